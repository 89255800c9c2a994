#!/usr/bin/python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""What is written of images of space and time: meshes, boundaries, slices, statistics; and the flags for it."""
import json
import os
import resource

import numpy as np

import images
import meshfiles
from program import ProgramTestCase, main, without_topology


class SpaceTimeTestCase(ProgramTestCase):
    GEOMETRY = images.Geometry((5, -7, 11), (1.0, 1.0, 1.2), first_time=3.0, time_step=2.0)

    def setUp(self):
        super().setUp()
        self.array = images.moving_balls()
        self.input = images.write_space_time_nrrd(self.folder / "heart.nrrd", self.array, self.GEOMETRY)
        self.arguments = ["--input", self.input, "--delta", 2, "--no-picking", "--threads", 1]

    def run_with(self, *arguments, **options):
        return self.mesh(*self.arguments, *arguments, **options)

    def refuse(self, status, pattern, *arguments, **options):
        return self.assert_refused(status, pattern, *self.arguments, *arguments, **options)


def touching_labels():
    """A ball of two labels, in three equal frames."""
    return np.stack([images.two_labels(16, 6.0)] * 3)


class Formats(SpaceTimeTestCase):
    def setUp(self):
        super().setUp()
        images.write_space_time_nrrd(self.input, touching_labels(), self.GEOMETRY)
        self.arguments += ["--size", 2]  # which makes points that are not on the boundary
        self.run_with("--output", "reference.vtu", "--plc", "boundary.vtu")
        self.reference = meshfiles.read_pentatopes(self.folder / "reference.vtu")
        self.boundary = meshfiles.read_boundary(self.folder / "boundary.vtu")

    def test_grid(self):
        mesh = self.reference
        self.assertGreater(len(mesh.cells), 300)
        self.assertEqual(set(mesh.labels), {3, 7})
        self.assertEqual(mesh.space, "LPS")
        self.assertGreater(mesh.volumes().min(), 0.0)
        np.testing.assert_array_equal(np.unique(mesh.cells), np.arange(len(mesh.points)))

    def test_boundary(self):
        """The facets of pentatopes that have another label, or none, on their other side."""
        self.assertEqual(self.boundary.space, "LPS")
        self.assertLess(len(self.boundary.points), len(self.reference.points))
        self.assertEqual({tuple(pair) for pair in self.boundary.labels}, {(3, 0), (7, 0), (7, 3)})
        np.testing.assert_array_equal(self.boundary.points, self.reference.points[self.boundary.point_ids])
        sides = {}
        for cell, label in zip(self.reference.cells, self.reference.labels):
            for i in range(5):
                sides.setdefault(tuple(sorted(np.delete(cell, i))), []).append(int(label))
        expected = {}
        for facet, labels in sides.items():
            pair = tuple(sorted(labels + [0] * (2 - len(labels)), reverse=True))
            if pair[0] != pair[1]:
                expected[facet] = pair
        found = {tuple(sorted(self.boundary.point_ids[cell])): tuple(pair)
                 for cell, pair in zip(self.boundary.cells, self.boundary.labels)}
        self.assertEqual(found, expected)
        self.assertEqual(len(found), len(self.boundary.cells))

    def check_format(self, name):
        self.run_with("--output", name)
        mesh = meshfiles.read_pentatopes(self.folder / name)
        # Coordinates are written such that the same doubles are read.
        np.testing.assert_array_equal(mesh.points, self.reference.points)
        np.testing.assert_array_equal(mesh.cells, self.reference.cells)
        np.testing.assert_array_equal(mesh.labels, self.reference.labels)
        self.assertGreater(mesh.volumes().min(), 0.0)
        self.assertEqual(mesh.space, "LPS")
        for array in (mesh.slabs, mesh.pairs, mesh.numbers):
            self.assertIsNone(array)
        self.assertEqual(mesh.planes, [])
        self.assertEqual(mesh.names, {3: (3, 0), 7: (7, 0), 8: (7, 3), 9: (3, 0), 10: (7, 0), 11: (3, 0), 12: (7, 0)})
        # Attributes from 9 on are those of the ends: all four vertices have the first or the last time.
        times = mesh.points[mesh.tetrahedra][:, :, 3]
        np.testing.assert_array_equal((times == 3.0).all(axis=1), np.isin(mesh.references, (9, 10)))
        np.testing.assert_array_equal((times == 7.0).all(axis=1), np.isin(mesh.references, (11, 12)))
        np.testing.assert_array_equal(self.boundary.sides, np.where(mesh.references > 10, 2, mesh.references > 8))
        np.testing.assert_array_equal(mesh.tetrahedra, self.boundary.point_ids[self.boundary.cells])
        np.testing.assert_array_equal([mesh.names[number] for number in mesh.references], self.boundary.labels)
        np.testing.assert_array_equal(mesh.references, self.boundary.surfaces)

    def test_surface_names(self):
        self.assertEqual(self.boundary.surface_names, {
            3: "label_3__background", 7: "label_7__background", 8: "label_7__label_3",
            9: "label_3__background__initial", 10: "label_7__background__initial",
            11: "label_3__background__final", 12: "label_7__background__final"})
        (self.folder / "names.csv").write_text('3,"Left, lung"\n7,Spleen\n')
        self.run_with("--plc", "boundary.vtu", "--label-table", "names.csv")
        boundary = meshfiles.read_boundary(self.folder / "boundary.vtu")
        self.assertEqual(boundary.surface_names, {
            3: "Left, lung__background", 7: "Spleen__background", 8: "Spleen__Left, lung",
            9: "Left, lung__background__initial", 10: "Spleen__background__initial",
            11: "Left, lung__background__final", 12: "Spleen__background__final"})
        np.testing.assert_array_equal(boundary.surfaces, self.boundary.surfaces)
        # A name that is that of a flat end already.
        (self.folder / "names.csv").write_text('3,A\n7,"A__background__initial"\n')
        self.run_with("--plc", "boundary.vtu", "--label-table", "names.csv")
        names = meshfiles.read_boundary(self.folder / "boundary.vtu").surface_names
        self.assertEqual(len(set(names.values())), 7)
        self.assertEqual(names[9], "A__background__initial_3_0__initial")

    def test_mfem(self):
        self.check_format("mesh.mfem")

    def test_gmf(self):
        self.check_format("mesh.mesh")

    def test_words_of_libmeshb(self):
        """It looks for these words even in comments, and takes what follows for a number."""
        self.run_with("--output", "mesh.mesh")
        words = (self.folder / "mesh.mesh").read_text().split()
        for word in ("MeshVersionFormatted", "Dimension", "Vertices", "Tetrahedra", "Pentatopes", "End"):
            self.assertEqual(words.count(word), 1, word)

    def test_labels_beyond_32_bits(self):
        array = touching_labels().astype(np.int64)
        array[array == 7] = 2**40
        images.write_space_time_nrrd(self.input, array, self.GEOMETRY)
        self.run_with("--output", "large.vtu")
        self.assertEqual(set(meshfiles.read_pentatopes(self.folder / "large.vtu").labels), {3, 2**40})
        for name in ("mesh.mfem", "mesh.mesh"):
            self.refuse(3, "cannot write '%s': label 1099511627776 .*32 bits.*vtu" % name, "--output", name)


