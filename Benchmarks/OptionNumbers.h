// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Numbers of the benchmark programs' command lines.
#ifndef voxplex_OptionNumbers_h
#define voxplex_OptionNumbers_h

#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>

namespace voxplex::benchmarks
{

/** A positive, finite number, all of the text. @throws std::invalid_argument */
inline double ParseNumber(const std::string& text)
{
  std::istringstream stream(text);
  double number = 0.0;
  if (!(stream >> number) || !stream.eof() || !(number > 0.0) || std::isinf(number))
  {
    throw std::invalid_argument("a positive number is needed, not " + text);
  }
  return number;
}

/** A whole number from 1 to 65535. @throws std::invalid_argument */
inline unsigned ParseCount(const std::string& text)
{
  const double number = ParseNumber(text);
  if (number != std::floor(number) || number > 65535.0)
  {
    throw std::invalid_argument("a whole number up to 65535 is needed, not " + text);
  }
  return static_cast<unsigned>(number);
}

} // namespace voxplex::benchmarks

#endif
