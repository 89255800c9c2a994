// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "OptionValues.h"

#include "Base/NumberText.h"
#include "Errors.h"
#include "Text.h"

#include <algorithm>
#include <cctype>
#include <cmath>

namespace voxplex::cli
{
namespace
{

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

/** "8G": bytes, with K, M, G and T for powers of 1024. */
double ParseBytes(const std::string& option, const std::string& text)
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
  return std::floor(*value * scale);
}

/** As many as the example has. */
std::vector<double> ParseVector(
  const std::string& option, const std::string& text, const MeshingParameter& parameter)
{
  std::vector<double> numbers = ParseNumbers(option, text);
  const std::size_t count = SplitAtCommas(parameter.Example).size();
  if (numbers.size() != count)
  {
    throw UsageError("--" + option + ": give " + std::to_string(count) +
      " numbers with commas between them, such as " + parameter.Example + ", not " + Quoted(text));
  }
  for (const std::string& one : SplitAtCommas(text))
  {
    ParseReal(option, one, parameter.Range);
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

std::string ParseName(const std::string& option, const std::string& text)
{
  if (text.empty())
  {
    throw UsageError("--" + option + ": the name is empty");
  }
  return text;
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
    parts.emplace_back(io::Trim(text.substr(0, comma)));
    text.remove_prefix(comma == std::string_view::npos ? text.size() : comma + 1);
  }
  return parts;
}

std::vector<std::string> SplitBehindNumbers(std::string_view text)
{
  std::vector<std::string> parts;
  std::size_t equals = text.find('=');
  while (equals != std::string_view::npos)
  {
    const std::size_t comma = text.find(',', equals);
    const bool isEnd = comma != std::string_view::npos &&
      io::ToNumber<double>(io::Trim(text.substr(equals + 1, comma - equals - 1)));
    if (isEnd)
    {
      parts.emplace_back(io::Trim(text.substr(0, comma)));
      text.remove_prefix(comma + 1);
    }
    equals = text.find('=', isEnd ? 0 : equals + 1);
  }
  parts.emplace_back(io::Trim(text));
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

LabelText ParseLabels(
  const std::string& option, std::string_view text, const MeshingParameter& parameter)
{
  if (parameter.Kind == ParameterKind::Labels)
  {
    for (const std::string& label : SplitAtCommas(text))
    {
      ParseLabelNumber(option, label);
    }
    return { std::string(text) };
  }
  const bool isOfInterfaces = parameter.Kind == ParameterKind::InterfaceSizes;
  const std::size_t equals = text.rfind('=');
  if (equals == std::string_view::npos || (equals == 0 && isOfInterfaces))
  {
    throw UsageError("--" + option + ": " + Quoted(text) +
      (isOfInterfaces
          ? " is not of the form LABEL=LENGTH or LABEL,LABEL=LENGTH, such as 3=0.5 or 3,7=0.5; "
            "--delta is the sampling distance of all interfaces"
          : " is not of the form LABEL=SIZE, such as 3=1.5 or Tibia=1.5"));
  }
  const std::string labels(text.substr(0, equals));
  if (!isOfInterfaces)
  {
    ParseLabelNumber(option, labels);
  }
  return { labels, ParseReal(option, text.substr(equals + 1), parameter.Range) };
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

ParameterValue ParseParameter(
  const std::string& option, const std::string& text, const MeshingParameter& parameter)
{
  const ParameterRange& range = parameter.Range;
  switch (parameter.Kind)
  {
    case ParameterKind::Whole:
      return static_cast<double>(
        ParseWhole(option, text, static_cast<int>(range.Low), static_cast<int>(range.High)));
    case ParameterKind::Bytes:
      return ParseBytes(option, text);
    case ParameterKind::Word:
      return static_cast<double>(ParseWord(option, text, parameter.Words));
    case ParameterKind::Text:
    case ParameterKind::File:
    case ParameterKind::Image:
      return ParseName(option, text);
    case ParameterKind::Numbers:
      return ParseVector(option, text, parameter);
    case ParameterKind::Times:
      return ParseNumbers(option, text);
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

UserInterface ParseWords(const std::string& option, const std::string& text)
{
  return ParseWord(option, text, { "shell", "python" }) == 0 ? UserInterface::CommandLine
                                                             : UserInterface::Python;
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
