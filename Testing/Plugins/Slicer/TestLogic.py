#!/usr/bin/python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""The logic of the scripted module, without Slicer: with the program as a process."""
import json
import os
import re
import subprocess
import sys
import unittest
from dataclasses import replace
from pathlib import Path

from vtkmodules.vtkCommonDataModel import vtkUnstructuredGrid
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

import images
from program import PROGRAM, ProgramTestCase

MODULE = Path(__file__).resolve().parents[3] / "Plugins" / "Slicer" / "VoxplexMesher"
sys.path.insert(0, str(MODULE))
from VoxplexMesherLib.Logic import (DEFAULTS, PARAMETERS, SIZES, MeshingError, MeshingLogic, Phase, RunState, Segment, Settings,  # noqa: E402
                                    describeMesh, describeQuality, labelMesh, measureLabels,
                                    mergeChoices, parseInterfaceSizes, parseSize, programOptions, segmentsByLabel, setSize,
                                    storeChoices)

SEGMENTS = [Segment("s1", "Bone", (1.0, 0.9, 0.7)), Segment("s2", "Mark", (0.8, 0.1, 0.1)),
            Segment("s3", "Muscle, left", (0.5, 0.2, 0.2))]


def read(path):
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


class ProcessRunner:
    """Calls the program; waits for it in start()."""

    def __init__(self, folder):
        self.input, self.output, self.figures = folder / "labels.nrrd", folder / "mesh.vtu", folder / "figures.json"

    def start(self, options, onChange):
        self.process = subprocess.Popen([PROGRAM, "--input", self.input, "--output", self.output, "--stats", self.figures,
                                         "--progress", *options],
                                        stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        self.cancelled = False
        errors = ""
        for line in self.process.stderr:
            found = re.match("([0-9]+) % (.*)", line)
            if found:
                onChange(RunState(Phase.RUNNING, int(found[1]) / 100, found[2]))
            else:
                errors += line
        self.process.communicate()
        if self.cancelled:
            onChange(RunState(Phase.CANCELLED))
        elif self.process.returncode:
            onChange(RunState(Phase.FAILED, message=errors))
        else:
            onChange(RunState(Phase.COMPLETED, 1.0, warnings=errors, figures=json.loads(self.figures.read_text())))

    def cancel(self):
        self.cancelled = True
        self.process.kill()

    def mesh(self):
        return read(self.output)


class Choices(unittest.TestCase):
    def test_needs_no_slicer(self):
        code = "import sys; sys.path.insert(0, %r); import VoxplexMesherLib.Logic; " \
               "sys.exit(any(m in sys.modules for m in ('slicer', 'qt', 'ctk')))" % str(MODULE)
        environment = {**os.environ, "PYTHONPATH": ""}
        self.assertEqual(subprocess.run([sys.executable, "-B", "-c", code], env=environment).returncode, 0)

    def test_choices_are_stored_by_id(self):
        chosen = [replace(SEGMENTS[0], mesh=False), replace(SEGMENTS[1], sizes={"labelSizes": 1.5, "shells": -2.0}), SEGMENTS[2]]
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
        segment = Segment("s", "S", (1, 1, 1))
        setSize(segment, "shells", "-2,5")
        setSize(segment, "labelSizes", "3")
        setSize(segment, "labelSizes", "")
        self.assertEqual(segment.sizes, {"shells": -2.5})
        for name in set(SIZES) - {"shells"}:
            with self.assertRaisesRegex(MeshingError, "is not a size"):
                setSize(segment, name, "-1")

    def test_settings_as_texts(self):
        settings = Settings(delta=1.25, threads=3, force=True)
        texts = settings.toTexts()
        self.assertTrue(all(isinstance(text, str) for text in texts.values()))
        self.assertEqual((texts["delta"], texts["threads"], texts["force"]), ("1.25", "3", "true"))
        self.assertEqual(Settings.fromTexts(texts.get), settings)
        self.assertEqual(Settings.fromTexts(lambda name: ""), Settings())
        hand = Settings.fromTexts({"delta": "by hand", "smallestComponent": "eight"}.get)
        self.assertEqual((hand.delta, hand.smallestComponent), (0.0, 8))
        for text, isOn in (("on", True), ("true", True), ("off", False), ("false", False)):
            self.assertIs(Settings.fromTexts({"optimise": text}.get).optimise, isOn)

    def test_options(self):
        segments = [replace(SEGMENTS[0], mesh=False, sizes={"labelSizes": 9.0}), replace(SEGMENTS[1]),
                    replace(SEGMENTS[2], sizes={"labelSizes": 1.5, "minimumThickness": 2.0, "shells": -1.0})]
        options = programOptions(segments, Settings(delta=2.0, optimise=False, exactComponents=True))
        # The first is not meshed: the labels are 1 and 2.
        self.assertEqual(options[:3], ["--label-size=2=1.5", "--min-thickness=2=2.0", "--shell=2=-1.0"])
        self.assertLess({"--delta=2.0", "--no-optimise", "--exact-components", "--sliver-angle=9.0"}, set(options))

    def test_options_that_count(self):
        """What has no effect is not passed on, nor what stands for none."""
        def names(isosurface=False, **settings):
            return {option.partition("=")[0][2:] for option in programOptions(SEGMENTS, Settings(**settings), isosurface)}
        plain = names(delta=1.0, quality=True)
        self.assertEqual({"delta", "isovalue", "inside", "feature-ratio", "largest-feature", "hausdorff", "elements", "size",
                          "min-component-volume", "optimise-seconds", "no-optimise", "force"} & plain,
                         {"delta", "hausdorff"})
        self.assertEqual(names(delta=1.0, quality=True, grading="lfs") - plain, {"feature-ratio", "largest-feature"})
        self.assertEqual(plain ^ names(elements=9, delta=1.0), {"delta", "elements", "hausdorff"})
        self.assertEqual(names(isosurface=True, quality=True) ^ names(), {"isovalue", "inside"})
        self.assertIn("--isovalue=0.0", programOptions(SEGMENTS, Settings(), isosurface=True))
        self.assertIn("--smoothing=0.5", programOptions(SEGMENTS, Settings(greySmoothing=0.5), isosurface=True))

    def test_the_program_takes_every_option(self):
        """Each setting with another value than by default, within its range."""
        def other(name):
            default, parameter = DEFAULTS[name], PARAMETERS[name]
            if parameter["words"]:
                return parameter["words"][1]
            if isinstance(default, (bool, str)):
                return "Bone = 2" if default == "" else not default
            return default + (1 if default + 1 <= (parameter["range"][1] or 1e9) else -1)
        for name in PARAMETERS:
            settings = Settings(**{name: other(name)}, **({} if name == "grading" else {"grading": "lfs"}))
            for isosurface in (False, True):
                options = programOptions(SEGMENTS, settings, isosurface)
                done = subprocess.run([PROGRAM, "--input=/nonexistent.nrrd", "--output=mesh.vtu", *options],
                                      capture_output=True, text=True)
                self.assertEqual((done.returncode, "nonexistent" in done.stderr), (3, True), (options, done.stderr))

    def test_interface_sizes(self):
        segments = [*SEGMENTS, Segment("s4", "A : B", (0, 0, 1)), Segment("s5", "T=37", (0, 1, 1))]
        for text, expected in {
                "": "", " ; ": "", "Bone=0.5": "1=0.5", "Bone = 0,5; Mark : Bone = 2;": "1=0.5 2,1=2.0",
                "Muscle, left : background = 1": "3,0=1.0", "A : B=1": "4=1.0", "T=37 = 1": "5=1.0", "Bone : A : B = 1": "1,4=1.0"}.items():
            self.assertEqual(parseInterfaceSizes(text, segments), expected.split())
        for text in ("Bone", "=1", "Skin=1", "Bone : Skin = 1", "Bone = 0", "Bone ="):
            with self.assertRaisesRegex(MeshingError, "is not the size of an interface: write NAME = LENGTH"):
                parseInterfaceSizes(text, segments)
        # Labels are those of the segments that are meshed.
        options = programOptions([replace(SEGMENTS[0], mesh=False), *SEGMENTS[1:]], Settings(interfaceSizes="Mark = 1"))
        self.assertIn("--interface-size=1=1.0", options)

    def test_figures_of_quality(self):
        shapes = {"quality": {"min_dihedral": 15.04, "max_dihedral": 154.96, "max_radius_edge": 2.413, "min_planar": 30.02}}
        self.assertEqual(describeQuality(shapes), ["Dihedral angles from 15.0 to 155.0 degrees, radius-edge ratio at most 2.41, "
                                                   "angles of triangles from 30.0 degrees"])
        compared = {**shapes, "hausdorff": {"voxels": {"distance": 1.2345}}, "topology": {"non_manifold_edges": 2},
                    "labels": {"1": {"volume_error": 0.01}, "2": {"volume_error": -0.0151}}}
        self.assertEqual(describeQuality(compared)[1:], ["Hausdorff distance 1.23 mm, 2 non-manifold edges, volumes of segments "
                                                         "off by up to 1.5 %"])

    def test_what_does_not_do(self):
        with self.assertRaisesRegex(MeshingError, "No segment is chosen"):
            programOptions([replace(segment, mesh=False) for segment in SEGMENTS], Settings())
        with self.assertRaisesRegex(MeshingError, "Delta must be 0 or more"):
            programOptions(SEGMENTS, Settings(delta=-1.0))
        with self.assertRaisesRegex(MeshingError, "Size must be 0 or more"):
            programOptions(SEGMENTS, Settings(size=float("nan")))
        with self.assertRaisesRegex(MeshingError, "Elements must be 0 or more"):
            programOptions(SEGMENTS, Settings(elements=-5))


class Runs(ProgramTestCase):
    def setUp(self):
        super().setUp()
        array = images.two_labels(lower=1, upper=2)
        self.array = array
        images.write_nrrd(self.folder / "labels.nrrd", array)
        self.segments = SEGMENTS[:2]
        self.lines, self.states = [], []
        self.logic = MeshingLogic(ProcessRunner(self.folder), self.lines.append, self.states.append)

    def test_mesh(self):
        self.logic.start(self.segments, Settings(delta=0.6))
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
        lines = describeMesh(mesh, segmentsByLabel(self.segments, self.states[-1].figures))
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
        self.assertGreater(count([replace(self.segments[0], sizes={"labelSizes": 1.5}), self.segments[1]], delta=3.0), 1.2 * plain)

    def test_names_and_colours(self):
        self.logic.start(self.segments, Settings(delta=3.0))
        mesh = self.logic.runner.mesh()
        for _ in range(2):  # a second time replaces the first
            labelMesh(mesh, segmentsByLabel(self.segments, {}))
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
                      describeMesh(self.logic.runner.mesh(), segmentsByLabel(SEGMENTS, {})))

    def test_thickness_and_shells(self):
        """A shell is a label of its own, with the name of what it is around, and a brighter colour."""
        self.array[6, 6, 6] = 3
        images.write_nrrd(self.folder / "labels.nrrd", self.array)
        segments = [replace(SEGMENTS[0], sizes={"shells": 2.0}), replace(SEGMENTS[1], sizes={"shells": -1.5}),
                    replace(SEGMENTS[2], sizes={"minimumThickness": 3.0})]
        self.logic.start(segments, Settings(delta=1.5))
        labels = segmentsByLabel(segments, self.states[-1].figures)
        self.assertEqual([segment.name for segment in labels.values()],
                         ["Bone", "Mark", "Muscle, left", "Bone shell", "Mark shell"])
        self.assertEqual(labels[5].color, (0.9, 0.55, 0.55))
        mesh = self.logic.runner.mesh()
        lines = describeMesh(mesh, labels)
        for line, segment in zip(lines[1:], labels.values()):
            self.assertRegex(line, "^  %s: [0-9]+ tetrahedra" % segment.name)
        self.assertGreater(measureLabels(mesh)[2].volume, 8)  # of one voxel

    def test_failure(self):
        self.logic.start(self.segments, Settings(radiusEdge=1.2))
        self.assertEqual(self.logic.state.phase, Phase.FAILED)
        self.assertRegex(self.lines[-1], "^Failed: voxplex: --radius-edge: .*--force")
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
        self.assertEqual(set(self.contents()), {Path("labels.nrrd")})
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


if __name__ == "__main__":
    unittest.main(verbosity=2)
