// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TextHeader.h
 * @brief The fields in the text header of an NRRD or MetaImage file, as they are written there.
 */
#ifndef voxplex_io_TextHeader_h
#define voxplex_io_TextHeader_h

#include "ScalarImage.h"

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace voxplex::io
{

class InputFile;
struct StoredVoxels;

/**
 * Keys are in lower case. "key: value" and "key = value" are fields. NRRD keeps "key:=value" apart, as pairs, whose
 * keys may be those of fields; of two pairs with one key the last counts.
 */
class TextHeader
{
public:
  /**
   * Reads up to the end of the header: an empty line in NRRD, the field ElementDataFile in MetaImage.
   *
   * @throws FileError: no end within 1 MiB, a line that is no field, a field that is given twice
   */
  explicit TextHeader(const InputFile& file);

  /** The value without surrounding blanks, or null. */
  const std::string* Find(const std::string& key) const;

  /** The first of these keys that is there, or null. */
  const std::string* FindAny(std::initializer_list<const char*> keys) const;

  /** The value as messages show it; empty if there is no such field. */
  std::string Shown(std::initializer_list<const char*> keys) const;

  /** The value in lower case; `missing` if there is no such field. */
  std::string Word(std::initializer_list<const char*> keys, const std::string& missing) const;

  /**
   * A list of numbers; empty if there is no such field. @throws FileError for words that are no numbers, and for
   * another number of them than `count`
   */
  std::vector<double> Numbers(std::initializer_list<const char*> keys, std::size_t count) const;

  /** A list of whole numbers, as above. */
  std::vector<std::int64_t> Wholes(
    std::initializer_list<const char*> keys, std::size_t count) const;

  /** A whole number. @throws FileError for other values */
  std::int64_t Whole(std::initializer_list<const char*> keys, std::int64_t missing) const;

  /** The value of a pair, or null. */
  const std::string* FindPair(const std::string& key) const;

  const std::map<std::string, std::string>& AllPairs() const { return this->Pairs; }

  /** Keys of the fields, and how the file writes them. */
  const std::map<std::string, std::string>& Own() const { return this->Spellings; }

  /**
   * Says in which files the voxels are: those that `value` names by one name, a pattern or LIST, or behind the header.
   *
   * @param value null, or MetaImage's LOCAL, for voxels behind the header
   */
  void SetFiles(const std::string* value, bool anywhere, StoredVoxels& stored) const;

private:
  /** Returns whether the header ends with this line. */
  bool TakeLine(std::string line);

  /** The name of a field as the file writes it. */
  std::string SpellingOf(std::initializer_list<const char*> keys) const;

  std::string Path;
  std::map<std::string, std::string> Fields;
  std::map<std::string, std::string> Spellings; ///< by key
  std::map<std::string, std::string> Pairs;
  std::vector<std::string> List;
  std::size_t Length = 0; ///< of the header, in bytes
  bool IsNRRD = false;
  bool IsInList = false;
};

/** The numbers of a list; brackets and commas separate, words that are no numbers are left out. */
std::vector<double> ParseNumbers(const std::string& text);

/** @param field in which the name is, for the message. @throws FileError for other names */
ScalarType TypeNamed(const std::string& name, const char* field, const TypeNames& names);

} // namespace voxplex::io

#endif
