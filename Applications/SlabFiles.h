// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SlabFiles.h
 * @brief What --slabs writes: each slab of a space-time mesh alone.
 */
#ifndef voxplex_cli_SlabFiles_h
#define voxplex_cli_SlabFiles_h

#include <vtkSmartPointer.h>

#include <string>
#include <vector>

class vtkUnstructuredGrid;

namespace voxplex::cli
{

/** PREFIX0.vtu, PREFIX1.vtu, ..., one for each slab of a mesh that conforms to time planes. */
std::vector<std::string> NamesOfSlabs(const std::string& prefix, vtkUnstructuredGrid* mesh);

/**
 * The pentatopes of a slab, and the points that they use, with all point and cell arrays. The point
 * array GlobalIds (vtkIdTypeArray, the attribute global ids) has the point's index in the whole mesh: two slabs
 * have the same vertex on their plane where the ids are equal. The field data array SlabTimes has the first and
 * the last time of the slab's points. Points and cells keep their order.
 */
vtkSmartPointer<vtkUnstructuredGrid> SlabOf(vtkUnstructuredGrid* mesh, int slab);

} // namespace voxplex::cli

#endif
