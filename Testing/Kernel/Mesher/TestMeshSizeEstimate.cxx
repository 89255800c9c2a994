// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// The estimate does not depend on threads and can be stopped; TestImageMesher.cxx compares it with
// meshes.
#include "Base/Error.h"
#include "Mesher/MeshSizeEstimate.h"
#include "Phantoms.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>

using namespace voxplex;

namespace
{

/** Sizes that differ from voxel to voxel; requests a stop in one of the calls. */
class Sizes final : public SizeFunction<3>
{
public:
  double Evaluate(const Point<3>& p, std::int64_t) const override
  {
    if (++this->Calls == this->StopAt)
    {
      this->Stop.request_stop();
    }
    return 0.1 + 0.01 * std::abs(std::sin(p[0] + 10.0 * p[1] + 100.0 * p[2]));
  }

  std::size_t StopAt = 0;
  mutable std::atomic<std::size_t> Calls = 0;
  mutable std::stop_source Stop;
};

constexpr double Radius =
  40.0; ///< of the outer of three nested balls: more rows and samples than one chunk

/** 1 / size^3 summed over all voxels of the balls; no size is below the floor. */
double BallsInBalls(const Sizes& sizes, double floor)
{
  const double c = Radius + 3.5; // as phantoms::NestedBalls has it
  double sum = 0.0;
  for (double z = 0.0; z <= 2.0 * c; ++z)
  {
    for (double y = 0.0; y <= 2.0 * c; ++y)
    {
      for (double x = 0.0; x <= 2.0 * c; ++x)
      {
        if (Distance<3>({ x, y, z }, { c, c, c }) < Radius)
        {
          sum += std::pow(std::max(sizes.Evaluate({ x, y, z }, 1), floor), -3.0);
        }
      }
    }
  }
  return sum;
}

} // namespace

TEST(MeshSizeEstimate, DoesNotDependOnThreads)
{
  const LabelImage<3> image = phantoms::NestedBalls(Radius);
  // Three spheres, the inner two with a third and two thirds of the radius; delta is 1.
  const double area = 4.0 * std::numbers::pi * Radius * Radius * (1.0 + 4.0 / 9.0 + 1.0 / 9.0);
  const double interfaceElements = 4.7 * 0.65 * area;
  const Sizes sizes;
  for (const double floor : { 0.01, 0.105, 0.2 })
  {
    const MeshSizeEstimate one = EstimateMeshSize<3>(image, 1.0, floor, &sizes, 1);
    EXPECT_EQ(one.SizesBelowFloor, floor > 0.1);
    // Five elements per size^3, beside those of the interfaces. The estimate looks at one voxel in ten.
    const double elements = 5.0 * BallsInBalls(sizes, floor) + interfaceElements;
    EXPECT_NEAR(
      static_cast<double>(one.InterfaceElements), interfaceElements, 0.02 * interfaceElements);
    EXPECT_NEAR(static_cast<double>(one.Elements), elements, 0.01 * elements);
    for (const unsigned threads : { 0u, 2u, 3u, 8u })
    {
      const MeshSizeEstimate other = EstimateMeshSize<3>(image, 1.0, floor, &sizes, threads);
      EXPECT_EQ(one.Elements, other.Elements);
      EXPECT_EQ(one.Vertices, other.Vertices);
      EXPECT_EQ(one.InterfaceVertices, other.InterfaceVertices);
      EXPECT_EQ(one.Bytes, other.Bytes);
      EXPECT_EQ(one.SizesBelowFloor, other.SizesBelowFloor);
    }
  }
}

TEST(MeshSizeEstimate, TinyImages)
{
  const LabelImage<3> image = phantoms::Make(phantoms::Cube(3),
    [](const Point<3>& p) -> std::int16_t {
      return p == Point<3>{ 1.0, 1.0, 1.0 } ? 1 : 0;
    });
  const Sizes sizes;
  for (const unsigned threads : { 1u, 8u })
  {
    sizes.Calls = 0;
    EXPECT_GT(EstimateMeshSize<3>(image, 1.0, 0.1, &sizes, threads).Elements, 1000u);
    EXPECT_EQ(sizes.Calls, 1u);
  }
}

TEST(MeshSizeEstimate, Stops)
{
  const LabelImage<3> image = phantoms::NestedBalls(40.0);
  const Sizes counted;
  EstimateMeshSize<3>(image, 1.0, 0.1, &counted, 1);
  ASSERT_GT(counted.Calls, 10000u);
  for (const unsigned threads : { 1u, 2u, 3u, 8u })
  {
    Sizes sizes;
    sizes.StopAt = 100;
    EXPECT_THROW(
      EstimateMeshSize<3>(image, 1.0, 0.1, &sizes, threads, sizes.Stop.get_token()), Cancelled);
    EXPECT_LT(sizes.Calls, counted.Calls) << threads;
    // Counting the faces, too.
    EXPECT_THROW(
      EstimateMeshSize<3>(image, 1.0, 0.1, nullptr, threads, sizes.Stop.get_token()), Cancelled);
  }
}
