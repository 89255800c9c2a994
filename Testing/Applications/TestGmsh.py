#!/usr/bin/python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Gmsh itself, as a library and as a program, reads .msh and .mesh; compared with .vtu and .vtp."""
import subprocess

import gmsh
import numpy as np

from labelledmesh import LabelledMeshTestCase
from program import main

TRIANGLE, TETRAHEDRON = 2, 4


class Gmsh(LabelledMeshTestCase):
    def open(self, name):
        path = self.write(name)
        gmsh.initialize()
        self.addCleanup(gmsh.finalize)
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.logger.start()
        gmsh.open(path)
        lines = gmsh.logger.get()
        gmsh.logger.stop()
        self.assertEqual([line for line in lines if not line.startswith("Info")], [])

    def nodes(self):
        tags, coordinates, _ = gmsh.model.mesh.getNodes()
        order = np.argsort(tags)
        np.testing.assert_array_equal(np.sort(tags), np.arange(1, len(tags) + 1))
        return coordinates.reshape(-1, 3)[order]

    def elements(self, dimension, entity):
        types, tags, nodes = gmsh.model.mesh.getElements(dimension, entity)
        kind = {2: TRIANGLE, 3: TETRAHEDRON}[dimension]
        self.assertEqual(list(types), [kind])
        return tags[0], nodes[0].reshape(-1, dimension + 1).astype(int) - 1

    def test_physical_groups(self):
        self.open("mesh.msh")
        np.testing.assert_array_equal(self.nodes(), self.points)
        found = {}
        for dimension, tag in gmsh.model.getPhysicalGroups():
            entities = gmsh.model.getEntitiesForPhysicalGroup(dimension, tag)
            self.assertEqual(list(entities), [tag])
            found[gmsh.model.getPhysicalName(dimension, tag)] = self.elements(dimension, tag)[1]
        self.assert_same_cells(found, {**self.cells_by_name(), **self.triangles_by_name()})

    def test_elements_are_numbered_as_cells(self):
        self.open("mesh.msh")
        for label in self.label_names:
            np.testing.assert_array_equal(self.elements(3, label)[0], np.flatnonzero(self.labels == label) + 1)

    def test_boundaries_of_volumes(self):
        self.open("mesh.msh")
        for label in self.label_names:
            signed = {number if pair[0] == label else -number
                      for pair, number in self.pair_numbers().items() if label in pair}
            boundary = gmsh.model.getBoundary([(3, label)], combined=False, oriented=True)
            self.assertEqual({tag for dimension, tag in boundary}, signed)

    def test_jacobians_are_positive(self):
        self.open("mesh.msh")
        for label in self.label_names:
            _, determinants, _ = gmsh.model.mesh.getJacobians(TETRAHEDRON, [0.25, 0.25, 0.25], label)
            corners = self.points[self.cells[self.labels == label]]
            np.testing.assert_allclose(determinants, np.linalg.det(corners[:, 1:] - corners[:, :1]), rtol=1e-9)
            self.assertGreater(np.min(determinants), 0.0)

    def test_medit(self):
        self.open("mesh.mesh")
        np.testing.assert_array_equal(self.nodes(), self.points)
        for label, name in self.label_names.items():
            np.testing.assert_array_equal(self.elements(3, label)[1], self.cells_by_name()[name])
        for pair, number in self.pair_numbers().items():
            expected = self.triangles_by_name()[self.name_of_pair(pair)]
            np.testing.assert_array_equal(self.elements(2, number)[1], expected)

    def test_check(self):
        for name in ("mesh.msh", "mesh.mesh"):
            self.write(name)
            done = subprocess.run(["gmsh", "-check", name], cwd=self.folder, capture_output=True, text=True,
                                  timeout=120)
            self.assertEqual(done.returncode, 0)
            self.assertRegex(done.stdout, "Done checking mesh coherence")
            self.assertNotRegex(done.stdout + done.stderr, "Error|Warning")


if __name__ == "__main__":
    main()
