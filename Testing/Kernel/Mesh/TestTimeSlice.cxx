// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Slices against what is known of them: volumes, and that cells fit together.
#include "../../Phantoms/SpaceTimePhantoms.h"
#include "Base/Error.h"
#include "ComplexOf.h"
#include "Delaunay/Triangulation.h"
#include "Mesh/TimeSlice.h"
#include "MeshRuns.h"
#include "TimeSliceChecks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <string>

using namespace voxplex;
using namespace voxplex::checks;

namespace
{

/**
 * The volume of the section of a pentatope at T: the hypervolume times the probability density of its points' times.
 * The density is a B-spline whose knots are the times of the vertices (Curry and Schoenberg 1966).
 */
double SectionVolume(const Mesh& mesh, double time)
{
  double sum = 0.0;
  for (std::size_t i = 0; i < 5; ++i)
  {
    double product = 1.0;
    for (std::size_t j = 0; j < 5; ++j)
    {
      product *= i == j ? 1.0 : mesh.Times[i] - mesh.Times[j];
    }
    sum += std::pow(std::max(mesh.Times[i] - time, 0.0), 3) / product;
  }
  return 4.0 * sum * std::abs(Orientation(mesh, { 0, 1, 2, 3, 4 })) / 24.0;
}

/** One pentatope with these times at random points; positive. */
Mesh OnePentatope(const std::array<double, 5>& times, std::mt19937& random)
{
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Mesh mesh;
  do
  {
    mesh = Mesh();
    for (const double t : times)
    {
      mesh.AddPoint({ uniform(random), uniform(random), uniform(random), t });
    }
  } while (std::abs(Orientation(mesh, { 0, 1, 2, 3, 4 })) < 0.1);
  mesh.AddCell(Orientation(mesh, { 0, 1, 2, 3, 4 }) > 0.0
      ? std::array<long long, 5>{ 0, 1, 2, 3, 4 }
      : std::array<long long, 5>{ 1, 0, 2, 3, 4 });
  return mesh;
}

/** The tetrahedra around pentatopes where the label changes, 0 being outside; larger label inside. */
Mesh BoundaryOf(const Mesh& mesh)
{
  std::map<std::set<long long>, std::vector<std::pair<std::array<long long, 4>, long long>>> facets;
  for (std::size_t c = 0; c < mesh.Labels.size(); ++c)
  {
    for (std::size_t i = 0; i < 5; ++i)
    {
      std::array<long long, 4> facet;
      std::size_t m = 0;
      for (std::size_t j = 0; j < 5; ++j)
      {
        if (j != i)
        {
          facet[m++] = mesh.Connectivity[5 * c + j];
        }
      }
      const long long inner = mesh.Connectivity[5 * c + i];
      if (Orientation(mesh, { inner, facet[0], facet[1], facet[2], facet[3] }) < 0.0)
      {
        std::swap(facet[0], facet[1]);
      }
      facets[{ facet.begin(), facet.end() }].emplace_back(facet, mesh.Labels[c]);
    }
  }
  Mesh boundary;
  boundary.Points = mesh.Points;
  boundary.Times = mesh.Times;
  for (auto& [ids, sides] : facets)
  {
    std::sort(
      sides.begin(), sides.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
    if (sides.size() == 1 || sides[0].second != sides[1].second)
    {
      boundary.AddCell(sides[0].first, sides[0].second, sides.size() == 1 ? 0 : sides[1].second);
    }
  }
  return boundary;
}

/** Kuhn's subdivision of cells^4 unit cubes; label 2 where x > 1, else 1. */
Mesh KuhnGrid(long long cells)
{
  Mesh mesh;
  const long long n = cells + 1;
  for (long long i = 0; i < n * n * n * n; ++i)
  {
    mesh.AddPoint(
      { double(i % n), double(i / n % n), double(i / n / n % n), double(i / n / n / n) });
  }
  const std::array<long long, 4> steps = { 1, n, n * n, n * n * n };
  for (long long i = 0; i < n * n * n * n; ++i)
  {
    const Point<4> p = mesh.At(i);
    if (*std::max_element(p.begin(), p.end()) >= double(cells))
    {
      continue;
    }
    std::array<std::size_t, 4> order = { 0, 1, 2, 3 };
    do
    {
      std::array<long long, 5> ids = { i };
      for (std::size_t k = 0; k < 4; ++k)
      {
        ids[k + 1] = ids[k] + steps[order[k]];
      }
      if (Orientation(mesh, ids) < 0.0)
      {
        std::swap(ids[3], ids[4]);
      }
      mesh.AddCell(ids, p[0] < 1.0 ? 1 : 2);
    } while (std::next_permutation(order.begin(), order.end()));
  }
  return mesh;
}

/** The unit box, label 1 or 2 by the circumcentre. */
class UnitBox final : public Domain<4>
{
public:
  Box<4> Bounds() const override { return { { 0, 0, 0, 0 }, { 1, 1, 1, 1 } }; }
  LabelId Label(const Point<4>& p) const override { return p[0] + 0.2 * p[3] < 0.6 ? 1 : 2; }
  std::int64_t LabelValue(LabelId id) const override { return id; }
  double DistanceBound(const Point<4>&) const override { return 0.0; }
  bool NearSurfacePoint(const Point<4>&, LabelId, Point<4>&, double&) const override
  {
    return false;
  }
  bool ClosestSurfacePoint(const Point<4>&, LabelId, Point<4>&) const override { return false; }
  bool FirstCrossing(const Point<4>&, LabelId, const Point<4>&, Point<4>&) const override
  {
    return false;
  }
};

/** The kernel's mesh, and its facets. */
void Copy(const SimplexMesh<4>& simplices, Mesh& mesh, Mesh& boundary)
{
  for (const Point<4>& p : simplices.Points)
  {
    mesh.AddPoint(p);
    boundary.AddPoint(p);
  }
  for (std::size_t s = 0; s < simplices.Simplices.size(); ++s)
  {
    mesh.AddCell(simplices.Simplices[s], simplices.Labels[s]);
  }
  for (std::size_t f = 0; f < simplices.Facets.size(); ++f)
  {
    boundary.AddCell(simplices.Facets[f], simplices.FacetLabels[f][0], simplices.FacetLabels[f][1]);
  }
}

/** The Delaunay triangulation of random points of the unit box, and its facets between labels. */
void DelaunayMesh(std::size_t points, bool latticeTimes, Mesh& mesh, Mesh& boundary)
{
  const UnitBox box;
  Triangulation<4> triangulation(box.Bounds());
  Triangulation<4>::Worker worker(triangulation);
  std::mt19937 random(static_cast<unsigned>(points));
  std::uniform_real_distribution<double> uniform(0.01, 0.99);
  SimplexId hint = 0;
  for (std::size_t i = 0; i < points; ++i)
  {
    Point<4> p = { uniform(random), uniform(random), uniform(random), uniform(random) };
    p[3] = latticeTimes ? std::round(4.0 * p[3]) / 4.0 : p[3];
    const bool onBox = p[3] == 0.0 || p[3] == 1.0;
    const SimplexId seed = triangulation.FindConflict(worker, p, hint);
    ASSERT_EQ(triangulation.Insert(worker, p, onBox ? VertexKind::Box : VertexKind::Free, seed),
      InsertionOutcome::Inserted);
    hint = worker.Created[0];
  }
  SimplexMesh<4> simplices;
  ExtractMesh<4>(triangulation, box, simplices, 1);
  Copy(simplices, mesh, boundary);
}

void ExpectBoxAt(const Mesh& mesh, const Mesh& boundary, double size, std::vector<double> times)
{
  const TimeSlicer slicer(mesh.View());
  const TimeSlicer boundarySlicer(boundary.View());
  EXPECT_EQ(slicer.GetFirstTime(), 0.0);
  EXPECT_EQ(slicer.GetLastTime(), size);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0.0, size);
  for (int i = 0; i < 20; ++i)
  {
    times.push_back(uniform(random));
  }
  for (const double time : times)
  {
    SCOPED_TRACE(time);
    const TimeSlice slice = slicer.Slice(time);
    ExpectGoodArrays(slice, mesh, time);
    ExpectToFillBox(slice, mesh, size);
    const TimeSlice cut = boundarySlicer.Slice(time);
    ExpectGoodArrays(cut, boundary, time);
    ExpectSameBoundary(slice, mesh, cut, boundary);
  }
}

std::string MessageOf(const Mesh& mesh)
{
  return checks::MessageOf([&] { const TimeSlicer slicer(mesh.View()); });
}

} // namespace

