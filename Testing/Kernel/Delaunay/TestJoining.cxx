// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// The union of triangulations of boxes with common faces.
#include "Delaunay/Triangulation.h"
#include "Geometry/SimplexQuality.h"
#include "TriangulationChecks.h"

#include <gtest/gtest.h>

#include <random>
#include <stdexcept>
#include <vector>

using namespace voxplex;

namespace
{

void Fill(Triangulation<4>& mesh, const std::vector<Point<4>>& points)
{
  Triangulation<4>::Worker worker(mesh);
  for (const Point<4>& p : points)
  {
    ASSERT_EQ(checks::Insert(mesh, worker, p), InsertionOutcome::Inserted);
  }
}

std::vector<Point<4>> RandomPoints(std::mt19937& random, std::size_t n, double first, double last)
{
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<Point<4>> points(n);
  for (Point<4>& p : points)
  {
    p = { unit(random), unit(random), unit(random), first + (last - first) * unit(random) };
  }
  return points;
}

constexpr Box<4> Lower{ { 0.0, 0.0, 0.0, 0.0 }, { 1.0, 1.0, 1.0, 0.7 } };
constexpr Box<4> Upper{ { 0.0, 0.0, 0.0, 0.7 }, { 1.0, 1.0, 1.0, 1.5 } };
constexpr Box<4> Both{ { 0.0, 0.0, 0.0, 0.0 }, { 1.0, 1.0, 1.0, 1.5 } };

} // namespace

TEST(Joining, UnionFillsTheBoxAndNeighboursAreMutual)
{
  std::mt19937 random(4);
  const std::vector<Point<4>> common = RandomPoints(random, 40, 0.7, 0.7);
  Triangulation<4> lower(Lower);
  Triangulation<4> upper(Upper);
  Fill(lower, RandomPoints(random, 60, 0.0, 0.7));
  Fill(lower, common);
  Fill(upper, { common.rbegin(), common.rend() }); // the order does not matter
  Fill(upper, RandomPoints(random, 60, 0.7, 1.5));

  Triangulation<4> mesh(Both);
  for (int round = 0; round < 2; ++round) // the second time it replaces a union
  {
    const Triangulation<4>* const parts[] = { &lower, &upper };
    mesh.Join(parts);
    double volume = 0.0;
    std::size_t vertices = 0;
    for (VertexId v = 0; v < mesh.VertexIdEnd(); ++v)
    {
      vertices += mesh.GetVertex(v).Alive ? 1 : 0;
    }
    EXPECT_EQ(vertices, 24u + 160u); // 8 of the corners and 40 points are common
    for (const SimplexId s : checks::AliveIn(mesh))
    {
      const auto& simplex = mesh.GetSimplex(s);
      volume += SignedVolume<4>(mesh.Points(simplex.V).data());
      for (unsigned i = 0; i < 5; ++i)
      {
        const SimplexId n = simplex.N[i];
        std::size_t onBox = 0;
        for (std::size_t a = 0; a < 4; ++a)
        {
          for (const double side : { Both.Min[a], Both.Max[a] })
          {
            bool isOn = true;
            for (unsigned k = 0; k < 5; ++k)
            {
              isOn = isOn && (k == i || mesh.Position(simplex.V[k])[a] == side);
            }
            onBox += isOn ? 1 : 0;
          }
        }
        ASSERT_EQ(n == None, onBox > 0);
        if (n != None)
        {
          const auto& back = mesh.GetSimplex(n).N;
          ASSERT_EQ(std::count(back.begin(), back.end(), s), 1);
        }
      }
    }
    EXPECT_NEAR(volume, 1.5, 1e-9); // SignedVolume() of a simplex is its volume
  }
}

TEST(Joining, RefusesFacesThatDiffer)
{
  std::mt19937 random(5);
  Triangulation<4> lower(Lower);
  Triangulation<4> upper(Upper);
  Fill(lower, RandomPoints(random, 10, 0.7, 0.7));
  const Triangulation<4>* const parts[] = { &lower, &upper };
  Triangulation<4> mesh(Both);
  EXPECT_THROW(mesh.Join(parts), std::logic_error);
}
