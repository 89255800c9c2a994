#!/usr/bin/python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""A mesh that is there is measured and converted as one that was just made; an image is read and written."""
import json
import os
import re
import signal
import subprocess
import time

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import VTK_ID_TYPE, vtkPoints, vtkStringArray
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData, vtkUnstructuredGrid
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter, vtkXMLUnstructuredGridWriter

import images
import meshfiles
from program import PROGRAM, ProgramTestCase, main


def has_open(process, path):
    """Whether it has opened the file."""
    folder = f"/proc/{process}/fd"
    try:
        return str(path) in [os.readlink(os.path.join(folder, number)) for number in os.listdir(folder)]
    except FileNotFoundError:  # closed meanwhile
        return False


class MeshTestCase(ProgramTestCase):
    delta = 2

    def setUp(self):
        super().setUp()
        self.input = images.write_nrrd(self.folder / "two.nrrd", images.two_labels(14, 5.0))

    def make(self, *arguments):
        return self.mesh("--input", self.input, "--delta", self.delta, "--threads", 1, "--output", "m.vtu", "--plc", "i.vtp",
                         *arguments)

    def run_program(self, *arguments):
        done = self.call(*arguments)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return done.stdout

    def json(self, name):
        return json.loads((self.folder / name).read_text())

    def same_files(self, first, second):
        self.assertEqual((self.folder / first).read_bytes(), (self.folder / second).read_bytes(), second)

    def load(self, name):
        return meshfiles.read_data(self.folder / name)

    def save(self, grid, name, **settings):
        writer = vtkXMLPolyDataWriter() if isinstance(grid, vtkPolyData) else vtkXMLUnstructuredGridWriter()
        writer.SetInputData(grid)
        writer.SetFileName(str(self.folder / name))
        for key, value in settings.items():
            getattr(writer, "Set" + key)(value)
        self.assertEqual(writer.Write(), 1)
        return name


