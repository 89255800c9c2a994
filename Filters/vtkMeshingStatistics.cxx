// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMeshingStatistics.h"

#include "Private/MeshingFigures.h"
#include "Private/QualityJson.h"

#include "vtkObjectFactory.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

using nlohmann::ordered_json;

vtkStandardNewMacro(vtkMeshingStatistics);

namespace
{

/** Null for labels. */
ordered_json IsosurfaceToJson(const IsosurfaceFigures& isosurface)
{
  if (!isosurface.Meshed)
  {
    return nullptr;
  }
  return {
    { "value", isosurface.Value },
    { "inside", isosurface.InsideIsAbove ? "above" : "below" },
    { "range", isosurface.Range },
  };
}

/** The search for a number of elements; null and empty if none was asked for. */
void AddRuns(ordered_json& json, const voxplex::MeshingStatistics& run)
{
  ordered_json& elements = json["elements_asked_for"];
  if (run.ElementsAskedFor > 0)
  {
    elements = run.ElementsAskedFor;
  }
  ordered_json& runs = json["runs"] = ordered_json::array();
  for (const voxplex::MeshingRun& one : run.Runs)
  {
    runs.push_back({ { "delta", one.Delta }, { "elements", one.Elements } });
  }
}

ordered_json YieldingToJson(const std::vector<voxplex::YieldingReport>& yielding)
{
  ordered_json regions = ordered_json::array();
  for (const voxplex::YieldingReport& region : yielding)
  {
    regions.push_back({ { "step", region.Step }, { "voxel", region.Voxel } });
  }
  return regions;
}

ordered_json RulesToJson(const voxplex::RuleStatistics& rules)
{
  ordered_json json;
  for (std::size_t i = 0; i < rules.Fired.size(); ++i)
  {
    json["R" + std::to_string(i + 1)] = rules.Fired[i];
  }
  json.update({
    { "R6", rules.Removed },
    { "R7_split", rules.SliversSplit },
    { "R7_sampled", rules.SliversSampled },
    { "size", rules.FiredBySize },
    { "projected", rules.Projected },
    { "refused_too_close", rules.RefusedTooClose },
    { "refused_no_conflict", rules.RefusedNoConflict },
    { "refused_duplicate", rules.RefusedDuplicate },
    { "removals_failed", rules.RemovalsFailed },
    { "closest_surface_point_calls", rules.ClosestSurfacePointCalls },
    { "evaluated", rules.Evaluated },
    { "created", rules.Created },
  });
  return json;
}

/** An empty report for an index out of range. */
voxplex::ComponentReport ReportAt(const std::vector<voxplex::ComponentReport>& reports, int index)
{
  return index >= 0 && index < std::ssize(reports) ? reports[static_cast<std::size_t>(index)]
                                                   : voxplex::ComponentReport{};
}

void CopyVoxel(const voxplex::ComponentReport& report, vtkTypeInt64 voxel[3])
{
  for (std::size_t a = 0; a < 3; ++a)
  {
    voxel[a] = a < report.Voxel.size() ? report.Voxel[a] : 0;
  }
}

ordered_json InterfacesToJson(const voxplex::InterfaceStatistics& figures)
{
  return {
    { "junction_curves", figures.JunctionCurves },
    { "junction_corners", figures.Corners },
    { "junction_points", figures.JunctionSeeds },
    { "rounds", figures.Rounds },
    { "points", figures.Seeds },
    { "nonmanifold_edges_repaired", figures.NonManifoldRepaired },
    { "nonmanifold_edges_opened", figures.NonManifoldOpened },
    { "nonmanifold_edges_left", figures.NonManifoldLeft },
  };
}

ordered_json OptimisationToJson(const voxplex::OptimisationSummary& figures)
{
  return {
    { "ran", figures.Ran },
    { "out_of_time", figures.OutOfTime },
    { "min_dihedral_before", figures.SmallestDihedralBefore },
    { "max_dihedral_before", figures.LargestDihedralBefore },
    { "poor_before", figures.PoorBefore },
    { "min_dihedral_after", figures.SmallestDihedralAfter },
    { "max_dihedral_after", figures.LargestDihedralAfter },
    { "poor_after", figures.PoorAfter },
  };
}

/** NaN without insertions. */
double MeanCavitySize(const voxplex::RuleStatistics& rules)
{
  return static_cast<double>(rules.CavitySimplices) / static_cast<double>(rules.Insertions());
}

void AddIfCounted(ordered_json& json, const char* key, const std::optional<std::uint64_t>& count)
{
  if (count)
  {
    json[key] = *count;
  }
}

ordered_json ThreadsToJson(const std::vector<voxplex::ThreadStatistics>& threads)
{
  ordered_json list = ordered_json::array();
  for (const auto& thread : threads)
  {
    ordered_json& json = list.emplace_back(ordered_json{
      { "insertions", thread.Insertions },
      { "removals", thread.Removals },
      { "rollbacks", thread.Rollbacks },
      { "waits", thread.Waits },
      { "contention_seconds", thread.ContentionSeconds },
      { "load_balance_seconds", thread.LoadBalanceSeconds },
      { "rollback_seconds", thread.RollbackSeconds },
      { "received", thread.Received },
      { "received_elements", thread.ReceivedElements },
      { "helped_loops", thread.HelpedLoops },
      { "helped_iterations", thread.HelpedIterations },
    });
    AddIfCounted(json, "tlb_misses", thread.Hardware.TlbMisses);
    AddIfCounted(json, "last_level_cache_misses", thread.Hardware.LastLevelCacheMisses);
    AddIfCounted(json, "resource_stall_cycles", thread.Hardware.ResourceStallCycles);
  }
  return list;
}

} // namespace

