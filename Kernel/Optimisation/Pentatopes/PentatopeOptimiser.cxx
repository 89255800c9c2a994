// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Optimisation/Pentatopes/PentatopeOptimiser.h"

#include "Optimisation/MoveLimits.h"
#include "Optimisation/Patch.h"
#include "Optimisation/Pentatopes/PentatopeFlips.h"
#include "Optimisation/Pentatopes/PentatopeInsertion.h"
#include "Optimisation/Pentatopes/PentatopeSmoother.h"
#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <atomic>
#include <numeric>
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

/** Strict passes end when one leaves more than this part of the poor pentatopes. */
constexpr double WorthAnotherPass = 0.9;

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
 * A round stops after this many consecutive failed insertions: on rough images hardly any helps, and each
 * takes 40 ms.
 */
constexpr std::size_t MostFailures = 32;

/** Rounds that move what is around poor pentatopes, each followed by passes; and their target, in targets. */
constexpr unsigned RoomRounds = 8;
constexpr double RoomTarget = 4.0;

/** New pentatopes are to be better than the target by this factor. */
constexpr double KeptGain = 1.02;

/** Flips of a pass are made in rounds: a flip may make another one possible. */
constexpr unsigned MostRounds = 8;

constexpr std::size_t Grain = 64;
constexpr std::size_t MovesGrain = 4; // a move is long, and few may be made at the same time

/** Insertions that each of several threads finds before the first of them is made. */
constexpr std::size_t InsertionsAtOnce = 16;

/** Spreads numbers, so that the order of vertices says nothing about where they are. */
std::uint32_t Mix(std::uint32_t x)
{
  x ^= x >> 16;
  x *= 0x7feb352dU;
  x ^= x >> 15;
  x *= 0x846ca68bU;
  return x ^ (x >> 16);
}

/** The passes of an optimisation. */
class Optimiser
{
public:
  Optimiser(PentatopeComplex& complex, const PentatopeRules& rules, const MoveLimits<4>& limits,
    const PentatopeBounds& bounds, unsigned threads, const std::stop_token& stop)
    : Mesh(complex)
    , Target(complex, {}, 0)
    , Rules(rules)
    , Limits(limits)
    , Originals(complex.Points)
    , Bounds(bounds)
    , Threads(threads)
    , Stop(stop)
    , HasNews(complex.Points.size(), 1)
  {
  }

  PentatopeStatistics Run()
  {
    this->FindPoor(this->Bounds.Target);
    this->Done.PoorBefore = this->Poor.size();
    this->Done.SmallestBefore = this->Smallest();
    this->RaiseSums();
    this->RunPasses(FirstTarget * this->Bounds.Target, StrictPasses, WorthAnotherPass);
    this->Tolerance = this->Bounds.InterfaceTolerance;
    std::fill(this->HasNews.begin(), this->HasNews.end(), 1);
    this->RunPasses(this->Bounds.Target, LoosePasses, 1.0);
    for (unsigned round = 0; round < InsertionRounds && this->Insert(); ++round)
    {
      this->RunPasses(this->Bounds.Target, LoosePasses, 1.0);
    }
    // Of many poor pentatopes most would stay.
    for (unsigned round = 0;
         round < RoomRounds && !this->Poor.empty() && this->Worst().size() == this->Poor.size();
         ++round)
    {
      this->MakeRoom();
      this->RunPasses(this->Bounds.Target, LoosePasses, 1.0);
    }
    this->Done.PoorAfter = this->Poor.size();
    this->Done.SmallestAfter = this->Smallest();
    return this->Done;
  }

private:
  /** Moves each vertex once for the sake of the mean. A second time would gain little more. */
  void RaiseSums()
  {
    std::uint32_t end = 0; // of the object's vertices, which come first (Complex::Compact())
    for (std::uint32_t s = 0; s < this->Mesh.Cells.size() && this->Mesh.Labels[s] != 0; ++s)
    {
      const PentatopeComplex::Vertices& v = this->Mesh.Cells[s].V;
      end = std::max(end, *std::max_element(v.begin(), v.end()) + 1);
    }
    std::vector<std::uint32_t> vertices;
    for (std::uint32_t v = 0; v < end; ++v)
    {
      if (this->Leader(v) == v)
      {
        vertices.push_back(v);
      }
    }
    this->Smooth(std::move(vertices),
      [this](PentatopeSmoother& smoother, std::uint32_t v)
      { return smoother.RaiseSum(v, this->Bounds.Target); });
  }

