// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Meshing.h"

#include "Errors.h"
#include "VTKImage.h"

#include <vtkCallbackCommand.h>
#include <vtkImageData.h>
#include <vtkImageToTetMeshFilter.h>
#include <vtkNew.h>

#include <algorithm>
#include <array>
#include <span>
#include <string_view>
#include <utility>

namespace voxplex::cli
{
namespace
{

/** Which of the words this is, which is also the filter's number for it. */
int IndexOf(std::string_view word, std::span<const std::string_view> words)
{
  return static_cast<int>(std::find(words.begin(), words.end(), word) - words.begin());
}
static_assert(ContentionManagers[vtkImageToTetMeshFilter::CONTENTION_AGGRESSIVE] == "aggressive" &&
  ContentionManagers[vtkImageToTetMeshFilter::CONTENTION_RANDOM] == "random" &&
  ContentionManagers[vtkImageToTetMeshFilter::CONTENTION_GLOBAL] == "global" &&
  ContentionManagers[vtkImageToTetMeshFilter::CONTENTION_LOCAL] == "local");
static_assert(LoadBalancers[vtkImageToTetMeshFilter::RANDOM_WORK_STEALING] == "rws" &&
  LoadBalancers[vtkImageToTetMeshFilter::HIERARCHICAL_WORK_STEALING] == "hws");

void Configure(vtkImageToTetMeshFilter* filter, const Parameters& p)
{
  if (p.Delta)
  {
    filter->SetDelta(*p.Delta);
  }
  if (p.RadiusEdgeRatio)
  {
    filter->SetRadiusEdgeRatio(*p.RadiusEdgeRatio);
  }
  if (p.FacetAngle)
  {
    filter->SetFacetAngle(*p.FacetAngle);
  }
  if (p.SmoothingSigma)
  {
    filter->SetSmoothingSigma(*p.SmoothingSigma);
  }
  if (p.Size)
  {
    filter->SetElementSize(*p.Size);
  }
  for (const auto& [label, size] : p.LabelSizes)
  {
    filter->SetLabelSize(label, size);
  }
  for (const std::int64_t label : p.Labels)
  {
    filter->AddLabel(label);
  }
  filter->SetNumberOfThreads(p.Threads);
  if (!p.Contention.empty())
  {
    filter->SetContentionManager(IndexOf(p.Contention, ContentionManagers));
  }
  if (!p.Balance.empty())
  {
    filter->SetLoadBalancer(IndexOf(p.Balance, LoadBalancers));
  }
  filter->SetPinThreads(p.PinThreads);
  filter->SetForce(p.Force);
  filter->SetMemoryLimit(p.MemoryLimit);
  filter->ComputeQualityOn();
}

/** The filter's errors speak of its methods; the user has flags. */
std::string InTermsOfFlags(std::string message)
{
  constexpr std::array<std::pair<std::string_view, std::string_view>, 6> terms{ {
    { "SetLabelSize()", "--label-size" },
    { "AddLabel()", "--labels" },
    { "or force it", "or go on with --force" },
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
  return message;
}

void OnProgress(vtkObject* caller, unsigned long, void* clientData, void*)
{
  auto* filter = static_cast<vtkImageToTetMeshFilter*>(caller);
  const auto& progress = *static_cast<const ProgressFunction*>(clientData);
  const char* step = filter->GetProgressText();
  if (!progress(filter->GetProgress(), step ? step : ""))
  {
    filter->SetAbortExecute(1);
  }
}

} // namespace

vtkSmartPointer<vtkImageToTetMeshFilter> Mesh(
  const Parameters& parameters, const MeshingInput& input, const ProgressFunction& progress)
{
  const auto filter = vtkSmartPointer<vtkImageToTetMeshFilter>::New();
  Configure(filter, parameters);

  const auto image = ToVTKImage(input.Labels, parameters.OutputSpace);
  AddSpaceArray(image, parameters.OutputSpace);
  filter->SetInputData(image);
  if (input.Sizes)
  {
    filter->SetElementSizeData(ToVTKImage(*input.Sizes, parameters.OutputSpace));
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
