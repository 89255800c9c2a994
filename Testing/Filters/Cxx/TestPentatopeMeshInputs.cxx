// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// What a space-time mesh is made from: time steps or components, points or cells, scalar types,
// selected labels, element sizes.
#include "PentatopeTesting.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkMeshingStatistics.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkSOADataArrayTemplate.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkTrivialProducer.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <set>

using namespace testing;

namespace
{

const Event Centre = { 5.5, 5.5, 5.5, 5.5 };

vtkSmartPointer<vtkImageToPentatopeMeshFilter> FromImage(vtkImageData* image)
{
  vtkNew<vtkTrivialProducer> producer;
  producer->SetOutput(image);
  return MakePentatopeFilter(producer);
}

/** Same labels, same mesh, in both ways to hand over frames. */
void TestBothKinds()
{
  for (const bool cells : { false, true })
  {
    Placement placement = SmallPlacement();
    placement.Cells = cells;
    placement.Origin = { 1, -2, 3 };
    const auto label = TwoLabelBall({ 6.5, 3.5, 8.5, 6.0 }, 4.2);
    std::vector<double> times;
    for (int k = 0; k < 9; ++k)
    {
      times.push_back(2.5 + 0.75 * k);
    }
    const auto series = MakePentatopeFilter(MakeSeries(placement, times, label));
    series->Update();
    CheckMesh(series);
    const auto components = FromImage(MakeComponents(placement, times, label));
    components->SetTimeOrigin(2.5);
    components->SetTimeSpacing(0.75);
    components->Update();
    CHECK(SameMesh(series, components), cells);
  }
}

/**
 * Frames 0, 1, 2, 4, 7 of a ball that does not move, as time steps and as components: the mesh is that
 * of all eight frames. And times that no frames of equal distances have.
 */
void TestUnequalTimes()
{
  const auto still = [](const Vector& x, double) { return TwoLabelBall(Centre, 4.2)(x, 5.0); };
  std::vector<double> whole;
  for (int k = 0; k < 8; ++k)
  {
    whole.push_back(10.0 + k);
  }
  const std::vector<double> some = { 10, 11, 12, 14, 17 };
  const auto expected = MakePentatopeFilter(MakeSeries(SmallPlacement(), whole, still));
  expected->Update();
  CheckMesh(expected);
  const auto series = MakePentatopeFilter(MakeSeries(SmallPlacement(), some, still));
  series->Update();
  CHECK(SameMesh(expected, series));

  const auto components = FromImage(MakeComponents(SmallPlacement(), some, still));
  for (const double time : some)
  {
    components->AddFrameTime(time);
  }
  CHECK(components->GetNumberOfFrameTimes() == 5);
  CHECK(components->GetFrameTime(3) == 14.0);
  CHECK(std::isnan(components->GetFrameTime(5)) && std::isnan(components->GetFrameTime(-1)));
  components->UpdateInformation();
  const double* const range =
    components->GetOutputInformation(0)->Get(vtkStreamingDemandDrivenPipeline::TIME_RANGE());
  CHECK(range && range[0] == 10.0 && range[1] == 17.0);
  components->Update();
  CHECK(SameMesh(expected, components));

  // In place of the times of the pipeline.
  const auto replaced = MakePentatopeFilter(MakeSeries(SmallPlacement(), EqualTimes(5), still));
  for (const double time : some)
  {
    replaced->AddFrameTime(time);
  }
  replaced->Update();
  CHECK(SameMesh(expected, replaced));

  const auto odd =
    MakePentatopeFilter(MakeSeries(SmallPlacement(), { 0.1, 1.0, 2.37, 4.01, 6.6 }, still));
  odd->Update();
  CheckMesh(odd);
  double times[2];
  odd->GetOutput()->GetPointData()->GetArray("Time")->GetRange(times);
  CHECK(times[0] == 0.1 && times[1] == 6.6);
}

/** Two of several arrays, by name. */
void TestChosenArray()
{
  const auto times = EqualTimes(12);
  const auto image = MakeComponents(SmallPlacement(), times, TwoLabelBall(Centre, 4.2));
  const auto other = MakeComponents(SmallPlacement(), times, TwoLabelBall(Centre, 3.0));
  vtkDataArray* array = other->GetPointData()->GetScalars();
  array->SetName("Other");
  image->GetPointData()->AddArray(array);
  const auto chosen = FromImage(image);
  chosen->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "Other");
  chosen->Update();
  const auto expected = FromImage(other);
  expected->Update();
  CheckMesh(chosen);
  CHECK(SameMesh(chosen, expected));
}

