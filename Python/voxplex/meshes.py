# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Meshes and their interfaces as NumPy arrays."""

from __future__ import annotations

import math
import os
from dataclasses import dataclass, field
from typing import Any, Dict, List, Mapping, Optional, Sequence, Type, TypeVar, Union

import numpy
from numpy.typing import NDArray

from . import program, xmlfiles
from .errors import FileError, MeshingError
from .fields import Color, Described, Fields, html_table
from .files import Path, existing, in_words, number_list, number_text, temporary_folder

_Kind = TypeVar("_Kind", bound="_Simplices")


@dataclass(eq=False, repr=False)
class _Simplices(Described):
    """Points, cells, and data by name."""

    points: NDArray[Any]
    cells: NDArray[Any]
    point_data: Dict[str, NDArray[Any]] = field(default_factory=dict)
    cell_data: Dict[str, NDArray[Any]] = field(default_factory=dict)
    names: Dict[int, str] = field(default_factory=dict)
    colors: Dict[int, Color] = field(default_factory=dict)
    space: Optional[str] = None
    field_data: Fields = field(default_factory=dict)

    @classmethod
    def _of(cls: Type[_Kind], arrays: xmlfiles.Arrays) -> _Kind:
        result = cls(*arrays[:4])
        result._describe(arrays.field_data)
        return result

    def _arrays(self) -> xmlfiles.Arrays:
        return xmlfiles.Arrays(self.points, self.cells, self.point_data, self.cell_data, self._fields())

    @classmethod
    def from_vtk(cls: Type[_Kind], data: Any) -> _Kind:
        """Of data of VTK or PyVista, sharing their memory: writing into the arrays changes them.

        Parameters
        ----------
        data : vtkUnstructuredGrid or vtkPolyData

        Raises
        ------
        ValueError
            The cells are not all of one kind, or not of this one.
        """
        from .vtkdata import mesh_from_vtk
        arrays = mesh_from_vtk(data)
        corners = (4, 5) if issubclass(cls, Mesh) else (3, 4)
        if arrays.cells.shape[1] not in corners:
            raise ValueError(f"the cells have {arrays.cells.shape[1]} corners, those of a voxplex.{cls.__name__} "
                             + " or ".join(map(str, corners)))
        return cls._of(arrays)

    def to_vtk(self) -> Any:
        """As data of VTK, which share the arrays' memory. Needs VTK (pip install vtk).

        Returns
        -------
        vtkUnstructuredGrid
            Of triangles a vtkPolyData. Pentatopes are VTK_POLY_VERTEX cells of five points.
        """
        from .vtkdata import mesh_to_vtk
        return mesh_to_vtk(self._arrays())

    def to_pyvista(self) -> Any:
        """As data of PyVista, which share the arrays' memory. Needs PyVista (pip install pyvista).

        Returns
        -------
        pyvista.UnstructuredGrid
            Of triangles a pyvista.PolyData.
        """
        import pyvista
        return pyvista.wrap(self.to_vtk())

    @property
    def times(self) -> NDArray[numpy.float64]:
        """The time of each point, if the mesh is one of space and time; shape (number of points,)."""
        return _array(self.point_data, "point", "Time")

    def _plot(self, kinds: NDArray[Any], texts: Sequence[str], colors: Sequence[Optional[Color]],
              cut: Union[str, Sequence[float], None], arguments: Dict[str, Any]) -> Any:
        """Shows categories: a number of a text for each cell."""
        import matplotlib.colors
        shown = self.to_pyvista()
        shown.cell_data["Voxplex"] = kinds
        if cut is not None:
            shown = shown.clip(normal=cut, crinkle=True)
        palette: Any = matplotlib.colormaps["tab20"]
        bar = {"title": "", "n_labels": 0, "vertical": True, **arguments.pop("scalar_bar_args", {})}
        return shown.plot(**{
            "scalars": "Voxplex", "show_edges": True, "clim": (-0.5, len(texts) - 0.5), "n_colors": len(texts), "scalar_bar_args": bar,
            "cmap": matplotlib.colors.ListedColormap([palette.colors[n % palette.N] if color is None else tuple(color)
                                                      for n, color in enumerate(colors)]),
            "annotations": {float(n): text for n, text in enumerate(texts)} if len(texts) <= _MOST_TEXTS else {}, **arguments})


_MOST_TEXTS = 40  # more would cover each other


