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
#include "ScalarImage.h"

#include <string>
#include <vector>

namespace voxplex::io
{

class TextHeader;
struct Reading;

/**
 * Names and colours by label value; empty if the file lists no segments. Of two segments with one value
 * the first counts.
 *
 * @param warnings receives what is not used, one line each: values that are no labels, names that are not
 *   UTF-8
 */
LabelTable ReadSegments(const TextHeader& header, std::vector<std::string>& warnings);

/** Whether the file lists segments. */
bool HasSegments(const TextHeader& header);

/**
 * One label a voxel of segments that overlap, by the rule of the reading. They are numbered 1, 2, ... as they are
 * listed, and their names and colours become those of the reading.
 *
 * @param layers an image whose frames are layers
 */
ScalarImage CombineLayers(const TextHeader& header, const ScalarImage& layers, Reading& reading);

} // namespace voxplex::io

#endif
