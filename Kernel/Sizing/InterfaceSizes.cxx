// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Sizing/InterfaceSizes.h"

#include "Base/Error.h"
#include "Base/GridIndex.h"
#include "Base/NumberText.h"

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <span>
#include <string>

namespace voxplex
{

namespace
{

constexpr double Unset = std::numeric_limits<double>::infinity();

LabelId DenseId(std::span<const std::int64_t> values, std::int64_t value)
{
  const auto found = std::lower_bound(values.begin(), values.end(), value);
  if (found == values.end() || *found != value)
  {
    throw InputError("an interface size is given to label " + std::to_string(value) +
      ", which does not occur in the image");
  }
  return static_cast<LabelId>(found - values.begin());
}

/**
 * Calls visit(axis, direction, id) with the label beyond each face of a voxel of the crop. Beyond
 * the crop it is background.
 */
template <int D, typename Visit>
void ForEachNeighbour(
  const LabelImage<D>& image, const typename GridGeometry<D>::Index& voxel, Visit&& visit)
{
  const auto& n = image.CropDimensions();
  const std::size_t offset = OffsetOf(voxel, n);
  std::size_t stride = 1;
  for (std::size_t a = 0; a < D; ++a)
  {
    visit(a, -1, voxel[a] > 0 ? image.Ids()[offset - stride] : LabelId(0));
    visit(a, 1, voxel[a] + 1 < n[a] ? image.Ids()[offset + stride] : LabelId(0));
    stride *= static_cast<std::size_t>(n[a]);
  }
}

template <int D>
Point<D> FaceCentre(
  const typename GridGeometry<D>::Index& voxel, std::size_t axis, std::int64_t direction)
{
  Point<D> p;
  for (std::size_t a = 0; a < D; ++a)
  {
    p[a] = static_cast<double>(voxel[a]);
  }
  p[axis] += 0.5 * static_cast<double>(direction);
  return p;
}

/** A point of the frame, from a continuous index of the crop. */
template <int D>
Point<D> ToFrame(const LabelImage<D>& image, Point<D> index)
{
  for (std::size_t a = 0; a < D; ++a)
  {
    index[a] += static_cast<double>(image.CropOrigin()[a]);
  }
  return image.Grid().ToFrame(index);
}

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
InterfaceSizes<D>::InterfaceSizes(const LabelImage<D>& image,
  const std::vector<InterfaceSize>& sizes, const BaseDistance<D>& base, double gradation,
  unsigned threads, const std::stop_token& stop)
  : OfLabel(image.Values().size(), Unset)
  , Base(base)
  , IsGraded(gradation > 0.0)
  , LargestOfLabel(image.Values().size(), 0.0)
{
  this->Take(image, sizes);
  this->Summarise(image, threads, stop);
  if (this->SmallestSize < this->LargestSize)
  {
    this->Grid = GradedGrid<D>(
      image, this->IsGraded ? gradation : SafeSlope,
      [&](const typename GridGeometry<D>::Index& voxel, LabelId id, auto&& add)
      {
        ForEachNeighbour<D>(image, voxel,
          [&](std::size_t axis, std::int64_t direction, LabelId other)
          {
            if (other == id)
            {
              return;
            }
            const Point<D> centre = FaceCentre<D>(voxel, axis, direction);
            const double size = this->Between(ToFrame(image, centre), id, other);
            if (size < this->LargestSize)
            {
              add(centre, size);
            }
          });
      },
      threads, stop);
  }
}

//------------------------------------------------------------------------------------------------
template <int D>
void InterfaceSizes<D>::Take(const LabelImage<D>& image, const std::vector<InterfaceSize>& sizes)
{
  for (const InterfaceSize& size : sizes)
  {
    const LabelId a = DenseId(image.Values(), size.Label);
    const std::string name = "label " + std::to_string(size.Label) +
      (size.Other == InterfaceSize::AnyLabel ? "" : " and label " + std::to_string(size.Other));
    if (!(size.Size > 0.0) || std::isinf(size.Size))
    {
      throw InputError("the interface size of " + name + " must be positive and finite; it is " +
        NumberText(size.Size));
    }
    bool isNew = false;
    if (size.Other == InterfaceSize::AnyLabel)
    {
      isNew = std::isinf(this->OfLabel[a]);
      this->OfLabel[a] = size.Size;
    }
    else
    {
      if (size.Other == size.Label)
      {
        throw InputError(name + ": a label has no interface with itself");
      }
      isNew = this->OfPair.emplace(Key(a, DenseId(image.Values(), size.Other)), size.Size).second;
    }
    if (!isNew)
    {
      throw InputError("the interface size of " + name + " is given twice");
    }
  }
}

//------------------------------------------------------------------------------------------------
// Faces are counted for each pair of labels, so that the result does not depend on the order.
template <int D>
void InterfaceSizes<D>::Summarise(
  const LabelImage<D>& image, unsigned threads, const std::stop_token& stop)
{
  using Faces = std::array<std::uint64_t, static_cast<std::size_t>(D)>; // by axis
  std::map<std::uint64_t, Faces> all;
  std::mutex mutex; // guards `all`
  const auto& n = image.CropDimensions();
  const std::size_t row = static_cast<std::size_t>(n[0]);
  ParallelFor(
    0, image.Ids().size() / row, 256, threads,
    [&](std::size_t first, std::size_t last)
    {
      std::unordered_map<std::uint64_t, Faces> found;
      for (std::size_t r = first; r < last; ++r)
      {
        typename GridGeometry<D>::Index voxel = IndexAt(r * row, n);
        for (; voxel[0] < n[0]; ++voxel[0])
        {
          const LabelId id = image.Ids()[r * row + static_cast<std::size_t>(voxel[0])];
          if (id != 0)
          {
            ForEachNeighbour<D>(image, voxel,
              [&](std::size_t axis, std::int64_t, LabelId other)
              {
                if (other != id)
                {
                  // A face between two labels is met from both sides.
                  found[Key(id, other)][axis] += other == 0 ? 2 : 1;
                }
              });
          }
        }
      }
      const std::scoped_lock lock(mutex);
      for (const auto& [pair, faces] : found)
      {
        for (std::size_t a = 0; a < D; ++a)
        {
          all[pair][a] += faces[a];
        }
      }
    },
    stop);

  this->SmallestSize = Unset;
  double area = 0.0;
  double vertices = 0.0; // an estimate
  for (const auto& [pair, faces] : all)
  {
    const auto a = static_cast<LabelId>(pair >> 32);
    const auto b = static_cast<LabelId>(pair & 0xffffffffu);
    const double given = this->Given(a, b);
    const bool isGiven = std::isfinite(given);
    const double largest = isGiven ? given : this->Base.Delta;
    this->SmallestSize = std::min(this->SmallestSize, isGiven ? given : this->Base.Finest());
    this->LargestSize = std::max(this->LargestSize, largest);
    for (const LabelId label : { a, b })
    {
      this->LargestOfLabel[label] = std::max(this->LargestOfLabel[label], largest);
    }
    const double equivalent = isGiven ? given : this->Base.Equivalent;
    for (std::size_t axis = 0; axis < D; ++axis)
    {
      const double part =
        static_cast<double>(faces[axis]) / image.Grid().Spacing(static_cast<int>(axis));
      area += part;
      vertices += part * std::pow(equivalent, 1 - D);
    }
  }
  this->EquivalentSize = std::pow(vertices / area, 1.0 / (1 - D));
}

template class InterfaceSizes<3>;
template class InterfaceSizes<4>;

} // namespace voxplex
