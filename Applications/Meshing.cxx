// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Meshing.h"

#include "Errors.h"
#include "FilterParameters.h"

#include <vtkCallbackCommand.h>
#include <vtkImageData.h>
#include <vtkImageToPentatopeMeshFilter.h>
#include <vtkImageToTetMeshFilter.h>
#include <vtkNew.h>
#include <vtkSegmentationReader.h>

#include <array>
#include <regex>
#include <string_view>
#include <utility>

namespace voxplex::cli
{
namespace
{

using Filter = vtkImageToSimplexMeshFilter;

void Configure(Filter* filter, const Parameters& p, const LabelSelection& selection)
{
  SetParameters(filter, p.Values);
  if (p.Has("isovalue"))
  {
    filter->SetInputModeToIsosurface();
  }
  if (auto* const pentatopes = vtkImageToPentatopeMeshFilter::SafeDownCast(filter))
  {
    pentatopes->SetTimePlanesAtFrames(p.TimePlanesAtFrames);
    for (const double time : p.TimePlanes)
    {
      pentatopes->AddTimePlane(time);
    }
  }
  for (const auto& [labels, size] : selection.InterfaceSizes)
  {
    filter->SetInterfaceSize(labels.first, labels.second, size);
  }
  for (const auto& [label, size] : selection.Sizes)
  {
    filter->SetLabelSize(label, size);
  }
  for (const std::int64_t label : selection.Labels)
  {
    filter->AddLabel(label);
  }
  filter->ComputeQualityOn();
}

void OnProgress(vtkObject* caller, unsigned long, void* clientData, void*)
{
  auto* filter = static_cast<Filter*>(caller);
  const auto& progress = *static_cast<const ProgressFunction*>(clientData);
  const char* step = filter->GetProgressText();
  if (!progress(filter->GetProgress(), step ? step : ""))
  {
    filter->SetAbortExecute(1);
  }
}

} // namespace

int MeshingInput::Dimension() const
{
  return this->Labels->GetNumberOfFrames() > 1 ? 4 : 3;
}

std::string InTermsOfFlags(std::string message)
{
  constexpr std::array<std::pair<std::string_view, std::string_view>, 16> terms{ {
    { "SetLabelSize()", "--label-size" },
    { "SetInterfaceSize()", "--interface-size" },
    { "AddLabel()", "--labels" },
    { "SetSeriesUID()", "--series" },
    { "SetSpacing()", "--spacing" },
    { "SetOrigin()", "--origin" },
    { "SetDirection()", "--direction" },
    { "SetDataFilesAnywhere()", "--data-files-anywhere" },
    { "SetTimeScale()", "--time-scale" },
    { "AddFrameTime()", "--frame-times" },
    { "or force it", "or go on with --force" },
    { "mesh an isosurface of it", "mesh an isosurface of it with --isovalue" },
    { "choose the labels to mesh", "choose the labels to mesh with --labels" },
    { "Correct the labels to keep", "Correct --labels" },
    { ", or choose the array that holds the segmentation", "" },
    { " Choose the array that holds the segmentation.", "" },
  } };
  for (const auto& [theirs, ours] : terms)
  {
    const std::size_t at = message.find(theirs);
    if (at != std::string::npos)
    {
      message.replace(at, theirs.size(), ours);
    }
  }
  static const std::regex series("SetSeriesUID\\(\"([^\"]*)\"\\)");
  return std::regex_replace(message, series, "--series $1");
}

vtkSmartPointer<vtkImageToSimplexMeshFilter> Mesh(
  const Parameters& parameters, const MeshingInput& input, const ProgressFunction& progress)
{
  vtkSmartPointer<Filter> filter = vtkSmartPointer<vtkImageToTetMeshFilter>::New();
  if (input.Dimension() == 4)
  {
    filter = vtkSmartPointer<vtkImageToPentatopeMeshFilter>::New();
  }
  filter->SetInputConnection(input.Labels->GetOutputPort());
  Configure(filter, parameters, input.Selection);
  if (input.Sizes)
  {
    filter->SetElementSizeData(input.Sizes->GetOutput());
  }

  vtkNew<vtkCallbackCommand> observer;
  observer->SetCallback(OnProgress);
  observer->SetClientData(const_cast<ProgressFunction*>(&progress));
  const unsigned long tag = filter->AddObserver(vtkCommand::ProgressEvent, observer);
  filter->Update();
  filter->RemoveObserver(tag);

  if (!filter->GetErrorMessage().empty())
  {
    throw RunError(
      "cannot mesh '" + parameters.Input + "': " + InTermsOfFlags(filter->GetErrorMessage()));
  }
  if (filter->GetAborted())
  {
    return nullptr;
  }
  return filter;
}

} // namespace voxplex::cli
