// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RegionalWork.h
 * @brief Counts the insertions of each region, so that the work in a region is bounded.
 */
#ifndef voxplex_RegionalWork_h
#define voxplex_RegionalWork_h

#include "Base/MixBits.h"
#include "Geometry/Point.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstdint>
#include <memory>

namespace voxplex
{

/**
 * How far the rules give way in a region that has taken many times the usual work. Each step
 * includes those before it.
 */
enum class Relaxation : unsigned
{
  Nothing,
  Slivers, ///< slivers stay, and the facet rule of 4D inserts centres of surface balls only
  Spacing, ///< points inserted for the sake of facets keep half the spacing instead of a tenth
  All      ///< only the sample spacing rule inserts points, and nothing is removed
};

/**
 * The step for a number of insertions counted in a region. No region should need `limit`
 * insertions.
 */
constexpr Relaxation RelaxationAfter(std::uint32_t work, std::uint32_t limit)
{
  return work < limit  ? Relaxation::Nothing
    : work < 2 * limit ? Relaxation::Slivers
    : work < 4 * limit ? Relaxation::Spacing
                       : Relaxation::All;
}

/**
 * @brief The number of points that were inserted in each region since the start of refinement.
 *
 * Let S be the spacing at a point (SizingField::Spacing). The point's region is a cell of a grid.
 * The side of its cells is above 2.5 S and at most 3 S, and is 3 times a power of 2^(1/4). So a
 * region has room for a bounded number of vertices that keep the distance S. If S is the same
 * everywhere, the number of regions is at most about the volume of the box over (2.5 S)^D.
 *
 * Counts are kept in a table without keys. A region has two entries in it, and the smaller one is
 * its count. Two regions that share both entries are counted as one. So the count of a region is
 * never too small, and rarely too large.
 *
 * Any number of threads may call all methods at once. Each takes constant time.
 */
template <int D>
class RegionalWork
{
public:
  /**
   * @param expected the expected number of vertices; with more vertices counts are too large more
   *   often
   */
  explicit RegionalWork(std::uint64_t expected)
  {
    constexpr std::uint64_t Fewest = std::uint64_t{ 1 } << 14;
    constexpr std::uint64_t Most = std::uint64_t{ 1 } << 22;
    const std::uint64_t entries = std::bit_ceil(std::clamp(expected, Fewest, Most));
    this->Mask = entries - 1;
    this->Counts = std::make_unique<std::atomic<std::uint32_t>[]>(entries); // zeros
  }

  /** Identifies a region. */
  using Region = std::uint64_t;

  /** Counts insertions. Returns the number that was counted before in the region. */
  std::uint32_t Add(Region region, std::uint32_t insertions = 1)
  {
    const std::uint32_t a = this->Entry(region).fetch_add(insertions, std::memory_order_relaxed);
    const std::uint32_t b =
      this->Entry(region >> 32).fetch_add(insertions, std::memory_order_relaxed);
    return std::min(a, b);
  }

  /** The number of insertions that were counted in a region. */
  std::uint32_t At(Region region) const
  {
    return std::min(this->Entry(region).load(std::memory_order_relaxed),
      this->Entry(region >> 32).load(std::memory_order_relaxed));
  }

  /** The region of a point. @param spacing at the point */
  static Region RegionOf(const Point<D>& place, double spacing)
  {
    const double step = std::floor(4.0 * std::log2(spacing));
    const double cells = std::exp2(-0.25 * step) / 3.0; // per unit of length
    std::uint64_t hash =
      MixBits(GoldenGamma + static_cast<std::uint64_t>(static_cast<std::int64_t>(step)));
    for (const double x : place)
    {
      const auto cell = static_cast<std::int64_t>(std::floor(x * cells));
      hash = MixBits(hash + static_cast<std::uint64_t>(cell));
    }
    return hash;
  }

private:
  std::atomic<std::uint32_t>& Entry(std::uint64_t hash) const
  {
    return this->Counts[(hash & 0xffffffffu) & this->Mask];
  }

  std::uint64_t Mask = 0;
  std::unique_ptr<std::atomic<std::uint32_t>[]> Counts;
};

} // namespace voxplex

#endif
