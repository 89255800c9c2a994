// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/HardwareCounters.h"

#ifdef VOXPLEX_HAVE_PAPI
#include <papi.h>
#include <pthread.h>
#endif

namespace voxplex
{

HardwareCounters::~HardwareCounters()
{
  this->Stop();
}

#ifdef VOXPLEX_HAVE_PAPI

namespace
{

static_assert(PAPI_NULL == -1);

unsigned long ThisThread()
{
  return static_cast<unsigned long>(pthread_self());
}

/** Initialises PAPI once per process. PAPI is never shut down, since other code may use it, too. */
bool IsPapiReady()
{
  static const bool ready = []()
  {
    if (PAPI_is_initialized() == PAPI_NOT_INITED &&
      PAPI_library_init(PAPI_VER_CURRENT) != PAPI_VER_CURRENT)
    {
      return false;
    }
    return PAPI_thread_init(ThisThread) == PAPI_OK;
  }();
  return ready;
}

} // namespace

bool HardwareCounters::Start()
{
  this->Stop();
  if (!IsPapiReady() || PAPI_register_thread() != PAPI_OK)
  {
    return false;
  }
  if (PAPI_create_eventset(&this->EventSet) != PAPI_OK)
  {
    this->EventSet = PAPI_NULL;
    return false;
  }
  const std::array<int, Events> events = { { PAPI_TLB_DM, PAPI_L3_TCM, PAPI_RES_STL } };
  int size = 0;
  for (std::size_t i = 0; i < Events; ++i)
  {
    // PAPI_add_event fails if the processor lacks the event or has no register left for it.
    this->Position[i] = PAPI_add_event(this->EventSet, events[i]) == PAPI_OK ? size++ : -1;
  }
  if (size == 0 || PAPI_start(this->EventSet) != PAPI_OK)
  {
    this->Position.fill(-1);
    PAPI_cleanup_eventset(this->EventSet);
    PAPI_destroy_eventset(&this->EventSet);
    return false;
  }
  return true;
}

HardwareCounters::Counts HardwareCounters::Stop()
{
  Counts counts;
  if (this->EventSet == PAPI_NULL)
  {
    return counts;
  }
  std::array<long long, Events> values{};
  if (PAPI_stop(this->EventSet, values.data()) == PAPI_OK)
  {
    const std::array<std::optional<std::uint64_t>*, Events> results = { { &counts.TlbMisses,
      &counts.LastLevelCacheMisses, &counts.ResourceStallCycles } };
    for (std::size_t i = 0; i < Events; ++i)
    {
      if (this->Position[i] >= 0)
      {
        *results[i] =
          static_cast<std::uint64_t>(values[static_cast<std::size_t>(this->Position[i])]);
      }
    }
  }
  PAPI_cleanup_eventset(this->EventSet);
  PAPI_destroy_eventset(&this->EventSet); // sets it to PAPI_NULL
  this->Position.fill(-1);
  return counts;
}

#else // without PAPI

bool HardwareCounters::Start()
{
  return false;
}

HardwareCounters::Counts HardwareCounters::Stop()
{
  return {};
}

#endif

} // namespace voxplex
