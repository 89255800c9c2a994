// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesher/DeltaSearch.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace voxplex
{

namespace
{

/**
 * The range of the exponent between two runs. A value outside of it is due to chance or a
 * threshold.
 */
constexpr double SmallestExponent = 0.5;
constexpr double LargestExponent = 6.0;

/** No step changes delta by more than this factor. */
constexpr double LargestStep = 4.0;

/** Counts that differ by less count as equal. */
constexpr double SameCount = 0.03;

/** If the log of the ratio of two deltas is smaller than this, they count as equal. */
constexpr double EmptyWidth = 1e-3;

/** Rounds to four digits, so that a user who reads a delta can request the same delta. */
double Rounded(double delta)
{
  const double digits = 3.0 - std::floor(std::log10(delta));
  const double scale = std::pow(10.0, std::abs(digits)); // a whole number, so rounding occurs once
  return digits >= 0.0 ? std::round(delta * scale) / scale : std::round(delta / scale) * scale;
}

} // namespace

DeltaSearch::DeltaSearch(
  std::uint64_t target, double guess, double exponent, double smallest, double largest)
  : Target(static_cast<double>(std::max<std::uint64_t>(target, 1)))
  , Exponent(exponent)
  , Smallest(std::min(smallest, largest))
  , Largest(largest)
  , NextDelta(std::clamp(Rounded(guess), Smallest, Largest))
  , LastWidth(std::numeric_limits<double>::infinity())
{
}

double DeltaSearch::Deviation(const MeshingRun& run) const
{
  return std::abs(static_cast<double>(run.Elements) / this->Target - 1.0);
}

double DeltaSearch::LogRatio(const MeshingRun& run) const
{
  return std::log(std::max(static_cast<double>(run.Elements), 0.5) / this->Target);
}

const MeshingRun& DeltaSearch::Best() const
{
  return *std::min_element(this->All.begin(), this->All.end(),
    [this](const MeshingRun& a, const MeshingRun& b)
    { return this->Deviation(a) < this->Deviation(b); });
}

bool DeltaSearch::Found() const
{
  return !this->All.empty() && this->Deviation(this->Best()) <= Tolerance;
}

//------------------------------------------------------------------------------------------------
void DeltaSearch::Add(std::uint64_t elements)
{
  const MeshingRun run{ *this->NextDelta, elements };
  this->All.push_back(run);
  if (this->LogRatio(run) > 0.0)
  {
    this->Above = !this->Above || run.Delta > this->Above->Delta ? run : this->Above;
  }
  else
  {
    this->Below = !this->Below || run.Delta < this->Below->Delta ? run : this->Below;
  }
  const double deviation = this->Deviation(this->Best());
  const bool isOver = deviation <= Aim || this->All.size() >= MostRuns ||
    (deviation <= Tolerance && this->All.size() >= GoodEnough) || this->IsOutOfReach();
  this->NextDelta = isOver ? std::nullopt : this->Choose();
}

//------------------------------------------------------------------------------------------------
// True if the smallest delta gives too few elements; if the largest delta gives too many; or if
// there are too many, and half the delta gave no more elements.
bool DeltaSearch::IsOutOfReach() const
{
  if (this->Below && !this->Above)
  {
    return this->Below->Delta <= this->Smallest;
  }
  if (this->Below || !this->Above)
  {
    return false;
  }
  return this->Above->Delta >= this->Largest ||
    std::any_of(this->All.begin(), this->All.end(),
      [this](const MeshingRun& run)
      {
        return run.Delta <= 0.5 * this->Above->Delta &&
          this->LogRatio(*this->Above) > this->LogRatio(run) - SameCount;
      });
}

//------------------------------------------------------------------------------------------------
std::optional<double> DeltaSearch::Choose()
{
  // Extrapolate from the run nearest to the target, on the line through the next nearest run with
  // another delta.
  std::vector<MeshingRun> runs = this->All;
  std::stable_sort(runs.begin(), runs.end(),
    [this](const MeshingRun& a, const MeshingRun& b)
    { return std::abs(this->LogRatio(a)) < std::abs(this->LogRatio(b)); });
  const MeshingRun& best = runs.front();
  double exponent = this->Exponent;
  if (runs.size() > 1)
  {
    const double step = std::log(runs[1].Delta / best.Delta);
    exponent = std::clamp(
      (this->LogRatio(best) - this->LogRatio(runs[1])) / step, SmallestExponent, LargestExponent);
  }
  const double most = std::log(LargestStep);
  double next =
    Rounded(best.Delta * std::exp(std::clamp(this->LogRatio(best) / exponent, -most, most)));

  if (this->Above && this->Below && this->Above->Delta < this->Below->Delta)
  {
    const double width = std::log(this->Below->Delta / this->Above->Delta);
    if (width < EmptyWidth)
    {
      return std::nullopt;
    }
    const double margin = std::exp(0.25 * EmptyWidth);
    const bool isInside = next > this->Above->Delta * margin && next * margin < this->Below->Delta;
    const bool shrinks = this->All.size() % 2 != 0 || width < 0.5 * this->LastWidth;
    if (!isInside || !shrinks)
    {
      next = std::sqrt(this->Above->Delta * this->Below->Delta);
    }
    this->LastWidth = this->All.size() % 2 == 0 ? width : this->LastWidth;
  }
  else if (this->Above && this->Below)
  {
    // The count is not monotonic: a finer run had too few elements. Take the middle of the
    // interval, unless it is nearly empty.
    next = std::sqrt(this->Above->Delta * this->Below->Delta);
  }
  next = std::clamp(Rounded(next), this->Smallest, this->Largest);
  const bool isNew = std::none_of(this->All.begin(), this->All.end(),
    [&](const MeshingRun& run) { return std::abs(std::log(run.Delta / next)) < 0.1 * EmptyWidth; });
  return isNew ? std::optional<double>(next) : std::nullopt;
}

} // namespace voxplex
