// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkImageToSimplexMeshFilter.h"

#include "ImageVoxels.h"
#include "LabelTable.h"
#include "MeshingParameters.h"
#include "Private/Execution.h"
#include "Private/Lists.h"
#include "Private/MeshingMessages.h"
#include "Private/SimplexMeshRun.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkDataSet.h"
#include "vtkDataSetAttributes.h"
#include "vtkExecutive.h"
#include "vtkFieldData.h"
#include "vtkInformation.h"
#include "vtkPointData.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <limits>
#include <set>

namespace
{

using voxplex::Clear;
using voxplex::InputError;
using voxplex::ItemAt;
using voxplex::ModifyIf;
using voxplex::PrintList;
using voxplex::PrintText;

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
static_assert(
  Filter::VOCABULARY_COMMAND_LINE == static_cast<int>(voxplex::UserInterface::CommandLine) &&
  Filter::VOCABULARY_SLICER == static_cast<int>(voxplex::UserInterface::Slicer) &&
  Filter::VOCABULARY_PYTHON == static_cast<int>(voxplex::UserInterface::Python) &&
  Filter::VOCABULARY_PARAVIEW == static_cast<int>(voxplex::UserInterface::ParaView));

/** A size that was given as a number. */
void CheckSize(double size, const std::string& what)
{
  using Limits = std::numeric_limits<double>;
  voxplex::CheckRange(
    size, Limits::denorm_min(), Limits::max(), what.c_str(), "positive and finite");
}

/** Leaves out the names of labels that a mesh has not. @param labels of its cells */
voxplex::LabelTable NamesOf(voxplex::LabelTable table, vtkDataArray* labels)
{
  std::set<std::int64_t> present;
  for (vtkIdType cell = 0; !table.Entries.empty() && cell < labels->GetNumberOfTuples(); ++cell)
  {
    present.insert(static_cast<std::int64_t>(labels->GetComponent(cell, 0)));
  }
  std::erase_if(
    table.Entries, [&present](const auto& entry) { return !present.contains(entry.first); });
  return table;
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
    voxplex::SetArray(this, port, port);
  }
}

vtkImageToSimplexMeshFilter::~vtkImageToSimplexMeshFilter() = default;

//----------------------------------------------------------------------------------------------------
VOXPLEX_SIZES_OF_LABELS(vtkImageToSimplexMeshFilter, LabelSize, LabelSizes, SizedLabel, LabelSizes)

//----------------------------------------------------------------------------------------------------
void vtkImageToSimplexMeshFilter::SetInterfaceSize(
  vtkTypeInt64 label, vtkTypeInt64 other, double size)
{
  voxplex::SetSize(this, this->Private->InterfaceSizes, InterfaceOf(label, other), size);
}

double vtkImageToSimplexMeshFilter::GetInterfaceSize(vtkTypeInt64 label, vtkTypeInt64 other) const
{
  return voxplex::SizeOf(this->Private->InterfaceSizes, InterfaceOf(label, other));
}

void vtkImageToSimplexMeshFilter::RemoveInterfaceSize(vtkTypeInt64 label, vtkTypeInt64 other)
{
  ModifyIf(this, this->Private->InterfaceSizes.erase(InterfaceOf(label, other)) > 0);
}

void vtkImageToSimplexMeshFilter::ClearInterfaceSizes()
{
  Clear(this, this->Private->InterfaceSizes);
}

int vtkImageToSimplexMeshFilter::GetNumberOfInterfaceSizes() const
{
  return static_cast<int>(this->Private->InterfaceSizes.size());
}

void vtkImageToSimplexMeshFilter::GetSizedInterface(int index, vtkTypeInt64 labels[2]) const
{
  const auto interface =
    ItemAt(this->Private->InterfaceSizes, index, { { ANY_LABEL, ANY_LABEL }, 0.0 }).first;
  labels[0] = interface.first;
  labels[1] = interface.second;
}

//----------------------------------------------------------------------------------------------------
VOXPLEX_SET_OF_LABELS(vtkImageToSimplexMeshFilter, AddLabel, RemoveLabel, RemoveAllLabels,
  SelectedLabel, SelectedLabels, Labels)
