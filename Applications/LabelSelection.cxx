// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "LabelSelection.h"

#include "EditDistance.h"
#include "Errors.h"
#include "OptionValues.h"
#include "Text.h"

#include <algorithm>

namespace voxplex::cli
{
namespace
{

/** The labels with a name for which the predicate holds. */
template <typename TPredicate>
std::vector<std::int64_t> LabelsWhere(const LabelTable& table, TPredicate&& holds)
{
  std::vector<std::int64_t> labels;
  for (const auto& [label, entry] : table.Entries)
  {
    if (holds(entry.Name))
    {
      labels.push_back(label);
    }
  }
  return labels;
}

/** The labels with a name; those whose name differs in the case of letters only if there are no others. */
std::vector<std::int64_t> LabelsCalled(const std::string& name, const LabelTable& table)
{
  std::vector<std::int64_t> labels =
    LabelsWhere(table, [&name](const std::string& other) { return other == name; });
  if (labels.empty())
  {
    const std::string lower = io::LowerCase(name);
    labels = LabelsWhere(
      table, [&lower](const std::string& other) { return io::LowerCase(other) == lower; });
  }
  return labels;
}

/** "; did you mean 'Tibia' (3) or 'Fibula' (4)?", the nearest first, or a hint where to find names. */
std::string Suggest(const std::string& name, const LabelTable& table)
{
  constexpr std::size_t most = 5;
  const std::string lower = io::LowerCase(name);
  std::multimap<std::size_t, std::string> near;
  for (const auto& [label, entry] : table.Entries)
  {
    const std::string other = io::LowerCase(entry.Name);
    const bool isPart = other.find(lower) != std::string::npos;
    const std::size_t distance = isPart ? 1 : EditDistance(lower, other);
    if (distance <= std::max<std::size_t>(2, lower.size() / 3))
    {
      near.emplace(distance, Quoted(entry.Name) + " (" + std::to_string(label) + ")");
    }
  }
  std::string text;
  std::size_t count = 0;
  const std::size_t shown = std::min(near.size(), most);
  for (const auto& [distance, match] : near)
  {
    if (count++ == shown)
    {
      break;
    }
    text += (count == 1 ? "" : count == near.size() ? " or " : ", ") + match;
  }
  if (near.size() > most)
  {
    text += " or one of " + std::to_string(near.size() - most) + " more";
  }
  return text.empty() ? "" : "; did you mean " + text + "?";
}

/** @throws UsageError */
std::int64_t ToLabel(const std::string& option, const std::string& text, const LabelTable& table)
{
  if (const auto number = ParseLabelNumber(option, text))
  {
    return *number;
  }
  const std::vector<std::int64_t> labels = LabelsCalled(text, table);
  if (labels.size() == 1)
  {
    return labels.front();
  }
  const std::string begin = "--" + option + ": ";
  if (table.Entries.empty())
  {
    throw UsageError(begin + Quoted(text) +
      " is not a number, and the labels of the image have no names; give numbers, or names with "
      "--label-table");
  }
  if (labels.empty())
  {
    throw UsageError(
      begin + "no label of the image is called " + Quoted(text) + Suggest(text, table));
  }
  std::string list;
  for (const std::int64_t label : labels)
  {
    list += (list.empty() ? "" : ", ") + std::to_string(label);
  }
  throw UsageError(
    begin + "several labels are called " + Quoted(text) + ": " + list + "; give numbers");
}

/** Those of 3-7, or one. @throws UsageError */
void AddLabels(const std::string& text, const LabelTable& table, std::vector<std::int64_t>& labels)
{
  constexpr std::int64_t most = 100'000;
  const std::size_t dash = text.find('-');
  const auto first = io::ToNumber<std::int64_t>(text.substr(0, dash));
  const auto last =
    io::ToNumber<std::int64_t>(dash == std::string::npos ? "" : text.substr(dash + 1));
  if (!first || !last || !LabelsCalled(text, table).empty())
  {
    labels.push_back(ToLabel("labels", text, table));
    return;
  }
  if (!(*first >= 1 && *first <= *last && *last - *first < most))
  {
    throw UsageError("--labels: " + Quoted(text) +
      " is not a range of labels, such as 3-7: from 1 on, the smaller first, at most 100000 of "
      "them");
  }
  for (std::int64_t i = 0; i <= *last - *first; ++i)
  {
    labels.push_back(*first + i);
  }
}

std::map<std::int64_t, double> ToSizes(
  const std::string& option, const std::vector<LabelSizeText>& texts, const LabelTable& table)
{
  std::map<std::int64_t, double> sizes;
  for (const LabelSizeText& size : texts)
  {
    const std::int64_t label = ToLabel(option, size.Label, table);
    if (!sizes.emplace(label, size.Size).second)
    {
      throw UsageError("--" + option + ": label " + std::to_string(label) + " is given twice");
    }
  }
  return sizes;
}

/** The one or two labels of --interface-size: a name that has commas, or what commas separate. */
std::vector<std::string> LabelsOfInterface(const std::string& text, const LabelTable& table)
{
  std::vector<std::string> labels =
    LabelsCalled(text, table).size() == 1 ? std::vector{ text } : SplitAtCommas(text);
  if (labels.size() > 2)
  {
    throw UsageError("--interface-size: " + Quoted(text) +
      " is more than two labels; an interface lies between two, as in 3,7=0.5, and 3=0.5 "
      "means all of label 3");
  }
  return labels;
}

void TakeInterfaceSizes(const Parameters& p, const LabelTable& table, LabelSelection& selection)
{
  for (const InterfaceSizeText& size : p.InterfaceSizeTexts)
  {
    std::pair<std::int64_t, std::int64_t> labels{ LabelSelection::AnyLabel,
      LabelSelection::AnyLabel };
    for (const std::string& text : LabelsOfInterface(size.Labels, table))
    {
      const std::int64_t label = text == "0" ? 0 : ToLabel("interface-size", text, table);
      if (label == labels.first)
      {
        throw UsageError("--interface-size: label " + text + " has no interface with itself");
      }
      if (label != 0 && !selection.Labels.empty() &&
        !std::binary_search(selection.Labels.begin(), selection.Labels.end(), label))
      {
        throw UsageError("--interface-size: label " + text + " is not among those of --labels");
      }
      labels = { std::max(labels.first, label), std::min(labels.first, label) };
    }
    if (!selection.InterfaceSizes.emplace(labels, size.Size).second)
    {
      throw UsageError("--interface-size: " + Quoted(size.Labels) + " is given twice");
    }
  }
}

} // namespace

bool HasNames(const Parameters& p)
{
  const auto isName = [](const std::string& text)
  { return !ParseLabelNumber("labels", text).has_value(); };
  const auto hasName = [&isName](const std::string& text)
  {
    const std::vector<std::string> labels = SplitAtCommas(text);
    return std::any_of(labels.begin(), labels.end(), isName);
  };
  const auto hasNamed = [&isName](const std::vector<LabelSizeText>& sizes)
  {
    return std::any_of(sizes.begin(), sizes.end(),
      [&isName](const LabelSizeText& size) { return isName(size.Label); });
  };
  return std::any_of(p.LabelTexts.begin(), p.LabelTexts.end(), hasName) ||
    hasNamed(p.LabelSizeTexts) || hasNamed(p.ThicknessTexts) || hasNamed(p.ShellTexts) ||
    std::any_of(p.InterfaceSizeTexts.begin(), p.InterfaceSizeTexts.end(),
      [](const InterfaceSizeText& size)
      {
        const std::vector<std::string> labels = SplitAtCommas(size.Labels);
        return std::any_of(labels.begin(), labels.end(),
          [](const std::string& text)
          { return text != "0" && !ParseLabelNumber("interface-size", text).has_value(); });
      });
}

LabelSelection SelectLabels(const Parameters& p, const LabelTable& table)
{
  LabelSelection selection;
  std::vector<std::int64_t>& labels = selection.Labels;
  for (const std::string& text : p.LabelTexts)
  {
    const bool isOneName = LabelsCalled(text, table).size() == 1;
    for (const std::string& label : isOneName ? std::vector{ text } : SplitAtCommas(text))
    {
      AddLabels(label, table, labels);
    }
  }
  std::sort(labels.begin(), labels.end());
  labels.erase(std::unique(labels.begin(), labels.end()), labels.end());

  selection.Sizes = ToSizes("label-size", p.LabelSizeTexts, table);
  for (const auto& [label, size] : selection.Sizes)
  {
    if (!labels.empty() && !std::binary_search(labels.begin(), labels.end(), label))
    {
      throw UsageError(
        "--label-size: label " + std::to_string(label) + " is not among those of --labels");
    }
  }
  TakeInterfaceSizes(p, table, selection);
  return selection;
}

void SelectRepairs(const Parameters& p, const LabelTable& table, LabelSelection& selection)
{
  selection.Thicknesses = ToSizes("min-thickness", p.ThicknessTexts, table);
  selection.Shells = ToSizes("shell", p.ShellTexts, table);
}

} // namespace voxplex::cli
