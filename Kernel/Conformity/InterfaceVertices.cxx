// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Conformity/InterfaceVertices.h"

#include "Conformity/PositionDifference.h"
#include "Delaunay/VertexStar.h"
#include "Mesh/SimplexLabels.h"
#include "Parallel/ChunkCounts.h"
#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <atomic>

namespace voxplex
{

namespace
{

constexpr std::size_t Grain = 4096;
constexpr std::size_t StarGrain = 256;

/** A set of vertices that all threads may add to. */
class MarkedVertices
{
public:
  explicit MarkedVertices(VertexId end)
    : Marks(end)
  {
  }

  void Mark(VertexId v)
  {
    // Relaxed: all threads write the same value, and the end of the loop orders the writes before
    // reads.
    const std::atomic_ref<std::uint8_t> mark(this->Marks[v]);
    if (mark.load(std::memory_order_relaxed) == 0)
    {
      mark.store(1, std::memory_order_relaxed);
    }
  }

  /** The marked vertices, in ascending order. */
  UninitialisedVector<VertexId> List(unsigned threads, const std::stop_token& stop) const
  {
    const auto forChunks = [&](auto&& function)
    { ParallelFor(0, this->Marks.size(), ChunkCounts::Grain, threads, function, stop); };
    ChunkCounts counts(this->Marks.size());
    forChunks(
      [&](std::size_t first, std::size_t last)
      {
        counts.OfChunk(first) = static_cast<std::size_t>(
          std::count(this->Marks.data() + first, this->Marks.data() + last, std::uint8_t{ 1 }));
      });
    UninitialisedVector<VertexId> list(counts.TurnIntoPlaces());
    forChunks(
      [&](std::size_t first, std::size_t last)
      {
        std::size_t place = counts.OfChunk(first);
        for (std::size_t v = first; v < last; ++v)
        {
          if (this->Marks[v] != 0)
          {
            list[place++] = static_cast<VertexId>(v);
          }
        }
      });
    return list;
  }

private:
  std::vector<std::uint8_t> Marks;
};

/** Makes room for a number of elements and a few more, but not for twice as many. */
template <typename Vector>
void MakeRoom(Vector& vector, std::size_t elements)
{
  if (elements > vector.capacity())
  {
    vector.reserve(elements + elements / 16);
  }
}

/**
 * Inserts more ids, and their positions, where they belong. Both lists are ascending.
 * @param more becomes empty
 */
template <int D>
void MergeInto(UninitialisedVector<VertexId>& ids, UninitialisedVector<Point<D>>& positions,
  std::vector<VertexId>& more, const std::vector<Point<D>>& morePositions)
{
  auto from = ids.size();
  auto to = from + more.size();
  MakeRoom(ids, to);
  ids.resize(to);
  MakeRoom(positions, to);
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
  , Seen(triangulation)
{
}

template <int D>
void InterfaceVertices<D>::Forget()
{
  this->Seen.Forget();
  this->Known = UninitialisedVector<VertexId>();
  this->Positions = UninitialisedVector<Point<D>>();
  this->LastAdded = std::vector<Point<D>>();
}

template <int D>
auto InterfaceVertices<D>::Update() -> Changes
{
  if (this->Seen.IsEmpty())
  {
    this->FindAll(true);
    return { this->Positions, {} };
  }
  // With more, it takes less time to label all simplices than to go around these vertices. All are
  // new after the triangulation was renumbered.
  constexpr std::size_t LargestShare = 4;
  const UninitialisedVector<VertexId> candidates = this->VerticesOfNewSimplices();
  return candidates.size() > this->Source.VertexIdEnd() / LargestShare
    ? this->FindAllAgain()
    : this->FindChanges(candidates);
}

//------------------------------------------------------------------------------------------------
template <int D>
LabelId InterfaceVertices<D>::LabelOf(SimplexId s) const
{
  return LabelAtCentre(this->Source, this->Image, s);
}

//------------------------------------------------------------------------------------------------
/** @param isRefined whether SimplexState::NearSurface tells where interfaces may be */
template <int D>
void InterfaceVertices<D>::FindAll(bool isRefined)
{
  const std::size_t ids = this->Source.SimplexIdEnd();
  this->Seen.MakeRoom();
  SimplexLabels labels(ids); // smaller than states: neighbours are anywhere in memory
  ParallelFor(
    0, ids, Grain, this->Threads,
    [&](std::size_t first, std::size_t last)
    {
      for (auto s = static_cast<SimplexId>(first); s < last; ++s)
      {
        this->Seen.See(s);
        labels[s] = this->Source.IsAlive(s) ? this->LabelOf(s) : LabelId{ 0 };
      }
    },
    this->Stop);
  MarkedVertices onInterfaces(this->Source.VertexIdEnd());
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
          onInterfaces.Mark(simplex.V[(i + m) % (D + 1)]);
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
        if ((!isRefined || this->Source.State(s).NearSurface) && this->Source.IsAlive(s))
        {
          look(s);
        }
      }
    },
    this->Stop);
  this->Known = onInterfaces.List(this->Threads, this->Stop);
  this->Positions.resize(this->Known.size());
  ParallelFor(
    0, this->Known.size(), Grain, this->Threads,
    [&](std::size_t first, std::size_t last)
    {
      for (std::size_t k = first; k < last; ++k)
      {
        this->Positions[k] = this->Source.Position(this->Known[k]);
      }
    },
    this->Stop);
}

