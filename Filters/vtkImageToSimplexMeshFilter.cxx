// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkImageToSimplexMeshFilter.h"

#include "Private/MeshingMessages.h"
#include "Private/SimplexMeshRun.h"
#include "Private/SmpThreads.h"

#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"
#include "vtkExecutive.h"
#include "vtkFieldData.h"
#include "vtkInformation.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkVersion.h"

#include <cmath>
#include <exception>
#include <limits>
#include <new>
#include <sstream>

namespace
{

using voxplex::InputError;

// The class's constants are the kernel's: casts lead from one to the other.
using Filter = vtkImageToSimplexMeshFilter;
static_assert(Filter::CONTENTION_RANDOM == static_cast<int>(voxplex::ContentionPolicy::Random) &&
  Filter::CONTENTION_GLOBAL == static_cast<int>(voxplex::ContentionPolicy::Global) &&
  Filter::CONTENTION_LOCAL == static_cast<int>(voxplex::ContentionPolicy::Local));
static_assert(Filter::UNIFORM == static_cast<int>(voxplex::GradingMode::Uniform) &&
  Filter::LOCAL_FEATURE_SIZE == static_cast<int>(voxplex::GradingMode::LocalFeatureSize));
static_assert(static_cast<std::int64_t>(Filter::ANY_LABEL) == voxplex::InterfaceSize::AnyLabel);
static_assert(
  Filter::HIERARCHICAL_WORK_STEALING == static_cast<int>(voxplex::BalancePolicy::Hierarchical));

/** A size that was given as a number. */
void CheckSize(double size, const std::string& what)
{
  if (!(size > 0.0) || !std::isfinite(size))
  {
    std::ostringstream text;
    text << what << " is " << size << "; it must be positive and finite.";
    throw InputError(text.str());
  }
}

/** The labels of an interface, in the order of the table: the larger first, so ANY_LABEL comes last. */
std::pair<std::int64_t, std::int64_t> InterfaceOf(std::int64_t label, std::int64_t other)
{
  return { std::max(label, other), std::min(label, other) };
}

std::string NameOf(const std::pair<std::int64_t, std::int64_t>& interface)
{
  return interface.second == Filter::ANY_LABEL
    ? "all interfaces of label " + std::to_string(interface.first)
    : "the interface of labels " + std::to_string(interface.first) + " and " +
      std::to_string(interface.second);
}

/** Whether the piece that is asked for is one that stays empty. */
bool IsEmptyPiece(vtkInformation* output)
{
  return output->Has(vtkStreamingDemandDrivenPipeline::UPDATE_PIECE_NUMBER()) &&
    output->Get(vtkStreamingDemandDrivenPipeline::UPDATE_PIECE_NUMBER()) > 0;
}

} // namespace

//----------------------------------------------------------------------------------------------------
vtkImageToSimplexMeshFilter::vtkImageToSimplexMeshFilter()
  : Private(std::make_unique<Internals>())
{
  this->SetNumberOfInputPorts(2);
  this->SetNumberOfOutputPorts(2);
  for (int port = 0; port < 2; ++port)
  {
    this->SetInputArrayToProcess(port, port, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS_THEN_CELLS,
      vtkDataSetAttributes::SCALARS);
  }
}

vtkImageToSimplexMeshFilter::~vtkImageToSimplexMeshFilter() = default;

//----------------------------------------------------------------------------------------------------
void vtkImageToSimplexMeshFilter::SetLabelSize(vtkTypeInt64 label, double size)
{
  const auto found = this->Private->LabelSizes.find(label);
  if (found == this->Private->LabelSizes.end() || found->second != size)
  {
    this->Private->LabelSizes[label] = size;
    this->Modified();
  }
}

double vtkImageToSimplexMeshFilter::GetLabelSize(vtkTypeInt64 label) const
{
  const auto found = this->Private->LabelSizes.find(label);
  return found == this->Private->LabelSizes.end() ? 0.0 : found->second;
}

void vtkImageToSimplexMeshFilter::RemoveLabelSize(vtkTypeInt64 label)
{
  if (this->Private->LabelSizes.erase(label) > 0)
  {
    this->Modified();
  }
}

void vtkImageToSimplexMeshFilter::ClearLabelSizes()
{
  if (!this->Private->LabelSizes.empty())
  {
    this->Private->LabelSizes.clear();
    this->Modified();
  }
}

int vtkImageToSimplexMeshFilter::GetNumberOfLabelSizes() const
{
  return static_cast<int>(this->Private->LabelSizes.size());
}

