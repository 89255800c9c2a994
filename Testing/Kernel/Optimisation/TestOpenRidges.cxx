// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Edges that are not manifold are opened by cutting tetrahedra around them in pieces; none is left, on any labels.
#include "Base/Error.h"
#include "ComplexOf.h"
#include "Domain/ImageDomain.h"
#include "Geometry/SimplexQuality.h"
#include "InterfaceChecks.h"
#include "Mesh/LabelledTriangulation.h"
#include "Optimisation/OpenRidges.h"
#include "Phantoms.h"
#include "RefinementChecks.h"
#include "RepairTesting.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

using namespace voxplex;
using namespace voxplex::checks;

namespace
{

/** The edges of a mesh that are not manifold. */
std::vector<InterfaceEdge> BadEdgesOf(const SimplexMesh<3>& mesh)
{
  std::vector<InterfaceEdge> edges;
  for (const auto& ends : BadEdges(mesh))
  {
    std::array<std::uint32_t, 2> edge{ ends[0], ends[1] };
    std::sort(edge.begin(), edge.end());
    edges.push_back({ edge, false });
  }
  return edges;
}

/** A mesh before and after. */
struct Opened
{
  Opened(const Triangulation<3>& triangulation, const Domain<3>& domain,
    const SimplexLabels& labels, unsigned threads = 1)
    : Cells(triangulation, labels, {}, this->Numbers, threads)
    , Pieces(Cells)
  {
    ExtractMesh<3>(triangulation, domain, labels, this->Before, threads);
    this->Edges = BadEdgesOf(this->Before); // points of the mesh have the numbers of the complex
    this->Left = OpenRidges<3>(this->Pieces, domain, this->Edges);
    TetrahedralComplex complex = this->Pieces;
    complex.Compact(false, threads);
    complex.Write(ValuesOf(domain, labels), this->After, threads);
  }

  /** Checks what must hold with all labels. */
  void Check() const
  {
    EXPECT_TRUE(this->Left.empty());
    EXPECT_TRUE(BadEdges(this->After).empty());
    ExpectSound(this->After);
    const std::set<std::int64_t> labels(this->Before.Labels.begin(), this->Before.Labels.end());
    EXPECT_EQ(std::set<std::int64_t>(this->After.Labels.begin(), this->After.Labels.end()), labels);
    // Each tetrahedron keeps pieces with its label, and so does each part of a label.
    EXPECT_GE(this->After.Simplices.size(), this->Before.Simplices.size());
    for (const Point<3>& p : this->Before.Points)
    {
      EXPECT_NE(std::find(this->After.Points.begin(), this->After.Points.end(), p),
        this->After.Points.end());
    }
  }

  UninitialisedVector<std::uint32_t> Numbers; ///< of the triangulation's vertices
  TetrahedralComplex Cells;
  TetrahedralComplex Pieces; ///< the same with the edges opened
  std::vector<InterfaceEdge> Edges;
  std::vector<InterfaceEdge> Left;
  SimplexMesh<3> Before;
  SimplexMesh<3> After;
};

/** A refined triangulation of a ball, whose tetrahedra get labels that know nothing of it. */
class ShuffledBall
{
public:
  ShuffledBall()
    : Ball(4.0)
    , Context(Refined(this->Ball, 0.7))
  {
  }

  /** @param number of labels besides background */
  SimplexLabels Labels(unsigned seed, unsigned number, bool withBackground) const
  {
    return Shuffled(
      LabelSimplices<3>(this->Context->Mesh, this->Ball), seed, number, withBackground);
  }

  const BallDomain Ball;
  const std::unique_ptr<const RefinementContext<3>> Context;
};

} // namespace

// Every sequence of up to three labels and background around an edge of four to seven tetrahedra.
TEST(OpenRidges, OpenEdgesWithAnyLabelsAround)
{
  std::size_t bad = 0;
  for (std::size_t n = 4; n < 8; ++n)
  {
    const auto sequences = static_cast<std::size_t>(std::pow(4.0, static_cast<double>(n)));
    for (std::size_t code = n < 7 ? 0 : 5; code < sequences; code += n < 6 ? 1 : 13)
    {
      std::vector<std::int64_t> labels;
      for (std::size_t rest = code; labels.size() < n; rest /= 4)
      {
        labels.push_back(static_cast<std::int64_t>(rest % 4));
      }
      const SimplexMesh<3> ring = Ring(labels);
      if (BadEdges(ring).empty())
      {
        continue;
      }
      SCOPED_TRACE(testing::PrintToString(labels));
      const Triangulated whole(ring);
      const Opened opened(*whole.Source, PlainLabels(), whole.Labels);
      EXPECT_EQ(opened.Edges.size(), 1u);
      opened.Check();
      ++bad;
    }
  }
  EXPECT_GT(bad, 1000u);
}

