// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file InterfaceFit.h
 * @brief Moves the vertices of space-time interfaces so that volumes are right.
 */
#ifndef voxplex_InterfaceFit_h
#define voxplex_InterfaceFit_h

#include "Base/UninitialisedVector.h"
#include "Delaunay/Triangulation.h"
#include "Domain/Domain.h"
#include "Domain/TimePlanes.h"
#include "Image/LabelImage.h"
#include "Mesh/SimplexLabels.h"
#include "Quality/ComponentGuard.h"
#include "Sizing/SizingField.h"

#include <array>
#include <cstdint>
#include <span>
#include <stop_token>

namespace voxplex
{

/** Shapes that FitInterfaces() keeps. An element that is worse already gets no worse. */
struct FitBounds
{
  double NormalizedVolume = 0.01; ///< at least
  double RadiusEdgeRatio = 2.0;   ///< at most
  const SizingField<4>* Sizing;   ///< circumradii are below its element sizes; may be null
  /**
   * No vertex moves by more than half a voxel along an axis, or by more than a voxel out of the
   * bounding box.
   */
  const LabelImage<4>& Image;
  const TimePlanes& Planes; ///< their vertices stay on them
  /**
   * Pairs of vertices that make the same steps, with the first and the last time of a periodic mesh;
   * ascending by the first.
   */
  std::span<const std::array<VertexId, 2>> Twins = {};
  /** No step that would lose one of its components is made. Null: all are. */
  ComponentGuard<4>* Guard = nullptr;
};

/** The result of FitInterfaces(). */
struct FittedPositions
{
  UninitialisedVector<Point<4>> Positions; ///< of each vertex id of the triangulation
  std::uint64_t Vertices = 0;              ///< vertices of interfaces
};

/**
 * @brief Computes positions for the vertices of interfaces, so that facets lie on the interfaces on
 * average.
 *
 * All vertices of a facet lie on the interface, so the facet is a chord: where the interface is convex,
 * its label loses volume. The loss grows with the square of delta, and with each dimension. Let
 * h(f) be the distance, along the normal n(f), from the centroid of a facet f to the interface. If
 * the interface is a quadric, its mean distance from the chord is 4/5 h(f). So the displacements
 * d(v) of the four vertices should satisfy
 *
 *     1/4 sum n(f) . d(v) = 4/5 h(f)    for each facet f,
 *
 * in the least-squares sense, weighted by the volumes of the facets. A few Jacobi steps, which
 * begin with d = 0, solve this well enough: d remains smooth. Where interfaces meet, the
 * displacement of a vertex serves the facets of all of them.
 *
 * Free vertices stay. Vertices on flat ends and time planes stay on them. Twins are one vertex with
 * the facets of both. The steps of the vertices of a simplex, inside or outside of the object, are
 * halved, twice, then dropped, where it would be turned over or violate a bound, or a component
 * would be lost. So the moved triangulation is a triangulation of the same box. There are three
 * rounds. In the second and third, targets h(f) are larger by what the rounds before have missed,
 * so that other vertices make up for those that had to stay.
 *
 * O(n) time for n simplices, and one search for an interface for each facet. The result does not
 * depend on the number of threads. No thread may change the triangulation meanwhile.
 *
 * @param labels of each simplex id
 * @param threads 0 means all cores
 * @throws Cancelled if a stop was requested before the end; std::bad_alloc
 */
FittedPositions FitInterfaces(const Triangulation<4>& triangulation, const Domain<4>& surfaces,
  const SimplexLabels& labels, const FitBounds& bounds, unsigned threads = 1,
  const std::stop_token& stop = {});

} // namespace voxplex

#endif
