// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Private/MeshOutput.h"

#include "Private/OutputArrays.h"

#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkUnstructuredGrid.h"

namespace voxplex
{

namespace
{

/** The interfaces, on a compact copy of the points that they use. */
void MakeInterfaces(const SimplexMesh<3>& mesh, const ImageFrame& frame, bool fitInt,
  vtkPolyData* interfaces, unsigned threads)
{
  const InterfacePoints<3> points(mesh, threads);
  vtkIdTypeArray* const meshIds = points.MeshIds();
  const vtkIdType* const ids = meshIds->GetPointer(0);
  interfaces->SetPoints(MakePoints(static_cast<std::size_t>(meshIds->GetNumberOfValues()), threads,
    [&](std::size_t i) { return frame.ToWorld(mesh.Points[static_cast<std::size_t>(ids[i])]); }));
  interfaces->SetPolys(MakeCells(mesh.Facets, frame.LeftHanded, threads,
    [&points](std::uint32_t id) { return points.Number(id); }));
  interfaces->GetPointData()->AddArray(meshIds);
  interfaces->GetCellData()->AddArray(MakeLabels(mesh.FacetLabels, "Labels", fitInt, threads));
}

} // namespace

void MoveToOutput(SimplexMesh<3>&& mesh, const ImageFrame& frame, vtkUnstructuredGrid* tetrahedra,
  vtkPolyData* interfaces, unsigned threads)
{
  const bool fitInt = FitInt(mesh.Labels);
  MakeInterfaces(mesh, frame, fitInt, interfaces, threads);
  Release(mesh.Facets);
  Release(mesh.FacetLabels);

  tetrahedra->SetPoints(MakePoints(
    mesh.Points.size(), threads, [&](std::size_t i) { return frame.ToWorld(mesh.Points[i]); }));
  Release(mesh.Points);
  tetrahedra->SetCells(VTK_TETRA,
    MakeCells(mesh.Simplices, frame.LeftHanded, threads,
      [](std::uint32_t id) { return static_cast<vtkTypeInt64>(id); }));
  Release(mesh.Simplices);
  tetrahedra->GetCellData()->SetScalars(MakeLabels(mesh.Labels, "Label", fitInt, threads));
  Release(mesh.Labels);
}

} // namespace voxplex
