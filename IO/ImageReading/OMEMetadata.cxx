// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "OMEMetadata.h"

#include "Expat.h"
#include "FileError.h"
#include "Text.h"

#include <memory>
#include <string_view>
#include <type_traits>

namespace voxplex::io
{
namespace
{

struct Parsing
{
  XML_Parser Parser = nullptr;
  OMEMetadata Metadata;
  bool IsInUUID = false;
  std::size_t DepthOfAnnotations = 0; ///< elements that are open, from StructuredAnnotations on
  bool HasDocumentType = false;
};

Parsing& At(void* data)
{
  return *static_cast<Parsing*>(data);
}

/** Without the prefix of a namespace. */
std::string_view LocalName(const char* name)
{
  const std::string_view text(name);
  return text.substr(text.find(':') + 1); // all of it if there is none
}

TextFields FieldsOf(const char** attributes)
{
  TextFields fields;
  for (; *attributes; attributes += 2)
  {
    fields.emplace(LocalName(attributes[0]), attributes[1]);
  }
  return fields;
}

std::string TextOf(const TextFields& fields, std::string_view name)
{
  const auto field = fields.find(name);
  return field == fields.end() ? std::string() : field->second;
}

void StartElement(void* data, const char* qualifiedName, const char** attributes)
{
  OMEMetadata& metadata = At(data).Metadata;
  const std::string_view name = LocalName(qualifiedName);
  if (At(data).DepthOfAnnotations > 0 || name == "StructuredAnnotations")
  {
    ++At(data).DepthOfAnnotations; // they may hold elements of any name
  }
  else if (name == "OME")
  {
    metadata.File = TextOf(FieldsOf(attributes), "UUID");
  }
  else if (name == "BinaryOnly")
  {
    metadata.CompanionFile = TextOf(FieldsOf(attributes), "MetadataFile");
  }
  else if (name == "Image")
  {
    ++metadata.Images;
  }
  else if (name == "Pixels" && metadata.Images == 1)
  {
    metadata.Pixels = FieldsOf(attributes);
  }
  else if (name == "TiffData" && metadata.Images == 1)
  {
    metadata.TiffData.push_back({ FieldsOf(attributes), {}, {} });
  }
  else if (name == "UUID" && !metadata.TiffData.empty())
  {
    metadata.TiffData.back().FileName = TextOf(FieldsOf(attributes), "FileName");
    At(data).IsInUUID = true;
  }
}

void EndElement(void* data, const char* /*name*/)
{
  Parsing& parsing = At(data);
  parsing.IsInUUID = false;
  parsing.DepthOfAnnotations -= parsing.DepthOfAnnotations > 0 ? 1 : 0;
}

void AddText(void* data, const char* text, int length)
{
  if (At(data).IsInUUID)
  {
    At(data).Metadata.TiffData.back().File.append(text, static_cast<std::size_t>(length));
  }
}

/** Entities are declared in one, and OME needs none. */
void RefuseDocumentType(void* data, const char* /*name*/, const char* /*system*/,
  const char* /*identifier*/, int /*hasInternalSubset*/)
{
  At(data).HasDocumentType = true;
  XML_StopParser(At(data).Parser, XML_FALSE);
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
  const std::unique_ptr<std::remove_pointer_t<XML_Parser>, void (*)(XML_Parser)> parser(
    XML_ParserCreate(nullptr), XML_ParserFree);
  Parsing parsing;
  parsing.Parser = parser.get();
  XML_SetUserData(parser.get(), &parsing);
  XML_SetElementHandler(parser.get(), StartElement, EndElement);
  XML_SetCharacterDataHandler(parser.get(), AddText);
  XML_SetStartDoctypeDeclHandler(parser.get(), RefuseDocumentType);
  constexpr std::size_t most = 1 << 30;
  if (description.size() > most)
  {
    throw FileError("its OME metadata are longer than 1 GiB");
  }
  const std::size_t first = description.find_first_not_of(" \t\r\n");
  const std::string_view text = std::string_view(description).substr(first);
  if (XML_Parse(parser.get(), text.data(), static_cast<int>(text.size()), XML_TRUE) !=
    XML_STATUS_OK)
  {
    throw FileError(parsing.HasDocumentType
        ? "its OME metadata have a document type, which OME does not use"
        : "its OME metadata are damaged: " +
          Excerpt(XML_ErrorString(XML_GetErrorCode(parser.get()))) + " in line " +
          std::to_string(LineOf(parser.get())));
  }
  return parsing.Metadata;
}

} // namespace voxplex::io
