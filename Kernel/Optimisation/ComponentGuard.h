// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ComponentGuard.h
 * @brief Tells whether a change of a mesh would lose a component of the image.
 */
#ifndef voxplex_ComponentGuard_h
#define voxplex_ComponentGuard_h

#include "Image/Components.h"
#include "Mesh/LabelledCells.h"
#include "Quality/ElementVoxels.h"

#include <array>
#include <cstdint>
#include <span>
#include <stop_token>
#include <utility>
#include <vector>

namespace voxplex
{

/**
 * @brief Keeps changes of a mesh from losing components, as FindLostComponents() sees them.
 *
 * Each guarded component has a *holder*: an element that keeps it from being lost. Before a change
 * replaces a holder, or moves one of its vertices, Keeps() says whether one of the new elements can
 * be the next one. Components with very many elements are not guarded: no change loses all of them.
 *
 * Whether a change is allowed depends on the elements that it changes alone, so threads may ask
 * about different parts of a mesh at the same time, and the result does not depend on their number.
 *
 * Complexity: FindHolders() is linear in the number of elements; Keeps() takes some hundred
 * nanoseconds for each element, and is asked about holders only.
 */
template <int D>
class ComponentGuard
{
public:
  using Corners = typename ElementVoxels<D>::Corners;

  /** Guards nothing. @param image must outlive this object */
  explicit ComponentGuard(const LabelImage<D>& image)
    : Image(image)
  {
  }

  /**
   * @param components of the image, or of its frames; must outlive this object
   * @param wanted the components to guard (Components::FindWanted)
   */
  void Add(const Components<D>& components, std::vector<bool> wanted)
  {
    this->Sets.push_back({ components, std::move(wanted), {}, {}, { components, this->Image } });
  }

  /**
   * Chooses the components to guard, and their holders. Components without an element are lost
   * already, and not guarded.
   * @param threads 0 means all cores; the result does not depend on it
   * @return for each element 1 if it is a holder, or else 0; empty if nothing is guarded
   * @throws Cancelled if a stop was requested before the end; std::bad_alloc
   */
  std::vector<std::uint8_t> FindHolders(
    const LabelledCells<D>& elements, unsigned threads, const std::stop_token& stop = {});

  /**
   * Whether new elements hold all guarded components that an old one may hold.
   * @param label of them all; 0 is held by nothing
   * @param areHolders of the new elements; receives 1 for those that are the next holders
   */
  bool Keeps(LabelId label, const Corners& before, std::span<const Corners> after,
    std::span<std::uint8_t> areHolders) const;

  /** The same for one element that changes its shape. */
  bool Keeps(LabelId label, const Corners& before, const Corners& after) const
  {
    std::uint8_t isHolder = 0;
    return this->Keeps(label, before, { &after, 1 }, { &isHolder, 1 });
  }

private:
  struct Set
  {
    const Components<D>& All;
    std::vector<bool> Wanted;
    std::vector<bool> Guarded;
    std::vector<bool> IsBeside; ///< whether the first holder has its centroid beside it, not in it
    ElementVoxels<D> Voxels;
  };

  const LabelImage<D>& Image;
  std::vector<Set> Sets;
};

extern template class ComponentGuard<3>;
extern template class ComponentGuard<4>;

} // namespace voxplex

#endif
