// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "MeshInput.h"

#include "FileError.h"
#include "LabelTable.h"

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
#include <vtkVersion.h>

#include <algorithm>
#include <array>
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

/** An array with one value for each cell or point; there are `count` of them. */
vtkDataArray* RequireArray(vtkDataSetAttributes* attributes, const char* name, int components,
  vtkIdType count, const std::string& what)
{
  vtkDataArray* array = attributes->GetArray(name);
  RefuseIf(!array || array->GetNumberOfComponents() != components, what, " no array '", name,
    "' of ", components, (components == 1 ? " component" : " components"),
    "; give the outputs of the meshing filter, or write a .vtu file");
  RefuseIf(array->GetNumberOfTuples() != count, what, " ", array->GetNumberOfTuples(), " values '",
    name, "' for ", count, " cells or points");
  return array;
}

/** Offsets and ids that a damaged file may have left anyhow. */
void RequireVertices(vtkCellArray* cells, vtkPointSet* owner)
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

/** The type of each cell. */
vtkDataArray* TypesOf(vtkUnstructuredGrid* grid)
{
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 6, 0)
  return grid->GetCellTypes();
#else
  return grid->GetCellTypesArray();
#endif
}

void RequireCells(vtkUnstructuredGrid* grid, int type, vtkIdType size, const std::string& what)
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
      ", and cell ", cell, " is none; write a .vtu file");
  }
  RequireVertices(grid->GetCells(), grid);
}

void RequireTriangles(vtkPolyData* surface)
{
  vtkCellArray* polygons = surface->GetPolys();
  const bool isOther = surface->GetNumberOfCells() != polygons->GetNumberOfCells();
  RefuseIf(isOther || (polygons->GetNumberOfCells() > 0 && polygons->IsHomogeneous() != 3),
    "the interfaces must be triangles in this format; write a .vtp file");
  RequireVertices(polygons, surface);
}

/** VTK's own writers rely on these. */
void RequireCells(vtkPolyData* surface)
{
  const std::array<std::pair<vtkCellArray*, vtkIdType>, 4> kinds{ { { surface->GetVerts(), 1 },
    { surface->GetLines(), 2 }, { surface->GetPolys(), 3 }, { surface->GetStrips(), 3 } } };
  for (const auto& [cells, leastSize] : kinds)
  {
    RequireVertices(cells, surface);
    for (vtkIdType cell = 0; cell < cells->GetNumberOfCells(); ++cell)
    {
      RefuseIf(
        cells->GetCellSize(cell) < leastSize, "it has cells with fewer vertices than they need");
    }
  }
}

/** Whether all numbers, which may be none, are ids of the mesh's points. */
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

void RequirePointIds(vtkDataSet* interfaces, vtkIdType numberOfPoints)
{
  vtkDataArray* ids = RequireArray(interfaces->GetPointData(), "PointIds", 1,
    interfaces->GetNumberOfPoints(), "the interfaces have");
  RefuseIf(!ArePoints(ids, numberOfPoints),
    "the interfaces are not those of this mesh: their PointIds are not its points");
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

/** The input itself is not touched. */
template <typename TGrid>
void EnsurePoints(vtkSmartPointer<TGrid>& grid)
{
  if (grid && !grid->GetPoints())
  {
    const auto copy = vtkSmartPointer<TGrid>::New();
    copy->ShallowCopy(grid);
    copy->SetPoints(vtkNew<vtkPoints>());
    grid = copy;
  }
}

} // namespace

MeshInput::MeshInput(vtkDataObject* mesh, vtkDataObject* interfaces, int slab)
  : Dimension(3)
  , Slab(slab)
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
  EnsurePoints(this->Mesh);
  EnsurePoints(this->Triangles);
  EnsurePoints(this->Tetrahedra);
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
    RequirePointIds(interfaces, this->Mesh->GetNumberOfPoints());
  }
  if (this->Dimension == 3)
  {
    RequireTriangles(this->Triangles);
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
    WriteFile(
      MeshData{ this->Mesh, this->Triangles, this->Space }, content, name, path, companionPath);
  }
  else
  {
    WriteFile(SpaceTimeMeshData{ this->Mesh, this->Tetrahedra, this->Space, this->Slab }, content,
      name, path);
  }
}

} // namespace voxplex::io