// One tetrahedron between two that get part of it: a point within is enough, and its neighbours stay whole.
TEST(OpenRidges, SplitATetrahedronFromWithin)
{
  const Triangulated ring(Ring({ 1, 2, 1, 3 }));
  const Opened opened(*ring.Source, PlainLabels(), ring.Labels);
  opened.Check();
  EXPECT_EQ(opened.After.Points.size(), opened.Before.Points.size() + 1);
  EXPECT_EQ(opened.After.Simplices.size(), opened.Before.Simplices.size() + 3);
  EXPECT_NEAR(TotalVolume(opened.After), TotalVolume(opened.Before), 1e-12);
}

// Narrow tetrahedra would have to be cut to slivers; the wide ones between them need not be.
TEST(OpenRidges, TakeTheBestShapes)
{
  RingShape shape;
  shape.Degrees = { 20.0, 150.0, 40.0, 150.0 };
  const Triangulated ring(Ring({ 1, 2, 1, 2 }, shape));
  const Opened opened(*ring.Source, PlainLabels(), ring.Labels);
  opened.Check();
  const auto smallest = [](const SimplexMesh<3>& mesh)
  {
    double sine = 1.0;
    for (const auto& v : mesh.Simplices)
    {
      const Point<3>* const points[4] = { &mesh.Points[v[0]], &mesh.Points[v[1]],
        &mesh.Points[v[2]], &mesh.Points[v[3]] };
      sine = std::min(sine, SmallestDihedralSine(points));
    }
    return sine;
  };
  EXPECT_GT(smallest(opened.After), 0.6 * smallest(opened.Before));
}

// Nearly every edge is bad, and the pieces that one leaves are cut for the next.
TEST(OpenRidges, OpenAllEdgesAtOnce)
{
  const ShuffledBall shuffled;
  for (unsigned seed = 1; seed <= 6; ++seed)
  {
    SCOPED_TRACE(seed);
    const SimplexLabels labels = shuffled.Labels(seed, 1 + seed / 2, seed % 2 == 1);
    const Opened opened(shuffled.Context->Mesh, PlainLabels(), labels);
    EXPECT_GT(opened.Edges.size(), 100u);
    opened.Check();
    EXPECT_GE(opened.After.Simplices.size(), opened.Before.Simplices.size());
  }
}

// No tetrahedron is lost with its label: all keep pieces, which fill it.
TEST(OpenRidges, LeaveSomethingOfEachTetrahedron)
{
  const ShuffledBall shuffled;
  const Opened opened(shuffled.Context->Mesh, PlainLabels(), shuffled.Labels(7, 3, true));
  const TetrahedralComplex& cells = opened.Cells;
  const TetrahedralComplex& pieces = opened.Pieces;
  const auto isOld = [&](std::uint32_t t)
  { return t < cells.Cells.size() && cells.Cells[t].V == pieces.Cells[t].V; };
  std::vector<std::uint32_t> cut;
  for (std::uint32_t t = 0; t < cells.Cells.size(); ++t)
  {
    if (!isOld(t))
    {
      cut.push_back(t);
    }
  }
  ASSERT_GT(cut.size(), 100u);
  std::map<std::uint32_t, std::pair<double, bool>> filled; // the volume, and whether of its label
  for (std::uint32_t t = 0; t < pieces.Cells.size(); ++t)
  {
    if (!pieces.IsAlive(t) || isOld(t))
    {
      continue;
    }
    const auto points = pieces.PointsOf(pieces.Cells[t].V);
    const Point<3> centre = Centroid(points);
    const auto isInside = [&](std::uint32_t old)
    {
      for (unsigned i = 0; i < 4; ++i)
      {
        auto corners = cells.PointsOf(cells.Cells[old].V);
        corners[i] = &centre;
        if (!(SignedVolume<3>(corners.data()) > 0.0))
        {
          return false;
        }
      }
      return true;
    };
    const auto old = std::find_if(cut.begin(), cut.end(), isInside);
    ASSERT_NE(old, cut.end());
    EXPECT_GT(SignedVolume<3>(points.data()), 0.0);
    filled[*old].first += SignedVolume<3>(points.data());
    filled[*old].second |= pieces.Labels[t] == cells.Labels[*old];
  }
  for (const std::uint32_t t : cut)
  {
    const double volume = SignedVolume<3>(cells.PointsOf(cells.Cells[t].V).data());
    EXPECT_NEAR(filled[t].first, volume, 1e-9 * volume);
    EXPECT_TRUE(filled[t].second);
  }
}

