// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Image/FeatureTransform.h"

#include "Base/Error.h"
#include "Base/GridIndex.h"
#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>

namespace voxplex
{
namespace
{

/** Position of the last set bit at or below a position; -1 if there is none. */
std::int64_t SetBitBelow(std::span<const std::uint64_t> words, std::int64_t position)
{
  if (position < 0)
  {
    return -1;
  }
  auto w = static_cast<std::size_t>(position) / 64;
  std::uint64_t word = words[w] & (~std::uint64_t{ 0 } >> (63 - position % 64));
  while (word == 0)
  {
    if (w-- == 0)
    {
      return -1;
    }
    word = words[w];
  }
  return static_cast<std::int64_t>(w * 64) + 63 - std::countl_zero(word);
}

/** Position of the first set bit at or above a position; -1 if there is none. */
std::int64_t SetBitAbove(std::span<const std::uint64_t> words, std::int64_t position)
{
  auto w = static_cast<std::size_t>(position) / 64;
  if (w >= words.size())
  {
    return -1;
  }
  std::uint64_t word = words[w] & (~std::uint64_t{ 0 } << (position % 64));
  while (word == 0)
  {
    if (++w == words.size())
    {
      return -1;
    }
    word = words[w];
  }
  return static_cast<std::int64_t>(w * 64) + std::countr_zero(word);
}

} // namespace

/**
 * The lower envelope of the parabolas of one line: it keeps only parabolas that are the lowest
 * somewhere. Push() all parabolas from left to right. Then call LowestAt() from left to right.
 */
template <int D>
class FeatureTransform<D>::Envelope
{
public:
  struct Parabola
  {
    double Position;
    double Height; ///< squared distance along the axes of earlier passes
    std::uint32_t Site;
  };

  explicit Envelope(std::size_t capacity)
    : Stack(capacity)
  {
  }

  void Clear()
  {
    this->Size = 0;
    this->Lowest = 0;
  }
  bool IsEmpty() const { return this->Size == 0; }

  void Push(const Parabola& w)
  {
    Parabola* const stack = this->Stack.data();
    std::size_t size = this->Size;
    while (size >= 2 && Hidden(stack[size - 2], stack[size - 1], w))
    {
      --size;
    }
    stack[size] = w;
    this->Size = size + 1;
  }

  /** The lowest parabola at x, and its value. x must not decrease from call to call. */
  const Parabola& LowestAt(double x, double& value)
  {
    const Parabola* const stack = this->Stack.data();
    std::size_t k = this->Lowest;
    value = At(stack[k], x);
    for (; k + 1 < this->Size; ++k)
    {
      const double next = At(stack[k + 1], x);
      if (next >= value)
      {
        break;
      }
      value = next;
    }
    this->Lowest = k;
    return stack[k];
  }

private:
  /** Whether v is nowhere below both u and w. The positions are u < v < w (Maurer's RemoveFT). */
  static bool Hidden(const Parabola& u, const Parabola& v, const Parabola& w)
  {
    const double a = v.Position - u.Position;
    const double b = w.Position - v.Position;
    const double c = a + b;
    return c * v.Height - b * u.Height - a * w.Height - a * b * c > 0.0;
  }
  static double At(const Parabola& p, double x)
  {
    const double d = p.Position - x;
    return p.Height + d * d;
  }

