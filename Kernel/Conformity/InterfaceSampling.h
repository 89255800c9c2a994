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

#include <map>
#include <stop_token>
#include <vector>

namespace voxplex
{

/**
 * The midpoint of a non-manifold edge: some label does not have exactly two boundary facets there.
 */
struct NonManifoldPlace
{
  Point<3> Middle;
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
class InterfaceSampling
{
public:
  /**
   * All references must outlive the object.
   * @param sites the image's surface voxels (FindSurfaceVoxels)
   * @param local receives the spacing of the points, and bounds
   */
  InterfaceSampling(const LabelImage<3>& image, const BitMask<3>& sites, const Domain<3>& domain,
    const SizingField<3>& sizing, LocalDelta<3>& local, const std::stop_token& stop);

  /**
   * Proposes points around far faces and non-manifold edges.
   * @return empty if nothing is wrong, or if the label field has no finer features to sample
   * @throws Cancelled if a stop was requested before the end
   */
  std::vector<FeatureSeed<3>> Around(
    const std::vector<VoxelFace>& far, const std::vector<NonManifoldPlace>& edges);

  /**
   * As Around(), but returns nothing if only edges at junctions are wrong. Such edges are sampled
   * along with other places.
   */
  std::vector<FeatureSeed<3>> AroundIfBad(
    const std::vector<VoxelFace>& far, const std::vector<NonManifoldPlace>& edges);

  /** The faces around which points were proposed so far, ascending. */
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

/** The union of two ascending lists. */
std::vector<VoxelFace> UnionOf(const std::vector<VoxelFace>& a, const std::vector<VoxelFace>& b);

} // namespace voxplex

#endif
