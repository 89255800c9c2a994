// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MoveLimits.h
 * @brief How far vertices of interfaces may be moved.
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
 * Limits from the image: a part of a voxel along each axis, about the image's box, and within the cut
 * faces (3D), flat ends and time planes (4D). The image, the domain and the planes must outlive this.
 */
template <int D>
class MoveLimits
{
public:
  MoveLimits(const LabelImage<D>& image, const Domain<D>& surfaces, const TimePlanes& planes)
    : Image(image)
    , Border(surfaces.Border())
    , Planes(planes)
    , Origin(image.Grid().ToIndex({}))
    , FirstTime(surfaces.HasTimeBorder(0) ? surfaces.Bounds().Min[D - 1] : -Infinity)
    , LastTime(surfaces.HasTimeBorder(1) ? surfaces.Bounds().Max[D - 1] : Infinity)
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

  /** What a vertex must stay on: a set of faces (ImageBorder), in 4D whether it keeps its time. */
  unsigned HeldAt(const Point<D>& p) const
  {
    if constexpr (D == 4)
    {
      return this->KeepsTime(p) ? 1u : 0u;
    }
    return this->Border ? this->Border->FacesAt(p) : 0u;
  }

  /** The displacement of a vertex, changed so that it stays on what it must. @param held HeldAt(p) */
  Point<D> Hold(const Point<D>& p, Point<D> displacement, unsigned held) const
  {
    if (held == 0)
    {
      return displacement;
    }
    if constexpr (D == 4)
    {
      displacement[3] = 0.0;
      return displacement;
    }
    Point<D> q;
    for (std::size_t a = 0; a < D; ++a)
    {
      q[a] = p[a] + displacement[a];
    }
    return Subtract(this->Border->MoveOnto(q, held), p);
  }

  /** The factor, at most 1, that shortens a displacement to MostVoxels along each axis. */
  double Shortening(const Point<D>& displacement) const
  {
    double factor = 1.0;
    const Point<D> index = this->Image.Grid().ToIndex(displacement);
    for (std::size_t a = 0; a < D; ++a)
    {
      factor = std::min(factor, MostVoxels / std::abs(index[a] - this->Origin[a])); // inf if 0
    }
    return factor;
  }

  /** Whether a point is in the image's bounding box, or less than a voxel outside. */
  bool IsNearImage(const Point<D>& p) const
  {
    const Point<D> index = this->Image.Grid().ToIndex(p);
    for (std::size_t a = 0; a < D; ++a)
    {
      const double offset = index[a] - static_cast<double>(this->Image.CropOrigin()[a]);
      if (!(offset > -1.0 && offset < static_cast<double>(this->Image.CropDimensions()[a])))
      {
        return false;
      }
    }
    return !this->Border || this->Border->IsWithin(p);
  }

private:
  static constexpr double MostVoxels = D == 3 ? 1.0 : 0.5;
  static constexpr double Infinity = std::numeric_limits<double>::infinity();

  const LabelImage<D>& Image;
  const ImageBorder<D>* const Border;
  const TimePlanes& Planes;
  const Point<D> Origin; ///< of the frame, in index coordinates
  const double FirstTime;
  const double LastTime;
};

} // namespace voxplex

#endif