class Tetrahedra(MeshTestCase):
    def test_converts(self):
        """As the program writes it at once."""
        names = ("a.msh", "a.mesh", "a.mfem", "a.feb", "a.inp", "a.vtk", "a.vtu")
        for name, surface in zip(names, ("a.stl", "a.ply", "a.vtk", "a.vtp", "", "", "")):
            with self.subTest(name):
                surfaces = [["--plc", prefix + surface] if surface else [] for prefix in ("s", "t")]
                self.mesh("--input", self.input, "--delta", self.delta, "--threads", 1, "--output", name, *surfaces[0])
                self.make()
                told = self.run_program("convert", "--mesh", "m.vtu", "--interfaces", "i.vtp", "--output", "b" + name, *surfaces[1])
                self.assertRegex(told, r"^\d+ tetrahedra, \d+ vertices\. Read in \d+\.\d+ s, written in \d+\.\d+ s\.\n$")
                self.same_files(name, "b" + name)
                if surface:
                    self.same_files("s" + surface, "t" + surface)
        self.run_program("convert", "--mesh", "m.vtu", "--interfaces", "i.vtp", "--plc", "j.vtu")
        self.run_program("convert", "--mesh", "m.vtu", "--interfaces", "j.vtu", "--output", "c.msh")
        self.same_files("a.msh", "c.msh")

    def test_converts_interfaces_alone(self):
        """As beside their mesh, also those that know no points of it."""
        self.make()
        for name in ("a.vtp", "a.vtu", "a.stl", "a.ply", "a.vtk"):
            self.run_program("convert", "--mesh", "m.vtu", "--interfaces", "i.vtp", "--plc", "s" + name)
            self.assertEqual(self.run_program("convert", "--interfaces", "i.vtp", "--plc", "t" + name), "")
            self.same_files("s" + name, "t" + name)
        self.run_program("convert", "--interfaces", "ta.vtu", "--plc", "b.stl")
        self.same_files("sa.stl", "b.stl")
        for status, words, arguments in ((2, "which mesh\\? Name it first, or with --mesh", ("--plc", "x.stl", "--output", "x.vtu")),
                                         (2, "no mesh would be written", ()), (2, "--delta is an option of 'voxplex mesh'", ("--plc", "x.stl", "--delta", 2)),
                                         (2, "--plc: the format '.inp' is not known", ("--plc", "x.inp")), (3, "i.vtp", ("--plc", "i.vtp"))):
            self.assert_refused(status, words, "convert", "--interfaces", "i.vtp", *arguments)

    def test_measures_against_the_image(self):
        self.make()
        made = self.call("--input", self.input, "--delta", self.delta, "--threads", 1, "--hausdorff", "--stats", "made.json")
        told = self.run_program("measure", "--mesh", "m.vtu", "--input", self.input, "--hausdorff", "--stats", "given.json")
        self.assertEqual(told[told.index("\nQuality:"):], made.stdout[made.stdout.index("\nQuality:"):])
        made, given = self.json("made.json"), self.json("given.json")
        self.assertEqual(list(given), ["elements", "vertices", "interface_facets", "faces_of_three_elements", "labels",
                                       "quality", "topology", "image", "hausdorff"])  # those of voxplex.quality()
        for key in ("elements", "vertices", "topology", "image", "hausdorff"):
            self.assertEqual(given[key], made[key], key)

    def test_measures_itself(self):
        self.make()
        told = self.run_program("measure", "--mesh", "m.vtu", "--stats", "s.json", "--radius-edge", 1.2, "--facet-angle", 30)
        self.assertRegex(told, r"vertices\. Radius-edge ratio at most [\d.]+, .* written in .* s\.\nQuality:\n")
        self.assertNotIn("components lost", told)
        figures = self.json("s.json")
        self.assertNotIn("image", figures)
        self.assertGreater(figures["quality"]["radius_edge_violations"], 0)
        self.run_program("measure", "--mesh", "m.vtu", "--stats", "t.json")
        self.assertEqual(self.json("t.json")["quality"]["radius_edge_violations"], 0)

    def test_options_of_measuring(self):
        self.make("--labels", 3)
        figures = []
        for arguments in ((), ("--labels", 3), ("--spacing", "1,1,2"), ("--space", "ras")):
            self.run_program("measure", "--mesh", "m.vtu", "--input", self.input, "--stats", "s.json", *arguments)
            figures.append(self.json("s.json")["image"])
        self.assertEqual([one["lost_labels"] for one in figures[:2]], [[7], []])
        self.assertEqual(figures[2]["volume"], 2 * figures[0]["volume"])
        self.assertGreater(len(figures[3]["lost_components"]), len(figures[0]["lost_components"]))

    def test_refused_options(self):
        self.make()
        for option, value in (("--delta", 2), ("--elements", 100), ("--grading", "lfs"), ("--size", 2), ("--label-size", "3=1"),
                              ("--interface-size", "3=1"), ("--size-image", "two.nrrd"), ("--isovalue", 1), ("--inside", "below"),
                              ("--time-planes", 1), ("--memory-limit", "8G"), ("--no-optimise", None), ("--force", None),
                              ("--reproducible", None), ("--min-component-volume", 1), ("--sliver-angle", 3)):
            self.assert_refused(2, f"{option} is an option of 'voxplex mesh', not of 'voxplex measure'",
                                "measure", "--mesh", "m.vtu", "--input", self.input, option, *([] if value is None else [value]))
        for option, value in (("--labels", 3), ("--spacing", "1,1,1"), ("--smoothing", 1), ("--label-table", "t.txt"),
                              ("--space", "ras"), ("--hausdorff", None), ("--smallest-component", 3), ("--series", "1")):
            self.assert_refused(2, f"{option}: only with an image beside the mesh; give it with --input",
                                "measure", "--mesh", "m.vtu", option, *([] if value is None else [value]))
        for pattern, arguments in (
                ("--interfaces is an option of 'voxplex convert'", ("--input", self.input, "--interfaces", "i.vtp")),
                ("--mesh is an option of 'voxplex measure' and 'voxplex convert', not of 'voxplex mesh'", ("--mesh", "m.vtu")),
                ("unknown option '--save-image'", ("image", self.input, "--save-image", "x.nrrd")),
                ("--time-scale: only for meshes of pentatopes", ("measure", "--mesh", "m.vtu", "--time-scale", 2)),
                ("--frame-times: only for meshes of pentatopes", ("measure", "--mesh", "m.vtu", "--frame-times", "1,2")),
                ("no mesh would be written: name it last", ("convert", "m.vtu")), ("which mesh", ("measure",)), ("which image", ("image",)),
                ("'x.msh' is one name too many", ("convert", "m.vtu", "y.msh", "x.msh", "z.msh")),
                ("--slices: only for meshes of pentatopes", ("convert", "--mesh", "m.vtu", "--slices", "s_", "--slice-count", 2)),
                ("--output: the format '.foo' is not known", ("convert", "--mesh", "m.vtu", "--output", "m.foo"))):
            self.assert_refused(2, pattern, *arguments)
        self.assert_refused(3, "cannot write 'm.vtu': it is the input", "convert", "--mesh", "m.vtu", "--output", "m.vtu")


