#!/usr/bin/python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Space-time meshes with time planes: the whole mesh, its slabs as files, periods; the flags for it."""
import itertools
import json
import math

import numpy as np

import images
import meshfiles
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


def facets_at(mesh, time, numbers=None):
    """The facets with all points at a time, by points (or numbers for them), and their labels."""
    names = [tuple(p[:3]) for p in mesh.points] if numbers is None else list(numbers)
    found = set()
    for cell, label in zip(mesh.cells, mesh.labels):
        flat = [v for v in cell if mesh.points[v][3] == time]
        if len(flat) == 4:
            found.add((frozenset(names[v] for v in flat), int(label)))
    return found


class SlabTestCase(ProgramTestCase):
    def setUp(self):
        super().setUp()
        geometry = images.Geometry((5, -7, 11), (1.0, 1.0, 1.0), first_time=FIRST, time_step=STEP)
        self.input = images.write_space_time_nrrd(self.folder / "heart.nrrd", pulsating_ball(), geometry)
        self.arguments = ["--input", self.input, "--delta", 2, "--threads", 2]

    def read(self, name):
        return meshfiles.read_pentatopes(self.folder / name)


class Slabs(SlabTestCase):
    def test_slabs(self):
        self.mesh(*self.arguments, "--time-planes", "7.5,13", "--output", "mesh.vtu", "--slabs", "slab_", "--stats", "s.json")
        whole = self.read("mesh.vtu")
        planes = whole.planes
        self.assertEqual(planes, [7.5, 13.0])
        self.assertIsNone(whole.pairs)
        ends = [FIRST, *planes, FIRST + (FRAMES - 1) * STEP]
        slabs = [self.read(f"slab_{k}.vtu") for k in range(3)]
        self.assertFalse((self.folder / "slab_3.vtu").exists())
        seen = []
        for k, slab in enumerate(slabs):
            ids = slab.numbers
            np.testing.assert_array_equal(whole.points[ids], slab.points)
            self.assertEqual(slab.times, ends[k:k + 2])
            self.assertEqual((slab.points[:, 3].min(), slab.points[:, 3].max()), (ends[k], ends[k + 1]))
            np.testing.assert_array_equal(np.unique(slab.cells), np.arange(len(slab.points)))
            self.assertGreater(slab.volumes().min(), 0.0)
            self.assertLessEqual(np.unique(facets_of(slab.cells), axis=0, return_counts=True)[1].max(), 2)
            np.testing.assert_array_equal(slab.slabs, k)
            seen += [(tuple(sorted(ids[cell])), int(label)) for cell, label in zip(slab.cells, slab.labels)]
        expected = [(tuple(sorted(cell)), int(label)) for cell, label in zip(whole.cells, whole.labels)]
        self.assertEqual(sorted(seen), sorted(expected))
        for before, after, time in zip(slabs, slabs[1:], planes):
            self.assertGreater(len(facets_at(before, time)), 50)
            self.assertEqual(facets_at(before, time), facets_at(after, time))
            self.assertEqual(facets_at(before, time, before.numbers), facets_at(after, time, after.numbers))
        report = json.loads((self.folder / "s.json").read_text())["time_planes"]
        self.assertEqual((report["slabs"], report["periodic"], report["refused"]), (3, False, 0))

    def test_period(self):
        self.mesh(*self.arguments, "--periodic", "--output", "mesh.vtu", "--stats", "s.json")
        mesh = self.read("mesh.vtu")
        first, last = FIRST, FIRST + (FRAMES - 1) * STEP
        self.assertEqual(mesh.planes, [0.5 * (first + last)])
        self.assertGreater(len(facets_at(mesh, first)), 50)
        self.assertEqual(facets_at(mesh, first), facets_at(mesh, last))
        pairs = mesh.pairs
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
        mesh = self.read("mesh.vtu")
        np.testing.assert_allclose(mesh.planes, FIRST + STEP * np.arange(1, FRAMES - 1), rtol=1e-12)
        for k in range(FRAMES - 1):
            self.assertTrue((self.folder / f"s{k}.vtu").exists())

    def test_folder_that_takes_no_files(self):
        """Known before the image is meshed: a mesh of this size would be refused, too."""
        for prefix, reason in (("none/s_", "there is no folder 'none'"), ("/proc/s_", "does not take new files")):
            self.assert_refused(3, f"cannot write '{prefix}0.vtu': .*{reason}", *self.arguments[:2], "--delta", 0.01,
                                "--time-planes", "7.5", "--slabs", prefix)

    def test_reproducible(self):
        """The same file for any number of threads."""
        for arguments in (("--time-planes", "7.5,13"), ("--periodic",)):
            files = []
            for threads in (1, 2, 5):
                self.mesh(*self.arguments[:-1], threads, *arguments, "--reproducible", "--output", "mesh.mfem")
                files.append((self.folder / "mesh.mfem").read_bytes())
            self.assertTrue(files[0] == files[1] == files[2])

    def test_period_of_grey_values(self):
        k, j, i = np.meshgrid(*[np.arange(18) - 8.5] * 3, indexing="ij")
        phases = 2 * math.pi * (np.arange(FRAMES) % (FRAMES - 1)) / (FRAMES - 1)
        values = np.stack([5.5 - np.sqrt((i - math.cos(p))**2 + (j - math.sin(p))**2 + k * k) for p in phases])
        geometry = images.Geometry((5, -7, 11), (1.0, 1.0, 1.0), first_time=FIRST, time_step=STEP)
        image = images.write_space_time_nrrd(self.folder / "ct.nrrd", values.astype(np.float32), geometry)
        arguments = ("--input", image, "--isovalue", 0, "--delta", 2, "--smoothing", 0.8, "--periodic")
        self.mesh(*arguments, "--output", "mesh.vtu")
        mesh = self.read("mesh.vtu")
        first, last = FIRST, FIRST + (FRAMES - 1) * STEP
        self.assertGreater(len(facets_at(mesh, first)), 50)
        self.assertEqual(facets_at(mesh, first), facets_at(mesh, last))
        expected = 4 / 3 * math.pi * 5.5**3 * (last - first)
        self.assertAlmostEqual(mesh.volumes().sum() / expected, 1, delta=0.03)
        values[-1, 3, 2, 1] += 1
        images.write_space_time_nrrd(image, values.astype(np.float32), geometry)
        self.assert_refused(1, r"they differ in 1 voxels, one of which is \(1, 2, 3\)", *arguments)

    def test_plane_at_an_end(self):
        self.mesh(*self.arguments, "--time-planes", FIRST, "--output", "mesh.mfem", "--slabs", "s_")
        self.assertEqual((self.folder / "mesh.mfem").read_bytes(), (self.folder / "s_0.mfem").read_bytes())
        self.assertFalse((self.folder / "s_1.mfem").exists())

    def test_refused(self):
        for status, pattern, arguments in (
                (1, "A time plane at 2 is outside of the series, whose frames are from 3 to 19", ("--time-planes", "2,5")),
                (1, "a slab of 1 is thinner than delta, which is 2", ("--time-planes", "7,8")),
                (2, "--time-planes: 'x' is not a number", ("--time-planes", "5,x")),
                (2, "--slabs: there is one slab only", ("--slabs", "s_")),
                (2, "--slabs: 's.vtu' is the whole name of a file", ("--time-planes", "7", "--slabs", "s.vtu"))):
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


