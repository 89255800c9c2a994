// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSimplexMeshQuality.h"

#include "Base/Error.h"
#include "Domain/LabelField.h"
#include "Mesh/FindInterfaces.h"
#include "Parallel/ParallelFor.h"
#include "Private/ChosenArray.h"
#include "Private/ImageLabels.h"
#include "Private/QualityJson.h"
#include "Private/QualityTables.h"
#include "Private/SmpThreads.h"
#include "Quality/MeshMeasurement.h"

#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkCellTypes.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkTable.h"
#include "vtkUnstructuredGrid.h"
#include "vtkVersion.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <exception>
#include <future>
#include <new>
#include <optional>
#include <set>
#include <sstream>
#include <stop_token>
#include <utility>

vtkStandardNewMacro(vtkSimplexMeshQuality);

using voxplex::InputError;

struct vtkSimplexMeshQuality::Internals
{
  std::set<vtkTypeInt64> Labels;

  // Of the last execution.
  voxplex::MeshMeasurement Figures;
  std::uint64_t Elements = 0;
  std::uint64_t Vertices = 0;
  std::uint64_t InterfaceFacets = 0;
  std::uint64_t FacesOfThreeElements = 0;

  /** Forgets the last execution. */
  void Clear() { *this = Internals{ this->Labels, {}, 0, 0, 0, 0 }; }
};

namespace
{

using Pipeline = vtkStreamingDemandDrivenPipeline;

/** Unless there is an image, the frame of the mesh is the world. */
voxplex::ImageFrame WorldFrame()
{
  voxplex::ImageFrame frame;
  for (std::size_t k = 0; k < 3; ++k)
  {
    frame.Rotation[k][k] = 1.0;
  }
  return frame;
}

/** The label of an element. */
std::int64_t LabelOf(double value, vtkIdType cell)
{
  if (!(value >= 1.0 && value <= 9007199254740992.0 && value == std::floor(value)))
  {
    std::ostringstream text;
    text << "Cell " << cell << " of the mesh has the label " << value
         << "; labels are whole numbers above 0.";
    throw InputError(text.str());
  }
  return static_cast<std::int64_t>(value);
}

vtkDataArray* LabelsOf(vtkUnstructuredGrid* grid, vtkAbstractArray* chosen)
{
  vtkDataArray* const labels = vtkDataArray::SafeDownCast(chosen);
  if (labels == nullptr)
  {
    throw InputError(
      "The mesh has no numeric cell array of labels; it is 'Label' unless another is chosen "
      "with SetInputArrayToProcess().");
  }
  if (labels->GetNumberOfComponents() != 1 ||
    labels->GetNumberOfTuples() != grid->GetNumberOfCells())
  {
    throw InputError(
      "The mesh's array of labels must have one component, and one value for each cell.");
  }
  return labels;
}

/** @throws InputError if it is no mesh of labelled tetrahedra */
voxplex::SimplexMesh<3> ReadMesh(
  vtkUnstructuredGrid* grid, vtkAbstractArray* chosen, const voxplex::ImageFrame& frame)
{
  voxplex::SimplexMesh<3> mesh;
  const vtkIdType cells = grid->GetNumberOfCells();
  if (cells == 0)
  {
    return mesh;
  }
  vtkDataArray* const labels = LabelsOf(grid, chosen);
  mesh.Points.resize(static_cast<std::size_t>(grid->GetNumberOfPoints()));
  for (std::size_t i = 0; i < mesh.Points.size(); ++i)
  {
    voxplex::Point<3> world;
    grid->GetPoint(static_cast<vtkIdType>(i), world.data());
    if (!std::isfinite(world[0]) || !std::isfinite(world[1]) || !std::isfinite(world[2]))
    {
      throw InputError("Point " + std::to_string(i) + " of the mesh is not finite.");
    }
    mesh.Points[i] = frame.ToFrame(world);
  }
  mesh.Simplices.resize(static_cast<std::size_t>(cells));
  mesh.Labels.resize(static_cast<std::size_t>(cells));
  for (vtkIdType c = 0; c < cells; ++c)
  {
    if (grid->GetCellType(c) != VTK_TETRA)
    {
      throw InputError("Cell " + std::to_string(c) + " of the mesh is a " +
        vtkCellTypes::GetClassNameFromTypeId(grid->GetCellType(c)) +
        "; only tetrahedra (VTK_TETRA) can be measured.");
    }
    vtkIdType size = 0;
    const vtkIdType* ids = nullptr;
    grid->GetCells()->GetCellAtId(c, size, ids);
    auto& simplex = mesh.Simplices[static_cast<std::size_t>(c)];
    for (std::size_t i = 0; i < 4; ++i)
    {
      simplex[i] = static_cast<std::uint32_t>(ids[i]);
    }
    if (frame.LeftHanded) // so that volumes are positive in the frame, too
    {
      std::swap(simplex[2], simplex[3]);
    }
    mesh.Labels[static_cast<std::size_t>(c)] = LabelOf(labels->GetComponent(c, 0), c);
  }
  return mesh;
}

void MoveToWorld(const voxplex::ImageFrame& frame, voxplex::HausdorffFigures& figures)
{
  for (voxplex::DistanceFigures* direction : { &figures.MeshToImage, &figures.ImageToMesh })
  {
    direction->Place = frame.ToWorld(direction->Place);
  }
}

} // namespace

