// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Smoother.h
 * @brief Moves vertices to improve the worst tetrahedron around them.
 */
#ifndef voxplex_Smoother_h
#define voxplex_Smoother_h

#include "Domain/Domain.h"
#include "Optimisation/Patch.h"
#include "Optimisation/Tetrahedra/InterfaceRules.h"

#include <array>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

namespace voxplex
{

/** Counts of changes. */
struct SmoothingStatistics
{
  SmoothingStatistics& operator+=(const SmoothingStatistics& other)
  {
    this->FreeMoves += other.FreeMoves;
    this->SurfaceMoves += other.SurfaceMoves;
    this->MovesOffInterfaces += other.MovesOffInterfaces;
    this->Insertions += other.Insertions;
    return *this;
  }

  std::uint64_t FreeMoves = 0;
  std::uint64_t SurfaceMoves = 0;
  std::uint64_t MovesOffInterfaces = 0;
  std::uint64_t Insertions = 0;
};

/** Where vertices on interfaces were before they were moved off. */
using AnchorMap = std::unordered_map<std::uint32_t, Point<3>>;

/**
 * @brief Optimisation-based smoothing (Freitag and Ollivier-Gooch, Tetrahedral mesh improvement
 * using swapping and smoothing, 1997): steepest ascent of the smallest score in the star of a
 * vertex.
 *
 * The smallest of several functions is not smooth. The active functions are those that are nearly
 * smallest. The direction is the shortest vector in the convex hull of their gradients. Along it,
 * all active functions grow at least as fast as its squared length. A line search follows. A step
 * is taken only if the smallest score grows.
 *
 * A vertex on a surface of two labels moves along the tangent plane and then to the distance from
 * the interface that it had before (FitInterfaces). It does not move if that point is not between its two labels, if a planar angle
 * of an interface triangle would violate its bound, or if a triangle would turn by more than 60
 * degrees.
 *
 * A vertex on a cut face stays on this face. A vertex on an edge of
 * such a face does not move.
 *
 * There are two last resorts. A vertex on an interface may be moved in any direction, within a
 * small distance of where it was; this distance is the loss of fidelity. On cut faces, it moves only
 * within these faces. And a vertex may be inserted inside a label. It
 * replaces the tetrahedra of a cavity by those between itself and the cavity's facets, and is moved
 * to its best position at once. The cavity has the tetrahedra around an edge; or it grows from one
 * tetrahedron across the facet that makes the worst new tetrahedron, as long as facets between
 * labels are not crossed (Klingner and Shewchuk, Aggressive tetrahedral mesh improvement, 2007).
 */
class Smoother
{
public:
  /**
   * @param reach how far vertices may be moved off interfaces
   * @param anchors of those that earlier ones have moved; changed. Must outlive this object.
   */
  Smoother(Patch<3>& patch, const Domain<3>& domain, const InterfaceRules& rules, double reach,
    AnchorMap& anchors)
    : Target(patch)
    , Image(domain)
    , Rules(rules)
    , LargestReach(reach)
    , Anchors(anchors)
  {
  }

  /**
   * Moves v until no tetrahedron around it is poor or no step helps. Returns false if v does not
   * move.
   */
  bool Improve(std::uint32_t v);

  /**
   * Moves v, a vertex on interfaces, by at most `reach`, and 0.4 of its shortest edge on them. Returns
   * false if v does not move.
   */
  bool MoveOffInterface(std::uint32_t v);

  /** Splits the edge from vertex i to vertex j of t if that helps. Returns false if it does not. */
  bool Insert(std::uint32_t t, unsigned i, unsigned j);

  /** Inserts a vertex inside t, with a cavity, if that helps. Returns false if it does not. */
  bool InsertInside(std::uint32_t t);

  const SmoothingStatistics& Counts() const { return this->Done; }

private:
  enum class Constraint : std::uint8_t
  {
    Free,
    Surface, ///< moves in the tangent plane, then to the interface
    Anchor   ///< moves within a ball
  };

  /**
   * An interface triangle of the vertex: its other two vertices, and the normal out of the larger
   * label.
   */
  struct FanFacet
  {
    std::uint32_t First;
    std::uint32_t Second;
    Point<3> Normal; ///< when smoothing began; its length is twice the area
    double LargestCosine;
  };

  /** A facet of the cavity: (p, V) is the tetrahedron that the new vertex p makes with it. */
  struct CavityFacet
  {
    std::uint32_t Cell; ///< the tetrahedron of the cavity that has it
    std::uint32_t Next; ///< the tetrahedron across it; None where the mesh ends
    std::array<std::uint32_t, 3> V;
    double Score;
  };

  void AddToCavity(std::uint32_t t, const Point<3>& p);
  double GrowCavity(std::uint32_t t, const Point<3>& p);
  bool FillCavity(std::uint32_t v, Point<3> p, std::span<const std::uint32_t> cells);
  void GatherFan();
  bool FanIsDisk();
  bool FindHeight();
  bool Ascend(Point<3>& p);
  bool AscendInStar(Point<3>& p);
  double ScoreAt(const Point<3>& p, double floor);
  bool Direction(const Point<3>& p, Point<3>& direction, double& slope);
  bool Step(Point<3>& p, double& score);
  bool Constrain(Point<3>& p, double length) const;
  bool Project(const Point<3>& raw, double length, Point<3>& p) const;
  bool FanAllows(const Point<3>& p) const;

  Patch<3>& Target;
  const Domain<3>& Image;
  const InterfaceRules Rules;
  const double LargestReach;
  AnchorMap& Anchors;
  double Reach = 0.0; ///< of the vertex that is moved
  SmoothingStatistics Done;

  VertexStar<3> Star;
  std::vector<Point<3>> Opposite; ///< the three other points of each tetrahedron of the star
  std::vector<float> Scores;      ///< at the current point
  std::vector<float> Tried;       ///< at the tried point
  std::vector<Point<3>> Gradients;
  Constraint Bound = Constraint::Free;
  std::vector<FanFacet> Fan;
  Point<3> Normal{};                  ///< of length 1
  double Height = 0.0;                ///< of the vertex above the interface, along the normal
  TetrahedralComplex::Label Sides[2]; ///< labels behind and in front of the normal
  double ShortestEdge = 0.0;
  Point<3> Anchor{};
  EdgeRing Ring;
  std::vector<std::uint32_t> Cavity;
  std::vector<CavityFacet> Facets; ///< of Cavity
  std::vector<NewCell<3>> Fresh;
};

} // namespace voxplex

#endif
