// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MesherRun.h
 * @brief One run of one mesher on one image: what is timed, and what comes out.
 */
#ifndef voxplex_MesherRun_h
#define voxplex_MesherRun_h

#include "LabelVolume.h"
#include "Mesh/SimplexMesh.h"

#include <cstdint>

namespace voxplex::benchmarks
{

/** A mesh, the seconds it took, and the peak of memory at the end of them. */
struct MesherRun
{
  SimplexMesh<3> Mesh;
  double RefinementSeconds = 0.0;
  double TotalSeconds = 0.0; ///< everything but reading and writing files
  double CpuSeconds = 0.0;   ///< processor time of the total
  std::uint64_t PeakBytes = 0;
};

/** What CGAL's optimisation made of a mesh, and how long it took. */
struct Optimisation
{
  SimplexMesh<3> Mesh;
  double PerturbSeconds = 0.0;
  double ExudeSeconds = 0.0;
};

/** What Voxplex does besides what CGAL's refinement does, too. */
enum class Care
{
  Default,
  Plain ///< slivers and small components are left alone
};

/**
 * Voxplex with default options but for care. The total includes the extraction of the mesh into arrays.
 * @param image consumed: released as soon as the kernel has read it
 */
MesherRun RunVoxplex(LabelVolume&& image, double delta, unsigned threads, Care care);

/**
 * CGAL Mesh_3 on the labelled image domain, defaults throughout: facet angle 30 degrees,
 * radius-edge ratio 2, no perturbation, exudation or global optimisation. GPL: never to be
 * installed.
 *
 * Refinement is the whole of make_mesh_3; the total adds the construction of the domain. Copying
 * CGAL's mesh into arrays is not counted.
 * @param size bound of the surface Delaunay balls; tetrahedra are bounded by shape alone, so that
 * they grow away from the interfaces as they do in Voxplex
 * @param parallel takes Parallel_tag even for one thread; else that takes Sequential_tag, which
 * refines the worst element first and is about half as fast
 */
MesherRun RunCgal(const LabelVolume& image, double size, unsigned threads, bool parallel);

/**
 * The same with one thread and Sequential_tag, after which perturbation and exudation go over the
 * mesh as make_mesh_3 lets them by default: without a limit of time or bound of angles.
 */
MesherRun RunCgalAndOptimise(const LabelVolume& image, double size, Optimisation& optimisation);

} // namespace voxplex::benchmarks

#endif