//----------------------------------------------------------------------------------------------------
vtkSimplexMeshQuality::vtkSimplexMeshQuality()
  : Private(std::make_unique<Internals>())
{
  this->SetNumberOfInputPorts(2);
  this->SetNumberOfOutputPorts(3);
  this->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "Label");
  this->SetInputArrayToProcess(
    1, 1, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS_THEN_CELLS, vtkDataSetAttributes::SCALARS);
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
  if (this->Private->Labels.insert(label).second)
  {
    this->Modified();
  }
}

void vtkSimplexMeshQuality::RemoveAllLabels()
{
  if (!this->Private->Labels.empty())
  {
    this->Private->Labels.clear();
    this->Modified();
  }
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

int vtkSimplexMeshQuality::RequestUpdateExtent(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector*)
{
  // Always the whole: interfaces and distances cannot be found piece by piece.
  for (int port = 0; port < 2; ++port)
  {
    vtkInformation* const input = inputVector[port]->GetInformationObject(0);
    if (input != nullptr)
    {
      input->Set(Pipeline::UPDATE_PIECE_NUMBER(), 0);
      input->Set(Pipeline::UPDATE_NUMBER_OF_PIECES(), 1);
      input->Set(Pipeline::UPDATE_NUMBER_OF_GHOST_LEVELS(), 0);
      if (input->Has(Pipeline::WHOLE_EXTENT()))
      {
        input->Set(Pipeline::UPDATE_EXTENT(), input->Get(Pipeline::WHOLE_EXTENT()), 6);
      }
    }
  }
  return 1;
}

//----------------------------------------------------------------------------------------------------
int vtkSimplexMeshQuality::RequestData(
  vtkInformation*, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  this->ErrorMessage.clear();
  this->Aborted = false;
  this->Private->Clear();
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 2, 20220823)
  // What stopped the last execution does not stop this one. In VTK 9.2 and before the executive sees to it.
  this->AbortExecute = 0;
#endif
  bool done = false;
  try
  {
    this->CheckParameters();
    done = this->Measure(inputVector, outputVector);
  }
  catch (const voxplex::Error& error)
  {
    this->ErrorMessage = error.what();
  }
  catch (const std::bad_alloc&)
  {
    this->ErrorMessage = "There is not enough memory to measure this mesh.";
  }
  catch (const std::exception& error) // no thread can be started
  {
    this->ErrorMessage = std::string("The mesh cannot be measured: ") + error.what();
  }
  if (done)
  {
    return 1;
  }
  this->Private->Clear();
  for (int port = 0; port < this->GetNumberOfOutputPorts(); ++port)
  {
    vtkDataObject::GetData(outputVector, port)->Initialize();
  }
  this->Aborted = this->ErrorMessage.empty();
  if (!this->Aborted)
  {
    vtkErrorMacro(<< this->ErrorMessage);
  }
  return this->Aborted ? 1 : 0;
}

