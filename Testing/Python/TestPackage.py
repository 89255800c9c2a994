#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""The package as such: what it exports, its version, its types, its examples, and python3 -m voxplex."""

import ast
import doctest
import errno
import graphlib
import importlib
import importlib.metadata
import importlib.util
import inspect
import os
import pkgutil
import re
import signal
import subprocess
import sys
import tempfile
import time
import unittest
import unittest.mock
from pathlib import Path

import numpy

import voxplex
from voxplex.installation import PROGRAM

PACKAGE = Path(voxplex.__file__).parent
WRAPPED = [name for name in ("vtkVoxplex", "vtkVoxplexIO") if importlib.util.find_spec("voxplex." + name)]


def run(*arguments, **options):
    return subprocess.run([sys.executable, "-m", "voxplex", *arguments], capture_output=True, text=True, timeout=300,
                          check=False, **options)


def catches_sigterm(process):
    """Whether the process has a handler for SIGTERM, as the program has and Python has not."""
    status = Path(f"/proc/{process}/status").read_text()
    return int(re.search(r"SigCgt:\s*([0-9a-f]+)", status).group(1), 16) >> (signal.SIGTERM - 1) & 1 == 1


class Package(unittest.TestCase):
    def test_exports(self):
        for name in voxplex.__all__:
            self.assertTrue(hasattr(voxplex, name), name)
        with self.assertRaisesRegex(AttributeError, "there is no vtkNothing in this package.*take voxplex.mesh"):
            voxplex.vtkNothing
        for module in WRAPPED:
            classes = [name for name in dir(importlib.import_module("voxplex." + module)) if name.startswith("vtk")]
            self.assertGreater(len(classes), 1)
            for name in classes:
                self.assertEqual(getattr(voxplex, name).__name__, name)
                self.assertIn(f"class {name}(", (PACKAGE / f"{module}.pyi").read_text())

    def test_functions_are_documented_and_typed(self):
        """As numpydoc wants: what has arguments has a section of parameters that names them all."""
        functions = {name: getattr(voxplex, name) for name in voxplex.__all__}
        methods = {f"{kind.__name__}.{name}": getattr(kind, name) for kind in (voxplex.Image, voxplex.Mesh, voxplex.Interfaces)
                   for name in dir(kind) if name[0] != "_"}
        for name, function in {**functions, **methods}.items():
            if inspect.isroutine(function):
                self.assertTrue(function.__doc__, name)
                section = re.search(r"Parameters\n +-+\n(.*?)(\n\n +\w+\n +---|$)", function.__doc__, re.DOTALL)
                documented = set(re.findall(r"\w+", section[1])) if section else set()
                self.assertEqual(set(inspect.signature(function).parameters) - documented - {"self"}, set(), name)
                signature = inspect.signature(function)
                self.assertIsNot(signature.return_annotation, inspect.Signature.empty, name)
                for parameter in signature.parameters.values():
                    if parameter.name != "self":
                        self.assertIsNot(parameter.annotation, inspect.Parameter.empty, f"{name}: {parameter}")
        self.assertTrue((PACKAGE / "py.typed").exists())

    def test_modules_import_no_circle(self):
        """Also inside of functions."""
        names = {path.stem for path in PACKAGE.glob("*.py")}
        imports = {name: set() for name in names}
        for name in names - {"__init__"}:
            for node in ast.walk(ast.parse((PACKAGE / f"{name}.py").read_text())):
                if isinstance(node, ast.ImportFrom) and node.level == 1:
                    imports[name] |= {node.module} if node.module else {alias.name for alias in node.names}
        self.assertGreater(len(list(graphlib.TopologicalSorter(imports).static_order())), 10)  # raises CycleError

    def test_version(self):
        self.assertRegex(voxplex.__version__, r"^\d+\.\d+\.\d+$")
        self.assertIn(voxplex.__version__, [distribution.version for distribution in importlib.metadata.distributions()
                                            if distribution.metadata["Name"] in ("voxplex", "voxplex-mesh")])
        expected = os.environ.get("VOXPLEX_VERSION")
        if expected:
            self.assertEqual(voxplex.__version__, expected)

    def test_examples_in_docstrings(self):
        attempted = 0
        for module in pkgutil.iter_modules([str(PACKAGE)], "voxplex."):
            if module.name.split(".")[1] in (*WRAPPED, "__main__"):
                continue
            try:
                result = doctest.testmod(importlib.import_module(module.name))
            except ImportError as missing:  # not every library is there
                self.assertIn(missing.name, ("vtkmodules", "pyvista"))
                continue
            self.assertEqual(result.failed, 0, module.name)
            attempted += result.attempted
        self.assertGreater(attempted, 15)

    @unittest.skipUnless(importlib.util.find_spec("mypy"), "mypy is not installed")
    def test_types(self):
        checked = subprocess.run(
            [sys.executable, "-m", "mypy", "--strict", "--ignore-missing-imports", "--allow-subclassing-any",
             "--no-warn-return-any", "--cache-dir=/dev/null", "-p", "voxplex"],
            capture_output=True, text=True, env={**os.environ, "MYPYPATH": str(PACKAGE.parent)}, check=False)
        self.assertEqual(checked.returncode, 0, checked.stdout + checked.stderr)

    @unittest.skipUnless(importlib.util.find_spec("mypy"), "mypy is not installed")
    def test_types_of_a_caller(self):
        """What an editor knows of calls: typos are found."""
        script = Path(os.environ.get("TMPDIR", "/tmp")) / f"voxplex-types-{os.getpid()}.py"
        script.write_text("import numpy, voxplex\n"
                          "labels = numpy.zeros((4, 4, 4), dtype=numpy.uint8)\n"
                          "voxplex.mesh(labels).statistics['elements']\n"
                          "voxplex.mesh(labels, delta='fine')\n"
                          "voxplex.mesh(labels, detla=1)\n")
        self.addCleanup(script.unlink)
        checked = subprocess.run(
            [sys.executable, "-m", "mypy", "--strict", "--ignore-missing-imports", "--cache-dir=/dev/null",
             str(script)], capture_output=True, text=True, env={**os.environ, "MYPYPATH": str(PACKAGE.parent)},
            check=False)
        lines = set(re.findall(r"voxplex-types-\d+\.py:(\d+): error", checked.stdout))
        self.assertEqual(lines, {"4", "5"}, checked.stdout)


