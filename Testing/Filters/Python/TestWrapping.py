#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""The filters from Python, beside VTK's own classes. What they do is tested in C++; this is what wrapping can break."""
import json
import threading
import unittest

import numpy
from vtkmodules.util.misc import calldata_type
from vtkmodules.util.vtkConstants import VTK_DOUBLE
from vtkmodules.vtkCommonCore import vtkSMPTools
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as Pipeline
from vtkmodules.vtkFiltersCore import vtkFlyingEdges3D, vtkImplicitPolyDataDistance

import voxplex
from filter_testing import errors_of
from temporal import Series

N = 24
K, J, I = numpy.mgrid[:N, :N, :N] - 0.5 * (N - 1)


def two_labels():
    """A ball of radius 8, label 3 on the left, 7 on the right."""
    return numpy.where(I * I + J * J + K * K < 64, numpy.where(I < 0, 3, 7), 0).astype(numpy.uint8)


def make_filter(array, **placement):
    mesher = voxplex.vtkImageToTetMeshFilter()
    mesher.SetInputData(voxplex.Image(array, **placement).to_vtk())
    mesher.SetNumberOfThreads(1)
    return mesher


class Tetrahedra(unittest.TestCase):
    def test_vertices_lie_on_the_surface_of_flying_edges(self):
        density = 100.0 * numpy.exp(-(I * I + J * J + K * K) / 60.0) * (1.2 + numpy.sin(0.4 * I))
        mesher = make_filter(density)
        mesher.SetInputModeToIsosurface()
        mesher.SetIsovalue(40.0)
        mesher.SetDelta(1.0)
        mesher.FitInterfacesOff()
        mesher.Update()
        contour = vtkFlyingEdges3D()
        contour.SetInputData(voxplex.Image(density).to_vtk())
        contour.SetValue(0, 40.0)
        contour.Update()
        distance = vtkImplicitPolyDataDistance()
        distance.SetInput(contour.GetOutput())
        off = [abs(distance.EvaluateFunction(point)) for point in voxplex.Interfaces.from_vtk(mesher.GetInterfaces()).points]
        self.assertGreater(len(off), 300)
        # What lies within a cell: VTK's triangles are plane, the interpolation is trilinear.
        self.assertLess(numpy.mean(off), 0.01)
        self.assertLess(max(off), 0.06)

    def test_grading(self):
        mesher = make_filter(two_labels(), spacing=(0.5, 1, 1))
        mesher.SetDelta(0.8)
        mesher.Update()
        uniform = mesher.GetStatistics().GetNumberOfElements()
        mesher.SetGradingToLocalFeatureSize()
        self.assertEqual(mesher.GetGradingAsString(), "local-feature-size")
        counts = []
        for ratio, largest in ((1.0, 12.0), (1.0, 1.5), (0.5, 2.5)):
            mesher.SetFeatureRatio(ratio)
            mesher.SetLargestFeature(largest)
            mesher.Update()
            self.assertEqual(mesher.GetErrorMessage(), "")
            statistics = mesher.GetStatistics()
            self.assertEqual(statistics.GetDelta(), 0.8)
            self.assertGreater(statistics.GetFigure("/largest_delta"), 0.9)
            self.assertLess(statistics.GetFigure("/largest_delta"), ratio * largest * 0.5 ** (1 / 3) + 1e-6)
            self.assertGreater(statistics.GetFigure("/grading/samples"), 500)
            self.assertGreater(statistics.GetFigure("/grading/poles"), 10)
            self.assertGreater(statistics.GetGradingTime(), 0.0)
            counts.append(statistics.GetNumberOfElements())
        self.assertEqual([*counts, uniform], sorted({*counts, uniform}))
        for mode, clamped in ((7, mesher.LOCAL_FEATURE_SIZE), (-1, mesher.UNIFORM)):
            mesher.SetGrading(mode)
            self.assertEqual(mesher.GetGrading(), clamped)

    def test_components(self):
        """A block of label 1 with specks: 2 x 2 x 2 voxels of label 2, and one voxel of label 5."""
        array = numpy.zeros((N, N, N), dtype=numpy.uint8)
        array[2:-2, 2:-2, 2:-2] = 1
        array[10:12, 10:12, 10:12] = 2
        array[8, 7, 6] = 5
        mesher = make_filter(array)
        for delta, smallest, rounds, labels, components in (
                (6, 1, 3, {1, 2, 5}, 3), (6, 0, 0, {1}, 0),
                # Specks that are far from all other interfaces, for the Delta, come out for the sake of distance.
                (2, 0, 3, {1, 2, 5}, 0), (2, 0, 0, {1}, 0)):
            with self.subTest(delta=delta, smallest=smallest, rounds=rounds):
                mesher.SetDelta(delta)
                mesher.SetSmallestComponent(smallest)
                mesher.SetInterfaceRounds(rounds)
                mesher.Update()
                self.assertEqual(set(voxplex.Mesh.from_vtk(mesher.GetOutput()).labels) - ({5} - labels), labels)
                statistics = mesher.GetStatistics()
                self.assertEqual(statistics.GetNumberOfComponents(), components)
                self.assertEqual(statistics.GetNumberOfLostComponents(), 0)
                self.assertEqual(statistics.GetFigure("/interfaces/rounds") > 0, rounds > 0)
        mesher.SetMinimumComponentVolume(8.5)
        errors = errors_of(mesher)
        mesher.Update()
        self.assertEqual(set(voxplex.Mesh.from_vtk(mesher.GetOutput()).labels), {1})
        self.assertEqual(errors, [])
        statistics = mesher.GetStatistics()
        self.assertEqual((statistics.GetNumberOfLostLabels(), statistics.GetNumberOfDroppedComponents()), (0, 2))
        self.assertEqual(json.loads(statistics.ToJSON())["dropped_components"], [
            {"label": 5, "voxels": 1, "voxel": [6, 7, 8]}, {"label": 2, "voxels": 8, "voxel": [10, 10, 10]}])
        mesher.SetMinimumComponentVolume(1e6)
        mesher.Update()
        self.assertIn("every component", mesher.GetErrorMessage())

    def test_default_number_of_threads_is_the_setting_of_vtk(self):
        self.addCleanup(vtkSMPTools.Initialize, vtkSMPTools.GetEstimatedNumberOfThreads())
        mesher = make_filter(two_labels())
        mesher.SetNumberOfThreads(0)
        for number in (3, 1):
            vtkSMPTools.Initialize(number)
            mesher.Modified()
            mesher.Update()
            # Always 1 without a parallel backend.
            self.assertEqual(mesher.GetStatistics().GetNumberOfThreads(), vtkSMPTools.GetEstimatedNumberOfThreads())
            self.assertEqual(mesher.GetNumberOfThreads(), 0)

    def test_events(self):
        """Observers of progress and of errors are called, by the calling thread; they may abort."""
        mesher = make_filter(two_labels())
        mesher.SetNumberOfThreads(8)
        fractions, threads = [], set()

        @calldata_type(VTK_DOUBLE)
        def observe(_caller, _event, fraction):
            fractions.append(fraction)
            threads.add(threading.get_ident())

        mesher.AddObserver("ProgressEvent", observe)
        errors = errors_of(mesher)
        mesher.Update()
        self.assertEqual((fractions[-1], threads), (1.0, {threading.get_ident()}))
        mesher.SetDelta(-1)
        mesher.Update()
        self.assertEqual(len(errors), 1)
        self.assertIn(mesher.GetErrorMessage(), errors[0])
        mesher.SetDelta(0.3)
        mesher.AddObserver("ProgressEvent", lambda caller, _event: caller.SetAbortExecute(1))
        mesher.Update()
        self.assertTrue(mesher.GetAborted())
        self.assertEqual((len(errors), mesher.GetOutput().GetNumberOfCells()), (1, 0))


