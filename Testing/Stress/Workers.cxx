// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Workers.h"

#include <cerrno>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstring>
#include <memory>
#include <sstream>
#include <stdexcept>

#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

namespace voxplex::stress
{

namespace
{

/** Separators: between the fields of a message, and at its end. */
constexpr char FieldEnd = '\x1f';
constexpr char MessageEnd = '\x1e';

/** Seconds beyond its own time limits in which a case must be cancelled and checked. */
constexpr double Grace = 60.0;
/** Wall-clock limit over the limit of processor time. A case may run twice. */
constexpr double WallOfLimit = 17.0;

double WallSeconds()
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

//------------------------------------------------------------------------------------------------
/** Converts a result to text and back. */
std::string Packed(const CaseResult& result)
{
  std::ostringstream text;
  text.precision(17);
  text << static_cast<int>(result.Status) << ' ' << result.Elements << ' ' << result.Vertices << ' '
       << result.Created << ' ' << result.Operations << ' ' << result.NonManifold << ' '
       << result.Lost << ' ' << result.Seconds << ' ' << result.CheckSeconds << FieldEnd
       << result.Kind << FieldEnd << result.Refusal << FieldEnd;
  for (const Finding& f : result.Failures)
  {
    text << f.Cause << FieldEnd << f.Message << FieldEnd << f.Count << FieldEnd;
  }
  return text.str();
}

CaseResult Unpacked(const std::string& packed)
{
  std::vector<std::string> fields;
  std::istringstream stream(packed);
  for (std::string field; std::getline(stream, field, FieldEnd);)
  {
    fields.push_back(field);
  }
  CaseResult result;
  std::istringstream numbers(fields.at(0));
  int status = 0;
  numbers >> status >> result.Elements >> result.Vertices >> result.Created >> result.Operations >>
    result.NonManifold >> result.Lost >> result.Seconds >> result.CheckSeconds;
  result.Status = static_cast<CaseStatus>(status);
  result.Kind = fields.at(1);
  result.Refusal = fields.at(2);
  for (std::size_t i = 3; i + 2 < fields.size(); i += 3)
  {
    result.Failures.push_back({ fields[i], fields[i + 1], std::stoull(fields[i + 2]) });
  }
  return result;
}

CaseResult FailedWith(const std::string& cause, const std::string& message)
{
  CaseResult result;
  result.Status = CaseStatus::Failed;
  result.Failures.push_back({ cause, message, 1 });
  return result;
}

//------------------------------------------------------------------------------------------------
/** One process that runs cases and reports them through a pipe: `B limit`, then `R result`. */
class Worker
{
public:
  using Tell = std::function<void(char kind, const std::string& text)>;

  /** @param body the function that the process runs */
  explicit Worker(const std::function<void(const Tell&)>& body)
  {
    std::array<int, 2> ends{};
    if (pipe(ends.data()) != 0)
    {
      throw std::runtime_error("no pipe: " + std::string(std::strerror(errno)));
    }
    this->Process = fork();
    if (this->Process < 0)
    {
      throw std::runtime_error("no process: " + std::string(std::strerror(errno)));
    }
    if (this->Process == 0)
    {
      close(ends[0]);
      body([&](char kind, const std::string& text) { Write(ends[1], kind + text + MessageEnd); });
      _exit(0);
    }
    close(ends[1]);
    this->Pipe = ends[0];
  }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;
  ~Worker()
  {
    if (this->Pipe >= 0)
    {
      this->Kill();
      this->Status();
    }
  }

  int Descriptor() const { return this->Pipe; }

  /** Reads the available data. @return false at the end of the pipe */
  bool Read(const std::function<void(char, const std::string&)>& take)
  {
    std::array<char, 4096> buffer{};
    const ssize_t length = read(this->Pipe, buffer.data(), buffer.size());
    if (length <= 0)
    {
      return length < 0 && errno == EINTR;
    }
    this->Text.append(buffer.data(), static_cast<std::size_t>(length));
    for (std::size_t end = 0; (end = this->Text.find(MessageEnd)) != std::string::npos;)
    {
      const std::string message = this->Text.substr(0, end);
      this->Text.erase(0, end + 1);
      take(message.at(0), message.substr(1));
    }
    return true;
  }

  void Kill() const { kill(this->Process, SIGKILL); }

  /** Waits for the end of the process. */
  int Status()
  {
    int status = 0;
    while (waitpid(this->Process, &status, 0) < 0 && errno == EINTR)
    {
    }
    close(this->Pipe);
    this->Pipe = -1;
    return status;
  }

private:
  static void Write(int pipe, const std::string& text)
  {
    for (std::size_t done = 0; done < text.size();)
    {
      const ssize_t length = write(pipe, text.data() + done, text.size() - done);
      if (length < 0 && errno != EINTR)
      {
        _exit(1); // the parent is gone
      }
      done += length > 0 ? static_cast<std::size_t>(length) : 0;
    }
  }

