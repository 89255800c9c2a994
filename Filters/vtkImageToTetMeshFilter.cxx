// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkImageToTetMeshFilter.h"

#include "Error.h"
#include "ImageMesher.h"
#include "Mesh/MeshQuality.h"
#include "Private/ElementSizes.h"
#include "Private/ImageFrame.h"
#include "Private/MeshOutput.h"
#include "Private/MeshingFigures.h"
#include "Private/SmpThreads.h"

#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"
#include "vtkExecutive.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkImplicitFunction.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMeshingStatistics.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkUnstructuredGrid.h"
#include "vtkVersion.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <iterator>
#include <map>
#include <new>
#include <set>
#include <span>
#include <sstream>
#include <vector>

vtkStandardNewMacro(vtkImageToTetMeshFilter);

struct vtkImageToTetMeshFilter::Internals
{
  std::map<std::int64_t, double> LabelSizes;
  std::set<std::int64_t> Labels;
  vtkSmartPointer<vtkImplicitFunction> SizeImplicitFunction;
  SizeFunctionType SizeFunction;
  vtkNew<vtkMeshingStatistics> Statistics;
};

namespace
{

using voxplex::ImageFrame;
using voxplex::InputError;

/** The fraction of the progress that belongs to the kernel; the rest is the copy into VTK data. */
constexpr double KernelProgress = 0.97;

/** voxplex::ProvedRadiusEdgeRatio, rounded down to what one types. */
constexpr double ProvedRadiusEdgeRatio = 1.93;

// The class's constants are the kernel's: casts lead from one to the other.
using Filter = vtkImageToTetMeshFilter;
static_assert(Filter::CONTENTION_RANDOM == static_cast<int>(voxplex::ContentionPolicy::Random) &&
  Filter::CONTENTION_GLOBAL == static_cast<int>(voxplex::ContentionPolicy::Global) &&
  Filter::CONTENTION_LOCAL == static_cast<int>(voxplex::ContentionPolicy::Local));
static_assert(
  Filter::HIERARCHICAL_WORK_STEALING == static_cast<int>(voxplex::BalancePolicy::Hierarchical));

class StopWatch
{
public:
  double Seconds() const
  {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - this->Start).count();
  }

private:
  std::chrono::steady_clock::time_point Start = std::chrono::steady_clock::now();
};

/** An image with the array that was chosen on it. */
struct ChosenArray
{
  vtkImageData* Image = nullptr;
  vtkSmartPointer<vtkDataArray> Array;
  ImageFrame Frame;
};

/**
 * Checks that the array has one number for each voxel; `advice` ends the message for several
 * components.
 */
ChosenArray Choose(vtkImageData* image, vtkAbstractArray* chosen, int association,
  const std::string& what, const std::string& advice)
{
  if (chosen == nullptr)
  {
    throw InputError("The " + what +
      " has no such array: neither active point nor cell scalars, or not the array named in "
      "SetInputArrayToProcess().");
  }
  const std::string name = chosen->GetName() ? chosen->GetName() : "";
  vtkDataArray* array = vtkDataArray::SafeDownCast(chosen);
  if (array == nullptr)
  {
    throw InputError("The array '" + name + "' of the " + what + " does not hold numbers.");
  }
  if (array->GetNumberOfComponents() != 1)
  {
    throw InputError("The array '" + name + "' of the " + what + " has " +
      std::to_string(array->GetNumberOfComponents()) + " components; one is needed." + advice);
  }
  ChosenArray result;
  result.Image = image;
  result.Array = array;
  result.Frame =
    voxplex::MakeImageFrame(image, association == vtkDataObject::FIELD_ASSOCIATION_CELLS, what);
  const auto& n = result.Frame.Grid.Dimensions;
  if (array->GetNumberOfTuples() != n[0] * n[1] * n[2])
  {
    throw InputError("The array '" + name + "' of the " + what + " has " +
      std::to_string(array->GetNumberOfTuples()) + " values; the dimensions ask for " +
      std::to_string(n[0] * n[1] * n[2]) + ".");
  }
  return result;
}

