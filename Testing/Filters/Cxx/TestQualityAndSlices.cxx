// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// What comes after a mesh, with one thread and with several, and each class without what it needs, and aborted. Python's
// tests try each property; this one is for sanitizers.
#include "PentatopeTesting.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkExecutive.h"
#include "vtkIdList.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkPentatopeMeshTimeSlice.h"
#include "vtkSegmentationRepair.h"
#include "vtkSimplexMeshInterfaces.h"
#include "vtkSimplexMeshQuality.h"
#include "vtkTable.h"

#include <sstream>
#include <string>
#include <utility>

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

/** The interfaces of a mesh, one element of which is turned round, are as many as its filter's. */
void TryInterfaces(vtkImageToSimplexMeshFilter* mesh, int port)
{
  mesh->Update();
  vtkNew<vtkUnstructuredGrid> grid;
  grid->DeepCopy(mesh->GetOutput());
  vtkNew<vtkIdList> element;
  grid->GetCellPoints(0, element);
  std::swap(*element->GetPointer(0), *element->GetPointer(1));
  grid->GetCells()->ReplaceCellAtId(0, element);
  vtkNew<vtkSimplexMeshInterfaces> interfaces;
  interfaces->SetInputData(grid);
  interfaces->Update();
  CHECK(interfaces->GetErrorMessage().empty(), interfaces->GetErrorMessage());
  CHECK(interfaces->GetNumberOfTurnedElements() == 1, interfaces->GetNumberOfTurnedElements());
  CHECK(interfaces->GetOutput()->GetNumberOfCells() == grid->GetNumberOfCells());
  CHECK(interfaces->GetOutputDataObject(port)->GetNumberOfElements(vtkDataObject::CELL) ==
    mesh->GetOutputDataObject(1)->GetNumberOfElements(vtkDataObject::CELL));
}

/** Without what it needs, a filter says so, makes nothing, and prints itself. */
template <typename Filter>
void TryMistake(Filter* filter, vtkDataObject* input, const char* word)
{
  filter->SetInputDataObject(input);
  const auto errors = vtkSmartPointer<ErrorCollector>::Take(ErrorCollector::New());
  errors->Watch(filter);
  CHECK(filter->GetExecutive()->Update() == 0, word);
  CHECK(filter->GetErrorMessage().find(word) != std::string::npos, filter->GetErrorMessage());
  CHECK(errors->FromFilter.size() == 1, word, errors->FromFilter.size());
  CHECK(filter->GetOutputDataObject(0)->GetNumberOfElements(vtkDataObject::POINT) == 0, word);
  std::ostringstream text;
  filter->Print(text);
}

/** Stopped by its first progress event, a filter of several threads makes nothing. */
void TryAbort(vtkAlgorithm* filter)
{
  int events = 0;
  const auto stop = Observe(filter,
    [&](vtkAlgorithm* caller, double)
    {
      caller->SetAbortExecute(1);
      ++events;
    });
  filter->UpdateTimeStep(5.5); // where a slice is not empty
  const auto size = filter->GetOutputDataObject(0)->GetNumberOfElements(vtkDataObject::POINT);
  CHECK(events > 0 && size == 0, filter->GetClassName(), size);
}

} // namespace

int TestQualityAndSlices(int, char*[])
{
  const auto image = MakeTwoLabels(8.0);
  const auto tetrahedra = MakeFilter(image);
  const auto pentatopes = MakePentatopeFilter();
  TryInterfaces(tetrahedra, 1);
  TryInterfaces(pentatopes, 2);

  vtkNew<vtkUnstructuredGrid> bare;
  bare->CopyStructure(tetrahedra->GetOutput());
  TryMistake(vtkNew<vtkSimplexMeshInterfaces>().Get(), bare, "Label");
  TryMistake(vtkNew<vtkSimplexMeshQuality>().Get(), bare, "Label");
  TryMistake(vtkNew<vtkPentatopeMeshTimeSlice>().Get(), bare, "Time");
  vtkNew<vtkImageData> noLabels;
  noLabels->SetDimensions(3, 3, 3);
  vtkNew<vtkSegmentationRepair> repair;
  repair->SetMinimumThickness(1, 3.0);
  repair->SetNumberOfThreads(4);
  TryMistake(repair.Get(), noLabels, "scalars");
  repair->SetInputData(image);
  TryAbort(repair);

  vtkNew<vtkSimplexMeshQuality> quality;
  quality->SetInputConnection(tetrahedra->GetOutputPort());
  quality->SetNumberOfThreads(4);
  TryAbort(quality);
  vtkNew<vtkPentatopeMeshTimeSlice> slice;
  slice->SetInputConnection(pentatopes->GetOutputPort());
  TryAbort(slice);

  for (const int threads : { 1, 4 })
  {
    TryQuality(tetrahedra, tetrahedra->GetInputAlgorithm(), threads, 2);
    TryQuality(pentatopes, pentatopes->GetInputAlgorithm(), threads, 2);
    TrySlice(pentatopes, 5.5);
  }
  return Result();
}
