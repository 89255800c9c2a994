// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "ProgressReport.h"

#include <algorithm>
#include <cstring>
#include <iostream>

namespace voxplex::slicer
{
namespace
{

double SecondsSince(std::chrono::steady_clock::time_point start)
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/** Another thread of the application may set it at any time. */
bool AbortIsSet(const ModuleProcessInformation* host)
{
  return host && *static_cast<const volatile unsigned char*>(&host->Abort) != 0;
}

} // namespace

ProgressReport::ProgressReport(ModuleProcessInformation* host)
  : Host(host)
{
}

void ProgressReport::CheckAbort() const
{
  if (AbortIsSet(this->Host))
  {
    throw Aborted("cancelled, no file was written");
  }
}

void ProgressReport::Start(const Stage& stage)
{
  this->EndStage();
  this->Current = stage;
  this->Open = true;
  this->StageBegin = Clock::now();
  if (this->Host)
  {
    std::strncpy(
      this->Host->ProgressMessage, stage.Comment, sizeof(this->Host->ProgressMessage) - 1);
    this->Host->ProgressMessage[sizeof(this->Host->ProgressMessage) - 1] = '\0';
  }
  else
  {
    std::cout << "<filter-start>\n<filter-name>" << stage.Filter
              << "</filter-name>\n<filter-comment> \"" << stage.Comment
              << "\" </filter-comment>\n</filter-start>" << std::endl;
  }
  if (!this->Tell(0.0))
  {
    this->CheckAbort();
  }
}

bool ProgressReport::Show(double progress)
{
  return this->Tell(std::clamp(progress, 0.0, 1.0));
}

void ProgressReport::Finish()
{
  this->EndStage();
  this->CheckAbort();
}

void ProgressReport::EndStage()
{
  if (!this->Open)
  {
    return;
  }
  if (!this->Tell(1.0))
  {
    this->CheckAbort();
  }
  this->Open = false;
  if (!this->Host)
  {
    std::cout << "<filter-end>\n<filter-name>" << this->Current.Filter
              << "</filter-name>\n<filter-time>" << SecondsSince(this->StageBegin)
              << "</filter-time>\n</filter-end>" << std::endl;
  }
}

bool ProgressReport::Tell(double progress)
{
  const double whole = this->Current.Begin + (this->Current.End - this->Current.Begin) * progress;
  if (this->Host)
  {
    return this->TellHost(whole, progress);
  }
  std::cout << "<filter-progress>" << whole << "</filter-progress>\n<filter-stage-progress>"
            << progress << "</filter-stage-progress>" << std::endl;
  return true;
}

bool ProgressReport::TellHost(double whole, double progress)
{
  const bool stop = AbortIsSet(this->Host);
  this->Host->Progress = stop ? 0.0F : static_cast<float>(whole);
  this->Host->StageProgress = stop ? 0.0F : static_cast<float>(progress);
  this->Host->ElapsedTime = SecondsSince(this->Begin);
  if (this->Host->ProgressCallbackFunction && this->Host->ProgressCallbackClientData)
  {
    this->Host->ProgressCallbackFunction(this->Host->ProgressCallbackClientData);
  }
  return !AbortIsSet(this->Host);
}

} // namespace voxplex::slicer
