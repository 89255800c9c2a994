// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "FilterTesting.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkDataArray.h"
#include "vtkExecutive.h"
#include "vtkImageData.h"
#include "vtkMeshingStatistics.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkUnstructuredGrid.h"

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
namespace
{

Vector Minus(const Vector& a, const Vector& b)
{
  return { a[0] - b[0], a[1] - b[1], a[2] - b[2] };
}

Vector Cross(const Vector& a, const Vector& b)
{
  return { a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0] };
}

double Dot(const Vector& a, const Vector& b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

} // namespace

double Volume(const Vector& a, const Vector& b, const Vector& c, const Vector& d)
{
  return Dot(Cross(Minus(b, a), Minus(c, a)), Minus(d, a)) / 6.0;
}

Circumball CircumballOf(const std::array<Vector, 4>& t)
{
  const Vector u = Minus(t[1], t[0]);
  const Vector v = Minus(t[2], t[0]);
  const Vector w = Minus(t[3], t[0]);
  const Vector vw = Cross(v, w);
  const Vector wu = Cross(w, u);
  const Vector uv = Cross(u, v);
  const double scale = 0.5 / Dot(u, vw);
  Vector offset;
  for (std::size_t i = 0; i < 3; ++i)
  {
    offset[i] = scale * (Dot(u, u) * vw[i] + Dot(v, v) * wu[i] + Dot(w, w) * uv[i]);
  }
  return { { t[0][0] + offset[0], t[0][1] + offset[1], t[0][2] + offset[2] },
    std::sqrt(Dot(offset, offset)) };
}

//----------------------------------------------------------------------------------------------------
std::array<Vector, 4> Tetrahedra::Corners(std::size_t cell) const
{
  const auto& c = this->Cells[cell];
  const auto at = [this](vtkIdType id) { return this->Points[static_cast<std::size_t>(id)]; };
  return { at(c[0]), at(c[1]), at(c[2]), at(c[3]) };
}

double Tetrahedra::VolumeOf(long long label) const
{
  double sum = 0.0;
  for (std::size_t c = 0; c < this->Cells.size(); ++c)
  {
    if (label == 0 || this->Labels[c] == label)
    {
      const auto t = this->Corners(c);
      sum += Volume(t[0], t[1], t[2], t[3]);
    }
  }
  return sum;
}

Vector Tetrahedra::Centroid() const
{
  Vector sum = { 0, 0, 0 };
  for (std::size_t c = 0; c < this->Cells.size(); ++c)
  {
    const auto t = this->Corners(c);
    const double volume = Volume(t[0], t[1], t[2], t[3]);
    for (std::size_t i = 0; i < 3; ++i)
    {
      sum[i] += volume * (t[0][i] + t[1][i] + t[2][i] + t[3][i]) / 4.0;
    }
  }
  const double all = this->VolumeOf();
  return { sum[0] / all, sum[1] / all, sum[2] / all };
}

Tetrahedra Read(vtkUnstructuredGrid* grid)
{
  Tetrahedra mesh;
  for (vtkIdType p = 0; p < grid->GetNumberOfPoints(); ++p)
  {
    Vector x;
    grid->GetPoint(p, x.data());
    mesh.Points.push_back(x);
  }
  vtkDataArray* labels = grid->GetCellData()->GetArray("Label");
  for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c)
  {
    if (!CHECK(grid->GetCellType(c) == VTK_TETRA, c))
    {
      return mesh;
    }
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    grid->GetCellPoints(c, count, ids);
    mesh.Cells.push_back({ ids[0], ids[1], ids[2], ids[3] });
    mesh.Labels.push_back(
      labels ? static_cast<long long>(std::llround(labels->GetComponent(c, 0))) : 0);
  }
  return mesh;
}

