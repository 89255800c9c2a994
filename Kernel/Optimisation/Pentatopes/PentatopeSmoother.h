// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PentatopeSmoother.h
 * @brief Moves a vertex to improve the pentatopes around it.
 */
#ifndef voxplex_PentatopeSmoother_h
#define voxplex_PentatopeSmoother_h

#include "Optimisation/MoveLimits.h"
#include "Optimisation/Pentatopes/PentatopeRules.h"
#include "Optimisation/Pentatopes/PentatopeStar.h"

#include <cstdint>
#include <span>
#include <vector>

namespace voxplex
{

/**
 * @brief Moves single vertices uphill along the gradient of a measure of the pentatopes around them.
 *
 * A step is taken only if the measure grows and PentatopeRules::Allows() the result.
 * Vertices of interfaces move along them: in the directions that are tangential to the facets around
 * them. If facets have several normals, at a crease or where interfaces meet, all of these are
 * excluded. If they have one, the moves change no label's volume. Such a vertex moves by at most half
 * a voxel along each axis and a quarter of its shortest edge in all, and stays on a flat end.
 * Vertices on time planes stay on them. At the ends of a periodic mesh a vertex and its twin move together: the
 * pentatopes and facets around both count. A vertex there without a twin does not move. A pentatope outside of the
 * object is not turned over, so the mesh does not overlap itself.
 */
class PentatopeSmoother
{
public:
  /** @param originals the points before any were moved */
  PentatopeSmoother(Patch<4>& patch, const PentatopeRules& rules, const MoveLimits<4>& limits,
    std::span<const Point<4>> originals)
    : Target(patch)
    , Mesh(patch.Mesh())
    , Rules(rules)
    , Limits(limits)
    , Originals(originals)
  {
  }

  /** Begins with a vertex. Returns false if it does not move, or not in this patch. */
  bool Start(std::uint32_t v);

  /**
   * Moves the vertex until no pentatope around it is below the target, or no step helps.
   * The measure is the smallest quality. Returns whether it has moved. Changes the qualities of the
   * pentatopes around it.
   * @param tolerance how far, in all, it may move along normals of interfaces. If it is not 0, more
   *   directions are tried.
   */
  bool RaiseWorst(double target, double tolerance);

  /**
   * Moves the vertex by a few steps. The measure is the sum of q (2 - q) for the qualities q,
   * which counts the gain of a poor pentatope more than that of a good one. No quality falls below
   * `floor`, or below the smallest one before.
   */
  bool RaiseSum(double floor);

private:
  void GatherNormals();
  Point<4> SumOfNormals(const Point<4>& side) const;
  void Project(Point<4>& direction) const;
  double Smallest() const;
  Point<4> GradientOfWorst(const Point<4>& p, double below);
  Point<4> GradientOfSum(const Point<4>& p);
  bool MayMoveTo(const Point<4>& p) const;
  bool Allows(MovedPentatope& one, const PentatopeShape& shape) const;
  bool Try(const Point<4>& p, double floor);
  void Take(const Point<4>& p);
  bool Finish();

  Patch<4>& Target;
  const PentatopeComplex& Mesh;
  const PentatopeRules& Rules;
  const MoveLimits<4>& Limits;
  const std::span<const Point<4>> Originals;
  PentatopeStar Star;
  std::vector<double> Tried; ///< qualities at the tried point
  std::vector<Point<4>>
    FacetNormals;                ///< of the interfaces around the vertex, as long as the volumes
  std::vector<Point<4>> Normals; ///< orthonormal: directions in which the vertex does not move
  std::size_t FirstTried = 0;    ///< what failed at one point is likely to fail at the next one
  bool IsOnInterface = false;
  double Tolerance = 0.0;
  std::uint32_t Vertex = 0;
  Point<4> First{};               ///< where it was
  Point<4> Here{};                ///< where it is to be
  std::vector<std::uint32_t> Ids; ///< of the pentatopes of the mesh around it
};

} // namespace voxplex

#endif
