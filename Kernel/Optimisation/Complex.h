// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Complex.h
 * @brief A labelled mesh with adjacency, for changes.
 */
#ifndef voxplex_Complex_h
#define voxplex_Complex_h

#include "Base/UninitialisedVector.h"
#include "Domain/Domain.h"
#include "Mesh/SimplexMesh.h"
#include "Optimisation/PentatopeShape.h"
#include "Optimisation/ShapeScore.h"
#include "Optimisation/Surroundings.h"
#include "Quality/ComponentGuard.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stop_token>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

namespace voxplex
{

/** How a vertex may move. */
enum class VertexRole : std::uint8_t
{
  Free,    ///< all cells around it have one label
  Surface, ///< on an interface of two labels; one of them may be background
  Crease,  ///< as Surface, but on an edge of a face where the image cuts the object
  Fixed    ///< where three or more labels meet
};

/** Numbers of cells and vertices that a complex can take without moving its arrays. */
struct SpareRoom
{
  std::size_t Cells = 0;
  std::size_t Vertices = 0;
};

/** The cells that were seen in a search. Memory is kept from search to search. */
class SeenCells
{
public:
  void Clear()
  {
    std::fill(this->Table.begin(), this->Table.end(), Empty);
    this->Count = 0;
  }

  /** Returns whether t is new. */
  bool Insert(std::uint32_t t)
  {
    std::size_t place = (t * std::uint32_t{ 0x9e3779b1u } >> 8) & this->Mask;
    for (; this->Table[place] != Empty; place = (place + 1) & this->Mask)
    {
      if (this->Table[place] == t)
      {
        return false;
      }
    }
    this->Table[place] = t;
    if (2 * ++this->Count > this->Mask)
    {
      this->Grow();
    }
    return true;
  }

private:
  static constexpr std::uint32_t Empty = 0xffffffffu;

  void Grow()
  {
    this->Mask = 2 * this->Mask + 1;
    const std::vector<std::uint32_t> old =
      std::exchange(this->Table, std::vector<std::uint32_t>(this->Mask + 1, Empty));
    this->Count = 0;
    for (const std::uint32_t t : old)
    {
      if (t != Empty)
      {
        this->Insert(t);
      }
    }
  }

  std::size_t Mask = 255; ///< a power of two, minus 1
  /** Open addressing. More than half of it is empty. */
  std::vector<std::uint32_t> Table = std::vector<std::uint32_t>(this->Mask + 1, Empty);
  std::size_t Count = 0;
};

/** The cells around a vertex. */
template <int D>
struct VertexStar
{
  std::uint32_t Vertex = 0;
  std::vector<std::uint32_t> Cells;
  /** The vertices of each cell, Vertex first, positively oriented. */
  std::vector<std::array<std::uint32_t, static_cast<std::size_t>(D + 1)>> Corners;
  SeenCells Seen; ///< for the search
};

/**
 * @brief The data structure of optimisation: a SimplexMesh<D> with adjacency, kinds of vertices and
 * scores. In 4D it also has the pentatopes around the mesh.
 *
 * Cell: the vertices V are positively oriented. N[i] is the neighbour across the facet opposite to
 * V[i], or None where the complex ends. Slots of deleted cells have V[0] == None.
 *
 * Labels are indices into LabelValues, which is sorted; 0 is background, which only cells around the
 * mesh have.
 *
 * Threads may change disjoint blocks of the complex at the same time: see Patch.
 */
template <int D>
class Complex
{
public:
  static constexpr std::uint32_t None = 0xffffffffu;
  static constexpr unsigned Corners = D + 1;
  using Vertices = std::array<std::uint32_t, static_cast<std::size_t>(D + 1)>;
  using Facet = std::array<std::uint32_t, static_cast<std::size_t>(D)>;
  using Label = std::uint32_t;
  using ShapeFunction = std::conditional_t<D == 3, ShapeScore, PentatopeScore>;
  using ScoreValue = std::conditional_t<D == 3, float, double>;

  struct Cell
  {
    Vertices V;
    Vertices N;
  };

