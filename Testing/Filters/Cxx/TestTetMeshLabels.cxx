// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Several labels: a conforming mesh, every pair of neighbours has its interface.
#include "FilterTesting.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkImageData.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkUnstructuredGrid.h"

#include <cmath>
#include <map>
#include <set>
#include <string>
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

using Counts = std::map<vtkTypeInt64, vtkTypeInt64>;

/** Of points, of cells, of two components; what has no labels says why. */
void TestCounts()
{
  using Filter = vtkImageToSimplexMeshFilter;
  std::string message;
  Placement small;
  small.Extent = { 0, 3, 0, 3, 0, 3 };
  const auto halves = [](const Vector& x) { return x[0] < 0.9 ? 0.0 : x[0] < 1.9 ? 7.0 : 300.0; };
  const auto image = MakeImage(small, halves, VTK_SHORT);
  CHECK(Filter::CountLabels(image, 0, "", message) == Counts({ { 7, 16 }, { 300, 32 } }));
  CHECK(Filter::CountLabels(image, vtkDataObject::FIELD_ASSOCIATION_POINTS, "Segmentation",
          message) == Counts({ { 7, 16 }, { 300, 32 } }));
  CHECK(message.empty(), message);
  CHECK(Filter::CountLabels(image, vtkDataObject::FIELD_ASSOCIATION_CELLS, "Segmentation", message)
          .empty());
  CHECK(message.find("no such array") != std::string::npos, message);

  vtkDataArray* const labels = image->GetPointData()->GetScalars();
  labels->SetComponent(5, 0, -2.0);
  CHECK(Filter::CountLabels(image, 0, "", message).empty());
  CHECK(message.find("-2") != std::string::npos, message);

  vtkNew<vtkIntArray> frames;
  frames->SetNumberOfComponents(2);
  frames->SetNumberOfTuples(64);
  frames->FillComponent(0, 0.0);
  frames->FillComponent(1, 5.0);
  frames->SetComponent(9, 0, 6.0);
  image->GetPointData()->SetScalars(frames);
  CHECK(Filter::CountLabels(image, 0, "", message) == Counts({ { 5, 64 }, { 6, 1 } }));

  small.Cells = true;
  const auto cells = MakeImage(small, halves, VTK_DOUBLE);
  CHECK(Filter::CountLabels(cells, 0, "", message) == Counts({ { 7, 9 }, { 300, 9 } }));
  CHECK(message.empty(), message);
}

} // namespace

int TestTetMeshLabels(int, char*[])
{
  TestTouching();
  TestNested();
  TestFullImage();
  TestCounts();
  return Result();
}