class Pentatopes(MeshTestCase):
    def setUp(self):
        super().setUp()
        self.input = images.write_space_time_nrrd(self.folder / "moving.nrrd", images.moving_balls(3, 12, 3.0))
        self.made = self.call("--input", self.input, "--delta", 2, "--threads", 1, "--time-scale", 4, "--time-planes", 1,
                              "--output", "m.vtu", "--plc", "i.vtu", "--hausdorff", "--stats", "made.json", "--slices", "s_",
                              "--slabs", "l_")
        self.assertEqual(self.made.returncode, 0, self.made.stderr)
        self.given = ("convert", "m.vtu", "--interfaces", "i.vtu")

    def test_against_the_image(self):
        self.run_program(*self.given, "n.vtu", "--plc", "n_i.vtu", "--slices", "t_", "--frame-times", "0,1,2", "--slabs", "k_")
        told = self.run_program("measure", "m.vtu", self.input, "--hausdorff", "--time-scale", 4, "--stats", "given.json")
        self.assertEqual(told[told.index("\nQuality"):], self.made.stdout[self.made.stdout.index("\nQuality"):])
        made, given = self.json("made.json"), self.json("given.json")
        for key in ("elements", "vertices", "worst_elements", "image", "frames"):
            self.assertEqual(given[key], made[key], key)
        for first, second in (("m", "n"), ("i", "n_i"), ("s_0", "t_0"), ("s_2", "t_2"), ("l_0", "k_0"), ("l_1", "k_1")):
            self.same_files(first + ".vtu", second + ".vtu")

    def test_interfaces_alone(self):
        self.run_program("convert", "--interfaces", "i.vtu", "--plc", "j.vtu")
        self.run_program(*self.given, "--plc", "k.vtu")
        self.same_files("k.vtu", "j.vtu")

    def test_alone(self):
        self.run_program(*self.given, "--frame-times", "0.5", "--slices", "t_")
        told = self.run_program("measure", "m.vtu", "--frame-times", "0.5", "--stats", "s.json")
        self.assertRegex(told, r"^\d+ pentatopes, .*normalized volume.*\nQuality of the cuts at 1 frames:\n")
        self.assertEqual([frame["time"] for frame in self.json("s.json")["frames"]], [0.5])
        self.assertTrue((self.folder / "t_0.vtu").exists())
        told = self.run_program(*self.given, "--slices", "t_", "--slice-count", 3, "--output", "n.mfem")
        self.assertEqual(told.count("\n"), 1)
        for slice_ in range(3):  # at the times of the frames
            points = [memoryview(self.load("%s_%d.vtu" % (name, slice_)).GetPoints().GetData()).tobytes() for name in "st"]
            self.assertEqual(*points)
        self.assertIn("initial", (self.folder / "n.mfem").read_text())
        self.run_program("measure", "--mesh", "m.vtu", "--facet-angle", 20, "--frame-times", "0.5,1", "--stats", "s.json")

    def test_refusals(self):
        two = images.write_nrrd(self.folder / "two.nrrd", images.two_labels(14, 5.0))
        self.mesh("--input", two, "--delta", 3, "--output", "tets.vtu")
        for status, pattern, arguments in (
                (2, "'m.vtu' has pentatopes, but .*two.nrrd' has no time frames", ("measure", "m.vtu", two)),
                (2, "moving.nrrd' has time frames, but 'tets.vtu' has no pent", ("measure", "--mesh", "tets.vtu", "--input", self.input)),
                (3, "--slabs: 'tets.vtu' has no time planes", ("convert", "--mesh", "tets.vtu", "--slabs", "x_")),
                (2, "--slices: a mesh has no frames; give .*--slice-count, .*--frame-times", (*self.given, "--slices", "x_")),
                (2, "--output: '.msh' does not hold", (*self.given, "--output", "x.msh")),
                (2, "--frame-times: give the time of each frame", ("--input", self.input, "--frame-times", "1"))):
            self.assert_refused(status, pattern, *arguments)


