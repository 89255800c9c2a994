// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Stopwatch.h
 * @brief Measures the wall-clock time since its construction.
 */
#ifndef voxplex_Stopwatch_h
#define voxplex_Stopwatch_h

#include <chrono>

namespace voxplex
{

class Stopwatch
{
public:
  double Seconds() const
  {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - this->Start).count();
  }

private:
  std::chrono::steady_clock::time_point Start = std::chrono::steady_clock::now();
};

} // namespace voxplex

#endif
