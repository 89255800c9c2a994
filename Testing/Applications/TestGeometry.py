#!/usr/bin/python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""The mesh lies where the image lies: axes, spaces, what the user says of them."""
import numpy as np

import images
import meshfiles
from program import ProgramTestCase, main


def rotation(degrees):
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])


class BallTestCase(ProgramTestCase):
    def mesh_of(self, path, *arguments, name="mesh.vtu", delta=1):
        self.mesh("--input", path, "--delta", delta, "--smoothing", 0, "--threads", 1, "--output", name, *arguments)
        mesh = meshfiles.read_tetrahedra(self.folder / name)
        self.assertGreater(mesh.volumes().min(), 0.0, "inverted elements")
        return mesh

    def check_ball(self, mesh, array, geometry):
        """Volume and centroid of a label's mesh against its voxels."""
        index = np.argwhere(array)[:, ::-1]
        expected = len(index) * geometry.voxel_volume()
        volumes = mesh.volumes()
        self.assertAlmostEqual(volumes.sum() / expected, 1.0, delta=0.05)
        centroid = (volumes[:, None] * mesh.points[mesh.cells].mean(axis=1)).sum(axis=0) / volumes.sum()
        np.testing.assert_allclose(centroid, geometry.physical(index).mean(axis=0), atol=0.1)


class Geometry(BallTestCase):
    def test_skewed_axes(self):
        """Left-handed ones, too."""
        array = images.ball(18, 6.0, center=(7, 8, 9))
        skew = np.array([[-1.0, 0.3, 0.0], [0.0, 1.0, 0.2], [0.0, 0.0, 1.0]])
        skew /= np.linalg.norm(skew, axis=0)
        geometry = images.Geometry((1, 2, 3), (1.0, 1.1, 1.2), skew)
        self.check_ball(self.mesh_of(images.write_nrrd(self.folder / "i.nrrd", array, geometry)), array, geometry)

    def test_space_ras(self):
        array = images.ball(18, 6.0, center=(7, 8, 9))
        geometry = images.Geometry((10, 20, 30), (1.0, 1.1, 1.2), rotation(20))
        path = images.write_nrrd(self.folder / "i.nrrd", array, geometry)
        lps = self.mesh_of(path, "--plc", "lps.vtp")
        ras = self.mesh_of(path, "--space", "RAS", "--plc", "ras.vtp")
        self.assertEqual((lps.space, ras.space), ("LPS", "RAS"))
        np.testing.assert_array_equal(ras.cells, lps.cells)
        np.testing.assert_allclose(ras.points, lps.points * [-1, -1, 1], atol=1e-9)
        surfaces = [meshfiles.read_triangles(self.folder / name) for name in ("lps.vtp", "ras.vtp")]
        self.assertEqual([surface.space for surface in surfaces], ["LPS", "RAS"])
        self.assertAlmostEqual(surfaces[0].enclosed_volume(), surfaces[1].enclosed_volume(), delta=1e-6)

    def test_fourth_dimension_of_one_frame(self):
        array = images.ball(16, 5.0)
        path = images.write_nrrd(self.folder / "i.nrrd", array[None])
        self.check_ball(self.mesh_of(path), array, images.Geometry())

    def test_object_cut_by_the_border(self):
        array = np.ones((8, 9, 10), dtype=np.uint8)
        mesh = self.mesh_of(images.write_nrrd(self.folder / "i.nrrd", array))
        self.check_ball(mesh, array, images.Geometry())


class GivenPlace(BallTestCase):
    """--spacing, --origin and --direction count before the file."""

    PLACE = images.Geometry((-10, 5, 2.5), (1.0, 0.75, 1.5), rotation(30) @ np.diag([1.0, -1.0, 1.0]))

    def setUp(self):
        super().setUp()
        self.array = images.ball(18, 6.0, center=(7, 8, 9))
        self.path = images.write_nrrd(self.folder / "i.nrrd", self.array, images.Geometry((1, 2, 3), (3.0, 3.0, 3.0)))
        self.options = {"--spacing": self.PLACE.spacing, "--origin": self.PLACE.origin,
                        "--direction": self.PLACE.direction.ravel()}

    def given(self, *names):
        return [text for name in names for text in (name, ",".join(repr(float(x)) for x in self.options[name]))]

    def test_all(self):
        for space in ("lps", "ras"):
            mesh = self.mesh_of(self.path, "--space", space, *self.given(*self.options))
            self.assertEqual(mesh.space, space.upper())
            self.check_ball(mesh, self.array, self.PLACE)

    def test_statistics(self):
        arguments = ("--input", self.path, "--delta", 2)
        given = self.statistics(*arguments, *self.given(*self.options), "--data-files-anywhere")["parameters"]
        self.assertEqual(given["spacing"], [1.0, 0.75, 1.5])
        self.assertEqual(given["origin"], [-10, 5, 2.5])
        np.testing.assert_array_equal(given["direction"], self.PLACE.direction.ravel())
        self.assertIs(given["data_files_anywhere"], True)
        default = self.statistics(*arguments)["parameters"]
        self.assertEqual([default[name] for name in ("spacing", "origin", "direction", "data_files_anywhere")],
                         [None, None, None, False])

    def test_spacing_that_the_file_lacks(self):
        lines = {"space": None, "space directions": None, "space origin": None}
        path = images.write_nrrd(self.folder / "j.nrrd", self.array, header_lines=lines)
        self.mesh("--input", path, "--delta", 2, "--output", "j.vtu", warning="j.nrrd: .*no spacing of the voxels.* set it with --spacing")
        self.check_ball(self.mesh_of(path, *self.given("--spacing")), self.array, images.Geometry(spacing=self.PLACE.spacing))

    def test_size_image_has_its_own_place(self):
        sizes = np.full((2, 2, 2), 1.5, dtype=np.float32)
        images.write_nrrd(self.folder / "sizes.nrrd", sizes, images.Geometry((-100, -100, -100), (200.0, 200.0, 200.0)))
        free = len(self.mesh_of(self.path, *self.given("--spacing"), delta=3).cells)
        bound = len(self.mesh_of(self.path, *self.given("--spacing"), "--size-image", "sizes.nrrd", delta=3).cells)
        self.assertGreater(bound, 1.5 * free)


class Series(ProgramTestCase):
    def setUp(self):
        super().setUp()
        self.series = self.folder / "series"
        self.series.mkdir()
        self.first = "1.2.826.0.1.3680043.2.1125.1.1"
        self.second = "1.2.826.0.1.3680043.2.1125.1.2"
        images.write_dicom_series(self.series, images.ball(12, 4.0, dtype=np.uint16), series=self.first)

    def test_choice_of_series(self):
        images.write_dicom_series(self.series, images.ball(14, 5.0, label=9, dtype=np.uint16), series=self.second,
                                  number=2)
        done = self.call("--input", "series", "--output", "mesh.vtu")
        self.assertEqual(done.returncode, 3)
        for uid in (self.first, self.second):
            self.assertIn("--series " + uid, done.stderr)
        self.assertFalse((self.folder / "mesh.vtu").exists())
        self.mesh("--input", "series", "--series", self.second, "--delta", 2, "--output", "mesh.vtu")
        self.assertEqual(set(meshfiles.read_tetrahedra(self.folder / "mesh.vtu").labels), {9})


if __name__ == "__main__":
    main()
