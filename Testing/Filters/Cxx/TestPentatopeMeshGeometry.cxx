// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Where a space-time mesh lies: axes, origin, times; its hypervolume; its ends in time; where it asks for sizes.
#include "PentatopeTesting.h"

#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkTrivialProducer.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <atomic>
#include <cmath>

using namespace testing;

namespace
{

const Event Centre = { 5.5, 5.5, 5.5, 5.5 };

/** Labels by voxel index, so that images that lie differently have the same voxels. */
vtkSmartPointer<TemporalSource> MakeIndexed(
  const Placement& placement, const std::vector<double>& times, double radius = 4.2)
{
  auto source = vtkSmartPointer<TemporalSource>::New();
  source->Times = times;
  source->MakeFrame = [=](int frame)
  {
    const auto image = MakeImage(
      SmallPlacement(), [=](const Vector& x) { return TwoLabelBall(Centre, radius)(x, frame); });
    image->SetOrigin(placement.Origin.data());
    image->SetSpacing(placement.Spacing.data());
    image->SetDirectionMatrix(placement.Direction.data());
    return image;
  };
  return source;
}

/** x = origin + direction * y, t = t0 + y_t / scale. */
Event Transformed(const Placement& placement, double t0, double timeScale, const Event& y)
{
  Event x;
  for (std::size_t r = 0; r < 3; ++r)
  {
    x[r] = placement.Origin[r];
    for (std::size_t c = 0; c < 3; ++c)
    {
      x[r] += placement.Direction[3 * r + c] * y[c];
    }
  }
  x[3] = t0 + y[3] / timeScale;
  return x;
}

/** The mesh of a moved image is the moved mesh; with left-handed axes orders change, not signs. */
void TestAxes()
{
  const auto reference = MakePentatopeFilter(MakeIndexed({}, EqualTimes(12)));
  reference->Update();
  CheckMesh(reference);
  const Pentatopes expected = ReadPentatopes(reference->GetOutput());

  const double a = std::cos(0.3);
  const double b = std::sin(0.3);
  const std::array<double, 9> directions[] = { { 1, 0, 0, 0, 1, 0, 0, 0, 1 },
    { a, -b, 0, b, a, 0, 0, 0, 1 }, { -1, 0, 0, 0, 1, 0, 0, 0, 1 }, { 0, 1, 0, 1, 0, 0, 0, 0, 1 },
    { a, b, 0, b, -a, 0, 0, 0, 1 } };
  for (const auto& direction : directions)
  {
    Placement placement;
    placement.Origin = { -20, 30, 7.5 };
    placement.Direction = direction;
    const double timeScale = 4.0;
    std::vector<double> times;
    for (int k = 0; k < 12; ++k)
    {
      times.push_back(-3.0 + 0.25 * k);
    }
    const auto filter = MakePentatopeFilter(MakeIndexed(placement, times));
    filter->SetTimeScale(timeScale);
    filter->Update();
    CheckMesh(filter);
    const Pentatopes mesh = ReadPentatopes(filter->GetOutput());
    if (!CHECK(mesh.Points.size() == expected.Points.size()) ||
      !CHECK(mesh.Cells.size() == expected.Cells.size()))
    {
      continue;
    }
    CHECK(mesh.Labels == expected.Labels);
    double farthest = 0.0;
    for (std::size_t p = 0; p < mesh.Points.size(); ++p)
    {
      const Event should = Transformed(placement, times[0], timeScale, expected.Points[p]);
      for (std::size_t k = 0; k < 4; ++k)
      {
        farthest = std::max(farthest, std::abs(mesh.Points[p][k] - should[k]));
      }
    }
    CHECK(farthest < 1e-11, farthest);
    for (std::size_t c = 0; c < mesh.Cells.size(); ++c)
    {
      auto mine = mesh.Cells[c];
      auto its = expected.Cells[c];
      std::sort(mine.begin(), mine.end());
      std::sort(its.begin(), its.end());
      CHECK(mine == its, c);
    }
  }
}

/** A TimeScale of s on times in one unit is the mesh of times s times as far apart. */
void TestTimeScale()
{
  const auto scaled = MakePentatopeFilter(MakeIndexed({}, EqualTimes(12, 0.5)));
  scaled->SetTimeScale(2.0);
  scaled->Update();
  const auto plain = MakePentatopeFilter(MakeIndexed({}, EqualTimes(12, 1.0)));
  plain->Update();
  const Pentatopes a = ReadPentatopes(scaled->GetOutput());
  const Pentatopes b = ReadPentatopes(plain->GetOutput());
  CHECK(a.Cells == b.Cells && !a.Cells.empty());
  for (std::size_t p = 0; p < a.Points.size() && p < b.Points.size(); ++p)
  {
    CHECK(a.Points[p][3] == 0.5 * b.Points[p][3] && a.Points[p][0] == b.Points[p][0], p);
  }
  // It weighs time against space: with a smaller one there are fewer elements.
  scaled->SetTimeScale(0.7);
  for (const auto& filter : { scaled, plain })
  {
    filter->SetDelta(1.6);
    filter->Update();
  }
  CheckMesh(scaled);
  CHECK(scaled->GetOutput()->GetNumberOfCells() < plain->GetOutput()->GetNumberOfCells());
}

/** Skewed axes and unequal spacing: the hypervolume is that of the voxels. */
void TestSkewedAxes()
{
  Placement placement;
  placement.Spacing = { 0.8, 1.0, 1.5 };
  placement.Direction = { 1, 0.3, 0, 0, std::sqrt(1 - 0.09), 0, 0, 0, -1 };
  const auto filter = MakePentatopeFilter(MakeIndexed(placement, EqualTimes(12, 0.9), 4.8));
  filter->SetDelta(0.9);
  filter->Update();
  CheckMesh(filter);
  const double pi = vtkMath::Pi();
  const double voxel = 0.8 * 1.0 * 1.5 * std::sqrt(1 - 0.09) * 0.9;
  const double truth = 0.5 * pi * pi * std::pow(4.8, 4) * voxel;
  const double found = ReadPentatopes(filter->GetOutput()).VolumeOf();
  CHECK(std::abs(found / truth - 1.0) < 0.1, found, truth);
}

/** pi^2 r^4 / 2; the halves of the two labels are equal. */
void TestBall()
{
  Placement placement;
  placement.Extent = { 0, 19, 0, 19, 0, 19 };
  const Event centre = { 9.5, 9.5, 9.5, 9.5 };
  const double radius = 8.0;
  const auto filter =
    MakePentatopeFilter(MakeSeries(placement, EqualTimes(20), TwoLabelBall(centre, radius)));
  filter->SetSmoothingSigma(0.5);
  filter->SetDelta(1.4);
  filter->Update();
  CheckMesh(filter);
  const Pentatopes mesh = ReadPentatopes(filter->GetOutput());
  const double truth = 0.5 * vtkMath::Pi() * vtkMath::Pi() * std::pow(radius, 4);
  const double found = mesh.VolumeOf();
  CHECK(std::abs(found / truth - 1.0) < 0.06, found, truth);
  CHECK(std::abs(mesh.VolumeOf(3) / mesh.VolumeOf(7) - 1.0) < 0.03, mesh.VolumeOf(3),
    mesh.VolumeOf(7));
  // It ends where the ball does, within a voxel.
  double first = VTK_DOUBLE_MAX;
  double last = -VTK_DOUBLE_MAX;
  for (const Event& p : mesh.Points)
  {
    first = std::min(first, p[3]);
    last = std::max(last, p[3]);
  }
  CHECK(std::abs(first - 1.5) < 1.0 && std::abs(last - 17.5) < 1.0, first, last);
}

/**
 * A resting ball is there in all frames: the mesh spans exactly the first to the last, its ends are
 * flat, and its hypervolume is volume times time.
 */
void TestFlatEnds()
{
  const auto label = [](const Vector& x, double)
  { return std::hypot(x[0] - 5.5, x[1] - 5.5, x[2] - 5.5) < 4.2 ? 4.0 : 0.0; };
  std::vector<double> times; // no rounding: 0.1 + 7 * 0.3 is not the last one to the bit
  for (int k = 0; k < 8; ++k)
  {
    times.push_back(0.1 + 0.3 * k);
  }
  for (const double timeScale : { 3.0, 1.0 / 0.3, 7.7 })
  {
    const auto filter = MakePentatopeFilter(MakeSeries(SmallPlacement(), times, label));
    filter->SetTimeScale(timeScale);
    filter->SetSmoothingSigma(0.5);
    filter->SetDelta(0.8);
    filter->Update();
    CheckMesh(filter);
    double range[2];
    filter->GetOutput()->GetPointData()->GetArray("Time")->GetRange(range);
    CHECK(range[0] == times.front() && range[1] == times.back(), range[0], range[1], timeScale);

    const Pentatopes mesh = ReadPentatopes(filter->GetOutput());
    const double area = 4.0 / 3.0 * vtkMath::Pi() * std::pow(4.2, 3);
    const double truth = area * (times.back() - times.front());
    CHECK(std::abs(mesh.VolumeOf() / truth - 1.0) < 0.08, mesh.VolumeOf(), truth);

    // The flat ends: boundary tetrahedra at the two times fill the ball.
    vtkUnstructuredGrid* boundary = filter->GetBoundary();
    vtkDataArray* time = boundary->GetPointData()->GetArray("Time");
    for (const double end : range)
    {
      double volume = 0.0;
      for (vtkIdType c = 0; c < boundary->GetNumberOfCells(); ++c)
      {
        vtkIdType count = 0;
        const vtkIdType* ids = nullptr;
        boundary->GetCellPoints(c, count, ids);
        std::array<Vector, 4> corners;
        bool flat = true;
        for (std::size_t i = 0; i < 4; ++i)
        {
          flat = flat && time->GetComponent(ids[i], 0) == end;
          boundary->GetPoint(ids[i], corners[i].data());
        }
        volume += flat ? std::abs(Volume<3>({ corners[0], corners[1], corners[2], corners[3] })) : 0.0;
      }
      CHECK(std::abs(volume / area - 1.0) < 0.08, end, volume, area);
    }
  }
}

/** The function gets physical coordinates, the time in the input's unit, and the label there. */
void TestSizeFunctionArguments()
{
  Placement placement = SmallPlacement();
  placement.Origin = { 100, 200, 300 };
  placement.Direction = { 0, -1, 0, 1, 0, 0, 0, 0, 1 };
  // Voxel (i, j, k) lies at (100 - j, 200 + i, 300 + k), frame l at 40 + 0.5 l.
  const Event centre = { 94.5, 205.5, 305.5, 42.75 };
  std::vector<double> times;
  for (int k = 0; k < 12; ++k)
  {
    times.push_back(40.0 + 0.5 * k);
  }
  const auto label = [&](const Vector& x, double t)
  {
    const Vector scaled = { 5.5 + x[0] - centre[0], 5.5 + x[1] - centre[1],
      5.5 + x[2] - centre[2] };
    return TwoLabelBall(Centre, 4.2)(scaled, 5.5 + 2.0 * (t - centre[3]));
  };
  const auto filter = MakePentatopeFilter(MakeSeries(placement, times, label));
  filter->SetTimeScale(2.0);
  filter->SetDelta(1.6);
  std::atomic<int> calls{ 0 };
  std::atomic<int> wrong{ 0 };
  filter->SetSizeFunction(
    [&](const double* x, vtkTypeInt64 value)
    {
      ++calls;
      const double space = std::hypot(x[0] - centre[0], x[1] - centre[1], x[2] - centre[2]);
      const double distance = std::hypot(space, 2.0 * (x[3] - centre[3]));
      const bool nearMiddle = std::abs(x[0] - centre[0]) < 1.0;
      const bool good = distance < 5.5 && (nearMiddle || value == (x[0] < centre[0] ? 3 : 7));
      wrong += good ? 0 : 1;
      return 2.0;
    });
  filter->Update();
  CheckMesh(filter);
  CHECK(calls > 100, calls);
  CHECK(wrong == 0, wrong, calls);
}

void TestConstantSizeFunction()
{
  const auto filter = MakePentatopeFilter();
  filter->SetDelta(3.0);
  filter->SetSizeFunction([](const double*, vtkTypeInt64) { return 1.8; });
  const auto number = MakePentatopeFilter();
  number->SetDelta(3.0);
  number->SetElementSize(1.8);
  filter->Update();
  number->Update();
  CHECK(SameMesh(filter, number));
  filter->SetSizeFunction(nullptr);
  number->SetElementSize(0.0);
  filter->Update();
  number->Update();
  CHECK(SameMesh(filter, number));
}

} // namespace

int TestPentatopeMeshGeometry(int, char*[])
{
  TestAxes();
  TestTimeScale();
  TestSkewedAxes();
  TestBall();
  TestFlatEnds();
  TestSizeFunctionArguments();
  TestConstantSizeFunction();
  return Result();
}
