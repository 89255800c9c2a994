// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Optimisation/Tetrahedra/PatchWorker.h"

#include "Parallel/ParallelFor.h"

#include <algorithm>

namespace voxplex
{

namespace
{

/** The number of tetrahedra between two checks of the limits. */
constexpr std::size_t LimitPeriod = 64;

} // namespace

//------------------------------------------------------------------------------------------------
std::size_t PatchWorker::Pass(Effort effort)
{
  std::size_t better = 0;
  std::vector<Task> left;
  // A tetrahedron that becomes poor in this pass is appended and tried in this pass, too. The
  // number of tries is limited.
  const std::size_t most = 4 * this->Work.size() + 1000;
  for (std::size_t k = 0; k < this->Work.size(); ++k)
  {
    if (k % LimitPeriod == 0)
    {
      ThrowIfStopped(this->Limits.Stop);
      if (k > most || this->Limits.OutOfTime())
      {
        left.insert(
          left.end(), this->Work.begin() + static_cast<std::ptrdiff_t>(k), this->Work.end());
        break;
      }
    }
    const Task task = this->Work[k];
    if (!this->IsPoor(task.Cell))
    {
      continue;
    }
    if (!this->HasChanged(task))
    {
      left.push_back(task);
    }
    else if (this->Improve(task.Cell, effort))
    {
      ++better;
      for (const std::uint32_t t : this->Target.Poor)
      {
        this->Work.push_back({ t, 0 });
      }
      this->Target.Poor.clear();
      left.push_back({ task.Cell, 0 });
    }
    else
    {
      left.push_back({ task.Cell, this->Target.Clock });
    }
  }
  // Keep each tetrahedron once; if one of its entries was tried, keep that entry.
  std::sort(left.begin(), left.end(),
    [](const Task& a, const Task& b)
    { return a.Cell < b.Cell || (a.Cell == b.Cell && a.Tried > b.Tried); });
  this->Work.clear();
  for (const Task& task : left)
  {
    if (this->IsPoor(task.Cell) && (this->Work.empty() || this->Work.back().Cell != task.Cell))
    {
      this->Work.push_back(task);
    }
  }
  return better;
}

bool PatchWorker::HasChanged(const Task& task) const
{
  const auto& v = this->Mesh.Cells[task.Cell].V;
  return task.Tried == 0 ||
    std::any_of(
      v.begin(), v.end(), [&](std::uint32_t w) { return this->Mesh.Changes[w] > task.Tried; });
}

bool PatchWorker::Improve(std::uint32_t t, Effort effort)
{
  if (this->Topology.Improve(t))
  {
    return true;
  }
  bool better = false;
  const auto vertices = this->Mesh.Cells[t].V; // smoothing only moves them
  for (const std::uint32_t v : vertices)
  {
    better = this->Geometry.Improve(v) || better;
    if (!this->IsPoor(t))
    {
      return true;
    }
  }
  return better || (effort != Effort::Plain && this->ImproveAsLastResort(t, effort));
}

bool PatchWorker::ImproveAsLastResort(std::uint32_t t, Effort effort)
{
  for (unsigned i = 0; i < 4; ++i)
  {
    for (unsigned j = 0; j < i; ++j)
    {
      if (this->Geometry.Insert(t, j, i))
      {
        return true;
      }
    }
  }
  if (this->Geometry.InsertInside(t))
  {
    return true;
  }
  bool better = false;
  if (effort == Effort::MovesOffInterfaces)
  {
    const auto vertices = this->Mesh.Cells[t].V;
    for (const std::uint32_t v : vertices)
    {
      better = this->Geometry.MoveOffInterface(v) || better;
      if (!this->IsPoor(t))
      {
        break;
      }
    }
  }
  return better;
}

void PatchWorker::TryAllAgain()
{
  for (Task& task : this->Work)
  {
    task.Tried = 0;
  }
}

std::vector<std::uint32_t> PatchWorker::Left() const
{
  std::vector<std::uint32_t> cells;
  for (const Task& task : this->Work)
  {
    cells.push_back(task.Cell);
  }
  return cells;
}

} // namespace voxplex
