// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPentatopeMeshTimeSlice.h"

#include "Base/Error.h"
#include "Mesh/TimeSlice.h"
#include "Private/Execution.h"
#include "Private/LabelledMesh.h"
#include "Private/Lists.h"
#include "Private/MeshingMessages.h"

#include "vtkAlgorithmOutput.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkInformation.h"
#include "vtkInformationDoubleVectorKey.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkSmartPointer.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkTypeInt64Array.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <optional>
#include <span>
#include <type_traits>

vtkStandardNewMacro(vtkPentatopeMeshTimeSlice);
vtkInformationKeyRestrictedMacro(vtkPentatopeMeshTimeSlice, MESH_TIME_RANGE, DoubleVector, 2);

using Pipeline = vtkStreamingDemandDrivenPipeline;
using voxplex::InputError;

static_assert(std::is_same_v<vtkTypeInt64, long long>, "the kernel reads VTK's indices in place");

/** The mesh that was looked at last, ready to be cut. */
struct vtkPentatopeMeshTimeSlice::Internals
{
  /**
   * Does nothing if the mesh has not changed.
   *
   * @throws InputError if it cannot be cut
   */
  void Prepare(vtkUnstructuredGrid* mesh, const std::string& timeArrayName);

  std::optional<voxplex::TimeSlicer> Slicer;

private:
  void Release();

  // What the slicer reads.
  vtkSmartPointer<vtkDoubleArray> Points;
  vtkSmartPointer<vtkDoubleArray> Times;
  vtkSmartPointer<vtkTypeInt64Array> Offsets;
  vtkSmartPointer<vtkTypeInt64Array> Connectivity;
  // What this was made from.
  const vtkUnstructuredGrid* Source = nullptr; ///< to compare only
  vtkMTimeType Version = 0;
  std::string TimeArrayName;
};

namespace
{

/** The array itself if its memory can be read as that of an Array, else a copy. */
template <class Array>
vtkSmartPointer<Array> As(vtkDataArray* array)
{
  vtkSmartPointer<Array> same = Array::SafeDownCast(array);
  if (same == nullptr)
  {
    same = vtkSmartPointer<Array>::New();
    same->DeepCopy(array);
  }
  return same;
}

template <typename Value, typename Array>
std::span<const Value> ValuesOf(Array* array)
{
  return { array->GetPointer(0), static_cast<std::size_t>(array->GetNumberOfValues()) };
}

vtkDataArray* TimesOf(vtkUnstructuredGrid* mesh, const std::string& name)
{
  vtkDataArray* times = mesh->GetPointData()->GetArray(name.c_str());
  if (times == nullptr)
  {
    throw InputError("The mesh has no numeric point array \"" + name +
      "\"; it must hold the time of each point (see SetTimeArrayName).");
  }
  if (times->GetNumberOfComponents() != 1)
  {
    throw InputError("The point array \"" + name + "\" has " +
      std::to_string(times->GetNumberOfComponents()) +
      " components; times have one. Choose another array with SetTimeArrayName.");
  }
  return times;
}

void CheckCells(vtkUnstructuredGrid* mesh)
{
  for (vtkIdType c = 0; c < mesh->GetNumberOfCells(); ++c)
  {
    const int type = mesh->GetCellType(c);
    const vtkIdType points = mesh->GetCells()->GetCellSize(c);
    if (!(type == VTK_POLY_VERTEX && points == 5) && !(type == VTK_TETRA && points == 4))
    {
      throw InputError("Cell " + std::to_string(c) + " is a " + voxplex::CellText(mesh, c) +
        "; only pentatopes (VTK_POLY_VERTEX of 5 points) and tetrahedra (VTK_TETRA) can be "
        "cut at a time.");
    }
  }
}

//----------------------------------------------------------------------------------------------------
vtkSmartPointer<vtkTypeInt64Array> CopyIds(const std::vector<long long>& ids)
{
  auto array = vtkSmartPointer<vtkTypeInt64Array>::New();
  array->SetNumberOfValues(static_cast<vtkIdType>(ids.size()));
  std::copy(ids.begin(), ids.end(), array->GetPointer(0));
  return array;
}

void SetGeometry(const voxplex::TimeSlice& slice, vtkUnstructuredGrid* output)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(static_cast<vtkIdType>(slice.Points.size()));
  for (std::size_t i = 0; i < slice.Points.size(); ++i)
  {
    points->SetPoint(static_cast<vtkIdType>(i), slice.Points[i].data());
  }
  output->SetPoints(points);

