# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Stand-ins for MRML's nodes and scene: what is stored is stored, who observes is told."""
import numpy as np
import vtk

MODIFIED = vtk.vtkCommand.ModifiedEvent


class Observed:
    def __init__(self):
        self.observers = {}

    def AddObserver(self, event, callback):
        tag = max(self.observers, default=0) + 1
        self.observers[tag] = (event, callback)
        return tag

    def RemoveObserver(self, tag):
        del self.observers[tag]

    def InvokeEvent(self, event):
        for observed, callback in list(self.observers.values()):
            if observed == event:
                callback(self, event)


class vtkMRMLNode(Observed):
    def __init__(self, name=""):
        super().__init__()
        self.name, self.id, self.scene = name, None, None

    def GetID(self):
        return self.id

    def GetName(self):
        return self.name

    def IsA(self, className):
        return className in (c.__name__ for c in type(self).__mro__)

    def SetName(self, name):
        self.name = name

    def Modified(self):
        self.InvokeEvent(MODIFIED)


class vtkMRMLScriptedModuleNode(vtkMRMLNode):
    """A parameter node."""

    def __init__(self, name=""):
        super().__init__(name)
        self.parameters, self.references = {}, {}
        self.modifying = self.pending = False

    def GetParameter(self, name):
        return self.parameters.get(name, "")

    def SetParameter(self, name, value):
        if not isinstance(value, str):
            raise TypeError("parameters are text, not %r" % value)
        self._store(self.parameters, name, value)

    def GetNodeReference(self, role):
        return self.scene.nodes.get(self.references.get(role))

    def SetNodeReferenceID(self, role, nodeId):
        if not (nodeId is None or isinstance(nodeId, str)):
            raise TypeError("an id is wanted, not %r" % nodeId)
        self._store(self.references, role, nodeId or None)

    def _store(self, where, name, value):
        if where.get(name) == value:
            return
        where[name] = value
        if self.modifying:
            self.pending = True
        else:
            self.Modified()

    def StartModify(self):
        was, self.modifying = self.modifying, True
        return was

    def EndModify(self, wasModifying):
        self.modifying = wasModifying
        if self.pending and not wasModifying:
            self.pending = False
            self.Modified()


class vtkSegment:
    def __init__(self, name, color, voxels):
        self.name, self.color, self.voxels = name, color, voxels

    def GetName(self):
        return self.name

    def GetColor(self):
        return self.color


class vtkSegmentation(Observed):
    SegmentAdded, SegmentRemoved, SegmentModified = 62100, 62101, 62102
    EXTENT_REFERENCE_GEOMETRY = 0

    def __init__(self):
        super().__init__()
        self.segments = {}

    def add(self, segmentId, name, color, voxels):
        self.segments[segmentId] = vtkSegment(name, color, voxels)
        self.InvokeEvent(self.SegmentAdded)

    def remove(self, segmentId):
        del self.segments[segmentId]
        self.InvokeEvent(self.SegmentRemoved)

    def GetNumberOfSegments(self):
        return len(self.segments)

    def GetNthSegmentID(self, index):
        return list(self.segments)[index]

    def GetSegment(self, segmentId):
        return self.segments.get(segmentId)

    def GetNumberOfLayers(self):
        """One if no segments overlap."""
        voxels = [segment.voxels for segment in self.segments.values()]
        return 1 if np.sum(voxels, axis=0).max() <= 1 else len(voxels)


class vtkMRMLSegmentationNode(vtkMRMLNode):
    def __init__(self, name=""):
        super().__init__(name)
        self.segmentation = vtkSegmentation()

    def GetSegmentation(self):
        return self.segmentation

    def CreateDefaultDisplayNodes(self):
        pass

    def SetReferenceImageGeometryParameterFromVolumeNode(self, volumeNode):
        if (volumeNode.image.GetDimensions(), volumeNode.origin) != ((91, 31, 31), (-15.0, -15.0, -15.0)):
            raise AssertionError("the grid is another one")

    def AddSegmentFromClosedSurfaceRepresentation(self, surface, name, color):
        """The ball in the surface's bounding box, on a grid of 1 mm from -15 to 75 in x, -15 to 15 in y and z."""
        bounds = np.array(surface.GetBounds()).reshape(3, 2)
        z, y, x = np.mgrid[-15:16, -15:16, -15:76]
        center, radius = bounds.mean(axis=1), np.ptp(bounds, axis=1).max() / 2
        distances = sum((axis - c)**2 for axis, c in zip((x, y, z), center))
        self.segmentation.add(name, name, tuple(color), distances <= radius**2)


class vtkMRMLColorTableNode(vtkMRMLNode):
    def __init__(self, name=""):
        super().__init__(name)
        self.colors, self.isUser, self.references = [], False, 1

    def SetTypeToUser(self):
        self.isUser = True

    def HideFromEditorsOff(self):
        pass

    def UnRegister(self, caller):
        self.references -= 1

    def SetNumberOfColors(self, count):
        self.colors = [None] * count

    def SetNamesInitialised(self, value):
        pass

    def SetColor(self, index, name, r, g, b, a):
        self.colors[index] = (name, (r, g, b, a))


