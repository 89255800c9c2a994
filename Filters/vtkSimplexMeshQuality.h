// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSimplexMeshQuality
 * @brief   shapes, junctions and volumes of a labelled mesh, its distance to an image
 *
 * Measures meshes of vtkImageToTetMeshFilter and vtkImageToPentatopeMeshFilter, and labelled meshes
 * of any other origin. It reads only the points, the cells and one cell array; of pentatopes also
 * the point array `Time`. What follows is about tetrahedra; "Pentatopes" says what is different.
 *
 * @par Input
 * Port 0: vtkUnstructuredGrid of `VTK_TETRA` cells with a cell array of labels, `Label` by default
 * (SetInputArrayToProcess(0, ...)), one component, whole numbers above 0. Port 1, optional:
 * vtkImageData, the label image that the mesh represents; by default its active scalars
 * (SetInputArrayToProcess(1, ...)), 0 is background. Image and mesh must have the same coordinates.
 *
 * @par Output 0
 * vtkUnstructuredGrid, the input with four more cell arrays (float64):
 * - `MinimumDihedralAngle`, `MaximumDihedralAngle`: of the six angles, in degrees;
 * - `RadiusEdgeRatio`: circumradius over shortest edge, 0.612 for the regular tetrahedron, infinite
 *   if flat;
 * - `Volume`: positive in VTK's order of vertices.
 *
 * @par Output 1
 * vtkTable, a row for each label of the mesh or the image: `Label`, `Elements`, `Volume`,
 * `BoundaryEdges`, `NonManifoldEdges`, `NonManifoldEdgesAtJunctions`. If there is an image, also
 * `Voxels`, `ImageVolume` and `VolumeError`, which is (Volume - ImageVolume) / ImageVolume.
 *
 * @par Output 2
 * vtkTable with the histograms, 90 rows:
 * - `Angle`, the lower end of a bin of 2 degrees, and the numbers of angles in it: `DihedralAngles`
 *   (six of each tetrahedron) and `PlanarAngles` (three of each interface facet);
 * - `Ratio`, the lower end of a bin of 0.05, and `RadiusEdgeRatios`, the number of tetrahedra in
 *   it.
 *
 * The last bin also counts all values above it.
 *
 * @par Interfaces and junctions
 * A face is an interface facet if only one tetrahedron has it, or if it lies between two tetrahedra
 * of different labels. An edge or point of interface facets is at a junction if the facets around
 * it have three labels or more, including background. An edge of a label's boundary is manifold if
 * exactly two facets of this boundary share it, and non-manifold otherwise.
 *
 * @par Distances
 * The Hausdorff distance is measured in both directions, with maximum, mean, 99th percentile and
 * the position of the maximum. A voxel face counts if it lies between voxels of different labels;
 * beyond the image's border all is background.
 * - From the image to the mesh: the exact distance of the centre of each such face to the nearest
 *   interface facet.
 * - From the mesh to the image: the distance of each vertex and centroid of the interface facets to
 *   the nearest such centre.
 *
 * This distance includes the staircase shape of voxels: about half a voxel's diagonal remains even
 * for a perfect mesh. Unless SmoothDistances is off, a second distance is measured to the smooth
 * interface that vtkImageToTetMeshFilter meshes with the same SmoothingSigma.
 * - From the image to the mesh: from one point on the smooth interface for each such face.
 * - From the mesh to the image: from each vertex and centroid to the closest point that the mesher
 *   finds. It is on average a few hundredths of a voxel farther away than the nearest point.
 *
 * @par Pentatopes
 * If the cells are pentatopes (`VTK_POLY_VERTEX` of five points, with the point array `Time`), lengths
 * and volumes are those of the space in which a unit of time has the length TimeScale. Port 1 is the
 * series that the mesh was made from: a temporal pipeline, each time step of which the filter
 * requests once, or an image with a component for each frame. AddFrameTime() gives the times of
 * components, and replaces those of a pipeline. The mesh is cut at the time of each frame. The cut is
 * split into tetrahedra and measured beside the frame. Without an image, cuts are measured at the
 * times of AddFrameTime().
 * - Output 0 has the cell arrays `NormalizedVolume` (volume over that of the regular pentatope with
 *   the same circumradius, 1 is best), `RadiusEdgeRatio`, `Volume` (hypervolume), and `WorstElement`
 *   (vtkIdTypeArray): 1 for the pentatope with the smallest normalized volume, 2 for the next, to
 *   NumberOfWorstElements; 0 for the others. vtkThreshold extracts them.
 * - Output 1: `Label`, `Elements`, `Volume` and `Components`, the sets of pentatopes that are
 *   connected through facets. With an image also `ImageVolume`, by the trapezoidal rule over its
 *   frames, and `VolumeError`.
 * - Output 2: `Ratio`, the lower end of a bin of 0.05, `RadiusEdgeRatios` and `NormalizedVolumes`.
 * - Output 3: vtkTable, a row for each frame and each label in it: `Time`, `Label`, `Elements` and
 *   `Volume` of the cut, `ImageVolume`, `VolumeError`, and of the whole frame `HausdorffDistance`,
 *   `Components` and `LostComponents`. Without an image, or where the frame is empty, figures of the
 *   image are NaN and 0. For tetrahedra it is empty.
 *
 * Distances to the smooth interface are not measured: that of one frame alone is another one.
 * GetHausdorffDistance() is the largest of all frames. Lost components are those of space-time; each
 * frame has its own in ToJSON(). Angles are NaN.
 *
 * @par VTK's own filters
 * This filter does not use vtkMeshQuality (Verdict). That filter has the volume, and the two
 * filters agree on it (a test compares them). It has neither the largest dihedral angle nor the
 * radius-edge ratio. Its smallest dihedral angle is, in VTK 9.1, the smallest of only four of the
 * six angles, so it misses slivers. Nor does this filter use vtkHausdorffDistancePointSetFilter.
 * That filter measures from points to cells as this one does (a test compares them), but uses only
 * one thread.
 *
 * @par Errors
 * Misuse is reported with vtkErrorMacro and leaves the outputs empty; GetErrorMessage() keeps the
 * reason.
 *
 * @par Progress and abort
 * If AbortExecute is set, the filter stops within a fraction of a second and leaves the outputs
 * empty.
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
  ///@{
  /** Construction, type information and printing, as in all VTK classes. */
  static vtkSimplexMeshQuality* New();
  vtkTypeMacro(vtkSimplexMeshQuality, vtkUnstructuredGridAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;
  ///@}

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

  /** The table of frames, output port 3. */
  vtkTable* GetFrameTable();

  ///@{
  /** Of pentatopes: the length of a unit of time, positive. Default 1. */
  vtkSetMacro(TimeScale, double);
  vtkGetMacro(TimeScale, double);
  ///@}

  ///@{
  /** Of pentatopes: the times of the frames, one after the other, increasing. By default none. */
  void AddFrameTime(double time);
  void ClearFrameTimes();
  ///@}

  ///@{
  /** Of pentatopes: how many of the smallest normalized volumes are listed. Default 20. */
  vtkSetClampMacro(NumberOfWorstElements, int, 0, VTK_INT_MAX);
  vtkGetMacro(NumberOfWorstElements, int);
  ///@}

  ///@{
  /**
   * The labels of the image that count. All others are treated as background, as labels that were
   * not meshed. By default all labels count.
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
   * The filter searches the mesh for connected components of the image with at least this number of
   * voxels, and for the largest component of each label. A component is found if an element of its
   * label has its centroid within a voxel of the component. Default 8.
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
  /** Whether to measure distances to the smooth interface, too. Default on. */
  vtkSetMacro(SmoothDistances, bool);
  vtkGetMacro(SmoothDistances, bool);
  vtkBooleanMacro(SmoothDistances, bool);
  ///@}

  ///@{
  /**
   * Smoothing of the interface, as vtkImageToTetMeshFilter::SetSmoothingSigma(); voxels, 0 to 5.
   * Default 1.
   */
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
   * The Hausdorff distance between the mesh and the voxel faces, the same for the smooth interface,
   * and the position of the former. Each is the larger maximum of the two directions. NaN (and the
   * origin) if it was not measured, infinite if the mesh is empty.
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
  double GetMinimumNormalizedVolume() const;
  double GetMeanNormalizedVolume() const;
  ///@}

  ///@{
  /** Non-manifold edges, and those at junctions. An edge counts once for each label that has it. */
  vtkTypeInt64 GetNonManifoldEdges() const;
  vtkTypeInt64 GetNonManifoldEdgesAtJunctions() const;
  ///@}

  ///@{
  /** Labels and connected components of the image that are not in the mesh; 0 without image. */
  vtkTypeInt64 GetNumberOfLostLabels() const;
  vtkTypeInt64 GetNumberOfLostComponents() const;
  ///@}

  /**
   * All figures as one JSON object. A figure that is not finite is null. Documentation/Reference.md
   * has the keys.
   */
  std::string ToJSON() const;

  /** The reason why the last execution failed; empty if it did not. */
  const std::string& GetErrorMessage() const { return this->ErrorMessage; }
  /** Whether the last execution was stopped. */
  bool GetAborted() const { return this->Aborted; }

  /** What stopped the last execution does not stop the next one. */
  vtkTypeBool ProcessRequest(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

protected:
  vtkSimplexMeshQuality();
  ~vtkSimplexMeshQuality() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestInformation(vtkInformation*, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
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
  double TimeScale = 1.0;
  int NumberOfWorstElements = 20;
  int NumberOfThreads = 0;

private:
  vtkSimplexMeshQuality(const vtkSimplexMeshQuality&) = delete;
  void operator=(const vtkSimplexMeshQuality&) = delete;

  struct Internals;
  class Execution;
  void CheckParameters() const;
  /** False if stopped. */
  bool Measure(vtkInformationVector** inputVector, vtkInformationVector* outputVector);
  bool StopRequested();

  std::unique_ptr<Internals> Private;
  std::string ErrorMessage;
  bool Aborted = false;
};

#endif
