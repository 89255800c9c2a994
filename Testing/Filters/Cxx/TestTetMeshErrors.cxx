// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Misuse: a clear message through ErrorEvent, empty outputs, and the filter goes on working.
#include "FilterTesting.h"

#include "vtkAlgorithm.h"
#include "vtkDoubleArray.h"
#include "vtkImageData.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkStringArray.h"
#include "vtkUnsignedCharArray.h"

#include <cmath>
#include <stdexcept>

using namespace testing;

namespace
{

/** An image that is bad in itself. */
void ExpectImageError(const char* name, vtkImageData* image, const std::vector<std::string>& words)
{
  const auto filter = MakeFilter(image);
  const auto good = MakeBall(5.0);
  ExpectError(name, filter, words, [&] { filter->SetInputData(good); });
}

vtkSmartPointer<vtkImageData> WithScalar(double bad)
{
  const auto image = MakeBall(8.0);
  image->GetPointData()->GetScalars()->SetTuple1(16 + 32 * (16 + 32 * 16), bad);
  return image;
}

void TestScalars()
{
  const auto none = MakeBall();
  none->GetPointData()->Initialize();
  ExpectImageError("no scalars", none, { "array", "SetInputArrayToProcess" });

  vtkNew<vtkImageData> empty;
  ExpectImageError("empty image", empty, {});

  const auto text = MakeBall();
  vtkNew<vtkStringArray> strings;
  strings->SetName("Text");
  strings->SetNumberOfValues(text->GetNumberOfPoints());
  text->GetPointData()->AddArray(strings);
  const auto named = MakeFilter(text);
  named->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "Text");
  ExpectError("strings", named, { "Text", "numbers" });
  named->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "Missing");
  ExpectError("missing array", named, { "SetInputArrayToProcess" });

  const auto several = MakeBall();
  vtkNew<vtkUnsignedCharArray> frames;
  frames->SetName("Frames");
  frames->SetNumberOfComponents(3);
  frames->SetNumberOfTuples(several->GetNumberOfPoints());
  frames->Fill(1);
  several->GetPointData()->SetScalars(frames);
  ExpectImageError(
    "components", several, { "Frames", "3 components", "vtkImageToPentatopeMeshFilter" });

  ExpectImageError("fraction", WithScalar(1.5), { "1.5", "whole", "(16, 16, 16)" });
  ExpectImageError(
    "negative", WithScalar(-3), { "-3", "negative", "isosurface", "choose the labels" });
  ExpectImageError("NaN", WithScalar(vtkMath::Nan()), { "finite", "set such voxels to 0" });
  ExpectImageError("infinite", WithScalar(vtkMath::Inf()), { "finite" });

  const auto grey = MakeBall();
  for (vtkIdType i = 0; i < grey->GetNumberOfPoints(); ++i)
  {
    grey->GetPointData()->GetScalars()->SetTuple1(i, static_cast<double>(i % 5000));
  }
  ExpectImageError("grey values", grey, { "grey-value", "labels" });
  const auto chosen = MakeFilter(grey); // and only the chosen label counts
  chosen->AddLabel(4000);
  chosen->SetSmallestComponent(1);
  chosen->Update();
  CHECK(!Empty(chosen), chosen->GetErrorMessage());

  const auto ghostly = MakeBall();
  vtkNew<vtkUnsignedCharArray> ghosts;
  ghosts->SetName("vtkGhostType");
  ghosts->SetNumberOfTuples(ghostly->GetNumberOfPoints() - 1);
  ghosts->Fill(0);
  ghostly->GetPointData()->AddArray(ghosts);
  ExpectImageError("ghosts", ghostly, { "vtkGhostType", "32767", "32768" });

  ExpectImageError("no foreground", MakeBall(-1.0), { "foreground" });

  Placement slice;
  slice.Extent = { 0, 31, 0, 31, 7, 7 };
  const auto one = [](const Vector&) { return 1.0; };
  ExpectImageError("one slice", MakeImage(slice, one), { "1 voxel" });
  slice.Extent = { 3, 3, 0, 0, 7, 7 };
  ExpectImageError("one voxel", MakeImage(slice, one), { "1 voxel" });
}

