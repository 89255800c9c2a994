// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Statistics.h
 * @brief Small numeric helpers of the comparison programs.
 */
#ifndef voxplex_Statistics_h
#define voxplex_Statistics_h

#include <algorithm>
#include <cstddef>
#include <vector>

namespace voxplex::benchmarks
{

/** The median. For an even count, the mean of the middle two; for no values, 0. */
inline double Median(std::vector<double> values)
{
  if (values.empty())
  {
    return 0.0;
  }
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

/** The median of `value` over records. */
template <typename Record, typename Value>
double MedianOf(const std::vector<Record>& records, Value value)
{
  std::vector<double> values;
  for (const Record& record : records)
  {
    values.push_back(value(record));
  }
  return Median(values);
}

struct PairedMedians
{
  double Left;
  double Right;
  double Ratio; ///< median of the ratios of each turn; 0 unless both have the same number of turns
};

/**
 * Compares runs that were made in turns. A ratio is computed for each turn, because the speed of a
 * shared machine changes more between turns than within a turn.
 */
template <typename Record, typename Value>
PairedMedians MedianPair(
  const std::vector<Record>& left, const std::vector<Record>& right, Value value)
{
  std::vector<double> ratios;
  for (std::size_t i = 0; left.size() == right.size() && i < left.size(); ++i)
  {
    ratios.push_back(value(left[i]) / value(right[i]));
  }
  return { MedianOf(left, value), MedianOf(right, value), Median(ratios) };
}

} // namespace voxplex::benchmarks

#endif
