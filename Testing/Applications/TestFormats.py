#!/usr/bin/python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Every output format, read again, holds the same mesh. Files behind links, and files that are replaced."""
import os
import stat
import tempfile
import unittest
from pathlib import Path

import numpy as np

import images
import meshfiles
from program import ProgramTestCase, main

MESH_FORMATS = ("vtu", "vtk", "mesh", "mfem", "inp")
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
                # Coordinates are written such that the same doubles are read, but solvers read 20 characters of .inp.
                off = 1e-13 if extension == "inp" else 0
                np.testing.assert_allclose(mesh.points, reference.points, rtol=off, atol=0)
                np.testing.assert_array_equal(mesh.cells, reference.cells)
                np.testing.assert_array_equal(mesh.labels, reference.labels)
                self.assertEqual(set(mesh.volume_of_label()), {3, 7})
                for label, volume in mesh.volume_of_label().items():
                    self.assertAlmostEqual(volume, reference.volume_of_label()[label], delta=10 * off * volume)
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
        """MEDIT and MFEM carry the interfaces, numbered by pairs of labels; so does Gmsh, see TestGmsh."""
        self.write(interfaces="interfaces.vtp")
        surface = meshfiles.read_triangles(self.folder / "interfaces.vtp")
        expected = np.array([{(3, 0): 3, (7, 0): 7, (7, 3): 8}[tuple(pair)] for pair in surface.labels])
        for name in ("mesh.mesh", "mesh.mfem"):
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
        for name in ("mesh.mesh", "mesh.mfem", "mesh.inp"):
            with self.subTest(name):
                self.write(name)
                mesh = meshfiles.read_tetrahedra(self.folder / name)
                self.assertEqual(mesh.label_names, {3: "label_3", 7: "label_7"})
                self.assertEqual(mesh.names, PAIR_NAMES)

    def test_no_output(self):
        """As in the thesis nothing is written then but the summary. That is said at once."""
        before = self.contents()
        self.mesh("--input", self.input, "--delta", 2, warning="no mesh will be written: name one last, or with --output")
        self.assertEqual(self.contents(), before)

    def test_existing_file_is_replaced(self):
        (self.folder / "mesh.vtu").write_text("old")
        self.write("mesh.vtu")
        self.assertGreater(len(meshfiles.read_tetrahedra(self.folder / "mesh.vtu").cells), 0)



