// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file DropComponents.h
 * @brief Removes small connected components from a label image.
 */
#ifndef voxplex_DropComponents_h
#define voxplex_DropComponents_h

#include "Image/Components.h"
#include "Image/LabelImage.h"

#include <cstdint>
#include <stop_token>
#include <vector>

namespace voxplex
{

/** A connected component of the image, for reports. */
struct ComponentReport
{
  std::int64_t Label = 0; ///< the label's value in the image
  std::int64_t Voxels = 0;
  std::vector<std::int64_t> Voxel; ///< the index of one of its voxels in the whole image
};

template <int D>
ComponentReport MakeReport(const Component<D>& component, const LabelImage<D>& image)
{
  ComponentReport report{ image.Values()[component.Label], component.Voxels, {} };
  for (std::size_t a = 0; a < D; ++a)
  {
    report.Voxel.push_back(image.CropOrigin()[a] + component.First[a]);
  }
  return report;
}

/**
 * Removes the connected components (through faces) that are smaller than a volume. Each takes the
 * most frequent label of its neighbours, counted by faces; if several labels are the most frequent,
 * the smallest of them. This is done in rounds until no component changes. So small components that
 * touch may first become one component.
 *
 * Complexity: linear in the voxels for each round; there are few rounds.
 *
 * @param volume components below it are removed; in the grid's unit of length to the power D. If it
 *   is not positive, nothing happens.
 * @param threads 0 means all cores; the result does not depend on it
 * @return the removed components. In each round the smallest come first; components of equal size
 *   are in the order of their first voxels.
 * @throws Cancelled if a stop was requested; InputError if only background is left
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
