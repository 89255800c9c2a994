// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Optimisation/Tetrahedra/Smoother.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace voxplex
{

namespace
{

/** The largest number of steps of one call. */
constexpr int MostSteps = 8;
/** The largest number of halvings of a step. */
constexpr int MostHalvings = 5;
/** The longest step, in shortest edges of the star. */
constexpr double LongestStep = 0.4;
/** A step must raise the smallest score by this fraction. */
constexpr double LeastGain = 0.01;
/** A score is active if it is within this factor of the smallest one. */
constexpr double ActiveFactor = 1.25;
/** The step of finite differences for gradients, in shortest edges. */
constexpr double Difference = 1e-5;
/** A score that is good enough to stop at. */
constexpr double Enough = 1.02;
/** An insertion must raise the smallest score by this factor. */
constexpr double LeastGainOfInsertion = 1.1;
/** The largest number of tetrahedra of a cavity that grows. */
constexpr std::size_t LargestCavity = 32;
/** A vertex is moved off interfaces by this part of its shortest edge on them, at most. */
constexpr double ReachOfEdges = 0.4;
/** The largest distance of a vertex from its interface, in edges. */
constexpr double FarthestHeight = 0.5;
/** The largest height above an interface, in distances from its closest point. */
constexpr double SteepestHeight = 2.0;
/** The distance from an interface point at which labels are looked up, in shortest edges. */
constexpr double Beside = 0.05;

Point<3> Along(const Point<3>& p, double t, const Point<3>& d)
{
  return { p[0] + t * d[0], p[1] + t * d[1], p[2] + t * d[2] };
}

/**
 * The shortest vector in the convex hull of some vectors, approximately (Frank-Wolfe iteration).
 */
Point<3> ShortestInHull(const std::vector<Point<3>>& vectors)
{
  Point<3> shortest = vectors[0];
  for (int i = 0; i < 12; ++i)
  {
    const Point<3>* least = nullptr;
    double leastDot = (1.0 - 1e-2) * Dot(shortest, shortest);
    for (const Point<3>& vector : vectors)
    {
      const double dot = Dot(vector, shortest);
      if (dot < leastDot)
      {
        leastDot = dot;
        least = &vector;
      }
    }
    if (least == nullptr)
    {
      break;
    }
    const Point<3> towards = Subtract(*least, shortest);
    const double t = std::min(1.0, -Dot(shortest, towards) / Dot(towards, towards));
    shortest = Along(shortest, t, towards);
  }
  return shortest;
}

} // namespace

//------------------------------------------------------------------------------------------------
bool Smoother::Improve(std::uint32_t v)
{
  const TetrahedralComplex& mesh = this->Target.Mesh();
  if (mesh.Kinds[v] >= VertexRole::Crease || !this->Target.GatherStar(v, this->Star))
  {
    return false;
  }
  this->Bound = Constraint::Free;
  this->Fan.clear();
  if (mesh.Kinds[v] == VertexRole::Surface)
  {
    this->Bound = Constraint::Surface;
    this->GatherFan();
    if (!this->FanIsDisk() || !this->FindHeight())
    {
      return false;
    }
  }
  Point<3> p = mesh.Points[v];
  if (!this->AscendInStar(p))
  {
    return false;
  }
  if (this->Bound == Constraint::Surface)
  {
    this->Anchors.erase(v);
    ++this->Done.SurfaceMoves;
  }
  else
  {
    ++this->Done.FreeMoves;
  }
  return true;
}

bool Smoother::MoveOffInterface(std::uint32_t v)
{
  const TetrahedralComplex& mesh = this->Target.Mesh();
  if (!(this->LargestReach > 0.0) || mesh.Kinds[v] == VertexRole::Free ||
    !this->Target.GatherStar(v, this->Star))
  {
    return false;
  }
  this->Bound = Constraint::Anchor;
  this->GatherFan();
  Point<3> p = mesh.Points[v];
  const auto known = this->Anchors.find(v);
  this->Anchor = known == this->Anchors.end() ? p : known->second;
  this->Reach = this->LargestReach;
  for (const FanFacet& facet : this->Fan)
  {
    for (const std::uint32_t w : { facet.First, facet.Second })
    {
      this->Reach = std::min(this->Reach, ReachOfEdges * Distance(this->Anchor, mesh.Points[w]));
    }
  }
  if (!this->AscendInStar(p))
  {
    return false;
  }
  this->Anchors.emplace(v, this->Anchor);
  ++this->Done.MovesOffInterfaces;
  return true;
}

bool Smoother::Insert(std::uint32_t t, unsigned i, unsigned j)
{
  constexpr std::size_t longestRing = 12;
  const TetrahedralComplex& mesh = this->Target.Mesh();
  EdgeRing& ring = this->Ring;
  const std::uint32_t v = this->Target.SpareVertex();
  if (v == TetrahedralComplex::None || !GatherRing(this->Target, t, i, j, longestRing, ring) ||
    !ring.Closed)
  {
    return false;
  }
  if (std::any_of(ring.Cells.begin(), ring.Cells.end(),
        [&](std::uint32_t cell) { return mesh.Labels[cell] != mesh.Labels[t]; }))
  {
    return false;
  }
  this->Fresh.clear();
  this->Opposite.clear();
  const Point<3>& a = mesh.Points[ring.A];
  const Point<3>& b = mesh.Points[ring.B];
  for (std::size_t k = 0; k < ring.Cells.size(); ++k)
  {
    const std::uint32_t x = ring.Link[k];
    const std::uint32_t y = ring.Link[(k + 1) % ring.Link.size()];
    // (a, b, x, y) becomes (a, v, x, y) and (v, b, x, y).
    this->Fresh.push_back({ { v, ring.A, y, x }, mesh.Labels[t] });
    this->Fresh.push_back({ { v, ring.B, x, y }, mesh.Labels[t] });
    this->Opposite.insert(this->Opposite.end(), { a, mesh.Points[y], mesh.Points[x] });
    this->Opposite.insert(this->Opposite.end(), { b, mesh.Points[x], mesh.Points[y] });
  }
  return this->FillCavity(v, Along(a, 0.5, Subtract(b, a)), ring.Cells);
}

bool Smoother::InsertInside(std::uint32_t t)
{
  const TetrahedralComplex& mesh = this->Target.Mesh();
  const std::uint32_t v = this->Target.SpareVertex();
  if (v == TetrahedralComplex::None || !this->Target.MayChange(t))
  {
    return false;
  }
  Point<3> p{};
  for (unsigned i = 0; i < 4; ++i)
  {
    p = Along(p, 0.25, mesh.PointOf(t, i));
  }
  if (!(this->GrowCavity(t, p) > 0.0))
  {
    return false;
  }
  this->Fresh.clear();
  this->Opposite.clear();
  for (const CavityFacet& facet : this->Facets)
  {
    this->Fresh.push_back({ { v, facet.V[0], facet.V[1], facet.V[2] }, mesh.Labels[t] });
    for (const std::uint32_t w : facet.V)
    {
      this->Opposite.push_back(mesh.Points[w]);
    }
  }
  return this->FillCavity(v, p, this->Cavity);
}

/** Adds a tetrahedron to Cavity and updates Facets. */
void Smoother::AddToCavity(std::uint32_t t, const Point<3>& p)
{
  const TetrahedralComplex& mesh = this->Target.Mesh();
  this->Cavity.push_back(t);
  std::erase_if(this->Facets, [t](const CavityFacet& facet) { return facet.Next == t; });
  for (unsigned i = 0; i < 4; ++i)
  {
    const std::uint32_t next = mesh.Cells[t].N[i];
    if (std::find(this->Cavity.begin(), this->Cavity.end(), next) != this->Cavity.end())
    {
      continue;
    }
    const auto w = StartingAt(mesh.Cells[t].V, i);
    this->Facets.push_back({ t, next, { w[1], w[2], w[3] },
      mesh.Shape(p, mesh.Points[w[1]], mesh.Points[w[2]], mesh.Points[w[3]]) });
  }
}

/**
 * Makes the cavity of a new vertex at p, in t: of the cavities on the way the one whose worst new
 * tetrahedron is best.
 * @return the score of that tetrahedron
 */
double Smoother::GrowCavity(std::uint32_t t, const Point<3>& p)
{
  const TetrahedralComplex& mesh = this->Target.Mesh();
  this->Cavity.clear();
  this->Facets.clear();
  double best = ShapeScore::Inverted;
  std::size_t bestSize = 0;
  std::vector<CavityFacet> bestFacets;
  for (std::uint32_t next = t;;)
  {
    this->AddToCavity(next, p);
    const auto worst = std::min_element(this->Facets.begin(), this->Facets.end(),
      [](const CavityFacet& a, const CavityFacet& b) { return a.Score < b.Score; });
    if (worst->Score > best)
    {
      best = worst->Score;
      bestSize = this->Cavity.size();
      bestFacets = this->Facets;
    }
    next = worst->Next;
    if (this->Cavity.size() == LargestCavity || next == TetrahedralComplex::None ||
      mesh.Labels[next] != mesh.Labels[t] || !this->Target.MayChange(next))
    {
      break; // the worst facet stays
    }
  }
  this->Cavity.resize(bestSize);
  this->Facets = std::move(bestFacets);
  return best;
}

/**
 * Replaces the tetrahedra of a cavity by Fresh, with the spare vertex v, which begins at p. Opposite
 * has the three other points of each. False, with nothing changed, if that does not help.
 */
bool Smoother::FillCavity(std::uint32_t v, Point<3> p, std::span<const std::uint32_t> cells)
{
  this->Bound = Constraint::Free;
  this->Fan.clear();
  this->Scores.resize(this->Fresh.size());
  this->Tried.resize(this->Fresh.size());
  this->ScoreAt(p, ShapeScore::Inverted);
  std::swap(this->Scores, this->Tried);
  this->Ascend(p);
  double before = 1.0;
  for (const std::uint32_t cell : cells)
  {
    before = std::min(before, static_cast<double>(this->Target.Mesh().Scores[cell]));
  }
  // If nothing is poor afterwards, any gain is enough.
  const double after = *std::min_element(this->Scores.begin(), this->Scores.end());
  if (before >= 1.0 || after < std::min(LeastGainOfInsertion * before, 1.0))
  {
    return false;
  }
  this->Target.PlaceVertex(v, p);
  if (!this->Target.Replace(cells, this->Fresh))
  {
    return false;
  }
  this->Target.KeepVertex();
  ++this->Done.Insertions;
  return true;
}

//------------------------------------------------------------------------------------------------
/** Gathers the interface triangles around the vertex, and their mean normal. */
void Smoother::GatherFan()
{
  const TetrahedralComplex& mesh = this->Target.Mesh();
  const Point<3>& p = mesh.Points[this->Star.Vertex];
  const bool fixed = mesh.Kinds[this->Star.Vertex] == VertexRole::Fixed;
  this->Fan.clear();
  this->Normal = { 0.0, 0.0, 0.0 };
  for (std::size_t k = 0; k < this->Star.Cells.size(); ++k)
  {
    const std::uint32_t t = this->Star.Cells[k];
    const auto& corners = this->Star.Corners[k];
    for (unsigned i = 1; i < 4; ++i)
    {
      const auto other = mesh.LabelOf(mesh.Cells[t].N[mesh.IndexOf(t, corners[i])]);
      if (other >= mesh.Labels[t])
      {
        continue;
      }
      this->Sides[0] = mesh.Labels[t];
      this->Sides[1] = other;
      // Corners are (v, 1, 2, 3). Seen from outside, the facet without 3 is (v, 2, 1).
      FanFacet facet;
      facet.First = corners[1 + (i + 1) % 3];
      facet.Second = corners[1 + i % 3];
      const Point<3>& x = mesh.Points[facet.First];
      const Point<3>& y = mesh.Points[facet.Second];
      facet.Normal = Cross(Subtract(x, p), Subtract(y, p));
      const bool junction = fixed || mesh.Kinds[facet.First] == VertexRole::Fixed ||
        mesh.Kinds[facet.Second] == VertexRole::Fixed;
      facet.LargestCosine =
        std::max(junction ? this->Rules.JunctionCosine : this->Rules.FacetCosine,
          CosineOfSmallestAngle(p, x, y));
      this->Normal = Along(this->Normal, 1.0, facet.Normal);
      this->Fan.push_back(facet);
    }
  }
}

/** Whether the fan's triangles go once around the vertex. Normalises the normal. */
bool Smoother::FanIsDisk()
{
  const double length = std::sqrt(Dot(this->Normal, this->Normal));
  if (this->Fan.size() < 3 || !(length > 0.0))
  {
    return false;
  }
  this->Normal = Along({ 0.0, 0.0, 0.0 }, 1.0 / length, this->Normal);
  std::uint32_t at = this->Fan[0].First;
  for (std::size_t k = 0; k < this->Fan.size(); ++k)
  {
    std::size_t next = k;
    while (next < this->Fan.size() && this->Fan[next].First != at)
    {
      ++next;
    }
    if (next == this->Fan.size())
    {
      return false;
    }
    std::swap(this->Fan[k], this->Fan[next]);
    at = this->Fan[k].Second;
  }
  return at == this->Fan[0].First;
}

/**
 * Finds how high the vertex, where it was before it was moved off, is above the interface of its two
 * labels, along the normal. False if the interface is not near.
 */
bool Smoother::FindHeight()
{
  const TetrahedralComplex& mesh = this->Target.Mesh();
  const auto known = this->Anchors.find(this->Star.Vertex);
  const Point<3>& p = known == this->Anchors.end() ? mesh.Points[this->Star.Vertex] : known->second;
  const LabelId label = this->Image.Label(p);
  const bool isBehind = label == this->Sides[0];
  if (!isBehind && label != this->Sides[1])
  {
    return false;
  }
  const double reach = FarthestHeight * Distance(p, mesh.Points[this->Fan[0].First]);
  Point<3> z;
  if (!this->Image.FirstCrossing(p, label, Along(p, isBehind ? reach : -reach, this->Normal), z))
  {
    return false;
  }
  this->Height = Dot(Subtract(p, z), this->Normal);
  // Where the normal runs beside a sheet, it crosses the interface far behind the closest point.
  Point<3> closest;
  return this->Image.ClosestSurfacePoint(p, label, closest) &&
    std::abs(this->Height) <= SteepestHeight * Distance(p, closest) + Beside * reach;
}

//------------------------------------------------------------------------------------------------
/** Ascends in the star and moves its vertex. False if the vertex does not move. */
bool Smoother::AscendInStar(Point<3>& p)
{
  const TetrahedralComplex& mesh = this->Target.Mesh();
  this->Opposite.clear();
  this->Scores.clear();
  for (std::size_t k = 0; k < this->Star.Cells.size(); ++k)
  {
    for (unsigned i = 1; i < 4; ++i)
    {
      this->Opposite.push_back(mesh.Points[this->Star.Corners[k][i]]);
    }
    this->Scores.push_back(mesh.Scores[this->Star.Cells[k]]);
  }
  this->Tried.resize(this->Scores.size());
  if (!this->Ascend(p))
  {
    return false;
  }
  return this->Target.Move(this->Star.Vertex, p, this->Star.Cells, this->Scores);
}

/** Moves p until the smallest score is enough or no step helps. False if p does not move. */
bool Smoother::Ascend(Point<3>& p)
{
  double shortest2 = Distance2(p, this->Opposite[0]);
  for (const Point<3>& x : this->Opposite)
  {
    shortest2 = std::min(shortest2, Distance2(p, x));
  }
  this->ShortestEdge = std::sqrt(shortest2);
  double score = *std::min_element(this->Scores.begin(), this->Scores.end());
  bool moved = false;
  for (int i = 0; i < MostSteps && score < Enough && this->Step(p, score); ++i)
  {
    moved = true;
  }
  return moved;
}

/** The smallest score with the vertex at p, up to Enough. Stops early once it is below `floor`. */
double Smoother::ScoreAt(const Point<3>& p, double floor)
{
  const TetrahedralComplex& mesh = this->Target.Mesh();
  const std::size_t count = this->Tried.size();
  double score = Enough;
  for (std::size_t k = 0; k < count; k += 2)
  {
    const std::size_t next = std::min(k + 1, count - 1);
    const std::array<double, 2> own =
      mesh.Shape.OfTwo(p, &this->Opposite[3 * k], &this->Opposite[3 * next]);
    this->Tried[k] = static_cast<float>(own[0]);
    this->Tried[next] = static_cast<float>(own[1]);
    score = std::min(score, own[0]);
    score = score < floor ? score : std::min(score, own[1]);
    if (score < floor)
    {
      return score;
    }
  }
  return score;
}

/**
 * The direction in which the smallest score grows fastest, and the slope. False if there is none.
 */
bool Smoother::Direction(const Point<3>& p, Point<3>& direction, double& slope)
{
  const TetrahedralComplex& mesh = this->Target.Mesh();
  const float smallest = *std::min_element(this->Scores.begin(), this->Scores.end());
  if (!(smallest > 0.0f))
  {
    return false; // an inverted tetrahedron has no useful gradient
  }
  const double h = Difference * this->ShortestEdge;
  this->Gradients.clear();
  for (std::size_t k = 0; k < this->Scores.size(); ++k)
  {
    if (this->Scores[k] > ActiveFactor * smallest)
    {
      continue;
    }
    const Point<3>* const x = &this->Opposite[3 * k];
    const double here = mesh.Shape(p, x[0], x[1], x[2]);
    Point<3> gradient;
    for (std::size_t a = 0; a < 3; ++a)
    {
      Point<3> q = p;
      q[a] += h;
      gradient[a] = (mesh.Shape(q, x[0], x[1], x[2]) - here) / h;
    }
    if (this->Bound == Constraint::Surface)
    {
      gradient = Along(gradient, -Dot(gradient, this->Normal), this->Normal);
    }
    this->Gradients.push_back(gradient);
  }
  direction = ShortestInHull(this->Gradients);
  slope = std::sqrt(Dot(direction, direction));
  if (!(slope * this->ShortestEdge > 1e-6))
  {
    return false;
  }
  direction = Along({ 0.0, 0.0, 0.0 }, 1.0 / slope, direction);
  return true;
}

bool Smoother::Step(Point<3>& p, double& score)
{
  Point<3> direction;
  double slope = 0.0;
  if (!this->Direction(p, direction, slope))
  {
    return false;
  }
  const double floor = std::max(std::min(score * (1.0 + LeastGain), 1.0), score) + 1e-9;
  double length = std::min(LongestStep * this->ShortestEdge, 2.0 * (Enough - score) / slope);
  for (int i = 0; i <= MostHalvings; ++i, length *= 0.5)
  {
    Point<3> q = Along(p, length, direction);
    double reached = this->ScoreAt(q, floor);
    if (reached < floor || !this->Constrain(q, length))
    {
      continue;
    }
    if (this->Bound != Constraint::Free)
    {
      reached = this->ScoreAt(q, floor);
      if (reached < floor)
      {
        continue;
      }
    }
    p = q;
    score = reached;
    std::swap(this->Scores, this->Tried);
    return true;
  }
  return false;
}

//------------------------------------------------------------------------------------------------
/** Moves p to an allowed position. False if this is not near or violates a rule. */
bool Smoother::Constrain(Point<3>& p, double length) const
{
  if (this->Bound == Constraint::Surface)
  {
    const Point<3> raw = p;
    if (!this->Project(raw, length, p))
    {
      return false;
    }
  }
  else if (this->Bound == Constraint::Anchor)
  {
    const Point<3> away = Subtract(p, this->Anchor);
    const double distance = std::sqrt(Dot(away, away));
    if (distance > this->Reach)
    {
      p = Along(this->Anchor, this->Reach / distance, away);
    }
    if (const ImageBorder<3>* border = this->Image.Border())
    {
      p = border->MoveOnto(p, this->Target.Mesh().BorderFacesOf(this->Star.Vertex));
      if (!border->IsWithin(p))
      {
        return false;
      }
    }
  }
  return this->FanAllows(p);
}

/**
 * Projects a point to where the vertex is as far from the interface of its two labels as before. False
 * if the closest interface is another one, or if the point is on another face where the image cuts
 * the object.
 */
bool Smoother::Project(const Point<3>& raw, double length, Point<3>& p) const
{
  const TetrahedralComplex& mesh = this->Target.Mesh();
  const unsigned faces = mesh.BorderFacesOf(this->Star.Vertex);
  Point<3> z;
  if (!this->Image.ClosestSurfacePoint(raw, this->Image.Label(raw), z) ||
    (faces != 0 && this->Image.Border()->FacesAt(z) != faces))
  {
    return false;
  }
  p = Along(z, this->Height, this->Normal);
  if (const ImageBorder<3>* border = this->Image.Border())
  {
    p = border->MoveOnto(p, faces);
    if (!border->IsWithin(p))
    {
      return false;
    }
  }
  if (Distance2(raw, p) > length * length)
  {
    return false;
  }
  const double beside = Beside * this->ShortestEdge;
  const auto labelAt = [&](double offset)
  { return this->Image.Label(Along(z, offset, this->Normal)); };
  return labelAt(-beside) == this->Sides[0] && labelAt(beside) == this->Sides[1];
}

bool Smoother::FanAllows(const Point<3>& p) const
{
  const TetrahedralComplex& mesh = this->Target.Mesh();
  for (const FanFacet& facet : this->Fan)
  {
    const Point<3>& x = mesh.Points[facet.First];
    const Point<3>& y = mesh.Points[facet.Second];
    if (CosineOfSmallestAngle(p, x, y) > facet.LargestCosine ||
      CosineBetween(Cross(Subtract(x, p), Subtract(y, p)), facet.Normal) < 0.5)
    {
      return false;
    }
  }
  return true;
}

} // namespace voxplex
