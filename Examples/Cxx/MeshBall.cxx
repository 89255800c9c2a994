// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
//
// Meshes a label image that is made on the spot, a ball (label 2) in a shell (label 1), and writes
// the tetrahedra. Usage: MeshBall OUTPUT.vtu

#include "vtkImageData.h"
#include "vtkImageToTetMeshFilter.h"
#include "vtkMeshingStatistics.h"
#include "vtkNew.h"
#include "vtkXMLUnstructuredGridWriter.h"

#include <cmath>
#include <cstdlib>
#include <iostream>

int main(int argc, char* argv[])
{
  if (argc != 2)
  {
    std::cerr << "Usage: " << argv[0] << " OUTPUT.vtu\n";
    return EXIT_FAILURE;
  }

  // 40 x 40 x 20 voxels of 1 x 1 x 2 mm.
  vtkNew<vtkImageData> image;
  image->SetDimensions(40, 40, 20);
  image->SetSpacing(1.0, 1.0, 2.0);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 1);
  for (int k = 0; k < 20; ++k)
  {
    for (int j = 0; j < 40; ++j)
    {
      for (int i = 0; i < 40; ++i)
      {
        const double r = std::hypot(i - 19.5, j - 19.5, 2.0 * (k - 9.5));
        *static_cast<unsigned char*>(image->GetScalarPointer(i, j, k)) = r < 8.0 ? 2
          : r < 14.0                                                             ? 1
                                                                                 : 0;
      }
    }
  }

  vtkNew<vtkImageToTetMeshFilter> mesher;
  mesher->SetInputData(image);
  mesher->SetDelta(2.0);        // edges of 2 to 4 mm on interfaces
  mesher->SetLabelSize(2, 1.5); // circumradii below 1.5 mm in the ball
  mesher->ComputeQualityOn();
  mesher->Update();
  if (!mesher->GetErrorMessage().empty()) // vtkErrorMacro has shown it
  {
    return EXIT_FAILURE;
  }

  const vtkMeshingStatistics* statistics = mesher->GetStatistics();
  std::cout << statistics->GetNumberOfElements() << " tetrahedra, worst radius-edge ratio "
            << statistics->GetMaximumRadiusEdgeRatio() << "\n";

  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  writer->SetInputConnection(mesher->GetOutputPort());
  writer->SetFileName(argv[1]);
  return writer->Write() == 1 ? EXIT_SUCCESS : EXIT_FAILURE;
}
