# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""The module's test inside Slicer: Reload and Test in the developer mode, or ctest in a build of the extension."""
import slicer
import vtk
from slicer.ScriptedLoadableModule import ScriptedLoadableModuleTest

from VoxplexMesherLib.Logic import Phase, measureLabels
from VoxplexMesherLib.ModuleLogic import VoxplexMesherLogic
from VoxplexMesherLib.Program import PACKAGE, isInstalled

RADIUS = 10.0


class VoxplexMesherTest(ScriptedLoadableModuleTest):
    def setUp(self):
        slicer.mrmlScene.Clear()

    def runTest(self):
        self.setUp()
        self.test_balls()

    @staticmethod
    def makeGrid():
        """A volume around the balls, with voxels of 1 mm: Slicer would take 62 million for this segmentation."""
        image = vtk.vtkImageData()
        image.SetDimensions(91, 31, 31)
        image.AllocateScalars(vtk.VTK_UNSIGNED_CHAR, 1)
        grid = slicer.mrmlScene.AddNewNodeByClass("vtkMRMLScalarVolumeNode", "Grid")
        grid.SetAndObserveImageData(image)
        grid.SetOrigin(-15.0, -15.0, -15.0)
        return grid

    def test_balls(self):
        """Of three balls the second is not meshed: two labels, each with about the volume of its ball."""
        if not isInstalled():
            self.skipTest(PACKAGE + " is not installed: press Apply in the module once")
        segmentationNode = slicer.mrmlScene.AddNewNodeByClass("vtkMRMLSegmentationNode", "Balls")
        segmentationNode.CreateDefaultDisplayNodes()
        segmentationNode.SetReferenceImageGeometryParameterFromVolumeNode(self.makeGrid())
        for name, x in (("First", 0.0), ("Second", 30.0), ("Third", 60.0)):
            ball = vtk.vtkSphereSource()
            ball.SetCenter(x, 0.0, 0.0)
            ball.SetRadius(RADIUS)
            ball.SetPhiResolution(40)
            ball.SetThetaResolution(40)
            ball.Update()
            segmentationNode.AddSegmentFromClosedSurfaceRepresentation(ball.GetOutput(), name, [1.0, 0.5, 0.5])

        logic = VoxplexMesherLogic()
        states = []
        logic.onChange = states.append
        node = logic.getParameterNode()
        logic.setDefaultParameters(node)
        node.SetNodeReferenceID("Segmentation", segmentationNode.GetID())
        node.SetParameter("delta", "2.0")
        segments = logic.segments(node)
        segments[1].mesh = False
        logic.storeSegments(node, segments)
        logic.apply(node)
        logic.wait()

        self.assertEqual(states[-1].phase, Phase.COMPLETED)
        figures = measureLabels(node.GetNodeReference("OutputMesh").GetMesh())
        self.assertEqual([f.label for f in figures], [1, 2])
        for f in figures:
            self.assertAlmostEqual(f.volume / (4.0 / 3.0 * vtk.vtkMath.Pi() * RADIUS**3), 1.0, delta=0.1)
