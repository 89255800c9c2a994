// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ManifoldRepair.h
 * @brief Makes boundaries of labels manifold by giving simplices to a neighbouring label.
 */
#ifndef voxplex_ManifoldRepair_h
#define voxplex_ManifoldRepair_h

#include "Conformity/NonManifoldRidges.h"
#include "Delaunay/Triangulation.h"
#include "Domain/Domain.h"
#include "Geometry/ShapeBounds.h"
#include "Image/Components.h"
#include "Image/LabelContacts.h"
#include "Sizing/SizingField.h"

#include <functional>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

namespace voxplex
{

/** The connected components whose elements are to hold together. */
template <int D>
struct KeptComponents
{
  const Components<D>& All;
  const LabelImage<D>& Image;
  std::vector<bool> Wanted; ///< by component
};

/** Constraints on changes of an interface. */
template <int D>
struct ManifoldRepairOptions
{
  ShapeBounds Shape; ///< of new interface triangles: angles only; 3D only
  /** Background with a dihedral angle below it, or above its supplement, becomes no element. Degrees; 3D only. */
  double SliverAngle = 0.0;
  /** The meshed domain. Faces where its image cuts the object get no dents. Null: no such faces. */
  const Domain<D>* Surfaces = nullptr;
  /** Bounds the circumradius of simplices that get another label. Null: no bound. */
  const SizingField<D>* Sizing = nullptr;
  /** Changes must not make contacts, cuts and unions that the image does not have. Null: they may. */
  const LabelContacts<D>* Contacts = nullptr;
  /** Pieces of these are joined (JoinPieces). Empty: of none. */
  std::optional<KeptComponents<D>> Kept = {};
  /** Whether a simplex must keep its label. Empty: none must. */
  std::function<bool(SimplexId)> Keeps = {};
};

/** The result of RepairManifold(). */
template <int D>
struct ManifoldRepairResult
{
  std::vector<InterfaceRidge<D>> Left; ///< non-manifold ridges after it, with vertex ids
  std::vector<SimplexId> Relabelled;   ///< ascending
};

/**
 * A ridge (an edge, in 4D a triangle) is bad if the boundary of a label is not manifold there. For
 * each bad ridge, simplices around it are given to the label of a neighbour, or to background, which
 * drops them. A change is made only if it leaves fewer bad ridges; ridges off junctions have a
 * larger weight. Simplices are changed only if
 * - all their vertices are on interfaces already (MarkInterfaceVertices), so that no vertex off the interfaces gets onto
 *   them;
 * - a simplex of the old label remains at one of the vertices;
 * - they are not larger than their new label allows;
 * - none with a facet on the hull of the triangulation, such as a flat end in time, is dropped.
 *
 * A tetrahedron with a facet on a cut face is dropped only if nothing
 * else helps, because that leaves a dent in the face. There, parts of the object meet at an edge,
 * and the dent is at the rim of the face.
 *
 * The triangulation is not changed, and no thread may change it during the call. The result does
 * not depend on the number of threads. Takes time linear in the number of ridges; if there is any,
 * also in the number of simplices, but little for each of these.
 *
 * @param labels by simplex id; some are changed
 * @param ridges the result of FindNonManifoldRidges() for these labels
 * @param threads 0 means all cores
 * @throws Cancelled if a stop was requested before the end; std::bad_alloc
 */
template <int D>
ManifoldRepairResult<D> RepairManifold(const Triangulation<D>& triangulation,
  std::span<LabelId> labels, const std::vector<InterfaceRidge<D>>& ridges,
  const ManifoldRepairOptions<D>& options = {}, unsigned threads = 1,
  const std::stop_token& stop = {});

extern template ManifoldRepairResult<3> RepairManifold<3>(const Triangulation<3>&,
  std::span<LabelId>, const std::vector<InterfaceRidge<3>>&, const ManifoldRepairOptions<3>&,
  unsigned, const std::stop_token&);
extern template ManifoldRepairResult<4> RepairManifold<4>(const Triangulation<4>&,
  std::span<LabelId>, const std::vector<InterfaceRidge<4>>&, const ManifoldRepairOptions<4>&,
  unsigned, const std::stop_token&);

} // namespace voxplex

#endif
