#!/usr/bin/python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Draws organs of a mesh twice, with the axes of LPS and of RAS: the picture of Documentation/Spaces.md.

usage: render_spaces.py MESH.vtu PICTURE.png

The mesh, in LPS, is that of Examples/Python/mesh_masks.py. Needs a display; without one: xvfb-run --auto-servernum
Benchmarks/Figures/render_spaces.py ...
"""
import sys

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkDataObject
from vtkmodules.vtkCommonTransforms import vtkTransform
from vtkmodules.vtkFiltersCore import vtkAppendFilter, vtkThreshold
from vtkmodules.vtkFiltersGeometry import vtkGeometryFilter
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
from vtkmodules.vtkRenderingAnnotation import vtkAxesActor
from vtkmodules.vtkRenderingCore import vtkTextActor

from render_mesh import EDGES, label_colors, make_actor, make_view, read, write_picture

SIZE = (1200, 640)
ORGANS = ("liver", "heart", "stomach", "spleen", "kidney", "hip", "sacrum", "vertebrae_T", "vertebrae_L")  # how their names begin
SPACES = (("LPS", (1, 1, 1), "x to the left, y to the back"), ("RAS", (-1, -1, 1), "x to the right, y to the front"))


def labels_of(mesh):
    """By name."""
    fields = mesh.GetFieldData()
    names = bytes(vtk_to_numpy(fields.GetArray("LabelNames"))).decode().split("\0")
    return dict(zip(names, vtk_to_numpy(fields.GetArray("LabelValues")).tolist()))


def part_with(mesh, label):
    part = vtkThreshold()
    part.SetInputData(mesh)
    part.SetInputArrayToProcess(0, 0, 0, vtkDataObject.FIELD_ASSOCIATION_CELLS, "Label")
    part.SetThresholdFunction(vtkThreshold.THRESHOLD_BETWEEN)
    part.SetLowerThreshold(label)
    part.SetUpperThreshold(label)
    part.Update()
    return part.GetOutput()


def axes(signs, bounds):
    """Beside the patient's feet, in LPS."""
    actor = vtkAxesActor()
    actor.SetTotalLength(110, 110, 110)
    actor.SetShaftTypeToCylinder()
    transform = vtkTransform()
    transform.Translate((-165 if signs[0] > 0 else 165), 0, bounds[4] - 50)
    transform.Scale(*signs)
    actor.SetUserTransform(transform)
    for letter, caption in zip("xyz", (actor.GetXAxisCaptionActor2D(), actor.GetYAxisCaptionActor2D(),
                                       actor.GetZAxisCaptionActor2D())):
        getattr(actor, f"Set{letter.upper()}AxisLabelText")(letter)
        caption.GetTextActor().SetTextScaleModeToNone()
        caption.GetCaptionTextProperty().SetFontSize(24)
        caption.GetCaptionTextProperty().SetColor(*EDGES)
    return actor


def mark(text, x):
    actor = vtkTextActor()
    actor.SetInput(text)
    actor.GetPositionCoordinate().SetCoordinateSystemToNormalizedViewport()
    actor.SetPosition(x, 0.55)
    actor.GetTextProperty().SetFontSize(64)
    actor.GetTextProperty().SetColor(*EDGES)
    return actor


def main(mesh_path, picture_path):
    mesh = read(vtkXMLUnstructuredGridReader(), mesh_path)
    labels = labels_of(mesh)
    organs = vtkAppendFilter()
    for name, label in labels.items():
        if name.startswith(ORGANS):
            organs.AddInputData(part_with(mesh, label))
    surface = vtkGeometryFilter()
    surface.SetInputConnection(organs.GetOutputPort())
    surface.Update()
    bounds = surface.GetOutput().GetBounds()
    liver = np.array(part_with(mesh, labels["liver"]).GetCenter())
    colors = label_colors(max(labels.values()))
    views = []
    for i, (space, signs, text) in enumerate(SPACES):
        place = ", ".join("%.0f" % coordinate for coordinate in liver * signs)
        view = make_view((i / 2, 0.0, (i + 1) / 2, 1.0), make_actor(surface, "Label", 0, colors, 0.5), bounds,
                         f"{space}: {text}, z to the head\nthe middle of the liver is at {place}")
        view.AddActor(axes(signs, bounds))
        view.AddViewProp(mark("R", 0.04))
        view.AddViewProp(mark("L", 0.9))
        camera = view.GetActiveCamera()
        center = camera.GetFocalPoint()
        camera.SetPosition(center[0], center[1] - 3, center[2] + 0.9)  # from the front, and a little from above
        view.ResetCamera(-200, 200, *bounds[2:4], bounds[4] - 110, bounds[5])
        camera.Zoom(1.25)
        views.append(view)
    write_picture(picture_path, SIZE, views)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
