// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Refinement/Rules3D.h"

#include <cmath>
#include <numbers>

namespace voxplex
{

//------------------------------------------------------------------------------------------------
Rules3D::Rules3D(RefinementContext<3>& context, RefinementWorker<3>& worker)
  : RuleVocabulary(context, worker)
  , CosineOfFacetAngle(
      std::cos(context.Settings.FacetAngle * std::numbers::pi / 180.0) * BoundSafety)
{
}

//------------------------------------------------------------------------------------------------
// Cheap: one look-up of the distance bounds, and labels only away from the interfaces, where they
// cost one look-up too. Nearly all that is screened dies before it would be evaluated.
bool Rules3D::MayBePoor(SimplexId t)
{
  if (this->ScreenDistance(t))
  {
    return true;
  }
  const Circumball<3>& ball = this->Context.Mesh.GetSimplex(t).Ball;
  const LabelId label = this->LabelOf(t, ball.Center);
  if (label != 0)
  {
    const double radius = std::sqrt(ball.Radius2);
    if (radius >= BoundSafety * this->Context.Settings.RadiusEdgeRatio * this->ShortestEdge(t) ||
      radius >= BoundSafety * this->Context.Size(ball.Center, label))
    {
      return true;
    }
  }
  return this->MayRestrictNeighbour(t, label);
}

//------------------------------------------------------------------------------------------------
Verdict Rules3D::Refine(SimplexId id)
{
  ++this->Worker.Statistics.Evaluated;
  const Element t = this->MakeElement(id);
  Verdict verdict = this->SampleInterface(t); // R1, R2
  verdict = verdict == Verdict::Good ? this->R3(t) : verdict;
  if (verdict == Verdict::Good && this->HasBadRatio(t)) // R4
  {
    verdict = this->InsertCircumcentre(t, this->Worker.Statistics.Fired[3]);
  }
  if (verdict == Verdict::Good && this->IsTooLarge(t)) // R5
  {
    verdict = this->InsertCircumcentre(t, this->Worker.Statistics.Fired[4]);
  }
  return verdict;
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

} // namespace voxplex
