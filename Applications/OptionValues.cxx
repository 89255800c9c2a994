// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "OptionValues.h"

#include "Base/NumberText.h"
#include "Errors.h"
#include "Text.h"

#include <vtkMath.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

namespace voxplex::cli
{
namespace
{

constexpr ParameterRange Lengths{ .Low = 0.0, .LowIsOutside = true };

double ParseFinite(const std::string& option, std::string_view text)
{
  const std::optional<double> value = io::ToNumber<double>(text);
  if (!value)
  {
    throw UsageError("--" + option + ": " + Quoted(text) + " is not a number");
  }
  if (!std::isfinite(*value))
  {
    throw UsageError("--" + option + ": must be a finite number, not " + std::string(text));
  }
  return *value;
}

std::vector<double> ParseSoMany(
  const std::string& option, std::string_view text, std::size_t count, const std::string& example)
{
  std::vector<double> numbers = ParseNumbers(option, text);
  if (numbers.size() != count)
  {
    throw UsageError("--" + option + ": give " + std::to_string(count) +
      " numbers with commas between them, such as " + example + ", not " + Quoted(text));
  }
  return numbers;
}

/** What an interface calls an option, which is given without dashes. */
std::string NameOfOption(UserInterface interface, std::string option)
{
  for (const MeshingParameter& parameter : MeshingParameters())
  {
    const std::string name = NameIn(interface, parameter);
    if (NameIn(UserInterface::CommandLine, parameter) == option && !name.empty())
    {
      return interface == UserInterface::Python && parameter.IsOnByDefault()
        ? name + "=False"
        : InTermsOf(interface, "{" + parameter.Name + "}");
    }
  }
  if (interface == UserInterface::Slicer) // a file
  {
    return "--" + option;
  }
  if (option == "frame-times")
  {
    return "times";
  }
  std::replace(option.begin(), option.end(), '-', '_');
  return option;
}

} // namespace

std::string Quoted(std::string_view text)
{
  std::string quoted("'");
  quoted.append(text).push_back('\'');
  return quoted;
}

double ParseReal(const std::string& option, std::string_view text, const ParameterRange& range,
  const std::string& hint)
{
  const double value = ParseFinite(option, text);
  const bool tooSmall = value < range.Low || (range.LowIsOutside && value == range.Low);
  if (!tooSmall && value <= range.High)
  {
    return value;
  }
  const std::string low = NumberText(range.Low);
  throw UsageError("--" + option +
    (std::isfinite(range.High) ? ": must lie between " + low + " and " + NumberText(range.High)
        : range.LowIsOutside   ? ": must be greater than " + low
                               : ": must be " + low + " or more") +
    ", not " + std::string(text) + (tooSmall ? hint : ""));
}

std::optional<std::int64_t> ParseLabelNumber(const std::string& option, std::string_view text)
{
  const std::optional<std::int64_t> label = io::ToNumber<std::int64_t>(text);
  const bool isNumber = label || text.empty() || io::ToNumber<double>(text);
  if (isNumber && (!label || *label <= 0))
  {
    throw UsageError("--" + option + ": " + Quoted(text) +
      " is not a label; labels are whole numbers from 1 on (0 is the background), or names");
  }
  return label;
}

std::vector<std::string> SplitAtCommas(std::string_view text)
{
  std::vector<std::string> parts;
  for (std::size_t comma = 0; comma != std::string_view::npos;)
  {
    comma = text.find(',');
    parts.emplace_back(text.substr(0, comma));
    text.remove_prefix(comma == std::string_view::npos ? text.size() : comma + 1);
  }
  return parts;
}

std::vector<double> ParseNumbers(const std::string& option, std::string_view text)
{
  std::vector<double> numbers;
  for (const std::string& one : SplitAtCommas(text))
  {
    numbers.push_back(ParseFinite(option, one));
  }
  return numbers;
}

LabelSizeText ParseLabelSize(const std::string& option, std::string_view text, bool isSigned)
{
  const std::size_t equals = text.rfind('=');
  if (equals == std::string_view::npos)
  {
    throw UsageError("--" + option + ": " + Quoted(text) +
      " is not of the form LABEL=SIZE, such as 3=1.5 or Tibia=1.5");
  }
  const std::string_view label = text.substr(0, equals);
  ParseLabelNumber(option, label);
  return { std::string(label),
    ParseReal(option, text.substr(equals + 1), isSigned ? ParameterRange() : Lengths) };
}

InterfaceSizeText ParseInterfaceSize(const std::string& option, std::string_view text)
{
  const std::size_t equals = text.rfind('=');
  if (equals == std::string_view::npos || equals == 0)
  {
    throw UsageError("--" + option + ": " + Quoted(text) +
      " is not of the form LABEL=LENGTH or LABEL,LABEL=LENGTH, such as 3=0.5 or 3,7=0.5; "
      "--delta is the sampling distance of all interfaces");
  }
  return { std::string(text.substr(0, equals)),
    ParseReal(option, text.substr(equals + 1), Lengths) };
}

std::vector<double> ParseFrameTimes(const std::string& option, std::string_view text)
{
  const std::vector<double> times = ParseNumbers(option, text);
  for (std::size_t k = 1; k < times.size(); ++k)
  {
    if (!(times[k] > times[k - 1]))
    {
      throw UsageError("--" + option + ": times must increase, but " + NumberText(times[k]) +
        " follows " + NumberText(times[k - 1]));
    }
  }
  return times;
}

std::vector<double> ParseSpacing(const std::string& option, std::string_view text)
{
  const std::vector<double> spacing = ParseSoMany(option, text, 3, "0.5,0.5,2");
  for (const std::string& one : SplitAtCommas(text))
  {
    ParseReal(option, one, Lengths);
  }
  return spacing;
}

std::vector<double> ParseOrigin(const std::string& option, std::string_view text)
{
  return ParseSoMany(option, text, 3, "-10,0,25.5");
}

std::vector<double> ParseDirection(const std::string& option, std::string_view text)
{
  constexpr double smallestDeterminant = 1e-5; // of unit vectors, as for images
  const std::vector<double> matrix = ParseSoMany(option, text, 9, "1,0,0,0,1,0,0,0,1");
  std::array<std::array<double, 3>, 3> axes{};
  std::array<double, 3> lengths{};
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    axes[axis] = { matrix[axis], matrix[3 + axis], matrix[6 + axis] };
    lengths[axis] = vtkMath::Normalize(axes[axis].data());
  }
  const double determinant =
    vtkMath::Determinant3x3(axes[0].data(), axes[1].data(), axes[2].data());
  if (!(std::abs(determinant) >= smallestDeterminant))
  {
    throw UsageError("--" + option +
      ": the columns of the matrix are the directions of the axes, and those of " + Quoted(text) +
      " are not independent");
  }
  constexpr double roundedToThreeDigits = 1e-3;
  if (std::any_of(lengths.begin(), lengths.end(),
        [](double length) { return std::abs(length - 1.0) > roundedToThreeDigits; }))
  {
    throw UsageError("--" + option +
      ": the columns of the matrix must have the length 1, and those of " + Quoted(text) +
      " have " + NumberText(lengths[0]) + ", " + NumberText(lengths[1]) + " and " +
      NumberText(lengths[2]) +
      "; of an affine, give these lengths with --spacing, and each column divided by its length "
      "here");
  }
  return matrix;
}

