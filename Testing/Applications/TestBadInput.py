#!/usr/bin/python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Wrong calls and bad input: a clear message, the right status, nothing written."""
import os
import resource
import unittest

import numpy as np

import images
from program import ProgramTestCase, main


class CommandLine(ProgramTestCase):
    def refuse(self, pattern, *arguments):
        self.assert_refused(2, pattern, *arguments)

    def test_flags_and_values(self):
        known = ("--input", "a.nrrd")
        for pattern, arguments in (
            ("which image shall be meshed", ()),
            ("unknown option '--inptu'; did you mean --input", ("--inptu", "a.nrrd")),
            ("unknown option '--elegance'", (*known, "--elegance", "1")),
            # Abbreviations are not guessed.
            ("unknown option '--thread'; did you mean --threads", (*known, "--thread", "2")),
            ("unknown option '--balances'; did you mean --balance", ("--balances", "hws")),
            ("--isovalue: only for one image", (*known, "b.nrrd", "--isovalue", "1")),
            ("--overlap.*smallest", (*known, "--overlap", "largest")),
            ("--mask-threshold: must lie between 0 and 1, not 1.5", (*known, "--mask-threshold", "1.5")),
            ("--input.* needs a value", ("--input",)),
            ("--balance.* needs a value", (*known, "--balance")),
            ("'--elements' needs a value, but '--output' follows it", (*known, "--elements", "--output", "b.vtu")),
            ("'--input' needs a value, but '--pin' follows it", ("--input", "--pin")),
            ("'--labels' needs a value, but '--delta=1' follows it", ("--labels", "--delta=1", *known)),
            # Some take none.
            ("--pin", (*known, "--pin=yes")),
            ("--contention.* more than once", (*known, "--contention", "local", "--contention", "random")),
            ("--delta.* more than once", (*known, "--delta", "1", "--delta", "2")),
        ):
            with self.subTest(arguments):
                self.refuse(pattern, *arguments)
        # Two dashes at the beginning of a value are possible.
        self.assert_refused(3, "'--pin'", "--pin", "--input=--pin", "--force")

    def test_delta(self):
        for value in ("0", "-1", "-0.5", "0.0"):
            self.refuse("--delta: must be greater than 0, not " + value, "--input", "a.nrrd", "--delta", value)
        for value in ("nan", "inf", "-inf"):
            self.refuse("--delta: must be a finite number", "--input", "a.nrrd", "--delta", value)
        for value in ("1,5", "1mm", "", "one", "1 2"):
            self.refuse("--delta: '.*' is not a number", "--input", "a.nrrd", "--delta", value)

    def test_other_numbers(self):
        for arguments, pattern in (
            (("--size", "-2"), "--size: must be greater than 0"),
            (("--radius-edge", "0.5"), "--radius-edge: must be 1 or more, not 0.5"),
            (("--radius-edge", "0.9", "--force"), "--radius-edge: must be 1 or more, not 0.9"),
            (("--radius-edge", "1.5"), "--radius-edge: .*--force"),
            (("--grading", "thickness"), "--grading: must be uniform or lfs, not 'thickness'"),
            (("--feature-ratio", "0"), "--feature-ratio: must be greater than 0"),
            (("--largest-feature", "-3"), "--largest-feature: must be greater than 0"),
            (("--grading", ""), "--grading: must be uniform or lfs, not ''"),
            (("--elements", "0"), "--elements: must be a whole number from 1 "),
            (("--elements", "-5"), "--elements: must be a whole number from 1 .*, not '-5'"),
            (("--elements", "1e5"), "--elements: must be a whole number from 1 .*, not '1e5'"),
            (("--gradation", "-1"), "--gradation: must be 0 or more, not -1"),
            (("--interface-rounds", "-1"), "--interface-rounds: must be a whole number from 0 to 100, not '-1'"),
            (("--optimise-seconds", "0"), "--optimise-seconds: must be greater than 0, not 0"),
            (("--isovalue", "nan"), "--isovalue: must be a finite number"),
            (("--isovalue", "1", "--inside", "left"), "--inside: must be above or below, not 'left'"),
            (("--isovalue", "1", "--inside-label", "0"), "--inside-label: must be a whole number from 1"),
            (("--facet-angle", "31"), "--facet-angle: must lie between 0 and 30"),
            (("--facet-angle", "-1"), "--facet-angle: must lie between 0 and 30"),
            (("--sliver-angle", "60"), "--sliver-angle: must lie between 0 and 59"),
            (("--sliver-angle", "16"), "--sliver-angle: .*--force"),
            (("--smallest-component", "-1"), "--smallest-component: must be a whole number"),
            (("--min-component-volume", "0"), "--min-component-volume: must be"),
            (("--smoothing", "-1"), "--smoothing: must lie between 0 and 5, not -1"),
            (("--threads", "-2"), "--threads: must be a whole number"),
            (("--threads", "1.5"), "--threads: must be a whole number"),
            (("--memory-limit", "much"), "--memory-limit: 'much' is not an amount"),
            (("--contention", "loc"), "--contention: must be aggressive, random, global or local, not 'loc'"),
            (("--contention", ""), "--contention: must be aggressive, random, global or local, not ''"),
            (("--contention", "hws"), "--contention: must be aggressive.*, not 'hws'"),
            (("--balance", "local"), "--balance: must be rws or hws, not 'local'"),
            (("--balance", "0"), "--balance: must be rws or hws, not '0'"),
            (("--spacing", "1,1"), "--spacing: give 3 numbers with commas between them, such as 0.5,0.5,2, not '1,1'"),
            (("--spacing", "2"), "--spacing: give 3 numbers"),
            (("--spacing", "1,0,1"), "--spacing: must be greater than 0, not 0"),
            (("--spacing", "1,1,-2"), "--spacing: must be greater than 0, not -2"),
            (("--spacing", "1,1,nan"), "--spacing: must be a finite number"),
            (("--spacing", "1 1 1"), "--spacing: '1 1 1' is not a number"),
            (("--origin", "1,1,1,1"), "--origin: give 3 numbers with commas between them, such as -10,0,25.5, not '1,1,1,1'"),
            (("--origin", "0,inf,0"), "--origin: must be a finite number"),
            (("--direction", "1,0,0"), "--direction: give 9 numbers"),
            (("--direction", "1,0,0,0,1,0,0,0,0"), "--direction: the columns .*, and these are not independent"),
            (("--direction", "1,2,0,1,2,0,0,0,1"), "--direction: the columns of the matrix .* are not independent"),
            (("--direction", "0,0,0,0,0,0,0,0,0"), "--direction: .* are not independent"),
            (("--direction", "0,-2,0,0.5,0,0,0,0,1"), "--direction: .* must have the length 1, .* have 0.5, 2 and 1; of an affine, .* --spacing"),
            (("--direction", "1,0,0,0,1,0,0,0,1.002"), "--direction: .* have 1, 1 and 1.002"),
            (("--direction", "1e-3,0,0,0,1e-3,0,0,0,1e-3"), "--direction: .* have 0.001, 0.001 and 0.001"),
        ):
            with self.subTest(arguments):
                self.refuse(pattern, "--input", "a.nrrd", *arguments)

    def test_options_without_effect(self):
        """They are refused rather than ignored."""
        for option in ("--feature-ratio", "--largest-feature"):
            for grading in ((), ("--grading", "uniform")):
                self.refuse(option + ": .*give --grading lfs as well, or leave it out", "--input", "a.nrrd", option, "2",
                            *grading)
        self.refuse("--optimise-seconds limits what --no-optimise switches off: leave one of the two out",
                    "--input", "a.nrrd", "--no-optimise", "--optimise-seconds", "3")
        self.refuse("--hausdorff: .*grey-value.*--quality", "--input", "a.nrrd", "--isovalue", "3", "--hausdorff")

    def test_labels(self):
        for arguments, pattern in (
            (("--labels", "1,,2"), "--labels: '' is not a label"),
            (("--labels", "1,-2"), "--labels: '-2' is not a label"),
            (("--labels", "0"), "--labels: '0' is not a label"),
            (("--label-size", "3"), "--label-size: '3' is not of the form"),
            (("--label-size", "3=1,2"), "--label-size: '2' is not of the form"),
            (("--label-size", "3=1,"), "--label-size: '' is not of the form"),
            (("--label-size", "3=0"), "--label-size: must be greater than 0"),
            (("--label-size", "1.5=1"), "--label-size: '1.5' is not a label"),
            (("--label-size", "=1"), "--label-size: '' is not a label"),
            (("--interface-size", "3"), "--interface-size: '3' is not of the form .*--delta"),
            (("--interface-size", "=3"), "--interface-size: '=3' is not of the form"),
            (("--interface-size", "3,7=0"), "--interface-size: must be greater than 0"),
            (("--interface-size", "3,=1"), "--interface-size: '' is not a label"),
            (("--interface-size", "3,-7=1"), "--interface-size: '-7' is not a label"),
            (("--interface-size", "3,7,9=1"), "--interface-size: '3,7,9' is more than two labels"),
            (("--interface-size", "3,3=1"), "--interface-size: label 3 has no interface with itself"),
            (("--interface-size", "3,7=1", "--interface-size", "7,3=1"), "--interface-size: '7,3' is given twice"),
            (("--labels", "1", "--interface-size", "0,3=1"), "label 3 is not among those of --labels"),
            (("--elements", "10", "--delta", "1"), "--delta and --elements do not go together"),
            (("--labels", "Tibia,1.5"), "--labels: '1.5' is not a label"),
            (("--label-size", "3=1", "--label-size", "3=2"), "--label-size: label 3 is given twice"),
            (("--labels", "1", "--label-size", "3=1"), "label 3 is not among those of --labels"),
            (("--space", "xyz"), "--space: must be lps or ras"),
        ):
            with self.subTest(arguments):
                self.refuse(pattern, "--input", "a.nrrd", *arguments)

    def test_extensions(self):
        """Refused before the input is even looked at."""
        self.refuse("--output: the format '.foo' is not known", "--input", "a.nrrd", "--output", "m.foo")
        self.refuse("--output: 'mesh' has no extension", "--input", "a.nrrd", "--output", "mesh")
        self.refuse("--output: .*goes with --plc", "--input", "a.nrrd", "--output", "m.stl")
        self.refuse("--plc: .*goes with --output", "--input", "a.nrrd", "--plc", "m.msh")
        self.refuse("--stats: .*use .json", "--input", "a.nrrd", "--stats", "m.txt")


