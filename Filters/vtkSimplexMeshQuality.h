// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSimplexMeshQuality
 * @brief   shapes, junctions and volumes of a tetrahedral mesh with labels, and its distance to an image
 *
 * Measures meshes of vtkImageToTetMeshFilter, and any others of labelled tetrahedra, whoever made them:
 * only the points, the cells and one cell array are looked at.
 *
 * @par Input
 * Port 0: vtkUnstructuredGrid of `VTK_TETRA` cells with a cell array of labels, `Label` by default
 * (SetInputArrayToProcess(0, ...)), one component, whole numbers above 0. Port 1, optional: vtkImageData,
 * the label image that the mesh shows; 0 is background, by default its active scalars
 * (SetInputArrayToProcess(1, ...)). It must lie where the mesh lies.
 *
 * @par Output 0
 * vtkUnstructuredGrid, the input with four more cell arrays (float64):
 * - `MinimumDihedralAngle`, `MaximumDihedralAngle`: of the six angles, in degrees;
 * - `RadiusEdgeRatio`: circumradius over shortest edge, 0.612 for the regular tetrahedron, infinite if flat;
 * - `Volume`: positive in VTK's order of vertices.
 *
 * @par Output 1
 * vtkTable, a row for each label of the mesh or the image: `Label`, `Elements`, `Volume`,
 * `BoundaryEdges`, `NonManifoldEdges`, `NonManifoldEdgesAtJunctions`; with an image also `Voxels`,
 * `ImageVolume` and `VolumeError`, (Volume - ImageVolume) / ImageVolume.
 *
 * @par Output 2
 * vtkTable with the histograms, 90 rows: `Angle`, where a bin of 2 degrees begins, and how many angles
 * fall into it: `DihedralAngles` (six of each tetrahedron) and `PlanarAngles` (three of each interface
 * facet); `Ratio`, where a bin of 0.05 begins, and `RadiusEdgeRatios`, the tetrahedra in it. The last bin
 * has all that lies above it, too.
 *
 * @par Interfaces and junctions
 * A face of one tetrahedron only, or between two of different labels, is an interface facet. An edge or
 * point of such is at a junction if the facets around it have three labels or more, background counted.
 * An edge of a label's own boundary is non-manifold if not exactly two facets of that boundary share it.
 *
 * @par Distances
 * The Hausdorff distance is measured in both directions, with maximum, mean, 99th percentile and the place
 * of the maximum:
 * - from the image: of each centre of a face between voxels of different labels from the nearest interface
 *   facet, exactly; beyond the image's border all is background;
 * - from the mesh: of each vertex and centroid of interface facets from the nearest such centre.
 *
 * The stairs of voxels are part of this distance: half a voxel's diagonal or so remains, however good the
 * mesh. A second figure, unless SmoothDistances is off, takes the smooth interface that
 * vtkImageToTetMeshFilter meshes with the same SmoothingSigma: of points on it, one for each of these faces;
 * and of vertices and centroids from the closest point that the mesher finds, which is on average a few
 * hundredths of a voxel farther than the nearest.
 *
 * @par VTK's own filters
 * vtkMeshQuality (Verdict) has the volume, with which this filter agrees (a test compares them). It has
 * neither the largest dihedral angle nor the radius-edge ratio; and the smallest dihedral angle that it
 * finds is, in VTK 9.1, the smallest of four of the six, so that it misses slivers. It is therefore not used.
 * vtkHausdorffDistancePointSetFilter measures from points to cells as this filter does (a test compares
 * them), but takes one thread; it is not used either.
 *
 * @par Errors
 * Misuse is reported with vtkErrorMacro and leaves the outputs empty; GetErrorMessage() keeps the reason.
 *
 * @par Progress and abort
 * Setting AbortExecute stops within a fraction of a second and leaves the outputs empty.
 *
 * The result does not depend on the number of threads. Events are sent from the thread that called
 * Update(). Distinct instances may execute at the same time.
 *
 * @sa vtkImageToTetMeshFilter vtkMeshingStatistics
 */
#ifndef vtkSimplexMeshQuality_h
#define vtkSimplexMeshQuality_h

#include "vtkUnstructuredGridAlgorithm.h"
#include "vtkVoxplexModule.h" // For export macro

#include <memory> // For std::unique_ptr
#include <string> // For std::string

class vtkImageData;
class vtkTable;

