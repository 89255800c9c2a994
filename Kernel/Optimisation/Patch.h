// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Patch.h
 * @brief The part of a complex that one thread may change, and the changes themselves.
 */
#ifndef voxplex_Patch_h
#define voxplex_Patch_h

#include "Optimisation/TetrahedralComplex.h"

#include <array>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

namespace voxplex
{

/** The tetrahedra around an edge ab: (a, b, Link[k], Link[k + 1]) is Cells[k], positively oriented. */
struct EdgeRing
{
  std::uint32_t A = 0;
  std::uint32_t B = 0;
  bool Closed = false; ///< then Link[0] follows on the last vertex; else the mesh ends at both ends
  std::vector<std::uint32_t> Link;
  std::vector<std::uint32_t> Cells; ///< as many as Link, one fewer if not closed
};

/** The tetrahedra around a vertex. */
struct VertexStar
{
  std::uint32_t Vertex = 0;
  std::vector<std::uint32_t> Cells;
  /** Of each cell its vertices, Vertex first, positively oriented. */
  std::vector<TetrahedralComplex::Vertices> Corners;
};

/** A tetrahedron to be. */
struct NewTetrahedron
{
  TetrahedralComplex::Vertices V;
  TetrahedralComplex::Label Label;
};

/**
 * @brief Changes a block of a complex: all tetrahedra whose four vertices are in the block.
 *
 * Every vertex belongs to one block. A facet has vertices of its own block only or is in no block, and
 * the entry for it in N of the tetrahedra beside it is read and written by its block's patch alone: facets
 * are found by their vertices, never by looking for an id in N. V, labels and scores of a tetrahedron are
 * written only by the block that has all four vertices. So patches of different blocks can work
 * at the same time without locks, and what each does depends on its own block only.
 *
 * Not thread-safe by itself: one thread uses a patch.
 */
class Patch
{
public:
  static constexpr std::uint32_t None = TetrahedralComplex::None;

  /**
   * @param blocks of each vertex
   * @param block which one this may change
   */
  Patch(TetrahedralComplex& complex, std::span<const std::uint32_t> blocks, std::uint32_t block)
    : Complex(complex)
    , Blocks(blocks)
    , Block(block)
  {
  }

  const TetrahedralComplex& Mesh() const { return this->Complex; }

  bool Owns(std::uint32_t v) const { return this->Blocks[v] == this->Block; }
  bool OwnsAll(const TetrahedralComplex::Vertices& v) const
  {
    return this->Owns(v[0]) && this->Owns(v[1]) && this->Owns(v[2]) && this->Owns(v[3]);
  }

  /** Whether t may become another tetrahedron, or none. */
  bool MayChange(std::uint32_t t) const
  {
    return this->OwnsAll(this->Complex.Cells[t].V) && !this->Complex.IsKept(t);
  }

  /**
   * The star of v.
   * @return false if part of it may not change, or if it falls apart in pieces that share no facet and
   * FindStars() has not found it
   */
  bool GatherStar(std::uint32_t v, VertexStar& star);

  /**
   * The tetrahedra around the edge from vertex i to vertex j of t.
   * @return false if there are more than `most` of them, or if part of it may not change. If
   * the edge is on the mesh's boundary in more than one place, only the part with t is found.
   */
  bool GatherRing(std::uint32_t t, unsigned i, unsigned j, std::size_t most, EdgeRing& ring) const;

  /**
   * Deletes tetrahedra and puts others in their place. Facets of neither what is new nor
   * what stays become the mesh's boundary where only one tetrahedron has them.
   * @return false, with nothing changed, if there are no slots left
   */
  bool Replace(std::span<const std::uint32_t> old, std::span<const NewTetrahedron> fresh);

  /** Moves the vertex of a star, whose scores become `scores`. */
  void Move(const VertexStar& star, const Point<3>& to, std::span<const float> scores);

  /** Slots of dead tetrahedra that new ones may take, the last one first. */
  void SetSlots(std::vector<std::uint32_t> slots) { this->FreeSlots = std::move(slots); }
  /** Gives the slots back that are left. */
  std::vector<std::uint32_t> TakeSlots() { return std::exchange(this->FreeSlots, {}); }

  /**
   * Finds the stars of some vertices by looking at all tetrahedra, for GatherStar() to use where a star falls
   * apart in pieces; until a change around such a vertex. Only for the patch of a whole complex.
   */
  void FindStars(std::span<const std::uint32_t> vertices);

  /** A vertex that no tetrahedron has, in this block; None if there is none left. */
  std::uint32_t SpareVertex() const
  {
    return this->NextSpare < this->LastSpare ? this->NextSpare : None;
  }
  /** Puts the spare vertex, as one inside a label, where a tetrahedron is about to have it. */
  void PlaceVertex(std::uint32_t v, const Point<3>& p)
  {
    this->Complex.Points[v] = p;
    this->Complex.Kinds[v] = VertexRole::Free;
  }
  /** Makes the spare vertex one of the mesh. */
  void KeepVertex() { ++this->NextSpare; }
  /** Vertices without tetrahedra that insertions may use; they must be of this block. */
  void SetSpareVertices(std::uint32_t first, std::uint32_t last)
  {
    this->NextSpare = first;
    this->LastSpare = last;
  }

  /** Gives a tetrahedron another label, not background. */
  void Relabel(std::uint32_t t, TetrahedralComplex::Label label)
  {
    this->Complex.Labels[t] = label;
  }

  /** Tetrahedra with a score below 1 that changes left, some of them gone since. */
  std::vector<std::uint32_t> Poor;

  /** Counts changes; TetrahedralComplex::Changes refers to it. */
  std::uint32_t Clock = 0;

private:
  bool UseFoundStar(VertexStar& star) const;

  /** A facet of the hole or of what fills it, sorted. */
  struct OpenFacet
  {
    std::array<std::uint32_t, 3> V;
    std::uint32_t Cell;
    unsigned Index;
  };

  void Touch(const TetrahedralComplex::Vertices& v);

  TetrahedralComplex& Complex;
  std::span<const std::uint32_t> Blocks;
  std::uint32_t Block;
  std::vector<std::uint32_t> FreeSlots;
  std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> FoundStars;
  std::uint32_t NextSpare = 0;
  std::uint32_t LastSpare = 0;
  std::vector<OpenFacet> Open;
};

} // namespace voxplex

#endif
