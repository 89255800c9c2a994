// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Dimension.h
 * @brief What differs between space and space-time before and during refinement.
 */
#ifndef voxplex_Dimension_h
#define voxplex_Dimension_h

#include "Mesher/RefinementStage.h"
#include "Sizing/SizingField.h"

#include <memory>
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

/** What differs between space and space-time before and during refinement. */
template <int D>
struct Dimension;

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

  /** Whether refinement may be resumed after an inspection. */
  static bool MayRefine(const RunEnvironment<3>&) { return true; }
};

/** In space-time there are no junctions. */
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

  /** False if the image is short in time. */
  static bool MayRefine(const RunEnvironment<4>& run);
};

} // namespace voxplex

#endif