class Places(ProgramTestCase):
    """What a name leads to, and what was there before."""

    def setUp(self):
        super().setUp()
        self.input = images.write_nrrd(self.folder / "two.nrrd", images.two_labels(14, 5.0))
        self.elsewhere = self.folder / "elsewhere"
        self.elsewhere.mkdir()

    def write(self, *arguments, **options):
        self.mesh("--input", self.input, "--delta", 3, "--threads", 1, *arguments, **options)

    def link(self, name, target):
        (self.folder / name).symlink_to(target)

    def test_links(self):
        """All files of a run are written through links, which stay; some lead to old files, others to none yet."""
        names = ("m.vtu", "i.vtp", "s.json", "m.xdmf", "m.h5")
        for name in names:
            self.link(name, "elsewhere/" + name)
        for name in names[::2]:
            (self.elsewhere / name).write_text("old")
        self.write("--output", "m.vtu", "--plc", "i.vtp", "--stats", "s.json")
        self.write("--output", "m.xdmf")
        self.assertEqual({path.name for path in self.elsewhere.iterdir()}, set(names))
        for name in names:
            self.assertTrue((self.folder / name).is_symlink(), name)
            self.assertGreater((self.elsewhere / name).stat().st_size, 200, name)

    def test_links_of_a_time_series(self):
        image = images.write_nrrd(self.folder / "t.nrrd", np.stack([images.two_labels(14, 5.0)] * 5))
        self.link("s_1.vtu", self.elsewhere / "one.vtu")
        self.link("slab_0.vtu", self.elsewhere / "slab.vtu")
        self.link("s.pvd", self.elsewhere / "s.pvd")
        self.mesh("--input", image, "--delta", 2, "--time-planes", 2, "--output", "m.vtu", "--slices", "s_", "--slabs", "slab_")
        self.assertEqual({path.name for path in self.elsewhere.iterdir()}, {"one.vtu", "slab.vtu", "s.pvd"})
        self.assertTrue((self.folder / "s_1.vtu").is_symlink())

    def test_link_to_link(self):
        """Each is relative to its own folder."""
        self.link("m.vtu", "elsewhere/link.vtu")
        (self.elsewhere / "link.vtu").symlink_to("../real.vtu")
        self.write("--output", "m.vtu")
        self.assertTrue((self.elsewhere / "link.vtu").is_symlink())
        self.assertFalse((self.folder / "real.vtu").is_symlink())
        self.assertEqual(meshfiles.read_tetrahedra(self.folder / "real.vtu").space, "LPS")

    @unittest.skipUnless(os.path.isdir("/dev/shm"), "no other file system")
    def test_link_to_another_file_system(self):
        with tempfile.TemporaryDirectory(dir="/dev/shm", prefix="voxplex-test-") as folder:
            self.link("m.vtu", Path(folder) / "m.vtu")
            for _ in range(2):  # to nothing, and to an old file
                self.write("--output", "m.vtu")
                self.assertEqual(os.listdir(folder), ["m.vtu"])
                self.assertTrue((self.folder / "m.vtu").is_symlink())

    def test_links_that_lead_nowhere(self):
        self.link("a.vtu", "b.vtu")
        self.link("b.vtu", "a.vtu")
        self.link("none.vtu", "no folder/m.vtu")
        self.link("folder.vtu", "elsewhere")
        self.link("input.vtu", "two.nrrd")
        self.link("null.vtu", "/dev/null")
        for name, pattern in (("a.vtu", "its symbolic links lead in a circle; remove them"),
                              ("none.vtu", "there is no folder 'no folder'; create it first"),
                              ("folder.vtu", "it is a folder"), ("input.vtu", "it is the input"),
                              ("null.vtu", "it exists and is not a regular file")):
            with self.subTest(name):
                self.assert_refused(3, "cannot write '%s': %s" % (name, pattern), "--input", self.input, "--output", name)

    def test_one_file_by_two_links(self):
        """Before it is there."""
        self.link("m.vtk", "elsewhere/one.vtk")
        self.assert_refused(3, "two outputs have this name", "--input", self.input, "--output", "m.vtk",
                            "--plc", "elsewhere/one.vtk")

    def test_permissions(self):
        """Those of a file that is replaced stay; a new one has what the user's mask leaves."""
        names = ("m.vtu", "i.vtp", "s.json", "m.xdmf", "m.h5")
        for name, mode in zip(names, (0o600, 0o664, 0o640, 0o755, 0o606)):
            (self.folder / name).write_text("old")
            (self.folder / name).chmod(mode)
        self.link("link.vtu", "elsewhere/m.vtu")
        (self.elsewhere / "m.vtu").touch(0o600)
        for arguments in (("--output", "m.vtu", "--plc", "i.vtp", "--stats", "s.json"), ("--output", "m.xdmf"),
                          ("--output", "link.vtu"), ("--output", "new.vtu")):
            self.write(*arguments, umask=0o027)
        modes = [stat.S_IMODE((self.folder / name).stat().st_mode) for name in (*names, "link.vtu", "new.vtu")]
        self.assertEqual([oct(mode) for mode in modes],
                         [oct(mode) for mode in (0o600, 0o664, 0o640, 0o755, 0o606, 0o600, 0o640)])

    @unittest.skipUnless(os.geteuid() == 0, "only root may give files to others")
    def test_owner(self):
        (self.folder / "m.vtu").touch(0o640)
        os.chown(self.folder / "m.vtu", 12345, 23456)
        self.write("--output", "m.vtu")
        found = (self.folder / "m.vtu").stat()
        self.assertEqual((found.st_uid, found.st_gid, stat.S_IMODE(found.st_mode)), (12345, 23456, 0o640))

    def test_write_protected(self):
        """Refused, as other programs do; root may write all the same."""
        self.folder.chmod(0o777)
        (self.folder / "m.vtu").write_text("precious")
        (self.folder / "m.vtu").chmod(0o444)
        other = {"user": 12345, "group": 12345} if os.geteuid() == 0 else {}
        self.assert_refused(3, r"cannot write 'm.vtu': the file that is there is write-protected \(Permission denied\)",
                            "--input", self.input, "--output", "m.vtu", **other)
        if os.geteuid() == 0:
            self.write("--output", "m.vtu")
            self.assertEqual(stat.S_IMODE((self.folder / "m.vtu").stat().st_mode), 0o444)

    def test_hard_links(self):
        """The name gets the new file; other names keep the old one."""
        (self.folder / "m.vtu").write_text("old")
        os.link(self.folder / "m.vtu", self.folder / "other.vtu")
        self.write("--output", "m.vtu")
        self.assertEqual((self.folder / "other.vtu").read_text(), "old")
        self.assertGreater((self.folder / "m.vtu").stat().st_size, 200)


if __name__ == "__main__":
    main()
