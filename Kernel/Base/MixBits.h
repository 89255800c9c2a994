// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MixBits.h
 * @brief A hash of 64-bit integers.
 */
#ifndef voxplex_MixBits_h
#define voxplex_MixBits_h

#include <cstdint>

namespace voxplex
{

/** The increment of splitmix64's state: 2^64 divided by the golden ratio. */
constexpr std::uint64_t GoldenGamma = 0x9e3779b97f4a7c15ull;

/**
 * The last step of splitmix64 (Steele, Lea, Flood, OOPSLA 2014, variant 13 of Stafford). It is a
 * bijection, and maps 0 to 0.
 */
constexpr std::uint64_t MixBits(std::uint64_t z)
{
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return z ^ (z >> 31);
}

} // namespace voxplex

#endif
