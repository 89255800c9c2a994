#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Labels by name: on the command line, in the mesh, and in the statistics."""
import json
import struct
import unittest
from pathlib import Path

import numpy as np

import images
import meshfiles
from program import ProgramTestCase, main

AAL = Path("/usr/share/mricron/templates/aal.nii.gz")


def names_of(path):
    """{label: name} of the field data of a .vtu or .vtp file."""
    data = meshfiles.read_data(path)
    values, names = data.GetFieldData().GetArray("LabelValues"), meshfiles.texts_of(data, "LabelNames")
    return {values.GetValue(i): names[i] for i in range(values.GetNumberOfValues())} if values else {}


class NamesTestCase(ProgramTestCase):
    TABLE = "3 Left hippocampus\n7 Tibia, left\n"

    def setUp(self):
        super().setUp()
        self.image = images.write_nrrd(self.folder / "i.nrrd", images.two_labels(16, 6.0))
        (self.folder / "names.txt").write_text(self.TABLE)

    def labels(self, *arguments):
        self.mesh("--input", self.image, "--delta", 3, "--output", "m.vtu", *arguments)
        return set(meshfiles.read_tetrahedra(self.folder / "m.vtu").labels)


class Selection(NamesTestCase):
    def test_labels(self):
        table = ("--label-table", "names.txt")
        for arguments, expected in (
            (("--labels", "Left hippocampus"), {3}),
            (("--labels", "left HIPPOCAMPUS"), {3}),
            (("--labels", "Tibia, left"), {7}),
            (("--labels", "Tibia, left", "--labels", "Left hippocampus"), {3, 7}),
            (("--labels", "Left hippocampus,7"), {3, 7}),
            (("--labels", "7"), {7}),
            (("--labels", "3-3,7-7"), {3, 7}),
            ((), {3, 7}),
        ):
            with self.subTest(arguments):
                self.assertEqual(self.labels(*table, *arguments), expected)

    def test_sizes(self):
        """The same as with numbers, bit for bit."""
        for name, number in (("Tibia, left=1.2", "7=1.2"), ("left hippocampus=1.5", "3=1.5")):
            files = []
            for text in (name, number):
                self.mesh("--input", self.image, "--delta", 2, "--threads", 1, "--label-table", "names.txt",
                          "--label-size", text, "--output", "m.mesh")
                files.append((self.folder / "m.mesh").read_bytes())
            self.assertEqual(*files)
        coarse = self.mesh("--input", self.image, "--delta", 2, "--threads", 1, "--output", "m.mesh")
        self.assertNotEqual((self.folder / "m.mesh").read_bytes(), files[0])
        self.assertIn("tetrahedra", coarse.stdout)

    def test_a_name_with_equals_sign(self):
        (self.folder / "names.txt").write_text("3 T1=low\n")
        self.assertEqual(self.labels("--label-table", "names.txt", "--label-size", "T1=low=2"), {3, 7})

    def test_lists_of_sizes(self):
        """A comma behind a number separates. Options may have underscores."""
        (self.folder / "names.txt").write_text("3 Tibia, left\n7 T1=low,1=2\n")
        for options in ((("--label_size=Tibia, left=1.5, T1=low,1=2=1.2",), ("--label-size", "3=1.5", "--label-size", "7=1.2")),
                        (("--interface_size", "Tibia, left=1,7,0=2"), ("--interface-size", "3=1", "--interface-size", "0,7=2"))):
            files = []
            for arguments in options:
                self.mesh("--input", self.image, "--delta", 4, "--threads", 1, "--label-table", "names.txt", *arguments,
                          "--output", "m.mesh")
                files.append((self.folder / "m.mesh").read_bytes())
            self.assertEqual(*files)

    def test_interfaces_of_names(self):
        (self.folder / "names.txt").write_text("3 Tibia, left\n7 Femur\n")
        files = []
        for text in ("3,7=1", "Femur,3=1", "7=2", "femur=2", "3=2", "Tibia, left=2"):
            self.mesh("--input", self.image, "--delta", 4, "--threads", 1, "--label-table", "names.txt",
                      "--interface-size", text, "--output", "m.mesh")
            files.append((self.folder / "m.mesh").read_bytes())
        self.assertEqual(files[0::2], files[1::2])
        self.assertEqual(len(set(files)), 3)

    def test_table_beside_the_image(self):
        (self.folder / "i.nrrd.txt").write_text(self.TABLE)
        self.assertEqual(self.labels("--labels", "Left hippocampus"), {3})

    def test_segments(self):
        self.image = images.write_nrrd(self.folder / "s.seg.nrrd", images.two_labels(16, 6.0), key_values={
            "Segment0_ID": "s0", "Segment0_Name": "Femur", "Segment0_LabelValue": "7", "Segment0_Layer": "0"})
        self.assertEqual(self.labels("--labels", "Femur"), {7})
        self.assertEqual(names_of(self.folder / "m.vtu"), {7: "Femur"})

    @unittest.skipUnless(AAL.exists(), "package mricron-data")
    def test_atlas(self):
        report = self.statistics("--input", AAL, "--labels", "Hippocampus_L,Hippocampus_R", "--delta", 4)
        self.assertEqual({label: figures["name"] for label, figures in report["labels"].items()},
                         {"37": "Hippocampus_L", "38": "Hippocampus_R"})
        self.assertEqual(report["label_names_from"], str(AAL)[:-3] + ".txt")


