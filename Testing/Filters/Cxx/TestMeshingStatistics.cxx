// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// vtkMeshingStatistics on figures that are made up: threads, sums, JSON, what is out of range.
#include "FilterTesting.h"

#include "Mesher/MeshingStatistics.h"

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
  auto& run = statistics->Edit();
  run.Threads.resize(2);
  run.Threads[0] = { 1001, 11, 21, 31, 0.5, 1.5, 2.5, { 41, 42, 43 }, 51, 71, 81, 3.5 };
  run.Threads[1] = { 1002, 12, 22, 32, 0.25, 1.25, 2.25, { 44, 45, 46 }, 52, 72, 82, 3.25 };
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
  CHECK(s->GetFigure("/thread_statistics") == 2.0);
  CHECK(s->GetFigure("/thread_statistics/0/insertions") == 1001.0);
  CHECK(s->GetFigure("/thread_statistics/1/insertions") == 1002.0);
  CHECK(s->GetFigure("/thread_statistics/1/received/2") == 46.0);
  CHECK(s->GetFigure("/thread_statistics/1/rollback_seconds") == 2.25);
  CHECK(s->GetSwitchedToLocal() && s->GetFigure("/seeding_seconds") == 0.125);

  std::ostringstream text;
  s->Print(text);
  for (const char* line : { "NumberOfRuns: 0", "SwitchedToLocal: 1", "\"insertions\":1002" })
  {
    CHECK(text.str().find(line) != std::string::npos, line);
  }
}

/** Quality, cavities and slivers of a 4D run, by getter and in the JSON. */
void TestQuality()
{
  vtkNew<vtkMeshingStatistics> s;
  CHECK(s->GetDimension() == 3);
  CHECK(std::isnan(s->GetFigure("/quality")) && std::isnan(s->GetFigure("/cavities/mean")));
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
  auto& rules = figures.Rules;
  rules.Fired = { 1, 2, 3, 4, 5 };
  rules.FiredBySize = 1;
  rules.CavitySimplices = 40;
  rules.LargestCavity = 9;
  rules.SliversFound = 71;
  rules.PicksTried = 72;
  rules.SliversKept = 73;

  CHECK(s->GetDimension() == 4);
  CHECK(s->GetFigure("/quality/shortest_edge") == 0.5);
  CHECK(s->GetFigure("/quality/mean_radius_edge") == 1.25 &&
    s->GetFigure("/quality/radius_edge_deviation") == 0.125);
  CHECK(s->GetFigure("/quality/mean_normalized_volume") == 0.375 &&
    s->GetFigure("/quality/normalized_volume_deviation") == 0.0625);
  CHECK(s->GetFigure("/quality/normalized_volume_histogram") == 20);
  CHECK(s->GetFigure("/quality/normalized_volume_histogram/19") == 119);
  CHECK(s->GetFigure("/rules/size") == 1);
  CHECK(s->GetFigure("/cavities/mean") == 2.5 && s->GetFigure("/cavities/largest") == 9);
  CHECK(s->GetFigure("/slivers/found") == 71 && s->GetFigure("/slivers/picks") == 72 &&
    s->GetFigure("/slivers/kept") == 73);

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

/** A figure that does not exist is NaN, not a crash. After Initialize() all figures are zero. */
void TestRange()
{
  vtkNew<vtkMeshingStatistics> s;
  FillThreads(s);
  for (const char* path : { "/thread_statistics/2/insertions", "/thread_statistics/-1/insertions",
         "/thread_statistics/x", "/nothing", "nothing", "/delta/", "/contention", "~2", "/~" })
  {
    CHECK(std::isnan(s->GetFigure(path)), path, s->GetFigure(path));
  }
  CHECK(s->GetFigure("") > 20.0 && s->GetFigure(nullptr) == s->GetFigure("")); // all entries
  CHECK(s->GetFigure("/switched_to_local") == 1.0);

  const vtkMTimeType before = s->GetMTime();
  s->Initialize();
  CHECK(s->GetMTime() > before);
  CHECK(s->GetFigure("/thread_statistics") == 0.0);
  CHECK(!s->GetSwitchedToLocal() && s->GetFigure("/seeding_seconds") == 0.0);
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
         R"("helped_loops":71,"helped_iterations":81,"helping_seconds":3.5},{"insertions":1002,)",
         R"("received":[44,45,46],"received_elements":52,)"
         R"("helped_loops":72,"helped_iterations":82,"helping_seconds":3.25,)"
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
