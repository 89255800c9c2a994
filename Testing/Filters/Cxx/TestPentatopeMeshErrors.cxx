// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Misuse of the space-time filter: a clear message, empty outputs, and it goes on working. What is
// tested for the 3D filter and handled by the common superclass is not repeated in full.
#include "PentatopeTesting.h"

#include "vtkDataArray.h"
#include "vtkExecutive.h"
#include "vtkImageData.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkStringArray.h"
#include "vtkTrivialProducer.h"
#include "vtkUnstructuredGrid.h"

#include <stdexcept>

using namespace testing;

namespace
{

const Event Centre = { 5.5, 5.5, 5.5, 5.5 };

/** The series of the small ball, with the frame of this number changed. */
vtkSmartPointer<TemporalSource> WithChangedFrame(
  int changed, const std::function<void(vtkImageData*)>& change)
{
  const auto source = MakeSeries(SmallPlacement(), EqualTimes(12), TwoLabelBall(Centre, 4.2));
  source->MakeFrame = [=, make = source->MakeFrame](int frame)
  {
    const auto image = make(frame);
    if (frame == changed)
    {
      change(image);
    }
    return image;
  };
  return source;
}

/** A series that is bad in itself. */
void ExpectSeriesError(
  const char* name, vtkAlgorithm* source, const std::vector<std::string>& words)
{
  const auto filter = MakePentatopeFilter(source);
  const auto good = MakeSeries(SmallPlacement(), EqualTimes(12), TwoLabelBall(Centre, 4.2));
  ExpectError(name, filter, words, [&] { filter->SetInputConnection(good->GetOutputPort()); });
}

void ExpectFrameError(const char* name, int frame, const std::function<void(vtkImageData*)>& change,
  const std::vector<std::string>& words)
{
  ExpectSeriesError(name, WithChangedFrame(frame, change), words);
}

void TestTimes()
{
  const auto withTimes = [](const std::vector<double>& times)
  {
    const auto source = MakeSeries(SmallPlacement(), EqualTimes(12), TwoLabelBall(Centre, 4.2));
    source->Times = times;
    return source;
  };
  ExpectSeriesError(
    "one time step", withTimes({ 2.0 }), { "one time step only", "vtkImageToTetMeshFilter" });
  ExpectSeriesError("no time steps", withTimes({}), { "no time steps", "vtkImageToTetMeshFilter" });
  ExpectSeriesError("equal times", withTimes({ 0, 1, 1, 2 }),
    { "must increase", "frame 1 has time 1", "frame 2 has time 1" });
  ExpectSeriesError("decreasing times", withTimes({ 0, 2, 1, 3 }),
    { "must increase", "frame 1 has time 2", "frame 2 has time 1" });
  ExpectSeriesError("two frames at nearly the same time", withTimes({ 0, 1, 1.0001, 3 }),
    { "frames 1 and 2", "1 and 1.0001", "too near each other", "more than 1000" });
  ExpectSeriesError("NaN", withTimes({ 0, vtkMath::Nan(), 2, 3 }), { "frame 1", "nan", "finite" });
  ExpectSeriesError("infinite", withTimes({ 0, 1, 2, vtkMath::Inf() }), { "frame 3", "finite" });

  // The rounding of a file's header is no gap.
  const auto rounded = withTimes({ 0, 0.333333, 0.666667, 1 });
  rounded->MakeFrame = [make = rounded->MakeFrame](int frame) { return make(frame + 4); };
  const auto filter = MakePentatopeFilter(rounded);
  filter->SetTimeScale(3.0);
  filter->Update();
  CheckMesh(filter);

  const auto three = MakePentatopeFilter();
  const auto add = [&]
  {
    for (const double time : { 0.0, 1.0, 2.0 })
    {
      three->AddFrameTime(time);
    }
  };
  add();
  ExpectError("three times of twelve frames", three,
    { "AddFrameTime() gave 3 times, but there are 12 frames" }, [&] { three->ClearFrameTimes(); });
}

void TestFrames()
{
  const auto other = [](const Placement& placement)
  {
    return [placement](vtkImageData* image)
    {
      image->DeepCopy(
        MakeImage(placement, [](const Vector& x) { return TwoLabelBall(Centre, 4.2)(x, 5.0); }));
    };
  };
  Placement larger = SmallPlacement();
  larger.Extent[3] = 12;
  ExpectFrameError("dimensions", 3, other(larger),
    { "same dimensions", "frame 0 (time 0)", "frame 3 (time 3)", "12 x 12 x 12", "12 x 13 x 12" });
  ExpectFrameError("spacing", 5, [](vtkImageData* i) { i->SetSpacing(1, 1, 1.01); },
    { "same spacing", "frame 0 (time 0)", "frame 5 (time 5)", "1.01" });
  ExpectFrameError("origin", 11, [](vtkImageData* i) { i->SetOrigin(0, 0.5, 0); },
    { "same origin", "frame 0 (time 0)", "frame 11 (time 11)", "(0, 0.5, 0)" });
  ExpectFrameError("shifted extent", 1, [](vtkImageData* i) { i->SetExtent(1, 12, 0, 11, 0, 11); },
    { "same origin", "frame 1" });
  const double mirrored[9] = { 0, 1, 0, 1, 0, 0, 0, 0, 1 };
  ExpectFrameError("direction", 2, [&](vtkImageData* i) { i->SetDirectionMatrix(mirrored); },
    { "same direction", "frame 0 (time 0)", "frame 2 (time 2)" });
  ExpectFrameError("array name", 4,
    [](vtkImageData* i) { i->GetPointData()->GetScalars()->SetName("Mask"); },
    { "same name", "frame 4 (time 4)", "'Segmentation'", "'Mask'" });
  ExpectFrameError("no array", 4, [](vtkImageData* i) { i->GetPointData()->Initialize(); },
    { "image of frame 4 (time 4)", "SetInputArrayToProcess" });
  ExpectFrameError("components", 6,
    [](vtkImageData* i)
    {
      vtkDataArray* scalars = i->GetPointData()->GetScalars();
      const vtkIdType voxels = scalars->GetNumberOfTuples();
      scalars->SetNumberOfComponents(2);
      scalars->SetNumberOfTuples(voxels);
      scalars->Fill(1.0);
    },
    { "image of frame 6 (time 6)", "2 components", "time steps" });

  // What is within rounding is the same.
  const auto rounded = WithChangedFrame(3,
    [](vtkImageData* i)
    {
      i->SetOrigin(1e-6, 0, 0);
      i->SetSpacing(1, 1 + 1e-6, 1);
    });
  const auto filter = MakePentatopeFilter(rounded);
  filter->Update();
  CheckMesh(filter);
}

void TestValues()
{
  const auto with = [](double bad)
  {
    return [bad](vtkImageData* image)
    {
      image->DeepCopy(MakeImage(
        SmallPlacement(),
        [&](const Vector& x) {
          return x == Vector{ 3, 4, 5 } ? bad : 1.0;
        },
        VTK_DOUBLE));
    };
  };
  ExpectFrameError("fraction", 2, with(1.5), { "frame 2 (time 2)", "1.5", "(3, 4, 5)", "whole" });
  ExpectFrameError("negative", 7, with(-3), { "frame 7 (time 7)", "-3", "negative" });
  ExpectFrameError("NaN", 0, with(vtkMath::Nan()), { "frame 0", "finite" });
  ExpectFrameError("infinite", 1, with(vtkMath::Inf()), { "frame 1", "finite" });
  ExpectFrameError("huge", 1, with(1e30), { "frame 1", "largest label" });
  ExpectFrameError("negative integer", 3,
    [](vtkImageData* image)
    {
      image->DeepCopy(MakeImage(
        SmallPlacement(), [](const Vector& x) { return x[0] - 1.0; }, VTK_SHORT));
    },
    { "frame 3", "-1", "(0, 0, 0)", "negative" });

  const auto nothing = [](const Vector&, double) { return 0.0; };
  ExpectSeriesError(
    "no foreground", MakeSeries(SmallPlacement(), EqualTimes(3), nothing), { "foreground" });
  const auto grey = [](const Vector& x, double t)
  { return x[0] + 12 * (x[1] + 12 * (x[2] + 12 * t)); };
  ExpectSeriesError(
    "grey values", MakeSeries(SmallPlacement(), EqualTimes(3), grey, VTK_FLOAT), { "grey-value" });
  Placement slice = SmallPlacement();
  slice.Extent[5] = 0;
  const auto one = [](const Vector&, double) { return 1.0; };
  ExpectSeriesError("one slice", MakeSeries(slice, EqualTimes(3), one), { "1 voxel" });
}

void TestComponents()
{
  const auto expect =
    [](const char* name, vtkImageData* image, const std::vector<std::string>& words)
  {
    vtkNew<vtkTrivialProducer> producer;
    producer->SetOutput(image);
    ExpectSeriesError(name, producer, words);
  };
  const auto label = TwoLabelBall(Centre, 4.2);
  expect("one component", MakeComponents(SmallPlacement(), { 5.0 }, label),
    { "one component", "vtkImageToTetMeshFilter" });
  const auto bad = MakeComponents(SmallPlacement(), EqualTimes(12), label, VTK_DOUBLE);
  bad->GetPointData()->GetScalars()->SetComponent(3 + 12 * (4 + 12 * 5), 6, 0.25);
  expect("fraction", bad, { "frame 6 (time 6)", "0.25", "(3, 4, 5)" });
  const auto none = MakeComponents(SmallPlacement(), EqualTimes(3), label);
  none->GetPointData()->Initialize();
  expect("no scalars", none, { "array", "SetInputArrayToProcess" });
  vtkNew<vtkStringArray> strings;
  strings->SetName("Text");
  strings->SetNumberOfValues(none->GetNumberOfPoints());
  none->GetPointData()->AddArray(strings);
  vtkNew<vtkTrivialProducer> producer;
  producer->SetOutput(none);
  const auto filter = MakePentatopeFilter(producer);
  filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "Text");
  ExpectError("strings", filter, { "Text", "numbers" });