vtkTypeInt64 vtkImageToSimplexMeshFilter::GetSizedLabel(int index) const
{
  return index >= 0 && index < this->GetNumberOfLabelSizes()
    ? std::next(this->Private->LabelSizes.begin(), index)->first
    : 0;
}

//----------------------------------------------------------------------------------------------------
void vtkImageToSimplexMeshFilter::SetInterfaceSize(
  vtkTypeInt64 label, vtkTypeInt64 other, double size)
{
  const auto [place, isNew] =
    this->Private->InterfaceSizes.try_emplace(InterfaceOf(label, other), size);
  if (isNew || place->second != size)
  {
    place->second = size;
    this->Modified();
  }
}

double vtkImageToSimplexMeshFilter::GetInterfaceSize(vtkTypeInt64 label, vtkTypeInt64 other) const
{
  const auto found = this->Private->InterfaceSizes.find(InterfaceOf(label, other));
  return found == this->Private->InterfaceSizes.end() ? 0.0 : found->second;
}

void vtkImageToSimplexMeshFilter::RemoveInterfaceSize(vtkTypeInt64 label, vtkTypeInt64 other)
{
  if (this->Private->InterfaceSizes.erase(InterfaceOf(label, other)) > 0)
  {
    this->Modified();
  }
}

void vtkImageToSimplexMeshFilter::ClearInterfaceSizes()
{
  if (!this->Private->InterfaceSizes.empty())
  {
    this->Private->InterfaceSizes.clear();
    this->Modified();
  }
}

int vtkImageToSimplexMeshFilter::GetNumberOfInterfaceSizes() const
{
  return static_cast<int>(this->Private->InterfaceSizes.size());
}

void vtkImageToSimplexMeshFilter::GetSizedInterface(int index, vtkTypeInt64 labels[2]) const
{
  labels[0] = labels[1] = ANY_LABEL;
  if (index >= 0 && index < this->GetNumberOfInterfaceSizes())
  {
    const auto& interface = std::next(this->Private->InterfaceSizes.begin(), index)->first;
    labels[0] = interface.first;
    labels[1] = interface.second;
  }
}

//----------------------------------------------------------------------------------------------------
void vtkImageToSimplexMeshFilter::AddLabel(vtkTypeInt64 label)
{
  if (this->Private->Labels.insert(label).second)
  {
    this->Modified();
  }
}

void vtkImageToSimplexMeshFilter::RemoveLabel(vtkTypeInt64 label)
{
  if (this->Private->Labels.erase(label) > 0)
  {
    this->Modified();
  }
}

void vtkImageToSimplexMeshFilter::RemoveAllLabels()
{
  if (!this->Private->Labels.empty())
  {
    this->Private->Labels.clear();
    this->Modified();
  }
}

int vtkImageToSimplexMeshFilter::GetNumberOfSelectedLabels() const
{
  return static_cast<int>(this->Private->Labels.size());
}

vtkTypeInt64 vtkImageToSimplexMeshFilter::GetSelectedLabel(int index) const
{
  return index >= 0 && index < this->GetNumberOfSelectedLabels()
    ? *std::next(this->Private->Labels.begin(), index)
    : 0;
}

//----------------------------------------------------------------------------------------------------
void vtkImageToSimplexMeshFilter::ExcludeLabel(vtkTypeInt64 label)
{
  if (this->Private->ExcludedLabels.insert(label).second)
  {
    this->Modified();
  }
}

void vtkImageToSimplexMeshFilter::RemoveExcludedLabel(vtkTypeInt64 label)
{
  if (this->Private->ExcludedLabels.erase(label) > 0)
  {
    this->Modified();
  }
}

void vtkImageToSimplexMeshFilter::RemoveAllExcludedLabels()
{
  if (!this->Private->ExcludedLabels.empty())
  {
    this->Private->ExcludedLabels.clear();
    this->Modified();
  }
}

int vtkImageToSimplexMeshFilter::GetNumberOfExcludedLabels() const
{
  return static_cast<int>(this->Private->ExcludedLabels.size());
}

vtkTypeInt64 vtkImageToSimplexMeshFilter::GetExcludedLabel(int index) const
{
  return index >= 0 && index < this->GetNumberOfExcludedLabels()
    ? *std::next(this->Private->ExcludedLabels.begin(), index)
    : 0;
}

