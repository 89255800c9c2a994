#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""voxplex.mesh(): what it takes, what it returns, what it refuses."""

import os
import tempfile
import unittest
import warnings

import numpy
import voxplex
from phantoms import ball, beating, brick


def volumes(mesh):
    corners = mesh.points[mesh.cells]
    a, b, c = (corners[:, i] - corners[:, 0] for i in (1, 2, 3))
    return numpy.einsum("ij,ij->i", numpy.cross(a, b), c) / 6.0


def hypervolumes(mesh):
    coordinates = numpy.column_stack([mesh.points, mesh.times])
    corners = coordinates[mesh.cells]
    return numpy.linalg.det(corners[:, 1:] - corners[:, :1]) / 24.0


def same(first, second):
    """Whether two meshes are the same bit for bit."""
    return (numpy.array_equal(first.points, second.points)
            and numpy.array_equal(first.cells, second.cells)
            and numpy.array_equal(first.labels, second.labels))


class Isosurfaces(unittest.TestCase):
    @staticmethod
    def depth():
        k, j, i = numpy.mgrid[:24, :24, :24]
        return (8.0 - numpy.sqrt((i - 11.5) ** 2 + (j - 11.5) ** 2 + (k - 11.5) ** 2)).astype(numpy.float32)

    def test_signed_distance(self):
        mesh = voxplex.mesh(self.depth(), 1.5, isovalue=0.0, threads=1)
        self.assertEqual(set(mesh.labels), {1})
        self.assertGreater(volumes(mesh).min(), 0.0)
        self.assertAlmostEqual(volumes(mesh).sum() / (4 / 3 * numpy.pi * 8 ** 3), 1.0, delta=0.01)
        unfitted = voxplex.mesh(self.depth(), 1.5, isovalue=0.0, fit_interfaces=False, threads=1)
        radii = numpy.linalg.norm(unfitted.interfaces.points - 11.5, axis=1)
        self.assertLess(abs(radii - 8.0).max(), 0.06)
        self.assertEqual(mesh.statistics["isosurface"]["inside"], "above")

    def test_refused(self):
        with self.assertRaisesRegex(ValueError, "^inside: inside of what.* with isovalue"):
            voxplex.mesh(ball(), inside="below")
        with self.assertRaisesRegex(ValueError, "^inside_label: inside of what.* with isovalue"):
            voxplex.mesh(ball(), inside_label=2)
        with self.assertRaisesRegex(ValueError, "^inside: must be above or below, not 'left'"):
            voxplex.mesh(self.depth(), isovalue=0.0, inside="left")
        with self.assertRaisesRegex(ValueError, "^labels: grey-value images have no labels"):
            voxplex.mesh(self.depth(), isovalue=0.0, labels=[1])

    def test_series(self):
        """Frames of grey values, in an array, at times that are not equally spaced."""
        depth = self.depth()
        times = (0.0, 1.0, 2.0, 4.0)
        series = numpy.stack([depth + 0.25 * time for time in times])
        mesh = voxplex.mesh(series, 1.5, isovalue=0.0, times=times, inside_label=4, threads=1)
        self.assertEqual(set(mesh.labels), {4})
        self.assertEqual((mesh.times.min(), mesh.times.max()), (0.0, 4.0))
        self.assertEqual(mesh.statistics["isosurface"]["value"], 0.0)
        # The whole series is the same mesh: values are linear in time.
        whole = voxplex.mesh(numpy.stack([depth + 0.25 * time for time in range(5)]), 1.5, isovalue=0.0, threads=1)
        numpy.testing.assert_allclose(hypervolumes(mesh).sum(), hypervolumes(whole).sum(), rtol=1e-2)
        with self.assertRaisesRegex(voxplex.MeshingError, "isovalue 9 is outside of the image's range"):
            voxplex.mesh(self.depth(), isovalue=9)
        with self.assertRaisesRegex(voxplex.MeshingError, r"isosurface of it with isovalue"):
            voxplex.mesh(self.depth())


