// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ChildProcess.h
 * @brief Runs one measurement in a process of its own, so that its peak memory is its own.
 */
#ifndef voxplex_ChildProcess_h
#define voxplex_ChildProcess_h

#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

namespace voxplex::benchmarks
{

/** Largest resident set of this process so far, in bytes; 0 where /proc/self/status does not say.
 */
std::uint64_t PeakResidentBytes();

namespace detail
{
/** Forks `copies` children at once; each calls body(context, result), where result has `size` bytes,
 * sends that through a pipe and exits. results receives one after another; waits for all. */
void RunInChildren(std::size_t copies, void (*body)(void* context, void* result), void* context,
  void* results, std::size_t size);
}

/**
 * Calls `function()` in several forked children at once and returns their results, which must be
 * trivially copyable.
 *
 * A child shares the parent's pages until it writes to them, and starts with a peak equal to what
 * is resident then: read the image before, once, and every run has the same baseline. Call it while
 * the process has one thread.
 * @throws std::runtime_error if a child failed; that has then written why to standard error
 */
template <typename Function>
auto RunInChildren(std::size_t copies, Function function)
{
  using Result = decltype(function());
  static_assert(std::is_trivially_copyable_v<Result>);
  static_assert(sizeof(Result) <= 4096, "what a pipe surely holds before anybody reads");
  std::vector<Result> results(copies);
  detail::RunInChildren(
    copies,
    [](void* context, void* r) { *static_cast<Result*>(r) = (*static_cast<Function*>(context))(); },
    &function, results.data(), sizeof(Result));
  return results;
}

/** As RunInChildren(), with one. */
template <typename Function>
auto RunInChild(Function function)
{
  return RunInChildren(1, function).front();
}

} // namespace voxplex::benchmarks

#endif
