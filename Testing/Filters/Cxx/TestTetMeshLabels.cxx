// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Several labels: a conforming mesh, every pair of neighbours has its interface.
#include "FilterTesting.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkPolyData.h"
#include "vtkUnstructuredGrid.h"

#include <cmath>
#include <set>
#include <utility>

using namespace testing;

namespace
{

using Pairs = std::set<std::pair<long long, long long>>;

Pairs InterfacePairs(vtkImageToTetMeshFilter* filter)
{
  vtkDataArray* labels = filter->GetInterfaces()->GetCellData()->GetArray("Labels");
  Pairs pairs;
  for (vtkIdType c = 0; labels && c < labels->GetNumberOfTuples(); ++c)
  {
    pairs.emplace(static_cast<long long>(labels->GetComponent(c, 0)),
      static_cast<long long>(labels->GetComponent(c, 1)));
  }
  return pairs;
}

void TestTouching()
{
  const auto filter = MakeFilter(MakeTwoLabels());
  filter->Update();
  CheckMesh(filter);
  CHECK(InterfacePairs(filter) == Pairs({ { 1, 0 }, { 2, 0 }, { 2, 1 } }));
  const Tetrahedra mesh = Read(filter->GetOutput());
  CHECK(
    std::abs(mesh.VolumeOf(1) / mesh.VolumeOf(2) - 1.0) < 0.05, mesh.VolumeOf(1), mesh.VolumeOf(2));
}

void TestNested()
{
  const auto filter = MakeFilter(MakeImage({},
    [](const Vector& x)
    {
      const double r = std::hypot(x[0] - 15.5, x[1] - 15.5, x[2] - 15.5);
      return r < 5.0 ? 40.0 : r < 10.0 ? 3.0 : 0.0;
    }));
  filter->Update();
  CheckMesh(filter);
  CHECK(InterfacePairs(filter) == Pairs({ { 3, 0 }, { 40, 3 } }));
}

/** No background at all: the object reaches every border of the image. */
void TestFullImage()
{
  Placement small;
  small.Extent = { 0, 9, 0, 9, 0, 9 };
  const auto filter =
    MakeFilter(MakeImage(small, [](const Vector& x) { return x[0] < 4.5 ? 1.0 : 2.0; }));
  filter->Update();
  CheckMesh(filter);
  CHECK(InterfacePairs(filter) == Pairs({ { 1, 0 }, { 2, 0 }, { 2, 1 } }));
}

} // namespace

int TestTetMeshLabels(int, char*[])
{
  TestTouching();
  TestNested();
  TestFullImage();
  return Result();
}
