#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Fills the parameters of meshing into a file of Python: write_python.py PROGRAM TEMPLATE OUTPUT

PROGRAM prints the table of parameters as JSON. In the template, @PARAMETERS@ stands for those of a function, @DESCRIPTIONS@ for
their part of its docstring, and @OPTIONS@ for what the program calls them.
"""
import json
import subprocess
import sys
import textwrap
from pathlib import Path

TYPES = {"flag": "bool", "real": "float", "whole": "int", "bytes": "int", "word": "str", "labels": "Iterable[Label]",
         "label-sizes": "Mapping[Label, float]", "interface-sizes": "Mapping[Interface, float]", "image": "Any"}


def signature(table):
    """All but delta, which has a place."""
    words = [f"{p['python']}: Optional[{TYPES[p['kind']]}] = None," for p in table if p["python"] != "delta"]
    # A word of the text is a parameter.
    text = textwrap.fill(" ".join(word.replace(" ", "\0") for word in words), 118, break_long_words=False,
                         break_on_hyphens=False, subsequent_indent=9 * " ")
    return text.replace("\0", " ")


def descriptions(table):
    lines = []
    for p in table:
        lines += [f"    {p['python']}", textwrap.fill(p["python_help"], 118, initial_indent=8 * " ",
                                                       subsequent_indent=8 * " ", break_on_hyphens=False)]
    return "\n".join(lines).lstrip()


def options(table):
    """Where 0 stands for the default, it is not a value of the option."""
    rows = []
    for p in table:
        low = p["range"][0]
        zero = bool(p["zero"]) and low is not None and (low > 0 or p["low_is_outside"])
        rows.append(f"    \"{p['python']}\": _Option(\"{p['option']}\", \"{p['kind']}\", {p['default'] == 'on'}, {zero}),")
    return "\n".join(rows).lstrip()


def main(program, template, output):
    table = [p for p in json.loads(subprocess.run([program], check=True, capture_output=True, text=True).stdout) if p["python"]]
    text = Path(template).read_text(encoding="utf-8")
    for name, write in (("PARAMETERS", signature), ("DESCRIPTIONS", descriptions), ("OPTIONS", options)):
        text = text.replace(f"@{name}@", write(table))
    Path(output).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
