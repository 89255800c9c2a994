// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "PentatopeTesting.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <cmath>

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

} // namespace testing
