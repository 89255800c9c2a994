# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Images and meshes as data of VTK and back, sharing memory. Any VTK from 9.1 on will do."""

from __future__ import annotations

import os
from typing import Any, List, NamedTuple, Optional, Sequence, Tuple

import numpy
from numpy.typing import NDArray

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

from . import program
from .fields import TEXTS, Fields, texts_of
from .files import temporary_folder
from .xmlfiles import ACTIVE, CELL_TYPE, CORNERS, IDS, Arrays, check, native

_GHOSTS = "vtkGhostType"


class Frame(NamedTuple):
    """An image without time. Masked voxels are hidden."""

    voxels: NDArray[Any]
    mask: Optional[NDArray[numpy.bool_]]
    spacing: Any
    origin: Any
    direction: Any
    field_data: Fields


def frame_from_vtk(image: Any, scalars: Optional[str], has_times: bool) -> Frame:
    """Its voxels are indexed [k, j, i] or, if they have several components, [k, j, i, component]."""
    if not isinstance(image, vtkImageData):
        raise TypeError(f"image must be a vtkImageData, not {type(image).__name__}")
    image = _with_labels_active(image, scalars, has_times)
    voxels = _voxels(image)
    return Frame(voxels, _mask(image, voxels), *_place(image), _fields(image.GetFieldData()))


def frames_of(data: Any) -> Tuple[List[Any], Optional[List[float]]]:
    """What a data object is, or an algorithm makes, at each of its times."""
    if not isinstance(data, vtkAlgorithm):
        return [data], None
    data.UpdateInformation()
    information = data.GetOutputInformation(0)
    times = list(information.Get(Pipeline.TIME_STEPS())) if information.Has(Pipeline.TIME_STEPS()) else []
    frames = []
    for time in times or [None]:
        data.Update() if time is None else data.UpdateTimeStep(time)
        output = data.GetOutputDataObject(0)
        frames.append(output.NewInstance())
        frames[-1].ShallowCopy(output)
    return frames, times if len(times) > 1 else None


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


def _with_labels_active(image: vtkImageData, name: Optional[str], has_times: bool) -> vtkImageData:
    """A copy that shares the arrays, whose active scalars are the labels: the array of this name, the active one, or the only one."""
    attributes = [image.GetPointData(), image.GetCellData()]
    arrays = [(data, n, data.GetArray(n)) for data in attributes for n in range(data.GetNumberOfArrays())]
    found = [row for row in arrays if row[2] is not None and row[2].GetName() != _GHOSTS]
    active = [row for row in found if row[0].IsArrayAnAttribute(row[1]) == vtkDataSetAttributes.SCALARS]
    if name is not None:
        found, active = ([row for row in rows if row[2].GetName() == name] for rows in (found, active))
    elif not active:
        found = [row for row in found if row[0].IsArrayAnAttribute(row[1]) < 0 and (row[2].GetNumberOfComponents() > 1) == has_times]
    info = getattr(image, "active_scalars_info", None)  # PyVista knows one active array, VTK one of points and one of cells
    if info is not None and info.association.name == "CELL":
        active.reverse()
    chosen = active[:1] or found
    if not chosen:
        raise ValueError("the image has no active scalars, neither of points nor of cells" if name is None else
                         f"the image has no array {name!r}, neither of points nor of cells")
    if len(chosen) > 1:
        names = ", ".join(f"{array.GetName()!r} of the {'points' if data is attributes[0] else 'cells'}" for data, _, array in chosen)
        raise ValueError(f"the image has several arrays that could be labels ({names}); choose one with scalars=, or make it active")
    result = vtkImageData()
    result.ShallowCopy(image)
    for data, copy in zip(attributes, (result.GetPointData(), result.GetCellData())):
        copy.SetActiveAttribute(chosen[0][1] if data is chosen[0][0] else -1, vtkDataSetAttributes.SCALARS)
    return result


def _scalars(image: vtkImageData) -> Tuple[Any, bool]:
    """The labels, and whether they are those of cells."""
    points = image.GetPointData().GetScalars()
    return points or image.GetCellData().GetScalars(), points is None


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
        read = os.path.join(folder, "image.nrrd")
        writer = vtkXMLImageDataWriter()
        writer.SetFileName(os.path.join(folder, "image.vti"))
        writer.SetInputData(shown)
        writer.Write()
        program.run(["image", "--input=" + writer.GetFileName(), "--output=" + read])
        return numpy.fromfile(read, numpy.uint8)[-ones.GetNumberOfValues():].reshape(voxels.shape[:3]) == 0


def _place(image: vtkImageData) -> Tuple[Any, Any, Any]:
    """Spacing, the place of the first voxel, and the direction."""
    matrix = image.GetDirectionMatrix()
    direction = numpy.array([[matrix.GetElement(row, column) for column in range(3)] for row in range(3)])
    spacing = numpy.array(image.GetSpacing())
    first = numpy.array(image.GetExtent()[::2]) + (0.5 if _scalars(image)[1] else 0.0)
    return spacing, numpy.array(image.GetOrigin()) + direction @ (first * spacing), direction


def frame_to_vtk(frame: Frame, time: Optional[float]) -> vtkImageData:
    """A vtkImageData that shares the voxels."""
    result, voxels, mask = vtkImageData(), frame.voxels, frame.mask
    result.SetDimensions(*reversed(voxels.shape))
    result.SetSpacing(*frame.spacing)
    result.SetOrigin(*frame.origin)
    result.SetDirectionMatrix(*frame.direction.reshape(-1))
    if time is not None:
        result.GetInformation().Set(vtkDataObject.DATA_TIME_STEP(), time)
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
    _set_fields(result.GetFieldData(), frame.field_data)
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
