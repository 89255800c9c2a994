// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "FilterTesting.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkDataArray.h"
#include "vtkExecutive.h"
#include "vtkIdList.h"
#include "vtkImageData.h"
#include "vtkImageToPentatopeMeshFilter.h"
#include "vtkMeshingStatistics.h"
#include "vtkNew.h"
#include "vtkPointData.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <set>

namespace testing
{

int& Failures()
{
  static int failures = 0;
  return failures;
}

int Result()
{
  if (Failures() > 0)
  {
    std::cerr << Failures() << " check(s) failed\n";
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}

//----------------------------------------------------------------------------------------------------
vtkSmartPointer<vtkImageData> MakeImage(
  const Placement& placement, const std::function<double(const Vector& x)>& label, int type)
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetExtent(const_cast<int*>(placement.Extent.data()));
  image->SetOrigin(placement.Origin.data());
  image->SetSpacing(placement.Spacing.data());
  image->SetDirectionMatrix(placement.Direction.data());

  auto scalars = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(type));
  scalars->SetName("Segmentation");
  const auto& e = placement.Extent;
  const int less = placement.Cells ? 1 : 0;
  for (int k = e[4]; k <= e[5] - less; ++k)
  {
    for (int j = e[2]; j <= e[3] - less; ++j)
    {
      for (int i = e[0]; i <= e[1] - less; ++i)
      {
        const double half = placement.Cells ? 0.5 : 0.0;
        const double index[3] = { i + half, j + half, k + half };
        Vector x;
        image->TransformContinuousIndexToPhysicalPoint(index, x.data());
        scalars->InsertNextTuple1(label(x));
      }
    }
  }
  if (placement.Cells)
  {
    image->GetCellData()->SetScalars(scalars);
  }
  else
  {
    image->GetPointData()->SetScalars(scalars);
  }
  return image;
}

namespace
{
bool InBall(const Vector& x, double radius)
{
  const double centre = 15.5;
  return std::hypot(x[0] - centre, x[1] - centre, x[2] - centre) < radius;
}
} // namespace

vtkSmartPointer<vtkImageData> MakeBall(double radius, double label)
{
  return MakeImage(
    {}, [=](const Vector& x) { return InBall(x, radius) ? label : 0.0; }, VTK_DOUBLE);
}

vtkSmartPointer<vtkImageData> MakeTwoLabels(double radius)
{
  return MakeImage(
    {}, [=](const Vector& x) { return InBall(x, radius) ? (x[0] < 15.5 ? 1.0 : 2.0) : 0.0; });
}

vtkSmartPointer<vtkImageToTetMeshFilter> MakeFilter(vtkImageData* image)
{
  auto filter = vtkSmartPointer<vtkImageToTetMeshFilter>::New();
  filter->SetInputData(image);
  filter->SetNumberOfThreads(1);
  return filter;
}

//----------------------------------------------------------------------------------------------------
void ErrorCollector::Execute(vtkObject* caller, unsigned long, void* data)
{
  const char* text = static_cast<const char*>(data);
  (caller == this->Filter ? this->FromFilter : this->FromOthers).emplace_back(text ? text : "");
}

void ErrorCollector::Watch(vtkAlgorithm* algorithm)
{
  this->Filter = algorithm;
  for (const auto event : { vtkCommand::ErrorEvent, vtkCommand::WarningEvent })
  {
    algorithm->AddObserver(event, this);
    algorithm->GetExecutive()->AddObserver(event, this);
  }
}

