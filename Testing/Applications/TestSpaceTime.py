#!/usr/bin/python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Images of space and time: the mesh lies where and when the frames lie. What is in files is tested in IO/matrix."""
import json
import re

import numpy as np

import images
import meshfiles
from program import ProgramTestCase, main


def rotation(degrees):
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])


class SpaceTimeTestCase(ProgramTestCase):
    def mesh_of(self, path, *arguments, name="mesh.vtu", warning=None, delta=1.5):
        self.mesh("--input", path, "--delta", delta, "--no-picking", "--threads", 1, "--output", name, *arguments,
                  warning=warning)
        mesh = meshfiles.read_pentatopes(self.folder / name)
        self.assertGreater(mesh.volumes().min(), 0.0, "inverted elements")
        return mesh

    def check_balls(self, mesh, array, geometry):
        """Labels, times, hypervolumes and centroids in space against the voxels."""
        times = geometry.times(len(array))
        self.assertEqual(set(mesh.labels), set(np.unique(array)) - {0})
        self.assertAlmostEqual(mesh.points[:, 3].min(), times[0], delta=1e-6 * geometry.time_step)
        self.assertAlmostEqual(mesh.points[:, 3].max(), times[-1], delta=1e-6 * geometry.time_step)
        # The first and the last frame end the mesh: they count half.
        weights = np.full(len(array), geometry.time_step)
        weights[[0, -1]] /= 2
        volumes = mesh.volumes()
        for label in np.unique(mesh.labels):
            index = np.argwhere(array == label)
            voxels = weights[index[:, 0]]
            own = mesh.labels == label
            expected = voxels.sum() * geometry.voxel_volume()
            self.assertAlmostEqual(volumes[own].sum() / expected, 1.0, delta=0.12)
            centers = mesh.points[mesh.cells[own]].mean(axis=1)
            centroid = volumes[own] @ centers / volumes[own].sum()
            middle = voxels @ geometry.physical(index[:, :0:-1]) / voxels.sum()
            np.testing.assert_allclose(centroid[:3], middle, atol=0.35)
            self.assertAlmostEqual(centroid[3], (voxels @ times[index[:, 0]]) / voxels.sum(),
                                   delta=0.25 * geometry.time_step)


class Times(SpaceTimeTestCase):
    def test_zero_step_of_nifti(self):
        path = images.write_nifti(self.folder / "heart.nii", images.moving_balls(7, 16), pixdim=[1, 1, 1, 0])
        mesh = self.mesh_of(path, warning="heart.nii: .*0 for the time from frame to frame.* taken to be 1.*--time-scale")
        self.assertEqual((mesh.points[:, 3].min(), mesh.points[:, 3].max()), (0.0, 6.0))

    def test_seconds(self):
        """A series that lasts less than a voxel is long gets no useful mesh, and is told of."""
        for step, warns in ((0.05, True), (0.5, False)):
            path = images.write_nifti(self.folder / "heart.nii", images.moving_balls(4, 12, 3.0),
                                      images.Geometry(spacing=(1.0, 1.0, 1.0), time_step=step))
            done = self.call("--input", path, "--delta", 3, "--threads", 1, "--output", "m.vtu")
            self.assertEqual(done.returncode, 0)
            told = re.search(r"With a --time-scale of 1 the whole series counts 0\.15, less than the edge of a voxel \(1\): .* A "
                             r"--time-scale of about 20 makes a frame as long as a voxel\.", done.stderr)
            self.assertEqual(told is not None, warns, done.stderr)


class Space(SpaceTimeTestCase):
    def test_space_ras(self):
        array = images.moving_balls(3, 16)
        geometry = images.Geometry((10, 20, 30), (1.0, 1.1, 1.2), rotation(20), time_step=4.0)
        path = images.write_space_time_nrrd(self.folder / "i.nrrd", array, geometry)
        lps = self.mesh_of(path, "--plc", "lps.vtu", name="a.vtu")
        ras = self.mesh_of(path, "--space", "RAS", "--plc", "ras.vtu", "--slices", "s_", name="b.vtu")
        self.assertEqual((lps.space, ras.space), ("LPS", "RAS"))
        np.testing.assert_array_equal(ras.cells, lps.cells)
        np.testing.assert_allclose(ras.points, lps.points * [-1, -1, 1, 1], atol=1e-9)
        self.assertEqual([meshfiles.read_boundary(self.folder / name).space for name in ("lps.vtu", "ras.vtu")],
                         ["LPS", "RAS"])
        self.assertEqual(meshfiles.read_slice(self.folder / "s_1.vtu").space, "RAS")


