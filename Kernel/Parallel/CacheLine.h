// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CacheLine.h
 * @brief The size of a cache line.
 */
#ifndef voxplex_CacheLine_h
#define voxplex_CacheLine_h

#include <cstddef>

namespace voxplex
{

/**
 * Size of a cache line in bytes. Data that different threads often write are kept in different
 * cache lines (`alignas(CacheLineSize)`). We do not use
 * std::hardware_destructive_interference_size: it may differ between two sources that are compiled
 * with different flags.
 */
inline constexpr std::size_t CacheLineSize = 64;

} // namespace voxplex

#endif
