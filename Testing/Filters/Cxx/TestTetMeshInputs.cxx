// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Every way to hand over labels gives the same mesh: scalar types, memory layouts, array choice.
#include "FilterTesting.h"

#include "vtkBitArray.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkSOADataArrayTemplate.h"
#include "vtkUniformGrid.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include <cmath>

using namespace testing;

namespace
{

double Label(const Vector& x)
{
  return std::hypot(x[0] - 15.5, x[1] - 15.5, x[2] - 15.5) < 6.0 ? 1.0 : 0.0;
}

vtkSmartPointer<vtkUnstructuredGrid> MeshOf(vtkImageData* image)
{
  const auto filter = MakeFilter(image);
  filter->Update();
  CHECK(filter->GetErrorMessage().empty(), filter->GetErrorMessage());
  return filter->GetOutput();
}

void TestTypes(vtkUnstructuredGrid* expected)
{
  for (const int type : { VTK_CHAR, VTK_SIGNED_CHAR, VTK_UNSIGNED_CHAR, VTK_SHORT,
         VTK_UNSIGNED_SHORT, VTK_INT, VTK_UNSIGNED_INT, VTK_LONG, VTK_UNSIGNED_LONG, VTK_LONG_LONG,
         VTK_UNSIGNED_LONG_LONG, VTK_ID_TYPE, VTK_FLOAT, VTK_DOUBLE })
  {
    const auto mesh = MeshOf(MakeImage({}, Label, type));
    CHECK(SameMesh(mesh, expected), vtkImageScalarTypeNameMacro(type));
  }
}

void TestLayouts(vtkUnstructuredGrid* expected)
{
  const auto image = MakeImage({}, Label);
  vtkDataArray* plain = image->GetPointData()->GetScalars();
  vtkNew<vtkSOADataArrayTemplate<short>> separate;
  separate->SetNumberOfComponents(1);
  separate->SetNumberOfTuples(plain->GetNumberOfTuples());
  vtkNew<vtkBitArray> bits;
  for (vtkIdType i = 0; i < plain->GetNumberOfTuples(); ++i)
  {
    separate->SetValue(i, static_cast<short>(plain->GetComponent(i, 0)));
    bits->InsertNextValue(static_cast<int>(plain->GetComponent(i, 0)));
  }
  image->GetPointData()->SetScalars(separate);
  CHECK(SameMesh(MeshOf(image), expected), "structure of arrays");
  image->GetPointData()->SetScalars(bits);
  CHECK(SameMesh(MeshOf(image), expected), "bits");
}

/** Point scalars go before cell scalars; a name and an association choose any array. */
void TestChoice(vtkUnstructuredGrid* expected)
{
  const auto image = MakeImage({}, Label);
  vtkNew<vtkUnsignedCharArray> cells;
  cells->SetName("Cells");
  cells->SetNumberOfTuples(image->GetNumberOfCells());
  cells->Fill(0);
  for (vtkIdType i = 12; i < 20; ++i)
  {
    for (vtkIdType j = 12; j < 20; ++j)
    {
      for (vtkIdType k = 12; k < 20; ++k)
      {
        cells->SetValue(i + 31 * (j + 31 * k), 5);
      }
    }
  }
  image->GetCellData()->SetScalars(cells);
  vtkNew<vtkUnsignedCharArray> other;
  other->SetName("Other");
  other->SetNumberOfTuples(image->GetNumberOfPoints());
  other->Fill(0);
  image->GetPointData()->AddArray(other);

  const auto filter = MakeFilter(image);
  filter->Update();
  CHECK(SameMesh(filter->GetOutput(), expected), "point scalars first");

  filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "Cells");
  filter->SetDelta(1.0); // a cube loses its edges
  filter->Update();
  CheckMesh(filter);
  const Tetrahedra mesh = Read(filter->GetOutput());
  CHECK(!mesh.Labels.empty() && mesh.Labels.front() == 5);
  CHECK(std::abs(mesh.VolumeOf() / 512.0 - 1.0) < 0.2, mesh.VolumeOf());
  for (const double c : mesh.Centroid())
  {
    CHECK(std::abs(c - 16.0) < 0.1, c);
  }

  filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "Segmentation");
  filter->SetDelta(0.0);
  filter->Update();
  CHECK(SameMesh(filter->GetOutput(), expected), "by name");

  image->GetPointData()->Initialize();
  const auto onlyCells = MakeFilter(image);
  onlyCells->Update();
  CHECK(Read(onlyCells->GetOutput()).Labels.front() == 5, "cell scalars where there is no other");
}

/** Scalars are read in place: the filter must not change them. */
void TestUntouched()
{
  const auto image = MakeImage({}, Label);
  const auto copy = vtkSmartPointer<vtkImageData>::New();
  copy->DeepCopy(image);
  MeshOf(image);
  vtkDataArray* a = image->GetPointData()->GetScalars();
  vtkDataArray* b = copy->GetPointData()->GetScalars();
  bool same = true;
  for (vtkIdType i = 0; i < a->GetNumberOfTuples(); ++i)
  {
    same = same && a->GetComponent(i, 0) == b->GetComponent(i, 0);
  }
  CHECK(same);
}

