// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshMeasures.h
 * @brief Measures of a tetrahedral mesh of any mesher, for comparisons.
 */
#ifndef voxplex_MeshMeasures_h
#define voxplex_MeshMeasures_h

#include "LabelVolume.h"
#include "Mesh/SimplexMesh.h"

#include <cstdint>
#include <map>

namespace voxplex::benchmarks
{

/**
 * Angles are in degrees. A facet is on an interface if its two sides have different labels (outside
 * is 0).
 */
struct MeshMeasures
{
  std::uint64_t Tetrahedra = 0;
  std::uint64_t Inverted = 0; ///< tetrahedra without a positive volume
  double RadiusEdgeMax = 0.0;
  double DihedralMin = 180.0;
  double DihedralMax = 0.0;
  std::uint64_t InterfaceFacets = 0;
  double PlanarMin = 180.0;                  ///< of all interface facets
  double PlanarMinAwayFromJunctions = 180.0; ///< no vertex of the facet touches three labels
  std::uint64_t PlanarBelow30 = 0;           ///< of all interface facets
  std::uint64_t PlanarBelow30AwayFromJunctions = 0;
  std::uint64_t LabelsInImage = 0;
  std::uint64_t LabelsLost = 0;
  double VolumeError = 0.0; ///< sum over labels of |mesh - image| over the volume of the image
};

/** The volume of each label of an image, without background. */
using LabelVolumes = std::map<std::int64_t, double>;
LabelVolumes VolumesOf(const LabelVolume& image);

/**
 * Measures a mesh from its points, tetrahedra and labels. Facets and FacetLabels are not used. The
 * mesh may be in any rigid position. Time O(n log n).
 */
MeshMeasures Measure(const SimplexMesh<3>& mesh, const LabelVolumes& image);

} // namespace voxplex::benchmarks

#endif
