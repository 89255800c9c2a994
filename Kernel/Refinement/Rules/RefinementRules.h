// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RefinementRules.h
 * @brief The rules by which elements are refined, and what those of 3D and 4D share.
 *
 * A rule is named by what it bounds. The thesis has numbers for them, which differ between sections
 * 3.1 (3D) and 4.2 (4D); statistics are shown under these numbers.
 *
 * | rule           | 3D | 4D | bounds                                                          |
 * | -------------- | -- | -- | --------------------------------------------------------------- |
 * | sample spacing | R1 | R1 | distance from an interface to the feature vertices              |
 * | ball           | R2 | R2 | circumradius, if the circumball meets an interface              |
 * | facet          | R3 | R5 | angles of interface facets (3D), and where their vertices are   |
 * | radius-edge    | R4 | R3 | circumradius over shortest edge                                 |
 * | size           | R5 | -  | circumradius, by a size function                                |
 * | removal        | R6 | -  | distance of free vertices from new feature vertices; 4D: in R5  |
 * | sliver         | R7 | R4 | dihedral angles (3D; section 2.6.2), normalized volume (4D)     |
 *
 * Let c(t) and r(t) be the centre and radius of the circumball of an element t, dOmega the union of
 * the interfaces, cfp(p) the feature point (point of an interface) closest to p, and Delta(z) the
 * sampling distance at a feature point z (SizingField::SamplingDistance). Each rule gives a
 * condition and an operation:
 *
 * - Sample spacing: the circumball of t meets dOmega, and no feature vertex is nearer than Delta(z)
 *   to z = cfp(c(t)): insert z.
 * - Ball: the circumball of t meets dOmega, and r(t) >= 2 Delta(z): insert c(t). If c(t) is outside
 *   the box, insert its projection onto the box.
 * - Radius-edge: c(t) is inside the object, and r(t) / shortest edge >= rho-bar: insert c(t). In 4D
 *   see also Rules4D::PreferredRatio.
 * - Size: c(t) is inside the object, and r(t) >= sf(c(t)): insert c(t).
 * - Removal: a rule inserted a feature vertex z: remove the free vertices of its star that are
 *   nearer than RemovalRadius Delta(z).
 * - Facet, sliver: see Rules3D.h and Rules4D.h.
 */
#ifndef voxplex_RefinementRules_h
#define voxplex_RefinementRules_h