TEST(TimeSlice, OnePentatopeInEveryOrder)
{
  std::mt19937 random(1);
  const Mesh mesh = OnePentatope({ 0.0, 1.0, 2.5, 3.0, 5.0 }, random);
  std::array<long long, 5> ids = { 0, 1, 2, 3, 4 };
  do
  {
    Mesh permuted = mesh;
    std::copy(ids.begin(), ids.end(), permuted.Connectivity.begin());
    const TimeSlicer slicer(permuted.View());
    const double sign = Orientation(permuted, ids) > 0.0 ? 1.0 : -1.0;
    for (const double time : { 0.3, 1.7, 2.6, 4.0 })
    {
      SCOPED_TRACE(time);
      const TimeSlice slice = slicer.Slice(time);
      ExpectGoodArrays(slice, permuted, time);
      EXPECT_EQ(slice.Sources.size(), time < 1.0 || time > 3.0 ? 1u : 3u);
      EXPECT_NEAR(sign * Measure(slice, permuted).All, SectionVolume(permuted, time), 1e-13);
      Volumes volumes = Measure(slice, permuted);
      EXPECT_EQ(volumes.Smallest > 0.0, sign > 0.0);
    }
  } while (std::next_permutation(ids.begin(), ids.end()));
}

// Every way in which vertices lie before, at and after T = 0, in two orders each.
TEST(TimeSlice, PointsAtTheTimeAreTheLimit)
{
  std::mt19937 random(2);
  std::map<std::size_t, int> seen; // by the number of tetrahedra
  for (int pattern = 0; pattern < 243; ++pattern)
  {
    SCOPED_TRACE(pattern);
    std::array<double, 5> times;
    int rest = pattern;
    for (double& t : times)
    {
      t = rest % 3 - 1;
      rest /= 3;
    }
    if (times[0] == times[1] && times[0] == times[2] && times[0] == times[3] &&
      times[0] == times[4])
    {
      continue;
    }
    const Mesh mesh = OnePentatope(times, random);
    const TimeSlicer slicer(mesh.View());
    const TimeSlice slice = slicer.Slice(0.0);
    ExpectGoodArrays(slice, mesh, 0.0);
    const bool first = slicer.GetFirstTime() == 0.0;
    const TimeSlice near = slicer.Slice(first ? 1e-7 : -1e-7);
    const Volumes volumes = Measure(slice, mesh);
    const Volumes limit = Measure(near, mesh);
    EXPECT_NEAR(volumes.All, limit.All, 1e-5);
    // What is left has volume, what has volume is left.
    EXPECT_EQ(slice.Sources.empty(), limit.All <= 1e-4);
    EXPECT_GT(volumes.Smallest, 1e-4);
    ++seen[slice.Sources.size()];
  }
  EXPECT_GT(seen[1], 20);
  EXPECT_GT(seen[2], 20);
  EXPECT_GT(seen[3], 10);
}

