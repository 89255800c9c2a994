#!/usr/bin/python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""The module as a process of its own, which is how Slicer prefers to run it."""
import re
import signal
import subprocess
import time
import unittest

import numpy as np
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

import images
import meshfiles
from module import EXECUTABLE, ModuleTestCase, parse_parameter_file

NUMBER = "[0-9.e+-]+"
# One filter's report; Slicer removes from the output what looks like this.
FILTER = re.compile(
    "<filter-start>\n<filter-name>([A-Za-z]+)</filter-name>\n"
    "<filter-comment> \"([^<\"]+)\" </filter-comment>\n</filter-start>\n((?:<filter-progress>%s</filter-progress>\n)+)"
    "<filter-end>\n<filter-name>([A-Za-z]+)</filter-name>\n<filter-time>%s</filter-time>\n</filter-end>\n" % (NUMBER, NUMBER))


class Runs(ModuleTestCase):
    def setUp(self):
        super().setUp()
        self.geometry = images.Geometry(origin=(10.0, -20.0, 5.0), spacing=(1.0, 1.25, 0.75),
                                        direction=np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]))
        self.array = images.two_labels()
        self.input = images.write_nrrd(self.folder / "two.nrrd", self.array, self.geometry)

    def mesh(self, *arguments, name="mesh.vtu"):
        self.run_module(*arguments, self.input, name)
        return meshfiles.read_tetrahedra(self.folder / name)

    def test_mesh_and_interfaces(self):
        mesh = self.mesh("--delta", 2, "--plc", "surfaces.vtp")
        volume = self.geometry.voxel_volume()
        for label in (3, 7):
            self.assertAlmostEqual(mesh.volume_of_label()[label] / ((self.array == label).sum() * volume), 1, delta=0.08)
        middle = self.geometry.physical(np.full(3, 11.5))
        np.testing.assert_allclose((mesh.points.min(axis=0) + mesh.points.max(axis=0)) / 2, middle, atol=0.8)
        surfaces = meshfiles.read_triangles(self.folder / "surfaces.vtp")
        self.assertEqual({tuple(pair) for pair in surfaces.labels}, {(3, 0), (7, 0), (7, 3)})
        self.assertEqual((mesh.space, surfaces.space), ("LPS", "LPS"))

    def test_repair(self):
        """Holes, thickness, shells; what is done is told, and the mesh is that of the repaired image."""
        array = self.array.copy()
        array[11, 11, 11] = 0
        images.write_nrrd(self.folder / "two.nrrd", array, self.geometry)
        told = self.run_module("--fill_holes", 1, "--remove_spikes", "--min_thickness", "3=2,7=2", "--shell", "3=-1.5,7=2",
                               "--check_image", "--delta", 2, "--quality", self.input, "mesh.vtu")
        self.assertRegex(told, r"\nfill-holes: label \d: 1 voxel, at \(11, 11, 11\)\n")
        self.assertRegex(told, r"\nshell: label 3: \d+ voxels became label 8,.*\nshell: label 7: \d+ voxels became label 9,")
        mesh = meshfiles.read_tetrahedra(self.folder / "mesh.vtu")
        self.assertEqual(set(mesh.labels), {3, 7, 8, 9})
        self.assert_refused(1, "Shells: the image has no label 5; it has 3, 7", "--shell", "5=1", self.input, "other.vtu")
        self.assert_refused(2, "grey-value images have no labels", "--fill_holes", 1, "--isovalue", 2, self.input, "other.vtu")

    def test_space(self):
        lps = self.mesh("--threads", 1)
        ras = self.mesh("--threads", 1, "--space", "ras", "--plc", "ras.vtp", name="ras.vtu")
        self.assertEqual((ras.space, meshfiles.read_triangles(self.folder / "ras.vtp").space), ("RAS", "RAS"))
        # The extents agree, apart from the signs; the triangulation need not.
        low, high = ras.points.min(axis=0), ras.points.max(axis=0)
        signs = np.array([-1.0, -1.0, 1.0])
        np.testing.assert_allclose(np.sort([signs * low, signs * high], axis=0),
                                   [lps.points.min(axis=0), lps.points.max(axis=0)], atol=0.5)

    def test_format_of_two_files(self):
        self.run_module("--delta", 3, self.input, "mesh.xdmf")
        self.assertIn(b">mesh.h5:/mesh/topology<", (self.folder / "mesh.xdmf").read_bytes())
        self.assertTrue((self.folder / "mesh.h5").read_bytes().startswith(b"\x89HDF"))

    def test_legacy_file_says_its_space_in_the_header(self):
        """Slicer reads the coordinate system of .vtk files from the second line."""
        for space in ("lps", "ras"):
            self.run_module("--space", space, "--plc", "s.vtk", self.input, "mesh.vtk")
            for name in ("mesh.vtk", "s.vtk"):
                header = (self.folder / name).read_bytes().split(b"\n")[1]
                self.assertIn(b"SPACE=" + space.upper().encode(), header)

    def names_and_colours(self, path):
        data = meshfiles._read(vtkXMLUnstructuredGridReader(), str(path))
        values, colours = (data.GetFieldData().GetArray("Label" + what) for what in ("Values", "Colors"))
        names = meshfiles.texts_of(data, "LabelNames")
        return {values.GetValue(i): (names[i], tuple(np.round(colours.GetTuple3(i), 3)))
                for i in range(values.GetNumberOfValues())}

    def test_names_of_a_segmentation(self):
        """Slicer's own files say which segment a label is."""
        images.write_nrrd(self.folder / "two.seg.nrrd", self.array, self.geometry, key_values={
            "Segment0_ID": "s0", "Segment0_Name": "Femur, left", "Segment0_LabelValue": "3", "Segment0_Layer": "0",
            "Segment0_Color": "0.5 0.25 1", "Segment1_ID": "s1", "Segment1_Name": "Müll", "Segment1_LabelValue": "7",
            "Segment1_Layer": "0", "Segment1_Color": "0 1 0.75"})
        self.run_module("two.seg.nrrd", "mesh.vtu")
        self.assertEqual(self.names_and_colours(self.folder / "mesh.vtu"),
                         {3: ("Femur, left", (0.5, 0.25, 1.0)), 7: ("Müll", (0.0, 1.0, 0.75))})

    def test_values_of_flags_and_names_with_colons(self):
        images.write_nrrd(self.folder / "two.seg.nrrd", self.array, self.geometry, key_values={
            "Segment0_ID": "s0", "Segment0_Name": "A:B", "Segment0_LabelValue": "3", "Segment0_Layer": "0"})
        sizes = []
        for flags in ((), ("--exact_components=false",), ("--exact_components=true",), ("--exact_components",),
                      ("--label_size", "A:B=1.5"), ("--label_size", "3=1.5")):
            self.run_module("two.seg.nrrd", "mesh.vtu", "--delta", 3, "--threads", 1, *flags)
            sizes.append(len(meshfiles.read_tetrahedra(self.folder / "mesh.vtu").cells))
        self.assertEqual((sizes[1], sizes[3], sizes[5]), (sizes[0], sizes[2], sizes[4]))
        self.assertGreater(sizes[4], sizes[0])

    def test_colour_table(self):
        """As Slicer writes it for a colour node."""
        (self.folder / "names.ctbl").write_text("# Color table file\n# 3 values\n0 background 0 0 0 0\n"
                                                "3 Femur 255 0 0 255\n7 Tibia 0 51 255 255\n")
        self.mesh("--label_table", "names.ctbl")
        self.assertEqual(self.names_and_colours(self.folder / "mesh.vtu"),
                         {3: ("Femur", (1.0, 0.0, 0.0)), 7: ("Tibia", (0.0, 0.2, 1.0))})
        self.assert_refused(1, "'no.ctbl'", "--label_table", "no.ctbl", self.input, "other.vtu")

    def test_isosurface(self):
        images.write_nrrd(self.input, np.linalg.norm(np.mgrid[:24, :24, :24] - 11.5, axis=0).astype(np.float32))
        self.assert_refused(1, "mesh an isosurface of it with Isovalue", self.input, "mesh.vtu")
        self.assert_refused(2, "Inside: must be above or below", "--isovalue", 2, "--inside", "left", self.input, "mesh.vtu")
        self.assert_refused(2, "--hausdorff: .* a grey-value image has none", "--isovalue", 2, "--hausdorff", self.input, "mesh.vtu")

        def points(*arguments):
            return self.mesh("--threads", 1, "--inside", "below", "--isovalue", 8, *arguments).points
        plain = points()
        np.testing.assert_array_equal(points("--smoothing", 2, "--grey_smoothing", 0), plain)  # the first is about labels
        self.assertFalse(np.array_equal(points("--smoothing", 1, "--grey_smoothing", 1), plain))

    def test_progress(self):
        output = self.run_module("--delta", 0.7, "--fill_holes", 1, "--hausdorff", self.input, "mesh.vtu")
        reports = list(FILTER.finditer(output))
        for name, comment, _, end in (report.groups() for report in reports):
            self.assertEqual((comment, end), (name, name))
        self.assertEqual([report.group(1) for report in reports], ["Repairing", "Meshing", "Measuring"])
        fractions = [float(value) for value in re.findall("<filter-progress>(.*)<", reports[1].group(3))]
        self.assertEqual(fractions, sorted(set(fractions)))
        self.assertGreater(len(fractions), 3)
        self.assertTrue(fractions[0] >= 0 and fractions[-1] <= 1, fractions)
        self.assertRegex(FILTER.sub("", output), r"^[\d,]+ tetrahedra in 2 labels, [^<]*$")

    def test_results(self):
        mesh = self.mesh("--delta", 2.5, "--returnparameterfile", "results.params")
        results = parse_parameter_file(self.folder / "results.params")
        figures = {name: float(results.pop(name)) for name in ("smallestDihedralAngle", "largestDihedralAngle",
                                                              "largestRadiusEdge", "smallestFacetAngle")}
        self.assertEqual(results, {"numberOfTetrahedra": str(len(mesh.cells)), "usedDelta": "2.5", "missingLabels": "",
                                   "missingComponents": "0"})
        self.assertEqual(set(self.contents()), {"two.nrrd", "mesh.vtu", "results.params"})
        self.assertTrue(12 < figures["smallestDihedralAngle"] < 70.5 < figures["largestDihedralAngle"] < 160, figures)
        self.assertTrue(0.612 < figures["largestRadiusEdge"] < 2.5 and 20 < figures["smallestFacetAngle"] <= 60, figures)

    def test_comparison_with_the_label_map(self):
        def compare(*arguments):
            self.run_module("--hausdorff", "--threads", 1, *arguments, "--returnparameterfile", "results.params", self.input,
                            "mesh.vtu")
            return parse_parameter_file(self.folder / "results.params")
        fine, coarse = compare("--delta", 1), compare("--delta", 2, "--optimise", "off")
        self.assertTrue(0.2 < float(fine["hausdorffDistance"]) < 2, fine)
        self.assertGreater(float(coarse["volumeError"]), 1.5 * float(fine["volumeError"]))
        self.assertEqual(fine["nonManifoldEdges"], "0")
        # Labels that are not meshed are background of the label map, too.
        self.assertLess(float(compare("--delta", 1, "--labels", 7)["hausdorffDistance"]), 2)

    def test_labels_that_get_lost(self):
        n = self.array.shape[0] // 2
        self.array[n, n, n] = 9  # one voxel beside an interface
        images.write_nrrd(self.input, self.array, self.geometry)
        done = self.call("--delta", 3, "--smallest_component", 0, "--returnparameterfile", "results.params", self.input,
                         "mesh.vtu")
        self.assertEqual(done.returncode, 0)
        self.assertEqual(parse_parameter_file(self.folder / "results.params")["missingLabels"], "9")
        self.assertRegex(done.stderr, "^voxplex: warning: The mesh lacks these labels .*: 9\\.\n$")

    def test_spacing_that_the_file_lacks(self):
        """The module has no flag for it: Slicer's own modules set it."""
        path = images.write_nrrd(self.folder / "plain.nrrd", self.array, header_lines={
            "space": None, "space directions": None, "space origin": None})
        done = self.call("--delta", 3, path, "mesh.vtu")
        self.assertEqual(done.returncode, 0)
        self.assertRegex(done.stderr, "^voxplex: warning: .*plain.nrrd: .*no spacing of the voxels.* 1; set it "
                         "with 3D Slicer's module Volumes\n$")

    def test_labels_that_are_thin(self):
        z, y, x = np.meshgrid(*3 * [np.arange(32)], indexing="ij")
        array = np.where(np.hypot(np.hypot(x - 18, y - 18), z - 22) < 8, 4, 0)
        array[(z >= 8) & (z < 10) & (np.hypot(x - 16, y - 16) < 14)] = 9
        images.write_nrrd(self.input, array.astype(np.uint8))
        done = self.call("--delta", 10, "--threads", 1, self.input, "mesh.vtu")
        self.assertEqual(done.returncode, 0)
        self.assertRegex(done.stderr, r"^voxplex: warning: The mesh lacks a tenth or more of the volume of these labels, .*: "
                                      r".*9 \(\d+ %\).*\. Exact components or a smaller Delta keeps them\.\n")
        done = self.call("--delta", 10, "--threads", 1, "--exact_components", self.input, "mesh.vtu")
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_echo_help_and_version(self):
        """The command line of the program."""
        output = self.run_module("--echo", "--delta=3", "--elements", 0, "--labels", "3, 7", "--junctions", "off", "--optimise", "on",
                                 self.input, "mesh.vtu", "--interface_size", "3:7=1,7:0=2")
        self.assertEqual(output.split("\n")[0].split(), [
            "voxplex", "mesh", "--messages=slicer", "--progress", str(self.input), "mesh.vtu", "--delta=3", "--labels=3", "--labels=7",
            "--no-junctions", "--interface-size=3,7=1", "--interface-size=7,0=2"])
        self.assertIn("Usage: voxplex mesh IMAGE... MESH", self.run_module("--help"))
        self.assertRegex(self.run_module("--version", "--returnparameterfile", "r"), r"^voxplex \d+\.\d+\.\d+\n$")
        self.assertEqual(set(self.contents()), {"two.nrrd", "mesh.vtu"})


