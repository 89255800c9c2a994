// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "OutputFormats.h"

#include "Errors.h"

#include <vtkSimplexMeshWriter.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

namespace voxplex::cli
{
namespace
{

const char* NameOf(OutputOption option)
{
  switch (option)
  {
    case OutputOption::Output:
      return "--output";
    case OutputOption::Interfaces:
      return "--plc";
    default:
      return "--stats";
  }
}

int ContentOf(OutputOption option)
{
  return option == OutputOption::Output ? vtkSimplexMeshWriter::CONTENT_MESH
                                        : vtkSimplexMeshWriter::CONTENT_INTERFACES;
}

/** In lower case, with its dot; empty if there is none. */
std::string ExtensionOf(const std::string& path)
{
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
    [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

bool Takes(OutputOption option, const std::string& path, std::optional<int> dimension)
{
  return option == OutputOption::Statistics
    ? ExtensionOf(path) == ".json"
    : vtkSimplexMeshWriter::HasFormat(path, ContentOf(option), dimension.value_or(0));
}

/** Which extensions to use, of one dimension or of both. */
std::string Advice(OutputOption option, std::optional<int> dimension)
{
  if (dimension || option == OutputOption::Statistics)
  {
    return "; use " + ListExtensions(option, dimension.value_or(3));
  }
  return "; use " + ListExtensions(option, 3) + " (of a space-time image " +
    ListExtensions(option, 4) + ")";
}

} // namespace

std::string ListExtensions(OutputOption option, int dimension)
{
  return option == OutputOption::Statistics
    ? ".json"
    : vtkSimplexMeshWriter::ListExtensions(ContentOf(option), dimension);
}

void RequireFormat(OutputOption option, const std::string& path, std::optional<int> dimension)
{
  const std::string extension = ExtensionOf(path);
  if (path.empty() || Takes(option, path, dimension))
  {
    return;
  }
  const bool isKnown = Takes(option, path, std::nullopt);
  std::string message = std::string(NameOf(option)) + ": ";
  if (isKnown)
  {
    // What holds a mesh of space-time holds one of three dimensions, too.
    message += "'" + extension + "' does not hold the " +
      (option == OutputOption::Output ? "pentatopes" : "tetrahedra between labels") +
      " of a space-time image, and the input is one";
  }
  else
  {
    message += extension.empty() ? "'" + path + "' has no extension"
                                 : "the format '" + extension + "' is not known here";
  }
  message += Advice(option, dimension);
  for (const OutputOption other :
    { OutputOption::Output, OutputOption::Interfaces, OutputOption::Statistics })
  {
    if (!isKnown && Takes(other, path, std::nullopt))
    {
      message += " (" + extension + " goes with " + NameOf(other) + ")";
    }
  }
  throw UsageError(message);
}

} // namespace voxplex::cli
