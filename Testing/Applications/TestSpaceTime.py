#!/usr/bin/python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Images of space and time: the mesh lies where and when the frames lie, in all formats."""
import dataclasses
import json
from pathlib import Path

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

    def check_balls(self, mesh, array, geometry, tolerance=0.12):
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
            self.assertAlmostEqual(volumes[own].sum() / expected, 1.0, delta=tolerance)
            centers = mesh.points[mesh.cells[own]].mean(axis=1)
            centroid = volumes[own] @ centers / volumes[own].sum()
            middle = voxels @ geometry.physical(index[:, :0:-1]) / voxels.sum()
            np.testing.assert_allclose(centroid[:3], middle, atol=0.35)
            self.assertAlmostEqual(centroid[3], (voxels @ times[index[:, 0]]) / voxels.sum(),
                                   delta=0.25 * geometry.time_step)


class Formats(SpaceTimeTestCase):
    ARRAY = images.moving_balls()
    GEOMETRY = images.Geometry((-30, 12.5, 4), (1.0, 1.25, 1.5), rotation(30), first_time=7.0, time_step=2.0)

    def test_same_image_in_every_format(self):
        """Four axes of NRRD, NIfTI and MetaImage, and the list of frames of 3D Slicer."""
        array, geometry = self.ARRAY, self.GEOMETRY
        paths = [
            images.write_space_time_nrrd(self.folder / "heart.nrrd", array, geometry),
            images.write_sequence(self.folder / "heart.seq.nrrd", array, geometry),
            images.write_metaimage(self.folder / "heart.mha", array, geometry),
            images.write_nifti(self.folder / "heart.nii", array, geometry),
            images.write_nifti(self.folder / "heart.nii.gz", array, geometry),
        ]
        meshes = [self.mesh_of(path) for path in paths]
        for path, mesh in zip(paths, meshes):
            with self.subTest(path):
                # Headers hold single precision or few digits, so meshes may differ in details.
                self.check_balls(mesh, array, geometry)
                self.assertAlmostEqual(mesh.volumes().sum() / meshes[0].volumes().sum(), 1.0, delta=0.03)
        np.testing.assert_array_equal(meshes[1].cells, meshes[0].cells)
        np.testing.assert_allclose(meshes[1].points, meshes[0].points, atol=1e-9)
        np.testing.assert_array_equal(meshes[4].points, meshes[3].points)

    def test_list_as_the_last_axis(self):
        """As newer versions of 3D Slicer write sequences; the axis of the list is the fourth."""
        array, geometry = self.ARRAY, self.GEOMETRY
        times = " ".join("%r" % time for time in geometry.times(len(array)))
        path = images.write_nrrd(self.folder / "heart.nrrd", array, geometry,
                                 key_values={"axis 3 index type": "numeric", "axis 3 index values": times})
        self.check_balls(self.mesh_of(path), array, geometry)

    def test_detached_header(self):
        array, geometry = self.ARRAY, self.GEOMETRY
        (self.folder / "heart.raw").write_bytes(array.tobytes())
        path = images.write_space_time_nrrd(self.folder / "heart.nhdr", array, geometry, header_lines={
            "encoding": "raw", "data file": "heart.raw"})
        head = (self.folder / "heart.nhdr").read_bytes().split(b"\n\n")[0]
        (self.folder / "heart.nhdr").write_bytes(head + b"\n")
        self.check_balls(self.mesh_of(path), array, geometry)

    def test_scalar_types(self):
        """Of four axes and of a list, whose values are sorted anew."""
        array = images.moving_balls(3, 16)
        geometry = images.Geometry(time_step=4.0)
        expected = None
        for code in ("u1", "i1", "u2", "i2", "u4", "i4", "u8", "i8", "f4", "f8"):
            for write in (images.write_space_time_nrrd, images.write_sequence):
                with self.subTest(code=code, write=write.__name__):
                    mesh = self.mesh_of(write(self.folder / "heart.nrrd", array.astype(code), geometry), delta=2.5)
                    expected = expected or mesh
                    np.testing.assert_array_equal(mesh.points, expected.points)
                    np.testing.assert_array_equal(mesh.cells, expected.cells)
                    np.testing.assert_array_equal(mesh.labels, expected.labels)

    def test_labels_keep_their_values(self):
        array = images.moving_balls(3, 16, labels=(300, 70000), dtype=np.int32)
        mesh = self.mesh_of(images.write_nifti(self.folder / "heart.nii", array, images.Geometry(time_step=4.0)))
        self.assertEqual(set(mesh.labels), {300, 70000})


