// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CycleClock.h
 * @brief A clock that is cheap enough to be read twice in every operation.
 */
#ifndef voxplex_CycleClock_h
#define voxplex_CycleClock_h

#include <chrono>
#include <cstdint>

namespace voxplex
{

/**
 * @brief Counts ticks, and measures the length of a tick.
 *
 * On x86-64 the ticks are those of the processor's time stamp counter. This counter is the same on
 * all cores, and reading it is several times faster than reading the system's clock. On other
 * processors the ticks are those of std::chrono::steady_clock.
 */
class CycleClock
{
public:
  using Ticks = std::uint64_t;

  static Ticks Now()
  {
#if defined(__x86_64__) && defined(__GNUC__)
    return __builtin_ia32_rdtsc(); // <x86intrin.h> takes half a second to compile
#else
    return static_cast<Ticks>(std::chrono::steady_clock::now().time_since_epoch().count());
#endif
  }

  /** Length of a tick in seconds, averaged over the time since the clock's construction. */
  double SecondsPerTick() const
  {
    const double seconds = this->Seconds();
    const Ticks ticks = Now() - this->StartTicks;
    return ticks == 0 ? 0.0 : seconds / static_cast<double>(ticks);
  }

  /** Seconds since the clock's construction. */
  double Seconds() const
  {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - this->Start).count();
  }

private:
  std::chrono::steady_clock::time_point Start = std::chrono::steady_clock::now();
  Ticks StartTicks = Now();
};

} // namespace voxplex

#endif
