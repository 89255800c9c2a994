// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Private/LabelledMesh.h"

#include "Base/Error.h"
#include "Image/LabelValue.h"

#include "vtkCell.h"
#include "vtkCellArray.h"
#include "vtkCellType.h"
#include "vtkDataArray.h"
#include "vtkGenericCell.h"
#include "vtkPointData.h"
#include "vtkSmartPointer.h"
#include "vtkUnstructuredGrid.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <sstream>
#include <string>

namespace voxplex
{

namespace
{

/** The label of an element. */
std::int64_t LabelOf(vtkDataArray* labels, vtkIdType cell)
{
  const double value = NearestLabel(labels->GetComponent(cell, 0));
  if (!(value >= 1.0 && value <= 9007199254740992.0 && value == std::floor(value)))
  {
    vtkIdType count = 1;
    for (vtkIdType other = cell + 1; other < labels->GetNumberOfTuples(); ++other)
    {
      const double one = NearestLabel(labels->GetComponent(other, 0));
      count += one == value || (std::isnan(one) && std::isnan(value)) ? 1 : 0;
    }
    std::ostringstream text;
    text << "Cells of the mesh with the label " << value << ": " << count << ", the first is cell "
         << cell << ". Labels are whole numbers above 0.";
    throw InputError(text.str());
  }
  return static_cast<std::int64_t>(value);
}

vtkDataArray* LabelsOf(vtkUnstructuredGrid* grid, vtkAbstractArray* chosen)
{
  vtkDataArray* const labels = vtkDataArray::SafeDownCast(chosen);
  if (labels == nullptr)
  {
    throw InputError(
      "The mesh has no numeric cell array of labels; it is 'Label' unless another is chosen "
      "with SetInputArrayToProcess().");
  }
  if (labels->GetNumberOfComponents() != 1 ||
    labels->GetNumberOfTuples() != grid->GetNumberOfCells())
  {
    throw InputError(
      "The mesh's array of labels must have one component, and one value for each cell.");
  }
  return labels;
}

vtkDataArray* TimesOf(vtkUnstructuredGrid* grid)
{
  vtkDataArray* const times = grid->GetPointData()->GetArray("Time");
  if (times == nullptr || times->GetNumberOfComponents() != 1)
  {
    throw InputError("The mesh has pentatopes, but no point array 'Time' of one component, which "
                     "holds the time of each point.");
  }
  return times;
}

void CheckFinite(bool isFinite, std::size_t point)
{
  if (!isFinite)
  {
    throw InputError("Point " + std::to_string(point) + " of the mesh is not finite.");
  }
}

Point<3> PointOf(vtkUnstructuredGrid* grid, std::size_t i)
{
  Point<3> world;
  grid->GetPoint(static_cast<vtkIdType>(i), world.data());
  CheckFinite(std::isfinite(world[0]) && std::isfinite(world[1]) && std::isfinite(world[2]), i);
  return world;
}

/** @param type VTK_TETRA, or VTK_POLY_VERTEX for pentatopes */
template <int D>
void ReadCells(vtkUnstructuredGrid* grid, vtkAbstractArray* chosen, int type, SimplexMesh<D>& mesh)
{
  vtkDataArray* const labels = LabelsOf(grid, chosen);
  const vtkIdType cells = grid->GetNumberOfCells();
  mesh.Simplices.resize(static_cast<std::size_t>(cells));
  mesh.Labels.resize(static_cast<std::size_t>(cells));
  for (vtkIdType c = 0; c < cells; ++c)
  {
    vtkIdType size = 0;
    const vtkIdType* ids = nullptr;
    grid->GetCells()->GetCellAtId(c, size, ids);
    if (grid->GetCellType(c) != type || size != D + 1)
    {
      throw InputError("Cell " + std::to_string(c) + " of the mesh is a " + CellText(grid, c) +
        "; only tetrahedra (VTK_TETRA), or only pentatopes (VTK_POLY_VERTEX of five "
        "points), can be measured.");
    }
    auto& simplex = mesh.Simplices[static_cast<std::size_t>(c)];
    for (std::size_t i = 0; i < simplex.size(); ++i)
    {
      simplex[i] = static_cast<std::uint32_t>(ids[i]);
    }
    mesh.Labels[static_cast<std::size_t>(c)] = LabelOf(labels, c);
  }
}

} // namespace

//----------------------------------------------------------------------------------------------------
bool HasPentatopes(vtkUnstructuredGrid* grid)
{
  return grid->GetNumberOfCells() > 0 && grid->GetCellType(0) == VTK_POLY_VERTEX;
}

std::string CellText(vtkUnstructuredGrid* grid, vtkIdType cell)
{
  const auto one =
    vtkSmartPointer<vtkCell>::Take(vtkGenericCell::InstantiateCell(grid->GetCellType(cell)));
  return std::string(one ? one->GetClassName() : "cell of unknown type") + " of " +
    std::to_string(grid->GetCells()->GetCellSize(cell)) + " points";
}

SimplexMesh<3> ReadTetrahedra(vtkUnstructuredGrid* grid, vtkAbstractArray* labels)
{
  SimplexMesh<3> mesh;
  if (grid->GetNumberOfCells() == 0)
  {
    return mesh;
  }
  mesh.Points.resize(static_cast<std::size_t>(grid->GetNumberOfPoints()));
  for (std::size_t i = 0; i < mesh.Points.size(); ++i)
  {
    mesh.Points[i] = PointOf(grid, i);
  }
  ReadCells<3>(grid, labels, VTK_TETRA, mesh);
  return mesh;
}

SimplexMesh<4> ReadPentatopes(vtkUnstructuredGrid* grid, vtkAbstractArray* labels, double timeScale)
{
  SimplexMesh<4> mesh;
  vtkDataArray* const times = TimesOf(grid);
  mesh.Points.resize(static_cast<std::size_t>(grid->GetNumberOfPoints()));
  for (std::size_t i = 0; i < mesh.Points.size(); ++i)
  {
    const Point<3> x = PointOf(grid, i);
    const double time = times->GetComponent(static_cast<vtkIdType>(i), 0);
    CheckFinite(std::isfinite(time), i);
    mesh.Points[i] = { x[0], x[1], x[2], timeScale * time };
  }
  ReadCells<4>(grid, labels, VTK_POLY_VERTEX, mesh);
  return mesh;
}

} // namespace voxplex
