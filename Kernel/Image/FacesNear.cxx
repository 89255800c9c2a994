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

using Index = GridGeometry<3>::Index;

/** Blocks of at most this number of voxels along each axis are searched face by face. */
constexpr std::int64_t LeafEdge = 4;

/** The voxels from `Low` to `High`, both included. */
struct Block
{
  Index Low;
  Index High;

  std::size_t LongestAxis() const
  {
    std::size_t longest = 0;
    for (std::size_t a = 1; a < 3; ++a)
    {
      longest =
        this->High[a] - this->Low[a] > this->High[longest] - this->Low[longest] ? a : longest;
    }
    return longest;
  }
};

class Search
{
public:
  Search(const LabelImage<3>& image, const BitMask<3>& sites, std::span<const SearchBall> balls,
    const std::stop_token& stop)
    : Image(image)
    , Sites(sites)
    , Balls(balls)
    , Stop(stop)
  {
  }

  std::vector<VoxelFace> Run()
  {
    for (std::uint32_t b = 0; b < this->Balls.size(); ++b)
    {
      this->Reaching.push_back(b);
    }
    Block all{ { -1, -1, -1 }, this->Image.CropDimensions() };
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
  void Visit(const Block& block, std::size_t first)
  {
    const std::size_t own = this->Reaching.size();
    const bool isWithinOne = this->KeepReaching(this->BoundsOf(block), first);
    const std::size_t axis = block.LongestAxis();
    if (this->Reaching.size() > own)
    {
      if (isWithinOne || block.High[axis] - block.Low[axis] < LeafEdge)
      {
        this->AddFacesOf(block, own);
      }
      else
      {
        Block half = block;
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
  Box<3> BoundsOf(const Block& block) const
  {
    constexpr double Slack = 1e-6; // voxels
    const auto& matrix = this->Image.Grid().IndexToFrame;
    Box<3> bounds{ {}, {} };
    for (std::size_t row = 0; row < 3; ++row)
    {
      for (std::size_t a = row; a < 3; ++a)
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
  bool KeepReaching(const Box<3>& box, std::size_t first)
  {
    const std::size_t own = this->Reaching.size();
    for (std::size_t k = first; k < own; ++k)
    {
      const std::uint32_t b = this->Reaching[k];
      const SearchBall& ball = this->Balls[b];
      const double radius2 = ball.Radius * ball.Radius;
      double nearest2 = 0.0;
      double farthest2 = 0.0;
      for (std::size_t a = 0; a < 3; ++a)
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

  void AddFacesOf(const Block& block, std::size_t first)
  {
    ThrowIfStopped(this->Stop);
    Index voxel;
    for (voxel[2] = block.Low[2]; voxel[2] <= block.High[2]; ++voxel[2])
    {
      for (voxel[1] = block.Low[1]; voxel[1] <= block.High[1]; ++voxel[1])
      {
        const auto words = this->Sites.Row(this->Sites.RowOf({ 0, voxel[1] + 1, voxel[2] + 1 }));
        for (std::int64_t w = (block.Low[0] + 1) / 64; 64 * w <= block.High[0] + 1; ++w)
        {
          for (std::uint64_t bits = words[static_cast<std::size_t>(w)]; bits != 0; bits &= bits - 1)
          {
            voxel[0] = 64 * w + std::countr_zero(bits) - 1;
            if (voxel[0] >= block.Low[0] && voxel[0] <= block.High[0])
            {
              this->AddFacesOf(voxel, first);
            }
          }
        }
      }
    }
  }

  /** Adds the faces on the voxel's upper sides. */
  void AddFacesOf(const Index& voxel, std::size_t first)
  {
    for (unsigned a = 0; a < 3; ++a)
    {
      const VoxelFace face{ voxel, a };
      if (this->Image.At(voxel) != this->Image.At(face.Next()) && this->IsNear(face, first))
      {
        this->Found.push_back(face);
      }
    }
  }

  bool IsNear(const VoxelFace& face, std::size_t first) const
  {
    const Point<3> centre = CentreOf(face, this->Image);
    return std::any_of(this->Reaching.begin() + static_cast<std::ptrdiff_t>(first),
      this->Reaching.end(),
      [&](std::uint32_t b)
      {
        const SearchBall& ball = this->Balls[b];
        return Distance2(centre, ball.Centre) <= ball.Radius * ball.Radius;
      });
  }

  const LabelImage<3>& Image;
  const BitMask<3>& Sites;
  const std::span<const SearchBall> Balls;
  const std::stop_token Stop;
  std::vector<std::uint32_t> Reaching; ///< stack: the balls of each block on the recursion's path
  std::vector<VoxelFace> Found;
};

} // namespace

//------------------------------------------------------------------------------------------------
std::vector<VoxelFace> FindFacesNear(const LabelImage<3>& image, const BitMask<3>& sites,
  std::span<const SearchBall> balls, const std::stop_token& stop)
{
  return Search(image, sites, balls, stop).Run();
}

} // namespace voxplex
