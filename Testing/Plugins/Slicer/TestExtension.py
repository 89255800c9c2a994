#!/usr/bin/python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""The extension's CMake files, configured with a stand-in for Slicer's CMake package, and its metadata."""
import json
import os
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parents[2]
EXTENSION = REPOSITORY / "Plugins" / "Slicer"
CMAKE = os.environ.get("VOXPLEX_CMAKE", "cmake")


class Extension(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix="voxplex-slicer-")
        cls.addClassCleanup(folder.cleanup)
        cls.build = Path(folder.name)
        # The real package, from a Slicer that is not there, would be found here, too.
        done = subprocess.run([CMAKE, "-S", EXTENSION, "-B", cls.build, "-DSlicer_DIR=%s" % (HERE / "standins" / "cmake"),
                               "-DCMAKE_BUILD_TYPE=Release",
                               "-DVOXPLEX_REPOSITORY_URL=https://example.org/elsewhere"],
                              capture_output=True, text=True, timeout=300)
        if done.returncode:
            raise AssertionError(done.stdout + done.stderr)
        cls.description = dict(line.split(" ", 1) for line in
                               (cls.build / "VoxplexMesher.description").read_text().splitlines())

    def test_metadata(self):
        d = self.description
        self.assertEqual(d["NAME"], "VoxplexMesher")
        self.assertEqual(d["HOMEPAGE"], "https://example.org/elsewhere")
        self.assertNotIn("\n", d["DESCRIPTION"])
        self.assertLess(len(d["DESCRIPTION"]), 200)
        for key in ("ICONURL", "SCREENSHOTURLS"):
            url = d[key]
            self.assertRegex(url, r"^https://example\.org/elsewhere/raw/main/.*\.png$")
            self.assertTrue((REPOSITORY / url.split("/raw/main/")[1]).is_file(), url)

    def test_entry_of_the_index(self):
        """The rules of slicer-extension-catalog-entry-schema-v1.0.1.json."""
        entry = json.loads((self.build / "VoxplexMesher.json").read_text())
        kinds = {"$schema": str, "category": str, "scm_url": str, "scm_revision": str, "scm_type": str,
                 "build_dependencies": list, "build_subdirectory": str, "enabled": bool, "tier": int}
        self.assertLessEqual({"$schema", "category", "scm_url"}, set(entry))
        self.assertLessEqual(set(entry), set(kinds))
        for key, value in entry.items():
            self.assertIsInstance(value, kinds[key], key)
        self.assertIn(entry["scm_type"], ("git", "local"))
        self.assertIn(entry["tier"], (1, 3, 5))
        self.assertIn("slicer-extension-catalog-entry-schema-v1.0.1", entry["$schema"])
        self.assertEqual((entry["category"], entry["scm_url"]),
                         (self.description["CATEGORY"], "https://example.org/elsewhere"))

    def test_every_script_is_packaged(self):
        folder = EXTENSION / "VoxplexMesher"
        listed = (folder / "CMakeLists.txt").read_text().replace("${MODULE_NAME}", "VoxplexMesher")
        for path in folder.rglob("*"):
            if path.suffix in (".py", ".png"):
                self.assertIn(str(path.relative_to(folder)), listed)

    def test_what_is_installed(self):
        """The modules where Slicer looks for them, and nothing of the libraries' headers and packages."""
        script = (self.build / "cmake_install.cmake").read_text()
        self.assertEqual(set(re.findall(r"\$\{CMAKE_INSTALL_PREFIX\}/([^\"]*/)(?:lib)?SegmentationToTetMesh", script)),
                         {"lib/Slicer-5.8/cli-modules/"})
        self.assertIn('lib/Slicer-5.8/cli-modules/SegmentationToTetMesh"', script)
        self.assertIn('lib/Slicer-5.8/cli-modules/libSegmentationToTetMeshLib.so"', script)
        self.assertNotIn("Voxplex/cmake_install.cmake", script)
        cache = (self.build / "CMakeCache.txt").read_text()
        # Where Slicer's launcher of the build tree looks.
        self.assertIn("VOXPLEX_SLICER_CLI_OUTPUT_DIRECTORY:PATH=%s/lib/Slicer-5.8/cli-modules\n" % self.build, cache)
        scripts = (self.build / "VoxplexMesher" / "cmake_install.cmake").read_text()
        self.assertIn("qt-scripted-modules/VoxplexMesherLib", scripts)
        self.assertIn("VoxplexMesherLib/Table.py", scripts)

    def test_slicer_is_needed(self):
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([CMAKE, "-S", EXTENSION, "-B", folder, "-DSlicer_DIR=/nonexistent"], capture_output=True,
                                  text=True, timeout=300)
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("Slicer", done.stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