TEST(TimeSlice, KuhnGrid)
{
  const Mesh mesh = KuhnGrid(2);
  ASSERT_EQ(mesh.Labels.size(), 16u * 24u);
  const Mesh boundary = BoundaryOf(mesh);
  ExpectBoxAt(mesh, boundary, 2.0, { 0.0, 0.5, 1.0, 2.0 });
  const TimeSlicer slicer(mesh.View());
  for (const double time : { 0.0, 0.77, 1.0, 1.5, 2.0 })
  {
    const Volumes volumes = Measure(slicer.Slice(time), mesh);
    EXPECT_NEAR(volumes.OfLabel.at(1), 4.0, 1e-12);
    EXPECT_NEAR(volumes.OfLabel.at(2), 4.0, 1e-12);
  }
}

TEST(TimeSlice, DelaunayTriangulation)
{
  Mesh mesh;
  Mesh boundary;
  DelaunayMesh(150, false, mesh, boundary);
  std::vector<double> times = { 0.0, 1.0 };
  for (std::size_t i = 0; i < mesh.Times.size(); i += 20)
  {
    times.push_back(mesh.Times[i]);
  }
  ExpectBoxAt(mesh, boundary, 1.0, times);
}

// Tens of points at each of these times, on the first and the last one too.
TEST(TimeSlice, DelaunayTriangulationOfPointsAtFewTimes)
{
  Mesh mesh;
  Mesh boundary;
  DelaunayMesh(151, true, mesh, boundary);
  ExpectBoxAt(mesh, boundary, 1.0, { 0.0, 0.25, 0.5, 0.75, 1.0 });
}

