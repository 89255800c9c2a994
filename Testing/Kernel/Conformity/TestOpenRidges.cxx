// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Edges that are not manifold are opened by cutting tetrahedra around them in pieces; none is left, on any labels.
#include "Base/Error.h"
#include "Conformity/OpenRidges.h"
#include "Domain/ImageDomain.h"
#include "Geometry/SimplexQuality.h"
#include "InterfaceChecks.h"
#include "Mesh/LabelledTriangulation.h"
#include "RefinementChecks.h"

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

/** Which edges of a triangulation are not manifold with these labels, from the mesh. */
std::vector<InterfaceEdge> BadEdgesOf(
  const Triangulation<3>& triangulation, const SimplexMesh<3>& mesh)
{
  std::map<Point<3>, VertexId> vertices;
  for (VertexId v = 0; v < triangulation.VertexIdEnd(); ++v)
  {
    if (triangulation.GetVertex(v).Alive)
    {
      vertices[triangulation.Position(v)] = v;
    }
  }
  std::vector<InterfaceEdge> edges;
  for (const auto& ends : BadEdges(mesh))
  {
    std::array<VertexId, 2> edge{ vertices.at(mesh.Points[ends[0]]),
      vertices.at(mesh.Points[ends[1]]) };
    std::sort(edge.begin(), edge.end());
    edges.push_back({ edge, false });
  }
  return edges;
}

double TotalVolume(const SimplexMesh<3>& mesh)
{
  double volume = 0.0;
  for (const auto& [label, part] : Volumes(mesh))
  {
    volume += part;
  }
  return volume;
}

/** A mesh before and after. */
struct Opened
{
  Opened(const Triangulation<3>& triangulation, const Domain<3>& domain,
    std::span<const LabelId> labels, unsigned threads = 1)
  {
    ExtractMesh<3>(triangulation, domain, labels, this->Before, threads);
    this->Edges = BadEdgesOf(triangulation, this->Before);
    this->Result = OpenRidges<3>(triangulation, domain, labels, this->Edges);
    ExtractMesh<3>(
      triangulation, domain, labels, this->After, threads, {}, { {}, this->Result.Parts });
  }

  /** Checks what must hold with all labels. */
  void Check() const
  {
    EXPECT_TRUE(this->Result.Left.empty());
    EXPECT_TRUE(BadEdges(this->After).empty());
    const std::vector<std::string> complaints = Complaints(this->After);
    EXPECT_TRUE(complaints.empty()) << complaints.front();
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

  std::vector<InterfaceEdge> Edges;
  OpenedRidges<3> Result;
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
    std::mt19937 random(seed);
    SimplexLabels labels = LabelSimplices<3>(this->Context->Mesh, this->Ball);
    for (LabelId& label : labels)
    {
      const auto drawn = static_cast<LabelId>(random() % (number + (withBackground ? 1 : 0)));
      label = label == 0 ? LabelId{ 0 } : static_cast<LabelId>(drawn + (withBackground ? 0 : 1));
    }
    return labels;
  }

  const BallDomain Ball;
  const std::unique_ptr<const RefinementContext<3>> Context;
};

/** Independent voxels with `labels` labels and background, all equally likely. */
LabelImage<3> Noise(unsigned seed, std::int64_t side, unsigned labels)
{
  std::mt19937 random(seed);
  std::vector<std::uint16_t> voxels(static_cast<std::size_t>(side * side * side));
  for (std::uint16_t& voxel : voxels)
  {
    voxel = static_cast<std::uint16_t>(random() % (labels + 1));
  }
  return LabelImage<3>::FromScalars<std::uint16_t>(
    voxels, GridGeometry<3>::Orthogonal({ side, side, side }, { 1.0, 1.0, 1.0 }));
}

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

