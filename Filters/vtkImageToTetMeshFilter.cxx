// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkImageToTetMeshFilter.h"

#include "Image/DropComponents.h"
#include "Private/MeshOutput.h"
#include "Private/SimplexMeshRun.h"

#include "vtkImplicitFunction.h"
#include "vtkInformation.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkUnstructuredGrid.h"

#include <limits>
#include <utility>
#include <vector>

vtkStandardNewMacro(vtkImageToTetMeshFilter);

namespace
{

voxplex::LabelImage<3> ReadLabels(
  const voxplex::ChosenArray& input, const voxplex::LabelSelection& selection, unsigned threads)
{
  const vtkSmartPointer<vtkDataArray> array = voxplex::Contiguous(input.Array);
  const auto count = static_cast<std::size_t>(array->GetNumberOfTuples());
  switch (array->GetDataType())
  {
    vtkTemplateMacro(return voxplex::LabelImage<3>::FromScalars<VTK_TT>(
      std::span<const VTK_TT>(static_cast<const VTK_TT*>(array->GetVoidPointer(0)), count),
      input.Frame.Grid, selection, threads));
  }
  throw voxplex::InputError(
    "Scalars of type " + std::string(array->GetDataTypeAsString()) + " cannot be read as labels.");
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
  voxplex::CheckRange(this->FacetAngle, 0.0, 30.0, "FacetAngle", "between 0 and 30 degrees");
  voxplex::CheckRange(this->SliverAngle, 0.0, this->Force ? 59.0 : voxplex::LargestSliverAngle,
    "SliverAngle",
    this->Force
      ? "between 0 and 59 degrees"
      : "between 0 and 15 degrees, because above meshes can become very large; Force goes "
        "on to 59");
  voxplex::CheckRange(this->MinimumComponentVolume, 0.0, std::numeric_limits<double>::max(),
    "MinimumComponentVolume", "positive and finite, or 0 for none");
}

void vtkImageToTetMeshFilter::Mesh(
  vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  int association = 0;
  vtkAbstractArray* scalars = this->GetInputAbstractArrayToProcess(0, inputVector, association);
  const voxplex::ChosenArray input = voxplex::ChooseScalars(vtkImageData::GetData(inputVector[0]),
    scalars, association, "image", " For time series, use vtkImageToPentatopeMeshFilter.");

  Run<3> run(this, inputVector, input.Frame);
  run.Options.FacetAngle = this->FacetAngle;
  run.Options.TetSlivers.Angle = this->SliverAngle;
  run.Options.Optimise = this->Optimise;
  run.Options.SmallestComponent = this->SmallestComponent;
  run.Sizes->Implicit = this->SizeImplicitFunction;
  voxplex::SimplexMesh<3> mesh;
  voxplex::LabelImage<3> labels = ReadLabels(input, run.SelectedLabels(), run.Options.Threads);
  std::vector<voxplex::ComponentReport> dropped =
    voxplex::DropComponents(labels, this->MinimumComponentVolume, run.Options.Threads);
  if (!run.Mesh(labels, mesh))
  {
    return;
  }
  run.Figures().DroppedComponents = std::move(dropped);
  const voxplex::StopWatch writing;
  voxplex::MoveToOutput(std::move(mesh), input.Frame, vtkUnstructuredGrid::GetData(outputVector, 0),
    vtkPolyData::GetData(outputVector, 1), run.Options.Threads);
  run.Figures().Run.Times.Extraction += writing.Seconds();
}

//----------------------------------------------------------------------------------------------------
void vtkImageToTetMeshFilter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FacetAngle: " << this->FacetAngle << "\n";
  os << indent << "SliverAngle: " << this->SliverAngle << "\n";
  os << indent << "Optimise: " << this->Optimise << "\n";
  os << indent << "SmallestComponent: " << this->SmallestComponent << "\n";
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
