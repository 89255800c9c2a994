// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Image/IsosurfaceImage.h"

#include "Base/Error.h"
#include "Image/LabelSmoothing.h"
#include "Image/ScalarTypes.h"
#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <mutex>
#include <sstream>
#include <string>
#include <type_traits>
#include <vector>

namespace voxplex
{
namespace
{

/** Voxels that a thread reads at once. */
constexpr std::size_t Grain = std::size_t{ 1 } << 18;

/**
 * The margin of a value, before scaling. Its sign is exact. It is 0 only for the isovalue itself.
 */
class SurfaceMargin
{
public:
  explicit SurfaceMargin(const Isosurface& surface)
    : Value(surface.Value)
    , Sign(surface.Inside == IsosurfaceSide::Above ? 1.0 : -1.0)
  {
  }

  template <typename T>
  double operator()(T value) const
  {
    return this->Sign * (static_cast<double>(value) - this->Value);
  }

private:
  double Value;
  double Sign;
};

/** The result of a pass over the values. */
struct Census
{
  double Min = std::numeric_limits<double>::infinity();
  double Max = -std::numeric_limits<double>::infinity();
  double LargestMargin = 0.0; ///< largest absolute value of the finite margins

  void Join(const Census& other)
  {
    this->Min = std::min(this->Min, other.Min);
    this->Max = std::max(this->Max, other.Max);
    this->LargestMargin = std::max(this->LargestMargin, other.LargestMargin);
  }
};

template <typename T>
Census TakeCensus(std::span<const T> scalars, const SurfaceMargin& marginOf, unsigned threads,
  const std::stop_token& stop)
{
  Census all;
  std::mutex mutex;
  ParallelFor(
    0, scalars.size(), Grain, threads,
    [&](std::size_t begin, std::size_t end)
    {
      Census census;
      for (std::size_t i = begin; i < end; ++i)
      {
        const auto value = static_cast<double>(scalars[i]);
        if (std::isnan(value))
        {
          continue;
        }
        census.Min = std::min(census.Min, value);
        census.Max = std::max(census.Max, value);
        const double margin = std::abs(marginOf(value));
        census.LargestMargin =
          std::isfinite(margin) ? std::max(census.LargestMargin, margin) : census.LargestMargin;
      }
      const std::scoped_lock lock(mutex);
      all.Join(census);
    },
    stop);
  return all;
}

void CheckSurface(const Isosurface& surface)
{
  std::ostringstream s;
  if (!std::isfinite(surface.Value))
  {
    s << "The isovalue is " << surface.Value << "; it must be finite.";
  }
  else if (surface.Label < 1)
  {
    s << "The label of the inside is " << surface.Label << "; it must be 1 or more.";
  }
  else if (!(surface.SmoothingSigma >= 0.0 && surface.SmoothingSigma <= Isosurface::LargestSigma))
  {
    s << "The standard deviation of the smoothing of grey values is " << surface.SmoothingSigma
      << " voxels; it must be between 0 (no smoothing) and " << Isosurface::LargestSigma << ".";
  }
  if (!s.str().empty())
  {
    throw InputError(s.str());
  }
}

void CheckRange(const Isosurface& surface, const std::array<double, 2>& range, const char* when)
{
  if (range[0] > range[1])
  {
    throw InputError("All values of the image are NaN, so there is no isosurface to mesh. Choose "
                     "another array.");
  }
  if (!(surface.Value >= range[0] && surface.Value <= range[1]))
  {
    std::ostringstream s;
    s << "The isovalue " << surface.Value << " is outside of the image's range, which is from "
      << range[0] << " to " << range[1] << when << ". Choose an isovalue in between.";
    throw InputError(s.str());
  }
}

/**
 * The power of two that scales the largest margin to 0.5 ... 1, so that floats hold all margins.
 */
double ScaleOf(const Census& census)
{
  int exponent = 0;
  std::frexp(census.LargestMargin, &exponent);
  return std::ldexp(1.0, std::clamp(-exponent, -1020, 1020));
}

/**
 * The margin as a float of the same sign; 0 and NaN are kept. Infinite margins become large ones.
 */
float ToFloat(double margin)
{
  constexpr double largest = 16.0; // finite margins are at most 1
  const double clamped = std::clamp(margin, -largest, largest);
  const auto result = static_cast<float>(std::isnan(margin) ? margin : clamped);
  return result == 0.0f && margin != 0.0
    ? std::copysign(std::numeric_limits<float>::min(), static_cast<float>(margin))
    : result;
}

/** Number of columns of a strip, which are smoothed together. */
constexpr std::size_t StripWidth = 64;

/** Memory for a strip, reused for the next strip. */
struct StripBuffers
{
  std::vector<float> In;
  std::vector<float> Out;
};

/**
 * Smooths `width` columns of n values each, in place. The values of a column are `stride` apart.
 * Beyond the ends of a column its outermost values are repeated, or, if it is periodic, what comes after the
 * other end; the last value of such a column is the first one again.
 */
void SmoothStrip(float* values, std::size_t n, std::size_t stride, std::size_t width,
  bool isPeriodic, const std::vector<float>& weights, StripBuffers& buffers)
{
  const std::size_t radius = weights.size() - 1;
  buffers.In.resize((n + 2 * radius) * width);
  for (std::size_t j = 0; j < n + 2 * radius; ++j)
  {
    const std::size_t from = isPeriodic ? (j + radius * (n - 2)) % (n - 1) // j - radius
                                        : std::clamp(j, radius, n - 1 + radius) - radius;
    std::copy_n(values + from * stride, width, buffers.In.data() + j * width);
  }
  buffers.Out.assign(n * width, 0.0f);
  for (std::size_t t = 0; t <= 2 * radius; ++t)
  {
    const float weight = weights[t < radius ? radius - t : t - radius];
    const float* in = buffers.In.data() + t * width;
    float* out = buffers.Out.data();
    for (std::size_t i = 0; i < n * width; ++i)
    {
      out[i] += weight * in[i];
    }
  }
  for (std::size_t j = 0; j < n; ++j)
  {
    std::copy_n(buffers.Out.data() + j * width, width, values + j * stride);
  }
}

/** Smooths along every axis, in place. @param isPeriodic along the last one */
template <int D>
void Smooth(std::vector<float>& values, const GridGeometry<D>& grid, double sigma, bool isPeriodic,
  unsigned threads, const std::stop_token& stop)
{
  std::vector<float> weights;
  for (const double w : NonShrinkingKernel(sigma, 0.0))
  {
    weights.push_back(static_cast<float>(w));
  }
  std::size_t stride = 1;
  for (std::size_t a = 0; a < D; ++a)
  {
    const auto n = static_cast<std::size_t>(grid.Dimensions[a]);
    const std::size_t strips = (stride + StripWidth - 1) / StripWidth; // of a block
    const std::size_t blocks = values.size() / (n * stride);
    ParallelFor(
      0, blocks * strips, std::max<std::size_t>(1, Grain / (n * std::min(stride, StripWidth))),
      threads,
      [&](std::size_t begin, std::size_t end)
      {
        StripBuffers buffers;
        for (std::size_t i = begin; i < end; ++i)
        {
          const std::size_t first = i % strips * StripWidth;
          SmoothStrip(values.data() + i / strips * n * stride + first, n, stride,
            std::min(StripWidth, stride - first), isPeriodic && a + 1 == D && n > 1, weights,
            buffers);
        }
      },
      stop);
    stride *= n;
  }
}

/** The smoothed margins. NaN counts as 0 in the smoothing, and is NaN again in the result. */
template <int D, typename Function>
std::vector<float> SmoothedMargins(const Function& read, const GridGeometry<D>& grid,
  std::size_t voxels, const Isosurface& surface, unsigned threads, const std::stop_token& stop)
{
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  std::vector<float> margins(voxels);
  std::vector<std::uint8_t> undefined(voxels);
  ParallelFor(
    0, voxels, Grain, threads,
    [&](std::size_t begin, std::size_t end)
    {
      read(begin, end - begin, margins.data() + begin);
      for (std::size_t i = begin; i < end; ++i)
      {
        undefined[i] = std::isnan(margins[i]);
        margins[i] = undefined[i] ? 0.0f : margins[i];
      }
    },
    stop);
  Smooth(margins, grid, surface.SmoothingSigma, D == 4 && surface.PeriodicInTime, threads, stop);
  ParallelFor(
    0, voxels, Grain, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        margins[i] = undefined[i] ? nan : margins[i];
      }
    },
    stop);
  return margins;
}

