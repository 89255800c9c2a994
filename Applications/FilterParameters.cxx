// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "FilterParameters.h"

#include "FileError.h"

#include <vtkCallbackCommand.h>
#include <vtkImageToPentatopeMeshFilter.h>
#include <vtkImageToTetMeshFilter.h>
#include <vtkNew.h>
#include <vtkSegmentationReader.h>
#include <vtkSegmentationRepair.h>

#include <concepts>
#include <type_traits>

namespace voxplex::cli
{
namespace
{

using Filter = vtkImageToSimplexMeshFilter;
using Tets = vtkImageToTetMeshFilter;
using Pentatopes = vtkImageToPentatopeMeshFilter;
using Repair = vtkSegmentationRepair;
using Reader = vtkSegmentationReader;
using Setter = std::function<void(vtkAlgorithm*, const ParameterValue&)>;

/** One value, or one after the other: times, and labels. */
template <class F, class T>
Setter To(void (F::*set)(T))
{
  return [set](vtkAlgorithm* algorithm, const ParameterValue& value)
  {
    auto* const object = static_cast<F*>(algorithm);
    if constexpr (std::is_same_v<T, const char*>)
    {
      (object->*set)(std::get<std::string>(value).c_str());
    }
    else if constexpr (std::is_same_v<T, const double*>)
    {
      (object->*set)(std::get<std::vector<double>>(value).data());
    }
    else if (const double* const number = std::get_if<double>(&value))
    {
      (object->*set)(static_cast<T>(*number));
    }
    else if (const auto* const labels = std::get_if<LabelValues>(&value))
    {
      for (const auto& [label, size] : *labels)
      {
        (object->*set)(static_cast<T>(label.first));
      }
    }
    else
    {
      for (const double one : std::get<std::vector<double>>(value))
      {
        (object->*set)(static_cast<T>(one));
      }
    }
  };
}

/** Sizes of labels. */
template <class F, std::integral Label>
Setter To(void (F::*set)(Label, double))
{
  return [set](vtkAlgorithm* algorithm, const ParameterValue& value)
  {
    for (const auto& [label, size] : std::get<LabelValues>(value))
    {
      (static_cast<F*>(algorithm)->*set)(label.first, size);
    }
  };
}

/** Sizes of interfaces. */
template <class F, std::integral Label>
Setter To(void (F::*set)(Label, Label, double))
{
  return [set](vtkAlgorithm* algorithm, const ParameterValue& value)
  {
    for (const auto& [labels, size] : std::get<LabelValues>(value))
    {
      (static_cast<F*>(algorithm)->*set)(labels.first, labels.second, size);
    }
  };
}

const std::map<std::string, Setter, std::less<>>& Setters()
{
  static const std::map<std::string, Setter, std::less<>> setters{
#include "Setters.inc" // from the table
  };
  return setters;
}

/** Those for which the predicate holds. Whoever has an image of sizes sets it. */
template <typename TPredicate>
void Set(vtkAlgorithm* algorithm, const ParameterValues& values, TPredicate&& isOfAlgorithm)
{
  for (const auto& [name, value] : values)
  {
    const MeshingParameter& parameter = FindParameter(name);
    if (parameter.Kind != ParameterKind::Image && isOfAlgorithm(parameter))
    {
      Setters().at(name)(algorithm, value);
    }
  }
}

bool IsOfReader(const MeshingParameter& parameter)
{
  return parameter.IsOfReading() || parameter.Kind == ParameterKind::Times;
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
  Set(filter, values,
    [](const MeshingParameter& parameter)
    { return !IsOfReader(parameter) && !parameter.IsOfRepair(); });
}

vtkSmartPointer<vtkSegmentationRepair> MakeRepair(
  const ParameterValues& values, const ParameterValues& ofLabels, UserInterface words)
{
  bool isAsked = !ofLabels.empty();
  for (const auto& [name, value] : values)
  {
    isAsked = isAsked || (FindParameter(name).IsOfRepair() && std::get<double>(value) != 0.0);
  }
  if (!isAsked)
  {
    return nullptr;
  }
  auto repair = vtkSmartPointer<Repair>::New();
  for (const ParameterValues* const some : { &values, &ofLabels })
  {
    Set(repair, *some, [](const MeshingParameter& parameter) { return parameter.IsOfRepair(); });
  }
  repair->SetNumberOfThreads(static_cast<int>(std::get<double>(values.at("threads"))));
  repair->SetVocabulary(static_cast<int>(words)); // the filter has the same numbers
  return repair;
}

std::vector<std::string> ReadImage(
  vtkSegmentationReader* reader, const ParameterValues& values, UserInterface interface)
{
  Set(reader, values, IsOfReader);
  reader->Update();
  if (!reader->GetErrorMessage().empty())
  {
    throw io::FileError(InTermsOf(interface, reader->GetErrorMessage()));
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
