#!/usr/bin/python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Draws time slices of a space-time mesh side by side, each cut open.

usage: render_slices.py SLICES.pvd PICTURE.png [NUMBER]

Takes NUMBER slices (default 8), evenly spaced from the first to the last of the collection.
Needs a display; without one: xvfb-run --auto-servernum Benchmarks/Figures/render_slices.py ...
"""
import os
import sys
import xml.etree.ElementTree

from vtkmodules.vtkCommonDataModel import vtkPlane
from vtkmodules.vtkFiltersGeneral import vtkTableBasedClipDataSet
from vtkmodules.vtkFiltersGeometry import vtkGeometryFilter
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
from vtkmodules.vtkRenderingCore import vtkRenderer, vtkTextActor

from render_mesh import BACKGROUND, EDGES, label_colors, make_actor, read, write_picture

WIDTH, HEIGHT = 220, 330


def list_slices(path):
    """(time, file) of each data set of a ParaView collection."""
    sets = xml.etree.ElementTree.parse(path).iter("DataSet")
    folder = os.path.dirname(path)
    return [(float(s.get("timestep")), os.path.join(folder, s.get("file"))) for s in sets]


def cut_open(mesh, bounds):
    """What lies behind a plane through the middle, across x."""
    plane = vtkPlane()
    plane.SetOrigin((bounds[0] + bounds[1]) / 2, 0, 0)
    plane.SetNormal(-1, 0, 0)
    clip = vtkTableBasedClipDataSet()
    clip.SetInputData(mesh)
    clip.SetClipFunction(plane)
    surface = vtkGeometryFilter()
    surface.SetInputConnection(clip.GetOutputPort())
    return surface


def make_view(index, count, mesh, bounds, colors, text):
    renderer = vtkRenderer()
    renderer.SetViewport(index / count, 0, (index + 1) / count, 1)
    renderer.SetBackground(*BACKGROUND)
    renderer.AddActor(make_actor(cut_open(mesh, bounds), "Label", 0, colors, 0.5))
    caption = vtkTextActor()
    caption.SetInput(text)
    caption.SetPosition(12, 8)
    caption.GetTextProperty().SetFontSize(16)
    caption.GetTextProperty().SetColor(*EDGES)
    renderer.AddViewProp(caption)
    center = [(bounds[2 * a] + bounds[2 * a + 1]) / 2 for a in range(3)]
    camera = renderer.GetActiveCamera()
    camera.SetFocalPoint(*center)
    camera.SetPosition(center[0] + 3, center[1] - 0.6, center[2] + 0.5)
    camera.SetViewUp(0, 0, 1)
    camera.ParallelProjectionOn()
    renderer.ResetCamera(bounds)
    camera.SetParallelScale(0.54 * max(bounds[5] - bounds[4], (bounds[3] - bounds[2]) * HEIGHT / WIDTH))
    return renderer


def main(collection, picture, number=8):
    slices = list_slices(collection)
    if len(slices) < 2:
        sys.exit("render_slices.py: fewer than two slices in %s" % collection)
    count = min(int(number), len(slices))
    chosen = [slices[round(i * (len(slices) - 1) / (count - 1))] for i in range(count)]
    meshes = [(time, read(vtkXMLUnstructuredGridReader(), path)) for time, path in chosen]
    each = [mesh.GetBounds() for _, mesh in meshes if mesh.GetNumberOfCells()]
    if not each:
        sys.exit("render_slices.py: nothing to draw in %s" % collection)
    bounds = [(min if a % 2 == 0 else max)(b[a] for b in each) for a in range(6)]
    last = max(mesh.GetCellData().GetArray("Label").GetRange()[1] for _, mesh in meshes if mesh.GetNumberOfCells())

    colors = label_colors(int(last))
    write_picture(picture, (WIDTH * count, HEIGHT), [
        make_view(index, count, mesh, bounds, colors, "t = %.3g" % time) for index, (time, mesh) in enumerate(meshes)])


if __name__ == "__main__":
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    main(*sys.argv[1:])
