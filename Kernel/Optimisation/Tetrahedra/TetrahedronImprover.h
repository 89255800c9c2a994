// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TetrahedronImprover.h
 * @brief Improves one poor tetrahedron, by whatever helps.
 */
#ifndef voxplex_TetrahedronImprover_h
#define voxplex_TetrahedronImprover_h

#include "Domain/Domain.h"
#include "Optimisation/Patch.h"
#include "Optimisation/Tetrahedra/Flips.h"
#include "Optimisation/Tetrahedra/InterfaceRules.h"
#include "Optimisation/Tetrahedra/Smoother.h"

#include <cstdint>

namespace voxplex
{

/** Additional measures for tetrahedra that flips and smoothing do not improve enough. */
enum class Effort
{
  Plain,
  Insertions,        ///< also inserts vertices
  MovesOffInterfaces ///< also moves vertices off interfaces
};

/** @brief Flips, then smoothing, then the measures of an effort. For PatchWorker. */
class TetrahedronImprover
{
public:
  /** @param reach, anchors see Smoother */
  TetrahedronImprover(Patch<3>& patch, const Domain<3>& domain, const InterfaceRules& rules,
    double reach, AnchorMap& anchors, Effort effort)
    : Mesh(patch.Mesh())
    , Topology(patch, rules)
    , Geometry(patch, domain, rules, reach, anchors)
    , Most(effort)
  {
  }

  bool Improve(std::uint32_t t);

  const FlipStatistics& GetFlipStatistics() const { return this->Topology.Counts(); }
  const SmoothingStatistics& GetSmoothingStatistics() const { return this->Geometry.Counts(); }

private:
  bool ImproveAsLastResort(std::uint32_t t);

  const TetrahedralComplex& Mesh;
  Flips Topology;
  Smoother Geometry;
  const Effort Most;
};

} // namespace voxplex

#endif