class OtherMeshes(MeshTestCase):
    """What a mesh of another program may have: elements that are turned round, points that none uses, no surfaces."""
    FORMATS = (".msh", ".mesh", ".mfem", ".feb", ".inp", ".xdmf")

    def both(self):
        """Tetrahedra with triangles, pentatopes with tetrahedra: their files, and the formats of solvers."""
        self.make()
        yield "m.vtu", "i.vtp", 4, self.FORMATS
        series = images.write_space_time_nrrd(self.folder / "moving.nrrd", images.moving_balls(3, 12, 3.0))
        self.mesh("--input", series, "--delta", 2, "--threads", 1, "--time-scale", 4, "--time-planes", 1, "--output", "p.vtu",
                  "--plc", "boundary.vtu")
        yield "p.vtu", "boundary.vtu", 5, (".mesh", ".mfem")

    def convert(self, mesh, *arguments, warning=None, verb="convert"):
        done = self.call(verb, "--mesh", mesh, *arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stderr, "^voxplex: warning: .*%s.*\n$" % warning if warning else "^$")

    def with_cells(self, grid, cells, size):
        ids = numpy_to_vtk(numpy.ascontiguousarray(cells, dtype=numpy.int64).ravel(), deep=True, array_type=VTK_ID_TYPE)
        array = vtkCellArray()
        array.SetData(size, ids)
        grid.SetCells(grid.GetCellType(0), array)
        return grid

    def cells(self, grid, size):
        return vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, size).copy()

    def test_turned_elements(self):
        for mesh, surfaces, size, formats in self.both():
            for name, step in (("all", 1), ("some", 3)):
                grid = self.load(mesh)
                cells = self.cells(grid, size)
                cells[::step] = cells[::step][:, [*range(size - 2), size - 1, size - 2]]
                self.save(self.with_cells(grid, cells, size), "turned.vtu")
                told = "%d of %d elements are inverted: they are turned round" % (len(cells[::step]), len(cells))
                for extension in (*formats, ".vtu"):
                    with self.subTest(mesh=mesh, name=name, extension=extension):
                        self.convert(mesh, "--output", "a" + extension)
                        self.convert("turned.vtu", "--interfaces", surfaces, "--output", "b" + extension, warning=told)
                        if extension != ".xdmf":
                            self.same_files("a" + extension, "b" + extension)
                self.convert("turned.vtu", "--stats", "t.json", warning=told, verb="measure")
                self.convert(mesh, "--stats", "s.json", verb="measure")
                self.assertEqual(self.json("t.json"), self.json("s.json"))

    def test_mirrored(self):
        """The interfaces look inwards then, as the elements are inverted; and stay where the mesh is turned."""
        self.make()
        for name in ("m.vtu", "i.vtp"):
            data = self.load(name)
            vtk_to_numpy(data.GetPoints().GetData())[:, 0] *= -1
            self.save(data, "mirrored_" + name)
        self.convert("mirrored_m.vtu", "--interfaces", "mirrored_i.vtp", "--plc", "x.stl", "--output", "x.inp",
                     warning="inverted")
        self.convert("mirrored_m.vtu", "--plc", "y.stl", "--output", "y.inp", warning="inverted")
        self.convert("m.vtu", "--interfaces", "i.vtp", "--plc", "z.stl", "--output", "z.inp")
        for name in ("x", "y"):
            for read, measure in ((meshfiles.read_triangles, "enclosed_volume"), (meshfiles.read_tetrahedra, "volume_of_label")):
                extension = ".inp" if measure == "volume_of_label" else ".stl"
                one, other = (getattr(read(self.folder / (stem + extension)), measure)() for stem in (name, "z"))
                self.assertEqual(str(one)[:8], str(other)[:8])

    def test_unused_points(self):
        for mesh, surfaces, size, formats in self.both():
            grid, boundary = self.load(mesh), self.load(surfaces)
            count = grid.GetNumberOfPoints()
            places = numpy.insert(numpy.arange(count), [0, 7, count], 0)  # of which the first, another and the last are copies
            numbers = numpy.delete(numpy.arange(count + 3), [0, 8, count + 2])
            wide = vtkUnstructuredGrid()
            wide.DeepCopy(grid)
            points = vtkPoints()
            points.SetDataTypeToDouble()
            wide.GetPointData().CopyAllocate(grid.GetPointData(), count + 3)
            for i, place in enumerate(places):
                points.InsertNextPoint(grid.GetPoint(place))
                wide.GetPointData().CopyData(grid.GetPointData(), int(place), i)
            wide.SetPoints(points)
            self.with_cells(wide, numbers[self.cells(grid, size)], size)
            self.save(wide, "wide.vtu")
            ids = vtk_to_numpy(boundary.GetPointData().GetArray("PointIds"))
            ids[:] = numbers[ids]
            name = self.save(boundary, "wide_" + surfaces)
            for extension in formats:
                with self.subTest(mesh=mesh, extension=extension):
                    self.convert(mesh, "--output", "a" + extension)
                    self.convert("wide.vtu", "--interfaces", name, "--output", "b" + extension)
                    if extension != ".xdmf":
                        self.same_files("a" + extension, "b" + extension)
            self.convert("wide.vtu", "--output", "c" + formats[0])

    def test_refused(self):
        for mesh, _, size, _ in self.both():
            for pattern, change in (
                    ("with the label 0: 2, the first is cell 3. Labels are", lambda g, c: self.relabel(g, 3, 0)),
                    ("with the label -1: 2, the first is cell 3", lambda g, c: self.relabel(g, 3, -1)),
                    ("with the label 1.5: 2, the first is cell 3", lambda g, c: self.relabel(g, 3, 1.5)),
                    ("with the label nan: 2, the first is cell 3", lambda g, c: self.relabel(g, 3, numpy.nan)),
                    ("that an array of ghost types hides: 2, the first is cell 3", lambda g, c: self.hide(g.GetCellData(), len(c), 3, 32)),
                    ("hides: 2", lambda g, c: self.hide(g.GetCellData(), len(c), 3, 1)),
                    ("hides: ", lambda g, c: self.hide(g.GetPointData(), g.GetNumberOfPoints(), 3, 2)),
                    ("without volume: 1, the first is cell 3", lambda g, c: c.__setitem__((3, 1), c[3, 0])),
                    ("points of another one: 1, the first is cell 9", lambda g, c: c.__setitem__(9, c[3, ::-1]))):
                with self.subTest(mesh=mesh, pattern=pattern):
                    grid = self.load(mesh)
                    cells = self.cells(grid, size)
                    change(grid, cells)
                    self.save(self.with_cells(grid, cells, size), "x.vtu")
                    for arguments in (("convert", "x.vtu", "x.mesh"), ("measure", "x.vtu")):
                        self.assert_refused(3, "cannot read 'x.vtu': Cells of the mesh .*" + pattern, *arguments)
            grid = self.load(mesh)  # nothing of it is hidden
            self.hide(grid.GetCellData(), grid.GetNumberOfCells(), 3, 0)
            self.save(grid, "x.vtu")
            self.convert("x.vtu", "--output", "x.mesh")

    def relabel(self, grid, cell, value):
        labels = vtk_to_numpy(grid.GetCellData().GetArray("Label")).astype(float)
        labels[[cell, -1]] = value
        array = numpy_to_vtk(labels, deep=True)
        array.SetName("Label")
        grid.GetCellData().SetScalars(array)

    def hide(self, data, count, first, flag):
        flags = numpy.zeros(count, dtype=numpy.uint8)
        flags[[first, -1]] = flag
        array = numpy_to_vtk(flags, deep=True)
        array.SetName("vtkGhostType")
        data.AddArray(array)

    def test_surfaces_from_labels(self):
        """As those that were made with the mesh: the same facets, sides and numbers, in another order."""
        for mesh, surfaces, size, formats in self.both():
            self.convert(mesh, "--plc", "made" + surfaces)
            first, second = self.described(surfaces), self.described("made" + surfaces)
            self.assertEqual(first.keys(), second.keys())
            for facet, (is_even, values) in first.items():
                self.assertEqual(second[facet][0], is_even)
                numpy.testing.assert_allclose(second[facet][1], values, rtol=1e-9, atol=1e-12)
            for extension in formats:
                self.convert(mesh, "--interfaces", surfaces, "--output", "a" + extension)
                self.convert(mesh, "--output", "b" + extension)
                sizes = [(self.folder / (one + extension)).stat().st_size for one in "ab"]
                self.assertLess(abs(sizes[0] - sizes[1]), 0.01 * sizes[0], extension)
        self.convert("m.vtu", "--plc", "made.stl")
        self.assertIn("label_7__label_3", (self.folder / "b.mesh").read_text() + (self.folder / "b.msh").read_text())

    def described(self, name):
        """Of each facet, named by its points: whether their order is even, and the values of all arrays, also of its points."""
        is_surface = name.endswith(".vtp")
        data = self.load(name)
        size = 3 if is_surface else 4
        cells = vtk_to_numpy((data.GetPolys() if is_surface else data.GetCells()).GetConnectivityArray()).reshape(-1, size)
        ids = vtk_to_numpy(data.GetPointData().GetArray("PointIds"))[cells]
        names = sorted(data.GetCellData().GetArrayName(i) for i in range(data.GetCellData().GetNumberOfArrays()))
        values = numpy.column_stack([vtk_to_numpy(data.GetCellData().GetArray(one)) for one in names])
        at_points = [vtk_to_numpy(data.GetPoints().GetData())]
        at_points += [vtk_to_numpy(data.GetPointData().GetArray(one)) for one in ("Time", "BoundaryVelocity") if not is_surface]
        at_points = numpy.column_stack(at_points)
        facets = {}
        for facet, points, value in zip(ids, cells, values):
            order = numpy.argsort(facet)
            is_even = numpy.linalg.det(numpy.eye(size)[order]) > 0
            facets[tuple(facet[order])] = is_even, numpy.concatenate([value, at_points[points[order]].ravel()])
        return facets


