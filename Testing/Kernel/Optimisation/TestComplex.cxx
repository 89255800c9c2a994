// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// The mesh of a labelled triangulation against its definition, written down without threads.
#include "Base/Error.h"
#include "ComplexOf.h"
#include "MeshChecks.h"
#include "TriangulationChecks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <random>
#include <set>
#include <thread>

using namespace voxplex;
using namespace voxplex::checks;
using voxplex::checks::ExpectSame;

namespace
{

/** The first thread waits until another one comes. The time limit is longer than any machine is that busy. */
class Meeting
{
public:
  void Arrive()
  {
    std::unique_lock lock(this->Mutex);
    this->Threads.insert(std::this_thread::get_id());
    this->Changed.notify_all();
    const auto isOver = [this] { return this->Threads.size() > 1 || this->Failed; };
    this->Failed = !this->Changed.wait_for(lock, std::chrono::seconds(100), isOver) || this->Failed;
  }
  bool TookPlace() const { return this->Threads.size() > 1; }

private:
  std::mutex Mutex;
  std::condition_variable Changed;
  std::set<std::thread::id> Threads;
  bool Failed = false;
};

/** A unit cube of labels 10 and 20 in background, told apart by a plane; counts what it is asked. */
template <int D>
class TwoLabels final : public Domain<D>
{
public:
  explicit TwoLabels(double margin)
    : Margin(margin)
  {
  }
  Box<D> Bounds() const override
  {
    Box<D> box;
    box.Min.fill(0.0);
    box.Max.fill(1.0);
    return box;
  }
  LabelId Label(const Point<D>& p) const override
  {
    this->Count(this->LabelCalls, this->StopAtLabel);
    if (this->LabelMeeting)
    {
      this->LabelMeeting->Arrive();
    }
    for (const double x : p)
    {
      if (x < this->Margin || x > 1.0 - this->Margin)
      {
        return 0;
      }
    }
    return p[0] + 0.3 * p[1] < 0.6 ? 1 : 2;
  }
  std::int64_t LabelValue(LabelId id) const override { return 10 * id; }
  double DistanceBound(const Point<D>&) const override { return 0.0; }
  bool NearSurfacePoint(const Point<D>&, LabelId, Point<D>&, double&) const override
  {
    return false;
  }
  bool ClosestSurfacePoint(const Point<D>&, LabelId, Point<D>&) const override { return false; }
  bool FirstCrossing(const Point<D>&, LabelId, const Point<D>&, Point<D>&) const override
  {
    return false;
  }

