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

/** A bit for each voxel of a box. Most boxes need no memory from the heap. */
constexpr std::size_t BitsOfWord = 64;
using Bits = boost::container::small_vector<std::uint64_t, 64>;

bool Has(const Bits& set, std::size_t bit)
{
  return (set[bit / BitsOfWord] >> bit % BitsOfWord & 1) != 0;
}

void Add(Bits& set, std::size_t bit)
{
  set[bit / BitsOfWord] |= std::uint64_t{ 1 } << bit % BitsOfWord;
}

/** Keeps what is in another set, too. @return whether that is anything */
bool Intersect(Bits& set, const Bits& other)
{
  std::uint64_t any = 0;
  for (std::size_t w = 0; w < set.size(); ++w)
  {
    any |= set[w] &= other[w];
  }
  return any != 0;
}

/**
 * @brief Sets of the voxels of a box. The bits are in the order of indices, with a free one after each line
 * along each axis, so that the bits beside that of a voxel are of voxels beside it, or free.
 */
template <int D>
class VoxelSets
{
public:
  using Index = typename GridGeometry<D>::Index;

  VoxelSets(const Index& low, const Index& high)
    : Low(low)
    , High(high)
  {
    std::size_t stride = 1;
    for (std::size_t k = 0; k < D; ++k)
    {
      this->Strides[k] = stride;
      stride *= static_cast<std::size_t>(high[k] - low[k] + 2);
    }
    this->Words = stride / BitsOfWord + 1;
  }

  std::size_t BitOf(const Index& voxel) const
  {
    std::size_t bit = 0;
    for (std::size_t k = 0; k < D; ++k)
    {
      bit += static_cast<std::size_t>(voxel[k] - this->Low[k]) * this->Strides[k];
    }
    return bit;
  }

  /** The voxels of some labels. */
  template <std::size_t N>
  std::array<Bits, N> VoxelsOf(
    const LabelImage<D>& image, const std::array<LabelId, N>& labels) const
  {
    std::array<Bits, N> found;
    found.fill(Bits(this->Words));
    const auto end = static_cast<std::size_t>(this->High[0] + 1);
    Index last = this->High;
    last[0] = this->Low[0];
    ForEachIndex(this->Low, last,
      [&](const Index& first)
      {
        const std::span<const LabelId> row = image.RowAt(first);
        std::size_t bit = this->BitOf(first);
        for (auto x = static_cast<std::size_t>(first[0]); x != end; ++x, ++bit)
        {
          const LabelId label = x < row.size() ? row[x] : LabelId{ 0 };
          for (std::size_t k = 0; k < N; ++k)
          {
            if (label == labels[k])
            {
              Add(found[k], bit);
            }
          }
        }
      });
    return found;
  }

  Bits SetOf(const Index& voxel) const
  {
    Bits set(this->Words);
    Add(set, this->BitOf(voxel));
    return set;
  }

  /** Adds the voxels beside those of a set along an axis. */
  void Widen(Bits& set, std::size_t axis) const
  {
    const std::size_t words = this->Strides[axis] / BitsOfWord;
    const std::size_t bits = this->Strides[axis] % BitsOfWord;
    const Bits before = set;
    const auto at = [&](std::size_t w) { return w < before.size() ? before[w] : 0; };
    for (std::size_t w = 0; w < set.size(); ++w)
    {
      set[w] |= at(w - words) << bits | at(w + words) >> bits;
      if (bits != 0)
      {
        set[w] |=
          at(w - words - 1) >> (BitsOfWord - bits) | at(w + words + 1) << (BitsOfWord - bits);
      }
    }
  }

private:
  const Index Low;
  const Index High; ///< is in the box
  std::array<std::size_t, static_cast<std::size_t>(D)> Strides;
  std::size_t Words;
};

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
  double most = 0.0; // voxels of the reach; smaller boxes answer most questions
  for (bool isAll = false; !isAll; most = most == 0.0 ? 1.0 : 3.0 * most)
  {
    isAll = true;
    Index low; // of the centres of voxels around the centroid
    Index high;
    for (std::size_t k = 0; k < D; ++k)
    {
      const double voxels = reach * this->VoxelsPerLength[k];
      isAll = isAll && voxels <= most;
      const auto by = static_cast<std::int64_t>(std::min(most, voxels));
      low[k] = static_cast<std::int64_t>(std::floor(index[k])) - by;
      high[k] = low[k] + 1 + 2 * by;
    }
    if (most == 0.0 ? this->AreInBox(low, high, a, b) : this->TouchInBox(low, high, a, b))
    {
      return true;
    }
  }
  return false;
}

