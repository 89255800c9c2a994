// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "FilterParameters.h"

#include <vtkImageToPentatopeMeshFilter.h>
#include <vtkImageToTetMeshFilter.h>

#include <functional>

namespace voxplex::cli
{
namespace
{

using Filter = vtkImageToSimplexMeshFilter;
using Tets = vtkImageToTetMeshFilter;
using Pentatopes = vtkImageToPentatopeMeshFilter;
using Setter = std::function<void(Filter*, double)>;

template <class F, class T>
Setter To(void (F::*set)(T))
{
  return [set](Filter* filter, double value)
  { (static_cast<F*>(filter)->*set)(static_cast<T>(value)); };
}

const std::map<std::string, Setter, std::less<>>& Setters()
{
  static const std::map<std::string, Setter, std::less<>> setters{
    { "isovalue", To(&Filter::SetIsovalue) },
    { "inside", To(&Filter::SetInside) },
    { "inside-label", To(&Filter::SetInsideLabel) },
    { "grey-smoothing", To(&Filter::SetIsosurfaceSmoothingSigma) },
    { "delta", To(&Filter::SetDelta) },
    { "elements", To(&Filter::SetNumberOfElements) },
    { "grading", To(&Filter::SetGrading) },
    { "size", To(&Filter::SetElementSize) },
    { "optimise", To(&Filter::SetOptimise) },
    { "smallest-component", To(&Filter::SetSmallestComponent) },
    { "exact-components", To(&Filter::SetExactComponents) },
    { "min-component-volume", To(&Tets::SetMinimumComponentVolume) },
    { "feature-ratio", To(&Filter::SetFeatureRatio) },
    { "largest-feature", To(&Filter::SetLargestFeature) },
    { "gradation", To(&Filter::SetGradation) },
    { "radius-edge", To(&Filter::SetRadiusEdgeRatio) },
    { "facet-angle", To(&Tets::SetFacetAngle) },
    { "smoothing", To(&Filter::SetSmoothingSigma) },
    { "sliver-angle", To(&Tets::SetSliverAngle) },
    { "optimise-seconds", To(&Tets::SetOptimisationTimeLimit) },
    { "junctions", To(&Tets::SetSampleJunctions) },
    { "interface-rounds", To(&Filter::SetInterfaceRounds) },
    { "manifold", To(&Filter::SetManifold) },
    { "time-scale", To(&Pentatopes::SetTimeScale) },
    { "frame-steps", To(&Pentatopes::SetFrameSteps) },
    { "fit", To(&Pentatopes::SetFitInterfaces) },
    { "periodic", To(&Pentatopes::SetPeriodic) },
    { "rule-order", To(&Pentatopes::SetRuleOrder) },
    { "picking", To(&Pentatopes::SetPickingRegions) },
    { "picks", To(&Pentatopes::SetNumberOfPicks) },
    { "sliver-bound", To(&Pentatopes::SetSliverBound) },
    { "seed", To(&Pentatopes::SetRandomSeed) },
    { "fine-grained", To(&Pentatopes::SetFineGrained) },
    { "threads", To(&Filter::SetNumberOfThreads) },
    { "contention", To(&Filter::SetContentionManager) },
    { "balance", To(&Filter::SetLoadBalancer) },
    { "pin", To(&Filter::SetPinThreads) },
    { "reproducible", To(&Filter::SetReproducible) },
    { "memory-limit", To(&Filter::SetMemoryLimit) },
    { "force", To(&Filter::SetForce) },
  };
  return setters;
}

} // namespace

void SetParameters(vtkImageToSimplexMeshFilter* filter, const ParameterValues& values)
{
  for (const auto& [name, value] : values)
  {
    Setters().at(name)(filter, value);
  }
}

} // namespace voxplex::cli
