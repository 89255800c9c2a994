// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// vtkMeshingStatistics on figures that are made up: threads, sums, JSON, what is out of range.
#include "FilterTesting.h"

#include "Private/MeshingFigures.h"

#include "vtkMeshingStatistics.h"
#include "vtkNew.h"

#include <cmath>
#include <sstream>

using namespace testing;

namespace
{

/** Two threads; every figure differs from all others. */
void FillThreads(vtkMeshingStatistics* statistics)
{
  auto& run = statistics->Edit().Run;
  run.Threads.resize(2);
  run.Threads[0] = { 1001, 11, 21, 31, 0.5, 1.5, 2.5, { 41, 42, 43 }, 51, 71, 81 };
  run.Threads[1] = { 1002, 12, 22, 32, 0.25, 1.25, 2.25, { 44, 45, 46 }, 52, 72, 82 };
  run.Threads[1].Hardware = { 61, {}, 63 };
  run.Contention = voxplex::ContentionPolicy::Random;
  run.Balance = voxplex::BalancePolicy::Random;
  run.SwitchedToLocal = true;
  run.SeedingSeconds = 0.125;
}

void TestThreads()
{
  vtkNew<vtkMeshingStatistics> s;
  FillThreads(s);
  CHECK(s->GetNumberOfRefinementThreads() == 2);
  CHECK(s->GetThreadInsertions(0) == 1001 && s->GetThreadInsertions(1) == 1002);
  CHECK(s->GetThreadRemovals(0) == 11 && s->GetThreadRemovals(1) == 12);
  CHECK(s->GetThreadRollbacks(0) == 21 && s->GetThreadRollbacks(1) == 22);
  CHECK(s->GetThreadWaits(0) == 31 && s->GetThreadWaits(1) == 32);
  CHECK(s->GetThreadContentionTime(0) == 0.5 && s->GetThreadContentionTime(1) == 0.25);
  CHECK(s->GetThreadLoadBalanceTime(0) == 1.5 && s->GetThreadLoadBalanceTime(1) == 1.25);
  CHECK(s->GetThreadRollbackTime(0) == 2.5 && s->GetThreadRollbackTime(1) == 2.25);
  for (int level = 0; level < 3; ++level)
  {
    CHECK(s->GetThreadReceived(0, level) == 41 + level, level);
    CHECK(s->GetThreadReceived(1, level) == 44 + level, level);
    CHECK(s->GetReceived(level) == 85 + 2 * level, level);
  }
  CHECK(s->GetThreadReceivedElements(0) == 51 && s->GetThreadReceivedElements(1) == 52);

  CHECK(s->GetRollbacks() == 43 && s->GetWaits() == 63 && s->GetReceivedElements() == 103);
  CHECK(s->GetContentionTime() == 0.75);
  CHECK(s->GetLoadBalanceTime() == 2.75);
  CHECK(s->GetRollbackTime() == 4.75);
  CHECK(s->GetSwitchedToLocal() && s->GetSeedingTime() == 0.125);

  std::ostringstream text;
  s->Print(text);
  for (const char* line : { "NumberOfRefinementThreads: 2", "Rollbacks: 43", "SwitchedToLocal: 1" })
  {
    CHECK(text.str().find(line) != std::string::npos, line);
  }
}

/** Quality, cavities and slivers of a 4D run, by getter and in the JSON. */
void TestQuality()
{
  vtkNew<vtkMeshingStatistics> s;
  CHECK(s->GetDimension() == 3);
  CHECK(std::isnan(s->GetShortestEdge()) && std::isnan(s->GetMeanCavitySize()));
  CHECK(s->ToJSON().find(R"("cavities":{"mean":null,"largest":0})") != std::string::npos);

  auto& figures = s->Edit();
  figures.Dimension = 4;
  figures.HasQuality = true;
  auto& quality = figures.Quality;
  quality.ShortestEdge = 0.5;
  quality.MeanRadiusEdgeRatio = 1.25;
  quality.RadiusEdgeRatioDeviation = 0.125;
  quality.MeanNormalizedVolume = 0.375;
  quality.NormalizedVolumeDeviation = 0.0625;
  for (std::size_t i = 0; i < quality.NormalizedVolumes.size(); ++i)
  {
    quality.NormalizedVolumes[i] = 100 + i;
  }
  auto& rules = figures.Run.Rules;
  rules.Fired = { 1, 2, 3, 4, 5 };
  rules.FiredBySize = 1;
  rules.CavitySimplices = 40;
  rules.LargestCavity = 9;
  rules.SliversFound = 71;
  rules.PicksTried = 72;
  rules.SliversKept = 73;

  CHECK(s->GetDimension() == 4);
  CHECK(s->GetShortestEdge() == 0.5);
  CHECK(s->GetMeanRadiusEdgeRatio() == 1.25 && s->GetRadiusEdgeRatioDeviation() == 0.125);
  CHECK(s->GetMeanNormalizedVolume() == 0.375 && s->GetNormalizedVolumeDeviation() == 0.0625);
  CHECK(s->GetNumberOfNormalizedVolumeBins() == 20);
  for (int i = 0; i < 20; ++i)
  {
    CHECK(s->GetNormalizedVolumeBin(i) == 100 + i, i);
  }
  CHECK(s->GetNormalizedVolumeBin(-1) == 0 && s->GetNormalizedVolumeBin(20) == 0);
  CHECK(s->GetFiredBySize() == 1);
  CHECK(s->GetMeanCavitySize() == 2.5 && s->GetLargestCavity() == 9);
  CHECK(s->GetSliversFound() == 71 && s->GetPicksTried() == 72 && s->GetSliversKept() == 73);

  const std::string json = s->ToJSON();
  for (const char* part : { R"({"dimension":4,"elements":)", R"("shortest_edge":0.5,)",
         R"("mean_radius_edge":1.25,"radius_edge_deviation":0.125,)",
         R"("mean_normalized_volume":0.375,"normalized_volume_deviation":0.0625,)"
         R"("normalized_volume_histogram":[100,101,)",
         R"("R5":5,"R6":0,"R7_split":0,"R7_sampled":0,"size":1,)",
         R"("cavities":{"mean":2.5,"largest":9},)"
         R"("slivers":{"found":71,"picks":72,"kept":73})" })
  {
    CHECK(json.find(part) != std::string::npos, part, json);
  }
  std::ostringstream text;
  s->Print(text);
  CHECK(text.str().find("Dimension: 4") != std::string::npos);
}

/** Sums over threads add up; the largest cavity is the largest of all. */
void TestSumOfRules()
{
  voxplex::RuleStatistics a;
  a.CavitySimplices = 1;
  a.LargestCavity = 20;
  a.SliversFound = 3;
  a.PicksTried = 4;
  a.SliversKept = 5;
  voxplex::RuleStatistics b = a;
  b.LargestCavity = 10;
  a += b;
  CHECK(a.CavitySimplices == 2 && a.LargestCavity == 20);
  CHECK(a.SliversFound == 6 && a.PicksTried == 8 && a.SliversKept == 10);
  b += a;
  CHECK(b.LargestCavity == 20);
}

/** An index out of range is 0, not a crash; so is everything after Initialize(). */
void TestRange()
{
  vtkNew<vtkMeshingStatistics> s;
  FillThreads(s);
  for (const int thread : { -1, 2, VTK_INT_MAX, VTK_INT_MIN })
  {
    CHECK(s->GetThreadInsertions(thread) == 0 && s->GetThreadRemovals(thread) == 0, thread);
    CHECK(s->GetThreadRollbacks(thread) == 0 && s->GetThreadWaits(thread) == 0, thread);
    CHECK(s->GetThreadContentionTime(thread) == 0.0, thread);
    CHECK(s->GetThreadLoadBalanceTime(thread) == 0.0, thread);
    CHECK(s->GetThreadRollbackTime(thread) == 0.0, thread);
    CHECK(s->GetThreadReceived(thread, 0) == 0, thread);
    CHECK(s->GetThreadReceivedElements(thread) == 0, thread);
  }
  for (const int level : { -1, 3, VTK_INT_MAX })
  {
    CHECK(s->GetThreadReceived(0, level) == 0 && s->GetReceived(level) == 0, level);
  }

  const vtkMTimeType before = s->GetMTime();
  s->Initialize();
  CHECK(s->GetMTime() > before);
  CHECK(s->GetNumberOfRefinementThreads() == 0 && s->GetThreadInsertions(0) == 0);
  CHECK(s->GetRollbacks() == 0 && s->GetContentionTime() == 0.0 && s->GetReceived(0) == 0);
  CHECK(!s->GetSwitchedToLocal() && s->GetSeedingTime() == 0.0);
  CHECK(s->ToJSON().find("\"thread_statistics\":[]") != std::string::npos);
}

void TestJSON()
{
  vtkNew<vtkMeshingStatistics> s;
  FillThreads(s);
  const std::string json = s->ToJSON();
  for (const char* part : { R"("contention":"random","balance":"rws","switched_to_local":true,)"
                            R"("seeding_seconds":0.125)",
         R"("thread_statistics":[{"insertions":1001,"removals":11,"rollbacks":21,"waits":31,)"
         R"("contention_seconds":0.5,"load_balance_seconds":1.5,"rollback_seconds":2.5,)"
         R"("received":[41,42,43],"received_elements":51,)"
         R"("helped_loops":71,"helped_iterations":81},{"insertions":1002,)",
         R"("received":[44,45,46],"received_elements":52,)"
         R"("helped_loops":72,"helped_iterations":82,)"
         R"("tlb_misses":61,"resource_stall_cycles":63}])" })
  {
    CHECK(json.find(part) != std::string::npos, part, json);
  }
}

} // namespace

int TestMeshingStatistics(int, char*[])
{
  TestThreads();
  TestQuality();
  TestSumOfRules();
  TestRange();
  TestJSON();
  return Result();
}
