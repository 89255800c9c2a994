// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Progress comes from the calling thread and never falls; aborting stops soon and leaves nothing.
#include "FilterTesting.h"

#include "vtkImageData.h"
#include "vtkMeshingStatistics.h"
#include "vtkNew.h"
#include "vtkUnstructuredGrid.h"

#include <chrono>
#include <thread>

using namespace testing;

namespace
{

using Clock = std::chrono::steady_clock;

double SecondsSince(Clock::time_point start)
{
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/** Takes seconds, so that there is something to stop. */
vtkSmartPointer<vtkImageToTetMeshFilter> MakeSlow(int threads)
{
  const auto filter = MakeFilter(MakeBall(14.0));
  filter->SetNumberOfThreads(threads);
  filter->SetDelta(0.25);
  filter->SetElementSize(0.3);
  return filter;
}

void TestProgress(int threads)
{
  const auto filter = MakeFilter(MakeTwoLabels(13.0));
  filter->SetDelta(0.8);
  filter->SetNumberOfThreads(threads);
  std::vector<double> fractions;
  bool sameThread = true;
  const auto caller = std::this_thread::get_id();
  const auto observer = Observe(filter,
    [&](vtkAlgorithm*, double fraction)
    {
      fractions.push_back(fraction);
      sameThread = sameThread && std::this_thread::get_id() == caller;
    });
  filter->Update();
  CheckMesh(filter);
  CHECK(sameThread);
  CHECK(fractions.size() >= 4, fractions.size());
  for (std::size_t i = 0; i < fractions.size(); ++i)
  {
    CHECK(fractions[i] >= 0.0 && fractions[i] <= 1.0, fractions[i]);
    CHECK(i == 0 || fractions[i] >= fractions[i - 1], i, fractions[i]);
  }
  CHECK(!fractions.empty() && fractions.back() == 1.0);
}

void CheckAborted(vtkImageToTetMeshFilter* filter)
{
  CHECK(filter->GetAborted());
  CHECK(filter->GetErrorMessage().empty(), filter->GetErrorMessage());
  CHECK(Empty(filter));
  CHECK(filter->GetStatistics()->GetNumberOfElements() == 0);
}

/** Aborting from a progress observer, at the start and in the midst of it. */
void TestAbortFromObserver(double at, int threads)
{
  const auto filter = MakeSlow(threads);
  const auto errors = vtkSmartPointer<ErrorCollector>::Take(ErrorCollector::New());
  errors->Watch(filter);
  Clock::time_point asked;
  bool hasAsked = false;
  bool sameThread = true;
  const auto caller = std::this_thread::get_id();
  const auto observer = Observe(filter,
    [&](vtkAlgorithm* algorithm, double fraction)
    {
      sameThread = sameThread && std::this_thread::get_id() == caller;
      if (fraction >= at && !hasAsked)
      {
        hasAsked = true;
        asked = Clock::now();
        algorithm->SetAbortExecute(1);
      }
    });
  filter->Update();
  CHECK(hasAsked, at);
  CHECK(sameThread);
  CHECK(SecondsSince(asked) < 1.0, at, threads, SecondsSince(asked));
  CheckAborted(filter);
  CHECK(errors->FromFilter.empty() && errors->FromOthers.empty());

  // Nothing is left over: asked again, the filter makes its whole mesh.
  filter->RemoveObserver(observer);
  filter->SetDelta(2.0);
  filter->SetElementSize(0.0);
  filter->Update();
  CHECK(!filter->GetAborted());
  CheckMesh(filter);
  filter->SetNumberOfThreads(1);
  filter->Update();
  const auto fresh = MakeFilter(MakeBall(14.0));
  fresh->SetDelta(2.0);
  fresh->Update();
  CHECK(SameMesh(filter->GetOutput(), fresh->GetOutput()));
}

void TestAbortFromThread(int threads)
{
  const auto filter = MakeSlow(threads);
  const auto start = Clock::now();
  std::thread user(
    [&]
    {
      std::this_thread::sleep_for(std::chrono::milliseconds(300));
      filter->SetAbortExecute(1);
    });
  filter->Update();
  const double took = SecondsSince(start);
  user.join();
  CheckAborted(filter);
  CHECK(took < 1.3, threads, took);
}

} // namespace

int TestTetMeshProgress(int, char*[])
{
  for (const int threads : { 1, 2, 8 })
  {
    TestProgress(threads);
  }
  for (const int threads : { 1, 8 })
  {
    TestAbortFromObserver(0.0, threads);
    TestAbortFromObserver(0.3, threads);
    TestAbortFromThread(threads);
  }
  return Result();
}
