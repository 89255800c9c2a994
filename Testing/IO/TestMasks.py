#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Many masks, and segments in layers, as one label image: beside what NumPy makes of them."""
import importlib.util
import itertools
import os
import re
import unittest
from collections import Counter
from pathlib import Path

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import (
    vtkCompositeDataSet, vtkImageData, vtkMultiBlockDataSet, vtkPartitionedDataSetCollection, vtkPolyData)
from vtkmodules.vtkCommonExecutionModel import vtkTrivialProducer

import images
import matrix.metaimage
import matrix.mgh
import matrix.nifti
import meshfiles
import TestTIFF
import voxplex
from iotesting import FolderTestCase, table_of, warnings_of

try:
    import nibabel
except ModuleNotFoundError:
    nibabel = None

EXAMPLE = Path(__file__).resolve().parents[2] / "Examples" / "Python" / "mesh_masks.py"
SMALLEST, ORDER = 0, 1


def voxels(image):
    """Indexed [k, j, i]."""
    return vtk_to_numpy(image.GetPointData().GetArray("Labels")).reshape(image.GetDimensions()[::-1])


def places_of(image):
    """Of the first and of the last voxel."""
    return image.GetPoint(0), image.GetPoint(image.GetNumberOfPoints() - 1)


def natural(name):
    return [int(part) if part.isdigit() else part for part in re.split(r"(\d+)", name)]


def combined(masks, rule):
    """Labels of boolean arrays: what comes last is painted first."""
    sizes = [mask.sum() for mask in masks]
    order = sorted(range(len(masks)), key=lambda n: (sizes[n], n) if rule == SMALLEST else n)
    labels = np.zeros(masks[0].shape, dtype=np.uint16)
    for number in reversed(order):
        labels[masks[number]] = number + 1
    return labels


def box(shape, *ranges):
    array = np.zeros(shape, dtype=np.uint8)
    array[tuple(slice(*one) for one in ranges)] = 1
    return array


class MaskTestCase(FolderTestCase):
    def execute(self, paths, **properties):
        reader = voxplex.vtkSegmentationReader()
        for path in paths:
            reader.AddFileName(path)
        for name, value in properties.items():
            getattr(reader, "Set" + name)(value)
        reader.Update()
        return reader

    def read_masks(self, paths, **properties):
        """A reader that has executed without an error."""
        reader = self.execute(paths, **properties)
        self.assertEqual(reader.GetErrorMessage(), "")
        return reader

    def masks_refused(self, pattern, paths, **properties):
        reader = self.execute(paths, **properties)
        self.assertRegex(reader.GetErrorMessage(), pattern)
        self.assertEqual(reader.GetOutput().GetNumberOfPoints(), 0)

    def write(self, **arrays):
        return [images.write_nrrd(self.folder / f"{name}.nrrd", array) for name, array in arrays.items()]


class WholeBody(MaskTestCase):
    """The example's 100 ellipsoids."""

    @classmethod
    def setUpClass(cls):
        spec = importlib.util.spec_from_file_location("mesh_masks", EXAMPLE)
        cls.phantom = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(cls.phantom)
        cls.masks = {name: cls.phantom.inside(centre, radii) for name, centre, radii in cls.phantom.structures()}
        cls.names = sorted(cls.masks, key=natural)

    def test_folder(self):
        self.assertEqual(len(self.masks), 100)
        self.phantom.write_phantom(self.folder)
        for name in ("report.json", "volumes.csv", ".hidden.txt"):
            (self.folder / name).write_text("{}")
        (self.folder / "deeper").mkdir()
        masks = [self.masks[name] for name in self.names]
        for rule, word in ((SMALLEST, "smallest"), (ORDER, "first")):
            reader = self.reader(self.folder, Overlap=rule)
            self.assertEqual(reader.GetErrorMessage(), "")
            labels = voxels(reader.GetOutput())
            np.testing.assert_array_equal(labels, combined(masks, rule))
            self.assertEqual({label: name for label, (name, _) in table_of(reader.GetOutput()).items()},
                             {n + 1: name for n, name in enumerate(self.names) if n + 1 in labels})
            told = warnings_of(reader)
            self.assertEqual(told[0], f"{self.folder}: left out what is no image, or a mask only if it is named: report.json, volumes.csv")
            self.check_overlaps(told[1], masks, word)
            hidden = [name for n, name in enumerate(self.names) if n + 1 not in labels]
            self.assertEqual(told[2:], [f"masks of which overlaps leave no voxel: {', '.join(hidden)}"] if hidden else [])
            self.assertEqual(bool(hidden), rule == ORDER)

    def check_overlaps(self, warning, masks, word):
        shared = Counter({(a, b): int((masks[a] & masks[b]).sum()) for a, b in itertools.combinations(range(100), 2)})
        pairs = [(pair, count) for pair, count in shared.most_common() if count]
        total = int((np.sum(masks, axis=0) > 1).sum())
        text = ", ".join(f"{self.names[a]} and {self.names[b]} ({count})" for (a, b), count in pairs[:5])
        self.assertEqual(warning, f"masks overlap in {total} voxels, which the {word} of them gets: {text}, "
                                  f"{len(pairs) - 5} more")