void vtkSimplexMeshQuality::CheckParameters() const
{
  if (!(this->SmoothingSigma >= 0.0 &&
        this->SmoothingSigma <= voxplex::LabelField<3>::MaximumSigma))
  {
    throw InputError("SmoothingSigma is " + std::to_string(this->SmoothingSigma) +
      "; it must be between 0 and 5 voxels.");
  }
  if (this->NumberOfThreads < 0)
  {
    throw InputError("NumberOfThreads is " + std::to_string(this->NumberOfThreads) +
      "; it must be positive, or 0 for VTK's setting.");
  }
}

bool vtkSimplexMeshQuality::Measure(
  vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  const unsigned threads = static_cast<unsigned>(
    this->NumberOfThreads > 0 ? this->NumberOfThreads : voxplex::SmpThreads());
  vtkUnstructuredGrid* const grid = vtkUnstructuredGrid::GetData(inputVector[0]);
  vtkImageData* const image = vtkImageData::GetData(inputVector[1]);
  std::optional<voxplex::ChosenArray> voxels;
  if (image != nullptr)
  {
    int association = 0;
    vtkAbstractArray* const scalars =
      this->GetInputAbstractArrayToProcess(1, inputVector, association);
    voxels = voxplex::ChooseScalars(image, scalars, association, "image", "");
  }
  const voxplex::ImageFrame frame = voxels ? voxels->Frame : WorldFrame();
  voxplex::SimplexMesh<3> mesh =
    ReadMesh(grid, this->GetInputAbstractArrayToProcess(0, inputVector), frame);
  this->UpdateProgress(0.1);

  const voxplex::MeasurementOptions options{ this->RadiusEdgeRatio, this->FacetAngle,
    this->SmallestComponent, this->Distances, this->SmoothDistances, this->SmoothingSigma,
    threads };
  // Measured by another thread, so that this one can see to AbortExecute.
  std::stop_source stop;
  auto work = std::async(std::launch::async,
    [&]
    {
      this->Private->FacesOfThreeElements =
        voxplex::FindInterfaces(mesh, threads, stop.get_token());
      std::optional<voxplex::LabelImage<3>> labels;
      if (voxels)
      {
        const auto& only = this->Private->Labels;
        labels = voxplex::ReadLabels(
          *voxels, { { only.begin(), only.end() }, {} }, threads, stop.get_token());
      }
      this->Private->Figures =
        voxplex::MeasureMesh(mesh, labels ? &*labels : nullptr, options, stop.get_token());
    });
  double progress = 0.1;
  while (work.wait_for(std::chrono::milliseconds(50)) != std::future_status::ready)
  {
    progress += 0.01 * (0.9 - progress); // how long it takes is not known
    this->UpdateProgress(progress);
    if (this->StopRequested())
    {
      stop.request_stop();
    }
  }
  try
  {
    work.get();
  }
  catch (const voxplex::Cancelled&)
  {
    return false;
  }
  if (this->StopRequested())
  {
    return false;
  }
  Internals& figures = *this->Private;
  figures.Elements = mesh.Simplices.size();
  figures.Vertices = mesh.Points.size();
  figures.InterfaceFacets = mesh.Facets.size();
  if (figures.Figures.Image)
  {
    MoveToWorld(frame, figures.Figures.Image->Voxels);
    MoveToWorld(frame, figures.Figures.Image->Smooth);
  }
  vtkUnstructuredGrid* const output = vtkUnstructuredGrid::GetData(outputVector, 0);
  output->ShallowCopy(grid);
  voxplex::AddElementMeasures(mesh, threads, output->GetCellData());
  voxplex::FillLabelTable(figures.Figures, vtkTable::GetData(outputVector, 1));
  voxplex::FillHistograms(figures.Figures.Quality, vtkTable::GetData(outputVector, 2));
  this->UpdateProgress(1.0);
  return true;
}