/** The array itself if its values lie contiguously in memory in a type with a name, else a copy. */
vtkSmartPointer<vtkDataArray> Contiguous(vtkDataArray* array)
{
  if (array->HasStandardMemoryLayout() && array->GetDataType() != VTK_BIT)
  {
    return array;
  }
  const int type = array->GetDataType() == VTK_BIT ? VTK_UNSIGNED_CHAR : array->GetDataType();
  auto copy = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(type));
  copy->DeepCopy(array);
  return copy;
}

voxplex::LabelImage<3> ReadLabels(
  const ChosenArray& input, const std::set<std::int64_t>& labels, unsigned threads)
{
  const vtkSmartPointer<vtkDataArray> array = Contiguous(input.Array);
  const std::vector<std::int64_t> keep(labels.begin(), labels.end());
  const auto count = static_cast<std::size_t>(array->GetNumberOfTuples());
  switch (array->GetDataType())
  {
    vtkTemplateMacro(return voxplex::LabelImage<3>::FromScalars<VTK_TT>(
      std::span<const VTK_TT>(static_cast<const VTK_TT*>(array->GetVoidPointer(0)), count),
      input.Frame.Grid, keep, threads));
  }
  throw InputError(
    "Scalars of type " + std::string(array->GetDataTypeAsString()) + " cannot be read as labels.");
}

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

void CheckRange(double value, double low, double high, const char* what, const char* must)
{
  if (!(value >= low && value <= high))
  {
    std::ostringstream text;
    text << what << " is " << value << "; it must be " << must << ".";
    throw InputError(text.str());
  }
}

/** At most 20 labels, separated by commas. */
std::string ListLabels(std::span<const std::int64_t> labels)
{
  constexpr std::size_t shown = 20;
  std::string text;
  for (std::size_t i = 0; i < std::min(shown, labels.size()); ++i)
  {
    text.append(i ? ", " : "").append(std::to_string(labels[i]));
  }
  if (labels.size() > shown)
  {
    text.append(", ... (").append(std::to_string(labels.size())).append(" in all)");
  }
  return text;
}

/** The labels of the image that no element has. */
std::vector<std::int64_t> FindLostLabels(
  const voxplex::LabelImage<3>& image, std::span<const std::int64_t> elements)
{
  const auto values = image.Values().subspan(1); // without background
  std::vector<char> found(values.size(), 0);
  std::int64_t last = 0;
  for (const std::int64_t label : elements)
  {
    if (label != last) // neighbours in the list mostly have the same label
    {
      last = label;
      found[static_cast<std::size_t>(
        std::lower_bound(values.begin(), values.end(), label) - values.begin())] = 1;
    }
  }
  std::vector<std::int64_t> lost;
  for (std::size_t i = 0; i < found.size(); ++i)
  {
    if (!found[i])
    {
      lost.push_back(values[i]);
    }
  }
  return lost;
}

/** Labels that have a size but nothing to apply it to. */
void CheckSizedLabels(const std::map<std::int64_t, double>& sizes,
  const std::set<std::int64_t>& selected, const voxplex::LabelImage<3>& image)
{
  const auto values = image.Values().subspan(1); // without background
  for (const auto& [label, size] : sizes)
  {
    if (std::binary_search(values.begin(), values.end(), label))
    {
      continue;
    }
    const std::string where = selected.empty() ? "does not occur in the image; its labels are "
                                               : "is not among the labels to mesh; these are ";
    throw InputError("SetLabelSize() gives a size to label " + std::to_string(label) + ", which " +
      where + ListLabels(values) + ".");
  }
}

