#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Looks for the messages of Documentation/Troubleshooting.md in the sources: TestMessages.py SOURCE_FOLDER PROGRAM

PROGRAM prints the table of parameters, whose names stand in braces in the sources and as those of VTK on the page.

Messages are in backticks in the first column of the tables. An ellipsis stands for what the program fills in.
"""

import json
import re
import subprocess
import sys
from pathlib import Path

FOLDERS = ("Applications", "Filters", "IO", "Kernel", "Parameters", "Segmentation")
LITERAL = re.compile(r'"((?:[^"\\\n]|\\.)*)"')
# Where two literals are joined, by standing side by side or by an operator.
JOINT = re.compile(r'(?<!\\)"\s*(?:\+\s*)?"')
FEWEST_MESSAGES = 100


def texts(root):
    """What the string literals of all sources hold, neighbouring ones joined."""
    for folder in FOLDERS:
        for path in sorted((root / folder).rglob("*")):
            if path.suffix in (".cxx", ".h", ".txx"):
                code = re.sub(r"^\s*//.*$", "", path.read_text(), flags=re.MULTILINE)
                for match in LITERAL.finditer(JOINT.sub("", code)):
                    yield match[1].replace('\\"', '"')


def messages(page):
    for row in re.findall(r"^\| (`.*?) \| ", page.read_text(), re.MULTILINE):
        yield from re.findall(r"`([^`]+)`", row)


def main(root, program):
    corpus = "\n".join(texts(root))
    for parameter in json.loads(subprocess.run([program], check=True, capture_output=True, text=True).stdout):
        corpus = corpus.replace("{%s}" % parameter["name"], parameter["message"])
    found = list(messages(root / "Documentation" / "Troubleshooting.md"))
    missing = [f"{message!r}: no source has {part.strip()!r}" for message in found for part in message.split("…")
               if part.strip() and part.strip() not in corpus]
    if len(found) < FEWEST_MESSAGES:
        missing.append(f"only {len(found)} messages were found on the page: has its form changed?")
    print("\n".join(missing) or f"{len(found)} messages are in the sources")
    return bool(missing)


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]), sys.argv[2]))
