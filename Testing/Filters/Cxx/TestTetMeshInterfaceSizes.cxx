// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Interface sizes, gradation and the number of elements through the filter: the kernel's tests say that they
// are right, these that they arrive.
#include "FilterTesting.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkMeshingStatistics.h"
#include "vtkPolyData.h"
#include "vtkUnstructuredGrid.h"

#include <cmath>
#include <sstream>
#include <string>

using namespace testing;

namespace
{

vtkSmartPointer<vtkImageToTetMeshFilter> MakeHalves(double delta)
{
  const auto filter = MakeFilter(MakeImage({},
    [](const Vector& x)
    {
      const double r = std::hypot(x[0] - 15.5, x[1] - 15.5, x[2] - 15.5);
      return r < 13.0 ? (x[0] < 15.5 ? 1.0 : 2.0) : 0.0;
    }));
  filter->SetDelta(delta);
  return filter;
}

/** How many triangles there are between two labels. */
vtkIdType CountBetween(vtkImageToTetMeshFilter* filter, double larger, double smaller)
{
  filter->Update();
  vtkDataArray* labels = filter->GetInterfaces()->GetCellData()->GetArray("Labels");
  vtkIdType count = 0;
  for (vtkIdType i = 0; labels && i < labels->GetNumberOfTuples(); ++i)
  {
    count += labels->GetComponent(i, 0) == larger && labels->GetComponent(i, 1) == smaller;
  }
  return count;
}

void TestTable()
{
  const auto filter = MakeHalves(3.0);
  constexpr int any = vtkImageToTetMeshFilter::ANY_LABEL;
  vtkTypeInt64 labels[2];
  CHECK(filter->GetNumberOfInterfaceSizes() == 0 && filter->GetInterfaceSize(1, 2) == 0.0);
  filter->SetInterfaceSize(1, 2, 0.5);
  filter->SetInterfaceSize(any, 2, 0.7);
  filter->SetInterfaceSize(0, any, 0.9);
  CHECK(filter->GetInterfaceSize(2, 1) == 0.5 && filter->GetInterfaceSize(2, any) == 0.7);
  CHECK(filter->GetNumberOfInterfaceSizes() == 3);
  filter->GetSizedInterface(0, labels);
  CHECK(labels[0] == 0 && labels[1] == any, labels[0], labels[1]);
  filter->GetSizedInterface(2, labels);
  CHECK(labels[0] == 2 && labels[1] == 1, labels[0], labels[1]);
  for (const int index : { -1, 3 })
  {
    filter->GetSizedInterface(index, labels);
    CHECK(labels[0] == any && labels[1] == any, labels[0], labels[1]);
  }
  std::ostringstream text;
  filter->Print(text);
  CHECK(
    text.str().find("InterfaceSizes: 0,-1=0.9 2,-1=0.7 2,1=0.5") != std::string::npos, text.str());

  vtkMTimeType time = filter->GetMTime();
  filter->SetInterfaceSize(2, 1, 0.5);
  filter->RemoveInterfaceSize(7, 1);
  CHECK(filter->GetMTime() == time);
  filter->SetInterfaceSize(2, 1, 0.6);
  CHECK(filter->GetMTime() > time);
  time = filter->GetMTime();
  filter->RemoveInterfaceSize(1, 2);
  CHECK(filter->GetMTime() > time && filter->GetNumberOfInterfaceSizes() == 2);
  time = filter->GetMTime();
  filter->ClearInterfaceSizes();
  CHECK(filter->GetMTime() > time && filter->GetNumberOfInterfaceSizes() == 0);
}

void TestMeshes()
{
  const auto filter = MakeHalves(2.0);
  filter->SampleJunctionsOff(); // a fine rim makes the facets beside it smaller
  filter->SetGradation(0.0);
  const vtkIdType between = CountBetween(filter, 2, 1);
  const vtkIdType outside = CountBetween(filter, 2, 0);
  filter->SetInterfaceSize(1, 2, 1.0);
  CHECK(CountBetween(filter, 2, 1) > 3 * between, CountBetween(filter, 2, 1), between);
  CHECK(CountBetween(filter, 2, 0) < 2 * outside, CountBetween(filter, 2, 0), outside);
  CheckMesh(filter);
  const vtkIdType stepping = filter->GetOutput()->GetNumberOfCells();
  filter->SetGradation(0.1); // the outside becomes finer towards the rim
  filter->Update();
  CHECK(filter->GetOutput()->GetNumberOfCells() > stepping * 11 / 10,
    filter->GetOutput()->GetNumberOfCells(), stepping);

  filter->SetGradation(0.0);
  filter->ClearInterfaceSizes();
  filter->SetInterfaceSize(
    vtkImageToTetMeshFilter::ANY_LABEL, 0, 3.5); // all of the outside, coarser
  CHECK(CountBetween(filter, 2, 0) < outside / 2, CountBetween(filter, 2, 0), outside);
  CheckMesh(filter);
}

void TestNumberOfElements()
{
  const auto filter = MakeHalves(0.0);
  filter->SetNumberOfElements(20000);
  double last = 0.0;
  bool falls = false;
  const auto observer = Observe(filter,
    [&](vtkAlgorithm*, double fraction)
    {
      falls = falls || fraction < last;
      last = fraction;
    });
  for (const int threads : { 1, 3 })
  {
    last = 0.0;
    filter->SetNumberOfThreads(threads);
    filter->Modified();
    filter->Update();
    CheckMesh(filter);
    const double elements = static_cast<double>(filter->GetOutput()->GetNumberOfCells());
    CHECK(std::abs(elements / 20000.0 - 1.0) <= 0.1, elements);
    CHECK(!falls && last == 1.0, last);
    vtkMeshingStatistics* statistics = filter->GetStatistics();
    CHECK(statistics->GetFigure("/elements_asked_for") == 20000 && statistics->GetDelta() > 0.0);
    const int runs = statistics->GetNumberOfRuns();
    CHECK(runs >= 1 && runs <= 12, runs);
    bool taken = false;
    for (int i = 0; i < runs; ++i)
    {
      const std::string run = "/runs/" + std::to_string(i);
      taken = taken ||
        (statistics->GetFigure((run + "/delta").c_str()) == statistics->GetDelta() &&
          statistics->GetFigure((run + "/elements").c_str()) ==
            static_cast<double>(statistics->GetNumberOfElements()));
    }
    CHECK(taken);
    CHECK(
      statistics->ToJSON().find("\"elements_asked_for\":20000,\"runs\":[{") != std::string::npos,
      statistics->ToJSON());
  }
  // Beside it a Delta that is but a suggestion changes nothing; without it, it counts.
  const vtkIdType found = filter->GetOutput()->GetNumberOfCells();
  filter->SetNumberOfThreads(1);
  filter->Modified();
  filter->Update();
  const vtkIdType withoutDelta = filter->GetOutput()->GetNumberOfCells();
  CHECK(!filter->GetDeltaIsSuggestion());
  filter->DeltaIsSuggestionOn();
  filter->SetDelta(4.0);
  filter->Update();
  CHECK(filter->GetOutput()->GetNumberOfCells() == withoutDelta, withoutDelta, found);
  filter->SetNumberOfElements(0);
  filter->Update();
  CHECK(filter->GetStatistics()->GetDelta() == 4.0, filter->GetStatistics()->GetDelta());
  CHECK(filter->GetStatistics()->GetNumberOfRuns() == 0);
  CHECK(filter->GetStatistics()->ToJSON().find("\"elements_asked_for\":null,\"runs\":[]") !=
    std::string::npos);
}

} // namespace

int TestTetMeshInterfaceSizes(int, char*[])
{
  TestTable();
  TestMeshes();
  TestNumberOfElements();
  return Result();
}
