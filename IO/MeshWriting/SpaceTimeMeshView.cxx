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
#include <iterator>

namespace voxplex::io
{
namespace
{

using FacetVertices = std::array<vtkIdType, 4>;

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
std::vector<FacetVertices> TetrahedraOf(vtkUnstructuredGrid* boundary)
{
  vtkDataArray* const ids = RequireArray(boundary->GetPointData(), "PointIds");
  std::vector<FacetVertices> tetrahedra;
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

/** The side of facets on a time plane. */
SidedPair PairOf(const PlaneFacet& facet)
{
  return { 2 + facet.Plane, { facet.Label, facet.Label } };
}

} // namespace

SpaceTimeMeshView::SpaceTimeMeshView(const SpaceTimeMeshData& mesh)
  : Slab(mesh.Slab)
  , Pentatopes(this->IsSlab() ? ExtractSlab(mesh.Pentatopes, mesh.Slab).Get() : mesh.Pentatopes)
  , Times(RequireArray(this->Pentatopes->GetPointData(), "Time"))
  , Labels(RequireArray(this->Pentatopes->GetCellData(), "Label"))
  , Planes(TimePlanesOf(mesh.Pentatopes))
{
  const std::vector<FacetVertices> tetrahedra = TetrahedraOf(mesh.Boundary);
  const std::vector<SidedPair> pairs = SidedPairsOf(mesh.Boundary, LabelAt);
  const std::vector<PlaneFacet> onPlanes = FindPlaneFacets(mesh.Pentatopes, tetrahedra);
  this->NumberFacets(mesh.Pentatopes, pairs, onPlanes);

  std::vector<vtkIdType> local(static_cast<std::size_t>(mesh.Pentatopes->GetNumberOfPoints()), -1);
  for (vtkIdType i = 0; i < this->NumberOfPoints(); ++i)
  {
    local[static_cast<std::size_t>(this->NumberInWhole(i))] = i;
  }
  const auto add = [&](FacetVertices vertices, const SidedPair& pair)
  {
    for (vtkIdType& vertex : vertices)
    {
      vertex = local[static_cast<std::size_t>(vertex)];
    }
    this->Facets.push_back({ vertices, this->PairNumber.at(pair) });
  };
  for (std::size_t k = 0; k < tetrahedra.size(); ++k)
  {
    if (!this->IsSlab() || this->IsInSlab(tetrahedra[k], mesh.Pentatopes))
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

void SpaceTimeMeshView::NumberFacets(vtkUnstructuredGrid* whole,
  const std::vector<SidedPair>& pairs, const std::vector<PlaneFacet>& onPlanes)
{
  std::int64_t largest = 0;
  vtkDataArray* const labels = whole->GetCellData()->GetArray("Label");
  for (vtkIdType cell = 0; cell < whole->GetNumberOfCells(); ++cell)
  {
    largest = std::max(largest, LabelAt(labels, cell));
  }
  std::set<SidedPair> all(pairs.begin(), pairs.end());
  std::transform(onPlanes.begin(), onPlanes.end(), std::inserter(all, all.end()), PairOf);
  this->PairNumber = NumberSidedPairs(all, largest);
}

/** A facet on a plane, between two labels, is in both slabs. */
bool SpaceTimeMeshView::IsInSlab(const FacetVertices& facet, vtkUnstructuredGrid* whole) const
{
  const auto slab = static_cast<std::size_t>(this->Slab);
  vtkDataArray* const times = whole->GetPointData()->GetArray("Time");
  return std::all_of(facet.begin(), facet.end(),
    [&](vtkIdType id)
    {
      const double time = times->GetComponent(id, 0);
      return (slab == 0 || time >= this->Planes[slab - 1]) &&
        (slab >= this->Planes.size() || time <= this->Planes[slab]);
    });
}

//------------------------------------------------------------------------------------------------
vtkIdType SpaceTimeMeshView::NumberOfPoints() const
{
  return this->Pentatopes->GetNumberOfPoints();
}

std::array<double, 4> SpaceTimeMeshView::Point(vtkIdType i) const
{
  std::array<double, 4> x;
  this->Pentatopes->GetPoint(i, x.data());
  x[3] = this->Times->GetComponent(i, 0);
  return x;
}

vtkIdType SpaceTimeMeshView::NumberInWhole(vtkIdType i) const
{
  vtkDataArray* const ids = this->Pentatopes->GetPointData()->GetGlobalIds();
  return this->IsSlab() ? static_cast<vtkIdType>(ids->GetComponent(i, 0)) : i;
}

vtkIdType SpaceTimeMeshView::NumberOfElements() const
{
  return this->Pentatopes->GetNumberOfCells();
}

std::array<vtkIdType, 5> SpaceTimeMeshView::Element(vtkIdType i) const
{
  return Vertices<5>(this->Pentatopes, i);
}

std::int64_t SpaceTimeMeshView::LabelOf(vtkIdType i) const
{
  return LabelAt(this->Labels, i);
}

std::vector<vtkIdType> SpaceTimeMeshView::SlabsOfPentatopes() const
{
  std::vector<vtkIdType> numbers;
  vtkDataArray* const slabs = this->Pentatopes->GetCellData()->GetArray("Slab");
  for (vtkIdType i = 0; !this->Planes.empty() && i < this->NumberOfElements(); ++i)
  {
    numbers.push_back(static_cast<vtkIdType>(slabs->GetComponent(i, 0)));
  }
  return numbers;
}

std::vector<std::array<vtkIdType, 2>> SpaceTimeMeshView::PeriodicPairs() const
{
  std::vector<std::array<vtkIdType, 2>> pairs;
  vtkDataArray* const ids = this->Pentatopes->GetFieldData()->GetArray("PeriodicPairs");
  for (vtkIdType k = 0; ids && k < ids->GetNumberOfTuples(); ++k)
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
