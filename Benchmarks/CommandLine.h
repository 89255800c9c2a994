// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CommandLine.h
 * @brief What the command lines of the benchmark programs have in common, from main() to a number.
 */
#ifndef voxplex_CommandLine_h
#define voxplex_CommandLine_h

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <map>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <type_traits>

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

/** A whole number from 1 to `largest`, which is at most 2^32 - 1. @throws std::invalid_argument */
inline unsigned ParseCount(const std::string& text, unsigned largest = 65535)
{
  const double number = ParseNumber(text);
  if (number != std::floor(number) || number > static_cast<double>(largest))
  {
    throw std::invalid_argument(
      "a whole number up to " + std::to_string(largest) + " is needed, not " + text);
  }
  return static_cast<unsigned>(number);
}

/** What to do at each argument of a program. */
struct ArgumentTable
{
  std::map<std::string, std::function<void(const std::string& value)>> WithValue;
  std::map<std::string, std::function<void()>> Flags;
  std::string* File = nullptr; ///< takes one argument that is no option, if there may be one
};

/** Goes through the arguments. @throws std::invalid_argument, and what the table's functions throw */
inline void ReadArguments(int argc, char** argv, const ArgumentTable& table)
{
  for (int i = 1; i < argc; ++i)
  {
    const std::string argument = argv[i];
    if (const auto option = table.WithValue.find(argument);
        option != table.WithValue.end() && i + 1 < argc)
    {
      option->second(argv[++i]);
    }
    else if (const auto flag = table.Flags.find(argument); flag != table.Flags.end())
    {
      flag->second();
    }
    else if (table.File && table.File->empty() && argument.rfind("--", 0) != 0)
    {
      *table.File = argument;
    }
    else
    {
      throw std::invalid_argument("unknown or incomplete argument " + argument);
    }
  }
}

/**
 * The whole of a main(): options = parse(argc, argv), then run(options). What they throw goes to standard
 * error, with the usage behind it if it is parse that throws.
 * @return the exit status: 2 if parse throws, EXIT_FAILURE if run does
 */
template <typename Parse, typename Run>
int RunProgram(int argc, char** argv, const char* usage, Parse&& parse, Run&& run)
{
  std::optional<std::invoke_result_t<Parse, int, char**>> options;
  try
  {
    options.emplace(parse(argc, argv));
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "error: %s\n\n%s", error.what(), usage);
    return 2;
  }
  try
  {
    run(*options);
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "error: %s\n", error.what());
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}

} // namespace voxplex::benchmarks

#endif
