// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/ParallelFor.h"

#include "Parallel/ChunkShares.h"
#include "Parallel/ThreadTeam.h"

#include <algorithm>
#include <exception>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>
#include <vector>

namespace voxplex::detail
{
namespace
{

/**
 * Calls function(chunk) for the chunks of a loop, in several threads. See ParallelFor().
 * @param workers the number of threads; thread w has share w, or the only one
 */
void RunChunks(ChunkShares& shares, std::size_t workers, const LoopFunction<std::size_t>& function,
  const std::stop_token& stop)
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

} // namespace

//------------------------------------------------------------------------------------------------
void RunLoop(std::size_t begin, std::size_t end, std::size_t grain, unsigned threads,
  const LoopFunction<std::size_t, std::size_t>& function, const std::stop_token& stop)
{
  if (begin >= end)
  {
    return;
  }
  grain = std::max<std::size_t>(grain, 1);
  const std::size_t chunks = (end - begin - 1) / grain + 1;
  const std::size_t workers = std::min<std::size_t>(NumberOfThreads(threads), chunks);
  ChunkShares shares(chunks, workers);
  const auto runChunk = [&](std::size_t chunk)
  {
    const std::size_t first = begin + chunk * grain;
    function(first, std::min(end, first + std::min(grain, end - first)));
  };
  RunChunks(shares, workers, LoopFunction<std::size_t>(runChunk), stop);
}

void RunTasks(std::size_t count, unsigned threads, const LoopFunction<std::size_t>& function,
  const std::stop_token& stop)
{
  if (count != 0)
  {
    ChunkShares shares(count, 1);
    RunChunks(shares, std::min<std::size_t>(NumberOfThreads(threads), count), function, stop);
  }
}

} // namespace voxplex::detail
