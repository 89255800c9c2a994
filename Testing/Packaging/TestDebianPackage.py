#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""The Debian package: its control fields, scripts and files. VOXPLEX_PACKAGE_FOLDER holds it."""

import os
import re
import shutil
import subprocess
import unittest
from pathlib import Path

PACKAGE = next(Path(os.environ["VOXPLEX_PACKAGE_FOLDER"]).glob("*.deb"))
VERSION = os.environ["VOXPLEX_VERSION"]
HAVE_PYTHON = os.environ["VOXPLEX_HAVE_PYTHON"] == "1"


def output(*command):
    return subprocess.run([str(part) for part in command], capture_output=True, text=True, check=True).stdout


class Package(unittest.TestCase):
    maxDiff = None

    def field(self, name):
        return output("dpkg-deb", "-f", PACKAGE, name).strip()

    def test_fields(self):
        architecture = output("dpkg", "--print-architecture").strip()
        self.assertEqual(PACKAGE.name, f"voxplex_{VERSION}_{architecture}.deb")
        self.assertEqual(self.field("Package"), "voxplex")
        self.assertEqual(self.field("Version"), VERSION)
        self.assertEqual(self.field("Section"), "science")
        self.assertRegex(self.field("Maintainer"), r"^[^<>]+ <\S+@\S+>$")
        self.assertRegex(self.field("Description"), r"(?s)^label images to .*\n .*tetrahedra")
        self.assertGreater(int(self.field("Installed-Size")), 1000)

    def test_dependencies(self):
        """Libraries of the Debian that this is, functions in Python without VTK, and no package of a developer."""
        depends = {re.split(r"[ (]", entry.strip())[0] for entry in self.field("Depends").split(",")}
        expected = ["libc6", r"libstdc\+\+6", r"libvtk9\.\d", "libgmp10"]
        if HAVE_PYTHON:
            expected += ["python3", "python3-numpy"]
            self.assertEqual(self.field("Recommends"), "python3-vtk9")
        if os.environ["VOXPLEX_HAVE_IO"] == "1":
            expected += [r"libgdcm\d\.\d(t64)?", r"libtiff\d"]
        missing = [name for name in expected if not any(re.fullmatch(name, package) for package in depends)]
        self.assertEqual(missing, [], depends)
        self.assertFalse([name for name in depends if name.endswith("-dev")])
        self.assertIn("libvtk9-dev", self.field("Suggests"))

    def test_files(self):
        listing = output("dpkg-deb", "-c", PACKAGE).splitlines()
        paths = {line.split()[5].lstrip("."): line for line in listing}
        for path in ("/usr/share/doc/voxplex/copyright", "/usr/share/doc/voxplex/changelog.gz"):
            self.assertIn(path, paths)
        panel = [path for path in paths if "/qt-scripted-modules/" in path]
        self.assertTrue(not panel or any(path.endswith("/Parameters.json") for path in panel), panel)  # which it imports
        for path, line in paths.items():
            self.assertTrue(path == "/" or path.startswith("/usr/"), path)
            self.assertIn("root/root", line)
            self.assertRegex(line.split()[0], r"^(l|.rw[-x]r-[-x]r-[-x]$)", path)
            self.assertNotIn("__pycache__", path)
        for line in listing:
            if "/usr/bin/voxplex" in line or re.search(r"/usr/lib/libvtkVoxplex\S*\.so\.\d+\.\d+\.\d+$", line):
                self.assertTrue(line.startswith("-rw"), line)

    def test_copyright(self):
        text = output("sh", "-c", f"dpkg-deb --fsys-tarfile '{PACKAGE}' | tar -xO ./usr/share/doc/voxplex/copyright")
        self.assertTrue(text.startswith("Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/"))
        self.assertIn("License: BSD-3-Clause", text)
        self.assertIn("Redistribution and use", text)
        self.assertNotIn("@_voxplex", text)

    def test_the_dynamic_linker_learns_of_it(self):
        triggers = output("dpkg-deb", "-I", PACKAGE, "triggers")
        self.assertEqual(triggers, "activate-noawait ldconfig\n")
        self.assertIn(f"libvtkVoxplex {VERSION.rsplit('.', 1)[0]} voxplex (>= {VERSION})",
                      output("dpkg-deb", "-I", PACKAGE, "shlibs"))

    @unittest.skipUnless(HAVE_PYTHON, "the Python package was not built")
    def test_byte_code(self):
        self.assertIn("py3compile -p voxplex", output("dpkg-deb", "-I", PACKAGE, "postinst"))
        self.assertIn("py3clean -p voxplex", output("dpkg-deb", "-I", PACKAGE, "prerm"))

    @unittest.skipUnless(shutil.which("lintian") and shutil.which("help2man"),
                         "lintian, or help2man for the manual page, is not installed")
    def test_lintian(self):
        """Nothing to say, apart from an override that the lintian of another Debian needs."""
        done = subprocess.run(["lintian", "--display-info", "--fail-on", "error,warning,info", "--suppress-tags",
                               "unused-override", "--allow-root", "--no-cfg", str(PACKAGE)],
                              capture_output=True, text=True, timeout=300, check=False)
        self.assertEqual(done.stdout, "", done.stderr)
        self.assertEqual(done.returncode, 0, done.stderr)


if __name__ == "__main__":
    unittest.main()
