// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSimplexMeshQuality.h"

#include "Base/Error.h"
#include "MeshingParameters.h"
#include "Private/Execution.h"
#include "Private/Lists.h"
#include "Private/MeshingMessages.h"
#include "Private/QualityRun.h"
#include "Private/QualityTables.h"

#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPentatopeMeshTimeSlice.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkTable.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <cmath>
#include <iterator>

vtkStandardNewMacro(vtkSimplexMeshQuality);

using voxplex::InputError;

namespace
{

using Pipeline = vtkStreamingDemandDrivenPipeline;

} // namespace

//----------------------------------------------------------------------------------------------------
vtkSimplexMeshQuality::vtkSimplexMeshQuality()
  : Private(std::make_unique<Internals>())
{
  this->SetNumberOfInputPorts(2);
  this->SetNumberOfOutputPorts(4);
  this->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "Label");
  voxplex::SetArray(this, 1, 1);
}

vtkSimplexMeshQuality::~vtkSimplexMeshQuality() = default;

void vtkSimplexMeshQuality::SetImageData(vtkImageData* image)
{
  this->SetInputData(1, image);
}

void vtkSimplexMeshQuality::SetImageConnection(vtkAlgorithmOutput* output)
{
  this->SetInputConnection(1, output);
}

vtkTable* vtkSimplexMeshQuality::GetLabelTable()
{
  return vtkTable::SafeDownCast(this->GetOutputDataObject(1));
}

vtkTable* vtkSimplexMeshQuality::GetHistograms()
{
  return vtkTable::SafeDownCast(this->GetOutputDataObject(2));
}

void vtkSimplexMeshQuality::AddLabel(vtkTypeInt64 label)
{
  voxplex::ModifyIf(this, this->Private->Labels.insert(label).second);
}

void vtkSimplexMeshQuality::RemoveAllLabels()
{
  voxplex::Clear(this, this->Private->Labels);
}

void vtkSimplexMeshQuality::AddFrameTime(double time)
{
  this->Private->FrameTimes.push_back(time);
  this->Modified();
}

void vtkSimplexMeshQuality::ClearFrameTimes()
{
  voxplex::Clear(this, this->Private->FrameTimes);
}

vtkTable* vtkSimplexMeshQuality::GetFrameTable()
{
  return vtkTable::SafeDownCast(this->GetOutputDataObject(3));
}

int vtkSimplexMeshQuality::FillInputPortInformation(int port, vtkInformation* info)
{
  info->Set(
    vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), port == 0 ? "vtkUnstructuredGrid" : "vtkImageData");
  if (port == 1)
  {
    info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  }
  return 1;
}

int vtkSimplexMeshQuality::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 0 ? "vtkUnstructuredGrid" : "vtkTable");
  return 1;
}

int vtkSimplexMeshQuality::RequestInformation(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  // Pentatopes hold all times at once: a request for another time must not measure them again.
  if (inputVector[0]->GetInformationObject(0)->Has(vtkPentatopeMeshTimeSlice::MESH_TIME_RANGE()))
  {
    for (int port = 0; port < this->GetNumberOfOutputPorts(); ++port)
    {
      outputVector->GetInformationObject(port)->Remove(Pipeline::TIME_STEPS());
      outputVector->GetInformationObject(port)->Remove(Pipeline::TIME_RANGE());
    }
  }
  return 1;
}

int vtkSimplexMeshQuality::RequestUpdateExtent(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector*)
{
  voxplex::RequestWholeInputs(inputVector, 2);
  return 1;
}

//----------------------------------------------------------------------------------------------------
vtkTypeBool vtkSimplexMeshQuality::ProcessRequest(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  VOXPLEX_FORGET_ABORT(request);
  return this->Superclass::ProcessRequest(request, inputVector, outputVector);
}

int vtkSimplexMeshQuality::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  this->ErrorMessage.clear();
  this->Aborted = false;
  this->Private->Clear();
  bool done = false;
  this->ErrorMessage = voxplex::InTermsOf(voxplex::UserInterface::VTK,
    voxplex::CatchFailure( // also if no thread can be started
      [&]
      {
        this->CheckParameters();
        done = this->Measure(inputVector, outputVector);
      },
      "There is not enough memory to measure this mesh.", "The mesh cannot be measured: "));
  if (done)
  {
    return 1;
  }
  this->Private->Clear();
  voxplex::EmptyOutputs(outputVector);
  this->Aborted = this->ErrorMessage.empty();
  if (!this->Aborted)
  {
    vtkErrorMacro(<< this->ErrorMessage);
  }
  return this->Aborted ? 1 : 0;
}

void vtkSimplexMeshQuality::CheckParameters() const
{
  voxplex::CheckValue("smoothing", this->SmoothingSigma);
  voxplex::CheckValue("time-scale", this->TimeScale);
  if (this->NumberOfThreads < 0)
  {
    throw InputError("NumberOfThreads is " + std::to_string(this->NumberOfThreads) +
      "; it must be positive, or 0 for VTK's setting.");
  }
}

bool vtkSimplexMeshQuality::Measure(
  vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  return Execution(this, inputVector, outputVector).Measure();
}

bool vtkSimplexMeshQuality::StopRequested()
{
  return voxplex::IsStopRequested(this);
}

