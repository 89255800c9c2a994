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
 * The input may also be a grey-value image (InputMode): then what an isosurface of it bounds is meshed, as
 * one tissue.
 *
 * @par Inputs
 * - Port 0, vtkImageData: one label per voxel, 0 is background. The array is the one chosen by
 *   `SetInputArrayToProcess(0, 0, 0, association, name)`; by default the active point scalars, else
 *   the active cell scalars. Point scalars lie at the points, cell scalars at the cell centres. One
 *   component, any scalar type; labels are whole values, none of them negative, grey values any numbers
 *   (see InputMode). Scalars that lie contiguous in memory are read in place.
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
 * pieces are explained, Grading, FacetAngle, SliverAngle, SmallestComponent, ExactComponents and MinimumComponentVolume; InputMode and
 * what belongs to it. Two more things bound element sizes: SizeImplicitFunction, and the image at input port 1.
 *
 * @par Errors
 * With isosurfaces also: an Isovalue that is not finite or lies outside of the image's range (the message
 * says the range), values none of which is a number, an InsideLabel below 1, labels that were added or excluded.
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
  static vtkImageToTetMeshFilter* New();
  vtkTypeMacro(vtkImageToTetMeshFilter, vtkImageToSimplexMeshFilter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /** Values of InputMode. */
  enum InputModes
  {
    INPUT_LABELS = 0,
    INPUT_ISOSURFACE = 1
  };

  ///@{
  /**
   * What the values of the input are. Default labels.
   * - Labels: the tissue of each voxel.
   * - Isosurface: grey values, such as those of a CT, a signed distance, a density. What lies on the Inside
   *   of the isosurface at Isovalue is meshed, with InsideLabel as its label. Between the voxel
   *   centres values are interpolated trilinearly, so that the vertices of the interface lie on the surface
   *   that vtkFlyingEdges3D triangulates, to a thousandth of a voxel. Voxels with the Isovalue itself are inside;
   *   those that are not a number are outside. What the image's border cuts is closed half a voxel beyond the
   *   outermost voxels, by a plane.
   *
   * The values are those of InputModes, others are clamped to them.
   */
  vtkSetClampMacro(InputMode, int, INPUT_LABELS, INPUT_ISOSURFACE);
  vtkGetMacro(InputMode, int);
  void SetInputModeToLabels() { this->SetInputMode(INPUT_LABELS); }
  void SetInputModeToIsosurface() { this->SetInputMode(INPUT_ISOSURFACE); }
  /** "labels" or "isosurface". */
  const char* GetInputModeAsString() const;
  ///@}

  ///@{
  /** The value of the isosurface (vtkContourFilter's SetValue()), if InputMode is isosurface. Default 0. */
  vtkSetMacro(Isovalue, double);
  vtkGetMacro(Isovalue, double);
  ///@}

  /** Values of Inside. */
  enum Sides
  {
    INSIDE_ABOVE = 0,
    INSIDE_BELOW = 1
  };

  ///@{
  /**
   * On which side of the isosurface the object lies: where values are at least the Isovalue (above, the
   * default), or at most (below: signed distances that are negative inside). The values are those of Sides,
   * others are clamped to them.
   */
  vtkSetClampMacro(Inside, int, INSIDE_ABOVE, INSIDE_BELOW);
  vtkGetMacro(Inside, int);
  void SetInsideToAbove() { this->SetInside(INSIDE_ABOVE); }
  void SetInsideToBelow() { this->SetInside(INSIDE_BELOW); }
  /** "above" or "below". */
  const char* GetInsideAsString() const;
  ///@}

  ///@{
  /** The label of what is inside of the isosurface, 1 or more. Default 1. */
  vtkSetMacro(InsideLabel, vtkTypeInt64);
  vtkGetMacro(InsideLabel, vtkTypeInt64);
  ///@}

  ///@{
  /**
   * Standard deviation, in voxels along each axis, of a smoothing of grey values against noise, if InputMode
   * is isosurface; SmoothingSigma is about labels only. It moves smooth surfaces hardly, but rounds edges, and specks
   * and gaps may vanish. 0 to 5; default 0: grey values have no voxel stairs.
   */
  vtkSetMacro(IsosurfaceSmoothingSigma, double);
  vtkGetMacro(IsosurfaceSmoothingSigma, double);
  ///@}

  /** Values of Grading. */
  enum GradingModes
  {
    UNIFORM = 0,
    LOCAL_FEATURE_SIZE = 1
  };

  ///@{
  /**
   * How densely interfaces are sampled. UNIFORM, the default: with Delta everywhere. LOCAL_FEATURE_SIZE (thesis,
   * sections 2.2 and 2.6.1): with Delta where the shape needs it, and more coarsely elsewhere, at a point z
   * with max(Delta, FeatureRatio x min(lfs(z), LargestFeature)), where lfs(z) is the distance from z to the
   * medial axis of the interfaces: about half the thickness of what is thin. Other values are clamped.
   */
  vtkSetClampMacro(Grading, int, UNIFORM, LOCAL_FEATURE_SIZE);
  vtkGetMacro(Grading, int);
  void SetGradingToUniform() { this->SetGrading(UNIFORM); }
  void SetGradingToLocalFeatureSize() { this->SetGrading(LOCAL_FEATURE_SIZE); }
  /** "uniform" or "local-feature-size". */
  const char* GetGradingAsString() const;
  ///@}

  ///@{
  /**
   * Sampling density over local feature size (delta of the thesis, where it is 2); the larger, the coarser are
   * the meshes. Positive; default 1. Without effect unless Grading is LOCAL_FEATURE_SIZE.
   */
  vtkSetMacro(FeatureRatio, double);
  vtkGetMacro(FeatureRatio, double);
  ///@}

  ///@{
  /**
   * Local feature sizes above this count as this (lambda of the thesis): so many edges of a cube with a voxel's
   * volume. Positive; default 12. Without effect unless Grading is LOCAL_FEATURE_SIZE.
   */
  vtkSetMacro(LargestFeature, double);
  vtkGetMacro(LargestFeature, double);
  ///@}

  ///@{
  /** Lower bound of the angles of interface triangles in degrees, 0 to 30. Default 30. */
  vtkSetMacro(FacetAngle, double);
  vtkGetMacro(FacetAngle, double);
  ///@}

  ///@{
  /**
   * Tetrahedra with a dihedral angle below this, or above 180 degrees less this, are slivers: they are
   * split, or the interface near them is sampled more densely (thesis, section 2.6.2). Where no point
   * helps, which is rare, a sliver stays (vtkMeshingStatistics::GetSliversKept()). While Optimise is on without a time
   * limit, slivers above 3 degrees are left to it, which takes fewer elements, unless they are wedged between interfaces.
   * Degrees, 0 to 60; default 9, which without Optimise makes about a tenth more elements; 0 leaves slivers alone. Above 15 meshes can become
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
   * refinement. The mesh is no longer Delaunay. Default on.
   * vtkMeshingStatistics::GetOptimised() and what follows it tell what it did.
   */
  vtkSetMacro(Optimise, bool);
  vtkGetMacro(Optimise, bool);
  vtkBooleanMacro(Optimise, bool);
  ///@}

  ///@{
  /**
   * Wall-clock seconds after which optimisation stops and leaves the rest as it is; the mesh then depends on the
   * speed of the machine. Default 0: no limit.
   */
  vtkSetMacro(OptimisationTimeLimit, double);
  vtkGetMacro(OptimisationTimeLimit, double);
  ///@}

  ///@{
  /**
   * Sample the curves where three labels or more meet, and the corners where four do, before all else, so that
   * edges of tetrahedra follow them; background is a label, too. Default on. Off, vertices of interfaces lie
   * anywhere beside the junctions, and these zigzag.
   */
  vtkSetMacro(SampleJunctions, bool);
  vtkGetMacro(SampleJunctions, bool);
  vtkBooleanMacro(SampleJunctions, bool);
  ///@}

  ///@{
  /**
   * How often, at most, the mesh is compared with the image and refined where an interface of the image is farther
   * from those of the mesh than about 1.5 Delta (tips of thin processes, holes), or where the boundary of a
   * label is not manifold. Default 8, of which mostly 3 to 6 are needed; 0: never.
   */
  vtkSetClampMacro(InterfaceRounds, int, 0, 100);
  vtkGetMacro(InterfaceRounds, int);
  ///@}

  ///@{
  /**
   * Make the boundary of every label manifold: two of its triangles meet at each edge. Where more do, tetrahedra around the
   * edge go to a neighbouring label, or parts of them where whole ones cannot; these parts are not Delaunay. Default on.
   */
  vtkSetMacro(Manifold, bool);
  vtkGetMacro(Manifold, bool);
  vtkBooleanMacro(Manifold, bool);
  ///@}

  ///@{
  /**
   * Every connected component (through voxel faces) of a label that has at least so many voxels gets
   * tetrahedra, however small or thin it is beside Delta: if it has none, a few points are added where it is thickest. So does the largest component of each label, however few voxels it has. Default 8; 1 keeps all
   * single voxels, too; 0 leaves all components to chance. What has no
   * tetrahedron all the same is named with vtkWarningMacro and in the statistics
   * (vtkMeshingStatistics::GetNumberOfLostComponents()).
   */
  vtkSetClampMacro(SmallestComponent, int, 0, VTK_INT_MAX);
  vtkGetMacro(SmallestComponent, int);
  ///@}

  ///@{
  /**
   * Sample the components that SmallestComponent looks after as finely as they are thin, whatever Delta. Default off:
   * those that are thin beside Delta are as exact as Delta makes them, and the number of tetrahedra falls as Delta grows.
   */
  vtkSetMacro(ExactComponents, bool);
  vtkGetMacro(ExactComponents, bool);
  vtkBooleanMacro(ExactComponents, bool);
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

  int Grading = UNIFORM;
  double FeatureRatio = 1.0;
  double LargestFeature = 12.0;
  int InputMode = INPUT_LABELS;
  double Isovalue = 0.0;
  int Inside = INSIDE_ABOVE;
  vtkTypeInt64 InsideLabel = 1;
  double IsosurfaceSmoothingSigma = 0.0;
  double FacetAngle = 30.0;
  double SliverAngle = 9.0;
  bool Optimise = true;
  double OptimisationTimeLimit = 0.0;
  bool SampleJunctions = true;
  int InterfaceRounds = 8;
  bool Manifold = true;
  int SmallestComponent = 8;
  bool ExactComponents = false;
  double MinimumComponentVolume = 0.0;

private:
  vtkImageToTetMeshFilter(const vtkImageToTetMeshFilter&) = delete;
  void operator=(const vtkImageToTetMeshFilter&) = delete;

  vtkSmartPointer<vtkImplicitFunction> SizeImplicitFunction;
};

#endif
