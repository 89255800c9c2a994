// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BuriedVoxels.h
 * @brief Finds the voxels of tips that smoothing takes away.
 */
#ifndef voxplex_BuriedVoxels_h
#define voxplex_BuriedVoxels_h

#include "Image/LabelImage.h"

#include <cstdint>
#include <span>
#include <stop_token>
#include <vector>

namespace voxplex
{

/**
 * @brief A voxel whose own label hardly wins after smoothing.
 *
 * There may be several of one voxel, since tiles share samples.
 */
struct WeakVoxel
{
  std::uint64_t Sample; ///< number of its sample in the lattice (TiledLattice), first axis fastest
  bool IsLost;          ///< another label would win
};

/**
 * Finds the tips of processes, and the ends of slots in other labels, that are two voxels wide or
 * irregular, so that smoothing takes more than a voxel away. A lost voxel is *buried* if all voxels
 * around it that have its label are weak, too.
 *
 * @param weak all weak voxels of the lattice, in any order
 * @param threads 0 means all cores; the result does not depend on it
 * @return the buried voxels, and the voxels of their labels around them: indices of the lattice,
 *   ascending. The lattice is the crop and one layer around it.
 * @throws Cancelled if a stop was requested before the end; std::bad_alloc
 *
 * Complexity: linear in the number of weak voxels, m log m in the number m of buried ones, and one
 * bit of memory a voxel of the lattice.
 */
std::vector<GridGeometry<3>::Index> FindBuriedVoxels(const LabelImage<3>& image,
  std::span<const WeakVoxel> weak, unsigned threads, const std::stop_token& stop);

} // namespace voxplex

#endif