std::uint64_t ParseBytes(const std::string& option, const std::string& text)
{
  constexpr std::string_view units = "KMGT";
  std::string_view digits = text;
  double scale = 1.0;
  if (!digits.empty())
  {
    const auto unit = units.find(static_cast<char>(std::toupper(digits.back())));
    if (unit != std::string_view::npos)
    {
      scale = std::pow(1024.0, static_cast<double>(unit) + 1.0);
      digits.remove_suffix(1);
    }
  }
  const std::optional<double> value = io::ToNumber<double>(digits);
  if (!value || !(*value * scale >= 1.0) || *value * scale > 1e18)
  {
    throw UsageError(
      "--" + option + ": " + Quoted(text) + " is not an amount of memory such as 8G or 500M");
  }
  return static_cast<std::uint64_t>(*value * scale);
}

int ParseWord(
  const std::string& option, const std::string& text, const std::vector<std::string>& words)
{
  const auto found = std::find(words.begin(), words.end(), io::LowerCase(text));
  if (found != words.end())
  {
    return static_cast<int>(found - words.begin());
  }
  std::string choice;
  for (std::size_t i = 0; i < words.size(); ++i)
  {
    choice.append(i == 0 ? "" : i + 1 < words.size() ? ", " : " or ").append(words[i]);
  }
  throw UsageError("--" + option + ": must be " + choice + ", not " + Quoted(text));
}

double ParseParameter(const std::string& option, const std::string& text,
  const MeshingParameter& parameter, const ParameterRange& range)
{
  switch (parameter.Kind)
  {
    case ParameterKind::Whole:
      return ParseWhole(option, text, static_cast<int>(range.Low), static_cast<int>(range.High));
    case ParameterKind::Bytes:
      return static_cast<double>(ParseBytes(option, text));
    case ParameterKind::Word:
      return ParseWord(option, text, parameter.Words);
    default:
      return ParseReal(option, text, range,
        parameter.IsOptional() && !parameter.Zero.empty() ? "; left out: " + parameter.Zero : "");
  }
}

int ParseWhole(const std::string& option, const std::string& text, int low, int high)
{
  const std::optional<int> value = io::ToNumber<int>(text);
  if (!value || *value < low || *value > high)
  {
    throw UsageError("--" + option + ": must be a whole number from " + std::to_string(low) +
      " to " + std::to_string(high) + ", not " + Quoted(text));
  }
  return *value;
}

Space ParseSpace(const std::string& option, const std::string& text)
{
  return ParseWord(option, text, { "lps", "ras" }) == 0 ? Space::LPS : Space::RAS;
}

UserInterface ParseWords(const std::string& option, const std::string& text)
{
  // In the order of the enumeration.
  return static_cast<UserInterface>(static_cast<int>(UserInterface::CommandLine) +
    ParseWord(option, text, { "shell", "slicer", "python" }));
}

std::string NameOptions(UserInterface interface, const std::string& message)
{
  constexpr std::string_view letters = "abcdefghijklmnopqrstuvwxyz-";
  std::string named;
  std::size_t end = 0;
  for (std::size_t at = 0; interface != UserInterface::CommandLine &&
       (at = message.find("--", at)) != std::string::npos;)
  {
    const std::size_t first = at + 2;
    const std::size_t last = std::min(message.find_first_not_of(letters, first), message.size());
    // What is behind a quotation mark is the user's.
    const bool isOption = last > first && (at == 0 || message[at - 1] == ' ');
    if (isOption)
    {
      named += message.substr(end, at - end) +
        NameOfOption(interface, message.substr(first, last - first));
      end = last;
    }
    at = last;
  }
  return named + message.substr(end);
}

} // namespace voxplex::cli
