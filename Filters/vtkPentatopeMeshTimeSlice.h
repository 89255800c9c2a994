// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkPentatopeMeshTimeSlice
 * @brief   the exact cut of a pentatope mesh at the requested time
 *
 * A mesh of space-time becomes a mesh of space that moves: at any time, not only at those of the frames
 * that it was made from, and conforming at each. Tetrahedra of the boundary become its polygons.
 *
 * @par Input
 * vtkUnstructuredGrid with any of these cells:
 * - pentatopes (4-simplices): `VTK_POLY_VERTEX` of 5 points, as VTK has no cell for them;
 * - tetrahedra of space-time: `VTK_TETRA`.
 *
 * The points are (x, y, z); the point array `Time` (see SetTimeArrayName(); 1 component, any numeric
 * type, finite) has their time. Outputs 0 and 1 of vtkImageToPentatopeMeshFilter are such grids. Points in
 * double precision, a vtkDoubleArray of times and cells with 64-bit ids are read in place.
 *
 * @par Output
 * vtkUnstructuredGrid, points in double precision. A pentatope becomes a `VTK_TETRA` or a `VTK_WEDGE`
 * or, where one of its points lies at the time, a `VTK_PYRAMID`; a tetrahedron becomes a `VTK_TRIANGLE` or
 * a `VTK_QUAD`. All faces are plane.
 * - Conforming: each point occurs once, and cells share whole faces.
 * - Pentatopes with det(p_i - p_0, t_i - t_0; i = 1 ... 4) > 0 become cells of positive volume in VTK's
 *   order of points. The right-hand normals of polygons point out of the region of the first label
 *   of `Labels`, if the tetrahedra are those of vtkImageToPentatopeMeshFilter.
 * - Cells are in the order of the input's, of which each makes one or none. Their data is copied
 *   (`Label`, `Labels`).
 * - Point data is interpolated linearly along the edges of the input. The array of times, which is the
 *   same everywhere, `PointIds` and arrays of type vtkIdTypeArray, which are about other points, are left
 *   out.
 * - Field data is passed. `DATA_TIME_STEP` in the output's information is the time of the slice.
 *
 * @par Times with points
 * At the first time of the mesh the slice is the limit of those after it, at all others the limit of
 * those before. The first and the last slice are thus the flat ends of the mesh, and nothing is cut
 * twice. Times within a few roundings of each other count as one; voxplex::TimeSlicer has the details.
 *
 * @par Time in the pipeline
 * The output can be asked for any time: the filter announces `TIME_RANGE`, the first and the last time of
 * the mesh, and no `TIME_STEPS`. ParaView's slider plays it. The time of the slice is `UPDATE_TIME_STEP` if
 * there is such a request, else SliceTime if it is set, else the start of the range. Times outside the
 * range are moved to its nearer end, as VTK's readers do.
 *
 * The range must be known before the mesh is. A filter upstream announces it as MESH_TIME_RANGE(),
 * which vtkImageToPentatopeMeshFilter does before it meshes. Otherwise, after a file reader for
 * example, the mesh is brought up to date already when information is asked for, and its times are
 * looked at. What the input says of `TIME_RANGE` and `TIME_STEPS` does not matter: they are the times
 * that it can be asked for, not those that the mesh spans.
 *
 * Requests for a time end here. The input is asked for the mesh without any, so it does not execute
 * again when the slider moves.
 *
 * @par Errors
 * Misuse is reported with vtkErrorMacro and leaves the output empty; GetErrorMessage() keeps the reason:
 * no array of times, or one with several components, or with values that are not finite; cells of other
 * types. No cells at all are no error.
 *
 * @par Progress and abort
 * Setting AbortExecute from a progress observer stops between the steps (preparation, cut, output), each
 * of which takes less than about a second for a million pentatopes, and leaves the output empty. VTK
 * regards this as up to date: call Modified() to execute again.
 *
 * @par Complexity
 * The first slice of a mesh with n cells sorts these by time, O(n log n), and keeps 32 bytes for each,
 * and the input's arrays, until the input changes. After that a slice costs O(k log n) for k cells that
 * it cuts.
 *
 * @par Pieces
 * Requests for pieces are passed on, and each piece is cut as if it were the mesh. Two pieces thus have
 * the points of their common faces each for itself.
 *
 * Events are sent from the thread that called Update(). Distinct instances may execute at the same time.
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
  static vtkPentatopeMeshTimeSlice* New();
  vtkTypeMacro(vtkPentatopeMeshTimeSlice, vtkUnstructuredGridAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The time to cut at if none is requested through the pipeline, in the mesh's unit of time. NaN,
   * the default, means the start of the range.
   */
  void SetSliceTime(double time);
  vtkGetMacro(SliceTime, double);
  ///@}

  ///@{
  /** The name of the point array with the times. Default "Time". */
  void SetTimeArrayName(const std::string& name);
  const std::string& GetTimeArrayName() const { return this->TimeArrayName; }
  ///@}

  /** Why the last execution failed; empty if it did not. */
  const std::string& GetErrorMessage() const { return this->ErrorMessage; }

  /**
   * The first and the last time of the pentatope mesh on an output port, which the port's algorithm
   * sets when it is asked for information. It says nothing of the times that the port can be asked for.
   */
  static vtkInformationDoubleVectorKey* MESH_TIME_RANGE();

  /** Keeps requests for a time from the input. */
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

  /** Looks at the mesh; false if there is none, or one that cannot be cut. */
  bool FindRange(vtkInformation* inputInformation, double range[2]);
  void Cut(
    vtkUnstructuredGrid* mesh, vtkInformation* outputInformation, vtkUnstructuredGrid* output);
  double ChooseTime(vtkInformation* outputInformation) const;
  bool AbortRequested();

  std::string ErrorMessage;

  struct Internals;
  std::unique_ptr<Internals> Private;
};

#endif
