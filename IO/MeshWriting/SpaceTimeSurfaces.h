// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SpaceTimeSurfaces.h
 * @brief Numbers and names of the surfaces that bound pentatopes.
 */
#ifndef voxplex_io_SpaceTimeSurfaces_h
#define voxplex_io_SpaceTimeSurfaces_h

#include <vtkSmartPointer.h>

class vtkUnstructuredGrid;

namespace voxplex::io
{

/**
 * A copy of a boundary grid that shares its arrays, with
 * - a cell array `Surface` (vtkTypeInt64Array): a number for the pair of labels and the side. The
 *   numbers are those of NumberSidedPairs(), which .mfem and .mesh files have;
 * - in the field data `SurfaceNumbers` (vtkTypeInt64Array), increasing, and `SurfaceNames`
 *   (vtkStringArray): names as SetNames makes them, `Blood__Muscle`; those of flat ends are
 *   `Blood__background__initial` and `Blood__background__final`.
 *
 * A grid without the cell array `Labels` is returned as it is. Labels may have 64 bits.
 */
vtkSmartPointer<vtkUnstructuredGrid> WithSurfaces(vtkUnstructuredGrid* boundary);

} // namespace voxplex::io

#endif
