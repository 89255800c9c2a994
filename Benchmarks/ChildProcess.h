// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ChildProcess.h
 * @brief Runs one measurement in a process of its own, so that its peak memory is its own.
 */
#ifndef voxplex_ChildProcess_h
#define voxplex_ChildProcess_h

#include <cstdint>
#include <type_traits>

namespace voxplex::benchmarks
{

/** Largest resident set of this process so far, in bytes; 0 where /proc/self/status does not say.
 */
std::uint64_t PeakResidentBytes();

namespace detail
{
/** Forks; the child calls body(context, result), sends the result through a pipe and exits. */
void RunInChild(
  void (*body)(void* context, void* result), void* context, void* result, std::size_t size);
}

/**
 * Calls `function()` in a forked child and returns its result, which must be trivially copyable.
 *
 * The child shares the parent's pages until it writes to them, and starts with a peak equal to what
 * is resident then: read the image before, once, and every run has the same baseline. Call it while
 * the process has one thread.
 * @throws std::runtime_error if the child failed; the child has then written why to standard error
 */
template <typename Function>
auto RunInChild(Function function)
{
  using Result = decltype(function());
  static_assert(std::is_trivially_copyable_v<Result>);
  Result result{};
  detail::RunInChild([](void* context, void* r)
    { *static_cast<Result*>(r) = (*static_cast<Function*>(context))(); },
    &function, &result, sizeof(Result));
  return result;
}

} // namespace voxplex::benchmarks

#endif
