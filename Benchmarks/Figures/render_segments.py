#!/usr/bin/python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Draws some labels of a label map as voxels, and beside them the mesh that the module for 3D Slicer made of them, whole and cut open.

usage: render_segments.py LABELS.nii.gz MESH.vtu PICTURE.png

Draws the labels that the mesh has. Needs a display; without one: xvfb-run --auto-servernum Benchmarks/Figures/render_segments.py ...
"""
import sys

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkCommonExecutionModel import vtkTrivialProducer
from vtkmodules.vtkFiltersGeometry import vtkGeometryFilter
from vtkmodules.vtkIOImage import vtkNIFTIImageReader
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

from render_mesh import label_colors, make_actor, make_view, part_of, read, write_picture

SIZE = (1650, 600)


def voxel_faces(path, labels):
    """The faces of the voxels with these labels that other voxels do not hide, in LPS as the mesh."""
    reader = vtkNIFTIImageReader()
    reader.SetFileName(path)
    reader.Update()
    image = reader.GetOutput()
    array = vtk_to_numpy(image.GetPointData().GetScalars()).reshape(image.GetDimensions()[::-1]).astype(int)
    array = np.pad(np.where(np.isin(array, labels), array, 0), 1)
    matrix = reader.GetSFormMatrix() or reader.GetQFormMatrix()
    affine = np.array([[matrix.GetElement(i, j) for j in range(4)] for i in range(3)])
    corners, values = [], []
    for axis in range(3):  # z, y, x
        for side in (-1, 1):
            free = (array > 0) & (np.roll(array, -side, axis) != array)
            voxels = np.argwhere(free)
            u, v = [a for a in range(3) if a != axis]
            for du, dv in ((-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)):
                corner = voxels - 1.0  # the padding
                corner[:, axis] += 0.5 * side
                corner[:, u] += du
                corner[:, v] += dv
                corners.append(corner)
            values.append(array[free])
    quads = np.concatenate([np.stack(corners[4 * i:4 * i + 4], axis=1) for i in range(6)])[:, :, ::-1].reshape(-1, 3)
    ras = quads @ affine[:, :3].T + affine[:, 3]
    return polygons(ras * (-1, -1, 1), np.concatenate(values))


def polygons(points, values):
    data = vtkPolyData()
    places = vtkPoints()
    places.SetData(numpy_to_vtk(points, deep=True))
    data.SetPoints(places)
    cells = vtkCellArray()
    offsets = np.arange(0, len(points) + 1, 4, dtype=np.int64)
    cells.SetData(numpy_to_vtk(offsets, deep=True, array_type=12), numpy_to_vtk(
        np.arange(len(points), dtype=np.int64), deep=True, array_type=12))
    data.SetPolys(cells)
    labels = numpy_to_vtk(values.astype(np.int32), deep=True)
    labels.SetName("Label")
    data.GetCellData().AddArray(labels)
    return data


def producer_of(data):
    producer = vtkTrivialProducer()
    producer.SetOutput(data)
    return producer


def surface_of(mesh):
    surface = vtkGeometryFilter()
    surface.SetInputData(mesh)
    return surface


def main(labels_path, mesh_path, picture_path):
    mesh = read(vtkXMLUnstructuredGridReader(), mesh_path)
    labels = np.unique(vtk_to_numpy(mesh.GetCellData().GetArray("Label")))
    colors = label_colors(int(labels.max()))
    views = []
    for i, (source, text) in enumerate((
            (producer_of(voxel_faces(labels_path, labels)), "label map, %d labels" % len(labels)),
            (surface_of(mesh), "{:,} tetrahedra".format(mesh.GetNumberOfCells())), (part_of(mesh), "cut open"))):
        view = make_view((i / 3, 0.0, (i + 1) / 3, 1.0), make_actor(source, "Label", 0, colors, 0.5), mesh.GetBounds(), text)
        view.GetActiveCamera().Zoom(0.75)  # three views side by side are narrow
        views.append(view)
    write_picture(picture_path, SIZE, views)


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    main(*sys.argv[1:])
