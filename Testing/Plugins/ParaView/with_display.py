#!/usr/bin/python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Runs a command with an X display of its own, and ends with its status.

usage: with_display.py COMMAND [ARGUMENT...]

The X server chooses the display's number itself, so that any number of these can run at once (xvfb-run
--auto-servernum looks for a free one first and may find the same twice).
"""
import os
import subprocess
import sys


def main(command):
    readable, writable = os.pipe()
    server = subprocess.Popen(
        ["Xvfb", "-displayfd", str(writable), "-screen", "0", "1600x1000x24", "-nolisten", "tcp", "-noreset"],
        pass_fds=[writable], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    os.close(writable)
    try:
        with os.fdopen(readable) as pipe:
            number = pipe.readline().strip()
        if not number:
            sys.exit("with_display.py: Xvfb does not start (apt-get install xvfb)")
        return subprocess.call(command, env=dict(os.environ, DISPLAY=":" + number))
    finally:
        server.terminate()
        server.wait()


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    status = main(sys.argv[1:])
    sys.exit(status if status >= 0 else 128 - status)
