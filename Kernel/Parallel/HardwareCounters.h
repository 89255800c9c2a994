// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file HardwareCounters.h
 * @brief Hardware events of a thread (thesis, table 3.5).
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
 * @brief Counts the processor events that the calling thread causes.
 *
 * This needs a build with PAPI (VOXPLEX_USE_PAPI) and a machine that permits it; otherwise every
 * count is empty. Virtual machines often have no counters. Linux may need a lower value of
 * kernel.perf_event_paranoid.
 *
 * One thread must call all methods of an object, and destroy it. Different threads may use
 * different objects at the same time.
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
   * Starts to count from 0. If the object counts already, it starts again.
   * @return false if no event can be counted
   */
  bool Start();

  /** The counts since Start(). The count of an event that was not counted is empty. */
  Counts Stop();

private:
  static constexpr std::size_t Events = 3;

  [[maybe_unused]] int EventSet = -1; ///< handle of PAPI; -1 while the object does not count
  /** Position of each event in the event set; -1 if the set does not have it. */
  [[maybe_unused]] std::array<int, Events> Position = { { -1, -1, -1 } };
};

} // namespace voxplex

#endif
