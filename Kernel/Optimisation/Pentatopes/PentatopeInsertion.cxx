// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Optimisation/Pentatopes/PentatopeInsertion.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace voxplex
{

namespace
{

/** Most pentatopes of a cavity. */
constexpr std::size_t MostOld = 100;

/** A cavity that has grown so often without being worth more is given up. */
constexpr unsigned Patience = 24;

/** Steps of the new vertex after each growth; lengths in mean heights of the boundary. */
constexpr unsigned MostSteps = 12;
constexpr double FirstStep = 0.3;
constexpr double ShortestStep = 0.01;

/** A step raises those that are better than the worst by up to this part of it. */
constexpr std::array<double, 3> Shares = { 1.0, 0.25, 0.0 };

} // namespace

//------------------------------------------------------------------------------------------------
PentatopeInsertion PentatopeCavity::Find(std::uint32_t s, double target)
{
  const std::array<const Point<4>*, 5> corners = this->Mesh.PointsOf(this->Mesh.Cells[s].V);
  const Point<4> centre = ShapeOf(corners).Ball.Center;
  Point<4> centroid{};
  for (const Point<4>* corner : corners)
  {
    for (std::size_t a = 0; a < 4; ++a)
    {
      centroid[a] += 0.2 * (*corner)[a];
    }
  }
  const auto between = [](const Point<4>& x, const Point<4>& y, double share)
  {
    Point<4> p;
    for (std::size_t a = 0; a < 4; ++a)
    {
      p[a] = x[a] + share * (y[a] - x[a]);
    }
    return p;
  };
  PentatopeInsertion best;
  for (const double share : { 0.0, 1.0, 0.5 })
  {
    this->Try(s, between(centroid, centre, share), target, best);
  }
  for (std::size_t k = 0; k < 5 && best.After < target; ++k)
  {
    this->Try(s, between(centroid, *corners[k], -0.5), target, best);
  }
  return best;
}

/** Grows the cavity of a vertex that is at p first. */
void PentatopeCavity::Try(std::uint32_t s, Point<4> p, double target, PentatopeInsertion& best)
{
  this->Cavity.clear();
  this->Facets.clear();
  this->Before = 1.0;
  this->Add(s);
  double reached = -std::numeric_limits<double>::infinity();
  for (unsigned inVain = 0; best.After < target && inVain < Patience; ++inVain)
  {
    const double worth = this->Improve(p);
    if (worth > reached)
    {
      reached = worth;
      inVain = 0;
    }
    if (worth > this->Before && worth > best.After && this->IsAllowed(p))
    {
      best = this->Result(p, worth);
    }
    if (this->Cavity.size() == MostOld || !this->Grow(p))
    {
      return;
    }
  }
}

/** Adds a pentatope to the cavity. Facets that it has in common with others vanish. */
void PentatopeCavity::Add(std::uint32_t s)
{
  this->Cavity.push_back(s);
  this->Before = std::min(this->Before, this->Mesh.Scores[s]);
  const PentatopeComplex::Vertices& corners = this->Mesh.Cells[s].V;
  for (unsigned i = 0; i < 5; ++i)
  {
    const std::uint32_t behind = this->Mesh.Cells[s].N[i];
    const auto common = std::find_if(this->Facets.begin(), this->Facets.end(),
      [&](const BoundaryFacet& facet) { return facet.Inside == behind && facet.Behind == s; });
    if (common != this->Facets.end())
    {
      this->Facets.erase(common);
      continue;
    }
    BoundaryFacet& facet = this->Facets.emplace_back();
    facet.Inside = s;
    facet.Opposite = i;
    const bool mayOpen = behind != None && this->Mesh.LabelOf(behind) == this->Mesh.LabelOf(s) &&
      this->Target.MayChange(behind) && !this->Rules.IsOnPlane(this->Mesh, s, i);
    facet.Behind = mayOpen ? behind : None;
    for (std::size_t k = 0, m = 0; k < 5; ++k)
    {
      if (k != i)
      {
        facet.New.Facet[m++] = &this->Mesh.Points[corners[k]];
      }
    }
    facet.New.MeasureFacet(i);
  }
}

/** The quality of a new pentatope. If it is turned over: its height, which is negative. */
double PentatopeCavity::WorthOf(const BoundaryFacet& facet, const Point<4>& p)
{
  const double height = Dot(Subtract(p, facet.New.Centre), facet.New.Normal);
  return height > 0.0 ? facet.New.QualityAt(p) : height;
}

/** The worth of the worst new pentatope; less than `enough` if that is certain. */
double PentatopeCavity::WorthAt(const Point<4>& p, double enough) const
{
  double worth = std::numeric_limits<double>::infinity();
  for (const BoundaryFacet& facet : this->Facets)
  {
    worth = std::min(worth, WorthOf(facet, p));
    if (!(worth > enough))
    {
      break;
    }
  }
  return worth;
}

/** A direction in which the new pentatopes that are nearly the worst become better. */
Point<4> PentatopeCavity::DirectionAt(const Point<4>& p, double worth, double share) const
{
  Point<4> sum{};
  for (const BoundaryFacet& facet : this->Facets)
  {
    const double one = WorthOf(facet, p);
    if (one > worth + share * std::abs(worth))
    {
      continue;
    }
    const Point<4> gradient = one > 0.0 ? facet.New.GradientAt(p) : facet.New.Normal;
    const double length = std::sqrt(Dot(gradient, gradient));
    for (std::size_t a = 0; a < 4 && length > 0.0; ++a)
    {
      sum[a] += gradient[a] / length;
    }
  }
  return sum;
}

/** Moves p uphill. Returns its worth there. */
double PentatopeCavity::Improve(Point<4>& p) const
{
  double worth = this->WorthAt(p, -std::numeric_limits<double>::infinity());
  double scale = 0.0;
  for (const BoundaryFacet& facet : this->Facets)
  {
    scale += std::sqrt(facet.New.Radius2) / static_cast<double>(this->Facets.size());
  }
  double step = FirstStep * scale;
  unsigned share = 0;
  for (unsigned k = 0; k < MostSteps && step > ShortestStep * scale; ++k)
  {
    const Point<4> direction = this->DirectionAt(p, worth, Shares[share]);
    const double length = std::sqrt(Dot(direction, direction));
    double worthThere = worth;
    Point<4> there = p;
    if (length > 0.0)
    {
      for (std::size_t a = 0; a < 4; ++a)
      {
        there[a] = p[a] + step / length * direction[a];
      }
      worthThere = this->WorthAt(there, worth);
    }
    if (worthThere > worth)
    {
      p = there;
      worth = worthThere;
      continue;
    }
    share = (share + 1) % Shares.size();
    step *= share == 0 ? 0.5 : 1.0;
  }
  return worth;
}

/** Adds the pentatope behind the facet of the worst new one that has one. Returns false if no facet may open. */
bool PentatopeCavity::Grow(const Point<4>& p)
{
  std::size_t worst = this->Facets.size();
  double worth = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < this->Facets.size(); ++k)
  {
    const BoundaryFacet& facet = this->Facets[k];
    const double one = facet.Behind == None ? worth : WorthOf(facet, p);
    if (one < worth && this->Keeps(facet.Behind))
    {
      worth = one;
      worst = k;
    }
  }
  if (worst == this->Facets.size())
  {
    return false;
  }
  this->Add(this->Facets[worst].Behind);
  return true;
}

