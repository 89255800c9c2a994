// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkImageToSimplexMeshFilter
 * @brief   base class of the filters that mesh label images
 *
 * Superclass of vtkImageToTetMeshFilter (a 3D image becomes tetrahedra) and
 * vtkImageToPentatopeMeshFilter (a series of images becomes space-time pentatopes). It has their
 * common parameters and runs an execution: errors, abort, statistics, warnings, pieces. The
 * subclasses document their inputs and outputs.
 *
 * @par Element sizes
 * An element's circumradius stays below each bound that applies at its circumcentre. The bounds are
 * ElementSize, the size of its label (SetLabelSize()), the size image (interpolated linearly;
 * points outside take the nearest value inside), the C++ callable (SetSizeFunction()) and the
 * bounds that the subclass adds. The smallest bound counts, and Gradation limits how fast it
 * changes in space. If the image or a function gives NaN, zero or a negative value, it sets no
 * bound there. Very small sizes are raised to a floor, a fraction of Delta, so that refinement
 * always ends.
 *
 * @par Errors
 * An error is reported with vtkErrorMacro and leaves both outputs empty. GetErrorMessage() keeps
 * the reason. The executive adds a message of its own, and its Update() returns 0. Errors are:
 * - no or unsuitable scalars, fractional, negative or non-finite labels, no foreground, fewer than
 *   two voxels along an axis, labels that look like grey values (unless Force is on), more than
 *   65000 labels of less than 8 voxels on average, spacing that is not positive and finite, a singular direction matrix. If there are
 *   labels of AddLabel(), only they count: all other whole numbers are background, negative ones
 *   included;
 * - parameters out of range, both Delta and NumberOfElements, a NumberOfElements that no Delta
 *   gives, a label in SetLabelSize(), SetInterfaceSize(), AddLabel() or ExcludeLabel() that the
 *   image does not have;
 * - a size image that lies beside the image, a mesh that is estimated not to fit in memory, an
 *   empty mesh;
 * - the errors that the subclass adds.
 *
 * Warnings are reported with vtkWarningMacro: labels of the image that the mesh lacks because Delta
 * is too coarse for them, sizes that were raised, a size image that does not cover the mesh, and a
 * ContentionManager that was replaced.
 *
 * @par Progress and abort
 * Progress is reported from the thread that called Update(), at least ten times a second during
 * meshing. It never decreases. If a progress observer or another thread sets AbortExecute, the
 * execution stops within a second and leaves both outputs empty; GetAborted() then returns true.
 * VTK regards the empty output as up to date: call Modified() to execute again.
 *
 * @par Threads
 * All stages use NumberOfThreads threads. Refinement is speculative: a thread locks the vertices
 * that its operation touches. If it finds a vertex locked, it gives the operation up (a rollback).
 * ContentionManager, LoadBalancer and PinThreads control how threads cooperate. Change the defaults
 * only for experiments; with one thread none of the three has an effect. vtkMeshingStatistics tells
 * how much time each thread lost, and why.
 *
 * With NumberOfThreads = 1 the mesh is bit-for-bit reproducible. With more threads the mesh differs
 * from run to run, but the bounds on shapes and sizes still hold. With Reproducible the mesh is the
 * same for any number of threads. Events are sent only from the
 * thread that called Update(). Distinct instances may execute at the same time. Only the statistics
 * are kept between executions.
 *
 * @par Pieces
 * The image cannot be meshed in pieces: piece 0 receives the whole mesh, other pieces are empty.
 *
 * @sa vtkImageToTetMeshFilter vtkImageToPentatopeMeshFilter vtkMeshingStatistics
 */
#ifndef vtkImageToSimplexMeshFilter_h
#define vtkImageToSimplexMeshFilter_h

#include "vtkUnstructuredGridAlgorithm.h"
#include "vtkVoxplexModule.h" // For export macro

#include <functional> // For std::function
#include <map>        // For std::map
#include <memory>     // For std::unique_ptr
#include <string>     // For std::string

