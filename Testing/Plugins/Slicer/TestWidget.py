#!/usr/bin/python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""The scripted module from its panel to the coloured mesh, with stand-ins for Slicer and Qt, and the real program.

It finds misspelt names and wrong arguments, and what the panel does when. How the panel looks it cannot tell.
"""
import os
import re
import subprocess
import sys
import tempfile
import types
import unittest
from dataclasses import fields
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE / "standins"))

import images  # noqa: E402
import qt  # noqa: E402
import slicer  # noqa: E402
import vtk  # noqa: E402
from module import MODULE, descriptions  # noqa: E402
import VoxplexMesher  # noqa: E402
from VoxplexMesherLib.Logic import Phase, Settings, measureLabels  # noqa: E402
from VoxplexMesherLib.Scene import isVolume  # noqa: E402
from VoxplexMesherLib.Widget import COMBO_BOXES, FLAGS, MESH, NAME, SIZE, SPIN_BOXES, SWITCHES  # noqa: E402


class PanelTestCase(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="voxplex-slicer-")
        self.addCleanup(folder.cleanup)
        slicer.app.temporaryPath = folder.name
        slicer.mrmlScene.nodes.clear()
        slicer.mrmlScene.observers.clear()
        for texts in (qt.QProcess.commands, slicer.util.shownErrors, slicer.util.questions, slicer.util.installations):
            texts.clear()
        slicer.util.uninstall()
        slicer.util.install()
        slicer.labelmapGeometry = images.Geometry()
        self.array = images.two_labels()
        self.widget = VoxplexMesher.VoxplexMesherWidget()
        self.widget.setup()
        self.addCleanup(self.widget.cleanup)
        self.addCleanup(self.check_nothing_is_left)

    def check_nothing_is_left(self):
        self.assertEqual(qt.QProcess.running, [])
        self.assertNotIn("Voxplex label map", slicer.mrmlScene.names("vtkMRMLLabelMapVolumeNode"))
        self.assertEqual(os.listdir(slicer.app.temporaryPath), [])

    def add_segmentation(self, name="Knee", size=None):
        node = slicer.mrmlScene.AddNewNodeByClass("vtkMRMLSegmentationNode", name)
        array = self.array if size is None else images.two_labels(size, 0.44 * size)
        node.GetSegmentation().add("a", "Bone", (1.0, 0.9, 0.7), array == 3)
        node.GetSegmentation().add("b", "Muscle", (0.6, 0.2, 0.2), array == 7)
        return node

    def choose_segmentation(self, **options):
        node = self.add_segmentation(**options)
        self.widget.inputSelector.setCurrentNode(node)
        return node

    def item(self, row, column):
        return self.widget.segmentTable.item(row, column)

    def log(self):
        return self.widget.logText.plainText.split("\n")

    def finish(self):
        self.widget.logic.wait()
        return self.widget.logic.meshing.state

    def apply(self):
        self.widget.applyButton.click()
        return self.finish()

    def mesh_node(self):
        return self.widget.parameterNode.GetNodeReference("OutputMesh")


class Panel(PanelTestCase):
    def test_module(self):
        parent = types.SimpleNamespace()
        VoxplexMesher.VoxplexMesher(parent)
        self.assertEqual((parent.title, parent.categories), ("Voxplex Mesher", ["Segmentation"]))
        self.assertEqual(parent.dependencies, ["Segmentations"])
        self.assertTrue((MODULE / "Resources" / "Icons" / "VoxplexMesher.png").is_file())

    def test_apply_needs_a_segmentation(self):
        self.assertFalse(self.widget.applyButton.enabled)
        self.assertEqual(self.widget.applyButton.toolTip, "Choose a segmentation or a volume first")
        self.assertFalse(self.widget.cancelButton.enabled)
        self.choose_segmentation()
        self.assertTrue(self.widget.applyButton.enabled)

    def test_first_segmentation_is_taken(self):
        node = self.add_segmentation()
        self.widget.enter()
        self.assertIs(self.widget.inputSelector.currentNode(), node)

    def test_table(self):
        self.choose_segmentation()
        table = self.widget.segmentTable
        self.assertEqual((table.rows, table.headers), (2, ["Segment", "Mesh it", "Size (mm)"]))
        self.assertEqual([self.item(row, NAME).text() for row in range(2)], ["Bone", "Muscle"])
        self.assertEqual(self.item(1, NAME).data(qt.Qt.DecorationRole).rgb, (0.6, 0.2, 0.2))
        self.assertEqual([self.item(row, MESH).checkState() for row in range(2)], [qt.Qt.Checked] * 2)
        self.assertEqual([self.item(row, SIZE).text() for row in range(2)], ["", ""])

    def test_table_follows_the_segmentation(self):
        segmentation = self.choose_segmentation().GetSegmentation()
        self.item(1, MESH).setCheckState(qt.Qt.Unchecked)
        segmentation.add("c", "Skin", (1.0, 0.8, 0.7), self.array == 0)
        self.assertEqual(self.widget.segmentTable.rows, 3)
        segmentation.remove("a")
        self.assertEqual([self.item(row, NAME).text() for row in range(2)], ["Muscle", "Skin"])
        self.assertEqual([self.item(row, MESH).checkState() for row in range(2)], [qt.Qt.Unchecked, qt.Qt.Checked])
        segmentation.segments["b"].name = "Fat"
        segmentation.InvokeEvent(segmentation.SegmentModified)
        self.assertEqual(self.item(0, NAME).text(), "Fat")
        other = self.add_segmentation("Other")
        self.widget.inputSelector.setCurrentNode(other)
        self.assertEqual(segmentation.observers, {})  # the first is no longer observed
        self.assertEqual(len(other.GetSegmentation().observers), 3)

    def test_panel_and_parameter_node(self):
        node = self.widget.parameterNode
        self.assertEqual(node.GetParameter("delta"), "0.0")
        self.widget.deltaSpinBox.value = 1.5
        self.widget.threadsSpinBox.value = 3
        self.widget.forceCheckBox.checked = True
        self.assertEqual([node.GetParameter(name) for name in ("delta", "threads", "force")], ["1.5", "3", "true"])
        node.SetParameter("force", "false")
        self.assertFalse(self.widget.forceCheckBox.checked)

    def test_every_setting_has_a_widget(self):
        """Which shows what the parameter node has, and stores what is chosen."""
        node = self.widget.parameterNode
        known = {*SPIN_BOXES, *COMBO_BOXES, *SWITCHES, *FLAGS, "interfaceSizes"}
        self.assertEqual(known, {field.name for field in fields(Settings)})
        kinds = {**dict.fromkeys(SPIN_BOXES, "SpinBox"), **dict.fromkeys(SWITCHES + FLAGS, "CheckBox")}
        for name, kind in kinds.items():
            box, attribute = getattr(self.widget, name + kind), "value" if kind == "SpinBox" else "checked"
            before = node.GetParameter(name)
            shown = getattr(box, attribute)
            setattr(box, attribute, shown + 1 if kind == "SpinBox" and shown + 1 <= box.maximum else
                    shown - 1 if kind == "SpinBox" else not shown)
            stored = node.GetParameter(name)
            self.assertNotEqual(stored, before, name)
            node.SetParameter(name, before)
            self.assertEqual(getattr(box, attribute), shown, name)
            self.assertNotEqual(box.toolTip, None, name)
        for name in COMBO_BOXES:
            box = getattr(self.widget, name + "ComboBox")
            box.currentIndex = 1
            self.assertEqual(node.GetParameter(name), box.items[1][1])
            node.SetParameter(name, box.items[0][1])
            self.assertEqual(box.currentIndex, 0)
        self.widget.interfaceSizesLineEdit.type("Bone = 1")
        self.assertEqual(node.GetParameter("interfaceSizes"), "Bone = 1")
        node.SetParameter("interfaceSizes", "Bone = 2")
        self.assertEqual(self.widget.interfaceSizesLineEdit.text, "Bone = 2")

    def test_choices_of_the_cli_module(self):
        parameters = descriptions()
        for name in COMBO_BOXES:
            offered = [data for _, data in getattr(self.widget, name + "ComboBox").items]
            self.assertEqual(offered, [e.text for e in parameters[name].findall("element")])
        for name in SWITCHES:
            self.assertEqual([e.text for e in parameters[name].findall("element")], ["on", "off"])

    def test_what_does_not_count_is_disabled(self):
        w = self.widget
        self.assertTrue(w.deltaSpinBox.enabled)
        w.elementsSpinBox.value = 5000
        self.assertFalse(w.deltaSpinBox.enabled)
        w.elementsSpinBox.value = 0
        self.assertTrue(w.deltaSpinBox.enabled)
        self.assertFalse(w.featureRatioSpinBox.enabled or w.largestFeatureSpinBox.enabled)
        w.gradingComboBox.currentIndex = 1
        self.assertTrue(w.featureRatioSpinBox.enabled and w.largestFeatureSpinBox.enabled)
        self.assertTrue(w.optimiseSecondsSpinBox.enabled)
        w.optimiseCheckBox.checked = False
        self.assertFalse(w.optimiseSecondsSpinBox.enabled)

    def test_sections_for_the_input(self):
        def shown():
            return [self.widget.sections[title].visible for title in ("Segments", "Isosurface")]
        self.assertEqual(shown(), [True, False])
        volume = slicer.mrmlScene.AddNewNodeByClass("vtkMRMLScalarVolumeNode", "CT")
        node = self.widget.parameterNode
        self.widget.inputSelector.setCurrentNode(volume)
        self.assertEqual((node.GetNodeReference("Volume"), node.GetNodeReference("Segmentation")), (volume, None))
        self.assertEqual(shown(), [False, True])
        self.assertFalse(self.widget.qualityCheckBox.enabled or self.widget.smoothingSpinBox.enabled)
        self.assertTrue(self.widget.applyButton.enabled)
        segmentation = self.choose_segmentation()
        self.assertEqual((node.GetNodeReference("Volume"), node.GetNodeReference("Segmentation")), (None, segmentation))
        self.assertEqual(shown(), [True, False])
        labels = slicer.mrmlScene.AddNewNodeByClass("vtkMRMLLabelMapVolumeNode")
        with self.assertRaisesRegex(AssertionError, "not offered"):
            self.widget.inputSelector.setCurrentNode(labels)
        self.assertEqual([isVolume(n) for n in (volume, labels, segmentation, None)], [True, False, False, False])

    def test_defaults_are_those_of_the_cli_module(self):
        for name, p in descriptions().items():
            box = getattr(self.widget, name + "SpinBox", None)
            if box and p.find("default") is not None:
                self.assertEqual(box.value, float(p.findtext("default")), name)
                if p.find("constraints") is not None:
                    limits = tuple(float(p.findtext("constraints/" + tag)) for tag in ("minimum", "maximum"))
                    self.assertEqual((box.minimum, box.maximum), limits, name)

    def test_choices_of_segments(self):
        self.choose_segmentation()
        self.item(0, MESH).setCheckState(qt.Qt.Unchecked)
        self.item(1, SIZE).setText("2,5")
        segments = self.widget.logic.segments(self.widget.parameterNode)
        self.assertEqual([(s.mesh, s.size) for s in segments], [(False, 0.0), (True, 2.5)])
        self.assertEqual(self.item(1, SIZE).text(), "2.5")
        self.item(1, SIZE).setText("big")
        self.assertRegex(slicer.util.shownErrors[-1], "'big' is not a size")
        self.assertEqual(self.item(1, SIZE).text(), "2.5")  # what holds
        self.item(1, SIZE).setText("")
        self.assertEqual(self.widget.logic.segments(self.widget.parameterNode)[1].size, 0.0)

    def test_nothing_is_observed_any_more(self):
        segmentation = self.choose_segmentation().GetSegmentation()
        node = self.widget.parameterNode
        self.widget.exit()
        self.assertEqual((segmentation.observers, node.observers), ({}, {}))
        self.widget.enter()
        self.assertEqual((len(segmentation.observers), len(node.observers)), (3, 1))
        self.widget.cleanup()
        self.assertEqual((segmentation.observers, node.observers, slicer.mrmlScene.observers), ({}, {}, {}))

    def test_closing_the_scene(self):
        self.choose_segmentation()
        node = self.widget.parameterNode
        slicer.mrmlScene.Clear()
        self.assertIsNot(self.widget.parameterNode, node)
        self.assertFalse(self.widget.applyButton.enabled)
        self.assertEqual(self.widget.segmentTable.rows, 0)


class Runs(PanelTestCase):
    def test_mesh(self):
        self.choose_segmentation()
        self.widget.deltaSpinBox.value = 2.0
        self.widget.applyButton.click()
        self.assertFalse(self.widget.applyButton.enabled)
        self.assertTrue(self.widget.cancelButton.enabled)
        state = self.finish()
        self.assertEqual(state.phase, Phase.COMPLETED, self.log())
        self.assertTrue(self.widget.applyButton.enabled)
        self.assertFalse(self.widget.cancelButton.enabled)
        self.assertEqual((self.widget.progressBar.value, self.widget.progressBar.format), (100, "completed"))
        command = qt.QProcess.commands[-1]
        self.assertIn("--delta=2.0", command)
        self.assertNotIn("--force", command)
        self.assertEqual((slicer.util.questions, slicer.util.installations), ([], []))

        mesh = self.mesh_node().GetMesh()
        self.assertEqual(self.mesh_node().GetName(), "Knee mesh")
        for f, label in zip(measureLabels(mesh), (3, 7)):
            self.assertAlmostEqual(f.volume / (self.array == label).sum(), 1.0, delta=0.08)
        names = mesh.GetFieldData().GetAbstractArray("LabelNames")
        self.assertEqual([names.GetValue(i) for i in range(names.GetNumberOfValues())], ["Bone", "Muscle"])
        self.assertRegex("\n".join(self.log()), r"(?s)^Meshing Bone, Muscle\n\d+ tetrahedra with \d+ nodes\n  Bone: \d+ "
                         r"tetrahedra, .* mm³\n  Muscle: \d+ ")
        self.check_display(self.mesh_node().GetDisplayNode())
        # The temporary label map, its display and its colours are gone.
        self.assertEqual(slicer.mrmlScene.names("vtkMRMLDisplayNode"), ["vtkMRMLDisplayNode"])
        self.assertEqual(slicer.mrmlScene.names("vtkMRMLColorTableNode"), ["Knee mesh labels"])

    def check_display(self, display):
        self.assertEqual(display.activeScalar, ("Label", vtk.vtkAssignAttribute.CELL_DATA))
        self.assertEqual(display.rangeFlag, display.UseColorNodeScalarRange)
        self.assertEqual(display.shown, {"scalars": True, "edges": True, "node": True})
        colors = display.GetColorNode()
        self.assertEqual(colors.colors, [("background", (0.0, 0.0, 0.0, 0.0)), ("Bone", (1.0, 0.9, 0.7, 1.0)),
                                         ("Muscle", (0.6, 0.2, 0.2, 1.0))])
        self.assertTrue(colors.isUser)
        self.assertEqual(colors.references, 1)

    def test_choices_and_settings_arrive(self):
        self.choose_segmentation()
        self.item(0, MESH).setCheckState(qt.Qt.Unchecked)
        self.item(1, SIZE).setText("1.5")
        self.widget.radiusEdgeSpinBox.value = 1.9
        self.widget.forceCheckBox.checked = True
        self.widget.gradingComboBox.currentIndex = 1
        self.widget.optimiseCheckBox.checked = False
        self.widget.interfaceSizesLineEdit.type("Muscle : background = 1.5")
        self.assertEqual(self.apply().phase, Phase.COMPLETED, self.log())
        self.assertLess({"--label-size=1=1.5", "--radius-edge=1.9", "--grading=lfs", "--no-optimise",
                         "--interface-size=1,0=1.5", "--force"}, set(qt.QProcess.commands[-1]))
        figures, = measureLabels(self.mesh_node().GetMesh())
        self.assertEqual(figures.label, 1)
        self.assertAlmostEqual(figures.volume / (self.array == 7).sum(), 1.0, delta=0.08)
        self.assertRegex(self.log()[2], "^  Muscle: ")

    def dihedral_angles(self):
        """As the log has them."""
        line, = [line for line in self.log() if line.startswith("Dihedral angles")]
        return [float(text) for text in re.findall(r"from ([\d.]+) to ([\d.]+) degrees", line)[0]]

    def test_figures_of_quality(self):
        self.choose_segmentation()
        self.assertEqual(self.apply().phase, Phase.COMPLETED, self.log())
        low, high = self.dihedral_angles()
        self.assertTrue(12 < low < 60 < high < 160, (low, high))
        self.assertNotIn("Hausdorff", "\n".join(self.log()))
        self.widget.qualityCheckBox.checked = True
        self.assertEqual(self.apply().phase, Phase.COMPLETED, self.log())
        distance, edges = re.match(r"Hausdorff distance ([\d.]+) mm, (\d+) non-manifold edges, volumes of segments off by up to "
                                   r"[\d.]+ %$", self.log()[-1]).groups()
        self.assertTrue(0.2 < float(distance) < 3.0, distance)
        self.assertEqual(edges, "0")

    def test_isosurface(self):
        """A ball of radius 8 in a volume; its mesh has the volume's name."""
        z, y, x = np.mgrid[:24, :24, :24] - 11.5
        volume = slicer.mrmlScene.AddNewNodeByClass("vtkMRMLScalarVolumeNode", "Distances")
        volume.array, volume.geometry = (100 * np.sqrt(x**2 + y**2 + z**2)).astype(np.float32), images.Geometry()
        w = self.widget
        w.inputSelector.setCurrentNode(volume)
        w.isovalueSpinBox.value = 1e6
        self.assertEqual(self.apply().phase, Phase.FAILED)
        self.assertRegex(self.log()[-1], "^Failed: .*outside of the image's range, which is from 86.6")
        w.isovalueSpinBox.value = 800.0
        w.insideComboBox.currentIndex = 1
        self.assertEqual(self.apply().phase, Phase.COMPLETED, self.log())
        figures, = measureLabels(self.mesh_node().GetMesh())
        self.assertAlmostEqual(figures.volume / (4.0 / 3.0 * np.pi * 8**3), 1.0, delta=0.08)
        self.assertRegex("\n".join(self.log()), r"^Meshing Distances\n(.*\n)*  Distances: \d+ tetrahedra")
        self.assertEqual(self.mesh_node().GetName(), "Distances mesh")
        self.assertIn(volume, slicer.mrmlScene.nodes.values())  # the input is no temporary label map
        self.assertEqual(self.mesh_node().GetDisplayNode().GetColorNode().colors[1][0], "Distances")

    def test_segmentation_or_volume(self):
        self.choose_segmentation()
        volume = slicer.mrmlScene.AddNewNodeByClass("vtkMRMLScalarVolumeNode", "CT")
        self.widget.parameterNode.references["Volume"] = volume.GetID()  # as a script can
        self.widget.applyButton.click()
        self.assertRegex(slicer.util.shownErrors[-1], "not both")
        self.assertEqual(qt.QProcess.commands, [])

    def test_wrong_interface_sizes(self):
        self.choose_segmentation()
        self.widget.interfaceSizesLineEdit.type("Bone : Skin = 1")
        self.widget.applyButton.click()
        self.assertRegex(slicer.util.shownErrors[-1], "'Bone : Skin = 1' is not the size of an interface")
        self.assertEqual(qt.QProcess.commands, [])
        self.assertTrue(self.widget.applyButton.enabled)

    def test_interfaces(self):
        self.choose_segmentation()
        surfaces = slicer.mrmlScene.AddNewNodeByClass("vtkMRMLModelNode", "Surfaces")
        self.widget.surfacesSelector.setCurrentNode(surfaces)
        self.assertEqual(self.apply().phase, Phase.COMPLETED, self.log())
        labels = surfaces.GetMesh().GetCellData().GetArray("Labels")
        pairs = {tuple(map(int, labels.GetTuple2(i))) for i in range(labels.GetNumberOfTuples())}
        self.assertEqual(pairs, {(1, 0), (2, 0), (2, 1)})
        self.assertEqual(surfaces.GetDisplayNode().shown, {"node": False})

    def test_mesh_node_is_used_again(self):
        self.choose_segmentation()
        self.apply()
        first = self.mesh_node()
        self.widget.deltaSpinBox.value = 4.0
        cells = first.GetMesh().GetNumberOfCells()
        self.apply()
        self.assertIs(self.mesh_node(), first)
        self.assertLess(first.GetMesh().GetNumberOfCells(), cells)
        self.assertEqual(slicer.mrmlScene.names("vtkMRMLModelNode"), ["Knee mesh"])

    def test_nothing_chosen(self):
        self.choose_segmentation()
        for row in range(2):
            self.item(row, MESH).setCheckState(qt.Qt.Unchecked)
        self.widget.applyButton.click()
        self.assertRegex(slicer.util.shownErrors[-1], "No segment is chosen")
        self.assertEqual(qt.QProcess.commands, [])
        self.assertTrue(self.widget.applyButton.enabled)

    def test_failure(self):
        self.choose_segmentation()
        self.widget.radiusEdgeSpinBox.value = 1.2
        self.assertEqual(self.apply().phase, Phase.FAILED)
        self.assertRegex(self.log()[-1], "^Failed: voxplex: --radius-edge: .*--force to try all the same$")
        self.assertEqual(self.widget.progressBar.format, "failed")
        self.assertIsNone(self.mesh_node().GetMesh())
        self.assertEqual(slicer.mrmlScene.names("vtkMRMLLabelMapVolumeNode"), [])
        self.assertTrue(self.widget.applyButton.enabled)

    def test_failure_in_the_middle(self):
        """The image is named as in the scene, and not as the file that it was in."""
        self.choose_segmentation()
        self.widget.deltaSpinBox.value = 0.001
        self.assertEqual(self.apply().phase, Phase.FAILED)
        self.assertRegex(self.log()[-1], "^Failed: voxplex: cannot mesh 'Knee': ")

    def test_warning(self):
        node = self.choose_segmentation()
        speck = np.zeros_like(self.array, dtype=bool)
        speck[12, 12, 12] = True
        node.GetSegmentation().add("c", "Speck", (1, 1, 1), speck)
        self.widget.deltaSpinBox.value = 3.0
        self.widget.smallestComponentSpinBox.value = 0
        self.assertEqual(self.apply().phase, Phase.COMPLETED, self.log())
        self.assertRegex("\n".join(self.log()), "voxplex: warning: The mesh lacks these labels .*: 3")
        self.assertIn("  Speck: none; it is too small for this delta", self.log())

    def test_overlapping_segments(self):
        """The smallest gets a voxel, though a later one has it, too."""
        node = self.choose_segmentation()
        node.GetSegmentation().add("c", "Knee: all/of it", (1, 1, 1), np.pad(np.ones((22, 22, 22), bool), 1))
        self.widget.deltaSpinBox.value = 2.0
        self.assertEqual(self.apply().phase, Phase.COMPLETED, self.log())
        counts = [(self.array == 3).sum(), (self.array == 7).sum()]
        self.assertIn("voxplex: warning: masks overlap in %d voxels, which the smallest of them gets: "
                      "Bone and Knee_ all_of it (%d), Muscle and Knee_ all_of it (%d)" % (sum(counts), *counts), "\n".join(self.log()))
        volumes = [f.volume for f in measureLabels(self.mesh_node().GetMesh())]
        np.testing.assert_allclose(volumes, [*counts, 22**3 - sum(counts)], rtol=0.08)

    def test_place_of_the_mesh(self):
        """In an oblique image the mesh lies where the voxels lie in the scene, and does not say what coordinates it has:
        Slicer adds that to files where it is not yet there."""
        angle = 0.4
        turned = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
        slicer.labelmapGeometry = images.Geometry((10.0, -20.0, 30.0), (0.5, 1.0, 2.0), turned[:, [1, 0, 2]])
        self.choose_segmentation()
        self.assertEqual(self.apply().phase, Phase.COMPLETED, self.log())
        mesh = self.mesh_node().GetMesh()
        center = slicer.labelmapGeometry.physical((11.5, 11.5, 11.5)) * (-1, -1, 1)
        bounds = np.array(mesh.GetBounds()).reshape(3, 2)
        np.testing.assert_allclose(bounds.mean(axis=1), center, atol=0.5)
        self.assertIsNone(mesh.GetFieldData().GetAbstractArray("SPACE"))
        for f, label in zip(measureLabels(mesh), (3, 7)):
            self.assertAlmostEqual(f.volume / (self.array == label).sum(), 1.0, delta=0.08)

    def test_image_that_cannot_be_written(self):
        slicer.app.temporaryPath, folder = "/nonexistent", slicer.app.temporaryPath
        self.choose_segmentation()
        try:
            self.widget.applyButton.click()
        finally:
            slicer.app.temporaryPath = folder
        self.assertRegex(slicer.util.shownErrors[-1], "nonexistent")
        self.assertEqual(self.widget.progressBar.format, "failed")

    def test_cancel(self):
        self.choose_segmentation(size=64)
        self.widget.deltaSpinBox.value = 0.05
        self.widget.forceCheckBox.checked = True
        self.widget.applyButton.click()
        for _ in range(20):
            slicer.app.processEvents()
        process = qt.QProcess.running[0].process
        self.assertIsNone(process.poll())
        self.widget.cancelButton.click()
        self.assertEqual(self.widget.progressBar.format, "cancelling")
        self.assertFalse(self.widget.cancelButton.enabled)
        self.assertEqual(self.finish().phase, Phase.CANCELLED)
        self.assertIsNotNone(process.poll())
        self.assertEqual(self.log()[-1], "Cancelled")
        self.assertIsNone(self.mesh_node().GetMesh())
        self.assertTrue(self.widget.applyButton.enabled)
        self.widget.deltaSpinBox.value = 8.0  # and again
        self.assertEqual(self.apply().phase, Phase.COMPLETED, self.log())

    def test_closing_the_scene_cancels(self):
        self.choose_segmentation()
        self.widget.applyButton.click()
        slicer.mrmlScene.Clear()
        self.assertEqual(self.finish().phase, Phase.CANCELLED)

    def test_self_test_of_the_module(self):
        """What Slicer's developer mode runs. It installs nothing."""
        slicer.labelmapGeometry = images.Geometry(origin=(15.0, 15.0, -15.0), direction=np.diag((-1.0, -1.0, 1.0)))
        test = VoxplexMesher.VoxplexMesherTest()
        test.runTest()
        slicer.util.uninstall()
        with self.assertRaisesRegex(unittest.SkipTest, "voxplex-mesh is not installed"):
            test.runTest()
        self.assertEqual(slicer.util.questions, [])


