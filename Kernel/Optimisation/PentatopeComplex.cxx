// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Optimisation/PentatopeComplex.h"

#include "Geometry/SimplexQuality.h"
#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <utility>

namespace voxplex
{

namespace
{

/** Circumradii stay below this times the size: a little less, for rounding. */
constexpr double BelowSize = 1.0 - 1e-9;

/** Pentatopes outside of the object keep at least this part of their volume. */
constexpr double VolumeKeptOutside = 0.1;

/** Lists the users of each vertex: begins[v] to begins[v + 1] in `lists`. */
template <typename CellVertices>
void ListUsers(std::size_t vertices, std::span<const CellVertices> cells,
  std::vector<std::size_t>& begins, std::vector<std::uint32_t>& lists)
{
  begins.assign(vertices + 1, 0);
  for (const CellVertices& cell : cells)
  {
    for (const std::uint32_t v : cell)
    {
      begins[v + 1] += cell[0] != None ? 1 : 0;
    }
  }
  for (std::size_t v = 0; v < vertices; ++v)
  {
    begins[v + 1] += begins[v];
  }
  lists.resize(begins.back());
  std::vector<std::size_t> next(begins.begin(), begins.end() - 1);
  for (std::size_t c = 0; c < cells.size(); ++c)
  {
    for (const std::uint32_t v : cells[c])
    {
      if (cells[c][0] != None)
      {
        lists[next[v]++] = static_cast<std::uint32_t>(c);
      }
    }
  }
}

} // namespace

//------------------------------------------------------------------------------------------------
Surroundings SurroundingsOf(const Triangulation<4>& triangulation, const SimplexLabels& labels,
  const Subdivision<4>& parts, std::span<const Point<4>> positions,
  std::span<const std::uint32_t> numbers, std::size_t points)
{
  Surroundings result;
  std::vector<std::uint32_t> all(numbers.begin(), numbers.end());
  const VertexId end = triangulation.VertexIdEnd();
  const auto positionOf = [&](VertexId v)
  {
    return v >= end       ? parts.Points[v - end]
      : positions.empty() ? triangulation.Position(v)
                          : positions[v];
  };
  const auto add = [&](const std::array<VertexId, 5>& vertices)
  {
    if (std::all_of(
          vertices.begin(), vertices.end(), [&numbers](VertexId v) { return numbers[v] == None; }))
    {
      return;
    }
    auto& simplex = result.Simplices.emplace_back();
    for (std::size_t k = 0; k < 5; ++k)
    {
      const VertexId v = vertices[k];
      if (all[v] == None)
      {
        all[v] = static_cast<std::uint32_t>(points + result.Points.size());
        result.Points.push_back(positionOf(v));
      }
      simplex[k] = all[v];
    }
  };
  auto replaced = parts.Replaced.begin(); // ascending
  for (SimplexId s = 0; s < labels.size(); ++s)
  {
    if (replaced != parts.Replaced.end() && *replaced == s)
    {
      ++replaced;
    }
    else if (labels[s] == 0 && triangulation.IsAlive(s))
    {
      add(triangulation.GetSimplex(s).V);
    }
  }
  for (const Piece<4>& piece : parts.Pieces)
  {
    if (piece.Label == 0)
    {
      add(piece.V);
    }
  }
  return result;
}

PentatopeShape ShapeOf(const std::array<const Point<4>*, 5>& points)
{
  PentatopeShape shape;
  if (!(SignedVolume<4>(points.data()) > 0.0))
  {
    return { 0.0, std::numeric_limits<double>::infinity(), {} };
  }
  if (!ComputeCircumball<4>(points.data(), shape.Ball))
  {
    ComputeCircumballExactly<4>(points.data(), shape.Ball);
  }
  shape.Quality = NormalizedVolume<4>(points.data(), shape.Ball.Radius2);
  shape.Ratio = RadiusEdgeRatio<4>(points.data(), shape.Ball.Radius2);
  return shape;
}

//------------------------------------------------------------------------------------------------
PentatopeComplex::PentatopeComplex(const SimplexMesh<4>& mesh, const Surroundings& outside,
  const LabelImage<4>& image, const Domain<4>& surfaces, const PentatopeBounds& bounds,
  unsigned threads, const std::stop_token& stop)
  : Bounds(bounds)
  , Surfaces(surfaces)
  , Values(image.Values())
  , MeshPoints(mesh.Points.size())
  , FirstPoints(mesh.Points.size() + outside.Points.size())
  , Facets(mesh.Facets)
  , Points(mesh.Points.begin(), mesh.Points.end())
  , Corners(mesh.Simplices.begin(), mesh.Simplices.end())
{
  this->Points.insert(this->Points.end(), outside.Points.begin(), outside.Points.end());
  this->Corners.insert(this->Corners.end(), outside.Simplices.begin(), outside.Simplices.end());
  this->Labels.resize(this->Corners.size(), 0);
  this->Qualities.resize(this->Corners.size());
  const std::span<const std::int64_t> values = this->Values;
  ParallelFor(
    0, this->Corners.size(), 4096, threads,
    [&](std::size_t first, std::size_t last)
    {
      for (std::size_t s = first; s < last; ++s)
      {
        const std::array<const Point<4>*, 5> points = this->PointsOf(this->Corners[s]);
        if (s < mesh.Simplices.size())
        {
          this->Labels[s] = static_cast<LabelId>(
            std::lower_bound(values.begin() + 1, values.end(), mesh.Labels[s]) - values.begin());
          this->Qualities[s] = ShapeOf(points).Quality;
        }
        else
        {
          this->Qualities[s] = VolumeKeptOutside * SignedVolume<4>(points.data());
        }
      }
    },
    stop);
  if (bounds.Guard)
  {
    this->AreHolders = bounds.Guard->FindHolders(mesh, threads, stop);
  }
  this->FindStars();
  ListUsers(this->MeshPoints, this->Facets, this->FirstFacet, this->FacetsOf);
  this->Twins.resize(mesh.Twins.empty() ? 0 : this->Points.size(), None);
  for (const auto& [first, last] : mesh.Twins)
  {
    this->Twins[first] = last;
    this->Twins[last] = first;
  }
}

void PentatopeComplex::CopyTo(SimplexMesh<4>& mesh) const
{
  const std::size_t made = this->Points.size() - this->FirstPoints;
  mesh.Points.resize(this->MeshPoints + made);
  std::copy_n(this->Points.begin(), this->MeshPoints, mesh.Points.begin());
  std::copy_n(this->Points.end() - static_cast<std::ptrdiff_t>(made), made,
    mesh.Points.begin() + static_cast<std::ptrdiff_t>(this->MeshPoints));
  std::size_t n = 0;
  for (std::size_t s = 0; s < this->Corners.size(); ++s)
  {
    n += this->Labels[s] != 0 && this->IsAlive(s) ? 1 : 0;
  }
  mesh.Simplices.resize(n);
  mesh.Labels.resize(n);
  for (std::size_t s = 0, k = 0; s < this->Corners.size(); ++s)
  {
    if (this->Labels[s] != 0 && this->IsAlive(s))
    {
      mesh.Simplices[k] = this->Corners[s];
      for (std::uint32_t& v : mesh.Simplices[k])
      {
        v -= static_cast<std::uint32_t>(
          v < this->FirstPoints ? 0 : this->FirstPoints - this->MeshPoints);
      }
      mesh.Labels[k] = this->Values[this->Labels[s]];
      ++k;
    }
  }
}

void PentatopeComplex::NoteChange(std::size_t s)
{
  for (std::size_t k = 0; k < 5 && this->IsAlive(s); ++k)
  {
    this->Left.push_back({ this->Corners[s][k], static_cast<std::uint32_t>(s) });
  }
  this->Changed.push_back(static_cast<std::uint32_t>(s));
}

void PentatopeComplex::FindStars()
{
  std::vector<std::size_t> begins;
  ListUsers<Vertices>(this->Points.size(), this->Corners, begins, this->Stars);
  this->PlacesOfStars.resize(this->Points.size());
  for (std::size_t v = 0; v < this->Points.size(); ++v)
  {
    this->PlacesOfStars[v] = { begins[v], begins[v + 1] };
  }
  this->StarsFound = this->Stars.size();
}

void PentatopeComplex::UpdateStars(unsigned threads, const std::stop_token& stop)
{
  std::vector<Corner> corners = std::move(this->Left);
  this->Left.clear();
  for (const std::uint32_t s : this->Changed)
  {
    for (std::size_t k = 0; k < 5 && this->IsAlive(s); ++k)
    {
      corners.push_back({ this->Corners[s][k], s });
    }
  }
  this->Changed.clear();
  std::sort(corners.begin(), corners.end());
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());

