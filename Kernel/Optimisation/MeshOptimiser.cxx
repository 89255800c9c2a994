// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Optimisation/MeshOptimiser.h"

#include "Base/Error.h"
#include "Optimisation/InterfaceRules.h"
#include "Optimisation/PatchWorker.h"
#include "Optimisation/Rooms.h"
#include "Optimisation/TetrahedralComplex.h"
#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <limits>
#include <mutex>
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

/** The largest number of attempts because of tetrahedra that should have stayed. */
constexpr unsigned MostAttempts = 8;

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
  {
    for (std::uint32_t t = 0; t < this->Mesh.Cells.size(); ++t)
    {
      if (this->Mesh.Scores[t] < 1.0f)
      {
        this->Poor.push_back(t);
      }
    }
    const auto cells = static_cast<std::uint32_t>(this->Mesh.Cells.size());
    // Edge removal needs additional slots for rings of six and more. Otherwise it mostly frees
    // slots.
    this->Mesh.AddCells(this->Poor.size() + 64 * MostBlocks);
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
      this->WorkInBlocks(blocks, this->BlocksByOrder(blocks));
      for (std::size_t axis = 0; axis < 3; ++axis)
      {
        this->WorkInBlocks(blocks, this->BlocksByCoordinate(blocks, axis));
      }
    }
    this->WorkOnAll();
  }