// No tetrahedron is lost with its label: all keep pieces, which lie within.
TEST(OpenRidges, LeaveSomethingOfEachTetrahedron)
{
  const ShuffledBall shuffled;
  const Triangulation<3>& mesh = shuffled.Context->Mesh;
  const SimplexLabels labels = shuffled.Labels(7, 3, true);
  const Opened opened(mesh, PlainLabels(), labels);
  const auto volumeOf = [&](const std::array<VertexId, 4>& v)
  {
    std::array<const Point<3>*, 4> points;
    for (std::size_t i = 0; i < 4; ++i)
    {
      points[i] = v[i] < mesh.VertexIdEnd()
        ? &mesh.Position(v[i])
        : &opened.Result.Parts.Points[v[i] - mesh.VertexIdEnd()];
    }
    return SignedVolume<3>(points.data());
  };
  // Pieces come in the order of what they replace, and fill it.
  const Subdivision<3>& parts = opened.Result.Parts;
  ASSERT_GT(parts.Replaced.size(), 100u);
  EXPECT_TRUE(std::is_sorted(parts.Replaced.begin(), parts.Replaced.end()));
  std::size_t next = 0;
  for (const SimplexId s : parts.Replaced)
  {
    const double volume = volumeOf(mesh.GetSimplex(s).V);
    double filled = 0.0;
    bool keepsSome = false;
    while (filled < volume * (1.0 - 1e-9) && next < parts.Pieces.size())
    {
      const double part = volumeOf(parts.Pieces[next].V);
      EXPECT_GT(part, 0.0);
      filled += part;
      keepsSome |= parts.Pieces[next].Label == labels[s];
      ++next;
    }
    EXPECT_NEAR(filled, volume, 1e-9 * volume);
    EXPECT_TRUE(keepsSome);
  }
  EXPECT_EQ(next, parts.Pieces.size());
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
TEST(MeshExtraction, PiecesAreBehindTheOtherTetrahedra)
{
  const ShuffledBall shuffled;
  const SimplexLabels labels = shuffled.Labels(3, 2, true);
  const Opened opened(shuffled.Context->Mesh, PlainLabels(), labels);
  ASSERT_GT(opened.After.Points.size(), opened.Before.Points.size());
  EXPECT_TRUE(std::equal(
    opened.Before.Points.begin(), opened.Before.Points.end(), opened.After.Points.begin()));
  const auto pieces = std::count_if(opened.Result.Parts.Pieces.begin(),
    opened.Result.Parts.Pieces.end(), [](const Piece<3>& piece) { return piece.Label != 0; });
  auto before = opened.Before.Simplices.begin();
  for (std::size_t t = 0; t + static_cast<std::size_t>(pieces) < opened.After.Simplices.size(); ++t)
  {
    before = std::find(before, opened.Before.Simplices.end(), opened.After.Simplices[t]);
    ASSERT_NE(before, opened.Before.Simplices.end()) << t;
  }
}

TEST(MeshExtraction, PiecesDoNotDependOnThreads)
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
  LabelledTriangulation<3>::LabelReader labelOf(elements);
  std::vector<Element> found;
  for (std::size_t t = 0; t < elements.Size(); ++t)
  {
    if (const LabelId label = labelOf(t); label != 0)
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

TEST(Subdivision, LeavesAGoodMeshAlone)
{
  const Triangulated ring(Ring({ 1, 1, 2, 3 }));
  const Opened opened(*ring.Source, PlainLabels(), ring.Labels);
  EXPECT_TRUE(opened.Edges.empty());
  EXPECT_TRUE(opened.Result.Parts.Replaced.empty());
  EXPECT_TRUE(opened.Result.Parts.Points.empty());
  EXPECT_TRUE(std::equal(opened.Before.Simplices.begin(), opened.Before.Simplices.end(),
    opened.After.Simplices.begin(), opened.After.Simplices.end()));
}

TEST(OpenRidges, StopOnRequest)
{
  const Triangulated ring(Ring({ 1, 2, 1, 2 }));
  std::stop_source stop;
  stop.request_stop();
  const std::vector<InterfaceEdge> edges = BadEdgesOf(*ring.Source, ring.Extract());
  EXPECT_THROW(
    OpenRidges<3>(*ring.Source, PlainLabels(), ring.Labels, edges, stop.get_token()), Cancelled);
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
    ImageMesher<3> mesher(options);
    SimplexMesh<3> mesh;
    ASSERT_EQ(mesher.Run(Noise(seed, 8, 1 + seed % 7), mesh), MeshingOutcome::Done);
    EXPECT_TRUE(BadEdges(mesh).empty());
    const std::vector<std::string> complaints = Complaints(mesh);
    EXPECT_TRUE(complaints.empty()) << complaints.front();
    const InterfaceStatistics& figures = mesher.Statistics().Interfaces;
    EXPECT_EQ(figures.NonManifoldLeft, 0u);
    EXPECT_LE(figures.NonManifoldOpened, figures.NonManifoldRepaired);
    opened += figures.NonManifoldOpened;
  }
  EXPECT_GT(opened, 10u);
}

TEST(ManifoldMeshes, AreLeftAsTheyComeOnRequest)
{
  MeshingOptions<3> options;
  options.Sampling.Delta = 2.0;
  options.SmoothingSigma = 0.0;
  options.Interfaces.Manifold = false;
  ImageMesher<3> mesher(options);
  SimplexMesh<3> mesh;
  ASSERT_EQ(mesher.Run(Noise(1, 8, 3), mesh), MeshingOutcome::Done);
  EXPECT_FALSE(BadEdges(mesh).empty());
  EXPECT_EQ(mesher.Statistics().Interfaces.NonManifoldRepaired, 0u);
}
