# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""The mesh of a phantom by names of labels and pairs, to compare what other programs read with.

It comes from .vtu and .vtp, which VTK's readers read; the names are given by the test.
"""
import numpy as np

import images
import meshfiles
from program import ProgramTestCase


class LabelledMeshTestCase(ProgramTestCase):
    """Writes each mesh beside mesh.vtu and interfaces.vtp, with the same parameters."""

    label_names = {3: "label_3", 7: "label_7"}
    delta = 2.5

    def make_input(self):
        return images.write_nrrd(self.folder / "two.nrrd", images.two_labels(),
                                 images.Geometry((5, -7, 11), (1.0, 1.0, 1.5)))

    def setUp(self):
        super().setUp()
        self.input = self.make_input()
        self.write("mesh.vtu", "--plc", "interfaces.vtp")
        mesh = meshfiles.read_tetrahedra(self.folder / "mesh.vtu")
        surface = meshfiles.read_triangles(self.folder / "interfaces.vtp")
        self.points, self.cells, self.labels = mesh.points, mesh.cells, mesh.labels
        self.triangles, self.pairs = surface.point_ids[surface.cells], surface.labels
        self.assertEqual(set(np.unique(self.labels)), set(self.label_names))

    def write(self, name, *arguments):
        self.mesh("--input", self.input, "--delta", self.delta, "--threads", 1, "--output", name, *arguments)
        return str(self.folder / name)

    def name_of_pair(self, pair):
        return self.label_names[pair[0]] + "__" + self.label_names.get(pair[1], "background")

    def pair_names(self):
        """Name of each pair of labels that meet."""
        return {tuple(pair): self.name_of_pair(tuple(pair)) for pair in np.unique(self.pairs, axis=0).tolist()}

    def pair_numbers(self):
        """As the documentation numbers them."""
        numbers, following = {}, max(self.label_names) + 1
        for pair in sorted(self.pair_names()):
            numbers[pair] = pair[0]
            if pair[1] != 0:
                numbers[pair], following = following, following + 1
        return numbers

    def cells_by_name(self):
        return {name: self.cells[self.labels == label] for label, name in self.label_names.items()}

    def triangles_by_name(self):
        return {name: self.triangles[(self.pairs == pair).all(axis=1)] for pair, name in self.pair_names().items()}

    def area_vector(self, name):
        """The integral of the normal over a surface."""
        a, b, c = (self.points[self.triangles_by_name()[name][:, i]] for i in range(3))
        return np.cross(b - a, c - a).sum(axis=0) / 2.0

    def assert_same_cells(self, found, expected):
        """Both by name; the order of cells and of the vertices in each counts."""
        self.assertEqual(set(found), set(expected))
        for name, cells in expected.items():
            np.testing.assert_array_equal(found[name], cells, name)


def sorted_rows(cells):
    """Cells without their order and that of their vertices."""
    rows = np.sort(np.asarray(cells), axis=1)
    return rows[np.lexsort(rows.T[::-1])]
