// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSimplexMeshInterfaces
 * @brief   makes the interfaces of a labelled mesh, and puts the mesh right, which any program may have made
 *
 * @par Input
 * vtkUnstructuredGrid of tetrahedra, or of pentatopes (`VTK_POLY_VERTEX` of 5 points, with the point
 * array `Time`), with the cell array `Label` (another one: SetInputArrayToProcess()).
 *
 * @par Output
 * - Port 0: the mesh. Inverted elements are turned round: their last two points change places. Points
 *   that no element uses are left out. All else stays as it is.
 * - Port 1: the interfaces of tetrahedra, a vtkPolyData as output 1 of vtkImageToTetMeshFilter.
 * - Port 2: those of pentatopes, a vtkUnstructuredGrid as output 1 of vtkImageToPentatopeMeshFilter.
 *
 * Interfaces are the faces between different labels, and those of one element only. Their order is
 * another one than the meshing filters'.
 *
 * @par Errors
 * Misuse is reported with vtkErrorMacro and leaves the outputs empty; GetErrorMessage() keeps the
 * reason: other cells, no labels or labels that are not whole numbers above 0, hidden cells
 * (`vtkGhostType`), elements without volume, and elements with the points of another one.
 *
 * Takes O(n log n) time. Distinct instances may execute at the same time.
 */
#ifndef vtkSimplexMeshInterfaces_h
#define vtkSimplexMeshInterfaces_h

#include "vtkUnstructuredGridAlgorithm.h"
#include "vtkVoxplexModule.h" // For export macro

#include <string> // For std::string

class VTKVOXPLEX_EXPORT vtkSimplexMeshInterfaces : public vtkUnstructuredGridAlgorithm
{
public:
  ///@{
  /** Construction, type information and printing, as in all VTK classes. */
  static vtkSimplexMeshInterfaces* New();
  vtkTypeMacro(vtkSimplexMeshInterfaces, vtkUnstructuredGridAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;
  ///@}

  ///@{
  /** What the last execution changed: inverted elements, and whether there were unused points. */
  vtkGetMacro(NumberOfTurnedElements, vtkIdType);
  vtkGetMacro(Changed, bool);
  ///@}

  /** The reason why the last execution failed; empty if it did not. */
  const std::string& GetErrorMessage() const { return this->ErrorMessage; }

protected:
  vtkSimplexMeshInterfaces();
  ~vtkSimplexMeshInterfaces() override = default;

  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

private:
  vtkSimplexMeshInterfaces(const vtkSimplexMeshInterfaces&) = delete;
  void operator=(const vtkSimplexMeshInterfaces&) = delete;

  template <int D>
  void Fill(vtkInformationVector** inputVector, vtkInformationVector* outputVector);

  vtkIdType NumberOfTurnedElements = 0;
  bool Changed = false;
  std::string ErrorMessage;
};

#endif
