// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file DICOMSlices.h
 * @brief What the header of a DICOM file says of its slices, and how slices make a volume.
 */
#ifndef voxplex_io_DICOMSlices_h
#define voxplex_io_DICOMSlices_h

#include "DICOMDataSet.h"
#include "DICOMPixels.h"
#include "Placement.h"

#include <string>
#include <vector>

namespace voxplex::io
{

/** A slice of a file, or a frame. */
struct DICOMSlice
{
  std::string Name; ///< for messages: "'a.dcm'", "frame 3"
  std::size_t File = 0;
  int Frame = 0; ///< NoFrame: all voxels are 0

  static constexpr int NoFrame = -1;

  Vector3 Position{}; ///< of the first voxel, LPS
  Vector3 Row{};      ///< from voxel to voxel
  Vector3 Column{};
  double Distance = 0.0;  ///< of slices; 0: unknown
  double Thickness = 0.0; ///< 0: unknown
  double Slope = 1.0;
  double Intercept = 0.0;
};

/** @throws FileError: an object that is no volume of one value a voxel, and what to do with it */
void CheckObject(const DICOMDataSet& data);

/** The slices of a file, in its order. @throws FileError: they have no place, or values that are not numbers */
std::vector<DICOMSlice> ReadSlices(const DICOMDataSet& data, int frames);

/**
 * Sorts slices along their normal.
 * @param isComplete if not, slices without a frame are put where slices have been left out; their distance must be
 * known
 * @param warnings receives what was taken for the thickness of one slice that does not tell it
 * @return the step from slice to slice, which need not be along the normal
 * @throws FileError: they differ in orientation or spacing, several are at one place, or one is out of place
 */
Vector3 ArrangeSlices(
  std::vector<DICOMSlice>& slices, bool isComplete, std::vector<std::string>& warnings);

} // namespace voxplex::io

#endif
