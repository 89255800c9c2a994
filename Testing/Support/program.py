# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Calls the program as a user does. The environment variable VOXPLEX_PROGRAM says where it is."""
import json
import os
import re
import subprocess
import sys
import unittest

from folders import FolderTestCase

PROGRAM = os.environ.get("VOXPLEX_PROGRAM", "voxplex")
VERBS = ("mesh", "measure", "convert", "image")
OUTPUTS = ("--output", "--plc", "--stats", "--slices", "--slabs", "--quality", "--hausdorff")


def without_topology(text):
    """Coarse meshes of thin parts and gaps have another topology than the image, or other volumes, and the program warns
    of it. TestOptions and TestLabelNames look at these warnings."""
    return re.sub("voxplex: warning: [^\n]*(?:no common faces connect|one piece with others|do not touch there|"
                  "Volumes are off by|of all labels together)[^\n]*\n", "", text)


class ProgramTestCase(FolderTestCase):
    """The program runs in the test's folder."""

    def call(self, *arguments, timeout=300, **options):
        return subprocess.run([PROGRAM, *map(str, arguments)], cwd=self.folder, text=True, stdin=subprocess.DEVNULL,
                              capture_output=True, timeout=timeout, **options)

    def mesh(self, *arguments, warning=None, **options):
        """A call that must succeed quietly: one paragraph on standard output, nothing on the other but a warning."""
        done = self.call(*arguments, **options)
        self.assertEqual(done.returncode, 0, done.stderr)
        told = without_topology(done.stderr)
        if warning:
            self.assertRegex(told, "^voxplex: warning: [^\n]*" + warning + "[^\n]*\n$")
        else:
            self.assertEqual(told, "")
        self.assertEqual(len(done.stdout.strip().split("\n")), 1, done.stdout)
        self.assertRegex(done.stdout, "tetrahedra|pentatopes")
        self.assertEqual(self.hidden_files(), [])
        return done

    def statistics(self, *arguments, **options):
        self.mesh(*arguments, "--stats", "statistics.json", **options)
        return json.loads((self.folder / "statistics.json").read_text())

    def assert_refused(self, status, pattern, *arguments, **options):
        """A call that must fail with one short message and leave the folder as it was. If it names no output, one is added."""
        before = self.contents()
        if arguments and arguments[0] not in VERBS and not any(str(one).startswith(OUTPUTS) for one in arguments):
            arguments = ("--output", "refused.vtu", *arguments)
        done = self.call(*arguments, **options)
        self.assertEqual(done.returncode, status, done.stderr)
        self.assertEqual(done.stdout, "")
        self.assertRegex(done.stderr, re.compile(pattern, re.IGNORECASE))
        self.assertRegex(done.stderr, "^voxplex: ")
        # One line for people: no dump of an exception, no address, no source file.
        self.assertLessEqual(len(done.stderr.strip().split("\n")), 2 if status == 2 else 1, done.stderr)
        self.assertNotRegex(done.stderr, r"0x[0-9a-f]{4}|\.(cxx|hxx|cpp)\b|itk::|vtk[A-Z]|ERROR:")
        if status == 2:
            self.assertRegex(done.stderr, "see voxplex --help\n$")
        self.assertEqual(self.contents(), before)
        return done

    def contents(self):
        return {path.relative_to(self.folder): path.read_bytes() for path in self.folder.rglob("*") if path.is_file()}

    def hidden_files(self):
        return [path.name for path in self.folder.iterdir() if path.name.startswith(".")]


def main():
    """unittest.main() that exits with 77, which ctest takes for 'skipped', if no test could run."""
    program = unittest.main(module="__main__", exit=False, verbosity=2)
    result = program.result
    if result.wasSuccessful() and result.testsRun and len(result.skipped) == result.testsRun:
        sys.exit(77)
    sys.exit(not result.wasSuccessful())
