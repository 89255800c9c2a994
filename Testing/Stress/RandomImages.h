// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RandomImages.h
 * @brief Random images of many kinds that make meshing hard.
 */
#ifndef voxplex_stress_RandomImages_h
#define voxplex_stress_RandomImages_h

#include "Random.h"
#include "Volume.h"

#include <string>

namespace voxplex::stress
{

/**
 * Draws extent and axes. Most grids have some thousand voxels or fewer; few have up to 80 voxels
 * along an axis (4D: 2 to 18, and 2 to 8 frames). Spacings differ by a factor of up to six. Some
 * axes are sheared. In 4D time is orthogonal to space.
 */
template <int D>
Volume<D> RandomGrid(Random& random);

/**
 * Fills a grid with 1 to about 60 labels, numbered with gaps. About half of the images have a
 * margin of background. In the others the border cuts the object.
 * @return the name of the kind
 */
template <int D>
std::string FillWithLabels(Volume<D>& image, Random& random);

/**
 * Fills a grid with grey values and chooses an isosurface. Labels mark the inside.
 * @return the name of the kind
 */
template <int D>
std::string FillWithGreyValues(Volume<D>& image, Random& random);

/** Makes the last frame equal to the first one. */
void RepeatFirstFrame(Volume<4>& image);

/** Sets Labels from Grey and Surface, without smoothing. */
template <int D>
void ClassifyGreyValues(Volume<D>& image);

} // namespace voxplex::stress

#endif
