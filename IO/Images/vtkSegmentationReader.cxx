// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSegmentationReader.h"

#include "FileError.h"
#include "LabelTable.h"
#include "LabelTables/LabelTableFile.h"
#include "Masks/MaskFiles.h"
#include "Placement.h"
#include "StopRequest.h"
#include "VTKImage.h"

#include "vtkDataObject.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMath.h"
#include "vtkMatrix3x3.h"
#include "vtkObjectFactory.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <vector>

using namespace voxplex;
using namespace voxplex::io;
using Pipeline = vtkStreamingDemandDrivenPipeline;

namespace
{

int NearestFrame(const ScalarImage& image, double time)
{
  int nearest = 0;
  for (int frame = 1; frame < image.Frames; ++frame)
  {
    if (std::abs(image.TimeOf(frame) - time) <= std::abs(image.TimeOf(nearest) - time))
    {
      nearest = frame;
    }
  }
  return nearest;
}

/** Replaces the times of the file. */
void SetTimes(ScalarImage& image, const std::vector<double>& times, const std::string& path)
{
  RefuseIf(times.size() != static_cast<std::size_t>(image.Frames), "AddFrameTime() gave ",
    times.size(), " times, but '", path, "' has ", image.Frames,
    (image.Frames == 1 ? " frame" : " frames"), "; give one time for each frame");
  for (std::size_t frame = 0; frame < times.size(); ++frame)
  {
    RefuseIf(!std::isfinite(times[frame]) || (frame > 0 && !(times[frame] > times[frame - 1])),
      "the times of AddFrameTime() must be finite and increase, but that of frame ", frame, " is ",
      times[frame]);
  }
  image.Times = times;
}

} // namespace

struct vtkSegmentationReader::Internals
{
  std::string Path;  ///< the image, or the first of masks
  ScalarImage Image; ///< without voxels as long as nothing was read
  voxplex::LabelTable Labels;
  std::string LabelSource;
  std::vector<std::string> Files;
  std::vector<std::string> Warnings;
  vtkTimeStamp ReadTime;
};

vtkStandardNewMacro(vtkSegmentationReader);

vtkSegmentationReader::vtkSegmentationReader()
  : FileName(nullptr)
  , Overlap(OVERLAP_SMALLEST)
  , MaskThreshold(0.5)
  , ResampleMasks(false)
  , SeriesUID(nullptr)
  , LabelTableFileName(nullptr)
  , Space(SPACE_LPS)
  , Spacing{ 0, 0, 0 }
  , Origin{ vtkMath::Nan(), vtkMath::Nan(), vtkMath::Nan() }
  , Direction{ 0, 0, 0, 0, 0, 0, 0, 0, 0 }
  , DataFilesAnywhere(false)
  , Private(new Internals)
{
  this->SetNumberOfInputPorts(0);
}

vtkSegmentationReader::~vtkSegmentationReader()
{
  this->SetFileName(nullptr);
  this->SetSeriesUID(nullptr);
  this->SetLabelTableFileName(nullptr);
}

void vtkSegmentationReader::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << (this->FileName ? this->FileName : "(none)") << "\n"
     << indent << "FileNames: " << this->FileNames.size() << "\n"
     << indent << "Overlap: " << (this->Overlap == OVERLAP_SMALLEST ? "smallest" : "order") << "\n"
     << indent << "MaskThreshold: " << this->MaskThreshold << "\n"
     << indent << "ResampleMasks: " << (this->ResampleMasks ? "on" : "off") << "\n"
     << indent << "SeriesUID: " << (this->SeriesUID ? this->SeriesUID : "(none)") << "\n"
     << indent
     << "LabelTableFileName: " << (this->LabelTableFileName ? this->LabelTableFileName : "(none)")
     << "\n"
     << indent << "Space: " << (this->Space == SPACE_LPS ? "LPS" : "RAS") << "\n"
     << indent << "Spacing: " << this->Spacing[0] << " " << this->Spacing[1] << " "
     << this->Spacing[2] << "\n"
     << indent << "Origin: " << this->Origin[0] << " " << this->Origin[1] << " " << this->Origin[2]
     << "\n"
     << indent << "Direction: ";
  for (const double number : this->Direction)
  {
    os << number << " ";
  }
  os << "\n"
     << indent << "DataFilesAnywhere: " << (this->DataFilesAnywhere ? "on" : "off") << "\n"
     << indent << "Frames: " << this->GetNumberOfFrames() << "\n"
     << indent << "Aborted: " << (this->Aborted ? "Yes" : "No") << "\n"
     << indent << "ErrorMessage: " << this->ErrorMessage << "\n";
}

int vtkSegmentationReader::GetNumberOfFrames() const
{
  return this->Private->Image.Scalars ? this->Private->Image.Frames : 0;
}

double vtkSegmentationReader::GetTimeOfFrame(int frame) const
{
  return this->Private->Image.TimeOf(frame);
}

