// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Optimisation/Tetrahedra/MeshOptimiser.h"

#include "Base/Error.h"
#include "Optimisation/Complex.h"
#include "Optimisation/Tetrahedra/InterfaceRules.h"
#include "Optimisation/Tetrahedra/PatchWorker.h"
#include "Optimisation/Tetrahedra/Rooms.h"
#include "Optimisation/Tetrahedra/VertexBoxes.h"
#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <limits>
#include <mutex>
#include <numeric>
#include <span>
#include <string>
#include <vector>

namespace voxplex
{

namespace
{

using Clock = std::chrono::steady_clock;

constexpr std::size_t SurveyGrain = 16384;
/** Vertices of a block. In larger blocks, fewer tetrahedra lie between blocks. */
constexpr std::size_t VerticesOfBlock = 4000;
constexpr std::size_t MostBlocks = 256;
/** The most vertices that are inserted for one poor tetrahedron. */
constexpr std::size_t SparePerPoor = 8;
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

/**
 * Edge removal needs additional slots for rings of six and more. Otherwise it mostly frees slots.
 */
std::size_t SpareCells(std::uint64_t poor)
{
  return static_cast<std::size_t>(poor) + 64 * MostBlocks;
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
  {
    for (std::uint32_t t = 0; t < this->Mesh.Cells.size(); ++t)
    {
      if (this->Mesh.Scores[t] < 1.0f)
      {
        this->Poor.push_back(t);
      }
    }
    const auto cells = static_cast<std::uint32_t>(this->Mesh.Cells.size());
    this->Mesh.AddCells(SpareCells(this->Poor.size()));
    for (auto slot = static_cast<std::uint32_t>(this->Mesh.Cells.size()); slot-- > cells;)
    {
      this->Slots.push_back(slot);
    }
  }

  void Run()
  {
    const std::size_t blocks =
      std::clamp<std::size_t>(this->Mesh.Points.size() / VerticesOfBlock, 1, MostBlocks);
    if (blocks > 1)
    {
      this->WorkInOrder(blocks);
      const auto side = std::max<std::size_t>(
        2, static_cast<std::size_t>(std::lround(std::cbrt(static_cast<double>(blocks)))));
      this->WorkInBoxes(side, false, Effort::Plain);
      this->WorkInBoxes(side, true, Effort::Plain);
      this->WorkInBoxes(side, false, Effort::Insertions);
    }
    this->WorkOnAll();
  }

private:
  using Blocks = std::vector<std::uint32_t>; ///< of each vertex

  //----------------------------------------------------------------------------------------------
  /** Blocks of consecutive vertices. They are compact if points are sorted along a curve. */
  void WorkInOrder(std::size_t number)
  {
    Blocks blocks(this->Mesh.Points.size());
    for (std::size_t v = 0; v < blocks.size(); ++v)
    {
      blocks[v] = static_cast<std::uint32_t>(v * number / blocks.size());
    }
    this->WorkInBlocks(number, blocks, Effort::Plain);
  }

  /** @param perAxis, shift see DivideIntoBoxes() */
  void WorkInBoxes(std::size_t perAxis, bool shift, Effort effort)
  {
    VertexBoxes boxes =
      DivideIntoBoxes(this->Mesh.Points, perAxis, shift, this->Threads, this->Limits.Stop);
    this->WorkInBlocks(boxes.Number, boxes.OfVertex, effort);
  }

  /** @param blocks receives the blocks of the vertices that insertions may use */
  void WorkInBlocks(std::size_t number, Blocks& blocks, Effort effort)
  {
    std::vector<std::vector<std::uint32_t>> poor(number);
    std::vector<std::uint32_t> between;
    for (const std::uint32_t t : this->Poor)
    {
      const auto& v = this->Mesh.Cells[t].V;
      const std::uint32_t block = blocks[v[0]];
      const bool inside = blocks[v[1]] == block && blocks[v[2]] == block && blocks[v[3]] == block;
      (inside ? poor[block] : between).push_back(t);
    }
    std::vector<std::vector<std::uint32_t>> slots(number);
    for (std::size_t k = 0; k < this->Slots.size(); ++k)
    {
      slots[k * number / this->Slots.size()].push_back(this->Slots[k]);
    }
    std::vector<std::uint32_t> spareVertices; // the first of each block, and the end
    if (effort != Effort::Plain)
    {
      spareVertices = this->AddSpareVertices(poor, blocks);
    }
    std::vector<std::uint32_t> clocks(number, this->LastClock);
    // The block with most work is not the last to begin.
    std::vector<std::uint32_t> order(number);
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(),
      [&](std::uint32_t a, std::uint32_t b) { return poor[a].size() > poor[b].size(); });
    std::mutex mutex; // guards the statistics
    ParallelTasks(
      number, this->Threads,
      [&](std::size_t k)
      {
        const std::uint32_t b = order[k];
        if (poor[b].empty())
        {
          return;
        }
        PatchWorker worker(this->Mesh, blocks, b, this->Image, this->Rules,
          this->Options.InterfaceTolerance, this->Limits);
        worker.GetPatch().Clock = this->LastClock;
        worker.GetPatch().SetSlots(std::move(slots[b]));
        if (!spareVertices.empty())
        {
          worker.GetPatch().SetSpareVertices(spareVertices[b], spareVertices[b + 1]);
        }
        worker.WorkOn(poor[b]);
        for (unsigned pass = 0; pass < PassesOfBlock && worker.Pass(effort) != 0; ++pass)
        {
        }
        poor[b] = worker.Left();
        slots[b] = worker.GetPatch().TakeSlots();
        clocks[b] = worker.GetPatch().Clock;
        const std::scoped_lock lock(mutex);
        this->Count(worker);
      },
      this->Limits.Stop);
    ++this->Statistics.Passes;
    this->LastClock = *std::max_element(clocks.begin(), clocks.end()) + 1;
    this->Slots.clear();
    this->Poor = std::move(between);
    for (std::size_t b = 0; b < number; ++b)
    {
      this->Slots.insert(this->Slots.end(), slots[b].begin(), slots[b].end());
      this->Poor.insert(this->Poor.end(), poor[b].begin(), poor[b].end());
    }
    // A block may have improved a tetrahedron between blocks, or its slot may hold another one now.
    std::sort(this->Poor.begin(), this->Poor.end());
    this->Poor.erase(std::unique(this->Poor.begin(), this->Poor.end()), this->Poor.end());
    std::erase_if(this->Poor, [this](std::uint32_t t) { return !this->Mesh.IsPoor(t); });
  }

