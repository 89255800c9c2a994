// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Private/QualityRun.h"

#include "Base/Error.h"
#include "Image/LabelValue.h"
#include "Parallel/ParallelFor.h"
#include "Private/Execution.h"
#include "Private/LabelledMesh.h"
#include "Private/QualityTables.h"

#include "vtkDataArray.h"
#include "vtkDemandDrivenPipeline.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkTable.h"
#include "vtkUnstructuredGrid.h"

#include <chrono>
#include <future>
#include <set>
#include <string>

using voxplex::InputError;

namespace
{

using Pipeline = vtkStreamingDemandDrivenPipeline;

/** Whether a voxel has a label that is selected. */
bool HasForeground(vtkDataArray* array, const voxplex::LabelSelection& selection)
{
  const std::set<double> only(selection.Only.begin(), selection.Only.end());
  for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
  {
    const double label = voxplex::NearestLabel(array->GetComponent(i, 0));
    if (label != 0.0 && (only.empty() || only.count(label) > 0))
    {
      return true;
    }
  }
  return false;
}

} // namespace

//----------------------------------------------------------------------------------------------------
bool vtkSimplexMeshQuality::Execution::Measure()
{
  vtkUnstructuredGrid* const grid = vtkUnstructuredGrid::GetData(this->Input[0]);
  const bool done =
    voxplex::HasPentatopes(grid) ? this->MeasurePentatopes() : this->MeasureTetrahedra();
  if (done)
  {
    this->Filter->UpdateProgress(1.0);
  }
  return done && !this->Filter->StopRequested();
}

// Another thread works, so that this one can see to AbortExecute.
bool vtkSimplexMeshQuality::Execution::Run(
  const std::function<void(const std::stop_token&)>& work, double from, double to)
{
  std::stop_source stop;
  auto done = std::async(std::launch::async, [&] { work(stop.get_token()); });
  double progress = from;
  while (done.wait_for(std::chrono::milliseconds(50)) != std::future_status::ready)
  {
    progress += 0.01 * (to - progress); // how long it takes is not known
    this->Filter->UpdateProgress(progress);
    if (this->Filter->StopRequested())
    {
      stop.request_stop();
    }
  }
  try
  {
    done.get();
  }
  catch (const voxplex::Cancelled&)
  {
    return false;
  }
  this->Filter->UpdateProgress(to);
  return !this->Filter->StopRequested();
}

unsigned vtkSimplexMeshQuality::Execution::Threads() const
{
  return voxplex::ThreadsFor(this->Filter->NumberOfThreads);
}

voxplex::MeasurementOptions vtkSimplexMeshQuality::Execution::Options() const
{
  return { this->Filter->RadiusEdgeRatio, this->Filter->FacetAngle, this->Filter->SmallestComponent,
    this->Filter->Distances, false, this->Filter->SmoothingSigma, this->Threads() };
}

bool vtkSimplexMeshQuality::Execution::MeasureTetrahedra()
{
  const unsigned threads = this->Threads();
  vtkUnstructuredGrid* const grid = vtkUnstructuredGrid::GetData(this->Input[0]);
  vtkImageData* const image = vtkImageData::GetData(this->Input[1]);
  std::optional<voxplex::ChosenArray> voxels;
  if (image != nullptr)
  {
    int association = 0;
    vtkAbstractArray* const scalars =
      this->Filter->GetInputAbstractArrayToProcess(1, this->Input, association);
    voxels = voxplex::ChooseScalars(
      image, scalars, association, voxplex::ImageContent::Labels, "image", "");
  }
  voxplex::SimplexMesh<3> mesh =
    voxplex::ReadTetrahedra(grid, this->Filter->GetInputAbstractArrayToProcess(0, this->Input));
  this->Filter->UpdateProgress(0.1);

  voxplex::MeasurementOptions options = this->Options();
  options.SmoothDistances = this->Filter->SmoothDistances;
  Internals& figures = *this->Filter->Private;
  const bool done = this->Run(
    [&](const std::stop_token& stop)
    {
      std::optional<voxplex::LabelImage<3>> labels;
      if (voxels)
      {
        labels = voxplex::ReadLabels(*voxels, figures.Selection(), threads, stop);
      }
      figures.Figures = voxplex::MeasureMesh(mesh, labels ? &*labels : nullptr,
        voxels ? voxels->Frame : voxplex::ImageFrame(), options, stop);
    },
    0.1, 0.95);
  if (!done)
  {
    return false;
  }
  vtkUnstructuredGrid* const output = vtkUnstructuredGrid::GetData(this->Output, 0);
  output->ShallowCopy(grid);
  voxplex::AddElementMeasures(mesh, threads, output->GetCellData());
  voxplex::FillLabelTable(figures.Figures, vtkTable::GetData(this->Output, 1));
  voxplex::FillHistograms(figures.Figures.Quality, vtkTable::GetData(this->Output, 2));
  return true;
}