class Inputs(unittest.TestCase):
    def test_array(self):
        mesh = voxplex.mesh(brick(), 1.5)
        self.assertIsInstance(mesh, voxplex.Mesh)
        self.assertEqual((mesh.points.shape[1], mesh.cells.shape[1]), (3, 4))
        self.assertEqual((mesh.points.dtype, mesh.cells.dtype, mesh.labels.dtype), (float, numpy.int64, numpy.int32))
        self.assertEqual(set(mesh.labels), {5, 9})
        self.assertGreater(volumes(mesh).min(), 0.0)

    def test_axes_of_an_array(self):
        """The last index is x: label 9 lies at larger x, and the brick is longest there."""
        mesh = voxplex.mesh(brick(), 1.0, fit_interfaces=False)
        points = mesh.points
        size = points.max(axis=0) - points.min(axis=0)
        numpy.testing.assert_allclose(size, (12, 8, 6), atol=0.5)
        numpy.testing.assert_allclose(points.min(axis=0), (3.5, 3.5, 2.5), atol=0.4)
        centres = points[mesh.cells].mean(axis=1)
        labels = mesh.labels
        self.assertGreater(centres[labels == 9, 0].min(), 9.0)
        self.assertLess(centres[labels == 5, 0].max(), 10.0)

    def test_geometry_of_an_array(self):
        spacing, origin = (0.5, 2.0, 3.0), (100.0, -20.0, 7.0)
        direction = ((0, -1, 0), (1, 0, 0), (0, 0, 1))  # i runs along +y, j along -x
        mesh = voxplex.mesh(brick(), 1.0, spacing=spacing, origin=origin, direction=direction)
        points = mesh.points
        index = numpy.linalg.solve(numpy.array(direction) * spacing, (points - origin).T).T
        numpy.testing.assert_allclose(index.min(axis=0), (3.5, 3.5, 2.5), atol=0.5)
        numpy.testing.assert_allclose(index.max(axis=0), (15.5, 11.5, 8.5), atol=0.5)
        self.assertGreater(volumes(mesh).min(), 0.0)
        numpy.testing.assert_allclose(volumes(mesh).sum(), 12 * 8 * 6 * 3.0, rtol=0.1)

    def test_kinds_of_arrays(self):
        labels = ball(radii=(8, 5))
        reference = voxplex.mesh(labels, 2.0, threads=1)
        read_only = labels.copy()
        read_only.flags.writeable = False
        for name, array in {
                "int64": labels.astype(numpy.int64), "float32": labels.astype(numpy.float32),
                "big-endian": labels.astype(">i2"), "Fortran order": numpy.asfortranarray(labels),
                "stride": numpy.repeat(labels, 2, axis=2)[:, :, ::2], "read only": read_only}.items():
            with self.subTest(name):
                self.assertTrue(same(reference, voxplex.mesh(array, 2.0, threads=1)))
        one = voxplex.mesh(labels > 0, 2.0, threads=1)
        self.assertEqual(set(one.labels), {1})

    def test_result_outlives_its_input(self):
        labels = brick()
        mesh = voxplex.mesh(labels, 1.5)
        before = mesh.points.copy()
        labels[:] = 0
        del labels
        numpy.testing.assert_array_equal(mesh.points, before)

    def test_names_reach_the_mesh(self):
        image = voxplex.Image(brick(), names={9: "spleen", 5: "liver"}, space="LPS")
        mesh = voxplex.mesh(image, 1.5)
        for part in (mesh, mesh.interfaces):
            self.assertEqual(part.names, {5: "liver", 9: "spleen"})
            self.assertEqual(part.space, "LPS")
        plain = voxplex.mesh(brick(), 1.5)
        self.assertEqual((plain.names, plain.space, plain.field_data), ({}, None, {}))
        mesh = voxplex.mesh(image, 1.5, labels=[9])
        self.assertEqual((mesh.names, mesh.interfaces.names), ({9: "spleen"},) * 2)


class Places(unittest.TestCase):
    """LPS or RAS, where it is known, is the same for all that lies in one place."""

    def test_sizes(self):
        image = voxplex.Image(brick(), origin=(30, 20, 10), space="RAS")
        sizes = voxplex.Image(numpy.full(brick().shape, 0.8), origin=(30, 20, 10), space="RAS")
        finer = voxplex.mesh(image, 2.0, size_image=sizes, threads=1)
        self.assertGreater(len(finer.cells), 1.5 * len(voxplex.mesh(image, 2.0).cells))
        sizes.space = "LPS"
        with self.assertRaisesRegex(ValueError, "size_image is in LPS coordinates, the image in RAS"):
            voxplex.mesh(image, 2.0, size_image=sizes)

    def test_quality(self):
        image = voxplex.Image(brick(), origin=(30, 20, 10), space="RAS")
        mesh = voxplex.mesh(image, 2.0)
        self.assertEqual(voxplex.quality(mesh, image)["image"]["lost_labels"], [])
        with self.assertRaisesRegex(ValueError, "the mesh is in RAS coordinates, the image in LPS"):
            voxplex.quality(mesh, voxplex.Image(brick(), space="LPS"))


