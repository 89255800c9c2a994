// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LabelValue.h
 * @brief Which scalars are labels.
 *
 * Labels are whole numbers from 0 to 2^63 - 1. What scaled integers have lost by rounding does not
 * count: a floating-point number stands for the nearest whole number n if it is off by at most
 * 1e-5 max(1, |n|), and by at most 0.01.
 */
#ifndef voxplex_LabelValue_h
#define voxplex_LabelValue_h

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

namespace voxplex
{

/** The whole number that a scalar stands for; the scalar itself if there is none. */
template <typename T>
T NearestLabel(T value)
{
  if constexpr (std::is_floating_point_v<T>)
  {
    const T whole = std::round(value);
    const T most = std::min(T(0.01), T(1e-5) * std::max(T(1), std::abs(whole)));
    return std::abs(value - whole) <= most ? whole : value; // NaN and infinity stay
  }
  return value;
}

/** Whether a scalar, after NearestLabel(), is a label. */
template <typename T>
bool IsLabel(T value)
{
  if constexpr (std::is_floating_point_v<T>)
  {
    // 2^63 is exact in float and double. NaN fails the first comparison.
    return value >= T(0) && value < static_cast<T>(9223372036854775808.0) &&
      std::floor(value) == value;
  }
  else if constexpr (std::is_signed_v<T>)
  {
    return value >= 0;
  }
  else if constexpr (sizeof(T) == 8)
  {
    return value <= static_cast<T>(std::numeric_limits<std::int64_t>::max());
  }
  else
  {
    return true;
  }
}

/** Whether a scalar, after NearestLabel(), is finite and whole: a label, negative, or too large. */
template <typename T>
bool IsWhole(T value)
{
  if constexpr (std::is_floating_point_v<T>)
  {
    return std::isfinite(value) && std::floor(value) == value;
  }
  return true;
}

} // namespace voxplex

#endif