  std::vector<Parabola> Stack;
  std::size_t Size = 0;
  std::size_t Lowest = 0;
};

template <int D>
FeatureTransform<D>::FeatureTransform(const BitMask<D>& sites, const Point<D>& spacing,
  const Array& stride, unsigned threads, const std::stop_token& stop)
  : CellStride(stride)
  , Spacing(spacing)
{
  double voxels = 1.0;
  for (std::size_t a = 0; a < D; ++a)
  {
    voxels *= static_cast<double>(sites.Dimensions()[a]);
    this->Voxels[a] = static_cast<std::uint32_t>(sites.Dimensions()[a]);
    this->Cells[a] = (this->Voxels[a] + stride[a] - 1) / stride[a];
    this->CentreOffset[a] = 0.5 * static_cast<double>(stride[a] - 1);
    this->InverseStride[a] = 1.0 / static_cast<double>(stride[a]);
  }
  if (voxels >= static_cast<double>(NoSite))
  {
    throw InputError("The foreground's bounding box has " +
      std::to_string(static_cast<std::uint64_t>(voxels)) +
      " voxels; at most 4294967294 are supported. Crop or resample the image.");
  }
  this->FirstPass(sites, threads, stop);
  for (std::size_t a = 1; a < D; ++a)
  {
    this->Pass(a, threads, stop);
  }
}

/** The pass along x: finds the nearest site in the same row, by words of 64 voxels. */
template <int D>
void FeatureTransform<D>::FirstPass(
  const BitMask<D>& sites, unsigned threads, const std::stop_token& stop)
{
  const std::size_t cells = this->Cells[0];
  this->Features.resize(sites.NumberOfRows() * cells);
  ParallelFor(
    0, sites.NumberOfRows(), 256, threads,
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t row = begin; row < end; ++row)
      {
        const std::span<const std::uint64_t> words = sites.Row(row);
        std::uint32_t* out = this->Features.data() + row * cells;
        std::int64_t below = -1;                    // last site at or below the centre
        std::int64_t above = SetBitAbove(words, 0); // first site above the centre
        for (std::size_t c = 0; c < cells; ++c)
        {
          const double centre = this->Centre(0, c);
          const auto floor = static_cast<std::int64_t>(centre);
          if (above >= 0 && above <= floor)
          {
            below = SetBitBelow(words, std::min<std::int64_t>(floor, this->Voxels[0] - 1));
            above = SetBitAbove(words, floor + 1);
          }
          const bool useBelow = above < 0 ||
            (below >= 0 &&
              centre - static_cast<double>(below) <= static_cast<double>(above) - centre);
          out[c] = static_cast<std::uint32_t>(useBelow ? below : above); // -1 becomes NoSite
        }
      }
    },
    stop);
}

/** Squared distance from a query to a site along the first `axes` axes. */
template <int D>
inline double FeatureTransform<D>::LowerDistance2(
  std::size_t axes, std::uint32_t site, const std::array<double, D>& query) const
{
  double sum = 0.0;
  for (std::size_t a = 0; a < axes; ++a)
  {
    const std::uint32_t q = a + 1 < axes ? site / this->Voxels[a] : 0;
    const double d =
      this->Spacing[a] * (static_cast<double>(site - q * this->Voxels[a]) - query[a]);
    sum += d * d;
    site = q;
  }
  return sum;
}

/** A pass along another axis. Earlier axes already have cells, later axes still have voxels. */
template <int D>
void FeatureTransform<D>::Pass(std::size_t axis, unsigned threads, const std::stop_token& stop)
{
  std::size_t inner = 1; // lines side by side
  std::uint32_t siteStride = 1;
  for (std::size_t a = 0; a < axis; ++a)
  {
    inner *= this->Cells[a];
    siteStride *= this->Voxels[a];
  }
  const std::size_t n = this->Voxels[axis];
  const std::size_t cells = this->Cells[axis];
  const std::size_t lines = this->Features.size() / n;
  const bool isLast = axis + 1 == D;
  UninitialisedVector<std::uint32_t> out(lines * cells);
  if (isLast)
  {
    this->Distances.resize(out.size());
  }
  ParallelFor(
    0, lines, std::max<std::size_t>(16, 32768 / n), threads,
    [&](std::size_t begin, std::size_t end)
    {
      Envelope envelope(n);
      std::array<double, D> query{};
      for (std::size_t line = begin; line < end; ++line)
      {
        const std::size_t outer = line / inner;
        const auto cell = IndexAt(line % inner, this->Cells);
        for (std::size_t a = 0; a < axis; ++a)
        {
          query[a] = this->Centre(a, cell[a]);
        }
        const std::uint32_t* in = this->Features.data() + outer * n * inner + line % inner;
        envelope.Clear();
        for (std::size_t i = 0; i < n; ++i)
        {
          const std::uint32_t site = in[i * inner];
          if (site != NoSite)
          {
            envelope.Push({ this->Spacing[axis] * static_cast<double>(i),
              this->LowerDistance2(axis, site, query),
              site + static_cast<std::uint32_t>(i) * siteStride });
          }
        }
        const std::size_t first = outer * cells * inner + line % inner;
        for (std::size_t c = 0; c < cells; ++c)
        {
          std::uint32_t site = NoSite;
          double distance2 = std::numeric_limits<double>::infinity();
          if (!envelope.IsEmpty())
          {
            site = envelope.LowestAt(this->Spacing[axis] * this->Centre(axis, c), distance2).Site;
          }
          out[first + c * inner] = site;
          if (isLast)
          {
            this->Distances[first + c * inner] = static_cast<float>(std::sqrt(distance2));
          }
        }
      }
    },
    stop);
  this->Features.swap(out);
}

template class FeatureTransform<3>;
template class FeatureTransform<4>;

} // namespace voxplex
