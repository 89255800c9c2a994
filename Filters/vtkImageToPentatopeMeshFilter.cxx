// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkImageToPentatopeMeshFilter.h"

#include "Base/NumberText.h"
#include "Private/FrameGathering.h"
#include "Private/Lists.h"
#include "Private/MeshOutput.h"
#include "Private/SimplexMeshRun.h"

#include "vtkCompositeDataPipeline.h"
#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"
#include "vtkFieldData.h"
#include "vtkInformation.h"
#include "vtkObjectFactory.h"
#include "vtkPentatopeMeshTimeSlice.h"
#include "vtkUnstructuredGrid.h"

#include <array>
#include <cmath>
#include <limits>

vtkStandardNewMacro(vtkImageToPentatopeMeshFilter);

struct vtkImageToPentatopeMeshFilter::Frames
{
  voxplex::FrameSeries Series;
  double Seconds = 0.0; ///< taken by copying them
};

namespace
{

using voxplex::InputError;
using Pipeline = vtkStreamingDemandDrivenPipeline;

/** VTK's executive with what FrameGathering mends. */
class vtkFrameGatheringPipeline : public voxplex::FrameGathering<vtkCompositeDataPipeline>
{
public:
  static vtkFrameGatheringPipeline* New();
  vtkTypeMacro(vtkFrameGatheringPipeline, vtkCompositeDataPipeline);
};
vtkStandardNewMacro(vtkFrameGatheringPipeline);

/** The fraction of the progress that belongs to gathering time steps. */
constexpr double GatheringProgress = 0.1;

/** The name of the field data array in which VTK's files have the time of their data. */
constexpr char TimeValue[] = "TimeValue";

// The class's constants are the kernel's: casts lead from one to the other.
static_assert(vtkImageToPentatopeMeshFilter::SURFACE_FIRST ==
  static_cast<int>(voxplex::RuleOrder::SurfaceFirst));

std::vector<double> TimeStepsOf(vtkInformation* info)
{
  const double* const times = info->Get(Pipeline::TIME_STEPS());
  return times ? std::vector<double>(times, times + info->Length(Pipeline::TIME_STEPS()))
               : std::vector<double>();
}

/** Whether the components may be red, green and blue. VTK's images of colours are of these types. */
bool LooksLikeColours(vtkDataArray* array)
{
  const int components = array->GetNumberOfComponents();
  const int type = array->GetDataType();
  return (components == 3 || components == 4) &&
    (type == VTK_UNSIGNED_CHAR || type == VTK_UNSIGNED_SHORT);
}

voxplex::ImageContent ContentOf(int inputMode)
{
  return inputMode == vtkImageToPentatopeMeshFilter::INPUT_LABELS
    ? voxplex::ImageContent::Labels
    : voxplex::ImageContent::GreyValues;
}

} // namespace

//----------------------------------------------------------------------------------------------------
vtkImageToPentatopeMeshFilter::vtkImageToPentatopeMeshFilter()
  : Gathered(std::make_unique<Frames>())
{
}

vtkImageToPentatopeMeshFilter::~vtkImageToPentatopeMeshFilter() = default;

const char* vtkImageToPentatopeMeshFilter::GetRuleOrderAsString() const
{
  return this->RuleOrder == RADIUS_EDGE_FIRST ? "radius-edge-first" : "surface-first";
}

vtkUnstructuredGrid* vtkImageToPentatopeMeshFilter::GetBoundary()
{
  return vtkUnstructuredGrid::SafeDownCast(this->GetOutputDataObject(1));
}

vtkExecutive* vtkImageToPentatopeMeshFilter::CreateDefaultExecutive()
{
  return vtkFrameGatheringPipeline::New();
}

int vtkImageToPentatopeMeshFilter::FillOutputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), "vtkUnstructuredGrid");
  return 1;
}

//----------------------------------------------------------------------------------------------------
void vtkImageToPentatopeMeshFilter::AddFrameTime(double time)
{
  this->FrameTimes.push_back(time);
  this->Modified();
}

void vtkImageToPentatopeMeshFilter::ClearFrameTimes()
{
  voxplex::Clear(this, this->FrameTimes);
}

