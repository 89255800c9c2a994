#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""The notebook runs, and shows its pictures."""

import importlib.util
import json
import tempfile
import unittest
from pathlib import Path

NOTEBOOK = Path(__file__).resolve().parents[2] / "Examples" / "Python" / "mesh_of_two_tissues.ipynb"
NEEDED = ("nbclient", "ipykernel", "pyvista", "matplotlib")


@unittest.skipUnless(all(map(importlib.util.find_spec, NEEDED)), "needs " + ", ".join(NEEDED))
class Notebook(unittest.TestCase):
    def test_runs(self):
        import nbclient
        import nbformat
        notebook = nbformat.read(NOTEBOOK, as_version=4)
        with tempfile.TemporaryDirectory() as folder:
            nbclient.NotebookClient(notebook, timeout=300, resources={"metadata": {"path": folder}}).execute()
            self.assertIn("yolk", (Path(folder) / "egg.inp").read_text())
        outputs = [output for cell in notebook.cells for output in cell.get("outputs", [])]
        pictures = [output for output in outputs if "image/png" in output.get("data", {})]
        self.assertEqual(len(pictures), 2)
        self.assertIn("Mesh of", "".join(output.get("text", "") for output in outputs))

    def test_is_stored_without_outputs(self):
        cells = json.loads(NOTEBOOK.read_text())["cells"]
        self.assertFalse(any(cell.get("outputs") for cell in cells))


if __name__ == "__main__":
    unittest.main()