class Installations(PanelTestCase):
    """Of the program, which a Slicer that was downloaded does not have."""

    def setUp(self):
        super().setUp()
        slicer.util.uninstall()
        self.choose_segmentation()
        self.addCleanup(setattr, slicer.util, "answer", True)
        self.addCleanup(setattr, slicer.util, "installation", None)

    def test_with_consent(self):
        self.assertEqual(self.apply().phase, Phase.COMPLETED, self.log())
        self.assertRegex(slicer.util.questions[0], "voxplex-mesh.*PyPI")
        self.assertEqual(slicer.util.installations, ["--only-binary=:all: voxplex-mesh"])
        self.apply()  # it asks once
        self.assertEqual((len(slicer.util.questions), len(slicer.util.installations)), (1, 1))

    def test_refused(self):
        slicer.util.answer = False
        self.assertEqual(self.apply().phase, Phase.CANCELLED)
        self.assertEqual((slicer.util.installations, slicer.util.shownErrors, qt.QProcess.commands), ([], [], []))
        self.assertTrue(self.widget.applyButton.enabled)
        slicer.util.answer = True
        self.assertEqual(self.apply().phase, Phase.COMPLETED, self.log())

    def test_nothing_is_asked_for_nothing(self):
        self.item(0, MESH).setCheckState(qt.Qt.Unchecked)
        self.item(1, MESH).setCheckState(qt.Qt.Unchecked)
        self.widget.applyButton.click()
        self.assertEqual(slicer.util.questions, [])

    def check_failure(self, pattern):
        self.widget.applyButton.click()
        self.assertRegex(slicer.util.shownErrors[-1], pattern)
        self.assertEqual((self.widget.progressBar.format, qt.QProcess.commands), ("failed", []))
        self.assertTrue(self.widget.applyButton.enabled)

    def test_no_network(self):
        def fail():
            raise subprocess.CalledProcessError(1, ["pip"])
        slicer.util.installation = fail
        self.check_failure("voxplex-mesh could not be installed.*PyPI cannot be reached")
        slicer.util.installation = None  # there is one again
        self.assertEqual(self.apply().phase, Phase.COMPLETED, self.log())

    def test_cancelled_meanwhile(self):
        """Slicer processes events while it installs."""
        def install():
            self.widget.cancelButton.click()
            slicer.util.install()
        slicer.util.installation = install
        self.assertEqual(self.apply().phase, Phase.CANCELLED)
        self.assertEqual(qt.QProcess.commands, [])

    def test_what_was_installed_does_not_work(self):
        slicer.util.installation = lambda: None
        self.check_failure("voxplex-mesh is installed, but cannot be used: No module named 'voxplex'")

    def test_other_package_of_this_name(self):
        """`voxplex` on PyPI is no part of this."""
        sys.modules["voxplex"] = types.ModuleType("voxplex")
        slicer.util.installation = lambda: None
        self.check_failure("cannot be used: .*voxplex")
        self.assertEqual(len(slicer.util.questions), 1)

    def test_package_without_its_program(self):
        slicer.util.install()
        from voxplex import installation
        self.addCleanup(slicer.util.uninstall)
        installation.PROGRAM = Path("/nonexistent/voxplex")
        self.check_failure("cannot be used: the program /nonexistent/voxplex cannot be started: it is not there; ")
        self.assertEqual(slicer.util.questions, [])

    def test_program_that_cannot_be_started(self):
        self.check_program("#!/nonexistent/interpreter", "^Failed: the program voxplex cannot be started$")

    def test_program_that_crashes(self):
        self.check_program("#!/bin/sh\nprintf 'voxplex: bad news' >&2\nkill -SEGV $$\n",
                           "^Failed: the program voxplex crashed, or was ended\nvoxplex: bad news$")

    def check_program(self, text, pattern):
        slicer.util.install()
        from voxplex import installation
        with tempfile.TemporaryDirectory() as folder:
            installation.PROGRAM = Path(folder) / "voxplex"
            installation.PROGRAM.write_text(text)
            installation.PROGRAM.chmod(0o755)
            self.assertEqual(self.apply().phase, Phase.FAILED)
        self.assertRegex("\n".join(self.log()[1:]), pattern)
        self.assertTrue(self.widget.applyButton.enabled)


if __name__ == "__main__":
    unittest.main(verbosity=2)
