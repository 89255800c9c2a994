// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkImageToTetMeshFilter.h"

#include "Image/IsosurfaceImage.h"
#include "ImageVoxels.h"
#include "Private/MeshOutput.h"
#include "Private/SimplexMeshRun.h"

#include "vtkImplicitFunction.h"
#include "vtkInformation.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkUnstructuredGrid.h"

#include <utility>

vtkStandardNewMacro(vtkImageToTetMeshFilter);

namespace
{

/** @param scalars must live as long as the result */
voxplex::IsosurfaceImage<3> ReadIsosurface(vtkDataArray* scalars, const voxplex::ImageFrame& frame,
  const voxplex::Isosurface& surface, unsigned threads)
{
  const auto count = static_cast<std::size_t>(scalars->GetNumberOfTuples());
  switch (scalars->GetDataType())
  {
    vtkTemplateMacro(return voxplex::IsosurfaceImage<3>::FromScalars<VTK_TT>(
      std::span<const VTK_TT>(static_cast<const VTK_TT*>(scalars->GetVoidPointer(0)), count),
      frame.Grid, surface, threads));
  }
  throw voxplex::InputError("Scalars of type " + std::string(scalars->GetDataTypeAsString()) +
    " cannot be read as grey values.");
}

} // namespace

//----------------------------------------------------------------------------------------------------
vtkImageToTetMeshFilter::vtkImageToTetMeshFilter() = default;
vtkImageToTetMeshFilter::~vtkImageToTetMeshFilter() = default;

void vtkImageToTetMeshFilter::SetSizeImplicitFunction(vtkImplicitFunction* function)
{
  if (this->SizeImplicitFunction != function)
  {
    this->SizeImplicitFunction = function;
    this->Modified();
  }
}

vtkImplicitFunction* vtkImageToTetMeshFilter::GetSizeImplicitFunction() const
{
  return this->SizeImplicitFunction;
}

vtkPolyData* vtkImageToTetMeshFilter::GetInterfaces()
{
  return vtkPolyData::SafeDownCast(this->GetOutputDataObject(1));
}

vtkMTimeType vtkImageToTetMeshFilter::GetMTime()
{
  const vtkMTimeType own = this->Superclass::GetMTime();
  vtkImplicitFunction* function = this->SizeImplicitFunction;
  return function ? std::max(own, function->GetMTime()) : own;
}

int vtkImageToTetMeshFilter::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 0 ? "vtkUnstructuredGrid" : "vtkPolyData");
  return 1;
}

//----------------------------------------------------------------------------------------------------
double vtkImageToTetMeshFilter::FindDefaultDelta(vtkInformationVector** inputVector)
{
  return voxplex::DefaultDelta<3>(
    voxplex::FindVoxelVolume(inputVector[0]->GetInformationObject(0)));
}

void vtkImageToTetMeshFilter::CheckParameters() const
{
  this->Superclass::CheckParameters();
  voxplex::CheckValue("facet-angle", this->FacetAngle);
  voxplex::CheckValue("sliver-angle", this->SliverAngle, this->Force);
  voxplex::CheckValue("min-component-volume", this->MinimumComponentVolume);
  voxplex::CheckValue("optimise-seconds", this->OptimisationTimeLimit);
}

void vtkImageToTetMeshFilter::Mesh(
  vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  int association = 0;
  vtkAbstractArray* scalars = this->GetInputAbstractArrayToProcess(0, inputVector, association);
  const voxplex::ChosenArray input =
    voxplex::ChooseScalars(vtkImageData::GetData(inputVector[0]), scalars, association,
      this->InputMode == INPUT_LABELS ? voxplex::ImageContent::Labels
                                      : voxplex::ImageContent::GreyValues,
      "image",
      " Of colours or vectors, extract one; for time series, use vtkImageToPentatopeMeshFilter.");

  Run<3> run(this, inputVector, input.Frame);
  run.Options.Shape.FacetAngle = this->FacetAngle;
  run.Options.Shape.Slivers.Angle = this->SliverAngle;
  run.Options.Optimisation.Seconds = this->OptimisationTimeLimit;
  run.Options.Interfaces.SampleJunctions = this->SampleJunctions;
  run.Sizes->Implicit = this->SizeImplicitFunction;
  run.Options.SmallestVolume = this->MinimumComponentVolume;
  const unsigned threads = run.Options.Team.Threads;
  voxplex::SimplexMesh<3> mesh;
  bool done = false;
  if (this->InputMode == INPUT_LABELS)
  {
    done = run.Mesh(ReadLabels(input, run.SelectedLabels(), threads), mesh);
  }
  else
  {
    const voxplex::Isosurface surface = run.ChosenIsosurface();
    const vtkSmartPointer<vtkDataArray> values = voxplex::Contiguous(input.Array);
    done = run.Mesh(ReadIsosurface(values, input.Frame, surface, threads), mesh);
  }
  if (!done)
  {
    return;
  }
  const voxplex::Stopwatch writing;
  voxplex::MoveToOutput(std::move(mesh), input.Frame, vtkUnstructuredGrid::GetData(outputVector, 0),
    vtkPolyData::GetData(outputVector, 1), threads);
  run.Statistics().Times.Extraction += writing.Seconds();
}

//----------------------------------------------------------------------------------------------------
void vtkImageToTetMeshFilter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FacetAngle: " << this->FacetAngle << "\n";
  os << indent << "SliverAngle: " << this->SliverAngle << "\n";
  os << indent << "OptimisationTimeLimit: " << this->OptimisationTimeLimit << "\n";
  os << indent << "SampleJunctions: " << this->SampleJunctions << "\n";
  os << indent << "MinimumComponentVolume: " << this->MinimumComponentVolume << "\n";
  os << indent << "SizeImplicitFunction: ";
  if (this->SizeImplicitFunction)
  {
    os << "\n";
    this->SizeImplicitFunction->PrintSelf(os, indent.GetNextIndent());
  }
  else
  {
    os << "(none)\n";
  }
}