  vtkNew<vtkUnsignedCharArray> types;
  types->SetNumberOfValues(static_cast<vtkIdType>(slice.Sources.size()));
  std::transform(slice.Offsets.begin(), slice.Offsets.end() - 1, slice.Offsets.begin() + 1,
    types->GetPointer(0),
    [](long long first, long long last)
    { return static_cast<unsigned char>(last - first == 4 ? VTK_TETRA : VTK_TRIANGLE); });
  vtkNew<vtkCellArray> cells;
  cells->SetData(CopyIds(slice.Offsets), CopyIds(slice.Connectivity));
  output->SetCells(types, cells);
}

void SetData(const voxplex::TimeSlice& slice, vtkUnstructuredGrid* mesh,
  const std::string& timeArrayName, vtkUnstructuredGrid* output)
{
  vtkNew<vtkPointData> pointData;
  pointData->ShallowCopy(mesh->GetPointData());
  pointData->RemoveArray(timeArrayName.c_str());
  pointData->RemoveArray("PointIds");
  output->GetPointData()->InterpolateAllocate(
    pointData, static_cast<vtkIdType>(slice.Origins.size()));
  for (std::size_t i = 0; i < slice.Origins.size(); ++i)
  {
    const voxplex::CutPoint& origin = slice.Origins[i];
    output->GetPointData()->InterpolateEdge(
      pointData, static_cast<vtkIdType>(i), origin.A, origin.B, origin.Weight);
  }

  vtkCellData* const cellData = mesh->GetCellData();
  output->GetCellData()->CopyAllocate(cellData, static_cast<vtkIdType>(slice.Sources.size()));
  for (std::size_t c = 0; c < slice.Sources.size(); ++c)
  {
    output->GetCellData()->CopyData(cellData, slice.Sources[c], static_cast<vtkIdType>(c));
  }
  output->GetFieldData()->PassData(mesh->GetFieldData());
}

} // namespace

//----------------------------------------------------------------------------------------------------
void vtkPentatopeMeshTimeSlice::Internals::Prepare(
  vtkUnstructuredGrid* mesh, const std::string& timeArrayName)
{
  if (this->Slicer && this->Source == mesh && this->Version == mesh->GetMTime() &&
    this->TimeArrayName == timeArrayName)
  {
    return;
  }
  this->Release();
  if (mesh->GetNumberOfCells() == 0)
  {
    this->Slicer.emplace(voxplex::SpaceTimeMesh{});
  }
  else
  {
    CheckCells(mesh);
    this->Times = As<vtkDoubleArray>(TimesOf(mesh, timeArrayName));
    this->Points = As<vtkDoubleArray>(mesh->GetPoints()->GetData());
    this->Offsets = As<vtkTypeInt64Array>(mesh->GetCells()->GetOffsetsArray());
    this->Connectivity = As<vtkTypeInt64Array>(mesh->GetCells()->GetConnectivityArray());
    this->Slicer.emplace(voxplex::SpaceTimeMesh{ ValuesOf<double>(this->Points.Get()),
      ValuesOf<double>(this->Times.Get()), ValuesOf<long long>(this->Offsets.Get()),
      ValuesOf<long long>(this->Connectivity.Get()) });
  }
  this->Source = mesh;
  this->Version = mesh->GetMTime();
  this->TimeArrayName = timeArrayName;
}

void vtkPentatopeMeshTimeSlice::Internals::Release()
{
  this->Slicer.reset();
  this->Points = nullptr;
  this->Times = nullptr;
  this->Offsets = nullptr;
  this->Connectivity = nullptr;
}

//----------------------------------------------------------------------------------------------------
vtkPentatopeMeshTimeSlice::vtkPentatopeMeshTimeSlice()
  : SliceTime(std::numeric_limits<double>::quiet_NaN())
  , Private(std::make_unique<Internals>())
{
}

vtkPentatopeMeshTimeSlice::~vtkPentatopeMeshTimeSlice() = default;

void vtkPentatopeMeshTimeSlice::SetSliceTime(double time)
{
  if (time != this->SliceTime && !(std::isnan(time) && std::isnan(this->SliceTime)))
  {
    this->SliceTime = time;
    this->Modified();
  }
}

void vtkPentatopeMeshTimeSlice::SetTimeArrayName(const std::string& name)
{
  if (name != this->TimeArrayName)
  {
    this->TimeArrayName = name;
    this->Modified();
  }
}

//----------------------------------------------------------------------------------------------------
vtkTypeBool vtkPentatopeMeshTimeSlice::ProcessRequest(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  if (request->Has(Pipeline::REQUEST_UPDATE_TIME()) ||
    request->Has(Pipeline::REQUEST_UPDATE_EXTENT()))
  {
    // The executive has copied it from the output.
    if (vtkInformation* const input = inputVector[0]->GetInformationObject(0))
    {
      input->Remove(Pipeline::UPDATE_TIME_STEP());
    }
  }
  VOXPLEX_FORGET_ABORT(request);
  return this->Superclass::ProcessRequest(request, inputVector, outputVector);
}

