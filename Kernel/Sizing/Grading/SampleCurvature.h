// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SampleCurvature.h
 * @brief How strongly a surface bends that is known by points of it.
 */
#ifndef voxplex_SampleCurvature_h
#define voxplex_SampleCurvature_h

#include "Geometry/Box.h"
#include "Image/LabelImage.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace voxplex
{

/**
 * @brief The curvature of a sampled surface around its points, seen at any scale.
 *
 * Points spread evenly over the part of a sphere with curvature k that is within a small distance r of one of its points are
 * k r^2 / sqrt(48) off the plane that fits them best, root mean square, and the other two eigenvalues of their
 * covariance are r^2 / 4. So the eigenvalues give the curvature whatever the spread of the points, and without normals,
 * which the stairs of voxels would spoil.
 *
 * Larger neighbourhoods are judged by a pseudo-random part of the points, so that a query takes about the same time
 * whatever their size. Queries may run in any number of threads.
 */
class SampleCurvature
{
public:
  using Labels = std::array<LabelId, 2>;

  /**
   * Linear in the number of points.
   * @param points of one surface or more; not none
   * @param labels of each point: those with other labels belong to another surface
   * @param spacing about how far apart neighbours are, > 0
   * @throws std::bad_alloc
   */
  SampleCurvature(
    const std::vector<Point<3>>& points, const std::vector<Labels>& labels, double spacing);

  /**
   * The curvature of a sphere that is as far off a plane as the points with these labels within `radius` of p are; of a
   * cylinder 0.87 times one over its radius, of a saddle 1.41 times its curvatures. 0 if there are too few points.
   * @param roughness of the surface, root mean square: being so far off a plane is no bend
   */
  double At(const Point<3>& p, const Labels& labels, double radius, double roughness) const;

private:
  struct Member
  {
    Point<3> Position;
    Labels Of;
  };

  /** A part of the points, by the cells of a grid. */
  struct Level
  {
    Level(const std::vector<Member>& members, const Box<3>& bounds, double cell);

    std::size_t CellAlong(std::size_t axis, double x) const;
    std::size_t CellOf(const Point<3>& p) const;

    Point<3> Origin;
    double InverseCell;
    std::array<std::size_t, 3> Cells;
    std::vector<std::uint32_t> First; ///< of each cell's members; one more than there are cells
    std::vector<Member> Members;
  };

  const double Spacing;      ///< of the first level
  std::vector<Level> Levels; ///< each has about a quarter of the points of the one before
};

} // namespace voxplex

#endif