/** Whether the piece that is asked for is one that stays empty. */
bool IsEmptyPiece(vtkInformation* output)
{
  return output->Has(vtkStreamingDemandDrivenPipeline::UPDATE_PIECE_NUMBER()) &&
    output->Get(vtkStreamingDemandDrivenPipeline::UPDATE_PIECE_NUMBER()) > 0;
}

} // namespace

//----------------------------------------------------------------------------------------------------
vtkImageToTetMeshFilter::vtkImageToTetMeshFilter()
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

vtkImageToTetMeshFilter::~vtkImageToTetMeshFilter() = default;

//----------------------------------------------------------------------------------------------------
void vtkImageToTetMeshFilter::SetLabelSize(vtkTypeInt64 label, double size)
{
  const auto found = this->Private->LabelSizes.find(label);
  if (found == this->Private->LabelSizes.end() || found->second != size)
  {
    this->Private->LabelSizes[label] = size;
    this->Modified();
  }
}

double vtkImageToTetMeshFilter::GetLabelSize(vtkTypeInt64 label) const
{
  const auto found = this->Private->LabelSizes.find(label);
  return found == this->Private->LabelSizes.end() ? 0.0 : found->second;
}

void vtkImageToTetMeshFilter::RemoveLabelSize(vtkTypeInt64 label)
{
  if (this->Private->LabelSizes.erase(label) > 0)
  {
    this->Modified();
  }
}

void vtkImageToTetMeshFilter::ClearLabelSizes()
{
  if (!this->Private->LabelSizes.empty())
  {
    this->Private->LabelSizes.clear();
    this->Modified();
  }
}

int vtkImageToTetMeshFilter::GetNumberOfLabelSizes() const
{
  return static_cast<int>(this->Private->LabelSizes.size());
}

vtkTypeInt64 vtkImageToTetMeshFilter::GetSizedLabel(int index) const
{
  return index >= 0 && index < this->GetNumberOfLabelSizes()
    ? std::next(this->Private->LabelSizes.begin(), index)->first
    : 0;
}

//----------------------------------------------------------------------------------------------------
void vtkImageToTetMeshFilter::AddLabel(vtkTypeInt64 label)
{
  if (this->Private->Labels.insert(label).second)
  {
    this->Modified();
  }
}

void vtkImageToTetMeshFilter::RemoveLabel(vtkTypeInt64 label)
{
  if (this->Private->Labels.erase(label) > 0)
  {
    this->Modified();
  }
}

void vtkImageToTetMeshFilter::RemoveAllLabels()
{
  if (!this->Private->Labels.empty())
  {
    this->Private->Labels.clear();
    this->Modified();
  }
}

int vtkImageToTetMeshFilter::GetNumberOfSelectedLabels() const
{
  return static_cast<int>(this->Private->Labels.size());
}

vtkTypeInt64 vtkImageToTetMeshFilter::GetSelectedLabel(int index) const
{
  return index >= 0 && index < this->GetNumberOfSelectedLabels()
    ? *std::next(this->Private->Labels.begin(), index)
    : 0;
}

//----------------------------------------------------------------------------------------------------
void vtkImageToTetMeshFilter::SetSizeImplicitFunction(vtkImplicitFunction* function)
{
  if (this->Private->SizeImplicitFunction != function)
  {
    this->Private->SizeImplicitFunction = function;
    this->Modified();
  }
}

vtkImplicitFunction* vtkImageToTetMeshFilter::GetSizeImplicitFunction() const
{
  return this->Private->SizeImplicitFunction;
}

void vtkImageToTetMeshFilter::SetElementSizeData(vtkImageData* image)
{
  this->SetInputData(1, image);
}

void vtkImageToTetMeshFilter::SetSizeFunction(SizeFunctionType function)
{
  this->Private->SizeFunction = std::move(function);
  this->Modified();
}

const char* vtkImageToTetMeshFilter::GetContentionManagerAsString() const
{
  return voxplex::ContentionPolicyNames[static_cast<std::size_t>(this->ContentionManager)].data();
}

