// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Fields.h
 * @brief Numbers and texts at fixed places of a binary header.
 */
#ifndef voxplex_io_Fields_h
#define voxplex_io_Fields_h

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>
#include <string>
#include <string_view>

namespace voxplex::io
{

/** The bytes belong to the caller, and hold all that is asked for. */
class Fields
{
public:
  Fields(std::string_view bytes, bool isBigEndian)
    : Bytes(bytes)
    , IsSwapped(isBigEndian != (std::endian::native == std::endian::big))
  {
  }

  /** @throws std::out_of_range */
  template <typename T>
  T Get(std::size_t offset) const
  {
    std::array<char, sizeof(T)> bytes{};
    const std::string_view from = this->Bytes.substr(offset, sizeof(T));
    std::copy(from.begin(), from.end(), bytes.begin());
    if (this->IsSwapped)
    {
      std::reverse(bytes.begin(), bytes.end());
    }
    T value;
    std::memcpy(&value, bytes.data(), sizeof(T));
    return value;
  }

  std::string Text(std::size_t offset, std::size_t length) const
  {
    return std::string(this->Bytes.substr(offset, length));
  }

private:
  std::string_view Bytes;
  bool IsSwapped;
};

} // namespace voxplex::io

#endif
