// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "SpaceTimeLattice.h"

#include "FilterTesting.h"

#include "vtkCell.h"
#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkDataObject.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkIdList.h"
#include "vtkInformation.h"
#include "vtkIntArray.h"
#include "vtkLongLongArray.h"
#include "vtkNew.h"
#include "vtkPentatopeMeshTimeSlice.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkStringArray.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

namespace testing
{

namespace
{

using Pentatope = std::array<vtkIdType, 5>;
using Facet = std::array<vtkIdType, 4>;

constexpr int N = 3; // points of the grid along each axis; times are 0, 1, 2

std::array<double, 4> LatticePoint(vtkIdType id)
{
  return { double(id % N), double(id / N % N), double(id / N / N % N), double(id / N / N / N) };
}

/** Kuhn's subdivision of the lattice; positive. */
std::vector<Pentatope> LatticePentatopes()
{
  std::vector<Pentatope> pentatopes;
  const std::array<vtkIdType, 4> steps = { 1, N, N * N, N * N * N };
  for (vtkIdType i = 0; i < N * N * N * N; ++i)
  {
    const auto p = LatticePoint(i);
    if (*std::max_element(p.begin(), p.end()) > N - 1.5)
    {
      continue;
    }
    std::array<std::size_t, 4> order = { 0, 1, 2, 3 };
    do
    {
      Pentatope ids = { i };
      for (std::size_t k = 0; k < 4; ++k)
      {
        ids[k + 1] = ids[k] + steps[order[k]];
      }
      Simplex<4> corners;
      std::transform(ids.begin(), ids.end(), corners.begin(), LatticePoint);
      if (Volume<4>(corners) < 0.0)
      {
        std::swap(ids[0], ids[1]);
      }
      pentatopes.push_back(ids);
    } while (std::next_permutation(order.begin(), order.end()));
  }
  return pentatopes;
}

/** Label 1 where x < 1, 2 elsewhere. */
int LabelOf(const Pentatope& pentatope)
{
  return std::all_of(pentatope.begin(), pentatope.end(),
           [](vtkIdType id) { return LatticePoint(id)[0] < 1.5; })
    ? 1
    : 2;
}

} // namespace

double Linear(double x, double y, double z, double t)
{
  return 1.0 + x - 2.0 * y + 3.0 * z + 5.0 * t;
}

namespace
{

vtkSmartPointer<vtkUnstructuredGrid> LatticePoints()
{
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkDoubleArray> time;
  time->SetName("Time");
  vtkNew<vtkDoubleArray> field;
  field->SetName("Field");
  vtkNew<vtkLongLongArray> ids; // VTK interpolates no vtkIdTypeArray anyway
  ids->SetName("PointIds");
  for (vtkIdType i = 0; i < N * N * N * N; ++i)
  {
    const auto p = LatticePoint(i);
    points->InsertNextPoint(p.data());
    time->InsertNextValue(p[3]);
    field->InsertNextValue(Linear(p[0], p[1], p[2], p[3]));
    ids->InsertNextValue(i);
  }
  grid->SetPoints(points);
  grid->GetPointData()->AddArray(time);
  grid->GetPointData()->AddArray(field);
  grid->GetPointData()->AddArray(ids);
  grid->Allocate(1000);
  return grid;
}

} // namespace

vtkSmartPointer<vtkUnstructuredGrid> MakePentatopes()
{
  const auto grid = LatticePoints();
  vtkNew<vtkIntArray> labels;
  labels->SetName("Label");
  for (const Pentatope& pentatope : LatticePentatopes())
  {
    grid->InsertNextCell(VTK_POLY_VERTEX, 5, pentatope.data());
    labels->InsertNextValue(LabelOf(pentatope));
  }
  grid->GetCellData()->SetScalars(labels);
  vtkNew<vtkStringArray> space;
  space->SetName("SPACE");
  space->InsertNextValue("LPS");
  grid->GetFieldData()->AddArray(space);
  return grid;
}

vtkSmartPointer<vtkUnstructuredGrid> MakeBoundaryTetrahedra()
{
  const auto grid = LatticePoints();
  std::map<std::set<vtkIdType>, std::vector<std::pair<int, Facet>>> facets;
  for (const Pentatope& p : LatticePentatopes())
  {
    for (std::size_t i = 0; i < 5; ++i)
    {
      Facet facet;
      std::copy(p.begin() + i + 1, p.end(), std::copy(p.begin(), p.begin() + i, facet.begin()));
      if (i % 2 == 1)
      {
        std::swap(facet[0], facet[1]);
      }
      facets[{ facet.begin(), facet.end() }].emplace_back(LabelOf(p), facet);
    }
  }
  vtkNew<vtkIntArray> labels;
  labels->SetName("Labels");
  labels->SetNumberOfComponents(2);
  for (auto& [ids, sides] : facets)
  {
    std::sort(sides.rbegin(), sides.rend());
    const int other = sides.size() == 1 ? 0 : sides[1].first;
    if (sides[0].first != other)
    {
      grid->InsertNextCell(VTK_TETRA, 4, sides[0].second.data());
      labels->InsertNextTuple2(sides[0].first, other);
    }
  }
  grid->GetCellData()->AddArray(labels);
  return grid;
}

std::map<int, double> Volumes(vtkUnstructuredGrid* slice)
{
  std::map<int, double> volumes;
  vtkDataArray* labels = slice->GetCellData()->GetArray("Label");
  vtkNew<vtkIdList> ids;
  vtkNew<vtkPoints> points;
  for (vtkIdType c = 0; c < slice->GetNumberOfCells(); ++c)
  {
    vtkCell* cell = slice->GetCell(c);
    if (cell->GetCellDimension() != 3)
    {
      continue;
    }
    cell->Triangulate(0, ids, points);
    for (vtkIdType i = 0; i + 3 < points->GetNumberOfPoints(); i += 4)
    {
      Simplex<3> t;
      for (vtkIdType k = 0; k < 4; ++k)
      {
        points->GetPoint(i + k, t[static_cast<std::size_t>(k)].data());
      }
      const double volume = Volume<3>(t);
      CHECK(volume > 0.0, c, cell->GetClassName(), volume);
      volumes[labels ? static_cast<int>(labels->GetComponent(c, 0)) : 0] += volume;
    }
  }
  return volumes;
}

bool Near(double a, double b)
{
  return std::abs(a - b) < 1e-12;
}

double DataTime(vtkAlgorithm* filter)
{
  vtkInformation* info = filter->GetOutputDataObject(0)->GetInformation();
  return info->Has(vtkDataObject::DATA_TIME_STEP()) ? info->Get(vtkDataObject::DATA_TIME_STEP())
                                                    : std::nan("");
}

void CheckSlice(vtkPentatopeMeshTimeSlice* filter, double time)
{
  CHECK(filter->GetErrorMessage().empty(), filter->GetErrorMessage());
  CHECK(DataTime(filter) == time, DataTime(filter), time);
  const auto volumes = Volumes(filter->GetOutput());
  CHECK(volumes.size() == 2, volumes.size());
  for (const auto& [label, volume] : volumes)
  {
    CHECK(Near(volume, 4.0), time, label, volume);
  }
}

} // namespace testing
