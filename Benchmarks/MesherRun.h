// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MesherRun.h
 * @brief One run of one mesher on one image: the timed parts, and the result.
 */
#ifndef voxplex_MesherRun_h
#define voxplex_MesherRun_h

#include "LabelVolume.h"
#include "Mesh/SimplexMesh.h"

#include <cstdint>

namespace voxplex::benchmarks
{

/** A mesh, the time it took in seconds, and the peak memory at the end. */
struct MesherRun
{
  SimplexMesh<3> Mesh;
  double RefinementSeconds = 0.0;
  double TotalSeconds = 0.0; ///< everything except reading and writing files
  double CpuSeconds = 0.0;   ///< processor time of the total
  std::uint64_t PeakBytes = 0;
};

/** The result of CGAL's optimisation, and its time. */
struct Optimisation
{
  SimplexMesh<3> Mesh;
  double PerturbSeconds = 0.0;
  double ExudeSeconds = 0.0;
};

/** Steps of Voxplex that CGAL's refinement does not have. */
enum class Care
{
  Default,
  Plain ///< no sliver removal, no junctions, no checks of components or interfaces
};

/**
 * Voxplex with default options, except for `care`. The total includes the extraction of the mesh
 * into arrays.
 * @param image consumed: it is released as soon as the kernel has read it
 */
MesherRun RunVoxplex(LabelVolume&& image, double delta, unsigned threads, Care care);

/**
 * CGAL Mesh_3 on the labelled image domain, with its default values: facet angle 30 degrees,
 * radius-edge ratio 2. No perturbation, exudation or global optimisation. GPL: never to be
 * installed.
 *
 * Refinement is the whole of make_mesh_3. The total also includes the construction of the domain.
 * Copying CGAL's mesh into arrays is not timed.
 * @param size bound of the surface Delaunay balls. Tetrahedra are bounded by shape only, so they
 *   grow away from the interfaces, as in Voxplex.
 * @param parallel use Parallel_tag even for one thread. Otherwise one thread uses Sequential_tag,
 *   which refines the worst element first and is about half as fast.
 */
MesherRun RunCgal(const LabelVolume& image, double size, unsigned threads, bool parallel);

/**
 * As above, with one thread and Sequential_tag. Then perturbation and exudation run with the
 * defaults of make_mesh_3: without a time limit or a bound of angles.
 */
MesherRun RunCgalAndOptimise(const LabelVolume& image, double size, Optimisation& optimisation);

} // namespace voxplex::benchmarks

#endif