double vtkImageToPentatopeMeshFilter::GetFrameTime(int frame) const
{
  return voxplex::ItemAt(this->FrameTimes, frame, std::numeric_limits<double>::quiet_NaN());
}

std::vector<double> vtkImageToPentatopeMeshFilter::ChooseTimes(
  const std::vector<double>& ofInput) const
{
  if (!this->FrameTimes.empty() && this->FrameTimes.size() != ofInput.size())
  {
    throw InputError("{frame-times} gave " + std::to_string(this->FrameTimes.size()) +
      " times, but there are " + std::to_string(ofInput.size()) +
      " frames; give one time for each frame.");
  }
  return this->FrameTimes.empty() ? ofInput : this->FrameTimes;
}

//----------------------------------------------------------------------------------------------------
int vtkImageToPentatopeMeshFilter::FindNumberOfComponents(vtkInformationVector** inputVector)
{
  vtkInformation* const info = inputVector[0]->GetInformationObject(0);
  if (vtkInformation* active = vtkDataObject::GetActiveFieldInformation(
        info, vtkDataObject::FIELD_ASSOCIATION_POINTS, vtkDataSetAttributes::SCALARS))
  {
    vtkInformation* const chosen = this->GetInputArrayInformation(0);
    const bool isChosen = chosen->Has(vtkDataObject::FIELD_ATTRIBUTE_TYPE()) &&
      chosen->Get(vtkDataObject::FIELD_ATTRIBUTE_TYPE()) == vtkDataSetAttributes::SCALARS;
    if (isChosen && active->Has(vtkDataObject::FIELD_NUMBER_OF_COMPONENTS()))
    {
      const int components = active->Get(vtkDataObject::FIELD_NUMBER_OF_COMPONENTS());
      if (components > 1)
      {
        return components;
      }
    }
  }
  // Of data that is there already, as that of SetInputData().
  vtkImageData* const image = vtkImageData::GetData(inputVector[0]);
  int association = 0;
  vtkAbstractArray* const array =
    image ? this->GetInputAbstractArrayToProcess(0, inputVector, association) : nullptr;
  return array ? array->GetNumberOfComponents() : 0;
}

int vtkImageToPentatopeMeshFilter::RequestInformation(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  this->Superclass::RequestInformation(request, inputVector, outputVector);
  const std::vector<double> times = this->FrameTimes.empty()
    ? TimeStepsOf(inputVector[0]->GetInformationObject(0))
    : this->FrameTimes;
  std::array<double, 2> range = { 0.0, 0.0 };
  if (times.size() > 1)
  {
    range = { times.front(), times.back() };
  }
  else if (const int frames = this->FindNumberOfComponents(inputVector); frames > 1)
  {
    range = { this->TimeOrigin, this->TimeOrigin + (frames - 1) * this->TimeSpacing };
  }
  for (int port = 0; port < this->GetNumberOfOutputPorts(); ++port)
  {
    vtkInformation* const info = outputVector->GetInformationObject(port);
    info->Remove(Pipeline::TIME_STEPS());
    if (range[0] < range[1])
    {
      info->Set(Pipeline::TIME_RANGE(), range.data(), 2);
      info->Set(vtkPentatopeMeshTimeSlice::MESH_TIME_RANGE(), range.data(), 2);
    }
    else
    {
      info->Remove(Pipeline::TIME_RANGE());
      info->Remove(vtkPentatopeMeshTimeSlice::MESH_TIME_RANGE());
    }
  }
  return 1;
}

int vtkImageToPentatopeMeshFilter::RequestUpdateExtent(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  this->Superclass::RequestUpdateExtent(request, inputVector, outputVector);
  for (int port = 0; port < this->GetNumberOfInputPorts(); ++port)
  {
    if (vtkInformation* info = inputVector[port]->GetInformationObject(0))
    {
      info->Remove(Pipeline::UPDATE_TIME_STEP());
    }
  }
  vtkInformation* const info = inputVector[0]->GetInformationObject(0);
  const std::vector<double> times = TimeStepsOf(info);
  if (!times.empty())
  {
    const std::size_t next =
      std::min(this->Gathered->Series.NumberOfFramesAdded(), times.size() - 1);
    info->Set(Pipeline::UPDATE_TIME_STEP(), times[next]);
  }
  return 1;
}