vtkMeshingStatistics::vtkMeshingStatistics()
  : Values(std::make_unique<Figures>())
{
}

vtkMeshingStatistics::~vtkMeshingStatistics() = default;

void vtkMeshingStatistics::Initialize()
{
  *this->Values = Figures();
  this->Modified();
}

vtkMeshingStatistics::Figures& vtkMeshingStatistics::Edit()
{
  this->Modified();
  return *this->Values;
}

// Getters whose figure has another name or type behind it.
#define VOXPLEX_FIGURE(type, getter, figure)                                                       \
  type vtkMeshingStatistics::Get##getter() const                                                   \
  {                                                                                                \
    return static_cast<type>(this->Values->figure);                                                \
  }

VOXPLEX_FIGURE(int, Dimension, Dimension)
VOXPLEX_FIGURE(vtkTypeInt64, NumberOfElements, Elements)
VOXPLEX_FIGURE(vtkTypeInt64, NumberOfVertices, Vertices)
VOXPLEX_FIGURE(vtkTypeInt64, NumberOfInterfaceFacets, InterfaceFacets)
VOXPLEX_FIGURE(double, Delta, Run.Delta)
VOXPLEX_FIGURE(double, LargestDelta, Run.LargestDelta)
VOXPLEX_FIGURE(vtkTypeInt64, GradingSamples, Run.GradingSamples)
VOXPLEX_FIGURE(vtkTypeInt64, GradingPoles, Run.GradingPoles)
VOXPLEX_FIGURE(vtkTypeInt64, ElementsAskedFor, Run.ElementsAskedFor)
VOXPLEX_FIGURE(int, NumberOfThreads, Threads)
VOXPLEX_FIGURE(vtkTypeInt64, EstimatedNumberOfElements, Run.EstimatedElements)
VOXPLEX_FIGURE(bool, MeshedIsosurface, Isosurface.Meshed)
VOXPLEX_FIGURE(double, Isovalue, Isosurface.Value)
VOXPLEX_FIGURE(int, NumberOfLostLabels, LostLabels.size())
VOXPLEX_FIGURE(vtkTypeInt64, NumberOfComponents, Run.Components.Found)
VOXPLEX_FIGURE(int, NumberOfLostComponents, Run.Components.Lost.size())
VOXPLEX_FIGURE(int, NumberOfDroppedComponents, DroppedComponents.size())
VOXPLEX_FIGURE(bool, HasQuality, HasQuality)
VOXPLEX_FIGURE(int, NumberOfLabels, Quality.Labels.size())
VOXPLEX_FIGURE(double, ShortestEdge, Quality.ShortestEdge)
VOXPLEX_FIGURE(double, MaximumRadiusEdgeRatio, Quality.MaximumRadiusEdgeRatio)
VOXPLEX_FIGURE(double, MeanRadiusEdgeRatio, Quality.MeanRadiusEdgeRatio)
VOXPLEX_FIGURE(double, RadiusEdgeRatioDeviation, Quality.RadiusEdgeRatioDeviation)
VOXPLEX_FIGURE(double, MinimumDihedralAngle, Quality.MinimumDihedralAngle)
VOXPLEX_FIGURE(double, MaximumDihedralAngle, Quality.MaximumDihedralAngle)
VOXPLEX_FIGURE(double, MinimumPlanarAngle, Quality.MinimumFacetAngle)
VOXPLEX_FIGURE(vtkTypeInt64, RadiusEdgeViolations, Quality.RadiusEdgeViolations)
VOXPLEX_FIGURE(vtkTypeInt64, FacetAngleViolations, Quality.FacetAngleViolations)
VOXPLEX_FIGURE(
  vtkTypeInt64, FacetAngleViolationsAtJunctions, Quality.FacetAngleViolationsAtJunctions)