// Two balls that merge and part, cut by the first and the last frame; coarse.
TEST(TimeSlice, MeshOfAnImage)
{
  const phantoms::SpaceTimePhantom balls = phantoms::MergingBalls();
  const std::vector<std::uint8_t> scalars = balls.Scalars();
  const SimplexMesh<4> simplices =
    MeshOf(LabelImage<4>::FromScalars<std::uint8_t>(scalars, balls.Grid), WithDelta<4>(2.5));
  Mesh mesh;
  Mesh boundary;
  Copy(simplices, mesh, boundary);
  const TimeSlicer slicer(mesh.View());
  const TimeSlicer boundarySlicer(boundary.View());
  ASSERT_EQ(slicer.GetFirstTime(), 0.0);
  ASSERT_EQ(slicer.GetLastTime(), 16.0);
  for (double time = 0.0; time <= 16.0; time += 0.5)
  {
    SCOPED_TRACE(time);
    const TimeSlice slice = slicer.Slice(time);
    ExpectGoodArrays(slice, mesh, time);
    ExpectSameBoundary(slice, mesh, boundarySlicer.Slice(time), boundary);
    const Volumes volumes = Measure(slice, mesh);
    EXPECT_GT(volumes.Smallest, -1e-12) << "inverted by more than the roundings of its corners";
    for (const long long label : { 1, 2 })
    {
      const auto frame = scalars.begin() + static_cast<std::ptrdiff_t>(time) * 48 * 28 * 28;
      const auto voxels = static_cast<double>(std::count(frame, frame + 48 * 28 * 28, label));
      EXPECT_NEAR(volumes.OfLabel.at(label) / voxels, 1.0, 0.08);
    }
    // The ends are the mesh's own tetrahedra.
    const bool isEnd = time == 0.0 || time == 16.0;
    EXPECT_EQ(isEnd,
      std::all_of(slice.Origins.begin(), slice.Origins.end(),
        [](const CutPoint& point) { return point.A == point.B; }));
  }
}

// Facets that the slice has on a plane of time belong to one side only: the slice is not doubled.
TEST(TimeSlice, FlatPartsAreCutOnce)
{
  const Mesh mesh = KuhnGrid(1);
  Mesh later = mesh;
  for (double& t : later.Times)
  {
    t += 1.0;
  }
  Mesh both = mesh;
  both.Points.insert(both.Points.end(), later.Points.begin(), later.Points.end());
  both.Times.insert(both.Times.end(), later.Times.begin(), later.Times.end());
  for (std::size_t c = 0; c < later.Labels.size(); ++c)
  {
    std::array<long long, 5> ids;
    for (std::size_t i = 0; i < 5; ++i)
    {
      ids[i] = later.Connectivity[5 * c + i] + static_cast<long long>(mesh.Times.size());
    }
    both.AddCell(ids, 2);
  }
  const TimeSlicer slicer(both.View());
  for (const double time : { 0.0, 0.5, 1.0, 1.5, 2.0 })
  {
    const Volumes volumes = Measure(slicer.Slice(time), both);
    EXPECT_NEAR(volumes.All, 1.0, 1e-12);
    EXPECT_NEAR(volumes.OfLabel.at(time > 1.0 ? 2 : 1), 1.0, 1e-12);
  }
}

