// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PentatopeStar.h
 * @brief The pentatopes around a vertex, ready to be measured with the vertex at any place.
 */
#ifndef voxplex_PentatopeStar_h
#define voxplex_PentatopeStar_h

#include "Base/UninitialisedVector.h"
#include "Optimisation/Patch.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace voxplex
{

/**
 * @brief A pentatope with one vertex that moves.
 *
 * The facet opposite to this vertex stays. Let c be its circumcentre, r its circumradius, A its
 * volume over 24, and n the unit normal that points to the vertex. If the vertex is at p, with the
 * height h = (p - c) . n, the pentatope has the volume A h. Its circumcentre is c + t n with
 * t = (|p - c|^2 - r^2) / (2 h), and its squared circumradius is r^2 + t^2. So a place costs a few
 * dozen operations.
 *
 * A pentatope at the twin of the vertex is measured at the same place in space, at its own time.
 */
struct MovedPentatope
{
  std::uint32_t Id;
  std::uint32_t Vertex;
  PentatopeComplex::Label Label;
  double Quality;  ///< at the current place; of label 0: the volume that it keeps
  double OldRatio; ///< radius-edge ratio at the first place; below 0 if it is not known yet
  std::array<const Point<4>*, 4> Facet;
  Point<4> Centre;      ///< c
  Point<4> Normal;      ///< n
  double Radius2;       ///< r^2
  double Area;          ///< A; 0: the facet has not been measured
  double ShortestEdge2; ///< of the facet
  double Shift;         ///< the twin's time minus that of the vertex; 0 at the vertex itself

  /**
   * Sets the circumcentre of the facet, the normal and the sizes. The facet has the corners of a positively
   * oriented pentatope in their order, without corner `opposite`, which is on the normal's side.
   */
  void MeasureFacet(std::size_t opposite);

  /** Measures the facet opposite to the first corner, unless it has been. All below needs that. */
  MovedPentatope& Measured()
  {
    if (this->Area == 0.0)
    {
      this->MeasureFacet(0);
    }
    return *this;
  }

  double VolumeAt(const Point<4>& p) const
  {
    return this->Area * Dot(Subtract(this->PlaceOf(p), this->Centre), this->Normal);
  }
  /** Normalized volume, ratio and circumball; quality 0 if it is not positively oriented. */
  PentatopeShape ShapeAt(const Point<4>& p) const;
  /** The normalized volume alone; 0 if it is not positively oriented. */
  double QualityAt(const Point<4>& p) const;
  /** The gradient of the normalized volume; the normal if the pentatope is not positively oriented at p. */
  Point<4> GradientAt(const Point<4>& p) const;
  /** Where the vertex of this pentatope is, if that of the star is at p. */
  Point<4> PlaceOf(const Point<4>& p) const { return { p[0], p[1], p[2], p[3] + this->Shift }; }
};

/**
 * @brief The pentatopes around a vertex and its twin: first those of the mesh, then those outside.
 *
 * Each is to be Measured() when it is needed: most trials fail at one of the first.
 */
class PentatopeStar
{
public:
  /**
   * Gathers the star of a vertex. All of its pentatopes must be positively oriented.
   * @return false if some of them may not be changed, or are missing (Patch::GatherStar)
   */
  bool Gather(const Patch<4>& patch, std::uint32_t v);

  std::span<MovedPentatope> Inside() { return { this->All.data(), this->NumberInside }; }
  std::span<const MovedPentatope> Inside() const
  {
    return { this->All.data(), this->NumberInside };
  }
  std::span<MovedPentatope> Outside() { return std::span(this->All).subspan(this->NumberInside); }
  std::span<const MovedPentatope> Both() const { return this->All; }
  double ShortestEdge() const { return this->Shortest; } ///< of those at the vertex and its twin

private:
  void Add(const PentatopeComplex& complex, std::uint32_t s,
    const PentatopeComplex::Vertices& corners, double shift);

  std::array<VertexStar<4>, 2> Stars; ///< of the vertex and its twin
  UninitialisedVector<MovedPentatope> All;
  std::size_t NumberInside = 0;
  double Shortest = 0.0;
};

} // namespace voxplex

#endif