VOXPLEX_FIGURE(vtkTypeInt64, InvertedElements, Quality.InvertedSimplices)
VOXPLEX_FIGURE(double, MinimumNormalizedVolume, Quality.MinimumNormalizedVolume)
VOXPLEX_FIGURE(double, MeanNormalizedVolume, Quality.MeanNormalizedVolume)
VOXPLEX_FIGURE(double, NormalizedVolumeDeviation, Quality.NormalizedVolumeDeviation)
VOXPLEX_FIGURE(int, NumberOfNormalizedVolumeBins, Quality.NormalizedVolumes.size())
VOXPLEX_FIGURE(vtkTypeInt64, LargestCavity, Run.Rules.LargestCavity)
VOXPLEX_FIGURE(vtkTypeInt64, SliversFound, Run.Rules.SliversFound)
VOXPLEX_FIGURE(vtkTypeInt64, PicksTried, Run.Rules.PicksTried)
VOXPLEX_FIGURE(vtkTypeInt64, SliversKept, Run.Rules.SliversKept)
VOXPLEX_FIGURE(vtkTypeInt64, FiredBySize, Run.Rules.FiredBySize)
VOXPLEX_FIGURE(vtkTypeInt64, SliversSplit, Run.Rules.SliversSplit)
VOXPLEX_FIGURE(vtkTypeInt64, SliversSampled, Run.Rules.SliversSampled)
VOXPLEX_FIGURE(vtkTypeInt64, PointsProjected, Run.Rules.Projected)
VOXPLEX_FIGURE(vtkTypeInt64, VerticesRemoved, Run.Rules.Removed)
VOXPLEX_FIGURE(vtkTypeInt64, RefusedTooClose, Run.Rules.RefusedTooClose)
VOXPLEX_FIGURE(vtkTypeInt64, RefusedNoConflict, Run.Rules.RefusedNoConflict)
VOXPLEX_FIGURE(vtkTypeInt64, RefusedDuplicate, Run.Rules.RefusedDuplicate)
VOXPLEX_FIGURE(vtkTypeInt64, RemovalsFailed, Run.Rules.RemovalsFailed)
VOXPLEX_FIGURE(vtkTypeInt64, ElementsEvaluated, Run.Rules.Evaluated)
VOXPLEX_FIGURE(vtkTypeInt64, ElementsCreated, Run.Rules.Created)
VOXPLEX_FIGURE(vtkTypeInt64, ClosestSurfacePointCalls, Run.Rules.ClosestSurfacePointCalls)
VOXPLEX_FIGURE(vtkTypeInt64, PredicateCalls, Run.Predicates.Calls)
VOXPLEX_FIGURE(vtkTypeInt64, PredicateFilterFailures, Run.Predicates.StaticFailures)
VOXPLEX_FIGURE(vtkTypeInt64, PredicateExactCalls, Run.Predicates.ExactCalls)
VOXPLEX_FIGURE(vtkTypeInt64, PredicatePerturbedCalls, Run.Predicates.Perturbed)
VOXPLEX_FIGURE(double, LabelFieldTime, Run.Times.LabelField)
VOXPLEX_FIGURE(double, DistanceTransformTime, Run.Times.DistanceTransform)
VOXPLEX_FIGURE(double, GradingTime, Run.Times.Grading)
VOXPLEX_FIGURE(double, ComponentsTime, Run.Times.Components)
VOXPLEX_FIGURE(double, InterfacesTime, Run.Times.Interfaces)
VOXPLEX_FIGURE(vtkTypeInt64, NumberOfJunctionCurves, Run.Interfaces.JunctionCurves)
VOXPLEX_FIGURE(vtkTypeInt64, NumberOfJunctionCorners, Run.Interfaces.Corners)
VOXPLEX_FIGURE(vtkTypeInt64, NumberOfJunctionPoints, Run.Interfaces.JunctionSeeds)
VOXPLEX_FIGURE(int, InterfaceRounds, Run.Interfaces.Rounds)
VOXPLEX_FIGURE(vtkTypeInt64, NonManifoldEdgesRepaired, Run.Interfaces.NonManifoldRepaired)
VOXPLEX_FIGURE(vtkTypeInt64, NonManifoldEdgesOpened, Run.Interfaces.NonManifoldOpened)
VOXPLEX_FIGURE(vtkTypeInt64, NonManifoldEdgesLeft, Run.Interfaces.NonManifoldLeft)
VOXPLEX_FIGURE(double, RefinementTime, Run.Times.Refinement)
VOXPLEX_FIGURE(double, ExtractionTime, Run.Times.Extraction)
VOXPLEX_FIGURE(double, OptimisationTime, Run.Times.Optimisation)
VOXPLEX_FIGURE(bool, Optimised, Run.Optimisation.Ran)
VOXPLEX_FIGURE(double, MinimumDihedralAngleBefore, Run.Optimisation.SmallestDihedralBefore)
VOXPLEX_FIGURE(double, MaximumDihedralAngleBefore, Run.Optimisation.LargestDihedralBefore)
VOXPLEX_FIGURE(double, MinimumDihedralAngleAfter, Run.Optimisation.SmallestDihedralAfter)
VOXPLEX_FIGURE(double, MaximumDihedralAngleAfter, Run.Optimisation.LargestDihedralAfter)
VOXPLEX_FIGURE(vtkTypeInt64, PoorElementsBefore, Run.Optimisation.PoorBefore)
VOXPLEX_FIGURE(vtkTypeInt64, PoorElementsAfter, Run.Optimisation.PoorAfter)
VOXPLEX_FIGURE(double, TotalTime, Run.Times.Total())
VOXPLEX_FIGURE(double, SeedingTime, Run.SeedingSeconds)
VOXPLEX_FIGURE(bool, SwitchedToLocal, Run.SwitchedToLocal)
VOXPLEX_FIGURE(int, NumberOfRefinementThreads, Run.Threads.size())
#undef VOXPLEX_FIGURE

