// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ParallelFor.h
 * @brief A loop in chunks that several threads process.
 */
#ifndef voxplex_ParallelFor_h
#define voxplex_ParallelFor_h

#include "Base/Error.h"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <stop_token>
#include <thread>

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

/** A function of a loop without its type. The code that runs loops is not a template, and is compiled once. */
template <typename... Arguments>
class LoopFunction
{
public:
  /** @param function must outlive this */
  template <typename Function>
  explicit LoopFunction(const Function& function)
    : Data(std::addressof(function))
    , Call([](const void* data, Arguments... arguments)
        { (*static_cast<const Function*>(data))(arguments...); })
  {
  }
  void operator()(Arguments... arguments) const { this->Call(this->Data, arguments...); }

private:
  const void* Data;
  void (*Call)(const void* data, Arguments... arguments);
};

void RunLoop(std::size_t begin, std::size_t end, std::size_t grain, unsigned threads,
  const LoopFunction<std::size_t, std::size_t>& function, const std::stop_token& stop);
void RunTasks(std::size_t count, unsigned threads, const LoopFunction<std::size_t>& function,
  const std::stop_token& stop);

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
  detail::RunLoop(
    begin, end, grain, threads, detail::LoopFunction<std::size_t, std::size_t>(function), stop);
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
  detail::RunTasks(count, threads, detail::LoopFunction<std::size_t>(function), stop);
}

} // namespace voxplex

#endif
