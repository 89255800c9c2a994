// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CommandLine.h
 * @brief Common code for the command lines of the benchmark programs.
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

/** Parses a positive, finite number. The whole text must be used. @throws std::invalid_argument */
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

/** Parses a whole number from 1 to `largest`, at most 2^32 - 1. @throws std::invalid_argument */
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

/** The actions for the arguments of a program. */
struct ArgumentTable
{
  std::map<std::string, std::function<void(const std::string& value)>> WithValue;
  std::map<std::string, std::function<void()>> Flags;
  std::string* File = nullptr; ///< receives the argument that is no option; null: none is allowed
};

/** Reads the arguments. @throws std::invalid_argument, and exceptions of the table's functions */
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
 * The whole of a main(): options = parse(argc, argv), then run(options). Exceptions are printed to
 * standard error. If parse throws, the usage follows.
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
