# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""mesh(): a label image, or a grey-value image with an isovalue, in, a mesh out."""

from __future__ import annotations

import json
import warnings
from typing import (
    TYPE_CHECKING, Any, Dict, Iterable, Mapping, NamedTuple, Optional, Sequence, Tuple, Union, overload)

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

Interface = Union[Label, Tuple[Label, Label]]
"""The interface between two labels, 0 being background, or all interfaces of a label."""


class MeshingResult(NamedTuple):
    """All that mesh() has to say (full_output=True)."""

    mesh: vtkUnstructuredGrid
    """Tetrahedra or pentatopes, cell array Label."""
    interfaces: Union[vtkPolyData, vtkUnstructuredGrid]
    """Triangles between tissues, cell array Labels; of pentatopes: boundary tetrahedra."""
    statistics: Dict[str, Any]
    """What voxplex --stats writes, without what is about files."""


# The filter's messages speak of its methods.
_TERMS = {"SetLabelSize()": "label_sizes", "SetInterfaceSize()": "interface_sizes", "AddLabel()": "labels",
          "or force it": "or pass force=True", "Force goes": "force=True goes",
          "mesh an isosurface of it": "mesh an isosurface of it (isovalue)"}


_GRADING = {"uniform": vtkImageToTetMeshFilter.UNIFORM, "lfs": vtkImageToTetMeshFilter.LOCAL_FEATURE_SIZE}


@overload
def mesh(image: Image, delta: Optional[float] = None, *, threads: int = 0,
         isovalue: Optional[float] = None, inside: Optional[str] = None,
         inside_label: Optional[int] = None,
         elements: Optional[int] = None, size: Optional[float] = None,
         label_sizes: Optional[Mapping[Label, float]] = None,
         interface_sizes: Optional[Mapping[Interface, float]] = None, gradation: Optional[float] = None,
         labels: Optional[Iterable[Label]] = None, size_image: Optional[SizeImage] = None,
         smoothing: Optional[float] = None, radius_edge: Optional[float] = None,
         grading: Optional[str] = None, feature_ratio: Optional[float] = None, largest_feature: Optional[float] = None,
         facet_angle: Optional[float] = None, sliver_angle: Optional[float] = None,
         optimise: Optional[bool] = None, optimise_seconds: Optional[float] = None,
         sample_junctions: Optional[bool] = None, interface_rounds: Optional[int] = None, manifold: Optional[bool] = None,
         smallest_component: Optional[int] = None, exact_components: Optional[bool] = None,
         min_component_volume: Optional[float] = None, spacing: Optional[Sequence[float]] = None,
         origin: Optional[Sequence[float]] = None, direction: Optional[ArrayLike] = None,
         times: Optional[Sequence[float]] = None, time_scale: Optional[float] = None,
         pick_slivers: Optional[bool] = None, seed: Optional[int] = None, force: bool = False,
         memory_limit: int = 0, progress: Optional[Progress] = None, full_output: Literal[False] = ...) -> vtkUnstructuredGrid: ...


@overload
def mesh(image: Image, delta: Optional[float] = None, *, threads: int = 0,
         isovalue: Optional[float] = None, inside: Optional[str] = None,
         inside_label: Optional[int] = None,
         elements: Optional[int] = None, size: Optional[float] = None,
         label_sizes: Optional[Mapping[Label, float]] = None,
         interface_sizes: Optional[Mapping[Interface, float]] = None, gradation: Optional[float] = None,
         labels: Optional[Iterable[Label]] = None, size_image: Optional[SizeImage] = None,
         smoothing: Optional[float] = None, radius_edge: Optional[float] = None,
         grading: Optional[str] = None, feature_ratio: Optional[float] = None, largest_feature: Optional[float] = None,
         facet_angle: Optional[float] = None, sliver_angle: Optional[float] = None,
         optimise: Optional[bool] = None, optimise_seconds: Optional[float] = None,
         sample_junctions: Optional[bool] = None, interface_rounds: Optional[int] = None, manifold: Optional[bool] = None,
         smallest_component: Optional[int] = None, exact_components: Optional[bool] = None,
         min_component_volume: Optional[float] = None, spacing: Optional[Sequence[float]] = None,
         origin: Optional[Sequence[float]] = None, direction: Optional[ArrayLike] = None,
         times: Optional[Sequence[float]] = None, time_scale: Optional[float] = None,
         pick_slivers: Optional[bool] = None, seed: Optional[int] = None, force: bool = False,
         memory_limit: int = 0, progress: Optional[Progress] = None, full_output: Literal[True]) -> MeshingResult: ...


