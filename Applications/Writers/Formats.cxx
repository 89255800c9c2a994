// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Formats.h"

#include "Errors.h"
#include "Writers.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <stdexcept>
#include <vector>

namespace voxplex::cli
{
namespace
{

struct Format
{
  Content Kind;
  const char* Extension;
  WriteFunction Write;
};

constexpr std::array Formats{
  Format{ Content::Mesh, ".vtu", WriteVTU },
  Format{ Content::Mesh, ".vtk", WriteLegacyVTKMesh },
  Format{ Content::Mesh, ".mesh", WriteMEDIT },
  Format{ Content::Mesh, ".msh", WriteGmsh },
  Format{ Content::Mesh, ".inp", WriteAbaqus },
  Format{ Content::Interfaces, ".vtp", WriteVTP },
  Format{ Content::Interfaces, ".stl", WriteSTL },
  Format{ Content::Interfaces, ".ply", WritePLY },
  Format{ Content::Interfaces, ".vtk", WriteLegacyVTKInterfaces },
  Format{ Content::Statistics, ".json", nullptr },
};

const char* OptionFor(Content content)
{
  switch (content)
  {
    case Content::Mesh:
      return "--output";
    case Content::Interfaces:
      return "--plc";
    default:
      return "--stats";
  }
}

std::string ExtensionOf(const std::string& path)
{
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
    [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

const Format* Find(const std::string& extension, Content content)
{
  const auto format = std::find_if(Formats.begin(), Formats.end(),
    [&](const Format& f) { return f.Kind == content && f.Extension == extension; });
  return format == Formats.end() ? nullptr : &*format;
}

} // namespace

std::string ListExtensions(Content content)
{
  std::vector<std::string> extensions;
  for (const Format& format : Formats)
  {
    if (format.Kind == content)
    {
      extensions.emplace_back(format.Extension);
    }
  }
  std::string phrase = extensions.front();
  for (std::size_t i = 1; i < extensions.size(); ++i)
  {
    phrase += (i + 1 == extensions.size() ? " or " : ", ") + extensions[i];
  }
  return phrase;
}

void RequireFormat(const std::string& option, const std::string& path, Content content)
{
  const std::string extension = ExtensionOf(path);
  if (Find(extension, content))
  {
    return;
  }
  std::string message = "--" + option + ": ";
  message += extension.empty() ? "'" + path + "' has no extension"
                               : "the format '" + extension + "' is not known here";
  message += "; use " + ListExtensions(content);
  for (const Content other : { Content::Mesh, Content::Interfaces, Content::Statistics })
  {
    if (Find(extension, other))
    {
      message += " (" + extension + " goes with " + OptionFor(other) + ")";
    }
  }
  throw UsageError(message);
}

WriteFunction FindWriter(const std::string& path, Content content)
{
  const Format* format = Find(ExtensionOf(path), content);
  if (!format || !format->Write)
  {
    throw std::logic_error("no writer for '" + path + "'");
  }
  return format->Write;
}

} // namespace voxplex::cli
