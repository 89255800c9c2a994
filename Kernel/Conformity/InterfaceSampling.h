// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file InterfaceSampling.h
 * @brief Points of interfaces that are inserted where a check found something wrong.
 */
#ifndef voxplex_InterfaceSampling_h
#define voxplex_InterfaceSampling_h

#include "Domain/Domain.h"
#include "Image/BitMask.h"
#include "Image/FacesNear.h"
#include "Image/LabelImage.h"
#include "Refinement/FeatureSeed.h"
#include "Sizing/SizingField.h"

#include <map>
#include <stop_token>
#include <vector>

namespace voxplex
{

/** The middle of an edge that is not manifold on the boundary of some label: other than two of its facets meet there. */
struct NonManifoldPlace
{
  Point<3> Middle;
  bool IsJunction; ///< three labels or more meet there
};

/**
 * @brief Proposes points on the interfaces around far faces of voxels and around edges that are not manifold.
 *
 * The points are FirstSpacing sampling distances apart at the first visit of a place, half of that at the next, and so
 * on down to a fifth of a voxel. Where a face is far a second time R1 gets a smaller sampling distance besides
 * (LocalDelta), so that circumcentres come to lie in what is thin.
 *
 * Not thread safe.
 */
class InterfaceSampling
{
public:
  /**
   * All references must live as long as this.
   * @param sites the image's surface voxels (FindSurfaceVoxels)
   * @param local receives the spacing of the points, and bounds
   */
  InterfaceSampling(const LabelImage<3>& image, const BitMask<3>& sites, const Domain<3>& domain,
    const SizingField<3>& sizing, LocalDelta<3>& local, const std::stop_token& stop);

  /**
   * @return nothing if there is nothing wrong, or if the label field has no finer features to sample
   * @throws Cancelled if a stop was requested before the end
   */
  std::vector<FeatureSeed<3>> Around(
    const std::vector<VoxelFace>& far, const std::vector<NonManifoldPlace>& edges);

  /**
   * The same, but edges at junctions are no reason to begin: they are sampled along with the rest.
   */
  std::vector<FeatureSeed<3>> AroundIfBad(
    const std::vector<VoxelFace>& far, const std::vector<NonManifoldPlace>& edges);

  /** The faces around which there were points so far, ascending. */
  const std::vector<VoxelFace>& Sampled() const { return this->Faces; }

private:
  using Index = GridGeometry<3>::Index;

  static Index CellOf(const VoxelFace& face);
  double FirstDistance(const VoxelFace& face) const;
  double SpacingAt(const VoxelFace& face, unsigned visit) const;
  void LowerBound(const VoxelFace& face);

  const LabelImage<3>& Image;
  const BitMask<3>& Sites;
  const Domain<3>& Surfaces;
  const SizingField<3>& Sizing;
  LocalDelta<3>& Local;
  const std::stop_token Stop;
  double FinestSpacing;
  std::map<Index, unsigned> Visits; ///< by cell of LocalDelta
  std::vector<VoxelFace> Faces;
};

/** Of both, which are ascending. */
std::vector<VoxelFace> UnionOf(const std::vector<VoxelFace>& a, const std::vector<VoxelFace>& b);

} // namespace voxplex

#endif
