// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Repairs of all bad ridges of a triangulation.
#ifndef voxplex_RepairTesting_h
#define voxplex_RepairTesting_h

#include "Conformity/InterfaceVertices.h"
#include "Conformity/ManifoldLabels.h"
#include "Conformity/ManifoldRepair.h"

#include <cstddef>
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

} // namespace voxplex::checks

#endif
