// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file DICOMDataSet.h
 * @brief The data elements of a DICOM file (PS3.5 and PS3.10).
 *
 * GDCM has a reader for them, too. Where it meets what is no DICOM it begins anew by the grammar of some faulty
 * writer, it takes memory for what elements claim, puts zeros where pixels are missing, and ends the program at odd
 * values. This one has one grammar, and reads values when they are asked for.
 */
#ifndef voxplex_io_DICOMDataSet_h
#define voxplex_io_DICOMDataSet_h

#include "InputFile.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <iosfwd>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace voxplex::io
{

/** Group and number of an element, and its name for messages. */
struct DICOMTag
{
  std::uint32_t Number = 0;
  const char* Name = "";
};

/** "Rows (0028,0010)", or "(0028,0010)" if it has no name */
std::ostream& operator<<(std::ostream& stream, const DICOMTag& tag);

std::uint32_t ReadNumber(std::span<const std::byte> bytes, bool isBigEndian);

/** How elements are written, and pixels compressed. */
struct DICOMSyntax
{
  std::string UID;        ///< of the transfer syntax; empty if the file does not say
  bool IsExplicit = true; ///< each element names its value representation
  bool IsBigEndian = false;
};

/** Where the value of an element is. */
struct DICOMElement
{
  static constexpr std::uint32_t Undefined = 0xFFFFFFFF; ///< the value ends with a delimiter

  std::uint32_t Tag = 0;
  std::array<char, 2> Representation{}; ///< '\0' in implicit syntax
  std::uint32_t Length = 0;
  std::uint64_t Position = 0;

  std::string_view VR() const { return { this->Representation.data(), 2 }; }
  bool HasVR() const { return this->Representation[0] != '\0'; }
};

/** A file, or what the file is when it is unpacked. Positions count from its first byte. */
class DICOMSource;

/** The elements of a file up to its pixels, or of an item of a sequence. */
class DICOMDataSet
{
public:
  /** @throws FileError: what is wrong with the elements */
  explicit DICOMDataSet(const std::string& path);

  const DICOMSyntax& Syntax() const { return this->Encoding; }
  const DICOMElement* Find(const DICOMTag& tag) const;

  /** Without blanks and zeros at its ends; empty if there is none. */
  std::string Text(const DICOMTag& tag) const;

  /** Numbers written as text; empty if there are none. @throws FileError if they are others than `count` finite ones */
  std::vector<double> Numbers(const DICOMTag& tag, std::size_t count) const;
  std::vector<double> AnyNumbers(const DICOMTag& tag) const;

  /** An unsigned number of two bytes. */
  std::optional<unsigned> Short(const DICOMTag& tag) const;
  /** Several; none if there are none, or a byte is left over. */
  std::vector<unsigned> Shorts(const DICOMTag& tag) const;

  /** Of a sequence; none if it is missing. */
  std::vector<DICOMDataSet> Items(const DICOMTag& tag) const;

  /** What the pixels are compressed to: the table of offsets, which may be empty, and the fragments. */
  std::vector<DICOMElement> Fragments(const DICOMElement& pixels) const;

  /** How many bytes there are from a position on, of those asked for. */
  std::uint64_t Available(std::uint64_t position, std::uint64_t length) const;
  /** @throws FileError if there are fewer */
  void ReadBytes(std::uint64_t position, std::span<std::byte> to) const;

  /** Whether a file is DICOM by its beginning: the word DICM, or three elements of an old file without it. */
  static bool Recognize(const InputFile& file);

private:
  DICOMDataSet() = default;
  std::string Value(const DICOMTag& tag, std::span<const std::string_view> representations) const;

  std::shared_ptr<DICOMSource> Source;
  DICOMSyntax Encoding;
  std::map<std::uint32_t, DICOMElement> Elements;
};

} // namespace voxplex::io

#endif