//----------------------------------------------------------------------------------------------------
void vtkImageToSimplexMeshFilter::SetLabelRow(vtkTypeInt64 label, double size, bool meshed)
{
  if (meshed)
  {
    this->RemoveExcludedLabel(label);
  }
  else
  {
    this->ExcludeLabel(label);
  }
  if (meshed && size != 0.0)
  {
    this->SetLabelSize(label, size);
  }
  else
  {
    this->RemoveLabelSize(label);
  }
}

void vtkImageToSimplexMeshFilter::ClearLabelRows()
{
  this->ClearLabelSizes();
  this->RemoveAllExcludedLabels();
}

//----------------------------------------------------------------------------------------------------
void vtkImageToSimplexMeshFilter::SetInputArrayToProcess(
  int index, int port, int connection, int association, const char* name)
{
  if (name && *name)
  {
    this->Superclass::SetInputArrayToProcess(index, port, connection, association, name);
  }
  else
  {
    this->Superclass::SetInputArrayToProcess(index, port, connection,
      vtkDataObject::FIELD_ASSOCIATION_POINTS_THEN_CELLS, vtkDataSetAttributes::SCALARS);
  }
}

void vtkImageToSimplexMeshFilter::SetElementSizeData(vtkImageData* image)
{
  this->SetInputData(1, image);
}

void vtkImageToSimplexMeshFilter::SetSizeFunction(SizeFunctionType function)
{
  this->Private->SizeFunction = std::move(function);
  this->Modified();
}

const char* vtkImageToSimplexMeshFilter::GetContentionManagerAsString() const
{
  return voxplex::ContentionPolicyNames[static_cast<std::size_t>(this->ContentionManager)].data();
}

const char* vtkImageToSimplexMeshFilter::GetLoadBalancerAsString() const
{
  return voxplex::BalancePolicyNames[static_cast<std::size_t>(this->LoadBalancer)].data();
}

vtkMeshingStatistics* vtkImageToSimplexMeshFilter::GetStatistics() const
{
  return this->Private->Statistics;
}

//----------------------------------------------------------------------------------------------------
int vtkImageToSimplexMeshFilter::FillInputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  if (port == 1)
  {
    info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  }
  return 1;
}

int vtkImageToSimplexMeshFilter::RequestInformation(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  this->DefaultDelta = this->FindDefaultDelta(inputVector);
  for (int port = 0; port < this->GetNumberOfOutputPorts(); ++port)
  {
    outputVector->GetInformationObject(port)->Set(vtkAlgorithm::CAN_HANDLE_PIECE_REQUEST(), 1);
  }
  return 1;
}

int vtkImageToSimplexMeshFilter::RequestUpdateExtent(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector*)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  for (int port = 0; port < this->GetNumberOfInputPorts(); ++port)
  {
    vtkInformation* info = inputVector[port]->GetInformationObject(0);
    if (info == nullptr)
    {
      continue;
    }
    if (info->Has(Pipeline::WHOLE_EXTENT()))
    {
      info->Set(Pipeline::UPDATE_EXTENT(), info->Get(Pipeline::WHOLE_EXTENT()), 6);
    }
    info->Set(Pipeline::UPDATE_PIECE_NUMBER(), 0);
    info->Set(Pipeline::UPDATE_NUMBER_OF_PIECES(), 1);
    info->Set(Pipeline::UPDATE_NUMBER_OF_GHOST_LEVELS(), 0);
  }
  return 1;
}

//----------------------------------------------------------------------------------------------------
int vtkImageToSimplexMeshFilter::RequestData(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  this->ErrorMessage.clear();
  this->Aborted = false;
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 2, 20220823)
  if (!request->Get(Pipeline::CONTINUE_EXECUTING()))
  {
    // What stopped the last execution does not stop this one. In VTK 9.2 and before the executive sees to it.
    this->AbortExecute = 0;
  }
