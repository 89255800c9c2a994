// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Several labels: a conforming mesh, every pair of neighbours has its interface, subsets.
#include "FilterTesting.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkMeshingStatistics.h"
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

std::set<long long> LabelsOf(vtkImageToTetMeshFilter* filter)
{
  const Tetrahedra mesh = Read(filter->GetOutput());
  return { mesh.Labels.begin(), mesh.Labels.end() };
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

void TestSubset()
{
  const auto filter = MakeFilter(MakeTwoLabels());
  CHECK(filter->GetNumberOfSelectedLabels() == 0);
  filter->AddLabel(2);
  CHECK(filter->GetNumberOfSelectedLabels() == 1 && filter->GetSelectedLabel(0) == 2);
  filter->Update();
  CheckMesh(filter);
  CHECK(LabelsOf(filter) == std::set<long long>({ 2 }));
  CHECK(InterfacePairs(filter) == Pairs({ { 2, 0 } }));

  filter->AddLabel(1);
  filter->Update();
  CHECK(LabelsOf(filter) == std::set<long long>({ 1, 2 }));
  filter->RemoveLabel(2);
  filter->Update();
  CHECK(LabelsOf(filter) == std::set<long long>({ 1 }));
  filter->RemoveAllLabels();
  filter->Update();
  CHECK(LabelsOf(filter) == std::set<long long>({ 1, 2 }));
}

void TestExcluded()
{
  const auto filter = MakeFilter(MakeTwoLabels());
  filter->ExcludeLabel(2);
  filter->ExcludeLabel(2);
  CHECK(filter->GetNumberOfExcludedLabels() == 1 && filter->GetExcludedLabel(0) == 2);
  CHECK(filter->GetExcludedLabel(1) == 0 && filter->GetExcludedLabel(-1) == 0);
  filter->Update();
  CheckMesh(filter);
  CHECK(LabelsOf(filter) == std::set<long long>({ 1 }));
  CHECK(InterfacePairs(filter) == Pairs({ { 1, 0 } }));

  filter->RemoveExcludedLabel(2);
  filter->ExcludeLabel(1);
  filter->Update();
  CHECK(LabelsOf(filter) == std::set<long long>({ 2 }));
  filter->RemoveAllExcludedLabels();
  filter->Update();
  CHECK(LabelsOf(filter) == std::set<long long>({ 1, 2 }));
}

/** Rows of a table are sizes and exclusions in other words. */
void TestRows()
{
  const auto filter = MakeFilter(MakeTwoLabels());
  filter->SetLabelRow(1, 1.5, true);
  filter->SetLabelRow(2, 2.5, false); // the size of what is not meshed does not count
  CHECK(filter->GetLabelSize(1) == 1.5 && filter->GetNumberOfLabelSizes() == 1);
  CHECK(filter->GetNumberOfExcludedLabels() == 1 && filter->GetExcludedLabel(0) == 2);
  filter->Update();
  CheckMesh(filter);
  CHECK(LabelsOf(filter) == std::set<long long>({ 1 }));
  const vtkIdType fine = filter->GetOutput()->GetNumberOfCells();

  filter->SetLabelRow(1, 0.0, true);
  CHECK(filter->GetNumberOfLabelSizes() == 0);
  filter->Update();
  CHECK(filter->GetOutput()->GetNumberOfCells() < fine);
  filter->SetLabelRow(2, 0.0, true);
  filter->Update();
  CHECK(LabelsOf(filter) == std::set<long long>({ 1, 2 }));

  filter->SetLabelRow(1, 1.0, true);
  filter->SetLabelRow(2, 1.0, false);
  filter->ClearLabelRows();
  CHECK(filter->GetNumberOfLabelSizes() == 0 && filter->GetNumberOfExcludedLabels() == 0);
}

/** Labels that the mesh lacks are named: in the statistics, and in one warning. */
void TestLostLabels()
{
  const auto filter = MakeFilter(MakeImage({},
    [](const Vector& x)
    {
      const bool speck = x == Vector{ 2, 2, 2 };
      return speck ? 9.0 : std::hypot(x[0] - 18, x[1] - 18, x[2] - 18) < 10.0 ? 4.0 : 0.0;
    }));
  filter->SetDelta(6.0);
  const auto errors = vtkSmartPointer<ErrorCollector>::Take(ErrorCollector::New());
  errors->Watch(filter);
  filter->Update();
  const std::set<long long> present = LabelsOf(filter);
  const auto* statistics = filter->GetStatistics();
  CHECK(present.count(4) == 1);
  if (present.count(9) == 1) // the mesher is free to keep it
  {
    CHECK(statistics->GetNumberOfLostLabels() == 0);
    CHECK(errors->FromFilter.empty());
  }
  else
  {
    CHECK(statistics->GetNumberOfLostLabels() == 1 && statistics->GetLostLabel(0) == 9);
    CHECK(statistics->ToJSON().find("\"lost_labels\":[9]") != std::string::npos);
    CHECK(errors->FromFilter.size() == 1 &&
      errors->FromFilter.front().find("lacks") != std::string::npos);
  }
  CHECK(statistics->GetLostLabel(5) == 0);
}

/** A sheet that is thin for Delta loses volume, and is in pieces: the statistics and two warnings say so. */
void TestShrunkLabels()
{
  const auto filter = MakeFilter(MakeImage({},
    [](const Vector& x)
    {
      const bool ball = std::hypot(x[0] - 18, x[1] - 18, x[2] - 22) < 8.0;
      const bool sheet = x[2] >= 8 && x[2] < 10 && std::hypot(x[0] - 16, x[1] - 16) < 14.0;
      return ball ? 4.0 : sheet ? 9.0 : 0.0;
    }));
  filter->SetDelta(4.0);
  const auto errors = vtkSmartPointer<ErrorCollector>::Take(ErrorCollector::New());
  errors->Watch(filter);
  filter->Update();
  const auto* statistics = filter->GetStatistics();
  CHECK(statistics->GetNumberOfShrunkLabels() == 1 && statistics->GetShrunkLabel(0) == 9);
  const double fraction = statistics->GetShrunkLabelFraction(0);
  CHECK(fraction > 0.0 && fraction < 0.5);
  CHECK(statistics->ToJSON().find("\"shrunk_labels\":[{\"label\":9,\"fraction\":0.") !=
    std::string::npos);
  CHECK(errors->FromFilter.size() == 2 &&
    errors->FromFilter.front().find(
      "less than half of the volume of these labels, which are thin for a Delta of 4: 9 (") !=
      std::string::npos);
  CHECK(errors->FromFilter.back().find("in several pieces that no common faces connect: ") !=
    std::string::npos);
  CHECK(filter->GetNumberOfWarnings() == 2 &&
    filter->GetWarning(0).find("The mesh has less than half of the volume") == 0);
  CHECK(filter->GetWarning(2).empty() && filter->GetWarning(-1).empty());
  CHECK(statistics->GetShrunkLabel(1) == 0 && statistics->GetShrunkLabelFraction(-1) == 0.0);

  filter->ExactComponentsOn();
  filter->Update();
  CHECK(statistics->GetNumberOfShrunkLabels() == 0 && filter->GetNumberOfWarnings() == 0);
  CHECK(statistics->ToJSON().find("\"shrunk_labels\":[]") != std::string::npos);
  CHECK(statistics->ToJSON().find("\"broken_components\":[]") != std::string::npos);
  CHECK(errors->FromFilter.size() == 2);
}

} // namespace

int TestTetMeshLabels(int, char*[])
{
  TestTouching();
  TestNested();
  TestFullImage();
  TestSubset();
  TestExcluded();
  TestRows();
  TestLostLabels();
  TestShrunkLabels();
  return Result();
}
