// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CpuStopwatch.h
 * @brief Measures wall-clock and processor time since its construction, in seconds.
 */
#ifndef voxplex_CpuStopwatch_h
#define voxplex_CpuStopwatch_h

#include "Base/Stopwatch.h"

#include <ctime>

namespace voxplex::benchmarks
{

class CpuStopwatch : public voxplex::Stopwatch
{
public:
  /**
   * Processor time of all threads. It is more than Seconds() if threads share work, and less if
   * other processes used the cores.
   */
  double CpuSeconds() const
  {
    return static_cast<double>(std::clock() - this->CpuStart) / CLOCKS_PER_SEC;
  }

private:
  std::clock_t CpuStart = std::clock();
};

} // namespace voxplex::benchmarks

#endif
