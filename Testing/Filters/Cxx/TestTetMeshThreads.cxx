// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Any number of threads, contention manager and load balancer: the same bounds; events stay on the
// calling thread.
#include "FilterTesting.h"

#include "vtkAlgorithm.h"
#include "vtkCallbackCommand.h"
#include "vtkExecutive.h"
#include "vtkImageData.h"
#include "vtkMeshingStatistics.h"
#include "vtkNew.h"
#include "vtkPolyData.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#ifdef __linux__
#include <sched.h>
#endif

using namespace testing;

namespace
{

using Filter = vtkImageToTetMeshFilter;

vtkSmartPointer<Filter> MakeParallel(int threads, double delta = 0.8)
{
  const auto filter = MakeFilter(MakeTwoLabels());
  filter->SetDelta(delta);
  filter->SetNumberOfThreads(threads);
  filter->ComputeQualityOn();
  return filter;
}

/** The figures of threads agree with each other and with the rest. */
void CheckThreads(vtkMeshingStatistics* statistics, int threads)
{
  CHECK(statistics->GetNumberOfThreads() == threads);
  const double found = statistics->GetFigure("/thread_statistics");
  CHECK(found == threads, threads, found);
  double insertions = 0.0;
  double removals = 0.0;
  double rollbacks = 0.0;
  double received = 0.0;
  for (int t = 0; t < threads; ++t)
  {
    const auto figure = [&](const char* key)
    {
      const std::string path = "/thread_statistics/" + std::to_string(t) + "/" + key;
      return statistics->GetFigure(path.c_str());
    };
    insertions += figure("insertions");
    removals += figure("removals");
    rollbacks += figure("rollbacks");
    received += figure("received_elements");
    CHECK(figure("waits") <= figure("rollbacks"), t);
    const double gifts = figure("received/0") + figure("received/1") + figure("received/2");
    CHECK(figure("received_elements") >= gifts, t, gifts);
    for (const double seconds :
      { figure("contention_seconds"), figure("load_balance_seconds"), figure("rollback_seconds") })
    {
      // Measured by another clock than the stage.
      CHECK(seconds >= 0.0 && seconds <= 1.05 * statistics->GetRefinementTime() + 0.01, t, seconds);
    }
  }
  double fired = 0.0;
  for (const char* rule : { "R1", "R2", "R3", "R4", "R5", "R7_split", "R7_sampled" })
  {
    fired += statistics->GetFigure((std::string("/rules/") + rule).c_str());
  }
  CHECK(insertions == fired, insertions, fired);
  CHECK(removals == statistics->GetFigure("/rules/R6"), removals);
  CHECK(statistics->GetFigure("/seeding_seconds") >= 0.0 &&
    statistics->GetFigure("/seeding_seconds") <= statistics->GetRefinementTime());
  if (threads == 1)
  {
    CHECK(rollbacks == 0.0 && received == 0.0 && !statistics->GetSwitchedToLocal());
  }
}

/** What is promised of every mesh, and hardly another one than `like`, which one thread made. */
void CheckParallelMesh(Filter* filter, Filter* like)
{
  CheckMesh(filter);
  vtkMeshingStatistics* statistics = filter->GetStatistics();
  CheckThreads(statistics, filter->GetNumberOfThreads());
  CHECK(statistics->GetMaximumRadiusEdgeRatio() <= 2.5, statistics->GetMaximumRadiusEdgeRatio());
  CHECK(statistics->GetRadiusEdgeViolations() == 0);
  CHECK(statistics->GetInvertedElements() == 0);
  CHECK(statistics->GetNumberOfLostLabels() == 0);
  vtkMeshingStatistics* expected = like->GetStatistics();
  // Optimisation may leave angles from 20 degrees on at junctions.
  const auto offJunctions = [](vtkMeshingStatistics* of)
  {
    return static_cast<double>(of->GetFacetAngleViolations()) -
      of->GetFigure("/quality/facet_angle_violations_at_junctions");
  };
  CHECK(offJunctions(statistics) <= offJunctions(expected), offJunctions(statistics));
  CHECK(statistics->GetFacetAngleViolations() <= expected->GetFacetAngleViolations() + 10,
    statistics->GetFacetAngleViolations());
  const double elements = static_cast<double>(statistics->GetNumberOfElements());
  const double usual = static_cast<double>(expected->GetNumberOfElements());
  CHECK(std::abs(elements / usual - 1.0) < 0.15, elements, usual);
  if (CHECK(statistics->GetNumberOfLabels() == expected->GetNumberOfLabels()))
  {
    for (int i = 0; i < statistics->GetNumberOfLabels(); ++i)
    {
      CHECK(statistics->GetLabel(i) == expected->GetLabel(i));
      CHECK(std::abs(statistics->GetLabelVolume(i) / expected->GetLabelVolume(i) - 1.0) < 0.03, i);
    }
  }
}

void TestEveryPolicy()
{
  const auto one = MakeParallel(1);
  one->Update();
  CheckParallelMesh(one, one);
  for (int manager = Filter::CONTENTION_AGGRESSIVE; manager <= Filter::CONTENTION_LOCAL; ++manager)
  {
    for (int balancer = Filter::RANDOM_WORK_STEALING;
         balancer <= Filter::HIERARCHICAL_WORK_STEALING; ++balancer)
    {
      const auto filter = MakeParallel(4);
      filter->SetContentionManager(manager);
      filter->SetLoadBalancer(balancer);
      filter->Update();
      CheckParallelMesh(filter, one);
      const std::string json = filter->GetStatistics()->ToJSON();
      for (const char* name :
        { filter->GetContentionManagerAsString(), filter->GetLoadBalancerAsString() })
      {
        CHECK(json.find('"' + std::string(name) + '"') != std::string::npos, name);
      }
    }
  }
}

/** More threads than cores and than work. With one thread no choice matters. */
void TestNumbers()
{
  const auto one = MakeParallel(1);
  one->Update();
  const auto many = MakeParallel(32);
  many->Update();
  CheckParallelMesh(many, one);

  const auto coarse = MakeParallel(16, 8.0);
  coarse->Update();
  CheckMesh(coarse);
  CheckThreads(coarse->GetStatistics(), 16);

  // The same filter, back to one thread: bit for bit what a fresh one makes.
  many->SetNumberOfThreads(1);
  many->SetContentionManagerToAggressive();
  many->SetLoadBalancerToRandomWorkStealing();
  many->PinThreadsOn();
  many->Update();
  CHECK(SameMesh(many->GetOutput(), one->GetOutput()));
  CHECK(SameMesh(many->GetInterfaces(), one->GetInterfaces()));
}

#ifdef __linux__
/** The processors that the calling thread may use. */
cpu_set_t Affinity()
{
  cpu_set_t set;
  CPU_ZERO(&set);
  sched_getaffinity(0, sizeof(set), &set);
  return set;
}

/** Whether there are several processors to choose from, and choosing is allowed. */
bool CanPin()
{
  bool can = false;
  std::thread(
    [&can]
    {
      const cpu_set_t all = Affinity();
      cpu_set_t first;
      CPU_ZERO(&first);
      for (int processor = 0; processor < CPU_SETSIZE && CPU_COUNT(&first) == 0; ++processor)
      {
        if (CPU_ISSET(processor, &all))
        {
          CPU_SET(processor, &first);
        }
      }
      can = CPU_COUNT(&all) > 1 && sched_setaffinity(0, sizeof(first), &first) == 0;
    })
    .join();
  return can;
}

/** Refinement threads, which evaluate sizes, keep to one core each; only if they are asked to. */
void TestAffinity()
{
  const cpu_set_t before = Affinity();
  for (const bool pin : { false, true })
  {
    const auto filter = MakeParallel(4);
    filter->SetPinThreads(pin);
    std::atomic<bool> pinned = false;
    filter->SetSizeFunction(
      [&pinned](const double[3], vtkTypeInt64)
      {
        const cpu_set_t set = Affinity();
        pinned = pinned || CPU_COUNT(&set) == 1;
        return 5.0;
      });
    filter->Update();
    CheckMesh(filter);
    CHECK(pinned == pin, pin);
    const cpu_set_t after = Affinity();
    CHECK(CPU_EQUAL(&before, &after), pin);
  }
}
#endif

/** Pinned threads make a mesh, too, and the calling thread keeps all its cores. */
void TestPinning()
{
  const auto one = MakeParallel(1);
  one->Update();
  const auto filter = MakeParallel(4);
  filter->PinThreadsOn();
  filter->Update();
  CheckParallelMesh(filter, one);
#ifdef __linux__
  if (CanPin())
  {
    TestAffinity();
  }
  else
  {
    std::cout << "Threads cannot be pinned here: not tested.\n";
  }
#endif
}

/** Two filters in one process do not disturb each other. */
void TestInstances()
{
  const auto one = MakeParallel(1);
  one->Update();
  const auto left = MakeParallel(4);
  const auto right = MakeParallel(4);
  right->SetContentionManagerToGlobal();
  std::thread other([&right] { right->Update(); });
  left->Update();
  other.join();
  CheckParallelMesh(left, one);
  CheckParallelMesh(right, one);
}

/** An observer of everything that objects send: which events, and whether from another thread. */
class Listener
{
public:
  Listener()
  {
    this->Command->SetClientData(this);
    this->Command->SetCallback(
      [](vtkObject* caller, unsigned long event, void* data, void*)
      {
        auto* self = static_cast<Listener*>(data);
        if (std::this_thread::get_id() != self->Caller)
        {
          ++self->FromOtherThreads;
        }
        else if (caller == self->Filter)
        {
          self->Events.push_back(event);
        }
      });
  }

