# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""The module's panel. All that it knows is in the parameter node, so that scenes keep it."""
import ctk
import qt
import slicer
import vtk
from slicer.ScriptedLoadableModule import ScriptedLoadableModuleWidget
from slicer.util import VTKObservationMixin

from VoxplexMesherLib.Logic import DEFAULTS, PARAMETERS, SIZES, MeshingError, Phase, setSize
from VoxplexMesherLib.ModuleLogic import VoxplexMesherLogic
from VoxplexMesherLib.Scene import isVolume

COLUMNS = ["Segment", "Mesh it", *(p["label"].replace(" of labels", "") + " (mm)" for p in SIZES.values())]
NAME, MESH, FIRST_SIZE = range(3)
SEGMENT_ID = qt.Qt.UserRole
LARGEST_WHOLE = 2147483647
LARGEST_REAL = 1e9
# Settings by the kind of widget that shows them, which is called after the setting.
SPIN_BOXES = [name for name, default in DEFAULTS.items() if type(default) in (int, float)]
COMBO_BOXES = [name for name, parameter in PARAMETERS.items() if parameter["kind"] == "word"]
CHECK_BOXES = [name for name, default in DEFAULTS.items() if type(default) is bool]
LINE_EDITS = [name for name, parameter in PARAMETERS.items() if parameter["kind"] == "interface-sizes"]
# The sections for groups of parameters; the others are advanced.
SECTIONS = {"Grey-value images": "Isosurface", **{title: title for title in (
    "Sampling distance and element sizes", "Shapes and small objects")}}
UNITS = {"LENGTH": " (mm)", "LABELS=LENGTH": " (mm)", "VOLUME": " (mm³)", "VOXELS": " (voxels)", "SECONDS": " (s)"}
CHOICES = {"above": "above the isovalue", "below": "below the isovalue", "uniform": "the same everywhere",
           "lfs": "coarser where shapes allow it"}


