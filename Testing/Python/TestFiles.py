#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Reading of segmentations and writing of meshes."""

import os
import sys
import tempfile
import unittest
import unittest.mock
import warnings
from pathlib import Path

import numpy
from vtkmodules.vtkCommonDataModel import vtkDataObject
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLUnstructuredGridReader

import voxplex
from phantoms import beating, brick

DIRECTION = numpy.array([[0.8, -0.6, 0], [0.48, 0.64, -0.6], [0.36, 0.48, 0.8]])
SPACING = numpy.array([0.5, 1.0, 2.0])
ORIGIN = numpy.array([10.0, -20.0, 30.0])


def write_nrrd(path, array, fields=()):
    """array: [k, j, i] or [t, k, j, i]; placed by the constants above."""
    columns = [f"({','.join(repr(float(x)) for x in DIRECTION[:, axis] * SPACING[axis])})" for axis in range(3)]
    kinds = ["domain"] * 3
    if array.ndim == 4:
        columns.append("none")
        kinds.append("list")
    header = ["NRRD0005", f"type: {array.dtype.name}", f"dimension: {array.ndim}", "space: left-posterior-superior",
              f"sizes: {' '.join(map(str, array.shape[::-1]))}", f"space directions: {' '.join(columns)}",
              f"kinds: {' '.join(kinds)}", "endian: little", "encoding: raw",
              f"space origin: ({','.join(repr(float(x)) for x in ORIGIN)})", *fields]
    path.write_bytes(("\n".join(header) + "\n\n").encode() + array.tobytes())


