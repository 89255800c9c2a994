// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Dimension.h
 * @brief The stages of a run that differ between space and space-time.
 */
#ifndef voxplex_Dimension_h
#define voxplex_Dimension_h

#include "Conformity/ComponentCheck.h"
#include "Conformity/ConformityCheck.h"
#include "Conformity/FragmentCheck.h"
#include "Conformity/InterfaceCheck.h"
#include "Conformity/SpaceTimeInterfaceCheck.h"
#include "Mesh/SimplexMesh.h"
#include "Mesher/MeshingOptions.h"
#include "Mesher/MeshingStatistics.h"
#include "Mesher/Preparation.h"
#include "Mesher/RefinementStage.h"
#include "Sizing/SizingField.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

namespace voxplex
{

/** The base distance, and the object that it refers to. */
template <int D>
struct OwnedBaseDistance
{
  BaseDistance<D> Base;
  std::shared_ptr<const void> Grading; ///< null if the distance is uniform
};

template <int D>
struct Dimension;

struct Surroundings;

/** The stages in space. */
template <>
struct Dimension<3>
{
  static std::unique_ptr<RefinementStage<3>> MakeStage(
    const RunEnvironment<3>& run, const RefinementPlan<3>& plan)
  {
    return std::make_unique<WholeRefinement<3>>(run, plan);
  }

  /** The base distance. Graded by the local feature size if the options request it. */
  static OwnedBaseDistance<3> GradeBase(const RunEnvironment<3>& run, double delta);

  /** Points on the curves where labels meet. */
  static std::vector<FeatureSeed<3>> SampleJunctions(
    const RunEnvironment<3>& run, const SizingField<3>& sizing);

  /**
   * Improves shapes if the options request it. Keeps the components that the mesh has. The
   * triangulation is not needed any more, so its memory can be free by then.
   */
  static void Optimise(const RunEnvironment<3>& run, SimplexMesh<3>& mesh);

  /** Checks components, then interfaces. Extracts the mesh. */
  class Checks
  {
  public:
    /** Components may lower local bounds already here. All references must outlive the checks. */
    Checks(const RunEnvironment<3>& run, const RefinementStage<3>& stage, LocalDelta<3>& local);

    /** Points for thin components, to be inserted before refinement. */
    std::vector<FeatureSeed<3>> TakeSeeds();

    /** All checks, in order. */
    std::vector<ConformityCheck<3>*> All();

    /** What will be extracted. Valid once all checks have inspected the triangulation. */
    LabelledTriangulation<3> Elements() const
    {
      return { this->Source, this->Interfaces.Labels(), this->Interfaces.Parts() };
    }
    /** Whether a check may need refinement after it has inspected the mesh. */
    bool NeedMesh() const { return this->Interfaces.NeedsMesh(); }
    /** Call this if refinement is not resumed. It frees what only further inspections need. */
    void Finish() { this->Interfaces.Finish(); }

    /** Extracts the mesh with the labels and pieces that the checks have found. */
    void Extract(SimplexMesh<3>& mesh) const;

  private:
    const RunEnvironment<3> Run;
    const Triangulation<3>& Source;
    std::optional<ComponentCheck<3>> Components; ///< empty if components are not checked
    std::optional<FragmentCheck> Fragments;      ///< likewise
    InterfaceCheck Interfaces;
  };
};

/**
 * The stages in space-time. There are no junctions.
 */
template <>
struct Dimension<4>
{
  /** Slab by slab if the mesh is to conform to time planes or is periodic. */
  static std::unique_ptr<RefinementStage<4>> MakeStage(
    const RunEnvironment<4>& run, const RefinementPlan<4>& plan);

  /** As in space. */
  static OwnedBaseDistance<4> GradeBase(const RunEnvironment<4>& run, double delta);
  static std::vector<FeatureSeed<4>> SampleJunctions(
    const RunEnvironment<4>&, const SizingField<4>&)
  {
    return {};
  }

  /** See Checks::Extract(). */
  static void Optimise(const RunEnvironment<4>&, SimplexMesh<4>&) {}

  /** Checks components, also those of frames, then interfaces. Extracts the mesh. */
  class Checks
  {
  public:
    /** Components may lower local bounds already here. All references must outlive the checks. */
    Checks(const RunEnvironment<4>& run, const RefinementStage<4>& stage, LocalDelta<4>& local);

    /** Points for thin components, to be inserted before refinement. */
    std::vector<FeatureSeed<4>> TakeSeeds();

    /** All checks, in order. */
    std::vector<ConformityCheck<4>*> All();

    /** What will be extracted, but for pieces. */
    LabelledTriangulation<4> Elements() const
    {
      return { this->Source, this->Interfaces.Labels().Labels, this->NoParts };
    }
    /** Components are looked for in the mesh, after its vertices have been moved. */
    bool NeedMesh() const { return true; }
    void Finish() {}

    /**
     * Extracts the mesh with the labels that the checks have found. Moves interfaces to the right
     * volumes, opens triangles that are not manifold, and improves shapes, if the options request
     * it: all need the pentatopes outside of the object, too.
     */
    void Extract(SimplexMesh<4>& mesh) const;

  private:
    void Optimise(SimplexMesh<4>& mesh, const Surroundings& outside) const;
    /** Fills Slabs of the mesh. */
    void TellSlabs(SimplexMesh<4>& mesh) const;
    /** Fills Twins of the mesh. @param numbers the point of each vertex id, or None */
    void TellTwins(SimplexMesh<4>& mesh, std::span<const std::uint32_t> numbers) const;

    const RunEnvironment<4> Run;
    const RefinementStage<4>& Stage;
    const Triangulation<4>& Source;
    const SizingField<4>& Sizing;
    const bool MayRefine;                        ///< false if the image is short in time
    std::optional<ComponentCheck<4>> Components; ///< empty if components are not checked
    std::optional<ComponentCheck<4>> OfFrames;   ///< empty if components are not checked
    SpaceTimeInterfaceCheck Interfaces;
    const Subdivision<4> NoParts;
  };
};

} // namespace voxplex

#endif
