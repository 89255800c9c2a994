// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ImageLabels.h
 * @brief The chosen array of an image as the kernel's label image.
 */
#ifndef voxplex_Private_ImageLabels_h
#define voxplex_Private_ImageLabels_h

#include "Image/LabelImage.h"
#include "Private/ChosenArray.h"

#include <stop_token>

namespace voxplex
{

/**
 * Reads an array of one component, of any type that VTK has for numbers.
 *
 * @param threads 0 means all cores
 * @throws InputError for values that are no labels, and what else LabelImage::FromScalars() throws
 */
LabelImage<3> ReadLabels(const ChosenArray& input, const LabelSelection& selection,
  unsigned threads, const std::stop_token& stop = {});

} // namespace voxplex

#endif
