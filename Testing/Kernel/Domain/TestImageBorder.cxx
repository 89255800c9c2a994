// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Where the border of a 3D image cuts an object: faces and edges in the field, the domain and its junctions. For meshes
// see Mesher/TestBorderFaces.cxx.
#include "Domain/ImageDomain.h"
#include "Junctions/JunctionCurves.h"
#include "Phantoms.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <utility>

using namespace voxplex;

//------------------------------------------------------------------------------------------------
TEST(ImageBorder, AreWhereForegroundTouchesTheBorder)
{
  const LabelImage<3> image = phantoms::CutBall(12);
  const std::set<std::pair<std::size_t, unsigned>> expected{ { 2, 0 } };
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    for (unsigned end = 0; end < 2; ++end)
    {
      EXPECT_EQ(image.ReachesBorder(axis, end), expected.contains({ axis, end }))
        << axis << " " << end;
    }
  }
  const ImageDomain<3> domain(image, 1.0);
  ASSERT_NE(domain.Border(), nullptr);
  EXPECT_EQ(domain.Border()->FacesAt({ 1.0, 2.0, -0.5 }), 1u << 4);
  EXPECT_EQ(domain.Border()->FacesAt({ 1.0, 2.0, -0.499 }), 0u);
  EXPECT_EQ(domain.Border()->FacesAt({ -0.5, 2.0, 3.0 }), 0u);
  const LabelImage<3> whole = phantoms::Ball(6.0);
  EXPECT_EQ(ImageDomain<3>(whole, 1.0).Border(), nullptr);
}

// Up to the face labels are those of the outermost voxel centres, but where an interface is oblique to it; at it
// background begins.
TEST(ImageBorder, LabelsGoOnToTheFace)
{
  const LabelImage<3> image = phantoms::CutHalves(phantoms::ObliqueGrid(30));
  const LabelField<3> field(image, 1.0);
  std::mt19937 random(5);
  int labels[3] = {};
  int changed = 0;
  for (int i = 0; i < 4000; ++i)
  {
    Point<3> x;
    for (std::size_t a = 0; a < 3; ++a)
    {
      x[a] = std::uniform_real_distribution<>(
        1.0, static_cast<double>(field.LatticeDimensions()[a] - 2))(random);
    }
    const std::size_t axis = i % 2 == 0 ? 0 : 2;
    x[axis] = 1.0;
    const LabelId label = field.LabelAt(x);
    ++labels[label];
    x[axis] = 0.5001;
    changed += field.LabelAt(x) != label ? 1 : 0;
    ASSERT_GT(field.MarginAt(x, field.LabelAt(x)), 0.0);
    for (const double outside : { 0.5, 0.4999, 0.2, -3.0 })
    {
      x[axis] = outside;
      ASSERT_EQ(field.LabelAt(x), 0);
      ASSERT_GT(field.MarginAt(x, 0), 0.0);
      ASSERT_LE(field.MarginAt(x, label == 0 ? 1 : label), 0.0);
    }
  }
  for (const int count : labels)
  {
    EXPECT_GT(count, 200);
  }
  EXPECT_LT(changed, 80);
}

//------------------------------------------------------------------------------------------------
// Not about, but on the face: facets of such points are flat.
TEST(ImageBorder, PointsFoundLieOnThem)
{
  for (const auto& grid : { phantoms::Cube(30), phantoms::ObliqueGrid(30) })
  {
    const LabelImage<3> image = phantoms::CutHalves(grid);
    const ImageDomain<3> domain(image, 1.0);
    std::mt19937 random(6);
    int crossings = 0;
    int closest = 0;
    int others = 0;
    for (int i = 0; i < 3000; ++i)
    {
      Point<3> index;
      for (std::size_t a = 0; a < 3; ++a)
      {
        index[a] = std::uniform_real_distribution<>(
          1.5, static_cast<double>(grid.Dimensions[a] - 2))(random);
      }
      const std::size_t axis = i % 2 == 0 ? 0 : 2;
      index[axis] = std::uniform_real_distribution<>(-0.45, 0.0)(random); // labels go on from here
      const Point<3> p = grid.ToFrame(index);
      const LabelId label = domain.Label(p);
      index[axis] = -3.0;
      Point<3> z;
      if (label == 0 || !domain.FirstCrossing(p, label, grid.ToFrame(index), z))
      {
        continue;
      }
      const Point<3> found = grid.ToIndex(z);
      if (found[axis] > -0.49)
      {
        ++others; // an interface that is oblique to the face
        continue;
      }
      EXPECT_NEAR(found[axis], -0.5, 1e-9);
      EXPECT_EQ((domain.Border()->FacesAt(z) >> (2 * axis)) & 1, 1u);
      ++crossings;
      Point<3> back;
      if (domain.FirstCrossing(grid.ToFrame(index), 0, p, back))
      {
        EXPECT_NE(domain.Border()->FacesAt(back), 0u);
      }
      ASSERT_TRUE(domain.ClosestSurfacePoint(p, label, z));
      closest += domain.Border()->FacesAt(z) != 0 ? 1 : 0;
    }
    EXPECT_GT(crossings, 500);
    EXPECT_LT(others, crossings / 50);
    EXPECT_GT(closest, crossings / 2); // the others are near the sides or the other half
  }
}

