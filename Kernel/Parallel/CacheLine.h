// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CacheLine.h
 * @brief What threads that write side by side must know of the memory.
 */
#ifndef voxplex_CacheLine_h
#define voxplex_CacheLine_h

#include <cstddef>

namespace voxplex
{

/**
 * Bytes that caches move together. What different threads write often is this far apart
 * (`alignas(CacheLineSize)`). A constant of ours, since std::hardware_destructive_interference_size
 * may differ between two sources that are compiled with different flags.
 */
inline constexpr std::size_t CacheLineSize = 64;

} // namespace voxplex

#endif
