// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ComponentPieces.h
 * @brief The parts of a mesh that hang together through faces, and the components they belong to.
 */
#ifndef voxplex_ComponentPieces_h
#define voxplex_ComponentPieces_h

#include "Base/DisjointSets.h"
#include "Image/Components.h"
#include "Mesh/LabelledCells.h"
#include "Mesh/LabelledTriangulation.h"
#include "Mesh/SimplexMesh.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <stop_token>
#include <utility>
#include <vector>

namespace voxplex
{

/**
 * The pieces of each label: maximal sets of its elements that are connected through faces (4D: through
 * tetrahedra). A finite-element model of a label holds together if it has one. Each set is named by its
 * first element.
 *
 * Takes time linear in the number of elements.
 *
 * @param elements LabelledTriangulation or LabelledCells
 * @param threads 0 means all cores; the result does not depend on it
 * @throws Cancelled if a stop was requested before the end; std::bad_alloc
 */
template <typename Elements>
DisjointSets FindPieces(
  const Elements& elements, unsigned threads = 1, const std::stop_token& stop = {});

/**
 * The number of pieces of each label value. Neighbours are found by their vertices, in linear time and with
 * 48 bytes for each element, if few elements share a point. For the rest, see FindPieces().
 */
std::map<std::int64_t, std::uint64_t> CountFragments(
  const SimplexMesh<3>& mesh, const std::stop_token& stop = {});

/** How the shares of a piece are found (ComponentPieces). */
enum class PieceShares
{
  OfAll, ///< from all of its elements
  OfSome ///< if it is large, from 1,024 or more of them: enough to tell which component has the largest
};

/**
 * @brief The pieces of a mesh, and the connected components of the image that they are parts of.
 *
 * If a label has one component, its pieces belong to it. Otherwise a piece has a share of each component
 * that has the centroid of one of its elements in its voxels: the volume of these elements. It
 * belongs to the component with the largest share. If there is none, it belongs to the first one beside
 * its first elements.
 *
 * Pieces are numbered from 0 in the order of their first elements. Not thread safe.
 */
template <int D>
class ComponentPieces
{
public:
  struct Piece
  {
    LabelId Label = 0;
    std::uint32_t Component = None;
    std::size_t Size = 0;  ///< elements
    std::size_t First = 0; ///< element
    /** Components and their shares; empty if the label has one. */
    std::vector<std::pair<std::uint32_t, double>> Shares = {};
  };

  /**
   * Takes time linear in the number of elements, and memory of 8 bytes for each.
   * For the rest, see FindPieces().
   */
  template <typename Elements>
  ComponentPieces(const Elements& elements, const Components<D>& components,
    const LabelImage<D>& image, PieceShares shares = PieceShares::OfAll, unsigned threads = 1,
    const std::stop_token& stop = {});

  const std::vector<Piece>& All() const { return this->List; }

  /** The piece of an element; None if it is outside of all labels. */
  std::uint32_t Of(std::size_t element) const { return this->Numbers[element]; }
  std::size_t NumberOfElements() const { return this->Numbers.size(); }

  /** Tells that an element is part of a piece now. Volumes and shares stay as they are. */
  void Move(std::size_t element, std::uint32_t piece) { this->Numbers[element] = piece; }

private:
  std::vector<std::uint32_t> Numbers; ///< by element
  std::vector<Piece> List;
};

} // namespace voxplex

#endif