class Parameters(unittest.TestCase):
    def setUp(self):
        self.image = voxplex.Image(brick(), names={5: "liver", 9: "spleen"})
        self.reference = voxplex.mesh(self.image, 2.0, threads=1)

    def test_names(self):
        """In place of numbers, and in any order."""
        for theirs, ours in ((dict(labels={"spleen"}), dict(labels=[9])), (dict(labels={"SPleen"}), dict(labels=[9])),
                             (dict(label_sizes={"spleen": 0.7}), dict(label_sizes={9: 0.7})),
                             (dict(interface_sizes={"liver": 0.9}), dict(interface_sizes={5: 0.9})),
                             (dict(interface_sizes={("spleen", "liver"): 0.6}), dict(interface_sizes={(5, 9): 0.6}))):
            mesh = voxplex.mesh(self.image, 2.0, threads=1, **theirs)
            self.assertTrue(same(voxplex.mesh(self.image, 2.0, threads=1, **ours), mesh))
            self.assertFalse(same(self.reference, mesh))
        for wrong in ((5, 9, 1), (5,)):
            with self.assertRaisesRegex(ValueError, "interface_sizes: .* is not a pair"):
                voxplex.mesh(self.image, interface_sizes={wrong: 1.0})

    def test_array_of_sizes(self):
        """It lies where the image lies."""
        sizes = numpy.zeros((12, 16, 20))
        sizes[:, :, 10:] = 0.7
        for placed in ({}, dict(spacing=(1, 1, 1), origin=(500, 0, 0))):
            labels = voxplex.mesh(brick(), 2.0, threads=1, size_image=sizes, **placed).labels
            self.assertGreater((labels == 9).sum(), 1.5 * (labels == 5).sum())

    def test_number_of_elements(self):
        mesh = voxplex.mesh(self.image, elements=20000)
        self.assertLess(abs(len(mesh.cells) / 20000 - 1), 0.1)
        self.assertIn({"delta": mesh.statistics["delta"], "elements": len(mesh.cells)}, mesh.statistics["runs"])
        with self.assertRaisesRegex(ValueError, "delta and elements"):
            voxplex.mesh(self.image, 2.0, elements=20000)
        with self.assertRaisesRegex(voxplex.MeshingError, "no delta makes a mesh of 30 elements"):
            voxplex.mesh(self.image, elements=30, size=0.5)

    def test_statistics(self):
        statistics = voxplex.mesh(self.image, 1.0, threads=2, grading="lfs", largest_feature=2).statistics
        self.assertEqual([statistics[key] for key in ("delta", "threads", "largest_delta")], [1, 2, 2])
        self.assertGreater(statistics["grading"]["samples"], 0)

    def test_refuses_what_has_no_effect(self):
        with self.assertRaisesRegex(ValueError, "^grading: must be uniform or lfs, not 'thin'"):
            voxplex.mesh(self.image, grading="thin")
        with self.assertRaisesRegex(voxplex.MeshingError, "feature_ratio"):
            voxplex.mesh(self.image, grading="lfs", feature_ratio=0)
        for grading in (None, "uniform"):
            for name in ("feature_ratio", "largest_feature"):
                with self.assertRaisesRegex(ValueError, "^%s: only .* graded; give grading lfs as well" % name):
                    voxplex.mesh(self.image, 2.0, grading=grading, **{name: 2})
        with self.assertRaisesRegex(ValueError, "^optimise_seconds limits what optimise=False switches off"):
            voxplex.mesh(self.image, 2.0, optimise=False, optimise_seconds=1)
        with self.assertRaisesRegex(ValueError, "^seed is about picking regions, and pick_slivers=False switches them off"):
            voxplex.mesh(beating(), 2.0, pick_slivers=False, seed=1)
        self.assertGreater(len(voxplex.mesh(self.image, 2.0, optimise=True, optimise_seconds=1).cells), 0)

    def test_memory_limit(self):
        with self.assertRaisesRegex(voxplex.MeshingError, "or go on with force=True"):
            voxplex.mesh(self.image, 0.5, memory_limit=1000)

    def test_interfaces(self):
        mesh = voxplex.mesh(self.image, 2.0)
        interfaces = mesh.interfaces
        self.assertIsInstance(interfaces, voxplex.Interfaces)
        self.assertEqual(interfaces.cells.shape[1], 3)
        self.assertEqual(mesh.statistics["elements"], len(mesh.cells))
        self.assertEqual(mesh.statistics["interface_facets"], len(interfaces.cells))
        self.assertEqual(set(mesh.statistics["labels"]), {"5", "9"})
        self.assertEqual({tuple(pair) for pair in interfaces.labels}, {(5, 0), (9, 0), (9, 5)})
        numpy.testing.assert_array_equal(mesh.points[interfaces.point_ids], interfaces.points)
        facets = {tuple(sorted(cell)) for corners in ((0, 1, 2), (0, 1, 3), (0, 2, 3), (1, 2, 3))
                  for cell in mesh.cells[:, corners].tolist()}
        self.assertTrue(facets.issuperset(tuple(sorted(cell)) for cell in interfaces.point_ids[interfaces.cells].tolist()))


