#!/usr/bin/python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""What the flags do: labels, sizes, statistics, help, progress."""
import json
import os
import pty
import subprocess

import numpy as np

import images
import meshfiles
from program import PROGRAM, ProgramTestCase, main, without_topology


class Options(ProgramTestCase):
    def setUp(self):
        super().setUp()
        self.array = images.two_labels()
        self.input = images.write_nrrd(self.folder / "two.nrrd", self.array)

    def test_chosen_labels_count_first(self):
        """Negative voxels are background then."""
        images.write_nrrd(self.folder / "chosen.nrrd", np.where(self.array == 0, -1024, self.array.astype(np.int32)))
        report = self.statistics("--input", "chosen.nrrd", "--labels", "3,7", "--delta", 2)
        self.assertEqual(set(report["labels"]), {"3", "7"})
        self.assert_refused(1, "-1024.* is negative.*with --isovalue.*choose the labels to mesh with --labels, if some are above 0",
                            "--input", "chosen.nrrd")

    def test_thousands_of_grains(self):
        """That regions of voxels are no grey values: Python.Mesh."""
        coarse = ("--delta", 6, "--no-optimise", "--no-manifold", "--smallest-component", 0)
        grey = np.random.default_rng(1).permutation(np.arange(1, 14**3 + 1, dtype=np.uint16))
        images.write_nrrd(self.input, grey.reshape(14, 14, 14))
        self.assert_refused(1, "2744 labels look like grey values.*with --labels.*or go on with --force",
                            "--input", self.input, *coarse)
        done = self.call("--input", self.input, "--output", "mesh.vtu", "--force", *coarse)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stderr, "The mesh lacks these labels")

    def test_sizes_below_the_floor_are_announced(self):
        done = self.call("--input", self.input, "--delta", 8, "--size", 0.01, "--stats", "s.json")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stderr, "^voxplex: warning: .*raised to 0.8.*--delta.*\n$")
        self.assertEqual(json.loads((self.folder / "s.json").read_text())["sizes_raised_to"], 0.8)
        self.assertEqual(self.statistics("--input", self.input, "--delta", 4)["sizes_raised_to"], 0)

    def test_broken_components_are_announced(self):
        """A vessel of 1 x 1 x 64 voxels."""
        array = np.zeros((72, 9, 9), dtype=np.uint8)
        array[4:68, 4, 4] = 1
        path = images.write_nrrd(self.folder / "vessel.nrrd", array)
        done = self.call("--input", path, "--delta", 1, "--quality", "--stats", "s.json")
        self.assertEqual(done.returncode, 0, done.stderr)
        report = json.loads((self.folder / "s.json").read_text())
        [broken] = report["broken_components"]
        self.assertEqual((broken["label"], broken["voxels"], broken["voxel"]), (1, 64, [4, 4, 4]))
        self.assertEqual(broken["fragments"], report["labels"]["1"]["fragments"])
        self.assertRegex(done.stderr, r"warning: Tetrahedra of these connected components of the image are in several pieces that "
                                      r"no common faces connect: 64 voxels of label 1 at \(i, j, k\) = \(4, 4, 4\) in %d\. --exact-components"
                         % broken["fragments"])
        self.assertRegex(done.stderr, r"a tenth or more of the volume of these labels, .*: 1 \(")
        done = self.call("--input", path, "--delta", 2, "--exact-components", "--quality", "--stats", "s.json")
        report = json.loads((self.folder / "s.json").read_text())
        self.assertEqual((report["broken_components"], report["labels"]["1"]["fragments"]), ([], 1))
        self.assertNotIn("pieces", done.stderr)

    def test_labels_that_are_lost_are_announced(self):
        n = self.array.shape[0] // 2
        self.array[n, n, n] = 5  # one voxel beside an interface
        images.write_nrrd(self.input, self.array)
        done = self.call("--input", self.input, "--delta", 4, "--smallest-component", 0, "--stats", "s.json")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stderr, "^voxplex: warning: The mesh lacks these labels .*--delta.*: 5\\.\n$")
        self.assertEqual(json.loads((self.folder / "s.json").read_text())["lost_labels"], [5])
        self.assertEqual(self.statistics("--input", self.input, "--delta", 4)["lost_labels"], [])

    def test_number_of_elements(self):
        for threads in 1, 4:
            report = self.statistics("--input", self.input, "--elements", 30000, "--threads", threads)
            self.assertLess(abs(report["elements"] / 30000 - 1), 0.1)
            self.assertEqual(report["elements_asked_for"], 30000)
            self.assertIn({"delta": report["delta"], "elements": report["elements"]}, report["runs"])
        done = self.mesh("--input", self.input, "--elements", 30000, "--output", "m.vtu")
        self.assertRegex(done.stdout, r"with delta [\d.]+ \(found in \d runs? for 30,000 elements\)\. ")
        report = self.statistics("--input", self.input, "--delta", 2)
        self.assertEqual((report["elements_asked_for"], report["runs"]), (None, []))

    def test_a_number_of_elements_out_of_reach(self):
        self.assert_refused(1, "no delta makes a mesh of 3000 elements within 10 %: the nearest of .* has .*; ask for about "
                            "that number, or for larger sizes",
                            "--input", self.input, "--size", 0.8, "--elements", 3000, "--output", "m.vtu")
        self.assertFalse((self.folder / "m.vtu").exists())

    def test_size_image_in_ras(self):
        """The image of sizes turns with the labels."""
        sizes = np.zeros(self.array.shape, dtype=np.float32)
        sizes[:, :, 12:] = 1.2
        images.write_nrrd(self.folder / "sizes.nrrd", sizes)
        self.mesh("--input", self.input, "--delta", 4, "--size-image", "sizes.nrrd", "--space", "ras",
                  "--output", "mesh.vtu")
        mesh = meshfiles.read_tetrahedra(self.folder / "mesh.vtu")
        right = (mesh.points[mesh.cells].mean(axis=1)[:, 0] < -12).sum()
        self.assertGreater(right, 2 * (len(mesh.cells) - right))

    def test_one_thread_is_reproducible(self):
        for name in ("a.mesh", "b.mesh"):
            self.mesh("--input", self.input, "--delta", 2, "--threads", 1, "--output", name)
        self.assertEqual((self.folder / "a.mesh").read_bytes(), (self.folder / "b.mesh").read_bytes())

    def test_radius_edge_below_the_proved_bound(self):
        self.assert_refused(2, "radius-edge.*--force", "--input", self.input, "--radius-edge", 1.9)
        report = self.statistics("--input", self.input, "--delta", 3, "--radius-edge", 1.9, "--force")
        self.assertTrue(report["parameters"]["force"])

    def test_interfaces(self):
        def run(*arguments):
            return self.statistics("--input", self.input, "--threads", 1, "--delta", 3, *arguments)["interfaces"]
        self.array[2, 2, 2] = 3  # a speck, far from everything else
        images.write_nrrd(self.input, self.array)
        default = run()
        self.assertGreater(default["junction_curves"], 0)
        self.assertGreater(default["junction_points"], 3)
        self.assertGreaterEqual(default["rounds"], 1)
        self.assertGreater(default["points"], 0)
        self.assertEqual(default["nonmanifold_edges_left"], 0)
        self.assertEqual(run("--no-junctions")["junction_points"], 0)
        self.assertEqual(run("--interface-rounds", 0)["rounds"], 0)

    def test_manifold(self):
        self.array[:] = np.random.RandomState(1).randint(0, 3, self.array.shape)
        images.write_nrrd(self.input, self.array)
        figures, edges = [], []
        for arguments in ((), ("--no-manifold",)):
            done = self.call("--input", self.input, "--threads", 1, "--delta", 3, "--smoothing", 0, "--interface-rounds", 0,
                             "--quality", "--stats", "statistics.json", *arguments)
            self.assertEqual((done.returncode, without_topology(done.stderr)), (0, ""))
            report = json.loads((self.folder / "statistics.json").read_text())
            self.assertEqual(report["parameters"]["no_manifold"], bool(arguments))
            figures.append(report["interfaces"])
            edges.append(report["topology"]["non_manifold_edges"])
        self.assertEqual((edges[0], figures[0]["nonmanifold_edges_left"]), (0, 0))
        self.assertGreater(figures[0]["nonmanifold_edges_opened"], 0)
        self.assertGreater(figures[0]["nonmanifold_edges_repaired"], figures[0]["nonmanifold_edges_opened"])
        self.assertGreater(edges[1], 0)
        self.assertEqual(figures[1]["nonmanifold_edges_repaired"], 0)

    def test_relative_and_absolute_names(self):
        (self.folder / "sub").mkdir()
        self.mesh("--input", "two.nrrd", "--delta", 3, "--output", "sub/mesh.vtu",
                  "--plc", self.folder / "sub" / "surface.vtp")
        self.assertEqual(sorted(os.listdir(self.folder / "sub")), ["mesh.vtu", "surface.vtp"])

    def test_equals_sign(self):
        self.mesh("--input=" + self.input, "--delta=3", "--output=mesh.vtu")

    def test_shapes(self):
        def run(*arguments):
            report = self.statistics("--input", self.input, "--threads", 1, "--delta", 1, *arguments)
            return report["quality"], report["optimisation"]
        sharp, figures = run("--sliver-angle", 0, "--no-optimise")
        self.assertLess(sharp["min_dihedral"], 4)
        self.assertFalse(figures["ran"])
        split, figures = run("--no-optimise")
        self.assertGreater(split["min_dihedral"], 4.6)
        self.assertLess(split["max_dihedral"], 171)
        self.assertLessEqual(split["max_radius_edge"], 2)
        best, figures = run()
        self.assertTrue(figures["ran"])
        self.assertFalse(figures["out_of_time"])
        self.assertGreater(best["min_dihedral"], 12)
        self.assertLess(best["max_dihedral"], 160)
        self.assertLessEqual(best["max_radius_edge"], 2.5)
        self.assertEqual(best["radius_edge_violations"], 0)
        self.assertAlmostEqual(figures["min_dihedral_after"], best["min_dihedral"], delta=1e-6)
        self.assertTrue(run("--optimise-seconds", 1e-9)[1]["out_of_time"])


