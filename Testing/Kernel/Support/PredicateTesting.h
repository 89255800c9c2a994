// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// What the tests of predicates and of circumballs share: the seed, points as arguments and as text.
#ifndef voxplex_PredicateTesting_h
#define voxplex_PredicateTesting_h

#include "Geometry/Point.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <random>
#include <string>
#include <type_traits>
#include <vector>

namespace voxplex::predicatetesting
{

/** Of all random tests of the program; printed when it is first asked for. */
inline std::uint64_t Seed()
{
  static const std::uint64_t seed = []
  {
    const char* text = std::getenv("VOXPLEX_TEST_SEED");
    const std::uint64_t value =
      text != nullptr ? std::strtoull(text, nullptr, 10) : std::random_device{}();
    std::cout << "VOXPLEX_TEST_SEED=" << value << std::endl;
    return value;
  }();
  return seed;
}

/** The first D + 1 points, as predicates take them. */
template <int D>
std::array<const Point<D>*, static_cast<std::size_t>(D + 1)> Pointers(
  const std::vector<Point<D>>& points)
{
  std::array<const Point<D>*, static_cast<std::size_t>(D + 1)> pointers;
  for (std::size_t i = 0; i < pointers.size(); ++i)
  {
    pointers[i] = &points[i];
  }
  return pointers;
}

/** Coordinates in hexadecimal, exactly. */
template <int D>
std::string Print(const std::vector<Point<D>>& points)
{
  std::string text;
  char number[64];
  for (const Point<D>& p : points)
  {
    text += "(";
    for (const double x : p)
    {
      std::snprintf(number, sizeof(number), " %a", x);
      text += number;
    }
    text += " ) ";
  }
  return text;
}

/** A test with random numbers that is run for 3 and for 4 dimensions. */
template <class T>
class RandomTest : public testing::Test
{
protected:
  void SetUp() override { this->Engine.seed(Seed()); }
  std::mt19937_64 Engine;
};

using Dimensions = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;

} // namespace voxplex::predicatetesting

#endif