// Figures of one refinement thread.
#define VOXPLEX_THREAD_FIGURE(type, getter, figure)                                                \
  type vtkMeshingStatistics::GetThread##getter(int thread) const                                   \
  {                                                                                                \
    return thread >= 0 && thread < this->GetNumberOfRefinementThreads()                            \
      ? static_cast<type>(this->Values->Run.Threads[static_cast<std::size_t>(thread)].figure)      \
      : type{};                                                                                    \
  }

// Figures of one refinement thread, and their sum over all.
#define VOXPLEX_SUMMED_FIGURE(type, getter, figure)                                                \
  VOXPLEX_THREAD_FIGURE(type, getter, figure)                                                      \
  type vtkMeshingStatistics::Get##getter() const                                                   \
  {                                                                                                \
    type sum{};                                                                                    \
    for (const auto& thread : this->Values->Run.Threads)                                           \
    {                                                                                              \
      sum += static_cast<type>(thread.figure);                                                     \
    }                                                                                              \
    return sum;                                                                                    \
  }

VOXPLEX_THREAD_FIGURE(vtkTypeInt64, Insertions, Insertions)
VOXPLEX_THREAD_FIGURE(vtkTypeInt64, Removals, Removals)
VOXPLEX_SUMMED_FIGURE(vtkTypeInt64, Rollbacks, Rollbacks)
VOXPLEX_SUMMED_FIGURE(vtkTypeInt64, Waits, Waits)
VOXPLEX_SUMMED_FIGURE(double, ContentionTime, ContentionSeconds)
VOXPLEX_SUMMED_FIGURE(double, LoadBalanceTime, LoadBalanceSeconds)
VOXPLEX_SUMMED_FIGURE(double, RollbackTime, RollbackSeconds)
VOXPLEX_SUMMED_FIGURE(vtkTypeInt64, ReceivedElements, ReceivedElements)
#undef VOXPLEX_SUMMED_FIGURE
#undef VOXPLEX_THREAD_FIGURE

