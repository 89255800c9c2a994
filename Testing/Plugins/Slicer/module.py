# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Runs the CLI module as an application does. The environment says where it is: VOXPLEX_SLICER_CLI. The scripted module can
be imported."""
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from xml.etree import ElementTree

import images  # noqa: F401 (of Testing/Support, for the tests)

EXECUTABLE = os.environ["VOXPLEX_SLICER_CLI"]
MODULE = Path(__file__).resolve().parents[3] / "Plugins" / "Slicer" / "VoxplexMesher"
sys.path.insert(0, str(MODULE))


def descriptions():
    """What the CLI module says of its parameters, by their names."""
    xml = subprocess.run([EXECUTABLE, "--xml"], capture_output=True, check=True).stdout
    return {p.findtext("name"): p for group in ElementTree.fromstring(xml).findall("parameters")
            for p in group if p.find("name") is not None}


class ModuleTestCase(unittest.TestCase):
    """Each test has an empty folder of its own."""

    maxDiff = None

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="voxplex-slicer-")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def call(self, *arguments, timeout=300):
        return subprocess.run([EXECUTABLE, *map(str, arguments)], cwd=self.folder, text=True, stdin=subprocess.DEVNULL,
                              capture_output=True, timeout=timeout)

    def run_module(self, *arguments):
        done = self.call(*arguments)
        told = re.sub("[^\n]*warning: The mesh [^\n]* of the volume of [^\n]*\n", "", done.stderr)  # as of any coarse mesh
        self.assertEqual((done.returncode, told), (0, ""), done.stdout)
        return done.stdout

    def contents(self):
        """Every file, hidden ones too."""
        return {path.name: path.read_bytes() for path in self.folder.rglob("*") if path.is_file()}

    def assert_refused(self, status, pattern, *arguments):
        """A call that must fail with a short message and leave the folder as it was."""
        before = self.contents()
        done = self.call(*arguments)
        self.assertEqual(done.returncode, status, done.stdout + done.stderr)
        self.assertRegex(done.stderr, "^voxplex: ")
        self.assertRegex(done.stderr, re.compile(pattern, re.IGNORECASE))
        self.assertLessEqual(len(done.stderr.strip().split("\n")), 1, done.stderr)
        self.assertNotRegex(done.stderr, r"0x[0-9a-f]{4}|\.(cxx|hxx|cpp)\b|itk::|vtk[A-Z]|ERROR:")
        self.assertEqual(self.contents(), before)
        return done


def parse_parameter_file(path):
    """What the module returns: lines of the form name = value."""
    return dict(re.match("([A-Za-z]+) = (.*)$", line).groups() for line in path.read_text().splitlines())
