// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Refinement/Rules3D.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace voxplex
{

namespace
{
// Circumradii are certified to within CircumballTolerance; elements are held a little below the bounds,
// so that they keep them in anybody's arithmetic.
constexpr double Safety = 1.0 - 10.0 * CircumballTolerance;
}

//------------------------------------------------------------------------------------------------
Rules3D::Rules3D(RefinementContext<3>& context, RefinementWorker<3>& worker)
  : Context(context)
  , Worker(worker)
  , CosineOfFacetAngle(std::cos(context.Settings.FacetAngle * std::numbers::pi / 180.0) * Safety)
{
}

//------------------------------------------------------------------------------------------------
void Rules3D::ScreenCreated()
{
  this->Worker.RemoveDeleted(this->Context.Mesh);
  for (const SimplexId t : this->Worker.Kernel.Created)
  {
    if (this->MayBePoor(t))
    {
      this->Worker.Poor.Push(t, this->Context.Mesh.State(t).Generation);
    }
  }
}

//------------------------------------------------------------------------------------------------
// Cheap: one look-up of the distance bounds, and labels only away from the interfaces, where they
// cost one look-up too. Nearly all that is screened dies before it would be evaluated.
bool Rules3D::MayBePoor(SimplexId t)
{
  const Triangulation<3>& mesh = this->Context.Mesh;
  const Circumball<3>& ball = mesh.GetSimplex(t).Ball;
  SimplexState& state = this->Context.Mesh.State(t);
  if (!(ball.Radius2 >= 0.0))
  {
    state.NearSurface = true; // no reliable ball: let the evaluation look closely
    return true;
  }
  const double lower = this->Context.Image.DistanceBounds(ball.Center).Lower;
  if (lower * lower <= ball.Radius2 || lower <= 0.0)
  {
    state.NearSurface = true;
    return true;
  }
  const LabelId label = this->LabelOf(t, ball.Center);
  if (label != 0)
  {
    const double radius = std::sqrt(ball.Radius2);
    if (radius >= Safety * this->Context.Settings.RadiusEdgeRatio * this->ShortestEdge(t) ||
      radius >= Safety * this->Context.Size(ball.Center, label))
    {
      return true;
    }
  }
  // A neighbour that was judged before may have got a restricted facet: its ball meets an interface,
  // and the labels at the two circumcentres differ.
  for (const SimplexId n : mesh.GetSimplex(t).N)
  {
    if (n != None)
    {
      const SimplexState& other = mesh.State(n);
      if (other.NearSurface && other.Labelled && other.Label != label)
      {
        return true;
      }
    }
  }
  return false;
}

//------------------------------------------------------------------------------------------------
Verdict Rules3D::Refine(SimplexId id)
{
  ++this->Worker.Statistics.Evaluated;
  Element t;
  t.Id = id;
  t.Ball = this->Context.Mesh.GetCircumball(id);
  t.Radius = std::sqrt(t.Ball.Radius2);
  t.Label = this->LabelOf(id, t.Ball.Center);

  if (this->Context.Mesh.State(id).NearSurface && !this->IsSampled(t))
  {
    Point<3> z;
    ++this->Worker.Statistics.ClosestSurfacePointCalls;
    if (this->Context.Image.ClosestSurfacePoint(t.Ball.Center, t.Label, z) &&
      Distance2(z, t.Ball.Center) <= t.Ball.Radius2)
    {
      const double delta = this->DeltaBehind(t, z);
      Verdict verdict = this->R1(t, z, delta);
      verdict = verdict == Verdict::Good ? this->R2(t, delta) : verdict;
      if (verdict != Verdict::Good)
      {
        return verdict;
      }
    }
  }
  Verdict verdict = this->R3(t);
  verdict = verdict == Verdict::Good ? this->R4(t) : verdict;
  return verdict == Verdict::Good ? this->R5(t) : verdict;
}

//------------------------------------------------------------------------------------------------
// Most tetrahedra near an interface have a feature vertex near cfp(c(t)): a quick look at where that is tells
// that neither R1 nor R2 applies.
bool Rules3D::IsSampled(const Element& t) const
{
  Point<3> z;
  double error;
  if (t.Radius >= 2.0 * this->Context.Settings.Delta ||
    !this->Context.Image.NearSurfacePoint(t.Ball.Center, t.Label, z, error))
  {
    return false;
  }
  const double delta = this->DeltaBehind(t, z);
  return t.Radius < 2.0 * delta && error < delta && this->FeatureVertexNear(t, z, delta - error);
}

//------------------------------------------------------------------------------------------------
Verdict Rules3D::R1(const Element& t, const Point<3>& z, double delta)
{
  return this->FeatureVertexNear(t, z, delta)
    ? Verdict::Good
    : this->InsertFeature(z, delta, delta, t.Id, None, this->Worker.Statistics.Fired[0]);
}

//------------------------------------------------------------------------------------------------
Verdict Rules3D::R2(const Element& t, double delta)
{
  return t.Radius >= 2.0 * delta ? this->InsertCircumcentre(t, this->Worker.Statistics.Fired[1])
                                 : Verdict::Good;
}

//------------------------------------------------------------------------------------------------
Verdict Rules3D::R3(const Element& t)
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
    if (other == t.Label || this->FacetIsGood(simplex.V, i))
    {
      continue;
    }
    Point<3> z;
    if (!this->Context.Image.FirstCrossing(t.Ball.Center, t.Label, mesh.GetCircumball(n).Center, z))
    {
      continue;
    }
    if (this->Context.Features.AnyWithin(z, this->Context.SpacingFloor))
    {
      ++this->Worker.Statistics.RefusedTooClose;
      continue;
    }
    const double delta = this->Context.Delta(z, t.Label, other);
    const Verdict verdict = this->InsertFeature(
      z, delta, this->Context.SpacingFloor, t.Id, n, this->Worker.Statistics.Fired[2]);
    if (verdict != Verdict::Good)
    {
      return verdict; // z need not conflict with t: whoever called judges t again if it lives
    }
  }
  return Verdict::Good;
}

