#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Looks for each key of the program's statistics in Documentation/Reference.md: TestStatistics.py VOXPLEX IMAGE PAGE.md"""

import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

# Their keys are labels, flags, or the rules that Algorithm.md describes.
OTHERS = ("parameters", "rules")


def keys(value, name=""):
    """All keys of nested objects, except labels."""
    if isinstance(value, list):
        for item in value:
            yield from keys(item)
    elif isinstance(value, dict) and name not in OTHERS:
        for key, item in value.items():
            if not key.isdigit():
                yield key
            yield from keys(item, key)


def main(program, image, page):
    documented = set(re.findall(r"`(\w+)`", page.read_text()))
    with tempfile.TemporaryDirectory() as folder:
        statistics = Path(folder) / "statistics.json"
        subprocess.run([program, "--input", image, "--delta", "8", "--threads", "2", "--hausdorff", "--stats", statistics],
                       check=True)
        found = set(keys(json.loads(statistics.read_text())))
    missing = sorted(found - documented)
    print(f"{page.name} lacks {', '.join(missing)}" if missing else f"{len(found)} keys are in {page.name}")
    return bool(missing)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2], Path(sys.argv[3])))
