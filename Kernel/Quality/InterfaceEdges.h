// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file InterfaceEdges.h
 * @brief The edges of interfaces with their facets, and the edges at which the boundary of a label
 * is not manifold.
 *
 * Repairs of a mesh use these lists. InterfaceTopology counts such edges, junctions and corners for
 * reports, from the same lists.
 */
#ifndef voxplex_InterfaceEdges_h
#define voxplex_InterfaceEdges_h

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stop_token>
#include <vector>

namespace voxplex
{

/**
 * @brief The edges of facets, each with the facets that share it.
 *
 * O(n) for n facets, if few facets share a point.
 */
class InterfaceEdgeLists
{
public:
  /** An edge, listed at its smaller end, and a facet that has it. */
  struct Use
  {
    std::uint32_t High;
    std::uint32_t Facet;
  };

  /**
   * @param facets three point numbers each
   * @param points the number of points; all point numbers are smaller
   * @param threads used to sort; 0 means all cores
   * @throws Cancelled if a stop was requested before the end; std::bad_alloc
   */
  InterfaceEdgeLists(std::span<const std::array<std::uint32_t, 3>> facets, std::size_t points,
    unsigned threads = 1, const std::stop_token& stop = {});

  /**
   * Calls visit(ends, uses) for each edge in the order of its ends. The ends are ascending point
   * numbers. `uses` is a std::span<const Use>, in the order of the facets.
   */
  template <typename Visit>
  void ForEachEdge(Visit&& visit) const
  {
    for (std::uint32_t low = 0; low + 1 < this->Begins.size(); ++low)
    {
      for (std::uint32_t first = this->Begins[low], last = first; first < this->Begins[low + 1];
           first = last)
      {
        while (last < this->Begins[low + 1] && this->Uses[last].High == this->Uses[first].High)
        {
          ++last;
        }
        visit(std::array<std::uint32_t, 2>{ low, this->Uses[first].High },
          std::span<const Use>(this->Uses.data() + first, last - first));
      }
    }
  }

private:
  std::vector<std::uint32_t> Begins; ///< begin of the list of each point
  std::vector<Use> Uses;
};

/** A label, and the number of facets at an edge that have it on one side. */
struct LabelAtEdge
{
  std::int64_t Label;
  std::uint32_t Facets;
};

/** The labels around an edge, ascending; background counts as one. */
class LabelsAtEdge
{
public:
  /** @param labels the labels on both sides of each facet */
  explicit LabelsAtEdge(std::span<const std::array<std::int64_t, 2>> labels)
    : Labels(labels)
  {
  }
  /** @return valid until the next call */
  std::span<const LabelAtEdge> Count(std::span<const InterfaceEdgeLists::Use> uses);

private:
  const std::span<const std::array<std::int64_t, 2>> Labels;
  std::vector<std::int64_t> Sides;
  std::vector<LabelAtEdge> Counts;
};

/** Whether three or more labels, including background, meet. */
inline bool IsJunction(std::span<const LabelAtEdge> labels)
{
  return labels.size() > 2;
}

/** Whether the boundary of a label is manifold at an edge. */
inline bool IsManifold(const LabelAtEdge& label)
{
  return label.Facets == 2;
}

/** An edge of an interface. */
struct InterfaceEdge
{
  std::array<std::uint32_t, 2> Ends; ///< point numbers, ascending
  bool IsJunction;
};

/**
 * Edges at which the boundary of some label is not manifold: the number of its facets there is not
 * two. Background does not count. The edges are in the order of their ends. Takes time linear in
 * the numbers of points and facets.
 *
 * @param facets three point numbers each
 * @param labels the labels on both sides of each facet
 * @param points the number of points; all point numbers are smaller
 * @param threads used for a part of the work; 0 means all cores
 * @throws Cancelled if a stop was requested before the end; std::bad_alloc
 */
std::vector<InterfaceEdge> FindNonManifoldEdges(
  std::span<const std::array<std::uint32_t, 3>> facets,
  std::span<const std::array<std::int64_t, 2>> labels, std::size_t points, unsigned threads = 1,
  const std::stop_token& stop = {});

} // namespace voxplex

#endif
