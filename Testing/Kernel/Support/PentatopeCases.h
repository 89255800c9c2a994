// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Meshes of pentatopes for tests of their optimisation.
#ifndef voxplex_PentatopeCases_h
#define voxplex_PentatopeCases_h

#include "Geometry/SimplexQuality.h"
#include "Optimisation/PentatopeComplex.h"
#include "SpaceTimeCases.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace voxplex::checks
{

struct Result
{
  SimplexMesh<4> Mesh;
  MeshingStatistics Statistics;
};

inline Result Mesh(const LabelImage<4>& image, MeshingOptions<4> options, bool optimise)
{
  options.Optimisation.Run = optimise;
  Result result;
  result.Mesh = MeshOf(image, options, &result.Statistics);
  return result;
}

inline MeshingOptions<4> UsualOptions(double delta)
{
  MeshingOptions<4> options = SpaceTimeOptions(delta);
  options.Interfaces.Fit = true;
  options.SpaceTime.Slivers.Fight = true;
  return options;
}

/** Six points; the pentatope `left` is without one of them. Positively oriented. */
inline PentatopeComplex::Vertices Without(const std::vector<Point<4>>& points, std::uint32_t left)
{
  PentatopeComplex::Vertices v{};
  for (std::uint32_t k = 0, m = 0; k < 6; ++k)
  {
    if (k != left)
    {
      v[m++] = k;
    }
  }
  std::array<const Point<4>*, 5> corners;
  std::transform(v.begin(), v.end(), corners.begin(), [&](std::uint32_t x) { return &points[x]; });
  if (SignedVolume<4>(corners.data()) < 0.0)
  {
    std::swap(v[0], v[1]);
  }
  return v;
}

} // namespace voxplex::checks

#endif
