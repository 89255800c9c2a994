#!/usr/bin/python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Every output format, read again, holds the same mesh."""
import shutil
import subprocess
import unittest

import numpy as np

import images
import meshfiles
from program import ProgramTestCase, main

MESH_FORMATS = ("vtu", "vtk", "mesh", "msh", "inp")
INTERFACE_FORMATS = ("vtp", "vtk", "ply", "stl")


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
        """MEDIT and Gmsh carry the interfaces, numbered by pairs of labels."""
        self.write("mesh.mesh", "interfaces.vtp")
        self.write("mesh.msh")
        surface = meshfiles.read_triangles(self.folder / "interfaces.vtp")
        medit = meshfiles.read_tetrahedra(self.folder / "mesh.mesh")
        gmsh = meshfiles.read_tetrahedra(self.folder / "mesh.msh")
        self.assertEqual(medit.names, {3: (3, 0), 7: (7, 0), 8: (7, 3)})
        self.assertEqual(gmsh.names, {(2, 3): "interface_3_0", (2, 7): "interface_7_0", (2, 8): "interface_7_3",
                                      (3, 3): "label_3", (3, 7): "label_7"})
        expected = np.array([{(3, 0): 3, (7, 0): 7, (7, 3): 8}[tuple(pair)] for pair in surface.labels])
        for mesh in (medit, gmsh):
            np.testing.assert_array_equal(mesh.triangles, surface.point_ids[surface.cells])
            np.testing.assert_array_equal(mesh.references, expected)

    def test_node_sets_of_abaqus(self):
        self.write("mesh.inp", "interfaces.vtp")
        mesh = meshfiles.read_tetrahedra(self.folder / "mesh.inp")
        surface = meshfiles.read_triangles(self.folder / "interfaces.vtp")
        self.assertEqual(set(mesh.node_sets), {"INTERFACE_3_0", "INTERFACE_7_0", "INTERFACE_7_3"})
        for name, nodes in mesh.node_sets.items():
            pair = [int(label) for label in name.split("_")[1:]]
            rows = (surface.labels == pair).all(axis=1)
            expected = np.unique(surface.point_ids[surface.cells[rows]]) + 1
            np.testing.assert_array_equal(nodes, expected)

    @unittest.skipUnless(shutil.which("gmsh"), "gmsh is not installed")
    def test_gmsh_accepts_its_format(self):
        self.write("mesh.msh")
        done = subprocess.run(["gmsh", "-check", "mesh.msh"], cwd=self.folder, capture_output=True, text=True,
                              timeout=120)
        self.assertEqual(done.returncode, 0)
        self.assertRegex(done.stdout, "Done checking mesh coherence")
        self.assertNotRegex(done.stdout + done.stderr, "Error|Warning")

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
