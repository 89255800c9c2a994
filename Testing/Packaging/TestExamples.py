#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""The examples in C++, as built against an installed Voxplex. VOXPLEX_EXAMPLES is their build folder."""

import os
import subprocess
import unittest
from pathlib import Path

import numpy

import images
from folders import FolderTestCase
from meshfiles import read_tetrahedra

FOLDER = Path(os.environ["VOXPLEX_EXAMPLES"])

# 32 x 28 x 24 voxels of 1 x 1.5 x 2 mm: a cube of 10 mm and a smaller one, both bright, in a grey image.
SPACING = numpy.array([1.0, 1.5, 2.0])
LARGE = ((6, 17), (6, 13), (5, 10))  # first and last index along i, j, k
SMALL = ((24, 29), (18, 22), (15, 18))


def centre(box):
    return numpy.array([0.5 * (first + last) for first, last in box])


def grey_image():
    """Indexed [k, j, i]."""
    image = numpy.full((24, 28, 32), -100, dtype=numpy.int16)
    for box in (LARGE, SMALL):
        (i0, i1), (j0, j1), (k0, k1) = box
        image[k0:k1 + 1, j0:j1 + 1, i0:i1 + 1] = 900
    return image


def write_image(path, array, direction, origin):
    images.write_metaimage(path, array, images.Geometry(origin, SPACING, direction))


def centroids(mesh):
    """Of each label, weighted by volume; and the smallest volume of a cell."""
    volumes, result = mesh.volumes(), {}
    for label in numpy.unique(mesh.labels):
        chosen = mesh.labels == label
        result[int(label)] = numpy.average(mesh.points[mesh.cells[chosen]].mean(axis=1), axis=0, weights=volumes[chosen])
    return result, volumes.min()


class Examples(FolderTestCase):
    def call(self, name, *arguments):
        return subprocess.run([str(FOLDER / name), *map(str, arguments)], capture_output=True, text=True, timeout=300,
                              check=False)

    def test_ball(self):
        done = self.call("MeshBall", self.folder / "ball.vtu")
        self.assertEqual(done.returncode, 0, done.stderr)
        mesh = read_tetrahedra(self.folder / "ball.vtu")
        self.assertRegex(done.stdout, f"^{len(mesh.cells)} tetrahedra")
        self.assertEqual(set(mesh.labels), {1, 2})
        centres, smallest = centroids(mesh)
        numpy.testing.assert_allclose(centres[2], (19.5, 19.5, 19.0), atol=0.3)
        self.assertGreater(smallest, 0.0)

    DIRECTIONS = {
        "identity": numpy.eye(3),
        "axes exchanged": numpy.array([[0.0, 0, 1], [1, 0, 0], [0, 1, 0]]),
        "oblique": numpy.array([[0.8, -0.6, 0], [0.48, 0.64, -0.6], [0.36, 0.48, 0.8]]),
        "left-handed": numpy.array([[0.8, 0.6, 0], [-0.6, 0.8, 0], [0, 0, -1.0]]),
    }
    ORIGIN = numpy.array([-40.0, 25.0, 310.0])

    def check(self, path, direction, expected):
        centres, smallest = centroids(read_tetrahedra(path))
        self.assertEqual(set(centres), set(expected))
        self.assertGreater(smallest, 0.0)
        for label, box in expected.items():
            numpy.testing.assert_allclose(
                centres[label], self.ORIGIN + direction @ (SPACING * centre(box)), atol=0.4)

    @unittest.skipUnless((FOLDER / "MeshITKImage").exists(), "Voxplex was built without ITK")
    def test_itk_pipeline(self):
        for name, direction in self.DIRECTIONS.items():
            with self.subTest(name):
                write_image(self.folder / "ct.mha", grey_image(), direction, self.ORIGIN)
                done = self.call("MeshITKImage", self.folder / "ct.mha", 300, 2.0, self.folder / "bone.vtk")
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertRegex(done.stdout, "^2 components, [1-9][0-9]+ tetrahedra\n$")
                self.check(self.folder / "bone.vtk", direction, {1: LARGE, 2: SMALL})

    @unittest.skipUnless((FOLDER / "MeshITKImage").exists(), "Voxplex was built without ITK")
    def test_itk_pipeline_fails_with_a_message(self):
        done = self.call("MeshITKImage", self.folder / "none.mha", 300, 2.0, self.folder / "bone.vtk")
        self.assertEqual(done.returncode, 1)
        self.assertIn("none.mha", done.stderr)
        self.assertEqual(list(self.folder.iterdir()), [])

    @unittest.skipUnless((FOLDER / "MeshFile").exists(), "Voxplex was built without IO")
    def test_file(self):
        direction = self.DIRECTIONS["oblique"]
        labels = numpy.where(grey_image() > 0, 4, 0).astype(numpy.uint8)
        write_image(self.folder / "labels.mha", labels, direction, self.ORIGIN)
        done = self.call("MeshFile", self.folder / "labels.mha", 2.0, self.folder / "mesh.vtu")
        self.assertEqual(done.returncode, 0, done.stderr)
        mesh = read_tetrahedra(self.folder / "mesh.vtu")
        self.assertEqual(set(mesh.labels), {4})
        self.assertEqual(done.stdout, f"{len(mesh.cells)} tetrahedra\n")
        missing = self.call("MeshFile", self.folder / "none.mha", 2.0, self.folder / "mesh2.vtu")
        self.assertEqual(missing.returncode, 1)
        self.assertFalse((self.folder / "mesh2.vtu").exists())


if __name__ == "__main__":
    unittest.main()