class DataFiles(ProgramTestCase):
    def test_outside_of_the_folder(self):
        """Refused, unless the user trusts the header: that of the image and that of the image of sizes."""
        ball = images.ball(12, 4.0)
        (self.folder / "headers").mkdir()
        (self.folder / "ball.raw").write_bytes(ball.tobytes())
        header = images.write_nrrd(self.folder / "headers" / "ball.nhdr", ball,
                                   header_lines={"encoding": "raw", "data file": "../ball.raw"})
        words = r"the data file '\.\./ball\.raw', which is not in the folder of the header or below; .* --data-files-anywhere if"
        self.assert_refused(3, words, "--input", header, "--output", "mesh.vtu")
        self.mesh("--input", header, "--data-files-anywhere", "--delta", 2, "--output", "mesh.vtu")
        arguments = ("--input", images.write_nrrd(self.folder / "ball.nrrd", ball), "--delta", 2, "--size-image", header)
        self.assert_refused(3, words, *arguments)
        self.statistics(*arguments, "--data-files-anywhere")


class Quality(ProgramTestCase):
    def setUp(self):
        super().setUp()
        self.input = images.write_nrrd(self.folder / "two.nrrd", images.two_labels())

    def report(self, *arguments):
        done = self.call("--input", self.input, "--delta", 2, "--threads", 1, "--stats", "s.json", *arguments)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return done.stdout, json.loads((self.folder / "s.json").read_text())

    def test_quality(self):
        text, report = self.report("--quality")
        self.assertRegex(text, r"\nQuality:\n  dihedral angles in steps of 10 degrees, %:( \d+\.\d){18}\n")
        self.assertRegex(text, r"\n  \d+ junction edges, 0 corners; 0 non-manifold edges, 0 of them at junctions\n")
        self.assertIn("\n  0 labels and 0 of 2 components lost; volumes of labels off by", text)
        self.assertNotIn("Hausdorff", text)
        self.assertEqual(report["hausdorff"], {})
        self.assertGreater(report["topology"]["junction_edges"], 0)
        self.assertEqual(sum(report["quality"]["dihedral_histogram"]), 6 * report["elements"])
        for label in report["labels"].values():
            self.assertAlmostEqual(label["volume_error"], label["volume"] / label["image_volume"] - 1)
        self.assertEqual(report["image"]["lost_labels"], [])
        self.assertTrue(report["parameters"]["quality"])

    def test_hausdorff(self):
        text, report = self.report("--hausdorff")
        voxels, smooth = report["hausdorff"]["voxels"], report["hausdorff"]["smooth"]
        self.assertIn("Hausdorff distance to the faces of voxels: %.3f\n" % voxels["distance"], text)
        self.assertIn("Hausdorff distance to the smooth interface: %.3f\n" % smooth["distance"], text)
        self.assertEqual(voxels["distance"], max(voxels["mesh_to_image"]["max"], voxels["image_to_mesh"]["max"]))
        self.assertGreater(voxels["distance"], 0.2)
        self.assertLess(voxels["distance"], 3)

    def test_one_label(self):
        """What is not meshed is background of the image, too."""
        _, report = self.report("--hausdorff", "--labels", 3)
        self.assertEqual(list(report["labels"]), ["3"])
        self.assertEqual(report["image"]["lost_labels"], [])
        self.assertLess(report["hausdorff"]["voxels"]["distance"], 3)

    def test_isosurface(self):
        """Grey values are no labels: the mesh is measured without them."""
        z, y, x = np.mgrid[:24, :24, :24] - 11.5
        images.write_nrrd(self.folder / "two.nrrd", (100 * np.sqrt(x**2 + y**2 + z**2)).astype(np.float32))
        text, report = self.report("--isovalue", 800, "--inside", "below", "--quality")
        self.assertRegex(text, r"\n  0 junction edges, 0 corners; 0 non-manifold edges, 0 of them at junctions\n"
                         r"  fragments of labels that are connected through faces: 1\n$")
        self.assertEqual((report["image"], report["hausdorff"]), (None, {}))
        self.assertEqual(report["topology"]["non_manifold_edges"], 0)
        self.assertEqual(sum(report["quality"]["dihedral_histogram"]), 6 * report["elements"])

    def test_not_asked_for(self):
        text, report = self.report()
        self.assertNotIn("Quality:", text)
        for key in ("topology", "image", "hausdorff"):
            self.assertNotIn(key, report)