@unittest.skipIf(nibabel is None, "nibabel was not found (apt-get install python3-nibabel)")
class Grids(MaskTestCase):
    """Oblique masks of nibabel's, each with a grid of its own."""

    TURN = np.array([[0.8, -0.6, 0], [0.48, 0.64, -0.6], [0.36, 0.48, 0.8]])
    GRIDS = {  # sizes, spacing, direction, origin: that of the heart has the smallest voxels
        "liver": ((30, 28, 24), (1.9, 2.1, 2.3), np.eye(3), (-11.3, 8.7, 20.2)),
        "heart": ((41, 37, 44), (1.1, 1.2, 1.3), TURN, (-14.1, 12.4, 3.3)),
        "body": ((26, 40, 33), (2.5, 1.6, 1.7), TURN @ np.diag([-1, 1, -1]), (21.06, -2.484, 48.612)),
    }
    BALLS = {"liver": ((6.0, 28.0, 44.0), 11.0), "heart": ((-9.0, 20.0, 44.0), 9.0), "body": ((-8.0, 20.0, 40.0), 24.0)}

    def affine(self, name):
        _, spacing, direction, origin = self.GRIDS[name]
        return np.vstack([np.column_stack([direction @ np.diag(spacing), origin]), [0, 0, 0, 1]])

    def mask(self, name):
        """Indexed [i, j, k]."""
        index = np.moveaxis(np.indices(self.GRIDS[name][0]), 0, -1)
        places = index @ self.affine(name)[:3, :3].T + self.affine(name)[:3, 3]
        centre, radius = self.BALLS[name]
        return np.linalg.norm(places - centre, axis=-1) < radius

    def save(self):
        paths = []
        for name in self.GRIDS:
            paths.append(self.folder / f"{name}.nii.gz")
            nibabel.save(nibabel.Nifti1Image(self.mask(name).astype(np.uint8), self.affine(name)), paths[-1])
        return paths

    def box(self):
        """The first voxel of the box of all, in indices of the heart, and its sizes."""
        ends = []
        for name, (sizes, *_) in self.GRIDS.items():
            corners = np.array(list(itertools.product((0, 1), repeat=3))) * sizes - 0.5
            between = np.linalg.inv(self.affine("heart")) @ self.affine(name)
            ends.append(corners @ between[:3, :3].T + between[:3, 3])
        first = np.ceil(np.min(ends, axis=(0, 1))).astype(int)
        return first, np.floor(np.max(ends, axis=(0, 1))).astype(int) - first + 1

    def nearest(self, name):
        """On that box, indexed [i, j, k]."""
        mask = self.mask(name)
        first, sizes = self.box()
        index = np.moveaxis(np.indices(sizes), 0, -1) + first
        between = np.linalg.inv(self.affine(name)) @ self.affine("heart")
        near = np.rint(index @ between[:3, :3].T + between[:3, 3]).astype(int)
        exists = ((near >= 0) & (near < mask.shape)).all(axis=-1)
        result = np.zeros(sizes, dtype=bool)
        result[exists] = mask[tuple(near[exists].T)]
        return result

    def test_volumes_and_centroids(self):
        masks = [self.nearest(name) for name in self.GRIDS]
        first, sizes = self.box()
        self.assertLess(first.max(), 0)
        for rule in (SMALLEST, ORDER):
            reader = self.read_masks(self.save(), ResampleMasks=True, Overlap=rule, Space=1)
            image = reader.GetOutput()
            self.assertEqual(image.GetDimensions(), tuple(sizes))
            expected = combined(masks, rule)
            labels = voxels(image).T
            affine = self.affine("heart")
            for label in (1, 2, 3):
                theirs, ours = np.argwhere(expected == label), np.argwhere(labels == label)
                self.assertAlmostEqual(len(ours), len(theirs), delta=0.1)
                centroid = [0.0] * 3
                image.TransformContinuousIndexToPhysicalPoint(ours.mean(axis=0).tolist(), centroid)
                truth = affine[:3, :3] @ (theirs.mean(axis=0) + first) + affine[:3, 3]
                self.assertLess(np.linalg.norm(np.linalg.solve(affine[:3, :3], centroid - truth)), 0.1)
            self.assertEqual(len(warnings_of(reader)), 1)  # overlaps
        # Nothing is lost: a coarse mask, whose faces are cut between voxels, keeps its volume.
        count = self.mask("body").sum() * np.prod(self.GRIDS["body"][1]) / np.prod(self.GRIDS["heart"][1])
        self.assertAlmostEqual(masks[2].sum() / count, 1, delta=0.02)

    def test_balls(self):
        """The smallest, which no other cuts, has the volume and the centroid of a ball, too."""
        reader = self.read_masks(self.save(), ResampleMasks=True, Overlap=SMALLEST, Space=1)
        labels = voxels(reader.GetOutput()).T
        centroid = [0.0] * 3
        reader.GetOutput().TransformContinuousIndexToPhysicalPoint(np.argwhere(labels == 2).mean(axis=0).tolist(), centroid)
        np.testing.assert_allclose(centroid, self.BALLS["heart"][0], atol=0.1)
        volume = (labels == 2).sum() * 1.1 * 1.2 * 1.3
        self.assertAlmostEqual(volume / (4 / 3 * np.pi * 9**3), 1, delta=0.01)

    def test_refused(self):
        paths = self.save()
        self.masks_refused("one grid, but '.*liver.nii.gz' has the spacing 1.9 2.1 2.3, and '.*heart.nii.gz' 1.1 1.2 1.3; give "
                           r"ResampleMasksOn\(\) to resample them to the finest grid", paths)

    def test_what_differs(self):
        plain = self.save()[0]
        other = self.folder / "other.nii"
        array = self.mask("liver").astype(np.uint8)
        for what, row, column, value in (("spacing", 0, 0, 1.9005), ("spacing", 0, 0, 1.95), ("direction", 0, 1, 0.002),
                                         ("origin", 1, 3, 8.8)):
            affine = self.affine("liver")
            affine[row, column] = value
            nibabel.save(nibabel.Nifti1Image(array, affine), other)
            if value == 1.9005:
                continue
            self.masks_refused(f"'.*liver.nii.gz' has the {what} .*, and '.*other.nii' ", [plain, other])
        affine = self.affine("liver")
        affine[0, 3] += 0.01
        affine[0, 0] *= 1 + 1e-6
        nibabel.save(nibabel.Nifti1Image(array, affine), other)
        self.assertEqual(len(warnings_of(self.read_masks([plain, other]))), 2)  # overlap, and nothing is left

    def test_in_memory(self):
        """Each from a reader of its own: the same as from files."""
        for properties in ({"Overlap": SMALLEST}, {"Overlap": ORDER, "Space": 1}):
            paths = self.save()
            files = self.read_masks(paths, ResampleMasks=True, **properties)
            joiner = voxplex.vtkMasksToSegmentation()
            joiner.ResampleMasksOn()
            joiner.SetOverlap(properties["Overlap"])
            readers = [voxplex.vtkSegmentationReader() for _ in paths]
            for number, name in enumerate(self.GRIDS):
                readers[number].SetFileName(paths[number])
                readers[number].SetSpace(properties.get("Space", 0))
                joiner.AddInputConnection(readers[number].GetOutputPort())
                joiner.SetMaskName(number, name)
            joiner.Update()
            self.assertEqual(joiner.GetErrorMessage(), "")
            ours, theirs = joiner.GetOutput(), files.GetOutput()
            np.testing.assert_array_equal(voxels(ours), voxels(theirs))
            np.testing.assert_allclose(places_of(ours), places_of(theirs), atol=1e-9)
            self.assertEqual(table_of(ours), table_of(theirs))
            self.assertEqual(meshfiles.texts_of(ours, "SPACE"), meshfiles.texts_of(theirs, "SPACE"))
            self.assertEqual(warnings_of(joiner), warnings_of(files))
        joiner.ResampleMasksOff()
        joiner.Update()
        self.assertRegex(joiner.GetErrorMessage(), "one grid, but mask 'liver' has the spacing .*, and mask 'heart' 1.1 1.2 1.3; "
                                                   r"give ResampleMasksOn\(\)")
        self.assertEqual(joiner.GetOutput().GetNumberOfPoints(), 0)


