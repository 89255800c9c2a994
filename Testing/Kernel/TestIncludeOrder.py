# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""TestIncludeOrder.py KERNEL: a folder of the kernel includes from itself and the folders before it only.

Documentation/Architecture.md says what each folder is for.
"""

import re
import sys
from pathlib import Path

ORDER = (
    "Base", "Parallel", "Geometry", "Image", "Domain", "Delaunay", "Sizing", "Refinement/Scheduling", "Refinement",
    "Junctions", "Mesh", "Quality", "Conformity", "Optimisation", "Mesher",
)


def folder_of(path):
    two = "/".join(path.parts[:2])
    return two if two in ORDER else path.parts[0]


def faults_of(kernel):
    files = {path.relative_to(kernel) for suffix in ("h", "cxx", "txx") for path in kernel.rglob("*." + suffix)}
    if not files:
        yield f"{kernel} has no sources"
    for path in sorted(files):
        if folder_of(path) not in ORDER:
            yield f"{path}: its folder is none of {', '.join(ORDER)}"
            continue
        for name in re.findall(r'^#include "([^"]+)"', (kernel / path).read_text(), re.MULTILINE):
            included = Path(name)
            if included not in files:
                yield f'{path}: "{name}" is not found from the top of the kernel'
            elif ORDER.index(folder_of(included)) > ORDER.index(folder_of(path)):
                yield f'{path} includes "{name}", which is above it'


def main():
    faults = list(faults_of(Path(sys.argv[1])))
    print("\n".join(faults) if faults else "every include goes down")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
