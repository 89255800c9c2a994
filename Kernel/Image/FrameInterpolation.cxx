// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Image/FrameInterpolation.h"

#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <array>
#include <cmath>
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
  return std::cbrt(
    grid.IndexToFrame[0][0] * grid.IndexToFrame[1][1] * grid.IndexToFrame[2][2]);
}

double SmallestSpacing(const GridGeometry<4>& grid)
{
  return std::min(
    { grid.IndexToFrame[0][0], grid.IndexToFrame[1][1], grid.IndexToFrame[2][2] });
}

/** The frames before and after the bounding box that the image has: 0 or 1 each. */
std::array<std::int64_t, 2> FramesAround(const LabelImage<4>& image)
{
  const std::int64_t end = image.CropOrigin()[3] + image.CropDimensions()[3];
  return { image.CropOrigin()[3] > 0 ? 1 : 0, end < image.Grid().Dimensions[3] ? 1 : 0 };
}

//------------------------------------------------------------------------------------------------
/** Writes the frames between two frames. */
class Between
{
public:
  Between(const LabelImage<4>& image, const FramePair& frames,
    const std::vector<Neighbour>& neighbours, unsigned steps)
    : Frames(frames)
    , Extent(image.CropDimensions())
    , Steps(steps)
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
        this->Changes.push_back({ std::min(a, b), std::max(a, b), at, a < b, sign * before,
          sign * after });
      });
    std::stable_sort(this->Changes.begin(), this->Changes.end(),
      [](const Change& x, const Change& y)
      { return std::pair(x.Smaller, x.Larger) < std::pair(y.Smaller, y.Larger); });
  }

  /** @param step 1 to steps - 1 */
  void Write(unsigned step, LabelId* frame)
  {
    const double w = static_cast<double>(step) / static_cast<double>(this->Steps);
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
  const unsigned Steps;
  std::vector<Change> Changes;
};

} // namespace

//------------------------------------------------------------------------------------------------
unsigned FrameStepsFor(const LabelImage<4>& image, unsigned threads, const std::stop_token& stop)
{
  const GridGeometry<4>& grid = image.Grid();
  const double spacing = MeanSpacing(grid);
  const double reach = Reach * spacing;
  const std::vector<Neighbour> neighbours = NeighboursOf(grid, reach);
  const std::int64_t pairs = image.CropDimensions()[3] - 1;
  std::vector<std::vector<double>> ofPair(static_cast<std::size_t>(std::max<std::int64_t>(pairs, 0)));
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
  const auto at = static_cast<std::ptrdiff_t>(FollowedShare * static_cast<double>(motions.size() - 1));
  std::nth_element(motions.begin(), motions.begin() + at, motions.end());
  const double voxels = static_cast<double>(image.Ids().size());
  const double most = std::min<double>(MaximumFrameSteps, std::floor(MostVoxels / voxels));
  const double motion = motions[static_cast<std::size_t>(at)] / spacing;
  return static_cast<unsigned>(std::max(1.0, std::min(most, std::ceil(motion - Slack))));
}

//------------------------------------------------------------------------------------------------
LabelImage<4> InterpolateFrames(
  const LabelImage<4>& image, unsigned steps, unsigned threads, const std::stop_token& stop)
{
  const auto parts = static_cast<std::int64_t>(steps);
  const auto [before, after] = FramesAround(image);
  GridGeometry<4> grid = image.Grid();
  grid.Dimensions[3] = (grid.Dimensions[3] - 1) * parts + 1;
  for (auto& row : grid.IndexToFrame)
  {
    row[3] /= static_cast<double>(steps);
  }
  Index origin = image.CropOrigin();
  Index extent = image.CropDimensions();
  origin[3] = origin[3] * parts - before * (parts - 1);
  extent[3] = (extent[3] - 1) * parts + 1 + (before + after) * (parts - 1);

  const double reach = Reach * MeanSpacing(image.Grid());
  const std::vector<Neighbour> neighbours = NeighboursOf(image.Grid(), reach);
  const auto frame = static_cast<std::size_t>(extent[0] * extent[1] * extent[2]);
  UninitialisedVector<LabelId> ids(frame * static_cast<std::size_t>(extent[3]));
  const auto given = [&](std::int64_t f)
  { return image.Ids().data() + frame * static_cast<std::size_t>(f); };
  // Frame f of the bounding box gets this place. Those between it and the next follow.
  const auto place = [&, leading = before](std::int64_t f)
  { return ids.data() + frame * static_cast<std::size_t>(f * parts + leading * (parts - 1)); };
  const std::int64_t frames = image.CropDimensions()[3];
  const std::int64_t firstPair = -before;
  const std::int64_t pairs = frames - 1 + before + after;
  for (std::int64_t f = 0; f < frames; ++f)
  {
    std::copy(given(f), given(f) + frame, place(f));
  }
  ParallelFor(
    0, static_cast<std::size_t>(pairs), 1, steps > 1 ? threads : 1,
    [&](std::size_t first, std::size_t last)
    {
      for (std::size_t p = first; p < last && steps > 1; ++p)
      {
        const std::int64_t f = firstPair + static_cast<std::int64_t>(p);
        const FramePair pair(image, f, reach);
        Between between(image, pair, neighbours, steps);
        LabelId* const next =
          f < 0 ? ids.data() : place(f) + frame; // the frames before the bounding box come first
        for (unsigned step = 1; step < steps; ++step)
        {
          between.Write(step, next + frame * (step - 1));
        }
      }
    },
    stop);
  return image.WithFrames(grid, origin, extent, std::move(ids));
}

} // namespace voxplex
