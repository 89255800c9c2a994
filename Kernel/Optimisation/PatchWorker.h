// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PatchWorker.h
 * @brief One thread's passes over the poor cells of a patch.
 */
#ifndef voxplex_PatchWorker_h
#define voxplex_PatchWorker_h

#include "Optimisation/Patch.h"
#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stop_token>
#include <vector>

namespace voxplex
{

/** Conditions that end optimisation. */
struct OptimisationLimits
{
  std::stop_token Stop;
  std::chrono::steady_clock::time_point Deadline = std::chrono::steady_clock::time_point::max();

  bool OutOfTime() const { return std::chrono::steady_clock::now() >= this->Deadline; }
};

/**
 * @brief Has poor cells of a patch improved, one after the other.
 *
 * Improver has a function bool Improve(t). It tells whether it has changed the mesh, so that the
 * poor cell t is better, or gone.
 */
template <int D, typename Improver>
class PatchWorker
{
public:
  /** All must outlive this object. @param cells to work on, in this order */
  PatchWorker(Patch<D>& patch, Improver& improver, const OptimisationLimits& limits,
    std::span<const std::uint32_t> cells)
    : Target(patch)
    , How(improver)
    , Limits(limits)
  {
    for (const std::uint32_t t : cells)
    {
      this->Work.push_back({ t, 0 });
    }
  }

  /**
   * Works on every cell that was given or has become poor. Skips those that were tried and whose
   * vertices' cells have not changed since.
   * @return the number of cells that were improved
   * @throws Cancelled
   */
  std::size_t Pass()
  {
    std::size_t better = 0;
    std::vector<Task> left;
    // A cell that becomes poor in this pass is appended and tried in this pass, too. The number of
    // tries is limited.
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
      if (!this->Target.Mesh().IsPoor(task.Id))
      {
        continue;
      }
      if (!this->HasChanged(task))
      {
        left.push_back(task);
      }
      else if (this->How.Improve(task.Id))
      {
        ++better;
        for (const std::uint32_t t : this->Target.Poor)
        {
          this->Work.push_back({ t, 0 });
        }
        this->Target.Poor.clear();
        left.push_back({ task.Id, 0 });
      }
      else
      {
        left.push_back({ task.Id, this->Target.Clock });
      }
    }
    // Keep each cell once; if one of its entries was tried, keep that entry.
    std::sort(left.begin(), left.end(),
      [](const Task& a, const Task& b)
      { return a.Id < b.Id || (a.Id == b.Id && a.Tried > b.Tried); });
    this->Work.clear();
    for (const Task& task : left)
    {
      if (this->Target.Mesh().IsPoor(task.Id) &&
        (this->Work.empty() || this->Work.back().Id != task.Id))
      {
        this->Work.push_back(task);
      }
    }
    return better;
  }

  /** The cells that are poor after the last pass, ascending. */
  std::vector<std::uint32_t> Left() const
  {
    std::vector<std::uint32_t> cells;
    for (const Task& task : this->Work)
    {
      cells.push_back(task.Id);
    }
    return cells;
  }

private:
  struct Task
  {
    std::uint32_t Id;
    std::uint32_t Tried; ///< the patch's clock at the last try; 0: never tried
  };

  /** The number of cells between two checks of the limits. */
  static constexpr std::size_t LimitPeriod = 16;

  bool HasChanged(const Task& task) const
  {
    const Complex<D>& mesh = this->Target.Mesh();
    const auto& v = mesh.Cells[task.Id].V;
    return task.Tried == 0 ||
      std::any_of(
        v.begin(), v.end(), [&](std::uint32_t w) { return mesh.Changes[w] > task.Tried; });
  }

  Patch<D>& Target;
  Improver& How;
  const OptimisationLimits& Limits;
  std::vector<Task> Work;
};

} // namespace voxplex

#endif
