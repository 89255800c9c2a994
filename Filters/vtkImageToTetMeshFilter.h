// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkImageToTetMeshFilter
 * @brief   label image, or isosurface of an image, to conforming, quality tetrahedral mesh
 *
 * Every tissue of a segmented image becomes a set of tetrahedra; tetrahedra of neighbouring tissues
 * share the nodes of their common interface. The interfaces are smooth rather than staircases. The
 * mesh is a Delaunay refinement made directly from the image, with provable bounds on the shape of
 * elements (P. Foteinos, "Real-time high-quality image-to-mesh conversion for finite element
 * simulations", 2013, chapters 2 and 3).
 *
 * The input may also be a grey-value image (InputMode). Then the filter meshes the region that an
 * isosurface bounds, as one tissue.
 *
 * @par Inputs
 * - Port 0, vtkImageData: one label per voxel, 0 is background. The array is the one chosen by
 *   `SetInputArrayToProcess(0, 0, 0, association, name)`; by default the active point scalars, else
 *   the active cell scalars. Point scalars lie at the points, cell scalars at the cell centres. The
 *   array has one component of any scalar type. Labels are whole values (to within 1e-5, for larger
 *   labels 1e-5 of them and at most 0.01), none of them negative; grey values are any numbers (see
 *   InputMode). Voxels that the image hides (`vtkGhostType`: HIDDENPOINT, HIDDENCELL, REFINEDCELL)
 *   are background, and outside of isosurfaces; duplicates are voxels like others. Scalars that are
 *   contiguous in memory are read in place, unless some are hidden. Origin, spacing, direction matrix
 *   (skewed and left-handed ones included) and extent are honoured: the mesh lies in physical space,
 *   `origin + direction * diag(spacing) * (i, j, k)`.
 * - Port 1, vtkImageData, optional: an upper bound of the element size at every point, in physical
 *   units; see "Element sizes". The array is chosen by `SetInputArrayToProcess(1, 1, 0, ...)`.
 *
 * @par Outputs
 * - Port 0, vtkUnstructuredGrid: `VTK_TETRA` cells. Each has positive volume in physical space, for
 *   left-handed and right-handed axes of the image. Points are double precision. Each point is used
 *   by a cell, and the order of points keeps neighbours near each other.
 *   - Cell array `Label` (1 component, active scalars): the image's own label value. The type is
 *     `vtkIntArray`, or `vtkLongLongArray` if a label does not fit into an int.
 * - Port 1, vtkPolyData: the triangles between two labels, or between a label and the background,
 *   each once. The points are those of port 0 that the triangles use.
 *   - Cell array `Labels` (2 components, type as above): the labels on both sides, the larger
 *     first, 0 for background. The normal given by the right-hand rule points out of the region
 *     of the first label, into the second.
 *   - Point array `PointIds` (1 component, vtkIdTypeArray): the index of the point in port 0.
 *
 * The field data of port 0 is passed to both outputs, with names of the labels that the mesh has.
 *
 * @par Parameters
 * Those of vtkImageToSimplexMeshFilter and those below. Its documentation also explains element
 * sizes, errors, progress, abort, threads and pieces. SizeImplicitFunction and the image at input
 * port 1 bound element sizes, too.
 *
 * @par Errors
 * Those of vtkImageToSimplexMeshFilter. With isosurfaces also: an Isovalue that is not finite or
 * lies outside of the image's range (the message says the range), an image without any value that
 * is a number, an InsideLabel below 1, labels that were added or excluded.
 *
 * @sa vtkImageToSimplexMeshFilter vtkImageToPentatopeMeshFilter vtkMeshingStatistics
 * vtkSurfaceNets3D vtkFlyingEdges3D
 */
#ifndef vtkImageToTetMeshFilter_h
#define vtkImageToTetMeshFilter_h

#include "vtkImageToSimplexMeshFilter.h"
#include "vtkVoxplexModule.h" // For export macro

#include "vtkSmartPointer.h" // For vtkSmartPointer

class vtkAlgorithmOutput;
class vtkImplicitFunction;
class vtkPolyData;

class VTKVOXPLEX_EXPORT vtkImageToTetMeshFilter : public vtkImageToSimplexMeshFilter
{
public:
  ///@{
  /** Construction, type information and printing, as in all VTK classes. */
  static vtkImageToTetMeshFilter* New();
  vtkTypeMacro(vtkImageToTetMeshFilter, vtkImageToSimplexMeshFilter);
  void PrintSelf(ostream& os, vtkIndent indent) override;
  ///@}

  ///@{
  /** Lower bound of the angles of interface triangles in degrees, 0 to 30. Default 30. */
  vtkSetMacro(FacetAngle, double);
  vtkGetMacro(FacetAngle, double);
  ///@}

  ///@{
  /**
   * A tetrahedron is a sliver if a dihedral angle is below this, or above 180 degrees minus this. A
   * sliver is split, or the interface near it is sampled more finely (thesis, section 2.6.2). In
   * rare cases no point helps, and the sliver stays ("/slivers/kept" of the statistics). If
   * Optimise is on without a time limit, slivers above 1 degree are left to the optimisation,
   * which needs fewer elements, unless they are wedged between interfaces. Degrees, 0 to 59.
   * Default 9, which without Optimise makes about a tenth more elements. 0 leaves slivers alone.
   * Above 15 meshes can become very large, and the value is refused unless Force is on.
   */
  vtkSetMacro(SliverAngle, double);
  vtkGetMacro(SliverAngle, double);
  ///@}

  ///@{
  /**
   * Wall-clock seconds after which optimisation stops and leaves the remaining elements unchanged.
   * The mesh then depends on the speed of the machine. Default 0: no limit.
   */
  vtkSetMacro(OptimisationTimeLimit, double);
  vtkGetMacro(OptimisationTimeLimit, double);
  ///@}

  ///@{
  /**
   * Before all else, sample the junctions: the curves where three labels or more meet, and the
   * corners where four labels meet. Then edges of tetrahedra follow them. Background is a label,
   * too. Default on. If it is off, vertices of interfaces lie beside the junctions, and the
   * junctions zigzag.
   */
  vtkSetMacro(SampleJunctions, bool);
  vtkGetMacro(SampleJunctions, bool);
  vtkBooleanMacro(SampleJunctions, bool);
  ///@}

  ///@{
  /**
   * Connected components with less volume than this are left out: they get the label that most of
   * their faces touch. The unit is that of the spacing to the third power. Default 0: no component
   * is left out. The statistics list them (vtkMeshingStatistics::GetNumberOfDroppedComponents()).
   */
  vtkSetMacro(MinimumComponentVolume, double);
  vtkGetMacro(MinimumComponentVolume, double);
  ///@}

  ///@{
  /**
   * The value of this function at a physical point is an upper bound of circumradii there. Calls
   * are serialised, because implicit functions in general are not thread-safe. With many threads,
   * an image of sizes or SetSizeFunction() is faster.
   */
  virtual void SetSizeImplicitFunction(vtkImplicitFunction* function);
  vtkImplicitFunction* GetSizeImplicitFunction() const;
  ///@}

  ///@{
  /** The interfaces (output port 1). */
  vtkPolyData* GetInterfaces();
  vtkAlgorithmOutput* GetInterfacesPort() { return this->GetOutputPort(1); }
  ///@}

  /** Includes the modification time of the SizeImplicitFunction. */
  vtkMTimeType GetMTime() override;

protected:
  vtkImageToTetMeshFilter();
  ~vtkImageToTetMeshFilter() override;

  int FillOutputPortInformation(int port, vtkInformation* info) override;

#ifndef __VTK_WRAP__
  double FindDefaultDelta(vtkInformationVector** inputVector) override;
  void CheckParameters() const override;
  void Mesh(vtkInformationVector** inputVector, vtkInformationVector* outputVector) override;
#endif

  double FacetAngle = 30.0;
  double SliverAngle = 9.0;
  double OptimisationTimeLimit = 0.0;
  bool SampleJunctions = true;
  double MinimumComponentVolume = 0.0;

private:
  vtkImageToTetMeshFilter(const vtkImageToTetMeshFilter&) = delete;
  void operator=(const vtkImageToTetMeshFilter&) = delete;

  vtkSmartPointer<vtkImplicitFunction> SizeImplicitFunction;
};

#endif
