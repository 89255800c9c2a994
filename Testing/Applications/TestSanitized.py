#!/usr/bin/python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Each verb of the program once, built with sanitizers, which find nothing. Other tests look at what it does."""
import numpy as np

import images
from program import ProgramTestCase, main


class Verbs(ProgramTestCase):
    def run_program(self, *arguments):
        done = self.call(*arguments)
        self.assertEqual((done.returncode, "Sanitizer" in done.stderr or "runtime error" in done.stderr), (0, False), done.stderr)

    def test_space(self):
        labels = images.two_labels(14, 5.0)
        labels[7, 7, 4] = 0
        labels[7, 7, 12] = 3
        images.write_nrrd(self.folder / "i.nrrd", labels)
        repairs = ("--fill-holes", 9, "--remove-spikes", "--min-thickness", "7=3", "--shell", "3=2", "--check-image")
        self.run_program("i.nrrd", "m.vtu", "--delta", 2, "--plc", "i.vtp", "--stats", "s.json", "--hausdorff", *repairs)
        self.run_program("i.nrrd", "x.vtu", "--delta", 2, "--exact-components", "--grading", "lfs", "--threads", 4)
        self.run_program("image", "i.nrrd", "j.nrrd", *repairs)
        self.run_program("measure", "m.vtu", "j.nrrd", "--hausdorff")
        for name in ("y.msh", "y.mesh", "y.mfem", "y.feb", "y.inp", "y.xdmf", "y.vtk"):
            self.run_program("convert", "m.vtu", name, "--interfaces", "i.vtp", "--plc", "y.stl")
        images.write_nrrd(self.folder / "grey.nrrd", labels.astype(np.float32))
        self.run_program("grey.nrrd", "g.vtu", "--isovalue", 2.5, "--delta", 2)

    def test_space_time(self):
        images.write_space_time_nrrd(self.folder / "i.nrrd", images.moving_balls(3, 10, 3.0))
        self.run_program("i.nrrd", "m.vtu", "--delta", 3, "--plc", "i.vtu", "--time-scale", 4, "--time-planes", 1, "--slabs", "l_", "--slices", "s_", "--quality")
        self.run_program("convert", "m.vtu", "y.mfem", "--interfaces", "i.vtu", "--slices", "t_", "--slice-count", 3)


if __name__ == "__main__":
    main()
