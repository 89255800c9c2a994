// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file DisjointSets.h
 * @brief Sets of numbers that can be joined.
 */
#ifndef voxplex_DisjointSets_h
#define voxplex_DisjointSets_h

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace voxplex
{

/**
 * @brief The numbers from 0 to size - 1, each in a set of its own at first.
 *
 * A set is named by its smallest number. Functions take logarithmic time on average. Not thread safe.
 */
class DisjointSets
{
public:
  explicit DisjointSets(std::size_t size)
    : Parent(size)
  {
    for (std::size_t i = 0; i < size; ++i)
    {
      this->Parent[i] = static_cast<std::uint32_t>(i);
    }
  }

  /** The name of the set with i. */
  std::uint32_t Find(std::uint32_t i)
  {
    while (this->Parent[i] != i)
    {
      this->Parent[i] = this->Parent[this->Parent[i]];
      i = this->Parent[i];
    }
    return i;
  }

  void Join(std::uint32_t i, std::uint32_t j)
  {
    i = this->Find(i);
    j = this->Find(j);
    this->Parent[std::max(i, j)] = std::min(i, j);
  }

private:
  std::vector<std::uint32_t> Parent;
};

} // namespace voxplex

#endif
