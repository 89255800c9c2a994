// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Complex.h
 * @brief The labelled mesh after refinement, which the fit, opening and optimisation change.
 */
#ifndef voxplex_Complex_h
#define voxplex_Complex_h

#include "Base/UninitialisedVector.h"
#include "Delaunay/Triangulation.h"
#include "Domain/Domain.h"
#include "Mesh/LabelledCells.h"
#include "Mesh/SimplexMesh.h"
#include "Optimisation/ComponentGuard.h"
#include "Optimisation/PentatopeShape.h"
#include "Optimisation/ShapeScore.h"

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
  Crease,  ///< as Surface, but on an edge of a cut face
  Fixed    ///< where three or more labels meet
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
 * @brief The one mesh after refinement: cells that know their neighbours, and their labels. It is made from
 * a labelled triangulation, changed in place (FitInterfaces(), OpenRidges(), OptimiseMesh(),
 * OptimisePentatopes()), and written once.
 *
 * The cells are the simplices of the object, which have a label, and those around it, with label 0, which
 * have a vertex of it. The star of each vertex of the object is whole. Slots of deleted cells have
 * V[0] == None. N[i] is None where the triangulation ends, or the cells around the object do.
 *
 * Threads may change disjoint blocks of the complex at the same time: see Patch.
 */
template <int D>
class Complex
{
public:
  static constexpr std::uint32_t None = 0xffffffffu;
  static constexpr unsigned Corners = D + 1;
  using Cell = voxplex::Cell<D>;
  using Vertices = typename Cell::Corners;
  using Facet = std::array<std::uint32_t, static_cast<std::size_t>(D)>;
  using Label = LabelId;
  using ShapeFunction = std::conditional_t<D == 3, ShapeScore, PentatopeScore>;
  using ScoreValue = std::conditional_t<D == 3, float, double>;

  /** A facet whose neighbour is not known, vertices sorted. */
  struct OpenFacet
  {
    Facet V;
    std::uint32_t Cell;
    unsigned Index;
  };

  Complex() = default;

  /**
   * Cells and vertices get the numbers that Compact() gives. No thread may change the triangulation
   * meanwhile. O(n) time for n simplices. The result does not depend on the number of threads.
   *
   * @param labels of each simplex id
   * @param twins pairs of vertices at the ends of a periodic mesh
   * @param numbers receives the number of each vertex id; None if the complex does not have it
   * @param threads 0 means all cores
   * @throws Cancelled if a stop was requested before the end; std::bad_alloc
   */
  Complex(const Triangulation<D>& triangulation, std::span<const LabelId> labels,
    std::span<const std::array<VertexId, 2>> twins, UninitialisedVector<std::uint32_t>& numbers,
    unsigned threads = 1, const std::stop_token& stop = {});

  /** From cells that are known, all of them in use. */
  Complex(UninitialisedVector<Point<D>> points, UninitialisedVector<Cell> cells,
    UninitialisedVector<Label> labels, unsigned threads = 1, const std::stop_token& stop = {});

  /**
   * Removes dead cells and unused vertices, and those around the object if they are not to be kept. Numbers
   * the object first. Otherwise cells and vertices keep their order. What FindKinds(), ScoreCells() and
   * Protect() have found is lost.
   */
  void Compact(bool keepsOutside, unsigned threads = 1, const std::stop_token& stop = {});

  /** Finds the kinds of vertices. To be called before optimisation. Linear time. */
  void FindKinds(unsigned threads = 1, const std::stop_token& stop = {});

  /**
   * Finds the vertices on cut faces. After FindKinds(), if the complex has no
   * cells around the object.
   */
  void FindBorderFaces(const Domain<D>& domain);

  /** Scores all cells. */
  void ScoreCells(unsigned threads = 1, const std::stop_token& stop = {});

  /**
   * No change loses a component from now on. All cells must be alive. Null: none is protected.
   * @param guard must outlive the changes
   */
  void Protect(ComponentGuard<D>* guard, unsigned threads = 1, const std::stop_token& stop = {});

  /**
   * Writes the mesh: all but Slabs. The complex must be compact, without cells around the object. It is
   * empty afterwards.
   * @param values of the label ids in the image; that of background is 0
   * @param mesh its old contents are lost
   */
  void Write(std::span<const std::int64_t> values, SimplexMesh<D>& mesh, unsigned threads = 1,
    const std::stop_token& stop = {});

  /** Adds slots for more cells. They are not alive. */
  void AddCells(std::size_t number);
  /** Adds unused vertices. */
  void AddVertices(std::size_t number);

  /** The cells with their labels. All must be alive. */
  LabelledCells<D> Elements() const { return { this->Points, this->Cells, this->Labels }; }
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
  ShapeFunction Shape{};
  ScoreValue Goal = 1; ///< cells with a lower score are poor
  UninitialisedVector<Point<D>> Points;
  /**
   * By vertex. Changes of connectivity need not update the kinds. If Flips brings an interface
   * triangle to a vertex, the vertex already has one between the same two labels, and on the same
   * cut faces. So a vertex can only become freer than its kind; then it
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
  UninitialisedVector<ScoreValue> Scores;   ///< of background: the least volume that it keeps
  const ComponentGuard<D>* Guard = nullptr; ///< is asked before a holder changes; null: none does
  std::vector<std::uint8_t> AreHolders;     ///< by cell; empty if there are none

private:
  template <typename Source>
  UninitialisedVector<std::uint32_t> Copy(
    const Source& source, bool withOutside, unsigned threads, const std::stop_token& stop);
  void FindHosts(unsigned threads, const std::stop_token& stop);
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