class Refusals(ModuleTestCase):
    def setUp(self):
        super().setUp()
        self.input = images.write_nrrd(self.folder / "ball.nrrd", images.ball())

    def test_command_lines(self):
        """In the words of the panel that an application makes of the description."""
        for pattern, arguments in {
                "which image": (), "option '--nonsense'": ("--nonsense", "a", "b"),
                "Delta: 'x' is not a number": ("--delta", "x", "a", "b.vtu"),
                "Delta: must be greater than 0": ("--delta=-1", "a", "b.vtu"),
                "Delta.* more than once": ("--delta", "1", "--delta", "2", "a", "b.vtu"),
                "Delta needs a value": ("a", "b.vtu", "--delta"),
                "Grading: must be uniform or lfs": ("--grading", "thin", "a", "b.vtu"),
                "Feature ratio: only for interfaces that are graded": ("--feature_ratio", "2", "a", "b.vtu"),
                "Labels: '0' is not a label": ("--labels", "1,0", "a", "b.vtu"),
                "Largest element of labels: '3' is not of the form": ("--label_size", "3", "a", "b.vtu"),
                "Interface sizes: '7,3' is given twice": ("--interface_size", "3:7=1,7:3=1", "a", "b.vtu"),
                "Delta and Number of elements do not go together": ("--delta", "1", "--elements", "9", "a", "b.vtu"),
                "'--no-optimise' does not take": ("--optimise", "yes", "a", "b.vtu"),
                "Time for optimising limits what Optimise switches off": ("--optimise", "off", "--optimise_seconds", "3", "a", "b.vtu"),
                "Sliver angle: above 15 .*; give Force": ("--sliver_angle", "16", "a", "b.vtu"),
                "--space: must be lps or ras": ("--space", "las", "a", "b.vtu"),
                "--plc: the format '.msh' is not known here; use .vtp": ("--plc", "s.msh", "ball.nrrd", "b.vtu")}.items():
            with self.subTest(arguments):
                self.assertEqual(self.assert_refused(2, pattern, *arguments).stdout, "")

    def test_files(self):
        images.write_nrrd(self.folder / "empty.nrrd", 0 * images.ball())
        (self.folder / "bad.nrrd").write_text("NRRD0004\n")
        for pattern, arguments in {
                "'no.nrrd': there is no such file": ("no.nrrd", "b.vtu"),
                "bad.nrrd": ("bad.nrrd", "b.vtu"),
                "no foreground|only background": ("empty.nrrd", "b.vtu"),
                "there is no folder 'no'": ("ball.nrrd", "no/b.vtu"),
                "Label 5 was asked for.* Correct Labels": ("--labels", "5", "ball.nrrd", "b.vtu"),
                "Largest element of labels .*5.* not occur": ("--label_size", "5=1", "ball.nrrd", "b.vtu"),
                "no delta makes a mesh of 3 elements .*ask for about that number": ("--elements", "3", "ball.nrrd", "b.vtu"),
                "every component of the image is smaller": ("--min_component_volume", "1e9", "ball.nrrd", "b.vtu"),
                "Force": ("--delta", "0.001", "ball.nrrd", "b.vtu")}.items():
            with self.subTest(arguments):
                self.assert_refused(1, pattern, *arguments)

    def test_the_input_is_not_overwritten(self):
        (self.folder / "link.vtu").symlink_to(self.input)
        self.assert_refused(1, "it is the input", "ball.nrrd", "link.vtu")

    def test_all_files_or_none(self):
        """The second output cannot be written: the first one, which is complete by then, does not appear."""
        (self.folder / "mesh.vtu").write_text("older")
        (self.folder / "s.vtp").mkdir()
        self.assert_refused(1, "'s.vtp': it is a folder", "--plc", "s.vtp", "ball.nrrd", "mesh.vtu")
        self.assertEqual((self.folder / "mesh.vtu").read_text(), "older")

    def test_full_disk(self):
        """Limited to 20 kB a file, while writing; all that is left is what was there before."""
        before = self.contents()
        done = subprocess.run(["bash", "-c", "ulimit -f 20; exec \"$@\"", "bash", EXECUTABLE, "--delta", "1", "ball.nrrd",
                               "mesh.vtu"], cwd=self.folder, capture_output=True, text=True, timeout=120)
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertRegex(done.stderr, "^voxplex: cannot write 'mesh.vtu': ")
        self.assertEqual(self.contents(), before)

    def test_interruption(self):
        """Ctrl-C while meshing; Slicer's cancel is a kill, which cannot leave more."""
        images.write_nrrd(self.input, images.ball(64, 28.0))
        for number, status in ((signal.SIGINT, 130), (signal.SIGKILL, -9)):
            before = self.contents()
            with subprocess.Popen([EXECUTABLE, "--delta", "0.05", "--force", "ball.nrrd", "mesh.vtu"], cwd=self.folder,
                                  stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                  preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL)) as process:
                while "Meshing" not in process.stdout.readline():
                    pass
                time.sleep(0.5)
                process.send_signal(number)
                process.communicate(timeout=30)
            self.assertEqual(process.returncode, status)
            self.assertEqual(self.contents(), before)


if __name__ == "__main__":
    unittest.main(verbosity=2)
