// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SimplexQuality.h
 * @brief Shape measures of one simplex.
 *
 * A simplex is given as D + 1 pointers to points. Angles are in degrees. They are accurate near 0
 * and 180, since they are computed by atan2 of a sine and a cosine with a common factor, never by
 * acos. Shape measures do not depend on the orientation. All functions are pure and thread-safe.
 */
#ifndef voxplex_SimplexQuality_h
#define voxplex_SimplexQuality_h

#include "Geometry/Circumball.h"
#include "Geometry/Determinants.h"
#include "Geometry/Point.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

namespace voxplex
{

constexpr double DegreesPerRadian = 180.0 / std::numbers::pi;

inline Point<3> Cross(const Point<3>& a, const Point<3>& b)
{
  return { Minor2(a[1], a[2], b[1], b[2]), Minor2(a[2], a[0], b[2], b[0]),
    Minor2(a[0], a[1], b[0], b[1]) };
}

/** The vector that is orthogonal to all three, and as long as the volume that they span. */
inline Point<4> Cross(const Point<4>& a, const Point<4>& b, const Point<4>& c)
{
  Point<4> normal;
  for (std::size_t j = 0; j < 4; ++j)
  {
    const std::size_t x = j == 0 ? 1 : 0;
    const std::size_t y = j <= 1 ? 2 : 1;
    const std::size_t z = j <= 2 ? 3 : 2;
    const double minor = Determinant<double>(std::array<Point<3>, 3>{
      { { a[x], a[y], a[z] }, { b[x], b[y], b[z] }, { c[x], c[y], c[z] } } });
    normal[j] = j % 2 == 0 ? minor : -minor;
  }
  return normal;
}

/** The normal of the facet of D points, as long as the volume that its edges span. */
inline Point<3> FacetNormal(const std::array<Point<3>, 3>& p)
{
  return Cross(Subtract(p[1], p[0]), Subtract(p[2], p[0]));
}

inline Point<4> FacetNormal(const std::array<Point<4>, 4>& p)
{
  return Cross(Subtract(p[1], p[0]), Subtract(p[2], p[0]), Subtract(p[3], p[0]));
}

/** The area of a triangle; the volume of a tetrahedron in 4D. */
template <std::size_t D>
inline double FacetMeasure(const std::array<const std::array<double, D>*, D>& corners)
{
  std::array<std::array<double, D>, D> points;
  for (std::size_t i = 0; i < D; ++i)
  {
    points[i] = *corners[i];
  }
  const std::array<double, D> normal = FacetNormal(points);
  return std::sqrt(Dot(normal, normal)) / (D == 3 ? 2.0 : 6.0);
}

/** D-dimensional volume, positive for positively oriented simplices. */
template <int D>
inline double SignedVolume(const Point<D>* const* v)
{
  std::array<Point<D>, static_cast<std::size_t>(D)> edges;
  for (std::size_t i = 0; i < edges.size(); ++i)
  {
    edges[i] = Subtract(*v[i + 1], *v[0]);
  }
  return Determinant(edges) / (D == 3 ? 6.0 : 24.0);
}

/** Squared length of the shortest edge. */
template <int D>
inline double ShortestEdge2(const Point<D>* const* v)
{
  double shortest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i <= static_cast<std::size_t>(D); ++i)
  {
    for (std::size_t j = 0; j < i; ++j)
    {
      shortest = std::min(shortest, Distance2(*v[i], *v[j]));
    }
  }
  return shortest;
}

/** Squared circumradius; infinity if flat. Uses exact arithmetic if double is not certain. */
template <int D>
inline double Circumradius2(const Point<D>* const* v)
{
  Circumball<D> ball;
  if (!ComputeCircumball<D>(v, ball))
  {
    ComputeCircumballExactly<D>(v, ball);
  }
  return ball.Radius2;
}

/**
 * Radius-edge ratio: circumradius / shortest edge (rho of the thesis). It is sqrt(6)/4 = 0.612 for
 * the regular tetrahedron, sqrt(10)/5 = 0.632 for the regular pentatope, larger for all other
 * simplices, and infinity if flat.
 * @param radius2 Circumradius2(v)
 */
template <int D>
inline double RadiusEdgeRatio(const Point<D>* const* v, double radius2)
{
  return std::sqrt(radius2 / ShortestEdge2<D>(v));
}

template <int D>
inline double RadiusEdgeRatio(const Point<D>* const* v)
{
  return RadiusEdgeRatio<D>(v, Circumradius2<D>(v));
}

/**
 * Volume divided by the volume of the regular simplex with the same circumradius (tau-hat in
 * chapter 4 of the thesis, here for any D): 1 for the regular simplex, 0 for a flat one.
 * @param volume SignedVolume(v)
 * @param radius2 Circumradius2(v)
 */
template <int D>
inline double NormalizedVolume(double volume, double radius2)
{
  // Regular simplex inscribed in the unit sphere: volume sqrt(D + 1) / D! ((D + 1) / D)^(D/2).
  const double regular = D == 3 ? 8.0 / (9.0 * std::numbers::sqrt3) : 25.0 * std::sqrt(5.0) / 384.0;
  const double radiusPower = D == 3 ? radius2 * std::sqrt(radius2) : radius2 * radius2;
  return std::abs(volume) / (regular * radiusPower);
}

