// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Optimisation/PentatopeOptimiser.h"

#include "Optimisation/MoveLimits.h"
#include "Optimisation/PentatopeFlips.h"
#include "Optimisation/PentatopeSmoother.h"
#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <atomic>
#include <span>
#include <utility>
#include <vector>

namespace voxplex
{

namespace
{

/** Passes that keep vertices on interfaces, and then passes that do not quite. */
constexpr unsigned StrictPasses = 2;
constexpr unsigned LoosePasses = 5;

/** Passes end when one leaves more than this part of the poor pentatopes. */
constexpr double WorthAnotherPass = 0.9;

/** Flips of a pass are made in rounds: a flip may make another one possible. */
constexpr unsigned MostRounds = 8;

constexpr std::size_t Grain = 64;

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
  Optimiser(PentatopeComplex& complex, const MoveLimits& limits, const SimplexMesh<4>& mesh,
    const PentatopeBounds& bounds, unsigned threads, const std::stop_token& stop)
    : Target(complex)
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
    this->FindPoor();
    this->Done.PoorBefore = this->Poor.size();
    this->Done.SmallestBefore = this->Smallest();
    this->RunPasses(StrictPasses);
    this->Tolerance = this->Bounds.InterfaceTolerance;
    std::fill(this->HasNews.begin(), this->HasNews.end(), 1);
    this->RunPasses(LoosePasses);
    this->Done.PoorAfter = this->Poor.size();
    this->Done.SmallestAfter = this->Smallest();
    return this->Done;
  }

private:
  void RunPasses(unsigned most)
  {
    for (unsigned pass = 0; !this->Poor.empty() && pass < most; ++pass)
    {
      ++this->Done.Passes;
      const auto before = static_cast<double>(this->Poor.size());
      this->Flip();
      this->Smooth();
      this->FindPoor();
      if (static_cast<double>(this->Poor.size()) > WorthAnotherPass * before)
      {
        return;
      }
    }
  }

  /** The poor pentatopes, worst first. */
  void FindPoor()
  {
    this->Poor.clear();
    for (std::size_t s = 0; s < this->Target.NumberOfPentatopes(); ++s)
    {
      if (this->Target.IsPoor(s))
      {
        this->Poor.push_back(static_cast<std::uint32_t>(s));
      }
    }
    std::stable_sort(this->Poor.begin(), this->Poor.end(),
      [this](std::uint32_t a, std::uint32_t b)
      { return this->Target.QualityOf(a) < this->Target.QualityOf(b); });
  }

