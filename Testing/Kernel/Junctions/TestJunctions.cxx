// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Curves where three labels meet: in the image, as points to begin with, and in the mesh.
#include "Base/Error.h"
#include "Domain/ImageDomain.h"
#include "Junctions/JunctionCurves.h"
#include "Junctions/JunctionGraph.h"
#include "Junctions/JunctionSeeds.h"
#include "MeshChecks.h"
#include "MeshRuns.h"
#include "Phantoms.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <set>

using namespace voxplex;

namespace
{

constexpr double CentreX = 15.3;
constexpr double CentreY = 15.8;
constexpr double Bottom = 5.5;
constexpr double Top = 24.5;

/** A cylinder in three sectors, whose edge is an axis from bottom to top. */
LabelImage<3> Sectors()
{
  return phantoms::Make(phantoms::Cube(31),
    [](const Point<3>& p) -> std::int16_t
    {
      const double x = p[0] - CentreX;
      const double y = p[1] - CentreY;
      if (std::hypot(x, y) > 11.0 || p[2] < Bottom || p[2] > Top)
      {
        return 0;
      }
      const double angle = std::atan2(y, x);
      return angle < -2.0 ? 1 : angle < 0.3 ? 2 : angle < 2.2 ? 5 : 1;
    });
}

/** A ball cut by three oblique planes into the labels 1 to 8. */
LabelImage<3> Octants()
{
  return phantoms::Make(phantoms::Cube(33),
    [](const Point<3>& p) -> std::int16_t
    {
      const Point<3> d = Subtract(p, { 16.2, 15.7, 16.4 });
      const int octant = (d[0] + 0.37 * d[1] - 0.21 * d[2] < 0.0 ? 1 : 0) +
        (d[1] + 0.29 * d[2] - 0.33 * d[0] < 0.0 ? 2 : 0) +
        (d[2] + 0.31 * d[0] - 0.27 * d[1] < 0.0 ? 4 : 0);
      return static_cast<std::int16_t>(Dot(d, d) < 12.5 * 12.5 ? 1 + octant : 0);
    });
}

/** Every voxel one of five labels or background, those at the border background. */
LabelImage<3> Noise(unsigned seed)
{
  std::mt19937 random(seed);
  const auto grid = GridGeometry<3>::Orthogonal({ 13, 11, 10 }, { 1.0, 0.5, 2.0 });
  return phantoms::Make(grid,
    [&](const Point<3>& p)
    {
      const Point<3> index = grid.ToIndex(p);
      bool border = false;
      for (std::size_t a = 0; a < 3; ++a)
      {
        border =
          border || index[a] < 0.5 || index[a] > static_cast<double>(grid.Dimensions[a]) - 1.5;
      }
      return static_cast<std::int16_t>(border ? 0 : random() % 6);
    });
}

JunctionCurves Trace(const LabelImage<3>& image, unsigned threads = 1)
{
  const ImageDomain<3> domain(image, 1.0);
  return JunctionCurves(image, domain.GetLabelField(), domain.GetSites(), threads);
}

/** The labels at the points of a lattice of half a voxel within half a voxel of a point, along each axis. */
std::set<LabelId> LabelsNear(
  const LabelImage<3>& image, const ImageDomain<3>& domain, const Point<3>& p)
{
  std::set<LabelId> labels;
  const Point<3> index = image.Grid().ToIndex(p);
  for (int k = 0; k < 64; ++k)
  {
    Point<3> q;
    for (std::size_t a = 0; a < 3; ++a)
    {
      q[a] = 0.5 * (std::floor(2.0 * index[a]) + static_cast<double>((k >> (2 * a)) & 3) - 1.0);
    }
    labels.insert(domain.Label(image.Grid().ToFrame(q)));
  }
  return labels;
}

double DistanceToAxis(const Point<3>& p)
{
  return std::hypot(p[0] - CentreX, p[1] - CentreY);
}

/** Labels by their indicators, which are linear: a constant and a gradient each. */
struct LinearField
{
  std::array<std::array<double, 4>, 3> Indicators;