void TestGeometry()
{
  for (const double bad : { 0.0, -1.0, vtkMath::Nan(), vtkMath::Inf() })
  {
    const auto image = MakeBall();
    image->SetSpacing(1.0, bad, 1.0);
    ExpectImageError("spacing", image, { "spacing", "positive" });
  }
  const auto far = MakeBall();
  far->SetOrigin(0, vtkMath::Nan(), 0);
  ExpectImageError("origin", far, { "origin", "finite" });

  const auto flat = MakeBall();
  const double coincide[9] = { 1, 1, 0, 0, 0, 0, 0, 0, 1 };
  flat->SetDirectionMatrix(coincide);
  ExpectImageError("coinciding axes", flat, { "direction", "singular" });
  const double planar[9] = { 1, 0, 1, 0, 1, 1, 0, 0, 0 };
  flat->SetDirectionMatrix(planar);
  ExpectImageError("axes in a plane", flat, { "direction", "singular" });
  const double zero[9] = {};
  flat->SetDirectionMatrix(zero);
  ExpectImageError("zero direction", flat, { "direction", "singular" });
  const double nan[9] = { vtkMath::Nan(), 0, 0, 0, 1, 0, 0, 0, 1 };
  flat->SetDirectionMatrix(nan);
  ExpectImageError("NaN direction", flat, { "direction", "finite" });
}

/** Numbers out of range: Parameters.Filters. */
void TestParameters()
{
  const auto filter = MakeFilter(MakeTwoLabels(6.0));
  for (const double bad : { 0.0, -1.0, vtkMath::Nan(), vtkMath::Inf() })
  {
    filter->SetLabelSize(2, bad);
    ExpectError("label size", filter, { "label 2" }, [&] { filter->ClearLabelSizes(); });
  }
  filter->SetRadiusEdgeRatio(1.8);
  ExpectError("unproved ratio", filter, { "1.93", "Force" }, [&] { filter->ForceOn(); });
  filter->SetRadiusEdgeRatio(2.0);
  filter->ForceOff();
  filter->SetLabelSize(9, 1.0);
  ExpectError("unknown label", filter, { "label 9", "1, 2" }, [&] { filter->ClearLabelSizes(); });
  filter->AddLabel(1);
  filter->SetLabelSize(2, 1.0);
  ExpectError("label not selected", filter, { "label 2", "1" }, [&] { filter->ClearLabelSizes(); });
  filter->AddLabel(77);
  ExpectError("unknown selection", filter, { "77", "1, 2" }, [&] { filter->RemoveLabel(77); });
  filter->RemoveAllLabels();
  filter->ExcludeLabel(78);
  ExpectError(
    "unknown exclusion", filter, { "78", "1, 2" }, [&] { filter->RemoveExcludedLabel(78); });
  filter->ExcludeLabel(1);
  filter->SetLabelSize(1, 1.0);
  ExpectError("excluded label", filter, { "label 1", "2" }, [&] { filter->ClearLabelSizes(); });
  filter->SetInterfaceSize(2, 1, 1.0);
  ExpectError("excluded interface", filter, { "SetInterfaceSize()", "label 1", "2" },
    [&] { filter->ClearInterfaceSizes(); });
  filter->ExcludeLabel(2);
  ExpectError(
    "nothing left", filter, { "All labels", "excluded" }, [&] { filter->RemoveExcludedLabel(2); });
}

