// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Refinement/Rules/Rules3D.h"

#include "Geometry/SimplexQuality.h"
#include "Refinement/Rules/PickingRegion.h"

#include <cmath>
#include <numbers>

namespace voxplex
{

//------------------------------------------------------------------------------------------------
Rules3D::Rules3D(RefinementContext<3>& context, RefinementWorker<3>& worker)
  : RefinementRules(context, worker)
  , CosineOfFacetAngle(
      std::cos(context.Settings.Shape.FacetAngle * std::numbers::pi / 180.0) * BoundSafety)
  , SineOfSliverAngle(std::sin(context.Settings.Shape.Slivers.Angle * std::numbers::pi / 180.0))
  , SineInside(std::min(SineOfSliverAngle,
      std::sin(context.Settings.Shape.Slivers.AngleInside * std::numbers::pi / 180.0)))
{
}

//------------------------------------------------------------------------------------------------
RuleOutcome Rules3D::Refine(SimplexId id)
{
  ++this->Worker.Statistics.Evaluated;
  const Element t = this->MakeElement(id);
  RuleOutcome outcome = this->SampleInterface(t);
  outcome = outcome == RuleOutcome::Good ? this->FacetRule(t) : outcome;
  outcome = outcome == RuleOutcome::Good ? this->RadiusEdgeRule(t) : outcome;
  if (outcome == RuleOutcome::Good)
  {
    outcome = this->SizeRule(t, this->Worker.Statistics.Fired[RuleNumber<3>::Size]);
  }
  if (outcome == RuleOutcome::Good && t.Label != 0 && this->IsToSplit(t))
  {
    if (this->AreSliversNext())
    {
      return this->SliverRule(t);
    }
    this->Worker.Poor.PushLast(id, this->Context.Mesh.State(id).Generation);
  }
  return outcome;
}

//------------------------------------------------------------------------------------------------
/**
 * Whether the sliver rule applies. Of the slivers that optimisation can improve, only the worst are
 * split.
 */
bool Rules3D::IsToSplit(const Element& t)
{
  if (this->SineOfSliverAngle <= 0.0)
  {
    return false;
  }
  const double sine = this->DihedralSine(t.Id);
  return !(sine >= this->SineOfSliverAngle) && (!(sine >= this->SineInside) || this->IsWedged(t));
}

/**
 * Whether at most one facet of t is inside of its label. If all vertices of t are on interfaces,
 * none can move.
 */
bool Rules3D::IsWedged(const Element& t)
{
  const auto& simplex = this->Context.Mesh.GetSimplex(t.Id);
  unsigned inside = 0;
  for (const SimplexId n : simplex.N)
  {
    inside += n != None && this->LabelOf(n) == t.Label ? 1 : 0;
  }
  return inside <= 1;
}

bool Rules3D::IsSliver(SimplexId t, double) const
{
  return this->SineOfSliverAngle > 0.0 && !(this->DihedralSine(t) >= this->SineOfSliverAngle);
}

double Rules3D::DihedralSine(SimplexId t) const
{
  const Triangulation<3>& mesh = this->Context.Mesh;
  return SmallestDihedralSine(mesh.Points(mesh.GetSimplex(t).V).data());
}

//------------------------------------------------------------------------------------------------
/** Accepts the first point whose star has no sliver, and remembers the best of the others. */
class Rules3D::BetterStar final : public Triangulation<3>::InsertionVeto
{
public:
  /**
   * @param bound of the smallest sine of the dihedral angles
   * @param only the label that every simplex of the star must have; 0: any
   * @param tolerance the factor by which radius-edge ratios may exceed the bound: the
   *   radius-edge rule repairs them
   */
  BetterStar(const RefinementContext<3>& context, const Point<3>& first, double bound, LabelId only,
    double tolerance)
    : Candidate(first)
    , Context(context)
    , Bound(bound)
    , LargestRatio(BoundSafety * tolerance * context.Settings.Shape.RadiusEdgeRatio)
    , Only(only)
  {
  }

  Point<3> Candidate;
  Point<3> Best{};
  bool HasBest = false;
  bool AcceptAll = false;

