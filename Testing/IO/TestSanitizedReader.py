#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Both programs that read images, built with sanitizers, on damaged and hostile files: they find nothing.

    TestSanitizedReader.py VOXPLEX_IMAGE_READER VOXPLEX

The first reads what libraries read, here without the process that it reads for; the second all else. What they answer is
judged by the other tests.
"""
import os
import subprocess
import sys
import unittest
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

TESTING = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(TESTING / "Support"), str(TESTING / "Fuzz")]
import MakeSeeds
from folders import FolderTestCase
from matrix import ROWS, SOUND
from matrix.damage import damaged
from matrix.rows import Files, Sound

HOSTILE = TESTING / "../../shared/data/hostile"
COUNT = 8  # of each sound file
EACH = 8  # of the rows: the other tests read them all
TIMEOUT = 60  # seconds; the sanitizers are slow where much memory is claimed
READER, PROGRAM = sys.argv.pop(1), sys.argv.pop(1)


def sound_after_seeds(folder):
    """Small files of all formats, also of those that the matrix has none of."""
    for extension, contents in MakeSeeds.image_seeds(folder).items():
        for number, content in enumerate(contents):
            file = "%d.%s" % (number, extension)
            yield Sound("seed", "raw", Files(file, {file: content}, header=len(content) // 2), None)


def found(path):
    """What the sanitizers say of reading a file; None if they say nothing."""
    memory = os.memfd_create("voxels")
    try:
        for command in ([READER, path, "", "0", "0.5"], [PROGRAM, "image", path]):
            done = subprocess.run(command, capture_output=True, timeout=TIMEOUT, preexec_fn=lambda: os.dup2(memory, 3), pass_fds=[3])
            is_refused = command[0] == PROGRAM and done.returncode in (1, 3)
            if (done.returncode and not is_refused) or b"Sanitizer" in done.stderr or b"runtime error" in done.stderr:
                return "%s: exit status %d: %s" % (command[0], done.returncode, done.stderr.decode(errors="replace")[:2000])
    except subprocess.TimeoutExpired:
        return "hangs for %d s" % TIMEOUT
    finally:
        os.close(memory)
    return None


class SanitizedReader(FolderTestCase):
    def check(self, paths):
        """paths: {name: path}"""
        with ThreadPoolExecutor(os.cpu_count()) as pool:
            failures = ["%s: %s" % (name, text) for name, text in zip(paths, pool.map(found, paths.values())) if text]
        print("\n%d files" % len(paths), flush=True)
        self.assertGreater(len(paths), 10)
        if failures:
            self.fail("%d files\n%s" % (len(failures), "\n".join(failures)))

    def test_damaged_files(self):
        sounds = [*SOUND, *sound_after_seeds(self.folder)]
        self.check({"%d: %s" % (number, name): files.write(self.folder / str(number))
                    for number, (name, _, files) in enumerate(damaged(sounds, COUNT))})

    def test_refused_rows(self):
        rows = [row for row in ROWS if any(outcome.name == "refused" for outcome in row.outcomes)]
        self.check({"%d: %s: %s" % (number, row.format, row.name): row.files.write(self.folder / str(number))
                    for number, row in enumerate(rows[::EACH])})

    @unittest.skipUnless(HOSTILE.is_dir(), "%s is not there" % HOSTILE)
    def test_hostile_files(self):
        self.check({path.name: path for path in HOSTILE.iterdir()})


if __name__ == "__main__":
    unittest.main()
