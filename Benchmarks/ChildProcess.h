// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ChildProcess.h
 * @brief Runs each measurement in a separate process, so that its peak memory is measured
 * separately.
 */
#ifndef voxplex_ChildProcess_h
#define voxplex_ChildProcess_h

#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

namespace voxplex::benchmarks
{

/**
 * The largest resident set of this process so far, in bytes; 0 if /proc/self/status does not have
 * it.
 */
std::uint64_t PeakResidentBytes();

namespace detail
{
/**
 * Forks `copies` children at once. Each child calls body(context, result), sends `size` bytes of
 * result through a pipe, and exits. `results` receives the results in order. Waits for all
 * children.
 */
void RunInChildren(std::size_t copies, void (*body)(void* context, void* result), void* context,
  void* results, std::size_t size);
}

/**
 * Calls `function()` in several forked children at once and returns their results, which must be
 * trivially copyable.
 *
 * A child shares the parent's pages until it writes to them. Its peak memory starts with the pages
 * that are resident at the fork. So read the image once before, and every run has the same
 * baseline. Call this while the process has only one thread.
 * @throws std::runtime_error if a child failed; the child has written the reason to standard error
 */
template <typename Function>
auto RunInChildren(std::size_t copies, Function function)
{
  using Result = decltype(function());
  static_assert(std::is_trivially_copyable_v<Result>);
  static_assert(sizeof(Result) <= 4096, "a pipe holds this many bytes before they are read");
  std::vector<Result> results(copies);
  detail::RunInChildren(
    copies,
    [](void* context, void* r) { *static_cast<Result*>(r) = (*static_cast<Function*>(context))(); },
    &function, results.data(), sizeof(Result));
  return results;
}

/** As RunInChildren(), with one child. */
template <typename Function>
auto RunInChild(Function function)
{
  return RunInChildren(1, function).front();
}

} // namespace voxplex::benchmarks

#endif