class Times(SpaceTimeTestCase):
    def setUp(self):
        super().setUp()
        self.array = images.moving_balls(7, 16)

    def check_times(self, mesh, first, last):
        self.assertEqual((mesh.points[:, 3].min(), mesh.points[:, 3].max()), (first, last))

    def test_unknown_step(self):
        """An axis without spacing counts from 0 in steps of 1."""
        plain = {"space": None, "space directions": None, "space origin": None}
        for name, lines in (
            ("list", {}),
            ("vector of NaN", {"space directions": "(1,0,0) (0,1,0) (0,0,1) (nan,nan,nan)"}),
            ("NaN", {**plain, "spacings": "1 1 1 nan", "kinds": "space space space time"}),
            ("NaN without kinds", {**plain, "spacings": "1 1 1 nan", "kinds": None}),
        ):
            with self.subTest(name):
                self.check_times(self.mesh_of(
                    images.write_nrrd(self.folder / "heart.nrrd", self.array, header_lines=lines)), 0.0, 6.0)

    def test_spacing_of_a_list(self):
        self.check_times(self.mesh_of(images.write_nrrd(
            self.folder / "heart.nrrd", self.array, header_lines={"spacings": "nan nan nan 2"})), 0.0, 12.0)
        self.check_times(self.mesh_of(images.write_sequence(
            self.folder / "heart.nrrd", self.array, key_values={}, header_lines={"spacings": "2 nan nan nan"})),
            0.0, 12.0)

    def test_zero_step_of_nifti(self):
        path = images.write_nifti(self.folder / "heart.nii", self.array, pixdim=[1, 1, 1, 0])
        mesh = self.mesh_of(path, warning="heart.nii: .*0 for the time from frame to frame.* taken to be 1.*--time-scale")
        self.check_times(mesh, 0.0, 6.0)

    def test_index_values_that_are_no_numbers(self):
        for keys in ({"axis 0 index type": "text", "axis 0 index values": "0 2 4 6 8 10 12"},
                     {"axis 0 index type": "numeric", "axis 0 index values": "0 2 4"},
                     {"axis 0 index values": "0 2 4 6 8 10 end"}):
            with self.subTest(keys):
                path = images.write_sequence(self.folder / "heart.nrrd", self.array, key_values=keys)
                self.check_times(self.mesh_of(path, warning="'axis 0 index values' are not one number"), 0.0, 6.0)

    def test_nearly_equal_steps(self):
        """Rounded times are fine; the ends stay what they are."""
        path = images.write_sequence(self.folder / "heart.nrrd", self.array,
                                     key_values={"axis 0 index values": "1 2.333 3.667 5 6.333 7.667 9"})
        self.check_times(self.mesh_of(path), 1.0, 9.0)

    def test_time_scale(self):
        """Time counts more or less, and the mesh keeps the image's own times."""
        images.write_space_time_nrrd(self.folder / "slow.nrrd", self.array, images.Geometry(time_step=2.0))
        images.write_space_time_nrrd(self.folder / "fast.nrrd", self.array, images.Geometry(time_step=0.5))
        slow = self.mesh_of("slow.nrrd")
        fast = self.mesh_of("fast.nrrd", "--time-scale", 4)
        self.check_times(fast, 0.0, 3.0)
        np.testing.assert_array_equal(fast.cells, slow.cells)
        np.testing.assert_allclose(fast.points * [1, 1, 1, 4], slow.points, atol=1e-12)
        self.assertLess(len(self.mesh_of("fast.nrrd").cells), 0.7 * len(fast.cells))


class Grading(SpaceTimeTestCase):
    def test_saves_pentatopes(self):
        """The volumes stay, and the statistics tell what was done."""
        geometry = images.Geometry()
        z, y, x = np.indices((24, 24, 24)) - 11.5
        array = np.repeat((np.sqrt(x * x + y * y + z * z) < 10)[None], 8, axis=0).astype(np.uint8)
        images.write_space_time_nrrd(self.folder / "ball.nrrd", array, geometry)
        uniform = self.mesh_of("ball.nrrd", delta=2)
        graded = self.mesh_of("ball.nrrd", "--grading", "lfs", "--stats", "graded.json", delta=2)
        self.check_balls(graded, array, geometry, tolerance=0.03)
        self.assertLess(len(graded.cells), 0.8 * len(uniform.cells))
        report = json.loads((self.folder / "graded.json").read_text())
        self.assertEqual(report["parameters"]["grading"], "lfs")
        self.assertGreater(report["grading"]["poles"], 10)
        self.assertGreater(report["largest_delta"], 2.2)
        self.assert_refused(2, "--feature-ratio: .*give --grading lfs as well", "--input", "ball.nrrd", "--feature-ratio",
                            2, "--output", "m.vtu")