void ExpectError(const char* name, vtkImageToSimplexMeshFilter* filter,
  const std::vector<std::string>& words, const std::function<void()>& repair)
{
  const auto errors = vtkSmartPointer<ErrorCollector>::Take(ErrorCollector::New());
  errors->Watch(filter);
  const int updated = filter->GetExecutive()->Update();
  CHECK(updated == 0, name);
  if (CHECK(errors->FromFilter.size() == 1, name, errors->FromFilter.size()))
  {
    const std::string& text = errors->FromFilter.front();
    for (const std::string& word : words)
    {
      CHECK(text.find(word) != std::string::npos, name, word, text);
    }
    CHECK(text.find(filter->GetErrorMessage()) != std::string::npos, name);
  }
  CHECK(!filter->GetErrorMessage().empty(), name);
  CHECK(!filter->GetAborted(), name);
  CHECK(Empty(filter), name);
  CHECK(filter->GetStatistics()->GetNumberOfElements() == 0, name);
  filter->RemoveObserver(errors);
  filter->GetExecutive()->RemoveObserver(errors);
  if (repair)
  {
    repair();
    filter->Update();
    CHECK(filter->GetErrorMessage().empty(), name, filter->GetErrorMessage());
    CHECK(filter->GetOutput()->GetNumberOfCells() > 0, name);
  }
}

namespace
{

class ProgressCommand : public vtkCommand
{
public:
  static ProgressCommand* New() { return new ProgressCommand; }
  std::function<void(vtkAlgorithm*, double)> Function;
  void Execute(vtkObject* caller, unsigned long, void* data) override
  {
    this->Function(static_cast<vtkAlgorithm*>(caller), *static_cast<double*>(data));
  }
};

} // namespace

vtkSmartPointer<vtkCommand> Observe(
  vtkAlgorithm* filter, std::function<void(vtkAlgorithm*, double)> function)
{
  auto command = vtkSmartPointer<ProgressCommand>::Take(ProgressCommand::New());
  command->Function = std::move(function);
  filter->AddObserver(vtkCommand::ProgressEvent, command);
  return command;
}

//----------------------------------------------------------------------------------------------------
template <std::size_t D>
double Volume(const Simplex<D>& simplex)
{
  std::array<std::array<double, D>, D> m;
  double volume = 1.0;
  for (std::size_t i = 0; i < D; ++i)
  {
    for (std::size_t j = 0; j < D; ++j)
    {
      m[i][j] = simplex[i + 1][j] - simplex[0][j];
    }
    volume /= static_cast<double>(i + 1);
  }
  for (std::size_t k = 0; k < D; ++k)
  {
    std::size_t pivot = k;
    for (std::size_t i = k; i < D; ++i)
    {
      pivot = std::abs(m[i][k]) > std::abs(m[pivot][k]) ? i : pivot;
    }
    volume *= pivot == k ? m[k][k] : -m[pivot][k];
    if (volume == 0.0)
    {
      return 0.0;
    }
    std::swap(m[k], m[pivot]);
    for (std::size_t i = k + 1; i < D; ++i)
    {
      const double factor = m[i][k] / m[k][k];
      for (std::size_t j = k; j < D; ++j)
      {
        m[i][j] -= factor * m[k][j];
      }
    }
  }
  return volume;
}
template double Volume<3>(const Simplex<3>&);
template double Volume<4>(const Simplex<4>&);

//----------------------------------------------------------------------------------------------------
template <std::size_t D>
Simplex<D> Simplices<D>::Corners(std::size_t cell) const
{
  Simplex<D> corners;
  for (std::size_t i = 0; i <= D; ++i)
  {
    corners[i] = this->Points[static_cast<std::size_t>(this->Cells[cell][i])];
  }
  return corners;
}

template <std::size_t D>
double Simplices<D>::VolumeOf(long long label) const
{
  double sum = 0.0;
  for (std::size_t c = 0; c < this->Cells.size(); ++c)
  {
    sum += label == 0 || this->Labels[c] == label ? Volume<D>(this->Corners(c)) : 0.0;
  }
  return sum;
}

template <std::size_t D>
std::array<double, D> Simplices<D>::Centroid() const
{
  std::array<double, D> centroid = {};
  const double all = this->VolumeOf();
  for (std::size_t c = 0; c < this->Cells.size(); ++c)
  {
    const Simplex<D> corners = this->Corners(c);
    for (const auto& corner : corners)
    {
      for (std::size_t i = 0; i < D; ++i)
      {
        centroid[i] += Volume<D>(corners) / all * corner[i] / (D + 1);
      }
    }
  }
  return centroid;
}
template struct Simplices<3>;
template struct Simplices<4>;

