// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Optimisation/Pentatopes/PentatopeStar.h"

#include "Geometry/SimplexQuality.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace voxplex
{

namespace
{

/** The volume of the regular pentatope with the circumradius 1; see NormalizedVolume(). */
const double RegularVolume = 25.0 * std::sqrt(5.0) / 384.0;

} // namespace

//------------------------------------------------------------------------------------------------
void MovedPentatope::MeasureFacet(std::size_t opposite)
{
  const Point<4>& origin = *this->Facet[0];
  const std::array<Point<4>, 3> e = { Subtract(*this->Facet[1], origin),
    Subtract(*this->Facet[2], origin), Subtract(*this->Facet[3], origin) };
  this->Normal = Cross(e[0], e[1], e[2]);
  const double length = std::sqrt(Dot(this->Normal, this->Normal));
  // Not asked of the vertex itself: if the pentatope is flat, rounding decides on which side it is.
  const double sign = opposite % 2 == 0 ? -1.0 : 1.0;
  for (double& x : this->Normal)
  {
    x *= sign / length;
  }
  this->Area = length / 24.0;

  // The circumcentre is origin + sum x_i e_i, and has (sum x_i e_i) . e_j = |e_j|^2 / 2.
  const double g01 = Dot(e[0], e[1]);
  const double g02 = Dot(e[0], e[2]);
  const double g12 = Dot(e[1], e[2]);
  const std::array<double, 3> g = { Dot(e[0], e[0]), Dot(e[1], e[1]), Dot(e[2], e[2]) };
  // Cofactors of the matrix of these products:
  const double c00 = g[1] * g[2] - g12 * g12;
  const double c01 = g02 * g12 - g01 * g[2];
  const double c02 = g01 * g12 - g02 * g[1];
  const double c11 = g[0] * g[2] - g02 * g02;
  const double c12 = g01 * g02 - g12 * g[0];
  const double c22 = g[0] * g[1] - g01 * g01;
  const double half = 0.5 / (g[0] * c00 + g01 * c01 + g02 * c02);
  const double x0 = half * (c00 * g[0] + c01 * g[1] + c02 * g[2]);
  const double x1 = half * (c01 * g[0] + c11 * g[1] + c12 * g[2]);
  const double x2 = half * (c02 * g[0] + c12 * g[1] + c22 * g[2]);
  this->Radius2 = 0.0;
  for (std::size_t a = 0; a < 4; ++a)
  {
    const double offset = x0 * e[0][a] + x1 * e[1][a] + x2 * e[2][a];
    this->Centre[a] = origin[a] + offset;
    this->Radius2 += offset * offset;
  }
  this->ShortestEdge2 = std::min({ g[0], g[1], g[2], g[0] + g[1] - 2.0 * g01,
    g[0] + g[2] - 2.0 * g02, g[1] + g[2] - 2.0 * g12 });
}

PentatopeShape MovedPentatope::ShapeAt(const Point<4>& place) const
{
  const Point<4> p = this->PlaceOf(place);
  const Point<4> d = Subtract(p, this->Centre);
  const double height = Dot(d, this->Normal);
  if (!(height > 0.0))
  {
    return { 0.0, std::numeric_limits<double>::infinity(), {} };
  }
  const double t = (Dot(d, d) - this->Radius2) / (2.0 * height);
  double edge2 = this->ShortestEdge2;
  for (const Point<4>* corner : this->Facet)
  {
    edge2 = std::min(edge2, Distance2(*corner, p));
  }
  PentatopeShape shape;
  shape.Ball.Radius2 = this->Radius2 + t * t;
  for (std::size_t a = 0; a < 4; ++a)
  {
    shape.Ball.Center[a] = this->Centre[a] + t * this->Normal[a];
  }
  shape.Quality = this->Area * height / (RegularVolume * shape.Ball.Radius2 * shape.Ball.Radius2);
  shape.Ratio = std::sqrt(shape.Ball.Radius2 / edge2);
  return shape;
}

double MovedPentatope::QualityAt(const Point<4>& p) const
{
  const Point<4> d = Subtract(this->PlaceOf(p), this->Centre);
  const double height = Dot(d, this->Normal);
  if (!(height > 0.0))
  {
    return 0.0;
  }
  const double t = (Dot(d, d) - this->Radius2) / (2.0 * height);
  const double radius2 = this->Radius2 + t * t;
  return this->Area * height / (RegularVolume * radius2 * radius2);
}

// q = A h / (regular R^4), and the gradient of t is (p - circumcentre) / h.
Point<4> MovedPentatope::GradientAt(const Point<4>& p) const
{
  const Point<4> d = Subtract(this->PlaceOf(p), this->Centre);
  const double height = Dot(d, this->Normal);
  if (!(height > 0.0))
  {
    return this->Normal; // flat, to rounding
  }
  const double t = (Dot(d, d) - this->Radius2) / (2.0 * height);
  const double radius2 = this->Radius2 + t * t;
  const double factor = this->Area / (RegularVolume * radius2 * radius2 * radius2);
  Point<4> gradient;
  for (std::size_t a = 0; a < 4; ++a)
  {
    gradient[a] = factor * (radius2 * this->Normal[a] - 4.0 * t * (d[a] - t * this->Normal[a]));
  }
  return gradient;
}

//------------------------------------------------------------------------------------------------
bool PentatopeStar::Gather(const Patch<4>& patch, std::uint32_t v)
{
  const PentatopeComplex& complex = patch.Mesh();
  this->All.clear();
  this->Shortest = std::numeric_limits<double>::infinity(); // squared, until all are there
  const std::uint32_t twin = complex.TwinOf(v);
  if (!patch.GatherStar(v, this->Stars[0]) ||
    (twin != None && !patch.GatherStar(twin, this->Stars[1])))
  {
    return false;
  }
  for (const bool inside : { true, false })
  {
    for (std::size_t k = 0; k < (twin == None ? 1 : 2); ++k)
    {
      const VertexStar<4>& star = this->Stars[k];
      const double shift = complex.Points[star.Vertex][3] - complex.Points[v][3];
      for (std::size_t s = 0; s < star.Cells.size(); ++s)
      {
        if ((complex.LabelOf(star.Cells[s]) != 0) == inside)
        {
          this->Add(complex, star.Cells[s], star.Corners[s], shift);
        }
      }
    }
    this->NumberInside = inside ? this->All.size() : this->NumberInside;
  }
  this->Shortest = std::sqrt(this->Shortest);
  return true;
}

/** @param corners the vertex first */
void PentatopeStar::Add(const PentatopeComplex& complex, std::uint32_t s,
  const PentatopeComplex::Vertices& corners, double shift)
{
  MovedPentatope& one = this->All.emplace_back();
  one.Id = s;
  one.Vertex = corners[0];
  one.Label = complex.LabelOf(s);
  one.Quality = complex.Scores[s];
  one.OldRatio = -1.0;
  one.Area = 0.0;
  one.Shift = shift;
  for (std::size_t k = 0; k < 4; ++k)
  {
    one.Facet[k] = &complex.Points[corners[k + 1]];
    this->Shortest = std::min(this->Shortest, Distance2(*one.Facet[k], complex.Points[corners[0]]));
  }
}

} // namespace voxplex
