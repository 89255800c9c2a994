// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "PentatopeTesting.h"

#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace testing
{

vtkStandardNewMacro(TemporalSource);

std::vector<double> EqualTimes(int frames, double step)
{
  std::vector<double> times;
  for (int k = 0; k < frames; ++k)
  {
    times.push_back(k * step);
  }
  return times;
}

//----------------------------------------------------------------------------------------------------
TemporalSource::TemporalSource()
{
  this->SetNumberOfInputPorts(0);
}

int TemporalSource::RequestInformation(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  vtkInformation* info = outputVector->GetInformationObject(0);
  if (const auto frame = this->MakeFrame(0))
  {
    info->Set(Pipeline::WHOLE_EXTENT(), frame->GetExtent(), 6);
    info->Set(vtkDataObject::SPACING(), frame->GetSpacing(), 3);
  }
  if (!this->Times.empty())
  {
    info->Set(Pipeline::TIME_STEPS(), this->Times.data(), static_cast<int>(this->Times.size()));
    const double range[2] = { this->Times.front(), this->Times.back() };
    info->Set(Pipeline::TIME_RANGE(), range, 2);
  }
  return 1;
}

int TemporalSource::RequestData(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  vtkInformation* info = outputVector->GetInformationObject(0);
  int frame = 0;
  if (info->Has(Pipeline::UPDATE_TIME_STEP()))
  {
    const double time = info->Get(Pipeline::UPDATE_TIME_STEP());
    this->Asked.push_back(time);
    frame = static_cast<int>(
      std::find(this->Times.begin(), this->Times.end(), time) - this->Times.begin());
  }
  const auto image = this->MakeFrame(frame);
  if (image == nullptr)
  {
    return 0;
  }
  vtkImageData* output = vtkImageData::GetData(outputVector);
  output->ShallowCopy(image);
  if (!this->Times.empty())
  {
    output->GetInformation()->Set(
      vtkDataObject::DATA_TIME_STEP(), this->Times[static_cast<std::size_t>(frame)]);
  }
  return 1;
}

vtkSmartPointer<TemporalSource> MakeSeries(
  const Placement& placement, const std::vector<double>& times, const MovingLabel& label, int type)
{
  auto source = vtkSmartPointer<TemporalSource>::New();
  source->Times = times;
  source->MakeFrame = [=](int frame)
  {
    const double t = times[static_cast<std::size_t>(frame)];
    return MakeImage(
      placement, [&](const Vector& x) { return label(x, t); }, type);
  };
  return source;
}

vtkSmartPointer<vtkImageData> MakeComponents(
  const Placement& placement, const std::vector<double>& times, const MovingLabel& label, int type)
{
  const auto scalars = [&placement](vtkImageData* image)
  {
    return placement.Cells ? image->GetCellData()->GetScalars()
                           : image->GetPointData()->GetScalars();
  };
  const auto result = MakeImage(
    placement, [](const Vector&) { return 0.0; }, type);
  vtkDataArray* all = scalars(result);
  const vtkIdType voxels = all->GetNumberOfTuples();
  all->SetNumberOfComponents(static_cast<int>(times.size()));
  all->SetNumberOfTuples(voxels);
  for (int k = 0; k < all->GetNumberOfComponents(); ++k)
  {
    const double t = times[static_cast<std::size_t>(k)];
    const auto frame = MakeImage(
      placement, [&](const Vector& x) { return label(x, t); }, type);
    all->CopyComponent(k, scalars(frame), 0);
  }
  return result;
}

//----------------------------------------------------------------------------------------------------
Placement SmallPlacement()
{
  Placement placement;
  placement.Extent = { 0, 11, 0, 11, 0, 11 };
  return placement;
}

MovingLabel TwoLabelBall(const Event& centre, double radius)
{
  return [=](const Vector& x, double t)
  {
    const double space = std::hypot(x[0] - centre[0], x[1] - centre[1], x[2] - centre[2]);
    return std::hypot(space, t - centre[3]) >= radius ? 0.0 : x[0] < centre[0] ? 3.0 : 7.0;
  };
}

vtkSmartPointer<vtkImageToPentatopeMeshFilter> MakePentatopeFilter(vtkAlgorithm* source)
{
  auto filter = vtkSmartPointer<vtkImageToPentatopeMeshFilter>::New();
  filter->SetInputConnection(source->GetOutputPort());
  filter->SetNumberOfThreads(1);
  filter->PickingRegionsOff();
  return filter;
}

vtkSmartPointer<vtkImageToPentatopeMeshFilter> MakePentatopeFilter()
{
  return MakePentatopeFilter(
    MakeSeries(SmallPlacement(), EqualTimes(12), TwoLabelBall({ 5.5, 5.5, 5.5, 5.5 }, 4.2)));
}

//----------------------------------------------------------------------------------------------------
double Hypervolume(const std::array<Event, 5>& p)
{
  std::array<Event, 4> m;
  for (std::size_t i = 0; i < 4; ++i)
  {
    for (std::size_t k = 0; k < 4; ++k)
    {
      m[i][k] = p[i + 1][k] - p[0][k];
    }
  }
  // Along the first row; the minors are volumes of tetrahedra.
  double determinant = 0.0;
  for (std::size_t k = 0; k < 4; ++k)
  {
    std::array<Vector, 3> minor;
    for (std::size_t i = 0; i < 3; ++i)
    {
      std::size_t column = 0;
      for (std::size_t c = 0; c < 4; ++c)
      {
        if (c != k)
        {
          minor[i][column++] = m[i + 1][c];
        }
      }
    }
    const double sign = k % 2 == 0 ? 1.0 : -1.0;
    determinant += sign * m[0][k] * 6.0 * Volume({ 0, 0, 0 }, minor[0], minor[1], minor[2]);
  }
  return determinant / 24.0;
}

std::array<Event, 5> Pentatopes::Corners(std::size_t cell) const
{
  std::array<Event, 5> corners;
  for (std::size_t i = 0; i < 5; ++i)
  {
    corners[i] = this->Points[static_cast<std::size_t>(this->Cells[cell][i])];
  }
  return corners;
}

double Pentatopes::HypervolumeOf(long long label) const
{
  double sum = 0.0;
  for (std::size_t c = 0; c < this->Cells.size(); ++c)
  {
    if (label == 0 || this->Labels[c] == label)
    {
      sum += Hypervolume(this->Corners(c));
    }
  }
  return sum;
}

namespace
{

std::vector<Event> ReadEvents(vtkUnstructuredGrid* grid)
{
  std::vector<Event> events;
  vtkDataArray* times = grid->GetPointData()->GetArray("Time");
  if (!CHECK(times != nullptr) || !CHECK(times->GetDataType() == VTK_DOUBLE) ||
    !CHECK(times->GetNumberOfComponents() == 1) ||
    !CHECK(times->GetNumberOfTuples() == grid->GetNumberOfPoints()) ||
    !CHECK(grid->GetPoints()->GetDataType() == VTK_DOUBLE))
  {
    return events;
  }
  for (vtkIdType p = 0; p < grid->GetNumberOfPoints(); ++p)
  {
    Vector x;
    grid->GetPoint(p, x.data());
    events.push_back({ x[0], x[1], x[2], times->GetComponent(p, 0) });
  }
  return events;
}

} // namespace

Pentatopes ReadPentatopes(vtkUnstructuredGrid* grid)
{
  Pentatopes mesh;
  mesh.Points = ReadEvents(grid);
  vtkDataArray* labels = grid->GetCellData()->GetArray("Label");
  if (!CHECK(labels != nullptr) || !CHECK(labels->GetNumberOfComponents() == 1) ||
    !CHECK(grid->GetCellData()->GetScalars() == labels))
  {
    return mesh;
  }
  for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c)
  {
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    grid->GetCellPoints(c, count, ids);
    if (!CHECK(grid->GetCellType(c) == VTK_POLY_VERTEX && count == 5, c, count))
    {
      return mesh;
    }
    mesh.Cells.push_back({ ids[0], ids[1], ids[2], ids[3], ids[4] });
    mesh.Labels.push_back(std::llround(labels->GetComponent(c, 0)));
  }
  return mesh;
}

