// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Refinement/Rules/Rules4D.h"

#include "Geometry/SimplexQuality.h"
#include "Refinement/Rules/PickingRegion.h"
#include "Refinement/Rules/PlaneLabels.h"

#include <algorithm>
#include <cmath>

namespace voxplex
{

//------------------------------------------------------------------------------------------------
RuleOutcome Rules4D::Refine(SimplexId id)
{
  ++this->Worker.Statistics.Evaluated;
  Element s = this->MakeElement(id);
  const std::optional<Point<4>> onPlane = this->FacetCentreOnPlane(id);
  s.LabelInMesh = onPlane ? this->Context.Image.Label(*onPlane) : s.Label;
  const bool ratioFirst = this->Context.Settings.SpaceTime.Order == RuleOrder::RadiusEdgeFirst;
  RuleOutcome outcome = ratioFirst ? this->RadiusEdgeRule(s) : this->SampleInterface(s);
  if (outcome == RuleOutcome::Good)
  {
    outcome = ratioFirst ? this->SampleInterface(s) : this->RadiusEdgeRule(s);
  }
  outcome = outcome == RuleOutcome::Good ? this->FacetRule(s, onPlane) : outcome;
  if (outcome == RuleOutcome::Good)
  {
    outcome = this->SizeRule(s, this->Worker.Statistics.FiredBySize);
  }
  if (outcome == RuleOutcome::Good && s.LabelInMesh != 0 && this->IsSliver(id, s.Ball.Radius2))
  {
    if (this->AreSliversNext())
    {
      return this->SliverRule(s);
    }
    this->Worker.Poor.PushLast(id, this->Context.Mesh.State(id).Generation);
  }
  return outcome;
}

//------------------------------------------------------------------------------------------------
std::optional<Point<4>> Rules4D::FacetCentreOnPlane(SimplexId s) const
{
  const std::array<bool, 2>& isPlane = this->Context.IsPlane;
  if (!this->Context.HasPlanes())
  {
    return std::nullopt;
  }
  const Triangulation<4>& mesh = this->Context.Mesh;
  const auto facet = FacetOnPlane(mesh, s,
    [&](double time)
    {
      return (isPlane[0] && time == mesh.GetBox().Min[3]) ||
        (isPlane[1] && time == mesh.GetBox().Max[3]);
    });
  return facet ? std::optional(CentreOnPlane(mesh, *facet)) : std::nullopt;
}

//------------------------------------------------------------------------------------------------
bool Rules4D::IsSliver(SimplexId s, double radius2) const
{
  const Triangulation<4>& mesh = this->Context.Mesh;
  const auto& slivers = this->Context.Settings.SpaceTime.Slivers;
  return slivers.Fight &&
    !(NormalizedVolume<4>(mesh.Points(mesh.GetSimplex(s).V).data(), radius2) >=
      slivers.VolumeBound);
}

//------------------------------------------------------------------------------------------------
/** Accepts the first point that makes no small sliver, and remembers the best. */
class Rules4D::BestPick final : public Triangulation<4>::InsertionVeto
{
public:
  /** @param radius of the ball around the first candidate */
  BestPick(const RefinementContext<4>& context, double radius, const Point<4>& first)
    : Candidate(first)
    , Context(context)
    , Bound(context.Settings.SpaceTime.Slivers.VolumeBound)
    , SmallRadius(context.Settings.SpaceTime.Slivers.RadiusFactor * radius)
  {
  }

  Point<4> Candidate;
  Point<4> Best{};
  double BestVolume = -1.0; ///< smallest normalized volume that the best point makes
  bool HasBest = false;
  bool AcceptAll = false;

