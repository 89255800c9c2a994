#!/usr/bin/python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""kill -9 at every step of writing several files leaves the old ones, whole new ones, or none. One file in each format:
IO/TestKilledWriter.py.

The steps are those of Testing/KillSwitch. VOXPLEX_KILL_SWITCH is the path of its library.
"""
import json
import os
import signal

import images
from program import ProgramTestCase, main

KILL_SWITCH = os.environ["VOXPLEX_KILL_SWITCH"]


class KilledWriting(ProgramTestCase):
    def kill(self, step, *arguments):
        return self.call("--threads", 1, *arguments,
                         env={**os.environ, "LD_PRELOAD": KILL_SWITCH, "VOXPLEX_KILL_AT": str(step)})

    def remove(self, names):
        for path in self.folder.iterdir():
            if path.name in names or path.name.startswith(".voxplex-"):
                path.unlink()

    def check_file(self, name, new, old):
        path = self.folder / name
        if not path.exists():
            return "none"
        found = path.read_bytes()
        if found == old:
            return "old"
        if name.endswith(".json"):  # has times in it
            self.assertEqual(json.loads(found).keys(), json.loads(new).keys())
        else:
            self.assertTrue(found == new, "half a file: " + name)
        return "new"

    def check(self, names, *arguments, old=b"old", together=()):
        """Every step. old: what is in the way. Files that belong together are never of two runs."""
        done = self.call("--threads", 1, *arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        whole = {name: (self.folder / name).read_bytes() for name in names}
        before = "old" if old else "none"
        outcomes = set()
        step = 0
        while done.returncode == -signal.SIGKILL or step == 0:
            step += 1
            self.remove(names)
            for name in names if old else ():
                (self.folder / name).write_bytes(old)
            done = self.kill(step, *arguments)
            found = {name: self.check_file(name, whole[name], old) for name in names}
            outcomes.update(found.values())
            self.assertFalse({"old", "new"} <= {found[name] for name in together}, found)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(set(found.values()), {"new"})
        self.assertEqual(self.hidden_files(), [])
        self.assertIn(before, outcomes)
        # Opening, writing, closing, and renaming of each file.
        self.assertGreater(step, 4 * len(names))

    def check_mesh(self, output, interfaces=None, companion=None, **options):
        path = images.write_nrrd(self.folder / "i.nrrd", images.two_labels(8, 3.0))
        pair = [output] + ([companion] if companion else [])
        more = ["--plc", interfaces] if interfaces else []
        self.check([*pair, *more[1:]], "--input", path, "--delta", 3, "--no-optimise", "--output", output, *more,
                   together=pair, **options)

    def test_something_in_the_way(self):
        self.check_mesh("m.vtu", "i.vtp")

    def test_nothing_in_the_way(self):
        self.check_mesh("m.mesh", "i.ply", old=None)

    def test_statistics(self):
        path = images.write_nrrd(self.folder / "i.nrrd", images.ball(8, 3.0))
        self.check(["s.json"], "--input", path, "--delta", 3, "--stats", "s.json")

    def test_xdmf(self):
        for name in ("m.xdmf", "m.XDMF"):  # one sorts behind its companion, the other before it
            with self.subTest(name):
                self.check_mesh(name, companion="m.h5")

    def test_slices(self):
        path = images.write_nrrd(self.folder / "i.nrrd", images.moving_balls(2, 8, 2.5))
        self.check(["m.vtu", "s_0.vtu", "s_1.vtu", "s.pvd"], "--input", path, "--delta", 4, "--output", "m.vtu",
                   "--slices", "s_", "--slice-count", 2)


if __name__ == "__main__":
    main()
