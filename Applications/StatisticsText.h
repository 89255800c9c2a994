// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file StatisticsText.h
 * @brief Numbers of the statistics as the program prints them.
 */
#ifndef voxplex_cli_StatisticsText_h
#define voxplex_cli_StatisticsText_h

#include <nlohmann/json.hpp>

#include <iomanip>
#include <sstream>
#include <string>

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

} // namespace voxplex::cli

#endif
