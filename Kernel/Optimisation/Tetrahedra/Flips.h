// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Flips.h
 * @brief Changes of connectivity that raise the smallest score.
 */
#ifndef voxplex_Flips_h
#define voxplex_Flips_h

#include "Optimisation/Patch.h"
#include "Optimisation/Tetrahedra/InterfaceRules.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace voxplex
{

/** Counts of changes. */
struct FlipStatistics
{
  FlipStatistics& operator+=(const FlipStatistics& other)
  {
    this->EdgeRemovals += other.EdgeRemovals;
    this->InterfaceFlips += other.InterfaceFlips;
    this->Dropped += other.Dropped;
    return *this;
  }

  std::uint64_t EdgeRemovals = 0;
  std::uint64_t InterfaceFlips = 0; ///< edge removals at edges on an interface
  std::uint64_t Dropped = 0;        ///< tetrahedra on the mesh's boundary that were removed
};

/**
 * @brief Flips: edge removal, including edges on interfaces.
 *
 * Edge removal deletes the tetrahedra around an edge ab. The polygon around the edge is
 * triangulated, and the hole is filled with two tetrahedra for each triangle, one with a and one
 * with b. The best triangulation is found by dynamic programming (Klincsek, Minimal triangulations
 * of polygonal domains, 1980; Freitag and Ollivier-Gooch 1997). For rings of three and four
 * tetrahedra, these are the 3-2 and 4-4 flips.
 *
 * If ab is an edge of the interface of two labels, between the triangles abc and abd, each label
 * fills its own polygon, which has the edge cd. The interface flips to acd and bcd, and the volume
 * of abcd changes its label. This removes slivers that have two facets on an interface: the polygon
 * of their label is only the edge cd, so no tetrahedron replaces them. If background is on the
 * other side, the sliver is removed from the mesh. The interface stays manifold where it was
 * manifold, labels keep their number of pieces, and InterfaceRules hold.
 */
class Flips
{
public:
  Flips(Patch<3>& patch, const InterfaceRules& rules)
    : Target(patch)
    , Rules(rules)
  {
  }

  /** Makes the change that raises the smallest score around t most; false if there is none. */
  bool Improve(std::uint32_t t);

  const FlipStatistics& Counts() const { return this->Done; }

private:
  static constexpr std::size_t LongestRing = 10;

  /** A way to fill a hole, and its quality. */
  struct Plan
  {
    double Score = 0.0; ///< the smallest score afterwards, up to 1
    double Gain = 0.0;  ///< the gain in the smallest score, up to 1
    std::vector<std::uint32_t> Old;
    std::vector<NewCell<3>> Fresh;
    bool OnInterface = false;
  };

  void ConsiderEdge(std::uint32_t t, unsigned i, unsigned j);
  double LeastScoreFrom(double before) const;
  void Consider(double before);

  double ScoreOf(std::span<const std::uint32_t> cells) const;
  bool MayFlipInterface(std::size_t firstRun);
  bool IsAtJunction(std::uint32_t u, std::uint32_t v, std::uint32_t w) const;
  bool MayBeEdge(std::uint32_t a, std::uint32_t b);
  bool IsInterfaceEdge(std::uint32_t t, std::uint32_t a, std::uint32_t b);
  double Triangulate(
    std::span<const std::uint32_t> chain, TetrahedralComplex::Label label, double floor);
  void Emit(std::span<const std::uint32_t> chain, TetrahedralComplex::Label label, std::size_t i,
    std::size_t j);

  Patch<3>& Target;
  const InterfaceRules Rules;
  FlipStatistics Done;
  EdgeRing Ring;
  EdgeRing OtherRing;
  VertexStar<3> Star;
  Plan Best;
  Plan Current;
  std::array<std::array<double, LongestRing + 1>, LongestRing + 1> Table;
  std::array<std::array<std::size_t, LongestRing + 1>, LongestRing + 1> Choice;
};

} // namespace voxplex

#endif
