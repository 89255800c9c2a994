// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Mesher/MeshSizeEstimate.h"

#include "Base/Error.h"
#include "Base/GridIndex.h"
#include "Base/NumberText.h"
#include "Base/PageMemory.h"
#include "Base/VectorClones.h"
#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

namespace voxplex
{

namespace
{

/** Calibrated on the phantoms and atlases of Documentation/Benchmarks.md. */
template <int D>
struct Calibration;

template <>
struct Calibration<3>
{
  static constexpr double VerticesPerArea =
    0.65; ///< interface vertices per delta^(D-1) of interface
  static constexpr double ElementsPerInterfaceVertex = 4.7;
  static constexpr double ElementsPerBall = 5.0;    ///< elements per size^D of volume
  static constexpr double VerticesPerElement = 0.3; ///< vertices of the whole triangulation
  static constexpr double BytesPerElement = 400.0;  ///< triangulation, output and its copy
  /** The area of an interface without a preferred direction, over the area of its stairs. */
  static constexpr double AreaPerStairs = 2.0 / 3.0;
};

template <>
struct Calibration<4>
{
  static constexpr double VerticesPerArea = 0.57;
  static constexpr double ElementsPerInterfaceVertex = 14.0;
  static constexpr double ElementsPerBall = 25.0;
  static constexpr double VerticesPerElement = 0.09;
  static constexpr double BytesPerElement = 450.0;
  static constexpr double AreaPerStairs = 0.589; // 3 pi / 16
};

/** The number of places where two rows of ids differ. */
VOXPLEX_VECTOR_CLONES std::uint64_t CountDifferent(
  const LabelId* a, const LabelId* b, std::size_t length)
{
  std::uint32_t sum = 0; // as wide as an id, so the loop is vectorised
  for (std::size_t i = 0; i < length; ++i)
  {
    sum += a[i] != b[i] ? 1u : 0u;
  }
  return sum;
}

/**
 * Counts voxel faces between different labels, by axis. Background closes the crop, except at flat
 * ends.
 */
template <int D>
std::array<std::uint64_t, static_cast<std::size_t>(D)> CountInterfaceFaces(
  const LabelImage<D>& image, unsigned threads, const std::stop_token& stop)
{
  const auto& n = image.CropDimensions();
  const std::span<const LabelId> ids = image.Ids();
  const std::size_t row = static_cast<std::size_t>(n[0]);
  const std::size_t rows = ids.size() / row;
  const std::vector<LabelId> background(row, LabelId{ 0 });
  std::array<std::atomic<std::uint64_t>, static_cast<std::size_t>(D)> faces{};
  ParallelFor(
    0, rows, 256, threads,
    [&](std::size_t first, std::size_t last)
    {
      std::array<std::uint64_t, static_cast<std::size_t>(D)> count{};
      for (std::size_t r = first; r < last; ++r)
      {
        const LabelId* voxels = ids.data() + r * row;
        count[0] += (voxels[0] != 0) + (voxels[row - 1] != 0);
        count[0] += CountDifferent(voxels + 1, voxels, row - 1);
        const auto index = IndexAt(r * row, n);
        std::size_t stride = row;
        for (std::size_t a = 1; a < D; ++a)
        {
          const bool time = D == 4 && a == 3;
          if (!(time && index[a] == 0 && image.ReachesBorderInTime(0)))
          {
            count[a] +=
              CountDifferent(voxels, index[a] == 0 ? background.data() : voxels - stride, row);
          }
          if (index[a] + 1 == n[a] && !(time && image.ReachesBorderInTime(1)))
          {
            count[a] += CountDifferent(voxels, background.data(), row);
          }
          stride *= static_cast<std::size_t>(n[a]);
        }
      }
      for (std::size_t a = 0; a < D; ++a)
      {
        faces[a] += count[a];
      }
    },
    stop);
  std::array<std::uint64_t, static_cast<std::size_t>(D)> result;
  for (std::size_t a = 0; a < D; ++a)
  {
    result[a] = faces[a];
  }
  return result;
}

/** The sum over a range of samples. */
struct BallCount
{
  double Sum = 0.0; ///< of 1 / size^D
  double Smallest = std::numeric_limits<double>::infinity();
};

/** Adds one voxel of the crop, unless it is background. */
template <int D>
void CountBalls(const LabelImage<D>& image, const SizeFunction<D>& size, double floor,
  std::size_t voxel, BallCount& count)
{
  const LabelId id = image.Ids()[voxel];
  if (id == 0)
  {
    return;
  }
  const Point<D> p = image.CentreOf(IndexAt(voxel, image.CropDimensions()));
  const double s = size.Evaluate(p, image.Values()[id]);
  if (s > 0.0 && std::isfinite(s))
  {
    count.Smallest = std::min(count.Smallest, s);
    count.Sum += std::pow(std::max(s, floor), -D);
  }
}

/** The sum of volume / size^D over the object, sampled at about ten thousand voxels. */
template <int D>
double BallsInObject(const LabelImage<D>& image, const SizeFunction<D>& size, double floor,
  double& smallest, unsigned threads, const std::stop_token& stop)
{
  constexpr std::size_t grain = 512; // fixed, so that the sum does not depend on threads
  const std::size_t voxels = image.Ids().size();
  const std::size_t step = std::max<std::size_t>(1, voxels / 50000);
  const std::size_t samples = (voxels - step / 2 + step - 1) / step;
  std::vector<BallCount> chunks((samples + grain - 1) / grain);
  ParallelFor(
    0, samples, grain, threads,
    [&](std::size_t first, std::size_t last)
    {
      BallCount count;
      for (std::size_t k = first; k < last; ++k)
      {
        CountBalls(image, size, floor, step / 2 + k * step, count);
      }
      chunks[first / grain] = count;
    },
    stop);
  double sum = 0.0;
  for (const BallCount& chunk : chunks)
  {
    sum += chunk.Sum;
    smallest = std::min(smallest, chunk.Smallest);
  }
  return sum * static_cast<double>(step) * image.Grid().VoxelVolume();
}

std::string InUnits(double bytes)
{
  char text[32];
  std::snprintf(text, sizeof(text), "%.1f GiB", bytes / (1024.0 * 1024.0 * 1024.0));
  return text;
}

std::uint64_t Saturate(double x)
{
  return x < 1.8e19 ? static_cast<std::uint64_t>(x) : ~std::uint64_t(0);
}

} // namespace

//------------------------------------------------------------------------------------------------
template <int D>
MeshSizeEstimate EstimateMeshSize(const LabelImage<D>& image, double delta, double sizeFloor,
  const SizeFunction<D>* size, unsigned threads, const std::stop_token& stop)
{
  const auto faces = CountInterfaceFaces(image, threads, stop);
  double area = 0.0;
  for (std::size_t a = 0; a < D; ++a)
  {
    area += static_cast<double>(faces[a]) * image.Grid().VoxelVolume() /
      image.Grid().Spacing(static_cast<int>(a));
  }
  using Constants = Calibration<D>;
  area *= Constants::AreaPerStairs;
  const double interfaceVertices = Constants::VerticesPerArea * area / std::pow(delta, D - 1);
  double elements = Constants::ElementsPerInterfaceVertex * interfaceVertices;
  MeshSizeEstimate estimate;
  if (size)
  {
    // Where sizes are small, they determine the sampling of the interface, and this sum includes
    // its elements.
    elements += Constants::ElementsPerBall *
      BallsInObject(image, *size, sizeFloor, estimate.SmallestSize, threads, stop);
    estimate.SizesBelowFloor = estimate.SmallestSize < sizeFloor;
  }
  estimate.InterfaceVertices = Saturate(interfaceVertices);
  estimate.InterfaceElements = Saturate(Constants::ElementsPerInterfaceVertex * interfaceVertices);
  estimate.Elements = Saturate(elements);
  estimate.Vertices = Saturate(elements * Constants::VerticesPerElement) + 64;
  estimate.Bytes = Saturate(elements * Constants::BytesPerElement);
  return estimate;
}

//------------------------------------------------------------------------------------------------
void CheckMemory(const MeshSizeEstimate& estimate, std::uint64_t limit)
{
  const auto available = static_cast<double>(limit == 0 ? PhysicalMemory() : limit);
  const double bytes = static_cast<double>(estimate.Bytes);
  constexpr std::uint64_t MostElements = 1u << 31; // half of all ids; some ids are free
  if (bytes > available || estimate.Elements > MostElements)
  {
    throw TooLargeError("the mesh is estimated to have " +
      NumberText(static_cast<double>(estimate.Elements), 3) + " elements and to need " +
      InUnits(bytes) + " of memory; " + InUnits(available) +
      " are available; choose a larger delta or element size, or go on with {force}");
  }
}

template MeshSizeEstimate EstimateMeshSize<3>(
  const LabelImage<3>&, double, double, const SizeFunction<3>*, unsigned, const std::stop_token&);
template MeshSizeEstimate EstimateMeshSize<4>(
  const LabelImage<4>&, double, double, const SizeFunction<4>*, unsigned, const std::stop_token&);

} // namespace voxplex
