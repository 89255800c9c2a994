// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RefinementStage.h
 * @brief The stage of a run that refines the triangulation, all at once or slab by slab.
 */
#ifndef voxplex_RefinementStage_h
#define voxplex_RefinementStage_h

#include "Mesher/MeshingOptions.h"
#include "Mesher/MeshingStatistics.h"
#include "Mesher/Preparation.h"
#include "Mesher/RunProgress.h"
#include "Refinement/RefinementContext.h"
#include "Refinement/RefinerBase.h"

#include <array>
#include <cstdint>
#include <span>
#include <stop_token>
#include <vector>

namespace voxplex
{

/** The inputs of a run after its preparation. All references must outlive the stages. */
template <int D>
struct RunEnvironment
{
  const PreparedImage<D>& Prepared;
  const MeshingOptions<D>& Options;
  MeshingStatistics& Statistics;
  std::stop_token Stop;
};

/** What a stage needs to know besides the environment. */
template <int D>
struct RefinementPlan
{
  RefinementSettings<D> Settings;
  double LargestDistance;          ///< largest Delta(z): the box is twice as far from interfaces
  std::uint64_t Vertices;          ///< expected, of the triangulation
  std::uint64_t InterfaceVertices; ///< expected
};

/**
 * @brief Refines a triangulation of the whole box until no rule applies. It can go on from more points
 * later.
 */
template <int D>
class RefinementStage
{
public:
  virtual ~RefinementStage() = default;

  /**
   * @param seeds points to be inserted before the rules are applied
   * @return false if stopped
   */
  virtual bool Refine(
    const std::vector<FeatureSeed<D>>& seeds, RefinementStart start, RunProgress& progress) = 0;

  /** The result of Refine(). The reference stays valid; ids may be others after each Refine(). */
  virtual const Triangulation<D>& Mesh() const = 0;
  /** The same, for states of simplices. Only the stage itself changes points and simplices. */
  virtual Triangulation<D>& Mesh() = 0;
  virtual const SizingField<D>& Sizing() const = 0;
  /**
   * Call this if there is no more refinement. It frees what only that needs. Afterwards only vertices and
   * simplices can be read, their labels, and whether they are alive. It may do nothing.
   */
  virtual void Finish() {}

  /**
   * Pairs of vertices at the first and at the last end of a periodic mesh, with the same position in space;
   * ascending by the first. Empty if the mesh is not periodic.
   */
  virtual std::span<const std::array<VertexId, 2>> Twins() const { return {}; }
};

/**
 * Refines one triangulation by the rules of its dimension.
 * @param others vertices of other triangulations of the run, for progress
 * @return false if stopped
 */
template <int D>
bool RefineContext(const RunEnvironment<D>& run, RefinementContext<D>& context,
  const std::vector<FeatureSeed<D>>& seeds, RefinementStart start, std::uint64_t expectedVertices,
  RunProgress& progress, std::uint64_t others = 0);

/**
 * A box at least 2 Delta away from every interface (thesis, sections 2.2 and 4.2), except at flat
 * ends.
 */
template <int D>
Box<D> BoxAround(const Domain<D>& domain, double largestDistance);

/** @brief One triangulation of the whole box. */
template <int D>
class WholeRefinement final : public RefinementStage<D>
{
public:
  WholeRefinement(const RunEnvironment<D>& run, const RefinementPlan<D>& plan);

  bool Refine(
    const std::vector<FeatureSeed<D>>& seeds, RefinementStart start, RunProgress& progress) override
  {
    return RefineContext(this->Run, this->Context, seeds, start, this->Vertices, progress);
  }
  const Triangulation<D>& Mesh() const override { return this->Context.Mesh; }
  Triangulation<D>& Mesh() override { return this->Context.Mesh; }
  const SizingField<D>& Sizing() const override { return this->Context.Sizing; }
  void Finish() override
  {
    this->Context.Mesh.Freeze();
    this->Context.Features.Release();
    this->Context.Work = RegionalWork<D>(0);
  }

private:
  const RunEnvironment<D> Run;
  RefinementContext<D> Context;
  const std::uint64_t Vertices;
};

extern template bool RefineContext<3>(const RunEnvironment<3>&, RefinementContext<3>&,
  const std::vector<FeatureSeed<3>>&, RefinementStart, std::uint64_t, RunProgress&, std::uint64_t);
extern template bool RefineContext<4>(const RunEnvironment<4>&, RefinementContext<4>&,
  const std::vector<FeatureSeed<4>>&, RefinementStart, std::uint64_t, RunProgress&, std::uint64_t);
extern template Box<3> BoxAround<3>(const Domain<3>&, double);
extern template Box<4> BoxAround<4>(const Domain<4>&, double);
extern template class WholeRefinement<3>;
extern template class WholeRefinement<4>;

} // namespace voxplex

#endif
