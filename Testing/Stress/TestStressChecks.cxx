// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Each check of the stress program finds its kind of error. Good meshes are spoilt in one way after
// the other.
#include "CaseRun.h"
#include "Checks.h"
#include "Mesher/ImageMesher.h"
#include "RandomImages.h"
#include "Reduction.h"
#include "Workers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <numeric>
#include <span>
#include <unistd.h>

using namespace voxplex;
using namespace voxplex::stress;

namespace
{

/** Two boxes of different labels that share a face, and a third one apart; in 4D for all times. */
template <int D>
StressCase<D> Boxes()
{
  StressCase<D> of;
  of.Kind = "boxes";
  for (std::size_t a = 0; a < static_cast<std::size_t>(D); ++a)
  {
    of.Image.Dimensions[a] = a == 0 ? 14 : a == 3 ? 4 : 8;
    of.Image.Axes[a][a] = 1.0;
  }
  of.Image.Labels.resize(of.Image.Size());
  of.Image.ForEach(
    [&](const typename Volume<D>::Index& v, std::size_t i)
    {
      const bool inside = v[1] > 0 && v[1] < 7 && v[2] > 0 && v[2] < 7;
      of.Image.Labels[i] = !inside || v[0] == 0 || v[0] > 12 ? 0 : v[0] < 5 ? 3 : v[0] < 9 ? 7 : 0;
      of.Image.Labels[i] = inside && v[0] > 10 && v[0] < 13 ? 9 : of.Image.Labels[i];
    });
  of.Options.Sampling.Delta = 1.5;
  of.Measure();
  return of;
}

template <int D>
struct Meshed
{
  StressCase<D> Of = Boxes<D>();
  SimplexMesh<D> Mesh;
  MeshingStatistics Stats;

  explicit Meshed(const std::function<void(StressCase<D>&)>& change = {})
  {
    if (change)
    {
      change(this->Of);
    }
    GridGeometry<D> grid;
    grid.Dimensions = this->Of.Image.Dimensions;
    grid.IndexToFrame = this->Of.Image.Axes;
    ImageMesher<D> mesher(this->Of.AllOptions());
    EXPECT_EQ(mesher.Run(LabelImage<D>::FromScalars(
                           std::span<const std::int32_t>(this->Of.Image.Labels), grid),
                this->Mesh),
      MeshingOutcome::Done);
    this->Stats = mesher.Statistics();
  }

