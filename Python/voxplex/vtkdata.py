# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Images and meshes as data of VTK and back, sharing memory. Any VTK from 9.1 on will do."""

from __future__ import annotations

import os
from typing import Any, List, Optional, Sequence, Tuple

import numpy
from numpy.typing import ArrayLike, NDArray

try:
    from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
    from vtkmodules.vtkCommonCore import vtkDataArray, vtkPoints, vtkStringArray, vtkVersion
    from vtkmodules.vtkCommonDataModel import (
        vtkCellArray, vtkDataObject, vtkDataSetAttributes, vtkFieldData, vtkImageData, vtkPointSet, vtkPolyData,
        vtkUnstructuredGrid)
    from vtkmodules.vtkCommonExecutionModel import vtkAlgorithm
    from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as Pipeline
    if (vtkVersion().GetVTKMajorVersion(), vtkVersion().GetVTKMinorVersion()) < (9, 1):
        raise ImportError(f"VTK is {vtkVersion().GetVTKVersion()}")
    from vtkmodules.vtkIOXML import vtkXMLImageDataWriter
except ImportError as missing:
    raise ImportError(f"this needs VTK 9.1 or newer (pip install 'vtk>=9.1'): {missing}", name="vtkmodules") from missing

from .fields import TEXTS, Fields, texts_of
from .files import read_segmentation, temporary_folder
from .images import Image, from_components
from .xmlfiles import ACTIVE, CELL_TYPE, CORNERS, IDS, Arrays, check, native

_GHOSTS = "vtkGhostType"


def image_to_vtk(image: Image) -> Any:
    """A vtkImageData; of a time series a list of them, each with its time."""
    if not image.is_series:
        return _frame_to_vtk(image, image.voxels, image.mask)
    frames = []
    for number, time in enumerate(image.times):
        frame = _frame_to_vtk(image, image.voxels[number], None if image.mask is None else image.mask[number])
        frame.GetInformation().Set(vtkDataObject.DATA_TIME_STEP(), time)
        frames.append(frame)
    return frames


def image_from_vtk(data: Any, times: Optional[ArrayLike]) -> Image:
    """Of a vtkImageData or an algorithm."""
    if isinstance(data, vtkAlgorithm):
        data, steps = _outputs(data)
        if len(data) > 1:
            return Image.from_vtk(data, steps if times is None else times)
        data = data[0]
    if not isinstance(data, vtkImageData):
        raise TypeError(f"image must be a vtkImageData, not {type(data).__name__}")
    voxels = _voxels(data)
    spacing, origin, direction = _place(data)
    image = from_components(voxels, _mask(data, voxels), times,
                            {"spacing": spacing, "origin": origin, "direction": direction})
    image.field_data = _fields(data.GetFieldData())
    return image


def frame_times(frames: Sequence[Any]) -> Optional[List[float]]:
    """The times that frames carry, if they do. Raises ValueError if only some do."""
    key = vtkDataObject.DATA_TIME_STEP()
    dated = [frame.GetInformation().Has(key) == 1 for frame in frames]
    if all(dated):
        return [frame.GetInformation().Get(key) for frame in frames]
    if any(dated):
        raise ValueError(f"frame {dated.index(False)} has no time, but others have; pass times=")
    return None


def mesh_to_vtk(arrays: Arrays) -> Any:
    """A vtkUnstructuredGrid, of triangles a vtkPolyData, that shares the arrays' memory."""
    check(arrays)
    corners = arrays.cells.shape[1]
    cells = vtkCellArray()
    if len(arrays.cells):
        connectivity = native("cells", arrays.cells).reshape(-1)
        cells.SetData(corners, _share(connectivity, ids=True))
        _keep(connectivity, cells.GetConnectivityArray())  # VTK may have another array with the same memory
    if corners == 3:
        result: Any = vtkPolyData()
        result.SetPolys(cells)
    else:
        result = vtkUnstructuredGrid()
        result.SetCells(CELL_TYPE[corners], cells)
    points = vtkPoints()
    points.SetDataTypeToDouble()
    if len(arrays.points):
        points.SetData(_share(native("points", arrays.points)))
    result.SetPoints(points)
    for target, data in ((result.GetPointData(), arrays.point_data), (result.GetCellData(), arrays.cell_data)):
        for name, values in data.items():
            target.AddArray(_named(name, values))
        if ACTIVE in data:
            target.SetActiveScalars(ACTIVE)
    _set_fields(result.GetFieldData(), arrays.field_data)
    return result


