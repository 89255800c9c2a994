// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Interruption.h"

#include "Errors.h"

#include <atomic>
#include <csignal>
#include <cstring>
#include <initializer_list>
#include <utility>

#ifdef _WIN32
#include <mutex>
#include <windows.h>
#else
#include <pthread.h>
#endif
#ifdef __linux__
#include <sys/prctl.h>
#endif
#include <unistd.h>

namespace voxplex::cli
{

namespace
{

/**
 * Read by the signal handler, which may come at any time: entries of a list that only grows, and
 * that lives to the very end.
 */
struct TemporaryFile
{
  const std::string Path;
  TemporaryFile* const Next;
};

std::atomic<TemporaryFile*> Temporaries = nullptr;
std::atomic<int> SignalNumber = 0;
std::atomic<bool> Cancellable = false;
std::atomic<const char*> MessageOfCrash = nullptr;
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free &&
  std::atomic<void*>::is_always_lock_free);

/** Only calls that POSIX allows in a signal handler. */
void RemoveTemporaries()
{
  for (const TemporaryFile* file = Temporaries; file; file = file->Next)
  {
    unlink(file->Path.c_str());
  }
}

template <std::size_t N>
void Print(const char (&message)[N])
{
  [[maybe_unused]] const auto written = write(STDERR_FILENO, message, N - 1);
}

[[noreturn]] void RemoveTemporariesAndExit()
{
  RemoveTemporaries();
  Print("\nvoxplex: interrupted, no file was written\n");
  _exit(128 + SignalNumber);
}

void OnCrash(int)
{
  RemoveTemporaries();
  const char* const message = MessageOfCrash;
  [[maybe_unused]] const auto written = write(STDERR_FILENO, message, std::strlen(message));
  _exit(ExitFile); // what crashes is the reading of a mesh
}

#ifdef _WIN32 // which has no signals from outside, but starts a thread for what the console says

constexpr std::initializer_list<int> Crashes = { SIGSEGV, SIGFPE, SIGILL, SIGABRT };

std::recursive_mutex DeferralMutex;

BOOL WINAPI OnControl(DWORD event)
{
  int none = 0;
  const bool first =
    SignalNumber.compare_exchange_strong(none, event == CTRL_C_EVENT ? SIGINT : SIGTERM);
  if (Cancellable && first)
  {
    Sleep(1000);
  }
  const std::scoped_lock notDeferred(DeferralMutex);
  RemoveTemporariesAndExit();
}

#else

constexpr std::initializer_list<int> Crashes = { SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT };

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

#endif

void HandleCrashes(void (*handler)(int))
{
  for (const int number : Crashes)
  {
    std::signal(number, handler);
  }
}

} // namespace

#ifdef _WIN32

void Interruption::Install()
{
  SetConsoleCtrlHandler(OnControl, TRUE);
}

Interruption::Deferral::Deferral()
{
  DeferralMutex.lock();
}

Interruption::Deferral::~Deferral()
{
  DeferralMutex.unlock();
}

#else

void Interruption::Install()
{
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
  std::signal(SIGXFSZ, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
}

Interruption::Deferral::Deferral()
{
  const sigset_t set = EndingSignals();
  pthread_sigmask(SIG_BLOCK, &set, &this->Previous);
}

Interruption::Deferral::~Deferral()
{
  pthread_sigmask(SIG_SETMASK, &this->Previous, nullptr);
}

#endif

void Interruption::EndWithParent()
{
#ifdef __linux__
  const pid_t parent = getppid();
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent) // it ended meanwhile
  {
    raise(SIGTERM);
  }
#endif
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
  Temporaries = new TemporaryFile{ path, Temporaries };
}

Interruption::CancellableStep::CancellableStep()
{
  Cancellable = true;
}

Interruption::CancellableStep::~CancellableStep()
{
  Cancellable = false;
}

Interruption::CrashReport::CrashReport(std::string message)
  : Message(std::move(message))
{
  MessageOfCrash = this->Message.c_str();
  HandleCrashes(OnCrash);
}

Interruption::CrashReport::~CrashReport()
{
  HandleCrashes(SIG_DFL);
}

} // namespace voxplex::cli
