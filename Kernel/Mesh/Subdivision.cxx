// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/Subdivision.h"

#include "Geometry/HilbertOrder.h"
#include "Mesh/FindInterfaces.h"
#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <utility>

namespace voxplex
{

namespace
{

using Corners = std::array<std::uint32_t, 4>;

/** Changes a mesh in successive steps. Points that stay keep their order, and so do tetrahedra. */
class Divider
{
public:
  Divider(const Triangulation<3>& triangulation, const Domain<3>& domain,
    const Subdivision& subdivision, SimplexMesh<3>& mesh)
    : Source(triangulation)
    , Image(domain)
    , Parts(subdivision)
    , Mesh(mesh)
  {
  }

  void Run(unsigned threads, const std::stop_token& stop)
  {
    this->FindNumbers();
    ThrowIfStopped(stop);
    this->DropReplaced();
    this->AddPoints();
    this->AddPieces();
    ThrowIfStopped(stop);
    this->RenewFacets(threads, stop);
  }

private:
  const Point<3>& Position(VertexId v) const
  {
    const VertexId end = this->Source.VertexIdEnd();
    return v < end ? this->Source.Position(v) : this->Parts.Points[v - end];
  }

  std::uint64_t PlaceOf(const Point<3>& p) const
  {
    return HilbertIndex<3>(p, this->Source.GetBox());
  }

  bool IsTouched(std::uint32_t point) const { return this->Touched[point] != 0; }

  /**
   * Finds the points of the mesh that are vertices of replaced tetrahedra. No two points are at the
   * same place.
   */
  void FindNumbers()
  {
    for (const SimplexId s : this->Parts.Replaced)
    {
      for (const VertexId v : this->Source.GetSimplex(s).V)
      {
        this->Numbers[this->Position(v)] = None;
      }
    }
    this->Touched.assign(this->Mesh.Points.size(), 0);
    for (std::uint32_t p = 0; p < this->Touched.size(); ++p)
    {
      const auto found = this->Numbers.find(this->Mesh.Points[p]);
      if (found != this->Numbers.end())
      {
        found->second = p;
        this->Touched[p] = 1;
      }
    }
  }

  void DropReplaced()
  {
    std::set<Corners> replaced;
    for (const SimplexId s : this->Parts.Replaced)
    {
      Corners corners;
      for (unsigned i = 0; i < 4; ++i)
      {
        corners[i] = this->Numbers.at(this->Position(this->Source.GetSimplex(s).V[i]));
      }
      std::sort(corners.begin(), corners.end());
      replaced.insert(corners);
    }
    std::size_t kept = 0;
    for (std::size_t t = 0; t < this->Mesh.Simplices.size(); ++t)
    {
      Corners corners = this->Mesh.Simplices[t];
      std::sort(corners.begin(), corners.end());
      const bool isReplaced = std::all_of(corners.begin(), corners.end(),
                                [this](std::uint32_t p) { return this->IsTouched(p); }) &&
        replaced.contains(corners);
      if (!isReplaced)
      {
        this->Mesh.Simplices[kept] = this->Mesh.Simplices[t];
        this->Mesh.Labels[kept] = this->Mesh.Labels[t];
        ++kept;
      }
    }
    this->Mesh.Simplices.resize(kept);
    this->Mesh.Labels.resize(kept);
  }

  /**
   * Inserts the points of pieces that the mesh lacks at their places along the curve, and renumbers
   * all points behind them.
   */
  void AddPoints()
  {
    // The value is the number of the point before which it is inserted.
    std::map<std::pair<std::uint64_t, Point<3>>, std::size_t> added;
    for (const Piece& piece : this->Parts.Pieces)
    {
      for (const VertexId v : piece.V)
      {
        const Point<3>& p = this->Position(v);
        if (piece.Label != 0 && this->Numbers.try_emplace(p, None).first->second == None)
        {
          const std::uint64_t place = this->PlaceOf(p);
          const auto behind =
            std::upper_bound(this->Mesh.Points.begin(), this->Mesh.Points.end(), place,
              [this](std::uint64_t own, const Point<3>& other)
              { return own < this->PlaceOf(other); });
          added[{ place, p }] = static_cast<std::size_t>(behind - this->Mesh.Points.begin());
        }
      }
    }
    UninitialisedVector<Point<3>> points;
    std::vector<std::uint8_t> touched;
    std::vector<std::uint32_t> numbers(this->Mesh.Points.size());
    points.reserve(this->Mesh.Points.size() + added.size());
    auto next = added.begin();
    for (std::size_t p = 0; p <= numbers.size(); ++p)
    {
      for (; next != added.end() && next->second == p; ++next)
      {
        this->Numbers[next->first.second] = static_cast<std::uint32_t>(points.size());
        points.push_back(next->first.second);
        touched.push_back(1);
      }
      if (p < numbers.size())
      {
        numbers[p] = static_cast<std::uint32_t>(points.size());
        points.push_back(this->Mesh.Points[p]);
        touched.push_back(this->Touched[p]);
        if (this->IsTouched(static_cast<std::uint32_t>(p)))
        {
          this->Numbers[this->Mesh.Points[p]] = numbers[p];
        }
      }
    }
    this->Mesh.Points = std::move(points);
    this->Touched = std::move(touched);
    Renumber(numbers, this->Mesh.Simplices);
    Renumber(numbers, this->Mesh.Facets);
  }

