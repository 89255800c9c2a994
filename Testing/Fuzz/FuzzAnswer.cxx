// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/** @file FuzzAnswer.cxx @brief What a reading process that was taken over might say. */
#include "Fuzzing.h"
#include "ReaderProcess/AnswerMessage.h"

#include <cmath>

namespace fuzz = voxplex::fuzz;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  constexpr std::uint64_t memory = 1 << 20;
  try
  {
    const voxplex::io::AnswerMessage message =
      voxplex::io::ParseAnswer({ reinterpret_cast<const char*>(data), size }, memory);
    const voxplex::ScalarImage& image = message.Answer.Image;
    const double bytes = static_cast<double>(image.NumberOfVoxels()) * image.Frames *
      static_cast<double>(voxplex::SizeOf(image.Type));
    if (message.Error.empty() &&
      !(bytes > 0 && static_cast<double>(message.Offset) + bytes <= memory))
    {
      fuzz::Fail("voxels outside of the memory");
    }
    for (const double spacing : image.Spacing)
    {
      if (message.Error.empty() && !(spacing > 0 && std::isfinite(spacing)))
      {
        fuzz::Fail("a spacing that is none");
      }
    }
  }
  catch (const std::exception&)
  {
  }
  return 0;
}
