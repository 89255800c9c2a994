#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Mesh a folder of masks, one file for each structure, as whole-body segmentation tools write them.

    mesh_masks.py [FOLDER] --output MESH.vtu [--delta LENGTH]

Without FOLDER a phantom of 100 ellipsoids is written beside the mesh, and meshed.
"""

import argparse
import gzip
import math
import warnings
from pathlib import Path

import numpy

import voxplex

SIZES = (96, 64, 160)
SPACING = 4.0
ORIGIN = (-190.0, -126.0, 0.0)


def structures():
    """100 names, each with the centre and the radii of an ellipsoid in millimetres: x to the left, y to the back, z up."""
    yield "body", (0, 0, 318), (172, 108, 300)
    spine = [f"C{n}" for n in range(1, 8)] + [f"T{n}" for n in range(1, 13)] + [f"L{n}" for n in range(1, 6)]
    for number, name in enumerate(spine):
        yield f"vertebrae_{name}", (0, 62 + 10 * math.sin(number / 4), 578 - 17 * number), (18, 17, 10)
    for side, sign in (("left", 1), ("right", -1)):
        for number in range(12):
            width = 105 + 16 * math.sin(number / 3.5)
            yield f"rib_{side}_{number + 1}", (sign * width, 10 + 2 * number, 470 - 17 * number), (12, 62, 11)
        pairs = {"lung_upper_lobe": ((58, -8, 420), (50, 62, 62)), "lung_lower_lobe": ((58, 18, 330), (48, 58, 60)),
                 "kidney": ((62, 48, 210), (27, 22, 46)), "adrenal_gland": ((50, 40, 262), (12, 10, 12)),
                 "hip": ((80, 30, 100), (48, 36, 50)), "femur": ((86, 10, 50), (24, 24, 46)),
                 "scapula": ((96, 76, 440), (40, 14, 50)), "clavicula": ((68, -52, 496), (52, 11, 11)),
                 "humerus": ((146, 4, 420), (17, 17, 60)), "gluteus": ((70, 76, 110), (50, 30, 60)),
                 "iliopsoas": ((36, 44, 150), (20, 20, 70)), "autochthon": ((34, 88, 300), (22, 16, 190)),
                 "common_carotid_artery": ((24, 8, 524), (9, 9, 46)), "subclavian_artery": ((52, 8, 488), (46, 9, 9)),
                 "iliac_artery": ((28, 6, 118), (10, 10, 46)), "iliac_vein": ((32, 26, 112), (11, 10, 44)),
                 "thyroid_gland": ((20, -18, 520), (14, 12, 22)), "eye": ((26, -48, 590), (13, 13, 13))}
        for name, (centre, radii) in pairs.items():
            yield f"{name}_{side}", (sign * centre[0], *centre[1:]), radii
    yield from (
        ("heart", (16, -30, 352), (48, 42, 54)), ("aorta", (10, 34, 300), (15, 15, 130)),
        ("inferior_vena_cava", (-24, 30, 240), (14, 14, 100)), ("superior_vena_cava", (-30, -6, 424), (12, 12, 40)),
        ("esophagus", (2, 40, 400), (11, 11, 100)), ("trachea", (0, 6, 470), (13, 13, 60)),
        ("liver", (-62, -10, 268), (74, 66, 52)), ("gallbladder", (-52, -48, 226), (17, 18, 25)),
        ("stomach", (52, -26, 278), (44, 44, 40)), ("spleen", (98, 34, 286), (26, 34, 42)),
        ("pancreas", (14, -2, 236), (56, 16, 17)), ("duodenum", (-34, -10, 208), (26, 22, 28)),
        ("colon", (0, -48, 180), (100, 30, 46)), ("urinary_bladder", (0, -30, 70), (40, 36, 32)),
        ("sacrum", (0, 70, 138), (40, 22, 36)))


def inside(centre, radii):
    """Voxels of an ellipsoid, indexed [k, j, i]."""
    x, y, z = (numpy.arange(SIZES[axis]) * SPACING + ORIGIN[axis] for axis in range(3))
    z, y, x = numpy.meshgrid(z, y, x, indexing="ij", sparse=True)
    return sum(((p - c) / r)**2 for p, c, r in zip((x, y, z), centre, radii)) < 1


def write_phantom(folder):
    """A mask a structure, as NRRD."""
    folder.mkdir(parents=True, exist_ok=True)
    header = ("NRRD0004\ntype: uint8\ndimension: 3\nspace: left-posterior-superior\nencoding: gzip\n"
              f"sizes: {' '.join(map(str, SIZES))}\nspace origin: ({','.join(map(str, ORIGIN))})\n"
              f"space directions: ({SPACING},0,0) (0,{SPACING},0) (0,0,{SPACING})\n\n")
    for name, centre, radii in structures():
        voxels = inside(centre, radii).astype(numpy.uint8)
        (folder / f"{name}.nrrd").write_bytes(header.encode() + gzip.compress(voxels.tobytes(), 1))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", nargs="?", type=Path)
    parser.add_argument("--output", required=True, type=Path)
    parser.add_argument("--delta", type=float, default=8.0)
    arguments = parser.parse_args()
    folder = arguments.folder
    if folder is None:
        folder = arguments.output.with_name("masks")
        write_phantom(folder)

    with warnings.catch_warnings(record=True) as told:  # what overlaps, and what is lost
        warnings.simplefilter("always")
        mesh = voxplex.mesh(folder, arguments.delta)
    for warning in told:
        print(warning.message)
    volumes = {label: figures["volume"] for label, figures in mesh.statistics["labels"].items()}
    for label, name in mesh.names.items():
        print(f"{label:4} {name:28} {volumes[str(label)] / 1000:10.1f} ml")
    print(f"{len(mesh.cells)} tetrahedra of {len(mesh.names)} structures")
    mesh.write(arguments.output)


if __name__ == "__main__":
    main()