  const auto good = MakeComponents(SmallPlacement(), EqualTimes(12), label);
  good->SetSpacing(1, 1, 0);
  expect("spacing", good, { "spacing", "positive" });
}

/** Bytes of three or four components are colours, unless there are times. */
void TestColours()
{
  const auto label = TwoLabelBall({ 5.5, 5.5, 5.5, 1.0 }, 4.2);
  for (const int type : { VTK_UNSIGNED_CHAR, VTK_UNSIGNED_SHORT })
  {
    for (const int frames : { 3, 4 })
    {
      vtkNew<vtkTrivialProducer> producer;
      producer->SetOutput(MakeComponents(SmallPlacement(), EqualTimes(frames), label, type));
      const auto filter = MakePentatopeFilter(producer);
      ExpectError("colours", filter, { "RGB", "AddFrameTime()", "extract one component" },
        [&]
        {
          for (const double time : EqualTimes(frames))
          {
            filter->AddFrameTime(time);
          }
        });
      filter->ClearFrameTimes();
      filter->SetTimeSpacing(0.5);
      filter->Update();
      CHECK(!Empty(filter), filter->GetErrorMessage());
    }
  }
  vtkNew<vtkTrivialProducer> producer;
  producer->SetOutput(MakeComponents(SmallPlacement(), EqualTimes(3), label, VTK_SHORT));
  const auto filter = MakePentatopeFilter(producer);
  filter->Update();
  CHECK(!Empty(filter), filter->GetErrorMessage());
}

