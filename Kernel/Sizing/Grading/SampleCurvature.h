// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SampleCurvature.h
 * @brief The curvature of a surface that is known by sample points.
 */
#ifndef voxplex_SampleCurvature_h
#define voxplex_SampleCurvature_h

#include "Geometry/CellGrid.h"
#include "Image/LabelImage.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace voxplex
{

/**
 * @brief The curvature of a sampled hypersurface around its points, at any scale.
 *
 * Take points spread evenly over a sphere of curvature k, within a small distance r of one of them.
 * Their root mean square distance from the plane that fits them best is k r^2 / sqrt(48), and the
 * other two eigenvalues of their covariance are r^2 / 4. So the eigenvalues give the curvature for
 * any spread of the points. They need no normals, which the stairs of voxels would spoil. In 4D
 * the numbers are k r^2 sqrt(3 / 175), and three times r^2 / 5.
 *
 * For a larger neighbourhood a query takes a pseudo-random part of the points, so its time hardly
 * depends on the radius. Queries may run in any number of threads.
 */
template <int D>
class SampleCurvature
{
public:
  using Labels = std::array<LabelId, 2>;

  /**
   * Linear in the number of points.
   * @param points of one surface or more; at least one
   * @param labels of each point: points with other labels belong to another surface
   * @param spacing the approximate distance between neighbours, > 0
   * @throws std::bad_alloc
   */
  SampleCurvature(
    const std::vector<Point<D>>& points, const std::vector<Labels>& labels, double spacing);

  /**
   * The curvature around p, from the points with these labels within `radius`. It is the curvature
   * of a sphere with the same distance from a plane. On a cylinder this is 0.87 over its radius,
   * and on a saddle 1.41 times its principal curvatures. In 4D, on the interface of a ball that
   * rests, it is exactly 1 over the radius, although the interface is straight along time. If there
   * are too few points, it is `unknown`.
   * @param roughness of the surface, root mean square: this part of the distance from a plane is
   *   not taken for a bend
   */
  double At(const Point<D>& p, const Labels& labels, double radius, double roughness,
    double unknown = 0.0) const;

private:
  struct Member
  {
    Point<D> Position;
    Labels Of;
  };

  /** A part of the points, sorted by the cells of a grid. */
  struct Level
  {
    Level(const std::vector<Member>& members, const Box<D>& bounds, double cell);

    CellGrid<D> Grid;
    std::vector<std::uint32_t> First; ///< of each cell's members; the last entry is their number
    std::vector<Member> Members;
  };

  const double Spacing; ///< of the first level
  std::vector<Level>
    Levels; ///< each has a part of the points of the one before, twice as far apart
};

extern template class SampleCurvature<3>;
extern template class SampleCurvature<4>;

} // namespace voxplex

#endif
