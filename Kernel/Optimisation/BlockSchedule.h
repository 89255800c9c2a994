// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BlockSchedule.h
 * @brief Has several threads change a complex, each in a block of it.
 */
#ifndef voxplex_BlockSchedule_h
#define voxplex_BlockSchedule_h

#include "Geometry/SimplexQuality.h"
#include "Geometry/Tiles.h"
#include "Optimisation/Patch.h"
#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <stop_token>
#include <utility>
#include <vector>

namespace voxplex
{

/**
 * @brief Has tasks done on parts of a complex (Patch), in blocks of its vertices.
 *
 * Space is cut where little work is in the way (TileCutter), and the vertices of each tile are a block. Work that
 * reaches across a plane is put off. The planes of the next tiling are elsewhere, so that it can be done
 * then; at last all of the complex is one block. Blocks depend on the complex and the work alone, so
 * the result does not depend on the number of threads.
 *
 * Not thread safe; uses threads of its own.
 */
template <int D>
class BlockSchedule
{
public:
  using Vertices = typename Complex<D>::Vertices;

  /** Slots for more cells, and vertices, that a block gets for each piece of work. */
  struct Spare
  {
    std::size_t Cells = 1;
    std::size_t Vertices = 0;
  };

  /**
   * @param complex all of its cells in use. It and `stop` must outlive this object.
   * @param threads 0 means all cores
   */
  BlockSchedule(Complex<D>& complex, unsigned threads, const std::stop_token& stop)
    : Mesh(complex)
    , Threads(threads)
    , Stop(stop)
  {
    this->Bounds.Min.fill(std::numeric_limits<double>::max());
    this->Bounds.Max.fill(std::numeric_limits<double>::lowest());
    for (const Point<D>& p : complex.Points)
    {
      for (std::size_t a = 0; a < D; ++a)
      {
        this->Bounds.Min[a] = std::min(this->Bounds.Min[a], p[a]);
        this->Bounds.Max[a] = std::max(this->Bounds.Max[a], p[a]);
      }
    }
  }

  /**
   * Does all work, tiling after tiling.
   *
   * @param work numbers of cells, or of what itemOf() knows
   * @param itemOf itemOf(number) gives the place of a piece of work, and how far it may reach; none if there is
   *   nothing to do any more
   * @param task task(patch, numbers) does the work of a block, from several threads
   * @throws Cancelled if a stop was requested before the end; std::bad_alloc
   */
  template <typename ItemOf, typename Task>
  void RunInTiles(
    std::vector<std::uint32_t> work, const ItemOf& itemOf, Spare spare, const Task& task)
  {
    for (unsigned tilings = 0; !work.empty(); ++tilings)
    {
      std::vector<TileItem<D>> items;
      for (const std::uint32_t number : work)
      {
        if (const std::optional<TileItem<D>> item = itemOf(number))
        {
          items.push_back(*item);
        }
      }
      Tiling<D> tiling = tilings < MostTilings
        ? TileCutter<D>::Cut(std::move(items), this->Bounds, Limits)
        : TileCutter<D>::Whole(items);
      work.clear();
      std::vector<std::vector<std::uint32_t>> inside;
      for (Tile<D>& tile : tiling.Tiles)
      {
        inside.push_back(std::move(tile.Inside));
        work.insert(work.end(), tile.Across.begin(), tile.Across.end());
      }
      std::sort(work.begin(), work.end());
      this->RunInBlocks(this->BlocksOf(tiling), inside, spare, task);
    }
  }

