// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Smoother.h
 * @brief Moves vertices to where the worst tetrahedron around them is best.
 */
#ifndef voxplex_Smoother_h
#define voxplex_Smoother_h

#include "Domain/Domain.h"
#include "Optimisation/InterfaceRules.h"
#include "Optimisation/Patch.h"

#include <cstdint>
#include <unordered_map>
#include <vector>

namespace voxplex
{

/** What has been done. */
struct SmoothingCounts
{
  SmoothingCounts& operator+=(const SmoothingCounts& other)
  {
    this->FreeMoves += other.FreeMoves;
    this->SurfaceMoves += other.SurfaceMoves;
    this->Nudges += other.Nudges;
    this->Insertions += other.Insertions;
    return *this;
  }

  std::uint64_t FreeMoves = 0;
  std::uint64_t SurfaceMoves = 0;
  std::uint64_t Nudges = 0;
  std::uint64_t Insertions = 0;
};

/**
 * @brief Optimisation-based smoothing (Freitag and Ollivier-Gooch, Tetrahedral mesh improvement using swapping and
 * smoothing, 1997): steepest ascent of the smallest score in the star of a vertex.
 *
 * The smallest of several functions is not smooth. The direction is the shortest vector in the convex hull
 * of the gradients of those that are nearly smallest, along which all of them grow at least as fast as its
 * squared length; a line search follows. A step is taken only if the smallest score grows.
 *
 * A vertex on a surface of two labels moves along the tangent plane and then to the closest point of the
 * interface. It stays if that point is not between its two labels, if a planar angle of an
 * interface triangle would break its bound, or if a triangle would turn by more than 60 degrees.
 *
 * A vertex on a face where the image cuts the object stays on it, one on an edge of such a face stays where it is.
 *
 * As a last means, a vertex on an interface may be nudged in any direction, within a small distance of
 * where it was, which is then the fidelity that is given up (but where the image cuts the object, in the faces there); and a vertex may be inserted on an edge inside a
 * label, at once moved to where it is best.
 */
class Smoother
{
public:
  /** @param reach how far vertices on interfaces may be nudged */
  Smoother(Patch& patch, const Domain<3>& domain, const InterfaceRules& rules, double reach)
    : Target(patch)
    , Image(domain)
    , Rules(rules)
    , Reach(reach)
  {
  }

  /** Moves v until no tetrahedron around it is poor or no step helps; false if it does not move. */
  bool Improve(std::uint32_t v);

  /** Moves v, a vertex on interfaces, within reach of where it was; false if it does not move. */
  bool Nudge(std::uint32_t v);

  /** Splits the edge from vertex i to vertex j of t if that helps; false if not. */
  bool Insert(std::uint32_t t, unsigned i, unsigned j);

  const SmoothingCounts& Counts() const { return this->Done; }

private:
  enum class Constraint : std::uint8_t
  {
    Free,
    Surface, ///< to the tangent plane, then to the interface
    Anchor   ///< to a ball
  };

  /** An interface triangle of the vertex: its other two vertices, the normal out of the larger label. */
  struct FanFacet
  {
    std::uint32_t First;
    std::uint32_t Second;
    Point<3> Normal; ///< when the smoothing began, of twice the area
    double LargestCosine;
  };

  void GatherFan();
  bool FanIsDisk();
  bool Ascend(Point<3>& p);
  bool AscendInStar(Point<3>& p);
  double ScoreAt(const Point<3>& p, double floor);
  bool Direction(const Point<3>& p, Point<3>& direction, double& slope);
  bool Step(Point<3>& p, double& score);
  bool Constrain(Point<3>& p, double length) const;
  bool Project(const Point<3>& raw, double length, Point<3>& p) const;
  bool FanAllows(const Point<3>& p) const;

  Patch& Target;
  const Domain<3>& Image;
  const InterfaceRules Rules;
  const double Reach;
  SmoothingCounts Done;

  VertexStar Star;
  std::vector<Point<3>> Opposite; ///< three points of each tetrahedron of the star
  std::vector<float> Scores;      ///< at the current point
  std::vector<float> Tried;       ///< at the point that is being tried
  std::vector<Point<3>> Gradients;
  Constraint Bound = Constraint::Free;
  std::vector<FanFacet> Fan;
  Point<3> Normal{};                  ///< of length 1
  TetrahedralComplex::Label Sides[2]; ///< behind and before the normal
  double ShortestEdge = 0.0;
  Point<3> Anchor{};
  std::unordered_map<std::uint32_t, Point<3>> Anchors; ///< of vertices that were nudged
  EdgeRing Ring;
  std::vector<NewTetrahedron> Fresh;
};

} // namespace voxplex

#endif
