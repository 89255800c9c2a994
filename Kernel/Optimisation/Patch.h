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
#include <stop_token>
#include <unordered_map>
#include <utility>
#include <vector>

namespace voxplex
{

/**
 * The tetrahedra around an edge ab: (a, b, Link[k], Link[k + 1]) is Cells[k], positively oriented.
 */
struct EdgeRing
{
  std::uint32_t A = 0;
  std::uint32_t B = 0;
  bool Closed = false; ///< true: Link[0] follows the last vertex; false: the mesh ends at both ends
  std::vector<std::uint32_t> Link;
  std::vector<std::uint32_t> Cells; ///< as long as Link; one shorter if not closed
};

/** The tetrahedra around a vertex. */
struct VertexStar
{
  std::uint32_t Vertex = 0;
  std::vector<std::uint32_t> Cells;
  /** The vertices of each cell, Vertex first, positively oriented. */
  std::vector<TetrahedralComplex::Vertices> Corners;
};

/** A tetrahedron to be made. */
struct NewTetrahedron
{
  TetrahedralComplex::Vertices V;
  TetrahedralComplex::Label Label;
};

/**
 * @brief Changes a block of a complex: all tetrahedra whose four vertices are in the block.
 *
 * Every vertex belongs to one block. A facet belongs to a block if all its vertices do; otherwise
 * it belongs to no block. Only the patch of its block reads and writes the entries for a facet in N
 * of the tetrahedra beside it: facets are found by their vertices, never by searching for an id in
 * N. V, label and score of a tetrahedron are written only by the block that has all four vertices.
 * So patches of different blocks can work at the same time without locks, and the result of each
 * depends on its own block only.
 *
 * Not thread-safe by itself: one thread uses a patch.
 */
class Patch
{
public:
  static constexpr std::uint32_t None = TetrahedralComplex::None;

  /**
   * @param blocks the block of each vertex
   * @param block the block that this patch may change
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

  /** Whether t may be changed or deleted. */
  bool MayChange(std::uint32_t t) const { return this->OwnsAll(this->Complex.Cells[t].V); }

  /**
   * Gathers the star of v.
   * @return false if a part of the star may not change; or if the star consists of pieces that
   *   share no facet, and FindStars() has not found it
   */
  bool GatherStar(std::uint32_t v, VertexStar& star);

  /**
   * Gathers the tetrahedra around the edge from vertex i to vertex j of t. If the edge is on the
   * mesh's boundary in more than one place, only the part with t is found.
   * @return false if there are more than `most` tetrahedra, or if some may not change
   */
  bool GatherRing(std::uint32_t t, unsigned i, unsigned j, std::size_t most, EdgeRing& ring) const;

  /**
   * Replaces tetrahedra by others. A facet becomes a boundary facet of the mesh if only one
   * tetrahedron has it afterwards.
   * @return false, with nothing changed, if there are no slots left, or a component would be lost
   */
  bool Replace(std::span<const std::uint32_t> old, std::span<const NewTetrahedron> fresh);

  /**
   * Moves the vertex of a star. The scores of the star become `scores`.
   * @return false, with nothing changed, if a component would be lost
   */
  bool Move(const VertexStar& star, const Point<3>& to, std::span<const float> scores);

  /** Sets the slots of dead tetrahedra that new ones may take, the last one first. */
  void SetSlots(std::vector<std::uint32_t> slots) { this->FreeSlots = std::move(slots); }
  /** Returns the slots that are left. */
  std::vector<std::uint32_t> TakeSlots() { return std::exchange(this->FreeSlots, {}); }

  /**
   * Finds the stars of some vertices by searching all tetrahedra. GatherStar() uses them if a star
   * consists of pieces that share no facet. A found star is valid until a change around its vertex.
   * Only for the patch of a whole complex.
   */
  void FindStars(std::span<const std::uint32_t> vertices, unsigned threads = 1,
    const std::stop_token& stop = {});

  /** An unused vertex of this block; None if there is none left. */
  std::uint32_t SpareVertex() const
  {
    return this->NextSpare < this->LastSpare ? this->NextSpare : None;
  }
  /** Sets the position of the spare vertex and makes it free (inside of a label), before use. */
  void PlaceVertex(std::uint32_t v, const Point<3>& p)
  {
    this->Complex.Points[v] = p;
    this->Complex.Kinds[v] = VertexRole::Free;
  }
  /** Makes the spare vertex a vertex of the mesh. */
  void KeepVertex() { ++this->NextSpare; }
  /** Sets the unused vertices that insertions may use. They must be in this block. */
  void SetSpareVertices(std::uint32_t first, std::uint32_t last)
  {
    this->NextSpare = first;
    this->LastSpare = last;
  }

  /** Tetrahedra that changes left with a score below 1. Some may have been deleted since. */
  std::vector<std::uint32_t> Poor;

  /** Counts changes; TetrahedralComplex::Changes refers to it. */
  std::uint32_t Clock = 0;

private:
  bool UseFoundStar(VertexStar& star) const;

  /** A facet of the hole or of a new tetrahedron, vertices sorted. */
  struct OpenFacet
  {
    std::array<std::uint32_t, 3> V;
    std::uint32_t Cell;
    unsigned Index;
  };

  void Touch(const TetrahedralComplex::Vertices& v);
  ComponentGuard<3>::Corners CornersOf(const TetrahedralComplex::Vertices& v) const;
  LabelId LabelInImage(TetrahedralComplex::Label label) const;
  bool FindNextHolders(std::span<const std::uint32_t> old, std::span<const NewTetrahedron> fresh);

  TetrahedralComplex& Complex;
  std::span<const std::uint32_t> Blocks;
  std::uint32_t Block;
  std::vector<std::uint32_t> FreeSlots;
  std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> FoundStars;
  std::uint32_t NextSpare = 0;
  std::uint32_t LastSpare = 0;
  std::vector<OpenFacet> Open;
  std::vector<std::uint8_t> NextHolders; ///< of the new tetrahedra of a Replace()
};

} // namespace voxplex

#endif