  Findings Check() const
  {
    Findings findings;
    CheckMesh<D>({ this->Of, this->Mesh, this->Stats }, findings);
    return findings;
  }
};

template <int D>
void ExpectNothing(const Meshed<D>& meshed)
{
  const Findings findings = meshed.Check();
  ASSERT_TRUE(findings.IsEmpty()) << findings.All()[0].Cause << ": " << findings.All()[0].Message;
  ASSERT_GT(meshed.Mesh.Simplices.size(), 100u);
}

/** The checks must find a change of a good mesh. */
template <int D>
void ExpectFoundIn(
  const Meshed<D>& good, const std::string& cause, const std::function<void(Meshed<D>&)>& spoil)
{
  Meshed<D> bad = good;
  spoil(bad);
  EXPECT_TRUE(bad.Check().Has(cause)) << cause;
}

template <int D>
void ExpectFound(const std::string& cause, const std::function<void(Meshed<D>&)>& spoil)
{
  static const Meshed<D> good;
  ExpectFoundIn<D>(good, cause, spoil);
}

/** Two slabs; both ends are the same. */
void MakePeriodicWithPlane(StressCase<4>& c)
{
  c.Options.Planes.Times = { 1.5 };
  c.Options.Planes.Periodic = true;
}

/** A pentatope with a facet at a time. */
std::size_t PentatopeAt(const SimplexMesh<4>& mesh, double time)
{
  for (std::size_t s = 0; s < mesh.Simplices.size(); ++s)
  {
    const auto& v = mesh.Simplices[s];
    const auto flat =
      std::count_if(v.begin(), v.end(), [&](std::uint32_t i) { return mesh.Points[i][3] == time; });
    if (flat == 4)
    {
      return s;
    }
  }
  ADD_FAILURE() << "no facet at " << time;
  return 0;
}

/** Replaces the mesh by two simplices of label 3 that share only an edge, in 4D a triangle. */
template <int D>
void MakePairAtRidge(Meshed<D>& m)
{
  constexpr auto N = static_cast<std::uint32_t>(D);
  m.Mesh = {};
  m.Mesh.Points.resize(N + 3, Point<D>{});
  // The ridge: the origin and one point on each of the first axes. Two axes are left.
  for (std::uint32_t v = 1; v < N - 1; ++v)
  {
    m.Mesh.Points[v][v - 1] = 1.0;
  }
  for (std::uint32_t k = 0; k < 4; ++k)
  {
    m.Mesh.Points[N - 1 + k][N - 2 + k % 2] = k < 2 ? 1.0 : -1.0;
  }
  for (const std::uint32_t first : { N - 1, N + 1 })
  {
    auto& simplex = m.Mesh.Simplices.emplace_back();
    std::iota(simplex.begin(), simplex.end(), 0u);
    simplex[N - 1] = first;
    simplex[N] = first + 1;
    m.Mesh.Labels.push_back(3);
    for (std::uint32_t apex = 0; apex <= N; ++apex)
    {
      auto& facet = m.Mesh.Facets.emplace_back();
      for (std::uint32_t k = 0, to = 0; k <= N; ++k)
      {
        if (k != apex)
        {
          facet[to++] = simplex[k];
        }
      }
      if (apex % 2 == 1)
      {
        std::swap(facet[N - 2], facet[N - 1]);
      }
      m.Mesh.FacetLabels.push_back({ 3, 0 });
    }
  }
  EXPECT_FALSE(m.Check().Has("facets"));
  EXPECT_FALSE(m.Check().Has("orientation"));
}

} // namespace

TEST(StressChecks, FindNothingInGoodMeshes)
{
  ExpectNothing(Meshed<3>());
  ExpectNothing(Meshed<3>([](StressCase<3>& c) { c.Options.Optimisation.Run = true; }));
  ExpectNothing(Meshed<4>());
}

TEST(StressChecks, FindWrongArrays)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  ExpectFound<3>("arrays", [](Meshed<3>& m) { m.Mesh.Labels.pop_back(); });
  ExpectFound<3>("arrays", [](Meshed<3>& m) { m.Mesh.Simplices[5][2] = 1u << 30; });
  ExpectFound<3>("not-finite", [nan](Meshed<3>& m) { m.Mesh.Points[7][1] = nan; });
  ExpectFound<3>("unused-point", [](Meshed<3>& m) { m.Mesh.Points.push_back({ 4.0, 4.0, 4.0 }); });
  ExpectFound<3>("duplicate-point", [](Meshed<3>& m) { m.Mesh.Points[3] = m.Mesh.Points[9]; });
  ExpectFound<3>("label", [](Meshed<3>& m) { m.Mesh.Labels[4] = 5; });
}

TEST(StressChecks, FindWrongOrientations)
{
  const auto swap = [](auto& m) { std::swap(m.Mesh.Simplices[8][0], m.Mesh.Simplices[8][1]); };
  ExpectFound<3>("orientation", swap);
  ExpectFound<4>("orientation", swap);
  ExpectFound<3>("conforming", swap);
}

TEST(StressChecks, FindWrongFacets)
{
  const auto lose = [](auto& m)
  {
    m.Mesh.Facets.pop_back();
    m.Mesh.FacetLabels.pop_back();
  };
  ExpectFound<3>("facets", lose);
  ExpectFound<4>("facets", lose);
  ExpectFound<3>("open-boundary", lose);
  ExpectFound<4>("open-boundary", lose);
  const auto turn = [](auto& m) { std::swap(m.Mesh.Facets[3][0], m.Mesh.Facets[3][1]); };
  ExpectFound<3>("facets", turn);
  ExpectFound<4>("facets", turn);
  ExpectFound<3>(
    "facets", [](Meshed<3>& m) { std::swap(m.Mesh.FacetLabels[3][0], m.Mesh.FacetLabels[3][1]); });
  ExpectFound<3>("facets", [](Meshed<3>& m) { m.Mesh.Labels[0] = m.Mesh.Labels[0] == 3 ? 7 : 3; });
}

