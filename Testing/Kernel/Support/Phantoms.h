// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
// Label images of known shapes.
#ifndef voxplex_Phantoms_h
#define voxplex_Phantoms_h

#include "Base/GridIndex.h"
#include "Image/LabelImage.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <random>
#include <vector>

namespace voxplex::phantoms
{

/** The value that a function gives the centre of each voxel. */
template <typename T, int D, typename Function>
std::vector<T> Sample(const GridGeometry<D>& grid, Function&& value)
{
  std::vector<T> values(CountCells(grid.Dimensions));
  for (std::size_t k = 0; k < values.size(); ++k)
  {
    const auto index = IndexAt(k, grid.Dimensions);
    Point<D> at;
    std::copy(index.begin(), index.end(), at.begin());
    values[k] = static_cast<T>(value(grid.ToFrame(at)));
  }
  return values;
}

/** A label image whose voxels have the label that a function gives their centre. */
inline LabelImage<3> Make(const GridGeometry<3>& grid,
  const std::function<std::int16_t(const Point<3>&)>& label, const LabelSelection& selection = {})
{
  return LabelImage<3>::FromScalars<std::int16_t>(
    Sample<std::int16_t>(grid, label), grid, selection);
}

/** A label image whose voxels have the label that a function gives their index. */
template <int D, typename Function>
LabelImage<D> OfVoxels(const GridGeometry<D>& grid, Function&& label)
{
  std::vector<std::uint8_t> labels(CountCells(grid.Dimensions));
  for (std::size_t k = 0; k < labels.size(); ++k)
  {
    labels[k] = static_cast<std::uint8_t>(label(IndexAt(k, grid.Dimensions)));
  }
  return LabelImage<D>::template FromScalars<std::uint8_t>(labels, grid);
}

/** Independent voxels with `labels` labels and background, all equally likely. */
template <int D>
LabelImage<D> Noise(const GridGeometry<D>& grid, unsigned seed, unsigned labels)
{
  std::mt19937 random(seed);
  return OfVoxels(grid, [&](const auto&) { return random() % (labels + 1); });
}

inline GridGeometry<3> Cube(std::int64_t n, double spacing = 1.0)
{
  return GridGeometry<3>::Orthogonal({ n, n, n }, { spacing, spacing, spacing });
}

/** Cubes with sides of `side` voxels, each with a label of its own. */
inline LabelImage<3> Blocks(std::int64_t side, std::int64_t along)
{
  const GridGeometry<3> grid = Cube(side * along);
  const std::vector<std::int32_t> labels = Sample<std::int32_t>(grid,
    [=](const Point<3>& p)
    {
      const auto block = [=](double x) { return static_cast<std::int64_t>(x) / side; };
      return static_cast<std::int32_t>(
        1 + (block(p[2]) * along + block(p[1])) * along + block(p[0]));
    });
  return LabelImage<3>::FromScalars<std::int32_t>(labels, grid);
}

/** Its axes meet at angles that are the more acute the larger `shear` is, in all three pairs of them. */
inline GridGeometry<3> Sheared(const GridGeometry<3>::Index& dimensions, double shear)
{
  GridGeometry<3> grid = GridGeometry<3>::Orthogonal(dimensions, { 0.7, 1.0, 1.3 });
  grid.IndexToFrame[0][1] = 0.3 * shear;
  grid.IndexToFrame[0][2] = -0.2 * shear;
  grid.IndexToFrame[1][2] = 0.4 * shear;
  return grid;
}

/** All voxels have label 1. */
inline LabelImage<3> Block(const GridGeometry<3>& grid)
{
  return Make(grid, [](const Point<3>&) { return std::int16_t{ 1 }; });
}

inline LabelImage<3> Ball(double radius, double spacing = 1.0)
{
  const std::int64_t n = static_cast<std::int64_t>(2 * radius / spacing) + 8;
  const double c = 0.5 * spacing * static_cast<double>(n - 1);
  return Make(Cube(n, spacing),
    [=](const Point<3>& p) -> std::int16_t {
      return Distance(p, { c, c, c }) < radius ? 1 : 0;
    });
}

inline LabelImage<3> Torus(double major, double minor)
{
  const std::int64_t n = static_cast<std::int64_t>(2 * (major + minor)) + 8;
  const double c = 0.5 * static_cast<double>(n - 1);
  return Make(Cube(n),
    [=](const Point<3>& p) -> std::int16_t
    {
      const double ring = std::hypot(p[0] - c, p[1] - c) - major;
      return std::hypot(ring, p[2] - c) < minor ? 1 : 0;
    });
}

/** Label 3 inside, 7 around it, 200 outermost. */
inline LabelImage<3> NestedBalls(double radius)
{
  const std::int64_t n = static_cast<std::int64_t>(2 * radius) + 8;
  const double c = 0.5 * static_cast<double>(n - 1);
  return Make(Cube(n),
    [=](const Point<3>& p) -> std::int16_t
    {
      const double r = Distance(p, { c, c, c });
      return r < radius / 3 ? 3 : r < 2 * radius / 3 ? 7 : r < radius ? 200 : 0;
    });
}

/** A box of two labels that touch in a plane; three regions meet along its rim. */
inline LabelImage<3> TouchingLabels(std::int64_t side)
{
  const std::int64_t n = side + 8;
  const double low = 3.5;
  const double high = low + static_cast<double>(side);
  return Make(Cube(n),
    [=](const Point<3>& p) -> std::int16_t
    {
      for (const double x : p)
      {
        if (x < low || x > high)
        {
          return 0;
        }
      }
      return p[0] < 0.5 * (low + high) ? 1 : 2;
    });
}

/** A square sheet one voxel thick. */
inline LabelImage<3> Sheet(std::int64_t side)
{
  const std::int64_t n = side + 8;
  return Make(Cube(n),
    [=](const Point<3>& p) -> std::int16_t
    {
      const auto within = [=](double x) { return x >= 4 && x < static_cast<double>(side + 4); };
      return within(p[0]) && within(p[1]) && p[2] == std::floor(static_cast<double>(n) / 2) ? 1 : 0;
    });
}

/**
 * Cells around random points that fill an image of 28 voxels a side, so that its border cuts them. The cells have
 * `labels` labels from `first` on, in turn.
 */
inline LabelImage<3> CutCells(unsigned seed, std::size_t cells, std::size_t labels, int first)
{
  std::mt19937 random(seed);
  std::vector<Point<3>> points(cells);
  for (Point<3>& p : points)
  {
    p = { 0.1 * (random() % 280), 0.1 * (random() % 280), 0.1 * (random() % 280) };
  }
  return Make(Cube(28),
    [&](const Point<3>& p) -> std::int16_t
    {
      std::size_t nearest = 0;
      for (std::size_t k = 1; k < cells; ++k)
      {
        nearest = Distance(p, points[k]) < Distance(p, points[nearest]) ? k : nearest;
      }
      return static_cast<std::int16_t>(static_cast<std::size_t>(first) + nearest % labels);
    });
}

/** Half a ball: the image's border cuts it through the centre. */
inline LabelImage<3> CutBall(std::int64_t radius)
{
  const std::int64_t n = 2 * radius + 8;
  const double c = 0.5 * static_cast<double>(n - 1);
  return Make(GridGeometry<3>::Orthogonal({ n, n, radius }, { 1.0, 1.0, 1.0 }),
    [=](const Point<3>& p) -> std::int16_t {
      return Distance(p, { c, c, 0.0 }) < static_cast<double>(radius) - 2.5 ? 1 : 0;
    });
}

/** Sheared axes; n, n - 3 and n - 6 voxels. */
inline GridGeometry<3> ObliqueGrid(std::int64_t n)
{
  return Sheared({ n, n - 3, n - 6 }, 1.0);
}

/**
 * A ball in two halves, 1 and 2, cut by two borders that meet in it.
 * @param middle in voxels
 * @param normal of the plane between the halves; 1 is where r . normal > offset, with r from the middle
 */
inline LabelImage<3> CutHalves(const GridGeometry<3>& grid,
  const Point<3>& middle = { 6.3, 15.1, 5.7 }, double radius = 11.0,
  const Point<3>& normal = { 1.0, 0.6, -0.3 }, double offset = 2.0)
{
  const Point<3> centre = grid.ToFrame(middle);
  return Make(grid,
    [=](const Point<3>& p) -> std::int16_t
    {
      if (!(Distance(p, centre) < radius))
      {
        return 0;
      }
      return Dot(Subtract(p, centre), normal) > offset ? 1 : 2;
    });
}

} // namespace voxplex::phantoms

#endif
