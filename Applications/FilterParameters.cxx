// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "FilterParameters.h"

#include "Errors.h"

#include <vtkCallbackCommand.h>
#include <vtkImageToPentatopeMeshFilter.h>
#include <vtkImageToTetMeshFilter.h>
#include <vtkNew.h>
#include <vtkSegmentationReader.h>
#include <vtkSegmentationRepair.h>

namespace voxplex::cli
{
namespace
{

using Filter = vtkImageToSimplexMeshFilter;
using Tets = vtkImageToTetMeshFilter;
using Pentatopes = vtkImageToPentatopeMeshFilter;
using Repair = vtkSegmentationRepair;
using Setter = std::function<void(vtkAlgorithm*, double)>;

template <class F, class T>
Setter To(void (F::*set)(T))
{
  return [set](vtkAlgorithm* filter, double value)
  { (static_cast<F*>(filter)->*set)(static_cast<T>(value)); };
}

const std::map<std::string, Setter, std::less<>>& Setters()
{
  static const std::map<std::string, Setter, std::less<>> setters{
#include "Setters.inc" // from the table
  };
  return setters;
}

void OnProgress(vtkObject* caller, unsigned long, void* clientData, void*)
{
  auto* const filter = static_cast<vtkAlgorithm*>(caller);
  const char* const step = filter->GetProgressText();
  if (!(*static_cast<const ProgressFunction*>(clientData))(filter->GetProgress(), step ? step : ""))
  {
    filter->SetAbortExecute(1);
  }
}

} // namespace

void SetParameters(vtkImageToSimplexMeshFilter* filter, const ParameterValues& values)
{
  for (const auto& [name, value] : values)
  {
    if (!FindParameter(name).IsOfRepair())
    {
      Setters().at(name)(filter, value);
    }
  }
}

vtkSmartPointer<vtkSegmentationRepair> MakeRepair(
  const ParameterValues& values, const LabelSelection& selection, UserInterface words)
{
  bool isAsked = !selection.Thicknesses.empty() || !selection.Shells.empty();
  auto repair = vtkSmartPointer<Repair>::New();
  for (const auto& [name, value] : values)
  {
    if (FindParameter(name).IsOfRepair())
    {
      Setters().at(name)(repair, value);
      isAsked = isAsked || value != 0.0;
    }
  }
  for (const auto& [label, length] : selection.Thicknesses)
  {
    repair->SetMinimumThickness(label, length);
  }
  for (const auto& [label, thickness] : selection.Shells)
  {
    repair->SetShell(label, thickness);
  }
  repair->SetNumberOfThreads(static_cast<int>(values.at("threads")));
  repair->SetVocabulary(static_cast<int>(words)); // the filter has the same numbers
  return isAsked ? repair : nullptr;
}

void SetLabels(vtkImageToSimplexMeshFilter* filter, const LabelSelection& selection)
{
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
}

std::vector<std::string> ReadImage(vtkSegmentationReader* reader, UserInterface interface)
{
  reader->Update();
  if (!reader->GetErrorMessage().empty())
  {
    throw RunError(InTermsOf(interface, reader->GetErrorMessage()));
  }
  std::vector<std::string> warnings = WarningsOf(reader);
  for (std::string& warning : warnings)
  {
    warning = InTermsOf(interface, warning);
  }
  return warnings;
}

void Execute(vtkAlgorithm* filter, const ProgressFunction& progress)
{
  vtkNew<vtkCallbackCommand> observer;
  observer->SetCallback(OnProgress);
  observer->SetClientData(const_cast<ProgressFunction*>(&progress));
  const unsigned long tag = filter->AddObserver(vtkCommand::ProgressEvent, observer);
  filter->Update();
  filter->RemoveObserver(tag);
}

} // namespace voxplex::cli