  /** Gives each block vertices for its poor tetrahedra. Returns the first of each, and the end. */
  std::vector<std::uint32_t> AddSpareVertices(
    const std::vector<std::vector<std::uint32_t>>& poor, Blocks& blocks)
  {
    std::vector<std::uint32_t> first{ static_cast<std::uint32_t>(blocks.size()) };
    for (std::uint32_t b = 0; b < poor.size(); ++b)
    {
      blocks.resize(blocks.size() + SparePerPoor * poor[b].size(), b);
      first.push_back(static_cast<std::uint32_t>(blocks.size()));
    }
    this->Mesh.AddVertices(blocks.size() - this->Mesh.Points.size());
    return first;
  }

  void Count(const PatchWorker& worker)
  {
    this->Statistics.Flips += worker.GetFlipStatistics();
    this->Statistics.Smoothing += worker.GetSmoothingStatistics();
  }

  //----------------------------------------------------------------------------------------------
  /**
   * One thread works on the whole mesh, with growing effort; then it makes room around the
   * remaining poor tetrahedra.
   */
  void WorkOnAll()
  {
    this->WorkWithoutInsertions();
    const std::size_t points = this->Mesh.Points.size();
    const std::size_t spare = SparePerPoor * this->Poor.size();
    this->Mesh.AddVertices(spare);
    PatchWorker worker(
      this->Mesh, {}, 0, this->Image, this->Rules, this->Options.InterfaceTolerance, this->Limits);
    Patch<3>& patch = worker.GetPatch();
    patch.Clock = this->LastClock;
    patch.SetSlots(std::move(this->Slots));
    patch.SetSpareVertices(
      static_cast<std::uint32_t>(points), static_cast<std::uint32_t>(points + spare));
    worker.WorkOn(this->Poor);
    this->WorkWith(Effort::Insertions, worker);
    this->WorkWith(Effort::MovesOffInterfaces, worker);
    for (unsigned round = 0; round < RoundsOfRoom; ++round)
    {
      if (worker.Left().empty() || this->Limits.OutOfTime())
      {
        break;
      }
      this->MakeRoom(worker, TighterBounds + TighterEachRound * round);
      this->WorkWith(Effort::Insertions, worker);
      this->WorkWith(Effort::MovesOffInterfaces, worker);
    }
    this->Count(worker);
  }

