// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SizingField.h
 * @brief The distance between the points of the mesh, and the largest size of its elements.
 */
#ifndef voxplex_SizingField_h
#define voxplex_SizingField_h

#include "Domain/Domain.h"
#include "Geometry/Circumball.h"
#include "Sizing/BaseDistance.h"
#include "Sizing/InterfaceSizes.h"
#include "Sizing/LocalDelta.h"
#include "Sizing/SizeFunction.h"

#include <algorithm>
#include <limits>

namespace voxplex
{

/** A point is never inserted closer to a vertex than this fraction of the spacing at the point. */
inline constexpr double SpacingFloorFraction = 0.1;

/**
 * The sources of a sizing field. Lengths are in the unit of the mesher's frame; the objects pointed
 * to must outlive the field.
 */
template <int D>
struct SizingSources
{
  BaseDistance<D> Base;                          ///< delta, uniform or by the local feature size
  const InterfaceSizes<D>* Interfaces = nullptr; ///< instead of the base; may be null
  const LocalDelta<D>* Local = nullptr;          ///< upper bound near thin parts; may be null
  const SizeFunction<D>* Size = nullptr;         ///< upper bound of circumradii; may be null
  /** Smaller sizes are raised to it; 0: SpacingFloorFraction of the smallest base distance. */
  double SizeFloor = 0.0;
};

/**
 * @brief The lengths that the rules, the checks and the bounding box ask for.
 *
 * - The *sampling distance* of an interface is the Delta of the thesis: a larger one is coarser. It
 *   is the distance of InterfaceSizes for the two labels, or else the base distance. LocalDelta and
 *   the sizes of the elements on both sides may lower it. If an interface were sampled more
 *   coarsely than its neighbourhood is meshed, the facet rule would insert the missing points one
 *   by one, and the removal rule would remove the points of the size rule.
 * - The *spacing* at a point is the smallest sampling distance of the interfaces near it. It grows
 *   slowly with the distance from them. Every rule that keeps points apart or removes points asks
 *   for the spacing. If one rule kept a smaller distance than another, the second would remove the
 *   points of the first.
 * - The *element size* is an upper bound of circumradii.
 *
 * A query takes one or a few look-ups. Queries are safe in any number of threads, but not while
 * local bounds are set.
 */
template <int D>
class SizingField
{
public:
  /** @param domain must outlive this object; it gives the values of labels */
  SizingField(const Domain<D>& domain, const SizingSources<D>& sources)
    : Image(domain)
    , Of(sources)
    , SmallestSize(
        sources.SizeFloor > 0.0 ? sources.SizeFloor : SpacingFloorFraction * sources.Base.Finest())
    , SmallestSpacing(std::min(SmallestSize,
        SpacingFloorFraction *
          std::min(sources.Base.Finest(),
            sources.Interfaces ? sources.Interfaces->Smallest() : sources.Base.Finest())))
  {
  }

  const SizingSources<D>& Sources() const { return this->Of; }

  /** Smaller sizes are raised to it. */
  double SizeFloor() const { return this->SmallestSize; }

  /** No point is ever inserted closer to a vertex. */
  double SpacingFloor() const
  {
    return this->Of.Local
      ? std::min(this->SmallestSpacing, SpacingFloorFraction * this->Of.Local->Smallest())
      : this->SmallestSpacing;
  }

  ///@{
  /** Delta, uniform or graded, without interface sizes, local bounds and sizes of elements. */
  double BaseAt(const Point<D>& p) const { return this->Of.Base.At(p); }
  const BaseDistance<D>& Base() const { return this->Of.Base; }
  ///@}

  /** Whether AskedDistance() is the same for all interfaces. */
  bool IsUniform() const { return !this->Of.Interfaces && !this->Of.Base.Graded; }

  /** The sampling distance between two labels, before local bounds and element sizes lower it. */
  double AskedDistance(const Point<D>& z, LabelId a, LabelId b) const
  {
    return this->Of.Interfaces ? this->Of.Interfaces->At(z, a, b) : this->BaseAt(z);
  }