class VoxplexMesherWidget(ScriptedLoadableModuleWidget, VTKObservationMixin):
    def __init__(self, parent=None):
        ScriptedLoadableModuleWidget.__init__(self, parent)
        VTKObservationMixin.__init__(self)
        self.logic = None
        self.sections = {}  # by title
        self.parameterNode = None
        self.segmentationNode = None  # the one that is observed, if segments are meshed
        self.updating = False  # while the panel follows the parameter node

    # --- Building the panel ---

    def setup(self):
        ScriptedLoadableModuleWidget.setup(self)
        self.logic = VoxplexMesherLogic()
        self.logic.log = self.appendToLog
        self.logic.onChange = self.showState
        self.buildNodes()
        self.buildSegments()
        self.buildSettings()
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
        self.sections[title] = section
        return qt.QFormLayout(section)

    def buildNodes(self):
        form = self.addSection("Input and output")
        self.inputSelector = self.makeNodeSelector("vtkMRMLSegmentationNode", "The segmentation to mesh; or a volume, to mesh "
                                                   "what an isosurface of it bounds")
        self.inputSelector.nodeTypes = ["vtkMRMLSegmentationNode", "vtkMRMLScalarVolumeNode"]
        self.inputSelector.showChildNodeTypes = False  # no label maps
        self.meshSelector = self.makeNodeSelector("vtkMRMLModelNode", "The mesh; left empty, a new model is made",
                                                  output=True)
        self.surfacesSelector = self.makeNodeSelector(
            "vtkMRMLModelNode", "The triangles between segments, and between segments and background; left empty, "
            "they are not made", output=True)
        form.addRow("Segmentation or volume:", self.inputSelector)
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
        self.segmentTable.setToolTip("Segments that are not checked become background. Leave a length empty for none.")
        for column, parameter in enumerate(SIZES.values(), FIRST_SIZE):
            self.segmentTable.horizontalHeaderItem(column).setToolTip(parameter["slicer_help"].rpartition(" (")[0])
        self.segmentTable.connect("itemChanged(QTableWidgetItem*)", self.onSegmentItemChanged)
        form.addRow(self.segmentTable)

    def buildSettings(self):
        """A row for each parameter of the table, and what the module has beside."""
        forms = {title: self.addSection(title) for title in SECTIONS.values()}
        forms["Advanced"] = self.addSection("Advanced", collapsed=True)
        for name, parameter in PARAMETERS.items():
            self.addSetting(forms[SECTIONS.get(parameter["group"], "Advanced")], name, parameter)
        self.addBox(forms["Shapes and small objects"], "qualityCheckBox", "Compare with the segments:", qt.QCheckBox(),
                    "toggled(bool)", "Measure the finished mesh beside the label map: Hausdorff distance, errors of volumes, "
                    "non-manifold edges. The log has the figures")

    def addSetting(self, form, name, parameter):
        toolTip = parameter["slicer_help"]
        if name in SPIN_BOXES:
            kind, box = "SpinBox", self.makeSpinBox(parameter)
            signal = "valueChanged(int)" if parameter["kind"] == "whole" else "valueChanged(double)"
        elif name in COMBO_BOXES:
            kind, box, signal = "ComboBox", qt.QComboBox(), "currentIndexChanged(int)"
            for word in parameter["words"]:
                box.addItem(CHOICES.get(word, word), word)
        elif name in CHECK_BOXES:
            kind, box, signal = "CheckBox", qt.QCheckBox(), "toggled(bool)"
        else:
            kind, box, signal = "LineEdit", qt.QLineEdit(), "editingFinished()"
            box.placeholderText = "Bone = 0.5; Bone : Muscle = 0.4; Skin : background = 2"
            toolTip = ("In place of delta for all interfaces of a segment, or for the interface between two, in millimetres; "
                       "with the names of segments, and semicolons between")
        self.addBox(form, name + kind, parameter["label"] + UNITS.get(parameter["unit"], "") + ":", box, signal, toolTip)

    def makeSpinBox(self, parameter):
        """With the range that the program takes; 0 where no value need be given."""
        isWhole = parameter["kind"] == "whole"
        box, number, largest = (qt.QSpinBox(), int, LARGEST_WHOLE) if isWhole else (qt.QDoubleSpinBox(), float, LARGEST_REAL)
        if not isWhole:
            box.decimals = 3  # before the range, which is rounded to them
        low, high = parameter["usual" if parameter["step"] else "range"]
        low = 0 if parameter["default"] == "" and not parameter["step"] else low
        box.setRange(number(low), number(largest if high is None else high))
        box.singleStep = number(parameter["step"] or (1 if isWhole else 0.1))
        box.specialValueText = parameter["zero"] if low == 0 else ""
        return box

    def addBox(self, form, name, label, box, signal, toolTip):
        """A row of the form; the box becomes an attribute of the panel."""
        box.setToolTip(toolTip)
        box.connect(signal, self.updateParameterNodeFromGUI)
        setattr(self, name, box)
        form.addRow(label, box)

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
        if node.GetNodeReference("Segmentation") is None and node.GetNodeReference("Volume") is None:
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
        self.inputSelector.setCurrentNode(self.inputNode())
        self.meshSelector.setCurrentNode(node.GetNodeReference("OutputMesh"))
        self.surfacesSelector.setCurrentNode(node.GetNodeReference("OutputSurfaces"))
        settings = self.logic.settings(node)
        for name in SPIN_BOXES:
            getattr(self, name + "SpinBox").value = getattr(settings, name)
        for name in COMBO_BOXES:
            box = getattr(self, name + "ComboBox")
            box.currentIndex = max(0, box.findData(getattr(settings, name)))
        for name in CHECK_BOXES:
            getattr(self, name + "CheckBox").checked = getattr(settings, name)
        for name in LINE_EDITS:
            getattr(self, name + "LineEdit").text = getattr(settings, name)
        self.fillSegmentTable(self.logic.segments(node))
        self.enableWhatCounts(settings)
        self.updateButtons()
        self.updating = False

    def enableWhatCounts(self, settings):
        """Shows the section for the kind of input, and disables what has no effect with the other choices."""
        ofVolume = isVolume(self.inputNode())
        self.sections["Isosurface"].visible = ofVolume
        self.sections["Segments"].visible = not ofVolume
        self.smoothingSpinBox.enabled = self.qualityCheckBox.enabled = not ofVolume
        self.deltaSpinBox.enabled = settings.elements == 0
        self.featureRatioSpinBox.enabled = self.largestFeatureSpinBox.enabled = settings.grading == "lfs"
        self.optimiseSecondsSpinBox.enabled = settings.optimise

    def inputNode(self):
        """The node of the parameter node that is meshed, or None."""
        node = self.parameterNode
        return node and (node.GetNodeReference("Volume") or node.GetNodeReference("Segmentation"))

    def updateParameterNodeFromGUI(self, *_):
        if self.parameterNode is None or self.updating:
            return
        node = self.parameterNode
        wasModifying = node.StartModify()
        chosen = self.inputSelector.currentNodeID
        ofVolume = isVolume(self.inputSelector.currentNode())
        node.SetNodeReferenceID("Segmentation", "" if ofVolume else chosen)
        node.SetNodeReferenceID("Volume", chosen if ofVolume else "")
        node.SetNodeReferenceID("OutputMesh", self.meshSelector.currentNodeID)
        node.SetNodeReferenceID("OutputSurfaces", self.surfacesSelector.currentNodeID)
        for name in SPIN_BOXES:
            node.SetParameter(name, repr(getattr(self, name + "SpinBox").value))
        for name in COMBO_BOXES:
            box = getattr(self, name + "ComboBox")
            node.SetParameter(name, box.itemData(box.currentIndex))
        for name in CHECK_BOXES:
            node.SetParameter(name, "true" if getattr(self, name + "CheckBox").checked else "false")
        for name in LINE_EDITS:
            node.SetParameter(name, getattr(self, name + "LineEdit").text)
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
            sizes = [qt.QTableWidgetItem("%g" % segment.sizes[size] if size in segment.sizes else "") for size in SIZES]
            for column, item in enumerate([name, mesh, *sizes]):
                self.segmentTable.setItem(row, column, item)

    def onSegmentItemChanged(self, item):
        if self.parameterNode is None or self.updating:
            return
        segments = {segment.id: segment for segment in self.logic.segments(self.parameterNode)}
        segment = segments[self.segmentTable.item(item.row(), NAME).data(SEGMENT_ID)]
        if item.column() == MESH:
            segment.mesh = item.checkState() == qt.Qt.Checked
        elif item.column() >= FIRST_SIZE:
            try:
                setSize(segment, list(SIZES)[item.column() - FIRST_SIZE], item.text())
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
        ready = self.inputNode() is not None
        self.applyButton.enabled = ready and not busy
        self.applyButton.toolTip = "Make the mesh" if ready else "Choose a segmentation or a volume first"
        self.cancelButton.enabled = self.logic.meshing.state.phase is Phase.RUNNING
