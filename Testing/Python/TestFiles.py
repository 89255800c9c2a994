#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Reading of segmentations and writing of meshes."""

import errno
import os
import subprocess
import sys
import tempfile
import unittest
import unittest.mock
import warnings
from pathlib import Path

import numpy
import images
import voxplex
from folders import FolderTestCase
from phantoms import beating, brick
from voxplex.sources import image_of

try:
    import meshfiles
except ModuleNotFoundError:  # it reads with VTK
    meshfiles = None

DIRECTION = numpy.array([[0.8, -0.6, 0], [0.48, 0.64, -0.6], [0.36, 0.48, 0.8]])
SPACING = numpy.array([0.5, 1.0, 2.0])
ORIGIN = numpy.array([10.0, -20.0, 30.0])


def write_nrrd(path, array, keys=None, **fields):
    """Placed by the constants above."""
    images.write_nrrd(path, array, images.Geometry(ORIGIN, SPACING, DIRECTION), key_values=keys,
                      header_lines={"encoding": "raw", **fields})


class Files(FolderTestCase):
    def setUp(self):
        super().setUp()
        self.labels = brick().astype(numpy.int16)
        self.image = self.folder / "labels.nrrd"
        write_nrrd(self.image, self.labels)
        self.series = self.folder / "series.nrrd"
        write_nrrd(self.series, beating())

    def test_read(self):
        image = voxplex.read_segmentation(self.image)
        numpy.testing.assert_array_equal(image.voxels, self.labels)
        self.assertEqual(image.voxels.dtype, numpy.int16)
        numpy.testing.assert_allclose(image.spacing, SPACING)
        numpy.testing.assert_allclose(image.origin, ORIGIN)
        numpy.testing.assert_allclose(image.direction, DIRECTION, atol=1e-6)
        self.assertEqual((image.space, image.names, image.is_series), ("LPS", {}, False))
        other = voxplex.read_segmentation(str(self.image), space="RAS")
        numpy.testing.assert_allclose(other.origin, ORIGIN * (-1, -1, 1))
        self.assertEqual(other.space, "RAS")

    def test_read_back(self):
        """What the program writes of an image, it reads as the same image."""
        for path, space in ((self.image, "lps"), (self.series, "lps"), (self.image, "ras")):
            copy = self.folder / "copy.nrrd"
            subprocess.run([voxplex.program.path(), "image", path, copy, "--space", space], check=True)
            first, second = voxplex.read_segmentation(path), voxplex.read_segmentation(copy)
            numpy.testing.assert_array_equal(first.voxels, second.voxels)
            numpy.testing.assert_allclose(second.origin, first.origin)
            numpy.testing.assert_allclose(second.direction, first.direction, atol=1e-12)
            self.assertEqual((first.times, first.names), (second.times, second.names))

    def test_names_that_are_no_text(self):
        path = os.fsdecode(os.fsencode(self.folder) + b"/\xe9.nrrd")
        os.rename(self.image, path)
        image = voxplex.read_segmentation(path)
        numpy.testing.assert_array_equal(image.voxels, self.labels)
        mesh = os.fsdecode(os.fsencode(self.folder) + b"/\xe9.vtu")
        voxplex.mesh(path, delta=2).write(mesh)
        self.assertTrue(os.path.exists(mesh))
        Path(path).write_bytes(b"no image")
        with self.assertRaisesRegex(voxplex.FileError, ".nrrd': it is not an image"):
            voxplex.read_segmentation(path)

    def test_place(self):
        """What the caller says counts before the file, for images, series and meshes."""
        place = dict(spacing=(1.0, 2.0, 4.0), origin=(1, 2, 3), direction=numpy.diag([-1.0, -1.0, 1.0]))
        for image in (voxplex.read_segmentation(self.image, **place), voxplex.read_segmentation(self.series, **place),
                      voxplex.read_segmentation(self.image, space="RAS", **place)):
            numpy.testing.assert_allclose(image.spacing, place["spacing"])
            numpy.testing.assert_allclose(image.origin, place["origin"])
            numpy.testing.assert_allclose(image.direction, place["direction"])
        numpy.testing.assert_allclose(voxplex.read_segmentation(self.image, origin=(1, 2, 3)).spacing, SPACING)
        from_path = voxplex.mesh(self.image, 2.0, threads=1, **place)
        from_array = voxplex.mesh(self.labels, 2.0, threads=1, **place)
        numpy.testing.assert_allclose(from_path.points, from_array.points)
        self.assertEqual(voxplex.quality(from_path, self.image, **place)["image"],
                         voxplex.quality(from_array, self.labels, **place)["image"])

    def test_no_place(self):
        """Never taken for 'as in the file'."""
        for words, place in (("spacing is .0.0, 1.0, 1.0.; lengths must be positive", dict(spacing=(0, 1, 1))),
                             ("spacing is .*inf", dict(spacing=(1, 1, numpy.inf))),
                             ("spacing has 2 numbers, not 3", dict(spacing=(1, 1))),
                             ("origin is .*nan.*; coordinates must be finite", dict(origin=(numpy.nan, 0, 0))),
                             ("direction has 3 numbers, not 9", dict(direction=(1, 0, 0))),
                             ("direction is .*; its columns must be independent", dict(direction=numpy.zeros((3, 3)))),
                             ("direction is .*; its columns must be independent", dict(direction=numpy.ones(9))),
                             ("direction: its columns must have the length 1, and they have 2, 2, 0.5; .*affine=",
                              dict(direction=numpy.diag((2, -2, 0.5)))),
                             ("direction: .* have 1, 1, 1.002;", dict(direction=numpy.diag((1, 1, 1.002)))),
                             ("spacing, origin: not with affine", dict(spacing=(1, 1, 1), origin=(0, 0, 0), affine=numpy.eye(4))),
                             ("affine must be a matrix of 4 x 4", dict(affine=numpy.eye(3))),
                             ("affine must .* the last row 0, 0, 0, 1", dict(affine=numpy.ones((4, 4)))),
                             ("affine must .* independent", dict(affine=numpy.diag((1, 1, 0, 1)))),
                             ("affine must .* finite", dict(affine=numpy.diag((1, 1, numpy.nan, 1))))):
            with self.subTest(words=words, place=place):
                for call, image in ((voxplex.read_segmentation, self.image), (voxplex.mesh, self.image), (voxplex.mesh, self.labels),
                                    (voxplex.Image, self.labels), (voxplex.read_segmentation, {"a": self.labels})):
                    with self.assertRaisesRegex(ValueError, words):
                        call(image, **place)

    def test_affine(self):
        """Of indices to RAS, as nibabel's, of arrays, masks and files; in memory the place is LPS, or RAS if it is asked for."""
        affine = numpy.eye(4)
        affine[:3, :3], affine[:3, 3] = DIRECTION * SPACING, ORIGIN
        affine[0, 1] += 0.25  # sheared
        for space, signs in (("LPS", (-1, -1, 1)), ("RAS", (1, 1, 1))):
            masks = {"a": self.labels, "b": self.image}
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # masks overlap
                found = [voxplex.Image(self.labels, affine=affine, space=space),
                         voxplex.read_segmentation(self.image, affine=affine, space=space),
                         voxplex.read_segmentation(masks, affine=affine, space=space)]
            for image in found:
                numpy.testing.assert_allclose(image.direction * image.spacing, numpy.diag(signs) @ affine[:3, :3], atol=1e-6)
                numpy.testing.assert_allclose(image.origin, affine[:3, 3] * signs)
                self.assertEqual(image.space, space)
            mesh = voxplex.mesh(found[0], 2.0, threads=1)
            self.assertEqual(voxplex.quality(mesh, self.image, affine=affine)["image"], voxplex.quality(mesh, found[0])["image"])
        for source in (self.image, self.labels, {"low": self.labels == 5, "high": self.labels == 9}):
            mesh = voxplex.mesh(source, 2.0, affine=affine, threads=1)
            self.assertEqual(mesh.space, "LPS")
            numpy.testing.assert_allclose(mesh.points, voxplex.mesh(voxplex.Image(self.labels, affine=affine), 2.0, threads=1).points,
                                          rtol=1e-6, atol=1e-5)
        with self.assertRaisesRegex(ValueError, "affine: only for arrays and files"):
            voxplex.mesh(found[0], affine=affine)

    def test_place_of_masks_is_in_space(self):
        """Origin and direction are in the coordinates of space, of arrays without a space of their own, too."""
        write_nrrd(self.image, (self.labels > 0).astype(numpy.uint8))
        for masks in ({"a": self.labels > 0}, {"a": self.image}):
            image = voxplex.read_segmentation(masks, space="RAS", origin=ORIGIN, direction=DIRECTION)
            numpy.testing.assert_allclose(image.origin, ORIGIN)
            numpy.testing.assert_allclose(image.direction, DIRECTION, atol=1e-6)
            self.assertEqual(image.space, "RAS")

    def test_mesh_reads_as_read_segmentation(self):
        """Each way of reading, of files, masks and frames; what does not apply is refused."""
        first, second, fine = self.folder / "first.nrrd", self.folder / "second.nrrd", self.folder / "fine.nrrd"
        write_nrrd(first, (self.labels > 0).astype(numpy.uint8))
        write_nrrd(second, 0.3 + 0.4 * (self.labels == 9).astype(numpy.float32))
        second.write_bytes(second.read_bytes().replace(b"float32", b"float"))
        write_nrrd(fine, (self.labels == 9).astype(numpy.uint8))
        fine.write_bytes(fine.read_bytes().replace(b"space origin: (10.0", b"space origin: (10.4"))
        table = self.folder / "table.txt"
        table.write_text("5 kidney\n9 bladder\n")
        memory = {"first": self.labels > 0, "second": 0.3 + 0.4 * (self.labels == 9)}
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # masks overlap
            for source, ways in (([first, second], dict(overlap="order")), ([first, second], dict(mask_threshold=0.2)),
                                 (memory, dict(overlap="order")), (memory, dict(mask_threshold=0.2)),
                                 ([first, fine], dict(resample_masks=True)), (self.image, dict(label_table=table)),
                                 (self.image, dict(space="RAS")), (self.image, dict(space="RAS", origin=(1, 2, 3))),
                                 (memory, dict(space="RAS", origin=(1, 2, 3)))):
                with self.subTest(ways):
                    image = voxplex.read_segmentation(source, **ways)
                    expected, mesh = voxplex.mesh(image, 2.0, threads=1), voxplex.mesh(source, 2.0, threads=1, **ways)
                    numpy.testing.assert_allclose(mesh.points, expected.points, atol=1e-9)
                    self.assertEqual((set(mesh.labels), mesh.names, mesh.space), (set(image.voxels.flat) - {0}, expected.names, image.space))
        array = voxplex.mesh(self.labels, 2.0, space="RAS", threads=1)
        self.assertEqual(array.space, "RAS")
        numpy.testing.assert_array_equal(array.points, voxplex.mesh(self.labels, 2.0, threads=1).points)
        self.assertEqual(voxplex.mesh([beating()[0], beating()[1]], 2.0, space="RAS").space, "RAS")
        for words, source, ways in (
                ("^overlap: only for files and masks", self.labels, dict(overlap="order")),
                ("^mask_threshold, resample_masks: only for files and masks", self.labels, dict(mask_threshold=0.1, resample_masks=True)),
                ("^label_table: only for files", voxplex.Image(self.labels), dict(label_table=table)),
                ("^series_uid: only for files", memory, dict(series_uid="1.2")),
                ("^space: only for arrays and files", voxplex.Image(self.labels), dict(space="RAS")),
                ("^overlap: only for files and masks", [beating()[0], beating()[1]], dict(overlap="order")),
                ("^space is 'XYZ'", self.labels, dict(space="XYZ"))):
            for call in (voxplex.mesh, voxplex.repair):
                with self.subTest(words=words, call=call), self.assertRaisesRegex(ValueError, words):
                    call(source, **ways)

    def test_write_image(self):
        """What is written is read as the same image."""
        place = dict(spacing=SPACING, origin=ORIGIN, direction=DIRECTION)
        names = {5: "liver; \u00e9, \"x\"", 9: "spleen"}
        for array, space, times in ((self.labels, None, None), (self.labels.astype(numpy.float32), "RAS", None), (self.labels > 0, "LPS", None),
                                    (5 * beating(), "RAS", (0.5, 1.0, 2.0, 4.25)), (self.labels.astype(">u8"), "LPS", None)):
            image = voxplex.Image(array, names=names, space=space, times=times, **place)
            image.colors = {5: (0.1, 0.2, 1.0)}
            image.write(self.folder / "image.nrrd")
            read = voxplex.read_segmentation(self.folder / "image.nrrd", space=space)
            numpy.testing.assert_array_equal(read.voxels, image.voxels)
            for name in place:
                numpy.testing.assert_allclose(getattr(read, name), getattr(image, name), atol=1e-12)
            present = set(numpy.unique(array).tolist())
            self.assertEqual((read.space, read.times, read.names, read.colors),
                             (space or "LPS", image.times, {label: names[label] for label in names if label in present},
                              {5: [0.1, 0.2, 1.0]} if 5 in present else {}))
        voxplex.Image(numpy.ma.array(self.labels, mask=self.labels == 9)).write(self.folder / "image.nrrd")
        numpy.testing.assert_array_equal(voxplex.read_segmentation(self.folder / "image.nrrd").voxels, numpy.where(self.labels == 9, 0, self.labels))
        for name, words in (("image.nii", "^path: images are saved as .nrrd"), ("none/image.nrrd", "none")):
            with self.assertRaisesRegex(voxplex.FileError, words):
                image.write(self.folder / name)

    def test_read_mesh(self):
        """Meshes and interfaces come back as they were."""
        for source in (self.image, self.series):
            mesh = voxplex.mesh(voxplex.read_segmentation(source, space="RAS"), 2.0)
            mesh.names, mesh.colors = {label: f"tissue {label}" for label in set(mesh.labels.tolist())}, {}
            mesh.cell_data["Weight"] = numpy.arange(len(mesh.cells)) / 7
            interfaces = self.folder / ("plc.vtp" if source is self.image else "plc.vtu")
            mesh.write(self.folder / "mesh.vtu", interfaces=interfaces)
            back = voxplex.read_mesh(self.folder / "mesh.vtu", interfaces)
            for ours, theirs in ((mesh, back), (mesh.interfaces, back.interfaces)):
                for name in ("points", "cells", "labels"):
                    numpy.testing.assert_array_equal(getattr(ours, name), getattr(theirs, name))
                self.assertEqual((theirs.names, theirs.space), (mesh.names, "RAS"))
                for data in ("point_data", "cell_data"):
                    self.assertEqual(set(getattr(ours, data)), set(getattr(theirs, data)))
            numpy.testing.assert_array_equal(back.cell_data["Weight"], mesh.cell_data["Weight"])
            numpy.testing.assert_array_equal(back.interfaces.point_ids, mesh.interfaces.point_ids)
            made = voxplex.read_mesh(self.folder / "mesh.vtu").interfaces
            self.assertEqual((len(made.cells), made.names), (len(mesh.interfaces.cells), mesh.names))
        with self.assertRaisesRegex(FileNotFoundError, "none.vtu"):
            voxplex.read_mesh(self.folder / "none.vtu")
        for path, words in ((self.image, "not a .vtu file"), (self.folder / "plc.vtu", "Label")):
            with self.assertRaisesRegex(voxplex.FileError, words):
                voxplex.read_mesh(path)

    def test_write_interfaces(self):
        """Alone, as with their mesh."""
        mesh, series = voxplex.mesh(self.image, 2.0), voxplex.mesh(self.series, 2.0, pick_slivers=False)
        for one, extensions in ((mesh, (".vtp", ".vtu", ".stl", ".ply", ".vtk")), (series, (".vtu",))):
            for extension in extensions:
                alone, together = self.folder / ("alone" + extension), self.folder / ("together" + extension)
                one.interfaces.write(alone)
                one.write(interfaces=together)
                self.assertEqual(alone.read_bytes(), together.read_bytes(), extension)
        part = voxplex.Interfaces(mesh.interfaces.points, mesh.interfaces.cells[:5])
        part.write(self.folder / "part.stl")
        self.assertEqual((self.folder / "part.stl").stat().st_size, 84 + 5 * 50)
        for interfaces, name, words in ((mesh.interfaces, "a.inp", "^path: the format '.inp' is not known"), (series.interfaces, "a.stl", "use .vtu"),
                                        (mesh.interfaces, "none/a.stl", "none")):
            with self.assertRaisesRegex(voxplex.FileError, words):
                interfaces.write(self.folder / name)

    def test_messages_speak_of_arguments(self):
        path = self.folder / "plain.nrrd"
        path.write_bytes(b"NRRD0004\ntype: uint8\ndimension: 3\nsizes: 4 4 4\nencoding: raw\n\n" + bytes(64))
        with self.assertWarnsRegex(voxplex.MeshingWarning, "plain.nrrd: .* taken to be 1; set it with spacing=$"):
            voxplex.read_segmentation(path)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            voxplex.read_segmentation(path, spacing=(1, 1, 1))
        with self.assertRaisesRegex(voxplex.FileError, "series_uid needs a folder"):
            voxplex.read_segmentation(path, series_uid="1.2")

    def test_data_files_anywhere(self):
        (self.folder / "headers").mkdir()
        path = self.folder / "headers" / "labels.nhdr"
        write_nrrd(path, self.labels, **{"data file": "../labels.raw"})
        header, voxels = path.read_bytes().split(b"\n\n", 1)
        path.write_bytes(header + b"\n")
        (self.folder / "labels.raw").write_bytes(voxels)
        words = r"or use read_segmentation\(..., data_files_anywhere=True\) if you trust the header"
        for call in (voxplex.read_segmentation, voxplex.mesh):
            with self.assertRaisesRegex(voxplex.FileError, words):
                call(path)
        image = voxplex.read_segmentation(path, data_files_anywhere=True)
        numpy.testing.assert_array_equal(image.voxels, self.labels)

    def test_masks(self):
        """Several files, or a folder of them."""
        folder = self.folder / "masks"
        folder.mkdir()
        paths = [folder / f"{name}.nrrd" for name in ("tibia", "femur")]
        write_nrrd(paths[0], (self.labels > 0).astype(numpy.uint8))
        write_nrrd(paths[1], (self.labels == 9).astype(numpy.uint8))
        both = numpy.where(self.labels == 9, 2, self.labels > 0)
        words = "^masks overlap in 288 voxels, which the smallest of them gets: tibia and femur .288.$"
        with self.assertWarnsRegex(voxplex.MeshingWarning, words):
            image = voxplex.read_segmentation(paths)
        numpy.testing.assert_array_equal(image.voxels, both)
        self.assertEqual(image.names, {1: "tibia", 2: "femur"})
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            self.assertEqual(voxplex.read_segmentation(paths, overlap="order").names, {1: "tibia"})
            self.assertEqual(voxplex.read_segmentation(folder).names, {1: "femur", 2: "tibia"})
            for source, names in ((folder, {1: "femur", 2: "tibia"}), (tuple(map(str, paths)), {1: "tibia", 2: "femur"})):
                mesh = voxplex.mesh(source, 2.0)
                self.assertEqual((mesh.names, set(mesh.labels)), (names, {1, 2}))
                self.assertEqual(voxplex.quality(mesh, source)["image"]["lost_labels"], [])
            # With times they are frames.
            self.assertEqual(voxplex.mesh(paths, 2.0, times=(0, 1), pick_slivers=False).cells.shape[1], 5)
        coarse = self.folder / "coarse.nrrd"
        coarse.write_bytes(paths[0].read_bytes().replace(b"space origin: (10.0", b"space origin: (10.4"))
        with self.assertRaisesRegex(voxplex.FileError, "the origin .*; give read_segmentation.*resample_masks=True"):
            voxplex.mesh([paths[0], coarse])
        with self.assertWarns(voxplex.MeshingWarning):
            image = voxplex.read_segmentation([paths[1], coarse], resample_masks=True)
        self.assertEqual(image.names, {1: "femur", 2: "coarse"})
        with self.assertRaisesRegex(FileNotFoundError, "none"):
            voxplex.read_segmentation([*paths, self.folder / "none"])
        with self.assertRaisesRegex(ValueError, "list of files is empty"):
            voxplex.read_segmentation([])
        with self.assertRaisesRegex(ValueError, "overlap.*largest"):
            voxplex.read_segmentation(paths, overlap="largest")
        with self.assertRaisesRegex(TypeError, "size_image must be one image"):
            voxplex.mesh(self.labels, 2.0, size_image=paths)

    def test_dicom_segmentation(self):
        file = Path(__file__).resolve().parents[1] / "IO" / "highdicom" / "fractional.dcm"
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # what overlaps
            mesh = voxplex.mesh(file, 2.0)
            image = voxplex.read_segmentation(file, mask_threshold=0.7)
        self.assertEqual(mesh.names, {1: "Liver", 2: "Rib, left", 3: "Tumour"})
        self.assertEqual((image.names, set(numpy.unique(image.voxels))), ({1: "Liver", 2: "Rib, left"}, {0, 1, 2}))
        with self.assertRaisesRegex(ValueError, "mask_threshold: must lie between 0 and 1, not 2"):
            voxplex.read_segmentation(file, mask_threshold=2)

    def test_masks_in_memory(self):
        """By name: arrays, images, masked and real ones, and files."""
        whole, part, empty = self.labels > 0, self.labels == 9, self.labels < 0
        both = numpy.where(part, 2, whole)
        words = ["masks overlap in 288 voxels, which the smallest of them gets: the knee _ left and femur (288)",
                 "masks without a voxel: none"]
        masks = {"the knee / left": whole, "femur": 0.5 + 0.4 * part, "none": empty}
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            image = voxplex.read_segmentation(masks, spacing=SPACING, origin=ORIGIN, direction=DIRECTION)
        self.assertEqual([str(warning.message) for warning in told], words)
        numpy.testing.assert_array_equal(image.voxels, both)
        numpy.testing.assert_allclose(image.origin, ORIGIN)
        numpy.testing.assert_allclose(image.direction * image.spacing, DIRECTION * SPACING)
        self.assertEqual((image.names, image.space), ({1: "the knee / left", 2: "femur"}, None))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            self.assertEqual(voxplex.read_segmentation(masks, overlap="order").names, {1: "the knee / left"})
            mesh = voxplex.mesh(masks, 2.0, spacing=SPACING, labels=["femur"])
            self.assertEqual((mesh.names[2], set(mesh.labels)), ("femur", {2}))
            self.assertEqual(voxplex.quality(mesh, masks, spacing=SPACING, labels=["femur"])["image"]["lost_labels"], [])
            place = {"spacing": SPACING, "origin": ORIGIN, "direction": DIRECTION}
            mixed = {'a, "b"': voxplex.Image(numpy.ma.array(whole, mask=self.labels == 5), **place), "file": self.image}
            image = voxplex.read_segmentation(mixed)
        numpy.testing.assert_array_equal(image.voxels, numpy.where(part, 1, 2 * whole))
        self.assertEqual((image.names, image.space), ({1: 'a, "b"', 2: "file"}, "LPS"))
        one = voxplex.read_segmentation({"only": self.labels})  # a mask, too
        self.assertEqual((one.names, set(one.voxels.flat)), ({1: "only"}, {0, 1}))
        frames = voxplex.mesh([{"ball": frame} for frame in beating()], 2.0)
        self.assertEqual((frames.cells.shape[1], frames.names), (5, {1: "ball"}))
        series = [{"none": 0 * frame, "ball": frame} for frame in beating()]
        self.assertEqual(voxplex.mesh(series, 2.0).names, {2: "ball"})
        series[1] = {"ball": series[1]["ball"], "none": series[1]["none"]}
        for wrong in (series, [series[0], beating()[1]]):
            with self.assertRaisesRegex(ValueError, "must have the same names, in the same order"):
                voxplex.mesh(wrong, 2.0)

    def test_masks_without_a_place(self):
        """Arrays, and files that do not say where they lie, beside images that do."""
        place = {"spacing": SPACING, "origin": ORIGIN, "direction": DIRECTION}
        first, second = self.labels == 9, self.labels > 0
        path = os.path.join(self.folder, "plain.nrrd")
        with open(path, "wb") as file:
            file.write(f"NRRD0004\ntype: uint8\ndimension: 3\nsizes: {' '.join(map(str, first.shape[::-1]))}\nencoding: raw\n\n"
                       .encode() + first.tobytes())
        for mask in (first, first.astype(float), path):
            for masks in ({"a": mask, "b": voxplex.Image(second, **place)}, {"b": self.image, "a": mask}):
                for read in (voxplex.read_segmentation, lambda masks: image_of(masks, {}, None)):
                    with self.assertWarnsRegex(voxplex.MeshingWarning, "do not say where they lie were put where .*: the mask 'a'"):
                        image = read(masks)
                    numpy.testing.assert_allclose(image.origin, ORIGIN)
                    numpy.testing.assert_allclose(image.direction * image.spacing, DIRECTION * SPACING)
                    numpy.testing.assert_array_equal(image.voxels > 0, second)
            with self.assertRaisesRegex(voxplex.FileError, "the mask 'a' does not say where it lies, and must have the size"):
                voxplex.read_segmentation({"a": mask, "b": voxplex.Image(second[1:], **place)})
        with self.assertWarnsRegex(voxplex.MeshingWarning, "the mask 'a'"):
            image = voxplex.read_segmentation({"a": first, "b": self.image}, spacing=(9, 9, 9))
        numpy.testing.assert_allclose(image.origin, ORIGIN)

    def test_masks_on_other_grids(self):
        fine, coarse = numpy.ones((6, 8, 10), bool), numpy.ones((2, 4, 5), bool)
        masks = {"fine": voxplex.Image(fine), "coarse": voxplex.Image(coarse, spacing=(2, 2, 2), space="RAS", origin=(-9, -7, 0),
                                                                      direction=numpy.diag((1, 1, 1)))}
        with self.assertRaisesRegex(voxplex.FileError, "one grid, but the mask 'fine' has the spacing 1 1 1, and the mask 'coarse' 2 2 2; "
                                                       "give read_segmentation.*resample_masks=True"):
            voxplex.read_segmentation(masks)
        with self.assertWarnsRegex(voxplex.MeshingWarning, "fine and coarse"):
            image = voxplex.read_segmentation(masks, resample_masks=True, overlap="smallest", space="RAS")
        expected = numpy.ones((6, 8, 10))
        k, j, i = numpy.indices(expected.shape)
        # The coarse one, whose first voxel is at (9, 7, 0) in LPS, has axes against those of the fine one. Ties go to even ones.
        near = numpy.rint([(9 - i) / 2, (7 - j) / 2, k / 2])
        expected[((near >= 0) & (near < numpy.reshape((5, 4, 2), (3, 1, 1, 1)))).all(axis=0)] = 2
        numpy.testing.assert_array_equal(image.voxels, expected)
        self.assertEqual(image.space, "RAS")

    def test_masks_refused(self):
        mask = self.labels > 0
        for masks, error, words in (
                ({}, ValueError, "dictionary of masks is empty"), ({1: mask}, ValueError, "none is called 1"),
                ({"a\nb": mask}, ValueError, "in one line"), ({"a": mask, "b": mask[1:]}, ValueError, "different shapes: .*; give images"),
                ({"a": mask, "b": beating()}, voxplex.FileError, "the mask 'b' is no mask.* 4 time frames"),
                ({"a": mask, "b": mask * 2.5}, voxplex.FileError, "the mask 'b' is no mask.* 2.5, and the real numbers"),
                ({"a": "none.nrrd"}, FileNotFoundError, "none.nrrd"), ({"a": None}, TypeError, "dictionary of these")):
            with self.subTest(words), self.assertRaisesRegex(error, words):
                voxplex.read_segmentation(masks)
        with self.assertRaisesRegex(ValueError, "label_table, series_uid: not with"):
            voxplex.read_segmentation({"a": mask}, label_table="names.csv")
        with self.assertRaisesRegex(ValueError, "times: not with a dictionary"):
            voxplex.mesh({"a": mask}, times=(0, 1))
        with self.assertRaisesRegex(ValueError, "spacing: only for arrays"):
            voxplex.mesh({"a": voxplex.Image(mask)}, spacing=(1, 1, 1))

    def test_read_series(self):
        image = voxplex.read_segmentation(self.series)
        numpy.testing.assert_array_equal(image.voxels, beating())
        self.assertEqual(image.times, [0, 1, 2, 3])

    def test_mesh_of_a_path(self):
        from_path = voxplex.mesh(self.image, 1.5, threads=1)
        from_image = voxplex.mesh(voxplex.read_segmentation(self.image), 1.5, threads=1)
        numpy.testing.assert_array_equal(from_path.points, from_image.points)
        from_array = voxplex.mesh(self.labels, 1.5, threads=1, spacing=SPACING, origin=ORIGIN, direction=DIRECTION)
        numpy.testing.assert_allclose(from_path.points.mean(axis=0), from_array.points.mean(axis=0), atol=0.2)
        series = voxplex.mesh(self.series, 2.0, pick_slivers=False)
        self.assertEqual(series.cells.shape[1], 5)
        self.assertEqual(series.times.max(), 3.0)
        series = voxplex.mesh(self.series, 2.0, pick_slivers=False, times=(0.5, 1.0, 2.0, 4.5))
        self.assertEqual((series.times.min(), series.times.max()), (0.5, 4.5))
        self.assertEqual(len(voxplex.mesh(voxplex.read_segmentation(self.series), 2.0, pick_slivers=False, threads=1).cells),
                         len(voxplex.mesh(self.series, 2.0, pick_slivers=False, threads=1).cells))

    def test_names(self):
        """Names choose labels, and reach the mesh and its file."""
        image = voxplex.read_segmentation(self.image)
        image.names = {5: "liver", 9: "spleen"}
        mesh = voxplex.mesh(image, 1.5, labels=["spleen"])
        self.assertEqual(set(mesh.labels), {9})
        mesh.write(self.folder / "named.inp")
        self.assertIn("spleen", (self.folder / "named.inp").read_text())

    def test_names_of_the_file(self):
        """3D Slicer's segment metadata, and a table."""
        path = self.folder / "named.seg.nrrd"
        write_nrrd(path, self.labels, {
            "Segment0_ID": "Segment_1", "Segment0_LabelValue": 5, "Segment0_Layer": 0, "Segment0_Name": "liver",
            "Segment1_ID": "Segment_2", "Segment1_LabelValue": 9, "Segment1_Layer": 0, "Segment1_Name": "spleen"})
        self.assertEqual(voxplex.read_segmentation(path).names, {5: "liver", 9: "spleen"})
        mesh = voxplex.mesh(path, 1.5, labels=["spleen"])
        self.assertEqual((set(mesh.labels), mesh.names, mesh.interfaces.names), ({9}, {9: "spleen"}, {9: "spleen"}))
        table = self.folder / "table.txt"
        table.write_text("5 kidney\n9 bladder\n")
        image = voxplex.read_segmentation(self.image, label_table=table)
        self.assertEqual(image.names, {5: "kidney", 9: "bladder"})
        with self.assertRaises(FileNotFoundError):
            voxplex.read_segmentation(self.image, label_table=self.folder / "none.txt")

    @unittest.skipUnless(meshfiles, "there is no VTK")
    def test_write(self):
        mesh = voxplex.mesh(self.image, 1.5)
        mesh.write(self.folder / "mesh.vtu", interfaces=self.folder / "plc.stl")
        read = meshfiles.read_tetrahedra(self.folder / "mesh.vtu")
        numpy.testing.assert_array_equal(read.points, mesh.points)
        numpy.testing.assert_array_equal(read.cells, mesh.cells)
        numpy.testing.assert_array_equal(read.labels, mesh.labels)
        triangles = (self.folder / "plc.stl").read_bytes()[80:84]
        self.assertEqual(int.from_bytes(triangles, "little"), len(mesh.interfaces.cells))
        for name in ("mesh.inp", "mesh.msh", "mesh.mesh"):
            mesh.write(self.folder / name)
            self.assertGreater((self.folder / name).stat().st_size, 1000)
        self.assertIn("*SURFACE", (self.folder / "mesh.inp").read_text().upper())

    def test_same_as_the_program(self):
        """A mesh that went through Python is written as the program writes it."""
        mesh = voxplex.mesh(self.image, 2.0, threads=1)
        for name in ("mesh.vtu", "mesh.inp", "mesh.msh", "mesh.mesh", "mesh.mfem", "mesh.feb", "mesh.vtk"):
            mesh.write(self.folder / name, interfaces=self.folder / "plc.vtp")
            ours, surfaces = (self.folder / name).read_bytes(), (self.folder / "plc.vtp").read_bytes()
            subprocess.run([voxplex.program.path(), "--input", self.image, "--delta", "2", "--threads", "1", "--output",
                            self.folder / name, "--plc", self.folder / "plc.vtp"], check=True, stdout=subprocess.DEVNULL)
            self.assertEqual(ours, (self.folder / name).read_bytes(), name)
            self.assertEqual(surfaces, (self.folder / "plc.vtp").read_bytes())

    @unittest.skipUnless(meshfiles, "there is no VTK")
    def test_write_space_time(self):
        mesh = voxplex.mesh(self.series, 2.0, pick_slivers=False)
        mesh.write(self.folder / "mesh.vtu", interfaces=self.folder / "boundary.vtu")
        read = meshfiles.read_pentatopes(self.folder / "mesh.vtu")
        numpy.testing.assert_array_equal(read.cells, mesh.cells)
        self.assertGreater((self.folder / "boundary.vtu").stat().st_size, 1000)
        with self.assertRaisesRegex(voxplex.FileError, "^interfaces: the format '.mfem' is not known here.*of a space-time image .vtu"):
            mesh.write(interfaces=self.folder / "boundary.mfem")

    @unittest.skipUnless(meshfiles, "there is no VTK")
    def test_write_slabs(self):
        mesh = voxplex.mesh(self.series, 2.0, pick_slivers=False, time_scale=3.0, time_planes="frames")
        mesh.write(self.folder / "mesh.vtu", slabs=self.folder / "slab")
        files = sorted(self.folder.glob("slab*.vtu"))
        self.assertEqual(len(files), len(mesh.field_data["TimePlanes"]) + 1)
        self.assertEqual(sum(len(meshfiles.read_pentatopes(file).cells) for file in files), len(mesh.cells))

    def test_space_of_the_mesh(self):
        """A file is read in the coordinates of what is in memory."""
        image = voxplex.read_segmentation(self.image, space="RAS")
        mesh = voxplex.mesh(image, 2.0)
        self.assertEqual(voxplex.quality(mesh, self.image), voxplex.quality(mesh, image))
        sizes = self.folder / "sizes.nrrd"
        values = numpy.zeros(self.labels.shape, dtype=numpy.float32)
        values[:, :, 10:] = 0.8
        write_nrrd(sizes, values)
        finer = voxplex.mesh(image, 2.0, size_image=sizes, threads=1)
        self.assertGreater(len(finer.cells), 1.5 * len(mesh.cells))
        expected = voxplex.mesh(image, 2.0, size_image=voxplex.read_segmentation(sizes, space="RAS"), threads=1)
        numpy.testing.assert_array_equal(finer.points, expected.points)

    def test_interfaces_follow_the_mesh(self):
        mesh = voxplex.mesh(self.image, 2.0)
        mesh.points[:] *= 0.001
        mesh.write(self.folder / "mesh.inp", interfaces=self.folder / "plc.stl")
        triangles = numpy.frombuffer((self.folder / "plc.stl").read_bytes()[84:], dtype=numpy.uint8).reshape(-1, 50)
        corners = numpy.ascontiguousarray(triangles[:, 12:48]).view("<f4").reshape(-1, 3)
        numpy.testing.assert_allclose(corners.max(axis=0), mesh.points.max(axis=0), rtol=1e-6)

    def test_no_mesh(self):
        mesh = voxplex.mesh(self.image, 2.0)
        mesh.points[3] = numpy.nan
        with self.assertRaisesRegex(voxplex.FileError, "Point 3 of the mesh is not finite"):
            mesh.write(self.folder / "mesh.inp")

    def test_full_temporary_folder(self):
        ours = "the temporary folder .* is full.*TMPDIR"
        for error, words in ((OSError(errno.ENOSPC, "No space left on device"), ours),
                             (OSError(errno.EDQUOT, "Disk quota exceeded"), ours),
                             (voxplex.FileError("cannot write the mesh: No space left on device"), ours),
                             (voxplex.FileError("cannot write '/folder/voxplex-ab12_xyz/interfaces.vtu': Disk quota exceeded"), ours),
                             (voxplex.FileError("cannot write '/home/voxplex-1/mesh.vtu': No space left on device"), "^cannot write")):
            with self.subTest(error), unittest.mock.patch("voxplex.program.run", side_effect=error):
                with self.assertRaisesRegex(voxplex.FileError, words):
                    voxplex.mesh(self.labels, 2.0)

    def test_no_temporary_folder(self):
        nowhere = FileNotFoundError(errno.ENOENT, "No usable temporary directory found in ['/tmp']")
        with unittest.mock.patch("tempfile.gettempdir", side_effect=nowhere):
            with self.assertRaisesRegex(voxplex.FileError, "^No usable temporary directory found in .*; name one .* TMPDIR$"):
                voxplex.mesh(self.labels, 2.0)

    def test_refusals(self):
        mesh = voxplex.mesh(self.image, 3.0)
        before = sorted(self.folder.iterdir())
        broken = self.folder / "broken.nrrd"
        broken.write_bytes(self.image.read_bytes()[:600])
        cases = [
            (FileNotFoundError, "none.nrrd", lambda: voxplex.read_segmentation(self.folder / "none.nrrd")),
            (FileNotFoundError, "none.nrrd", lambda: voxplex.mesh(str(self.folder / "none.nrrd"))),
            (voxplex.FileError, "broken.nrrd", lambda: voxplex.read_segmentation(broken)),
            (voxplex.FileError, "broken.nrrd", lambda: voxplex.mesh(broken)),
            (OSError, "", lambda: voxplex.read_segmentation(__file__)),
            (ValueError, "space", lambda: voxplex.read_segmentation(self.image, space="XYZ")),
            (voxplex.FileError, "xyz", lambda: mesh.write(self.folder / "mesh.xyz")),
            (voxplex.FileError, "no-folder", lambda: mesh.write(self.folder / "no-folder" / "mesh.vtu")),
            (voxplex.FileError, "stl", lambda: mesh.write(self.folder / "mesh.stl")),
            (TypeError, "path", mesh.write),
            (voxplex.FileError, "^slabs: the mesh has no time planes", lambda: mesh.write(self.folder / "s.vtu", slabs="s")),
        ]
        for kind, words, call in cases:
            with self.subTest(words=words), self.assertRaisesRegex(kind, words):
                call()
        self.assertEqual(sorted(self.folder.iterdir()), sorted([*before, broken]))

    def test_nothing_is_printed(self):
        with tempfile.TemporaryFile() as file:
            sys.stderr.flush()
            saved = os.dup(2)
            os.dup2(file.fileno(), 2)
            try:
                for call in (lambda: voxplex.read_segmentation(__file__),
                             lambda: voxplex.mesh(self.image, 1.5).write(self.folder / "mesh.xyz")):
                    with self.assertRaises(voxplex.FileError):
                        call()
            finally:
                os.dup2(saved, 2)
                os.close(saved)
            file.seek(0)
            self.assertEqual(file.read(), b"")


if __name__ == "__main__":
    unittest.main()
