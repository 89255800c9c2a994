// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Image/VolumeBalance.h"

#include "Base/VectorClones.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace voxplex
{

namespace
{

constexpr std::size_t Tile = 8;

/** The mean of the interpolation over a voxel is a product of this kernel along the axes. */
constexpr std::array<float, 2> MeanOfVoxel = { 0.75f, 0.125f };

/**
 * Integral of 1 - (2 V - 1)^2 across a plane interface, voxels. V falls from 1 to 0 over one voxel.
 */
constexpr float AreaOfPlane = 2.0f / 3.0f;

/** Less area around a sample counts as this much. A plane through the sample has 0.27. */
constexpr float LeastArea = 0.05f;

/** Moves are a little longer than the volume asks for, because samples far from 0 do not move. */
constexpr float Lengthening = 1.15f;

/** Longest move, voxels. With 0.5, parts that are about a voxel thick become rough, and refinement of a tube that
 * opens took many times the work that it needs. */
constexpr float LongestMove = 0.16f;

/** Samples move by the whole distance if they are at least 1 / FullMove away from 1 and -1. */
constexpr float FullMove = 4.0f;

/** The number of samples along each axis. */
using Extent = std::array<std::size_t, 4>;

std::size_t SizeOf(const Extent& n)
{
  return n[0] * n[1] * n[2] * n[3];
}

/** Adds weight (below + above), or sets weight below if `above` is null. */
VOXPLEX_VECTOR_CLONES
void AddWeighted(
  float weight, const float* below, const float* above, std::size_t n, float* __restrict to)
{
  if (!above)
  {
    for (std::size_t i = 0; i < n; ++i)
    {
      to[i] = weight * below[i];
    }
    return;
  }
  for (std::size_t i = 0; i < n; ++i)
  {
    to[i] += weight * (below[i] + above[i]);
  }
}

/**
 * Filters along one axis by a symmetric kernel. The result is shorter by its radius on both sides. Along x it keeps
 * its length, and what is nearer to an end of a row than the radius has no meaning: rows are too short to be
 * treated one by one.
 */
void Filter(
  const float* in, Extent& n, std::size_t axis, std::span<const float> weights, float* out)
{
  const std::size_t radius = weights.size() - 1;
  std::size_t stride = 1;
  for (std::size_t a = 0; a < axis; ++a)
  {
    stride *= n[a];
  }
  const std::size_t all = SizeOf(n);
  const std::size_t block = axis == 0 ? all : n[axis] * stride;
  const std::size_t length = block - 2 * radius * stride; // the results of a block
  const std::size_t made = axis == 0 ? all : length;
  for (std::size_t k = 0; k < all / block; ++k)
  {
    const float* const middle = in + k * block + radius * stride;
    float* const to = out + k * made + (axis == 0 ? radius : 0);
    AddWeighted(weights[0], middle, nullptr, length, to);
    for (std::size_t r = 1; r <= radius; ++r)
    {
      AddWeighted(weights[r], middle - r * stride, middle + r * stride, length, to);
    }
  }
  if (axis == 0)
  {
    std::fill_n(out, radius, 0.0f);
    std::fill_n(out + all - radius, radius, 0.0f);
    return;
  }
  n[axis] -= 2 * radius;
}

/** Filters along all axes, the slowest first. The result is in `values`. */
void FilterAll(
  std::vector<float>& values, Extent n, std::span<const float> weights, std::vector<float>& other)
{
  for (std::size_t axis = 4; axis-- > 0;)
  {
    Filter(values.data(), n, axis, weights, other.data());
    values.swap(other);
  }
}

/**
 * Excess and area of voxels in a row.
 * @param excess holds means of samples over voxels, and receives the excess
 */
VOXPLEX_VECTOR_CLONES
void MeasureVoxels(const float* __restrict margins, float perFilling, std::size_t n,
  float* __restrict excess, float* __restrict area)
{
  for (std::size_t i = 0; i < n; ++i)
  {
    const float filling = std::clamp(excess[i] * perFilling, -1.0f, 1.0f); // 2 V - 1
    excess[i] = 0.5f * (filling - (margins[i] > 0.0f ? 1.0f : -1.0f));
    area[i] = 1.0f - filling * filling;
  }
}

/** What is to be subtracted from 8 samples in a row. */
VOXPLEX_VECTOR_CLONES
void FindShifts(const float* __restrict margins, float slope, const float* __restrict excess,
  const float* __restrict area, float* __restrict shifts)
{
  for (std::size_t i = 0; i < Tile; ++i)
  {
    const float move = Lengthening * AreaOfPlane * excess[i] / std::max(area[i], LeastArea);
    const float share = std::clamp(FullMove * (1.0f - std::abs(margins[i])), 0.0f, 1.0f);
    shifts[i] = share * slope * std::clamp(move, -LongestMove, LongestMove);
  }
}

} // namespace

//------------------------------------------------------------------------------------------------
VolumeBalance::VolumeBalance(double sigma, const std::vector<double>& kernel)
{
  const auto radius = static_cast<std::size_t>(std::ceil(2.0 * sigma));
  double sum = 0.0;
  for (std::size_t t = 0; t <= radius; ++t)
  {
    const double x = static_cast<double>(t) / sigma;
    this->Spread.push_back(static_cast<float>(std::exp(-0.5 * x * x)));
    sum += (t == 0 ? 1.0 : 2.0) * static_cast<double>(this->Spread.back());
  }
  for (float& weight : this->Spread)
  {
    weight = static_cast<float>(weight / sum);
  }
  // Half a voxel away from a plane, samples are kernel[0], and their means over voxels are:
  const double next = kernel.size() > 1 ? kernel[1] : 0.0;
  const double mean = (1.0 - 2.0 * MeanOfVoxel[1]) * kernel[0] + 2.0 * MeanOfVoxel[1] * next;
  this->Slope = static_cast<float>(2.0 * kernel[0]);
  this->PerFilling = static_cast<float>(1.0 / mean);
}

//------------------------------------------------------------------------------------------------
void VolumeBalance::Find(const float* margins, Buffers& buffers, float* shifts) const
{
  const std::size_t width = Tile + 2 * this->Radius();
  const Extent whole = { width, width, width, width };
  const std::size_t inner = width - 2;
  const Extent within = { width, inner, inner, inner }; // see Filter() for the rows
  auto& [excess, area, other] = buffers;
  excess.assign(margins, margins + SizeOf(whole));
  other.resize(SizeOf(whole));
  FilterAll(excess, whole, MeanOfVoxel, other);

  area.resize(SizeOf(whole));
  for (std::size_t row = 0; row < inner * inner * inner; ++row)
  {
    const std::size_t y = row % inner + 1;
    const std::size_t z = row / inner % inner + 1;
    const std::size_t t = row / inner / inner + 1;
    MeasureVoxels(margins + ((t * width + z) * width + y) * width, this->PerFilling, width,
      excess.data() + row * width, area.data() + row * width);
  }
  other.resize(SizeOf(whole));
  FilterAll(excess, within, this->Spread, other);
  FilterAll(area, within, this->Spread, other);

  const std::size_t r = this->Radius();
  for (std::size_t row = 0; row < Tile * Tile * Tile; ++row)
  {
    const std::size_t y = row % Tile + r;
    const std::size_t z = row / Tile % Tile + r;
    const std::size_t t = row / Tile / Tile + r;
    FindShifts(margins + ((t * width + z) * width + y) * width + r, this->Slope,
      excess.data() + row * width + r, area.data() + row * width + r, shifts + row * Tile);
  }
}

} // namespace voxplex