class SavedImage(MeshTestCase):
    def test_refusals(self):
        for pattern, arguments in (("--output: images are saved as .nrrd", ("x.nii",)), ("--output: images are saved as .nrrd", ("--output", "x.vtu")),
                                   ("--quality is an option of 'voxplex mesh', not of 'voxplex image'", ("x.nrrd", "--quality")),
                                   ("'x.nrrd' is one name too many", ("x.nrrd", "y.nrrd"))):
            self.assert_refused(2, pattern, "image", self.input, *arguments)
        self.assert_refused(2, "which image\\? Name it first, or with --input", "image", "--output", "x.nrrd")
        self.assert_refused(3, "it is the input", "image", self.input, self.input)

    def test_files_that_are_read(self):
        """Those of a folder, and those that a header names, stay as they are, whatever is to be written there."""
        voxels = images.two_labels(14, 5.0)
        for folder in ("masks", "data"):
            (self.folder / folder).mkdir()
        masks = [images.write_nrrd(self.folder / "masks" / ("%d.nrrd" % label), (voxels == label).astype(numpy.uint8))
                 for label in (3, 7)]
        (self.folder / "masks" / "linked.nrrd").symlink_to(images.write_nrrd(self.folder / "away.nrrd", (voxels == 0).astype(numpy.uint8)))
        names = ["data/0%d.nrrd" % k for k in range(len(voxels))]
        for name, plane in zip(names, voxels):
            (self.folder / name).write_bytes(plane.tobytes())
        (self.folder / "data" / "all.vtk").write_bytes(voxels.tobytes())
        sizes = " ".join(map(str, voxels.shape[::-1]))
        head = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: %s\nencoding: raw\nendian: little\nspacings: 1 1 1\n" % sizes
        for name, text in (("list", "LIST\n" + "\n".join(names)), ("pattern", "data/0%%d.nrrd 0 %d 1" % (len(voxels) - 1)),
                           ("one", "data/all.vtk")):
            (self.folder / (name + ".nhdr")).write_text(head + "data file: " + text + "\n")
        (self.folder / "meta.mhd").write_text("ObjectType = Image\nNDims = 3\nDimSize = %s\nElementType = MET_UCHAR\nElementSpacing = 1 1 1\n"
                                              "ElementDataFile = data/all.vtk\n" % sizes)
        for read, written, option in (
                (("--input", "masks"), masks[1], "--output"), (("--input", "masks"), self.folder / "away.nrrd", "--output"),
                (("--input", *masks), masks[1], "--output"), (("--input", "list.nhdr"), names[3], "--output"),
                (("--input", "pattern.nhdr"), names[-1], "--output"), (("--input", "one.nhdr"), "data/all.vtk", "--output"),
                (("--input", "meta.mhd"), "data/all.vtk", "--output"), (("--input", "meta.mhd"), "data/all.vtk", "--plc"),
                (("--input", self.input, "--size-image", "one.nhdr"), "data/all.vtk", "--output")):
            before = (self.folder / written).read_bytes()
            with self.subTest(read=read, option=option):
                verb = ["image"] if str(written).endswith(".nrrd") or written in names else ["mesh"]
                self.assert_refused(3, "cannot write '%s': it is the input" % written, *verb, *read, option, written)
                self.assertEqual((self.folder / written).read_bytes(), before)
        self.run_program("image", "masks", "masks/both.nrrd")  # nothing was there


