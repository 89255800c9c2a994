// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Pause.h
 * @brief The processor's pause instruction, for loops that wait for another thread.
 */
#ifndef voxplex_Pause_h
#define voxplex_Pause_h

namespace voxplex
{

/** Tells the processor that the thread is in a spin-wait loop. */
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
