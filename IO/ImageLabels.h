// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ImageLabels.h
 * @brief Which labels an image has.
 */
#ifndef voxplex_io_ImageLabels_h
#define voxplex_io_ImageLabels_h

#include "ImageReading/ScalarImage.h"
#include "LabelTable.h"

namespace voxplex::io
{

/** Removes labels that no voxel of any frame has. Ends when all of them have been seen. */
void KeepLabelsOf(const ScalarImage& image, LabelTable& table);

} // namespace voxplex::io

#endif
