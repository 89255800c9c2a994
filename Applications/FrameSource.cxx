// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "FrameSource.h"

#include "VTKImage.h"

#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace voxplex::cli
{

using Pipeline = vtkStreamingDemandDrivenPipeline;

vtkStandardNewMacro(FrameSource);

FrameSource::FrameSource()
{
  this->SetNumberOfInputPorts(0);
}

void FrameSource::SetFrames(const ScalarImage& frames, Space space)
{
  this->Frames = frames;
  this->FrameSpace = space;
  this->Modified();
}

int FrameSource::FrameAt(double time) const
{
  const double steps = (time - this->Frames.TimeOrigin) / this->Frames.TimeSpacing;
  return static_cast<int>(std::clamp(std::round(steps), 0.0, this->Frames.Frames - 1.0));
}

int FrameSource::RequestInformation(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs)
{
  vtkInformation* information = outputs->GetInformationObject(0);
  const auto& n = this->Frames.Dimensions;
  const std::array<int, 6> extent{ 0, n[0] - 1, 0, n[1] - 1, 0, n[2] - 1 };
  information->Set(Pipeline::WHOLE_EXTENT(), extent.data(), 6);
  std::vector<double> times;
  for (int frame = 0; frame < this->Frames.Frames; ++frame)
  {
    times.push_back(this->Frames.TimeOf(frame));
  }
  const std::array<double, 2> range{ times.front(), times.back() };
  information->Set(Pipeline::TIME_STEPS(), times.data(), static_cast<int>(times.size()));
  information->Set(Pipeline::TIME_RANGE(), range.data(), 2);
  return 1;
}

int FrameSource::RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs)
{
  vtkInformation* information = outputs->GetInformationObject(0);
  const int frame = information->Has(Pipeline::UPDATE_TIME_STEP())
    ? this->FrameAt(information->Get(Pipeline::UPDATE_TIME_STEP()))
    : 0;
  vtkImageData* output = vtkImageData::GetData(outputs);
  output->ShallowCopy(ToVTKImage(this->Frames, this->FrameSpace, frame));
  output->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), this->Frames.TimeOf(frame));
  AddSpaceArray(output, this->FrameSpace);
  return 1;
}

} // namespace voxplex::cli
