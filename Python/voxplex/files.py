# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Reading of segmentations, and meshes in files."""

from __future__ import annotations

import contextlib
import copy
import errno
import os
import re
import tempfile
from typing import TYPE_CHECKING, Any, Iterator, List, Mapping, Optional, Sequence, Tuple, Union

import numpy
from numpy.typing import ArrayLike

from . import program, xmlfiles
from .errors import FileError, MeshingError
from .images import Image, Path, check_shapes, lies_somewhere, place_of, read_nrrd, single_image, space_of, write_nrrd
from .meshes import Mesh

if TYPE_CHECKING:
    from typing import Literal

_IS_FULL = re.compile(r"(/voxplex-\w{8}/|cannot write the (image|mesh):).*(No space left|quota exceeded)", re.DOTALL)

_IS_NO_TEXT = re.compile(r"[\0-\x1f\x7f]")
NAMES = "names.csv"
"""What a table of names is called in a temporary folder."""


def read_segmentation(path: Union[Path, Sequence[Path], Mapping[str, Any]], *, space: Literal["LPS", "RAS"] = "LPS",
                      series_uid: Optional[str] = None, overlap: Literal["smallest", "order"] = "smallest",
                      mask_threshold: float = 0.5, resample_masks: bool = False, label_table: Optional[Path] = None,
                      spacing: Optional[ArrayLike] = None, origin: Optional[ArrayLike] = None,
                      direction: Optional[ArrayLike] = None, data_files_anywhere: bool = False) -> Image:
    """Reads a label image, or a time series of them, with its place in space and the names of its labels.

    path: a file (NRRD, NIfTI, MetaImage, DICOM, TIFF, VTK, MGH, GIPL, MRC), or a folder with a DICOM series. Several
        files, or a folder of them, are masks, one for each structure: they become labels 1, 2, ... with the names of their
        files. So do masks of a dictionary, by name, each an array or another image that :func:`mesh` takes, or a file.
        Arrays among other images lie where one of their size lies.
    space: the coordinates of the image, those of DICOM and ITK (LPS) or those of NIfTI (RAS).
    series_uid: which series, if the folder holds several.
    overlap: which of the masks that have a voxel gets it: the smallest (of equals the first), or the first in order.
        Also of segments of a .seg.nrrd file, and of DICOM segmentations.
    mask_threshold: above which probabilities, from 0 to 1, are inside: of masks, and of DICOM segmentations.
    resample_masks: whether masks whose voxels differ are resampled to that with the smallest voxels, by nearest
        neighbour, and not refused.
    label_table: a text file with the names and colours of labels, if the image has none itself.
    spacing, origin, direction: in place of what the file says, for formats that do not know them (TIFF), as for
        :class:`Image`. The last two are in the coordinates of space. Of a dictionary: of its arrays and files.
    data_files_anywhere: whether the header of an image (.nhdr, .mhd, .hdr) may name data files that are not in
        its folder or below. Only for headers that you trust.

    Raises FileNotFoundError; FileError (an OSError) for what cannot be read; ValueError for a spacing, origin or
    direction that is none.
    """
    place = place_of(spacing, origin, direction)
    options = ["--space=" + space_of(space).lower(), f"--overlap={overlap}",
               "--mask-threshold=" + number_text(mask_threshold)]
    if resample_masks:
        options.append("--resample-masks")
    if data_files_anywhere:
        options.append("--data-files-anywhere")
    with temporary_folder() as folder:
        image = os.path.join(folder, "image.nrrd")
        if isinstance(path, Mapping):
            if label_table is not None or series_uid is not None:
                raise ValueError("label_table, series_uid: not with a dictionary of masks, which have names")
            masks, words, has_space = _mask_options(path, place, folder)
            program.run([*masks, *options, "--save-image=" + image], words=words)
            result = read_nrrd(image)
            if not has_space:
                del result.field_data["SPACE"]
            return result
        for option, value in (("series", series_uid), ("label-table", None if label_table is None else existing(label_table))):
            if value is not None:
                options.append(f"--{option}={value}")
        program.run([*input_options(path), *options, *place_options(place), "--save-image=" + image])
        return read_nrrd(image)


def _mask_options(masks: Mapping[str, Any], place: Mapping[str, Any], folder: str) -> Tuple[List[str], List[Tuple[str, str]], bool]:
    """The options for masks, which are written to the folder; what messages call them; whether one has a space."""
    if not masks:
        raise ValueError("the dictionary of masks is empty")
    check_shapes(masks)
    options, has_space = [], False
    words = [(f"'{os.path.join(folder, NAMES)}'", "the dictionary")]
    for name in masks:
        if not isinstance(name, str) or not name.strip() or _IS_NO_TEXT.search(name):
            raise ValueError(f"masks have names in one line of text, and none is called {name!r}")
    # Files that the program reads itself: only it knows what they do not say.
    found: List[Tuple[str, Union[str, Image]]] = []
    for name, mask in masks.items():
        is_file = isinstance(mask, (str, os.PathLike)) and os.path.isfile(mask)
        found.append((name, os.fsdecode(mask) if is_file and not place and len(masks) > 1 else single_image(mask, place)))
    is_any_placed = any(isinstance(mask, str) or lies_somewhere(mask) for _, mask in found)
    for number, (name, image) in enumerate(found, 1):
        if isinstance(image, str):
            path, has_space = image, True
        else:
            path = os.path.join(folder, str(number), name.replace("/", "_")[:50] + ".nrrd")  # warnings show its name
            os.mkdir(os.path.dirname(path))
            write_nrrd(image, path, hidden_is_outside=False, space=image.space or "LPS",
                       is_placed=lies_somewhere(image) or not is_any_placed)
            has_space = has_space or image.space is not None
        words.append((f"'{path}'", f"the mask {name!r}"))
        options.append("--input=" + path)
    if len(masks) == 1:
        options = ["--input=" + os.path.dirname(path)]  # a file that is alone is no mask, but that of a folder is
    return [*options, *names_option(dict(enumerate(masks, 1)), folder)], words, has_space


