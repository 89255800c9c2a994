#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Fills the parameters of meshing into a file of Python: write_python.py PROGRAM TEMPLATE OUTPUT

PROGRAM prints the table of parameters as JSON. In the template, @PARAMETERS@ stands for those of meshing and repair in the
arguments of a function, @REPAIR@ and @READING@ for those of repair and of reading, with _DESCRIPTIONS for their part of a docstring,
with _LIST and _NAMES for their names, and @OPTIONS@ for what the program calls all of them.
"""
import json
import re
import subprocess
import sys
import textwrap
from pathlib import Path

TYPES = {"flag": "bool", "real": "float", "whole": "int", "bytes": "int", "text": "str", "file": "Path", "numbers": "ArrayLike", "labels": "Iterable[Label]",
         "label-sizes": "Mapping[Label, float]", "interface-sizes": "Mapping[Interface, float]", "image": "Any"}


def type_of(p):
    if p["words"]:
        words = map(str.upper, p["words"]) if p["python"] == "space" else p["words"]
        return f"Literal[{', '.join(map(json.dumps, words))}]"
    return TYPES[p["kind"]]


def signature(table, indent):
    """All but delta, which has a place."""
    words = [f"{p['python']}: Optional[{type_of(p)}] = None," for p in table if p["python"] != "delta"]
    # A word of the text is a parameter.
    text = textwrap.fill(" ".join(word.replace(" ", "\0") for word in words), 118, break_long_words=False,
                         break_on_hyphens=False, subsequent_indent=indent)
    return text.replace("\0", " ")


def descriptions(table, indent):
    lines = []
    for p in table:
        lines += [indent + p["python"], textwrap.fill(p["python_help"], 118, initial_indent=2 * indent,
                                                      subsequent_indent=2 * indent, break_on_hyphens=False)]
    return "\n".join(lines).lstrip()


def names(table, indent):
    return textwrap.fill(", ".join(p["python"] for p in table), 118, subsequent_indent=indent)


def quoted(table, indent):
    return textwrap.fill(", ".join(json.dumps(p["python"]) for p in table), 118, subsequent_indent=indent)


def options(table, indent):
    """Where 0 stands for the default, it is not a value of the option."""
    rows = []
    for p in table:
        low = p["range"][0]
        zero = bool(p["zero"]) and low is not None and (low > 0 or p["low_is_outside"])
        rows.append(f"{indent}\"{p['python']}\": Option(\"{p['option']}\", \"{p['kind']}\", {p['default'] == 'on'}, {zero}),")
    return "\n".join(rows).lstrip()


def main(program, template, output):
    table = [p for p in json.loads(subprocess.run([program], check=True, capture_output=True, text=True).stdout) if p["python"]]
    parts = {"PARAMETERS": (signature, [p for p in table if p["class"] != "Reader"]), "OPTIONS": (options, table)}
    for name, kind in (("READING", "Reader"), ("REPAIR", "Repair")):
        some = [p for p in table if p["class"] == kind]
        parts.update({name: (signature, some), name + "_LIST": (names, some), name + "_DESCRIPTIONS": (descriptions, some),
                      name + "_NAMES": (quoted, some)})
    parts["DESCRIPTIONS"] = (descriptions, parts["PARAMETERS"][1])
    text = re.sub(r"^( *)(.*)@(\w+)@", lambda found: found[1] + found[2] + parts[found[3]][0](parts[found[3]][1], found[1]),
                  Path(template).read_text(encoding="utf-8"), flags=re.MULTILINE)
    Path(output).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
