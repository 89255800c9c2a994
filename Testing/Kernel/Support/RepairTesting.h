// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Repairs of all bad ridges of a triangulation.
#ifndef voxplex_RepairTesting_h
#define voxplex_RepairTesting_h

#include "Conformity/InterfaceVertices.h"
#include "Conformity/ManifoldLabels.h"
#include "Conformity/ManifoldRepair.h"
#include "MeshChecks.h"
#include "MeshRuns.h"

#include <cstddef>
#include <cstdint>
#include <random>
#include <span>
#include <stop_token>
#include <utility>
#include <vector>

namespace voxplex::checks
{

/** The result of a repair, and the number of bad ridges before it. */
template <int D>
struct Repaired : ManifoldRepairResult<D>
{
  std::size_t Before = 0;
};

template <int D>
Repaired<D> RepairAll(Triangulation<D>& triangulation, std::span<LabelId> labels,
  const ManifoldRepairOptions<D>& options = {}, unsigned threads = 1,
  const std::stop_token& stop = {})
{
  MarkInterfaceVertices<D>(triangulation, labels, threads, stop);
  const std::vector<InterfaceRidge<D>> ridges =
    FindNonManifoldRidges<D>(triangulation, labels, threads, stop);
  Repaired<D> result{ RepairManifold<D>(triangulation, labels, ridges, options, threads, stop) };
  result.Before = ridges.size();
  return result;
}

/** What a repair says, and the labels after it. */
template <int D>
struct RepairedLabels : ManifoldLabels<D>
{
  SimplexLabels Labels;
};

/** The labels after a repair that tells all gaps. */
template <int D>
RepairedLabels<D> LabelsOf(ManifoldLabeller<D>& labeller, InterfaceStatistics& figures)
{
  RepairedLabels<D> made{ labeller.Repair(labeller.Take(), {}, figures), {} };
  made.Labels = labeller.GetLabels();
  return made;
}

/** Other labels for the simplices of an object, at random: of so many, and of background if asked for. */
inline SimplexLabels Shuffled(
  SimplexLabels labels, unsigned seed, unsigned number, bool withBackground)
{
  std::mt19937 random(seed);
  for (LabelId& label : labels)
  {
    const auto drawn = static_cast<LabelId>(random() % (number + (withBackground ? 1 : 0)));
    label = label == 0 ? LabelId{ 0 } : static_cast<LabelId>(drawn + (withBackground ? 0 : 1));
  }
  return labels;
}

template <int D>
double TotalVolume(const SimplexMesh<D>& mesh)
{
  double volume = 0.0;
  for (const auto& [label, part] : Volumes(mesh))
  {
    volume += part;
  }
  return volume;
}

/** The mesh of an image is sound, and the statistics say that all bad ridges went. @return how many were opened */
template <int D>
std::uint64_t ExpectRidgesOpened(
  const LabelImage<D>& image, const MeshingOptions<D>& options, SimplexMesh<D>& mesh)
{
  MeshingStatistics statistics;
  mesh = MeshOf(image, options, &statistics);
  ExpectSound(mesh);
  const InterfaceStatistics& figures = statistics.Interfaces;
  EXPECT_EQ(figures.NonManifoldLeft, 0u);
  EXPECT_LE(figures.NonManifoldOpened, figures.NonManifoldRepaired);
  return figures.NonManifoldOpened;
}

} // namespace voxplex::checks

#endif
