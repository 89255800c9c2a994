// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SizingField.h
 * @brief How far apart the points of the mesh are, and how large its elements may be.
 */
#ifndef voxplex_SizingField_h
#define voxplex_SizingField_h

#include "Domain/Domain.h"
#include "Sizing/BaseDistance.h"
#include "Sizing/InterfaceSizes.h"
#include "Sizing/LocalDelta.h"
#include "Sizing/SizeFunction.h"

#include <algorithm>
#include <limits>

namespace voxplex
{

/** Points closer to a vertex than this fraction of the spacing at their place are never inserted. */
inline constexpr double SpacingFloorFraction = 0.1;

/** What a sizing field is made of. Lengths are in the unit of the mesher's frame; what is pointed to must outlive it. */
template <int D>
struct SizingSources
{
  BaseDistance<D> Base;                          ///< delta, uniform or by the local feature size
  const InterfaceSizes<D>* Interfaces = nullptr; ///< in place of the base; may be null
  const LocalDelta<D>* Local = nullptr;  ///< upper bound where something is thin; may be null
  const SizeFunction<D>* Size = nullptr; ///< upper bound of circumradii; may be null
  /** Sizes below it are raised to it; 0: SpacingFloorFraction of the smallest base distance. */
  double SizeFloor = 0.0;
};

/**
 * @brief The one place where rules, checks and the box ask for lengths.
 *
 * - The *sampling distance* of an interface is the Delta of the thesis: a larger one is coarser. It is what
 *   InterfaceSizes asks for the two labels, or else the base distance; LocalDelta and the sizes of the elements on both
 *   sides may lower it. Were an interface sampled more coarsely than its neighbourhood is meshed, R3 would insert the missing
 *   points one by one, and R6 would remove what R5 asks for.
 * - The *spacing* at any point is the least sampling distance of the interfaces near it, and grows slowly with the distance
 *   from them. All rules that keep points apart, or take points away, ask for it: if one rule kept less than
 *   another, the other would take away again what the first makes.
 * - The *element size* is an upper bound of circumradii.
 *
 * Queries are safe in any number of threads, unless FollowLocalBounds() runs, and take one or a few look-ups.
 */
template <int D>
class SizingField
{
public:
  /** @param domain must live as long as this; the labels' values are asked from it */
  SizingField(const Domain<D>& domain, const SizingSources<D>& sources)
    : Image(domain)
    , Of(sources)
    , SmallestSize(
        sources.SizeFloor > 0.0 ? sources.SizeFloor : SpacingFloorFraction * sources.Base.Finest())
  {
    this->FollowLocalBounds();
  }

  /** To be called when bounds were added to the local ones. */
  void FollowLocalBounds()
  {
    double smallest = this->Of.Base.Finest();
    if (this->Of.Interfaces)
    {
      smallest = std::min(smallest, this->Of.Interfaces->Smallest());
    }
    if (this->Of.Local)
    {
      smallest = std::min(smallest, this->Of.Local->Smallest());
    }
    this->SmallestSpacing = std::min(this->SmallestSize, SpacingFloorFraction * smallest);
  }

  const SizingSources<D>& Sources() const { return this->Of; }

  /** Sizes below it are raised to it. */
  double SizeFloor() const { return this->SmallestSize; }

  /** No point closer to a vertex is ever inserted. */
  double SpacingFloor() const { return this->SmallestSpacing; }

  ///@{
  /** Delta and its bounds, without interface sizes, local bounds and sizes of elements. */
  double BaseAt(const Point<D>& p) const { return this->Of.Base.At(p); }
  const BaseDistance<D>& Base() const { return this->Of.Base; }
  ///@}

  /** Whether the distance that is asked for is the same for all interfaces. */
  bool IsUniform() const { return !this->Of.Interfaces && !this->Of.Base.Graded; }

  /** The sampling distance that is asked for between two labels, before anything lowers it. */
  double AskedDistance(const Point<D>& z, LabelId a, LabelId b) const
  {
    return this->Of.Interfaces ? this->Of.Interfaces->At(z, a, b) : this->BaseAt(z);
  }

  /**
   * The sampling distance at a point of the interface between two labels. The same label twice is no interface, but may
   * be all that is known near the edge of one: then it is the spacing there.
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

  /** The same at the interface point z closest to p: the label of p is known, the other one is looked up just behind z. */
  double SamplingDistanceBehind(const Point<D>& p, LabelId label, const Point<D>& z) const
  {
    const Point<D> behind =
      Interpolate(p, z, 1.0 + this->SmallestSpacing / std::max(Distance(p, z), 1e-300));
    return this->SamplingDistance(z, label, this->Image.Label(behind));
  }

  /** Whether the sampling distance depends on the labels at z. */
  bool DependsOnLabels(const Point<D>& z) const
  {
    return this->Of.Size || this->Of.Interfaces ||
      (this->Of.Local && this->Of.Local->At(z).Delta < this->BaseAt(z));
  }

  /** No sampling distance is larger. */
  double Largest() const
  {
    return this->Of.Interfaces ? std::max(this->Of.Base.Delta, this->Of.Interfaces->Largest())
                               : this->Of.Base.Delta;
  }

  /** No sampling distance of a label's interfaces is larger. */
  double LargestOf(LabelId label) const
  {
    const double largest = this->Of.Interfaces ? this->Of.Interfaces->LargestOf(label) : 0.0;
    return largest > 0.0 ? largest : this->Of.Base.Delta; // no voxel may have the label any more
  }

  /** The one sampling distance with which interfaces would get about as many vertices. */
  double Equivalent() const
  {
    return this->Of.Interfaces ? this->Of.Interfaces->Equivalent() : this->Of.Base.Equivalent;
  }

  /** The least sampling distance that is asked for near p, before anything lowers it. */
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

  /** The same inside of a label: no more than the size that is asked for there. */
  double Spacing(const Point<D>& p, LabelId label) const
  {
    const double spacing = this->Spacing(p);
    return label != 0 ? std::min(spacing, this->ElementSize(p, label)) : spacing;
  }

  /** The largest circumradius of an element of a label with its circumcentre at p; infinite if there is no bound. */
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

private:
  const Domain<D>& Image;
  const SizingSources<D> Of;
  const double SmallestSize;
  double SmallestSpacing = 0.0;
};

} // namespace voxplex

#endif
