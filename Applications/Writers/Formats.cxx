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

/** A format of 3D meshes, 4D meshes or both; what has no writer here is written elsewhere. */
struct Format
{
  Content Kind;
  const char* Extension;
  void (*Write3D)(const MeshData& mesh, const std::string& path);
  void (*Write4D)(const SpaceTimeMeshData& mesh, const std::string& path);

  bool Has(std::optional<int> dimension) const
  {
    return this->Kind == Content::Statistics || !dimension ||
      (*dimension == 3 ? this->Write3D != nullptr : this->Write4D != nullptr);
  }
};

constexpr std::array Formats{
  Format{ Content::Mesh, ".vtu", WriteVTU, WriteSpaceTimeVTU },
  Format{ Content::Mesh, ".vtk", WriteLegacyVTKMesh, nullptr },
  Format{ Content::Mesh, ".mesh", WriteMEDIT, WriteGMF },
  Format{ Content::Mesh, ".mfem", nullptr, WriteMFEM },
  Format{ Content::Mesh, ".msh", WriteGmsh, nullptr },
  Format{ Content::Mesh, ".inp", WriteAbaqus, nullptr },
  Format{ Content::Interfaces, ".vtp", WriteVTP, nullptr },
  Format{ Content::Interfaces, ".vtu", nullptr, WriteSpaceTimeBoundaryVTU },
  Format{ Content::Interfaces, ".stl", WriteSTL, nullptr },
  Format{ Content::Interfaces, ".ply", WritePLY, nullptr },
  Format{ Content::Interfaces, ".vtk", WriteLegacyVTKInterfaces, nullptr },
  Format{ Content::Statistics, ".json", nullptr, nullptr },
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

const char* NameOf(Content content, int dimension)
{
  if (content == Content::Mesh)
  {
    return dimension == 3 ? "tetrahedra" : "pentatopes";
  }
  return dimension == 3 ? "triangles between labels" : "tetrahedra between labels";
}

/** Which extensions to use, of one dimension or of both. */
std::string Advice(Content content, std::optional<int> dimension)
{
  if (dimension || content == Content::Statistics)
  {
    return "; use " + ListExtensions(content, dimension.value_or(3));
  }
  return "; use " + ListExtensions(content, 3) + " (of a space-time image " +
    ListExtensions(content, 4) + ")";
}

const Format& Require(const std::string& name, Content content)
{
  const Format* format = Find(ExtensionOf(name), content);
  if (!format)
  {
    throw std::logic_error("no writer for '" + name + "'");
  }
  return *format;
}

} // namespace

std::string ListExtensions(Content content, int dimension)
{
  std::vector<std::string> extensions;
  for (const Format& format : Formats)
  {
    if (format.Kind == content && format.Has(dimension))
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

void RequireFormat(
  const std::string& option, const std::string& path, Content content, std::optional<int> dimension)
{
  const std::string extension = ExtensionOf(path);
  const Format* format = Find(extension, content);
  if (format && format->Has(dimension))
  {
    return;
  }
  std::string message = "--" + option + ": ";
  if (format)
  {
    const bool isSpaceTime = *dimension == 4;
    message += "'" + extension + "' does not hold the " + NameOf(content, *dimension) +
      (isSpaceTime ? " of a space-time image, and the input is one"
                   : " of a 3D image, and the input is one");
  }
  else
  {
    message += extension.empty() ? "'" + path + "' has no extension"
                                 : "the format '" + extension + "' is not known here";
  }
  message += Advice(content, dimension);
  for (const Content other : { Content::Mesh, Content::Interfaces, Content::Statistics })
  {
    const Format* theirs = Find(extension, other);
    if (!format && theirs)
    {
      message += " (" + extension + " goes with " + OptionFor(other) + ")";
    }
  }
  throw UsageError(message);
}

void WriteFile(
  const MeshData& mesh, Content content, const std::string& name, const std::string& path)
{
  Require(name, content).Write3D(mesh, path);
}

void WriteFile(
  const SpaceTimeMeshData& mesh, Content content, const std::string& name, const std::string& path)
{
  Require(name, content).Write4D(mesh, path);
}

} // namespace voxplex::cli