template <int D>
inline double NormalizedVolume(const Point<D>* const* v, double radius2)
{
  return NormalizedVolume<D>(SignedVolume<D>(v), radius2);
}

template <int D>
inline double NormalizedVolume(const Point<D>* const* v)
{
  return NormalizedVolume<D>(v, Circumradius2<D>(v));
}

/**
 * The smallest sine of the dihedral angles of a tetrahedron: 0.943 for the regular tetrahedron, 0
 * if flat. It is small if an angle is near 0 or near 180 degrees.
 */
inline double SmallestDihedralSine(const Point<3>* const* v)
{
  const Point<3> e01 = Subtract(*v[1], *v[0]);
  const Point<3> e02 = Subtract(*v[2], *v[0]);
  const Point<3> e03 = Subtract(*v[3], *v[0]);
  const Point<3> e12 = Subtract(*v[2], *v[1]);
  const Point<3> e13 = Subtract(*v[3], *v[1]);
  const Point<3> e23 = Subtract(*v[3], *v[2]);
  const Point<3> n1 = Cross(e03, e02);
  const double determinant = Dot(e01, n1);
  const auto norm2 = [](const Point<3>& n) { return Dot(n, n); };
  const double a0 = norm2(Cross(e12, e13));
  const double a1 = norm2(n1);
  const double a2 = norm2(Cross(e01, e03));
  const double a3 = norm2(Cross(e02, e01));
  // The squared sines, divided by the squared determinant.
  const double smallest =
    std::min({ norm2(e01) / (a2 * a3), norm2(e02) / (a1 * a3), norm2(e03) / (a1 * a2),
      norm2(e12) / (a0 * a3), norm2(e13) / (a0 * a2), norm2(e23) / (a0 * a1) });
  return std::abs(determinant) * std::sqrt(smallest);
}

/**
 * The dihedral angles of a tetrahedron at its edges 01, 02, 03, 12, 13, 23.
 *
 * Let N_k be the outward normal of the facet opposite vertex k. Its length is twice the facet's
 * area. The dihedral angle at edge ij lies between the facets opposite k and l. Its cosine is
 * -N_k . N_l / (|N_k| |N_l|), and its sine |N_k x N_l| / (|N_k| |N_l|), with
 * |N_k x N_l| = |edge ij| |det|.
 */
inline std::array<double, 6> DihedralAngles(const Point<3>* const* v)
{
  const Point<3> e01 = Subtract(*v[1], *v[0]);
  const Point<3> e02 = Subtract(*v[2], *v[0]);
  const Point<3> e03 = Subtract(*v[3], *v[0]);
  const Point<3> e12 = Subtract(*v[2], *v[1]);
  const Point<3> e13 = Subtract(*v[3], *v[1]);
  const Point<3> e23 = Subtract(*v[3], *v[2]);
  const Point<3> n0 = Cross(e12, e13);
  const Point<3> n1 = Cross(e03, e02);
  const Point<3> n2 = Cross(e01, e03);
  const Point<3> n3 = Cross(e02, e01);
  const double determinant = std::abs(Dot(e01, n1));
  const auto angle = [determinant](const Point<3>& edge, const Point<3>& a, const Point<3>& b)
  { return std::atan2(std::sqrt(Dot(edge, edge)) * determinant, -Dot(a, b)) * DegreesPerRadian; };
  return { angle(e01, n2, n3), angle(e02, n1, n3), angle(e03, n1, n2), angle(e12, n0, n3),
    angle(e13, n0, n2), angle(e23, n0, n1) };
}

/** The angles of a triangle at a, b and c. */
inline std::array<double, 3> PlanarAngles(const Point<3>& a, const Point<3>& b, const Point<3>& c)
{
  const Point<3> ab = Subtract(b, a);
  const Point<3> ac = Subtract(c, a);
  const Point<3> bc = Subtract(c, b);
  const Point<3> normal = Cross(ab, ac);
  const double twiceArea = std::sqrt(Dot(normal, normal));
  return { std::atan2(twiceArea, Dot(ab, ac)) * DegreesPerRadian,
    std::atan2(twiceArea, -Dot(ab, bc)) * DegreesPerRadian,
    std::atan2(twiceArea, Dot(ac, bc)) * DegreesPerRadian };
}

/** Cosine of the smallest angle of a triangle. */
inline double CosineOfSmallestAngle(const Point<3>& a, const Point<3>& b, const Point<3>& c)
{
  const double ab = Distance2(a, b);
  const double bc = Distance2(b, c);
  const double ca = Distance2(c, a);
  // The smallest angle is opposite to the shortest edge.
  const double shortest = std::min({ ab, bc, ca });
  const double product = shortest == ab ? bc * ca : shortest == bc ? ab * ca : ab * bc;
  return (ab + bc + ca - 2.0 * shortest) / (2.0 * std::sqrt(product));
}

} // namespace voxplex

#endif
