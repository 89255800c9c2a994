// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PentatopeInsertion.h
 * @brief Replaces a poor pentatope and some around it by others with a new vertex.
 */
#ifndef voxplex_PentatopeInsertion_h
#define voxplex_PentatopeInsertion_h

#include "Optimisation/Pentatopes/PentatopeRules.h"
#include "Optimisation/Pentatopes/PentatopeStar.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace voxplex
{

/** Pentatopes that are taken out, and those between their boundary and a new vertex. */
struct PentatopeInsertion
{
  std::vector<std::uint32_t> Old;
  std::vector<PentatopeComplex::Vertices> New; ///< the new vertex is None
  Point<4> Place{};                            ///< of the new vertex
  double Before = 0.0;                         ///< smallest quality of the old ones
  double After = 0.0;                          ///< smallest quality of the new ones
};

/**
 * @brief Finds where to insert a vertex.
 *
 * The cavity begins as the poor pentatope. The new vertex moves in it until the worst of the new
 * pentatopes cannot be raised any more. Then the pentatope behind the facet of this worst one is added, and so on.
 * Of all cavities on the way the best is taken. All pentatopes of a cavity have the same label
 * and are on the same side of all time planes, so interfaces and planes stay as they are.
 */
class PentatopeCavity
{
public:
  /** Both must outlive this object. */
  PentatopeCavity(const Patch<4>& patch, const PentatopeRules& rules)
    : Target(patch)
    , Mesh(patch.Mesh())
    , Rules(rules)
  {
  }

  /**
   * The best insertion for a pentatope. Its After is at most Before if there is none.
   *
   * Complexity: constant, because the number of pentatopes is bounded.
   * @param target the cavity does not grow any more when all new pentatopes are as good
   */
  PentatopeInsertion Find(std::uint32_t s, double target);

private:
  struct BoundaryFacet
  {
    std::uint32_t Inside;
    unsigned Opposite;    ///< the vertex of Inside that is not in the facet
    std::uint32_t Behind; ///< the pentatope that may be added across the facet, or None
    MovedPentatope New;
  };

  void Try(std::uint32_t s, Point<4> p, double target, PentatopeInsertion& best);
  void Add(std::uint32_t s);
  double Improve(Point<4>& p) const;
  static double WorthOf(const BoundaryFacet& facet, const Point<4>& p);
  double WorthAt(const Point<4>& p, double enough) const;
  Point<4> DirectionAt(const Point<4>& p, double worth, double share) const;
  bool Grow(const Point<4>& p);
  bool Keeps(std::uint32_t s) const;
  bool IsAllowed(const Point<4>& p) const;
  PentatopeInsertion Result(const Point<4>& p, double worth) const;

  const Patch<4>& Target;
  const PentatopeComplex& Mesh;
  const PentatopeRules& Rules;
  std::vector<std::uint32_t> Cavity;
  std::vector<BoundaryFacet> Facets;
  double Before = 0.0;
};

} // namespace voxplex

#endif
