# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""NumPy arrays as vtkImageData and back, without copying voxels.

Arrays are indexed [k, j, i] with i, the first axis of the image, running fastest in memory: the order
of SimpleITK's GetArrayFromImage() and of ITK's. An array indexed [i, j, k], as nibabel's, is passed
transposed: `array.T`. Spacing, origin and direction are in the order (x, y, z) of SimpleITK's
GetSpacing(), GetOrigin() and GetDirection().
"""

from __future__ import annotations

from typing import Any, List, Optional, Sequence, Tuple, Union

import numpy
from numpy.typing import ArrayLike, NDArray
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkDataArray, vtkStringArray
from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkDataSetAttributes, vtkImageData

# NumPy has types for a part of it only.
_MASKED: Any = numpy.ma


def image_from_array(array: ArrayLike, *, spacing: Sequence[float] = (1.0, 1.0, 1.0),
                     origin: Sequence[float] = (0.0, 0.0, 0.0), direction: Optional[ArrayLike] = None,
                     space: Optional[str] = None) -> vtkImageData:
    """An image with the voxels of an array of three dimensions.

    array: indexed [k, j, i], one label a voxel, 0 is background, or one grey value. Any integer or real
        type, or bool. Masked voxels (numpy.ma) are background: 0, or NaN in arrays of real numbers, and
        hidden from VTK (`vtkGhostType`), so that they are outside of isosurfaces, too.
    spacing: the distances of voxels along i, j and k.
    origin: where voxel (0, 0, 0) lies.
    direction: a 3 x 3 matrix (or its 9 numbers, row by row), whose columns are the directions of
        i, j and k; by default the axes.
    space: "LPS" or "RAS", the coordinates that these are in, if it is known.

    The image refers to the array's memory, and keeps it alive, if the array is contiguous, in the
    machine's byte order and without masked voxels; otherwise it has a copy. Raises ValueError for
    shapes that do not fit.

    >>> import numpy
    >>> labels = numpy.zeros((20, 32, 32), dtype=numpy.uint8)
    >>> image = image_from_array(labels, spacing=(0.5, 0.5, 1.0))
    >>> image.GetDimensions()
    (32, 32, 20)
    """
    voxels, mask = _unmasked(array)
    if voxels.ndim != 3:
        raise ValueError(f"the array has {voxels.ndim} dimensions, not 3 ([k, j, i])")
    if voxels.dtype == numpy.bool_:
        voxels = voxels.view(numpy.uint8)
    if voxels.dtype.kind not in "iuf":
        raise ValueError(f"the array has elements of type {voxels.dtype}, which are not numbers")
    voxels = numpy.ascontiguousarray(voxels, dtype=voxels.dtype.newbyteorder("="))
    image = vtkImageData()
    image.SetDimensions(voxels.shape[2], voxels.shape[1], voxels.shape[0])
    image.SetSpacing(*_numbers(spacing, 3, "spacing"))
    image.SetOrigin(*_numbers(origin, 3, "origin"))
    if direction is not None:
        image.SetDirectionMatrix(*_numbers(direction, 9, "direction"))
    if voxels.size:
        scalars = _share(voxels.reshape(-1))
        scalars.SetName("Labels")
        image.GetPointData().SetScalars(scalars)
    if mask is not None:
        hidden = _share(numpy.where(mask.reshape(-1), numpy.uint8(vtkDataSetAttributes.HIDDENPOINT), numpy.uint8(0)))
        hidden.SetName(vtkDataSetAttributes.GhostArrayName())
        image.GetPointData().AddArray(hidden)
    if space is not None:
        _set_space(image, space)
    return image


def images_from_array(array: ArrayLike, *, times: Optional[Sequence[float]] = None,
                      **geometry: Any) -> List[vtkImageData]:
    """The frames of an array of four dimensions, indexed [t, k, j, i], as images.

    times: the time of each frame, by default 0, 1, 2 ... Further arguments are those of
    :func:`image_from_array`, for every frame. The result is what :func:`mesh` makes pentatopes from.

    Raises ValueError for shapes that do not fit. A uint8 array whose last axis has the length 3 or 4 is taken for a
    stack of coloured pictures, and refused, unless there are times.
    """
    voxels = _MASKED.asanyarray(array)  # of a list of masked arrays, too
    if voxels.ndim != 4:
        raise ValueError(f"the array has {voxels.ndim} dimensions, not 4 ([t, k, j, i])")
    if times is None and voxels.dtype == numpy.uint8 and voxels.shape[3] in (3, 4):
        raise ValueError(f"the array has the shape {voxels.shape}, as pictures with colours have: make labels of them; "
                         "if it is indexed [t, k, j, i], pass times=")
    frames = [image_from_array(frame, **geometry) for frame in voxels]
    if times is not None:
        set_times(frames, times)
    return frames


def array_from_image(image: vtkImageData) -> NDArray[Any]:
    """The labels of an image as an array indexed [k, j, i], which shares the image's memory.

    An image with several components (time frames) gives [k, j, i, component]. Raises ValueError if the
    image has no active point scalars.
    """
    scalars = image.GetPointData().GetScalars()
    if scalars is None:
        raise ValueError("the image has no active point scalars")
    shape = tuple(reversed(image.GetDimensions()))
    components = scalars.GetNumberOfComponents()
    return vtk_to_numpy(scalars).reshape(shape if components == 1 else shape + (components,))


def set_times(frames: Sequence[vtkImageData], times: Sequence[float]) -> None:
    """Notes the time of each frame in its information (DATA_TIME_STEP), where VTK's readers note it."""
    if len(times) != len(frames):
        raise ValueError(f"there are {len(frames)} frames, and {len(times)} times")
    for frame, time in zip(frames, times):
        frame.GetInformation().Set(vtkDataObject.DATA_TIME_STEP(), float(time))


def _unmasked(array: ArrayLike) -> Tuple[NDArray[Any], Optional[NDArray[numpy.bool_]]]:
    """The array with masked voxels set to background, and its mask; without masked voxels the array itself and None."""
    voxels = _MASKED.asanyarray(array)
    if not _MASKED.is_masked(voxels):
        return voxels.data, None
    return voxels.filled(numpy.nan if voxels.dtype.kind == "f" else 0), _MASKED.getmaskarray(voxels)


def _share(values: NDArray[Any]) -> vtkDataArray:
    """A VTK array over the memory of a NumPy array, which it keeps alive for as long as it lives itself.

    numpy_to_vtk() leaves that to an attribute of the Python object, which VTK keeps longer than the
    array. An observer dies with the array.
    """
    result = numpy_to_vtk(values)
    del result._numpy_reference

    def owner(_caller: Any, _event: str, memory: NDArray[Any] = values) -> NDArray[Any]:
        return memory

    result.AddObserver("UserEvent", owner)
    return result


def _numbers(values: ArrayLike, count: int, what: str) -> List[float]:
    result = numpy.asarray(values, dtype=float).reshape(-1)
    if result.size != count:
        raise ValueError(f"{what} has {result.size} numbers, not {count}")
    return [float(value) for value in result]


def _set_space(data: Union[vtkImageData, vtkDataObject], space: str) -> None:
    if space not in ("LPS", "RAS"):
        raise ValueError(f"space is {space!r}, not 'LPS' or 'RAS'")
    array = vtkStringArray()
    array.SetName("SPACE")
    array.InsertNextValue(space)
    data.GetFieldData().AddArray(array)
