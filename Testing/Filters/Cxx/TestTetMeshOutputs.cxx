// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// What leaves the filter: arrays, types, volumes, statistics, field data.
#include "FilterTesting.h"

#include "vtkCellData.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkIntArray.h"
#include "vtkLongLongArray.h"
#include "vtkMath.h"
#include "vtkMeshingStatistics.h"
#include "vtkNew.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"
#include "vtkUnstructuredGrid.h"

#include <cmath>
#include <string>

using namespace testing;

namespace
{

void TestBall()
{
  const double radius = 12.0;
  const auto filter = MakeFilter(MakeBall(radius, 7));
  filter->SetDelta(1.0); // an inscribed polyhedron loses volume with the square of delta
  filter->Update();
  CheckMesh(filter);
  CHECK(vtkIntArray::SafeDownCast(filter->GetOutput()->GetCellData()->GetArray("Label")));
  const Tetrahedra mesh = Read(filter->GetOutput());
  const double truth = 4.0 / 3.0 * vtkMath::Pi() * std::pow(radius, 3);
  const double volume = mesh.VolumeOf(7);
  CHECK(std::abs(volume / truth - 1.0) < 0.03, volume, truth);
  CHECK(mesh.VolumeOf() == volume, "one label only");
  const Vector centroid = mesh.Centroid();
  for (const double c : centroid)
  {
    CHECK(std::abs(c - 15.5) < 0.1, c);
  }
}

/** Points and cells enough for several chunks of the loops that write them. */
void TestThreads()
{
  const auto filter = MakeFilter(MakeTwoLabels(14.0));
  filter->SetDelta(0.5);
  filter->SetNumberOfThreads(3);
  filter->Update();
  CheckMesh(filter);
  CHECK(filter->GetOutput()->GetNumberOfPoints() > 10000, filter->GetOutput()->GetNumberOfPoints());
}

void TestLargeLabels()
{
  const double large = 5e9; // does not fit into an int
  const auto filter = MakeFilter(MakeBall(6.0, large));
  filter->Update();
  CheckMesh(filter);
  CHECK(vtkLongLongArray::SafeDownCast(filter->GetOutput()->GetCellData()->GetArray("Label")));
  CHECK(Read(filter->GetOutput()).Labels.front() == 5000000000LL);
}

void TestStatistics()
{
  const auto filter = MakeFilter(MakeTwoLabels());
  vtkMeshingStatistics* statistics = filter->GetStatistics();
  filter->Update();
  CHECK(statistics == filter->GetStatistics(), "the same object over the filter's life");
  CHECK(statistics->GetNumberOfElements() == filter->GetOutput()->GetNumberOfCells());
  CHECK(statistics->GetNumberOfVertices() == filter->GetOutput()->GetNumberOfPoints());
  CHECK(statistics->GetNumberOfInterfaceFacets() == filter->GetInterfaces()->GetNumberOfCells());
  CHECK(statistics->GetNumberOfThreads() == 1);
  CHECK(statistics->GetDelta() > 0.0);
  CHECK(statistics->GetFigure("/largest_delta") == statistics->GetDelta());
  CHECK(
    statistics->GetFigure("/grading/samples") == 0 && statistics->GetFigure("/grading/poles") == 0);
  CHECK(statistics->GetFigure("/rules/R1") > 0);
  CHECK(std::isnan(statistics->GetFigure("/rules/R8")));
  CHECK(statistics->GetFigure("/predicates/calls") > statistics->GetFigure("/predicates/exact"));
  CHECK(statistics->GetRefinementTime() > 0.0);
  CHECK(std::abs(statistics->GetTotalTime() -
          (statistics->GetLabelFieldTime() + statistics->GetDistanceTransformTime() +
            statistics->GetGradingTime() + statistics->GetComponentsTime() +
            statistics->GetInterfacesTime() + statistics->GetRefinementTime() +
            statistics->GetExtractionTime() + statistics->GetOptimisationTime())) < 1e-9);
  CHECK(!statistics->GetHasQuality() && statistics->GetNumberOfLabels() == 0);
  CHECK(statistics->ToJSON().find("\"quality\"") == std::string::npos);

  filter->ComputeQualityOn();
  filter->Update();
  CHECK(statistics->GetHasQuality());
  CHECK(statistics->GetMaximumRadiusEdgeRatio() <= 2.5, statistics->GetMaximumRadiusEdgeRatio());
  CHECK(statistics->GetMaximumRadiusEdgeRatio() > 0.6);
  CHECK(statistics->GetRadiusEdgeViolations() == 0);
  CHECK(statistics->GetInvertedElements() == 0);
  CHECK(statistics->GetFigure("/quality/min_normalized_volume") > 0.0);
  CHECK(statistics->GetFigure("/quality/mean_normalized_volume") < 1.0);
  CHECK(statistics->GetMinimumDihedralAngle() > 0.0);
  CHECK(statistics->GetMaximumDihedralAngle() < 180.0);
  CHECK(statistics->GetMinimumDihedralAngle() < statistics->GetMaximumDihedralAngle());
  CHECK(statistics->GetMinimumPlanarAngle() > 0.0 && statistics->GetMinimumPlanarAngle() <= 60.0);
  CHECK(static_cast<double>(statistics->GetFacetAngleViolations()) >=
    statistics->GetFigure("/quality/facet_angle_violations_at_junctions"));
  if (CHECK(statistics->GetNumberOfLabels() == 2))
  {
    const Tetrahedra mesh = Read(filter->GetOutput());
    vtkTypeInt64 elements = 0;
    for (int i = 0; i < 2; ++i)
    {
      const auto label = statistics->GetLabel(i);
      CHECK(label == i + 1);
      elements += statistics->GetLabelElements(i);
      const double volume = mesh.VolumeOf(label);
      CHECK(std::abs(statistics->GetLabelVolume(i) / volume - 1.0) < 1e-9, label);
    }
    CHECK(elements == statistics->GetNumberOfElements());
  }
  CHECK(statistics->GetLabel(2) == 0 && statistics->GetLabel(-1) == 0);
  const std::string json = statistics->ToJSON();
  for (const char* key : { "\"elements\"", "\"labels\"", "\"quality\"", "\"rules\"",
         "\"predicates\"", "\"time\"", "\"max_radius_edge\"" })
  {
    CHECK(json.find(key) != std::string::npos, key);
  }
  CHECK(json.front() == '{' && json.back() == '}');
}

void TestFieldData()
{
  const auto image = MakeBall(6.0, 7);
  vtkNew<vtkStringArray> space;
  space->SetName("SPACE");
  space->InsertNextValue("LPS");
  vtkNew<vtkIntArray> values;
  values->SetName("LabelValues");
  vtkNew<vtkStringArray> names;
  names->SetName("LabelNames");
  for (const int label : { 3, 7, 9 })
  {
    values->InsertNextValue(label);
    names->InsertNextValue("label " + std::to_string(label));
  }
  for (vtkAbstractArray* const array : { vtkAbstractArray::SafeDownCast(space),
         vtkAbstractArray::SafeDownCast(values), vtkAbstractArray::SafeDownCast(names) })
  {
    image->GetFieldData()->AddArray(array);
  }
  const auto filter = MakeFilter(image);
  filter->Update();
  CHECK(filter->GetOutput()->GetFieldData()->GetAbstractArray("SPACE") == space);
  CHECK(filter->GetInterfaces()->GetFieldData()->GetAbstractArray("SPACE") == space);
  for (vtkDataObject* const part :
    { filter->GetOutputDataObject(0), filter->GetOutputDataObject(1) })
  {
    vtkFieldData* const fields = part->GetFieldData();
    auto* const ofMesh = vtkStringArray::SafeDownCast(fields->GetAbstractArray("LabelNames"));
    CHECK(ofMesh && ofMesh->GetNumberOfValues() == 1 && ofMesh->GetValue(0) == "label 7" &&
        fields->GetArray("LabelValues")->GetTuple1(0) == 7,
      "names of labels that the mesh has");
  }
  CHECK(image->GetFieldData()->GetAbstractArray("LabelNames") == names &&
    names->GetNumberOfValues() == 3);
}

} // namespace

int TestTetMeshOutputs(int, char*[])
{
  TestBall();
  TestThreads();
  TestLargeLabels();
  TestStatistics();
  TestFieldData();
  return Result();
}
