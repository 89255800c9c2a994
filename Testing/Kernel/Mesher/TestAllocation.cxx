// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// If any one allocation of a run fails, Run() throws std::bad_alloc or does without it. It does not
// hang, crash or leak, and the next run works. A program of its own, since it replaces operator new.
#include "Image/FacesNear.h"
#include "Image/SurfaceVoxels.h"
#include "MeshChecks.h"
#include "MeshRuns.h"
#include "Phantoms.h"
#include "Sanitizers.h"
#include "ThreadTesting.h"
#include "TriangulationChecks.h"

#include <gtest/gtest.h>

#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <new>
#include <random>
#include <string>
#include <thread>
#include <vector>

namespace
{

constexpr std::int64_t Never = std::numeric_limits<std::int64_t>::max();

/** Allocations until the one that fails. */
std::atomic<std::int64_t> Countdown{ Never };
std::atomic<std::int64_t> Allocations{ 0 };
std::atomic<std::uint64_t> AllocatedBytes{ 0 };
/** This thread's allocations neither fail nor count down. */
thread_local bool Spared = false;

void* Allocate(std::size_t size, std::size_t alignment)
{
  Allocations.fetch_add(1, std::memory_order_relaxed);
  AllocatedBytes.fetch_add(size, std::memory_order_relaxed);
  if (!Spared && Countdown.load(std::memory_order_relaxed) != Never &&
    Countdown.fetch_sub(1, std::memory_order_relaxed) == 1)
  {
    return nullptr;
  }
  if (alignment <= alignof(std::max_align_t))
  {
    return std::malloc(size == 0 ? 1 : size);
  }
  return std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
}

void* AllocateOrThrow(std::size_t size, std::size_t alignment)
{
  void* const memory = Allocate(size, alignment);
  if (!memory)
  {
    throw std::bad_alloc();
  }
  return memory;
}

/** Not inlined: seen from inside, compilers take malloc and free for a mismatch of new and free. */
[[gnu::noinline]] void Release(void* memory) noexcept
{
  std::free(memory);
}

constexpr std::size_t Plain = alignof(std::max_align_t);

} // namespace

// clang-format off
void* operator new(std::size_t n) { return AllocateOrThrow(n, Plain); }
void* operator new[](std::size_t n) { return AllocateOrThrow(n, Plain); }
void* operator new(std::size_t n, std::align_val_t a) { return AllocateOrThrow(n, static_cast<std::size_t>(a)); }
void* operator new[](std::size_t n, std::align_val_t a) { return AllocateOrThrow(n, static_cast<std::size_t>(a)); }
void* operator new(std::size_t n, const std::nothrow_t&) noexcept { return Allocate(n, Plain); }
void* operator new[](std::size_t n, const std::nothrow_t&) noexcept { return Allocate(n, Plain); }
void* operator new(std::size_t n, std::align_val_t a, const std::nothrow_t&) noexcept { return Allocate(n, static_cast<std::size_t>(a)); }
void* operator new[](std::size_t n, std::align_val_t a, const std::nothrow_t&) noexcept { return Allocate(n, static_cast<std::size_t>(a)); }
void operator delete(void* p) noexcept { Release(p); }
void operator delete[](void* p) noexcept { Release(p); }
void operator delete(void* p, std::size_t) noexcept { Release(p); }
void operator delete[](void* p, std::size_t) noexcept { Release(p); }
void operator delete(void* p, std::align_val_t) noexcept { Release(p); }
void operator delete[](void* p, std::align_val_t) noexcept { Release(p); }
void operator delete(void* p, std::size_t, std::align_val_t) noexcept { Release(p); }
void operator delete[](void* p, std::size_t, std::align_val_t) noexcept { Release(p); }
void operator delete(void* p, const std::nothrow_t&) noexcept { Release(p); }
void operator delete[](void* p, const std::nothrow_t&) noexcept { Release(p); }
void operator delete(void* p, std::align_val_t, const std::nothrow_t&) noexcept { Release(p); }
void operator delete[](void* p, std::align_val_t, const std::nothrow_t&) noexcept { Release(p); }
// clang-format on

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
/** For the kernel's AllocatePages(). The C library's own calls do not come here. */
extern "C" void* mmap(
  void* at, std::size_t size, int protection, int flags, int file, off_t offset) noexcept
{
  Allocations.fetch_add(1, std::memory_order_relaxed);
  AllocatedBytes.fetch_add(size, std::memory_order_relaxed);
  if (!Spared && Countdown.load(std::memory_order_relaxed) != Never &&
    Countdown.fetch_sub(1, std::memory_order_relaxed) == 1)
  {
    return MAP_FAILED;
  }
  return reinterpret_cast<void*>(syscall(SYS_mmap, at, size, protection, flags, file, offset));
}
#endif

