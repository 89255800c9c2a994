# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""A stand-in for Slicer's Python module: enough of it to run the scripted module from Apply to the coloured mesh, with
the real program. It knows the names that are used and no others.

The geometry of label maps, which the real one takes from the segmentation, is that of labelmapGeometry.
"""
import os
import tempfile
import types

import images
import qt

from slicer import nodes, util  # noqa: F401
from slicer.nodes import vtkMRMLDisplayNode, vtkMRMLNode, vtkMRMLScene, vtkSegmentation  # noqa: F401

labelmapGeometry = images.Geometry()
mrmlScene = vtkMRMLScene()
app = types.SimpleNamespace(processEvents=qt.processEvents, temporaryPath=tempfile.gettempdir(),
                            startupEnvironment=lambda: {"PATH": os.defpath})


def _exportSegments(segmentationNode, ids, labelmapNode, referenceNode, extent):
    labelmapNode.geometry = labelmapGeometry
    return nodes.exportSegments(segmentationNode, ids, labelmapNode, referenceNode, extent)


_segmentationsLogic = types.SimpleNamespace(ExportSegmentsToLabelmapNode=_exportSegments)
modules = types.SimpleNamespace(segmentations=types.SimpleNamespace(logic=lambda: _segmentationsLogic))


class qMRMLNodeComboBox(qt.Object):
    PROPERTIES = ("nodeTypes", "showChildNodeTypes", "addEnabled", "removeEnabled", "renameEnabled", "noneEnabled", "_node")
    SIGNALS = ("currentNodeChanged(vtkMRMLNode*)",)

    def setMRMLScene(self, scene):
        pass

    def setCurrentNode(self, node):
        offered = node is None or type(node).__name__ in self.nodeTypes or (
            self.showChildNodeTypes is not False and any(node.IsA(name) for name in self.nodeTypes))
        if not offered:
            raise AssertionError("%s is not offered" % node)
        if node is not self._node:
            self._set("_node", node)
            self.emit("currentNodeChanged(vtkMRMLNode*)", node)

    def currentNode(self):
        return self._node

    @property
    def currentNodeID(self):
        return self._node.GetID() if self._node else ""
