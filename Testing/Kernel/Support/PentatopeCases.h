// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Meshes of pentatopes for tests of their optimisation.
#ifndef voxplex_PentatopeCases_h
#define voxplex_PentatopeCases_h

#include "ComplexOf.h"
#include "Geometry/SimplexQuality.h"
#include "Optimisation/Patch.h"
#include "Optimisation/Pentatopes/PentatopeRules.h"
#include "SpaceTimeCases.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
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

/** Replaces pentatopes of one label. @param added takes the place of None in new ones */
inline bool Replace(PentatopeComplex& complex, Patch<4>& patch, std::span<const std::uint32_t> old,
  std::span<const PentatopeComplex::Vertices> vertices, std::uint32_t added = None)
{
  std::vector<NewCell<4>> fresh;
  for (PentatopeComplex::Vertices v : vertices)
  {
    std::replace(v.begin(), v.end(), None, added);
    fresh.push_back({ v, complex.LabelOf(old.front()) });
  }
  patch.NeedSlots(fresh.size());
  return patch.Replace(old, fresh);
}

/** Inserts a vertex at a place. */
inline std::uint32_t AddVertex(PentatopeComplex& complex, const Point<4>& place)
{
  complex.AddVertices(1);
  complex.Points.back() = place;
  return static_cast<std::uint32_t>(complex.Points.size() - 1);
}

} // namespace voxplex::checks

#endif