  /**
   * Passes of flips and smoothing of the pentatopes below a target.
   * @param worthIt no further pass follows one that leaves more than this part of them
   */
  void RunPasses(double target, unsigned most, double worthIt)
  {
    this->FindPoor(target);
    for (unsigned pass = 0; !this->Poor.empty() && pass < most; ++pass)
    {
      ++this->Done.Passes;
      const auto before = static_cast<double>(this->Poor.size());
      this->Flip();
      this->FindPoor(target);
      this->Smooth(this->FindVerticesToMove(),
        [this](PentatopeSmoother& smoother, std::uint32_t v)
        { return smoother.RaiseWorst(v, this->Mesh.Goal, this->Tolerance); });
      this->FindPoor(target);
      if (static_cast<double>(this->Poor.size()) > worthIt * before)
      {
        return;
      }
    }
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
    std::stable_sort(this->Poor.begin(), this->Poor.end(),
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

  /** Makes flips, in rounds. Later rounds look at what earlier ones have changed. */
  void Flip()
  {
    std::vector<std::uint32_t> candidates = this->Poor;
    for (unsigned round = 0; round < MostRounds && !candidates.empty(); ++round)
    {
      std::vector<PentatopeFlip> flips(candidates.size());
      ParallelFor(
        0, flips.size(), Grain, this->Threads,
        [&](std::size_t first, std::size_t last)
        {
          for (std::size_t k = first; k < last; ++k)
          {
            flips[k] = FindFlip(this->Mesh, this->Rules, candidates[k]);
          }
        },
        this->Stop);
      std::erase_if(flips, [](const PentatopeFlip& flip) { return flip.NumberOfOld == 0; });
      if (flips.empty())
      {
        return;
      }
      candidates = this->MakeFlips(flips);
    }
  }

  /**
   * Makes the flips, except where an earlier one has changed a pentatope.
   * @return the poor pentatopes that have changed or are left
   */
  std::vector<std::uint32_t> MakeFlips(const std::vector<PentatopeFlip>& flips)
  {
    std::vector<std::uint8_t> hasChanged(this->Mesh.Cells.size(), 0);
    std::vector<std::uint32_t> next;
    for (const PentatopeFlip& flip : flips)
    {
      const std::span<const std::uint32_t> old(flip.Old.data(), flip.NumberOfOld);
      next.insert(next.end(), old.begin(), old.end());
      if (std::none_of(
            old.begin(), old.end(), [&](std::uint32_t s) { return hasChanged[s] != 0; }) &&
        this->Replace(old, { flip.New.data(), flip.NumberOfNew }))
      {
        for (const std::uint32_t s : old)
        {
          hasChanged[s] = 1;
        }
        next.insert(next.end(), this->Target.Poor.begin(), this->Target.Poor.end());
        ++this->Done.Flips[flip.NumberOfOld - 2];
      }
    }
    std::sort(next.begin(), next.end());
    next.erase(std::unique(next.begin(), next.end()), next.end());
    std::erase_if(next, [this](std::uint32_t s) { return !this->Mesh.IsPoor(s); });
    std::stable_sort(next.begin(), next.end(),
      [this](std::uint32_t a, std::uint32_t b)
      { return this->Mesh.Scores[a] < this->Mesh.Scores[b]; });
    return next;
  }

  /**
   * Replaces pentatopes of one label by others. Target.Poor receives the poor ones.
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
    this->Target.Poor.clear();
    this->Target.NeedSlots(vertices.size());
    if (!this->Target.Replace(old, this->Fresh))
    {
      return false;
    }
    for (const NewCell<4>& cell : this->Fresh)
    {
      this->TellVertices(cell.V);
    }
    return true;
  }

  /** Of a vertex and its twin the one that is listed. It moves both. */
  std::uint32_t Leader(std::uint32_t v) const
  {
    return std::min(v, this->Mesh.TwinOf(v)); // None is the largest number
  }

  /**
   * Moves vertices, once each. A vertex waits for its neighbours of lower rank. So the result is that
   * of one thread, which moves them in the order of their ranks.
   * @param improve moves a vertex by a smoother; returns whether it has moved
   */
  template <typename Function>
  void Smooth(std::vector<std::uint32_t> vertices, const Function& improve)
  {
    // In the order of points, each vertex would have to wait for the one before.
    std::sort(vertices.begin(), vertices.end(),
      [](std::uint32_t a, std::uint32_t b) { return std::pair(Mix(a), a) < std::pair(Mix(b), b); });
    std::vector<std::uint32_t> ranks(this->Mesh.Points.size(), None);
    const auto setRank = [this, &ranks](std::uint32_t v, std::uint32_t rank)
    {
      ranks[v] = rank;
      if (const std::uint32_t twin = this->Mesh.TwinOf(v); twin != None)
      {
        ranks[twin] = rank;
      }
    };
    for (std::size_t k = 0; k < vertices.size(); ++k)
    {
      setRank(vertices[k], static_cast<std::uint32_t>(k));
    }
    std::atomic<std::uint64_t> moves{ 0 };
    std::vector<std::uint32_t> waitsFor(ranks.size(), None); // one that comes before each vertex
    while (!vertices.empty())
    {
      if (NumberOfThreads(this->Threads) > 1)
      {
        ParallelFor(
          0, vertices.size(), Grain, this->Threads,
          [&](std::size_t begin, std::size_t end)
          {
            VertexStar<4> star;
            for (std::size_t k = begin; k < end; ++k)
            {
              std::uint32_t& earlier = waitsFor[vertices[k]];
              if (earlier == None || ranks[earlier] == None)
              {
                earlier = this->FindEarlier(vertices[k], ranks, star);
              }
            }
          },
          this->Stop);
      }
      std::vector<std::uint32_t> first;
      std::size_t left = 0;
      for (const std::uint32_t v : vertices)
      {
        if (waitsFor[v] == None)
        {
          first.push_back(v);
        }
        else
        {
          vertices[left++] = v;
        }
      }
      vertices.resize(left);
      ParallelFor(
        0, first.size(), MovesGrain, this->Threads,
        [&](std::size_t begin, std::size_t end)
        {
          PentatopeSmoother smoother(this->Mesh, this->Rules, this->Limits, this->Originals);
          for (std::size_t k = begin; k < end; ++k)
          {
            moves += this->Improve(smoother, first[k], improve) ? 1 : 0;
            setRank(first[k], None);
          }
        },
        this->Stop);
    }
    this->Done.Moves += moves;
  }

  /**
   * Inserts vertices where pentatopes are still poor. Returns whether there was one.
   *
   * Several insertions are found at the same time. One that has seen a pentatope that has changed since is found
   * again. So the result is that of one thread.
   */
  bool Insert()
  {
    const double target = KeptGain * this->Mesh.Goal;
    const std::span<const std::uint32_t> worst = this->Worst();
    const std::size_t threads = NumberOfThreads(this->Threads);
    const std::size_t atOnce = threads == 1 ? 1 : threads * InsertionsAtOnce;
    const std::uint64_t before = this->Done.Insertions;
    const auto spare = static_cast<std::uint32_t>(this->Mesh.Points.size());
    this->Mesh.AddVertices(worst.size());
    this->HasNews.resize(this->Mesh.Points.size(), 1);
    this->Target.SetSpareVertices(spare, static_cast<std::uint32_t>(this->Mesh.Points.size()));
    std::vector<PentatopeInsertion> insertions(std::min(atOnce, worst.size()));
    std::vector<std::uint8_t> hasChanged(this->Mesh.Cells.size(), 0);
    std::size_t failures = 0;
    for (std::size_t begin = 0; begin < worst.size() && failures < MostFailures; begin += atOnce)
    {
      const auto some = worst.subspan(begin, std::min(atOnce, worst.size() - begin));
      ParallelFor(
        0, some.size(), 1, this->Threads,
        [&](std::size_t first, std::size_t)
        { insertions[first] = this->FindInsertion(some[first], target); },
        this->Stop);
      std::vector<std::uint32_t> changed;
      for (std::size_t k = 0; k < some.size() && failures < MostFailures; ++k)
      {
        if (std::any_of(insertions[k].Seen.begin(), insertions[k].Seen.end(),
              [&](std::uint32_t s) { return hasChanged[s] != 0; }))
        {
          insertions[k] = this->FindInsertion(some[k], target);
        }
        ++this->Done.InsertionsTried;
        ++failures;
        if (this->Make(insertions[k]))
        {
          failures = 0;
          hasChanged.resize(this->Mesh.Cells.size(), 0);
          changed.insert(changed.end(), insertions[k].Old.begin(), insertions[k].Old.end());
          changed.insert(changed.end(), this->Target.Poor.begin(), this->Target.Poor.end());
          for (const std::uint32_t s : changed)
          {
            hasChanged[s] = 1;
          }
        }
      }
      for (const std::uint32_t s : changed)
      {
        hasChanged[s] = 0;
      }
    }
    if (this->Done.Insertions == before)
    {
      return false;
    }
    this->FindPoor(this->Mesh.Goal);
    return true;
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
            vertices.push_back(this->Leader(other));
          }
        }
      }
    }
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    const double target = RoomTarget * this->Bounds.Target;
    this->Smooth(std::move(vertices),
      [this, target](PentatopeSmoother& smoother, std::uint32_t v)
      { return smoother.RaiseWorst(v, target, this->Tolerance); });
  }

  /** The best insertion for a pentatope; none if it was part of an earlier cavity. */
  PentatopeInsertion FindInsertion(std::uint32_t s, double target) const
  {
    if (this->Mesh.IsPoor(s))
    {
      return PentatopeCavity(this->Mesh, this->Rules).Find(s, target);
    }
    PentatopeInsertion none;
    none.Seen = { s };
    return none;
  }

  /** Makes an insertion if it is worth it. Returns whether it was. */
  bool Make(const PentatopeInsertion& insertion)
  {
    const std::uint32_t v = this->Target.SpareVertex();
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
    return true;
  }

  /** A vertex beside v or its twin that has a lower rank; None if there is none. */
  std::uint32_t FindEarlier(
    std::uint32_t v, const std::vector<std::uint32_t>& ranks, VertexStar<4>& star) const
  {
    std::uint32_t earlier = None;
    const auto isFirstIn = [&](std::uint32_t s)
    {
      const PentatopeComplex::Vertices& corners = this->Mesh.Cells[s].V;
      const auto found = std::find_if(corners.begin(), corners.end(),
        [&](std::uint32_t other) { return ranks[other] < ranks[v]; });
      earlier = found == corners.end() ? None : *found;
      return earlier == None;
    };
    const std::uint32_t twin = this->Mesh.TwinOf(v);
    if (this->Mesh.GatherStar(v, star, isFirstIn) && twin != None)
    {
      this->Mesh.GatherStar(twin, star, isFirstIn);
    }
    return earlier;
  }

  std::vector<std::uint32_t> FindVerticesToMove() const
  {
    std::vector<std::uint32_t> vertices;
    for (const std::uint32_t s : this->Poor)
    {
      for (const std::uint32_t v : this->Mesh.Cells[s].V)
      {
        if (this->HasNews[this->Leader(v)] != 0)
        {
          vertices.push_back(this->Leader(v));
        }
      }
    }
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    return vertices;
  }

  template <typename Function>
  bool Improve(PentatopeSmoother& smoother, std::uint32_t v, const Function& improve)
  {
    std::atomic_ref<std::uint8_t>(this->HasNews[v]).store(0, std::memory_order_relaxed);
    if (!improve(smoother, v))
    {
      return false;
    }
    for (const MovedPentatope& one : smoother.Around())
    {
      this->TellVertices(this->Mesh.Cells[one.Id].V);
    }
    return true;
  }

  /** Pentatopes around these vertices have changed, so it is worth trying to move them again. */
  void TellVertices(const PentatopeComplex::Vertices& corners)
  {
    for (const std::uint32_t v : corners)
    {
      std::atomic_ref<std::uint8_t>(this->HasNews[this->Leader(v)])
        .store(1, std::memory_order_relaxed);
    }
  }

  PentatopeComplex& Mesh;
  Patch<4> Target; ///< all of the mesh
  const PentatopeRules& Rules;
  const MoveLimits<4>& Limits;
  const UninitialisedVector<Point<4>> Originals; ///< the points before any is moved
  const PentatopeBounds& Bounds;
  const unsigned Threads;
  const std::stop_token& Stop;
  std::vector<std::uint32_t> Poor;
  std::vector<NewCell<4>> Fresh;
  std::vector<std::uint8_t> HasNews; ///< of each vertex, since it was tried
  PentatopeStatistics Done;
  double Tolerance = 0.0; ///< how far vertices may leave interfaces
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
