// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Draws the time planes of space-time cases. The order of the draws defines the meaning of a seed.
#include "StressCase.h"

#include <algorithm>

namespace voxplex::stress
{

namespace
{

/** Space for slabs must not cost more elements than this, by estimate. */
constexpr double MostElements = 6000.0;
/** Planes are refused if a slab is thinner than delta. Rounding must not decide. */
constexpr double ThinnestSlab = 1.0001;

double DurationOf(const StressCase<4>& of)
{
  return static_cast<double>(of.Image.Dimensions[3] - 1) * of.Image.Axes[3][3];
}

/** Makes the duration a number of deltas: with a smaller delta, then with a longer step in time. */
void MakeRoom(StressCase<4>& of, double deltas)
{
  constexpr double step = 1.2;
  while (of.Options.Sampling.Delta > 0.0 && DurationOf(of) < deltas * of.Delta())
  {
    of.Options.Sampling.Delta /= step;
    if (of.ExpectedElements() > MostElements)
    {
      of.Options.Sampling.Delta *= step;
      break;
    }
  }
  // The default of delta grows with the step.
  while (DurationOf(of) < deltas * of.Delta() && of.ExpectedElements() < MostElements)
  {
    of.Image.Axes[3][3] *= step;
    of.Measure();
  }
}

/** The times of some frames, or of all. */
std::vector<double> TimesOfFrames(const StressCase<4>& of, Random& random)
{
  const bool isEach = random.Chance(0.6);
  std::vector<double> times;
  for (std::int64_t frame = 0; frame < of.Image.Dimensions[3]; ++frame)
  {
    if (isEach || random.Chance(0.4))
    {
      times.push_back(static_cast<double>(frame) * of.Image.Axes[3][3]);
    }
  }
  return times;
}

std::vector<double> RandomTimes(const StressCase<4>& of, Random& random)
{
  std::vector<double> times;
  const std::int64_t count = random.Integer(1, 5);
  for (std::int64_t k = 0; k < count; ++k)
  {
    times.push_back(random.Uniform(0.0, DurationOf(of)));
  }
  return times;
}

/** Planes that are as near to each other as they may be, or nearly so, from a random time on. */
std::vector<double> NearTimes(const StressCase<4>& of, Random& random)
{
  const double step = of.Delta() * (random.Chance(0.3) ? ThinnestSlab : random.Uniform(1.01, 2.0));
  std::vector<double> times;
  double time = random.Chance(0.5) ? step : random.Uniform(step, std::max(step, DurationOf(of)));
  for (std::int64_t count = random.Integer(1, 6); count > 0 && time < DurationOf(of); --count)
  {
    times.push_back(time);
    time += step;
  }
  return times;
}

/** Leaves out planes that are too near to the plane before them, or to an end. */
void ThinOut(const StressCase<4>& of, std::vector<double>& times)
{
  const double least = ThinnestSlab * of.Delta() * (1.0 - 1e-12);
  const double end = DurationOf(of);
  std::vector<double> kept;
  for (const double time : times)
  {
    const double before = kept.empty() ? 0.0 : kept.back();
    if (time == 0.0 || time == end || (time - before >= least && end - time >= least))
    {
      kept.push_back(time);
    }
  }
  times = kept;
}

} // namespace

//------------------------------------------------------------------------------------------------
void DrawTimePlanes(StressCase<4>& of, Random& random)
{
  TimePlaneOptions& planes = of.Options.Planes;
  const bool hasTimes = random.Chance(planes.Periodic ? 0.4 : 0.35);
  if (hasTimes || planes.Periodic)
  {
    MakeRoom(of, random.LogUniform(2.1, 14.0));
    of.Options.Team.Reproducible &= random.Chance(0.05); // is refused
    of.Twice &= of.Options.Team.Reproducible || of.Options.Team.Threads == 1;
  }
  if (hasTimes)
  {
    const double way = random.Uniform();
    planes.Times = way < 0.3 ? TimesOfFrames(of, random)
      : way < 0.75           ? RandomTimes(of, random)
                             : NearTimes(of, random);
    std::sort(planes.Times.begin(), planes.Times.end());
    if (!random.Chance(0.02))
    {
      ThinOut(of, planes.Times);
    }
    if (random.Chance(0.2) && !planes.Times.empty()) // neither order nor repetition matters
    {
      planes.Times.push_back(planes.Times.front());
      std::reverse(planes.Times.begin(), planes.Times.end());
    }
  }
  of.Kind += of.Image.Surface ? ", grey values" : "";
  of.Kind += !planes.Times.empty() ? ", time planes" : "";
  of.Kind += planes.Periodic ? ", periodic" : "";
}

} // namespace voxplex::stress
