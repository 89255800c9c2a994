// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// The space-time filter in a pipeline: which time steps it asks for, what times it announces, when it
// executes, progress, abort, threads, statistics, PrintSelf.
#include "PentatopeTesting.h"

#include "vtkCallbackCommand.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationDoubleVectorKey.h"
#include "vtkMeshingStatistics.h"
#include "vtkNew.h"
#include "vtkPentatopeMeshTimeSlice.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkStringArray.h"
#include "vtkTrivialProducer.h"
#include "vtkUnstructuredGrid.h"

#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>

using namespace testing;

namespace
{

using Pipeline = vtkStreamingDemandDrivenPipeline;

const Event Centre = { 5.5, 5.5, 5.5, 5.5 };

vtkSmartPointer<TemporalSource> MakeSource(const std::vector<double>& times = EqualTimes(12))
{
  const double step = times[1] - times[0];
  return MakeSeries(SmallPlacement(), times,
    [=](const Vector& x, double t) { return TwoLabelBall(Centre, 4.2)(x, (t - times[0]) / step); });
}

/** Counts how often an algorithm starts to execute. */
void Count(vtkAlgorithm* algorithm, int& executions)
{
  vtkNew<vtkCallbackCommand> counter;
  counter->SetClientData(&executions);
  counter->SetCallback(
    [](vtkObject*, unsigned long, void* data, void*) { ++*static_cast<int*>(data); });
  algorithm->AddObserver(vtkCommand::StartEvent, counter);
}

/** Each step once, in order; a request for a time executes nothing. */
void TestTimeRequests()
{
  const auto source = MakeSource();
  const auto filter = MakePentatopeFilter(source);
  int executions = 0;
  Count(filter, executions);
  filter->Update();
  CheckMesh(filter);
  CHECK(source->Asked == source->Times, source->Asked.size());
  CHECK(executions == 1, executions);

  for (const double time : { 3.0, 7.5, 11.0, 0.0, -4.0 })
  {
    filter->UpdateTimeStep(time);
    filter->GetOutputInformation(1)->Set(Pipeline::UPDATE_TIME_STEP(), time);
    filter->Update(1);
    CHECK(executions == 1 && source->Asked == source->Times, time, executions);
  }
  CheckMesh(filter);
  for (int port = 0; port < 2; ++port)
  {
    vtkInformation* data = filter->GetOutputDataObject(port)->GetInformation();
    CHECK(!data->Has(vtkDataObject::DATA_TIME_STEP()), port);
  }

  // Asked for a time from the start, too.
  source->Asked.clear();
  source->Modified();
  filter->UpdateTimeStep(4.0);
  CHECK(source->Asked == source->Times, source->Asked.size());
  CHECK(executions == 2, executions);
  CheckMesh(filter);
}

/** Of time steps, and of components: the edge of a hypercube as large as a voxel, twice. */
void TestDefaultDelta()
{
  const auto filter = MakePentatopeFilter(MakeSource({ 2.0, 2.5, 3.0, 3.5 }));
  filter->SetTimeScale(32.0); // unit spacing: a voxel's hypervolume is 16
  filter->UpdateInformation();
  CHECK(std::abs(filter->GetDefaultDelta() - 4.0) < 1e-12, filter->GetDefaultDelta());
  CHECK(filter->GetStatistics()->GetDelta() == 0.0);
  filter->Update();
  CHECK(std::abs(filter->GetStatistics()->GetDelta() - 4.0) < 1e-12);

  vtkNew<vtkImageData> image;
  image->SetDimensions(4, 4, 4);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  vtkNew<vtkImageToPentatopeMeshFilter> components;
  components->SetInputData(image);
  components->SetTimeSpacing(81.0);
  components->UpdateInformation();
  CHECK(std::abs(components->GetDefaultDelta() - 6.0) < 1e-12, components->GetDefaultDelta());
}

void CheckRange(vtkImageToPentatopeMeshFilter* filter, double first, double last)
{
  for (int port = 0; port < 2; ++port)
  {
    vtkInformation* info = filter->GetOutputInformation(port);
    CHECK(!info->Has(Pipeline::TIME_STEPS()), port);
    for (auto* key : { Pipeline::TIME_RANGE(), vtkPentatopeMeshTimeSlice::MESH_TIME_RANGE() })
    {
      const double* range = info->Get(key);
      if (CHECK(range != nullptr, port))
      {
        CHECK(range[0] == first && range[1] == last, range[0], range[1]);
      }
    }
  }
}

/** The range is announced before execution. */
void TestTimeRange()
{
  const auto series = MakePentatopeFilter(MakeSource(EqualTimes(12, 0.25)));
  series->UpdateInformation();
  CheckRange(series, 0.0, 2.75);

  const auto image = MakeComponents(SmallPlacement(), EqualTimes(12), TwoLabelBall(Centre, 4.2));
  vtkNew<vtkTrivialProducer> producer;
  producer->SetOutput(image);
  const auto components = MakePentatopeFilter(producer);
  components->SetTimeOrigin(10.0);
  components->SetTimeSpacing(0.5);
  components->UpdateInformation();
  CheckRange(components, 10.0, 15.5);
  components->SetTimeOrigin(20.0);
  components->UpdateInformation();
  CheckRange(components, 20.0, 25.5);
  image->DeepCopy(MakeBall());
  components->UpdateInformation(); // one component: nothing to announce
  CHECK(!components->GetOutputInformation(0)->Has(Pipeline::TIME_RANGE()));
}

void TestExecutions()
{
  const auto filter = MakePentatopeFilter();
  int executions = 0;
  Count(filter, executions);
  filter->Update();
  filter->Update();
  CHECK(executions == 1, executions);
  const auto expectExecution = [&](const char* name, const std::function<void()>& change)
  {
    executions = 0;
    change();
    filter->Update();
    filter->Update();
    CHECK(executions == 1, name, executions);
    CHECK(filter->GetErrorMessage().empty(), name, filter->GetErrorMessage());
  };
  expectExecution("TimeOrigin", [&] { filter->SetTimeOrigin(1.0); });
  expectExecution("TimeSpacing", [&] { filter->SetTimeSpacing(2.0); });
  expectExecution("PickingRadius", [&] { filter->SetPickingRadius(0.4); });
  expectExecution("SliverRadiusFactor", [&] { filter->SetSliverRadiusFactor(3.0); });
  expectExecution("SizeFunction",
    [&] { filter->SetSizeFunction([](const double*, vtkTypeInt64) { return 5.0; }); });
}

/** Piece 0 is everything, other pieces are empty. */
void TestPieces()
{
  const auto filter = MakePentatopeFilter();
  filter->UpdatePiece(0, 2, 0);
  CheckMesh(filter);
  filter->UpdatePiece(1, 2, 0);
  CHECK(Empty(filter));
  CHECK(filter->GetErrorMessage().empty());
  filter->UpdatePiece(0, 1, 0);
  CheckMesh(filter);
}

void TestReproducible()
{
  const auto make = []
  {
    const auto filter = MakePentatopeFilter();
    filter->PickingRegionsOn();
    filter->SetRandomSeed(5);
    filter->Update();
    CheckMesh(filter);
    return filter;
  };
  CHECK(SameMesh(make(), make()));
}

//----------------------------------------------------------------------------------------------------
void TestProgress()
{
  const auto filter = MakePentatopeFilter();
  std::vector<double> fractions;
  const auto observer =
    Observe(filter, [&](vtkAlgorithm*, double fraction) { fractions.push_back(fraction); });
  filter->Update();
  CHECK(fractions.size() >= 14, fractions.size()); // one for each frame at least
  for (std::size_t i = 0; i < fractions.size(); ++i)
  {
    CHECK(fractions[i] >= 0.0 && fractions[i] <= 1.0, fractions[i]);
    CHECK(i == 0 || fractions[i] >= fractions[i - 1], i, fractions[i]);
  }
  CHECK(!fractions.empty() && fractions.back() == 1.0);
}

/** While frames are gathered, and while meshing; with time steps and with components. */
void TestAbort(bool components, double at, std::size_t mostAsked)
{
  const auto source = MakeSource();
  const auto image = MakeComponents(SmallPlacement(), EqualTimes(12), TwoLabelBall(Centre, 4.2));
  vtkNew<vtkTrivialProducer> producer;
  producer->SetOutput(image);
  const auto filter =
    MakePentatopeFilter(components ? static_cast<vtkAlgorithm*>(producer) : source);
  const auto errors = vtkSmartPointer<ErrorCollector>::Take(ErrorCollector::New());
  errors->Watch(filter);
  const auto observer = Observe(filter,
    [at](vtkAlgorithm* algorithm, double fraction)
    {
      if (fraction >= at)
      {
        algorithm->SetAbortExecute(1);
      }
    });
  filter->Update();
  CHECK(filter->GetAborted(), at);
  CHECK(filter->GetErrorMessage().empty(), filter->GetErrorMessage());
  CHECK(Empty(filter));
  CHECK(filter->GetStatistics()->GetNumberOfElements() == 0);
  CHECK(errors->FromFilter.empty() && errors->FromOthers.empty());
  CHECK(source->Asked.size() <= mostAsked, source->Asked.size(), mostAsked);

  // Nothing is left over.
  filter->RemoveObserver(observer);
  filter->Modified();
  source->Asked.clear();
  source->Modified();
  filter->Update();
  CHECK(!filter->GetAborted());
  CHECK(components || source->Asked == source->Times, source->Asked.size());
  const auto fresh = MakePentatopeFilter();
  fresh->Update();
  CHECK(SameMesh(filter, fresh));
}

//----------------------------------------------------------------------------------------------------
void TestThreads()
{
  // That of the 4-ball's voxels, as labels keep it. The ball itself has 1,536.
  const double expected = 1600.0;
  for (const int threads : { 1, 2, 4 })
  {
    for (const bool picking : { false, true })
    {
      const auto filter = MakePentatopeFilter();
      filter->SetDelta(1.0);
      filter->SetNumberOfThreads(threads);
      filter->SetPickingRegions(picking);
      filter->SetFineGrained(threads == 4);
      filter->ComputeQualityOn();
      filter->Update();
      CheckMesh(filter);
      const double found = ReadPentatopes(filter->GetOutput()).VolumeOf();
      CHECK(std::abs(found / expected - 1.0) < 0.05, threads, picking, found, expected);
      vtkMeshingStatistics* statistics = filter->GetStatistics();
      CHECK(statistics->GetNumberOfThreads() == threads);
      CHECK(statistics->GetFigure("/thread_statistics") == threads);
      CHECK(statistics->GetInvertedElements() == 0 && statistics->GetRadiusEdgeViolations() == 0);
    }
  }
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

void TestStatistics()
{
  const auto filter = MakePentatopeFilter();
  filter->ComputeQualityOn();
  filter->Update();
  vtkMeshingStatistics* s = filter->GetStatistics();
  CHECK(s->GetDimension() == 4);
  CHECK(s->GetNumberOfElements() == filter->GetOutput()->GetNumberOfCells());
  CHECK(s->GetNumberOfVertices() == filter->GetOutput()->GetNumberOfPoints());
  CHECK(s->GetNumberOfInterfaceFacets() == filter->GetBoundary()->GetNumberOfCells());
  const Pentatopes mesh = ReadPentatopes(filter->GetOutput());
  if (CHECK(s->GetNumberOfLabels() == 2))
  {
    CHECK(s->GetLabel(0) == 3 && s->GetLabel(1) == 7);
    CHECK(std::abs(s->GetLabelVolume(0) / mesh.VolumeOf(3) - 1.0) < 1e-9);
  }
  double shortest = VTK_DOUBLE_MAX;
  for (std::size_t c = 0; c < mesh.Cells.size(); ++c)
  {
    const auto p = mesh.Corners(c);
    for (std::size_t i = 0; i < 5; ++i)
    {
      for (std::size_t j = 0; j < i; ++j)
      {
        double square = 0.0;
        for (std::size_t k = 0; k < 4; ++k)
        {
          square += (p[i][k] - p[j][k]) * (p[i][k] - p[j][k]);
        }
        shortest = std::min(shortest, std::sqrt(square));
      }
    }
  }
  CHECK(std::abs(s->GetFigure("/quality/shortest_edge") / shortest - 1.0) < 1e-9, shortest);
  CHECK(s->GetMaximumRadiusEdgeRatio() <= 2.0);
  CHECK(s->GetFigure("/quality/mean_radius_edge") > 0.63 &&
    s->GetFigure("/quality/mean_radius_edge") < 2.0);
  CHECK(s->GetFigure("/quality/radius_edge_deviation") > 0.0 &&
    s->GetFigure("/quality/normalized_volume_deviation") > 0.0);
  double sum = 0.0;
  for (int i = 0; i < 20; ++i)
  {
    const std::string bin = "/quality/normalized_volume_histogram/" + std::to_string(i);
    sum += s->GetFigure(bin.c_str());
  }
  CHECK(sum == static_cast<double>(s->GetNumberOfElements()), sum);
  CHECK(std::isnan(s->GetMinimumDihedralAngle()));
  CHECK(s->ToJSON().find("\"dimension\":4") != std::string::npos);

  // Shapes are improved unless that is switched off.
  CHECK(s->GetOptimised());
  const double worst = s->GetFigure("/quality/min_normalized_volume");
  CHECK(std::abs(s->GetFigure("/optimisation/min_normalized_volume_after") - worst) < 1e-12, worst);
  const auto plain = MakePentatopeFilter();
  plain->ComputeQualityOn();
  plain->OptimiseOff();
  plain->Update();
  CheckMesh(plain);
  CHECK(!plain->GetStatistics()->GetOptimised());
  const double before = plain->GetStatistics()->GetFigure("/quality/min_normalized_volume");
  CHECK(s->GetFigure("/optimisation/min_normalized_volume_before") == before, before);
  CHECK(worst > 1.5 * before, worst, before);

  // Figures are those of the space in which a unit of time counts as TimeScale units of length.
  const auto scaled = MakePentatopeFilter(MakeSource(EqualTimes(12, 0.5)));
  scaled->SetTimeScale(2.0);
  scaled->ComputeQualityOn();
  scaled->Update();
  CHECK(scaled->GetStatistics()->GetLabelVolume(0) == s->GetLabelVolume(0));
  CHECK(scaled->GetStatistics()->GetFigure("/quality/shortest_edge") ==
    s->GetFigure("/quality/shortest_edge"));
}

/** Field data of the input goes to both outputs, without the time of a frame. */
void TestFieldData()
{
  const auto source = MakeSource();
  source->MakeFrame = [make = source->MakeFrame](int frame)
  {
    const auto image = make(frame);
    vtkNew<vtkStringArray> space;
    space->SetName("SPACE");
    space->InsertNextValue("LPS");
    image->GetFieldData()->AddArray(space);
    vtkNew<vtkDoubleArray> time;
    time->SetName("TimeValue");
    time->InsertNextValue(frame);
    image->GetFieldData()->AddArray(time);
    return image;
  };
  const auto filter = MakePentatopeFilter(source);
  filter->Update();
  for (int port = 0; port < 2; ++port)
  {
    vtkFieldData* fields = filter->GetOutputDataObject(port)->GetFieldData();
    CHECK(fields->GetAbstractArray("SPACE") != nullptr, port);
    CHECK(fields->GetAbstractArray("TimeValue") == nullptr, port);
  }
}

void TestPrintSelf()
{
  vtkNew<vtkImageToPentatopeMeshFilter> filter;
  std::ostringstream text;
  filter->Print(text);
  for (const char* line :
    { "TimeOrigin: 0\n", "TimeSpacing: 1\n", "PickingRadius: 0.5\n", "SliverRadiusFactor: 4\n" })
  {
    CHECK(text.str().find(line) != std::string::npos, line);
  }
}

} // namespace

int TestPentatopeMeshPipeline(int, char*[])
{
  TestTimeRequests();
  TestDefaultDelta();
  TestTimeRange();
  TestExecutions();
  TestPieces();
  TestReproducible();
  TestProgress();
  TestAbort(false, 0.0, 1);
  TestAbort(false, 0.04, 6);
  TestAbort(false, 0.1, 12);
  TestAbort(true, 0.0, 0);
  TestAbort(true, 0.11, 0);
  TestThreads();
  TestThrowingFunction();
  TestStatistics();
  TestFieldData();
  TestPrintSelf();
  return Result();
}