bool vtkSimplexMeshQuality::StopRequested()
{
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 3, 0)
  return this->CheckAbort();
#else
  return this->GetAbortExecute() != 0;
#endif
}

//----------------------------------------------------------------------------------------------------
namespace
{

const voxplex::DistanceFigures& Farther(const voxplex::HausdorffFigures& figures)
{
  return figures.MeshToImage.Maximum > figures.ImageToMesh.Maximum ? figures.MeshToImage
                                                                   : figures.ImageToMesh;
}

} // namespace

double vtkSimplexMeshQuality::GetHausdorffDistance() const
{
  const auto& image = this->Private->Figures.Image;
  return image ? image->Voxels.Distance() : voxplex::DistanceFigures::NotApplicable;
}

double vtkSimplexMeshQuality::GetSmoothHausdorffDistance() const
{
  const auto& image = this->Private->Figures.Image;
  return image ? image->Smooth.Distance() : voxplex::DistanceFigures::NotApplicable;
}

void vtkSimplexMeshQuality::GetHausdorffPlace(double place[3]) const
{
  const auto& image = this->Private->Figures.Image;
  const voxplex::Point<3> p = image ? Farther(image->Voxels).Place : voxplex::Point<3>{};
  std::copy(p.begin(), p.end(), place);
}

double vtkSimplexMeshQuality::GetMinimumDihedralAngle() const
{
  return this->Private->Figures.Quality.MinimumDihedralAngle;
}

double vtkSimplexMeshQuality::GetMaximumDihedralAngle() const
{
  return this->Private->Figures.Quality.MaximumDihedralAngle;
}

double vtkSimplexMeshQuality::GetMaximumRadiusEdgeRatio() const
{
  return this->Private->Figures.Quality.MaximumRadiusEdgeRatio;
}

double vtkSimplexMeshQuality::GetMinimumPlanarAngle() const
{
  return this->Private->Figures.Quality.MinimumFacetAngle;
}

vtkTypeInt64 vtkSimplexMeshQuality::GetNonManifoldEdges() const
{
  return static_cast<vtkTypeInt64>(this->Private->Figures.Topology.NonManifoldEdges);
}

vtkTypeInt64 vtkSimplexMeshQuality::GetNonManifoldEdgesAtJunctions() const
{
  return static_cast<vtkTypeInt64>(this->Private->Figures.Topology.NonManifoldEdgesAtJunctions);
}

vtkTypeInt64 vtkSimplexMeshQuality::GetNumberOfLostLabels() const
{
  const auto& image = this->Private->Figures.Image;
  return image ? std::ssize(image->LostLabels) : 0;
}

vtkTypeInt64 vtkSimplexMeshQuality::GetNumberOfLostComponents() const
{
  const auto& image = this->Private->Figures.Image;
  return image ? std::ssize(image->LostComponents) : 0;
}

std::string vtkSimplexMeshQuality::ToJSON() const
{
  const Internals& figures = *this->Private;
  nlohmann::ordered_json json = {
    { "elements", figures.Elements },
    { "vertices", figures.Vertices },
    { "interface_facets", figures.InterfaceFacets },
    { "faces_of_three_elements", figures.FacesOfThreeElements },
  };
  voxplex::AddMeasurement(json, figures.Figures);
  return json.dump();
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
  os << indent << "NumberOfThreads: " << this->NumberOfThreads << "\n";
  os << indent << "NumberOfLabels: " << this->Private->Labels.size() << "\n";
  os << indent << "Aborted: " << this->Aborted << "\n";
  os << indent
     << "ErrorMessage: " << (this->ErrorMessage.empty() ? "(none)" : this->ErrorMessage.c_str())
     << "\n";
  os << indent << "All figures: " << this->ToJSON() << "\n";
}