class VTKVOXPLEX_EXPORT vtkSimplexMeshQuality : public vtkUnstructuredGridAlgorithm
{
public:
  static vtkSimplexMeshQuality* New();
  vtkTypeMacro(vtkSimplexMeshQuality, vtkUnstructuredGridAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /** The label image, input port 1. */
  void SetImageData(vtkImageData* image);
  void SetImageConnection(vtkAlgorithmOutput* output);
  ///@}

  ///@{
  /** The tables of labels and of histograms, output ports 1 and 2. */
  vtkTable* GetLabelTable();
  vtkTable* GetHistograms();
  ///@}

  ///@{
  /**
   * Which labels of the image count; the others are taken for background, as those that were not meshed.
   * By default all.
   */
  void AddLabel(vtkTypeInt64 label);
  void RemoveAllLabels();
  ///@}

  ///@{
  /** Elements with this radius-edge ratio or more are counted as violations. Default 2. */
  vtkSetMacro(RadiusEdgeRatio, double);
  vtkGetMacro(RadiusEdgeRatio, double);
  ///@}

  ///@{
  /** Interface facets with an angle below this are counted as violations, degrees. Default 30. */
  vtkSetMacro(FacetAngle, double);
  vtkGetMacro(FacetAngle, double);
  ///@}

  ///@{
  /**
   * Connected components of the image with at least so many voxels, and the largest of each label, are looked for in
   * the mesh: an element of their label must have its centroid within a voxel of them. Default 8.
   */
  vtkSetMacro(SmallestComponent, vtkIdType);
  vtkGetMacro(SmallestComponent, vtkIdType);
  ///@}

  ///@{
  /** Whether to measure distances to the image, if there is one. Default on. */
  vtkSetMacro(Distances, bool);
  vtkGetMacro(Distances, bool);
  vtkBooleanMacro(Distances, bool);
  ///@}

  ///@{
  /** Whether to measure them to the smooth interface, too. Default on. */
  vtkSetMacro(SmoothDistances, bool);
  vtkGetMacro(SmoothDistances, bool);
  vtkBooleanMacro(SmoothDistances, bool);
  ///@}

  ///@{
  /** Of that interface, as vtkImageToTetMeshFilter::SetSmoothingSigma(); voxels, 0 to 5. Default 1. */
  vtkSetMacro(SmoothingSigma, double);
  vtkGetMacro(SmoothingSigma, double);
  ///@}

  ///@{
  /** Threads to use; 0, the default, means as many as vtkSMPTools uses. */
  vtkSetMacro(NumberOfThreads, int);
  vtkGetMacro(NumberOfThreads, int);
  ///@}

  ///@{
  /**
   * The larger of both directions' maxima, from the faces of voxels and from the smooth interface; and
   * where it is. NaN (and the origin) if it was not measured, infinite if the mesh is empty.
   */
  double GetHausdorffDistance() const;
  double GetSmoothHausdorffDistance() const;
  void GetHausdorffPlace(double place[3]) const;
  ///@}

  ///@{
  /** Smallest and largest figures of the mesh; NaN if there is no element or facet. */
  double GetMinimumDihedralAngle() const;
  double GetMaximumDihedralAngle() const;
  double GetMaximumRadiusEdgeRatio() const;
  double GetMinimumPlanarAngle() const;
  ///@}

  ///@{
  /** Edges that are non-manifold, counted for each label that has them, and those of them at junctions. */
  vtkTypeInt64 GetNonManifoldEdges() const;
  vtkTypeInt64 GetNonManifoldEdgesAtJunctions() const;
  ///@}

  ///@{
  /** Labels and connected components of the image that are not in the mesh; 0 without image. */
  vtkTypeInt64 GetNumberOfLostLabels() const;
  vtkTypeInt64 GetNumberOfLostComponents() const;
  ///@}

  /**
   * All figures as one JSON object; what is not finite is null. Documentation/Reference.md has the keys.
   */
  std::string ToJSON() const;

  /** Why the last execution failed; empty if it did not. */
  const std::string& GetErrorMessage() const { return this->ErrorMessage; }
  /** Whether the last execution was stopped. */
  bool GetAborted() const { return this->Aborted; }

protected:
  vtkSimplexMeshQuality();
  ~vtkSimplexMeshQuality() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int RequestData(vtkInformation*, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

  double RadiusEdgeRatio = 2.0;
  double FacetAngle = 30.0;
  vtkIdType SmallestComponent = 8;
  bool Distances = true;
  bool SmoothDistances = true;
  double SmoothingSigma = 1.0;
  int NumberOfThreads = 0;

private:
  vtkSimplexMeshQuality(const vtkSimplexMeshQuality&) = delete;
  void operator=(const vtkSimplexMeshQuality&) = delete;

  struct Internals;
  void CheckParameters() const;
  /** False if stopped. */
  bool Measure(vtkInformationVector** inputVector, vtkInformationVector* outputVector);
  bool StopRequested();

  std::unique_ptr<Internals> Private;
  std::string ErrorMessage;
  bool Aborted = false;
};

#endif