class Files(MeshTestCase):
    def setUp(self):
        super().setUp()
        self.make("--uncompressed")
        self.whole = (self.folder / "m.vtu").read_bytes()

    def refuse(self, pattern, name="x.vtu"):
        self.assert_refused(3, "cannot read '%s': %s" % (name, pattern), "convert", "--mesh", name, "--output", "y.msh")

    def refuse_bytes(self, pattern, data):
        (self.folder / "x.vtu").write_bytes(data)
        self.refuse(pattern)

    def test_no_mesh(self):
        self.refuse("there is no such file", "none.vtu")
        self.refuse("it is not a .vtu file", "i.vtp")
        self.refuse("it is not a .vtu file", ".")
        (self.folder / "folder.vtu").mkdir()
        self.refuse("it is not a regular file", "folder.vtu")
        self.refuse_bytes("it holds PolyData, and not UnstructuredGrid", (self.folder / "i.vtp").read_bytes())
        self.refuse_bytes("it is truncated or damaged: ", b"solid\n")
        self.refuse_bytes("it is truncated or damaged: ", b"")
        self.refuse_bytes("it is truncated or damaged: its appended data do not end", self.whole[:-40])
        self.refuse_bytes("it is truncated or damaged: its appended data do not end", self.whole[:3000])
        claim = re.sub(rb'NumberOfPoints="\d+" *', b'NumberOfPoints="99999999999" ', self.whole)
        self.refuse_bytes("it is truncated or damaged: it claims .* points or cells", claim)

    def test_wrong_content(self):
        grid = self.load("m.vtu")
        grid.GetCellData().RemoveArray("Label")
        self.save(grid, "x.vtu")
        self.refuse("its cells have no array 'Label' of 1 component")
        self.mesh("--input", images.write_space_time_nrrd(self.folder / "v.nrrd", images.moving_balls(2, 10, 3.0)), "--delta", 3,
                  "--output", "p.vtu", "--plc", "pi.vtu")
        self.refuse("its cells have no array 'Label'", "pi.vtu")
        grid = self.load("p.vtu")
        grid.GetPointData().RemoveArray("Time")
        self.save(grid, "x.vtu")
        self.refuse("its points have no array 'Time' of 1 component")
        self.refuse_bytes("its cells must be tetrahedra, or pentatopes .*, and cell 0 is none",
                          self.change("types", bytes([12])))
        self.refuse_bytes("its cells must be tetrahedra, .*and cell 1 is none", self.change("types", bytes([10, 12])))
        self.refuse_bytes("it has cells with vertices that are none of its points", self.change("connectivity", b"\xff" * 8))
        self.refuse_bytes("it has cells with vertices that are none of its points", self.change("connectivity", b"\xff\xff" + bytes(6)))
        for pattern, mesh, interfaces in (
                ("it is not a .vtp file", "m.vtu", "two.nrrd"),
                ("interfaces of tetrahedra are triangles, and cell 0 is none", "m.vtu", "pi.vtu"), ("it is not a .vtu file", "p.vtu", "i.vtp"),
                ("interfaces of pentatopes are tetrahedra, and cell 0 is none", "p.vtu", "p.vtu"),
                ("its cells have no array 'Labels' of 2 components", "p.vtu", "m.vtu"),
                ("the interfaces are not those of this mesh: their PointIds", "other.vtu", "i.vtp"),
                ("there is no such file", "m.vtu", "none.vtp")):
            with self.subTest(pattern):
                if mesh == "other.vtu":
                    self.mesh("--input", self.input, "--delta", 3, "--output", "other.vtu")
                self.assert_refused(3, "cannot read '%s': %s" % (interfaces, pattern),
                                    "convert", "--mesh", mesh, "--interfaces", interfaces, "--output", "y.vtu")

    def change(self, name, data):
        """Other numbers at the beginning of an array."""
        offset = int(re.search(rb'Name="%s"[^>]*offset="(\d+)"' % name.encode(), self.whole)[1])
        begin = self.whole.index(b"_", self.whole.index(b"<AppendedData")) + 1 + offset + 8
        return self.whole[:begin] + data + self.whole[begin + len(data):]

    def test_crash_of_the_library(self):
        """A signal stands for it, while a file of many blanks is read; again, if the file was read before it came."""
        path = self.folder / "x.vtu"
        at = self.whole.index(b"<FieldData>")
        path.write_bytes(self.whole[:at] + b" " * 50_000_000 + self.whole[at:])
        for _ in range(20):
            with subprocess.Popen([PROGRAM, "measure", path], text=True, stderr=subprocess.PIPE) as process:
                while process.poll() is None and not has_open(process.pid, path):
                    time.sleep(0.001)
                process.send_signal(signal.SIGSEGV)
                message = process.stderr.read()
            if process.returncode == 3:
                break
        self.assertRegex(message, "^voxplex: cannot read '.*x.vtu': its reading ended with a crash: .*\n$")

    def test_elements_in_elements(self):
        """VTK's reader calls itself for each."""
        at = self.whole.index(b"<FieldData>")
        for count in 50, 1_000_000:
            (self.folder / "x.vtu").write_bytes(self.whole[:at] + b"<a>" * count + b"</a>" * count + self.whole[at:])
            if count < 100:
                self.run_program("convert", "x.vtu", "y.vtu")
        self.refuse("it has elements in more than 100 others, which cannot be: correct it")

    def test_more_texts_than_claimed(self):
        """VTK's reader writes them into the array, beyond its end."""
        grid = self.load("m.vtu")
        strings = vtkStringArray()
        strings.SetName("Texts")
        for i in range(100000):
            strings.InsertNextValue("a text that is long enough for memory of its own %d" % i)
        grid.GetFieldData().AddArray(strings)
        self.save(grid, "sound.vtu")
        self.run_program("convert", "sound.vtu", "y.vtu")
        data = (self.folder / "sound.vtu").read_bytes()
        (self.folder / "short.vtu").write_bytes(data.replace(b'NumberOfTuples="100000"', b'NumberOfTuples="1"'))
        self.run_program("convert", "short.vtu", "y.vtu")

    def test_encodings(self):
        """All that VTK writes."""
        grid = self.load("m.vtu")
        expected = self.run_program("measure", "--mesh", "m.vtu", "--stats", "s.json")
        figures = self.json("s.json")
        for mode, encoded, compressor, header in ((0, 0, 0, 0), (1, 0, 0, 0), (1, 0, 1, 1), (2, 1, 1, 0), (2, 1, 0, 1), (2, 0, 1, 0),
                                                  (2, 0, 2, 1), (2, 0, 3, 0)):
            with self.subTest(mode=mode, encoded=encoded, compressor=compressor, header=header):
                self.save(grid, "x.VTU", DataMode=mode, EncodeAppendedData=encoded, CompressorType=compressor,
                          HeaderType=(32, 64)[header])
                told = self.run_program("measure", "--mesh", "x.VTU", "--stats", "s.json")
                self.assertEqual(told.split("\n")[1:], expected.split("\n")[1:])
                self.assertEqual(self.json("s.json")["topology"], figures["topology"])


