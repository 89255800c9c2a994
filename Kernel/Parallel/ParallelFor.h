// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ParallelFor.h
 * @brief A loop cut in chunks that threads take one after the other.
 */
#ifndef voxplex_ParallelFor_h
#define voxplex_ParallelFor_h

#include "Base/Error.h"

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

/** The number of threads meant by a request: 0 means all cores. */
inline unsigned NumberOfThreads(unsigned requested)
{
  return requested != 0 ? requested : std::max(1u, std::thread::hardware_concurrency());
}

/** @throws Cancelled if a stop was requested; otherwise costs an atomic load. */
inline void ThrowIfStopped(const std::stop_token& stop)
{
  if (stop.stop_requested())
  {
    throw Cancelled();
  }
}

/**
 * Calls function(first, last) on disjoint chunks that together cover [begin, end).
 *
 * Chunks have `grain` iterations (the last may have fewer) and are handed out dynamically, so that
 * uneven work balances. With one thread, or a single chunk, everything runs in the calling thread,
 * in order. The calling thread always takes part. Returns when all chunks are done.
 *
 * @param grain iterations of a chunk, at least 1
 * @param threads threads that take part, the caller's included; 0 means all cores
 * @param function callable as void(std::size_t first, std::size_t last), from several threads at
 * once
 * @param stop checked before each chunk; the default never stops
 * @throws Cancelled if a stop was requested before the last chunk was started; chunks that run are
 *   finished first
 * @throws the first exception that a chunk threw, after all threads have stopped; chunks that had
 *   not been started by then are not run. std::system_error never escapes: if a thread cannot be
 *   started, those that run do its work.
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
    // Relaxed: the counter only hands out numbers; the joins below order the chunks' results.
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
      // The machine gives us no more threads: go on with those that we have.
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
