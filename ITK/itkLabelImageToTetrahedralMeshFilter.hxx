// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#ifndef itkLabelImageToTetrahedralMeshFilter_hxx
#define itkLabelImageToTetrahedralMeshFilter_hxx

#include "itkLabelImageToTetrahedralMeshFilter.h"

#include "itkMesh.h"
#include "itkMultiThreaderBase.h"
#include "itkPoint.h"
#include "itkTetrahedronCell.h"

#include <algorithm>
#include <exception>

namespace itk
{

template <typename TInputImage, typename TOutputMesh>
void LabelImageToTetrahedralMeshFilter<TInputImage, TOutputMesh>::AddLabel(std::int64_t label)
{
  if (this->m_Labels.insert(label).second)
  {
    this->Modified();
  }
}

template <typename TInputImage, typename TOutputMesh>
void LabelImageToTetrahedralMeshFilter<TInputImage, TOutputMesh>::RemoveAllLabels()
{
  if (!this->m_Labels.empty())
  {
    this->m_Labels.clear();
    this->Modified();
  }
}

template <typename TInputImage, typename TOutputMesh>
void LabelImageToTetrahedralMeshFilter<TInputImage, TOutputMesh>::GenerateData()
{
  const voxplex::LabelledTetrahedra mesh = this->Mesh();
  if (this->GetAbortGenerateData())
  {
    ProcessAborted aborted(__FILE__, __LINE__);
    aborted.SetLocation(ITK_LOCATION);
    aborted.SetDescription("Meshing was stopped by AbortGenerateData.");
    throw aborted;
  }
  if (!mesh.Error.empty())
  {
    itkExceptionMacro(<< mesh.Error);
  }
  this->Fill(mesh);
  for (const std::string& warning : mesh.Warnings)
  {
    itkWarningMacro(<< warning);
  }
}

template <typename TInputImage, typename TOutputMesh>
voxplex::LabelledTetrahedra LabelImageToTetrahedralMeshFilter<TInputImage, TOutputMesh>::Mesh()
{
  const TInputImage* const image = this->GetInput();
  const auto region = image->GetBufferedRegion(); // the origin is that of index 0, perhaps outside
  Point<double, 3> first;
  image->TransformIndexToPhysicalPoint(region.GetIndex(), first);
  voxplex::LabelGrid grid;
  for (unsigned axis = 0; axis < 3; ++axis)
  {
    grid.Dimensions[axis] = static_cast<std::int64_t>(region.GetSize(axis));
    grid.Origin[axis] = first[axis];
    for (unsigned row = 0; row < 3; ++row)
    {
      grid.Steps[axis][row] = image->GetDirection()[row][axis] * image->GetSpacing()[axis];
    }
  }
  std::exception_ptr thrown; // by an observer
  const auto progress = [this, &thrown](double fraction)
  {
    try
    {
      this->UpdateProgress(static_cast<float>(fraction));
    }
    catch (...)
    {
      thrown = std::current_exception();
    }
    return !thrown && !this->GetAbortGenerateData();
  };
  // A pool of threads has several work units for each, which would keep each other waiting here.
  const unsigned threads = std::min<unsigned>(
    this->GetNumberOfWorkUnits(), this->GetMultiThreader()->GetMaximumNumberOfThreads());
  voxplex::LabelledTetrahedra mesh =
    voxplex::MeshLabels(image->GetBufferPointer(), grid, *this, threads, progress);
  if (thrown)
  {
    std::rethrow_exception(thrown);
  }
  return mesh;
}

template <typename TInputImage, typename TOutputMesh>
void LabelImageToTetrahedralMeshFilter<TInputImage, TOutputMesh>::Fill(
  const voxplex::LabelledTetrahedra& mesh)
{
  using CellType = typename TOutputMesh::CellType;
  using CellPixelType = typename TOutputMesh::CellPixelType;
  for (std::size_t i = 0; i < mesh.NumberOfTetrahedra; ++i)
  {
    const std::int64_t label = mesh.Labels[i];
    if (static_cast<long double>(static_cast<CellPixelType>(label)) != label)
    {
      itkExceptionMacro(<< "The label " << label
                        << " does not fit into the cell data of the mesh, whose "
                           "CellPixelType has "
                        << sizeof(CellPixelType) << " bytes; choose a larger type.");
    }
  }

  const auto points = TOutputMesh::PointsContainer::New();
  points->Reserve(mesh.NumberOfPoints);
  for (std::size_t i = 0; i < mesh.NumberOfPoints; ++i)
  {
    typename TOutputMesh::PointType point;
    for (unsigned axis = 0; axis < 3; ++axis)
    {
      point[axis] = static_cast<typename TOutputMesh::PointType::ValueType>(mesh.Points[i][axis]);
    }
    points->InsertElement(i, point);
  }
  TOutputMesh* const output = this->GetOutput();
  output->SetPoints(points);

  const auto labels = TOutputMesh::CellDataContainer::New();
  labels->Reserve(mesh.NumberOfTetrahedra);
  const auto cells = TOutputMesh::CellsContainer::New();
  cells->Reserve(mesh.NumberOfTetrahedra);
  output->SetCells(cells);
  output->SetCellData(labels);
  for (std::size_t i = 0; i < mesh.NumberOfTetrahedra; ++i)
  {
    typename CellType::CellAutoPointer cell;
    cell.TakeOwnership(new TetrahedronCell<CellType>);
    for (int corner = 0; corner < 4; ++corner)
    {
      cell->SetPointId(corner, mesh.Tetrahedra[i][static_cast<std::size_t>(corner)]);
    }
    output->SetCell(i, cell);
    labels->InsertElement(i, static_cast<CellPixelType>(mesh.Labels[i]));
  }
  output->SetBufferedRegion(output->GetRequestedRegion()); // or every update meshes again
}

template <typename TInputImage, typename TOutputMesh>
void LabelImageToTetrahedralMeshFilter<TInputImage, TOutputMesh>::PrintSelf(
  std::ostream& os, Indent indent) const
{
  Superclass::PrintSelf(os, indent);
  os << indent << "Delta: " << this->m_Delta << "\n";
  os << indent << "NumberOfElements: " << this->m_NumberOfElements << "\n";
  os << indent << "RadiusEdgeRatio: " << this->m_RadiusEdgeRatio << "\n";
  os << indent << "FacetAngle: " << this->m_FacetAngle << "\n";
  os << indent << "SmoothingSigma: " << this->m_SmoothingSigma << "\n";
  os << indent << "MinimumComponentVolume: " << this->m_MinimumComponentVolume << "\n";
  os << indent << "ExactComponents: " << (this->m_ExactComponents ? "On" : "Off") << "\n";
  os << indent << "Optimise: " << (this->m_Optimise ? "On" : "Off") << "\n";
  os << indent << "Reproducible: " << (this->m_Reproducible ? "On" : "Off") << "\n";
  os << indent << "Force: " << (this->m_Force ? "On" : "Off") << "\n";
  os << indent << "Labels:";
  for (const std::int64_t label : this->m_Labels)
  {
    os << ' ' << label;
  }
  os << (this->m_Labels.empty() ? " (all)\n" : "\n");
}

} // namespace itk

#endif
