#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""vtkSegmentationReader: place in space, frames, errors, and when it reads."""
import gc
import os
import unittest
from pathlib import Path

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as Pipeline

import images
import voxplex
from iotesting import FolderTestCase, warnings_of

OBLIQUE = images.Geometry((10.0, -20.0, 30.0), (0.5, 1.25, 2.0),
                          np.array([[0.8, 0.6, 0.0], [-0.6, 0.8, 0.0], [0.0, 0.0, -1.0]]), 3.0, 0.5)


def voxels(image):
    """Indexed [k, j, i]."""
    labels = image.GetPointData().GetArray("Labels")
    return vtk_to_numpy(labels).reshape(image.GetDimensions()[::-1])


def position(image, index):
    point = [0.0] * 3
    image.TransformContinuousIndexToPhysicalPoint([float(i) for i in index], point)
    return point


def space(image):
    return image.GetFieldData().GetAbstractArray("SPACE").GetValue(0)


class Reading(FolderTestCase):
    def test_geometry(self):
        array = images.two_labels(10, 4.0)
        for write, name in ((images.write_nrrd, "i.nrrd"), (images.write_metaimage, "i.mha"),
                            (images.write_nifti, "i.nii.gz")):
            for choice, flip in ((0, (1, 1, 1)), (1, (-1, -1, 1))):
                with self.subTest(name=name, choice=choice):
                    path = write(self.folder / name, array, OBLIQUE)
                    image = self.read(path, Space=choice)
                    self.assertEqual(space(image), ("LPS", "RAS")[choice])
                    np.testing.assert_array_equal(voxels(image), array)
                    self.assertIs(image.GetPointData().GetScalars(), image.GetPointData().GetArray("Labels"))
                    for index in ((0, 0, 0), (9, 1, 4)):
                        np.testing.assert_allclose(position(image, index), OBLIQUE.physical(index) * flip, atol=1e-5)

    def test_information_before_data(self):
        reader = voxplex.vtkSegmentationReader()
        reader.SetFileName(Path(images.write_nrrd(self.folder / "i.nrrd", images.ball(9, 3.0), OBLIQUE)))
        reader.UpdateInformation()
        information = reader.GetOutputInformation(0)
        self.assertEqual(information.Get(Pipeline.WHOLE_EXTENT()), (0, 8) * 3)
        np.testing.assert_allclose(information.Get(reader.GetOutputDataObject(0).SPACING()), OBLIQUE.spacing)
        np.testing.assert_allclose(information.Get(reader.GetOutputDataObject(0).DIRECTION()),
                                   OBLIQUE.direction.ravel(), atol=1e-12)
        self.assertFalse(information.Has(Pipeline.TIME_STEPS()))
        self.assertEqual(reader.GetNumberOfFrames(), 1)

    def test_voxels_outlive_the_reader(self):
        array = images.two_labels(40, 15.0)
        reader = self.reader(images.write_nrrd(self.folder / "i.nrrd", array))
        labels = reader.GetOutput().GetPointData().GetArray("Labels")
        del reader
        gc.collect()
        np.testing.assert_array_equal(vtk_to_numpy(labels).reshape(array.shape), array)


