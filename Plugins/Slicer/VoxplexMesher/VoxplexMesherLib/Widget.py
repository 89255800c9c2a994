# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""The module's panel. All that it knows is in the parameter node, so that scenes keep it."""
from dataclasses import fields

import ctk
import qt
import slicer
import vtk
from slicer.ScriptedLoadableModule import ScriptedLoadableModuleWidget
from slicer.util import VTKObservationMixin

from VoxplexMesherLib.Logic import MeshingError, Phase, Settings, parseSize
from VoxplexMesherLib.ModuleLogic import VoxplexMesherLogic
from VoxplexMesherLib.Scene import isVolume

COLUMNS = ("Segment", "Mesh it", "Size (mm)")
NAME, MESH, SIZE = range(3)
SEGMENT_ID = qt.Qt.UserRole
LARGEST_WHOLE = 2147483647
# Settings by the kind of widget that shows them, which is called after the setting.
DEFAULTS = {field.name: field.default for field in fields(Settings)}
SPIN_BOXES = [name for name, default in DEFAULTS.items() if type(default) in (int, float)]
COMBO_BOXES = ["grading", "inside"]
SWITCHES = [name for name, default in DEFAULTS.items() if default in ("on", "off")]  # check boxes
FLAGS = [name for name, default in DEFAULTS.items() if type(default) is bool]  # check boxes of true or false


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
        self.buildIsosurface()
        self.buildSampling()
        self.buildShapes()
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
        self.segmentTable.setToolTip("Segments that are not checked become background. Size is the upper bound of the "
                                     "circumradii of a segment's elements; leave it empty for none.")
        self.segmentTable.connect("itemChanged(QTableWidgetItem*)", self.onSegmentItemChanged)
        form.addRow(self.segmentTable)

    def buildIsosurface(self):
        form = self.addSection("Isosurface")
        self.addSpinBox(form, "isovalue", "Isovalue:", -1e9, 1e9, 1.0, 3, "",
                        "The value of the isosurface; it must lie within the range of the volume")
        self.addComboBox(form, "inside", "Inside:", {"above": "above the isovalue", "below": "below the isovalue"},
                         "On which side of the isosurface the object lies")
        self.addSpinBox(form, "greySmoothing", "Smoothing (voxels):", 0.0, 5.0, 0.1, 2, "off",
                        "How far grey values are smoothed against noise, in voxels")

    def buildSampling(self):
        form = self.addSection("Sampling distance and element sizes")
        self.addSpinBox(form, "delta", "Delta (mm):", 0.0, 1000.0, 0.1, 3, "from the spacing",
                        "Sampling distance of the interfaces: the edges of their triangles are about one to two times as long")
        self.addWholeSpinBox(form, "elements", "Number of elements:", LARGEST_WHOLE, 10000, "from delta",
                             "The number of tetrahedra, to within a tenth. Delta is then found by trying, which takes two or three "
                             "times as long")
        self.addComboBox(form, "grading", "Grading:", {"uniform": "the same everywhere", "lfs": "coarser where shapes allow it"},
                         "The second samples interfaces by their local feature size, the distance to the medial axis: about "
                         "half the thickness of a thin part. Delta is then the shortest sampling distance")
        self.addSpinBox(form, "size", "Largest element (mm):", 0.0, 1000.0, 0.5, 3, "no bound",
                        "Upper bound of the circumradii of all elements")

    def buildShapes(self):
        form = self.addSection("Shapes and small objects")
        self.addCheckBox(form, "optimise", "Optimise:",
                         "Improve shapes after refinement: dihedral angles of 18 to 150 degrees, with few exceptions, "
                         "radius-edge ratios up to 2.5")
        self.addWholeSpinBox(form, "smallestComponent", "Smallest component (voxels):", LARGEST_WHOLE, 1, "no guarantee",
                             "Connected components of a segment with at least this number of voxels, and its largest one, get "
                             "tetrahedra for every delta")
        self.addCheckBox(form, "exactComponents", "Exact for every delta:",
                         "Sample these components as finely as their thickness requires, for every delta, and as it takes to "
                         "connect their tetrahedra through faces. Otherwise those that are thin compared with delta have few "
                         "tetrahedra")
        self.addCheckBox(form, "quality", "Compare with the segments:",
                         "Measure the finished mesh beside the label map: Hausdorff distance, errors of volumes, non-manifold "
                         "edges. The log has the figures")

    def buildAdvanced(self):
        form = self.addSection("Advanced", collapsed=True)
        self.buildInterfaces(form)
        self.buildBounds(form)
        self.addWholeSpinBox(form, "threads", "Threads:", 4096, 1, "all cores",
                             "With 1, or with Reproducible, the mesh is the same in every run")
        self.addCheckBox(form, "reproducible", "Reproducible:", "Make the same mesh with any number of threads")
        self.addCheckBox(form, "force", "Force:",
                         "Go on although the mesh is estimated not to fit into memory, the labels look like grey values, the "
                         "radius-edge ratio is too low, or the sliver angle too large")

    def buildInterfaces(self, form):
        """How interfaces are sampled."""
        self.interfaceSizesLineEdit = qt.QLineEdit()
        self.interfaceSizesLineEdit.placeholderText = "Bone = 0.5; Bone : Muscle = 0.4; Skin : background = 2"
        self.interfaceSizesLineEdit.setToolTip("In place of delta for all interfaces of a segment, or for the interface between two, "
                                               "in millimetres")
        self.interfaceSizesLineEdit.connect("editingFinished()", self.updateParameterNodeFromGUI)
        form.addRow("Interface sizes (mm):", self.interfaceSizesLineEdit)
        self.addSpinBox(form, "gradation", "Gradation:", 0.0, 10.0, 0.1, 2, "no limit",
                        "How much sizes, and interface sizes, may change over a millimetre")
        self.addSpinBox(form, "featureRatio", "Feature ratio:", 0.1, 4.0, 0.1, 2, "",
                        "With grading: sampling distance over local feature size where that gives more than delta")
        self.addSpinBox(form, "largestFeature", "Largest feature (voxels):", 1.0, 100.0, 1.0, 1, "",
                        "With grading: upper bound of the local feature size, in voxels")
        self.addSpinBox(form, "smoothing", "Smoothing (voxels):", 0.0, 5.0, 0.1, 2, "off",
                        "How far voxel stairs are smoothed, in voxels")
        self.addCheckBox(form, "junctions", "Sample junctions:",
                         "Sample the curves where three segments meet before all else, so that edges follow them")
        self.addWholeSpinBox(form, "interfaceRounds", "Interface rounds:", 100, 1, "never",
                             "How often, at most, to refine again where interfaces are farther than 1.5 delta from the mesh, or "
                             "are not manifold")

    def buildBounds(self, form):
        """What is asked of elements, and what is left out."""
        self.addSpinBox(form, "radiusEdge", "Radius-edge ratio:", 1.0, 10.0, 0.1, 3, "",
                        "Upper bound of circumradius over shortest edge; below 1.93 only with Force")
        self.addSpinBox(form, "facetAngle", "Facet angle:", 0.0, 30.0, 1.0, 1, "",
                        "Lower bound of the angles of triangles on the interfaces, in degrees")
        self.addSpinBox(form, "sliverAngle", "Sliver angle:", 0.0, 59.0, 1.0, 1, "slivers stay",
                        "Tetrahedra with a dihedral angle below this, or above 180 minus this, are split, in degrees; above "
                        "15 only with Force")
        self.addSpinBox(form, "optimiseSeconds", "Time for optimising (s):", 0.0, 1e6, 10.0, 1, "no limit",
                        "Stop optimising after this time")
        self.addSpinBox(form, "minimumVolume", "Smallest volume (mm³):", 0.0, 1e9, 1.0, 3, "none is left out",
                        "Connected components with less volume, such as specks, get the label around them")

    def addSpinBox(self, form, name, label, low, high, step, decimals, textOfLow, toolTip):
        box = qt.QDoubleSpinBox()
        box.decimals = decimals
        box.setRange(low, high)
        box.singleStep = step
        box.specialValueText = textOfLow
        self.addBox(form, name + "SpinBox", label, box, "valueChanged(double)", toolTip)

    def addWholeSpinBox(self, form, name, label, high, step, textOfZero, toolTip):
        box = qt.QSpinBox()
        box.setRange(0, high)
        box.singleStep = step
        box.specialValueText = textOfZero
        self.addBox(form, name + "SpinBox", label, box, "valueChanged(int)", toolTip)

    def addComboBox(self, form, name, label, textsOfValues, toolTip):
        box = qt.QComboBox()
        for value, text in textsOfValues.items():
            box.addItem(text, value)
        self.addBox(form, name + "ComboBox", label, box, "currentIndexChanged(int)", toolTip)

    def addCheckBox(self, form, name, label, toolTip):
        box = qt.QCheckBox()
        self.addBox(form, name + "CheckBox", label, box, "toggled(bool)", toolTip)

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
        for name in SWITCHES:
            getattr(self, name + "CheckBox").checked = getattr(settings, name) == "on"
        for name in FLAGS:
            getattr(self, name + "CheckBox").checked = getattr(settings, name)
        self.interfaceSizesLineEdit.text = settings.interfaceSizes
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
        self.optimiseSecondsSpinBox.enabled = settings.optimise == "on"

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
        for name in SWITCHES:
            node.SetParameter(name, "on" if getattr(self, name + "CheckBox").checked else "off")
        for name in FLAGS:
            node.SetParameter(name, "true" if getattr(self, name + "CheckBox").checked else "false")
        node.SetParameter("interfaceSizes", self.interfaceSizesLineEdit.text)
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
        ready = self.inputNode() is not None
        self.applyButton.enabled = ready and not busy
        self.applyButton.toolTip = "Make the mesh" if ready else "Choose a segmentation or a volume first"
        self.cancelButton.enabled = self.logic.meshing.state.phase is Phase.RUNNING
