// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Reduction.h"

#include "CaseOptions.h"
#include "RandomImages.h"
#include "Workers.h"

#include <algorithm>
#include <chrono>
#include <functional>
#include <vector>

namespace voxplex::stress
{

namespace
{

double WallSeconds()
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/** Wall-clock seconds beyond its own limit after which an attempt counts as hanging. */
constexpr double Grace = 30.0;

/** Single voxels are tried one by one only in images with at most this number of voxels. */
constexpr std::size_t FewVoxels = 600;

/** Moves planes to earlier times, and leaves out those that are not in the image any more. */
template <int D>
void ShiftPlanes(StressCase<D>& of, double by)
{
  const double duration =
    static_cast<double>(of.Image.Dimensions[D - 1] - 1) * of.Image.Axes[D - 1][D - 1];
  std::vector<double> times;
  for (const double time : of.Options.Planes.Times)
  {
    if (time - by >= 0.0 && time - by <= duration)
    {
      times.push_back(time - by);
    }
  }
  of.Options.Planes.Times = times;
}

template <int D>
class Reducer
{
public:
  Reducer(
    StressCase<D> of, std::string cause, const RunLimits& limits, const ReductionLimits& reduction)
    : Best(std::move(of))
    , Cause(std::move(cause))
    , Limits(limits)
    , Reduction(reduction)
    , End(WallSeconds() + reduction.Seconds)
  {
  }

  StressCase<D> Run()
  {
    for (bool smaller = true; smaller && !this->IsOver();)
    {
      smaller = this->ResetOptions();
      smaller = this->Crop() || smaller;
      smaller = this->MergeLabels() || smaller;
      smaller = this->SimplifyGrid() || smaller;
      smaller = this->RoundNumbers() || smaller;
      smaller = this->ClearVoxels() || smaller;
    }
    return this->Best;
  }

private:
  using Change = std::function<void(StressCase<D>&)>;

  bool IsOver() const { return WallSeconds() > this->End; }

  /** Whether a case fails for the same cause. */
  bool Fails(const StressCase<D>& candidate) const
  {
    const double wall = 8.0 * TimeLimit(candidate, this->Limits) + Grace;
    const unsigned repeats = candidate.Options.Team.Threads > 1 ? this->Reduction.Repeats : 1;
    for (unsigned k = 0; k < repeats; ++k)
    {
      const CaseResult result = RunInChild([&] { return RunCase(candidate, this->Limits); }, wall);
      if (result.Has(this->Cause))
      {
        return true;
      }
    }
    return false;
  }

  /** Keeps a change if the case still fails. */
  bool Try(const Change& change)
  {
    if (this->IsOver())
    {
      return false;
    }
    StressCase<D> candidate = this->Best;
    change(candidate);
    if constexpr (D == 4)
    {
      if (candidate.Options.Planes.Periodic)
      {
        RepeatFirstFrame(candidate.Image);
      }
    }
    candidate.Measure();
    if (!this->Fails(candidate))
    {
      return false;
    }
    this->Best = std::move(candidate);
    return true;
  }

  /** Tries to set a member. If it has the value already, nothing is tried. */
  template <typename Member, typename T>
  bool TryToSet(Member member, const T& value)
  {
    const auto to = static_cast<std::decay_t<decltype(member(this->Best))>>(value);
    return !(member(this->Best) == to) && this->Try([&](StressCase<D>& c) { member(c) = to; });
  }

  /** Tries the value that leaves a stage out, then the default. */
  template <typename Member, typename T, typename U>
  bool TryToSet(Member member, const T& usual, const U& without)
  {
    return !(member(this->Best) == static_cast<T>(without)) &&
      (this->TryToSet(member, without) || this->TryToSet(member, usual));
  }

  bool ResetOptions();
  bool LeaveOutPlanes();
  bool Crop();
  bool CropTo(std::size_t axis, std::int64_t first, std::int64_t count);
  bool MergeLabels();
  bool SimplifyGrid();
  bool RoundNumbers();
  bool ClearVoxels();

