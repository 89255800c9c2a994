// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MoveLimits.h
 * @brief How far vertices of space-time interfaces may be moved.
 */
#ifndef voxplex_MoveLimits_h
#define voxplex_MoveLimits_h

#include "Domain/Domain.h"
#include "Domain/TimePlanes.h"
#include "Geometry/Point.h"
#include "Image/LabelImage.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace voxplex
{

/**
 * Limits from the image: half a voxel along each axis, about the image's box, and within flat ends and
 * time planes. The image, the domain and the planes must outlive this.
 */
class MoveLimits
{
public:
  MoveLimits(const LabelImage<4>& image, const Domain<4>& surfaces, const TimePlanes& planes)
    : Image(image)
    , Planes(planes)
    , Origin(image.Grid().ToIndex({}))
    , FirstTime(surfaces.HasTimeBorder(0) ? surfaces.Bounds().Min[3] : -Infinity)
    , LastTime(surfaces.HasTimeBorder(1) ? surfaces.Bounds().Max[3] : Infinity)
  {
  }

  /** Whether a vertex is on a flat end or a plane. Then its time must not change. */
  bool KeepsTime(const Point<4>& p) const
  {
    return p[3] <= this->FirstTime || p[3] >= this->LastTime || this->IsOnPlane(p);
  }

  /** Whether a vertex is on a time plane inside of the mesh. */
  bool IsOnPlane(const Point<4>& p) const { return this->Planes.AreAt(p[3]); }

  /** Whether a vertex has a twin at the other end of a periodic mesh. */
  bool HasTwin(const Point<4>& p) const { return this->Planes.IsPeriodicEnd(p[3]); }

  /** The factor, at most 1, that shortens a displacement to half a voxel along each axis. */
  double Shortening(const Point<4>& displacement) const
  {
    double factor = 1.0;
    const Point<4> index = this->Image.Grid().ToIndex(displacement);
    for (std::size_t a = 0; a < 4; ++a)
    {
      factor = std::min(factor, MostVoxels / std::abs(index[a] - this->Origin[a])); // inf if 0
    }
    return factor;
  }

  /** Whether a point is in the image's bounding box, or less than a voxel outside. */
  bool IsNearImage(const Point<4>& p) const
  {
    const Point<4> index = this->Image.Grid().ToIndex(p);
    for (std::size_t a = 0; a < 4; ++a)
    {
      const double offset = index[a] - static_cast<double>(this->Image.CropOrigin()[a]);
      if (!(offset > -1.0 && offset < static_cast<double>(this->Image.CropDimensions()[a])))
      {
        return false;
      }
    }
    return true;
  }

private:
  static constexpr double MostVoxels = 0.5;
  static constexpr double Infinity = std::numeric_limits<double>::infinity();

  const LabelImage<4>& Image;
  const TimePlanes& Planes;
  const Point<4> Origin; ///< of the frame, in index coordinates
  const double FirstTime;
  const double LastTime;
};

} // namespace voxplex

#endif
