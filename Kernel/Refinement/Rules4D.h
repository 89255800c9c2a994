// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Rules4D.h
 * @brief The rules R1 to R5 of the thesis' section 4.2, with picking regions and the orders of 4.2 and 4.6.1.
 *
 * With c(s) and r(s) the centre and radius of the circumball of a pentatope s, dOmega the union of the
 * interfaces, cfp(p) the feature point (point of an interface) closest to p, and Delta(z) the sampling
 * density at a feature point z (RefinementContext::Delta):
 *
 * - R1: s whose circumball meets dOmega; z = cfp(c(s)) has no feature vertex nearer than Delta(z):
 *   insert z.
 * - R2: s whose circumball meets dOmega; r(s) >= 2 Delta(z): insert c(s), or its projection onto the
 *   box if it lies outside.
 * - R3: s with c(s) inside the object; r(s) / shortest edge >= rho-bar: insert c(s).
 * - R4: s with c(s) inside the object and normalized volume (4.5) below the bound, a sliver: insert a good
 *   point of its picking region, the ball around c(s) of radius zeta r(s).
 * - R5: facet f whose dual edge meets dOmega at z; a vertex of f is not a feature vertex: insert a good point
 *   of its picking region, dOmega within zeta |z - f| of z, and remove the free vertices of its star that
 *   are nearer than Delta to it. R1, too, removes those.
 * - Besides: s with c(s) inside the object; r(s) >= sf(c(s)): insert c(s) (R5 of 3D).
 *
 * A point is good if its insertion makes no small sliver inside the object: none with a circumradius below b
 * times that of the ball. The centre is tried first, then random points; if none of them is good, that is
 * taken whose worst sliver is best (lemma 4.1 promises a good one for a bound that is small enough).
 *
 * **Order.** For one element R1, R2, R3, R5, or R3 first (4.6.1), which keeps the cavities small. R4 comes
 * last of all, when the thread has no other poor element: most slivers die while the interfaces are
 * sampled. In the thesis it precedes R5.
 *
 * **Slivers** are pentatopes here, whatever their faces are: a face that is a sliver makes the pentatopes
 * around it slivers, too, or is harmless.
 *
 * **Termination**, whatever the input, as of Rules3D: feature vertices stay, and none is inserted nearer than
 * the spacing floor to another, so R1 and R5 fire finitely often; between two of them R2, R3, R4 and the
 * size rule insert points that are at least min(2 Delta, rho-bar * shortest edge, size, SliverSpacing
 * Delta) from every vertex, or at least the floor if moved onto the box. Few points suffice for volume
 * bounds of a few hundredths; above that R4 and R5 may answer each other until the floor is reached,
 * and the meshes become large. Theorem 4.1 asks for rho-bar >= 4 / (1 - zeta)^2 and b >= 2 / (1 - zeta); as
 * in the thesis' experiments, much smaller rho-bar do.
 */
#ifndef voxplex_Rules4D_h
#define voxplex_Rules4D_h

#include "Refinement/RefinementRules.h"

namespace voxplex
{

/** @brief Screens new pentatopes and refines poor ones. */
class Rules4D : public RefinementRules<4, Rules4D>
{
public:
  using RefinementRules::RefinementRules;

  /**
   * Applies the first rule that s violates and that can be applied. The worker owns the vertices of s,
   * or is alone. After a change s may be alive still and is then to be judged again.
   */
  RuleOutcome Refine(SimplexId s);

  /** Insertions of a region before rules give way there. */
  static constexpr std::uint32_t WorkLimit = 250;

private:
  friend RefinementRules;
  class BestPick;

  /** Free vertices nearer than this times Delta(z) to a new feature vertex z are removed. */
  static constexpr double RemovalRadius = 1.0;
  /** R4 inserts no point nearer than this times Delta to a vertex; what would need it stays a sliver. */
  static constexpr double SliverSpacing = 0.5;

  bool MayBePoor(SimplexId s);
  bool IsSliver(SimplexId s, double radius2) const;
  RuleOutcome R3(const Element& s);
  RuleOutcome R4(const Element& s);
  RuleOutcome R5(const Element& s);
  RuleOutcome InsertFeatureAt(
    const Point<4>& z, const Element& s, SimplexId other, LabelId labelOfOther);
  RuleOutcome InsertFeaturePick(
    const Point<4>& z, double delta, double clearance, const Element& s, SimplexId other);
  bool FacetIsGood(const std::array<VertexId, 5>& v, unsigned facet) const;
};

} // namespace voxplex

#endif
