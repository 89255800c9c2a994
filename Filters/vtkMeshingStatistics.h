// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkMeshingStatistics
 * @brief   what a meshing filter did: counts, quality, rules, predicates, times
 *
 * A meshing filter owns one of these (vtkImageToSimplexMeshFilter::GetStatistics()) and fills it
 * each time it executes. After an error or an abort counts and times are zero. The figures come in
 * groups:
 *
 * - **Counts**, **times** and **threads** are always filled.
 * - **Labels** and **quality** need a pass over the finished mesh and are filled only if the
 *   filter's ComputeQuality is on (see GetHasQuality()); otherwise counts are zero and angles and
 *   ratios NaN.
 *
 * Lengths and volumes are in the unit of the image's spacing, angles in degrees, times in seconds
 * of wall clock. In 4D volumes are those of space-time, in units of length to the fourth: a unit of
 * time counts as vtkImageToPentatopeMeshFilter::GetTimeScale() units of length. ToJSON() gives everything as one JSON object, which Python reads with
 * json.loads().
 *
 * @sa vtkImageToTetMeshFilter vtkImageToPentatopeMeshFilter
 */
#ifndef vtkMeshingStatistics_h
#define vtkMeshingStatistics_h

#include "vtkObject.h"
#include "vtkVoxplexModule.h" // For export macro

#include <memory> // For std::unique_ptr
#include <string> // For std::string