  bool Accepts(const Triangulation<3>::Worker& worker) override
  {
    if (this->AcceptAll)
    {
      return true;
    }
    double smallest = 1.0;
    for (std::size_t k = 0; k < worker.NumberOfNewSimplices(); ++k)
    {
      std::uint32_t apex = 0;
      const auto& v = worker.NewSimplex(k, apex);
      std::array<const Point<3>*, 4> points;
      for (unsigned i = 0; i < 4; ++i)
      {
        points[i] = i == apex ? &this->Candidate : &this->Context.Mesh.Position(v[i]);
      }
      const double sine = SmallestDihedralSine(points.data());
      Circumball<3> ball;
      if (!ComputeCircumball<3>(points.data(), ball))
      {
        return false;
      }
      const bool isBad = !(sine > this->BestSine) ||
        ball.Radius2 >= this->LargestRatio * this->LargestRatio * ShortestEdge2<3>(points.data());
      // Outside the object shapes do not matter. A simplex with a good shape needs no label.
      if (this->Only != 0 || isBad)
      {
        const LabelId label = this->Context.Image.Label(ball.Center);
        if ((this->Only != 0 && label != this->Only) || (label != 0 && isBad))
        {
          return false;
        }
        if (label == 0)
        {
          continue;
        }
      }
      smallest = std::min(smallest, sine);
    }
    this->BestSine = smallest;
    this->Best = this->Candidate;
    this->HasBest = true;
    return smallest >= this->Bound;
  }

private:
  const RefinementContext<3>& Context;
  const double Bound;
  const double LargestRatio;
  const LabelId Only;
  double BestSine = 0.0; ///< smallest in the star of the best point
};

//------------------------------------------------------------------------------------------------
// First only points that leave nothing for the radius-edge rule to do. If none is found, the
// elements that this rule makes are usually better.
RuleOutcome Rules3D::SliverRule(const Element& t)
{
  ++this->Worker.Statistics.SliversFound;
  RuleOutcome outcome = RuleOutcome::Good;
  for (const double tolerance : { 1.0, 1.5 })
  {
    outcome = outcome == RuleOutcome::Good ? this->SplitSliver(t, tolerance) : outcome;
    outcome = outcome == RuleOutcome::Good ? this->SampleAtSliver(t, tolerance) : outcome;
  }
  outcome = outcome == RuleOutcome::Good ? this->SampleBeside(t, 1.5) : outcome;
  this->Worker.Statistics.SliversKept += outcome == RuleOutcome::Good ? 1 : 0;
  return outcome;
}

//------------------------------------------------------------------------------------------------
// If the star has one label only, the insertion takes no facet from an interface, and adds none
// with a free vertex: the thesis' rejection of points that eliminate legal facets.
RuleOutcome Rules3D::SplitSliver(const Element& t, double tolerance)
{
  const TetSliverOptions& options = this->Context.Settings.Shape.Slivers;
  const double spacing = this->Context.Sizing.Spacing(t.Ball.Center, t.Label);
  if (this->RelaxationAt(t.Ball.Center, spacing) != Relaxation::Nothing)
  {
    return RuleOutcome::Good;
  }
  const double clearance = SliverSpacing * spacing;
  PseudoRandom<3> random(options.Seed, t.Ball.Center);
  BetterStar veto(this->Context, t.Ball.Center, this->SineOfSliverAngle, t.Label, tolerance);
  return InsertPick(
    this->Worker.Statistics, options.Picks, veto,
    [&](Point<3>& p)
    {
      p = random.InBall(t.Ball.Center, options.PickingRadius * t.Radius);
      return true;
    },
    [&](const Point<3>& p)
    {
      const RuleOutcome inserted =
        this->CountOutcome(this->Insert(p, VertexKind::Free, t.Id, clearance, &veto),
          this->Worker.Statistics.SliversSplit);
      if (inserted == RuleOutcome::Changed)
      {
        this->CountWork(t.Ball.Center, spacing);
        this->ScreenCreated();
      }
      return inserted;
    });
}

//------------------------------------------------------------------------------------------------
// Near an interface: inserts a point of it, from the picking region of a restricted facet nearby.
RuleOutcome Rules3D::SampleAtSliver(const Element& t, double tolerance)
{
  Triangulation<3>& mesh = this->Context.Mesh;
  const Triangulation<3>::Simplex simplex = mesh.GetSimplex(t.Id);
  RuleOutcome outcome = this->SampleFacets(t.Id, t, tolerance);
  for (unsigned i = 0; i < 4 && outcome == RuleOutcome::Good; ++i)
  {
    const SimplexId n = simplex.N[i];
    if (n == None || this->LabelOf(n) != t.Label)
    {
      continue;
    }
    for (const VertexId v : mesh.GetSimplex(n).V) // so that the neighbours of n may be read
    {
      if (!mesh.TryLock(this->Worker.Kernel, v))
      {
        return RuleOutcome::Contended;
      }
    }
    outcome = this->SampleFacets(n, t, tolerance);
  }
  return outcome;
}

//------------------------------------------------------------------------------------------------
RuleOutcome Rules3D::SampleFacets(SimplexId s, const Element& t, double tolerance)
{
  const Triangulation<3>& mesh = this->Context.Mesh;
  const Triangulation<3>::Simplex simplex = mesh.GetSimplex(s);
  const Point<3> centre = mesh.GetCircumball(s).Center;
  for (unsigned i = 0; i < 4; ++i)
  {
    const SimplexId n = simplex.N[i];
    Point<3> z;
    if (n == None || this->LabelOf(n) == t.Label ||
      !this->Context.Image.FirstCrossing(centre, t.Label, mesh.GetCircumball(n).Center, z))
    {
      continue;
    }
    const RuleOutcome outcome =
      this->SampleNear(z, Distance(z, mesh.Position(simplex.V[(i + 1) % 4])),
        this->Context.Sizing.SamplingDistance(z, t.Label, this->LabelOf(n)), t, tolerance);
    if (outcome != RuleOutcome::Good)
    {
      return outcome;
    }
  }
  return RuleOutcome::Good;
}

//------------------------------------------------------------------------------------------------
// A sliver between two sides of a sheet: all four vertices are on interfaces, but no facet of it or
// of its neighbours is restricted. Inserts a point of the interface beside it.
RuleOutcome Rules3D::SampleBeside(const Element& t, double tolerance)
{
  Point<3> z;
  ++this->Worker.Statistics.ClosestSurfacePointCalls;
  if (!this->Context.Image.ClosestSurfacePoint(t.Ball.Center, t.Label, z) ||
    Distance2(z, t.Ball.Center) > t.Ball.Radius2)
  {
    return RuleOutcome::Good;
  }
  return this->SampleNear(z, t.Radius, this->DeltaBehind(t, z), t, tolerance);
}

//------------------------------------------------------------------------------------------------
RuleOutcome Rules3D::SampleNear(
  const Point<3>& z, double radius, double delta, const Element& t, double tolerance)
{
  const TetSliverOptions& options = this->Context.Settings.Shape.Slivers;
  const double spacing = std::min(delta, this->Context.Sizing.Spacing(z));
  if (this->RelaxationAt(z, spacing) != Relaxation::Nothing)
  {
    return RuleOutcome::Good;
  }
  const double clearance = SliverSpacing * spacing;
  PseudoRandom<3> random(options.Seed, z);
  BetterStar veto(this->Context, z, this->SineOfSliverAngle, 0, tolerance);
  return InsertPick(
    this->Worker.Statistics, options.Picks, veto,
    [&](Point<3>& p)
    {
      const Point<3> q = random.InBall(z, options.PickingRadius * radius);
      ++this->Worker.Statistics.ClosestSurfacePointCalls;
      return this->Context.Image.ClosestSurfacePoint(q, this->Context.Image.Label(q), p);
    },
    [&](const Point<3>& p)
    {
      return this->AnyFeatureWithin(p, clearance)
        ? RuleOutcome::Good
        : this->InsertFeature(
            p, delta, clearance, t.Id, None, this->Worker.Statistics.SliversSampled, &veto);
    });
}

//------------------------------------------------------------------------------------------------
RuleOutcome Rules3D::FacetRule(const Element& t)
{
  const Triangulation<3>& mesh = this->Context.Mesh;
  const Triangulation<3>::Simplex& simplex = mesh.GetSimplex(t.Id);
  const bool near = mesh.State(t.Id).NearSurface;
  for (unsigned i = 0; i < 4; ++i)
  {
    const SimplexId n = simplex.N[i];
    if (n == None || !(near || mesh.State(n).NearSurface))
    {
      continue;
    }
    const LabelId other = this->LabelOf(n);
    if (other == t.Label)
    {
      continue;
    }
    const bool shapely = this->FacetIsGood(simplex.V, i);
    if (shapely && !this->MayCrossBorder(t, n, other))
    {
      continue;
    }
    Point<3> z;
    if (!this->Context.Image.FirstCrossing(
          t.Ball.Center, t.Label, mesh.GetCircumball(n).Center, z) ||
      (shapely && this->FacetIsFlat(simplex.V, i, z)))
    {
      continue;
    }
    const double delta = this->Context.Sizing.SamplingDistance(z, t.Label, other);
    const double spacing = std::min(delta, this->Context.Sizing.Spacing(z));
    const Relaxation step = this->RelaxationAt(z, spacing);
    if (step == Relaxation::All)
    {
      continue;
    }
    double clearance = FacetClearance(spacing, step);
    if (shapely)
    {
      clearance = std::max(clearance, CutClearance * delta);
      this->MoveToBorderEdge(z, Distance(z, mesh.Position(simplex.V[(i + 1) % 4])), clearance, z);
    }
    else
    {
      this->MoveOntoBorder(z, CutClearance * delta);
    }
    if (this->AnyFeatureWithin(z, clearance))
    {
      ++this->Worker.Statistics.RefusedTooClose;
      continue;
    }
    const RuleOutcome outcome = this->InsertFeature(
      z, delta, clearance, t.Id, n, this->Worker.Statistics.Fired[RuleNumber<3>::Facet]);
    if (outcome != RuleOutcome::Good)
    {
      return outcome; // z need not conflict with t: if t is alive, the caller judges it again
    }
  }
  return RuleOutcome::Good;
}

//------------------------------------------------------------------------------------------------
// The criterion rho(f) < rho-bar_f of the thesis in the form of section 3.1: no angle is below the
// bound, and all vertices are on interfaces.
bool Rules3D::FacetIsGood(const std::array<VertexId, 4>& v, unsigned facet) const
{
  std::array<const Triangulation<3>::Vertex*, 3> f;
  unsigned m = 0;
  for (unsigned i = 0; i < 4; ++i)
  {
    if (i != facet)
    {
      f[m++] = &this->Context.Mesh.GetVertex(v[i]);
    }
  }
  for (const Triangulation<3>::Vertex* vertex : f)
  {
    if (vertex->Kind != VertexKind::Feature)
    {
      return false;
    }
  }
  for (unsigned i = 0; i < 3; ++i)
  {
    const Point<3> a = Subtract(f[(i + 1) % 3]->Position, f[i]->Position);
    const Point<3> b = Subtract(f[(i + 2) % 3]->Position, f[i]->Position);
    const double cosine = Dot(a, b);
    // angle < bound: cos(angle) > cos(bound)
    if (cosine > this->CosineOfFacetAngle * std::sqrt(Dot(a, a) * Dot(b, b)))
    {
      return false;
    }
  }
  return true;
}

//------------------------------------------------------------------------------------------------
bool Rules3D::MayCrossBorder(const Element& t, SimplexId neighbour, LabelId other) const
{
  const auto isBeyond = [this](const Point<3>& p) { return this->Context.Border->IsBeyond(p); };
  return this->Context.Border &&
    ((t.Label == 0 && isBeyond(t.Ball.Center)) ||
      (other == 0 && isBeyond(this->Context.Mesh.GetCircumball(neighbour).Center)));
}

//------------------------------------------------------------------------------------------------
// If the dual edge of a facet leaves the object through the border of the image, the facet's
// vertices must be there.
bool Rules3D::FacetIsFlat(
  const std::array<VertexId, 4>& v, unsigned facet, const Point<3>& crossing) const
{
  unsigned faces = this->Context.Border->FacesAt(crossing);
  if (faces == 0)
  {
    return true;
  }
  for (unsigned i = 0; i < 4; ++i)
  {
    if (i != facet)
    {
      faces &= this->Context.Border->FacesAt(this->Context.Mesh.Position(v[i]));
    }
  }
  return faces != 0;
}

//------------------------------------------------------------------------------------------------
// If a facet is not flat, the reason is usually an edge nearby that has too few vertices.
void Rules3D::MoveToBorderEdge(
  const Point<3>& onFace, double reach, double clearance, Point<3>& z) const
{
  Point<3> edge;
  if (this->Context.Border->FindEdge(onFace, reach, edge) &&
    !this->AnyFeatureWithin(edge, clearance))
  {
    z = edge;
  }
}

//------------------------------------------------------------------------------------------------
// A vertex of another interface just below a face would take a facet's place there. The edge where
// the two meet is near.
void Rules3D::MoveOntoBorder(Point<3>& z, double clearance) const
{
  const ImageBorder<3>* border = this->Context.Border;
  if (border == nullptr || border->FacesAt(z) != 0)
  {
    return;
  }
  for (unsigned face = 0; face < 6; ++face)
  {
    const Point<3> above = border->MoveOnto(z, 1u << face);
    if (Distance2(above, z) < clearance * clearance)
    {
      this->MoveToBorderEdge(above, 4.0 * clearance, clearance, z);
      return;
    }
  }
}

} // namespace voxplex
