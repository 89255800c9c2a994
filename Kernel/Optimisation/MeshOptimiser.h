// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshOptimiser.h
 * @brief Improves the shapes of a mesh's tetrahedra after refinement.
 */
#ifndef voxplex_MeshOptimiser_h
#define voxplex_MeshOptimiser_h

#include "Domain/Domain.h"
#include "Geometry/ShapeBounds.h"
#include "Mesh/SimplexMesh.h"
#include "Optimisation/Flips.h"
#include "Optimisation/Smoother.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <stop_token>
#include <vector>

namespace voxplex
{

/** Angles are in degrees, lengths in the mesh's unit. */
struct OptimisationOptions
{
  /** Bounds of tetrahedra: what breaks one is worked on. Dihedral angles: 0 < smallest < 60, 90 < largest < 180. */
  double SmallestDihedralAngle = 15.0;
  double LargestDihedralAngle = 155.0;
  /** What breaks the bound of a ratio is worked on; interface triangles that break theirs already do not get worse. */
  ShapeBounds Shape{ .RadiusEdgeRatio = 2.5 };
  /** Interface edges are flipped only between triangles that make at most this angle. */
  double CreaseAngle = 30.0;
  /**
   * How far vertices on interfaces may leave them as a last means, which ones on junctions cannot otherwise
   * move by. A tenth of a voxel is a good value; 0 means not at all.
   */
  double InterfaceTolerance = 0.0;

  /** Work ends after about so many seconds, with what was reached by then; 0 means no limit. */
  double Seconds = 0.0;

  /**
   * Is asked when the work is done, with what has become of the mesh: which tetrahedra of the mesh before should have
   * stayed as they were. If there are any the work is done again without changing these; at last not at all. May be empty.
   */
  std::function<std::vector<std::uint32_t>(const SimplexMesh<3>& result)> ShouldHaveStayed;
};

/** Shapes of a mesh's tetrahedra. */
struct ShapeSurvey
{
  /** Bins of histograms, each 5 degrees wide. */
  static constexpr std::size_t NumberOfBins = 36;

  double SmallestDihedralAngle = 180.0; ///< degrees; as it is here if there are no tetrahedra
  double LargestDihedralAngle = 0.0;    ///< the same
  double LargestRadiusEdgeRatio = 0.0;  ///< the same; infinite if one is flat
  std::uint64_t Poor = 0;               ///< tetrahedra that break a bound
  std::array<std::uint64_t, NumberOfBins> SmallestAngles{}; ///< tetrahedra by their smallest angle
  std::array<std::uint64_t, NumberOfBins> LargestAngles{};  ///< and by their largest
};

struct OptimisationStatistics
{
  ShapeSurvey Before;
  ShapeSurvey After;
  FlipCounts Flips;
  SmoothingCounts Smoothing;
  std::uint32_t Passes = 0; ///< over what is poor
  bool OutOfTime = false;
  double Seconds = 0.0;
};

/**
 * Brings all tetrahedra within the bounds of shape where it can: flips (Flips), smoothing (Smoother), and,
 * for what is left, changes of labels of slivers between labels, insertion of vertices inside labels, and
 * small moves of vertices on interfaces. Where that does not do, tetrahedra around are first improved beyond the bounds,
 * which makes room.
 *
 * Only poor tetrahedra are worked on, and a change is made only if the smallest score (ShapeScore) of
 * what it touches grows, so the worst shape of the mesh never gets worse. Kept are: conformity, positive
 * orientation, every label, the pieces of each label but for single tetrahedra, planar angles of interfaces,
 * and where interfaces are: vertices on them move only along them (but for InterfaceTolerance), and their triangles
 * change only where they are nearly flat. A mesh without poor tetrahedra is left as it is, bit for
 * bit; otherwise points that are used keep their order, and new ones come last.
 *
 * Most of the work is done in blocks of vertices, each by one thread, with other blocks in each round;
 * the rest by one thread. Blocks do not depend on the number of threads, so neither does the result, unless
 * the time limit ends it.
 *
 * @param mesh valid; points sorted along a space-filling curve make it fast. Unchanged if this throws.
 * @param domain what the mesh was made from
 * @param threads 0 means all cores
 * @throws InputError if an option is out of range; Cancelled if a stop was requested; std::bad_alloc
 * Complexity: linear in the mesh, and in the number of poor tetrahedra, which weigh some 100 times as much.
 */
OptimisationStatistics OptimiseMesh(SimplexMesh<3>& mesh, const Domain<3>& domain,
  const OptimisationOptions& options, unsigned threads = 1, const std::stop_token& stop = {});

/** Measures shapes against the bounds of the options. */
ShapeSurvey SurveyShapes(const SimplexMesh<3>& mesh, const OptimisationOptions& options,
  unsigned threads = 1, const std::stop_token& stop = {});

} // namespace voxplex

#endif
