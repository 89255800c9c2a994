// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file AnswerMessage.h
 * @brief What a reading process tells the process that started it: a JSON document.
 */
#ifndef voxplex_io_AnswerMessage_h
#define voxplex_io_AnswerMessage_h

#include "ImageReading/ReadImage.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace voxplex::io
{

/**
 * What the reading process writes as soon as it has started: a process that does not is another program or another
 * version. The document follows.
 */
inline constexpr std::string_view Greeting = "voxplex image reader 5\n";

/** An image, or why there is none. Its voxels are at Offset of the memory that both processes share. */
struct AnswerMessage
{
  ImageAnswer Answer; ///< its Image has no Scalars
  std::uint64_t Offset = 0;
  std::string Error; ///< empty if there is an image
};

/** The warnings and the error may hold any bytes; those that are not UTF-8 are replaced. */
std::string ToText(const AnswerMessage& message);

/**
 * Reads a document that anybody may have written.
 *
 * @param memory how many bytes are shared
 * @throws std::exception unless it describes an image whose voxels are in that memory, whose place and times are such
 * as readers give, and whose labels are positive and have names, or is an error
 */
AnswerMessage ParseAnswer(std::string_view text, std::uint64_t memory);

} // namespace voxplex::io

#endif
