// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshingParameters.h
 * @brief The table of the parameters of meshing, and of what goes before it: reading and repair.
 *
 * The command line, the modules for 3D Slicer, the Python package, the panels of the ParaView plugin and
 * Documentation/Parameters.md are made from it. Messages name parameters by their names in the table, and
 * InTermsOf() brings them to the terms of an interface.
 *
 * The VTK classes declare their parameters again. Testing/Parameters compares them with the table.
 */
#ifndef voxplex_MeshingParameters_h
#define voxplex_MeshingParameters_h

#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace voxplex
{

enum class ParameterKind
{
  Flag,
  Real,
  Whole,
  Bytes,
  Word, ///< one of several words
  Text,
  File,
  Numbers, ///< of a vector or a matrix
  Labels,
  LabelSizes,     ///< a length for each of some labels
  InterfaceSizes, ///< a length for each of some interfaces
  Image,          ///< an image of lengths
  Times           ///< the times of frames
};

/** In the order in which users see them. */
enum class ParameterGroup
{
  Reading,
  GreyValues,
  Sampling,
  Labels,
  Shapes,
  Interfaces,
  Quality,
  Repair,
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

/** How a parameter goes with another one. */
struct ParameterRule
{
  std::string Other{}; ///< empty: there is no rule
  std::string
    Text{}; ///< follows the parameter's name if the rule is broken; names others in braces
};

struct MeshingParameter
{
  std::string Name{}; ///< words with dashes
  ParameterKind Kind{};
  ///@{
  /** Empty if they are made from Name: LabelOf(), PropertyOf(). */
  std::string Property{};
  std::string Label{};
  ///@}
  /** The parameter applies only to images with this number of dimensions; 0: to all images. */
  int Dimension = 0;
  /**
   * A number, a word, on or off. If it is empty and no value is given, Zero describes the effect.
   */
  std::string Default{};
  ParameterRange Range{};
  /** The range of sliders, if it is not the whole range. */
  std::optional<ParameterRange> Usual{};
  double Step = 0.0;                ///< step of sliders; 0: none
  std::vector<std::string> Words{}; ///< their positions are the values of the filter's enumeration
  std::string Unit{};               ///< the word that --help shows for the value
  std::string Example{};            ///< of Numbers: as many as there must be, with commas between
  /**
   * Describes the parameter. The text begins with a small letter, has no full stop at its end, and
   * names other parameters in braces. The text of a flag begins with a verb and describes the flag
   * when it is on.
   */
  std::string Help{};
  std::string Zero{}; ///< the meaning of 0, or of a flag that is off
  /** Values below or above need Force. */
  std::optional<double> ForceBelow{};
  std::optional<double> ForceAbove{};
  std::string ForceWhy{};   ///< follows "below LIMIT" or "above LIMIT"
  ParameterRule Needs{};    ///< without the other the parameter has no effect
  ParameterRule Excludes{}; ///< with the other it has none, or contradicts it
  /**
   * Another parameter, of grey-value images. Where users do not have it, this parameter sets it.
   */
  std::string StandsFor{};

  ///@{
  /**
   * Empty if it is made from Name. None if users do not have the parameter. Slicer has no
   * space-time parameters.
   */
  std::string Option{};
  std::string Slicer{};
  std::string Python{};
  std::string Panel{}; ///< the label in ParaView, made from Property
  static constexpr const char* None = "-";
  ///@}

  ParameterGroup Group{};

  ///@{
  /** Whether it is one of vtkSegmentationReader or of vtkSegmentationRepair, not of the meshing filters. */
  bool IsOfReading() const { return this->Group == ParameterGroup::Reading; }
  bool IsOfRepair() const { return this->Group == ParameterGroup::Repair; }
  ///@}
  bool IsNumber() const;
  /** Whether it has several values, each with a label. */
  bool IsOfLabels() const;
  bool IsOnByDefault() const { return this->Default == "on"; }
  /**
   * Whether the value may be absent. Where a number always has a value, 0 means that it is absent.
   */
  bool IsOptional() const { return this->Default.empty(); }
};

/** The interfaces in which parameters have names. */
enum class UserInterface
{
  VTK,         ///< FacetAngle
  CommandLine, ///< facet-angle, no-optimise
  Slicer,      ///< facetAngle
  Python,      ///< facet_angle
  ParaView,    ///< Facet Angle
  ITK          ///< FacetAngle
};

/** All parameters by groups, in the order in which users see them. */
const std::vector<MeshingParameter>& MeshingParameters();

/** @throws std::logic_error if there is no such parameter */
const MeshingParameter& FindParameter(std::string_view name);

/** The name; empty if users of the interface do not have the parameter. */
std::string NameIn(UserInterface interface, const MeshingParameter& parameter);

/** The label of a field in a window: Facet angle. */
std::string LabelOf(const MeshingParameter& parameter);

/** The name that follows Set and Get in the VTK filters: FacetAngle. */
std::string PropertyOf(const MeshingParameter& parameter);

/**
 * The help, and in parentheses notes about the values. Slicer and ParaView show defaults themselves. For
 * the command line the text is not a sentence.
 */
std::string Describe(UserInterface interface, const MeshingParameter& parameter);

/**
 * A message as users of the interface read it. `{facet-angle}` becomes the parameter's name there,
 * `{isovalue:TEXT}` becomes TEXT if they have the parameter, and nothing otherwise. Beside the parameters of
 * the table, there are `isosurface` (what makes a filter mesh one) and `array` (what chooses the array of
 * labels). Messages of readers, which name methods of VTK, get the names that the interface has for these.
 */
std::string InTermsOf(UserInterface interface, const std::string& message);

/**
 * "{radius-edge} is 1.5; it must be at least 1.93, because ..." for InTermsOf() if the value is out of range, or
 * needs Force and `force` is off; otherwise empty. 0 stands for no value where a value may be absent.
 */
std::string FaultOf(const MeshingParameter& parameter, double value, bool force);

/**
 * "{delta} and {elements} do not go together: ..." for InTermsOf() if a parameter that is given needs another that is
 * not, or excludes one that is; otherwise empty. A word that is the default is not given.
 */
std::string ClashOf(const std::function<bool(const MeshingParameter&)>& isGiven);

/** "below 1.93" or "above 15" if the value needs Force; otherwise empty. */
std::string BeyondLimit(const MeshingParameter& parameter, double value);

const char* TitleOf(ParameterGroup group);
/** A sentence. */
const char* DescriptionOf(ParameterGroup group);

/**
 * Labels, or interfaces with the larger label first, and their sizes, if the parameter has sizes. Where one label is
 * meant, or all its interfaces, the other is AnyLabel.
 */
using LabelValues = std::map<std::pair<std::int64_t, std::int64_t>, double>;
inline constexpr std::int64_t AnyLabel = -1;

/** The value of a word is its position, that of a flag 0 or 1; vectors and times have several numbers. */
using ParameterValue = std::variant<double, std::string, std::vector<double>, LabelValues>;

/** Values by the names of the parameters. Parameters that were not given are absent. */
using ParameterValues = std::map<std::string, ParameterValue, std::less<>>;

} // namespace voxplex

#endif
