// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file InterfaceFit.h
 * @brief Moves the vertices of interfaces so that volumes are right.
 */
#ifndef voxplex_InterfaceFit_h
#define voxplex_InterfaceFit_h

#include "Domain/Domain.h"
#include "Domain/TimePlanes.h"
#include "Image/LabelImage.h"
#include "Optimisation/Complex.h"
#include "Sizing/SizingField.h"

#include <cstdint>
#include <limits>
#include <span>
#include <stop_token>

namespace voxplex
{

/** What FitInterfaces() keeps. An element that violates a bound already gets no worse. */
template <int D>
struct FitBounds
{
  /** No vertex moves further along an axis, or out of its bounding box, than MoveLimits allows. */
  const LabelImage<D>& Image;
  const TimePlanes& Planes;      ///< their vertices stay on them; 4D only
  double NormalizedVolume = 0.0; ///< at least
  double RadiusEdgeRatio = std::numeric_limits<double>::infinity(); ///< at most
  double FacetAngle = 0.0; ///< smallest planar angle of interface triangles, in degrees; 3D only
  const SizingField<D>* Sizing = nullptr; ///< circumradii are below its element sizes; may be null
  /**
   * The volume that each label id is to have. In 3D only; all labels must be inside of the box.
   * Empty: what the distances from the interfaces give.
   */
  std::span<const double> Volumes = {};
};

/**
 * @brief Moves the vertices of interfaces, so that facets lie on the interfaces on average.
 *
 * All vertices of a facet lie on the interface, so the facet is a chord: where the interface is convex,
 * its label loses volume. The loss grows with the square of delta, and with each dimension. Let
 * h(f) be the distance, along the normal n(f), from the centroid of a facet f to the interface. If
 * the interface is a quadric, its mean distance from the chord is D / (D + 1) h(f). So the
 * displacements d(v) of the D vertices should satisfy
 *
 *     1/D sum n(f) . d(v) = D / (D + 1) h(f) + o    for each facet f,
 *
 * in the least-squares sense, weighted by the volumes of the facets. A few Jacobi steps, which
 * begin with d = 0, solve this well enough: d remains smooth. Where interfaces meet, the
 * displacement of a vertex serves the facets of all of them. The offset o is the same for all facets
 * between two labels. It is found before each step, so that labels gain the volumes that they are to
 * gain (InterfaceOffsets).
 *
 * Free vertices stay. Vertices on the cut faces, on flat ends and on time
 * planes stay on them. Twins are one vertex with the facets of both. The steps of the vertices of a
 * simplex, inside or outside of the object, are halved, then dropped, where it would lose nine tenths
 * of its volume or violate a bound, or a component would be lost. So the moved triangulation is a
 * triangulation of the same box. There are two rounds, in 4D three: from the second on, other vertices
 * make up for those that had to stay.
 *
 * O(n) time for n cells, and one search for an interface for each facet. The result does not depend on
 * the number of threads.
 *
 * @param complex with the cells around the object. Its twins move alike. No step that would lose one of
 *   its protected components is made.
 * @param threads 0 means all cores
 * @return the number of vertices of interfaces
 * @throws Cancelled if a stop was requested before the end; std::bad_alloc
 */
template <int D>
std::uint64_t FitInterfaces(Complex<D>& complex, const Domain<D>& surfaces,
  const FitBounds<D>& bounds, unsigned threads = 1, const std::stop_token& stop = {});

extern template std::uint64_t FitInterfaces<3>(
  Complex<3>&, const Domain<3>&, const FitBounds<3>&, unsigned, const std::stop_token&);
extern template std::uint64_t FitInterfaces<4>(
  Complex<4>&, const Domain<4>&, const FitBounds<4>&, unsigned, const std::stop_token&);

} // namespace voxplex

#endif
