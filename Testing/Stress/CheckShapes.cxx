// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Bounds of shapes, as far as they are promised: see Algorithm.md, "Rules" and "Optimisation after refinement".
#include "Checks.h"

#include <algorithm>
#include <map>
#include <set>
#include <string>

namespace voxplex::stress
{

namespace
{

/** Rounding of ratios and angles. */
constexpr Real Rounding = 1e-6;

/** An element whose volume is below this times the power of its circumradius is flat to rounding. */
constexpr Real FlatVolume = 1e-12;

/** Dihedral angles that the optimiser regards as poor, degrees. */
constexpr Real SmallestDihedral = 18;
constexpr Real LargestDihedral = 150;

/** The number of elements that break a bound, and the worst of them. */
struct Breaches
{
  std::uint64_t Count = 0;
  Real Worst = 0;

  void Note(Real value, bool larger)
  {
    this->Worst = this->Count++ == 0 ? value
      : larger                       ? std::max(this->Worst, value)
                                     : std::min(this->Worst, value);
  }

  void Report(const std::string& cause, std::uint64_t excused, Real bound, Findings& findings) const
  {
    if (this->Count > excused)
    {
      findings.Add(cause,
        std::to_string(this->Count) + " (" + std::to_string(excused) + " excused), the worst has " +
          Text(static_cast<double>(this->Worst)) + ", the bound is " +
          Text(static_cast<double>(bound)));
    }
  }
};

template <int D>
bool IsOptimised(const StressCase<D>& of)
{
  return D == 3 && of.Options.Optimisation.Run;
}

//------------------------------------------------------------------------------------------------
template <int D>
void CheckRatios(const Subject<D>& subject, Findings& findings)
{
  const bool optimised = IsOptimised(subject.Of);
  const Real bound = optimised
    ? std::max(OptimisedRadiusEdgeRatio, subject.Of.Options.Shape.RadiusEdgeRatio)
    : subject.Of.Options.Shape.RadiusEdgeRatio;
  Breaches ratios;
  Breaches sizes;
  for (std::size_t s = 0; s < subject.Mesh.Simplices.size(); ++s)
  {
    const auto corners = subject.Corners(s);
    std::array<Real, static_cast<std::size_t>(D)> centre;
    const Real radius = CircumcentreOf<D>(corners, centre);
    const Real ratio = radius / ShortestEdgeOf<D>(corners);
    // The kernel cannot know the ratio of a sliver that is flat to rounding. Slivers stay if nobody
    // fights them.
    const bool isFlat = VolumeOf<D>(corners) < FlatVolume * std::pow(radius, D);
    if (!(ratio <= bound * (1 + Rounding)) && !isFlat)
    {
      ratios.Note(ratio, true);
    }
    const Real size = std::max<Real>(subject.Stats.SizesRaisedTo,
      subject.Of.Size.At(static_cast<double>(centre[0]), subject.Mesh.Labels[s]));
    if (!optimised && radius > size * (1 + Rounding))
    {
      sizes.Note(radius / size, true);
    }
  }
  const std::uint64_t excused =
    optimised ? subject.Stats.Optimisation.PoorAfter : subject.Excused();
  ratios.Report("ratio", excused, bound, findings);
  sizes.Report("size", excused, 1, findings);
}

//------------------------------------------------------------------------------------------------
/** Checks the statistics of optimisation, and slivers if it did not run. */
void CheckDihedralAngles(const Subject<3>& subject, Findings& findings)
{
  const OptimisationSummary& said = subject.Stats.Optimisation;
  const Real bound = subject.Of.Options.Shape.Slivers.Angle;
  Real smallest = 180;
  Real largest = 0;
  std::uint64_t poor = 0;
  Breaches slivers;
  for (std::size_t s = 0; s < subject.Mesh.Simplices.size(); ++s)
  {
    const std::array<Real, 2> angles = DihedralAnglesOf(subject.Corners(s));
    smallest = std::min(smallest, angles[0]);
    largest = std::max(largest, angles[1]);
    poor += angles[0] < SmallestDihedral - Rounding || angles[1] > LargestDihedral + Rounding;
    if (angles[0] < bound - Rounding || angles[1] > 180 - bound + Rounding)
    {
      slivers.Note(std::min(angles[0], 180 - angles[1]), false);
    }
  }
  if (!subject.Of.Options.Optimisation.Run)
  {
    slivers.Report("sliver", subject.Stats.Rules.SliversKept + subject.Excused(), bound, findings);
    return;
  }
  if (subject.Mesh.Simplices.empty())
  {
    return;
  }
  if (std::abs(smallest - Real(said.SmallestDihedralAfter)) > 1e-3 ||
    std::abs(largest - Real(said.LargestDihedralAfter)) > 1e-3)
  {
    findings.Add("statistics",
      "dihedral angles are from " + Text(double(smallest)) + " to " + Text(double(largest)) +
        ", optimisation says from " + Text(said.SmallestDihedralAfter) + " to " +
        Text(said.LargestDihedralAfter));
  }
  if (poor > said.PoorAfter)
  {
    findings.Add("statistics",
      std::to_string(poor) + " elements have poor angles, optimisation says " +
        std::to_string(said.PoorAfter));
  }
}

//------------------------------------------------------------------------------------------------
/**
 * Checks the angles of facets between labels. A facet with a vertex at a junction may have smaller
 * angles.
 */
void CheckFacetAngles(const Subject<3>& subject, Findings& findings)
{
  const SimplexMesh<3>& mesh = subject.Mesh;
  std::map<std::uint32_t, std::set<std::int64_t>> labels;
  for (std::size_t f = 0; f < mesh.Facets.size(); ++f)
  {
    for (const std::uint32_t v : mesh.Facets[f])
    {
      labels[v].insert(mesh.FacetLabels[f].begin(), mesh.FacetLabels[f].end());
    }
  }
  const Real bound = subject.Of.Options.Shape.FacetAngle;
  Breaches angles;
  for (const auto& f : mesh.Facets)
  {
    const Real angle = SmallestAngleOf(mesh.Points[f[0]], mesh.Points[f[1]], mesh.Points[f[2]]);
    const bool atJunction =
      std::any_of(f.begin(), f.end(), [&](std::uint32_t v) { return labels[v].size() > 2; });
    if (!atJunction && angle < bound - Rounding)
    {
      angles.Note(angle, false);
    }
  }
  // Optimisation replaces an angle by a larger one, or by one above the bound.
  angles.Report("facet-angle", subject.Excused(), bound, findings);
}

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
void CheckShapes(const Subject<D>& subject, Findings& findings)
{
  CheckRatios(subject, findings);
  if constexpr (D == 3)
  {
    CheckDihedralAngles(subject, findings);
    CheckFacetAngles(subject, findings);
  }
}

template void CheckShapes<3>(const Subject<3>&, Findings&);
template void CheckShapes<4>(const Subject<4>&, Findings&);

} // namespace voxplex::stress
