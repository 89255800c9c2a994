#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""vtkPentatopeMeshTimeSlice in a temporal pipeline: times, executions, arrays, errors, abort. The mesh is the box [0, 2]^3
from time 0 to time 2, label 1 where x < 1 and label 2 elsewhere, in Kuhn's subdivision of unit cubes."""
import itertools
import math
import unittest

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.util.vtkAlgorithm import VTKPythonAlgorithmBase
from vtkmodules.vtkCommonCore import VTK_DOUBLE, VTK_FLOAT, vtkPoints, vtkStringArray
from vtkmodules.vtkCommonDataModel import (VTK_HEXAHEDRON, VTK_POLY_VERTEX, VTK_PYRAMID, VTK_TETRA, VTK_TRIANGLE,
                                           vtkDataObject, vtkUnstructuredGrid)
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as Pipeline

import voxplex
from filter_testing import add_array as add, errors_of

N = 3  # points along each axis
LATTICE = numpy.array(list(itertools.product(range(N), repeat=4)), dtype=float)[:, ::-1]  # x, y, z, time


def kuhn():
    """Pentatopes in positive order."""
    for first in numpy.flatnonzero(LATTICE.max(axis=1) < N - 1):
        for steps in itertools.permutations((1, N, N * N, N ** 3)):
            ids = first + numpy.cumsum((0, *steps))
            is_positive = numpy.linalg.det(LATTICE[ids[1:]] - LATTICE[ids[0]]) > 0
            yield ids if is_positive else ids[[1, 0, 2, 3, 4]]


CELLS = numpy.array(list(kuhn()))
LABELS = numpy.where(LATTICE[CELLS, 0].max(axis=1) < 1.5, 1, 2).astype(numpy.int32)


def linear(points, time):
    return 1 + points @ (1, -2, 3) + 5 * time


def grid_of(points, cells, kind):
    """Points are x, y, z, time."""
    places = vtkPoints()
    places.SetData(numpy_to_vtk(points[:, :3].copy(), deep=True))
    grid = vtkUnstructuredGrid()
    grid.SetPoints(places)
    add(grid.GetPointData(), "Time", points[:, 3].copy())
    for cell in cells:
        grid.InsertNextCell(kind, len(cell), cell)
    return grid


def pentatopes():
    grid = grid_of(LATTICE, CELLS, VTK_POLY_VERTEX)
    add(grid.GetPointData(), "Field", linear(LATTICE[:, :3], LATTICE[:, 3]))
    add(grid.GetPointData(), "PointIds", numpy.arange(len(LATTICE)))
    grid.GetCellData().SetScalars(add(grid.GetCellData(), "Label", LABELS))
    space = vtkStringArray()
    space.SetName("SPACE")
    space.InsertNextValue("LPS")
    grid.GetFieldData().AddArray(space)
    return grid


def boundary():
    """Its tetrahedra, those between the labels too."""
    sides = {}
    for cell, label in zip(CELLS, LABELS):
        for left in range(5):
            facet = numpy.delete(cell, left)[[1, 0, 2, 3] if left % 2 else [0, 1, 2, 3]]
            sides.setdefault(frozenset(facet), []).append((label, tuple(facet)))
    found = [sorted(pair, reverse=True) + [(0, None)] for pair in sides.values()]
    found = [(pair[0][1], (pair[0][0], pair[1][0])) for pair in found if pair[0][0] != pair[1][0]]
    grid = grid_of(LATTICE, [facet for facet, _ in found], VTK_TETRA)
    add(grid.GetCellData(), "Labels", numpy.array([labels for _, labels in found]))
    return grid


