// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LabelledMesh.h
 * @brief Labelled tetrahedra and pentatopes of a vtkUnstructuredGrid as the kernel's meshes.
 */
#ifndef voxplex_LabelledMesh_h
#define voxplex_LabelledMesh_h

#include "Mesh/SimplexMesh.h"

#include "vtkType.h"

#include <string>

class vtkAbstractArray;
class vtkUnstructuredGrid;

namespace voxplex
{

/** Whether the first cell is a pentatope: a VTK_POLY_VERTEX of five points. */
bool HasPentatopes(vtkUnstructuredGrid* grid);

/** What messages call a cell: "vtkHexahedron of 8 points". */
std::string CellText(vtkUnstructuredGrid* grid, vtkIdType cell);

/**
 * The tetrahedra, as they lie.
 * @param labels the chosen array of labels, may be null
 * @throws InputError if it is no mesh of labelled tetrahedra, or if a point is not finite
 */
SimplexMesh<3> ReadTetrahedra(vtkUnstructuredGrid* grid, vtkAbstractArray* labels);

/**
 * The pentatopes in the world; the fourth coordinate is the point array `Time`, multiplied.
 * @param labels the chosen array of labels, may be null
 * @throws InputError if it is no mesh of labelled pentatopes, or if a point or a time is not finite
 */
SimplexMesh<4> ReadPentatopes(
  vtkUnstructuredGrid* grid, vtkAbstractArray* labels, double timeScale);

} // namespace voxplex

#endif