void vtkSegmentationReader::ClearOrigin()
{
  for (double& coordinate : this->Origin)
  {
    if (!std::isnan(coordinate))
    {
      coordinate = vtkMath::Nan();
      this->Modified();
    }
  }
}

void vtkSegmentationReader::AddFileName(const char* name)
{
  this->FileNames.emplace_back(name ? name : "");
  this->Modified();
}

void vtkSegmentationReader::ClearFileNames()
{
  if (!this->FileNames.empty())
  {
    this->FileNames.clear();
    this->Modified();
  }
}

void vtkSegmentationReader::AddFrameTime(double time)
{
  this->FrameTimes.push_back(time);
  this->Modified();
}

void vtkSegmentationReader::ClearFrameTimes()
{
  if (!this->FrameTimes.empty())
  {
    this->FrameTimes.clear();
    this->Modified();
  }
}

const std::string& vtkSegmentationReader::GetLabelTableSource() const
{
  return this->Private->LabelSource;
}

std::vector<std::string> vtkSegmentationReader::GetFilesRead() const
{
  std::vector<std::string> files = this->Private->Files;
  files.insert(files.end(), { this->Private->Path, this->Private->LabelSource });
  return files;
}

int vtkSegmentationReader::GetNumberOfWarnings() const
{
  return static_cast<int>(this->Private->Warnings.size());
}

const std::string& vtkSegmentationReader::GetWarning(int i) const
{
  static const std::string none;
  return i >= 0 && i < this->GetNumberOfWarnings()
    ? this->Private->Warnings[static_cast<std::size_t>(i)]
    : none;
}

/** Whether the user says something of it. */
bool vtkSegmentationReader::IsPlaced() const
{
  return std::any_of(
           std::begin(this->Spacing), std::end(this->Spacing), [](double x) { return x > 0; }) ||
    std::any_of(
      std::begin(this->Origin), std::end(this->Origin), [](double x) { return !std::isnan(x); }) ||
    std::any_of(
      std::begin(this->Direction), std::end(this->Direction), [](double x) { return x != 0; });
}

/** What is still right. */
bool vtkSegmentationReader::IsRead() const
{
  return this->Private->Image.Scalars && this->Private->ReadTime > this->MTime;
}

void vtkSegmentationReader::SetSpace(int space)
{
  space = std::clamp<int>(space, SPACE_LPS, SPACE_RAS);
  if (space != this->Space)
  {
    const bool isRead = this->IsRead() && !this->IsPlaced(); // the user's place is in the space
    this->Space = space;
    this->Modified();
    if (isRead)
    {
      this->Private->ReadTime.Modified();
    }
  }
}

bool vtkSegmentationReader::Read()
{
  if (this->IsRead())
  {
    return true;
  }
  Internals& data = *this->Private;
  data = Internals();
  this->ErrorMessage.clear();
  this->Aborted = false;
  this->AbortExecute = 0; // what stopped the last reading does not stop this one
  try
  {
    std::vector<std::string> paths = this->FileNames;
    if (paths.empty())
    {
      paths.emplace_back(this->FileName ? this->FileName : "");
    }
    data.Path = paths.front();
    RefuseIf(data.Path.empty(), "no file name is set");
    ImageAnswer answer = ReadImageOrMasks(paths,
      { "", this->SeriesUID ? this->SeriesUID : "", this->DataFilesAnywhere,
        static_cast<voxplex::Overlap>(this->Overlap), this->MaskThreshold,
        [this](double part)
        {
          this->UpdateProgress(part);
          return !IsStopRequested(this);
        } },
      this->ResampleMasks, this->IsPlaced());
    data.Image = std::move(answer.Image);
    data.Labels = std::move(answer.Labels);
    if (std::ranges::any_of(this->Origin, [](double number) { return std::isnan(number); }) ||
      std::ranges::all_of(this->Direction, [](double number) { return number == 0; }))
    {
      data.Warnings = std::move(answer.PlaceGuesses);
    }
    if (!std::all_of(std::begin(this->Spacing), std::end(this->Spacing),
          [](double number) { return number > 0; }))
    {
      std::ranges::copy(answer.SpacingGuesses, std::back_inserter(data.Warnings));
    }
    std::ranges::copy(answer.Warnings, std::back_inserter(data.Warnings));
    data.Files = std::move(answer.Files);
    if (!this->FrameTimes.empty())
    {
      SetTimes(data.Image, this->FrameTimes, data.Path);
    }
    this->PlaceImage();
    this->ReadLabels();
  }
  catch (const Stopped&)
  {
    data = Internals();
    this->Aborted = true;
    this->AbortExecute = 0;
    return false;
  }
  catch (const std::exception& error)
  {
    data = Internals();
    this->ErrorMessage = error.what();
    vtkErrorMacro(<< this->ErrorMessage);
    return false;
  }
  data.ReadTime.Modified();
  for (const std::string& warning : data.Warnings)
  {
    vtkWarningMacro(<< warning);
  }
  return true;
}

