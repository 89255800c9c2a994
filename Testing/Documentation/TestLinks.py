#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Follows the links between the documents, to files and to headings in them: TestLinks.py SOURCE_FOLDER"""

import re
import sys
from pathlib import Path

LINK = re.compile(r"\]\(([^)\s]+)\)")
FENCE = re.compile(r"^```.*?^```$", re.MULTILINE | re.DOTALL)


def prose(path):
    """The text of a page without its blocks of code."""
    return FENCE.sub("", path.read_text())


def anchors(path):
    """What the headings of a page are called in links, as on GitHub."""
    result = set()
    for heading in re.findall(r"^#+ (.*)$", prose(path), re.MULTILINE):
        text = re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")
        number = 0
        name = text
        while name in result:
            number += 1
            name = f"{text}-{number}"
        result.add(name)
    return result


def faults(page, root):
    for link in LINK.findall(re.sub(r"`[^`]*`", "", prose(page))):
        if re.match(r"\w+:", link):
            continue
        name, _, anchor = link.partition("#")
        target = (page.parent / name).resolve() if name else page
        where = f"{page.relative_to(root)}: {link}"
        if not target.exists():
            yield f"{where}: there is no such file"
        elif anchor and anchor not in anchors(target):
            yield f"{where}: the page has no such heading"


def main(root):
    pages = [path for folder in ("", "Documentation", "Benchmarks") for path in sorted((root / folder).glob("*.md"))]
    found = [fault for page in pages for fault in faults(page, root)]
    print("\n".join(found) or f"all links of {len(pages)} pages lead somewhere")
    return bool(found)


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]).resolve()))
