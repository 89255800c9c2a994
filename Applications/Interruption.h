// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Interruption.h
 * @brief Ctrl-C and its relatives end the program within a second and leave no temporary file.
 *
 * A first SIGINT, SIGTERM or SIGHUP while a cancellable step runs only sets a flag, which the
 * step's progress observer reads. In any other step, at a second signal, or when the cancellable
 * step has not ended within a second, the handler removes the registered temporary files and exits
 * with 128 + the signal's number. On Windows, Ctrl-C counts as SIGINT; Ctrl-Break, and the end of the console or of the
 * session, as SIGTERM; a temporary file stays if it is being written then.
 */
#ifndef voxplex_cli_Interruption_h
#define voxplex_cli_Interruption_h

#include <csignal>
#include <string>

namespace voxplex::cli
{

/** Process-wide, as signals are. Everything but Requested() belongs to the main thread. */
class Interruption
{
public:
  /** Install the handlers. Ignores SIGXFSZ and SIGPIPE, so that writing
   * reports an error instead. */
  static void Install();

  /** From now on the end of the process that started this one counts as SIGTERM, where the system can tell. */
  static void EndWithParent();

  /** Whether a signal came. */
  static bool Requested();

  /** Tell the user, remove the temporary files and end the program. */
  [[noreturn]] static void Exit();

  /** A file to remove on the way out, if it is there then. */
  static void AddTemporary(const std::string& path);

  /** While one lives, a signal sets the flag instead of ending the program. */
  class CancellableStep
  {
  public:
    CancellableStep();
    ~CancellableStep();
    CancellableStep(const CancellableStep&) = delete;
    CancellableStep& operator=(const CancellableStep&) = delete;
  };

  /**
   * While one lives, a crash removes the temporary files, prints a message and ends the program with status 1. For
   * files from strangers, and libraries that crash on some.
   */
  class CrashReport
  {
  public:
    explicit CrashReport(std::string message);
    ~CrashReport();
    CrashReport(const CrashReport&) = delete;
    CrashReport& operator=(const CrashReport&) = delete;

  private:
    const std::string Message;
  };

  /** While one lives, signals wait. */
  class Deferral
  {
  public:
    Deferral();
    ~Deferral();
    Deferral(const Deferral&) = delete;
    Deferral& operator=(const Deferral&) = delete;

  private:
#ifndef _WIN32         // where the process has a lock instead
    sigset_t Previous; ///< what the thread had blocked before
#endif
  };
};

} // namespace voxplex::cli

#endif
