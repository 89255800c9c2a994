# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""The beginning of a temporal pipeline of VTK, for tests."""
from vtkmodules.util.vtkAlgorithm import VTKPythonAlgorithmBase
from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkImageData
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as Pipeline


class Series(VTKPythonAlgorithmBase):
    """A temporal source: images, or None for those that fail."""

    def __init__(self, frames, times):
        super().__init__(nInputPorts=0, nOutputPorts=1, outputType="vtkImageData")
        self.frames, self.times, self.asked = list(frames), list(times), []

    def RequestInformation(self, _request, _inputs, outputs):
        info = outputs.GetInformationObject(0)
        info.Set(Pipeline.WHOLE_EXTENT(), self.frames[0].GetExtent(), 6)
        info.Set(vtkDataObject.SPACING(), self.frames[0].GetSpacing(), 3)
        if self.times:
            info.Set(Pipeline.TIME_STEPS(), self.times, len(self.times))
            info.Set(Pipeline.TIME_RANGE(), (self.times[0], self.times[-1]), 2)
        return 1

    def RequestData(self, _request, _inputs, outputs):
        info, number = outputs.GetInformationObject(0), 0
        if info.Has(Pipeline.UPDATE_TIME_STEP()):
            self.asked.append(info.Get(Pipeline.UPDATE_TIME_STEP()))
            number = self.times.index(self.asked[-1])
        if self.frames[number] is None:
            return 0
        output = vtkImageData.GetData(outputs)
        output.ShallowCopy(self.frames[number])
        if self.times:
            output.GetInformation().Set(vtkDataObject.DATA_TIME_STEP(), self.times[number])
        return 1
