#!/usr/bin/python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Draws a mesh and its interfaces: from outside, and cut open.

usage: render_mesh.py MESH.vtu INTERFACES.vtp PICTURE.png

Needs a display; without one: xvfb-run --auto-servernum Benchmarks/Figures/render_mesh.py ...
"""
import colorsys
import sys

import vtkmodules.vtkRenderingFreeType  # noqa: F401 (registers the text renderer)
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401 (registers the OpenGL classes)
from vtkmodules.vtkCommonCore import vtkLookupTable
from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkPlane
from vtkmodules.vtkFiltersCore import vtkThreshold
from vtkmodules.vtkFiltersExtraction import vtkExtractGeometry
from vtkmodules.vtkFiltersGeometry import vtkGeometryFilter
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLUnstructuredGridReader
from vtkmodules.vtkRenderingCore import (vtkActor, vtkPolyDataMapper, vtkRenderer, vtkRenderWindow, vtkTextActor,
                                         vtkWindowToImageFilter)

SIZE = (1600, 800)
BACKGROUND = (1.0, 1.0, 1.0)
EDGES = (0.15, 0.15, 0.15)


def read(reader, path):
    reader.SetFileName(path)
    reader.Update()
    return reader.GetOutput()


def label_colors(last):
    """Neighbouring labels get hues far from each other (golden ratio)."""
    table = vtkLookupTable()
    table.SetNumberOfTableValues(last + 1)
    table.SetTableRange(0, last)
    for label in range(last + 1):
        hue = (label * 0.618034) % 1.0
        saturation, value = (0.45, 0.95) if label % 2 else (0.62, 0.82)
        table.SetTableValue(label, *colorsys.hsv_to_rgb(hue, saturation, value), 1.0)
    return table


def make_actor(source, array, component, colors, edge_width):
    mapper = vtkPolyDataMapper()
    mapper.SetInputConnection(source.GetOutputPort())
    mapper.SetScalarModeToUseCellFieldData()
    mapper.SelectColorArray(array)
    mapper.SetArrayComponent(component)
    mapper.SetLookupTable(colors)
    mapper.UseLookupTableScalarRangeOn()
    actor = vtkActor()
    actor.SetMapper(mapper)
    appearance = actor.GetProperty()
    appearance.EdgeVisibilityOn()
    appearance.SetEdgeColor(*EDGES)
    appearance.SetLineWidth(edge_width)
    appearance.SetAmbient(0.25)
    appearance.SetDiffuse(0.75)
    return actor


def outer_surface(interfaces):
    """The triangles that have background on one side."""
    threshold = vtkThreshold()
    threshold.SetInputData(interfaces)
    threshold.SetInputArrayToProcess(0, 0, 0, vtkDataObject.FIELD_ASSOCIATION_CELLS, "Labels")
    threshold.SetComponentModeToUseSelected()
    threshold.SetSelectedComponent(1)
    threshold.SetThresholdFunction(vtkThreshold.THRESHOLD_LOWER)
    threshold.SetLowerThreshold(0.5)
    surface = vtkGeometryFilter()
    surface.SetInputConnection(threshold.GetOutputPort())
    return surface


def part_of(mesh):
    """The elements that lie wholly behind a plane beside the middle, so that they show whole."""
    low, high = mesh.GetBounds()[:2]
    plane = vtkPlane()
    plane.SetOrigin(low + 0.65 * (high - low), 0, 0)
    plane.SetNormal(1, 0, 0)
    part = vtkExtractGeometry()
    part.SetInputData(mesh)
    part.SetImplicitFunction(plane)
    part.ExtractInsideOn()
    part.ExtractBoundaryCellsOff()
    surface = vtkGeometryFilter()
    surface.SetInputConnection(part.GetOutputPort())
    return surface


def make_view(viewport, actor, bounds, text):
    renderer = vtkRenderer()
    renderer.SetViewport(*viewport)
    renderer.SetBackground(*BACKGROUND)
    renderer.AddActor(actor)
    caption = vtkTextActor()
    caption.SetInput(text)
    caption.SetPosition(16, 12)
    caption.GetTextProperty().SetFontSize(18)
    caption.GetTextProperty().SetColor(*EDGES)
    renderer.AddViewProp(caption)
    # From the side of the cut, a little from the front and above (LPS: x left, y back, z up).
    center = [(bounds[2 * a] + bounds[2 * a + 1]) / 2 for a in range(3)]
    camera = renderer.GetActiveCamera()
    camera.SetFocalPoint(*center)
    camera.SetPosition(center[0] + 3, center[1] - 1, center[2] + 1)
    camera.SetViewUp(0, 0, 1)
    renderer.ResetCamera(bounds)
    camera.Zoom(1.35)
    return renderer


def write_picture(path, size, views):
    """Draws the views into a PNG file of this size in pixels."""
    window = vtkRenderWindow()
    window.SetOffScreenRendering(True)
    window.SetSize(*size)
    window.SetMultiSamples(8)
    for view in views:
        window.AddRenderer(view)
    window.Render()
    image = vtkWindowToImageFilter()
    image.SetInput(window)
    writer = vtkPNGWriter()
    writer.SetFileName(path)
    writer.SetInputConnection(image.GetOutputPort())
    writer.Write()


def main(mesh_path, interfaces_path, picture_path):
    mesh = read(vtkXMLUnstructuredGridReader(), mesh_path)
    interfaces = read(vtkXMLPolyDataReader(), interfaces_path)
    if not mesh.GetNumberOfCells() or not interfaces.GetNumberOfCells():
        sys.exit("render_mesh.py: nothing to draw in %s or %s" % (mesh_path, interfaces_path))
    colors = label_colors(int(mesh.GetCellData().GetArray("Label").GetRange()[1]))
    bounds = mesh.GetBounds()
    write_picture(picture_path, SIZE, [
        make_view((0.0, 0.0, 0.5, 1.0), make_actor(outer_surface(interfaces), "Labels", 0, colors, 1.0), bounds,
                  "{:,} interface triangles".format(interfaces.GetNumberOfCells())),
        make_view((0.5, 0.0, 1.0, 1.0), make_actor(part_of(mesh), "Label", 0, colors, 1.0), bounds,
                  "{:,} tetrahedra, cut open".format(mesh.GetNumberOfCells()))])


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    main(*sys.argv[1:])
