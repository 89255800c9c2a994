// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Private/QualityTables.h"

#include "Geometry/SimplexQuality.h"
#include "Parallel/ParallelFor.h"

#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkIdTypeArray.h"
#include "vtkNew.h"
#include "vtkTable.h"
#include "vtkTypeInt64Array.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <type_traits>
#include <vector>

namespace voxplex
{
namespace
{

double* AddDoubles(vtkCellData* cells, const char* name, std::size_t size)
{
  vtkNew<vtkDoubleArray> array;
  array->SetName(name);
  array->SetNumberOfValues(static_cast<vtkIdType>(size));
  cells->AddArray(array);
  return array->GetPointer(0);
}

/** A column with a value for each of `rows`: real or whole numbers, as valueOf() returns them. */
template <typename Rows, typename ValueOf>
void AddColumn(vtkTable* table, const char* name, const Rows& rows, ValueOf&& valueOf)
{
  using Value = decltype(valueOf(*rows.begin()));
  using Array =
    std::conditional_t<std::is_floating_point_v<Value>, vtkDoubleArray, vtkTypeInt64Array>;
  vtkNew<Array> column;
  column->SetName(name);
  for (const auto& row : rows)
  {
    column->InsertNextValue(static_cast<typename Array::ValueType>(valueOf(row)));
  }
  table->AddColumn(column);
}

/** Where each of the bins begins. */
template <std::size_t N>
void AddStarts(
  vtkTable* table, const char* name, const std::array<std::uint64_t, N>& bins, double width)
{
  AddColumn(table, name, bins,
    [&bins, width](const std::uint64_t& bin)
    { return width * static_cast<double>(&bin - bins.data()); });
}

template <std::size_t N>
void AddBins(vtkTable* table, const char* name, const std::array<std::uint64_t, N>& bins)
{
  AddColumn(table, name, bins, [](std::uint64_t count) { return count; });
}

} // namespace

std::map<std::int64_t, LabelFigures> CollectLabels(const MeshMeasurement& measurement)
{
  std::map<std::int64_t, LabelFigures> labels;
  for (const LabelMeasure& measure : measurement.Quality.Labels)
  {
    labels[measure.Label].Comparison = { measure.Label, 0, 0.0, measure.Elements, measure.Volume };
  }
  for (const LabelTopology& topology : measurement.Topology.Labels)
  {
    labels[topology.Label].Topology = topology;
  }
  for (const auto& [label, number] : measurement.Fragments)
  {
    labels[label].Fragments = number;
  }
  if (measurement.Image)
  {
    for (const LabelComparison& comparison : measurement.Image->Labels)
    {
      labels[comparison.Label].Comparison = comparison;
    }
  }
  return labels;
}

void AddElementMeasures(const SimplexMesh<3>& mesh, unsigned threads, vtkCellData* cells)
{
  constexpr std::size_t grain = 4096;
  const std::size_t n = mesh.Simplices.size();
  double* const smallest = AddDoubles(cells, "MinimumDihedralAngle", n);
  double* const largest = AddDoubles(cells, "MaximumDihedralAngle", n);
  double* const ratio = AddDoubles(cells, "RadiusEdgeRatio", n);
  double* const volume = AddDoubles(cells, "Volume", n);
  ParallelFor(0, n, grain, threads,
    [&](std::size_t first, std::size_t last)
    {
      for (std::size_t s = first; s < last; ++s)
      {
        const auto v = mesh.PointsOf(s);
        const std::array<double, 6> angles = DihedralAngles(v.data());
        smallest[s] = *std::min_element(angles.begin(), angles.end());
        largest[s] = *std::max_element(angles.begin(), angles.end());
        ratio[s] = voxplex::RadiusEdgeRatio<3>(v.data());
        volume[s] = SignedVolume<3>(v.data());
      }
    });
}

void FillLabelTable(const MeshMeasurement& measurement, vtkTable* table)
{
  const std::map<std::int64_t, LabelFigures> rows = CollectLabels(measurement);
  const auto add = [&](const char* name, auto&& valueOf)
  { AddColumn(table, name, rows, [&](const auto& row) { return valueOf(row.second); }); };
  add("Label", [](const LabelFigures& row) { return row.Comparison.Label; });
  add("Elements", [](const LabelFigures& row) { return row.Comparison.Elements; });
  add("Volume", [](const LabelFigures& row) { return row.Comparison.Volume; });
  add("BoundaryEdges", [](const LabelFigures& row) { return row.Topology.BoundaryEdges; });
  add("NonManifoldEdges", [](const LabelFigures& row) { return row.Topology.NonManifoldEdges; });
  add("NonManifoldEdgesAtJunctions",
    [](const LabelFigures& row) { return row.Topology.NonManifoldEdgesAtJunctions; });
  if (measurement.Image)
  {
    add("Voxels", [](const LabelFigures& row) { return row.Comparison.Voxels; });
    add("ImageVolume", [](const LabelFigures& row) { return row.Comparison.ImageVolume; });
    add("VolumeError", [](const LabelFigures& row) { return row.Comparison.VolumeError(); });
  }
}

void FillHistograms(const MeshQuality& quality, vtkTable* table)
{
  AddStarts(table, "Angle", quality.DihedralAngles, MeshQuality::AngleBinWidth);
  AddBins(table, "DihedralAngles", quality.DihedralAngles);
  AddBins(table, "PlanarAngles", quality.PlanarAngles);
  AddStarts(table, "Ratio", quality.RadiusEdgeRatios, MeshQuality::RatioBinWidth);
  AddBins(table, "RadiusEdgeRatios", quality.RadiusEdgeRatios);
}

//----------------------------------------------------------------------------------------------------
void AddElementMeasures(const SpaceTimeMeasurement& figures, vtkCellData* cells)
{
  const auto add = [cells](const char* name, const std::vector<double>& values)
  { std::copy(values.begin(), values.end(), AddDoubles(cells, name, values.size())); };
  add("NormalizedVolume", figures.NormalizedVolumes);
  add("RadiusEdgeRatio", figures.RadiusEdgeRatios);
  add("Volume", figures.Hypervolumes);
  vtkNew<vtkIdTypeArray> ranks;
  ranks->SetName("WorstElement");
  ranks->SetNumberOfValues(static_cast<vtkIdType>(figures.Hypervolumes.size()));
  ranks->FillValue(0);
  for (std::size_t k = 0; k < figures.Worst.size(); ++k)
  {
    ranks->SetValue(figures.Worst[k].Cell, static_cast<vtkIdType>(k + 1));
  }
  cells->AddArray(ranks);
}

void FillLabelTable(const SpaceTimeMeasurement& figures, vtkTable* table)
{
  const std::vector<SpaceTimeLabel> rows = figures.Labels();
  const auto add = [&](const char* name, auto&& valueOf) { AddColumn(table, name, rows, valueOf); };
  add("Label", [](const SpaceTimeLabel& row) { return row.Label; });
  add("Elements", [](const SpaceTimeLabel& row) { return row.Elements; });
  add("Volume", [](const SpaceTimeLabel& row) { return row.Volume; });
  add("Components", [](const SpaceTimeLabel& row) { return row.Components; });
  if (figures.Components)
  {
    add("ImageVolume", [](const SpaceTimeLabel& row) { return row.ImageVolume; });
    add("VolumeError", [](const SpaceTimeLabel& row) { return row.VolumeError(); });
  }
}

void FillHistograms(const SpaceTimeMeasurement& figures, vtkTable* table)
{
  const MeshQuality& quality = figures.Quality;
  // Bins of both figures are 0.05 wide. Normalized volumes are at most 1.
  static_assert(MeshQuality::RatioBinWidth * MeshQuality::NumberOfBins == 1.0);
  std::array<std::uint64_t, MeshQuality::NumberOfRatioBins> volumes{};
  std::copy(quality.NormalizedVolumes.begin(), quality.NormalizedVolumes.end(), volumes.begin());
  AddStarts(table, "Ratio", quality.RadiusEdgeRatios, MeshQuality::RatioBinWidth);
  AddBins(table, "RadiusEdgeRatios", quality.RadiusEdgeRatios);
  AddBins(table, "NormalizedVolumes", volumes);
}

void FillFrameTable(const SpaceTimeMeasurement& figures, vtkTable* table)
{
  struct Row
  {
    const FrameMeasurement* Frame;
    LabelComparison Label;
  };
  std::vector<Row> rows;
  for (const FrameMeasurement& frame : figures.Frames)
  {
    if (frame.Measured.Image)
    {
      for (const LabelComparison& label : frame.Measured.Image->Labels)
      {
        rows.push_back({ &frame, label });
      }
      continue;
    }
    for (const LabelMeasure& label : frame.Measured.Quality.Labels)
    {
      rows.push_back(
        { &frame, { label.Label, 0, MeshQuality::NotApplicable, label.Elements, label.Volume } });
    }
  }
  const auto add = [&](const char* name, auto&& valueOf) { AddColumn(table, name, rows, valueOf); };
  const auto addOfImage = [&](const char* name, auto&& valueOf, auto without)
  {
    add(name,
      [&](const Row& row)
      {
        const auto& image = row.Frame->Measured.Image;
        return image ? valueOf(*image) : without;
      });
  };
  add("Time", [](const Row& row) { return row.Frame->Time; });
  add("Label", [](const Row& row) { return row.Label.Label; });
  add("Elements", [](const Row& row) { return row.Label.Elements; });
  add("Volume", [](const Row& row) { return row.Label.Volume; });
  add("ImageVolume", [](const Row& row) { return row.Label.ImageVolume; });
  add("VolumeError", [](const Row& row) { return row.Label.VolumeError(); });
  addOfImage(
    "HausdorffDistance", [](const ImageComparison& image) { return image.Voxels.Distance(); },
    MeshQuality::NotApplicable);
  addOfImage(
    "Components", [](const ImageComparison& image) { return image.Components; },
    std::uint64_t{ 0 });
  addOfImage(
    "LostComponents",
    [](const ImageComparison& image) { return std::uint64_t{ image.LostComponents.size() }; },
    std::uint64_t{ 0 });
}

} // namespace voxplex
