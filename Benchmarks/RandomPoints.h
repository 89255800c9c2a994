// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RandomPoints.h
 * @brief Points for benchmarks, the same in every run.
 */
#ifndef voxplex_RandomPoints_h
#define voxplex_RandomPoints_h

#include "Geometry/Box.h"
#include "Geometry/Point.h"

#include <cstddef>
#include <random>
#include <vector>

namespace voxplex::benchmarks
{

/** n points, uniformly distributed in a box. */
template <int D>
std::vector<Point<D>> RandomPoints(std::size_t n, const Box<D>& box, unsigned seed = 1)
{
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<Point<D>> points(n);
  for (Point<D>& p : points)
  {
    for (std::size_t axis = 0; axis < p.size(); ++axis)
    {
      p[axis] = box.Min[axis] + uniform(generator) * (box.Max[axis] - box.Min[axis]);
    }
  }
  return points;
}

/** n points of the lattice of integers from 0 to `side` - 1. Many of them are co-spherical. */
template <int D>
std::vector<Point<D>> RandomLatticePoints(std::size_t n, int side, unsigned seed = 1)
{
  std::mt19937_64 generator(seed);
  std::uniform_int_distribution<int> uniform(0, side - 1);
  std::vector<Point<D>> points(n);
  for (Point<D>& p : points)
  {
    for (double& x : p)
    {
      x = uniform(generator);
    }
  }
  return points;
}

/** The box from the origin to (side, ..., side). */
template <int D>
Box<D> Cube(double side)
{
  Box<D> cube;
  cube.Min.fill(0.0);
  cube.Max.fill(side);
  return cube;
}

} // namespace voxplex::benchmarks

#endif
