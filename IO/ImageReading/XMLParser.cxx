// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "XMLParser.h"

#include "Text.h"

#include <vtk_expat.h>

#include <utility>

// Expat 2.9 has new names for places.
#if 1000 * XML_MAJOR_VERSION + XML_MINOR_VERSION >= 2009
#define XML_GetCurrentLineNumber XML_GetCurrentLineNumber64
#define XML_GetCurrentByteIndex XML_GetCurrentByteIndex64
#endif

namespace voxplex::io
{

std::string TextOf(const TextFields& fields, std::string_view name)
{
  const auto field = fields.find(name);
  return field == fields.end() ? std::string() : field->second;
}

XMLParser::XMLParser(Events events)
  : On(std::move(events))
  , Parser(XML_ParserCreate(nullptr), XML_ParserFree)
{
  XML_Parser parser = this->Parser.get();
  XML_SetUserData(parser, this);
  XML_SetElementHandler(parser, XMLParser::Start,
    [](void* self, const char* /*name*/) { static_cast<XMLParser*>(self)->On.End(); });
  XML_SetCharacterDataHandler(parser,
    [](void* self, const char* text, int length) {
      static_cast<XMLParser*>(self)->On.Text({ text, static_cast<std::size_t>(length) });
    });
  XML_SetCommentHandler(
    parser, [](void* self, const char* /*text*/) { static_cast<XMLParser*>(self)->On.Comment(); });
  XML_SetProcessingInstructionHandler(parser,
    [](void* self, const char* /*target*/, const char* /*text*/)
    { static_cast<XMLParser*>(self)->On.Comment(); });
  XML_SetStartDoctypeDeclHandler(parser,
    [](void* self, const char* /*name*/, const char* /*system*/, const char* /*identifier*/,
      int /*hasInternalSubset*/)
    {
      static_cast<XMLParser*>(self)->HasType = true;
      static_cast<XMLParser*>(self)->Stop();
    });
}

void XMLParser::Start(void* self, const char* name, const char** attributes)
{
  TextFields fields;
  for (; *attributes; attributes += 2)
  {
    fields.emplace(attributes[0], attributes[1]);
  }
  static_cast<XMLParser*>(self)->On.Start(name, fields);
}

bool XMLParser::Parse(std::string_view part, bool isLast)
{
  return XML_Parse(this->Parser.get(), part.data(), static_cast<int>(part.size()), isLast) ==
    XML_STATUS_OK;
}

std::string XMLParser::Error() const
{
  return Excerpt(XML_ErrorString(XML_GetErrorCode(this->Parser.get()))) + " in line " +
    std::to_string(XML_GetCurrentLineNumber(this->Parser.get()));
}

void XMLParser::Stop()
{
  XML_StopParser(this->Parser.get(), XML_FALSE);
}

std::uint64_t XMLParser::Offset() const
{
  return static_cast<std::uint64_t>(XML_GetCurrentByteIndex(this->Parser.get()));
}

std::size_t XMLParser::Length() const
{
  return static_cast<std::size_t>(XML_GetCurrentByteCount(this->Parser.get()));
}

} // namespace voxplex::io
