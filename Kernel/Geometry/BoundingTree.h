// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BoundingTree.h
 * @brief A search tree for the nearest of many points or triangles.
 */
#ifndef voxplex_BoundingTree_h
#define voxplex_BoundingTree_h

#include "Geometry/Box.h"
#include "Geometry/HilbertOrder.h"
#include "Geometry/Point.h"
#include "Geometry/Triangle.h"
#include "Parallel/ParallelFor.h"
#include "Parallel/ParallelSort.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <stop_token>
#include <utility>
#include <vector>

namespace voxplex
{

/**
 * @brief A bounding volume hierarchy: a tree of boxes around points or triangles, the primitives.
 *
 * Primitives are sorted along a Hilbert curve, and every eight of them form a leaf. The leaves are
 * those of a complete binary tree that is stored as a heap. A search visits the nearer child first,
 * and skips boxes that are farther than the nearest primitive so far. For points near the
 * primitives a search takes O(log n) on average. Unlike a uniform grid, the tree stays fast if
 * primitives differ in size or are dense in places.
 *
 * Immutable after construction. Thread-safe.
 *
 * @tparam Primitive Point<3> or Triangle
 */
template <typename Primitive>
class BoundingTree
{
public:
  /**
   * @param primitives fewer than 2^32
   * @param threads 0 means all cores; the result does not depend on it
   * @throws Cancelled if a stop was requested before the end; std::bad_alloc
   */
  explicit BoundingTree(
    std::vector<Primitive> primitives, unsigned threads = 1, const std::stop_token& stop = {})
    : Primitives(std::move(primitives))
  {
    if (!this->Primitives.empty())
    {
      this->Sort(threads, stop);
      this->MakeBoxes(threads, stop);
    }
  }

  bool IsEmpty() const { return this->Primitives.empty(); }

  /**
   * Squared distance of p from the nearest primitive; infinity if there are no primitives.
   * @param hint index of the primitive with which the search starts, such as the result of the last
   *   search; on return the index of the nearest primitive
   */
  double Distance2To(const Point<3>& p, std::uint32_t& hint) const;

private:
  static constexpr std::size_t LeafSize = 8;
  static constexpr std::size_t Grain = 4096;

  static Box<3> BoxOf(const Point<3>& p) { return { p, p }; }
  static Box<3> BoxOf(const Triangle& t)
  {
    Box<3> box{ t.A, t.A };
    Extend(box, { t.B, t.B });
    Extend(box, { t.C, t.C });
    return box;
  }
  static void Extend(Box<3>& box, const Box<3>& other)
  {
    for (std::size_t k = 0; k < 3; ++k)
    {
      box.Min[k] = std::min(box.Min[k], other.Min[k]);
      box.Max[k] = std::max(box.Max[k], other.Max[k]);
    }
  }
  /** A box without points, infinitely far from every point. */
  static Box<3> EmptyBox()
  {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Box<3> box;
    box.Min.fill(infinity);
    box.Max.fill(-infinity);
    return box;
  }
  static double Distance2From(const Box<3>& box, const Point<3>& p)
  {
    double sum = 0.0;
    for (std::size_t k = 0; k < 3; ++k)
    {
      const double d = std::max({ box.Min[k] - p[k], 0.0, p[k] - box.Max[k] });
      sum += d * d;
    }
    return sum;
  }

  void Sort(unsigned threads, const std::stop_token& stop);
  void MakeBoxes(unsigned threads, const std::stop_token& stop);

