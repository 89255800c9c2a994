# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""What mesh() takes for an image: arrays, files, masks, and images of other libraries."""

from __future__ import annotations

import copy
import os
from typing import TYPE_CHECKING, Any, Dict, List, Mapping, Optional, Sequence, Union

import numpy
from numpy.typing import ArrayLike

from . import program
from .files import Path, existing, input_options, number_list, number_text, temporary_folder
from .images import (IS_NO_TEXT, Image, at_times, from_components, in_space, joined, place_of, read_nrrd, space_of, with_unit_directions,
                     write_nrrd)

if TYPE_CHECKING:
    from typing import Literal

Source = Union[Image, List[str]]
"""An image in memory, or the path of a file, or those of masks."""

_PLACE = ("spacing", "origin", "direction", "affine")
_OF_MASKS = ("space", "overlap", "mask_threshold", "resample_masks", "data_files_anywhere")
_OF_FILES = ("series_uid", "label_table")
READING = (*_PLACE, *_OF_MASKS, *_OF_FILES)
"""How an image is read: arguments of mesh(), repair() and read_segmentation()."""
_MASKED: Any = numpy.ma  # NumPy has types for a part of it only


def read_segmentation(path: Union[Path, Sequence[Path], Mapping[str, Any]], *, space: Optional[Literal["LPS", "RAS"]] = None,
                      series_uid: Optional[str] = None, overlap: Optional[Literal["smallest", "order"]] = None,
                      mask_threshold: Optional[float] = None, resample_masks: Optional[bool] = None,
                      label_table: Optional[Path] = None, spacing: Optional[ArrayLike] = None, origin: Optional[ArrayLike] = None,
                      direction: Optional[ArrayLike] = None, affine: Optional[ArrayLike] = None,
                      data_files_anywhere: Optional[bool] = None) -> Image:
    """Reads a label image, or a time series of them, with its place in space and the names of its labels.

    Parameters
    ----------
    path : path-like, sequence of path-like, or dict
        A file (NRRD, NIfTI, MetaImage, DICOM, TIFF, VTK, MGH, GIPL, MRC), or a folder with a DICOM series. Several files, or
        a folder of them, are masks, one for each structure: they become labels 1, 2, ... with the names of their files. So do
        masks of a dictionary, by name, each an array or another image that :func:`mesh` takes, or a file.
    space : {"LPS", "RAS"}, optional
        The coordinates of the image, those of DICOM and ITK (LPS, the default) or those of NIfTI (RAS).
    series_uid : str, optional
        Which series, if the folder holds several.
    overlap : {"smallest", "order"}, optional
        Which of the masks that have a voxel gets it: the smallest (the default; of equals the first), or the first in order.
        Also of segments of a .seg.nrrd file, and of DICOM segmentations.
    mask_threshold : float, optional
        Above which probabilities, from 0 to 1, are inside: of masks, and of DICOM segmentations. Default 0.5.
    resample_masks : bool, optional
        Whether masks whose voxels differ are resampled to that with the smallest voxels, by nearest neighbour, and not
        refused.
    label_table : path-like, optional
        A text file with the names and colours of labels, if the image has none itself.
    spacing, origin, direction, affine : array_like, optional
        In place of what the file says, for formats that do not know them (TIFF), as for :class:`Image`. Origin and direction
        are in the coordinates of space, an affine is in RAS and converted to them. Of a dictionary: of its arrays and files.
    data_files_anywhere : bool, optional
        Whether the header of an image (.nhdr, .mhd, .hdr) may name data files that are not in its folder or below. Only for
        headers that you trust.

    Returns
    -------
    Image

    Raises
    ------
    FileNotFoundError
        There is no such file.
    FileError
        The file cannot be read. It is an OSError.
    ValueError
        Spacing, origin, direction or affine is none.
    """
    given = reading_of(locals())
    if isinstance(path, Mapping):
        return _join_masks(path, given, None, "LPS")
    return _read(path, given)


