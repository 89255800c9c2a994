// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Private/MeshOutput.h"

#include "Mesh/BoundaryMotion.h"
#include "Private/OutputArrays.h"

#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkFieldData.h"
#include "vtkIntArray.h"
#include "vtkPointData.h"
#include "vtkSmartPointer.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <vector>

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

/** The arrays Side and NormalVelocity. */
void AddSides(const SimplexMesh<4>& mesh, const SpaceTimeFrame& frame,
  vtkUnstructuredGrid* boundary, unsigned threads)
{
  const std::size_t n = mesh.Facets.size();
  vtkNew<vtkUnsignedCharArray> sides;
  sides->SetName("Side");
  sides->SetNumberOfValues(static_cast<vtkIdType>(n));
  vtkNew<vtkDoubleArray> velocities;
  velocities->SetName("NormalVelocity");
  velocities->SetNumberOfValues(static_cast<vtkIdType>(n));
  unsigned char* const side = sides->GetPointer(0);
  double* const velocity = velocities->GetPointer(0);
  ParallelFor(0, n, OutputGrain, threads,
    [&](std::size_t first, std::size_t last)
    {
      for (std::size_t f = first; f < last; ++f)
      {
        const BoundarySide one = SideOf(mesh, frame, f);
        side[f] = static_cast<unsigned char>(one);
        velocity[f] = one == BoundarySide::Lateral ? NormalVelocity(mesh, frame, f) : 0.0;
      }
    });
  boundary->GetCellData()->AddArray(sides);
  boundary->GetCellData()->AddArray(velocities);
}

/** The array BoundaryVelocity of all points of the mesh. */
vtkSmartPointer<vtkDoubleArray> MakeVelocities(
  const SimplexMesh<4>& mesh, const SpaceTimeFrame& frame, unsigned threads)
{
  const std::vector<Point<3>> velocities = BoundaryVelocities(mesh, frame, threads);
  auto array = vtkSmartPointer<vtkDoubleArray>::New();
  array->SetName("BoundaryVelocity");
  array->SetNumberOfComponents(3);
  array->SetNumberOfTuples(static_cast<vtkIdType>(velocities.size()));
  for (std::size_t i = 0; i < velocities.size(); ++i)
  {
    array->SetTypedTuple(static_cast<vtkIdType>(i), velocities[i].data());
  }
  return array;
}

/** The boundary tetrahedra, on a compact copy of the points that they use. */
void MakeBoundary(const SimplexMesh<4>& mesh, const SpaceTimeFrame& frame, bool fitInt,
  vtkDoubleArray* velocities, vtkUnstructuredGrid* boundary, unsigned threads)
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
  vtkNew<vtkDoubleArray> own;
  own->SetName(velocities->GetName());
  own->SetNumberOfComponents(3);
  own->SetNumberOfTuples(meshIds->GetNumberOfValues());
  for (vtkIdType i = 0; i < meshIds->GetNumberOfValues(); ++i)
  {
    own->SetTuple(i, ids[i], velocities);
  }
  boundary->GetPointData()->AddArray(own);
  boundary->GetCellData()->AddArray(MakeLabels(mesh.FacetLabels, "Labels", fitInt, threads));
  AddSides(mesh, frame, boundary, threads);
}

/** The arrays Slab and TimePlanes, and PeriodicPairs of a periodic mesh. */
void AddSlabs(const SimplexMesh<4>& mesh, const SpaceTimeFrame& frame,
  const std::vector<double>& planes, vtkUnstructuredGrid* pentatopes)
{
  vtkFieldData* const fieldData = pentatopes->GetFieldData();
  fieldData->RemoveArray("TimePlanes"); // of an input that is a mesh' field data
  fieldData->RemoveArray("PeriodicPairs");
  if (mesh.Slabs.empty())
  {
    return;
  }
  vtkNew<vtkIntArray> slabs;
  slabs->SetName("Slab");
  slabs->SetNumberOfValues(static_cast<vtkIdType>(mesh.Slabs.size()));
  std::copy(mesh.Slabs.begin(), mesh.Slabs.end(), slabs->GetPointer(0));
  pentatopes->GetCellData()->AddArray(slabs);
  vtkNew<vtkDoubleArray> times;
  times->SetName("TimePlanes");
  for (const double time : planes)
  {
    times->InsertNextValue(frame.Time({ 0.0, 0.0, 0.0, time }));
  }
  fieldData->AddArray(times);
  if (!mesh.Twins.empty())
  {
    vtkNew<vtkIdTypeArray> pairs;
    pairs->SetName("PeriodicPairs");
    pairs->SetNumberOfComponents(2);
    pairs->SetNumberOfTuples(static_cast<vtkIdType>(mesh.Twins.size()));
    for (std::size_t k = 0; k < mesh.Twins.size(); ++k)
    {
      pairs->SetTypedComponent(static_cast<vtkIdType>(k), 0, mesh.Twins[k][0]);
      pairs->SetTypedComponent(static_cast<vtkIdType>(k), 1, mesh.Twins[k][1]);
    }
    fieldData->AddArray(pairs);
  }
}

} // namespace

void MoveToOutput(SimplexMesh<4>&& mesh, const SpaceTimeFrame& frame,
  const std::vector<double>& planes, vtkUnstructuredGrid* pentatopes, vtkUnstructuredGrid* boundary,
  unsigned threads)
{
  const bool fitInt = FitInt(mesh.Labels);
  const auto velocities = MakeVelocities(mesh, frame, threads);
  MakeBoundary(mesh, frame, fitInt, velocities, boundary, threads);
  Release(mesh.Facets);
  Release(mesh.FacetLabels);

  SetPoints(pentatopes, mesh.Points.size(), frame, threads,
    [&mesh](std::size_t i) -> const Point<4>& { return mesh.Points[i]; });
  pentatopes->GetPointData()->AddArray(velocities);
  Release(mesh.Points);
  pentatopes->SetCells(VTK_POLY_VERTEX,
    MakeCells(mesh.Simplices, frame.Space.LeftHanded, threads,
      [](std::uint32_t id) { return static_cast<vtkTypeInt64>(id); }));
  Release(mesh.Simplices);
  pentatopes->GetCellData()->SetScalars(MakeLabels(mesh.Labels, "Label", fitInt, threads));
  Release(mesh.Labels);
  AddSlabs(mesh, frame, planes, pentatopes);
}

} // namespace voxplex
