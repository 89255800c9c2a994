// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkImageToPentatopeMeshFilter
 * @brief   series of label images to conforming, quality space-time mesh of pentatopes
 *
 * Every tissue of a segmented time series (3D + time) becomes a set of pentatopes, the simplices of
 * four dimensions: a mesh of the volume that the moving tissue sweeps through in space-time. Its cut
 * at any time (vtkPentatopeMeshTimeSlice) is a 3D mesh, and tissues may appear, vanish, merge and
 * part. The mesh is a Delaunay refinement made directly from the images (P. Foteinos, "Real-time
 * high-quality image-to-mesh conversion for finite element simulations", 2013, chapter 4).
 *
 * @par Inputs
 * - Port 0, vtkImageData: one label per voxel and frame, 0 is background. The frames, at least two,
 *   come in one of two ways:
 *   - A temporal pipeline, which announces two or more `TIME_STEPS`: each time step is a frame. The
 *     filter asks upstream for every one, once, in order. All must have the same dimensions, spacing,
 *     origin, direction and array name; the array has one component. Times must increase and be
 *     equally spaced (to a thousandth of a step).
 *   - One image (no, or one, time step) whose array has several components: each component is a
 *     frame, component k at the time TimeOrigin + k TimeSpacing.
 *
 *   The array is the one chosen by `SetInputArrayToProcess(0, 0, 0, association, name)`; by default
 *   the active point scalars, else the active cell scalars. Point scalars lie at the points, cell
 *   scalars at the cell centres. Any scalar type, whole values, none of them negative. Frames are
 *   copied, into as few bits a voxel as their labels need.
 *   Origin, spacing, direction matrix (skewed and left-handed ones included) and extent are honoured.
 * - Port 1, vtkImageData, optional: an image (3D) of element sizes, which applies at all times. The
 *   array is chosen by `SetInputArrayToProcess(1, 1, 0, ...)`.
 *
 * @par Outputs
 * - Port 0, vtkUnstructuredGrid: the pentatopes. VTK has no cell type for them; each is a
 *   `VTK_POLY_VERTEX` of 5 points. Points are (x, y, z) in physical space, double precision, each
 *   used by a cell, in an order that keeps neighbours near each other. The 5 points p_0 ... p_4 of a
 *   cell, at times t_0 ... t_4, are in positive order, whatever the handedness of the image's axes:
 *   the determinant whose rows are (p_i - p_0, t_i - t_0), i = 1 ... 4, columns x, y, z, t, is
 *   positive.
 *   - Point array `Time` (1 component, vtkDoubleArray): the fourth coordinate, in the unit of the
 *     input's times.
 *   - Cell array `Label` (1 component, active scalars): the image's own label value. The type is
 *     `vtkIntArray`, or `vtkLongLongArray` if a label does not fit into an int.
 * - Port 1, vtkUnstructuredGrid: the boundary, `VTK_TETRA` cells: the facets of pentatopes that lie
 *   between two labels, or between a label and the background, each once. The points are those of
 *   port 0 that they use.
 *   - Point array `Time`, as above.
 *   - Point array `PointIds` (1 component, vtkIdTypeArray): the index of the point in port 0.
 *   - Cell array `Labels` (2 components, type as that of `Label`): the labels on both sides, the
 *     larger first, 0 for background. The 4 points are in such an order that, put behind the fifth
 *     point of the first label's pentatope, they make a positive pentatope.
 *
 * Where an object is cut by the first or the last frame, the mesh ends at that frame's time, to the
 * bit, and its boundary there is flat.
 *
 * The field data of port 0 (of the last frame) is passed to both outputs, apart from the array
 * `TimeValue`, which says the time of one frame.
 *
 * @par Time in the pipeline
 * Both outputs announce the times of the first and the last frame as `TIME_RANGE`, and as
 * vtkPentatopeMeshTimeSlice::MESH_TIME_RANGE(), but no `TIME_STEPS`: they hold all times at once, and a
 * request for a certain time does not execute the filter again. (For an image with components the
 * range is announced if their number is known before execution.)
 *
 * @par Lengths and times
 * Refinement works in one space with four equal axes. TimeScale says what length a unit of time is
 * worth there; circumradii, radius-edge ratios, Delta, element sizes and the figures of
 * GetStatistics() are all measured in that space. Times of the outputs are in the input's own unit.
 *
 * @par Parameters
 * Those of vtkImageToSimplexMeshFilter, where element sizes, errors, progress, abort, threads and
 * pieces are explained, and those below. The thesis proves that refinement ends for a RadiusEdgeRatio
 * of at least 16; in practice it ends with the default of 2 (its experiments had 2.2 at most).
 *
 * @par Errors
 * In addition to those of vtkImageToSimplexMeshFilter: one frame only (use vtkImageToTetMeshFilter),
 * frames that differ in dimensions, spacing, origin, direction or array, times that do not increase,
 * that are not finite or not equally spaced. Messages name frames by their number, from 0, and time.
 * If the input fails while frames are gathered, both outputs stay empty.
 *
 * @sa vtkPentatopeMeshTimeSlice vtkImageToSimplexMeshFilter vtkImageToTetMeshFilter
 * vtkMeshingStatistics
 */
#ifndef vtkImageToPentatopeMeshFilter_h
#define vtkImageToPentatopeMeshFilter_h

#include "vtkImageToSimplexMeshFilter.h"
#include "vtkVoxplexModule.h" // For export macro

#include <memory> // For std::unique_ptr

class vtkAlgorithmOutput;
class vtkUnstructuredGrid;

class VTKVOXPLEX_EXPORT vtkImageToPentatopeMeshFilter : public vtkImageToSimplexMeshFilter
{
public:
  static vtkImageToPentatopeMeshFilter* New();
  vtkTypeMacro(vtkImageToPentatopeMeshFilter, vtkImageToSimplexMeshFilter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Length per unit of time, positive: how much time weighs against space. Default 1: a unit of time
   * counts as much as a unit of length. Larger makes elements shorter in time.
   */
  vtkSetMacro(TimeScale, double);
  vtkGetMacro(TimeScale, double);
  ///@}

  ///@{
  /** Time of the first component where components are the frames. Default 0. */
  vtkSetMacro(TimeOrigin, double);
  vtkGetMacro(TimeOrigin, double);
  ///@}

  ///@{
  /** Time from one component to the next where components are the frames, positive. Default 1. */
  vtkSetMacro(TimeSpacing, double);
  vtkGetMacro(TimeSpacing, double);
  ///@}

  /** Values of RuleOrder. */
  enum RuleOrders
  {
    RADIUS_EDGE_FIRST = 0,
    SURFACE_FIRST = 1
  };

  ///@{
  /**
   * Which poor elements are refined first. Default radius-edge first.
   * - Radius-edge first: elements with a large radius-edge ratio before all others (thesis, section
   *   4.6.1), which keeps the number of elements that an insertion changes small.
   * - Surface first: those that sample the interfaces before those of bad quality (thesis, section
   *   4.2). For comparisons.
   *
   * The values are those of RuleOrders, others are clamped to them.
   */
  vtkSetClampMacro(RuleOrder, int, RADIUS_EDGE_FIRST, SURFACE_FIRST);
  vtkGetMacro(RuleOrder, int);
  void SetRuleOrderToRadiusEdgeFirst() { this->SetRuleOrder(RADIUS_EDGE_FIRST); }
  void SetRuleOrderToSurfaceFirst() { this->SetRuleOrder(SURFACE_FIRST); }
  /** "radius-edge-first" or "surface-first". */
  const char* GetRuleOrderAsString() const;
  ///@}

  ///@{
  /**
   * Whether to fight slivers, elements that are nearly flat although their radius-edge ratio is good:
   * a point to be inserted is picked at random in a region around its place until it makes no small
   * sliver (thesis, section 4.1). Default on. Without it meshing is much faster and slivers stay.
   */
  vtkSetMacro(PickingRegions, bool);
  vtkGetMacro(PickingRegions, bool);
  vtkBooleanMacro(PickingRegions, bool);
  ///@}

  ///@{
  /**
   * Radius of a picking region over that of the ball around the element that it belongs to (zeta of
   * the thesis), above 0 and below 1. Default 0.5.
   */
  vtkSetMacro(PickingRadius, double);
  vtkGetMacro(PickingRadius, double);
  ///@}

  ///@{
  /** How many points are tried in a picking region, at least 1. Default 10. */
  vtkSetMacro(NumberOfPicks, int);
  vtkGetMacro(NumberOfPicks, int);
  ///@}

  ///@{
  /**
   * An element with a normalized volume below this is a sliver: its volume over that of the regular
   * pentatope with the same circumradius. From 0 to 0.03, default 0.01; above, where meshes can become
   * very large, it is refused unless Force is on.
   */
  vtkSetMacro(SliverBound, double);
  vtkGetMacro(SliverBound, double);
  ///@}

  ///@{
  /**
   * A sliver is small, and a picked point must not make it, if its circumradius is below that of the
   * ball of the picking region times this (b of the thesis' theorem 4.1). At least 1, default 4.
   */
  vtkSetMacro(SliverRadiusFactor, double);
  vtkGetMacro(SliverRadiusFactor, double);
  ///@}

  ///@{
  /** Seed of the random picks. With one thread the same seed gives the same mesh. Default 0. */
  vtkSetMacro(RandomSeed, int);
  vtkGetMacro(RandomSeed, int);
  ///@}

  ///@{
  /**
   * Whether threads that wait help others with the elements that an insertion deletes and makes (thesis,
   * section 4.6.2). Default on. It has no effect with more threads than the machine has processors.
   */
  vtkSetMacro(FineGrained, bool);
  vtkGetMacro(FineGrained, bool);
  vtkBooleanMacro(FineGrained, bool);
  ///@}

  ///@{
  /** The boundary tetrahedra (output port 1). */
  vtkUnstructuredGrid* GetBoundary();
  vtkAlgorithmOutput* GetBoundaryPort() { return this->GetOutputPort(1); }
  ///@}

protected:
  vtkImageToPentatopeMeshFilter();
  ~vtkImageToPentatopeMeshFilter() override;

  vtkExecutive* CreateDefaultExecutive() override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestInformation(vtkInformation*, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

#ifndef __VTK_WRAP__
  double FindDefaultDelta(vtkInformationVector** inputVector) override;
  void CheckParameters() const override;
  bool Gather(vtkInformation* request, vtkInformationVector** inputVector) override;
  void Mesh(vtkInformationVector** inputVector, vtkInformationVector* outputVector) override;
#endif

  double TimeScale = 1.0;
  double TimeOrigin = 0.0;
  double TimeSpacing = 1.0;
  int RuleOrder = RADIUS_EDGE_FIRST;
  bool PickingRegions = true;
  double PickingRadius = 0.5;
  int NumberOfPicks = 10;
  double SliverBound = 0.01;
  double SliverRadiusFactor = 4.0;
  int RandomSeed = 0;
  bool FineGrained = true;

private:
  vtkImageToPentatopeMeshFilter(const vtkImageToPentatopeMeshFilter&) = delete;
  void operator=(const vtkImageToPentatopeMeshFilter&) = delete;

  void GatherComponents(vtkInformationVector** inputVector, bool hasTimeStep);
  /** Number of frames that an image without time steps has; 0 if unknown before execution. */
  int FindNumberOfComponents(vtkInformationVector** inputVector);

  struct Frames;
  std::unique_ptr<Frames> Gathered;
};

#endif