class Finest(MaskTestCase):
    """Masks with parallel axes, in any order and direction, where each may have the finest spacing of an axis."""

    SHAPE = (24, 30, 36)  # of the finest grid, [k, j, i], with the spacing 1
    CENTRE, RADIUS = np.array((17.3, 14.6, 11.9)), 8.4  # in i, j, k of that grid

    def ball(self, first, steps, sizes):
        """Indexed [k, j, i] of a grid with these steps, whose columns are in the finest indices."""
        index = np.moveaxis(np.indices(sizes[::-1])[::-1], 0, -1)
        return (np.linalg.norm(index @ np.transpose(steps) + first - self.CENTRE, axis=-1) < self.RADIUS).astype(np.uint8)

    def save(self, name, first, steps):
        """Steps along i, j, k of the file, in finest indices, as many as the finest grid holds from the first voxel on."""
        sizes = [int(np.min([(n - 1 - at if step > 0 else at) // abs(step) for n, at, step in
                             zip(self.SHAPE[::-1], first, column) if step])) + 1 for column in np.transpose(steps)]
        steps, turn = np.asarray(steps, float), Grids.TURN
        spacing = np.linalg.norm(steps, axis=0)
        return images.write_nrrd(self.folder / f"{name}.nrrd", self.ball(first, steps, sizes), images.Geometry(
            turn @ first, spacing, turn @ steps / spacing))

    def test_each_axis(self):
        swapped = np.array([[0, -4, 0], [0, 0, 1], [2, 0, 0]])
        for n, (a, b) in enumerate(((np.diag((1, 1, 3)), np.diag((2, 2, 1))), (np.diag((1, 3, 1)), swapped),
                                    (np.diag((4, 1, 2)), np.diag((1, 4, -1))), (np.diag((1, 1, 2)), np.diag((2, 2, 2))))):
            paths = [self.save("a", (0, 0, 0), a), self.save("b", [35 * (b[0].min() < 0), 0, 23 * (b[2].min() < 0)], b)]
            finest = [min(np.linalg.norm(s, axis=0)[np.argmax(abs(s[axis]))] for s in (a, b)) for axis in range(3)]
            for order in (paths, paths[::-1]):
                with self.subTest(n, order=order):
                    image = self.read_masks(order, ResampleMasks=True, Overlap=ORDER).GetOutput()
                    steps = np.reshape([image.GetDirectionMatrix().GetElement(r, c) for r in range(3) for c in range(3)],
                                       (3, 3)) * image.GetSpacing()
                    inFinest = Grids.TURN.T @ steps
                    np.testing.assert_allclose(abs(inFinest).sum(axis=1), finest, atol=1e-9)
                    centroid = [0.0] * 3
                    image.TransformContinuousIndexToPhysicalPoint(np.argwhere(voxels(image).T).mean(axis=0).tolist(), centroid)
                    self.assertLess(np.linalg.norm(Grids.TURN.T @ centroid - self.CENTRE), 0.5)

    def test_ties(self):
        """Faces in the middle of voxels are rounded to both sides in turn, and the program says so."""
        fine = self.save("fine", (0, 0, 0), np.eye(3))
        for ratio in (2, 3):
            coarse = self.save("coarse", (0, 0, 0), ratio * np.eye(3))
            truth = (np.argwhere(self.ball((0, 0, 0), ratio * np.eye(3), [n // ratio + 1 for n in self.SHAPE[::-1]])[
                :-1, :-1, :-1])[:, ::-1] * ratio)
            reader = self.read_masks([coarse, fine], ResampleMasks=True, Overlap=ORDER)
            ours = np.argwhere(voxels(reader.GetOutput()) == 1)[:, ::-1]
            centroid = [0.0] * 3
            reader.GetOutput().TransformContinuousIndexToPhysicalPoint(ours.mean(axis=0).tolist(), centroid)
            self.assertLess(np.linalg.norm(Grids.TURN.T @ centroid - truth.mean(axis=0)), 0.3)
            self.assertAlmostEqual(len(ours) / (len(truth) * ratio**3), 1, delta=0.06)
            told = " ".join(warnings_of(reader))
            (self.assertNotIn if ratio == 3 else self.assertIn)("in the middle of voxels of the finest grid", told)


class Cropped(MaskTestCase):
    """Masks of one grid, each cut to a box of its own."""

    SHAPE = (20, 24, 28)  # of the whole grid, [k, j, i]
    STEPS = Grids.TURN @ np.diag((0.7, 1.1, 1.9))
    ORIGIN = np.array((-123.4, 56.7, 0.1))
    BALLS = {"liver": ((9, 11, 17), 6), "spleen": ((12, 13, 9), 5), "kidney": ((4, 6, 21), 2.5)}

    def ball(self, name):
        centre, radius = self.BALLS[name]
        return np.linalg.norm(np.moveaxis(np.indices(self.SHAPE), 0, -1) - centre, axis=-1) < radius

    def crop(self, name, margin=1):
        """The first voxel, [i, j, k], and the voxels."""
        mask = self.ball(name)
        index = np.argwhere(mask)
        low, high = index.min(axis=0) - margin, index.max(axis=0) + margin + 1
        return low[::-1], mask[tuple(map(slice, low, high))]

    def geometry(self, first):
        spacing = np.linalg.norm(self.STEPS, axis=0)
        return images.Geometry(self.ORIGIN + self.STEPS @ first, spacing, self.STEPS / spacing)

    def save(self, names, moved=0.0):
        paths = []
        for name, kind in zip(names, (np.uint8, np.float32, np.int16)):
            first, array = self.crop(name)
            geometry = self.geometry(first + moved * (-1) ** len(paths))
            paths.append(images.write_nrrd(self.folder / f"{name}.nrrd", array.astype(kind), geometry))
        return paths

    def joiner(self, names, **properties):
        joiner = voxplex.vtkMasksToSegmentation()
        for number, name in enumerate(names):
            first, array = self.crop(name)
            place = self.geometry(first)
            joiner.AddInputData(voxplex.Image(array, spacing=place.spacing, origin=place.origin, direction=place.direction).to_vtk())
            joiner.SetMaskName(number, name)
        for name, value in properties.items():
            getattr(joiner, "Set" + name)(value)
        joiner.Update()
        return joiner

    def check(self, source, names, rule, atol=1e-9):
        self.assertEqual(source.GetErrorMessage(), "")
        image = source.GetOutput()
        boxes = [self.crop(name) for name in names]
        low = np.min([first for first, _ in boxes], axis=0)
        high = np.max([first + array.shape[::-1] for first, array in boxes], axis=0)
        expected = combined([self.ball(name) for name in names], rule)
        np.testing.assert_array_equal(voxels(image), expected[tuple(slice(*ends) for ends in zip(low[::-1], high[::-1]))])
        np.testing.assert_allclose(places_of(image), [self.ORIGIN + self.STEPS @ ends for ends in (low, high - 1)], rtol=0, atol=atol)
        for label in range(1, len(names) + 1):
            centroid = [0.0] * 3
            ours = np.argwhere(voxels(image).T == label)
            image.TransformContinuousIndexToPhysicalPoint(ours.mean(axis=0).tolist(), centroid)
            truth = self.ORIGIN + self.STEPS @ np.argwhere(expected.T == label).mean(axis=0)
            np.testing.assert_allclose(centroid, truth, rtol=0, atol=atol)
        self.assertRegex(" | ".join(warnings_of(source)), r"^masks overlap in \d+ voxels[^|]*$")
        self.assertEqual({label: name for label, (name, _) in table_of(image).items()}, dict(enumerate(names, 1)))

    def test_joined(self):
        """In any order, so that masks begin before and behind the first; the same where masks may be resampled."""
        for names in itertools.permutations(self.BALLS):
            for rule, resample in itertools.product((SMALLEST, ORDER), (False, True)):
                properties = {"Overlap": rule, "ResampleMasks": resample}
                self.check(self.read_masks(self.save(names), **properties), names, rule)
                self.check(self.joiner(names, **properties), names, rule)

    def test_rounded_headers(self):
        names = tuple(self.BALLS)
        self.check(self.read_masks(self.save(names, moved=0.004)), names, SMALLEST, atol=0.02)

    def test_slices(self):
        """One plane of voxels, slices from 0 or 1 before it, as files of segments have them."""
        array = self.ball("liver") | self.ball("spleen")
        for first in (0, -1):
            padded = np.pad(array[:9], ((-first, 0), (0, 0), (0, 0))).astype(np.uint8)
            paths = [images.write_nrrd(self.folder / "a.nrrd", padded, self.geometry((0, 0, first))),
                     images.write_nrrd(self.folder / "b.nrrd", array[9:].astype(np.uint8), self.geometry((0, 0, 9)))]
            for order, labels in ((1, (1, 2)), (-1, (2, 1))):
                image = self.read_masks(paths[::order]).GetOutput()
                expected = np.where(np.arange(20)[:, None, None] < 9, *labels) * array
                np.testing.assert_array_equal(voxels(image), np.pad(expected, ((-first, 0), (0, 0), (0, 0))))

    def test_between_voxels(self):
        paths = self.save(self.BALLS)
        first, array = self.crop("spleen")
        for moved in (0.5, 0.02):
            images.write_nrrd(paths[1], array.astype(np.uint8), self.geometry(first + (moved, 0, 0)))
            self.masks_refused(r"one grid, but '.*liver.nrrd' has the origin .*, and '.*spleen.nrrd' .*ResampleMasksOn\(\)", paths)
        labels = voxels(self.read_masks(paths, ResampleMasks=True, Overlap=ORDER).GetOutput())
        self.assertEqual((labels == 2).sum(), (self.ball("spleen") & ~self.ball("liver")).sum())  # 0.02 is not seen

    def test_too_far(self):
        paths = self.save(self.BALLS)
        first, array = self.crop("spleen")
        images.write_nrrd(paths[1], array.astype(np.uint8), self.geometry(first + (3000, 3000, 3000)))
        self.masks_refused("one grid, but '.*liver.nrrd' has the origin .*, and '.*spleen.nrrd' ", paths)
        reader = self.read_masks(paths, ResampleMasks=True)
        self.assertEqual(voxels(reader.GetOutput()).shape, self.crop("liver")[1].shape)
        self.assertEqual(warnings_of(reader)[0], f"masks reach too far beyond the finest grid, that of '{paths[0]}', and lose "
                                                 f"voxels there: spleen {array.sum()}, kidney {self.lost('kidney')}")

    def lost(self, name):
        """Voxels beyond the box of the liver."""
        first, array = self.crop("liver")
        inside = np.zeros(self.SHAPE, bool)
        inside[tuple(slice(a, a + n) for a, n in zip(first[::-1], array.shape))] = True
        return int((self.ball(name) & ~inside).sum())


class InMemory(MaskTestCase):
    SHAPE = (6, 7, 8)
    PLACE = {"spacing": (0.5, 1.0, 2.0), "origin": (10, -20, 30), "direction": Grids.TURN}
    BOXES = [box(SHAPE, (0, 3), (0, 3), (0, 4)), box(SHAPE, (0, 3), (0, 3), (2, 6)), box(SHAPE, (1, 2), (1, 2), (1, 2)),
             box(SHAPE, (0, 0), (0, 1), (0, 1))]

    def image(self, array, name="mask", space=None, **place):
        image = voxplex.Image(array, space=space, **{**self.PLACE, **place}).to_vtk()
        image.GetPointData().GetScalars().SetName(name)
        return image

    def join(self, *images, names=(), **properties):
        joiner = voxplex.vtkMasksToSegmentation()
        for image in images:
            joiner.AddInputData(image)
        for number, name in names:
            joiner.SetMaskName(number, name)
        for name, value in properties.items():
            getattr(joiner, "Set" + name)(value)
        joiner.Update()
        return joiner

    def names(self, joiner):
        return {label: name for label, (name, _) in table_of(joiner.GetOutput()).items()}

    def test_rules(self):
        for rule, word, lost in ((SMALLEST, "smallest", ""), (ORDER, "first", "mask 3")):
            joiner = self.join(*map(self.image, self.BOXES), names=[(0, "liver"), (3, "none")], Overlap=rule)
            self.assertEqual(joiner.GetErrorMessage(), "")
            output = joiner.GetOutput()
            self.assertEqual(output.GetPointData().GetScalars().GetDataTypeAsString(), "unsigned short")
            np.testing.assert_array_equal(voxels(output), combined([one > 0 for one in self.BOXES], rule))
            np.testing.assert_allclose(places_of(output), places_of(self.image(self.BOXES[0])))
            self.assertEqual(self.names(joiner), {1: "liver"})
            self.assertEqual(meshfiles.texts_of(output, "SPACE"), ["LPS"])
            self.assertEqual(warnings_of(joiner), [
                f"masks overlap in 19 voxels, which the {word} of them gets: liver and mask 2 (18), liver and mask 3 (1)",
                "masks without a voxel: none", *([f"masks of which overlaps leave no voxel: {lost}"] if lost else [])])

    def test_names(self):
        """Of an array, unless another has it, too; before it the only label of the field data, with its colour."""
        images = [self.image(one, name) for one, name in zip(self.BOXES[:3], ("liver", "Labels", "Labels"))]
        self.assertEqual(self.names(self.join(*images)), {1: "liver"})
        labelled = voxplex.Image(self.BOXES[2], names={1: "Spleen"}, **self.PLACE)
        labelled.colors = {1: (1.0, 0.0, 0.0)}
        images[2] = labelled.to_vtk()
        joiner = self.join(*images)
        self.assertEqual(table_of(joiner.GetOutput()), {1: ("liver", None), 3: ("Spleen", (255, 0, 0))})
        joiner.SetMaskName(2, "spleen")
        joiner.Update()
        self.assertEqual(table_of(joiner.GetOutput())[3], ("spleen", (255, 0, 0)))
        joiner.ClearMaskNames()
        joiner.Update()
        self.assertEqual(self.names(joiner)[3], "Spleen")
        joiner.SetMaskName(3, "other")
        joiner.Update()
        self.assertRegex(joiner.GetErrorMessage(), r"SetMaskName\(3, 'other'\) names none of the 3 masks")

    def test_blocks(self):
        """Nested, empty, and of a collection."""
        images = [self.image(one) for one in self.BOXES[:3]]
        inner, outer = vtkMultiBlockDataSet(), vtkMultiBlockDataSet()
        for block, (number, data, name) in itertools.chain(
                zip(itertools.repeat(inner), ((0, images[1], "kidney"), (1, images[2], "cyst"))),
                zip(itertools.repeat(outer), ((0, images[0], "liver"), (1, None, "nothing"), (2, inner, "more")))):
            block.SetBlock(number, data)
            block.GetMetaData(number).Set(vtkCompositeDataSet.NAME(), name)
        collection = vtkPartitionedDataSetCollection()
        for number, (image, name) in enumerate(zip(images, ("liver", "kidney", "cyst"))):
            collection.SetPartition(number, 0, image)
            collection.GetMetaData(number).Set(vtkCompositeDataSet.NAME(), name)
        for data in (outer, collection):
            joiner = self.join(data)
            np.testing.assert_array_equal(voxels(joiner.GetOutput()), combined([one > 0 for one in self.BOXES[:3]], SMALLEST))
            self.assertEqual(self.names(joiner), {1: "liver", 2: "kidney", 3: "cyst"})
        both = self.join(self.image(self.BOXES[0], "first"), outer)
        self.assertEqual(both.GetOutput().GetPointData().GetScalars().GetRange(), (0, 4))
        outer.SetBlock(0, vtkPolyData())
        self.assertRegex(self.join(outer).GetErrorMessage(), "block 'liver' is a vtkPolyData; masks are vtkImageData")

    def test_threshold(self):
        probabilities = self.image(np.where(self.BOXES[0] > 0, 0.7, 0.3))
        for threshold, count in ((0.5, 36), (0.7, 0), (0.2, 6 * 7 * 8)):
            joiner = self.join(probabilities, MaskThreshold=threshold)
            self.assertEqual(np.count_nonzero(voxels(joiner.GetOutput())), count)

    def test_spaces(self):
        """Masks in RAS and LPS lie at the same place; the output is in the space of the first."""
        flip = np.diag((-1.0, -1.0, 1.0))
        ras = self.image(self.BOXES[1], space="RAS", origin=flip @ self.PLACE["origin"], direction=flip @ self.PLACE["direction"])
        lps = self.image(self.BOXES[0], space="LPS")
        for first, second, space in ((ras, lps, "RAS"), (lps, ras, "LPS")):
            joiner = self.join(first, second)
            self.assertEqual(joiner.GetErrorMessage(), "")
            self.assertEqual(meshfiles.texts_of(joiner.GetOutput(), "SPACE"), [space])
            np.testing.assert_allclose(places_of(joiner.GetOutput()), places_of(first))

    def test_cells_and_extents(self):
        """Labels of cells, and an extent that does not begin with 0."""
        points = self.image(self.BOXES[0])
        moved = self.image(self.BOXES[1])
        first = np.array((4, -3, 2))
        moved.SetOrigin(np.array(self.PLACE["origin"]) - self.PLACE["direction"] @ (first * self.PLACE["spacing"]))
        moved.SetExtent(*np.ravel([(a, a + n - 1) for a, n in zip(first, self.SHAPE[::-1])]).tolist())
        cells = self.image(np.zeros(np.array(self.SHAPE) + 1, np.uint8))
        cells.SetOrigin(np.array(self.PLACE["origin"]) - self.PLACE["direction"] @ (0.5 * np.array(self.PLACE["spacing"])))
        cells.GetPointData().Initialize()
        cells.GetCellData().SetScalars(numpy_to_vtk(self.BOXES[2].ravel(), deep=True))
        joiner = self.join(points, moved, cells)
        self.assertEqual(joiner.GetErrorMessage(), "")
        np.testing.assert_array_equal(voxels(joiner.GetOutput()), combined([one > 0 for one in self.BOXES[:3]], SMALLEST))

    def test_refused(self):
        mask = self.image(self.BOXES[0])
        for pattern, other in (("mask 2 is no mask.* the value 2", self.image(self.BOXES[0] * 2.0)),
                               ("mask 2 is no mask.* one slice", self.image(self.BOXES[0][:1])),
                               ("mask 2: it has no array", vtkImageData())):
            joiner = self.join(mask, other)
            self.assertRegex(joiner.GetErrorMessage(), pattern)
            self.assertEqual(joiner.GetOutput().GetNumberOfPoints(), 0)
        self.assertRegex(self.join(vtkMultiBlockDataSet()).GetErrorMessage(), "there is no mask")
        joiner = self.join(mask, self.image(self.BOXES[1]))
        self.assertEqual((joiner.GetErrorMessage(), joiner.GetOutput().GetNumberOfPoints()), ("", mask.GetNumberOfPoints()))

    def test_series(self):
        """A mask in time beside one that stays: at each time the union of then."""
        frames = images.moving_balls(4, 16, 4.0, labels=(1, 1))
        reader = self.reader(images.write_nrrd(self.folder / "frames.nrrd", frames))
        joiner = voxplex.vtkMasksToSegmentation()
        joiner.AddInputConnection(reader.GetOutputPort())
        joiner.AddInputData(voxplex.Image(box((16, 16, 16), (0, 16), (0, 16), (0, 3))).to_vtk())
        for time in (0, 2, 1, 3):
            joiner.UpdateTimeStep(time)
            np.testing.assert_array_equal(voxels(joiner.GetOutput()) == 1, frames[time] > 0)
        mesher = voxplex.vtkImageToPentatopeMeshFilter()
        mesher.SetInputConnection(joiner.GetOutputPort())
        mesher.SetDelta(3.0)
        mesher.Update()
        self.assertEqual(mesher.GetErrorMessage(), "")
        self.assertEqual(mesher.GetOutput().GetPointData().GetArray("Time").GetRange(), (0, 3))

    def test_progress_and_abort(self):
        """Told before each mask; who stops there gets no image, no error, and all of it the next time."""
        joiner = self.join(*map(self.image, self.BOXES[:2]))
        expected, said = voxels(joiner.GetOutput()).copy(), []
        joiner.AddObserver("ProgressEvent", lambda *_: said.append(joiner.GetProgress()))
        tag = joiner.AddObserver("ProgressEvent", lambda caller, _: caller.SetAbortExecute(caller.GetProgress() == 0.5))
        joiner.Modified()
        joiner.Update()
        self.assertEqual((joiner.GetErrorMessage(), joiner.GetOutput().GetNumberOfPoints(), warnings_of(joiner)), ("", 0, []))
        self.assertEqual(max(said), 0.5)
        joiner.RemoveObserver(tag)
        joiner.Modified()
        joiner.Update()
        np.testing.assert_array_equal(voxels(joiner.GetOutput()), expected)
        self.assertEqual(said[-1], 1.0)

    def test_pipeline(self):
        """A change before the filter reaches the mesh after it."""
        shape = (20, 20, 30)
        source = vtkTrivialProducer()
        source.SetOutput(self.image(box(shape, (4, 16), (4, 16), (4, 15)), spacing=(1, 1, 1)))
        joiner = voxplex.vtkMasksToSegmentation()
        joiner.AddInputConnection(source.GetOutputPort())
        joiner.AddInputData(self.image(box(shape, (4, 16), (4, 16), (15, 26)), spacing=(1, 1, 1)))
        joiner.SetMaskName(1, "Bone")
        mesher = voxplex.vtkImageToTetMeshFilter()
        mesher.SetInputConnection(joiner.GetOutputPort())
        mesher.SetDelta(3.0)
        mesher.Update()
        self.assertEqual(mesher.GetErrorMessage(), "")
        self.assertEqual(mesher.GetOutput().GetCellData().GetArray("Label").GetRange(), (1, 2))
        self.assertEqual(table_of(mesher.GetOutput()), {2: ("Bone", None)})
        source.SetOutput(self.image(np.zeros(shape, np.uint8), spacing=(1, 1, 1)))
        mesher.Update()
        self.assertEqual(mesher.GetOutput().GetCellData().GetArray("Label").GetRange(), (2, 2))


class Unplaced(MaskTestCase):
    """Masks whose files do not say where they lie, beside others."""

    SHAPE = (6, 7, 8)
    PLACE = images.Geometry((-12.5, 40.0, 7.25), (0.5, 1.25, 2.0), Grids.TURN)
    MASK, OTHER = box(SHAPE, (1, 4), (1, 5), (1, 4)), box(SHAPE, (3, 6), (2, 6), (3, 7))
    # A description with the right spacing, which is no place yet; ImageJ's in voxels for a unit.
    IMAGEJ = {**TestTIFF.text("ImageJ=1.53t\nimages=6\nslices=6\nunit=mm\nspacing=2\n"), **TestTIFF.resolution(2, 0.8, 1)}

    def file(self, kind, array, name="plain"):
        """Without a place, by code that is not images.py's."""
        if kind.startswith("TIFF"):
            return TestTIFF.write(self.folder / (name + ".tif"), array, tags=self.IMAGEJ if kind == "TIFF of ImageJ" else {})
        plain = {"space": None, "space directions": None, "space origin": None}
        if kind.startswith("NRRD"):
            lines = {"NRRD": plain, "NRRD with spacings": {**plain, "spacings": "0.5 1.25 2"},
                     "NRRD without an origin": {"space origin": None}}[kind]
            return images.write_nrrd(self.folder / (name + ".nrrd"), array, self.PLACE, header_lines=lines)
        files = {"NIfTI": lambda: matrix.nifti.nifti(array, name + ".nii", pixdim=(1, 0.5, 1.25, 2)),
                 "MGH": lambda: matrix.mgh.mgh(array, name + ".mgh", good=0),
                 "MetaImage": lambda: matrix.metaimage.metaimage(array, name + ".mha", Offset=None)}[kind]()
        return files.write(self.folder)

    KINDS = ("TIFF", "TIFF of ImageJ", "NRRD", "NRRD with spacings", "NRRD without an origin", "NIfTI", "MGH", "MetaImage")

    def test_put_where_others_lie(self):
        placed = images.write_nrrd(self.folder / "placed.nrrd", self.OTHER, self.PLACE)
        cut = images.write_nrrd(self.folder / "cut.nrrd", self.OTHER[2:], images.Geometry(
            np.array(self.PLACE.origin) + 4.0 * Grids.TURN[:, 2], self.PLACE.spacing, self.PLACE.direction))
        for n, kind in enumerate(self.KINDS):
            plain = self.file(kind, self.MASK)
            for resample, paths in enumerate(([plain, placed], [cut, placed, plain]) if n % 2 else
                                             ([placed, plain], [plain, placed, cut])):
                with self.subTest(kind, paths=paths, resample=resample):
                    reader = self.read_masks(paths, ResampleMasks=bool(resample))
                    image = reader.GetOutput()
                    np.testing.assert_allclose(image.GetOrigin(), self.PLACE.origin, atol=1e-9)
                    np.testing.assert_allclose(image.GetSpacing(), self.PLACE.spacing)
                    masks = [self.MASK if path is plain else self.OTHER for path in paths]
                    np.testing.assert_array_equal(voxels(image), combined([mask > 0 for mask in masks], SMALLEST))
                    told = warnings_of(reader)
                    self.assertIn("masks that do not say where they lie were put where others of their size lie: "
                                  f"'{plain}'", told)
                    self.assertNotRegex(" ".join(told), "SetSpacing|image lies")
            reader = self.reader(plain)  # alone it says what it said
            self.assertEqual(reader.GetErrorMessage(), "")
            self.assertNotRegex(" ".join(warnings_of(reader)), "it does not say where")

    def test_refused(self):
        placed = images.write_nrrd(self.folder / "placed.nrrd", self.OTHER, self.PLACE)
        apart = images.write_nrrd(self.folder / "apart.nrrd", self.OTHER, images.Geometry(
            (0, 0, 0), self.PLACE.spacing, self.PLACE.direction))
        moved = images.write_nrrd(self.folder / "moved.nrrd", self.OTHER, images.Geometry(
            np.array(self.PLACE.origin) + 4.0 * Grids.TURN[:, 2], self.PLACE.spacing, self.PLACE.direction))
        longer = np.concatenate([self.MASK, self.MASK])
        for kind, resample in (("TIFF", False), ("NRRD", True), ("NRRD without an origin", False), ("NIfTI", True)):
            small, same = self.file(kind, longer, "small"), self.file(kind, self.MASK)
            with self.subTest(kind, resample=resample):
                for paths in ([small, placed], [placed, same, small], [same, small]):
                    self.masks_refused("' does not say where it lies, and must have the size of another mask that does, or of "
                                       "all, but it has 8 7 (6|12) voxels", paths, ResampleMasks=resample)
                for others in ([placed, moved],) + (([placed, apart],) if resample else ()):
                    for paths in ([same, *others], [*others, same]):
                        self.masks_refused("does not say where it lies, and masks of its size lie at several places",
                                           paths, ResampleMasks=resample)
        for resample in (False, True):
            other = images.write_nrrd(self.folder / "other.nrrd", self.OTHER, images.Geometry(
                self.PLACE.origin, (1, 1, 1), self.PLACE.direction))
            for kind in ("TIFF of ImageJ", "MetaImage"):
                self.masks_refused("spacing", [other, self.file(kind, self.MASK)], ResampleMasks=resample)

    def test_all_without(self):
        """They lie together, wherever that is."""
        for kind in self.KINDS:
            paths = [self.file(kind, self.MASK, "a"), self.file(kind, self.OTHER, "b")]
            for properties in ({}, {"Origin": (1, 2, 3), "Spacing": (0.5, 0.5, 3)}):
                image = self.read_masks(paths, **properties).GetOutput()
                np.testing.assert_array_equal(voxels(image), combined([self.MASK > 0, self.OTHER > 0], SMALLEST))
                if properties:
                    np.testing.assert_allclose(image.GetOrigin(), (1, 2, 3))

    def test_other_guesses(self):
        """Formats guess other axes and spacings: of two masks without a place, one lies where the other does."""
        kinds = self.KINDS[:-1]
        for (n, one), (m, other) in itertools.permutations(enumerate(kinds), 2):
            with self.subTest(one=one, other=other):
                paths = [self.file(one, self.MASK, f"a{n}"), self.file(other, self.OTHER, f"b{m}")]
                image = self.read_masks(paths, ResampleMasks=n % 2 == 0).GetOutput()
                np.testing.assert_array_equal(voxels(image), combined([self.MASK > 0, self.OTHER > 0], SMALLEST))
                known = [kind for kind in (one, other) if kind not in ("TIFF", "NRRD", "MGH")]
                np.testing.assert_allclose(image.GetSpacing(), self.PLACE.spacing if known else (1, 1, 1))

    def test_guess_is_told_unless_it_is_replaced(self):
        path = self.file("NIfTI", self.MASK)
        place = {"Origin": (1, 2, 3), "Direction": np.eye(3).ravel().tolist()}
        for properties, told in (({}, True), ({"Origin": (1, 2, 3)}, True), (place, False)):
            self.assertEqual("taken for those of RAS" in " ".join(warnings_of(self.reader(path, **properties))), told)

    def test_one_place_for_several(self):
        """A place that is given replaces one, not those of masks that begin at several."""
        geometry = [images.Geometry(np.array(self.PLACE.origin) + n * self.PLACE.spacing[0] * Grids.TURN[:, 0], self.PLACE.spacing,
                                    self.PLACE.direction) for n in (0, 3)]
        a, b = (images.write_nrrd(self.folder / f"{n}.nrrd", self.MASK, one) for n, one in enumerate(geometry))
        same = images.write_nrrd(self.folder / "same.nrrd", self.OTHER[:4], geometry[0])
        plain = self.file("TIFF", self.MASK)
        for properties in ({"Origin": (0, 0, 0)}, {"Spacing": (1, 1, 1)}, {"Direction": np.eye(3).ravel().tolist()}):
            for paths, resample in itertools.product(([a, b], [b, a], [same, b]), (False, True)):
                self.masks_refused(r"tell one place, but masks have several: '.*' begins at .*, and '.*' at .*", paths,
                                   ResampleMasks=resample, **properties)
            for paths in ([a, same], [a, plain], [plain, a], [plain, same, a]):
                self.read_masks(paths, **properties)

    def test_units(self):
        """Masks in micrometres and in millimetres are not joined as if these were one."""
        um, mm, none = (images.write_nrrd(self.folder / f"{n}.nrrd", self.MASK, self.PLACE, header_lines=units and {
            "space units": units}) for n, units in enumerate(('"um" "um" "um"', '"mm" "mm" "mm"', None)))
        other = images.write_nrrd(self.folder / "other.nrrd", self.OTHER, self.PLACE, header_lines={
            "space units": '"micron" "micron" "micron"'})
        plain = self.file("TIFF of ImageJ", self.MASK)
        for resample in (False, True):
            for paths in ([um, mm], [mm, um], [none, um], [um, none], [um, plain], [plain, um], [mm, none, um]):
                self.masks_refused("masks must have one unit of length, but '.*' is in m(icro|illi)metres, and '.*' in m",
                                   paths, ResampleMasks=resample)
            for paths in ([um, other], [mm, none], [plain, mm], [um, self.file("TIFF", self.MASK, "other")]):
                self.read_masks(paths, ResampleMasks=resample)


class Rules(MaskTestCase):
    SHAPE = (6, 7, 8)

    def test_ties_and_losers(self):
        first = box(self.SHAPE, (0, 3), (0, 3), (0, 4))
        second = box(self.SHAPE, (0, 3), (0, 3), (2, 6))
        paths = self.write(b_10=first, b_9=second, inner=box(self.SHAPE, (1, 2), (1, 2), (1, 2)), none=0 * first,
                           copy=first)
        reader = self.read_masks(paths)
        expected = second * 2
        expected[first > 0] = 1
        expected[1, 1, 1] = 3
        np.testing.assert_array_equal(voxels(reader.GetOutput()), expected)
        self.assertEqual({label: name for label, (name, _) in table_of(reader.GetOutput()).items()},
                         {1: "b_10", 2: "b_9", 3: "inner"})
        self.assertEqual(warnings_of(reader), [
            "masks overlap in 36 voxels, which the smallest of them gets: b_10 and copy (36), b_10 and b_9 (18), b_9 and copy "
            "(18), b_10 and inner (1), inner and copy (1)",
            "masks without a voxel: none", "masks of which overlaps leave no voxel: copy"])
        reader.SetOverlap(ORDER)
        reader.Update()
        expected[1, 1, 1] = 1
        np.testing.assert_array_equal(voxels(reader.GetOutput()), expected)
        self.assertRegex(warnings_of(reader)[0], "which the first of them gets")
        self.assertRegex(warnings_of(reader)[2], "no voxel: inner, copy$")
        reader.ClearFileNames()
        for path in reversed(paths):
            reader.AddFileName(path)
        reader.Update()
        self.assertEqual({label: name for label, (name, _) in table_of(reader.GetOutput()).items()}, {1: "copy", 4: "b_9"})

    def test_values(self):
        mask = box(self.SHAPE, (1, 3), (1, 3), (1, 4))
        probabilities = np.where(mask > 0, 0.51, 0.5).astype(np.float32)
        probabilities[2, 2, 2] = 1.0
        several = box(self.SHAPE, (4, 6), (4, 6), (4, 7)).astype(np.int16) * 7
        several[5, 5, 5] = -2
        reader = self.read_masks(self.write(a=probabilities, b=several, c=box(self.SHAPE, (0, 1), (0, 1), (0, 1)) * 255))
        expected = mask + 2 * (several != 0)
        expected[0, 0, 0] = 3
        np.testing.assert_array_equal(voxels(reader.GetOutput()), expected)
        self.assertEqual(warnings_of(reader), ["masks with several values, all of which are inside: b"])
        reader = self.read_masks(self.write(a=probabilities, b=several), MaskThreshold=0.75)
        np.testing.assert_array_equal(voxels(reader.GetOutput()), (probabilities > 0.75) + 2 * (several != 0))
        for value in (2.0, -0.5, np.nan):
            probabilities[0, 0, 0] = value
            self.masks_refused("'.*/a.nrrd' is no mask, .* has the value .*probabilities from 0 to 1",
                               self.write(b=mask, a=probabilities))

    def test_names_of_no_text(self):
        """The warning names the file."""
        folder, mask = self.folder / "in", box(self.SHAPE, (1, 3), (1, 3), (1, 4))
        folder.mkdir()
        images.write_nrrd(folder / "a.nrrd", mask)
        images.write_nrrd(os.fsencode(folder) + b"/li\xe9vre.nrrd", np.roll(mask, 3, axis=2))
        reader = self.reader(folder)
        self.assertEqual(reader.GetErrorMessage(), "")
        self.assertEqual(table_of(reader.GetOutput()), {1: ("a", None)})
        self.assertRegex(warnings_of(reader)[0], "/in/li.*vre.nrrd': the name of label 2 is not in UTF-8")

    def test_no_masks(self):
        mask = box(self.SHAPE, (1, 3), (1, 3), (1, 4))
        self.masks_refused("'.*series.nrrd' is no mask.* 3 time frames", self.write(a=mask, series=np.stack([mask] * 3)))
        self.masks_refused("'.*slice.nrrd' is no mask.* one slice", self.write(a=mask, slice=mask[:1]))
        self.masks_refused("there is no such file", [*self.write(a=mask), self.folder / "none.nrrd"])
        self.masks_refused("no file name is set", [""])

    def test_one_file_is_an_image(self):
        labels = images.two_labels(10, 4.0)
        path = images.write_nrrd(self.folder / "labels.nrrd", labels)
        np.testing.assert_array_equal(voxels(self.read_masks([path]).GetOutput()), labels)

    def test_common_warnings_are_said_once(self):
        mask = box(self.SHAPE, (1, 3), (1, 3), (1, 4))
        paths = [images.write_nrrd(self.folder / f"m{n}.nrrd", np.roll(mask, n, axis=2), header_lines={
            "space": None, "space directions": None, "space origin": None}) for n in (0, 3)]
        self.assertEqual(len(warnings_of(self.read_masks(paths))), 1)
        self.assertRegex(warnings_of(self.read_masks(paths))[0], "/m0.nrrd and 1 more: .*no spacing")

    def test_folder_of_dicom(self):
        """Whatever else is in it."""
        array = images.ball(12, 4.0, label=3, dtype=np.uint16)
        images.write_dicom_series(self.folder, array)
        self.write(mask=box((12, 12, 12), (1, 3), (1, 3), (1, 3)))
        np.testing.assert_array_equal(voxels(self.reader(self.folder).GetOutput()), array)


class Layers(MaskTestCase):
    """Segments of 3D Slicer that overlap."""

    KEYS = {
        "Segment0_ID": "a", "Segment0_Name": "Bone", "Segment0_LabelValue": "1", "Segment0_Layer": "0",
        "Segment0_Color": "1 0 0", "Segment1_ID": "b", "Segment1_Name": "Tumour", "Segment1_LabelValue": "1",
        "Segment1_Layer": "1", "Segment2_ID": "c", "Segment2_Name": "Fat", "Segment2_LabelValue": "2",
        "Segment2_Layer": "0", "Segment3_ID": "d", "Segment3_Name": "Nothing", "Segment3_LabelValue": "9",
        "Segment3_Layer": "7"}

    def test_rules(self):
        shape = (6, 7, 8)
        bone, fat = box(shape, (0, 6), (0, 7), (0, 3)), box(shape, (0, 6), (0, 7), (3, 5))
        tumour = box(shape, (2, 4), (2, 4), (1, 7))
        layers = np.stack([bone + 2 * fat, tumour + 5 * bone * (1 - tumour)], axis=-1)  # 5 is no segment
        path = images.write_nrrd(self.folder / "s.seg.nrrd", layers, images.Geometry((1, 2, 3), (1, 1, 2)), components=True,
                                 header_lines={"kinds": "list domain domain domain"}, key_values=self.KEYS)
        for rule, word in ((SMALLEST, "smallest"), (ORDER, "first")):
            reader = self.reader(path, Overlap=rule)
            expected = combined([bone > 0, tumour > 0, fat > 0], rule)
            np.testing.assert_array_equal(voxels(reader.GetOutput()), expected)
            self.assertEqual(reader.GetOutput().GetSpacing(), (1, 1, 2))
            self.assertEqual(table_of(reader.GetOutput()), {1: ("Bone", (255, 0, 0)), 2: ("Tumour", None), 3: ("Fat", None)})
            self.assertEqual(warnings_of(reader), [
                f"{path}: segments overlap in 16 voxels, which the {word} of them gets: Bone and Tumour (8), Fat and Tumour (8)",
                f"{path}: segments without a voxel: Nothing"])
            self.assertEqual(reader.GetNumberOfFrames(), 1)

    def test_sequence_with_names_is_none(self):
        """What the program saves of a series."""
        array = images.moving_balls(3, 8, 2.0, labels=(1, 2))
        path = images.write_nrrd(self.folder / "s.nrrd", array, key_values={**self.KEYS, "axis 3 index values": "0 1 2"})
        self.assertEqual(self.reader(path).GetNumberOfFrames(), 3)


if __name__ == "__main__":
    unittest.main()
