// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MixBits.h
 * @brief Bits as good as random, always the same for the same number.
 */
#ifndef voxplex_MixBits_h
#define voxplex_MixBits_h

#include <cstdint>

namespace voxplex
{

/** What splitmix64 adds to its state from one number to the next: 2^64 over the golden ratio. */
constexpr std::uint64_t GoldenGamma = 0x9e3779b97f4a7c15ull;

/** One to one; splitmix64's last step (Steele, Lea, Flood, OOPSLA 2014, variant 13 of Stafford). 0 stays 0. */
constexpr std::uint64_t MixBits(std::uint64_t z)
{
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return z ^ (z >> 31);
}

} // namespace voxplex

#endif
