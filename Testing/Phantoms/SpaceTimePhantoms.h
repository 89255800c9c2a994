// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Space-time label images of known shapes, for tests, benchmarks and examples.
#ifndef voxplex_SpaceTimePhantoms_h
#define voxplex_SpaceTimePhantoms_h

#include "Phantom.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <numbers>
#include <utility>
#include <vector>

namespace voxplex::phantoms
{

using SpaceTimePhantom = PhantomOf<4>;

/** The same phantom where a unit of time is as long as `scale` units of length. */
inline SpaceTimePhantom WithTimeScale(SpaceTimePhantom phantom, double scale)
{
  phantom.Grid.IndexToFrame[3][3] *= scale;
  phantom.Label = [label = std::move(phantom.Label), scale](const Point<4>& p) {
    return label({ p[0], p[1], p[2], p[3] / scale });
  };
  return phantom;
}

/** A 4-ball of label 1 around the centre of a grid of unit spacing, away from its border. */
inline SpaceTimePhantom FourBall(double radius)
{
  const std::int64_t n = static_cast<std::int64_t>(2 * radius) + 8;
  const double c = 0.5 * static_cast<double>(n - 1);
  return { GridGeometry<4>::Orthogonal({ n, n, n, n }, { 1.0, 1.0, 1.0, 1.0 }),
    [=](const Point<4>& p) -> std::uint8_t {
      return Distance(p, { c, c, c, c }) < radius;
    } };
}

/**
 * A left ventricle that beats once: label 1 is the blood, 2 the myocardium around it; both are cut
 * by a plane at the base. Of the size of the thesis' patients: 100 x 100 x 44 x 15 voxels of
 * 1.77 x 1.77 x 6 mm, one frame a unit of time.
 *
 * @param coarsening 2 halves the number of voxels along x, y and z, and so on
 */
inline SpaceTimePhantom BeatingVentricle(std::int64_t coarsening = 1)
{
  const double s = static_cast<double>(coarsening);
  const GridGeometry<4> grid =
    GridGeometry<4>::Orthogonal({ 100 / coarsening, 100 / coarsening, 44 / coarsening, 15 },
      { 1.77 * s, 1.77 * s, 6.0 * s, 1.0 });
  constexpr double Duration = 14.0;
  return { grid,
    [](const Point<4>& p) -> std::uint8_t
    {
      // Contracts and relaxes; the muscle thickens meanwhile.
      const double sine = std::sin(std::numbers::pi * p[3] / Duration);
      const double squeeze = sine * sine;
      const double inner = 30.0 - 9.0 * squeeze;
      const double outer = 42.0 - 5.0 * squeeze;
      const double apex = 84.0 - 8.0 * squeeze;
      constexpr double Base = 153.0; // between two layers of voxels
      const double x = p[0] - 87.0;
      const double y = p[1] - 89.0;
      const double z = p[2] - 128.0;
      if (p[2] > Base)
      {
        return 0;
      }
      const double r2 = x * x + y * y;
      const double endocardium = r2 / (inner * inner) + z * z / ((apex - 12.0) * (apex - 12.0));
      const double epicardium = r2 / (outer * outer) + z * z / (apex * apex);
      return endocardium < 1.0 ? 1 : epicardium < 1.0 ? 2 : 0;
    } };
}

/** Two balls of labels 1 and 2 that come near, merge and part again: topology changes in time. */
inline SpaceTimePhantom MergingBalls(std::int64_t frames = 17)
{
  const GridGeometry<4> grid =
    GridGeometry<4>::Orthogonal({ 48, 28, 28, frames }, { 1.0, 1.0, 1.0, 1.0 });
  const double duration = static_cast<double>(frames - 1);
  return { grid,
    [=](const Point<4>& p) -> std::uint8_t
    {
      // Half the distance of the centres: 13, then 6, then 13 again; the radius is 8.
      const double half = 9.5 + 3.5 * std::cos(2.0 * std::numbers::pi * p[3] / duration);
      const double left = std::hypot(p[0] - (23.5 - half), p[1] - 13.5, p[2] - 13.5);
      const double right = std::hypot(p[0] - (23.5 + half), p[1] - 13.5, p[2] - 13.5);
      return std::min(left, right) >= 8.0 ? 0 : left < right ? 1 : 2;
    } };
}

/**
 * A sheet of label 1, 3 voxels thick, that turns about its long axis: by a quarter in all. It moves
 * by up to 1.6 voxels a frame.
 */
inline SpaceTimePhantom RotatingSheet(std::int64_t frames = 15)
{
  const GridGeometry<4> grid =
    GridGeometry<4>::Orthogonal({ 36, 36, 28, frames }, { 1.0, 1.0, 1.0, 1.0 });
  const double duration = static_cast<double>(frames - 1);
  return { grid,
    [=](const Point<4>& p) -> std::uint8_t
    {
      const double angle = 0.3 + 0.5 * std::numbers::pi * p[3] / duration;
      const double x = p[0] - 17.5;
      const double y = p[1] - 17.5;
      const double across = std::cos(angle) * x + std::sin(angle) * y;
      const double along = std::cos(angle) * y - std::sin(angle) * x;
      return std::abs(across) < 1.5 && std::abs(along) < 14.0 && std::abs(p[2] - 13.5) < 10.0;
    } };
}

/**
 * A tube that opens and closes: label 1 is the wall, 2 the lumen. At the first and the last frame
 * there is no lumen. The wall keeps its cross-section.
 */
inline SpaceTimePhantom OpeningTube(std::int64_t frames = 15)
{
  const GridGeometry<4> grid =
    GridGeometry<4>::Orthogonal({ 32, 32, 34, frames }, { 1.0, 1.0, 1.0, 1.0 });
  const double duration = static_cast<double>(frames - 1);
  return { grid,
    [=](const Point<4>& p) -> std::uint8_t
    {
      const double inner = 8.0 * std::sin(std::numbers::pi * p[3] / duration) - 1.0;
      const double outer = std::sqrt(81.0 + std::max(inner, 0.0) * std::max(inner, 0.0));
      const double r = std::hypot(p[0] - 15.5, p[1] - 15.5);
      return std::abs(p[2] - 16.5) > 13.0 || r >= outer ? 0 : r < inner ? 2 : 1;
    } };
}

/** A large ball (label 1, radius 20) that rests, and a small one (label 2, radius 5) that moves past it. */
inline SpaceTimePhantom SmallAndLarge(std::int64_t frames = 13)
{
  const GridGeometry<4> grid =
    GridGeometry<4>::Orthogonal({ 58, 46, 46, frames }, { 1.0, 1.0, 1.0, 1.0 });
  return { grid,
    [](const Point<4>& p) -> std::uint8_t
    {
      const bool isLarge = std::hypot(p[0] - 22.5, p[1] - 22.5, p[2] - 22.5) < 20.0;
      const double y = 16.0 + 1.1 * p[3];
      return isLarge ? 1 : std::hypot(p[0] - 50.0, p[1] - y, p[2] - 22.5) < 5.0 ? 2 : 0;
    } };
}

/** A ball of label 1, radius 7, that moves 4 voxels a frame there and back. */
inline SpaceTimePhantom FastBall(std::int64_t frames = 17)
{
  const GridGeometry<4> grid =
    GridGeometry<4>::Orthogonal({ 56, 24, 24, frames }, { 1.0, 1.0, 1.0, 1.0 });
  const double middle = 0.5 * static_cast<double>(frames - 1);
  return { grid,
    [=](const Point<4>& p) -> std::uint8_t
    {
      const double x = 11.5 + 4.0 * (middle - std::abs(p[3] - middle));
      return std::hypot(p[0] - x, p[1] - 11.5, p[2] - 11.5) < 7.0;
    } };
}

} // namespace voxplex::phantoms

#endif
