#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Files that say what this is, of which version, by whom and under which licence say the same."""

import json
import os
import re
import subprocess
import unittest
from pathlib import Path

SOURCE = Path(os.environ["VOXPLEX_SOURCE"])
VERSION = os.environ["VOXPLEX_VERSION"]
DESCRIPTION = "Label images to conforming simplex meshes"
AUTHORS = "The Voxplex developers"
LICENCE = "BSD-3-Clause"


def entry(name, text):
    """The value in a line of YAML or TOML, without quotes and comment."""
    return re.search(rf"""^[ -]*{name}(?::| =) *["']?(.*?)["']?(?: #.*)?$""", text, re.MULTILINE)[1]


class Credit(unittest.TestCase):
    def test_citation(self):
        text = (SOURCE / "CITATION.cff").read_text()
        self.assertEqual([entry(name, text) for name in ("title", "abstract", "version", "license", "name")],
                         ["Voxplex", DESCRIPTION, VERSION, LICENCE, AUTHORS])

    def test_codemeta(self):
        meta = json.loads((SOURCE / "codemeta.json").read_text())
        self.assertEqual([meta[name] for name in ("name", "description", "version", "license")],
                         ["Voxplex", DESCRIPTION, VERSION, f"https://spdx.org/licenses/{LICENCE}"])
        self.assertEqual([author["name"] for author in meta["author"]], [AUTHORS])
        thesis = meta["referencePublication"]
        citation = (SOURCE / "CITATION.cff").read_text().partition("references:")[2]
        self.assertEqual([thesis["name"], thesis["datePublished"], thesis["id"]],
                         [entry("title", citation), entry("year", citation), f"https://doi.org/{entry('doi', citation)}"])

    def test_wheel(self):
        text = (SOURCE / "pyproject.toml").read_text()
        self.assertEqual([entry(name, text) for name in ("name", "description", "license")],
                         ["voxplex-mesh", DESCRIPTION, LICENCE])
        self.assertIn(f'authors = [{{ name = "{AUTHORS}" }}]', text)
        self.assertEqual(re.search(entry("regex", text), (SOURCE / entry("input", text)).read_text())["value"], VERSION)

    def test_cmake(self):
        text = (SOURCE / "CMakeLists.txt").read_text()
        self.assertIn(f"set(VOXPLEX_VERSION {VERSION})", text)
        self.assertIn(f'DESCRIPTION "{DESCRIPTION}"', text)
        self.assertIn(f'NAME\n  VTK::Voxplex\nLIBRARY_NAME\n  vtkVoxplex\nDESCRIPTION\n  "{DESCRIPTION}"\n',
                      (SOURCE / "vtk.module").read_text())

    def test_conda(self):
        text = (SOURCE / "Packaging" / "conda-forge" / "recipe.yaml").read_text()
        self.assertEqual([entry(name, text) for name in ("name", "version", "license", "summary")],
                         ["voxplex-mesh", VERSION, LICENCE, DESCRIPTION])

    def test_licence(self):
        text = (SOURCE / "LICENSE").read_text()
        self.assertTrue(text.startswith("BSD 3-Clause License\n"))
        self.assertRegex(text, rf"Copyright \(c\) \d+, {AUTHORS}\n")

    @unittest.skipUnless((SOURCE / ".git").exists(), "not a checkout")
    def test_sources(self):
        """Each source file begins with its copyright and licence. VTK 9.1 refuses fields for them in vtk.module."""
        names = subprocess.run(["git", "-C", SOURCE, "ls-files"], capture_output=True, text=True, check=True).stdout
        sources = [name for name in names.splitlines() if re.search(
            r"^(Scripts|Benchmarks)/(\w+/)*[\w-]+$|\.(cxx|h|hxx|txx|c|py|pyi|cmake|sh)(\.in)?$|(^|/)(CMakeLists\.txt|vtk\.module)$", name)]
        self.assertGreater(len(sources), 900)
        tags = rf"SPDX-FileCopyrightText: Copyright \(c\) {AUTHORS}\n\W*SPDX-License-Identifier: {LICENCE}\n"
        without = [name for name in sources if (SOURCE / name).is_file()
                   and not re.match(rf"(?:#!.*\n)?\W*{tags}", (SOURCE / name).read_text())]
        self.assertEqual(without, [])


if __name__ == "__main__":
    unittest.main()
