# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""mesh(): a label image in, a mesh out."""

from __future__ import annotations

import json
import warnings
from typing import (
    TYPE_CHECKING, Any, Dict, Iterable, Mapping, NamedTuple, Optional, Sequence, Union, overload)

from numpy.typing import ArrayLike
from vtkmodules.vtkCommonDataModel import vtkPolyData, vtkUnstructuredGrid

from .errors import MeshingCancelled, MeshingError, MeshingWarning
from .execution import Execution, Progress
from .names import label_value
from .sources import Image, SizeImage, Source
from .vtkVoxplex import vtkImageToPentatopeMeshFilter, vtkImageToTetMeshFilter

if TYPE_CHECKING:
    from typing import Literal

Label = Union[int, str]
"""A label's value, or its name where the image carries names."""


class MeshingResult(NamedTuple):
    """All that mesh() has to say (full_output=True)."""

    mesh: vtkUnstructuredGrid
    """Tetrahedra or pentatopes, cell array Label."""
    interfaces: Union[vtkPolyData, vtkUnstructuredGrid]
    """Triangles between tissues, cell array Labels; of pentatopes: boundary tetrahedra."""
    statistics: Dict[str, Any]
    """What voxplex --stats writes, without what is about files."""


# The filter's messages speak of its methods.
_TERMS = {"SetLabelSize()": "label_sizes", "AddLabel()": "labels", "or force it": "or pass force=True",
          "Force goes": "force=True goes"}


@overload
def mesh(image: Image, delta: Optional[float] = None, *, threads: int = 0,
         size: Optional[float] = None, label_sizes: Optional[Mapping[Label, float]] = None,
         labels: Optional[Iterable[Label]] = None, size_image: Optional[SizeImage] = None,
         smoothing: Optional[float] = None, radius_edge: Optional[float] = None,
         facet_angle: Optional[float] = None, sliver_angle: Optional[float] = None,
         optimise: Optional[bool] = None,
         smallest_component: Optional[int] = None, min_component_volume: Optional[float] = None,
         spacing: Optional[Sequence[float]] = None,
         origin: Optional[Sequence[float]] = None, direction: Optional[ArrayLike] = None,
         times: Optional[Sequence[float]] = None, time_scale: Optional[float] = None,
         pick_slivers: Optional[bool] = None, seed: Optional[int] = None, force: bool = False,
         memory_limit: int = 0, progress: Optional[Progress] = None, full_output: Literal[False] = ...) -> vtkUnstructuredGrid: ...


@overload
def mesh(image: Image, delta: Optional[float] = None, *, threads: int = 0,
         size: Optional[float] = None, label_sizes: Optional[Mapping[Label, float]] = None,
         labels: Optional[Iterable[Label]] = None, size_image: Optional[SizeImage] = None,
         smoothing: Optional[float] = None, radius_edge: Optional[float] = None,
         facet_angle: Optional[float] = None, sliver_angle: Optional[float] = None,
         optimise: Optional[bool] = None,
         smallest_component: Optional[int] = None, min_component_volume: Optional[float] = None,
         spacing: Optional[Sequence[float]] = None,
         origin: Optional[Sequence[float]] = None, direction: Optional[ArrayLike] = None,
         times: Optional[Sequence[float]] = None, time_scale: Optional[float] = None,
         pick_slivers: Optional[bool] = None, seed: Optional[int] = None, force: bool = False,
         memory_limit: int = 0, progress: Optional[Progress] = None, full_output: Literal[True]) -> MeshingResult: ...