private:
  using Blocks = std::vector<std::uint32_t>;

  /** Blocks of consecutive vertices. They are compact if points are sorted along a curve. */
  Blocks BlocksByOrder(std::size_t number) const
  {
    Blocks blocks(this->Mesh.Points.size());
    for (std::size_t v = 0; v < blocks.size(); ++v)
    {
      blocks[v] = static_cast<std::uint32_t>(v * number / blocks.size());
    }
    return blocks;
  }

  /** Slabs with about as many vertices each. */
  Blocks BlocksByCoordinate(std::size_t number, std::size_t axis) const
  {
    constexpr std::size_t bins = 4096;
    const auto& points = this->Mesh.Points;
    double low = points[0][axis];
    double high = low;
    for (const Point<3>& p : points)
    {
      low = std::min(low, p[axis]);
      high = std::max(high, p[axis]);
    }
    const double scale = high > low ? static_cast<double>(bins - 1) / (high - low) : 0.0;
    const auto binOf = [&](std::size_t v)
    { return static_cast<std::size_t>((points[v][axis] - low) * scale); };
    std::vector<std::size_t> below(bins + 1, 0);
    for (std::size_t v = 0; v < points.size(); ++v)
    {
      ++below[binOf(v) + 1];
    }
    for (std::size_t bin = 0; bin < bins; ++bin)
    {
      below[bin + 1] += below[bin];
    }
    Blocks blocks(points.size());
    for (std::size_t v = 0; v < blocks.size(); ++v)
    {
      blocks[v] = static_cast<std::uint32_t>(below[binOf(v)] * number / blocks.size());
    }
    return blocks;
  }

  //----------------------------------------------------------------------------------------------
  void WorkInBlocks(std::size_t number, const Blocks& blocks)
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
    std::vector<std::uint32_t> clocks(number, this->LastClock);
    std::mutex mutex; // guards the statistics
    ParallelFor(
      0, number, 1, this->Threads,
      [&](std::size_t b, std::size_t)
      {
        PatchWorker worker(this->Mesh, blocks, static_cast<std::uint32_t>(b), this->Image,
          this->Rules, this->Options.InterfaceTolerance, this->Limits);
        worker.GetPatch().Clock = this->LastClock;
        worker.GetPatch().SetSlots(std::move(slots[b]));
        worker.WorkOn(poor[b]);
        for (unsigned pass = 0; pass < PassesOfBlock && worker.Pass(Effort::Plain) != 0; ++pass)
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
    std::erase_if(this->Poor,
      [this](std::uint32_t t) { return !this->Mesh.IsAlive(t) || this->Mesh.Scores[t] >= 1.0f; });
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
    const std::size_t points = this->Mesh.Points.size();
    const std::size_t spare = 8 * this->Poor.size();
    this->Mesh.AddVertices(spare);
    const Blocks blocks(points + spare, 0);
    PatchWorker worker(this->Mesh, blocks, 0, this->Image, this->Rules,
      this->Options.InterfaceTolerance, this->Limits);
    Patch& patch = worker.GetPatch();
    patch.Clock = this->LastClock;
    patch.SetSlots(std::move(this->Slots));
    patch.SetSpareVertices(
      static_cast<std::uint32_t>(points), static_cast<std::uint32_t>(points + spare));
    worker.WorkOn(this->Poor);
    for (const Effort effort : { Effort::Plain, Effort::Insertions, Effort::MovesOffInterfaces })
    {
      this->WorkWith(effort, worker);
    }
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

  /** Makes passes until nothing gets better. */
  void WorkWith(Effort effort, PatchWorker& worker)
  {
    if (effort == Effort::MovesOffInterfaces && !(this->Options.InterfaceTolerance > 0.0))
    {
      return;
    }
    worker.ForgetTries();
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
    Patch& patch = worker.GetPatch();
    const Rooms rooms = RoomsAround(this->Mesh, worker.Left(), EdgesOfRoom);
    const ShapeScore usual = this->Mesh.Shape;
    this->Mesh.Shape = ShapeScore(
      std::min(tighter * this->Options.SmallestDihedralAngle, LargestLowerBound),
      std::max(180.0 - tighter * (180.0 - this->Options.LargestDihedralAngle), SmallestUpperBound),
      this->Options.Shape.RadiusEdgeRatio);
    this->Poor = this->Rescore(rooms);
    this->LastClock = patch.Clock;
    this->Slots = patch.TakeSlots();
    this->WorkInBlocks(rooms.Number, rooms.OfVertex);
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
    worker.GetPatch().FindStars(vertices);
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

void Add(ShapeStatistics& survey, double smallest, double largest, double radiusEdge)
{
  constexpr double width = 180.0 / ShapeStatistics::NumberOfBins;
  const auto bin = [](double angle)
  { return std::min(static_cast<std::size_t>(angle / width), ShapeStatistics::NumberOfBins - 1); };
  survey.SmallestDihedralAngle = std::min(survey.SmallestDihedralAngle, smallest);
  survey.LargestDihedralAngle = std::max(survey.LargestDihedralAngle, largest);
  survey.LargestRadiusEdgeRatio = std::max(survey.LargestRadiusEdgeRatio, radiusEdge);
  ++survey.SmallestAngles[bin(smallest)];
  ++survey.LargestAngles[bin(largest)];
}

void Merge(ShapeStatistics& survey, const ShapeStatistics& part)
{
  survey.SmallestDihedralAngle = std::min(survey.SmallestDihedralAngle, part.SmallestDihedralAngle);
  survey.LargestDihedralAngle = std::max(survey.LargestDihedralAngle, part.LargestDihedralAngle);
  survey.LargestRadiusEdgeRatio =
    std::max(survey.LargestRadiusEdgeRatio, part.LargestRadiusEdgeRatio);
  survey.Poor += part.Poor;
  for (std::size_t bin = 0; bin < ShapeStatistics::NumberOfBins; ++bin)
  {
    survey.SmallestAngles[bin] += part.SmallestAngles[bin];
    survey.LargestAngles[bin] += part.LargestAngles[bin];
  }
}

} // namespace

//------------------------------------------------------------------------------------------------
ShapeStatistics MeasureShapes(const SimplexMesh<3>& mesh, const OptimisationOptions& options,
  unsigned threads, const std::stop_token& stop)
{
  CheckOptions(options);
  const ShapeScore score = ScoreOf(options);
  ShapeStatistics survey;
  std::mutex mutex;
  ParallelFor(
    0, mesh.Simplices.size(), SurveyGrain, threads,
    [&](std::size_t first, std::size_t last)
    {
      ShapeStatistics part;
      for (std::size_t t = first; t < last; ++t)
      {
        const auto& v = mesh.Simplices[t];
        ShapeExtremes shape;
        if (MeasureShape(
              mesh.Points[v[0]], mesh.Points[v[1]], mesh.Points[v[2]], mesh.Points[v[3]], shape))
        {
          part.Poor += static_cast<float>(score.Of(shape)) < 1.0f ? 1 : 0;
          Add(part, AngleOf(shape.LargestCosine), AngleOf(shape.SmallestCosine),
            1.0 / std::sqrt(shape.EdgeRadiusRatio2));
        }
        else
        {
          ++part.Poor;
          Add(part, 0.0, 180.0, std::numeric_limits<double>::infinity());
        }
      }
      const std::scoped_lock lock(mutex);
      Merge(survey, part);
    },
    stop);
  return survey;
}

//------------------------------------------------------------------------------------------------
OptimisationStatistics OptimiseMesh(SimplexMesh<3>& mesh, const Domain<3>& domain,
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
  statistics.Before = MeasureShapes(mesh, options, threads, stop);
  statistics.After = statistics.Before;
  if (statistics.Before.Poor != 0)
  {
    std::vector<std::uint32_t> kept;
    for (unsigned attempt = 0; attempt < MostAttempts; ++attempt)
    {
      SimplexMesh<3> result;
      {
        TetrahedralComplex complex(mesh, ScoreOf(options), threads, stop);
        complex.FindBorderFaces(domain);
        complex.Kept = kept;
        Optimisation(complex, domain, options, threads, limits, statistics).Run();
        ThrowIfStopped(stop);
        complex.Write(result);
      }
      const std::vector<std::uint32_t> more =
        options.ShouldHaveStayed ? options.ShouldHaveStayed(result) : std::vector<std::uint32_t>();
      if (more.empty())
      {
        statistics.After = MeasureShapes(result, options, threads, stop);
        mesh = std::move(result);
        break;
      }
      const std::size_t before = kept.size();
      kept.insert(kept.end(), more.begin(), more.end());
      std::sort(kept.begin(), kept.end());
      kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
      if (kept.size() == before)
      {
        break;
      }
    }
    statistics.OutOfTime = limits.OutOfTime();
  }
  statistics.Seconds = std::chrono::duration<double>(Clock::now() - start).count();
  return statistics;
}

} // namespace voxplex
