#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Runs what a page of Documentation/ tells its readers to run: TestPage.py PAGE.md

In one empty folder, in order: blocks of `sh` by bash, blocks of `python` in one interpreter, one namespace. A block of
`text` is the output of the block before it and is not compared (Benchmarks/Figures/refresh-output writes it). A block after a line
`<!-- file: NAME -->` is written to that file; one after `<!-- not run: REASON -->` is left out, and so is one after
`<!-- needs: NAMES -->` if one of these programs or Python modules is not there; one of `sh` after `<!-- fails: REASON -->`
must end with an error.
PYTHONPATH and VOXPLEX_PREFIX (an install tree, which stands for ~/voxplex and ~/voxplex-cxx) say what is tested.
"""

import contextlib
import importlib.util
import io
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

BLOCK = re.compile(r"^(?:<!-- (?P<mark>file|needs|not run|fails): (?P<value>.*?) -->\n)?^```(?P<kind>\w*)\n(?P<text>.*?)^```$",
                   re.MULTILINE | re.DOTALL)


def environment(folder):
    """A home with ~/voxplex and ~/voxplex-cxx, whose programs are found, and this interpreter as python3."""
    programs = folder / "bin"
    programs.mkdir()
    (programs / "python3").write_text(f'#!/bin/sh\nexec "{sys.executable}" "$@"\n')  # a link would leave a virtual environment
    (programs / "python3").chmod(0o755)
    result = {**os.environ, "HOME": str(folder), "PATH": f"{programs}:{folder / 'voxplex' / 'bin'}:{os.environ['PATH']}"}
    if "VOXPLEX_PREFIX" in os.environ:
        for name in ("voxplex", "voxplex-cxx"):  # README's virtual environment, and the prefix of Cxx.md
            (folder / name).symlink_to(os.environ["VOXPLEX_PREFIX"])
    return result


def run_shell(block, variables):
    """What a block prints; raises if it fails, or if it does not although it must."""
    process = subprocess.run(["bash", "-euo", "pipefail", "-c", block["text"]], env=variables, timeout=900,
                             stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    print(process.stdout, flush=True)
    if (process.returncode != 0) != (block["mark"] == "fails"):
        sys.exit(f"exit status {process.returncode} of:\n{block['text']}")
    return process.stdout


def is_missing(name):
    """Whether it is neither a program nor a module."""
    return not shutil.which(name) and not importlib.util.find_spec(name)


def run(page, on_output=lambda block, output: None, on_end=lambda: None):
    """The number of blocks that were run or left out; raises if one fails. Calls on_output for each block of sh, on_end in the folder."""
    text = page.read_text()
    namespace = {"__name__": "page"}
    count = 0
    with tempfile.TemporaryDirectory() as home:
        variables = environment(Path(home))
        work = Path(home) / "work"
        work.mkdir()
        os.chdir(work)
        for block in BLOCK.finditer(text):
            where = f"{page.name}:{text.count(chr(10), 0, block.start('text')) + 1}"
            if block["mark"] == "not run" or block["kind"] == "text":
                continue
            count += 1
            print(f"--- {where}: {block['value'] or block['kind']}", flush=True)
            missing = [name for name in block["value"].split(", ") if is_missing(name)] if block["mark"] == "needs" else []
            if missing:
                print("left out without", *missing)
                continue
            if block["mark"] == "file":
                Path(block["value"]).write_text(block["text"])
            elif block["kind"] == "sh":
                on_output(block, run_shell(block, variables))
            elif block["kind"] == "python":
                output = io.StringIO()
                with contextlib.redirect_stdout(output):
                    exec(compile(block["text"], where, "exec"), namespace)
                print(output.getvalue(), flush=True)
            else:
                sys.exit(f"{where}: a block of kind {block['kind']!r} is neither run nor written to a file")
        on_end()
        os.chdir("/")
    if count != len(re.findall(r"^```(?!text$)\w", text, re.MULTILINE)) - len(re.findall(r"^<!-- not run: ", text, re.MULTILINE)):
        sys.exit(f"{page.name}: some blocks were overlooked")
    return count


if __name__ == "__main__":
    print(f"{run(Path(sys.argv[1]).resolve())} blocks were run or left out")
