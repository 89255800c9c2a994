// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// vtkSimplexMeshQuality: figures of boxes made by hand, images in any position, misuse, abort.
#include "FilterTesting.h"

#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkDataSetAttributes.h"
#include "vtkDoubleArray.h"
#include "vtkImageData.h"
#include "vtkIntArray.h"
#include "vtkMeshingStatistics.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkSimplexMeshQuality.h"
#include "vtkTable.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>

using namespace testing;

namespace
{

/** A box from `low` to `high` (indices) of an image as six tetrahedra, where the image lies in space. */
void AddBox(vtkImageData* image, const Vector& low, const Vector& high, int label,
  vtkUnstructuredGrid* grid, bool flip)
{
  vtkIdType ids[8];
  for (int corner = 0; corner < 8; ++corner)
  {
    Vector index;
    for (int a = 0; a < 3; ++a)
    {
      index[a] = corner & (1 << a) ? high[a] : low[a];
    }
    Vector x;
    image->TransformContinuousIndexToPhysicalPoint(index.data(), x.data());
    ids[corner] = grid->GetPoints()->InsertNextPoint(x.data());
  }
  const int orders[6][2] = { { 1, 3 }, { 3, 2 }, { 2, 6 }, { 6, 4 }, { 4, 5 }, { 5, 1 } };
  for (const auto& order : orders)
  {
    vtkIdType tetrahedron[4] = { ids[0], ids[order[0]], ids[order[1]], ids[7] };
    if (flip)
    {
      std::swap(tetrahedron[2], tetrahedron[3]);
    }
    grid->InsertNextCell(VTK_TETRA, 4, tetrahedron);
    vtkIntArray::SafeDownCast(grid->GetCellData()->GetArray("Label"))->InsertNextValue(label);
  }
}

vtkSmartPointer<vtkUnstructuredGrid> NewGrid()
{
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  grid->SetPoints(points);
  vtkNew<vtkIntArray> labels;
  labels->SetName("Label");
  grid->GetCellData()->AddArray(labels);
  return grid;
}

/** Voxels 2 to 5 of each axis have label 3; so do the tetrahedra, shifted by this along the first axis. */
struct Case
{
  vtkSmartPointer<vtkImageData> Image;
  vtkSmartPointer<vtkUnstructuredGrid> Grid;
  vtkNew<vtkSimplexMeshQuality> Filter;

