#!/usr/bin/python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""The logic of the scripted module, without Slicer: with the CLI module as a process, and with the VTK filter."""
import os
import re
import subprocess
import sys
import unittest
from dataclasses import fields, replace
from xml.etree import ElementTree

from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonDataModel import vtkImageData, vtkUnstructuredGrid
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

import images
from module import EXECUTABLE, MODULE, ModuleTestCase
from VoxplexMesherLib.Logic import (MeshingError, MeshingLogic, Phase, RunState, Segment, Settings, commandParameters,
                                    describeMesh, describeQuality, labelMesh, measureLabels,
                                    mergeChoices, parseInterfaceSizes, parseSize, storeChoices)

SEGMENTS = [Segment("s1", "Bone", (1.0, 0.9, 0.7)), Segment("s2", "Mark", (0.8, 0.1, 0.1)),
            Segment("s3", "Muscle, left", (0.5, 0.2, 0.2))]


def read(path):
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


class ProcessRunner:
    """Calls the executable; waits for it in start()."""

    def __init__(self, folder):
        self.input, self.output = folder / "labels.nrrd", folder / "mesh.vtu"
        flags = subprocess.run([EXECUTABLE, "--xml"], capture_output=True, text=True, check=True).stdout
        self.flags = {p.findtext("name"): p for g in ElementTree.fromstring(flags.encode()).findall("parameters")
                      for p in g if p.find("longflag") is not None}

    def start(self, parameters, onChange):
        arguments = []
        for name, value in parameters.items():
            flag = self.flags[name].findtext("longflag")
            if self.flags[name].tag == "boolean":
                arguments += [flag] if value else []
            elif value != "":
                arguments += [flag, str(value)]
        self.process = subprocess.Popen([EXECUTABLE, *arguments, self.input, self.output], stdout=subprocess.PIPE,
                                        stderr=subprocess.PIPE, text=True)
        self.cancelled = False
        for line in self.process.stdout:
            found = re.match("<filter-progress>(.*)</filter-progress>", line)
            if found:
                onChange(RunState(Phase.RUNNING, float(found.group(1))))
        errors = self.process.communicate()[1]
        if self.cancelled:
            onChange(RunState(Phase.CANCELLED))
        elif self.process.returncode:
            onChange(RunState(Phase.FAILED, message=errors))
        else:
            onChange(RunState(Phase.COMPLETED, 1.0, warnings=errors))

    def cancel(self):
        self.cancelled = True
        self.process.kill()

    def mesh(self):
        return read(self.output)


class FilterRunner:
    """Calls the filter of the Python package."""

    def __init__(self, array):
        import voxplex
        self.filter = voxplex.vtkImageToTetMeshFilter()
        image = vtkImageData()
        image.SetDimensions(array.shape[::-1])
        image.GetPointData().SetScalars(numpy_to_vtk(array.ravel(), deep=True))
        self.filter.SetInputData(image)

    def start(self, parameters, onChange):
        names = {"delta": "Delta", "elements": "NumberOfElements", "size": "ElementSize", "smoothing": "SmoothingSigma",
                 "radiusEdge": "RadiusEdgeRatio", "facetAngle": "FacetAngle", "sliverAngle": "SliverAngle",
                 "gradation": "Gradation", "featureRatio": "FeatureRatio", "largestFeature": "LargestFeature",
                 "optimiseSeconds": "OptimisationTimeLimit", "interfaceRounds": "InterfaceRounds",
                 "smallestComponent": "SmallestComponent", "exactComponents": "ExactComponents", "minimumVolume": "MinimumComponentVolume",
                 "threads": "NumberOfThreads", "reproducible": "Reproducible", "force": "Force"}
        for name, value in parameters.items():
            if name in names:
                getattr(self.filter, "Set" + names[name])(value)
        self.filter.SetGrading(["uniform", "lfs"].index(parameters["grading"]))
        self.filter.SetOptimise(parameters["optimise"] == "on")
        self.filter.SetSampleJunctions(parameters["junctions"] == "on")
        rest = set(parameters) - set(names) - {"grading", "optimise", "junctions", "labelSizes"}
        if any(parameters[name] for name in rest):
            raise AssertionError("not for this runner: %s" % rest)
        for item in filter(None, parameters["labelSizes"].split(",")):
            label, size = item.split("=")
            self.filter.SetLabelSize(int(label), float(size))
        self.filter.Update()
        failed = self.filter.GetErrorMessage()
        onChange(RunState(Phase.FAILED, message=failed) if failed else RunState(Phase.COMPLETED, 1.0))

    def mesh(self):
        return self.filter.GetOutput()