//----------------------------------------------------------------------------------------------------
int vtkImageToPentatopeMeshFilter::RequestData(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  const int result = this->Superclass::RequestData(request, inputVector, outputVector);
  if (!request->Get(Pipeline::CONTINUE_EXECUTING()))
  {
    *this->Gathered = Frames();
    for (int port = 0; port < this->GetNumberOfOutputPorts(); ++port)
    {
      vtkDataObject::GetData(outputVector, port)->GetFieldData()->RemoveArray(TimeValue);
    }
  }
  return result;
}

bool vtkImageToPentatopeMeshFilter::Gather(
  vtkInformation* request, vtkInformationVector** inputVector)
{
  const voxplex::Stopwatch copying;
  voxplex::FrameSeries& series = this->Gathered->Series;
  const std::vector<double> times = TimeStepsOf(inputVector[0]->GetInformationObject(0));
  if (times.size() < 2)
  {
    this->GatherComponents(inputVector, !times.empty());
    this->Gathered->Seconds += copying.Seconds();
    return true;
  }

  if (!request->Get(Pipeline::CONTINUE_EXECUTING()) && series.NumberOfFramesAdded() > 0)
  {
    // An execution before this one ended upstream, and this one's first frame is not the series'.
    series.Clear();
    return false;
  }
  if (series.NumberOfFramesAdded() == 0)
  {
    series.Start(
      this->ChooseTimes(times), this->InputMode == INPUT_LABELS, this->Private->Selection());
  }
  int association = 0;
  vtkAbstractArray* const scalars =
    this->GetInputAbstractArrayToProcess(0, inputVector, association);
  voxplex::AddFrame(
    voxplex::ChooseScalars(vtkImageData::GetData(inputVector[0]), scalars, association,
      ContentOf(this->InputMode), "image of " + series.NameOf(series.NumberOfFramesAdded()),
      " The frames are the time steps of the input."),
    0, this->GetThreads(), series);
  this->Gathered->Seconds += copying.Seconds();
  this->UpdateProgress(GatheringProgress *
    (static_cast<double>(series.NumberOfFramesAdded()) /
      static_cast<double>(series.NumberOfFrames())));
  return series.IsComplete() || this->StopRequested();
}

void vtkImageToPentatopeMeshFilter::GatherComponents(
  vtkInformationVector** inputVector, bool hasTimeStep)
{
  int association = 0;
  vtkAbstractArray* const scalars =
    this->GetInputAbstractArrayToProcess(0, inputVector, association);
  const voxplex::ChosenArray input = voxplex::Choose(vtkImageData::GetData(inputVector[0]), scalars,
    association, ContentOf(this->InputMode), "image");
  const int frames = input.Array->GetNumberOfComponents();
  const bool hasTimes =
    !this->FrameTimes.empty() || this->TimeOrigin != 0.0 || this->TimeSpacing != 1.0;
  if (!hasTimes && LooksLikeColours(input.Array))
  {
    throw InputError("The array has " + std::to_string(frames) + " components of type " +
      input.Array->GetDataTypeAsString() +
      ", as colours (RGB, RGBA) have. If they are time frames, give "
      "their times with {frame-times}; if they are colours, extract one component, or make labels "
      "of them.");
  }
  if (frames < 2)
  {
    throw InputError(std::string("A space-time mesh needs two frames or more, but the input has ") +
      (hasTimeStep ? "one time step only" : "no time steps") +
      " and its array has one component; for one image, use vtkImageToTetMeshFilter.");
  }
  std::vector<double> times(static_cast<std::size_t>(frames));
  for (int k = 0; k < frames; ++k)
  {
    times[static_cast<std::size_t>(k)] = this->TimeOrigin + k * this->TimeSpacing;
  }
  this->Gathered->Series.Start(
    this->ChooseTimes(times), this->InputMode == INPUT_LABELS, this->Private->Selection());
  for (int k = 0; k < frames && !this->StopRequested(); ++k)
  {
    voxplex::AddFrame(input, k, this->GetThreads(), this->Gathered->Series);
  }
}