class Space(SpaceTimeTestCase):
    def test_left_handed_axes(self):
        array = images.moving_balls()
        geometry = images.Geometry((100, 0, 0), (1.0, 1.0, 1.2), np.diag([-1.0, 1.0, 1.0]), 1.0, 1.5)
        for write in (images.write_space_time_nrrd, images.write_sequence, images.write_metaimage):
            with self.subTest(write.__name__):
                self.check_balls(self.mesh_of(write(self.folder / "i.nrrd" if "nrrd" in write.__name__ or
                                                    "sequence" in write.__name__ else self.folder / "i.mha",
                                                    array, geometry)), array, geometry)

    def test_skewed_axes(self):
        array = images.moving_balls()
        skew = np.array([[1.0, 0.3, 0.0], [0.0, 1.0, 0.2], [0.0, 0.0, 1.0]])
        skew /= np.linalg.norm(skew, axis=0)
        geometry = images.Geometry((1, 2, 3), (1.0, 1.1, 1.2), skew, 0.0, 2.0)
        self.check_balls(self.mesh_of(images.write_space_time_nrrd(self.folder / "i.nrrd", array, geometry)),
                         array, geometry)

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

    def test_size_image_holds_at_all_times(self):
        array = images.moving_balls(3, 16)
        path = images.write_space_time_nrrd(self.folder / "i.nrrd", array, images.Geometry(time_step=4.0))
        free = self.mesh_of(path, delta=2.5)
        images.write_nrrd(self.folder / "sizes.nrrd", np.full(array.shape[1:], 2.0, dtype=np.float32))
        bound = self.mesh_of(path, "--size-image", "sizes.nrrd", delta=2.5)
        self.assertGreater(len(bound.cells), 1.5 * len(free.cells))
        np.testing.assert_array_equal(self.mesh_of(path, "--size", 2, delta=2.5).cells, bound.cells)


class UnequalTimes(SpaceTimeTestCase):
    """Frames 0, 1, 3, 4 of five: what is between 1 and 3 is interpolated. Times of the file, and of --frame-times."""
    GEOMETRY = images.Geometry((-30, 12.5, 4), (1.0, 1.25, 1.5), rotation(30), first_time=7.0, time_step=2.0)

    def test_times_of_the_file_and_of_the_option(self):
        array, geometry = images.moving_balls(5), self.GEOMETRY
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
        done = self.call("--input", plain, *option, "--delta", 1.5, "--no-picking", "--slices", "s_", "--stats", "s.json",
                         "--quality")
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

    def test_any_times(self):
        array = images.moving_balls(4)
        path = images.write_space_time_nrrd(self.folder / "i.nrrd", array)
        mesh = self.mesh_of(path, "--frame-times", "0.5,2.1,3,5.7")
        self.assertEqual((mesh.points[:, 3].min(), mesh.points[:, 3].max()), (0.5, 5.7))
        self.assertEqual(set(mesh.labels), {2, 6})
        counts = (array == 2).sum(axis=(1, 2, 3))
        expected = (np.diff([0.5, 2.1, 3, 5.7]) * (counts[1:] + counts[:-1]) / 2).sum()
        self.assertAlmostEqual(mesh.volumes()[mesh.labels == 2].sum() / expected, 1.0, delta=0.05)


