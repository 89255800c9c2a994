// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Space-time images for tests of whole meshes, and what every mesh of them must be.
#ifndef voxplex_SpaceTimeCases_h
#define voxplex_SpaceTimeCases_h

#include "../../Phantoms/SpaceTimePhantoms.h"
#include "Domain/ImageDomain.h"
#include "MeshRuns.h"
#include "SpaceTimeChecks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace voxplex::checks
{

/**
 * A ball of radius 8 in space, all the time, that grows and shrinks by `swing`: label 2, within it label 1
 * up to radius 4. 24 units wide; `duration` long.
 */
inline phantoms::SpaceTimePhantom PulsatingBalls(GridGeometry<4> grid, double swing)
{
  const auto half = [&](std::size_t axis)
  { return 0.5 * static_cast<double>(grid.Dimensions[axis] - 1); };
  const Point<4> centre = grid.ToFrame({ half(0), half(1), half(2), 0.0 });
  const double duration = 2.0 * half(3) * grid.IndexToFrame[3][3];
  return { grid,
    [=](const Point<4>& p) -> std::uint8_t
    {
      const double r = std::hypot(p[0] - centre[0], p[1] - centre[1], p[2] - centre[2]);
      const double outer = 8.0 + swing * std::sin(2.0 * std::numbers::pi * p[3] / duration);
      return r < 0.5 * outer ? 1 : r < outer ? 2 : 0;
    } };
}

/** Frames of unit voxels: `frames` of them, `timeScale` apart. */
inline phantoms::SpaceTimePhantom PulsatingBalls(
  std::int64_t frames, double timeScale, double swing = 1.0)
{
  return PulsatingBalls(
    GridGeometry<4>::Orthogonal({ 24, 24, 24, frames }, { 1.0, 1.0, 1.0, timeScale }), swing);
}

inline LabelImage<4> ImageOf(const phantoms::SpaceTimePhantom& phantom)
{
  return LabelImage<4>::FromScalars<std::uint8_t>(phantom.Scalars(), phantom.Grid);
}

/** Picking regions are off: they have tests of their own. */
inline MeshingOptions<4> SpaceTimeOptions(double delta, unsigned threads = 1)
{
  MeshingOptions<4> options = WithDelta<4>(delta);
  options.Team.Threads = threads;
  options.SpaceTime.Slivers.Fight = false;
  // So that vertices are on interfaces, which are those of the image itself.
  options.Interfaces.Fit = false;
  options.FrameSteps = 1;
  return options;
}

/** By how much a mesh may fall short of perfection. */
struct Tolerances
{
  double RadiusEdge = 2.0;
  double FacetsOffInterface = 0.0; ///< share of the lateral facets
  bool VertexLinks = true;         ///< are spheres in boundaries, away from junctions
};

/** What holds of every mesh of an image, with all options. */
inline void ExpectGood(
  const SimplexMesh<4>& mesh, const LabelImage<4>& image, const Tolerances& tolerances = {})
{
  ExpectSound(mesh);
  ASSERT_FALSE(mesh.Simplices.empty());
  EXPECT_EQ(Volumes(mesh).size(), static_cast<std::size_t>(image.NumberOfLabels()));
  for (std::size_t s = 0; s < mesh.Simplices.size(); ++s)
  {
    ASSERT_LT(RadiusEdge(mesh, s), tolerances.RadiusEdge + 1e-9);
  }
  // Theorem 4.2 of the thesis: boundaries are closed 3-manifolds. Parts may touch at a vertex or an edge.
  const ManifoldDefects defects = FindManifoldDefects(mesh);
  EXPECT_EQ(defects.Triangles, 0u);
  EXPECT_TRUE(!tolerances.VertexLinks || defects.Vertices == 0) << defects.Vertices;
  const ImageDomain<4> domain(image, 1.0);
  const std::size_t lateral = LateralFacets(mesh, domain).size();
  EXPECT_GT(lateral, 0u);
  EXPECT_LE(static_cast<double>(CountFacetsOffInterface(mesh, domain)),
    tolerances.FacetsOffInterface * static_cast<double>(lateral));

  // Flat ends: exactly at the frames, and all of the mesh there ends with facets.
  const double last =
    static_cast<double>(image.Grid().Dimensions[3] - 1) * image.Grid().IndexToFrame[3][3];
  const auto [from, to] = TimeSpan(mesh);
  const double moment = 1e-9 * last;
  for (const unsigned end : { 0u, 1u })
  {
    const double time = end == 0 ? 0.0 : last;
    if (!image.ReachesBorderInTime(end))
    {
      EXPECT_GT(std::abs((end == 0 ? from : to) - time), 0.0);
      EXPECT_TRUE(EndVolumes(mesh, time).empty());
      continue;
    }
    EXPECT_EQ(end == 0 ? from : to, time);
    const auto slices = SliceVolumes(mesh, end == 0 ? time + moment : time - moment);
    const auto ends = EndVolumes(mesh, time);
    EXPECT_EQ(slices.size(), ends.size());
    for (const auto& [label, volume] : slices)
    {
      ASSERT_EQ(ends.count(label), 1u);
      EXPECT_NEAR(ends.at(label), volume, 1e-6 * volume) << "label " << label << ", end " << end;
    }
  }
  EXPECT_GE(from, 0.0);
  EXPECT_LE(to, last);
}

} // namespace voxplex::checks

#endif
