#!/usr/bin/python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Draws the icon of the extension, a triangulated section of two tissues, and puts it where it is used.

usage: draw_icon.py

Writes the icon of the scripted module and the extension (128 x 128).
"""
from pathlib import Path

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkImageData, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkDelaunay2D
from vtkmodules.vtkIOImage import vtkPNGWriter

HERE = Path(__file__).resolve().parent
SIZE, SAMPLES = 128, 8
RINGS = ((0.0, 1), (0.26, 7), (0.5, 13), (0.72, 16), (0.95, 22))  # radius, points
INTERFACE = 0.5  # a radius of RINGS
COLORS = np.array([[221, 110, 78], [244, 205, 138]], dtype=float)  # inside, outside
EDGE = np.array([56, 44, 52], dtype=float)
EDGE_WIDTH = 0.013


def ring_points():
    points = []
    for turn, (radius, count) in enumerate(RINGS):
        angles = 2 * np.pi * (np.arange(count) / count) + 0.35 * turn
        points += [(radius * np.cos(a), radius * np.sin(a)) for a in angles]
    return np.array(points)


def triangulate(points):
    data = vtkPolyData()
    places = vtkPoints()
    places.SetData(numpy_to_vtk(np.column_stack([points, np.zeros(len(points))]), deep=True))
    data.SetPoints(places)
    delaunay = vtkDelaunay2D()
    delaunay.SetInputData(data)
    delaunay.Update()
    return vtk_to_numpy(delaunay.GetOutput().GetPolys().GetConnectivityArray()).reshape(-1, 3)


def draw(size):
    """RGBA, as whole numbers, rows from the top."""
    points = ring_points()
    n = size * SAMPLES
    axis = (np.arange(n) + 0.5) / n * 2 - 1
    x, y = np.meshgrid(axis, -axis)
    color = np.zeros((n, n, 3))
    covered = np.zeros((n, n), dtype=bool)
    edge = np.full((n, n), np.inf)
    for triangle in triangulate(points):
        corners = points[triangle]
        inside = np.ones((n, n), dtype=bool)
        for i in range(3):
            (ax, ay), (bx, by) = corners[i], corners[(i + 1) % 3]
            inside &= (bx - ax) * (y - ay) - (by - ay) * (x - ax) >= 0
            share = np.clip(((x - ax) * (bx - ax) + (y - ay) * (by - ay)) / ((bx - ax) ** 2 + (by - ay) ** 2), 0, 1)
            edge = np.minimum(edge, np.hypot(x - ax - share * (bx - ax), y - ay - share * (by - ay)))
        label = int(np.hypot(*corners.T).max() > INTERFACE + 1e-6)
        color[inside] = COLORS[label] * (0.94 + 0.06 * np.cos(5.0 * corners.sum()))
        covered |= inside
    color[edge < EDGE_WIDTH] = EDGE
    covered |= edge < EDGE_WIDTH
    alpha = covered.reshape(size, SAMPLES, size, SAMPLES).mean(axis=(1, 3))
    total = (color * covered[..., None]).reshape(size, SAMPLES, size, SAMPLES, 3).mean(axis=(1, 3))
    rgb = np.divide(total, alpha[..., None], out=np.zeros_like(total), where=alpha[..., None] > 0)
    return np.dstack([rgb, 255 * alpha]).round().astype(np.uint8)


def write_png(pixels, path):
    image = vtkImageData()
    image.SetDimensions(pixels.shape[1], pixels.shape[0], 1)
    image.GetPointData().SetScalars(numpy_to_vtk(pixels[::-1].reshape(-1, 4), deep=True))
    writer = vtkPNGWriter()
    writer.SetInputData(image)
    writer.SetFileName(str(path))
    writer.Write()


def main():
    write_png(draw(SIZE), HERE.parent / "VoxplexMesher" / "Resources" / "Icons" / "VoxplexMesher.png")


if __name__ == "__main__":
    main()
