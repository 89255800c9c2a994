#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""vtkPentatopeMeshTimeSlice from Python, together with VTK's own classes."""

import itertools
import math
import os
import tempfile
import unittest

from vtkmodules.vtkCommonCore import vtkDoubleArray, vtkIntArray, vtkPoints
from vtkmodules.vtkCommonDataModel import (VTK_POLY_VERTEX, VTK_PYRAMID, VTK_TETRA, VTK_WEDGE,
                                           vtkDataObject, vtkUnstructuredGrid)
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as Pipeline
from vtkmodules.vtkFiltersVerdict import vtkCellSizeFilter
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader, vtkXMLUnstructuredGridWriter
from vtkmodules.util.misc import calldata_type
from vtkmodules.util.vtkConstants import VTK_STRING

import voxplex

FRAMES = (10.0, 12.5, 15.0)  # times of the points
SLANT = 0.1  # points at x = 1 are later by this, except at the two ends


def determinant(rows):
    if len(rows) == 1:
        return rows[0][0]
    return sum((-1) ** i * row[0] * determinant([r[1:] for r in rows[:i] + rows[i + 1:]])
               for i, row in enumerate(rows))


def make_mesh():
    """The unit cube from time 10 to time 15, two layers of 24 pentatopes with labels 1 and 2."""
    points = vtkPoints()
    points.SetDataTypeToDouble()
    times = vtkDoubleArray()
    times.SetName("Time")
    at = {}
    for corner in itertools.product((0, 1), (0, 1), (0, 1), (0, 1, 2)):
        at[corner] = points.InsertNextPoint(corner[:3])
        late = SLANT if corner[0] == 1 and corner[3] == 1 else 0.0
        times.InsertNextValue(FRAMES[corner[3]] + late)
    mesh = vtkUnstructuredGrid()
    mesh.SetPoints(points)
    mesh.GetPointData().AddArray(times)
    labels = vtkIntArray()
    labels.SetName("Label")
    for layer in (0, 1):
        for order in itertools.permutations(range(4)):
            corner = [0, 0, 0, layer]
            ids = [at[tuple(corner)]]
            for axis in order:
                corner[axis] += 1
                ids.append(at[tuple(corner)])
            place = [points.GetPoint(i) + (times.GetValue(i),) for i in ids]
            rows = [[a - b for a, b in zip(p, place[0])] for p in place[1:]]
            if determinant(rows) < 0:
                ids[3], ids[4] = ids[4], ids[3]
            mesh.InsertNextCell(VTK_POLY_VERTEX, 5, ids)
            labels.InsertNextValue(1 + layer)
    mesh.GetCellData().SetScalars(labels)
    return mesh


def volumes(grid):
    """VTK's own measure of each cell."""
    sizes = vtkCellSizeFilter()
    sizes.SetInputData(grid)
    sizes.Update()
    array = sizes.GetOutput().GetCellData().GetArray("Volume")
    return [array.GetValue(i) for i in range(grid.GetNumberOfCells())]


class TimeSlices(unittest.TestCase):
    def check(self, slicer, time):
        grid = slicer.GetOutput()
        self.assertEqual(grid.GetInformation().Get(vtkDataObject.DATA_TIME_STEP()), time)
        self.assertGreater(grid.GetNumberOfCells(), 0)
        self.assertTrue(all(volume > 0 for volume in volumes(grid)))
        self.assertAlmostEqual(sum(volumes(grid)), 1.0)
        self.assertTrue({grid.GetCellType(c) for c in range(grid.GetNumberOfCells())}
                        <= {VTK_TETRA, VTK_WEDGE, VTK_PYRAMID})

    def test_range_and_slices(self):
        slicer = voxplex.vtkPentatopeMeshTimeSlice()
        slicer.SetInputData(make_mesh())
        slicer.UpdateInformation()
        information = slicer.GetOutputInformation(0)
        self.assertEqual(information.Get(Pipeline.TIME_RANGE()), (10.0, 15.0))
        self.assertFalse(information.Has(Pipeline.TIME_STEPS()))
        for time in (10.0, 10.3, 12.5, 12.55, 12.6, 13.1, 15.0):
            with self.subTest(time=time):
                slicer.UpdateTimeStep(time)
                self.check(slicer, time)
        slicer.UpdateTimeStep(99.0)
        self.check(slicer, 15.0)

    def test_slice_time(self):
        slicer = voxplex.vtkPentatopeMeshTimeSlice()
        self.assertTrue(math.isnan(slicer.GetSliceTime()))
        self.assertEqual(slicer.GetTimeArrayName(), "Time")
        slicer.SetInputData(make_mesh())
        slicer.Update()
        self.check(slicer, 10.0)
        slicer.SetSliceTime(13.0)
        slicer.Update()
        self.check(slicer, 13.0)
        self.assertEqual(slicer.GetOutput().GetCellData().GetArray("Label").GetRange(), (2, 2))

    def test_from_a_file(self):
        """A reader knows nothing of the mesh's times, and is asked for the mesh once."""
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "mesh.vtu")
            writer = vtkXMLUnstructuredGridWriter()
            writer.SetInputData(make_mesh())
            writer.SetFileName(path)
            self.assertEqual(writer.Write(), 1)
            reader = vtkXMLUnstructuredGridReader()
            reader.SetFileName(path)
            executions = []
            reader.AddObserver("StartEvent", lambda *_: executions.append(1))
            slicer = voxplex.vtkPentatopeMeshTimeSlice()
            slicer.SetInputConnection(reader.GetOutputPort())
            slicer.UpdateInformation()
            self.assertEqual(
                slicer.GetOutputInformation(0).Get(Pipeline.TIME_RANGE()), (10.0, 15.0))
            for i in range(30):
                time = 10.0 + 5.0 * i / 29
                slicer.UpdateTimeStep(time)
                self.check(slicer, time)
            self.assertEqual(len(executions), 1)

    def test_key(self):
        """What a filter that makes pentatope meshes announces."""
        self.assertEqual(
            voxplex.vtkPentatopeMeshTimeSlice.MESH_TIME_RANGE().GetName(), "MESH_TIME_RANGE")

    def test_error(self):
        slicer = voxplex.vtkPentatopeMeshTimeSlice()
        messages = []

        @calldata_type(VTK_STRING)
        def keep(_caller, _event, text):
            messages.append(text)

        slicer.AddObserver("ErrorEvent", keep)
        slicer.GetExecutive().AddObserver("ErrorEvent", lambda *_: None)
        mesh = make_mesh()
        mesh.GetPointData().RemoveArray("Time")
        slicer.SetInputData(mesh)
        slicer.Update()
        self.assertEqual(len(messages), 1)
        self.assertIn('no numeric point array "Time"', slicer.GetErrorMessage())
        self.assertEqual(slicer.GetOutput().GetNumberOfCells(), 0)


if __name__ == "__main__":
    unittest.main()