class Placing(FolderTestCase):
    """What the user says of spacing, origin and direction counts before the file."""

    SPACING, ORIGIN = (0.5, 0.25, 4.0), (-1.0, 2.0, -3.0)
    DIRECTION = np.array([[0.0, 0.6, 0.8], [-1.0, 0.0, 0.0], [0.0, -0.8, 0.6]])

    def setUp(self):
        super().setUp()
        self.array = images.two_labels(10, 4.0)
        self.path = images.write_nrrd(self.folder / "i.nrrd", self.array, OBLIQUE)

    def check(self, image, geometry):
        np.testing.assert_array_equal(voxels(image), self.array)
        for index in ((0, 0, 0), (9, 1, 4)):
            np.testing.assert_allclose(position(image, index), geometry.physical(index), atol=1e-9)

    def test_each_alone(self):
        self.check(self.read(self.path, Spacing=self.SPACING), images.Geometry(OBLIQUE.origin, self.SPACING, OBLIQUE.direction))
        self.check(self.read(self.path, Origin=self.ORIGIN), images.Geometry(self.ORIGIN, OBLIQUE.spacing, OBLIQUE.direction))
        self.check(self.read(self.path, Direction=self.DIRECTION.ravel()),
                   images.Geometry(OBLIQUE.origin, OBLIQUE.spacing, self.DIRECTION))

    def test_parts(self):
        """What is not given is the file's."""
        self.check(self.read(self.path, Spacing=(0, -1, 4.0)), images.Geometry(OBLIQUE.origin, (0.5, 1.25, 4.0), OBLIQUE.direction))
        self.check(self.read(self.path, Origin=(7.0, np.nan, np.nan)),
                   images.Geometry((7.0, -20.0, 30.0), OBLIQUE.spacing, OBLIQUE.direction))

    def test_in_both_spaces(self):
        """Numbers are coordinates of the output, whatever the file has."""
        for choice in (0, 1):
            for write, name in ((images.write_nrrd, "i.nrrd"), (images.write_nifti, "i.nii")):
                with self.subTest(choice=choice, name=name):
                    path = write(self.folder / name, self.array, OBLIQUE)
                    self.check(self.read(path, Space=choice, Spacing=self.SPACING, Origin=self.ORIGIN,
                                         Direction=self.DIRECTION.ravel()),
                               images.Geometry(self.ORIGIN, self.SPACING, self.DIRECTION))

    def test_lengths_of_directions_do_not_count(self):
        image = self.read(self.path, Spacing=self.SPACING, Direction=(self.DIRECTION * [2.0, 0.1, 30.0]).ravel())
        self.check(image, images.Geometry(OBLIQUE.origin, self.SPACING, self.DIRECTION))

    def test_information(self):
        reader = self.reader(self.path, Spacing=self.SPACING)
        information = reader.GetOutputInformation(0)
        np.testing.assert_allclose(information.Get(reader.GetOutputDataObject(0).SPACING()), self.SPACING)

    def test_no_place(self):
        words = r"^SetSpacing\(\), SetOrigin\(\) and SetDirection\(\) give '.*i.nrrd' no place in space: .*independent$"
        self.refused(words, self.path, Direction=(1, 0, 0, 0, 1, 0, 0, 0, 0))
        self.refused(words, self.path, Direction=(1, 1, 0, 1, 1, 0, 0, 0, 1))
        self.refused(words, self.path, Origin=(np.inf, 0, 0))
        self.refused(words, self.path, Spacing=(1, 1, np.inf))

    def test_origin_of_the_file_again(self):
        reader = self.reader(self.path, Origin=self.ORIGIN)
        reader.ClearOrigin()
        reader.Update()
        self.check(reader.GetOutput(), OBLIQUE)
        time = reader.GetMTime()
        reader.ClearOrigin()
        self.assertEqual(reader.GetMTime(), time)

    def test_spacing_that_the_file_lacks(self):
        """The warning asks for a spacing, and goes when there is one, for each axis."""
        path = images.write_nrrd(self.folder / "i.nrrd", self.array, header_lines={
            "space": None, "space directions": None, "space origin": None})
        reader = self.reader(path)
        self.assertEqual(len(warnings_of(reader)), 1)
        self.assertRegex(reader.GetWarning(0), r"no spacing of the voxels, which is taken to be 1; set it with SetSpacing\(\)")
        self.check(reader.GetOutput(), images.Geometry())
        self.assertEqual(len(warnings_of(self.reader(path, Spacing=(0, 0, 2)))), 1)
        self.check(self.read(path, Spacing=self.SPACING), images.Geometry(spacing=self.SPACING))


