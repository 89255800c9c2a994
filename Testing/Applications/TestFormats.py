#!/usr/bin/python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Every output format, read again, holds the same mesh."""
import numpy as np

import images
import meshfiles
from program import ProgramTestCase, main

MESH_FORMATS = ("vtu", "vtk", "mesh", "mfem", "msh", "inp")
INTERFACE_FORMATS = ("vtp", "vtk", "ply", "stl")

PAIR_NAMES = {(3, 0): "label_3__background", (7, 0): "label_7__background", (7, 3): "label_7__label_3"}


def from_smallest(triangles):
    """Each triangle from its smallest vertex on."""
    start = np.argmin(triangles, axis=1)[:, None]
    return np.take_along_axis(triangles, (start + np.arange(3)) % 3, axis=1)


class Formats(ProgramTestCase):
    def setUp(self):
        super().setUp()
        self.input = images.write_nrrd(self.folder / "two.nrrd", images.two_labels(),
                                       images.Geometry((5, -7, 11), (1.0, 1.0, 1.5)))

    def write(self, mesh=None, interfaces=None):
        arguments = ["--input", self.input, "--delta", 2.5, "--threads", 1]
        if mesh:
            arguments += ["--output", mesh]
        if interfaces:
            arguments += ["--plc", interfaces]
        self.mesh(*arguments)

    def test_mesh_formats_agree(self):
        self.write("reference.vtu")
        reference = meshfiles.read_tetrahedra(self.folder / "reference.vtu")
        self.assertGreater(len(reference.cells), 300)
        self.assertEqual(set(reference.labels), {3, 7})
        self.assertGreater(reference.volumes().min(), 0.0)
        self.assertEqual(reference.space, "LPS")
        for extension in MESH_FORMATS:
            with self.subTest(extension):
                name = "again." + extension
                self.write(name)
                mesh = meshfiles.read_tetrahedra(self.folder / name)
                # Coordinates are written such that the same doubles are read.
                np.testing.assert_array_equal(mesh.points, reference.points)
                np.testing.assert_array_equal(mesh.cells, reference.cells)
                np.testing.assert_array_equal(mesh.labels, reference.labels)
                self.assertEqual(mesh.volume_of_label(), reference.volume_of_label())
                self.assertEqual(mesh.space, "LPS")

    def test_upper_case_extension(self):
        self.write("MESH.VTU")
        self.assertTrue((self.folder / "MESH.VTU").exists())

    def test_interfaces_are_the_boundaries_of_the_labels(self):
        self.write("mesh.vtu", "interfaces.vtp")
        mesh = meshfiles.read_tetrahedra(self.folder / "mesh.vtu")
        surface = meshfiles.read_triangles(self.folder / "interfaces.vtp")
        self.assertEqual(surface.space, "LPS")
        self.assertEqual({tuple(pair) for pair in surface.labels}, {(3, 0), (7, 0), (7, 3)})
        np.testing.assert_array_equal(surface.points, mesh.points[surface.point_ids])
        # The divergence theorem, label by label: normals point out of the first label.
        volumes = mesh.volume_of_label()
        for label in (3, 7):
            out = surface.labels[:, 0] == label
            into = surface.labels[:, 1] == label
            enclosed = meshfiles.Triangles(surface.points, surface.cells[out]).enclosed_volume() - \
                meshfiles.Triangles(surface.points, surface.cells[into]).enclosed_volume()
            self.assertAlmostEqual(enclosed, volumes[label], delta=1e-8 * volumes[label])

    def test_interface_formats_agree(self):
        self.write(interfaces="reference.vtp")
        reference = meshfiles.read_triangles(self.folder / "reference.vtp")
        for extension in INTERFACE_FORMATS:
            with self.subTest(extension):
                name = "again." + extension
                self.write(interfaces=name)
                surface = meshfiles.read_triangles(self.folder / name)
                self.assertEqual(surface.space, "LPS")
                self.assertEqual(len(surface.cells), len(reference.cells))
                self.assertAlmostEqual(surface.areas().sum(), reference.areas().sum(), delta=1e-3)
                np.testing.assert_allclose(surface.points.min(axis=0), reference.points.min(axis=0), atol=1e-4)
                if extension == "ply":
                    np.testing.assert_array_equal(surface.labels, reference.labels)
                if extension in ("vtp", "vtk"):
                    np.testing.assert_array_equal(surface.points, reference.points)
                    np.testing.assert_array_equal(surface.labels, reference.labels)

    def test_references_of_triangles(self):
        """MEDIT, MFEM and Gmsh carry the interfaces, numbered by pairs of labels."""
        self.write(interfaces="interfaces.vtp")
        surface = meshfiles.read_triangles(self.folder / "interfaces.vtp")
        expected = np.array([{(3, 0): 3, (7, 0): 7, (7, 3): 8}[tuple(pair)] for pair in surface.labels])
        for name in ("mesh.mesh", "mesh.mfem", "mesh.msh"):
            with self.subTest(name):
                self.write(name)
                mesh = meshfiles.read_tetrahedra(self.folder / name)
                np.testing.assert_array_equal(mesh.triangles, surface.point_ids[surface.cells])
                np.testing.assert_array_equal(mesh.references, expected)

    def test_sets_and_surfaces_of_abaqus(self):
        """A surface is made of faces of the elements with the larger label, in the order of the triangles."""
        self.write("mesh.inp", "interfaces.vtp")
        mesh = meshfiles.read_tetrahedra(self.folder / "mesh.inp")
        surface = meshfiles.read_triangles(self.folder / "interfaces.vtp")
        self.assertEqual(set(mesh.node_sets), set(PAIR_NAMES.values()))
        self.assertEqual(set(mesh.surfaces), set(PAIR_NAMES.values()))
        for pair, name in PAIR_NAMES.items():
            triangles = surface.point_ids[surface.cells[(surface.labels == pair).all(axis=1)]]
            np.testing.assert_array_equal(mesh.node_sets[name], np.unique(triangles) + 1)
            self.assertEqual(mesh.surface_labels[name], {pair[0]})
            # The same vertices in the same sense: the cyclic order that begins with the smallest is the same.
            np.testing.assert_array_equal(from_smallest(mesh.surfaces[name]), from_smallest(triangles))

    def test_default_names(self):
        for name in ("mesh.mesh", "mesh.mfem", "mesh.msh", "mesh.inp"):
            with self.subTest(name):
                self.write(name)
                mesh = meshfiles.read_tetrahedra(self.folder / name)
                self.assertEqual(mesh.label_names, {3: "label_3", 7: "label_7"})
                self.assertEqual(mesh.names, PAIR_NAMES)

    def test_no_output_is_fine(self):
        """As in the thesis: without names, nothing is written but the summary."""
        before = self.contents()
        self.write()
        self.assertEqual(self.contents(), before)

    def test_existing_file_is_replaced(self):
        (self.folder / "mesh.vtu").write_text("old")
        self.write("mesh.vtu")
        self.assertGreater(len(meshfiles.read_tetrahedra(self.folder / "mesh.vtu").cells), 0)


if __name__ == "__main__":
    main()
