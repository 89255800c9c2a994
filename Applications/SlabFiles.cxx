// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "SlabFiles.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <limits>

namespace voxplex::cli
{

std::vector<std::string> NamesOfSlabs(const std::string& prefix, vtkUnstructuredGrid* mesh)
{
  const vtkIdType planes = mesh->GetFieldData()->GetArray("TimePlanes")->GetNumberOfTuples();
  std::vector<std::string> names;
  for (vtkIdType slab = 0; slab <= planes; ++slab)
  {
    names.push_back(prefix + std::to_string(slab) + ".vtu");
  }
  return names;
}

vtkSmartPointer<vtkUnstructuredGrid> SlabOf(vtkUnstructuredGrid* mesh, int slab)
{
  vtkDataArray* const slabs = mesh->GetCellData()->GetArray("Slab");
  std::vector<vtkIdType> cells;
  std::vector<vtkIdType> numbers(static_cast<std::size_t>(mesh->GetNumberOfPoints()), -1);
  vtkIdType size = 0;
  const vtkIdType* ids = nullptr;
  for (vtkIdType cell = 0; cell < mesh->GetNumberOfCells(); ++cell)
  {
    if (slabs->GetComponent(cell, 0) == slab)
    {
      cells.push_back(cell);
      mesh->GetCellPoints(cell, size, ids);
      std::for_each_n(
        ids, size, [&numbers](vtkIdType id) { numbers[static_cast<std::size_t>(id)] = 0; });
    }
  }
  std::vector<vtkIdType> points;
  for (std::size_t id = 0; id < numbers.size(); ++id)
  {
    if (numbers[id] == 0)
    {
      numbers[id] = static_cast<vtkIdType>(points.size());
      points.push_back(static_cast<vtkIdType>(id));
    }
  }

  auto result = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkPoints> positions;
  positions->SetDataType(mesh->GetPoints()->GetDataType());
  vtkNew<vtkIdTypeArray> globalIds;
  globalIds->SetName("GlobalIds");
  const auto n = static_cast<vtkIdType>(points.size());
  result->GetPointData()->CopyAllocate(mesh->GetPointData(), n);
  vtkDataArray* const times = mesh->GetPointData()->GetArray("Time");
  double first = std::numeric_limits<double>::infinity();
  double last = -first;
  for (vtkIdType i = 0; i < n; ++i)
  {
    const vtkIdType id = points[static_cast<std::size_t>(i)];
    positions->InsertNextPoint(mesh->GetPoint(id));
    globalIds->InsertNextValue(id);
    result->GetPointData()->CopyData(mesh->GetPointData(), id, i);
    first = std::min(first, times->GetComponent(id, 0));
    last = std::max(last, times->GetComponent(id, 0));
  }
  result->SetPoints(positions);
  result->GetPointData()->SetGlobalIds(globalIds);

  vtkNew<vtkCellArray> connectivity;
  result->GetCellData()->CopyAllocate(mesh->GetCellData(), static_cast<vtkIdType>(cells.size()));
  for (std::size_t k = 0; k < cells.size(); ++k)
  {
    mesh->GetCellPoints(cells[k], size, ids);
    connectivity->InsertNextCell(static_cast<int>(size));
    std::for_each_n(ids, size,
      [&](vtkIdType id) { connectivity->InsertCellPoint(numbers[static_cast<std::size_t>(id)]); });
    result->GetCellData()->CopyData(mesh->GetCellData(), cells[k], static_cast<vtkIdType>(k));
  }
  result->SetCells(VTK_POLY_VERTEX, connectivity);

  result->GetFieldData()->ShallowCopy(mesh->GetFieldData());
  result->GetFieldData()->RemoveArray("PeriodicPairs"); // its numbers are those of the whole mesh
  vtkNew<vtkDoubleArray> ends;
  ends->SetName("SlabTimes");
  ends->InsertNextValue(first);
  ends->InsertNextValue(last);
  result->GetFieldData()->AddArray(ends);
  return result;
}

} // namespace voxplex::cli
