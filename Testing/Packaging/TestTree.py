#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""What a build tree, an install tree or an unpacked package is good for, without its neighbours.

VOXPLEX_TREE: the build folder or the prefix. VOXPLEX_BUILD and VOXPLEX_SOURCE: folders that must not occur in
installed files. The others say what was built (VOXPLEX_HAVE_PYTHON, VOXPLEX_HAVE_IO, VOXPLEX_HAVE_PROGRAM) and
where parts go (VOXPLEX_PYTHON_DESTINATION, VOXPLEX_LIBDIR), relative to the prefix.
"""

import os
import re
import subprocess
import sys
import unittest
from pathlib import Path

TREE = Path(os.environ["VOXPLEX_TREE"]).resolve()
LIBRARIES = TREE / os.environ["VOXPLEX_LIBDIR"]
PYTHON = TREE / os.environ["VOXPLEX_PYTHON_DESTINATION"]
VERSION = os.environ["VOXPLEX_VERSION"]
MINOR = VERSION.rsplit(".", 1)[0]
HAVE_ITK = os.environ["VOXPLEX_HAVE_ITK"] == "1"
MODULES = ["Voxplex"] + (["VoxplexIO"] if os.environ["VOXPLEX_HAVE_IO"] == "1" else [])

needs_python = unittest.skipUnless(os.environ["VOXPLEX_HAVE_PYTHON"] == "1", "the Python package was not built")
needs_program = unittest.skipUnless(os.environ["VOXPLEX_HAVE_PROGRAM"] == "1", "the program was not built")


def run(*command, **variables):
    environment = {name: value for name, value in os.environ.items()
                   if name not in ("PYTHONPATH", "LD_LIBRARY_PATH")}
    return subprocess.run([str(part) for part in command], capture_output=True, text=True, timeout=300, check=False,
                          env={**environment, **variables})


class Contents(unittest.TestCase):
    def files(self):
        return {str(path.relative_to(TREE)) for path in TREE.rglob("*") if not path.is_dir()}

    def test_files(self):
        files = self.files()
        lib = os.environ["VOXPLEX_LIBDIR"]
        expected = {f"{lib}/cmake/voxplex-{VERSION}/{name}" for name in (
            "voxplex-config.cmake", "voxplex-config-version.cmake", "Voxplex-targets.cmake",
            "Voxplex-vtk-module-properties.cmake")}
        for module in MODULES:
            expected |= {f"{lib}/libvtk{module}.so", f"{lib}/libvtk{module}.so.{MINOR}",
                         f"{lib}/libvtk{module}.so.{VERSION}", f"include/voxplex-{VERSION}/vtk{module}Module.h"}
            if os.environ["VOXPLEX_HAVE_PYTHON"] == "1":
                expected |= {f"{lib}/vtk/hierarchy/Voxplex/vtk{module}-hierarchy.txt",
                             f"{os.environ['VOXPLEX_PYTHON_DESTINATION']}/voxplex/vtk{module}.so"}
        if HAVE_ITK:
            expected |= {f"{lib}/libVoxplexITK.so", f"{lib}/libVoxplexITK.so.{MINOR}", f"{lib}/libVoxplexITK.so.{VERSION}",
                         f"{lib}/cmake/voxplex-{VERSION}/VoxplexITK-targets.cmake"}
        expected |= {f"share/doc/voxplex/{name}" for name in ("README.md", "CONTRIBUTING.md", "CHANGELOG.md", "Documentation/FirstMesh.md")}
        self.assertEqual(expected - files, set())

    def test_headers(self):
        """The modules' public headers, and nothing of the kernel."""
        names = {path.relative_to(TREE / "include").as_posix() for path in (TREE / "include").rglob("*") if path.is_file()}
        folder = f"voxplex-{VERSION}"
        public = {f"{folder}/{path.name}" for part in ("Filters", "IO")
                  for path in (Path(os.environ["VOXPLEX_SOURCE"]) / part).rglob("vtk*.h")
                  if part == "Filters" or "VoxplexIO" in MODULES}
        generated = {f"{folder}/vtk{module}Module.h" for module in MODULES}
        if HAVE_ITK:
            public |= {f"{folder}/{path.name}" for path in (Path(os.environ["VOXPLEX_SOURCE"]) / "ITK").glob("*.h*")}
            generated.add(f"{folder}/voxplexITKExport.h")
        self.assertGreater(len(public), 4)
        self.assertEqual(names - {"VoxplexPython.h"}, public | generated)  # VTK 9.3 writes it for the wrapped classes

    def test_no_path_of_this_machine(self):
        paths = [os.environ[name].encode() for name in ("VOXPLEX_BUILD", "VOXPLEX_SOURCE")]
        for name in self.files():
            data = (TREE / name).read_bytes()
            for path in paths:
                at = data.find(path)
                self.assertEqual(at, -1, f"{name}: {data[max(0, at - 80):at + 120]!r}")

    def test_run_paths(self):
        """Libraries are looked for beside the files, not where they were built."""
        checked = 0
        for name in sorted(self.files()):
            path = TREE / name
            if path.is_symlink() or path.read_bytes()[:4] != b"\x7fELF":
                continue
            checked += 1
            dynamic = run("readelf", "-d", path).stdout
            for entry in re.findall(r"\(R(?:UN)?PATH\).*\[(.*)\]", dynamic):
                for folder in entry.split(":"):
                    self.assertTrue(folder.startswith("$ORIGIN"), f"{name}: {folder}")
        self.assertGreaterEqual(checked, len(MODULES))


