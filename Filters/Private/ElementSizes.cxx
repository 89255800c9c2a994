// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Private/ElementSizes.h"

#include "Base/Error.h"
#include "Base/NumberText.h"
#include "Sizing/Grading/PointBounds.h"

#include "vtkDataArray.h"
#include "vtkImplicitFunction.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace voxplex
{

namespace
{
constexpr double NoBound = std::numeric_limits<double>::infinity();

/** NaN, zero and negative values set no bound. */
double AsBound(double size)
{
  return size > 0.0 ? size : NoBound;
}

/** Of all voxels, in the world. */
Box<3> BoundsOf(const ImageFrame& frame)
{
  std::array<Point<3>, 8> corners;
  for (unsigned corner = 0; corner < 8; ++corner)
  {
    Point<3> index;
    for (std::size_t a = 0; a < 3; ++a)
    {
      const bool high = (corner >> a) & 1u;
      index[a] = (high ? static_cast<double>(frame.Grid.Dimensions[a]) : 0.0) - 0.5;
    }
    corners[corner] = frame.ToWorld(frame.Grid.ToFrame(index));
  }
  return voxplex::BoundsOf<3>(corners);
}

std::string Describe(const Box<3>& box)
{
  std::string text;
  for (std::size_t a = 0; a < 3; ++a)
  {
    text += (a > 0 ? ", " : "") + std::string(1, "xyz"[a]) + " from " + NumberText(box.Min[a]) +
      " to " + NumberText(box.Max[a]);
  }
  return text;
}
} // namespace

void CheckOverlap(const ImageFrame& sizes, const ImageFrame& image)
{
  const Box<3> theirs = BoundsOf(sizes);
  const Box<3> ours = BoundsOf(image);
  for (std::size_t a = 0; a < 3; ++a)
  {
    if (theirs.Min[a] >= ours.Max[a] || theirs.Max[a] <= ours.Min[a])
    {
      throw InputError("The image of sizes ({size-image}) lies beside the image: it has " +
        Describe(theirs) + "; the image has " + Describe(ours) +
        ". Correct its spacing, origin or direction.");
    }
  }
}

SizeImage::SizeImage(const ImageFrame& frame, vtkDataArray* sizes)
  : Frame(frame)
  , Sizes(sizes)
{
}

bool SizeImage::Covers(const Point<3>& x) const
{
  const Point<3> index = this->Frame.Grid.ToIndex(this->Frame.ToFrame(x));
  bool isCovered = true;
  for (std::size_t a = 0; a < 3; ++a)
  {
    isCovered &=
      index[a] >= -1.0 && index[a] <= static_cast<double>(this->Frame.Grid.Dimensions[a]);
  }
  return isCovered;
}

double SizeImage::At(const Point<3>& x) const
{
  const GridGeometry<3>& grid = this->Frame.Grid;
  const Point<3> index = grid.ToIndex(this->Frame.ToFrame(x));
  std::array<std::int64_t, 3> low;
  std::array<double, 3> fraction;
  for (std::size_t a = 0; a < 3; ++a)
  {
    const double last = static_cast<double>(grid.Dimensions[a] - 1);
    const double inside = std::clamp(index[a], 0.0, last);
    low[a] = std::min(
      static_cast<std::int64_t>(inside), std::max<std::int64_t>(grid.Dimensions[a] - 2, 0));
    fraction[a] = inside - static_cast<double>(low[a]);
  }

  double sum = 0.0;
  double weights = 0.0;
  for (unsigned corner = 0; corner < 8; ++corner)
  {
    double weight = 1.0;
    std::int64_t voxel = 0;
    for (std::size_t a = 3; a-- > 0;)
    {
      const bool high = (corner >> a) & 1u;
      weight *= high ? fraction[a] : 1.0 - fraction[a];
      voxel = voxel * grid.Dimensions[a] + low[a] + (high ? 1 : 0);
    }
    if (weight > 0.0) // a weight of 0 may belong to a voxel beyond the last one
    {
      const double size = this->Sizes->GetComponent(voxel, 0);
      if (size > 0.0 && std::isfinite(size))
      {
        sum += weight * size;
        weights += weight;
      }
    }
  }
  return weights > 0.0 ? sum / weights : NoBound;
}

template <int D>
bool ElementSizes<D>::Any() const
{
  return this->Uniform > 0.0 || !this->PerLabel.empty() || this->Image || this->Implicit ||
    this->Function;
}

template <int D>
double ElementSizes<D>::Evaluate(const Point<D>& p, std::int64_t label) const
{
  double size = AsBound(this->Uniform);
  if (!this->PerLabel.empty())
  {
    const auto found = this->PerLabel.find(label);
    if (found != this->PerLabel.end())
    {
      size = std::min(size, AsBound(found->second));
    }
  }
  if (!this->Image && !this->Implicit && !this->Function)
  {
    return size;
  }
  const Point<D> x = this->Frame.ToWorld(p);
  if (this->Image)
  {
    size = std::min(size, this->Image->At({ x[0], x[1], x[2] }));
  }
  if (this->Implicit)
  {
    const std::lock_guard<std::mutex> lock(this->ImplicitMutex);
    size = std::min(size, AsBound(this->Implicit->FunctionValue(x.data())));
  }
  if (this->Function)
  {
    size = std::min(size, AsBound(this->Call(x, label)));
  }
  return size;
}

template <int D>
double ElementSizes<D>::Call(const Point<D>& x, std::int64_t label) const
{
  if (this->Failed())
  {
    return NoBound;
  }
  try
  {
    return this->Function(x.data(), label);
  }
  catch (...) // an exception must not leave a meshing thread: it would end the program
  {
    const std::lock_guard<std::mutex> lock(this->FailureMutex);
    if (!this->Failure)
    {
      this->Failure = std::current_exception();
    }
    this->HasFailed.store(true, std::memory_order_release);
    return NoBound;
  }
}

template <int D>
void ElementSizes<D>::Rethrow() const
{
  const std::lock_guard<std::mutex> lock(this->FailureMutex);
  if (this->Failure)
  {
    std::rethrow_exception(this->Failure);
  }
}

template class ElementSizes<3>;
template class ElementSizes<4>;

} // namespace voxplex
