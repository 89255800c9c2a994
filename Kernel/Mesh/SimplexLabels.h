// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SimplexLabels.h
 * @brief Which label each simplex of a triangulation has in the mesh.
 */
#ifndef voxplex_SimplexLabels_h
#define voxplex_SimplexLabels_h

#include "Base/UninitialisedVector.h"
#include "Delaunay/Triangulation.h"
#include "Domain/Domain.h"

#include <stop_token>

namespace voxplex
{

/** Of each simplex id; 0 for background, and for what is not alive. */
using SimplexLabels = UninitialisedVector<LabelId>;

/** That at the circumcentre of a simplex that is alive, which refinement may have asked for already. */
template <int D>
LabelId LabelAtCentre(const Triangulation<D>& triangulation, const Domain<D>& image, SimplexId s)
{
  const SimplexState& state = triangulation.State(s);
  return state.Labelled ? state.Label : image.Label(triangulation.GetCircumball(s).Center);
}

/**
 * LabelAtCentre() of all simplices (the final mesh of the thesis, section 2.2).
 *
 * Nobody may change the triangulation meanwhile.
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
