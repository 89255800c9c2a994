// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Formats.h"

#include "FileError.h"
#include "Writers.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <vector>

namespace voxplex::io
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

  /** In place of Write3D if 3D meshes go into two files; the second has this extension. */
  const char* CompanionExtension = nullptr;
  void (*WriteTwoFiles)(const MeshData& mesh, const std::string& path,
    const std::string& companionName, const std::string& companionPath) = nullptr;

  bool Has(std::optional<int> dimension) const
  {
    const bool has3D = this->Write3D || this->WriteTwoFiles;
    return !dimension || (*dimension == 3 ? has3D : this->Write4D != nullptr);
  }
};

constexpr std::array Formats{
  Format{ Content::Mesh, ".vtu", WriteVTU, WriteSpaceTimeVTU },
  Format{ Content::Mesh, ".vtk", WriteLegacyVTKMesh, nullptr },
  Format{ Content::Mesh, ".mesh", WriteMEDIT, WriteGMF },
  Format{ Content::Mesh, ".mfem", WriteMFEM, WriteSpaceTimeMFEM },
  Format{ Content::Mesh, ".msh", WriteGmsh, nullptr },
  Format{ Content::Mesh, ".inp", WriteAbaqus, nullptr },
  Format{ Content::Mesh, ".feb", WriteFEBio, nullptr },
  Format{ Content::Mesh, ".xdmf", nullptr, nullptr, ".h5", WriteXDMF },
  Format{ Content::Interfaces, ".vtp", WriteVTP, nullptr },
  Format{ Content::Interfaces, ".vtu", WriteInterfacesVTU, WriteSpaceTimeBoundaryVTU },
  Format{ Content::Interfaces, ".stl", WriteSTL, nullptr },
  Format{ Content::Interfaces, ".ply", WritePLY, nullptr },
  Format{ Content::Interfaces, ".vtk", WriteLegacyVTKInterfaces, nullptr },
};

const Format* Find(const std::string& extension, Content content)
{
  const auto format = std::find_if(Formats.begin(), Formats.end(),
    [&](const Format& f) { return f.Kind == content && f.Extension == extension; });
  return format == Formats.end() ? nullptr : &*format;
}

const Format& Require(const std::string& name, Content content, int dimension)
{
  const std::string extension = ExtensionOf(name);
  const Format* format = Find(extension, content);
  RefuseIf(!format || !format->Has(dimension), "no format '", extension, "' for this content; use ",
    ListExtensions(content, dimension));
  return *format;
}

} // namespace

std::string ExtensionOf(const std::string& path)
{
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
    [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

bool HasFormat(const std::string& extension, Content content, std::optional<int> dimension)
{
  const Format* format = Find(extension, content);
  return format && format->Has(dimension);
}

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

std::string CompanionOf(const std::string& name)
{
  const auto format = std::find_if(Formats.begin(), Formats.end(),
    [extension = ExtensionOf(name)](const Format& f)
    { return f.CompanionExtension && f.Extension == extension; });
  return format == Formats.end()
    ? std::string()
    : std::filesystem::path(name).replace_extension(format->CompanionExtension).string();
}

void WriteFile(const MeshData& mesh, Content content, const std::string& name,
  const std::string& path, const std::string& companionPath)
{
  const Format& format = Require(name, content, 3);
  if (format.WriteTwoFiles)
  {
    format.WriteTwoFiles(mesh, path, CompanionOf(name), companionPath);
  }
  else
  {
    format.Write3D(mesh, path);
  }
}

void WriteFile(
  const SpaceTimeMeshData& mesh, Content content, const std::string& name, const std::string& path)
{
  Require(name, content, 4).Write4D(mesh, path);
}

} // namespace voxplex::io
