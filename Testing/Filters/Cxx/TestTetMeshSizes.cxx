// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Element sizes of every kind: each makes more elements, and no element is larger than its bound.
#include "FilterTesting.h"

#include "vtkDoubleArray.h"
#include "vtkImageData.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkPlane.h"
#include "vtkPointData.h"
#include "vtkTetra.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <atomic>
#include <cmath>

using namespace testing;

namespace
{

/** Coarse enough that a size bites: few elements without one. */
vtkSmartPointer<vtkImageToTetMeshFilter> MakeCoarse(const Placement& placement = {})
{
  const auto filter = MakeFilter(MakeImage(placement,
    [](const Vector& x)
    {
      const double r = std::hypot(x[0] - 15.5, x[1] - 15.5, x[2] - 15.5);
      return r < 13.0 ? (x[0] < 15.5 ? 1.0 : 2.0) : 0.0;
    }));
  filter->SetDelta(4.0);
  filter->OptimiseOff(); // which keeps to sizes only about
  return filter;
}

vtkIdType CountWithout()
{
  static const vtkIdType count = []
  {
    const auto filter = MakeCoarse();
    filter->Update();
    return filter->GetOutput()->GetNumberOfCells();
  }();
  return count;
}

using Bound = std::function<double(const Vector& centre, long long label)>;

/** Every circumradius against the bound at its circumcentre, and more elements than without. */
void CheckSizes(vtkImageToTetMeshFilter* filter, const char* name, const Bound& bound)
{
  filter->Update();
  CheckMesh(filter);
  const Tetrahedra mesh = Read(filter->GetOutput());
  CHECK(static_cast<double>(mesh.Cells.size()) > 1.3 * static_cast<double>(CountWithout()), name,
    mesh.Cells.size(), CountWithout());
  double worst = 0.0;
  for (std::size_t c = 0; c < mesh.Cells.size(); ++c)
  {
    Simplex<3> t = mesh.Corners(c);
    Vector centre;
    const double square =
      vtkTetra::Circumsphere(t[0].data(), t[1].data(), t[2].data(), t[3].data(), centre.data());
    worst = std::max(worst, std::sqrt(square) / bound(centre, mesh.Labels[c]));
  }
  CHECK(worst <= 1.0 + 1e-6, name, worst);
}

void TestUniform()
{
  const auto filter = MakeCoarse();
  filter->SetElementSize(1.6);
  CheckSizes(filter, "uniform", [](const Vector&, long long) { return 1.6; });
  filter->SetElementSize(0.0);
  filter->Update();
  CHECK(filter->GetOutput()->GetNumberOfCells() == CountWithout());
}

void TestPerLabel()
{
  const auto filter = MakeCoarse();
  filter->SetLabelSize(2, 1.5);
  CHECK(filter->GetLabelSize(2) == 1.5 && filter->GetLabelSize(1) == 0.0);
  CHECK(filter->GetNumberOfLabelSizes() == 1 && filter->GetSizedLabel(0) == 2);
  CheckSizes(filter, "per label",
    [](const Vector&, long long label) { return label == 2 ? 1.5 : VTK_DOUBLE_MAX; });
  const Tetrahedra mesh = Read(filter->GetOutput());
  const auto fine = std::count(mesh.Labels.begin(), mesh.Labels.end(), 2);
  const auto coarse = std::count(mesh.Labels.begin(), mesh.Labels.end(), 1);
  CHECK(fine > 2 * coarse, fine, coarse);
  filter->RemoveLabelSize(2);
  filter->Update();
  CHECK(filter->GetOutput()->GetNumberOfCells() == CountWithout());
  filter->SetLabelSize(1, 2.0);
  filter->SetLabelSize(2, 2.0);
  filter->ClearLabelSizes();
  CHECK(filter->GetNumberOfLabelSizes() == 0);
}

/** Size 1.5 + 0.15 |x - 4|, which a linear interpolation on whole x reproduces. */
double Graded(double x)
{
  return 1.5 + 0.15 * std::abs(x - 4.0);
}

void TestImage(bool cells)
{
  Placement grid; // coarser, rotated by a quarter turn, larger than the label image
  grid.Extent = { -2, 18, -2, 18, -2, 18 };
  grid.Spacing = { 2, 2, 2 };
  grid.Direction = { 0, 1, 0, -1, 0, 0, 0, 0, 1 };
  grid.Origin = { 0, 32, 0 };
  grid.Cells = cells;
  const auto sizes = MakeImage(
    grid, [](const Vector& x) { return Graded(x[0]); }, VTK_FLOAT);
  const auto filter = MakeCoarse();
  filter->SetElementSizeData(sizes);
  const auto bound = [cells](const Vector& x, long long)
  {
    // Between the cell centres 3 and 5 the image is flat where Graded() has its kink.
    return (cells && std::abs(x[0] - 4.0) < 1.0 ? Graded(3.0) : Graded(x[0])) + 1e-5;
  };
  CheckSizes(filter, cells ? "image of cells" : "image of points", bound);
  filter->SetElementSizeData(nullptr);
  filter->Update();
  CHECK(filter->GetOutput()->GetNumberOfCells() == CountWithout());
}

/** Outside of the image of sizes the nearest value counts; what is not a size sets no bound. */
void TestSmallImage()
{
  Placement grid;
  grid.Extent = { 0, 3, 0, 3, 0, 3 };
  grid.Origin = { 14, 14, 14 };
  const auto filter = MakeCoarse();
  filter->SetElementSizeData(MakeImage(
    grid, [](const Vector&) { return 1.7; }, VTK_DOUBLE));
  CheckSizes(filter, "clamped", [](const Vector&, long long) { return 1.7 + 1e-9; });
  CHECK(filter->GetNumberOfWarnings() == 1);
  CHECK(
    filter->GetWarning(0).find("The image of sizes (SetElementSizeData()) does not cover ") == 0,
    filter->GetWarning(0));

  filter->SetElementSizeData(MakeImage(
    grid, [](const Vector& x) { return x[0] < 15.5 ? vtkMath::Nan() : 0.0; }, VTK_DOUBLE));
  filter->Update();
  CHECK(filter->GetOutput()->GetNumberOfCells() == CountWithout());

  grid.Extent = { 0, 0, 0, 0, 0, 0 };
  filter->SetElementSizeData(MakeImage(
    grid, [](const Vector&) { return 1.9; }, VTK_DOUBLE));
  CheckSizes(filter, "one voxel", [](const Vector&, long long) { return 1.9 + 1e-9; });
}

/** An image of sizes beside the image is refused; one that has a corner of it is not. */
void TestImageBeside()
{
  const auto filter = MakeCoarse();
  Placement grid;
  grid.Extent = { 0, 9, 0, 9, 0, 9 };
  grid.Spacing = { 2, 2, 2 };
  grid.Direction = { 0, 1, 0, -1, 0, 0, 0, 0, 1 }; // y from -19 to 1
  const auto update = [&](const Vector& origin)
  {
    grid.Origin = origin;
    filter->SetElementSizeData(MakeImage(
      grid, [](const Vector&) { return 3.0; }, VTK_DOUBLE));
    vtkObject::GlobalWarningDisplayOff();
    filter->Update();
    vtkObject::GlobalWarningDisplayOn();
    return filter->GetErrorMessage();
  };
  CHECK(update({ 0, 0, 0 }).empty(), filter->GetErrorMessage());
  const std::string message = update({ 0, -2, 1000 });
  CHECK(message ==
      "The image of sizes (SetElementSizeData()) lies beside the image: it has x from -1 to 19, y "
      "from -21 to -1, z from 999 "
      "to 1019; the image has x from -0.5 to 31.5, y from -0.5 to 31.5, z from -0.5 to 31.5. "
      "Correct "
      "its spacing, origin or direction.",
    message);
  CHECK(filter->GetOutput()->GetNumberOfCells() == 0);
  CHECK(!update({ 0, -2, 0 }).empty());
}

/** The array of sizes is chosen by name, too. */
void TestNamedImage()
{
  const auto sizes = MakeImage(
    {}, [](const Vector&) { return 100.0; }, VTK_DOUBLE);
  vtkNew<vtkDoubleArray> fine;
  fine->SetName("Fine");
  fine->SetNumberOfTuples(sizes->GetNumberOfPoints());
  fine->Fill(1.8);
  sizes->GetPointData()->AddArray(fine);
  const auto filter = MakeCoarse();
  filter->SetElementSizeData(sizes);
  filter->SetInputArrayToProcess(1, 1, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "Fine");
  CheckSizes(filter, "named", [](const Vector&, long long) { return 1.8 + 1e-9; });

  filter->SetElementSizeArray(vtkDataObject::FIELD_ASSOCIATION_POINTS, "");
  filter->Update();
  CHECK(filter->GetOutput()->GetNumberOfCells() == CountWithout());
  filter->SetElementSizeArray(vtkDataObject::FIELD_ASSOCIATION_POINTS, "Fine");
  CheckSizes(filter, "named in short", [](const Vector&, long long) { return 1.8 + 1e-9; });
}

void TestImplicitFunction()
{
  vtkNew<vtkPlane> plane; // 0.15 (x + 10): 1.9 to 5.8 over the ball
  plane->SetOrigin(-10, 0, 0);
  plane->SetNormal(0.15, 0, 0);
  const auto filter = MakeCoarse();
  filter->SetSizeImplicitFunction(plane);
  CHECK(filter->GetSizeImplicitFunction() == plane);
  CheckSizes(
    filter, "implicit", [](const Vector& x, long long) { return 0.15 * (x[0] + 10) + 1e-9; });

  const vtkIdType before = filter->GetOutput()->GetNumberOfCells();
  plane->SetOrigin(-8, 0, 0); // smaller everywhere; the filter must notice
  filter->Update();
  CHECK(filter->GetOutput()->GetNumberOfCells() > before);

  filter->SetNumberOfThreads(4);
  CheckSizes(filter, "implicit, 4 threads",
    [](const Vector& x, long long) { return 0.15 * (x[0] + 8) + 1e-9; });
}

void TestCallable()
{
  const auto filter = MakeCoarse();
  std::atomic<int> calls = 0;
  std::atomic<bool> goodLabels = true;
  filter->SetSizeFunction(
    [&](const double x[3], vtkTypeInt64 label)
    {
      ++calls;
      goodLabels = goodLabels && (label == 1 || label == 2);
      return label == 1 ? Graded(x[0]) : -1.0; // no bound in label 2
    });
  CheckSizes(filter, "callable",
    [](const Vector& x, long long label) { return label == 1 ? Graded(x[0]) : VTK_DOUBLE_MAX; });
  CHECK(calls > 0 && goodLabels);
  filter->SetNumberOfThreads(4);
  CheckSizes(filter, "callable, 4 threads",
    [](const Vector& x, long long label) { return label == 1 ? Graded(x[0]) : VTK_DOUBLE_MAX; });
  CHECK(goodLabels);
  filter->SetNumberOfThreads(1);
  filter->SetSizeFunction(nullptr);
  filter->Update();
  CHECK(filter->GetOutput()->GetNumberOfCells() == CountWithout());
}

/** All kinds at once: the smallest applies. */
void TestCombination()
{
  Placement moved; // the callable and the plane see physical positions
  moved.Origin = { 0, 0, 0 };
  const auto filter = MakeCoarse(moved);
  vtkNew<vtkPlane> plane;
  plane->SetOrigin(-10, 0, 0);
  plane->SetNormal(0.15, 0, 0);
  filter->SetElementSize(2.4);
  filter->SetLabelSize(1, 2.2);
  filter->SetSizeImplicitFunction(plane);
  filter->SetElementSizeData(MakeImage(
    {}, [](const Vector& x) { return 1.8 + 0.1 * x[1]; }, VTK_DOUBLE));
  filter->SetSizeFunction([](const double x[3], vtkTypeInt64) { return 1.6 + 0.1 * x[2]; });
  CheckSizes(filter, "all",
    [](const Vector& x, long long label)
    {
      return std::min({ 2.4, label == 1 ? 2.2 : 2.4, 0.15 * (x[0] + 10), 1.8 + 0.1 * x[1],
               1.6 + 0.1 * x[2] }) +
        1e-9;
    });
}

} // namespace

int TestTetMeshSizes(int, char*[])
{
  TestUniform();
  TestPerLabel();
  TestImage(false);
  TestImage(true);
  TestSmallImage();
  TestImageBeside();
  TestNamedImage();
  TestImplicitFunction();
  TestCallable();
  TestCombination();
  return Result();
}