class SpaceTime(unittest.TestCase):
    def test_series_from_python(self):
        """The mesh is made once, however many of its slices are asked for."""
        k, j, i = numpy.mgrid[:12, :12, :12] - 5.5
        times = [2.0, 2.5, 3.0, 3.5]
        source = Series([voxplex.Image((i * i + j * j + k * k < (1.5 + time) ** 2).astype(numpy.uint8)).to_vtk()
                         for time in times], times)
        mesher = voxplex.vtkImageToPentatopeMeshFilter()
        mesher.SetInputConnection(source.GetOutputPort())
        mesher.SetTimeScale(4.0)
        slicer = voxplex.vtkPentatopeMeshTimeSlice()
        slicer.SetInputConnection(mesher.GetOutputPort())
        slicer.UpdateInformation()
        self.assertEqual(slicer.GetOutputInformation(0).Get(Pipeline.TIME_RANGE()), (2.0, 3.5))
        sizes = []
        for time in (2.0, 2.8, 3.5):
            slicer.UpdateTimeStep(time)
            sizes.append(slicer.GetOutput().GetLength())
        self.assertEqual(sizes, sorted(set(sizes)))
        self.assertEqual(source.asked, times)
        self.assertEqual(mesher.GetOutput().GetPointData().GetArray("Time").GetRange(), (2.0, 3.5))


