// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file UninitialisedVector.h
 * @brief A vector whose memory is first touched by the threads that fill it.
 */
#ifndef voxplex_UninitialisedVector_h
#define voxplex_UninitialisedVector_h

#include <memory>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace voxplex
{

/** Like std::allocator, but elements constructed without arguments are not initialised. */
template <typename T>
class UninitialisedAllocator : public std::allocator<T>
{
  static_assert(std::is_trivially_default_constructible_v<T> && std::is_trivially_destructible_v<T>,
    "only what needs no constructor can be left without");

public:
  template <typename U>
  struct rebind
  {
    using other = UninitialisedAllocator<U>;
  };

  using std::allocator<T>::allocator;
  template <typename U>
  UninitialisedAllocator(const UninitialisedAllocator<U>&) noexcept
  {
  }

  void construct(T* element) noexcept { ::new (static_cast<void*>(element)) T; }
  template <typename First, typename... Rest>
  void construct(T* element, First&& first, Rest&&... rest)
  {
    std::construct_at(element, std::forward<First>(first), std::forward<Rest>(rest)...);
  }
};

/**
 * @brief A std::vector of numbers whose constructor and resize() leave new elements uninitialised.
 *
 * Write each element before you read it. Use it for large arrays that a parallel loop fills. A
 * std::vector would write zeros first, in one thread, and that thread would fetch the memory pages
 * from the operating system. This takes about as long as such a loop itself.
 */
template <typename T>
using UninitialisedVector = std::vector<T, UninitialisedAllocator<T>>;

} // namespace voxplex

#endif
