// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Optimisation/PentatopeOptimiser.h"

#include "Optimisation/MoveLimits.h"
#include "Optimisation/PentatopeFlips.h"
#include "Optimisation/PentatopeInsertion.h"
#include "Optimisation/PentatopeSmoother.h"
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

/** The first target, in targets: what only just passes would be poor again soon. */
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
 * A round of insertions ends after so many in vain, one after the other: on rough images hardly any helps, and each takes
 * 40 ms.
 */
constexpr std::size_t MostInVain = 32;

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
  Optimiser(PentatopeComplex& complex, const MoveLimits<4>& limits, const SimplexMesh<4>& mesh,
    const PentatopeBounds& bounds, unsigned threads, const std::stop_token& stop)
    : Complex(complex)
    , Limits(limits)
    , Original(mesh)
    , Bounds(bounds)
    , Threads(threads)
    , Stop(stop)
    , HasNews(complex.NumberOfPoints(), 1)
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
    std::vector<std::uint32_t> vertices(this->Original.Points.size());
    std::iota(vertices.begin(), vertices.end(), 0);
    std::erase_if(vertices, [this](std::uint32_t v) { return this->Leader(v) != v; });
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
        { return smoother.RaiseWorst(v, this->Goal, this->Tolerance); });
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
    this->Goal = target;
    this->Poor.clear();
    for (std::size_t s = 0; s < this->Complex.NumberOfPentatopes(); ++s)
    {
      if (this->Complex.IsPoor(s, this->Goal))
      {
        this->Poor.push_back(static_cast<std::uint32_t>(s));
      }
    }
    std::stable_sort(this->Poor.begin(), this->Poor.end(),
      [this](std::uint32_t a, std::uint32_t b)
      { return this->Complex.QualityOf(a) < this->Complex.QualityOf(b); });
  }

  /** Of the poor pentatopes those that a round looks at. */
  std::span<const std::uint32_t> Worst() const
  {
    const std::size_t most = FewestOfRound + this->Complex.NumberOfPentatopes() / PentatopesPerPoor;
    return std::span(this->Poor).first(std::min({ most, MostOfRound, this->Poor.size() }));
  }

  double Smallest() const
  {
    double smallest = 1.0;
    for (std::size_t s = 0; s < this->Complex.NumberOfPentatopes(); ++s)
    {
      if (this->Complex.LabelOf(s) != 0 && this->Complex.IsAlive(s))
      {
        smallest = std::min(smallest, this->Complex.QualityOf(s));
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
            flips[k] = FindFlip(this->Complex, candidates[k]);
          }
        },
        this->Stop);
      std::erase_if(flips, [](const PentatopeFlip& flip) { return flip.NumberOfOld == 0; });
      if (flips.empty())
      {
        return;
      }
      candidates = this->MakeFlips(flips);
      this->Complex.UpdateStars(this->Threads, this->Stop);
    }
  }

  /**
   * Makes the flips, except where an earlier one has changed a pentatope.
   * @return the poor pentatopes that have changed or are left
   */
  std::vector<std::uint32_t> MakeFlips(const std::vector<PentatopeFlip>& flips)
  {
    std::vector<std::uint8_t> hasChanged(this->Complex.NumberOfPentatopes(), 0);
    std::vector<std::uint32_t> next;
    for (const PentatopeFlip& flip : flips)
    {
      const std::span<const std::uint32_t> old(flip.Old.data(), flip.NumberOfOld);
      next.insert(next.end(), old.begin(), old.end());
      const auto first = static_cast<std::uint32_t>(this->Complex.NumberOfPentatopes());
      if (std::none_of(
            old.begin(), old.end(), [&](std::uint32_t s) { return hasChanged[s] != 0; }) &&
        MakeFlip(this->Complex, flip))
      {
        for (const std::uint32_t s : old)
        {
          hasChanged[s] = 1;
        }
        for (std::uint32_t s = first; s < this->Complex.NumberOfPentatopes(); ++s)
        {
          next.push_back(s);
        }
        this->TellVertices(flip.New[0]);
        this->TellVertices(flip.New[1]); // the two have all six points
        ++this->Done.Flips[flip.NumberOfOld - 2];
      }
    }
    std::sort(next.begin(), next.end());
    next.erase(std::unique(next.begin(), next.end()), next.end());
    std::erase_if(next, [this](std::uint32_t s) { return !this->Complex.IsPoor(s, this->Goal); });
    std::stable_sort(next.begin(), next.end(),
      [this](std::uint32_t a, std::uint32_t b)
      { return this->Complex.QualityOf(a) < this->Complex.QualityOf(b); });
    return next;
  }

  /** Of a vertex and its twin the one that is listed. It moves both. */
  std::uint32_t Leader(std::uint32_t v) const
  {
    return std::min(v, this->Complex.TwinOf(v)); // None is the largest number
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
    std::vector<std::uint32_t> ranks(this->Complex.NumberOfPoints(), None);
    const auto setRank = [this, &ranks](std::uint32_t v, std::uint32_t rank)
    {
      ranks[v] = rank;
      if (const std::uint32_t twin = this->Complex.TwinOf(v); twin != None)
      {
        ranks[twin] = rank;
      }
    };
    for (std::size_t k = 0; k < vertices.size(); ++k)
    {
      setRank(vertices[k], static_cast<std::uint32_t>(k));
    }
    std::atomic<std::uint64_t> moves{ 0 };
    const auto forEach = [this](std::size_t number, std::size_t grain, const auto& function)
    {
      ParallelFor(
        0, number, grain, this->Threads,
        [&](std::size_t first, std::size_t last)
        {
          for (std::size_t k = first; k < last; ++k)
          {
            function(k);
          }
        },
        this->Stop);
    };
    while (!vertices.empty())
    {
      std::vector<std::uint8_t> isFirst(vertices.size(), 1);
      if (NumberOfThreads(this->Threads) > 1)
      {
        forEach(vertices.size(), Grain,
          [&](std::size_t k) { isFirst[k] = this->ComesFirst(vertices[k], ranks) ? 1 : 0; });
      }
      std::vector<std::uint32_t> first;
      std::size_t left = 0;
      for (std::size_t k = 0; k < vertices.size(); ++k)
      {
        if (isFirst[k] != 0)
        {
          first.push_back(vertices[k]);
        }
        else
        {
          vertices[left++] = vertices[k];
        }
      }
      vertices.resize(left);
      forEach(first.size(), MovesGrain,
        [&](std::size_t k)
        {
          moves += this->Improve(first[k], improve) ? 1 : 0;
          setRank(first[k], None);
        });
    }
    this->Done.Moves += moves;
  }

  /**
   * Inserts vertices where pentatopes are still poor. Returns whether there was one. Cavities do not
   * reach into new pentatopes, because stars are brought up to date at the end.
   *
   * Several insertions are found at the same time. One that has seen a pentatope that has changed since is found
   * again. So the result is that of one thread.
   */
  bool Insert()
  {
    const double target = KeptGain * this->Goal;
    const std::span<const std::uint32_t> worst = this->Worst();
    const std::size_t threads = NumberOfThreads(this->Threads);
    const std::size_t atOnce = threads == 1 ? 1 : threads * InsertionsAtOnce;
    const std::uint64_t before = this->Done.Insertions;
    std::vector<PentatopeInsertion> insertions(std::min(atOnce, worst.size()));
    std::vector<std::uint8_t> hasChanged(this->Complex.NumberOfPentatopes(), 0);
    std::size_t inVain = 0;
    for (std::size_t begin = 0; begin < worst.size() && inVain < MostInVain; begin += atOnce)
    {
      const auto some = worst.subspan(begin, std::min(atOnce, worst.size() - begin));
      ParallelFor(
        0, some.size(), 1, this->Threads,
        [&](std::size_t first, std::size_t)
        { insertions[first] = this->FindInsertion(some[first], target); },
        this->Stop);
      std::vector<std::uint32_t> changed;
      for (std::size_t k = 0; k < some.size() && inVain < MostInVain; ++k)
      {
        if (std::any_of(insertions[k].Seen.begin(), insertions[k].Seen.end(),
              [&](std::uint32_t s) { return hasChanged[s] != 0; }))
        {
          insertions[k] = this->FindInsertion(some[k], target);
        }
        ++this->Done.InsertionsTried;
        ++inVain;
        if (this->Make(insertions[k]))
        {
          inVain = 0;
          for (const std::uint32_t s : insertions[k].Old)
          {
            hasChanged[s] = 1;
            changed.push_back(s);
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
    this->Complex.UpdateStars(this->Threads, this->Stop);
    this->FindPoor(this->Goal);
    return true;
  }

  /**
   * Moves the vertices around the worst pentatopes, so that these have room. What is around them may be good
   * already, and then no pass moves it.
   */
  void MakeRoom()
  {
    std::vector<std::uint32_t> vertices;
    for (const std::uint32_t s : this->Worst())
    {
      for (const std::uint32_t v : this->Complex.CornersOf(s))
      {
        for (const std::uint32_t beside : this->Complex.StarOf(v))
        {
          for (const std::uint32_t other : this->Complex.CornersOf(beside))
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
    return this->Complex.IsPoor(s, this->Goal) ? PentatopeCavity(this->Complex).Find(s, target)
                                               : PentatopeInsertion();
  }

  /** Makes an insertion if it is worth it. Returns whether it was. */
  bool Make(const PentatopeInsertion& insertion)
  {
    if (!(insertion.After > insertion.Before))
    {
      return false;
    }
    for (const std::uint32_t old : insertion.Old) // while they have vertices
    {
      this->TellVertices(this->Complex.CornersOf(old));
    }
    if (MakeInsertion(this->Complex, insertion) == None)
    {
      return false;
    }
    ++this->Done.Insertions;
    this->HasNews.push_back(1);
    return true;
  }

  bool ComesFirst(std::uint32_t v, const std::vector<std::uint32_t>& ranks) const
  {
    const auto isFirstIn = [&](std::uint32_t s)
    {
      const PentatopeComplex::Vertices& corners = this->Complex.CornersOf(s);
      return std::all_of(corners.begin(), corners.end(),
        [&](std::uint32_t other) { return ranks[other] >= ranks[v]; });
    };
    const std::span<const std::uint32_t> star = this->Complex.StarOf(v);
    const std::uint32_t twin = this->Complex.TwinOf(v);
    const std::span<const std::uint32_t> other =
      twin == None ? std::span<const std::uint32_t>() : this->Complex.StarOf(twin);
    return std::all_of(star.begin(), star.end(), isFirstIn) &&
      std::all_of(other.begin(), other.end(), isFirstIn);
  }

  std::vector<std::uint32_t> FindVerticesToMove() const
  {
    std::vector<std::uint32_t> vertices;
    for (const std::uint32_t s : this->Poor)
    {
      for (const std::uint32_t v : this->Complex.CornersOf(s))
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
  bool Improve(std::uint32_t v, const Function& improve)
  {
    std::atomic_ref<std::uint8_t>(this->HasNews[v]).store(0, std::memory_order_relaxed);
    PentatopeSmoother smoother(this->Complex, this->Limits, this->Original.Points);
    if (!improve(smoother, v))
    {
      return false;
    }
    for (const std::uint32_t of : { v, this->Complex.TwinOf(v) })
    {
      for (const std::uint32_t s :
        of == None ? std::span<const std::uint32_t>() : this->Complex.StarOf(of))
      {
        this->TellVertices(this->Complex.CornersOf(s));
      }
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

  PentatopeComplex& Complex;
  const MoveLimits<4>& Limits;
  const SimplexMesh<4>& Original;
  const PentatopeBounds& Bounds;
  const unsigned Threads;
  const std::stop_token& Stop;
  std::vector<std::uint32_t> Poor;
  std::vector<std::uint8_t> HasNews; ///< of each vertex, since it was tried
  PentatopeStatistics Done;
  double Goal = 0.0;      ///< pentatopes below it are poor
  double Tolerance = 0.0; ///< how far vertices may leave interfaces
};

} // namespace

//------------------------------------------------------------------------------------------------
PentatopeStatistics OptimisePentatopes(SimplexMesh<4>& mesh, const Surroundings& outside,
  const Domain<4>& surfaces, const LabelImage<4>& image, const PentatopeBounds& bounds,
  unsigned threads, const std::stop_token& stop)
{
  const MoveLimits<4> limits(image, surfaces, bounds.Planes);
  PentatopeComplex complex(mesh, outside, image, surfaces, bounds, threads, stop);
  const PentatopeStatistics done = Optimiser(complex, limits, mesh, bounds, threads, stop).Run();
  complex.CopyTo(mesh);
  return done;
}

} // namespace voxplex
