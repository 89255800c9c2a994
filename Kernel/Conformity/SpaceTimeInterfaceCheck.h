// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SpaceTimeInterfaceCheck.h
 * @brief Checks that the interfaces of a refined space-time mesh match those of the image, and are
 * manifold.
 */
#ifndef voxplex_SpaceTimeInterfaceCheck_h
#define voxplex_SpaceTimeInterfaceCheck_h

#include "Conformity/ConformityCheck.h"
#include "Conformity/ConformityOptions.h"
#include "Conformity/InterfaceStatistics.h"
#include "Conformity/InterfaceVertices.h"
#include "Conformity/ManifoldLabels.h"
#include "Conformity/UniformInterfaceCheck.h"

#include <functional>
#include <stop_token>
#include <vector>

namespace voxplex
{

/**
 * @brief Gives pentatopes their labels, and requests points where the image has an interface and no
 * vertex of the mesh's interfaces is near.
 *
 * Some pentatopes get another label, to make the boundary of a label manifold (RepairManifold).
 * Triangles that are still not manifold are told, so that they can be opened (MakeSpindles) when
 * vertices are where they stay.
 *
 * Not thread safe; uses threads of its own. No thread may change the triangulation during a call.
 */
class SpaceTimeInterfaceCheck final : public ConformityCheck<4>
{
public:
  /**
   * All references must outlive the check.
   * @param mayRefine whether points may be requested
   * @param sites surface voxels of the image
   * @param keeps whether a pentatope must keep its label; empty: none must
   * @param local receives the spacing of the points to be inserted, and bounds
   * @param statistics counts rounds, points and triangles
   * @param threads 0 means all cores
   */
  SpaceTimeInterfaceCheck(const Triangulation<4>& mesh, const LabelImage<4>& image,
    const BitMask<4>& sites, const Domain<4>& surfaces, const SizingField<4>& sizing,
    const InterfaceOptions& options, bool mayRefine, std::function<bool(SimplexId)> keeps,
    LocalDelta<4>& local, InterfaceStatistics& statistics, double& seconds, unsigned threads,
    const std::stop_token& stop);

  /** Requests no points once the number of rounds has reached the limit in the options. */
  Remedy<4> InspectTriangulation() override;

  /** Valid if InspectTriangulation() requested nothing. */
  const ManifoldLabels<4>& Labels() const { return this->Made; }

private:
  Remedy<4> Counted(std::vector<FeatureSeed<4>> points);

  const bool Repairs; ///< whether boundaries are made manifold
  const unsigned MostRounds;
  ManifoldLabels<4> Made;
  InterfaceStatistics& Statistics;
  InterfaceVertices<4> Vertices;
  ManifoldLabeller<4> Labeller;
  UniformInterfaceCheck<4> Distances;
};

} // namespace voxplex

#endif