vtkTypeInt64 vtkMeshingStatistics::GetThreadReceived(int thread, int level) const
{
  return thread >= 0 && thread < this->GetNumberOfRefinementThreads() && level >= 0 &&
      level < static_cast<int>(voxplex::StealingLevels)
    ? static_cast<vtkTypeInt64>(this->Values->Run.Threads[static_cast<std::size_t>(thread)]
                                  .Received[static_cast<std::size_t>(level)])
    : 0;
}

vtkTypeInt64 vtkMeshingStatistics::GetReceived(int level) const
{
  vtkTypeInt64 sum = 0;
  for (int thread = 0; thread < this->GetNumberOfRefinementThreads(); ++thread)
  {
    sum += this->GetThreadReceived(thread, level);
  }
  return sum;
}

vtkTypeInt64 vtkMeshingStatistics::GetNormalizedVolumeBin(int bin) const
{
  return bin >= 0 && bin < this->GetNumberOfNormalizedVolumeBins()
    ? static_cast<vtkTypeInt64>(
        this->Values->Quality.NormalizedVolumes[static_cast<std::size_t>(bin)])
    : 0;
}

double vtkMeshingStatistics::GetMeanCavitySize() const
{
  return MeanCavitySize(this->Values->Run.Rules);
}

void vtkMeshingStatistics::GetScalarRange(double range[2]) const
{
  std::copy_n(this->Values->Isosurface.Range.begin(), 2, range);
}

vtkTypeInt64 vtkMeshingStatistics::GetLostLabel(int index) const
{
  return index >= 0 && index < this->GetNumberOfLostLabels()
    ? this->Values->LostLabels[static_cast<std::size_t>(index)]
    : 0;
}

vtkTypeInt64 vtkMeshingStatistics::GetLabel(int index) const
{
  return index >= 0 && index < this->GetNumberOfLabels()
    ? this->Values->Quality.Labels[static_cast<std::size_t>(index)].Label
    : 0;
}

int vtkMeshingStatistics::GetNumberOfRuns() const
{
  return static_cast<int>(this->Values->Run.Runs.size());
}

