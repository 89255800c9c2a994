// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Image/LabelContacts.h"

#include "Base/GridIndex.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace voxplex
{

namespace
{

/**
 * Labels touch near a facet if they do so within this part of the distance from its centroid to its
 * farthest vertex, and a voxel's diagonal. With 1, facets of coarse meshes are taken for right that lie
 * 1.5 sampling distances away from all contacts.
 */
constexpr double FacetReach = 0.5;

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
auto LabelContacts<D>::LabelsAlong(const Point<D>& from, const Point<D>& to) const -> Runs
{
  const Point<D> x = this->Image.ToCrop(from);
  const Point<D> d = Subtract(this->Image.ToCrop(to), x);
  double begin = 0.0;
  double end = 1.0;
  double longest = 0.0;
  for (std::size_t k = 0; k < D; ++k)
  {
    longest = std::max(longest, std::abs(d[k]));
    if (d[k] != 0.0) // to the crop and the layer around it
    {
      const double t0 = (-1.0 - x[k]) / d[k];
      const double t1 = (static_cast<double>(this->Image.CropDimensions()[k]) - x[k]) / d[k];
      begin = std::max(begin, std::min(t0, t1));
      end = std::min(end, std::max(t0, t1));
    }
  }
  Runs runs;
  if (!(begin <= end))
  {
    runs.push_back({ 0, 0.0, 1.0 });
    return runs;
  }
  constexpr double StepsPerVoxel = 2.0;
  const auto steps = static_cast<std::size_t>(std::ceil(StepsPerVoxel * longest * (end - begin)));
  for (std::size_t i = 0; i <= steps; ++i)
  {
    const double t = begin +
      (end - begin) * static_cast<double>(i) / static_cast<double>(std::max<std::size_t>(steps, 1));
    Index voxel; // the nearest one, from -1 on
    for (std::size_t k = 0; k < D; ++k)
    {
      voxel[k] = static_cast<std::int64_t>(x[k] + t * d[k] + 1.5) - 1;
    }
    const LabelId label = this->Image.At(voxel);
    if (runs.empty() || runs.back().Label != label)
    {
      runs.push_back({ label, t, t });
    }
    runs.back().End = t;
  }
  return runs;
}

//------------------------------------------------------------------------------------------------
template <int D>
bool LabelContacts<D>::TouchNear(
  const std::array<const Point<D>*, static_cast<std::size_t>(D)>& corners, LabelId a,
  LabelId b) const
{
  const Point<D> centroid = Centroid(corners);
  double reach2 = 0.0;
  for (const Point<D>* p : corners)
  {
    reach2 = std::max(reach2, Distance2(*p, centroid));
  }
  const double reach = FacetReach * std::sqrt(reach2) + this->Diagonal;
  const Point<D> index = this->Image.ToCrop(centroid);
  constexpr double All = std::numeric_limits<double>::infinity();
  for (const double most : { 0.0, 1.0, All }) // smaller boxes answer most questions
  {
    Index low; // of the centres of voxels around the centroid
    Index high;
    for (std::size_t k = 0; k < D; ++k)
    {
      const auto by = static_cast<std::int64_t>(std::min(most, reach * this->VoxelsPerLength[k]));
      low[k] = static_cast<std::int64_t>(std::floor(index[k])) - by;
      high[k] = low[k] + 1 + 2 * by;
    }
    if (this->TouchInBox(low, high, a, b))
    {
      return true;
    }
  }
  return false;
}

/** Whether two labels touch in a box, with all its voxels, but at most 64 along the first axis. */
template <int D>
bool LabelContacts<D>::TouchInBox(Index low, Index high, LabelId a, LabelId b) const
{
  constexpr std::int64_t Bits = 64;
  const std::int64_t width = std::min(high[0] + 1 - low[0], Bits);
  low[0] = (low[0] + high[0] + 1 - width) / 2;
  high[0] = low[0];
  using Rows = boost::container::small_vector<std::uint64_t, 256>; // a bit for each voxel
  Rows ofA;
  Rows ofB;
  std::uint64_t anyA = 0;
  std::uint64_t anyB = 0;
  ForEachIndex(low, high,
    [&](const Index& first)
    {
      const std::span<const LabelId> row = this->Image.RowAt(first);
      std::uint64_t inA = 0;
      std::uint64_t inB = 0;
      for (std::int64_t i = 0; i < width; ++i)
      {
        const std::int64_t x = first[0] + i;
        const LabelId label =
          x >= 0 && x < std::ssize(row) ? row[static_cast<std::size_t>(x)] : LabelId{ 0 };
        inA |= std::uint64_t{ label == a } << i;
        inB |= std::uint64_t{ label == b } << i;
      }
      ofA.push_back(inA);
      ofB.push_back(inB);
      anyA |= inA;
      anyB |= inB;
    });
  if (anyA == 0 || anyB == 0)
  {
    return false;
  }
  std::size_t stride = 1;
  for (std::size_t k = 1; k < D;
       ++k) // the voxels of b are spread to the rows beside along each axis
  {
    const std::size_t line = stride * static_cast<std::size_t>(high[k] + 1 - low[k]);
    const Rows before = ofB;
    for (std::size_t i = 0; i < before.size(); ++i)
    {
      ofB[i] |= i % line >= stride ? before[i - stride] : 0;
      ofB[i] |= i % line + stride < line ? before[i + stride] : 0;
    }
    stride = line;
  }
  bool touch = false;
  for (std::size_t i = 0; i < ofA.size(); ++i)
  {
    touch = touch || ((ofA[i] | ofA[i] << 1 | ofA[i] >> 1) & ofB[i]) != 0;
  }
  return touch;
}

//------------------------------------------------------------------------------------------------
/** Replaces a voxel without a label by one with it beside it, if there is one. */
template <int D>
bool LabelContacts<D>::FindVoxelOf(LabelId label, Index& voxel) const
{
  if (this->Image.At(voxel) == label)
  {
    return true;
  }
  Index low = voxel;
  Index high = voxel;
  for (std::size_t k = 0; k < D; ++k)
  {
    --low[k];
    ++high[k];
  }
  const Index centre = voxel;
  std::int64_t nearest = std::numeric_limits<std::int64_t>::max();
  ForEachIndex(low, high,
    [&](const Index& at)
    {
      std::int64_t steps = 0;
      for (std::size_t k = 0; k < D; ++k)
      {
        steps += std::abs(at[k] - centre[k]);
      }
      if (steps < nearest && this->Image.At(at) == label)
      {
        nearest = steps;
        voxel = at;
      }
    });
  return nearest != std::numeric_limits<std::int64_t>::max();
}

template <int D>
bool LabelContacts<D>::AreConnected(const Point<D>& p, const Point<D>& q, LabelId label) const
{
  Index from = this->Image.VoxelAt(p);
  Index to = this->Image.VoxelAt(q);
  if (!this->FindVoxelOf(label, from) || !this->FindVoxelOf(label, to) || from == to)
  {
    return true;
  }
  Index low;
  Index extent;
  for (std::size_t k = 0; k < D; ++k)
  {
    const auto by = static_cast<std::int64_t>(Detour * this->Diagonal * this->VoxelsPerLength[k]);
    low[k] = std::min(from[k], to[k]) - by;
    extent[k] = std::max(from[k], to[k]) + by + 1 - low[k];
    from[k] -= low[k];
    to[k] -= low[k];
  }
  std::vector<bool> isSeen(CountCells(extent));
  std::vector<Index> front{ from };
  isSeen[OffsetOf(from, extent)] = true;
  while (!front.empty())
  {
    const Index at = front.back();
    front.pop_back();
    if (at == to)
    {
      return true;
    }
    for (const bool isTowards : { false, true }) // the last is the next to be looked at
    {
      for (std::size_t k = 0; k < D; ++k)
      {
        Index next = at;
        next[k] += (to[k] > at[k]) == isTowards ? 1 : -1;
        if (next[k] < 0 || next[k] >= extent[k] || isSeen[OffsetOf(next, extent)])
        {
          continue;
        }
        isSeen[OffsetOf(next, extent)] = true;
        Index voxel = next;
        for (std::size_t j = 0; j < D; ++j)
        {
          voxel[j] += low[j];
        }
        if (this->Image.At(voxel) == label)
        {
          front.push_back(next);
        }
      }
    }
  }
  return false;
}

template class LabelContacts<3>;
template class LabelContacts<4>;

} // namespace voxplex
