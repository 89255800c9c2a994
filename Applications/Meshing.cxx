// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Meshing.h"

#include "Errors.h"

#include <vtkCallbackCommand.h>
#include <vtkImageData.h>
#include <vtkImageToPentatopeMeshFilter.h>
#include <vtkImageToTetMeshFilter.h>
#include <vtkNew.h>
#include <vtkSegmentationReader.h>

#include <algorithm>
#include <array>
#include <regex>
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
static_assert(GradingModes[vtkImageToTetMeshFilter::UNIFORM] == "uniform" &&
  GradingModes[vtkImageToTetMeshFilter::LOCAL_FEATURE_SIZE] == "lfs");
static_assert(Sides[vtkImageToTetMeshFilter::INSIDE_ABOVE] == "above" &&
  Sides[vtkImageToTetMeshFilter::INSIDE_BELOW] == "below");

void Configure(Filter* filter, const Parameters& p, const LabelSelection& selection)
{
  if (p.Delta)
  {
    filter->SetDelta(*p.Delta);
  }
  if (p.Elements)
  {
    filter->SetNumberOfElements(*p.Elements);
  }
  if (p.Gradation)
  {
    filter->SetGradation(*p.Gradation);
  }
  for (const auto& [labels, size] : selection.InterfaceSizes)
  {
    filter->SetInterfaceSize(labels.first, labels.second, size);
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
  for (const auto& [label, size] : selection.Sizes)
  {
    filter->SetLabelSize(label, size);
  }
  for (const std::int64_t label : selection.Labels)
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

void SetIsosurface(vtkImageToTetMeshFilter* filter, const Parameters& p)
{
  filter->SetInputModeToIsosurface();
  filter->SetIsovalue(*p.Isovalue);
  if (!p.Inside.empty())
  {
    filter->SetInside(IndexOf(p.Inside, Sides));
  }
  if (p.InsideLabel)
  {
    filter->SetInsideLabel(*p.InsideLabel);
  }
  if (p.SmoothingSigma)
  {
    filter->SetIsosurfaceSmoothingSigma(*p.SmoothingSigma);
  }
}

vtkSmartPointer<Filter> MakeTetMesher(const Parameters& p)
{
  const auto filter = vtkSmartPointer<vtkImageToTetMeshFilter>::New();
  if (!p.Grading.empty())
  {
    filter->SetGrading(IndexOf(p.Grading, GradingModes));
  }
  if (p.FeatureRatio)
  {
    filter->SetFeatureRatio(*p.FeatureRatio);
  }
  if (p.LargestFeature)
  {
    filter->SetLargestFeature(*p.LargestFeature);
  }
  if (p.Isovalue)
  {
    SetIsosurface(filter, p);
  }
  if (p.FacetAngle)
  {
    filter->SetFacetAngle(*p.FacetAngle);
  }
  if (p.SliverAngle)
  {
    filter->SetSliverAngle(*p.SliverAngle);
  }
  filter->SetOptimise(!p.NoOptimise);
  if (p.OptimiseSeconds)
  {
    filter->SetOptimisationTimeLimit(*p.OptimiseSeconds);
  }
  filter->SetSampleJunctions(!p.NoJunctions);
  if (p.InterfaceRounds)
  {
    filter->SetInterfaceRounds(*p.InterfaceRounds);
  }
  filter->SetManifold(!p.NoManifold);
  if (p.SmallestComponent)
  {
    filter->SetSmallestComponent(*p.SmallestComponent);
  }
  filter->SetExactComponents(p.ExactComponents);
  if (p.MinimumComponentVolume)
  {
    filter->SetMinimumComponentVolume(*p.MinimumComponentVolume);
  }
  return filter;
}

vtkSmartPointer<Filter> MakePentatopeMesher(const Parameters& p)
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
  return filter;
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
  constexpr std::array<std::pair<std::string_view, std::string_view>, 10> terms{ {
    { "SetLabelSize()", "--label-size" },
    { "SetInterfaceSize()", "--interface-size" },
    { "AddLabel()", "--labels" },
    { "SetSeriesUID()", "--series" },
    { "SetTimeScale()", "--time-scale" },
    { "or force it", "or go on with --force" },
    { "mesh an isosurface of it", "mesh an isosurface of it with --isovalue" },
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
  const auto filter =
    input.Dimension() == 3 ? MakeTetMesher(parameters) : MakePentatopeMesher(parameters);
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