class Outputs(ProgramTestCase):
    def setUp(self):
        super().setUp()
        self.input = images.write_nrrd(self.folder / "ball.nrrd", images.ball())

    def refuse(self, pattern, *arguments, **options):
        return self.assert_refused(3, pattern, "--input", self.input, "--delta", 3, *arguments, **options)

    def test_missing_folder(self):
        self.refuse("cannot write 'nowhere/m.vtu': there is no folder 'nowhere'", "--output", "nowhere/m.vtu")

    def test_file_in_place_of_the_folder(self):
        self.refuse("there is no folder", "--output", "ball.nrrd/m.vtu")

    def test_folder_that_takes_no_files(self):
        self.refuse("cannot write '/proc/m.vtu'", "--output", "/proc/m.vtu")

    @unittest.skipIf(os.geteuid() == 0, "root may write everywhere")
    def test_read_only_folder(self):
        (self.folder / "locked").mkdir(mode=0o500)
        self.refuse("cannot write 'locked/m.vtu'.*permission", "--output", "locked/m.vtu")

    def test_output_is_a_folder(self):
        (self.folder / "m.vtu").mkdir()
        self.refuse("it is a folder", "--output", "m.vtu")

    def test_one_name_twice(self):
        self.refuse("two outputs have this name", "--output", "m.vtk", "--plc", "./m.vtk")

    def test_output_is_the_input(self):
        os.link(self.input, self.folder / "ball.vtk")
        self.refuse("it is the input", "--output", "ball.vtk")

    def test_full_disk(self):
        """A limit on the size of files stands in for it. What was there before stays."""
        def limit():
            resource.setrlimit(resource.RLIMIT_FSIZE, (4096, resource.RLIM_INFINITY))

        for name, flag in (("m.vtu", "--output"), ("m.xdmf", "--output"), ("i.ply", "--plc")):
            with self.subTest(name):
                (self.folder / name).write_text("old")
                self.assert_refused(3, "cannot write '%s': " % name, "--input", self.input, "--delta", 1.2, flag, name,
                                    preexec_fn=limit)