def mesh(image: Image, delta: Optional[float] = None, *, threads: int = 0,
         isovalue: Optional[float] = None, inside: Optional[str] = None,
         inside_label: Optional[int] = None,
         elements: Optional[int] = None, size: Optional[float] = None,
         label_sizes: Optional[Mapping[Label, float]] = None,
         interface_sizes: Optional[Mapping[Interface, float]] = None, gradation: Optional[float] = None,
         labels: Optional[Iterable[Label]] = None, size_image: Optional[SizeImage] = None,
         smoothing: Optional[float] = None, radius_edge: Optional[float] = None,
         grading: Optional[str] = None, feature_ratio: Optional[float] = None, largest_feature: Optional[float] = None,
         facet_angle: Optional[float] = None, sliver_angle: Optional[float] = None,
         optimise: Optional[bool] = None, optimise_seconds: Optional[float] = None,
         sample_junctions: Optional[bool] = None, interface_rounds: Optional[int] = None, manifold: Optional[bool] = None,
         smallest_component: Optional[int] = None, exact_components: Optional[bool] = None,
         min_component_volume: Optional[float] = None, spacing: Optional[Sequence[float]] = None,
         origin: Optional[Sequence[float]] = None, direction: Optional[ArrayLike] = None,
         times: Optional[Sequence[float]] = None, time_scale: Optional[float] = None,
         pick_slivers: Optional[bool] = None, seed: Optional[int] = None, force: bool = False,
         memory_limit: int = 0, progress: Optional[Progress] = None, full_output: bool = False) -> Union[vtkUnstructuredGrid, MeshingResult]:
    """Meshes a segmented image, or a time series of such images, or what an isosurface bounds.

    Every tissue of a 3D image becomes tetrahedra (cell array `Label`), which share the nodes of
    interfaces; a time series becomes pentatopes of space-time (point array `Time`, too). Lengths are
    in the unit of the image's spacing.

    Parameters
    ----------
    image
        One label a voxel, 0 is background; with isovalue, one grey value a voxel. It may be

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
    isovalue
        Tetrahedra only: the image has grey values (CT numbers, signed distances, densities), and what
        lies inside of the isosurface at this value is meshed, as one tissue. Its vertices lie on the
        isosurface of the trilinear interpolation; voxels that are NaN are outside.
    inside
        With isovalue: "above" (default) if the object has the greater values, or "below".
    inside_label
        With isovalue: the label of what is inside. Default 1.
    elements
        How many elements the mesh is to have, to within a tenth, instead of delta, which is solved for: meshing
        takes two or three times as long. The statistics have the delta, and each run that it took.
    size
        Upper bound of every element's circumradius.
    label_sizes
        The same for the elements of some labels: {label: size}. Labels may be given by name where
        the image carries names (see :func:`label_names`).
    interface_sizes
        How densely single interfaces are sampled, in place of delta: {(label, label): length} for the interface of two
        labels, 0 being background, {label: length} for all interfaces of one.
    gradation
        How much sizes and interface sizes may change over a unit of length. Default 0.3; 0 sets no limit.
    labels
        Mesh these labels only, and take the others for background.
    size_image
        The same bound at every point: a vtkImageData of lengths, or an array of the shape of a 3D
        image (of one frame). 0 sets no bound.
    smoothing
        How far voxel stairs, or the noise of grey values, are smoothed, in voxels. Default 1, with
        isovalue 0; 0 switches it off.
    radius_edge
        Upper bound of circumradius over shortest edge. Default 2.
    grading
        Tetrahedra only: "uniform", the default, samples interfaces with delta everywhere; "lfs" with
        max(delta, feature_ratio * local feature size), which is coarser where the shape allows it. The local
        feature size is the distance to the medial axis, about half the thickness of what is thin.
    feature_ratio
        Tetrahedra only, with grading="lfs": sampling density over local feature size. Default 1.
    largest_feature
        Tetrahedra only, with grading="lfs": larger local feature sizes count as this, in voxels. Default 12.
    facet_angle
        Tetrahedra only: lower bound of the angles of triangles on interfaces, in degrees. Default 30.
    sliver_angle
        Tetrahedra only: those with a dihedral angle below this, or above 180 less this, are split; most above 3
        degrees are left to optimisation. In degrees, default 9; 0 leaves them, above 15 needs force.
    optimise
        Tetrahedra only: improve shapes after refinement; dihedral angles of 15 to 155 degrees but for a few,
        radius-edge ratios up to 2.5. Default True.
    optimise_seconds
        Tetrahedra only: stop improving shapes after so long. Default 0: no limit. Not with optimise=False.
    sample_junctions
        Tetrahedra only: sample the curves where three labels or more meet before all else, so that edges follow
        them. Default True.
    interface_rounds
        Tetrahedra only: how often, at most, to refine again where an interface of the image is farther than
        1.5 delta from those of the mesh, or the boundary of a label is not manifold. Default 8; 0 is never.
    manifold
        Tetrahedra only: leave no edge where more than two triangles of a label's boundary meet. Default True.
    smallest_component
        Tetrahedra only: connected components of at least so many voxels, and the largest of each label, get elements
        whatever delta. Default 8; 0 leaves it to chance.
    exact_components
        Tetrahedra only: sample these components as finely as they are thin, whatever delta. Default False: those that
        are thin beside delta have a few elements.
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
        Pentatopes only: of the random points tried against slivers. Default 0. Not with pick_slivers=False.
    force
        Go on although the mesh is estimated not to fit in memory, the labels look like grey values, radius_edge is
        below 1.93, or sliver_angle above 15.
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
    if delta and elements:
        raise ValueError("delta and elements: give one of the two; delta is what elements are solved for")
    geometry = {name: value for name, value in
                (("spacing", spacing), ("origin", origin), ("direction", direction)) if value is not None}
    source = Source(image, geometry, times)
    if source.is_series:
        mesher = vtkImageToPentatopeMeshFilter()
        _refuse("only for images without time frames", isovalue=isovalue, grading=grading, feature_ratio=feature_ratio,
                largest_feature=largest_feature, facet_angle=facet_angle, sliver_angle=sliver_angle,
                optimise=optimise, optimise_seconds=optimise_seconds, sample_junctions=sample_junctions,
                interface_rounds=interface_rounds, manifold=manifold, smallest_component=smallest_component,
                exact_components=exact_components, min_component_volume=min_component_volume)
        if pick_slivers is not None and not pick_slivers:
            _refuse("of the points that pick_slivers=False does without; leave one of the two out", seed=seed)
        _set(mesher, TimeScale=time_scale, PickingRegions=pick_slivers, RandomSeed=seed)
    else:
        mesher = vtkImageToTetMeshFilter()
        _refuse("only for images with time frames", times=times, time_scale=time_scale,
                pick_slivers=pick_slivers, seed=seed)
        if grading is not None and grading not in _GRADING:
            raise ValueError(f"grading must be one of {', '.join(_GRADING)}, not {grading!r}")
        if grading != "lfs":
            _refuse('only for interfaces that are graded; pass grading="lfs" as well, or leave it out',
                    feature_ratio=feature_ratio, largest_feature=largest_feature)
        if optimise is not None and not optimise:
            _refuse("limits what optimise=False switches off; leave one of the two out", optimise_seconds=optimise_seconds)
        _set(mesher, Grading=None if grading is None else _GRADING[grading], FeatureRatio=feature_ratio, LargestFeature=largest_feature)
        _set(mesher, FacetAngle=facet_angle, SliverAngle=sliver_angle, Optimise=optimise,
             OptimisationTimeLimit=optimise_seconds, SampleJunctions=sample_junctions, InterfaceRounds=interface_rounds,
             Manifold=manifold, SmallestComponent=smallest_component, ExactComponents=exact_components,
             MinimumComponentVolume=min_component_volume)
    if isovalue is None:
        _refuse("only with isovalue", inside=inside, inside_label=inside_label)
        _set(mesher, SmoothingSigma=smoothing)
    else:
        _refuse("only for images of labels, without isovalue", labels=labels)
        mesher.SetInputModeToIsosurface()
        _set(mesher, Isovalue=isovalue, Inside=_side(inside), InsideLabel=inside_label,
             IsosurfaceSmoothingSigma=smoothing)
    source.connect(mesher)
    _set(mesher, Delta=delta, NumberOfElements=elements, Gradation=gradation, NumberOfThreads=threads, ElementSize=size,
         RadiusEdgeRatio=radius_edge, Force=force, MemoryLimit=memory_limit, ComputeQuality=full_output)
    names = source.names()
    for label, bound in (label_sizes or {}).items():
        mesher.SetLabelSize(label_value(label, names), bound)
    for interface, density in (interface_sizes or {}).items():
        mesher.SetInterfaceSize(*_interface(interface, names), density)
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


def _interface(interface: Interface, names: Any) -> Tuple[int, int]:
    """The two labels of a key of interface_sizes."""
    if not isinstance(interface, tuple):
        return label_value(interface, names), vtkImageToTetMeshFilter.ANY_LABEL
    if len(interface) != 2:
        raise ValueError(f"interface_sizes: {interface!r} is not a pair of labels")
    first, second = (0 if label == 0 else label_value(label, names) for label in interface)
    return first, second


def _set(mesher: Any, **values: Any) -> None:
    """Sets the properties that were given."""
    for name, value in values.items():
        if value is not None:
            getattr(mesher, "Set" + name)(value)


def _side(inside: Optional[str]) -> Optional[int]:
    """The filter's number for a side."""
    if inside is None:
        return None
    sides = {"above": vtkImageToTetMeshFilter.INSIDE_ABOVE, "below": vtkImageToTetMeshFilter.INSIDE_BELOW}
    if inside not in sides:
        raise ValueError(f"inside is {inside!r}, not 'above' or 'below'")
    return sides[inside]


def _refuse(why: str, **values: Any) -> None:
    given = [name for name, value in values.items() if value is not None]
    if given:
        raise ValueError(f"{', '.join(given)}: {why}")
