// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// The filter in a pipeline: when it executes, pieces, reproducibility, PrintSelf.
#include "FilterTesting.h"

#include "vtkAlgorithmOutput.h"
#include "vtkCallbackCommand.h"
#include "vtkImageData.h"
#include "vtkMeshingStatistics.h"
#include "vtkNew.h"
#include "vtkPolyData.h"
#include "vtkSphere.h"
#include "vtkTrivialProducer.h"
#include "vtkUnstructuredGrid.h"

#include <cmath>
#include <sstream>

using namespace testing;

namespace
{

/** Same input, same parameters, one thread: the same bits. */
void TestReproducible()
{
  const auto a = MakeFilter(MakeTwoLabels());
  const auto b = MakeFilter(MakeTwoLabels());
  a->SetDelta(1.5);
  b->SetDelta(1.5);
  a->Update();
  b->Update();
  CHECK(a->GetOutput()->GetNumberOfCells() > 0);
  CHECK(SameMesh(a->GetOutput(), b->GetOutput()));
  CHECK(SameMesh(a->GetInterfaces(), b->GetInterfaces()));

  vtkNew<vtkUnstructuredGrid> before;
  before->DeepCopy(a->GetOutput());
  a->Modified();
  a->Update();
  CHECK(SameMesh(a->GetOutput(), before));
}

/** The default is known before the filter executes, and it is what 0 means. */
void TestDefaultDelta()
{
  Placement skewed;
  skewed.Spacing = { 0.5, 2.0, 1.0 };
  skewed.Direction = { 1, 0.5, 0, 0, 0.5, 0, 0, 0, -1 }; // of determinant -0.5
  const auto image = MakeImage(skewed, [](const Vector&) { return 1.0; });
  const auto filter = MakeFilter(image);
  CHECK(filter->GetDefaultDelta() == 0.0);
  filter->UpdateInformation();
  const double expected = 2.0 * std::cbrt(0.5);
  CHECK(std::abs(filter->GetDefaultDelta() - expected) < 1e-12, filter->GetDefaultDelta());
  CHECK(filter->GetStatistics()->GetDelta() == 0.0);
  filter->Update();
  CHECK(std::abs(filter->GetStatistics()->GetDelta() - expected) < 1e-12);

  image->SetSpacing(1.0, 1.0, 1.0);
  image->SetDirectionMatrix(1, 0, 0, 0, 1, 0, 0, 0, 1);
  filter->UpdateInformation();
  CHECK(filter->GetDefaultDelta() == 2.0, filter->GetDefaultDelta());
  image->SetSpacing(0.0, 1.0, 1.0); // an error when it executes
  filter->UpdateInformation();
  CHECK(filter->GetDefaultDelta() == 0.0);
}

/** Of single numbers: Parameters.Filters. */
void TestExecutions()
{
  const auto image = MakeTwoLabels(6.0);
  const auto filter = MakeFilter(image);
  int executions = 0;
  vtkNew<vtkCallbackCommand> counter;
  counter->SetClientData(&executions);
  counter->SetCallback(
    [](vtkObject*, unsigned long, void* data, void*) { ++*static_cast<int*>(data); });
  filter->AddObserver(vtkCommand::StartEvent, counter);

  filter->Update();
  CHECK(executions == 1, executions);
  filter->Update();
  filter->GetInterfacesPort();
  CHECK(executions == 1, executions);

  const auto expectExecution = [&](const char* name, const std::function<void()>& change)
  {
    executions = 0;
    change();
    filter->Update();
    CHECK(executions == 1, name, executions);
    filter->Update();
    CHECK(executions == 1, name, executions);
  };
  vtkNew<vtkSphere> sphere;
  sphere->SetRadius(1.0);
  sphere->SetCenter(-50, 0, 0);
  expectExecution("Delta", [&] { filter->SetDelta(2.5); });
  expectExecution("LabelSize", [&] { filter->SetLabelSize(1, 4.0); });
  expectExecution("LabelSize again", [&] { filter->SetLabelSize(1, 4.5); });
  expectExecution("RemoveLabelSize", [&] { filter->RemoveLabelSize(1); });
  expectExecution("ExcludeLabel", [&] { filter->ExcludeLabel(2); });
  expectExecution("RemoveExcludedLabel", [&] { filter->RemoveExcludedLabel(2); });
  expectExecution("SetLabelRow", [&] { filter->SetLabelRow(1, 4.0, true); });
  expectExecution("ClearLabelRows", [&] { filter->ClearLabelRows(); });
  expectExecution("AddLabel", [&] { filter->AddLabel(1); });
  expectExecution("RemoveAllLabels", [&] { filter->RemoveAllLabels(); });
  expectExecution("SizeImplicitFunction", [&] { filter->SetSizeImplicitFunction(sphere); });
  expectExecution("the function itself", [&] { sphere->SetRadius(2.0); });
  expectExecution("SizeFunction",
    [&] { filter->SetSizeFunction([](const double[3], vtkTypeInt64) { return 5.0; }); });
  expectExecution("ElementSizeData",
    [&] { filter->SetElementSizeData(MakeImage({}, [](const Vector&) { return 6.0; })); });
  expectExecution("ComputeQuality", [&] { filter->ComputeQualityOn(); });
  expectExecution("the image", [&] { image->Modified(); });

  executions = 0;
  filter->SetDelta(2.5);
  filter->SetLabelSize(7, 1.0);
  filter->RemoveLabelSize(7);
  filter->RemoveLabel(99);
  sphere->Modified();
  filter->SetSizeImplicitFunction(nullptr);
  sphere->Modified(); // no longer ours
  filter->Update();
  CHECK(executions == 1, executions);
}

/** Piece 0 is everything, other pieces are empty; their union is the mesh, once. */
void TestPieces()
{
  const auto filter = MakeFilter(MakeBall(6.0));
  filter->UpdatePiece(0, 2, 0);
  CHECK(filter->GetOutput()->GetNumberOfCells() > 0);
  CHECK(filter->GetInterfaces()->GetNumberOfCells() > 0);
  filter->UpdatePiece(1, 2, 0);
  CHECK(Empty(filter));
  CHECK(filter->GetErrorMessage().empty());
  filter->Update(1); // the other port asks for everything
  CHECK(filter->GetInterfaces()->GetNumberOfCells() > 0);
  CheckMesh(filter);
  filter->UpdatePiece(0, 1, 0);
  CheckMesh(filter);
}

/** Both outputs through one update of a pipeline with connections. */
void TestConnections()
{
  vtkNew<vtkTrivialProducer> producer;
  const auto image = MakeTwoLabels(6.0);
  producer->SetOutput(image);
  producer->SetWholeExtent(image->GetExtent());
  vtkNew<vtkTrivialProducer> sizes;
  const auto sizeImage = MakeImage(
    {}, [](const Vector&) { return 1.5; }, VTK_FLOAT);
  sizes->SetOutput(sizeImage);
  sizes->SetWholeExtent(sizeImage->GetExtent());
  vtkNew<vtkImageToTetMeshFilter> filter;
  filter->SetInputConnection(producer->GetOutputPort());
  filter->Update();
  CheckMesh(filter);
  const vtkIdType coarse = filter->GetOutput()->GetNumberOfCells();
  filter->SetElementSizeConnection(sizes->GetOutputPort());
  filter->Update();
  CheckMesh(filter);
  CHECK(filter->GetOutput()->GetNumberOfCells() > coarse);
  CHECK(filter->GetInterfacesPort()->GetIndex() == 1);
}

void TestPrintSelf()
{
  const auto filter = MakeFilter(MakeBall(6.0));
  vtkNew<vtkSphere> sphere;
  std::ostringstream before;
  filter->Print(before);
  CHECK(before.str().find("LabelSizes: (none)") != std::string::npos);
  CHECK(before.str().find("SelectedLabels: (all)") != std::string::npos);
  filter->SetLabelSize(1, 3.5);
  filter->AddLabel(1);
  filter->SetSizeImplicitFunction(sphere);
  filter->Update();
  std::ostringstream text;
  filter->Print(text);
  for (const char* line :
    { "LabelSizes: 1=3.5", "SelectedLabels: 1", "SizeImplicitFunction:", "SizeFunction: (none)",
      "ComputeQuality: Off", "ErrorMessage: (none)", "Aborted: No", "Statistics:",
      "NumberOfElements:" })
  {
    CHECK(text.str().find(line) != std::string::npos, line);
  }
}

} // namespace

int TestTetMeshPipeline(int, char*[])
{
  TestReproducible();
  TestDefaultDelta();
  TestExecutions();
  TestPieces();
  TestConnections();
  TestPrintSelf();
  return Result();
}
