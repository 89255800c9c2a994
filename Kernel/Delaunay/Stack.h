// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Stack.h
 * @brief A growing array for the innermost loops.
 */
#ifndef voxplex_Stack_h
#define voxplex_Stack_h

#include <algorithm>
#include <cstddef>
#include <memory>
#include <type_traits>

namespace voxplex
{

/**
 * @brief Like std::vector for plain data, but making room and pushing are separate operations.
 *
 * A loop makes room once for all pushes of an iteration. Then each push is a store and an
 * increment. (std::vector::push_back calls a function that is not inlined. In the cavity search
 * this took 5 % of an insertion.)
 */
template <typename T>
class Stack
{
  static_assert(std::is_trivially_copyable_v<T>, "elements are copied as bytes");

public:
  /** Makes room for n more elements. Throws std::bad_alloc with the contents unchanged. */
  void ReserveMore(std::size_t n)
  {
    if (this->Count + n > this->Capacity)
    {
      this->Grow(n);
    }
  }
  /** Call ReserveMore() before. */
  void Push(const T& x) { this->Data[this->Count++] = x; }
  /** Returns the new top, which is uninitialised. Call ReserveMore() before. */
  T& PushUninitialised() { return this->Data[this->Count++]; }
  T Pop() { return this->Data[--this->Count]; }
  void Clear() { this->Count = 0; }
  /** New elements are uninitialised. */
  void Resize(std::size_t n)
  {
    if (n > this->Count)
    {
      this->ReserveMore(n - this->Count);
    }
    this->Count = n;
  }

  std::size_t Size() const { return this->Count; }
  bool Empty() const { return this->Count == 0; }
  T& operator[](std::size_t i) { return this->Data[i]; }
  const T& operator[](std::size_t i) const { return this->Data[i]; }
  const T& Back() const { return this->Data[this->Count - 1]; }
  T* begin() { return this->Data.get(); }
  T* end() { return this->Data.get() + this->Count; }
  const T* begin() const { return this->Data.get(); }
  const T* end() const { return this->Data.get() + this->Count; }

private:
  void Grow(std::size_t n)
  {
    const std::size_t capacity = std::max<std::size_t>(2 * this->Capacity, this->Count + n + 64);
    std::unique_ptr<T[]> data(new T[capacity]);
    std::copy(this->begin(), this->end(), data.get());
    this->Data = std::move(data);
    this->Capacity = capacity;
  }

  std::unique_ptr<T[]> Data;
  std::size_t Count = 0;
  std::size_t Capacity = 0;
};

} // namespace voxplex

#endif