class DataFiles(FolderTestCase):
    def test_anywhere(self):
        """A header may name files that are not beside it only if the user allows it."""
        array = images.ball(8, 3.0)
        (self.folder / "headers").mkdir()
        (self.folder / "i.raw").write_bytes(array.tobytes())
        for name in ("../i.raw", str(self.folder / "i.raw")):
            path = images.write_nrrd(self.folder / "headers" / "i.nhdr", array,
                                     header_lines={"encoding": "raw", "data file": name})
            with self.subTest(name):
                self.refused(r"not in the folder of the header or below; .*SetDataFilesAnywhere\(\)", path)
                np.testing.assert_array_equal(voxels(self.read(path, DataFilesAnywhere=True)), array)


class Frames(FolderTestCase):
    def setUp(self):
        super().setUp()
        self.array = images.moving_balls(5, 12, 3.0)
        self.path = images.write_sequence(self.folder / "i.nrrd", self.array, OBLIQUE)

    def test_times(self):
        reader = self.reader(self.path)
        information = reader.GetOutputInformation(0)
        self.assertEqual(information.Get(Pipeline.TIME_STEPS()), (3.0, 3.5, 4.0, 4.5, 5.0))
        self.assertEqual(information.Get(Pipeline.TIME_RANGE()), (3.0, 5.0))
        self.assertEqual([reader.GetTimeOfFrame(n) for n in range(reader.GetNumberOfFrames())], [3.0, 3.5, 4.0, 4.5, 5.0])

    def test_frame_that_is_asked_for(self):
        reader = self.reader(self.path)
        np.testing.assert_array_equal(voxels(reader.GetOutput()), self.array[0])
        for time, frame in ((3.5, 1), (4.2, 2), (4.3, 3), (99.0, 4), (-99.0, 0)):
            with self.subTest(time):
                reader.UpdateTimeStep(time)
                image = reader.GetOutput()
                np.testing.assert_array_equal(voxels(image), self.array[frame])
                self.assertEqual(image.GetInformation().Get(image.DATA_TIME_STEP()), 3.0 + 0.5 * frame)
                self.assertEqual(space(image), "LPS")

    def test_times_are_forgotten(self):
        reader = self.reader(self.path)
        reader.SetFileName(images.write_nrrd(self.folder / "j.nrrd", self.array[0]))
        reader.Update()
        self.assertFalse(reader.GetOutputInformation(0).Has(Pipeline.TIME_STEPS()))
        self.assertEqual(reader.GetNumberOfFrames(), 1)


