// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PointTriangulation.h
 * @brief Points along a Hilbert curve, and their triangulation by one worker.
 */
#ifndef voxplex_PointTriangulation_h
#define voxplex_PointTriangulation_h

#include "Delaunay/Triangulation.h"
#include "Geometry/HilbertOrder.h"
#include "RandomPoints.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace voxplex::benchmarks
{

enum class Input
{
  Random,
  Lattice
};

/** n distinct points inside a cube of the given side, along a Hilbert curve. */
template <int D>
std::vector<Point<D>> MakePoints(std::size_t n, Input input, double side)
{
  const Box<D> cube = Cube<D>(side);
  std::vector<Point<D>> points;
  if (input == Input::Random)
  {
    points = RandomPoints<D>(n, cube);
  }
  else
  {
    points = RandomLatticePoints<D>(n, static_cast<int>(side) - 1);
    for (Point<D>& p : points)
    {
      for (double& x : p)
      {
        x += 1.0; // off the box
      }
    }
  }
  std::sort(points.begin(), points.end(),
    [&](const Point<D>& a, const Point<D>& b)
    { return std::pair(HilbertIndex<D>(a, cube), a) < std::pair(HilbertIndex<D>(b, cube), b); });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

/** A triangulation with its worker. */
template <int D>
struct Instance
{
  Triangulation<D> Delaunay;
  typename Triangulation<D>::Worker Worker;
  std::vector<VertexId> Vertices;

  explicit Instance(const Box<D>& box)
    : Delaunay(box)
    , Worker(Delaunay)
  {
  }

  bool Insert(const std::vector<Point<D>>& points)
  {
    SimplexId hint = 0;
    this->Vertices.reserve(points.size());
    for (const Point<D>& p : points)
    {
      const SimplexId seed = this->Delaunay.FindConflict(this->Worker, p, hint);
      if (this->Delaunay.Insert(this->Worker, p, VertexKind::Free, seed) !=
        InsertionOutcome::Inserted)
      {
        return false;
      }
      this->Vertices.push_back(this->Worker.NewVertex);
      hint = this->Worker.Created.Back();
    }
    return true;
  }

  bool Remove(const std::vector<VertexId>& vertices)
  {
    return std::all_of(vertices.begin(), vertices.end(),
      [this](VertexId v)
      { return this->Delaunay.Remove(this->Worker, v) == RemovalOutcome::Removed; });
  }
};

/** The side of a cube in which points use about two out of three lattice points. */
template <int D>
double SideFor(std::size_t n, Input input)
{
  return input == Input::Random ? 1.0 : std::ceil(std::pow(static_cast<double>(n), 1.0 / D)) + 1.0;
}

} // namespace voxplex::benchmarks

#endif
