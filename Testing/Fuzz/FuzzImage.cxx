// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/** @file FuzzImage.cxx @brief VOXPLEX_FUZZ_READER, in this process, on files with the extension
 * VOXPLEX_FUZZ_EXTENSION. */
#include "FileError.h"
#include "Fuzzing.h"
#include "ImageReading/Readers.h"

#include <array>
#include <cstddef>
#include <cstring>
#include <memory>
#include <utility>

namespace fuzz = voxplex::fuzz;

namespace
{

constexpr std::byte Poison{ 0xA5 };

/** Beside the image, for headers that name it: 4 x 4 x 4 voxels of two bytes. */
void WriteData()
{
  const std::array<char, 128> zeros{};
  fuzz::Write(fuzz::PathOf("i.raw"), zeros.data(), zeros.size());
  fuzz::Write(fuzz::PathOf("i.img"), zeros.data(), zeros.size());
}

std::shared_ptr<void> Allocate(std::size_t bytes, std::byte content)
{
  const std::shared_ptr<void> memory = voxplex::AllocateVoxels(bytes);
  std::memset(memory.get(), static_cast<int>(content), bytes);
  return memory;
}

/** Nothing if the file is refused. */
std::shared_ptr<void> Read(const std::string& path, std::byte content, std::size_t& bytes)
{
  voxplex::io::Reading reading;
  reading.Request.Path = path;
  reading.Allocate = [content](std::size_t size) { return Allocate(size, content); };
  try
  {
    const voxplex::io::ImageAnswer answer =
      voxplex::io::ReadBy(voxplex::io::VOXPLEX_FUZZ_READER, std::move(reading));
    bytes = answer.Image.NumberOfVoxels() * static_cast<std::size_t>(answer.Image.Frames) *
      voxplex::SizeOf(answer.Image.Type);
    if (bytes == 0)
    {
      fuzz::Fail("an image without voxels was read");
    }
    return answer.Image.Scalars;
  }
  catch (const voxplex::io::FileError& error)
  {
    fuzz::CheckRefusal("cannot read '" + path + "': " + error.what(), path);
    return nullptr;
  }
}

} // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***)
{
  WriteData();
  return 0;
}

/** Twice, over memory with other contents: all voxels are written, and by the file. */
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  const std::string path = fuzz::PathOf("i" VOXPLEX_FUZZ_EXTENSION);
  fuzz::Write(path, data, size);
  std::size_t bytes = 0;
  std::size_t bytesAgain = 0;
  const std::shared_ptr<void> voxels = Read(path, std::byte{ 0 }, bytes);
  const std::shared_ptr<void> again = Read(path, Poison, bytesAgain);
  if (!voxels != !again || bytes != bytesAgain ||
    (voxels && std::memcmp(voxels.get(), again.get(), bytes) != 0))
  {
    fuzz::Fail("the second reading gives something else");
  }
  return 0;
}
