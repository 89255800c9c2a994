// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ThinPart.h
 * @brief The fewest interface points with which a part thinner than the sampling distance appears
 *   in the mesh.
 */
#ifndef voxplex_ThinPart_h
#define voxplex_ThinPart_h

#include "Domain/Domain.h"
#include "Image/LabelImage.h"

#include <cstdint>
#include <vector>

namespace voxplex
{

/**
 * @brief How far the label of a voxel extends from it along the axes.
 *
 * The line through the voxel's centre along an axis leaves the label at two points, the ends. If
 * the label is thin along this axis and no other vertices are near, the ends make an edge of the
 * Delaunay triangulation. The circumcentres of all tetrahedra at this edge lie in its bisecting
 * plane, that is, in the middle of the label. So two points are enough for a sheet, four for a rod,
 * six for a grain.
 *
 * Immutable; safe to read from any thread.
 */
template <int D>
class ThinPart
{
public:
  using Index = typename GridGeometry<D>::Index;

  /** The label is followed at most this number of voxels along each axis. */
  static constexpr std::int64_t MostSteps = 8;

  /**
   * Takes at most MostSteps look-ups of voxels and one search for a crossing in each direction.
   * @param surfaces the domain of the same image
   * @param voxel an index of the crop
   */
  ThinPart(const LabelImage<D>& image, const Domain<D>& surfaces, const Index& voxel);

  const Index& Voxel() const { return this->Middle; }

  /**
   * The smallest distance between the two ends along an axis, in the unit of the image's spacing.
   */
  double Thickness() const { return this->Least; }

  /** The ends, which lie on interfaces, but only along the axes along which the label is thin. */
  const std::vector<Point<D>>& Ends() const { return this->Crossings; }

  /**
   * Whether the label is thicker here. If it is equally thick: whether this voxel is farther from
   * its ends.
   */
  bool IsBetterThan(const ThinPart& other) const;

private:
  Index Middle;
  double Least;  ///< smallest distance between two ends
  double Margin; ///< smallest distance from the voxel's centre to an end
  double Total;  ///< sum of the distances between two ends
  std::vector<Point<D>> Crossings;
};

extern template class ThinPart<3>;
extern template class ThinPart<4>;

} // namespace voxplex

#endif
