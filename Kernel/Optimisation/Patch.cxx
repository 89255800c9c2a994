// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Optimisation/Patch.h"

#include "Parallel/ParallelCollect.h"

#include <algorithm>
#include <numeric>

namespace voxplex
{

namespace
{

/** The index of the vertex of v that is not in facet i of w. */
template <std::size_t N>
unsigned IndexBeyond(
  const std::array<std::uint32_t, N>& v, const std::array<std::uint32_t, N>& w, unsigned i)
{
  const auto isInFacet = [&](std::uint32_t x)
  {
    bool isThere = false;
    for (unsigned k = 0; k < N; ++k)
    {
      isThere = isThere || (k != i && w[k] == x);
    }
    return isThere;
  };
  unsigned k = 0;
  while (isInFacet(v[k]))
  {
    ++k;
  }
  return k;
}

/** The vertices of a tetrahedron, starting with vertices i and j, positively oriented. */
TetrahedralComplex::Vertices StartingAtEdge(
  const TetrahedralComplex::Vertices& v, unsigned i, unsigned j)
{
  TetrahedralComplex::Vertices w = StartingAt(v, i);
  while (w[1] != v[j])
  {
    w = { w[0], w[2], w[3], w[1] };
  }
  return w;
}

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
bool Patch<D>::GatherStar(std::uint32_t v, VertexStar<D>& star) const
{
  return this->Target.GatherStar(v, star, [this](std::uint32_t t) { return this->MayChange(t); }) &&
    (star.Cells.size() == this->Target.Degrees[v] || this->UseFoundStar(star));
}

//------------------------------------------------------------------------------------------------
template <int D>
void Patch<D>::Touch(const Vertices& v)
{
  for (const std::uint32_t w : v)
  {
    this->Target.Changes[w] = this->Clock;
  }
}

template <int D>
bool Patch<D>::Replace(std::span<const std::uint32_t> old, std::span<const NewCell<D>> fresh)
{
  if (fresh.size() > old.size() + this->FreeSlots.size() || !this->FindNextHolders(old, fresh))
  {
    return false;
  }
  ++this->Clock;
  auto& cells = this->Target.Cells;
  const auto isOld = [old](std::uint32_t t)
  { return std::find(old.begin(), old.end(), t) != old.end(); };

  // The facets around the hole, seen from outside.
  this->Open.clear();
  for (const std::uint32_t t : old)
  {
    const auto& cell = cells[t];
    this->Touch(cell.V);
    for (unsigned i = 0; i <= D; ++i)
    {
      const std::uint32_t outside = cell.N[i];
      if (outside != None && !isOld(outside))
      {
        const unsigned back = IndexBeyond(cells[outside].V, cell.V, i);
        cells[outside].N[back] = None;
        this->Open.push_back({ Complex<D>::SortedFacet(cell.V, i), outside, back });
      }
    }
    for (const std::uint32_t v : cell.V)
    {
      --this->Target.Degrees[v];
    }
  }
  // Slots are last in, first out, so the slots of the hole are used first.
  for (std::size_t k = old.size(); k-- > 0;)
  {
    cells[old[k]].V[0] = None;
    this->FreeSlots.push_back(old[k]);
    if (!this->NextHolders.empty())
    {
      this->Target.AreHolders[old[k]] = 0;
    }
  }
  // If a vertex of the hole loses its host, it gets another one beside the hole, if there is any.
  for (const auto& open : this->Open)
  {
    for (const std::uint32_t v : open.V)
    {
      this->Target.Hosts[v] = open.Cell;
    }
  }
  for (std::size_t k = 0; k < fresh.size(); ++k)
  {
    const NewCell<D>& cell = fresh[k];
    const std::uint32_t t = this->FreeSlots.back();
    this->FreeSlots.pop_back();
    if (!this->NextHolders.empty())
    {
      this->Target.AreHolders[t] = this->NextHolders[k];
    }
    cells[t].V = cell.V;
    cells[t].N.fill(None);
    this->Target.Labels[t] = cell.Label;
    this->Target.Scores[t] =
      static_cast<typename Complex<D>::ScoreValue>(this->Target.Score(cell.V));
    if (this->Target.IsPoor(t))
    {
      this->Poor.push_back(t);
    }
    this->Touch(cell.V);
    for (unsigned i = 0; i <= D; ++i)
    {
      this->Target.Hosts[cell.V[i]] = t;
      ++this->Target.Degrees[cell.V[i]];
      this->Target.Join(t, i, this->Open);
    }
  }
  return true;
}

template <int D>
bool Patch<D>::Move(std::uint32_t v, const Point<D>& to, std::span<const std::uint32_t> cells,
  std::span<const typename Complex<D>::ScoreValue> scores)
{
  const std::uint32_t twin = this->Target.TwinOf(v);
  Point<D> twinTo = to;
  if (twin != None)
  {
    twinTo[D - 1] = this->Target.Points[twin][D - 1];
  }
  for (const std::uint32_t t : cells)
  {
    const Vertices& corners = this->Target.Cells[t].V;
    const bool isAtTwin = std::find(corners.begin(), corners.end(), v) == corners.end();
    if (!this->Target.KeepsComponents(t, isAtTwin ? twin : v, isAtTwin ? twinTo : to))
    {
      return false;
    }
  }
  ++this->Clock;
  this->Target.Points[v] = to;
  if (twin != None)
  {
    this->Target.Points[twin] = twinTo;
  }
  for (std::size_t k = 0; k < cells.size(); ++k)
  {
    this->Touch(this->Target.Cells[cells[k]].V);
    this->Target.Scores[cells[k]] = scores[k];
    if (scores[k] < this->Target.Goal)
    {
      this->Poor.push_back(cells[k]);
    }
  }
  return true;
}

//------------------------------------------------------------------------------------------------
/**
 * Finds the new cells that hold what old ones have held. NextHolders becomes empty if there are
 * no holders in the mesh. Returns false if a component would be lost.
 */
template <int D>
bool Patch<D>::FindNextHolders(
  std::span<const std::uint32_t> old, std::span<const NewCell<D>> fresh)
{
  this->NextHolders.clear();
  if (this->Target.AreHolders.empty())
  {
    return true;
  }
  this->NextHolders.resize(std::max<std::size_t>(fresh.size(), 1));
  for (const std::uint32_t t : old)
  {
    if (!this->Target.IsHolder(t))
    {
      continue;
    }
    const auto label = this->Target.Labels[t];
    std::vector<typename ComponentGuard<D>::Corners> corners;
    std::vector<std::size_t> places;
    for (std::size_t k = 0; k < fresh.size(); ++k)
    {
      if (fresh[k].Label == label)
      {
        corners.push_back(this->Target.PointsOf(fresh[k].V));
        places.push_back(k);
      }
    }
    std::vector<std::uint8_t> areHolders(corners.size());
    if (!this->Target.Guard->Keeps(
          label, this->Target.PointsOf(this->Target.Cells[t].V), corners, areHolders))
    {
      return false;
    }
    for (std::size_t k = 0; k < places.size(); ++k)
    {
      this->NextHolders[places[k]] |= areHolders[k];
    }
  }
  return true;
}

//------------------------------------------------------------------------------------------------
template <int D>
void Patch<D>::NeedSlots(std::size_t number)
{
  const auto old = static_cast<std::uint32_t>(this->Target.Cells.size());
  if (this->FreeSlots.size() < number)
  {
    this->Target.AddCells(number);
    this->FreeSlots.resize(this->FreeSlots.size() + number);
    std::iota(this->FreeSlots.rbegin(),
      this->FreeSlots.rbegin() + static_cast<std::ptrdiff_t>(number), old);
  }
}

template <int D>
void Patch<D>::FindStars(
  std::span<const std::uint32_t> vertices, unsigned threads, const std::stop_token& stop)
{
  constexpr std::size_t Grain = 65536;
  this->FoundStars.clear();
  if (vertices.empty())
  {
    return;
  }
  std::vector<char> wanted(this->Target.Points.size(), 0);
  for (const std::uint32_t v : vertices)
  {
    wanted[v] = 1;
  }
  const std::vector<std::uint32_t> cells = ParallelCollect<std::uint32_t>(
    this->Target.Cells.size(), Grain, threads,
    [&](std::size_t first, std::size_t last, std::vector<std::uint32_t>& found)
    {
      for (auto t = static_cast<std::uint32_t>(first); t < last; ++t)
      {
        const Vertices& v = this->Target.Cells[t].V;
        if (this->Target.IsAlive(t) &&
          std::any_of(v.begin(), v.end(), [&](std::uint32_t w) { return wanted[w] != 0; }))
        {
          found.push_back(t);
        }
      }
    },
    stop);
  for (const std::uint32_t t : cells)
  {
    for (const std::uint32_t v : this->Target.Cells[t].V)
    {
      if (wanted[v] != 0)
      {
        this->FoundStars[v].push_back(t);
      }
    }
  }
}

/**
 * Replaces a partly gathered star by the found one. False if the star was not found or has changed.
 */
template <int D>
bool Patch<D>::UseFoundStar(VertexStar<D>& star) const
{
  const auto found = this->FoundStars.find(star.Vertex);
  if (found == this->FoundStars.end() || found->second.size() != this->Target.Degrees[star.Vertex])
  {
    return false;
  }
  star.Cells = found->second;
  star.Corners.clear();
  for (const std::uint32_t t : star.Cells)
  {
    const Vertices& v = this->Target.Cells[t].V;
    if (!this->Target.IsAlive(t) || std::find(v.begin(), v.end(), star.Vertex) == v.end())
    {
      return false;
    }
    star.Corners.push_back(StartingAt(v, this->Target.IndexOf(t, star.Vertex)));
  }
  return true;
}

//------------------------------------------------------------------------------------------------
bool GatherRing(
  const Patch<3>& patch, std::uint32_t t, unsigned i, unsigned j, std::size_t most, EdgeRing& ring)
{
  const TetrahedralComplex& mesh = patch.Mesh();
  const TetrahedralComplex::Vertices start = StartingAtEdge(mesh.Cells[t].V, i, j);
  ring.A = start[0];
  ring.B = start[1];
  return patch.MayChange(t) &&
    GatherRing(
      t, start[2],
      start[3], [&mesh](std::uint32_t cell) -> const auto& { return mesh.Cells[cell]; },
      [&](std::uint32_t next) { return ring.Cells.size() != most && patch.MayChange(next); }, ring);
}

template class Patch<3>;
template class Patch<4>;

} // namespace voxplex