TEST(ImageBorder, NearEdges)
{
  const LabelImage<3> image = phantoms::CutBall(12);
  const ImageDomain<3> domain(image, 1.0);
  const double c = 0.5 * static_cast<double>(image.Grid().Dimensions[0] - 1);
  Point<3> z;
  for (int k = 0; k < 16; ++k)
  {
    const double angle = 0.4 * k;
    const Point<3> p{ c + 8.0 * std::cos(angle), c + 8.0 * std::sin(angle), -0.5 };
    ASSERT_TRUE(domain.Border()->FindEdge(p, 3.0, z));
    EXPECT_EQ(z[2], -0.5);
    EXPECT_NEAR(std::hypot(z[0] - c, z[1] - c), 9.5, 0.6);
    EXPECT_LT(Distance(p, z), 3.0);
    EXPECT_FALSE(domain.Border()->FindEdge(p, 0.5, z));
  }
  EXPECT_FALSE(domain.Border()->FindEdge({ c, c, -0.5 }, 3.0, z));
  EXPECT_FALSE(domain.Border()->FindEdge({ c + 8.0, c, 3.0 }, 9.0, z)) << "not on a face";

  const LabelImage<3> block = phantoms::Block(phantoms::ObliqueGrid(12));
  const ImageDomain<3> oblique(block, 1.0);
  ASSERT_TRUE(oblique.Border()->FindEdge(block.Grid().ToFrame({ -0.5, 0.7, 3.0 }), 2.0, z));
  EXPECT_NEAR(Distance(z, block.Grid().ToFrame({ -0.5, -0.5, 3.0 })), 0.0, 1e-9);
}

//------------------------------------------------------------------------------------------------
TEST(ImageBorder, EdgesOfABlockAreTwelveCurves)
{
  for (const auto& grid : { phantoms::Cube(9), phantoms::ObliqueGrid(12) })
  {
    const LabelImage<3> image = phantoms::Block(grid);
    const ImageDomain<3> domain(image, 1.0);
    const JunctionCurves edges(image, domain.GetLabelField(), domain.GetSites());
    EXPECT_EQ(edges.NumberOfCorners(), 8u);
    ASSERT_EQ(edges.Curves().size(), 12u);
    double length = 0.0;
    for (const JunctionCurves::Curve& curve : edges.Curves())
    {
      EXPECT_FALSE(curve.IsClosed);
      EXPECT_EQ(curve.Labels, (std::array<LabelId, 3>{ 0, 0, 1 }));
      const double chord = Distance(curve.Points.front(), curve.Points.back());
      double arc = 0.0;
      for (std::size_t i = 1; i < curve.Points.size(); ++i)
      {
        arc += Distance(curve.Points[i - 1], curve.Points[i]);
      }
      EXPECT_NEAR(arc, chord, 1e-9) << "straight";
      length += chord;
    }
    double expected = 0.0;
    for (std::size_t a = 0; a < 3; ++a)
    {
      expected += 4.0 * static_cast<double>(grid.Dimensions[a]) * grid.Spacing(static_cast<int>(a));
    }
    EXPECT_NEAR(length, expected, 1e-9);
  }
}

TEST(ImageBorder, EdgesOfNoiseEndInCorners)
{
  std::mt19937 random(7);
  const LabelImage<3> image = phantoms::Make(
    phantoms::Cube(9), [&](const Point<3>&) { return static_cast<std::int16_t>(random() % 4); });
  const ImageDomain<3> domain(image, 1.0);
  const JunctionCurves edges(image, domain.GetLabelField(), domain.GetSites());
  std::map<Point<3>, int> ends;
  std::size_t flat = 0;
  for (const JunctionCurves::Curve& curve : edges.Curves())
  {
    if (!curve.IsClosed)
    {
      ++ends[curve.Points.front()];
      ++ends[curve.Points.back()];
    }
    if (curve.Labels[1] == 0) // background and a face of the image, or two of these
    {
      for (const Point<3>& p : curve.Points)
      {
        EXPECT_NE(domain.Border()->FacesAt(p), 0u);
      }
    }
    flat += domain.Border()->FacesAt(curve.Points[curve.Points.size() / 2]) != 0 ? 1 : 0;
  }
  EXPECT_GT(flat, 50u);
  EXPECT_EQ(ends.size(), edges.NumberOfCorners());
  for (const auto& [corner, count] : ends)
  {
    EXPECT_TRUE(count == 4 || (count == 3 && domain.Border()->FacesAt(corner) != 0)) << count;
  }
}
