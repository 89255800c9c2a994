// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ProcessorTopology.h
 * @brief Which threads are near each other.
 */
#ifndef voxplex_ProcessorTopology_h
#define voxplex_ProcessorTopology_h

#include <array>
#include <vector>

namespace voxplex
{

/**
 * @brief For each thread the group that it belongs to on each of three levels, the nearest first.
 *
 * Group[t] = { socket, NUMA node, machine } or { NUMA node, socket, machine }, whichever nests;
 * { socket, 0, 0 } if neither does. Numbers are unique on a level and begin with 0. Threads of one
 * group on a level are in one group on all higher levels; Group[t][2] is 0 for all.
 */
struct ProcessorTopology
{
  static constexpr unsigned Levels = 3;
  std::vector<std::array<unsigned, Levels>> Group;
  /** Logical processor of each thread, by the operating system's number; empty where unknown. */
  std::vector<unsigned> Processor;
};

/** All threads in one socket. */
ProcessorTopology FlatTopology(unsigned threads);

/**
 * Spreads the threads over the processors that this process may use, filling one socket after the
 * other; cores first, then their second hyper-threads; more threads than processors go round. Flat
 * where the machine's topology is not known. Thread-safe. Never throws but std::bad_alloc.
 */
ProcessorTopology DiscoverTopology(unsigned threads);

/**
 * Keeps the calling thread on the processor of thread t, for the rest of its life: meant for
 * threads that are made for the purpose. (A main thread that pins itself leaves its process one
 * processor in the eyes of the next DiscoverTopology().)
 * @return false where that is not possible
 */
bool PinThisThread(const ProcessorTopology& topology, unsigned t);

} // namespace voxplex

#endif