def mesh_from_vtk(data: vtkPointSet) -> Arrays:
    """Of a vtkUnstructuredGrid or a vtkPolyData of one kind of cells. Raises ValueError for others."""
    if isinstance(data, vtkPolyData):
        others = data.GetNumberOfCells() - data.GetNumberOfPolys()
        corners, cells = 3, data.GetPolys()
    elif isinstance(data, vtkUnstructuredGrid):
        count = data.GetNumberOfCells()
        corners = CORNERS.get(data.GetCellType(0), 0) if count else 4
        kind = data.GetCellType(0) if count else 0
        others = 0 if count == 0 or data.IsHomogeneous() else sum(data.GetCellType(cell) != kind for cell in range(count))
        cells = data.GetCells()
    else:
        raise TypeError(f"a mesh must be a vtkUnstructuredGrid or a vtkPolyData, not {type(data).__name__}")
    filled = cells.GetNumberOfCells() > 0
    connectivity = vtk_to_numpy(cells.GetConnectivityArray()) if filled else numpy.empty(0, dtype=numpy.int64)
    if (others or corners == 0 or filled and cells.IsHomogeneous() != corners
            or connectivity.size != corners * cells.GetNumberOfCells()):
        raise ValueError("the cells are not all of one kind: triangles, tetrahedra or pentatopes (VTK_POLY_VERTEX of five points)")
    points = vtk_to_numpy(data.GetPoints().GetData()) if data.GetPoints() is not None else numpy.empty((0, 3))
    return Arrays(points, connectivity.reshape(-1, corners), _data(data.GetPointData()), _data(data.GetCellData()),
                  _fields(data.GetFieldData()))


def _outputs(algorithm: vtkAlgorithm) -> Tuple[List[Any], Optional[List[float]]]:
    """What an algorithm makes, at each of its times."""
    algorithm.UpdateInformation()
    information = algorithm.GetOutputInformation(0)
    times = list(information.Get(Pipeline.TIME_STEPS())) if information.Has(Pipeline.TIME_STEPS()) else []
    frames = []
    for time in times or [None]:
        algorithm.Update() if time is None else algorithm.UpdateTimeStep(time)
        output = algorithm.GetOutputDataObject(0)
        frames.append(output.NewInstance())
        frames[-1].ShallowCopy(output)
    return frames, times if len(times) > 1 else None


def _scalars(image: vtkImageData) -> Tuple[Any, bool]:
    """The labels, and whether they are those of cells."""
    points = image.GetPointData().GetScalars()
    scalars = points or image.GetCellData().GetScalars()
    if scalars is None:
        raise ValueError("the image has no active scalars, neither of points nor of cells")
    return scalars, points is None


def _voxels(image: vtkImageData) -> NDArray[Any]:
    """Indexed [k, j, i], or [k, j, i, component]."""
    scalars, of_cells = _scalars(image)
    shape = tuple(max(n - 1, 1) if of_cells else n for n in reversed(image.GetDimensions()))
    components = scalars.GetNumberOfComponents()
    return vtk_to_numpy(scalars).reshape(shape if components == 1 else shape + (components,))


def _mask(image: vtkImageData, voxels: NDArray[Any]) -> Optional[NDArray[numpy.bool_]]:
    """What the image hides. The program knows, which reads an image of ones that hides the same."""
    shown = vtkImageData()
    shown.CopyStructure(image)
    for data, shown_data in ((image.GetPointData(), shown.GetPointData()), (image.GetCellData(), shown.GetCellData())):
        if data.HasArray(_GHOSTS):
            shown_data.AddArray(data.GetArray(_GHOSTS))
    if not (shown.GetPointData().HasArray(_GHOSTS) or shown.GetCellData().HasArray(_GHOSTS)):
        return None
    ones = _named("Labels", numpy.ones(voxels.shape[:3], numpy.uint8).reshape(-1))
    (shown.GetCellData() if _scalars(image)[1] else shown.GetPointData()).SetScalars(ones)
    with temporary_folder() as folder:
        writer = vtkXMLImageDataWriter()
        writer.SetFileName(os.path.join(folder, "image.vti"))
        writer.SetInputData(shown)
        writer.Write()
        return read_segmentation(writer.GetFileName()).voxels == 0