//----------------------------------------------------------------------------------------------------
bool vtkSimplexMeshQuality::Execution::MeasurePentatopes()
{
  vtkUnstructuredGrid* const grid = vtkUnstructuredGrid::GetData(this->Input[0]);
  voxplex::SpaceTimeMeasurer quality(
    voxplex::ReadPentatopes(
      grid, this->Filter->GetInputAbstractArrayToProcess(0, this->Input), this->Filter->TimeScale),
    this->Filter->TimeScale, this->Options());
  const auto worst = static_cast<std::size_t>(this->Filter->NumberOfWorstElements);
  if (!this->Run(
        [&](const std::stop_token& stop) { quality.MeasureElements(worst, stop); }, 0.0, 0.2) ||
    !this->MeasureFrames(quality))
  {
    return false;
  }
  Internals& figures = *this->Filter->Private;
  figures.SpaceTime = quality.Measurement();
  vtkUnstructuredGrid* const output = vtkUnstructuredGrid::GetData(this->Output, 0);
  output->ShallowCopy(grid);
  voxplex::AddElementMeasures(*figures.SpaceTime, output->GetCellData());
  voxplex::FillLabelTable(*figures.SpaceTime, vtkTable::GetData(this->Output, 1));
  voxplex::FillHistograms(*figures.SpaceTime, vtkTable::GetData(this->Output, 2));
  voxplex::FillFrameTable(*figures.SpaceTime, vtkTable::GetData(this->Output, 3));
  return true;
}

bool vtkSimplexMeshQuality::Execution::MeasureFrames(voxplex::SpaceTimeMeasurer& quality)
{
  constexpr double start = 0.2; // of the progress
  const voxplex::LabelSelection selection = this->Filter->Private->Selection();
  if (vtkImageData::GetData(this->Input[1]) == nullptr)
  {
    return this->Run(
      [&](const std::stop_token& stop)
      {
        for (const double time : this->Filter->Private->FrameTimes)
        {
          quality.MeasureCut(time, nullptr, voxplex::ImageFrame(), stop);
        }
      },
      start, 0.95);
  }
  const std::vector<double> given = this->TimesOfImage();
  const std::vector<double>& times =
    this->Filter->Private->FrameTimes.empty() ? given : this->Filter->Private->FrameTimes;
  if (times.size() != given.size())
  {
    throw InputError("AddFrameTime() gave " + std::to_string(times.size()) +
      " times, but there are " + std::to_string(given.size()) +
      " frames; give one time for each frame.");
  }
  voxplex::FrameSeries series;
  series.Start(times, true, selection);
  for (std::size_t k = 0; k < times.size(); ++k)
  {
    const voxplex::ChosenArray frame = this->FrameOfImage(given, k);
    const auto progress = [&](std::size_t frames)
    { return start + 0.7 * static_cast<double>(frames) / static_cast<double>(times.size()); };
    const bool done = this->Run(
      [&](const std::stop_token& stop)
      {
        voxplex::AddFrame(frame, 0, this->Threads(), series);
        std::optional<voxplex::LabelImage<3>> labels;
        if (HasForeground(frame.Array, selection)) // else there is nothing to compare with
        {
          labels = voxplex::ReadLabels(frame, selection, this->Threads(), stop);
        }
        quality.MeasureCut(times[k], labels ? &*labels : nullptr, frame.Frame, stop);
      },
      progress(k), progress(k + 1));
    if (!done)
    {
      return false;
    }
  }
  return this->Run(
    [&](const std::stop_token& stop)
    {
      const voxplex::SpaceTimeFrame frame = series.MakeFrame(this->Filter->TimeScale);
      quality.MeasureImage(series.MakeLabelImage(frame.Grid, this->Threads()), frame, stop);
    },
    0.9, 0.95);
}

