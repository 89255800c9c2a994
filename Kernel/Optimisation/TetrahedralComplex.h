// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TetrahedralComplex.h
 * @brief A labelled tetrahedral mesh with adjacency, for changes.
 */
#ifndef voxplex_TetrahedralComplex_h
#define voxplex_TetrahedralComplex_h

#include "Base/UninitialisedVector.h"
#include "Domain/Domain.h"
#include "Mesh/SimplexMesh.h"
#include "Optimisation/ShapeScore.h"
#include "Quality/ComponentGuard.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stop_token>
#include <vector>

namespace voxplex
{

/** How a vertex may move. */
enum class VertexRole : std::uint8_t
{
  Free,    ///< all tetrahedra around it have one label
  Surface, ///< on an interface of two labels; one of them may be background
  Crease,  ///< as Surface, but on an edge of a face where the image cuts the object
  Fixed    ///< where three or more labels meet
};

/** Numbers of tetrahedra and vertices that a complex can take without moving its arrays. */
struct SpareRoom
{
  std::size_t Cells = 0;
  std::size_t Vertices = 0;
};

/**
 * @brief The data structure of optimisation: a SimplexMesh<3> with adjacency, kinds of vertices and
 * scores.
 *
 * Tetrahedron: the vertices V are positively oriented. N[i] is the neighbour across the facet
 * opposite to V[i], or None where the mesh ends. Slots of deleted tetrahedra have V[0] == None.
 *
 * Labels are indices into LabelValues, which is sorted; 0 is background, which no tetrahedron has.
 *
 * Threads may change disjoint blocks of the complex at the same time: see Patch.
 */
class TetrahedralComplex
{
public:
  static constexpr std::uint32_t None = 0xffffffffu;
  using Vertices = std::array<std::uint32_t, 4>;
  using Label = std::uint32_t;

  struct Tetrahedron
  {
    Vertices V;
    Vertices N;
  };

  /**
   * @param mesh a valid mesh: positive orientation, at most two tetrahedra at a facet
   * @param scores of the tetrahedra, if they are known; otherwise empty
   * @param spare room for this many more tetrahedra and vertices (AddCells(), AddVertices())
   *
   * Complexity: linear, except for sorting label values. The result does not depend on the number of
   * threads.
   */
  TetrahedralComplex(const SimplexMesh<3>& mesh, const ShapeScore& score, unsigned threads,
    const std::stop_token& stop, std::span<const float> scores = {}, const SpareRoom& spare = {});

  /**
   * Finds the vertices on faces where the image cuts the object. To be called once, before any
   * change.
   */
  void FindBorderFaces(const Domain<3>& domain);

  /**
   * Replaces the mesh by the current state: used points, tetrahedra and interfaces. The complex is
   * taken apart while the mesh is written, so that both never take their whole memory. Afterwards
   * it cannot be used any more.
   */
  void Write(SimplexMesh<3>& mesh, unsigned threads = 1, const std::stop_token& stop = {});

  /** Adds slots for more tetrahedra. They are not alive. */
  void AddCells(std::size_t number);
  /** Adds unused vertices. */
  void AddVertices(std::size_t number);

  bool IsAlive(std::uint32_t t) const { return this->Cells[t].V[0] != None; }
  /** Whether a component needs t: see Guard. */
  bool IsHolder(std::uint32_t t) const
  {
    return !this->AreHolders.empty() && this->AreHolders[t] != 0;
  }
  Label LabelOf(std::uint32_t t) const { return t == None ? 0 : this->Labels[t]; }
  /** Domain::BorderFaces of a vertex. */
  unsigned BorderFacesOf(std::uint32_t v) const
  {
    return this->BorderFaces.empty() ? 0u : this->BorderFaces[v];
  }
  const Point<3>& PointOf(std::uint32_t t, unsigned i) const
  {
    return this->Points[this->Cells[t].V[i]];
  }

  /** The index of v in t; v must be a vertex of t. */
  unsigned IndexOf(std::uint32_t t, std::uint32_t v) const
  {
    const Vertices& w = this->Cells[t].V;
    return w[0] == v ? 0u : w[1] == v ? 1u : w[2] == v ? 2u : 3u;
  }

  double Score(const Vertices& v) const
  {
    return this->Shape(
      this->Points[v[0]], this->Points[v[1]], this->Points[v[2]], this->Points[v[3]]);
  }

  ShapeScore Shape;
  UninitialisedVector<Point<3>> Points;
  /**
   * By vertex. Changes of connectivity need not update the kinds. If Flips brings an interface
   * triangle to a vertex, the vertex already has one between the same two labels, and on the same
   * faces where the image cuts the object. So a vertex can only become freer than its kind; then it
   * keeps its kind.
   */
  std::vector<VertexRole> Kinds;
  std::vector<std::uint8_t>
    BorderFaces; ///< Domain::BorderFaces by vertex; empty if the image cuts nothing
  std::vector<std::uint32_t> Hosts;   ///< a tetrahedron of each vertex
  std::vector<std::uint32_t> Degrees; ///< number of tetrahedra of each vertex
  std::vector<std::uint32_t> Changes; ///< the clock when a tetrahedron of each vertex changed last
  UninitialisedVector<Tetrahedron> Cells;
  UninitialisedVector<Label> Labels;
  UninitialisedVector<float> Scores;
  std::vector<std::int64_t> LabelValues;
  const ComponentGuard<3>* Guard = nullptr; ///< is asked before a holder changes; null: none does
  std::vector<std::uint8_t> AreHolders;     ///< by tetrahedron; empty if there are none

private:
  void FindLabels(const SimplexMesh<3>& mesh, unsigned threads, const std::stop_token& stop);
  void CopyCells(const SimplexMesh<3>& mesh, unsigned threads, const std::stop_token& stop);
  void ScoreCells(unsigned threads, const std::stop_token& stop);
  void Connect(unsigned threads, const std::stop_token& stop);
  void FindKinds(unsigned threads, const std::stop_token& stop);
  UninitialisedVector<std::uint32_t> WritePoints(
    SimplexMesh<3>& mesh, unsigned threads, const std::stop_token& stop) const;
};

/**
 * The vertices of a positively oriented tetrahedron, v[first] first, in an order that keeps the
 * orientation.
 */
inline TetrahedralComplex::Vertices StartingAt(
  const TetrahedralComplex::Vertices& v, unsigned first)
{
  switch (first)
  {
    case 0:
      return v;
    case 1:
      return { v[1], v[0], v[3], v[2] };
    case 2:
      return { v[2], v[0], v[1], v[3] };
    default:
      return { v[3], v[0], v[2], v[1] };
  }
}

} // namespace voxplex

#endif