  StressCase<D> Best;
  std::string Cause;
  RunLimits Limits;
  ReductionLimits Reduction;
  double End;
};

//------------------------------------------------------------------------------------------------
template <int D>
bool Reducer<D>::ResetOptions()
{
  const StressCase<D> usual;
  bool changed = this->TryToSet([](auto& c) -> auto& { return c.Options.Team.Threads; }, 1);
  changed |= this->TryToSet([](auto& c) -> auto& { return c.Twice; }, false);
  changed |= this->TryToSet([](auto& c) -> auto& { return c.Options.SmoothingSigma; },
    usual.Options.SmoothingSigma, 0.0);
  changed |= this->TryToSet([](auto& c) -> auto& { return c.Size.Everywhere; }, 0.0);
  changed |= this->TryToSet([](auto& c) -> auto& { return c.Size.OfLabel; }, 0.0);
  changed |= this->TryToSet([](auto& c) -> auto& { return c.Size.Slope; }, 0.0);
  while (!this->Best.Options.Sampling.InterfaceSizes.empty() &&
    this->Try([](StressCase<D>& c) { c.Options.Sampling.InterfaceSizes.pop_back(); }))
  {
    changed = true;
  }
  VisitOptions(this->Best, [&](const char*, auto member, auto... without)
    { changed |= this->TryToSet(member, member(usual), without...); });
  return this->LeaveOutPlanes() || changed;
}

//------------------------------------------------------------------------------------------------
/** Leaves out time planes one by one. */
template <int D>
bool Reducer<D>::LeaveOutPlanes()
{
  bool changed = false;
  for (std::size_t k = this->Best.Options.Planes.Times.size(); k-- > 0;)
  {
    changed |= this->Try(
      [&](StressCase<D>& c)
      {
        std::vector<double>& times = c.Options.Planes.Times;
        times.erase(times.begin() + static_cast<std::ptrdiff_t>(k));
      });
  }
  return changed;
}

//------------------------------------------------------------------------------------------------
template <int D>
bool Reducer<D>::CropTo(std::size_t axis, std::int64_t first, std::int64_t count)
{
  return this->Try(
    [&](StressCase<D>& c)
    {
      Volume<D> old = c.Image;
      Volume<D>& image = c.Image;
      image.Dimensions[axis] = count;
      if (axis == 3)
      {
        ShiftPlanes(c, static_cast<double>(first) * image.Axes[axis][axis]);
      }
      image.Labels.resize(image.Size());
      image.Grey.resize(old.Grey.empty() ? 0 : image.Size());
      image.ForEach(
        [&](typename Volume<D>::Index voxel, std::size_t i)
        {
          voxel[axis] += first;
          const std::size_t from = old.At(voxel);
          image.Labels[i] = old.Labels[from];
          if (!old.Grey.empty())
          {
            image.Grey[i] = old.Grey[from];
          }
        });
    });
}

/** Removes halves, quarters, down to single layers at both ends of each axis. */
template <int D>
bool Reducer<D>::Crop()
{
  bool changed = false;
  for (std::size_t axis = 0; axis < static_cast<std::size_t>(D); ++axis)
  {
    for (std::int64_t part = this->Best.Image.Dimensions[axis] / 2; part >= 1; part /= 2)
    {
      for (bool more = true; more;)
      {
        const std::int64_t left = this->Best.Image.Dimensions[axis] - part;
        more = left >= 2 && (this->CropTo(axis, part, left) || this->CropTo(axis, 0, left));
        changed |= more;
      }
    }
  }
  return changed;
}

//------------------------------------------------------------------------------------------------
/** Changes each label to background, or to the previous label. */
template <int D>
bool Reducer<D>::MergeLabels()
{
  if (this->Best.Image.Surface)
  {
    return false;
  }
  bool changed = false;
  std::int32_t before = 0;
  for (const std::int32_t label : this->Best.Image.LabelValues())
  {
    const auto become = [&](std::int32_t other)
    {
      return this->Try([&](StressCase<D>& c)
        { std::replace(c.Image.Labels.begin(), c.Image.Labels.end(), label, other); });
    };
    const bool gone = become(0) || (before != 0 && become(before));
    before = gone ? before : label;
    changed |= gone;
  }
  // Renumber the labels from 1 on.
  const std::vector<std::int32_t> values = this->Best.Image.LabelValues();
  if (!values.empty() && values.back() != static_cast<std::int32_t>(values.size()))
  {
    changed |= this->Try(
      [&](StressCase<D>& c)
      {
        for (std::int32_t& label : c.Image.Labels)
        {
          label = label == 0
            ? 0
            : static_cast<std::int32_t>(
                std::lower_bound(values.begin(), values.end(), label) - values.begin() + 1);
        }
        c.Size.OfLabel = 0.0;
      });
  }
  return changed;
}

//------------------------------------------------------------------------------------------------
/** Tries unit voxels, then orthogonal axes. */
template <int D>
bool Reducer<D>::SimplifyGrid()
{
  const auto isUnit = [&](const Volume<D>& image)
  {
    for (std::size_t r = 0; r < static_cast<std::size_t>(D); ++r)
    {
      for (std::size_t c = r; c < static_cast<std::size_t>(D); ++c)
      {
        if (image.Axes[r][c] != (r == c ? 1.0 : 0.0))
        {
          return false;
        }
      }
    }
    return true;
  };
  if (isUnit(this->Best.Image))
  {
    return false;
  }
  const double voxel = std::pow(this->Best.Image.VoxelVolume(), 1.0 / D);
  const auto unit = [&](StressCase<D>& c)
  {
    for (double& time : c.Options.Planes.Times)
    {
      time /= c.Image.Axes[D - 1][D - 1];
    }
    for (std::size_t r = 0; r < static_cast<std::size_t>(D); ++r)
    {
      c.Image.Axes[r].fill(0.0);
      c.Image.Axes[r][r] = 1.0;
    }
    c.Options.Sampling.Delta = this->Best.Delta() / voxel;
    c.Size.Everywhere /= voxel;
    c.Size.OfLabel /= voxel;
    for (InterfaceSize& size : c.Options.Sampling.InterfaceSizes)
    {
      size.Size /= voxel;
    }
  };
  bool sheared = false;
  for (std::size_t r = 0; r < static_cast<std::size_t>(D); ++r)
  {
    for (std::size_t c = r + 1; c < static_cast<std::size_t>(D); ++c)
    {
      sheared |= this->Best.Image.Axes[r][c] != 0.0;
    }
  }
  const auto orthogonal = [&](StressCase<D>& c)
  {
    for (std::size_t r = 0; r < static_cast<std::size_t>(D); ++r)
    {
      const double diagonal = c.Image.Axes[r][r];
      c.Image.Axes[r].fill(0.0);
      c.Image.Axes[r][r] = diagonal;
    }
  };
  return this->Try(unit) || (sheared && this->Try(orthogonal));
}

//------------------------------------------------------------------------------------------------
/** Rounds lengths to few digits. */
template <int D>
bool Reducer<D>::RoundNumbers()
{
  const auto rounded = [](double x, int digits) { return std::stod(Text(x, digits)); };
  for (const int digits : { 2, 3, 4 })
  {
    const double delta = rounded(this->Best.Options.Sampling.Delta, digits);
    if (delta == this->Best.Options.Sampling.Delta)
    {
      return false;
    }
    if (this->Try([&](StressCase<D>& c) { c.Options.Sampling.Delta = delta; }))
    {
      return true;
    }
  }
  return false;
}

//------------------------------------------------------------------------------------------------
/** Changes voxels to background, one by one. */
template <int D>
bool Reducer<D>::ClearVoxels()
{
  if (this->Best.Image.Surface || this->Best.Image.Size() > FewVoxels)
  {
    return false;
  }
  bool changed = false;
  for (std::size_t i = 0; i < this->Best.Image.Labels.size(); ++i)
  {
    changed |= this->Best.Image.Labels[i] != 0 &&
      this->Try([&](StressCase<D>& c) { c.Image.Labels[i] = 0; });
  }
  return changed;
}

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
StressCase<D> Reduce(const StressCase<D>& of, const std::string& cause, const RunLimits& limits,
  const ReductionLimits& reduction)
{
  return Reducer<D>(of, cause, limits, reduction).Run();
}

template StressCase<3> Reduce<3>(
  const StressCase<3>&, const std::string&, const RunLimits&, const ReductionLimits&);
template StressCase<4> Reduce<4>(
  const StressCase<4>&, const std::string&, const RunLimits&, const ReductionLimits&);

} // namespace voxplex::stress
