// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Rules4D.h
 * @brief The rules of the thesis' section 4.2, with picking regions and the orders of sections 4.2
 * and 4.6.1.
 *
 * RefinementRules.h has the names and what 3D and 4D share. In 4D, for a pentatope s:
 *
 * - Radius-edge: also, which is not in the thesis, if the ratio is >= PreferredRatio rho-bar, and
 *   r(s) >= PreferredSpacing Delta, for the Delta that holds there and for the requested one.
 * - Sliver: c(s) is inside the object, and the normalized volume of s (section 4.5) is below the
 *   bound (s is a sliver): insert a good point of its picking region, the ball around c(s) of
 *   radius zeta r(s).
 * - Facet: the dual edge of a facet f meets dOmega at z, and a vertex of f is not a feature vertex:
 *   insert a good point of its picking region, which is dOmega within zeta |z - f| of z, with zeta
 *   at most LargestInterfacePick.
 * - Removal and size: as in 3D. In the thesis removal is part of the facet rule.
 *
 * A point is good if its insertion makes no small sliver inside the object: no sliver with a
 * circumradius below b times that of the ball. The centre is tried first, then random points. If
 * none of them is good, the point whose worst sliver is best is inserted (lemma 4.1 promises a good
 * point if the bound is small enough).
 *
 * **Order.** For one element the order is sample spacing, ball, radius-edge, facet, size, or with
 * radius-edge first (section 4.6.1), which keeps cavities small. The sliver rule comes last, when
 * the thread has no other poor element: most slivers die while the interfaces are sampled. In the
 * thesis it precedes the facet rule.
 *
 * **Planes between slabs.** A pentatope with a facet on one gets the label of the plane
 * (SlabRefinement). For the radius-edge, sliver, facet and size rules this label counts, not that
 * of c(s). The dual edges of its facets lead from the centre of its facet on the plane to c(s), and
 * on.
 *
 * **Slivers** are pentatopes here. No face has a smaller normalized volume than its pentatope, so a
 * pentatope that is no sliver has none among its faces. Proof: let R be the circumradius of the
 * pentatope, x R that of a facet, and f the facet's normalized volume. The height above the facet
 * is at most R (1 + sqrt(1 - x^2)). So the pentatope has at most f g(x) / g(sqrt(15) / 4), with
 * g(x) = x^3 (1 + sqrt(1 - x^2)). g is largest at sqrt(15) / 4, the value of the regular pentatope.
 * The same holds from tetrahedra to triangles, with x^2 in place of x^3.
 *
 * **Termination** for every input, as in Rules3D. Feature vertices stay, and none is inserted
 * nearer than the spacing floor to another, so the sample spacing and facet rules fire finitely
 * often. Between two of them the others insert points. Each is at least min(2 Delta, rho-bar *
 * shortest edge, PreferredSpacing Delta, size, SliverSpacing Delta) from every vertex, or at least
 * the floor if it was moved onto the box. For volume bounds of a few hundredths few points suffice.
 * For larger bounds the sliver and facet rules may answer each other until the floor is reached,
 * and meshes become large. Theorem 4.1 asks for rho-bar >= 4 / (1 - zeta)^2 and b >= 2 / (1 -
 * zeta). As in the thesis' experiments, much smaller values of rho-bar work.
 */
#ifndef voxplex_Rules4D_h
#define voxplex_Rules4D_h

#include "Refinement/Rules/RefinementRules.h"

#include <optional>

namespace voxplex
{

/** @brief Screens new pentatopes and refines poor ones. */
class Rules4D : public RefinementRules<4, Rules4D>
{
public:
  using RefinementRules::RefinementRules;

  /**
   * Applies the first rule that s violates and that can be applied. The worker owns the vertices of
   * s, or is alone. If s is still alive after a change, it must be judged again.
   */
  RuleOutcome Refine(SimplexId s);

  /** Insertions in a region before rules give way there. */
  static constexpr std::uint32_t WorkLimit = 250;

private:
  friend RefinementRules;
  class BestPick;

  /** Free vertices nearer than this times Delta(z) to a new feature vertex z are removed. */
  static constexpr double RemovalRadius = 1.0;
  /**
   * The radius-edge rule also fires above this part of the bound of the radius-edge ratio, if the
   * circumradius is at least PreferredSpacing times Delta. Interfaces are sampled densely and the
   * inside is not, so most pentatopes have all vertices but one on interfaces, and are as poor as
   * the bound allows. With points in the layer behind the interface, the mean normalized volume
   * grows by a quarter, for up to 27 % more pentatopes. The spacing keeps these points from asking
   * for others, as a smaller bound would.
   */
  static constexpr double PreferredRatio = 0.725;
  static constexpr double PreferredSpacing = 1.2;
  /**
   * Upper bound of zeta in the facet rule. The surface ball of a facet is empty, so a point of the
   * picking region is at least half of its radius from all vertices. Points nearer to them make bad
   * ratios; then the radius-edge and facet rules answer each other: in noise of four labels zeta =
   * 0.9 took 8 times the points.
   */
  static constexpr double LargestInterfacePick = 0.5;
  /**
   * The sliver rule keeps this distance from vertices, times Delta. A sliver that would need a
   * nearer point stays.
   */
  static constexpr double SliverSpacing = 0.5;

  /**
   * The centre of a pentatope's facet on a plane between slabs, if it has one. The mesh has the
   * label there.
   */
  std::optional<Point<4>> FacetCentreOnPlane(SimplexId s) const;
  bool IsSliver(SimplexId s, double radius2) const;
  RuleOutcome SliverRule(const Element& s);
  RuleOutcome FacetRule(const Element& s, const std::optional<Point<4>>& onPlane);
  RuleOutcome InsertFeatureAt(
    const Point<4>& crossing, const Element& s, SimplexId other, LabelId labelOfOther);
  RuleOutcome InsertFeaturePick(
    const Point<4>& z, double delta, double clearance, const Element& s, SimplexId other);
  bool FacetIsGood(const std::array<VertexId, 5>& v, unsigned facet) const;
};

} // namespace voxplex

#endif
