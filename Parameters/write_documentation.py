#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Writes the table of parameters as a page: write_documentation.py PROGRAM > Documentation/Parameters.md

PROGRAM prints the table as JSON.
"""
import json
import subprocess
import sys

LARGEST_WHOLE = 2**31 - 1
HEAD = """# Parameters of meshing

Their names in the program `voxplex`, in Python (`voxplex.mesh()`), 3D Slicer (the panel) and VTK, whose methods
have Set or Get before them; ParaView's properties have VTK's names. [Reference.md](Reference.md) says what each does. A
script makes this page from the table in `Parameters/Table.cxx`.

| option | Python | Slicer | VTK | default | values |
| --- | --- | --- | --- | --- | --- |
"""


def limits(p):
    """The range as text; words are their own."""
    if p["words"]:
        return ", ".join(f"`{word}`" for word in p["words"])
    if p["kind"] == "flag":
        return "on, off"
    low, high = p["range"]
    if low is None or p["kind"] == "bytes":
        return "any" if p["kind"] == "real" else ""
    if high is None or high == LARGEST_WHOLE:
        return f"above {low:g}" if p["low_is_outside"] else f"{low:g} or more"
    return f"{low:g} to {high:g}"


def row(p):
    names = [f"`{name}`" if name else "" for name in (p["option"] and "--" + p["option"], p["python"], p["slicer"], p["property"])]
    values = [limits(p)] if limits(p) else []
    if p["dimension"]:
        values.append("%dD only" % p["dimension"])
    return "| " + " | ".join([*names, p["default"], "; ".join(values)]) + " |"


def page(table):
    return HEAD + "".join(row(p) + "\n" for p in table)


def read_table(program):
    return json.loads(subprocess.run([program], check=True, capture_output=True, text=True).stdout)


if __name__ == "__main__":
    sys.stdout.write(page(read_table(sys.argv[1])))
