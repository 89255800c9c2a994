// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "ImageReading/Readers.h"

#include "AnswerMessage.h"
#include "FileError.h"
#include "SharedMemory.h"

#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string_view>

#include <dlfcn.h>
#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#ifdef __APPLE__
#include <crt_externs.h>
#else
extern char** environ;
#endif

namespace fs = std::filesystem;

namespace voxplex::io
{
namespace
{

using Clock = std::chrono::steady_clock;

#ifdef __APPLE__ // which has no pipe2(), no variable for the environment in libraries, but a flag to close all files

bool MakePipe(std::array<int, 2>& ends)
{
  return pipe(ends.data()) == 0 && fcntl(ends[0], F_SETFD, FD_CLOEXEC) == 0 &&
    fcntl(ends[1], F_SETFD, FD_CLOEXEC) == 0;
}

char** Environment()
{
  return *_NSGetEnviron();
}

constexpr int SpawnFlags = POSIX_SPAWN_CLOEXEC_DEFAULT;

#else

bool MakePipe(std::array<int, 2>& ends)
{
  return pipe2(ends.data(), O_CLOEXEC) == 0;
}

char** Environment()
{
  return environ;
}

constexpr int SpawnFlags = 0;

#endif

/** A file descriptor that is closed at the end. */
class Descriptor
{
public:
  explicit Descriptor(int number = -1)
    : Number(number)
  {
  }
  ~Descriptor() { this->Close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  void Set(int number) { this->Number = number; }
  int Get() const { return this->Number; }
  void Close()
  {
    if (this->Number >= 0)
    {
      close(this->Number);
      this->Number = -1;
    }
  }

private:
  int Number;
};

/**
 * The program beside this library, as it is built and installed. If the library is part of a program (in the wheel), its
 * file may have the name by which that was started, which is none to look for in the working folder.
 */
std::string ReaderPath()
{
  Dl_info library{};
  const bool isKnown = dladdr(reinterpret_cast<const void*>(&ReaderPath), &library) != 0;
  const bool isPath = isKnown && fs::path(library.dli_fname).is_absolute();
  std::error_code ignored;
  const fs::path file = fs::canonical(isPath ? library.dli_fname : "/proc/self/exe", ignored);
  return (file.parent_path() / VOXPLEX_READER_NAME).string();
}

/** What posix_spawn() wants to be told. */
class SpawnSettings
{
public:
  SpawnSettings(int output, int memory)
  {
    posix_spawn_file_actions_init(&this->Actions);
    posix_spawnattr_init(&this->Attributes);
    posix_spawn_file_actions_addopen(&this->Actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&this->Actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_adddup2(&this->Actions, output, STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&this->Actions, memory, 3);
#if defined(__GLIBC__)
#if __GLIBC_PREREQ(2, 34)
    posix_spawn_file_actions_addclosefrom_np(&this->Actions, 4); // what the host has open
#endif
#endif
    sigset_t none;
    sigemptyset(&none);
    sigset_t all;
    sigfillset(&all);
    posix_spawnattr_setsigmask(&this->Attributes, &none);
    posix_spawnattr_setsigdefault(&this->Attributes, &all);
    posix_spawnattr_setflags(
      &this->Attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | SpawnFlags);
  }
  ~SpawnSettings()
  {
    posix_spawn_file_actions_destroy(&this->Actions);
    posix_spawnattr_destroy(&this->Attributes);
  }
  SpawnSettings(const SpawnSettings&) = delete;
  SpawnSettings& operator=(const SpawnSettings&) = delete;

  posix_spawn_file_actions_t Actions;
  posix_spawnattr_t Attributes;
};

/** A process that reads an image. It is ended, at the latest, with this object. */
class ReaderProcess
{
public:
  /** @throws FileError if it cannot be started */
  explicit ReaderProcess(const ImageRequest& request)
    : Reader(ReaderPath())
    , Memory(MakeSharedMemory())
  {
    std::array<int, 2> ends{ -1, -1 };
    this->RefuseIfNoStart(this->Memory.Get() < 0 || !MakePipe(ends));
    this->Output.Set(ends[0]);
    const Descriptor input(ends[1]);
    // Beyond the numbers that they get in the other process.
    const Descriptor output(fcntl(input.Get(), F_DUPFD_CLOEXEC, 4));
    const Descriptor memory(fcntl(this->Memory.Get(), F_DUPFD_CLOEXEC, 4));
    this->RefuseIfNoStart(output.Get() < 0 || memory.Get() < 0);
    const SpawnSettings settings(output.Get(), memory.Get());
    std::string path = request.Path;
    std::string series = request.Series;
    std::string rule = request.Rule == Overlap::Order ? "1" : "0";
    std::array<char, 32> threshold{}; // more than a number takes
    std::to_chars(threshold.begin(), threshold.end() - 1, request.MaskThreshold);
    const std::array<char*, 6> arguments{ this->Reader.data(), path.data(), series.data(),
      rule.data(), threshold.data(), nullptr };
    errno = posix_spawn(&this->Id, this->Reader.c_str(), &settings.Actions, &settings.Attributes,
      arguments.data(), Environment());
    this->RefuseIfNoStart(errno != 0);
  }

