// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ThreadTesting.h
 * @brief For tests of what makes threads wait: a test that hangs ends, and says where.
 */
#ifndef voxplex_ThreadTesting_h
#define voxplex_ThreadTesting_h

#include "Parallel/Policies.h"

#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <mutex>
#include <string>
#include <thread>

#ifdef _WIN32
#include <windows.h>
#else
#include <sys/resource.h>
#endif

namespace voxplex::testing
{

inline constexpr std::array<ContentionPolicy, 4> AllPolicies = { ContentionPolicy::Aggressive,
  ContentionPolicy::Random, ContentionPolicy::Global, ContentionPolicy::Local };

inline std::string NameOf(ContentionPolicy policy)
{
  return std::string(ContentionPolicyNames[static_cast<std::size_t>(policy)]);
}

/** Ends the program if it lives too long: threads that hang cannot be ended one by one. */
class Watchdog
{
public:
  explicit Watchdog(std::string what, std::chrono::seconds patience = std::chrono::seconds(550))
    : Thread([this, what = std::move(what), patience]() { this->Watch(what, patience); })
  {
  }
  ~Watchdog()
  {
    {
      const std::scoped_lock lock(this->Mutex);
      this->Done = true;
    }
    this->Changed.notify_all();
    this->Thread.join();
  }
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

private:
  void Watch(const std::string& what, std::chrono::seconds patience)
  {
    std::unique_lock lock(this->Mutex);
    if (!this->Changed.wait_for(lock, patience, [this]() { return this->Done; }))
    {
      std::cerr << "HANGS: " << what << std::endl;
      std::abort();
    }
  }

  std::mutex Mutex;
  std::condition_variable Changed;
  bool Done = false;
  std::thread Thread; // last: it uses the others
};

/** Waits until something is true that other threads bring about; false after `patience`. */
inline bool Soon(const std::function<bool()>& condition,
  std::chrono::milliseconds patience = std::chrono::milliseconds(100000))
{
  const auto end = std::chrono::steady_clock::now() + patience;
  while (!condition())
  {
    if (std::chrono::steady_clock::now() > end)
    {
      return false;
    }
    std::this_thread::sleep_for(std::chrono::microseconds(50));
  }
  return true;
}

/** True if something stays true for a while. */
inline bool Stays(const std::function<bool()>& condition,
  std::chrono::milliseconds duration = std::chrono::milliseconds(20))
{
  return !Soon([&condition]() { return !condition(); }, duration);
}

struct Work
{
  long Milliseconds; ///< of processors
  long Sleeps;
};

/** Of all threads of this process so far. */
inline Work WorkSoFar()
{
#ifdef _WIN32 // where nobody counts how often threads go to sleep
  FILETIME start, end, kernel, user;
  GetProcessTimes(GetCurrentProcess(), &start, &end, &kernel, &user);
  return { static_cast<long>((kernel.dwLowDateTime + user.dwLowDateTime) / 10000), 0 };
#else
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto milliseconds = [](const timeval& time)
  { return static_cast<long>(time.tv_sec) * 1000 + static_cast<long>(time.tv_usec) / 1000; };
  return { milliseconds(usage.ru_utime) + milliseconds(usage.ru_stime), usage.ru_nvcsw };
#endif
}

/**
 * True if for a tenth of a second the other threads of the process hardly run: they neither compute
 * nor fall asleep and wake up again and again.
 */
inline bool OthersStandStill()
{
  const Work before = WorkSoFar();
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  const Work after = WorkSoFar();
  // This thread sleeps once, the thread sanitizer's once or twice.
  return after.Milliseconds - before.Milliseconds < 5 && after.Sleeps - before.Sleeps < 6;
}

/** A call that may wait, made in a thread of its own. */
class Call
{
public:
  explicit Call(std::function<bool()> function)
    : Thread([this, function = std::move(function)]()
        { this->Result.store(function() ? 1 : 0, std::memory_order_release); })
  {
  }
  bool Returned() const { return this->Result.load(std::memory_order_acquire) >= 0; }
  bool ReturnsSoon() const
  {
    return Soon([this]() { return this->Returned(); });
  }
  /** What the call returned. */
  bool Value() const { return this->Result.load(std::memory_order_acquire) == 1; }

private:
  std::atomic<int> Result{ -1 };
  std::jthread Thread; // last: it uses the others
};

} // namespace voxplex::testing

#endif
