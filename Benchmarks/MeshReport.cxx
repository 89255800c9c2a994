// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "MeshReport.h"

#include "MarkdownTable.h"
#include "Statistics.h"

#include <algorithm>
#include <cstdio>
#include <string>

namespace voxplex::benchmarks
{
namespace
{

/** A number of a record: its names in the table and in the JSON stream, and its format. */
struct Row
{
  const char* Name;
  const char* Key;
  const char* Format;
  bool Ratio; ///< whether the ratio of the two meshers is meaningful
  double (*Value)(const Record&);
};

const Row Rows[] = {
  { "tetrahedra", "tetrahedra", "%.0f", true, [](const Record& r) { return r.Tetrahedra(); } },
  { "refinement, s", "refinement", "%.3f", true,
    [](const Record& r) { return r.RefinementSeconds; } },
  { "total without files, s", "total_without_io", "%.3f", true,
    [](const Record& r) { return r.TotalSeconds; } },
  { "  processor time, s", "cpu", "%.3f", true, [](const Record& r) { return r.CpuSeconds; } },
  { "tets/s, refinement", "elements_per_second_refinement", "%.0f", true,
    [](const Record& r) { return r.Tetrahedra() / r.RefinementSeconds; } },
  { "tets/s, total", "elements_per_second", "%.0f", true,
    [](const Record& r) { return r.Tetrahedra() / r.TotalSeconds; } },
  { "peak memory, MB", "peak_memory_mb", "%.1f", true,
    [](const Record& r) { return static_cast<double>(r.PeakBytes) / 1e6; } },
  { "radius-edge, largest", "radius_edge_max", "%.3f", false,
    [](const Record& r) { return r.Quality.RadiusEdgeMax; } },
  { "dihedral, smallest", "dihedral_min", "%.2f", false,
    [](const Record& r) { return r.Quality.DihedralMin; } },
  { "dihedral, largest", "dihedral_max", "%.2f", false,
    [](const Record& r) { return r.Quality.DihedralMax; } },
  { "interface facets", "interface_facets", "%.0f", false,
    [](const Record& r) { return static_cast<double>(r.Quality.InterfaceFacets); } },
  { "planar angle, smallest", "planar_min", "%.2f", false,
    [](const Record& r) { return r.Quality.PlanarMin; } },
  { "  away from junctions", "planar_min_away_from_junctions", "%.2f", false,
    [](const Record& r) { return r.Quality.PlanarMinAwayFromJunctions; } },
  { "facets below 30 degrees", "planar_below_30", "%.0f", false,
    [](const Record& r) { return static_cast<double>(r.Quality.PlanarBelow30); } },
  { "  away from junctions", "planar_below_30_away_from_junctions", "%.0f", false,
    [](const Record& r) { return static_cast<double>(r.Quality.PlanarBelow30AwayFromJunctions); } },
  { "inverted tetrahedra", "inverted", "%.0f", false,
    [](const Record& r) { return static_cast<double>(r.Quality.Inverted); } },
  { "labels present", "labels", "%.0f", false,
    [](const Record& r)
    { return static_cast<double>(r.Quality.LabelsInImage - r.Quality.LabelsLost); } },
  { "labels lost", "labels_lost", "%.0f", false,
    [](const Record& r) { return static_cast<double>(r.Quality.LabelsLost); } },
  { "label volume error, %", "label_volume_error_percent", "%.3f", false,
    [](const Record& r) { return 100.0 * r.Quality.VolumeError; } },
};

/** Writes one number of each row as a JSON object. */
template <typename NumberOf>
void WriteNumbers(std::ostream& stream, bool onlyRatios, NumberOf numberOf)
{
  const char* separator = "{ ";
  for (const Row& row : Rows)
  {
    if (row.Ratio || !onlyRatios)
    {
      stream << separator << "\"" << row.Key << "\": " << numberOf(row);
      separator = ",\n        ";
    }
  }
  stream << " }";
}

void PrintCell(const char* format, const Contestant& contestant, double value)
{
  char text[32] = "-"; // the mesher did not run
  if (!contestant.Records.empty())
  {
    std::snprintf(text, sizeof(text), format, value);
  }
  std::printf(" %14s", text);
}

} // namespace

void PrintTable(const Contestant& left, const Contestant& right)
{
  std::printf("%-26s %14s %14s %10s\n", "", left.Name, right.Name, "ratio");
  std::printf("%-26s", "delta, facet size");
  PrintCell("%.4g", left, left.Size);
  PrintCell("%.4g", right, right.Size);
  std::printf("\n");
  for (const Row& row : Rows)
  {
    const PairedMedians medians = MedianPair(left.Records, right.Records, row.Value);
    std::printf("%-26s", row.Name);
    PrintCell(row.Format, left, medians.Left);
    PrintCell(row.Format, right, medians.Right);
    if (row.Ratio && medians.Ratio > 0.0)
    {
      std::printf(" %10.3f", medians.Ratio);
    }
    std::printf("\n");
  }
}

void PrintSpread(const Contestant& one, const Contestant& many)
{
  MarkdownTable table({ "", one.Name, std::string(many.Name) + ", smallest", "median", "largest" });
  for (const Row& row : Rows)
  {
    double smallest = row.Value(many.Records.front());
    double largest = smallest;
    for (const Record& record : many.Records)
    {
      smallest = std::min(smallest, row.Value(record));
      largest = std::max(largest, row.Value(record));
    }
    table.Add({ row.Name, Format(MedianOf(one.Records, row.Value), row.Format),
      Format(smallest, row.Format), Format(MedianOf(many.Records, row.Value), row.Format),
      Format(largest, row.Format) });
  }
  table.Print();
}

void WriteJson(std::ostream& stream, const Contestant& contestant)
{
  stream << "{\n    \"size\": " << contestant.Size << ",\n    \"medians\":\n      ";
  WriteNumbers(
    stream, false, [&](const Row& row) { return MedianOf(contestant.Records, row.Value); });
  stream << ",\n    \"runs\": [";
  for (std::size_t i = 0; i < contestant.Records.size(); ++i)
  {
    stream << (i ? ",\n      " : "\n      ");
    WriteNumbers(stream, false, [&](const Row& row) { return row.Value(contestant.Records[i]); });
  }
  stream << "\n    ]\n  }";
}

void WriteRatios(std::ostream& stream, const Contestant& left, const Contestant& right)
{
  WriteNumbers(stream, true,
    [&](const Row& row) { return MedianPair(left.Records, right.Records, row.Value).Ratio; });
}

} // namespace voxplex::benchmarks
