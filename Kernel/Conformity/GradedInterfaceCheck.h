// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file GradedInterfaceCheck.h
 * @brief Whether the mesh's triangles are near the interfaces of the image, where sampling distances are graded.
 */
#ifndef voxplex_GradedInterfaceCheck_h
#define voxplex_GradedInterfaceCheck_h

#include "Conformity/InterfaceSampling.h"
#include "Mesh/SimplexMesh.h"

#include <stop_token>
#include <vector>

namespace voxplex
{

/**
 * @brief UniformInterfaceCheck for graded meshes, whose vertices may be rare: it looks at the triangles between them.
 *
 * A face between voxels of different labels is far if no triangle is within LargestDistance() of it. Each inspection looks
 * at the faces that were sampled, and at all others only when nothing is wrong with these.
 *
 * Not thread safe; uses threads of its own. An inspection takes time linear in the image's surface voxels, and n log n in
 * the number of the interfaces' facets.
 */
class GradedInterfaceCheck
{
public:
  /** The mesh may be this far from interfaces. @param delta the finest sampling distance that was asked for */
  static double LargestDistance(const GridGeometry<3>& grid, double delta);

  /** As UniformInterfaceCheck's. */
  GradedInterfaceCheck(const LabelImage<3>& image, const BitMask<3>& sites, const Domain<3>& domain,
    const SizingField<3>& sizing, LocalDelta<3>& local, unsigned threads,
    const std::stop_token& stop);

  /**
   * Points that would mend what is wrong with a mesh's interfaces.
   * @param edges of the mesh
   * @return nothing if all is well, or if the label field has no finer features to sample
   * @throws Cancelled if a stop was requested before the end
   */
  std::vector<FeatureSeed<3>> Inspect(
    const SimplexMesh<3>& mesh, const std::vector<NonManifoldPlace>& edges);

  /** At the last inspection. */
  std::size_t NumberOfFarFaces() const { return this->FarFaces; }

private:
  const LabelImage<3>& Image;
  const BitMask<3>& Sites;
  const Domain<3>& Surfaces;
  InterfaceSampling Sampling;
  const unsigned Threads;
  const std::stop_token Stop;
  const double Largest;
  std::size_t FarFaces = 0;
};

} // namespace voxplex

#endif