class Names(unittest.TestCase):
    def test_documentation_and_print(self):
        for kind, word, line in ((voxplex.vtkImageToTetMeshFilter, "tetrahedral", "SmoothingSigma: 1"),
                                 (voxplex.vtkImageToPentatopeMeshFilter, "pentatopes", "TimeScale: 1")):
            self.assertIn(word, kind.__doc__)
            self.assertIn(line, str(kind()))

    def test_words(self):
        """The names of choices, as methods and as texts."""
        for kind, prop, choices in (
                (voxplex.vtkImageToTetMeshFilter, "ContentionManager",
                 {"Aggressive": "aggressive", "Random": "random", "Global": "global", "Local": "local"}),
                (voxplex.vtkImageToTetMeshFilter, "LoadBalancer",
                 {"RandomWorkStealing": "rws", "HierarchicalWorkStealing": "hws"}),
                (voxplex.vtkImageToTetMeshFilter, "InputMode", {"Labels": "labels", "Isosurface": "isosurface"}),
                (voxplex.vtkImageToTetMeshFilter, "Inside", {"Above": "above", "Below": "below"}),
                (voxplex.vtkImageToPentatopeMeshFilter, "RuleOrder",
                 {"RadiusEdgeFirst": "radius-edge-first", "SurfaceFirst": "surface-first"})):
            mesher = kind()
            for value, (method, text) in enumerate(choices.items()):
                getattr(mesher, "Set%sTo%s" % (prop, method))()
                self.assertEqual(getattr(mesher, "Get" + prop)(), value)
                self.assertEqual(getattr(mesher, "Get%sAsString" % prop)(), text)
            for outside, nearest in ((-1, 0), (99, len(choices) - 1)):
                getattr(mesher, "Set" + prop)(outside)
                self.assertEqual(getattr(mesher, "Get" + prop)(), nearest)

    def test_mistakes(self):
        for kind in (voxplex.vtkImageToTetMeshFilter, voxplex.vtkImageToPentatopeMeshFilter):
            with self.assertRaises(TypeError):
                kind().SetDelta("fine")
            with self.assertRaises(AttributeError):
                kind().SetDetla(1.0)
            self.assertTrue(issubclass(kind, voxplex.vtkImageToSimplexMeshFilter))
        with self.assertRaises(TypeError):  # abstract
            voxplex.vtkImageToSimplexMeshFilter()

    def test_keys(self):
        """What a filter that makes pentatope meshes announces."""
        self.assertEqual(voxplex.vtkPentatopeMeshTimeSlice.MESH_TIME_RANGE().GetName(), "MESH_TIME_RANGE")


if __name__ == "__main__":
    unittest.main()