class Choices(unittest.TestCase):
    def test_needs_no_slicer(self):
        code = "import sys; sys.path.insert(0, %r); import VoxplexMesherLib; VoxplexMesherLib.__path__.append(%r); " \
               "import VoxplexMesherLib.Logic; sys.exit(any(m in sys.modules for m in ('slicer', 'qt', 'ctk')))" % (
                   str(MODULE), os.environ["VOXPLEX_SLICER_TABLE"])
        environment = {**os.environ, "PYTHONPATH": ""}
        self.assertEqual(subprocess.run([sys.executable, "-B", "-c", code], env=environment).returncode, 0)

    def test_choices_are_stored_by_id(self):
        chosen = [replace(SEGMENTS[0], mesh=False), replace(SEGMENTS[1], size=1.5), SEGMENTS[2]]
        text = storeChoices(chosen)
        self.assertEqual(mergeChoices(SEGMENTS, text), chosen)
        # In another order, with one more and one fewer: what is known stays, what is new is meshed.
        new = Segment("s4", "New", (0, 0, 1))
        self.assertEqual(mergeChoices([new, SEGMENTS[1], SEGMENTS[0]], text), [new, chosen[1], chosen[0]])
        self.assertEqual(mergeChoices(SEGMENTS, ""), SEGMENTS)
        self.assertEqual(mergeChoices(SEGMENTS, "{broken"), SEGMENTS)

    def test_sizes_as_typed(self):
        self.assertEqual([parseSize(text) for text in ("", " 1.5 ", "1,5", "0", "2e1")], [0.0, 1.5, 1.5, 0.0, 20.0])
        for text in ("x", "-1", "nan", "inf", "1.5 mm"):
            with self.assertRaisesRegex(MeshingError, "is not a size"):
                parseSize(text)

    def test_settings_as_texts(self):
        settings = Settings(delta=1.25, threads=3, force=True)
        texts = settings.toTexts()
        self.assertTrue(all(isinstance(text, str) for text in texts.values()))
        self.assertEqual((texts["delta"], texts["threads"], texts["force"]), ("1.25", "3", "true"))
        self.assertEqual(Settings.fromTexts(texts.get), settings)
        self.assertEqual(Settings.fromTexts(lambda name: ""), Settings())
        hand = Settings.fromTexts({"delta": "by hand", "smallestComponent": "eight"}.get)
        self.assertEqual((hand.delta, hand.smallestComponent), (0.0, 8))
        self.assertEqual(Settings.fromTexts(Settings(optimise="off", grading="lfs").toTexts().get).optimise, "off")

    def test_parameters(self):
        segments = [replace(SEGMENTS[0], mesh=False, size=9.0), replace(SEGMENTS[1]), replace(SEGMENTS[2], size=1.5)]
        parameters = commandParameters(segments, Settings(delta=2.0))
        self.assertEqual(parameters["labelSizes"], "2=1.5")  # the first is not meshed: the labels are 1 and 2
        self.assertEqual(parameters["delta"], 2.0)

    def test_parameters_that_count(self):
        """What has no effect is not passed on."""
        def names(isosurface=False, **settings):
            return set(commandParameters(SEGMENTS, Settings(**settings), isosurface))
        plain = names()
        self.assertEqual({"delta", "isovalue", "inside", "greySmoothing", "featureRatio", "largestFeature", "quality",
                          "smoothing"} & plain, {"delta", "quality", "smoothing"})
        self.assertEqual(names(grading="lfs") - plain, {"featureRatio", "largestFeature"})
        self.assertEqual(plain - names(elements=9), {"delta"})
        self.assertEqual(names(isosurface=True) ^ plain, {"isovalue", "inside", "greySmoothing", "quality", "smoothing"})
        self.assertFalse(commandParameters(SEGMENTS, Settings())["isosurface"])
        self.assertTrue(commandParameters(SEGMENTS, Settings(), isosurface=True)["isosurface"])

    def test_interface_sizes(self):
        segments = [*SEGMENTS, Segment("s4", "A : B", (0, 0, 1)), Segment("s5", "T=37", (0, 1, 1))]
        for text, expected in {
                "": "", " ; ": "", "Bone=0.5": "1=0.5", "Bone = 0,5; Mark : Bone = 2;": "1=0.5,2:1=2.0",
                "Muscle, left : background = 1": "3:0=1.0", "A : B=1": "4=1.0", "T=37 = 1": "5=1.0", "Bone : A : B = 1": "1:4=1.0"}.items():
            self.assertEqual(parseInterfaceSizes(text, segments), expected)
        for text in ("Bone", "=1", "Skin=1", "Bone : Skin = 1", "Bone = 0", "Bone ="):
            with self.assertRaisesRegex(MeshingError, "is not the size of an interface: write NAME = LENGTH"):
                parseInterfaceSizes(text, segments)
        # Labels are those of the segments that are meshed.
        parameters = commandParameters([replace(SEGMENTS[0], mesh=False), *SEGMENTS[1:]], Settings(interfaceSizes="Mark = 1"))
        self.assertEqual(parameters["interfaceSizes"], "1=1.0")

    def test_figures_of_quality(self):
        shapes = {"smallestDihedralAngle": "15.04", "largestDihedralAngle": "154.96", "largestRadiusEdge": "2.413",
                  "smallestFacetAngle": "30.02", "missingComponents": "0"}
        self.assertEqual(describeQuality(shapes), ["Dihedral angles from 15.0 to 155.0 degrees, radius-edge ratio at most 2.41, "
                                                   "angles of triangles from 30.0 degrees"])
        compared = {**shapes, "hausdorffDistance": "1.2345", "nonManifoldEdges": "2", "volumeError": "0.0151"}
        self.assertEqual(describeQuality(compared)[1:], ["Hausdorff distance 1.23 mm, 2 non-manifold edges, volumes of segments "
                                                         "off by up to 1.5 %"])
        self.assertEqual(describeQuality({}), [])
        self.assertEqual(describeQuality({"smallestDihedralAngle": ""}), [])

    def test_parameters_are_those_of_the_cli_module(self):
        xml = subprocess.run([EXECUTABLE, "--xml"], capture_output=True, check=True).stdout
        known = {p.findtext("name"): p for g in ElementTree.fromstring(xml).findall("parameters") for p in g}
        parameters = commandParameters(SEGMENTS, Settings())
        self.assertLessEqual(set(parameters), set(known))
        # The defaults agree, too.
        for field in fields(Settings):
            default = known[field.name].findtext("default") or ""
            value = getattr(Settings(), field.name)
            self.assertEqual(value, default == "true" if isinstance(value, bool) else type(value)(default), field.name)

    def test_what_does_not_do(self):
        with self.assertRaisesRegex(MeshingError, "No segment is chosen"):
            commandParameters([replace(segment, mesh=False) for segment in SEGMENTS], Settings())
        with self.assertRaisesRegex(MeshingError, "Delta must be 0 or more"):
            commandParameters(SEGMENTS, Settings(delta=-1.0))
        with self.assertRaisesRegex(MeshingError, "Size must be 0 or more"):
            commandParameters(SEGMENTS, Settings(size=float("nan")))
        with self.assertRaisesRegex(MeshingError, "Elements must be 0 or more"):
            commandParameters(SEGMENTS, Settings(elements=-5))