  /**
   * The same in given blocks.
   * @param blocks the block of each vertex; empty: there is one
   * @param work of each block
   */
  template <typename Task>
  void RunInBlocks(std::vector<std::uint32_t> blocks,
    const std::vector<std::vector<std::uint32_t>>& work, Spare spare, const Task& task)
  {
    const std::size_t number = work.size();
    std::vector<std::size_t> slots{ 0 }; // the first of each block, and the end
    std::vector<std::uint32_t> vertices{ static_cast<std::uint32_t>(this->Mesh.Points.size()) };
    for (std::uint32_t b = 0; b < number; ++b)
    {
      slots.push_back(
        slots.back() + (work[b].empty() ? 0 : spare.Cells * work[b].size() + FewestSlots));
      vertices.push_back(
        vertices.back() + static_cast<std::uint32_t>(spare.Vertices * work[b].size()));
      blocks.resize(blocks.empty() ? 0 : vertices.back(), b);
    }
    this->Mesh.AddVertices(vertices.back() - vertices.front());
    Patch<D> whole(this->Mesh, {}, 0);
    whole.SetSlots(std::move(this->Slots));
    whole.NeedSlots(slots.back());
    this->Slots = whole.TakeSlots();
    // The block with most work is not the last to begin.
    std::vector<std::uint32_t> order(number);
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(),
      [&](std::uint32_t a, std::uint32_t b) { return work[a].size() > work[b].size(); });
    std::vector<std::vector<std::uint32_t>> slotsLeft(number);
    std::vector<std::uint32_t> clocks(number, this->Clock);
    ParallelTasks(
      number, this->Threads,
      [&](std::size_t k)
      {
        const std::uint32_t b = order[k];
        if (work[b].empty())
        {
          return;
        }
        Patch<D> patch(this->Mesh, blocks, b);
        patch.Clock = this->Clock;
        patch.SetSlots({ this->Slots.begin() + static_cast<std::ptrdiff_t>(slots[b]),
          this->Slots.begin() + static_cast<std::ptrdiff_t>(slots[b + 1]) });
        patch.SetSpareVertices(vertices[b], vertices[b + 1]);
        task(patch, std::span<const std::uint32_t>(work[b]));
        slotsLeft[b] = patch.TakeSlots();
        clocks[b] = patch.Clock;
      },
      this->Stop);
    this->Slots.erase(
      this->Slots.begin(), this->Slots.begin() + static_cast<std::ptrdiff_t>(slots.back()));
    for (const std::vector<std::uint32_t>& left : slotsLeft)
    {
      this->Slots.insert(this->Slots.end(), left.begin(), left.end());
    }
    this->Clock = std::accumulate(clocks.begin(), clocks.end(), this->Clock,
                    [](std::uint32_t a, std::uint32_t b) { return std::max(a, b); }) +
      1;
  }

  /**
   * The place of a cell, and how far its corners are. A vertex with a twin moves with it, so that work on it is done
   * in a block of everything.
   */
  TileItem<D> ItemOf(std::uint32_t t) const
  {
    const Vertices& v = this->Mesh.Cells[t].V;
    TileItem<D> item{ Centroid(this->Mesh.PointsOf(v)), 0.0, t };
    for (const std::uint32_t w : v)
    {
      item.Reach =
        std::max(item.Reach, this->ReachOf(w, Distance(this->Mesh.Points[w], item.Place)));
    }
    return item;
  }

  /** How far work on a vertex reaches, if it has no twin. */
  double ReachOf(std::uint32_t v, double alone) const
  {
    return this->Mesh.TwinOf(v) == Complex<D>::None ? alone
                                                    : std::numeric_limits<double>::infinity();
  }

private:
  /** Pentatopes take longer than tetrahedra, and more of them are in the way of a plane. */
  static constexpr TileLimits<D> Limits = { D == 3 ? 512u : 64u, D == 3 ? 0.25 : 0.4,
    D == 3 ? 5u : 3u };
  static constexpr unsigned MostTilings = 8; ///< little work is left then
  static constexpr std::size_t FewestSlots = 64;

  /** The tile of each vertex; empty if there is one. */
  std::vector<std::uint32_t> BlocksOf(const Tiling<D>& tiling) const
  {
    constexpr std::size_t Grain = 16384;
    std::vector<std::uint32_t> blocks(tiling.Tiles.size() > 1 ? this->Mesh.Points.size() : 0);
    ParallelFor(
      0, blocks.size(), Grain, this->Threads,
      [&](std::size_t first, std::size_t end)
      {
        for (std::size_t v = first; v < end; ++v)
        {
          blocks[v] = tiling.TileAt(this->Mesh.Points[v]);
        }
      },
      this->Stop);
    return blocks;
  }

  Complex<D>& Mesh;
  const unsigned Threads;
  const std::stop_token& Stop;
  Box<D> Bounds;                    ///< of the points
  std::vector<std::uint32_t> Slots; ///< of cells that are not in use
  std::uint32_t Clock = 1;          ///< of the next patches
};

} // namespace voxplex

#endif