#endif
  this->Private->Statistics->Initialize();
  const auto clearOutputs = [this, outputVector]
  {
    for (int port = 0; port < this->GetNumberOfOutputPorts(); ++port)
    {
      vtkDataObject::GetData(outputVector, port)->Initialize();
    }
  };
  clearOutputs();
  // The executive takes all outputs for the piece that the asking port wants.
  const int asking = std::max(0, request->Get(vtkExecutive::FROM_OUTPUT_PORT()));
  if (IsEmptyPiece(outputVector->GetInformationObject(asking)))
  {
    return 1;
  }

  try
  {
    this->CheckParameters();
    if (!this->Gather(request, inputVector))
    {
      this->ErrorMessage = "The input failed before it had delivered all time steps."; // if it does
      request->Set(Pipeline::CONTINUE_EXECUTING(), 1);
      return 1;
    }
    if (!this->Aborted)
    {
      this->Mesh(inputVector, outputVector);
    }
  }
  catch (const voxplex::Error& error)
  {
    this->ErrorMessage = error.what();
  }
  catch (const std::bad_alloc&)
  {
    this->ErrorMessage = "There is not enough memory for this mesh; increase Delta, or mesh fewer "
                         "labels.";
  }
  catch (const std::exception& error)
  {
    this->ErrorMessage = std::string("Meshing failed: ") + error.what();
  }
  catch (...)
  {
    this->ErrorMessage = "Meshing failed: the size function threw something that is not a "
                         "std::exception.";
  }
  request->Remove(Pipeline::CONTINUE_EXECUTING());
  this->Aborted = this->Aborted && this->ErrorMessage.empty();
  if (this->ErrorMessage.empty() && !this->Aborted)
  {
    vtkFieldData* fields = vtkDataObject::GetData(inputVector[0])->GetFieldData();
    for (int port = 0; port < this->GetNumberOfOutputPorts(); ++port)
    {
      vtkDataObject::GetData(outputVector, port)->GetFieldData()->PassData(fields);
    }
    for (const std::string& warning : voxplex::WarningsOf(this->Private->Statistics->Edit(),
           this->GetContentionManagerAsString(), this->ExactComponents))
    {
      vtkWarningMacro(<< warning);
    }
    return 1;
  }
  clearOutputs();
  this->Private->Statistics->Initialize();
  if (this->Aborted)
  {
    return 1;
  }
  vtkErrorMacro(<< this->ErrorMessage);
  return 0;
}

bool vtkImageToSimplexMeshFilter::Gather(vtkInformation*, vtkInformationVector**)
{
  return true;
}

//----------------------------------------------------------------------------------------------------
void vtkImageToSimplexMeshFilter::CheckParameters() const
{
  using voxplex::CheckRange;
  constexpr double largest = std::numeric_limits<double>::max();
  CheckRange(
    this->Delta, 0.0, largest, "Delta", "positive and finite, or 0 to derive it from the spacing");
  CheckRange(
    this->SmoothingSigma, 0.0, largest, "SmoothingSigma", "positive and finite, or 0 for none");
  CheckRange(this->ElementSize, 0.0, largest, "ElementSize", "positive and finite, or 0 for none");
  CheckRange(this->RadiusEdgeRatio, this->Force ? 1.0 : voxplex::SmallestRadiusEdgeRatio, largest,
    "RadiusEdgeRatio",
    this->Force ? "at least 1"
                : "at least 1.93, because below meshes can become very large; Force goes down "
                  "to 1");
  for (const auto& [label, size] : this->Private->LabelSizes)
  {
    CheckSize(size, "The size of label " + std::to_string(label));
  }
  CheckRange(this->Gradation, 0.0, largest, "Gradation", "positive and finite, or 0 for no limit");
  constexpr double tiny = std::numeric_limits<double>::min();
  CheckRange(this->FeatureRatio, tiny, largest, "FeatureRatio", "positive and finite");
  CheckRange(this->LargestFeature, tiny, largest, "LargestFeature", "positive and finite");
  for (const auto& [interface, size] : this->Private->InterfaceSizes)
  {
    if (interface.second < ANY_LABEL || interface.first < 0 || interface.first == interface.second)
    {
      throw InputError("SetInterfaceSize() takes two different labels, or a label and ANY_LABEL "
                       "(-1); these are " +
        std::to_string(interface.first) + " and " + std::to_string(interface.second) + ".");
    }
    CheckSize(size, "The size of " + NameOf(interface));
  }
  if (this->NumberOfElements > 0 && this->Delta > 0.0 && !this->DeltaIsSuggestion)
  {
    throw InputError("Both Delta and NumberOfElements are set; Delta is what meshing finds for a "
                     "NumberOfElements: set one of the two to 0.");
  }
}

const char* vtkImageToSimplexMeshFilter::GetInputModeAsString() const
{
  return this->InputMode == INPUT_LABELS ? "labels" : "isosurface";
}

const char* vtkImageToSimplexMeshFilter::GetGradingAsString() const
{
  return this->Grading == UNIFORM ? "uniform" : "local-feature-size";
}

const char* vtkImageToSimplexMeshFilter::GetInsideAsString() const
{
  return this->Inside == INSIDE_ABOVE ? "above" : "below";
}

