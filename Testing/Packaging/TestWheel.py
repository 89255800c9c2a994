#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""The wheel in the environment of this interpreter: Scripts/build-wheel runs this, without Voxplex or VTK around."""

import importlib.metadata
import json
import pathlib
import re
import struct
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree
import zlib

import numpy

import voxplex


def run(*arguments, program=("voxplex",)):
    return subprocess.run([*program, *map(str, arguments)], capture_output=True, text=True, timeout=300)


def write_nrrd(path, labels):
    header = (f"NRRD0004\ntype: uint8\ndimension: 3\nsizes: {' '.join(map(str, reversed(labels.shape)))}\n"
              "encoding: raw\n\n")
    path.write_bytes(header.encode() + labels.tobytes())


def array_of(vtu, name):
    """An array of a .vtu file as VTK writes it: appended, raw, in compressed blocks, with counts of 64 bits."""
    data = vtu.read_bytes()
    head, _, appended = data.partition(b'<AppendedData encoding="raw">')
    tree = xml.etree.ElementTree.fromstring(head + b"</VTKFile>")
    offset = int(next(a.get("offset") for a in tree.iter("DataArray") if a.get("Name") == name))
    at = appended.index(b"_") + 1 + offset
    (blocks,) = struct.unpack_from("<Q", appended, at)
    sizes = struct.unpack_from(f"<{blocks}Q", appended, at + 24)
    at += 24 + 8 * blocks
    parts = []
    for size in sizes:
        parts.append(zlib.decompress(appended[at:at + size]))
        at += size
    return b"".join(parts)


class Wheel(unittest.TestCase):
    def test_versions(self):
        version = importlib.metadata.version("voxplex-mesh")
        self.assertEqual(voxplex.__version__, version)
        for program in ("voxplex",), (sys.executable, "-m", "voxplex"):
            self.assertEqual(run("--version", program=program).stdout, f"voxplex {version}\n")

    def test_ball(self):
        k, j, i = numpy.mgrid[:24, :24, :24]
        ball = ((i - 11.5) ** 2 + (j - 11.5) ** 2 + (k - 11.5) ** 2 < 81).astype(numpy.uint8)
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            write_nrrd(folder / "ball.nrrd", ball)
            done = run("--input", folder / "ball.nrrd", "--delta", 2, "--output", folder / "ball.vtu")
            self.assertEqual(done.returncode, 0, done.stderr)
            tetrahedra = int(re.match(r"([\d,]+) tetrahedra", done.stdout)[1].replace(",", ""))
            labels = numpy.frombuffer(array_of(folder / "ball.vtu", "Label"), numpy.int32)
            self.assertEqual(labels.shape, (tetrahedra,))
            self.assertTrue((labels == 1).all())
            points = numpy.frombuffer(array_of(folder / "ball.vtu", "Points"), numpy.float64).reshape(-1, 3)
            cells = numpy.frombuffer(array_of(folder / "ball.vtu", "connectivity"), numpy.int64).reshape(-1, 4)
            edges = points[cells[:, 1:]] - points[cells[:, :1]]
            volume = abs(numpy.linalg.det(edges)).sum() / 6
            self.assertAlmostEqual(volume / ball.sum(), 1.0, delta=0.01)

    def test_wrong_arguments(self):
        done = run("--input", "no such file.nrrd", "--output", "mesh.vtu")
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("no such file.nrrd", done.stderr)
        self.assertEqual(run("--unknown").returncode, 2)

    def test_libraries(self):
        """VTK's libraries are in the wheel, and ours in place of libjbig, which is under the GPL, and of libcurl."""
        files = [pathlib.Path(file.locate()) for file in importlib.metadata.files("voxplex-mesh")]
        libraries = [file for file in files if ".libs" in file.parent.name]
        self.assertTrue(any("vtkIOXML" in file.name for file in libraries))
        for name in "libjbig", "libcurl":
            (stand_in,) = (file for file in libraries if file.name.startswith(name))
            self.assertLess(stand_in.stat().st_size, 30000)
        self.assertFalse([file.name for file in libraries if file.name.startswith(("libgnutls", "libkrb5", "libldap"))])
        self.assertTrue(any(file.name == "LICENSE" for file in files))

    def test_licences(self):
        """Each library is in the list of components, and each component's licence is in the wheel."""
        files = [pathlib.Path(file.locate()) for file in importlib.metadata.files("voxplex-mesh")]
        (path,) = (file for file in files if file.name.endswith(".cdx.json"))
        bill = json.loads(path.read_text())
        ours, others = bill["metadata"]["component"], bill["components"]
        listed = [part["name"] for component in (ours, *others) for part in component["components"]]
        self.assertEqual(sorted(listed), sorted(file.name for file in files if ".libs" in file.parent.name))
        licences = path.parent.parent / "licenses"
        for component in others:
            (licence,) = component["licenses"]
            self.assertRegex(licence["expression"], r"^(?!GPL)\S")
            text = (licences / component["name"] / "copyright").read_text(errors="replace")
            self.assertRegex(text, "(?i)copyright", component["name"])
        names = {component["name"] for component in others}
        self.assertLess({"libcgal-dev", "liblzma5", "libvtk9.1", "nlohmann-json3-dev"}, names)
        for name in "Apache-2.0", "GPL-3", "LGPL-2.1", "LGPL-3":
            self.assertGreater((licences / "common-licenses" / name).stat().st_size, 5000)


if __name__ == "__main__":
    unittest.main()
