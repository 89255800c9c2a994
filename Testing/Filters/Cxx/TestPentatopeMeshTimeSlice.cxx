// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Slices of a pentatope mesh in a temporal pipeline: times, executions, arrays, errors, abort.
#include "FilterTesting.h"
#include "SpaceTimeLattice.h"

#include "vtkCallbackCommand.h"
#include "vtkCell.h"
#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkFloatArray.h"
#include "vtkInformation.h"
#include "vtkInformationDoubleVectorKey.h"
#include "vtkInformationVector.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPentatopeMeshTimeSlice.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkStringArray.h"
#include "vtkUnstructuredGrid.h"
#include "vtkUnstructuredGridAlgorithm.h"

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

using namespace testing;

namespace
{

using Pipeline = vtkStreamingDemandDrivenPipeline;

/** A mesh from a pipeline; counts how often it is made, and what it is asked for. */
class MeshSource : public vtkUnstructuredGridAlgorithm
{
public:
  static MeshSource* New();
  vtkTypeMacro(MeshSource, vtkUnstructuredGridAlgorithm);

  bool IsEmpty = false;
  bool KnowsRange = false; ///< announces MESH_TIME_RANGE
  bool IsTemporal = false; ///< announces times that have nothing to do with the mesh
  int Executions = 0;
  int TimeRequests = 0; ///< executions for a certain time

protected:
  MeshSource() { this->SetNumberOfInputPorts(0); }
  int RequestInformation(
    vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector) override
  {
    vtkInformation* info = outputVector->GetInformationObject(0);
    const double range[2] = { 0.0, 2.0 };
    const double steps[3] = { 50.0, 60.0, 70.0 };
    if (this->KnowsRange)
    {
      info->Set(vtkPentatopeMeshTimeSlice::MESH_TIME_RANGE(), range, 2);
    }
    if (this->IsTemporal)
    {
      info->Set(Pipeline::TIME_STEPS(), steps, 3);
      info->Set(Pipeline::TIME_RANGE(), steps + 1, 2);
    }
    return 1;
  }
  int RequestData(
    vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector) override
  {
    ++this->Executions;
    vtkInformation* info = outputVector->GetInformationObject(0);
    this->TimeRequests += info->Has(Pipeline::UPDATE_TIME_STEP()) ? 1 : 0;
    if (!this->IsEmpty)
    {
      vtkUnstructuredGrid::GetData(outputVector)->ShallowCopy(MakePentatopes());
    }
    return 1;
  }
};
vtkStandardNewMacro(MeshSource);

/** Hands on the mesh and its range. */
class PassMesh : public vtkUnstructuredGridAlgorithm
{
public:
  static PassMesh* New();
  vtkTypeMacro(PassMesh, vtkUnstructuredGridAlgorithm);

protected:
  int RequestInformation(vtkInformation*, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override
  {
    outputVector->GetInformationObject(0)->CopyEntry(
      inputVector[0]->GetInformationObject(0), vtkPentatopeMeshTimeSlice::MESH_TIME_RANGE());
    return 1;
  }
  int RequestData(vtkInformation*, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override
  {
    vtkUnstructuredGrid::GetData(outputVector)
      ->ShallowCopy(vtkUnstructuredGrid::GetData(inputVector[0]));
    return 1;
  }
};
vtkStandardNewMacro(PassMesh);

void CheckRange(vtkPentatopeMeshTimeSlice* filter)
{
  vtkInformation* info = filter->GetOutputInformation(0);
  CHECK(!info->Has(Pipeline::TIME_STEPS()));
  if (CHECK(info->Length(Pipeline::TIME_RANGE()) == 2))
  {
    CHECK(info->Get(Pipeline::TIME_RANGE())[0] == 0.0);
    CHECK(info->Get(Pipeline::TIME_RANGE())[1] == 2.0);
  }
}

/** Thirty times, one mesh. */
void TestPlayback(bool knowsRange, bool isTemporal)
{
  vtkNew<MeshSource> source;
  source->KnowsRange = knowsRange;
  source->IsTemporal = isTemporal;
  vtkNew<vtkPentatopeMeshTimeSlice> filter;
  filter->SetInputConnection(source->GetOutputPort());
  int slices = 0;
  vtkNew<vtkCallbackCommand> counter;
  counter->SetClientData(&slices);
  counter->SetCallback(
    [](vtkObject*, unsigned long, void* data, void*) { ++*static_cast<int*>(data); });
  filter->AddObserver(vtkCommand::StartEvent, counter);

  filter->UpdateInformation();
  CheckRange(filter);
  CHECK(source->Executions == (knowsRange ? 0 : 1), source->Executions);
  CHECK(slices == 0, slices);
  for (int i = 0; i < 30; ++i)
  {
    const double time = 2.0 * i / 29.0;
    filter->UpdateTimeStep(time);
    CheckSlice(filter, time);
    filter->UpdateTimeStep(time);
    CHECK(slices == i + 1, slices, i);
  }
  CHECK(source->Executions == 1, source->Executions);
  CHECK(source->TimeRequests == 0, source->TimeRequests);
  CheckRange(filter);

  filter->Modified();
  filter->UpdateTimeStep(1.3);
  CheckSlice(filter, 1.3);
  CHECK(source->Executions == 1, source->Executions);
  source->Modified();
  filter->UpdateTimeStep(1.3);
  CheckSlice(filter, 1.3);
  CHECK(source->Executions == 2, source->Executions);
  CHECK(source->TimeRequests == 0, source->TimeRequests);
}

/** The request for a time does not get past the filter before the mesh either. */
void TestLongPipeline()
{
  for (const bool knowsRange : { false, true })
  {
    vtkNew<MeshSource> source;
    source->KnowsRange = knowsRange;
    source->IsTemporal = true;
    vtkNew<PassMesh> pass;
    pass->SetInputConnection(source->GetOutputPort());
    vtkNew<vtkPentatopeMeshTimeSlice> filter;
    filter->SetInputConnection(pass->GetOutputPort());
    for (const double time : { 0.5, 1.5 })
    {
      filter->UpdateTimeStep(time);
      CheckSlice(filter, time);
    }
    CHECK(source->Executions == 1, source->Executions);
    CHECK(source->TimeRequests == 0, source->TimeRequests);
    // Somebody else asks the source for a time; that is forgotten.
    source->Modified();
    source->UpdateTimeStep(60.0);
    CHECK(source->TimeRequests == 1, source->TimeRequests);
    source->Modified();
    vtkNew<vtkPentatopeMeshTimeSlice> direct;
    direct->SetInputConnection(source->GetOutputPort());
    direct->UpdateTimeStep(0.5);
    CheckSlice(direct, 0.5);
    CHECK(source->TimeRequests == 1, source->TimeRequests);
  }
}

/** Nothing to cut, and nothing known of its times. */
void TestEmpty()
{
  vtkNew<MeshSource> source;
  source->IsEmpty = true;
  source->IsTemporal = true;
  vtkNew<vtkPentatopeMeshTimeSlice> filter;
  filter->SetInputConnection(source->GetOutputPort());
  filter->Update();
  CHECK(filter->GetOutput()->GetNumberOfCells() == 0);
  CHECK(filter->GetErrorMessage().empty(), filter->GetErrorMessage());
  CHECK(!filter->GetOutputInformation(0)->Has(Pipeline::TIME_RANGE()));
}

/** An error of the executive's, and nothing worse. */
void TestWithoutInput()
{
  vtkNew<vtkPentatopeMeshTimeSlice> filter;
  vtkNew<ErrorCollector> errors;
  errors->Watch(filter);
  filter->UpdateTimeStep(1.0);
  CHECK(errors->FromOthers.size() > 0);
  CHECK(filter->GetOutput()->GetNumberOfCells() == 0);
}

void TestTimes()
{
  vtkNew<vtkPentatopeMeshTimeSlice> filter;
  filter->SetInputData(MakePentatopes());
  filter->Update();
  CheckRange(filter);
  CheckSlice(filter, 0.0);
  filter->SetSliceTime(0.7);
  filter->Update();
  CheckSlice(filter, 0.7);
  filter->SetSliceTime(2.0);
  filter->Update();
  CheckSlice(filter, 2.0);
  filter->SetSliceTime(17.0);
  filter->Update();
  CheckSlice(filter, 2.0);
  filter->UpdateTimeStep(1.0); // wins
  CheckSlice(filter, 1.0);
  filter->UpdateTimeStep(-3.0);
  CheckSlice(filter, 0.0);
  filter->UpdateTimeStep(1e30);
  CheckSlice(filter, 2.0);
  filter->GetOutputInformation(0)->Remove(Pipeline::UPDATE_TIME_STEP());
  filter->SetSliceTime(std::nan(""));
  filter->Update();
  CheckSlice(filter, 0.0);
  const vtkMTimeType before = filter->GetMTime();
  filter->SetSliceTime(std::nan(""));
  filter->SetTimeArrayName("Time");
  CHECK(filter->GetMTime() == before);
}

void TestData()
{
  vtkNew<vtkPentatopeMeshTimeSlice> filter;
  const auto mesh = MakePentatopes();
  filter->SetInputData(mesh);
  std::set<int> types;
  for (const double time : { 0.0, 0.3, 1.0, 1.6, 2.0 })
  {
    filter->UpdateTimeStep(time);
    vtkUnstructuredGrid* slice = filter->GetOutput();
    CHECK(slice->GetPoints()->GetDataType() == VTK_DOUBLE);
    vtkPointData* pointData = slice->GetPointData();
    CHECK(pointData->GetNumberOfArrays() == 1, pointData->GetNumberOfArrays());
    vtkDataArray* field = pointData->GetArray("Field");
    if (CHECK(field && field->GetNumberOfTuples() == slice->GetNumberOfPoints()))
    {
      for (vtkIdType i = 0; i < slice->GetNumberOfPoints(); ++i)
      {
        const double* x = slice->GetPoint(i);
        CHECK(Near(field->GetComponent(i, 0), Linear(x[0], x[1], x[2], time)), time, i);
      }
    }
    vtkDataArray* labels = slice->GetCellData()->GetScalars();
    CHECK(slice->GetCellData()->GetNumberOfArrays() == 1);
    if (CHECK(labels && std::string(labels->GetName()) == "Label"))
    {
      CHECK(vtkIntArray::SafeDownCast(labels) != nullptr);
      CHECK(labels->GetNumberOfTuples() == slice->GetNumberOfCells());
    }
    CHECK(slice->GetFieldData()->GetAbstractArray("SPACE") != nullptr);
    for (vtkIdType c = 0; c < slice->GetNumberOfCells(); ++c)
    {
      types.insert(slice->GetCellType(c));
    }
  }
  CHECK(types == std::set<int>({ VTK_TETRA, VTK_WEDGE }), types.size());
  CHECK(mesh->GetPointData()->GetNumberOfArrays() == 3, "the input stays as it is");
}

/** One pentatope with an edge before the time, and more and more of the other points at it. */
void TestPointsAtTheTime()
{
  const std::array<int, 4> expected = { VTK_WEDGE, VTK_PYRAMID, VTK_TETRA, VTK_EMPTY_CELL };
  for (std::size_t atTheTime = 0; atTheTime < expected.size(); ++atTheTime)
  {
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    points->InsertNextPoint(0, 0, 0);
    points->InsertNextPoint(0, 0, 1);
    points->InsertNextPoint(1, 0, 0);
    points->InsertNextPoint(0, 1, 0);
    points->InsertNextPoint(0, 0, 0);
    vtkNew<vtkDoubleArray> times;
    times->SetName("Time");
    for (std::size_t i = 0; i < 5; ++i)
    {
      times->InsertNextValue(i < 2 ? -1.0 : i < 2 + atTheTime ? 0.0 : 1.0);
    }
    vtkNew<vtkUnstructuredGrid> mesh;
    mesh->SetPoints(points);
    mesh->GetPointData()->AddArray(times);
    const std::array<vtkIdType, 5> ids = { 0, 1, 2, 3, 4 };
    mesh->InsertNextCell(VTK_POLY_VERTEX, 5, ids.data());
    vtkNew<vtkPentatopeMeshTimeSlice> filter;
    filter->SetInputData(mesh);
    filter->SetSliceTime(0.0);
    filter->Update();
    vtkUnstructuredGrid* slice = filter->GetOutput();
    const bool isEmpty = expected[atTheTime] == VTK_EMPTY_CELL;
    if (CHECK(slice->GetNumberOfCells() == (isEmpty ? 0 : 1), atTheTime) && !isEmpty)
    {
      CHECK(slice->GetCellType(0) == expected[atTheTime], atTheTime);
      CHECK(Volumes(slice)[0] > 0.05, atTheTime);
    }
  }
}

/** What is not read in place gives the same slice. */
void TestOtherStorage()
{
  vtkNew<vtkPentatopeMeshTimeSlice> expected;
  expected->SetInputData(MakePentatopes());
  expected->SetSliceTime(0.3);
  expected->Update();

  const auto mesh = MakePentatopes();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToFloat();
  points->DeepCopy(mesh->GetPoints());
  CHECK(points->GetDataType() == VTK_FLOAT);
  mesh->SetPoints(points);
  vtkNew<vtkFloatArray> times;
  times->DeepCopy(mesh->GetPointData()->GetArray("Time"));
  times->SetName("t");
  mesh->GetPointData()->AddArray(times);
  mesh->GetPointData()->RemoveArray("Time");
  mesh->GetCells()->ConvertTo32BitStorage();
  vtkNew<vtkPentatopeMeshTimeSlice> filter;
  filter->SetTimeArrayName("t");
  filter->SetInputData(mesh);
  filter->SetSliceTime(0.3);
  filter->Update();
  CheckSlice(filter, 0.3);
  CHECK(SameMesh(filter->GetOutput(), expected->GetOutput()));
  CHECK(!mesh->GetCells()->IsStorage64Bit(), "the input stays as it is");
  CHECK(filter->GetOutput()->GetPointData()->GetArray("t") == nullptr);
}

/** What was kept of the mesh is not used when the mesh has changed. */
void TestChanges()
{
  const auto mesh = MakePentatopes();
  vtkNew<vtkPentatopeMeshTimeSlice> filter;
  filter->SetInputData(mesh);
  filter->UpdateTimeStep(1.5);
  CheckSlice(filter, 1.5);
  auto* times = vtkDoubleArray::SafeDownCast(mesh->GetPointData()->GetArray("Time"));
  for (vtkIdType i = 0; i < times->GetNumberOfValues(); ++i)
  {
    times->SetValue(i, 10.0 * times->GetValue(i));
  }
  times->Modified();
  filter->UpdateTimeStep(15.0);
  CheckSlice(filter, 15.0);
  CHECK(filter->GetOutputInformation(0)->Get(Pipeline::TIME_RANGE())[1] == 20.0);
  vtkNew<vtkDoubleArray> later;
  later->DeepCopy(times);
  later->SetName("Later");
  for (vtkIdType i = 0; i < later->GetNumberOfValues(); ++i)
  {
    later->SetValue(i, 100.0 + later->GetValue(i));
  }
  mesh->GetPointData()->AddArray(later);
  filter->UpdateTimeStep(15.0);
  CheckSlice(filter, 15.0);
  filter->SetTimeArrayName("Later");
  filter->UpdateTimeStep(115.0);
  CheckSlice(filter, 115.0);
  filter->SetTimeArrayName("Time");
  filter->SetInputData(MakePentatopes());
  filter->UpdateTimeStep(1.0);
  CheckSlice(filter, 1.0);
  filter->SetInputData(vtkSmartPointer<vtkUnstructuredGrid>::New());
  filter->UpdateTimeStep(1.0);
  CHECK(filter->GetOutput()->GetNumberOfCells() == 0);
  CHECK(filter->GetErrorMessage().empty(), filter->GetErrorMessage());
  CHECK(!filter->GetOutputInformation(0)->Has(Pipeline::TIME_RANGE()));
}

void ExpectError(const std::string& what, const std::function<void(vtkUnstructuredGrid*)>& spoil)
{
  const auto mesh = MakePentatopes();
  spoil(mesh);
  vtkNew<vtkPentatopeMeshTimeSlice> filter;
  vtkNew<ErrorCollector> errors;
  errors->Watch(filter);
  filter->SetInputData(mesh);
  filter->UpdateTimeStep(1.5);
  CHECK(filter->GetErrorMessage().find(what) != std::string::npos, what, filter->GetErrorMessage());
  CHECK(errors->FromFilter.size() == 1, what, errors->FromFilter.size());
  CHECK(filter->GetOutput()->GetNumberOfCells() == 0, what);
  CHECK(filter->GetOutput()->GetNumberOfPoints() == 0, what);
  filter->SetInputData(MakePentatopes());
  filter->UpdateTimeStep(1.5);
  CheckSlice(filter, 1.5);
}

void TestErrors()
{
  const auto setTimes = [](vtkUnstructuredGrid* mesh, vtkAbstractArray* times)
  {
    times->SetName("Time");
    mesh->GetPointData()->RemoveArray("Time");
    mesh->GetPointData()->AddArray(times);
  };
  ExpectError("no numeric point array \"Time\"",
    [](vtkUnstructuredGrid* mesh) { mesh->GetPointData()->RemoveArray("Time"); });
  ExpectError("no numeric point array \"Time\"",
    [&](vtkUnstructuredGrid* mesh)
    {
      vtkNew<vtkStringArray> times;
      times->SetNumberOfValues(mesh->GetNumberOfPoints());
      setTimes(mesh, times);
    });
  ExpectError("2 components",
    [&](vtkUnstructuredGrid* mesh)
    {
      vtkNew<vtkDoubleArray> times;
      times->SetNumberOfComponents(2);
      times->SetNumberOfTuples(mesh->GetNumberOfPoints());
      times->Fill(1.0);
      setTimes(mesh, times);
    });
  ExpectError("80 times for 81 points",
    [&](vtkUnstructuredGrid* mesh)
    {
      vtkNew<vtkDoubleArray> times;
      times->SetNumberOfTuples(mesh->GetNumberOfPoints() - 1);
      times->Fill(1.0);
      setTimes(mesh, times);
    });
  for (const double bad : { std::nan(""), std::numeric_limits<double>::infinity() })
  {
    ExpectError("time of point 7 is not a finite number",
      [&](vtkUnstructuredGrid* mesh)
      { mesh->GetPointData()->GetArray("Time")->SetComponent(7, 0, bad); });
  }
  const std::array<vtkIdType, 8> ids = { 0, 1, 2, 3, 4, 5, 6, 7 };
  ExpectError("Cell 384 is a vtkHexahedron of 8 points",
    [&](vtkUnstructuredGrid* mesh) { mesh->InsertNextCell(VTK_HEXAHEDRON, 8, ids.data()); });
  ExpectError("Cell 384 is a vtkPolyVertex of 4 points",
    [&](vtkUnstructuredGrid* mesh) { mesh->InsertNextCell(VTK_POLY_VERTEX, 4, ids.data()); });
  ExpectError("Cell 384 is a vtkPyramid of 5 points",
    [&](vtkUnstructuredGrid* mesh) { mesh->InsertNextCell(VTK_PYRAMID, 5, ids.data()); });
}

/** The boundary's polygons close the labels; volumes by the divergence theorem. */
void TestBoundary()
{
  vtkNew<vtkPentatopeMeshTimeSlice> filter;
  filter->SetInputData(MakeBoundaryTetrahedra());
  for (const double time : { 0.0, 0.4, 1.0, 1.5, 2.0 })
  {
    filter->UpdateTimeStep(time);
    vtkUnstructuredGrid* slice = filter->GetOutput();
    vtkDataArray* labels = slice->GetCellData()->GetArray("Labels");
    if (!CHECK(labels && labels->GetNumberOfComponents() == 2))
    {
      return;
    }
    std::map<int, double> volumes;
    for (vtkIdType c = 0; c < slice->GetNumberOfCells(); ++c)
    {
      CHECK(slice->GetCellType(c) == VTK_TRIANGLE || slice->GetCellType(c) == VTK_QUAD);
      std::vector<Vector> x(static_cast<std::size_t>(slice->GetCell(c)->GetNumberOfPoints()));
      for (std::size_t i = 0; i < x.size(); ++i)
      {
        slice->GetPoint(slice->GetCell(c)->GetPointId(static_cast<int>(i)), x[i].data());
      }
      for (std::size_t i = 2; i < x.size(); ++i)
      {
        const double volume = Volume<3>({ Vector{}, x[0], x[i - 1], x[i] });
        volumes[static_cast<int>(labels->GetComponent(c, 0))] += volume;
        volumes[static_cast<int>(labels->GetComponent(c, 1))] -= volume;
      }
    }
    CHECK(Near(volumes[1], 4.0), time, volumes[1]);
    CHECK(Near(volumes[2], 4.0), time, volumes[2]);
  }
}

/** Pentatopes and boundary in one grid. */
void TestMixed()
{
  const auto mesh = MakePentatopes();
  const auto boundary = MakeBoundaryTetrahedra();
  vtkDataArray* labels = mesh->GetCellData()->GetArray("Label");
  for (vtkIdType c = 0; c < boundary->GetNumberOfCells(); ++c)
  {
    mesh->InsertNextCell(VTK_TETRA, boundary->GetCell(c)->GetPointIds());
    labels->InsertNextTuple1(7);
  }
  vtkNew<vtkPentatopeMeshTimeSlice> both;
  both->SetInputData(mesh);
  vtkNew<vtkPentatopeMeshTimeSlice> volume;
  volume->SetInputData(MakePentatopes());
  vtkNew<vtkPentatopeMeshTimeSlice> surface;
  surface->SetInputData(boundary);
  for (const double time : { 0.0, 0.6, 2.0 })
  {
    both->UpdateTimeStep(time);
    volume->UpdateTimeStep(time);
    surface->UpdateTimeStep(time);
    CheckSlice(both, time);
    CHECK(both->GetOutput()->GetNumberOfCells() ==
      volume->GetOutput()->GetNumberOfCells() + surface->GetOutput()->GetNumberOfCells());
    CHECK(
      both->GetOutput()->GetNumberOfPoints() == volume->GetOutput()->GetNumberOfPoints(), "shared");
  }
}

void TestAbort()
{
  struct Abort
  {
    int At;
    int Events;
  };
  for (int at = 0; at < 3; ++at)
  {
    vtkNew<vtkPentatopeMeshTimeSlice> filter;
    filter->SetInputData(MakePentatopes());
    Abort abort = { at, 0 };
    vtkNew<vtkCallbackCommand> observer;
    observer->SetClientData(&abort);
    observer->SetCallback(
      [](vtkObject* caller, unsigned long, void* data, void*)
      {
        auto& state = *static_cast<Abort*>(data);
        if (state.Events++ == state.At)
        {
          static_cast<vtkAlgorithm*>(caller)->SetAbortExecute(1);
        }
      });
    const auto tag = filter->AddObserver(vtkCommand::ProgressEvent, observer);
    filter->UpdateTimeStep(0.5);
    CHECK(filter->GetOutput()->GetNumberOfCells() == 0, at);
    CHECK(filter->GetErrorMessage().empty());
    CHECK(abort.Events == at + 1, "it stops before the next step", at, abort.Events);
    filter->RemoveObserver(tag);
    filter->Modified();
    filter->UpdateTimeStep(0.5);
    CheckSlice(filter, 0.5);
  }
}

void TestPrintSelf()
{
  vtkNew<vtkPentatopeMeshTimeSlice> filter;
  std::ostringstream before;
  filter->Print(before);
  CHECK(before.str().find("SliceTime: (start of the range)") != std::string::npos);
  filter->SetSliceTime(1.25);
  filter->SetTimeArrayName("t");
  std::ostringstream text;
  filter->Print(text);
  for (const char* line : { "SliceTime: 1.25", "TimeArrayName: t", "ErrorMessage: (none)" })
  {
    CHECK(text.str().find(line) != std::string::npos, line);
  }
}

} // namespace

int TestPentatopeMeshTimeSlice(int, char*[])
{
  for (const bool knowsRange : { false, true })
  {
    for (const bool isTemporal : { false, true })
    {
      TestPlayback(knowsRange, isTemporal);
    }
  }
  TestLongPipeline();
  TestEmpty();
  TestWithoutInput();
  TestTimes();
  TestData();
  TestPointsAtTheTime();
  TestOtherStorage();
  TestChanges();
  TestErrors();
  TestBoundary();
  TestMixed();
  TestAbort();
  TestPrintSelf();
  return Result();
}
