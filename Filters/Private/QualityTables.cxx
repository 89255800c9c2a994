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

/** A column with a value for each of `rows`. */
template <typename Array, typename Rows, typename ValueOf>
void AddColumn(vtkTable* table, const char* name, const Rows& rows, ValueOf&& valueOf)
{
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
  AddColumn<vtkDoubleArray>(table, name, bins,
    [&bins, width](const std::uint64_t& bin)
    { return width * static_cast<double>(&bin - bins.data()); });
}

template <std::size_t N>
void AddBins(vtkTable* table, const char* name, const std::array<std::uint64_t, N>& bins)
{
  AddColumn<vtkTypeInt64Array>(table, name, bins, [](std::uint64_t count) { return count; });
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
  const auto count = [&](const char* name, auto&& valueOf)
  {
    AddColumn<vtkTypeInt64Array>(
      table, name, rows, [&](const auto& row) { return valueOf(row.second); });
  };
  const auto number = [&](const char* name, auto&& valueOf)
  {
    AddColumn<vtkDoubleArray>(
      table, name, rows, [&](const auto& row) { return valueOf(row.second); });
  };
  count("Label", [](const LabelFigures& row) { return row.Comparison.Label; });
  count("Elements", [](const LabelFigures& row) { return row.Comparison.Elements; });
  number("Volume", [](const LabelFigures& row) { return row.Comparison.Volume; });
  count("BoundaryEdges", [](const LabelFigures& row) { return row.Topology.BoundaryEdges; });
  count("NonManifoldEdges", [](const LabelFigures& row) { return row.Topology.NonManifoldEdges; });
  count("NonManifoldEdgesAtJunctions",
    [](const LabelFigures& row) { return row.Topology.NonManifoldEdgesAtJunctions; });
  if (measurement.Image)
  {
    count("Voxels", [](const LabelFigures& row) { return row.Comparison.Voxels; });
    number("ImageVolume", [](const LabelFigures& row) { return row.Comparison.ImageVolume; });
    number("VolumeError",
      [](const LabelFigures& row)
      {
        const LabelComparison& label = row.Comparison;
        return (label.Volume - label.ImageVolume) / label.ImageVolume;
      });
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
void AddElementMeasures(const SpaceTimeFigures& figures, vtkCellData* cells)
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

void FillLabelTable(const SpaceTimeFigures& figures, vtkTable* table)
{
  const std::vector<SpaceTimeLabel> rows = LabelsOf(figures);
  AddColumn<vtkTypeInt64Array>(
    table, "Label", rows, [](const SpaceTimeLabel& row) { return row.Label; });
  AddColumn<vtkTypeInt64Array>(
    table, "Elements", rows, [](const SpaceTimeLabel& row) { return row.Elements; });
  AddColumn<vtkDoubleArray>(
    table, "Volume", rows, [](const SpaceTimeLabel& row) { return row.Volume; });
  AddColumn<vtkTypeInt64Array>(
    table, "Components", rows, [](const SpaceTimeLabel& row) { return row.Components; });
  if (figures.Components)
  {
    AddColumn<vtkDoubleArray>(
      table, "ImageVolume", rows, [](const SpaceTimeLabel& row) { return row.ImageVolume; });
    AddColumn<vtkDoubleArray>(
      table, "VolumeError", rows, [](const SpaceTimeLabel& row) { return row.VolumeError(); });
  }
}

void FillHistograms(const SpaceTimeFigures& figures, vtkTable* table)
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

void FillFrameTable(const SpaceTimeFigures& figures, vtkTable* table)
{
  struct Row
  {
    const FrameFigures* Frame;
    LabelComparison Label;
  };
  std::vector<Row> rows;
  for (const FrameFigures& frame : figures.Frames)
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
  const auto count = [&](const char* name, auto&& valueOf)
  { AddColumn<vtkTypeInt64Array>(table, name, rows, valueOf); };
  const auto number = [&](const char* name, auto&& valueOf)
  { AddColumn<vtkDoubleArray>(table, name, rows, valueOf); };
  number("Time", [](const Row& row) { return row.Frame->Time; });
  count("Label", [](const Row& row) { return row.Label.Label; });
  count("Elements", [](const Row& row) { return row.Label.Elements; });
  number("Volume", [](const Row& row) { return row.Label.Volume; });
  number("ImageVolume", [](const Row& row) { return row.Label.ImageVolume; });
  number("VolumeError",
    [](const Row& row)
    { return (row.Label.Volume - row.Label.ImageVolume) / row.Label.ImageVolume; });
  number("HausdorffDistance",
    [](const Row& row)
    {
      const auto& image = row.Frame->Measured.Image;
      return image ? image->Voxels.Distance() : MeshQuality::NotApplicable;
    });
  count("Components",
    [](const Row& row)
    { return row.Frame->Measured.Image ? row.Frame->Measured.Image->Components : 0; });
  count("LostComponents",
    [](const Row& row)
    { return row.Frame->Measured.Image ? row.Frame->Measured.Image->LostComponents.size() : 0; });
}

} // namespace voxplex