def _array(data: Mapping[str, NDArray[Any]], where: str, name: str) -> NDArray[Any]:
    if name not in data:
        raise ValueError(f"there is no {where} array {name}")
    return data[name]


@dataclass(eq=False, repr=False)
class Interfaces(_Simplices):
    """Triangles between tissues; of a mesh of pentatopes the tetrahedra of its boundary.

    Parameters
    ----------
    points : (number of points, 3) numpy.ndarray of float64
    cells : (number of cells, 3 or 4) numpy.ndarray of int64
        The points of each triangle or tetrahedron.
    point_data, cell_data : dict of str to numpy.ndarray, optional
        Further arrays: `PointIds` of points; `Labels` of cells, and `Side` of tetrahedra.
    names, colors, space, field_data : optional
        As of :class:`Mesh`.
    """

    def __repr__(self) -> str:
        return f"{len(self.cells)} {'triangles' if self.cells.shape[1] == 3 else 'tetrahedra'} of interfaces"

    @property
    def labels(self) -> NDArray[Any]:
        """The labels on both sides, the larger first, 0 for background; shape (number of cells, 2)."""
        return _array(self.cell_data, "cell", "Labels")

    @property
    def point_ids(self) -> NDArray[numpy.int64]:
        """For each point its index in the mesh: point_ids[cells] are triangles of the mesh's own points."""
        return _array(self.point_data, "point", "PointIds")

    def plot(self, *, cut: Union[str, Sequence[float], None] = None, **arguments: Any) -> Any:
        """Shows them in a window or a notebook, coloured by the labels of both sides. Needs PyVista and Matplotlib.

        Parameters
        ----------
        cut : str or three numbers, optional
            Cuts them open: what lies beyond the middle along this direction ("x", "-x", "y" ...) is left out.
        **arguments
            Those of PyVista's plot().
        """
        pairs, kinds = numpy.unique(self.labels, axis=0, return_inverse=True)
        name = {0: "outside", **self.names}
        texts = [" - ".join(name.get(int(label), str(label)) for label in pair) for pair in pairs]
        return self._plot(kinds.reshape(-1), texts, [self.colors.get(pair[0]) if pair[1] == 0 else None for pair in pairs.tolist()], cut,
                          arguments)

    def write(self, path: Path) -> None:
        """Writes a file whose extension chooses the format.

        Parameters
        ----------
        path : path-like
            .vtp, .vtu, .stl, .ply or .vtk; of tetrahedra .vtu. It appears whole or not at all.

        Raises
        ------
        FileError
            The file cannot be written, or its extension is not known.
        """
        with temporary_folder() as folder:
            _run([*self._options(folder), "--plc=" + os.fsdecode(path)], folder, "path")

    def _options(self, folder: str) -> List[str]:
        file = os.path.join(folder, "interfaces" + (".vtp" if self.cells.shape[1] == 3 else ".vtu"))
        xmlfiles.write(file, self._arrays())
        return ["--interfaces=" + file]