def reading_of(arguments: Mapping[str, Any]) -> Dict[str, Any]:
    """Of a function's arguments those that say how an image is read, checked."""
    given = {name: value for name, value in arguments.items() if name in READING and value is not None}
    place = place_of(*map(given.get, _PLACE))
    if "space" in given:
        space_of(given["space"])
    return {**given, **place}


def image_of(image: Any, reading: Mapping[str, Any], times: Optional[ArrayLike], scalars: Optional[str] = None) -> Source:
    """What mesh() takes for an image. Raises ValueError for ways of reading that do not apply to it."""
    _check_reading(image, reading)
    if scalars is not None and not hasattr(image, "IsA") and not isinstance(image, (list, tuple, Mapping)):
        raise ValueError("scalars: only for images of VTK and PyVista")
    if isinstance(image, Mapping):
        if times is not None:
            raise ValueError("times: not with a dictionary of masks; give a list of dictionaries for frames")
        return _join_masks(image, reading, scalars)
    if _are_files(image) and (isinstance(image, (str, os.PathLike)) or times is None):
        return [os.fsdecode(image)] if isinstance(image, (str, os.PathLike)) else [os.fsdecode(one) for one in image]
    if isinstance(image, Image):
        return image if times is None else at_times(image, times)
    if hasattr(image, "IsA"):
        return Image.from_vtk(image, times, scalars)
    library = type(image).__module__.partition(".")[0]
    if library in ("SimpleITK", "itk"):
        return _from_itk(image, times)
    if library == "nibabel":
        return _from_nibabel(image, times)
    if hasattr(image, "__array__"):
        place = {name: reading[name] for name in (*_PLACE, "space") if name in reading}
        return Image(_MASKED.asanyarray(image), times=times, **place)
    if isinstance(image, (list, tuple)) and image and not isinstance(image[0], (int, float, list, tuple)):
        return _series(image, reading, times, scalars)
    raise TypeError("image must be an array, a path, a voxplex.Image, an image of VTK, PyVista, ITK, SimpleITK or nibabel, or "
                    f"a list or a dictionary of these (not empty), not {type(image).__name__}")


def input_of(source: Source, folder: str, hidden_is_outside: bool, reading: Mapping[str, Any], times: Optional[ArrayLike]) -> List[str]:
    """The options that name an image, which is written to the folder if it is in memory."""
    if isinstance(source, Image):
        path = os.path.join(folder, "image.nrrd")
        write_nrrd(source, path, hidden_is_outside)
        return ["--input=" + path, *number_list("frame-times", source.times)]
    return [*input_options(source), *_reading_options(reading), *number_list("frame-times", [] if times is None else numpy.ravel(times))]


def _are_files(image: Any) -> bool:
    some = image if isinstance(image, (list, tuple)) else [image]
    return bool(some) and all(isinstance(one, (str, os.PathLike)) for one in some)


def _has_place(image: Any) -> bool:
    library = type(image).__module__.partition(".")[0]
    return isinstance(image, Image) or hasattr(image, "IsA") or library in ("SimpleITK", "itk", "nibabel")


def _check_reading(image: Any, reading: Mapping[str, Any]) -> None:
    """Frames are looked at one by one."""
    if _are_files(image) or isinstance(image, (list, tuple)):
        return
    is_masks = isinstance(image, Mapping)
    for names, is_right, why in (((*_PLACE, "space"), not _has_place(image), "only for arrays and files; the image has its own"),
                                 (_OF_MASKS[1:], is_masks, "only for files and masks"), (_OF_FILES, False, "only for files")):
        wrong = [name for name in reading if name in names]
        if wrong and not is_right:
            raise ValueError(f"{', '.join(wrong)}: {why}")


