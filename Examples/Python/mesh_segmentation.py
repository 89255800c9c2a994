#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Mesh a segmentation and write the tetrahedra and the interfaces.

    mesh_segmentation.py [INPUT] --output MESH.vtu [--interfaces PLC.vtp] [--delta LENGTH]

INPUT is a label image of any format that Voxplex reads. Without it a small phantom is meshed: two touching organs in a body.
"""

import argparse

import numpy

import voxplex


def phantom():
    """48 x 32 x 24 voxels of 1 x 1 x 1.5 mm: organs 2 and 3 touch each other inside of body 1."""
    z, y, x = numpy.meshgrid(1.5 * (numpy.arange(24) - 11.5), numpy.arange(32) - 15.5, numpy.arange(48) - 23.5, indexing="ij")
    labels = ((x / 21) ** 2 + (y / 14) ** 2 + (z / 15) ** 2 < 1).astype(numpy.uint8)
    labels[(x + 6) ** 2 + y ** 2 + z ** 2 < 49] = 2
    labels[(labels < 2) & ((x - 6) ** 2 + y ** 2 + z ** 2 < 49)] = 3
    return voxplex.Image(labels, spacing=(1.0, 1.0, 1.5))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("input", nargs="?")
    parser.add_argument("--output", required=True)
    parser.add_argument("--interfaces")
    parser.add_argument("--delta", type=float)
    arguments = parser.parse_args()

    mesh = voxplex.mesh(arguments.input or phantom(), arguments.delta)
    print(f"{len(mesh.cells)} tetrahedra, {len(mesh.interfaces.cells)} interface triangles")
    for label, volume in mesh.label_volumes().items():
        print(f"  label {label}: {(mesh.labels == label).sum()} tetrahedra, volume {volume:.1f}")
    mesh.write(arguments.output, interfaces=arguments.interfaces)


if __name__ == "__main__":
    main()
