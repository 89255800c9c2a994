// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FeatureGrid.h
 * @brief Finds feature vertices near a point.
 */
#ifndef voxplex_FeatureGrid_h
#define voxplex_FeatureGrid_h

#include "Base/GridIndex.h"
#include "Delaunay/ChunkedArray.h"
#include "Geometry/Point.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>

namespace voxplex
{

/**
 * @brief Feature vertices, hashed by the cells of uniform grids. Refinement adds vertices and never
 * removes one.
 *
 * There are grids of several levels, each finer than the one before, and every vertex is in all of
 * them. A query takes the finest grid whose cells are at least twice as wide as its radius. So it
 * visits at most 2^D cells, or more if its radius is larger than that of the first level. Queries
 * are quick even where vertices are much nearer to each other than elsewhere, as around parts that
 * are small compared with delta. Every cell is a list whose head is in a table of fixed size.
 *
 * Any number of threads may call all methods except Remove() at once. A query sees every vertex
 * that was added before it began. No thread ever waits for another.
 */
template <int D>
class FeatureGrid
{
public:
  static constexpr std::size_t Levels = 4; ///< the most that a grid has

  /**
   * @param radius queries up to this radius visit few cells; larger ones are correct but slower
   * @param expected the expected number of vertices; with more vertices queries are correct but
   *   slower
   * @param levels 1 ... Levels; with fewer, queries with small radii visit more vertices
   */
  FeatureGrid(
    const Point<D>& origin, double radius, std::uint64_t expected, std::size_t levels = Levels)
    : Origin(origin)
    , NumberOfLevels(levels)
  {
    for (std::size_t level = 0; level < levels; ++level)
    {
      this->Radius[level] = radius;
      this->InverseCell[level] = 0.5 / radius;
      radius /= LevelFactor;
    }
    const std::uint64_t buckets =
      std::bit_ceil(std::clamp<std::uint64_t>(expected / 2, FewestBuckets, MostBuckets));
    this->Mask = static_cast<std::uint32_t>(buckets - 1);
    this->Heads.reset(new std::atomic<std::uint32_t>[levels * buckets]);
    for (std::uint64_t b = 0; b < levels * buckets; ++b)
    {
      this->Heads[b].store(End, std::memory_order_relaxed);
    }
  }

  void Add(const Point<D>& p)
  {
    const std::uint32_t n = this->Count.fetch_add(1, std::memory_order_relaxed);
    this->Nodes.Grow(n + 1);
    Node& node = this->Nodes[n];
    node.Position = p;
    for (std::size_t level = 0; level < this->NumberOfLevels; ++level)
    {
      std::atomic<std::uint32_t>& head = this->HeadOf(this->CellOf(p, level), level);
      node.Next[level] = head.load(std::memory_order_relaxed);
      while (!head.compare_exchange_weak(
        node.Next[level], n, std::memory_order_release, std::memory_order_relaxed))
      {
      }
    }
  }

  /**
   * Removes a vertex that was added with exactly this position. No other thread may use the grid
   * meanwhile.
   * @return false if there is none
   */
  bool Remove(const Point<D>& p)
  {
    const std::size_t finest = this->NumberOfLevels - 1;
    std::uint32_t n = this->HeadOf(this->CellOf(p, finest), finest).load(std::memory_order_relaxed);
    while (n != End && this->Nodes[n].Position != p)
    {
      n = this->Nodes[n].Next[finest];
    }
    if (n != End)
    {
      this->Nodes[n].Position.fill(std::numeric_limits<double>::infinity()); // no query finds it
    }
    return n != End;
  }

  /** True if a vertex is nearer to p than `distance`. */
  bool AnyWithin(const Point<D>& p, double distance) const
  {
    return this->FindWithin(p, distance) != nullptr;
  }

