// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "ReadApart.h"

#include "AnswerMessage.h"
#include "FileError.h"
#include "SharedMemory.h"

#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <string_view>

#include <dlfcn.h>
#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/resource.h>
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

/** Whether shared memory may grow: it counts as a file. */
bool FilesMayGrow()
{
  rlimit limit{};
  return getrlimit(RLIMIT_FSIZE, &limit) == 0 && limit.rlim_cur == RLIM_INFINITY;
}

/** The program beside this library, as it is built and installed; empty if it is not there. */
std::string FindReader()
{
  Dl_info library{};
  if (dladdr(reinterpret_cast<const void*>(&FindReader), &library) == 0 || !library.dli_fname)
  {
    return "";
  }
  std::error_code ignored;
  const fs::path file = fs::canonical(library.dli_fname, ignored);
  const fs::path reader = file.parent_path() / VOXPLEX_READER_NAME;
  return access(reader.c_str(), X_OK) == 0 ? reader.string() : "";
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

enum class Reception
{
  Complete, ///< the process has closed its end
  TooLong,  ///< more than any answer
  TooLate
};

/** A process that reads an image. It is ended, at the latest, with this object. */
class ReaderProcess
{
public:
  explicit ReaderProcess(const ImageRequest& request)
    : Memory(MakeSharedMemory())
  {
    std::string reader = FindReader();
    std::array<int, 2> ends{ -1, -1 };
    if (reader.empty() || !FilesMayGrow() || this->Memory.Get() < 0 || !MakePipe(ends))
    {
      return;
    }
    this->Output.Set(ends[0]);
    const Descriptor input(ends[1]);
    // Beyond the numbers that they get in the other process.
    const Descriptor output(fcntl(input.Get(), F_DUPFD_CLOEXEC, 4));
    const Descriptor memory(fcntl(this->Memory.Get(), F_DUPFD_CLOEXEC, 4));
    if (output.Get() < 0 || memory.Get() < 0)
    {
      return;
    }
    const SpawnSettings settings(output.Get(), memory.Get());
    std::string path = request.Path;
    std::string series = request.Series;
    std::string anywhere = request.DataFilesAnywhere ? "1" : "0";
    std::string rule = request.Rule == Overlap::Order ? "1" : "0";
    std::array<char, 32> threshold{}; // more than a number takes
    std::to_chars(threshold.begin(), threshold.end() - 1, request.MaskThreshold);
    const std::array<char*, 7> arguments{ reader.data(), path.data(), series.data(),
      anywhere.data(), rule.data(), threshold.data(), nullptr };
    if (posix_spawn(&this->Id, reader.c_str(), &settings.Actions, &settings.Attributes,
          arguments.data(), Environment()) != 0)
    {
      this->Id = -1;
    }
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

  bool HasStarted() const { return this->Id > 0; }
  int MemoryDescriptor() const { return this->Memory.Get(); }

  /** Collects all that the process writes. */
  Reception Receive(std::string& text)
  {
    constexpr std::size_t longest = 256 << 20;
    const Clock::time_point end = Clock::now() + std::chrono::hours(1);
    std::array<char, 65536> buffer;
    while (text.size() < longest)
    {
      pollfd event{ this->Output.Get(), POLLIN, 0 };
      const int ready = poll(&event, 1, 1000);
      if (ready == 0 && Clock::now() > end)
      {
        return Reception::TooLate;
      }
      const ssize_t got = ready > 0 ? read(this->Output.Get(), buffer.data(), buffer.size()) : -1;
      if (got == 0 || (got < 0 && ready > 0 && errno != EINTR))
      {
        return Reception::Complete;
      }
      text.append(buffer.data(), got > 0 ? static_cast<std::size_t>(got) : 0);
    }
    return Reception::TooLong;
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

private:
  Descriptor Memory;
  Descriptor Output;
  pid_t Id = -1;
};

std::string DescribeEnd(int status)
{
  const int number = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  if (number == SIGXCPU || number == SIGKILL)
  {
    return "its reading took too long or too much memory, and was stopped: it is damaged, or made "
           "to do harm";
  }
  return "its reading ended with " +
    (number ? "signal " + std::to_string(number)
            : "status " + std::to_string(WEXITSTATUS(status))) +
    ": it is damaged, or made to do harm";
}

} // namespace

std::optional<ImageAnswer> ReadApart(const ImageRequest& request)
{
  const std::string start = "cannot read '" + request.Path + "': ";
  ReaderProcess process(request);
  std::string text;
  if (!process.HasStarted())
  {
    return std::nullopt;
  }
  const Reception reception = process.Receive(text);
  if (reception != Reception::Complete)
  {
    throw FileError(start + DescribeEnd(SIGKILL));
  }
  const int status = process.Wait();
  if (!text.starts_with(Greeting))
  {
    return std::nullopt;
  }
  if (status != 0)
  {
    throw FileError(start + DescribeEnd(status));
  }
  try
  {
    AnswerMessage message = ParseAnswer(
      std::string_view(text).substr(Greeting.size()), FixSharedMemory(process.MemoryDescriptor()));
    if (!message.Error.empty())
    {
      throw FileError(message.Error);
    }
    ScalarImage& image = message.Answer.Image;
    const std::size_t bytes =
      image.NumberOfVoxels() * static_cast<std::size_t>(image.Frames) * SizeOf(image.Type);
    image.Scalars = MapSharedMemory(process.MemoryDescriptor(), message.Offset, bytes);
    return std::move(message.Answer);
  }
  catch (const FileError&)
  {
    throw;
  }
  catch (const std::bad_alloc&)
  {
    throw FileError(start + "it does not fit into memory");
  }
  catch (const std::exception&)
  {
    throw FileError(
      start + "the process that read it gave no sound answer: it is damaged, or made to do harm");
  }
}

} // namespace voxplex::io