class Source(VTKPythonAlgorithmBase):
    """Makes the mesh and counts how often, and how often it is asked for a certain time."""

    def __init__(self, knows_range=False, is_temporal=False, is_empty=False):
        super().__init__(nInputPorts=0, nOutputPorts=1, outputType="vtkUnstructuredGrid")
        self.knows_range, self.is_temporal, self.is_empty = knows_range, is_temporal, is_empty
        self.executions = self.requests = 0

    def RequestInformation(self, _request, _inputs, outputs):
        info = outputs.GetInformationObject(0)
        if self.knows_range:
            info.Set(voxplex.vtkPentatopeMeshTimeSlice.MESH_TIME_RANGE(), (0.0, 2.0), 2)
        if self.is_temporal:  # times that have nothing to do with the mesh
            info.Set(Pipeline.TIME_STEPS(), (50.0, 60.0, 70.0), 3)
            info.Set(Pipeline.TIME_RANGE(), (50.0, 70.0), 2)
        return 1

    def RequestData(self, _request, _inputs, outputs):
        self.executions += 1
        self.requests += outputs.GetInformationObject(0).Has(Pipeline.UPDATE_TIME_STEP())
        if not self.is_empty:
            vtkUnstructuredGrid.GetData(outputs).ShallowCopy(pentatopes())
        return 1


class Pass(VTKPythonAlgorithmBase):
    """Hands on the mesh and its range."""

    def __init__(self):
        super().__init__(1, "vtkUnstructuredGrid", 1, "vtkUnstructuredGrid")

    def RequestInformation(self, _request, inputs, outputs):
        outputs.GetInformationObject(0).CopyEntry(inputs[0].GetInformationObject(0),
                                                  voxplex.vtkPentatopeMeshTimeSlice.MESH_TIME_RANGE())
        return 1

    def RequestData(self, _request, inputs, outputs):
        vtkUnstructuredGrid.GetData(outputs).ShallowCopy(vtkUnstructuredGrid.GetData(inputs[0]))
        return 1


class SliceTestCase(unittest.TestCase):
    def slicer(self, source):
        """Of a mesh, or of an algorithm that makes it."""
        slicer = voxplex.vtkPentatopeMeshTimeSlice()
        if isinstance(source, vtkUnstructuredGrid):
            slicer.SetInputData(source)
        else:
            slicer.SetInputConnection(source.GetOutputPort())
        self.slices = 0

        def count(_caller, _event):
            self.slices += 1

        slicer.AddObserver("StartEvent", count)
        return slicer

    def corners(self, output):
        """Of the tetrahedra, by their numbers."""
        return {cell: vtk_to_numpy(output.GetCell(cell).GetPoints().GetData()).copy()
                for cell in range(output.GetNumberOfCells()) if output.GetCellType(cell) == VTK_TETRA}

    def volumes(self, output):
        """Of labels (0: without); each tetrahedron is positive."""
        volumes, labels = {}, output.GetCellData().GetArray("Label")
        for cell, corners in self.corners(output).items():
            volume = numpy.linalg.det(corners[1:] - corners[0]) / 6
            self.assertGreater(volume, 0)
            label = labels.GetValue(cell) if labels else 0
            volumes[label] = volumes.get(label, 0) + volume
        return volumes

    def check(self, slicer, time):
        self.assertEqual(slicer.GetErrorMessage(), "")
        self.assertEqual(slicer.GetOutput().GetInformation().Get(vtkDataObject.DATA_TIME_STEP()), time)
        volumes = self.volumes(slicer.GetOutput())
        self.assertEqual(set(volumes), {1, 2})
        numpy.testing.assert_allclose(list(volumes.values()), 4, atol=1e-12)

    def update(self, slicer, time, shown=None):
        slicer.UpdateTimeStep(time)
        self.check(slicer, time if shown is None else shown)

    def check_range(self, slicer, last=2.0):
        info = slicer.GetOutputInformation(0)
        self.assertFalse(info.Has(Pipeline.TIME_STEPS()))
        self.assertEqual(info.Get(Pipeline.TIME_RANGE()), (0.0, last))

    def check_empty(self, slicer):
        """Nothing to cut, and nothing known of its times."""
        self.assertEqual((slicer.GetOutput().GetNumberOfCells(), slicer.GetErrorMessage()), (0, ""))
        self.assertFalse(slicer.GetOutputInformation(0).Has(Pipeline.TIME_RANGE()))


