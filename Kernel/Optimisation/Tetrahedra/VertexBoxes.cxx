// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "Optimisation/Tetrahedra/VertexBoxes.h"

#include "Parallel/ParallelFor.h"

#include <algorithm>
#include <array>

namespace voxplex
{

namespace
{

constexpr std::size_t Grain = 16384;

/** Tells between which planes across an axis a vertex is. */
class AxisDivision
{
public:
  /** @param shift 0.5 if planes lie half a box further, or 0 */
  void Divide(std::span<const Point<3>> points, std::size_t axis, std::size_t perAxis, double shift)
  {
    const auto [low, high] = std::minmax_element(points.begin(), points.end(),
      [axis](const Point<3>& a, const Point<3>& b) { return a[axis] < b[axis]; });
    const double length = (*high)[axis] - (*low)[axis];
    this->Axis = axis;
    this->Low = (*low)[axis];
    this->Scale = length > 0.0 ? static_cast<double>(Bins - 1) / length : 0.0;

    std::array<std::size_t, Bins> counts{};
    for (const Point<3>& p : points)
    {
      ++counts[this->BinOf(p)];
    }
    const double boxesPerPoint = static_cast<double>(perAxis) / static_cast<double>(points.size());
    std::size_t before = 0;
    for (std::size_t bin = 0; bin < Bins; ++bin)
    {
      // Bins after the last vertex are not used.
      this->Boxes[bin] =
        static_cast<std::uint32_t>(static_cast<double>(before) * boxesPerPoint + shift);
      before += counts[bin];
    }
  }

  std::uint32_t operator()(const Point<3>& p) const { return this->Boxes[this->BinOf(p)]; }

private:
  static constexpr std::size_t Bins = 4096;

  std::size_t BinOf(const Point<3>& p) const
  {
    return static_cast<std::size_t>((p[this->Axis] - this->Low) * this->Scale);
  }

  std::size_t Axis = 0;
  double Low = 0.0;
  double Scale = 0.0; ///< from lengths to bins
  std::array<std::uint32_t, Bins> Boxes{};
};

} // namespace

//------------------------------------------------------------------------------------------------
VertexBoxes DivideIntoBoxes(std::span<const Point<3>> points, std::size_t perAxis, bool shift,
  unsigned threads, const std::stop_token& stop)
{
  const std::size_t n = perAxis + (shift ? 1 : 0);
  VertexBoxes boxes{ n * n * n, std::vector<std::uint32_t>(points.size()) };
  if (points.empty())
  {
    return boxes;
  }
  std::array<AxisDivision, 3> axes;
  ParallelFor(
    0, 3, 1, threads,
    [&](std::size_t axis, std::size_t)
    { axes[axis].Divide(points, axis, perAxis, shift ? 0.5 : 0.0); },
    stop);
  ParallelFor(
    0, points.size(), Grain, threads,
    [&](std::size_t first, std::size_t last)
    {
      const auto side = static_cast<std::uint32_t>(n);
      for (std::size_t v = first; v < last; ++v)
      {
        const Point<3>& p = points[v];
        boxes.OfVertex[v] = axes[0](p) + side * (axes[1](p) + side * axes[2](p));
      }
    },
    stop);
  return boxes;
}

} // namespace voxplex
