// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ParallelFor.h
 * @brief A loop in chunks that several threads process.
 */
#ifndef voxplex_ParallelFor_h
#define voxplex_ParallelFor_h

#include "Base/Error.h"
#include "Parallel/ThreadTeam.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <stop_token>
#include <system_error>
#include <thread>
#include <vector>

namespace voxplex
{

/** The requested number of threads, or the number of cores if 0 is requested. */
inline unsigned NumberOfThreads(unsigned requested)
{
  return requested != 0 ? requested : std::max(1u, std::thread::hardware_concurrency());
}

/** Costs an atomic load. @throws Cancelled if a stop was requested */
inline void ThrowIfStopped(const std::stop_token& stop)
{
  if (stop.stop_requested())
  {
    throw Cancelled();
  }
}

/**
 * A grain for loops in which neighbouring iterations write to the same memory (by atomic
 * operations), such as the counts of their common vertices. Chunks are so large that threads seldom
 * work on neighbouring iterations. So cache lines seldom go from one thread to another.
 *
 * @param threads 0 means all cores
 * @param unit the result is a multiple of it
 */
inline std::size_t DistantGrain(std::size_t iterations, unsigned threads, std::size_t unit)
{
  constexpr std::size_t ChunksPerThread = 16; // so that uneven work balances
  const std::size_t chunks = ChunksPerThread * NumberOfThreads(threads);
  return std::max<std::size_t>(1, iterations / (chunks * unit)) * unit;
}

/**
 * Calls function(first, last) on disjoint chunks that together cover [begin, end).
 *
 * A chunk has `grain` iterations (the last chunk may have fewer). Threads take chunks dynamically,
 * so that uneven work balances. If there is one thread or one chunk, everything runs in the calling
 * thread, in order. The calling thread always takes part. Returns when all chunks are done.
 *
 * If the calling thread leads a ThreadTeam, the other threads are helpers of this team. Otherwise
 * they are started for this loop.
 *
 * @param grain iterations of a chunk, at least 1
 * @param threads threads that take part, the caller included; 0 means all cores
 * @param function callable as void(std::size_t first, std::size_t last), from several threads at
 *   the same time
 * @param stop checked before each chunk; the default never stops
 * @throws Cancelled if a stop was requested before the last chunk was started. Running chunks are
 *   finished first.
 * @throws the first exception of a chunk, after all threads have stopped. Chunks that had not been
 *   started by then are not run. If a thread cannot be started, the running threads do its work:
 *   its std::system_error does not escape.
 */
template <typename Function>
void ParallelFor(std::size_t begin, std::size_t end, std::size_t grain, unsigned threads,
  Function&& function, const std::stop_token& stop = {})
{
  if (begin >= end)
  {
    return;
  }
  grain = std::max<std::size_t>(grain, 1);
  const std::size_t chunks = (end - begin - 1) / grain + 1;
  const std::size_t workers = std::min<std::size_t>(NumberOfThreads(threads), chunks);

  std::atomic<std::size_t> nextChunk{ 0 };
  std::exception_ptr error;
  std::mutex errorMutex;
  auto work = [&]()
  {
    // Relaxed: the counter only hands out numbers. The joins below order the results of the chunks.
    for (std::size_t chunk = nextChunk.fetch_add(1, std::memory_order_relaxed); chunk < chunks;
         chunk = nextChunk.fetch_add(1, std::memory_order_relaxed))
    {
      const std::size_t first = begin + chunk * grain;
      try
      {
        ThrowIfStopped(stop);
        function(first, std::min(end, first + std::min(grain, end - first)));
      }
      catch (...)
      {
        const std::scoped_lock lock(errorMutex);
        if (!error)
        {
          error = std::current_exception();
        }
        nextChunk.store(chunks, std::memory_order_relaxed);
      }
    }
  };

  if (workers == 1)
  {
    work();
  }
  else if (ThreadTeam* const team = ThreadTeam::Idle())
  {
    team->Run(workers - 1, work);
  }
  else
  {
    std::vector<std::jthread> others;
    others.reserve(workers - 1);
    try
    {
      for (std::size_t i = 1; i < workers; ++i)
      {
        others.emplace_back(work);
      }
    }
    catch (const std::system_error&)
    {
      // The system cannot start more threads: go on with the threads that run.
    }
    work();
  } // joins
  if (error)
  {
    std::rethrow_exception(error);
  }
}

} // namespace voxplex

#endif