class BadImages(ProgramTestCase):
    ARRAY = images.moving_balls(3, 12)

    def refuse(self, pattern, path, *arguments, status=1):
        return self.assert_refused(status, pattern, "--input", path, "--output", "mesh.vtu", *arguments)

    def test_time_mixed_with_space(self):
        mixed = "1 0 0 0 0 1 0 0 0 0 0.8 0.6 0 0 -0.6 0.8"
        self.refuse("mixes time with space", images.write_metaimage(
            self.folder / "i.mha", self.ARRAY, header_lines={"TransformMatrix": mixed}))
        vectors = "(1,0,0,0) (0,1,0,0.3) (0,0,1,0) (0,0,0,1)"
        self.refuse("mixes time with space", images.write_space_time_nrrd(
            self.folder / "i.nrrd", self.ARRAY, header_lines={"space directions": vectors}))

    def test_time_that_runs_backwards(self):
        backwards = "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 -1"
        self.refuse("time runs backwards", images.write_metaimage(
            self.folder / "i.mha", self.ARRAY, header_lines={"TransformMatrix": backwards}))
        self.refuse("times of its frames do not increase: 1 follows 2", images.write_sequence(
            self.folder / "i.nrrd", self.ARRAY, key_values={"axis 0 index values": "2 1 0"}))
        self.refuse("do not increase: 1 follows 1", images.write_sequence(
            self.folder / "i.nrrd", self.ARRAY, key_values={"axis 0 index values": "0 1 1"[::-1]}))

    def test_frames_at_nearly_the_same_time(self):
        self.refuse("times of frames 1 and 2, 3 and 3.0001, are too near each other: .* more than 1000", images.write_sequence(
            self.folder / "i.nrrd", self.ARRAY, key_values={"axis 0 index values": "0 3 3.0001"}))

    def test_frame_times(self):
        path = images.write_space_time_nrrd(self.folder / "i.nrrd", self.ARRAY)
        for text, pattern in (("0,1", "--frame-times gave 2 times, but '.*i.nrrd' has 3 frames; give one"),):
            self.refuse(pattern, path, "--frame-times", text)
        for text, pattern in (("0,2,1", "--frame-times: times must increase, but 1 follows 2"),
                              ("0,x,1", "--frame-times: 'x' is not a number"), ("5", "give the time of each frame"),
                              ("0,inf,1", "must be a finite number")):
            self.refuse(pattern, path, "--frame-times", text, status=2)
        ball = images.write_nrrd(self.folder / "ball.nrrd", images.ball(12, 4.0))
        self.refuse("--frame-times gave 2 times, but '.*ball.nrrd' has 1 frame; give one", ball, "--frame-times", "0,1")

    def test_steps(self):
        plain = {"space": None, "space directions": None, "space origin": None}
        for bad in ("0", "-1", "inf"):
            with self.subTest(bad):
                # 0 is 'unknown' in NIfTI, and a warning.
                if bad != "0":
                    self.refuse("time", images.write_nifti(
                        self.folder / "i.nii", self.ARRAY, pixdim=[1, 1, 1, float(bad)]))
                self.refuse("time", images.write_metaimage(
                    self.folder / "i.mha", self.ARRAY, header_lines={"ElementSpacing": "1 1 1 " + bad}))
                self.refuse("time|spacing", images.write_nrrd(
                    self.folder / "i.nrrd", self.ARRAY, header_lines={**plain, "spacings": "1 1 1 " + bad}))
        self.refuse("time", images.write_nifti(
            self.folder / "i.nii", self.ARRAY, pixdim=[1, 1, 1, float("nan")]))
        self.refuse("time", images.write_metaimage(
            self.folder / "i.mha", self.ARRAY, header_lines={"ElementSpacing": "1 1 1 nan"}))

    def test_first_time(self):
        self.refuse("toffset", images.write_nifti(
            self.folder / "i.nii", self.ARRAY, images.Geometry(first_time=float("nan"))))

    def test_spacing(self):
        plain = {"space": None, "space directions": None, "space origin": None}
        for bad in ("0 1 1", "1 -1 1", "1 1 nan", "inf 1 1"):
            with self.subTest(bad):
                self.refuse("spacing", images.write_nrrd(
                    self.folder / "i.nrrd", self.ARRAY, header_lines={**plain, "spacings": bad + " 1"}))
                self.refuse("spacing", images.write_metaimage(
                    self.folder / "i.mha", self.ARRAY, header_lines={"ElementSpacing": bad + " 1"}))
                path = Path(images.write_nifti(
                    self.folder / "i.nii", self.ARRAY, pixdim=[*(float(word) for word in bad.split()), 1.0]))
                data = bytearray(path.read_bytes())
                data[254:256] = b"\0\0"  # of the qform and the sform, the former needs the spacing
                path.write_bytes(data)
                self.refuse("spacing", path)
                self.refuse("spacing", images.write_sequence(
                    self.folder / "i.nrrd", self.ARRAY, header_lines={**plain, "spacings": "nan " + bad}))

    def test_singular_direction(self):
        singular = "(1,0,0) (1,0,0) (0,0,1)"
        self.refuse("axes are not independent", images.write_nrrd(
            self.folder / "i.nrrd", self.ARRAY, header_lines={"space directions": singular + " none"}))
        self.refuse("axes are not independent", images.write_sequence(
            self.folder / "i.nrrd", self.ARRAY, header_lines={"space directions": "none " + singular}))

    def test_direction_of_three_axes_of_four(self):
        """The kind says that the fourth is time."""
        self.mesh("--input", images.write_nrrd(
            self.folder / "i.nrrd", images.moving_balls(3), header_lines={"kinds": "domain domain domain time"}), "--delta", 3)

    def test_layers_of_a_segmentation(self):
        """3D Slicer writes overlapping segments as a list, too."""
        self.refuse("segments overlap.* 3 layers: ", images.write_sequence(
            self.folder / "i.seg.nrrd", self.ARRAY, key_values={"Segment0_ID": "Segment_1", "Segment0_Layer": "0"}))

    def test_components_that_may_be_anything(self):
        """Only a list is one of frames; a vector or a colour is not."""
        for kind in ("vector", "RGB-color", "3-vector"):
            with self.subTest(kind):
                self.refuse("3 components.*four dimensions", images.write_sequence(
                    self.folder / "i.nrrd", self.ARRAY, header_lines={"kinds": kind + " domain domain domain"}))

    def test_five_dimensions(self):
        self.refuse("5 dimensions.*12 x 12 x 12 x 3 x 2", images.write_nifti(
            self.folder / "i.nii", np.stack([self.ARRAY] * 2)))

    def test_truncated(self):
        array = np.random.default_rng(3).integers(0, 3, (3, 12, 12, 12)).astype(np.uint16)
        for write, name in ((images.write_space_time_nrrd, "i.nrrd"), (images.write_sequence, "s.nrrd"),
                            (images.write_metaimage, "i.mha"), (images.write_nifti, "i.nii"),
                            (images.write_nifti, "i.nii.gz")):
            write(self.folder / name, array)
            whole = (self.folder / name).read_bytes()
            for part in (0.5, 0.9, 0.995):
                with self.subTest(name=name, part=part):
                    (self.folder / name).write_bytes(whole[:int(len(whole) * part)])
                    self.refuse("truncated|damaged", name)

    def test_values(self):
        for value, pattern in ((1.5, "1.5.*whole"), (np.nan, "nan"), (-1, "-1.*negative")):
            array = self.ARRAY.astype(np.float32)
            array[1, 5, 5, 5] = value
            for write in (images.write_space_time_nrrd, images.write_sequence):
                with self.subTest(value=value, write=write.__name__):
                    self.refuse("cannot mesh .*" + pattern, write(self.folder / "i.nrrd", array))
        self.refuse("no foreground", images.write_space_time_nrrd(self.folder / "i.nrrd", np.zeros_like(self.ARRAY)))

    def test_single_slice(self):
        self.refuse("1 voxel.* along axis 2", images.write_space_time_nrrd(
            self.folder / "i.nrrd", self.ARRAY[:, 4:5]))

    def test_unknown_labels(self):
        path = images.write_space_time_nrrd(self.folder / "i.nrrd", self.ARRAY)
        self.refuse("--label-size.* label 5", path, "--label-size", "5=1")
        self.refuse("label 5.* --labels", path, "--labels", "2,5")

    def test_too_fine(self):
        path = images.write_space_time_nrrd(self.folder / "i.nrrd", self.ARRAY)
        self.refuse("elements.* memory.* larger delta.* --force", path, "--delta", "1e-4")

    def test_size_image_of_four_dimensions(self):
        path = images.write_space_time_nrrd(self.folder / "i.nrrd", self.ARRAY)
        images.write_space_time_nrrd(self.folder / "sizes.nrrd", self.ARRAY.astype(np.float32))
        self.refuse("--size-image: .*sizes.nrrd.* three dimensions", path, "--size-image", "sizes.nrrd")


class OneFrame(ProgramTestCase):
    """Images with a fourth axis of length 1 are common, and are 3D images."""

    def test_is_a_3d_image(self):
        ball = images.ball(12, 4.0)
        for write, name in ((images.write_space_time_nrrd, "i.nrrd"), (images.write_metaimage, "i.mha"),
                            (images.write_nifti, "i.nii"), (images.write_sequence, "s.nrrd")):
            with self.subTest(name):
                path = write(self.folder / name, ball[None], dataclasses.replace(images.Geometry(), time_step=2.0))
                self.mesh("--input", path, "--delta", 2, "--output", "mesh.vtu")
                self.assertEqual(set(meshfiles.read_tetrahedra(self.folder / "mesh.vtu").labels), {1})

    def test_has_no_slices(self):
        path = images.write_nifti(self.folder / "i.nii", images.ball(12, 4.0)[None])
        self.assert_refused(2, "--slices: .*at least two time frames.*i.nii' is a 3D image", "--input", path,
                            "--slices", "s_")


if __name__ == "__main__":
    main()
