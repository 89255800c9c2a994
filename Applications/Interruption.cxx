// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Interruption.h"

#include "Errors.h"

#include <array>
#include <atomic>
#include <csignal>
#include <cstring>

#include <fcntl.h>
#include <pthread.h>
#include <unistd.h>

namespace voxplex::cli
{
namespace
{

constexpr std::size_t MaximumPathLength = 4096;

/** Read by the signal handler: plain memory and lock-free atomics only. */
struct TemporaryFile
{
  std::atomic<bool> Used = false;
  std::array<char, MaximumPathLength> Path{};
};

std::array<TemporaryFile, 16> Temporaries;
std::atomic<int> SignalNumber = 0;
/** A duplicate of standard error: the original may be redirected while a library reads. */
std::atomic<int> MessageDescriptor = STDERR_FILENO;
std::atomic<bool> Cancellable = false;
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free);

/** Only calls that POSIX allows in a signal handler. */
void RemoveTemporaries()
{
  for (TemporaryFile& file : Temporaries)
  {
    if (file.Used)
    {
      unlink(file.Path.data());
    }
  }
}

template <std::size_t N>
void Print(const char (&message)[N])
{
  [[maybe_unused]] const auto written = write(MessageDescriptor, message, N - 1);
}

[[noreturn]] void RemoveTemporariesAndExit()
{
  RemoveTemporaries();
  Print("\nvoxplex: interrupted, no file was written\n");
  _exit(128 + SignalNumber);
}

/** libpng, for one, calls abort() when a file is damaged. */
void OnAbort(int)
{
  RemoveTemporaries();
  Print("voxplex: a library gave up; most likely the input file is damaged\n");
  _exit(ExitFailure);
}

void OnSignal(int number)
{
  const bool first = SignalNumber.exchange(number) == 0;
  if (!Cancellable || !first)
  {
    RemoveTemporariesAndExit();
  }
  alarm(1);
}

void OnAlarm(int)
{
  RemoveTemporariesAndExit();
}

sigset_t EndingSignals()
{
  sigset_t set;
  sigemptyset(&set);
  for (const int number : { SIGINT, SIGTERM, SIGHUP })
  {
    sigaddset(&set, number);
  }
  return set;
}

} // namespace

void Interruption::Install()
{
  const int duplicate = fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 3);
  if (duplicate >= 0)
  {
    MessageDescriptor = duplicate;
  }
  struct sigaction action
  {
  };
  action.sa_mask = EndingSignals();
  action.sa_handler = OnSignal;
  for (const int number : { SIGINT, SIGTERM, SIGHUP })
  {
    // nohup and shells without job control start programs that ignore a signal: respect that.
    struct sigaction inherited
    {
    };
    sigaction(number, nullptr, &inherited);
    if (inherited.sa_handler != SIG_IGN || number == SIGTERM)
    {
      sigaction(number, &action, nullptr);
    }
  }
  action.sa_handler = OnAlarm;
  sigaction(SIGALRM, &action, nullptr);
  action.sa_handler = OnAbort;
  sigaction(SIGABRT, &action, nullptr);
  std::signal(SIGXFSZ, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
}

bool Interruption::Requested()
{
  return SignalNumber != 0;
}

void Interruption::Exit()
{
  RemoveTemporariesAndExit();
}

void Interruption::AddTemporary(const std::string& path)
{
  if (path.size() < MaximumPathLength)
  {
    for (TemporaryFile& file : Temporaries)
    {
      if (!file.Used)
      {
        std::memcpy(file.Path.data(), path.c_str(), path.size() + 1);
        file.Used = true;
        return;
      }
    }
  }
  throw RunError("cannot write beside '" + path + "': the path is too long");
}

void Interruption::RemoveTemporary(const std::string& path)
{
  for (TemporaryFile& file : Temporaries)
  {
    if (file.Used && path == file.Path.data())
    {
      file.Used = false;
    }
  }
}

Interruption::CancellableStep::CancellableStep()
{
  Cancellable = true;
}

Interruption::CancellableStep::~CancellableStep()
{
  Cancellable = false;
}

Interruption::Deferral::Deferral()
{
  const sigset_t set = EndingSignals();
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
}

Interruption::Deferral::~Deferral()
{
  const sigset_t set = EndingSignals();
  pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
}

} // namespace voxplex::cli