  /** Most of the poor tetrahedra go, so that few vertices need room afterwards. */
  void WorkWithoutInsertions()
  {
    PatchWorker worker(
      this->Mesh, {}, 0, this->Image, this->Rules, this->Options.InterfaceTolerance, this->Limits);
    worker.GetPatch().Clock = this->LastClock;
    worker.GetPatch().SetSlots(std::move(this->Slots));
    worker.WorkOn(this->Poor);
    this->WorkWith(Effort::Plain, worker);
    this->Poor = worker.Left();
    this->Slots = worker.GetPatch().TakeSlots();
    this->LastClock = worker.GetPatch().Clock;
    this->Count(worker);
  }

  /** Makes passes until nothing gets better. */
  void WorkWith(Effort effort, PatchWorker& worker)
  {
    if (effort == Effort::MovesOffInterfaces && !(this->Options.InterfaceTolerance > 0.0))
    {
      return;
    }
    worker.TryAllAgain();
    for (unsigned pass = 0; pass < MostPasses; ++pass)
    {
      if (effort != Effort::Plain)
      {
        this->FindStarsOf(worker);
      }
      ++this->Statistics.Passes;
      if (worker.Pass(effort) == 0 || this->Limits.OutOfTime())
      {
        break;
      }
    }
  }

  /**
   * Improves tetrahedra around poor ones beyond their bounds, so that the poor ones can change.
   * Each room is a block. Outside of rooms nothing changes: there, one tetrahedron beyond its
   * bounds would lead to the next, and so on without end.
   */
  void MakeRoom(PatchWorker& worker, double tighter)
  {
    Patch<3>& patch = worker.GetPatch();
    Rooms rooms = RoomsAround(this->Mesh, worker.Left(), EdgesOfRoom);
    const ShapeScore usual = this->Mesh.Shape;
    this->Mesh.Shape = ShapeScore(
      std::min(tighter * this->Options.SmallestDihedralAngle, LargestLowerBound),
      std::max(180.0 - tighter * (180.0 - this->Options.LargestDihedralAngle), SmallestUpperBound),
      this->Options.Shape.RadiusEdgeRatio);
    this->Poor = this->Rescore(rooms);
    this->LastClock = patch.Clock;
    this->Slots = patch.TakeSlots();
    this->WorkInBlocks(rooms.Number, rooms.OfVertex, Effort::Plain);
    patch.Clock = this->LastClock;
    patch.SetSlots(std::move(this->Slots));
    this->Mesh.Shape = usual;
    worker.WorkOn(this->Rescore(rooms));
  }

  /** Scores the tetrahedra in rooms again. Returns the poor ones. */
  std::vector<std::uint32_t> Rescore(const Rooms& rooms)
  {
    const auto isInRoom = [&](std::uint32_t t)
    { return this->Mesh.IsAlive(t) && rooms.Contain(this->Mesh.Cells[t].V); };
    ParallelFor(
      0, this->Mesh.Cells.size(), SurveyGrain, this->Threads,
      [&](std::size_t first, std::size_t last)
      {
        for (auto t = static_cast<std::uint32_t>(first); t < last; ++t)
        {
          if (isInRoom(t))
          {
            this->Mesh.Scores[t] = static_cast<float>(this->Mesh.Score(this->Mesh.Cells[t].V));
          }
        }
      },
      this->Limits.Stop);
    std::vector<std::uint32_t> poor;
    for (std::uint32_t t = 0; t < this->Mesh.Cells.size(); ++t)
    {
      if (this->Mesh.Scores[t] < 1.0f && isInRoom(t))
      {
        poor.push_back(t);
      }
    }
    return poor;
  }

  void FindStarsOf(PatchWorker& worker) const
  {
    std::vector<std::uint32_t> vertices;
    for (const std::uint32_t t : worker.Left())
    {
      const auto& v = this->Mesh.Cells[t].V;
      vertices.insert(vertices.end(), v.begin(), v.end());
    }
    worker.GetPatch().FindStars(vertices, this->Threads, this->Limits.Stop);
  }

  TetrahedralComplex& Mesh;
  const Domain<3>& Image;
  const OptimisationOptions& Options;
  const InterfaceRules Rules;
  const unsigned Threads;
  const OptimisationLimits& Limits;
  OptimisationStatistics& Statistics;
  std::vector<std::uint32_t> Poor;
  std::vector<std::uint32_t> Slots;
  std::uint32_t LastClock = 1;
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
