// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
//
// A pipeline of ITK with the meshing filter at its end: a CT image is thresholded, its connected components become
// labels, the largest first, and these are meshed where the image lies, its direction matrix included.
// Usage: MeshITKImage IMAGE THRESHOLD DELTA OUTPUT.vtk

#include "itkBinaryThresholdImageFilter.h"
#include "itkConnectedComponentImageFilter.h"
#include "itkImage.h"
#include "itkImageFileReader.h"
#include "itkLabelImageToTetrahedralMeshFilter.h"
#include "itkMesh.h"
#include "itkRelabelComponentImageFilter.h"

#include <cstdlib>
#include <fstream>
#include <iostream>
#include <limits>

using GreyImage = itk::Image<short, 3>;
using LabelImage = itk::Image<unsigned short, 3>;
using Mesh = itk::Mesh<unsigned short, 3>;

/** ITK's own writers have no tetrahedra: VTK's legacy format, as text. */
void Write(const Mesh* mesh, const char* path)
{
  std::ofstream file(path);
  file.exceptions(std::ios::failbit | std::ios::badbit);
  file.precision(9);
  file << "# vtk DataFile Version 3.0\nMeshITKImage\nASCII\nDATASET UNSTRUCTURED_GRID\n";
  file << "POINTS " << mesh->GetNumberOfPoints() << " float\n";
  for (const auto& point : mesh->GetPoints()->CastToSTLConstContainer())
  {
    file << point[0] << ' ' << point[1] << ' ' << point[2] << '\n';
  }
  const auto cells = mesh->GetNumberOfCells();
  file << "CELLS " << cells << ' ' << 5 * cells << '\n';
  for (const auto* const cell : mesh->GetCells()->CastToSTLConstContainer())
  {
    file << 4;
    for (auto corner = cell->PointIdsBegin(); corner != cell->PointIdsEnd(); ++corner)
    {
      file << ' ' << *corner;
    }
    file << '\n';
  }
  file << "CELL_TYPES " << cells << '\n';
  for (std::size_t i = 0; i < cells; ++i)
  {
    file << "10\n"; // VTK_TETRA
  }
  file << "CELL_DATA " << cells << "\nSCALARS Label unsigned_short\nLOOKUP_TABLE default\n";
  for (const auto label : mesh->GetCellData()->CastToSTLConstContainer())
  {
    file << label << '\n';
  }
}

void Run(const char* input, short threshold, double delta, const char* output)
{
  const auto reader = itk::ImageFileReader<GreyImage>::New();
  reader->SetFileName(input);

  const auto bone = itk::BinaryThresholdImageFilter<GreyImage, LabelImage>::New();
  bone->SetInput(reader->GetOutput());
  bone->SetLowerThreshold(threshold);
  bone->SetUpperThreshold(std::numeric_limits<short>::max());
  bone->SetInsideValue(1);
  bone->SetOutsideValue(0);

  const auto components = itk::ConnectedComponentImageFilter<LabelImage, LabelImage>::New();
  components->SetInput(bone->GetOutput());

  const auto labels = itk::RelabelComponentImageFilter<LabelImage, LabelImage>::New();
  labels->SetInput(components->GetOutput());
  labels->SetMinimumObjectSize(100); // voxels

  const auto mesher = itk::LabelImageToTetrahedralMeshFilter<LabelImage, Mesh>::New();
  mesher->SetInput(labels->GetOutput());
  mesher->SetDelta(delta); // sampling distance of interfaces, mm
  mesher->Update();        // the whole pipeline
  std::cout << labels->GetNumberOfObjects() << " components, "
            << mesher->GetOutput()->GetNumberOfCells() << " tetrahedra\n";
  Write(mesher->GetOutput(), output);
}

int main(int argc, char* argv[])
{
  if (argc != 5)
  {
    std::cerr << "Usage: " << argv[0] << " IMAGE THRESHOLD DELTA OUTPUT.vtk\n";
    return EXIT_FAILURE;
  }
  try
  {
    Run(argv[1], static_cast<short>(std::atoi(argv[2])), std::atof(argv[3]), argv[4]);
    return EXIT_SUCCESS;
  }
  catch (const itk::ExceptionObject& error) // of a filter
  {
    std::cerr << argv[0] << ": " << error.GetDescription() << "\n";
  }
  catch (const std::exception& error) // of the file that is written
  {
    std::cerr << argv[0] << ": " << argv[4] << ": " << error.what() << "\n";
  }
  return EXIT_FAILURE;
}
