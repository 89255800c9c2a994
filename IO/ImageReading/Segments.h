// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Segments.h
 * @brief The segments that the header of 3D Slicer's .seg.nrrd files lists.
 *
 * Keys are Segment0_ID, Segment0_Name, Segment0_Color, Segment0_LabelValue, Segment0_Layer and so on;
 * numbers may have gaps. What may be missing is what Slicer's own reader
 * (vtkMRMLSegmentationStorageNode) does without: the name is then the ID, the value 1, and the layer
 * the number of the segment.
 */
#ifndef voxplex_io_Segments_h
#define voxplex_io_Segments_h

#include "LabelTable.h"

#include <string>
#include <vector>

namespace voxplex::io
{

class TextHeader;

/**
 * Names and colours by label value; empty if the file lists no segments. Of two segments with one value
 * the first counts.
 *
 * @param warnings receives what is not used, one line each: values that are no labels, names that are not
 *   UTF-8
 */
LabelTable ReadSegments(const TextHeader& header, std::vector<std::string>& warnings);

/** "1 (Tibia, Femur), 2 (Cartilage)": the layers, counted from 1, and their segments' names. */
std::string DescribeLayers(const TextHeader& header);

} // namespace voxplex::io

#endif
