#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""vtkImageToPentatopeMeshFilter from Python: time steps, components, outputs, times, misuse."""
import json
import math
import unittest

from vtkmodules.vtkCommonCore import vtkIdList, vtkUnsignedCharArray
from vtkmodules.vtkCommonDataModel import (
    VTK_POLY_VERTEX, VTK_TETRA, vtkDataObject, vtkImageData)
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as Pipeline
from vtkmodules.util.misc import calldata_type
from vtkmodules.util.vtkAlgorithm import VTKPythonAlgorithmBase
from vtkmodules.util.vtkConstants import VTK_STRING

import voxplex

N = 10
CENTRE = 0.5 * (N - 1)
RADIUS = 3.6
TIMES = [2.0 + 0.5 * k for k in range(N)]


def label(i, j, k, frame):
    """A 4-ball, label 3 on the left, 7 on the right."""
    if math.dist((i, j, k, frame), (CENTRE,) * 4) >= RADIUS:
        return 0
    return 3 if i < CENTRE else 7


def make_image(frames):
    """A cube of N voxels with a component for each frame."""
    scalars = vtkUnsignedCharArray()
    scalars.SetName("Segmentation")
    scalars.SetNumberOfComponents(len(frames))
    scalars.SetNumberOfTuples(N ** 3)
    for voxel in range(N ** 3):
        i, j, k = voxel % N, voxel // N % N, voxel // N ** 2
        for component, frame in enumerate(frames):
            scalars.SetComponent(voxel, component, label(i, j, k, frame))
    image = vtkImageData()
    image.SetDimensions(N, N, N)
    image.GetPointData().SetScalars(scalars)
    return image


class Beating(VTKPythonAlgorithmBase):
    """A temporal source of the frames, as a reader of a time series is one."""

    def __init__(self, times=TIMES):
        super().__init__(nInputPorts=0, nOutputPorts=1, outputType="vtkImageData")
        self.times = list(times)
        self.asked = []
        self.frames = [make_image([frame]) for frame in range(len(self.times))]

    def RequestInformation(self, _request, _inputs, outputs):
        info = outputs.GetInformationObject(0)
        info.Set(Pipeline.WHOLE_EXTENT(), (0, N - 1) * 3, 6)
        info.Set(Pipeline.TIME_STEPS(), self.times, len(self.times))
        info.Set(Pipeline.TIME_RANGE(), [self.times[0], self.times[-1]], 2)
        return 1

    def RequestData(self, _request, _inputs, outputs):
        info = outputs.GetInformationObject(0)
        time = info.Get(Pipeline.UPDATE_TIME_STEP())
        self.asked.append(time)
        output = vtkImageData.GetData(outputs)
        output.ShallowCopy(self.frames[self.times.index(time)])
        output.GetInformation().Set(vtkDataObject.DATA_TIME_STEP(), time)
        return 1


def make_filter(source=None, image=None):
    mesher = voxplex.vtkImageToPentatopeMeshFilter()
    if source is not None:
        mesher.SetInputConnection(source.GetOutputPort())
    else:
        mesher.SetInputData(image)
        mesher.SetTimeOrigin(TIMES[0])
        mesher.SetTimeSpacing(TIMES[1] - TIMES[0])
    mesher.SetTimeScale(2.0)
    mesher.SetNumberOfThreads(1)
    return mesher


def cells(grid):
    """The corners (x, y, z, t) of each cell."""
    times = grid.GetPointData().GetArray("Time")
    ids = vtkIdList()
    for cell in range(grid.GetNumberOfCells()):
        grid.GetCellPoints(cell, ids)
        yield [grid.GetPoint(ids.GetId(i)) + (times.GetValue(ids.GetId(i)),)
               for i in range(ids.GetNumberOfIds())]


def determinant(rows):
    if len(rows) == 1:
        return rows[0][0]
    return sum((-1) ** c * rows[0][c] * determinant([row[:c] + row[c + 1:] for row in rows[1:]])
               for c in range(len(rows)))


def hypervolume(corners):
    return determinant([[p - q for p, q in zip(corner, corners[0])]
                        for corner in corners[1:]]) / 24.0


