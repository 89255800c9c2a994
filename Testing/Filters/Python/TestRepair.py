#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""vtkSegmentationRepair: phantoms whose answers are known, and distances of SciPy."""
import itertools
import json
import math
import unittest

import numpy
from scipy import ndimage
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.util.vtkConstants import vtkImageScalarTypeNameMacro
from vtkmodules.vtkCommonDataModel import vtkImageData

import voxplex
from filter_testing import add_array, components, errors_of, series


def ball(radius=10.0, size=30):
    return (numpy.linalg.norm(numpy.mgrid[:size, :size, :size] - (size - 1) / 2, axis=0) < radius).astype(numpy.uint8)


def box(size=20, margin=5):
    labels = numpy.zeros((size,) * 3, dtype=numpy.uint8)
    labels[(slice(margin, -margin),) * 3] = 1
    return labels


def filter_of(image, **properties):
    """A property that is a dictionary is one of labels."""
    repair = voxplex.vtkSegmentationRepair()
    repair.SetInputData(image)
    for name, value in properties.items():
        for arguments in value.items() if isinstance(value, dict) else [(value,)]:
            getattr(repair, "Set" + name)(*arguments)
    return repair


def array_of(image, like):
    return vtk_to_numpy(image.GetPointData().GetScalars()).reshape(like.shape)


def near(sites, spacing, thickness):
    """What a shell of the sites has: an ellipsoid around each, and all voxels beside them."""
    lengths = numpy.array(spacing[::-1])
    half = thickness + lengths / 2
    reach = (half / lengths).astype(int)
    offsets = numpy.moveaxis(numpy.indices(2 * reach + 1), 0, -1) - reach
    inside = numpy.linalg.norm(offsets * lengths / half, axis=-1) <= 1.0001
    return ndimage.binary_dilation(sites, inside | (abs(offsets).max(axis=-1) < 2)) & ~sites


def faces(one, other):
    """How many faces of voxels two masks have in common."""
    return sum(numpy.count_nonzero(a[1:] & b[:-1]) for axis in range(3)
               for a, b in ((numpy.moveaxis(one, axis, 0), numpy.moveaxis(other, axis, 0)),
                            (numpy.moveaxis(other, axis, 0), numpy.moveaxis(one, axis, 0))))


class Repair(unittest.TestCase):
    def repaired(self, labels, place=None, **properties):
        """The voxels, and the rows of the report."""
        repair = filter_of(voxplex.Image(labels, **(place or {})).to_vtk(), **properties)
        repair.Update()
        self.assertEqual(repair.GetErrorMessage(), "")
        return array_of(repair.GetOutput(), labels), json.loads(repair.ToJSON())

    def check_same(self, found, expected):
        self.assertEqual(numpy.argwhere(found != expected)[:20].tolist(), [])


class Holes(Repair):
    def test_size(self):
        """A cavity of N voxels is filled, one of N + 1 is not."""
        labels = ball()
        labels[10, 10:13, 10:13] = 0
        labels[20, 18:20, 10:15] = 0
        filled = ball()
        self.check_same(self.repaired(labels, FillHoles=8)[0], labels)
        found, rows = self.repaired(labels, FillHoles=9)
        self.assertEqual(found[10, 11, 11], 1)
        self.assertEqual(found[20, 18, 12], 0)
        self.assertEqual(rows, [{"what": "fill-holes", "label": 1, "voxels": 9, "places": 1, "largest": 9, "first": [10, 10, 10],
                                 "last": [12, 12, 10]}])
        found, rows = self.repaired(labels, FillHoles=10)
        self.check_same(found, filled)
        self.assertEqual((rows[0]["voxels"], rows[0]["places"], rows[0]["largest"], rows[0]["first"]), (19, 2, 10, [10, 18, 20]))

    def test_only_what_is_enclosed(self):
        """Not a dent, a cavity at the border of the image, or an island; corners enclose."""
        labels = box()
        labels[5, 10, 10] = 0
        labels[10, 10, 10] = 2
        self.check_same(self.repaired(labels, FillHoles=100)[0], labels)
        labels = numpy.ones((8, 8, 8), dtype=numpy.uint8)
        labels[0, 4, 4] = 0
        self.check_same(self.repaired(labels, FillHoles=100)[0], labels)
        labels[1, 4, 5] = 0  # shares an edge with it
        self.assertEqual(self.repaired(labels, FillHoles=1)[0][1, 4, 5], 1)

    def test_label_of_most_faces(self):
        labels = box()
        labels[:, :, 10:][labels[:, :, 10:] == 1] = 7
        labels[10, 10, 10:12] = 0  # nine faces to 7, one to 1
        found, rows = self.repaired(labels, FillHoles=2)
        self.assertEqual(list(found[10, 10, 10:12]), [7, 7])
        self.assertEqual([(row["label"], row["voxels"]) for row in rows], [(7, 2)])