class Executions(SliceTestCase):
    def test_playback(self):
        """Thirty times, one mesh."""
        for knows_range, is_temporal in itertools.product((False, True), repeat=2):
            source = Source(knows_range, is_temporal)
            slicer = self.slicer(source)
            slicer.UpdateInformation()
            self.check_range(slicer)
            self.assertEqual((source.executions, self.slices), (0 if knows_range else 1, 0))
            for n, time in enumerate(numpy.linspace(0, 2, 30), 1):
                self.update(slicer, time)
                slicer.UpdateTimeStep(time)
                self.assertEqual(self.slices, n)
            self.check_range(slicer)
            slicer.Modified()
            self.update(slicer, 1.3)
            self.assertEqual((source.executions, source.requests), (1, 0))
            source.Modified()
            self.update(slicer, 1.3)
            self.assertEqual((source.executions, source.requests), (2, 0))

    def test_long_pipeline(self):
        """The request for a time does not get past the filter before the mesh either."""
        for knows_range in (False, True):
            source, through = Source(knows_range, True), Pass()
            through.SetInputConnection(source.GetOutputPort())
            slicer = self.slicer(through)
            self.update(slicer, 0.5)
            self.update(slicer, 1.5)
            self.assertEqual((source.executions, source.requests), (1, 0))
            # Somebody else asks the source for a time; that is forgotten.
            source.Modified()
            source.UpdateTimeStep(60.0)
            self.assertEqual(source.requests, 1)
            source.Modified()
            self.update(self.slicer(source), 0.5)
            self.assertEqual(source.requests, 1)

    def test_nothing(self):
        slicer = self.slicer(Source(is_temporal=True, is_empty=True))
        slicer.Update()
        self.check_empty(slicer)
        # Without an input: an error of the executive's, and nothing worse.
        slicer, errors = voxplex.vtkPentatopeMeshTimeSlice(), []
        slicer.GetExecutive().AddObserver("ErrorEvent", lambda *_: errors.append(1))
        slicer.UpdateTimeStep(1.0)
        self.assertTrue(errors)
        self.assertEqual(slicer.GetOutput().GetNumberOfCells(), 0)

    def test_changes(self):
        """What was kept of the mesh is not used when the mesh has changed."""
        mesh = pentatopes()
        slicer = self.slicer(mesh)
        self.update(slicer, 1.5)
        times = mesh.GetPointData().GetArray("Time")
        vtk_to_numpy(times)[:] *= 10
        times.Modified()
        self.update(slicer, 15.0)
        self.check_range(slicer, 20.0)
        add(mesh.GetPointData(), "Later", 100 + vtk_to_numpy(times))
        self.update(slicer, 15.0)
        slicer.SetTimeArrayName("Later")
        self.update(slicer, 115.0)
        slicer.SetTimeArrayName("Time")
        slicer.SetInputData(pentatopes())
        self.update(slicer, 1.0)
        slicer.SetInputData(vtkUnstructuredGrid())
        slicer.UpdateTimeStep(1.0)
        self.check_empty(slicer)

    def test_abort(self):
        """It stops before the next step, and works the next time."""
        for last in (1, 2, 3):
            slicer, events = self.slicer(pentatopes()), []

            def abort(caller, _event):
                events.append(caller.GetProgress())
                if len(events) == last:
                    caller.SetAbortExecute(1)

            tag = slicer.AddObserver("ProgressEvent", abort)
            slicer.UpdateTimeStep(0.5)
            self.assertEqual((slicer.GetOutput().GetNumberOfCells(), slicer.GetErrorMessage()), (0, ""))
            self.assertEqual([fraction for fraction in events[last:] if 0 < fraction < 1], [])  # VTK 9.3 reports the end
            slicer.RemoveObserver(tag)
            slicer.Modified()
            self.update(slicer, 0.5)


