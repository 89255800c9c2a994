// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// The parts of an insertion with which waiting threads may help: conflict tests, level by level,
// and circumballs. The worker itself works in the order of Insertion.txx, and the result is the
// same. This is a separate translation unit: in a common one the compiler inlines less of the
// insertion without help, which then takes 4 % more instructions.
#include "Delaunay/Insertion.txx"

#include <algorithm>

namespace voxplex
{

//------------------------------------------------------------------------------------------------
// The simplices of a level joined the cavity when the previous level was expanded.
template <int D>
bool Triangulation<D>::ExpandWithHelp(Worker& worker, const Point<D>& p, unsigned planes)
{
  std::size_t last = 0;
  while (last < worker.Deleted.Size())
  {
    const std::size_t first = last;
    last = worker.Deleted.Size();
    if (!this->ExpandLevel(worker, p, planes, first, last))
    {
      return false;
    }
  }
  this->NumberLink(worker, p);
  return true;
}

//------------------------------------------------------------------------------------------------
// Does what the loop in CollectCavity() does for each simplex of the level, but does all conflict
// tests first. The worker takes the vertices that permit it to read the neighbours of the whole
// level. Then other threads help to test these neighbours. If the level is small, the worker tests
// them alone.
template <int D>
bool Triangulation<D>::ExpandLevel(
  Worker& worker, const Point<D>& p, unsigned planes, std::size_t first, std::size_t last)
{
  const std::size_t most = N * (last - first);
  worker.Deleted.ReserveMore(most);
  worker.Touched.ReserveMore(most);
  worker.Boundary.ReserveMore(most);
  worker.Joined.ReserveMore(most);
  worker.Owned.ReserveMore(last - first);
  worker.Candidates.Clear();
  worker.Candidates.ReserveMore(most);
  for (std::size_t k = std::max<std::size_t>(first, 1); k < last; ++k)
  {
    if (!this->TryOwn(worker, worker.Joined[k + N - 1]))
    {
      return false;
    }
  }
  // Until they are tested, all candidates are marked Outside. So their marks are restored if the
  // operation fails.
  const std::size_t touched = worker.Touched.Size();
  for (std::size_t k = first; k < last; ++k)
  {
    const SimplexId s = worker.Deleted[k];
    for (const SimplexId n : this->Simplices[s].N)
    {
      if (n != None && this->Marks[n] == SimplexMark::Alive)
      {
        assert(this->OwnsFacet(worker, n));
        this->Marks[n] = SimplexMark::Outside;
        worker.Touched.Push(n);
        worker.Candidates.Push({ n, s, 0, false });
      }
    }
  }
  this->TestCandidates(worker, p, last - first);
  worker.Touched.Resize(touched);
  for (const Candidate& candidate : worker.Candidates)
  {
    const SimplexId n = candidate.Id;
    if (!candidate.InConflict)
    {
      worker.Touched.Push(n);
      continue;
    }
    worker.Deleted.Push(n);
    this->Marks[n] = SimplexMark::Cavity;
    const Simplex& neighbour = this->Simplices[n];
    worker.Joined.Push(neighbour.V[candidate.Back]);
    this->Prefetch(n, neighbour, worker.Joined.Back());
  }
  for (std::size_t k = first; k < last; ++k)
  {
    const SimplexId s = worker.Deleted[k];
    const Simplex& simplex = this->Simplices[s];
    for (unsigned i = 0; i < N; ++i)
    {
      const SimplexId n = simplex.N[i];
      if (n != None ? this->Marks[n] == SimplexMark::Cavity
                    : planes != 0 && this->OnPlane(simplex.V, i, planes))
      {
        continue;
      }
      BoundaryFacet& facet = worker.Boundary.PushUninitialised();
      facet.V = simplex.V;
      facet.Apex = i;
      facet.Outer = n;
      facet.OuterIndex = n != None ? IndexOfNeighbour(this->Simplices[n], s) : 0;
    }
  }
  return true;
}

//------------------------------------------------------------------------------------------------
// A chunk runs in the helper's thread, with the helper's worker. This worker is free, since its
// thread waits.
template <int D>
void Triangulation<D>::TestCandidates(Worker& worker, const Point<D>& p, std::size_t level)
{
  const auto test = [&](Worker& tester, std::size_t first, std::size_t last)
  {
    for (std::size_t k = first; k < last; ++k)
    {
      Candidate& candidate = worker.Candidates[k];
      candidate.InConflict = this->InConflict(tester, candidate.Id, p);
      candidate.Back = IndexOfNeighbour(this->Simplices[candidate.Id], candidate.From);
    }
  };
  if (level < worker.Help.FewestSimplices)
  {
    test(worker, 0, worker.Candidates.Size());
    return;
  }
  const std::vector<Worker*>& team = *worker.Help.Team;
  worker.Help.Sharing->Run(worker.Help.Number, worker.Candidates.Size(), worker.Help.Grain,
    [&](unsigned thread, std::size_t first, std::size_t last)
    { test(*team[thread], first, last); });
}

//------------------------------------------------------------------------------------------------
// One thread must link the new simplices, which takes longer than computing their circumballs.
// Meanwhile the helpers begin with the circumballs. Nothing here throws.
template <int D>
void Triangulation<D>::FillWithHelp(Worker& worker, VertexId apex)
{
  const std::uint32_t count = static_cast<std::uint32_t>(worker.Boundary.Size());
  for (std::uint32_t k = 0; k < count; ++k)
  {
    const SimplexId s = this->NewSimplex(worker);
    worker.Created[k] = s;
    this->PlaceSimplex(worker, s, this->Simplices[s], worker.Boundary[k], apex);
  }
  this->Vertices[apex].Incident = worker.Created[0];
  const Point<D> p = this->Position(apex);
  worker.Help.Sharing->Run(
    worker.Help.Number, count, worker.Help.Grain,
    [&](unsigned, std::size_t first, std::size_t last)
    {
      for (std::size_t k = first; k < last; ++k)
      {
        this->SetBall(worker, this->Simplices[worker.Created[k]], worker.Boundary[k], p);
      }
    },
    [&]() { this->LinkRidges(worker); });
  worker.NumberOfCreated += count;
}

template bool Triangulation<3>::ExpandWithHelp(Worker&, const Point<3>&, unsigned);
template bool Triangulation<3>::ExpandLevel(
  Worker&, const Point<3>&, unsigned, std::size_t, std::size_t);
template void Triangulation<3>::TestCandidates(Worker&, const Point<3>&, std::size_t);
template void Triangulation<3>::FillWithHelp(Worker&, VertexId);
template bool Triangulation<4>::ExpandWithHelp(Worker&, const Point<4>&, unsigned);
template bool Triangulation<4>::ExpandLevel(
  Worker&, const Point<4>&, unsigned, std::size_t, std::size_t);
template void Triangulation<4>::TestCandidates(Worker&, const Point<4>&, std::size_t);
template void Triangulation<4>::FillWithHelp(Worker&, VertexId);

} // namespace voxplex
