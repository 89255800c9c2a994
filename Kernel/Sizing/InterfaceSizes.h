// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file InterfaceSizes.h
 * @brief Sampling densities of single interfaces, apart from delta and from the sizes of elements.
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

/** What a user asks for the interface between two labels, or for all interfaces of one. */
struct InterfaceSize
{
  /** Stands for the second label: all interfaces of the first. */
  static constexpr std::int64_t AnyLabel = -1;

  std::int64_t Label = 0; ///< the image's own value; 0 is background
  std::int64_t Other = AnyLabel;
  double Size = 0.0; ///< sampling density, as delta is one; positive and finite
};

/**
 * @brief The sampling density of the interface between any two labels, and how it changes in space.
 *
 * What is given for a pair of labels counts; else the smaller of what is given for the two labels; else
 * delta, which may be graded (BaseDistance). A density may be larger than delta.
 *
 * Interfaces meet at junctions, and those with different densities may run near each other. With a gradation of g densities
 * change by at most g over a unit of length: a fine interface makes coarse ones finer that are near it (GradedGrid over all
 * voxel faces between labels). Without, R6 still has to spare the vertices that serve a finer interface: GradedAt() then has the
 * slope SafeSlope.
 *
 * Immutable after construction; safe to query from any thread.
 */
template <int D>
class InterfaceSizes
{
public:
  /** As of LocalDelta, by which small components are spared. */
  static constexpr double SafeSlope = 0.25;

  /**
   * @param image the labels; needed during construction only
   * @param sizes what differs from delta
   * @param base what counts elsewhere; if it is graded, that must live as long as this
   * @param gradation change of densities over a unit of length; 0: no limit
   * @param threads 0 means all cores; the result does not depend on it
   * @throws InputError if a label does not occur in the image, a pair is given twice or has one label twice, a size is not
   *   positive and finite
   * @throws Cancelled if a stop was requested before the end
   */
  InterfaceSizes(const LabelImage<D>& image, const std::vector<InterfaceSize>& sizes,
    const BaseDistance<D>& base, double gradation, unsigned threads,
    const std::stop_token& stop = {});

  /** The density at a point of an interface, its surroundings aside. */
  double Between(const Point<D>& z, LabelId a, LabelId b) const
  {
    const double given = this->Given(a, b);
    return std::isfinite(given) ? given : this->Base.At(z);
  }

  /** The density at a point of the interface. */
  double At(const Point<D>& z, LabelId a, LabelId b) const
  {
    const double between = this->Between(z, a, b);
    return this->IsGraded ? std::min(between, this->Grid.At(z)) : between;
  }

  /** What the densest interfaces ask for at any point of the frame; infinite if none is below the largest density. */
  double GradedAt(const Point<D>& p) const { return this->Grid.At(p); }

  ///@{
  /** Bounds of the density over the interfaces that the image has. */
  double Smallest() const { return this->SmallestSize; }
  double Largest() const { return this->LargestSize; }
  ///@}

  /** The one density with which interfaces would get about as many vertices, gradation aside. */
  double Equivalent() const { return this->EquivalentSize; }

  /** The largest density of any interface that a label has. */
  double LargestOf(LabelId label) const { return this->LargestOfLabel[label]; }

private:
  static std::uint32_t Key(LabelId a, LabelId b)
  {
    return std::uint32_t(std::max(a, b)) << 16 | std::min(a, b);
  }

  /** What is given for an interface; infinite if nothing is. */
  double Given(LabelId a, LabelId b) const
  {
    const auto pair = this->OfPair.find(Key(a, b));
    return pair != this->OfPair.end() ? pair->second : std::min(this->OfLabel[a], this->OfLabel[b]);
  }

  void Take(const LabelImage<D>& image, const std::vector<InterfaceSize>& sizes);
  void Summarise(const LabelImage<D>& image, unsigned threads, const std::stop_token& stop);

  std::unordered_map<std::uint32_t, double> OfPair;
  std::vector<double> OfLabel; ///< by dense id; infinite if not given
  BaseDistance<D> Base;
  bool IsGraded;
  double SmallestSize = 0.0;
  double LargestSize = 0.0;
  double EquivalentSize = 0.0;
  std::vector<double> LargestOfLabel;
  GradedGrid<D> Grid; ///< of what is below the largest
};

extern template class InterfaceSizes<3>;
extern template class InterfaceSizes<4>;

} // namespace voxplex

#endif
