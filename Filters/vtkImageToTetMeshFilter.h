// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkImageToTetMeshFilter
 * @brief   label image to conforming, quality tetrahedral mesh
 *
 * Every tissue of a segmented image becomes a set of tetrahedra; tetrahedra of neighbouring tissues
 * share the nodes of their common interface. The interfaces are smooth rather than staircases. The
 * mesh is a Delaunay refinement made directly from the image, with provable bounds on the shape of
 * elements (P. Foteinos, "Real-time high-quality image-to-mesh conversion for finite element
 * simulations", 2013, chapters 2 and 3).
 *
 * @par Inputs
 * - Port 0, vtkImageData: one label per voxel, 0 is background. The array is the one chosen by
 *   `SetInputArrayToProcess(0, 0, 0, association, name)`; by default the active point scalars, else
 *   the active cell scalars. Point scalars lie at the points, cell scalars at the cell centres. One
 *   component, any scalar type, whole values, none of them negative. Scalars that lie contiguous
 *   in memory are read in place.
 *   Origin, spacing, direction matrix (skewed and left-handed ones included) and extent are
 *   honoured: the mesh lies in physical space, `origin + direction * diag(spacing) * (i, j, k)`.
 * - Port 1, vtkImageData, optional: an upper bound of the element size at every point, in physical
 *   units; see "Element sizes". The array is chosen by `SetInputArrayToProcess(1, 1, 0, ...)`.
 *
 * @par Outputs
 * - Port 0, vtkUnstructuredGrid: `VTK_TETRA` cells, each with positive volume in physical space
 *   whatever the handedness of the image's axes. Points are double precision, each used by a cell,
 *   in an order that keeps neighbours near each other.
 *   - Cell array `Label` (1 component, active scalars): the image's own label value. The type is
 *     `vtkIntArray`, or `vtkLongLongArray` if a label does not fit into an int.
 * - Port 1, vtkPolyData: the triangles between two labels, or between a label and the background,
 *   each once. The points are those of port 0 that the triangles use.
 *   - Cell array `Labels` (2 components, type as above): the labels on both sides, the larger
 *     first, 0 for background. The normal given by the right-hand rule points out of the region
 *     of the first label, into the second.
 *   - Point array `PointIds` (1 component, vtkIdTypeArray): the index of the point in port 0.
 *
 * The field data of port 0 is passed to both outputs.
 *
 * @par Parameters
 * Those of vtkImageToSimplexMeshFilter, where element sizes, errors, progress, abort, threads and
 * pieces are explained, FacetAngle, SliverAngle, SmallestComponent and MinimumComponentVolume. Two more things bound element sizes: SizeImplicitFunction,
 * and the image at input port 1.
 *
 * @sa vtkImageToSimplexMeshFilter vtkImageToPentatopeMeshFilter vtkMeshingStatistics
 * vtkSurfaceNets3D
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
  static vtkImageToTetMeshFilter* New();
  vtkTypeMacro(vtkImageToTetMeshFilter, vtkImageToSimplexMeshFilter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /** Lower bound of the angles of interface triangles in degrees, 0 to 30. Default 30. */
  vtkSetMacro(FacetAngle, double);
  vtkGetMacro(FacetAngle, double);
  ///@}

  ///@{
  /**
   * Tetrahedra with a dihedral angle below this, or above 180 degrees less this, are slivers: they are
   * split, or the interface near them is sampled more densely (thesis, section 2.6.2). Where no point
   * helps, which is rare, a sliver stays (vtkMeshingStatistics::GetSliversKept()). Degrees, 0 to 60;
   * default 9, which makes about a tenth more elements; 0 leaves slivers alone. Above 15 meshes can become
   * very large, and the value is refused unless Force is on.
   */
  vtkSetMacro(SliverAngle, double);
  vtkGetMacro(SliverAngle, double);
  ///@}

  ///@{
  /**
   * Improve shapes after refinement with flips and smoothing: dihedral angles of 15 to 155 degrees but for
   * a few, at the price of radius-edge ratios up to 2.5 (or RadiusEdgeRatio, if that is larger) and of interface
   * angles down to 20 degrees where three or more labels meet. It takes about a fifth of the time of
   * refinement. The mesh is no longer Delaunay. Default off.
   * vtkMeshingStatistics::GetOptimised() and what follows it tell what it did.
   */
  vtkSetMacro(Optimise, bool);
  vtkGetMacro(Optimise, bool);
  vtkBooleanMacro(Optimise, bool);
  ///@}

  ///@{
  /**
   * Every connected component (through voxel faces) of a label that has at least so many voxels gets
   * tetrahedra, however small or thin it is beside Delta: its interfaces are sampled as finely as that
   * takes. Default 8; 1 keeps single voxels, too; 0 leaves small components to chance. What has no
   * tetrahedron all the same is named with vtkWarningMacro and in the statistics
   * (vtkMeshingStatistics::GetNumberOfLostComponents()).
   */
  vtkSetClampMacro(SmallestComponent, int, 0, VTK_INT_MAX);
  vtkGetMacro(SmallestComponent, int);
  ///@}

  ///@{
  /**
   * Connected components with less volume than this are left out: they become what most of their
   * faces touch. In the unit of the spacing to the third power; default 0, nothing is left out. The
   * statistics list them (vtkMeshingStatistics::GetNumberOfDroppedComponents()).
   */
  vtkSetMacro(MinimumComponentVolume, double);
  vtkGetMacro(MinimumComponentVolume, double);
  ///@}

  ///@{
  /**
   * The value of this function at a physical point is an upper bound of circumradii there. Calls
   * are serialised, because implicit functions in general are not thread safe: with many threads an
   * image of sizes, or SetSizeFunction(), is faster.
   */
  virtual void SetSizeImplicitFunction(vtkImplicitFunction* function);
  vtkImplicitFunction* GetSizeImplicitFunction() const;
  ///@}

  ///@{
  /** The interfaces (output port 1). */
  vtkPolyData* GetInterfaces();
  vtkAlgorithmOutput* GetInterfacesPort() { return this->GetOutputPort(1); }
  ///@}

  /** Counts the SizeImplicitFunction in. */
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
  bool Optimise = false;
  int SmallestComponent = 8;
  double MinimumComponentVolume = 0.0;

private:
  vtkImageToTetMeshFilter(const vtkImageToTetMeshFilter&) = delete;
  void operator=(const vtkImageToTetMeshFilter&) = delete;

  vtkSmartPointer<vtkImplicitFunction> SizeImplicitFunction;
};

#endif