  /** A vertex nearer to p than `distance`, or null if there is none. The pointer stays valid. */
  const Point<D>* FindWithin(const Point<D>& p, double distance) const
  {
    std::size_t level = this->NumberOfLevels - 1;
    while (level > 0 && distance > this->Radius[level])
    {
      --level;
    }
    const double distance2 = distance * distance;
    const Cell centre = this->CellOf(p, level);
    if (const Point<D>* const found = this->FindInCell(centre, level, p, distance2))
    {
      return found;
    }
    if (distance > this->Radius[level])
    {
      return this->FindInCells(p, distance);
    }
    // Along each axis the ball reaches into at most one of the two neighbouring cells.
    std::array<std::int64_t, static_cast<std::size_t>(D)> step;
    for (unsigned a = 0; a < static_cast<unsigned>(D); ++a)
    {
      const double low = this->CellAlong(a, p[a] - distance, level);
      const double high = this->CellAlong(a, p[a] + distance, level);
      step[a] = low < static_cast<double>(centre[a]) ? -1
        : high > static_cast<double>(centre[a])      ? 1
                                                     : 0;
    }
    for (std::uint32_t set = 1; set < (1u << D); ++set)
    {
      Cell cell = centre;
      bool reached = true;
      for (unsigned a = 0; a < static_cast<unsigned>(D); ++a)
      {
        if ((set >> a) & 1u)
        {
          reached &= step[a] != 0;
          cell[a] += step[a];
        }
      }
      if (!reached)
      {
        continue;
      }
      if (const Point<D>* const found = this->FindInCell(cell, level, p, distance2))
      {
        return found;
      }
    }
    return nullptr;
  }

  /** Frees all memory. Afterwards the grid cannot be used any more. */
  void Release()
  {
    this->Heads.reset();
    this->Nodes.Clear();
  }

  /** The number of vertices that were added. */
  std::uint32_t Size() const { return this->Count.load(std::memory_order_relaxed); }

private:
  static constexpr std::uint32_t End = 0xffffffffu;
  /** Ratio of the radii of successive levels. */
  static constexpr double LevelFactor = 5.0;
  static constexpr std::uint64_t FewestBuckets = 1u << 14; ///< of one level
  static constexpr std::uint64_t MostBuckets = 1u << 22;
  using Cell = std::array<std::int64_t, static_cast<std::size_t>(D)>;
  struct Node
  {
    Point<D> Position;
    std::array<std::uint32_t, Levels> Next;
  };

  double CellAlong(unsigned axis, double x, std::size_t level) const
  {
    return std::floor((x - this->Origin[axis]) * this->InverseCell[level]);
  }

  Cell CellOf(const Point<D>& p, std::size_t level) const
  {
    Cell cell;
    for (unsigned a = 0; a < static_cast<unsigned>(D); ++a)
    {
      cell[a] = static_cast<std::int64_t>(this->CellAlong(a, p[a], level));
    }
    return cell;
  }

  // Neighbouring cells of a row share cache lines.
  std::atomic<std::uint32_t>& HeadOf(const Cell& cell, std::size_t level) const
  {
    std::uint64_t h = static_cast<std::uint64_t>(cell[0]);
    std::uint64_t k = 0x9e3779b97f4a7c15ull;
    for (unsigned a = 1; a < static_cast<unsigned>(D); ++a)
    {
      h += (static_cast<std::uint64_t>(cell[a]) * k) >> 20;
      k *= 0xc2b2ae3d27d4eb4full;
    }
    return this->Heads[level * (this->Mask + std::size_t{ 1 }) + (h & this->Mask)];
  }

  /** Searches all cells of the first level that the ball may reach. */
  const Point<D>* FindInCells(const Point<D>& p, double distance) const
  {
    Cell low;
    Cell high;
    for (unsigned a = 0; a < static_cast<unsigned>(D); ++a)
    {
      low[a] = static_cast<std::int64_t>(this->CellAlong(a, p[a] - distance, 0));
      high[a] = static_cast<std::int64_t>(this->CellAlong(a, p[a] + distance, 0));
    }
    const Point<D>* found = nullptr;
    ForEachIndex(low, high,
      [&](const Cell& cell)
      { found = found ? found : this->FindInCell(cell, 0, p, distance * distance); });
    return found;
  }

  const Point<D>* FindInCell(
    const Cell& cell, std::size_t level, const Point<D>& p, double distance2) const
  {
    for (std::uint32_t n = this->HeadOf(cell, level).load(std::memory_order_acquire); n != End;
         n = this->Nodes[n].Next[level])
    {
      if (Distance2(this->Nodes[n].Position, p) < distance2)
      {
        return &this->Nodes[n].Position;
      }
    }
    return nullptr;
  }

  Point<D> Origin;
  std::size_t NumberOfLevels;
  std::array<double, Levels> Radius;
  std::array<double, Levels> InverseCell;
  std::uint32_t Mask = 0;
  std::unique_ptr<std::atomic<std::uint32_t>[]> Heads;
  ChunkedArray<Node> Nodes;
  std::atomic<std::uint32_t> Count{ 0 };
};

} // namespace voxplex

#endif
