# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Images in memory, and what mesh() takes for one.

Arrays are indexed [k, j, i] with i, the first axis of the image, running fastest in memory: the order
of SimpleITK's GetArrayFromImage() and of ITK's. An array indexed [i, j, k], as nibabel's, is passed
transposed: `array.T`. Spacing, origin and direction are in the order (x, y, z) of SimpleITK's
GetSpacing(), GetOrigin() and GetDirection().
"""

from __future__ import annotations

import math
import os
import re
from typing import Any, Dict, List, Mapping, Optional, Sequence, Tuple, Union

import numpy
from numpy.typing import ArrayLike, NDArray

from .fields import Fields, HasFields

_SPACES = {"LPS": "left-posterior-superior", "RAS": "right-anterior-superior"}
# NumPy has types for a part of it only.
_MASKED: Any = numpy.ma

Path = Union[str, "os.PathLike[str]"]


class Image(HasFields):
    """A label image, one of grey values, or a time series of such images, with its place.

    voxels: an array indexed [k, j, i], or [t, k, j, i] of a time series. One label a voxel, 0 is background, or one
        grey value. Any integer or real type, or bool. Masked voxels (numpy.ma) are background, and outside of
        isosurfaces. The array is kept, not copied.
    spacing: the distances of voxels along i, j and k.
    origin: where voxel (0, 0, 0) lies.
    direction: a 3 x 3 matrix (or its 9 numbers, row by row), whose columns are the directions of i, j and k; by
        default the axes.
    times: of the frames, increasing; by default 0, 1, 2 ...
    names: of labels, by value.
    space: "LPS" or "RAS", the coordinates that these are in, if it is known.

    The attributes have the same names. `field_data` has what meshes inherit: the names as arrays, SPACE, and what a
    VTK image had.

    Raises ValueError for shapes and numbers that do not fit. A uint8 array of four dimensions whose last axis has the
    length 3 or 4 is taken for a stack of coloured pictures, and refused, unless there are times.

    >>> import numpy
    >>> Image(numpy.zeros((20, 32, 32), dtype=numpy.uint8), spacing=(0.5, 0.5, 1.0))
    Image of 32 x 32 x 20 voxels, uint8
    """

    def __init__(self, voxels: ArrayLike, *, spacing: ArrayLike = (1.0, 1.0, 1.0),
                 origin: ArrayLike = (0.0, 0.0, 0.0), direction: Optional[ArrayLike] = None,
                 times: Optional[ArrayLike] = None, names: Optional[Mapping[int, str]] = None,
                 space: Optional[str] = None) -> None:
        self.voxels, self.mask = _unmasked(voxels)
        if self.voxels.size == 0:
            raise ValueError(f"the array has the shape {self.voxels.shape}: there are no voxels")
        if self.voxels.ndim not in (3, 4):
            raise ValueError(f"the array has {self.voxels.ndim} dimensions, not 3 ([k, j, i]) or 4 ([t, k, j, i])")
        if self.voxels.dtype.kind not in "biuf":
            raise ValueError(f"the array has elements of type {self.voxels.dtype}, which are not numbers")
        self.spacing = spacing_of(spacing)
        self.origin = origin_of(origin)
        self.direction = direction_of(numpy.eye(3) if direction is None else direction)
        self._known: Optional[List[str]] = None  # what is given of the place of a bare array
        self.times = self._times(times)
        self.field_data: Fields = {}
        if names:
            self.names = dict(names)
        if space is not None:
            self.field_data["SPACE"] = [space_of(space)]

    def __repr__(self) -> str:
        shape = " x ".join(map(str, reversed(self.voxels.shape[-3:])))
        frames = f"{len(self.voxels)} frames of " if self.is_series else ""
        return f"Image of {frames}{shape} voxels, {self.voxels.dtype}"

    @property
    def is_series(self) -> bool:
        """Whether it has time frames."""
        return self.voxels.ndim == 4

    def to_vtk(self) -> Any:
        """A vtkImageData that shares the voxels; of a time series a list of them, each with its time."""
        from .vtkdata import image_to_vtk
        return image_to_vtk(self)

    @staticmethod
    def from_vtk(data: Any, times: Optional[ArrayLike] = None) -> Image:
        """Of a vtkImageData, a list of them (a time series), or a VTK algorithm whose first output is the image.

        Several components are frames if there are times for them: they may as well be colours.
        """
        if isinstance(data, (list, tuple)):
            return _series(data, {}, times)
        from .vtkdata import image_from_vtk
        return image_from_vtk(data, times)

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


def image_of(image: Any, geometry: Mapping[str, Any], times: Optional[ArrayLike]) -> Union[Image, List[str]]:
    """What mesh() takes for an image: an Image, or the path of a file, or those of masks."""
    if isinstance(image, Mapping):
        if times is not None:
            raise ValueError("times: not with a dictionary of masks; give a list of dictionaries for frames")
        from .files import read_segmentation
        check_shapes(image)
        masks = {name: mask if isinstance(mask, (str, os.PathLike)) and not geometry else single_image(mask, geometry)
                 for name, mask in image.items()}
        return read_segmentation(masks, space="RAS" if any(getattr(mask, "space", "") == "RAS" for mask in masks.values()) else "LPS")
    if isinstance(image, (str, os.PathLike)):
        return [os.fsdecode(image)]
    if isinstance(image, (list, tuple)) and image and times is None and all(isinstance(one, (str, os.PathLike)) for one in image):
        return [os.fsdecode(one) for one in image]
    kind = type(image).__module__.partition(".")[0]
    has_place = isinstance(image, Image) or hasattr(image, "IsA") or kind in ("SimpleITK", "itk", "nibabel")
    if geometry and has_place:
        raise ValueError(f"{', '.join(geometry)}: only for arrays and files; the image has its own")
    if isinstance(image, Image):
        return image if times is None else _at_times(image, times)
    if hasattr(image, "IsA"):
        return Image.from_vtk(image, times)
    if kind in ("SimpleITK", "itk"):
        return _from_itk(image, times)
    if kind == "nibabel":
        return _from_nibabel(image, times)
    if hasattr(image, "__array__"):
        result = Image(_MASKED.asanyarray(image), times=times, **geometry)
        result._known = list(geometry)
        return result
    if isinstance(image, (list, tuple)) and image and not isinstance(image[0], (int, float, list, tuple)):
        return _series(image, geometry, times)
    raise TypeError("image must be an array, a path, a voxplex.Image, an image of VTK, PyVista, ITK, SimpleITK or nibabel, or "
                    f"a list or a dictionary of these (not empty), not {type(image).__name__}")


def check_shapes(masks: Mapping[str, Any]) -> None:
    """Arrays have no place that would tell where a smaller one lies."""
    shapes = sorted({mask.shape for mask in masks.values() if isinstance(mask, numpy.ndarray) and mask.ndim == 3})
    if len(shapes) > 1:
        raise ValueError(f"masks that are arrays have different shapes: {shapes[0]} and {shapes[1]}; give images with their place")


def single_image(image: Any, geometry: Mapping[str, Any]) -> Image:
    """What image_of() takes, read if it is in a file."""
    from .files import read_segmentation
    found = image_of(image, geometry, None)
    return found if isinstance(found, Image) else read_segmentation(found, **geometry)


def _series(frames: Sequence[Any], geometry: Mapping[str, Any], times: Optional[ArrayLike]) -> Image:
    """A time series of single images, which must lie at the same place."""
    if any(isinstance(frame, Mapping) for frame in frames) and \
            not all(isinstance(frame, Mapping) and list(frame) == list(frames[0]) for frame in frames):
        raise ValueError("frames that are dictionaries of masks must have the same names, in the same order")
    images = [single_image(frame, geometry) for frame in frames]
    first = images[0]
    for number, image in enumerate(images):
        if image.is_series:
            raise ValueError(f"frame {number} is a time series itself")
        if image.voxels.shape != first.voxels.shape:
            raise ValueError(f"the frames have different shapes: {first.voxels.shape} and {image.voxels.shape}")
        if (image.spacing, image.origin, image.space) != (first.spacing, first.origin, first.space) or \
                not numpy.array_equal(image.direction, first.direction):
            raise ValueError(f"frame {number} does not lie where frame 0 lies: spacing, origin, direction or space differ")
    if times is None and hasattr(frames[0], "IsA"):
        from .vtkdata import frame_times
        times = frame_times(frames)
    masks = [image.mask for image in images]
    result = Image(numpy.stack([image.voxels for image in images]), spacing=first.spacing, origin=first.origin,
                   direction=first.direction, times=range(len(images)) if times is None else times)
    if any(mask is not None for mask in masks):
        result.mask = numpy.stack([numpy.zeros(first.voxels.shape, bool) if mask is None else mask for mask in masks])
    result.field_data = first.field_data
    if isinstance(frames[0], Mapping):
        result.names = dict(enumerate(frames[0], 1))  # also of masks that are empty at first
    return result


def lies_somewhere(image: Image) -> bool:
    """Whether it has a place, which a bare array has not."""
    return image._known is None or "origin" in image._known or "direction" in image._known


def write_nrrd(image: Image, path: str, hidden_is_outside: bool, space: str = "LPS", is_placed: bool = True) -> None:
    """Writes an image as the program reads it; masked voxels become NaN if they are outside of isosurfaces, else 0.

    is_placed: otherwise the file has the spacing alone, if it was given."""
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
    if not is_placed:
        header = [line for line in header if not line.startswith("space")]
        header += [f"spacings: {' '.join(map(repr, image.spacing))}"] * ("spacing" in (image._known or []))
    with open(path, "wb") as file:
        file.write(("\n".join(header) + "\n\n").encode())
        masks = image.mask if image.is_series else None if image.mask is None else image.mask[numpy.newaxis]
        for number, frame in enumerate(voxels if image.is_series else voxels[numpy.newaxis]):
            if masks is not None:
                frame = numpy.where(masks[number], voxels.dtype.type(outside), frame)
            file.write(numpy.ascontiguousarray(frame).data)


def read_nrrd(path: str) -> Image:
    """Reads what the program writes with --save-image."""
    with open(path, "rb") as file:
        lines = iter(lambda: file.readline().decode(errors="replace").rstrip("\n"), "")
        pairs = dict(re.split(":=|: ", line, maxsplit=1) for line in lines if not line.startswith("NRRD"))
        shape = [int(size) for size in reversed(pairs["sizes"].split())]
        dtype = {"float": "float32", "double": "float64"}.get(pairs["type"], pairs["type"])
        voxels = numpy.fromfile(file, dtype=dtype).reshape(shape)
    columns = [_point(text) for text in pairs["space directions"].split()[:3]]
    spacing = [math.sqrt(sum(x * x for x in column)) for column in columns]
    times = pairs.get("axis 3 index values")
    image = Image(voxels, spacing=spacing, origin=_point(pairs["space origin"]),
                  direction=numpy.array(columns).T / spacing, times=None if times is None else [float(t) for t in times.split()],
                  space="LPS" if pairs["space"] == _SPACES["LPS"] else "RAS")
    segments = [key[:-len("ID")] for key in pairs if re.fullmatch(r"Segment\d+_ID", key)]
    image.names = {int(pairs[segment + "LabelValue"]): pairs[segment + "Name"] for segment in segments}
    if segments:
        colors = [pairs.get(segment + "Color", "nan nan nan").split() for segment in segments]
        image.field_data["LabelColors"] = numpy.array(colors, dtype=float)
    return image


def _point(text: str) -> List[float]:
    return [float(number) for number in text.strip("()").split(",")]


def place_of(spacing: Optional[ArrayLike], origin: Optional[ArrayLike],
             direction: Optional[ArrayLike]) -> Dict[str, Any]:
    """What is given of the place of an image."""
    values: Dict[str, Any] = {}
    if spacing is not None:
        values["spacing"] = spacing_of(spacing)
    if origin is not None:
        values["origin"] = origin_of(origin)
    if direction is not None:
        values["direction"] = direction_of(direction)
    return values


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


def _at_times(image: Image, times: ArrayLike) -> Image:
    result = Image(image.voxels, spacing=image.spacing, origin=image.origin, direction=image.direction, times=times)
    result.mask, result.field_data = image.mask, image.field_data
    return result


def from_components(voxels: NDArray[Any], mask: Optional[NDArray[numpy.bool_]], times: Optional[ArrayLike],
                    place: Mapping[str, Any]) -> Image:
    """Of an array indexed [k, j, i] or, of several components, [k, j, i, component]: frames, if there are times."""
    if voxels.ndim == 4:
        if times is None:
            raise ValueError(f"the image has {voxels.shape[3]} components in each voxel: if they are time frames, pass "
                             "their times (times=[0, 1, ...]); of colours or vectors, extract one component, or make "
                             "labels of them")
        voxels = numpy.moveaxis(voxels, -1, 0)
        mask = None if mask is None else numpy.broadcast_to(mask, voxels.shape)
    image = Image(voxels, times=times, **place)
    image.mask = mask
    return image


def _from_itk(image: Any, times: Optional[ArrayLike]) -> Image:
    """Of ITK or SimpleITK. The fourth axis of an image of four dimensions is time."""
    if type(image).__module__.startswith("SimpleITK"):
        import SimpleITK
        dimension = image.GetDimension()
        components = image.GetNumberOfComponentsPerPixel()
        voxels = SimpleITK.GetArrayViewFromImage(image)
        direction = numpy.reshape(image.GetDirection(), (dimension, dimension))
    else:
        import itk
        dimension = image.GetImageDimension()
        components = image.GetNumberOfComponentsPerPixel()
        voxels = itk.array_view_from_image(image)
        direction = itk.array_from_matrix(image.GetDirection())
    if dimension not in (3, 4) or dimension == 4 and components > 1:
        raise ValueError(f"the image has {dimension} dimensions and {components} components in each voxel; images of three "
                         "dimensions are meshed, and of four with one component")
    spacing, origin = list(image.GetSpacing()), list(image.GetOrigin())
    place: Dict[str, Any] = {"spacing": spacing[:3], "origin": origin[:3], "direction": direction[:3, :3], "space": "LPS"}
    if dimension == 4:
        return Image(voxels, times=times if times is not None else
                     [origin[3] + frame * spacing[3] for frame in range(voxels.shape[0])], **place)
    return from_components(voxels, None, times, place)


def _from_nibabel(image: Any, times: Optional[ArrayLike]) -> Image:
    """Of nibabel, whose arrays are indexed [i, j, k], and whose affine is in RAS."""
    voxels = numpy.asanyarray(image.dataobj).T
    units = image.header.get_xyzt_units() if hasattr(image.header, "get_xyzt_units") else ("mm", "sec")
    length, duration = ({"meter": 1e3, "micron": 1e-3, "msec": 1e-3, "usec": 1e-6}.get(unit, 1.0) for unit in units)
    affine = numpy.diag((-length, -length, length, 1.0)) @ image.affine
    spacing = numpy.linalg.norm(affine[:3, :3], axis=0)
    if times is None and voxels.ndim == 4:
        step = float(image.header.get_zooms()[3]) or 1.0
        first = float(image.header["toffset"]) if "toffset" in image.header else 0.0
        times = [duration * (first + step * frame) for frame in range(len(voxels))]
    return Image(voxels, spacing=spacing, origin=affine[:3, 3], direction=affine[:3, :3] / spacing, times=times, space="LPS")
