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
#include <span>
#include <utility>

namespace voxplex
{

namespace
{

/** Changes a mesh in successive steps. Points that stay keep their order, and so do simplices. */
template <int D>
class Divider
{
public:
  Divider(const Triangulation<D>& triangulation, const Domain<D>& domain,
    const Subdivision<D>& subdivision, const MovedVertices<D>& moved, SimplexMesh<D>& mesh)
    : Source(triangulation)
    , Image(domain)
    , Parts(subdivision)
    , Moved(moved)
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
  static constexpr unsigned N = D + 1;
  using Corners = std::array<std::uint32_t, N>;

  const Point<D>& Position(VertexId v) const
  {
    const VertexId end = this->Source.VertexIdEnd();
    if (v >= end)
    {
      return this->Parts.Points[v - end];
    }
    return this->Moved.Positions.empty() ? this->Source.Position(v) : this->Moved.Positions[v];
  }

  std::uint64_t PlaceOf(const Point<D>& p) const
  {
    return HilbertIndex<D>(p, this->Source.GetBox());
  }

  bool IsTouched(std::uint32_t point) const { return this->Touched[point] != 0; }

  /**
   * Finds the points of the mesh that are vertices of replaced simplices. No two points are at the
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
      for (unsigned i = 0; i < N; ++i)
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

  /** The points by whose places the mesh is sorted; empty if they are still those of the mesh. */
  std::vector<Point<D>> PointsBeforeMoving() const
  {
    std::vector<Point<D>> points;
    if (!this->Moved.Positions.empty())
    {
      points.resize(this->Mesh.Points.size());
      for (VertexId v = 0; v < this->Source.VertexIdEnd(); ++v)
      {
        if ((*this->Moved.Numbers)[v] != None)
        {
          points[(*this->Moved.Numbers)[v]] = this->Source.Position(v);
        }
      }
    }
    return points;
  }

  /**
   * Inserts the points of pieces that the mesh lacks at their places along the curve, and renumbers
   * all points behind them.
   */
  void AddPoints()
  {
    // The value is the number of the point before which it is inserted.
    std::map<std::pair<std::uint64_t, Point<D>>, std::size_t> added;
    const std::vector<Point<D>> before = this->PointsBeforeMoving();
    const std::span<const Point<D>> sorted =
      before.empty() ? std::span<const Point<D>>(this->Mesh.Points) : before;
    for (const Piece<D>& piece : this->Parts.Pieces)
    {
      for (const VertexId v : piece.V)
      {
        const Point<D>& p = this->Position(v);
        if (piece.Label != 0 && this->Numbers.try_emplace(p, None).first->second == None)
        {
          const std::uint64_t place = this->PlaceOf(p);
          const auto behind = std::upper_bound(sorted.begin(), sorted.end(), place,
            [this](std::uint64_t own, const Point<D>& other)
            { return own < this->PlaceOf(other); });
          added[{ place, p }] = static_cast<std::size_t>(behind - sorted.begin());
        }
      }
    }
    // From behind, so that no point is overwritten before it has moved.
    std::vector<std::uint32_t> numbers(this->Mesh.Points.size());
    std::size_t to = numbers.size() + added.size();
    this->Mesh.Points.resize(to);
    this->Touched.resize(to);
    auto next = added.rbegin();
    for (std::size_t p = numbers.size() + 1; p-- > 0;)
    {
      if (p < numbers.size())
      {
        numbers[p] = static_cast<std::uint32_t>(--to);
        this->Mesh.Points[to] = this->Mesh.Points[p];
        this->Touched[to] = this->Touched[p];
        if (this->Touched[to] != 0)
        {
          this->Numbers[this->Mesh.Points[to]] = numbers[p];
        }
      }
      for (; next != added.rend() && next->second == p; ++next)
      {
        this->Numbers[next->first.second] = static_cast<std::uint32_t>(--to);
        this->Mesh.Points[to] = next->first.second;
        this->Touched[to] = 1;
      }
    }
    Renumber(numbers, this->Mesh.Simplices);
    Renumber(numbers, this->Mesh.Facets);
    this->TellNumbers(numbers);
  }

