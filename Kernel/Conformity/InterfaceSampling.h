// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file InterfaceSampling.h
 * @brief Chooses interface points to insert where a check found something wrong.
 */
#ifndef voxplex_InterfaceSampling_h
#define voxplex_InterfaceSampling_h

#include "Domain/Domain.h"
#include "Image/BitMask.h"
#include "Image/FacesNear.h"
#include "Image/LabelImage.h"
#include "Refinement/FeatureSeed.h"
#include "Sizing/SizingField.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <stop_token>
#include <vector>

namespace voxplex
{

/**
 * The midpoint of a non-manifold edge (a triangle in 4D): some label does not have exactly two
 * boundary facets there.
 */
template <int D>
struct NonManifoldPlace
{
  Point<D> Middle;
  bool IsJunction; ///< three or more labels meet there
};

/**
 * @brief Proposes points on the interfaces around far voxel faces and around non-manifold edges.
 *
 * At the first visit of a place, the points are FirstSpacing sampling distances apart. Each further
 * visit halves the spacing, down to a fifth of a voxel. If a face is far a second time, R1 also
 * gets a smaller sampling distance there (LocalDelta), so that circumcentres come to lie in thin
 * parts.
 *
 * Not thread safe.
 */
template <int D>
class InterfaceSampling
{
public:
  /**
   * All references must outlive the object.
   * @param sites the image's surface voxels (FindSurfaceVoxels)
   * @param local receives the spacing of the points, and bounds
   */
  InterfaceSampling(const LabelImage<D>& image, const BitMask<D>& sites, const Domain<D>& domain,
    const SizingField<D>& sizing, LocalDelta<D>& local, const std::stop_token& stop);

  /**
   * Proposes points around far faces and non-manifold edges.
   * @return empty if nothing is wrong, or if the label field has no finer features to sample
   * @throws Cancelled if a stop was requested before the end
   */
  std::vector<FeatureSeed<D>> Around(
    const std::vector<VoxelFace<D>>& far, const std::vector<NonManifoldPlace<D>>& edges);

  /**
   * As Around(), but returns nothing if only edges at junctions are wrong. Such edges are sampled
   * along with other places.
   */
  std::vector<FeatureSeed<D>> AroundIfBad(
    const std::vector<VoxelFace<D>>& far, const std::vector<NonManifoldPlace<D>>& edges);

  /** The faces around which points were proposed so far, ascending. */
  const std::vector<VoxelFace<D>>& Sampled() const { return this->Faces; }

  using Index = typename GridGeometry<D>::Index;

  /** The cell of LocalDelta that a face is sampled with. */
  static Index CellOf(const VoxelFace<D>& face);

private:
  double FirstDistance(const VoxelFace<D>& face) const;
  double SpacingAt(const VoxelFace<D>& face, unsigned visit) const;
  void LowerBound(const VoxelFace<D>& face);

  const LabelImage<D>& Image;
  const BitMask<D>& Sites;
  const Domain<D>& Surfaces;
  const SizingField<D>& Sizing;
  LocalDelta<D>& Local;
  const std::stop_token Stop;
  double FinestSpacing;
  std::map<Index, unsigned> Visits; ///< by cell of LocalDelta
  std::vector<VoxelFace<D>> Faces;
};

/** The union of two ascending lists. */
template <int D>
std::vector<VoxelFace<D>> UnionOf(
  const std::vector<VoxelFace<D>>& a, const std::vector<VoxelFace<D>>& b)
{
  std::vector<VoxelFace<D>> all;
  std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(all));
  return all;
}

extern template class InterfaceSampling<3>;
extern template class InterfaceSampling<4>;

} // namespace voxplex

#endif
