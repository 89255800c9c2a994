// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file HardwareCounters.h
 * @brief What a thread costs the processor (thesis, table 3.5).
 */
#ifndef voxplex_HardwareCounters_h
#define voxplex_HardwareCounters_h

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace voxplex
{

/**
 * @brief Counts events of the processor that the calling thread causes, where PAPI is built in and
 * the machine lets us; elsewhere every count is empty.
 *
 * All methods of an object, its destructor too, are for one thread. Different threads may use
 * different objects at the same time. Needs VOXPLEX_USE_PAPI; virtual machines often have no
 * counters, and Linux may ask for a lower kernel.perf_event_paranoid.
 */
class HardwareCounters
{
public:
  struct Counts
  {
    std::optional<std::uint64_t> TlbMisses;            ///< translation lookaside buffers, data
    std::optional<std::uint64_t> LastLevelCacheMisses; ///< of the third level
    std::optional<std::uint64_t> ResourceStallCycles;  ///< cycles stalled on any resource

    Counts& operator+=(const Counts& other)
    {
      for (const auto count :
        { &Counts::TlbMisses, &Counts::LastLevelCacheMisses, &Counts::ResourceStallCycles })
      {
        if (other.*count)
        {
          this->*count = (this->*count).value_or(0) + *(other.*count);
        }
      }
      return *this;
    }
  };

  HardwareCounters() = default;
  ~HardwareCounters();
  HardwareCounters(const HardwareCounters&) = delete;
  HardwareCounters& operator=(const HardwareCounters&) = delete;

  /**
   * Counts from 0 on, again if it counts already.
   * @return false if no event can be counted
   */
  bool Start();

  /** What was counted since Start(); each event that cannot be counted, or was not, is empty. */
  Counts Stop();

private:
  static constexpr std::size_t Events = 3;

  int EventSet = -1;                                     ///< PAPI's; -1 while not counting
  std::array<int, Events> Position = { { -1, -1, -1 } }; ///< in the event set; -1: not there
};

} // namespace voxplex

#endif