  // A star that changes moves to the end, where there is room for what it had and what it may get.
  struct NewStar
  {
    std::span<const Corner> Changes;
    std::size_t Begin;
  };
  std::vector<NewStar> stars;
  std::size_t end = this->Stars.size();
  this->PlacesOfStars.resize(this->Points.size());
  for (std::size_t k = 0, next = 0; k < corners.size(); k = next)
  {
    while (next < corners.size() && corners[next].Vertex == corners[k].Vertex)
    {
      ++next;
    }
    stars.push_back({ std::span(corners).subspan(k, next - k), end });
    end += this->StarOf(corners[k].Vertex).size() + next - k;
  }
  if (end > 2 * this->StarsFound)
  {
    this->FindStars();
    return;
  }
  this->Stars.resize(end);
  ParallelFor(
    0, stars.size(), 16, threads,
    [&](std::size_t first, std::size_t last)
    {
      for (std::size_t k = first; k < last; ++k)
      {
        this->UpdateStar(stars[k].Changes, stars[k].Begin);
      }
    },
    stop);
}

/** @param changes a vertex, and the pentatopes that have changed and had it or have it now; ascending */
void PentatopeComplex::UpdateStar(std::span<const Corner> changes, std::size_t newBegin)
{
  const std::uint32_t v = changes.front().Vertex;
  const std::span<const std::uint32_t> star = this->StarOf(v);
  std::uint32_t* end = this->Stars.data() + newBegin;
  auto old = star.begin();
  for (const Corner& change : changes)
  {
    const auto place = std::lower_bound(old, star.end(), change.Pentatope);
    end = std::copy(old, place, end);
    old = place + (place != star.end() && *place == change.Pentatope ? 1 : 0);
    const Vertices& corners = this->Corners[change.Pentatope];
    if (this->IsAlive(change.Pentatope) &&
      std::find(corners.begin(), corners.end(), v) != corners.end())
    {
      *end++ = change.Pentatope;
    }
  }
  end = std::copy(old, star.end(), end);
  this->PlacesOfStars[v] = { newBegin, static_cast<std::size_t>(end - this->Stars.data()) };
}

