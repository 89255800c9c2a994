// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Stopwatch.h
 * @brief Measures wall-clock and processor time since its construction, in seconds.
 */
#ifndef voxplex_Stopwatch_h
#define voxplex_Stopwatch_h

#include <chrono>
#include <ctime>

namespace voxplex::benchmarks
{

class Stopwatch
{
public:
  double Seconds() const
  {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - this->Start).count();
  }

  /**
   * Processor time of all threads. It is more than Seconds() if threads share work, and less if
   * other processes used the cores.
   */
  double CpuSeconds() const
  {
    return static_cast<double>(std::clock() - this->CpuStart) / CLOCKS_PER_SEC;
  }

private:
  std::chrono::steady_clock::time_point Start = std::chrono::steady_clock::now();
  std::clock_t CpuStart = std::clock();
};

} // namespace voxplex::benchmarks

#endif
