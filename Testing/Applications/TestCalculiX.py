#!/usr/bin/python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""CalculiX reads .inp and solves a problem of linear elasticity with our sets and surfaces."""
import re
import subprocess

import numpy as np

import images
import meshfiles
from labelledmesh import LabelledMeshTestCase
from program import ProgramTestCase, main

PRESSURE = 0.5

MODEL = """\
*INCLUDE, INPUT=mesh.inp
*MATERIAL, NAME=soft
*ELASTIC
1000., 0.3
*MATERIAL, NAME=stiff
*ELASTIC
5000., 0.3
*SOLID SECTION, ELSET=label_3, MATERIAL=soft
*SOLID SECTION, ELSET=label_7, MATERIAL=stiff
*NSET, NSET=fixed
%(fixed)s
*STEP
*STATIC
*BOUNDARY
fixed, 1, 3
*DSLOAD
%(surface)s, P, %(pressure)r
*NODE PRINT, NSET=fixed, TOTALS=ONLY
RF
%(displacements)s
*EL PRINT, ELSET=label_3, TOTALS=ONLY
EVOL
*EL PRINT, ELSET=label_7, TOTALS=ONLY
EVOL
*END STEP
"""


class CalculiX(LabelledMeshTestCase):
    def setUp(self):
        super().setUp()
        self.write("mesh.inp")
        # The outside of one label is fixed, without its rim: a load that is applied there is no reaction.
        surfaces = self.triangles_by_name()
        rim = surfaces["label_7__background"]
        self.fixed = np.setdiff1d(surfaces["label_3__background"], rim)

    def solve(self, surface):
        (self.folder / "model.inp").write_text(MODEL % {
            "fixed": "".join("%d,\n" % (node + 1) for node in self.fixed).rstrip(), "surface": surface,
            "pressure": PRESSURE,
            "displacements": "\n".join("*NODE PRINT, NSET=%s\nU" % name for name in self.pair_names().values())})
        done = subprocess.run(["ccx", "model"], cwd=self.folder, capture_output=True, text=True, timeout=300)
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertNotRegex(done.stdout, r"\*(ERROR|WARNING)")
        return (self.folder / "model.dat").read_text()

    def table(self, text, heading):
        """The rows of numbers below a heading."""
        at = text.index(heading)
        rows = []
        for line in text[at:].split("\n")[1:]:
            if rows and not line.strip():
                break
            if line.strip():
                rows.append([float(word) for word in line.split()])
        self.assertTrue(rows)
        return np.array(rows)

    def check(self, surface):
        text = self.solve(surface)
        for name, triangles in self.triangles_by_name().items():
            displacements = self.table(text, "displacements (vx,vy,vz) for set " + name.upper())
            np.testing.assert_array_equal(displacements[:, 0], np.unique(triangles) + 1)
            self.assertTrue(np.isfinite(displacements).all())
            size = np.abs(displacements[:, 1:]).max()
            self.assertTrue(1e-6 < size < 1.0, size)
        # A pressure pushes against the normal of the surface; the reaction balances it.
        reaction = self.table(text, "total force (fx,fy,fz) for set FIXED")[0]
        expected = PRESSURE * self.area_vector(surface)
        self.assertGreater(np.linalg.norm(expected), 50.0)
        np.testing.assert_allclose(reaction, expected, atol=2e-6 * np.linalg.norm(expected))
        for label, name in self.label_names.items():
            corners = self.points[self.cells[self.labels == label]]
            volume = np.linalg.det(corners[:, 1:] - corners[:, :1]).sum() / 6.0
            found, = re.findall(r"total volume for set %s .*\n\n\s*(\S+)" % name.upper(), text)
            self.assertAlmostEqual(float(found), volume, delta=1e-5 * volume)

    def test_pressure_on_the_outside(self):
        self.check("label_7__background")

    def test_pressure_on_the_interface(self):
        """It acts on the elements with the larger label."""
        self.check("label_7__label_3")


WALL = """\
*NODE, NSET=all
%(nodes)s
*ELEMENT, TYPE=C3D4, ELSET=wall
%(elements)s
*MATERIAL, NAME=one
*ELASTIC
1., 0.3
*DENSITY
1e-6
*SOLID SECTION, ELSET=wall, MATERIAL=one
*NSET, NSET=bottom
%(bottom)s
*STEP
*STATIC
*BOUNDARY
bottom, 1, 3
*DLOAD
wall, GRAV, 1., 0., 0., -1.
*NODE PRINT, NSET=all
U
*END STEP
"""


class ThinWall(ProgramTestCase):
    """A dome of one voxel, as one body. What hangs on by a vertex or not at all would fall without end."""

    def displacement(self, array, *arguments):
        """The largest one under its own weight."""
        self.call("--input", images.write_nrrd(self.folder / "wall.nrrd", array), "--output", "wall.vtu", *arguments)
        mesh = meshfiles.read_tetrahedra(self.folder / "wall.vtu")
        z = mesh.points[:, 2]

        def rows(numbers, values):
            return "\n".join(", ".join([str(n), *map(repr, row)]) for n, row in zip(numbers, values))

        (self.folder / "wall.inp").write_text(WALL % {
            "nodes": rows(range(1, len(z) + 1), mesh.points.astype(float).tolist()),
            "elements": rows(range(1, len(mesh.cells) + 1), (mesh.cells + 1).tolist()),
            "bottom": ",\n".join(map(str, np.nonzero(z < z.min() + 2)[0] + 1))})
        done = subprocess.run(["ccx", "wall"], cwd=self.folder, capture_output=True, text=True, timeout=300)
        self.assertEqual(done.returncode, 0, done.stdout)
        text = (self.folder / "wall.dat").read_text()
        rows = [line.split() for line in text[text.index("displacements"):].split("\n")[2:] if line.strip()]
        return float(np.abs(np.array(rows, dtype=float)[:, 1:]).max())

    def test_is_one_body(self):
        k, j, i = np.mgrid[:36, :32, :32]
        radius = np.sqrt((i - 15.5) ** 2 + (j - 15.5) ** 2 + (k - 16) ** 2)
        dome = ((radius < 13) & (radius >= 12) & (k >= 16)).astype(np.uint8)
        found = {}
        for delta in (1, 1.5, 2, 3):
            for flags in ((), ("--exact-components",)):
                found[delta, flags] = self.displacement(dome, "--delta", delta, "--threads", 1, *flags)
        self.assertGreater(min(found.values()), 0)
        self.assertLess(max(found.values()), 2 * min(found.values()), found)


if __name__ == "__main__":
    main()