//----------------------------------------------------------------------------------------------------
namespace
{

using Face = std::array<vtkIdType, 3>;

struct Side
{
  long long Label;
  vtkIdType Opposite; ///< the vertex of the tetrahedron that is not on the face
};

Face Sorted(Face face)
{
  std::sort(face.begin(), face.end());
  return face;
}

std::map<Face, std::vector<Side>> FacesOf(const Tetrahedra& mesh)
{
  std::map<Face, std::vector<Side>> faces;
  for (std::size_t c = 0; c < mesh.Cells.size(); ++c)
  {
    const auto& v = mesh.Cells[c];
    for (std::size_t i = 0; i < 4; ++i)
    {
      const Face face = Sorted({ v[(i + 1) % 4], v[(i + 2) % 4], v[(i + 3) % 4] });
      faces[face].push_back({ mesh.Labels[c], v[i] });
    }
  }
  return faces;
}

void CheckArrays(vtkUnstructuredGrid* grid, vtkPolyData* interfaces)
{
  vtkDataArray* label = grid->GetCellData()->GetArray("Label");
  if (CHECK(label != nullptr))
  {
    CHECK(label->GetNumberOfComponents() == 1);
    CHECK(label->GetNumberOfTuples() == grid->GetNumberOfCells());
    CHECK(grid->GetCellData()->GetScalars() == label);
  }
  vtkDataArray* labels = interfaces->GetCellData()->GetArray("Labels");
  if (CHECK(labels != nullptr))
  {
    CHECK(labels->GetNumberOfComponents() == 2);
    CHECK(labels->GetNumberOfTuples() == interfaces->GetNumberOfCells());
    CHECK(label == nullptr || labels->GetDataType() == label->GetDataType());
  }
  CHECK(grid->GetPoints()->GetDataType() == VTK_DOUBLE);
  CHECK(interfaces->GetPoints()->GetDataType() == VTK_DOUBLE);
}

void CheckPoints(const Tetrahedra& mesh)
{
  std::vector<char> used(mesh.Points.size(), 0);
  for (const auto& cell : mesh.Cells)
  {
    for (const vtkIdType id : cell)
    {
      used[static_cast<std::size_t>(id)] = 1;
    }
  }
  CHECK(std::find(used.begin(), used.end(), 0) == used.end());
  CHECK(std::set<Vector>(mesh.Points.begin(), mesh.Points.end()).size() == mesh.Points.size());
}

/** Returns the face in the volume mesh's points. */
Face CheckInterfaceCell(
  vtkPolyData* interfaces, vtkDataArray* pointIds, vtkIdType cell, const Tetrahedra& mesh)
{
  vtkIdType count = 0;
  const vtkIdType* ids = nullptr;
  interfaces->GetCellPoints(cell, count, ids);
  Face face = { -1, -1, -1 };
  if (!CHECK(count == 3, cell))
  {
    return face;
  }
  for (std::size_t i = 0; i < 3; ++i)
  {
    face[i] = static_cast<vtkIdType>(pointIds->GetComponent(ids[i], 0));
    Vector x;
    interfaces->GetPoint(ids[i], x.data());
    CHECK(x == mesh.Points[static_cast<std::size_t>(face[i])], cell, i);
  }
  return face;
}

void CheckInterfaces(vtkPolyData* interfaces, const Tetrahedra& mesh)
{
  const auto faces = FacesOf(mesh);
  std::size_t expected = 0;
  for (const auto& [face, sides] : faces)
  {
    CHECK(sides.size() <= 2, "a face of more than two tetrahedra");
    expected += sides.size() == 1 || sides[0].Label != sides[1].Label ? 1 : 0;
  }
  CHECK(static_cast<std::size_t>(interfaces->GetNumberOfCells()) == expected,
    interfaces->GetNumberOfCells(), expected);

  vtkDataArray* pointIds = interfaces->GetPointData()->GetArray("PointIds");
  vtkDataArray* labels = interfaces->GetCellData()->GetArray("Labels");
  if (!CHECK(pointIds != nullptr) || labels == nullptr)
  {
    return;
  }
  std::set<Face> seen;
  std::set<vtkIdType> used;
  for (vtkIdType c = 0; c < interfaces->GetNumberOfCells(); ++c)
  {
    const Face face = CheckInterfaceCell(interfaces, pointIds, c, mesh);
    used.insert(face.begin(), face.end());
    CHECK(seen.insert(Sorted(face)).second, c);
    const auto found = faces.find(Sorted(face));
    if (!CHECK(found != faces.end(), c))
    {
      continue;
    }
    const auto first = static_cast<long long>(labels->GetComponent(c, 0));
    const auto second = static_cast<long long>(labels->GetComponent(c, 1));
    const std::vector<Side>& sides = found->second;
    const long long other = sides.size() == 2 ? std::min(sides[0].Label, sides[1].Label) : 0;
    const Side& inner = sides.size() == 2 && sides[1].Label == first ? sides[1] : sides[0];
    CHECK(first > second && inner.Label == first && second == other, c, first, second);
    const auto at = [&mesh](vtkIdType id) { return mesh.Points[static_cast<std::size_t>(id)]; };
    CHECK(Volume(at(face[0]), at(face[1]), at(face[2]), at(inner.Opposite)) < 0.0,
      "the normal must point out of the first label", c);
  }
  CHECK(static_cast<vtkIdType>(used.size()) == interfaces->GetNumberOfPoints());
}

} // namespace

void CheckMesh(vtkImageToTetMeshFilter* filter)
{
  CHECK(filter->GetErrorMessage().empty(), filter->GetErrorMessage());
  vtkUnstructuredGrid* grid = filter->GetOutput();
  vtkPolyData* interfaces = filter->GetInterfaces();
  if (!CHECK(grid->GetNumberOfCells() > 0))
  {
    return;
  }
  CheckArrays(grid, interfaces);
  const Tetrahedra mesh = Read(grid);
  double smallest = VTK_DOUBLE_MAX;
  for (std::size_t c = 0; c < mesh.Cells.size(); ++c)
  {
    const auto t = mesh.Corners(c);
    smallest = std::min(smallest, Volume(t[0], t[1], t[2], t[3]));
  }
  CHECK(smallest > 0.0, smallest);
  CHECK(std::count(mesh.Labels.begin(), mesh.Labels.end(), 0) == 0);
  CheckPoints(mesh);
  CheckInterfaces(interfaces, mesh);
}

//----------------------------------------------------------------------------------------------------
namespace
{

bool SameArray(vtkDataArray* a, vtkDataArray* b)
{
  if (a == nullptr || b == nullptr)
  {
    return a == b;
  }
  if (a->GetNumberOfTuples() != b->GetNumberOfTuples() ||
    a->GetNumberOfComponents() != b->GetNumberOfComponents())
  {
    return false;
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

vtkDataArray* Coordinates(vtkPointSet* mesh)
{
  return mesh->GetPoints() ? mesh->GetPoints()->GetData() : nullptr;
}

} // namespace

bool SameMesh(vtkUnstructuredGrid* a, vtkUnstructuredGrid* b)
{
  return SameArray(Coordinates(a), Coordinates(b)) &&
    SameArray(a->GetCells()->GetConnectivityArray(), b->GetCells()->GetConnectivityArray()) &&
    SameArray(a->GetCellData()->GetArray("Label"), b->GetCellData()->GetArray("Label"));
}

bool SameMesh(vtkPolyData* a, vtkPolyData* b)
{
  return SameArray(Coordinates(a), Coordinates(b)) &&
    SameArray(a->GetPolys()->GetConnectivityArray(), b->GetPolys()->GetConnectivityArray()) &&
    SameArray(a->GetCellData()->GetArray("Labels"), b->GetCellData()->GetArray("Labels"));
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