template <int D>
auto InterfaceVertices<D>::FindAllAgain() -> Changes
{
  const UninitialisedVector<Point<D>> before = std::move(this->Positions);
  this->Positions = {};
  this->FindAll(false);
  PositionDifference<D> difference =
    DifferenceOf<D>(before, this->Positions, this->Threads, this->Stop);
  this->LastAdded = std::move(difference.OfSecond);
  return { this->LastAdded, std::move(difference.OfFirst) };
}

//------------------------------------------------------------------------------------------------
/** @param candidates the vertices of simplices created since the last call, ascending */
template <int D>
auto InterfaceVertices<D>::FindChanges(const UninitialisedVector<VertexId>& candidates) -> Changes
{
  const UninitialisedVector<std::uint8_t> areOnInterfaces = this->AreOnInterfaces(candidates);
  UninitialisedVector<std::uint8_t> isGone = this->AreRemoved();
  std::vector<VertexId> fresh; // not yet in Known; their positions are in LastAdded
  this->LastAdded.clear();
  // Only the stars of the candidates have changed.
  auto known = this->Known.begin();
  for (std::size_t c = 0; c < candidates.size(); ++c)
  {
    const VertexId v = candidates[c];
    const Point<D>& position = this->Source.Position(v);
    known = std::lower_bound(known, this->Known.end(), v);
    const auto k = static_cast<std::size_t>(known - this->Known.begin());
    const bool wasKnown = known != this->Known.end() && *known == v;
    const bool isOn = areOnInterfaces[c] != 0;
    const bool isSame = isOn && wasKnown && this->Positions[k] == position; // ids are reused
    if (wasKnown && !isSame)
    {
      isGone[k] = 1;
    }
    if (isOn && !isSame)
    {
      fresh.push_back(v);
      this->LastAdded.push_back(position);
    }
  }
  Changes changes;
  changes.Gone = this->Drop(isGone);
  MergeInto<D>(this->Known, this->Positions, fresh, this->LastAdded);
  changes.Added = this->LastAdded;
  return changes;
}

//------------------------------------------------------------------------------------------------
template <int D>
UninitialisedVector<std::uint8_t> InterfaceVertices<D>::AreRemoved() const
{
  UninitialisedVector<std::uint8_t> answers(this->Known.size());
  ParallelFor(
    0, this->Known.size(), Grain, this->Threads,
    [&](std::size_t first, std::size_t last)
    {
      for (std::size_t k = first; k < last; ++k)
      {
        answers[k] = this->Source.GetVertex(this->Known[k]).Alive ? 0 : 1;
      }
    },
    this->Stop);
  return answers;
}

template <int D>
std::vector<Point<D>> InterfaceVertices<D>::Drop(std::span<const std::uint8_t> isGone)
{
  std::vector<Point<D>> gone;
  auto kept = static_cast<std::size_t>(
    std::find(isGone.begin(), isGone.end(), std::uint8_t{ 1 }) - isGone.begin());
  for (std::size_t k = kept; k < isGone.size(); ++k)
  {
    if (isGone[k] != 0)
    {
      gone.push_back(this->Positions[k]);
    }
    else
    {
      this->Known[kept] = this->Known[k];
      this->Positions[kept] = this->Positions[k];
      ++kept;
    }
  }
  this->Known.resize(kept);
  this->Positions.resize(kept);
  return gone;
}

//------------------------------------------------------------------------------------------------
/** The vertices of simplices created since the last call, in ascending order. */
template <int D>
UninitialisedVector<VertexId> InterfaceVertices<D>::VerticesOfNewSimplices()
{
  const std::size_t ids = this->Source.SimplexIdEnd();
  this->Seen.MakeRoom();
  MarkedVertices found(this->Source.VertexIdEnd());
  ParallelFor(
    0, ids, Grain, this->Threads,
    [&](std::size_t first, std::size_t last)
    {
      for (auto s = static_cast<SimplexId>(first); s < last; ++s)
      {
        if (this->Seen.See(s))
        {
          for (const VertexId v : this->Source.GetSimplex(s).V)
          {
            found.Mark(v);
          }
        }
      }
    },
    this->Stop);
  return found.List(this->Threads, this->Stop);
}

//------------------------------------------------------------------------------------------------
template <int D>
UninitialisedVector<std::uint8_t> InterfaceVertices<D>::AreOnInterfaces(
  std::span<const VertexId> vertices) const
{
  UninitialisedVector<std::uint8_t> answers(vertices.size());
  ParallelFor(
    0, vertices.size(), StarGrain, this->Threads,
    [&](std::size_t first, std::size_t last)
    {
      for (std::size_t k = first; k < last; ++k)
      {
        answers[k] = this->IsOnInterface(vertices[k]) ? 1 : 0;
      }
    },
    this->Stop);
  return answers;
}

template <int D>
bool InterfaceVertices<D>::IsOnInterface(VertexId v) const
{
  const SimplexId incident = this->Source.GetVertex(v).Incident;
  return AnyInStar(this->Source, v, incident,
    [this, label = this->LabelOf(incident)](SimplexId s) { return this->LabelOf(s) != label; });
}

template class InterfaceVertices<3>;
template class InterfaceVertices<4>;

} // namespace voxplex
