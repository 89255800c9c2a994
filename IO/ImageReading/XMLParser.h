// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file XMLParser.h
 * @brief Reads XML from its beginning to its end, by Expat, which VTK brings.
 */
#ifndef voxplex_io_XMLParser_h
#define voxplex_io_XMLParser_h

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>

struct XML_ParserStruct;

namespace voxplex::io
{

/** Attributes and the like, by their names. */
using TextFields = std::map<std::string, std::string, std::less<>>;

/** Empty if there is no such field. */
std::string TextOf(const TextFields& fields, std::string_view name);

/** Calls functions for what it meets. A document type, in which entities are declared, stops it. */
class XMLParser
{
public:
  struct Events
  {
    std::function<void(std::string_view name, const TextFields& attributes)> Start;
    std::function<void()> End = [] {};
    std::function<void(std::string_view text)> Text; ///< a part of what is between tags
    std::function<void()> Comment = [] {};           ///< or an instruction for a program
  };

  explicit XMLParser(Events events);

  /** Reads the next part. @return whether it is well-formed, and nothing has stopped the parser */
  bool Parse(std::string_view part, bool isLast);

  bool HasDocumentType() const { return this->HasType; }
  std::string Error() const; ///< what is wrong, and in which line

  ///@{
  /** While an event is handled: reads no more; where it is in the file, and how long, in bytes. */
  void Stop();
  std::uint64_t Offset() const;
  std::size_t Length() const;
  ///@}

private:
  static void Start(void* self, const char* name, const char** attributes);

  Events On;
  bool HasType = false;
  std::unique_ptr<XML_ParserStruct, void (*)(XML_ParserStruct*)> Parser;
};

} // namespace voxplex::io

#endif
