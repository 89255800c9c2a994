// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Random.h
 * @brief Pseudo-random numbers that are the same with every compiler and library.
 */
#ifndef voxplex_stress_Random_h
#define voxplex_stress_Random_h

#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <numbers>

namespace voxplex::stress
{

/**
 * SplitMix64 (Steele, Lea and Flood 2014). The distributions are written out because std's differ.
 */
class Random
{
public:
  explicit Random(std::uint64_t seed)
    : State(seed)
  {
  }

  /** Each pair has a stream of its own. */
  Random(std::uint64_t seed, std::uint64_t number)
    : State(Mixed(seed) ^ Mixed(number + 0x632BE59BD9B4E019u))
  {
  }

  std::uint64_t Next()
  {
    this->State += 0x9E3779B97F4A7C15u;
    return Mixed(this->State);
  }

  /** At least 0, below 1. */
  double Uniform() { return static_cast<double>(this->Next() >> 11) * 0x1p-53; }
  double Uniform(double low, double high) { return low + (high - low) * this->Uniform(); }
  double LogUniform(double low, double high)
  {
    return low * std::exp(this->Uniform() * std::log(high / low));
  }
  /** From low to high, both inclusive. */
  std::int64_t Integer(std::int64_t low, std::int64_t high)
  {
    return low +
      static_cast<std::int64_t>(this->Next() % static_cast<std::uint64_t>(high - low + 1));
  }
  bool Chance(double probability) { return this->Uniform() < probability; }
  double Normal()
  {
    const double r = std::sqrt(-2.0 * std::log(1.0 - this->Uniform()));
    return r * std::cos(2.0 * std::numbers::pi * this->Uniform());
  }
  template <typename T>
  T OneOf(std::initializer_list<T> choices)
  {
    return choices.begin()[this->Integer(0, static_cast<std::int64_t>(choices.size()) - 1)];
  }

private:
  static std::uint64_t Mixed(std::uint64_t x)
  {
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
    return x ^ (x >> 31);
  }

  std::uint64_t State;
};

} // namespace voxplex::stress

#endif
