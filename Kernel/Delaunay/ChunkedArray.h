// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ChunkedArray.h
 * @brief An array that grows without moving its elements.
 */
#ifndef voxplex_ChunkedArray_h
#define voxplex_ChunkedArray_h

#include "Base/PageMemory.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <new>
#include <type_traits>

namespace voxplex
{

/**
 * @brief Elements 0 ... 2^32 - 2 in chunks of 2^ChunkBits, allocated on demand.
 *
 * Addresses never change, so threads may read elements while other threads make the array grow.
 * Without an initial value, the memory of a chunk is touched only where elements are written.
 *
 * Several threads may call Grow() at the same time. If two threads need the same chunk, both
 * allocate it, one installs it, and the other frees its own.
 */
template <typename T, unsigned ChunkBits = 14>
class ChunkedArray
{
  static_assert(std::is_trivially_copyable_v<T>, "elements are never constructed or destroyed");
  static_assert(alignof(T) <= 64, "AllocatePages() aligns to 64 bytes");

public:
  static constexpr std::uint32_t ChunkSize = 1u << ChunkBits;

  ChunkedArray()
    // calloc: untouched pages of the table cost nothing, and zero bits are null pointers.
    : Chunks(static_cast<std::atomic<T*>*>(std::calloc(NumberOfChunks, sizeof(std::atomic<T*>))))
  {
    if (!this->Chunks)
    {
      throw std::bad_alloc();
    }
  }
  /** The elements of a new chunk are copies of `initial`. */
  explicit ChunkedArray(const T& initial)
    : ChunkedArray()
  {
    this->Initial = initial;
    this->Initialise = true;
  }
  ChunkedArray(const ChunkedArray&) = delete;
  ChunkedArray& operator=(const ChunkedArray&) = delete;
  ~ChunkedArray() { this->Clear(); }

  /** Frees all elements. No other thread may use the array meanwhile. */
  void Clear()
  {
    for (std::uint32_t c = 0; c < NumberOfChunks; ++c)
    {
      T* chunk = this->Chunks[c].exchange(nullptr, std::memory_order_relaxed);
      if (!chunk)
      {
        // Threads install chunks roughly in the order of element numbers. Races among threads may
        // leave a gap of a few chunks.
        if (c > this->HighestChunk.load(std::memory_order_relaxed))
        {
          break;
        }
        continue;
      }
      FreePages(chunk, BytesOfChunk);
    }
  }

  /** Makes elements [0, end) available. Throws std::bad_alloc. */
  void Grow(std::uint32_t end)
  {
    if (end == 0)
    {
      return;
    }
    for (std::uint32_t c = (end - 1) >> ChunkBits;; --c)
    {
      if (this->Chunks[c].load(std::memory_order_acquire))
      {
        break; // the chunks below exist, or the threads that need them make them now
      }
      this->MakeChunk(c);
      if (c == 0)
      {
        break;
      }
    }
  }

  /** Elements from `end` on become those of a new array. No other thread may use the array meanwhile. */
  void Shrink(std::uint32_t end)
  {
    const std::uint32_t highest = this->HighestChunk.load(std::memory_order_relaxed);
    for (std::uint32_t c = end >> ChunkBits; c <= highest; ++c)
    {
      T* const chunk = this->Chunks[c].load(std::memory_order_relaxed);
      const std::uint32_t first = c == end >> ChunkBits ? end & (ChunkSize - 1) : 0;
      if (chunk && first == 0)
      {
        FreePages(chunk, BytesOfChunk);
        this->Chunks[c].store(nullptr, std::memory_order_relaxed);
      }
      else if (chunk && this->Initialise)
      {
        std::fill(chunk + first, chunk + ChunkSize, this->Initial);
      }
    }
    this->HighestChunk.store(std::min(highest, end >> ChunkBits), std::memory_order_relaxed);
  }

  T& operator[](std::uint32_t i)
  {
    return this->Chunks[i >> ChunkBits].load(std::memory_order_relaxed)[i & (ChunkSize - 1)];
  }
  const T& operator[](std::uint32_t i) const
  {
    return this->Chunks[i >> ChunkBits].load(std::memory_order_relaxed)[i & (ChunkSize - 1)];
  }

private:
  static constexpr std::uint32_t NumberOfChunks = 1u << (32 - ChunkBits);
  static constexpr std::size_t BytesOfChunk = sizeof(T) * std::size_t(ChunkSize);

  void MakeChunk(std::uint32_t c)
  {
    T* fresh = static_cast<T*>(AllocatePages(BytesOfChunk));
    if (this->Initialise)
    {
      std::uninitialized_fill_n(fresh, ChunkSize, this->Initial);
    }
    T* expected = nullptr;
    // Release: a thread that sees the pointer sees the initial values.
    if (!this->Chunks[c].compare_exchange_strong(expected, fresh, std::memory_order_acq_rel))
    {
      FreePages(fresh, BytesOfChunk);
    }
    std::uint32_t highest = this->HighestChunk.load(std::memory_order_relaxed);
    while (highest < c &&
      !this->HighestChunk.compare_exchange_weak(highest, c, std::memory_order_relaxed))
    {
    }
  }

  struct Free
  {
    void operator()(std::atomic<T*>* table) const { std::free(table); }
  };
  std::unique_ptr<std::atomic<T*>[], Free> Chunks;
  std::atomic<std::uint32_t> HighestChunk{ 0 };
  T Initial{};
  bool Initialise = false;
};

} // namespace voxplex

#endif
