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

/** A label, by number or name, and the size of its elements. */
struct LabelSizeText
{
  std::string Label;
  double Size;
};

/** An interface, by the number or name of one or two labels, and its sampling distance. */
struct InterfaceSizeText
{
  std::string Labels;
  double Size;
};

/** How the file of an image is read. What is empty is as the file says. */
struct ReadingOptions
{
  std::string Series;
  int Overlap = 0; ///< of vtkSegmentationReader
  double MaskThreshold = 0.5;
  bool ResampleMasks = false;
  std::string LabelTable;
  std::vector<double> FrameTimes;
  std::vector<double> Spacing; ///< of three axes
  std::vector<double> Origin;  ///< three coordinates, in Space
  std::vector<double>
    Direction; ///< nine numbers, row by row; columns are directions of axes, in Space
  bool DataFilesAnywhere = false;
  voxplex::Space Space = voxplex::Space::LPS; ///< of the output
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
  ReadingOptions Reading;     ///< of the input
  std::string Mesh;           ///< that is there already
  std::string MeshInterfaces; ///< those of Mesh
  std::string Output;         ///< a mesh, or an image
  std::string Interfaces;
  std::string Statistics;
  std::string SizeImage;
  std::string Slices; ///< the beginning of the names of slices
  std::optional<int> SliceCount;
  std::vector<double> TimePlanes; ///< in the image's unit of time
  bool TimePlanesAtFrames = false;
  std::string Slabs; ///< the beginning of the names of slabs

  /** Of the table, apart from lists of labels and sizes. */
  ParameterValues Values{ { "threads", 0.0 }, { "memory-limit", 0.0 } };
  std::vector<LabelSizeText> LabelSizeTexts;
  std::vector<LabelSizeText> ThicknessTexts; ///< smallest ones
  std::vector<LabelSizeText> ShellTexts;     ///< may be negative
  std::vector<InterfaceSizeText> InterfaceSizeTexts;
  std::vector<std::string> LabelTexts; ///< each is one label, or several with commas between them

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
  bool Has(std::string_view name) const { return this->Value(name).has_value(); }
  std::optional<double> Value(std::string_view name) const
  {
    const auto found = this->Values.find(FindParameter(name).Name);
    return found == this->Values.end() ? std::nullopt : std::optional(found->second);
  }
  ///@}
};

} // namespace voxplex::cli

#endif
