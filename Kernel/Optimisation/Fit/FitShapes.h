// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FitShapes.h
 * @brief Internal to InterfaceFit: the shapes that the fit keeps.
 */
#ifndef voxplex_FitShapes_h
#define voxplex_FitShapes_h

#include "Base/UninitialisedVector.h"
#include "Geometry/SimplexQuality.h"
#include "Optimisation/Fit/InterfaceFit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace voxplex
{

/**
 * @brief Says whether cells and facets with moved vertices keep the bounds of a fit. Any number of
 * threads may ask, while nobody changes the positions.
 */
template <int D>
class FitShapes
{
public:
  /** All references must outlive this object. @param before the positions before all steps */
  FitShapes(const Complex<D>& complex, const Domain<D>& surfaces, const FitBounds<D>& bounds,
    const UninitialisedVector<Point<D>>& before)
    : Mesh(complex)
    , Surfaces(surfaces)
    , Bounds(bounds)
    , Originals(before)
    , AnyBounds(
        bounds.NormalizedVolume > 0.0 || std::isfinite(bounds.RadiusEdgeRatio) || bounds.Sizing)
    , LargestCosine(std::cos(bounds.FacetAngle / DegreesPerRadian))
  {
  }

  /** Whether the moved cell is positively oriented, and keeps the bounds or gets no worse. */
  bool IsGood(std::uint32_t s) const
  {
    const Corners after = this->Mesh.PointsOf(this->Mesh.Cells[s].V);
    const double volume = SignedVolume<D>(after.data());
    const double least =
      this->HasBounds(s) ? 0.0 : VolumeKept * SignedVolume<D>(this->Before(s).data());
    if (!(volume > least) ||
      (this->Mesh.IsHolder(s) &&
        !this->Mesh.Guard->Keeps(this->Mesh.Labels[s], this->Before(s), after)))
    {
      return false;
    }
    if (!this->HasBounds(s))
    {
      return true;
    }
    const Shape shape = ShapeOf(after, volume);
    const bool isWithin = shape.NormalizedVolume >= this->Bounds.NormalizedVolume &&
      shape.RadiusEdge2 <= this->Bounds.RadiusEdgeRatio * this->Bounds.RadiusEdgeRatio;
    if (isWithin && !this->Bounds.Sizing)
    {
      return true;
    }
    const Corners before = this->Before(s);
    const Shape shapeBefore = ShapeOf(before, SignedVolume<D>(before.data()));
    return (isWithin ||
             (shape.NormalizedVolume >=
                 std::min(this->Bounds.NormalizedVolume, shapeBefore.NormalizedVolume) &&
               shape.RadiusEdge2 <=
                 std::max(this->Bounds.RadiusEdgeRatio * this->Bounds.RadiusEdgeRatio,
                   shapeBefore.RadiusEdge2))) &&
      this->HasRightSize(shape.Ball, shapeBefore.Ball, this->Mesh.Labels[s]);
  }

  /** Whether no angle of an interface triangle is below the bound, or smaller than before. */
  bool HasGoodAngles(const std::array<std::uint32_t, 3>& v) const
  {
    const auto cosineIn = [&v](const UninitialisedVector<Point<D>>& points)
    { return CosineOfSmallestAngle(points[v[0]], points[v[1]], points[v[2]]); };
    const double cosine = cosineIn(this->Mesh.Points);
    return cosine <= this->LargestCosine || cosine <= cosineIn(this->Originals);
  }

private:
  using Corners = typename ComponentGuard<D>::Corners;

  /** Simplices without bounds keep at least this part of their volume. */
  static constexpr double VolumeKept = 0.1;

  /** What shape bounds apply to. */
  struct Shape
  {
    Circumball<D> Ball;
    double NormalizedVolume;
    double RadiusEdge2; ///< the square of the radius-edge ratio
  };

  static Shape ShapeOf(const Corners& points, double volume)
  {
    Shape shape;
    if (!ComputeCircumball<D>(points.data(), shape.Ball))
    {
      ComputeCircumballExactly<D>(points.data(), shape.Ball);
    }
    shape.NormalizedVolume = NormalizedVolume<D>(volume, shape.Ball.Radius2);
    shape.RadiusEdge2 = shape.Ball.Radius2 / ShortestEdge2<D>(points.data());
    return shape;
  }

  Corners Before(std::uint32_t s) const
  {
    const auto& v = this->Mesh.Cells[s].V;
    Corners corners;
    for (std::size_t k = 0; k <= D; ++k)
    {
      corners[k] = &this->Originals[v[k]];
    }
    return corners;
  }

  /** Whether bounds of shapes or sizes apply. */
  bool HasBounds(std::uint32_t s) const { return this->Mesh.Labels[s] != 0 && this->AnyBounds; }

  /**
   * Whether a simplex of a label is below the element size at its new centre, or, compared with that
   * size, no larger than before. Sizes are asked for where the label is only, as in refinement.
   */
  bool HasRightSize(const Circumball<D>& ball, const Circumball<D>& before, LabelId label) const
  {
    const SizingField<D>* const sizing = this->Bounds.Sizing;
    if (!sizing)
    {
      return true;
    }
    if (this->Surfaces.Label(ball.Center) != label)
    {
      return false;
    }
    const double size = sizing->ElementSize(ball.Center, label);
    const double sizeBefore = sizing->ElementSize(before.Center, label);
    return sizing->IsSmallEnough(ball, label) ||
      (this->Surfaces.Label(before.Center) == label &&
        ball.Radius2 * sizeBefore * sizeBefore <= before.Radius2 * size * size);
  }

  const Complex<D>& Mesh;
  const Domain<D>& Surfaces;
  const FitBounds<D> Bounds;
  const UninitialisedVector<Point<D>>& Originals;
  const bool AnyBounds;       ///< of shapes or sizes
  const double LargestCosine; ///< of the smallest angle of an interface triangle
};

} // namespace voxplex

#endif
