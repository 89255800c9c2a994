// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file HiddenLayers.h
 * @brief Finds facets at which the mesh hides a layer of the image, and shows it where labels alone can.
 */
#ifndef voxplex_HiddenLayers_h
#define voxplex_HiddenLayers_h

#include "Conformity/ManifoldRepair.h"
#include "Mesh/SimplexLabels.h"

#include <array>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

namespace voxplex
{

/** A layer of the image between two simplices that share a facet. */
template <int D>
struct HiddenLayer
{
  SimplexId Cell;
  unsigned Facet; ///< of the cell; the other simplex is beside it
  /** Of the layer. If the dual edge of the facet does not pass one, the label of the cell. */
  LabelId Label;
  /** Where the dual edge enters and leaves the layer; within the domain's box. If it passes none, the facet's centroid, twice. */
  std::array<Point<D>, 2> Ends;
};

/**
 * @brief Finds the facets at which the topology of the mesh is not that of the image.
 *
 * If samples are far apart compared with a gap, a wall or a neck, circumcentres may lie on both sides
 * of it only. Then the simplices on both sides share facets, and the layer between them is hidden. The
 * dual edge of such a facet, the segment between the two circumcentres, passes the layer: it leaves the
 * label of one side before it enters that of the other. In the mesh of a dense sample no dual edge
 * meets an interface more than once (the closed ball property: Edelsbrunner and Shah, 1997; used as a
 * test by Cheng, Dey and Levine, 2007, and by Boltcheva, Yvinec and Boissonnat, 2009).
 *
 * Most edges that meet interfaces more often do no harm: they pass a bump, or the rim of a layer. A facet
 * hides a layer if
 * - its two labels do not touch near it in the image (LabelContacts::TouchNear), or
 * - it has one label on both sides, which the image does not connect around the layer
 *   (LabelContacts::AreConnected). If a circumcentre is in a voxel of the layer, edges and corners of voxels
 *   connect, too: there the label field is smoother than the voxels.
 *
 * Labels that were given by a repair may hide layers, too; dual edges need not pass these.
 *
 * Safe to use from several threads, as long as nobody changes the triangulation or the labels. A
 * facet takes a few look-ups of voxels; if all its vertices are on interfaces, a walk along its dual edge.
 */
template <int D>
class HiddenLayerFinder
{
public:
  /** All must outlive this object. Options must have a domain, and contacts. */
  HiddenLayerFinder(const Triangulation<D>& triangulation, std::span<const LabelId> labels,
    const ManifoldRepairOptions<D>& options)
    : Mesh(triangulation)
    , Labels(labels)
    , Surfaces(*options.Surfaces)
    , Contacts(*options.Contacts)
  {
  }

  /** The layer that facet i of a simplex hides, if it does. */
  std::optional<HiddenLayer<D>> Find(SimplexId s, unsigned i) const;

  /** Whether a facet separates two labels that do not touch near it. */
  bool IsFalseContact(SimplexId s, unsigned i, LabelId a, LabelId b) const;

private:
  std::optional<Point<D>> CrossingAt(
    const Point<D>& end, const Point<D>& other, LabelId layer) const;

  const Triangulation<D>& Mesh;
  const std::span<const LabelId> Labels;
  const Domain<D>& Surfaces;
  const LabelContacts<D>& Contacts;
};

/**
 * The layers that the facets of some simplices hide, each once, in the order of simplex ids.
 * @param simplices ascending; null: all
 * @param threads 0 means all cores; the result does not depend on it
 * @throws Cancelled if a stop was requested before the end; std::bad_alloc
 */
template <int D>
std::vector<HiddenLayer<D>> FindHiddenLayers(const Triangulation<D>& triangulation,
  std::span<const LabelId> labels, const std::vector<SimplexId>* simplices,
  const ManifoldRepairOptions<D>& options, unsigned threads, const std::stop_token& stop);

/**
 * Shows layers by giving one of the two simplices of a facet the label of the layer, or another one
 * beside it, where ChangeRules allow it. The rest needs finer sampling. For threads and errors, see
 * RepairManifold().
 * @param labels by simplex id; some are changed
 * @return the simplices whose label was changed, ascending
 */
template <int D>
std::vector<SimplexId> ShowHiddenLayers(const Triangulation<D>& triangulation,
  std::span<LabelId> labels, const std::vector<HiddenLayer<D>>& layers,
  const ManifoldRepairOptions<D>& options, unsigned threads, const std::stop_token& stop);

} // namespace voxplex

#endif
