// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Meshing.h"

#include "Errors.h"
#include "FilterParameters.h"

#include <vtkImageData.h>
#include <vtkImageToPentatopeMeshFilter.h>
#include <vtkImageToTetMeshFilter.h>
#include <vtkSegmentationReader.h>
#include <vtkSegmentationRepair.h>

namespace voxplex::cli
{
namespace
{

using Filter = vtkImageToSimplexMeshFilter;

void Configure(Filter* filter, const Parameters& p, const ParameterValues& ofLabels)
{
  SetParameters(filter, p.Values);
  SetParameters(filter, ofLabels);
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
  filter->ComputeQualityOn();
  filter->SetVocabulary(static_cast<int>(p.Words)); // the filter has the same numbers
}

} // namespace

int MeshingInput::Dimension() const
{
  return this->Labels->GetNumberOfFrames() > 1 ? 4 : 3;
}

std::vector<double> MeshingInput::TimesOfFrames() const
{
  std::vector<double> times;
  for (int frame = 0; frame < this->Labels->GetNumberOfFrames(); ++frame)
  {
    times.push_back(this->Labels->GetTimeOfFrame(frame));
  }
  return times;
}

vtkAlgorithm* MeshingInput::Source() const
{
  return this->Repair ? static_cast<vtkAlgorithm*>(this->Repair) : this->Labels;
}

vtkImageData* MeshingInput::Image() const
{
  return vtkImageData::SafeDownCast(this->Source()->GetOutputDataObject(0));
}

vtkSmartPointer<vtkImageToSimplexMeshFilter> Mesh(
  const Parameters& parameters, const MeshingInput& input, const ProgressFunction& progress)
{
  vtkSmartPointer<Filter> filter = vtkSmartPointer<vtkImageToTetMeshFilter>::New();
  if (input.Dimension() == 4)
  {
    filter = vtkSmartPointer<vtkImageToPentatopeMeshFilter>::New();
  }
  filter->SetInputConnection(input.Source()->GetOutputPort());
  Configure(filter, parameters, input.Selection);
  if (input.Sizes)
  {
    filter->SetElementSizeData(input.Sizes->GetOutput());
  }

  Execute(filter,
    [&progress](double fraction, const std::string&) { return progress(fraction, "Meshing"); });
  if (!filter->GetErrorMessage().empty())
  {
    throw RunError("cannot mesh '" + parameters.InputName() + "'", filter->GetErrorMessage());
  }
  if (filter->GetAborted())
  {
    return nullptr;
  }
  return filter;
}

} // namespace voxplex::cli
