#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Writes what 3D Slicer's scripted module knows of the parameters, which needs no build:

    write_slicer.py PROGRAM > Plugins/Slicer/VoxplexMesher/VoxplexMesherLib/Parameters.json

PROGRAM prints the table as JSON. A parameter has a line, and only what differs from the default of a key.
"""
import json
import sys

from write_documentation import read_table

DEFAULTS = {"slicer": "", "option": "", "group": "", "label": "", "kind": "", "unit": "", "default": "", "zero": "", "step": 0.0,
            "words": [], "needs": "", "excludes": "", "range": [None, None], "usual": [None, None], "slicer_help": ""}


def text(table):
    names = {p["name"]: p["slicer"] for p in table}
    table = [{**p, "needs": names.get(p["needs"], ""), "excludes": names.get(p["excludes"], "")} for p in table if p["slicer"]]
    rows = [{key: p[key] for key, value in DEFAULTS.items() if p[key] != value} for p in table]
    lines = [json.dumps(row, ensure_ascii=False) for row in [DEFAULTS, *rows]]
    return "[\n" + ",\n".join(lines) + "\n]\n"


if __name__ == "__main__":
    sys.stdout.write(text(read_table(sys.argv[1])))