// Of components without times the numbers of the frames, which AddFrameTime() replaces.
std::vector<double> vtkSimplexMeshQuality::Execution::TimesOfImage() const
{
  vtkInformation* const info = this->Input[1]->GetInformationObject(0);
  const int steps = info->Has(Pipeline::TIME_STEPS()) ? info->Length(Pipeline::TIME_STEPS()) : 0;
  if (steps > 1)
  {
    const double* const times = info->Get(Pipeline::TIME_STEPS());
    return { times, times + steps };
  }
  int association = 0;
  vtkAbstractArray* const scalars =
    this->Filter->GetInputAbstractArrayToProcess(1, this->Input, association);
  const int components = scalars != nullptr ? scalars->GetNumberOfComponents() : 0;
  if (components < 2)
  {
    throw InputError("The mesh has pentatopes, but the image has one frame; give the series that "
                     "the mesh was made from.");
  }
  if (this->Filter->Private->FrameTimes.empty())
  {
    throw InputError("The frames of the image are components, which have no times; give the time "
                     "of each frame with AddFrameTime().");
  }
  std::vector<double> numbers;
  for (int k = 0; k < components; ++k)
  {
    numbers.push_back(k);
  }
  return numbers;
}

voxplex::ChosenArray vtkSimplexMeshQuality::Execution::FrameOfImage(
  const std::vector<double>& times, std::size_t k) const
{
  vtkInformation* const info = this->Input[1]->GetInformationObject(0);
  int association = 0;
  if (info->Has(Pipeline::TIME_STEPS()) && info->Length(Pipeline::TIME_STEPS()) > 1)
  {
    int port = 0;
    vtkAlgorithm* const producer = this->Filter->GetInputAlgorithm(1, 0, port);
    info->Set(Pipeline::UPDATE_TIME_STEP(), times[k]);
    auto* const executive = vtkDemandDrivenPipeline::SafeDownCast(producer->GetExecutive());
    if (executive == nullptr || !executive->Update(port))
    {
      throw InputError("The image has no frame " + std::to_string(k) +
        ": what makes the image failed at that time.");
    }
    vtkAbstractArray* const scalars =
      this->Filter->GetInputAbstractArrayToProcess(1, this->Input, association);
    return voxplex::ChooseScalars(vtkImageData::GetData(this->Input[1]), scalars, association,
      voxplex::ImageContent::Labels, "image of frame " + std::to_string(k), "");
  }
  vtkAbstractArray* const scalars =
    this->Filter->GetInputAbstractArrayToProcess(1, this->Input, association);
  voxplex::ChosenArray frame = voxplex::Choose(vtkImageData::GetData(this->Input[1]), scalars,
    association, voxplex::ImageContent::Labels, "image");
  const auto component = vtkSmartPointer<vtkDataArray>::Take(frame.Array->NewInstance());
  component->SetName(frame.Array->GetName());
  component->SetNumberOfTuples(frame.Array->GetNumberOfTuples());
  component->CopyComponent(0, frame.Array, static_cast<int>(k));
  frame.Array = component;
  return frame;
}
