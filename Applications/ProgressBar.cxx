// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "ProgressBar.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <unistd.h>

namespace voxplex::cli
{

ProgressBar::ProgressBar(bool wanted)
  : Visible(wanted && isatty(STDERR_FILENO))
{
}

ProgressBar::~ProgressBar()
{
  if (this->Visible)
  {
    std::fputs("\r\033[K", stderr);
    std::fflush(stderr);
  }
}

void ProgressBar::Show(double fraction, const std::string& step)
{
  using namespace std::chrono_literals;
  const Clock::time_point now = Clock::now();
  if (!this->Visible || (step == this->LastStep && now - this->LastDrawn < 100ms))
  {
    return;
  }
  this->LastDrawn = now;
  this->LastStep = step;

  constexpr int width = 30;
  fraction = std::clamp(fraction, 0.0, 1.0);
  const int filled = static_cast<int>(std::lround(fraction * width));
  const double seconds = std::chrono::duration<double>(now - this->Start).count();
  std::fprintf(stderr, "\r[%s%s] %3.0f %%  %.0f s  %s\033[K", std::string(filled, '=').c_str(),
    std::string(width - filled, ' ').c_str(), 100.0 * fraction, seconds, step.c_str());
  std::fflush(stderr);
}

} // namespace voxplex::cli