class Objects(unittest.TestCase):
    """Meshes as plain data."""

    def test_names(self):
        """Writing into them is enough, on both parts; class and other meshes do not change."""
        image = voxplex.Image(brick(), names={5: "liver", 9: "spleen"})
        mesh, other = voxplex.mesh(image, 3.0), voxplex.mesh(image, 3.0)
        mesh.names[5] = "lung"
        mesh.statistics["note"] = 1
        image.names[9] = "heart"
        self.assertEqual((mesh.names, mesh.interfaces.names), ({5: "lung", 9: "spleen"},) * 2)
        self.assertEqual((other.names, "note" in other.statistics), ({5: "liver", 9: "spleen"}, False))
        self.assertEqual(voxplex.Mesh(mesh.points, mesh.cells).statistics, {})
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "mesh.inp")
            mesh.write(path)
            with open(path, encoding="utf-8") as file:
                self.assertRegex(file.read(), "(?s)=lung.*=spleen.*SURFACE.*spleen__lung")

    def test_made_by_hand(self):
        points = numpy.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1]])
        mesh = voxplex.Mesh(points, numpy.array([[0, 1, 2, 3], [1, 2, 3, 4]]), cell_data={"Label": numpy.array([7, 3])}, names={3: "a<b"})
        numpy.testing.assert_allclose(mesh.volumes, (1 / 6, 1 / 3))
        self.assertEqual({label: round(volume, 9) for label, volume in mesh.label_volumes().items()}, {3: 0.333333333, 7: 0.166666667})
        self.assertEqual(list(mesh.label_volumes()), [3, 7])
        self.assertIn("<td>3</td><td>a&lt;b</td><td>1</td><td>0.333333</td>", mesh._repr_html_())
        with self.assertRaisesRegex(ValueError, "no point array Time"):
            mesh.slice(0.0)
        self.assertIn("20 x 16 x 12 voxels", voxplex.Image(brick(), names={5: "liver"})._repr_html_())

    def test_example(self):
        """Each tissue is in one piece, has a name and a colour, and nearly the volume of its voxels; two calls share nothing."""
        knee = voxplex.example()
        voxplex.example().names[1] = "changed"
        labels = sorted(set(knee.voxels.flat) - {0})
        self.assertEqual((list(knee.names), list(knee.colors), knee.space), (labels, labels, "LPS"))
        mesh = voxplex.mesh(knee, 3.0)
        self.assertEqual((mesh.names, mesh.colors), (knee.names, {label: list(color) for label, color in knee.colors.items()}))
        self.assertEqual(mesh.statistics["broken_components"], [])
        for label, volume in mesh.label_volumes().items():
            self.assertAlmostEqual(volume / (3.375 * (knee.voxels == label).sum()), 1, delta=0.02)

    def test_volumes(self):
        mesh = voxplex.mesh(brick(), 1.5)
        numpy.testing.assert_allclose(mesh.volumes, volumes(mesh))
        for label, volume in mesh.label_volumes().items():
            self.assertAlmostEqual(volume, mesh.statistics["labels"][str(label)]["volume"], places=6)
        mesh = voxplex.mesh(beating(), 2.0, times=(0, 1, 2.5, 3))
        numpy.testing.assert_allclose(mesh.volumes, hypervolumes(mesh))
        self.assertIn("pentatopes", mesh._repr_html_())

    def test_slice(self):
        """Slices of all times together are the space-time mesh; data of points are interpolated."""
        mesh = voxplex.mesh(voxplex.Image(beating(), times=(0, 1, 2.5, 4), names={1: "ball"}, space="RAS"), 2.0)
        mesh.point_data["Double"] = 2 * mesh.times
        nodes, weights = numpy.polynomial.legendre.leggauss(12)
        sums = 0.0
        for time, weight in zip(2 + 2 * nodes, 2 * weights):
            piece = mesh.slice(time)
            self.assertEqual((piece.cells.shape[1], piece.names, piece.space, set(piece.labels)), (4, {1: "ball"}, "RAS", {1}))
            self.assertGreater(piece.volumes.min(), 0)
            self.assertEqual({tuple(pair) for pair in piece.interfaces.labels}, {(1, 0)})
            numpy.testing.assert_allclose(piece.point_data["Double"], 2 * time)
            sums += weight * piece.volumes.sum()
        numpy.testing.assert_allclose(sums, mesh.volumes.sum(), rtol=1e-3)
        for time in (-0.1, 4.1, numpy.nan):
            with self.assertRaisesRegex(ValueError, "the mesh is there from 0 to 4"):
                mesh.slice(time)
        for time in (0, 4):
            self.assertGreater(len(mesh.slice(time).cells), 0)