TEST(StressChecks, FindOverlaps)
{
  ExpectFound<3>("conforming",
    [](Meshed<3>& m)
    {
      m.Mesh.Simplices.push_back(m.Mesh.Simplices[11]);
      m.Mesh.Labels.push_back(m.Mesh.Labels[11]);
    });
  ExpectFound<3>("overlap",
    [](Meshed<3>& m)
    {
      // A second copy of the mesh, slightly shifted.
      const auto points = static_cast<std::uint32_t>(m.Mesh.Points.size());
      const std::size_t simplices = m.Mesh.Simplices.size();
      for (std::uint32_t v = 0; v < points; ++v)
      {
        m.Mesh.Points.push_back(m.Mesh.Points[v]);
        m.Mesh.Points.back()[0] += 0.01;
      }
      for (std::size_t s = 0; s < simplices; ++s)
      {
        m.Mesh.Simplices.push_back(m.Mesh.Simplices[s]);
        for (std::uint32_t& v : m.Mesh.Simplices.back())
        {
          v += points;
        }
        m.Mesh.Labels.push_back(m.Mesh.Labels[s]);
      }
    });
}

TEST(StressChecks, FindWhatIsNotDelaunay)
{
  Meshed<3> optimised([](StressCase<3>& c) { c.Options.Optimisation.Run = true; });
  optimised.Of.Options.Optimisation.Run = false;
  EXPECT_TRUE(optimised.Check().Has("delaunay"));
  // A vertex that moves a little changes balls, not orientations.
  ExpectFound<4>("delaunay",
    [](Meshed<4>& m)
    {
      m.Of.Options.Interfaces.Fit = false; // says that nothing was moved
      m.Of.Options.Optimisation.Run = false;
      for (std::size_t v = 0; v < m.Mesh.Points.size(); v += 10)
      {
        m.Mesh.Points[v][0] += 0.1;
      }
    });
}

TEST(StressChecks, FindPoorShapes)
{
  ExpectFound<3>("ratio", [](Meshed<3>& m) { m.Of.Options.Shape.RadiusEdgeRatio = 1.2; });
  ExpectFound<4>("ratio", [](Meshed<4>& m) { m.Of.Options.Shape.RadiusEdgeRatio = 1.0; });
  ExpectFound<3>("size", [](Meshed<3>& m) { m.Of.Size.Everywhere = 0.7; });
  ExpectFound<4>("size",
    [](Meshed<4>& m)
    {
      m.Of.Size.Label = 7;
      m.Of.Size.OfLabel = 0.7;
    });
  ExpectFound<3>("sliver", [](Meshed<3>& m) { m.Of.Options.Shape.Slivers.Angle = 25.0; });
  ExpectFound<3>("facet-angle", [](Meshed<3>& m) { m.Of.Options.Shape.FacetAngle = 40.0; });
}

TEST(StressChecks, FindWhatIsNotOfTheImage)
{
  ExpectFound<3>("lost",
    [](Meshed<3>& m) { // the third box is not meshed
      for (std::int64_t& label : m.Mesh.Labels)
      {
        label = label == 9 ? 7 : label;
      }
    });
  ExpectFound<3>("lost-list",
    [](Meshed<3>& m) {
      m.Stats.Components.Lost.push_back({ 3, 5, { 2, 2, 2 } });
    });
  const auto move = [](auto& m)
  {
    for (auto& p : m.Mesh.Points)
    {
      p[1] += 3.0;
    }
  };
  ExpectFound<3>("off-interface", move);
  ExpectFound<3>("outside", move);
  ExpectFound<4>("off-interface", move);
  ExpectFound<3>("volume",
    [](Meshed<3>& m)
    {
      for (auto& p : m.Mesh.Points)
      {
        p[0] *= 4.0;
      }
    });
  ExpectFound<4>("outside", // the ends in time are those of the image
    [](Meshed<4>& m)
    {
      for (auto& p : m.Mesh.Points)
      {
        p[3] += 0.01;
      }
    });
}