def mesh(image: Image, delta: Optional[float] = None, *, threads: int = 0,
         size: Optional[float] = None, label_sizes: Optional[Mapping[Label, float]] = None,
         labels: Optional[Iterable[Label]] = None, size_image: Optional[SizeImage] = None,
         smoothing: Optional[float] = None, radius_edge: Optional[float] = None,
         facet_angle: Optional[float] = None, sliver_angle: Optional[float] = None,
         optimise: Optional[bool] = None,
         smallest_component: Optional[int] = None, min_component_volume: Optional[float] = None,
         spacing: Optional[Sequence[float]] = None,
         origin: Optional[Sequence[float]] = None, direction: Optional[ArrayLike] = None,
         times: Optional[Sequence[float]] = None, time_scale: Optional[float] = None,
         pick_slivers: Optional[bool] = None, seed: Optional[int] = None, force: bool = False,
         memory_limit: int = 0, progress: Optional[Progress] = None, full_output: bool = False) -> Union[vtkUnstructuredGrid, MeshingResult]:
    """Meshes a segmented image, or a time series of such images.

    Every tissue of a 3D image becomes tetrahedra (cell array `Label`), which share the nodes of
    interfaces; a time series becomes pentatopes of space-time (point array `Time`, too). Lengths are
    in the unit of the image's spacing.

    Parameters
    ----------
    image
        One label a voxel, 0 is background. It may be

        - a vtkImageData; several components are the frames of a time series;
        - an array indexed [k, j, i] (see :mod:`voxplex.images`), or [t, k, j, i] for a time series;
        - a list of vtkImageData, the frames of a time series;
        - the path of a file or of a folder with a DICOM series, as for :func:`read_segmentation`;
        - a VTK reader or filter, whose first output is the image.
    delta
        How densely interfaces are sampled: edges of their triangles are about one to two times as
        long. By default it is derived from the spacing.
    threads
        0 means what VTK's SMP setting says: all cores. One thread gives the same mesh every time.
    size
        Upper bound of every element's circumradius.
    label_sizes
        The same for the elements of some labels: {label: size}. Labels may be given by name where
        the image carries names (see :func:`label_names`).
    labels
        Mesh these labels only, and take the others for background.
    size_image
        The same bound at every point: a vtkImageData of lengths, or an array of the shape of a 3D
        image (of one frame). 0 sets no bound.
    smoothing
        How far voxel stairs are smoothed, in voxels. Default 1; 0 switches it off.
    radius_edge
        Upper bound of circumradius over shortest edge. Default 2.
    facet_angle
        Tetrahedra only: lower bound of the angles of triangles on interfaces, in degrees. Default 30.
    sliver_angle
        Tetrahedra only: those with a dihedral angle below this, or above 180 less this, are split. In
        degrees, default 9; 0 leaves them, above 15 needs force.
    optimise
        Tetrahedra only: improve shapes after refinement; dihedral angles of 15 to 155 degrees but for a few,
        radius-edge ratios up to 2.5. Default False.
    smallest_component
        Tetrahedra only: connected components of at least so many voxels get elements whatever delta.
        Default 8; 0 leaves it to chance.
    min_component_volume
        Tetrahedra only: connected components with less volume are left out; they become what is around
        them. Default 0.
    spacing, origin, direction
        Of an array, in the order x, y, z; see :func:`image_from_array`.
    times
        Of the frames, equally spaced; by default what the images say, else 0, 1, 2 ...
    time_scale
        Pentatopes only: the length that a unit of time counts as much as. Default 1.
    pick_slivers
        Pentatopes only: whether to fight slivers; False is faster. Default True.
    seed
        Pentatopes only: of the random points tried against slivers. Default 0.
    force
        Go on although the mesh is estimated not to fit in memory, or radius_edge is below 1.93,
        or sliver_angle above 15.
    memory_limit
        Bytes to plan with; 0 means the machine's memory.
    progress
        Called now and then, from this thread, with the fraction done (0 to 1). If it returns False
        meshing stops within a second; what it raises is raised by this function.
    full_output
        Return a :class:`MeshingResult` with the interfaces and the statistics besides the mesh.

    Returns
    -------
    The mesh, or if full_output the tuple (mesh, interfaces, statistics). The field data of the image
    (label names, SPACE) is passed to both.

    Raises
    ------
    MeshingError
        The image cannot be meshed; the message says why.
    MeshingCancelled
        The progress callback returned False.
    KeyboardInterrupt
        Ctrl-C was pressed. Meshing stops within a second.
    ValueError, TypeError
        The arguments do not fit each other, or the image.
    OSError
        The file cannot be read.

    Warns
    -----
    MeshingWarning
        The mesh lacks a label, or an element size was raised.

    Examples
    --------
    >>> import numpy
    >>> labels = numpy.zeros((16, 24, 24), dtype=numpy.uint8)
    >>> labels[4:12, 6:18, 6:12] = 1
    >>> labels[4:12, 6:18, 12:18] = 2
    >>> grid = mesh(labels, delta=1.5, spacing=(0.5, 0.5, 1.0), label_sizes={2: 1.0}, threads=1)
    >>> grid.GetClassName()
    'vtkUnstructuredGrid'
    >>> tetrahedra, interfaces, statistics = mesh(labels, delta=3, full_output=True)
    >>> statistics["elements"] == tetrahedra.GetNumberOfCells()
    True
    >>> mesh(labels, delta=-1)
    Traceback (most recent call last):
      ...
    voxplex.errors.MeshingError: Delta is -1; it must be positive and finite, or 0 to derive it from the spacing.
    """
    geometry = {name: value for name, value in
                (("spacing", spacing), ("origin", origin), ("direction", direction)) if value is not None}
    source = Source(image, geometry, times)
    if source.is_series:
        mesher = vtkImageToPentatopeMeshFilter()
        _refuse("only for images without time frames", facet_angle=facet_angle, sliver_angle=sliver_angle,
                optimise=optimise, smallest_component=smallest_component, min_component_volume=min_component_volume)
        _set(mesher, TimeScale=time_scale, PickingRegions=pick_slivers, RandomSeed=seed)
    else:
        mesher = vtkImageToTetMeshFilter()
        _refuse("only for images with time frames", times=times, time_scale=time_scale,
                pick_slivers=pick_slivers, seed=seed)
        _set(mesher, FacetAngle=facet_angle, SliverAngle=sliver_angle, Optimise=optimise,
             SmallestComponent=smallest_component, MinimumComponentVolume=min_component_volume)
    source.connect(mesher)
    _set(mesher, Delta=delta, NumberOfThreads=threads, ElementSize=size, SmoothingSigma=smoothing,
         RadiusEdgeRatio=radius_edge, Force=force, MemoryLimit=memory_limit, ComputeQuality=full_output)
    names = source.names()
    for label, bound in (label_sizes or {}).items():
        mesher.SetLabelSize(label_value(label, names), bound)
    if labels is not None:
        chosen = [label_value(label, names) for label in labels]
        if not chosen:
            raise ValueError("labels is empty: there is nothing to mesh")
        for value in chosen:
            mesher.AddLabel(value)
    if size_image is not None:
        mesher.SetElementSizeData(source.sizes(size_image))

    _run(mesher, source, progress)
    if not full_output:
        return mesher.GetOutput()
    return MeshingResult(mesher.GetOutput(), mesher.GetOutputDataObject(1),
                         json.loads(mesher.GetStatistics().ToJSON()))


def _run(mesher: Any, source: Source, progress: Optional[Progress]) -> None:
    execution = Execution(mesher, progress)
    if source.algorithm is not None:
        execution.watch(source.algorithm)
    execution.run(mesher.Update)
    for text in execution.warnings:
        warnings.warn(text, MeshingWarning, stacklevel=3)
    if mesher.GetAborted() or execution.cancelled:
        raise MeshingCancelled("meshing was cancelled")
    message = mesher.GetErrorMessage() or "\n".join(execution.errors)
    if message:
        for theirs, ours in _TERMS.items():
            message = message.replace(theirs, ours)
        raise MeshingError(message)


def _set(mesher: Any, **values: Any) -> None:
    """Sets the properties that were given."""
    for name, value in values.items():
        if value is not None:
            getattr(mesher, "Set" + name)(value)


def _refuse(why: str, **values: Any) -> None:
    given = [name for name, value in values.items() if value is not None]
    if given:
        raise ValueError(f"{', '.join(given)}: {why}")
