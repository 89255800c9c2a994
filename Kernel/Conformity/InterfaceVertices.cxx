// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Conformity/InterfaceVertices.h"

#include "Mesh/SimplexLabels.h"
#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <atomic>

namespace voxplex
{

namespace
{

constexpr std::size_t Grain = 4096;

/**
 * Inserts more ids, and their positions, where they belong. Both lists are ascending.
 * @param more becomes empty
 */
template <int D>
void MergeInto(std::vector<VertexId>& ids, std::vector<Point<D>>& positions,
  std::vector<VertexId>& more, const std::vector<Point<D>>& morePositions)
{
  auto from = ids.size();
  auto to = from + more.size();
  ids.reserve(to); // not twice as much
  ids.resize(to);
  positions.reserve(to);
  positions.resize(to);
  while (!more.empty())
  {
    --to;
    if (from > 0 && more.back() < ids[from - 1])
    {
      ids[to] = ids[--from];
      positions[to] = positions[from];
    }
    else
    {
      ids[to] = more.back();
      positions[to] = morePositions[more.size() - 1];
      more.pop_back();
    }
  }
}

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
InterfaceVertices<D>::InterfaceVertices(const Triangulation<D>& triangulation,
  const Domain<D>& image, unsigned threads, const std::stop_token& stop)
  : Source(triangulation)
  , Image(image)
  , Threads(threads)
  , Stop(stop)
{
}

template <int D>
void InterfaceVertices<D>::Forget()
{
  this->Seen = std::vector<std::uint16_t>();
  this->Known = std::vector<VertexId>();
  this->Positions = std::vector<Point<D>>();
  this->LastAdded = std::vector<Point<D>>();
}

template <int D>
auto InterfaceVertices<D>::Update() -> Changes
{
  return this->Seen.empty() ? this->FindAll() : this->FindChanges();
}

//------------------------------------------------------------------------------------------------
template <int D>
std::uint16_t InterfaceVertices<D>::GenerationOf(SimplexId s) const
{
  return this->Source.IsAlive(s) ? static_cast<std::uint16_t>(std::min<std::uint32_t>(
                                     this->Source.State(s).Generation, NotKnown))
                                 : NotKnown;
}

template <int D>
LabelId InterfaceVertices<D>::LabelOf(SimplexId s) const
{
  return LabelAtCentre(this->Source, this->Image, s);
}

//------------------------------------------------------------------------------------------------
template <int D>
auto InterfaceVertices<D>::FindAll() -> Changes
{
  const std::size_t ids = this->Source.SimplexIdEnd();
  this->Seen.resize(ids);
  SimplexLabels labels(ids); // smaller than states: neighbours are anywhere in memory
  ParallelFor(
    0, ids, Grain, this->Threads,
    [&](std::size_t first, std::size_t last)
    {
      for (auto s = static_cast<SimplexId>(first); s < last; ++s)
      {
        this->Seen[s] = this->GenerationOf(s);
        labels[s] = this->Source.IsAlive(s) ? this->LabelOf(s) : LabelId{ 0 };
      }
    },
    this->Stop);
  std::vector<std::uint8_t> isOnInterface(this->Source.VertexIdEnd());
  const auto mark = [&](VertexId v)
  {
    // Relaxed: all threads write the same value, and the end of the loop orders the writes before
    // reads.
    const std::atomic_ref<std::uint8_t> known(isOnInterface[v]);
    if (known.load(std::memory_order_relaxed) == 0)
    {
      known.store(1, std::memory_order_relaxed);
    }
  };
  // If two neighbouring simplices have different labels, the circumball of one of them meets an
  // interface, because the union of the two balls contains the dual edge.
  const auto look = [&](SimplexId s)
  {
    const auto& simplex = this->Source.GetSimplex(s);
    for (unsigned i = 0; i <= D; ++i)
    {
      const SimplexId n = simplex.N[i];
      if (n != None && labels[n] != labels[s])
      {
        for (unsigned m = 1; m <= D; ++m)
        {
          mark(simplex.V[(i + m) % (D + 1)]);
        }
      }
    }
  };
  ParallelFor(
    0, ids, Grain, this->Threads,
    [&](std::size_t first, std::size_t last)
    {
      for (auto s = static_cast<SimplexId>(first); s < last; ++s)
      {
        if (this->Source.State(s).NearSurface && this->Source.IsAlive(s))
        {
          look(s);
        }
      }
    },
    this->Stop);
  const auto number = static_cast<std::size_t>(
    std::count(isOnInterface.begin(), isOnInterface.end(), std::uint8_t{ 1 }));
  this->Known.reserve(number);
  this->Positions.reserve(number);
  for (VertexId v = 0; v < isOnInterface.size(); ++v)
  {
    if (isOnInterface[v] != 0)
    {
      this->Known.push_back(v);
      this->Positions.push_back(this->Source.Position(v));
    }
  }
  return { this->Positions, {} };
}

//------------------------------------------------------------------------------------------------
template <int D>
auto InterfaceVertices<D>::FindChanges() -> Changes
{
  const std::vector<VertexId> candidates = this->VerticesOfNewSimplices();
  std::vector<SimplexId> star;
  std::vector<VertexId> fresh; // not yet in Known; their positions are in LastAdded
  this->LastAdded.clear();
  Changes changes;
  // Only the stars of the candidates have changed. Some other vertices may have been removed. What
  // stays moves to the front of Known.
  std::size_t known = 0;
  std::size_t kept = 0;
  const auto keep = [&](std::size_t k)
  {
    this->Known[kept] = this->Known[k];
    this->Positions[kept] = this->Positions[k];
    ++kept;
  };
  const auto keepBefore = [&](VertexId end)
  {
    for (; known < this->Known.size() && this->Known[known] < end; ++known)
    {
      if (this->Source.GetVertex(this->Known[known]).Alive)
      {
        keep(known);
      }
      else
      {
        changes.Gone.push_back(this->Positions[known]);
      }
    }
  };
  for (const VertexId v : candidates)
  {
    ThrowIfStopped(this->Stop);
    keepBefore(v);
    const Point<D>& position = this->Source.Position(v);
    const bool isOn = this->IsOnInterface(v, star);
    const bool wasKnown = known < this->Known.size() && this->Known[known] == v;
    const bool isSame = isOn && wasKnown && this->Positions[known] == position; // ids are reused
    if (wasKnown && !isSame)
    {
      changes.Gone.push_back(this->Positions[known]);
    }
    if (isSame)
    {
      keep(known);
    }
    if (isOn && !isSame)
    {
      fresh.push_back(v);
      this->LastAdded.push_back(position);
    }
    known += wasKnown ? 1 : 0;
  }
  keepBefore(None);
  this->Known.resize(kept);
  this->Positions.resize(kept);
  MergeInto<D>(this->Known, this->Positions, fresh, this->LastAdded);
  changes.Added = this->LastAdded;
  return changes;
}

//------------------------------------------------------------------------------------------------
/** The vertices of simplices created since the last call, in ascending order. */
template <int D>
std::vector<VertexId> InterfaceVertices<D>::VerticesOfNewSimplices()
{
  const std::size_t ids = this->Source.SimplexIdEnd();
  this->Seen.reserve(ids); // not twice as much
  this->Seen.resize(ids, NotKnown);
  std::vector<std::vector<VertexId>> parts((ids - 1) / Grain + 1);
  ParallelFor(
    0, ids, Grain, this->Threads,
    [&](std::size_t first, std::size_t last)
    {
      std::vector<VertexId>& found = parts[first / Grain];
      for (auto s = static_cast<SimplexId>(first); s < last; ++s)
      {
        const std::uint16_t generation = this->GenerationOf(s);
        const bool isNew = generation != this->Seen[s] || generation == NotKnown;
        if (isNew && this->Source.IsAlive(s))
        {
          const auto& v = this->Source.GetSimplex(s).V;
          found.insert(found.end(), v.begin(), v.end());
        }
        this->Seen[s] = generation;
      }
    },
    this->Stop);
  std::vector<VertexId> vertices;
  for (const std::vector<VertexId>& part : parts)
  {
    vertices.insert(vertices.end(), part.begin(), part.end());
  }
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

//------------------------------------------------------------------------------------------------
template <int D>
bool InterfaceVertices<D>::IsOnInterface(VertexId v, std::vector<SimplexId>& star) const
{
  star.assign(1, this->Source.GetVertex(v).Incident);
  for (std::size_t k = 0; k < star.size(); ++k)
  {
    const auto& simplex = this->Source.GetSimplex(star[k]);
    const LabelId label = this->LabelOf(star[k]);
    for (unsigned i = 0; i <= D; ++i)
    {
      const SimplexId n = simplex.N[i];
      if (n == None || simplex.V[i] == v)
      {
        continue;
      }
      if (this->LabelOf(n) != label)
      {
        return true;
      }
      if (std::find(star.begin(), star.end(), n) == star.end())
      {
        star.push_back(n);
      }
    }
  }
  return false;
}

template class InterfaceVertices<3>;
template class InterfaceVertices<4>;

} // namespace voxplex
