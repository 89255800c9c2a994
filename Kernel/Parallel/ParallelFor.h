// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ParallelFor.h
 * @brief A loop in chunks that several threads process.
 */
#ifndef voxplex_ParallelFor_h
#define voxplex_ParallelFor_h

#include "Base/Error.h"
#include "Parallel/ChunkShares.h"
#include "Parallel/ThreadTeam.h"

#include <algorithm>
#include <cstddef>
#include <exception>
#include <mutex>
#include <optional>
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

namespace detail
{

/**
 * Calls function(chunk) for the chunks of a loop, in several threads. See ParallelFor().
 * @param workers the number of threads; thread w has share w, or the only one
 */
template <typename Function>
void RunChunks(
  ChunkShares& shares, std::size_t workers, const Function& function, const std::stop_token& stop)
{
  std::exception_ptr error;
  std::mutex errorMutex;
  auto work = [&](std::size_t worker)
  {
    while (const std::optional<std::size_t> chunk = shares.Take(worker))
    {
      try
      {
        ThrowIfStopped(stop);
        function(*chunk);
      }
      catch (...)
      {
        const std::scoped_lock lock(errorMutex);
        if (!error)
        {
          error = std::current_exception();
        }
        shares.Clear();
      }
    }
  };

  if (workers == 1)
  {
    work(0);
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
      for (std::size_t w = 1; w < workers; ++w)
      {
        others.emplace_back(work, w);
      }
    }
    catch (const std::system_error&)
    {
      // The system cannot start more threads: go on with the threads that run.
    }
    work(0);
  } // joins
  if (error)
  {
    std::rethrow_exception(error);
  }
}

} // namespace detail

/**
 * Calls function(first, last) on disjoint chunks that together cover [begin, end).
 *
 * A chunk has `grain` iterations (the last chunk may have fewer). Each thread begins with a part of
 * the range of its own, and then takes chunks of others', so that uneven work balances
 * (ChunkShares). If there is one thread or one chunk, everything runs in the calling thread, in
 * order. The calling thread always takes part. Returns when all chunks are done.
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
  ChunkShares shares(chunks, workers);
  detail::RunChunks(
    shares, workers,
    [&](std::size_t chunk)
    {
      const std::size_t first = begin + chunk * grain;
      function(first, std::min(end, first + std::min(grain, end - first)));
    },
    stop);
}

/**
 * Calls function(task) for the tasks 0 ... count - 1. A thread that is free begins the first one
 * that has not begun. If the largest tasks come first, no thread has a large one to do at the end.
 *
 * For the other parameters and exceptions, see ParallelFor().
 */
template <typename Function>
void ParallelTasks(
  std::size_t count, unsigned threads, Function&& function, const std::stop_token& stop = {})
{
  if (count != 0)
  {
    ChunkShares shares(count, 1);
    detail::RunChunks(
      shares, std::min<std::size_t>(NumberOfThreads(threads), count), function, stop);
  }
}

} // namespace voxplex

#endif
