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
#include <vector>

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
/**
 * Runs a child from start to exit. Never returns, so that the parent's objects are not destroyed
 * twice.
 */
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

struct Child
{
  pid_t Process;
  int PipeEnd; ///< the end to read the result from
};

Child StartChild(void (*body)(void*, void*), void* context, void* result, std::size_t size)
{
  int ends[2];
  if (pipe(ends) != 0)
  {
    throw std::runtime_error("cannot make a pipe");
  }
  const pid_t process = fork();
  if (process == 0)
  {
    close(ends[0]);
    LiveAsChild(ends[1], body, context, result, size);
  }
  close(ends[1]);
  if (process < 0)
  {
    close(ends[0]);
    throw std::runtime_error("cannot start a child process");
  }
  return { process, ends[0] };
}

/** Reads the result of a child and waits for it. Returns whether the child succeeded. */
bool FinishChild(const Child& child, void* result, std::size_t size)
{
  const ssize_t received = read(child.PipeEnd, result, size);
  close(child.PipeEnd);
  int status = 0;
  waitpid(child.Process, &status, 0);
  return status == 0 && received == static_cast<ssize_t>(size);
}
} // namespace

void detail::RunInChildren(std::size_t copies, void (*body)(void* context, void* result),
  void* context, void* results, std::size_t size)
{
  std::fflush(nullptr);
  std::vector<Child> children;
  std::exception_ptr failure;
  try
  {
    for (std::size_t i = 0; i < copies; ++i)
    {
      children.push_back(StartChild(body, context, static_cast<char*>(results) + i * size, size));
    }
  }
  catch (const std::exception&)
  {
    failure = std::current_exception();
  }
  bool well = true;
  for (std::size_t i = 0; i < children.size(); ++i)
  {
    well &= FinishChild(children[i], static_cast<char*>(results) + i * size, size);
  }
  if (failure)
  {
    std::rethrow_exception(failure);
  }
  if (!well)
  {
    throw std::runtime_error("a measurement failed in its child process");
  }
}

} // namespace voxplex::benchmarks