class Imports(unittest.TestCase):
    def test_numpy_is_enough(self):
        """VTK, where it is, is loaded with the first thing of it that is used."""
        script = ("import sys, voxplex, numpy\n"
                  "labels = numpy.ones((8, 8, 8), dtype=numpy.uint8)\n"
                  "mesh = voxplex.mesh(labels, delta=3)\n"
                  "assert len(mesh.cells), mesh\n"
                  "print([name for name in sys.modules if name.partition('.')[0] in ('vtk', 'vtkmodules', 'scipy')])\n")
        done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)
        self.assertEqual((done.stdout, done.stderr), ("[]\n", ""))

    def last_words(self, script, folder=""):
        """The last line of what a script says."""
        paths = [str(folder), str(PACKAGE.parent), os.environ.get("PYTHONPATH", "")]
        done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False,
                              env={**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, paths))})
        self.assertEqual(done.returncode, 1)
        return done.stderr.splitlines()[-1]

    def test_without_numpy(self):
        self.assertEqual(self.last_words("import sys; sys.modules['numpy'] = None; import voxplex"),
                         "ModuleNotFoundError: voxplex needs NumPy, which this Python does not find: pip install numpy")

    def test_without_a_vtk_that_will_do(self):
        """None, an old one, and one that lacks a library."""
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        package = Path(folder.name) / "vtkmodules"
        (package / "util").mkdir(parents=True)
        any_name = "def __getattr__(name):\n    if name[:2] == '__': raise AttributeError(name)\n    return object\n"
        version = ("class vtkVersion:\n    def GetVTKMajorVersion(self): return 9\n"
                   "    def GetVTKMinorVersion(self): return 0\n    def GetVTKVersion(self): return '9.0.3'\n")
        for name in "__init__", "util/__init__", "vtkCommonDataModel", "vtkCommonExecutionModel":
            (package / f"{name}.py").write_text(any_name)
        (package / "vtkCommonCore.py").write_text(version + any_name)
        needs = "ImportError: this needs VTK 9.1 or newer (pip install 'vtk>=9.1'): "
        use = "import voxplex; voxplex.Image([[[1]]]).to_vtk()"
        for support, words in ((any_name, "VTK is 9.0.3"), ("raise ImportError('libGL.so.1: no such file')", "libGL.so.1: no such file")):
            (package / "util" / "numpy_support.py").write_text(support)
            self.assertEqual(self.last_words(use, folder.name), needs + words)
        hide = "import sys; sys.modules['vtkmodules'] = None; "
        self.assertRegex(self.last_words(hide + use), "^" + re.escape(needs) + ".*vtkmodules")


