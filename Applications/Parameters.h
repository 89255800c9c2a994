// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Parameters.h
 * @brief What the user asked for on the command line.
 */
#ifndef voxplex_cli_Parameters_h
#define voxplex_cli_Parameters_h

#include "MeshingParameters.h"
#include "Space.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace voxplex::cli
{

/** Labels or an interface, by numbers or names with commas between, and their size, if the parameter has sizes. */
struct LabelText
{
  std::string Labels;
  double Size = 0.0;
};

/** What the program does, by its first word. */
enum class Verb
{
  Mesh,
  Measure,
  Convert,
  Image
};

/** An empty string or optional means that the option was not given. Lengths are physical. */
struct Parameters
{
  Verb Action = Verb::Mesh;
  std::vector<std::string> Inputs;
  std::string Mesh;           ///< that is there already
  std::string MeshInterfaces; ///< those of Mesh
  std::string Output;         ///< a mesh, or an image
  std::string Interfaces;
  std::string Statistics;
  std::string Results; ///< for an application of the Slicer Execution Model
  std::string Slices;  ///< the beginning of the names of slices
  std::optional<int> SliceCount;
  std::vector<double> TimePlanes; ///< in the image's unit of time
  bool TimePlanesAtFrames = false;
  std::string Slabs; ///< the beginning of the names of slabs

  ///@{
  /** Of the table, and those whose values have labels: names of labels are known only when the image is read. */
  ParameterValues Values{ { "threads", 0.0 }, { "memory-limit", 0.0 } };
  std::map<std::string, std::vector<LabelText>, std::less<>> OfLabels;
  ///@}

  UserInterface Words = UserInterface::CommandLine; ///< of errors and warnings
  bool Progress = false;
  bool Compress = true; ///< .vtu and .vtp files
  bool Quality = false;
  bool Hausdorff = false; ///< implies Quality

  /** Whether no file of a mesh or about it is asked for. */
  bool WritesNothing() const
  {
    return (this->Output + this->Interfaces + this->Statistics + this->Slices + this->Slabs)
      .empty();
  }

  /** Whether interfaces are written in another format, without their mesh. */
  bool IsAboutInterfaces() const
  {
    return this->Action == Verb::Convert && this->Mesh.empty() && !this->MeshInterfaces.empty() &&
      (this->Output + this->Slices + this->Slabs).empty();
  }

  /** What messages call the image; empty if there is none. */
  std::string InputName() const
  {
    const std::size_t count = this->Inputs.size();
    return count == 0
      ? ""
      : this->Inputs.front() + (count == 1 ? "" : " and " + std::to_string(count - 1) + " more");
  }

  ///@{
  /** Of the table; the name must be one of it. */
  bool Has(std::string_view name) const
  {
    const std::string& key = FindParameter(name).Name;
    return this->Values.contains(key) || this->OfLabels.contains(key);
  }
  std::optional<double> Value(std::string_view name) const { return this->Get<double>(name); }
  std::string Text(std::string_view name) const
  {
    return this->Get<std::string>(name).value_or("");
  }
  std::vector<double> Numbers(std::string_view name) const
  {
    return this->Get<std::vector<double>>(name).value_or(std::vector<double>());
  }
  voxplex::Space Space() const
  {
    return this->Value("space") == 1.0 ? voxplex::Space::RAS : voxplex::Space::LPS;
  }
  ///@}

private:
  template <typename T>
  std::optional<T> Get(std::string_view name) const
  {
    const auto found = this->Values.find(FindParameter(name).Name);
    return found == this->Values.end() ? std::nullopt : std::optional(std::get<T>(found->second));
  }
};

} // namespace voxplex::cli

#endif
