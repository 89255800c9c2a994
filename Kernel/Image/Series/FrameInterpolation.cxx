// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Image/Series/FrameInterpolation.h"

#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace voxplex
{

namespace
{

using Index = LabelImage<4>::Index;

/** Distances are searched up to this many mean voxel spacings. */
constexpr double Reach = 8.0;

/** The share of the changing voxels whose motion is followed. */
constexpr double FollowedShare = 0.95;

/** A step may be longer than a voxel by this many voxels. */
constexpr double Slack = 0.25;

/** FrameStepsFor() looks at no more voxels of a pair of frames. */
constexpr std::size_t MostSamples = 20'000;

/** FrameStepsFor() makes no image with more voxels. */
constexpr double MostVoxels = 4e8;

/** A neighbour in space, and its distance. */
struct Neighbour
{
  Index Offset;
  double Distance;
};

/** The neighbours within reach, the nearest first. */
std::vector<Neighbour> NeighboursOf(const GridGeometry<4>& grid, double reach)
{
  std::array<std::int64_t, 3> most;
  for (std::size_t a = 0; a < 3; ++a)
  {
    // The matrix is upper triangular: the last coordinate of a step has one source.
    double height = grid.IndexToFrame[a][a];
    most[a] = static_cast<std::int64_t>(reach / height) + 1;
  }
  std::vector<Neighbour> neighbours;
  for (std::int64_t k = -most[2]; k <= most[2]; ++k)
  {
    for (std::int64_t j = -most[1]; j <= most[1]; ++j)
    {
      for (std::int64_t i = -most[0]; i <= most[0]; ++i)
      {
        Point<3> step{};
        const std::array<double, 3> index = { static_cast<double>(i), static_cast<double>(j),
          static_cast<double>(k) };
        for (std::size_t r = 0; r < 3; ++r)
        {
          for (std::size_t c = r; c < 3; ++c)
          {
            step[r] += grid.IndexToFrame[r][c] * index[c];
          }
        }
        const double distance = std::sqrt(Dot(step, step));
        if (distance > 0.0 && distance <= reach)
        {
          neighbours.push_back({ { i, j, k, 0 }, distance });
        }
      }
    }
  }
  std::stable_sort(neighbours.begin(), neighbours.end(),
    [](const Neighbour& a, const Neighbour& b) { return a.Distance < b.Distance; });
  return neighbours;
}

/** Distances from a voxel whose label changes from A to B. At most the reach. */
struct Distances
{
  double LeaveA; ///< before the change, to another label than A
  double FindB;  ///< before the change, to B
  double LeaveB; ///< after the change, to another label than B
  double FindA;  ///< after the change, to A
};

/** Two frames in a row, in indices of the bounding box. One of them may lie beyond it. */
class FramePair
{
public:
  FramePair(const LabelImage<4>& image, std::int64_t first, double reach)
    : Image(image)
    , First(first)
    , Reach(reach)
  {
  }

  LabelId Before(Index v) const
  {
    v[3] = this->First;
    return this->Image.At(v);
  }
  LabelId After(Index v) const
  {
    v[3] = this->First + 1;
    return this->Image.At(v);
  }

  Distances At(const Index& v, const std::vector<Neighbour>& neighbours) const
  {
    const LabelId a = this->Before(v);
    const LabelId b = this->After(v);
    Distances d{ this->Reach, this->Reach, this->Reach, this->Reach };
    unsigned left = 4;
    for (const Neighbour& neighbour : neighbours)
    {
      Index w = v;
      for (std::size_t i = 0; i < 3; ++i)
      {
        w[i] += neighbour.Offset[i];
      }
      const LabelId before = this->Before(w);
      const LabelId after = this->After(w);
      const auto note = [&](bool found, double& distance)
      {
        if (found && distance == this->Reach)
        {
          distance = neighbour.Distance;
          --left;
        }
      };
      note(before != a, d.LeaveA);
      note(before == b, d.FindB);
      note(after != b, d.LeaveB);
      note(after == a, d.FindA);
      if (left == 0)
      {
        break;
      }
    }
    return d;
  }

  /** Calls function(voxel) for each voxel that changes, in order. */
  template <typename Function>
  void ForChanges(Function&& function) const
  {
    const Index& extent = this->Image.CropDimensions();
    const LabelId* before = this->FrameAt(this->First);
    const LabelId* after = this->FrameAt(this->First + 1);
    Index v{};
    for (v[2] = 0; v[2] < extent[2]; ++v[2])
    {
      for (v[1] = 0; v[1] < extent[1]; ++v[1])
      {
        for (v[0] = 0; v[0] < extent[0]; ++v[0])
        {
          if ((before ? *before++ : 0) != (after ? *after++ : 0))
          {
            function(v);
          }
        }
      }
    }
  }

private:
  /** The ids of a frame; null beyond the bounding box, where all voxels are background. */
  const LabelId* FrameAt(std::int64_t frame) const
  {
    const Index& extent = this->Image.CropDimensions();
    return frame < 0 || frame >= extent[3]
      ? nullptr
      : this->Image.Ids().data() + frame * extent[0] * extent[1] * extent[2];
  }

  const LabelImage<4>& Image;
  const std::int64_t First;
  const double Reach;
};

double MeanSpacing(const GridGeometry<4>& grid)
{
  return std::cbrt(grid.IndexToFrame[0][0] * grid.IndexToFrame[1][1] * grid.IndexToFrame[2][2]);
}

double SmallestSpacing(const GridGeometry<4>& grid)
{
  return std::min({ grid.IndexToFrame[0][0], grid.IndexToFrame[1][1], grid.IndexToFrame[2][2] });
}

//------------------------------------------------------------------------------------------------
/** Writes the frames between two frames. */
class Between
{
public:
  Between(
    const LabelImage<4>& image, const FramePair& frames, const std::vector<Neighbour>& neighbours)
    : Frames(frames)
    , Extent(image.CropDimensions())
  {
    const double half = 0.5 * SmallestSpacing(image.Grid());
    frames.ForChanges(
      [&](const Index& v)
      {
        const LabelId a = frames.Before(v);
        const LabelId b = frames.After(v);
        const Distances d = frames.At(v, neighbours);
        // Signed distances to A minus those to B, before and after the change.
        const double before = -(d.LeaveA - half) - (d.FindB - half);
        const double after = (d.FindA - half) + (d.LeaveB - half);
        const double sign = a < b ? 1.0 : -1.0;
        const auto at =
          static_cast<std::size_t>((v[2] * this->Extent[1] + v[1]) * this->Extent[0] + v[0]);
        this->Changes.push_back(
          { std::min(a, b), std::max(a, b), at, a < b, sign * before, sign * after });
      });
    std::stable_sort(this->Changes.begin(), this->Changes.end(),
      [](const Change& x, const Change& y)
      { return std::pair(x.Smaller, x.Larger) < std::pair(y.Smaller, y.Larger); });
  }

  /** @param w the weight of the frame after, above 0 and below 1 */
  void Write(double w, LabelId* frame)
  {
    this->CopyBefore(frame);
    for (auto first = this->Changes.begin(); first != this->Changes.end();)
    {
      const auto last = std::find_if(first, this->Changes.end(),
        [first](const Change& change)
        { return change.Smaller != first->Smaller || change.Larger != first->Larger; });
      const auto before = static_cast<double>(
        std::count_if(first, last, [](const Change& change) { return change.SmallerFirst; }));
      const auto after = static_cast<double>(last - first) - before;
      const auto smaller = first + std::lround((1.0 - w) * before + w * after);
      const auto score = [w](const Change& change)
      { return (1.0 - w) * change.ScoreBefore + w * change.ScoreAfter; };
      std::sort(first, last,
        [&](const Change& x, const Change& y)
        { return std::pair(score(x), x.Place) < std::pair(score(y), y.Place); });
      for (auto change = first; change != last; ++change)
      {
        frame[change->Place] = change < smaller ? change->Smaller : change->Larger;
      }
      first = last;
    }
  }

private:
  /** A voxel that changes from one of two labels to the other. */
  struct Change
  {
    LabelId Smaller;
    LabelId Larger;
    std::size_t Place; ///< in a frame of the bounding box
    bool SmallerFirst;
    double ScoreBefore; ///< signed distance to the smaller label minus that to the larger
    double ScoreAfter;
  };

  void CopyBefore(LabelId* frame) const
  {
    Index v{};
    for (v[2] = 0; v[2] < this->Extent[2]; ++v[2])
    {
      for (v[1] = 0; v[1] < this->Extent[1]; ++v[1])
      {
        for (v[0] = 0; v[0] < this->Extent[0]; ++v[0])
        {
          *frame++ = this->Frames.Before(v);
        }
      }
    }
  }

  const FramePair& Frames;
  const Index Extent;
  std::vector<Change> Changes;
};

/** Where places after another frame begin, and the number of places. */
std::vector<std::size_t> FirstOfEachPair(std::span<const FramePlace> places)
{
  std::vector<std::size_t> starts;
  for (std::size_t k = 0; k < places.size(); ++k)
  {
    if (k == 0 || places[k].Before != places[k - 1].Before)
    {
      starts.push_back(k);
    }
  }
  starts.push_back(places.size());
  return starts;
}

} // namespace

//------------------------------------------------------------------------------------------------
unsigned FrameStepsFor(const LabelImage<4>& image, unsigned threads, const std::stop_token& stop)
{
  const GridGeometry<4>& grid = image.Grid();
  const double spacing = MeanSpacing(grid);
  const double reach = Reach * spacing;
  const std::vector<Neighbour> neighbours = NeighboursOf(grid, reach);
  const std::int64_t pairs = image.CropDimensions()[3] - 1;
  std::vector<std::vector<double>> ofPair(
    static_cast<std::size_t>(std::max<std::int64_t>(pairs, 0)));
  ParallelFor(
    0, ofPair.size(), 1, threads,
    [&](std::size_t first, std::size_t last)
    {
      for (std::size_t p = first; p < last; ++p)
      {
        const FramePair frames(image, static_cast<std::int64_t>(p), reach);
        std::size_t changes = 0;
        frames.ForChanges([&changes](const Index&) { ++changes; });
        const std::size_t stride = changes / MostSamples + 1;
        std::size_t k = 0;
        frames.ForChanges(
          [&](const Index& v)
          {
            if (k++ % stride == 0)
            {
              const Distances d = frames.At(v, neighbours);
              if (d.FindA < reach && d.FindB < reach)
              {
                ofPair[p].push_back(d.FindA + d.FindB - spacing);
              }
            }
          });
      }
    },
    stop);
  std::vector<double> motions;
  for (const std::vector<double>& some : ofPair)
  {
    motions.insert(motions.end(), some.begin(), some.end());
  }
  if (motions.empty())
  {
    return 1;
  }
  const auto at =
    static_cast<std::ptrdiff_t>(FollowedShare * static_cast<double>(motions.size() - 1));
  std::nth_element(motions.begin(), motions.begin() + at, motions.end());
  const double voxels = static_cast<double>(image.Ids().size());
  const double most = std::min<double>(MaximumFrameSteps, std::floor(MostVoxels / voxels));
  const double motion = motions[static_cast<std::size_t>(at)] / spacing;
  return static_cast<unsigned>(std::max(1.0, std::min(most, std::ceil(motion - Slack))));
}

//------------------------------------------------------------------------------------------------
LabelImage<4> ScheduledFrames(const LabelImage<4>& image, const FrameSchedule& schedule,
  double step, unsigned threads, const std::stop_token& stop)
{
  const std::int64_t firstGiven = image.CropOrigin()[3];
  const std::int64_t endGiven = firstGiven + image.CropDimensions()[3];
  const auto isGiven = [&](std::int64_t frame) { return frame >= firstGiven && frame < endGiven; };
  // The frames that may have labels, in a row: those of the new bounding box.
  const auto hasLabels = [&](const FramePlace& place)
  { return isGiven(place.Before) || (place.Weight > 0.0 && isGiven(place.Before + 1)); };
  const auto& places = schedule.Places;
  const auto begin = std::find_if(places.begin(), places.end(), hasLabels);
  const auto end = std::find_if_not(begin, places.end(), hasLabels);

  GridGeometry<4> grid = image.Grid();
  grid.Dimensions[3] = schedule.NumberOfFrames();
  grid.IndexToFrame[3][3] = step;
  Index origin = image.CropOrigin();
  Index extent = image.CropDimensions();
  origin[3] = begin - places.begin();
  extent[3] = end - begin;

  const double reach = Reach * MeanSpacing(image.Grid());
  const std::vector<Neighbour> neighbours = NeighboursOf(image.Grid(), reach);
  const auto frame = static_cast<std::size_t>(extent[0] * extent[1] * extent[2]);
  UninitialisedVector<LabelId> ids(frame * static_cast<std::size_t>(extent[3]));
  const std::span<const FramePlace> made(begin, end);
  const std::vector<std::size_t> starts = FirstOfEachPair(made);
  ParallelFor(
    0, starts.size() - 1, 1, threads,
    [&](std::size_t first, std::size_t last)
    {
      for (std::size_t pair = first; pair < last; ++pair)
      {
        const std::int64_t before = made[starts[pair]].Before - firstGiven;
        const FramePair frames(image, before, reach);
        std::optional<Between> between;
        for (std::size_t k = starts[pair]; k < starts[pair + 1]; ++k)
        {
          const double weight = made[k].Weight;
          LabelId* const to = ids.data() + frame * k;
          if (weight > 0.0)
          {
            if (!between)
            {
              between.emplace(image, frames, neighbours);
            }
            between->Write(weight, to);
          }
          else
          {
            const LabelId* const from =
              image.Ids().data() + frame * static_cast<std::size_t>(before);
            std::copy(from, from + frame, to);
          }
        }
      }
    },
    stop);
  return image.WithFrames(grid, origin, extent, std::move(ids));
}

//------------------------------------------------------------------------------------------------
LabelImage<4> InterpolateFrames(
  const LabelImage<4>& image, unsigned steps, unsigned threads, const std::stop_token& stop)
{
  FrameSchedule schedule;
  for (std::int64_t before = 0; before + 1 < image.Grid().Dimensions[3]; ++before)
  {
    for (unsigned step = 0; step < steps; ++step)
    {
      schedule.Places.push_back({ before, static_cast<double>(step) / static_cast<double>(steps) });
    }
  }
  schedule.Places.push_back({ image.Grid().Dimensions[3] - 1, 0.0 });
  return ScheduledFrames(
    image, schedule, image.Grid().IndexToFrame[3][3] / static_cast<double>(steps), threads, stop);
}

//------------------------------------------------------------------------------------------------
template <typename T>
UninitialisedVector<T> ScheduledValues(
  std::span<const T> values, std::size_t frame, const FrameSchedule& schedule, unsigned threads)
{
  UninitialisedVector<T> result(frame * schedule.Places.size());
  ParallelFor(0, schedule.Places.size(), 1, threads,
    [&](std::size_t first, std::size_t last)
    {
      for (std::size_t k = first; k < last; ++k)
      {
        const auto [number, weight] = schedule.Places[k];
        const T* const before = values.data() + static_cast<std::size_t>(number) * frame;
        T* const to = result.data() + k * frame;
        if (weight == 0.0)
        {
          std::copy(before, before + frame, to);
          continue;
        }
        for (std::size_t i = 0; i < frame; ++i)
        {
          to[i] = static_cast<T>((1.0 - weight) * static_cast<double>(before[i]) +
            weight * static_cast<double>(before[frame + i]));
        }
      }
    });
  return result;
}

template UninitialisedVector<float> ScheduledValues(
  std::span<const float>, std::size_t, const FrameSchedule&, unsigned);
template UninitialisedVector<double> ScheduledValues(
  std::span<const double>, std::size_t, const FrameSchedule&, unsigned);

} // namespace voxplex
