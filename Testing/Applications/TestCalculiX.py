#!/usr/bin/python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""CalculiX reads .inp and solves a problem of linear elasticity with our sets and surfaces."""
import re
import subprocess

import numpy as np

from labelledmesh import LabelledMeshTestCase
from program import main

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


if __name__ == "__main__":
    main()
