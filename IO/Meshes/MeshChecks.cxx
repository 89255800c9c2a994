// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Meshes/MeshChecks.h"

#include "FileError.h"

#include <vtkCellArray.h>
#include <vtkDataArray.h>
#include <vtkDataSetAttributes.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkVersion.h>

#include <array>

namespace voxplex::io
{
namespace
{

/** The type of each cell. */
vtkDataArray* TypesOf(vtkUnstructuredGrid* grid)
{
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 6, 0)
  return grid->GetCellTypes();
#else
  return grid->GetCellTypesArray();
#endif
}

} // namespace

vtkDataArray* CheckArray(vtkDataSetAttributes* attributes, const char* name, int components,
  vtkIdType count, const std::string& what, const std::string& advice)
{
  vtkDataArray* array = attributes->GetArray(name);
  RefuseIf(!array || array->GetNumberOfComponents() != components, what, " no array '", name,
    "' of ", components, (components == 1 ? " component" : " components"), advice);
  RefuseIf(array->GetNumberOfTuples() != count, what, " ", array->GetNumberOfTuples(), " values '",
    name, "' for ", count, " cells or points");
  return array;
}

void CheckVertices(vtkCellArray* cells, vtkPointSet* owner)
{
  if (cells->GetNumberOfCells() == 0)
  {
    return;
  }
  std::array<double, 2> offsets;
  cells->GetOffsetsArray()->GetRange(offsets.data());
  std::array<double, 2> ids{ 0.0, -1.0 };
  if (cells->GetNumberOfConnectivityIds() > 0)
  {
    cells->GetConnectivityArray()->GetRange(ids.data());
  }
  RefuseIf(offsets[0] < 0 ||
      offsets[1] > static_cast<double>(cells->GetNumberOfConnectivityIds()) || ids[0] < 0 ||
      ids[1] >= static_cast<double>(owner->GetNumberOfPoints()),
    "it has cells with vertices that are none of its points");
}

void CheckCells(vtkUnstructuredGrid* grid, int type, vtkIdType size, const std::string& what,
  const std::string& advice)
{
  if (grid->GetNumberOfCells() == 0)
  {
    return;
  }
  RefuseIf(TypesOf(grid)->GetNumberOfTuples() != grid->GetNumberOfCells(),
    "it has not as many types as cells");
  for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell)
  {
    RefuseIf(grid->GetCellType(cell) != type || grid->GetCells()->GetCellSize(cell) != size, what,
      ", and cell ", cell, " is none", advice);
  }
  CheckVertices(grid->GetCells(), grid);
}

void CheckTriangles(vtkPolyData* surface, const std::string& message)
{
  vtkCellArray* polygons = surface->GetPolys();
  const bool isOther = surface->GetNumberOfCells() != polygons->GetNumberOfCells();
  RefuseIf(
    isOther || (polygons->GetNumberOfCells() > 0 && polygons->IsHomogeneous() != 3), message);
  CheckVertices(polygons, surface);
}

bool ArePoints(vtkDataArray* ids, vtkIdType numberOfPoints)
{
  bool are = true;
  for (vtkIdType i = 0; are && i < ids->GetNumberOfValues(); ++i)
  {
    const int components = ids->GetNumberOfComponents();
    const double id = ids->GetComponent(i / components, static_cast<int>(i % components));
    are = id >= 0 && id < static_cast<double>(numberOfPoints);
  }
  return are;
}

void CheckPointIds(vtkDataSet* interfaces, vtkIdType numberOfPoints)
{
  RefuseIf(!ArePoints(interfaces->GetPointData()->GetArray("PointIds"), numberOfPoints),
    "the interfaces are not those of this mesh: their PointIds are not its points");
}

} // namespace voxplex::io
