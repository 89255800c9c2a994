// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Private/MeshOutput.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkDoubleArray.h"
#include "vtkIdTypeArray.h"
#include "vtkIntArray.h"
#include "vtkLongLongArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>
#include <vector>

namespace voxplex
{

namespace
{

/** Releases a vector's memory. */
template <typename T>
void Release(std::vector<T>& v)
{
  std::vector<T>().swap(v);
}

vtkSmartPointer<vtkPoints> MakePoints(const std::vector<Point<3>>& points, const ImageFrame& frame)
{
  vtkNew<vtkDoubleArray> coordinates;
  coordinates->SetNumberOfComponents(3);
  coordinates->SetNumberOfTuples(static_cast<vtkIdType>(points.size()));
  double* out = coordinates->GetPointer(0);
  for (const Point<3>& p : points)
  {
    const Point<3> x = frame.ToWorld(p);
    out = std::copy(x.begin(), x.end(), out);
  }
  auto result = vtkSmartPointer<vtkPoints>::New();
  result->SetData(coordinates);
  return result;
}

/** Cells of N vertices each; `flip` lets the last two change places. */
template <std::size_t N, typename PointId>
vtkSmartPointer<vtkCellArray> MakeCells(
  const std::vector<std::array<std::uint32_t, N>>& cells, bool flip, PointId&& pointId)
{
  vtkNew<vtkTypeInt64Array> connectivity;
  connectivity->SetNumberOfValues(static_cast<vtkIdType>(cells.size()) * static_cast<vtkIdType>(N));
  vtkTypeInt64* out = connectivity->GetPointer(0);
  for (const std::array<std::uint32_t, N>& cell : cells)
  {
    for (std::size_t i = 0; i < N; ++i)
    {
      out[i] = pointId(cell[i]);
    }
    if (flip)
    {
      std::swap(out[N - 2], out[N - 1]);
    }
    out += N;
  }
  auto result = vtkSmartPointer<vtkCellArray>::New();
  result->SetData(static_cast<vtkIdType>(N), connectivity);
  return result;
}

/** Labels of `components` each, as Array. */
template <typename Array, typename Values>
vtkSmartPointer<vtkDataArray> CopyLabels(const Values& values, const char* name)
{
  auto result = vtkSmartPointer<Array>::New();
  result->SetName(name);
  constexpr bool isPair = !std::is_arithmetic_v<typename Values::value_type>;
  result->SetNumberOfComponents(isPair ? 2 : 1);
  result->SetNumberOfTuples(static_cast<vtkIdType>(values.size()));
  auto* out = result->GetPointer(0);
  using Value = typename Array::ValueType;
  for (const auto& value : values)
  {
    if constexpr (isPair)
    {
      *out++ = static_cast<Value>(value[0]);
      *out++ = static_cast<Value>(value[1]);
    }
    else
    {
      *out++ = static_cast<Value>(value);
    }
  }
  return result;
}

template <typename Values>
vtkSmartPointer<vtkDataArray> MakeLabels(const Values& values, const char* name, bool fitInt)
{
  return fitInt ? CopyLabels<vtkIntArray>(values, name)
                : CopyLabels<vtkLongLongArray>(values, name);
}

/** The interfaces, on a compact copy of the points that they use. */
void MakeInterfaces(
  SimplexMesh<3>& mesh, const ImageFrame& frame, bool fitInt, vtkPolyData* interfaces)
{
  constexpr vtkTypeInt64 unused = -1;
  std::vector<vtkTypeInt64> compact(mesh.Points.size(), unused);
  for (const auto& facet : mesh.Facets)
  {
    for (const std::uint32_t id : facet)
    {
      compact[id] = 0;
    }
  }
  // Numbered in the order of the mesh's points, which keeps neighbours near.
  std::vector<Point<3>> points;
  vtkNew<vtkIdTypeArray> pointIds;
  pointIds->SetName("PointIds");
  for (std::size_t id = 0; id < compact.size(); ++id)
  {
    if (compact[id] != unused)
    {
      compact[id] = static_cast<vtkTypeInt64>(points.size());
      points.push_back(mesh.Points[id]);
      pointIds->InsertNextValue(static_cast<vtkIdType>(id));
    }
  }
  interfaces->SetPoints(MakePoints(points, frame));
  interfaces->SetPolys(
    MakeCells(mesh.Facets, frame.LeftHanded, [&compact](std::uint32_t id) { return compact[id]; }));
  interfaces->GetPointData()->AddArray(pointIds);
  interfaces->GetCellData()->AddArray(MakeLabels(mesh.FacetLabels, "Labels", fitInt));
}

} // namespace

void MoveToOutput(SimplexMesh<3>&& mesh, const ImageFrame& frame, vtkUnstructuredGrid* tetrahedra,
  vtkPolyData* interfaces)
{
  const auto largest = std::max_element(mesh.Labels.begin(), mesh.Labels.end());
  const bool fitInt = largest == mesh.Labels.end() || *largest <= std::numeric_limits<int>::max();

  MakeInterfaces(mesh, frame, fitInt, interfaces);
  Release(mesh.Facets);
  Release(mesh.FacetLabels);

  tetrahedra->SetPoints(MakePoints(mesh.Points, frame));
  Release(mesh.Points);
  tetrahedra->SetCells(VTK_TETRA,
    MakeCells(mesh.Simplices, frame.LeftHanded,
      [](std::uint32_t id) { return static_cast<vtkTypeInt64>(id); }));
  Release(mesh.Simplices);
  tetrahedra->GetCellData()->SetScalars(MakeLabels(mesh.Labels, "Label", fitInt));
  Release(mesh.Labels);
}

} // namespace voxplex
