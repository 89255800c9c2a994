// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "ProgressBar.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#ifdef _WIN32
#include <windows.h>
#else
#include <unistd.h>
#endif

namespace voxplex::cli
{
namespace
{

/** Whether standard error is a terminal that understands escape sequences. */
bool IsTerminal()
{
#ifdef _WIN32 // where a console has to be asked for that
  const HANDLE console = GetStdHandle(STD_ERROR_HANDLE);
  DWORD mode = 0;
  return GetConsoleMode(console, &mode) &&
    SetConsoleMode(console, mode | ENABLE_VIRTUAL_TERMINAL_PROCESSING);
#else
  return isatty(STDERR_FILENO);
#endif
}

} // namespace

ProgressBar::ProgressBar(bool wanted, UserInterface words)
  : IsElements(wanted && words == UserInterface::Slicer)
  , IsMessages(wanted && words == UserInterface::Python)
  , IsBar(wanted && words == UserInterface::CommandLine && IsTerminal())
  , IsLines(wanted && !this->IsBar)
{
}

ProgressBar::~ProgressBar()
{
  if (this->IsBar)
  {
    std::fputs("\r\033[K", stderr);
    std::fflush(stderr);
  }
  if (this->IsElements && this->LastPercent >= 0)
  {
    std::printf(
      "<filter-end>\n<filter-name>%s</filter-name>\n<filter-time>%g</filter-time>\n</filter-end>\n",
      this->LastStep.c_str(), this->Seconds());
    std::fflush(stdout);
  }
}

double ProgressBar::Seconds() const
{
  return std::chrono::duration<double>(Clock::now() - this->Start).count();
}

void ProgressBar::Show(double fraction, const std::string& step)
{
  using namespace std::chrono_literals;
  const Clock::time_point now = Clock::now();
  const bool isSoon = now - this->LastDrawn < 100ms;
  fraction = std::clamp(fraction, 0.0, 1.0);
  const int percent = static_cast<int>(100.0 * fraction);
  if (this->IsBar && !(isSoon && step == this->LastStep))
  {
    this->Draw(fraction, step);
  }
  else if (this->IsElements && percent != this->LastPercent)
  {
    this->WriteElement(fraction, step);
  }
  else if (this->IsMessages && percent != this->LastPercent)
  {
    std::fprintf(stderr, "{\"kind\":\"progress\",\"fraction\":%.2f,\"step\":\"%s\"}\n", fraction,
      step.c_str());
  }
  else if (this->IsLines && percent != this->LastPercent)
  {
    std::fprintf(stderr, "%d %% %s\n", percent, step.c_str());
  }
  else
  {
    return;
  }
  std::fflush(stderr);
  this->LastDrawn = now;
  this->LastStep = step;
  this->LastPercent = percent;
}

void ProgressBar::Draw(double fraction, const std::string& step)
{
  constexpr int width = 30;
  const int filled = static_cast<int>(std::lround(fraction * width));
  std::fprintf(stderr, "\r[%s%s] %3.0f %%  %.0f s  %s\033[K", std::string(filled, '=').c_str(),
    std::string(width - filled, ' ').c_str(), 100.0 * fraction, this->Seconds(), step.c_str());
}

void ProgressBar::WriteElement(double fraction, const std::string& step) const
{
  if (this->LastPercent < 0)
  {
    std::printf("<filter-start>\n<filter-name>%s</filter-name>\n<filter-comment> \"%s\" "
                "</filter-comment>\n</filter-start>\n",
      step.c_str(), step.c_str());
  }
  std::printf("<filter-progress>%g</filter-progress>\n", fraction);
  std::fflush(stdout);
}

} // namespace voxplex::cli
