# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Slicer's side of a run: segmentation nodes, the CLI module, model nodes."""
import slicer
import vtk

from VoxplexMesherLib.Logic import MeshingError, Phase, RunState, Segment, labelMesh, meshedSegments


def readSegments(segmentationNode):
    """The segments of a segmentation node, in its order."""
    if segmentationNode is None:
        return []
    segmentation = segmentationNode.GetSegmentation()
    segments = []
    for index in range(segmentation.GetNumberOfSegments()):
        segmentId = segmentation.GetNthSegmentID(index)
        segment = segmentation.GetSegment(segmentId)
        segments.append(Segment(segmentId, segment.GetName(), tuple(segment.GetColor())))
    return segments


def insideOf(volumeNode):
    """What an isosurface of a volume node bounds, as the one segment that is meshed."""
    return Segment(volumeNode.GetID(), volumeNode.GetName(), (0.9, 0.85, 0.7))


def isVolume(node):
    """Whether it is a volume of grey values."""
    return node is not None and node.IsA("vtkMRMLScalarVolumeNode") and not node.IsA("vtkMRMLLabelMapVolumeNode")


class CommandLineRunner:
    """Runs the CLI module SegmentationToTetMesh on some segments of a segmentation, or on a volume.

    The segments are exported into a temporary label map, in which later segments win where they overlap. Slicer
    loads the results into the output nodes before the run counts as completed.
    """

    RESULTS = ("missingComponents", "smallestDihedralAngle", "largestDihedralAngle", "largestRadiusEdge", "smallestFacetAngle")
    RESULTS_OF_COMPARISON = ("hausdorffDistance", "nonManifoldEdges", "volumeError")

    def __init__(self):
        self.cliNode = None
        self.labelmapNode = None
        self.observation = None
        self.onChange = None
        self.results = ()

    def prepare(self, inputNode, segments, meshNode, surfacesNode=None):
        """What the next start() works on: a segmentation node, or a volume node."""
        self.inputs = (inputNode, segments, meshNode, surfacesNode)

    def start(self, parameters, onChange):
        inputNode, segments, meshNode, surfacesNode = self.inputs
        if not hasattr(slicer.modules, "segmentationtotetmesh"):
            raise MeshingError("The CLI module SegmentationToTetMesh is not loaded: add its folder to the module paths "
                               "in the application settings, and restart")
        self.onChange = onChange
        self.results = self.RESULTS + (self.RESULTS_OF_COMPARISON if parameters.get("quality") else ())
        if not isVolume(inputNode):
            inputNode = self.labelmapNode = self._exportSegments(inputNode, segments)
        nodes = {"inputLabels": inputNode, "outputMesh": meshNode}
        if surfacesNode is not None:
            nodes["outputSurfaces"] = surfacesNode
        self.cliNode = slicer.cli.run(slicer.modules.segmentationtotetmesh, None, {**parameters, **nodes},
                                      wait_for_completion=False, update_display=False)
        self.observation = self.cliNode.AddObserver(vtk.vtkCommand.ModifiedEvent, self._onModified)

    def cancel(self):
        if self.cliNode is not None:
            self.cliNode.Cancel()

    def _exportSegments(self, segmentationNode, segments):
        ids = vtk.vtkStringArray()
        for segment in meshedSegments(segments):
            ids.InsertNextValue(segment.id)
        node = slicer.mrmlScene.AddNewNodeByClass("vtkMRMLLabelMapVolumeNode", "Voxplex label map")
        if not slicer.modules.segmentations.logic().ExportSegmentsToLabelmapNode(
                segmentationNode, ids, node, None, slicer.vtkSegmentation.EXTENT_REFERENCE_GEOMETRY):
            slicer.mrmlScene.RemoveNode(node)
            raise MeshingError("The segments could not be exported into a label map")
        return node

    def _onModified(self, cliNode, event):
        if cliNode.IsBusy():
            self.onChange(RunState(Phase.RUNNING, cliNode.GetProgress() / 100.0, cliNode.GetStatusString()))
            return
        status, errors = cliNode.GetStatus(), cliNode.GetErrorText()
        if status == cliNode.Cancelled:
            state = RunState(Phase.CANCELLED)
        elif status & cliNode.ErrorsMask:
            state = RunState(Phase.FAILED, message=errors or cliNode.GetStatusString())
        elif status & cliNode.Completed:
            state = RunState(Phase.COMPLETED, 1.0, warnings=errors,
                             results={name: cliNode.GetParameterAsString(name) for name in self.results})
        else:
            return  # before the start
        self._cleanUp()
        self.onChange(state)

    def _cleanUp(self):
        """The scene keeps the inputs and the outputs only."""
        self.cliNode.RemoveObserver(self.observation)
        displayNode = self.labelmapNode.GetDisplayNode() if self.labelmapNode else None
        colorNode = displayNode.GetColorNode() if displayNode else None
        for node in (self.cliNode, self.labelmapNode, colorNode):
            if node is not None:
                slicer.mrmlScene.RemoveNode(node)
        self.cliNode = self.labelmapNode = self.observation = None


def makeColorNode(name, segments):
    """A colour table with the names and colours of the segments that are meshed."""
    chosen = meshedSegments(segments)
    node = slicer.mrmlScene.CreateNodeByClass("vtkMRMLColorTableNode")
    node.SetName(slicer.mrmlScene.GenerateUniqueName(name))
    node.SetTypeToUser()
    node.HideFromEditorsOff()
    slicer.mrmlScene.AddNode(node)
    node.UnRegister(None)
    node.SetNumberOfColors(len(chosen) + 1)
    node.SetNamesInitialised(True)
    node.SetColor(0, "background", 0.0, 0.0, 0.0, 0.0)
    for label, segment in enumerate(chosen, 1):
        node.SetColor(label, segment.name, *segment.color, 1.0)
    return node


def showMesh(modelNode, segments):
    """Gives the mesh the names of the segments, and shows each tetrahedron in the colour of its own."""
    labelMesh(modelNode.GetMesh(), segments)
    modelNode.CreateDefaultDisplayNodes()
    displayNode = modelNode.GetDisplayNode()
    colorNode = makeColorNode(modelNode.GetName() + " labels", segments)
    displayNode.SetAndObserveColorNodeID(colorNode.GetID())
    displayNode.SetActiveScalar("Label", vtk.vtkAssignAttribute.CELL_DATA)
    displayNode.SetScalarRangeFlag(slicer.vtkMRMLDisplayNode.UseColorNodeScalarRange)
    displayNode.SetScalarVisibility(True)
    displayNode.SetEdgeVisibility(True)
    displayNode.SetVisibility(True)


def showSurfaces(modelNode):
    """The interfaces lie inside the mesh: they are loaded, but not shown."""
    modelNode.CreateDefaultDisplayNodes()
    modelNode.GetDisplayNode().SetVisibility(False)
