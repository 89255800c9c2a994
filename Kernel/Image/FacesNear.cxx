// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Image/FacesNear.h"

#include "Geometry/Box.h"
#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <bit>
#include <cstdint>

namespace voxplex
{

namespace
{

/** Blocks of at most this number of voxels along each axis are searched face by face. */
constexpr std::int64_t LeafEdge = 4;

/** The voxels from `Low` to `High`, both included. */
template <int D>
struct Block
{
  using Index = typename GridGeometry<D>::Index;

  Index Low;
  Index High;

  /** The number of rows along the first axis. */
  std::size_t NumberOfRows() const
  {
    std::size_t rows = 1;
    for (std::size_t a = 1; a < D; ++a)
    {
      rows *= static_cast<std::size_t>(this->High[a] - this->Low[a] + 1);
    }
    return rows;
  }

  std::size_t LongestAxis() const
  {
    std::size_t longest = 0;
    for (std::size_t a = 1; a < D; ++a)
    {
      longest =
        this->High[a] - this->Low[a] > this->High[longest] - this->Low[longest] ? a : longest;
    }
    return longest;
  }
};

template <int D>
class Search
{
  using Index = typename GridGeometry<D>::Index;

public:
  Search(const LabelImage<D>& image, const BitMask<D>& sites,
    const std::vector<SearchBall<D>>& balls, const std::stop_token& stop)
    : Image(image)
    , Sites(sites)
    , Balls(balls)
    , Stop(stop)
  {
  }

  std::vector<VoxelFace<D>> Run()
  {
    for (std::uint32_t b = 0; b < this->Balls.size(); ++b)
    {
      this->Reaching.push_back(b);
    }
    Block<D> all{ {}, this->Image.CropDimensions() };
    all.Low.fill(-1);
    for (std::int64_t& last : all.High)
    {
      --last;
    }
    this->Visit(all, 0);
    std::sort(this->Found.begin(), this->Found.end());
    return std::move(this->Found);
  }

private:
  /** @param first the balls of this->Reaching from this position on may intersect the block */
  void Visit(const Block<D>& block, std::size_t first)
  {
    const std::size_t own = this->Reaching.size();
    // Many balls may overlap where the image has no interface.
    if (block.NumberOfRows() <= own - first && !this->HasSites(block))
    {
      return;
    }
    const bool isWithinOne = this->KeepReaching(this->BoundsOf(block), first);
    const std::size_t axis = block.LongestAxis();
    if (this->Reaching.size() > own)
    {
      if (isWithinOne || block.High[axis] - block.Low[axis] < LeafEdge)
      {
        this->AddFaces(block, own);
      }
      else
      {
        Block<D> half = block;
        half.High[axis] = (block.Low[axis] + block.High[axis]) / 2;
        this->Visit(half, own);
        half.Low[axis] = half.High[axis] + 1;
        half.High[axis] = block.High[axis];
        this->Visit(half, own);
      }
    }
    this->Reaching.resize(own);
  }

  /** A box in the frame that contains the centres of the block's faces, in spite of rounding. */
  Box<D> BoundsOf(const Block<D>& block) const
  {
    constexpr double Slack = 1e-6; // voxels
    const auto& matrix = this->Image.Grid().IndexToFrame;
    Box<D> bounds{ {}, {} };
    for (std::size_t row = 0; row < D; ++row)
    {
      for (std::size_t a = row; a < D; ++a)
      {
        const auto origin = static_cast<double>(this->Image.CropOrigin()[a]);
        const double low = matrix[row][a] * (origin + static_cast<double>(block.Low[a]) - Slack);
        const double high =
          matrix[row][a] * (origin + static_cast<double>(block.High[a]) + 0.5 + Slack);
        bounds.Min[row] += std::min(low, high);
        bounds.Max[row] += std::max(low, high);
      }
    }
    return bounds;
  }