class Masks(ProgramTestCase):
    """Several files are labels 1, 2, ... with their names."""

    def setUp(self):
        super().setUp()
        self.large = images.write_nrrd(self.folder / "Body.nrrd", images.ball(20, 8.0))
        self.small = images.write_nrrd(self.folder / "Lung.left.seg.nrrd", images.ball(20, 5.0))
        self.shared = images.ball(20, 5.0).sum()
        (self.folder / "masks").mkdir()
        for name, image in (("b10.nrrd", images.ball(20, 5.0)), ("b9.nrrd", images.ball(20, 8.0))):
            images.write_nrrd(self.folder / "masks" / name, image)

    def test_inputs(self):
        for arguments in (("--input", self.large, self.small), (f"--input={self.large}", f"--input={self.small}"),
                          ("--input", self.large, "--input", self.small)):
            statistics = self.statistics(*arguments, "--delta", "2.5", "--output", "m.vtu",
                                         warning=f"masks overlap in {self.shared} voxels, which the smallest of them gets: "
                                                 rf"Body and Lung.left \({self.shared}\)")
            self.assertEqual(names_of(self.folder / "m.vtu"), {1: "Body", 2: "Lung.left"})
            self.assertEqual({label: one["name"] for label, one in statistics["labels"].items()},
                             {"1": "Body", "2": "Lung.left"})
            parameters = statistics["parameters"]
            self.assertEqual((parameters["input"], parameters["overlap"], parameters["resample_masks"]),
                             ([self.large, self.small], "smallest", False))
            self.assertEqual(statistics["label_names_from"], self.large)

    def test_folder(self):
        statistics = self.statistics("--input", "masks", "--labels", "b10", "--delta", "2.5", "--output", "m.vtu",
                                     warning=f"masks overlap in {self.shared} voxels")
        self.assertEqual(names_of(self.folder / "m.vtu"), {2: "b10"})  # of its labels only
        self.assertEqual(set(meshfiles.read_tetrahedra(self.folder / "m.vtu").labels), {2})
        self.assertEqual(statistics["parameters"]["input"], "masks")

    def test_order(self):
        self.mesh("--input", self.small, self.large, "--overlap", "order", "--delta", "2.5", "--output", "m.vtu",
                  warning="which the first of them gets")
        self.assertEqual(names_of(self.folder / "m.vtu"), {1: "Lung.left", 2: "Body"})

    def test_grids(self):
        coarse = images.write_nrrd(self.folder / "coarse.nrrd", images.ball(10, 4.0),
                                   images.Geometry((0.25,) * 3, (2.0,) * 3))
        self.assert_refused(3, "one grid, but '.*Body.nrrd' has the spacing 1 1 1, and '.*coarse.nrrd' 2 2 2; give "
                            "--resample-masks", "--input", self.large, coarse, "--delta", "2.5")
        self.mesh("--input", coarse, self.small, "--resample-masks", "--delta", "2.5", "--output", "m.vtu",
                  warning="masks overlap")
        self.assertEqual(names_of(self.folder / "m.vtu"), {1: "coarse", 2: "Lung.left"})

    def test_output_is_a_mask(self):
        self.assert_refused(3, "Lung.left.seg.nrrd", "image", "--input", self.large, self.small, "--output", self.small)


