// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ProcessorTopology.h
 * @brief The processors and memory groups on which threads run.
 */
#ifndef voxplex_ProcessorTopology_h
#define voxplex_ProcessorTopology_h

#include <array>
#include <vector>

namespace voxplex
{

/**
 * @brief The groups of each thread on three levels, from the innermost to the outermost.
 *
 * Group[t] is { socket, NUMA node, machine } if each socket lies in one NUMA node. It is { NUMA
 * node, socket, machine } if each NUMA node lies in one socket. Otherwise it is { socket, 0, 0 }.
 * Numbers are unique on a level and begin with 0. Threads of one group on a level are in one group
 * on all higher levels. Group[t][2] is 0 for all threads.
 */
struct ProcessorTopology
{
  static constexpr unsigned Levels = 3;
  std::vector<std::array<unsigned, Levels>> Group;
  /** Logical processor of each thread, as numbered by the operating system; empty if unknown. */
  std::vector<unsigned> Processor;
};

/** A topology with all threads in one socket. */
ProcessorTopology FlatTopology(unsigned threads);

/**
 * Assigns threads to the processors that this process may use. The first hyper-threads of all cores
 * come first, one socket after the other, then the second hyper-threads. If there are more threads
 * than processors, the assignment starts again from the first processor. The result is
 * FlatTopology() if the machine's topology is not known. Thread-safe.
 * @throws std::bad_alloc, and no other exception
 */
ProcessorTopology DiscoverTopology(unsigned threads);

/**
 * Pins the calling thread to the processor of thread t, for the rest of its life. Call it from
 * worker threads only: if the main thread pins itself, the next DiscoverTopology() finds a process
 * that may use only one processor.
 * @return false if pinning is not possible
 */
bool PinThisThread(const ProcessorTopology& topology, unsigned t);

} // namespace voxplex

#endif
