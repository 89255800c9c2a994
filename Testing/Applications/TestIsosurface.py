#!/usr/bin/python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Grey-value images: --isovalue and what goes with it."""
import json

import numpy as np

import images
import meshfiles
from program import ProgramTestCase, main

SIZE, RADIUS = 32, 11.0


def depth(size=SIZE, radius=RADIUS):
    """How deep each voxel lies in a ball; negative outside."""
    center = (size - 1) / 2
    z, y, x = np.mgrid[:size, :size, :size]
    return radius - np.sqrt((x - center) ** 2 + (y - center) ** 2 + (z - center) ** 2)


class Isosurface(ProgramTestCase):
    def setUp(self):
        super().setUp()
        self.input = images.write_nrrd(self.folder / "ball.nrrd", depth().astype(np.float32))

    def distances(self, surface, radius=RADIUS):
        center = (SIZE - 1) / 2
        return np.abs(np.linalg.norm(meshfiles.read_triangles(self.folder / surface).points - center, axis=1) - radius)

    def test_ball(self):
        report = self.statistics("--input", self.input, "--threads", 1, "--isovalue", 0, "--delta", 2,
                                 "--output", "ball.vtu", "--plc", "ball.vtp")
        self.mesh("--input", self.input, "--isovalue", 0, "--delta", 2, "--no-fit", "--plc", "unfitted.vtp")
        self.assertLess(self.distances("unfitted.vtp").max(), 0.05)
        mesh = meshfiles.read_tetrahedra(self.folder / "ball.vtu")
        self.assertEqual(set(mesh.labels), {1})
        self.assertAlmostEqual(mesh.volumes().sum() / (4 / 3 * np.pi * RADIUS**3), 1.0, delta=0.005)
        self.assertEqual(report["isosurface"]["value"], 0)
        self.assertEqual(report["isosurface"]["inside"], "above")
        np.testing.assert_allclose(report["isosurface"]["range"], [depth().min(), depth().max()], rtol=1e-6)
        self.assertEqual(report["parameters"]["isovalue"], 0)
        self.assertIsNone(report["parameters"]["inside"])

    def test_place_in_space(self):
        tilt = np.array([[0.8, -0.6, 0], [0.6, 0.8, 0], [0, 0, -1]])
        geometry = images.Geometry(origin=(-30.0, 5.0, 60.0), spacing=(0.5, 0.5, 1.5), direction=tilt)
        k, j, i = np.mgrid[:14, :40, :40]
        points = geometry.physical(np.stack([i, j, k], axis=-1))
        center = geometry.physical((19.3, 19.8, 6.4))
        values = (7.0 - np.linalg.norm(points - center, axis=-1)).astype(np.float32)
        images.write_nrrd(self.input, values, geometry)
        self.mesh("--input", self.input, "--isovalue", 0, "--delta", 1.2, "--no-fit", "--plc", "s.vtp")
        surface = meshfiles.read_triangles(self.folder / "s.vtp").points
        self.assertLess(np.abs(np.linalg.norm(surface - center, axis=1) - 7.0).max(), 0.06)

    def test_names_of_labels_are_not_for_grey_values(self):
        values = np.rint(100 + 10 * depth()).clip(0).astype(np.int16)
        values[0, 0, 0] = 1
        (self.folder / "ct.nrrd.txt").write_text("1 Tibia\n")
        path = images.write_nrrd(self.folder / "ct.nrrd", values)
        report = self.statistics("--input", path, "--isovalue", 100, "--delta", 3, "--output", "m.vtu")
        self.assertIsNone(report["labels"]["1"]["name"])
        self.assertIsNone(report["label_names_from"])
        self.assertNotIn(b"LabelNames", (self.folder / "m.vtu").read_bytes())

    def test_wrong_arguments(self):
        self.assert_refused(2, "--inside: inside of what\\? Give the isosurface with --isovalue",
                            "--input", "a.nrrd", "--inside", "below")
        self.assert_refused(2, "--inside-label: inside of what", "--input", "a.nrrd", "--inside-label", "2")
        self.assert_refused(2, "--isovalue: .* is not a number", "--input", "a.nrrd", "--isovalue", "high")
        for option in ("--labels", "--label-table"):
            self.assert_refused(2, option + ": grey-value images have no labels", "--input", "a.nrrd", "--isovalue", 1,
                                option, "1")

    def test_series(self):
        """A ball that moves by half a voxel a frame, and grows."""
        center, radius = (10.0, 11.5, 11.5), 7.0
        z, y, x = np.mgrid[:24, :24, :26]
        values = np.stack([radius + 0.1 * t - np.sqrt((x - center[0] - 0.5 * t) ** 2 + (y - center[1]) ** 2 +
                                                      (z - center[2]) ** 2) for t in range(8)])
        path = images.write_space_time_nrrd(self.folder / "t.nrrd", values.astype(np.float32))
        arguments = ("--input", path, "--isovalue", 0, "--delta", 2, "--threads", 1, "--inside-label", 5)
        done = self.call(*arguments, "--output", "m.vtu", "--plc", "b.vtu", "--slices", "s_", "--quality", "--stats", "q.json")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        mesh = meshfiles.read_pentatopes(self.folder / "m.vtu")
        self.assertEqual(set(mesh.labels), {5})
        radii = radius + 0.1 * np.linspace(0, 7, 701)
        expected = 7 * (4 / 3 * np.pi * radii**3).mean()
        self.assertAlmostEqual(mesh.volumes().sum() / expected, 1.0, delta=0.01)
        for time, piece in meshfiles.read_slices(self.folder / "s.pvd"):
            self.assertAlmostEqual(piece.volume_of_label()[5] / (4 / 3 * np.pi * (radius + 0.1 * time) ** 3), 1.0, delta=0.025)
        report = json.loads((self.folder / "q.json").read_text())
        self.assertEqual(report["isosurface"]["value"], 0)
        self.assertEqual(report["parameters"]["isovalue"], 0)
        self.assertEqual([frame["image"] for frame in report["frames"]], [None] * 8)
        self.assertNotIn("image_volume", report["labels"]["5"])
        self.assertRegex(done.stdout, r"Quality of the cuts at 8 frames:\n  dihedral angles.*\n$")

        # Without the fit, vertices lie on the sphere of their time.
        self.mesh(*arguments, "--no-fit", "--no-optimise", "--plc", "b.vtu")
        boundary = meshfiles.read_boundary(self.folder / "b.vtu")
        lateral = np.unique(boundary.cells[boundary.sides == 0])
        points = boundary.points[lateral]
        off = np.linalg.norm(points[:, :3] - center - np.outer(points[:, 3], (0.5, 0, 0)), axis=1) - radius - 0.1 * points[:, 3]
        self.assertLess(np.abs(off).max(), 0.06)
        self.assert_refused(2, "--hausdorff: distances are measured from the labels", *arguments, "--hausdorff")

    def test_values_without_a_surface(self):
        self.assert_refused(1, "isovalue 50 is outside of the image's range, which is from -15.* to 10",
                            "--input", self.input, "--isovalue", 50)
        self.assert_refused(1, "label of the inside|label 3", "--input", self.input, "--isovalue", 0,
                            "--label-size", "3=1")

    def test_the_message_about_labels_shows_the_way(self):
        self.assert_refused(1, "is not whole.*mesh an isosurface of it with --isovalue", "--input", self.input)


if __name__ == "__main__":
    main()