class Grading(ProgramTestCase):
    def test_figures(self):
        path = images.write_nrrd(self.folder / "two.nrrd", images.two_labels())
        plain, graded = (self.statistics("--input", path, "--delta", 1, *arguments) for arguments in (
            (), ("--grading", "lfs", "--feature-ratio", 0.4, "--largest-feature", 9)))
        self.assertEqual((plain["grading"]["samples"], plain["parameters"]["grading"]), (0, None))
        self.assertGreater(graded["grading"]["samples"], 0)
        self.assertGreater(graded["time"]["grading"], 0.0)
        parameters = graded["parameters"]
        self.assertEqual([parameters[key] for key in ("grading", "feature_ratio", "largest_feature")], ["lfs", 0.4, 9])


class Statistics(ProgramTestCase):
    def test_schema(self):
        path = images.write_nrrd(self.folder / "two.nrrd", images.two_labels())
        report = self.statistics("--input", path, "--delta", 2, "--threads", 1, "--output", "mesh.vtu",
                                 "--plc", "interfaces.vtp", "--label-size", "3=2.5")
        mesh = meshfiles.read_tetrahedra(self.folder / "mesh.vtu")
        surface = meshfiles.read_triangles(self.folder / "interfaces.vtp")
        self.assertEqual(report["elements"], len(mesh.cells))
        self.assertEqual(report["vertices"], len(mesh.points))
        self.assertEqual(report["interface_facets"], len(surface.cells))
        self.assertEqual(report["delta"], 2)
        self.assertEqual(report["space"], "LPS")

        self.assertEqual(set(report["labels"]), {"3", "7"})
        for label, volume in mesh.volume_of_label().items():
            figures = report["labels"][str(label)]
            self.assertEqual(figures["elements"], int((mesh.labels == label).sum()))
            self.assertAlmostEqual(figures["volume"], volume, delta=1e-6 * volume)

        self.check_quality(report["quality"], mesh, surface)
        time = report["time"]
        stages = ("label_field", "distance_transform", "grading", "components", "interfaces", "refinement", "extraction",
                  "optimisation")
        for name in ("read", "write", "total_without_io") + stages:
            self.assertIsInstance(time[name], float)
            self.assertGreaterEqual(time[name], 0.0)
        self.assertAlmostEqual(time["total_without_io"], sum(time[name] for name in stages), delta=1e-6)
        self.assertGreater(time["refinement"], 0.0)
        self.assertAlmostEqual(report["elements_per_second"] * time["total_without_io"], report["elements"],
                               delta=1e-6 * report["elements"])
        self.assertGreater(report["peak_memory_bytes"], 10 << 20)
        self.assertLess(report["peak_memory_bytes"], 4 << 30)

        for rule in ("R1", "R2", "R3", "R4", "R5", "R6"):
            self.assertIsInstance(report["rules"][rule], int)
        self.assertGreater(report["rules"]["R1"], 0)
        self.assertGreater(report["predicates"]["calls"], 0)
        self.assertIsInstance(report["predicates"]["exact"], int)
        self.assertEqual(report["parameters"]["input"], path)
        self.assertEqual(report["parameters"]["label_size"], {"3": 2.5})
        self.assertIsNone(report["parameters"]["size"])
        version = self.call("--version").stdout.split()
        self.assertEqual(version, ["voxplex", report["version"]])

    def check_quality(self, quality, mesh, surface):
        """Against figures worked out here from the files."""
        p = mesh.points[mesh.cells]
        edges = np.stack([p[:, i] - p[:, j] for i in range(4) for j in range(i)], axis=1)
        shortest = np.linalg.norm(edges, axis=2).min(axis=1)
        a = p[:, 1:] - p[:, :1]
        center = np.linalg.solve(2 * a, (a**2).sum(axis=2)[..., None])[..., 0]
        ratio = (np.linalg.norm(center, axis=1) / shortest).max()
        self.assertAlmostEqual(quality["max_radius_edge"], ratio, places=6)
        self.assertLessEqual(quality["max_radius_edge"], 2.5)
        self.assertEqual(quality["radius_edge_violations"], 0)

        normals = np.stack([np.cross(p[:, b] - p[:, a], p[:, c] - p[:, a])
                            for a, b, c in ((1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1))], axis=1)
        normals /= np.linalg.norm(normals, axis=2)[..., None]
        cosines = np.stack([-(normals[:, i] * normals[:, j]).sum(axis=1) for i in range(4) for j in range(i)])
        dihedral = np.degrees(np.arccos(np.clip(cosines, -1, 1)))
        self.assertAlmostEqual(quality["min_dihedral"], dihedral.min(), places=4)
        self.assertAlmostEqual(quality["max_dihedral"], dihedral.max(), places=4)

        t = surface.points[surface.cells]
        angles = []
        for i in range(3):
            u, v = t[:, (i + 1) % 3] - t[:, i], t[:, (i + 2) % 3] - t[:, i]
            cosine = (u * v).sum(axis=1) / np.linalg.norm(u, axis=1) / np.linalg.norm(v, axis=1)
            angles.append(np.degrees(np.arccos(np.clip(cosine, -1, 1))))
        self.assertAlmostEqual(quality["min_planar"], np.min(angles), places=4)
        self.assertEqual(quality["facet_angle_violations"], int((np.min(angles, axis=0) < 30).sum()))