const char* vtkImageToTetMeshFilter::GetLoadBalancerAsString() const
{
  return voxplex::BalancePolicyNames[static_cast<std::size_t>(this->LoadBalancer)].data();
}

vtkMeshingStatistics* vtkImageToTetMeshFilter::GetStatistics() const
{
  return this->Private->Statistics;
}

vtkPolyData* vtkImageToTetMeshFilter::GetInterfaces()
{
  return vtkPolyData::SafeDownCast(this->GetOutputDataObject(1));
}

vtkMTimeType vtkImageToTetMeshFilter::GetMTime()
{
  const vtkMTimeType own = this->Superclass::GetMTime();
  vtkImplicitFunction* function = this->Private->SizeImplicitFunction;
  return function ? std::max(own, function->GetMTime()) : own;
}

//----------------------------------------------------------------------------------------------------
int vtkImageToTetMeshFilter::FillInputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  if (port == 1)
  {
    info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  }
  return 1;
}

int vtkImageToTetMeshFilter::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 0 ? "vtkUnstructuredGrid" : "vtkPolyData");
  return 1;
}

int vtkImageToTetMeshFilter::RequestInformation(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector)
{
  for (int port = 0; port < this->GetNumberOfOutputPorts(); ++port)
  {
    outputVector->GetInformationObject(port)->Set(vtkAlgorithm::CAN_HANDLE_PIECE_REQUEST(), 1);
  }
  return 1;
}

