// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Quality/MeshQuality.h"

#include "Geometry/Predicates.h"
#include "Geometry/SimplexQuality.h"
#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>

namespace voxplex
{
namespace
{

/** Elements measured at a time. Fixed, so that sums do not depend on the number of threads. */
constexpr std::size_t Grain = 4096;

/** Mean and standard deviation of numbers that are added one by one or in groups. */
class Moments
{
public:
  void Add(double x) { this->Add(1.0, x, x, 0.0); }
  void Add(const Moments& other)
  {
    this->Add(other.Count, other.Sum, other.Mean, other.SquaredDeviations);
  }

  double GetMean() const { return this->Sum / this->Count; }
  /** NaN if some number was not finite. */
  double GetDeviation() const { return std::sqrt(this->SquaredDeviations / this->Count); }

private:
  void Add(double count, double sum, double mean, double squaredDeviations)
  {
    if (count > 0.0)
    {
      const double all = this->Count + count;
      const double difference = mean - this->Mean;
      this->SquaredDeviations +=
        squaredDeviations + difference * difference * (this->Count * count / all);
      this->Mean += difference * (count / all);
      this->Sum += sum;
      this->Count = all;
    }
  }

  double Count = 0.0;
  double Sum = 0.0;
  double Mean = 0.0;
  double SquaredDeviations = 0.0;
};

/** Counts a value, given in widths of a bin. A value beyond the last bin counts in the last bin. */
template <std::size_t N>
void Count(std::array<std::uint64_t, N>& bins, double value)
{
  constexpr auto last = static_cast<double>(N - 1);
  // Not std::clamp: NaN (a ratio of two zeros) goes to the last bin, too.
  ++bins[value < last ? static_cast<std::size_t>(std::max(0.0, value)) : N - 1];
}

template <std::size_t N>
void Add(std::array<std::uint64_t, N>& bins, const std::array<std::uint64_t, N>& others)
{
  for (std::size_t i = 0; i < N; ++i)
  {
    bins[i] += others[i];
  }
}

/** Measures of a range of elements. */
struct ElementMeasures
{
  double ShortestEdge2 = std::numeric_limits<double>::infinity();
  double MaximumRadiusEdgeRatio = 0.0;
  Moments RadiusEdgeRatios;
  std::uint64_t RadiusEdgeViolations = 0;
  double MinimumDihedralAngle = std::numeric_limits<double>::infinity();
  double MaximumDihedralAngle = 0.0;
  double MinimumNormalizedVolume = std::numeric_limits<double>::infinity();
  Moments NormalizedVolumes;
  decltype(MeshQuality::NormalizedVolumes) Bins{};
  decltype(MeshQuality::DihedralAngles) DihedralBins{};
  decltype(MeshQuality::RadiusEdgeRatios) RatioBins{};
  std::uint64_t InvertedSimplices = 0;
  std::map<std::int64_t, LabelMeasure> Labels;

  void Add(const ElementMeasures& other)
  {
    this->ShortestEdge2 = std::min(this->ShortestEdge2, other.ShortestEdge2);
    this->RadiusEdgeRatios.Add(other.RadiusEdgeRatios);
    this->MaximumRadiusEdgeRatio =
      std::max(this->MaximumRadiusEdgeRatio, other.MaximumRadiusEdgeRatio);
    this->RadiusEdgeViolations += other.RadiusEdgeViolations;
    this->MinimumDihedralAngle = std::min(this->MinimumDihedralAngle, other.MinimumDihedralAngle);
    this->MaximumDihedralAngle = std::max(this->MaximumDihedralAngle, other.MaximumDihedralAngle);
    this->MinimumNormalizedVolume =
      std::min(this->MinimumNormalizedVolume, other.MinimumNormalizedVolume);
    this->NormalizedVolumes.Add(other.NormalizedVolumes);
    voxplex::Add(this->Bins, other.Bins);
    voxplex::Add(this->DihedralBins, other.DihedralBins);
    voxplex::Add(this->RatioBins, other.RatioBins);
    this->InvertedSimplices += other.InvertedSimplices;
    for (const auto& [label, measure] : other.Labels)
    {
      LabelMeasure& mine = this->Labels[label];
      mine.Label = label;
      mine.Elements += measure.Elements;
      mine.Volume += measure.Volume;
    }
  }
};

/** Measures of a range of facets. */
struct FacetMeasures
{
  double MinimumAngleOffJunctions = std::numeric_limits<double>::infinity();
  double MinimumAngleAtJunctions = std::numeric_limits<double>::infinity();
  std::uint64_t Violations = 0;
  std::uint64_t ViolationsAtJunctions = 0;
  std::uint64_t SmallAtJunctions = 0;
  decltype(MeshQuality::PlanarAngles) Bins{};

