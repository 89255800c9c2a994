// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ThinPart.h
 * @brief The fewest interface points that bring out what is thinner than the mesh is fine.
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
 * @brief How far the label of a voxel reaches from it along the axes.
 *
 * Where a label is thin along an axis, the two points where the line through the voxel's centre along that axis leaves it
 * make an edge of the Delaunay triangulation, unless other vertices are near. The circumcentres of all tetrahedra at this
 * edge are in the plane half way between its ends, so in the middle of the label. A sheet needs two points to be seen
 * there, a rod four, a grain six.
 *
 * Immutable; safe to read from any thread.
 */
template <int D>
class ThinPart
{
public:
  using Index = typename GridGeometry<D>::Index;

  /** The label is not followed farther than so many voxels along each axis. */
  static constexpr std::int64_t MostSteps = 8;

  /**
   * Takes MostSteps look-ups of voxels and one search for a crossing for each direction, at most.
   * @param surfaces of the same image
   * @param voxel an index of the crop
   */
  ThinPart(const LabelImage<D>& image, const Domain<D>& surfaces, const Index& voxel);

  const Index& Voxel() const { return this->Middle; }

  /** The least distance between the two ends along an axis, in the unit of the image's spacing. */
  double Thickness() const { return this->Least; }

  /** The ends along the axes along which the label is thin, on interfaces; along the others there are none. */
  const std::vector<Point<D>>& Ends() const { return this->Crossings; }

  /** Whether the label is thicker here, or as thick and this voxel is farther from its rim. */
  bool IsBetterThan(const ThinPart& other) const;

private:
  Index Middle;
  double Least;  ///< of the distances between two ends
  double Margin; ///< of the distances to an end
  double Total;  ///< of the distances between two ends
  std::vector<Point<D>> Crossings;
};

extern template class ThinPart<3>;
extern template class ThinPart<4>;

} // namespace voxplex

#endif
