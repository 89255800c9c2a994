# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""voxplexPhantom as a script calls it: files are read back, wrong arguments are refused."""
import math
import os
import subprocess
import unittest

import numpy as np

from folders import FolderTestCase

PI = math.pi
BALL = 4 / 3 * PI
# Arguments, sizes of the axes, spacings, volumes of labels: of each frame, but of all frames of a four-ball; None: any.
PHANTOMS = (
    ("ball --coarsening 8", [52] * 3, [0.32] * 3, [BALL * 7.5 ** 3]),
    ("embedded-balls --coarsening 4", [158, 104, 104], [0.16] * 3,
     [BALL * (7.5 ** 3 - 3 ** 3), BALL * 3 ** 3, BALL * 0.75 ** 3]),
    ("torus --coarsening 2", [73, 73, 33], [0.5] * 3, [2 * PI ** 2 * 10.5 * 7 ** 2]),
    ("four-ball --radius 6", [20] * 4, [1] * 4, [PI ** 2 * 6 ** 4 / 2]),
    ("beating-ventricle --coarsening 4", [25, 25, 11, 15], [7.08, 7.08, 24, 1], [None, None]),
    ("merging-balls --frames 5", [48, 28, 28, 5], [1] * 4, [None, None]),
    ("rotating-sheet --frames 5", [36, 36, 28, 5], [1] * 4, [3 * 28 * 20]),
    ("opening-tube --frames 5", [32, 32, 34, 5], [1] * 4, [PI * 81 * 26, None]),
    ("fast-ball --frames 5", [56, 24, 24, 5], [1] * 4, [BALL * 7 ** 3]),
)


class TestPhantomProgram(FolderTestCase):
    def setUp(self):
        super().setUp()
        self.path = str(self.folder / "phantom.nrrd")

    def run_program(self, *arguments):
        return subprocess.run([os.environ["VOXPLEX_PHANTOM"], *arguments], capture_output=True, text=True, check=False)

    def write(self, words):
        """The header's fields, and the voxels by [frame,] z, y, x."""
        name, *options = words.split()
        done = self.run_program(name, self.path, *options)
        self.assertEqual((done.returncode, done.stdout + done.stderr), (0, ""))
        with open(self.path, "rb") as file:
            header, data = file.read().split(b"\n\n", 1)
        fields = dict(line.split(": ", 1) for line in header.decode("ascii").splitlines()[1:])
        return fields, np.frombuffer(data, "u1").reshape([int(n) for n in fields["sizes"].split()][::-1])

    def test_shapes(self):
        for words, sizes, spacings, volumes in PHANTOMS:
            with self.subTest(words):
                fields, voxels = self.write(words)
                self.assertEqual(voxels.shape[::-1], tuple(sizes))
                vectors = [vector.strip("()").split(",") for vector in fields["space directions"].split()]
                np.testing.assert_allclose(np.array(vectors, dtype=float), np.diag(spacings))
                self.assertEqual(set(np.unique(voxels)), set(range(len(volumes) + 1)))
                frames = voxels if voxels.ndim == 4 and not words.startswith("four") else voxels[None]
                for label, volume in enumerate(volumes, 1):
                    for frame in frames if volume else ():
                        found = np.count_nonzero(frame == label) * math.prod(spacings)
                        self.assertAlmostEqual(found / volume, 1.0, delta=0.05 if len(frames) > 1 else 0.02)
                if len(frames) > 1:
                    self.assertTrue((frames[0] != frames[len(frames) // 2]).any())

    def test_beat(self):
        """The blood's volume falls to half the beat and comes back."""
        _, voxels = self.write("beating-ventricle --coarsening 4")
        blood = [np.count_nonzero(frame == 1) for frame in voxels]
        self.assertEqual((blood, min(blood)), (blood[::-1], blood[7]))
        self.assertLess(blood[7], 0.6 * blood[0])

    def test_balls_merge(self):
        _, voxels = self.write("merging-balls --frames 5")
        self.assertEqual([bool(voxels[frame, 13, 13, 23]) for frame in (0, 2)], [False, True])

    def test_tube_opens(self):
        _, voxels = self.write("opening-tube --frames 5")
        self.assertEqual([bool((voxels[frame] == 2).any()) for frame in (0, 2)], [False, True])

    def test_wrong_arguments(self):
        for words, expected in (
                ("", "needed"), ("four-ball", "needed"), ("five-ball FILE", "five-ball"), ("torus FILE.nii", "FILE.nii"),
                ("four-ball FILE third", "third"), ("four-ball FILE --radius", "--radius"),
                ("four-ball FILE --radius 3 4", "--radius"), ("four-ball FILE --radius big", "big"),
                ("four-ball FILE --radius nan", "nan"), ("four-ball FILE --radius -3", "--radius"),
                ("four-ball FILE --frames 5", "--frames"), ("merging-balls FILE --frames 1", "--frames"),
                ("torus FILE --coarsening 9", "--coarsening"), ("ball FILE --radius 3", "--radius"),
                ("merging-balls FILE --frames 2.5", "whole"), ("merging-balls FILE --fraems 3", "--fraems")):
            with self.subTest(words):
                done = self.run_program(*(self.path if word == "FILE" else word for word in words.split()))
                self.assertEqual(done.returncode, 2)
                self.assertIn(expected, done.stderr.split("usage:")[0])
                self.assertIn("usage:", done.stderr)
                self.assertFalse(os.path.exists(self.path))

    def test_a_file_that_cannot_be_written(self):
        path = os.path.join(self.path, "no", "folder.nrrd")
        done = self.run_program("merging-balls", path, "--frames", "2")
        self.assertEqual(done.returncode, 1)
        self.assertIn(path, done.stderr)


if __name__ == "__main__":
    unittest.main()
