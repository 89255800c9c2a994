// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file GradingOptions.h
 * @brief What a user may choose about where interfaces are sampled more coarsely.
 */
#ifndef voxplex_GradingOptions_h
#define voxplex_GradingOptions_h

namespace voxplex
{

/** How the sampling density of interfaces depends on the place. */
enum class GradingMode
{
  Uniform,         ///< delta everywhere
  LocalFeatureSize ///< delta where the shape needs it, coarser elsewhere (thesis, sections 2.2 and 2.6.1)
};

/**
 * In mode LocalFeatureSize Delta(z) = max(delta, Ratio x min(lambda, lfs(z))), where lfs(z) is the local
 * feature size: the distance from a point z of the interfaces to their medial axis. 3D only.
 */
struct GradingOptions
{
  GradingMode Mode = GradingMode::Uniform;
  /** Delta(z) over the local feature size; delta in the thesis, where it is 2. */
  double Ratio = 1.0;
  /** Local feature sizes above this count as this: so many edges of a cube of a voxel's volume. */
  double Lambda = 12.0;
};

} // namespace voxplex

#endif