  Meeting* LabelMeeting = nullptr;
  /** Requests a stop in the n-th call. */
  std::size_t StopAtLabel = ~std::size_t{ 0 };
  mutable std::atomic<std::size_t> LabelCalls = 0;
  mutable std::stop_source Stop;

private:
  void Count(std::atomic<std::size_t>& calls, std::size_t stopAt) const
  {
    if (++calls == stopAt)
    {
      this->Stop.request_stop();
    }
  }
  double Margin; ///< of background
};

/** Random points in the unit cube; some are removed again, so that ids are left unused. */
template <int D>
std::unique_ptr<Triangulation<D>> RandomTriangulation(std::size_t points)
{
  auto triangulation = std::make_unique<Triangulation<D>>(TwoLabels<D>(0.0).Bounds());
  typename Triangulation<D>::Worker worker(*triangulation);
  std::mt19937 random(static_cast<unsigned>(points));
  std::uniform_real_distribution<double> uniform(0.01, 0.99);
  std::vector<VertexId> removable;
  SimplexId hint = 0;
  const auto rememberLast = [&] { hint = worker.Created[0]; };
  for (std::size_t i = 0; i < points; ++i)
  {
    const Point<D> p = Drawn<D>([&] { return uniform(random); });
    const SimplexId seed = triangulation->FindConflict(worker, p, hint);
    EXPECT_EQ(triangulation->Insert(worker, p, VertexKind::Free, seed), InsertionOutcome::Inserted);
    rememberLast();
    if (i % 10 == 0)
    {
      removable.push_back(worker.NewVertex);
    }
  }
  for (const VertexId v : removable)
  {
    if (triangulation->Remove(worker, v) == RemovalOutcome::Removed)
    {
      rememberLast();
    }
  }
  return triangulation;
}

/** The mesh that a complex writes, step by step. */
template <int D>
SimplexMesh<D> Expected(const Triangulation<D>& triangulation, const Domain<D>& image)
{
  std::map<SimplexId, LabelId> labels;
  std::map<VertexId, std::uint32_t> order;
  for (const SimplexId s : AliveIn(triangulation))
  {
    const SimplexState& state = triangulation.State(s);
    const LabelId label =
      state.Labelled ? state.Label : image.Label(triangulation.GetCircumball(s).Center);
    if (label != 0)
    {
      labels[s] = label;
      for (const VertexId v : triangulation.GetSimplex(s).V)
      {
        order[v] = 0;
      }
    }
  }
  SimplexMesh<D> mesh;
  for (auto& [v, number] : order)
  {
    number = static_cast<std::uint32_t>(mesh.Points.size());
    mesh.Points.push_back(triangulation.Position(v));
  }
  for (const auto& [s, label] : labels)
  {
    auto& simplex = mesh.Simplices.emplace_back();
    for (std::size_t i = 0; i < simplex.size(); ++i)
    {
      simplex[i] = order.at(triangulation.GetSimplex(s).V[i]);
    }
    mesh.Labels.push_back(image.LabelValue(label));
    for (unsigned i = 0; i < simplex.size(); ++i)
    {
      const auto other = labels.find(triangulation.GetSimplex(s).N[i]);
      const LabelId otherLabel = other == labels.end() ? LabelId(0) : other->second;
      if (otherLabel < label)
      {
        auto& facet = mesh.Facets.emplace_back();
        std::copy(simplex.begin() + i + 1, simplex.end(),
          std::copy(simplex.begin(), simplex.begin() + i, facet.begin()));
        if (i % 2 == 1)
        {
          std::swap(facet[0], facet[1]);
        }
        mesh.FacetLabels.push_back({ mesh.Labels.back(), image.LabelValue(otherLabel) });
      }
    }
  }
  return mesh;
}

template <int D>
bool IsEmpty(const SimplexMesh<D>& mesh)
{
  return mesh.Points.empty() && mesh.Simplices.empty() && mesh.Labels.empty() &&
    mesh.Facets.empty() && mesh.FacetLabels.empty();
}

template <int D>
void ExpectTheDefinition(std::size_t points, double margin)
{
  const auto triangulation = RandomTriangulation<D>(points);
  const TwoLabels<D> image(margin);
  const SimplexMesh<D> expected = Expected<D>(*triangulation, image);
  for (const unsigned threads : { 0u, 1u, 2u, 3u, 8u })
  {
    SCOPED_TRACE(threads);
    SimplexMesh<D> mesh;
    ExtractMesh<D>(*triangulation, image, mesh, threads);
    ExpectSame(mesh, expected);
  }
}

} // namespace

// Enough for several chunks of every loop.
TEST(Complex, IsTheDefinitionForAnyNumberOfThreads)
{
  ExpectTheDefinition<3>(20000, 0.1);
  ExpectTheDefinition<4>(1500, 0.05);
}

// Fewer elements than threads.
TEST(Complex, TinyMeshes)
{
  for (const std::size_t points : { 0u, 1u, 5u, 30u })
  {
    ExpectTheDefinition<3>(points, 0.0);
    ExpectTheDefinition<3>(points, 0.3);
    ExpectTheDefinition<4>(points, 0.0);
  }
}