class Slices(SliceTestCase):
    def test_times(self):
        slicer = self.slicer(pentatopes())
        slicer.Update()
        self.check_range(slicer)
        self.check(slicer, 0.0)
        for time, shown in ((0.7, 0.7), (2.0, 2.0), (17.0, 2.0)):
            slicer.SetSliceTime(time)
            slicer.Update()
            self.check(slicer, shown)
        for time, shown in ((1.0, 1.0), (-3.0, 0.0), (1e30, 2.0)):  # wins
            self.update(slicer, time, shown)
        slicer.GetOutputInformation(0).Remove(Pipeline.UPDATE_TIME_STEP())
        slicer.SetSliceTime(math.nan)
        slicer.Update()
        self.check(slicer, 0.0)
        before = slicer.GetMTime()
        slicer.SetSliceTime(math.nan)
        slicer.SetTimeArrayName("Time")
        self.assertEqual(slicer.GetMTime(), before)

    def test_data(self):
        mesh, types = pentatopes(), set()
        slicer = self.slicer(mesh)
        for time in (0.0, 0.3, 1.0, 1.6, 2.0):
            slicer.UpdateTimeStep(time)
            output = slicer.GetOutput()
            self.assertEqual(output.GetPoints().GetDataType(), VTK_DOUBLE)
            self.assertEqual(output.GetPointData().GetNumberOfArrays(), 1)
            field = vtk_to_numpy(output.GetPointData().GetArray("Field"))
            points = vtk_to_numpy(output.GetPoints().GetData())
            numpy.testing.assert_allclose(field, linear(points, time), atol=1e-12)
            labels = output.GetCellData().GetScalars()
            self.assertEqual((output.GetCellData().GetNumberOfArrays(), labels.GetName()), (1, "Label"))
            self.assertEqual(labels.GetDataType(), mesh.GetCellData().GetScalars().GetDataType())
            self.assertEqual(labels.GetNumberOfTuples(), output.GetNumberOfCells())
            self.assertIsNotNone(output.GetFieldData().GetAbstractArray("SPACE"))
            types.update(map(output.GetCellType, range(output.GetNumberOfCells())))
        self.assertEqual(types, {VTK_TETRA})
        self.assertEqual(mesh.GetPointData().GetNumberOfArrays(), 3)

    def test_points_at_the_time(self):
        """One pentatope with an edge before the time, and more and more of the other points at it."""
        for at_the_time, expected in enumerate((3, 2, 1, 0)):
            times = [-1, -1] + [0] * at_the_time + [1] * (3 - at_the_time)
            points = numpy.column_stack(([[0, 0, 0], [0, 0, 1], [1, 0, 0], [0, 1, 0], [0, 0, 0]], times)).astype(float)
            slicer = self.slicer(grid_of(points, [range(5)], VTK_POLY_VERTEX))
            slicer.SetSliceTime(0.0)
            slicer.Update()
            output = slicer.GetOutput()
            self.assertEqual([output.GetCellType(cell) for cell in range(output.GetNumberOfCells())], [VTK_TETRA] * expected)
            self.assertTrue(all(volume > 0.05 for volume in self.volumes(output).values()))

    def test_other_storage(self):
        """What is not read in place gives the same slice, and stays as it is."""
        expected = self.slicer(pentatopes())
        self.update(expected, 0.3)
        mesh = pentatopes()
        points = vtkPoints()
        points.SetDataType(VTK_FLOAT)
        points.DeepCopy(mesh.GetPoints())
        mesh.SetPoints(points)
        mesh.GetPointData().RemoveArray("Time")
        add(mesh.GetPointData(), "t", LATTICE[:, 3].astype(numpy.float32))
        mesh.GetCells().ConvertTo32BitStorage()
        slicer = self.slicer(mesh)
        slicer.SetTimeArrayName("t")
        self.update(slicer, 0.3)
        for get in (lambda output: output.GetPoints().GetData(), lambda output: output.GetCells().GetConnectivityArray(),
                    lambda output: output.GetCellData().GetScalars()):
            numpy.testing.assert_array_equal(*(vtk_to_numpy(get(filter.GetOutput())) for filter in (slicer, expected)))
        self.assertEqual((points.GetDataType(), mesh.GetCells().IsStorage64Bit()), (VTK_FLOAT, False))
        self.assertIsNone(slicer.GetOutput().GetPointData().GetArray("t"))

    def test_boundary(self):
        """Triangles are faces of the tetrahedra, and close the labels; volumes by the divergence theorem."""
        slicer, inside = self.slicer(boundary()), self.slicer(pentatopes())
        for time in (0.0, 0.4, 1.0, 1.5, 2.0):
            slicer.UpdateTimeStep(time)
            inside.UpdateTimeStep(time)
            faces = {frozenset(map(tuple, face)) for points in self.corners(inside.GetOutput()).values()
                     for face in itertools.combinations(points, 3)}
            output, volumes = slicer.GetOutput(), numpy.zeros(3)
            for cell, pair in enumerate(vtk_to_numpy(output.GetCellData().GetArray("Labels"))):
                self.assertEqual(output.GetCellType(cell), VTK_TRIANGLE)
                points = vtk_to_numpy(output.GetCell(cell).GetPoints().GetData())
                self.assertIn(frozenset(map(tuple, points)), faces)
                volumes[pair] += numpy.linalg.det(points) / 6 * numpy.array((1, -1))
            numpy.testing.assert_allclose(volumes[1:], 4, atol=1e-12)

    def test_mixed(self):
        """Pentatopes and boundary in one grid share their points."""
        mesh, tetrahedra = pentatopes(), boundary()
        for cell in range(tetrahedra.GetNumberOfCells()):
            mesh.InsertNextCell(VTK_TETRA, tetrahedra.GetCell(cell).GetPointIds())
            mesh.GetCellData().GetScalars().InsertNextTuple1(7)
        both, volume, surface = map(self.slicer, (mesh, pentatopes(), tetrahedra))
        for time in (0.0, 0.6, 2.0):
            self.update(both, time)
            volume.UpdateTimeStep(time)
            surface.UpdateTimeStep(time)
            self.assertEqual(both.GetOutput().GetNumberOfCells(),
                             volume.GetOutput().GetNumberOfCells() + surface.GetOutput().GetNumberOfCells())
            self.assertEqual(both.GetOutput().GetNumberOfPoints(), volume.GetOutput().GetNumberOfPoints())

    def test_print(self):
        slicer = voxplex.vtkPentatopeMeshTimeSlice()
        self.assertIn("SliceTime: (start of the range)", str(slicer))
        slicer.SetSliceTime(1.25)
        slicer.SetTimeArrayName("t")
        for line in ("SliceTime: 1.25", "TimeArrayName: t", "ErrorMessage: (none)"):
            self.assertIn(line, str(slicer))