  /**
   * Checks the balls of this->Reaching from `first` on. If a ball contains the box, appends only
   * this ball. Otherwise appends all balls that intersect the box.
   * @return whether a ball contains the box
   */
  bool KeepReaching(const Box<D>& box, std::size_t first)
  {
    const std::size_t own = this->Reaching.size();
    for (std::size_t k = first; k < own; ++k)
    {
      const std::uint32_t b = this->Reaching[k];
      const SearchBall<D>& ball = this->Balls[b];
      const double radius2 = ball.Radius * ball.Radius;
      double nearest2 = 0.0;
      double farthest2 = 0.0;
      for (std::size_t a = 0; a < D; ++a)
      {
        const double below = box.Min[a] - ball.Centre[a];
        const double above = ball.Centre[a] - box.Max[a];
        const double outside = std::max({ below, above, 0.0 });
        const double far = std::max(-below, -above);
        nearest2 += outside * outside;
        farthest2 += far * far;
      }
      if (farthest2 <= radius2)
      {
        this->Reaching.resize(own);
        this->Reaching.push_back(b);
        return true;
      }
      if (nearest2 <= radius2)
      {
        this->Reaching.push_back(b);
      }
    }
    return false;
  }

  /** Calls f for each site of the block until f returns false. */
  template <typename Function>
  void ForEachSite(const Block<D>& block, Function f) const
  {
    Index voxel = block.Low;
    for (bool isInside = true; isInside; isInside = NextRow(voxel, block))
    {
      Index inMask = voxel;
      for (std::int64_t& c : inMask)
      {
        ++c;
      }
      const auto words = this->Sites.Row(this->Sites.RowOf(inMask));
      const std::int64_t low = block.Low[0] + 1;
      const std::int64_t high = block.High[0] + 1;
      for (std::int64_t w = low / 64; 64 * w <= high; ++w)
      {
        std::uint64_t bits =
          words[static_cast<std::size_t>(w)] & BitMask<D>::RunInWord(low, high, w);
        for (; bits != 0; bits &= bits - 1)
        {
          voxel[0] = 64 * w + std::countr_zero(bits) - 1;
          if (!f(voxel))
          {
            return;
          }
        }
      }
    }
  }

  bool HasSites(const Block<D>& block) const
  {
    bool any = false;
    this->ForEachSite(block,
      [&](const Index&)
      {
        any = true;
        return false;
      });
    return any;
  }

  void AddFaces(const Block<D>& block, std::size_t first)
  {
    ThrowIfStopped(this->Stop);
    this->ForEachSite(block,
      [&](const Index& voxel)
      {
        this->AddFaces(voxel, first);
        return true;
      });
  }

  /** Moves to the block's next row along the first axis. False if there is none. */
  static bool NextRow(Index& voxel, const Block<D>& block)
  {
    std::size_t a = 1;
    while (a < D && voxel[a] == block.High[a])
    {
      voxel[a] = block.Low[a];
      ++a;
    }
    if (a == D)
    {
      return false;
    }
    ++voxel[a];
    return true;
  }

  /** Adds the faces on the voxel's upper sides. */
  void AddFaces(const Index& voxel, std::size_t first)
  {
    for (unsigned a = 0; a < D; ++a)
    {
      const VoxelFace<D> face{ voxel, a };
      if (IsOfInterface(face, this->Image) && this->IsNear(face, first))
      {
        this->Found.push_back(face);
      }
    }
  }

  bool IsNear(const VoxelFace<D>& face, std::size_t first) const
  {
    const Point<D> centre = CentreOf(face, this->Image);
    return std::any_of(this->Reaching.begin() + static_cast<std::ptrdiff_t>(first),
      this->Reaching.end(),
      [&](std::uint32_t b)
      {
        const SearchBall<D>& ball = this->Balls[b];
        return Distance2(centre, ball.Centre) <= ball.Radius * ball.Radius;
      });
  }

  const LabelImage<D>& Image;
  const BitMask<D>& Sites;
  const std::vector<SearchBall<D>>& Balls;
  const std::stop_token Stop;
  std::vector<std::uint32_t> Reaching; ///< stack: the balls of each block on the recursion's path
  std::vector<VoxelFace<D>> Found;
};

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
std::vector<VoxelFace<D>> FindFacesNear(const LabelImage<D>& image, const BitMask<D>& sites,
  const std::vector<SearchBall<D>>& balls, const std::stop_token& stop)
{
  return Search<D>(image, sites, balls, stop).Run();
}

template std::vector<VoxelFace<3>> FindFacesNear<3>(const LabelImage<3>&, const BitMask<3>&,
  const std::vector<SearchBall<3>>&, const std::stop_token&);
template std::vector<VoxelFace<4>> FindFacesNear<4>(const LabelImage<4>&, const BitMask<4>&,
  const std::vector<SearchBall<4>>&, const std::stop_token&);

} // namespace voxplex