def names_option(names: Mapping[int, str], folder: str) -> List[str]:
    """The option for the names of labels, which are written to the folder; none if there are none."""
    rows = ['%d,"%s"\n' % (value, name.replace('"', '""')) for value, name in sorted(names.items())
            if value > 0 and name.strip() and not _IS_NO_TEXT.search(name)]
    if not rows:
        return []
    table = os.path.join(folder, NAMES)
    with open(table, "w", encoding="utf-8") as file:
        file.writelines(rows)
    return ["--label-table=" + table]


def input_options(paths: Union[Path, Sequence[Path]]) -> List[str]:
    """The options for an image, or for masks."""
    files = [paths] if isinstance(paths, (str, os.PathLike)) else list(paths)
    if not files:
        raise ValueError("the list of files is empty")
    return ["--input=" + existing(file) for file in files]


def existing(path: Path) -> str:
    """Raises FileNotFoundError where there is nothing."""
    if not os.path.exists(path):
        raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), os.fsdecode(path))
    return os.fsdecode(path)


def number_text(value: Any) -> str:
    """As an option and a message have it."""
    text = repr(float(value))
    return text[:-2] if text.endswith(".0") else text


def number_list(option: str, values: Any) -> List[str]:
    """The option with its numbers; nothing if there are none."""
    text = ",".join(map(number_text, values))
    return [f"--{option}={text}"] if text else []


def place_options(place: Mapping[str, Any]) -> List[str]:
    """The options for what place_of() returns."""
    return [option for name, values in place.items() for option in number_list(name, numpy.reshape(values, -1))]


@contextlib.contextmanager
def temporary_folder() -> Iterator[str]:
    """For files that only pass data. Raises FileError if there is no room for them."""
    try:
        place = tempfile.gettempdir()
    except FileNotFoundError as error:
        raise FileError(f"{error.strerror}; name one with the environment variable TMPDIR") from None
    try:
        with tempfile.TemporaryDirectory(prefix="voxplex-") as folder:
            yield folder
    except OSError as error:
        if error.errno in (errno.ENOSPC, errno.EDQUOT) or isinstance(error, FileError) and _IS_FULL.search(str(error)):
            raise FileError(f"the temporary folder {place} is full, which the image and the mesh pass through; choose "
                            "another one with the environment variable TMPDIR") from error
        raise


def in_words(folder: str) -> List[Tuple[str, str]]:
    """What messages call the files of images and meshes that are in memory."""
    names = (("image.nrrd", "the image"), ("sizes.nrrd", "the image of sizes"), ("mesh.vtu", "the mesh"))
    return [(quote + os.path.join(folder, file) + quote, name) for file, name in names for quote in ("'", "")]


def mesh_file(mesh: Union[Mesh, Path, Any], folder: str) -> str:
    """The path of a mesh, which is written to the folder if it is in memory."""
    if isinstance(mesh, (str, os.PathLike)):
        return existing(mesh)
    if not isinstance(mesh, Mesh):
        raise TypeError(f"mesh must be a voxplex.Mesh, a vtkUnstructuredGrid or a path, not {type(mesh).__name__}")
    path = os.path.join(folder, "mesh.vtu")
    xmlfiles.write(path, mesh)
    return path


def write_mesh(mesh: Mesh, outputs: Mapping[str, Optional[Path]]) -> None:
    """Mesh.write(): a path for each of these options of the program."""
    if not any(path is not None for path in outputs.values()):
        raise TypeError("write() needs a path")
    with temporary_folder() as folder:
        arguments = ["--mesh=" + mesh_file(mesh, folder)]
        if mesh.has_interfaces:
            surfaces = copy.copy(mesh.interfaces)
            surfaces.points = mesh.points[surfaces.point_ids]  # they are the mesh's own points, wherever these are now
            extension = ".vtp" if surfaces.cells.shape[1] == 3 else ".vtu"
            interfaces = os.path.join(folder, "interfaces" + extension)
            xmlfiles.write(interfaces, surfaces)
            arguments.append("--interfaces=" + interfaces)
        arguments += [f"--{option}={os.fsdecode(path)}" for option, path in outputs.items() if path is not None]
        ours = [("plc: ", "interfaces: "), ("output: ", "path: "), ("with output", "with path"), ("with plc", "with interfaces")]
        try:
            program.run(arguments, words=ours + in_words(folder))
        except MeshingError as error:
            raise FileError(str(error)) from None
