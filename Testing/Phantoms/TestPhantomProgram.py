# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""voxplexPhantom as a script calls it: files are read back, wrong arguments are refused."""

import gzip
import math
import os
import subprocess
import tempfile
import unittest

PROGRAM = os.environ["VOXPLEX_PHANTOM"]


def run(*arguments):
    return subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, check=False)


def read_nrrd(path):
    """The header's fields, the sizes of the axes, their spacings, and the voxels as bytes."""
    with open(path, "rb") as file:
        header, data = file.read().split(b"\n\n", 1)
    lines = header.decode("ascii").splitlines()
    assert lines[0].startswith("NRRD"), lines[0]
    fields = dict(line.split(": ", 1) for line in lines[1:] if ": " in line)
    sizes = [int(n) for n in fields["sizes"].split()]
    if "spacings" in fields:
        spacings = [float(s) for s in fields["spacings"].split()]
    else:
        vectors = fields["space directions"].split()
        spacings = [math.hypot(*map(float, v.strip("()").split(","))) for v in vectors]
    voxels = gzip.decompress(data) if fields["encoding"] in ("gzip", "gz") else data
    return fields, sizes, spacings, voxels


class TestPhantomProgram(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = os.path.join(folder.name, "phantom.nrrd")

    def write(self, *arguments, dimension=4):
        result = run(arguments[0], self.path, *arguments[1:])
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(result.stdout + result.stderr, "")
        fields, sizes, spacings, voxels = read_nrrd(self.path)
        self.assertEqual(fields["dimension"], str(dimension))
        self.assertIn(fields["type"], ("unsigned char", "uchar", "uint8", "uint8_t"))
        self.assertEqual(len(voxels), math.prod(sizes))
        return sizes, spacings, voxels

    def test_shapes_of_space(self):
        ball = lambda radius: 4.0 / 3.0 * math.pi * radius**3
        for name, coarsening, expected_sizes, spacing, volumes in [
            ("ball", 8, [52, 52, 52], 0.32, [ball(7.5)]),
            ("embedded-balls", 4, [158, 104, 104], 0.16, [ball(7.5) - ball(3.0), ball(3.0), ball(0.75)]),
            ("torus", 2, [73, 73, 33], 0.5, [2.0 * math.pi**2 * 10.5 * 7.0**2]),
        ]:
            with self.subTest(name):
                sizes, spacings, voxels = self.write(name, "--coarsening", str(coarsening), dimension=3)
                self.assertEqual(sizes, expected_sizes)
                for got in spacings:
                    self.assertAlmostEqual(got, spacing)
                self.assertEqual(set(voxels), set(range(len(volumes) + 1)))
                for label, volume in enumerate(volumes, 1):
                    self.assertAlmostEqual(voxels.count(label) * spacing**3 / volume, 1.0, delta=0.02)

    def test_four_ball(self):
        sizes, spacings, voxels = self.write("four-ball", "--radius", "6")
        self.assertEqual(sizes, [20, 20, 20, 20])
        self.assertEqual(spacings, [1.0, 1.0, 1.0, 1.0])
        self.assertEqual(set(voxels), {0, 1})
        volume = math.pi**2 * 6.0**4 / 2.0
        self.assertAlmostEqual(voxels.count(1) / volume, 1.0, delta=0.02)

    def test_beating_ventricle(self):
        sizes, spacings, voxels = self.write("beating-ventricle", "--coarsening", "4")
        self.assertEqual(sizes, [25, 25, 11, 15])
        for got, expected in zip(spacings, [7.08, 7.08, 24.0, 1.0]):
            self.assertAlmostEqual(got, expected)
        self.assertEqual(set(voxels), {0, 1, 2})
        # x varies fastest and time slowest: the blood's volume falls to half the beat and comes back.
        frame = len(voxels) // 15
        blood = [voxels[k * frame : (k + 1) * frame].count(1) for k in range(15)]
        self.assertEqual(blood, blood[::-1])
        self.assertEqual(min(blood), blood[7])
        self.assertLess(blood[7], 0.6 * blood[0])

    def test_merging_balls(self):
        sizes, spacings, voxels = self.write("merging-balls", "--frames", "5")
        self.assertEqual(sizes, [48, 28, 28, 5])
        self.assertEqual(spacings, [1.0, 1.0, 1.0, 1.0])
        self.assertEqual(set(voxels), {0, 1, 2})
        frame = len(voxels) // 5
        row = slice(13 * 48 + 13 * 48 * 28, 14 * 48 + 13 * 48 * 28)
        self.assertEqual(voxels[row][23], 0, "apart in the first frame")
        self.assertNotEqual(voxels[2 * frame : 3 * frame][row][23], 0, "together in the middle")

    def test_shapes_that_keep_their_volumes(self):
        """In each frame: a sheet that turns, a wall whose cross-section stays, a ball that moves."""
        for name, expected_sizes, volume in [
            ("rotating-sheet", [36, 36, 28, 5], 3.0 * 28.0 * 20.0),
            ("opening-tube", [32, 32, 34, 5], math.pi * 81.0 * 26.0),
            ("fast-ball", [56, 24, 24, 5], 4.0 / 3.0 * math.pi * 7.0**3),
        ]:
            with self.subTest(name):
                sizes, spacings, voxels = self.write(name, "--frames", "5")
                self.assertEqual(sizes, expected_sizes)
                self.assertEqual(spacings, [1.0, 1.0, 1.0, 1.0])
                self.assertEqual(set(voxels), {0, 1, 2} if name == "opening-tube" else {0, 1})
                frame = len(voxels) // 5
                frames = [voxels[k * frame : (k + 1) * frame] for k in range(5)]
                for one in frames:
                    self.assertAlmostEqual(one.count(1) / volume, 1.0, delta=0.05)
                self.assertNotEqual(frames[0], frames[2])
                self.assertEqual(frames[0].count(2), 0)

    def test_wrong_arguments(self):
        for arguments, word in [
            ([], "needed"),
            (["four-ball"], "needed"),
            (["five-ball", self.path], "five-ball"),
            (["four-ball", self.path, "third"], "third"),
            (["four-ball", self.path, "--radius"], "--radius"),
            (["four-ball", self.path, "--radius", "big"], "big"),
            (["four-ball", self.path, "--radius", "nan"], "nan"),
            (["four-ball", self.path, "--radius", "-3"], "--radius"),
            (["four-ball", self.path, "--frames", "5"], "--frames"),
            (["merging-balls", self.path, "--frames", "1"], "--frames"),
            (["torus", self.path, "--coarsening", "9"], "--coarsening"),
            (["ball", self.path, "--radius", "3"], "--radius"),
            (["merging-balls", self.path, "--frames", "2.5"], "whole"),
            (["merging-balls", self.path, "--fraems", "3"], "--fraems"),
        ]:
            with self.subTest(arguments=arguments):
                result = run(*arguments)
                self.assertEqual(result.returncode, 2)
                self.assertIn(word, result.stderr.split("usage:")[0])
                self.assertIn("usage:", result.stderr)
                self.assertFalse(os.path.exists(self.path))

    def test_files_that_cannot_be_written(self):
        for path in [os.path.join(self.path, "no", "folder.nrrd"), self.path + ".unknown"]:
            with self.subTest(path=path):
                result = run("merging-balls", path, "--frames", "2")
                self.assertEqual(result.returncode, 1)
                self.assertIn(path, result.stderr)


if __name__ == "__main__":
    unittest.main()
