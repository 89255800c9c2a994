// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ProgressReport.h
 * @brief Tells the calling application how far the module is, in one of the two ways of the Slicer
 * Execution Model.
 *
 * In the application's process: through its ModuleProcessInformation. As a process of its own: with
 * elements on standard output, `<filter-start>` with `<filter-name>` and `<filter-comment>`,
 * `<filter-progress>` and `<filter-stage-progress>` (0 to 1), and `<filter-end>` with `<filter-name>` and
 * `<filter-time>` (seconds).
 *
 * A module runs through stages; each is a filter in the words of the protocol, and takes a known
 * share of the whole.
 */
#ifndef voxplex_slicer_ProgressReport_h
#define voxplex_slicer_ProgressReport_h

#include "ModuleProcessInformation.h"

#include <chrono>
#include <stdexcept>
#include <string>

namespace voxplex::slicer
{

/** The application asked for an end. */
class Aborted : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};

class ProgressReport
{
public:
  /** @param host the application's structure, which outlives this; null: write to standard output */
  explicit ProgressReport(ModuleProcessInformation* host);

  struct Stage
  {
    const char* Filter;  ///< the class that works
    const char* Comment; ///< what it does, for people
    double Begin;        ///< of the whole, 0 to 1
    double End;          ///< not below Begin
  };

  /** Ends the stage before it, if one is open. @throws Aborted */
  void Start(const Stage& stage);

  /**
   * Reports progress within the stage, from 0 to 1.
   *
   * @return false if the application wants the module to stop
   */
  bool Show(double progress);

  /** Ends the last stage. @throws Aborted */
  void Finish();

private:
  using Clock = std::chrono::steady_clock;

  void EndStage();
  bool Tell(double progress);
  bool TellHost(double whole, double progress);
  void CheckAbort() const;

  ModuleProcessInformation* Host;
  Stage Current{};
  bool Open = false;
  Clock::time_point Begin = Clock::now();
  Clock::time_point StageBegin;
};

} // namespace voxplex::slicer

#endif