  /** Tells the caller the new numbers of vertices, and those of new points. */
  void TellNumbers(const std::vector<std::uint32_t>& renumbered)
  {
    if (!this->Moved.Numbers)
    {
      return;
    }
    UninitialisedVector<std::uint32_t>& numbers = *this->Moved.Numbers;
    for (std::uint32_t& p : numbers)
    {
      p = p != None ? renumbered[p] : None;
    }
    numbers.resize(this->Source.VertexIdEnd() + this->Parts.Points.size());
    for (const Piece<D>& piece : this->Parts.Pieces)
    {
      for (const VertexId v : piece.V)
      {
        const auto found = this->Numbers.find(this->Position(v));
        numbers[v] = found != this->Numbers.end() ? found->second : None;
      }
    }
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

  /** Inserts each piece behind the simplices with the same smallest point. */
  void AddPieces()
  {
    struct Added
    {
      Corners V;
      std::int64_t Label;
    };
    const auto smallest = [](const Corners& v) { return *std::min_element(v.begin(), v.end()); };
    std::vector<Added> added;
    for (const Piece<D>& piece : this->Parts.Pieces)
    {
      if (piece.Label != 0)
      {
        Added one{ {}, this->Image.LabelValue(piece.Label) };
        for (unsigned i = 0; i < N; ++i)
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

  /** A facet of a changed simplex has touched points only. Such facets are found again. */
  void RenewFacets(unsigned threads, const std::stop_token& stop)
  {
    const auto touchedOf = [this](const auto& v)
    {
      return std::count_if(
        v.begin(), v.end(), [this](std::uint32_t p) { return this->IsTouched(p); });
    };
    SimplexMesh<D> part;
    std::vector<std::uint32_t>
      points; // of the part, ascending, so that its numbers have the same order
    for (std::size_t t = 0; t < this->Mesh.Simplices.size(); ++t)
    {
      if (touchedOf(this->Mesh.Simplices[t]) >= D)
      {
        part.Simplices.push_back(this->Mesh.Simplices[t]);
        part.Labels.push_back(this->Mesh.Labels[t]);
        points.insert(points.end(), part.Simplices.back().begin(), part.Simplices.back().end());
      }
    }
    std::sort(points.begin(), points.end());
    points.erase(std::unique(points.begin(), points.end()), points.end());
    part.Points.resize(points.size()); // only their number is needed
    for (auto& simplex : part.Simplices)
    {
      for (std::uint32_t& v : simplex)
      {
        v = static_cast<std::uint32_t>(
          std::lower_bound(points.begin(), points.end(), v) - points.begin());
      }
    }
    FindInterfaces<D>(part, threads, stop);
    std::size_t kept = 0;
    for (std::size_t f = 0; f < this->Mesh.Facets.size(); ++f)
    {
      if (touchedOf(this->Mesh.Facets[f]) < D)
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
      auto facet = part.Facets[f];
      std::transform(
        facet.begin(), facet.end(), facet.begin(), [&](std::uint32_t v) { return points[v]; });
      if (touchedOf(facet) == D)
      {
        this->Mesh.Facets.push_back(facet);
        this->Mesh.FacetLabels.push_back(part.FacetLabels[f]);
      }
    }
  }

  const Triangulation<D>& Source;
  const Domain<D>& Image;
  const Subdivision<D>& Parts;
  const MovedVertices<D>& Moved;
  SimplexMesh<D>& Mesh;
  std::map<Point<D>, std::uint32_t> Numbers; ///< in the mesh; None if the mesh lacks the point
  std::vector<std::uint8_t> Touched; ///< by point: whether it is a vertex of a changed simplex
};

} // namespace

template <int D>
void Subdivide(const Triangulation<D>& triangulation, const Domain<D>& domain,
  const Subdivision<D>& subdivision, SimplexMesh<D>& mesh, unsigned threads,
  const std::stop_token& stop, const MovedVertices<D>& moved)
{
  if (!subdivision.Replaced.empty())
  {
    Divider<D>(triangulation, domain, subdivision, moved, mesh).Run(threads, stop);
  }
}

template void Subdivide<3>(const Triangulation<3>&, const Domain<3>&, const Subdivision<3>&,
  SimplexMesh<3>&, unsigned, const std::stop_token&, const MovedVertices<3>&);
template void Subdivide<4>(const Triangulation<4>&, const Domain<4>&, const Subdivision<4>&,
  SimplexMesh<4>&, unsigned, const std::stop_token&, const MovedVertices<4>&);

} // namespace voxplex
