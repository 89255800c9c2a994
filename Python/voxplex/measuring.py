# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""quality(): how good a mesh is, and how well it shows its image."""

from __future__ import annotations

import json
import os
from typing import Any, Dict, Iterable, Optional, Union

import numpy
from numpy.typing import ArrayLike

from . import program
from .fields import Label
from .files import Path, in_words, number_list, temporary_folder
from .images import Image
from .meshes import Mesh, mesh_options
from .options import labels_of
from .program import Progress
from .sources import image_of, input_of, reading_of


def quality(mesh: Union[Mesh, Path, Any], image: Optional[Any] = None, *,
            labels: Optional[Iterable[Label]] = None,
            hausdorff: bool = True, smoothing: Optional[float] = None, radius_edge: Optional[float] = None,
            facet_angle: Optional[float] = None, smallest_component: Optional[int] = None,
            spacing: Optional[ArrayLike] = None, origin: Optional[ArrayLike] = None,
            direction: Optional[ArrayLike] = None, times: Optional[ArrayLike] = None,
            affine: Optional[ArrayLike] = None, scalars: Optional[str] = None,
            time_scale: Optional[float] = None, threads: int = 0,
            progress: Optional[Progress] = None) -> Dict[str, Any]:
    """Measures a mesh of labelled tetrahedra or pentatopes, made by Voxplex or another program.

    A mesh of pentatopes is measured itself, and its cut at the time of each frame beside the frame.

    Parameters
    ----------
    mesh
        A :class:`Mesh`; a vtkUnstructuredGrid of tetrahedra or pentatopes with a cell array `Label` (and for pentatopes
        the point array `Time`); or the path of a .vtu file.
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
    spacing, origin, direction, affine
        Of an image that is an array or a file, as for :func:`mesh`.
    times
        Of the frames of a series, as for :func:`mesh`. Without an image, the times at which pentatopes are cut.
    scalars
        Of an image of VTK or PyVista, as for :func:`mesh`.
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
    >>> figures = voxplex.quality(voxplex.mesh(labels, delta=1.5), labels)
    >>> figures["image"]["lost_labels"]
    []
    >>> figures["hausdorff"]["voxels"]["distance"] < 1.5 * 1.5
    True
    """
    reading = reading_of(locals())
    source = None if image is None else image_of(image, reading, times, scalars)
    if source is None and (labels is not None or reading):
        raise ValueError(f"{', '.join(reading) or 'labels'}: only with an image")
    if hasattr(mesh, "GetCellData"):
        mesh = Mesh.from_vtk(mesh)
    space = mesh.space if isinstance(mesh, Mesh) else None
    if isinstance(source, Image) and None not in (space, source.space) and space != source.space:
        raise ValueError(f"the mesh is in {space} coordinates, the image in {source.space}")
    with temporary_folder() as folder:
        report = os.path.join(folder, "quality.json")
        arguments = ["measure", *mesh_options(mesh, folder), "--stats=" + report, f"--threads={int(threads)}"]
        if hausdorff and source is not None:
            arguments.append("--hausdorff")
        for option, value in (("smoothing", smoothing), ("radius-edge", radius_edge), ("facet-angle", facet_angle),
                              ("smallest-component", smallest_component), ("time-scale", time_scale)):
            if value is not None:
                arguments.append(f"--{option}={value}")
        if labels is not None:
            arguments += labels_of(labels, source.names if isinstance(source, Image) else None)
        if source is not None:
            arguments += input_of(source, folder, False, {"space": space or "LPS", **reading}, times)
        elif times is not None:
            arguments += number_list("frame-times", numpy.ravel(times))
        program.run(arguments, progress, in_words(folder))
        with open(report, encoding="utf-8") as file:
            figures: Dict[str, Any] = json.load(file)
    return figures