  bool Accepts(const Triangulation<4>::Worker& worker) override
  {
    if (this->AcceptAll)
    {
      return true;
    }
    double smallest = 1.0;
    for (std::size_t k = 0; k < worker.NumberOfNewSimplices() && smallest > this->BestVolume; ++k)
    {
      std::uint32_t apex = 0;
      const auto& v = worker.NewSimplex(k, apex);
      std::array<const Point<4>*, 5> points;
      for (unsigned i = 0; i < 5; ++i)
      {
        points[i] = i == apex ? &this->Candidate : &this->Context.Mesh.Position(v[i]);
      }
      Circumball<4> ball;
      ComputeCircumball<4>(points.data(), ball);
      const double volume = NormalizedVolume<4>(points.data(), ball.Radius2);
      if (!(volume >= std::min(smallest, this->Bound)) &&
        !(ball.Radius2 >= this->SmallRadius * this->SmallRadius) &&
        this->Context.Image.Label(ball.Center) != 0)
      {
        smallest = volume >= 0.0 ? volume : 0.0;
      }
    }
    if (smallest > this->BestVolume)
    {
      this->BestVolume = smallest;
      this->Best = this->Candidate;
      this->HasBest = true;
    }
    return smallest >= this->Bound;
  }

private:
  const RefinementContext<4>& Context;
  const double Bound;
  const double SmallRadius;
};

//------------------------------------------------------------------------------------------------
RuleOutcome Rules4D::SliverRule(const Element& s)
{
  RuleStatistics& statistics = this->Worker.Statistics;
  const SliverOptions& options = this->Context.Settings.SpaceTime.Slivers;
  ++statistics.SliversFound;
  const double spacing = this->Context.Sizing.Spacing(s.Ball.Center, s.Label);
  if (this->RelaxationAt(s.Ball.Center, spacing) != Relaxation::Nothing)
  {
    ++statistics.SliversKept;
    return RuleOutcome::Good;
  }
  const double clearance = SliverSpacing * spacing;
  PseudoRandom<4> random(options.Seed, s.Ball.Center);
  BestPick veto(this->Context, s.Radius, s.Ball.Center);
  const RuleOutcome outcome = InsertPick(
    this->Worker.Statistics, this->Context.Settings.SpaceTime.Slivers.Picks, veto,
    [&](Point<4>& p)
    {
      p = random.InBall(s.Ball.Center, options.PickingRadius * s.Radius);
      return true;
    },
    [&](Point<4>& p)
    {
      const InsertionPoint place = this->MakeInsertionPoint(p, CentreMargin * s.Radius);
      p = place.Position;
      const RuleOutcome inserted =
        this->CountOutcome(this->Insert(p, place.Kind, s.Id, clearance, &veto),
          statistics.Fired[RuleNumber<4>::Sliver]);
      if (inserted == RuleOutcome::Changed)
      {
        this->CountWork(s.Ball.Center, spacing);
        this->ScreenCreated();
      }
      return inserted;
    });
  statistics.SliversKept += outcome == RuleOutcome::Good ? 1 : 0;
  return outcome;
}

//------------------------------------------------------------------------------------------------
RuleOutcome Rules4D::FacetRule(const Element& s, const std::optional<Point<4>>& onPlane)
{
  const Triangulation<4>& mesh = this->Context.Mesh;
  const Triangulation<4>::Simplex& simplex = mesh.GetSimplex(s.Id);
  const bool near = mesh.State(s.Id).NearSurface;
  for (unsigned i = 0; i < 5; ++i)
  {
    const SimplexId n = simplex.N[i];
    if (n == None || !(near || mesh.State(n).NearSurface))
    {
      continue;
    }
    const LabelId atOther = this->LabelOf(n);
    const std::optional<Point<4>> otherOnPlane = this->FacetCentreOnPlane(n);
    const LabelId other = otherOnPlane ? this->Context.Image.Label(*otherOnPlane) : atOther;
    if (other == s.LabelInMesh || this->FacetIsGood(simplex.V, i))
    {
      continue;
    }
    // The labels along the way from s to n: on the plane, at c(s), at c(n), on the plane.
    const Point<4>& centre = s.Ball.Center;
    const Point<4> centreOfOther = mesh.GetCircumball(n).Center;
    Point<4> z;
    const bool isFound = s.LabelInMesh != s.Label
      ? this->Context.Image.FirstCrossing(*onPlane, s.LabelInMesh, centre, z)
      : s.Label != atOther
      ? this->Context.Image.FirstCrossing(centre, s.Label, centreOfOther, z)
      : this->Context.Image.FirstCrossing(centreOfOther, atOther, *otherOnPlane, z);
    if (!isFound)
    {
      continue;
    }
    const RuleOutcome outcome = this->InsertFeatureAt(z, s, n, other);
    if (outcome != RuleOutcome::Good)
    {
      return outcome;
    }
  }
  return RuleOutcome::Good;
}

//------------------------------------------------------------------------------------------------
// Inserts a feature point at the centre of the surface ball of a facet, or near it.
RuleOutcome Rules4D::InsertFeatureAt(
  const Point<4>& crossing, const Element& s, SimplexId other, LabelId labelOfOther)
{
  const double delta = this->Context.Sizing.SamplingDistance(crossing, s.LabelInMesh, labelOfOther);
  const Point<4> z = this->Context.OnEndIfNextTo(crossing, delta);
  const double spacing = std::min(delta, this->Context.Sizing.Spacing(z));
  const Relaxation step = this->RelaxationAt(z, spacing);
  if (step == Relaxation::All)
  {
    return RuleOutcome::Good;
  }
  double clearance = FacetClearance(spacing, step);
  std::uint64_t& fired = this->Worker.Statistics.Fired[RuleNumber<4>::Facet];
  Point<4> snapped;
  if (this->Context.SnapToEnd(z, delta, snapped))
  {
    const double onEnd = EndSpacing * delta;
    if (std::abs(z[3] - snapped[3]) < onEnd || !this->FeatureVertexNear(s, snapped, onEnd))
    {
      return this->InsertFeatureOnEnd(snapped, delta, s, other, fired);
    }
    clearance = onEnd; // the end is crowded, and z is far enough from it
  }
  if (this->AnyFeatureWithin(z, clearance))
  {
    ++this->Worker.Statistics.RefusedTooClose;
    return RuleOutcome::Good;
  }
  return this->Context.Settings.SpaceTime.Slivers.Fight && step == Relaxation::Nothing
    ? this->InsertFeaturePick(z, delta, clearance, s, other)
    : this->InsertFeature(z, delta, clearance, s.Id, other, fired);
}

//------------------------------------------------------------------------------------------------
// The picking region of a restricted facet is the part of the interface inside a ball around z, the
// centre of its surface ball.
RuleOutcome Rules4D::InsertFeaturePick(
  const Point<4>& z, double delta, double clearance, const Element& s, SimplexId other)
{
  const SliverOptions& options = this->Context.Settings.SpaceTime.Slivers;
  const Triangulation<4>& mesh = this->Context.Mesh;
  const auto& v = mesh.GetSimplex(s.Id).V;
  const auto& w = mesh.GetSimplex(other).V;
  const auto shared = std::find_if(
    v.begin(), v.end(), [&w](VertexId x) { return std::find(w.begin(), w.end(), x) != w.end(); });
  const double radius = Distance(z, mesh.Position(*shared));
  const double reach = std::min(options.PickingRadius, LargestInterfacePick) * radius;
  PseudoRandom<4> random(options.Seed, z);
  BestPick veto(this->Context, radius, z);
  return InsertPick(
    this->Worker.Statistics, this->Context.Settings.SpaceTime.Slivers.Picks, veto,
    [&](Point<4>& p)
    {
      Point<4> onEnd;
      const Point<4> q = random.InBall(z, reach);
      ++this->Worker.Statistics.ClosestSurfacePointCalls;
      return this->Context.Image.ClosestSurfacePoint(q, this->Context.Image.Label(q), p) &&
        Distance(p, z) < reach && !this->Context.IsNearEnd(p, delta, onEnd) &&
        !this->AnyFeatureWithin(p, clearance);
    },
    [&](const Point<4>& p)
    {
      return this->InsertFeature(p, delta, clearance, s.Id, other,
        this->Worker.Statistics.Fired[RuleNumber<4>::Facet], &veto);
    });
}

//------------------------------------------------------------------------------------------------
bool Rules4D::FacetIsGood(const std::array<VertexId, 5>& v, unsigned facet) const
{
  for (unsigned i = 0; i < 5; ++i)
  {
    if (i != facet && this->Context.Mesh.GetVertex(v[i]).Kind != VertexKind::Feature)
    {
      return false;
    }
  }
  return true;
}

} // namespace voxplex