namespace voxplex
{
namespace
{

MeshingOptions<3> Options(unsigned threads)
{
  MeshingOptions<3> options = checks::WithDelta<3>(0.7);
  options.Team.Threads = threads;
  return options;
}

struct Result
{
  bool Done;
  std::int64_t Allocations;
};

/** A run whose n-th allocation fails. */
Result RunWithFailure(const LabelImage<3>& image, const MeshingOptions<3>& options, std::int64_t n)
{
  SimplexMesh<3> mesh;
  Result result{ false, 0 };
  {
    ImageMesher<3> mesher(options);
    const std::int64_t before = Allocations;
    Countdown = n;
    try
    {
      const MeshingOutcome outcome = mesher.Run(image, mesh);
      Countdown = Never;
      result.Allocations = Allocations - before;
      EXPECT_EQ(outcome, MeshingOutcome::Done) << "nobody cancelled it";
      result.Done = true;
    }
    catch (const std::bad_alloc&)
    {
      // as it should
    }
    Countdown = Never;
  }
  if (result.Done)
  {
    checks::ExpectSound(mesh);
    EXPECT_FALSE(mesh.Simplices.empty());
  }
  return result;
}

void FailEverywhere(const MeshingOptions<3>& options)
{
  const LabelImage<3> image = phantoms::NestedBalls(4.0);
  const Result unhindered = RunWithFailure(image, options, Never);
  ASSERT_TRUE(unhindered.Done);
  const std::int64_t all = unhindered.Allocations;
  const std::int64_t step = Sanitized ? 4 : 1;
  std::int64_t failures = 0;
  for (std::int64_t n = 1; n <= all; n += step)
  {
    const std::string name =
      std::to_string(options.Team.Threads) + " threads, failure at allocation " + std::to_string(n);
    SCOPED_TRACE(name);
    const testing::Watchdog watchdog(name);
    failures += RunWithFailure(image, options, n).Done ? 0 : 1;
    if (n % 16 == 1)
    {
      EXPECT_TRUE(RunWithFailure(image, options, Never).Done) << "afterwards all is well";
    }
  }
  // Threads may happen to make fewer allocations; one makes the same in each run.
  EXPECT_GE(failures, (options.Team.Threads == 1 ? 1.0 : 0.5) * static_cast<double>(all / step));
}

} // namespace

TEST(Allocation, AnyMayFailInOneThread)
{
  FailEverywhere(Options(1));
}

TEST(Allocation, AnyMayFailInFourThreads)
{
  FailEverywhere(Options(4));
}

TEST(Allocation, AnyMayFailInFourPinnedThreads)
{
  MeshingOptions<3> options = Options(4);
  options.Team.Pin = true;
  FailEverywhere(options);
}

// Balls that all contain the same faces must not list them once each: memory grows with balls and faces, not with
// their product.
TEST(Allocation, OverlappingBallsShareTheirFaces)
{
  const LabelImage<3> image = phantoms::Ball(12.0);
  const BitMask<3> sites = FindSurfaceVoxels(image, 1, {});
  const Point<3> middle = { 16.0, 16.0, 16.0 };
  const std::size_t faces =
    FindFacesNear<3>(image, sites, std::vector<SearchBall<3>>{ { middle, 100.0 } }, {}).size();
  ASSERT_GT(faces, 2000u);
  for (const double radius : { 12.0, 30.0, 1000.0 })
  {
    const std::vector<SearchBall<3>> balls(5000, { middle, radius });
    const std::uint64_t before = AllocatedBytes;
    EXPECT_LE(FindFacesNear<3>(image, sites, balls, {}).size(), faces);
    EXPECT_LT(AllocatedBytes - before, 100 * sizeof(VoxelFace<3>) * (faces + balls.size()));
  }
}

// What Insert() and Remove() promise. Fresh workers allocate most, and use up ids fastest.
TEST(Allocation, AFailedOperationLeavesTheTriangulationAsItWas)
{
  Triangulation<3> t(checks::UnitBox<3>(1.0));
  std::mt19937 random(1);
  int failures = 0;
  for (const Point<3>& p : checks::RandomPoints<3>(150, 1.0, random))
  {
    Triangulation<3>::Worker alone(t);
    const SimplexId seed = t.FindConflict(alone, p, checks::AnyAlive(t));
    const checks::SimplexSet<3> before = checks::Simplices(t);
    const std::size_t vertices = checks::Points(t).size();
    VertexId v = None;
    for (std::int64_t n = 1; v == None; ++n)
    {
      Triangulation<3>::Worker worker(t);
      Countdown = n;
      try
      {
        const InsertionOutcome outcome = t.Insert(worker, p, VertexKind::Free, seed);
        Countdown = Never;
        ASSERT_EQ(outcome, InsertionOutcome::Inserted);
        v = worker.NewVertex;
      }
      catch (const std::bad_alloc&)
      {
        Countdown = Never;
        ++failures;
        ASSERT_EQ(checks::Points(t).size(), vertices);
        if (vertices < 40 || n % 8 == 1)
        {
          ASSERT_TRUE(checks::Simplices(t) == before);
          checks::ExpectSound(t);
        }
      }
    }
    bool removed = false;
    for (std::int64_t n = 1; !removed && failures % 3 == 0; ++n)
    {
      const checks::SimplexSet<3> with = checks::Simplices(t);
      Triangulation<3>::Worker worker(t);
      Countdown = n;
      try
      {
        const RemovalOutcome outcome = t.Remove(worker, v);
        Countdown = Never;
        ASSERT_EQ(outcome, RemovalOutcome::Removed);
        ASSERT_TRUE(checks::Simplices(t) == before);
        removed = true;
      }
      catch (const std::bad_alloc&)
      {
        Countdown = Never;
        ++failures;
        ASSERT_TRUE(checks::Simplices(t) == with);
      }
    }
    checks::ExpectSound(t);
  }
  EXPECT_GT(failures, 100);
}

// The same when a thread waits to help: the cavity is then collected level by level.
TEST(Allocation, AFailedInsertionWithHelpLeavesTheTriangulationAsItWas)
{
  const testing::Watchdog watchdog("failures with help");
  Triangulation<4> t(checks::UnitBox<4>(1.0));
  Triangulation<4>::Worker helper(t, 2);
  LoopSharing sharing(2, std::numeric_limits<unsigned>::max());
  std::atomic<bool> over{ false };
  const std::jthread helping(
    [&]()
    {
      Spared = true;
      sharing.HelpUntil(1, [&over]() { return over.load(); });
    });
  EXPECT_TRUE(testing::Soon([&]() { return sharing.SomeoneIdle(); }));
  std::mt19937 random(1);
  int failures = 0;
  for (const Point<4>& p : checks::RandomPoints<4>(40, 1.0, random))
  {
    Triangulation<4>::Worker alone(t);
    const SimplexId seed = t.FindConflict(alone, p, checks::AnyAlive(t));
    const checks::SimplexSet<4> before = checks::Simplices(t);
    bool inserted = false;
    for (std::int64_t n = 1; !inserted; ++n)
    {
      Triangulation<4>::Worker worker(t, 1);
      std::vector<Triangulation<4>::Worker*> team = { &worker, &helper };
      worker.Help = { &sharing, 0, &team, 1, 1, 1 };
      EXPECT_EQ(t.Lock(worker, seed, t.State(seed).Generation), LockOutcome::Locked);
      Countdown = n;
      try
      {
        const InsertionOutcome outcome = t.Insert(worker, p, VertexKind::Free, seed);
        Countdown = Never;
        EXPECT_EQ(outcome, InsertionOutcome::Inserted);
        inserted = true;
      }
      catch (const std::bad_alloc&)
      {
        Countdown = Never;
        ++failures;
        EXPECT_TRUE(checks::Simplices(t) == before);
      }
      t.Unlock(worker);
    }
  }
  over = true;
  checks::ExpectSound(t);
  EXPECT_GT(failures, 100);
}

} // namespace voxplex