  double Indicator(const Point<3>& x, LabelId label) const
  {
    const std::array<double, 4>& u = this->Indicators[label];
    return u[0] + u[1] * x[0] + u[2] * x[1] + u[3] * x[2];
  }
  double ExtendedMarginAt(const Point<3>& x, LabelId label) const
  {
    double other = -std::numeric_limits<double>::infinity();
    for (LabelId l = 0; l < 3; ++l)
    {
      other = l != label ? std::max(other, this->Indicator(x, l)) : other;
    }
    return this->Indicator(x, label) - other;
  }
  template <std::size_t N>
  std::array<double, N> ExtendedMarginsAt(
    const Point<3>& x, const std::array<LabelId, N>& labels) const
  {
    std::array<double, N> margins;
    for (std::size_t k = 0; k < N; ++k)
    {
      margins[k] = this->ExtendedMarginAt(x, labels[k]);
    }
    return margins;
  }
};

/** What is `constant` at (1, 2) and grows by s and t over half a voxel along x and y. */
std::array<double, 4> Steps(double constant, double s, double t)
{
  return { constant - 2.0 * (s * 1.0 + t * 2.0), 2.0 * s, 2.0 * t, 0.0 };
}

/** A triangle of the fine lattice with the corners (1, 2, 3), (1.5, 2, 3) and (1.5, 2.5, 3). */
constexpr junctions::LatticeSimplex Triangle{ { 2, 4, 6 }, 1, 3, false };

Point<3> Locate(const LinearField& field, const std::array<LabelId, 3>& labels)
{
  const LabelImage<3> image =
    phantoms::TouchingLabels(4); // of two labels: from 3 on all is outside
  const junctions::LabelledSpace<LinearField> space(image, field);
  return junctions::Locator<LinearField>(space).Locate(Triangle, labels);
}

} // namespace

//------------------------------------------------------------------------------------------------
TEST(JunctionCurves, FollowTheAxisOfThreeSectors)
{
  const LabelImage<3> image = Sectors();
  const JunctionCurves junctions = Trace(image);
  EXPECT_EQ(junctions.NumberOfCorners(), 2u);
  // The axis, three lines down the side, and three arcs at each end, all between the two corners or rims.
  std::map<std::array<LabelId, 3>, double> lengths;
  int axes = 0;
  for (const JunctionCurves::Curve& curve : junctions.Curves())
  {
    for (std::size_t i = 1; i < curve.Points.size(); ++i)
    {
      lengths[curve.Labels] += Distance(curve.Points[i - 1], curve.Points[i]);
    }
    if (curve.Labels == std::array<LabelId, 3>{ 1, 2, 3 })
    {
      ++axes;
      for (const Point<3>& p : curve.Points)
      {
        EXPECT_LT(DistanceToAxis(p), 0.5); // the field rounds the wider sectors
      }
      EXPECT_NEAR(std::abs(curve.Points.front()[2] - curve.Points.back()[2]), Top - Bottom, 1.0);
    }
  }
  EXPECT_EQ(axes, 1);
  EXPECT_NEAR((lengths[{ 1, 2, 3 }]), Top - Bottom, 2.0);
  EXPECT_EQ(lengths.size(), 4u); // and each two of the labels with background
}

