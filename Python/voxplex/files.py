# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Reading of segmentations and writing of meshes.

Needs the module VTK::VoxplexIO, which is built where GDCM is found (`voxplex.HAVE_IO`); without it the
functions raise RuntimeError.
"""

from __future__ import annotations

import errno
import math
import os
import warnings
from typing import TYPE_CHECKING, Any, List, Optional, Sequence, Union

import numpy
from numpy.typing import ArrayLike
from vtkmodules.vtkCommonDataModel import (
    vtkDataObject, vtkImageData, vtkPointSet, vtkUnstructuredGrid)
from vtkmodules.vtkCommonExecutionModel import vtkAlgorithm

from .errors import FileError, MeshingWarning
from .execution import Execution
from .images import _numbers
from .vtkVoxplex import vtkImageToSimplexMeshFilter

if TYPE_CHECKING:
    from typing import Literal

try:
    from .vtkVoxplexIO import vtkSegmentationReader, vtkSimplexMeshWriter
    HAVE_IO = True
    """Whether files can be read and written."""
except ModuleNotFoundError:
    HAVE_IO = False

Path = Union[str, "os.PathLike[str]"]


def read_segmentation(path: Path, *, frame: Optional[int] = None, space: Literal["LPS", "RAS"] = "LPS",
                      series_uid: Optional[str] = None, label_table: Optional[Path] = None,
                      spacing: Optional[Sequence[float]] = None, origin: Optional[Sequence[float]] = None,
                      direction: Optional[ArrayLike] = None, data_files_anywhere: bool = False) -> vtkImageData:
    """Reads a label image with its place in space and the names of its labels.

    path: a file (NRRD, NIfTI, MetaImage, DICOM, TIFF, VTK, GIPL, MRC), or a folder with a DICOM series.
    frame: which one of a time series, from 0; for all of them see :func:`read_frames`.
    space: the coordinates of the image, those of DICOM and ITK (LPS) or those of NIfTI (RAS).
    series_uid: which series, if the folder holds several.
    label_table: a text file with the names and colours of labels, if the image has none itself.
    spacing, origin, direction: in place of what the file says, for formats that do not know them (TIFF): the
        distances of voxels along i, j and k; where voxel (0, 0, 0) lies; and a 3 x 3 matrix (or its 9 numbers, row
        by row), whose columns are the directions of i, j and k. The last two are in the coordinates of space.
    data_files_anywhere: whether the header of an image (.nhdr, .mhd, .hdr) may name data files that are not in
        its folder or below. Only for headers that you trust.

    The voxels are its active point scalars, `Labels`; :func:`label_names` gives the names, and
    :func:`array_from_image` the voxels as an array.

    Raises FileNotFoundError; FileError (an OSError) for what cannot be read; ValueError for a time series
    without frame, for a frame that it does not have, and for a spacing, origin or direction that is none.
    """
    reader = segmentation_reader(path, space=space, series_uid=series_uid, label_table=label_table, spacing=spacing,
                                 origin=origin, direction=direction, data_files_anywhere=data_files_anywhere)
    count = reader.GetNumberOfFrames()
    if frame is None and count > 1:
        raise ValueError(f"{os.fspath(path)} has {count} time frames: pass frame=, or use read_frames()")
    if frame is not None and not 0 <= frame < count:
        raise ValueError(f"{os.fspath(path)} has {count} time frames, not number {frame} (from 0)")
    return _read(reader, frame or 0)


def read_frames(path: Path, *, space: Literal["LPS", "RAS"] = "LPS", series_uid: Optional[str] = None,
                label_table: Optional[Path] = None, spacing: Optional[Sequence[float]] = None,
                origin: Optional[Sequence[float]] = None, direction: Optional[ArrayLike] = None,
                data_files_anywhere: bool = False) -> List[vtkImageData]:
    """Reads a time series: one image a frame, each with its time, as :func:`mesh` takes them.

    Arguments and exceptions are those of :func:`read_segmentation`. An image without time frames gives
    a list of one.
    """
    reader = segmentation_reader(path, space=space, series_uid=series_uid, label_table=label_table, spacing=spacing,
                                 origin=origin, direction=direction, data_files_anywhere=data_files_anywhere)
    return [_read(reader, frame) for frame in range(reader.GetNumberOfFrames())]


def write(mesh: vtkPointSet, path: Path, *, interfaces: Optional[vtkPointSet] = None,
          slab: Optional[int] = None) -> None:
    """Writes a mesh, or interfaces, to a file whose extension chooses the format.

    mesh: what :func:`mesh` returns; or its interfaces alone (.vtp, .stl ...).
    path: Documentation/FileFormats.md lists the extensions and what each holds.
    interfaces: of the mesh; formats for solvers make named surfaces of them.
    slab: the only slab to write, from 0, of a mesh with time planes.

    The file appears whole or not at all. Raises FileError (an OSError) for an extension that is not known,
    and for what cannot be written.
    """
    _need_io()
    writer = vtkSimplexMeshWriter()
    writer.SetFileName(os.fsencode(path))
    if _is_mesh(mesh):
        writer.SetContent(writer.CONTENT_MESH)
        writer.SetSlab(-1 if slab is None else slab)
        writer.SetInputData(0, mesh)
        if interfaces is not None:
            writer.SetInputData(1, interfaces)
    else:
        if interfaces is not None:
            raise ValueError("mesh and interfaces are both interfaces")
        if slab is not None:
            raise ValueError("slab: interfaces have no slabs")
        writer.SetContent(writer.CONTENT_INTERFACES)
        writer.SetInputData(0, vtkUnstructuredGrid())  # vtkWriter wants an input there
        writer.SetInputData(1, mesh)
    execution = Execution(writer)
    execution.run(writer.Write)
    _issue(execution.warnings)
    if writer.GetErrorMessage() or execution.errors:
        raise FileError(writer.GetErrorMessage() or "\n".join(execution.errors))


def segmentation_reader(path: Path, *, space: str = "LPS", series_uid: Optional[str] = None,
                        label_table: Optional[Path] = None, spacing: Optional[Sequence[float]] = None,
                        origin: Optional[Sequence[float]] = None, direction: Optional[ArrayLike] = None,
                        data_files_anywhere: bool = False) -> Any:
    """A vtkSegmentationReader that has read this file, for pipelines.

    Arguments and exceptions are those of :func:`read_segmentation`.
    """
    _need_io()
    for file in (path, label_table):
        if file is not None and not os.path.exists(file):
            raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), os.fspath(file))
    if space not in ("LPS", "RAS"):
        raise ValueError(f"space is {space!r}, not 'LPS' or 'RAS'")
    reader = vtkSegmentationReader()
    reader.SetFileName(os.fsencode(path))
    reader.SetSpace(reader.SPACE_LPS if space == "LPS" else reader.SPACE_RAS)
    if series_uid is not None:
        reader.SetSeriesUID(series_uid)
    if label_table is not None:
        reader.SetLabelTableFileName(os.fsencode(label_table))
    _place(reader, spacing, origin, direction)
    reader.SetDataFilesAnywhere(data_files_anywhere)
    _execute(reader, reader.UpdateInformation)
    return reader


def _place(reader: Any, spacing: Optional[Sequence[float]], origin: Optional[Sequence[float]],
           direction: Optional[ArrayLike]) -> None:
    """Refuses what the reader takes for 'as in the file'."""
    if spacing is not None:
        lengths = _numbers(spacing, 3, "spacing")
        if not all(0 < length < math.inf for length in lengths):
            raise ValueError(f"spacing is {lengths}; lengths must be positive and finite")
        reader.SetSpacing(lengths)
    if origin is not None:
        coordinates = _numbers(origin, 3, "origin")
        if not all(map(math.isfinite, coordinates)):
            raise ValueError(f"origin is {coordinates}; coordinates must be finite")
        reader.SetOrigin(coordinates)
    if direction is not None:
        matrix = _numbers(direction, 9, "direction")
        if not all(map(math.isfinite, matrix)) or numpy.linalg.matrix_rank(numpy.reshape(matrix, (3, 3))) < 3:
            raise ValueError(f"direction is {matrix}; its columns must be independent")
        reader.SetDirection(matrix)


def _read(reader: Any, frame: int) -> vtkImageData:
    _execute(reader, lambda: reader.UpdateTimeStep(reader.GetTimeOfFrame(frame)))
    result = vtkImageData()
    result.ShallowCopy(reader.GetOutput())
    return result


def _execute(reader: vtkAlgorithm, update: Any) -> None:
    execution = Execution(reader)
    execution.run(update)
    _issue([_in_terms_of_arguments(text) for text in execution.warnings])
    if reader.GetErrorMessage() or execution.errors:
        raise FileError(_in_terms_of_arguments(reader.GetErrorMessage() or "\n".join(execution.errors)))


def _in_terms_of_arguments(message: str) -> str:
    filters = vtkImageToSimplexMeshFilter
    return str(filters.InTermsOf(filters.VOCABULARY_PYTHON, message))


def _issue(texts: List[str]) -> None:
    for text in texts:
        warnings.warn(text, MeshingWarning, stacklevel=4)


def _is_mesh(data: vtkPointSet) -> bool:
    """Whether data is a mesh rather than interfaces, which for pentatopes are tetrahedra."""
    if not isinstance(data, vtkUnstructuredGrid):
        return False
    cells = data.GetCellData()
    return cells.HasArray("Label") == 1 or not cells.HasArray("Labels")


def _need_io() -> None:
    if not HAVE_IO:
        raise RuntimeError("this build of Voxplex cannot read or write files: it was made without GDCM; "
                           "build it where GDCM is found (apt-get install libgdcm-dev libgdcm-tools)")