VOXPLEX_SET_OF_LABELS(vtkImageToSimplexMeshFilter, ExcludeLabel, RemoveExcludedLabel,
  RemoveAllExcludedLabels, ExcludedLabel, ExcludedLabels, ExcludedLabels)

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
std::map<vtkTypeInt64, vtkTypeInt64> vtkImageToSimplexMeshFilter::CountLabels(
  vtkImageData* image, int association, const std::string& name, std::string& message)
{
  vtkAbstractArray* array = name.empty()
    ? image->GetPointData()->GetScalars()
    : image->GetAttributes(association)->GetAbstractArray(name.c_str());
  if (name.empty())
  {
    association =
      array ? vtkDataObject::FIELD_ASSOCIATION_POINTS : vtkDataObject::FIELD_ASSOCIATION_CELLS;
    array = array ? array : image->GetCellData()->GetScalars();
  }
  std::map<vtkTypeInt64, vtkTypeInt64> counts;
  message = voxplex::CatchFailure(
    [&]
    {
      voxplex::ChosenArray chosen =
        voxplex::Choose(image, array, association, voxplex::ImageContent::Labels, "input image");
      chosen.Array = voxplex::Contiguous(chosen.Array);
      // Components lie side by side: they make rows longer.
      const vtkSmartPointer<vtkDataArray> all = chosen.Array;
      chosen.Array.TakeReference(all->NewInstance());
      chosen.Array->SetVoidArray(all->GetVoidPointer(0), all->GetNumberOfValues(), 1);
      chosen.Frame.Grid.Dimensions[0] *= all->GetNumberOfComponents();
      const auto labels = voxplex::ReadLabels(chosen, {}, voxplex::ThreadsFor(0));
      for (int id = 1; id <= labels.NumberOfLabels(); ++id)
      {
        counts[labels.Values()[static_cast<std::size_t>(id)]] =
          labels.Counts()[static_cast<std::size_t>(id)];
      }
    },
    "There is not enough memory to count the voxels of labels.", "Counting voxels failed: ");
  return counts;
}

