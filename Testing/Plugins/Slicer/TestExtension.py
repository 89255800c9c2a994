#!/usr/bin/python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""The extension's CMake files, configured with what they use of Slicer's CMake package, and its metadata."""
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
SLICER = """
set(Slicer_CLIMODULES_BIN_DIR "lib/Slicer-5.8/cli-modules")
set(Slicer_INSTALL_CLIMODULES_BIN_DIR "lib/Slicer-5.8/cli-modules")
foreach (file IN ITEMS USE_FILE EXTENSION_GENERATE_CONFIG EXTENSION_CPACK)
  file(WRITE "${CMAKE_BINARY_DIR}/nothing.cmake" "")
  set(Slicer_${file} "${CMAKE_BINARY_DIR}/nothing.cmake")
endforeach ()
macro (slicerMacroBuildScriptedModule)
  cmake_parse_arguments(module "WITH_GENERIC_TESTS" "NAME" "SCRIPTS;RESOURCES" ${ARGN})
  foreach (file IN LISTS module_SCRIPTS module_RESOURCES)
    if (NOT EXISTS "${CMAKE_CURRENT_SOURCE_DIR}/${file}")
      message(FATAL_ERROR "there is no ${file}")
    endif ()
    get_filename_component(folder "${file}" DIRECTORY)
    install(FILES "${file}" DESTINATION "lib/Slicer-5.8/qt-scripted-modules/${folder}")
  endforeach ()
endmacro ()
"""


def configure(folder, *options):
    (folder / "SlicerConfig.cmake").write_text(SLICER)
    done = subprocess.run([CMAKE, "-S", EXTENSION, "-B", folder / "build", "-DSlicer_DIR=%s" % folder,
                           "-DCMAKE_BUILD_TYPE=Release", *options], capture_output=True, text=True, timeout=300)
    if done.returncode:
        raise AssertionError(done.stdout + done.stderr)


class Extension(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix="voxplex-slicer-")
        cls.addClassCleanup(folder.cleanup)
        cls.build = Path(folder.name) / "build"
        configure(Path(folder.name))
        cls.description = dict(re.findall(r'set\(EXTENSION_([A-Z]+) "(.*)"\)', (EXTENSION / "CMakeLists.txt").read_text()))

    def test_metadata(self):
        d = self.description
        self.assertEqual(set(d), {"HOMEPAGE", "CATEGORY", "CONTRIBUTORS", "DESCRIPTION", "ICONURL", "SCREENSHOTURLS", "DEPENDS"})
        self.assertNotIn("\n", d["DESCRIPTION"])
        self.assertLess(len(d["DESCRIPTION"]), 200)

    def test_pictures(self):
        """As the checks of the index find them, in the text of the file at the root of the extension's repository."""
        text = (EXTENSION / "CMakeLists.txt").read_text()
        self.assertEqual(re.search(r"project\s*\(\s*([^\s\)\n\r]+)", text)[1], "VoxplexMesher")
        for name, root in (("ICONURL", EXTENSION), ("SCREENSHOTURLS", REPOSITORY)):
            url, = re.findall(r'set\s*\(EXTENSION_%s\s*"([^"]+)"\)' % name, text)
            self.assertRegex(url, r"^https://[^$]*/raw/main/[^$]*\.png$")
            self.assertTrue((root / url.split("/raw/main/")[1]).is_file(), url)
        icon = (EXTENSION / "VoxplexMesher/Resources/Icons/VoxplexMesher.png").read_bytes()
        self.assertEqual((int.from_bytes(icon[16:20], "big"), int.from_bytes(icon[20:24], "big")), (128, 128))

    def test_licence(self):
        self.assertEqual((EXTENSION / "LICENSE").read_text(), (REPOSITORY / "LICENSE").read_text())

    def test_entry_of_the_index(self):
        """The rules of slicer-extension-catalog-entry-schema-v1.0.1.json, and of the checks of the index."""
        text = (EXTENSION / "VoxplexMesher.json").read_text()
        self.assertNotIn("\r", text)
        entry = json.loads(text)
        kinds = {"$schema": str, "category": str, "scm_url": str, "scm_revision": str, "scm_type": str,
                 "build_dependencies": list, "build_subdirectory": str, "enabled": bool, "tier": int}
        self.assertLessEqual({"$schema", "category", "scm_url"}, set(entry))
        self.assertLessEqual(set(entry), set(kinds))
        for key, value in entry.items():
            self.assertIsInstance(value, kinds[key], key)
        self.assertIn(entry["scm_type"], ("git", "local"))
        self.assertIn(entry["tier"], range(1, 6))
        self.assertIn("slicer-extension-catalog-entry-schema-v1.0.1", entry["$schema"])
        self.assertRegex(entry["scm_url"], r"^(https|git)://.*/Slicer\w+\.git$")
        self.assertEqual(entry["scm_url"], self.description["HOMEPAGE"] + ".git")
        self.assertEqual(entry["category"], self.description["CATEGORY"])
        self.assertEqual((entry["build_dependencies"], self.description["DEPENDS"]), ([], "NA"))

    def test_every_script_is_packaged(self):
        folder = EXTENSION / "VoxplexMesher"
        listed = (folder / "CMakeLists.txt").read_text().replace("${MODULE_NAME}", "VoxplexMesher")
        for path in folder.rglob("*"):
            if path.suffix in (".py", ".png", ".json"):
                self.assertIn(str(path.relative_to(folder)), listed)

    def test_nothing_is_compiled(self):
        """And nothing of the repository outside of the extension's folder is needed."""
        scripts = (self.build / "VoxplexMesher" / "cmake_install.cmake").read_text()
        self.assertIn("qt-scripted-modules/VoxplexMesherLib", scripts)
        self.assertIn("VoxplexMesherLib/Parameters.json", scripts)
        self.assertNotIn("cli-modules", (self.build / "cmake_install.cmake").read_text())
        self.assertNotIn("CGAL_DIR", (self.build / "CMakeCache.txt").read_text())

    def test_with_the_cli_module(self):
        """It goes where Slicer looks for it, and nothing of the libraries' headers and packages is installed."""
        folder = tempfile.TemporaryDirectory(prefix="voxplex-slicer-")
        self.addCleanup(folder.cleanup)
        build = Path(folder.name) / "build"
        configure(Path(folder.name), "-DVOXPLEX_BUILD_CLI_MODULE=ON")
        script = (build / "cmake_install.cmake").read_text()
        self.assertEqual(set(re.findall(r"\$\{CMAKE_INSTALL_PREFIX\}/([^\"]*/)SegmentationToTetMesh", script)),
                         {"lib/Slicer-5.8/cli-modules/"})
        # The process that reads images, beside what was a library's folder in another tree.
        self.assertRegex(script, r"lib/Slicer-5\.8/cli-modules/\.\./lib[^\"]*/voxplex/voxplexImageReader\"")
        self.assertNotIn("Voxplex/cmake_install.cmake", script)
        cache = (build / "CMakeCache.txt").read_text()
        self.assertIn("CGAL_DIR", cache)
        # Where Slicer's launcher of the build tree looks.
        self.assertIn('"%s/lib/Slicer-5.8/cli-modules/SegmentationToTetMesh"' % build, script)

    def test_slicer_is_needed(self):
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([CMAKE, "-S", EXTENSION, "-B", folder, "-DSlicer_DIR=/nonexistent"], capture_output=True,
                                  text=True, timeout=300)
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("Slicer", done.stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
