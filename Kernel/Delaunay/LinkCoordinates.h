// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LinkCoordinates.h
 * @brief Guesses and checks the apex of a facet among the vertices of a link, in vectors.
 */
#ifndef voxplex_LinkCoordinates_h
#define voxplex_LinkCoordinates_h

#include "Delaunay/Stack.h"
#include "Geometry/Circumball.h"
#include "Geometry/Point.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace voxplex
{

/**
 * @brief The coordinates of the vertices of a link, each axis in an array of its own.
 *
 * The balls through a facet are a pencil: if S(x) = |x - c|^2 - r^2 is zero on the sphere of one of
 * them and d(x) is the height of x above the facet's plane, the others are S(x) = t d(x). If the
 * ball of S is empty, the first vertex that its sphere meets above the plane, as t grows from 0, is
 * the one with the largest d / S.
 *
 * All functions are loops without branches or calls. They take time linear in the number of vertices.
 */
template <int D>
class LinkCoordinates
{
public:
  static constexpr std::uint32_t Nothing = 0xffffffffu;

  void Resize(std::size_t n)
  {
    this->Count = n;
    for (Stack<double>& axis : this->Axes)
    {
      axis.Resize(n);
    }
    this->Slopes.Resize(n);
  }
  void Set(std::size_t k, const Point<D>& p)
  {
    for (std::size_t a = 0; a < this->Axes.size(); ++a)
    {
      this->Axes[a][k] = p[a];
    }
  }

  /**
   * The vertex that the pencil meets first, up to rounding.
   * @param ball a ball through the facet; NaN if it is not known
   * @param origin a vertex of the facet
   * @param normal a normal of the facet, on the side of the vertex that is looked for
   * @param facet the numbers of the facet's vertices, which are left out, and one more that is ignored
   * @param ignored the position in `facet` that is ignored
   * @return its number; Nothing if no vertex is on this side
   */
  std::uint32_t FirstOfPencil(const Circumball<D>& ball, const Point<D>& origin,
    const Point<D>& normal, const std::array<std::uint32_t, D + 1>& facet, std::uint32_t ignored)
  {
    const std::array<const double*, static_cast<std::size_t>(D)> x = this->Data();
    const Point<D> center = ball.Center; // copies, which the results cannot overwrite
    const double radius2 = ball.Radius2;
    const Point<D> up = normal;
    const double level = Dot(normal, origin);
    const double floor = 1e-30 * radius2;
    double* const slopes = this->Slopes.begin();
    for (std::size_t k = 0; k < this->Count; ++k)
    {
      double height = -level;
      double power = -radius2;
      for (std::size_t a = 0; a < x.size(); ++a)
      {
        const double fromCenter = x[a][k] - center[a];
        height += up[a] * x[a][k];
        power += fromCenter * fromCenter;
      }
      slopes[k] = height / (power > floor ? power : floor);
    }
    for (std::uint32_t i = 0; i < facet.size(); ++i)
    {
      if (i != ignored)
      {
        slopes[facet[i]] = 0.0;
      }
    }
    std::uint32_t first = Nothing;
    double steepest = 0.0;
    for (std::uint32_t k = 0; k < this->Count; ++k)
    {
      const bool steeper = slopes[k] > steepest;
      steepest = steeper ? slopes[k] : steepest;
      first = steeper ? k : first;
    }
    return first;
  }

  /**
   * True if only the vertices of the ball's own simplex are not certainly outside it.
   * @param ball a certified ball of D + 1 of the vertices
   */
  bool IsCertainlyEmpty(const Circumball<D>& ball) const
  {
    const double slack = CircumballTolerance * ball.Radius2; // as SideOfCircumball does
    const std::array<const double*, static_cast<std::size_t>(D)> x = this->Data();
    std::uint64_t near = 0;
    for (std::size_t k = 0; k < this->Count; ++k)
    {
      double distance2 = 0.0;
      for (std::size_t a = 0; a < x.size(); ++a)
      {
        const double fromCenter = x[a][k] - ball.Center[a];
        distance2 += fromCenter * fromCenter;
      }
      near += distance2 - ball.Radius2 > slack ? 0 : 1;
    }
    return near == D + 1;
  }

private:
  std::array<const double*, static_cast<std::size_t>(D)> Data() const
  {
    std::array<const double*, static_cast<std::size_t>(D)> data;
    for (std::size_t a = 0; a < data.size(); ++a)
    {
      data[a] = this->Axes[a].begin();
    }
    return data;
  }

  std::array<Stack<double>, static_cast<std::size_t>(D)> Axes;
  Stack<double> Slopes;
  std::size_t Count = 0;
};

} // namespace voxplex

#endif