class Files(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.labels = brick().astype(numpy.int16)
        self.image = self.folder / "labels.nrrd"
        write_nrrd(self.image, self.labels)
        self.series = self.folder / "series.nrrd"
        write_nrrd(self.series, beating())

    def grid(self, path):
        reader = vtkXMLUnstructuredGridReader()
        reader.SetFileName(str(path))
        reader.Update()
        return reader.GetOutput()

    def test_read(self):
        image = voxplex.read_segmentation(self.image)
        numpy.testing.assert_array_equal(voxplex.array_from_image(image), self.labels)
        numpy.testing.assert_allclose(image.GetSpacing(), SPACING)
        numpy.testing.assert_allclose(image.GetOrigin(), ORIGIN)
        matrix = image.GetDirectionMatrix()
        numpy.testing.assert_allclose([[matrix.GetElement(r, c) for c in range(3)] for r in range(3)], DIRECTION, atol=1e-6)
        self.assertEqual(image.GetFieldData().GetAbstractArray("SPACE").GetValue(0), "LPS")
        other = voxplex.read_segmentation(str(self.image), space="RAS")
        numpy.testing.assert_allclose(other.GetOrigin(), ORIGIN * (-1, -1, 1))
        self.assertEqual(other.GetFieldData().GetAbstractArray("SPACE").GetValue(0), "RAS")

    def test_names_that_are_no_text(self):
        path = os.fsdecode(os.fsencode(self.folder) + b"/\xe9.nrrd")
        os.rename(self.image, path)
        image = voxplex.read_segmentation(path)
        numpy.testing.assert_array_equal(voxplex.array_from_image(image), self.labels)
        mesh = os.fsdecode(os.fsencode(self.folder) + b"/\xe9.vtu")
        voxplex.write(voxplex.mesh(image, delta=2), mesh)
        self.assertTrue(os.path.exists(mesh))
        Path(path).write_bytes(b"no image")
        with self.assertRaisesRegex(voxplex.FileError, ".nrrd': it is not an image"):
            voxplex.read_segmentation(path)

    def test_place(self):
        """What the caller says counts before the file, for images, series and meshes."""
        place = dict(spacing=(1.0, 2.0, 4.0), origin=(1, 2, 3), direction=numpy.diag([-1.0, -1.0, 1.0]))
        for image in (voxplex.read_segmentation(self.image, **place), *voxplex.read_frames(self.series, **place),
                      voxplex.read_segmentation(self.image, space="RAS", **place)):
            numpy.testing.assert_allclose(image.GetSpacing(), place["spacing"])
            numpy.testing.assert_allclose(image.GetOrigin(), place["origin"])
            matrix = image.GetDirectionMatrix()
            numpy.testing.assert_allclose([matrix.GetElement(n, n) for n in range(3)], (-1, -1, 1))
        numpy.testing.assert_allclose(voxplex.read_segmentation(self.image, origin=(1, 2, 3)).GetSpacing(), SPACING)
        from_path = voxplex.mesh(self.image, 2.0, threads=1, **place)
        from_array = voxplex.mesh(self.labels, 2.0, threads=1, **place)
        numpy.testing.assert_allclose(voxplex.points(from_path), voxplex.points(from_array))
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
                             ("direction is .*; its columns must be independent", dict(direction=numpy.ones(9)))):
            with self.subTest(words=words, place=place):
                for call in (voxplex.read_segmentation, voxplex.mesh):
                    with self.assertRaisesRegex(ValueError, words):
                        call(self.image, **place)

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
        words = 'there are 2 series; choose one with\n  SetSeriesUID("1.2.3")'
        self.assertEqual(voxplex.files._in_terms_of_arguments(words),
                         'there are 2 series; choose one with\n  series_uid="1.2.3"')

    def test_data_files_anywhere(self):
        (self.folder / "headers").mkdir()
        path = self.folder / "headers" / "labels.nhdr"
        write_nrrd(path, self.labels, ["data file: ../labels.raw"])
        header, voxels = path.read_bytes().split(b"\n\n", 1)
        path.write_bytes(header + b"\n")
        (self.folder / "labels.raw").write_bytes(voxels)
        words = r"or use read_segmentation\(..., data_files_anywhere=True\) if you trust the header"
        for call in (voxplex.read_segmentation, voxplex.read_frames, voxplex.mesh):
            with self.assertRaisesRegex(voxplex.FileError, words):
                call(path)
        image = voxplex.read_segmentation(path, data_files_anywhere=True)
        numpy.testing.assert_array_equal(voxplex.array_from_image(image), self.labels)
        self.assertEqual(len(voxplex.read_frames(path, data_files_anywhere=True)), 1)

    def test_read_series(self):
        with self.assertRaisesRegex(ValueError, "4 time frames: pass frame="):
            voxplex.read_segmentation(self.series)
        with self.assertRaisesRegex(ValueError, "4 time frames, not number 4"):
            voxplex.read_segmentation(self.series, frame=4)
        frames = voxplex.read_frames(self.series)
        self.assertEqual(len(frames), 4)
        for number, (frame, expected) in enumerate(zip(frames, beating())):
            numpy.testing.assert_array_equal(voxplex.array_from_image(frame), expected)
            self.assertEqual(frame.GetInformation().Get(vtkDataObject.DATA_TIME_STEP()), number)
            single = voxplex.read_segmentation(self.series, frame=number)
            numpy.testing.assert_array_equal(voxplex.array_from_image(single), expected)
        self.assertEqual(len(voxplex.read_frames(self.image)), 1)

    def test_mesh_of_a_path(self):
        from_path = voxplex.mesh(self.image, 1.5, threads=1)
        from_image = voxplex.mesh(voxplex.read_segmentation(self.image), 1.5, threads=1)
        numpy.testing.assert_array_equal(voxplex.points(from_path), voxplex.points(from_image))
        from_array = voxplex.mesh(self.labels, 1.5, threads=1, spacing=SPACING, origin=ORIGIN, direction=DIRECTION)
        numpy.testing.assert_allclose(voxplex.points(from_path).mean(axis=0), voxplex.points(from_array).mean(axis=0), atol=0.2)
        series = voxplex.mesh(self.series, 2.0, pick_slivers=False)
        self.assertEqual(voxplex.pentatopes(series).shape[1], 5)
        self.assertEqual(voxplex.times(series).max(), 3.0)
        series = voxplex.mesh(self.series, 2.0, pick_slivers=False, times=(0.5, 1.0, 2.0, 4.5))
        self.assertEqual((voxplex.times(series).min(), voxplex.times(series).max()), (0.5, 4.5))
        self.assertEqual(voxplex.mesh(voxplex.read_frames(self.series), 2.0, pick_slivers=False, threads=1).GetNumberOfCells(),
                         voxplex.mesh(self.series, 2.0, pick_slivers=False, threads=1).GetNumberOfCells())

    def test_names(self):
        """Names choose labels, and reach the mesh and its file."""
        image = voxplex.read_segmentation(self.image)
        voxplex.set_label_names(image, {5: "liver", 9: "spleen"})
        mesh = voxplex.mesh(image, 1.5, labels=["spleen"])
        self.assertEqual(set(voxplex.labels(mesh)), {9})
        voxplex.write(mesh, self.folder / "named.vtu")
        self.assertEqual(voxplex.label_names(self.grid(self.folder / "named.vtu")), {5: "liver", 9: "spleen"})

    def test_names_of_the_file(self):
        """3D Slicer's segment metadata, and a table."""
        path = self.folder / "named.seg.nrrd"
        write_nrrd(path, self.labels, [
            "Segment0_ID:=Segment_1", "Segment0_LabelValue:=5", "Segment0_Layer:=0", "Segment0_Name:=liver",
            "Segment1_ID:=Segment_2", "Segment1_LabelValue:=9", "Segment1_Layer:=0", "Segment1_Name:=spleen"])
        self.assertEqual(voxplex.label_names(voxplex.read_segmentation(path)), {5: "liver", 9: "spleen"})
        mesh = voxplex.mesh(path, 1.5, labels=["spleen"])
        self.assertEqual(set(voxplex.labels(mesh)), {9})
        self.assertEqual(voxplex.label_names(mesh), {5: "liver", 9: "spleen"})
        table = self.folder / "table.txt"
        table.write_text("5 kidney\n9 bladder\n")
        image = voxplex.read_segmentation(self.image, label_table=table)
        self.assertEqual(voxplex.label_names(image), {5: "kidney", 9: "bladder"})
        with self.assertRaises(FileNotFoundError):
            voxplex.read_segmentation(self.image, label_table=self.folder / "none.txt")

    def test_write(self):
        mesh, interfaces, _ = voxplex.mesh(self.image, 1.5, full_output=True)
        path = self.folder / "mesh.vtu"
        voxplex.write(mesh, path)
        grid = self.grid(path)
        numpy.testing.assert_array_equal(voxplex.points(grid), voxplex.points(mesh))
        numpy.testing.assert_array_equal(voxplex.tets(grid), voxplex.tets(mesh))
        numpy.testing.assert_array_equal(voxplex.labels(grid), voxplex.labels(mesh))
        voxplex.write(interfaces, str(self.folder / "plc.vtp"))
        reader = vtkXMLPolyDataReader()
        reader.SetFileName(str(self.folder / "plc.vtp"))
        reader.Update()
        numpy.testing.assert_array_equal(voxplex.triangles(reader.GetOutput()), voxplex.triangles(interfaces))
        numpy.testing.assert_array_equal(voxplex.labels(reader.GetOutput()), voxplex.labels(interfaces))
        for name in ("mesh.inp", "mesh.msh", "mesh.mesh"):
            voxplex.write(mesh, self.folder / name, interfaces=interfaces)
            self.assertGreater((self.folder / name).stat().st_size, 1000)

    def test_interfaces_reach_the_writer(self):
        mesh, interfaces, _ = voxplex.mesh(self.image, 3.0, full_output=True)
        with unittest.mock.patch("voxplex.files.vtkSimplexMeshWriter") as kind:
            writer = kind.return_value
            writer.GetErrorMessage.return_value = ""
            voxplex.write(mesh, "mesh.inp", interfaces=interfaces)
        self.assertEqual(writer.SetInputData.call_args_list, [((0, mesh),), ((1, interfaces),)])

    def test_write_space_time(self):
        mesh, boundary, _ = voxplex.mesh(self.series, 2.0, pick_slivers=False, full_output=True)
        voxplex.write(mesh, self.folder / "mesh.vtu")
        numpy.testing.assert_array_equal(voxplex.pentatopes(self.grid(self.folder / "mesh.vtu")), voxplex.pentatopes(mesh))
        voxplex.write(boundary, self.folder / "boundary.vtu")
        grid = self.grid(self.folder / "boundary.vtu")
        numpy.testing.assert_array_equal(voxplex.tets(grid), voxplex.tets(boundary))
        self.assertEqual(voxplex.labels(grid).shape[1], 2)
        with self.assertRaisesRegex(voxplex.FileError, "for this content; use .vtu"):
            voxplex.write(boundary, self.folder / "boundary.mfem")

    def test_write_a_slab(self):
        mesh, boundary, _ = voxplex.mesh(self.series, 2.0, pick_slivers=False, time_scale=3.0, time_planes="frames",
                                         full_output=True)
        self.assertIsNotNone(mesh.GetCellData().GetArray("Slab"))
        written = 0
        for slab in range(mesh.GetFieldData().GetArray("TimePlanes").GetNumberOfTuples() + 1):
            voxplex.write(mesh, self.folder / "slab.vtu", interfaces=boundary, slab=slab)
            written += self.grid(self.folder / "slab.vtu").GetNumberOfCells()
        self.assertEqual(written, mesh.GetNumberOfCells())
        with self.assertRaisesRegex(voxplex.FileError, "it has no slab 90"):
            voxplex.write(mesh, self.folder / "slab.vtu", slab=90)
        with self.assertRaisesRegex(ValueError, "interfaces have no slabs"):
            voxplex.write(boundary, self.folder / "slab.vtu", slab=0)

    def test_refusals(self):
        mesh, interfaces, _ = voxplex.mesh(self.image, 3.0, full_output=True)
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
            (voxplex.FileError, "xyz", lambda: voxplex.write(mesh, self.folder / "mesh.xyz")),
            (voxplex.FileError, "no-folder", lambda: voxplex.write(mesh, self.folder / "no-folder" / "mesh.vtu")),
            (voxplex.FileError, "stl", lambda: voxplex.write(mesh, self.folder / "mesh.stl")),
            (ValueError, "both interfaces", lambda: voxplex.write(interfaces, self.folder / "a.vtp", interfaces=interfaces)),
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
                             lambda: voxplex.write(voxplex.mesh(self.image, 3.0), self.folder / "mesh.xyz")):
                    with self.assertRaises(voxplex.FileError):
                        call()
            finally:
                os.dup2(saved, 2)
                os.close(saved)
            file.seek(0)
            self.assertEqual(file.read(), b"")


if __name__ == "__main__":
    unittest.main()
