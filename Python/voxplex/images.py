# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Images in memory.

Arrays are indexed [k, j, i] with i, the first axis of the image, running fastest in memory: the order
of SimpleITK's GetArrayFromImage() and of ITK's. An array indexed [i, j, k], as nibabel's, is passed
transposed: `array.T`. Spacing, origin and direction are in the order (x, y, z) of SimpleITK's
GetSpacing(), GetOrigin() and GetDirection().
"""

from __future__ import annotations

import math
import os
import re
from typing import Any, Dict, List, Mapping, Optional, Sequence, Tuple

import numpy
from numpy.typing import ArrayLike, NDArray

from . import program
from .errors import FileError, MeshingError
from .fields import Color, Described, Fields, check_names, html_table
from .files import Path, in_words, number_list, number_text, temporary_folder

_SPACES = {"LPS": "left-posterior-superior", "RAS": "right-anterior-superior"}
_ROUNDED = 1e-3  # directions of three digits have this length, nearly
IS_NO_TEXT = re.compile(r"[\0-\x1f\x7f]")
"""What no name of a label has."""
# NumPy has types for a part of it only.
_MASKED: Any = numpy.ma


class Image(Described):
    """A label image, one of grey values, or a time series of such images, with its place.

    Parameters
    ----------
    voxels : array_like
        Indexed [k, j, i], or [t, k, j, i] of a time series. One label a voxel, 0 is background, or one grey value. Any
        integer or real type, or bool. Masked voxels (numpy.ma) are background, and outside of isosurfaces. The array is
        kept, not copied.
    spacing : three numbers, optional
        The distances of voxels along i, j and k. Default 1.
    origin : three numbers, optional
        Where voxel (0, 0, 0) lies. Default 0.
    direction : 3 x 3 array_like, optional
        Or its 9 numbers, row by row. The columns are the directions of i, j and k, of length 1. Default: the axes.
    times : sequence of float, optional
        Of the frames, increasing. Default 0, 1, 2 ...
    names : dict of int to str, optional
        Of labels, by value.
    space : {"LPS", "RAS"}, optional
        The coordinates that origin and direction are in, if they are known.
    affine : 4 x 4 array_like, optional
        In place of spacing, origin and direction: takes (i, j, k, 1) to RAS, as nibabel's. The place is converted to LPS,
        unless space is "RAS".

    Attributes
    ----------
    voxels : numpy.ndarray
    mask : numpy.ndarray of bool, or None
        Which voxels do not count.
    spacing, origin : list of float
    direction : numpy.ndarray
    times : list of float
        Empty without time frames.
    names : dict of int to str
        Writing into it renames labels.
    colors : dict of int to three float
        Red, green and blue of labels with names, from 0 to 1.
    space : str or None
    field_data : dict of str to numpy.ndarray or list of str
        Further arrays, which meshes inherit.
    statistics : dict
        What :func:`repair` did, else empty.

    Raises
    ------
    ValueError
        Shapes and numbers do not fit. A uint8 array of four dimensions whose last axis has the length 3 or 4 is taken for a
        stack of coloured pictures, and refused, unless there are times.

    Examples
    --------
    >>> import numpy
    >>> Image(numpy.zeros((20, 32, 32), dtype=numpy.uint8), spacing=(0.5, 0.5, 1.0))
    Image of 32 x 32 x 20 voxels, uint8
    """

    def __init__(self, voxels: ArrayLike, *, spacing: Optional[ArrayLike] = None, origin: Optional[ArrayLike] = None,
                 direction: Optional[ArrayLike] = None, times: Optional[ArrayLike] = None,
                 names: Optional[Mapping[int, str]] = None, space: Optional[str] = None,
                 affine: Optional[ArrayLike] = None) -> None:
        self.voxels, self.mask = _unmasked(voxels)
        if self.voxels.size == 0:
            raise ValueError(f"the array has the shape {self.voxels.shape}: there are no voxels")
        if self.voxels.ndim not in (3, 4):
            raise ValueError(f"the array has {self.voxels.ndim} dimensions, not 3 ([k, j, i]) or 4 ([t, k, j, i])")
        if self.voxels.dtype.kind not in "biuf":
            raise ValueError(f"the array has elements of type {self.voxels.dtype}, which are not numbers")
        self.space: Optional[str] = None if space is None and affine is None else space_of(space or "LPS")
        place = in_space(place_of(spacing, origin, direction, affine), self.space or "LPS")
        self.spacing: List[float] = place.get("spacing", [1.0, 1.0, 1.0])
        self.origin: List[float] = place.get("origin", [0.0, 0.0, 0.0])
        self.direction: NDArray[numpy.float64] = place.get("direction", numpy.eye(3))
        self.times = self._times(times)
        self.names: Dict[int, str] = dict(names or {})
        check_names(self.names)
        self.colors: Dict[int, Color] = {}
        self.field_data: Fields = {}
        self.statistics: Dict[str, Any] = {}

    def __repr__(self) -> str:
        shape = " x ".join(map(str, reversed(self.voxels.shape[-3:])))
        frames = f"{len(self.voxels)} frames of " if self.is_series else ""
        return f"Image of {frames}{shape} voxels, {self.voxels.dtype}"

    def _repr_html_(self) -> str:
        place = [(name, ", ".join(map(number_text, numpy.ravel(getattr(self, name))))) for name in ("spacing", "origin", "direction")]
        return html_table(repr(self), ("", ""), [*place, ("space", self.space or "not known"), *sorted(self.names.items())])

    @property
    def is_series(self) -> bool:
        """Whether it has time frames."""
        return self.voxels.ndim == 4

    def to_vtk(self) -> Any:
        """As data of VTK, which share the voxels. Needs VTK (pip install vtk).

        Returns
        -------
        vtkImageData
            Of a time series a list of them, each with its time.
        """
        from .vtkdata import Frame, frame_to_vtk
        place = (self.spacing, self.origin, self.direction, self._fields())
        if not self.is_series:
            return frame_to_vtk(Frame(self.voxels, self.mask, *place), None)
        return [frame_to_vtk(Frame(self.voxels[n], None if self.mask is None else self.mask[n], *place), time)
                for n, time in enumerate(self.times)]

    @staticmethod
    def from_vtk(data: Any, times: Optional[ArrayLike] = None, scalars: Optional[str] = None) -> Image:
        """Of data of VTK or PyVista, sharing their memory.

        Parameters
        ----------
        data : vtkImageData, list of these, or vtkAlgorithm
            A list is a time series. Of an algorithm the first output is the image.
        times : sequence of float, optional
            Of the frames. Several components are frames if there are times for them: they may as well be colours.
        scalars : str, optional
            The name of the array of points or cells that has the labels. By default it is the active one, which of points
            and cells PyVista decides if the image is PyVista's; if none is active, the only one.
        """
        from .vtkdata import frame_from_vtk, frame_times, frames_of
        if isinstance(data, (list, tuple)):
            return joined([Image.from_vtk(frame, None, scalars) for frame in data], frame_times(data) if times is None else times)
        frames, steps = frames_of(data)
        if len(frames) > 1:
            return Image.from_vtk(frames, steps if times is None else times, scalars)
        frame = frame_from_vtk(frames[0], scalars, times is not None)
        image = from_components(frame.voxels, frame.mask, times, frame.spacing, frame.origin, frame.direction)
        image._describe(frame.field_data)
        return image

    def write(self, path: Path) -> None:
        """Writes it with its place, times, and names and colours of the labels that it has.

        Masked voxels are written as 0. Where space is None, the file says LPS.

        Parameters
        ----------
        path : path-like
            A .nrrd file, which 3D Slicer reads as a segmentation if it ends in .seg.nrrd. It appears whole or not at all.

        Raises
        ------
        FileError
            The file cannot be written, or its extension is another one.
        """
        with temporary_folder() as folder:
            try:
                program.run(["image", *self._options(folder), "--output=" + os.fsdecode(path)],
                            words=[("output: ", "path: "), *in_words(folder)])
            except MeshingError as error:
                raise FileError(str(error)) from None

    def _options(self, folder: str) -> List[str]:
        """Options of the program that read it in its own coordinates, from a file in the folder."""
        path = os.path.join(folder, "image.nrrd")
        space = self.space or "LPS"
        write_nrrd(self, path, hidden_is_outside=False, space=space)
        return ["--input=" + path, "--space=" + space.lower(), *number_list("frame-times", self.times)]

    def _times(self, times: Optional[ArrayLike]) -> List[float]:
        shape = self.voxels.shape
        if not self.is_series:
            if times is not None:
                raise ValueError("times: only for images with time frames")
            return []
        if times is None and self.voxels.dtype == numpy.uint8 and shape[3] in (3, 4):
            raise ValueError(f"the array has the shape {shape}, as pictures with colours have: make labels of them; "
                             "if it is indexed [t, k, j, i], pass times=")
        if len(self.voxels) < 2:
            raise ValueError("a time series needs two frames or more; pass a single image as it is")
        result = [float(time) for time in numpy.ravel(range(len(self.voxels)) if times is None else times)]
        if len(result) != len(self.voxels):
            raise ValueError(f"there are {len(self.voxels)} frames, and {len(result)} times")
        return result


def joined(images: Sequence[Image], times: Optional[ArrayLike]) -> Image:
    """A time series of single images, which must lie at the same place."""
    first = images[0]
    for number, image in enumerate(images):
        if image.is_series:
            raise ValueError(f"frame {number} is a time series itself")
        if image.voxels.shape != first.voxels.shape:
            raise ValueError(f"the frames have different shapes: {first.voxels.shape} and {image.voxels.shape}")
        if (image.spacing, image.origin, image.space) != (first.spacing, first.origin, first.space) or \
                not numpy.array_equal(image.direction, first.direction):
            raise ValueError(f"frame {number} does not lie where frame 0 lies: spacing, origin, direction or space differ")
    masks = [image.mask for image in images]
    result = at_times(first, range(len(images)) if times is None else times, numpy.stack([image.voxels for image in images]))
    result.mask = None if all(mask is None for mask in masks) else \
        numpy.stack([numpy.zeros(first.voxels.shape, bool) if mask is None else mask for mask in masks])
    return result


def at_times(image: Image, times: ArrayLike, voxels: Optional[NDArray[Any]] = None) -> Image:
    """A copy with other times, or other voxels, too."""
    result = Image(image.voxels if voxels is None else voxels, spacing=image.spacing, origin=image.origin, direction=image.direction,
                   times=times)
    result.mask, result.names, result.colors = image.mask, dict(image.names), dict(image.colors)
    result.space, result.field_data = image.space, image.field_data
    return result


def from_components(voxels: NDArray[Any], mask: Optional[NDArray[numpy.bool_]], times: Optional[ArrayLike],
                    spacing: ArrayLike, origin: ArrayLike, direction: NDArray[Any]) -> Image:
    """Of an array indexed [k, j, i] or, of several components, [k, j, i, component]: frames, if there are times."""
    if voxels.ndim == 4:
        if times is None:
            raise ValueError(f"the image has {voxels.shape[3]} components in each voxel: if they are time frames, pass "
                             "their times (times=[0, 1, ...]); of colours or vectors, extract one component, or make "
                             "labels of them")
        voxels = numpy.moveaxis(voxels, -1, 0)
        mask = None if mask is None else numpy.broadcast_to(mask, voxels.shape)
    spacing, direction = with_unit_directions(spacing, direction)
    image = Image(voxels, times=times, spacing=spacing, origin=origin, direction=direction)
    image.mask = mask
    return image


def write_nrrd(image: Image, path: str, hidden_is_outside: bool, space: str = "LPS", without: Sequence[str] = ()) -> None:
    """Writes an image as the program reads it; masked voxels become NaN if they are outside of isosurfaces, else 0.

    without: "origin" if it is not known where the image lies, "spacing" if its spacing is not known either.
    """
    voxels = _stored(image.voxels)
    if image.mask is not None and hidden_is_outside and voxels.dtype.kind != "f":
        voxels = voxels.astype(numpy.float32 if voxels.dtype.itemsize < 4 else numpy.float64)
    outside = numpy.nan if hidden_is_outside else 0
    columns = [f"({','.join(repr(float(x)) for x in column)})"
               for column in (image.direction * image.spacing).T]
    kinds = ["domain"] * 3 + ["list"] * image.is_series
    header = ["NRRD0004", f"type: {voxels.dtype.name.replace('float32', 'float').replace('float64', 'double')}",
              f"dimension: {voxels.ndim}", "space: " + _SPACES[space],
              f"sizes: {' '.join(map(str, reversed(voxels.shape)))}",
              f"space directions: {' '.join(columns + ['none'] * image.is_series)}", f"kinds: {' '.join(kinds)}",
              f"space origin: ({','.join(map(repr, image.origin))})", "endian: little", "encoding: raw"]
    if "origin" in without:
        header = [line for line in header if not line.startswith("space")]
        header += [] if "spacing" in without else [f"spacings: {' '.join(map(repr, image.spacing))}"]
    if image.is_series:
        header.append("axis 3 index values:=" + " ".join(map(repr, image.times)))
    if not hidden_is_outside:  # grey values have no names
        header += _segments(image)
    with open(path, "wb") as file:
        file.write(("\n".join(header) + "\n\n").encode())
        masks = image.mask if image.is_series else None if image.mask is None else image.mask[numpy.newaxis]
        for number, frame in enumerate(voxels if image.is_series else voxels[numpy.newaxis]):
            if masks is not None:
                frame = numpy.where(masks[number], voxels.dtype.type(outside), frame)
            file.write(numpy.ascontiguousarray(frame).data)


def _segments(image: Image) -> List[str]:
    """Names and colours as 3D Slicer writes them."""
    check_names(image.names)
    lines = []
    for number, (label, name) in enumerate(sorted(image.names.items())):
        if name.strip() and not IS_NO_TEXT.search(name):
            key = f"Segment{number}_"
            lines += [f"{key}ID:=Segment_{label}", f"{key}LabelValue:={label}", f"{key}Layer:=0",
                      f"{key}Name:=" + name.replace("\\", "\\\\")]
            if label in image.colors:
                lines.append(f"{key}Color:={' '.join(repr(float(part)) for part in image.colors[label])}")
    return lines


def read_nrrd(path: str) -> Image:
    """Reads what `voxplex image` writes."""
    with open(path, "rb") as file:
        lines = iter(lambda: file.readline().decode(errors="replace").rstrip("\n"), "")
        pairs = dict(re.split(":=|: ", line, maxsplit=1) for line in lines if not line.startswith("NRRD"))
        shape = [int(size) for size in reversed(pairs["sizes"].split())]
        dtype = {"float": "float32", "double": "float64"}.get(pairs["type"], pairs["type"])
        voxels = numpy.fromfile(file, dtype=dtype).reshape(shape)
    spacing, direction = apart(numpy.array([_point(text) for text in pairs["space directions"].split()[:3]]).T)
    times = pairs.get("axis 3 index values")
    image = Image(voxels, spacing=spacing, origin=_point(pairs["space origin"]), direction=direction,
                  times=None if times is None else [float(t) for t in times.split()],
                  space="LPS" if pairs["space"] == _SPACES["LPS"] else "RAS")
    for segment in [key[:-len("ID")] for key in pairs if re.fullmatch(r"Segment\d+_ID", key)]:
        label = int(pairs[segment + "LabelValue"])
        image.names[label] = pairs[segment + "Name"]
        if segment + "Color" in pairs:
            image.colors[label] = [float(part) for part in pairs[segment + "Color"].split()]
    return image


def _point(text: str) -> List[float]:
    return [float(number) for number in text.strip("()").split(",")]


def place_of(spacing: Optional[ArrayLike], origin: Optional[ArrayLike], direction: Optional[ArrayLike],
             affine: Optional[ArrayLike] = None) -> Dict[str, Any]:
    """What is given of the place of an image."""
    values: Dict[str, Any] = {}
    if spacing is not None:
        values["spacing"] = spacing_of(spacing)
    if origin is not None:
        values["origin"] = origin_of(origin)
    if direction is not None:
        values["direction"] = direction_of(direction)
    if affine is not None:
        if values:
            raise ValueError(f"{', '.join(values)}: not with affine, which has all of the place")
        matrix = numpy.asarray(affine, dtype=float)
        if matrix.shape != (4, 4) or not numpy.isfinite(matrix).all() or (matrix[3] != (0, 0, 0, 1)).any() \
                or numpy.linalg.matrix_rank(matrix) < 4:
            raise ValueError("affine must be a matrix of 4 x 4 finite numbers with independent columns and the last row 0, 0, 0, 1, "
                             f"not {matrix.tolist()}")
        values["affine"] = matrix
    return values


def in_space(place: Mapping[str, Any], space: str) -> Dict[str, Any]:
    """With spacing, origin and direction in place of an affine, which is in RAS."""
    if "affine" not in place:
        return dict(place)
    columns = place["affine"][:3] if space == "RAS" else place["affine"][:3] * [[-1.0], [-1.0], [1.0]]
    spacing, direction = apart(columns[:, :3])
    return {"spacing": [float(length) for length in spacing], "origin": [float(x) for x in columns[:, 3]], "direction": direction}


def apart(columns: NDArray[Any]) -> Tuple[NDArray[numpy.float64], NDArray[numpy.float64]]:
    """Spacing and direction of steps from voxel to voxel."""
    lengths = numpy.linalg.norm(columns, axis=0)
    return lengths, columns / lengths


def with_unit_directions(spacing: ArrayLike, direction: NDArray[Any]) -> Tuple[ArrayLike, NDArray[numpy.float64]]:
    """Spacing and direction of VTK or ITK, which take directions of any length: it belongs to the spacing."""
    lengths = numpy.linalg.norm(direction, axis=0)
    is_off = (abs(lengths - 1.0) > _ROUNDED).any() and lengths.all()
    return apart(direction * spacing) if is_off else (spacing, direction)


def spacing_of(values: ArrayLike) -> List[float]:
    lengths = _numbers(values, 3, "spacing")
    if not all(0 < length < math.inf for length in lengths):
        raise ValueError(f"spacing is {lengths}; lengths must be positive and finite")
    return lengths


def origin_of(values: ArrayLike) -> List[float]:
    coordinates = _numbers(values, 3, "origin")
    if not all(map(math.isfinite, coordinates)):
        raise ValueError(f"origin is {coordinates}; coordinates must be finite")
    return coordinates


def direction_of(values: ArrayLike) -> NDArray[numpy.float64]:
    matrix = _numbers(values, 9, "direction")
    result = numpy.array(matrix).reshape(3, 3)
    if not numpy.isfinite(result).all() or numpy.linalg.matrix_rank(result) < 3:
        raise ValueError(f"direction is {matrix}; its columns must be independent")
    lengths = numpy.linalg.norm(result, axis=0)
    if (abs(lengths - 1.0) > _ROUNDED).any():
        raise ValueError("direction: its columns must have the length 1, and they have "
                         + ", ".join(f"{length:.6g}" for length in lengths) + "; if it is a part of an affine, pass the whole as affine=")
    return result


def space_of(space: str) -> str:
    if space not in ("LPS", "RAS"):
        raise ValueError(f"space is {space!r}, not 'LPS' or 'RAS'")
    return space


def _numbers(values: ArrayLike, count: int, what: str) -> List[float]:
    result = numpy.asarray(values, dtype=float).reshape(-1)
    if result.size != count:
        raise ValueError(f"{what} has {result.size} numbers, not {count}")
    return [float(value) for value in result]


def _unmasked(array: ArrayLike) -> Tuple[NDArray[Any], Optional[NDArray[numpy.bool_]]]:
    """The values of an array, and its mask; None without masked voxels."""
    voxels = _MASKED.asanyarray(array)
    return voxels.data, _MASKED.getmaskarray(voxels) if _MASKED.is_masked(voxels) else None


def _stored(voxels: NDArray[Any]) -> NDArray[Any]:
    """In a type that NRRD has."""
    kind, size = voxels.dtype.kind, voxels.dtype.itemsize
    if kind == "b":
        return voxels.view(numpy.uint8)
    if kind == "f" and size not in (4, 8):
        return voxels.astype(numpy.float32 if size < 4 else numpy.float64)
    return voxels.astype(voxels.dtype.newbyteorder("<"), copy=False)