unsigned vtkImageToSimplexMeshFilter::GetThreads() const
{
  return static_cast<unsigned>(
    this->NumberOfThreads > 0 ? this->NumberOfThreads : voxplex::SmpThreads());
}

bool vtkImageToSimplexMeshFilter::StopRequested()
{
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 3, 0)
  const bool stop = this->CheckAbort();
#else
  const bool stop = this->GetAbortExecute() != 0;
#endif
  this->Aborted = this->Aborted || stop;
  return stop;
}

//----------------------------------------------------------------------------------------------------
void vtkImageToSimplexMeshFilter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "InputMode: " << this->GetInputModeAsString() << "\n";
  os << indent << "Isovalue: " << this->Isovalue << "\n";
  os << indent << "Inside: " << this->GetInsideAsString() << "\n";
  os << indent << "InsideLabel: " << this->InsideLabel << "\n";
  os << indent << "IsosurfaceSmoothingSigma: " << this->IsosurfaceSmoothingSigma << "\n";
  os << indent << "Delta: " << this->Delta << "\n";
  os << indent << "NumberOfElements: " << this->NumberOfElements << "\n";
  os << indent << "DeltaIsSuggestion: " << this->DeltaIsSuggestion << "\n";
  os << indent << "RadiusEdgeRatio: " << this->RadiusEdgeRatio << "\n";
  os << indent << "InterfaceRounds: " << this->InterfaceRounds << "\n";
  os << indent << "Manifold: " << this->Manifold << "\n";
  os << indent << "Optimise: " << this->Optimise << "\n";
  os << indent << "SmallestComponent: " << this->SmallestComponent << "\n";
  os << indent << "ExactComponents: " << this->ExactComponents << "\n";
  os << indent << "SmoothingSigma: " << this->SmoothingSigma << "\n";
  os << indent << "ElementSize: " << this->ElementSize << "\n";
  os << indent << "LabelSizes:";
  for (const auto& [label, size] : this->Private->LabelSizes)
  {
    os << " " << label << "=" << size;
  }
  os << (this->Private->LabelSizes.empty() ? " (none)\n" : "\n");
  os << indent << "Gradation: " << this->Gradation << "\n";
  os << indent << "Grading: " << this->GetGradingAsString() << "\n";
  os << indent << "FeatureRatio: " << this->FeatureRatio << "\n";
  os << indent << "LargestFeature: " << this->LargestFeature << "\n";
  os << indent << "InterfaceSizes:";
  for (const auto& [interface, size] : this->Private->InterfaceSizes)
  {
    os << " " << interface.first << "," << interface.second << "=" << size;
  }
  os << (this->Private->InterfaceSizes.empty() ? " (none)\n" : "\n");
  os << indent << "SelectedLabels:";
  for (const std::int64_t label : this->Private->Labels)
  {
    os << " " << label;
  }
  os << (this->Private->Labels.empty() ? " (all)\n" : "\n");
  os << indent << "ExcludedLabels:";
  for (const std::int64_t label : this->Private->ExcludedLabels)
  {
    os << " " << label;
  }
  os << (this->Private->ExcludedLabels.empty() ? " (none)\n" : "\n");
  os << indent << "DefaultDelta: " << this->DefaultDelta << "\n";
  os << indent << "SizeFunction: " << (this->Private->SizeFunction ? "set" : "(none)") << "\n";
  os << indent << "NumberOfThreads: " << this->NumberOfThreads << "\n";
  os << indent << "ContentionManager: " << this->GetContentionManagerAsString() << "\n";
  os << indent << "LoadBalancer: " << this->GetLoadBalancerAsString() << "\n";
  os << indent << "PinThreads: " << (this->PinThreads ? "On" : "Off") << "\n";
  os << indent << "Reproducible: " << (this->Reproducible ? "On" : "Off") << "\n";
  os << indent << "Force: " << (this->Force ? "On" : "Off") << "\n";
  os << indent << "MemoryLimit: " << this->MemoryLimit << "\n";
  os << indent << "ComputeQuality: " << (this->ComputeQuality ? "On" : "Off") << "\n";
  os << indent << "ErrorMessage: " << (this->ErrorMessage.empty() ? "(none)" : this->ErrorMessage)
     << "\n";
  os << indent << "Aborted: " << (this->Aborted ? "Yes" : "No") << "\n";
  os << indent << "Statistics:\n";
  this->Private->Statistics->PrintSelf(os, indent.GetNextIndent());
}