#include "Geometry/SimplexQuality.h"
#include "Refinement/RefinementContext.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace voxplex
{

/**
 * Circumradii are certified to within CircumballTolerance. The bounds of elements are tightened by
 * a little more, so that elements keep them in any arithmetic.
 */
inline constexpr double BoundSafety = 1.0 - 10.0 * CircumballTolerance;

/**
 * @brief The base of a set of rules: one instance per thread. It has no state except references and
 * scratch memory.
 *
 * The derived class Rules has `bool IsSliver(SimplexId, double radius2)`, where radius2 is the
 * squared circumradius.
 *
 * **Flat ends** (Domain::HasTimeBorder, in 4D). Elements near a flat end are good under two
 * conditions. No vertex lies near the end without being on it. No vertex of the end lies near an
 * interface without being on the interface. So
 * - a circumcentre beyond the end or near it is moved onto it; a feature point near it is moved to
 *   where the interface meets the end;
 * - if a point moved onto the end is near an interface, a feature point on both takes its place.
 *
 * A point on the end that would crowd feature vertices is refused.
 *
 * **Bounded work.** Every insertion is counted in the region of the point that asked for it: c(t),
 * or the feature point. A region needs a few dozen insertions at most. `Rules::WorkLimit` is
 * several times the largest count that was seen where refinement goes well. Beyond the limit the
 * rules give way step by step (Relaxation). So a region takes at most 4 WorkLimit insertions, plus
 * those of the sample spacing rule, which keep Delta(z) from each other. Hence refinement ends on
 * every input.
 */
template <int D, typename Rules>
class RefinementRules
{
public:
  static constexpr int Dimension = D;

  RefinementRules(RefinementContext<D>& context, RefinementWorker<D>& worker)
    : Context(context)
    , Worker(worker)
  {
  }

  /**
   * Call this after every operation. Pushes the new simplices that may be poor, judged by cheap
   * bounds alone.
   */
  void ScreenCreated()
  {
    if (this->Worker.ScreensLater)
    {
      return;
    }
    for (const SimplexId t : this->Worker.Kernel.Created)
    {
      if (this->MayBePoor(t))
      {
        this->Worker.Poor.Push(t, this->Context.Mesh.State(t).Generation);
      }
    }
  }

  /**
   * Inserts a feature point and applies the removal rule, unless the point would crowd others. A
   * point near a flat end is moved to where an interface meets the end. A shared point is inserted
   * as it is. No other thread may operate meanwhile.
   * @param near a living simplex, where the search begins; receives one near the point if the point
   *   is inserted
   * @return whether the point is inserted; then the worker's NewVertex has it
   */
  bool InsertSeed(const FeatureSeed<D>& seed, SimplexId& near);

  /**
   * Tries the last of the worker's pending removals again. Vertices that a removal brings within
   * reach are removed after it.
   */
  RuleOutcome RemovePending()
  {
    const PendingRemoval<D> pending = this->Worker.PendingRemovals.back();
    if ((this->Worker.Zone && !this->Worker.Zone->Extent.Contains(pending.Position)) ||
      !this->Context.Mesh.TryLock(this->Worker.Kernel, pending.Vertex))
    {
      return RuleOutcome::Contended;
    }
    const Vertex& vertex = this->Context.Mesh.GetVertex(pending.Vertex);
    RuleOutcome verdict = RuleOutcome::Good;
    if (vertex.Alive && vertex.Kind == VertexKind::Free && vertex.Position == pending.Position)
    {
      const RemovalOutcome outcome = this->Remove(pending.Vertex);
      if (outcome == RemovalOutcome::Contended)
      {
        return RuleOutcome::Contended;
      }
      verdict = outcome == RemovalOutcome::Removed ? RuleOutcome::Changed : RuleOutcome::Good;
    }
    this->Worker.PendingRemovals.pop_back();
    if (verdict == RuleOutcome::Changed)
    {
      this->ToRemove.clear();
      this->FindVerticesToRemove(pending.Feature, pending.Radius);
      for (const VertexId v : this->ToRemove)
      {
        this->Worker.PendingRemovals.push_back(
          { v, this->Context.Mesh.Position(v), pending.Feature, pending.Radius });
      }
    }
    return verdict;
  }

protected:
  using Mesh = Triangulation<D>;
  using Vertex = typename Mesh::Vertex;

  /** The simplex under evaluation. */
  struct Element
  {
    SimplexId Id;
    Circumball<D> Ball;
    double Radius;
    LabelId Label;       ///< of the circumcentre
    LabelId LabelInMesh; ///< the same, except beside planes between slabs
  };

  Element MakeElement(SimplexId id)
  {
    assert(this->Context.Mesh.OwnsAll(this->Worker.Kernel, this->Context.Mesh.GetSimplex(id).V));
    Element t;
    t.Id = id;
    t.Ball = this->Context.Mesh.GetCircumball(id);
    t.Radius = std::sqrt(t.Ball.Radius2);
    t.Label = t.LabelInMesh = this->LabelOf(id, t.Ball.Center);
    return t;
  }

  LabelId LabelOf(SimplexId t)
  {
    assert(this->Context.Mesh.OwnsFacet(this->Worker.Kernel, t));
    const SimplexState& state = this->Context.Mesh.State(t);
    return state.Labelled ? state.Label
                          : this->LabelOf(t, this->Context.Mesh.GetCircumball(t).Center);
  }

  LabelId LabelOf(SimplexId t, const Point<D>& centre)
  {
    SimplexState& state = this->Context.Mesh.State(t);
    if (!state.Labelled)
    {
      state.Label = this->Context.Image.Label(centre);
      state.Labelled = true;
    }
    return state.Label;
  }

  double ShortestEdge(SimplexId t) const
  {
    const Triangulation<D>& mesh = this->Context.Mesh;
    return std::sqrt(ShortestEdge2<D>(mesh.Points(mesh.GetSimplex(t).V).data()));
  }

  /**
   * Cheap: one look-up of the distance bound, and labels only away from the interfaces, where a
   * label costs one look-up, too. Nearly all screened simplices die before they would be evaluated.
   */
  bool MayBePoor(SimplexId t)
  {
    if (this->ScreenDistance(t))
    {
      return true;
    }
    const Circumball<D>& ball = this->Context.Mesh.GetSimplex(t).Ball;
    const LabelId label = this->LabelOf(t, ball.Center);
    if (label != 0)
    {
      const double radius = std::sqrt(ball.Radius2);
      if (this->IsRatioBad(ball.Center, radius, this->ShortestEdge(t), label) ||
        radius >= BoundSafety * this->Context.Sizing.ElementSize(ball.Center, label) ||
        static_cast<const Rules*>(this)->IsSliver(t, ball.Radius2))
      {
        return true;
      }
    }
    return this->MayRestrictNeighbour(t, label);
  }

  /** Whether the circumball may meet an interface, by the distance bound; remembers it. */
  bool ScreenDistance(SimplexId t)
  {
    const Circumball<D>& ball = this->Context.Mesh.GetSimplex(t).Ball;
    bool near = true; // without a reliable ball the evaluation decides
    if (ball.Radius2 >= 0.0)
    {
      const double lower = this->Context.Image.DistanceBound(ball.Center);
      near = lower * lower <= ball.Radius2 || lower <= 0.0;
    }
    if (near)
    {
      this->Context.Mesh.State(t).NearSurface = true;
    }
    return near;
  }

  /**
   * Whether a neighbour that was judged before may have got a restricted facet: its ball meets an
   * interface, and the labels at the two circumcentres differ, or, beside planes, those in the mesh
   * may.
   */
  bool MayRestrictNeighbour(SimplexId t, LabelId label) const
  {
    for (const SimplexId n : this->Context.Mesh.GetSimplex(t).N)
    {
      if (n != None)
      {
        const SimplexState& other = this->Context.Mesh.State(n);
        if (other.NearSurface && other.Labelled &&
          (other.Label != label || this->Context.HasPlanes()))
        {
          return true;
        }
      }
    }
    return false;
  }

  /**
   * A quick test: most simplices near an interface have a feature vertex near cfp(c(t)). Returns
   * true if neither the sample spacing rule nor the ball rule applies.
   * @param search receives the start of the search for cfp(c(t)), if it was started
   */
  bool IsSampled(const Element& t, typename Domain<D>::Search& search) const
  {
    Point<D> z;
    double error = 0.0;
    if (t.Radius >= 2.0 * this->Context.Sizing.Largest() ||
      !this->Context.Image.StartSearch(t.Ball.Center, t.Label, z, error, search))
    {
      return false;
    }
    const double delta = this->DeltaBehind(t, z);
    return t.Radius < 2.0 * delta && error < delta && this->FeatureVertexNear(t, z, delta - error);
  }

  /** The sample spacing rule and the ball rule. */
  RuleOutcome SampleInterface(const Element& t)
  {
    typename Domain<D>::Search search;
    if (!this->Context.Mesh.State(t.Id).NearSurface || this->IsSampled(t, search))
    {
      return RuleOutcome::Good;
    }
    Point<D> z;
    ++this->Worker.Statistics.ClosestSurfacePointCalls;
    if (!this->Context.Image.FinishSearch(search, t.Ball.Center, t.Label, z) ||
      Distance2(z, t.Ball.Center) > t.Ball.Radius2)
    {
      return RuleOutcome::Good;
    }
    const double delta = this->DeltaBehind(t, z);
    const RuleOutcome verdict = this->SampleSpacingRule(t, z, delta);
    return verdict == RuleOutcome::Good ? this->BallRule(t, delta) : verdict;
  }

  RuleOutcome SampleSpacingRule(const Element& t, const Point<D>& closest, double delta)
  {
    const Point<D> z = this->Context.OnEndIfNextTo(closest, delta);
    if (this->FeatureVertexNear(t, z, delta))
    {
      return RuleOutcome::Good;
    }
    std::uint64_t& fired = this->Worker.Statistics.Fired[RuleNumber<D>::SampleSpacing];
    Point<D> snapped;
    if (!this->Context.SnapToEnd(z, delta, snapped))
    {
      return this->InsertFeature(z, delta, delta, t.Id, None, fired);
    }
    return this->FeatureVertexNear(t, snapped, delta)
      ? RuleOutcome::Good
      : this->InsertFeature(snapped, delta, delta, t.Id, None, fired);
  }

  RuleOutcome BallRule(const Element& t, double delta)
  {
    return t.Radius >= 2.0 * delta
      ? this->InsertCircumcentre(t, this->Worker.Statistics.Fired[RuleNumber<D>::Ball], delta)
      : RuleOutcome::Good;
  }

  RuleOutcome RadiusEdgeRule(const Element& t)
  {
    const bool isBad = t.LabelInMesh != 0 &&
      this->IsRatioBad(t.Ball.Center, t.Radius, this->ShortestEdge(t.Id), t.LabelInMesh);
    return isBad
      ? this->InsertCircumcentre(t, this->Worker.Statistics.Fired[RuleNumber<D>::RadiusEdge])
      : RuleOutcome::Good;
  }

  RuleOutcome SizeRule(const Element& t, std::uint64_t& fired)
  {
    const bool isTooLarge = t.LabelInMesh != 0 &&
      t.Radius >= BoundSafety * this->Context.Sizing.ElementSize(t.Ball.Center, t.LabelInMesh);
    return isTooLarge ? this->InsertCircumcentre(t, fired) : RuleOutcome::Good;
  }

  /**
   * Whether the radius-edge ratio is not below its bound, or not below the preferred part of it
   * while the circumcentre is far enough from all vertices, and not near a face of the box.
   */
  bool IsRatioBad(const Point<D>& centre, double radius, double shortestEdge, LabelId label) const
  {
    const double least = BoundSafety * this->Context.Settings.Shape.RadiusEdgeRatio * shortestEdge;
    return radius >= least ||
      (radius >= Rules::PreferredRatio * least &&
        radius >= Rules::PreferredSpacing *
            std::max(
              this->Context.Sizing.Spacing(centre, label), this->Context.Sizing.Base().Asked) &&
        !this->MakeInsertionPoint(centre, CentreMargin * radius).Moved);
  }

  /**
   * Whether it is the turn of slivers: nothing else is left, and the zone does not put them off.
   */
  bool AreSliversNext() const
  {
    return this->Worker.Poor.OnlyLast() && !(this->Worker.Zone && this->Worker.Zone->DefersSlivers);
  }

  /**
   * Delta(z) for z = cfp(c(t)). The label on this side is known; the label beyond is looked up just
   * behind z.
   */
  double DeltaBehind(const Element& t, const Point<D>& z) const
  {
    const SizingField<D>& sizing = this->Context.Sizing;
    return sizing.DependsOnLabels(z) ? sizing.SamplingDistanceBehind(t.Ball.Center, t.Label, z)
                                     : sizing.BaseAt(z);
  }

  bool OwnFeatureVertexNear(const Element& t, const Point<D>& z, double distance) const
  {
    for (const VertexId v : this->Context.Mesh.GetSimplex(t.Id).V)
    {
      const Vertex& vertex = this->Context.Mesh.GetVertex(v);
      if (vertex.Kind == VertexKind::Feature && Distance2(vertex.Position, z) < distance * distance)
      {
        return true;
      }
    }
    return false;
  }

  bool FeatureVertexNear(const Element& t, const Point<D>& z, double distance) const
  {
    return this->OwnFeatureVertexNear(t, z, distance) || this->AnyFeatureWithin(z, distance);
  }

  /**
   * Whether a feature vertex is nearer to p than a distance. If that cannot be known inside of the
   * worker's zone, the evaluation is put off.
   */
  bool AnyFeatureWithin(const Point<D>& p, double distance) const
  {
    if (this->Worker.Zone && !this->Worker.Zone->Extent.ContainsBall(p, distance))
    {
      this->Worker.Zone->NeedsOutside = true;
      return true;
    }
    return this->Context.Features.AnyWithin(p, distance);
  }

  /** Inserts a point, unless the evaluation is put off or the point lies on a closed end. */
  InsertionOutcome Insert(const Point<D>& p, VertexKind kind, SimplexId seed, double clearance,
    typename Mesh::InsertionVeto* veto = nullptr)
  {
    if (this->Worker.Zone && this->Worker.Zone->NeedsOutside)
    {
      return InsertionOutcome::Contended;
    }
    if (this->Context.IsOnClosedEnd(p))
    {
      ++this->Worker.Statistics.RefusedOnClosedEnd;
      return InsertionOutcome::Rejected;
    }
    return this->Context.Mesh.Insert(this->Worker.Kernel, p, kind, seed, clearance, veto);
  }

  /**
   * Where a point is inserted that must keep a margin from flat ends, and as which kind of vertex.
   */
  struct InsertionPoint
  {
    Point<D> Position;
    VertexKind Kind;
    bool Moved;
    bool OnEnd;
  };

  /**
   * Moves p into the box, onto a face next to it, and onto a flat end if p itself is that near or
   * beyond it.
   */
  InsertionPoint MakeInsertionPoint(const Point<D>& p, double margin) const
  {
    const Point<D> inBox =
      this->Context.Mesh.GetBox().Clamp(p, FaceMargin * this->Context.Sizing.SpacingFloor());
    const bool moved = inBox != p;
    InsertionPoint place{ inBox, moved ? VertexKind::Box : VertexKind::Free, moved, false };
    double& time = place.Position[static_cast<std::size_t>(D) - 1];
    const double end = this->Context.NearestFlatEnd(time);
    if (time == end || std::abs(p[D - 1] - end) < margin)
    {
      place.Moved |= time != end;
      time = end;
      place.Kind = this->Context.IsOnSide(place.Position) ? VertexKind::Box : VertexKind::Free;
      place.OnEnd = true;
    }
    return place;
  }

  /**
   * Inserts c(t), or its projection onto the box or onto a flat end that is near.
   * @param deltaBeside Delta(z) of the interface that needs the point: the spacing there is at most
   *   this
   */
  RuleOutcome InsertCircumcentre(const Element& t, std::uint64_t& fired,
    double deltaBeside = std::numeric_limits<double>::infinity())
  {
    const InsertionPoint place = this->MakeInsertionPoint(t.Ball.Center, CentreMargin * t.Radius);
    Point<D> z;
    const double delta = place.OnEnd && this->Context.Sizing.DependsOnLabels(place.Position)
      ? this->Context.Sizing.SamplingDistance(
          place.Position, t.Label, this->Context.Image.Label(place.Position))
      : this->Context.Sizing.BaseAt(place.Position);
    const double spacing =
      std::min(deltaBeside, this->Context.Sizing.Spacing(place.Position, t.Label));
    if (this->RelaxationAt(place.Position, spacing) == Relaxation::All)
    {
      return RuleOutcome::Good;
    }
    if (place.OnEnd && this->Context.Image.ClosestSurfacePointOnEnd(place.Position, z) &&
      Distance2(z, place.Position) < InterfaceMargin * InterfaceMargin * delta * delta)
    {
      return this->InsertFeatureOnEnd(z, delta, t, None, fired);
    }
    // The circumball is empty, so only a point that was moved can be near a vertex.
    const double clearance =
      place.Moved ? SpacingFloorFraction * this->Context.Sizing.Spacing(place.Position) : 0.0;
    const InsertionOutcome outcome = this->Insert(place.Position, place.Kind, t.Id, clearance);
    const RuleOutcome verdict = this->CountOutcome(outcome, fired);
    if (verdict == RuleOutcome::Changed)
    {
      this->CountWork(place.Position, spacing);
      this->Worker.Statistics.Projected += place.Moved ? 1 : 0;
      this->ScreenCreated();
    }
    return verdict;
  }

  /**
   * Inserts a feature point and removes the free vertices near it. On entry no feature vertex is
   * nearer to z than the clearance, unless another thread has inserted it meanwhile.
   * @param veto may be null
   */
  RuleOutcome InsertFeature(const Point<D>& z, double delta, double clearance, SimplexId seed,
    SimplexId otherSeed, std::uint64_t& fired, typename Mesh::InsertionVeto* veto = nullptr)
  {
    InsertionOutcome outcome = this->Insert(z, VertexKind::Feature, seed, clearance, veto);
    if (outcome == InsertionOutcome::NoConflict && otherSeed != None)
    {
      outcome = this->Insert(z, VertexKind::Feature, otherSeed, clearance, veto);
    }
    const RuleOutcome verdict = this->CountOutcome(outcome, fired);
    if (verdict == RuleOutcome::Changed)
    {
      const double spacing = std::min(delta, this->Context.Sizing.Spacing(z));
      this->CountWork(z, spacing);
      this->Context.Features.Add(z);
      this->ScreenCreated();
      if (this->RelaxationAt(z, spacing) != Relaxation::All)
      {
        this->RemoveFreeVertices(this->Worker.Kernel.NewVertex, Rules::RemovalRadius * delta);
      }
    }
    return verdict;
  }

  /** Inserts a feature point of a flat end, unless it would crowd other feature vertices. */
  RuleOutcome InsertFeatureOnEnd(
    const Point<D>& z, double delta, const Element& t, SimplexId otherSeed, std::uint64_t& fired)
  {
    const double spacing = EndSpacing * delta;
    if (this->FeatureVertexNear(t, z, spacing))
    {
      ++this->Worker.Statistics.RefusedTooClose;
      return RuleOutcome::Good;
    }
    return this->InsertFeature(z, delta, spacing, t.Id, otherSeed, fired);
  }

  // These and EndMargin were chosen on a beating ventricle. Without the last two, the
  // radius-edge rule and the facet rule answer each other as long as there is room, and elements of
  // ratio 15 remain.
  /** A circumcentre nearer to a flat end than this, in circumradii, is moved onto it. */
  static constexpr double CentreMargin = 0.5;
  /**
   * In spacing floors. Points nearer to a face of the box make balls so large that rounding tells
   * what they meet.
   */
  static constexpr double FaceMargin = 1e-5;
  /**
   * A point on an end that is nearer to an interface than this, in delta, is moved onto the
   * interface.
   */
  static constexpr double InterfaceMargin = 0.7;
  /**
   * Smallest distance of feature vertices on an end, in delta, except for those of the sample
   * spacing rule.
   */
  static constexpr double EndSpacing = 0.6;

private:
  bool InsertShared(const FeatureSeed<D>& seed, SimplexId& near);
  bool FindSeedPosition(const FeatureSeed<D>& seed, Point<D>& z) const;

  /**
   * Removes the free vertices adjacent to z that are nearer than the radius. A removal can make
   * other vertices adjacent, so this is repeated until none is left. On entry worker.Created holds
   * the star of z.
   */
  void RemoveFreeVertices(VertexId z, double radius)
  {
    std::size_t done = 0;
    this->ToRemove.clear();
    for (;;)
    {
      this->FindVerticesToRemove(z, radius);
      if (done == this->ToRemove.size())
      {
        return;
      }
      const VertexId v = this->ToRemove[done++];
      if (this->Remove(v) == RemovalOutcome::Contended)
      {
        this->Worker.PendingRemovals.push_back({ v, this->Context.Mesh.Position(v), z, radius });
      }
    }
  }

  /**
   * Whether the removal rule removes a vertex. Where the spacing is smaller than Delta, the vertex
   * may serve a finer interface, and the radius is smaller, too.
   */
  bool IsTooNear(const Point<D>& vertex, const Point<D>& feature, double radius) const
  {
    const double distance2 = Distance2(vertex, feature);
    if (distance2 >= radius * radius)
    {
      return false;
    }
    const double own = Rules::RemovalRadius * this->Context.Sizing.Spacing(vertex);
    return distance2 < own * own;
  }

  /** Adds to ToRemove the free vertices of worker.Created that are nearer to z than the radius. */
  void FindVerticesToRemove(VertexId z, double radius)
  {
    const Mesh& mesh = this->Context.Mesh;
    const Point<D> centre = mesh.Position(z);
    for (const SimplexId t : this->Worker.Kernel.Created)
    {
      for (const VertexId v : mesh.GetSimplex(t).V)
      {
        const Vertex& vertex = mesh.GetVertex(v);
        if (vertex.Kind == VertexKind::Free && this->IsTooNear(vertex.Position, centre, radius) &&
          std::find(this->ToRemove.begin(), this->ToRemove.end(), v) == this->ToRemove.end())
        {
          this->ToRemove.push_back(v);
        }
      }
    }
  }

  /** Afterwards worker.Created holds the simplices that were created, if any. */
  RemovalOutcome Remove(VertexId v)
  {
    const RemovalOutcome outcome = this->Context.Mesh.Remove(this->Worker.Kernel, v);
    if (outcome == RemovalOutcome::Removed)
    {
      ++this->Worker.Statistics.Removed;
      this->ScreenCreated();
      return outcome;
    }
    this->Worker.Statistics.RemovalsFailed += outcome == RemovalOutcome::Contended ? 0 : 1;
    this->Worker.Kernel.Created.Clear();
    return outcome;
  }

protected:
  /** How far the rules give way in the region of a point. */
  Relaxation RelaxationAt(const Point<D>& place, double spacing) const
  {
    const auto region = RegionalWork<D>::RegionOf(place, spacing);
    const std::uint32_t own = this->Worker.Zone ? this->Worker.Zone->WorkIn(region) : 0;
    return RelaxationAfter(this->Context.Work.At(region) + own, Rules::WorkLimit);
  }

  /** Counts an insertion in the region of a point. */
  void CountWork(const Point<D>& place, double spacing)
  {
    const auto region = RegionalWork<D>::RegionOf(place, spacing);
    const std::uint32_t work = this->Worker.Zone
      ? this->Context.Work.At(region) + ++this->Worker.Zone->Work[region]
      : this->Context.Work.Add(region) + 1;
    std::uint64_t& most = this->Worker.Statistics.LargestRegionalWork;
    most = std::max<std::uint64_t>(most, work);
    const Relaxation step = RelaxationAfter(work, Rules::WorkLimit);
    if (step != RelaxationAfter(work - 1, Rules::WorkLimit))
    {
      this->Worker.RelaxedRegions.push_back({ place, step });
    }
  }

  RuleOutcome CountOutcome(InsertionOutcome outcome, std::uint64_t& fired)
  {
    RuleStatistics& statistics = this->Worker.Statistics;
    switch (outcome)
    {
      case InsertionOutcome::Inserted:
        ++fired;
        statistics.CavitySimplices += this->Worker.Kernel.Deleted.Size();
        statistics.LargestCavity =
          std::max<std::uint64_t>(statistics.LargestCavity, this->Worker.Kernel.Deleted.Size());
        return RuleOutcome::Changed;
      case InsertionOutcome::NoConflict:
        ++statistics.RefusedNoConflict;
        return RuleOutcome::Good;
      case InsertionOutcome::Duplicate:
        ++statistics.RefusedDuplicate;
        return RuleOutcome::Good;
      case InsertionOutcome::TooClose:
        ++statistics.RefusedTooClose;
        return RuleOutcome::Good;
      case InsertionOutcome::Rejected:
        return RuleOutcome::Good;
      case InsertionOutcome::Contended:
        return RuleOutcome::Contended;
    }
    return RuleOutcome::Good;
  }

  RefinementContext<D>& Context;
  RefinementWorker<D>& Worker;

private:
  std::vector<VertexId> ToRemove; ///< scratch memory of RemoveFreeVertices
};

} // namespace voxplex

#include "Refinement/Rules/SeedInsertion.txx"

#endif
