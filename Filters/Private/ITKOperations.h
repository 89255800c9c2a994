// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ITKOperations.h
 * @brief Operations of ITK on blocks of voxels, without ITK's types.
 */
#ifndef voxplex_Private_ITKOperations_h
#define voxplex_Private_ITKOperations_h

#include "Image/GridGeometry.h"
#include "Image/LabelImage.h"

#include <cstdint>
#include <span>
#include <vector>

namespace voxplex
{

using VoxelIndex = GridGeometry<3>::Index;

/** A connected set of voxels, as runs along the first axis. */
struct Piece
{
  struct Run
  {
    VoxelIndex First;
    std::int64_t Length;
  };
  std::vector<Run> Runs;
  std::int64_t Voxels = 0;
  VoxelIndex First{}; ///< lowest corner of the bounding box
  VoxelIndex Last{};  ///< highest corner
};

/**
 * The connected sets of the voxels with a value (itk::BinaryImageToLabelMapFilter), in no order. Those with more than
 * `largest` voxels are left out.
 * @param voxels first axis fastest; T is LabelId or unsigned char
 * @param corners whether voxels that share an edge or a corner are neighbours, or only those that share a face
 * @throws std::exception of ITK
 */
template <typename T>
std::vector<Piece> FindPieces(std::span<const T> voxels, const VoxelIndex& dimensions, T value,
  bool corners, std::int64_t largest);

/**
 * The distance from the centre of each voxel to that of the nearest site (itk::SignedMaurerDistanceMapImageFilter).
 * @param sites not 0 at sites; there must be one
 * @throws std::exception of ITK
 */
std::vector<float> DistancesToSites(
  std::span<const unsigned char> sites, const VoxelIndex& dimensions, const Point<3>& spacing);

} // namespace voxplex

#endif
