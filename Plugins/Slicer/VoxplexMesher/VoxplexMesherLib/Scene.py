# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Slicer's side of a run: segmentation nodes, volumes, model nodes."""
import os
import re

import slicer
import vtk

from VoxplexMesherLib.Logic import MeshingError, Segment, labelMesh, meshedSegments


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


def writeImages(images, inputNode, segments, folder):
    """Writes a volume, or the segments that are meshed, as NRRD; images is a module of the package voxplex.

    Segments that may overlap become masks. Returns what messages call each file, by its path, in the order of labels.
    """
    path = os.path.join(folder, "image.nrrd")
    if isVolume(inputNode):
        images.write_nrrd(_imageOf(images, inputNode), path, hidden_is_outside=False)
        return {path: inputNode.GetName()}
    chosen = meshedSegments(segments)
    if len(chosen) == 1 or inputNode.GetSegmentation().GetNumberOfLayers() == 1:
        _writeSegments(images, inputNode, chosen, path)
        return {path: inputNode.GetName()}
    names = {}
    for label, segment in enumerate(chosen, 1):
        file = re.sub(r'[\0-\x1f<>:"/\\|?*]', "_", segment.name)[:50] + ".nrrd"  # warnings show it
        path = os.path.join(folder, str(label), file)
        os.mkdir(os.path.dirname(path))
        _writeSegments(images, inputNode, [segment], path)
        names[path] = segment.name
    return names


def _writeSegments(images, segmentationNode, segments, path):
    node = _exportSegments(segmentationNode, segments)
    try:
        images.write_nrrd(_imageOf(images, node), path, hidden_is_outside=False)
    finally:
        displayNode = node.GetDisplayNode()
        colorNode = displayNode.GetColorNode() if displayNode else None
        for temporary in filter(None, (node, displayNode, colorNode)):
            slicer.mrmlScene.RemoveNode(temporary)


def _exportSegments(segmentationNode, segments):
    """A temporary label map, with labels 1, 2, ..."""
    ids = vtk.vtkStringArray()
    for segment in segments:
        ids.InsertNextValue(segment.id)
    node = slicer.mrmlScene.AddNewNodeByClass("vtkMRMLLabelMapVolumeNode", "Voxplex label map")
    if not slicer.modules.segmentations.logic().ExportSegmentsToLabelmapNode(
            segmentationNode, ids, node, None, slicer.vtkSegmentation.EXTENT_REFERENCE_GEOMETRY):
        slicer.mrmlScene.RemoveNode(node)
        raise MeshingError("The segments could not be exported into a label map")
    return node


def _imageOf(images, volumeNode):
    """Slicer's scene is in RAS coordinates."""
    matrix = vtk.vtkMatrix4x4()
    volumeNode.GetIJKToRASMatrix(matrix)
    affine = [[matrix.GetElement(row, column) for column in range(4)] for row in range(4)]
    return images.Image(slicer.util.arrayFromVolume(volumeNode), affine=affine)


def loadMesh(modelNode, path):
    """What the program wrote in RAS coordinates."""
    reader = vtk.vtkXMLPolyDataReader() if path.endswith(".vtp") else vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(path)
    reader.Update()
    mesh = reader.GetOutput()
    mesh.GetFieldData().RemoveArray("SPACE")  # Slicer writes its own, but not beside this one
    modelNode.SetAndObserveMesh(mesh)


def makeColorNode(name, labels):
    """A colour table with the names and colours of segments, by their labels."""
    node = slicer.mrmlScene.CreateNodeByClass("vtkMRMLColorTableNode")
    node.SetName(slicer.mrmlScene.GenerateUniqueName(name))
    node.SetTypeToUser()
    node.HideFromEditorsOff()
    slicer.mrmlScene.AddNode(node)
    node.UnRegister(None)
    node.SetNumberOfColors(max(labels) + 1)
    if not hasattr(node, "SetColorDefined"):  # which newer versions have in its place
        node.SetNamesInitialised(True)
    node.SetColor(0, "background", 0.0, 0.0, 0.0, 0.0)
    for label, segment in labels.items():
        node.SetColor(label, segment.name, *segment.color, 1.0)
    return node


def showMesh(modelNode, labels):
    """Gives the mesh the names of segments, by their labels, and shows each tetrahedron in the colour of its own."""
    labelMesh(modelNode.GetMesh(), labels)
    modelNode.CreateDefaultDisplayNodes()
    displayNode = modelNode.GetDisplayNode()
    colorNode = makeColorNode(modelNode.GetName() + " labels", labels)
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
