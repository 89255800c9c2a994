// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Placement.h
 * @brief Where the voxels of an image lie.
 */
#ifndef voxplex_Placement_h
#define voxplex_Placement_h

#include "Geometry/Point.h"
#include "ScalarImage.h"

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace voxplex
{

using Vector3 = Point<3>;

/** From a voxel to the next, along each axis. */
std::array<Vector3, 3> StepsOf(const ScalarImage& image);

/** Of the parallelepiped that the directions of the axes span: 1 if these are orthogonal. */
double VolumeOfDirections(const ScalarImage& image);

/**
 * Sets spacing, direction and origin from the steps between neighbouring voxels along each axis and the place of voxel
 * (0, 0, 0), both in LPS. Axes may be oblique or sheared.
 *
 * @throws InputError: a number that is not finite or too large (1e12), a step of length 0, axes that are not independent
 */
void Place(ScalarImage& image, const std::array<Vector3, 3>& steps, const Vector3& origin);

/** The same, for axes along those of space. @throws InputError also for a spacing that is not positive */
void PlaceAlongAxes(ScalarImage& image, const Vector3& spacing, const Vector3& origin);

/**
 * Sets the sizes, which must be positive and fit into int, and whose product into memory.
 *
 * @param sizes of three axes, or of four with time as the last. Of more, the last must be 1.
 * @throws InputError that shows the sizes
 */
void SetSizes(ScalarImage& image, std::vector<std::int64_t> sizes);

/** @throws InputError for spacings that are wrong. @param shown how the header gives them */
void CheckSpacing(bool isRight, std::string_view shown);

/** @throws InputError for axes that are wrong */
void CheckTimeIsApart(bool isApart);

/**
 * Sets the times of frames that are equally spaced.
 *
 * @param shown how the header gives the step
 * @throws InputError for a step that is negative or 0, and for numbers that are not finite
 */
void SetTimeStep(ScalarImage& image, double first, double step, std::string_view shown);

/**
 * Sets the time of each frame. @throws InputError if they do not increase.
 * @param times one for each frame
 */
void SetFrameTimes(ScalarImage& image, const std::vector<double>& times);

} // namespace voxplex

#endif
