#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Both modules with 3D Slicer itself (slicer-core), and with the wheel: the scripted module with its nodes and segmentations, the
program as it reads the description of a CLI module, and runs one.

There is no application, no window and no Qt: a process has a few lines here. Scripts/test-wheel runs this."""
import ctypes
import os
import subprocess
import sys
import tempfile
import types
import unittest
from pathlib import Path

import numpy as np
import slicer
import slicer.util
import slicer_core
import voxplex
import vtk

sys.path.append(str(Path(__file__).resolve().parents[3] / "Plugins" / "Slicer" / "VoxplexMesher"))


class Process:
    """What the module uses of QProcess. Its text is read, a line at a time, when events are processed."""
    NormalExit, CrashExit, FailedToStart = 0, 1, 0
    running = None

    def __init__(self):
        self.slots, self.text = {}, b""

    def connect(self, signal, slot):
        self.slots[signal.partition("(")[0]] = slot

    def setProcessEnvironment(self, environment):
        self.environment = environment

    def start(self, program, arguments):
        self.process = subprocess.Popen([program, *arguments], env=self.environment, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        Process.running = self

    def kill(self):
        self.process.kill()

    def readAllStandardError(self):
        return types.SimpleNamespace(data=lambda: self.text)

    @classmethod
    def proceed(cls):
        self = cls.running
        self.text = self.process.stderr.readline()
        if self.text:
            self.slots["readyReadStandardError"]()
        else:
            self.process.stderr.close()
            status = self.process.wait()
            self.slots["finished"](max(status, 0), self.NormalExit if status >= 0 else self.CrashExit)


BASES = types.ModuleType("slicer.ScriptedLoadableModule")
BASES.ScriptedLoadableModuleLogic = type("ScriptedLoadableModuleLogic", (), {})
BASES.ScriptedLoadableModuleTest = unittest.TestCase
sys.modules[BASES.__name__] = BASES
sys.modules["qt"] = types.SimpleNamespace(QProcess=Process)
slicer.app = types.SimpleNamespace(processEvents=Process.proceed, startupEnvironment=lambda: dict(os.environ))
SEGMENTATIONS = slicer.vtkSlicerSegmentationsModuleLogic()
slicer.modules = types.SimpleNamespace(segmentations=types.SimpleNamespace(logic=lambda: SEGMENTATIONS))

from VoxplexMesherLib import SelfTest  # noqa: E402
from VoxplexMesherLib.Logic import Phase, measureLabels  # noqa: E402
from VoxplexMesherLib.ModuleLogic import VoxplexMesherLogic  # noqa: E402


def nodes(className):
    found = slicer.mrmlScene.GetNodesByClass(className)
    found.UnRegister(None)
    return [found.GetItemAsObject(i) for i in range(found.GetNumberOfItems())]


class CLIModule(unittest.TestCase):
    """Slicer's parser of descriptions, which Python does not reach, is called by its names in the libraries."""

    @classmethod
    def setUpClass(cls):
        libraries = Path(slicer_core.__file__).parent
        cls.parser = ctypes.CDLL(str(libraries / "third_party.libs" / "libModuleDescriptionParser.so"))
        cls.cli = ctypes.CDLL(str(libraries / "libMRMLCLI.so"))
        cls.strings = ctypes.CDLL("libstdc++.so.6")
        cls.program = voxplex.program.path()
        cls.xml = subprocess.run([cls.program, "--xml"], capture_output=True, check=True).stdout

    def text(self, value):
        text = ctypes.create_string_buffer(8)  # a std::string of the older interface is a pointer
        self.strings._ZNSsC1EPKcRKSaIcE(text, value, ctypes.create_string_buffer(1))
        return text

    def register(self, xml):
        """For all command line module nodes. The parser's status: 0 if it finds no fault."""
        description = ctypes.create_string_buffer(1 << 16)  # more than a ModuleDescription has
        self.parser._ZN17ModuleDescriptionC1Ev(description)
        status = self.parser._ZN23ModuleDescriptionParser5ParseERKSsR17ModuleDescription(
            ctypes.create_string_buffer(8), self.text(xml), description)
        self.parser._ZN17ModuleDescription9SetTargetERKSs(description, self.text(os.fsencode(self.program)))
        self.parser._ZN17ModuleDescription7SetTypeERKSs(description, self.text(b"CommandLineModule"))
        self.cli._ZN28vtkMRMLCommandLineModuleNode25RegisterModuleDescriptionE17ModuleDescription(description)
        return status

    def test_faults_are_found(self):
        self.assertEqual(self.register(self.xml), 0)
        for old, new in ((b"<?xml", b" <?xml"), (b"--label_size", b"--label-size"), (b"<name>delta", b"<name>del ta"),
                         (b'type="model"', b'type="mesh"'), (b"<index>1</index>", b"<index>1</index><longflag>--o</longflag>"),
                         (b"<boolean>", b"<switch>"), (b"<default>lps", b"<standard>lps")):
            self.assertNotEqual(self.register(self.xml.replace(old, new)), 0, new)

    def test_run(self):
        """Slicer writes the image, makes the command line, and reads what the program returns."""
        self.register(self.xml)
        scene = slicer.mrmlScene = slicer.vtkMRMLScene()
        application, logic = slicer.vtkSlicerApplicationLogic(), slicer.vtkSlicerCLIModuleLogic()
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        application.SetTemporaryPath(folder.name)
        logic.SetMRMLApplicationLogic(application)
        for one in (application, logic):
            one.SetMRMLScene(scene)
        logic.DeleteTemporaryFilesOff()  # an application would read them now
        volume = scene.AddNewNodeByClass("vtkMRMLLabelMapVolumeNode", "labels")
        array = np.zeros((24, 24, 24), np.uint8)
        array[6:18, 6:18, 6:12], array[6:18, 6:18, 12:18] = 3, 7
        slicer.util.updateVolumeFromArray(volume, array)
        volume.SetOrigin(10, 20, 30)
        node = scene.AddNode(slicer.vtkMRMLCommandLineModuleNode())
        node.SetModuleDescription("Segmentation To Tetrahedral Mesh")
        node.SetParameterAsNode("inputLabels", volume)
        for name in ("outputMesh", "outputSurfaces"):
            node.SetParameterAsNode(name, scene.AddNewNodeByClass("vtkMRMLModelNode", name))
        for name, text in (("labels", "3, 7"), ("shells", "3=2"), ("minimumThickness", "7=2, 3=2"), ("noOptimise", "true"), ("delta", "1.0")):
            node.SetParameterAsString(name, text)
        logic.ApplyAndWait(node, False)
        self.assertEqual((node.GetStatusString(), node.GetErrorText()), ("Completed", ""))
        self.assertRegex(node.GetOutputText(), r"^[\d,]+ tetrahedra in 3 labels, [^<]*$")
        result, = Path(folder.name).glob("*.params")
        self.assertTrue(node.ReadParameterFile(str(result)))
        mesh, = Path(folder.name).glob("*.vtu")
        storage, model = slicer.vtkMRMLModelStorageNode(), slicer.vtkMRMLModelNode()
        storage.SetFileName(str(mesh))
        self.assertTrue(storage.ReadData(model))
        self.assertEqual(node.GetParameterAsString("numberOfTetrahedra"), str(model.GetMesh().GetNumberOfCells()))
        np.testing.assert_allclose(np.reshape(model.GetMesh().GetBounds(), (3, 2)).mean(axis=1), (20.5, 31.5, 41.5), atol=0.6)
        self.assertEqual(len(list(Path(folder.name).glob("*.vtp"))), 1)
        node.SetParameterAsString("delta", "-1")
        logic.ApplyAndWait(node, False)
        self.assertRegex(node.GetErrorText(), "^voxplex: Delta: must be greater than 0, not -1")