@dataclass(eq=False, repr=False)
class Mesh(_Simplices):
    """Labelled tetrahedra, or pentatopes of space and time.

    Parameters
    ----------
    points : (number of points, 3) numpy.ndarray of float64
    cells : (number of elements, 4 or 5) numpy.ndarray of int64
        The points of each element, in VTK's order: volumes are positive.
    point_data, cell_data : dict of str to numpy.ndarray, optional
        Further arrays: `Label` of cells, and `Time` of points if there are pentatopes.
    names : dict of int to str, optional
        Of labels. Writing into it renames them.
    colors : dict of int to three float, optional
        Red, green and blue of labels with names, from 0 to 1.
    space : {"LPS", "RAS"}, optional
        The coordinates, if they are known.
    field_data : dict of str to numpy.ndarray or list of str, optional
        Arrays of no point or cell.
    statistics : dict, optional
        What `voxplex --stats` writes of the run that made the mesh, without what is about files.
    """

    statistics: Dict[str, Any] = field(default_factory=dict)
    _interfaces: Optional[Interfaces] = field(default=None, init=False)

    def __repr__(self) -> str:
        return f"Mesh of {len(self.cells)} {'tetrahedra' if self.cells.shape[1] == 4 else 'pentatopes'}"

    def _repr_html_(self) -> str:
        counts = dict(zip(*(part.tolist() for part in numpy.unique(self.labels, return_counts=True))))
        rows = [(label, self.names.get(label, ""), counts[label], f"{volume:.6g}") for label, volume in self.label_volumes().items()]
        return html_table(repr(self), ("label", "name", "elements", "volume" if self.cells.shape[1] == 4 else "volume x time"), rows)

    @property
    def interfaces(self) -> Interfaces:
        """What bounds and separates the tissues: of the run that made the mesh, else by the labels of its elements."""
        if self._interfaces is None:
            with temporary_folder() as folder:
                path = os.path.join(folder, "interfaces.vtu")
                program.run(["convert", *self._options(folder), "--uncompressed", "--plc=" + path], words=in_words(folder))
                made = Interfaces._of(xmlfiles.read(path))
            made.point_data["PointIds"] = numpy.unique(self.cells)[made.point_ids]  # the program leaves out points without elements
            made.names, made.colors = self.names, self.colors
            self._interfaces = made
        return self._interfaces

    @interfaces.setter
    def interfaces(self, interfaces: Optional[Interfaces]) -> None:
        self._interfaces = interfaces

    @property
    def labels(self) -> NDArray[Any]:
        """The label of each element, shape (number of elements,); int32, or int64 if a label needs it."""
        return _array(self.cell_data, "cell", "Label")

    @property
    def volumes(self) -> NDArray[numpy.float64]:
        """The volume of each element, of pentatopes in space and time; shape (number of elements,)."""
        corners = (self.points if self.cells.shape[1] == 4 else numpy.column_stack([self.points, self.times]))[self.cells]
        result: NDArray[numpy.float64] = numpy.linalg.det(corners[:, 1:] - corners[:, :1]) / math.factorial(corners.shape[2])
        return result

    def label_volumes(self) -> Dict[int, float]:
        """The volume of each label.

        Returns
        -------
        dict of int to float
            In the order of labels.

        Examples
        --------
        >>> import numpy, voxplex
        >>> mesh = voxplex.mesh(numpy.ones((8, 8, 8), dtype=numpy.uint8), delta=2)
        >>> {label: round(volume) for label, volume in mesh.label_volumes().items()}
        {1: 512}
        """
        labels, which = numpy.unique(self.labels, return_inverse=True)
        return dict(zip(labels.tolist(), numpy.bincount(which, self.volumes, len(labels)).tolist()))

    def slice(self, time: float) -> Mesh:
        """What a mesh of space and time is at one time.

        Parameters
        ----------
        time : float
            From the first to the last of :attr:`times`.

        Returns
        -------
        Mesh
            Tetrahedra, which share faces. Data of points are interpolated.

        Raises
        ------
        ValueError
            The mesh has no times, or they do not reach there.
        """
        first, last = (self.times.min(), self.times.max()) if len(self.times) else (0.0, 0.0)
        if not first <= time <= last:
            raise ValueError(f"time is {number_text(time)}; the mesh is there from {number_text(first)} to {number_text(last)}")
        with temporary_folder() as folder:
            program.run(["convert", *self._options(folder), *number_list("frame-times", [time]), "--uncompressed",
                         "--slices=" + os.path.join(folder, "slice")], words=in_words(folder))
            return Mesh._of(xmlfiles.read(os.path.join(folder, "slice0.vtu")))

    def plot(self, *, cut: Union[str, Sequence[float], None] = None, time: Optional[float] = None, **arguments: Any) -> Any:
        """Shows it in a window or a notebook, coloured by label, with their names. Needs PyVista and Matplotlib.

        Parameters
        ----------
        cut : str or three numbers, optional
            Cuts it open: elements beyond the middle along this direction ("x", "-x", "y" ...) are left out.
        time : float, optional
            When a mesh of space and time is shown. Default: in the middle.
        **arguments
            Those of PyVista's plot().
        """
        if self.cells.shape[1] == 5:
            return self.slice((self.times.min() + self.times.max()) / 2 if time is None else time).plot(cut=cut, **arguments)
        labels, kinds = numpy.unique(self.labels, return_inverse=True)
        texts = [self.names.get(int(label), str(label)) for label in labels]
        return self._plot(kinds, texts, [self.colors.get(label) for label in labels.tolist()], cut, arguments)

    def to_meshio(self) -> Any:
        """As a mesh of meshio. Needs meshio (pip install meshio), which has no pentatopes.

        Returns
        -------
        meshio.Mesh
            Its cell sets have the names of labels, which Abaqus gets; its field data and the array `gmsh:physical` name the
            physical groups of Gmsh, of which meshio writes those of the format gmsh22.
        """
        import meshio
        if self.cells.shape[1] != 4:
            raise ValueError("meshio has no cells for pentatopes")
        cell_data = {name: [values] for name, values in self.cell_data.items()}
        for name in ("gmsh:physical", "gmsh:geometrical") if "Label" in self.cell_data else ():
            cell_data.setdefault(name, [self.labels])
        named = {self.names.get(label, f"label_{label}"): label for label in (numpy.unique(self.labels).tolist() if cell_data else ())}
        return meshio.Mesh(self.points, [("tetra", self.cells)], point_data=dict(self.point_data), cell_data=cell_data,
                           field_data={name: numpy.array([label, 3]) for name, label in named.items()},
                           cell_sets={name: [numpy.flatnonzero(self.labels == label)] for name, label in named.items()})

    def write(self, path: Optional[Path] = None, *, interfaces: Optional[Path] = None,
              slabs: Optional[Path] = None) -> None:
        """Writes files whose extensions choose the format: Documentation/FileFormats.md tells what each holds.

        Files appear whole or not at all.

        Parameters
        ----------
        path : path-like, optional
            Of the mesh. Formats for solvers get the interfaces as named surfaces.
        interfaces : path-like, optional
            Of the interfaces (.vtp, .stl, .ply ...).
        slabs : path-like, optional
            Of a mesh with time planes, the beginning of the names of its slabs, which are files of their own in the format of
            path: slabs0.vtu, slabs1.vtu ...

        Raises
        ------
        FileError
            An extension is not known, or a file cannot be written. It is an OSError.
        """
        outputs = [(option, path) for option, path in (("output", path), ("plc", interfaces), ("slabs", slabs)) if path is not None]
        if not outputs:
            raise TypeError("write() needs a path")
        with temporary_folder() as folder:
            arguments = self._options(folder)
            if self._interfaces is not None:
                known = self._interfaces  # its points are the mesh's own, wherever these are now, and its labels are the mesh's
                arguments += Interfaces(self.points[known.point_ids], known.cells, known.point_data, known.cell_data, self.names,
                                        self.colors, self.space, known.field_data)._options(folder)
            _run([*arguments, *(f"--{option}={os.fsdecode(path)}" for option, path in outputs)], folder, "interfaces")

    def _options(self, folder: str) -> List[str]:
        path = os.path.join(folder, "mesh.vtu")
        xmlfiles.write(path, self._arrays())
        return ["--mesh=" + path]


