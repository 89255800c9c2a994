// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TimeSlabs.h
 * @brief The slabs between the time planes that a mesh of pentatopes conforms to.
 */
#ifndef voxplex_io_TimeSlabs_h
#define voxplex_io_TimeSlabs_h

#include <vtkSmartPointer.h>
#include <vtkType.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

class vtkUnstructuredGrid;

namespace voxplex::io
{

/** The times of the planes, ascending. Empty if the grid has no array Slab or no TimePlanes. */
std::vector<double> TimePlanesOf(vtkUnstructuredGrid* pentatopes);

/**
 * The pentatopes of a slab, and the points that they use, with all point and cell arrays. The point
 * array GlobalIds (vtkIdTypeArray, the attribute global ids) has the point's index in the whole mesh: two slabs
 * have the same vertex on their plane where the ids are equal. The field data array SlabTimes has the first and
 * the last time of the slab's points. Points and cells keep their order.
 */
vtkSmartPointer<vtkUnstructuredGrid> ExtractSlab(vtkUnstructuredGrid* pentatopes, int slab);

/** A facet with all four vertices on a time plane, inside of a label. */
struct PlaneFacet
{
  std::array<vtkIdType, 4> Vertices;
  int Plane; ///< 1 is between slab 0 and slab 1
  std::int64_t Label;
};

/**
 * The facets on time planes, each once, in the order of the pentatopes.
 *
 * @param others facets of interfaces, which are left out; vertices are points of the pentatopes
 * @throws FileError if a label does not fit into 31 bits
 */
std::vector<PlaneFacet> FindPlaneFacets(
  vtkUnstructuredGrid* pentatopes, std::span<const std::array<vtkIdType, 4>> others);

} // namespace voxplex::io

#endif
