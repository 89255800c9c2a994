// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "SpaceTimeMeshView.h"

#include "Formats.h"
#include "TextFile.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkPointData.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>

namespace voxplex::io
{
namespace
{

template <std::size_t N>
std::array<vtkIdType, N> Vertices(vtkUnstructuredGrid* grid, vtkIdType cell)
{
  vtkIdType size;
  const vtkIdType* ids;
  grid->GetCellPoints(cell, size, ids);
  std::array<vtkIdType, N> vertices;
  std::copy_n(ids, N, vertices.begin());
  return vertices;
}

} // namespace

SpaceTimeMeshView::SpaceTimeMeshView(const SpaceTimeMeshData& mesh)
  : Pentatopes(mesh.Pentatopes)
  , Boundary(mesh.Boundary)
  , Times(RequireArray(mesh.Pentatopes->GetPointData(), "Time"))
  , Labels(RequireArray(mesh.Pentatopes->GetCellData(), "Label"))
  , Pairs(RequireArray(mesh.Boundary->GetCellData(), "Labels"))
  , Sides(mesh.Boundary->GetCellData()->GetArray("Side"))
  , PointIds(RequireArray(mesh.Boundary->GetPointData(), "PointIds"))
{
  std::int64_t largest = 0;
  for (vtkIdType cell = 0; cell < this->NumberOfPentatopes(); ++cell)
  {
    largest = std::max(largest, this->LabelOf(cell));
  }
  std::set<SidedPair> pairs;
  for (vtkIdType cell = 0; cell < this->NumberOfTetrahedra(); ++cell)
  {
    pairs.insert(this->PairOf(cell));
  }
  this->PairNumber = NumberSidedPairs(pairs, largest);
}

vtkIdType SpaceTimeMeshView::NumberOfPoints() const
{
  return this->Pentatopes->GetNumberOfPoints();
}

std::array<double, 4> SpaceTimeMeshView::Point(vtkIdType id) const
{
  std::array<double, 4> x;
  this->Pentatopes->GetPoint(id, x.data());
  x[3] = this->Times->GetComponent(id, 0);
  return x;
}

vtkIdType SpaceTimeMeshView::NumberOfPentatopes() const
{
  return this->Pentatopes->GetNumberOfCells();
}

std::array<vtkIdType, 5> SpaceTimeMeshView::Pentatope(vtkIdType cell) const
{
  return Vertices<5>(this->Pentatopes, cell);
}

std::int64_t SpaceTimeMeshView::LabelOf(vtkIdType pentatope) const
{
  return LabelAt(this->Labels, pentatope);
}

vtkIdType SpaceTimeMeshView::NumberOfTetrahedra() const
{
  return this->Boundary->GetNumberOfCells();
}

std::array<vtkIdType, 4> SpaceTimeMeshView::Tetrahedron(vtkIdType cell) const
{
  std::array<vtkIdType, 4> vertices = Vertices<4>(this->Boundary, cell);
  for (vtkIdType& vertex : vertices)
  {
    vertex = static_cast<vtkIdType>(this->PointIds->GetComponent(vertex, 0));
  }
  return vertices;
}

SidedPair SpaceTimeMeshView::PairOf(vtkIdType tetrahedron) const
{
  const double side = this->Sides ? this->Sides->GetComponent(tetrahedron, 0) : 0.0;
  return { side == 1.0 ? 1
      : side == 2.0    ? 2
                       : 0,
    { LabelAt(this->Pairs, tetrahedron, 0), LabelAt(this->Pairs, tetrahedron, 1) } };
}

std::int64_t SpaceTimeMeshView::NumberOf(vtkIdType tetrahedron) const
{
  return this->PairNumber.at(this->PairOf(tetrahedron));
}

void SpaceTimeMeshView::WritePairs(TextFile& file) const
{
  for (const auto& [sided, number] : this->PairNumber)
  {
    const auto& [side, pair] = sided;
    file << "#   " << number << ": " << pair.first << ' ' << pair.second
         << (side == 0      ? ""
                : side == 1 ? " initial"
                            : " final")
         << '\n';
  }
}

} // namespace voxplex::io