class Runs(ModuleTestCase):
    def setUp(self):
        super().setUp()
        array = images.two_labels(lower=1, upper=2)
        self.array = array
        images.write_nrrd(self.folder / "labels.nrrd", array)
        self.segments = SEGMENTS[:2]
        self.lines, self.states = [], []
        self.logic = MeshingLogic(ProcessRunner(self.folder), self.lines.append, self.states.append)

    def test_mesh(self):
        self.logic.start(self.segments, Settings(delta=2.0))
        phases = [state.phase for state in self.states]
        self.assertEqual((phases[0], phases[-1]), (Phase.RUNNING, Phase.COMPLETED))
        progress = [state.progress for state in self.states]
        self.assertEqual((progress, progress[-1]), (sorted(progress), 1.0))
        self.assertGreater(len(set(progress)), 3)
        self.assertFalse(self.logic.isBusy)
        self.assertEqual(self.lines, ["Meshing Bone, Mark"])
        mesh = self.logic.runner.mesh()
        figures = {f.label: f for f in measureLabels(mesh)}
        for label in (1, 2):
            self.assertAlmostEqual(figures[label].volume / (self.array == label).sum(), 1.0, delta=0.08)
        self.assertEqual(sum(f.elements for f in figures.values()), mesh.GetNumberOfCells())
        lines = describeMesh(mesh, self.segments)
        self.assertEqual(lines[0], "%d tetrahedra with %d nodes" % (mesh.GetNumberOfCells(), mesh.GetNumberOfPoints()))
        self.assertRegex(lines[1], "^  Bone: %d tetrahedra, " % figures[1].elements)
        self.assertRegex(lines[2], "^  Mark: %d tetrahedra, " % figures[2].elements)

    def test_settings_and_sizes_arrive(self):
        def count(segments, **settings):
            self.logic.start(segments, Settings(threads=1, **settings))
            return self.logic.runner.mesh().GetNumberOfCells()
        plain = count(self.segments, delta=3.0)
        self.assertGreater(count(self.segments, delta=2.0), 1.5 * plain)
        self.assertGreater(count(self.segments, delta=3.0, size=1.5), 1.5 * plain)
        self.assertGreater(count([replace(self.segments[0], size=1.5), self.segments[1]], delta=3.0), 1.2 * plain)

    def test_names_and_colours(self):
        self.logic.start(self.segments, Settings(delta=3.0))
        mesh = self.logic.runner.mesh()
        for _ in range(2):  # a second time replaces the first
            labelMesh(mesh, self.segments)
        data = mesh.GetFieldData()
        self.assertEqual([data.GetAbstractArray("LabelNames").GetValue(i) for i in range(2)], ["Bone", "Mark"])
        self.assertEqual([data.GetArray("LabelValues").GetValue(i) for i in range(2)], [1, 2])
        self.assertEqual(data.GetArray("LabelColors").GetTuple3(1), (0.8, 0.1, 0.1))
        self.assertEqual(data.GetAbstractArray("LabelNames").GetNumberOfValues(), 2)

    def test_lost_segment_is_named(self):
        n = self.array.shape[0] // 2
        self.array[n, n, n] = 3  # one voxel beside an interface
        images.write_nrrd(self.folder / "labels.nrrd", self.array)
        self.logic.start(SEGMENTS, Settings(delta=3.0, smallestComponent=0))
        self.assertEqual(self.logic.state.phase, Phase.COMPLETED)
        self.assertTrue(any("The mesh lacks these labels" in line for line in self.lines), self.lines)
        self.assertIn("  Muscle, left: none; it is too small for this delta",
                      describeMesh(self.logic.runner.mesh(), SEGMENTS))

    def test_failure(self):
        self.logic.start(self.segments, Settings(radiusEdge=1.2))
        self.assertEqual(self.logic.state.phase, Phase.FAILED)
        self.assertRegex(self.lines[-1], "^Failed: SegmentationToTetMesh: cannot mesh .*--force")
        self.assertFalse(self.logic.isBusy)
        self.logic.start(self.segments, Settings())  # and again
        self.assertEqual(self.logic.state.phase, Phase.COMPLETED)

    def test_cancel(self):
        images.write_nrrd(self.folder / "labels.nrrd", images.ball(64, 28.0))
        phases = []

        def onChange(state):
            phases.append(state.phase)
            if state.progress > 0.1:
                self.logic.cancel()
        self.logic.onChange = onChange
        self.logic.start(self.segments, Settings(delta=0.05, force=True))
        self.assertEqual((phases[0], phases[-2:]), (Phase.RUNNING, [Phase.CANCELLING, Phase.CANCELLED]))
        self.assertEqual(self.lines[-1], "Cancelled")
        self.assertEqual(set(self.contents()), {"labels.nrrd"})
        self.logic.cancel()  # no run: nothing happens
        self.assertEqual(phases[-1], Phase.CANCELLED)

    def test_one_run_at_a_time(self):
        class Endless:
            def start(self, parameters, onChange):
                self.onChange = onChange

            def cancel(self):
                pass
        logic = MeshingLogic(Endless())
        logic.start(self.segments, Settings())
        with self.assertRaisesRegex(MeshingError, "wait for it, or cancel it"):
            logic.start(self.segments, Settings())
        logic.runner.onChange(RunState(Phase.COMPLETED, 1.0))
        logic.runner.onChange(RunState(Phase.RUNNING, 0.5))  # an echo
        self.assertEqual(logic.state.phase, Phase.COMPLETED)

    def test_runner_that_cannot_start(self):
        class Broken:
            def start(self, parameters, onChange):
                raise MeshingError("no module")
        logic = MeshingLogic(Broken(), self.lines.append)
        with self.assertRaisesRegex(MeshingError, "no module"):
            logic.start(self.segments, Settings())
        self.assertEqual((logic.state.phase, self.lines[-1]), (Phase.FAILED, "Failed: no module"))

    def test_nothing_to_measure(self):
        for mesh in (None, vtkUnstructuredGrid()):
            with self.assertRaisesRegex(MeshingError, "made no tetrahedra"):
                measureLabels(mesh)

    @unittest.skipUnless(os.environ.get("VOXPLEX_HAVE_PYTHON"), "the Python package was not built")
    def test_same_mesh_from_the_filter(self):
        """One runner is as good as the other."""
        settings = Settings(delta=2.5, smoothing=0.5, radiusEdge=2.1, facetAngle=25.0, sliverAngle=7.0, gradation=0.5,
                            grading="lfs", featureRatio=0.8, largestFeature=9.0, junctions="off", interfaceRounds=1,
                            smallestComponent=3, minimumVolume=1.5, optimise="off", threads=1)
        segments = [replace(self.segments[0], size=2.0), self.segments[1]]
        self.logic.start(segments, settings)
        other = MeshingLogic(FilterRunner(self.array))
        other.start(segments, settings)
        self.assertEqual(other.state.phase, Phase.COMPLETED)
        self.assertEqual(measureLabels(self.logic.runner.mesh()), measureLabels(other.runner.mesh()))


if __name__ == "__main__":
    unittest.main(verbosity=2)
