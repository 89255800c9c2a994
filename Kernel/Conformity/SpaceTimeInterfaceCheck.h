// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SpaceTimeInterfaceCheck.h
 * @brief Checks that the interfaces of a refined space-time mesh match those of the image.
 */
#ifndef voxplex_SpaceTimeInterfaceCheck_h
#define voxplex_SpaceTimeInterfaceCheck_h

#include "Conformity/ConformityCheck.h"
#include "Conformity/ConformityOptions.h"
#include "Conformity/InterfaceStatistics.h"
#include "Conformity/InterfaceVertices.h"
#include "Conformity/UniformInterfaceCheck.h"

#include <stop_token>

namespace voxplex
{

/**
 * @brief Requests points where the image has an interface and no vertex of the mesh's interfaces is
 * near.
 *
 * Not thread safe; uses threads of its own. No thread may change the triangulation during a call.
 */
class SpaceTimeInterfaceCheck final : public ConformityCheck<4>
{
public:
  /**
   * All references must outlive the check.
   * @param sites surface voxels of the image
   * @param local receives the spacing of the points to be inserted, and bounds
   * @param statistics counts rounds and points
   * @param threads 0 means all cores
   */
  SpaceTimeInterfaceCheck(const Triangulation<4>& mesh, const LabelImage<4>& image,
    const BitMask<4>& sites, const Domain<4>& surfaces, const SizingField<4>& sizing,
    const InterfaceOptions& options, LocalDelta<4>& local, InterfaceStatistics& statistics,
    double& seconds, unsigned threads, const std::stop_token& stop);

  /** Requests no points once the number of rounds has reached the limit in the options. */
  Remedy<4> InspectTriangulation() override;

private:
  const unsigned MostRounds;
  InterfaceStatistics& Statistics;
  InterfaceVertices<4> Vertices;
  UniformInterfaceCheck<4> Distances;
};

} // namespace voxplex

#endif
