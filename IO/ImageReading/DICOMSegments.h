// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file DICOMSegments.h
 * @brief What the header of a DICOM segmentation says of its segments (PS3.3, C.8.20).
 */
#ifndef voxplex_io_DICOMSegments_h
#define voxplex_io_DICOMSegments_h

#include "DICOMDataSet.h"
#include "LabelTable.h"

#include <cstdint>
#include <vector>

namespace voxplex::io
{

struct DICOMSegment
{
  std::uint16_t Number = 0; ///< positive
  LabelTable::Entry Entry;  ///< its name may be empty
};

/**
 * In the order of the file, each number once. The background of a label map is left out.
 *
 * Names in Latin-1 become UTF-8; those of other character sets are as the file has them. Colours are those to display,
 * CIELab with the white of D65, as PixelMed, DCMTK and highdicom write it, or those of a palette.
 *
 * @throws FileError: a Segmentation Type that is not of its class, a number twice or, unless it is a label map, 0
 */
std::vector<DICOMSegment> ListSegments(const DICOMDataSet& data);

/**
 * Above which value of a voxel, of so many bits, its segment has it.
 *
 * @throws FileError for fractions whose greatest is not given, or needs more bits
 */
double FindThreshold(const DICOMDataSet& data, unsigned bits, double probability);

/** The value of a label map that is background, beside 0. @throws FileError if 0 is a segment then */
std::uint16_t FindBackground(const DICOMDataSet& data);

} // namespace voxplex::io

#endif