TEST(StressChecks, FindWhatTouchesSilently)
{
  const auto cut = [](auto& m)
  {
    for (std::size_t s = 0; s < m.Mesh.Simplices.size(); ++s) // a slice of a box
    {
      double x = 0.0;
      for (const std::uint32_t v : m.Mesh.Simplices[s])
      {
        x += m.Mesh.Points[v][0] / static_cast<double>(m.Mesh.Simplices[s].size());
      }
      m.Mesh.Labels[s] = x > 2.0 && x < 3.5 ? 7 : m.Mesh.Labels[s];
    }
  };
  ExpectFound<3>("broken", cut);
  ExpectFound<4>("broken", cut);
  const auto touch = [](auto& m)
  {
    for (auto& labels : m.Mesh.FacetLabels)
    {
      labels = labels == std::array<std::int64_t, 2>{ 7, 3 } ? std::array<std::int64_t, 2>{ 9, 3 }
                                                             : labels;
    }
  };
  ExpectFound<3>("contact", touch);
  ExpectFound<4>("contact", touch);
  const Meshed<3> twins(
    [](StressCase<3>&
        of) // the third box has the label of the first, and that of the second is between them
    {
      of.Image.ForEach(
        [&](const Volume<3>::Index& v, std::size_t i)
        {
          const bool inside = v[1] > 0 && v[1] < 7 && v[2] > 0 && v[2] < 7;
          of.Image.Labels[i] = inside && (v[0] == 9 || v[0] == 10) ? 7
            : of.Image.Labels[i] == 9                              ? 3
                                                                   : of.Image.Labels[i];
        });
    });
  ExpectNothing(twins);
  ExpectFoundIn<3>(twins, "united",
    [](Meshed<3>& m) { std::fill(m.Mesh.Labels.begin(), m.Mesh.Labels.end(), 3); });
}

TEST(StressChecks, ExcuseWhatOptimisationMayMove)
{
  Meshed<3> moved([](StressCase<3>& c) { c.Options.Optimisation.Run = true; });
  auto& points = moved.Mesh.Points;
  const auto last = std::max_element(
    points.begin(), points.end(), [](const auto& a, const auto& b) { return a[0] < b[0]; });
  const double end = 13.0;                    // voxels of the third box end at 12
  (*last)[0] = end + 0.2 * moved.Stats.Delta; // vertices may be moved by a quarter of delta
  EXPECT_FALSE(moved.Check().Has("outside"));
  (*last)[0] = end + 0.3 * moved.Stats.Delta;
  EXPECT_TRUE(moved.Check().Has("outside"));
  moved.Of.Options.Optimisation.Run = false;
  (*last)[0] = end + 0.2 * moved.Stats.Delta;
  EXPECT_TRUE(moved.Check().Has("outside"));
}

TEST(StressChecks, FindEdgesThatAreNotManifold)
{
  ExpectFound<3>("non-manifold",
    [](Meshed<3>& m)
    {
      MakePairAtRidge<3>(m);
      m.Of.Options.Interfaces.Manifold = false;
      EXPECT_FALSE(m.Check().Has("non-manifold"));
      m.Of.Options.Interfaces.Manifold = true;
      m.Of.Options.Interfaces.Rounds = 0; // does not matter
    });
}

TEST(StressChecks, FindTrianglesThatAreNotManifold)
{
  ExpectFound<4>("non-manifold",
    [](Meshed<4>& m)
    {
      MakePairAtRidge<4>(m);
      m.Of.Options.Interfaces.Manifold = false;
      EXPECT_FALSE(m.Check().Has("non-manifold"));
      m.Of.Options.Interfaces.Manifold = true;
      m.Stats.Planes.Times = { 0.0 }; // the triangle lies on a plane
      EXPECT_FALSE(m.Check().Has("non-manifold"));
      m.Stats.Planes.Times = { 0.5 };
    });
}