int vtkPentatopeMeshTimeSlice::RequestInformation(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkInformation* const input = inputVector[0]->GetInformationObject(0);
  vtkInformation* const output = outputVector->GetInformationObject(0);
  output->Set(vtkAlgorithm::CAN_HANDLE_PIECE_REQUEST(), 1);
  output->Remove(Pipeline::TIME_STEPS());
  output->Remove(Pipeline::TIME_RANGE());
  double range[2];
  if (input->Has(MESH_TIME_RANGE()))
  {
    input->Get(MESH_TIME_RANGE(), range);
    output->Set(Pipeline::TIME_RANGE(), range, 2);
  }
  else if (this->FindRange(input, range))
  {
    output->Set(Pipeline::TIME_RANGE(), range, 2);
  }
  return 1;
}

bool vtkPentatopeMeshTimeSlice::FindRange(vtkInformation* inputInformation, double range[2])
{
  inputInformation->Remove(Pipeline::UPDATE_TIME_STEP());
  inputInformation->Set(Pipeline::UPDATE_PIECE_NUMBER(), 0);
  inputInformation->Set(Pipeline::UPDATE_NUMBER_OF_PIECES(), 1);
  inputInformation->Set(Pipeline::UPDATE_NUMBER_OF_GHOST_LEVELS(), 0);
  vtkAlgorithmOutput* const connection = this->GetInputConnection(0, 0);
  connection->GetProducer()->Update(connection->GetIndex());
  vtkUnstructuredGrid* const mesh = vtkUnstructuredGrid::GetData(inputInformation);
  if (mesh == nullptr)
  {
    return false;
  }
  try
  {
    this->Private->Prepare(mesh, this->TimeArrayName);
  }
  catch (const std::exception&)
  {
    return false; // RequestData() meets it again, and reports it
  }
  range[0] = this->Private->Slicer->GetFirstTime();
  range[1] = this->Private->Slicer->GetLastTime();
  return !this->Private->Slicer->IsEmpty();
}

//----------------------------------------------------------------------------------------------------
int vtkPentatopeMeshTimeSlice::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkUnstructuredGrid* const output = vtkUnstructuredGrid::GetData(outputVector);
  output->Initialize();
  this->ErrorMessage = voxplex::CatchFailure(
    [&]
    {
      this->Cut(vtkUnstructuredGrid::GetData(inputVector[0]), outputVector->GetInformationObject(0),
        output);
    },
    "There is not enough memory to cut this mesh.", "The mesh cannot be cut: ");
  if (this->ErrorMessage.empty())
  {
    return 1;
  }
  output->Initialize();
  vtkErrorMacro(<< this->ErrorMessage);
  return 0;
}

void vtkPentatopeMeshTimeSlice::Cut(
  vtkUnstructuredGrid* mesh, vtkInformation* outputInformation, vtkUnstructuredGrid* output)
{
  if (voxplex::IsStopRequested(this)) // the executive has reported the start
  {
    return;
  }
  this->Private->Prepare(mesh, this->TimeArrayName);
  const double time = this->ChooseTime(outputInformation);
  this->UpdateProgress(0.4);
  if (voxplex::IsStopRequested(this))
  {
    return;
  }
  const voxplex::TimeSlice slice = this->Private->Slicer->Slice(time);
  this->UpdateProgress(0.8);
  if (voxplex::IsStopRequested(this))
  {
    return;
  }
  SetGeometry(slice, output);
  SetData(slice, mesh, this->TimeArrayName, output);
  output->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), time);
}

double vtkPentatopeMeshTimeSlice::ChooseTime(vtkInformation* outputInformation) const
{
  double range[2] = { this->Private->Slicer->GetFirstTime(), this->Private->Slicer->GetLastTime() };
  if (outputInformation->Has(Pipeline::TIME_RANGE()))
  {
    outputInformation->Get(Pipeline::TIME_RANGE(), range);
  }
  double time = range[0];
  if (outputInformation->Has(Pipeline::UPDATE_TIME_STEP()))
  {
    time = outputInformation->Get(Pipeline::UPDATE_TIME_STEP());
  }
  else if (!std::isnan(this->SliceTime))
  {
    time = this->SliceTime;
  }
  return std::min(std::max(time, range[0]), range[1]);
}

//----------------------------------------------------------------------------------------------------
void vtkPentatopeMeshTimeSlice::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "SliceTime: ";
  if (std::isnan(this->SliceTime))
  {
    os << "(start of the range)\n";
  }
  else
  {
    os << this->SliceTime << "\n";
  }
  os << indent << "TimeArrayName: " << this->TimeArrayName << "\n";
  voxplex::PrintText(os, indent, "ErrorMessage", this->ErrorMessage);
}
