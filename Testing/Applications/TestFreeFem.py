#!/usr/bin/python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""FreeFEM reads .mesh and solves a problem of heat conduction with our references."""
import subprocess

import numpy as np

from labelledmesh import LabelledMeshTestCase
from program import main

# Linear elements hold u = x exactly with any conductivity, if it is the same on both sides.
SCRIPT = """\
verbosity = 0;
mesh3 Th("mesh.mesh");
cout.precision(16);
cout << "sizes " << Th.nv << " " << Th.nt << " " << Th.nbe << endl;
cout << "volumes " << int3d(Th, 3)(1.) << " " << int3d(Th, 7)(1.) << endl;
cout << "areas " << int2d(Th, 3)(1.) << " " << int2d(Th, 7)(1.) << " " << int2d(Th, 8)(1.) << endl;
cout << "normals " << int2d(Th, 7)(N.x) << " " << int2d(Th, 7)(N.y) << " " << int2d(Th, 7)(N.z) << endl;
fespace Vh(Th, P1);
Vh u, v;
solve heat(u, v, solver=CG, eps=-1e-24) = int3d(Th)(dx(u) * dx(v) + dy(u) * dy(v) + dz(u) * dz(v))
  + on(3, 7, u = x);
cout << "error " << sqrt(int3d(Th)((u - x)^2)) << endl;
"""


class FreeFem(LabelledMeshTestCase):
    def run_script(self):
        self.write("mesh.mesh")
        (self.folder / "model.edp").write_text(SCRIPT)
        done = subprocess.run(["FreeFem++", "-nw", "-ne", "model.edp"], cwd=self.folder, capture_output=True, text=True,
                              timeout=300)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        lines = (line.split() for line in done.stdout.split("\n"))
        return {words[0]: np.array(words[1:], dtype=float) for words in lines
                if words and words[0] in ("sizes", "volumes", "areas", "normals", "error")}

    def test_mesh_and_solution(self):
        found = self.run_script()
        np.testing.assert_array_equal(found["sizes"], [len(self.points), len(self.cells), len(self.triangles)])
        corners = {name: self.points[cells] for name, cells in self.cells_by_name().items()}
        volumes = [np.linalg.det(corners[name][:, 1:] - corners[name][:, :1]).sum() / 6.0
                   for name in ("label_3", "label_7")]
        np.testing.assert_allclose(found["volumes"], volumes, rtol=1e-10)
        numbers = self.pair_numbers()
        self.assertEqual(sorted(numbers.values()), [3, 7, 8])
        areas = {}
        for pair, number in numbers.items():
            a, b, c = (self.points[self.triangles_by_name()[self.name_of_pair(pair)][:, i]] for i in range(3))
            areas[number] = np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2.0
        np.testing.assert_allclose(found["areas"], [areas[number] for number in (3, 7, 8)], rtol=1e-10)
        np.testing.assert_allclose(found["normals"], self.area_vector("label_7__background"), rtol=1e-8)
        self.assertLess(found["error"][0], 1e-6)


if __name__ == "__main__":
    main()