std::uint32_t PentatopeComplex::Neighbour(std::size_t s, unsigned i) const
{
  const Vertices& corners = this->Corners[s];
  std::array<std::uint32_t, 4> facet;
  std::size_t shortest = 0;
  for (std::size_t k = 0, m = 0; k < 5; ++k)
  {
    if (k != i)
    {
      facet[m] = corners[k];
      shortest =
        this->StarOf(facet[m]).size() < this->StarOf(facet[shortest]).size() ? m : shortest;
      ++m;
    }
  }
  for (const std::uint32_t other : this->StarOf(facet[shortest]))
  {
    const Vertices& v = this->Corners[other];
    const bool hasAll = std::all_of(facet.begin(), facet.end(),
      [&v](std::uint32_t x) { return std::find(v.begin(), v.end(), x) != v.end(); });
    if (other != s && hasAll)
    {
      return other;
    }
  }
  return None;
}

bool PentatopeComplex::IsOnPlane(std::size_t s, unsigned i) const
{
  const Vertices& corners = this->Corners[s];
  const double time = this->Points[corners[(i + 1) % 5]][3];
  for (unsigned k = 2; k < 5; ++k)
  {
    if (this->Points[corners[(i + k) % 5]][3] != time)
    {
      return false;
    }
  }
  return this->Bounds.Planes.AreAt(time);
}

bool PentatopeComplex::Allows(const PentatopeShape& shape, double oldRatio, LabelId label) const
{
  if (!(shape.Ratio <= std::max(this->Bounds.RadiusEdgeRatio, oldRatio)))
  {
    return false;
  }
  if (!this->Bounds.Sizing)
  {
    return true;
  }
  // Sizes are asked for where the label is only, as in refinement.
  const Point<4>& centre = shape.Ball.Center;
  if (this->Surfaces.Label(centre) != label)
  {
    return false;
  }
  const double size = BelowSize * this->Bounds.Sizing->ElementSize(centre, label);
  return shape.Ball.Radius2 < size * size;
}

bool PentatopeComplex::HandOver(
  std::span<const std::uint32_t> old, std::span<const Vertices> fresh, const Point<4>& added)
{
  if (std::none_of(old.begin(), old.end(), [this](std::uint32_t s) { return this->IsHolder(s); }))
  {
    return true;
  }
  std::vector<ComponentGuard<4>::Corners> corners(fresh.size());
  for (std::size_t k = 0; k < fresh.size(); ++k)
  {
    for (std::size_t i = 0; i < 5; ++i)
    {
      corners[k][i] = fresh[k][i] == None ? &added : &this->Points[fresh[k][i]];
    }
  }
  std::vector<std::uint8_t> areHolders(fresh.size());
  for (const std::uint32_t s : old)
  {
    if (this->IsHolder(s) &&
      !this->Bounds.Guard->Keeps(
        this->Labels[s], this->PointsOf(this->Corners[s]), corners, areHolders))
    {
      return false;
    }
  }
  this->AreHolders.resize(this->Corners.size());
  for (std::size_t k = 0; k < std::max(old.size(), fresh.size()); ++k)
  {
    if (k < old.size())
    {
      this->AreHolders[old[k]] = k < fresh.size() ? areHolders[k] : std::uint8_t{ 0 };
    }
    else
    {
      this->AreHolders.push_back(areHolders[k]);
    }
  }
  return true;
}

std::uint32_t PentatopeComplex::Append(LabelId label)
{
  this->Corners.push_back({ None, None, None, None, None });
  this->Labels.push_back(label);
  this->Qualities.push_back(0.0);
  return static_cast<std::uint32_t>(this->Corners.size() - 1);
}

std::uint32_t PentatopeComplex::AddPoint(const Point<4>& p)
{
  this->Points.push_back(p);
  if (!this->Twins.empty())
  {
    this->Twins.push_back(None);
  }
  return static_cast<std::uint32_t>(this->Points.size() - 1);
}

} // namespace voxplex
