// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "SpaceTimeMeshView.h"

#include "Formats.h"
#include "TextFile.h"
#include "TimeSlabs.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkPointData.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <numeric>

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

/** By points of the pentatopes. */
std::vector<std::array<vtkIdType, 4>> TetrahedraOf(vtkUnstructuredGrid* boundary)
{
  vtkDataArray* const ids = RequireArray(boundary->GetPointData(), "PointIds");
  std::vector<std::array<vtkIdType, 4>> tetrahedra;
  for (vtkIdType cell = 0; cell < boundary->GetNumberOfCells(); ++cell)
  {
    tetrahedra.push_back(Vertices<4>(boundary, cell));
    for (vtkIdType& vertex : tetrahedra.back())
    {
      vertex = static_cast<vtkIdType>(ids->GetComponent(vertex, 0));
    }
  }
  return tetrahedra;
}

std::vector<SidedPair> PairsOf(vtkUnstructuredGrid* boundary)
{
  vtkDataArray* const labels = RequireArray(boundary->GetCellData(), "Labels");
  vtkDataArray* const sides = boundary->GetCellData()->GetArray("Side");
  std::vector<SidedPair> pairs;
  for (vtkIdType cell = 0; cell < boundary->GetNumberOfCells(); ++cell)
  {
    const double side = sides ? sides->GetComponent(cell, 0) : 0.0;
    pairs.push_back({ side == 1.0 ? 1
        : side == 2.0             ? 2
                                  : 0,
      { LabelAt(labels, cell, 0), LabelAt(labels, cell, 1) } });
  }
  return pairs;
}

/** The side of facets on a time plane. */
SidedPair PairOf(const PlaneFacet& facet)
{
  return { 2 + facet.Plane, { facet.Label, facet.Label } };
}

} // namespace

SpaceTimeMeshView::SpaceTimeMeshView(const SpaceTimeMeshData& mesh)
  : Slab(mesh.Slab)
  , Pentatopes(mesh.Pentatopes)
  , Times(RequireArray(mesh.Pentatopes->GetPointData(), "Time"))
  , Labels(RequireArray(mesh.Pentatopes->GetCellData(), "Label"))
  , Planes(TimePlanesOf(mesh.Pentatopes))
{
  this->ChooseCells();
  this->ChoosePoints();
  this->GatherFacets(mesh);
}

void SpaceTimeMeshView::ChooseCells()
{
  this->Cells.resize(static_cast<std::size_t>(this->Pentatopes->GetNumberOfCells()));
  std::iota(this->Cells.begin(), this->Cells.end(), 0);
  if (this->IsSlab())
  {
    vtkDataArray* const slabs = RequireArray(this->Pentatopes->GetCellData(), "Slab");
    std::erase_if(this->Cells,
      [this, slabs](vtkIdType cell) { return slabs->GetComponent(cell, 0) != this->Slab; });
  }
}

/** A whole mesh has all points, those that no pentatope uses, too. */
void SpaceTimeMeshView::ChoosePoints()
{
  const vtkIdType all = this->Pentatopes->GetNumberOfPoints();
  this->LocalId.assign(static_cast<std::size_t>(all), this->IsSlab() ? -1 : 0);
  if (this->IsSlab())
  {
    for (const vtkIdType cell : this->Cells)
    {
      for (const vtkIdType id : Vertices<5>(this->Pentatopes, cell))
      {
        this->LocalId[static_cast<std::size_t>(id)] = 0;
      }
    }
  }
  for (vtkIdType id = 0; id < all; ++id)
  {
    vtkIdType& local = this->LocalId[static_cast<std::size_t>(id)];
    if (local == 0)
    {
      local = this->NumberOfPoints();
      this->Points.push_back(id);
    }
  }
}

