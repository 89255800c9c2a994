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

namespace voxplex
{
struct MeshingStatistics;
}

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
   * If a number of elements was requested (vtkImageToSimplexMeshFilter::SetNumberOfElements()), the
   * number of refinement runs to find delta; otherwise 0. ToJSON() lists the runs. Times are the
   * sums over all runs. All other figures are those of the run whose mesh was taken.
   */
  int GetNumberOfRuns() const;
  /** The requested number of threads, or the number that VTK's SMP setting gave. */
  int GetNumberOfThreads() const;

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
   * Labels of 8 voxels or more of which the mesh has less than half of the volume, in increasing
   * order, and the fraction of the volume that it has. They are thin compared with Delta, and the
   * filter warns of them. Filled for meshes of tetrahedra.
   */
  int GetNumberOfShrunkLabels() const;
  vtkTypeInt64 GetShrunkLabel(int index) const;
  double GetShrunkLabelFraction(int index) const;
  ///@}

  ///@{
  /**
   * Connected components (through voxel faces) of all labels; 0 if components were not searched for
   * (vtkImageToTetMeshFilter::SetSmallestComponent()). A lost component has no element, although
   * the filter tried to keep it. A dropped component was left out on request
   * (vtkImageToTetMeshFilter::SetMinimumComponentVolume()). ToJSON() lists them: the label, the
   * number of voxels and the index of one voxel.
   */
  vtkTypeInt64 GetNumberOfComponents() const;
  int GetNumberOfLostComponents() const;
  int GetNumberOfDroppedComponents() const;
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
   * - Dihedral and planar angles apply to 3D; in 4D they are NaN.
   * - Inverted elements have no positive volume. There are none unless something is wrong.
   * - Violations are elements whose ratio is not below the filter's RadiusEdgeRatio, and interface
   *   facets with an angle below its FacetAngle.
   */
  double GetMaximumRadiusEdgeRatio() const;
  double GetMinimumDihedralAngle() const;
  double GetMaximumDihedralAngle() const;
  double GetMinimumPlanarAngle() const;
  vtkTypeInt64 GetInvertedElements() const;
  vtkTypeInt64 GetRadiusEdgeViolations() const;
  vtkTypeInt64 GetFacetAngleViolations() const;
  ///@}

  /** Whether optimisation ran after refinement (SetOptimise() of the filter). */
  bool GetOptimised() const;

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
   * Regions in which refinement took many times the expected work, and stopped improving shapes.
   * The filter warns of them. ToJSON() has their positions.
   */
  int GetNumberOfYieldingRegions() const;

  /**
   * Whether the filter's ContentionManager (aggressive or random) made no progress and was replaced
   * by the local one. If so, the filter warns of it.
   */
  bool GetSwitchedToLocal() const;

  /**
   * All figures as one JSON object. Documentation/Reference.md lists its keys. "labels" and
   * "quality" are left out if they were not measured. A figure that is not finite is null.
   */
  std::string ToJSON() const;

  /**
   * One figure of ToJSON(), by its JSON pointer: "/rules/R1", "/thread_statistics/0/rollbacks". A
   * boolean is 0 or 1. For a list or an object, the number of its entries. NaN if there is no such
   * figure, and if it is null or text. Takes as long as ToJSON().
   */
  double GetFigure(const char* path) const;

  /** Set every figure to zero. */
  void Initialize();

#ifndef __VTK_WRAP__
  /** For the filters: the kernel's record of a run, which is behind the getters. */
  voxplex::MeshingStatistics& Edit();
#endif

protected:
  vtkMeshingStatistics();
  ~vtkMeshingStatistics() override;

private:
  vtkMeshingStatistics(const vtkMeshingStatistics&) = delete;
  void operator=(const vtkMeshingStatistics&) = delete;

  std::unique_ptr<voxplex::MeshingStatistics> Values;
};

#endif