class MRML(unittest.TestCase):
    def setUp(self):
        slicer.mrmlScene = slicer.vtkMRMLScene()
        SEGMENTATIONS.SetMRMLScene(slicer.mrmlScene)
        parameterNode = slicer.mrmlScene.AddNewNodeByClass("vtkMRMLScriptedModuleNode")
        BASES.ScriptedLoadableModuleLogic.getParameterNode = lambda logic: parameterNode
        self.node = parameterNode
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        slicer.app.temporaryPath = folder.name

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

    def mesh_balls(self, *balls, sizes=(), onChange=lambda logic, state: None, **parameters):
        """The last state of a run with balls: name, x, radius."""
        segmentation = slicer.mrmlScene.AddNewNodeByClass("vtkMRMLSegmentationNode", "Balls")
        segmentation.CreateDefaultDisplayNodes()
        segmentation.SetReferenceImageGeometryParameterFromVolumeNode(SelfTest.VoxplexMesherTest.makeGrid())
        for name, x, radius in balls:
            ball = vtk.vtkSphereSource()
            ball.SetCenter(x, 0.0, 0.0)
            ball.SetRadius(radius)
            ball.SetPhiResolution(40)
            ball.SetThetaResolution(40)
            ball.Update()
            segmentation.AddSegmentFromClosedSurfaceRepresentation(ball.GetOutput(), name, [1.0, 0.5, 0.5])
        logic, states = VoxplexMesherLogic(), []
        logic.onChange = lambda state: (states.append(state), onChange(logic, state))
        logic.setDefaultParameters(self.node)
        self.node.SetNodeReferenceID("Segmentation", segmentation.GetID())
        for name, text in {"delta": "2.0", **parameters}.items():
            self.node.SetParameter(name, text)
        segments = logic.segments(self.node)
        for segment, chosen in zip(segments, sizes):
            segment.sizes = chosen
        logic.storeSegments(self.node, segments)
        logic.apply(self.node)
        logic.wait()
        self.assertEqual(os.listdir(slicer.app.temporaryPath), [])
        return states[-1]

    def test_overlap(self):
        """A ball within a larger one, and beside it, gets its voxels, wherever it stands in the table."""
        state = self.mesh_balls(("Small / first", 4.0, 6.0), ("Large", 0.0, 12.0), ("Last", 40.0, 8.0))
        self.assertEqual(state.phase, Phase.COMPLETED, state)
        self.assertRegex(state.warnings, "masks overlap in [0-9]+ voxels, which the smallest of them gets: Small _ first and Large")
        figures = measureLabels(self.node.GetNodeReference("OutputMesh").GetMesh())
        balls = [4 / 3 * np.pi * radius**3 for radius in (6, 12, 8)]
        np.testing.assert_allclose([f.volume for f in figures], [balls[0], balls[1] - balls[0], balls[2]], rtol=0.1)
        self.assertEqual(nodes("vtkMRMLLabelMapVolumeNode"), [])

    def test_shell(self):
        """It has a name and a colour in the scene."""
        state = self.mesh_balls(("First", 0.0, 8.0), ("Second", 40.0, 8.0), sizes=({"labelSizes": 3.0}, {"shells": 3.0}))
        self.assertEqual(state.phase, Phase.COMPLETED, state)
        figures = measureLabels(self.node.GetNodeReference("OutputMesh").GetMesh())
        np.testing.assert_allclose([f.volume for f in figures], 4 / 3 * np.pi * np.array((8**3, 8**3, 11**3 - 8**3)), rtol=0.1)
        colors, = nodes("vtkMRMLColorTableNode")
        self.assertEqual([colors.GetColorName(i) for i in range(colors.GetNumberOfColors())],
                         ["background", "First", "Second", "Second shell"])

    def test_failure(self):
        """The image is named as in the scene, and not as the file that it was in."""
        state = self.mesh_balls(("Ball", 0.0, 8.0), minimumVolume="1000000")
        self.assertEqual(state.phase, Phase.FAILED)
        self.assertRegex(state.message, "^voxplex: .*component.* smaller")
        self.assertNotIn("image.nrrd", state.message)

    def test_cancel(self):
        state = self.mesh_balls(("Ball", 0.0, 12.0), onChange=lambda logic, state: state.progress > 0.1 and logic.cancel(), delta="0.2")
        self.assertEqual(state.phase, Phase.CANCELLED)

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
