// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file GradingOptions.h
 * @brief The user's options for a coarser sampling of interfaces where their shape allows it.
 */
#ifndef voxplex_GradingOptions_h
#define voxplex_GradingOptions_h

namespace voxplex
{

/** How the sampling distance of interfaces depends on the place. */
enum class GradingMode
{
  Uniform,         ///< delta everywhere
  LocalFeatureSize ///< delta where the shape needs it, else coarser (thesis, 2.2 and 2.6.1)
};

/**
 * In mode LocalFeatureSize Delta(z) = max(delta, Ratio x min(lambda, lfs(z))), and less where the
 * interface bends (LocalFeatureSize). lfs(z) is the local feature size: the distance from a point z
 * of the interfaces to their medial axis; in 4D in space-time, with time in units of length.
 */
struct GradingOptions
{
  GradingMode Mode = GradingMode::Uniform;
  /** Delta(z) over the local feature size. The thesis calls it delta; its value there is 2. */
  double Ratio = 1.0;
  /**
   * Upper bound of the local feature size; the unit is the edge of a cube with the volume of a
   * voxel; in 4D of a hypercube with its hypervolume.
   */
  double Lambda = 12.0;
};

} // namespace voxplex

#endif