class SpaceTime(unittest.TestCase):
    def check(self, mesh, first, last):
        times = mesh.times
        self.assertEqual((times.min(), times.max()), (first, last))
        self.assertGreater(hypervolumes(mesh).min(), 0.0)
        self.assertEqual(set(mesh.labels), {1})

    def test_array(self):
        mesh = voxplex.mesh(beating(), 2.0)
        self.check(mesh, 0.0, 3.0)

    def test_times_and_scale(self):
        times = (1.0, 1.5, 2.0, 2.5)
        mesh = voxplex.mesh(beating(), 2.0, times=times, time_scale=4.0, seed=3, spacing=(1, 1, 1))
        self.check(mesh, 1.0, 2.5)
        self.assertEqual(mesh.statistics["dimension"], 4)
        boundary = mesh.interfaces
        self.assertEqual(boundary.labels.shape, (len(boundary.cells), 2))
        self.assertEqual(boundary.cells.shape[1], 4)

    def test_time_planes_and_period(self):
        labels = beating()
        labels[-1] = labels[0]
        times = (1.0, 1.5, 2.0, 2.5)
        mesh = voxplex.mesh(labels, 2.0, times=times, time_scale=8.0, time_planes=(1.8,), periodic=True)
        slabs = mesh.cell_data["Slab"]
        self.assertEqual(set(slabs), {0, 1})
        self.assertEqual(len(mesh.field_data["TimePlanes"]), 1)
        pairs = mesh.field_data["PeriodicPairs"]
        self.assertGreater(len(pairs), 10)
        points, at = mesh.points, mesh.times
        numpy.testing.assert_array_equal(points[pairs[:, 0]], points[pairs[:, 1]])
        self.assertEqual((set(at[pairs[:, 0]]), set(at[pairs[:, 1]])), ({1.0}, {2.5}))
        mesh = voxplex.mesh(labels, 2.0, times=times, time_scale=8.0, time_planes="frames")
        self.assertEqual(len(mesh.field_data["TimePlanes"]), 2)
        with self.assertRaisesRegex(ValueError, "time_planes: 'frame' is neither"):
            voxplex.mesh(labels, 2.0, time_planes="frame")
        with self.assertRaisesRegex(voxplex.MeshingError, "A time plane at 9 is outside"):
            voxplex.mesh(labels, 2.0, times=times, time_planes=(9,))

    def test_frames_carry_their_times(self):
        image = voxplex.Image(beating(), times=(0.0, 2.0, 4.0, 6.0))
        self.check(voxplex.mesh(image, 2.0), 0.0, 6.0)
        self.check(voxplex.mesh(image, 2.0, times=(1, 2, 3, 4)), 1.0, 4.0)
        self.check(voxplex.mesh(image, 2.0, times=(1, 2, 3.5, 4)), 1.0, 4.0)
        with self.assertRaisesRegex(voxplex.MeshingError, "must increase"):
            voxplex.mesh(image, 2.0, times=(5.0, 7.0, 7.0, 10.0))

    def test_frames_are_in_order(self):
        """The ball grows: at the end it is larger than at the start."""
        mesh = voxplex.mesh(beating(), 1.5)
        ends = [numpy.ptp(mesh.points[mesh.times == time], axis=0).max() for time in (0.0, 3.0)]
        self.assertLess(ends[0] + 1.5, ends[1])

    def test_lists(self):
        """Frames of any kind, at one place."""
        reference = voxplex.mesh(beating(), 2.0, spacing=(1, 1, 2), threads=1)
        for frames in (list(beating()), [voxplex.Image(frame, spacing=(1, 1, 2)) for frame in beating()]):
            place = {} if isinstance(frames[0], voxplex.Image) else dict(spacing=(1, 1, 2))
            mesh = voxplex.mesh(frames, 2.0, threads=1, **place)
            numpy.testing.assert_array_equal(mesh.points, reference.points)
        with self.assertRaisesRegex(ValueError, "frame 0 is a time series itself"):
            voxplex.mesh([beating(), beating()], 2.0)

    def test_pictures_with_colours(self):
        pictures = numpy.zeros((6, 10, 12, 3), dtype=numpy.uint8)
        pictures[:, 2:8, 3:9] = 1
        for take in (voxplex.mesh, voxplex.Image):
            with self.assertRaisesRegex(ValueError, "colours.*pass times="):
                take(pictures)
        self.assertEqual(voxplex.Image(pictures, times=range(6)).times, [0, 1, 2, 3, 4, 5])
        self.assertTrue(voxplex.Image(pictures.astype(numpy.int16)).is_series)
        self.check(voxplex.mesh(pictures, 2.0, times=range(6)), 0.0, 5.0)


