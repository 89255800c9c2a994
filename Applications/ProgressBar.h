// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ProgressBar.h
 * @brief How much is done, on standard error: a bar in a terminal, lines for other programs. For 3D Slicer on
 * standard output, in the elements of its Execution Model.
 */
#ifndef voxplex_cli_ProgressBar_h
#define voxplex_cli_ProgressBar_h

#include "MeshingParameters.h"

#include <chrono>
#include <string>

namespace voxplex::cli
{

class ProgressBar
{
public:
  /** Shows nothing if not wanted. */
  ProgressBar(bool wanted, UserInterface words);
  /** Wipes the bar, or ends the element. */
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /**
   * A bar is drawn at most ten times a second; lines, such as "37 % Meshing", are written for new percents only. Programs
   * get elements of the Slicer Execution Model, or lines of JSON.
   *
   * @param fraction 0 to 1 of the whole run
   */
  void Show(double fraction, const std::string& step);

private:
  using Clock = std::chrono::steady_clock;

  double Seconds() const;
  void Draw(double fraction, const std::string& step);
  void WriteElement(double fraction, const std::string& step) const;

  const bool IsElements;
  const bool IsMessages;
  const bool IsBar;
  const bool IsLines;
  Clock::time_point Start = Clock::now();
  Clock::time_point LastDrawn{};
  std::string LastStep;
  int LastPercent = -1;
};

} // namespace voxplex::cli

#endif
