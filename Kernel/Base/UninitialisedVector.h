// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file UninitialisedVector.h
 * @brief A vector whose memory is first touched by the threads that fill it.
 */
#ifndef voxplex_UninitialisedVector_h
#define voxplex_UninitialisedVector_h

#include <boost/core/noinit_adaptor.hpp>

#include <memory>
#include <type_traits>
#include <vector>

namespace voxplex
{

/** Elements that may be left without a call of a constructor. */
template <typename T>
concept NeedsNoConstructor =
  std::is_trivially_default_constructible_v<T> && std::is_trivially_destructible_v<T>;

/**
 * @brief A std::vector of numbers whose constructor and resize() leave new elements uninitialised.
 *
 * Write each element before you read it. Use it for large arrays that a parallel loop fills. A
 * std::vector would write zeros first, in one thread, and that thread would fetch the memory pages
 * from the operating system. This takes about as long as such a loop itself.
 */
template <NeedsNoConstructor T>
using UninitialisedVector = std::vector<T, boost::noinit_adaptor<std::allocator<T>>>;

} // namespace voxplex

#endif
