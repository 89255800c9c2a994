#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""find_package(Voxplex): versions, components, and messages where it fails.

VOXPLEX_TREES, with | between them: the folder of the package in the build tree, and the prefix of an install
tree. VOXPLEX_CMAKE, VOXPLEX_CMAKE_ARGUMENTS: how to configure a project.
"""

import os
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

PROJECT = Path(__file__).resolve().parent / "FindPackage"
HAVE_IO = os.environ["VOXPLEX_HAVE_IO"] == "1"
HAVE_ITK = os.environ["VOXPLEX_HAVE_ITK"] == "1"
ITK = ["Voxplex::ITK"] if HAVE_ITK else []
VERSION = os.environ["VOXPLEX_VERSION"]
TREES = os.environ["VOXPLEX_TREES"].split("|")
MAJOR, MINOR, _ = map(int, VERSION.split("."))


class FindPackage(unittest.TestCase):
    def configure(self, tree, *arguments):
        is_package_folder = (Path(tree) / "voxplex-config.cmake").exists()
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run(
                [os.environ["VOXPLEX_CMAKE"], "-S", PROJECT, "-B", folder,
                 f"-D{'Voxplex_DIR' if is_package_folder else 'CMAKE_PREFIX_PATH'}={tree}",
                 *os.environ["VOXPLEX_CMAKE_ARGUMENTS"].split("|"), *arguments],
                capture_output=True, text=True, timeout=300, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        found = re.search(r"FOUND (\S+) (\S*) IN (.*)", done.stdout)
        because = re.search(r"BECAUSE (.*)", done.stdout)
        targets = re.findall(r"TARGET (\S+)", done.stdout)
        return found.group(1) in ("1", "TRUE", "ON"), targets, because.group(1), found.group(3)

    def test_found(self):
        for tree in TREES:
            for version in ("", f"{MAJOR}.{MINOR}", VERSION):
                found, targets, because, folder = self.configure(tree, f"-DVERSION={version}")
                self.assertTrue(found, because)
                self.assertEqual(targets, ["VTK::Voxplex"] + (["VTK::VoxplexIO"] if HAVE_IO else []) + ITK)
                self.assertTrue(folder.startswith(tree), folder)

    def test_components(self):
        for tree in TREES:
            found, targets, because, _ = self.configure(tree, "-DCOMPONENTS=COMPONENTS;IO")
            self.assertEqual(found, HAVE_IO)
            if not HAVE_IO:
                self.assertIn("without the component IO", because)
            self.assertTrue(self.configure(tree, "-DCOMPONENTS=OPTIONAL_COMPONENTS;IO;Nonsense")[0])
            found, targets, because, _ = self.configure(tree, "-DCOMPONENTS=COMPONENTS;Nonsense")
            self.assertFalse(found)
            self.assertEqual(targets, [])
            self.assertIn("has no component Nonsense", because)

    def test_itk(self):
        """The component ITK alone does without VTK."""
        for tree in TREES:
            without_vtk = "-DCMAKE_DISABLE_FIND_PACKAGE_VTK=ON"
            found, targets, because, _ = self.configure(tree, "-DCOMPONENTS=COMPONENTS;ITK", without_vtk)
            self.assertEqual((found, targets), (HAVE_ITK, ITK))
            if not HAVE_ITK:
                self.assertIn("without the component ITK", because)
            found, targets, because, _ = self.configure(tree, "-DCOMPONENTS=OPTIONAL_COMPONENTS;ITK")
            self.assertTrue(found, because)
            self.assertIn("VTK::Voxplex", targets)
            self.assertFalse(self.configure(tree, "-DCOMPONENTS=COMPONENTS;ITK;IO", without_vtk)[0])

    def test_other_versions(self):
        for tree in TREES:
            for version in (f"{MAJOR}.{MINOR + 1}", f"{MAJOR + 1}.0", f"{MAJOR}.{MINOR}.99", f"{MAJOR}.{MINOR - 1}"):
                self.assertFalse(self.configure(tree, f"-DVERSION={version}")[0], version)

    def test_without_vtk(self):
        for tree in TREES:
            found, targets, because, _ = self.configure(tree, "-DCMAKE_DISABLE_FIND_PACKAGE_VTK=ON")
            self.assertFalse(found)
            self.assertEqual(targets, [])
            self.assertRegex(because, r"^Voxplex needs VTK \d+\.\d+ with CommonCore, .* Set VTK_DIR")

    def test_another_vtk(self):
        """A VTK of another minor version is refused, with the reason."""
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "vtk-config.cmake").write_text(
                "set(VTK_FOUND 1)\nset(VTK_VERSION 9.77.0)\nset(VTK_MAJOR_VERSION 9)\nset(VTK_MINOR_VERSION 77)\n")
            for tree in TREES:
                found, _, because, _ = self.configure(tree, f"-DVTK_DIR={folder}")
                self.assertFalse(found)
                self.assertRegex(because, r"^Voxplex was built with VTK \S+, but VTK 9.77.0 was found in " + folder)


if __name__ == "__main__":
    unittest.main()