def _run(arguments: List[str], folder: str, plc: str) -> None:
    """Writes files. plc: what the argument is called that names the file of interfaces."""
    ours = [("plc: ", plc + ": "), ("with plc", "with " + plc), ("output: ", "path: "), ("with output", "with path")]
    try:
        program.run(["convert", *arguments], words=ours + in_words(folder))
    except MeshingError as error:
        raise FileError(str(error)) from None


def read_mesh(path: Path, interfaces: Optional[Path] = None) -> Mesh:
    """Reads a mesh of labelled tetrahedra or pentatopes.

    Parameters
    ----------
    path : path-like
        A .vtu file with the cell array `Label` and, of pentatopes, the point array `Time`, made by Voxplex or another program.
    interfaces : path-like, optional
        A .vtp or .vtu file of its interfaces.

    Returns
    -------
    Mesh
        Without statistics.

    Raises
    ------
    FileNotFoundError
        There is no such file.
    FileError
        A file is no such mesh, or cannot be read. It is an OSError.
    """
    with temporary_folder() as folder:
        arguments = ["--mesh=" + existing(path), "--uncompressed", "--output=" + os.path.join(folder, "mesh.vtu")]
        if interfaces is not None:
            arguments += ["--interfaces=" + existing(interfaces), "--plc=" + os.path.join(folder, "interfaces.vtu")]
        _run(arguments, folder, "interfaces")
        result = Mesh._of(xmlfiles.read(os.path.join(folder, "mesh.vtu")))
        if interfaces is not None:
            result.interfaces = Interfaces._of(xmlfiles.read(os.path.join(folder, "interfaces.vtu")))
    return result


def mesh_options(mesh: Union[Mesh, Path, Any], folder: str) -> List[str]:
    """The option that names a mesh, which is written to the folder if it is in memory."""
    if isinstance(mesh, (str, os.PathLike)):
        return ["--mesh=" + existing(mesh)]
    if not isinstance(mesh, Mesh):
        raise TypeError(f"mesh must be a voxplex.Mesh, a vtkUnstructuredGrid or a path, not {type(mesh).__name__}")
    return mesh._options(folder)
