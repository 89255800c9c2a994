// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Conformity/ManifoldRepair.h"

#include "Conformity/OrderedChanges.h"
#include "Conformity/RidgeRepair.h"

#include <utility>

namespace voxplex
{

template <int D>
ManifoldRepairResult<D> RepairManifold(const Triangulation<D>& triangulation,
  std::span<LabelId> labels, const std::vector<InterfaceRidge<D>>& ridges,
  const ManifoldRepairOptions<D>& options, unsigned threads, const std::stop_token& stop)
{
  if (ridges.empty())
  {
    return {};
  }
  const auto makeFinder = [&] { return repair::RidgeRepair<D>(triangulation, labels, options); };
  repair::OrderedChanges<D> changes(triangulation, labels, ridges.size(), threads, stop);
  // A change may make another one possible.
  while (changes.Pass(makeFinder,
    [&](const repair::RidgeRepair<D>& finder, std::size_t r)
    { return finder.Propose(ridges[r].Vertices); }))
  {
  }
  std::vector<SimplexId> changed(changes.GetChanged().begin(), changes.GetChanged().end());
  std::vector<InterfaceRidge<D>> left = makeFinder().FindLeft(ridges, changed);
  return { std::move(left), std::move(changed) };
}

template ManifoldRepairResult<3> RepairManifold<3>(const Triangulation<3>&, std::span<LabelId>,
  const std::vector<InterfaceRidge<3>>&, const ManifoldRepairOptions<3>&, unsigned,
  const std::stop_token&);
template ManifoldRepairResult<4> RepairManifold<4>(const Triangulation<4>&, std::span<LabelId>,
  const std::vector<InterfaceRidge<4>>&, const ManifoldRepairOptions<4>&, unsigned,
  const std::stop_token&);

} // namespace voxplex
