// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SlabRefinement.h
 * @brief Refines a space-time mesh slab by slab, so that it conforms to time planes.
 */
#ifndef voxplex_SlabRefinement_h
#define voxplex_SlabRefinement_h

#include "Domain/SlabDomain.h"
#include "Mesher/RefinementStage.h"

#include <map>
#include <memory>
#include <vector>

namespace voxplex
{

/**
 * @brief A triangulation for each slab between two time planes, and their union.
 *
 * The facets of a triangulation on a face of its box are the 3D Delaunay triangulation of the
 * vertices there, and a function of them alone. So two slabs match on their common plane if they
 * have the same vertices on it.
 *
 * Slabs are refined one after the other, each by all threads. From the plane between them, the next slab gets
 * what the slab before it has, and keeps it: as *shared* vertices. Where it needs more points there,
 * the slab before it gets these in the next round, and goes on from them, and so on until no plane
 * has a new point. Vertices on planes stay, and the rules keep them apart, so a plane has room for a
 * bounded number of them. After TimePlaneOptions::OpenRounds rounds planes are closed: the rules insert nothing there
 * any more. So there are at most OpenRounds + 2 rounds.
 *
 * A periodic mesh has one plane more: its two ends. It needs two slabs or more: both ends of one slab are
 * refined at the same time, and would get points that are close to each other without being equal.
 *
 * **Labels.** A pentatope with a facet on a plane has the label that the image has, on the plane, at
 * the centre of the facet's circumball. So the pentatopes on both sides have the same label, and so
 * have those at both ends of a periodic mesh. The rules know of it.
 *
 * Memory: while Refine() runs, that of the triangulations; then twice as much.
 */
class SlabRefinement final : public RefinementStage<4>
{
public:
  /** Slabs between two planes are at least this thick, in sampling distances. */
  static constexpr double ThinnestSlab = 1.0;

  /** @throws InputError if a slab is thinner than ThinnestSlab */
  SlabRefinement(const RunEnvironment<4>& run, const RefinementPlan<4>& plan);
  ~SlabRefinement() override;

  bool Refine(const std::vector<FeatureSeed<4>>& seeds, RefinementStart start,
    RunProgress& progress) override;
  const Triangulation<4>& Mesh() const override { return this->Whole; }
  Triangulation<4>& Mesh() override { return this->Whole; }
  const SizingField<4>& Sizing() const override { return this->WholeSizing; }
  std::span<const std::array<VertexId, 2>> Twins() const override { return this->Pairs; }

private:
  /** The vertices that a plane has, by their positions in space. */
  using Plane = std::map<Point<3>, VertexKind>;
  struct Slab;

  std::unique_ptr<Slab> MakeSlab(double first, double last) const;
  /** The seeds in a slab, and the points that its planes have and the slab does not. */
  std::vector<FeatureSeed<4>> MakeSeeds(
    const Slab& slab, const std::vector<FeatureSeed<4>>& seeds) const;
  bool RefineSlab(Slab& slab, const std::vector<FeatureSeed<4>>& seeds, RefinementStart start,
    RunProgress& progress);
  void TakeVertices(Slab& slab);
  bool Misses(const Slab& slab) const;
  void Unite();
  void FindTwins();
  void LabelAtPlanes();

  const RunEnvironment<4> Run;
  const RefinementPlan<4> Plan;
  std::vector<Plane> Planes; ///< in the order of TimePlanes; then, if it is periodic, the ends
  std::vector<std::unique_ptr<Slab>> Slabs;
  Triangulation<4> Whole;
  SizingField<4> WholeSizing;
  std::vector<std::array<VertexId, 2>> Pairs;
};

} // namespace voxplex

#endif