namespace
{

template <std::size_t N>
using Ids = std::array<vtkIdType, N>;

template <std::size_t N>
Ids<N> Sorted(Ids<N> ids)
{
  std::sort(ids.begin(), ids.end());
  return ids;
}

template <std::size_t N>
Ids<N - 1> Without(const Ids<N>& ids, std::size_t left)
{
  Ids<N - 1> rest;
  std::copy(ids.begin() + left + 1, ids.end(), std::copy_n(ids.begin(), left, rest.begin()));
  return rest;
}

template <std::size_t D>
std::vector<std::array<double, D>> ReadPoints(vtkPointSet* mesh)
{
  std::vector<std::array<double, D>> points(static_cast<std::size_t>(mesh->GetNumberOfPoints()));
  vtkDataArray* times = mesh->GetPointData()->GetArray("Time");
  if (D == 4 &&
    (!CHECK(times != nullptr) || !CHECK(times->GetDataType() == VTK_DOUBLE) ||
      !CHECK(times->GetNumberOfComponents() == 1) ||
      !CHECK(times->GetNumberOfTuples() == mesh->GetNumberOfPoints())))
  {
    return points;
  }
  for (std::size_t p = 0; p < points.size(); ++p)
  {
    mesh->GetPoint(static_cast<vtkIdType>(p), points[p].data());
    if constexpr (D == 4)
    {
      points[p][3] = times->GetComponent(static_cast<vtkIdType>(p), 0);
    }
  }
  return points;
}

/** Cells that must all be of this type and have so many points. */
template <std::size_t N>
std::vector<Ids<N>> ReadCells(vtkPointSet* mesh, int type)
{
  std::vector<Ids<N>> cells;
  vtkNew<vtkIdList> ids;
  for (vtkIdType c = 0; c < mesh->GetNumberOfCells(); ++c)
  {
    mesh->GetCellPoints(c, ids);
    if (!CHECK(mesh->GetCellType(c) == type && ids->GetNumberOfIds() == N, c))
    {
      break;
    }
    std::copy(ids->begin(), ids->end(), cells.emplace_back().begin());
  }
  return cells;
}

template <std::size_t D>
Simplices<D> ReadMesh(vtkUnstructuredGrid* grid)
{
  Simplices<D> mesh;
  mesh.Points = ReadPoints<D>(grid);
  mesh.Cells = ReadCells<D + 1>(grid, D == 4 ? VTK_POLY_VERTEX : VTK_TETRA);
  vtkDataArray* labels = grid->GetCellData()->GetArray("Label");
  for (std::size_t c = 0; c < mesh.Cells.size(); ++c)
  {
    mesh.Labels.push_back(
      labels ? std::llround(labels->GetComponent(static_cast<vtkIdType>(c), 0)) : 0);
  }
  return mesh;
}

} // namespace

Tetrahedra Read(vtkUnstructuredGrid* grid)
{
  return ReadMesh<3>(grid);
}

Pentatopes ReadPentatopes(vtkUnstructuredGrid* grid)
{
  return ReadMesh<4>(grid);
}

