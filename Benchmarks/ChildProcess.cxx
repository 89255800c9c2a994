// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "ChildProcess.h"

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <stdexcept>
#include <string>
#include <sys/wait.h>
#include <unistd.h>

namespace voxplex::benchmarks
{

std::uint64_t PeakResidentBytes()
{
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
  {
    if (line.rfind("VmHWM:", 0) == 0)
    {
      return std::stoull(line.substr(6)) * 1024; // "VmHWM:  1234 kB"
    }
  }
  return 0;
}

namespace
{
/** The whole life of the child; never returns, so that the parent's objects are not destroyed
 * twice. */
[[noreturn]] void LiveAsChild(
  int pipeEnd, void (*body)(void*, void*), void* context, void* result, std::size_t size)
{
  try
  {
    body(context, result);
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "error: %s\n", error.what());
    _exit(EXIT_FAILURE);
  }
  const bool sent = write(pipeEnd, result, size) == static_cast<ssize_t>(size);
  _exit(sent ? EXIT_SUCCESS : EXIT_FAILURE);
}
} // namespace

void detail::RunInChild(
  void (*body)(void* context, void* result), void* context, void* result, std::size_t size)
{
  int ends[2];
  if (pipe(ends) != 0)
  {
    throw std::runtime_error("cannot make a pipe");
  }
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child < 0)
  {
    throw std::runtime_error("cannot start a child process");
  }
  if (child == 0)
  {
    close(ends[0]);
    LiveAsChild(ends[1], body, context, result, size);
  }
  close(ends[1]);
  const ssize_t received = read(ends[0], result, size);
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  if (status != 0 || received != static_cast<ssize_t>(size))
  {
    throw std::runtime_error("a measurement failed in its child process");
  }
}

} // namespace voxplex::benchmarks
