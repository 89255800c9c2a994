// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PutRight.h
 * @brief Makes a mesh of another program what SimplexMesh promises.
 */
#ifndef voxplex_PutRight_h
#define voxplex_PutRight_h

#include "Mesh/SimplexMesh.h"

#include <cstdint>
#include <vector>

namespace voxplex
{

struct MeshChanges
{
  std::uint64_t Turned = 0; ///< simplices that were inverted
  /** The former number of each point. Empty if simplices use all points: none has another number. */
  std::vector<std::uint32_t> Points;

  bool IsNone() const { return this->Turned == 0 && this->Points.empty(); }
};

/**
 * Turns inverted simplices round: their last two points change places. Points that no simplex uses
 * are left out; the others keep their order. Facets, Slabs and Twins stay as they are.
 *
 * O(n log n).
 * @throws InputError if a simplex has no volume but roundings, or if two have the same points. The
 *   message has their number and the first one.
 */
template <int D>
MeshChanges PutRight(SimplexMesh<D>& mesh);

extern template MeshChanges PutRight<3>(SimplexMesh<3>&);
extern template MeshChanges PutRight<4>(SimplexMesh<4>&);

} // namespace voxplex

#endif
