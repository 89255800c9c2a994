// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SimplexLabels.h
 * @brief The label of each simplex of a triangulation in the mesh.
 */
#ifndef voxplex_SimplexLabels_h
#define voxplex_SimplexLabels_h

#include "Base/UninitialisedVector.h"
#include "Delaunay/Triangulation.h"
#include "Domain/Domain.h"

#include <stop_token>

namespace voxplex
{

/** The label of each simplex id; 0 for background and for dead simplices. */
using SimplexLabels = UninitialisedVector<LabelId>;

/**
 * The label at the circumcentre of a living simplex. If refinement has looked it up already, it is
 * not looked up again.
 */
template <int D>
LabelId LabelAtCentre(const Triangulation<D>& triangulation, const Domain<D>& image, SimplexId s)
{
  const SimplexState& state = triangulation.State(s);
  return state.Labelled ? state.Label : image.Label(triangulation.GetCircumball(s).Center);
}

/**
 * LabelAtCentre() of all simplices (the final mesh of the thesis, section 2.2).
 *
 * No thread may change the triangulation meanwhile.
 * @param threads 0 means all cores
 * @throws Cancelled if a stop was requested before the end; std::bad_alloc
 */
template <int D>
SimplexLabels LabelSimplices(const Triangulation<D>& triangulation, const Domain<D>& image,
  unsigned threads = 1, const std::stop_token& stop = {});

extern template SimplexLabels LabelSimplices<3>(
  const Triangulation<3>&, const Domain<3>&, unsigned, const std::stop_token&);
extern template SimplexLabels LabelSimplices<4>(
  const Triangulation<4>&, const Domain<4>&, unsigned, const std::stop_token&);

} // namespace voxplex

#endif
