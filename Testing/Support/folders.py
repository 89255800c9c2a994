# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Folders of tests."""
import tempfile
import unittest
from pathlib import Path


class FolderTestCase(unittest.TestCase):
    """Each test has an empty folder of its own, which is removed afterwards."""

    maxDiff = None

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="voxplex-test-")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