double vtkMeshingStatistics::GetRunDelta(int index) const
{
  return index >= 0 && index < this->GetNumberOfRuns()
    ? this->Values->Run.Runs[static_cast<std::size_t>(index)].Delta
    : 0.0;
}

vtkTypeInt64 vtkMeshingStatistics::GetRunElements(int index) const
{
  return index >= 0 && index < this->GetNumberOfRuns()
    ? static_cast<vtkTypeInt64>(this->Values->Run.Runs[static_cast<std::size_t>(index)].Elements)
    : 0;
}

vtkTypeInt64 vtkMeshingStatistics::GetLabelElements(int index) const
{
  return index >= 0 && index < this->GetNumberOfLabels()
    ? static_cast<vtkTypeInt64>(
        this->Values->Quality.Labels[static_cast<std::size_t>(index)].Elements)
    : 0;
}

double vtkMeshingStatistics::GetLabelVolume(int index) const
{
  return index >= 0 && index < this->GetNumberOfLabels()
    ? this->Values->Quality.Labels[static_cast<std::size_t>(index)].Volume
    : 0.0;
}

vtkTypeInt64 vtkMeshingStatistics::GetLostComponentLabel(int index) const
{
  return ReportAt(this->Values->Run.Components.Lost, index).Label;
}

vtkTypeInt64 vtkMeshingStatistics::GetLostComponentVoxels(int index) const
{
  return ReportAt(this->Values->Run.Components.Lost, index).Voxels;
}

void vtkMeshingStatistics::GetLostComponentVoxel(int index, vtkTypeInt64 voxel[3]) const
{
  CopyVoxel(ReportAt(this->Values->Run.Components.Lost, index), voxel);
}

vtkTypeInt64 vtkMeshingStatistics::GetDroppedComponentLabel(int index) const
{
  return ReportAt(this->Values->DroppedComponents, index).Label;
}

vtkTypeInt64 vtkMeshingStatistics::GetDroppedComponentVoxels(int index) const
{
  return ReportAt(this->Values->DroppedComponents, index).Voxels;
}

void vtkMeshingStatistics::GetDroppedComponentVoxel(int index, vtkTypeInt64 voxel[3]) const
{
  CopyVoxel(ReportAt(this->Values->DroppedComponents, index), voxel);
}

vtkTypeInt64 vtkMeshingStatistics::GetRuleFired(int rule) const
{
  const auto& fired = this->Values->Run.Rules.Fired;
  return rule >= 1 && rule <= static_cast<int>(fired.size())
    ? static_cast<vtkTypeInt64>(fired[static_cast<std::size_t>(rule - 1)])
    : 0;
}

int vtkMeshingStatistics::GetNumberOfYieldingRegions() const
{
  const auto& steps = this->Values->Run.Yielding;
  return static_cast<int>(std::count_if(steps.begin(), steps.end(),
    [](const voxplex::YieldingReport& region) { return region.Step == 1; }));
}

