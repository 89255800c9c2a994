// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Private/PentatopeOutput.h"

#include "Private/OutputArrays.h"

#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkPointData.h"
#include "vtkUnstructuredGrid.h"

namespace voxplex
{

namespace
{

/** n points of the frame, the i-th of which is point(i), and the array Time. */
template <typename PointAt>
void SetPoints(vtkUnstructuredGrid* grid, std::size_t n, const SpaceTimeFrame& frame,
  unsigned threads, PointAt&& point)
{
  grid->SetPoints(MakePoints(n, threads, [&](std::size_t i) { return frame.Position(point(i)); }));
  vtkNew<vtkDoubleArray> times;
  times->SetName("Time");
  times->SetNumberOfValues(static_cast<vtkIdType>(n));
  double* const out = times->GetPointer(0);
  ParallelFor(0, n, OutputGrain, threads,
    [&](std::size_t first, std::size_t last)
    {
      for (std::size_t i = first; i < last; ++i)
      {
        out[i] = frame.Time(point(i));
      }
    });
  grid->GetPointData()->AddArray(times);
}

/** The boundary tetrahedra, on a compact copy of the points that they use. */
void MakeBoundary(const SimplexMesh<4>& mesh, const SpaceTimeFrame& frame, bool fitInt,
  vtkUnstructuredGrid* boundary, unsigned threads)
{
  const InterfacePoints<4> points(mesh, threads);
  vtkIdTypeArray* const meshIds = points.MeshIds();
  const vtkIdType* const ids = meshIds->GetPointer(0);
  SetPoints(boundary, static_cast<std::size_t>(meshIds->GetNumberOfValues()), frame, threads,
    [&](std::size_t i) -> const Point<4>&
    { return mesh.Points[static_cast<std::size_t>(ids[i])]; });
  boundary->SetCells(VTK_TETRA,
    MakeCells(mesh.Facets, frame.Space.LeftHanded, threads,
      [&points](std::uint32_t id) { return points.Number(id); }));
  boundary->GetPointData()->AddArray(meshIds);
  boundary->GetCellData()->AddArray(MakeLabels(mesh.FacetLabels, "Labels", fitInt, threads));
}

} // namespace

void MoveToOutput(SimplexMesh<4>&& mesh, const SpaceTimeFrame& frame,
  vtkUnstructuredGrid* pentatopes, vtkUnstructuredGrid* boundary, unsigned threads)
{
  const bool fitInt = FitInt(mesh.Labels);
  MakeBoundary(mesh, frame, fitInt, boundary, threads);
  Release(mesh.Facets);
  Release(mesh.FacetLabels);

  SetPoints(pentatopes, mesh.Points.size(), frame, threads,
    [&mesh](std::size_t i) -> const Point<4>& { return mesh.Points[i]; });
  Release(mesh.Points);
  pentatopes->SetCells(VTK_POLY_VERTEX,
    MakeCells(mesh.Simplices, frame.Space.LeftHanded, threads,
      [](std::uint32_t id) { return static_cast<vtkTypeInt64>(id); }));
  Release(mesh.Simplices);
  pentatopes->GetCellData()->SetScalars(MakeLabels(mesh.Labels, "Label", fitInt, threads));
  Release(mesh.Labels);
}

} // namespace voxplex
