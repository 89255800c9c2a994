# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""The module's panel. All that it knows is in the parameter node, so that scenes keep it."""
import ctk
import qt
import slicer
import vtk
from slicer.ScriptedLoadableModule import ScriptedLoadableModuleWidget
from slicer.util import VTKObservationMixin

from VoxplexMesherLib.Logic import MeshingError, Phase, parseSize
from VoxplexMesherLib.ModuleLogic import VoxplexMesherLogic

COLUMNS = ("Segment", "Mesh it", "Size (mm)")
NAME, MESH, SIZE = range(3)
SEGMENT_ID = qt.Qt.UserRole


class VoxplexMesherWidget(ScriptedLoadableModuleWidget, VTKObservationMixin):
    def __init__(self, parent=None):
        ScriptedLoadableModuleWidget.__init__(self, parent)
        VTKObservationMixin.__init__(self)
        self.logic = None
        self.parameterNode = None
        self.segmentationNode = None  # the one that is observed
        self.updating = False  # while the panel follows the parameter node

    # --- Building the panel ---

    def setup(self):
        ScriptedLoadableModuleWidget.setup(self)
        self.logic = VoxplexMesherLogic()
        self.logic.log = self.appendToLog
        self.logic.onChange = self.showState
        self.buildNodes()
        self.buildSegments()
        self.buildDensity()
        self.buildAdvanced()
        self.buildRun()
        self.layout.addStretch(1)
        self.addObserver(slicer.mrmlScene, slicer.mrmlScene.StartCloseEvent, self.onSceneStartClose)
        self.addObserver(slicer.mrmlScene, slicer.mrmlScene.EndCloseEvent, self.onSceneEndClose)
        self.initializeParameterNode()

    def addSection(self, title, collapsed=False):
        section = ctk.ctkCollapsibleButton()
        section.text = title
        section.collapsed = collapsed
        self.layout.addWidget(section)
        return qt.QFormLayout(section)

    def buildNodes(self):
        form = self.addSection("Input and output")
        self.segmentationSelector = self.makeNodeSelector("vtkMRMLSegmentationNode", "The segmentation to mesh")
        self.meshSelector = self.makeNodeSelector("vtkMRMLModelNode", "The mesh; left empty, a new model is made",
                                                  output=True)
        self.surfacesSelector = self.makeNodeSelector(
            "vtkMRMLModelNode", "The triangles between segments, and between segments and background; left empty, "
            "they are not made", output=True)
        form.addRow("Segmentation:", self.segmentationSelector)
        form.addRow("Mesh:", self.meshSelector)
        form.addRow("Interfaces:", self.surfacesSelector)

    def makeNodeSelector(self, nodeType, toolTip, output=False):
        selector = slicer.qMRMLNodeComboBox()
        selector.nodeTypes = [nodeType]
        selector.addEnabled = output
        selector.removeEnabled = output
        selector.renameEnabled = output
        selector.noneEnabled = True
        selector.setMRMLScene(slicer.mrmlScene)
        selector.setToolTip(toolTip)
        selector.connect("currentNodeChanged(vtkMRMLNode*)", self.updateParameterNodeFromGUI)
        return selector

    def buildSegments(self):
        form = self.addSection("Segments")
        self.segmentTable = qt.QTableWidget()
        self.segmentTable.setColumnCount(len(COLUMNS))
        self.segmentTable.setHorizontalHeaderLabels(list(COLUMNS))
        self.segmentTable.setToolTip("Segments that are not checked become background. Size is the upper bound of the "
                                     "circumradii of a segment's elements; leave it empty for none.")
        self.segmentTable.connect("itemChanged(QTableWidgetItem*)", self.onSegmentItemChanged)
        form.addRow(self.segmentTable)

    def buildDensity(self):
        form = self.addSection("Density")
        self.deltaSpinBox = self.makeSpinBox(0.0, 1000.0, 0.1, 3, "from the spacing", "Sampling density of the "
                                             "interfaces: the edges of their triangles are about one to two times as long")
        self.sizeSpinBox = self.makeSpinBox(0.0, 1000.0, 0.5, 3, "no bound",
                                            "Upper bound of the circumradii of all elements")
        form.addRow("Delta (mm):", self.deltaSpinBox)
        form.addRow("Largest element (mm):", self.sizeSpinBox)

    def buildAdvanced(self):
        form = self.addSection("Advanced", collapsed=True)
        self.smoothingSpinBox = self.makeSpinBox(0.0, 10.0, 0.1, 2, "off", "How far voxel stairs are smoothed, in voxels")
        self.radiusEdgeSpinBox = self.makeSpinBox(1.0, 10.0, 0.1, 3, "", "Upper bound of circumradius over shortest edge; "
                                                  "below 1.932 only with Force")
        self.facetAngleSpinBox = self.makeSpinBox(0.0, 30.0, 1.0, 1, "", "Lower bound of the angles of triangles on the "
                                                  "interfaces, in degrees")
        self.threadsSpinBox = qt.QSpinBox()
        self.threadsSpinBox.setRange(0, 1024)
        self.threadsSpinBox.specialValueText = "all cores"
        self.threadsSpinBox.setToolTip("With 1 the mesh is the same in every run")
        self.threadsSpinBox.connect("valueChanged(int)", self.updateParameterNodeFromGUI)
        self.forceCheckBox = qt.QCheckBox()
        self.forceCheckBox.setToolTip("Go on although the mesh is estimated not to fit into memory, or the radius-edge "
                                      "ratio is too low")
        self.forceCheckBox.connect("toggled(bool)", self.updateParameterNodeFromGUI)
        form.addRow("Smoothing (voxels):", self.smoothingSpinBox)
        form.addRow("Radius-edge ratio:", self.radiusEdgeSpinBox)
        form.addRow("Facet angle:", self.facetAngleSpinBox)
        form.addRow("Threads:", self.threadsSpinBox)
        form.addRow("Force:", self.forceCheckBox)

    def makeSpinBox(self, low, high, step, decimals, textOfLow, toolTip):
        box = qt.QDoubleSpinBox()
        box.decimals = decimals
        box.setRange(low, high)
        box.singleStep = step
        box.specialValueText = textOfLow
        box.setToolTip(toolTip)
        box.connect("valueChanged(double)", self.updateParameterNodeFromGUI)
        return box

    def buildRun(self):
        self.applyButton = qt.QPushButton("Apply")
        self.applyButton.connect("clicked(bool)", self.onApply)
        self.cancelButton = qt.QPushButton("Cancel")
        self.cancelButton.connect("clicked(bool)", self.onCancel)
        buttons = qt.QHBoxLayout()
        buttons.addWidget(self.applyButton)
        buttons.addWidget(self.cancelButton)
        self.layout.addLayout(buttons)
        self.progressBar = qt.QProgressBar()
        self.progressBar.setRange(0, 100)
        self.layout.addWidget(self.progressBar)
        self.logText = qt.QPlainTextEdit()
        self.logText.readOnly = True
        self.layout.addWidget(self.logText)

    # --- The parameter node ---

    def cleanup(self):
        self.removeObservers()

    def enter(self):
        self.initializeParameterNode()

    def exit(self):
        self.setParameterNode(None)

    def onSceneStartClose(self, caller, event):
        self.logic.cancel()
        self.setParameterNode(None)

    def onSceneEndClose(self, caller, event):
        if self.parent.isEntered:
            self.initializeParameterNode()

    def initializeParameterNode(self):
        node = self.logic.getParameterNode()
        self.logic.setDefaultParameters(node)
        if node.GetNodeReference("Segmentation") is None:
            first = slicer.mrmlScene.GetFirstNodeByClass("vtkMRMLSegmentationNode")
            if first is not None:
                node.SetNodeReferenceID("Segmentation", first.GetID())
        self.setParameterNode(node)

    def setParameterNode(self, node):
        modified = vtk.vtkCommand.ModifiedEvent
        if self.parameterNode is not None:
            self.removeObserver(self.parameterNode, modified, self.updateGUIFromParameterNode)
        self.parameterNode = node
        if node is not None:
            self.addObserver(node, modified, self.updateGUIFromParameterNode)
        self.observeSegmentation(node.GetNodeReference("Segmentation") if node else None)
        self.updateGUIFromParameterNode()

    def observeSegmentation(self, node):
        """Segments may be added, removed or renamed at any time."""
        if node is self.segmentationNode:
            return
        events = (slicer.vtkSegmentation.SegmentAdded, slicer.vtkSegmentation.SegmentRemoved,
                  slicer.vtkSegmentation.SegmentModified)
        if self.segmentationNode is not None:
            for event in events:
                self.removeObserver(self.segmentationNode.GetSegmentation(), event, self.updateGUIFromParameterNode)
        self.segmentationNode = node
        if node is not None:
            for event in events:
                self.addObserver(node.GetSegmentation(), event, self.updateGUIFromParameterNode)

    def updateGUIFromParameterNode(self, caller=None, event=None):
        if self.parameterNode is None or self.updating:
            return
        self.updating = True
        node = self.parameterNode
        self.observeSegmentation(node.GetNodeReference("Segmentation"))
        self.segmentationSelector.setCurrentNode(node.GetNodeReference("Segmentation"))
        self.meshSelector.setCurrentNode(node.GetNodeReference("OutputMesh"))
        self.surfacesSelector.setCurrentNode(node.GetNodeReference("OutputSurfaces"))
        settings = self.logic.settings(node)
        for name in ("delta", "size", "smoothing", "radiusEdge", "facetAngle", "threads"):
            getattr(self, name + "SpinBox").value = getattr(settings, name)
        self.forceCheckBox.checked = settings.force
        self.fillSegmentTable(self.logic.segments(node))
        self.updateButtons()
        self.updating = False

    def updateParameterNodeFromGUI(self, *_):
        if self.parameterNode is None or self.updating:
            return
        node = self.parameterNode
        wasModifying = node.StartModify()
        node.SetNodeReferenceID("Segmentation", self.segmentationSelector.currentNodeID)
        node.SetNodeReferenceID("OutputMesh", self.meshSelector.currentNodeID)
        node.SetNodeReferenceID("OutputSurfaces", self.surfacesSelector.currentNodeID)
        for name in ("delta", "size", "smoothing", "radiusEdge", "facetAngle", "threads"):
            node.SetParameter(name, repr(getattr(self, name + "SpinBox").value))
        node.SetParameter("force", "true" if self.forceCheckBox.checked else "false")
        node.EndModify(wasModifying)

    # --- The table of segments ---

    def fillSegmentTable(self, segments):
        self.segmentTable.setRowCount(len(segments))
        for row, segment in enumerate(segments):
            name = qt.QTableWidgetItem(segment.name)
            name.setFlags(qt.Qt.ItemIsEnabled)
            name.setData(SEGMENT_ID, segment.id)
            name.setData(qt.Qt.DecorationRole, qt.QColor.fromRgbF(*segment.color))
            mesh = qt.QTableWidgetItem()
            mesh.setFlags(qt.Qt.ItemIsEnabled | qt.Qt.ItemIsUserCheckable)
            mesh.setCheckState(qt.Qt.Checked if segment.mesh else qt.Qt.Unchecked)
            size = qt.QTableWidgetItem("%g" % segment.size if segment.size else "")
            for column, item in ((NAME, name), (MESH, mesh), (SIZE, size)):
                self.segmentTable.setItem(row, column, item)

    def onSegmentItemChanged(self, item):
        if self.parameterNode is None or self.updating:
            return
        segments = {segment.id: segment for segment in self.logic.segments(self.parameterNode)}
        segment = segments[self.segmentTable.item(item.row(), NAME).data(SEGMENT_ID)]
        if item.column() == MESH:
            segment.mesh = item.checkState() == qt.Qt.Checked
        elif item.column() == SIZE:
            try:
                segment.size = parseSize(item.text())
            except MeshingError as error:
                slicer.util.errorDisplay(str(error))
        self.logic.storeSegments(self.parameterNode, segments.values())
        self.updateGUIFromParameterNode()  # also where nothing was stored, to show what holds

    # --- Runs ---

    def onApply(self, *_):
        self.logText.clear()
        try:
            self.logic.apply(self.parameterNode)
        except MeshingError as error:
            slicer.util.errorDisplay(str(error))

    def onCancel(self, *_):
        self.logic.cancel()

    def appendToLog(self, line):
        self.logText.appendPlainText(line)

    def showState(self, state):
        self.progressBar.value = round(100 * state.progress)
        self.progressBar.format = {Phase.RUNNING: "%p %", Phase.CANCELLING: "cancelling"}.get(state.phase,
                                                                                             state.phase.value)
        self.updateButtons()

    def updateButtons(self):
        busy = self.logic.meshing.isBusy
        ready = self.parameterNode is not None and self.parameterNode.GetNodeReference("Segmentation") is not None
        self.applyButton.enabled = ready and not busy
        self.applyButton.toolTip = "Make the mesh" if ready else "Choose a segmentation first"
        self.cancelButton.enabled = self.logic.meshing.state.phase is Phase.RUNNING