class UnequalTimes(SpaceTimeTestCase):
    """Frames 0, 1, 3, 4 of five: what is between 1 and 3 is interpolated. Times of the file, and of --frame-times."""

    def test_times_of_the_file_and_of_the_option(self):
        array = images.moving_balls(5)
        geometry = images.Geometry((-30, 12.5, 4), (1.0, 1.25, 1.5), rotation(30) @ np.diag([-1.0, 1.0, 1.0]),
                                   first_time=7.0, time_step=2.0)
        some, times = array[[0, 1, 3, 4]], "7 9 13 15"
        path = images.write_sequence(self.folder / "i.seq.nrrd", some, geometry, key_values={
            "axis 0 index type": "numeric", "axis 0 index values": times})
        mesh = self.mesh_of(path)
        self.check_balls(mesh, array, geometry)
        plain = images.write_space_time_nrrd(self.folder / "i.nrrd", some, geometry)
        option = ("--frame-times", times.replace(" ", ","))
        same = self.mesh_of(plain, *option, name="same.vtu")
        np.testing.assert_array_equal(same.points, mesh.points)
        np.testing.assert_array_equal(same.cells, mesh.cells)
        # Slices and figures are those of the given frames.
        # One thread: ball 2 is 2.9 % too large in one frame, and 3 % are warned of.
        done = self.call("--input", plain, *option, "--delta", 1.5, "--no-picking", "--threads", 1, "--slices", "s_",
                         "--stats", "s.json", "--quality")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual([time for time, _ in meshfiles.read_slices(self.folder / "s.pvd")], [7, 9, 13, 15])
        report = json.loads((self.folder / "s.json").read_text())
        self.assertEqual(report["parameters"]["frame_times"], [7, 9, 13, 15])
        self.assertEqual([frame["time"] for frame in report["frames"]], [7, 9, 13, 15])
        voxel = geometry.voxel_volume()
        for label in (2, 6):
            counts = [int((frame == label).sum()) for frame in some]
            self.assertEqual([frame["labels"][str(label)]["voxels"] for frame in report["frames"]], counts)
            expected = voxel * (counts[0] + 3 * counts[1] + 3 * counts[2] + counts[3])  # steps of 2, 4, 2, halved
            self.assertAlmostEqual(report["labels"][str(label)]["image_volume"], expected, delta=1e-9 * expected)
            self.assertLess(abs(report["labels"][str(label)]["volume_error"]), 0.05)


class BadImages(ProgramTestCase):
    ARRAY = images.moving_balls(3, 12)

    def refuse(self, pattern, path, *arguments, status=1):
        return self.assert_refused(status, pattern, "--input", path, "--output", "mesh.vtu", *arguments)

    def test_frame_times(self):
        path = images.write_space_time_nrrd(self.folder / "i.nrrd", self.ARRAY)
        self.refuse("--frame-times gave 2 times, but '.*i.nrrd' has 3 frames; give one", path, "--frame-times", "0,1", status=3)
        for text, pattern in (("0,2,1", "--frame-times: times must increase, but 1 follows 2"), ("0,1,1", "but 1 follows 1"),
                              ("0,x,1", "--frame-times: 'x' is not a number"), ("5", "give the time of each frame"),
                              ("0,inf,1", "must be a finite number")):
            self.refuse(pattern, path, "--frame-times", text, status=2)
        ball = images.write_nrrd(self.folder / "ball.nrrd", images.ball(12, 4.0))
        self.refuse("--frame-times gave 2 times, but '.*ball.nrrd' has 1 frame; give one", ball, "--frame-times", "0,1", status=3)

    def test_size_image_of_four_dimensions(self):
        path = images.write_space_time_nrrd(self.folder / "i.nrrd", self.ARRAY)
        images.write_space_time_nrrd(self.folder / "sizes.nrrd", self.ARRAY.astype(np.float32))
        self.refuse("--size-image: .*sizes.nrrd.* three dimensions", path, "--size-image", "sizes.nrrd", status=3)

    def test_one_frame(self):
        """Images with a fourth axis of length 1 are common, and are 3D images."""
        path = images.write_nifti(self.folder / "i.nii", images.ball(12, 4.0)[None])
        self.assert_refused(2, "--slices: .*at least two time frames.*i.nii' is a 3D image", "--input", path,
                            "--slices", "s_")


if __name__ == "__main__":
    main()