def _place(image: vtkImageData) -> Tuple[Any, Any, Any]:
    """Spacing, the place of the first voxel, and the direction."""
    matrix = image.GetDirectionMatrix()
    direction = numpy.array([[matrix.GetElement(row, column) for column in range(3)] for row in range(3)])
    spacing = numpy.array(image.GetSpacing())
    first = numpy.array(image.GetExtent()[::2]) + (0.5 if _scalars(image)[1] else 0.0)
    return spacing, numpy.array(image.GetOrigin()) + direction @ (first * spacing), direction


def _frame_to_vtk(image: Image, voxels: NDArray[Any], mask: Optional[NDArray[numpy.bool_]]) -> vtkImageData:
    result = vtkImageData()
    result.SetDimensions(*reversed(voxels.shape))
    result.SetSpacing(*image.spacing)
    result.SetOrigin(*image.origin)
    result.SetDirectionMatrix(*image.direction.reshape(-1))
    if mask is not None:
        voxels = numpy.where(mask, voxels.dtype.type(numpy.nan if voxels.dtype.kind == "f" else 0), voxels)
    if voxels.dtype == numpy.bool_:
        voxels = voxels.view(numpy.uint8)
    voxels = numpy.ascontiguousarray(voxels, dtype=voxels.dtype.newbyteorder("="))
    if voxels.size:
        result.GetPointData().SetScalars(_named("Labels", voxels.reshape(-1)))
    if mask is not None:
        hidden = numpy.where(mask.reshape(-1), numpy.uint8(vtkDataSetAttributes.HIDDENPOINT), numpy.uint8(0))
        result.GetPointData().AddArray(_named(_GHOSTS, hidden))
    _set_fields(result.GetFieldData(), image.field_data)
    return result


def _named(name: str, values: NDArray[Any]) -> vtkDataArray:
    array = _share(native(name, values), name in IDS)
    array.SetName(name)
    return array


def _share(values: NDArray[Any], ids: bool = False) -> vtkDataArray:
    """A VTK array over the memory of a NumPy array, which it keeps alive for as long as it lives itself.

    numpy_to_vtk() leaves that to an attribute of the Python object, which VTK keeps longer than the
    array. An observer dies with the array.
    """
    if values.size == 0:
        return numpy_to_vtk(values, deep=True)
    result = (numpy_to_vtkIdTypeArray if ids else numpy_to_vtk)(values)
    if hasattr(result, "_numpy_reference"):
        del result._numpy_reference
    _keep(values, result)
    return result


def _keep(values: NDArray[Any], array: vtkDataArray) -> None:
    """Keeps the memory for as long as the VTK array lives."""
    def owner(_caller: Any, _event: str, memory: NDArray[Any] = values) -> NDArray[Any]:
        return memory

    array.AddObserver("UserEvent", owner)


def _data(data: vtkFieldData) -> Any:
    arrays = {data.GetArrayName(n): data.GetArray(n) for n in range(data.GetNumberOfArrays())}
    return {name: vtk_to_numpy(array) for name, array in arrays.items() if name and array is not None}


def _fields(data: vtkFieldData) -> Fields:
    result: Fields = _data(data)
    for n in range(data.GetNumberOfArrays()):
        array = data.GetAbstractArray(n)
        if array.IsA("vtkStringArray"):
            result[array.GetName()] = [array.GetValue(i) for i in range(array.GetNumberOfValues())]
        elif array.GetName() in TEXTS:
            result[array.GetName()] = texts_of(bytes(array))
    return result


def _set_fields(data: vtkFieldData, fields: Fields) -> None:
    for name, values in fields.items():
        if isinstance(values, list):
            array = vtkStringArray()
            array.SetName(name)
            for text in values:
                array.InsertNextValue(text)
            data.AddArray(array)
        else:
            data.AddArray(_named(name, values))
