// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FuzzMesh.cxx
 * @brief vtkSimplexMeshWriter on grids as a damaged file may leave them: any cells, any arrays, any ids.
 */
#include "Fuzzing.h"

#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkIdTypeArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSimplexMeshWriter.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>

#include <array>
#include <limits>
#include <vector>

namespace fuzz = voxplex::fuzz;

namespace
{

/** Takes the input byte by byte; zeros follow it. */
class Bytes
{
public:
  Bytes(const std::uint8_t* data, std::size_t size)
    : Next(data)
    , End(data + size)
  {
  }
  int Take(int count) { return (this->Next == this->End ? 0 : *this->Next++) % count; }

private:
  const std::uint8_t* Next;
  const std::uint8_t* End;
};

/** Small numbers, and those at which conversions fail. */
double TakeNumber(Bytes& bytes)
{
  constexpr std::array hostile{ std::numeric_limits<double>::quiet_NaN(),
    std::numeric_limits<double>::infinity(), -1.0, 1e300, -1e300, 9.3e18, 4294967296.0, 0.5 };
  const auto number = static_cast<std::size_t>(bytes.Take(64));
  return number < hostile.size() ? hostile[number] : static_cast<double>(number - hostile.size());
}

vtkIdType TakeId(Bytes& bytes)
{
  constexpr std::array<vtkIdType, 3> hostile{ -1, 1000, std::numeric_limits<vtkIdType>::max() };
  const auto number = static_cast<std::size_t>(bytes.Take(256));
  return number < hostile.size() ? hostile[number] : static_cast<vtkIdType>(number % 6);
}

/** An array that may be missing, of another type, or of another length than it should have. */
void AddArray(Bytes& bytes, vtkDataSetAttributes* attributes, const char* name, int components,
  vtkIdType tuples)
{
  const int type = bytes.Take(16);
  if (type == 0)
  {
    return;
  }
  vtkSmartPointer<vtkDataArray> array;
  if (type < 3)
  {
    array = vtkSmartPointer<vtkDoubleArray>::New();
  }
  else if (type < 6)
  {
    array = vtkSmartPointer<vtkIdTypeArray>::New();
  }
  else
  {
    array = vtkSmartPointer<vtkIntArray>::New();
  }
  array->SetName(name);
  array->SetNumberOfComponents(bytes.Take(32) == 1 ? 3 : components);
  array->SetNumberOfTuples(bytes.Take(32) == 1 ? tuples / 2 : tuples);
  for (vtkIdType i = 0; i < array->GetNumberOfValues(); ++i)
  {
    const double value = type < 3 ? TakeNumber(bytes) : static_cast<double>(bytes.Take(6));
    array->SetComponent(i / array->GetNumberOfComponents(),
      static_cast<int>(i % array->GetNumberOfComponents()), value);
  }
  attributes->AddArray(array);
}

vtkSmartPointer<vtkPoints> TakePoints(Bytes& bytes)
{
  const auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetDataTypeToDouble();
  const int count = bytes.Take(8);
  for (int i = 0; i < count; ++i)
  {
    points->InsertNextPoint(TakeNumber(bytes), TakeNumber(bytes), TakeNumber(bytes));
  }
  return points;
}

std::vector<vtkIdType> TakeCell(Bytes& bytes, int size)
{
  std::vector<vtkIdType> ids(static_cast<std::size_t>(bytes.Take(32) == 1 ? size - 1 : size));
  for (vtkIdType& id : ids)
  {
    id = TakeId(bytes);
  }
  return ids;
}

vtkSmartPointer<vtkUnstructuredGrid> TakeGrid(Bytes& bytes, int type, int size)
{
  const auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  if (bytes.Take(32) != 1)
  {
    grid->SetPoints(TakePoints(bytes));
  }
  grid->AllocateEstimate(4, size);
  const int count = bytes.Take(4);
  for (int i = 0; i < count; ++i)
  {
    const std::vector<vtkIdType> ids = TakeCell(bytes, size);
    grid->InsertNextCell(
      bytes.Take(32) == 1 ? VTK_VERTEX : type, static_cast<vtkIdType>(ids.size()), ids.data());
  }
  return grid;
}

vtkSmartPointer<vtkPolyData> TakeTriangles(Bytes& bytes)
{
  const auto surface = vtkSmartPointer<vtkPolyData>::New();
  if (bytes.Take(32) != 1)
  {
    surface->SetPoints(TakePoints(bytes));
  }
  vtkNew<vtkCellArray> polygons;
  const int count = bytes.Take(4);
  for (int i = 0; i < count; ++i)
  {
    const std::vector<vtkIdType> ids = TakeCell(bytes, 3);
    polygons->InsertNextCell(static_cast<vtkIdType>(ids.size()), ids.data());
  }
  surface->SetPolys(polygons);
  return surface;
}

} // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***)
{
  vtkObject::GlobalWarningDisplayOff();
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  constexpr std::array names{ "m.vtu", "m.vtk", "m.vtp", "m.mesh", "m.mfem", "m.msh", "m.inp",
    "m.feb", "m.xdmf", "m.ply", "m.stl" };
  Bytes bytes(data, size);
  const std::string path =
    fuzz::PathOf(names[static_cast<std::size_t>(bytes.Take(int{ names.size() }))]);
  const int content = bytes.Take(2);
  const bool isSpaceTime = bytes.Take(2) == 1;
  const auto mesh =
    isSpaceTime ? TakeGrid(bytes, VTK_POLY_VERTEX, 5) : TakeGrid(bytes, VTK_TETRA, 4);
  AddArray(bytes, mesh->GetCellData(), "Label", 1, mesh->GetNumberOfCells());
  AddArray(bytes, mesh->GetPointData(), "Time", 1, mesh->GetNumberOfPoints());
  vtkSmartPointer<vtkPointSet> interfaces;
  if (isSpaceTime)
  {
    interfaces = TakeGrid(bytes, VTK_TETRA, 4);
  }
  else
  {
    interfaces = TakeTriangles(bytes);
  }
  AddArray(bytes, interfaces->GetCellData(), "Labels", 2, interfaces->GetNumberOfCells());
  AddArray(bytes, interfaces->GetPointData(), "PointIds", 1, interfaces->GetNumberOfPoints());

  vtkNew<vtkSimplexMeshWriter> writer;
  writer->SetInputData(0, mesh);
  if (bytes.Take(8) != 1)
  {
    writer->SetInputData(1, interfaces);
  }
  writer->SetContent(content);
  writer->SetFileName(path.c_str());
  if (!writer->Write())
  {
    fuzz::CheckRefusal(writer->GetErrorMessage(), path);
  }
  return 0;
}
