// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
//
// An ITK pipeline feeds the meshing filter: a CT image is thresholded, its connected components become
// labels, the largest first, and these are meshed where the image lies, its direction matrix included.
// Usage: MeshITKImage IMAGE THRESHOLD DELTA OUTPUT.vtu

#include "itkBinaryThresholdImageFilter.h"
#include "itkConnectedComponentImageFilter.h"
#include "itkImage.h"
#include "itkImageFileReader.h"
#include "itkRelabelComponentImageFilter.h"
#include "itkVTKImageExport.h"

#include "vtkImageImport.h"
#include "vtkImageToTetMeshFilter.h"
#include "vtkNew.h"
#include "vtkUnstructuredGrid.h"
#include "vtkXMLUnstructuredGridWriter.h"

#include <cstdlib>
#include <iostream>
#include <limits>

using GreyImage = itk::Image<short, 3>;
using LabelImage = itk::Image<unsigned short, 3>;

/**
 * Lets VTK's pipeline ask ITK's for images, direction matrix included. Voxels are not copied: the
 * exporter must live for as long as the importer's output is used. itk::ImageToVTKImageFilter does the
 * same; it belongs to the ITK module ITKVtkGlue, which Debian's ITK comes without.
 */
template <typename Image>
void Connect(itk::VTKImageExport<Image>* exporter, vtkImageImport* importer)
{
  importer->SetUpdateInformationCallback(exporter->GetUpdateInformationCallback());
  importer->SetPipelineModifiedCallback(exporter->GetPipelineModifiedCallback());
  importer->SetWholeExtentCallback(exporter->GetWholeExtentCallback());
  importer->SetSpacingCallback(exporter->GetSpacingCallback());
  importer->SetOriginCallback(exporter->GetOriginCallback());
  importer->SetDirectionCallback(exporter->GetDirectionCallback());
  importer->SetScalarTypeCallback(exporter->GetScalarTypeCallback());
  importer->SetNumberOfComponentsCallback(exporter->GetNumberOfComponentsCallback());
  importer->SetPropagateUpdateExtentCallback(exporter->GetPropagateUpdateExtentCallback());
  importer->SetUpdateDataCallback(exporter->GetUpdateDataCallback());
  importer->SetDataExtentCallback(exporter->GetDataExtentCallback());
  importer->SetBufferPointerCallback(exporter->GetBufferPointerCallback());
  importer->SetCallbackUserData(exporter->GetCallbackUserData());
}

int Run(const char* input, short threshold, double delta, const char* output)
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

  const auto exporter = itk::VTKImageExport<LabelImage>::New();
  exporter->SetInput(labels->GetOutput());
  vtkNew<vtkImageImport> importer;
  Connect(exporter.GetPointer(), importer);

  vtkNew<vtkImageToTetMeshFilter> mesher;
  mesher->SetInputConnection(importer->GetOutputPort());
  mesher->SetDelta(delta);
  mesher->Update();
  if (!mesher->GetErrorMessage().empty()) // vtkErrorMacro has shown it
  {
    return EXIT_FAILURE;
  }
  std::cout << labels->GetNumberOfObjects() << " components, "
            << mesher->GetOutput()->GetNumberOfCells() << " tetrahedra\n";

  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  writer->SetInputConnection(mesher->GetOutputPort());
  writer->SetFileName(output);
  return writer->Write() == 1 ? EXIT_SUCCESS : EXIT_FAILURE;
}

int main(int argc, char* argv[])
{
  if (argc != 5)
  {
    std::cerr << "Usage: " << argv[0] << " IMAGE THRESHOLD DELTA OUTPUT.vtu\n";
    return EXIT_FAILURE;
  }
  try
  {
    return Run(argv[1], static_cast<short>(std::atoi(argv[2])), std::atof(argv[3]), argv[4]);
  }
  catch (const itk::ExceptionObject& error) // from ITK's pipeline, through VTK's
  {
    std::cerr << argv[0] << ": " << error.GetDescription() << "\n";
    return EXIT_FAILURE;
  }
}