void TestInterfacesAndNumbers()
{
  const auto filter = MakeFilter(MakeBall(8.0));
  for (const double wrong : { 0.0, -1.0, vtkMath::Inf(), vtkMath::Nan() })
  {
    filter->SetInterfaceSize(1, 0, wrong);
    ExpectError("interface size", filter, { "labels 1 and 0", "positive and finite" },
      [&] { filter->RemoveInterfaceSize(0, 1); });
  }
  filter->SetInterfaceSize(1, vtkImageToTetMeshFilter::ANY_LABEL, -1.0);
  ExpectError("interfaces of a label", filter, { "all interfaces of label 1" },
    [&] { filter->ClearInterfaceSizes(); });
  filter->SetInterfaceSize(9, 0, 1.0);
  ExpectError("unknown interface", filter, { "SetInterfaceSize()", "label 9" },
    [&] { filter->ClearInterfaceSizes(); });
  for (const int label : { 1, -2 })
  {
    filter->SetInterfaceSize(1, label, 1.0);
    ExpectError("no interface", filter, { "two different labels", "1 and" },
      [&] { filter->ClearInterfaceSizes(); });
  }
  filter->SetDelta(2.0);
  filter->SetNumberOfElements(5000);
  ExpectError("both", filter, { "Delta", "NumberOfElements" }, [&] { filter->SetDelta(0.0); });
  filter->SetElementSize(0.8);
  ExpectError("out of reach", filter, { "no delta makes a mesh of 5000 elements", "nearest" },
    [&] { filter->SetElementSize(0.0); });
}

void TestMemory()
{
  const auto filter = MakeFilter(MakeBall());
  filter->SetDelta(1e-4);
  ExpectError("tiny delta", filter, { "memory" }, [&] { filter->SetDelta(2.0); });
  filter->SetMemoryLimit(1000);
  filter->Modified();
  ExpectError("tiny limit", filter, { "memory" }, [&] { filter->ForceOn(); });
}

void TestSizeImage()
{
  const auto filter = MakeFilter(MakeBall(6.0));
  const auto sizes = MakeImage(
    {}, [](const Vector&) { return 2.0; }, VTK_DOUBLE);
  sizes->SetSpacing(1, 1, 0);
  filter->SetElementSizeData(sizes);
  ExpectError("size image spacing", filter, { "image of element sizes", "spacing" },
    [&] { sizes->SetSpacing(1, 1, 1); });
  vtkNew<vtkDoubleArray> pairs;
  pairs->SetNumberOfComponents(2);
  pairs->SetNumberOfTuples(sizes->GetNumberOfPoints());
  pairs->Fill(1.0);
  sizes->GetPointData()->SetScalars(pairs);
  ExpectError("size image components", filter, { "image of element sizes", "2 components" },
    [&] { filter->SetElementSizeData(nullptr); });
  vtkNew<vtkImageData> bare;
  bare->SetDimensions(2, 2, 2);
  filter->SetElementSizeData(bare);
  ExpectError("size image without scalars", filter, { "image of element sizes" },
    [&] { filter->SetElementSizeData(nullptr); });
}

void TestThrowingFunction()
{
  for (const int threads : { 1, 2, 8 })
  {
    const auto filter = MakeFilter(MakeBall());
    filter->SetNumberOfThreads(threads);
    filter->SetSizeFunction([](const double[3], vtkTypeInt64) -> double
      { throw std::runtime_error("the user's own words"); });
    ExpectError(
      "exception", filter, { "the user's own words" }, [&] { filter->SetSizeFunction(nullptr); });
    filter->SetSizeFunction([](const double[3], vtkTypeInt64) -> double { throw 42; });
    ExpectError(
      "odd exception", filter, { "size function" }, [&] { filter->SetSizeFunction(nullptr); });
  }
}

/** No input at all is the executive's error, not the filter's. */
void TestNoInput()
{
  vtkNew<vtkImageToTetMeshFilter> filter;
  const auto errors = vtkSmartPointer<ErrorCollector>::Take(ErrorCollector::New());
  errors->Watch(filter);
  filter->Update();
  CHECK(!errors->FromOthers.empty());
  CHECK(Empty(filter));
}

} // namespace

int TestTetMeshErrors(int, char*[])
{
  TestScalars();
  TestGeometry();
  TestParameters();
  TestInterfacesAndNumbers();
  TestMemory();
  TestSizeImage();
  TestThrowingFunction();
  TestNoInput();
  return Result();
}
