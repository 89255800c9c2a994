// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Patch.h
 * @brief The part of a complex that one thread may change, and the changes themselves.
 */
#ifndef voxplex_Patch_h
#define voxplex_Patch_h

#include "Mesh/RidgeRing.h"
#include "Optimisation/Complex.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stop_token>
#include <unordered_map>
#include <utility>
#include <vector>

namespace voxplex
{

/** The tetrahedra around an edge ab: (a, b, Link[k], Link[k + 1]) is Cells[k], positively oriented. */
struct EdgeRing : RidgeRing
{
  std::uint32_t A = 0;
  std::uint32_t B = 0;
};

/** A cell to be made. */
template <int D>
struct NewCell
{
  typename Complex<D>::Vertices V;
  typename Complex<D>::Label Label;
};

/**
 * @brief Changes a block of a complex: all cells whose vertices are all in the block.
 *
 * Every vertex belongs to one block. A facet belongs to a block if all its vertices do; otherwise
 * it belongs to no block. Only the patch of its block reads and writes the entries for a facet in N
 * of the cells beside it: facets are found by their vertices, never by searching for an id in
 * N. V, label and score of a cell are written only by the block that has all its vertices.
 * So patches of different blocks can work at the same time without locks, and the result of each
 * depends on its own block only.
 *
 * Not thread-safe by itself: one thread uses a patch.
 */
template <int D>
class Patch
{
public:
  using Vertices = typename Complex<D>::Vertices;

  /**
   * @param blocks the block of each vertex; empty: all are in this one
   * @param block the block that this patch may change
   */
  Patch(Complex<D>& complex, std::span<const std::uint32_t> blocks, std::uint32_t block)
    : Target(complex)
    , Blocks(blocks)
    , Block(block)
  {
  }

  const Complex<D>& Mesh() const { return this->Target; }

  /** Whether a vertex is in the block. */
  bool Has(std::uint32_t v) const { return this->Blocks.empty() || this->Blocks[v] == this->Block; }

  /** Whether t may be changed or deleted. */
  bool MayChange(std::uint32_t t) const
  {
    const Vertices& v = this->Target.Cells[t].V;
    return std::all_of(v.begin(), v.end(), [this](std::uint32_t w) { return this->Has(w); });
  }

  /**
   * Gathers the star of v.
   * @return false if a part of the star may not change; or if the star consists of pieces that
   *   share no facet, and FindStars() has not found it
   */
  bool GatherStar(std::uint32_t v, VertexStar<D>& star) const;

  /**
   * Replaces cells by others. A facet becomes a boundary facet of the complex if only one cell has it
   * afterwards.
   * @return false, with nothing changed, if there are no slots left, or a component would be lost
   */
  bool Replace(std::span<const std::uint32_t> old, std::span<const NewCell<D>> fresh);

  /**
   * Moves a vertex, and its twin, whose time stays.
   * @param cells of the object that are around both, whose scores become `scores`
   * @return false, with nothing changed, if a component would be lost
   */
  bool Move(std::uint32_t v, const Point<D>& to, std::span<const std::uint32_t> cells,
    std::span<const typename Complex<D>::ScoreValue> scores);

  /** Sets the slots of dead cells that new ones may take, the last one first. */
  void SetSlots(std::vector<std::uint32_t> slots) { this->FreeSlots = std::move(slots); }
  /** Returns the slots that are left. */
  std::vector<std::uint32_t> TakeSlots() { return std::exchange(this->FreeSlots, {}); }
  /** Makes more slots if there are fewer. Only for the patch of a whole complex. */
  void NeedSlots(std::size_t number);

  /**
   * Finds the stars of some vertices by searching all cells. GatherStar() uses them if a star
   * consists of pieces that share no facet. A found star is valid until a change around its vertex.
   * Only for the patch of a whole complex.
   */
  void FindStars(std::span<const std::uint32_t> vertices, unsigned threads = 1,
    const std::stop_token& stop = {});

  /** An unused vertex of this block; None if there is none left. */
  std::uint32_t SpareVertex() const
  {
    return this->NextSpare < this->LastSpare ? this->NextSpare : Complex<D>::None;
  }
  /** Sets the position of the spare vertex and makes it free (inside of a label), before use. */
  void PlaceVertex(std::uint32_t v, const Point<D>& p)
  {
    this->Target.Points[v] = p;
    this->Target.Kinds[v] = VertexRole::Free;
  }
  /** Makes the spare vertex a vertex of the mesh. */
  void KeepVertex() { ++this->NextSpare; }
  /** Sets the unused vertices that insertions may use. They must be in this block. */
  void SetSpareVertices(std::uint32_t first, std::uint32_t last)
  {
    this->NextSpare = first;
    this->LastSpare = last;
  }

  /** Poor cells that changes made. Some may have been deleted since. */
  std::vector<std::uint32_t> Poor;

  /** Counts changes; Complex::Changes refers to it. */
  std::uint32_t Clock = 0;

private:
  bool UseFoundStar(VertexStar<D>& star) const;

  void Touch(const Vertices& v);
  bool FindNextHolders(std::span<const std::uint32_t> old, std::span<const NewCell<D>> fresh);

  Complex<D>& Target;
  std::span<const std::uint32_t> Blocks;
  std::uint32_t Block;
  std::vector<std::uint32_t> FreeSlots;
  std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> FoundStars;
  std::uint32_t NextSpare = 0;
  std::uint32_t LastSpare = 0;
  std::vector<typename Complex<D>::OpenFacet> Open; ///< of the hole and of new cells
  std::vector<std::uint8_t> NextHolders;            ///< of the new cells of a Replace()
};

extern template class Patch<3>;
extern template class Patch<4>;

/**
 * Gathers the tetrahedra around the edge from vertex i to vertex j of t. If the edge is on the
 * mesh's boundary in more than one place, only the part with t is found.
 * @return false if there are more than `most` tetrahedra, or if some may not change
 */
bool GatherRing(
  const Patch<3>& patch, std::uint32_t t, unsigned i, unsigned j, std::size_t most, EdgeRing& ring);

} // namespace voxplex

#endif