/** Numbers pairs and sides of the whole mesh; keeps the facets of the slab. */
void SpaceTimeMeshView::GatherFacets(const SpaceTimeMeshData& mesh)
{
  const std::vector<std::array<vtkIdType, 4>> tetrahedra = TetrahedraOf(mesh.Boundary);
  const std::vector<SidedPair> pairs = PairsOf(mesh.Boundary);
  const std::vector<PlaneFacet> onPlanes = FindPlaneFacets(mesh.Pentatopes, tetrahedra);
  std::int64_t largest = 0;
  for (vtkIdType cell = 0; cell < this->Pentatopes->GetNumberOfCells(); ++cell)
  {
    largest = std::max(largest, LabelAt(this->Labels, cell));
  }
  std::set<SidedPair> all(pairs.begin(), pairs.end());
  for (const PlaneFacet& facet : onPlanes)
  {
    all.insert(PairOf(facet));
  }
  this->PairNumber = NumberSidedPairs(all, largest);

  const auto add = [this](std::array<vtkIdType, 4> vertices, const SidedPair& pair)
  {
    for (vtkIdType& vertex : vertices)
    {
      vertex = this->LocalId[static_cast<std::size_t>(vertex)];
    }
    this->Facets.push_back({ vertices, this->PairNumber.at(pair) });
  };
  for (std::size_t k = 0; k < tetrahedra.size(); ++k)
  {
    if (!this->IsSlab() || this->IsInSlab(tetrahedra[k]))
    {
      add(tetrahedra[k], pairs[k]);
    }
  }
  for (const PlaneFacet& facet : onPlanes)
  {
    if (!this->IsSlab() || facet.Plane == this->Slab || facet.Plane == this->Slab + 1)
    {
      add(facet.Vertices, PairOf(facet));
    }
  }
}

/** A facet on a plane, between two labels, is in both slabs. */
bool SpaceTimeMeshView::IsInSlab(const std::array<vtkIdType, 4>& facet) const
{
  const auto slab = static_cast<std::size_t>(this->Slab);
  return std::all_of(facet.begin(), facet.end(),
    [&](vtkIdType id)
    {
      const double time = this->Times->GetComponent(id, 0);
      return (slab == 0 || time >= this->Planes[slab - 1]) &&
        (slab >= this->Planes.size() || time <= this->Planes[slab]);
    });
}

//------------------------------------------------------------------------------------------------
std::array<double, 4> SpaceTimeMeshView::Point(vtkIdType i) const
{
  const vtkIdType id = this->NumberInWhole(i);
  std::array<double, 4> x;
  this->Pentatopes->GetPoint(id, x.data());
  x[3] = this->Times->GetComponent(id, 0);
  return x;
}

std::array<vtkIdType, 5> SpaceTimeMeshView::Pentatope(vtkIdType i) const
{
  std::array<vtkIdType, 5> vertices =
    Vertices<5>(this->Pentatopes, this->Cells[static_cast<std::size_t>(i)]);
  for (vtkIdType& vertex : vertices)
  {
    vertex = this->LocalId[static_cast<std::size_t>(vertex)];
  }
  return vertices;
}

std::int64_t SpaceTimeMeshView::LabelOf(vtkIdType i) const
{
  return LabelAt(this->Labels, this->Cells[static_cast<std::size_t>(i)]);
}

std::vector<vtkIdType> SpaceTimeMeshView::SlabsOfPentatopes() const
{
  std::vector<vtkIdType> numbers;
  vtkDataArray* const slabs = this->Pentatopes->GetCellData()->GetArray("Slab");
  for (std::size_t i = 0; !this->Planes.empty() && i < this->Cells.size(); ++i)
  {
    numbers.push_back(static_cast<vtkIdType>(slabs->GetComponent(this->Cells[i], 0)));
  }
  return numbers;
}

std::vector<std::array<vtkIdType, 2>> SpaceTimeMeshView::PeriodicPairs() const
{
  std::vector<std::array<vtkIdType, 2>> pairs;
  vtkDataArray* const ids = this->Pentatopes->GetFieldData()->GetArray("PeriodicPairs");
  for (vtkIdType k = 0; ids && !this->IsSlab() && k < ids->GetNumberOfTuples(); ++k)
  {
    pairs.push_back({ static_cast<vtkIdType>(ids->GetComponent(k, 0)),
      static_cast<vtkIdType>(ids->GetComponent(k, 1)) });
  }
  return pairs;
}

void SpaceTimeMeshView::WritePairs(TextFile& file) const
{
  for (std::size_t plane = 0; plane < this->Planes.size(); ++plane)
  {
    file << "#   plane " << plane + 1 << " at " << this->Planes[plane] << '\n';
  }
  for (const auto& [sided, number] : this->PairNumber)
  {
    const auto& [side, pair] = sided;
    file << "#   " << number << ": " << pair.first << ' ' << pair.second;
    if (side > 2)
    {
      file << " plane " << side - 2;
    }
    else
    {
      file << (side == 0 ? "" : side == 1 ? " initial" : " final");
    }
    file << '\n';
  }
}

} // namespace voxplex::io