  ~ReaderProcess()
  {
    if (this->Id > 0)
    {
      kill(this->Id, SIGKILL);
      this->Wait();
    }
  }
  ReaderProcess(const ReaderProcess&) = delete;
  ReaderProcess& operator=(const ReaderProcess&) = delete;

  int MemoryDescriptor() const { return this->Memory.Get(); }

  /** Collects all that the process writes. False if that is more, or takes longer, than any answer. @throws Stopped */
  bool Receive(std::string& text, const Reading& reading)
  {
    constexpr std::size_t longest = 256 << 20;
    const Clock::time_point end = Clock::now() + std::chrono::hours(1);
    std::array<char, 65536> buffer;
    while (text.size() < longest)
    {
      reading.Tell(0);
      pollfd event{ this->Output.Get(), POLLIN, 0 };
      const int ready = poll(&event, 1, 100);
      if (ready == 0 && Clock::now() > end)
      {
        return false;
      }
      const ssize_t got = ready > 0 ? read(this->Output.Get(), buffer.data(), buffer.size()) : -1;
      if (got == 0 || (got < 0 && ready > 0 && errno != EINTR))
      {
        return true;
      }
      text.append(buffer.data(), got > 0 ? static_cast<std::size_t>(got) : 0);
    }
    return false;
  }

  /** The status of the process, which has ended or is about to; 0 if the host collects its children's itself. */
  int Wait()
  {
    int status = 0;
    while (waitpid(this->Id, &status, 0) < 0)
    {
      if (errno != EINTR)
      {
        status = 0;
        break;
      }
    }
    this->Id = -1;
    return status;
  }

  const std::string& Program() const { return this->Reader; }

private:
  /** With the reason that errno gives. */
  void RefuseIfNoStart(bool isWrong) const
  {
    RefuseIf(isWrong, "the program that reads images, '", this->Reader,
      "', cannot be started: ", std::strerror(errno));
  }

  std::string Reader;
  Descriptor Memory;
  Descriptor Output;
  pid_t Id = -1;
};

/** What the process said, if it is sound. */
AnswerMessage Parse(std::string_view text, int memory)
{
  try
  {
    return ParseAnswer(text, FixSharedMemory(memory));
  }
  catch (const std::exception&)
  {
    Refuse("the process that read it gave no sound answer: it is damaged, or made to do harm");
  }
}

} // namespace

ScalarImage ReadApart(const std::string&, Reading& reading)
{
  ReaderProcess process(reading.Request);
  std::string text;
  const bool isComplete = process.Receive(text, reading);
  const int status = isComplete ? process.Wait() : SIGKILL;
  const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  RefuseIf(signal == SIGXCPU || signal == SIGKILL,
    "its reading took too long or too much memory, and was stopped: it is damaged, or made to do "
    "harm");
  const std::string end =
    signal ? "signal " + std::to_string(signal) : "status " + std::to_string(WEXITSTATUS(status));
  RefuseIf(!text.starts_with(Greeting), "the program that reads images, '", process.Program(),
    "', does not answer, and ended with ", end,
    ": it is damaged, lacks a library, or is of another version; start it in a shell to see why, "
    "or install Voxplex again");
  RefuseIf(status != 0, "its reading ended with ", end, ": it is damaged, or made to do harm");
  AnswerMessage message =
    Parse(std::string_view(text).substr(Greeting.size()), process.MemoryDescriptor());
  if (!message.Error.empty())
  {
    throw FileError(message.Error);
  }
  ScalarImage& image = message.Answer.Image;
  const std::size_t bytes =
    image.NumberOfVoxels() * static_cast<std::size_t>(image.Frames) * SizeOf(image.Type);
  image.Scalars = MapSharedMemory(process.MemoryDescriptor(), message.Offset, bytes);
  static_cast<ImageNotes&>(reading) = std::move(message.Answer);
  reading.HasPlace = image.HasPlace;
  reading.Unit = image.Unit;
  return image;
}

} // namespace voxplex::io