/** Whether all vertices of the cavity stay on its boundary if a pentatope is added. Others would be lost. */
bool PentatopeCavity::Keeps(std::uint32_t s) const
{
  const auto isCommon = [&](const BoundaryFacet& facet) { return facet.Behind == s; };
  const PentatopeComplex::Vertices& corners = this->Mesh.Cells[s].V;
  return std::all_of(corners.begin(), corners.end(),
    [&](std::uint32_t v)
    {
      std::size_t vanishing = 0;
      bool stays = false;
      for (const BoundaryFacet& facet : this->Facets)
      {
        const PentatopeComplex::Vertices& inside = this->Mesh.Cells[facet.Inside].V;
        const bool hasIt =
          std::find(inside.begin(), inside.end(), v) != inside.end() && inside[facet.Opposite] != v;
        if (hasIt && isCommon(facet))
        {
          ++vanishing;
        }
        stays = stays || (hasIt && !isCommon(facet));
      }
      // v is in four facets of s. One that is not in the boundary yet becomes a part of it.
      return stays || vanishing < 4;
    });
}

/** Whether new pentatopes keep the bounds. As many as among the old ones may break them, by no more than those. */
bool PentatopeCavity::IsAllowed(const Point<4>& p) const
{
  const LabelId label = this->Mesh.LabelOf(this->Cavity.front());
  double oldRatio = 0.0;
  std::size_t excused = 0;
  for (const std::uint32_t s : this->Cavity)
  {
    const PentatopeShape shape = ShapeOf(this->Mesh.PointsOf(this->Mesh.Cells[s].V));
    oldRatio = std::max(oldRatio, shape.Ratio);
    excused += this->Rules.Allows(shape, 0.0, label) ? 0 : 1;
  }
  std::size_t broken = 0;
  return std::all_of(this->Facets.begin(), this->Facets.end(),
    [&](const BoundaryFacet& facet)
    {
      const PentatopeShape shape = facet.New.ShapeAt(p);
      return this->Rules.Allows(shape, 0.0, label) ||
        (++broken <= excused && this->Rules.Allows(shape, oldRatio, label));
    });
}

PentatopeInsertion PentatopeCavity::Result(const Point<4>& p, double worth) const
{
  PentatopeInsertion result;
  result.Old = this->Cavity;
  result.Place = p;
  result.Before = this->Before;
  result.After = worth;
  for (const BoundaryFacet& facet : this->Facets)
  {
    PentatopeComplex::Vertices corners = this->Mesh.Cells[facet.Inside].V;
    corners[facet.Opposite] = None;
    result.New.push_back(corners);
  }
  return result;
}

} // namespace voxplex