  explicit Case(const Placement& where, double shift = 0.0)
  {
    Placement placement = where;
    placement.Extent = { 0, 7, 0, 7, 0, 7 };
    this->Image = MakeImage(placement, [](const Vector&) { return 0.0; });
    for (int k = 2; k < 6; ++k)
    {
      for (int j = 2; j < 6; ++j)
      {
        for (int i = 2; i < 6; ++i)
        {
          this->Image->SetScalarComponentFromDouble(i, j, k, 0, 3.0);
        }
      }
    }
    const auto& d = placement.Direction;
    const double determinant = d[0] * (d[4] * d[8] - d[5] * d[7]) -
      d[1] * (d[3] * d[8] - d[5] * d[6]) + d[2] * (d[3] * d[7] - d[4] * d[6]);
    this->Grid = NewGrid();
    AddBox(this->Image, { 1.5 + shift, 1.5, 1.5 }, { 5.5 + shift, 5.5, 5.5 }, 3, this->Grid,
      determinant < 0.0);
    this->Filter->SetInputData(this->Grid);
    this->Filter->SetImageData(this->Image);
  }
};

bool Near(double a, double b, double tolerance = 1e-9)
{
  return std::abs(a - b) <= tolerance;
}

double Value(vtkTable* table, const char* column, vtkIdType row)
{
  return table->GetValueByName(row, column).ToDouble();
}

//----------------------------------------------------------------------------------------------------
void TestPlacements()
{
  const double s = std::sqrt(0.5);
  Placement turned;
  turned.Origin = { 10, -20, 30 };
  turned.Spacing = { 2, 2, 2 };
  turned.Direction = { s, -s, 0, s, s, 0, 0, 0, 1 };
  Placement leftHanded = turned;
  leftHanded.Direction = { s, -s, 0, s, s, 0, 0, 0, -1 };
  for (const Placement& placement : { Placement(), turned, leftHanded })
  {
    const double spacing = placement.Spacing[0];
    Case c(placement, 0.25);
    c.Filter->Update();
    CHECK(c.Filter->GetErrorMessage().empty(), c.Filter->GetErrorMessage());
    CHECK(c.Filter->GetNumberOfLostLabels() == 0);
    CHECK(c.Filter->GetNumberOfLostComponents() == 0);

    vtkTable* const labels = c.Filter->GetLabelTable();
    CHECK(labels->GetNumberOfRows() == 1);
    CHECK(Value(labels, "Label", 0) == 3);
    CHECK(Value(labels, "Elements", 0) == 6);
    CHECK(Value(labels, "Voxels", 0) == 64);
    CHECK(Near(Value(labels, "Volume", 0), 64 * std::pow(spacing, 3)), Value(labels, "Volume", 0));
    CHECK(Near(Value(labels, "VolumeError", 0), 0.0));
    CHECK(Value(labels, "BoundaryEdges", 0) == 18);
    CHECK(Value(labels, "NonManifoldEdges", 0) == 0);

    // The corners that were moved away: (0.25, 0.5, 0.5) from the nearest centre of a voxel's face.
    const double corner = 0.75 * spacing;
    CHECK(Near(c.Filter->GetHausdorffDistance(), corner), c.Filter->GetHausdorffDistance());
    Vector place;
    c.Filter->GetHausdorffPlace(place.data());
    Vector index;
    c.Image->TransformPhysicalPointToContinuousIndex(place.data(), index.data());
    CHECK(Near(index[0], 5.75), index[0]);
    CHECK(Near(index[1], 1.5) || Near(index[1], 5.5), index[1]);
    CHECK(c.Filter->GetSmoothHausdorffDistance() > 0.0);
    CHECK(c.Filter->GetSmoothHausdorffDistance() < 1.5 * spacing);

    vtkCellData* const cells = c.Filter->GetOutput()->GetCellData();
    for (vtkIdType t = 0; t < 6; ++t)
    {
      CHECK(Near(cells->GetArray("Volume")->GetTuple1(t), 64 * std::pow(spacing, 3) / 6));
      CHECK(Near(cells->GetArray("MinimumDihedralAngle")->GetTuple1(t), 45));
      CHECK(Near(cells->GetArray("MaximumDihedralAngle")->GetTuple1(t), 90));
      CHECK(Near(cells->GetArray("RadiusEdgeRatio")->GetTuple1(t), std::sqrt(0.75)));
      CHECK(cells->GetArray("Label")->GetTuple1(t) == 3);
    }
    CHECK(Near(c.Filter->GetMinimumDihedralAngle(), 45));
    CHECK(Near(c.Filter->GetMaximumDihedralAngle(), 90));
    CHECK(Near(c.Filter->GetMaximumRadiusEdgeRatio(), std::sqrt(0.75)));
    CHECK(Near(c.Filter->GetMinimumPlanarAngle(), 45));
    CHECK(c.Filter->ToJSON().find("\"inverted_elements\":0") != std::string::npos);
    vtkTable* const histograms = c.Filter->GetHistograms();
    CHECK(histograms->GetNumberOfRows() == 90);
    CHECK(Value(histograms, "Angle", 45) == 90);
    CHECK(Value(histograms, "DihedralAngles", 22) == 12);
    CHECK(Value(histograms, "PlanarAngles", 22) == 24);
    CHECK(Near(Value(histograms, "Ratio", 17), 0.85));
    CHECK(Value(histograms, "RadiusEdgeRatios", 17) == 6);
  }
}

//----------------------------------------------------------------------------------------------------
void TestLabels()
{
  Case c{ Placement() };
  for (int i = 0; i < 3; ++i) // a component of three voxels, of a label that no element has
  {
    c.Image->SetScalarComponentFromDouble(i, 0, 0, 0, 9);
  }
  c.Image->SetScalarComponentFromDouble(6, 7, 7, 0, 9); // and one of two
  c.Image->SetScalarComponentFromDouble(7, 7, 7, 0, 9);
  c.Filter->Update();
  CHECK(c.Filter->GetNumberOfLostLabels() == 1);
  CHECK(c.Filter->GetNumberOfLostComponents() == 1); // the largest of its label, however small
  CHECK(c.Filter->GetLabelTable()->GetNumberOfRows() == 2);
  CHECK(Value(c.Filter->GetLabelTable(), "Elements", 1) == 0);
  CHECK(Near(Value(c.Filter->GetLabelTable(), "VolumeError", 1), -1.0));
  // The first voxel's outer corner face is the farthest from the mesh.
  CHECK(c.Filter->GetHausdorffDistance() > std::sqrt(3 * 1.5 * 1.5));
  c.Filter->SetSmallestComponent(3);
  c.Filter->Update();
  CHECK(c.Filter->GetNumberOfLostComponents() == 1);
  CHECK(
    c.Filter->ToJSON().find("\"lost_components\":[{\"label\":9,\"voxels\":3,\"voxel\":[0,0,0]}]") !=
      std::string::npos,
    c.Filter->ToJSON());
  c.Filter->SetSmallestComponent(2);
  c.Filter->Update();
  CHECK(c.Filter->GetNumberOfLostComponents() == 2);
  c.Filter->AddLabel(3);
  c.Filter->Update();
  CHECK(c.Filter->GetNumberOfLostLabels() == 0);
  CHECK(Near(c.Filter->GetHausdorffDistance(), std::sqrt(0.5)));
  c.Filter->RemoveAllLabels();
  c.Filter->DistancesOff();
  c.Filter->Update();
  CHECK(c.Filter->GetNumberOfLostLabels() == 1);
  CHECK(std::isnan(c.Filter->GetHausdorffDistance()));
  CHECK(c.Filter->ToJSON().find("\"hausdorff\":{}") != std::string::npos);
  c.Filter->SetImageData(nullptr);
  c.Filter->Update();
  CHECK(c.Filter->GetErrorMessage().empty());
  CHECK(c.Filter->GetNumberOfLostLabels() == 0);
  CHECK(c.Filter->GetLabelTable()->GetColumnByName("Voxels") == nullptr);
  CHECK(c.Filter->ToJSON().find("hausdorff") == std::string::npos);
}

/** Voxels that the image hides are background for measuring, too. */
void TestHidden()
{
  Case shown{ Placement() };
  Case hidden{ Placement() };
  vtkNew<vtkUnsignedCharArray> ghosts;
  ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
  for (vtkIdType i = 0; i < hidden.Image->GetNumberOfPoints(); ++i)
  {
    const bool isLeft = i % 8 < 4;
    ghosts->InsertNextValue(isLeft ? vtkDataSetAttributes::HIDDENPOINT : 0);
    if (isLeft)
    {
      shown.Image->GetPointData()->GetScalars()->SetComponent(i, 0, 0.0);
    }
  }
  hidden.Image->GetPointData()->AddArray(ghosts);
  shown.Filter->Update();
  hidden.Filter->Update();
  CHECK(shown.Filter->GetHausdorffDistance() > 1.5, shown.Filter->GetHausdorffDistance());
  CHECK(shown.Filter->ToJSON() == hidden.Filter->ToJSON(), hidden.Filter->ToJSON());
}

/** What the mesher counts with its own interfaces. */
void TestAgreesWithTheMesher()
{
  const auto mesher = MakeFilter(MakeTwoLabels());
  mesher->SetDelta(2.0);
  mesher->ComputeQualityOn();
  mesher->Update();
  vtkNew<vtkSimplexMeshQuality> filter;
  filter->SetInputConnection(mesher->GetOutputPort());
  filter->SetImageConnection(mesher->GetInputConnection(0, 0));
  filter->SetNumberOfThreads(1);
  filter->Update();
  const vtkMeshingStatistics* const statistics = mesher->GetStatistics();
  const auto json = filter->ToJSON();
  CHECK(json.find("\"interface_facets\":" +
          std::to_string(statistics->GetNumberOfInterfaceFacets()) + ",") != std::string::npos);
  CHECK(Near(filter->GetMinimumDihedralAngle(), statistics->GetMinimumDihedralAngle(), 1e-6));
  CHECK(Near(filter->GetMaximumRadiusEdgeRatio(), statistics->GetMaximumRadiusEdgeRatio(), 1e-6));
  CHECK(Near(filter->GetMinimumPlanarAngle(), statistics->GetMinimumPlanarAngle(), 1e-6));
  CHECK(filter->GetHausdorffDistance() > 0.2 && filter->GetHausdorffDistance() < 3.0);
  CHECK(filter->GetSmoothHausdorffDistance() > 0.02 && filter->GetSmoothHausdorffDistance() < 3.0);
  filter->SetNumberOfThreads(3);
  filter->Update();
  CHECK(filter->ToJSON() == json); // to the last bit
}

/** The mesh of a ball follows the smooth interface, which is half a voxel or so from the stairs of the image. */
void TestSmoothInterfaceOfABall()
{
  const auto mesher = MakeFilter(MakeBall());
  mesher->SetDelta(1.0);
  vtkNew<vtkSimplexMeshQuality> filter;
  filter->SetInputConnection(mesher->GetOutputPort());
  filter->SetImageConnection(mesher->GetInputConnection(0, 0));
  filter->Update();
  // Vertices lie on the smooth interface, centroids of facets a tenth of a voxel beside it. The middle of a voxel's
  // face is up to half a voxel from the mesh, and points between such middles are still farther from all of them.
  const double smooth = filter->GetSmoothHausdorffDistance();
  const double voxels = filter->GetHausdorffDistance();
  CHECK(smooth > 0.05 && smooth < 0.25, smooth);
  CHECK(voxels > 0.5 && voxels < 1.0, voxels);
  CHECK(smooth < 0.5 * voxels);
  const std::string json = filter->ToJSON();
  const auto fromImage = [&](const std::string& interfaces)
  {
    const std::string key = "\"image_to_mesh\":{\"max\":";
    const std::size_t at = json.find(key, json.find("\"" + interfaces + "\":{\"distance\""));
    return at == std::string::npos ? 0.0 : std::strtod(json.c_str() + at + key.size(), nullptr);
  };
  CHECK(fromImage("smooth") > 0.05 && fromImage("smooth") < 0.25, fromImage("smooth"));
  CHECK(fromImage("voxels") > 0.35 && fromImage("voxels") < 0.6, fromImage("voxels"));
}

//----------------------------------------------------------------------------------------------------
void ExpectError(vtkSimplexMeshQuality* filter, const std::string& words)
{
  vtkNew<ErrorCollector> errors;
  errors->Watch(filter);
  filter->Update();
  CHECK(errors->FromFilter.size() == 1, words);
  CHECK(filter->GetErrorMessage().find(words) != std::string::npos, filter->GetErrorMessage());
  CHECK(filter->GetOutput()->GetNumberOfCells() == 0);
  CHECK(filter->GetLabelTable()->GetNumberOfColumns() == 0);
  CHECK(filter->GetHistograms()->GetNumberOfColumns() == 0);
  filter->RemoveObserver(errors);
}

void TestErrors()
{
  {
    Case c{ Placement() };
    c.Grid->GetCellData()->GetArray("Label")->SetComponent(4, 0, 0);
    ExpectError(c.Filter, "Cell 4 of the mesh has the label 0");
    c.Grid->GetCellData()->GetArray("Label")->SetComponent(4, 0, 3);
    c.Grid->Modified();
    c.Filter->Update();
    CHECK(c.Filter->GetOutput()->GetNumberOfCells() == 6);
    c.Filter->SetSmoothingSigma(6.0);
    ExpectError(c.Filter, "SmoothingSigma is 6");
    c.Filter->SetSmoothingSigma(1.0);
    c.Filter->SetNumberOfThreads(-1);
    ExpectError(c.Filter, "NumberOfThreads is -1");
    c.Filter->SetNumberOfThreads(0);
    c.Filter->AddLabel(77);
    ExpectError(c.Filter, "77");
  }
  {
    Case c{ Placement() };
    c.Grid->GetCellData()->GetArray("Label")->SetName("Tissue");
    ExpectError(c.Filter, "no numeric cell array of labels");
    c.Filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "Tissue");
    c.Filter->Update();
    CHECK(c.Filter->GetOutput()->GetNumberOfCells() == 6);
  }
  {
    Case c{ Placement() };
    const vtkIdType triangle[3] = { 0, 1, 2 };
    c.Grid->InsertNextCell(VTK_TRIANGLE, 3, triangle);
    vtkIntArray::SafeDownCast(c.Grid->GetCellData()->GetArray("Label"))->InsertNextValue(1);
    ExpectError(c.Filter, "Cell 6 of the mesh is a vtkTriangle");
  }
  {
    Case c{ Placement() };
    c.Grid->GetPoints()->SetPoint(2, std::nan(""), 0, 0);
    ExpectError(c.Filter, "Point 2 of the mesh is not finite");
  }
  {
    Case c{ Placement() };
    c.Image->SetScalarComponentFromDouble(0, 0, 0, 0, 0);
    c.Image->GetPointData()->SetActiveScalars("none");
    ExpectError(c.Filter, "image has no such array");
  }
}

