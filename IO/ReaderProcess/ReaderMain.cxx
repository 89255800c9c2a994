// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ReaderMain.cxx
 * @brief The program that reads one image with a library, for another process, which lives whatever the image does here.
 *
 *     voxplexImageReader PATH SERIES RULE THRESHOLD
 *
 * Standard output receives the greeting and the answer (AnswerMessage.h). Descriptor 3 is the memory for voxels.
 */
#include "AnswerMessage.h"
#include "Confinement.h"
#include "ImageReading/Readers.h"
#include "SharedMemory.h"
#include "Text.h"

#include <csignal>
#include <cstring>

#include <unistd.h>

#if defined(__linux__)
#include <sys/prctl.h>
#endif

namespace
{

using namespace voxplex;
using namespace voxplex::io;

constexpr int MemoryDescriptor = 3;

bool Write(std::string_view text)
{
  while (!text.empty())
  {
    const ssize_t written = write(STDOUT_FILENO, text.data(), text.size());
    if (written <= 0)
    {
      return false;
    }
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

AnswerMessage Read(const ImageRequest& request)
{
  SharedMemoryWriter memory(MemoryDescriptor);
  Reading reading;
  reading.Request = request;
  reading.Allocate = [&memory](std::size_t bytes)
  {
    AllowTimeFor(bytes);
    return memory.Allocate(bytes);
  };
  AnswerMessage message;
  try
  {
    message.Answer = ReadBy(ReadWithLibraries, std::move(reading));
    message.Offset = memory.OffsetOf(message.Answer.Image.Scalars.get());
  }
  catch (const FileError& error)
  {
    message.Error = error.what();
  }
  return message;
}

} // namespace

int main(int argc, char** argv)
{
  if (argc != 5)
  {
    return 2;
  }
#if defined(__linux__)
  prctl(PR_SET_PDEATHSIG, SIGKILL); // if the host has ended before, nobody takes the greeting
#endif
  std::signal(SIGXFSZ, SIG_IGN); // shared memory counts as a file: no memory is a message
  const ImageRequest request{ argv[1], argv[2], false,
    std::strcmp(argv[3], "1") == 0 ? Overlap::Order : Overlap::Smallest,
    ToNumber<double>(argv[4]).value_or(0.5) };
  if (!Write(Greeting))
  {
    return 1;
  }
  Confine(request.Path);
  const AnswerMessage message = Read(request);
  const bool isWritten = Write(ToText(message));
  _exit(isWritten ? 0 : 1); // no library's destructors
}
