// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkMeshingStatistics
 * @brief   what a meshing filter did: counts, quality, rules, predicates, times
 *
 * A meshing filter owns one of these (vtkImageToSimplexMeshFilter::GetStatistics()) and fills it
 * each time it executes. After an error or an abort, counts and times are zero. The figures come in
 * groups:
 *
 * - **Counts**, **times** and **threads** are always filled.
 * - **Labels** and **quality** need a pass over the finished mesh. They are filled only if the
 *   filter's ComputeQuality is on (see GetHasQuality()). Otherwise counts are zero, and angles and
 *   ratios are NaN.
 *
 * Lengths and volumes are in the unit of the image's spacing, angles in degrees, times in seconds
 * of wall clock. In 4D, volumes are volumes of space-time, in units of length to the fourth power:
 * a unit of time counts as vtkImageToPentatopeMeshFilter::GetTimeScale() units of length. ToJSON()
 * returns all figures as one JSON object, which Python reads with json.loads().
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
  ///@{
  /** Construction, type information and printing, as in all VTK classes. */
  static vtkMeshingStatistics* New();
  vtkTypeMacro(vtkMeshingStatistics, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;
  ///@}

  /** 3 for a mesh of tetrahedra, 4 for one of pentatopes. */
  int GetDimension() const;

  ///@{
  /**
   * Size of the mesh. Elements are tetrahedra or pentatopes. Interface facets are the triangles or
   * tetrahedra between elements of different labels (in 4D: the boundary tetrahedra).
   */
  vtkTypeInt64 GetNumberOfElements() const;
  vtkTypeInt64 GetNumberOfVertices() const;
  vtkTypeInt64 GetNumberOfInterfaceFacets() const;
  ///@}

  /** The delta that was used: the requested one, or the one derived from the spacing. */
  double GetDelta() const;
  /**
   * The largest sampling distance of any interface. This is delta, unless sampling distances are
   * graded (vtkImageToTetMeshFilter::SetGrading()) or interfaces have their own
   * (vtkImageToSimplexMeshFilter::SetInterfaceSize()).
   */
  double GetLargestDelta() const;
  ///@{
  /**
   * The interface points from which local feature sizes were measured, and the points of the medial
   * axis derived from them. Both are 0 unless sampling distances are graded.
   */
  vtkTypeInt64 GetGradingSamples() const;
  vtkTypeInt64 GetGradingPoles() const;
  ///@}
  ///@{
  /**
   * If a number of elements was requested (vtkImageToSimplexMeshFilter::SetNumberOfElements()):
   * that number, the number of refinement runs to find delta, and the delta and the number of
   * elements of each run, in order. Times are the sums over all runs. All other figures are those
   * of the run whose mesh was taken. If no number was requested, or the index is out of range, the
   * result is 0.
   */
  vtkTypeInt64 GetElementsAskedFor() const;
  int GetNumberOfRuns() const;
  double GetRunDelta(int index) const;
  vtkTypeInt64 GetRunElements(int index) const;
  ///@}

  /** The requested number of threads, or the number that VTK's SMP setting gave. */
  int GetNumberOfThreads() const;
  /** The number of elements estimated before meshing. */
  vtkTypeInt64 GetEstimatedNumberOfElements() const;

  ///@{
  /**
   * Whether the inside of an isosurface was meshed (vtkImageToTetMeshFilter::SetInputMode()). If
   * so, the isovalue, and the smallest and the largest value of the image after smoothing.
   */
  bool GetMeshedIsosurface() const;
  double GetIsovalue() const;
  void GetScalarRange(double range[2]) const;
  ///@}

  ///@{
  /**
   * Labels of the image that the mesh lacks, in increasing order. There should be none. If there
   * are, Delta is too coarse for them, and the filter warns of them. Always filled.
   */
  int GetNumberOfLostLabels() const;
  vtkTypeInt64 GetLostLabel(int index) const;
  ///@}

  ///@{
  /**
   * Connected components (through voxel faces) of all labels; 0 if components were not searched for
   * (vtkImageToTetMeshFilter::SetSmallestComponent()). A lost component has no element, although
   * the filter tried to keep it. A dropped component was left out on request
   * (vtkImageToTetMeshFilter::SetMinimumComponentVolume()). For each: the label, the number of
   * voxels, and the index of one voxel in the image, from 0 to the dimensions less 1, in an array
   * of three. If the index is out of range, the result is 0.
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
   * from 0 to GetNumberOfLabels() - 1. If the index is out of range, the result is 0.
   */
  int GetNumberOfLabels() const;
  vtkTypeInt64 GetLabel(int index) const;
  vtkTypeInt64 GetLabelElements(int index) const;
  double GetLabelVolume(int index) const;
  ///@}

  ///@{
  /**
   * Quality of the whole mesh.
   * - The radius-edge ratio is circumradius / shortest edge of an element.
   * - The planar angle is the smallest angle of an interface facet.
   * - The normalized volume is the volume of an element divided by the volume of the regular
   *   element with the same circumradius (1 is best, 0 is flat).
   * - Deviations are standard deviations over all elements.
   * - Dihedral and planar angles apply to 3D; in 4D they are NaN.
   * - Inverted elements have no positive volume. There are none unless something is wrong.
   * - Violations are elements whose ratio is not below the filter's RadiusEdgeRatio, and interface
   *   facets with an angle below its FacetAngle. Such facets that touch a junction of three or more
   *   labels are also counted separately.
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
   * Histogram of normalized volumes. Bin i, from 0 to GetNumberOfNormalizedVolumeBins() - 1 = 19,
   * counts the elements from i / 20 to below (i + 1) / 20. The last bin also counts the elements
   * with 1. If i is out of range, the result is 0.
   */
  int GetNumberOfNormalizedVolumeBins() const;
  vtkTypeInt64 GetNormalizedVolumeBin(int bin) const;
  ///@}

  ///@{
  /**
   * Cavity sizes: the mean (NaN without insertions) and the largest number of simplices that an
   * insertion deleted.
   */
  double GetMeanCavitySize() const;
  vtkTypeInt64 GetLargestCavity() const;
  ///@}

  ///@{
  /**
   * Sliver removal (vtkImageToTetMeshFilter::SetSliverAngle(),
   * vtkImageToPentatopeMeshFilter::SetPickingRegions()): slivers found, points tried in picking
   * regions, and slivers kept because no tried point was good.
   */
  vtkTypeInt64 GetSliversFound() const;
  vtkTypeInt64 GetPicksTried() const;
  vtkTypeInt64 GetSliversKept() const;
  ///@}

  ///@{
  /**
   * How often each rule changed the mesh, and why changes were refused. GetRuleFired(i) counts the
   * insertions by rule R_i, i = 1 ... 5. GetVerticesRemoved() counts the vertices removed by R6. In
   * 3D, R5 makes the insertions because of element sizes. In 4D, GetFiredBySize() counts them
   * separately. In 3D, R7 inserts free points (GetSliversSplit()) or interface points
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
   * Junctions and interfaces (vtkImageToTetMeshFilter::SetSampleJunctions() and
   * SetInterfaceRounds()).
   * - Curves where three labels meet, corners where four labels meet, and points inserted on them.
   * - How many times refinement was resumed to correct interfaces.
   * - Non-manifold edges of a label's boundary: those repaired, those of the repaired around which
   *   tetrahedra were cut in pieces (opened), and those left.
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
   * Optimisation after refinement (vtkImageToTetMeshFilter::SetOptimise()): whether it ran; the
   * smallest and largest dihedral angle before and after it, in degrees; and the number of poor
   * elements before and after it. A tetrahedron is poor if one of its angles is outside of 15 to
   * 155 degrees, or if its radius-edge ratio is too large.
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
   * Geometric predicates: all calls, calls that the fast filter could not decide, calls decided by
   * exact arithmetic, and exact ties decided by the symbolic perturbation.
   */
  vtkTypeInt64 GetPredicateCalls() const;
  vtkTypeInt64 GetPredicateFilterFailures() const;
  vtkTypeInt64 GetPredicateExactCalls() const;
  vtkTypeInt64 GetPredicatePerturbedCalls() const;
  ///@}

  ///@{
  /**
   * Wall-clock seconds of each stage: reading and smoothing the labels, the distance transform,
   * local feature sizes, connected components, junctions and interfaces, refinement, extraction of
   * the mesh into VTK data, optimisation. The total is the sum of the eight. It does not include
   * measuring the quality.
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
   * Seconds from the start of refinement until all threads have work; part of GetRefinementTime().
   */
  double GetSeedingTime() const;

  /**
   * Regions in which refinement took many times the expected work, and stopped improving shapes.
   * The filter warns of them. ToJSON() has their positions.
   */
  int GetNumberOfYieldingRegions() const;

  /**
   * Whether the filter's ContentionManager (aggressive or random) made no progress and was replaced
   * by the local one. If so, the filter warns of it.
   */
  bool GetSwitchedToLocal() const;

  ///@{
  /**
   * Operations of each refinement thread. There are GetNumberOfThreads() threads, or fewer if the
   * system gave no more. The index runs from 0 to GetNumberOfRefinementThreads() - 1. If it is out
   * of range, the result is 0. Insertions and removals are operations that succeeded. A rollback is
   * an operation that was given up because another thread held a vertex. A wait is a rollback after
   * which the contention manager made the thread wait.
   */
  int GetNumberOfRefinementThreads() const;
  vtkTypeInt64 GetThreadInsertions(int thread) const;
  vtkTypeInt64 GetThreadRemovals(int thread) const;
  vtkTypeInt64 GetThreadRollbacks(int thread) const;
  vtkTypeInt64 GetThreadWaits(int thread) const;
  ///@}

  ///@{
  /**
   * The three overheads of a refinement thread, in seconds (thesis, section 3.3.5). Contention is
   * the time in the contention manager. Load balance is the time without work. Rollback is the time
   * spent on operations that were given up.
   */
  double GetThreadContentionTime(int thread) const;
  double GetThreadLoadBalanceTime(int thread) const;
  double GetThreadRollbackTime(int thread) const;
  ///@}

  ///@{
  /**
   * How many times an idle refinement thread received work from another thread, and the elements
   * received. The level says where the other thread runs: 0 in the same socket, 1 in the same NUMA
   * node, 2 elsewhere in the machine.
   */
  vtkTypeInt64 GetThreadReceived(int thread, int level) const;
  vtkTypeInt64 GetThreadReceivedElements(int thread) const;
  ///@}

  ///@{
  /**
   * Sums over all refinement threads. A sum of times can be up to GetNumberOfRefinementThreads()
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
   * All figures as one JSON object: `{"dimension", "elements", "vertices", "interface_facets",
   * "delta", "largest_delta", "grading": {"samples", "poles"}, "threads", "contention", "balance",
   * "switched_to_local", "seeding_seconds", "sizes_raised_to", "isosurface": {"value", "inside",
   * "range": [least, largest]} (null for labels), "lost_labels": [...], "labels": {"3":
   * {"elements", "volume"}, ...}, "quality": {...}, "rules": {...}, "cavities": {"mean",
   * "largest"}, "slivers": {"found", "picks", "kept"}, "predicates": {...}, "time": {...},
   * "thread_statistics": [{"insertions", "removals", "rollbacks", "waits", "contention_seconds",
   * "load_balance_seconds", "rollback_seconds", "received": [socket, NUMA node, machine],
   * "received_elements", "helped_loops", "helped_iterations"}, ...]}`. If the processor's counters
   * can be read (a build with PAPI), the objects of "thread_statistics" also have "tlb_misses",
   * "last_level_cache_misses" and "resource_stall_cycles". "contention" and "balance" name the
   * requested policies. "labels" and "quality" are left out if they were not measured. A figure
   * that is not finite is null.
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