class Refusal(NamesTestCase):
    def refuse(self, pattern, *arguments, status=2):
        self.assert_refused(status, pattern, "--input", self.image, "--output", "m.vtu", *arguments)

    def test_unknown(self):
        table = ("--label-table", "names.txt")
        self.refuse(r"--labels: no label of the image is called 'Left hipocampus'; did you mean "
                    r"'Left hippocampus' \(3\)\?", *table, "--labels", "Left hipocampus")
        self.refuse(r"--labels: .* 'left'; did you mean '.*' \((3|7)\) or '.*' \((3|7)\)\?", *table, "--labels", "left")
        many = images.write_nrrd(self.folder / "many.nrrd", np.arange(12 * 64).reshape(12, 8, 8).astype(np.uint8) % 12 + 1)
        (self.folder / "ribs.csv").write_text("".join("%d,rib %d\n" % (label, label) for label in range(1, 13)))
        for arguments, pattern in ((("--label-table", "ribs.csv", "--labels", "rib"),
                                    r"'rib 1' \(1\), 'rib 2' \(2\), .* 'rib 5' \(5\) or one of 7 more\?"),
                                   (("--label-table", "ribs.csv", "--labels", "rab 1"), r"did you mean 'rib 1' .* or one of \d more\?")):
            self.assert_refused(2, pattern, "--input", many, *arguments)
        wide = images.write_nrrd(self.folder / "wide.nrrd", np.arange(8 * 8 * 8).reshape(8, 8, 8).astype(np.uint16) // 16 + 1)
        self.assert_refused(1, r"its labels are 1, 2, 3, .*, 20, \.\.\. \(32 in all\)", "--input", wide, "--labels", "99")
        self.refuse("--label-size: no label of the image is called 'Femur'\n", *table, "--label-size", "Femur=2")
        self.refuse("--interface-size: no label of the image is called 'Femur'\n", *table, "--interface-size", "Femur,0=2")

    def test_no_names(self):
        self.refuse("--labels: 'Femur' is not a number, and the labels of the image have no names",
                    "--labels", "Femur")

    def test_ranges(self):
        self.image = images.write_nrrd(self.folder / "two.nrrd", np.where(images.two_labels(16, 6.0) == 7, 4,
                                                                         images.two_labels(16, 6.0)))
        self.assertEqual(self.labels("--labels", "3-4"), {3, 4})
        self.refuse("Label 5 was asked for, but does not occur", "--labels", "3-5", status=1)
        self.refuse("Labels 1, 2, 5, 6 were asked for, but do not occur in the image; its labels are 3, 4", "--labels", "1-6", status=1)
        self.refuse(r"Labels 5, .*, 24, \.\.\. \(46 in all\) were", "--labels", "3-50", status=1)
        self.refuse("Labels 9223372036854775806, 9223372036854775807 were asked", "--labels",
                    "9223372036854775806-9223372036854775807", status=1)
        for text in ("0-3", "4-3", "1-100001", "3-9223372036854775807"):
            self.refuse(f"--labels: '{text}' is not a range of labels, such as 3-7", "--labels", text)
        (self.folder / "names.txt").write_text("3 A\n4 1-2\n")
        self.assertEqual(self.labels("--label-table", "names.txt", "--labels", "1-2"), {4})

    def test_ambiguous(self):
        (self.folder / "names.txt").write_text("3 Bone\n7 Bone\n")
        table = ("--label-table", "names.txt")
        self.refuse("several labels are called 'Bone': 3, 7; give numbers", *table, "--labels", "Bone")
        (self.folder / "names.txt").write_text("3 Bone\n7 bone\n")
        self.refuse("several labels are called 'BONE': 3, 7", *table, "--labels", "BONE")
        self.assertEqual(self.labels(*table, "--labels", "bone"), {7})

    def test_together(self):
        table = ("--label-table", "names.txt")
        self.refuse("--label-size: label 3 is given twice", *table, "--label-size", "Left hippocampus=2",
                    "--label-size", "3=2")
        self.refuse("label 7 is not among those of --labels", *table, "--labels", "Left hippocampus",
                    "--label-size", "Tibia, left=2")

    def test_table(self):
        (self.folder / "names.txt").write_text("3 Bone\nx\n")
        self.refuse("cannot read the label table 'names.txt': line 2: 'x' is not a label", "--label-table", "names.txt",
                    status=3)
        self.refuse("cannot read the label table 'none': there is no such file", "--label-table", "none", status=3)
        (self.folder / "m.vtu").write_text("3 Bone\n")
        self.refuse("cannot write 'm.vtu': it is the input", "--label-table", "m.vtu", status=3)
        self.refuse("--label-table: the name is empty", "--label-table", "")


class Output(NamesTestCase):
    EXPECTED = {3: "Left hippocampus", 7: "Tibia, left"}

    def test_meshes(self):
        self.mesh("--input", self.image, "--label-table", "names.txt", "--delta", 3, "--output", "m.vtu", "--plc", "i.vtp")
        for name in ("m.vtu", "i.vtp"):
            self.assertEqual(names_of(self.folder / name), self.EXPECTED)

    def test_names_with_escapes(self):
        """A line break in a name does not end the header of the image, and a backslash stays."""
        (self.folder / "names.txt").write_text('3,"C:\\new"\n7,"a\\nsizes: 1 1 1"\n')
        self.call("image", self.image, "o.nrrd", "--label-table", "names.txt")
        self.mesh("--input", "o.nrrd", "--delta", 3, "--output", "m.vtu")
        self.assertEqual(names_of(self.folder / "m.vtu"), {3: "C:\\new", 7: "a\\nsizes: 1 1 1"})
        table = (b'<CaretExtension><VolumeInformation><LabelTable><Label Key="3">a\n\nb\nsizes: 1 1 1</Label></LabelTable>'
                 b"</VolumeInformation></CaretExtension>").ljust(152)
        plain = Path(images.write_nifti(self.folder / "i.nii", images.two_labels(16, 6.0))).read_bytes()
        (self.folder / "i.nii").write_bytes(plain[:108] + struct.pack("<f", 512.0) + plain[112:348] + b"\1\0\0\0" +
                                            struct.pack("<2i", 160, 0) + table + plain[352:])
        self.call("image", "i.nii", "o.nrrd")
        self.mesh("--input", "o.nrrd", "--delta", 3, "--output", "m.vtu")
        self.assertEqual(names_of(self.folder / "m.vtu"), {3: "a  b sizes: 1 1 1"})

    def test_space_time(self):
        path = images.write_nrrd(self.folder / "t.nrrd", np.stack([images.two_labels(16, 6.0)] * 3))
        done = self.mesh("--input", path, "--label-table", "names.txt", "--delta", 4, "--labels", "Left hippocampus",
                         "--output", "m.vtu", "--plc", "b.vtu", "--slices", "s_")
        self.assertRegex(done.stderr, r"Volumes are off by 3 % or more in \d frames?, most in frame \d \(from 0 on\), where the mesh "
                                      r"has \d+ % of label 3 \(Left hippocampus\)\. A larger --time-scale follows")
        for name in ("m.vtu", "b.vtu", "s_0.vtu", "s_2.vtu"):
            self.assertEqual(names_of(self.folder / name), {3: "Left hippocampus"})

    def test_statistics(self):
        array = images.two_labels(16, 6.0)
        array[8, 8, 8] = 9  # one voxel beside an interface
        path = images.write_nrrd(self.folder / "lost.nrrd", array)
        (self.folder / "names.txt").write_text(self.TABLE + "9 Speck\n")
        self.mesh("--input", path, "--label-table", "names.txt", "--delta", 3, "--stats", "s.json",
                  "--smallest-component", 0, warning=r"lacks these labels of the image.*: 9 \(Speck\)\.")
        report = json.loads((self.folder / "s.json").read_text())
        self.assertEqual({label: list(figures)[0] for label, figures in report["labels"].items()},
                         {"3": "name", "7": "name"})
        self.assertEqual({int(label): figures["name"] for label, figures in report["labels"].items()}, self.EXPECTED)
        self.assertEqual((report["lost_labels"], report["lost_label_names"]), ([9], ["Speck"]))
        self.assertEqual((report["label_names_from"], report["parameters"]["label_table"]), ("names.txt",) * 2)

        array = images.two_labels(24, 6.0)
        array[2] = 9  # a sheet of one voxel
        path = images.write_nrrd(self.folder / "sheet.nrrd", array)
        self.mesh("--input", path, "--label-table", "names.txt", "--delta", 8, "--stats", "s.json", "--interface-rounds", 0,
                  warning=r"a tenth or more of the volume of these labels, which are small or thin for a --delta of 8 .*"
                          r"9 \(Speck\) \(\d+ %\).*\. --exact-components or a smaller --delta keeps them\.")
        shrunk = json.loads((self.folder / "s.json").read_text())["shrunk_labels"]
        self.assertIn((9, "Speck"), [(one["label"], one["name"]) for one in shrunk])

        report = self.statistics("--input", self.image, "--delta", 3)
        self.assertEqual({figures["name"] for figures in report["labels"].values()}, {None})
        self.assertEqual((report["label_names_from"], report["parameters"]["label_table"]), (None, None))

    def test_no_label_of_the_table(self):
        (self.folder / "names.txt").write_text("1 a\n")
        self.mesh("--input", self.image, "--label-table", "names.txt", "--delta", 3, "--output", "m.vtu",
                  warning="no label that 'names.txt' lists is in the image")
        self.assertEqual(names_of(self.folder / "m.vtu"), {})


if __name__ == "__main__":
    main()