// The same times, computed in two ways, differ by roundings; so do the times of points.
TEST(TimeSlice, RoundingsOfTimesDoNotMatter)
{
  for (const double origin : { 0.0, 1e9 })
  {
    Mesh mesh = KuhnGrid(2);
    bool up = false;
    for (double& t : mesh.Times)
    {
      t = std::nextafter(origin + 0.1 * t, up ? 2e9 : -2e9);
      up = !up;
    }
    const TimeSlicer slicer(mesh.View());
    for (const double time : { origin, origin + 0.1, origin + 0.2 })
    {
      for (const double to : { time, -2e9, 2e9 })
      {
        const TimeSlice slice = slicer.Slice(std::nextafter(time, to));
        ExpectToFillBox(slice, mesh, 2.0);
        for (const CutPoint& point : slice.Origins)
        {
          EXPECT_EQ(point.A, point.B);
        }
      }
    }
    EXPECT_TRUE(slicer.Slice(origin - 1e-5).Sources.empty());
    EXPECT_TRUE(slicer.Slice(origin + 0.2 + 1e-5).Sources.empty());
  }
}

// Cells of very different durations, found as if each had been looked at.
TEST(TimeSlice, FindsTheCellsThatCross)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  Mesh mesh;
  for (long long c = 0; c < 1000; ++c)
  {
    const double duration = c % 50 == 0 ? 1.0 : 0.01;
    const double begin = uniform(random);
    for (int i = 0; i < 5; ++i)
    {
      mesh.AddPoint(
        { uniform(random), uniform(random), uniform(random), begin + duration * uniform(random) });
    }
    mesh.AddCell(std::array<long long, 5>{ 5 * c, 5 * c + 1, 5 * c + 2, 5 * c + 3, 5 * c + 4 });
  }
  const TimeSlicer slicer(mesh.View());
  for (int i = 0; i < 50; ++i)
  {
    const double time = 1.2 * uniform(random);
    std::vector<long long> expected;
    for (std::size_t c = 0; c < mesh.Labels.size(); ++c)
    {
      const auto first = mesh.Times.begin() + static_cast<std::ptrdiff_t>(5 * c);
      if (*std::min_element(first, first + 5) < time && *std::max_element(first, first + 5) > time)
      {
        expected.push_back(static_cast<long long>(c));
      }
    }
    std::vector<long long> found = slicer.Slice(time).Sources;
    found.erase(std::unique(found.begin(), found.end()), found.end());
    EXPECT_EQ(found, expected);
  }
}

TEST(TimeSlice, NothingToCut)
{
  const Mesh empty;
  const TimeSlicer none(empty.View());
  EXPECT_TRUE(none.IsEmpty());
  EXPECT_EQ(none.Slice(0.0).Offsets.size(), 1u);
  EXPECT_TRUE(TimeSlicer(SpaceTimeMesh{}).Slice(0.0).Sources.empty());

  const Mesh mesh = KuhnGrid(1);
  const TimeSlicer slicer(mesh.View());
  EXPECT_FALSE(slicer.IsEmpty());
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (const double time : { -0.1, 1.1, infinity, -infinity, std::nan("") })
  {
    EXPECT_TRUE(slicer.Slice(time).Sources.empty());
    EXPECT_TRUE(slicer.Slice(time).Points.empty());
  }
  Mesh flat = mesh;
  std::fill(flat.Times.begin(), flat.Times.end(), 3.0);
  EXPECT_TRUE(TimeSlicer(flat.View()).Slice(3.0).Sources.empty());
}

TEST(TimeSlice, BadMeshesAreRefused)
{
  const Mesh good = KuhnGrid(1);
  EXPECT_EQ(MessageOf(good), "");
  Mesh mesh = good;
  mesh.AddCell(std::array<long long, 3>{ 0, 1, 2 });
  EXPECT_EQ(MessageOf(mesh), "Cell 24 has 3 points; a pentatope has 5, a tetrahedron 4.");
  mesh = good;
  mesh.Offsets.back() += 1;
  EXPECT_NE(MessageOf(mesh), "");
  mesh = good;
  mesh.Connectivity[7] = 16;
  EXPECT_EQ(MessageOf(mesh), "Cell 1 has the point 16, but there are only 16 points.");
  mesh.Connectivity[7] = -1;
  EXPECT_NE(MessageOf(mesh), "");
  mesh = good;
  mesh.Times[3] = std::nan("");
  EXPECT_EQ(MessageOf(mesh), "The time of point 3 is not a finite number.");
  mesh.Times[3] = std::numeric_limits<double>::infinity();
  EXPECT_NE(MessageOf(mesh), "");
  mesh = good;
  mesh.Times.pop_back();
  EXPECT_EQ(MessageOf(mesh), "There are 15 times for 16 points; each point needs one.");
}
