#!/usr/bin/python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""DOLFINx, of FEniCS, reads .xdmf with its names and tags; compared with .vtu and .vtp."""
import json

import numpy as np
from dolfinx.cpp.mesh import entities_to_geometry
from dolfinx.io import XDMFFile
from mpi4py import MPI

from labelledmesh import LabelledMeshTestCase, sorted_rows
from program import main


class FEniCS(LabelledMeshTestCase):
    def setUp(self):
        super().setUp()
        with XDMFFile(MPI.COMM_WORLD, self.write("mesh.xdmf"), "r") as file:
            self.mesh = file.read_mesh(name="mesh")
            self.mesh.topology.create_connectivity(2, 3)
            self.tags = {3: file.read_meshtags(self.mesh, name="mesh"), 2: file.read_meshtags(self.mesh, name="facets")}
            self.names = {3: json.loads(file.read_information("CellTags", "/Xdmf/Domain")),
                          2: json.loads(file.read_information("FacetTags", "/Xdmf/Domain"))}

    def original_vertices(self, dimension, tag):
        """DOLFINx renumbers the points."""
        entities = self.tags[dimension].indices[self.tags[dimension].values == tag]
        # What the Python object wraps is called differently from release to release.
        mesh = getattr(self.mesh, "_cpp_object", None) or self.mesh._mesh
        vertices = entities_to_geometry(mesh, dimension, entities, False)
        return np.array(self.mesh.geometry.input_global_indices)[vertices]

    def test_points(self):
        self.assertEqual(len(self.mesh.geometry.x), len(self.points))
        np.testing.assert_array_equal(self.mesh.geometry.x, self.points[self.mesh.geometry.input_global_indices])

    def test_tags(self):
        expected = {3: self.cells_by_name(), 2: self.triangles_by_name()}
        for dimension, names in self.names.items():
            self.assertEqual(set(names), set(expected[dimension]))
            self.assertEqual(set(self.tags[dimension].values), set(names.values()))
            for name, tag in names.items():
                np.testing.assert_array_equal(sorted_rows(self.original_vertices(dimension, tag)),
                                              sorted_rows(expected[dimension][name]), name)


if __name__ == "__main__":
    main()
