// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// What comes after a mesh, with one thread and with several. Python's tests try each property; this one is for sanitizers.
#include "PentatopeTesting.h"

#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkPentatopeMeshTimeSlice.h"
#include "vtkSimplexMeshQuality.h"
#include "vtkTable.h"

using namespace testing;

namespace
{

void TryQuality(vtkAlgorithm* mesh, vtkAlgorithm* image, int threads, vtkIdType labels)
{
  vtkNew<vtkSimplexMeshQuality> quality;
  quality->SetInputConnection(mesh->GetOutputPort());
  quality->SetImageConnection(image->GetOutputPort());
  quality->SetNumberOfThreads(threads);
  quality->SetNumberOfWorstElements(3);
  quality->SetDistances(true);
  quality->SetSmoothDistances(true);
  quality->Update();
  CHECK(quality->GetErrorMessage().empty(), quality->GetErrorMessage());
  CHECK(quality->GetLabelTable()->GetNumberOfRows() == labels, threads,
    quality->GetLabelTable()->GetNumberOfRows());
  CHECK(quality->GetNumberOfLostLabels() == 0, threads, quality->GetNumberOfLostLabels());
  CHECK(quality->GetHausdorffDistance() > 0.0 && quality->GetHausdorffDistance() < 3.0, threads,
    quality->GetHausdorffDistance());
}

void TrySlice(vtkAlgorithm* mesh, double time)
{
  vtkNew<vtkPentatopeMeshTimeSlice> slice;
  slice->SetInputConnection(mesh->GetOutputPort());
  slice->UpdateTimeStep(time);
  CHECK(slice->GetErrorMessage().empty(), slice->GetErrorMessage());
  CHECK(slice->GetOutput()->GetNumberOfCells() > 50, slice->GetOutput()->GetNumberOfCells());
}

} // namespace

int TestQualityAndSlices(int, char*[])
{
  const auto image = MakeTwoLabels(8.0);
  const auto tetrahedra = MakeFilter(image);
  const auto pentatopes = MakePentatopeFilter();
  for (const int threads : { 1, 4 })
  {
    TryQuality(tetrahedra, tetrahedra->GetInputAlgorithm(), threads, 2);
    TryQuality(pentatopes, pentatopes->GetInputAlgorithm(), threads, 2);
    TrySlice(pentatopes, 5.5);
  }
  return Result();
}