class Spikes(Repair):
    def test_antenna(self):
        labels = ball()
        labels[14, 14, 20:28] = 1
        found, rows = self.repaired(labels, RemoveSpikes=True)
        self.check_same(found, ball())
        self.assertEqual(rows, [{"what": "remove-spikes", "label": 1, "voxels": 3, "places": 1, "largest": 3, "first": [25, 14, 14],
                                 "last": [27, 14, 14]}])

    def test_what_stays(self):
        """Boxes, sheets, strings between two parts, and labels that are strings."""
        labels = numpy.zeros((30, 30, 30), dtype=numpy.uint8)
        labels[2:8, 2:8, 2:8] = 1
        labels[2:8, 2:8, 15:20] = 1
        labels[5, 5, 8:15] = 1  # a bridge
        labels[8:20, 2:8, 5] = 1  # a sheet
        labels[15:27, 20, 20] = 2
        labels[25, 25, 25] = 3
        labels[20:, 2:8, 20:][:, :, 0] = 4  # to the border
        found, rows = self.repaired(labels, RemoveSpikes=True)
        self.check_same(found, labels)
        self.assertEqual(rows, [])

    def test_arches(self):
        """What touches the rest at two places stays: also at one voxel; what hangs on it does not, and strings to the border."""
        def string(*voxels):
            added = labels.copy()
            for voxel in voxels:
                added[voxel] = 1
            return added

        labels = numpy.zeros((15, 15, 15), dtype=numpy.uint8)
        labels[4:10, 4:10, 4:10] = 1
        arch = [(k, 5, i) for k, i in ((10, 5), (11, 5), (12, 5), (12, 6), (12, 7), (12, 8), (11, 8), (10, 8))]
        edge = [(k, 6, i) for k, i in ((10, 9), (11, 9), (11, 10), (11, 11), (10, 11), (9, 11), (9, 10))]
        border = [(k, 6, 6) for k in range(10, 15)]
        ring = [(10, 5, 5), (11, 5, 5), *((12, j, i) for j in range(4, 7) for i in range(5, 8) if (j, i) != (5, 6))]
        for axes in itertools.permutations(range(3)):
            for flip in (1, -1):
                def turned(image):
                    return image.transpose(axes)[::flip, ::flip, ::flip].copy()

                for stays in (arch, edge, arch + edge):
                    found, rows = self.repaired(turned(string(*stays)), RemoveSpikes=True)
                    self.check_same(found, turned(string(*stays)))
                    self.assertEqual(rows, [])
                twigs = [(13, 5, 6), (10, 5, 10), (11, 5, 9)]  # the last two: a component, and on the arch
                found, rows = self.repaired(turned(string(*arch, *twigs)), RemoveSpikes=True)
                self.check_same(found, turned(string(*arch, twigs[1])))
                self.assertEqual((rows[0]["voxels"], rows[0]["places"]), (2, 2))
                for hangs in (arch[:-1], edge[:-1], border, ring):
                    self.check_same(self.repaired(turned(string(*hangs)), RemoveSpikes=True)[0], turned(labels))
                    self.assertEqual(self.repaired(turned(string(*hangs)), CheckImage=True)[1][0]["what"], "spikes")
        self.assertNotIn("spikes", [row["what"] for row in self.repaired(string(*arch), CheckImage=True)[1]])

    def test_diagonal_sheet(self):
        i, j, k = numpy.mgrid[:30, :30, :30]
        labels = (((i - k) // 2 == 0) & (j > 3) & (j < 26)).astype(numpy.uint8)
        labels[:12] = 1  # what it hangs on
        self.check_same(self.repaired(labels, RemoveSpikes=True)[0], labels)

    def test_label_around(self):
        """A spike into another label becomes that, voxel by voxel."""
        labels = box()
        labels[15:, :, :] = 2
        labels[15:18, 10, 10] = 1
        found, _ = self.repaired(labels, RemoveSpikes=True)
        self.assertEqual(list(found[14:19, 10, 10]), [1, 2, 2, 2, 2])
        labels = box()
        labels[15:17, :, :] = 2
        labels[15:20, 10, 10] = 1
        self.assertEqual(list(self.repaired(labels, RemoveSpikes=True)[0][14:20, 10, 10]), [1, 2, 2, 0, 0, 0])

    def test_noise_loses_no_component(self):
        labels = numpy.random.RandomState(3).randint(0, 3, (40, 40, 40)).astype(numpy.uint8)
        found, rows = self.repaired(labels, RemoveSpikes=True)
        self.assertEqual(sum(row["voxels"] for row in rows), numpy.count_nonzero(found != labels))
        for label in (1, 2):
            before, count = ndimage.label(labels == label)
            kept = set(numpy.unique(before[found == label]))
            self.assertEqual(set(range(1, count + 1)) - kept, set())


class Thickness(Repair):
    def test_sheet(self):
        """From one voxel to at least so many; the middle stays where it is."""
        labels = numpy.zeros((20, 40, 40), dtype=numpy.uint8)
        labels[10, 5:35, 5:35] = 1
        for length, voxels in ((1, 1), (1.01, 3), (2, 3), (3, 3), (3.01, 5), (5, 5)):
            found, rows = self.repaired(labels, MinimumThickness={1: length})
            where = numpy.flatnonzero(found[:, 20, 20])
            self.assertEqual((len(where), where.mean()), (voxels, 10), length)
            self.assertEqual(rows[0]["voxels"], numpy.count_nonzero(found != labels))
            self.assertTrue((found >= labels).all())

    def test_two_voxels(self):
        """What is thick enough stays as it is; from an even number of voxels to an even number."""
        labels = numpy.zeros((20, 40, 40), dtype=numpy.uint8)
        labels[9:11, 5:35, 5:35] = 1
        for length, voxels in ((2, 2), (2.01, 4), (4, 4), (6, 6)):
            found, _ = self.repaired(labels, MinimumThickness={1: length})
            self.assertEqual(numpy.count_nonzero(found[:, 20, 20]), voxels, length)

    def test_thick_parts_stay(self):
        """Corners, bumps and spheres are not thin."""
        labels = box(40, 10)
        labels[9, 20, 20] = 1
        self.check_same(self.repaired(labels, MinimumThickness={1: 6})[0], labels)
        self.check_same(self.repaired(ball(12, 40), MinimumThickness={1: 6})[0], ball(12, 40))

    def test_sheet_on_a_box(self):
        labels = numpy.zeros((60, 30, 60), dtype=numpy.uint8)
        labels[:40, 5:25, 5:25] = 1
        labels[10, 5:25, 25:55] = 1
        found, _ = self.repaired(labels, MinimumThickness={1: 3})
        self.assertEqual({numpy.count_nonzero(found[5:16, 15, i]) for i in range(30, 54)}, {3})
        self.check_same(found[:, :, :20], labels[:, :, :20])

    def test_across_blocks(self):
        """Larger than the blocks that it is computed in; a sheet is beside the border of one."""
        labels = numpy.zeros((20, 30, 150), dtype=numpy.uint8)
        labels[4:16, 4:26, 8:140:10] = 1
        found, rows = self.repaired(labels, MinimumThickness={1: 5})
        expected = ndimage.binary_dilation(labels[10, 15], iterations=2)
        self.check_same(found[10, 15], expected)
        self.assertEqual(rows[0]["places"], 14)

    def test_spacing_and_direction(self):
        """Lengths are in the world's unit, and axes may be turned."""
        for axis, voxels in ((0, 3), (1, 5), (2, 3)):  # z, y, x
            labels = numpy.zeros((40, 40, 40), dtype=numpy.uint8)
            where = [slice(8, 32)] * 3
            where[axis] = 20
            labels[tuple(where)] = 1
            for direction in (numpy.eye(3), [[0, 0, 1], [1, 0, 0], [0, 1, 0]], [[0.8, -0.6, 0], [0.6, 0.8, 0], [0, 0, 1]]):
                place = {"spacing": (1.0, 0.5, 2.0), "direction": direction}
                found, _ = self.repaired(labels, place, MinimumThickness={1: 2.5})
                middle = [20] * 3
                middle[axis] = slice(None)
                self.assertEqual(numpy.count_nonzero(found[tuple(middle)]), voxels, axis)

    def test_oblique_sheet(self):
        """Its mean thickness: volume over area."""
        i, j, k = numpy.mgrid[:60, :60, :60] - 29.27
        height = abs(i + j + k) / 3 ** 0.5
        around = numpy.sqrt(numpy.maximum(i * i + j * j + k * k - height ** 2, 0))
        labels = ((height < 0.9) & (around < 20)).astype(numpy.uint8)
        found, _ = self.repaired(labels, MinimumThickness={1: 4})
        thickness = 12 * numpy.count_nonzero(found[around < 12]) / numpy.count_nonzero((height < 6) & (around < 12))
        self.assertGreater(thickness, 3.8)
        self.assertLess(thickness, 4.6)

    def test_others(self):
        """They lose voxels, but no component, and none to a label with a thickness of their own."""
        labels = numpy.zeros((20, 40, 40), dtype=numpy.uint8)
        labels[10, 5:35, 5:35] = 1
        labels[11:, :, :20] = 2
        labels[9, 30, 30] = 3
        found, _ = self.repaired(labels, MinimumThickness={1: 3})
        self.assertEqual(list(found[9:12, 20, 10]), [1, 1, 1])
        self.assertEqual(found[9, 30, 30], 3)
        found, rows = self.repaired(labels, MinimumThickness={1: 3, 2: 1})
        self.assertEqual(list(found[9:12, 20, 10]), [1, 1, 2])
        self.assertEqual([(row["label"], row["voxels"] > 0) for row in rows], [(1, True), (2, False)])


    def test_free_side(self):
        """Where a label has to stay, the other side grows: another thickened one, or a component that would be lost."""
        for axes in itertools.permutations(range(3)):
            spacing = [(1.0, 1.0, 1.0), (1.0, 0.5, 2.0)][axes[0] == 2]
            unit = spacing[2 - axes.index(0)]  # along the first axis of `labels`
            for wanted in (1.01, 2, 3, 4.5, 6):
                for lengths in ({1: wanted, 2: wanted}, {1: wanted}):
                    labels = numpy.zeros((30, 24, 24), dtype=numpy.uint8)
                    labels[14, 2:-2, 2:-2] = 1
                    labels[15][(slice(2, -2) if 2 in lengths else slice(8, -8),) * 2] = 2
                    repair = filter_of(voxplex.Image(labels.transpose(axes).copy(), spacing=spacing).to_vtk(),
                                       MinimumThickness={label: length * unit for label, length in lengths.items()})
                    repair.Update()
                    found = array_of(repair.GetOutput(), labels.transpose(axes)).transpose(numpy.argsort(axes))
                    self.assertEqual(numpy.flatnonzero(found[:, 12, 12] == 1).tolist(), list(range(15 - math.ceil(wanted), 15)))
                    thickness = math.ceil(wanted) if 2 in lengths else 1
                    self.assertEqual(numpy.flatnonzero(found[:, 12, 12] == 2).tolist(), list(range(15, 15 + thickness)))
                    self.assertEqual(repair.GetNumberOfWarnings(), 0)
                    self.assertNotIn("more", repair.GetReport())

    def test_what_stays_thinner(self):
        """Between labels that have to stay, and where the free side ends; the growth does not follow a crack."""
        labels = numpy.zeros((20, 24, 60), dtype=numpy.uint8)
        labels[2:10, :, 4:-4] = 1
        labels[11:19, :, 4:-4] = 2
        labels[10, :, 4:14] = 3
        repair = filter_of(voxplex.Image(labels).to_vtk(), MinimumThickness={1: 1.0, 2: 1.0, 3: 4.0})
        repair.Update()
        found = array_of(repair.GetOutput(), labels)
        self.assertFalse((found[10, :, 20:] == 3).any())
        row = json.loads(repair.ToJSON())[-1]
        self.assertGreater(row["left_out"], 100)
        self.assertEqual(repair.GetNumberOfWarnings(), 1)
        self.assertRegex(repair.GetWarning(0), f"label 3 stays thinner than 4, .* {row['left_out']} voxels")
        self.assertIn(f", {row['left_out']} more would cross labels that have to stay", repair.GetReport())
        self.assertEqual(repair.GetReportTable().GetColumnByName("LeftOut").GetValue(2), row["left_out"])

    def test_others_that_stay(self):
        """Neither pieces beyond a label that would lose all, nor beyond one that is thickened itself."""
        core = numpy.where(ball(9, 40) > 0, 3, 0) + 4 * ball(4, 40)
        found, rows = self.repaired(core, MinimumThickness={7: 20.0})
        self.check_same(found, core)
        self.assertEqual(rows[0]["voxels"], 0)
        repair = filter_of(voxplex.Image(core).to_vtk(), MinimumThickness={7: 20.0})
        repair.Update()
        self.assertRegex(repair.GetReport(), r": 0 voxels, \d+ more would cross labels that have to stay\n$")
        sheets = numpy.zeros((20, 20, 20), numpy.uint8)
        sheets[10] = 1
        sheets[11] = 2
        found, _ = self.repaired(sheets, MinimumThickness={1: 5.0, 2: 5.0})
        self.assertEqual(list(found[:, 10, 10][8:14]), [1, 1, 1, 2, 2, 2])


class Shells(Repair):
    def test_against_scipy(self):
        rng = numpy.random.RandomState(2)
        seeds = ndimage.gaussian_filter(rng.rand(50, 80, 150), 5)
        labels = (seeds > numpy.percentile(seeds, 90)).astype(numpy.uint8)
        labels[25:][labels[25:] == 1] = 4
        for spacing in ((1.0, 1.0, 1.0), (0.7, 1.1, 2.3)):
            place = {"spacing": spacing}
            found, rows = self.repaired(labels, place, Shell={1: 4.0})
            self.check_same(found, numpy.where((labels == 0) & near(labels == 1, spacing, 4.0), 5, labels))
            self.assertEqual((rows[0]["what"], rows[0]["label"], rows[0]["new_label"]), ("shell", 1, 5))
            self.assertEqual(rows[0]["left_out"], numpy.count_nonzero((labels == 4) & near(labels == 1, spacing, 4.0)))
            found, _ = self.repaired(labels, place, Shell={1: -3.0})
            self.check_same(found, numpy.where((labels == 1) & near(labels != 1, spacing, 3.0), 5, labels))

    def test_thickness(self):
        """Closed if at least half a voxel thick, and up to half a voxel thicker than asked, whatever the order of axes."""
        for spacing, thickness in (((1.0, 1.0, 1.0), 2.0), ((0.7, 0.7, 0.7), 2.0), ((0.5, 0.5, 3.0), 2.0), ((0.5, 0.5, 3.0), 1.5),
                                   ((0.7, 0.7, 2.5), 2.0), ((0.4, 1.0, 2.5), 3.0), ((1.0, 3.0, 3.0), 2.0)):
            size = numpy.array([round(34 / length) for length in spacing[::-1]])
            where = (numpy.indices(size).T - (size - 1) / 2).T * numpy.array(spacing[::-1])[:, None, None, None]
            labels = (numpy.linalg.norm(where, axis=0) <= 10.0).astype(numpy.uint8)
            first = None
            for axes in itertools.permutations(range(3)):
                turned = labels.transpose(axes)
                lengths = [spacing[2 - axis] for axis in axes][::-1]
                place = {"spacing": lengths, "direction": [[0.8, -0.6, 0], [0.6, 0.8, 0], [0, 0, 1]]}
                found, _ = self.repaired(turned, place, Shell={1: thickness})
                self.assertFalse((ndimage.binary_dilation(found == 1, numpy.ones((3, 3, 3))) & (found == 0)).any(), (spacing, axes))
                first = found if first is None else first
                self.check_same(found, first.transpose(axes))
                found, _ = self.repaired(turned, place, Shell={1: -thickness})
                self.assertFalse((ndimage.binary_dilation(found == 1, numpy.ones((3, 3, 3))) & (found == 0)).any(), (spacing, axes))
            volume = numpy.array([(first == 1).sum(), (first > 0).sum()]) * numpy.prod(spacing)
            inner, outer = numpy.cbrt(volume * 3 / 4 / numpy.pi)
            self.assertGreater(outer - inner, thickness)
            self.assertLess(outer - inner - thickness, max(spacing) / 2)

    def test_thinner_than_voxels(self):
        """What the label still touches is told: background, and inside of a shell all others."""
        labels = ball(9, 30)
        labels[:, :, 20:][labels[:, :, 20:] == 1] = 2
        for axis, spacing in enumerate(((1.0, 1.0, 4.0), (1.0, 4.0, 1.0), (4.0, 1.0, 1.0))):
            for thickness in (1.9, -1.9):
                repair = filter_of(voxplex.Image(labels, spacing=spacing).to_vtk(), Shell={1: thickness})
                repair.Update()
                found = array_of(repair.GetOutput(), labels)
                touching = faces(found == 1, found == 0) + (faces(found == 1, found == 2) if thickness < 0 else 0)
                self.assertGreater(touching, 0, axis)
                self.assertEqual(json.loads(repair.ToJSON())[0]["touching_faces"], touching)
                self.assertEqual(repair.GetNumberOfWarnings(), 1)
                self.assertRegex(repair.GetWarning(0), f"label 1 still touches .* at {touching} faces .* From 2 on it is closed")
                self.assertEqual(repair.GetReportTable().GetColumnByName("TouchingFaces").GetValue(0), touching)
                repair = filter_of(voxplex.Image(labels, spacing=spacing).to_vtk(), Shell={1: thickness / 1.9 * 2})
                repair.Update()
                self.assertEqual(repair.GetNumberOfWarnings(), 0)

    def test_shared_gap(self):
        """Two shells share what is between their labels by their thicknesses; what each lacks is told."""
        for gap, lengths, parts in ((6, (4, 4), (3, 3)), (8, (4, 4), (4, 4)), (7, (4, 4), (4, 3)), (6, (2, 4), (2, 4)), (6, (8, 4), (4, 2)),
                                    (6, (1e300, 1e300), (3, 3))):
            labels = numpy.zeros((14, 14, 40), dtype=numpy.uint8)
            labels[4:-4, 4:-4, 10:12] = 1
            labels[4:-4, 4:-4, 12 + gap:14 + gap] = 2
            found, rows = self.repaired(labels, Shell=dict(zip((1, 2), lengths)))
            self.assertEqual(tuple(numpy.count_nonzero(found[7, 7, 12:12 + gap] == shell) for shell in (3, 4)), parts)
            if gap == 6 and lengths == (4, 4):
                self.check_same(found[:, :, :30], numpy.array([0, 2, 1, 4, 3])[found[:, :, 29::-1]])
            for row, length in zip(rows, lengths):
                alone = self.repaired(labels, Shell={row["label"]: length})[1][0]
                self.assertEqual(row["voxels"] + row.get("left_out", 0), alone["voxels"] + alone.get("left_out", 0))
        labels = numpy.zeros((12, 12, 12), dtype=numpy.uint8)
        labels[4:-4, 4:-4, 4] = 1
        labels[4:-4, 4:-4, 6] = 2
        repair = filter_of(voxplex.Image(labels).to_vtk(), Shell={1: 2, 2: 2})
        repair.Update()
        self.assertEqual(repair.GetNumberOfWarnings(), 1)
        self.assertRegex(repair.GetWarning(0), "label 2 still touches .* at 16 faces .* gap")
        self.assertIn(" more have other labels", repair.GetReport())

    def test_types_and_numbers(self):
        for kind, label in ((numpy.float32, 2 ** 24), (numpy.float64, 2 ** 53), (numpy.int64, 2 ** 62)):
            found, _ = self.repaired((box() * label).astype(kind), Shell={label: 1.0})
            self.assertEqual(set(numpy.unique(found)), {0, label, label + 1})
        for properties, why in (({"Shell": {2 ** 63 - 1: 1.0}}, "no label above 9223372036854775807"),
                                ({"Shell": {2 ** 63 - 1: 1.0}, "FirstShellLabel": 5}, "the new label 5 is in the image")):
            labels = box().astype(numpy.int64) * (2 ** 63 - 1)
            labels[0, 0, 0] = 5
            repair = filter_of(voxplex.Image(labels).to_vtk(), **properties)
            repair.Update()
            self.assertIn(why, repair.GetErrorMessage())

    def test_progress(self):
        repair = filter_of(voxplex.Image(box()).to_vtk(), FillHoles=1, MinimumThickness={1: 3.0}, Shell={1: 1.0}, CheckImage=True)
        said = []
        repair.AddObserver("ProgressEvent", lambda *_: said.append(repair.GetProgress()))
        repair.Update()
        self.assertEqual((sorted(said), max(said)), (said, 1.0))

    def test_all_of_a_label(self):
        repair = filter_of(voxplex.Image(box()).to_vtk(), Shell={1: -50.0})
        repair.Update()
        self.assertIn("became label 2, all that it had, at (", repair.GetReport())

    def test_at_the_border(self):
        for length, is_cut in ((4.0, False), (5.0, True)):
            repair = filter_of(voxplex.Image(box()).to_vtk(), Shell={1: length})
            repair.Update()
            self.assertEqual("became label 2, cut at the border of the image, at (" in repair.GetReport(), is_cut)

    def test_numbers_and_names(self):
        """Above all labels and names; what has no name gets none, and no colour."""
        labels = box()
        labels[:, :, 10:][labels[:, :, 10:] == 1] = 3
        image = voxplex.Image(labels)
        image.names = {1: "Bone", 9: "Elsewhere"}
        data = image.to_vtk()
        add_array(data.GetFieldData(), "LabelColors", numpy.array([[1.0, 0, 0], [0, 1, 0]]))
        repair = filter_of(data, Shell={1: 1, 3: -1})
        repair.Update()
        fields = repair.GetOutput().GetFieldData()
        names = fields.GetAbstractArray("LabelNames")
        self.assertEqual(list(vtk_to_numpy(fields.GetArray("LabelValues"))), [1, 9, 10])
        self.assertEqual([names.GetValue(i) for i in range(3)], ["Bone", "Elsewhere", "Bone shell"])
        numpy.testing.assert_array_equal(vtk_to_numpy(fields.GetArray("LabelColors"))[2], [numpy.nan] * 3)
        self.assertEqual(data.GetFieldData().GetAbstractArray("LabelNames").GetNumberOfValues(), 2)
        found = array_of(repair.GetOutput(), labels)
        self.assertEqual(set(numpy.unique(found)), {0, 1, 3, 10, 11})
        self.assertIn("shell: label 1 (Bone): ", repair.GetReport())
        self.assertIn("became label 10, at (4-10, 4-15, 4-15)", repair.GetReport())

    def test_all_of_it(self):
        """A thickness beyond the image."""
        labels = box()
        self.check_same(self.repaired(labels, Shell={1: 1e300})[0], numpy.where(labels == 0, 2, 1))
        self.check_same(self.repaired(labels, Shell={1: -50})[0], 2 * labels)

    def test_type(self):
        labels = numpy.where(box() == 1, 255, 0).astype(numpy.uint8)
        found, _ = self.repaired(labels, Shell={255: 1})
        self.assertEqual((found.dtype, found.max()), (numpy.uint16, 256))


class Check(Repair):
    def test_each_kind(self):
        labels = numpy.zeros((40, 40, 40), dtype=numpy.uint8)
        labels[5:15, 5:15, 5:15] = 1
        labels[8, 8, 8:10] = 0  # a cavity
        labels[15:18, 10, 10] = 1  # a spike
        labels[25:27, 5:15, 5:15] = 1  # a component
        labels[36, 36, 36] = 1  # a crumb
        labels[30, 20:30, 20:30] = 2  # thin
        labels[31:33, 30:32, 30:32] = 2  # shares a corner
        labels[0, 30:32, 5] = 4
        image = voxplex.Image(labels)
        image.names = {1: "Bone", 2: "Skin", 8: "Lost"}
        repair = filter_of(image.to_vtk(), CheckImage=True)
        repair.Update()
        found = [(row["what"], row["label"], row["voxels"], row["places"], row["first"]) for row in json.loads(repair.ToJSON())]
        self.assertEqual(found, [
            ("components", 1, 200, 1, [5, 5, 25]), ("components", 2, 8, 1, [30, 30, 31]), ("crumbs", 1, 1, 1, [36, 36, 36]),
            ("cavities", 1, 2, 1, [8, 8, 8]), ("spikes", 1, 3, 1, [10, 10, 15]), ("thin", 1, 4, 2, [10, 10, 15]),
            ("thin", 2, 100, 1, [20, 20, 30]), ("thin", 4, 2, 1, [5, 30, 0]), ("contacts", 2, 1, 1, [29, 29, 30]),
            ("border", 4, 2, 2, [5, 30, 0]), ("absent", 8, 0, 0, [0, 0, 0]), ("unnamed", 4, 2, 2, [5, 30, 0])])
        self.check_same(array_of(repair.GetOutput(), labels), labels)
        self.assertIn("absent: label 8 (Lost): 0 voxels\n", repair.GetReport())
        table = repair.GetReportTable()
        self.assertEqual(table.GetNumberOfRows(), len(found))
        self.assertEqual(table.GetColumnByName("Name").GetValue(0), "Bone")
        self.assertEqual(table.GetColumnByName("First").GetTuple3(0), (5.0, 5.0, 25.0))

    def test_nothing(self):
        self.assertEqual(self.repaired(ball(), CheckImage=True)[1], [])

    def test_necks_and_gaps(self):
        """Two cubes on a neck of 2 x 2 voxels, and one that is a voxel away."""
        labels = numpy.zeros((24, 24, 40), dtype=numpy.uint8)
        labels[8:14, 8:14, 4:10] = labels[8:14, 8:14, 14:20] = 1
        labels[10:12, 10:12, 10:14] = 1
        labels[8:14, 8:14, 21:27] = 2
        found = [(row["what"], row["label"], row["voxels"], row["first"], row["last"])
                 for row in self.repaired(labels, CheckImage=True)[1]]
        self.assertEqual(found, [("necks", 1, 16, [10, 10, 10], [13, 11, 11]), ("gaps", 1, 36, [20, 8, 8], [20, 13, 13]),
                                 ("gaps", 2, 36, [20, 8, 8], [20, 13, 13])])
        labels[9:13, 9:13, 10:14] = 1
        labels[:, :, 20] = 0
        labels[8:14, 8:14, 21] = 0
        self.assertEqual(self.repaired(labels, CheckImage=True)[1], [])

    def test_many_labels(self):
        labels = numpy.zeros((3, 3, 25), numpy.uint8)
        labels[0, 0] = range(1, 26)
        repair = filter_of(voxplex.Image(labels).to_vtk(), CheckImage=True)
        repair.Update()
        lines = [line for line in repair.GetReport().splitlines() if line.startswith("border")]
        self.assertEqual(lines[19:], ["border: label 20: 1 voxel, at (19, 0, 0)", "border: 5 more labels"])
        self.assertEqual([row["what"] for row in json.loads(repair.ToJSON())].count("border"), 25)

    def test_frame_without_labels(self):
        repair = filter_of(voxplex.Image(numpy.zeros((5, 5, 5), numpy.uint8)).to_vtk(), CheckImage=True)
        repair.Update()
        self.assertIn("no foreground", repair.GetErrorMessage())

    def test_edges(self):
        """Voxels that share an edge only; beside a third one they are no contact."""
        labels = numpy.zeros((12, 12, 12), dtype=numpy.uint8)
        labels[2:6, 2:6, 2:6] = 1
        labels[2:6, 6:10, 6:10] = 1
        contacts = [row for row in self.repaired(labels, CheckImage=True)[1] if row["what"] == "contacts"]
        self.assertEqual([row["voxels"] for row in contacts], [4])
        labels[2:6, 6, 5] = 1
        self.assertNotIn("contacts", [row["what"] for row in self.repaired(labels, CheckImage=True)[1]])


class Together(Repair):
    def test_order(self):
        """Holes first, then spikes, thickness, shells; the input stays as it is."""
        labels = ball()
        labels[14, 14, 14] = 0
        labels[14, 14, 20:28] = 1
        image = voxplex.Image(labels).to_vtk()
        repair = filter_of(image, Shell={1: 1}, MinimumThickness={1: 2}, RemoveSpikes=True, FillHoles=1, CheckImage=True)
        repair.Update()
        self.assertEqual([row["what"] for row in json.loads(repair.ToJSON())][:4],
                         ["fill-holes", "remove-spikes", "min-thickness", "shell"])
        self.check_same(array_of(repair.GetOutput(), labels) == 1, ball() == 1)
        self.check_same(array_of(image, labels), labels)
        repair.ClearShells()
        repair.ClearMinimumThicknesses()
        repair.CheckImageOff()
        repair.Update()
        self.check_same(array_of(repair.GetOutput(), labels), ball())

    def test_idle(self):
        image = voxplex.Image(ball()).to_vtk()
        repair = filter_of(image)
        repair.Update()
        self.assertEqual(repair.GetOutput().GetPointData().GetScalars(), image.GetPointData().GetScalars())
        self.assertEqual((repair.GetReport(), repair.GetReportTable().GetNumberOfRows()), ("", 0))

    def test_cells(self):
        labels = ball()
        labels[14, 14, 14] = 0
        image = voxplex.Image(numpy.zeros((31, 31, 31), dtype=numpy.uint8)).to_vtk()
        add_array(image.GetCellData(), "Tissue", labels.ravel())
        repair = filter_of(image, FillHoles=1)
        repair.SetInputArrayToProcess(0, 0, 0, 1, "Tissue")
        repair.Update()
        found = vtk_to_numpy(repair.GetOutput().GetCellData().GetArray("Tissue")).reshape(labels.shape)
        self.check_same(found, ball())

    def test_threads(self):
        labels = numpy.random.RandomState(5).randint(0, 3, (30, 30, 30)).astype(numpy.uint8)
        results = [self.repaired(labels, NumberOfThreads=threads, FillHoles=5, RemoveSpikes=True, MinimumThickness={1: 2},
                                 Shell={2: -1}, CheckImage=True) for threads in (1, 3)]
        self.check_same(results[0][0], results[1][0])
        self.assertEqual(results[0][1], results[1][1])

    def test_series(self):
        """Each frame alone; a label may be missing, and a frame empty."""
        frames = numpy.stack([ball(8), numpy.zeros_like(ball()), 3 * ball(6)])
        frames[0, 14, 14, 14] = 0
        source = series(frames, [0.0, 1.0, 2.0])
        repair = voxplex.vtkSegmentationRepair()
        repair.SetInputConnection(source.GetOutputPort())
        repair.SetFillHoles(1)
        repair.SetShell(3, 1.0)
        repair.SetFirstShellLabel(300)
        for time, labels in ((0.0, {0, 1}), (1.0, {0}), (2.0, {0, 3, 300})):
            repair.UpdateTimeStep(time)
            self.assertEqual(repair.GetErrorMessage(), "")
            found = array_of(repair.GetOutput(), frames[0])
            self.assertEqual((set(numpy.unique(found)), found.dtype), (labels, numpy.uint16))

    def test_announced_type(self):
        """The type of the output, where it is known: after the highest label it is not."""
        image = voxplex.Image(ball()).to_vtk()
        for properties, announced in (({"FillHoles": 1}, "unsigned char"), ({"Shell": {1: 2}}, None), ({}, "unsigned char"),
                                      ({"Shell": {1: 2}, "FirstShellLabel": 200}, "unsigned char"),
                                      ({"Shell": {1: 2}, "FirstShellLabel": 256}, "unsigned short"),
                                      ({"Shell": {1: 2}, "FirstShellLabel": 1 << 40}, "long long")):
            repair = filter_of(image, **properties)
            repair.UpdateInformation()
            information = repair.GetOutputInformation(0)
            told = vtkImageData.GetScalarType(information) if vtkImageData.HasScalarType(information) else None
            self.assertEqual(told and vtkImageScalarTypeNameMacro(told), announced)
            repair.Update()
            self.assertIn(repair.GetOutput().GetScalarTypeAsString(), (announced, "unsigned char")[:1 if announced else 2])

    def test_lists(self):
        repair = filter_of(voxplex.Image(ball()).to_vtk(), Shell={3: 1.0, 1: 2.0}, MinimumThickness={2: 4.0})
        self.assertEqual([repair.GetShelledLabel(i) for i in range(-1, repair.GetNumberOfShells() + 1)], [0, 1, 3, 0])
        self.assertEqual((repair.GetNumberOfMinimumThicknesses(), repair.GetThickenedLabel(0)), (1, 2))
        repair.RemoveShell(3)
        repair.RemoveMinimumThickness(2)
        self.assertEqual((repair.GetNumberOfShells(), repair.GetShell(3), repair.GetNumberOfMinimumThicknesses()), (1, 0, 0))

    def test_errors(self):
        image = voxplex.Image(ball()).to_vtk()
        for properties, message in (
                ({"FillHoles": -1}, "FillHoles is -1"), ({"Shell": {1: 0}}, "Shell.* of label 1 is 0; it must be finite, and not 0"),
                ({"MinimumThickness": {1: -2}}, "MinimumThickness.* of label 1 is -2; it must be positive"),
                ({"MinimumThickness": {7: 2}}, "MinimumThickness.* the image has no label 7; it has 1"),
                ({"Shell": {0: 2}}, "0 is not a label"), ({"NumberOfThreads": -1, "CheckImage": True}, "not be negative")):
            repair = filter_of(image, **properties)
            errors = errors_of(repair)
            repair.Update()
            self.assertRegex(repair.GetErrorMessage(), message)
            self.assertEqual(len(errors), 1)
            self.assertEqual(repair.GetOutput().GetNumberOfPoints(), 0)
        repair = filter_of(components([ball(), ball()]), FillHoles=1)
        errors_of(repair)
        repair.Update()
        self.assertRegex(repair.GetErrorMessage(), "2 components.*steps of time")

    def test_abort(self):
        repair = filter_of(voxplex.Image(ball()).to_vtk(), FillHoles=1)
        repair.AddObserver("ProgressEvent", lambda caller, event: caller.SetAbortExecute(1))
        repair.Update()
        self.assertEqual((repair.GetErrorMessage(), repair.GetOutput().GetNumberOfPoints()), ("", 0))


if __name__ == "__main__":
    unittest.main()
