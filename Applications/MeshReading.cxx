// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "MeshReading.h"

#include "Errors.h"
#include "FileError.h"
#include "ImageReading/VTKFileStructure.h"
#include "ImageReading/VTKMessages.h"
#include "Interruption.h"
#include "Meshes/MeshChecks.h"
#include "Text.h"

#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSimplexMeshInterfaces.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <filesystem>
#include <new>

namespace voxplex::cli
{
namespace
{

bool HasPentatopes(vtkUnstructuredGrid* mesh)
{
  return mesh->GetNumberOfCells() > 0 && mesh->GetCellType(0) == VTK_POLY_VERTEX;
}

/** @param extension of the file @param kind what VTK calls its content */
template <typename TReader, typename TData>
vtkSmartPointer<TData> Read(
  const std::string& path, const std::string& extension, const std::string& kind)
{
  namespace fs = std::filesystem;
  std::error_code ignored;
  io::RefuseIf(!fs::exists(path, ignored), "there is no such file");
  io::RefuseIf(io::LowerCase(fs::path(path).extension().string()) != extension, "it is not a ",
    extension, " file");
  io::CheckStructureOfMesh(io::InputFile(path), kind);
  const io::VTKMessages messages;
  vtkNew<io::WithRoomForTexts<TReader>> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  messages.CheckErrors();
  return reader->GetOutput();
}

/** Elements, labels, points and times are looked at later. */
void CheckMesh(vtkUnstructuredGrid* mesh)
{
  const bool isSpaceTime = HasPentatopes(mesh);
  io::CheckCells(mesh, isSpaceTime ? VTK_POLY_VERTEX : VTK_TETRA, isSpaceTime ? 5 : 4,
    isSpaceTime ? "its first cell is a pentatope (VTK_POLY_VERTEX of five points), so all must be"
                : "its cells must be tetrahedra, or pentatopes (VTK_POLY_VERTEX of five points)",
    "");
  io::CheckArray(mesh->GetCellData(), "Label", 1, mesh->GetNumberOfCells(), "its cells have",
    "; it holds the label of each cell");
  if (isSpaceTime)
  {
    io::CheckArray(mesh->GetPointData(), "Time", 1, mesh->GetNumberOfPoints(), "its points have",
      "; it holds the time of each point");
  }
}

/** Turns inverted elements round, leaves unused points out, and makes the interfaces. */
void PutRight(MeshWithInterfaces& mesh)
{
  vtkNew<vtkSimplexMeshInterfaces> filter;
  filter->SetInputData(mesh.Mesh);
  filter->Update();
  io::RefuseIf(!filter->GetErrorMessage().empty(), filter->GetErrorMessage());
  mesh.Mesh = filter->GetOutput();
  mesh.Interfaces = filter->GetOutputDataObject(HasPentatopes(mesh.Mesh) ? 2 : 1);
  mesh.IsChanged = filter->GetChanged();
  if (const auto count = filter->GetNumberOfTurnedElements(); count > 0)
  {
    mesh.Warning = std::to_string(count) + " of " + std::to_string(mesh.Mesh->GetNumberOfCells()) +
      " elements are inverted: they are turned round";
  }
}

bool IsVTU(const std::string& path)
{
  return io::LowerCase(std::filesystem::path(path).extension().string()) == ".vtu";
}

vtkSmartPointer<vtkDataSet> ReadInterfaces(
  const std::string& path, std::optional<bool> isOfSpaceTime)
{
  if (!isOfSpaceTime.value_or(false) && !IsVTU(path))
  {
    const auto surface = Read<vtkXMLPolyDataReader, vtkPolyData>(path, ".vtp", "PolyData");
    io::CheckTriangles(surface, "interfaces of tetrahedra are triangles, and it has other cells");
    return surface;
  }
  const auto cells =
    Read<vtkXMLUnstructuredGridReader, vtkUnstructuredGrid>(path, ".vtu", "UnstructuredGrid");
  if (isOfSpaceTime.value_or(cells->GetNumberOfCells() > 0 && cells->GetCellType(0) == VTK_TETRA))
  {
    io::CheckCells(cells, VTK_TETRA, 4, "interfaces of pentatopes are tetrahedra", "");
    return cells;
  }
  io::CheckCells(cells, VTK_TRIANGLE, 3, "interfaces of tetrahedra are triangles", "");
  const auto surface = vtkSmartPointer<vtkPolyData>::New();
  surface->SetPoints(cells->GetPoints());
  surface->SetPolys(cells->GetCells());
  surface->GetPointData()->ShallowCopy(cells->GetPointData());
  surface->GetCellData()->ShallowCopy(cells->GetCellData());
  surface->SetFieldData(cells->GetFieldData());
  return surface;
}

void CheckArraysOfInterfaces(vtkDataSet* interfaces, vtkIdType numberOfPoints)
{
  io::CheckArray(interfaces->GetCellData(), "Labels", 2, interfaces->GetNumberOfCells(),
    "its cells have", "; it holds the labels of both sides");
  io::CheckArray(interfaces->GetPointData(), "PointIds", 1, interfaces->GetNumberOfPoints(),
    "its points have", "; it holds their numbers in the mesh");
  io::CheckPointIds(interfaces, numberOfPoints);
}

/** Calls read(), and says which file it was if that fails. */
template <typename TFunction>
void Named(const std::string& path, TFunction&& read)
{
  const std::string begin = "cannot read '" + path + "': ";
  const Interruption::CrashReport report(
    "voxplex: " + begin + "its reading ended with a crash: it is damaged, or made to do harm\n");
  try
  {
    read();
  }
  catch (const std::bad_alloc&)
  {
    throw io::FileError(begin + "it does not fit into memory");
  }
  catch (const io::FileError& error)
  {
    throw io::FileError(begin + error.what());
  }
}

} // namespace

int MeshWithInterfaces::Dimension() const
{
  return HasPentatopes(this->Mesh) ? 4 : 3;
}

MeshWithInterfaces ReadMeshFiles(const std::string& mesh, const std::string& interfaces)
{
  MeshWithInterfaces result;
  vtkIdType numberOfPoints = 0;
  if (!mesh.empty())
  {
    Named(mesh,
      [&]
      {
        result.Mesh =
          Read<vtkXMLUnstructuredGridReader, vtkUnstructuredGrid>(mesh, ".vtu", "UnstructuredGrid");
        CheckMesh(result.Mesh);
        numberOfPoints = result.Mesh->GetNumberOfPoints();
        PutRight(result);
      });
  }
  if (!interfaces.empty())
  {
    Named(interfaces,
      [&]
      {
        const auto cells = ReadInterfaces(
          interfaces, result.Mesh ? std::optional<bool>(HasPentatopes(result.Mesh)) : std::nullopt);
        if (result.Mesh)
        {
          CheckArraysOfInterfaces(cells, numberOfPoints);
        }
        if (!result.IsChanged)
        {
          result.Interfaces = cells;
        }
      });
  }
  return result;
}

} // namespace voxplex::cli