def _reading_options(reading: Mapping[str, Any]) -> List[str]:
    """The options for what reading_of() returns."""
    space = reading.get("space", "LPS")
    options = ["--space=" + space.lower()]
    for name, values in in_space({name: reading[name] for name in _PLACE if name in reading}, space).items():
        options += number_list(name, numpy.reshape(values, -1))
    if "mask_threshold" in reading:
        options.append("--mask-threshold=" + number_text(reading["mask_threshold"]))
    if "label_table" in reading:
        options.append("--label-table=" + existing(reading["label_table"]))
    options += [f"--{option}={reading[name]}" for name, option in (("overlap", "overlap"), ("series_uid", "series")) if name in reading]
    return options + [flag for name, flag in (("resample_masks", "--resample-masks"), ("data_files_anywhere", "--data-files-anywhere"))
                      if reading.get(name)]


def _read(paths: Union[Path, Sequence[Path]], reading: Mapping[str, Any]) -> Image:
    with temporary_folder() as folder:
        image = os.path.join(folder, "image.nrrd")
        program.run(["image", *input_options(paths), *_reading_options(reading), "--output=" + image])
        return read_nrrd(image)


def _single(image: Any, reading: Mapping[str, Any], scalars: Optional[str]) -> Image:
    """A frame or a mask, read if it is in a file."""
    found = _read(image, reading) if _are_files(image) else image_of(image, reading, None, scalars)
    assert isinstance(found, Image)
    return found


def _join_masks(masks: Mapping[str, Any], reading: Mapping[str, Any], scalars: Optional[str], space: Optional[str] = None) -> Image:
    """Masks by name. space: if reading has none; without either they are in RAS if one of them is."""
    if not masks:
        raise ValueError("the dictionary of masks is empty")
    if any(name in reading for name in _OF_FILES):
        raise ValueError("label_table, series_uid: not with a dictionary of masks, which have names")
    shapes = sorted({mask.shape for mask in masks.values() if isinstance(mask, numpy.ndarray) and mask.ndim == 3})
    if len(shapes) > 1:  # arrays have no place that would tell where a smaller one lies
        raise ValueError(f"masks that are arrays have different shapes: {shapes[0]} and {shapes[1]}; give images with their place")
    for name in masks:
        if not isinstance(name, str) or not name.strip() or IS_NO_TEXT.search(name):
            raise ValueError(f"masks have names in one line of text, and none is called {name!r}")
    images: List[Union[str, Image]] = []
    has_place = any(name in reading for name in _PLACE)
    for mask in masks.values():
        if isinstance(mask, (str, os.PathLike)) and os.path.isfile(mask) and len(masks) > 1 and not has_place:
            images.append(os.fsdecode(mask))  # only the program knows what a file does not say
            continue
        names = (*_PLACE, "space", "data_files_anywhere") if _are_files(mask) else _PLACE  # arrays have no space of their own
        images.append(_single(mask, {name: reading[name] for name in names if name in reading}, scalars))
    spaces = {image.space if isinstance(image, Image) else "LPS" for image in images}
    space = reading.get("space") or space or ("RAS" if "RAS" in spaces else "LPS")
    own = space if has_place else "LPS"  # of images without a space
    # Arrays that lie nowhere are put where others of their size lie.
    unknown = [name for name in ("origin", "spacing") if name not in reading and "direction" not in reading]
    is_bare = [isinstance(image, Image) and not _are_files(mask) and not _has_place(mask) for mask, image in zip(masks.values(), images)]
    without = unknown if "origin" in unknown and not all(is_bare) else []
    with temporary_folder() as folder:
        table, result = os.path.join(folder, "names.csv"), os.path.join(folder, "image.nrrd")
        words, options = [(f"'{table}'", "the dictionary")], []
        for number, (name, image) in enumerate(zip(masks, images), 1):
            if isinstance(image, str):
                path = image
            else:
                path = os.path.join(folder, str(number), name.replace("/", "_")[:50] + ".nrrd")  # warnings show its name
                os.mkdir(os.path.dirname(path))
                mask = copy.copy(image)
                mask.names = {}
                write_nrrd(mask, path, False, image.space or own, without if is_bare[number - 1] else ())
            words.append((f"'{path}'", f"the mask {name!r}"))
            # A folder of one file is a mask, a file is none.
            options.append("--input=" + (path if len(masks) > 1 else os.path.dirname(path)))
        with open(table, "w", encoding="utf-8") as file:
            file.writelines('%d,"%s"\n' % (value, name.replace('"', '""')) for value, name in enumerate(masks, 1))
        rest = {name: value for name, value in reading.items() if name not in _PLACE}
        options += ["--label-table=" + table, *_reading_options({**rest, "space": space})]
        program.run(["image", *options, "--output=" + result], words=words)
        joint = read_nrrd(result)
    if spaces == {None} and "space" not in reading:
        joint.space = None
    return joint


