// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Optimisation/Tetrahedra/MeshOptimiser.h"

#include "Base/Error.h"
#include "Optimisation/BlockSchedule.h"
#include "Optimisation/Complex.h"
#include "Optimisation/PatchWorker.h"
#include "Optimisation/Tetrahedra/InterfaceRules.h"
#include "Optimisation/Tetrahedra/Rooms.h"
#include "Optimisation/Tetrahedra/TetrahedronImprover.h"
#include "Parallel/ParallelCollect.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace voxplex
{

namespace
{

using Clock = std::chrono::steady_clock;

constexpr std::size_t SurveyGrain = 16384;
/** The most vertices that are inserted for one poor tetrahedron. */
constexpr std::size_t SparePerPoor = 8;
/** Slots for the tetrahedra that insertions make more. */
constexpr std::size_t SlotsPerPoor = 32;
/**
 * Passes over one block. A pass also works on tetrahedra that become poor in it, so more passes are
 * seldom needed.
 */
constexpr unsigned PassesOfBlock = 4;
/** The largest number of passes over the whole mesh with each effort. */
constexpr unsigned MostPasses = 12;
/** How many times room is made around the remaining poor tetrahedra, and within how many edges. */
constexpr unsigned RoundsOfRoom = 3;
constexpr unsigned EdgesOfRoom = 2;
/** The factor that tightens bounds of angles there, and its growth at each round. */
constexpr double TighterBounds = 1.2;
constexpr double TighterEachRound = 0.1;

/** The limits of ShapeScore. */
constexpr double LargestLowerBound = 59.0;
constexpr double SmallestUpperBound = 91.0;

void CheckOptions(const OptimisationOptions& options)
{
  const auto check = [](bool valid, const char* what)
  {
    if (!valid)
    {
      throw InputError(std::string("optimisation: ") + what);
    }
  };
  check(options.SmallestDihedralAngle > 0.0 && options.SmallestDihedralAngle < 60.0,
    "the smallest dihedral angle must be between 0 and 60 degrees");
  check(options.LargestDihedralAngle > 90.0 && options.LargestDihedralAngle < 180.0,
    "the largest dihedral angle must be between 90 and 180 degrees");
  check(options.Shape.RadiusEdgeRatio >= 1.0 && std::isfinite(options.Shape.RadiusEdgeRatio),
    "the radius-edge ratio must be at least 1");
  check(options.Shape.FacetAngle >= 0.0 && options.Shape.FacetAngle <= 60.0 &&
      options.Shape.JunctionFacetAngle >= 0.0 && options.Shape.JunctionFacetAngle <= 60.0,
    "facet angles must be between 0 and 60 degrees");
  check(options.CreaseAngle >= 0.0 && options.CreaseAngle <= 90.0,
    "the crease angle must be between 0 and 90 degrees");
  check(options.InterfaceTolerance >= 0.0 && std::isfinite(options.InterfaceTolerance),
    "the interface tolerance must be a length");
  check(options.Seconds >= 0.0, "the time limit must not be negative");
}

ShapeScore ScoreOf(const OptimisationOptions& options)
{
  return { options.SmallestDihedralAngle, options.LargestDihedralAngle,
    options.Shape.RadiusEdgeRatio };
}

//------------------------------------------------------------------------------------------------
/** The stages of one optimisation. */
class Optimisation
{
public:
  Optimisation(TetrahedralComplex& complex, const Domain<3>& domain,
    const OptimisationOptions& options, unsigned threads, const OptimisationLimits& limits,
    OptimisationStatistics& statistics)
    : Mesh(complex)
    , Image(domain)
    , Options(options)
    , Rules(options.Shape.FacetAngle, options.Shape.JunctionFacetAngle, options.CreaseAngle)
    , Threads(threads)
    , Limits(limits)
    , Statistics(statistics)
    , Schedule(complex, threads, limits.Stop)
  {
    for (std::uint32_t t = 0; t < this->Mesh.Cells.size(); ++t)
    {
      if (this->Mesh.Scores[t] < 1.0f)
      {
        this->Poor.push_back(t);
      }
    }
  }

  void Run()
  {
    // At first without insertions: most of the poor ones go, so that few vertices need room afterwards.
    this->WorkInTiles(Effort::Plain);
    this->WorkInTiles(Effort::Insertions);
    this->WorkOnAll(Effort::Insertions);
    this->WorkOnAll(Effort::MovesOffInterfaces);
    for (unsigned round = 0; round < RoundsOfRoom && !this->Poor.empty(); ++round)
    {
      this->MakeRoom(TighterBounds + TighterEachRound * round);
      this->WorkOnAll(Effort::Insertions);
      this->WorkOnAll(Effort::MovesOffInterfaces);
    }
  }

private:
  using Spare = BlockSchedule<3>::Spare;

  void WorkInTiles(Effort effort)
  {
    this->Schedule.RunInTiles(
      std::exchange(this->Poor, {}),
      [this](std::uint32_t t)
      { return this->Mesh.IsPoor(t) ? std::optional(this->Schedule.ItemOf(t)) : std::nullopt; },
      SpareFor(effort),
      [&](Patch<3>& patch, std::span<const std::uint32_t> cells)
      { this->WorkInBlock(patch, cells, effort); });
    this->SortPoor();
  }

  /** Edge removal needs additional slots for rings of six and more. Otherwise it mostly frees slots. */
  static Spare SpareFor(Effort effort)
  {
    return effort == Effort::Plain ? Spare{} : Spare{ SlotsPerPoor, SparePerPoor };
  }

  /** Works on poor tetrahedra of a block. Adds those that are left to Poor. */
  void WorkInBlock(Patch<3>& patch, std::span<const std::uint32_t> cells, Effort effort)
  {
    AnchorMap none;
    TetrahedronImprover improver(patch, this->Image, this->Rules, 0.0, none, effort);
    PatchWorker<3, TetrahedronImprover> worker(patch, improver, this->Limits, cells);
    for (unsigned pass = 0; pass < PassesOfBlock && worker.Pass() != 0; ++pass)
    {
    }
    const std::vector<std::uint32_t> left = worker.Left();
    const std::scoped_lock lock(this->Mutex);
    this->Poor.insert(this->Poor.end(), left.begin(), left.end());
    this->Count(improver);
    ++this->Statistics.Passes;
  }

  /** A block may have improved a tetrahedron between blocks, or its slot may hold another one now. */
  void SortPoor()
  {
    std::sort(this->Poor.begin(), this->Poor.end());
    this->Poor.erase(std::unique(this->Poor.begin(), this->Poor.end()), this->Poor.end());
    std::erase_if(this->Poor, [this](std::uint32_t t) { return !this->Mesh.IsPoor(t); });
  }

  void Count(const TetrahedronImprover& improver)
  {
    this->Statistics.Flips += improver.GetFlipStatistics();
    this->Statistics.Smoothing += improver.GetSmoothingStatistics();
  }

  //----------------------------------------------------------------------------------------------
  /** One thread works on what blocks have left, until nothing gets better. */
  void WorkOnAll(Effort effort)
  {
    const bool isOff =
      effort == Effort::MovesOffInterfaces && !(this->Options.InterfaceTolerance > 0.0);
    if (this->Poor.empty() || isOff || this->Limits.OutOfTime())
    {
      return;
    }
    this->Schedule.RunInBlocks({}, { this->Poor }, SpareFor(effort),
      [&](Patch<3>& patch, std::span<const std::uint32_t> cells)
      {
        TetrahedronImprover improver(
          patch, this->Image, this->Rules, this->Options.InterfaceTolerance, this->Anchors, effort);
        PatchWorker<3, TetrahedronImprover> worker(patch, improver, this->Limits, cells);
        std::size_t better = 1;
        for (unsigned pass = 0; pass < MostPasses && better != 0 && !this->Limits.OutOfTime();
             ++pass)
        {
          this->FindStars(patch, worker.Left());
          better = worker.Pass();
          ++this->Statistics.Passes;
        }
        this->Poor = worker.Left();
        this->Count(improver);
      });
  }

  void FindStars(Patch<3>& patch, const std::vector<std::uint32_t>& cells) const
  {
    std::vector<std::uint32_t> vertices;
    for (const std::uint32_t t : cells)
    {
      const auto& v = this->Mesh.Cells[t].V;
      vertices.insert(vertices.end(), v.begin(), v.end());
    }
    patch.FindStars(vertices, this->Threads, this->Limits.Stop);
  }

  /**
   * Improves tetrahedra around poor ones beyond their bounds, so that the poor ones can change.
   * Each room is a block. Outside of rooms nothing changes: there, one tetrahedron beyond its
   * bounds would lead to the next, and so on without end.
   */
  void MakeRoom(double tighter)
  {
    const Rooms rooms = RoomsAround(this->Mesh, this->Poor, EdgesOfRoom);
    const ShapeScore usual = this->Mesh.Shape;
    this->Mesh.Shape = ShapeScore(
      std::min(tighter * this->Options.SmallestDihedralAngle, LargestLowerBound),
      std::max(180.0 - tighter * (180.0 - this->Options.LargestDihedralAngle), SmallestUpperBound),
      this->Options.Shape.RadiusEdgeRatio);
    std::vector<std::vector<std::uint32_t>> poor(rooms.Number);
    for (const std::uint32_t t : this->Rescore(rooms))
    {
      poor[rooms.OfVertex[this->Mesh.Cells[t].V[0]]].push_back(t);
    }
    this->Schedule.RunInBlocks(rooms.OfVertex, poor, {},
      [this](Patch<3>& patch, std::span<const std::uint32_t> cells)
      { this->WorkInBlock(patch, cells, Effort::Plain); });
    this->Mesh.Shape = usual;
    this->Poor = this->Rescore(rooms);
  }

  /** Scores the tetrahedra in rooms again. Returns the poor ones. */
  std::vector<std::uint32_t> Rescore(const Rooms& rooms)
  {
    return ParallelCollect<std::uint32_t>(
      this->Mesh.Cells.size(), SurveyGrain, this->Threads,
      [&](std::size_t first, std::size_t last, std::vector<std::uint32_t>& poor)
      {
        for (auto t = static_cast<std::uint32_t>(first); t < last; ++t)
        {
          if (this->Mesh.IsAlive(t) && rooms.Contain(this->Mesh.Cells[t].V))
          {
            this->Mesh.Scores[t] = static_cast<float>(this->Mesh.Score(this->Mesh.Cells[t].V));
            if (this->Mesh.IsPoor(t))
            {
              poor.push_back(t);
            }
          }
        }
      },
      this->Limits.Stop);
  }

  TetrahedralComplex& Mesh;
  const Domain<3>& Image;
  const OptimisationOptions& Options;
  const InterfaceRules Rules;
  const unsigned Threads;
  const OptimisationLimits& Limits;
  OptimisationStatistics& Statistics;
  BlockSchedule<3> Schedule;
  std::vector<std::uint32_t> Poor;
  AnchorMap Anchors;
  std::mutex Mutex; ///< guards Poor and Statistics while blocks are worked on
};

//------------------------------------------------------------------------------------------------
/** The angle, from its cosine times the absolute value of the cosine. */
double AngleOf(double signedSquare)
{
  const double cosine = std::copysign(std::sqrt(std::abs(signedSquare)), signedSquare);
  return std::acos(std::clamp(cosine, -1.0, 1.0)) * DegreesPerRadian;
}

//------------------------------------------------------------------------------------------------
/** Collects the shapes of tetrahedra. */
class ShapeSurvey
{
public:
  void Add(const ShapeExtremes& shape, bool isPoor)
  {
    this->LargestCosine = std::max(this->LargestCosine, shape.LargestCosine);
    this->SmallestCosine = std::min(this->SmallestCosine, shape.SmallestCosine);
    this->EdgeRadiusRatio2 = std::min(this->EdgeRadiusRatio2, shape.EdgeRadiusRatio2);
    this->Poor += isPoor ? 1 : 0;
  }

  void AddTo(ShapeStatistics& all) const
  {
    all.SmallestDihedralAngle = std::min(all.SmallestDihedralAngle, AngleOf(this->LargestCosine));
    all.LargestDihedralAngle = std::max(all.LargestDihedralAngle, AngleOf(this->SmallestCosine));
    all.LargestRadiusEdgeRatio =
      std::max(all.LargestRadiusEdgeRatio, 1.0 / std::sqrt(this->EdgeRadiusRatio2));
    all.Poor += this->Poor;
  }

private:
  double LargestCosine = -1.0;
  double SmallestCosine = 1.0;
  double EdgeRadiusRatio2 = std::numeric_limits<double>::infinity();
  std::uint64_t Poor = 0;
};

/** Measures all tetrahedra, and scores them. */
ShapeStatistics MeasureAndScore(
  TetrahedralComplex& complex, unsigned threads, const std::stop_token& stop)
{
  ShapeStatistics all;
  std::mutex mutex;
  ParallelFor(
    0, complex.Cells.size(), SurveyGrain, threads,
    [&](std::size_t first, std::size_t last)
    {
      ShapeSurvey part;
      for (auto t = static_cast<std::uint32_t>(first); t < last; ++t)
      {
        if (!complex.IsAlive(t))
        {
          continue;
        }
        const auto p = complex.PointsOf(complex.Cells[t].V);
        ShapeExtremes shape;
        const bool isPositive = MeasureShape(*p[0], *p[1], *p[2], *p[3], shape);
        if (!isPositive)
        {
          shape = { 1.0, -1.0, 0.0 }; // 0 and 180 degrees
        }
        complex.Scores[t] =
          static_cast<float>(isPositive ? complex.Shape.Of(shape) : ShapeScore::Inverted);
        part.Add(shape, complex.Scores[t] < 1.0f);
      }
      const std::scoped_lock lock(mutex);
      part.AddTo(all);
    },
    stop);
  return all;
}

} // namespace

//------------------------------------------------------------------------------------------------
OptimisationStatistics OptimiseMesh(TetrahedralComplex& complex, const Domain<3>& domain,
  const OptimisationOptions& options, unsigned threads, const std::stop_token& stop)
{
  CheckOptions(options);
  const Clock::time_point start = Clock::now();
  OptimisationLimits limits;
  limits.Stop = stop;
  if (options.Seconds > 0.0 && options.Seconds < 1e9)
  {
    limits.Deadline = start +
      std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(options.Seconds));
  }

  OptimisationStatistics statistics;
  complex.Compact(false, threads, stop);
  complex.Shape = ScoreOf(options);
  statistics.Before = MeasureAndScore(complex, threads, stop);
  statistics.After = statistics.Before;
  if (statistics.Before.Poor != 0)
  {
    complex.FindKinds(threads, stop);
    complex.FindBorderFaces(domain);
    complex.Protect(options.Guard, threads, stop);
    Optimisation(complex, domain, options, threads, limits, statistics).Run();
    ThrowIfStopped(stop);
    statistics.After = MeasureAndScore(complex, threads, stop);
    statistics.OutOfTime = limits.OutOfTime();
  }
  statistics.Seconds = std::chrono::duration<double>(Clock::now() - start).count();
  return statistics;
}

} // namespace voxplex