class Boundaries(SpaceTimeTestCase):
    def boundary_of(self, array, *arguments):
        images.write_space_time_nrrd(self.input, array, self.GEOMETRY)
        self.run_with("--smoothing", 0.7, "--output", "m.vtu", "--plc", "boundary.vtu", *arguments)
        boundary = meshfiles.read_boundary(self.folder / "boundary.vtu")
        points = boundary.points[boundary.cells]
        edges = points[:, 1:] - points[:, :1]
        weights = np.sqrt(np.linalg.det(edges @ edges.transpose(0, 2, 1)).clip(0))
        return boundary, points, weights

    def test_sides(self):
        boundary, points, _ = self.boundary_of(self.array)
        for side, time in ((1, 3.0), (2, 11.0)):
            np.testing.assert_array_equal(boundary.sides == side, (points[:, :, 3] == time).all(axis=1))
        self.assertEqual(set(boundary.sides), {0, 1, 2})

    def test_an_object_that_does_not_reach_the_ends(self):
        array = np.zeros((7, 14, 14, 14), dtype=np.uint8)
        array[2:5] = images.ball(14, 5.0)
        boundary, _, _ = self.boundary_of(array)
        self.assertEqual(set(boundary.sides), {0})

    def test_velocity_of_a_ball_that_grows(self):
        """Its radius grows by 0.5 voxels a frame, 0.25 mm in a unit of time (a step is 2)."""
        array = np.stack([2 * images.ball(22, 4.0 + 0.5 * n) for n in range(9)])
        self.GEOMETRY = images.Geometry(first_time=3.0, time_step=2.0)
        for arguments in ((), ("--space", "ras", "--time-scale", 0.5)):
            with self.subTest(arguments):
                boundary, _, weights = self.boundary_of(array, *arguments)
                lateral = boundary.sides == 0
                np.testing.assert_array_equal(boundary.velocities[~lateral], 0.0)
                mean = np.average(boundary.velocities[lateral], weights=weights[lateral])
                self.assertAlmostEqual(mean, 0.25, delta=0.04)


