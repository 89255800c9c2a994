#!/usr/bin/python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Space-time meshes with time planes: the whole mesh, its slabs as files, periods; the flags for it."""
import json
import math

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

import images
from program import ProgramTestCase, main

FIRST, STEP, FRAMES = 3.0, 2.0, 9


def pulsating_ball():
    """Labels 1 and 2, in frames of which the last is the first again."""
    k, j, i = np.meshgrid(*[np.arange(20) - 9.5] * 3, indexing="ij")
    radius = np.sqrt(i * i + j * j + k * k)
    frames = []
    for frame in range(FRAMES):
        outer = 6.0 + math.sin(2 * math.pi * (frame % (FRAMES - 1)) / (FRAMES - 1))
        frames.append(np.where(radius < 0.5 * outer, 1, np.where(radius < outer, 2, 0)))
    return np.stack(frames).astype(np.uint8)


class Grid:
    def __init__(self, path):
        reader = vtkXMLUnstructuredGridReader()
        reader.SetFileName(str(path))
        reader.Update()
        self.grid = reader.GetOutput()
        points, cells = self.grid.GetPointData(), self.grid.GetCellData()
        self.points = np.column_stack([vtk_to_numpy(self.grid.GetPoints().GetData()), vtk_to_numpy(points.GetArray("Time"))])
        self.cells = vtk_to_numpy(self.grid.GetCells().GetConnectivityArray()).reshape(-1, 5)
        self.labels = vtk_to_numpy(cells.GetArray("Label"))
        self.slabs = vtk_to_numpy(cells.GetArray("Slab")) if cells.GetArray("Slab") else None
        self.global_ids = points.GetGlobalIds()

    def field(self, name):
        array = self.grid.GetFieldData().GetArray(name)
        return None if array is None else vtk_to_numpy(array)

    def volumes(self):
        p = self.points[self.cells]
        return np.linalg.det(p[:, 1:] - p[:, :1]) / 24.0

    def facets_at(self, time, numbers=None):
        """The facets with all points at a time, by points (or numbers for them), and their labels."""
        names = [tuple(p[:3]) for p in self.points] if numbers is None else list(numbers)
        found = set()
        for cell, label in zip(self.cells, self.labels):
            flat = [v for v in cell if self.points[v][3] == time]
            if len(flat) == 4:
                found.add((frozenset(names[v] for v in flat), int(label)))
        return found

    def sides(self):
        counts = {}
        for cell in self.cells:
            for i in range(5):
                facet = frozenset(np.delete(cell, i))
                counts[facet] = counts.get(facet, 0) + 1
        return counts


