// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkImageToSimplexMeshFilter
 * @brief   what the filters that mesh label images have in common
 *
 * Superclass of vtkImageToTetMeshFilter (a 3D image becomes tetrahedra) and
 * vtkImageToPentatopeMeshFilter (a series of images becomes space-time pentatopes). It has their
 * common parameters and carries an execution out: errors, abort, statistics, warnings, pieces. The
 * subclasses say what their inputs and outputs are.
 *
 * @par Element sizes
 * An element's circumradius stays below each bound that is given at its circumcentre: ElementSize,
 * the size of its label (SetLabelSize()), the size image (interpolated linearly; points outside
 * take the nearest value inside), the C++ callable (SetSizeFunction()) and what the subclass adds.
 * The smallest of them applies, and Gradation limits how fast it changes from place to place. Values that are NaN, zero or negative in the image or from a
 * function set no bound there. Very small sizes are raised to a floor, a fraction of Delta, so that
 * refinement always ends.
 *
 * @par Errors
 * Misuse is reported with vtkErrorMacro and leaves both outputs empty: no or unsuitable scalars,
 * fractional, negative or non-finite labels, no foreground, fewer than two voxels along an axis,
 * thousands of labels (a grey-value image), spacing that is not positive and finite, a singular
 * direction matrix, parameters out of range, a label in SetLabelSize(), SetInterfaceSize(), AddLabel() or
 * ExcludeLabel() that the image does not have, both Delta and NumberOfElements, a NumberOfElements that no Delta makes, a mesh that is estimated not to fit in memory, one that comes out empty, and what
 * the subclass adds. The executive then adds a message of its own and its Update() returns 0.
 * GetErrorMessage() keeps the reason. Labels of the image that the mesh lacks, because Delta is too
 * coarse for them, are named with vtkWarningMacro; so are sizes that were raised, and a
 * ContentionManager that was replaced.
 *
 * @par Progress and abort
 * Progress is reported from the thread that called Update(), at least ten times a second while
 * meshing and never decreasing. Setting AbortExecute, from a progress observer or from another
 * thread, stops within a second and leaves both outputs empty; GetAborted() then returns true. VTK
 * regards the empty output as up to date: call Modified() to execute again.
 *
 * @par Threads
 * All stages use NumberOfThreads threads. Refinement is speculative: threads lock the vertices that
 * an operation touches, and one that finds a vertex locked gives its operation up (a rollback).
 * ContentionManager, LoadBalancer and PinThreads say how threads get along; the defaults are the
 * right choice but for experiments, and with one thread none of the three matters.
 * vtkMeshingStatistics tells how much time each thread lost, and to what.
 *
 * With NumberOfThreads = 1 the mesh is bit-for-bit reproducible. With more it differs from run to
 * run; the bounds on shapes and sizes hold all the same. Events are sent from the thread that called
 * Update() only. Distinct instances may execute at the same time. Nothing is kept between
 * executions apart from the statistics.
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
#include <memory>     // For std::unique_ptr
#include <string>     // For std::string

class vtkAlgorithmOutput;
class vtkImageData;
class vtkMeshingStatistics;