/** Chosen labels count first: negative voxels are background then, as other labels are. */
void TestNegativeBesideChosen()
{
  const auto label = [](const Vector& x, double t)
  { return x[0] < 1.0 ? -1024.0 : TwoLabelBall(Centre, 4.2)(x, t); };
  const auto expected = MakePentatopeFilter();
  expected->AddLabel(3);
  expected->Update();
  for (const int type : { VTK_SHORT, VTK_FLOAT })
  {
    const auto filter =
      MakePentatopeFilter(MakeSeries(SmallPlacement(), EqualTimes(12), label, type));
    filter->AddLabel(3);
    filter->Update();
    CHECK(SameMesh(expected, filter), filter->GetErrorMessage());
  }
}

/** Those that the programs have no option for. The others: Parameters.Filters. */
void TestParameters()
{
  using Filter = vtkImageToPentatopeMeshFilter;
  struct Parameter
  {
    const char* Name;
    void (Filter::*Set)(double);
    double Good;
    std::vector<double> Bad;
  };
  const double nan = vtkMath::Nan();
  const double infinity = vtkMath::Inf();
  const auto filter = MakePentatopeFilter();
  for (const Parameter& p : { Parameter{ "TimeOrigin", &Filter::SetTimeOrigin, 0.0, { nan, infinity } },
         Parameter{ "TimeSpacing", &Filter::SetTimeSpacing, 1.0, { 0.0, -1.0, nan, infinity } },
         Parameter{ "PickingRadius", &Filter::SetPickingRadius, 0.5, { 0.0, 1.0, -0.5, nan } },
         Parameter{
           "SliverRadiusFactor", &Filter::SetSliverRadiusFactor, 4.0, { 0.9, 0.0, nan, infinity } } })
  {
    for (const double bad : p.Bad)
    {
      (filter->*p.Set)(bad);
      ExpectError(p.Name, filter, { p.Name }, [&] { (filter->*p.Set)(p.Good); });
    }
  }
  filter->SetSliverBound(0.04);
  ExpectError("large bound", filter, { "SliverBound", "0.03", "Force" }, [&] { filter->ForceOn(); });
}