class Errors(FolderTestCase):
    def test_files(self):
        (self.folder / "empty.nrrd").touch()
        (self.folder / "text.nrrd").write_text("hello")
        self.refused("^cannot read '.*none': there is no such file or folder$", self.folder / "none")
        self.refused("the file is empty", self.folder / "empty.nrrd")
        self.refused("not an image in a format that voxplex reads", self.folder / "text.nrrd")
        self.refused("empty.nrrd': the file is empty", self.folder)
        (self.folder / "texts").mkdir()
        (self.folder / "texts" / "a.txt").write_text("hello")
        for name in ("zarr.json", ".zgroup"):
            (self.folder / "a.zarr").mkdir(exist_ok=True)
            (self.folder / "a.zarr" / name).write_text("{}")
            self.refused("it is a Zarr folder: open the array of one resolution in Python", self.folder / "a.zarr")
            (self.folder / "a.zarr" / name).unlink()
        self.refused("the folder holds no DICOM images, no slices .*, and no files that are named as masks", self.folder / "texts")
        self.refused("^no file name is set$", None)
        self.refused("^no file name is set$", "")

    def test_pictures(self):
        """No library for pictures sees them."""
        magic = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR"
        (self.folder / "i.png").write_bytes(magic + np.random.default_rng(5).bytes(1000))
        self.refused("it is a picture of one slice", self.folder / "i.png")

    def test_recovery(self):
        """An error leaves nothing of the image before, and the next image nothing of the error."""
        good = images.write_nrrd(self.folder / "good.nrrd", images.ball(8, 3.0))
        reader = self.reader(good)
        self.assertEqual(reader.GetOutput().GetNumberOfPoints(), 512)
        reader.SetFileName(self.folder / "none")
        reader.Update()
        self.assertRegex(reader.GetErrorMessage(), "no such file")
        self.assertEqual((reader.GetOutput().GetNumberOfPoints(), reader.GetNumberOfFrames()), (0, 0))
        reader.SetFileName(good)
        reader.Update()
        self.assertEqual((reader.GetErrorMessage(), reader.GetOutput().GetNumberOfPoints()), ("", 512))

    def test_warnings(self):
        array = images.moving_balls(3, 8, 2.0)
        reader = self.reader(images.write_nifti(self.folder / "i.nii", array, pixdim=(1, 1, 1, 0)))
        self.assertEqual(len(warnings_of(reader)), 1)
        self.assertRegex(reader.GetWarning(0), "i.nii: .*0 for the time from frame to frame")
        self.assertEqual((reader.GetWarning(1), reader.GetWarning(-1)), ("", ""))

    def test_nothing_is_printed(self):
        """Standard error is never touched."""
        text = self.folder / "stderr"
        kept = os.dup(2)
        descriptor = os.open(text, os.O_WRONLY | os.O_CREAT)
        os.dup2(descriptor, 2)
        try:
            path = Path(images.write_metaimage(self.folder / "i.mha", images.ball(8, 3.0)))
            path.write_bytes(path.read_bytes()[:-100])
            self.refused("it is truncated: 'i.mha' holds 412 of 512 bytes", path)
            os.write(2, b"after\n")
        finally:
            os.dup2(kept, 2)
            os.close(kept)
            os.close(descriptor)
        self.assertEqual(text.read_text(), "after\n")


class Execution(FolderTestCase):
    def test_space_is_no_reason_to_read_again(self):
        """Unless the user gives a place, whose coordinates are those of the space."""
        path = images.write_nrrd(self.folder / "i.nrrd", images.ball(8, 3.0, label=1), images.Geometry((1, 2, 3)))
        reader = self.reader(path)
        images.write_nrrd(self.folder / "i.nrrd", images.ball(8, 3.0, label=2), images.Geometry((1, 2, 3)))
        reader.SetSpace(reader.SPACE_RAS)
        for label, change in ((1, lambda: None), (2, reader.Modified), (2, lambda: reader.SetOrigin(4, 5, 6))):
            change()
            reader.Update()
            self.assertEqual(reader.GetOutput().GetPointData().GetScalars().GetRange(), (0, label))
        self.assertEqual(reader.GetOutput().GetOrigin(), (4, 5, 6))
        reader.SetSpace(reader.SPACE_LPS)
        reader.Update()
        self.assertEqual(reader.GetOutput().GetOrigin(), (4, 5, 6))

    def test_reads_again_when_modified(self):
        path = images.write_nrrd(self.folder / "i.nrrd", images.ball(8, 3.0, label=1))
        reader = self.reader(path)
        images.write_nrrd(self.folder / "i.nrrd", images.ball(8, 3.0, label=2))
        reader.Update()
        self.assertEqual(voxels(reader.GetOutput()).max(), 1)
        reader.Modified()
        reader.Update()
        self.assertEqual(voxels(reader.GetOutput()).max(), 2)

    def test_print(self):
        text = str(self.reader(images.write_nrrd(self.folder / "i.nrrd", images.ball(8, 3.0))))
        for line in ("FileName: .*i.nrrd", "SeriesUID: .none", "LabelTableFileName: .none", "FileNames: 0", "Overlap: smallest",
                     "MaskThreshold: 0.5",
                     "ResampleMasks: off", "Space: LPS", "Spacing: 0 0 0",
                     "Direction: 0 0 0 0 0 0 0 0 0", "DataFilesAnywhere: off", "Frames: 1"):
            self.assertRegex(text, line)


if __name__ == "__main__":
    unittest.main()