TEST(StressChecks, FindNothingAtGoodPlanes)
{
  ExpectNothing(Meshed<4>(MakePeriodicWithPlane));
  const Meshed<4> refined(
    [](StressCase<4>& c)
    {
      MakePeriodicWithPlane(c);
      c.Options.Interfaces.Fit = false; // each slab is Delaunay
    });
  ExpectNothing(refined);
  ExpectFoundIn<4>(refined, "delaunay",
    [](Meshed<4>& m)
    {
      for (std::size_t v = 0; v < m.Mesh.Points.size(); v += 10)
      {
        m.Mesh.Points[v][0] += 0.1;
      }
    });
}

TEST(StressChecks, FindWhatIsWrongAtPlanes)
{
  const Meshed<4> good(MakePeriodicWithPlane);
  const auto expect = [&good](
                        const std::string& cause, const std::function<void(Meshed<4>&)>& spoil)
  { ExpectFoundIn<4>(good, cause, spoil); };
  expect("planes", [](Meshed<4>& m) { m.Of.Options.Planes.Times = { 1.4 }; });
  expect("planes", [](Meshed<4>& m) { m.Of.Options.Planes.Times.push_back(2.5); });
  expect("planes", [](Meshed<4>& m) { m.Of.Options.Planes.Periodic = false; });
  expect("planes", [](Meshed<4>& m) { m.Stats.Planes.Periodic = false; });
  expect("planes", [](Meshed<4>& m) { m.Stats.Planes.Times = { 1.5, 1.5 }; });
  expect("slab", [](Meshed<4>& m) { m.Mesh.Slabs.clear(); });
  expect("slab", [](Meshed<4>& m) { m.Mesh.Slabs[6] = 1 - m.Mesh.Slabs[6]; });
  expect("crosses-plane",
    [](Meshed<4>& m)
    {
      for (auto& p : m.Mesh.Points)
      {
        p[3] += p[3] == 1.5 ? 1e-12 : 0.0;
      }
    });
  const auto relabel = [](double time)
  {
    return [time](Meshed<4>& m)
    {
      std::int64_t& label = m.Mesh.Labels[PentatopeAt(m.Mesh, time)];
      label = label == 3 ? 7 : 3;
    };
  };
  expect("plane-sides", relabel(1.5));
  expect("period", relabel(0.0));
  expect("period", relabel(3.0));
  expect("twins",
    [](Meshed<4>& m)
    {
      double& x = m.Mesh.Points[m.Mesh.Twins[2][1]][0];
      x = std::nextafter(x, 100.0);
    });
  expect("twins", [](Meshed<4>& m) { m.Mesh.Twins.pop_back(); });
  expect("twins", [](Meshed<4>& m) { m.Mesh.Twins.push_back(m.Mesh.Twins.front()); });
  expect("twins",
    [](Meshed<4>& m)
    {
      m.Of.Options.Planes.Periodic = false;
      m.Stats.Planes.Periodic = false;
    });
  expect("statistics", [](Meshed<4>& m) { ++m.Stats.Planes.Pairs; });
  expect("statistics", [](Meshed<4>& m) { ++m.Stats.Planes.Facets; });
}

TEST(StressChecks, FindWrongStatistics)
{
  ExpectFound<4>("statistics", [](Meshed<4>& m) { m.Stats.Interfaces.NonManifoldLeft = 1; });
  ExpectFound<3>("statistics", [](Meshed<3>& m) { m.Stats.Delta = 2.0; });
  ExpectFound<3>("statistics", [](Meshed<3>& m) { m.Stats.Rules.Fired = {}; });
  ExpectFound<3>("statistics", [](Meshed<3>& m) { m.Stats.Interfaces.NonManifoldLeft = 1; });
  ExpectFound<3>("statistics",
    [](Meshed<3>& m)
    {
      m.Of.Options.Interfaces.Manifold = false;
      EXPECT_FALSE(m.Check().Has("statistics"));
      m.Stats.Interfaces.NonManifoldRepaired = 1;
    });
  ExpectFound<3>("elements", [](Meshed<3>& m) { m.Of.Options.Sampling.Elements = 10; });
}

