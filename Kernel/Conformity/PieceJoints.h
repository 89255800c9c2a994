// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PieceJoints.h
 * @brief Connects the pieces of a component by giving its label to the simplices between them.
 */
#ifndef voxplex_PieceJoints_h
#define voxplex_PieceJoints_h

#include "Conformity/ManifoldRepair.h"
#include "Image/FacesNear.h"

#include <cstdint>
#include <span>
#include <stop_token>
#include <vector>

namespace voxplex
{

/** A place between two pieces of a component. */
template <int D>
struct PieceGap
{
  SearchBall<D> Where;
  std::uint32_t Component;
};

/** Which gaps JoinPieces() leaves to finer sampling. */
struct GapOptions
{
  double Smallest = 0.0; ///< smaller pieces, by volume, have no gaps
  bool AreLast = false;  ///< nothing is sampled any more
};

/** The result of JoinPieces(). */
template <int D>
struct JoinedPieces
{
  std::vector<SimplexId> Relabelled; ///< ascending
  std::vector<PieceGap<D>> Gaps;     ///< along the ways between pieces that are still apart
};

/**
 * @brief Connects pieces of components (ComponentPieces).
 *
 * If a part of a component is thin compared with the sampling distance, circumcentres lie in it here
 * and there only. Then the component has pieces that hang together at edges and vertices, or not at
 * all, and a finite-element model of them falls apart.
 *
 * All pieces of a component but the largest are looked at. From each, a way is searched to another
 * piece, through the fewest simplices that the component passes: those with the centroid of the simplex, of
 * a facet or of an edge in one of its voxels. If ChangeRules allow it, these simplices get the label of the
 * component. Some of the next best ways are tried, too. Where none is allowed,
 * - a large piece has a gap on the first one, which needs finer sampling. If nothing is sampled any more,
 *   ways may also lead through simplices with vertices off the interfaces, between voxels of the component and
 *   others: where a part of one voxel turns, the label field does not connect it, however finely it is sampled;
 * - one that has no gap, or that finer sampling has not helped, gets the label beside it with the largest common
 *   area that the rules allow, if it is smaller than a voxel, or has no gap and at most five simplices.
 *
 * The thesis keeps all pieces.
 *
 * Nobody may change the triangulation during the call. Takes time linear in the number of simplices,
 * and in those that are looked at between pieces.
 *
 * @param labels by simplex id; some are changed
 * @param options of the repair that comes next, with the components to keep. Pieces of others are given
 *   away only.
 * @throws Cancelled if a stop was requested before the end; std::bad_alloc
 */
template <int D>
JoinedPieces<D> JoinPieces(const Triangulation<D>& triangulation, std::span<LabelId> labels,
  const ManifoldRepairOptions<D>& options, GapOptions gaps, unsigned threads,
  const std::stop_token& stop);

} // namespace voxplex

#endif
