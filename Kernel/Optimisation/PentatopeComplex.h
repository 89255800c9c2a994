// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PentatopeComplex.h
 * @brief A pentatope mesh that is being changed, and what lies around it.
 */
#ifndef voxplex_PentatopeComplex_h
#define voxplex_PentatopeComplex_h

#include "Base/UninitialisedVector.h"
#include "Delaunay/Triangulation.h"
#include "Domain/TimePlanes.h"
#include "Geometry/Circumball.h"
#include "Image/LabelImage.h"
#include "Mesh/SimplexLabels.h"
#include "Mesh/SimplexMesh.h"
#include "Mesh/Subdivision.h"
#include "Quality/ComponentGuard.h"
#include "Sizing/SizingField.h"

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stop_token>
#include <vector>

namespace voxplex
{

/** The pentatopes outside of the object that have points of the mesh. */
struct Surroundings
{
  std::vector<Point<4>> Points;                        ///< numbered after the points of the mesh
  std::vector<std::array<std::uint32_t, 5>> Simplices; ///< positively oriented
};

/**
 * @param labels of each simplex id
 * @param parts the pieces that replace some simplices
 * @param positions of each vertex id; empty: those of the triangulation
 * @param numbers the point of each vertex id, then of each point of the parts; None if it is not in
 *   the mesh
 * @param points number of points of the mesh
 */
Surroundings SurroundingsOf(const Triangulation<4>& triangulation, const SimplexLabels& labels,
  const Subdivision<4>& parts, std::span<const Point<4>> positions,
  std::span<const std::uint32_t> numbers, std::size_t points);

/** What one pentatope is worth. */
struct PentatopeShape
{
  double Quality; ///< normalized volume; 0 if it is not positively oriented
  double Ratio;   ///< radius-edge ratio
  Circumball<4> Ball;
};

PentatopeShape ShapeOf(const std::array<const Point<4>*, 5>& points);

/** Bounds that changes of a mesh keep. What violates a bound already gets no worse. */
struct PentatopeBounds
{
  double Target = 0.05;         ///< pentatopes with a smaller normalized volume are improved
  double RadiusEdgeRatio = 2.0; ///< at most
  /** How far vertices may be moved off interfaces as a last resort; 0: not at all. */
  double InterfaceTolerance = 0.0;
  const SizingField<4>* Sizing = nullptr; ///< circumradii are below its element sizes; may be null
  /**
   * The facets on these planes stay, and so does the time of their vertices. So do those at the ends of a
   * periodic mesh.
   */
  TimePlanes Planes = {};
  /** No change that would lose one of its components is made. Null: all are. */
  ComponentGuard<4>* Guard = nullptr;
};

/**
 * @brief Vertices, labels and shapes of pentatopes, those around each vertex, and the facets of
 * interfaces.
 *
 * At the ends of a periodic mesh a vertex has a twin; both have the same place in space.
 *
 * The pentatopes of Surroundings have the label 0. Threads may read at the same time, and change
 * pentatopes and points that no other thread reads.
 */
class PentatopeComplex
{
public:
  using Vertices = std::array<std::uint32_t, 5>;

  PentatopeComplex(const SimplexMesh<4>& mesh, const Surroundings& outside,
    const LabelImage<4>& image, const Domain<4>& surfaces, const PentatopeBounds& bounds,
    unsigned threads, const std::stop_token& stop);

  /** Replaces the points, pentatopes and labels of the mesh; new points come last. Facets stay. */
  void CopyTo(SimplexMesh<4>& mesh) const;

  /** Numbers of pentatopes are smaller. Some may be dead. */
  std::size_t NumberOfPentatopes() const { return this->Corners.size(); }
  std::size_t NumberOfPoints() const { return this->Points.size(); } ///< those outside included

  const Vertices& CornersOf(std::size_t s) const { return this->Corners[s]; }
  LabelId LabelOf(std::size_t s) const { return this->Labels[s]; }
  bool IsAlive(std::size_t s) const { return this->Corners[s][0] != None; }

  /** Normalized volume. Of pentatopes with the label 0, the least volume that they keep. */
  double QualityOf(std::size_t s) const { return this->Qualities[s]; }
  bool IsPoor(std::size_t s, double target) const
  {
    return this->Labels[s] != 0 && this->IsAlive(s) && this->Qualities[s] < target;
  }

  const Point<4>& PointOf(std::uint32_t v) const { return this->Points[v]; }
  std::array<const Point<4>*, 5> PointsOf(const Vertices& v) const
  {
    return { &this->Points[v[0]], &this->Points[v[1]], &this->Points[v[2]], &this->Points[v[3]],
      &this->Points[v[4]] };
  }