class Files(ProgramTestCase):
    def refuse(self, pattern, path, *arguments):
        done = self.assert_refused(3, pattern, "--input", path, "--output", "mesh.vtu", *arguments)
        self.assertIn(os.path.basename(str(path)), done.stderr)
        return done

    def test_missing(self):
        self.refuse("cannot read 'none.nrrd': there is no such file", "none.nrrd")

    def test_empty(self):
        (self.folder / "empty.nrrd").touch()
        self.refuse("the file is empty", "empty.nrrd")

    def test_no_image(self):
        rng = np.random.default_rng(5)
        for name, magic in (("text.txt", b"hello"), ("text.nrrd", b"hello"), ("noise.nii", b""), ("noise.nii.gz", b""),
                            ("noise.png", b"\x89PNG\r\n\x1a\n"), ("noise.h5", b"\x89HDF\r\n\x1a\n"),
                            ("noise.tif", b"II*\0"), ("noise.dcm", b"\0" * 128 + b"DICM")):
            with self.subTest(name):
                (self.folder / name).write_bytes(magic + rng.bytes(1000))
                self.assert_refused(3, "cannot read '%s': .*(not an image|damaged|picture|HDF5)" % name, "--input", name, "--output", "mesh.vtu")

    def test_series_of_a_file(self):
        self.refuse("--series needs a folder", images.write_nrrd(self.folder / "i.nrrd", images.ball()),
                    "--series", "1.2")

    def test_bad_size_image(self):
        path = images.write_nrrd(self.folder / "i.nrrd", images.ball())
        self.assert_refused(3, "cannot read 'none.nrrd'", "--input", path, "--size-image", "none.nrrd")


