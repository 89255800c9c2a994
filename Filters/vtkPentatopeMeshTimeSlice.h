// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkPentatopeMeshTimeSlice
 * @brief   the exact cut of a pentatope mesh at the requested time
 *
 * The filter turns a mesh of space-time into a moving mesh of space. A slice can be cut at any
 * time, not only at the times of the frames that the mesh was made from, and each slice is
 * conforming. Boundary tetrahedra become triangles.
 *
 * @par Input
 * vtkUnstructuredGrid with any of these cells:
 * - pentatopes (4-simplices): `VTK_POLY_VERTEX` of 5 points, as VTK has no cell for them;
 * - tetrahedra of space-time: `VTK_TETRA`.
 *
 * The points are (x, y, z). The point array `Time` (see SetTimeArrayName(); 1 component, any
 * numeric type, finite) has the time of each point. Outputs 0 and 1 of
 * vtkImageToPentatopeMeshFilter are such grids. Points in double precision, a vtkDoubleArray of
 * times and cells with 64-bit ids are read in place.
 *
 * @par Output
 * vtkUnstructuredGrid, points in double precision. A pentatope becomes one to three `VTK_TETRA`, a
 * tetrahedron one or two `VTK_TRIANGLE`; none if only its corners or faces lie at the time.
 * - Conforming: each point occurs once, and cells share whole faces. The triangles of a boundary
 *   by vtkImageToPentatopeMeshFilter are faces of the tetrahedra of its mesh.
 * - Pentatopes with det(p_i - p_0, t_i - t_0; i = 1 ... 4) > 0 become tetrahedra of positive
 *   volume. If the input's tetrahedra are those of vtkImageToPentatopeMeshFilter, the right-hand
 *   normals of triangles point out of the region of the first label of `Labels`.
 * - Cells are in the order of those of the input that they are cut from, whose cell data they get
 *   (`Label`, `Labels`).
 * - Point data is interpolated linearly along the edges of the input. Three kinds of arrays are
 *   left out: the array of times, which is constant in a slice; `PointIds`; and arrays of type
 *   vtkIdTypeArray, as their ids refer to other points.
 * - Field data is passed. `DATA_TIME_STEP` in the output's information is the time of the slice.
 *
 * @par Times of the mesh's points
 * At the first time of the mesh, the slice is the limit of the slices after it. At all other times
 * it is the limit of the slices before. So the first and the last slice are the flat ends of the
 * mesh, and nothing is cut twice. Times that differ by a few rounding errors count as one;
 * voxplex::TimeSlicer has the details.
 *
 * @par Time in the pipeline
 * The output can be requested for any time. The filter announces `TIME_RANGE`, the first and the
 * last time of the mesh, and no `TIME_STEPS`, so ParaView's time slider can play it. The time of
 * the slice is `UPDATE_TIME_STEP` if a time is requested, else SliceTime if it is set, else the
 * start of the range. A time outside of the range is moved to the nearer end, as VTK's readers do.
 *
 * The filter needs the range before the mesh exists. An upstream filter can announce it as
 * MESH_TIME_RANGE(); vtkImageToPentatopeMeshFilter does so before it meshes. Otherwise, for example
 * after a file reader, RequestInformation updates the mesh and reads its times. The input's
 * `TIME_RANGE` and `TIME_STEPS` are ignored: they are the times that can be requested from the
 * input, not the times that the mesh spans.
 *
 * A request for a time is not passed upstream. The input does not execute again when the slider
 * moves.
 *
 * @par Errors
 * Misuse is reported with vtkErrorMacro and leaves the output empty; GetErrorMessage() keeps the
 * reason. Errors are: no array of times, an array with several components or with values that are
 * not finite, and cells of other types. An input without cells is no error.
 *
 * @par Progress and abort
 * If a progress observer sets AbortExecute, the filter stops after the current step (preparation,
 * cut, output) and leaves the output empty. Each step takes less than about a second for a million
 * pentatopes. VTK regards the empty output as up to date: call Modified() to execute again.
 *
 * @par Complexity
 * The first slice of a mesh with n cells sorts the cells by time in O(n log n). It keeps 32 bytes
 * for each cell, and the input's arrays, until the input changes. Each further slice costs O(k log
 * n) for k cells that it cuts.
 *
 * @par Pieces
 * Requests for pieces are passed upstream, and each piece is cut as if it were the whole mesh. So
 * the points of a face that two pieces share occur in both pieces.
 *
 * Events are sent from the thread that called Update(). Distinct instances may execute at the same
 * time.
 */
#ifndef vtkPentatopeMeshTimeSlice_h
#define vtkPentatopeMeshTimeSlice_h

#include "vtkUnstructuredGridAlgorithm.h"
#include "vtkVoxplexModule.h" // For export macro

#include <memory> // For std::unique_ptr
#include <string> // For std::string

class vtkInformationDoubleVectorKey;

class VTKVOXPLEX_EXPORT vtkPentatopeMeshTimeSlice : public vtkUnstructuredGridAlgorithm
{
public:
  ///@{
  /** Construction, type information and printing, as in all VTK classes. */
  static vtkPentatopeMeshTimeSlice* New();
  vtkTypeMacro(vtkPentatopeMeshTimeSlice, vtkUnstructuredGridAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;
  ///@}

  ///@{
  /**
   * The time of the slice if none is requested through the pipeline, in the mesh's unit of time.
   * NaN, the default, means the start of the range.
   */
  void SetSliceTime(double time);
  vtkGetMacro(SliceTime, double);
  ///@}

  ///@{
  /** The name of the point array with the times. Default "Time". */
  void SetTimeArrayName(const std::string& name);
  const std::string& GetTimeArrayName() const { return this->TimeArrayName; }
  ///@}

  /** The reason why the last execution failed; empty if it did not. */
  const std::string& GetErrorMessage() const { return this->ErrorMessage; }

  /**
   * The first and the last time of the pentatope mesh on an output port. The port's algorithm sets
   * this key in RequestInformation. It does not tell which times can be requested from the port.
   */
  static vtkInformationDoubleVectorKey* MESH_TIME_RANGE();

  /** Keeps requests for a time from going upstream. */
  vtkTypeBool ProcessRequest(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

protected:
  vtkPentatopeMeshTimeSlice();
  ~vtkPentatopeMeshTimeSlice() override;

  int RequestInformation(vtkInformation*, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int RequestData(vtkInformation*, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

  double SliceTime;
  std::string TimeArrayName = "Time";

private:
  vtkPentatopeMeshTimeSlice(const vtkPentatopeMeshTimeSlice&) = delete;
  void operator=(const vtkPentatopeMeshTimeSlice&) = delete;

  /** Finds the time range of the mesh; false if there is no mesh or it cannot be cut. */
  bool FindRange(vtkInformation* inputInformation, double range[2]);
  void Cut(
    vtkUnstructuredGrid* mesh, vtkInformation* outputInformation, vtkUnstructuredGrid* output);
  double ChooseTime(vtkInformation* outputInformation) const;

  std::string ErrorMessage;

  struct Internals;
  std::unique_ptr<Internals> Private;
};

#endif
