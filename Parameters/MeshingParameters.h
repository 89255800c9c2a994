// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshingParameters.h
 * @brief The parameters of meshing: the one table that the command line, the module for 3D Slicer, the Python package and
 * Documentation/Parameters.md are made from.
 *
 * The VTK filters and the ParaView plugin declare theirs again; Testing/Parameters compares them with the table.
 */
#ifndef voxplex_MeshingParameters_h
#define voxplex_MeshingParameters_h

#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace voxplex
{

enum class ParameterKind
{
  Flag,
  Real,
  Whole,
  Bytes,
  Word, ///< one of several
  Labels,
  LabelSizes,     ///< a length for each of some labels
  InterfaceSizes, ///< a length for each of some interfaces
  Image           ///< of lengths
};

/** In the order in which users see them. */
enum class ParameterGroup
{
  GreyValues,
  Density,
  Labels,
  Shapes,
  Interfaces,
  Quality,
  SpaceTime,
  Running
};

/** Finite numbers from Low to High. */
struct ParameterRange
{
  double Low = -std::numeric_limits<double>::infinity();
  double High = std::numeric_limits<double>::infinity();
  bool LowIsOutside = false;
};

struct MeshingParameter
{
  std::string Name{}; ///< words with dashes
  ParameterKind Kind{};
  ///@{
  /** Where they are not made from Name: LabelOf(), PropertyOf(). */
  std::string Property{};
  std::string Label{};
  ///@}
  /** Of images with so many dimensions only; 0: of all. */
  int Dimension = 0;
  /** A number, a word, on or off. Empty: what Zero says is the case where no value is given. */
  std::string Default{};
  ParameterRange Range{};
  /** Where sliders begin and end, if they do not have the whole range. */
  std::optional<ParameterRange> Usual{};
  double Step = 0.0;                ///< of sliders; 0: it has none
  std::vector<std::string> Words{}; ///< their places are the values of the filter's enumeration
  std::string Unit{};               ///< what --help has for the value
  /**
   * What it does; begins with a small letter, has no full stop at its end, and names other parameters in braces. Of
   * a flag: what it does when it is on, beginning with a verb.
   */
  std::string Help{};
  std::string Zero{}; ///< what 0, or a flag that is off, means
  /** Values below or above need Force. */
  std::optional<double> ForceBelow{};
  std::optional<double> ForceAbove{};
  std::string ForceWhy{}; ///< follows "below LIMIT" or "above LIMIT"
  /** The parameter of grey-value images that is set by this one where users do not have it. */
  std::string StandsFor{};

  ///@{
  /** Where it is not made from Name; None where users do not have it. Slicer has nothing of space-time. */
  std::string Option{};
  std::string Slicer{};
  std::string Python{};
  static constexpr const char* None = "-";
  ///@}

  ParameterGroup Group{};

  bool IsNumber() const;
  bool IsOnByDefault() const { return this->Default == "on"; }
  /** Whether a value need not be there, which numbers say by 0 where they always have one. */
  bool IsOptional() const { return this->Default.empty(); }
};

/** Who names parameters. */
enum class UserInterface
{
  CommandLine, ///< facet-angle, no-optimise
  Slicer,      ///< facetAngle
  Python       ///< facet_angle
};

/** By groups, in the order in which users see them. */
const std::vector<MeshingParameter>& MeshingParameters();

/** @throws std::logic_error: there is no such parameter */
const MeshingParameter& FindParameter(std::string_view name);

/** Empty where users of the interface do not have the parameter. */
std::string NameIn(UserInterface interface, const MeshingParameter& parameter);

/** Of a field in a window: Facet angle. */
std::string LabelOf(const MeshingParameter& parameter);

/** Of the VTK filters, what follows Set and Get: FacetAngle. */
std::string PropertyOf(const MeshingParameter& parameter);

/** Its help, and in parentheses what is to be known of its values. Slicer shows defaults itself. Of the
 * command line it is no sentence. */
std::string Describe(UserInterface interface, const MeshingParameter& parameter);

/** "below 1.93" or "above 15" if the value needs Force; otherwise empty. */
std::string BeyondLimit(const MeshingParameter& parameter, double value);

const char* TitleOf(ParameterGroup group);
/** A sentence. */
const char* DescriptionOf(ParameterGroup group);

/** As short as possible: "9", "0.3". */
std::string NumberText(double value);

/**
 * Values by the names of the parameters; of a word its place, of a flag 0 or 1. What was not given is not there.
 */
using ParameterValues = std::map<std::string, double, std::less<>>;

} // namespace voxplex

#endif
