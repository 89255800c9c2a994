# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Image files written by hand from the definitions of their formats, and what reading them must give.

A module for each format has its ROWS. rows.py says what a row is, images.py has voxels and axes, reading.py reads.
"""
from . import faults, gipl, metaimage, mgh, mrc, nifti, nrrd, vtkfiles

_MODULES = nrrd, nifti, metaimage, mgh, gipl, mrc, vtkfiles

SOUND = [sound for module in _MODULES for sound in module.SOUND]
ROWS = [row for module in _MODULES for row in module.ROWS] + faults.rows(SOUND)


def formats_of(rows):
    return list(dict.fromkeys(row.format for row in rows))