//------------------------------------------------------------------------------------------------
Verdict Rules3D::R4(const Element& t)
{
  const bool applies = t.Label != 0 &&
    t.Radius >= Safety * this->Context.Settings.RadiusEdgeRatio * this->ShortestEdge(t.Id);
  return applies ? this->InsertCircumcentre(t, this->Worker.Statistics.Fired[3]) : Verdict::Good;
}

//------------------------------------------------------------------------------------------------
Verdict Rules3D::R5(const Element& t)
{
  const bool applies =
    t.Label != 0 && t.Radius >= Safety * this->Context.Size(t.Ball.Center, t.Label);
  return applies ? this->InsertCircumcentre(t, this->Worker.Statistics.Fired[4]) : Verdict::Good;
}

//------------------------------------------------------------------------------------------------
// Delta(z) for z = cfp(c(t)): the label on this side is known, that beyond is just behind z.
double Rules3D::DeltaBehind(const Element& t, const Point<3>& z) const
{
  if (!this->Context.Settings.Size)
  {
    return this->Context.Settings.Delta;
  }
  const double distance = Distance(t.Ball.Center, z);
  const Point<3> behind =
    Interpolate(t.Ball.Center, z, 1.0 + this->Context.SpacingFloor / std::max(distance, 1e-300));
  return this->Context.Delta(z, t.Label, this->Context.Image.Label(behind));
}

//------------------------------------------------------------------------------------------------
// Removes the free vertices adjacent to z that are nearer than 2 delta; a removal can make others
// adjacent, so it goes on until none is left. worker.Created holds the star of z on entry.
void Rules3D::R6(VertexId z, double delta)
{
  std::size_t done = 0;
  this->ToRemove.clear();
  for (;;)
  {
    this->FindVerticesToRemove(z, 2.0 * delta);
    if (done == this->ToRemove.size())
    {
      return;
    }
    const VertexId v = this->ToRemove[done++];
    if (this->Remove(v) == RemovalOutcome::Contended)
    {
      this->Worker.PendingRemovals.push_back({ v, z, 2.0 * delta });
    }
  }
}

//------------------------------------------------------------------------------------------------
// Adds the free vertices of worker.Created that are nearer than the radius to z to ToRemove.
void Rules3D::FindVerticesToRemove(VertexId z, double radius)
{
  const Triangulation<3>& mesh = this->Context.Mesh;
  const Point<3> centre = mesh.Position(z);
  for (const SimplexId t : this->Worker.Kernel.Created)
  {
    for (const VertexId v : mesh.GetSimplex(t).V)
    {
      const Triangulation<3>::Vertex& vertex = mesh.GetVertex(v);
      if (vertex.Kind == VertexKind::Free && Distance2(vertex.Position, centre) < radius * radius &&
        std::find(this->ToRemove.begin(), this->ToRemove.end(), v) == this->ToRemove.end())
      {
        this->ToRemove.push_back(v);
      }
    }
  }
}

//------------------------------------------------------------------------------------------------
// Afterwards worker.Created holds what was made, if anything.
RemovalOutcome Rules3D::Remove(VertexId v)
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

