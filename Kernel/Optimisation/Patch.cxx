// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Optimisation/Patch.h"

#include "Parallel/ParallelCollect.h"

#include <algorithm>

namespace voxplex
{

namespace
{

using Vertices = TetrahedralComplex::Vertices;

std::array<std::uint32_t, 3> SortedFacet(const Vertices& v, unsigned i)
{
  std::array<std::uint32_t, 3> f = { v[(i + 1) & 3], v[(i + 2) & 3], v[(i + 3) & 3] };
  std::sort(f.begin(), f.end());
  return f;
}

/** The vertices of a tetrahedron, starting with vertices i and j, positively oriented. */
Vertices StartingAtEdge(const Vertices& v, unsigned i, unsigned j)
{
  Vertices w = StartingAt(v, i);
  while (w[1] != v[j])
  {
    w = { w[0], w[2], w[3], w[1] };
  }
  return w;
}

/** The index of the vertex that is none of a, b and c. */
unsigned IndexOfOther(const Vertices& v, std::uint32_t a, std::uint32_t b, std::uint32_t c)
{
  unsigned i = 0;
  while (v[i] == a || v[i] == b || v[i] == c)
  {
    ++i;
  }
  return i;
}

} // namespace

//------------------------------------------------------------------------------------------------
bool Patch::GatherStar(std::uint32_t v, VertexStar& star)
{
  star.Vertex = v;
  star.Cells.clear();
  star.Corners.clear();
  star.Cells.push_back(this->Complex.Hosts[v]);
  for (std::size_t k = 0; k < star.Cells.size(); ++k)
  {
    const auto& cell = this->Complex.Cells[star.Cells[k]];
    if (!this->MayChange(star.Cells[k]))
    {
      return false;
    }
    const unsigned own = this->Complex.IndexOf(star.Cells[k], v);
    star.Corners.push_back(StartingAt(cell.V, own));
    for (unsigned i = 0; i < 4; ++i)
    {
      const std::uint32_t next = cell.N[i];
      if (i != own && next != None &&
        std::find(star.Cells.begin(), star.Cells.end(), next) == star.Cells.end())
      {
        star.Cells.push_back(next);
      }
    }
  }
  return star.Cells.size() == this->Complex.Degrees[v] || this->UseFoundStar(star);
}

//------------------------------------------------------------------------------------------------
bool Patch::GatherRing(
  std::uint32_t t, unsigned i, unsigned j, std::size_t most, EdgeRing& ring) const
{
  const Vertices start = StartingAtEdge(this->Complex.Cells[t].V, i, j);
  const std::uint32_t a = start[0];
  const std::uint32_t b = start[1];
  ring.A = a;
  ring.B = b;
  ring.Closed = false;
  ring.Link.assign({ start[2], start[3] });
  ring.Cells.assign({ t });
  if (!this->MayChange(t))
  {
    return false;
  }
  // Walk forwards until the start or the mesh's end, then backwards from the start.
  for (std::uint32_t cell = t;;)
  {
    const std::uint32_t behind = ring.Link[ring.Link.size() - 2];
    const std::uint32_t front = ring.Link.back();
    const std::uint32_t next = this->Complex.Cells[cell].N[this->Complex.IndexOf(cell, behind)];
    if (next == None)
    {
      break;
    }
    if (next == t)
    {
      ring.Closed = true;
      ring.Link.pop_back();
      return true;
    }
    const Vertices& v = this->Complex.Cells[next].V;
    if (ring.Cells.size() == most || !this->MayChange(next))
    {
      return false;
    }
    ring.Cells.push_back(next);
    ring.Link.push_back(v[IndexOfOther(v, a, b, front)]);
    cell = next;
  }
  for (std::uint32_t cell = t;;)
  {
    const std::uint32_t behind = ring.Link[1];
    const std::uint32_t front = ring.Link[0];
    const std::uint32_t next = this->Complex.Cells[cell].N[this->Complex.IndexOf(cell, behind)];
    if (next == None)
    {
      return true;
    }
    const Vertices& v = this->Complex.Cells[next].V;
    if (ring.Cells.size() == most || !this->MayChange(next))
    {
      return false;
    }
    ring.Cells.insert(ring.Cells.begin(), next);
    ring.Link.insert(ring.Link.begin(), v[IndexOfOther(v, a, b, front)]);
    cell = next;
  }
}

//------------------------------------------------------------------------------------------------
void Patch::Touch(const Vertices& v)
{
  for (const std::uint32_t w : v)
  {
    this->Complex.Changes[w] = this->Clock;
  }
}

bool Patch::Replace(std::span<const std::uint32_t> old, std::span<const NewTetrahedron> fresh)
{
  if (fresh.size() > old.size() + this->FreeSlots.size() || !this->FindNextHolders(old, fresh))
  {
    return false;
  }
  ++this->Clock;
  auto& cells = this->Complex.Cells;
  const auto isOld = [old](std::uint32_t t)
  { return std::find(old.begin(), old.end(), t) != old.end(); };

  // The facets around the hole, seen from outside.
  this->Open.clear();
  for (const std::uint32_t t : old)
  {
    const auto& cell = cells[t];
    this->Touch(cell.V);
    for (unsigned i = 0; i < 4; ++i)
    {
      const std::uint32_t outside = cell.N[i];
      if (outside != None && !isOld(outside))
      {
        const unsigned back = IndexOfOther(
          cells[outside].V, cell.V[(i + 1) & 3], cell.V[(i + 2) & 3], cell.V[(i + 3) & 3]);
        cells[outside].N[back] = None;
        this->Open.push_back({ SortedFacet(cell.V, i), outside, back });
      }
    }
    for (const std::uint32_t v : cell.V)
    {
      --this->Complex.Degrees[v];
    }
  }
  // Slots are last in, first out, so the slots of the hole are used first.
  for (std::size_t k = old.size(); k-- > 0;)
  {
    cells[old[k]].V[0] = None;
    this->FreeSlots.push_back(old[k]);
    if (!this->NextHolders.empty())
    {
      this->Complex.AreHolders[old[k]] = 0;
    }
  }
  // If a vertex of the hole loses its host, it gets another one beside the hole, if there is any.
  for (const OpenFacet& open : this->Open)
  {
    for (const std::uint32_t v : open.V)
    {
      this->Complex.Hosts[v] = open.Cell;
    }
  }
  for (std::size_t k = 0; k < fresh.size(); ++k)
  {
    const NewTetrahedron& tetrahedron = fresh[k];
    const std::uint32_t t = this->FreeSlots.back();
    this->FreeSlots.pop_back();
    if (!this->NextHolders.empty())
    {
      this->Complex.AreHolders[t] = this->NextHolders[k];
    }
    cells[t] = { tetrahedron.V, { None, None, None, None } };
    this->Complex.Labels[t] = tetrahedron.Label;
    const auto score = static_cast<float>(this->Complex.Score(tetrahedron.V));
    this->Complex.Scores[t] = score;
    if (score < 1.0f)
    {
      this->Poor.push_back(t);
    }
    this->Touch(tetrahedron.V);
    for (unsigned i = 0; i < 4; ++i)
    {
      this->Complex.Hosts[tetrahedron.V[i]] = t;
      ++this->Complex.Degrees[tetrahedron.V[i]];
      const auto facet = SortedFacet(tetrahedron.V, i);
      const auto match = std::find_if(this->Open.begin(), this->Open.end(),
        [&facet](const OpenFacet& open) { return open.V == facet; });
      if (match == this->Open.end())
      {
        this->Open.push_back({ facet, t, i });
      }
      else
      {
        cells[t].N[i] = match->Cell;
        cells[match->Cell].N[match->Index] = t;
        *match = this->Open.back();
        this->Open.pop_back();
      }
    }
  }
  return true;
}

bool Patch::Move(const VertexStar& star, const Point<3>& to, std::span<const float> scores)
{
  for (std::size_t k = 0; k < star.Cells.size(); ++k)
  {
    if (this->Complex.IsHolder(star.Cells[k]))
    {
      ComponentGuard<3>::Corners after = this->CornersOf(star.Corners[k]);
      after[0] = &to; // Corners have the vertex first
      if (!this->Complex.Guard->Keeps(this->LabelInImage(this->Complex.Labels[star.Cells[k]]),
            this->CornersOf(star.Corners[k]), after))
      {
        return false;
      }
    }
  }
  ++this->Clock;
  this->Complex.Points[star.Vertex] = to;
  for (std::size_t k = 0; k < star.Cells.size(); ++k)
  {
    this->Touch(star.Corners[k]);
    this->Complex.Scores[star.Cells[k]] = scores[k];
    if (scores[k] < 1.0f)
    {
      this->Poor.push_back(star.Cells[k]);
    }
  }
  return true;
}

//------------------------------------------------------------------------------------------------
ComponentGuard<3>::Corners Patch::CornersOf(const Vertices& v) const
{
  const auto& points = this->Complex.Points;
  return { &points[v[0]], &points[v[1]], &points[v[2]], &points[v[3]] };
}

LabelId Patch::LabelInImage(TetrahedralComplex::Label label) const
{
  return this->Complex.Guard->LabelOf(this->Complex.LabelValues[label]);
}

/**
 * Finds the new tetrahedra that hold what old ones have held. NextHolders becomes empty if there are
 * no holders in the mesh. Returns false if a component would be lost.
 */
bool Patch::FindNextHolders(
  std::span<const std::uint32_t> old, std::span<const NewTetrahedron> fresh)
{
  this->NextHolders.clear();
  if (this->Complex.AreHolders.empty())
  {
    return true;
  }
  this->NextHolders.resize(std::max<std::size_t>(fresh.size(), 1));
  for (const std::uint32_t t : old)
  {
    if (!this->Complex.IsHolder(t))
    {
      continue;
    }
    const TetrahedralComplex::Label label = this->Complex.Labels[t];
    std::vector<ComponentGuard<3>::Corners> corners;
    std::vector<std::size_t> places;
    for (std::size_t k = 0; k < fresh.size(); ++k)
    {
      if (fresh[k].Label == label)
      {
        corners.push_back(this->CornersOf(fresh[k].V));
        places.push_back(k);
      }
    }
    std::vector<std::uint8_t> areHolders(corners.size());
    if (!this->Complex.Guard->Keeps(this->LabelInImage(label),
          this->CornersOf(this->Complex.Cells[t].V), corners, areHolders))
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
void Patch::FindStars(
  std::span<const std::uint32_t> vertices, unsigned threads, const std::stop_token& stop)
{
  constexpr std::size_t Grain = 65536;
  this->FoundStars.clear();
  if (vertices.empty())
  {
    return;
  }
  std::vector<char> wanted(this->Complex.Points.size(), 0);
  for (const std::uint32_t v : vertices)
  {
    wanted[v] = 1;
  }
  const std::vector<std::uint32_t> cells = ParallelCollect<std::uint32_t>(
    this->Complex.Cells.size(), Grain, threads,
    [&](std::size_t first, std::size_t last, std::vector<std::uint32_t>& found)
    {
      for (auto t = static_cast<std::uint32_t>(first); t < last; ++t)
      {
        const Vertices& v = this->Complex.Cells[t].V;
        if (this->Complex.IsAlive(t) &&
          (wanted[v[0]] | wanted[v[1]] | wanted[v[2]] | wanted[v[3]]) != 0)
        {
          found.push_back(t);
        }
      }
    },
    stop);
  for (const std::uint32_t t : cells)
  {
    for (const std::uint32_t v : this->Complex.Cells[t].V)
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
bool Patch::UseFoundStar(VertexStar& star) const
{
  const auto found = this->FoundStars.find(star.Vertex);
  if (found == this->FoundStars.end() || found->second.size() != this->Complex.Degrees[star.Vertex])
  {
    return false;
  }
  star.Cells = found->second;
  star.Corners.clear();
  for (const std::uint32_t t : star.Cells)
  {
    const Vertices& v = this->Complex.Cells[t].V;
    if (!this->Complex.IsAlive(t) || std::find(v.begin(), v.end(), star.Vertex) == v.end())
    {
      return false;
    }
    star.Corners.push_back(StartingAt(v, this->Complex.IndexOf(t, star.Vertex)));
  }
  return true;
}

} // namespace voxplex