  pid_t Process = 0;
  int Pipe = -1;
  std::string Text; ///< text of an incomplete message
};

/** The result of a case during which its process ended. */
CaseResult ResultOfDeath(int status)
{
  if (WIFSIGNALED(status))
  {
    return FailedWith("crash",
      "signal " + std::to_string(WTERMSIG(status)) + " (" + strsignal(WTERMSIG(status)) + ")");
  }
  return FailedWith(
    "crash", "the process ended with status " + std::to_string(WEXITSTATUS(status)));
}

template <int D>
CaseResult RunTelling(const CaseId& id, const RunLimits& limits, const Worker::Tell& tell)
{
  const StressCase<D> made = MakeCase<D>(id);
  tell('B', Text(WallOfLimit * TimeLimit(made, limits) + Grace));
  return RunCase(made, limits);
}

//------------------------------------------------------------------------------------------------
/** The cases of one job, and the process that currently runs them. */
class Job
{
public:
  Job(const CaseRange& range, std::uint64_t first, unsigned stride, const RunLimits& limits)
    : Range(range)
    , Next(first)
    , Stride(stride)
    , Limits(limits)
    , End(range.Seconds > 0.0 ? WallSeconds() + range.Seconds : 0.0)
  {
  }

  bool HasMore() const
  {
    return (this->Range.Count == 0 || this->Next < this->Range.First + this->Range.Count) &&
      (this->End == 0.0 || WallSeconds() < this->End);
  }

  void Start()
  {
    this->Deadline = 0.0;
    this->Process = std::make_unique<Worker>(
      [this](const Worker::Tell& tell)
      {
        for (; this->HasMore(); this->Next += this->Stride)
        {
          const CaseId id = this->Current();
          const CaseResult result = IsSpaceTime(id) ? RunTelling<4>(id, this->Limits, tell)
                                                    : RunTelling<3>(id, this->Limits, tell);
          tell('R', Packed(result));
        }
      });
  }

  CaseId Current() const { return { this->Range.Kind, this->Range.Seed, this->Next }; }
  Worker* Running() { return this->Process.get(); }

  /**
   * Takes the messages of the process. If it ended before its last case, starts another process.
   */
  void Listen(const std::function<void(const CaseId&, const CaseResult&)>& take)
  {
    const bool goesOn = this->Process->Read(
      [&](char kind, const std::string& text)
      {
        if (kind == 'B')
        {
          this->Deadline = WallSeconds() + std::stod(text);
          return;
        }
        this->Deadline = 0.0;
        take(this->Current(), Unpacked(text));
        this->Next += this->Stride;
      });
    if (!goesOn)
    {
      this->Bury(take);
    }
  }

  void EndIfHanging(const std::function<void(const CaseId&, const CaseResult&)>& take)
  {
    if (this->Deadline > 0.0 && WallSeconds() > this->Deadline)
    {
      this->Process->Kill();
      this->Process->Status();
      this->Process.reset();
      this->TakeAndGoOn(FailedWith("hang", "it neither ended nor could be cancelled"), take);
    }
  }

private:
  void Bury(const std::function<void(const CaseId&, const CaseResult&)>& take)
  {
    const int status = this->Process->Status();
    this->Process.reset();
    const bool inCase = this->Deadline > 0.0;
    if (inCase || !WIFEXITED(status) || WEXITSTATUS(status) != 0)
    {
      this->TakeAndGoOn(ResultOfDeath(status), take);
    }
  }

  void TakeAndGoOn(
    const CaseResult& result, const std::function<void(const CaseId&, const CaseResult&)>& take)
  {
    take(this->Current(), result);
    this->Next += this->Stride;
    if (this->HasMore())
    {
      this->Start();
    }
  }

  CaseRange Range;
  std::uint64_t Next;
  unsigned Stride;
  RunLimits Limits;
  double End;
  double Deadline = 0.0; ///< deadline of the running case; 0 if no case runs
  std::unique_ptr<Worker> Process;
};

} // namespace

//------------------------------------------------------------------------------------------------
void RunInWorkers(const CaseRange& range, unsigned jobs, const RunLimits& limits,
  const std::function<void(const CaseId&, const CaseResult&)>& take)
{
  std::vector<std::unique_ptr<Job>> all;
  for (unsigned j = 0; j < jobs; ++j)
  {
    all.push_back(std::make_unique<Job>(range, range.First + j, jobs, limits));
    if (all.back()->HasMore())
    {
      all.back()->Start();
    }
  }
  for (bool running = true; running;)
  {
    std::vector<pollfd> pipes;
    std::vector<Job*> owners;
    for (const auto& job : all)
    {
      if (job->Running())
      {
        pipes.push_back({ job->Running()->Descriptor(), POLLIN, 0 });
        owners.push_back(job.get());
      }
    }
    running = !pipes.empty();
    constexpr int Milliseconds = 500;
    poll(pipes.data(), pipes.size(), Milliseconds);
    for (std::size_t k = 0; k < pipes.size(); ++k)
    {
      if (pipes[k].revents != 0)
      {
        owners[k]->Listen(take);
      }
      else
      {
        owners[k]->EndIfHanging(take);
      }
    }
  }
}

//------------------------------------------------------------------------------------------------
CaseResult RunInChild(const std::function<CaseResult()>& run, double wallLimit)
{
  CaseResult result = FailedWith("hang", "it neither ended nor could be cancelled");
  Worker worker([&](const Worker::Tell& tell) { tell('R', Packed(run())); });
  const double end = WallSeconds() + wallLimit;
  bool told = false;
  while (WallSeconds() < end)
  {
    pollfd pipe{ worker.Descriptor(), POLLIN, 0 };
    constexpr int Milliseconds = 500;
    if (poll(&pipe, 1, Milliseconds) <= 0)
    {
      continue;
    }
    const auto take = [&](char, const std::string& text)
    {
      result = Unpacked(text);
      told = true;
    };
    if (!worker.Read(take))
    {
      const int status = worker.Status();
      return told ? result : ResultOfDeath(status);
    }
  }
  return result;
}

} // namespace voxplex::stress