class BoundaryVelocities(SpaceTimeTestCase):
    """A ball moves by one voxel a frame along i: where its normal is n, the boundary's velocity is (v . n) n."""
    CENTRE = np.array([8.5, 7.5, 7.5])

    def moving_ball(self, geometry):
        array = np.zeros((9, 16, 16, 26), dtype=np.uint8)
        z, y, x = np.indices(array.shape[1:])
        for n in range(9):
            array[n] = (x - 8.5 - n) ** 2 + (y - 7.5) ** 2 + (z - 7.5) ** 2 < 36
        images.write_space_time_nrrd(self.input, array, geometry)

    def errors(self, geometry, points, times, velocities):
        """Of points about on the ball, relative to its speed."""
        frames = (times - geometry.first_time) / geometry.time_step
        offsets = points - geometry.physical(self.CENTRE + np.column_stack([frames, 0 * frames, 0 * frames]))
        normals = offsets / np.linalg.norm(offsets, axis=1)[:, None]
        velocity = (geometry.physical((1, 0, 0)) - geometry.physical((0, 0, 0))) / geometry.time_step
        expected = (normals @ velocity)[:, None] * normals
        return np.linalg.norm(velocities - expected, axis=1) / np.linalg.norm(velocity)

    def test_points_of_the_boundary_and_of_slices(self):
        turned = np.array([[0.0, -1.0, 0.0], [0.6, 0.0, 0.8], [-0.8, 0.0, 0.6]])
        for name, direction in (("straight", np.eye(3)), ("turned", turned), ("left-handed", turned @ np.diag([1, 1, -1]))):
            geometry = images.Geometry((3, 1, -2), (1.5, 1.5, 1.5), direction, first_time=3.0, time_step=2.0)
            self.moving_ball(geometry)
            self.mesh("--input", self.input, "--delta", 3, "--time-scale", 0.75, "--threads", 1, "--output", "m.vtu",
                      "--plc", "b.vtu", "--slices", "s_", "--slice-count", 4)
            with self.subTest(name):
                boundary = meshfiles.read_boundary(self.folder / "b.vtu")
                lateral = np.unique(boundary.cells[boundary.sides == 0])
                points = boundary.points[lateral]
                errors = self.errors(geometry, points[:, :3], points[:, 3], boundary.point_velocities[lateral])
                self.assertLess(np.mean(errors), 0.15)
                self.assertLess(np.quantile(errors, 0.9), 0.35)
                elsewhere = np.setdiff1d(boundary.cells, lateral)
                self.assertGreater(len(elsewhere), 5)
                np.testing.assert_array_equal(boundary.point_velocities[elsewhere], 0.0)
                for time, piece in meshfiles.read_slices(self.folder / "s.pvd"):
                    distances = np.linalg.norm(piece.points - geometry.physical(
                        self.CENTRE + ((time - 3.0) / 2.0, 0, 0)), axis=1)
                    surface = distances > 0.93 * 1.5 * 6.0
                    self.assertGreater(surface.sum(), 50)
                    errors = self.errors(geometry, piece.points[surface], np.full(surface.sum(), time),
                                         piece.point_velocities[surface])
                    self.assertLess(np.mean(errors), 0.2)