  void Add(const FacetMeasures& other)
  {
    this->MinimumAngleOffJunctions =
      std::min(this->MinimumAngleOffJunctions, other.MinimumAngleOffJunctions);
    this->MinimumAngleAtJunctions =
      std::min(this->MinimumAngleAtJunctions, other.MinimumAngleAtJunctions);
    this->Violations += other.Violations;
    this->ViolationsAtJunctions += other.ViolationsAtJunctions;
    this->SmallAtJunctions += other.SmallAtJunctions;
    voxplex::Add(this->Bins, other.Bins);
  }
};

/** The smallest box around the mesh, for the predicates' static filter. */
template <int D>
Predicates<D> MakePredicates(const SimplexMesh<D>& mesh)
{
  Point<D> min{};
  Point<D> max{};
  if (!mesh.Points.empty())
  {
    min = max = mesh.Points.front();
  }
  for (const Point<D>& p : mesh.Points)
  {
    for (std::size_t k = 0; k < p.size(); ++k)
    {
      min[k] = std::min(min[k], p[k]);
      max[k] = std::max(max[k], p[k]);
    }
  }
  return Predicates<D>(min, max);
}

template <int D>
void MeasureElements(const SimplexMesh<D>& mesh, std::size_t first, std::size_t last,
  double radiusEdgeBound, Predicates<D> predicates, ElementMeasures& measures)
{
  for (std::size_t s = first; s < last; ++s)
  {
    const auto v = mesh.PointsOf(s);
    measures.InvertedSimplices += predicates.Orientation(v.data()) <= 0;

    const double radius2 = Circumradius2<D>(v.data());
    measures.ShortestEdge2 = std::min(measures.ShortestEdge2, ShortestEdge2<D>(v.data()));
    const double ratio = RadiusEdgeRatio<D>(v.data(), radius2);
    measures.RadiusEdgeRatios.Add(ratio);
    measures.MaximumRadiusEdgeRatio = std::max(measures.MaximumRadiusEdgeRatio, ratio);
    measures.RadiusEdgeViolations += ratio >= radiusEdgeBound;
    Count(measures.RatioBins, ratio / MeshQuality::RatioBinWidth);

    const double normalized = NormalizedVolume<D>(v.data(), radius2);
    measures.MinimumNormalizedVolume = std::min(measures.MinimumNormalizedVolume, normalized);
    measures.NormalizedVolumes.Add(normalized);
    Count(measures.Bins, normalized * static_cast<double>(MeshQuality::NumberOfBins));

    if constexpr (D == 3)
    {
      const std::array<double, 6> angles = DihedralAngles(v.data());
      const auto [smallest, largest] = std::minmax_element(angles.begin(), angles.end());
      measures.MinimumDihedralAngle = std::min(measures.MinimumDihedralAngle, *smallest);
      measures.MaximumDihedralAngle = std::max(measures.MaximumDihedralAngle, *largest);
      for (const double angle : angles)
      {
        Count(measures.DihedralBins, angle / MeshQuality::AngleBinWidth);
      }
    }

    LabelMeasure& label = measures.Labels[mesh.Labels[s]];
    label.Label = mesh.Labels[s];
    ++label.Elements;
    label.Volume += SignedVolume<D>(v.data());
  }
}

/** For each point, whether the facets around it separate three or more labels. */
template <int D>
std::vector<char> FindJunctions(const SimplexMesh<D>& mesh)
{
  struct Seen
  {
    std::array<std::int64_t, 2> Label{};
    int Count = 0; // 3 stands for three or more
  };
  std::vector<Seen> seen(mesh.Points.size());
  for (std::size_t f = 0; f < mesh.Facets.size(); ++f)
  {
    for (const std::uint32_t point : mesh.Facets[f])
    {
      Seen& s = seen[point];
      for (const std::int64_t label : mesh.FacetLabels[f])
      {
        const bool known =
          (s.Count > 0 && s.Label[0] == label) || (s.Count > 1 && s.Label[1] == label);
        if (!known && s.Count < 2)
        {
          s.Label[static_cast<std::size_t>(s.Count)] = label;
        }
        s.Count = std::min(3, s.Count + (known ? 0 : 1));
      }
    }
  }
  std::vector<char> junctions(mesh.Points.size());
  for (std::size_t i = 0; i < seen.size(); ++i)
  {
    junctions[i] = seen[i].Count > 2;
  }
  return junctions;
}

void MeasureFacets(const SimplexMesh<3>& mesh, std::size_t first, std::size_t last,
  double facetAngleBound, const std::vector<char>& junctions, FacetMeasures& measures)
{
  for (std::size_t f = first; f < last; ++f)
  {
    const std::array<std::uint32_t, 3>& facet = mesh.Facets[f];
    const std::array<double, 3> angles =
      PlanarAngles(mesh.Points[facet[0]], mesh.Points[facet[1]], mesh.Points[facet[2]]);
    const double smallest = *std::min_element(angles.begin(), angles.end());
    const bool atJunction = junctions[facet[0]] || junctions[facet[1]] || junctions[facet[2]];
    double& minimum =
      atJunction ? measures.MinimumAngleAtJunctions : measures.MinimumAngleOffJunctions;
    minimum = std::min(minimum, smallest);
    measures.Violations += smallest < facetAngleBound;
    measures.ViolationsAtJunctions += atJunction && smallest < facetAngleBound;
    measures.SmallAtJunctions += atJunction && smallest < MeshQuality::JunctionFacetAngle;
    for (const double angle : angles)
    {
      Count(measures.Bins, angle / MeshQuality::AngleBinWidth);
    }
  }
}

} // namespace

//------------------------------------------------------------------------------
template <int D>
MeshQuality MeasureQuality(
  const SimplexMesh<D>& mesh, double radiusEdgeBound, double facetAngleBound, unsigned threads)
{
  MeshQuality quality;
  const std::size_t elements = mesh.Simplices.size();
  if (elements != 0)
  {
    const Predicates<D> predicates = MakePredicates(mesh);
    std::vector<ElementMeasures> chunks((elements - 1) / Grain + 1);
    ParallelFor(0, elements, Grain, threads,
      [&](std::size_t first, std::size_t last) {
        MeasureElements<D>(mesh, first, last, radiusEdgeBound, predicates, chunks[first / Grain]);
      });
    ElementMeasures sum;
    for (const ElementMeasures& chunk : chunks)
    {
      sum.Add(chunk);
    }
    quality.ShortestEdge = std::sqrt(sum.ShortestEdge2);
    quality.MaximumRadiusEdgeRatio = sum.MaximumRadiusEdgeRatio;
    quality.MeanRadiusEdgeRatio = sum.RadiusEdgeRatios.GetMean();
    quality.RadiusEdgeRatioDeviation = sum.RadiusEdgeRatios.GetDeviation();
    quality.RadiusEdgeViolations = sum.RadiusEdgeViolations;
    quality.MinimumNormalizedVolume = sum.MinimumNormalizedVolume;
    quality.MeanNormalizedVolume = sum.NormalizedVolumes.GetMean();
    quality.NormalizedVolumeDeviation = sum.NormalizedVolumes.GetDeviation();
    quality.NormalizedVolumes = sum.Bins;
    quality.RadiusEdgeRatios = sum.RatioBins;
    quality.InvertedSimplices = sum.InvertedSimplices;
    if (D == 3)
    {
      quality.MinimumDihedralAngle = sum.MinimumDihedralAngle;
      quality.MaximumDihedralAngle = sum.MaximumDihedralAngle;
      quality.DihedralAngles = sum.DihedralBins;
    }
    for (const auto& [label, measure] : sum.Labels)
    {
      quality.Labels.push_back(measure);
    }
  }

  if constexpr (D == 3)
  {
    const std::size_t facets = mesh.Facets.size();
    if (facets != 0)
    {
      const std::vector<char> junctions = FindJunctions(mesh);
      std::vector<FacetMeasures> chunks((facets - 1) / Grain + 1);
      ParallelFor(0, facets, Grain, threads,
        [&](std::size_t first, std::size_t last)
        { MeasureFacets(mesh, first, last, facetAngleBound, junctions, chunks[first / Grain]); });
      FacetMeasures sum;
      for (const FacetMeasures& chunk : chunks)
      {
        sum.Add(chunk);
      }
      const auto orNone = [](double angle)
      { return std::isfinite(angle) ? angle : MeshQuality::NotApplicable; };
      quality.MinimumFacetAngle =
        std::min(sum.MinimumAngleOffJunctions, sum.MinimumAngleAtJunctions);
      quality.MinimumFacetAngleOffJunctions = orNone(sum.MinimumAngleOffJunctions);
      quality.MinimumFacetAngleAtJunctions = orNone(sum.MinimumAngleAtJunctions);
      quality.FacetAngleViolations = sum.Violations;
      quality.FacetAngleViolationsAtJunctions = sum.ViolationsAtJunctions;
      quality.SmallFacetAnglesAtJunctions = sum.SmallAtJunctions;
      quality.PlanarAngles = sum.Bins;
    }
  }
  else
  {
    static_cast<void>(facetAngleBound);
  }
  return quality;
}

template MeshQuality MeasureQuality<3>(const SimplexMesh<3>&, double, double, unsigned);
template MeshQuality MeasureQuality<4>(const SimplexMesh<4>&, double, double, unsigned);

} // namespace voxplex
