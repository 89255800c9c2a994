// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file DropComponents.h
 * @brief Takes small connected components out of a label image.
 */
#ifndef voxplex_DropComponents_h
#define voxplex_DropComponents_h

#include "Image/LabelImage.h"

#include <cstdint>
#include <stop_token>
#include <vector>

namespace voxplex
{

/** A connected component of the image, for reports. */
struct ComponentReport
{
  std::int64_t Label = 0; ///< the image's own value
  std::int64_t Voxels = 0;
  std::vector<std::int64_t> Voxel; ///< the index of one of its voxels in the whole image
};

/**
 * Gives every connected component (through faces) that is smaller than a volume the label that most of
 * its faces have on their other side, the smallest such label if there are several: specks become what is
 * around them. Small ones that touch are taken for one, by repeating it until none is left.
 *
 * Complexity: linear in the voxels, a few times.
 *
 * @param volume in the unit of length of the grid to the power D; nothing happens if it is not positive
 * @param threads 0 means all cores; the result does not depend on it
 * @return what was dropped, in the order of first voxels, the smallest ones of each round first
 * @throws Cancelled if a stop was requested; InputError if nothing but background is left
 */
template <int D>
std::vector<ComponentReport> DropComponents(
  LabelImage<D>& image, double volume, unsigned threads = 1, const std::stop_token& stop = {});

extern template std::vector<ComponentReport> DropComponents<3>(
  LabelImage<3>&, double, unsigned, const std::stop_token&);
extern template std::vector<ComponentReport> DropComponents<4>(
  LabelImage<4>&, double, unsigned, const std::stop_token&);

} // namespace voxplex

#endif