class Use(unittest.TestCase):
    @needs_program
    def test_program(self):
        program = TREE / "bin" / "voxplex"
        self.assertIn("--delta", run(program, "--help").stdout)
        self.assertIn(VERSION, run(program, "--version").stdout)
        linked = run("ldd", program).stdout
        self.assertNotIn("not found", linked)
        found = re.search(r"libvtkVoxplex\.so\S* => (\S+)", linked)
        self.assertEqual(Path(found.group(1)).resolve().parent, LIBRARIES)

    @unittest.skipUnless(HAVE_ITK, "the filter for ITK was not built")
    def test_itk(self):
        """The library for ITK works with any ITK, and without VTK."""
        linked = run("readelf", "-d", LIBRARIES / "libVoxplexITK.so").stdout
        self.assertIn("[libVoxplexITK.so." + MINOR + "]", linked)
        self.assertNotRegex(linked, r"NEEDED.*\[lib(vtk|ITK|itk)")

    @needs_python
    def test_python(self):
        """import voxplex, from here alone, with the libraries from here."""
        script = ("import numpy, voxplex, re\n"
                  "labels = numpy.zeros((9, 9, 9), dtype=numpy.uint8); labels[2:7, 2:7, 2:7] = 1\n"
                  "print(voxplex.__file__)\n"
                  "print(voxplex.__version__)\n"
                  "voxplex.vtkImageToTetMeshFilter()\n"
                  "print(sorted(set(re.findall('/.*libvtkVoxplex.*', open('/proc/self/maps').read()))))\n"
                  "print(len(voxplex.mesh(labels, 2.0).cells))\n")
        done = run(sys.executable, "-c", script, PYTHONPATH=str(PYTHON))
        self.assertEqual(done.returncode, 0, done.stderr)
        file, version, libraries, cells = done.stdout.splitlines()
        self.assertEqual(Path(file), PYTHON / "voxplex" / "__init__.py")
        self.assertEqual(version, VERSION)
        self.assertEqual({str(Path(path).parent) for path in re.findall(r"'(.*?)'", libraries)}, {str(LIBRARIES)})
        self.assertGreater(int(cells), 10)

    @needs_python
    def test_distribution(self):
        done = run(sys.executable, "-c", "import importlib.metadata as m; print(m.version('voxplex'))", PYTHONPATH=str(PYTHON))
        self.assertEqual(done.stdout.strip(), VERSION, done.stderr)

    @needs_python
    @needs_program
    def test_python_finds_the_program_of_its_tree(self):
        done = run(sys.executable, "-c", "import os, voxplex.installation as i; print(os.path.normpath(i.PROGRAM))",
                   PYTHONPATH=str(PYTHON))
        self.assertEqual(Path(done.stdout.strip()), TREE / "bin" / "voxplex", done.stderr)
        version = run(sys.executable, "-m", "voxplex", "--version", PYTHONPATH=str(PYTHON))
        self.assertIn(VERSION, version.stdout, version.stderr)


if __name__ == "__main__":
    if os.environ.get("VOXPLEX_TREE_KIND") == "build":
        del Contents  # a build tree has other files, too
    unittest.main()