//----------------------------------------------------------------------------------------------------
namespace
{

bool HasComponents(vtkDataArray* array, int components, vtkPointSet* mesh)
{
  return CHECK(array != nullptr) && CHECK(array->GetNumberOfComponents() == components) &&
    CHECK(array->GetNumberOfTuples() == mesh->GetNumberOfCells());
}

template <std::size_t D>
void CheckCells(const Simplices<D>& mesh)
{
  std::vector<char> used(mesh.Points.size(), 0);
  for (std::size_t c = 0; c < mesh.Cells.size(); ++c)
  {
    const double volume = Volume<D>(mesh.Corners(c));
    CHECK(volume > 0.0, c, volume);
    CHECK(mesh.Labels[c] != 0, c);
    for (const vtkIdType id : mesh.Cells[c])
    {
      used[static_cast<std::size_t>(id)] = 1;
    }
  }
  CHECK(std::count(used.begin(), used.end(), 0) == 0);
  const std::set points(mesh.Points.begin(), mesh.Points.end());
  CHECK(points.size() == mesh.Points.size());
}

/** The boundary's cells in the mesh's points; checks that these are the same points, and all used. */
template <std::size_t D>
std::vector<Ids<D>> ReadBoundary(vtkPointSet* boundary, const Simplices<D>& mesh)
{
  vtkDataArray* pointIds = boundary->GetPointData()->GetArray("PointIds");
  if (!CHECK(pointIds != nullptr) || !CHECK(pointIds->GetDataType() == VTK_ID_TYPE))
  {
    return {};
  }
  const auto meshId = [pointIds](vtkIdType p)
  { return static_cast<vtkIdType>(pointIds->GetComponent(p, 0)); };
  const auto points = ReadPoints<D>(boundary);
  for (std::size_t p = 0; p < points.size(); ++p)
  {
    const vtkIdType id = meshId(static_cast<vtkIdType>(p));
    CHECK(points[p] == mesh.Points[static_cast<std::size_t>(id)], p);
  }
  auto facets = ReadCells<D>(boundary, D == 4 ? VTK_TETRA : VTK_TRIANGLE);
  std::set<vtkIdType> used;
  for (Ids<D>& facet : facets)
  {
    used.insert(facet.begin(), facet.end());
    std::transform(facet.begin(), facet.end(), facet.begin(), meshId);
  }
  CHECK(used.size() == points.size());
  return facets;
}

template <std::size_t D>
void CheckBoundary(vtkPointSet* boundary, vtkDataArray* labels, const Simplices<D>& mesh)
{
  struct Side
  {
    long long Label;
    vtkIdType Opposite; ///< the vertex of the simplex that is not on the facet
  };
  std::map<Ids<D>, std::vector<Side>> sidesOf;
  for (std::size_t c = 0; c < mesh.Cells.size(); ++c)
  {
    for (std::size_t i = 0; i <= D; ++i)
    {
      sidesOf[Sorted(Without(mesh.Cells[c], i))].push_back({ mesh.Labels[c], mesh.Cells[c][i] });
    }
  }
  std::size_t expected = 0;
  for (const auto& [facet, sides] : sidesOf)
  {
    CHECK(sides.size() <= 2, "a facet of more than two simplices");
    expected += sides.size() == 1 || sides[0].Label != sides[1].Label ? 1 : 0;
  }
  const auto facets = ReadBoundary<D>(boundary, mesh);
  CHECK(facets.size() == expected, facets.size(), expected);

  std::set<Ids<D>> seen;
  std::map<std::pair<long long, Ids<D - 1>>, int> ridges; // around each label
  for (std::size_t c = 0; c < facets.size(); ++c)
  {
    const auto cell = static_cast<vtkIdType>(c);
    const long long first = std::llround(labels->GetComponent(cell, 0));
    const long long second = std::llround(labels->GetComponent(cell, 1));
    for (std::size_t i = 0; i < D; ++i)
    {
      ++ridges[{ first, Sorted(Without(facets[c], i)) }];
      ++ridges[{ second, Sorted(Without(facets[c], i)) }];
    }
    CHECK(seen.insert(Sorted(facets[c])).second, c);
    const auto found = sidesOf.find(Sorted(facets[c]));
    if (!CHECK(found != sidesOf.end(), c))
    {
      continue;
    }
    const std::vector<Side>& sides = found->second;
    const long long other = sides.size() == 2 ? std::min(sides[0].Label, sides[1].Label) : 0;
    const Side& inner = sides.size() == 2 && sides[1].Label == first ? sides[1] : sides[0];
    CHECK(first > second && inner.Label == first && second == other, c, first, second);
    Simplex<D> corners = { mesh.Points[static_cast<std::size_t>(inner.Opposite)] };
    for (std::size_t i = 0; i < D; ++i)
    {
      corners[i + 1] = mesh.Points[static_cast<std::size_t>(facets[c][i])];
    }
    CHECK(Volume<D>(corners) > 0.0, "the normal must point out of the first label", c);
  }
  CHECK(std::all_of(
    ridges.begin(), ridges.end(), [](const auto& ridge) { return ridge.second % 2 == 0; }));
}

template <std::size_t D>
void CheckOutputs(vtkUnstructuredGrid* grid, vtkPointSet* boundary)
{
  vtkDataArray* label = grid->GetCellData()->GetArray("Label");
  vtkDataArray* labels = boundary->GetCellData()->GetArray("Labels");
  if (!CHECK(grid->GetNumberOfCells() > 0) || !HasComponents(label, 1, grid) ||
    !HasComponents(labels, 2, boundary))
  {
    return;
  }
  CHECK(grid->GetCellData()->GetScalars() == label);
  CHECK(labels->GetDataType() == label->GetDataType());
  CHECK(grid->GetPoints()->GetDataType() == VTK_DOUBLE);
  CHECK(boundary->GetPoints()->GetDataType() == VTK_DOUBLE);
  const Simplices<D> mesh = ReadMesh<D>(grid);
  CheckCells<D>(mesh);
  CheckBoundary<D>(boundary, labels, mesh);
}

} // namespace