/** Labels of 8, 16 and 64 bits, in frames that come in any order; the scalars' type is no matter. */
void TestTypes()
{
  const auto times = EqualTimes(12);
  const auto reference = MakePentatopeFilter();
  reference->Update();
  for (const int type : { VTK_CHAR, VTK_SIGNED_CHAR, VTK_UNSIGNED_SHORT, VTK_INT, VTK_LONG,
         VTK_UNSIGNED_LONG_LONG, VTK_FLOAT, VTK_DOUBLE, VTK_ID_TYPE })
  {
    const auto label = TwoLabelBall(Centre, 4.2);
    const auto series = MakePentatopeFilter(MakeSeries(SmallPlacement(), times, label, type));
    series->Update();
    CHECK(SameMesh(reference, series), type);
    const auto components = FromImage(MakeComponents(SmallPlacement(), times, label, type));
    components->Update();
    CHECK(SameMesh(reference, components), type);
  }

  // Other values in the same places: the same mesh with other labels, which need more bits from
  // some frame on.
  struct Case
  {
    double Left, Right;
    int ArrayType;
  };
  for (const Case& c : { Case{ 3, 300, VTK_INT }, Case{ 255, 256, VTK_INT },
         Case{ 65535, 65536, VTK_INT }, Case{ 3, 1e12, VTK_LONG_LONG } })
  {
    for (const bool late : { false, true })
    {
      const auto label = [&](const Vector& x, double t)
      {
        const double value = TwoLabelBall(Centre, 4.2)(x, t);
        const bool isRight = late ? t > 6.0 : x[0] >= Centre[0];
        return value == 0.0 ? 0.0 : isRight ? c.Right : c.Left;
      };
      const auto filter =
        MakePentatopeFilter(MakeSeries(SmallPlacement(), times, label, VTK_DOUBLE));
      filter->Update();
      CheckMesh(filter);
      vtkDataArray* labels = filter->GetOutput()->GetCellData()->GetArray("Label");
      CHECK(labels->GetDataType() == c.ArrayType, c.Right);
      std::set<double> found;
      for (vtkIdType i = 0; i < labels->GetNumberOfTuples(); ++i)
      {
        found.insert(labels->GetComponent(i, 0));
      }
      CHECK(found == std::set<double>({ c.Left, c.Right }), c.Left, c.Right, late);
    }
  }
}

/** Scalars that are not contiguous in memory. */
void TestLayouts()
{
  const auto image = MakeComponents(SmallPlacement(), EqualTimes(12), TwoLabelBall(Centre, 4.2));
  vtkDataArray* scalars = image->GetPointData()->GetScalars();
  const auto expected = MakePentatopeFilter();
  expected->Update();
  vtkNew<vtkSOADataArrayTemplate<int>> apart;
  apart->SetNumberOfComponents(scalars->GetNumberOfComponents());
  apart->SetNumberOfTuples(scalars->GetNumberOfTuples());
  for (int k = 0; k < scalars->GetNumberOfComponents(); ++k)
  {
    apart->CopyComponent(k, scalars, k);
  }
  image->GetPointData()->SetScalars(apart);
  const auto filter = FromImage(image);
  filter->Update();
  CHECK(SameMesh(filter, expected));
}

void TestSelectedLabels()
{
  const auto both = MakePentatopeFilter();
  both->Update();
  const auto filter = MakePentatopeFilter();
  filter->AddLabel(7);
  filter->Update();
  CheckMesh(filter);
  const Pentatopes mesh = ReadPentatopes(filter->GetOutput());
  CHECK(std::count(mesh.Labels.begin(), mesh.Labels.end(), 7) ==
    static_cast<std::ptrdiff_t>(mesh.Labels.size()));
  CHECK(mesh.VolumeOf() < 0.8 * ReadPentatopes(both->GetOutput()).VolumeOf());
  filter->RemoveAllLabels();
  filter->Update();
  CHECK(SameMesh(filter, both));
}

/** Largest circumradius bound: every way to give a size makes more elements. */
void TestSizes()
{
  const auto filter = MakePentatopeFilter();
  filter->SetDelta(3.0);
  filter->Update();
  const vtkIdType without = filter->GetOutput()->GetNumberOfCells();
  const auto expectMore = [&](const char* name)
  {
    filter->Update();
    CheckMesh(filter);
    const vtkIdType cells = filter->GetOutput()->GetNumberOfCells();
    CHECK(cells > 1.3 * static_cast<double>(without), name, cells, without);
    return cells;
  };
  filter->SetElementSize(1.8);
  const vtkIdType uniform = expectMore("a number");
  filter->SetElementSize(0.0);

  filter->SetLabelSize(7, 1.8);
  const vtkIdType oneLabel = expectMore("a label");
  CHECK(oneLabel < uniform, oneLabel, uniform);
  filter->ClearLabelSizes();

  const auto sizes = MakeImage(
    SmallPlacement(), [](const Vector&) { return 1.8; }, VTK_FLOAT);
  filter->SetElementSizeData(sizes);
  CHECK(expectMore("an image") == uniform); // it applies at all times
  filter->SetElementSizeData(nullptr);

  filter->SetSizeFunction([](const double*, vtkTypeInt64) { return 1.8; });
  CHECK(expectMore("a function") == uniform);
  filter->SetSizeFunction(nullptr);
  filter->Update();
  CHECK(filter->GetOutput()->GetNumberOfCells() == without);
}