//------------------------------------------------------------------------------------------------
// With all labels, curves are closed or go from corner to corner. Four meet at each corner.
TEST(JunctionCurves, AreClosedOrEndInCorners)
{
  for (const unsigned seed : { 1u, 2u, 3u })
  {
    const LabelImage<3> image = Noise(seed);
    const ImageDomain<3> domain(image, 1.0);
    const JunctionCurves junctions = Trace(image);
    std::map<Point<3>, int> ends;
    std::size_t points = 0;
    for (const JunctionCurves::Curve& curve : junctions.Curves())
    {
      ASSERT_GE(curve.Points.size(), 2u);
      if (!curve.IsClosed)
      {
        ++ends[curve.Points.front()];
        ++ends[curve.Points.back()];
      }
      EXPECT_LT(curve.Labels[0], curve.Labels[1]);
      EXPECT_LT(curve.Labels[1], curve.Labels[2]);
      const Point<3>& p = curve.Points[curve.Points.size() / 2];
      const std::set<LabelId> near = LabelsNear(image, domain, p);
      for (const LabelId label : curve.Labels)
      {
        EXPECT_TRUE(near.contains(label));
      }
      points += curve.Points.size();
    }
    EXPECT_GT(junctions.NumberOfCorners(), 20u);
    EXPECT_EQ(ends.size(), junctions.NumberOfCorners());
    for (const auto& [corner, count] : ends)
    {
      EXPECT_EQ(count, 4);
    }
    EXPECT_GT(points, 100u);
  }
}

// On a side of a cube of half a voxel one coordinate at least is a multiple of that.
TEST(JunctionCurves, HavePointsInsideOfCubesAtCornersAndInRingsOnly)
{
  int ends = 0;
  int atCorners = 0;
  int rings = 0;
  int onSides = 0;
  for (unsigned seed = 1; seed <= 12; ++seed)
  {
    const LabelImage<3> image = Noise(seed);
    const JunctionCurves junctions = Trace(image);
    for (const JunctionCurves::Curve& curve : junctions.Curves())
    {
      std::vector<std::size_t> inside;
      for (std::size_t k = 0; k < curve.Points.size(); ++k)
      {
        const Point<3> index = image.Grid().ToIndex(curve.Points[k]);
        const bool isOnSide = std::any_of(index.begin(), index.end(),
          [](double x) { return std::abs(2.0 * x - std::round(2.0 * x)) < 1e-9; });
        onSides += isOnSide ? 1 : 0;
        const bool isEnd = !curve.IsClosed && (k == 0 || k + 1 == curve.Points.size());
        if (!isOnSide && !isEnd)
        {
          inside.push_back(k);
        }
      }
      if (curve.IsClosed)
      {
        EXPECT_TRUE(inside.empty() || curve.Points.size() == 2);
        rings += inside.empty() ? 0 : 1;
        continue;
      }
      ends += 2;
      for (const std::size_t k : inside)
      {
        EXPECT_TRUE(k == 1 || k + 2 == curve.Points.size()) << k << " of " << curve.Points.size();
        atCorners += (k == 1 ? 1 : 0) + (k + 2 == curve.Points.size() ? 1 : 0);
      }
    }
  }
  EXPECT_GT(atCorners, 0.4 * ends); // two facets of four are inside; some points are on their edges
  EXPECT_GT(onSides, 1000);
  EXPECT_GT(rings, 0);
}