class Slices(SpaceTimeTestCase):
    def slices(self, name="heart.pvd"):
        return meshfiles.read_slices(self.folder / name)

    def check_volumes(self, time, piece, tolerance):
        """Against the frame at that time."""
        self.assertEqual(piece.time, time)
        frame = self.array[round((time - 3.0) / 2.0)]
        volumes = piece.volume_of_label()
        self.assertEqual(set(volumes), {2, 6})
        for label, volume in volumes.items():
            expected = (frame == label).sum() * self.GEOMETRY.voxel_volume()
            self.assertAlmostEqual(volume / expected, 1.0, delta=tolerance)

    def test_one_for_each_frame(self):
        self.mesh("--input", self.input, "--delta", 1.2, "--no-picking", "--smoothing", 0, "--slices", "heart_",
                  "--output", "heart.vtu")
        entries = meshfiles.read_collection(self.folder / "heart.pvd")
        self.assertEqual(entries, [(3.0 + 2.0 * n, "heart_%d.vtu" % n) for n in range(5)])
        slices = self.slices()
        for time, piece in slices:
            self.check_volumes(time, piece, 0.12)
            self.assertEqual(piece.space, "LPS")
        # The first ball grows, the second shrinks.
        for label, sign in ((2, 1), (6, -1)):
            volumes = [sign * piece.volume_of_label()[label] for _, piece in slices]
            self.assertGreater(volumes[-1], volumes[0])
        mesh = meshfiles.read_pentatopes(self.folder / "heart.vtu")
        # The mean of the slices, by the trapezoidal rule, is near the hypervolume.
        integral = sum(piece.volumes().sum() * (1.0 if 0 < n < 4 else 0.5) * 2.0 for n, (_, piece) in enumerate(slices))
        self.assertAlmostEqual(integral / mesh.volumes().sum(), 1.0, delta=0.05)

    def test_between_frames(self):
        self.run_with("--slices", "s", "--slice-count", 4)
        slices = self.slices("s.pvd")
        np.testing.assert_allclose([time for time, _ in slices], [3.0, 3.0 + 8 / 3, 3.0 + 16 / 3, 11.0], rtol=1e-15)
        self.assertEqual(slices[-1][0], 11.0)
        for _, piece in slices:
            self.assertGreater(len(piece.points), 10)

    def test_names(self):
        (self.folder / "out").mkdir()
        for prefix, collection, first in (
            ("heart_", "heart.pvd", "heart_0.vtu"),
            ("heart", "heart.pvd", "heart0.vtu"),
            ("heart-", "heart.pvd", "heart-0.vtu"),
            ("__", "__.pvd", "__0.vtu"),
            ("out/a & <b>.", "out/a & <b>.pvd", "out/a & <b>.0.vtu"),
            (str(self.folder / "out" / "absolute_"), "out/absolute.pvd", "out/absolute_0.vtu"),
        ):
            with self.subTest(prefix):
                before = set(self.contents())
                self.mesh("--input", self.input, "--delta", 5, "--slices", prefix, "--slice-count", 2)
                new = {str(path) for path in set(self.contents()) - before}
                self.assertEqual(new, {collection, first, first.replace("0.vtu", "1.vtu")})
                # The names are relative to the collection, which can be moved with the slices.
                entries = meshfiles.read_collection(self.folder / collection)
                self.assertEqual([file for _, file in entries],
                                 [os.path.basename(first), os.path.basename(first).replace("0.vtu", "1.vtu")])
                for path in new:
                    (self.folder / path).unlink()

    def test_times_when_there_is_nothing(self):
        """A slice without any label is an empty mesh, not an error."""
        array = np.zeros((5, 12, 12, 12), dtype=np.uint8)
        array[:2] = images.ball(12, 4.0)
        images.write_space_time_nrrd(self.input, array)
        self.run_with("--slices", "s_")
        counts = [len(piece.cells) for _, piece in self.slices("s.pvd")]
        self.assertGreater(counts[0], 0)
        self.assertEqual(counts[3:], [0, 0])

    def test_all_or_none(self):
        """A limit on the size of files stands in for a full disk."""
        def limit():
            resource.setrlimit(resource.RLIMIT_FSIZE, (3000, resource.RLIM_INFINITY))

        (self.folder / "heart_1.vtu").write_text("old")
        self.refuse(3, "cannot write 'heart_0.vtu': ", "--slices", "heart_", preexec_fn=limit)

    def test_many(self):
        """More files than a list of a fixed size would hold."""
        self.run_with("--slices", "s_", "--slice-count", 100)
        self.assertEqual(len(self.slices("s.pvd")), 100)

    def test_outputs_that_clash(self):
        self.refuse(3, "cannot write 'heart_2.vtu': two outputs have this name", "--slices", "heart_",
                    "--output", "heart_2.vtu")
        self.refuse(3, "two outputs have this name", "--slices", "./heart_", "--plc", "heart_2.vtu")

    def test_folder_that_is_missing(self):
        self.refuse(3, "cannot write 'none/heart.pvd': there is no folder 'none'", "--slices", "none/heart_")

    def test_input_is_not_overwritten(self):
        os.link(self.input, self.folder / "heart_3.vtu")
        self.refuse(3, "cannot write 'heart_3.vtu': it is the input", "--slices", "heart_")

    def test_prefixes(self):
        for prefix, pattern in (("", "--slices: the name is empty"), ("out/", "--slices: 'out/' names no file"),
                                ("heart.vtu", "--slices: 'heart.vtu' is the whole name of a file.*heart_"),
                                ("heart.pvd", "--slices: 'heart.pvd' is the whole name")):
            with self.subTest(prefix):
                self.refuse(2, pattern, "--slices", prefix)


