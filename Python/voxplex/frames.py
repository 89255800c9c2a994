# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""A list of images as the beginning of a temporal pipeline."""

from __future__ import annotations

from typing import Any, List, Sequence

from vtkmodules.util.vtkAlgorithm import VTKPythonAlgorithmBase
from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkImageData
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as Pipeline


def frame_times(frames: Sequence[vtkImageData]) -> List[float]:
    """The times that the frames carry (DATA_TIME_STEP); 0, 1, 2 ... if none of them carries one.

    Raises ValueError if some do and some do not.
    """
    key = vtkDataObject.DATA_TIME_STEP()
    dated = [frame.GetInformation().Has(key) == 1 for frame in frames]
    if all(dated):
        return [frame.GetInformation().Get(key) for frame in frames]
    if any(dated):
        raise ValueError(f"frame {dated.index(False)} has no time, but others have; pass times=")
    return [float(number) for number in range(len(frames))]


class FrameSource(VTKPythonAlgorithmBase):
    """Announces the time of each frame, and gives the one that is asked for without copying voxels."""

    def __init__(self, frames: Sequence[vtkImageData], times: Sequence[float]) -> None:
        super().__init__(nInputPorts=0, nOutputPorts=1, outputType="vtkImageData")
        self._frames = list(frames)
        self._times = list(times)

    def RequestInformation(self, _request: Any, _inputs: Any, outputs: Any) -> int:
        information = outputs.GetInformationObject(0)
        information.Set(Pipeline.WHOLE_EXTENT(), self._frames[0].GetExtent(), 6)
        information.Set(Pipeline.TIME_STEPS(), self._times, len(self._times))
        information.Set(Pipeline.TIME_RANGE(), [self._times[0], self._times[-1]], 2)
        return 1

    def RequestData(self, _request: Any, _inputs: Any, outputs: Any) -> int:
        information = outputs.GetInformationObject(0)
        index = 0
        if information.Has(Pipeline.UPDATE_TIME_STEP()):
            wanted = information.Get(Pipeline.UPDATE_TIME_STEP())
            index = min(range(len(self._times)), key=lambda number: abs(self._times[number] - wanted))
        result = vtkImageData.GetData(outputs, 0)
        result.ShallowCopy(self._frames[index])
        result.GetInformation().Set(vtkDataObject.DATA_TIME_STEP(), self._times[index])
        return 1
