// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file InterfaceSizes.h
 * @brief Sampling distances of single interfaces, apart from delta and from the sizes of elements.
 */
#ifndef voxplex_InterfaceSizes_h
#define voxplex_InterfaceSizes_h

#include "Image/LabelImage.h"
#include "Sizing/BaseDistance.h"
#include "Sizing/GradedGrid.h"

#include <algorithm>
#include <cstdint>
#include <stop_token>
#include <unordered_map>
#include <vector>

namespace voxplex
{

/**
 * The sampling distance that a user asks for at the interface between two labels, or at all
 * interfaces of one label.
 */
struct InterfaceSize
{
  /** Stands for the second label: the size holds for all interfaces of the first. */
  static constexpr std::int64_t AnyLabel = -1;

  std::int64_t Label = 0; ///< the image's own value; 0 is background
  std::int64_t Other = AnyLabel;
  double Size = 0.0; ///< sampling distance; positive and finite
};

/**
 * @brief The sampling distance of the interface between any two labels, and how it changes in
 * space.
 *
 * If a distance is given for the pair of labels, it holds. Otherwise, if distances are given for
 * one or both labels, the smaller holds. Otherwise delta holds, which may be graded (BaseDistance).
 * A given distance may be larger than delta.
 *
 * Interfaces meet at junctions, and interfaces with different distances may run near each other. If
 * the gradation g is positive, distances change by at most g over a unit of length: near a fine
 * interface, coarse interfaces become finer (GradedGrid over all voxel faces between labels). If
 * the gradation is 0, the removal rule still has to spare the vertices of a finer interface:
 * GradedAt() then has the slope SafeSlope.
 *
 * Immutable after construction; safe to query from any thread.
 */
template <int D>
class InterfaceSizes
{
public:
  /** The slope of LocalDelta, which spares small components in the same way. */
  static constexpr double SafeSlope = 0.25;

  /**
   * @param image the labels; needed during construction only
   * @param sizes the interfaces whose distance differs from delta
   * @param base the distance of all other interfaces; if it is graded, its grid must outlive this
   *   object
   * @param gradation change of distances over a unit of length; 0: no limit
   * @param threads 0 means all cores; the result does not depend on it
   * @throws InputError if a label does not occur in the image, a pair is given twice or has one
   *   label twice, or a size is not positive and finite
   * @throws Cancelled if a stop was requested before the end
   */
  InterfaceSizes(const LabelImage<D>& image, const std::vector<InterfaceSize>& sizes,
    const BaseDistance<D>& base, double gradation, unsigned threads,
    const std::stop_token& stop = {});

  /** The sampling distance at a point of an interface, without the gradation. */
  double Between(const Point<D>& z, LabelId a, LabelId b) const
  {
    const double given = this->Given(a, b);
    return std::isfinite(given) ? given : this->Base.At(z);
  }

  /** The sampling distance at a point of an interface, with the gradation. */
  double At(const Point<D>& z, LabelId a, LabelId b) const
  {
    const double between = this->Between(z, a, b);
    return this->IsGraded ? std::min(between, this->Grid.At(z)) : between;
  }

  /**
   * The sampling distance that the finer interfaces ask for at any point of the frame; infinite if
   * all interfaces have the largest distance.
   */
  double GradedAt(const Point<D>& p) const { return this->Grid.At(p); }

  ///@{
  /** Bounds of the sampling distance over the interfaces that the image has. */
  double Smallest() const { return this->SmallestSize; }
  double Largest() const { return this->LargestSize; }
  ///@}

  /** The uniform sampling distance that gives about as many vertices, without the gradation. */
  double Equivalent() const { return this->EquivalentSize; }

  /** The largest sampling distance of the interfaces of a label. */
  double LargestOf(LabelId label) const { return this->LargestOfLabel[label]; }

private:
  static std::uint64_t Key(LabelId a, LabelId b)
  {
    return std::uint64_t(std::max(a, b)) << 32 | std::min(a, b);
  }

  /** The distance that is given for an interface; infinite if none is. */
  double Given(LabelId a, LabelId b) const
  {
    const auto pair = this->OfPair.find(Key(a, b));
    return pair != this->OfPair.end() ? pair->second : std::min(this->OfLabel[a], this->OfLabel[b]);
  }

  void Take(const LabelImage<D>& image, const std::vector<InterfaceSize>& sizes);
  void Summarise(const LabelImage<D>& image, unsigned threads, const std::stop_token& stop);

  std::unordered_map<std::uint64_t, double> OfPair;
  std::vector<double> OfLabel; ///< by dense id; infinite: not given
  BaseDistance<D> Base;
  bool IsGraded;
  double SmallestSize = 0.0;
  double LargestSize = 0.0;
  double EquivalentSize = 0.0;
  std::vector<double> LargestOfLabel;
  GradedGrid<D> Grid; ///< of the interfaces below the largest distance
};

extern template class InterfaceSizes<3>;
extern template class InterfaceSizes<4>;

} // namespace voxplex

#endif