int vtkImageToTetMeshFilter::RequestUpdateExtent(
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
int vtkImageToTetMeshFilter::RequestData(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  this->ErrorMessage.clear();
  this->Aborted = false;
  this->Private->Statistics->Initialize();
  vtkUnstructuredGrid* tetrahedra = vtkUnstructuredGrid::GetData(outputVector, 0);
  vtkPolyData* interfaces = vtkPolyData::GetData(outputVector, 1);
  tetrahedra->Initialize();
  interfaces->Initialize();
  // The executive takes all outputs for the piece that the asking port wants.
  const int asking = std::max(0, request->Get(vtkExecutive::FROM_OUTPUT_PORT()));
  if (IsEmptyPiece(outputVector->GetInformationObject(asking)))
  {
    return 1;
  }

  try
  {
    this->Mesh(inputVector, tetrahedra, interfaces);
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
  if (this->ErrorMessage.empty() && !this->Aborted)
  {
    vtkFieldData* fields = vtkDataObject::GetData(inputVector[0])->GetFieldData();
    tetrahedra->GetFieldData()->PassData(fields);
    interfaces->GetFieldData()->PassData(fields);
    this->WarnOfDeviations();
    return 1;
  }
  tetrahedra->Initialize();
  interfaces->Initialize();
  this->Private->Statistics->Initialize();
  if (this->Aborted)
  {
    return 1;
  }
  vtkErrorMacro(<< this->ErrorMessage);
  return 0;
}

//----------------------------------------------------------------------------------------------------
void vtkImageToTetMeshFilter::Mesh(
  vtkInformationVector** inputVector, vtkUnstructuredGrid* tetrahedra, vtkPolyData* interfaces)
{
  StopWatch reading;
  this->CheckParameters();
  int association = 0;
  vtkAbstractArray* scalars = this->GetInputAbstractArrayToProcess(0, inputVector, association);
  const ChosenArray input = Choose(vtkImageData::GetData(inputVector[0]), scalars, association,
    "image", " For time series, use vtkImageToPentatopeMeshFilter.");

  const auto sizes = std::make_shared<voxplex::ElementSizes>();
  sizes->Frame = input.Frame;
  sizes->Uniform = this->ElementSize;
  sizes->PerLabel = this->Private->LabelSizes;
  sizes->Implicit = this->Private->SizeImplicitFunction;
  sizes->Function = this->Private->SizeFunction;
  if (vtkImageData* image = vtkImageData::GetData(inputVector[1]))
  {
    vtkAbstractArray* values = this->GetInputAbstractArrayToProcess(1, inputVector, association);
    const ChosenArray chosen = Choose(image, values, association, "image of element sizes", "");
    sizes->Image.emplace(chosen.Frame, chosen.Array);
  }

  voxplex::MeshingOptions<3> options;
  options.Delta = this->Delta;
  options.RadiusEdgeRatio = this->RadiusEdgeRatio;
  options.FacetAngle = this->FacetAngle;
  options.SmoothingSigma = this->SmoothingSigma;
  options.Threads = static_cast<unsigned>(
    this->NumberOfThreads > 0 ? this->NumberOfThreads : voxplex::SmpThreads());
  options.Contention = static_cast<voxplex::ContentionPolicy>(this->ContentionManager);
  options.Balance = static_cast<voxplex::BalancePolicy>(this->LoadBalancer);
  options.PinThreads = this->PinThreads;
  options.Force = this->Force;
  options.MemoryLimit = this->MemoryLimit;
  if (sizes->Any())
  {
    options.Size = sizes;
  }

  const voxplex::LabelImage<3> labels = ReadLabels(input, this->Private->Labels, options.Threads);
  CheckSizedLabels(this->Private->LabelSizes, this->Private->Labels, labels);
  const double readingTime = reading.Seconds();

  voxplex::ImageMesher<3> mesher(options);
  mesher.Progress = [this, &sizes](double fraction)
  {
    this->UpdateProgress(KernelProgress * fraction);
    return !sizes->Failed() && !this->AbortRequested();
  };
  voxplex::SimplexMesh<3> mesh;
  const voxplex::MeshingOutcome outcome = mesher.Run(labels, mesh);
  sizes->Rethrow();
  if (outcome == voxplex::MeshingOutcome::Cancelled || this->AbortRequested())
  {
    this->Aborted = true;
    return;
  }

  vtkMeshingStatistics::Figures& figures = this->Private->Statistics->Edit();
  figures.Run = mesher.Statistics();
  figures.Threads = static_cast<int>(options.Threads);
  figures.Elements = std::ssize(mesh.Simplices);
  figures.Vertices = std::ssize(mesh.Points);
  figures.InterfaceFacets = std::ssize(mesh.Facets);
  figures.LostLabels = FindLostLabels(labels, mesh.Labels);
  if (mesh.Simplices.empty())
  {
    throw InputError("The mesh is empty, because every label is too small for a Delta of " +
      std::to_string(figures.Run.Delta) + "; use a smaller one.");
  }
  if (this->ComputeQuality)
  {
    figures.Quality =
      voxplex::MeasureQuality(mesh, options.RadiusEdgeRatio, options.FacetAngle, options.Threads);
    figures.HasQuality = true;
  }
  StopWatch writing;
  voxplex::MoveToOutput(std::move(mesh), input.Frame, tetrahedra, interfaces, options.Threads);
  figures.Run.Times.LabelField += readingTime;
  figures.Run.Times.Extraction += writing.Seconds();
}

//----------------------------------------------------------------------------------------------------
void vtkImageToTetMeshFilter::WarnOfDeviations()
{
  const vtkMeshingStatistics::Figures& figures = this->Private->Statistics->Edit();
  if (figures.Run.SizesRaisedTo > 0.0)
  {
    vtkWarningMacro(<< "Some element sizes are below a tenth of Delta and were raised to "
                    << figures.Run.SizesRaisedTo << "; use a smaller Delta for smaller elements.");
  }
  if (!figures.LostLabels.empty())
  {
    vtkWarningMacro(
      << "The mesh lacks these labels of the image, which are too small for a Delta of "
      << figures.Run.Delta << ": " << ListLabels(figures.LostLabels) << ".");
  }
  if (figures.Run.SwitchedToLocal)
  {
    vtkWarningMacro(<< "The threads made no progress with the contention manager '"
                    << this->GetContentionManagerAsString()
                    << "', which cannot exclude a livelock, and the local one took over; use "
                       "SetContentionManagerToLocal().");
  }
}

//----------------------------------------------------------------------------------------------------
void vtkImageToTetMeshFilter::CheckParameters() const
{
  constexpr double largest = std::numeric_limits<double>::max();
  CheckRange(
    this->Delta, 0.0, largest, "Delta", "positive and finite, or 0 to derive it from the spacing");
  CheckRange(
    this->SmoothingSigma, 0.0, largest, "SmoothingSigma", "positive and finite, or 0 for none");
  CheckRange(this->FacetAngle, 0.0, 30.0, "FacetAngle", "between 0 and 30 degrees");
  CheckRange(this->ElementSize, 0.0, largest, "ElementSize", "positive and finite, or 0 for none");
  CheckRange(this->RadiusEdgeRatio, this->Force ? 1.0 : ProvedRadiusEdgeRatio, largest,
    "RadiusEdgeRatio",
    this->Force ? "at least 1"
                : "at least 1.93, because below it is not proved that refinement ends; Force goes "
                  "down to 1");
  for (const auto& [label, size] : this->Private->LabelSizes)
  {
    CheckSize(size, "The size of label " + std::to_string(label));
  }
}

bool vtkImageToTetMeshFilter::AbortRequested()
{
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 3, 0)
  return this->CheckAbort();
#else
  return this->GetAbortExecute() != 0;
#endif
}

//----------------------------------------------------------------------------------------------------
void vtkImageToTetMeshFilter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Delta: " << this->Delta << "\n";
  os << indent << "RadiusEdgeRatio: " << this->RadiusEdgeRatio << "\n";
  os << indent << "FacetAngle: " << this->FacetAngle << "\n";
  os << indent << "SmoothingSigma: " << this->SmoothingSigma << "\n";
  os << indent << "ElementSize: " << this->ElementSize << "\n";
  os << indent << "LabelSizes:";
  for (const auto& [label, size] : this->Private->LabelSizes)
  {
    os << " " << label << "=" << size;
  }
  os << (this->Private->LabelSizes.empty() ? " (none)\n" : "\n");
  os << indent << "SelectedLabels:";
  for (const std::int64_t label : this->Private->Labels)
  {
    os << " " << label;
  }
  os << (this->Private->Labels.empty() ? " (all)\n" : "\n");
  os << indent << "SizeImplicitFunction: ";
  if (this->Private->SizeImplicitFunction)
  {
    os << "\n";
    this->Private->SizeImplicitFunction->PrintSelf(os, indent.GetNextIndent());
  }
  else
  {
    os << "(none)\n";
  }
  os << indent << "SizeFunction: " << (this->Private->SizeFunction ? "set" : "(none)") << "\n";
  os << indent << "NumberOfThreads: " << this->NumberOfThreads << "\n";
  os << indent << "ContentionManager: " << this->GetContentionManagerAsString() << "\n";
  os << indent << "LoadBalancer: " << this->GetLoadBalancerAsString() << "\n";
  os << indent << "PinThreads: " << (this->PinThreads ? "On" : "Off") << "\n";
  os << indent << "Force: " << (this->Force ? "On" : "Off") << "\n";
  os << indent << "MemoryLimit: " << this->MemoryLimit << "\n";
  os << indent << "ComputeQuality: " << (this->ComputeQuality ? "On" : "Off") << "\n";
  os << indent << "ErrorMessage: " << (this->ErrorMessage.empty() ? "(none)" : this->ErrorMessage)
     << "\n";
  os << indent << "Aborted: " << (this->Aborted ? "Yes" : "No") << "\n";
  os << indent << "Statistics:\n";
  this->Private->Statistics->PrintSelf(os, indent.GetNextIndent());
}