  /**
   * The sampling distance at a point of the interface between two labels. If both labels are the
   * same, this is the spacing: near the edge of an interface the second label may be unknown.
   */
  double SamplingDistance(const Point<D>& z, LabelId a, LabelId b) const
  {
    if (a == b)
    {
      return this->Spacing(z, a);
    }
    double distance = this->AskedDistance(z, a, b);
    if (this->Of.Local)
    {
      const auto bound = this->Of.Local->At(z);
      distance =
        bound.Label == a || bound.Label == b ? std::min<double>(distance, bound.Delta) : distance;
    }
    if (this->Of.Size)
    {
      for (const LabelId label : { a, b })
      {
        distance = label != 0 ? std::min(distance, this->ElementSize(z, label)) : distance;
      }
    }
    return distance;
  }

  /**
   * The same at the interface point z closest to p. The label of p is known; the other label is
   * looked up just behind z.
   */
  double SamplingDistanceBehind(const Point<D>& p, LabelId label, const Point<D>& z) const
  {
    const Point<D> behind =
      Interpolate(p, z, 1.0 + this->SpacingFloor() / std::max(Distance(p, z), 1e-300));
    return this->SamplingDistance(z, label, this->Image.Label(behind));
  }

  /** Whether the sampling distance depends on the labels at z. */
  bool DependsOnLabels(const Point<D>& z) const
  {
    return this->Of.Size || this->Of.Interfaces ||
      (this->Of.Local && this->Of.Local->At(z).Delta < this->BaseAt(z));
  }

  /** Upper bound of all sampling distances. */
  double Largest() const
  {
    return this->Of.Interfaces ? std::max(this->Of.Base.Delta, this->Of.Interfaces->Largest())
                               : this->Of.Base.Delta;
  }

  /** Upper bound of the sampling distances of a label's interfaces. */
  double LargestOf(LabelId label) const
  {
    const double largest = this->Of.Interfaces ? this->Of.Interfaces->LargestOf(label) : 0.0;
    return largest > 0.0 ? largest : this->Of.Base.Delta; // the label may have lost all its voxels
  }

  /** The uniform sampling distance that gives about as many vertices. */
  double Equivalent() const
  {
    return this->Of.Interfaces ? this->Of.Interfaces->Equivalent() : this->Of.Base.Equivalent;
  }

  /** The smallest sampling distance near p, before local bounds lower it. */
  double AskedNear(const Point<D>& p) const
  {
    return this->Of.Interfaces
      ? std::min(this->Of.Interfaces->Largest(), this->Of.Interfaces->GradedAt(p))
      : this->BaseAt(p);
  }

  /** The spacing of the mesh at p. */
  double Spacing(const Point<D>& p) const
  {
    const double spacing = this->AskedNear(p);
    return this->Of.Local ? std::min(spacing, this->Of.Local->GradedAt(p)) : spacing;
  }

  /** The spacing inside of a label: also at most the element size there. */
  double Spacing(const Point<D>& p, LabelId label) const
  {
    const double spacing = this->Spacing(p);
    return label != 0 ? std::min(spacing, this->ElementSize(p, label)) : spacing;
  }

  /**
   * The largest circumradius of an element of a label with its circumcentre at p; infinite: no
   * bound.
   */
  double ElementSize(const Point<D>& p, LabelId label) const
  {
    if (!this->Of.Size)
    {
      return std::numeric_limits<double>::infinity();
    }
    const double size = this->Of.Size->Evaluate(p, this->Image.LabelValue(label));
    return size > 0.0 ? std::max(size, this->SmallestSize)
                      : std::numeric_limits<double>::infinity();
  }

  /**
   * Whether a circumball is smaller than the elements of a label may be there: a little smaller, for rounding.
   */
  bool IsSmallEnough(const Circumball<D>& ball, LabelId label) const
  {
    constexpr double Below = 1.0 - 1e-9;
    const double size = Below * this->ElementSize(ball.Center, label);
    return ball.Radius2 < size * size;
  }

private:
  const Domain<D>& Image;
  const SizingSources<D> Of;
  const double SmallestSize;
  const double SmallestSpacing; ///< before local bounds
};

} // namespace voxplex

#endif
