// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RandomImages.h
 * @brief Images of all kinds that make meshing hard.
 */
#ifndef voxplex_stress_RandomImages_h
#define voxplex_stress_RandomImages_h

#include "Random.h"
#include "Volume.h"

#include <string>

namespace voxplex::stress
{

/**
 * Extent and axes. Mostly some thousand voxels or fewer, seldom up to 80 a side (4D: 2 to 18, and 2 to 8 frames);
 * spacings that differ by up to six times, axes that are sheared now and then. In 4D time is orthogonal to space.
 */
template <int D>
Volume<D> RandomGrid(Random& random);

/**
 * Fills a grid with labels: 1 to some 60, numbered with gaps. About half of the images have a margin of background,
 * in the others the border cuts the object.
 * @return the name of the kind
 */
template <int D>
std::string FillWithLabels(Volume<D>& image, Random& random);

/** Fills a grid with grey values and chooses an isosurface. Labels are what is inside. @return the name of the kind */
template <int D>
std::string FillWithGreyValues(Volume<D>& image, Random& random);

/** Sets Labels by Grey and Surface, smoothing aside. */
template <int D>
void ClassifyGreyValues(Volume<D>& image);

} // namespace voxplex::stress

#endif