//------------------------------------------------------------------------------------------------
// The vertex may be another one by now; then it goes if it, too, is a free one so near. What its removal
// brings up goes after it.
Verdict Rules3D::RemovePending()
{
  const PendingRemoval pending = this->Worker.PendingRemovals.back();
  if (!this->Context.Mesh.TryLock(this->Worker.Kernel, pending.Vertex))
  {
    return Verdict::Contended;
  }
  const Triangulation<3>::Vertex& vertex = this->Context.Mesh.GetVertex(pending.Vertex);
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

//------------------------------------------------------------------------------------------------
// rho(f) < rho-bar_f of the thesis in the form of section 3.1: no angle below the bound, and all
// vertices on interfaces.
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
bool Rules3D::OwnFeatureVertexNear(const Element& t, const Point<3>& z, double distance) const
{
  const Triangulation<3>& mesh = this->Context.Mesh;
  for (const VertexId v : mesh.GetSimplex(t.Id).V)
  {
    const Triangulation<3>::Vertex& vertex = mesh.GetVertex(v);
    if (vertex.Kind == VertexKind::Feature && Distance2(vertex.Position, z) < distance * distance)
    {
      return true;
    }
  }
  return false;
}

//------------------------------------------------------------------------------------------------
bool Rules3D::FeatureVertexNear(const Element& t, const Point<3>& z, double distance) const
{
  return this->OwnFeatureVertexNear(t, z, distance) ||
    this->Context.Features.AnyWithin(z, distance);
}

//------------------------------------------------------------------------------------------------
Verdict Rules3D::InsertCircumcentre(const Element& t, std::uint64_t& fired)
{
  Triangulation<3>& mesh = this->Context.Mesh;
  const bool inside = mesh.GetBox().Contains(t.Ball.Center);
  const Point<3> p = inside ? t.Ball.Center : mesh.GetBox().Clamp(t.Ball.Center);
  // The circumball is empty: only a projected point can be near a vertex.
  const InsertionOutcome outcome = mesh.Insert(this->Worker.Kernel, p,
    inside ? VertexKind::Free : VertexKind::Box, t.Id, inside ? 0.0 : this->Context.SpacingFloor);
  const Verdict verdict = this->CountOutcome(outcome, fired);
  if (verdict == Verdict::Changed)
  {
    this->Worker.Statistics.Projected += inside ? 0 : 1;
    this->ScreenCreated();
  }
  return verdict;
}

//------------------------------------------------------------------------------------------------
// Nothing is nearer to z than the clearance but for what another thread has inserted meanwhile.
Verdict Rules3D::InsertFeature(const Point<3>& z, double delta, double clearance, SimplexId seed,
  SimplexId otherSeed, std::uint64_t& fired)
{
  Triangulation<3>& mesh = this->Context.Mesh;
  InsertionOutcome outcome =
    mesh.Insert(this->Worker.Kernel, z, VertexKind::Feature, seed, clearance);
  if (outcome == InsertionOutcome::NoConflict && otherSeed != None)
  {
    outcome = mesh.Insert(this->Worker.Kernel, z, VertexKind::Feature, otherSeed, clearance);
  }
  const Verdict verdict = this->CountOutcome(outcome, fired);
  if (verdict == Verdict::Changed)
  {
    this->Context.Features.Add(z);
    this->ScreenCreated();
    this->R6(this->Worker.Kernel.NewVertex, delta);
  }
  return verdict;
}

//------------------------------------------------------------------------------------------------
Verdict Rules3D::CountOutcome(InsertionOutcome outcome, std::uint64_t& fired)
{
  RuleStatistics& statistics = this->Worker.Statistics;
  switch (outcome)
  {
    case InsertionOutcome::Inserted:
      ++fired;
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
    case InsertionOutcome::Contended:
      return Verdict::Contended;
  }
  return Verdict::Good;
}

//------------------------------------------------------------------------------------------------
LabelId Rules3D::LabelOf(SimplexId t)
{
  const SimplexState& state = this->Context.Mesh.State(t);
  return state.Labelled ? state.Label
                        : this->LabelOf(t, this->Context.Mesh.GetCircumball(t).Center);
}

//------------------------------------------------------------------------------------------------
LabelId Rules3D::LabelOf(SimplexId t, const Point<3>& centre)
{
  SimplexState& state = this->Context.Mesh.State(t);
  if (!state.Labelled)
  {
    state.Label = this->Context.Image.Label(centre);
    state.Labelled = true;
  }
  return state.Label;
}

//------------------------------------------------------------------------------------------------
double Rules3D::ShortestEdge(SimplexId t) const
{
  const Triangulation<3>& mesh = this->Context.Mesh;
  const std::array<VertexId, 4>& v = mesh.GetSimplex(t).V;
  double shortest2 = std::numeric_limits<double>::infinity();
  for (unsigned i = 0; i < 4; ++i)
  {
    for (unsigned j = 0; j < i; ++j)
    {
      shortest2 = std::min(shortest2, Distance2(mesh.Position(v[i]), mesh.Position(v[j])));
    }
  }
  return std::sqrt(shortest2);
}

} // namespace voxplex
