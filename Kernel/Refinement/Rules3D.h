// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Rules3D.h
 * @brief The rules R1 to R6 of the thesis' section 3.1, with the projection onto the box of 2.2, and
 * the one against slivers of section 2.6.2.
 *
 * With c(t) and r(t) the centre and radius of the circumball of a tetrahedron t, dOmega the union of
 * the interfaces, cfp(p) the feature point (point of an interface) closest to p, and Delta(z) the
 * sampling density at a feature point z (RefinementContext::Delta):
 *
 * - R1: t whose circumball meets dOmega; z = cfp(c(t)) has no feature vertex nearer than Delta(z):
 *   insert z.
 * - R2: t whose circumball meets dOmega; r(t) >= 2 Delta(z): insert c(t), or its projection onto the
 *   box if it lies outside.
 * - R3: facet f whose dual edge meets dOmega at z; an angle of f is below the bound, or a vertex of f
 *   is not a feature vertex: insert z. Or z lies on a face where the image cuts the object and a vertex of f
 *   does not: insert z, or a point nearby on an edge of that face, unless a feature vertex is nearer than
 *   CutClearance Delta(z).
 * - R4: t with c(t) inside the object; r(t) / shortest edge >= rho-bar: insert c(t).
 * - R5: t with c(t) inside the object; r(t) >= sf(c(t)): insert c(t).
 * - R6: a new feature vertex z (of R1 or R3): remove the free vertices of its star that are nearer than
 *   2 Delta(z).
 * - R7: t with c(t) inside the object that no other rule applies to, when nothing else is left; a dihedral
 *   angle of t is below the bound or above 180 degrees less the bound: insert a point near c(t) if its star
 *   has one label, else a point of the interface near the dual edge of a restricted facet of t or of a
 *   neighbour. Of a number of points in the picking region (as in the thesis' chapter 4) the first without
 *   slivers in its star is taken, else the best.
 *
 * R7 follows section 2.6.2 in that points that would eliminate facets of the interfaces are rejected for
 * points on these. The thesis tries the circumcentre alone, and bounds the mean ratio; dihedral angles are
 * what users ask for. Its conversion of illegal facets is R3 with R6.
 *
 * **Termination**, whatever the input. Feature vertices are never removed, and none is inserted nearer
 * than SpacingFloor to another or to the box: in the box there is room for finitely many, so R1 and R3
 * fire finitely often. R6 follows only these. Between two of them only R2, R4 and R5 insert, each a
 * point at least min(2 Delta, rho-bar * shortest edge, size floor) from every vertex (the circumball
 * is empty; projected points are tested), so again finitely often. R7 keeps off all vertices by SliverSpacing, too.
 *
 * With several threads two feature points may pass the test of their distance at the same time, unless
 * one is a vertex of the other's cavity, which is tested again under the locks. Points too near to
 * each other were then all under way at once, so there are at most as many in one place as there are
 * threads, and the argument holds. A removal that another thread is in the way of is put off, not
 * dropped.
 */
#ifndef voxplex_Rules3D_h
#define voxplex_Rules3D_h

#include "Refinement/RefinementRules.h"

namespace voxplex
{

/** @brief Screens new tetrahedra and refines poor ones. */
class Rules3D : public RefinementRules<3, Rules3D>
{
public:
  Rules3D(RefinementContext<3>& context, RefinementWorker<3>& worker);

  /**
   * Applies the first rule that t violates and that can be applied. The worker owns the vertices of t,
   * or is alone. After a change t may be alive still and is then to be judged again.
   */
  RuleOutcome Refine(SimplexId t);

  /** Insertions of a region before rules give way there. */
  static constexpr std::uint32_t WorkLimit = 400;

private:
  friend RefinementRules;
  /** R6 removes free vertices nearer than this times Delta(z). */
  static constexpr double RemovalRadius = 2.0;
  /** R7 inserts no point nearer than this times Delta to a vertex, a free one in the way of a feature
   * point excepted. With 0.4 a few slivers of the knee atlas stay, with 0.25 none. */
  static constexpr double SliverSpacing = 0.25;
  /** Points that R3 inserts to make facets flat keep off feature vertices by this times delta. */
  static constexpr double CutClearance = 0.25;

  bool MayBePoor(SimplexId t);
  class BetterStar;
  RuleOutcome R3(const Element& t);
  bool IsSliver(SimplexId t) const;
  RuleOutcome R7(const Element& t);
  RuleOutcome SplitSliver(const Element& t, double tolerance);
  RuleOutcome SampleAtSliver(const Element& t, double tolerance);
  RuleOutcome SampleFacetsOf(SimplexId s, const Element& t, double tolerance);
  RuleOutcome SampleBeside(const Element& t, double tolerance);
  RuleOutcome SampleNear(
    const Point<3>& z, double radius, double delta, const Element& t, double tolerance);
  double DihedralSine(SimplexId t) const;
  bool IsToSplit(const Element& t);
  bool IsWedged(const Element& t);
  bool FacetIsGood(const std::array<VertexId, 4>& v, unsigned facet) const;
  bool MayCrossBorder(const Element& t, SimplexId neighbour, LabelId other) const;
  bool FacetIsFlat(
    const std::array<VertexId, 4>& v, unsigned facet, const Point<3>& crossing) const;
  void MoveToBorderEdge(Point<3>& z, double reach, double clearance) const;

  const double CosineOfFacetAngle;
  const double SineOfSliverAngle; ///< 0: slivers are left alone
  const double SineInside;        ///< the same for those that are not wedged between interfaces
};

} // namespace voxplex

#endif
