// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file InterfaceEdges.h
 * @brief The edges of interfaces with what meets there, and those at which the boundary of a label is no surface.
 *
 * For whoever mends a mesh and needs to know which edges; how many there are, and junctions and corners as
 * reports have them, is InterfaceTopology's, which goes through the same lists.
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
 * O(n) for n facets of which few share a point.
 */
class InterfaceEdgeLists
{
public:
  /** An edge in the list of its smaller end, and a facet that has it. */
  struct Use
  {
    std::uint32_t High;
    std::uint32_t Facet;
  };

  /**
   * @param facets three point numbers each
   * @param points all numbers are below
   * @param threads used to sort; 0 means all cores
   * @throws Cancelled if a stop was requested before the end; std::bad_alloc
   */
  InterfaceEdgeLists(std::span<const std::array<std::uint32_t, 3>> facets, std::size_t points,
    unsigned threads = 1, const std::stop_token& stop = {});

  /**
   * Calls visit(ends, uses) for each edge in the order of its ends, which are ascending point numbers; uses is a
   * std::span<const Use>, in the order of the facets.
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
  std::vector<std::uint32_t> Begins; ///< of the list of each point
  std::vector<Use> Uses;
};

/** How many facets at an edge have a label on one side. */
struct LabelAtEdge
{
  std::int64_t Label;
  std::uint32_t Facets;
};

/** The labels around an edge, ascending; background counts as one. */
class LabelsAtEdge
{
public:
  /** @param labels on both sides of each facet */
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

/** Three labels or more meet at a junction; background counts. */
inline bool IsJunction(std::span<const LabelAtEdge> labels)
{
  return labels.size() > 2;
}

/** Whether the boundary of a label is a surface at an edge. */
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
 * Edges at which some label other than background has another number of boundary facets than two, in the
 * order of their ends. Takes time linear in the numbers of points and facets.
 *
 * @param facets three point numbers each
 * @param labels on both sides of each
 * @param points all numbers are below
 * @param threads used for some of it; 0 means all cores
 * @throws Cancelled if a stop was requested before the end; std::bad_alloc
 */
std::vector<InterfaceEdge> FindNonManifoldEdges(
  std::span<const std::array<std::uint32_t, 3>> facets,
  std::span<const std::array<std::int64_t, 2>> labels, std::size_t points, unsigned threads = 1,
  const std::stop_token& stop = {});

} // namespace voxplex

#endif
