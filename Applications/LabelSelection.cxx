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

/** The one or two labels of an interface: a name that has commas, or what commas separate. */
std::vector<std::string> LabelsOfInterface(
  const std::string& option, const std::string& text, const LabelTable& table)
{
  std::vector<std::string> labels =
    LabelsCalled(text, table).size() == 1 ? std::vector{ text } : SplitAtCommas(text);
  if (labels.size() > 2)
  {
    throw UsageError("--" + option + ": " + Quoted(text) +
      " is more than two labels; an interface lies between two, as in 3,7=0.5, and 3=0.5 "
      "means all of label 3");
  }
  return labels;
}

/** @param chosen what is meshed; empty: all */
LabelValues ToSizes(const std::string& option, const std::vector<LabelText>& texts,
  bool isOfInterfaces, const LabelTable& table, const LabelValues& chosen)
{
  LabelValues sizes;
  for (const LabelText& size : texts)
  {
    std::pair<std::int64_t, std::int64_t> labels{ AnyLabel, AnyLabel };
    for (const std::string& text :
      isOfInterfaces ? LabelsOfInterface(option, size.Labels, table) : std::vector{ size.Labels })
    {
      const std::int64_t label = isOfInterfaces && text == "0" ? 0 : ToLabel(option, text, table);
      if (label == labels.first)
      {
        throw UsageError("--" + option + ": label " + text + " has no interface with itself");
      }
      if (label != 0 && !chosen.empty() && !chosen.contains({ label, AnyLabel }))
      {
        throw UsageError(
          "--" + option + ": label " + std::to_string(label) + " is not among those of --labels");
      }
      labels = { std::max(labels.first, label), std::min(labels.first, label) };
    }
    if (!sizes.emplace(labels, size.Size).second)
    {
      throw UsageError("--" + option + ": " +
        (isOfInterfaces ? Quoted(size.Labels) : "label " + std::to_string(labels.first)) +
        " is given twice");
    }
  }
  return sizes;
}

LabelValues ToLabels(const std::vector<LabelText>& texts, const LabelTable& table)
{
  std::vector<std::int64_t> labels;
  for (const LabelText& given : texts)
  {
    const std::string& text = given.Labels;
    const bool isOneName = LabelsCalled(text, table).size() == 1;
    for (const std::string& label : isOneName ? std::vector{ text } : SplitAtCommas(text))
    {
      AddLabels(label, table, labels);
    }
  }
  LabelValues values;
  for (const std::int64_t label : labels)
  {
    values.emplace(std::pair(label, AnyLabel), 0.0);
  }
  return values;
}

/** Of repair, or of meshing. */
ParameterValues Select(const Parameters& p, const LabelTable& table, bool isOfRepair)
{
  ParameterValues selection;
  const auto chosen = p.OfLabels.find("labels");
  const LabelValues labels =
    chosen == p.OfLabels.end() || isOfRepair ? LabelValues() : ToLabels(chosen->second, table);
  for (const auto& [name, texts] : p.OfLabels)
  {
    const MeshingParameter& parameter = FindParameter(name);
    if (parameter.IsOfRepair() == isOfRepair)
    {
      selection[name] = parameter.Kind == ParameterKind::Labels
        ? labels
        : ToSizes(NameIn(UserInterface::CommandLine, parameter), texts,
            parameter.Kind == ParameterKind::InterfaceSizes, table, labels);
    }
  }
  return selection;
}

} // namespace

bool HasNames(const Parameters& p)
{
  for (const auto& [name, texts] : p.OfLabels)
  {
    const bool isOne = FindParameter(name).Kind == ParameterKind::LabelSizes;
    for (const LabelText& given : texts)
    {
      for (const std::string& label :
        isOne ? std::vector{ given.Labels } : SplitAtCommas(given.Labels))
      {
        if (label != "0" && !ParseLabelNumber(name, label).has_value())
        {
          return true;
        }
      }
    }
  }
  return false;
}

ParameterValues SelectLabels(const Parameters& p, const LabelTable& table)
{
  return Select(p, table, false);
}

ParameterValues SelectRepairs(const Parameters& p, const LabelTable& table)
{
  return Select(p, table, true);
}

} // namespace voxplex::cli
