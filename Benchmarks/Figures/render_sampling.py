#!/usr/bin/python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Draws meshes of the AAL brain atlas that differ in their sampling distance, side by side, cut open around a putamen.

usage: render_sampling.py PICTURE.png DELTA=MESH.vtu...

Needs a display; without one: xvfb-run --auto-servernum Benchmarks/Figures/render_sampling.py ...
"""
import sys

from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

from render_mesh import label_colors, make_actor, make_view, part_of, read, write_picture

WIDTH, HEIGHT = 460, 460  # of each view
# What the views show, in LPS: the left putamen and what lies around it.
REGION = (0, 30, -35, 25, -25, 25)


def main(picture_path, meshes):
    views = []
    for i, (delta, path) in enumerate(meshes):
        mesh = read(vtkXMLUnstructuredGridReader(), path)
        if not mesh.GetNumberOfCells():
            sys.exit("render_sampling.py: nothing to draw in %s" % path)
        colors = label_colors(int(mesh.GetCellData().GetArray("Label").GetRange()[1]))
        views.append(make_view((i / len(meshes), 0.0, (i + 1) / len(meshes), 1.0),
                               make_actor(part_of(mesh), "Label", 0, colors, 1.0), REGION, "delta %s" % delta))
    write_picture(picture_path, (WIDTH * len(meshes), HEIGHT), views)


if __name__ == "__main__":
    if len(sys.argv) < 3 or any("=" not in mesh for mesh in sys.argv[2:]):
        sys.exit(__doc__)
    main(sys.argv[1], [mesh.split("=", 1) for mesh in sys.argv[2:]])
