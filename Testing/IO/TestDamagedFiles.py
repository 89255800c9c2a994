#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Files damaged at random, the same ones in every run: the host lives, and each gives an error or what its header says.

To look at the files of some:

    TestDamagedFiles.py --write FOLDER PATTERN
"""
import math
import os
import re
import sys
import unittest
from collections import Counter
from pathlib import Path

import numpy as np
from vtkmodules.vtkCommonCore import vtkVersion

from folders import FolderTestCase
from matrix import SOUND
from matrix.damage import claimed_sizes, damaged
from matrix.reading import Host
from matrix.rows import write_some

# What other readers find in files that only looked damaged.
SOUND_AFTER_ALL = {"nrrd-axes10.nrrd": (1, 10, 10, 10), "tiff-subfile_count.tif": (1, 8, 50, 50)}
COUNT = 16  # of each sound file
# Bytes more than with a sound file. The address sanitizer keeps what is freed.
MOST_MEMORY = (2048 if "asan" in os.environ.get("LD_PRELOAD", "") else 256) << 20
TIMEOUT = 10  # seconds
ABORTS = (vtkVersion.GetVTKMajorVersion(), vtkVersion.GetVTKMinorVersion()) >= (9, 6)  # VTK itself, of some .vtk files
HOSTILE = Path(__file__).resolve().parents[2] / "../shared/data/hostile"


class DamagedFiles(FolderTestCase):
    def setUp(self):
        super().setUp()
        self.host = Host(TIMEOUT)
        self.addCleanup(self.host.stop)
        self.memory_before = self.host.read(SOUND[0].files.write(self.folder / "sound")).resident

    def wrong(self, result):
        """What is wrong with a result whatever the file is; None if nothing is."""
        if result.fault and not (ABORTS and "i.vtk': its reading ended with signal 6" in result.fault):
            return result.fault
        if result.resident - self.memory_before > MOST_MEMORY:
            return "takes %d MiB" % (result.resident - self.memory_before >> 20)
        if result.message:
            if not any(name in result.message for name in result.names):
                return "the message names no file: " + result.message
            if len(result.message) > 600 or re.search("[\x00-\x09\x0b-\x1f\x7f]", result.message):
                return "the message is too long, or has control characters: %r" % result.message[:600]
        elif not np.isfinite(result.affine).all() or not all(map(math.isfinite, result.times)):
            return "its place is not finite"
        return None

    def test_damaged_files(self):
        failures, counts = [], Counter()
        for number, (name, format_name, files) in enumerate(damaged(SOUND, COUNT)):
            path = files.write(self.folder / str(number))
            result = self.host.read(path)
            wrong = self.wrong(result)
            if not wrong and not result.message:
                sizes = sorted(size for size in result.shape if size != 1)
                if sizes not in claimed_sizes(format_name, path.read_bytes()):
                    wrong = "read as %s, which its header does not say" % (result.shape,)
            counts["wrong" if wrong else "refused" if result.message else "read"] += 1
            if wrong:
                failures.append("%s: %s" % (name, wrong))
        self.report(failures, counts)

    @unittest.skipUnless(HOSTILE.is_dir(), "%s is not there" % HOSTILE)
    def test_hostile_files(self):
        failures, counts = [], Counter()
        for path in sorted(HOSTILE.iterdir()):
            result = self.host.read(path)
            is_right = bool(result.message) or SOUND_AFTER_ALL.get(path.name) == result.shape
            wrong = self.wrong(result) or (not is_right and "read as %s" % (result.shape,))
            counts["wrong" if wrong else "refused"] += 1
            if wrong:
                failures.append("%s: %s" % (path.name, wrong))
        self.report(failures, counts)

    def report(self, failures, counts):
        print("\n%d files: %s; loads of the reader: %d" % (
            sum(counts.values()), ", ".join("%d %s" % (n, what) for what, n in sorted(counts.items())),
            self.host.starts), flush=True)
        if failures:
            self.fail("%d files\n%s" % (len(failures), "\n".join(failures).replace(str(self.folder), "")))


if __name__ == "__main__":
    if sys.argv[1:2] == ["--write"]:
        write_some(*sys.argv[2:4], [(name, files) for name, _, files in damaged(SOUND, COUNT)])
    else:
        unittest.main()
