# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""python3 -m voxplex: the command line program of the same build or install tree."""

import os
import sys

from .program import no_start, path


def main() -> None:
    """Becomes the program: arguments, streams, signals and the exit status are its own."""
    try:
        os.execv(path(), ["voxplex", *sys.argv[1:]])
    except OSError as error:
        sys.exit("voxplex: " + no_start(error))


if __name__ == "__main__":
    main()