class vtkAlgorithmOutput;
class vtkImageData;
class vtkMeshingStatistics;

class VTKVOXPLEX_EXPORT vtkImageToSimplexMeshFilter : public vtkUnstructuredGridAlgorithm
{
public:
  ///@{
  /** Construction, type information and printing, as in all VTK classes. */
  vtkAbstractTypeMacro(vtkImageToSimplexMeshFilter, vtkUnstructuredGridAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;
  ///@}

  /** Values of InputMode. */
  enum InputModes
  {
    INPUT_LABELS = 0,
    INPUT_ISOSURFACE = 1
  };

  ///@{
  /**
   * The kind of values that the input has. Default labels.
   * - Labels: the tissue of each voxel.
   * - Isosurface: grey values, for example of a CT, a signed distance, a density. The filter meshes
   *   the region on the Inside of the isosurface at Isovalue, with InsideLabel as its label.
   *   Between the voxel centres values are interpolated multilinearly. In 3D the vertices of the
   *   interface lie on the surface that vtkFlyingEdges3D triangulates, to a thousandth of a voxel.
   *   A voxel with the Isovalue itself is inside; a voxel whose value is not a number is outside.
   *   If the image's border cuts the object, a plane half a voxel beyond the outermost voxels
   *   closes it.
   *
   * Values outside of InputModes are clamped.
   */
  vtkSetClampMacro(InputMode, int, INPUT_LABELS, INPUT_ISOSURFACE);
  vtkGetMacro(InputMode, int);
  void SetInputModeToLabels() { this->SetInputMode(INPUT_LABELS); }
  void SetInputModeToIsosurface() { this->SetInputMode(INPUT_ISOSURFACE); }
  /** "labels" or "isosurface". */
  const char* GetInputModeAsString() const;
  ///@}

  ///@{
  /**
   * If InputMode is isosurface: the value of the isosurface (SetValue() of vtkContourFilter).
   * Default 0.
   */
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
   * The side of the isosurface on which the object lies. Above, the default: where values are at
   * least the Isovalue. Below: where values are at most the Isovalue, as with signed distances that
   * are negative inside. Values outside of Sides are clamped.
   */
  vtkSetClampMacro(Inside, int, INSIDE_ABOVE, INSIDE_BELOW);
  vtkGetMacro(Inside, int);
  void SetInsideToAbove() { this->SetInside(INSIDE_ABOVE); }
  void SetInsideToBelow() { this->SetInside(INSIDE_BELOW); }
  /** "above" or "below". */
  const char* GetInsideAsString() const;
  ///@}

  ///@{
  /** The label of the elements inside of the isosurface, 1 or more. Default 1. */
  vtkSetMacro(InsideLabel, vtkTypeInt64);
  vtkGetMacro(InsideLabel, vtkTypeInt64);
  ///@}

  ///@{
  /**
   * If InputMode is isosurface: standard deviation, in voxels along each axis, of a smoothing of
   * grey values against noise. (SmoothingSigma applies to labels only.) It hardly moves smooth
   * surfaces, but it rounds edges, and specks and gaps may vanish. 0 to 5; default 0, because grey
   * values have no voxel stairs.
   */
  vtkSetMacro(IsosurfaceSmoothingSigma, double);
  vtkGetMacro(IsosurfaceSmoothingSigma, double);
  ///@}

  ///@{
  /**
   * The sampling distance of interfaces, in physical units. The edges of surface triangles are
   * about one to two times as long. Smaller is finer: the number of elements grows about with the
   * square of 1 / Delta. 0, the default, derives Delta from the spacing: GetDefaultDelta() tells
   * this value before execution, GetStatistics()->GetDelta() the value that was used.
   */
  vtkSetMacro(Delta, double);
  vtkGetMacro(Delta, double);
  ///@}

  ///@{
  /**
   * The number of elements that the mesh shall have, to within a tenth. 0, the default: Delta
   * determines it. If it is not 0, Delta must be 0, unless DeltaIsSuggestion is on. Meshing is
   * repeated with different values of Delta, usually two or three times and at most twelve times,
   * until the number is within 5 %, from the fourth time on within 10 %. Element sizes are not
   * changed. If no Delta gives the number, this is an error. vtkMeshingStatistics::GetDelta() and
   * GetNumberOfRuns() describe the search.
   */
  vtkSetClampMacro(NumberOfElements, vtkTypeInt64, 0, VTK_TYPE_INT64_MAX);
  vtkGetMacro(NumberOfElements, vtkTypeInt64);
  ///@}

  ///@{
  /**
   * Whether Delta is only a suggestion. If it is, Delta has no effect beside a NumberOfElements;
   * otherwise both together are an error. For panels of applications, which always have a Delta.
   * Default off.
   */
  vtkSetMacro(DeltaIsSuggestion, bool);
  vtkGetMacro(DeltaIsSuggestion, bool);
  vtkBooleanMacro(DeltaIsSuggestion, bool);
  ///@}

  ///@{
  /**
   * Upper bound of circumradius / shortest edge of every element. Default 2. Below 1.93
   * meshes can become very large, and the value is refused unless Force is on.
   */
  vtkSetMacro(RadiusEdgeRatio, double);
  vtkGetMacro(RadiusEdgeRatio, double);
  ///@}

  ///@{
  /**
   * Standard deviation, in voxels along each axis, of the smoothing that turns voxel stairs into
   * smooth interfaces. The smoothing does not shrink objects, and every voxel centre keeps its
   * label. Default 1; 0 switches it off. It applies to label images only; for grey values see
   * SetIsosurfaceSmoothingSigma().
   */
  vtkSetMacro(SmoothingSigma, double);
  vtkGetMacro(SmoothingSigma, double);
  ///@}

  ///@{
  /**
   * Largest number of rounds that compare the mesh with the image. A round refines where an
   * interface of the image is farther than about 1.5 Delta from the interfaces of the mesh (tips of
   * thin processes, holes), or, in space, where the boundary of a label is not manifold. Default 8;
   * usually 3 to 6 rounds are needed. 0: never.
   */
  vtkSetClampMacro(InterfaceRounds, int, 0, 100);
  vtkGetMacro(InterfaceRounds, int);
  ///@}

  ///@{
  /**
   * Make the boundary of every label manifold: two of its triangles meet at each edge, in
   * space-time two of its tetrahedra at each triangle. If there are more, elements around that edge
   * or triangle get a neighbouring label. If whole elements cannot, they are split and parts of them
   * get it; these parts are not Delaunay. Default on.
   */
  vtkSetMacro(Manifold, bool);
  vtkGetMacro(Manifold, bool);
  vtkBooleanMacro(Manifold, bool);
  ///@}

  ///@{
  /**
   * Whether to move the vertices of interfaces a little, so that volumes are right: facets are
   * chords, and cut convex shapes short. Default on. If it is off, these vertices lie on the
   * interfaces. In 3D it has no effect if Optimise is off.
   */
  vtkSetMacro(FitInterfaces, bool);
  vtkGetMacro(FitInterfaces, bool);
  vtkBooleanMacro(FitInterfaces, bool);
  ///@}

  ///@{
  /**
   * Improve shapes after refinement with flips and smoothing. Default on.
   *
   * In 3D all dihedral angles but a few become 18 to 150 degrees. The price: radius-edge ratios up
   * to 2.5 (or RadiusEdgeRatio, if that is larger), and interface angles down to 20 degrees where
   * three or more labels meet. It takes about a third of the time of refinement.
   *
   * In space-time normalized volumes become 0.05 or more, with few exceptions. Radius-edge ratios
   * and sizes keep their bounds.
   *
   * The mesh is no longer Delaunay. "/optimisation" of vtkMeshingStatistics::ToJSON() describes the
   * result.
   */
  vtkSetMacro(Optimise, bool);
  vtkGetMacro(Optimise, bool);
  vtkBooleanMacro(Optimise, bool);
  ///@}

  ///@{
  /**
   * Smallest number of voxels of a connected component (through voxel faces) that always gets
   * elements, even if it is small or thin compared with Delta. If a component has no element, a few
   * points are added where it is thickest. The largest component of each label counts always, even
   * with fewer voxels. Default 8; 1 keeps single voxels, too; 0 gives no component special
   * treatment. In space-time, the components of each frame count, too: the mesh has elements there
   * at the time of the frame. If a component still has no element, vtkWarningMacro and the
   * statistics name it (vtkMeshingStatistics::GetNumberOfLostComponents()).
   */
  vtkSetClampMacro(SmallestComponent, int, 0, VTK_INT_MAX);
  vtkGetMacro(SmallestComponent, int);
  ///@}

  ///@{
  /**
   * Sample the components that SmallestComponent selects as finely as their thickness requires, for
   * any Delta; in 3D also as it takes to connect their tetrahedra through faces, unless
   * InterfaceRounds is 0. Default off: thin components are only as exact as Delta allows, and the number of
   * elements falls as Delta grows.
   */
  vtkSetMacro(ExactComponents, bool);
  vtkGetMacro(ExactComponents, bool);
  vtkBooleanMacro(ExactComponents, bool);
  ///@}

  ///@{
  /** Upper bound of circumradii everywhere, in physical units. 0, the default, sets none. */
  vtkSetMacro(ElementSize, double);
  vtkGetMacro(ElementSize, double);
  ///@}

  ///@{
  /**
   * Upper bound of the circumradii of one label's elements, in physical units. `label` is the
   * image's own value. If a label does not occur in the image, this is an error when the filter
   * executes. GetLabelSize() returns 0 for a label without a size. The labels with a size are
   * numbered in increasing order of their value; GetSizedLabel() returns 0 if the index is out of
   * range.
   */
  void SetLabelSize(vtkTypeInt64 label, double size);
  double GetLabelSize(vtkTypeInt64 label) const;
  void RemoveLabelSize(vtkTypeInt64 label);
  void ClearLabelSizes();
  int GetNumberOfLabelSizes() const;
  vtkTypeInt64 GetSizedLabel(int index) const;
  ///@}

  ///@{
  /**
   * How much element sizes and interface sizes may change over a unit of length. With 0.3, the
   * default, an element 10 mm from a point of size 1 mm has a bound of at most 4 mm. So all sizes,
   * from any source, change smoothly. It has no effect if no size is given, or only one for all
   * elements. 0 sets no limit; then a small size beside a large Delta can take very long.
   */
  vtkSetMacro(Gradation, double);
  vtkGetMacro(Gradation, double);
  ///@}

  /** Values of Grading; others are clamped. */
  enum GradingModes
  {
    UNIFORM = 0,
    LOCAL_FEATURE_SIZE = 1
  };

  ///@{
  /**
   * The sampling distance of interfaces: Delta everywhere (UNIFORM, the default), or more where
   * their shape allows it (LOCAL_FEATURE_SIZE; thesis, 2.2 and 2.6.1). At a point z it is then at
   * most max(Delta, FeatureRatio x min(lfs(z), LargestFeature)). The local feature size lfs(z) is
   * the distance from the medial axis of the interfaces: about half the thickness of a thin part.
   * FeatureRatio is positive, default 1. LargestFeature is positive, default 12, and its unit is the
   * edge of a (hyper)cube with a voxel's (hyper)volume.
   */
  vtkSetClampMacro(Grading, int, UNIFORM, LOCAL_FEATURE_SIZE);
  vtkGetMacro(Grading, int);
  void SetGradingToUniform() { this->SetGrading(UNIFORM); }
  void SetGradingToLocalFeatureSize() { this->SetGrading(LOCAL_FEATURE_SIZE); }
  /** "uniform" or "local-feature-size". */
  const char* GetGradingAsString() const;
  vtkSetMacro(FeatureRatio, double);
  vtkGetMacro(FeatureRatio, double);
  vtkSetMacro(LargestFeature, double);
  vtkGetMacro(LargestFeature, double);
  ///@}

  /**
   * In SetInterfaceSize(), ANY_LABEL stands for all labels that share an interface with the other
   * label.
   */
  enum InterfaceLabels
  {
    ANY_LABEL = -1
  };

  ///@{
  /**
   * The sampling distance of the interface between two labels, in place of Delta. With ANY_LABEL it
   * applies to all interfaces of a label. It may be smaller or larger than Delta. Labels are the
   * image's own values, 0 is background; their order does not matter. A size of a pair counts
   * before the sizes of all interfaces of its labels. If both labels have such a size, the smaller
   * one counts. If element sizes at an interface are smaller, they replace it, as they replace
   * Delta.
   *
   * If the image does not have a label, this is an error when the filter executes.
   * GetInterfaceSize() returns 0 if no size was set. The sized interfaces are numbered in
   * increasing order of the larger label, then of the other label. GetSizedInterface() returns both
   * labels, or ANY_LABEL twice if the index is out of range.
   */
  void SetInterfaceSize(vtkTypeInt64 label, vtkTypeInt64 other, double size);
  double GetInterfaceSize(vtkTypeInt64 label, vtkTypeInt64 other) const;
  void RemoveInterfaceSize(vtkTypeInt64 label, vtkTypeInt64 other);
  void ClearInterfaceSizes();
  int GetNumberOfInterfaceSizes() const;
  void GetSizedInterface(int index, vtkTypeInt64 labels[2]) const;
  ///@}

  ///@{
  /**
   * Restrict meshing to some labels; the others become background. By default (no label added) all
   * labels are meshed. If a label does not occur in the image, this is an error when the filter
   * executes.
   */
  void AddLabel(vtkTypeInt64 label);
  void RemoveLabel(vtkTypeInt64 label);
  void RemoveAllLabels();
  int GetNumberOfSelectedLabels() const;
  vtkTypeInt64 GetSelectedLabel(int index) const;
  ///@}

  ///@{
  /**
   * Leave labels out: they become background. Together with AddLabel(), the filter meshes the added
   * labels without the excluded ones. If a label does not occur in the image, or if no label
   * remains, this is an error when the filter executes. GetExcludedLabel() returns 0 if the index
   * is out of range.
   */
  void ExcludeLabel(vtkTypeInt64 label);
  void RemoveExcludedLabel(vtkTypeInt64 label);
  void RemoveAllExcludedLabels();
  int GetNumberOfExcludedLabels() const;
  vtkTypeInt64 GetExcludedLabel(int index) const;
  ///@}

  ///@{
  /**
   * One row of a table of labels, for user interfaces: whether the label is meshed, and the upper
   * bound of its elements' circumradii (0 sets none). It has the same effect as SetLabelSize() or
   * RemoveLabelSize(), and ExcludeLabel() or RemoveExcludedLabel(). ClearLabelRows() removes all
   * sizes and all exclusions. Labels without a row are meshed.
   */
  void SetLabelRow(vtkTypeInt64 label, double size, bool meshed);
  void ClearLabelRows();
  ///@}

#ifndef __VTK_WRAP__
  /**
   * The numbers of voxels of the labels that an array of an image has, for such a table. Background
   * is left out, as are voxels that the image hides. Of several components, all count.
   * @param image any image; it is not changed
   * @param association vtkDataObject::FIELD_ASSOCIATION_POINTS or _CELLS
   * @param name an empty one means the default, as in SetInputArrayToProcess()
   * @param message why there are no labels, for InTermsOf(); empty if there are
   */
  static std::map<vtkTypeInt64, vtkTypeInt64> CountLabels(
    vtkImageData* image, int association, const std::string& name, std::string& message);
#endif

  ///@{
  /**
   * As in vtkAlgorithm, but an empty name means the default: the active point scalars, else the
   * active cell scalars. ParaView passes an empty name when it does not know the arrays of its
   * input yet.
   */
  void SetInputArrayToProcess(
    int index, int port, int connection, int association, const char* name) override;
  using vtkUnstructuredGridAlgorithm::SetInputArrayToProcess;
  ///@}

  /**
   * The array of the image of element sizes: SetInputArrayToProcess(1, 1, 0, association, name).
   */
  void SetElementSizeArray(int association, const char* name)
  {
    this->SetInputArrayToProcess(1, 1, 0, association, name);
  }

  ///@{
  /** Sets the image of element sizes (input port 1); null removes it. */
  void SetElementSizeConnection(vtkAlgorithmOutput* port)
  {
    this->SetInputConnection(1, port);
  }
  void SetElementSizeData(vtkImageData* image);
  ///@}

  ///@{
  /**
   * Number of threads of every stage. 0, the default, uses VTK's SMP setting:
   * vtkSMPTools::GetEstimatedNumberOfThreads() when the filter executes. More threads than cores
   * are allowed, but slower.
   */
  vtkSetClampMacro(NumberOfThreads, int, 0, VTK_INT_MAX);
  vtkGetMacro(NumberOfThreads, int);
  ///@}

  ///@{
  /**
   * Make the same mesh, bit for bit, with any number of threads. Default off. The threads then
   * refine different parts of space, not one part together; ContentionManager, LoadBalancer and
   * PinThreads have no effect. The mesh is as good as without this option, but another one, also
   * with one thread. If optimisation has a time limit, the mesh depends on the machine all the same.
   */
  vtkSetMacro(Reproducible, bool);
  vtkGetMacro(Reproducible, bool);
  vtkBooleanMacro(Reproducible, bool);
  ///@}

  /**
   * The value that Delta = 0 means for the present input: twice the edge of a cube (in 4D, of a
   * hypercube) with a voxel's volume. It is known once the filter or UpdateInformation() has
   * executed, if the input announces its spacing by then; otherwise it is 0.
   */
  vtkGetMacro(DefaultDelta, double);

  /** Values of ContentionManager. */
  enum ContentionManagers
  {
    CONTENTION_AGGRESSIVE = 0,
    CONTENTION_RANDOM = 1,
    CONTENTION_GLOBAL = 2,
    CONTENTION_LOCAL = 3
  };

  ///@{
  /**
   * What a refinement thread does after a rollback (thesis, section 3.3). Default local.
   * - Aggressive: it tries again at once.
   * - Random: after several rollbacks in a row it sleeps for a random time.
   * - Global: it waits in one list for all threads, until a thread that makes progress wakes it.
   * - Local: it waits in the list of the thread that held the vertex, until that thread makes
   *   progress.
   *
   * Global and local cannot livelock. Aggressive and random can. If no thread makes progress any
   * more, the local manager takes over and the filter warns
   * (vtkMeshingStatistics::GetSwitchedToLocal()). Values outside of ContentionManagers are clamped.
   */
  vtkSetClampMacro(ContentionManager, int, CONTENTION_AGGRESSIVE, CONTENTION_LOCAL);
  vtkGetMacro(ContentionManager, int);
  void SetContentionManagerToAggressive()
  {
    this->SetContentionManager(CONTENTION_AGGRESSIVE);
  }
  void SetContentionManagerToRandom()
  {
    this->SetContentionManager(CONTENTION_RANDOM);
  }
  void SetContentionManagerToGlobal()
  {
    this->SetContentionManager(CONTENTION_GLOBAL);
  }
  void SetContentionManagerToLocal()
  {
    this->SetContentionManager(CONTENTION_LOCAL);
  }
  /** "aggressive", "random", "global" or "local". */
  const char* GetContentionManagerAsString() const;
  ///@}

  /** Values of LoadBalancer. */
  enum LoadBalancers
  {
    RANDOM_WORK_STEALING = 0,
    HIERARCHICAL_WORK_STEALING = 1
  };

  ///@{
  /**
   * From which thread a refinement thread without work gets some (thesis, sections 3.2.4 and
   * 3.4.1). Default hierarchical.
   * - Random work stealing (RWS): from the thread that looks first, on any core.
   * - Hierarchical work stealing (HWS): first from a thread of its socket, then from one of its
   *   NUMA node, then from the rest of the machine, so that less work travels far. On a machine
   *   with one socket there is little difference.
   *
   * Values outside of LoadBalancers are clamped.
   */
  vtkSetClampMacro(LoadBalancer, int, RANDOM_WORK_STEALING, HIERARCHICAL_WORK_STEALING);
  vtkGetMacro(LoadBalancer, int);
  void SetLoadBalancerToRandomWorkStealing()
  {
    this->SetLoadBalancer(RANDOM_WORK_STEALING);
  }
  void SetLoadBalancerToHierarchicalWorkStealing()
  {
    this->SetLoadBalancer(HIERARCHICAL_WORK_STEALING);
  }
  /** "rws" or "hws". */
  const char* GetLoadBalancerAsString() const;
  ///@}

  ///@{
  /**
   * Keep each refinement thread on a core of its own, if the system allows it. Default off. Leave
   * it off if other programs, or other instances of this filter, share the cores. The thread that
   * called Update() is never pinned.
   */
  vtkSetMacro(PinThreads, bool);
  vtkGetMacro(PinThreads, bool);
  vtkBooleanMacro(PinThreads, bool);
  ///@}

  ///@{
  /**
   * Continue in cases that the filter otherwise refuses: the mesh is estimated not to fit in
   * memory, the labels look like grey values (many, and most neighbouring voxels differ),
   * RadiusEdgeRatio is below the proved bound, or a parameter of the subclass says that it needs
   * Force. Default off.
   */
  vtkSetMacro(Force, bool);
  vtkGetMacro(Force, bool);
  vtkBooleanMacro(Force, bool);
  ///@}

  ///@{
  /**
   * Memory limit in bytes. If a mesh is estimated to need more, it is refused unless Force is on.
   * 0, the default, means the machine's physical memory.
   */
  vtkSetMacro(MemoryLimit, vtkTypeUInt64);
  vtkGetMacro(MemoryLimit, vtkTypeUInt64);
  ///@}

  ///@{
  /** Measure the quality and the labels of the mesh for GetStatistics(). Default off. */
  vtkSetMacro(ComputeQuality, bool);
  vtkGetMacro(ComputeQuality, bool);
  vtkBooleanMacro(ComputeQuality, bool);
  ///@}

  /** Values of Vocabulary. */
  enum Vocabularies
  {
    VOCABULARY_VTK = 0,
    VOCABULARY_COMMAND_LINE = 1,
    VOCABULARY_SLICER = 2,
    VOCABULARY_PYTHON = 3,
    VOCABULARY_PARAVIEW = 4
  };

  ///@{
  /**
   * In whose terms messages name parameters: with those of VTK (RadiusEdgeRatio), the default, or of a program
   * that shows the messages to its users (--radius-edge, radius_edge, 'Radius-Edge Ratio').
   */
  vtkSetClampMacro(Vocabulary, int, VOCABULARY_VTK, VOCABULARY_PARAVIEW);
  vtkGetMacro(Vocabulary, int);
  ///@}

  /** A message of vtkSegmentationReader, which names VTK's methods, in the terms of a vocabulary. */
  static std::string InTermsOf(int vocabulary, const std::string& message);

  /** Statistics of the last execution. The filter owns the object and never replaces it. */
  vtkMeshingStatistics* GetStatistics() const;

  /** Why the last execution failed; empty if it did not. */
  const std::string& GetErrorMessage() const
  {
    return this->ErrorMessage;
  }

  ///@{
  /** How the mesh of the last execution differs from what was asked for, as it was reported. */
  int GetNumberOfWarnings() const;
  const std::string& GetWarning(int i) const;
  ///@}

  /** Whether the last execution was stopped by AbortExecute. */
  bool GetAborted() const
  {
    return this->Aborted;
  }

#ifndef __VTK_WRAP__
  /**
   * Upper bound of circumradii at a point inside the label with this value. x has the three
   * physical coordinates; in 4D the fourth coordinate is the time.
   */
  using SizeFunctionType = std::function<double(const double* x, vtkTypeInt64 label)>;
  /**
   * An upper bound of circumradii as a C++ callable; an empty one removes it. All meshing threads
   * call it at the same time, so it must be thread-safe. If it throws an exception, the execution
   * ends and the exception is reported as an error.
   */
  void SetSizeFunction(SizeFunctionType function);
#endif

  /** What stopped the last execution does not stop the next one. */
  vtkTypeBool ProcessRequest(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

protected:
  vtkImageToSimplexMeshFilter();
  ~vtkImageToSimplexMeshFilter() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestInformation(vtkInformation*, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

#ifndef __VTK_WRAP__
  ///@{
  /**
   * The subclass's parts of an execution. They throw voxplex::Error for errors that the user can
   * correct, std::bad_alloc, and the exceptions of the size function. CheckParameters() comes
   * first. Gather() takes the data that the pipeline delivers. If it returns false, it asks for
   * another pass of the pipeline (vtkStreamingDemandDrivenPipeline::CONTINUE_EXECUTING, which is
   * set in the request of each pass after the first). Mesh() fills the outputs, unless it is
   * stopped.
   */
  virtual void CheckParameters() const;
  virtual bool Gather(vtkInformation* request, vtkInformationVector** inputVector);
  virtual void Mesh(vtkInformationVector** inputVector, vtkInformationVector* outputVector) = 0;
  ///@}

  /**
   * The default Delta for images as the pipeline describes them; 0 if it is unknown.
   * RequestInformation() calls this.
   */
  virtual double FindDefaultDelta(vtkInformationVector** inputVector) = 0;

  /** Whether a stop was requested. If so, GetAborted() stays true. */
  bool StopRequested();

  /** Reports a warning, in the terms of Vocabulary, and keeps it for GetWarning(). */
  void Warn(const std::string& warning);

  /** The number of threads that NumberOfThreads currently stands for. */
  unsigned GetThreads() const;

  /**
   * The part of an execution in D dimensions that the subclasses share (Private/SimplexMeshRun.h).
   */
  template <int D>
  class Run;
  struct Internals;
  std::unique_ptr<Internals> Private;
#endif

  double Delta = 0.0;
  double DefaultDelta = 0.0;
  vtkTypeInt64 NumberOfElements = 0;
  bool DeltaIsSuggestion = false;
  double RadiusEdgeRatio = 2.0;
  int InterfaceRounds = 8;
  bool Manifold = true;
  bool FitInterfaces = true;
  bool Optimise = true;
  int SmallestComponent = 8;
  bool ExactComponents = false;
  int InputMode = INPUT_LABELS;
  double Isovalue = 0.0;
  int Inside = INSIDE_ABOVE;
  vtkTypeInt64 InsideLabel = 1;
  double IsosurfaceSmoothingSigma = 0.0;
  double SmoothingSigma = 1.0;
  double ElementSize = 0.0;
  double Gradation = 0.3;
  int Grading = UNIFORM;
  double FeatureRatio = 1.0;
  double LargestFeature = 12.0;
  int NumberOfThreads = 0;
  int ContentionManager = CONTENTION_LOCAL;
  int LoadBalancer = HIERARCHICAL_WORK_STEALING;
  bool PinThreads = false;
  bool Reproducible = false;
  bool Force = false;
  vtkTypeUInt64 MemoryLimit = 0;
  bool ComputeQuality = false;
  int Vocabulary = VOCABULARY_VTK;

private:
  vtkImageToSimplexMeshFilter(const vtkImageToSimplexMeshFilter&) = delete;
  void operator=(const vtkImageToSimplexMeshFilter&) = delete;

  std::string ErrorMessage;
  bool Aborted = false;
};

#endif