  std::vector<Primitive> Primitives;
  /** Node i has the children 2 i and 2 i + 1. The root is node 1, the first leaf node FirstLeaf. */
  std::vector<Box<3>> Nodes;
  std::size_t FirstLeaf = 1;
};

template <typename Primitive>
void BoundingTree<Primitive>::Sort(unsigned threads, const std::stop_token& stop)
{
  struct Ranked
  {
    std::uint64_t Rank;
    std::uint32_t Index;
  };
  Box<3> bounds = EmptyBox();
  for (const Primitive& primitive : this->Primitives)
  {
    Extend(bounds, BoxOf(primitive));
  }
  if (bounds.Min == bounds.Max)
  {
    return; // all primitives are the same point
  }
  const std::size_t n = this->Primitives.size();
  std::vector<Ranked> ranked(n);
  ParallelFor(
    0, n, Grain, threads,
    [&](std::size_t first, std::size_t last)
    {
      for (std::size_t i = first; i < last; ++i)
      {
        const Box<3> box = BoxOf(this->Primitives[i]);
        ranked[i] = { HilbertIndex<3>(Interpolate(box.Min, box.Max, 0.5), bounds),
          static_cast<std::uint32_t>(i) };
      }
    },
    stop);
  std::vector<Ranked> scratch(n);
  const std::span<Ranked> sorted = ParallelRadixSort(
    std::span<Ranked>(ranked), std::span<Ranked>(scratch), 63,
    [](const Ranked& r) { return r.Rank; }, threads, stop);
  std::vector<Primitive> inOrder(n);
  ParallelFor(
    0, n, Grain, threads,
    [&](std::size_t first, std::size_t last)
    {
      for (std::size_t i = first; i < last; ++i)
      {
        inOrder[i] = this->Primitives[sorted[i].Index];
      }
    },
    stop);
  this->Primitives.swap(inOrder);
}

template <typename Primitive>
void BoundingTree<Primitive>::MakeBoxes(unsigned threads, const std::stop_token& stop)
{
  const std::size_t n = this->Primitives.size();
  const std::size_t leaves = (n - 1) / LeafSize + 1;
  this->FirstLeaf = std::bit_ceil(leaves);
  this->Nodes.assign(2 * this->FirstLeaf, EmptyBox());
  ParallelFor(
    0, leaves, Grain, threads,
    [&](std::size_t first, std::size_t last)
    {
      for (std::size_t leaf = first; leaf < last; ++leaf)
      {
        Box<3>& box = this->Nodes[this->FirstLeaf + leaf];
        for (std::size_t i = leaf * LeafSize; i < std::min(n, (leaf + 1) * LeafSize); ++i)
        {
          Extend(box, BoxOf(this->Primitives[i]));
        }
      }
    },
    stop);
  for (std::size_t level = this->FirstLeaf / 2; level > 0; level /= 2)
  {
    ParallelFor(
      level, 2 * level, Grain, threads,
      [&](std::size_t first, std::size_t last)
      {
        for (std::size_t node = first; node < last; ++node)
        {
          this->Nodes[node] = this->Nodes[2 * node];
          Extend(this->Nodes[node], this->Nodes[2 * node + 1]);
        }
      },
      stop);
  }
}

template <typename Primitive>
double BoundingTree<Primitive>::Distance2To(const Point<3>& p, std::uint32_t& hint) const
{
  if (this->Primitives.empty())
  {
    return std::numeric_limits<double>::infinity();
  }
  const std::size_t n = this->Primitives.size();
  hint = std::min(hint, static_cast<std::uint32_t>(n - 1));
  double best = Distance2(p, this->Primitives[hint]);

  struct Waiting
  {
    std::size_t Node;
    double Distance2;
  };
  std::array<Waiting, 64> stack; // each level adds one node, and there are at most 30 levels
  std::size_t depth = 0;
  stack[depth++] = { 1, Distance2From(this->Nodes[1], p) };
  while (depth > 0)
  {
    const Waiting next = stack[--depth];
    if (!(next.Distance2 < best))
    {
      continue;
    }
    if (next.Node >= this->FirstLeaf)
    {
      const std::size_t first = (next.Node - this->FirstLeaf) * LeafSize;
      for (std::size_t i = first; i < std::min(n, first + LeafSize); ++i)
      {
        const double distance2 = Distance2(p, this->Primitives[i]);
        if (distance2 < best)
        {
          best = distance2;
          hint = static_cast<std::uint32_t>(i);
        }
      }
      continue;
    }
    Waiting near{ 2 * next.Node, Distance2From(this->Nodes[2 * next.Node], p) };
    Waiting far{ 2 * next.Node + 1, Distance2From(this->Nodes[2 * next.Node + 1], p) };
    if (far.Distance2 < near.Distance2)
    {
      std::swap(near, far);
    }
    stack[depth++] = far;
    stack[depth++] = near;
  }
  return best;
}

} // namespace voxplex

#endif
