// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "TimeSlabs.h"

#include "LabelPairs.h"

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
#include <set>

namespace voxplex::io
{
namespace
{

using Facet = std::array<vtkIdType, 4>;

constexpr int NoPlane = 0;

Facet Sorted(Facet facet)
{
  std::sort(facet.begin(), facet.end());
  return facet;
}

/** The number of the plane that each point is on, or NoPlane. */
std::vector<int> PlanesOfPoints(vtkUnstructuredGrid* pentatopes)
{
  const std::vector<double> planes = TimePlanesOf(pentatopes);
  vtkDataArray* const times = RequireArray(pentatopes->GetPointData(), "Time");
  std::vector<int> result(static_cast<std::size_t>(pentatopes->GetNumberOfPoints()), NoPlane);
  for (std::size_t i = 0; i < result.size(); ++i)
  {
    const double time = times->GetComponent(static_cast<vtkIdType>(i), 0);
    const auto plane = std::lower_bound(planes.begin(), planes.end(), time);
    if (plane != planes.end() && *plane == time)
    {
      result[i] = static_cast<int>(plane - planes.begin()) + 1;
    }
  }
  return result;
}

} // namespace

std::vector<double> TimePlanesOf(vtkUnstructuredGrid* pentatopes)
{
  std::vector<double> times;
  vtkDataArray* const planes = pentatopes->GetFieldData()->GetArray("TimePlanes");
  if (planes && pentatopes->GetCellData()->GetArray("Slab"))
  {
    for (vtkIdType plane = 0; plane < planes->GetNumberOfTuples(); ++plane)
    {
      times.push_back(planes->GetComponent(plane, 0));
    }
  }
  return times;
}

std::vector<PlaneFacet> FindPlaneFacets(
  vtkUnstructuredGrid* pentatopes, std::span<const Facet> others)
{
  if (TimePlanesOf(pentatopes).empty())
  {
    return {};
  }
  const std::vector<int> planeOf = PlanesOfPoints(pentatopes);
  const auto planeOfFacet = [&planeOf](const Facet& facet)
  {
    const int plane = planeOf[static_cast<std::size_t>(facet[0])];
    const bool isFlat = std::all_of(facet.begin(), facet.end(),
      [&](vtkIdType id) { return planeOf[static_cast<std::size_t>(id)] == plane; });
    return isFlat ? plane : NoPlane;
  };
  std::set<Facet> known; // a facet inside of a label has a pentatope on both sides
  for (const Facet& facet : others)
  {
    if (planeOfFacet(facet) != NoPlane)
    {
      known.insert(Sorted(facet));
    }
  }
  vtkDataArray* const labels = RequireArray(pentatopes->GetCellData(), "Label");
  std::vector<PlaneFacet> facets;
  for (vtkIdType cell = 0; cell < pentatopes->GetNumberOfCells(); ++cell)
  {
    vtkIdType size = 0;
    const vtkIdType* ids = nullptr;
    pentatopes->GetCellPoints(cell, size, ids);
    for (vtkIdType apex = 0; apex < size; ++apex)
    {
      Facet facet;
      std::copy(ids + apex + 1, ids + size, std::copy_n(ids, apex, facet.begin()));
      const int plane = planeOfFacet(facet);
      if (plane != NoPlane && known.insert(Sorted(facet)).second)
      {
        facets.push_back({ facet, plane, LabelAt(labels, cell) });
      }
    }
  }
  return facets;
}

//------------------------------------------------------------------------------------------------
vtkSmartPointer<vtkUnstructuredGrid> ExtractSlab(vtkUnstructuredGrid* mesh, int slab)
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

} // namespace voxplex::io
