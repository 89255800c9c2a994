#!/usr/bin/python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Ctrl-C ends the program within a second or two and leaves nothing behind."""
import signal
import subprocess
import time

import images
from program import PROGRAM, ProgramTestCase, main


def listen():
    """Shells start background jobs with SIGINT ignored, which the program would respect."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


class Interruption(ProgramTestCase):
    def setUp(self):
        super().setUp()
        # Minutes of work, so that the signal comes in the midst of it.
        self.input = images.write_nrrd(self.folder / "ball.nrrd", images.ball(64, 28.0))

    def interrupt(self, number, after):
        before = self.contents()
        with subprocess.Popen([PROGRAM, "--input", self.input, "--delta", "0.05", "--force", "--output", "mesh.vtu",
                               "--plc", "surface.vtp", "--stats", "s.json"], cwd=self.folder, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, preexec_fn=listen) as process:
            time.sleep(after)
            self.assertIsNone(process.poll(), "ended before it could be interrupted")
            start = time.monotonic()
            process.send_signal(number)
            out, err = process.communicate(timeout=30)
            elapsed = time.monotonic() - start
        self.assertEqual(process.returncode, 128 + number, err)
        self.assertLess(elapsed, 3.0)
        self.assertEqual(out, "")
        self.assertIn("voxplex: interrupted, no file was written", err)
        self.assertEqual(self.contents(), before)

    def test_soon_after_the_start(self):
        self.interrupt(signal.SIGINT, 0.3)

    def test_while_refining(self):
        self.interrupt(signal.SIGINT, 3.0)

    def test_ignored_signals_stay_ignored(self):
        """Under nohup or in the background of a script, Ctrl-C is meant for others."""
        with subprocess.Popen([PROGRAM, "--input", self.input, "--delta", "2", "--output", "mesh.vtu"],
                              cwd=self.folder, stdout=subprocess.DEVNULL,
                              preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_IGN)) as process:
            time.sleep(0.2)
            process.send_signal(signal.SIGINT)
        self.assertEqual(process.returncode, 0)
        self.assertTrue((self.folder / "mesh.vtu").exists())

    def test_termination(self):
        self.interrupt(signal.SIGTERM, 1.5)


if __name__ == "__main__":
    main()