  double Smallest() const
  {
    double smallest = 1.0;
    for (std::size_t s = 0; s < this->Target.NumberOfPentatopes(); ++s)
    {
      if (this->Target.LabelOf(s) != 0 && this->Target.IsAlive(s))
      {
        smallest = std::min(smallest, this->Target.QualityOf(s));
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
            flips[k] = FindFlip(this->Target, candidates[k]);
          }
        },
        this->Stop);
      std::erase_if(flips, [](const PentatopeFlip& flip) { return flip.NumberOfOld == 0; });
      if (flips.empty())
      {
        return;
      }
      candidates = this->MakeFlips(flips);
      this->Target.FindStars();
    }
  }

  /**
   * Makes the flips, except where an earlier one has changed a pentatope.
   * @return the poor pentatopes that have changed or are left
   */
  std::vector<std::uint32_t> MakeFlips(const std::vector<PentatopeFlip>& flips)
  {
    std::vector<std::uint8_t> hasChanged(this->Target.NumberOfPentatopes(), 0);
    std::vector<std::uint32_t> next;
    for (const PentatopeFlip& flip : flips)
    {
      const std::span<const std::uint32_t> old(flip.Old.data(), flip.NumberOfOld);
      next.insert(next.end(), old.begin(), old.end());
      if (std::none_of(old.begin(), old.end(), [&](std::uint32_t s) { return hasChanged[s] != 0; }))
      {
        for (const std::uint32_t s : old)
        {
          hasChanged[s] = 1;
        }
        const auto first = static_cast<std::uint32_t>(this->Target.NumberOfPentatopes());
        MakeFlip(this->Target, flip);
        for (std::uint32_t s = first; s < this->Target.NumberOfPentatopes(); ++s)
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
    std::erase_if(next, [this](std::uint32_t s) { return !this->Target.IsPoor(s); });
    std::stable_sort(next.begin(), next.end(),
      [this](std::uint32_t a, std::uint32_t b)
      { return this->Target.QualityOf(a) < this->Target.QualityOf(b); });
    return next;
  }

  /**
   * Moves the vertices of poor pentatopes, once each. A vertex waits for its neighbours of lower rank.
   * So the result is that of one thread, which moves them in the order of their ranks.
   */
  void Smooth()
  {
    this->FindPoor();
    std::vector<std::uint32_t> vertices = this->FindVerticesToMove();
    std::vector<std::uint32_t> ranks(this->Target.NumberOfPoints(), None);
    for (std::size_t k = 0; k < vertices.size(); ++k)
    {
      ranks[vertices[k]] = static_cast<std::uint32_t>(k);
    }
    std::atomic<std::uint64_t> moves{ 0 };
    while (!vertices.empty())
    {
      std::vector<std::uint8_t> isFirst(vertices.size(), 1);
      const auto forVertices = [&](const auto& function)
      {
        ParallelFor(
          0, vertices.size(), Grain, this->Threads,
          [&](std::size_t first, std::size_t last)
          {
            for (std::size_t k = first; k < last; ++k)
            {
              function(k);
            }
          },
          this->Stop);
      };
      if (NumberOfThreads(this->Threads) > 1)
      {
        forVertices(
          [&](std::size_t k) { isFirst[k] = this->ComesFirst(vertices[k], ranks) ? 1 : 0; });
      }
      forVertices(
        [&](std::size_t k)
        {
          if (isFirst[k] != 0)
          {
            moves += this->Improve(vertices[k]) ? 1 : 0;
            ranks[vertices[k]] = None;
          }
        });
      std::size_t left = 0;
      for (std::size_t k = 0; k < vertices.size(); ++k)
      {
        vertices[left] = vertices[k];
        left += isFirst[k] == 0 ? 1 : 0;
      }
      vertices.resize(left);
    }
    this->Done.Moves += moves;
  }

  bool ComesFirst(std::uint32_t v, const std::vector<std::uint32_t>& ranks) const
  {
    const std::span<const std::uint32_t> star = this->Target.StarOf(v);
    return std::all_of(star.begin(), star.end(),
      [&](std::uint32_t s)
      {
        const PentatopeComplex::Vertices& corners = this->Target.CornersOf(s);
        return std::all_of(corners.begin(), corners.end(),
          [&](std::uint32_t other) { return ranks[other] >= ranks[v]; });
      });
  }

  std::vector<std::uint32_t> FindVerticesToMove() const
  {
    std::vector<std::uint32_t> vertices;
    for (const std::uint32_t s : this->Poor)
    {
      for (const std::uint32_t v : this->Target.CornersOf(s))
      {
        if (this->HasNews[v] != 0)
        {
          vertices.push_back(v);
        }
      }
    }
    // In the order of points, each vertex would have to wait for the one before.
    std::sort(vertices.begin(), vertices.end(),
      [](std::uint32_t a, std::uint32_t b) { return std::pair(Mix(a), a) < std::pair(Mix(b), b); });
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    return vertices;
  }

  bool Improve(std::uint32_t v)
  {
    std::atomic_ref<std::uint8_t>(this->HasNews[v]).store(0, std::memory_order_relaxed);
    PentatopeSmoother smoother(this->Target, this->Limits, this->Original.Points);
    if (!smoother.Improve(v, this->Bounds.Target, this->Tolerance))
    {
      return false;
    }
    for (const std::uint32_t s : this->Target.StarOf(v))
    {
      this->TellVertices(this->Target.CornersOf(s));
    }
    return true;
  }

  /** Pentatopes around these vertices have changed, so it is worth trying to move them again. */
  void TellVertices(const PentatopeComplex::Vertices& corners)
  {
    for (const std::uint32_t v : corners)
    {
      std::atomic_ref<std::uint8_t>(this->HasNews[v]).store(1, std::memory_order_relaxed);
    }
  }

  PentatopeComplex& Target;
  const MoveLimits& Limits;
  const SimplexMesh<4>& Original;
  const PentatopeBounds& Bounds;
  const unsigned Threads;
  const std::stop_token& Stop;
  std::vector<std::uint32_t> Poor;
  std::vector<std::uint8_t> HasNews; ///< of each vertex, since it was tried
  PentatopeStatistics Done;
  double Tolerance = 0.0; ///< how far vertices may leave interfaces
};

} // namespace

//------------------------------------------------------------------------------------------------
PentatopeStatistics OptimisePentatopes(SimplexMesh<4>& mesh, const Surroundings& outside,
  const Domain<4>& surfaces, const LabelImage<4>& image, const PentatopeBounds& bounds,
  unsigned threads, const std::stop_token& stop)
{
  const MoveLimits limits(image, surfaces);
  PentatopeComplex complex(mesh, outside, image, surfaces, bounds, threads, stop);
  const PentatopeStatistics done = Optimiser(complex, limits, mesh, bounds, threads, stop).Run();
  complex.CopyTo(mesh);
  return done;
}

} // namespace voxplex