class Uncompressed(MeshTestCase):
    def test_bytes(self):
        self.make("--uncompressed")
        for name in ("m.vtu", "i.vtp"):
            raw, plain = (self.folder / name).read_bytes(), self.load(name)
            head = raw[:raw.index(b">")]
            self.assertIn(b'header_type="UInt64"', head)
            self.assertNotIn(b"compressor", head)
            self.assertIn(b'<AppendedData encoding="raw">', raw)
            self.assertNotIn(b'format="binary"', raw)
            self.assertNotIn(b'format="ascii"', raw)
            coordinates = memoryview(plain.GetPoints().GetData()).tobytes()
            self.assertIn(len(coordinates).to_bytes(8, "little") + coordinates, raw)
            self.assertEqual(isinstance(plain, vtkPolyData), name == "i.vtp")
        self.make()
        for name in ("m.vtu", "i.vtp"):
            self.assertIn(b"vtkZLibDataCompressor", (self.folder / name).read_bytes()[:200])

    def test_slices_and_slabs(self):
        path = images.write_space_time_nrrd(self.folder / "moving.nrrd", images.moving_balls(3, 12, 3.0))
        self.mesh("--input", path, "--delta", 2, "--time-scale", 4, "--time-planes", 1, "--slices", "s_", "--slabs", "l_",
                  "--plc", "i.vtu", "--uncompressed")
        for name in ("s_0.vtu", "l_1.vtu", "i.vtu"):
            self.assertNotIn(b"compressor", (self.folder / name).read_bytes()[:200], name)


if __name__ == "__main__":
    main()