void TestThrowingFunction()
{
  for (const int threads : { 1, 4 })
  {
    const auto filter = MakePentatopeFilter();
    filter->SetNumberOfThreads(threads);
    filter->SetSizeFunction([](const double*, vtkTypeInt64) -> double
      { throw std::runtime_error("the user's own words"); });
    ExpectError(
      "exception", filter, { "the user's own words" }, [&] { filter->SetSizeFunction(nullptr); });
  }
}

/** An input that fails at some frame: nothing comes out, and the next execution starts afresh. */
void TestFailingInput()
{
  for (const int failing : { 1, 5, 11 })
  {
    const auto source = MakeSeries(SmallPlacement(), EqualTimes(12), TwoLabelBall(Centre, 4.2));
    const auto make = source->MakeFrame;
    source->MakeFrame = [=](int frame) { return frame == failing ? nullptr : make(frame); };
    const auto filter = MakePentatopeFilter(source);
    const auto errors = vtkSmartPointer<ErrorCollector>::Take(ErrorCollector::New());
    errors->Watch(filter);
    source->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, errors);
    CHECK(filter->GetExecutive()->Update() == 0, failing);
    CHECK(!errors->FromOthers.empty(), failing);
    CHECK(Empty(filter), failing);
    CHECK(!filter->GetErrorMessage().empty(), failing);
    CHECK(source->Asked.size() == static_cast<std::size_t>(failing) + 1, failing);

    // Other frames than those that were gathered before the failure.
    const auto other = MakeSeries(SmallPlacement(), EqualTimes(12), TwoLabelBall(Centre, 3.6));
    source->MakeFrame = other->MakeFrame;
    source->Modified();
    CHECK(filter->GetExecutive()->Update() == 1, failing);
    CheckMesh(filter);
    const auto fresh = MakePentatopeFilter(other);
    fresh->Update();
    CHECK(SameMesh(filter, fresh), failing);
  }
}

} // namespace

int TestPentatopeMeshErrors(int, char*[])
{
  TestTimes();
  TestFrames();
  TestValues();
  TestComponents();
  TestColours();
  TestNegativeBesideChosen();
  TestParameters();
  TestThrowingFunction();
  TestFailingInput();
  return Result();
}
