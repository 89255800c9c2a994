// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file InterfaceEdges.h
 * @brief The ridges of interfaces with their facets, and the ridges at which the boundary of a label
 * is not manifold.
 *
 * A ridge is a face of D - 1 vertices: an edge in 3D, a triangle in 4D. Repairs of a mesh use these
 * lists. InterfaceTopology counts such edges, junctions and corners of 3D meshes for reports, from
 * the same lists.
 */
#ifndef voxplex_InterfaceEdges_h
#define voxplex_InterfaceEdges_h

#include "Base/UninitialisedVector.h"
#include "Image/LabelImage.h"
#include "Parallel/SharedCounts.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stop_token>
#include <vector>

namespace voxplex
{

/** A ridge, listed at its smallest vertex, and a facet that has it. */
template <int D>
struct RidgeUse
{
  std::array<std::uint32_t, static_cast<std::size_t>(D - 2)> Others; ///< ascending
  std::uint32_t Facet;
};

/**
 * @brief The ridges of facets, each with the facets that share it.
 *
 * O(n) for n facets, if few facets share a point.
 */
template <int D>
class InterfaceRidgeLists
{
public:
  using Ridge = std::array<std::uint32_t, static_cast<std::size_t>(D - 1)>;

  /**
   * @param facets D point numbers each; they must outlive this object
   * @param points the number of points; all point numbers are smaller
   * @param threads 0 means all cores; the result does not depend on it
   * @throws Cancelled if a stop was requested before the end; std::bad_alloc
   */
  InterfaceRidgeLists(
    std::span<const std::array<std::uint32_t, static_cast<std::size_t>(D)>> facets,
    std::size_t points, unsigned threads = 1, const std::stop_token& stop = {});

  /**
   * Calls visit(ridge, uses) for each ridge in the order of its vertices, which are ascending point
   * numbers. `uses` is a std::span<const RidgeUse<D>>, in the order of the facets.
   */
  template <typename Visit>
  void ForEachRidge(Visit&& visit) const
  {
    this->ForEachRidge(0, this->Points, visit);
  }

  /** The same for the ridges whose smallest vertices are first ... last - 1. */
  template <typename Visit>
  void ForEachRidge(std::size_t first, std::size_t last, Visit&& visit) const
  {
    std::vector<RidgeUse<D>> uses;
    for (std::size_t low = first; low < last; ++low)
    {
      this->FindUsesAt(static_cast<std::uint32_t>(low), uses);
      for (std::size_t begin = 0, behind = 0; begin < uses.size(); begin = behind)
      {
        const auto& others = uses[begin].Others;
        while (behind < uses.size() && uses[behind].Others == others)
        {
          ++behind;
        }
        Ridge ridge{ static_cast<std::uint32_t>(low) };
        std::copy(others.begin(), others.end(), ridge.begin() + 1);
        visit(ridge, std::span<const RidgeUse<D>>(uses.data() + begin, behind - begin));
      }
    }
  }

private:
  /** The ridges whose smallest point is given, with their facets; sorted. */
  void FindUsesAt(std::uint32_t point, std::vector<RidgeUse<D>>& uses) const;

  const std::span<const std::array<std::uint32_t, static_cast<std::size_t>(D)>> Facets;
  std::size_t Points;
  SharedCounts Lists; ///< of each point
  /** Each facet is in the lists of its two smallest points, one of which each of its ridges has. */
  UninitialisedVector<std::uint32_t> Listed;
};

extern template class InterfaceRidgeLists<3>;
extern template class InterfaceRidgeLists<4>;

/** A label, and the number of facets at a ridge that have it on one side. */
struct LabelAtRidge
{
  std::int64_t Label;
  std::uint32_t Facets;
};

/** The labels around a ridge, ascending; background counts as one. A Label is an integer. */
template <typename Label>
class LabelsAtRidge
{
public:
  /** @param labels the labels on both sides of each facet */
  explicit LabelsAtRidge(std::span<const std::array<Label, 2>> labels)
    : Labels(labels)
  {
  }
  /** @return valid until the next call */
  template <int D>
  std::span<const LabelAtRidge> Count(std::span<const RidgeUse<D>> uses)
  {
    this->Sides.clear();
    for (const RidgeUse<D>& use : uses)
    {
      const auto& sides = this->Labels[use.Facet];
      this->Sides.insert(this->Sides.end(), sides.begin(), sides.end());
    }
    std::sort(this->Sides.begin(), this->Sides.end());
    this->Counts.clear();
    for (const Label label : this->Sides)
    {
      if (this->Counts.empty() || this->Counts.back().Label != label)
      {
        this->Counts.push_back({ label, 0 });
      }
      ++this->Counts.back().Facets;
    }
    return this->Counts;
  }

private:
  const std::span<const std::array<Label, 2>> Labels;
  std::vector<Label> Sides;
  std::vector<LabelAtRidge> Counts;
};

/** Whether three or more labels, including background, meet. */
inline bool IsJunction(std::span<const LabelAtRidge> labels)
{
  return labels.size() > 2;
}

/** Whether the boundary of a label is manifold at a ridge. */
inline bool IsManifold(const LabelAtRidge& label)
{
  return label.Facets == 2;
}

/** A ridge of an interface: an edge in 3D, a triangle in 4D. */
template <int D>
struct InterfaceRidge
{
  std::array<std::uint32_t, static_cast<std::size_t>(D - 1)> Vertices; ///< ascending
  bool IsJunction;
};
using InterfaceEdge = InterfaceRidge<3>;

/**
 * Ridges at which the boundary of some label is not manifold: the number of its facets there is not
 * two. Background does not count. The ridges are in the order of their vertices. Takes time linear
 * in the numbers of points and facets.
 *
 * @param facets D point numbers each
 * @param labels the labels on both sides of each facet
 * @param points the number of points; all point numbers are smaller
 * @param threads 0 means all cores; the result does not depend on it
 * @throws Cancelled if a stop was requested before the end; std::bad_alloc
 */
template <int D>
std::vector<InterfaceRidge<D>> FindNonManifoldRidges(
  std::span<const std::array<std::uint32_t, static_cast<std::size_t>(D)>> facets,
  std::span<const std::array<std::int64_t, 2>> labels, std::size_t points, unsigned threads = 1,
  const std::stop_token& stop = {});

/** The same with the labels' ids. */
template <int D>
std::vector<InterfaceRidge<D>> FindNonManifoldRidges(
  std::span<const std::array<std::uint32_t, static_cast<std::size_t>(D)>> facets,
  std::span<const std::array<LabelId, 2>> labels, std::size_t points, unsigned threads = 1,
  const std::stop_token& stop = {});

} // namespace voxplex

#endif