//----------------------------------------------------------------------------------------------------
double vtkImageToPentatopeMeshFilter::FindDefaultDelta(vtkInformationVector** inputVector)
{
  vtkInformation* const info = inputVector[0]->GetInformationObject(0);
  const std::vector<double> times = this->FrameTimes.empty() ? TimeStepsOf(info) : this->FrameTimes;
  const double step = times.size() < 2
    ? this->TimeSpacing
    : (times.back() - times.front()) / static_cast<double>(times.size() - 1);
  return voxplex::DefaultDelta<4>(voxplex::FindVoxelVolume(info) * step * this->TimeScale);
}

void vtkImageToPentatopeMeshFilter::CheckParameters() const
{
  using voxplex::CheckRange;
  using voxplex::CheckValue;
  constexpr double largest = std::numeric_limits<double>::max();
  constexpr double smallest = std::numeric_limits<double>::denorm_min();
  this->Superclass::CheckParameters();
  CheckValue("time-scale", this->TimeScale);
  CheckRange(this->TimeOrigin, -largest, largest, "TimeOrigin", "finite");
  CheckRange(this->TimeSpacing, smallest, largest, "TimeSpacing", "positive and finite");
  CheckRange(this->PickingRadius, smallest, std::nextafter(1.0, 0.0), "PickingRadius",
    "above 0 and below 1");
  CheckValue("picks", this->NumberOfPicks);
  // The table ends a little below 1.
  CheckRange(this->SliverBound, 0.0,
    this->Force ? std::nextafter(1.0, 0.0) : voxplex::LargestSliverBound, "{sliver-bound}",
    this->Force ? "at least 0 and below 1"
                : "at least 0 and at most 0.03, because above it meshes can become very large; "
                  "{force} goes up to 1");
  CheckRange(this->SliverRadiusFactor, 1.0, largest, "SliverRadiusFactor", "at least 1 and finite");
}

void vtkImageToPentatopeMeshFilter::AddTimePlane(double time)
{
  this->TimePlanes.push_back(time);
  this->Modified();
}

void vtkImageToPentatopeMeshFilter::RemoveAllTimePlanes()
{
  voxplex::Clear(this, this->TimePlanes);
}

int vtkImageToPentatopeMeshFilter::GetNumberOfTimePlanes() const
{
  return static_cast<int>(this->TimePlanes.size());
}

double vtkImageToPentatopeMeshFilter::GetTimePlane(int plane) const
{
  return voxplex::ItemAt(this->TimePlanes, plane, 0.0);
}

namespace
{

/**
 * The times of planes in the mesher's frame.
 * @throws InputError if a time is not within the series
 */
std::vector<double> PlanesInFrame(
  std::vector<double> times, const voxplex::FrameSeries& series, bool atFrames, double timeScale)
{
  const double first = series.TimeOf(0);
  const double last = series.TimeOf(series.NumberOfFrames() - 1);
  for (const double time : times)
  {
    if (!(time >= first && time <= last))
    {
      throw InputError("A time plane at " + voxplex::NumberText(time) +
        " is outside of the series, whose frames are from " + voxplex::NumberText(first) + " to " +
        voxplex::NumberText(last) + "; correct the times of the planes.");
    }
  }
  for (std::size_t k = 0; k < series.NumberOfFrames() && atFrames; ++k)
  {
    times.push_back(series.TimeOf(k));
  }
  for (double& time : times)
  {
    time = (time - first) * timeScale;
  }
  return times;
}

/** What is wrong if all of the series, in seconds perhaps, counts less than one voxel; else empty. */
std::string OddTimeScale(const voxplex::SpaceTimeFrame& frame)
{
  const double step = frame.Grid.IndexToFrame[3][3];
  const double edge = std::cbrt(frame.Grid.VoxelVolume() / step);
  const double duration = step * static_cast<double>(frame.Grid.Dimensions[3] - 1);
  if (duration >= edge)
  {
    return "";
  }
  const double scale = frame.TimeScale * edge / step;
  const double digit = std::pow(10.0, std::floor(std::log10(scale)));
  return "With a {time-scale} of " + voxplex::NumberText(frame.TimeScale) +
    " the whole series counts " + voxplex::NumberText(duration) +
    ", less than the edge of a voxel (" + voxplex::NumberText(edge) +
    "): elements become flat, and volumes wrong. A {time-scale} of about " +
    voxplex::NumberText(std::round(scale / digit) * digit) + " makes a frame as long as a voxel.";
}

} // namespace