/** The function gets physical coordinates, the time in the input's unit, and the label there. */
void TestSizeFunctionArguments()
{
  Placement placement = SmallPlacement();
  placement.Origin = { 100, 200, 300 };
  placement.Direction = { 0, -1, 0, 1, 0, 0, 0, 0, 1 };
  // Voxel (i, j, k) lies at (100 - j, 200 + i, 300 + k), frame l at 40 + 0.5 l.
  const Event centre = { 94.5, 205.5, 305.5, 42.75 };
  std::vector<double> times;
  for (int k = 0; k < 12; ++k)
  {
    times.push_back(40.0 + 0.5 * k);
  }
  const auto label = [&](const Vector& x, double t)
  {
    const Vector scaled = { 5.5 + x[0] - centre[0], 5.5 + x[1] - centre[1],
      5.5 + x[2] - centre[2] };
    return TwoLabelBall(Centre, 4.2)(scaled, 5.5 + 2.0 * (t - centre[3]));
  };
  const auto filter = MakePentatopeFilter(MakeSeries(placement, times, label));
  filter->SetTimeScale(2.0);
  filter->SetDelta(1.5);
  std::atomic<int> calls{ 0 };
  std::atomic<int> wrong{ 0 };
  filter->SetSizeFunction(
    [&](const double* x, vtkTypeInt64 value)
    {
      ++calls;
      const double space = std::hypot(x[0] - centre[0], x[1] - centre[1], x[2] - centre[2]);
      const double distance = std::hypot(space, 2.0 * (x[3] - centre[3]));
      const bool nearMiddle = std::abs(x[0] - centre[0]) < 1.0;
      const bool good = distance < 5.5 && (nearMiddle || value == (x[0] < centre[0] ? 3 : 7));
      wrong += good ? 0 : 1;
      return 2.0;
    });
  filter->Update();
  CheckMesh(filter);
  CHECK(calls > 100, calls);
  CHECK(wrong == 0, wrong, calls);
}

/** Points that are hidden in one image or in each frame are background, whatever their values are. */
void TestHidden()
{
  const auto isHidden = [](const Vector& x) { return x[0] < 4.0; };
  const auto hide = [&](vtkImageData* image)
  {
    vtkNew<vtkUnsignedCharArray> ghosts;
    ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
    for (vtkIdType i = 0; i < image->GetNumberOfPoints(); ++i)
    {
      Vector x;
      image->GetPoint(i, x.data());
      ghosts->InsertNextValue(isHidden(x) ? vtkDataSetAttributes::HIDDENPOINT : 0);
    }
    image->GetPointData()->AddArray(ghosts);
  };
  const auto label = TwoLabelBall(Centre, 4.2);
  const auto expected = MakePentatopeFilter(MakeSeries(SmallPlacement(), EqualTimes(12),
    [&](const Vector& x, double t) { return isHidden(x) ? 0.0 : label(x, t); }));
  expected->Update();
  const auto strange = [&](const Vector& x, double t) { return isHidden(x) ? -1.5 : label(x, t); };
  const auto source = MakeSeries(SmallPlacement(), EqualTimes(12), strange, VTK_FLOAT);
  const auto makeFrame = source->MakeFrame;
  source->MakeFrame = [&](int frame)
  {
    const auto image = makeFrame(frame);
    hide(image);
    return image;
  };
  const auto series = MakePentatopeFilter(source);
  series->Update();
  CHECK(SameMesh(expected, series), series->GetErrorMessage());

  const auto image = MakeComponents(SmallPlacement(), EqualTimes(12), strange, VTK_SHORT);
  hide(image);
  const auto components = FromImage(image);
  components->Update();
  CHECK(SameMesh(expected, components), components->GetErrorMessage());
}

/** Labels that were scaled and scaled back. */
void TestRounded()
{
  const auto label = TwoLabelBall(Centre, 4.2);
  const auto rounded = [&](const Vector& x, double t)
  { return label(x, t) * (1.0 - 1e-7) - (label(x, t) == 0.0 ? 1e-7 : 0.0); };
  const auto expected = MakePentatopeFilter();
  expected->Update();
  for (const int type : { VTK_FLOAT, VTK_DOUBLE })
  {
    const auto filter =
      MakePentatopeFilter(MakeSeries(SmallPlacement(), EqualTimes(12), rounded, type));
    filter->Update();
    CHECK(SameMesh(expected, filter), filter->GetErrorMessage());
  }
}

} // namespace

int TestPentatopeMeshInputs(int, char*[])
{
  TestBothKinds();
  TestUnequalTimes();
  TestChosenArray();
  TestTypes();
  TestLayouts();
  TestSelectedLabels();
  TestSizes();
  TestSizeFunctionArguments();
  TestHidden();
  TestRounded();
  return Result();
}