class Errors(SliceTestCase):
    def check_refused(self, words, mesh):
        slicer = self.slicer(mesh)
        errors = errors_of(slicer)
        slicer.UpdateTimeStep(1.5)
        self.assertIn(words, slicer.GetErrorMessage())
        self.assertEqual((len(errors), slicer.GetOutput().GetNumberOfCells(), slicer.GetOutput().GetNumberOfPoints()), (1, 0, 0))
        slicer.SetInputData(pentatopes())
        self.update(slicer, 1.5)

    def test_times(self):
        bad = {"nan": LATTICE[:, 3].copy(), "inf": LATTICE[:, 3].copy()}
        for number, times in bad.items():
            times[7] = number
        texts = vtkStringArray()
        texts.SetName("Time")
        texts.SetNumberOfValues(81)
        for words, times in (('no numeric point array "Time"', None), ('no numeric point array "Time"', texts),
                             ("2 components", numpy.ones((81, 2))), ("80 times for 81 points", numpy.ones(80)),
                             ("time of point 7 is not a finite number", bad["nan"]),
                             ("time of point 7 is not a finite number", bad["inf"])):
            with self.subTest(words):
                mesh = pentatopes()
                mesh.GetPointData().RemoveArray("Time")
                if times is texts:
                    mesh.GetPointData().AddArray(times)
                elif times is not None:
                    add(mesh.GetPointData(), "Time", times)
                self.check_refused(words, mesh)

    def test_cells(self):
        for words, kind, points in (("Cell 384 is a vtkHexahedron of 8 points", VTK_HEXAHEDRON, 8),
                                    ("Cell 384 is a vtkPolyVertex of 4 points", VTK_POLY_VERTEX, 4),
                                    ("Cell 384 is a vtkPyramid of 5 points", VTK_PYRAMID, 5)):
            mesh = pentatopes()
            mesh.InsertNextCell(kind, points, range(points))
            self.check_refused(words, mesh)


if __name__ == "__main__":
    unittest.main()