class Labels(ProgramTestCase):
    def refuse(self, pattern, array, *arguments):
        path = images.write_nrrd(self.folder / "i.nrrd", array)
        self.assert_refused(1, "cannot mesh '.*i.nrrd': .*" + pattern, "--input", path, "--output", "mesh.vtu",
                            *arguments)

    def test_voxels(self):
        ball = images.ball(12, 4.0)
        for array, pattern in (
                (0 * ball, "no foreground"), (ball[5:6], "1 voxel.* along axis 2"), (ball[:1, :1, :1] + 1, "1 voxel"),
                (ball * np.float32(1.5), "1.5.*whole"), (np.where(ball, np.nan, 0.0), "nan"),
                (ball.astype(np.int16) * -1, "-1.*negative"),
                (np.arange(20**3, dtype=np.uint16).reshape(20, 20, 20), "grey-value")):
            with self.subTest(pattern):
                self.refuse(pattern, array)

    def test_grey_values(self):
        noise = np.random.default_rng(3).integers(1, 256, (30, 30, 30), dtype=np.uint8)
        for flags in ((), ("--min-component-volume", "3")):
            self.refuse("255 labels look like grey values.*isosurface of it with --isovalue, or go on with --force", noise, *flags)

    def test_unknown_labels(self):
        self.refuse("--label-size.* label 5", images.ball(12, 4.0), "--label-size", "5=1")
        self.refuse("--interface-size.* label 5", images.ball(12, 4.0), "--interface-size", "5,1=1")
        self.refuse("label 5.* --labels", images.ball(12, 4.0), "--labels", "1,5")

    def test_too_fine(self):
        self.refuse("elements.* memory.* larger delta.* --force", images.ball(24, 9.0), "--delta", "1e-5")

    def test_memory_limit(self):
        array = images.ball(40, 16.0)
        self.refuse("elements.* memory.* --force", array, "--delta", "0.2", "--memory-limit", "5M")
        # --force goes on all the same; coarse enough to end soon.
        path = images.write_nrrd(self.folder / "i.nrrd", array)
        self.mesh("--input", path, "--delta", "2", "--memory-limit", "100K", "--force", "--output", "mesh.vtu")


if __name__ == "__main__":
    main()
