// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshChecks.h
 * @brief Whether a mesh is one that the rest of the code can rely on. It may come from a damaged file.
 */
#ifndef voxplex_io_MeshChecks_h
#define voxplex_io_MeshChecks_h

#include <string>

#include <vtkType.h>

class vtkCellArray;
class vtkDataArray;
class vtkDataSet;
class vtkDataSetAttributes;
class vtkPointSet;
class vtkPolyData;
class vtkUnstructuredGrid;

namespace voxplex::io
{

// All throw FileError.

/**
 * An array with one value for each cell or point.
 *
 * @param count how many cells or points there are
 * @param what begins the message: "the mesh has"
 * @param advice ends it
 */
vtkDataArray* CheckArray(vtkDataSetAttributes* attributes, const char* name, int components,
  vtkIdType count, const std::string& what, const std::string& advice);

/** Offsets and ids that a damaged file may have left anyhow. */
void CheckVertices(vtkCellArray* cells, vtkPointSet* owner);

/** All cells have this type, this number of vertices, and vertices that are points. */
void CheckCells(vtkUnstructuredGrid* grid, int type, vtkIdType size, const std::string& what,
  const std::string& advice);

/** @param message if there is a cell that is no triangle */
void CheckTriangles(vtkPolyData* surface, const std::string& message);

/** Whether all numbers, which may be none, are ids of points. */
bool ArePoints(vtkDataArray* ids, vtkIdType numberOfPoints);

/** The array PointIds of interfaces, which must have it. */
void CheckPointIds(vtkDataSet* interfaces, vtkIdType numberOfPoints);

} // namespace voxplex::io

#endif
