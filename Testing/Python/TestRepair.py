#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Repairs and checks of the image before it is meshed: by the program, and in Python."""
import json

import numpy

import images
import voxplex
from program import ProgramTestCase, main


def phantom():
    """A ball with a cavity, an antenna and a sheet."""
    labels = numpy.zeros((40, 40, 40), dtype=numpy.uint8)
    labels[numpy.linalg.norm(numpy.mgrid[:40, :40, :40] - 14.5, axis=0) < 10] = 3
    repaired = labels.copy()
    labels[14, 14, 14:16] = 0
    labels[14, 14, 24:30] = 3
    labels[30, 5:35, 5:35] = 7
    repaired[29:32, 5:35, 5:35] = 7
    return labels, repaired


NAMES = {3: "Ball", 7: "Sheet"}
OPTIONS = ("--fill-holes", 2, "--remove-spikes", "--min-thickness", "Sheet=3")


class Program(ProgramTestCase):
    def setUp(self):
        super().setUp()
        self.labels, self.repaired = phantom()
        self.write(self.labels)

    def write(self, labels):
        names = {f"Segment{label}_{key}": value for label, name in NAMES.items()
                 for key, value in (("ID", name), ("LabelValue", label), ("Layer", 0), ("Name", name))}
        images.write_nrrd(self.folder / "dirty.nrrd", labels, key_values=names)

    def run_program(self, *arguments, verb="image"):
        done = self.call(verb, "--input", "dirty.nrrd", *arguments)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return done.stdout

    def check_repaired(self, voxels):
        """The sheet's border grows, too."""
        inside = numpy.zeros_like(voxels, dtype=bool)
        inside[:, 8:32, 8:32] = True
        inside[:25] = True
        numpy.testing.assert_array_equal(voxels[inside], self.repaired[inside])

    def test_saved_image(self):
        told = self.run_program(*OPTIONS, "--shell", "Ball=2", "--shell", "7=-1", "--output", "clean.nrrd", "--stats", "told.json")
        rows = json.loads((self.folder / "told.json").read_text())["repair"]
        self.assertEqual([row["what"] for row in rows], ["fill-holes", "remove-spikes", "min-thickness", "shell", "shell"])
        self.assertRegex(told, r"^fill-holes: label 3 \(Ball\): 2 voxels, at \(14-15, 14, 14\)\n"
                               r"remove-spikes: label 3 \(Ball\): 5 voxels, at \(25-29, 14, 14\)\n"
                               r"min-thickness: label 7 \(Sheet\): \d+ voxels, at \([\d, -]+\)\n"
                               r"shell: label 3 \(Ball\): \d+ voxels became label 8, at \([\d, -]+\)\n"
                               r"shell: label 7 \(Sheet\): \d+ voxels became label 9, at \([\d, -]+\)\n$")
        clean = voxplex.read_segmentation(self.folder / "clean.nrrd")
        self.assertEqual(clean.names, {**NAMES, 8: "Ball shell", 9: "Sheet shell"})
        voxels = clean.voxels.copy()
        voxels[voxels == 8] = 0
        voxels[voxels == 9] = 7
        self.check_repaired(voxels)

    def test_check_makes_no_mesh(self):
        told = self.run_program()
        self.assertEqual(told, "cavities: label 3 (Ball): 2 voxels, at (14-15, 14, 14)\n"
                               "spikes: label 3 (Ball): 5 voxels, at (25-29, 14, 14)\n"
                               "thin: label 3 (Ball): 5 voxels, at (25-29, 14, 14)\n"
                               "thin: label 7 (Sheet): 900 voxels, at (5-34, 5-34, 30)\n")
        self.assertEqual(self.run_program(*OPTIONS).splitlines()[3:], [])
        self.write(self.repaired)
        self.assertEqual(self.run_program(), "Nothing is suspicious.\n")

    def test_mesh(self):
        """A mesh of the repaired image, the report in the statistics, and the same image to compare with."""
        told = self.run_program(*OPTIONS, "--shell", "Ball=3", "--check-image", "--labels", "Ball", "--delta", 2,
                                "--output", "mesh.vtu", "--stats", "mesh.json", "--quality", verb="mesh")
        self.assertIn("\nfill-holes: label 3 (Ball): 2 voxels, at (14-15, 14, 14)\n", told)
        figures = json.loads((self.folder / "mesh.json").read_text())
        self.assertEqual([row["what"] for row in figures["repair"]],
                         ["fill-holes", "remove-spikes", "min-thickness", "shell", "necks", "gaps", "gaps"])
        self.assertEqual(figures["repair"][0], {"what": "fill-holes", "label": 3, "voxels": 2, "places": 1, "largest": 2,
                                                "first": [14, 14, 14], "last": [15, 14, 14]})
        self.assertEqual(figures["repair"][3]["new_label"], 8)
        self.assertEqual({name: figures["parameters"][name] for name in ("fill_holes", "min_thickness", "shell")},
                         {"fill_holes": 2, "min_thickness": {"7": 3.0}, "shell": {"3": 3.0}})
        self.assertEqual(set(figures["labels"]), {"3", "8"})
        volumes = {label: row["volume"] for label, row in figures["labels"].items()}
        self.assertAlmostEqual(volumes["3"] / numpy.count_nonzero(self.repaired == 3), 1, delta=0.02)
        self.run_program(*OPTIONS, "--shell", "Ball=3", "--mesh", "mesh.vtu", "--labels", "3,8", "--stats", "again.json", verb="measure")
        again = json.loads((self.folder / "again.json").read_text())
        self.assertEqual(again["image"]["lost_labels"], [])
        self.assertLess(max(abs(row["volume_error"]) for row in again["labels"].values()), 0.03)
        self.assertEqual(again["repair"], figures["repair"][:4])
        self.assertIn("\nfill-holes: label 3", self.run_program("--fill-holes", 2, "--mesh", "mesh.vtu", verb="measure"))

    def test_series(self):
        frames = images.moving_balls(size=12, radius=3.0)
        frames[0, 6, 6, 6] = 0
        images.write_nrrd(self.folder / "dirty.nrrd", frames)
        told = self.run_program("--fill-holes", 1, "--shell", "6=1", "--output", "clean.nrrd")
        first = told.splitlines()[0]
        self.assertRegex(first, r"^time 0: fill-holes: label \d+: 1 voxel, at \(6, 6, 6\)$")
        clean = voxplex.read_segmentation(self.folder / "clean.nrrd").voxels
        highest = int(frames.max())
        self.assertEqual({int(frame.max()) for frame in clean}, {highest + 1})
        frames[0, 6, 6, 6] = clean[0, 6, 6, 6]
        numpy.testing.assert_array_equal(numpy.where(clean == highest + 1, 0, clean), frames)
        self.assertGreater(frames[0, 6, 6, 6], 0)

    def test_series_with_an_empty_frame(self):
        frames = images.moving_balls(size=12, radius=3.0)
        frames[1] = 0
        images.write_nrrd(self.folder / "dirty.nrrd", frames)
        told = self.run_program("--shell", "6=1", "--check-image", "--output", "clean.nrrd")
        self.assertIn("time 1: shell: label 6: 0 voxels", told)
        clean = voxplex.read_segmentation(self.folder / "clean.nrrd").voxels
        self.assertEqual((int(clean[1].max()), int(clean[2].max())), (0, int(frames.max()) + 1))

    def test_told(self):
        """What a repair could not do: also by frame, in the statistics, and in terms of Python."""
        frames = images.moving_balls(frames=2, size=14, radius=4.0)
        for image, begin in ((frames[0], ""), (frames, "time 1: ")):
            images.write_nrrd(self.folder / "dirty.nrrd", image)
            for output in ("clean.nrrd", "mesh.vtu"):
                done = self.call("image" if output == "clean.nrrd" else "mesh", "dirty.nrrd", "--shell", "6=0.3", *(
                    ("--output", output) if output == "clean.nrrd" else ("--delta", 2, "--output", output, "--stats", "run.json")))
                self.assertEqual(done.returncode, 0)
                self.assertRegex(done.stderr, rf"(?m)^voxplex: warning: {begin}--shell: label 6 still touches .* "
                                              r"at \d+ faces .* From 0\.5 on it is closed\.$")
                self.assertNotIn("shell", self.call("image", "dirty.nrrd", "out.nrrd", "--shell", "6=0.5").stderr)
            self.assertGreater(json.loads((self.folder / "run.json").read_text())["repair"][-1]["touching_faces"], 100)
        with self.assertWarnsRegex(voxplex.MeshingWarning, "^shells: label 6 still touches"):
            voxplex.mesh(frames[0], delta=2, shells={6: 0.3})

    def test_label_of_no_frame(self):
        frames = images.moving_balls(size=12, radius=3.0)
        frames[1] = 0
        images.write_nrrd(self.folder / "dirty.nrrd", frames)
        for flag in ("--shell", "--min-thickness"):
            self.assert_refused(1, f"cannot repair 'dirty.nrrd': {flag}: no frame of the image has label 5", "image", "dirty.nrrd",
                                flag, "5=1", "--output", "clean.nrrd")
        with self.assertRaisesRegex(voxplex.MeshingError, "shells: no frame of the image has label 5"):
            voxplex.mesh(frames, times=range(5), delta=2, shells={5: 1})

    def test_refused(self):
        for option, value in (("--labels", "Nonsense"), ("--min-component-volume", 9), ("--delta", 3)):
            self.assert_refused(2, f"{option} is an option of 'voxplex mesh'.*, not of 'voxplex image'", "image", "dirty.nrrd", option, value)
        for status, pattern, arguments in (
                (1, "cannot repair 'dirty.nrrd': --shell: the image has no label 5; it has 3, 7", ("--shell", "5=1")),
                (2, "no label of the image is called 'Bal'; did you mean 'Ball'", ("--min-thickness", "Bal=1")),
                (2, "--min-thickness: .*-2", ("--min-thickness", "3=-2")), (2, "--fill-holes: .*0", ("--fill-holes", 0)),
                (1, "--shell of label 3 is 0; it must be finite, and not 0", ("--shell", "3=0")),
                (2, "--shell: label 3 is given twice", ("--shell", "3=1", "--shell", "3=2")),
                (2, "--fill-holes: grey-value images have no labels", ("--fill-holes", 1, "--isovalue", 2)),
                (2, "--check-image: grey-value images have no labels", ("--check-image", "--isovalue", 2))):
            self.assert_refused(status, pattern, "--input", "dirty.nrrd", *arguments, "--output", "mesh.vtu")
        self.call("--input", "dirty.nrrd", "--delta", 2, "--output", "mesh.vtu")
        self.assert_refused(2, "--shell: only with an image beside the mesh", "measure", "mesh.vtu", "--shell", "3=1")


