// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Meshing.h"

#include "Errors.h"
#include "FrameSource.h"
#include "VTKImage.h"

#include <vtkCallbackCommand.h>
#include <vtkImageData.h>
#include <vtkImageToPentatopeMeshFilter.h>
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
using Filter = vtkImageToSimplexMeshFilter;
static_assert(ContentionManagers[Filter::CONTENTION_AGGRESSIVE] == "aggressive" &&
  ContentionManagers[Filter::CONTENTION_RANDOM] == "random" &&
  ContentionManagers[Filter::CONTENTION_GLOBAL] == "global" &&
  ContentionManagers[Filter::CONTENTION_LOCAL] == "local");
static_assert(LoadBalancers[Filter::RANDOM_WORK_STEALING] == "rws" &&
  LoadBalancers[Filter::HIERARCHICAL_WORK_STEALING] == "hws");
static_assert(RuleOrders[vtkImageToPentatopeMeshFilter::RADIUS_EDGE_FIRST] == "radius-edge" &&
  RuleOrders[vtkImageToPentatopeMeshFilter::SURFACE_FIRST] == "surface");

void Configure(Filter* filter, const Parameters& p)
{
  if (p.Delta)
  {
    filter->SetDelta(*p.Delta);
  }
  if (p.RadiusEdgeRatio)
  {
    filter->SetRadiusEdgeRatio(*p.RadiusEdgeRatio);
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

vtkSmartPointer<Filter> MakeTetMesher(const Parameters& p, const ScalarImage& labels)
{
  const auto filter = vtkSmartPointer<vtkImageToTetMeshFilter>::New();
  if (p.FacetAngle)
  {
    filter->SetFacetAngle(*p.FacetAngle);
  }
  const auto image = ToVTKImage(labels, p.OutputSpace);
  AddSpaceArray(image, p.OutputSpace);
  filter->SetInputData(image);
  return filter;
}

vtkSmartPointer<Filter> MakePentatopeMesher(const Parameters& p, const ScalarImage& frames)
{
  const SpaceTimeParameters& spaceTime = p.SpaceTime;
  const auto filter = vtkSmartPointer<vtkImageToPentatopeMeshFilter>::New();
  if (spaceTime.TimeScale)
  {
    filter->SetTimeScale(*spaceTime.TimeScale);
  }
  if (!spaceTime.RuleOrder.empty())
  {
    filter->SetRuleOrder(IndexOf(spaceTime.RuleOrder, RuleOrders));
  }
  filter->SetPickingRegions(!spaceTime.NoPicking);
  if (spaceTime.Picks)
  {
    filter->SetNumberOfPicks(*spaceTime.Picks);
  }
  if (spaceTime.SliverBound)
  {
    filter->SetSliverBound(*spaceTime.SliverBound);
  }
  if (spaceTime.Seed)
  {
    filter->SetRandomSeed(*spaceTime.Seed);
  }
  filter->SetFineGrained(!spaceTime.NoFineGrained);
  vtkNew<FrameSource> source;
  source->SetFrames(frames, p.OutputSpace);
  filter->SetInputConnection(source->GetOutputPort());
  return filter;
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
  auto* filter = static_cast<Filter*>(caller);
  const auto& progress = *static_cast<const ProgressFunction*>(clientData);
  const char* step = filter->GetProgressText();
  if (!progress(filter->GetProgress(), step ? step : ""))
  {
    filter->SetAbortExecute(1);
  }
}

} // namespace

vtkSmartPointer<vtkImageToSimplexMeshFilter> Mesh(
  const Parameters& parameters, const MeshingInput& input, const ProgressFunction& progress)
{
  const auto filter = input.Labels.Dimension() == 3 ? MakeTetMesher(parameters, input.Labels)
                                                    : MakePentatopeMesher(parameters, input.Labels);
  Configure(filter, parameters);
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
