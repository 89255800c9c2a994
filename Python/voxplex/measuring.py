# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""quality(): how good a mesh is, and how well it shows its image."""

from __future__ import annotations

import errno
import json
import os
from typing import Any, Dict, Iterable, Optional, Sequence, Union

from numpy.typing import ArrayLike
from vtkmodules.vtkCommonDataModel import VTK_POLY_VERTEX, vtkUnstructuredGrid
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

from .errors import FileError
from .execution import Execution, Progress
from .files import Path
from .names import Label, label_value
from .sources import Image, Source
from .vtkVoxplex import vtkSimplexMeshQuality


def quality(mesh: Union[vtkUnstructuredGrid, Path], image: Optional[Image] = None, *,
            labels: Optional[Iterable[Label]] = None,
            hausdorff: bool = True, smoothing: Optional[float] = None, radius_edge: Optional[float] = None,
            facet_angle: Optional[float] = None, smallest_component: Optional[int] = None,
            spacing: Optional[Sequence[float]] = None, origin: Optional[Sequence[float]] = None,
            direction: Optional[ArrayLike] = None, times: Optional[Sequence[float]] = None,
            time_scale: Optional[float] = None, threads: int = 0,
            progress: Optional[Progress] = None) -> Dict[str, Any]:
    """Measures a mesh of labelled tetrahedra or pentatopes, made by Voxplex or another program.

    A mesh of pentatopes is measured itself, and its cut at the time of each frame beside the frame.

    Parameters
    ----------
    mesh
        A vtkUnstructuredGrid of tetrahedra or pentatopes with a cell array `Label` (and for pentatopes the point
        array `Time`), or the path of a .vtu file.
    image
        The label image or series that it was made from, as :func:`mesh` takes it; without one, nothing that needs
        an image is measured. It must lie where the mesh lies.
    labels
        Those that were meshed, by number or name; others are background. By default all.
    hausdorff
        Whether to measure distances between the interfaces of the mesh and of the image, which takes a few
        seconds for a million voxel faces.
    smoothing
        Of the interface that the mesh should have, as for :func:`mesh`; voxels. Default 1.
    radius_edge, facet_angle
        Elements with this ratio or more, and facets with an angle below, are counted. Default 2 and 30.
    smallest_component
        Connected components of the image with at least this number of voxels, and the largest of each label,
        are looked for. Default 8.
    spacing, origin, direction
        Of an image that is an array or a file, as for :func:`mesh`.
    times
        Of the frames of a series, as for :func:`mesh`. Without an image, the times at which pentatopes are cut.
    time_scale
        With which pentatopes were meshed. Default 1.
    threads, progress
        As for :func:`mesh`.

    Returns
    -------
    A dictionary; Documentation/Reference.md has its keys.

    Raises
    ------
    MeshingError
        The mesh or the image cannot be measured; the message says why.
    MeshingCancelled, KeyboardInterrupt
        As :func:`mesh`.
    OSError
        A file cannot be read.
    ValueError, TypeError
        The arguments do not fit each other.

    Examples
    --------
    >>> import numpy, voxplex
    >>> labels = numpy.zeros((16, 24, 24), dtype=numpy.uint8)
    >>> labels[4:12, 6:18, 6:12] = 1
    >>> labels[4:12, 6:18, 12:18] = 2
    >>> grid = voxplex.mesh(labels, delta=1.5)
    >>> figures = voxplex.quality(grid, labels)
    >>> figures["image"]["lost_labels"]
    []
    >>> figures["hausdorff"]["voxels"]["distance"] < 1.5 * 1.5
    True
    """
    measurer = vtkSimplexMeshQuality()
    grid = _mesh(mesh)
    is_series = grid.GetNumberOfCells() > 0 and grid.GetCellType(0) == VTK_POLY_VERTEX
    measurer.SetInputData(grid)
    geometry = {name: value for name, value in
                (("spacing", spacing), ("origin", origin), ("direction", direction)) if value is not None}
    if image is not None:
        _connect(measurer, Source(image, geometry, times), labels, is_series)
    elif geometry or labels is not None:
        raise ValueError(f"{', '.join(geometry) or 'labels'}: only with an image")
    elif is_series:
        for time in () if times is None else times:
            measurer.AddFrameTime(float(time))
    if not is_series and (times is not None or time_scale is not None):
        raise ValueError("times, time_scale: only for meshes of pentatopes")
    measurer.SetDistances(hausdorff)
    measurer.SetNumberOfThreads(threads)
    for name, value in (("TimeScale", time_scale), ("SmoothingSigma", smoothing), ("RadiusEdgeRatio", radius_edge), ("FacetAngle", facet_angle),
                        ("SmallestComponent", smallest_component)):
        if value is not None:
            getattr(measurer, "Set" + name)(value)
    execution = Execution(measurer, progress)
    execution.run(measurer.Update)
    execution.check("measuring")
    figures: Dict[str, Any] = json.loads(measurer.ToJSON())
    return figures


def _connect(measurer: Any, source: Source, labels: Optional[Iterable[Label]], is_series: bool) -> None:
    if source.is_series != is_series:
        raise ValueError("the image has time frames, but the mesh has no pentatopes" if source.is_series else
                         "the mesh has pentatopes, but the image has no time frames")
    source.connect(measurer, 1)
    if labels is not None:
        for label in labels:
            measurer.AddLabel(label_value(label, source.names()))


def _mesh(mesh: Union[vtkUnstructuredGrid, Path]) -> vtkUnstructuredGrid:
    if isinstance(mesh, (str, os.PathLike)):
        return _read(mesh)
    if not isinstance(mesh, vtkUnstructuredGrid):
        raise TypeError(f"mesh must be a vtkUnstructuredGrid or a path, not {type(mesh).__name__}")
    return mesh


def _read(path: Path) -> vtkUnstructuredGrid:
    name = os.fspath(path)
    if not os.path.exists(name):
        raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), name)
    reader = vtkXMLUnstructuredGridReader()
    if not name.endswith(".vtu") or not reader.CanReadFile(name):
        raise FileError(f"{name} is not a .vtu file, the one format that quality() reads; pass the mesh itself")
    reader.SetFileName(name)
    execution = Execution(reader)
    execution.run(reader.Update)
    if execution.errors:
        raise FileError("\n".join(execution.errors))
    return reader.GetOutput()