vtkUnsignedCharArray* AddGhosts(vtkDataSetAttributes* data, vtkIdType count)
{
  vtkNew<vtkUnsignedCharArray> ghosts;
  ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
  ghosts->SetNumberOfTuples(count);
  ghosts->Fill(0);
  data->AddArray(ghosts);
  return ghosts; // the attributes keep it
}

/** The left half of the ball; of cells, the half whose centres are left of 15.5. */
bool IsLeft(const Vector& x)
{
  return x[0] < 15.5;
}

/**
 * Voxels that the image hides are background, on points and cells, by points and cells; duplicates are not
 * hidden. The image stays as it is.
 */
void TestHidden()
{
  using Attributes = vtkDataSetAttributes;
  const auto half = [](const Vector& x) { return IsLeft(x) ? 0.0 : Label(x); };
  const auto expected = MeshOf(MakeImage({}, half));
  // Hidden voxels may have any value.
  const auto strange = [](const Vector& x) { return IsLeft(x) ? -1.5 : Label(x); };
  for (const int type : { VTK_UNSIGNED_CHAR, VTK_FLOAT })
  {
    const auto image = MakeImage({}, type == VTK_FLOAT ? strange : Label, type);
    auto* const ghosts = AddGhosts(image->GetPointData(), image->GetNumberOfPoints());
    for (vtkIdType i = 0; i < image->GetNumberOfPoints(); ++i)
    {
      Vector x;
      image->GetPoint(i, x.data());
      ghosts->SetValue(i, IsLeft(x) ? Attributes::HIDDENPOINT : Attributes::DUPLICATEPOINT);
    }
    const double before =
      image->GetPointData()->GetScalars()->GetComponent(15 + 32 * (15 + 32 * 15), 0);
    CHECK(SameMesh(MeshOf(image), expected), "points", type);
    CHECK(image->GetPointData()->GetScalars()->GetComponent(15 + 32 * (15 + 32 * 15), 0) == before);
  }

  // Points are hidden where all cells around them are: the cells from point 14 to 15 are the last hidden ones.
  vtkNew<vtkUniformGrid> grid;
  grid->ShallowCopy(MakeImage({}, Label));
  for (vtkIdType i = 0; i < grid->GetNumberOfCells(); ++i)
  {
    double bounds[6];
    grid->GetCellBounds(i, bounds);
    if (bounds[0] < 15.5)
    {
      grid->BlankCell(i);
    }
  }
  CHECK(SameMesh(MeshOf(grid), expected), "points by cells");

  Placement cells;
  cells.Cells = true;
  cells.Extent = { 0, 32, 0, 32, 0, 32 };
  cells.Origin = { -0.5, -0.5, -0.5 };
  const auto expectedCells = MeshOf(MakeImage(cells, half));
  for (const auto kind : { Attributes::HIDDENCELL, Attributes::REFINEDCELL })
  {
    const auto image = MakeImage(cells, Label);
    auto* const ghosts = AddGhosts(image->GetCellData(), image->GetNumberOfCells());
    for (vtkIdType i = 0; i < image->GetNumberOfCells(); ++i)
    {
      ghosts->SetValue(i, i % 32 < 16 ? kind : Attributes::DUPLICATECELL);
    }
    CHECK(SameMesh(MeshOf(image), expectedCells), "cells", kind);
  }
  // A cell with a hidden corner is hidden.
  const auto image = MakeImage(cells, Label);
  auto* const ghosts = AddGhosts(image->GetPointData(), image->GetNumberOfPoints());
  for (vtkIdType i = 0; i < image->GetNumberOfPoints(); ++i)
  {
    ghosts->SetValue(i, i % 33 <= 15 ? Attributes::HIDDENPOINT : 0);
  }
  CHECK(SameMesh(MeshOf(image), expectedCells), "cells by points");
}

/** Hidden voxels of an image of sizes set no bound. */
void TestHiddenSizes(vtkUnstructuredGrid* expected)
{
  const auto sizes = MakeImage(
    {}, [](const Vector&) { return 0.5; }, VTK_FLOAT);
  AddGhosts(sizes->GetPointData(), sizes->GetNumberOfPoints())
    ->Fill(vtkDataSetAttributes::HIDDENPOINT);
  const auto filter = MakeFilter(MakeImage({}, Label));
  filter->SetElementSizeData(sizes);
  filter->Update();
  CHECK(SameMesh(filter->GetOutput(), expected));
}

/** Labels that were scaled and scaled back, in single precision. */
void TestRounded(vtkUnstructuredGrid* expected)
{
  const auto rounded = [](const Vector& x)
  { return Label(x) + 1e-7 * std::sin(x[0] + 3.0 * x[1] + 7.0 * x[2]); };
  CHECK(SameMesh(MeshOf(MakeImage({}, rounded, VTK_FLOAT)), expected));
  CHECK(SameMesh(MeshOf(MakeImage({}, rounded, VTK_DOUBLE)), expected));
}

} // namespace

int TestTetMeshInputs(int, char*[])
{
  const auto expected = MeshOf(MakeImage({}, Label));
  CHECK(expected->GetNumberOfCells() > 0);
  TestTypes(expected);
  TestLayouts(expected);
  TestChoice(expected);
  TestUntouched();
  TestHidden();
  TestHiddenSizes(expected);
  TestRounded(expected);
  return Result();
}
