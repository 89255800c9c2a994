// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshQuality.h
 * @brief Quality of a mesh: shapes, violations of the promised bounds, volume of each label.
 */
#ifndef voxplex_MeshQuality_h
#define voxplex_MeshQuality_h

#include "Geometry/ShapeBounds.h"
#include "Mesh/SimplexMesh.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace voxplex
{

/** Size of one label. */
struct LabelMeasure
{
  std::int64_t Label = 0;
  std::uint64_t Elements = 0;
  double Volume = 0.0; ///< D-dimensional, in the mesh's unit of length
};

/**
 * Angles are in degrees. A figure that does not apply (no element, no facet, not for this D) is NaN
 * or 0.
 */
struct MeshQuality
{
  static constexpr double NotApplicable = std::numeric_limits<double>::quiet_NaN();
  /** Bins of NormalizedVolumes, each 1 / NumberOfBins wide. */
  static constexpr std::size_t NumberOfBins = 20;
  /** Bins of angles, each 2 degrees wide. */
  static constexpr std::size_t NumberOfAngleBins = 90;
  /** Bins of RadiusEdgeRatios, each RatioBinWidth wide. */
  static constexpr std::size_t NumberOfRatioBins = 90;
  static constexpr double AngleBinWidth = 2.0;
  static constexpr double RatioBinWidth = 0.05;
  /** The smallest angle required of facets at junctions, degrees. */
  static constexpr double JunctionFacetAngle = ShapeBounds::DefaultJunctionFacetAngle;

  double ShortestEdge = NotApplicable; ///< of all elements

  double MaximumRadiusEdgeRatio = NotApplicable;
  double MeanRadiusEdgeRatio = NotApplicable;      ///< infinite if some element is flat
  double RadiusEdgeRatioDeviation = NotApplicable; ///< standard deviation; NaN if some are flat
  std::uint64_t RadiusEdgeViolations = 0;          ///< elements at or above the bound

  double MinimumDihedralAngle = NotApplicable; ///< 3D only
  double MaximumDihedralAngle = NotApplicable; ///< 3D only
  /**
   * All six angles of all elements. Bin i counts angles from 2 i to below 2 (i + 1) degrees; the
   * last bin also counts 180. 3D only.
   */
  std::array<std::uint64_t, NumberOfAngleBins> DihedralAngles{};
  /**
   * Elements by radius-edge ratio. Bin i counts ratios from i / 20 to below (i + 1) / 20; the last
   * bin also counts all ratios above.
   */
  std::array<std::uint64_t, NumberOfRatioBins> RadiusEdgeRatios{};

  /**
   * Volume divided by the volume of the regular simplex with the same circumradius; 1 is best, 0 is
   * flat.
   */
  double MinimumNormalizedVolume = NotApplicable;
  double MeanNormalizedVolume = NotApplicable;
  double NormalizedVolumeDeviation = NotApplicable; ///< standard deviation
  /**
   * Elements by normalized volume. Bin i counts volumes from i / 20 to below (i + 1) / 20; the last
   * bin also counts 1.
   */
  std::array<std::uint64_t, NumberOfBins> NormalizedVolumes{};

  double MinimumFacetAngle = NotApplicable; ///< planar angle of the interface facets; 3D only
  std::uint64_t FacetAngleViolations = 0;   ///< facets with an angle below the bound; 3D only
  /**
   * Such facets that touch a junction: a vertex where three or more labels meet, including
   * background.
   */
  std::uint64_t FacetAngleViolationsAtJunctions = 0;
  double MinimumFacetAngleOffJunctions = NotApplicable; ///< of facets off junctions; 3D only
  double MinimumFacetAngleAtJunctions = NotApplicable;  ///< of facets at junctions; 3D only
  /** Facets at junctions with an angle below JunctionFacetAngle. */
  std::uint64_t SmallFacetAnglesAtJunctions = 0;
  /** All three angles of all interface facets, in the bins of DihedralAngles; 3D only. */
  std::array<std::uint64_t, NumberOfAngleBins> PlanarAngles{};

  std::uint64_t InvertedSimplices = 0; ///< not positively oriented, flat ones included; exact

  std::vector<LabelMeasure> Labels; ///< sorted by label
};

/**
 * Measures a mesh.
 *
 * Ratios and angles are computed in double (radii of nearly flat elements exactly, see
 * SimplexQuality.h) and compared with the bounds without a tolerance. Standard deviations are
 * population standard deviations: the sum of squares is divided by the number of elements. They are
 * merged from parts by the formulas of Chan, Golub and LeVeque (1979), which avoid cancellation.
 * The result does not depend on the number of threads.
 *
 * @param radiusEdgeBound elements with a radius-edge ratio of this or more are counted
 * @param facetAngleBound interface facets with a planar angle below this many degrees are counted
 * (3D)
 * @param threads how many threads to use, 0 for all cores
 * Complexity: O(n log labels) for n elements and facets.
 * @throws std::bad_alloc
 */
template <int D>
MeshQuality MeasureQuality(
  const SimplexMesh<D>& mesh, double radiusEdgeBound, double facetAngleBound, unsigned threads);

} // namespace voxplex

#endif
