// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/** @file FuzzCommandLine.cxx @brief Options, one a line, and labels by name. */
#include "CommandLine.h"
#include "Errors.h"
#include "Fuzzing.h"
#include "LabelSelection.h"
#include "LabelTable.h"

#include <sstream>
#include <vector>

namespace
{

voxplex::LabelTable MakeTable()
{
  voxplex::LabelTable table;
  std::int64_t label = 1;
  for (const char* name : { "Tibia", "tibia", "Femur, left", "Knee", "\xC3\x9C" })
  {
    table.Entries[label++].Name = name;
  }
  return table;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  static const voxplex::LabelTable table = MakeTable();
  std::istringstream lines(std::string(reinterpret_cast<const char*>(data), size));
  std::vector<std::string> arguments{ "voxplex" };
  for (std::string line; std::getline(lines, line);)
  {
    arguments.emplace_back(line.c_str()); // an argument ends at a zero
  }
  std::vector<const char*> pointers;
  for (const std::string& argument : arguments)
  {
    pointers.push_back(argument.c_str());
  }
  try
  {
    const voxplex::cli::CommandLine commandLine =
      voxplex::cli::ParseCommandLine(static_cast<int>(pointers.size()), pointers.data());
    if (commandLine.Run)
    {
      voxplex::cli::HasNames(*commandLine.Run);
      voxplex::cli::SelectLabels(*commandLine.Run, table);
    }
  }
  catch (const voxplex::cli::UsageError& error)
  {
    if (*error.what() == '\0')
    {
      voxplex::fuzz::Fail("the refusal says nothing");
    }
  }
  return 0;
}