void CheckMesh(vtkImageToSimplexMeshFilter* filter)
{
  CHECK(filter->GetErrorMessage().empty(), filter->GetErrorMessage());
  const auto check =
    vtkImageToPentatopeMeshFilter::SafeDownCast(filter) ? CheckOutputs<4> : CheckOutputs<3>;
  check(filter->GetOutput(), vtkPointSet::SafeDownCast(filter->GetOutputDataObject(1)));
}

//----------------------------------------------------------------------------------------------------
namespace
{

/** Numbers that two meshes of the same bits have in common. */
std::vector<vtkDataArray*> ArraysOf(vtkPointSet* mesh)
{
  auto* const grid = vtkUnstructuredGrid::SafeDownCast(mesh);
  auto* const cells = grid ? grid->GetCells() : vtkPolyData::SafeDownCast(mesh)->GetPolys();
  vtkCellData* data = mesh->GetCellData();
  return { mesh->GetPoints() ? mesh->GetPoints()->GetData() : nullptr,
    cells->GetConnectivityArray(), data->GetArray("Label"), data->GetArray("Labels"),
    mesh->GetPointData()->GetArray("Time") };
}

bool SameArray(vtkDataArray* a, vtkDataArray* b)
{
  if (a == nullptr || b == nullptr || a->GetNumberOfTuples() != b->GetNumberOfTuples() ||
    a->GetNumberOfComponents() != b->GetNumberOfComponents())
  {
    return a == b;
  }
  for (vtkIdType t = 0; t < a->GetNumberOfTuples(); ++t)
  {
    for (int c = 0; c < a->GetNumberOfComponents(); ++c)
    {
      if (a->GetComponent(t, c) != b->GetComponent(t, c))
      {
        return false;
      }
    }
  }
  return true;
}

} // namespace

bool SameMesh(vtkPointSet* a, vtkPointSet* b)
{
  const auto first = ArraysOf(a);
  return std::equal(first.begin(), first.end(), ArraysOf(b).begin(), SameArray);
}

bool SameMesh(vtkImageToSimplexMeshFilter* a, vtkImageToSimplexMeshFilter* b)
{
  const auto output = [](vtkAlgorithm* filter, int port)
  { return vtkPointSet::SafeDownCast(filter->GetOutputDataObject(port)); };
  return SameMesh(output(a, 0), output(b, 0)) && SameMesh(output(a, 1), output(b, 1));
}

bool Empty(vtkImageToSimplexMeshFilter* filter)
{
  for (int port = 0; port < filter->GetNumberOfOutputPorts(); ++port)
  {
    const auto output = vtkDataSet::SafeDownCast(filter->GetOutputDataObject(port));
    if (output->GetNumberOfCells() != 0 || output->GetNumberOfPoints() != 0)
    {
      return false;
    }
  }
  return true;
}

} // namespace testing
