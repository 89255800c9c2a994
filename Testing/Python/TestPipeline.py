#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""The filters that are made of mesh(), in pipelines of VTK."""

import unittest

import numpy

import voxplex
from phantoms import beating, brick

try:
    from vtkmodules.util.numpy_support import numpy_to_vtk
    from vtkmodules.vtkCommonDataModel import vtkPolyData, vtkUnstructuredGrid
    from vtkmodules.vtkFiltersCore import vtkThreshold
    from temporal import Series
except ModuleNotFoundError as missing:
    raise unittest.SkipTest("there is no VTK") from missing

from voxplex.pipeline import vtkImageToPentatopeMeshFilter, vtkImageToTetMeshFilter


class Tetrahedra(unittest.TestCase):
    def setUp(self):
        self.mesher = vtkImageToTetMeshFilter()
        self.mesher.SetInputData(voxplex.Image(brick()).to_vtk())
        self.mesher.SetDelta(2.0)
        self.mesher.SetNumberOfThreads(1)

    def check(self, **arguments):
        self.mesher.Update()
        ours = voxplex.Mesh.from_vtk(self.mesher.GetOutput())
        theirs = voxplex.mesh(brick(), **{"delta": 2.0, "threads": 1, **arguments})
        numpy.testing.assert_array_equal(ours.points, theirs.points)
        numpy.testing.assert_array_equal(ours.cells, theirs.cells)
        numpy.testing.assert_array_equal(voxplex.Interfaces.from_vtk(self.mesher.GetInterfaces()).cells, theirs.interfaces.cells)
        return ours

    def test_outputs(self):
        self.check()
        self.assertIsInstance(self.mesher.GetOutput(), vtkUnstructuredGrid)
        self.assertIsInstance(self.mesher.GetInterfaces(), vtkPolyData)
        self.assertEqual(self.mesher.GetStatistics()["elements"], self.mesher.GetOutput().GetNumberOfCells())

    def test_properties(self):
        self.mesher.SetGrading(1)
        self.mesher.SetDelta(1.0)
        self.mesher.FitInterfacesOff()
        self.assertEqual((self.mesher.GetDelta(), self.mesher.GetGrading(), self.mesher.GetFitInterfaces()), (1.0, "lfs", False))
        self.check(delta=1.0, grading="lfs", fit_interfaces=False)

    def test_labels_and_sizes(self):
        self.mesher.AddLabel(9)
        self.mesher.SetLabelSize(9, 0.9)
        self.mesher.SetInterfaceSize(9, self.mesher.ANY_LABEL, 1.5)
        self.assertEqual(set(self.check(labels=[9], label_sizes={9: 0.9}, interface_sizes={9: 1.5}).labels), {9})
        self.mesher.ClearLabels()
        self.check(label_sizes={9: 0.9}, interface_sizes={9: 1.5})

    def test_pipeline(self):
        """What is downstream gets it, and nothing is done twice."""
        threshold = vtkThreshold()
        threshold.SetInputConnection(self.mesher.GetOutputPort())
        threshold.SetInputArrayToProcess(0, 0, 0, 1, "Label")
        threshold.SetLowerThreshold(9)
        threshold.SetUpperThreshold(9)
        executions = []
        self.mesher.AddObserver("StartEvent", lambda *_: executions.append(1))
        threshold.Update()
        labels = voxplex.Mesh.from_vtk(self.mesher.GetOutput()).labels
        self.assertEqual(threshold.GetOutput().GetNumberOfCells(), (labels == 9).sum())
        threshold.Update()
        self.assertEqual(len(executions), 1)

    def test_errors(self):
        self.mesher.SetDelta(-1.0)
        with self.assertRaisesRegex(voxplex.MeshingError, "delta: must be greater than 0"):
            self.mesher.Update()
        self.assertIn("delta", self.mesher.GetErrorMessage())
        self.mesher.SetDelta(2.0)
        self.check()
        self.assertEqual(self.mesher.GetErrorMessage(), "")

    def test_abort(self):
        self.mesher.AddObserver("ProgressEvent", lambda *_: self.mesher.SetAbortExecute(1))
        with self.assertRaises(voxplex.MeshingCancelled):
            self.mesher.Update()


class Pentatopes(unittest.TestCase):
    TIMES = [0.0, 1.0, 2.5, 3.0]

    def mesher(self):
        mesher = vtkImageToPentatopeMeshFilter()
        mesher.SetDelta(2.0)
        mesher.SetNumberOfThreads(1)
        return mesher

    def check(self, mesher, **arguments):
        mesher.Update()
        ours = voxplex.Mesh.from_vtk(mesher.GetOutput())
        theirs = voxplex.mesh(beating(), 2.0, times=self.TIMES, threads=1, **arguments)
        numpy.testing.assert_array_equal(ours.times, theirs.times)
        numpy.testing.assert_array_equal(ours.cells, theirs.cells)
        self.assertEqual(mesher.GetBoundary().GetNumberOfCells(), len(theirs.interfaces.cells))

    def test_time_steps(self):
        source = Series(voxplex.Image(beating(), times=self.TIMES).to_vtk(), self.TIMES)
        mesher = self.mesher()
        mesher.SetInputConnection(source.GetOutputPort())
        mesher.SetTimeScale(2.0)
        self.check(mesher, time_scale=2.0)
        mesher.AddTimePlane(1.5)
        self.check(mesher, time_scale=2.0, time_planes=[1.5])

    def test_components(self):
        frames = beating()
        image = voxplex.Image(frames[0]).to_vtk()
        image.GetPointData().SetScalars(numpy_to_vtk(numpy.moveaxis(frames, 0, -1).reshape(-1, len(frames)).copy()))
        mesher = self.mesher()
        mesher.SetInputData(image)
        for time in self.TIMES:
            mesher.AddFrameTime(time)
        self.check(mesher)


if __name__ == "__main__":
    unittest.main()