class VTKVOXPLEX_EXPORT vtkMeshingStatistics : public vtkObject
{
public:
  static vtkMeshingStatistics* New();
  vtkTypeMacro(vtkMeshingStatistics, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /** 3 for a mesh of tetrahedra, 4 for one of pentatopes. */
  int GetDimension() const;

  ///@{
  /**
   * Size of the mesh: elements are tetrahedra or pentatopes, interface facets the triangles or
   * tetrahedra between them where labels differ (in 4D: the boundary tetrahedra).
   */
  vtkTypeInt64 GetNumberOfElements() const;
  vtkTypeInt64 GetNumberOfVertices() const;
  vtkTypeInt64 GetNumberOfInterfaceFacets() const;
  ///@}

  /** The delta that was used: the one asked for, or the one derived from the spacing. */
  double GetDelta() const;
  /**
   * The largest sampling density of any interface: delta, unless it is graded
   * (vtkImageToTetMeshFilter::SetGrading()) or interfaces have their own
   * (vtkImageToSimplexMeshFilter::SetInterfaceSize()).
   */
  double GetLargestDelta() const;
  ///@{
  /**
   * Points of the interfaces by which local feature sizes were measured, and points of the medial axis that they
   * gave; 0 unless the sampling density is graded.
   */
  vtkTypeInt64 GetGradingSamples() const;
  vtkTypeInt64 GetGradingPoles() const;
  ///@}
  ///@{
  /**
   * If a number of elements was asked for (vtkImageToSimplexMeshFilter::SetNumberOfElements()): that number, how many times
   * refinement was run to find the delta, and the delta and the elements of each run, in their order. Times are those of all
   * runs together, everything else is of the run whose mesh was taken. Otherwise 0, also for an index out of range.
   */
  vtkTypeInt64 GetElementsAskedFor() const;
  int GetNumberOfRuns() const;
  double GetRunDelta(int index) const;
  vtkTypeInt64 GetRunElements(int index) const;
  ///@}

  /** The number of threads that was asked for, or that VTK's SMP setting gave. */
  int GetNumberOfThreads() const;
  /** The number of elements that was estimated before meshing. */
  vtkTypeInt64 GetEstimatedNumberOfElements() const;

  ///@{
  /**
   * Whether the inside of an isosurface was meshed (vtkImageToTetMeshFilter::SetInputMode()); if so, its
   * value, and the smallest and the largest value of the image, as they are after smoothing.
   */
  bool GetMeshedIsosurface() const;
  double GetIsovalue() const;
  void GetScalarRange(double range[2]) const;
  ///@}

  ///@{
  /**
   * Labels that the image has but the mesh has not, in increasing order: there should be none; if
   * there are, Delta is too coarse for them. The filter warns of them. Always filled.
   */
  int GetNumberOfLostLabels() const;
  vtkTypeInt64 GetLostLabel(int index) const;
  ///@}

  ///@{
  /**
   * Connected components (through voxel faces) of all labels; 0 if none were looked for
   * (vtkImageToTetMeshFilter::SetSmallestComponent()). Lost ones have no element although they were
   * looked after; dropped ones were left out on request
   * (vtkImageToTetMeshFilter::SetMinimumComponentVolume()). Of each: the label, the number of voxels,
   * and the index of one voxel in the image, from 0 to the dimensions less 1, in an array of three. An
   * index out of range gives 0.
   */
  vtkTypeInt64 GetNumberOfComponents() const;
  int GetNumberOfLostComponents() const;
  vtkTypeInt64 GetLostComponentLabel(int index) const;
  vtkTypeInt64 GetLostComponentVoxels(int index) const;
  void GetLostComponentVoxel(int index, vtkTypeInt64 voxel[3]) const;
  int GetNumberOfDroppedComponents() const;
  vtkTypeInt64 GetDroppedComponentLabel(int index) const;
  vtkTypeInt64 GetDroppedComponentVoxels(int index) const;
  void GetDroppedComponentVoxel(int index, vtkTypeInt64 voxel[3]) const;
  ///@}

  /** Whether the labels and the quality below were measured. */
  bool GetHasQuality() const;

  ///@{
  /**
   * The labels of the mesh in increasing order: value, elements and volume of each. The index runs
   * from 0 to GetNumberOfLabels() - 1; outside of that the result is 0.
   */
  int GetNumberOfLabels() const;
  vtkTypeInt64 GetLabel(int index) const;
  vtkTypeInt64 GetLabelElements(int index) const;
  double GetLabelVolume(int index) const;
  ///@}

  ///@{
  /**
   * Quality, for the whole mesh. The radius-edge ratio is circumradius / shortest edge of an
   * element; the planar angle is the smallest angle of an interface facet; the normalized volume is
   * that of an element over that of the regular one with the same circumradius (1 is best, 0 is
   * flat). Deviations are standard deviations over all elements. Dihedral and planar angles are
   * those of 3D; in 4D they are NaN. Inverted elements are those without a positive volume: there are none unless something
   * is wrong. Violations count the elements whose ratio is not below the filter's RadiusEdgeRatio,
   * and the interface facets with an angle below its FacetAngle; of the latter, those that touch a
   * junction of three or more labels are counted separately, too.
   */
  double GetShortestEdge() const;
  double GetMaximumRadiusEdgeRatio() const;
  double GetMeanRadiusEdgeRatio() const;
  double GetRadiusEdgeRatioDeviation() const;
  double GetMinimumDihedralAngle() const;
  double GetMaximumDihedralAngle() const;
  double GetMinimumPlanarAngle() const;
  double GetMinimumNormalizedVolume() const;
  double GetMeanNormalizedVolume() const;
  double GetNormalizedVolumeDeviation() const;
  vtkTypeInt64 GetInvertedElements() const;
  vtkTypeInt64 GetRadiusEdgeViolations() const;
  vtkTypeInt64 GetFacetAngleViolations() const;
  vtkTypeInt64 GetFacetAngleViolationsAtJunctions() const;
  ///@}

  ///@{
  /**
   * Histogram of normalized volumes: bin i, from 0 to GetNumberOfNormalizedVolumeBins() - 1 = 19,
   * counts the elements from i / 20 to below (i + 1) / 20, the last one also those with 1. Outside
   * of that range of i the result is 0.
   */
  int GetNumberOfNormalizedVolumeBins() const;
  vtkTypeInt64 GetNormalizedVolumeBin(int bin) const;
  ///@}

  ///@{
  /**
   * Cavity sizes: how many simplices an insertion deleted, on average (NaN without insertions) and at
   * most.
   */
  double GetMeanCavitySize() const;
  vtkTypeInt64 GetLargestCavity() const;
  ///@}

  ///@{
  /**
   * The fight against slivers (vtkImageToTetMeshFilter::SetSliverAngle(),
   * vtkImageToPentatopeMeshFilter::SetPickingRegions()): slivers that
   * were found, points that were tried in picking regions, slivers that stayed because no point that
   * was tried was good.
   */
  vtkTypeInt64 GetSliversFound() const;
  vtkTypeInt64 GetPicksTried() const;
  vtkTypeInt64 GetSliversKept() const;
  ///@}

  ///@{
  /**
   * How often each rule changed the mesh, and why changes were refused. GetRuleFired(i) counts the
   * insertions by rule R_i, i = 1 ... 5; vertices removed by R6 are GetVerticesRemoved(). Insertions
   * because of element sizes are those of R5 in 3D; in 4D they are counted apart, by
   * GetFiredBySize(). R7 of 3D inserts free points (GetSliversSplit()) or some of an interface
   * (GetSliversSampled()).
   */
  vtkTypeInt64 GetRuleFired(int rule) const;
  vtkTypeInt64 GetFiredBySize() const;
  vtkTypeInt64 GetSliversSplit() const;
  vtkTypeInt64 GetSliversSampled() const;
  vtkTypeInt64 GetPointsProjected() const;
  vtkTypeInt64 GetVerticesRemoved() const;
  vtkTypeInt64 GetRefusedTooClose() const;
  vtkTypeInt64 GetRefusedNoConflict() const;
  vtkTypeInt64 GetRefusedDuplicate() const;
  vtkTypeInt64 GetRemovalsFailed() const;
  vtkTypeInt64 GetElementsEvaluated() const;
  vtkTypeInt64 GetElementsCreated() const;
  vtkTypeInt64 GetClosestSurfacePointCalls() const;
  ///@}

  ///@{
  /**
   * Junctions and interfaces (vtkImageToTetMeshFilter::SetSampleJunctions() and SetInterfaceRounds()): curves
   * where three labels meet, corners where four do, points that were inserted on them; times that refinement
   * went on for the sake of interfaces; edges that were not manifold on the boundary of some label and were made so, of
   * these the ones around which tetrahedra were cut in pieces, and those left.
   */
  vtkTypeInt64 GetNumberOfJunctionCurves() const;
  vtkTypeInt64 GetNumberOfJunctionCorners() const;
  vtkTypeInt64 GetNumberOfJunctionPoints() const;
  int GetInterfaceRounds() const;
  vtkTypeInt64 GetNonManifoldEdgesRepaired() const;
  vtkTypeInt64 GetNonManifoldEdgesOpened() const;
  vtkTypeInt64 GetNonManifoldEdgesLeft() const;
  ///@}

  ///@{
  /**
   * Optimisation after refinement (vtkImageToTetMeshFilter::SetOptimise()): whether it ran, the smallest and
   * largest dihedral angle before and after it in degrees, and how many tetrahedra had angles outside of
   * 15 to 155 degrees, or too large a radius-edge ratio, before and after it.
   */
  bool GetOptimised() const;
  double GetMinimumDihedralAngleBefore() const;
  double GetMaximumDihedralAngleBefore() const;
  double GetMinimumDihedralAngleAfter() const;
  double GetMaximumDihedralAngleAfter() const;
  vtkTypeInt64 GetPoorElementsBefore() const;
  vtkTypeInt64 GetPoorElementsAfter() const;
  ///@}

  ///@{
  /**
   * Geometric predicates: all calls; calls that the fast filter could not decide; calls decided by
   * exact arithmetic; exact ties decided by the symbolic perturbation.
   */
  vtkTypeInt64 GetPredicateCalls() const;
  vtkTypeInt64 GetPredicateFilterFailures() const;
  vtkTypeInt64 GetPredicateExactCalls() const;
  vtkTypeInt64 GetPredicatePerturbedCalls() const;
  ///@}

  ///@{
  /**
   * Wall-clock seconds of each stage: reading the labels and smoothing them, the distance
   * transform, local feature sizes, connected components, what is done for junctions and interfaces, refinement, extraction of the mesh
   * into VTK data, optimisation. The total is the sum of the eight;
   * measuring the quality is not part of it.
   */
  double GetLabelFieldTime() const;
  double GetDistanceTransformTime() const;
  double GetGradingTime() const;
  double GetComponentsTime() const;
  double GetInterfacesTime() const;
  double GetRefinementTime() const;
  double GetExtractionTime() const;
  double GetOptimisationTime() const;
  double GetTotalTime() const;
  ///@}

  /**
   * The start of refinement, before there is work for all threads; part of GetRefinementTime().
   */
  double GetSeedingTime() const;

  /**
   * Regions in which refinement took many times the work that it should need, and stopped improving shapes. The filter
   * warns of them; ToJSON() says where they are.
   */
  int GetNumberOfYieldingRegions() const;

  /**
   * Whether the filter's ContentionManager (aggressive or random) made no progress and was replaced
   * by the local one. The filter warns of it.
   */
  bool GetSwitchedToLocal() const;

  ///@{
  /**
   * What each refinement thread did. There are GetNumberOfThreads() of them, or fewer if the system
   * gave no more. The index runs from 0 to GetNumberOfRefinementThreads() - 1; outside of that the
   * result is 0. Insertions and removals are operations that succeeded; a rollback is one that was
   * given up because another thread held a vertex; a wait is a rollback after which the contention
   * manager made the thread wait.
   */
  int GetNumberOfRefinementThreads() const;
  vtkTypeInt64 GetThreadInsertions(int thread) const;
  vtkTypeInt64 GetThreadRemovals(int thread) const;
  vtkTypeInt64 GetThreadRollbacks(int thread) const;
  vtkTypeInt64 GetThreadWaits(int thread) const;
  ///@}

  ///@{
  /**
   * The three overheads of a refinement thread, in seconds (thesis, section 3.3.5): contention is
   * the time in the contention manager, load balance the time without work, rollback the time spent
   * on operations that were given up.
   */
  double GetThreadContentionTime(int thread) const;
  double GetThreadLoadBalanceTime(int thread) const;
  double GetThreadRollbackTime(int thread) const;
  ///@}

  ///@{
  /**
   * Gifts of work that a refinement thread received while it had none, and the elements in them.
   * The level says how far a gift came: 0 from within the socket, 1 from within the NUMA node, 2
   * from elsewhere in the machine.
   */
  vtkTypeInt64 GetThreadReceived(int thread, int level) const;
  vtkTypeInt64 GetThreadReceivedElements(int thread) const;
  ///@}

  ///@{
  /**
   * Sums over all refinement threads. Those of times are thus up to GetNumberOfRefinementThreads()
   * times as long as refinement took.
   */
  vtkTypeInt64 GetRollbacks() const;
  vtkTypeInt64 GetWaits() const;
  double GetContentionTime() const;
  double GetLoadBalanceTime() const;
  double GetRollbackTime() const;
  vtkTypeInt64 GetReceived(int level) const;
  vtkTypeInt64 GetReceivedElements() const;
  ///@}

  /**
   * Everything as one JSON object:
   * `{"dimension", "elements", "vertices", "interface_facets", "delta", "largest_delta", "grading": {"samples",
   * "poles"}, "threads", "contention", "balance", "switched_to_local", "seeding_seconds", "sizes_raised_to",
   * "isosurface": {"value", "inside", "range": [least, largest]} (null for labels), "lost_labels": [...],
   * "labels": {"3": {"elements", "volume"}, ...}, "quality": {...}, "rules": {...}, "cavities":
   * {"mean", "largest"}, "slivers": {"found", "picks", "kept"}, "predicates": {...}, "time": {...}, "thread_statistics": [{"insertions", "removals", "rollbacks", "waits",
   * "contention_seconds", "load_balance_seconds", "rollback_seconds", "received": [socket, NUMA
   * node, machine], "received_elements", "helped_loops",
   * "helped_iterations"}, ...]}`. Where the processor's counters can be read (a build
   * with PAPI) the last also has "tlb_misses", "last_level_cache_misses" and "resource_stall_cycles".
   * "contention" and "balance" name the policies that were asked for. "labels" and "quality" are left out when they were not measured; what is not
   * finite is null.
   */
  std::string ToJSON() const;

  /** Set every figure to zero. */
  void Initialize();

#ifndef __VTK_WRAP__
  struct Figures;
  /** For the filters: the figures behind the getters (Private/MeshingFigures.h, not installed). */
  Figures& Edit();
#endif

protected:
  vtkMeshingStatistics();
  ~vtkMeshingStatistics() override;

private:
  vtkMeshingStatistics(const vtkMeshingStatistics&) = delete;
  void operator=(const vtkMeshingStatistics&) = delete;

  std::unique_ptr<Figures> Values;
};

#endif