void TestEmptyMesh()
{
  Case c{ Placement() };
  c.Filter->SetInputData(NewGrid());
  c.Filter->Update();
  CHECK(c.Filter->GetErrorMessage().empty(), c.Filter->GetErrorMessage());
  CHECK(c.Filter->GetNumberOfLostLabels() == 1);
  CHECK(std::isnan(c.Filter->GetMinimumDihedralAngle()));
}

void TestAbort()
{
  const auto mesher = MakeFilter(MakeBall());
  vtkNew<vtkSimplexMeshQuality> filter;
  filter->SetInputConnection(mesher->GetOutputPort());
  const auto observer =
    Observe(filter, [](vtkAlgorithm* algorithm, double) { algorithm->SetAbortExecute(1); });
  filter->Update();
  CHECK(filter->GetAborted());
  CHECK(filter->GetErrorMessage().empty());
  CHECK(filter->GetOutput()->GetNumberOfCells() == 0);
  filter->RemoveObserver(observer);
  filter->Modified();
  filter->Update();
  CHECK(!filter->GetAborted());
  CHECK(filter->GetOutput()->GetNumberOfCells() > 0);
}

} // namespace

int TestSimplexMeshQuality(int, char*[])
{
  TestPlacements();
  TestLabels();
  TestHidden();
  TestAgreesWithTheMesher();
  TestSmoothInterfaceOfABall();
  TestErrors();
  TestEmptyMesh();
  TestAbort();
  return Result();
}
