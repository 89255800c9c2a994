// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file OpenRidges.h
 * @brief Makes boundaries of labels manifold at edges (4D: triangles) where giving whole simplices to
 * another label does not help.
 */
#ifndef voxplex_OpenRidges_h
#define voxplex_OpenRidges_h

#include "Domain/Domain.h"
#include "Domain/TimePlanes.h"
#include "Image/LabelContacts.h"
#include "Optimisation/Complex.h"
#include "Quality/InterfaceEdges.h"
#include "Sizing/SizingField.h"

#include <stop_token>
#include <vector>

namespace voxplex
{

/** What OpenRidges() looks at in addition. All is optional. */
template <int D>
struct OpeningContext
{
  /** 4D: pieces with a circumradius above its element sizes count as bad shapes. Null: no bound. */
  const SizingField<D>* Sizing = nullptr;
  /** Fillings that make contacts or connections which the image does not have are the last choice. Null: they are not. */
  const LabelContacts<D>* Contacts = nullptr;
  /** 4D: cells with a facet on them, or on an end of a periodic mesh, keep their labels. */
  TimePlanes Planes = {};
};

/**
 * A ridge is an edge in 3D and a triangle in 4D. At a non-manifold ridge, the simplices of some
 * label form more than one run around it. The simplices of some runs are cut in pieces. The pieces
 * at the ridge form a spindle around it, or a sector of one, and get another label that occurs
 * around the ridge. After that, each label except background has one run. This is always possible,
 * because the whole spindle can get a single label.
 *
 *           s                   ab     the ridge, seen along it (3D: an edge)
 *          /|\                  r, s   vertices around it
 *         / | \                 p, q   new ones on the facets abr, abs
 *        /  q  \                abpq   part of the spindle
 *       / /   \ \               aprs, bprs, apqs, bpqs keep their label
 *      ab----p---r
 *
 * In 4D, with a ridge abc, the part of the spindle is abcpq, and abprs, bcprs, caprs, abpqs, bcpqs
 * and capqs keep their label. Where the triangulation ends at the ridge, as on the flat ends in
 * time, what lies beyond counts as background that cannot be cut.
 *
 * **Each spindle removes one non-manifold ridge and makes no new one,** with any labels. Let sigma be
 * the ridge, L the label of the spindle, and tau a facet of sigma (3D: a or b). The simplices that
 * are cut fill one arc around sigma, with those in between that have L already. Where a cut simplex
 * is beside one with L, their facet gets no new vertex; between two such it is cut by a vertex inside.
 * - Around sigma: the arc is chosen so that each label has one run.
 * - Around old ridges: those with r and s lie in pieces that keep their label. Around tau r a piece
 *   of L is added only if there is no new vertex on the facet of sigma and r. Then it is beside the
 *   simplex with L, whose run grows, and a piece of the old label follows.
 * - Around new ridges: around tau p are pieces of L, then of the label of one simplex, then of that
 *   of the other. If one of the two is not cut, it lies on both sides of the facet as one run. The
 *   other new ridges are inside of a simplex or between two. Each label has one run there.
 * New vertices lie inside of facets and simplices, so no spindle cuts another one's ridge, and there
 * are as many spindles as ridges.
 *
 * Each simplex keeps pieces with its own label, so no element is lost. It is cut at most once for each
 * of its ridges. New vertices lie at one of a few fixed positions in their facet or
 * simplex, so the shapes of the simplices bound the shapes of the pieces. Of all possible cuts, the
 * one with the best shapes in the mesh is taken. A cut that makes dents or bulges in cut faces is taken
 * only if there is no other; so is one that makes labels touch, or
 * connects parts of one, where the image does not (OpeningContext::Contacts).
 *
 * Takes time linear in the number of ridges, if few simplices share one. Ridges with many runs around
 * them take longer.
 *
 * @param complex with the cells around the object
 * @param ridges the non-manifold ridges
 * @return those that are left: only where simplices are flat within rounding
 * @throws Cancelled if a stop was requested before the end; std::bad_alloc
 */
template <int D>
std::vector<InterfaceRidge<D>> OpenRidges(Complex<D>& complex, const Domain<D>& domain,
  const std::vector<InterfaceRidge<D>>& ridges, const OpeningContext<D>& context = {},
  const std::stop_token& stop = {});

extern template std::vector<InterfaceRidge<3>> OpenRidges<3>(Complex<3>&, const Domain<3>&,
  const std::vector<InterfaceRidge<3>>&, const OpeningContext<3>&, const std::stop_token&);
extern template std::vector<InterfaceRidge<4>> OpenRidges<4>(Complex<4>&, const Domain<4>&,
  const std::vector<InterfaceRidge<4>>&, const OpeningContext<4>&, const std::stop_token&);

} // namespace voxplex

#endif
