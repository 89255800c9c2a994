#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Writes what 3D Slicer's scripted module knows of the parameters, which needs no build:

    write_slicer.py PROGRAM > Plugins/Slicer/VoxplexMesher/VoxplexMesherLib/Table.py

PROGRAM prints the table as JSON.
"""
import pprint
import sys

from write_documentation import read_table

HEAD = '''# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""The parameters of meshing; written by Parameters/write_slicer.py."""

TABLE = '''
KEYS = ("slicer", "option", "group", "label", "kind", "unit", "default", "zero", "step", "words", "range", "usual", "slicer_help")


def module(table):
    rows = [{key: p[key] for key in KEYS} for p in table if p["slicer"]]
    return HEAD + pprint.pformat(rows, width=120, sort_dicts=False) + "\n"


if __name__ == "__main__":
    sys.stdout.write(module(read_table(sys.argv[1])))
