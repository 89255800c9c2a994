// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Optimisation/Tetrahedra/VertexBoxes.h"

#include "Base/Error.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <stop_token>
#include <vector>

using namespace voxplex;

namespace
{

/** Points of a ball, denser in one half. */
std::vector<Point<3>> PointsOfBall(std::size_t number)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::vector<Point<3>> points;
  while (points.size() < number)
  {
    const Point<3> p = { unit(random), unit(random), unit(random) };
    if (p[0] * p[0] + p[1] * p[1] + p[2] * p[2] < 1.0)
    {
      points.push_back({ p[0] > 0.0 ? 9.0 * p[0] : p[0], p[1], p[2] });
    }
  }
  return points;
}

/** The number of a box along an axis. */
std::uint32_t Along(std::size_t axis, std::uint32_t box, std::uint32_t perAxis)
{
  for (; axis > 0; --axis)
  {
    box /= perAxis;
  }
  return box % perAxis;
}

//------------------------------------------------------------------------------------------------
TEST(VertexBoxes, HaveAboutAsManyVerticesBetweenPlanes)
{
  const std::vector<Point<3>> points = PointsOfBall(40000);
  const VertexBoxes boxes = DivideIntoBoxes(points, 4, false, 1, {});
  EXPECT_EQ(boxes.Number, 64u);
  ASSERT_EQ(boxes.OfVertex.size(), points.size());
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    std::vector<std::size_t> counts(4);
    for (const std::uint32_t box : boxes.OfVertex)
    {
      ASSERT_LT(box, boxes.Number);
      ++counts[Along(axis, box, 4)];
    }
    for (const std::size_t count : counts)
    {
      EXPECT_NEAR(static_cast<double>(count), 10000.0, 100.0) << axis;
    }
  }
}

// The planes of one division are far from those of the other.
TEST(VertexBoxes, ShiftedBoxesHaveOtherPlanes)
{
  std::vector<Point<3>> points;
  for (int i = 0; i < 1000; ++i)
  {
    points.push_back({ static_cast<double>(i), 0.0, 0.0 });
  }
  const auto usual = DivideIntoBoxes(points, 2, false, 1, {});
  const auto shifted = DivideIntoBoxes(points, 2, true, 1, {});
  EXPECT_EQ(shifted.Number, 27u);
  EXPECT_NE(usual.OfVertex[480], usual.OfVertex[520]);
  EXPECT_EQ(shifted.OfVertex[480], shifted.OfVertex[520]);
  EXPECT_EQ(usual.OfVertex[230], usual.OfVertex[270]);
  EXPECT_NE(shifted.OfVertex[230], shifted.OfVertex[270]);
  EXPECT_NE(shifted.OfVertex[730], shifted.OfVertex[770]);
}

TEST(VertexBoxes, DoNotDependOnThreads)
{
  const std::vector<Point<3>> points = PointsOfBall(50000);
  const std::vector<std::uint32_t> one = DivideIntoBoxes(points, 3, true, 1, {}).OfVertex;
  for (const unsigned threads : { 2u, 5u })
  {
    EXPECT_EQ(DivideIntoBoxes(points, 3, true, threads, {}).OfVertex, one);
  }
}

TEST(VertexBoxes, OfPointsInAPlaneAndOfNone)
{
  std::vector<Point<3>> points = PointsOfBall(1000);
  for (Point<3>& p : points)
  {
    p[1] = -2.5;
  }
  for (const std::uint32_t box : DivideIntoBoxes(points, 3, false, 1, {}).OfVertex)
  {
    ASSERT_LT(box, 27u);
    EXPECT_EQ(Along(1, box, 3), 0u);
  }
  EXPECT_TRUE(DivideIntoBoxes({}, 3, false, 1, {}).OfVertex.empty());
}

TEST(VertexBoxes, CanBeStopped)
{
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW(DivideIntoBoxes(PointsOfBall(10), 2, false, 1, stop.get_token()), Cancelled);
}

} // namespace
