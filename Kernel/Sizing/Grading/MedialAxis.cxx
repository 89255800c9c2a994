// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Sizing/Grading/MedialAxis.h"

#include "Parallel/ParallelFor.h"
#include "Sizing/Grading/SampleTriangulation.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace voxplex
{

namespace
{

constexpr std::size_t SimplicesAtOnce = 8192;

/** A Voronoi vertex of the sample: the circumball of a simplex. */
template <int D>
struct VoronoiVertex
{
  Point<D> Centre;
  double Radius2 = -1.0; ///< negative: the simplex does not exist
  bool IsMedial = false; ///< by its points of contact and its radius

  /** A strict order that does not depend on the numbers of the simplices. */
  bool IsFartherThan(const VoronoiVertex& other) const
  {
    return this->Radius2 != other.Radius2 ? this->Radius2 > other.Radius2
                                          : this->Centre > other.Centre;
  }
};

/**
 * Let phi be half the contact angle and R the radius. The planes that touch the ball meet at R /
 * cos(phi) from the centre.
 * @param longest2 squared length of the longest edge, (2 R sin(phi))^2
 */
bool IsMedialBall(double radius2, double longest2, const MedialBalls& which)
{
  const double sine2 = std::min(1.0, longest2 / (4.0 * radius2));
  const double cosine = std::sqrt(1.0 - sine2);
  const double bound = std::sin(which.ContactAngle * std::numbers::pi / 360.0);
  return radius2 <= which.LargestRadius * which.LargestRadius && sine2 >= bound * bound &&
    std::sqrt(radius2) * (1.0 - cosine) >= which.Salience * cosine;
}

/**
 * Whether a ball passes near all its points. In 4D many pentatopes are so flat that no ball
 * is certified. What such a ball is, depends on the displacements of the sample's points, so exact
 * arithmetic does not make it better, and takes two thirds of the time.
 */
template <int D>
bool PassesNear(const Circumball<D>& ball,
  const std::array<const Point<D>*, static_cast<std::size_t>(D) + 1>& points)
{
  constexpr double Tolerance = 1e-3;
  return std::all_of(points.begin(), points.end(),
    [&](const Point<D>* p)
    { return std::abs(Distance2(*p, ball.Center) - ball.Radius2) <= Tolerance * ball.Radius2; });
}

/** Takes the vertices in an order that does not depend on how the triangulation was made. */
template <int D>
VoronoiVertex<D> MakeVoronoiVertex(
  const Triangulation<D>& mesh, SimplexId s, const MedialBalls& which)
{
  std::array<const Point<D>*, static_cast<std::size_t>(D) + 1> points =
    mesh.Points(mesh.GetSimplex(s).V);
  std::sort(
    points.begin(), points.end(), [](const Point<D>* a, const Point<D>* b) { return *a < *b; });
  Circumball<D> ball;
  if (!ComputeCircumball<D>(points.data(), ball) && !(D == 4 && PassesNear<D>(ball, points)))
  {
    ComputeCircumballExactly<D>(points.data(), ball);
  }
  double longest2 = 0.0;
  for (unsigned i = 0; i <= D; ++i)
  {
    for (unsigned j = 0; j < i; ++j)
    {
      longest2 = std::max(longest2, Distance2(*points[i], *points[j]));
    }
  }
  return { ball.Center, ball.Radius2, IsMedialBall(ball.Radius2, longest2, which) };
}

/**
 * For each vertex, the farthest Voronoi vertex of its cell that passes the test; None if there is
 * none.
 */
template <int D, typename Admits>
std::vector<SimplexId> FarthestOfCells(
  const Triangulation<D>& mesh, const std::vector<VoronoiVertex<D>>& voronoi, Admits&& admits)
{
  std::vector<SimplexId> farthest(mesh.VertexIdEnd(), None);
  for (SimplexId s = 0; s < voronoi.size(); ++s)
  {
    if (voronoi[s].Radius2 < 0.0)
    {
      continue;
    }
    for (const VertexId v : mesh.GetSimplex(s).V)
    {
      if (admits(v, voronoi[s]) &&
        (farthest[v] == None || voronoi[s].IsFartherThan(voronoi[farthest[v]])))
      {
        farthest[v] = s;
      }
    }
  }
  return farthest;
}

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
std::vector<Point<D>> FindPoles(const std::vector<Point<D>>& sample, const MedialBalls& which,
  unsigned threads, const std::stop_token& stop)
{
  std::vector<Point<D>> poles;
  // A medial ball touches D + 1 points. So there is none for fewer points, and none if all points
  // are in one place. In the latter case LargestRadius, the margin of the box, may be 0, and there
  // is no box to triangulate.
  if (sample.size() < D + 1 || !(which.LargestRadius > 0.0))
  {
    return poles;
  }
  // With this margin no medial ball contains a corner of the box.
  const SampleTriangulation<D> triangulation(sample, 2.0 * which.LargestRadius, threads, stop);
  const Triangulation<D>& mesh = triangulation.Mesh();
  std::vector<VoronoiVertex<D>> voronoi(mesh.SimplexIdEnd());
  ParallelFor(
    0, voronoi.size(), SimplicesAtOnce, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t s = begin; s < end; ++s)
      {
        if (mesh.IsAlive(static_cast<SimplexId>(s)))
        {
          voronoi[s] = MakeVoronoiVertex(mesh, static_cast<SimplexId>(s), which);
        }
      }
    },
    stop);

  const std::vector<SimplexId> first =
    FarthestOfCells<D>(mesh, voronoi, [](VertexId, const VoronoiVertex<D>&) { return true; });
  ThrowIfStopped(stop);
  const std::vector<SimplexId> second = FarthestOfCells<D>(mesh, voronoi,
    [&](VertexId v, const VoronoiVertex<D>& vertex)
    {
      const Point<D>& z = mesh.Position(v);
      return Dot(Subtract(vertex.Centre, z), Subtract(voronoi[first[v]].Centre, z)) < 0.0;
    });
  for (VertexId v = 0; v < mesh.VertexIdEnd(); ++v)
  {
    for (const SimplexId s : { first[v], second[v] })
    {
      if (s != None && voronoi[s].IsMedial)
      {
        poles.push_back(voronoi[s].Centre);
      }
    }
  }
  std::sort(poles.begin(), poles.end());
  poles.erase(std::unique(poles.begin(), poles.end()), poles.end());
  return poles;
}

template std::vector<Point<3>> FindPoles<3>(
  const std::vector<Point<3>>&, const MedialBalls&, unsigned, const std::stop_token&);
template std::vector<Point<4>> FindPoles<4>(
  const std::vector<Point<4>>&, const MedialBalls&, unsigned, const std::stop_token&);

} // namespace voxplex
