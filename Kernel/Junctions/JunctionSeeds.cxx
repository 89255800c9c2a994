// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Junctions/JunctionSeeds.h"

#include "Refinement/Rules/FeatureGrid.h"

#include <algorithm>
#include <cmath>

namespace voxplex
{

namespace
{

// Chosen on the knee and AAL atlases: a smaller distance of points makes more elements, a larger
// one worse curves.

/** Approximate arc length between points, in delta. */
constexpr double ArcLength = 1.2;

/** Smallest distance between two points, in delta. */
constexpr double Clearance = 0.75;

/**
 * Closed curves shorter than this, in arc lengths, are left out: they surround a part smaller than
 * delta.
 */
constexpr std::size_t ShortestLoop = 4;

/** Visits points in equal steps along a curve, without its ends. */
template <typename Function>
void WalkAlong(const JunctionCurves::Curve& curve, const JunctionDelta& delta, Function&& visit)
{
  const std::size_t n = curve.Points.size();
  const std::size_t pieces = curve.IsClosed ? n : n - 1;
  const auto after = [&](std::size_t i) { return curve.Points[i + 1 < n ? i + 1 : 0]; };
  std::vector<double> steps{ 0.0 }; // number of steps from the beginning
  for (std::size_t i = 0; i < pieces; ++i)
  {
    const Point<3>& a = curve.Points[i];
    const Point<3> b = after(i);
    const double step = ArcLength * delta(Interpolate(a, b, 0.5), curve.Labels);
    steps.push_back(steps.back() + Distance(a, b) / step);
  }
  const auto count = static_cast<std::size_t>(std::round(steps.back()));
  if (curve.IsClosed && count < ShortestLoop)
  {
    return;
  }
  std::size_t i = 0;
  for (std::size_t k = curve.IsClosed ? 0 : 1; k < count; ++k)
  {
    const double at = static_cast<double>(k) * steps.back() / static_cast<double>(count);
    while (i + 2 < steps.size() && steps[i + 1] < at)
    {
      ++i;
    }
    const double piece = steps[i + 1] - steps[i];
    visit(Interpolate(curve.Points[i], after(i), piece > 0.0 ? (at - steps[i]) / piece : 0.0));
  }
}

} // namespace

//------------------------------------------------------------------------------------------------
std::vector<FeatureSeed<3>> SampleJunctions(
  const JunctionCurves& junctions, const JunctionDelta& delta, double largest)
{
  std::vector<FeatureSeed<3>> seeds;
  FeatureGrid<3> taken({ 0.0, 0.0, 0.0 }, largest, junctions.Curves().size());
  const auto take = [&](const Point<3>& p, double own)
  {
    if (!taken.AnyWithin(p, Clearance * own))
    {
      taken.Add(p);
      seeds.push_back({ p, Clearance * own });
    }
  };
  // Corners come first, so that points near corners are left out, not the corners.
  for (const JunctionCurves::Curve& curve : junctions.Curves())
  {
    if (!curve.IsClosed)
    {
      take(curve.Points.front(), delta(curve.Points.front(), curve.Labels));
      take(curve.Points.back(), delta(curve.Points.back(), curve.Labels));
    }
  }
  for (const JunctionCurves::Curve& curve : junctions.Curves())
  {
    WalkAlong(curve, delta, [&](const Point<3>& p) { take(p, delta(p, curve.Labels)); });
  }
  return seeds;
}

} // namespace voxplex
