// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file OptionValues.h
 * @brief From the text of an option to its value.
 *
 * Each function takes the name of the option, without dashes, for the message, and throws UsageError
 * if the text is not what is wanted.
 */
#ifndef voxplex_cli_OptionValues_h
#define voxplex_cli_OptionValues_h

#include "MeshingParameters.h"
#include "Parameters.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace voxplex::cli
{

std::string Quoted(std::string_view text);

/** A text that is not empty. */
std::string ParseName(const std::string& option, const std::string& text);

/** A finite number in the range. The hint ends the message about numbers that are too small. */
double ParseReal(const std::string& option, std::string_view text, const ParameterRange& range,
  const std::string& hint = "");

/** A whole number from low to high. */
int ParseWhole(const std::string& option, const std::string& text, int low, int high);

/** A label by its number; nothing if the text is no number, and thus a name. */
std::optional<std::int64_t> ParseLabelNumber(const std::string& option, std::string_view text);

/** "1,Tibia, 5": the texts between the commas, without blanks around them. */
std::vector<std::string> SplitAtCommas(std::string_view text);

/** "3=1.5,7,0=2": "3=1.5" and "7,0=2". A comma that follows an equals sign and a number separates. */
std::vector<std::string> SplitBehindNumbers(std::string_view text);

/** "0.5,1": finite numbers with commas between them. */
std::vector<double> ParseNumbers(const std::string& option, std::string_view text);

/** "Tibia,Femur", "3=1.5", "Tibia,0=1.5"; the last = counts. The size is in the range of the parameter. */
LabelText ParseLabels(
  const std::string& option, std::string_view text, const MeshingParameter& parameter);

/** The place of one of several words. The case of letters does not count. */
int ParseWord(
  const std::string& option, const std::string& text, const std::vector<std::string>& words);

/** What the parameter wants, within its range: a number, a word, a text that is not empty, numbers. Not of labels. */
ParameterValue ParseParameter(
  const std::string& option, const std::string& text, const MeshingParameter& parameter);

/** Whose words errors and warnings have: "shell" or "python". */
UserInterface ParseWords(const std::string& option, const std::string& text);

/** A message that names options, "--facet-angle", with the names that an interface has for them. */
std::string NameOptions(UserInterface interface, const std::string& message);

} // namespace voxplex::cli

#endif