  /** A facet whose neighbour is not known, vertices sorted. */
  struct OpenFacet
  {
    Facet V;
    std::uint32_t Cell;
    unsigned Index;
  };

  /**
   * @param mesh a valid mesh: positive orientation, at most two cells at a facet
   * @param scores of the cells, if they are known; otherwise empty
   * @param spare room for this many more cells and vertices (AddCells(), AddVertices())
   * @param outside the cells around the mesh
   *
   * Complexity: linear, except for sorting label values. The result does not depend on the number of
   * threads.
   */
  Complex(const SimplexMesh<D>& mesh, const ShapeFunction& score, unsigned threads,
    const std::stop_token& stop, std::span<const ScoreValue> scores = {},
    const SpareRoom& spare = {}, const Surroundings<D>& outside = {});

  /**
   * Finds the vertices on faces where the image cuts the object. To be called once, before any
   * change.
   */
  void FindBorderFaces(const Domain<D>& domain);

  /** No change loses a component from now on. To be called once, before any change. */
  void Protect(ComponentGuard<D>& guard, const SimplexMesh<D>& mesh, unsigned threads,
    const std::stop_token& stop);

  /**
   * Replaces the mesh by the current state: used points, cells and in 3D interfaces; in 4D facets do
   * not change. Cells around the mesh are left out. The complex is taken apart while the mesh is
   * written, so that both never take their whole memory. Afterwards it cannot be used any more.
   */
  void Write(SimplexMesh<D>& mesh, unsigned threads = 1, const std::stop_token& stop = {});

  /** Adds slots for more cells. They are not alive. */
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
  const Point<D>& PointOf(std::uint32_t t, unsigned i) const
  {
    return this->Points[this->Cells[t].V[i]];
  }
  std::array<const Point<D>*, Corners> PointsOf(const Vertices& v) const
  {
    std::array<const Point<D>*, Corners> points;
    for (unsigned i = 0; i < Corners; ++i)
    {
      points[i] = &this->Points[v[i]];
    }
    return points;
  }

  /** Joins facet i of t to the same one in `open`, which leaves it. If there is none, it is added. */
  void Join(std::uint32_t t, unsigned i, std::vector<OpenFacet>& open);

  /** The index of v in t; v must be a vertex of t. */
  unsigned IndexOf(std::uint32_t t, std::uint32_t v) const
  {
    const Vertices& w = this->Cells[t].V;
    unsigned i = 0;
    while (i < D && w[i] != v)
    {
      ++i;
    }
    return i;
  }

  double Score(const Vertices& v) const
  {
    return std::apply([this](const auto&... p) { return this->Shape(*p...); }, this->PointsOf(v));
  }
  bool IsPoor(std::uint32_t t) const
  {
    return this->IsAlive(t) && this->Scores[t] < this->Goal && this->Labels[t] != 0;
  }

  /** The vertices of facet i, sorted. */
  static Facet SortedFacet(const Vertices& v, unsigned i)
  {
    Facet f;
    for (unsigned k = 0; k < D; ++k)
    {
      unsigned place = k;
      const std::uint32_t next = v[k < i ? k : k + 1];
      for (; place > 0 && f[place - 1] > next; --place)
      {
        f[place] = f[place - 1];
      }
      f[place] = next;
    }
    return f;
  }

  /**
   * Gathers the cells around v that facets lead to from one of them.
   * @param mayHave mayHave(t) says whether the search goes on with the cell t
   * @return false if one was refused. The star is whole if it has Degrees[v] cells.
   */
  template <typename Function>
  bool GatherStar(std::uint32_t v, VertexStar<D>& star, const Function& mayHave) const;

  /** The vertex at the other end of a periodic mesh; None if there is none. */
  std::uint32_t TwinOf(std::uint32_t v) const
  {
    return this->Twins.empty() ? None : this->Twins[v];
  }

  /** Whether no component is lost if v, a vertex of t, moves. */
  bool KeepsComponents(std::uint32_t t, std::uint32_t v, const Point<D>& to) const;
  /** The label id in the image. */
  LabelId LabelInImage(Label label) const { return this->Guard->LabelOf(this->LabelValues[label]); }

