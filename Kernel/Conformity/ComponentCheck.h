// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ComponentCheck.h
 * @brief Sees to it that no connected component of the image is missing from the mesh.
 */
#ifndef voxplex_ComponentCheck_h
#define voxplex_ComponentCheck_h

#include "Conformity/ComponentStatistics.h"
#include "Conformity/ConformityCheck.h"
#include "Domain/Domain.h"
#include "Image/Components.h"
#include "Mesh/SimplexMesh.h"
#include "Refinement/FeatureSeed.h"
#include "Sizing/SizingField.h"

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
class ComponentCheck final : public ConformityCheck<D>
{
public:
  /**
   * @param image, domain, components must live as long as this
   * @param sizing the sampling distances elsewhere; needed during construction only
   * @param fewestVoxels smaller components are not looked after, but for the largest of each label
   * @param exact whether what is thin beside delta is sampled as a whole from the start
   * @param local where to sample more finely; receives bounds
   * @param statistics counts rounds and points, and lists what is lost
   * @param threads 0 means all cores; results do not depend on it
   * @throws Cancelled if a stop was requested before the end
   */
  ComponentCheck(const LabelImage<D>& image, const Domain<D>& domain,
    const Components<D>& components, const SizingField<D>& sizing, std::int64_t fewestVoxels,
    bool exact, LocalDelta<D>& local, ComponentStatistics& statistics, double& seconds,
    unsigned threads, const std::stop_token& stop);

  /** The points that were chosen since the last call, in the order of components. */
  std::vector<FeatureSeed<D>> TakeSeeds();

  /** Asks for elements of the components that have none; of those that cannot get one it gives up, and lists them. */
  Remedy<D> InspectMesh(const SimplexMesh<D>& mesh) override;

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
  ComponentStatistics& Statistics;
};

extern template class ComponentCheck<3>;
extern template class ComponentCheck<4>;

} // namespace voxplex

#endif
