// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Refinement/Rules/PlaneLabels.h"

#include "Geometry/Circumball.h"

#include <algorithm>

namespace voxplex
{

Point<4> CentreOnPlane(const Triangulation<4>& mesh, const FacetVertices& facet)
{
  std::array<Point<3>, 4> corners;
  for (std::size_t k = 0; k < 4; ++k)
  {
    const Point<4>& p = mesh.Position(facet[k]);
    corners[k] = { p[0], p[1], p[2] };
  }
  // The same arithmetic from both sides.
  std::sort(corners.begin(), corners.end());
  std::array<const Point<3>*, 4> points = { &corners[0], &corners[1], &corners[2], &corners[3] };
  Circumball<3> ball;
  if (!ComputeCircumball<3>(points.data(), ball))
  {
    ComputeCircumballExactly<3>(points.data(), ball);
  }
  return { ball.Center[0], ball.Center[1], ball.Center[2], mesh.Position(facet[0])[3] };
}

} // namespace voxplex
