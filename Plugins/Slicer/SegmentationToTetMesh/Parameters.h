// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Parameters.h
 * @brief The module's parameters, from which its XML description, the parser of its command line and its help are
 * made: those of meshing, from the table of all programs, and the module's own.
 */
#ifndef voxplex_slicer_Parameters_h
#define voxplex_slicer_Parameters_h

#include "MeshingParameters.h"

#include <optional>
#include <string>
#include <vector>

namespace voxplex::slicer
{

/** Numbers outside are refused; applications make a slider of it. */
struct Constraints
{
  double Minimum;
  double Maximum;
  double Step;
};

struct Parameter
{
  std::string Type = "string"; ///< its element in the Slicer Execution Model
  std::string Name{}; ///< a letter, then letters and digits; what applications' scripts call it
  std::string Label{};
  std::string Description{};

  /**
   * How it comes: with a flag (the long one without its dashes, and maybe one of a single letter), or
   * by its place, from 0 on. With neither it is a value that the module returns, in the file of
   * --returnparameterfile.
   */
  std::string LongFlag{};
  char Flag = '\0';
  int Index = -1;

  std::string Channel{}; ///< input, output or none
  std::string Default{};
  std::optional<Constraints> Limits{};
  std::vector<std::string> Elements{};      ///< of an enumeration
  std::string NodeType{};                   ///< of images, geometries and tables
  std::string FileExtensions{};             ///< of these; the application takes the first
  const MeshingParameter* Source = nullptr; ///< null: the module's own

  bool IsFlag() const { return this->Type == "boolean"; } ///< which has no value
  bool IsReturned() const
  {
    return this->Channel == "output" && this->LongFlag.empty() && this->Index < 0;
  }
};

struct ParameterGroup
{
  std::string Label{};
  std::string Description{};
  bool Advanced = false;
  std::vector<Parameter> Parameters{};
};

/** In the order in which applications show them. */
const std::vector<ParameterGroup>& ParameterGroups();

/** Those of all groups. */
const std::vector<const Parameter*>& AllParameters();

} // namespace voxplex::slicer

#endif
