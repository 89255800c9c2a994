// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "MeshView.h"

#include "Errors.h"
#include "Formats.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <limits>
#include <stdexcept>

namespace voxplex::cli
{
namespace
{

vtkDataArray* RequireArray(vtkDataSetAttributes* attributes, const char* name)
{
  vtkDataArray* array = attributes->GetArray(name);
  if (!array)
  {
    throw std::logic_error(std::string("the mesh has no array '") + name + "'");
  }
  return array;
}

/** vtkVariant keeps all 64 bits of a label, GetTuple() only 53. */
std::int64_t Label(vtkDataArray* labels, vtkIdType cell, int component = 0)
{
  const vtkIdType index = cell * labels->GetNumberOfComponents() + component;
  const auto label = static_cast<std::int64_t>(labels->GetVariantValue(index).ToTypeInt64());
  if (label > std::numeric_limits<std::int32_t>::max())
  {
    throw RunError("label " + std::to_string(label) +
      " does not fit into this format, which has 32 bits for it; write a .vtu file");
  }
  return label;
}

} // namespace

MeshView::MeshView(const MeshData& mesh)
  : Points(mesh.Tetrahedra->GetPoints())
{
  vtkIdType size;
  const vtkIdType* ids;

  vtkDataArray* labels = RequireArray(mesh.Tetrahedra->GetCellData(), "Label");
  const vtkIdType numberOfTetrahedra = mesh.Tetrahedra->GetNumberOfCells();
  this->Tetrahedra.reserve(static_cast<std::size_t>(numberOfTetrahedra));
  for (vtkIdType cell = 0; cell < numberOfTetrahedra; ++cell)
  {
    mesh.Tetrahedra->GetCellPoints(cell, size, ids);
    this->Tetrahedra.push_back({ ids[0], ids[1], ids[2], ids[3] });
    this->LabelOfTetrahedron.push_back(Label(labels, cell));
    this->TetrahedraOfLabel[this->LabelOfTetrahedron.back()].push_back(cell);
  }

  vtkDataArray* pairs = RequireArray(mesh.Interfaces->GetCellData(), "Labels");
  vtkDataArray* pointIds = RequireArray(mesh.Interfaces->GetPointData(), "PointIds");
  vtkCellArray* triangles = mesh.Interfaces->GetPolys();
  const auto vertex = [pointIds](vtkIdType id)
  { return static_cast<vtkIdType>(pointIds->GetComponent(id, 0)); };
  const vtkIdType numberOfTriangles = triangles->GetNumberOfCells();
  this->Triangles.reserve(static_cast<std::size_t>(numberOfTriangles));
  for (vtkIdType cell = 0; cell < numberOfTriangles; ++cell)
  {
    triangles->GetCellAtId(cell, size, ids);
    this->Triangles.push_back({ vertex(ids[0]), vertex(ids[1]), vertex(ids[2]) });
    this->PairOfTriangle.emplace_back(Label(pairs, cell, 0), Label(pairs, cell, 1));
    this->TrianglesOfPair[this->PairOfTriangle.back()].push_back(cell);
  }

  std::int64_t next =
    this->TetrahedraOfLabel.empty() ? 1 : this->TetrahedraOfLabel.rbegin()->first + 1;
  for (const auto& [pair, cells] : this->TrianglesOfPair)
  {
    this->PairNumber[pair] = pair.second == 0 ? pair.first : next++;
  }
}

vtkIdType MeshView::NumberOfPoints() const
{
  return this->Points->GetNumberOfPoints();
}

std::array<double, 3> MeshView::Point(vtkIdType id) const
{
  std::array<double, 3> x;
  this->Points->GetPoint(id, x.data());
  return x;
}

} // namespace voxplex::cli
