// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Meshes of other programs: inverted, flat and repeated simplices, unused points.
#include "Geometry/SimplexQuality.h"
#include "Mesh/PutRight.h"
#include "MeshRuns.h"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

using namespace voxplex;

namespace
{

/** Two simplices that share a facet, the second one inverted; points 0 and 4 are used by none. */
template <int D>
SimplexMesh<D> TwoSimplices()
{
  SimplexMesh<D> mesh;
  const auto add = [&mesh](std::size_t axis, double x)
  {
    mesh.Points.push_back({});
    mesh.Points.back()[axis] = x;
  };
  add(0, 5.0);
  add(0, 0.0);
  add(0, 1.0);
  add(1, 1.0);
  add(1, 5.0);
  add(2, 1.0);
  if (D == 4)
  {
    add(3, 1.0);
  }
  add(0, -1.0);
  const auto last = static_cast<std::uint32_t>(mesh.Points.size() - 1);
  if constexpr (D == 3)
  {
    mesh.Simplices = { { 1, 2, 3, 5 }, { 1, last, 3, 5 } };
  }
  else
  {
    mesh.Simplices = { { 1, 2, 3, 5, 6 }, { 1, last, 3, 5, 6 } };
  }
  mesh.Labels = { 1, 2 };
  return mesh;
}

template <int D>
std::string Refusal(const SimplexMesh<D>& mesh)
{
  SimplexMesh<D> copy = mesh;
  return checks::MessageOf([&copy] { PutRight(copy); });
}

template <int D>
void ExpectPutRight()
{
  SimplexMesh<D> mesh = TwoSimplices<D>();
  const auto before = mesh.Points;
  MeshChanges changes = PutRight(mesh);
  EXPECT_EQ(changes.Turned, 1u);
  ASSERT_EQ(changes.Points.size(), before.size() - 2);
  ASSERT_EQ(mesh.Points.size(), before.size() - 2);
  for (std::size_t i = 0; i < mesh.Points.size(); ++i)
  {
    EXPECT_EQ(mesh.Points[i], before[changes.Points[i]]);
  }
  for (std::size_t s = 0; s < 2; ++s)
  {
    EXPECT_GT(SignedVolume<D>(mesh.PointsOf(s).data()), 0.0);
  }
  EXPECT_TRUE(PutRight(mesh).IsNone());

  SimplexMesh<D> bad = mesh;
  bad.Simplices[1][D] = bad.Simplices[1][0];
  EXPECT_NE(Refusal<D>(bad).find("without volume: 1, the first is cell 1."), std::string::npos);
  for (Point<D>& p : bad.Points) // flat but for roundings, and small
  {
    p[0] = 1e-3 * (p[1] + p[2]) / 3.0;
    p[1] *= 1e-3;
    p[2] *= 1e-3;
  }
  EXPECT_NE(Refusal<D>(bad).find("without volume: 2, the first is cell 0."), std::string::npos);
  bad = mesh;
  bad.Simplices[1] = bad.Simplices[0];
  std::swap(bad.Simplices[1][0], bad.Simplices[1][2]);
  EXPECT_NE(
    Refusal<D>(bad).find("points of another one: 1, the first is cell 1."), std::string::npos);
  bad = mesh; // thin, but not flat
  for (Point<D>& p : bad.Points)
  {
    p[D - 1] *= 1e-9;
  }
  EXPECT_EQ(Refusal<D>(bad), "");
}

} // namespace

TEST(PutRight, Tetrahedra)
{
  ExpectPutRight<3>();
}

TEST(PutRight, Pentatopes)
{
  ExpectPutRight<4>();
}