//----------------------------------------------------------------------------------------------------
namespace
{

/** The comparison of the frame that is farthest from its cut; null if there is none. */
const voxplex::ImageComparison* FarthestFrame(const voxplex::SpaceTimeMeasurement& figures)
{
  const voxplex::ImageComparison* farthest = nullptr;
  for (const voxplex::FrameMeasurement& frame : figures.Frames)
  {
    const auto& image = frame.Measured.Image;
    if (image && !(farthest && !(image->Voxels.Distance() > farthest->Voxels.Distance())))
    {
      farthest = &*image;
    }
  }
  return farthest;
}

const voxplex::DistanceFigures& Farther(const voxplex::HausdorffFigures& figures)
{
  return figures.MeshToImage.Maximum > figures.ImageToMesh.Maximum ? figures.MeshToImage
                                                                   : figures.ImageToMesh;
}

} // namespace

const voxplex::ImageComparison* vtkSimplexMeshQuality::Internals::Farthest() const
{
  if (this->SpaceTime)
  {
    return FarthestFrame(*this->SpaceTime);
  }
  return this->Figures.Image ? &*this->Figures.Image : nullptr;
}

const voxplex::MeshQuality& vtkSimplexMeshQuality::Internals::Shapes() const
{
  return this->SpaceTime ? this->SpaceTime->Quality : this->Figures.Quality;
}

double vtkSimplexMeshQuality::GetHausdorffDistance() const
{
  const auto* const image = this->Private->Farthest();
  return image ? image->Voxels.Distance() : voxplex::DistanceFigures::NotApplicable;
}

double vtkSimplexMeshQuality::GetSmoothHausdorffDistance() const
{
  const auto& image = this->Private->Figures.Image;
  return image ? image->Smooth.Distance() : voxplex::DistanceFigures::NotApplicable;
}

void vtkSimplexMeshQuality::GetHausdorffPlace(double place[3]) const
{
  const auto* const image = this->Private->Farthest();
  const voxplex::Point<3> p = image ? Farther(image->Voxels).Place : voxplex::Point<3>{};
  std::copy(p.begin(), p.end(), place);
}

// Getters whose figure has another name or type behind it.
#define VOXPLEX_FIGURE(type, getter, figure)                                                       \
  type vtkSimplexMeshQuality::Get##getter() const                                                  \
  {                                                                                                \
    return static_cast<type>(this->Private->figure);                                               \
  }

VOXPLEX_FIGURE(double, MinimumDihedralAngle, Shapes().MinimumDihedralAngle)
VOXPLEX_FIGURE(double, MaximumDihedralAngle, Shapes().MaximumDihedralAngle)
VOXPLEX_FIGURE(double, MaximumRadiusEdgeRatio, Shapes().MaximumRadiusEdgeRatio)
VOXPLEX_FIGURE(double, MinimumPlanarAngle, Shapes().MinimumFacetAngle)
VOXPLEX_FIGURE(double, MinimumNormalizedVolume, Shapes().MinimumNormalizedVolume)
VOXPLEX_FIGURE(double, MeanNormalizedVolume, Shapes().MeanNormalizedVolume)
VOXPLEX_FIGURE(vtkTypeInt64, NonManifoldEdges, Figures.Topology.NonManifoldEdges)
VOXPLEX_FIGURE(
  vtkTypeInt64, NonManifoldEdgesAtJunctions, Figures.Topology.NonManifoldEdgesAtJunctions)
#undef VOXPLEX_FIGURE

vtkTypeInt64 vtkSimplexMeshQuality::GetNumberOfLostLabels() const
{
  if (this->Private->SpaceTime)
  {
    return std::ssize(this->Private->SpaceTime->LostLabels());
  }
  const auto& image = this->Private->Figures.Image;
  return image ? std::ssize(image->LostLabels) : 0;
}

vtkTypeInt64 vtkSimplexMeshQuality::GetNumberOfLostComponents() const
{
  if (this->Private->SpaceTime)
  {
    const auto& components = this->Private->SpaceTime->Components;
    return components ? std::ssize(components->Lost) : 0;
  }
  const auto& image = this->Private->Figures.Image;
  return image ? std::ssize(image->LostComponents) : 0;
}

std::string vtkSimplexMeshQuality::ToJSON() const
{
  const Internals& figures = *this->Private;
  return figures.SpaceTime ? voxplex::ToJson(*figures.SpaceTime) : voxplex::ToJson(figures.Figures);
}

void vtkSimplexMeshQuality::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "RadiusEdgeRatio: " << this->RadiusEdgeRatio << "\n";
  os << indent << "FacetAngle: " << this->FacetAngle << "\n";
  os << indent << "SmallestComponent: " << this->SmallestComponent << "\n";
  os << indent << "Distances: " << this->Distances << "\n";
  os << indent << "SmoothDistances: " << this->SmoothDistances << "\n";
  os << indent << "SmoothingSigma: " << this->SmoothingSigma << "\n";
  os << indent << "TimeScale: " << this->TimeScale << "\n";
  os << indent << "NumberOfFrameTimes: " << this->Private->FrameTimes.size() << "\n";
  os << indent << "NumberOfWorstElements: " << this->NumberOfWorstElements << "\n";
  os << indent << "NumberOfThreads: " << this->NumberOfThreads << "\n";
  os << indent << "NumberOfLabels: " << this->Private->Labels.size() << "\n";
  os << indent << "Aborted: " << this->Aborted << "\n";
  voxplex::PrintText(os, indent, "ErrorMessage", this->ErrorMessage);
  os << indent << "All figures: " << this->ToJSON() << "\n";
}
