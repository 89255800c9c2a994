#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""The package as such: what it exports, its version, its types, its examples, and python3 -m voxplex."""

import doctest
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
        with self.assertRaisesRegex(AttributeError, "there is no vtkNothing in this package|needs VTK"):
            voxplex.vtkNothing
        for module in WRAPPED:
            classes = [name for name in dir(importlib.import_module("voxplex." + module)) if name.startswith("vtk")]
            self.assertGreater(len(classes), 1)
            for name in classes:
                self.assertEqual(getattr(voxplex, name).__name__, name)
                self.assertIn(f"class {name}(", (PACKAGE / f"{module}.pyi").read_text())

    def test_functions_are_documented_and_typed(self):
        for name in voxplex.__all__:
            function = getattr(voxplex, name)
            if inspect.isfunction(function):
                self.assertTrue(function.__doc__, name)
                signature = inspect.signature(function)
                self.assertIsNot(signature.return_annotation, inspect.Signature.empty, name)
                for parameter in signature.parameters.values():
                    self.assertIsNot(parameter.annotation, inspect.Parameter.empty, f"{name}: {parameter}")
        self.assertTrue((PACKAGE / "py.typed").exists())

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
            except ModuleNotFoundError as missing:  # not every library is there
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


class CommandLine(unittest.TestCase):
    def test_without_the_program(self):
        script = ("import pathlib, runpy, voxplex.installation as installation\n"
                  "installation.PROGRAM = pathlib.Path('/none/../no-such-program')\n"
                  "runpy.run_module('voxplex', run_name='__main__')\n")
        done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stderr, "^voxplex: the command line program is not installed: there is no /no-such-program")
        with unittest.mock.patch("voxplex.installation.PROGRAM", Path("/none/../no-such-program")):
            with self.assertRaisesRegex(RuntimeError, "is not installed: there is no /no-such-program"):
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
        self.assertEqual(missing.returncode, 1)
        self.assertIn("a file with spaces.nrrd", missing.stderr)

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
            with subprocess.Popen([sys.executable, "-m", "voxplex", "--input", str(header), "--delta", "0.4", "--force"],
                                  stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as process:
                while process.poll() is None and not catches_sigterm(process.pid):
                    time.sleep(0.05)
                process.send_signal(signal.SIGTERM)
                self.assertEqual(process.wait(120), 143)


if __name__ == "__main__":
    unittest.main()
