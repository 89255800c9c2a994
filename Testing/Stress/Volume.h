// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Volume.h
 * @brief An image of labels or grey values, independent of the kernel.
 */
#ifndef voxplex_stress_Volume_h
#define voxplex_stress_Volume_h

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace voxplex::stress
{

/** The isosurface of grey values that bounds the object. */
struct GreySurface
{
  double Value = 0.0;
  bool InsideIsAbove = true;
  double SmoothingSigma = 0.0;
  std::int64_t Label = 1;
};

/**
 * Voxels; the first axis varies fastest. The point of index i is Axes x i. Axes is upper triangular
 * with a positive diagonal.
 */
template <int D>
struct Volume
{
  static constexpr std::size_t N = static_cast<std::size_t>(D);
  using Index = std::array<std::int64_t, N>;
  using Vector = std::array<double, N>;

  Index Dimensions{};
  std::array<Vector, N> Axes{};     ///< rows
  std::vector<std::int32_t> Labels; ///< 0 is background; for grey values, labels mark the inside
  std::vector<float> Grey;          ///< empty for images of labels
  std::optional<GreySurface> Surface;

  std::size_t Size() const
  {
    std::size_t size = 1;
    for (const std::int64_t n : this->Dimensions)
    {
      size *= static_cast<std::size_t>(n);
    }
    return size;
  }

  bool Contains(const Index& voxel) const
  {
    for (std::size_t a = 0; a < N; ++a)
    {
      if (voxel[a] < 0 || voxel[a] >= this->Dimensions[a])
      {
        return false;
      }
    }
    return true;
  }

  std::size_t At(const Index& voxel) const
  {
    std::int64_t at = 0;
    for (std::size_t a = N; a-- > 0;)
    {
      at = at * this->Dimensions[a] + voxel[a];
    }
    return static_cast<std::size_t>(at);
  }

  /** The label of a voxel; 0 beyond the image. */
  std::int32_t LabelAt(const Index& voxel) const
  {
    return this->Contains(voxel) ? this->Labels[this->At(voxel)] : 0;
  }

  Vector ToPoint(const Vector& index) const
  {
    Vector point{};
    for (std::size_t r = 0; r < N; ++r)
    {
      for (std::size_t c = r; c < N; ++c)
      {
        point[r] += this->Axes[r][c] * index[c];
      }
    }
    return point;
  }

  Vector ToIndex(const Vector& point) const
  {
    Vector index{};
    for (std::size_t k = N; k-- > 0;)
    {
      double rest = point[k];
      for (std::size_t c = k + 1; c < N; ++c)
      {
        rest -= this->Axes[k][c] * index[c];
      }
      index[k] = rest / this->Axes[k][k];
    }
    return index;
  }

  double VoxelVolume() const
  {
    double volume = 1.0;
    for (std::size_t a = 0; a < N; ++a)
    {
      volume *= this->Axes[a][a];
    }
    return volume;
  }

  /** The length of a step along an axis. */
  double Spacing(std::size_t axis) const
  {
    double sum = 0.0;
    for (std::size_t r = 0; r <= axis; ++r)
    {
      sum += this->Axes[r][axis] * this->Axes[r][axis];
    }
    return std::sqrt(sum);
  }

  double LargestSpacing() const
  {
    double largest = 0.0;
    for (std::size_t a = 0; a < N; ++a)
    {
      largest = std::max(largest, this->Spacing(a));
    }
    return largest;
  }

  /**
   * The distance between adjacent layers of voxels across an axis. If axes are oblique, it is not
   * the spacing.
   */
  double LayerDistance(std::size_t axis) const
  {
    Vector gradient{};
    for (std::size_t a = 0; a < N; ++a)
    {
      Vector unit{};
      unit[a] = 1.0;
      gradient[a] = this->ToIndex(unit)[axis];
    }
    double sum = 0.0;
    for (const double g : gradient)
    {
      sum += g * g;
    }
    return 1.0 / std::sqrt(sum);
  }

  /** The area of the face of a voxel across an axis. */
  double FaceArea(std::size_t axis) const
  {
    return this->VoxelVolume() / this->LayerDistance(axis);
  }

  /** The label values that occur, sorted, without background. */
  std::vector<std::int32_t> LabelValues() const
  {
    std::vector<std::int32_t> values(this->Labels);
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
    values.erase(std::remove(values.begin(), values.end(), 0), values.end());
    return values;
  }

  /** Calls f(voxel, number) for each voxel. */
  template <typename Function>
  void ForEach(Function f) const
  {
    Index voxel{};
    for (std::size_t i = 0, size = this->Size(); i < size; ++i)
    {
      f(voxel, i);
      for (std::size_t a = 0; a < N && ++voxel[a] == this->Dimensions[a]; ++a)
      {
        voxel[a] = 0;
      }
    }
  }
};

} // namespace voxplex::stress

#endif