class Quality(SpaceTimeTestCase):
    """--quality and --hausdorff: cuts at the times of the frames, beside the frames."""

    def report(self, *arguments):
        done = self.call(*self.arguments, "--stats", "q.json", *arguments)
        self.assertEqual((done.returncode, without_topology(done.stderr)), (0, ""))
        return done.stdout, json.loads((self.folder / "q.json").read_text())

    def test_volumes(self):
        text, report = self.report("--quality", "--slices", "s_", "--time-scale", 1.5)
        frames = report["frames"]
        self.assertEqual([frame["time"] for frame in frames], [3.0, 5.0, 7.0, 9.0, 11.0])
        for frame, (_, piece) in zip(frames, meshfiles.read_slices(self.folder / "s.pvd")):
            for label, volume in piece.volume_of_label().items():
                self.assertAlmostEqual(frame["labels"][str(label)]["volume"], volume, delta=1e-9 * volume)
            self.assertEqual(frame["hausdorff"], {})
        worst = max(abs(figures["volume_error"]) for frame in frames for figures in frame["labels"].values())
        self.assertRegex(text, r"Quality of the cuts at 5 frames:\n"
                         r"  dihedral angles in steps of 10 degrees, %:( [\d.]+){18}\n"
                         r"  0 of 10 components lost; hypervolumes off by up to -?[\d.]+ %, volumes in a frame by up to "
                         rf"-?{100 * worst:.2f} % \(label \d at time ")
        self.assertNotIn("Hausdorff", text)

    def test_distances(self):
        text, report = self.report("--hausdorff")
        distances = [frame["hausdorff"]["voxels"]["distance"] for frame in report["frames"]]
        self.assertEqual(len(distances), 5)
        for distance in distances:
            self.assertGreater(distance, 0.3)
            self.assertLess(distance, 2.0)
        self.assertIn("Hausdorff distance to the faces of voxels: at most %.3f (at time " % max(distances), text)

    def test_frames_in_which_there_is_nothing(self):
        array = np.zeros((5, 12, 12, 12), np.uint8)
        array[:3] = images.ball(12, 4.0)
        images.write_space_time_nrrd(self.input, array)
        _, report = self.report("--hausdorff")
        frames = report["frames"]
        self.assertEqual([frame["image"] is None for frame in frames], [False, False, False, True, True])
        self.assertEqual(frames[4]["elements"], 0)
        self.assertEqual(frames[4]["labels"], {})
        self.assertEqual(report["labels"]["1"]["image_volume"], 2.5 * (array[0] != 0).sum())

    def test_chosen_labels(self):
        _, report = self.report("--hausdorff", "--labels", 6)
        for frame in report["frames"]:
            self.assertEqual(set(frame["labels"]), {"6"})
            self.assertEqual(frame["image"]["lost_labels"], [])
            self.assertLess(frame["hausdorff"]["voxels"]["distance"], 2.0)


