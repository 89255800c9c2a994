// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RuleVocabulary.h
 * @brief What the rules of 3D and 4D are written in: circumballs, closest feature points, insertions.
 */
#ifndef voxplex_RuleVocabulary_h
#define voxplex_RuleVocabulary_h

#include "Refinement/RefinementContext.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace voxplex
{

/**
 * Circumradii are certified to within CircumballTolerance; elements are held a little below the bounds,
 * so that they keep them in anybody's arithmetic.
 */
inline constexpr double BoundSafety = 1.0 - 10.0 * CircumballTolerance;

/**
 * @brief The base of a set of rules: one instance per thread, no state of its own but references.
 *
 * Rules (the derived class) has `bool MayBePoor(SimplexId)`, by which new simplices are screened.
 *
 * **Flat ends** (Domain::IsFlatEnd, in 4D). Elements near such an end are good if no vertex lies near it
 * without being on it, and none of the end's vertices near an interface without being on that. So
 * - a circumcentre beyond the end or near it is moved onto it; a feature point near it is moved to where
 *   the interface meets the end;
 * - a point moved onto the end near an interface gives way to a feature point on both.
 *
 * Points on the end that would crowd feature vertices are refused.
 *
 * **Bounded work.** Every insertion is counted in the region of the place that asked for it: c(t), or the feature point.
 * No region needs more than some dozen; `Rules::WorkLimit` is several times what was ever seen where refinement
 * goes well. Beyond it rules give way step by step (Yielding). So a region takes at most 4 WorkLimit insertions, and
 * those of R1, which keep Delta(z) from each other. There is no input on which refinement does not end.
 */
template <int D, typename Rules>
class RuleVocabulary
{
public:
  static constexpr int Dimension = D;

  RuleVocabulary(RefinementContext<D>& context, RefinementWorker<D>& worker)
    : Context(context)
    , Worker(worker)
  {
  }

  /** After every operation: pushes the new simplices that may be poor, by cheap bounds alone. */
  void ScreenCreated()
  {
    if (this->Worker.ScreensLater)
    {
      return;
    }
    this->Worker.RemoveDeleted(this->Context.Mesh);
    for (const SimplexId t : this->Worker.Kernel.Created)
    {
      if (static_cast<Rules*>(this)->MayBePoor(t))
      {
        this->Worker.Poor.Push(t, this->Context.Mesh.State(t).Generation);
      }
    }
  }

  /**
   * Inserts a feature point unless it would crowd others or is near a flat end, with R6.
   * @param near a living simplex, for the search; receives one near the point if that is inserted
   */
  void InsertSeed(const FeatureSeed<D>& seed, SimplexId& near)
  {
    Point<D> onEnd;
    if (this->Context.Features.AnyWithin(seed.Position, seed.Delta) ||
      this->Context.IsNearEnd(seed.Position, seed.Delta, onEnd))
    {
      return;
    }
    const SimplexId conflict =
      this->Context.Mesh.FindConflict(this->Worker.Kernel, seed.Position, near);
    if (conflict != None)
    {
      this->Context.Mesh.Lock( // nobody else operates, so it succeeds
        this->Worker.Kernel, conflict, this->Context.Mesh.State(conflict).Generation);
      this->InsertFeature(
        seed.Position, seed.Delta, 0.0, conflict, None, this->Worker.Statistics.Fired[0]);
      near = this->Worker.Kernel.Created.Empty() ? near : this->Worker.Kernel.Created[0];
    }
  }

  /**
   * Tries the last of the worker's pending removals again. The vertex may be another one by now; then it
   * goes if it, too, is a free one so near. What its removal brings up goes after it.
   */
  Verdict RemovePending()
  {
    const PendingRemoval pending = this->Worker.PendingRemovals.back();
    if (!this->Context.Mesh.TryLock(this->Worker.Kernel, pending.Vertex))
    {
      return Verdict::Contended;
    }
    const Vertex& vertex = this->Context.Mesh.GetVertex(pending.Vertex);
    Verdict verdict = Verdict::Good;
    if (vertex.Alive && vertex.Kind == VertexKind::Free &&
      Distance2(vertex.Position, this->Context.Mesh.Position(pending.Feature)) <
        pending.Radius * pending.Radius)
    {
      const RemovalOutcome outcome = this->Remove(pending.Vertex);
      if (outcome == RemovalOutcome::Contended)
      {
        return Verdict::Contended;
      }
      verdict = outcome == RemovalOutcome::Removed ? Verdict::Changed : Verdict::Good;
    }
    this->Worker.PendingRemovals.pop_back();
    if (verdict == Verdict::Changed)
    {
      this->ToRemove.clear();
      this->FindVerticesToRemove(pending.Feature, pending.Radius);
      for (const VertexId v : this->ToRemove)
      {
        this->Worker.PendingRemovals.push_back({ v, pending.Feature, pending.Radius });
      }
    }
    return verdict;
  }

protected:
  using Mesh = Triangulation<D>;
  using Vertex = typename Mesh::Vertex;

  /** What the rules know of the simplex under evaluation. */
  struct Element
  {
    SimplexId Id;
    Circumball<D> Ball;
    double Radius;
    LabelId Label; ///< of the circumcentre
  };

  Element MakeElement(SimplexId id)
  {
    assert(this->Context.Mesh.OwnsAll(this->Worker.Kernel, this->Context.Mesh.GetSimplex(id).V));
    Element t;
    t.Id = id;
    t.Ball = this->Context.Mesh.GetCircumball(id);
    t.Radius = std::sqrt(t.Ball.Radius2);
    t.Label = this->LabelOf(id, t.Ball.Center);
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
    const auto& v = this->Context.Mesh.GetSimplex(t).V;
    double shortest2 = std::numeric_limits<double>::infinity();
    for (unsigned i = 0; i < v.size(); ++i)
    {
      for (unsigned j = 0; j < i; ++j)
      {
        shortest2 = std::min(shortest2,
          Distance2(this->Context.Mesh.Position(v[i]), this->Context.Mesh.Position(v[j])));
      }
    }
    return std::sqrt(shortest2);
  }

  /** Whether the circumball may meet an interface, by the distance bounds; remembers it. */
  bool ScreenDistance(SimplexId t)
  {
    const Circumball<D>& ball = this->Context.Mesh.GetSimplex(t).Ball;
    bool near = true; // no reliable ball: let the evaluation look closely
    if (ball.Radius2 >= 0.0)
    {
      const double lower = this->Context.Image.DistanceBounds(ball.Center).Lower;
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
   * interface, and the labels at the two circumcentres differ.
   */
  bool MayRestrictNeighbour(SimplexId t, LabelId label) const
  {
    for (const SimplexId n : this->Context.Mesh.GetSimplex(t).N)
    {
      if (n != None)
      {
        const SimplexState& other = this->Context.Mesh.State(n);
        if (other.NearSurface && other.Labelled && other.Label != label)
        {
          return true;
        }
      }
    }
    return false;
  }

  /**
   * Most simplices near an interface have a feature vertex near cfp(c(t)): a quick look at where that is
   * tells that neither R1 nor R2 applies.
   */
  bool IsSampled(const Element& t) const
  {
    Point<D> z;
    double error;
    if (t.Radius >= 2.0 * this->Context.Sizing.Largest() ||
      !this->Context.Image.NearSurfacePoint(t.Ball.Center, t.Label, z, error))
    {
      return false;
    }
    const double delta = this->DeltaBehind(t, z);
    return t.Radius < 2.0 * delta && error < delta && this->FeatureVertexNear(t, z, delta - error);
  }

  /** R1 and R2 (thesis, sections 3.1 and 4.2). */
  Verdict SampleInterface(const Element& t)
  {
    if (!this->Context.Mesh.State(t.Id).NearSurface || this->IsSampled(t))
    {
      return Verdict::Good;
    }
    Point<D> z;
    ++this->Worker.Statistics.ClosestSurfacePointCalls;
    if (!this->Context.Image.ClosestSurfacePoint(t.Ball.Center, t.Label, z) ||
      Distance2(z, t.Ball.Center) > t.Ball.Radius2)
    {
      return Verdict::Good;
    }
    const double delta = this->DeltaBehind(t, z);
    const Verdict verdict = this->R1(t, z, delta);
    return verdict == Verdict::Good ? this->R2(t, delta) : verdict;
  }

  Verdict R1(const Element& t, const Point<D>& z, double delta)
  {
    if (this->FeatureVertexNear(t, z, delta))
    {
      return Verdict::Good;
    }
    std::uint64_t& fired = this->Worker.Statistics.Fired[0];
    Point<D> snapped;
    if (!this->SnapToEnd(z, delta, snapped))
    {
      return this->InsertFeature(z, delta, delta, t.Id, None, fired);
    }
    return this->FeatureVertexNear(t, snapped, delta)
      ? Verdict::Good
      : this->InsertFeature(snapped, delta, delta, t.Id, None, fired);
  }

  Verdict R2(const Element& t, double delta)
  {
    return t.Radius >= 2.0 * delta
      ? this->InsertCircumcentre(t, this->Worker.Statistics.Fired[1], delta)
      : Verdict::Good;
  }

  bool HasBadRatio(const Element& t) const
  {
    return t.Label != 0 &&
      t.Radius >= BoundSafety * this->Context.Settings.RadiusEdgeRatio * this->ShortestEdge(t.Id);
  }

  bool IsTooLarge(const Element& t) const
  {
    return t.Label != 0 &&
      t.Radius >= BoundSafety * this->Context.Sizing.ElementSize(t.Ball.Center, t.Label);
  }

  /** Delta(z) for z = cfp(c(t)): the label on this side is known, that beyond is just behind z. */
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
    return this->OwnFeatureVertexNear(t, z, distance) ||
      this->Context.Features.AnyWithin(z, distance);
  }

  /** Where a point at p is put that is to keep off flat ends by a margin, and what it is there. */
  struct Place
  {
    Point<D> Position;
    VertexKind Kind;
    bool Moved;
    bool OnEnd;
  };

  /** Into the box, and onto a flat end that is nearer than the margin. */
  Place PlaceOf(const Point<D>& p, double margin) const
  {
    const Box<D>& box = this->Context.Mesh.GetBox();
    Place place{ p, VertexKind::Free, false, false };
    if (!box.Contains(p))
    {
      place = { box.Clamp(p), VertexKind::Box, true, false };
    }
    double& time = place.Position[static_cast<std::size_t>(D) - 1];
    const double end = this->Context.NearestFlatEnd(time);
    if (std::abs(time - end) < margin)
    {
      place.Moved |= time != end;
      time = end;
      place.Kind = this->IsOnSide(place.Position) ? VertexKind::Box : VertexKind::Free;
      place.OnEnd = true;
    }
    return place;
  }

  /**
   * Inserts c(t), or its projection onto the box or onto a flat end that is near.
   * @param deltaBeside Delta(z) of the interface for whose sake it is inserted: that is how near points may be needed
   */
  Verdict InsertCircumcentre(const Element& t, std::uint64_t& fired,
    double deltaBeside = std::numeric_limits<double>::infinity())
  {
    const Place place = this->PlaceOf(t.Ball.Center, CentreMargin * t.Radius);
    Point<D> z;
    const double delta = place.OnEnd && this->Context.Sizing.DependsOnLabels(place.Position)
      ? this->Context.Sizing.SamplingDistance(
          place.Position, t.Label, this->Context.Image.Label(place.Position))
      : this->Context.Sizing.Base().Delta;
    const double spacing =
      std::min(deltaBeside, this->Context.Sizing.Spacing(place.Position, t.Label));
    if (this->YieldingAt(place.Position, spacing) == Yielding::All)
    {
      return Verdict::Good;
    }
    if (place.OnEnd && this->Context.Image.ClosestSurfacePointOnEnd(place.Position, z) &&
      Distance2(z, place.Position) < InterfaceMargin * InterfaceMargin * delta * delta)
    {
      return this->InsertFeatureOnEnd(z, delta, t, None, fired);
    }
    // The circumball is empty: only a point that was moved can be near a vertex.
    const double clearance =
      place.Moved ? SpacingFloorFraction * this->Context.Sizing.Spacing(place.Position) : 0.0;
    const InsertionOutcome outcome =
      this->Context.Mesh.Insert(this->Worker.Kernel, place.Position, place.Kind, t.Id, clearance);
    const Verdict verdict = this->CountOutcome(outcome, fired);
    if (verdict == Verdict::Changed)
    {
      this->CountWork(place.Position, spacing);
      this->Worker.Statistics.Projected += place.Moved ? 1 : 0;
      this->ScreenCreated();
    }
    return verdict;
  }

  /**
   * Inserts a feature point and removes the free vertices near it. Nothing is nearer to z than the
   * clearance but for what another thread has inserted meanwhile.
   * @param judge may be null
   */
  Verdict InsertFeature(const Point<D>& z, double delta, double clearance, SimplexId seed,
    SimplexId otherSeed, std::uint64_t& fired, typename Mesh::Judge* judge = nullptr)
  {
    Mesh& mesh = this->Context.Mesh;
    InsertionOutcome outcome =
      mesh.Insert(this->Worker.Kernel, z, VertexKind::Feature, seed, clearance, judge);
    if (outcome == InsertionOutcome::NoConflict && otherSeed != None)
    {
      outcome =
        mesh.Insert(this->Worker.Kernel, z, VertexKind::Feature, otherSeed, clearance, judge);
    }
    const Verdict verdict = this->CountOutcome(outcome, fired);
    if (verdict == Verdict::Changed)
    {
      const double spacing = std::min(delta, this->Context.Sizing.Spacing(z));
      this->CountWork(z, spacing);
      this->Context.Features.Add(z);
      this->ScreenCreated();
      if (this->YieldingAt(z, spacing) != Yielding::All)
      {
        this->RemoveFreeVertices(this->Worker.Kernel.NewVertex, Rules::RemovalRadius * delta);
      }
    }
    return verdict;
  }

  /** Inserts a feature point of a flat end, unless it would crowd the others. */
  Verdict InsertFeatureOnEnd(
    const Point<D>& z, double delta, const Element& t, SimplexId otherSeed, std::uint64_t& fired)
  {
    const double spacing = EndSpacing * delta;
    if (this->FeatureVertexNear(t, z, spacing))
    {
      ++this->Worker.Statistics.RefusedTooClose;
      return Verdict::Good;
    }
    return this->InsertFeature(z, delta, spacing, t.Id, otherSeed, fired);
  }

  /**
   * Where an interface meets a flat end that is near z.
   * @return false if no end is near, z lies on one already, or no interface was found there
   */
  bool SnapToEnd(const Point<D>& z, double delta, Point<D>& snapped) const
  {
    Point<D> onEnd = z;
    return this->Context.IsNearEnd(z, delta, onEnd) &&
      this->Context.Image.ClosestSurfacePointOnEnd(onEnd, snapped);
  }

  // Chosen on a beating ventricle, as was EndMargin: without the last two R3 and R5 answer each other for as long as there
  // is room, and elements of ratio 15 remain.
  /** Circumcentres nearer to a flat end than this, in circumradii, are moved onto it. */
  static constexpr double CentreMargin = 0.5;
  /** Points on an end nearer to an interface than this, in delta, are moved onto that. */
  static constexpr double InterfaceMargin = 0.7;
  /** Feature vertices on an end are no nearer to each other than this, in delta, but for those of R1. */
  static constexpr double EndSpacing = 0.6;

private:
  /** Whether a point of the box is on one of its faces that are no flat ends. */
  bool IsOnSide(const Point<D>& p) const
  {
    const Box<D>& box = this->Context.Mesh.GetBox();
    for (std::size_t a = 0; a < static_cast<std::size_t>(D); ++a)
    {
      const bool time = a + 1 == static_cast<std::size_t>(D);
      if ((p[a] == box.Min[a] && !(time && this->Context.IsFlatEnd[0])) ||
        (p[a] == box.Max[a] && !(time && this->Context.IsFlatEnd[1])))
      {
        return true;
      }
    }
    return false;
  }

  /**
   * Removes the free vertices adjacent to z that are nearer than the radius; a removal can make others
   * adjacent, so it goes on until none is left. worker.Created holds the star of z on entry.
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
        this->Worker.PendingRemovals.push_back({ v, z, radius });
      }
    }
  }

  /** By R6; a vertex that serves interfaces with a smaller delta may be so much nearer. */
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

  /** Adds the free vertices of worker.Created that are nearer than the radius to z to ToRemove. */
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

  /** Afterwards worker.Created holds what was made, if anything. */
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
  /** How far rules give way in the region of a place. */
  Yielding YieldingAt(const Point<D>& place, double spacing) const
  {
    return YieldingOf(this->Context.Work.At(place, spacing), Rules::WorkLimit);
  }

  /** How near to others a feature point for the sake of facets may be. */
  double FacetClearance(double spacing, Yielding step) const
  {
    return (step < Yielding::Spacing ? SpacingFloorFraction : YieldingFraction) * spacing;
  }

  /** Counts an insertion that was asked for at a place. */
  void CountWork(const Point<D>& place, double spacing)
  {
    const std::uint32_t work = this->Context.Work.Add(place, spacing) + 1;
    std::uint64_t& most = this->Worker.Statistics.LargestRegionalWork;
    most = std::max<std::uint64_t>(most, work);
    const Yielding step = YieldingOf(work, Rules::WorkLimit);
    if (step != YieldingOf(work - 1, Rules::WorkLimit))
    {
      this->Worker.Yielded.push_back({ place, step });
    }
  }

  Verdict CountOutcome(InsertionOutcome outcome, std::uint64_t& fired)
  {
    RuleStatistics& statistics = this->Worker.Statistics;
    switch (outcome)
    {
      case InsertionOutcome::Inserted:
        ++fired;
        statistics.CavitySimplices += this->Worker.Kernel.Deleted.Size();
        statistics.LargestCavity =
          std::max<std::uint64_t>(statistics.LargestCavity, this->Worker.Kernel.Deleted.Size());
        return Verdict::Changed;
      case InsertionOutcome::NoConflict:
        ++statistics.RefusedNoConflict;
        return Verdict::Good;
      case InsertionOutcome::Duplicate:
        ++statistics.RefusedDuplicate;
        return Verdict::Good;
      case InsertionOutcome::TooClose:
        ++statistics.RefusedTooClose;
        return Verdict::Good;
      case InsertionOutcome::Rejected:
        return Verdict::Good;
      case InsertionOutcome::Contended:
        return Verdict::Contended;
    }
    return Verdict::Good;
  }

  RefinementContext<D>& Context;
  RefinementWorker<D>& Worker;

private:
  std::vector<VertexId> ToRemove; ///< scratch of RemoveFreeVertices
};

} // namespace voxplex

#endif
