// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Rules3D.h
 * @brief The rules of the thesis' section 3.1, with the projection onto the box of section 2.2, and
 * the sliver rule (section 2.6.2).
 *
 * RefinementRules.h has the names and what 3D and 4D share. The order is sample spacing, ball,
 * facet, radius-edge, size, sliver; removal follows an insertion. In 3D:
 *
 * - Facet: the dual edge of a facet f meets dOmega at z, and an angle of f is below the bound or a
 *   vertex of f is not a feature vertex: insert z. Or z lies on a cut face, and a vertex of f does not:
 *   insert z or a point nearby on an edge of that face, unless
 *   a feature vertex is nearer than CutClearance Delta(z). A z of the first kind that is nearer to
 *   such a face than this is moved to an edge of the face nearby.
 * - Sliver: c(t) is inside the object, a dihedral angle of t is below the bound or above 180
 *   degrees minus the bound, and no other poor element is left: insert a point near c(t) if its
 *   star has one label. Else insert a point of the interface near the dual edge of a restricted
 *   facet of t or of a neighbour, else near cfp(c(t)). Several points of the picking region are
 *   tried (as in chapter 4 of the thesis). The first whose star has no slivers is inserted, else
 *   the best.
 *
 * The sliver rule follows section 2.6.2: a point that would eliminate facets of the interfaces is
 * rejected in favour of a point on these. The thesis tries the circumcentre alone and bounds the
 * mean ratio. Here dihedral angles are bounded, because users ask for them. The thesis' conversion
 * of illegal facets is the facet rule with removal.
 *
 * **Termination** for every input. Feature vertices are never removed. None is inserted nearer than
 * SpacingFloor to another or to the box, so the box has room for finitely many. So the rules of
 * sample spacing and of facets fire finitely often. Removal follows such an insertion only. Between
 * two of them only the ball, radius-edge and size rules insert points. Each point is at least min(2
 * Delta, rho-bar * shortest edge, size floor) from every vertex, because the circumball is empty
 * and projected points are tested. So they fire finitely often, too. The points of the sliver rule
 * keep SliverSpacing from all vertices.
 *
 * With several threads, two feature points may pass the test of their distance at the same time.
 * (If one is a vertex of the other's cavity, the distance is tested again under the locks.) Points
 * that are too near to each other were then all being inserted at once. So there are at most as
 * many in one place as there are threads, and the argument holds. A removal that another thread
 * prevents is put off, not dropped.
 */
#ifndef voxplex_Rules3D_h
#define voxplex_Rules3D_h

#include "Refinement/Rules/RefinementRules.h"

namespace voxplex
{

/** @brief Screens new tetrahedra and refines poor ones. */
class Rules3D : public RefinementRules<3, Rules3D>
{
public:
  Rules3D(RefinementContext<3>& context, RefinementWorker<3>& worker);

  /**
   * Applies the first rule that t violates and that can be applied. The worker owns the vertices of
   * t, or is alone. If t is still alive after a change, it must be judged again.
   */
  RuleOutcome Refine(SimplexId t);

  /** Insertions in a region before rules give way there. */
  static constexpr std::uint32_t WorkLimit = 400;

private:
  friend RefinementRules;
  /** Free vertices nearer than this times Delta(z) to a new feature vertex z are removed. */
  static constexpr double RemovalRadius = 2.0;
  /** The bound of the radius-edge ratio is all that is asked for; see Rules4D. */
  static constexpr double PreferredRatio = 1.0;
  static constexpr double PreferredSpacing = 1.0;
  /**
   * The sliver rule keeps this distance from vertices, times Delta. Free vertices in the way of a
   * feature point are excepted. With 0.4 a few slivers of the knee atlas stay, with 0.25 none.
   */
  static constexpr double SliverSpacing = 0.25;
  /**
   * Points that the facet rule inserts to make facets flat keep this distance from feature
   * vertices, times Delta. Its other points keep it from cut faces, if
   * they can.
   */
  static constexpr double CutClearance = 0.25;

  class BetterStar;
  RuleOutcome FacetRule(const Element& t);
  bool IsSliver(SimplexId t, double radius2) const;
  RuleOutcome SliverRule(const Element& t);
  RuleOutcome SplitSliver(const Element& t, double tolerance);
  RuleOutcome SampleAtSliver(const Element& t, double tolerance);
  RuleOutcome SampleFacets(SimplexId s, const Element& t, double tolerance);
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
  void MoveToBorderEdge(const Point<3>& onFace, double reach, double clearance, Point<3>& z) const;
  void MoveOntoBorder(Point<3>& z, double clearance) const;

  const double CosineOfFacetAngle;
  const double SineOfSliverAngle; ///< 0: slivers are left alone
  const double SineInside;        ///< the same for slivers that are not wedged between interfaces
};

} // namespace voxplex

#endif
