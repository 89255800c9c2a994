# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""The logic as Slicer's scripts see it: everything that a run needs is in a parameter node.

    logic = VoxplexMesherLogic()
    node = logic.getParameterNode()
    node.SetNodeReferenceID("Segmentation", segmentationNode.GetID())
    node.SetParameter("delta", "2.0")
    logic.apply(node)      # returns at once; log and onChange are called later
    logic.wait()           # for scripts

References: Segmentation, or Volume to mesh an isosurface; OutputMesh, OutputSurfaces (optional). Parameters: those of Logic.Settings, and Segments, the
choices of Logic.storeChoices().
"""
import logging

import slicer
from slicer.ScriptedLoadableModule import ScriptedLoadableModuleLogic

from VoxplexMesherLib.Logic import (MeshingError, MeshingLogic, Phase, RunState, Settings, describeMesh, describeQuality,
                                    mergeChoices, segmentsByLabel, storeChoices)
from VoxplexMesherLib.Program import ProgramRunner
from VoxplexMesherLib.Scene import insideOf, readSegments, showMesh, showSurfaces


class VoxplexMesherLogic(ScriptedLoadableModuleLogic):
    def __init__(self):
        ScriptedLoadableModuleLogic.__init__(self)
        self.log = logging.info  # called with each line
        self.onChange = lambda state: None  # called with each RunState
        self.runner = ProgramRunner()
        self.meshing = MeshingLogic(self.runner, log=lambda line: self.log(line), onChange=self._onChange)
        self._outputs = None

    # --- The parameter node ---

    def setDefaultParameters(self, parameterNode):
        for name, text in Settings().toTexts().items():
            if not parameterNode.GetParameter(name):
                parameterNode.SetParameter(name, text)

    def settings(self, parameterNode):
        return Settings.fromTexts(parameterNode.GetParameter)

    def segments(self, parameterNode):
        """The segments of the chosen segmentation with their stored choices; of a volume the inside of its isosurface."""
        volumeNode = parameterNode.GetNodeReference("Volume")
        if volumeNode is not None:
            return [insideOf(volumeNode)]
        return mergeChoices(readSegments(parameterNode.GetNodeReference("Segmentation")),
                            parameterNode.GetParameter("Segments"))

    def storeSegments(self, parameterNode, segments):
        parameterNode.SetParameter("Segments", storeChoices(segments))

    # --- Runs ---

    def apply(self, parameterNode):
        """Begins a run; a mesh node is made if none is chosen. Raises MeshingError."""
        volumeNode = parameterNode.GetNodeReference("Volume")
        inputNode = volumeNode or parameterNode.GetNodeReference("Segmentation")
        if inputNode is None:
            raise MeshingError("Choose a segmentation or a volume first")
        if volumeNode is not None and parameterNode.GetNodeReference("Segmentation") is not None:
            raise MeshingError("Choose a segmentation or a volume, not both")
        segments = self.segments(parameterNode)
        meshNode = parameterNode.GetNodeReference("OutputMesh")
        if meshNode is None:
            meshNode = slicer.mrmlScene.AddNewNodeByClass("vtkMRMLModelNode", inputNode.GetName() + " mesh")
            parameterNode.SetNodeReferenceID("OutputMesh", meshNode.GetID())
        surfacesNode = parameterNode.GetNodeReference("OutputSurfaces")
        self._outputs = (meshNode, surfacesNode, segments)
        self.runner.prepare(inputNode, segments, meshNode, surfacesNode)
        self.meshing.start(segments, self.settings(parameterNode), isosurface=volumeNode is not None)

    def cancel(self):
        self.meshing.cancel()

    def wait(self):
        """Lets Slicer work until the run has ended."""
        while self.meshing.isBusy:
            slicer.app.processEvents()

    def _onChange(self, state):
        if state.phase is Phase.COMPLETED:
            state = self._show(state)
        self.onChange(state)

    def _show(self, state):
        meshNode, surfacesNode, segments = self._outputs
        labels = segmentsByLabel(segments, state.figures)
        try:
            for line in describeMesh(meshNode.GetMesh(), labels) + describeQuality(state.figures):
                self.log(line)
        except MeshingError as error:
            self.log("Failed: %s" % error)
            return RunState(Phase.FAILED, message=str(error))
        showMesh(meshNode, labels)
        if surfacesNode is not None:
            showSurfaces(surfacesNode)
        return state