class Outputs(unittest.TestCase):
    def setUp(self):
        self.mesher = make_filter(Beating())
        self.mesher.SetDelta(0.9)
        self.mesher.SetSmoothingSigma(0.5)
        self.mesher.ComputeQualityOn()
        self.mesher.Update()
        self.assertEqual(self.mesher.GetErrorMessage(), "")

    def test_mesh(self):
        mesh = self.mesher.GetOutput()
        self.assertGreater(mesh.GetNumberOfCells(), 100)
        self.assertEqual(
            {mesh.GetCellType(c) for c in range(mesh.GetNumberOfCells())}, {VTK_POLY_VERTEX})
        labels = mesh.GetCellData().GetArray("Label")
        self.assertEqual({labels.GetValue(c) for c in range(mesh.GetNumberOfCells())}, {3, 7})
        volumes = [hypervolume(corners) for corners in cells(mesh)]
        self.assertGreater(min(volumes), 0.0)
        voxels = sum(label(i, j, k, frame) > 0 for i in range(N) for j in range(N)
                     for k in range(N) for frame in range(N))
        truth = 0.5 * voxels  # frames are half a unit of time apart
        self.assertLess(abs(sum(volumes) / truth - 1.0), 0.25)  # chords of a small ball

    def test_boundary(self):
        boundary = self.mesher.GetBoundary()
        self.assertEqual(boundary.GetNumberOfCells(),
                         self.mesher.GetBoundaryPort().GetProducer().GetOutputDataObject(1)
                         .GetNumberOfCells())
        self.assertEqual(
            {boundary.GetCellType(c) for c in range(boundary.GetNumberOfCells())}, {VTK_TETRA})
        labels = boundary.GetCellData().GetArray("Labels")
        pairs = {labels.GetTuple2(c) for c in range(boundary.GetNumberOfCells())}
        self.assertEqual(pairs, {(3.0, 0.0), (7.0, 0.0), (7.0, 3.0)})
        mesh = self.mesher.GetOutput()
        ids = boundary.GetPointData().GetArray("PointIds")
        for point in range(boundary.GetNumberOfPoints()):
            self.assertEqual(boundary.GetPoint(point), mesh.GetPoint(ids.GetValue(point)))
            self.assertEqual(boundary.GetPointData().GetArray("Time").GetValue(point),
                             mesh.GetPointData().GetArray("Time").GetValue(ids.GetValue(point)))

    def test_statistics(self):
        statistics = self.mesher.GetStatistics()
        figures = json.loads(statistics.ToJSON())
        self.assertEqual(figures["dimension"], 4)
        self.assertEqual(figures["elements"], self.mesher.GetOutput().GetNumberOfCells())
        self.assertEqual(
            figures["interface_facets"], self.mesher.GetBoundary().GetNumberOfCells())
        self.assertEqual(set(figures["labels"]), {"3", "7"})
        quality = figures["quality"]
        self.assertLessEqual(quality["max_radius_edge"], 2.0)
        self.assertEqual(quality["shortest_edge"], statistics.GetFigure("/quality/shortest_edge"))
        self.assertEqual(quality["mean_radius_edge"], statistics.GetFigure("/quality/mean_radius_edge"))
        self.assertEqual(
            quality["radius_edge_deviation"], statistics.GetFigure("/quality/radius_edge_deviation"))
        self.assertEqual(sum(quality["normalized_volume_histogram"]), figures["elements"])
        self.assertEqual(len(quality["normalized_volume_histogram"]),
                         statistics.GetFigure("/quality/normalized_volume_histogram"))
        self.assertIsNone(quality["min_dihedral"])

    def test_repr(self):
        self.assertIn("TimeScale: 2", str(self.mesher))
        self.assertIn("pentatopes", voxplex.vtkImageToPentatopeMeshFilter.__doc__)


class Inputs(unittest.TestCase):
    def test_both_kinds(self):
        source = Beating()
        series = make_filter(source)
        series.Update()
        self.assertEqual(source.asked, TIMES)
        components = make_filter(image=make_image(range(N)))
        components.Update()
        self.assertEqual(components.GetErrorMessage(), "")
        self.assertEqual(list(cells(series.GetOutput())), list(cells(components.GetOutput())))
        self.assertEqual(list(cells(series.GetBoundary())), list(cells(components.GetBoundary())))

    def test_time_requests(self):
        source = Beating()
        mesher = make_filter(source)
        mesher.UpdateInformation()
        info = mesher.GetOutputInformation(0)
        self.assertFalse(info.Has(Pipeline.TIME_STEPS()))
        self.assertEqual(info.Get(Pipeline.TIME_RANGE()), (TIMES[0], TIMES[-1]))
        for time in (TIMES[3], TIMES[3] + 0.1, TIMES[-1]):
            mesher.UpdateTimeStep(time)
        self.assertEqual(source.asked, TIMES)
        self.assertGreater(mesher.GetOutput().GetNumberOfCells(), 0)

    def test_slices(self):
        source = Beating()
        mesher = make_filter(source)
        slicer = voxplex.vtkPentatopeMeshTimeSlice()
        slicer.SetInputConnection(mesher.GetOutputPort())
        slicer.UpdateInformation()
        info = slicer.GetOutputInformation(0)
        self.assertEqual(info.Get(Pipeline.TIME_RANGE()), (TIMES[0], TIMES[-1]))
        middle = 0.5 * (TIMES[0] + TIMES[-1])
        for time in (middle, middle + 0.3, middle - 0.3):
            slicer.UpdateTimeStep(time)
            self.assertGreater(slicer.GetOutput().GetNumberOfCells(), 0)
        self.assertEqual(source.asked, TIMES)  # meshed once

    def test_flat_ends(self):
        mesher = make_filter(Beating(TIMES[:5]))  # cut in the middle of the ball
        mesher.Update()
        self.assertEqual(mesher.GetOutput().GetPointData().GetArray("Time").GetRange()[1], TIMES[4])

    def test_sizes(self):
        mesher = make_filter(Beating())
        mesher.SetDelta(3.0)
        mesher.Update()
        coarse = mesher.GetOutput().GetNumberOfCells()
        mesher.SetLabelSize(7, 1.5)
        mesher.Update()
        self.assertGreater(mesher.GetOutput().GetNumberOfCells(), coarse)
        mesher.SetLabelSize(5, 1.0)
        mesher.GlobalWarningDisplayOff()
        self.addCleanup(mesher.GlobalWarningDisplayOn)
        mesher.Update()
        self.assertIn("label 5", mesher.GetErrorMessage())