def _series(frames: Sequence[Any], reading: Mapping[str, Any], times: Optional[ArrayLike], scalars: Optional[str]) -> Image:
    is_masks = isinstance(frames[0], Mapping)
    if any(isinstance(frame, Mapping) != is_masks or is_masks and list(frame) != list(frames[0]) for frame in frames):
        raise ValueError("frames that are dictionaries of masks must have the same names, in the same order")
    if times is None and hasattr(frames[0], "IsA"):
        from .vtkdata import frame_times
        times = frame_times(frames)
    result = joined([_single(frame, reading, scalars) for frame in frames], times)
    if is_masks:
        result.names = dict(enumerate(frames[0], 1))  # also of masks that are empty at first
    return result


def _from_itk(image: Any, times: Optional[ArrayLike]) -> Image:
    """Of ITK or SimpleITK. The fourth axis of an image of four dimensions is time."""
    components = image.GetNumberOfComponentsPerPixel()
    if type(image).__module__.startswith("SimpleITK"):
        import SimpleITK
        dimension = image.GetDimension()
        voxels = SimpleITK.GetArrayViewFromImage(image)
        direction = numpy.reshape(image.GetDirection(), (dimension, dimension))
    else:
        import itk
        dimension = image.GetImageDimension()
        voxels = itk.array_view_from_image(image)
        direction = itk.array_from_matrix(image.GetDirection())
    if dimension not in (3, 4) or dimension == 4 and components > 1:
        raise ValueError(f"the image has {dimension} dimensions and {components} components in each voxel; images of three "
                         "dimensions are meshed, and of four with one component")
    spacing, origin = list(image.GetSpacing()), list(image.GetOrigin())
    if dimension == 3:
        result = from_components(voxels, None, times, spacing, origin, direction)
    else:
        lengths, directions = with_unit_directions(spacing[:3], direction[:3, :3])
        result = Image(voxels, spacing=lengths, origin=origin[:3], direction=directions, times=times if times is not None else
                       [origin[3] + frame * spacing[3] for frame in range(voxels.shape[0])])
    result.space = "LPS"
    return result


def _from_nibabel(image: Any, times: Optional[ArrayLike]) -> Image:
    """Of nibabel, whose arrays are indexed [i, j, k], and whose affine is in RAS."""
    voxels = numpy.asanyarray(image.dataobj).T
    units = image.header.get_xyzt_units() if hasattr(image.header, "get_xyzt_units") else ("mm", "sec")
    length, duration = ({"meter": 1e3, "micron": 1e-3, "msec": 1e-3, "usec": 1e-6}.get(unit, 1.0) for unit in units)
    if times is None and voxels.ndim == 4:
        step = float(image.header.get_zooms()[3]) or 1.0
        first = float(image.header["toffset"]) if "toffset" in image.header else 0.0
        times = [duration * (first + step * frame) for frame in range(len(voxels))]
    return Image(voxels, affine=numpy.diag((length, length, length, 1.0)) @ image.affine, times=times)
