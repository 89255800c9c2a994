// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Label images of the shapes of the thesis' table 2.2.
#ifndef voxplex_ImagePhantoms_h
#define voxplex_ImagePhantoms_h

#include "Phantom.h"

#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

namespace voxplex::phantoms
{

using ImagePhantom = PhantomOf<3>;

/** The voxels of one of the table's images, divided by `coarsening` along each axis. */
inline GridGeometry<3> CoarsenedGrid(
  std::int64_t nx, std::int64_t ny, std::int64_t nz, double spacing, std::int64_t coarsening)
{
  const double s = spacing * static_cast<double>(coarsening);
  return GridGeometry<3>::Orthogonal(
    { nx / coarsening, ny / coarsening, nz / coarsening }, { s, s, s });
}

/**
 * Label 1, a ball of radius 7.5 mm: 416^3 voxels of 0.04 mm. (The thesis speaks of a radius of 10 mm, but
 * these voxels span only 16.64 mm.)
 */
inline ImagePhantom SingleBall(std::int64_t coarsening = 1)
{
  return { CoarsenedGrid(416, 416, 416, 0.04, coarsening), [](const Point<3>& p) -> std::uint8_t {
            return Distance(p, { 8.3, 8.31, 8.29 }) < 7.5;
          } };
}

/**
 * Three labels in 634 x 416 x 416 voxels of 0.04 mm: a ball of radius 7.5 mm (1) with one of 3 mm in it (2), whose
 * surface comes as near as 1 mm to that of the first, and a small one of 0.75 mm apart (3). The thesis does
 * not say how large its balls are.
 */
inline ImagePhantom EmbeddedBalls(std::int64_t coarsening = 1)
{
  return { CoarsenedGrid(634, 416, 416, 0.04, coarsening),
    [](const Point<3>& p) -> std::uint8_t
    {
      if (Distance(p, { 11.8, 8.31, 8.29 }) < 3.0)
      {
        return 2;
      }
      if (Distance(p, { 8.3, 8.31, 8.29 }) < 7.5)
      {
        return 1;
      }
      return Distance(p, { 20.6, 8.31, 8.29 }) < 0.75 ? 3 : 0;
    } };
}

/** Label 1, a torus whose tube has radius 7 mm and whose hole has 3.5 mm: 147 x 147 x 67 voxels of 0.25 mm. */
inline ImagePhantom Torus(std::int64_t coarsening = 1)
{
  return { CoarsenedGrid(147, 147, 67, 0.25, coarsening),
    [](const Point<3>& p) -> std::uint8_t
    {
      const double ring = std::hypot(p[0] - 18.26, p[1] - 18.24) - 10.5;
      return std::hypot(ring, p[2] - 8.27) < 7.0;
    } };
}

} // namespace voxplex::phantoms

#endif
