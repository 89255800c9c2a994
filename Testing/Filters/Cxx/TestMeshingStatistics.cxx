// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// vtkMeshingStatistics on figures that are made up: threads, sums, JSON, what is out of range.
#include "FilterTesting.h"

#include "Private/MeshingFigures.h"

#include "vtkMeshingStatistics.h"
#include "vtkNew.h"

#include <sstream>

using namespace testing;

namespace
{

/** Two threads; every figure differs from all others. */
void FillThreads(vtkMeshingStatistics* statistics)
{
  auto& run = statistics->Edit().Run;
  run.Threads.resize(2);
  run.Threads[0] = { 1001, 11, 21, 31, 0.5, 1.5, 2.5, { 41, 42, 43 }, 51 };
  run.Threads[1] = { 1002, 12, 22, 32, 0.25, 1.25, 2.25, { 44, 45, 46 }, 52 };
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
  CHECK(s->ToJSON().find("\"thread_statistics\": []") != std::string::npos);
}

void TestJSON()
{
  vtkNew<vtkMeshingStatistics> s;
  FillThreads(s);
  const std::string json = s->ToJSON();
  for (const char* part :
    { R"("contention": "random", "balance": "rws", "switched_to_local": true, )"
      R"("seeding_seconds": 0.125)",
      R"("thread_statistics": [{"insertions": 1001, "removals": 11, "rollbacks": 21, "waits": 31, )"
      R"("contention_seconds": 0.5, "load_balance_seconds": 1.5, "rollback_seconds": 2.5, )"
      R"("received": [41, 42, 43], "received_elements": 51}, {"insertions": 1002, )",
      R"("received": [44, 45, 46], "received_elements": 52, )"
      R"("tlb_misses": 61, "resource_stall_cycles": 63}])" })
  {
    CHECK(json.find(part) != std::string::npos, part, json);
  }
}

} // namespace

int TestMeshingStatistics(int, char*[])
{
  TestThreads();
  TestRange();
  TestJSON();
  return Result();
}