class Elements(SpaceTimeTestCase):
    """--elements: delta is found, of labels and of grey values."""

    def check(self, wanted, *arguments):
        done = self.call("--no-picking", "--threads", 1, "--elements", wanted, "--stats", "e.json", "--output", "m.vtu",
                         *arguments)
        self.assertEqual((done.returncode, without_topology(done.stderr)), (0, ""))
        report = json.loads((self.folder / "e.json").read_text())
        self.assertLess(abs(report["elements"] / wanted - 1), 0.1)
        self.assertEqual(report["elements_asked_for"], wanted)
        self.assertIn({"delta": report["delta"], "elements": report["elements"]}, report["runs"])
        self.assertEqual(len(meshfiles.read_pentatopes(self.folder / "m.vtu").cells), report["elements"])
        self.assertIn("elements)", done.stdout)

    def test_labels(self):
        self.check(4000, "--input", self.input)

    def test_grey_values(self):
        z, y, x = np.mgrid[:20, :20, :20]
        values = np.stack([6 + 0.2 * t - np.sqrt((x - 9 - 0.3 * t)**2 + (y - 9.5)**2 + (z - 9.5)**2) for t in range(6)])
        path = images.write_space_time_nrrd(self.folder / "grey.nrrd", values.astype(np.float32))
        self.check(8000, "--input", path, "--isovalue", 0)


class Flags(SpaceTimeTestCase):
    SPACE_TIME = (("--time-scale", 2), ("--slices", "s_"), ("--slices", "s_", "--slice-count", 3),
                  ("--rule-order", "surface"), ("--no-picking",), ("--picks", 5), ("--sliver-bound", 0.02),
                  ("--seed", 1), ("--no-fine-grained",), ("--frame-steps", 2))

    def test_of_space_time_on_a_3d_image(self):
        path = images.write_nrrd(self.folder / "ball.nrrd", images.ball(12, 4.0))
        for arguments in self.SPACE_TIME:
            with self.subTest(arguments):
                self.assert_refused(2, arguments[0] + ": only for space-time images.*ball.nrrd' is a 3D image",
                                    "--input", path, *arguments)

    def test_of_3d_on_a_space_time_image(self):
        self.refuse(2, "--facet-angle: only for 3D images.*heart.nrrd' is a space-time image", "--facet-angle", 20)
        self.refuse(2, "--optimise-seconds: only for 3D images", "--optimise-seconds", 3)
        for name in ("m.vtk", "m.msh", "m.inp", "m.feb", "m.xdmf"):
            self.refuse(2, "--output: '.%s' does not hold the pentatopes of a space-time image.*use .vtu, .mesh or .mfem"
                        % name[2:], "--output", name)
        for name in ("i.vtp", "i.stl", "i.ply", "i.vtk"):
            self.refuse(2, "--plc: '.%s' does not hold the tetrahedra between labels of a space-time.*use .vtu"
                        % name[2:], "--plc", name)

    def test_values(self):
        for arguments, pattern in (
            (("--time-scale", 0), "--time-scale: must be greater than 0"),
            (("--time-scale", "nan"), "--time-scale: must be a finite number"),
            (("--slices", "s_", "--slice-count", 1), "--slice-count: must be a whole number from 2 to 10000, not '1'"),
            (("--slices", "s_", "--slice-count", "2.5"), "--slice-count: must be a whole number"),
            (("--slice-count", 3), "--slice-count: give the beginning of the slices' names with --slices"),
            (("--rule-order", "quality"), "--rule-order: must be radius-edge or surface, not 'quality'"),
            (("--picks", 0), "--picks: must be a whole number from 1"),
            (("--sliver-bound", -0.1), "--sliver-bound: must lie between 0 and 0.999"),
            (("--sliver-bound", 1, "--force"), "--sliver-bound: must lie between 0 and 0.999"),
            (("--sliver-bound", 0.04), "--sliver-bound: above 0.03.*--force"),
            (("--seed", -1), "--seed: must be a whole number from 0"),
            (("--frame-steps", 9), "--frame-steps: must be a whole number from 0 to 8, not '9'"),
            (("--seed", "x"), "--seed: must be a whole number from 0"),
            (("--no-picking", "--picks", 5), "--picks is about picking regions.*--no-picking"),
            (("--no-picking", "--sliver-bound", 0.02), "--sliver-bound is about picking regions.*--no-picking"),
            (("--no-picking", "--seed", 7), "--seed is about picking regions.*--no-picking"),
        ):
            with self.subTest(arguments):
                self.assert_refused(2, pattern, "--input", self.input, *arguments)

    def test_every_flag(self):
        report = self.statistics("--input", self.input, "--delta", 4, "--time-scale", 1.5, "--rule-order", "surface",
                                 "--no-optimise", "--picks", 4, "--sliver-bound", 0.02, "--seed", 7, "--no-fine-grained", "--slices", "s_",
                                 "--slice-count", 2)
        parameters = report["parameters"]
        self.assertEqual([parameters[key] for key in ("time_scale", "rule_order", "picks", "sliver_bound", "seed",
                                                      "no_fine_grained", "no_optimise", "no_picking", "slices",
                                                      "slice_count")],
                         [1.5, "surface", 4, 0.02, 7, True, True, False, "s_", 2])
        self.assertFalse(report["optimisation"]["ran"])

    def test_forced_sliver_bound(self):
        self.statistics("--input", self.input, "--delta", 5, "--sliver-bound", 0.04, "--force")

    def test_rule_order_changes_the_mesh(self):
        orders = {}
        for order in ("radius-edge", "surface"):
            self.run_with("--rule-order", order, "--radius-edge", 1.5, "--force", "--output", "m.mfem")
            orders[order] = (self.folder / "m.mfem").read_bytes()
        self.run_with("--radius-edge", 1.5, "--force", "--output", "m.mfem")
        self.assertTrue((self.folder / "m.mfem").read_bytes() == orders["radius-edge"])
        self.assertTrue(orders["radius-edge"] != orders["surface"])

    def test_picking_regions(self):
        """They are on by default; the same seed gives the same mesh, another one another."""
        meshes = {}
        for name, arguments in (("default", ()), ("seed 0", ("--seed", 0)), ("seed 1", ("--seed", 1)),
                                ("off", ("--no-picking",))):
            self.mesh("--input", self.input, "--delta", 2, "--threads", 1, "--output", "m.mfem", *arguments)
            meshes[name] = (self.folder / "m.mfem").read_bytes()
        self.assertTrue(meshes["default"] == meshes["seed 0"])
        self.assertEqual(len(set(meshes.values())), 3)


