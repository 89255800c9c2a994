// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Preparation.h
 * @brief The first stage of a run, which does not depend on the sampling distance.
 */
#ifndef voxplex_Preparation_h
#define voxplex_Preparation_h

#include "Domain/Domain.h"
#include "Domain/TimePlanes.h"
#include "Image/BitMask.h"
#include "Image/Components.h"
#include "Image/IsosurfaceImage.h"
#include "Image/LabelImage.h"
#include "Junctions/JunctionCurves.h"
#include "Mesher/MeshingOptions.h"
#include "Mesher/MeshingStatistics.h"
#include "Sizing/SizeFunction.h"

#include <memory>
#include <optional>
#include <stop_token>
#include <vector>

namespace voxplex
{

/** The result of Prepare(). Later stages do not change it. */
template <int D>
struct PreparedImage
{
  const LabelImage<D>& Image;
  /** Image with frames between its frames, or a periodic copy of it; null if neither is needed, and in 3D. */
  std::unique_ptr<const LabelImage<D>> WithSteps;
  std::unique_ptr<const Domain<D>> Surfaces;
  const BitMask<D>* Sites;                     ///< surface voxels of the domain
  std::optional<JunctionCurves> Junctions;     ///< empty if junctions are not sampled
  std::optional<Components<D>> AllComponents;  ///< empty if components are not checked
  std::optional<Components<D>> OfFrames;       ///< those of each frame; empty as before, and in 3D
  std::shared_ptr<const SizeFunction<D>> Size; ///< with gradation; may be null
  TimePlanes Planes = {};                      ///< none in 3D
  /** The volume of each label id's voxels, which the mesh is to have; empty for isosurfaces, and in 4D. */
  std::vector<double> Volumes = {};

  /** The image that the domain is made from. Its surface voxels are Sites. */
  const LabelImage<D>& OfDomain() const { return this->WithSteps ? *this->WithSteps : this->Image; }
};

/**
 * Removes noise, adds frames between frames, makes the domain, finds junctions and components, and limits the growth of element sizes.
 *
 * @param image loses its small components (MeshingOptions::SmallestVolume); must outlive the result, and so must the isosurface
 * @param isosurface the isosurface to mesh, or null to mesh the labels alone
 * @param statistics receives times, numbers and bytes
 * @throws InputError if the image has grey values (CheckSegmented), is nothing but noise, or does not suit the time planes;
 *   Cancelled; std::bad_alloc
 */
template <int D>
PreparedImage<D> Prepare(LabelImage<D>& image, const IsosurfaceImage<D>* isosurface,
  const MeshingOptions<D>& options, MeshingStatistics& statistics, const std::stop_token& stop);

extern template PreparedImage<3> Prepare<3>(LabelImage<3>&, const IsosurfaceImage<3>*,
  const MeshingOptions<3>&, MeshingStatistics&, const std::stop_token&);
extern template PreparedImage<4> Prepare<4>(LabelImage<4>&, const IsosurfaceImage<4>*,
  const MeshingOptions<4>&, MeshingStatistics&, const std::stop_token&);

} // namespace voxplex

#endif