//------------------------------------------------------------------------------------------------
// Between voxels of two labels a third one may win: a curve that passes there must not be cut off.
// Where three labels are equal, and on the line between two where they are; by hand, with linear indicators.
TEST(JunctionLocator, FindsWhereLabelsAreEqual)
{
  // The labels are as good as each other 0.6 steps of half a voxel along x and 0.35 along y from the first corner.
  const auto step = [](double constant, double s, double t) -> std::array<double, 4> {
    return { constant - 2.0 * (s * 1.0 + t * 2.0), 2.0 * s, 2.0 * t, 0.0 };
  };
  const LinearField three{ { Steps(0.6, -1.0, 0.0), Steps(-0.9, 1.5, 0.0),
    Steps(-0.7, 0.0, 2.0) } };
  const Point<3> p = Locate(three, { 0, 1, 2 });
  EXPECT_NEAR(p[0], 1.3, 1e-12);
  EXPECT_NEAR(p[1], 2.175, 1e-12);
  EXPECT_NEAR(p[2], 3.0, 1e-12);

  // They are nowhere equal in the triangle, as the first label wins on most of the side opposite to its corner: there.
  const LinearField apart{ { Steps(0.0, 0.0, 0.0), Steps(-0.1, 1.1, -11.0),
    Steps(-0.1, -9.9, 11.0) } };
  EXPECT_EQ(Locate(apart, { 0, 1, 2 }), (Point<3>{ 1.0, 2.0, 3.0 }));

  // Outside begins at one corner: on the edge between the two others.
  const LinearField two{ { Steps(0.3, -1.0, 0.0), Steps(-0.3, 1.0, 0.0), Steps(-9.0, 0.0, 0.0) } };
  const Point<3> first = Locate(two, { 0, 1, 4 });
  EXPECT_NEAR(first[0], 1.15, 1e-12);
  EXPECT_NEAR(first[1], 2.0, 1e-12);
  const Point<3> diagonal = Locate(two, { 0, 3, 1 });
  EXPECT_NEAR(diagonal[0], 1.15, 1e-12);
  EXPECT_NEAR(diagonal[1], 2.15, 1e-12);
  // On the edge of two faces: at the corner that is inside.
  EXPECT_EQ(Locate(two, { 3, 1, 5 }), (Point<3>{ 1.5, 2.0, 3.0 }));
  EXPECT_EQ(Locate(two, { 4, 5, 1 }), (Point<3>{ 1.5, 2.5, 3.0 }));
}

// Known margins belong to the labels and the point that they were computed for, even if others share their place.
TEST(JunctionLocator, KeepsMarginsApart)
{
  const LinearField field{
    { { { 0.1, 0.7, -0.2, 0.3 }, { 0.4, -0.1, 0.6, 0.2 }, { -0.3, 0.2, 0.5, -0.9 } } }
  };
  const LabelImage<3> image = phantoms::TouchingLabels(4);
  const junctions::LabelledSpace<LinearField> space(image, field);
  junctions::KnownMargins<LinearField> known(space);
  std::mt19937 random(3);
  for (int k = 0; k < 50000; ++k)
  {
    const junctions::Index fine{ static_cast<std::int64_t>(random() % 40),
      static_cast<std::int64_t>(random() % 40), static_cast<std::int64_t>(random() % 40) };
    std::array<LabelId, 3> labels{ 0, 1, 2 };
    std::shuffle(labels.begin(), labels.end(), random);
    labels[2] = random() % 2 == 0 ? labels[2] : labels[0];
    ASSERT_EQ(known.At(fine, labels),
      space.MarginsAt(junctions::LabelledSpace<LinearField>::OfFine(fine), labels));
  }
}

TEST(JunctionLocator, TakesTies)
{
  const auto step = [](double constant, double s, double t) -> std::array<double, 4> {
    return { constant - 2.0 * (s * 1.0 + t * 2.0), 2.0 * s, 2.0 * t, 0.0 };
  };
  // Two labels tie at a corner, where the smaller one wins.
  const LinearField two{ { Steps(0.0, -1.0, 0.0), Steps(0.0, 1.0, 0.0), Steps(-9.0, 0.0, 0.0) } };
  EXPECT_EQ(Locate(two, { 0, 1, 4 }), (Point<3>{ 1.0, 2.0, 3.0 }));
  // All three tie along a line through the triangle: the middle is on it.
  const LinearField line{ { Steps(0.0, 0.0, 0.0), Steps(0.0, 1.0, -2.0), Steps(0.0, -1.0, 2.0) } };
  const Point<3> p = Locate(line, { 0, 1, 2 });
  EXPECT_NEAR(p[0], 1.0 + 1.0 / 3.0, 1e-12);
  EXPECT_NEAR(p[1], 2.0 + 0.5 / 3.0, 1e-12);
}