//----------------------------------------------------------------------------------------------------
namespace
{

using Facet = std::array<vtkIdType, 4>;

struct FacetSide
{
  long long Label;
  vtkIdType Opposite; ///< the vertex of the pentatope that is not on the facet
};

template <std::size_t N>
std::array<vtkIdType, N> SortedIds(std::array<vtkIdType, N> ids)
{
  std::sort(ids.begin(), ids.end());
  return ids;
}

std::map<Facet, std::vector<FacetSide>> FacetsOf(const Pentatopes& mesh)
{
  std::map<Facet, std::vector<FacetSide>> facets;
  for (std::size_t c = 0; c < mesh.Cells.size(); ++c)
  {
    const auto& v = mesh.Cells[c];
    for (std::size_t i = 0; i < 5; ++i)
    {
      const Facet facet = { v[(i + 1) % 5], v[(i + 2) % 5], v[(i + 3) % 5], v[(i + 4) % 5] };
      facets[SortedIds(facet)].push_back({ mesh.Labels[c], v[i] });
    }
  }
  return facets;
}

void CheckCells(const Pentatopes& mesh)
{
  double smallest = VTK_DOUBLE_MAX;
  std::vector<char> used(mesh.Points.size(), 0);
  for (std::size_t c = 0; c < mesh.Cells.size(); ++c)
  {
    smallest = std::min(smallest, Hypervolume(mesh.Corners(c)));
    for (const vtkIdType id : mesh.Cells[c])
    {
      used[static_cast<std::size_t>(id)] = 1;
    }
  }
  CHECK(smallest > 0.0, smallest);
  CHECK(std::count(mesh.Labels.begin(), mesh.Labels.end(), 0) == 0);
  CHECK(std::find(used.begin(), used.end(), 0) == used.end());
  CHECK(std::set<Event>(mesh.Points.begin(), mesh.Points.end()).size() == mesh.Points.size());
}

/** The boundary's cells in the mesh's points; checks that these are the same points. */
std::vector<Facet> ReadBoundary(vtkUnstructuredGrid* boundary, const Pentatopes& mesh)
{
  std::vector<Facet> facets;
  const std::vector<Event> points = ReadEvents(boundary);
  vtkDataArray* pointIds = boundary->GetPointData()->GetArray("PointIds");
  if (!CHECK(pointIds != nullptr) || !CHECK(pointIds->GetDataType() == VTK_ID_TYPE))
  {
    return facets;
  }
  const auto meshId = [pointIds](vtkIdType p)
  { return static_cast<vtkIdType>(pointIds->GetComponent(p, 0)); };
  for (std::size_t p = 0; p < points.size(); ++p)
  {
    const auto id = static_cast<std::size_t>(meshId(static_cast<vtkIdType>(p)));
    CHECK(points[p] == mesh.Points[id], p);
  }
  std::set<vtkIdType> used;
  for (vtkIdType c = 0; c < boundary->GetNumberOfCells(); ++c)
  {
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    boundary->GetCellPoints(c, count, ids);
    if (CHECK(boundary->GetCellType(c) == VTK_TETRA && count == 4, c))
    {
      facets.push_back({ meshId(ids[0]), meshId(ids[1]), meshId(ids[2]), meshId(ids[3]) });
      used.insert(ids, ids + 4);
    }
  }
  CHECK(static_cast<vtkIdType>(used.size()) == boundary->GetNumberOfPoints());
  return facets;
}

/** Around each label, every triangle lies in an even number of boundary tetrahedra. */
void CheckClosed(const std::vector<Facet>& boundary, vtkDataArray* labels)
{
  std::map<std::pair<long long, std::array<vtkIdType, 3>>, int> triangles;
  for (std::size_t c = 0; c < boundary.size(); ++c)
  {
    for (int side = 0; side < 2; ++side)
    {
      const auto label = std::llround(labels->GetComponent(static_cast<vtkIdType>(c), side));
      for (std::size_t i = 0; i < 4; ++i)
      {
        const Facet& f = boundary[c];
        ++triangles[{ label, SortedIds<3>({ f[(i + 1) % 4], f[(i + 2) % 4], f[(i + 3) % 4] }) }];
      }
    }
  }
  std::size_t open = 0;
  for (const auto& [triangle, count] : triangles)
  {
    open += static_cast<std::size_t>(count % 2);
  }
  CHECK(open == 0, open);
}

void CheckBoundary(vtkUnstructuredGrid* grid, const Pentatopes& mesh)
{
  const auto facets = FacetsOf(mesh);
  std::size_t expected = 0;
  for (const auto& [facet, sides] : facets)
  {
    CHECK(sides.size() <= 2, "a facet of more than two pentatopes");
    expected += sides.size() == 1 || sides[0].Label != sides[1].Label ? 1 : 0;
  }
  const std::vector<Facet> boundary = ReadBoundary(grid, mesh);
  CHECK(boundary.size() == expected, boundary.size(), expected);
  vtkDataArray* labels = grid->GetCellData()->GetArray("Labels");
  if (!CHECK(labels != nullptr) || !CHECK(labels->GetNumberOfComponents() == 2) ||
    !CHECK(labels->GetNumberOfTuples() == grid->GetNumberOfCells()))
  {
    return;
  }
  std::set<Facet> seen;
  for (std::size_t c = 0; c < boundary.size(); ++c)
  {
    const Facet& f = boundary[c];
    CHECK(seen.insert(SortedIds(f)).second, c);
    const auto found = facets.find(SortedIds(f));
    if (!CHECK(found != facets.end(), c))
    {
      continue;
    }
    const auto cell = static_cast<vtkIdType>(c);
    const long long first = std::llround(labels->GetComponent(cell, 0));
    const long long second = std::llround(labels->GetComponent(cell, 1));
    const std::vector<FacetSide>& sides = found->second;
    const long long other = sides.size() == 2 ? std::min(sides[0].Label, sides[1].Label) : 0;
    const FacetSide& inner = sides.size() == 2 && sides[1].Label == first ? sides[1] : sides[0];
    CHECK(first > second && inner.Label == first && second == other, c, first, second);
    const auto at = [&mesh](vtkIdType id) { return mesh.Points[static_cast<std::size_t>(id)]; };
    CHECK(Hypervolume({ at(inner.Opposite), at(f[0]), at(f[1]), at(f[2]), at(f[3]) }) > 0.0,
      "the order of a boundary tetrahedron", c);
  }
  CheckClosed(boundary, labels);
}

} // namespace

void CheckPentatopeMesh(vtkImageToPentatopeMeshFilter* filter)
{
  CHECK(filter->GetErrorMessage().empty(), filter->GetErrorMessage());
  if (!CHECK(filter->GetOutput()->GetNumberOfCells() > 0))
  {
    return;
  }
  const Pentatopes mesh = ReadPentatopes(filter->GetOutput());
  CheckCells(mesh);
  CheckBoundary(filter->GetBoundary(), mesh);
  vtkDataArray* label = filter->GetOutput()->GetCellData()->GetArray("Label");
  vtkDataArray* labels = filter->GetBoundary()->GetCellData()->GetArray("Labels");
  CHECK(label && labels && label->GetDataType() == labels->GetDataType());
}

bool SamePentatopeMesh(vtkImageToPentatopeMeshFilter* a, vtkImageToPentatopeMeshFilter* b)
{
  const auto sameGrid = [](vtkUnstructuredGrid* c, vtkUnstructuredGrid* d)
  { return ReadEvents(c) == ReadEvents(d) && SameMesh(c, d); };
  return sameGrid(a->GetOutput(), b->GetOutput()) && sameGrid(a->GetBoundary(), b->GetBoundary());
}

} // namespace testing
