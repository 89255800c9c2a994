# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""The meshing filters for pipelines of any VTK, where the wrapped classes are not built: as in the wheel.

They have the names and the properties of the wrapped ones (Documentation/Parameters.md), and call :func:`voxplex.mesh`.
What goes wrong is raised by Update(), and kept in GetErrorMessage().
"""

from __future__ import annotations

from typing import Any, Dict, List, Optional, Tuple

from . import vtkdata  # first, since it says so if VTK is missing or too old
from vtkmodules.util.vtkAlgorithm import VTKPythonAlgorithmBase
from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkImageData, vtkPolyData, vtkUnstructuredGrid
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as Pipeline

from .meshing import OPTIONS, mesh

_LISTS = ("labels", "label-sizes", "interface-sizes", "image")


class _Mesher(VTKPythonAlgorithmBase):
    """Output 0 is the mesh, output 1 are its interfaces."""

    ANY_LABEL = -1
    dimension = 3

    def __init__(self) -> None:
        super().__init__(nInputPorts=1, inputType="vtkImageData", nOutputPorts=2, outputType="vtkUnstructuredGrid")
        self._values: Dict[str, Any] = {}
        self._times: Tuple[float, ...] = ()
        self._frames: List[vtkImageData] = []
        self._failure: Optional[BaseException] = None
        self._statistics: Dict[str, Any] = {}

    def SetInputData(self, data: Any) -> None:
        """The image, of whatever kind VTK has."""
        self.SetInputDataObject(0, data)

    def GetOutput(self, port: int = 0) -> Any:
        """The mesh, or its interfaces."""
        return self.GetOutputDataObject(port)

    def Update(self, *port: int) -> None:
        """Executes what is not up to date. Raises what voxplex.mesh() raises."""
        self._failure = None
        super().Update(*port)
        if self._failure is not None:
            raise self._failure

    def GetErrorMessage(self) -> str:
        """Why the last execution failed; empty if it did not."""
        return "" if self._failure is None else str(self._failure)

    def GetInterfaces(self) -> Any:
        """Output 1."""
        return self.GetOutputDataObject(1)

    def GetStatistics(self) -> Dict[str, Any]:
        """What voxplex.Mesh.statistics has."""
        return self._statistics

    def AddLabel(self, label: int) -> None:
        """Meshes this label, and others that are added; by default all."""
        self._change("labels", [*self._values.get("labels", []), label])

    def ClearLabels(self) -> None:
        """All labels again."""
        self._change("labels", None)

    def SetLabelSize(self, label: int, size: float) -> None:
        """The largest circumradius in a label."""
        self._change("label_sizes", {**self._values.get("label_sizes", {}), label: size})

    def SetInterfaceSize(self, first: int, second: int, size: float) -> None:
        """The sampling distance between two labels, the second of which may be ANY_LABEL."""
        key = first if second == self.ANY_LABEL else (first, second)
        self._change("interface_sizes", {**self._values.get("interface_sizes", {}), key: size})

    def SetElementSizeData(self, image: Any) -> None:
        """An image of largest circumradii."""
        self._change("size_image", image)

    def FillOutputPortInformation(self, port: int, info: Any) -> int:
        kind = "vtkPolyData" if port == 1 and self.dimension == 3 else "vtkUnstructuredGrid"
        info.Set(vtkDataObject.DATA_TYPE_NAME(), kind)
        return 1

    def RequestUpdateExtent(self, _request: Any, inputs: Any, _outputs: Any) -> int:
        """The whole image; of a series the next frame."""
        information = inputs[0].GetInformationObject(0)
        information.Set(Pipeline.UPDATE_EXTENT(), information.Get(Pipeline.WHOLE_EXTENT()), 6)
        if self.dimension == 4:
            self._times = _times_of(information)
            information.Set(Pipeline.UPDATE_TIME_STEP(), self._times[len(self._frames)] if self._times else 0.0)
        return 1

    def RequestData(self, request: Any, inputs: Any, outputs: Any) -> int:
        image = vtkImageData.GetData(inputs[0], 0)
        source, times = image, None
        if self.dimension == 4 and self._times:
            self._frames.append(image.NewInstance())
            self._frames[-1].ShallowCopy(image)
            if len(self._frames) < len(self._times):
                request.Set(Pipeline.CONTINUE_EXECUTING(), 1)
                return 1
            request.Remove(Pipeline.CONTINUE_EXECUTING())
            source, times, self._frames = self._frames, self._times, []
        try:
            result = mesh(source, times=self._values.get("times", times), progress=self._on_progress,
                          **{name: value for name, value in self._values.items() if name != "times"})
        except BaseException as failure:  # pylint: disable=broad-except
            self._failure = failure  # raised here, VTK would print it
            return 1
        self._statistics = result.statistics
        vtkUnstructuredGrid.GetData(outputs, 0).ShallowCopy(result.to_vtk())
        kind = vtkPolyData if self.dimension == 3 else vtkUnstructuredGrid
        kind.GetData(outputs, 1).ShallowCopy(result.interfaces.to_vtk())
        return 1

    def _on_progress(self, fraction: float) -> bool:
        self.UpdateProgress(fraction)
        return not self.GetAbortExecute()

    def _change(self, name: str, value: Any) -> None:
        if value is None:
            self._values.pop(name, None)
        else:
            self._values[name] = value
        self.Modified()


class vtkImageToTetMeshFilter(_Mesher):
    """Tetrahedra of a label image, or of grey values with SetIsovalue()."""


class vtkImageToPentatopeMeshFilter(_Mesher):
    """Pentatopes of a time series: of time steps, or of components with AddFrameTime()."""

    dimension = 4

    def AddFrameTime(self, time: float) -> None:
        """The time of each frame, one after the other, in place of those of the input."""
        self._change("times", [*self._values.get("times", []), time])

    def AddTimePlane(self, time: float) -> None:
        """A time that the mesh conforms to."""
        self._change("time_planes", [*self._values.get("time_planes", []), time])

    def TimePlanesAtFramesOn(self) -> None:
        """A time plane at each frame."""
        self._change("time_planes", "frames")

    def GetBoundary(self) -> Any:
        """Output 1: tetrahedra."""
        return self.GetOutputDataObject(1)


def _times_of(information: Any) -> Tuple[float, ...]:
    times = information.Get(Pipeline.TIME_STEPS()) if information.Has(Pipeline.TIME_STEPS()) else ()
    return tuple(times) if len(times) > 1 else ()


def _add_property(name: str, key: str, words: Tuple[str, ...], is_flag: bool) -> None:
    """Set..., Get..., and ...On and ...Off."""
    def set_value(self: _Mesher, value: Any) -> None:
        self._change(key, words[value] if words and not isinstance(value, str) else value)

    def get_value(self: _Mesher) -> Any:
        return self._values.get(key)

    setattr(_Mesher, "Set" + name, set_value)
    setattr(_Mesher, "Get" + name, get_value)
    if is_flag:
        setattr(_Mesher, name + "On", lambda self: set_value(self, True))
        setattr(_Mesher, name + "Off", lambda self: set_value(self, False))


for _key, _option in OPTIONS.items():
    if _option.property and _option.kind not in _LISTS:
        _add_property(_option.property, _key, _option.words, _option.kind == "flag")