std::string vtkMeshingStatistics::ToJSON() const
{
  const Figures& v = *this->Values;
  ordered_json json = {
    { "dimension", v.Dimension },
    { "elements", v.Elements },
    { "vertices", v.Vertices },
    { "interface_facets", v.InterfaceFacets },
    { "delta", v.Run.Delta },
    { "largest_delta", v.Run.LargestDelta },
    { "grading", { { "samples", v.Run.GradingSamples }, { "poles", v.Run.GradingPoles } } },
  };
  AddRuns(json, v.Run);
  json.update({
    { "smoothing_sigma", v.Run.SmoothingSigma },
    { "threads", v.Threads },
    { "contention", voxplex::ContentionPolicyNames[static_cast<std::size_t>(v.Run.Contention)] },
    { "balance", voxplex::BalancePolicyNames[static_cast<std::size_t>(v.Run.Balance)] },
    { "switched_to_local", v.Run.SwitchedToLocal },
    { "seeding_seconds", v.Run.SeedingSeconds },
    { "estimated_elements", v.Run.EstimatedElements },
    { "sizes_raised_to", v.Run.SizesRaisedTo },
    { "isosurface", IsosurfaceToJson(v.Isosurface) },
    { "lost_labels", v.LostLabels },
    { "components", v.Run.Components.Found },
    { "lost_components", voxplex::ComponentsToJson(v.Run.Components.Lost) },
    { "dropped_components", voxplex::ComponentsToJson(v.DroppedComponents) },
    { "largest_regional_work", v.Run.Rules.LargestRegionalWork },
    { "yielding_regions", YieldingToJson(v.Run.Yielding) },
    { "interfaces", InterfacesToJson(v.Run.Interfaces) },
    { "optimisation", OptimisationToJson(v.Run.Optimisation) },
  });
  if (v.HasQuality)
  {
    ordered_json& labels = json["labels"] = ordered_json::object();
    for (const auto& label : v.Quality.Labels)
    {
      voxplex::AppendLabel(
        labels, label.Label, { { "elements", label.Elements }, { "volume", label.Volume } });
    }
    json["quality"] = voxplex::QualityToJson(v.Quality);
  }
  const auto& rules = v.Run.Rules;
  const auto& predicates = v.Run.Predicates;
  const auto& times = v.Run.Times;
  json.update({
    { "rules", RulesToJson(rules) },
    { "cavities", { { "mean", MeanCavitySize(rules) }, { "largest", rules.LargestCavity } } },
    { "slivers",
      { { "found", rules.SliversFound }, { "picks", rules.PicksTried },
        { "kept", rules.SliversKept } } },
    { "predicates",
      { { "calls", predicates.Calls }, { "filter_failures", predicates.StaticFailures },
        { "exact", predicates.ExactCalls }, { "perturbed", predicates.Perturbed } } },
    { "time",
      { { "label_field", times.LabelField }, { "distance_transform", times.DistanceTransform },
        { "grading", times.Grading }, { "components", times.Components },
        { "interfaces", times.Interfaces }, { "refinement", times.Refinement },
        { "extraction", times.Extraction }, { "optimisation", times.Optimisation },
        { "total", times.Total() } } },
    { "memory",
      { { "label_field_bytes", v.Run.LabelFieldBytes },
        { "distance_bytes", v.Run.DistanceBytes } } },
    { "thread_statistics", ThreadsToJson(v.Run.Threads) },
  });
  return json.dump();
}

void vtkMeshingStatistics::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Dimension: " << this->GetDimension() << "\n";
  os << indent << "NumberOfElements: " << this->GetNumberOfElements() << "\n";
  os << indent << "NumberOfVertices: " << this->GetNumberOfVertices() << "\n";
  os << indent << "NumberOfInterfaceFacets: " << this->GetNumberOfInterfaceFacets() << "\n";
  os << indent << "Delta: " << this->GetDelta() << "\n";
  if (this->GetElementsAskedFor() > 0)
  {
    os << indent << "ElementsAskedFor: " << this->GetElementsAskedFor() << ", found in "
       << this->GetNumberOfRuns() << " runs\n";
  }
  os << indent << "NumberOfThreads: " << this->GetNumberOfThreads() << "\n";
  os << indent << "NumberOfLostLabels: " << this->GetNumberOfLostLabels() << "\n";
  os << indent << "HasQuality: " << this->GetHasQuality() << "\n";
  os << indent << "NumberOfLabels: " << this->GetNumberOfLabels() << "\n";
  os << indent << "TotalTime: " << this->GetTotalTime() << "\n";
  os << indent << "NumberOfRefinementThreads: " << this->GetNumberOfRefinementThreads() << "\n";
  os << indent << "Rollbacks: " << this->GetRollbacks() << "\n";
  os << indent << "SwitchedToLocal: " << this->GetSwitchedToLocal() << "\n";
  os << indent << "All figures: " << this->ToJSON() << "\n";
}