//------------------------------------------------------------------------------------------------
TEST(StressGeometry, SignsAreExact)
{
  const std::array<Vector<3>, 4> tetrahedron = { { { 0.1, 0.1, 0.1 }, { 1.1, 0.1, 0.1 },
    { 0.1, 1.1, 0.1 }, { 0.1, 0.1, 1.1 } } };
  EXPECT_EQ(Orientation<3>(tetrahedron), 1);
  EXPECT_EQ(InSphere<3>(tetrahedron, { 0.3, 0.3, 0.3 }), 1);
  EXPECT_EQ(InSphere<3>(tetrahedron, { 3.0, 0.3, 0.3 }), -1);
  const std::array<Vector<3>, 4> whole = { { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } };
  EXPECT_EQ(InSphere<3>(whole, { 1, 1, 1 }), 0);
  EXPECT_EQ(InSphere<3>(whole, { 1, 1, std::nextafter(1.0, 0.0) }), 1);
  EXPECT_EQ(InSphere<3>(whole, { 1, 1, std::nextafter(1.0, 2.0) }), -1);
  EXPECT_EQ(Orientation<3>({ { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0.3, 0.4, 1e-300 } } }), 1);
  EXPECT_EQ(Orientation<3>({ { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0.3, 0.4, 0 } } }), 0);
  const std::array<Vector<4>, 5> pentatope = { { { 0, 0, 0, 0 }, { 1, 0, 0, 0 }, { 0, 1, 0, 0 },
    { 0, 0, 1, 0 }, { 0, 0, 0, 1 } } };
  EXPECT_EQ(Orientation<4>(pentatope), 1);
  EXPECT_EQ(InSphere<4>(pentatope, { 1, 1, 1, 1 }), 0);
  EXPECT_EQ(InSphere<4>(pentatope, { 1, 1, 1, std::nextafter(1.0, 0.0) }), 1);
  EXPECT_EQ(InSphere<4>(pentatope, { 1, 1, 1, std::nextafter(1.0, 2.0) }), -1);
}

TEST(StressGeometry, MeasuresOfTheRegularTetrahedron)
{
  const std::array<Vector<3>, 4> p = { { { 1, 1, 1 }, { 1, -1, -1 }, { -1, 1, -1 },
    { -1, -1, 1 } } };
  const auto angles = DihedralAnglesOf(p);
  EXPECT_NEAR(static_cast<double>(angles[0]), 70.528779, 1e-5);
  EXPECT_NEAR(static_cast<double>(angles[1]), 70.528779, 1e-5);
  EXPECT_NEAR(static_cast<double>(SmallestAngleOf(p[0], p[1], p[2])), 60.0, 1e-9);
  std::array<Real, 3> centre;
  EXPECT_NEAR(static_cast<double>(CircumcentreOf<3>(p, centre)), std::sqrt(3.0), 1e-12);
  EXPECT_NEAR(static_cast<double>(ShortestEdgeOf<3>(p)), std::sqrt(8.0), 1e-12);
  EXPECT_NEAR(std::abs(static_cast<double>(VolumeOf<3>(p))), 8.0 / 3.0, 1e-12);
}

//------------------------------------------------------------------------------------------------
TEST(StressCases, ASeedRepeatsACase)
{
  for (std::uint64_t number = 0; number < 40; ++number)
  {
    const CaseId id{ Family::Space, 5, number };
    const StressCase<3> a = MakeCase<3>(id);
    const StressCase<3> b = MakeCase<3>(id);
    EXPECT_EQ(a.Image.Labels, b.Image.Labels);
    EXPECT_EQ(Describe(a), Describe(b));
    EXPECT_NE(Describe(a), Describe(MakeCase<3>({ Family::Space, 6, number })));
  }
}

