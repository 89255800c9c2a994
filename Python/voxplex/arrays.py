# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""What meshes and interfaces consist of, as NumPy arrays that share VTK's memory.

The arrays keep VTK's memory alive, so they may outlive the mesh. Writing into them changes the mesh;
call `Modified()` on it afterwards. A VTK method that makes an array of the mesh longer or shorter may
move its memory: take the NumPy array again after that.
"""

from __future__ import annotations

from typing import Any

import numpy
from numpy.typing import NDArray
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import (
    VTK_POLY_VERTEX, VTK_TETRA, vtkCellArray, vtkDataSet, vtkPointSet, vtkPolyData,
    vtkUnstructuredGrid)


def points(mesh: vtkPointSet) -> NDArray[numpy.float64]:
    """The coordinates of the points of a mesh or of interfaces, shape (number of points, 3).

    Shares the mesh's memory.

    >>> import numpy, voxplex
    >>> labels = numpy.zeros((12, 12, 12), dtype=numpy.uint8)
    >>> labels[3:9, 3:9, 3:9] = 1
    >>> mesh = voxplex.mesh(labels, delta=2)
    >>> corners = voxplex.points(mesh)[voxplex.tets(mesh)]
    >>> corners.shape[1:]
    (4, 3)
    >>> a, b, c = (corners[:, i] - corners[:, 0] for i in (1, 2, 3))
    >>> volumes = numpy.einsum("ij,ij->i", numpy.cross(a, b), c) / 6
    >>> bool((volumes > 0).all())
    True
    """
    data = mesh.GetPoints()
    if data is None:
        return numpy.empty((0, 3))
    return vtk_to_numpy(data.GetData())


def tets(mesh: vtkUnstructuredGrid) -> NDArray[numpy.int64]:
    """The four points of each tetrahedron, shape (number of tetrahedra, 4).

    Their order is VTK's: volumes are positive. Also for the boundary of a mesh of pentatopes. Shares
    the mesh's memory. Raises ValueError if the mesh has cells of other types.
    """
    return _cells(mesh, VTK_TETRA, 4, "tetrahedra")


def pentatopes(mesh: vtkUnstructuredGrid) -> NDArray[numpy.int64]:
    """The five points of each pentatope, shape (number of pentatopes, 5).

    Shares the mesh's memory. Raises ValueError if the mesh has other cells than pentatopes, which are
    VTK_POLY_VERTEX cells of five points.
    """
    return _cells(mesh, VTK_POLY_VERTEX, 5, "pentatopes")


def triangles(interfaces: vtkPolyData) -> NDArray[numpy.int64]:
    """The three points of each triangle of the interfaces, shape (number of triangles, 3).

    Indices are those of points(interfaces). Shares the memory of the interfaces. Raises ValueError if
    they have cells of other types.
    """
    others = interfaces.GetNumberOfCells() - interfaces.GetNumberOfPolys()
    if others:
        raise ValueError(f"{others} of {interfaces.GetNumberOfCells()} cells are no triangles")
    return _connectivity(interfaces.GetPolys(), 3, "triangles")


def labels(mesh: vtkDataSet) -> NDArray[Any]:
    """The labels of a mesh: shape (number of cells,), int32, or int64 if a label needs it.

    Of interfaces (and of the boundary of pentatopes): the labels on both sides, the larger first, 0 for
    background; shape (number of cells, 2). Shares the mesh's memory. Raises ValueError if there are
    neither.
    """
    data = mesh.GetCellData()
    for name in ("Label", "Labels"):
        array = data.GetArray(name)
        if array is not None:
            return vtk_to_numpy(array)
    raise ValueError("the mesh has no cell array Label or Labels")


def point_ids(interfaces: vtkPointSet) -> NDArray[numpy.int64]:
    """For each point of the interfaces its index in the mesh, shape (number of points,). Shares memory.

    `point_ids(interfaces)[triangles(interfaces)]` are triangles of the mesh's own points.
    """
    return _point_array(interfaces, "PointIds")


def times(mesh: vtkPointSet) -> NDArray[numpy.float64]:
    """The time of each point of a mesh of pentatopes, shape (number of points,). Shares its memory."""
    return _point_array(mesh, "Time")


def _point_array(mesh: vtkPointSet, name: str) -> NDArray[Any]:
    array = mesh.GetPointData().GetArray(name)
    if array is None:
        raise ValueError(f"the mesh has no point array {name}")
    return vtk_to_numpy(array)


def _cells(mesh: vtkUnstructuredGrid, cell_type: int, size: int, what: str) -> NDArray[numpy.int64]:
    if mesh.GetNumberOfCells() == 0:
        return numpy.empty((0, size), dtype=numpy.int64)
    if not mesh.IsHomogeneous() or mesh.GetCellType(0) != cell_type:
        count = mesh.GetNumberOfCells()
        others = sum(mesh.GetCellType(cell) != cell_type for cell in range(count))
        raise ValueError(f"{others} of {count} cells are no {what}")
    return _connectivity(mesh.GetCells(), size, what)


def _connectivity(cells: vtkCellArray, size: int, what: str) -> NDArray[numpy.int64]:
    if cells.GetNumberOfCells() == 0:
        return numpy.empty((0, size), dtype=numpy.int64)
    if cells.IsHomogeneous() != size:
        raise ValueError(f"not all cells are {what}: they have other numbers of points than {size}")
    return vtk_to_numpy(cells.GetConnectivityArray()).reshape(-1, size)
