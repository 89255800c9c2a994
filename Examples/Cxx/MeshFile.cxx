// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
//
// Reads a segmentation, meshes it, and writes the mesh; the extension of OUTPUT chooses the format.
// Usage: MeshFile SEGMENTATION DELTA OUTPUT

#include "vtkImageToTetMeshFilter.h"
#include "vtkNew.h"
#include "vtkSegmentationReader.h"
#include "vtkSimplexMeshWriter.h"
#include "vtkUnstructuredGrid.h"

#include <cstdlib>
#include <iostream>

int main(int argc, char* argv[])
{
  if (argc != 4)
  {
    std::cerr << "Usage: " << argv[0] << " SEGMENTATION DELTA OUTPUT\n";
    return EXIT_FAILURE;
  }

  vtkNew<vtkSegmentationReader> reader;
  reader->SetFileName(argv[1]);

  vtkNew<vtkImageToTetMeshFilter> mesher;
  mesher->SetInputConnection(reader->GetOutputPort());
  mesher->SetDelta(std::atof(argv[2]));
  mesher->Update();
  if (!reader->GetErrorMessage().empty() || !mesher->GetErrorMessage().empty())
  {
    return EXIT_FAILURE; // vtkErrorMacro has shown it
  }
  std::cout << mesher->GetOutput()->GetNumberOfCells() << " tetrahedra\n";

  vtkNew<vtkSimplexMeshWriter> writer;
  writer->SetInputConnection(0, mesher->GetOutputPort());
  writer->SetInputConnection(1, mesher->GetInterfacesPort()); // surfaces, in formats that have them
  writer->SetFileName(argv[3]);
  return writer->Write() == 1 ? EXIT_SUCCESS : EXIT_FAILURE;
}
