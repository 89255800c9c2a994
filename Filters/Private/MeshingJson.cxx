// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Private/FiguresJson.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

using nlohmann::ordered_json;

namespace voxplex
{

namespace
{

/** Null for labels. */
ordered_json IsosurfaceToJson(const std::optional<MeshedIsosurface>& isosurface)
{
  if (!isosurface)
  {
    return nullptr;
  }
  return {
    { "value", isosurface->Surface.Value },
    { "inside", isosurface->Surface.Inside == IsosurfaceSide::Above ? "above" : "below" },
    { "range", isosurface->Range },
  };
}

/** The search for a number of elements; null and empty if none was asked for. */
void AddRuns(ordered_json& json, const MeshingStatistics& run)
{
  ordered_json& elements = json["elements_asked_for"];
  if (run.ElementsAskedFor > 0)
  {
    elements = run.ElementsAskedFor;
  }
  json["runs"] = ListToJson(run.Runs,
    [](const MeshingRun& one) -> ordered_json {
      return { { "delta", one.Delta }, { "elements", one.Elements } };
    });
}

ordered_json BrokenToJson(const BrokenComponent& component)
{
  ordered_json json = ComponentToJson(component.Component);
  json.update({ { "fragments", component.Fragments }, { "largest", component.Largest } });
  return json;
}

ordered_json UnitedToJson(const UnitedComponents& piece)
{
  ordered_json json = ComponentToJson(piece.Component);
  json["number"] = piece.Number;
  return json;
}

ordered_json ContactToJson(const FalseContact& contact)
{
  return { { "labels", contact.Labels }, { "facets", contact.Facets }, { "area", contact.Area },
    { "voxel", contact.Voxel } };
}

ordered_json RulesToJson(const RuleStatistics& rules)
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

ordered_json InterfacesToJson(const InterfaceStatistics& figures)
{
  return {
    { "junction_curves", figures.JunctionCurves },
    { "junction_corners", figures.Corners },
    { "junction_points", figures.JunctionSeeds },
    { "rounds", figures.Rounds },
    { "points", figures.Seeds },
    { "layer_rounds", figures.LayerRounds },
    { "layer_points", figures.LayerSeeds },
    { "nonmanifold_edges_repaired", figures.NonManifoldRepaired },
    { "nonmanifold_edges_opened", figures.NonManifoldOpened },
    { "nonmanifold_edges_left", figures.NonManifoldLeft },
  };
}

/** Null unless the mesh conforms to time planes. */
ordered_json PlanesToJson(const TimePlaneStatistics& planes)
{
  if (planes.Times.empty())
  {
    return nullptr;
  }
  return { { "slabs", planes.Times.size() + 1 }, { "rounds", planes.Rounds },
    { "vertices", planes.Vertices }, { "facets", planes.Facets },
    { "relabelled", planes.Relabelled }, { "refused", planes.Refused },
    { "periodic", planes.Periodic }, { "periodic_pairs", planes.Pairs } };
}

/** Dihedral angles of 3D, or normalized volumes of space-time. */
ordered_json OptimisationToJson(const OptimisationSummary& figures, bool isSpaceTime)
{
  ordered_json json = { { "ran", figures.Ran }, { "out_of_time", figures.OutOfTime } };
  const auto addShapes = [&](const std::string& when, double smallestAngle, double largestAngle,
                           double smallestVolume, std::uint64_t poor)
  {
    if (isSpaceTime)
    {
      json["min_normalized_volume_" + when] = smallestVolume;
    }
    else
    {
      json["min_dihedral_" + when] = smallestAngle;
      json["max_dihedral_" + when] = largestAngle;
    }
    json["poor_" + when] = poor;
  };
  addShapes("before", figures.SmallestDihedralBefore, figures.LargestDihedralBefore,
    figures.SmallestVolumeBefore, figures.PoorBefore);
  addShapes("after", figures.SmallestDihedralAfter, figures.LargestDihedralAfter,
    figures.SmallestVolumeAfter, figures.PoorAfter);
  return json;
}

/** NaN without insertions. */
double MeanCavitySize(const RuleStatistics& rules)
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

ordered_json ThreadToJson(const ThreadStatistics& thread)
{
  ordered_json json = {
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
    { "helping_seconds", thread.HelpingSeconds },
  };
  AddIfCounted(json, "tlb_misses", thread.Hardware.TlbMisses);
  AddIfCounted(json, "last_level_cache_misses", thread.Hardware.LastLevelCacheMisses);
  AddIfCounted(json, "resource_stall_cycles", thread.Hardware.ResourceStallCycles);
  return json;
}

} // namespace

//----------------------------------------------------------------------------------------------------
ordered_json FiguresToJson(const MeshingStatistics& v)
{
  ordered_json json = {
    { "dimension", v.Dimension },
    { "elements", v.Elements },
    { "vertices", v.Vertices },
    { "interface_facets", v.InterfaceFacets },
    { "delta", v.Delta },
    { "largest_delta", v.LargestDelta },
    { "grading", { { "samples", v.GradingSamples }, { "poles", v.GradingPoles } } },
  };
  AddRuns(json, v);
  json.update({
    { "smoothing_sigma", v.SmoothingSigma },
    { "frame_steps", v.FrameSteps },
    { "threads", v.NumberOfThreads },
    { "contention", ContentionPolicyNames[static_cast<std::size_t>(v.Contention)] },
    { "balance", BalancePolicyNames[static_cast<std::size_t>(v.Balance)] },
    { "switched_to_local", v.SwitchedToLocal },
    { "seeding_seconds", v.SeedingSeconds },
    { "estimated_elements", v.EstimatedElements },
    { "sizes_raised_to", v.SizesRaisedTo },
    { "isosurface", IsosurfaceToJson(v.Isosurface) },
    { "lost_labels", v.LostLabels },
    { "shrunk_labels",
      ListToJson(v.ShrunkLabels,
        [](const ShrunkLabel& label) -> ordered_json {
          return { { "label", label.Label }, { "fraction", label.Fraction } };
        }) },
    { "components", v.Components.Found },
    { "lost_components", ComponentsToJson(v.Components.Lost) },
    { "broken_components", ListToJson(v.Components.Broken, BrokenToJson) },
    { "united_components", ListToJson(v.Components.United, UnitedToJson) },
    { "false_contacts", ListToJson(v.Components.Contacts, ContactToJson) },
    { "dropped_components", ComponentsToJson(v.DroppedComponents) },
    { "frame_components", v.FrameComponents.Found },
    { "lost_frame_components", ComponentsToJson(v.FrameComponents.Lost) },
    { "largest_regional_work", v.Rules.LargestRegionalWork },
    { "yielding_regions",
      ListToJson(v.RelaxedRegions,
        [](const RelaxationReport& region) -> ordered_json {
          return { { "step", region.Step }, { "voxel", region.Voxel } };
        }) },
    { "time_planes", PlanesToJson(v.Planes) },
    { "interfaces", InterfacesToJson(v.Interfaces) },
    { "optimisation", OptimisationToJson(v.Optimisation, v.Dimension == 4) },
  });
  if (v.HasQuality)
  {
    ordered_json& labels = json["labels"] = ordered_json::object();
    for (const auto& label : v.Quality.Labels)
    {
      AppendLabel(
        labels, label.Label, { { "elements", label.Elements }, { "volume", label.Volume } });
    }
    json["quality"] = QualityToJson(v.Quality);
  }
  const auto& rules = v.Rules;
  const auto& predicates = v.Predicates;
  const auto& times = v.Times;
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
      { { "label_field_bytes", v.LabelFieldBytes }, { "distance_bytes", v.DistanceBytes } } },
    { "thread_statistics", ListToJson(v.Threads, ThreadToJson) },
  });
  return json;
}

} // namespace voxplex
