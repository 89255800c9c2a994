// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Time planes and periods of the space-time filter: arrays, left-handed axes, errors.
#include "PentatopeTesting.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkFieldData.h"
#include "vtkMath.h"
#include "vtkUnstructuredGrid.h"

#include <cmath>
#include <set>

using namespace testing;

namespace
{

/** A ball of label 3, radius 4 at the first and the last time, that grows meanwhile. */
MovingLabel GrowingBall(double first, double duration)
{
  return [=](const Vector& x, double t)
  {
    const double radius = 4.0 + std::sin(vtkMath::Pi() * (t - first) / duration);
    const double distance = std::hypot(x[0] - 5.5, x[1] - 5.5, x[2] - 5.5);
    return distance < std::round(1e6 * radius) / 1e6 ? 3.0 : 0.0; // sin(pi) is not 0
  };
}

void TestSlabs()
{
  std::vector<double> times = EqualTimes(9, 0.5);
  for (double& time : times)
  {
    time += 100.0;
  }
  const auto source = MakeSeries(SmallPlacement(), times, GrowingBall(100.0, 4.0));
  const auto filter = MakePentatopeFilter(source);
  filter->SetTimeScale(3.0);
  filter->SetDelta(1.5);
  filter->AddTimePlane(102.5);
  filter->AddTimePlane(101.2);
  filter->PeriodicOn();
  filter->Update();
  CheckMesh(filter);
  vtkUnstructuredGrid* const grid = filter->GetOutput();
  vtkDataArray* const planes = grid->GetFieldData()->GetArray("TimePlanes");
  CHECK(planes && planes->GetNumberOfTuples() == 2, "two planes");
  CHECK(std::abs(planes->GetComponent(0, 0) - 101.2) < 1e-12 &&
      std::abs(planes->GetComponent(1, 0) - 102.5) < 1e-12,
    "times of planes");
  const Pentatopes mesh = ReadPentatopes(grid);
  vtkDataArray* const slabs = grid->GetCellData()->GetArray("Slab");
  std::set<int> found;
  for (std::size_t cell = 0; cell < mesh.Cells.size(); ++cell)
  {
    const int slab = static_cast<int>(slabs->GetComponent(static_cast<vtkIdType>(cell), 0));
    found.insert(slab);
    const double first = slab == 0 ? 100.0 : planes->GetComponent(slab - 1, 0);
    const double last = slab == 2 ? 104.0 : planes->GetComponent(slab, 0);
    for (const Event& corner : mesh.Corners(cell))
    {
      CHECK(corner[3] >= first && corner[3] <= last, "a pentatope leaves its slab");
    }
  }
  CHECK(found.size() == 3, "three slabs");
  vtkDataArray* const pairs = grid->GetFieldData()->GetArray("PeriodicPairs");
  CHECK(pairs && pairs->GetNumberOfTuples() > 20, "pairs");
  for (vtkIdType k = 0; k < pairs->GetNumberOfTuples(); ++k)
  {
    const Event& a = mesh.Points[static_cast<std::size_t>(pairs->GetComponent(k, 0))];
    const Event& b = mesh.Points[static_cast<std::size_t>(pairs->GetComponent(k, 1))];
    CHECK(a[0] == b[0] && a[1] == b[1] && a[2] == b[2] && a[3] == 100.0 && b[3] == 104.0,
      "a pair is one point in space, at both ends");
  }

  // Without planes again.
  filter->RemoveAllTimePlanes();
  filter->PeriodicOff();
  filter->Update();
  CheckMesh(filter);
  CHECK(!filter->GetOutput()->GetCellData()->GetArray("Slab") &&
      !filter->GetOutput()->GetFieldData()->GetArray("TimePlanes") &&
      !filter->GetOutput()->GetFieldData()->GetArray("PeriodicPairs"),
    "arrays without planes");

  filter->TimePlanesAtFramesOn();
  filter->SetTimeScale(4.0);
  filter->Update();
  CHECK(filter->GetOutput()->GetFieldData()->GetArray("TimePlanes")->GetNumberOfTuples() == 7,
    "a plane at each frame inside");
}

void TestMistakes()
{
  const auto source = MakeSeries(SmallPlacement(), EqualTimes(12), GrowingBall(0.0, 11.0));
  const auto filter = MakePentatopeFilter(source);
  filter->AddTimePlane(11.5);
  CHECK(filter->GetNumberOfTimePlanes() == 1 && filter->GetTimePlane(0) == 11.5 &&
      filter->GetTimePlane(1) == 0.0,
    "planes can be asked for");
  ExpectError("a plane outside", filter, { "time plane at 11.5", "from 0 to 11" },
    [&] { filter->RemoveAllTimePlanes(); });
  filter->AddTimePlane(5.0);
  filter->AddTimePlane(5.1);
  ExpectError("a thin slab", filter, { "too near", "thinner than delta" },
    [&] { filter->RemoveAllTimePlanes(); });
  const auto other = MakeSeries(SmallPlacement(), EqualTimes(12), GrowingBall(0.0, 22.0));
  const auto another = MakePentatopeFilter(other);
  another->PeriodicOn();
  ExpectError(
    "ends that differ", another, { "equal to the first one" }, [&] { another->PeriodicOff(); });
}

} // namespace

int TestPentatopeMeshPlanes(int, char*[])
{
  TestSlabs();
  TestMistakes();
  return Result();
}
