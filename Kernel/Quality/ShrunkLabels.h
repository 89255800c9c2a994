// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ShrunkLabels.h
 * @brief Labels of which a mesh has no element, or much less volume than its image.
 */
#ifndef voxplex_ShrunkLabels_h
#define voxplex_ShrunkLabels_h

#include "Image/LabelImage.h"
#include "Mesh/SimplexMesh.h"

#include <cstdint>
#include <vector>

namespace voxplex
{

struct ShrunkLabel
{
  std::int64_t Label = 0;
  double Fraction = 0.0; ///< of its volume in the image
};

/** What a mesh has of the volumes of labels. */
struct VolumeShares
{
  std::vector<ShrunkLabel> Shrunk; ///< the worst first
  double All = 1.0;                ///< of the volume of all labels together
};

/** A label is shrunk if the mesh has at most this part of its volume... */
inline constexpr double ShrunkFraction = 0.9;
/** ... of an isosurface less, as its volume is not that of voxels... */
inline constexpr double ShrunkFractionOfIsosurface = 0.5;
/**
 * ... and it has at least this number of voxels, as ComponentOptions::Smallest. Specks are only kept,
 * with few elements.
 */
inline constexpr std::int64_t FewestVoxelsOfShrunk = 8;
/** Labels of which none is shrunk, grains for example, have together lost much if they have at most this part. */
inline constexpr double ShrunkFractionOfAll = 0.95;

/**
 * The labels of the image without an element, in increasing order. Those without a voxel, which
 * DropComponents() has removed, are not among them. O(elements).
 */
template <int D>
std::vector<std::int64_t> FindLostLabels(const SimplexMesh<D>& mesh, const LabelImage<D>& image);

/**
 * The shrunk labels, the worst first. Labels without an element are not among them.
 *
 * O(elements).
 *
 * @param mesh in the frame of the image
 * @param fraction see ShrunkFraction
 * @param threads 0 means all cores; the result does not depend on it
 * @throws std::bad_alloc
 */
VolumeShares FindShrunkLabels(const SimplexMesh<3>& mesh, const LabelImage<3>& image,
  double fraction = ShrunkFraction, unsigned threads = 1);

extern template std::vector<std::int64_t> FindLostLabels<3>(
  const SimplexMesh<3>&, const LabelImage<3>&);
extern template std::vector<std::int64_t> FindLostLabels<4>(
  const SimplexMesh<4>&, const LabelImage<4>&);

} // namespace voxplex

#endif
