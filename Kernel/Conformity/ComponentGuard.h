// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ComponentGuard.h
 * @brief Sees to it that no connected component of the image is missing from the mesh.
 */
#ifndef voxplex_ComponentGuard_h
#define voxplex_ComponentGuard_h

#include "Domain/Domain.h"
#include "Image/Components.h"
#include "Mesh/SimplexMesh.h"
#include "Refinement/FeatureSeed.h"
#include "Sizing/LocalDelta.h"

#include <cstdint>
#include <stop_token>
#include <vector>

namespace voxplex
{

/**
 * @brief Chooses where to sample more finely so that every component gets elements, and tells which got
 * none.
 *
 * An interface that is sampled with delta cannot show what is much thinner than delta: a Delaunay mesh of
 * too few points joins what lies on both sides. So components may have no element when the mesh is there. FindLost() says
 * which, and SampleFiner() chooses points: first the few that bring out a component where it is thickest (ThinPart), with
 * a smaller delta (LocalDelta) just there; if it has no element all the same, the same more finely; then all of it, again
 * and again with half the delta. The largest component of each label is looked after however small it is, so that a mesh
 * has all labels of its image.
 *
 * When components are to be exact, what is thin beside delta is sampled as a whole from the start. The mean
 * thickness of a component is taken from the ratio of its volume to its surface, which is a third of it for a ball or
 * cube and half of it for a sheet or a rod. Where that is small beside delta, its surroundings get a smaller delta, and
 * points on all of its faces are inserted before refinement (FeatureSeed), since R1 looks only at the interface closest to
 * a circumcentre and may never see a small component.
 *
 * Beyond the thesis, which samples uniformly or by the local feature size and gives no guarantee for
 * objects that are small beside delta.
 */
template <int D>
class ComponentGuard
{
public:
  /**
   * @param image, domain, components must live as long as this
   * @param delta the sampling density elsewhere, by dense id of the label
   * @param fewestVoxels smaller components are not looked after, but for the largest of each label
   * @param exact whether what is thin beside delta is sampled as a whole from the start
   * @param local where to sample more finely; receives bounds
   * @param threads 0 means all cores; results do not depend on it
   * @throws Cancelled if a stop was requested before the end
   */
  ComponentGuard(const LabelImage<D>& image, const Domain<D>& domain,
    const Components<D>& components, const std::vector<double>& delta, std::int64_t fewestVoxels,
    bool exact, LocalDelta<D>& local, unsigned threads, const std::stop_token& stop);

  /** What has been decided to insert since the last call, in the order of components. */
  std::vector<FeatureSeed<D>> TakeSeeds();

  /** How many seeds there were so far. */
  std::size_t NumberOfSeeds() const { return this->SeedsTaken + this->Seeds.size(); }

  /** Components with no element of their label within a voxel of them, in increasing order. */
  std::vector<std::uint32_t> FindLost(const SimplexMesh<D>& mesh) const;

  /** An element of each of these that the mesh has, the one of best shape; those that it has not are passed over. */
  std::vector<std::uint32_t> FindWitnesses(
    const SimplexMesh<D>& mesh, const std::vector<std::uint32_t>& components) const;

  /**
   * Adds seeds of these components, and bounds near them.
   * @return false if none of them can be sampled more finely
   */
  bool SampleFiner(const std::vector<std::uint32_t>& lost);

  const Components<D>& GetComponents() const { return this->All; }

private:
  using Index = typename GridGeometry<D>::Index;

  /** What the mean thickness of a component bears. */
  double OwnDelta(std::uint32_t component) const;
  void SampleThickest(std::uint32_t component);
  void Sample(std::uint32_t component, double delta);

  const LabelImage<D>& Image;
  const Domain<D>& Surfaces;
  const Components<D>& All;
  std::vector<double> Delta;      ///< by component
  std::vector<unsigned> Attempts; ///< by component, how often it was sampled where it is thickest
  double FinestDelta;             ///< no component is sampled more finely
  std::vector<bool> Wanted;       ///< by component
  unsigned Threads;
  std::stop_token Stop;
  LocalDelta<D>& Local;
  std::vector<FeatureSeed<D>> Seeds; ///< not taken yet
  std::size_t SeedsTaken = 0;
};

extern template class ComponentGuard<3>;
extern template class ComponentGuard<4>;

} // namespace voxplex

#endif
