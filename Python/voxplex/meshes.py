# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Meshes and their interfaces as NumPy arrays."""

from __future__ import annotations

from typing import Any, Dict, Optional, Tuple

import numpy
from numpy.typing import NDArray

from .fields import HasFields
from .images import Path
from .xmlfiles import Arrays


class _Simplices(Arrays, HasFields):
    """Points, cells and data; `field_data` has the names of labels and other things that are of no point or cell."""

    _corners: Tuple[int, ...] = ()

    def to_vtk(self) -> Any:
        """A vtkUnstructuredGrid, of triangles a vtkPolyData, which shares the arrays' memory.

        Needs VTK (pip install vtk). Pentatopes are VTK_POLY_VERTEX cells of five points.
        """
        from .vtkdata import mesh_to_vtk
        return mesh_to_vtk(self)

    def to_pyvista(self) -> Any:
        """A pyvista.UnstructuredGrid, of triangles a pyvista.PolyData. Needs PyVista (pip install pyvista)."""
        import pyvista
        return pyvista.wrap(self.to_vtk())

    def plot(self, **arguments: Any) -> Any:
        """Shows it in a window or a notebook, coloured by label. Needs PyVista, whose plot() takes the arguments."""
        shown = self.to_pyvista()
        arguments.setdefault("scalars", next((name for name in ("Label", "Labels") if name in self.cell_data), None))
        arguments.setdefault("show_edges", True)
        return shown.plot(**arguments)

    @classmethod
    def from_vtk(cls, data: Any) -> Any:
        """Of a vtkUnstructuredGrid or a vtkPolyData, sharing its memory: writing into the arrays changes it.

        Raises ValueError if the cells are not all of one kind, or not of this one.
        """
        from .vtkdata import mesh_from_vtk
        arrays = mesh_from_vtk(data)
        if arrays.cells.shape[1] not in cls._corners:
            raise ValueError(f"the cells have {arrays.cells.shape[1]} corners, those of a voxplex.{cls.__name__} "
                             + " or ".join(map(str, cls._corners)))
        result = cls.__new__(cls)
        result.__dict__.update(arrays.__dict__)
        return result

    @property
    def times(self) -> NDArray[numpy.float64]:
        """The time of each point, if the mesh is one of space and time; shape (number of points,)."""
        return self._array(self.point_data, "point", "Time")

    def _array(self, data: Dict[str, NDArray[Any]], where: str, name: str) -> NDArray[Any]:
        if name not in data:
            raise ValueError(f"there is no {where} array {name}")
        return data[name]


class Interfaces(_Simplices):
    """Triangles between tissues; of a mesh of pentatopes the tetrahedra of its boundary.

    points: shape (number of points, 3), float64.
    cells: the points of each triangle or tetrahedron, shape (number of cells, 3 or 4).
    """

    _corners = (3, 4)

    def __repr__(self) -> str:
        return f"{len(self.cells)} {'triangles' if self.cells.shape[1] == 3 else 'tetrahedra'} of interfaces"

    @property
    def labels(self) -> NDArray[Any]:
        """The labels on both sides, the larger first, 0 for background; shape (number of cells, 2)."""
        return self._array(self.cell_data, "cell", "Labels")

    @property
    def point_ids(self) -> NDArray[numpy.int64]:
        """For each point its index in the mesh: point_ids[cells] are triangles of the mesh's own points."""
        return self._array(self.point_data, "point", "PointIds")


class Mesh(_Simplices):
    """Labelled tetrahedra, or pentatopes of space and time.

    points: shape (number of points, 3), float64.
    cells: the points of each element, shape (number of elements, 4 or 5), in VTK's order: volumes are positive.
    point_data, cell_data, field_data: further arrays, by name.
    statistics: what `voxplex --stats` writes, without what is about files.
    """

    _interfaces: Optional[Interfaces] = None
    statistics: Dict[str, Any] = {}
    _corners = (4, 5)

    def __repr__(self) -> str:
        return f"Mesh of {len(self.cells)} {'tetrahedra' if self.cells.shape[1] == 4 else 'pentatopes'}"

    @property
    def has_interfaces(self) -> bool:
        """Whether they are known."""
        return self._interfaces is not None

    @property
    def interfaces(self) -> Interfaces:
        """What bounds and separates the tissues. Raises ValueError if it is not known (from_vtk)."""
        if self._interfaces is None:
            raise ValueError("the interfaces of this mesh are not known")
        return self._interfaces

    @interfaces.setter
    def interfaces(self, interfaces: Optional[Interfaces]) -> None:
        self._interfaces = interfaces

    @property
    def labels(self) -> NDArray[Any]:
        """The label of each element, shape (number of elements,); int32, or int64 if a label needs it."""
        return self._array(self.cell_data, "cell", "Label")

    def to_meshio(self) -> Any:
        """A meshio.Mesh of the tetrahedra. Needs meshio (pip install meshio), which has no pentatopes."""
        import meshio
        if self.cells.shape[1] != 4:
            raise ValueError("meshio has no cells for pentatopes")
        return meshio.Mesh(self.points, [("tetra", self.cells)], point_data=dict(self.point_data),
                           cell_data={name: [values] for name, values in self.cell_data.items()})

    def write(self, path: Optional[Path] = None, *, interfaces: Optional[Path] = None,
              slabs: Optional[Path] = None) -> None:
        """Writes files whose extensions choose the format: Documentation/FileFormats.md tells what each holds.

        path: of the mesh. Formats for solvers get the interfaces as named surfaces.
        interfaces: of the interfaces (.vtp, .stl, .ply ...).
        slabs: of a mesh with time planes, the beginning of the names of its slabs, which are files of their own in the
            format of path: slabs0.vtu, slabs1.vtu ...

        Files appear whole or not at all. Raises FileError (an OSError) for an extension that is not known, and for what
        cannot be written.
        """
        from .files import write_mesh
        write_mesh(self, {"output": path, "plc": interfaces, "slabs": slabs})
