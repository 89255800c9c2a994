// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file GradedInterfaceCheck.h
 * @brief Checks that the interfaces of the image have triangles of the mesh near them, if sampling
 * distances are graded.
 */
#ifndef voxplex_GradedInterfaceCheck_h
#define voxplex_GradedInterfaceCheck_h

#include "Conformity/InterfaceSampling.h"
#include "Mesh/LabelledTriangulation.h"

#include <stop_token>
#include <vector>

namespace voxplex
{

/**
 * @brief UniformInterfaceCheck for graded meshes. Their vertices may be sparse, so this check
 * measures the distance to triangles.
 *
 * Let L be LargestDistance(). A face between voxels of different labels is far if no triangle is
 * within 1.15 L of its centre, or if none is within L of the interface point between its two voxel
 * centres. Each inspection first checks the faces that were sampled before. If none of them is far,
 * it checks all faces.
 *
 * Not thread safe; uses threads of its own. An inspection takes time linear in the number of the
 * image's surface voxels, and O(n log n) for n facets of the interfaces.
 */
class GradedInterfaceCheck
{
public:
  /**
   * The largest allowed distance of the mesh from interfaces.
   * @param delta the finest requested sampling distance
   */
  static double LargestDistance(const GridGeometry<3>& grid, double delta);

  /** Parameters as in UniformInterfaceCheck. */
  GradedInterfaceCheck(const LabelImage<3>& image, const BitMask<3>& sites, const Domain<3>& domain,
    const SizingField<3>& sizing, LocalDelta<3>& local, unsigned threads,
    const std::stop_token& stop);

  /**
   * Proposes points that repair interfaces.
   * @param edges those that are not manifold
   * @return empty if nothing is wrong, or if the label field has no finer features to sample
   * @throws Cancelled if a stop was requested before the end
   */
  std::vector<FeatureSeed<3>> Inspect(
    const LabelledTriangulation<3>& elements, const std::vector<NonManifoldPlace<3>>& edges);

  /** The number of far faces at the last inspection. */
  std::size_t NumberOfFarFaces() const { return this->FarFaces; }

private:
  const LabelImage<3>& Image;
  const BitMask<3>& Sites;
  const Domain<3>& Surfaces;
  InterfaceSampling<3> Sampling;
  const unsigned Threads;
  const std::stop_token Stop;
  const double Largest;
  std::size_t FarFaces = 0;
};

} // namespace voxplex

#endif
