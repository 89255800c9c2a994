// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Meshing.h"

#include "Errors.h"
#include "FilterParameters.h"

#include <vtkImageData.h>
#include <vtkImageToPentatopeMeshFilter.h>
#include <vtkImageToTetMeshFilter.h>
#include <vtkSegmentationReader.h>

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
  SetLabels(filter, selection);
  filter->ComputeQualityOn();
  filter->SetVocabulary(Filter::VOCABULARY_COMMAND_LINE);
}

} // namespace

int MeshingInput::Dimension() const
{
  return this->Labels->GetNumberOfFrames() > 1 ? 4 : 3;
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

  Execute(filter, progress);
  if (!filter->GetErrorMessage().empty())
  {
    throw RunError("cannot mesh '" + parameters.Input + "': " + filter->GetErrorMessage());
  }
  if (filter->GetAborted())
  {
    return nullptr;
  }
  return filter;
}

} // namespace voxplex::cli