class Masked(unittest.TestCase):
    """Masked voxels are background, in every way in."""

    def setUp(self):
        self.labels = ball(radii=(8, 5))
        self.mask = numpy.zeros(self.labels.shape, dtype=bool)
        self.mask[:, :, :12] = True
        self.expected = voxplex.mesh(numpy.where(self.mask, 0, self.labels), 2.0, threads=1)

    def test_labels(self):
        for kind in (numpy.uint8, numpy.int64, numpy.float32, float, ">i2"):
            values = self.labels.astype(kind)
            if values.dtype.kind == "f":
                values[self.mask] = numpy.nan
            array = numpy.ma.masked_array(values, self.mask)
            for source in (array, voxplex.Image(array)):
                with self.subTest(kind=kind):
                    self.assertTrue(same(self.expected, voxplex.mesh(source, 2.0, threads=1)))
            self.assertEqual(voxplex.quality(self.expected, array), voxplex.quality(self.expected, array.filled(0)))
        array = numpy.ma.masked_array(self.labels > 0, self.mask)
        self.assertTrue(same(voxplex.mesh(array.filled(False), 2.0, threads=1), voxplex.mesh(array, 2.0, threads=1)))
        nothing = numpy.ma.masked_array(self.labels)
        self.assertTrue(same(voxplex.mesh(self.labels, 2.0, threads=1), voxplex.mesh(nothing, 2.0, threads=1)))

    def test_grey_values(self):
        """0 is inside of this isosurface, and masked voxels are not."""
        values = self.labels.astype(numpy.int16) * 10 - 5
        expected = voxplex.mesh(numpy.where(self.mask, numpy.nan, values), 2.0, isovalue=-2.5, threads=1)
        for kind in (numpy.int16, numpy.int32, numpy.float32):
            array = numpy.ma.masked_array(values.astype(kind), self.mask)
            self.assertTrue(same(expected, voxplex.mesh(array, 2.0, isovalue=-2.5, threads=1)))

    def test_series(self):
        frames = numpy.ma.masked_array(beating(), False)
        frames[:, :, :, :5] = numpy.ma.masked
        expected = voxplex.mesh(frames.filled(0), 2.0, threads=1)
        for source in (frames, voxplex.Image(frames), voxplex.Image(list(frames))):
            mesh = voxplex.mesh(source, 2.0, threads=1)
            numpy.testing.assert_array_equal(expected.points, mesh.points)
            numpy.testing.assert_array_equal(expected.cells, mesh.cells)
        self.assertEqual(voxplex.quality(expected, frames), voxplex.quality(expected, frames.filled(0)))

    def test_sizes(self):
        """Masked sizes set no bound."""
        sizes = numpy.ma.masked_array(numpy.full(self.labels.shape, 0.5), True)
        self.assertTrue(same(voxplex.mesh(self.labels, 2.0, threads=1),
                             voxplex.mesh(self.labels, 2.0, threads=1, size_image=sizes)))