class Threads(ProgramTestCase):
    """That meshes are as good as those of one thread is tested with the filter."""

    def setUp(self):
        super().setUp()
        self.input = images.write_nrrd(self.folder / "two.nrrd", images.two_labels())

    def report(self, *arguments):
        """Aggressive and random managers may livelock; a warning then tells that local took over."""
        done = self.call("--input", self.input, "--delta", 0.6, "--stats", "s.json", *arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertNotRegex(done.stdout, "rollback")  # they are the business of --stats
        report = json.loads((self.folder / "s.json").read_text())
        if report["switched_to_local"] and report["contention"] in ("aggressive", "random"):
            self.assertRegex(done.stderr, r"^voxplex: warning: .* contention manager '%s' \(\d+ rollbacks\), .* the local one "
                                          r"took over; set --contention to local\.\n$" % report["contention"])
        else:
            self.assertEqual(done.stderr, "")
            self.assertIs(report["switched_to_local"], False)
        return report

    def test_policies(self):
        for manager, balancer, pin in (("aggressive", "rws", True), ("random", "hws", False), ("Global", "RWS", False),
                                       ("local", "hws", True)):
            with self.subTest(manager=manager):
                report = self.report("--threads", 4, "--contention", manager, "--balance", balancer, *["--pin"] * pin)
                self.assertEqual((report["contention"], report["balance"]), (manager.lower(), balancer.lower()))
                parameters = report["parameters"]
                self.assertEqual((parameters["contention"], parameters["balance"], parameters["pin"]),
                                 (manager.lower(), balancer.lower(), pin))

    def test_figures(self):
        report = self.report("--threads", 3)
        self.assertEqual((report["contention"], report["balance"], report["threads"]), ("local", "hws", 3))
        parameters = report["parameters"]
        self.assertEqual((parameters["contention"], parameters["balance"], parameters["pin"]), (None, None, False))
        self.assertLessEqual(report["seeding_seconds"], report["time"]["refinement"])
        self.assertEqual(len(report["thread_statistics"]), 3)
        for entry in report["thread_statistics"]:
            self.assertEqual(set(entry), {
                "insertions", "removals", "rollbacks", "waits", "contention_seconds", "load_balance_seconds",
                "rollback_seconds", "received", "received_elements", "helped_loops", "helped_iterations",
                "helping_seconds"})
            self.assertEqual(len(entry["received"]), 3)

    def test_all_cores(self):
        self.assertGreaterEqual(self.report("--threads", 0)["threads"], 1)

    def test_reproducible(self):
        meshes = set()
        for threads in (1, 2, 5):
            self.mesh("--input", self.input, "--delta", 0.6, "--threads", threads, "--reproducible", "--output", "m.mesh")
            meshes.add((self.folder / "m.mesh").read_bytes())
        self.assertEqual(len(meshes), 1)


class Talk(ProgramTestCase):
    """What the program says, and where."""

    def test_help(self):
        short = self.call("--help").stdout
        self.assertLess(short.count("\n"), 60)
        self.assertIn("\nExamples:", short)
        for verb, flags in (("measure", ("--mesh", "--hausdorff")), ("convert", ("--mesh", "--interfaces")), ("image", ("--fill-holes",))):
            text = self.call(verb, "--help").stdout
            for flag in flags:
                self.assertIn(flag + " ", text)
            self.assertNotIn("--delta ", text)
        done = self.call("--help", "all")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual(self.call("mesh", "--help").stdout, done.stdout)
        for flag in ("--threads", "--reproducible", "--contention", "--balance", "--pin", "--input", "--delta", "--output", "--plc",
                     "--size ", "--elements", "--interface-size", "--gradation", "--label-size", "--size-image", "--labels", "--smoothing", "--radius-edge",
                     "--facet-angle", "--sliver-angle", "--no-optimise", "--optimise-seconds", "--no-junctions", "--interface-rounds", "--no-manifold", "--grading", "--feature-ratio", "--largest-feature",
                      "--smallest-component", "--exact-components", "--min-component-volume", "--force", "--memory-limit", "--stats", "--progress", "--space", "--series", "--quality", "--hausdorff", "--version", "--help",
                     "--time-scale", "--time-planes", "--slabs", "--periodic", "--slices", "--slice-count", "--rule-order", "--no-picking", "--picks",
                     "--sliver-bound", "--seed", "--no-fine-grained", "--uncompressed", "--messages"):
            self.assertIn(flag, done.stdout)
        self.assertIn("\nSpace-time images", done.stdout)
        for line in (short + done.stdout).split("\n"):
            self.assertLessEqual(len(line), 100, line)
        # --help wins over all other options.
        self.assertEqual(self.call("--nonsense", "--help").stdout, short)

    def test_version(self):
        done = self.call("--version")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertRegex(done.stdout, r"^voxplex \d+\.\d+\.\d+\n$")

    def test_summary(self):
        path = images.write_nrrd(self.folder / "ball.nrrd", images.ball())
        done = self.mesh("--input", path, "--delta", 3, "--stats", "s.json")
        report = json.loads((self.folder / "s.json").read_text())
        self.assertIn("{:,} tetrahedra in 1 label,".format(report["elements"]), done.stdout)

    def test_progress_in_a_pipe(self):
        """A line for each percent that is new."""
        path = images.write_nrrd(self.folder / "ball.nrrd", images.ball(60, 26.0))
        arguments = ("--input", path, "--delta", 0.5, "--threads", 1)
        self.assertEqual(self.call(*arguments, "--hausdorff").stderr, "")
        done = self.call(*arguments, "--hausdorff", "--progress")
        self.assertEqual(done.returncode, 0)
        self.assertRegex(done.stderr, r"^(\d{1,3} % [A-Z][^\n]*\n)+$")
        lines = [line.split(" % ") for line in done.stderr.splitlines()]
        steps = [step for _, step in lines]
        self.assertIn("Meshing", steps)
        self.assertIn("Measuring", steps)
        for is_measured in (False, True):
            percents = [int(percent) for percent, step in lines if (step == "Measuring") == is_measured]
            self.assertEqual(percents, sorted(set(percents)))
            self.assertLessEqual(percents[-1], 100)
        self.assertGreater(len(lines), 3)

    def test_progress_on_a_terminal(self):
        path = images.write_nrrd(self.folder / "ball.nrrd", images.ball(40, 16.0))
        try:
            ours, theirs = pty.openpty()
        except OSError as error:
            self.skipTest("no pseudo-terminals here: %s" % error)
        with subprocess.Popen([PROGRAM, "--input", path, "--delta", "1.2", "--progress", "--stats", "s.json"], cwd=self.folder, stdout=subprocess.PIPE,
                              stderr=theirs, text=True) as process:
            os.close(theirs)
            shown = b""
            while True:
                try:
                    chunk = os.read(ours, 4096)
                except OSError:  # the other end was closed
                    break
                if not chunk:
                    break
                shown += chunk
            self.assertRegex(process.stdout.read(), "tetrahedra")
        os.close(ours)
        self.assertEqual(process.returncode, 0)
        text = shown.decode()
        self.assertRegex(text, r"\[=* *\] +\d+ %")
        percents = [int(part.split("]")[1].split("%")[0]) for part in text.split("\r")[1:] if "%" in part]
        self.assertEqual(percents, sorted(percents))
        self.assertTrue(text.endswith("\r\033[K"), "the bar is wiped at the end")


class Messages(ProgramTestCase):
    """--messages python: errors and warnings are objects, and name what Python has."""

    def setUp(self):
        super().setUp()
        self.input = images.write_nrrd(self.folder / "two.nrrd", images.two_labels())

    def say(self, status, *arguments):
        if "--output" not in arguments:
            arguments += ("--output", "m.vtu")
        done = self.call("--messages", "python", *arguments)
        self.assertEqual(done.returncode, status, done.stderr)
        self.assertEqual(self.call(*arguments, "--messages=python").stderr, done.stderr)
        message, = map(json.loads, done.stderr.splitlines())
        self.assertEqual(message["kind"], "error" if status else "warning")
        self.assertEqual(message["doing"] != "", status == 1)
        self.assertNotIn("--", message["text"])
        return message["text"]

    def test_options(self):
        for arguments, words in (
                (("--facet-angle", 31), "^facet_angle: must lie between 0 and 30, not 31$"),
                (("--radius-edge", 1.5), "radius_edge: below 1.93 .*; give force=True to try"),
                (("--no-optimise", "--optimise-seconds", 3), "optimise_seconds limits what optimise=False switches off"),
                (("--label-size", "Tibia=2"), "label_sizes: 'Tibia' is not a number, .* with label_table"),
                (("--feature-ratio", 2), "feature_ratio: .*give grading lfs as well"),
                (("--frame-times", 1), "times: give the time of each frame"),
                (("--output", "x--delta.foo"), "output: the format '.foo' is not known")):
            with self.subTest(arguments):
                self.assertRegex(self.say(2, "--input", self.input, *arguments), words)

    def test_filters_and_readers(self):
        self.assertRegex(self.say(1, "--input", self.input, "--delta", 1e-5), "a larger delta or .* or go on with force=True")
        self.assertRegex(self.say(0, "--input", self.input, "--delta", 8, "--size", 0.01),
                         " raised to 0.8; use a smaller delta for")
        (self.folder / "folder").mkdir()
        ball = images.ball(6, 2.0)
        for number in (1, 2):
            images.write_dicom_series(self.folder / "folder", ball, series="1.2.%d" % number, number=number)
        self.assertRegex(self.say(3, "--input", "folder"), 'series_uid="1.2.1"')
        self.assertRegex(self.call("--input", "folder").stderr, "--series 1.2.1")

    def test_shell(self):
        self.assert_refused(2, "--delta: must be", "--input", self.input, "--delta", -1, "--messages", "shell")
        self.assert_refused(2, "--messages: must be shell or python, not 'ruby'", "--input", self.input, "--messages", "ruby")


if __name__ == "__main__":
    main()