/** The voxels of a box touch each other if there are two along each axis. */
template <int D>
bool LabelContacts<D>::AreInBox(const Index& low, const Index& high, LabelId a, LabelId b) const
{
  bool isA = false;
  bool isB = false;
  ForEachIndex(low, high,
    [&](const Index& voxel)
    {
      const LabelId label = this->Image.At(voxel);
      isA = isA || label == a;
      isB = isB || label == b;
    });
  return isA && isB;
}

template <int D>
bool LabelContacts<D>::TouchInBox(const Index& low, const Index& high, LabelId a, LabelId b) const
{
  const VoxelSets<D> sets(low, high);
  auto [ofA, nearB] = sets.VoxelsOf(this->Image, std::array{ a, b });
  for (std::size_t k = 0; k < D; ++k)
  {
    sets.Widen(nearB, k);
  }
  return Intersect(nearB, ofA);
}

//------------------------------------------------------------------------------------------------
template <int D>
auto LabelContacts<D>::VoxelOf(LabelId label, const Point<D>& p) const -> std::optional<Index>
{
  const Index centre = this->Image.VoxelAt(p);
  if (this->Image.At(centre) == label)
  {
    return centre;
  }
  Index low = centre;
  Index high = centre;
  for (std::size_t k = 0; k < D; ++k)
  {
    --low[k];
    ++high[k];
  }
  std::optional<Index> nearest;
  double least2 = std::numeric_limits<double>::infinity();
  ForEachIndex(low, high,
    [&](const Index& voxel)
    {
      const double distance2 = Distance2(this->Image.CentreOf(voxel), p);
      if (distance2 < least2 && this->Image.At(voxel) == label)
      {
        least2 = distance2;
        nearest = voxel;
      }
    });
  return nearest;
}

template <int D>
bool LabelContacts<D>::AreConnected(
  const Point<D>& p, const Point<D>& q, LabelId label, Through through) const
{
  const std::optional<Index> from = this->VoxelOf(label, p);
  const std::optional<Index> to = this->VoxelOf(label, q);
  if (!from || !to || *from == *to)
  {
    return true;
  }
  for (const double detour : { 0.0, 1.0, Detour }) // a small box answers many questions
  {
    Index low;
    Index high;
    for (std::size_t k = 0; k < D; ++k)
    {
      const auto by = static_cast<std::int64_t>(detour * this->Diagonal * this->VoxelsPerLength[k]);
      low[k] = std::min((*from)[k], (*to)[k]) - by;
      high[k] = std::max((*from)[k], (*to)[k]) + by;
    }
    const VoxelSets<D> sets(low, high);
    const Bits all = sets.VoxelsOf(this->Image, std::array{ label })[0];
    Bits reached = sets.SetOf(*from);
    Bits before;
    while (reached != before && !Has(reached, sets.BitOf(*to)))
    {
      before = reached;
      for (std::size_t k = 0; k < D; ++k)
      {
        sets.Widen(reached, k);
        if (through == Through::Faces || k + 1 == D)
        {
          Intersect(reached, all);
        }
      }
    }
    if (Has(reached, sets.BitOf(*to)))
    {
      return true;
    }
  }
  return false;
}

template class LabelContacts<3>;
template class LabelContacts<4>;

} // namespace voxplex
