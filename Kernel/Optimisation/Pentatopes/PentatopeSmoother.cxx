// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Optimisation/Pentatopes/PentatopeSmoother.h"

#include "Geometry/SimplexQuality.h"
#include "Geometry/SymmetricEigen.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace voxplex
{

namespace
{

/** Lengths of steps that raise the worst, in shortest edges. */
constexpr double FirstStep = 0.3;
constexpr double ShortestStep = 0.01;

/** Steps of one vertex that raise the worst, those that fail included. */
constexpr unsigned MostSteps = 12;

/**
 * A step raises the worst alone. As a last resort it also raises those that are better by up to this
 * part of its quality.
 */
constexpr std::array<double, 3> Shares = { 0.0, 0.25, 1.0 };

/** Steps that raise the sum: the first length, their number, and how lengths change. */
constexpr double FirstStepOfSum = 0.15;
constexpr unsigned MostStepsOfSum = 4;
constexpr double Longer = 1.2;
constexpr double Shorter = 0.4;

/** A vertex of an interface moves at most this far, in shortest edges. */
constexpr double LongestMove = 0.25;

/**
 * A direction is normal to an interface if this part of its facets' area faces it. Less is
 * curvature.
 */
constexpr double NormalShare = 0.15;

/** What a quality adds to the sum. */
double WorthOf(double quality)
{
  return quality * (2.0 - quality);
}

/** @param direction not 0 */
Point<4> Along(const Point<4>& p, const Point<4>& direction, double step)
{
  const double factor = step / std::sqrt(Dot(direction, direction));
  Point<4> moved;
  for (std::size_t a = 0; a < 4; ++a)
  {
    moved[a] = p[a] + factor * direction[a];
  }
  return moved;
}

} // namespace

//------------------------------------------------------------------------------------------------
bool PentatopeSmoother::RaiseWorst(double target, double tolerance)
{
  this->Tolerance = tolerance;
  double quality = this->Smallest();
  bool moved = false;
  double step = FirstStep * this->Star.ShortestEdge();
  const double shortest = ShortestStep * this->Star.ShortestEdge();
  const bool isLast = tolerance > 0.0;
  const std::size_t shares = isLast ? Shares.size() : 1;
  const unsigned most = isLast ? 2 * MostSteps : MostSteps;
  std::size_t share = 0;
  for (unsigned k = 0; k < most && step >= shortest && quality < target; ++k)
  {
    const Point<4> here = this->Here;
    Point<4> direction = this->GradientOfWorst(here, (1.0 + Shares[share]) * quality);
    this->Project(direction);
    const bool leads = Dot(direction, direction) > 0.0;
    const Point<4> p = leads ? Along(here, direction, step) : here;
    if (leads && this->MayMoveTo(p) && this->Try(p, quality))
    {
      this->Take(p);
      quality = this->Smallest();
      moved = true;
    }
    else
    {
      share = (share + 1) % shares;
      step *= share == 0 ? 0.5 : 1.0;
    }
  }
  return moved && this->Finish();
}

bool PentatopeSmoother::RaiseSum(double floor)
{
  this->Tolerance = 0.0;
  const auto sum = [](double total, double quality) { return total + WorthOf(quality); };
  double worth = 0.0;
  double smallest = 1.0;
  for (const MovedPentatope& one : this->Star.Inside())
  {
    worth = sum(worth, one.Quality);
    smallest = std::min(smallest, one.Quality);
  }
  floor = std::min(floor, smallest);
  bool moved = false;
  double step = FirstStepOfSum * this->Star.ShortestEdge();
  for (unsigned k = 0; k < MostStepsOfSum; ++k)
  {
    const Point<4> here = this->Here;
    Point<4> direction = this->GradientOfSum(here);
    this->Project(direction);
    if (!(Dot(direction, direction) > 0.0))
    {
      break;
    }
    const Point<4> p = Along(here, direction, step);
    double worthThere = 0.0;
    if (this->MayMoveTo(p) && this->Try(p, floor))
    {
      worthThere = std::accumulate(this->Tried.begin(), this->Tried.end(), 0.0, sum);
    }
    if (worthThere > worth)
    {
      this->Take(p);
      worth = worthThere;
      moved = true;
      step *= Longer;
    }
    else
    {
      step *= Shorter;
    }
  }
  return moved && this->Finish();
}

bool PentatopeSmoother::Start(std::uint32_t v)
{
  this->Vertex = v;
  this->First = this->Here = this->Mesh.Points[v];
  if ((this->Limits.HasTwin(this->First) && this->Mesh.TwinOf(v) == None) ||
    !this->Star.Gather(this->Target, v) || this->Star.Inside().empty())
  {
    return false;
  }
  this->Tried.resize(this->Star.Inside().size());
  this->FirstTried = 0;
  this->GatherNormals();
  return true;
}

void PentatopeSmoother::GatherNormals()
{
  this->Normals.clear();
  this->FacetNormals.clear();
  const std::uint32_t twin = this->Mesh.TwinOf(this->Vertex);
  this->IsOnInterface = this->Mesh.Kinds[this->Vertex] != VertexRole::Free ||
    (twin != None && this->Mesh.Kinds[twin] != VertexRole::Free);
  if (!this->IsOnInterface)
  {
    return;
  }
  const bool keepsTime = this->Limits.KeepsTime(this->First);
  // The outer products of the normals over their areas, which are as long as the normals.
  std::array<Point<4>, 4> sum{};
  double total = 0.0;
  for (const MovedPentatope& one : this->Star.Inside())
  {
    const PentatopeComplex::Cell& cell = this->Mesh.Cells[one.Id];
    for (unsigned i = 0; i < 5; ++i)
    {
      if (cell.V[i] == one.Vertex || this->Mesh.LabelOf(cell.N[i]) >= one.Label)
      {
        continue; // no facet of an interface, or counted from the other side
      }
      const auto corner = [&](unsigned k) -> const Point<4>&
      { return this->Mesh.PointOf(one.Id, (i + k) % 5); };
      Point<4> normal = Cross(Subtract(corner(2), corner(1)), Subtract(corner(3), corner(1)),
        Subtract(corner(4), corner(1)));
      normal[3] = keepsTime ? 0.0 : normal[3]; // such a vertex moves in space only
      const double area = std::sqrt(Dot(normal, normal));
      for (std::size_t a = 0; a < 4 && area > 0.0; ++a)
      {
        for (std::size_t b = 0; b < 4; ++b)
        {
          sum[a][b] += normal[a] * normal[b] / area;
        }
      }
      total += area;
      this->FacetNormals.push_back(normal);
    }
  }
  const SymmetricEigen<4> eigen = EigenOf<4>(sum);
  for (std::size_t k = 0; k < 4; ++k)
  {
    if (eigen.Values[k] > NormalShare * total)
    {
      this->Normals.push_back(eigen.Vectors[k]);
    }
  }
  if (this->Normals.size() == 1)
  {
    this->Normals.front() = this->SumOfNormals(this->Normals.front());
  }
}

/**
 * The direction of the sum of the facets' normals, each on the side of the given direction. Moves that are
 * orthogonal to it change no volume, because the volume beneath the facets is linear in the place of
 * one vertex.
 */
Point<4> PentatopeSmoother::SumOfNormals(const Point<4>& side) const
{
  Point<4> sum{};
  for (const Point<4>& normal : this->FacetNormals)
  {
    const double sign = Dot(normal, side) < 0.0 ? -1.0 : 1.0;
    for (std::size_t a = 0; a < 4; ++a)
    {
      sum[a] += sign * normal[a];
    }
  }
  return Along({}, sum, 1.0);
}

/** Removes what a direction has of the normals, unless tolerated, and time where it must stay. */
void PentatopeSmoother::Project(Point<4>& direction) const
{
  for (std::size_t k = 0; k < this->Normals.size() && this->Tolerance == 0.0; ++k)
  {
    const double part = Dot(direction, this->Normals[k]);
    for (std::size_t a = 0; a < 4; ++a)
    {
      direction[a] -= part * this->Normals[k][a];
    }
  }
  if ((this->IsOnInterface && this->Limits.KeepsTime(this->First)) ||
    this->Limits.IsOnPlane(this->First))
  {
    direction[3] = 0.0;
  }
}

double PentatopeSmoother::Smallest() const
{
  double smallest = 1.0;
  for (const MovedPentatope& one : this->Star.Inside())
  {
    smallest = std::min(smallest, one.Quality);
  }
  return smallest;
}

/** The sum of the directions in which pentatopes become better, over those below a quality. */
Point<4> PentatopeSmoother::GradientOfWorst(const Point<4>& p, double below)
{
  Point<4> sum{};
  for (MovedPentatope& one : this->Star.Inside())
  {
    if (one.Quality <= below)
    {
      const Point<4> gradient = one.Measured().GradientAt(p);
      const double length = std::sqrt(Dot(gradient, gradient));
      for (std::size_t a = 0; a < 4 && length > 0.0; ++a)
      {
        sum[a] += gradient[a] / length;
      }
    }
  }
  return sum;
}

Point<4> PentatopeSmoother::GradientOfSum(const Point<4>& p)
{
  Point<4> sum{};
  for (MovedPentatope& one : this->Star.Inside())
  {
    const Point<4> gradient = one.Measured().GradientAt(p);
    for (std::size_t a = 0; a < 4; ++a)
    {
      sum[a] += 2.0 * (1.0 - one.Quality) * gradient[a];
    }
  }
  return sum;
}

bool PentatopeSmoother::MayMoveTo(const Point<4>& p) const
{
  if (!this->IsOnInterface)
  {
    return true;
  }
  const Point<4> moved = Subtract(p, this->Originals[this->Vertex]);
  const double farthest = LongestMove * this->Star.ShortestEdge();
  const bool isTolerated = this->Tolerance == 0.0 ||
    std::all_of(this->Normals.begin(), this->Normals.end(),
      [&](const Point<4>& normal) { return std::abs(Dot(moved, normal)) <= this->Tolerance; });
  return isTolerated && Dot(moved, moved) <= farthest * farthest &&
    this->Limits.Shortening(moved) >= 1.0 && this->Limits.IsNearImage(p);
}

/** Whether all qualities at p are above `floor`, and all bounds are kept. */
bool PentatopeSmoother::Try(const Point<4>& p, double floor)
{
  const std::span<MovedPentatope> inside = this->Star.Inside();
  for (std::size_t k = 0; k < inside.size(); ++k)
  {
    const std::size_t s = k == 0 ? this->FirstTried : k <= this->FirstTried ? k - 1 : k;
    const PentatopeShape shape = inside[s].Measured().ShapeAt(p);
    if (!(shape.Quality > floor) || !this->Allows(inside[s], shape))
    {
      this->FirstTried = s;
      return false;
    }
    this->Tried[s] = shape.Quality;
  }
  const std::span<MovedPentatope> outside = this->Star.Outside();
  return std::all_of(outside.begin(), outside.end(),
           [&p](MovedPentatope& one) { return one.Measured().VolumeAt(p) > one.Quality; }) &&
    std::all_of(inside.begin(), inside.end(),
      [&](const MovedPentatope& one)
      { return this->Mesh.KeepsComponents(one.Id, one.Vertex, one.PlaceOf(p)); });
}

bool PentatopeSmoother::Allows(MovedPentatope& one, const PentatopeShape& shape) const
{
  if (this->Rules.Allows(shape, 0.0, one.Label))
  {
    return true;
  }
  if (one.OldRatio < 0.0)
  {
    one.OldRatio = one.ShapeAt(this->First).Ratio;
  }
  return this->Rules.Allows(shape, one.OldRatio, one.Label);
}

void PentatopeSmoother::Take(const Point<4>& p)
{
  this->Here = p;
  for (std::size_t s = 0; s < this->Tried.size(); ++s)
  {
    this->Star.Inside()[s].Quality = this->Tried[s];
  }
}

/** Moves the vertex to Here. Returns false if it stays. */
bool PentatopeSmoother::Finish()
{
  this->Ids.clear();
  this->Tried.clear();
  for (const MovedPentatope& one : this->Star.Inside())
  {
    this->Ids.push_back(one.Id);
    this->Tried.push_back(one.Quality);
  }
  return this->Target.Move(this->Vertex, this->Here, this->Ids, this->Tried);
}

} // namespace voxplex
