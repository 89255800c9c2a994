// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Tiles.h
 * @brief Cuts space into tiles where little work is in the way.
 */
#ifndef voxplex_Tiles_h
#define voxplex_Tiles_h

#include "Geometry/Box.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace voxplex
{

/** A piece of work on a part of a mesh. */
template <int D>
struct TileItem
{
  Point<D> Place; ///< the item belongs to the tile that contains this point
  double Reach;   ///< radius of the ball around it that the work is about
  std::uint32_t Number;
};

/** A part of space, and the numbers of the items in it, ascending. */
template <int D>
struct Tile
{
  HalfOpenBox<D> Extent;             ///< infinite where no plane cuts
  std::vector<std::uint32_t> Inside; ///< items whose balls are in the tile
  std::vector<std::uint32_t> Across; ///< items whose balls meet another tile
};

/** All of space, cut into tiles. */
template <int D>
struct Tiling
{
  /** A plane, and what is on both sides: the number of another one; or of a tile, if the highest bit is set. */
  struct Plane
  {
    std::size_t Axis;
    double Place;
    std::array<std::uint32_t, 2> Sides;
  };
  static constexpr std::uint32_t IsTile = 0x80000000u;

  /** The tile that contains a point. Takes the time of one comparison for each level. */
  std::uint32_t TileAt(const Point<D>& p) const
  {
    std::uint32_t at = this->Planes.empty() ? IsTile : 0;
    while ((at & IsTile) == 0)
    {
      const Plane& plane = this->Planes[at];
      at = plane.Sides[p[plane.Axis] < plane.Place ? 0 : 1];
    }
    return at & ~IsTile;
  }

  std::vector<Tile<D>> Tiles;
  std::vector<Plane> Planes; ///< that of all space is the first one
};

/** When space is not cut any further. */
template <int D>
struct TileLimits
{
  std::size_t FewestItems = 512; ///< a part with fewer items is not cut
  /** The largest fraction of a part's items whose balls meet the plane. */
  double MostInTheWay = D == 3 ? 0.25 : 0.3;
  unsigned MostCuts = 5; ///< one within the other: there are at most 2^MostCuts tiles
};

/**
 * @brief Cuts space by planes across the axes, as a k-d tree does.
 *
 * A plane is chosen that meets the fewest balls of items, and has enough items on both sides. An
 * item whose ball meets a plane can probably not be done in a tile. So if the items were put off
 * because of the planes of one tiling, the planes of the next tiling are elsewhere.
 *
 * Every point of space is in exactly one tile. The tiles depend on the items alone.
 */
template <int D>
class TileCutter
{
public:
  /** One tile: all of space. */
  static Tiling<D> Whole(const std::vector<TileItem<D>>& items)
  {
    Tiling<D> tiling;
    AddTile(items.begin(), items.end(), Space(), tiling);
    return tiling;
  }

  /**
   * Takes O(items) for each level of the tree.
   * @param box all planes cut it; items may be anywhere, as circumcentres of flat simplices are
   */
  static Tiling<D> Cut(
    std::vector<TileItem<D>> items, const Box<D>& box, const TileLimits<D>& limits = {})
  {
    Tiling<D> tiling;
    Cut(items.begin(), items.end(), Space(), box, limits, limits.MostCuts, tiling);
    return tiling;
  }

  /** If most items reach less far than this, Cut() makes at least two tiles. */
  static double LargestReach(const std::vector<TileItem<D>>& items, const Box<D>& box)
  {
    const auto [low, high] = Bounds(items.begin(), items.end(), box);
    double extent = 0.0;
    for (std::size_t a = 0; a < D; ++a)
    {
      extent = std::max(extent, high[a] - low[a]);
    }
    return 0.5 * TileLimits<D>().MostInTheWay * extent;
  }

private:
  using Iterator = typename std::vector<TileItem<D>>::iterator;
  using ConstIterator = typename std::vector<TileItem<D>>::const_iterator;

  /** With more items, a plane is chosen by some of them. */
  static constexpr std::ptrdiff_t MostLookedAt = 2048;
  /** Planes that are tried across each axis. */
  static constexpr std::size_t Planes = 64;

  struct Plane
  {
    std::size_t Axis = 0;
    double Place = 0.0;
    std::size_t Cost = std::numeric_limits<std::size_t>::max();
  };

  static HalfOpenBox<D> Space()
  {
    HalfOpenBox<D> space;
    space.Min.fill(-std::numeric_limits<double>::infinity());
    space.Max.fill(std::numeric_limits<double>::infinity());
    return space;
  }

  /** Of the items' places, moved into a box. */
  static std::pair<Point<D>, Point<D>> Bounds(
    ConstIterator first, ConstIterator last, const Box<D>& box, std::ptrdiff_t stride = 1)
  {
    std::pair<Point<D>, Point<D>> bounds{ box.Clamp(first->Place), box.Clamp(first->Place) };
    for (std::ptrdiff_t i = 0; i < last - first; i += stride)
    {
      const Point<D> place = box.Clamp((first + i)->Place);
      for (std::size_t a = 0; a < D; ++a)
      {
        bounds.first[a] = std::min(bounds.first[a], place[a]);
        bounds.second[a] = std::max(bounds.second[a], place[a]);
      }
    }
    return bounds;
  }

  /** @return the number of a plane or tile, as in Tiling::Plane::Sides */
  static std::uint32_t Cut(Iterator first, Iterator last, const HalfOpenBox<D>& extent,
    const Box<D>& box, const TileLimits<D>& limits, unsigned cuts, Tiling<D>& tiling)
  {
    const auto count = static_cast<std::size_t>(last - first);
    const Plane plane = cuts > 0 && count >= limits.FewestItems
      ? BestPlane(first, last, box, limits.MostInTheWay)
      : Plane();
    if (plane.Cost == Plane().Cost)
    {
      return AddTile(first, last, extent, tiling);
    }
    const Iterator middle = std::partition(first, last,
      [&plane](const TileItem<D>& item) { return item.Place[plane.Axis] < plane.Place; });
    HalfOpenBox<D> lower = extent;
    HalfOpenBox<D> upper = extent;
    lower.Max[plane.Axis] = plane.Place;
    upper.Min[plane.Axis] = plane.Place;
    const auto number = static_cast<std::uint32_t>(tiling.Planes.size());
    tiling.Planes.push_back({ plane.Axis, plane.Place, {} });
    const std::uint32_t below = Cut(first, middle, lower, box, limits, cuts - 1, tiling);
    const std::uint32_t above = Cut(middle, last, upper, box, limits, cuts - 1, tiling);
    tiling.Planes[number].Sides = { below, above };
    return number;
  }

  /**
   * The plane for which the larger side and the items in the way are fewest together. Its cost is
   * the largest number if there are too many in the way of every plane.
   */
  static Plane BestPlane(
    ConstIterator first, ConstIterator last, const Box<D>& box, double mostInTheWay)
  {
    const auto stride = (last - first) / MostLookedAt + 1;
    const auto count = static_cast<std::size_t>((last - first - 1) / stride + 1);
    const auto most = static_cast<std::size_t>(mostInTheWay * static_cast<double>(count));
    const auto [low, high] = Bounds(first, last, box, stride);
    Plane best;
    for (std::size_t a = 0; a < D; ++a)
    {
      const double step = (high[a] - low[a]) / static_cast<double>(Planes + 1);
      const auto cellOf = [&, begin = low[a]](double x) // the number of planes below x
      {
        const double cell = std::ceil((x - begin) / step) - 1.0;
        return static_cast<std::size_t>(std::clamp(cell, 0.0, static_cast<double>(Planes)));
      };
      if (!(step > 0.0))
      {
        continue;
      }
      std::array<std::size_t, Planes + 2> below{};   // items in a cell; then, below its upper plane
      std::array<std::size_t, Planes + 2> entered{}; // balls that begin in a cell; then, so far
      std::array<std::size_t, Planes + 2> left{};    // balls that end in a cell; then, so far
      for (std::ptrdiff_t i = 0; i < last - first; i += stride)
      {
        const ConstIterator item = first + i;
        ++below[cellOf(item->Place[a])];
        ++entered[cellOf(item->Place[a] - item->Reach)];
        ++left[cellOf(item->Place[a] + item->Reach)];
      }
      for (std::size_t k = 0; k < Planes; ++k)
      {
        below[k + 1] += below[k];
        entered[k + 1] += entered[k];
        left[k + 1] += left[k];
        const std::size_t inTheWay = entered[k] - left[k];
        const std::size_t cost = std::max(below[k], count - below[k]) + inTheWay;
        if (inTheWay <= most && cost < best.Cost)
        {
          best = { a, low[a] + static_cast<double>(k + 1) * step, cost };
        }
      }
    }
    return best;
  }

  static std::uint32_t AddTile(
    ConstIterator first, ConstIterator last, const HalfOpenBox<D>& extent, Tiling<D>& tiling)
  {
    Tile<D>& tile = tiling.Tiles.emplace_back(Tile<D>{ extent, {}, {} });
    for (ConstIterator item = first; item != last; ++item)
    {
      const bool isInside = extent.ContainsBall(item->Place, item->Reach);
      (isInside ? tile.Inside : tile.Across).push_back(item->Number);
    }
    std::sort(tile.Inside.begin(), tile.Inside.end());
    std::sort(tile.Across.begin(), tile.Across.end());
    return Tiling<D>::IsTile | static_cast<std::uint32_t>(tiling.Tiles.size() - 1);
  }
};

} // namespace voxplex

#endif
