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

constexpr const char* Kinds[] = { "flag", "real", "whole", "bytes", "word", "text", "file",
  "numbers", "labels", "label-sizes", "interface-sizes", "image", "times" };

/** The class that has the parameter; times of frames are also of the reader. */
const char* ClassOf(const MeshingParameter& p)
{
  constexpr const char* filters[] = { "Filter", "", "", "Tets", "Pentatopes" };
  return p.IsOfReading() ? "Reader" : p.IsOfRepair() ? "Repair" : filters[p.Dimension];
}

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
    { "unit", p.Unit }, { "dimension", p.Dimension }, { "class", ClassOf(p) },
    { "needs", p.Needs.Other }, { "excludes", p.Excludes.Other }, { "words", p.Words },
    { "range", Range(p.Range) }, { "usual", Range(p.Usual.value_or(p.Range)) },
    { "low_is_outside", p.Range.LowIsOutside }, { "force", nullptr } };
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

/** The method of the class that has it: of times, which filters know from the image, that of the reader. */
void PrintSetter(const MeshingParameter& p)
{
  const bool isTimes = p.Kind == ParameterKind::Times;
  if (p.Kind != ParameterKind::Image)
  {
    std::cout << "{ \"" << p.Name << "\", To(&" << (isTimes ? "Reader" : ClassOf(p))
              << (isTimes || p.Kind == ParameterKind::Labels ? "::Add" : "::Set") << PropertyOf(p)
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