class Behaviour(unittest.TestCase):
    def test_properties(self):
        mesher = voxplex.vtkImageToPentatopeMeshFilter()
        self.assertIsInstance(mesher, voxplex.vtkImageToSimplexMeshFilter)
        self.assertEqual(mesher.GetTimeScale(), 1.0)
        self.assertEqual((mesher.GetTimeOrigin(), mesher.GetTimeSpacing()), (0.0, 1.0))
        self.assertEqual(mesher.GetRuleOrder(), mesher.RADIUS_EDGE_FIRST)
        self.assertEqual(mesher.GetRuleOrderAsString(), "radius-edge-first")
        mesher.SetRuleOrderToSurfaceFirst()
        self.assertEqual(mesher.GetRuleOrder(), mesher.SURFACE_FIRST)
        self.assertEqual(mesher.GetRuleOrderAsString(), "surface-first")
        self.assertTrue(mesher.GetPickingRegions())
        mesher.PickingRegionsOff()
        self.assertFalse(mesher.GetPickingRegions())
        self.assertEqual(mesher.GetContentionManager(), mesher.CONTENTION_LOCAL)
        with self.assertRaises(TypeError):
            mesher.SetTimeScale("fast")
        with self.assertRaises(AttributeError):
            mesher.SetTimescale(1.0)
        with self.assertRaises(TypeError):  # abstract
            voxplex.vtkImageToSimplexMeshFilter()

    def test_errors(self):
        cases = [
            (Beating(TIMES[:1]), "vtkImageToTetMeshFilter"),
            (Beating([0.0, 1.0, 1.0, 2.0]), "must increase"),
            (Beating([0.0, 1.0, 2.0, 2.0001]), "too near each other"),
        ]
        different = Beating()
        different.frames[4].SetSpacing(1, 2, 1)
        cases.append((different, "frame 4"))
        for source, words in cases:
            with self.subTest(words):
                mesher = make_filter(source)
                messages = []

                @calldata_type(VTK_STRING)
                def keep(_caller, _event, text):
                    messages.append(text)

                @calldata_type(VTK_STRING)
                def ignore(_caller, _event, _text):
                    pass

                mesher.AddObserver("ErrorEvent", keep)
                mesher.GetExecutive().AddObserver("ErrorEvent", ignore)
                mesher.Update()
                self.assertEqual(len(messages), 1)
                self.assertIn(words, messages[0])
                self.assertIn(words, mesher.GetErrorMessage())
                self.assertEqual(mesher.GetOutput().GetNumberOfCells(), 0)
                self.assertEqual(mesher.GetBoundary().GetNumberOfCells(), 0)

    def test_abort_while_gathering(self):
        source = Beating()
        mesher = make_filter(source)

        def stop(caller, _event):
            if len(source.asked) == 4:
                caller.SetAbortExecute(1)

        observer = mesher.AddObserver("ProgressEvent", stop)
        mesher.Update()
        self.assertTrue(mesher.GetAborted())
        self.assertEqual(source.asked, TIMES[:4])
        self.assertEqual(mesher.GetOutput().GetNumberOfCells(), 0)
        mesher.RemoveObserver(observer)
        mesher.Modified()
        source.asked.clear()
        mesher.Update()
        self.assertGreater(mesher.GetOutput().GetNumberOfCells(), 0)
        self.assertEqual(sorted(source.asked)[0], TIMES[0])


if __name__ == "__main__":
    unittest.main()
