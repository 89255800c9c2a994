// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkImageToPentatopeMeshFilter
 * @brief   series of label images to conforming, quality space-time mesh of pentatopes
 *
 * Every tissue of a segmented time series (3D + time) becomes a set of pentatopes, the simplices of
 * four dimensions: a mesh of the volume that the moving tissue sweeps through in space-time. Its
 * cut at any time (vtkPentatopeMeshTimeSlice) is a 3D mesh. Tissues may appear, vanish, merge and
 * split. The mesh is a Delaunay refinement made directly from the images (P. Foteinos, "Real-time
 * high-quality image-to-mesh conversion for finite element simulations", 2013, chapter 4).
 *
 * @par Inputs
 * - Port 0, vtkImageData: one label per voxel and frame, 0 is background, or one grey value (see
 *   InputMode). The frames, at least two, come in one of two ways:
 *   - A temporal pipeline that announces two or more `TIME_STEPS`: each time step is a frame. The
 *     filter requests every time step once, in order. All frames must have the same dimensions,
 *     spacing, origin, direction and array name; the array has one component. Times must increase.
 *   - One image without, or with one, time step, whose array has several components: each component
 *     is a frame. Component k has the time TimeOrigin + k TimeSpacing. Three or four components of
 *     type unsigned char or unsigned short may be colours: they are frames if AddFrameTime() gives
 *     their times, or TimeOrigin or TimeSpacing are not the default ones, and an error otherwise.
 *
 *   AddFrameTime() gives the frames other times.
 *
 *   The array is the one chosen by `SetInputArrayToProcess(0, 0, 0, association, name)`; by default
 *   the active point scalars, else the active cell scalars. Point scalars lie at the points, cell
 *   scalars at the cell centres. They have any scalar type; labels are whole (to within
 *   1e-5, for larger labels 1e-5 of them and at most 0.01), none of them negative. Voxels that a
 *   frame hides (`vtkGhostType`) are background, as for vtkImageToTetMeshFilter. Frames are copied
 *   into as few bits per voxel as their labels need; grey values as float, or as double if their
 *   type needs it. Origin, spacing, direction matrix (skewed and left-handed ones included) and
 *   extent are honoured.
 * - Port 1, vtkImageData, optional: a 3D image of element sizes, which applies at all times. The
 *   array is chosen by `SetInputArrayToProcess(1, 1, 0, ...)`.
 *
 * @par Outputs
 * - Port 0, vtkUnstructuredGrid: the pentatopes. VTK has no cell type for them; each is a
 *   `VTK_POLY_VERTEX` of 5 points. Points are (x, y, z) in physical space, double precision. Each
 *   point is used by a cell, and the order of points keeps neighbours near each other. The 5 points
 *   p_0 ... p_4 of a cell, at times t_0 ... t_4, are in positive order, for left-handed and
 *   right-handed axes of the image: the determinant with the rows (p_i - p_0, t_i - t_0), i = 1 ...
 *   4, and the columns x, y, z, t is positive.
 *   - Point array `Time` (1 component, vtkDoubleArray): the fourth coordinate, in the unit of the
 *     input's times.
 *   - Point array `BoundaryVelocity` (3 components, vtkDoubleArray): the velocity at which the
 *     lateral boundary moves there, in its normal directions, in the input's units of length and
 *     time. Where several boundaries meet they all have it. 0 at other points.
 *   - Cell array `Label` (1 component, active scalars): the image's own label value. The type is
 *     `vtkIntArray`, or `vtkLongLongArray` if a label does not fit into an int.
 *   - If the mesh conforms to time planes: cell array `Slab` (vtkIntArray), the number of the slab between two planes,
 *     from 0 on in the order of time; and field data array `TimePlanes` (vtkDoubleArray), the times of the
 *     planes inside of the mesh, ascending.
 *   - If the mesh is periodic: field data array `PeriodicPairs` (vtkIdTypeArray, 2 components), pairs
 *     of points at the first and at the last time, with the same position in space to the bit.
 * - Port 1, vtkUnstructuredGrid: the boundary as `VTK_TETRA` cells. They are the facets of
 *   pentatopes between two labels, or between a label and the background, each once. The points are
 *   those of port 0 that these cells use.
 *   - Point arrays `Time` and `BoundaryVelocity`, as above.
 *   - Point array `PointIds` (1 component, vtkIdTypeArray): the index of the point in port 0.
 *   - Cell array `Labels` (2 components, type as that of `Label`): the labels on both sides, the
 *     larger first, 0 for background. The fifth point of the first label's pentatope, followed by
 *     the 4 points, makes a positive pentatope.
 *   - Cell array `Side` (vtkUnsignedCharArray): 0 for the lateral boundary, 1 for the flat end at the
 *     first frame's time, 2 for that at the last frame's.
 *   - Cell array `NormalVelocity` (vtkDoubleArray): how fast a lateral tetrahedron moves along its
 *     normal in space, out of the first label, in the input's units of length and time. 0 at flat
 *     ends, NaN where the normal has no direction in space.
 *
 * Where the first or the last frame cuts an object, the mesh ends exactly at that frame's time, and
 * its boundary there is flat.
 *
 * The field data of port 0 (of the last frame) is passed to both outputs, with names of the labels that
 * the mesh has, and without the array `TimeValue`, which is the time of one frame.
 *
 * @par Time in the pipeline
 * Both outputs announce the times of the first and the last frame as `TIME_RANGE`, and as
 * vtkPentatopeMeshTimeSlice::MESH_TIME_RANGE(), but no `TIME_STEPS`. They contain all times at
 * once, so a request for a certain time does not execute the filter again. (For an image with
 * components the range is announced if their number is known before execution.)
 *
 * @par Lengths and times
 * Refinement works in one space with four equal axes. TimeScale is the length of a unit of time in
 * that space. Circumradii, radius-edge ratios, Delta, element sizes and the figures of
 * GetStatistics() are all measured in that space. Times of the outputs are in the input's own unit.
 *
 * @par Frames that are not equally spaced
 * The mesh is made from equally spaced frames. If the times are multiples of the smallest distance of
 * two frames, or of a half to an eighth of it (to a thousandth of a step), all frames are kept, and
 * frames are interpolated between them. Otherwise frames are interpolated at steps that are at most
 * as long as the smallest distance. The first and the last frame are always kept. Interpolation is
 * that of FrameSteps. There are at most 1000 frames then, and 400 million voxels, or twice those of
 * the input.
 *
 * @par Parameters
 * Those of vtkImageToSimplexMeshFilter and those below. Its documentation also explains element
 * sizes, errors, progress, abort, threads and pieces. The thesis proves that refinement ends for a
 * RadiusEdgeRatio of at least 16. In practice it ends with the default of 2 (the experiments of the
 * thesis had 2.2 at most).
 *
 * @par Errors
 * Those of vtkImageToSimplexMeshFilter. Also: only one frame (use vtkImageToTetMeshFilter), frames
 * that differ in dimensions, spacing, origin, direction or array, times that do not increase or are
 * not finite, two frames so near in time that there would be too many equally spaced ones, another
 * number of frame times than of frames; time planes outside of the series or too near to each other; a
 * periodic series whose first and last frame differ. Messages name frames by their number, from 0, and
 * time. If the input fails while frames are gathered, both outputs stay empty.
 *
 * @sa vtkPentatopeMeshTimeSlice vtkImageToSimplexMeshFilter vtkImageToTetMeshFilter
 * vtkMeshingStatistics
 */
#ifndef vtkImageToPentatopeMeshFilter_h
#define vtkImageToPentatopeMeshFilter_h

#include "vtkImageToSimplexMeshFilter.h"
#include "vtkVoxplexModule.h" // For export macro

#include <memory> // For std::unique_ptr
#include <vector> // For std::vector

class vtkAlgorithmOutput;
class vtkUnstructuredGrid;

class VTKVOXPLEX_EXPORT vtkImageToPentatopeMeshFilter : public vtkImageToSimplexMeshFilter
{
public:
  ///@{
  /** Construction, type information and printing, as in all VTK classes. */
  static vtkImageToPentatopeMeshFilter* New();
  vtkTypeMacro(vtkImageToPentatopeMeshFilter, vtkImageToSimplexMeshFilter);
  void PrintSelf(ostream& os, vtkIndent indent) override;
  ///@}

  ///@{
  /**
   * Length per unit of time, positive: the weight of time against space. Default 1: a unit of time
   * counts as much as a unit of length. A larger value makes elements shorter in time.
   */
  vtkSetMacro(TimeScale, double);
  vtkGetMacro(TimeScale, double);
  ///@}

  ///@{
  /** If components are the frames: the time of the first component. Default 0. */
  vtkSetMacro(TimeOrigin, double);
  vtkGetMacro(TimeOrigin, double);
  ///@}

  ///@{
  /** If components are the frames: the time from one component to the next, positive. Default 1. */
  vtkSetMacro(TimeSpacing, double);
  vtkGetMacro(TimeSpacing, double);
  ///@}

  ///@{
  /**
   * The times of the frames, one after the other, increasing. They replace those of the input, for
   * time steps and components. By default there are none.
   */
  void AddFrameTime(double time);
  void ClearFrameTimes();
  int GetNumberOfFrameTimes() const { return static_cast<int>(this->FrameTimes.size()); }
  /** NaN if there is no such frame. */
  double GetFrameTime(int frame) const;
  ///@}

  ///@{
  /**
   * Steps between two frames, 0 to 8. Labels are interpolated between the frames: the shape changes
   * gradually, and volumes change linearly. Default 0: as many as the motion of the labels asks
   * for, about one for each voxel that an interface moves. 1: no frames are added. Grey values
   * (InputMode) have no frames between frames: they are interpolated linearly in time.
   */
  vtkSetClampMacro(FrameSteps, int, 0, 8);
  vtkGetMacro(FrameSteps, int);
  ///@}

  ///@{
  /**
   * Times of planes that the mesh conforms to, in the input's unit and in any order: no pentatope has
   * points before and after a plane. So the mesh is a stack of slabs, whose facets on a plane are the same
   * on both sides, with the same labels. They need not be times of frames. Those of the first and the last frame
   * have no effect. Slabs must not be thinner than Delta, as a length (see TimeScale). By default there are none.
   */
  void AddTimePlane(double time);
  void RemoveAllTimePlanes();
  int GetNumberOfTimePlanes() const;
  double GetTimePlane(int plane) const; ///< 0 if there is no such plane
  ///@}

  ///@{
  /** Whether there is also a plane at the time of each frame. Default off. */
  vtkSetMacro(TimePlanesAtFrames, bool);
  vtkGetMacro(TimePlanesAtFrames, bool);
  vtkBooleanMacro(TimePlanesAtFrames, bool);
  ///@}

  ///@{
  /**
   * Whether the last frame is the first one again, as in a heart that beats. The frames must be equal: labels, or
   * grey values where isosurfaces are meshed. The flat ends of
   * the mesh are then congruent: the same points in space, to the bit, the same tetrahedra and
   * labels. If there is no time plane, one is added half-way. Default off.
   */
  vtkSetMacro(Periodic, bool);
  vtkGetMacro(Periodic, bool);
  vtkBooleanMacro(Periodic, bool);
  ///@}

  /** Values of RuleOrder. */
  enum RuleOrders
  {
    RADIUS_EDGE_FIRST = 0,
    SURFACE_FIRST = 1
  };

  ///@{
  /**
   * The order in which poor elements are refined. Default radius-edge first.
   * - Radius-edge first: elements with a large radius-edge ratio come before all others (thesis,
   *   section 4.6.1). This keeps the number of elements that an insertion changes small.
   * - Surface first: the rules that sample the interfaces come before the rules for quality
   *   (thesis, section 4.2). For comparisons.
   *
   * Values outside of RuleOrders are clamped.
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
   * Whether to avoid slivers, elements that are nearly flat although their radius-edge ratio is
   * good. The point to insert is picked at random in a region around its original place until it
   * makes no small sliver (thesis, section 4.1). Default on. If it is off, meshing is much faster
   * and slivers stay.
   */
  vtkSetMacro(PickingRegions, bool);
  vtkGetMacro(PickingRegions, bool);
  vtkBooleanMacro(PickingRegions, bool);
  ///@}

  ///@{
  /**
   * Radius of a picking region over the radius of the ball around its element (zeta of the thesis),
   * above 0 and below 1. Default 0.5.
   */
  vtkSetMacro(PickingRadius, double);
  vtkGetMacro(PickingRadius, double);
  ///@}

  ///@{
  /** Number of points that are tried in a picking region, at least 1. Default 10. */
  vtkSetMacro(NumberOfPicks, int);
  vtkGetMacro(NumberOfPicks, int);
  ///@}

  ///@{
  /**
   * An element is a sliver if its normalized volume is below this. The normalized volume is its
   * volume over that of the regular pentatope with the same circumradius. From 0 to below 1,
   * default 0.01. Above 0.03 meshes can become very large, and the value is refused unless Force is
   * on.
   */
  vtkSetMacro(SliverBound, double);
  vtkGetMacro(SliverBound, double);
  ///@}

  ///@{
  /**
   * A sliver is small if its circumradius is below this factor times the radius of the ball of the
   * picking region (b of the thesis' theorem 4.1). A picked point must not make a small sliver. At
   * least 1, default 4.
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
   * Whether waiting threads help other threads with the elements that an insertion deletes and
   * makes (thesis, section 4.6.2). Default on. It has no effect with more threads than processors.
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
  std::vector<double> FrameTimes;
  int FrameSteps = 0;
  std::vector<double> TimePlanes;
  bool TimePlanesAtFrames = false;
  bool Periodic = false;
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
  /** The times of frames: those that are set, else those of the input. @throws InputError */
  std::vector<double> ChooseTimes(const std::vector<double>& ofInput) const;
  /** Number of frames of an image without time steps; 0 if it is unknown before execution. */
  int FindNumberOfComponents(vtkInformationVector** inputVector);

  struct Frames;
  std::unique_ptr<Frames> Gathered;
};

#endif
