// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PentatopeSmoother.h
 * @brief Moves a vertex to improve the worst pentatope around it.
 */
#ifndef voxplex_PentatopeSmoother_h
#define voxplex_PentatopeSmoother_h

#include "Optimisation/MoveLimits.h"
#include "Optimisation/PentatopeComplex.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace voxplex
{

/**
 * @brief Moves single vertices uphill along the gradient of the worst pentatope around them.
 *
 * A step is taken only if the smallest quality grows and PentatopeComplex::Allows() the result.
 * Vertices of interfaces move along them: in the directions that are tangential to the facets around
 * them. If facets have several normals, at a crease or where interfaces meet, all of these are
 * excluded. Such a vertex moves by at most half a voxel along each axis and a quarter of its
 * shortest edge in all, and stays on a flat end. A pentatope outside of the object is not turned
 * over, so the mesh does not overlap itself.
 */
class PentatopeSmoother
{
public:
  /** @param originals the points before any were moved */
  PentatopeSmoother(
    PentatopeComplex& complex, const MoveLimits& limits, std::span<const Point<4>> originals)
    : Target(complex)
    , Limits(limits)
    , Originals(originals)
  {
  }

  /**
   * Moves a vertex of the mesh until no pentatope around it is below the target, or no step helps.
   * Returns whether it has moved. Changes the qualities of the pentatopes around it.
   * @param tolerance how far, in all, it may move along normals of interfaces
   */
  bool Improve(std::uint32_t v, double target, double tolerance);

private:
  /** A pentatope around the vertex. */
  struct Around
  {
    std::uint32_t Id;
    std::uint32_t Place; ///< the vertex' place in its corners
    LabelId Label;
    double Quality;  ///< at the current point; of label 0: the volume that it keeps
    double OldRatio; ///< at the first point; found when it is needed
  };

  void GatherStar(std::uint32_t v);
  void PutWorstFirst();
  void GatherNormals(std::uint32_t v);
  void Project(Point<4>& direction) const;
  Point<4> GradientOfWorst(std::uint32_t v, double step) const;
  bool MayMoveTo(std::uint32_t v, const Point<4>& p) const;
  bool Allows(Around& one, const PentatopeShape& shape) const;
  bool Try(const Point<4>& p, double floor);
  std::array<const Point<4>*, 5> PointsWith(const Around& one, const Point<4>& p) const;

  PentatopeComplex& Target;
  const MoveLimits& Limits;
  const std::span<const Point<4>> Originals;
  std::vector<Around> Star;      ///< the worst comes first, those outside last
  std::vector<double> Tried;     ///< qualities at the tried point
  std::vector<Point<4>> Normals; ///< orthonormal: directions in which the vertex does not move
  bool IsOnInterface = false;
  double Tolerance = 0.0;
  double ShortestEdge = 0.0;
  Point<4> Start{};
};

} // namespace voxplex

#endif
