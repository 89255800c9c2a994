// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Optimisation/Pentatopes/PentatopeOptimiser.h"

#include "Optimisation/BlockSchedule.h"
#include "Optimisation/MoveLimits.h"
#include "Optimisation/PatchWorker.h"
#include "Optimisation/Pentatopes/PentatopeFlips.h"
#include "Optimisation/Pentatopes/PentatopeInsertion.h"
#include "Optimisation/Pentatopes/PentatopeSmoother.h"
#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <mutex>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace voxplex
{

namespace
{

/**
 * The first passes aim at this many times the target: elements that barely reach it soon fall below it
 * again.
 */
constexpr double FirstTarget = 2.0;

/** Passes that keep vertices on interfaces, and then passes that do not quite. */
constexpr unsigned StrictPasses = 2;
constexpr unsigned LoosePasses = 8;

/** Insertions, each followed by passes. */
constexpr unsigned InsertionRounds = 3;

/**
 * A round looks at this number of the worst pentatopes, and at one more for so many others, but at no more than that:
 * noise may leave tens of thousands, and each may take milliseconds.
 */
constexpr std::size_t FewestOfRound = 16;
constexpr std::size_t PentatopesPerPoor = 500;
constexpr std::size_t MostOfRound = 1000;

/**
 * A round stops after this many consecutive failed insertions, a block of it after its share of them: on rough images
 * hardly any helps, and each takes 40 ms.
 */
constexpr std::size_t MostFailures = 32;

/** Rounds that move what is around poor pentatopes, each followed by passes; and their target, in targets. */
constexpr unsigned RoomRounds = 8;
constexpr double RoomTarget = 4.0;

/** New pentatopes are to be better than the target by this factor. */
constexpr double KeptGain = 1.02;

/** Slots for the pentatopes that a flip, or an insertion, makes more. */
constexpr std::size_t SlotsOfFlip = 4;
constexpr std::size_t SlotsOfInsertion = 100;

/** What changes of pentatopes go by. All must outlive it. */
struct Context
{
  const PentatopeRules& Rules;
  const MoveLimits<4>& Limits;
  std::span<const Point<4>> Originals; ///< the points before any is moved
  /** Of each vertex, the clock when it was tried to be moved last; 0: never. */
  std::span<std::uint32_t> Tried;
  double Tolerance = 0.0; ///< how far vertices may leave interfaces
  /** Pentatopes for which vertices are to be inserted. If there are none, there are flips and moves. */
  std::size_t Round = 0;
};

//------------------------------------------------------------------------------------------------
/** @brief Changes pentatopes of one block, by flips or insertions (for PatchWorker), and by moves of vertices. */
class PentatopeImprover
{
public:
  /** @param pentatopes number of those to be improved */
  PentatopeImprover(Patch<4>& patch, const Context& context, std::size_t pentatopes = 0)
    : Target(patch)
    , Mesh(patch.Mesh())
    , By(context)
    , Smoother(patch, context.Rules, context.Limits, context.Originals)
    , Cavity(patch, context.Rules)
    , FailuresLeft(context.Round == 0 ? 0 : 1 + MostFailures * pentatopes / context.Round)
    , Failures(FailuresLeft)
  {
  }

  bool Improve(std::uint32_t s) { return this->By.Round != 0 ? this->Insert(s) : this->Flip(s); }

  /** Moves a vertex, or its twin and it, for the sake of the mean. */
  void RaiseSum(std::uint32_t v, double floor)
  {
    this->Done.Moves += this->Smoother.Start(v) && this->Smoother.RaiseSum(floor) ? 1 : 0;
  }

  /** The same for the sake of the worst. */
  void RaiseWorst(std::uint32_t v, double target)
  {
    this->Done.Moves +=
      this->Smoother.Start(v) && this->Smoother.RaiseWorst(target, this->By.Tolerance) ? 1 : 0;
  }

  /** Moves the vertices of poor pentatopes, once each. Returns how many have moved. */
  std::size_t MoveVertices(std::span<const std::uint32_t> pentatopes)
  {
    std::vector<std::uint32_t> vertices;
    for (const std::uint32_t s : pentatopes)
    {
      for (const std::uint32_t v : this->Mesh.Cells[s].V)
      {
        vertices.push_back(std::min(v, this->Mesh.TwinOf(v))); // None is the largest number
      }
    }
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    std::size_t moved = 0;
    for (const std::uint32_t v : vertices)
    {
      if (this->IsNew(v) && this->Smoother.Start(v))
      {
        this->By.Tried[v] = this->Target.Clock;
        moved += this->Smoother.RaiseWorst(this->Mesh.Goal, this->By.Tolerance) ? 1 : 0;
      }
    }
    this->Done.Moves += moved;
    return moved;
  }

  PentatopeStatistics Done; ///< counts of changes

private:
  bool Flip(std::uint32_t s)
  {
    const PentatopeFlip flip = FindFlip(this->Mesh, this->By.Rules, s);
    const std::span<const std::uint32_t> old(flip.Old.data(), flip.NumberOfOld);
    if (old.empty() ||
      !std::all_of(
        old.begin(), old.end(), [this](std::uint32_t t) { return this->Target.MayChange(t); }) ||
      !this->Replace(old, { flip.New.data(), flip.NumberOfNew }))
    {
      return false;
    }
    ++this->Done.Flips[flip.NumberOfOld - 2];
    return true;
  }

  /** Whether a vertex and its twin are in the block, and pentatopes around them have changed since they were tried. */
  bool IsNew(std::uint32_t v) const
  {
    const std::uint32_t twin = this->Mesh.TwinOf(v);
    if (!this->Target.Has(v) || (twin != None && !this->Target.Has(twin)))
    {
      return false;
    }
    const std::uint32_t tried = this->By.Tried[v];
    return tried == 0 || this->Mesh.Changes[v] > tried ||
      (twin != None && this->Mesh.Changes[twin] > tried);
  }

  bool Insert(std::uint32_t s)
  {
    const std::uint32_t v = this->Target.SpareVertex();
    if (this->FailuresLeft == 0 || v == None)
    {
      return false;
    }
    ++this->Done.InsertionsTried;
    --this->FailuresLeft;
    const PentatopeInsertion insertion = this->Cavity.Find(s, KeptGain * this->Mesh.Goal);
    if (!(insertion.After > insertion.Before))
    {
      return false;
    }
    this->Target.PlaceVertex(v, insertion.Place);
    if (!this->Replace(insertion.Old, insertion.New, v))
    {
      return false;
    }
    this->Target.KeepVertex();
    ++this->Done.Insertions;
    this->FailuresLeft = this->Failures;
    return true;
  }

  /**
   * Replaces pentatopes of one label by others.
   * @param added the vertex None of new ones
   * @return false, with nothing changed, if a component would be lost
   */
  bool Replace(std::span<const std::uint32_t> old,
    std::span<const PentatopeComplex::Vertices> vertices, std::uint32_t added = None)
  {
    this->Fresh.clear();
    for (const PentatopeComplex::Vertices& v : vertices)
    {
      this->Fresh.push_back({ v, this->Mesh.LabelOf(old.front()) });
      std::replace(this->Fresh.back().V.begin(), this->Fresh.back().V.end(), None, added);
    }
    return this->Target.Replace(old, this->Fresh);
  }

  Patch<4>& Target;
  const PentatopeComplex& Mesh;
  const Context& By;
  PentatopeSmoother Smoother;
  PentatopeCavity Cavity;
  std::vector<NewCell<4>> Fresh;
  std::size_t FailuresLeft;   ///< of insertions, before this block ends its round
  const std::size_t Failures; ///< after a success
};

//------------------------------------------------------------------------------------------------
/** The passes of an optimisation. */
class Optimiser
{
public:
  Optimiser(PentatopeComplex& complex, const PentatopeRules& rules, const MoveLimits<4>& limits,
    const PentatopeBounds& bounds, unsigned threads, const std::stop_token& stop)
    : Mesh(complex)
    , Originals(complex.Points)
    , Bounds(bounds)
    , Schedule(complex, threads, stop)
    , By{ rules, limits, this->Originals, {} }
  {
    this->Limits.Stop = stop;
  }

  PentatopeStatistics Run()
  {
    this->FindPoor(this->Bounds.Target);
    this->Done.PoorBefore = this->Poor.size();
    this->Done.SmallestBefore = this->Smallest();
    this->RaiseSums();
    this->RunPasses(FirstTarget * this->Bounds.Target, StrictPasses);
    this->By.Tolerance = this->Bounds.InterfaceTolerance;
    std::fill(this->Tried.begin(), this->Tried.end(), 0u);
    this->RunPasses(this->Bounds.Target, LoosePasses);
    for (unsigned round = 0; round < InsertionRounds && this->Insert(); ++round)
    {
      this->RunPasses(this->Bounds.Target, LoosePasses);
    }
    // Of many poor pentatopes most would stay.
    for (unsigned round = 0;
         round < RoomRounds && !this->Poor.empty() && this->Worst().size() == this->Poor.size();
         ++round)
    {
      this->MakeRoom();
      this->RunPasses(this->Bounds.Target, LoosePasses);
    }
    this->Done.PoorAfter = this->Poor.size();
    this->Done.SmallestAfter = this->Smallest();
    return this->Done;
  }

private:
  /** Moves each vertex once for the sake of the mean. A second time would gain little more. */
  void RaiseSums()
  {
    std::vector<double> reach(
      this->Mesh.Points.size(), 0.0); // of the object's vertices: of their stars
    for (std::uint32_t s = 0; s < this->Mesh.Cells.size() && this->Mesh.Labels[s] != 0; ++s)
    {
      for (const std::uint32_t v : this->Mesh.Cells[s].V)
      {
        for (const std::uint32_t w : this->Mesh.Cells[s].V)
        {
          reach[v] = std::max(reach[v], Distance(this->Mesh.Points[v], this->Mesh.Points[w]));
        }
      }
    }
    std::vector<std::uint32_t> vertices;
    for (std::uint32_t v = 0; v < reach.size(); ++v)
    {
      if (reach[v] > 0.0 && v < this->Mesh.TwinOf(v)) // None is the largest number
      {
        vertices.push_back(v);
      }
    }
    this->Schedule.RunInTiles(
      std::move(vertices),
      [&](std::uint32_t v)
      {
        return std::optional(
          TileItem<4>{ this->Mesh.Points[v], this->Schedule.ReachOf(v, reach[v]), v });
      },
      {},
      [this](Patch<4>& patch, std::span<const std::uint32_t> some)
      {
        PentatopeImprover improver(patch, this->By);
        for (const std::uint32_t v : some)
        {
          ThrowIfStopped(this->Limits.Stop);
          improver.RaiseSum(v, this->Bounds.Target);
        }
        this->Count(improver.Done, 0);
      });
  }

  /** Passes of flips and moves of the pentatopes below a target, until nothing helps any more. */
  void RunPasses(double target, unsigned most)
  {
    this->FindPoor(target);
    std::size_t better = 1;
    for (unsigned pass = 0; !this->Poor.empty() && better != 0 && pass < most; ++pass)
    {
      ++this->Done.Passes;
      better = this->Work(this->Poor, { SlotsOfFlip, 0 });
      this->FindPoor(target);
    }
  }

  /** Inserts vertices where pentatopes are still poor. Returns whether there was one. */
  bool Insert()
  {
    const std::uint64_t before = this->Done.Insertions;
    const std::span<const std::uint32_t> worst = this->Worst();
    this->By.Round = worst.size();
    this->Work({ worst.begin(), worst.end() }, { SlotsOfInsertion, 1 });
    this->By.Round = 0;
    this->FindPoor(this->Mesh.Goal);
    return this->Done.Insertions > before;
  }

  /** One pass over pentatopes, the worst of each block first. Returns the number of changes. */
  std::size_t Work(std::vector<std::uint32_t> pentatopes, BlockSchedule<4>::Spare spare)
  {
    this->Tried.resize(this->Mesh.Points.size() + spare.Vertices * pentatopes.size(), 0);
    this->By.Tried = this->Tried;
    const std::size_t before = this->Better;
    this->Schedule.RunInTiles(
      std::move(pentatopes),
      [this](std::uint32_t s)
      { return this->Mesh.IsPoor(s) ? std::optional(this->Schedule.ItemOf(s)) : std::nullopt; },
      spare,
      [this](Patch<4>& patch, std::span<const std::uint32_t> some)
      {
        std::vector<std::uint32_t> sorted(some.begin(), some.end());
        this->SortByScore(sorted);
        PentatopeImprover improver(patch, this->By, sorted.size());
        PatchWorker<4, PentatopeImprover> worker(patch, improver, this->Limits, sorted);
        std::size_t better = worker.Pass();
        better += this->By.Round != 0 ? 0 : improver.MoveVertices(worker.Left());
        this->Count(improver.Done, better);
      });
    return this->Better - before;
  }

  /** @param better changes of poor pentatopes */
  void Count(const PentatopeStatistics& some, std::size_t better)
  {
    const std::scoped_lock lock(this->Mutex);
    for (std::size_t k = 0; k < some.Flips.size(); ++k)
    {
      this->Done.Flips[k] += some.Flips[k];
    }
    this->Done.Moves += some.Moves;
    this->Done.Insertions += some.Insertions;
    this->Done.InsertionsTried += some.InsertionsTried;
    this->Better += better;
  }

  /** The pentatopes below a target, worst first. */
  void FindPoor(double target)
  {
    this->Mesh.Goal = target;
    this->Poor.clear();
    for (std::uint32_t s = 0; s < this->Mesh.Cells.size(); ++s)
    {
      if (this->Mesh.IsPoor(s))
      {
        this->Poor.push_back(s);
      }
    }
    this->SortByScore(this->Poor);
  }

  void SortByScore(std::vector<std::uint32_t>& pentatopes) const
  {
    std::stable_sort(pentatopes.begin(), pentatopes.end(),
      [this](std::uint32_t a, std::uint32_t b)
      { return this->Mesh.Scores[a] < this->Mesh.Scores[b]; });
  }

  /** Of the poor pentatopes those that a round looks at. */
  std::span<const std::uint32_t> Worst() const
  {
    const std::size_t most = FewestOfRound + this->Mesh.Cells.size() / PentatopesPerPoor;
    return std::span(this->Poor).first(std::min({ most, MostOfRound, this->Poor.size() }));
  }

  double Smallest() const
  {
    double smallest = 1.0;
    for (std::uint32_t s = 0; s < this->Mesh.Cells.size(); ++s)
    {
      if (this->Mesh.IsAlive(s) && this->Mesh.LabelOf(s) != 0)
      {
        smallest = std::min(smallest, this->Mesh.Scores[s]);
      }
    }
    return smallest;
  }

  /**
   * Moves the vertices around the worst pentatopes, so that these have room. What is around them may be good
   * already, and then no pass moves it.
   */
  void MakeRoom()
  {
    std::vector<std::uint32_t> vertices;
    VertexStar<4> star;
    for (const std::uint32_t s : this->Worst())
    {
      for (const std::uint32_t v : this->Mesh.Cells[s].V)
      {
        this->Mesh.GatherStar(v, star, [](std::uint32_t) { return true; });
        for (const PentatopeComplex::Vertices& corners : star.Corners)
        {
          for (const std::uint32_t other : corners)
          {
            vertices.push_back(std::min(other, this->Mesh.TwinOf(other)));
          }
        }
      }
    }
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    this->Schedule.RunInBlocks({}, { std::move(vertices) }, {},
      [this](Patch<4>& patch, std::span<const std::uint32_t> some)
      {
        PentatopeImprover improver(patch, this->By);
        for (const std::uint32_t v : some)
        {
          ThrowIfStopped(this->Limits.Stop);
          improver.RaiseWorst(v, RoomTarget * this->Bounds.Target);
        }
        this->Count(improver.Done, 0);
      });
  }

  PentatopeComplex& Mesh;
  const UninitialisedVector<Point<4>> Originals;
  const PentatopeBounds& Bounds;
  BlockSchedule<4> Schedule;
  Context By;
  OptimisationLimits Limits;
  std::vector<std::uint32_t> Poor;
  std::vector<std::uint32_t> Tried; ///< see Context
  std::mutex Mutex;                 ///< guards what follows while blocks are worked on
  PentatopeStatistics Done;
  std::size_t Better = 0; ///< changes of poor pentatopes
};

} // namespace

//------------------------------------------------------------------------------------------------
PentatopeStatistics OptimisePentatopes(PentatopeComplex& complex, const Domain<4>& surfaces,
  const LabelImage<4>& image, const PentatopeBounds& bounds, unsigned threads,
  const std::stop_token& stop)
{
  const MoveLimits<4> limits(image, surfaces, bounds.Planes);
  const PentatopeRules rules(surfaces, bounds);
  complex.Compact(true, threads, stop);
  complex.FindKinds(threads, stop);
  complex.ScoreCells(threads, stop);
  complex.Protect(bounds.Guard, threads, stop);
  return Optimiser(complex, rules, limits, bounds, threads, stop).Run();
}

} // namespace voxplex
