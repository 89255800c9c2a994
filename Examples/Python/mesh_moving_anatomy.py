#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Mesh a segmented time series in space-time and cut the mesh at some times.

    mesh_moving_anatomy.py --output FOLDER [--delta LENGTH] [--time-scale LENGTH] [--slices NUMBER]

The time series is a phantom: a chamber (label 1) in a wall (label 2) that beats once in 9 frames.
"""

import argparse
import json
import os
import sys

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkFiltersVerdict import vtkCellSizeFilter
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter

import voxplex

FRAMES = 9


def phantom():
    """28 x 28 x 24 voxels of 1 x 1 x 1.2 mm; the frames are the components of one array."""
    z, y, x = numpy.meshgrid(1.2 * (numpy.arange(24) - 11.5), numpy.arange(28) - 13.5, numpy.arange(28) - 13.5,
                             indexing="ij")
    frames = []
    for frame in range(FRAMES):
        squeeze = numpy.sin(numpy.pi * frame / (FRAMES - 1)) ** 2
        chamber = numpy.sqrt(x * x + y * y + 0.7 * z * z) < 7.0 - 2.5 * squeeze
        wall = numpy.sqrt(x * x + y * y + 0.7 * z * z) < 10.0 - 1.0 * squeeze
        frames.append(numpy.where(chamber, 1, numpy.where(wall, 2, 0)).astype(numpy.uint8).ravel())
    image = vtkImageData()
    image.SetDimensions(28, 28, 24)
    image.SetSpacing(1.0, 1.0, 1.2)
    image.GetPointData().SetScalars(numpy_to_vtk(numpy.stack(frames, axis=1), deep=True))
    return image


def volumes(grid):
    """Volume of each label of a slice."""
    sizes = vtkCellSizeFilter()
    sizes.SetInputData(grid)
    sizes.Update()
    cells = sizes.GetOutput().GetCellData()
    sums = {}
    for cell in range(sizes.GetOutput().GetNumberOfCells()):
        label = int(cells.GetArray("Label").GetTuple1(cell))
        sums[label] = sums.get(label, 0.0) + cells.GetArray("Volume").GetTuple1(cell)
    return sums


def write(grid, path):
    writer = vtkXMLUnstructuredGridWriter()
    writer.SetInputData(grid)
    writer.SetFileName(path)
    if not writer.Write():
        sys.exit(f"{path}: could not be written")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--output", required=True)
    parser.add_argument("--delta", type=float, default=2.0)
    parser.add_argument("--time-scale", type=float, default=2.0)
    parser.add_argument("--slices", type=int, default=5)
    arguments = parser.parse_args()
    os.makedirs(arguments.output, exist_ok=True)

    mesher = voxplex.vtkImageToPentatopeMeshFilter()
    mesher.SetInputData(phantom())
    mesher.SetDelta(arguments.delta)
    mesher.SetTimeScale(arguments.time_scale)
    mesher.SetTimeSpacing(0.1)  # seconds from frame to frame
    mesher.ComputeQualityOn()
    mesher.Update()
    if mesher.GetErrorMessage():
        sys.exit(mesher.GetErrorMessage())
    figures = json.loads(mesher.GetStatistics().ToJSON())
    print(f"{figures['elements']} pentatopes, {figures['interface_facets']} boundary tetrahedra")
    write(mesher.GetOutput(), os.path.join(arguments.output, "mesh.vtu"))

    slicer = voxplex.vtkPentatopeMeshTimeSlice()
    slicer.SetInputConnection(mesher.GetOutputPort())
    for index in range(arguments.slices):
        time = 0.1 * (FRAMES - 1) * index / max(1, arguments.slices - 1)
        slicer.UpdateTimeStep(time)
        write(slicer.GetOutput(), os.path.join(arguments.output, f"slice{index}.vtu"))
        sums = volumes(slicer.GetOutput())
        print(f"  t = {time:.2f} s: chamber {sums.get(1, 0.0):.0f} mm^3, wall {sums.get(2, 0.0):.0f} mm^3")


if __name__ == "__main__":
    main()