  /**
   * The pentatopes around a vertex, in ascending order. What Replace(), Kill() and Append() change in them is
   * seen after UpdateStars(). Until then a new vertex has none.
   */
  std::span<const std::uint32_t> StarOf(std::uint32_t v) const
  {
    if (v >= this->PlacesOfStars.size())
    {
      return {};
    }
    const auto& [begin, end] = this->PlacesOfStars[v];
    return { this->Stars.data() + begin, end - begin };
  }

  /**
   * Complexity: linear in the stars of the vertices of pentatopes that have changed, but for a sort; now and then
   * in all stars, to free memory.
   */
  void UpdateStars(unsigned threads, const std::stop_token& stop);

  /** The facets of interfaces around a vertex of the mesh. New vertices have none. */
  std::span<const std::uint32_t> FacetsAt(std::uint32_t v) const
  {
    if (v >= this->MeshPoints)
    {
      return {};
    }
    return { this->FacetsOf.data() + this->FirstFacet[v],
      this->FirstFacet[v + 1] - this->FirstFacet[v] };
  }
  const std::array<std::uint32_t, 4>& Facet(std::size_t f) const { return this->Facets[f]; }

  /** The pentatope with the same vertices as s but one, vertex i; None if there is none. */
  std::uint32_t Neighbour(std::size_t s, unsigned i) const;

  /**
   * Whether a pentatope of a label keeps the bounds.
   * @param oldRatio the largest ratio of those that it replaces
   */
  bool Allows(const PentatopeShape& shape, double oldRatio, LabelId label) const;

  /** Whether the facet of s across vertex i lies on a time plane. */
  bool IsOnPlane(std::size_t s, unsigned i) const;

  /** The vertex at the other end of a periodic mesh; None if there is none. */
  std::uint32_t TwinOf(std::uint32_t v) const
  {
    return this->Twins.empty() ? None : this->Twins[v];
  }

  /** Moves a vertex; its twin to the same place in space. */
  void Move(std::uint32_t v, const Point<4>& p)
  {
    this->Points[v] = p;
    if (const std::uint32_t twin = this->TwinOf(v); twin != None)
    {
      this->Points[twin] = { p[0], p[1], p[2], this->Points[twin][3] };
    }
  }
  /** Whether a component needs a pentatope: see PentatopeBounds::Guard. */
  bool IsHolder(std::size_t s) const
  {
    return s < this->AreHolders.size() && this->AreHolders[s] != 0;
  }
  const ComponentGuard<4>* Guard() const { return this->Bounds.Guard; }
  /**
   * To be called before pentatopes of one label are replaced. Each new one takes the place of an old
   * one, or is appended.
   * @param added the place of the vertex None of new ones
   * @return false if a component would be lost; otherwise it is noted what holds it next
   */
  bool HandOver(std::span<const std::uint32_t> old, std::span<const Vertices> fresh,
    const Point<4>& added = {});

  void SetQuality(std::size_t s, double quality) { this->Qualities[s] = quality; }
  void Replace(std::size_t s, const Vertices& corners, double quality)
  {
    this->NoteChange(s);
    this->Corners[s] = corners;
    this->Qualities[s] = quality;
  }
  void Kill(std::size_t s)
  {
    this->NoteChange(s);
    this->Corners[s][0] = None;
  }
  std::uint32_t Append(LabelId label);
  std::uint32_t AddPoint(const Point<4>& p);

private:
  struct Range
  {
    std::size_t Begin = 0;
    std::size_t End = 0;
  };

  struct Corner
  {
    std::uint32_t Vertex;
    std::uint32_t Pentatope;
    auto operator<=>(const Corner&) const = default;
  };

  void FindStars();
  void UpdateStar(std::span<const Corner> changes, std::size_t newBegin);
  void NoteChange(std::size_t s);

  const PentatopeBounds Bounds;
  const Domain<4>& Surfaces;
  const std::span<const std::int64_t> Values; ///< of labels in the image
  const std::size_t MeshPoints;
  const std::size_t FirstPoints; ///< those of the mesh and those outside; new ones come after them
  std::span<const std::array<std::uint32_t, 4>> Facets;
  std::vector<Point<4>> Points;
  std::vector<Vertices> Corners;
  std::vector<LabelId> Labels;
  std::vector<double> Qualities;
  std::vector<std::uint8_t> AreHolders; ///< of each pentatope; empty if there are none
  std::vector<Range> PlacesOfStars;     ///< of each vertex, in Stars
  std::vector<std::uint32_t> Stars;     ///< with gaps
  std::size_t StarsFound = 0;           ///< the length of Stars after all were found
  std::vector<std::uint32_t> Changed; ///< pentatopes, since stars were brought up to date; repeated
  std::vector<Corner> Left;           ///< of such pentatopes, before they changed
  std::vector<std::size_t> FirstFacet; ///< by vertex of the mesh, and the end
  std::vector<std::uint32_t> FacetsOf;
  std::vector<std::uint32_t> Twins; ///< of each vertex; empty if there are none
};

} // namespace voxplex

#endif
