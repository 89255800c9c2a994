// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PrintTable.cxx
 * @brief Prints the parameters of meshing, for what is made from them or compared with them: as JSON for scripts, or,
 * if the argument is "setters", as lines for Applications/FilterParameters.cxx.
 */
#include "MeshingParameters.h"

#include <nlohmann/json.hpp>

#include <iostream>
#include <string_view>

namespace
{

using namespace voxplex;
using nlohmann::ordered_json;

constexpr const char* Kinds[] = { "flag", "real", "whole", "bytes", "word", "labels", "label-sizes",
  "interface-sizes", "image", "times" };

/** Infinity is null, as JSON has none. */
ordered_json Range(const ParameterRange& range)
{
  return { range.Low, range.High };
}

ordered_json Describe(const MeshingParameter& p)
{
  ordered_json row = { { "name", p.Name }, { "group", TitleOf(p.Group) },
    { "kind", Kinds[static_cast<int>(p.Kind)] }, { "property", PropertyOf(p) },
    { "label", LabelOf(p) }, { "default", p.Default }, { "zero", p.Zero }, { "step", p.Step },
    { "unit", p.Unit }, { "dimension", p.Dimension }, { "of_repair", p.IsOfRepair() },
    { "words", p.Words }, { "range", Range(p.Range) },
    { "usual", Range(p.Usual.value_or(p.Range)) }, { "low_is_outside", p.Range.LowIsOutside },
    { "force", nullptr } };
  if (const auto limit = p.ForceBelow ? p.ForceBelow : p.ForceAbove)
  {
    row["force"] = *limit;
  }
  constexpr std::pair<const char*, UserInterface> interfaces[] = {
    { "option", UserInterface::CommandLine }, { "slicer", UserInterface::Slicer },
    { "python", UserInterface::Python }, { "panel", UserInterface::ParaView }
  };
  for (const auto& [key, interface] : interfaces)
  {
    const std::string name = NameIn(interface, p);
    row[key] = name;
    row[key + std::string("_help")] = name.empty() ? "" : Describe(interface, p);
  }
  row["message"] = InTermsOf(UserInterface::VTK, "{" + p.Name + "}");
  return row;
}

/** The method of the class that has it. Lists have others. */
void PrintSetter(const MeshingParameter& p)
{
  constexpr const char* classes[] = { "Filter", "", "", "Tets", "Pentatopes" };
  if (p.Kind < ParameterKind::Labels)
  {
    std::cout << "{ \"" << p.Name << "\", To(&"
              << (p.IsOfRepair() ? "Repair" : classes[p.Dimension]) << "::Set" << PropertyOf(p)
              << ") },\n";
  }
}

} // namespace

int main(int argc, char* argv[])
{
  if (argc > 1 && argv[1] == std::string_view("setters"))
  {
    for (const MeshingParameter& parameter : MeshingParameters())
    {
      PrintSetter(parameter);
    }
    return 0;
  }
  ordered_json table;
  for (const MeshingParameter& parameter : MeshingParameters())
  {
    table.push_back(Describe(parameter));
  }
  std::cout << table.dump(1) << '\n';
}
