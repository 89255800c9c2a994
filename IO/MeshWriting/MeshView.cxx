// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "MeshView.h"

#include "Formats.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

namespace voxplex::io
{
MeshView::MeshView(const MeshData& mesh)
  : Table(GetLabelTable(mesh.Tetrahedra->GetFieldData()))
  , Points(mesh.Tetrahedra->GetPoints())
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
    this->LabelOfTetrahedron.push_back(LabelAt(labels, cell));
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
    this->PairOfTriangle.emplace_back(LabelAt(pairs, cell, 0), LabelAt(pairs, cell, 1));
    this->TrianglesOfPair[this->PairOfTriangle.back()].push_back(cell);
  }

  const std::int64_t largest =
    this->TetrahedraOfLabel.empty() ? 0 : this->TetrahedraOfLabel.rbegin()->first;
  this->PairNumber = NumberPairs(KeysOf(this->TrianglesOfPair), largest);
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

} // namespace voxplex::io