class Numbers(unittest.TestCase):
    """Numbers of NumPy are as good as Python's."""

    def test_options(self):
        options = dict(delta=1.5, optimise=False, threads=1, labels=[5], radius_edge=2.0, smallest_component=3,
                       label_sizes={5: 1.25}, interface_sizes={(5, 0): 1.5}, manifold=False, force=True)
        theirs = dict(delta=numpy.float32(1.5), optimise=numpy.bool_(False), threads=numpy.int64(1),
                      labels=numpy.array([5], dtype=numpy.uint8), radius_edge=numpy.float64(2.0),
                      smallest_component=numpy.int16(3), label_sizes={numpy.uint8(5): numpy.float32(1.25)},
                      interface_sizes={(numpy.int64(5), numpy.int64(0)): numpy.float64(1.5)},
                      manifold=numpy.False_, force=numpy.True_)
        mesh = voxplex.mesh(brick(), **theirs)
        self.assertTrue(same(voxplex.mesh(brick(), **options), mesh))
        voxplex.mesh(brick(), elements=numpy.int64(800))
        voxplex.mesh(brick(), 2.0, isovalue=numpy.int16(4), inside_label=numpy.uint8(3))

    def test_series(self):
        times = numpy.linspace(0.0, 6.0, 4)
        mesh = voxplex.mesh(beating(), 1.0, times=times, time_planes=numpy.array([3.0]), seed=numpy.int64(3))
        self.assertEqual(len(voxplex.quality(mesh, times=times)["frames"]), 4)

    def test_labels_are_whole(self):
        self.assertTrue(same(voxplex.mesh(brick(), 2.0, labels=[5], threads=1),
                             voxplex.mesh(brick(), 2.0, labels=[5.0], threads=1)))
        for bad in (5.5, numpy.float32(5.5), float("nan")):
            for options in (dict(labels=[bad]), dict(label_sizes={bad: 1.0}), dict(interface_sizes={(bad, 0): 1.0})):
                with self.assertRaisesRegex(ValueError, "labels are whole numbers"):
                    voxplex.mesh(brick(), 2.0, **options)


