// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// InputMode isosurface in space-time: time steps and components, types, times, what is refused.
#include "PentatopeTesting.h"

#include "vtkImageData.h"
#include "vtkMath.h"
#include "vtkMeshingStatistics.h"
#include "vtkNew.h"
#include "vtkTrivialProducer.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <cmath>

using namespace testing;

namespace
{

constexpr int Frames = 6;

/** How deep a point is in a ball of radius 4 that moves along x. */
double Depth(const Vector& x, double t)
{
  return 4.0 - std::hypot(x[0] - 5.0 - 0.25 * t, x[1] - 5.5, x[2] - 5.5);
}

double Hypervolume()
{
  return (Frames - 1.0) * 4.0 / 3.0 * vtkMath::Pi() * 64.0;
}

vtkSmartPointer<vtkImageToPentatopeMeshFilter> AsIsosurface(
  vtkSmartPointer<vtkImageToPentatopeMeshFilter> filter)
{
  filter->SetInputModeToIsosurface();
  filter->SetDelta(1.25);
  filter->PickingRegionsOn(); // without them volumes are less exact
  return filter;
}

vtkSmartPointer<vtkImageToPentatopeMeshFilter> FromSeries(
  const std::vector<double>& times, const MovingLabel& value, int type)
{
  return AsIsosurface(MakePentatopeFilter(MakeSeries(SmallPlacement(), times, value, type)));
}

vtkSmartPointer<vtkImageToPentatopeMeshFilter> FromComponents(
  const std::vector<double>& times, const MovingLabel& value, int type)
{
  vtkNew<vtkTrivialProducer> producer;
  producer->SetOutput(MakeComponents(SmallPlacement(), times, value, type));
  return AsIsosurface(MakePentatopeFilter(producer));
}

/** The same mesh in both ways to hand over frames, with the ball's hypervolume. */
void TestBall()
{
  const auto times = EqualTimes(Frames);
  const auto series = FromSeries(times, Depth, VTK_DOUBLE);
  series->Update();
  CheckMesh(series);
  const double ratio = ReadPentatopes(series->GetOutput()).VolumeOf(1) / Hypervolume();
  CHECK(std::abs(ratio - 1.0) < 0.04, ratio);
  vtkMeshingStatistics* statistics = series->GetStatistics();
  CHECK(statistics->GetFigure("/isosurface/value") == 0.0);
  CHECK(statistics->GetFigure("/isosurface/range/1") == Depth({ 5, 5, 5 }, 0.0));

  const auto components = FromComponents(times, Depth, VTK_DOUBLE);
  components->Update();
  CHECK(SameMesh(series, components));
  const auto floats = FromSeries(times, Depth, VTK_FLOAT); // values are rounded
  floats->Update();
  CheckMesh(floats);
  const double same = ReadPentatopes(floats->GetOutput()).VolumeOf(1) / Hypervolume();
  CHECK(std::abs(same - 1.0) < 0.04, same);
}

/** Whole values in all types: the same mesh, whether they are kept as float or double. */
void TestTypes()
{
  const auto times = EqualTimes(Frames);
  const MovingLabel value = [](const Vector& x, double t)
  { return std::round(60.0 + 8.0 * Depth(x, t)); };
  const auto reference = FromSeries(times, value, VTK_DOUBLE);
  reference->SetIsovalue(60.25);
  reference->Update();
  CheckMesh(reference);
  for (const int type :
    { VTK_CHAR, VTK_SHORT, VTK_UNSIGNED_SHORT, VTK_INT, VTK_LONG_LONG, VTK_FLOAT })
  {
    const auto filter = FromSeries(times, value, type);
    filter->SetIsovalue(60.25);
    filter->Update();
    CHECK(SameMesh(reference, filter), type);
  }
}

/** A type that float does not hold, from the second frame on. */
void TestMixedTypes()
{
  const auto source = MakeSeries(SmallPlacement(), EqualTimes(Frames), Depth, VTK_FLOAT);
  source->MakeFrame = [](int frame)
  {
    return MakeImage(
      SmallPlacement(),
      [frame](const Vector& x) { return 16777217.0 + std::round(8.0 * Depth(x, frame)); },
      frame == 0 ? VTK_FLOAT : VTK_INT);
  };
  const auto filter = AsIsosurface(MakePentatopeFilter(source));
  filter->SetIsovalue(16777217.0);
  filter->Update();
  CheckMesh(filter);
  const double ratio = ReadPentatopes(filter->GetOutput()).VolumeOf(1) / Hypervolume();
  CHECK(std::abs(ratio - 1.0) < 0.05, ratio);
}

/** A frame is missing; values that are linear in time are made again exactly. */
void TestUnequalTimes()
{
  const MovingLabel linear = [](const Vector& x, double t) { return Depth(x, 0.0) + 0.25 * t; };
  const auto whole = FromSeries(EqualTimes(Frames), linear, VTK_DOUBLE);
  whole->Update();
  CheckMesh(whole);
  const auto some = FromSeries({ 0, 1, 2, 4, 5 }, linear, VTK_DOUBLE);
  some->Update();
  CheckMesh(some);
  const double ratio = ReadPentatopes(some->GetOutput()).VolumeOf() /
    ReadPentatopes(whole->GetOutput()).VolumeOf();
  CHECK(std::abs(ratio - 1.0) < 1e-3, ratio);
}

void TestSideAndLabel()
{
  const auto filter = FromSeries(
    EqualTimes(Frames), [](const Vector& x, double t) { return -Depth(x, t); }, VTK_DOUBLE);
  filter->SetInsideToBelow();
  filter->SetInsideLabel(12);
  filter->Update();
  CheckMesh(filter);
  const Pentatopes mesh = ReadPentatopes(filter->GetOutput());
  CHECK(std::all_of(mesh.Labels.begin(), mesh.Labels.end(), [](long long l) { return l == 12; }));
  CHECK(std::abs(mesh.VolumeOf(12) / Hypervolume() - 1.0) < 0.04);
}

} // namespace

int TestPentatopeMeshIsosurface(int, char*[])
{
  TestBall();
  TestTypes();
  TestMixedTypes();
  TestUnequalTimes();
  TestSideAndLabel();
  return Result();
}
