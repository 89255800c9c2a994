// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Checks the statistics of a run.
#include "Checks.h"

#include <cmath>
#include <string>

namespace voxplex::stress
{

namespace
{

void Require(bool holds, const std::string& what, Findings& findings)
{
  if (!holds)
  {
    findings.Add("statistics", what);
  }
}

template <int D>
void CheckElementTarget(const Subject<D>& subject, Findings& findings)
{
  const std::uint64_t asked = subject.Of.Options.Sampling.Elements;
  Require(subject.Stats.ElementsAskedFor == asked,
    "another number of elements is said to be asked for", findings);
  Require(subject.Stats.Runs.empty() == (asked == 0), "the list of runs", findings);
  const auto made = static_cast<double>(subject.Mesh.Simplices.size());
  const auto target = static_cast<double>(asked);
  if (asked > 0 && std::abs(made - target) > 0.1 * target + 1.0)
  {
    findings.Add("elements", Text(made) + " elements were made, " + Text(target) + " asked for");
  }
}

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
void CheckStatistics(const Subject<D>& subject, const MeshFigures& figures, Findings& findings)
{
  const MeshingOptions<D>& options = subject.Of.Options;
  const MeshingStatistics& stats = subject.Stats;
  const RuleStatistics& rules = stats.Rules;
  const std::uint64_t vertices = subject.Mesh.Points.size();
  const std::uint64_t opened =
    Subject<D>::PiecesOfARidge * stats.Interfaces.NonManifoldOpened; // most new vertices
  const std::uint64_t optimised =
    stats.Optimisation.Ran ? 8 * stats.Optimisation.PoorBefore : 0; // likewise
  Require(rules.Insertions() + opened + optimised + 1 > vertices || vertices == 0,
    "fewer insertions than the mesh has vertices", findings);
  Require(rules.Created >= subject.Mesh.Simplices.size(),
    "fewer simplices created than the mesh has", findings);
  Require(rules.Removed <= rules.Insertions(), "more removals than insertions", findings);
  Require(options.Sampling.Elements > 0 || stats.Delta == subject.Of.Delta(), "delta", findings);
  Require(stats.LargestDelta >= stats.Delta || !options.Sampling.InterfaceSizes.empty(),
    "the largest delta is below delta", findings);
  Require(stats.Threads.size() == options.Team.Threads, "the number of threads", findings);
  Require(stats.Times.Total() >= 0.0 && std::isfinite(stats.Times.Total()), "times", findings);
  Require(
    stats.Interfaces.Rounds <= options.Interfaces.Rounds, "more rounds than asked for", findings);
  Require(stats.Optimisation.Ran == options.Optimisation.Run, "whether optimisation ran", findings);
  // In space-time optimisation leaves boundaries as they are.
  const bool counts = options.Interfaces.Manifold && (D == 4 || !options.Optimisation.Run);
  Require(!counts || (figures.NonManifold > 0) == (stats.Interfaces.NonManifoldLeft > 0),
    std::to_string(figures.NonManifold) + " ridges are not manifold, it says " +
      std::to_string(stats.Interfaces.NonManifoldLeft),
    findings);
  const std::uint64_t looked = stats.Interfaces.NonManifoldRepaired +
    stats.Interfaces.NonManifoldOpened + stats.Interfaces.NonManifoldLeft;
  Require(options.Interfaces.Manifold || looked == 0,
    "ridges are made manifold, which was not asked for", findings);
  CheckElementTarget(subject, findings);
}

//------------------------------------------------------------------------------------------------
template <int D>
MeshFigures CheckMesh(const Subject<D>& subject, Findings& findings)
{
  MeshFigures figures;
  if (!CheckArrays(subject, findings))
  {
    return figures;
  }
  CheckOrientation(subject, findings);
  CheckConformity(subject, findings);
  CheckComponents(subject, figures, findings);
  CheckTopology(subject, findings);
  CheckBoundaries(subject, figures, findings);
  CheckShapes(subject, findings);
  CheckAgainstImage(subject, findings);
  if constexpr (D == 4)
  {
    CheckTimePlanes(subject, findings);
  }
  CheckStatistics(subject, figures, findings);
  return figures;
}

template MeshFigures CheckMesh<3>(const Subject<3>&, Findings&);
template MeshFigures CheckMesh<4>(const Subject<4>&, Findings&);

} // namespace voxplex::stress
