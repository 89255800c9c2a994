// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Meshes/MeshInput.h"

#include "FileError.h"
#include "LabelTable.h"
#include "Meshes/MeshChecks.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIdTypeArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <array>
#include <type_traits>
#include <utility>

namespace voxplex::io
{
namespace
{

/** Formats that take any cells and any arrays as they are. */
bool TakesAnything(const std::string& name)
{
  const std::string extension = ExtensionOf(name);
  return extension == ".vtu" || extension == ".vtp" || extension == ".vtk" || extension == ".stl";
}

std::string SpaceOf(vtkDataObject* data)
{
  const auto texts = data ? TextsOf(data->GetFieldData(), "SPACE") : std::vector<std::string>();
  return texts.size() == 1 ? texts.front() : "";
}

/** Adds an array without values, as the filters name it. */
template <typename TArray>
void AddArray(vtkDataSetAttributes* attributes, const char* name, int components = 1)
{
  vtkNew<TArray> array;
  array->SetName(name);
  array->SetNumberOfComponents(components);
  attributes->AddArray(array);
}

void AddInterfaceArrays(vtkDataSet* interfaces)
{
  AddArray<vtkIntArray>(interfaces->GetCellData(), "Labels", 2);
  AddArray<vtkIdTypeArray>(interfaces->GetPointData(), "PointIds");
}

void AddMeshArrays(vtkUnstructuredGrid* mesh, bool isSpaceTime)
{
  AddArray<vtkIntArray>(mesh->GetCellData(), "Label");
  if (isSpaceTime)
  {
    AddArray<vtkDoubleArray>(mesh->GetPointData(), "Time");
  }
}

vtkDataArray* RequireArray(vtkDataSetAttributes* attributes, const char* name, int components,
  vtkIdType count, const std::string& what)
{
  return CheckArray(attributes, name, components, count, what,
    "; give the outputs of the meshing filter, or write a .vtu file");
}

void RequireCells(vtkUnstructuredGrid* grid, int type, vtkIdType size, const std::string& what)
{
  CheckCells(grid, type, size, what, "; write a .vtu file");
}

/** VTK's own writers rely on these. */
void RequireCells(vtkPolyData* surface)
{
  const std::array<std::pair<vtkCellArray*, vtkIdType>, 4> kinds{ { { surface->GetVerts(), 1 },
    { surface->GetLines(), 2 }, { surface->GetPolys(), 3 }, { surface->GetStrips(), 3 } } };
  for (const auto& [cells, leastSize] : kinds)
  {
    CheckVertices(cells, surface);
    for (vtkIdType cell = 0; cell < cells->GetNumberOfCells(); ++cell)
    {
      RefuseIf(
        cells->GetCellSize(cell) < leastSize, "it has cells with fewer vertices than they need");
    }
  }
}

/** Arrays of time planes, if the mesh has them. */
void RequireSlabs(vtkUnstructuredGrid* mesh)
{
  if (mesh->GetCellData()->HasArray("Slab"))
  {
    RequireArray(mesh->GetCellData(), "Slab", 1, mesh->GetNumberOfCells(), "the mesh has");
  }
  vtkDataArray* const planes = mesh->GetFieldData()->GetArray("TimePlanes");
  vtkDataArray* const pairs = mesh->GetFieldData()->GetArray("PeriodicPairs");
  RefuseIf((planes && planes->GetNumberOfComponents() != 1) ||
      (pairs && pairs->GetNumberOfComponents() != 2),
    "its arrays 'TimePlanes' or 'PeriodicPairs' are not those of a meshing filter; write a .vtu "
    "file");
  RefuseIf(
    pairs && !ArePoints(pairs, mesh->GetNumberOfPoints()), "its PeriodicPairs are not its points");
}

/** VTK's writers need both, also of what a filter that failed has left. The input itself is not touched. */
template <typename TGrid>
void EnsurePointsAndCells(vtkSmartPointer<TGrid>& grid)
{
  if (!grid || (grid->GetPoints() && grid->GetNumberOfCells() > 0))
  {
    return;
  }
  const auto copy = vtkSmartPointer<TGrid>::New();
  copy->ShallowCopy(grid);
  if (!copy->GetPoints())
  {
    copy->SetPoints(vtkNew<vtkPoints>());
  }
  if constexpr (std::is_same_v<TGrid, vtkUnstructuredGrid>)
  {
    copy->SetCells(VTK_TETRA, vtkNew<vtkCellArray>());
  }
  grid = copy;
}

} // namespace

MeshInput::MeshInput(vtkDataObject* mesh, vtkDataObject* interfaces, int slab, bool compress)
  : Dimension(3)
  , Slab(slab)
  , Compress(compress)
  , Space(SpaceOf(mesh))
  , Mesh(vtkUnstructuredGrid::SafeDownCast(mesh))
  , Triangles(vtkPolyData::SafeDownCast(interfaces))
  , Tetrahedra(vtkUnstructuredGrid::SafeDownCast(interfaces))
{
  const bool hasCells = this->Mesh && this->Mesh->GetNumberOfCells() > 0;
  const bool isSpaceTime = hasCells && this->Mesh->GetCellType(0) == VTK_POLY_VERTEX;
  RefuseIf(hasCells && interfaces && isSpaceTime != (this->Tetrahedra != nullptr),
    "the interfaces are not those of this mesh: one is of three dimensions, and the other of four");
  this->Dimension = isSpaceTime || this->Tetrahedra ? 4 : 3;
  for (const std::string& other : { SpaceOf(interfaces), std::string("unknown") })
  {
    this->Space = this->Space.empty() ? other : this->Space;
  }
  if (!this->Mesh)
  {
    this->Mesh = vtkSmartPointer<vtkUnstructuredGrid>::New();
    AddMeshArrays(this->Mesh, this->Dimension == 4);
  }
  if (this->Dimension == 3 && !this->Triangles)
  {
    this->Triangles = vtkSmartPointer<vtkPolyData>::New();
    AddInterfaceArrays(this->Triangles);
  }
  if (this->Dimension == 4 && !this->Tetrahedra)
  {
    this->Tetrahedra = vtkSmartPointer<vtkUnstructuredGrid>::New();
    AddInterfaceArrays(this->Tetrahedra);
  }
  EnsurePointsAndCells(this->Mesh);
  EnsurePointsAndCells(this->Triangles);
  EnsurePointsAndCells(this->Tetrahedra);
}

void MeshInput::Check(Content content, const std::string& name) const
{
  if (this->Slab >= 0)
  {
    this->CheckSlab(content);
  }
  if (content == Content::Interfaces && this->Dimension == 3)
  {
    RequireCells(this->Triangles);
  }
  if (TakesAnything(name))
  {
    return;
  }
  if (content == Content::Mesh)
  {
    RequireArray(
      this->Mesh->GetCellData(), "Label", 1, this->Mesh->GetNumberOfCells(), "the mesh has");
    if (this->Dimension == 3)
    {
      RequireCells(this->Mesh, VTK_TETRA, 4, "the cells must be tetrahedra in this format");
    }
    else
    {
      RequireCells(this->Mesh, VTK_POLY_VERTEX, 5, "the cells must be pentatopes in this format");
      RequireArray(
        this->Mesh->GetPointData(), "Time", 1, this->Mesh->GetNumberOfPoints(), "the mesh has");
      RequireSlabs(this->Mesh);
    }
    vtkDataSet* interfaces = this->Triangles;
    if (this->Dimension == 4)
    {
      interfaces = this->Tetrahedra;
    }
    RequireArray(interfaces->GetPointData(), "PointIds", 1, interfaces->GetNumberOfPoints(),
      "the interfaces have");
    CheckPointIds(interfaces, this->Mesh->GetNumberOfPoints());
  }
  if (this->Dimension == 3)
  {
    CheckTriangles(
      this->Triangles, "the interfaces must be triangles in this format; write a .vtp file");
    RequireArray(this->Triangles->GetCellData(), "Labels", 2, this->Triangles->GetNumberOfCells(),
      "the interfaces have");
  }
  else
  {
    RequireCells(
      this->Tetrahedra, VTK_TETRA, 4, "the interfaces must be tetrahedra in this format");
    vtkCellData* cellData = this->Tetrahedra->GetCellData();
    const vtkIdType count = this->Tetrahedra->GetNumberOfCells();
    RequireArray(cellData, "Labels", 2, count, "the interfaces have");
    if (cellData->HasArray("Side"))
    {
      RequireArray(cellData, "Side", 1, count, "the interfaces have");
    }
  }
}

/** Before it is written alone. */
void MeshInput::CheckSlab(Content content) const
{
  vtkDataArray* const planes = this->Mesh->GetFieldData()->GetArray("TimePlanes");
  RefuseIf(content != Content::Mesh || !planes || !this->Mesh->GetCellData()->HasArray("Slab") ||
      this->Slab > planes->GetNumberOfTuples(),
    "it has no slab ", this->Slab,
    "; slabs are those of the pentatopes of a mesh with time planes");
  RequireCells(this->Mesh, VTK_POLY_VERTEX, 5, "the cells of slabs must be pentatopes");
  RequireArray(
    this->Mesh->GetPointData(), "Time", 1, this->Mesh->GetNumberOfPoints(), "the mesh has");
  RequireSlabs(this->Mesh);
}

void MeshInput::Write(Content content, const std::string& name, const std::string& path,
  const std::string& companionPath) const
{
  if (this->Dimension == 3)
  {
    WriteFile(MeshData{ this->Mesh, this->Triangles, this->Space, this->Compress }, content, name,
      path, companionPath);
  }
  else
  {
    WriteFile(
      SpaceTimeMeshData{ this->Mesh, this->Tetrahedra, this->Space, this->Slab, this->Compress },
      content, name, path);
  }
}

} // namespace voxplex::io