// The ring lies on a lower face of the image and in front of it, with background beyond.
TEST(OpenRidges, LeaveNoDentsWhereTheImageCuts)
{
  const LabelImage<3> image = phantoms::CutCells(5, 200, 3, 1);
  const ImageDomain<3> domain(image, 1.0);
  RingShape shape;
  shape.Degrees = { 60.0, 60.0, 60.0, 180.0 };
  for (const std::vector<std::int64_t>& labels :
    { std::vector<std::int64_t>{ 1, 2, 1, 0 }, { 1, 0, 1, 0 } })
  {
    SimplexMesh<3> mesh = Ring(labels, shape);
    for (Point<3>& p : mesh.Points)
    {
      p = { p[2] + 14.0, p[0] + 14.0, p[1] - 0.5 }; // the image's lower face along z is at -0.5
    }
    const Triangulated ring(mesh);
    const Opened opened(*ring.Source, domain, ring.Labels);
    opened.Check();
    double area[2] = { 0.0, 0.0 };
    for (const SimplexMesh<3>* of : { &opened.Before, &opened.After })
    {
      for (const auto& facet : of->Facets)
      {
        const Point<3>& a = of->Points[facet[0]];
        const Point<3>& b = of->Points[facet[1]];
        const Point<3>& c = of->Points[facet[2]];
        const Point<3> normal = checks::Cross(Subtract(b, a), Subtract(c, a));
        const bool isFlat =
          std::max({ std::abs(a[2] + 0.5), std::abs(b[2] + 0.5), std::abs(c[2] + 0.5) }) < 1e-9;
        area[of == &opened.After] += isFlat ? 0.5 * std::sqrt(Dot(normal, normal)) : 0.0;
      }
    }
    EXPECT_GT(area[0], 0.1);
    EXPECT_NEAR(area[1], area[0], 1e-9);
    for (const Point<3>& p : opened.After.Points)
    {
      EXPECT_GT(p[2], -0.5 - 1e-9);
    }
  }
}

//------------------------------------------------------------------------------------------------
TEST(OpenRidges, KeepTheOrderOfTheRest)
{
  const ShuffledBall shuffled;
  const Opened opened(shuffled.Context->Mesh, PlainLabels(), shuffled.Labels(3, 2, true));
  ASSERT_GT(opened.After.Points.size(), opened.Before.Points.size());
  EXPECT_TRUE(std::equal(
    opened.Before.Points.begin(), opened.Before.Points.end(), opened.After.Points.begin()));
  const std::set<std::array<std::uint32_t, 4>> old(
    opened.Before.Simplices.begin(), opened.Before.Simplices.end());
  auto before = opened.Before.Simplices.begin();
  for (const auto& simplex : opened.After.Simplices)
  {
    if (old.count(simplex) != 0)
    {
      before = std::find(before, opened.Before.Simplices.end(), simplex);
      ASSERT_NE(before, opened.Before.Simplices.end());
    }
  }
}

TEST(OpenRidges, DoNotDependOnThreads)
{
  const ShuffledBall shuffled;
  const SimplexLabels labels = shuffled.Labels(4, 3, false);
  const Opened one(shuffled.Context->Mesh, PlainLabels(), labels, 1);
  const Opened four(shuffled.Context->Mesh, PlainLabels(), labels, 4);
  EXPECT_TRUE(std::equal(one.After.Points.begin(), one.After.Points.end(),
    four.After.Points.begin(), four.After.Points.end()));
  EXPECT_TRUE(std::equal(one.After.Simplices.begin(), one.After.Simplices.end(),
    four.After.Simplices.begin(), four.After.Simplices.end()));
  EXPECT_TRUE(std::equal(one.After.Facets.begin(), one.After.Facets.end(),
    four.After.Facets.begin(), four.After.Facets.end()));
}

