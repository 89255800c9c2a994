// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/** @file PrintTable.cxx @brief Prints the parameters of meshing as JSON, for the scripts and tests beside it. */
#include "MeshingParameters.h"

#include <cmath>
#include <iostream>
#include <sstream>

namespace
{

using namespace voxplex;

/** Quotes a text for JSON. The texts of the table have no control characters. */
std::string Quoted(const std::string& text)
{
  std::string quoted = "\"";
  for (const char c : text)
  {
    quoted += (c == '"' || c == '\\') ? std::string{ '\\', c } : std::string{ c };
  }
  return quoted + '"';
}

const char* NameOf(ParameterKind kind)
{
  constexpr const char* names[] = { "flag", "real", "whole", "bytes", "word", "labels",
    "label-sizes", "interface-sizes", "image", "times" };
  return names[static_cast<int>(kind)];
}

std::string Limit(double value)
{
  std::ostringstream text;
  text.precision(17);
  text << value;
  return std::isfinite(value) ? text.str() : "null";
}

std::string RangeText(const ParameterRange& range)
{
  return "[" + Limit(range.Low) + ", " + Limit(range.High) + "]";
}

std::string List(const std::vector<std::string>& words)
{
  std::string text;
  for (const std::string& word : words)
  {
    text += (text.empty() ? "" : ", ") + Quoted(word);
  }
  return "[" + text + "]";
}

void Print(const MeshingParameter& p)
{
  const auto text = [](const char* key, const std::string& value)
  { std::cout << ", \"" << key << "\": " << Quoted(value); };
  std::cout << "  {\"name\": " << Quoted(p.Name);
  text("group", TitleOf(p.Group));
  text("kind", NameOf(p.Kind));
  text("property", PropertyOf(p));
  text("default", p.Default);
  text("unit", p.Unit);
  std::cout << ", \"dimension\": " << p.Dimension << ", \"words\": " << List(p.Words)
            << ", \"range\": " << RangeText(p.Range)
            << ", \"usual\": " << RangeText(p.Usual.value_or(p.Range))
            << ", \"low_is_outside\": " << (p.Range.LowIsOutside ? "true" : "false")
            << ", \"force\": " << Limit(p.ForceBelow.value_or(p.ForceAbove.value_or(NAN)));
  const std::pair<const char*, UserInterface> interfaces[] = { { "option",
                                                                 UserInterface::CommandLine },
    { "slicer", UserInterface::Slicer }, { "python", UserInterface::Python } };
  for (const auto& [key, interface] : interfaces)
  {
    const std::string name = NameIn(interface, p);
    text(key, name);
    text((std::string(key) + "_help").c_str(), name.empty() ? "" : Describe(interface, p));
  }
  std::cout << '}';
}

} // namespace

int main()
{
  const char* separator = "[\n";
  for (const MeshingParameter& parameter : MeshingParameters())
  {
    std::cout << separator;
    Print(parameter);
    separator = ",\n";
  }
  std::cout << "\n]\n";
}
