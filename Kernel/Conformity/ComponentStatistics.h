// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ComponentStatistics.h
 * @brief What became of the components of the image.
 */
#ifndef voxplex_ComponentStatistics_h
#define voxplex_ComponentStatistics_h

#include "Image/DropComponents.h"

#include <array>
#include <cstdint>
#include <vector>

namespace voxplex
{

/** A connected component of the image whose elements are not all connected through faces. */
struct BrokenComponent
{
  ComponentReport Component;
  std::uint64_t Fragments = 0;
  double Largest = 0.0; ///< the part of its volume in the mesh that the largest fragment has
};

/** Components of one label that do not touch in the image, but whose elements are one piece. */
struct UnitedComponents
{
  ComponentReport Component; ///< the smallest of them, but for those that touch the first
  std::uint64_t Number = 0;  ///< of sets of components that do not touch
};

/** An interface of the mesh between two labels that do not touch near it in the image. */
struct FalseContact
{
  std::array<std::int64_t, 2> Labels{}; ///< values, the larger first; 0 is background
  std::uint64_t Facets = 0;
  double Area = 0.0;               ///< in 4D, volume
  std::vector<std::int64_t> Voxel; ///< the index of one at its largest facet, in the whole image
};

struct ComponentStatistics
{
  std::uint64_t Found = 0;           ///< components of all labels; 0 if none were looked for
  std::uint64_t Seeds = 0;           ///< feature points inserted for small or thin ones, at most
  unsigned Rounds = 0;               ///< times refinement was resumed for lost or broken ones
  std::vector<ComponentReport> Lost; ///< components that have no element
  ///@{
  /** Where the topology of the mesh is not that of the image (MeshTopology.h). The worst come first. */
  std::vector<BrokenComponent> Broken;
  std::vector<UnitedComponents> United;
  std::vector<FalseContact> Contacts;
  ///@}
};

} // namespace voxplex

#endif
