#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""The scripted module with the nodes and the segmentations of 3D Slicer itself (slicer-core), and with the wheel.

There is no application: what it and Qt bring has stand-ins. Scripts/test-wheel runs this."""
import importlib.util
import os
import sys
import tempfile
import types
import unittest
from pathlib import Path

import numpy as np
import slicer
import slicer.util
import vtk

HERE = Path(__file__).resolve().parent
sys.path.append(str(HERE / "standins"))  # behind slicer-core, which has a module `slicer`, too
sys.path.append(str(HERE.parents[2] / "Plugins" / "Slicer" / "VoxplexMesher"))

import qt  # noqa: E402

SPECIFICATION = importlib.util.spec_from_file_location("slicer.ScriptedLoadableModule",
                                                       HERE / "standins" / "slicer" / "ScriptedLoadableModule.py")
BASES = importlib.util.module_from_spec(SPECIFICATION)
sys.modules[SPECIFICATION.name] = BASES
SPECIFICATION.loader.exec_module(BASES)
slicer.app = types.SimpleNamespace(processEvents=qt.processEvents, temporaryPath=tempfile.gettempdir(),
                                   startupEnvironment=lambda: dict(os.environ))
SEGMENTATIONS = slicer.vtkSlicerSegmentationsModuleLogic()
slicer.modules = types.SimpleNamespace(segmentations=types.SimpleNamespace(logic=lambda: SEGMENTATIONS))

from VoxplexMesherLib import SelfTest  # noqa: E402
from VoxplexMesherLib.Logic import Phase, measureLabels  # noqa: E402
from VoxplexMesherLib.ModuleLogic import VoxplexMesherLogic  # noqa: E402


def nodes(className):
    found = slicer.mrmlScene.GetNodesByClass(className)
    found.UnRegister(None)
    return [found.GetItemAsObject(i) for i in range(found.GetNumberOfItems())]


class MRML(unittest.TestCase):
    def setUp(self):
        slicer.mrmlScene = slicer.vtkMRMLScene()
        SEGMENTATIONS.SetMRMLScene(slicer.mrmlScene)
        parameterNode = slicer.mrmlScene.AddNewNodeByClass("vtkMRMLScriptedModuleNode")
        BASES.ScriptedLoadableModuleLogic.getParameterNode = lambda logic: parameterNode
        self.node = parameterNode

    def test_segmentation(self):
        SelfTest.VoxplexMesherTest().test_balls()
        model, = nodes("vtkMRMLModelNode")
        self.assertEqual(nodes("vtkMRMLLabelMapVolumeNode"), [])
        display, = nodes("vtkMRMLModelDisplayNode")
        self.assertIs(model.GetDisplayNode(), display)
        self.assertEqual(display.GetActiveScalarName(), "Label")
        self.assertEqual((display.GetScalarVisibility(), display.GetEdgeVisibility(), display.GetVisibility()), (1, 1, 1))
        colors, = nodes("vtkMRMLColorTableNode")
        self.assertIs(display.GetColorNode(), colors)
        self.assertEqual([colors.GetColorName(i) for i in range(colors.GetNumberOfColors())],
                         ["background", "First", "Third"])
        self.check_file(model)

    def check_file(self, model):
        """A file that Slicer writes lies where the node lies."""
        with tempfile.TemporaryDirectory() as folder:
            storage = slicer.vtkMRMLModelStorageNode()
            storage.SetFileName(str(Path(folder) / "mesh.vtu"))
            self.assertTrue(storage.WriteData(model))
            loaded = slicer.vtkMRMLModelNode()
            self.assertTrue(storage.ReadData(loaded))
        np.testing.assert_allclose(loaded.GetMesh().GetBounds(), model.GetMesh().GetBounds(), rtol=1e-6)
        names = loaded.GetMesh().GetFieldData().GetAbstractArray("LabelNames")
        self.assertEqual([names.GetValue(i) for i in range(names.GetNumberOfValues())], ["First", "Third"])

    def test_overlap(self):
        """A ball within a larger one, and beside it, gets its voxels, wherever it stands in the table."""
        segmentation = slicer.mrmlScene.AddNewNodeByClass("vtkMRMLSegmentationNode", "Balls")
        segmentation.CreateDefaultDisplayNodes()
        segmentation.SetReferenceImageGeometryParameterFromVolumeNode(SelfTest.VoxplexMesherTest.makeGrid())
        for name, x, radius in (("Small / first", 4.0, 6.0), ("Large", 0.0, 12.0), ("Last", 40.0, 8.0)):
            ball = vtk.vtkSphereSource()
            ball.SetCenter(x, 0.0, 0.0)
            ball.SetRadius(radius)
            ball.SetPhiResolution(40)
            ball.SetThetaResolution(40)
            ball.Update()
            segmentation.AddSegmentFromClosedSurfaceRepresentation(ball.GetOutput(), name, [1.0, 0.5, 0.5])
        logic = VoxplexMesherLogic()
        states = []
        logic.onChange = states.append
        logic.setDefaultParameters(self.node)
        self.node.SetNodeReferenceID("Segmentation", segmentation.GetID())
        self.node.SetParameter("delta", "2.0")
        logic.apply(self.node)
        logic.wait()
        self.assertEqual(states[-1].phase, Phase.COMPLETED, states[-1])
        self.assertRegex(states[-1].warnings, "masks overlap in [0-9]+ voxels, which the smallest of them gets: Small _ first and Large")
        figures = measureLabels(self.node.GetNodeReference("OutputMesh").GetMesh())
        balls = [4 / 3 * np.pi * radius**3 for radius in (6, 12, 8)]
        np.testing.assert_allclose([f.volume for f in figures], [balls[0], balls[1] - balls[0], balls[2]], rtol=0.1)
        self.assertEqual(nodes("vtkMRMLLabelMapVolumeNode"), [])

    def test_volume(self):
        """A ball in an oblique volume; its mesh, and its interfaces, lie where the ball lies."""
        k, j, i = np.mgrid[:20, :24, :28]
        distances = np.sqrt((i - 13.5) ** 2 + (j - 11.5) ** 2 + (2 * (k - 9.5)) ** 2)
        angle = 0.4
        directions = np.array([[np.cos(angle), 0, np.sin(angle)], [-np.sin(angle), 0, np.cos(angle)], [0, 1, 0]])
        volume = slicer.mrmlScene.AddNewNodeByClass("vtkMRMLScalarVolumeNode", "Distances")
        slicer.util.updateVolumeFromArray(volume, distances.astype(np.float32))
        volume.SetSpacing(1, 1, 2)
        volume.SetOrigin(10, -20, 30)
        volume.SetIJKToRASDirections(*directions.ravel())
        matrix = vtk.vtkMatrix4x4()
        volume.GetIJKToRASMatrix(matrix)
        center = matrix.MultiplyPoint((13.5, 11.5, 9.5, 1))[:3]

        surfaces = slicer.mrmlScene.AddNewNodeByClass("vtkMRMLModelNode", "Surfaces")
        logic = VoxplexMesherLogic()
        states = []
        logic.onChange = states.append
        logic.setDefaultParameters(self.node)
        self.node.SetNodeReferenceID("Volume", volume.GetID())
        self.node.SetNodeReferenceID("OutputSurfaces", surfaces.GetID())
        for name, text in (("delta", "2.0"), ("isovalue", "8.0"), ("inside", "below")):
            self.node.SetParameter(name, text)
        logic.apply(self.node)
        logic.wait()
        self.assertEqual(states[-1].phase, Phase.COMPLETED, states[-1])
        model = self.node.GetNodeReference("OutputMesh")
        figures, = measureLabels(model.GetMesh())
        self.assertAlmostEqual(figures.volume / (4 / 3 * np.pi * 8**3), 1.0, delta=0.02)
        for mesh in (model.GetMesh(), surfaces.GetMesh()):
            bounds = np.array(mesh.GetBounds()).reshape(3, 2)
            np.testing.assert_allclose(bounds.mean(axis=1), center, atol=0.3)
            np.testing.assert_allclose(np.ptp(bounds, axis=1), 16, atol=0.6)
        self.assertEqual(surfaces.GetDisplayNode().GetVisibility(), 0)


if __name__ == "__main__":
    unittest.main(verbosity=2)
