// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FrameVolumes.h
 * @brief Volumes of the cuts of a pentatope mesh at the frames of its image, beside those of voxels.
 */
#ifndef voxplex_FrameVolumes_h
#define voxplex_FrameVolumes_h

#include "Image/LabelImage.h"
#include "Mesh/SimplexMesh.h"

#include <array>
#include <cstdint>

namespace voxplex
{

/** A frame is off if the volume of a label differs by this part or more. */
inline constexpr double FrameTolerance = 0.03;
/**
 * Frames in which a label has less than this part of its largest volume are not compared: where it
 * appears or vanishes, voxels are no measure.
 */
inline constexpr double LeastShareOfLargest = 0.05;

/** The frames whose volumes are off. */
struct FramesOff
{
  std::uint64_t Number = 0;
  std::int64_t Frame = 0; ///< the worst, from 0 on
  std::int64_t Label = 0; ///< there
  double Share = 1.0;     ///< of the label's volume there
};

/**
 * Compares frames. Takes O(n) for n pentatopes and voxels, for each pentatope the frames that cut it.
 *
 * @param mesh in the frame of the image
 * @throws std::bad_alloc
 */
FramesOff CompareFrames(const SimplexMesh<4>& mesh, const LabelImage<4>& image);

/**
 * The density at a time of a simplex whose vertices have these times: the volume of the cut, divided
 * by the volume of the simplex (Curry and Schoenberg 1966). It is the limit of times shortly before,
 * or shortly after.
 *
 * @param times ascending, not all the same
 */
double CutDensity(const std::array<double, 5>& times, double time, bool fromAbove);

} // namespace voxplex

#endif
