// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file StatisticsText.h
 * @brief Numbers of the statistics as the program prints them.
 */
#ifndef voxplex_cli_StatisticsText_h
#define voxplex_cli_StatisticsText_h

#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>
#include <iomanip>
#include <numeric>
#include <sstream>
#include <string>
#include <vector>

namespace voxplex::cli
{

/** With a fixed number of decimals; "-" if it is no number. */
inline std::string Rounded(const nlohmann::ordered_json& number, int decimals)
{
  if (!number.is_number())
  {
    return "-";
  }
  std::ostringstream text;
  text << std::fixed << std::setprecision(decimals) << number.get<double>();
  return text.str();
}

/** The bins of a histogram joined by fives, in percent of all. */
inline std::string Shares(const std::vector<std::uint64_t>& histogram)
{
  const auto sum = [&histogram](std::size_t first, std::size_t last)
  {
    return static_cast<double>(
      std::accumulate(histogram.begin() + static_cast<std::ptrdiff_t>(first),
        histogram.begin() + static_cast<std::ptrdiff_t>(last), std::uint64_t{ 0 }));
  };
  std::string text;
  for (std::size_t first = 0; first + 5 <= histogram.size(); first += 5)
  {
    text += " " + Rounded(100.0 * sum(first, first + 5) / sum(0, histogram.size()), 1);
  }
  return text;
}

} // namespace voxplex::cli

#endif