  ShapeFunction Shape;
  ScoreValue Goal = 1; ///< cells with a lower score are poor
  UninitialisedVector<Point<D>> Points;
  /**
   * By vertex. Changes of connectivity need not update the kinds. If Flips brings an interface
   * triangle to a vertex, the vertex already has one between the same two labels, and on the same
   * faces where the image cuts the object. So a vertex can only become freer than its kind; then it
   * keeps its kind.
   */
  std::vector<VertexRole> Kinds;
  std::vector<std::uint8_t>
    BorderFaces; ///< Domain::BorderFaces by vertex; empty if the image cuts nothing
  std::vector<std::uint32_t> Hosts;   ///< a cell of each vertex
  std::vector<std::uint32_t> Degrees; ///< number of cells of each vertex
  std::vector<std::uint32_t> Changes; ///< the clock when a cell of each vertex changed last
  std::vector<std::uint32_t> Twins;   ///< of each vertex; empty if there are none
  UninitialisedVector<Cell> Cells;
  UninitialisedVector<Label> Labels;
  UninitialisedVector<ScoreValue> Scores; ///< of background: the least volume that it keeps
  std::vector<std::int64_t> LabelValues;
  const ComponentGuard<D>* Guard = nullptr; ///< is asked before a holder changes; null: none does
  std::vector<std::uint8_t> AreHolders;     ///< by cell; empty if there are none

private:
  void FindLabels(const SimplexMesh<D>& mesh, unsigned threads, const std::stop_token& stop);
  void CopyCells(const SimplexMesh<D>& mesh, const Surroundings<D>& outside, unsigned threads,
    const std::stop_token& stop);
  void ScoreCells(unsigned threads, const std::stop_token& stop);
  void Connect(unsigned threads, const std::stop_token& stop);
  void FindKinds(unsigned threads, const std::stop_token& stop);
  UninitialisedVector<std::uint32_t> WritePoints(
    SimplexMesh<D>& mesh, unsigned threads, const std::stop_token& stop) const;

  std::size_t FirstOutside; ///< of the points
  std::size_t EndOfOutside;
};

using TetrahedralComplex = Complex<3>;
using PentatopeComplex = Complex<4>;

/**
 * The vertices of a positively oriented cell, v[first] first, in an order that keeps the orientation.
 */
template <std::size_t N>
std::array<std::uint32_t, N> StartingAt(const std::array<std::uint32_t, N>& v, unsigned first)
{
  if (first == 0)
  {
    return v;
  }
  if constexpr (N == 4)
  {
    return first == 1 ? std::array{ v[1], v[0], v[3], v[2] }
      : first == 2    ? std::array{ v[2], v[0], v[1], v[3] }
                      : std::array{ v[3], v[0], v[2], v[1] };
  }
  else
  {
    std::array<std::uint32_t, N> w = v;
    std::swap(w[0], w[first]);
    std::swap(w[first == 1 ? 2 : 1], w[first == 3 ? 4 : 3]);
    return w;
  }
}

template <int D>
template <typename Function>
bool Complex<D>::GatherStar(std::uint32_t v, VertexStar<D>& star, const Function& mayHave) const
{
  if (!mayHave(this->Hosts[v]))
  {
    return false;
  }
  star.Vertex = v;
  star.Cells.assign({ this->Hosts[v] });
  star.Corners.clear();
  star.Seen.Clear();
  star.Seen.Insert(this->Hosts[v]);
  for (std::size_t k = 0; k < star.Cells.size(); ++k)
  {
    const Cell& cell = this->Cells[star.Cells[k]];
    const unsigned own = this->IndexOf(star.Cells[k], v);
    star.Corners.push_back(StartingAt(cell.V, own));
    for (unsigned i = 0; i < Corners; ++i)
    {
      if (i == own || cell.N[i] == None || !star.Seen.Insert(cell.N[i]))
      {
        continue;
      }
      if (!mayHave(cell.N[i]))
      {
        return false;
      }
      star.Cells.push_back(cell.N[i]);
    }
  }
  return true;
}

extern template class Complex<3>;
extern template class Complex<4>;

} // namespace voxplex

#endif