class Python(ProgramTestCase):
    def test_keywords(self):
        labels, repaired = phantom()
        image = voxplex.Image(labels, names={**NAMES, 20: "Elsewhere"})
        image.colors = {3: (1, 0, 0), 7: (0, 1, 0)}
        mesh = voxplex.mesh(image, delta=2, fill_holes=2, remove_spikes=True, min_thickness={"Sheet": 3}, shells={"Ball": 2},
                            check_image=True)
        rows = mesh.statistics["repair"]
        self.assertEqual([(row["what"], row["label"]) for row in rows],
                         [("fill-holes", 3), ("remove-spikes", 3), ("min-thickness", 7), ("shell", 3)])
        self.assertEqual(mesh.names, {**NAMES, 8: "Ball shell"})
        self.assertEqual(mesh.colors, {3: [1, 0, 0], 7: [0, 1, 0]})
        self.assertEqual(set(mesh.labels), {3, 7, 8})
        self.assertEqual(mesh.statistics["labels"]["8"]["name"], "Ball shell")
        self.assertAlmostEqual(mesh.statistics["labels"]["3"]["volume"] / numpy.count_nonzero(repaired == 3), 1, delta=0.02)
        self.assertNotIn("repair", voxplex.mesh(image, delta=3).statistics)

    def test_closed_shells(self):
        """In the mesh, too, with thick slices and at corners of voxels."""
        for spacing, size in (((0.5, 0.5, 3.0), (12, 56, 56)), ((3.0, 0.5, 0.5), (56, 56, 12)), ((1.0, 1.0, 1.0), (28, 28, 28))):
            where = (numpy.indices(size).T - (numpy.array(size) - 1) / 2) * spacing[::-1]
            image = voxplex.Image((numpy.linalg.norm(where.T, axis=0) < 10).astype(numpy.uint8), spacing=spacing)
            for thickness in (2.0, -2.0):
                pairs = voxplex.mesh(image, delta=1.5, shells={1: thickness}).interfaces.labels
                self.assertEqual({tuple(pair) for pair in numpy.sort(pairs, axis=1)}, {(0, 2), (1, 2)})

    def test_repair(self):
        """An image, which makes the same mesh; of arrays, files, series and images with a space."""
        labels = phantom()[0]
        ways = dict(fill_holes=2, remove_spikes=True, min_thickness={"sheet": 3}, shells={"Ball": 2})
        image = voxplex.Image(labels, names=NAMES, space="RAS", spacing=(1, 1, 1.25), origin=(3, 4, 5))
        image.field_data["Note"] = ["x"]
        repaired = voxplex.repair(image, check_image=True, **ways)
        self.assertEqual([(row["what"], row["label"]) for row in repaired.statistics["repair"]][:4],
                         [("fill-holes", 3), ("remove-spikes", 3), ("min-thickness", 7), ("shell", 3)])
        self.assertEqual((repaired.names, repaired.space, repaired.spacing, repaired.origin, repaired.field_data),
                         ({**NAMES, 8: "Ball shell"}, "RAS", [1, 1, 1.25], [3, 4, 5], {"Note": ["x"]}))
        ours, theirs = voxplex.mesh(repaired, 2.0, threads=1), voxplex.mesh(image, 2.0, threads=1, **ways)
        numpy.testing.assert_array_equal(ours.points, theirs.points)
        self.assertEqual(ours.names, theirs.names)
        numpy.testing.assert_array_equal(labels, phantom()[0])
        image.write(self.folder / "image.nrrd")
        of_file = voxplex.repair(self.folder / "image.nrrd", space="RAS", **ways)
        numpy.testing.assert_array_equal(of_file.voxels, repaired.voxels)
        self.assertEqual((of_file.names, of_file.space, of_file.origin), (repaired.names, "RAS", [3, 4, 5]))
        series = voxplex.repair([labels, labels], times=(1, 5), fill_holes=2)
        self.assertEqual((series.times, [row["time"] for row in series.statistics["repair"]]), ([1, 5], [1, 5]))
        self.assertEqual(voxplex.repair(labels).statistics, {"repair": []})
        with self.assertRaisesRegex(voxplex.ArgumentError, "no label is called 'Bal'"):
            voxplex.repair(image, shells={"Bal": 1})
        with self.assertRaisesRegex(voxplex.MeshingError, "shells: the image has no label 5"):
            voxplex.repair(labels, shells={5: 1})

    def test_name_of_a_label_that_is_absent(self):
        labels = phantom()[0]
        mesh = voxplex.mesh(voxplex.Image(labels, names={3: "Ball", 8: "Far"}), delta=3, shells={7: 1})
        self.assertEqual(mesh.names, {3: "Ball"})
        self.assertIn(8, mesh.labels)

    def test_errors(self):
        labels = phantom()[0]
        with self.assertRaisesRegex(voxplex.ArgumentError, "no label is called 'Bal'"):
            voxplex.mesh(voxplex.Image(labels, names=NAMES), shells={"Bal": 1})
        with self.assertRaisesRegex(voxplex.MeshingError, "shells: the image has no label 5; it has 3, 7"):
            voxplex.mesh(labels, shells={5: 1})
        with self.assertRaisesRegex(TypeError, "min_thickness must be a dictionary of lengths"):
            voxplex.mesh(labels, min_thickness=3)


if __name__ == "__main__":
    main()
