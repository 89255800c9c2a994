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

ProgressBar::ProgressBar(bool wanted)
  : IsBar(wanted && IsTerminal())
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
    this->Draw(fraction, step, now);
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

void ProgressBar::Draw(double fraction, const std::string& step, Clock::time_point now)
{
  constexpr int width = 30;
  const int filled = static_cast<int>(std::lround(fraction * width));
  const double seconds = std::chrono::duration<double>(now - this->Start).count();
  std::fprintf(stderr, "\r[%s%s] %3.0f %%  %.0f s  %s\033[K", std::string(filled, '=').c_str(),
    std::string(width - filled, ' ').c_str(), 100.0 * fraction, seconds, step.c_str());
}

} // namespace voxplex::cli