TEST(JunctionCurves, AreFollowedBetweenVoxelsOfTwoLabels)
{
  for (const LabelImage<3>& image : { Sectors(), Octants() })
  {
    const JunctionCurves junctions = Trace(image);
    std::map<Point<3>, std::size_t> ends;
    std::size_t open = 0;
    for (const JunctionCurves::Curve& curve : junctions.Curves())
    {
      if (!curve.IsClosed)
      {
        ++open;
        ++ends[curve.Points.front()];
        ++ends[curve.Points.back()];
      }
    }
    EXPECT_GE(junctions.NumberOfCorners(), 2u);
    EXPECT_EQ(ends.size(), junctions.NumberOfCorners());
    EXPECT_EQ(open, 2u * junctions.NumberOfCorners()); // four ends at each
    for (const auto& [corner, count] : ends)
    {
      EXPECT_EQ(count, 4u) << corner[0] << ' ' << corner[1] << ' ' << corner[2];
    }
  }
}

//------------------------------------------------------------------------------------------------
TEST(JunctionCurves, DoNotDependOnThreads)
{
  const LabelImage<3> image = Noise(4);
  const JunctionCurves one = Trace(image, 1);
  const JunctionCurves four = Trace(image, 4);
  ASSERT_EQ(one.Curves().size(), four.Curves().size());
  for (std::size_t k = 0; k < one.Curves().size(); ++k)
  {
    EXPECT_EQ(one.Curves()[k].Points, four.Curves()[k].Points);
    EXPECT_EQ(one.Curves()[k].Labels, four.Curves()[k].Labels);
  }
}

TEST(JunctionCurves, NeedThreeLabels)
{
  EXPECT_TRUE(Trace(phantoms::Ball(6.0)).Curves().empty());
  EXPECT_TRUE(Trace(phantoms::NestedBalls(12.0)).Curves().empty());
}

TEST(JunctionCurves, CanBeCancelled)
{
  const LabelImage<3> image = Noise(1);
  const ImageDomain<3> domain(image, 1.0);
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW(
    JunctionCurves(image, domain.GetLabelField(), domain.GetSites(), 1, stop.get_token()),
    Cancelled);
}

//------------------------------------------------------------------------------------------------
TEST(JunctionSeeds, AreAboutDeltaApart)
{
  const LabelImage<3> image = Sectors();
  const JunctionCurves junctions = Trace(image);
  const double delta = 2.0;
  const std::vector<FeatureSeed<3>> seeds = SampleJunctions(
    junctions, [&](const Point<3>&, const std::array<LabelId, 3>&) { return delta; }, delta);
  std::vector<double> heights; // of those on the axis
  for (std::size_t i = 0; i < seeds.size(); ++i)
  {
    for (std::size_t j = 0; j < i; ++j)
    {
      EXPECT_GE(Distance(seeds[i].Position, seeds[j].Position), 0.75 * delta);
    }
    if (DistanceToAxis(seeds[i].Position) < 1.0)
    {
      heights.push_back(seeds[i].Position[2]);
    }
  }
  std::sort(heights.begin(), heights.end());
  ASSERT_GE(heights.size(), 7u);
  EXPECT_NEAR(heights.front(), Bottom, 0.6); // the corners are among them
  EXPECT_NEAR(heights.back(), Top, 0.6);
  for (std::size_t i = 1; i < heights.size(); ++i)
  {
    EXPECT_LT(heights[i] - heights[i - 1], 1.6 * delta);
  }
}

