// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Pause.h
 * @brief What a loop that waits for another thread does in each turn.
 */
#ifndef voxplex_Pause_h
#define voxplex_Pause_h

namespace voxplex
{

/** Tells the processor that this is a waiting loop. */
inline void Pause()
{
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#elif defined(__aarch64__)
  asm volatile("yield");
#endif
}

} // namespace voxplex

#endif