class Refusals(unittest.TestCase):
    def test_negative(self):
        """As of a CT. Where labels are chosen, such voxels are background."""
        ct = brick() * 100 - 1024
        words = r"-1024 .* is negative.*isosurface of it with isovalue.*the labels to mesh with labels"
        with self.assertRaisesRegex(voxplex.MeshingError, words):
            voxplex.mesh(ct, 2.0)
        labels = brick()
        labels[0] = -1
        self.assertEqual(set(voxplex.mesh(labels, 2.0, labels=[5, 9]).labels), {5, 9})

    def test_grains(self):
        """Thousands of labels are no grey values if they are regions; otherwise only force helps, or labels."""
        grains = numpy.arange(1, 14 ** 3 + 1, dtype=numpy.int32).reshape(14, 14, 14)
        grey = numpy.random.default_rng(1).permutation(grains.reshape(-1)).reshape(14, 14, 14)
        grains = grains.repeat(3, 0).repeat(3, 1).repeat(3, 2)
        fast = dict(delta=6.0, optimise=False, manifold=False, smallest_component=0)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # the mesh lacks many of them
            self.assertGreater(len(voxplex.mesh(grains, **fast).cells), 100)
            self.assertGreater(len(voxplex.mesh(grey, force=True, **fast).cells), 10)
        with self.assertRaisesRegex(voxplex.MeshingError, "2744 labels look like grey values.*go on with force=True"):
            voxplex.mesh(grey, **fast)
        chosen = voxplex.mesh(grey, 0.5, labels=[1, 2, 3], smallest_component=1)
        self.assertEqual(set(chosen.labels), {1, 2, 3})

    def test_messages_of_the_filter(self):
        for words, options in {
                "^delta: must be greater than 0, not -1": dict(delta=-1), "label_sizes gives a size to label 3": dict(label_sizes={3: 1.0}),
                "interface_sizes gives a size to label 3": dict(interface_sizes={(3, 5): 1.0}),
                "^gradation: must be 0 or more, not -1": dict(gradation=-1),
                "[Ll]abels? .*4": dict(labels=[4]), "^label_sizes: must be greater than 0, not -2": dict(label_sizes={5: -2.0})}.items():
            with self.subTest(words), self.assertRaisesRegex(voxplex.MeshingError, words):
                voxplex.mesh(brick(), **options)
        with self.assertRaisesRegex(voxplex.MeshingError, "are 0"):
            voxplex.mesh(numpy.zeros((5, 5, 5), dtype=numpy.uint8))
        with self.assertRaisesRegex(voxplex.MeshingError, "whole"):
            voxplex.mesh(brick() + 0.5)

    def test_nothing_is_printed(self):
        with tempfile.TemporaryFile() as file:
            saved = os.dup(2)
            os.dup2(file.fileno(), 2)
            try:
                with self.assertRaises(voxplex.MeshingError):
                    voxplex.mesh(brick(), delta=-1)
                with warnings.catch_warnings(record=True):
                    warnings.simplefilter("always")
                    voxplex.mesh(brick(), 2.0, size=0.01)
            finally:
                os.dup2(saved, 2)
                os.close(saved)
            file.seek(0)
            self.assertEqual(file.read(), b"")

    def test_arguments(self):
        image = voxplex.Image(brick())
        cases = [
            (TypeError, "not int", lambda: voxplex.mesh(3)),
            (TypeError, "not list", lambda: voxplex.mesh([])),
            (TypeError, "detla", lambda: voxplex.mesh(image, detla=1)),
            (TypeError, "", lambda: voxplex.mesh(image, "fine")),
            (ValueError, "2 dimensions", lambda: voxplex.mesh(brick()[0])),
            (ValueError, "complex", lambda: voxplex.mesh(brick().astype(complex))),
            (ValueError, "spacing, origin: only for arrays and files", lambda: voxplex.mesh(image, spacing=(1, 1, 1), origin=(0, 0, 0))),
            (ValueError, "spacing has 2 numbers", lambda: voxplex.mesh(brick(), spacing=(1, 1))),
            (ValueError, "direction has 4 numbers", lambda: voxplex.mesh(brick(), direction=numpy.eye(2))),
            (ValueError, "^time_scale: only for space-time images.*the image is a 3D image", lambda: voxplex.mesh(image, time_scale=2.0, seed=0)),
            (ValueError, "^facet_angle: only for 3D images, and the image is a space-time image", lambda: voxplex.mesh(beating(), facet_angle=20)),
            (ValueError, "4 frames, and 2 times", lambda: voxplex.mesh(beating(), times=(0, 1))),
            (TypeError, "labels must be a list of labels, not 'lung'", lambda: voxplex.mesh(image, labels="lung")),
            (TypeError, "label_sizes must be a dictionary", lambda: voxplex.mesh(image, label_sizes=[1, 2])),
            (TypeError, "optimise must be True or False, not 'no'", lambda: voxplex.mesh(image, optimise="no")),
            (TypeError, "progress must be a function", lambda: voxplex.mesh(image, progress=3)),
            (TypeError, "labels are whole numbers, not '1'", lambda: voxplex.Image(brick(), names={"1": "x"})),
            (ValueError, "there are no voxels", lambda: voxplex.mesh(numpy.zeros((0, 4, 4)))),
            (FileNotFoundError, "none.nrrd", lambda: voxplex.mesh(image, size_image="none.nrrd")),
            (ValueError, "labels is empty", lambda: voxplex.mesh(image, labels=[])),
            (ValueError, "'heart'.*no label names", lambda: voxplex.mesh(image, labels=["heart"])),
            (ValueError, "two frames or more", lambda: voxplex.mesh(beating()[:1])),
            (ValueError, "shape", lambda: voxplex.mesh(image, size_image=numpy.ones((3, 3, 3)))),
            (voxplex.MeshingError, r"^The image of sizes \(size_image\) lies beside the image: it has x from 998.5 to 1001.5, y .*; the "
             r"image has x from", lambda: voxplex.mesh(image, size_image=voxplex.Image(numpy.ones((3, 3, 3)), origin=(999, 0, 0)))),
        ]
        for kind, words, call in cases:
            with self.subTest(words), self.assertRaisesRegex(kind, words):
                call()

    def test_names(self):
        image = voxplex.Image(brick())
        image.names = {5: "lung", 9: "lung"}
        with self.assertRaisesRegex(ValueError, r"several labels are called 'lung': \[5, 9\]"):
            voxplex.mesh(image, labels=["lung"])
        image.names = {5: "Lung", 9: "lung"}
        self.assertEqual(set(voxplex.mesh(image, 3.0, labels=["Lung"]).labels), {5})
        with self.assertRaisesRegex(ValueError, r"several labels are called 'LUNG': \[5, 9\]"):
            voxplex.mesh(image, labels=["LUNG"])
        with self.assertRaisesRegex(ValueError, "no label is called 'heart' .there are 'lung'"):
            voxplex.mesh(image, label_sizes={"heart": 1.0})
        with self.assertRaisesRegex(ValueError, "from 1 on"):
            voxplex.Image(brick(), names={0: "air"})
        image.names[0] = "air"
        with self.assertRaisesRegex(ValueError, "from 1 on"):
            voxplex.mesh(image)

    def test_warning(self):
        with self.assertWarnsRegex(voxplex.MeshingWarning, "^Some element sizes are below") as caught:
            voxplex.mesh(brick(), 2.0, label_sizes={5: 0.01})
        self.assertEqual(caught.filename, __file__)


if __name__ == "__main__":
    unittest.main()
