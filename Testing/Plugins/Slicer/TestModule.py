#!/usr/bin/python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""The program as a CLI module: its description, and runs as 3D Slicer starts them. TestMRML has Slicer itself do both."""
import json
import os
import re
import subprocess
import sys
import unittest
from pathlib import Path
from xml.etree import ElementTree

import numpy as np

import images
import meshfiles
from program import PROGRAM, ProgramTestCase, without_topology

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "Plugins" / "Slicer" / "VoxplexMesher"))
from VoxplexMesherLib.Logic import TABLE  # noqa: E402

# One filter's report; Slicer removes from the output what looks like this.
FILTER = re.compile("<filter-start>\n<filter-name>(\\w+)</filter-name>\n<filter-comment> \"\\1\" </filter-comment>\n</filter-start>\n"
                    "((?:<filter-progress>[0-9.e-]+</filter-progress>\n)+)"
                    "<filter-end>\n<filter-name>\\1</filter-name>\n<filter-time>[0-9.e+-]+</filter-time>\n</filter-end>\n")


class Module(ProgramTestCase):
    def setUp(self):
        super().setUp()
        self.array = images.two_labels()
        self.input = images.write_nrrd(self.folder / "two.nrrd", self.array)
        xml = subprocess.run([PROGRAM, "--xml"], capture_output=True, check=True).stdout
        self.description = {p.findtext("name"): p for p in ElementTree.fromstring(xml).iterfind("parameters/*[name]")}

    def words(self, values):
        """As vtkSlicerCLIModuleLogic: every number and word, a flag if it is true, a list, text or file if there is one."""
        left = set(values)
        words, places = ["--returnparameterfile", "results.params"], {}
        for name, p in self.description.items():
            value = values.get(name, p.findtext("default") or "")
            left.discard(name)
            if p.find("index") is not None:
                places[int(p.findtext("index"))] = value
            elif p.tag == "boolean":
                words += [p.findtext("longflag")] * (value == "true")
            elif p.find("longflag") is not None and (value or not re.search("string$|vector|table|geometry", p.tag)):
                words += [p.findtext("longflag"), value]
        self.assertEqual(left, set())
        return words + [places[index] for index in range(len(places))]

    def run_module(self, outcome=0, **values):
        return self.check(outcome, self.call(*self.words({"inputLabels": "two.nrrd", "outputMesh": "mesh.vtu", **values})))

    def check(self, outcome, done):
        """The results, or, if it fails, the message."""
        self.assertEqual(done.returncode, outcome, done.stderr)
        self.output = done.stdout
        if outcome:
            self.assertRegex(done.stderr, "^voxplex: [^\n]*\n$")
            return done.stderr
        self.assertEqual(without_topology(done.stderr), "")
        lines = (self.folder / "results.params").read_text().splitlines()
        return dict(re.fullmatch("([A-Za-z]+) = (.*)", line).groups() for line in lines)

    def tetrahedra(self, name="mesh.vtu"):
        return meshfiles.read_tetrahedra(self.folder / name)

    def test_every_parameter_of_the_table(self):
        """Where Slicer has a name for it: with the program's own option, which may have underscores."""
        for row in (row for row in TABLE if row["option"]):
            isOn = row["default"] == "on"
            p = self.description["no" + row["slicer"][0].upper() + row["slicer"][1:] if isOn else row["slicer"]]
            self.assertEqual(p.findtext("longflag"), "--" + row["option"].replace("-", "_"))
            self.assertTrue(p.findtext("label").startswith(row["label"]) and p.findtext("description").endswith("."))
            self.assertEqual([e.text for e in p.findall("element")], row["words"])
            if p.tag in ("double", "integer", "string-enumeration"):
                self.assertEqual(p.findtext("default"), row["default"] or "0")
            if row["step"] and p.tag != "string":
                low, high, step = (float(e.text) for e in p.find("constraints"))
                self.assertEqual(([low, high], step), (row["usual"], row["step"]))
                self.assertTrue(low <= float(p.findtext("default")) <= high, row)
        flags = [p.findtext("longflag") for p in self.description.values() if p.find("longflag") is not None]
        self.assertEqual(len(flags), len(set(flags)))

    def test_what_is_left_as_it_is(self):
        results = self.run_module(threads="1")
        self.call("--threads", 1, "two.nrrd", "plain.vtu")
        np.testing.assert_array_equal(self.tetrahedra().cells, self.tetrahedra("plain.vtu").cells)
        returned = {name for name, p in self.description.items() if p.findtext("channel") == "output" and p.tag != "geometry"}
        self.assertEqual(set(results) | {"hausdorffDistance", "nonManifoldEdges", "volumeError"}, returned)
        self.assertEqual((results["numberOfTetrahedra"], results["missingLabels"], results["missingComponents"]),
                         (str(len(self.tetrahedra().cells)), "", "0"))
        self.assertTrue(12 < float(results["smallestDihedralAngle"]) < 70.5 < float(results["largestDihedralAngle"]) < 160)

    def test_other_values(self):
        """Of each kind; lists have blanks as Slicer makes them of Python's."""
        self.array[11, 11, 11] = 0
        images.write_nrrd(self.input, self.array)
        (self.folder / "names.ctbl").write_text("# Color table file\n3 Femur 255 0 0 255\n7 Tibia 0 51 255 255\n")
        results = self.run_module(
            colorTable="names.ctbl", outputSurfaces="surfaces.vtp", space="ras", quality="true", delta="1", grading="lfs",
            labels="3, Tibia", labelSizes="Femur=3, 7=2.5", interfaceSizes="3,7=1.5,7,0=2", noOptimise="true", noJunctions="true",
            smoothing="0.5", fillHoles="1", minimumThickness="3=2,7=2", shells="3=-1.5, 7=2", threads="1")
        reports = FILTER.findall(self.output)
        self.assertEqual([name for name, _ in reports], ["Repairing", "Meshing", "Measuring"])
        fractions = [float(value) for value in re.findall("<filter-progress>(.+)<", reports[1][1])]
        self.assertEqual(fractions, sorted(set(fractions)))
        text = FILTER.sub("", self.output)
        self.assertRegex(text, r"^[\d,]+ tetrahedra in 4 labels, [^<]*\nfill-holes: [^<]*shell: label 7 \(Tibia\): [^<]*$")
        options = ("--label-table", "names.ctbl", "--space", "ras", "--delta", 1, "--grading", "lfs", "--labels", "3,7", "--label-size",
                   "Femur=3", "--label-size", "7=2.5", "--interface-size", "3,7=1.5", "--interface-size", "7,0=2", "--no-optimise",
                   "--no-junctions", "--smoothing", 0.5, "--fill-holes", 1, "--min-thickness", "3=2", "--min-thickness", "7=2",
                   "--shell", "3=-1.5", "--shell", "7=2", "--threads", 1)
        self.call(*options, "two.nrrd", "plain.vtu", "--stats", "plain.json", "--hausdorff")
        mesh = self.tetrahedra()
        np.testing.assert_array_equal(mesh.cells, self.tetrahedra("plain.vtu").cells)
        self.assertEqual((mesh.space, meshfiles.read_triangles(self.folder / "surfaces.vtp").space), ("RAS", "RAS"))
        figures = json.loads((self.folder / "plain.json").read_text())
        self.assertAlmostEqual(float(results["hausdorffDistance"]), figures["hausdorff"]["voxels"]["distance"])
        self.assertAlmostEqual(float(results["volumeError"]), max(abs(one["volume_error"]) for one in figures["labels"].values()))
        self.assertEqual(results["nonManifoldEdges"], "0")

    def test_lost_labels(self):
        self.array[12, 12, 12] = 9
        images.write_nrrd(self.input, self.array)
        done = self.call(*self.words({"inputLabels": "two.nrrd", "outputMesh": "mesh.vtu", "delta": "3", "smallestComponent": "0"}))
        self.assertIn("missingLabels = 9\n", (self.folder / "results.params").read_text())
        self.assertRegex(done.stderr, "^voxplex: warning: The mesh lacks these labels .*: 9\\.\n$")

    def test_isosurface(self):
        images.write_nrrd(self.input, np.linalg.norm(np.mgrid[:24, :24, :24] - 11.5, axis=0).astype(np.float32))
        self.assertRegex(self.run_module(1), "mesh an isosurface of it with Isovalue")
        self.assertRegex(self.run_module(2, isovalue="0", fillHoles="1"), "grey-value images have no labels")
        for smoothing in ("", "1"):
            self.run_module(isovalue="8", inside="below", insideLabel="4", smoothing=smoothing, threads="1")
            self.call("--isovalue", 8, "--inside", "below", "--inside-label", 4, "--threads", 1, "two.nrrd", "plain.vtu",
                      *["--smoothing", smoothing] * bool(smoothing))
            np.testing.assert_array_equal(self.tetrahedra().points, self.tetrahedra("plain.vtu").points)
            self.assertEqual(set(self.tetrahedra().labels), {4})

    def test_messages(self):
        """In the words of the panel that Slicer makes of the description; no file is left."""
        before = self.contents()
        for outcome, pattern, values in (
                (2, "Delta: 'x' is not a number", {"delta": "x"}),
                (2, "Delta and Number of elements do not go together", {"delta": "1", "elements": "9"}),
                (2, "Feature ratio: only for interfaces that are graded", {"featureRatio": "2"}),
                (2, "Largest element of labels: '4' is not of the form", {"labelSizes": "3=1,4"}),
                (2, "Interface sizes: '7,3' is given twice", {"interfaceSizes": "3,7=1,7,3=1"}),
                (2, "Time for optimising limits what Optimise switches off", {"noOptimise": "true", "optimiseSeconds": "3"}),
                (2, "Sliver angle: above 15 .*; give Force", {"sliverAngle": "16"}),
                (1, "Label 5 was asked for.* Correct Labels", {"labels": "5"}),
                (1, "Shells: the image has no label 5; it has 3, 7", {"shells": "5=1"}),
                (3, "'no.nrrd': there is no such file", {"inputLabels": "no.nrrd"}),
                (3, "it is the input", {"outputMesh": "link.vtu"})):
            if "outputMesh" in values:
                (self.folder / "link.vtu").symlink_to(self.input)
                before = self.contents()
            with self.subTest(values):
                self.assertRegex(self.run_module(outcome, **values), pattern)
                self.assertEqual(self.contents(), before)

    def test_installed_name(self):
        """The module is a link, from which the program finds its own folder."""
        module = Path(os.environ["VOXPLEX_SLICER_CLI"])
        self.assertTrue(module.is_symlink() and not os.readlink(module).startswith("/"))
        done = subprocess.run([module, *self.words({"inputLabels": "two.nrrd", "outputMesh": "mesh.vtu", "delta": "3"})],
                              cwd=self.folder, capture_output=True, text=True)
        self.check(0, done)


if __name__ == "__main__":
    unittest.main(verbosity=2)