class Slabs(ProgramTestCase):
    def setUp(self):
        super().setUp()
        geometry = images.Geometry((5, -7, 11), (1.0, 1.0, 1.0), first_time=FIRST, time_step=STEP)
        self.input = images.write_space_time_nrrd(self.folder / "heart.nrrd", pulsating_ball(), geometry)
        self.arguments = ["--input", self.input, "--delta", 2, "--threads", 2]

    def test_slabs(self):
        self.mesh(*self.arguments, "--time-planes", "7.5,13", "--output", "mesh.vtu", "--slabs", "slab_", "--stats", "s.json")
        whole = Grid(self.folder / "mesh.vtu")
        planes = list(whole.field("TimePlanes"))
        self.assertEqual(planes, [7.5, 13.0])
        self.assertIsNone(whole.field("PeriodicPairs"))
        ends = [FIRST, *planes, FIRST + (FRAMES - 1) * STEP]
        slabs = [Grid(self.folder / f"slab_{k}.vtu") for k in range(3)]
        self.assertFalse((self.folder / "slab_3.vtu").exists())
        seen = []
        for k, slab in enumerate(slabs):
            ids = vtk_to_numpy(slab.global_ids)
            np.testing.assert_array_equal(whole.points[ids], slab.points)
            self.assertEqual(list(slab.field("SlabTimes")), ends[k:k + 2])
            self.assertEqual((slab.points[:, 3].min(), slab.points[:, 3].max()), (ends[k], ends[k + 1]))
            np.testing.assert_array_equal(np.unique(slab.cells), np.arange(len(slab.points)))
            self.assertGreater(slab.volumes().min(), 0.0)
            self.assertLessEqual(max(slab.sides().values()), 2)
            np.testing.assert_array_equal(slab.slabs, k)
            seen += [(tuple(sorted(ids[cell])), int(label)) for cell, label in zip(slab.cells, slab.labels)]
        expected = [(tuple(sorted(cell)), int(label)) for cell, label in zip(whole.cells, whole.labels)]
        self.assertEqual(sorted(seen), sorted(expected))
        for before, after, time in zip(slabs, slabs[1:], planes):
            self.assertGreater(len(before.facets_at(time)), 50)
            self.assertEqual(before.facets_at(time), after.facets_at(time))
            self.assertEqual(before.facets_at(time, vtk_to_numpy(before.global_ids)),
                             after.facets_at(time, vtk_to_numpy(after.global_ids)))
        report = json.loads((self.folder / "s.json").read_text())["time_planes"]
        self.assertEqual((report["slabs"], report["periodic"], report["refused"]), (3, False, 0))

    def test_period(self):
        self.mesh(*self.arguments, "--periodic", "--output", "mesh.vtu", "--stats", "s.json")
        mesh = Grid(self.folder / "mesh.vtu")
        first, last = FIRST, FIRST + (FRAMES - 1) * STEP
        self.assertEqual(list(mesh.field("TimePlanes")), [0.5 * (first + last)])
        self.assertGreater(len(mesh.facets_at(first)), 50)
        self.assertEqual(mesh.facets_at(first), mesh.facets_at(last))
        pairs = mesh.field("PeriodicPairs")
        np.testing.assert_array_equal(mesh.points[pairs[:, 0], :3], mesh.points[pairs[:, 1], :3])
        np.testing.assert_array_equal(mesh.points[pairs[:, 0], 3], first)
        np.testing.assert_array_equal(mesh.points[pairs[:, 1], 3], last)
        on_facets = {v for cell in mesh.cells for v in cell if sum(mesh.points[w][3] == first for w in cell) == 4
                     and mesh.points[v][3] == first}
        self.assertLessEqual(on_facets, set(pairs[:, 0]))
        report = json.loads((self.folder / "s.json").read_text())["time_planes"]
        self.assertEqual((report["slabs"], report["periodic"], report["periodic_pairs"]), (2, True, len(pairs)))

    def test_every_frame(self):
        self.mesh(*self.arguments, "--time-planes", "frames", "--time-scale", 1.5, "--output", "mesh.vtu", "--slabs", "s")
        mesh = Grid(self.folder / "mesh.vtu")
        np.testing.assert_allclose(mesh.field("TimePlanes"), FIRST + STEP * np.arange(1, FRAMES - 1), rtol=1e-12)
        for k in range(FRAMES - 1):
            self.assertTrue((self.folder / f"s{k}.vtu").exists())

    def test_refused(self):
        for status, pattern, arguments in (
                (1, "A time plane at 2 is outside of the series, whose frames are from 3 to 19", ("--time-planes", "2,5")),
                (1, "a slab of 1 is thinner than delta, which is 2", ("--time-planes", "7,8")),
                (2, "--time-planes: 'x' is not a number", ("--time-planes", "5,x")),
                (2, "--slabs: there is one slab only", ("--slabs", "s_")),
                (2, "--slabs: 's.vtu' is the whole name of a file", ("--time-planes", "7", "--slabs", "s.vtu")),
                (2, "do not go together with --reproducible", ("--periodic", "--reproducible"))):
            with self.subTest(pattern):
                self.assert_refused(status, pattern, *self.arguments, *arguments)
        image = images.write_nrrd(self.folder / "ball.nrrd", images.ball())
        for arguments in (("--periodic",), ("--time-planes", "1"), ("--time-planes", "1", "--slabs", "s_")):
            self.assert_refused(2, "only for space-time images", "--input", image, *arguments)
        array = pulsating_ball()
        array[-1] = array[1]
        geometry = images.Geometry((0, 0, 0), (1.0, 1.0, 1.0), first_time=0.0, time_step=2.0)
        other = images.write_space_time_nrrd(self.folder / "other.nrrd", array, geometry)
        self.assert_refused(1, "a last frame that is equal to the first one; they differ in", "--input", other, "--periodic")


if __name__ == "__main__":
    main()
