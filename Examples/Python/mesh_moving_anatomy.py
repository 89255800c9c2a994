#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Mesh a segmented time series in space-time and cut the mesh at some times.

    mesh_moving_anatomy.py --output FOLDER [--delta LENGTH] [--time-scale LENGTH] [--slices NUMBER]

The time series is a phantom: a chamber (label 1) in a wall (label 2) that beats once in 9 frames.
"""

import argparse
import os

import numpy

import voxplex

FRAMES = 9


def phantom():
    """28 x 28 x 24 voxels of 1 x 1 x 1.2 mm, every tenth of a second."""
    z, y, x = numpy.meshgrid(1.2 * (numpy.arange(24) - 11.5), numpy.arange(28) - 13.5, numpy.arange(28) - 13.5,
                             indexing="ij")
    frames = []
    for frame in range(FRAMES):
        squeeze = numpy.sin(numpy.pi * frame / (FRAMES - 1)) ** 2
        chamber = numpy.sqrt(x * x + y * y + 0.7 * z * z) < 7.0 - 2.5 * squeeze
        wall = numpy.sqrt(x * x + y * y + 0.7 * z * z) < 10.0 - 1.0 * squeeze
        frames.append(numpy.where(chamber, 1, numpy.where(wall, 2, 0)).astype(numpy.uint8))
    return voxplex.Image(numpy.stack(frames), spacing=(1.0, 1.0, 1.2), times=0.1 * numpy.arange(FRAMES),
                         names={1: "chamber", 2: "wall"})


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--output", required=True)
    parser.add_argument("--delta", type=float, default=2.0)
    parser.add_argument("--time-scale", type=float, default=2.0)
    parser.add_argument("--slices", type=int, default=5)
    arguments = parser.parse_args()
    os.makedirs(arguments.output, exist_ok=True)

    mesh = voxplex.mesh(phantom(), arguments.delta, time_scale=arguments.time_scale)
    print(f"{mesh.statistics['elements']} pentatopes, {mesh.statistics['interface_facets']} boundary tetrahedra")
    mesh.write(os.path.join(arguments.output, "mesh.vtu"))
    for index, time in enumerate(numpy.linspace(mesh.times.min(), mesh.times.max(), arguments.slices)):
        piece = mesh.slice(time)
        piece.write(os.path.join(arguments.output, f"slice{index}.vtu"))
        volumes = ", ".join(f"{mesh.names[label]} {volume:.0f} mm^3" for label, volume in piece.label_volumes().items())
        print(f"  t = {time:.2f} s: {volumes}")


if __name__ == "__main__":
    main()
