// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Arguments.h
 * @brief The module's command line: the parameters of the table, and the flags that every module of
 * the Slicer Execution Model has.
 */
#ifndef voxplex_slicer_Arguments_h
#define voxplex_slicer_Arguments_h

#include "LabelSelection.h"
#include "MeshingParameters.h"

#include <map>
#include <string>

namespace voxplex::slicer
{

struct ModuleProcessInformation;

/** Parses and checks all that can be checked without touching files. */
class Arguments
{
public:
  /** What to print instead of running. */
  enum class Request
  {
    Run,
    Help,
    Version,
    Description, ///< --xml
    Logo
  };

  /**
   * @throws cli::UsageError: unknown, repeated or incomplete flags, values that are not numbers or out
   *   of range, an input or output that is missing. Not if something else than a run is asked for
   */
  Arguments(int argc, const char* const* argv);

  Request Wanted = Request::Run;
  bool Echo = false;      ///< print the values before the run
  std::string ReturnFile; ///< for the results; empty: none wanted
  ModuleProcessInformation* Host =
    nullptr; ///< of the calling application; null: a process of its own

  ///@{
  /** The value of a parameter, given or default. */
  const std::string& Text(const std::string& name) const;
  bool IsSet(const std::string& name) const; ///< of a flag without value
  ///@}

  cli::LabelSelection Selection() const;

  /** Those of the table, apart from lists. */
  ParameterValues MeshingValues() const;

private:
  void Check() const;

  std::map<std::string, std::string> Values; ///< by the parameters' names
};

/** For --help. */
std::string HelpText();

} // namespace voxplex::slicer

#endif