void vtkImageToSimplexMeshFilter::SetInputArrayToProcess(
  int index, int port, int connection, int association, const char* name)
{
  voxplex::SetArray(this, index, port, connection, association, name);
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

int vtkImageToSimplexMeshFilter::GetNumberOfWarnings() const
{
  return static_cast<int>(this->Private->Warnings.size());
}

const std::string& vtkImageToSimplexMeshFilter::GetWarning(int i) const
{
  return voxplex::TextAt(this->Private->Warnings, i);
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

vtkTypeBool vtkImageToSimplexMeshFilter::ProcessRequest(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  VOXPLEX_FORGET_ABORT(request);
  return this->Superclass::ProcessRequest(request, inputVector, outputVector);
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
  voxplex::RequestWholeInputs(inputVector, this->GetNumberOfInputPorts());
  return 1;
}

//----------------------------------------------------------------------------------------------------
int vtkImageToSimplexMeshFilter::RequestData(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  this->ErrorMessage.clear();
  this->Aborted = false;
  this->Private->Warnings.clear();
  this->Private->Statistics->Initialize();
  voxplex::EmptyOutputs(outputVector);
  // The executive takes all outputs for the piece that the asking port wants.
  const int asking = std::max(0, request->Get(vtkExecutive::FROM_OUTPUT_PORT()));
  if (IsEmptyPiece(outputVector->GetInformationObject(asking)))
  {
    return 1;
  }

  bool isGathered = true;
  this->ErrorMessage = voxplex::CatchFailure(
    [&]
    {
      this->CheckParameters();
      isGathered = this->Gather(request, inputVector);
      if (isGathered && !this->Aborted)
      {
        this->Mesh(inputVector, outputVector);
      }
    },
    voxplex::NoMemoryForMesh, voxplex::MeshingFailed);
  if (!isGathered)
  {
    this->ErrorMessage = "The input failed before it had delivered all time steps."; // if it does
    request->Set(Pipeline::CONTINUE_EXECUTING(), 1);
    return 1;
  }
  this->ErrorMessage = InTermsOf(this->Vocabulary, this->ErrorMessage);
  request->Remove(Pipeline::CONTINUE_EXECUTING());
  this->Aborted = this->Aborted && this->ErrorMessage.empty();
  if (this->ErrorMessage.empty() && !this->Aborted)
  {
    vtkFieldData* const fields = vtkDataObject::GetData(inputVector[0])->GetFieldData();
    const voxplex::LabelTable names = voxplex::GetLabelTable(fields);
    const voxplex::LabelTable namesOfMesh =
      NamesOf(names, vtkDataSet::GetData(outputVector)->GetCellData()->GetArray("Label"));
    for (int port = 0; port < this->GetNumberOfOutputPorts(); ++port)
    {
      vtkFieldData* const passed = vtkDataObject::GetData(outputVector, port)->GetFieldData();
      passed->PassData(fields);
      if (!names.Entries.empty()) // there may be colours alone
      {
        voxplex::SetLabelTable(passed, namesOfMesh);
      }
    }
    for (const std::string& warning : voxplex::WarningsOf(this->Private->Statistics->Edit(),
           names.Names(), this->GetContentionManagerAsString(), this->ExactComponents))
    {
      this->Warn(warning);
    }
    return 1;
  }
  voxplex::EmptyOutputs(outputVector);
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
  using voxplex::CheckValue;
  CheckValue("delta", this->Delta);
  CheckValue("smoothing", this->SmoothingSigma);
  CheckValue("size", this->ElementSize);
  CheckValue("radius-edge", this->RadiusEdgeRatio, this->Force);
  CheckValue("gradation", this->Gradation);
  CheckValue("feature-ratio", this->FeatureRatio);
  CheckValue("largest-feature", this->LargestFeature);
  for (const auto& [label, size] : this->Private->LabelSizes)
  {
    CheckSize(size, "The size of label " + std::to_string(label));
  }
  for (const auto& [interface, size] : this->Private->InterfaceSizes)
  {
    if (interface.second < ANY_LABEL || interface.first < 0 || interface.first == interface.second)
    {
      throw InputError("{interface-size} takes two different labels, or a label and ANY_LABEL "
                       "(-1); these are " +
        std::to_string(interface.first) + " and " + std::to_string(interface.second) + ".");
    }
    CheckSize(size, "The size of " + NameOf(interface));
  }
  if (this->NumberOfElements > 0 && this->Delta > 0.0 && !this->DeltaIsSuggestion)
  {
    throw InputError("{delta}" + voxplex::FindParameter("delta").Excludes.Text + ".");
  }
}

void vtkImageToSimplexMeshFilter::Warn(const std::string& warning)
{
  this->Private->Warnings.push_back(InTermsOf(this->Vocabulary, warning));
  vtkWarningMacro(<< this->Private->Warnings.back());
}

std::string vtkImageToSimplexMeshFilter::InTermsOf(int vocabulary, const std::string& message)
{
  return voxplex::InTermsOf(static_cast<voxplex::UserInterface>(vocabulary), message);
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
  return voxplex::ThreadsFor(this->NumberOfThreads);
}

bool vtkImageToSimplexMeshFilter::StopRequested()
{
  const bool stop = voxplex::IsStopRequested(this);
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
  os << indent << "FitInterfaces: " << this->FitInterfaces << "\n";
  os << indent << "Optimise: " << this->Optimise << "\n";
  os << indent << "SmallestComponent: " << this->SmallestComponent << "\n";
  os << indent << "ExactComponents: " << this->ExactComponents << "\n";
  os << indent << "SmoothingSigma: " << this->SmoothingSigma << "\n";
  os << indent << "ElementSize: " << this->ElementSize << "\n";
  PrintList(os, indent, "LabelSizes", this->Private->LabelSizes, " (none)",
    [](ostream& to, const auto& size) { to << size.first << '=' << size.second; });
  os << indent << "Gradation: " << this->Gradation << "\n";
  os << indent << "Grading: " << this->GetGradingAsString() << "\n";
  os << indent << "FeatureRatio: " << this->FeatureRatio << "\n";
  os << indent << "LargestFeature: " << this->LargestFeature << "\n";
  PrintList(os, indent, "InterfaceSizes", this->Private->InterfaceSizes, " (none)",
    [](ostream& to, const auto& size)
    { to << size.first.first << ',' << size.first.second << '=' << size.second; });
  PrintList(os, indent, "SelectedLabels", this->Private->Labels, " (all)");
  PrintList(os, indent, "ExcludedLabels", this->Private->ExcludedLabels, " (none)");
  os << indent << "DefaultDelta: " << this->DefaultDelta << "\n";
  os << indent << "SizeFunction: " << (this->Private->SizeFunction ? "set" : "(none)") << "\n";
  os << indent << "NumberOfThreads: " << this->NumberOfThreads << "\n";
  os << indent << "ContentionManager: " << this->GetContentionManagerAsString() << "\n";
  os << indent << "LoadBalancer: " << this->GetLoadBalancerAsString() << "\n";
  os << indent << "PinThreads: " << (this->PinThreads ? "On" : "Off") << "\n";
  os << indent << "Reproducible: " << (this->Reproducible ? "On" : "Off") << "\n";
  os << indent << "Force: " << (this->Force ? "On" : "Off") << "\n";
  os << indent << "MemoryLimit: " << this->MemoryLimit << "\n";
  os << indent << "Vocabulary: " << this->Vocabulary << "\n";
  os << indent << "ComputeQuality: " << (this->ComputeQuality ? "On" : "Off") << "\n";
  PrintText(os, indent, "ErrorMessage", this->ErrorMessage);
  os << indent << "Aborted: " << (this->Aborted ? "Yes" : "No") << "\n";
  os << indent << "Statistics:\n";
  this->Private->Statistics->PrintSelf(os, indent.GetNextIndent());
}
