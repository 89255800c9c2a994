// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "OMEMetadata.h"

#include "FileError.h"

#include <string_view>

namespace voxplex::io
{
namespace
{

/** What is read so far. */
struct Parsing
{
  OMEMetadata Metadata;
  bool IsInUUID = false;
  std::size_t DepthOfAnnotations = 0; ///< elements that are open, from StructuredAnnotations on

  void Start(std::string_view qualifiedName, const TextFields& attributes);
  void End();
  void AddText(std::string_view text);
};

void Parsing::Start(std::string_view qualifiedName, const TextFields& attributes)
{
  const std::string_view name =
    qualifiedName.substr(qualifiedName.find(':') + 1); // without the prefix of a namespace, if any
  if (this->DepthOfAnnotations > 0 || name == "StructuredAnnotations")
  {
    ++this->DepthOfAnnotations; // they may hold elements of any name
  }
  else if (name == "OME")
  {
    this->Metadata.File = TextOf(attributes, "UUID");
  }
  else if (name == "BinaryOnly")
  {
    this->Metadata.CompanionFile = TextOf(attributes, "MetadataFile");
  }
  else if (name == "Image")
  {
    ++this->Metadata.Images;
  }
  else if (name == "Pixels" && this->Metadata.Images == 1)
  {
    this->Metadata.Pixels = attributes;
  }
  else if (name == "TiffData" && this->Metadata.Images == 1)
  {
    this->Metadata.TiffData.push_back({ attributes, {}, {} });
  }
  else if (name == "UUID" && !this->Metadata.TiffData.empty())
  {
    this->Metadata.TiffData.back().FileName = TextOf(attributes, "FileName");
    this->IsInUUID = true;
  }
}

void Parsing::End()
{
  this->IsInUUID = false;
  this->DepthOfAnnotations -= this->DepthOfAnnotations > 0 ? 1 : 0;
}

void Parsing::AddText(std::string_view text)
{
  if (this->IsInUUID)
  {
    this->Metadata.TiffData.back().File.append(text);
  }
}

} // namespace

bool IsOMEMetadata(const std::string& description)
{
  const std::size_t first = description.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  return first != std::string::npos && description[first] == '<' &&
    (description.find("<OME") != std::string::npos ||
      description.find(":OME") != std::string::npos);
}

OMEMetadata ParseOMEMetadata(const std::string& description)
{
  constexpr std::size_t most = 1 << 30;
  RefuseIf(description.size() > most, "its OME metadata are longer than 1 GiB");
  Parsing parsing;
  XMLParser parser(
    { [&](std::string_view name, const TextFields& attributes) { parsing.Start(name, attributes); },
      [&] { parsing.End(); }, [&](std::string_view text) { parsing.AddText(text); } });
  const std::size_t first = description.find_first_not_of(" \t\r\n");
  if (!parser.Parse(std::string_view(description).substr(first), true))
  {
    RefuseIf(
      parser.HasDocumentType(), "its OME metadata have a document type, which OME does not use");
    Refuse("its OME metadata are damaged: ", parser.Error());
  }
  return parsing.Metadata;
}

} // namespace voxplex::io