class vtkMRMLDisplayNode(vtkMRMLNode):
    UseColorNodeScalarRange = 2

    def __init__(self, name=""):
        super().__init__(name)
        self.colorNodeId = self.activeScalar = self.rangeFlag = None
        self.shown = {}

    def GetColorNode(self):
        return self.scene.nodes.get(self.colorNodeId)

    def SetAndObserveColorNodeID(self, nodeId):
        self.colorNodeId = nodeId

    def SetActiveScalar(self, name, association):
        self.activeScalar = (name, association)

    def SetScalarRangeFlag(self, flag):
        self.rangeFlag = flag

    def SetScalarVisibility(self, value):
        self.shown["scalars"] = value

    def SetEdgeVisibility(self, value):
        self.shown["edges"] = value

    def SetVisibility(self, value):
        self.shown["node"] = value


class vtkMRMLDisplayableNode(vtkMRMLNode):
    def __init__(self, name=""):
        super().__init__(name)
        self.displayNode = None

    def CreateDefaultDisplayNodes(self):
        if self.displayNode is None:
            self.displayNode = self.scene.AddNewNodeByClass("vtkMRMLDisplayNode")

    def GetDisplayNode(self):
        return self.displayNode


class vtkMRMLModelNode(vtkMRMLDisplayableNode):
    def __init__(self, name=""):
        super().__init__(name)
        self.mesh = None

    def GetMesh(self):
        return self.mesh

    def SetAndObserveMesh(self, mesh):
        self.mesh = mesh


class vtkMRMLScalarVolumeNode(vtkMRMLDisplayableNode):
    """A volume: its voxels, and where they lie."""

    def __init__(self, name=""):
        super().__init__(name)
        self.array = self.geometry = self.image = self.origin = None

    def SetAndObserveImageData(self, image):
        self.image = image

    def SetOrigin(self, *origin):
        self.origin = origin

    def GetIJKToRASMatrix(self, matrix):
        """The geometry is in LPS coordinates, as in files."""
        columns = np.column_stack([self.geometry.direction * self.geometry.spacing, self.geometry.origin])
        for row, sign in enumerate((-1, -1, 1)):
            for column in range(4):
                matrix.SetElement(row, column, sign * columns[row, column])


class vtkMRMLLabelMapVolumeNode(vtkMRMLScalarVolumeNode):
    pass


CLASSES = {c.__name__: c for c in (vtkMRMLScriptedModuleNode, vtkMRMLSegmentationNode, vtkMRMLColorTableNode,
                                   vtkMRMLDisplayNode, vtkMRMLModelNode, vtkMRMLScalarVolumeNode,
                                   vtkMRMLLabelMapVolumeNode)}


class vtkMRMLScene(Observed):
    StartCloseEvent, EndCloseEvent = 66003, 66004

    def __init__(self):
        super().__init__()
        self.nodes, self.count = {}, 0

    def AddNode(self, node):
        self.count += 1
        node.id, node.scene = "%s%d" % (type(node).__name__, self.count), self
        self.nodes[node.id] = node
        return node

    def AddNewNodeByClass(self, className, name=""):
        return self.AddNode(CLASSES[className](name or className))

    def CreateNodeByClass(self, className):
        node = CLASSES[className]()
        node.references = 2
        return node

    def GenerateUniqueName(self, name):
        taken = {node.name for node in self.nodes.values()}
        return name if name not in taken else "%s_%d" % (name, self.count)

    def RemoveNode(self, node):
        del self.nodes[node.id]

    def GetFirstNodeByClass(self, className):
        return next((node for node in self.nodes.values() if type(node).__name__ == className), None)

    def GetSingletonNode(self, tag, className):
        return next((node for node in self.nodes.values()
                     if type(node).__name__ == className and node.name == tag), None)

    def Clear(self):
        self.InvokeEvent(self.StartCloseEvent)
        self.nodes.clear()
        self.InvokeEvent(self.EndCloseEvent)

    def names(self, className):
        return sorted(node.name for node in self.nodes.values() if type(node).__name__ == className)


def exportSegments(segmentationNode, ids, labelmapNode, referenceNode, extent):
    """ExportSegmentsToLabelmapNode: labels 1, 2, ... in the order of the ids; later ones win."""
    if referenceNode is not None or extent != vtkSegmentation.EXTENT_REFERENCE_GEOMETRY:
        raise AssertionError("the whole grid is wanted")
    segmentation = segmentationNode.GetSegmentation()
    array = None
    for index in range(ids.GetNumberOfValues()):
        voxels = segmentation.GetSegment(ids.GetValue(index)).voxels
        array = np.zeros(voxels.shape, np.uint8) if array is None else array
        array[voxels] = index + 1
    labelmapNode.array = array
    labelmapNode.CreateDefaultDisplayNodes()
    colors = labelmapNode.scene.AddNewNodeByClass("vtkMRMLColorTableNode", labelmapNode.name + "_ColorTable")
    labelmapNode.displayNode.SetAndObserveColorNodeID(colors.GetID())
    return True