  template <typename Cells>
  static void Renumber(const std::vector<std::uint32_t>& numbers, Cells& cells)
  {
    for (auto& cell : cells)
    {
      for (std::uint32_t& p : cell)
      {
        p = numbers[p];
      }
    }
  }

  /** Inserts each piece behind the tetrahedra with the same smallest point. */
  void AddPieces()
  {
    struct Added
    {
      Corners V;
      std::int64_t Label;
    };
    const auto smallest = [](const Corners& v) { return *std::min_element(v.begin(), v.end()); };
    std::vector<Added> added;
    for (const Piece& piece : this->Parts.Pieces)
    {
      if (piece.Label != 0)
      {
        Added one{ {}, this->Image.LabelValue(piece.Label) };
        for (unsigned i = 0; i < 4; ++i)
        {
          one.V[i] = this->Numbers.at(this->Position(piece.V[i]));
        }
        added.push_back(one);
      }
    }
    std::stable_sort(added.begin(), added.end(),
      [&](const Added& a, const Added& b) { return smallest(a.V) < smallest(b.V); });
    std::size_t from = this->Mesh.Simplices.size();
    std::size_t to = from + added.size();
    this->Mesh.Simplices.resize(to);
    this->Mesh.Labels.resize(to);
    while (!added.empty())
    {
      --to;
      if (from > 0 && smallest(this->Mesh.Simplices[from - 1]) > smallest(added.back().V))
      {
        --from;
        this->Mesh.Simplices[to] = this->Mesh.Simplices[from];
        this->Mesh.Labels[to] = this->Mesh.Labels[from];
      }
      else
      {
        this->Mesh.Simplices[to] = added.back().V;
        this->Mesh.Labels[to] = added.back().Label;
        added.pop_back();
      }
    }
  }

  /** A facet of a changed tetrahedron has touched points only. Such facets are found again. */
  void RenewFacets(unsigned threads, const std::stop_token& stop)
  {
    const auto touchedOf = [this](const auto& v)
    {
      return std::count_if(
        v.begin(), v.end(), [this](std::uint32_t p) { return this->IsTouched(p); });
    };
    SimplexMesh<3> part;
    part.Points = this->Mesh.Points;
    for (std::size_t t = 0; t < this->Mesh.Simplices.size(); ++t)
    {
      if (touchedOf(this->Mesh.Simplices[t]) >= 3)
      {
        part.Simplices.push_back(this->Mesh.Simplices[t]);
        part.Labels.push_back(this->Mesh.Labels[t]);
      }
    }
    FindInterfaces(part, threads, stop);
    std::size_t kept = 0;
    for (std::size_t f = 0; f < this->Mesh.Facets.size(); ++f)
    {
      if (touchedOf(this->Mesh.Facets[f]) < 3)
      {
        this->Mesh.Facets[kept] = this->Mesh.Facets[f];
        this->Mesh.FacetLabels[kept] = this->Mesh.FacetLabels[f];
        ++kept;
      }
    }
    this->Mesh.Facets.resize(kept);
    this->Mesh.FacetLabels.resize(kept);
    for (std::size_t f = 0; f < part.Facets.size(); ++f)
    {
      if (touchedOf(part.Facets[f]) == 3)
      {
        this->Mesh.Facets.push_back(part.Facets[f]);
        this->Mesh.FacetLabels.push_back(part.FacetLabels[f]);
      }
    }
  }

  const Triangulation<3>& Source;
  const Domain<3>& Image;
  const Subdivision& Parts;
  SimplexMesh<3>& Mesh;
  std::map<Point<3>, std::uint32_t> Numbers; ///< in the mesh; None if the mesh lacks the point
  std::vector<std::uint8_t> Touched; ///< by point: whether it is a vertex of a changed tetrahedron
};

} // namespace

void Subdivide(const Triangulation<3>& triangulation, const Domain<3>& domain,
  const Subdivision& subdivision, SimplexMesh<3>& mesh, unsigned threads,
  const std::stop_token& stop)
{
  if (!subdivision.Replaced.empty())
  {
    Divider(triangulation, domain, subdivision, mesh).Run(threads, stop);
  }
}

} // namespace voxplex