/** What the user says of spacing, origin and direction replaces what the file says. */
void vtkSegmentationReader::PlaceImage()
{
  ScalarImage& image = this->Private->Image;
  const std::array<double, 3> signs = SignsFromLPS(static_cast<voxplex::Space>(this->Space));
  const bool hasDirection = std::any_of(std::begin(this->Direction), std::end(this->Direction),
    [](double number) { return number != 0; });
  std::array<Vector3, 3> steps{};
  Vector3 origin{};
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    const double spacing = this->Spacing[axis] > 0 ? this->Spacing[axis] : image.Spacing[axis];
    const double length =
      std::hypot(this->Direction[axis], this->Direction[3 + axis], this->Direction[6 + axis]);
    for (std::size_t row = 0; row < 3; ++row)
    {
      const std::size_t at = 3 * row + axis;
      steps[axis][row] =
        spacing * (hasDirection ? signs[row] * this->Direction[at] / length : image.Direction[at]);
    }
    origin[axis] =
      std::isnan(this->Origin[axis]) ? image.Origin[axis] : signs[axis] * this->Origin[axis];
  }
  if (!this->IsPlaced())
  {
    return;
  }
  try
  {
    Place(image, steps, origin);
  }
  catch (const FileError&)
  {
    Refuse("SetSpacing(), SetOrigin() and SetDirection() give '", this->Private->Path,
      "' no place in space: numbers must be finite, and the columns of the direction matrix "
      "independent");
  }
}

/** From the table that is set, the header, or a table beside the image, in this order. */
void vtkSegmentationReader::ReadLabels()
{
  Internals& data = *this->Private;
  if (this->LabelTableFileName && *this->LabelTableFileName)
  {
    data.LabelSource = this->LabelTableFileName;
    data.Labels = ReadLabelTableFile(data.LabelSource);
  }
  else if (!data.Labels.Entries.empty()) // the image's own
  {
    data.LabelSource = data.Path;
  }
  else if (const auto beside = FindLabelTableFile(data.Path))
  {
    try
    {
      data.Labels = ReadLabelTableFile(*beside);
      data.LabelSource = *beside;
    }
    catch (const FileError& error)
    {
      data.Warnings.push_back(std::string("labels have no names: ") + error.what());
    }
  }
  KeepLabelsOf(data.Image, data.Labels);
  if (data.Labels.Entries.empty() && !data.LabelSource.empty())
  {
    data.Warnings.push_back(
      "labels have no names: no label that '" + data.LabelSource + "' lists is in the image");
    data.LabelSource.clear();
  }
}

int vtkSegmentationReader::RequestInformation(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector)
{
  vtkInformation* information = outputVector->GetInformationObject(0);
  information->Remove(Pipeline::TIME_STEPS());
  information->Remove(Pipeline::TIME_RANGE());
  if (!this->Read())
  {
    if (vtkDataObject* output = vtkDataObject::GetData(information))
    {
      output->Initialize();
    }
    const std::array<int, 6> nothing{ 0, -1, 0, -1, 0, -1 };
    information->Set(Pipeline::WHOLE_EXTENT(), nothing.data(), 6);
    return this->Aborted ? 1 : 0;
  }
  const ScalarImage& image = this->Private->Image;
  const auto space = static_cast<voxplex::Space>(this->Space);
  const auto frame = ToVTKImage(image, space);
  information->Set(Pipeline::WHOLE_EXTENT(), frame->GetExtent(), 6);
  information->Set(vtkDataObject::ORIGIN(), frame->GetOrigin(), 3);
  information->Set(vtkDataObject::SPACING(), frame->GetSpacing(), 3);
  information->Set(vtkDataObject::DIRECTION(), frame->GetDirectionMatrix()->GetData(), 9);
  vtkDataObject::SetPointDataActiveScalarInfo(information, frame->GetScalarType(), 1);
  if (image.Frames > 1)
  {
    std::vector<double> times;
    for (int i = 0; i < image.Frames; ++i)
    {
      times.push_back(image.TimeOf(i));
    }
    const std::array<double, 2> range{ times.front(), times.back() };
    information->Set(Pipeline::TIME_STEPS(), times.data(), static_cast<int>(times.size()));
    information->Set(Pipeline::TIME_RANGE(), range.data(), 2);
  }
  return 1;
}

int vtkSegmentationReader::RequestData(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector)
{
  vtkInformation* information = outputVector->GetInformationObject(0);
  vtkImageData* output = vtkImageData::GetData(information);
  const ScalarImage& image = this->Private->Image;
  if (this->Aborted)
  {
    output->Initialize();
    return 1;
  }
  const bool hasTime = information->Has(Pipeline::UPDATE_TIME_STEP());
  const int frame =
    hasTime ? NearestFrame(image, information->Get(Pipeline::UPDATE_TIME_STEP())) : 0;
  FillVTKImage(
    output, image, static_cast<voxplex::Space>(this->Space), this->Private->Labels, frame);
  if (image.Frames > 1)
  {
    output->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), image.TimeOf(frame));
  }
  return 1;
}
