// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Private/PentatopeOutput.h"

#include "Geometry/SimplexQuality.h"
#include "Geometry/SymmetricEigen.h"
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
#include <array>
#include <cmath>
#include <limits>
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

/** A normal of a boundary tetrahedron in the world; its length is proportional to the area. */
Point<4> NormalOf(const SimplexMesh<4>& mesh, const SpaceTimeFrame& frame, std::size_t facet)
{
  std::array<Point<4>, 4> p;
  for (std::size_t k = 0; k < 4; ++k)
  {
    p[k] = frame.ToWorld(mesh.Points[mesh.Facets[facet][k]]);
  }
  return Cross(Subtract(p[1], p[0]), Subtract(p[2], p[0]), Subtract(p[3], p[0]));
}

/**
 * The velocity of a lateral tetrahedron along its normal in space, out of the region of its first
 * label: -n_t / |n_x|, where n is the normal in space-time. NaN if n_x is 0.
 */
double NormalVelocity(const SimplexMesh<4>& mesh, const SpaceTimeFrame& frame, std::size_t facet)
{
  // That of the frame, or its opposite if axes are left-handed.
  const Point<4> normal = NormalOf(mesh, frame, facet);
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

/** A direction is normal to a boundary if this part of its area faces it. Less is curvature. */
constexpr double NormalShare = 0.15;

/** What the lateral tetrahedra around a point say about its velocity. */
struct VelocityEquations
{
  std::array<Point<3>, 3> Matrix{};
  Point<3> Right{};

  /** The tetrahedron stays on the boundary: n_x . v + n_t = 0. */
  void Add(const Point<4>& normal)
  {
    const double length = std::hypot(normal[0], normal[1], normal[2]);
    for (std::size_t a = 0; a < 3 && length > 0.0; ++a)
    {
      for (std::size_t b = 0; b < 3; ++b)
      {
        this->Matrix[a][b] += normal[a] * normal[b] / length;
      }
      this->Right[a] -= normal[a] * normal[3] / length;
    }
  }

  /** Least squares, in the directions that are normal to a boundary. 0 in all others. */
  Point<3> Solve() const
  {
    const SymmetricEigen<3> eigen = EigenOf<3>(this->Matrix);
    const double trace = eigen.Values[0] + eigen.Values[1] + eigen.Values[2];
    Point<3> velocity{};
    for (std::size_t k = 0; k < 3; ++k)
    {
      if (eigen.Values[k] > NormalShare * trace)
      {
        const double part = Dot(eigen.Vectors[k], this->Right) / eigen.Values[k];
        for (std::size_t a = 0; a < 3; ++a)
        {
          velocity[a] += part * eigen.Vectors[k][a];
        }
      }
    }
    return velocity;
  }
};

/** The array BoundaryVelocity of all points of the mesh. */
vtkSmartPointer<vtkDoubleArray> MakeVelocities(
  const SimplexMesh<4>& mesh, const SpaceTimeFrame& frame, unsigned threads)
{
  std::vector<VelocityEquations> equations(mesh.Points.size());
  for (std::size_t f = 0; f < mesh.Facets.size(); ++f)
  {
    if (SideOf(mesh, frame, f) == Side::Lateral)
    {
      const Point<4> normal = NormalOf(mesh, frame, f);
      for (const std::uint32_t id : mesh.Facets[f])
      {
        equations[id].Add(normal);
      }
    }
  }
  auto velocities = vtkSmartPointer<vtkDoubleArray>::New();
  velocities->SetName("BoundaryVelocity");
  velocities->SetNumberOfComponents(3);
  velocities->SetNumberOfTuples(static_cast<vtkIdType>(equations.size()));
  double* const out = velocities->GetPointer(0);
  ParallelFor(0, equations.size(), OutputGrain, threads,
    [&](std::size_t first, std::size_t last)
    {
      for (std::size_t i = first; i < last; ++i)
      {
        const Point<3> velocity = equations[i].Solve();
        std::copy(velocity.begin(), velocity.end(), out + 3 * i);
      }
    });
  return velocities;
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
