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
  unsigned Segment = 0; ///< of which the frame is; 0: none is told
};

/** Which slices a volume has. */
enum class DICOMStack
{
  Complete,  ///< all, each once
  LabelMap,  ///< some may have been left out
  OfSegments ///< and several frames are at one place
};

/** @throws FileError: an object that is no volume of one value a voxel, and what to do with it */
void CheckObject(const DICOMDataSet& data);

/** The slices of a file, in its order. @throws FileError: they have no place, or values that are not numbers */
std::vector<DICOMSlice> ReadSlices(const DICOMDataSet& data, int frames);

/**
 * Sorts slices along their normal. Slices without a frame are put where some have been left out: their distance is told,
 * or the smallest that there is. Of several at one place, where this may be, the first is kept. If some may have been
 * left out, one without a frame is put before the first and one after the last.
 *
 * @param warnings receives what was taken for the thickness of one slice that does not tell it
 * @return the step from slice to slice, which need not be along the normal
 * @throws FileError: they differ in orientation or spacing, several are at one place, or one is out of place
 */
Vector3 ArrangeSlices(
  std::vector<DICOMSlice>& slices, DICOMStack stack, std::vector<std::string>& warnings);

/**
 * Which of the arranged slices is at the place of a frame of a segment that was arranged with them.
 * @throws FileError: the frame is beside it
 */
std::size_t FindSlice(
  const std::vector<DICOMSlice>& arranged, const Vector3& step, const DICOMSlice& frame);

} // namespace voxplex::io

#endif