def sorted_rows(rows):
    return np.sort(np.asarray(rows), axis=1)


def facets_of(cells):
    """The sorted facets of pentatopes, five for each."""
    return sorted_rows(np.concatenate([np.delete(cells, i, axis=1) for i in range(5)]))


class FormatsOfSolvers(SlabTestCase):
    """Slabs and pairs in .mfem and .mesh, beside the .vtu of the same mesh."""

    def run_with(self, extension, *arguments):
        self.mesh(*self.arguments[:-1], 1, *arguments, "--output", "mesh.vtu", "--plc", "boundary.vtu", "--slabs", "vtk_")
        self.mesh(*self.arguments[:-1], 1, *arguments, "--output", "mesh." + extension, "--slabs", "slab_")
        return self.read("mesh.vtu"), self.read("mesh." + extension)

    def check_slabs(self, extension):
        grid, mesh = self.run_with(extension, "--time-planes", "7.5,13")
        np.testing.assert_array_equal(mesh.points, grid.points)
        np.testing.assert_array_equal(mesh.cells, grid.cells)
        np.testing.assert_array_equal(mesh.slabs, grid.slabs)
        self.assertEqual(mesh.planes, [7.5, 13.0])
        self.assertIsNone(mesh.pairs)
        self.assertIsNone(mesh.numbers)
        self.check_surfaces(mesh)
        seen, ends = [], {}
        for k in range(3):
            slab, vtk = self.read(f"slab_{k}.{extension}"), self.read(f"vtk_{k}.vtu")
            np.testing.assert_array_equal(slab.points, vtk.points)
            np.testing.assert_array_equal(slab.cells, vtk.cells)
            np.testing.assert_array_equal(slab.labels, vtk.labels)
            np.testing.assert_array_equal(slab.numbers, vtk.numbers)
            np.testing.assert_array_equal(slab.points, mesh.points[slab.numbers])
            np.testing.assert_array_equal(slab.slabs, k)
            self.assertEqual((slab.names, slab.sides, slab.planes), (mesh.names, mesh.sides, mesh.planes))
            self.check_slab(slab, k)
            seen += [(*sorted(cell), int(label)) for cell, label in zip(slab.numbers[slab.cells], slab.labels)]
            for side in ("plane %d" % k, "plane %d" % (k + 1)):
                at = np.array([slab.sides[number] == side for number in slab.references])
                facets = slab.numbers[sorted_rows(slab.tetrahedra[at])] if at.any() else np.zeros((0, 4), int)
                ends[k, side] = {(*sorted(row), int(number)) for row, number in zip(facets, slab.references[at])}
        self.assertEqual(sorted(seen), sorted((*sorted(cell), int(label)) for cell, label in zip(mesh.cells, mesh.labels)))
        for k in (1, 2):
            shared = ends[k - 1, "plane %d" % k]
            self.assertGreater(len(shared), 50)
            self.assertEqual(shared, ends[k, "plane %d" % k])
        for path in self.folder.glob("slab_3.*"):
            self.fail(path)

    def check_surfaces(self, mesh):
        """Tetrahedra are those of the boundary, in its order, and all facets on planes inside of a label."""
        boundary = meshfiles.read_boundary(self.folder / "boundary.vtu")
        count = len(boundary.cells)
        np.testing.assert_array_equal(mesh.tetrahedra[:count], boundary.point_ids[boundary.cells])
        np.testing.assert_array_equal(mesh.references[:count], boundary.surfaces)
        times = mesh.points[:, 3]
        labels = {}
        for facet, label in zip(facets_of(mesh.cells), np.tile(mesh.labels, 5)):
            if len(set(times[facet])) == 1 and times[facet[0]] in mesh.planes:
                labels.setdefault(tuple(facet), []).append(int(label))
        expected = {facet: ((both[0], both[1]), "plane %d" % (mesh.planes.index(times[facet[0]]) + 1))
                    for facet, both in labels.items()}
        found = {tuple(row): (mesh.names[number], mesh.sides[number])
                 for row, number in zip(sorted_rows(mesh.tetrahedra[count:]), mesh.references[count:])}
        self.assertEqual(found, expected)
        self.assertEqual(len(found), len(mesh.tetrahedra) - count)
        self.assertEqual({pair for pair, _ in found.values()}, {(1, 1), (2, 2)})

    def check_slab(self, slab, k):
        """It is closed: its tetrahedra are the facets that one pentatope has, and those between labels."""
        self.assertGreater(slab.volumes().min(), 0.0)
        np.testing.assert_array_equal(np.unique(slab.cells), np.arange(len(slab.points)))
        sides = {}
        for facet, label in zip(facets_of(slab.cells), np.tile(slab.labels, 5)):
            sides.setdefault(tuple(facet), []).append(int(label))
        expected = {facet for facet, labels in sides.items() if len(set(labels + [0] * (2 - len(labels)))) == 2}
        rows = sorted_rows(slab.tetrahedra)
        self.assertEqual({tuple(row) for row in rows}, expected)
        self.assertEqual(len(rows), len(expected))
        ends = [FIRST, *slab.planes, FIRST + (FRAMES - 1) * STEP][k:k + 2]
        names = ["plane %d" % k if k > 0 else "initial", "plane %d" % (k + 1) if k < len(slab.planes) else "final"]
        for row, number in zip(rows, slab.references):
            times = set(slab.points[row, 3])
            flat = names[ends.index(times.pop())] if len(times) == 1 else ""
            self.assertEqual(slab.sides[number], flat)
            label, = set(sides[tuple(row)]) if flat else (None,)
            self.assertIn(slab.names[number], ((label, 0), (label, label)) if flat else ((2, 0), (2, 1)))

    def check_period(self, extension):
        grid, mesh = self.run_with(extension, "--periodic")
        np.testing.assert_array_equal(mesh.points, grid.points)
        np.testing.assert_array_equal(mesh.pairs, grid.pairs)
        first, last = mesh.pairs.T
        np.testing.assert_array_equal(mesh.points[first, :3], mesh.points[last, :3])
        self.assertEqual((set(mesh.points[first, 3]), set(mesh.points[last, 3])), ({FIRST}, {FIRST + (FRAMES - 1) * STEP}))
        # Both ends are congruent, with the same labels.
        twin = np.arange(len(mesh.points))
        twin[last] = first
        at = {end: {(*row, mesh.names[number]) for row, number in zip(sorted_rows(twin[mesh.tetrahedra]), mesh.references)
                    if mesh.sides[number] == end} for end in ("initial", "final")}
        self.assertGreater(len(at["initial"]), 50)
        self.assertEqual(at["initial"], at["final"])
        # One vertex for both: edges and facets that were different are so still, but those of the ends.
        for part in (2, 4):
            edges = np.concatenate([mesh.cells[:, list(k)] for k in itertools.combinations(range(5), part)])
            before = {tuple(row) for row in sorted_rows(edges)}
            flat = {row for row in before if (mesh.points[list(row), 3] == FIRST).all()}
            self.assertEqual(len({tuple(sorted(twin[list(row)])) for row in before}), len(before) - len(flat))
        self.assertFalse([path for path in self.folder.glob("slab_*") if meshfiles.read_pentatopes(path).pairs is not None])

    def test_mfem(self):
        self.check_slabs("mfem")

    def test_gmf(self):
        self.check_slabs("mesh")

    def test_period_in_mfem(self):
        self.check_period("mfem")

    def test_period_in_gmf(self):
        self.check_period("mesh")


if __name__ == "__main__":
    main()