class VTKVOXPLEX_EXPORT vtkImageToSimplexMeshFilter : public vtkUnstructuredGridAlgorithm
{
public:
  vtkAbstractTypeMacro(vtkImageToSimplexMeshFilter, vtkUnstructuredGridAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The sampling density of interfaces, in physical units: the edges of surface triangles are
   * about one to two times as long. Smaller is finer: the number of elements grows about with the
   * square of 1 / Delta. 0, the default, derives it from the spacing; GetStatistics()->GetDelta()
   * tells which was used. GetDefaultDelta() tells it before.
   */
  vtkSetMacro(Delta, double);
  vtkGetMacro(Delta, double);
  ///@}

  ///@{
  /**
   * Elements that the mesh is to have, to within a tenth; 0, the default, leaves it to Delta, which must be 0
   * otherwise, unless DeltaIsSuggestion. Meshing is repeated with one Delta after the other, two or three times as a rule and at most
   * twelve times, until the number is within 5 %, from the fourth time on within 10 %. All sizes stay what they are. An error
   * if no Delta makes the number. vtkMeshingStatistics::GetDelta() and what belongs to GetNumberOfRuns() tell how it went.
   */
  vtkSetClampMacro(NumberOfElements, vtkTypeInt64, 0, VTK_TYPE_INT64_MAX);
  vtkGetMacro(NumberOfElements, vtkTypeInt64);
  ///@}

  ///@{
  /**
   * Whether Delta is but a suggestion, without effect beside a NumberOfElements, rather than an error. For panels of
   * applications, which always have a Delta. Default off.
   */
  vtkSetMacro(DeltaIsSuggestion, bool);
  vtkGetMacro(DeltaIsSuggestion, bool);
  vtkBooleanMacro(DeltaIsSuggestion, bool);
  ///@}

  ///@{
  /**
   * Upper bound of circumradius / shortest edge of every element. Default 2. Below 1.93 it is not
   * proved that refinement ends, and the value is refused unless Force is on.
   */
  vtkSetMacro(RadiusEdgeRatio, double);
  vtkGetMacro(RadiusEdgeRatio, double);
  ///@}

  ///@{
  /**
   * Standard deviation, in voxels along each axis, of the smoothing that turns voxel stairs into
   * smooth interfaces. It does not shrink objects, and every voxel centre keeps its label. Default
   * 1; 0 switches it off. Of label images only
   * (vtkImageToTetMeshFilter::SetIsosurfaceSmoothingSigma()).
   */
  vtkSetMacro(SmoothingSigma, double);
  vtkGetMacro(SmoothingSigma, double);
  ///@}

  ///@{
  /** Upper bound of circumradii everywhere, in physical units. 0, the default, sets none. */
  vtkSetMacro(ElementSize, double);
  vtkGetMacro(ElementSize, double);
  ///@}

  ///@{
  /**
   * Upper bound of the circumradii of one label's elements, in physical units, by the image's own
   * label value. A label that does not occur in the image is an error when the filter executes.
   * GetLabelSize() returns 0 for a label without a size. Sized labels are numbered in increasing
   * order of their value; GetSizedLabel() returns 0 for an index out of range.
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
   * How much element sizes and interface sizes may change over a unit of length: with 0.3, the default, an element 10 mm
   * from a place of size 1 mm has a bound of 4 mm at most. So sizes pass into each other instead of stepping, whatever they come
   * from. It changes nothing if no size is given, or one for all. 0 sets no limit; then a small size beside a large Delta can
   * take very long.
   */
  vtkSetMacro(Gradation, double);
  vtkGetMacro(Gradation, double);
  ///@}

  /** In SetInterfaceSize(): all interfaces of the other label. */
  enum InterfaceLabels
  {
    ANY_LABEL = -1
  };

  ///@{
  /**
   * The sampling density of the interface between two labels, or with ANY_LABEL of all interfaces of a label,
   * in place of Delta; smaller or larger. Labels are the image's own values, 0 is background, the order does not matter. What is
   * given for a pair counts before what is given for its labels, of which the smaller one counts. Where element sizes at an interface are smaller
   * they take its place, as they do with Delta. A label that the image does not have is an error when the filter executes.
   * GetInterfaceSize() returns 0 where none was set. Those that are set are numbered in increasing order of
   * the larger label, then of the other; GetSizedInterface() gives both, or twice ANY_LABEL for an index out of
   * range.
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
   * labels are meshed. A label that does not occur in the image is an error when the filter
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
   * Leave labels out: they become background. Together with AddLabel(), the labels that were added
   * apart from those that were excluded are meshed. A label that does not occur in the image is an
   * error when the filter executes; so is it if no label remains. GetExcludedLabel() returns 0 for an index
   * out of range.
   */
  void ExcludeLabel(vtkTypeInt64 label);
  void RemoveExcludedLabel(vtkTypeInt64 label);
  void RemoveAllExcludedLabels();
  int GetNumberOfExcludedLabels() const;
  vtkTypeInt64 GetExcludedLabel(int index) const;
  ///@}

  ///@{
  /**
   * One row of a table of labels, as user interfaces have it: whether the label is meshed, and if so,
   * the upper bound of its elements' circumradii (0 sets none). The same as SetLabelSize() or
   * RemoveLabelSize(), and ExcludeLabel() or RemoveExcludedLabel(). ClearLabelRows() removes all sizes
   * and excludes no label any more. Labels without a row are meshed.
   */
  void SetLabelRow(vtkTypeInt64 label, double size, bool meshed);
  void ClearLabelRows();
  ///@}

  ///@{
  /**
   * As in vtkAlgorithm, but for an empty name, which means the default: the active point scalars, else the active cell
   * scalars. So ParaView says it when the arrays of its input are not known yet.
   */
  using vtkUnstructuredGridAlgorithm::SetInputArrayToProcess;
  void SetInputArrayToProcess(
    int index, int port, int connection, int association, const char* name) override;
  ///@}

  /**
   * The array of the image of element sizes: SetInputArrayToProcess(1, 1, 0, association, name).
   */
  void SetElementSizeArray(int association, const char* name)
  {
    this->SetInputArrayToProcess(1, 1, 0, association, name);
  }

  ///@{
  /** The image of element sizes (input port 1); null removes it. */
  void SetElementSizeConnection(vtkAlgorithmOutput* port) { this->SetInputConnection(1, port); }
  void SetElementSizeData(vtkImageData* image);
  ///@}

#ifndef __VTK_WRAP__
  /**
   * Upper bound of circumradii at a point inside the label with this value. x has three physical
   * coordinates, and in 4D the time as the fourth.
   */
  using SizeFunctionType = std::function<double(const double* x, vtkTypeInt64 label)>;
  /**
   * An upper bound of circumradii as a C++ callable; an empty one removes it. It is called from
   * every meshing thread at once and must be safe for that. An exception that it throws ends the
   * execution and is reported as an error.
   */
  void SetSizeFunction(SizeFunctionType function);
#endif

  ///@{
  /**
   * Threads to mesh with, in every stage. 0, the default, means what VTK's SMP setting says:
   * vtkSMPTools::GetEstimatedNumberOfThreads() when the filter executes. More threads than cores
   * are allowed, but slower.
   */
  vtkSetClampMacro(NumberOfThreads, int, 0, VTK_INT_MAX);
  vtkGetMacro(NumberOfThreads, int);
  ///@}

  /**
   * The Delta that 0 means for the present input: twice the edge of a cube (in 4D, of a hypercube) that
   * is as large as a voxel. Known once the filter or UpdateInformation() has executed, if the input says its
   * spacing by then; otherwise 0.
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
   * - Global: it waits in one list for all, until a thread that makes progress wakes it.
   * - Local: it waits in the list of the thread that held the vertex, until that one makes progress.
   *
   * Global and local cannot livelock. Aggressive and random can; when no thread makes progress any
   * more the local manager takes over and the filter warns of it
   * (vtkMeshingStatistics::GetSwitchedToLocal()). The values are those of ContentionManagers, others
   * are clamped to them.
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
   * From whom a refinement thread without work gets some (thesis, sections 3.2.4 and 3.4.1).
   * Default hierarchical.
   * - Random work stealing (RWS): from whichever thread looks first, wherever it runs.
   * - Hierarchical work stealing (HWS): from one of its socket before one of its NUMA node before
   *   the rest of the machine, so that less work travels far. On a machine with one socket there is
   *   little difference.
   *
   * The values are those of LoadBalancers, others are clamped to them.
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
   * Keep each refinement thread on a core of its own, where the system allows it. Default off. Leave
   * it off where other programs, or other instances of this filter, share the cores. The thread that
   * called Update() is never pinned.
   */
  vtkSetMacro(PinThreads, bool);
  vtkGetMacro(PinThreads, bool);
  vtkBooleanMacro(PinThreads, bool);
  ///@}

  ///@{
  /**
   * Go on although the mesh is estimated not to fit in memory, the labels look like grey values (many, and most
   * neighbouring voxels differ), or RadiusEdgeRatio is below the proved bound. Default off.
   */
  vtkSetMacro(Force, bool);
  vtkGetMacro(Force, bool);
  vtkBooleanMacro(Force, bool);
  ///@}

  ///@{
  /**
   * Bytes that meshing may plan with; a mesh estimated to need more is refused unless Force is on.
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

  /** What the last execution did. Owned by the filter; the same object over its whole life. */
  vtkMeshingStatistics* GetStatistics() const;

  /** Why the last execution failed; empty if it did not. */
  const std::string& GetErrorMessage() const
  {
    return this->ErrorMessage;
  }

  /** Whether the last execution was stopped by AbortExecute. */
  bool GetAborted() const
  {
    return this->Aborted;
  }

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
   * The parts of an execution that are the subclass's. They throw voxplex::Error for what the user
   * can mend, std::bad_alloc, and what the size function throws. CheckParameters() comes first.
   * Gather() takes what the pipeline has brought; false asks for another pass of the pipeline
   * (vtkStreamingDemandDrivenPipeline::CONTINUE_EXECUTING, which is set in the request of each pass
   * but the first). Mesh() fills the outputs, unless it is
   * stopped.
   */
  virtual void CheckParameters() const;
  virtual bool Gather(vtkInformation* request, vtkInformationVector** inputVector);
  virtual void Mesh(vtkInformationVector** inputVector, vtkInformationVector* outputVector) = 0;
  ///@}

  /**
   * The default Delta for images as the pipeline describes them. It is called by RequestInformation();
   * 0 if it is not known.
   */
  virtual double FindDefaultDelta(vtkInformationVector** inputVector) = 0;

  /** Whether a stop was asked for; GetAborted() then stays true. */
  bool StopRequested();

  /** The number of threads that NumberOfThreads means now. */
  unsigned GetThreads() const;

  /** What the subclasses share of an execution in D dimensions (Private/SimplexMeshRun.h). */
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
  double SmoothingSigma = 1.0;
  double ElementSize = 0.0;
  double Gradation = 0.3;
  int NumberOfThreads = 0;
  int ContentionManager = CONTENTION_LOCAL;
  int LoadBalancer = HIERARCHICAL_WORK_STEALING;
  bool PinThreads = false;
  bool Force = false;
  vtkTypeUInt64 MemoryLimit = 0;
  bool ComputeQuality = false;

private:
  vtkImageToSimplexMeshFilter(const vtkImageToSimplexMeshFilter&) = delete;
  void operator=(const vtkImageToSimplexMeshFilter&) = delete;

  void WarnOfDeviations();

  std::string ErrorMessage;
  bool Aborted = false;
};

#endif