TEST(StressCases, SomeOfFourDimensionsHavePlanesOrPeriodsOrGreyValues)
{
  std::size_t planes = 0;
  std::size_t periods = 0;
  std::size_t series = 0;
  std::size_t refused = 0;
  constexpr std::uint64_t cases = 200;
  for (std::uint64_t number = 0; number < cases; ++number)
  {
    const CaseId id{ Family::SpaceTime, 5, number };
    const StressCase<4> c = MakeCase<4>(id);
    const std::string words = Describe(c);
    EXPECT_EQ(words, Describe(MakeCase<4>(id)));
    const TimePlaneOptions& options = c.Options.Planes;
    EXPECT_EQ(!options.Times.empty(), words.find("--time-planes") != std::string::npos);
    EXPECT_EQ(options.Periodic, words.find("--periodic") != std::string::npos);
    EXPECT_EQ(c.Image.Surface.has_value(), words.find("--isovalue") != std::string::npos);
    planes += !options.Times.empty();
    periods += options.Periodic;
    series += c.Image.Surface.has_value();
    refused += options.AreWanted() && c.Options.Team.Reproducible;
    EXPECT_FALSE(options.Periodic && c.Image.Surface.has_value()); // is refused
    const auto frame = static_cast<std::ptrdiff_t>(c.Image.Labels.size()) / c.Image.Dimensions[3];
    refused += options.Periodic &&
      !std::equal(
        c.Image.Labels.begin(), c.Image.Labels.begin() + frame, c.Image.Labels.end() - frame);
  }
  EXPECT_GT(planes, cases / 5);
  EXPECT_GT(periods, cases / 10);
  EXPECT_GT(series, cases / 10);
  EXPECT_LT(refused, cases / 20);
}

TEST(StressCases, EndlessRunsAreEnded)
{
  StressCase<3> of = Boxes<3>();
  of.Options.Sampling.Delta = 0.02; // millions of elements
  of.Options.Limits.Force = true;
  RunLimits limits;
  limits.Seconds = 0.2;
  EXPECT_TRUE(RunCase(of, limits).Has("endless"));
}

TEST(StressCases, RefusalsAreNoFailures)
{
  StressCase<3> of = Boxes<3>();
  of.Options.Shape.RadiusEdgeRatio = 1.5;
  EXPECT_EQ(RunCase(of, {}).Status, CaseStatus::Refused);
}

TEST(StressCases, CrashesAndHangsAreResults)
{
  const CaseResult good = RunInChild([] { return RunCase(Boxes<3>(), {}); }, 100.0);
  EXPECT_EQ(good.Status, CaseStatus::Passed);
  EXPECT_EQ(good.Elements, RunCase(Boxes<3>(), {}).Elements);
  EXPECT_TRUE(RunInChild([]() -> CaseResult { std::abort(); }, 100.0).Has("crash"));
  EXPECT_TRUE(RunInChild(
    []() -> CaseResult
    {
      for (;;)
      {
        sleep(1);
      }
    },
    0.1)
                .Has("hang"));
}

TEST(StressCases, ReductionKeepsTheCause)
{
  StressCase<3> of = Boxes<3>();
  of.Options.Team.Threads = 2;
  of.Options.Sampling.Gradation = 1.0;
  RunLimits limits;
  limits.OperationsPerVertex = 0.01; // any work exceeds the limit
  ASSERT_TRUE(RunCase(of, limits).Has("work"));
  const StressCase<3> smaller = Reduce(of, "work", limits, {});
  EXPECT_TRUE(RunCase(smaller, limits).Has("work"));
  EXPECT_EQ(smaller.Options.Team.Threads, 1u);
  EXPECT_EQ(smaller.Options.Sampling.Gradation, MeshingOptions<3>().Sampling.Gradation);
  EXPECT_LT(smaller.Image.Size(), of.Image.Size() / 8);
}

TEST(StressCases, ReductionLeavesOutPlanes)
{
  StressCase<4> of = Boxes<4>();
  MakePeriodicWithPlane(of);
  RunLimits limits;
  limits.OperationsPerVertex = 0.01;
  ASSERT_TRUE(RunCase(of, limits).Has("work"));
  const StressCase<4> smaller = Reduce(of, "work", limits, {});
  EXPECT_TRUE(RunCase(smaller, limits).Has("work"));
  EXPECT_FALSE(smaller.Options.Planes.AreWanted());
  EXPECT_LT(smaller.Image.Size(), of.Image.Size() / 8);
}
