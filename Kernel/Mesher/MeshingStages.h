// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshingStages.h
 * @brief What the mesher does one after the other, from an image to a mesh.
 */
#ifndef voxplex_MeshingStages_h
#define voxplex_MeshingStages_h

#include "Conformity/ComponentGuard.h"
#include "Conformity/InterfaceStage.h"
#include "Domain/Domain.h"
#include "Image/Components.h"
#include "Image/IsosurfaceImage.h"
#include "Junctions/JunctionCurves.h"
#include "Mesh/SimplexMesh.h"
#include "Mesher/DeltaSearch.h"
#include "Mesher/MeshingOptions.h"
#include "Mesher/MeshingStatistics.h"
#include "Refinement/Refiner.h"
#include "Sizing/BaseDensity.h"
#include "Sizing/Grading/LocalFeatureSize.h"
#include "Sizing/InterfaceSizes.h"
#include "Sizing/LocalDelta.h"

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <stop_token>
#include <vector>

namespace voxplex
{

/**
 * @brief The stages of a run, on whatever thread; shares only the fraction and the request to stop with
 * the thread that reports.
 *
 * What does not depend on delta is prepared once. MeshWithDelta() then samples, refines, extracts, goes on where
 * components or interfaces are missing, and optimises; for a number of elements it is called with one delta
 * after the other (DeltaSearch).
 */
template <int D>
class MeshingStages
{
public:
  /**
   * All references must live as long as this.
   * @param isosurface what is meshed, or null to mesh the labels alone
   * @param statistics has what is known before: the delta, if no number of elements is asked for
   */
  MeshingStages(const MeshingOptions<D>& options, const IsosurfaceImage<D>* isosurface,
    MeshingStatistics& statistics)
    : Options(options)
    , Isosurface(isosurface)
    , Stats(statistics)
  {
  }

  /** How much of a run each stage takes, about; only progress depends on it. */
  static constexpr double PreparationShare = 0.2;
  static constexpr double RefinementShare = 0.95; ///< end of refinement

  std::atomic<double> Fraction{ 0.0 };
  std::stop_source Stop;

  /**
   * False if stopped.
   * @throws InputError, TooLargeError, std::bad_alloc as ImageMesher::Run()
   */
  bool Run(const LabelImage<D>& image, SimplexMesh<D>& mesh);

private:
  /** What does not depend on delta. */
  struct Prepared
  {
    const LabelImage<D>& Image;
    const voxplex::Domain<D>& Domain;
    const Components<D>* All;                    ///< null if none are looked after
    const JunctionCurves* Junctions;             ///< null if they are not sampled
    std::shared_ptr<const SizeFunction<D>> Size; ///< with gradation; may be null
    std::stop_token Stop;
  };

  /** How densely interfaces are sampled, for one delta; the other members refer to the first. */
  struct Density
  {
    std::unique_ptr<const LocalFeatureSize> Grading; ///< null in uniform mode
    BaseDensity<D> Base;
    std::optional<InterfaceSizes<D>> Interfaces; ///< if any are given

    const InterfaceSizes<D>* Sizes() const
    {
      return this->Interfaces ? &*this->Interfaces : nullptr;
    }
    double Equivalent() const
    {
      return this->Interfaces ? this->Interfaces->Equivalent() : this->Base.Equivalent;
    }
  };

  // Once.
  bool RunUnlessStopped(const LabelImage<D>& image, SimplexMesh<D>& mesh);
  std::unique_ptr<const Domain<D>> MakeDomain(
    const LabelImage<D>& image, const std::stop_token& stop);
  template <typename DomainType>
  std::unique_ptr<const Domain<D>> Measured(std::unique_ptr<const DomainType> domain);
  std::shared_ptr<const SizeFunction<D>> LimitGradation(
    const LabelImage<D>& image, const std::stop_token& stop);
  std::optional<Components<D>> FindComponents(
    const LabelImage<D>& image, const std::stop_token& stop);
  std::optional<JunctionCurves> FindJunctions(const Domain<D>& domain, const std::stop_token& stop);

  // The search for a number of elements.
  bool SearchDelta(const Prepared& prepared, SimplexMesh<D>& mesh);
  DeltaSearch StartSearch(const Prepared& prepared) const;
  std::uint64_t ExpectedElements(const SimplexMesh<D>& mesh) const;
  bool IsFarFromTarget(const SimplexMesh<D>& mesh) const;

  // With one delta.
  bool MeshWithDelta(const Prepared& prepared, SimplexMesh<D>& mesh);
  Density ChooseDensity(const Prepared& prepared);
  std::unique_ptr<const LocalFeatureSize> Grade(const Prepared& prepared);
  std::optional<ComponentGuard<D>> GuardComponents(
    const Prepared& prepared, const Density& density, LocalDelta<D>& local);
  std::vector<FeatureSeed<D>> SampleJunctions(
    const Prepared& prepared, const RefinementContext<D>& context);
  RefinementSettings<D> Settings(
    const Prepared& prepared, const Density& density, const LocalDelta<D>& local) const;
  Box<D> MakeBox(const Domain<D>& domain, const Density& density) const;
  TeamOptions Team() const;
  bool Refine(const Prepared& prepared, RefinementContext<D>& context,
    const std::vector<FeatureSeed<D>>& seeds, RefinementStart start,
    std::uint64_t expectedVertices);
  void AddThreads(const std::vector<ThreadStatistics>& threads);
  void AddYielded(const GridGeometry<D>& grid, const std::vector<YieldingRegion<D>>& regions);
  bool SampleLostComponents(
    ComponentGuard<D>& guard, const LabelImage<D>& image, const SimplexMesh<D>& mesh);
  std::vector<FeatureSeed<D>> InspectTriangulation(std::optional<InterfaceStage>& interfaces);
  std::vector<FeatureSeed<D>> InspectMesh(
    std::optional<InterfaceStage>& interfaces, const SimplexMesh<D>& mesh);
  void Extract(const Triangulation<D>& triangulation, const Domain<D>& domain,
    const std::optional<InterfaceStage>& interfaces, const std::stop_token& stop,
    SimplexMesh<D>& mesh);
  void Optimise(
    const Prepared& prepared, const ComponentGuard<D>* components, SimplexMesh<D>& mesh);

  const BitMask<D>* Sites = nullptr; ///< surface voxels of the domain
  const MeshingOptions<D>& Options;
  const IsosurfaceImage<D>* Isosurface;
  MeshingStatistics& Stats;
  double ProgressStart = PreparationShare; ///< of the refinement
  double ProgressEnd = RefinementShare;
};

extern template class MeshingStages<3>;
extern template class MeshingStages<4>;

} // namespace voxplex

#endif
