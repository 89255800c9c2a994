// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// InputMode isosurface: grey-value images of all types and placements, what is refused.
#include "FilterTesting.h"

#include "vtkDataSetAttributes.h"
#include "vtkImageData.h"
#include "vtkMath.h"
#include "vtkMeshingStatistics.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include <cmath>
#include <set>

using namespace testing;

namespace
{

constexpr double Middle = 15.5;

double Radius(const Vector& x)
{
  return std::hypot(x[0] - Middle, x[1] - Middle, x[2] - Middle);
}

/** How deep a point is in a ball of radius 10. */
double Depth(const Vector& x)
{
  return 10.0 - Radius(x);
}

vtkSmartPointer<vtkImageToTetMeshFilter> MakeIsosurfaceFilter(vtkImageData* image, double isovalue)
{
  const auto filter = MakeFilter(image);
  filter->SetInputModeToIsosurface();
  filter->SetIsovalue(isovalue);
  filter->SetDelta(2.0);
  return filter;
}

std::set<long long> LabelsOf(vtkImageToTetMeshFilter* filter)
{
  const auto labels = Read(filter->GetOutput()).Labels;
  return { labels.begin(), labels.end() };
}

double LargestDistance(vtkImageToTetMeshFilter* filter)
{
  double largest = 0.0;
  vtkPolyData* interfaces = filter->GetInterfaces();
  for (vtkIdType i = 0; i < interfaces->GetNumberOfPoints(); ++i)
  {
    Vector x;
    interfaces->GetPoint(i, x.data());
    largest = std::max(largest, std::abs(Depth(x)));
  }
  return largest;
}

void TestDistance()
{
  const auto image = MakeImage({}, Depth, VTK_FLOAT);
  const auto filter = MakeIsosurfaceFilter(image, 0.0);
  filter->ComputeQualityOn();
  filter->Update();
  CheckMesh(filter);
  CHECK(LabelsOf(filter) == std::set<long long>({ 1 }));
  CHECK(LargestDistance(filter) < 0.05, LargestDistance(filter));
  vtkMeshingStatistics* statistics = filter->GetStatistics();
  CHECK(statistics->GetFigure("/isosurface/value") == 0.0);
  const double range[2] = { statistics->GetFigure("/isosurface/range/0"),
    statistics->GetFigure("/isosurface/range/1") };
  double* exact = image->GetScalarRange();
  CHECK(range[0] == exact[0] && range[1] == exact[1], range[0], range[1]);
  CHECK(statistics->ToJSON().find(
          "\"isosurface\":{\"value\":0.0,\"inside\":\"above\",\"range\":[-") != std::string::npos);

  filter->SetIsovalue(2.0); // a smaller ball
  filter->Update();
  const double ratio = Read(filter->GetOutput()).VolumeOf() / (4.0 / 3.0 * vtkMath::Pi() * 512.0);
  CHECK(ratio > 0.93 && ratio < 1.01, ratio);
}

void TestTypes()
{
  for (const int type : { VTK_CHAR, VTK_UNSIGNED_CHAR, VTK_SHORT, VTK_UNSIGNED_SHORT, VTK_INT,
         VTK_UNSIGNED_INT, VTK_LONG, VTK_LONG_LONG, VTK_ID_TYPE, VTK_FLOAT, VTK_DOUBLE })
  {
    const auto image = MakeImage(
      {}, [](const Vector& x) { return std::max(0.0, std::round(60.0 + 4.0 * Depth(x))); }, type);
    const auto filter = MakeIsosurfaceFilter(image, 60.25);
    filter->Update();
    CHECK(filter->GetErrorMessage().empty(), filter->GetErrorMessage());
    CHECK(LargestDistance(filter) < 0.3, type, LargestDistance(filter));
  }
}

/** Hidden voxels are outside of isosurfaces, as NaN is, whatever their values; in all types. */
void TestHidden()
{
  const auto isHidden = [](const Vector& x) { return x[0] < Middle; };
  const auto value = [](const Vector& x) { return std::round(4.0 * Depth(x)); };
  for (const bool below : { false, true })
  {
    const auto make = [&](vtkImageData* image)
    {
      const auto filter = MakeIsosurfaceFilter(image, 0.5);
      filter->SetInside(
        below ? vtkImageToTetMeshFilter::INSIDE_BELOW : vtkImageToTetMeshFilter::INSIDE_ABOVE);
      filter->Update();
      return filter;
    };
    const auto expected = make(MakeImage(
      {}, [&](const Vector& x) { return isHidden(x) ? vtkMath::Nan() : value(x); }, VTK_DOUBLE));
    CHECK(!Empty(expected));
    for (const int type : { VTK_CHAR, VTK_SHORT, VTK_INT, VTK_FLOAT, VTK_DOUBLE })
    {
      const auto image = MakeImage({}, value, type);
      vtkNew<vtkUnsignedCharArray> ghosts;
      ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
      for (vtkIdType i = 0; i < image->GetNumberOfPoints(); ++i)
      {
        Vector x;
        image->GetPoint(i, x.data());
        ghosts->InsertNextValue(isHidden(x) ? vtkDataSetAttributes::HIDDENPOINT : 0);
      }
      image->GetPointData()->AddArray(ghosts);
      CHECK(SameMesh(make(image)->GetOutput(), expected->GetOutput()), type, below);
    }
  }
}

/** Spacing, origin, tilted and left-handed axes, an extent that does not begin at 0, cell scalars. */
void TestPlacement()
{
  Placement placement;
  placement.Extent = { 3, 42, -5, 24, 2, 31 };
  placement.Spacing = { 0.8, 1.1, 1.0 };
  const double c = std::cos(0.5);
  const double s = std::sin(0.5);
  placement.Direction = { c, -s, 0, s, c, 0, 0, 0, -1 };
  const Vector corner{ c * 0.8 * 22.5 - s * 1.1 * 9.5, s * 0.8 * 22.5 + c * 1.1 * 9.5, -16.5 };
  for (std::size_t a = 0; a < 3; ++a)
  {
    placement.Origin[a] = Middle - corner[a];
  }
  for (const bool cells : { false, true })
  {
    placement.Cells = cells;
    const auto filter = MakeIsosurfaceFilter(MakeImage(placement, Depth, VTK_FLOAT), 0.5);
    filter->Update();
    CheckMesh(filter);
    CHECK(std::abs(LargestDistance(filter) - 0.5) < 0.06, LargestDistance(filter));
  }
}

void TestSides()
{
  const auto above = MakeIsosurfaceFilter(MakeImage({}, Depth, VTK_DOUBLE), 0.25);
  const auto below =
    MakeIsosurfaceFilter(MakeImage(
                           {}, [](const Vector& x) { return -Depth(x); }, VTK_DOUBLE),
      -0.25);
  below->SetInsideToBelow();
  CHECK(std::string(above->GetInsideAsString()) == "above");
  CHECK(std::string(below->GetInsideAsString()) == "below");
  above->Update();
  below->Update();
  CHECK(SameMesh(above->GetOutput(), below->GetOutput()));

  // The label of the inside, which may have a size.
  above->SetInsideLabel(77);
  above->SetLabelSize(77, 1.5);
  const vtkIdType coarse = above->GetOutput()->GetNumberOfCells();
  above->Update();
  CheckMesh(above);
  CHECK(LabelsOf(above) == std::set<long long>({ 77 }));
  CHECK(above->GetOutput()->GetNumberOfCells() > 2 * coarse);
}

void TestSmoothing()
{
  unsigned state = 1;
  const auto image = MakeImage(
    {},
    [&state](const Vector& x)
    {
      state = state * 1664525u + 1013904223u;
      return Depth(x) + 1.2 * (static_cast<double>(state >> 8) / (1 << 24) - 0.5);
    },
    VTK_FLOAT);
  const auto filter = MakeIsosurfaceFilter(image, 0.0);
  filter->SetSmoothingSigma(3.0); // about labels only
  filter->Update();
  const double rough = LargestDistance(filter);
  filter->SetIsosurfaceSmoothingSigma(1.5);
  filter->Update();
  CheckMesh(filter);
  CHECK(LargestDistance(filter) < 0.5 * rough, LargestDistance(filter), rough);
}

void TestStatistics()
{
  const auto filter = MakeFilter(MakeBall(5.0));
  filter->Update();
  CHECK(filter->GetStatistics()->ToJSON().find("\"isosurface\":null") != std::string::npos);
}

} // namespace

int TestTetMeshIsosurface(int, char*[])
{
  TestDistance();
  TestTypes();
  TestHidden();
  TestPlacement();
  TestSides();
  TestSmoothing();
  TestStatistics();
  return Result();
}
