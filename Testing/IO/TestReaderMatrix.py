#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Files written by other code, read by vtkSegmentationReader: voxels, types, place, times, or a refusal by name.

The rows are in the folder matrix. To look at the files of some:

    TestReaderMatrix.py --write FOLDER PATTERN

Each two values of two properties (types, orders of bytes, encodings, axes ...) occur in some row. With
VOXPLEX_MATRIX_STRENGTH=3 in the environment each three of three do, in half as many rows more.
"""
import re
import sys
import tempfile
import unittest
from collections import Counter

import numpy as np

from matrix import ROWS, formats_of
from matrix.reading import Host
from matrix.rows import Image, write_some

try:
    import nibabel
    nibabel.imageglobals.logger.disabled = True  # it comments on odd headers
except ModuleNotFoundError:
    nibabel = None


class ReaderMatrix(unittest.TestCase):
    maxDiff = None

    @classmethod
    def setUpClass(cls):
        cls.host = Host()
        cls.counts = {name: Counter() for name in formats_of(ROWS)}

    @classmethod
    def tearDownClass(cls):
        cls.host.stop()
        print("\n%s\nloads of the reader: %d" % (table(cls.counts), cls.host.starts), flush=True)

    def judge(self, format_name):
        failures = []
        for row in ROWS:
            if row.format == format_name:
                with tempfile.TemporaryDirectory(prefix="voxplex-test-") as folder:
                    outcome, difference = row.judge(self.host.read(row.files.write(folder)))
                self.counts[format_name][outcome or "failed"] += 1
                if difference:
                    failures.append("%s: %s: %s" % (row.format, row.name, difference.replace(folder + "/", "")))
        if failures:
            self.fail("%d rows\n%s" % (len(failures), "\n".join(failures)))


def _test_of(name):
    def test(self):
        self.judge(name)
    test.__doc__ = name
    return test


for _name in formats_of(ROWS):
    setattr(ReaderMatrix, "test_" + re.sub("[^a-z0-9]+", "_", _name.lower()), _test_of(_name))


class Definitions(unittest.TestCase):
    """What the rows expect is what other people's readers make of the files."""

    @unittest.skipIf(nibabel is None, "nibabel was not found (apt-get install python3-nibabel)")
    def test_nibabel(self):
        compared = 0
        for row in ROWS:
            image = row.outcomes[0]
            # nibabel goes by the name, not by the content.
            if row.format not in ("NIfTI", "NIfTI-2", "MGH") or not isinstance(image, Image) or " named " in row.name:
                continue
            with self.subTest(row.name), tempfile.TemporaryDirectory(prefix="voxplex-test-") as folder:
                path = row.files.write(folder)
                names = (".mgh", ".mgz") if row.format == "MGH" else (".nii", ".nii.gz")
                if not path.name.endswith(names) or path.is_symlink():
                    continue
                # Of MGH nibabel knows no unsigned short, and y and z of images without a place point the other way.
                if row.format == "MGH" and (image.voxels.dtype == "u2" or row.name == "no place"):
                    continue
                theirs = nibabel.load(path)
                unit = 1.0
                if row.format != "MGH":
                    if theirs.header["sform_code"] <= 0 and theirs.header["qform_code"] <= 0:
                        continue
                    unit = {1: 1e3, 3: 1e-3}.get(int(theirs.header["xyzt_units"]) & 7, 1.0)  # metres, microns
                np.testing.assert_allclose(np.diag([-unit, -unit, unit]) @ theirs.affine[:3], image.affine, rtol=1e-5,
                                           atol=1e-5)
                voxels = np.asarray(theirs.dataobj).reshape(image.voxels.T.shape).T
                np.testing.assert_allclose(voxels.astype("f8"), image.voxels.astype("f8"), rtol=1e-6)
                compared += 1
        self.assertGreater(compared, 100)


def table(counts):
    lines = ["%-16s %6s %6s %8s %7s" % ("format", "rows", "equal", "refused", "failed")]
    total = Counter()
    for name, count in counts.items():
        total += count
        lines.append(_line(name, count))
    return "\n".join(lines + [_line("all", total)])


def _line(name, count):
    return "%-16s %6d %6d %8d %7d" % (name, sum(count.values()), count["equal"], count["refused"], count["failed"])


if __name__ == "__main__":
    if sys.argv[1:2] == ["--write"]:
        write_some(*sys.argv[2:4], [("%s: %s" % (row.format, row.name), row.files) for row in ROWS])
    else:
        unittest.main()