//------------------------------------------------------------------------------------------------
// What is smaller than delta is not gone around.
TEST(JunctionSeeds, LeaveSmallLoopsOut)
{
  const LabelImage<3> image = phantoms::Make(phantoms::Cube(24),
    [](const Point<3>& p) -> std::int16_t
    {
      const bool hole =
        Distance(p, { 11.5, 11.5, 11.5 }) < 2.5; // of background, between the labels
      const bool inside = Distance(p, { 11.5, 11.5, 11.5 }) < 9.0;
      return !inside || hole ? 0 : p[0] < 11.5 ? 1 : 2;
    });
  const JunctionCurves junctions = Trace(image);
  ASSERT_EQ(junctions.Curves().size(), 2u); // around the ball, and around the hole
  const auto count = [&](double delta)
  {
    int near = 0;
    for (const FeatureSeed<3>& seed : SampleJunctions(
           junctions, [&](const Point<3>&, const std::array<LabelId, 3>&) { return delta; }, delta))
    {
      near += Distance(seed.Position, { 11.5, 11.5, 11.5 }) < 5.0 ? 1 : 0;
    }
    return near;
  };
  EXPECT_GE(count(1.0), 4);
  EXPECT_EQ(count(5.0), 0);
}

//------------------------------------------------------------------------------------------------
namespace
{

/** Edges of a mesh where three labels or more meet, background included. */
std::vector<std::array<std::uint32_t, 2>> JunctionEdges(const SimplexMesh<3>& mesh)
{
  std::map<std::array<std::uint32_t, 2>, std::set<std::int64_t>> labels;
  for (std::size_t f = 0; f < mesh.Facets.size(); ++f)
  {
    for (unsigned i = 0; i < 3; ++i)
    {
      const auto [low, high] = std::minmax(mesh.Facets[f][i], mesh.Facets[f][(i + 1) % 3]);
      labels[{ low, high }].insert(mesh.FacetLabels[f].begin(), mesh.FacetLabels[f].end());
    }
  }
  std::vector<std::array<std::uint32_t, 2>> edges;
  for (const auto& [edge, around] : labels)
  {
    if (around.size() > 2)
    {
      edges.push_back(edge);
    }
  }
  return edges;
}

struct AxisFigures
{
  double LargestDistance =
    0.0;        ///< of the middle of a junction edge within the cylinder from the axis
  int Ends = 0; ///< vertices there whose number of junction edges is not two
};

AxisFigures MeshAxis(bool sample)
{
  MeshingOptions<3> options = checks::WithDelta<3>(2.0);
  options.Interfaces.SampleJunctions = sample;
  MeshingStatistics statistics;
  const SimplexMesh<3> mesh = checks::MeshOf(Sectors(), options, &statistics);
  checks::ExpectSound(mesh);
  EXPECT_EQ(statistics.Interfaces.Corners, sample ? 2u : 0u);
  EXPECT_EQ(statistics.Interfaces.JunctionSeeds > 0, sample);
  AxisFigures figures;
  std::map<std::uint32_t, int> degrees;
  for (const auto& edge : JunctionEdges(mesh))
  {
    const Point<3> middle = Interpolate(mesh.Points[edge[0]], mesh.Points[edge[1]], 0.5);
    if (middle[2] > Bottom + 1.5 && middle[2] < Top - 1.5 && DistanceToAxis(middle) < 8.0)
    {
      figures.LargestDistance = std::max(figures.LargestDistance, DistanceToAxis(middle));
    }
    ++degrees[edge[0]];
    ++degrees[edge[1]];
  }
  for (const auto& [vertex, degree] : degrees)
  {
    const Point<3>& p = mesh.Points[vertex];
    if (p[2] > Bottom + 2.0 && p[2] < Top - 2.0 && DistanceToAxis(p) < 8.0)
    {
      figures.Ends += degree != 2 ? 1 : 0;
    }
  }
  return figures;
}

} // namespace

TEST(Junctions, ComeOutAsPolylines)
{
  const AxisFigures with = MeshAxis(true);
  EXPECT_LT(with.LargestDistance, 0.5);
  EXPECT_EQ(with.Ends, 0);
  const AxisFigures without = MeshAxis(false);
  EXPECT_GT(without.LargestDistance, 2.0 * with.LargestDistance);
}
