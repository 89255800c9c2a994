#!/usr/bin/python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Real segmentations. Each is used where it is found and skipped, with a message, where not."""
import json
import re
import unittest
from pathlib import Path

import numpy as np

import meshfiles
from program import ProgramTestCase, main, without_topology

TEMPLATES = Path("/usr/share/mricron/templates")  # Debian: mricron-data
AAL = TEMPLATES / "aal.nii.gz"
DATA = Path(__file__).resolve().parents[3] / "shared" / "data"
KNEE = DATA / "spl-knee-atlas.nrrd"
HEAD_NECK = DATA / "spl-head-neck-atlas.nrrd"
CASES = DATA / "cases"

# Insertions of a region of a space-time mesh, as bounded by Kernel/Refinement/Rules/Rules4D.h: four times WorkLimit,
# and those of the sample spacing rule.
MOST_WORK = 2000
# At a coarse delta some labels are mostly lost, and the program says so.
SHRUNK = "a tenth or more of the volume of"


class Atlases(ProgramTestCase):
    def call(self, *arguments, **options):
        """Some atlases have a qform and an sform that differ, and the program says so: that is tested elsewhere."""
        done = super().call(*arguments, **options)
        done.stderr = re.sub("voxplex: warning: [^\n]* gives two places, and the sform is used;[^\n]*\n", "", done.stderr)
        return done

    @unittest.skipUnless(AAL.exists(), "package mricron-data is not installed")
    def test_every_region_of_the_brain(self):
        report = self.statistics("--input", AAL, "--delta", 2.5, "--output", "aal.vtu", "--plc", "aal.vtp")
        mesh = meshfiles.read_tetrahedra(self.folder / "aal.vtu")
        self.assertEqual(sorted(set(mesh.labels)), list(range(1, 117)))
        self.assertEqual(len(report["labels"]), 116)
        self.assertGreater(mesh.volumes().min(), 0.0)
        self.assertEqual(len(np.unique(mesh.cells)), len(mesh.points), "points that no element uses")
        surface = meshfiles.read_triangles(self.folder / "aal.vtp")
        np.testing.assert_array_equal(surface.points, mesh.points[surface.point_ids])

    @unittest.skipUnless(KNEE.exists(), "the knee atlas is not beside the checkout")
    def test_every_tissue_of_the_knee(self):
        report = self.statistics("--input", KNEE, "--delta", 2, "--threads", 1, "--output", "knee.vtu", warning=SHRUNK)
        mesh = meshfiles.read_tetrahedra(self.folder / "knee.vtu")
        self.assertEqual(len(set(mesh.labels)), 49)
        self.assertGreater(mesh.volumes().min(), 0.0)
        self.assertLessEqual(report["quality"]["max_radius_edge"], 2.5)

    # Refinement did not end here: what was made for a fine place was taken away from beside it.
    @unittest.skipUnless(HEAD_NECK.exists(), "the head-neck atlas is not beside the checkout")
    def test_head_and_neck_end(self):
        report = self.statistics(
            "--input", HEAD_NECK, "--delta", 2, "--threads", 1, "--no-optimise", "--output", "head.vtu",
            warning=SHRUNK)
        self.assertEqual(report["yielding_regions"], [])
        self.assertLess(report["largest_regional_work"], 250)
        self.assertEqual(report["lost_components"], [])

    # Components that are thin compared with delta have a few elements, so that coarse meshes are coarse; none is lost.
    # Vertices may leave interfaces by a part of delta, so that shapes are as good as in fine meshes.
    @unittest.skipUnless(TEMPLATES.exists(), "package mricron-data is not installed")
    def test_coarse_meshes_are_coarse(self):
        for name, most in (("natbrainlab", 60000), ("inia19-NeuroMaps", 150000)):
            with self.subTest(name):
                report = self.statistics("--input", TEMPLATES / (name + ".nii.gz"), "--delta", 6, "--threads", 1,
                                         "--output", "coarse.vtu", warning=SHRUNK)
                self.assertLess(report["elements"], most)
                self.assertEqual((report["lost_components"], report["lost_labels"]), ([], []))
                self.assertEqual(report["optimisation"]["poor_after"], 0)  # 4 and 10 with a quarter of a voxel

    # What is promised costs few elements. Slivers wedged between interfaces would be left over if refinement left them.
    @unittest.skipUnless(TEMPLATES.exists(), "package mricron-data is not installed")
    def test_promises_cost_few_elements(self):
        for name, warning in (("HarvardOxford-cort-maxprob-thr0-1mm", None), ("jhu189", SHRUNK)):
            with self.subTest(name):
                image = ("--input", TEMPLATES / (name + ".nii.gz"), "--delta", 2, "--threads", 1, "--output", "mesh.vtu")
                promised = self.statistics(*image, warning=warning)
                plain = self.statistics(*image, "--no-optimise", "--sliver-angle", 0, "--smallest-component", 0,
                                        "--no-junctions", "--interface-rounds", 0, "--no-manifold", warning=warning)
                self.assertLess(promised["elements"], 1.1 * plain["elements"])
                # One tetrahedron may stay as it was, since a component is there by it alone.
                shapes = promised["optimisation"]
                self.assertLessEqual(shapes["poor_after"], 1)
                self.assertTrue(shapes["min_dihedral_after"] >= 12 and shapes["max_dihedral_after"] <= 160, shapes)

    @unittest.skipUnless(TEMPLATES.exists(), "package mricron-data is not installed")
    def test_exact_components_with_every_delta(self):
        errors, elements = [], []
        for flags in ((), ("--exact-components",)):
            done = self.call("--input", TEMPLATES / "natbrainlab.nii.gz", "--delta", 4, "--threads", 1, "--quality",
                             "--no-fit", "--stats", "statistics.json", *flags)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertRegex(without_topology(done.stderr), "^(|[^\n]*" + SHRUNK + "[^\n]*\n)$")
            report = json.loads((self.folder / "statistics.json").read_text())
            self.assertTrue(all(one["fraction"] > 0.7 for one in report["shrunk_labels"]), report["shrunk_labels"])
            self.assertEqual(report["parameters"]["exact_components"], bool(flags))
            self.assertEqual(report["lost_components"], [])
            errors.append(report["image"]["label_volume_error"])
            elements.append(report["elements"])
        self.assertLess(errors[1], 0.7 * errors[0])
        self.assertGreater(elements[1], 2 * elements[0])

    # Refinement did not end here either, where a life is hardly longer than delta. What is left there is out of bounds, and the user is told.
    @unittest.skipUnless(CASES.exists(), "the small cases are not beside the checkout")
    def test_short_lives_end(self):
        for name, options in (
            ("spacetime-endless-1", ["--delta", 1.6206, "--time-scale", 0.5]),
            ("spacetime-endless-2", ["--delta", 1.078, "--time-scale", 0.4988]),
            ("spacetime-endless-3", ["--delta", 1.8263, "--time-scale", 0.7057, "--no-picking"]),
            ("spacetime-slow", ["--delta", 3.0834, "--time-scale", 4.4545]),
        ):
            with self.subTest(name):
                report = self.statistics("--input", CASES / (name + ".nrrd"), *options, "--threads", 1,
                                         "--output", "short.vtu", warning="many times the work")
                self.assertGreater(len(report["yielding_regions"]), 0)
                self.assertLessEqual(report["largest_regional_work"], MOST_WORK)

    @unittest.skipUnless(CASES.exists(), "the cases are not beside the checkout")
    def test_no_edge_that_is_not_manifold(self):
        opened = 0
        for name, delta in (("random", 1.805), ("sheets", 1.7365), ("one-edge", 5.43)):
            for flags in (("--threads", 1), ("--threads", 2), ("--threads", 1, "--interface-rounds", 0),
                          ("--threads", 1, "--no-optimise")):
                with self.subTest(name=name, flags=flags):
                    done = self.call("--input", CASES / f"nonmanifold-{name}.nrrd", "--delta", delta, "--quality",
                                     "--stats", "statistics.json", *flags)
                    self.assertEqual(done.returncode, 0, done.stderr)
                    self.assertRegex(without_topology(done.stderr), "^(|[^\n]*" + SHRUNK + "[^\n]*\n)$")
                    report = json.loads((self.folder / "statistics.json").read_text())
                    self.assertEqual(report["topology"]["non_manifold_edges"], 0)
                    self.assertEqual(report["interfaces"]["nonmanifold_edges_left"], 0)
                    opened += report["interfaces"]["nonmanifold_edges_opened"]
        self.assertGreater(opened, 0)


if __name__ == "__main__":
    main()
