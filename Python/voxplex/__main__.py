# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""python3 -m voxplex: the command line program of the same build or install tree."""

import os
import sys

from .installation import PROGRAM


def main() -> None:
    """Becomes the program: arguments, streams, signals and the exit status are its own."""
    program = os.path.normpath(PROGRAM)
    if not os.access(program, os.X_OK):
        sys.exit(f"voxplex: the command line program is not installed: there is no {program}. It is built where "
                 "GDCM and Boost are found.")
    os.execv(program, ["voxplex", *sys.argv[1:]])


if __name__ == "__main__":
    main()