class Statistics(SpaceTimeTestCase):
    def test_figures(self):
        report = self.statistics(*self.arguments, "--output", "m.vtu", "--plc", "b.vtu")
        mesh = meshfiles.read_pentatopes(self.folder / "m.vtu")
        boundary = meshfiles.read_boundary(self.folder / "b.vtu")
        self.assertEqual(report["dimension"], 4)
        self.assertEqual(report["elements"], len(mesh.cells))
        self.assertEqual(report["vertices"], len(mesh.points))
        self.assertEqual(report["interface_facets"], len(boundary.cells))
        for label, volume in mesh.volume_of_label().items():
            figures = report["labels"][str(label)]
            self.assertEqual(figures["elements"], int((mesh.labels == label).sum()))
            self.assertAlmostEqual(figures["volume"], volume, delta=1e-6 * volume)
        self.assertEqual(sum(report["quality"]["normalized_volume_histogram"]), len(mesh.cells))
        self.assertEqual(report["quality"]["inverted_elements"], 0)
        self.assertGreater(report["cavities"]["mean"], 5)
        self.assertGreater(report["cavities"]["largest"], report["cavities"]["mean"])

    def test_summary(self):
        done = self.run_with("--stats", "s.json")
        self.assertRegex(done.stdout, r"^[\d,]+ pentatopes in 2 labels, [\d,]+ vertices, [\d,]+ boundary tetrahedra with "
                         r"delta 2\. Shortest edge [\d.]+; radius-edge ratio at most [\d.]+, [\d.]+ \+- [\d.]+; "
                         r"normalized volume at least [\d.]+, [\d.]+ \+- [\d.]+; cavities of \d+ pentatopes, at most "
                         r"[\d,]+\. Read in")


if __name__ == "__main__":
    main()
