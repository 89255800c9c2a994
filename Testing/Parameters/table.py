# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""The table of parameters, and what the filters call its values."""
import json
import os
import subprocess
from pathlib import Path

from voxplex import vtkImageToPentatopeMeshFilter, vtkImageToTetMeshFilter, vtkSegmentationReader, vtkSegmentationRepair

SOURCE = Path(os.environ["VOXPLEX_SOURCE"])
LISTS = ("text", "file", "numbers", "labels", "label-sizes", "interface-sizes", "image", "times")
TABLE = json.loads(subprocess.run([os.environ["VOXPLEX_PARAMETERS"]], check=True, capture_output=True, text=True).stdout)
BY_PROPERTY = {p["property"]: p for p in TABLE if p["kind"] not in LISTS}


CLASSES = {"Reader": vtkSegmentationReader, "Repair": vtkSegmentationRepair, "Pentatopes": vtkImageToPentatopeMeshFilter,
           "Tets": vtkImageToTetMeshFilter, "Filter": vtkImageToTetMeshFilter}


def make_filter(parameter):
    return CLASSES[parameter["class"]]()


def default_of(parameter):
    """As the filters have it."""
    if parameter["words"]:
        return parameter["words"].index(parameter["default"])
    if parameter["kind"] == "flag":
        return parameter["default"] == "on"
    return float(parameter["default"] or 0)