// Before extraction the elements are in another order, and have the same labels and points.
TEST(LabelledTriangulation, HasTheElementsOfTheMesh)
{
  const ShuffledBall shuffled;
  const SimplexLabels labels = shuffled.Labels(4, 3, true);
  const Opened opened(shuffled.Context->Mesh, PlainLabels(), labels);
  using Element = std::pair<std::int64_t, std::array<Point<3>, 4>>;
  std::vector<Element> extracted;
  for (std::size_t t = 0; t < opened.Before.Simplices.size(); ++t)
  {
    Element& element = extracted.emplace_back(opened.Before.Labels[t], std::array<Point<3>, 4>{});
    for (std::size_t i = 0; i < 4; ++i)
    {
      element.second[i] = opened.Before.Points[opened.Before.Simplices[t][i]];
    }
  }
  const LabelledTriangulation<3> elements(shuffled.Context->Mesh, labels);
  std::vector<Element> found;
  for (std::size_t t = 0; t < elements.Size(); ++t)
  {
    if (const LabelId label = elements.GetLabels()[t]; label != 0)
    {
      Element& element =
        found.emplace_back(PlainLabels().LabelValue(label), std::array<Point<3>, 4>{});
      for (std::size_t i = 0; i < 4; ++i)
      {
        element.second[i] = *elements.PointsOf(t)[i];
      }
    }
  }
  std::sort(extracted.begin(), extracted.end());
  std::sort(found.begin(), found.end());
  EXPECT_EQ(found, extracted);
}

TEST(OpenRidges, LeaveAGoodMeshAlone)
{
  const Triangulated ring(Ring({ 1, 1, 2, 3 }));
  const Opened opened(*ring.Source, PlainLabels(), ring.Labels);
  EXPECT_TRUE(opened.Edges.empty());
  EXPECT_EQ(opened.Cells.Points, opened.Pieces.Points);
  EXPECT_TRUE(std::equal(opened.Before.Simplices.begin(), opened.Before.Simplices.end(),
    opened.After.Simplices.begin(), opened.After.Simplices.end()));
}

TEST(OpenRidges, StopOnRequest)
{
  const Triangulated ring(Ring({ 1, 2, 1, 2 }));
  std::stop_source stop;
  stop.request_stop();
  UninitialisedVector<std::uint32_t> numbers;
  TetrahedralComplex complex(*ring.Source, ring.Labels, {}, numbers);
  EXPECT_THROW(
    OpenRidges<3>(complex, PlainLabels(), BadEdgesOf(ring.Extract()), {}, stop.get_token()),
    Cancelled);
}

//------------------------------------------------------------------------------------------------
// What is asked for does not matter: rounds, junctions, components, optimisation, smoothing, threads.
TEST(ManifoldMeshes, HaveNoBadEdgesOnAnyImage)
{
  std::uint64_t opened = 0;
  for (unsigned seed = 1; seed <= 24; ++seed)
  {
    MeshingOptions<3> options;
    options.Sampling.Delta = 0.9 + 0.25 * (seed % 9);
    options.Interfaces.Rounds = seed % 4 == 0 ? 0 : seed % 3;
    options.Interfaces.SampleJunctions = seed % 5 != 0;
    options.Components.Smallest = seed % 3 == 0 ? 0 : 8;
    options.SmoothingSigma = seed % 2 == 0 ? 0.0 : 1.0;
    options.Optimisation.Run = seed % 2 == 0;
    options.Team.Threads = seed % 6 == 0 ? 4 : 1;
    SCOPED_TRACE(testing::Message() << "seed " << seed << ", delta " << options.Sampling.Delta);
    SimplexMesh<3> mesh;
    opened +=
      ExpectRidgesOpened(phantoms::Noise(phantoms::Cube(8), seed, 1 + seed % 7), options, mesh);
    EXPECT_TRUE(BadEdges(mesh).empty());
  }
  EXPECT_GT(opened, 10u);
}

TEST(ManifoldMeshes, AreLeftAsTheyComeOnRequest)
{
  MeshingOptions<3> options;
  options.Sampling.Delta = 2.0;
  options.SmoothingSigma = 0.0;
  options.Interfaces.Manifold = false;
  MeshingStatistics statistics;
  const SimplexMesh<3> mesh =
    MeshOf(phantoms::Noise(phantoms::Cube(8), 1, 3), options, &statistics);
  EXPECT_FALSE(BadEdges(mesh).empty());
  EXPECT_EQ(statistics.Interfaces.NonManifoldRepaired, 0u);
}
