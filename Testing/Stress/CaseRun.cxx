// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "CaseRun.h"

#include "Base/Error.h"
#include "Checks.h"
#include "Mesher/ImageMesher.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <ctime>
#include <new>
#include <span>

namespace voxplex::stress
{

namespace
{

/** Processor time of all threads of this process. */
double ProcessorSeconds()
{
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double WallSeconds()
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/**
 * Wall-clock seconds per second of processor time: the machine may be busy, and threads may wait
 * for each other.
 */
constexpr double WallFactor = 8.0;

template <int D>
GridGeometry<D> GridOf(const Volume<D>& image)
{
  GridGeometry<D> grid;
  grid.Dimensions = image.Dimensions;
  grid.IndexToFrame = image.Axes;
  return grid;
}

/** The time limit of a run, in processor time and in wall-clock time. */
class Deadline
{
public:
  explicit Deadline(double seconds)
    : Processor(ProcessorSeconds() + seconds)
    , Wall(WallSeconds() + WallFactor * seconds)
  {
  }
  bool IsOver() const { return ProcessorSeconds() > this->Processor || WallSeconds() > this->Wall; }

private:
  double Processor;
  double Wall;
};

/** One call of ImageMesher. @throws the exceptions of ImageMesher */
template <int D>
MeshingOutcome MeshOnce(
  const StressCase<D>& of, double seconds, SimplexMesh<D>& mesh, MeshingStatistics& statistics)
{
  const Deadline deadline(seconds);
  const Volume<D>& image = of.Image;
  const GridGeometry<D> grid = GridOf(image);
  ImageMesher<D> mesher(of.AllOptions());
  mesher.Progress = [&](double) { return !deadline.IsOver(); };
  MeshingOutcome outcome = MeshingOutcome::Done;
  if (image.Surface)
  {
    Isosurface surface;
    surface.Value = image.Surface->Value;
    surface.Inside = image.Surface->InsideIsAbove ? IsosurfaceSide::Above : IsosurfaceSide::Below;
    surface.Label = image.Surface->Label;
    surface.SmoothingSigma = image.Surface->SmoothingSigma;
    const auto grey = IsosurfaceImage<D>::FromScalars(
      std::span<const float>(image.Grey), grid, surface, of.Options.Team.Threads);
    outcome = mesher.Run(grey, mesh);
  }
  else
  {
    const auto labels = LabelImage<D>::FromScalars(
      std::span<const std::int32_t>(image.Labels), grid, {}, of.Options.Team.Threads);
    outcome = mesher.Run(labels, mesh);
  }
  statistics = mesher.Statistics();
  return outcome;
}

template <typename T>
bool SameBytes(const T& a, const T& b)
{
  return a.size() == b.size() &&
    (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0);
}

template <int D>
bool SameMesh(const SimplexMesh<D>& a, const SimplexMesh<D>& b)
{
  return SameBytes(a.Points, b.Points) && SameBytes(a.Simplices, b.Simplices) &&
    SameBytes(a.Labels, b.Labels) && SameBytes(a.Facets, b.Facets) &&
    SameBytes(a.FacetLabels, b.FacetLabels) && a.Slabs == b.Slabs && a.Twins == b.Twins;
}

/** The second run of a case. If the number of threads must not matter, it has another one. */
template <int D>
StressCase<D> Second(const StressCase<D>& of)
{
  StressCase<D> second = of;
  if (of.Options.Team.Reproducible)
  {
    second.Options.Team.Threads = of.Options.Team.Threads % 4 + 1;
  }
  return second;
}

/** Meshes, and meshes again if the case says so. @return null if there is no mesh */
template <int D>
bool MakeMesh(const StressCase<D>& of, const RunLimits& limits, SimplexMesh<D>& mesh,
  MeshingStatistics& statistics, CaseResult& result, Findings& findings)
{
  const double limit = TimeLimit(of, limits);
  try
  {
    if (MeshOnce(of, limit, mesh, statistics) == MeshingOutcome::Cancelled)
    {
      findings.Add("endless",
        "cancelled after " + Text(limit) + " s; about " + Text(of.ExpectedElementsIfThin()) +
          " elements were expected; " + Text(double(statistics.Rules.Created)) +
          " simplices were created before the last round");
      return false;
    }
    SimplexMesh<D> again;
    MeshingStatistics ignored;
    if (of.Twice && MeshOnce(Second(of), limit, again, ignored) == MeshingOutcome::Done &&
      !SameMesh(mesh, again))
    {
      findings.Add("not-repeatable", "a second run made another mesh");
    }
    return true;
  }
  catch (const InputError& error)
  {
    result.Refusal = error.what();
  }
  catch (const TooLargeError& error)
  {
    result.Refusal = error.what();
  }
  catch (const std::bad_alloc&)
  {
    findings.Add("memory", "std::bad_alloc");
  }
  catch (const std::exception& error)
  {
    findings.Add("exception", error.what());
  }
  catch (...)
  {
    findings.Add("exception", "of an unknown type");
  }
  if (findings.IsEmpty() && result.Refusal.size() < 10)
  {
    findings.Add("message", "a refusal says nothing: " + result.Refusal);
  }
  return false;
}

} // namespace

//------------------------------------------------------------------------------------------------
bool CaseResult::Has(const std::string& cause) const
{
  return std::any_of(this->Failures.begin(), this->Failures.end(),
    [&](const Finding& f) { return f.Cause == cause; });
}

//------------------------------------------------------------------------------------------------
template <int D>
double TimeLimit(const StressCase<D>& of, const RunLimits& limits)
{
  // Ten to a hundred times the time that meshing takes.
  const double perElement = D == 3 ? 3e-4 : 1e-2;
  const double runs = of.Options.Sampling.Elements > 0 ? 12.0 : 1.0;
  return limits.Seconds > 0.0
    ? limits.Seconds
    : limits.TimeFactor * (3.0 + runs * perElement * of.ExpectedElementsIfThin());
}

//------------------------------------------------------------------------------------------------
template <int D>
CaseResult RunCase(const StressCase<D>& of, const RunLimits& limits)
{
  CaseResult result;
  result.Kind = of.Kind;
  Findings findings;
  SimplexMesh<D> mesh;
  MeshingStatistics statistics;
  const double start = ProcessorSeconds();
  const bool made = MakeMesh(of, limits, mesh, statistics, result, findings);
  result.Seconds = ProcessorSeconds() - start;
  const RuleStatistics& rules = statistics.Rules;
  result.Elements = mesh.Simplices.size();
  // Where an isosurface encloses nearly nothing, most of the triangulation's vertices bound no
  // element of the mesh.
  result.Vertices = std::max<std::uint64_t>(mesh.Points.size(), rules.Insertions() - rules.Removed);
  result.Created = rules.Created;
  result.Operations = rules.Insertions() + rules.Removed;
  if (made)
  {
    const double begin = ProcessorSeconds();
    const MeshFigures figures = CheckMesh<D>({ of, mesh, statistics }, findings);
    result.CheckSeconds = ProcessorSeconds() - begin;
    result.NonManifold = figures.NonManifold;
    result.Lost = figures.Lost;
  }
  // Lost components had vertices, too: small meshes count as this many. In 4D a vertex takes more.
  constexpr std::uint64_t fewest = D == 3 ? 100 : 300;
  const double most =
    limits.OperationsPerVertex * static_cast<double>(std::max(result.Vertices, fewest));
  if (made && most > 0.0 && static_cast<double>(result.Operations) > most)
  {
    findings.Add("work",
      Text(double(result.Operations)) + " operations for " + Text(double(result.Vertices)) +
        " vertices");
  }
  result.Failures.insert(result.Failures.end(), findings.All().begin(), findings.All().end());
  result.Status = !result.Failures.empty() ? CaseStatus::Failed
    : result.Refusal.empty()               ? CaseStatus::Passed
                                           : CaseStatus::Refused;
  return result;
}

template double TimeLimit<3>(const StressCase<3>&, const RunLimits&);
template double TimeLimit<4>(const StressCase<4>&, const RunLimits&);
template CaseResult RunCase<3>(const StressCase<3>&, const RunLimits&);
template CaseResult RunCase<4>(const StressCase<4>&, const RunLimits&);

} // namespace voxplex::stress
