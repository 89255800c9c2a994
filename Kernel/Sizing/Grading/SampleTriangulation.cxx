// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Sizing/Grading/SampleTriangulation.h"

#include "Base/MixBits.h"
#include "Geometry/HilbertOrder.h"
#include "Parallel/ParallelFor.h"
#include "Sizing/Grading/PointBounds.h"

#include <algorithm>
#include <atomic>

namespace voxplex
{

namespace
{

constexpr std::size_t RoundFactor = 8;
constexpr std::size_t FewestOfRound = 256;
/** Points that a thread takes at a time. */
constexpr std::size_t PieceSize = 1024;
/** Smaller last rounds are inserted by one thread. */
constexpr std::size_t FewestForThreads = 4 * PieceSize;

template <int D>
Box<D> MakeBox(const std::vector<Point<D>>& sample, double margin)
{
  Box<D> box = BoundsOf<D>(sample);
  for (std::size_t a = 0; a < D; ++a)
  {
    box.Min[a] -= margin;
    box.Max[a] += margin;
  }
  return box;
}

/** The round of the k-th point. Rounds are spread evenly over the sample. */
std::size_t InsertionRound(std::size_t k, std::size_t rounds)
{
  std::size_t round = rounds - 1;
  std::uint64_t h = MixBits(k + 1);
  for (; round > 0 && h % RoundFactor == 0; --round)
  {
    h /= RoundFactor;
  }
  return round;
}

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
SampleTriangulation<D>::SampleTriangulation(
  const std::vector<Point<D>>& sample, double margin, unsigned threads, const std::stop_token& stop)
  : Triangulated(MakeBox<D>(sample, margin))
  , Stop(stop)
{
  std::size_t rounds = 1;
  for (std::size_t n = sample.size(); n / RoundFactor >= FewestOfRound; n /= RoundFactor)
  {
    ++rounds;
  }
  std::vector<std::vector<CurvePoint>> entries(rounds);
  for (std::size_t k = 0; k < sample.size(); ++k)
  {
    entries[InsertionRound(k, rounds)].push_back(
      { HilbertIndex<D>(sample[k], this->Triangulated.GetBox()), sample[k] });
  }
  const auto before = [](const CurvePoint& a, const CurvePoint& b)
  { return a.Key != b.Key ? a.Key < b.Key : a.Position < b.Position; };
  ParallelFor(0, rounds, 1, threads,
    [&](std::size_t first, std::size_t last)
    {
      for (std::size_t round = first; round < last; ++round)
      {
        std::sort(entries[round].begin(), entries[round].end(), before);
      }
    });
  const bool together = NumberOfThreads(threads) > 1 && entries.back().size() >= FewestForThreads;
  for (std::size_t round = 0; round + 1 < rounds; ++round)
  {
    this->InsertAlone(entries[round], together ? &this->Before : nullptr);
  }
  if (together && !this->Before.empty())
  {
    std::sort(this->Before.begin(), this->Before.end(), before);
    this->InsertTogether(entries.back(), NumberOfThreads(threads));
    entries.back().swap(this->Left);
    std::sort(entries.back().begin(), entries.back().end(), before);
  }
  this->InsertAlone(entries.back(), nullptr);
}

//------------------------------------------------------------------------------------------------
template <int D>
void SampleTriangulation<D>::InsertAlone(
  const std::vector<CurvePoint>& entries, std::vector<CurvePoint>* inserted)
{
  Triangulation<D>& mesh = this->Triangulated;
  Worker worker(mesh);
  SimplexId near = mesh.FirstAlive();
  for (std::size_t k = 0; k < entries.size(); ++k)
  {
    if (k % PieceSize == 0)
    {
      ThrowIfStopped(this->Stop);
    }
    const SimplexId conflict = mesh.FindConflict(worker, entries[k].Position, near);
    if (conflict != None &&
      mesh.Insert(worker, entries[k].Position, VertexKind::Feature, conflict) ==
        InsertionOutcome::Inserted)
    {
      near = worker.Created[0];
      if (inserted)
      {
        inserted->push_back(entries[k]);
        inserted->back().Vertex = worker.NewVertex;
      }
    }
  }
}

//------------------------------------------------------------------------------------------------
template <int D>
void SampleTriangulation<D>::InsertTogether(
  const std::vector<CurvePoint>& entries, unsigned threads)
{
  std::atomic<std::size_t> next{ 0 };
  const auto team = std::min<std::size_t>(threads, MaximumNumberOfWorkers - 1);
  ParallelFor(0, team, 1, static_cast<unsigned>(team),
    [&](std::size_t number, std::size_t)
    {
      Worker worker(this->Triangulated, static_cast<WorkerId>(number + 1));
      for (std::size_t begin = next.fetch_add(PieceSize); begin < entries.size();
           begin = next.fetch_add(PieceSize))
      {
        ThrowIfStopped(this->Stop);
        this->InsertPiece(worker, entries.data() + begin,
          entries.data() + std::min(begin + PieceSize, entries.size()));
      }
    });
}

//------------------------------------------------------------------------------------------------
template <int D>
void SampleTriangulation<D>::InsertPiece(
  Worker& worker, const CurvePoint* begin, const CurvePoint* end)
{
  Triangulation<D>& mesh = this->Triangulated;
  std::vector<CurvePoint> left;
  SimplexId near = None;
  std::uint32_t generation = 0;
  for (const CurvePoint* entry = begin; entry != end; ++entry)
  {
    if (near == None || mesh.Lock(worker, near, generation) != LockOutcome::Locked)
    {
      mesh.Unlock(worker);
      near = this->LockNear(worker, *entry);
    }
    const SimplexId conflict =
      near == None ? None : this->WalkLocking(worker, entry->Position, near);
    near = None;
    if (conflict != None &&
      mesh.Insert(worker, entry->Position, VertexKind::Feature, conflict) ==
        InsertionOutcome::Inserted)
    {
      near = worker.Created[0];
      generation = mesh.State(near).CurrentGeneration();
    }
    else
    {
      left.push_back(*entry);
    }
    mesh.Unlock(worker);
  }
  const std::scoped_lock lock(this->Mutex);
  this->Left.insert(this->Left.end(), left.begin(), left.end());
}

//------------------------------------------------------------------------------------------------
// Locks a simplex at a vertex of the earlier rounds that is near on the curve. Returns None if
// another thread owns one of the simplex' vertices. While a thread owns a vertex, no other thread
// can delete the simplices at it.
template <int D>
SimplexId SampleTriangulation<D>::LockNear(Worker& worker, const CurvePoint& entry)
{
  const auto found = std::lower_bound(this->Before.begin(), this->Before.end(), entry.Key,
    [](const CurvePoint& e, std::uint64_t key) { return e.Key < key; });
  const VertexId v = (found == this->Before.end() ? this->Before.back() : *found).Vertex;
  if (!this->Triangulated.TryLock(worker, v))
  {
    return None;
  }
  const SimplexId s = this->Triangulated.GetVertex(v).Incident;
  for (const VertexId other : this->Triangulated.GetSimplex(s).V)
  {
    if (!this->Triangulated.TryLock(worker, other))
    {
      return None;
    }
  }
  return s;
}

//------------------------------------------------------------------------------------------------
// Like Triangulation::FindConflict. If rounding or another thread stops the walk, it returns None.
template <int D>
SimplexId SampleTriangulation<D>::WalkLocking(Worker& worker, const Point<D>& p, SimplexId from)
{
  Triangulation<D>& mesh = this->Triangulated;
  SimplexId s = from;
  const auto power = [&](SimplexId t)
  {
    const Circumball<D>& ball = mesh.GetSimplex(t).Ball;
    return Distance2(p, ball.Center) - ball.Radius2;
  };
  for (double smallest = power(s); !(smallest < 0.0);)
  {
    SimplexId next = None;
    for (const SimplexId n : mesh.GetSimplex(s).N)
    {
      if (n != None && power(n) < smallest)
      {
        smallest = power(n);
        next = n;
      }
    }
    if (next == None)
    {
      break;
    }
    for (const VertexId v : mesh.GetSimplex(next).V)
    {
      if (!mesh.TryLock(worker, v))
      {
        return None;
      }
    }
    s = next;
  }
  return mesh.InConflict(worker, s, p) ? s : None;
}

template class SampleTriangulation<3>;
template class SampleTriangulation<4>;

} // namespace voxplex
