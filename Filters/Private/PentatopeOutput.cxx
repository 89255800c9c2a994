// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Private/PentatopeOutput.h"

#include "Geometry/SimplexQuality.h"
#include "Private/OutputArrays.h"

#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkPointData.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include <array>
#include <cmath>
#include <limits>

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

/** Values of the cell array Side. */
enum class Side : unsigned char
{
  Lateral,
  Initial, ///< the flat end at the time of the first frame
  Final
};

/** Whether a boundary tetrahedron lies in a flat end. */
Side SideOf(const SimplexMesh<4>& mesh, const SpaceTimeFrame& frame, std::size_t facet)
{
  if (mesh.FacetLabels[facet][1] != 0)
  {
    return Side::Lateral;
  }
  bool isInitial = true;
  bool isFinal = true;
  for (const std::uint32_t id : mesh.Facets[facet])
  {
    const double time = frame.Time(mesh.Points[id]);
    isInitial &= time == frame.FirstTime;
    isFinal &= time == frame.LastTime;
  }
  return isInitial ? Side::Initial : isFinal ? Side::Final : Side::Lateral;
}

/**
 * The velocity of a lateral tetrahedron along its normal in space, out of the region of its first
 * label: -n_t / |n_x|, where n is the normal in space-time. NaN if n_x is 0.
 */
double NormalVelocity(const SimplexMesh<4>& mesh, const SpaceTimeFrame& frame, std::size_t facet)
{
  std::array<Point<4>, 4> p;
  for (std::size_t k = 0; k < 4; ++k)
  {
    p[k] = frame.ToWorld(mesh.Points[mesh.Facets[facet][k]]);
  }
  // That of the frame, or its opposite if axes are left-handed.
  const Point<4> normal =
    Cross(Subtract(p[1], p[0]), Subtract(p[2], p[0]), Subtract(p[3], p[0]));
  const double sign = frame.Space.LeftHanded ? -1.0 : 1.0;
  const double length = std::hypot(normal[0], normal[1], normal[2]);
  return length > 0.0 ? -sign * normal[3] / length : std::numeric_limits<double>::quiet_NaN();
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
        const Side one = SideOf(mesh, frame, f);
        side[f] = static_cast<unsigned char>(one);
        velocity[f] = one == Side::Lateral ? NormalVelocity(mesh, frame, f) : 0.0;
      }
    });
  boundary->GetCellData()->AddArray(sides);
  boundary->GetCellData()->AddArray(velocities);
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
  AddSides(mesh, frame, boundary, threads);
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
