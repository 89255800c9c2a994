// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ProgressBar.h
 * @brief A bar on standard error, if that is a terminal.
 */
#ifndef voxplex_cli_ProgressBar_h
#define voxplex_cli_ProgressBar_h

#include <chrono>
#include <string>

namespace voxplex::cli
{

class ProgressBar
{
public:
  /** Shows nothing if not wanted, or if standard error is not a terminal. */
  explicit ProgressBar(bool wanted);
  /** Wipes the line. */
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /** @param fraction 0 to 1 of the whole run; drawn at most ten times a second */
  void Show(double fraction, const std::string& step);

private:
  using Clock = std::chrono::steady_clock;

  bool Visible;
  Clock::time_point Start = Clock::now();
  Clock::time_point LastDrawn{};
  std::string LastStep;
};

} // namespace voxplex::cli

#endif