/** The smallest and the largest value that belong to these margins. */
std::array<double, 2> RangeOf(
  const std::vector<float>& margins, const Isosurface& surface, double scale)
{
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::array<double, 2> range{ infinity, -infinity };
  const double perMargin = (surface.Inside == IsosurfaceSide::Above ? 1.0 : -1.0) / scale;
  for (const float margin : margins)
  {
    if (!std::isnan(margin))
    {
      const double value = surface.Value + perMargin * static_cast<double>(margin);
      range = { std::min(range[0], value), std::max(range[1], value) };
    }
  }
  return range;
}

/** @throws InputError if the first and the last frame differ; what is not a number equals its like */
template <int D, typename T>
void CheckPeriod(std::span<const T> scalars, const GridGeometry<D>& grid)
{
  const std::size_t frame = scalars.size() / static_cast<std::size_t>(grid.Dimensions[D - 1]);
  const T* const last = scalars.data() + (scalars.size() - frame);
  std::size_t differ = 0;
  std::size_t example = 0;
  const auto isNoNumber = [](T x)
  {
    if constexpr (std::is_floating_point_v<T>)
    {
      return std::isnan(x);
    }
    return false;
  };
  for (std::size_t i = 0; i < frame; ++i)
  {
    const bool isSame = scalars[i] == last[i] || (isNoNumber(scalars[i]) && isNoNumber(last[i]));
    example = isSame || differ > 0 ? example : i;
    differ += isSame ? 0 : 1;
  }
  if (differ > 0)
  {
    std::string voxel;
    for (std::size_t a = 0; a + 1 < D; ++a)
    {
      const auto n = static_cast<std::size_t>(grid.Dimensions[a]);
      voxel += (a == 0 ? "" : ", ") + std::to_string(example % n);
      example /= n;
    }
    throw InputError(
      "a periodic mesh needs a last frame that is equal to the first one; they differ in " +
      std::to_string(differ) + " voxels, one of which is (" + voxel +
      "); if the series ends one frame before the period does, append its first frame");
  }
}

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
template <typename T>
IsosurfaceImage<D> IsosurfaceImage<D>::FromScalars(std::span<const T> scalars,
  const GridGeometry<D>& grid, const Isosurface& surface, unsigned threads,
  const std::stop_token& stop)
{
  CheckGrid(grid, scalars.size());
  CheckSurface(surface);
  const SurfaceMargin marginOf(surface);
  const Census census = TakeCensus(scalars, marginOf, threads, stop);
  IsosurfaceImage image;
  image.Which = surface;
  image.Values = { census.Min, census.Max };
  CheckRange(surface, image.Values, "");
  const double scale = ScaleOf(census);
  const bool isPeriodic = D == 4 && surface.PeriodicInTime;
  if (isPeriodic)
  {
    CheckPeriod(scalars, grid);
  }
  image.Read = [scalars, marginOf, scale](std::size_t first, std::size_t count, float* margins)
  {
    for (std::size_t i = 0; i < count; ++i)
    {
      margins[i] = ToFloat(scale * marginOf(scalars[first + i]));
    }
  };
  if (surface.SmoothingSigma > 0.0)
  {
    const auto smoothed = std::make_shared<const std::vector<float>>(
      SmoothedMargins<D>(image.Read, grid, scalars.size(), surface, threads, stop));
    image.Read = [smoothed](std::size_t first, std::size_t count, float* margins)
    { std::copy_n(smoothed->data() + first, count, margins); };
    image.Values = RangeOf(*smoothed, surface, scale);
    CheckRange(surface, image.Values, " after smoothing");
  }
  std::vector<unsigned char> mask(scalars.size());
  ParallelFor(
    0, scalars.size(), Grain, threads,
    [&](std::size_t begin, std::size_t end)
    {
      std::vector<float> margins(end - begin);
      image.Read(begin, end - begin, margins.data());
      for (std::size_t i = begin; i < end; ++i)
      {
        mask[i] = margins[i - begin] >= 0.0f; // not NaN
      }
    },
    stop);
  image.Inside = LabelImage<D>::template FromScalars<unsigned char>(mask, grid, {}, threads, stop);
  image.Inside.SetValue(1, surface.Label);
  if (isPeriodic)
  {
    image.Inside.MakePeriodicInTime();
  }
  return image;
}

template class IsosurfaceImage<3>;
template class IsosurfaceImage<4>;

#define VOXPLEX_INSTANTIATE(T)                                                                     \
  template IsosurfaceImage<3> IsosurfaceImage<3>::FromScalars<T>(std::span<const T>,               \
    const GridGeometry<3>&, const Isosurface&, unsigned, const std::stop_token&);                  \
  template IsosurfaceImage<4> IsosurfaceImage<4>::FromScalars<T>(std::span<const T>,               \
    const GridGeometry<4>&, const Isosurface&, unsigned, const std::stop_token&)
VOXPLEX_FOR_EACH_SCALAR_TYPE(VOXPLEX_INSTANTIATE);
#undef VOXPLEX_INSTANTIATE

} // namespace voxplex
