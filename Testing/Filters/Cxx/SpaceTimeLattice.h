// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SpaceTimeLattice.h
 * @brief A pentatope mesh whose slices are known, and checks of these.
 */
#ifndef SpaceTimeLattice_h
#define SpaceTimeLattice_h

#include "vtkSmartPointer.h"

#include <map>

class vtkAlgorithm;
class vtkPentatopeMeshTimeSlice;
class vtkUnstructuredGrid;

namespace testing
{

/**
 * A pentatope grid: the box [0, 2]^3 from time 0 to time 2 in Kuhn's subdivision of unit cubes; cell array
 * `Label`, 1 where x < 1, else 2; point arrays `Time`, `Field` (see Linear()) and `PointIds`; field array
 * `SPACE`.
 */
vtkSmartPointer<vtkUnstructuredGrid> MakePentatopes();

/** Its boundary tetrahedra, those between the labels too; cell array `Labels`. */
vtkSmartPointer<vtkUnstructuredGrid> MakeBoundaryTetrahedra();

/** A field that is linear in space and time. */
double Linear(double x, double y, double z, double t);

/**
 * Sums over 3D cells by label (0 if there is no array `Label`), as VTK triangulates them; checks that each
 * piece is positive.
 */
std::map<int, double> Volumes(vtkUnstructuredGrid* slice);

bool Near(double a, double b);

/** The output's `DATA_TIME_STEP`, NaN without one. */
double DataTime(vtkAlgorithm* filter);

/** Checks that this is a slice of MakePentatopes() at this time. */
void CheckSlice(vtkPentatopeMeshTimeSlice* filter, double time);

} // namespace testing

#endif
