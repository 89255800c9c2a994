#!/usr/bin/python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""The scripted module from its panel to the coloured mesh, with stand-ins for Slicer and Qt, and the real CLI module.

It finds misspelt names and wrong arguments, and what the panel does when. How the panel looks it cannot tell.
"""
import sys
import types
import unittest
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
MODULE = HERE.parents[2] / "Plugins" / "Slicer" / "VoxplexMesher"
sys.path[:0] = [str(HERE / "standins"), str(MODULE)]

import images  # noqa: E402
import qt  # noqa: E402
import slicer  # noqa: E402
import vtk  # noqa: E402
import VoxplexMesher  # noqa: E402
from VoxplexMesherLib.Logic import Phase, measureLabels  # noqa: E402
from VoxplexMesherLib.Widget import MESH, NAME, SIZE  # noqa: E402


class PanelTestCase(unittest.TestCase):
    def setUp(self):
        slicer.mrmlScene.nodes.clear()
        slicer.mrmlScene.observers.clear()
        slicer.cli.running.clear()
        slicer.cli.commands.clear()
        slicer.util.shownErrors.clear()
        slicer.labelmapGeometry = images.Geometry()
        self.array = images.two_labels()
        self.widget = VoxplexMesher.VoxplexMesherWidget()
        self.widget.setup()
        self.addCleanup(self.widget.cleanup)

    def add_segmentation(self, name="Knee", size=None):
        node = slicer.mrmlScene.AddNewNodeByClass("vtkMRMLSegmentationNode", name)
        array = self.array if size is None else images.two_labels(size, 0.44 * size)
        node.GetSegmentation().add("a", "Bone", (1.0, 0.9, 0.7), array == 3)
        node.GetSegmentation().add("b", "Muscle", (0.6, 0.2, 0.2), array == 7)
        return node

    def choose_segmentation(self, **options):
        node = self.add_segmentation(**options)
        self.widget.segmentationSelector.setCurrentNode(node)
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
        self.assertEqual(parent.dependencies, ["Segmentations", "SegmentationToTetMesh"])
        self.assertTrue((MODULE / "Resources" / "Icons" / "VoxplexMesher.png").is_file())

    def test_apply_needs_a_segmentation(self):
        self.assertFalse(self.widget.applyButton.enabled)
        self.assertEqual(self.widget.applyButton.toolTip, "Choose a segmentation first")
        self.assertFalse(self.widget.cancelButton.enabled)
        self.choose_segmentation()
        self.assertTrue(self.widget.applyButton.enabled)

    def test_first_segmentation_is_taken(self):
        node = self.add_segmentation()
        self.widget.enter()
        self.assertIs(self.widget.segmentationSelector.currentNode(), node)

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
        self.widget.segmentationSelector.setCurrentNode(other)
        self.assertEqual(segmentation.observers, {})  # the first is no longer observed
        self.assertEqual(len(other.GetSegmentation().observers), 3)

    def test_panel_and_parameter_node(self):
        node = self.widget.parameterNode
        self.assertEqual(node.GetParameter("delta"), "0.0")
        self.widget.deltaSpinBox.value = 1.5
        self.widget.threadsSpinBox.value = 3
        self.widget.forceCheckBox.checked = True
        self.assertEqual([node.GetParameter(name) for name in ("delta", "threads", "force")], ["1.5", "3", "true"])
        for name, value in (("size", 4.0), ("smoothing", 0.5), ("radiusEdge", 1.95), ("facetAngle", 20.0), ("threads", 2)):
            node.SetParameter(name, repr(value))
            self.assertEqual(getattr(self.widget, name + "SpinBox").value, value)
        node.SetParameter("force", "false")
        self.assertFalse(self.widget.forceCheckBox.checked)

    def test_defaults_are_those_of_the_cli_module(self):
        for name, p in slicer.modules.segmentationtotetmesh.parameters.items():
            box = getattr(self.widget, name + "SpinBox", None)
            if box:
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
        command = slicer.cli.commands[-1]
        self.assertEqual(command[command.index("--delta") + 1], "2.0")
        self.assertNotIn("--force", command)

        mesh = self.mesh_node().GetMesh()
        self.assertEqual(self.mesh_node().GetName(), "Knee mesh")
        for f, label in zip(measureLabels(mesh), (3, 7)):
            self.assertAlmostEqual(f.volume / (self.array == label).sum(), 1.0, delta=0.08)
        names = mesh.GetFieldData().GetAbstractArray("LabelNames")
        self.assertEqual([names.GetValue(i) for i in range(names.GetNumberOfValues())], ["Bone", "Muscle"])
        self.assertRegex("\n".join(self.log()), r"(?s)^Meshing Bone, Muscle\n\d+ tetrahedra with \d+ nodes\n  Bone: \d+ "
                         r"tetrahedra, .* mm³\n  Muscle: \d+ ")
        self.check_display(self.mesh_node().GetDisplayNode())
        # The temporary label map, its colours and the node of the CLI module are gone.
        self.assertEqual(slicer.mrmlScene.names("vtkMRMLLabelMapVolumeNode"), [])
        self.assertEqual(slicer.mrmlScene.names("vtkMRMLCommandLineModuleNode"), [])
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

    def test_progress_is_shown(self):
        self.choose_segmentation(size=48)
        self.widget.deltaSpinBox.value = 0.8
        shown = []
        show = self.widget.showState

        def record(state):
            show(state)
            shown.append(self.widget.progressBar.value)
        self.widget.logic.onChange = record
        self.assertEqual(self.apply().phase, Phase.COMPLETED)
        self.assertEqual(shown, sorted(shown))
        self.assertGreater(len(set(shown)), 4)

    def test_choices_and_settings_arrive(self):
        self.choose_segmentation()
        self.item(0, MESH).setCheckState(qt.Qt.Unchecked)
        self.item(1, SIZE).setText("1.5")
        self.widget.radiusEdgeSpinBox.value = 1.9
        self.widget.forceCheckBox.checked = True
        self.assertEqual(self.apply().phase, Phase.COMPLETED, self.log())
        command = slicer.cli.commands[-1]
        self.assertEqual(command[command.index("--labelsizes") + 1], "1=1.5")
        self.assertEqual(command[command.index("--radiusedge") + 1], "1.9")
        self.assertIn("--force", command)
        figures, = measureLabels(self.mesh_node().GetMesh())
        self.assertEqual(figures.label, 1)
        self.assertAlmostEqual(figures.volume / (self.array == 7).sum(), 1.0, delta=0.08)
        self.assertRegex(self.log()[2], "^  Muscle: ")

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
        self.assertEqual(slicer.cli.running, [])
        self.assertTrue(self.widget.applyButton.enabled)

    def test_failure(self):
        self.choose_segmentation()
        self.widget.radiusEdgeSpinBox.value = 1.2
        self.assertEqual(self.apply().phase, Phase.FAILED)
        self.assertRegex(self.log()[-1], "^Failed: SegmentationToTetMesh: cannot mesh .*--force")
        self.assertEqual(self.widget.progressBar.format, "failed")
        self.assertIsNone(self.mesh_node().GetMesh())
        self.assertEqual(slicer.mrmlScene.names("vtkMRMLLabelMapVolumeNode"), [])
        self.assertTrue(self.widget.applyButton.enabled)

    def test_missing_cli_module(self):
        module = slicer.modules.__dict__.pop("segmentationtotetmesh")
        self.addCleanup(setattr, slicer.modules, "segmentationtotetmesh", module)
        self.choose_segmentation()
        self.widget.applyButton.click()
        self.assertRegex(slicer.util.shownErrors[-1], "module paths")
        self.assertTrue(self.widget.applyButton.enabled)

    def test_cancel(self):
        self.choose_segmentation(size=64)
        self.widget.deltaSpinBox.value = 0.05
        self.widget.forceCheckBox.checked = True
        self.widget.applyButton.click()
        for _ in range(20):
            slicer.app.processEvents()
        process = slicer.cli.running[0].process
        self.assertIsNone(process.poll())
        self.widget.cancelButton.click()
        self.assertEqual(self.widget.progressBar.format, "cancelling")
        self.assertFalse(self.widget.cancelButton.enabled)
        self.assertEqual(self.finish().phase, Phase.CANCELLED)
        self.assertIsNotNone(process.poll())
        self.assertEqual(self.log()[-1], "Cancelled")
        self.assertIsNone(self.mesh_node().GetMesh())
        self.assertTrue(self.widget.applyButton.enabled)
        self.assertEqual(slicer.mrmlScene.names("vtkMRMLLabelMapVolumeNode"), [])

    def test_oblique_axes(self):
        """The mesh lies where the label map lies."""
        turned = images.Geometry(origin=(50.0, -10.0, 3.0), spacing=(1.0, 2.0, 0.5),
                                 direction=np.array([[0.6, -0.8, 0.0], [0.8, 0.6, 0.0], [0.0, 0.0, 1.0]]))
        slicer.labelmapGeometry = turned
        self.choose_segmentation()
        self.apply()
        bounds = np.array(self.mesh_node().GetMesh().GetBounds()).reshape(3, 2)
        np.testing.assert_allclose(bounds.mean(axis=1), turned.physical(np.full(3, 11.5)), atol=1.0)

    def test_self_test_of_the_module(self):
        """What Slicer's developer mode runs."""
        slicer.labelmapGeometry = images.Geometry(origin=(-15.0, -15.0, -15.0))
        test = VoxplexMesher.VoxplexMesherTest()
        test.runTest()


if __name__ == "__main__":
    unittest.main(verbosity=2)