  void Watch(vtkObject* object) { object->AddObserver(vtkCommand::AnyEvent, this->Command); }
  long Count(unsigned long event) const
  {
    return std::count(this->Events.begin(), this->Events.end(), event);
  }

  vtkObject* Filter = nullptr;
  std::vector<unsigned long> Events; ///< of the filter
  std::atomic<int> FromOtherThreads = 0;

private:
  const std::thread::id Caller = std::this_thread::get_id();
  vtkNew<vtkCallbackCommand> Command;
};

/** Of the filter and of every object that it can reach, to the end of its life. */
void TestEvents(int threads)
{
  Listener listener;
  const auto image = MakeTwoLabels();
  auto filter = MakeFilter(image);
  filter->SetDelta(0.8);
  filter->SetNumberOfThreads(threads);
  filter->ComputeQualityOn();
  listener.Filter = filter;
  for (vtkObject* object :
    { static_cast<vtkObject*>(filter), static_cast<vtkObject*>(filter->GetExecutive()),
      static_cast<vtkObject*>(filter->GetOutput()),
      static_cast<vtkObject*>(filter->GetInterfaces()),
      static_cast<vtkObject*>(filter->GetStatistics()), static_cast<vtkObject*>(image) })
  {
    listener.Watch(object);
  }
  filter->Update();
  CheckMesh(filter);
  CHECK(listener.Count(vtkCommand::StartEvent) == 1);
  CHECK(listener.Count(vtkCommand::EndEvent) == 1);
  CHECK(listener.Count(vtkCommand::ProgressEvent) >= 4);
  CHECK(listener.Count(vtkCommand::ErrorEvent) == 0);
  CHECK(listener.Count(vtkCommand::WarningEvent) == 0);
  const auto start = std::find(listener.Events.begin(), listener.Events.end(),
    static_cast<unsigned long>(vtkCommand::StartEvent));
  const auto progress = std::find(listener.Events.begin(), listener.Events.end(),
    static_cast<unsigned long>(vtkCommand::ProgressEvent));
  CHECK(start < progress);
  CHECK(!listener.Events.empty() && listener.Events.back() == vtkCommand::EndEvent);

  // An error and a warning come from the calling thread, too.
  filter->SetLabelSize(9, 1.0);
  filter->Update();
  CHECK(listener.Count(vtkCommand::ErrorEvent) == 1);
  filter->ClearLabelSizes();
  filter->SetDelta(8.0);
  filter->SetElementSize(0.01);
  filter->Update();
  CHECK(listener.Count(vtkCommand::WarningEvent) >= 1);

  CHECK(listener.Count(vtkCommand::DeleteEvent) == 0);
  filter = nullptr;
  CHECK(listener.Count(vtkCommand::DeleteEvent) == 1);
  CHECK(listener.Events.back() == vtkCommand::DeleteEvent);
  CHECK(listener.FromOtherThreads == 0, threads, listener.FromOtherThreads);
}

void TestThrowingFunction()
{
  for (const int threads : { 1, 2, 8 })
  {
    const auto filter = MakeParallel(threads, 2.0);
    filter->SetSizeFunction([](const double[3], vtkTypeInt64) -> double
      { throw std::runtime_error("the user's own words"); });
    ExpectError(
      "exception", filter, { "the user's own words" }, [&] { filter->SetSizeFunction(nullptr); });
    filter->SetSizeFunction([](const double[3], vtkTypeInt64) -> double { throw 42; });
    ExpectError(
      "odd exception", filter, { "size function" }, [&] { filter->SetSizeFunction(nullptr); });
  }
}

} // namespace

int TestTetMeshThreads(int, char*[])
{
  TestEveryPolicy();
  TestNumbers();
  TestPinning();
  TestInstances();
  TestThrowingFunction();
  TestEvents(1);
  TestEvents(8);
  return Result();
}