class CommandLine(unittest.TestCase):
    def test_program_that_does_not_start(self):
        """For the system or for the loader of libraries."""
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        path = Path(folder.name) / "voxplex"
        for words, content, mode in (
                ("it is not there; ", None, 0),
                ("it may not be executed; ", b"#!/bin/sh\n", 0o644),
                ("it is made for another system or processor; ", b"\x7fELF of a processor that nobody has", 0o755),
                ("it is made for another system or processor; ", b"#!/no/such/loader\n", 0o755),
                ("/voxplex: version `GLIBC_9' not found; ", b"#!/bin/sh\necho \"$0: version \\`GLIBC_9' not found\" >&2\nexit 1", 0o755),
                ("/voxplex: cannot open libx; ", b"#!/bin/sh\necho \"$0: cannot open libx\" >&2\nexit 127", 0o755)):
            with self.subTest(words):
                if content is not None:
                    path.write_bytes(content)
                    path.chmod(mode)
                message = f"the program {re.escape(str(path))} cannot be started: .*{words}"
                with unittest.mock.patch("voxplex.installation.PROGRAM", path.parent / "none" / ".." / "voxplex"):
                    with self.assertRaisesRegex(RuntimeError, f"^{message}"):
                        voxplex.mesh(numpy.ones((4, 4, 4)))
                if "/voxplex" not in words:
                    script = ("import pathlib, runpy, voxplex.installation as installation\n"
                              f"installation.PROGRAM = pathlib.Path({str(path)!r})\n"
                              "runpy.run_module('voxplex', run_name='__main__')\n")
                    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)
                    self.assertEqual(done.returncode, 1)
                    self.assertRegex(done.stderr, f"^voxplex: {message}.*\n$")
        with unittest.mock.patch("subprocess.Popen", side_effect=BlockingIOError(errno.EAGAIN, "Resource temporarily unavailable")):
            with self.assertRaisesRegex(RuntimeError, r"^the program .* cannot be started: .*Resource.*; limits \(ulimit\) may be too low$"):
                voxplex.mesh(numpy.ones((4, 4, 4)))

    @unittest.skipUnless(os.access(PROGRAM, os.X_OK), "the program was not built")
    def test_arguments_and_status(self):
        version = run("--version")
        self.assertEqual(version.returncode, 0, version.stderr)
        self.assertIn(voxplex.__version__, version.stdout)
        self.assertIn("--delta", run("--help").stdout)
        wrong = run("--input", "a file with spaces.nrrd", "--delta", "fine")
        self.assertEqual(wrong.returncode, 2)
        missing = run("--input", "a file with spaces.nrrd")
        self.assertEqual(missing.returncode, 3)
        self.assertIn("cannot read 'a file with spaces.nrrd': there is no such file", missing.stderr)

    @unittest.skipUnless(os.access(PROGRAM, os.X_OK), "the program was not built")
    def test_signals(self):
        """The process is the program: what is sent to it arrives, and its ways are the program's."""
        with tempfile.TemporaryDirectory() as folder:
            header = Path(folder) / "large.mhd"
            n = 160
            header.write_text("ObjectType = Image\nNDims = 3\nDimSize = 160 160 160\nElementType = MET_UCHAR\n"
                              "ElementSpacing = 1 1 1\nElementDataFile = large.raw\n")
            voxels = bytearray(n * n * n)
            for k in range(5, n - 5):
                for j in range(5, n - 5):
                    row = (k * n + j) * n
                    voxels[row + 5:row + n - 5] = b"\1" * (n - 10)
            (Path(folder) / "large.raw").write_bytes(voxels)
            with subprocess.Popen([sys.executable, "-m", "voxplex", "--input", str(header), "--delta", "0.4", "--force", "--quality"],
                                  stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as process:
                while process.poll() is None and not catches_sigterm(process.pid):
                    time.sleep(0.05)
                process.send_signal(signal.SIGTERM)
                self.assertEqual(process.wait(120), 143)


if __name__ == "__main__":
    unittest.main()