TEST(Complex, IsConforming)
{
  const auto triangulation = RandomTriangulation<3>(3000);
  SimplexMesh<3> mesh;
  ExtractMesh<3>(*triangulation, TwoLabels<3>(0.1), mesh, 3);
  EXPECT_GT(mesh.Simplices.size(), 5000u);
  checks::ExpectSound(mesh);
}

TEST(SimplexLabels, AreFoundByThreadsAtOnce)
{
  const auto triangulation = RandomTriangulation<3>(5000);
  Meeting labelling;
  TwoLabels<3> image(0.0);
  image.LabelMeeting = &labelling;
  LabelSimplices<3>(*triangulation, image, 2);
  EXPECT_TRUE(labelling.TookPlace());
}

TEST(Complex, WithoutObjectTheMeshIsEmpty)
{
  const auto triangulation = RandomTriangulation<3>(20);
  for (const unsigned threads : { 1u, 2u, 3u, 8u })
  {
    SimplexMesh<3> mesh;
    ExtractMesh<3>(*triangulation, TwoLabels<3>(0.0), mesh, threads);
    ASSERT_FALSE(IsEmpty(mesh));
    ExtractMesh<3>(*triangulation, TwoLabels<3>(0.6), mesh, threads);
    EXPECT_TRUE(IsEmpty(mesh)) << "what the mesh held is lost";
  }
}

TEST(Complex, LabelsThatAreKnownAreNotAskedFor)
{
  const auto triangulation = RandomTriangulation<3>(500);
  const TwoLabels<3> image(0.1);
  std::size_t unknown = 0;
  for (const SimplexId s : AliveIn(*triangulation))
  {
    if (s % 10 == 0)
    {
      ++unknown;
      continue;
    }
    triangulation->State(s).Label = 3; // not what the image would say
    triangulation->State(s).Labelled = true;
  }
  const SimplexMesh<3> expected = Expected<3>(*triangulation, image);
  for (const unsigned threads : { 1u, 3u })
  {
    image.LabelCalls = 0;
    SimplexMesh<3> mesh;
    ExtractMesh<3>(*triangulation, image, mesh, threads);
    EXPECT_EQ(image.LabelCalls, unknown);
    ExpectSame(mesh, expected);
    EXPECT_EQ(std::ranges::count(mesh.Labels, 30), std::ranges::count(expected.Labels, 30));
  }
}

// While labels are found, when all are found, and when the complex is made.
TEST(Complex, StopsInTheMiddle)
{
  const auto triangulation = RandomTriangulation<3>(20000);
  const TwoLabels<3> counted(0.0);
  SimplexMesh<3> mesh;
  ExtractMesh<3>(*triangulation, counted, mesh);
  const std::size_t labels = counted.LabelCalls;
  ASSERT_GT(labels, 80000u);
  constexpr std::size_t Chunk = 8192;
  for (const unsigned threads : { 1u, 2u, 3u, 8u })
  {
    SCOPED_TRACE(threads);
    const auto expectStop = [&](const TwoLabels<3>& image)
    {
      EXPECT_THROW(
        ExtractMesh<3>(*triangulation, image, mesh, threads, image.Stop.get_token()), Cancelled);
      EXPECT_TRUE(IsEmpty(mesh));
    };
    TwoLabels<3> first(0.0);
    first.StopAtLabel = 20;
    expectStop(first);
    EXPECT_LT(first.LabelCalls, threads * Chunk + 1) << "chunks that ran, but no others";

    TwoLabels<3> last(0.0);
    last.StopAtLabel = labels;
    expectStop(last);
    EXPECT_EQ(last.LabelCalls, labels);

    UninitialisedVector<std::uint32_t> numbers;
    Complex<3> complex(*triangulation, LabelSimplices<3>(*triangulation, counted), {}, numbers);
    complex.Compact(false);
    EXPECT_THROW(
      complex.Write(ValuesOf<3>(counted, { 1, 2 }), mesh, threads, last.Stop.get_token()),
      Cancelled);
    EXPECT_TRUE(IsEmpty(mesh));
  }
}