//----------------------------------------------------------------------------------------------------
void vtkImageToPentatopeMeshFilter::Mesh(
  vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  voxplex::FrameSeries& series = this->Gathered->Series;
  const voxplex::SpaceTimeFrame frame = series.MakeFrame(this->TimeScale);
  Run<4> run(this, inputVector, frame);
  run.Options.FrameSteps = static_cast<unsigned>(this->FrameSteps);
  run.Options.Planes.Times =
    PlanesInFrame(this->TimePlanes, series, this->TimePlanesAtFrames, this->TimeScale);
  run.Options.Planes.Periodic = this->Periodic;
  run.Options.SpaceTime.Order = static_cast<voxplex::RuleOrder>(this->RuleOrder);
  run.Options.SpaceTime.Slivers.Fight = this->PickingRegions;
  run.Options.SpaceTime.Slivers.PickingRadius = this->PickingRadius;
  run.Options.SpaceTime.Slivers.RadiusFactor = this->SliverRadiusFactor;
  run.Options.SpaceTime.Slivers.VolumeBound = this->SliverBound;
  run.Options.SpaceTime.Slivers.Picks = static_cast<unsigned>(this->NumberOfPicks);
  run.Options.SpaceTime.Slivers.Seed = static_cast<std::uint64_t>(this->RandomSeed);
  run.Options.Team.FineGrained = this->FineGrained;
  run.ProgressBefore = GatheringProgress;
  const std::string odd = OddTimeScale(frame);
  if (!odd.empty())
  {
    this->Warn(odd);
  }

  const unsigned threads = run.Options.Team.Threads;
  voxplex::SimplexMesh<4> mesh;
  bool done = false;
  if (this->InputMode == INPUT_LABELS)
  {
    voxplex::LabelImage<4> labels = series.MakeLabelImage(frame.Grid, threads);
    series.Clear();
    done = run.Mesh(std::move(labels), mesh);
  }
  else
  {
    voxplex::Isosurface surface = run.ChosenIsosurface();
    surface.PeriodicInTime = this->Periodic;
    done = run.Mesh(series.MakeIsosurface(frame.Grid, surface, threads), mesh);
  }
  if (!done)
  {
    return;
  }
  const voxplex::Stopwatch writing;
  voxplex::MoveToOutput(std::move(mesh), frame, run.Statistics().Planes.Times,
    vtkUnstructuredGrid::GetData(outputVector, 0), vtkUnstructuredGrid::GetData(outputVector, 1),
    threads);
  run.Statistics().Times.LabelField += this->Gathered->Seconds;
  run.Statistics().Times.Extraction += writing.Seconds();
}

//----------------------------------------------------------------------------------------------------
void vtkImageToPentatopeMeshFilter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "TimeScale: " << this->TimeScale << "\n";
  os << indent << "TimeOrigin: " << this->TimeOrigin << "\n";
  os << indent << "TimeSpacing: " << this->TimeSpacing << "\n";
  voxplex::PrintList(os, indent, "FrameTimes", this->FrameTimes, " (of the input)");
  os << indent << "FrameSteps: " << this->FrameSteps << "\n";
  voxplex::PrintList(os, indent, "TimePlanes", this->TimePlanes, "");
  os << indent << "TimePlanesAtFrames: " << (this->TimePlanesAtFrames ? "On" : "Off") << "\n";
  os << indent << "Periodic: " << (this->Periodic ? "On" : "Off") << "\n";
  os << indent << "RuleOrder: " << this->GetRuleOrderAsString() << "\n";
  os << indent << "PickingRegions: " << (this->PickingRegions ? "On" : "Off") << "\n";
  os << indent << "PickingRadius: " << this->PickingRadius << "\n";
  os << indent << "NumberOfPicks: " << this->NumberOfPicks << "\n";
  os << indent << "SliverBound: " << this->SliverBound << "\n";
  os << indent << "SliverRadiusFactor: " << this->SliverRadiusFactor << "\n";
  os << indent << "RandomSeed: " << this->RandomSeed << "\n";
  os << indent << "FineGrained: " << (this->FineGrained ? "On" : "Off") << "\n";
}
