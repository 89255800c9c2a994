#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""vtkImageToTetMeshFilter from Python, together with VTK's own classes."""

import json
import math
import threading
import unittest

from vtkmodules.vtkCommonCore import vtkDoubleArray, vtkIdList, vtkSMPTools, vtkUnsignedCharArray
from vtkmodules.vtkCommonDataModel import VTK_TETRA, vtkImageData, vtkPlane
from vtkmodules.vtkCommonExecutionModel import vtkTrivialProducer
from vtkmodules.vtkFiltersCore import vtkFlyingEdges3D, vtkImplicitPolyDataDistance
from vtkmodules.util.misc import calldata_type
from vtkmodules.util.vtkConstants import VTK_DOUBLE, VTK_STRING

import voxplex

N = 24
CENTRE = 0.5 * (N - 1)


def make_image(label, spacing=(1, 1, 1)):
    """A cube of N voxels; label(i, j, k) gives their values."""
    scalars = vtkUnsignedCharArray()
    scalars.SetName("Segmentation")
    scalars.SetNumberOfValues(N ** 3)
    voxel = 0
    for k in range(N):
        for j in range(N):
            for i in range(N):
                scalars.SetValue(voxel, label(i, j, k))
                voxel += 1
    image = vtkImageData()
    image.SetDimensions(N, N, N)
    image.SetSpacing(spacing)
    image.GetPointData().SetScalars(scalars)
    return image


def two_labels(i, j, k):
    """A ball of radius 8, label 3 on the left, 7 on the right."""
    if math.dist((i, j, k), (CENTRE, CENTRE, CENTRE)) >= 8.0:
        return 0
    return 3 if i < CENTRE else 7


def make_filter(image):
    mesher = voxplex.vtkImageToTetMeshFilter()
    mesher.SetInputData(image)
    mesher.SetNumberOfThreads(1)
    return mesher


def tetrahedra(mesh):
    """Corner coordinates of each cell."""
    ids = vtkIdList()
    for cell in range(mesh.GetNumberOfCells()):
        mesh.GetCellPoints(cell, ids)
        yield [mesh.GetPoint(ids.GetId(i)) for i in range(4)]


def volume(t):
    a, b, c = ([p - q for p, q in zip(corner, t[0])] for corner in t[1:])
    return (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2])
            + a[2] * (b[0] * c[1] - b[1] * c[0])) / 6.0


class Isosurface(unittest.TestCase):
    """InputMode isosurface, beside VTK's own isosurfaces."""

    @staticmethod
    def grey_image():
        scalars = vtkDoubleArray()
        scalars.SetName("Density")
        for voxel in range(N ** 3):
            x, y, z = voxel % N - CENTRE, voxel // N % N - CENTRE, voxel // N ** 2 - CENTRE
            scalars.InsertNextValue(100.0 * math.exp(-(x * x + y * y + z * z) / 60.0) * (1.2 + math.sin(0.4 * x)))
        image = vtkImageData()
        image.SetDimensions(N, N, N)
        image.GetPointData().SetScalars(scalars)
        return image

    def test_vertices_lie_on_the_surface_of_flying_edges(self):
        image = self.grey_image()
        mesher = make_filter(image)
        mesher.SetInputModeToIsosurface()
        mesher.SetIsovalue(40.0)
        mesher.SetDelta(1.0)
        mesher.Update()
        contour = vtkFlyingEdges3D()
        contour.SetInputData(image)
        contour.SetValue(0, 40.0)
        contour.Update()
        distance = vtkImplicitPolyDataDistance()
        distance.SetInput(contour.GetOutput())
        interfaces = mesher.GetInterfaces()
        self.assertGreater(interfaces.GetNumberOfPoints(), 300)
        off = [abs(distance.EvaluateFunction(interfaces.GetPoint(i))) for i in range(interfaces.GetNumberOfPoints())]
        # What lies within a cell: VTK's triangles are plane, the interpolation is trilinear.
        self.assertLess(sum(off) / len(off), 0.01)
        self.assertLess(max(off), 0.06)

    def test_constants_and_names(self):
        mesher = voxplex.vtkImageToTetMeshFilter()
        self.assertEqual((mesher.GetInputModeAsString(), mesher.GetInsideAsString()), ("labels", "above"))
        mesher.SetInputMode(voxplex.vtkImageToTetMeshFilter.INPUT_ISOSURFACE)
        mesher.SetInsideToBelow()
        self.assertEqual((mesher.GetInputModeAsString(), mesher.GetInsideAsString()), ("isosurface", "below"))
        self.assertEqual(mesher.GetInside(), voxplex.vtkImageToTetMeshFilter.INSIDE_BELOW)

    def test_range(self):
        mesher = make_filter(self.grey_image())
        mesher.SetInputModeToIsosurface()
        mesher.SetIsovalue(30.0)
        mesher.Update()
        value_range = list(self.grey_image().GetScalarRange())
        self.assertEqual(json.loads(mesher.GetStatistics().ToJSON())["isosurface"],
                         {"value": 30.0, "inside": "above", "range": value_range})


class ErrorCollector:
    """Keeps the text of the filter's error events."""

    def __init__(self, mesher):
        self.messages = []

        @calldata_type(VTK_STRING)
        def keep(_caller, _event, text):
            self.messages.append(text)

        @calldata_type(VTK_STRING)
        def ignore(_caller, _event, _text):
            pass

        mesher.AddObserver("ErrorEvent", keep)
        mesher.GetExecutive().AddObserver("ErrorEvent", ignore)


class Grading(unittest.TestCase):
    def test_saves_elements_where_the_shape_allows_it(self):
        mesher = make_filter(make_image(two_labels, (0.5, 1, 1)))
        mesher.SetDelta(0.8)
        self.assertEqual((mesher.GetGrading(), mesher.GetGradingAsString()), (mesher.UNIFORM, "uniform"))
        self.assertEqual((mesher.GetFeatureRatio(), mesher.GetLargestFeature()), (1.0, 12.0))
        mesher.Update()
        uniform = mesher.GetStatistics().GetNumberOfElements()
        mesher.SetGradingToLocalFeatureSize()
        self.assertEqual(mesher.GetGradingAsString(), "local-feature-size")
        counts = []
        for ratio, largest in ((1.0, 12.0), (0.5, 2.5), (1.0, 1.5)):
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
            figures = json.loads(statistics.ToJSON())
            self.assertEqual(figures["largest_delta"], statistics.GetFigure("/largest_delta"))
            self.assertEqual(figures["grading"], {"samples": statistics.GetFigure("/grading/samples"),
                                                  "poles": statistics.GetFigure("/grading/poles")})
            counts.append(statistics.GetNumberOfElements())
        self.assertLess(counts[0], counts[2], counts)
        self.assertLess(counts[2], counts[1], counts)
        self.assertLess(counts[1], uniform)

    def test_modes_are_clamped(self):
        mesher = make_filter(make_image(two_labels, (0.5, 1, 1)))
        mesher.SetGrading(7)
        self.assertEqual(mesher.GetGrading(), mesher.LOCAL_FEATURE_SIZE)
        mesher.SetGrading(-1)
        self.assertEqual(mesher.GetGrading(), mesher.UNIFORM)


class Outputs(unittest.TestCase):
    def setUp(self):
        self.mesher = make_filter(make_image(two_labels, (0.5, 1, 1)))
        self.mesher.SetDelta(1.5)
        self.mesher.ComputeQualityOn()
        self.mesher.Update()
        self.assertEqual(self.mesher.GetErrorMessage(), "")

    def test_mesh(self):
        mesh = self.mesher.GetOutput()
        self.assertGreater(mesh.GetNumberOfCells(), 100)
        self.assertEqual({mesh.GetCellType(c) for c in range(mesh.GetNumberOfCells())}, {VTK_TETRA})
        labels = mesh.GetCellData().GetArray("Label")
        self.assertEqual({labels.GetValue(c) for c in range(mesh.GetNumberOfCells())}, {3, 7})
        volumes = [volume(t) for t in tetrahedra(mesh)]
        self.assertGreater(min(volumes), 0.0)
        truth = 0.5 * 4.0 / 3.0 * math.pi * 8 ** 3
        self.assertLess(abs(sum(volumes) / truth - 1.0), 0.1)

    def test_interfaces(self):
        interfaces = self.mesher.GetInterfaces()
        labels = interfaces.GetCellData().GetArray("Labels")
        pairs = {labels.GetTuple2(c) for c in range(interfaces.GetNumberOfCells())}
        self.assertEqual(pairs, {(3.0, 0.0), (7.0, 0.0), (7.0, 3.0)})

    def test_statistics(self):
        statistics = self.mesher.GetStatistics()
        figures = json.loads(statistics.ToJSON())
        self.assertEqual(figures["elements"], self.mesher.GetOutput().GetNumberOfCells())
        self.assertEqual(figures["vertices"], self.mesher.GetOutput().GetNumberOfPoints())
        self.assertEqual(
            figures["interface_facets"], self.mesher.GetInterfaces().GetNumberOfCells())
        self.assertEqual(figures["delta"], 1.5)
        self.assertEqual(set(figures["labels"]), {"3", "7"})
        self.assertEqual(
            sum(entry["elements"] for entry in figures["labels"].values()), figures["elements"])
        self.assertLessEqual(figures["quality"]["max_radius_edge"], 2.5)
        self.assertEqual(
            figures["quality"]["max_radius_edge"], statistics.GetMaximumRadiusEdgeRatio())
        self.assertGreater(figures["rules"]["R1"], 0)
        self.assertEqual(figures["rules"]["R1"], statistics.GetFigure("/rules/R1"))
        self.assertGreater(figures["time"]["refinement"], 0.0)
        self.assertGreater(figures["predicates"]["calls"], 0)

    def test_repr(self):
        self.assertIn("SmoothingSigma: 1", str(self.mesher))
        self.assertIn("tetrahedral", voxplex.vtkImageToTetMeshFilter.__doc__)


class Sizes(unittest.TestCase):
    def setUp(self):
        self.mesher = make_filter(make_image(two_labels))
        self.mesher.SetDelta(4.0)
        self.mesher.Update()
        self.without = self.mesher.GetOutput().GetNumberOfCells()

    def expect_more(self):
        self.mesher.Update()
        self.assertEqual(self.mesher.GetErrorMessage(), "")
        self.assertGreater(self.mesher.GetOutput().GetNumberOfCells(), 1.3 * self.without)

    def test_number(self):
        self.mesher.SetElementSize(1.5)
        self.expect_more()

    def test_label(self):
        self.mesher.SetLabelSize(7, 1.2)
        self.assertEqual(self.mesher.GetLabelSize(7), 1.2)
        self.expect_more()

    def test_image(self):
        sizes = vtkDoubleArray()
        sizes.SetNumberOfValues(N ** 3)
        sizes.Fill(1.5)
        image = vtkImageData()
        image.SetDimensions(N, N, N)
        image.GetPointData().SetScalars(sizes)
        self.mesher.SetElementSizeData(image)
        self.expect_more()
        producer = vtkTrivialProducer()
        producer.SetOutput(image)
        producer.SetWholeExtent(image.GetExtent())
        self.mesher.SetElementSizeConnection(producer.GetOutputPort())
        self.expect_more()

    def test_implicit_function(self):
        plane = vtkPlane()
        plane.SetNormal(0.1, 0, 0)
        plane.SetOrigin(-10, 0, 0)
        self.mesher.SetSizeImplicitFunction(plane)
        self.expect_more()
        first = self.mesher.GetOutput().GetNumberOfCells()
        plane.SetOrigin(-5, 0, 0)
        self.mesher.Update()
        self.assertGreater(self.mesher.GetOutput().GetNumberOfCells(), first)


class Components(unittest.TestCase):
    """A block of label 1 with specks: 2 x 2 x 2 voxels of label 2, and one voxel of label 5."""

    @classmethod
    def setUpClass(cls):
        def label(i, j, k):
            if not all(2 <= x < N - 2 for x in (i, j, k)):
                return 0
            if all(10 <= x < 12 for x in (i, j, k)):
                return 2
            return 5 if (i, j, k) == (6, 7, 8) else 1
        cls.image = make_image(label)

    def mesh(self, **properties):
        mesher = make_filter(self.image)
        mesher.SetDelta(6)
        mesher.ComputeQualityOn()
        for name, value in properties.items():
            getattr(mesher, "Set" + name)(value)
            self.assertEqual(getattr(mesher, "Get" + name)(), value)
        errors = ErrorCollector(mesher)
        mesher.Update()
        labels = mesher.GetOutput().GetCellData().GetArray("Label")
        found = {int(labels.GetTuple1(i)) for i in range(labels.GetNumberOfTuples())} if labels else set()
        return mesher, found, errors

    def test_small_ones_are_kept(self):
        self.assertEqual(self.mesh()[1] - {5}, {1, 2})
        mesher, found, _ = self.mesh(SmallestComponent=1)
        self.assertEqual(found, {1, 2, 5})
        self.assertEqual(mesher.GetStatistics().GetNumberOfComponents(), 3)
        self.assertEqual(mesher.GetStatistics().GetNumberOfLostComponents(), 0)
        mesher, found, _ = self.mesh(SmallestComponent=0, InterfaceRounds=0)
        self.assertNotIn(2, found)
        self.assertEqual(mesher.GetStatistics().GetNumberOfComponents(), 0)

    def test_dropped_on_request(self):
        mesher, found, errors = self.mesh(MinimumComponentVolume=8.5)
        self.assertEqual(found, {1})
        self.assertEqual(errors.messages, [])
        statistics = mesher.GetStatistics()
        self.assertEqual(statistics.GetNumberOfLostLabels(), 0)
        dropped = json.loads(statistics.ToJSON())["dropped_components"]
        self.assertEqual(dropped, [{"label": 5, "voxels": 1, "voxel": [6, 7, 8]},
                                   {"label": 2, "voxels": 8, "voxel": [10, 10, 10]}])
        self.assertEqual(statistics.GetNumberOfDroppedComponents(), 2)
        mesher, _, _ = self.mesh(MinimumComponentVolume=1e6)
        self.assertIn("every component", mesher.GetErrorMessage())

    def test_slivers(self):
        sharp = self.mesh(SliverAngle=0.0, Delta=1.0, Optimise=False)[0].GetStatistics()
        blunt = self.mesh(SliverAngle=9.0, Delta=1.0, Optimise=False)[0].GetStatistics()
        self.assertEqual(sharp.GetFigure("/slivers/found"), 0)
        self.assertGreater(blunt.GetFigure("/rules/R7_split") + blunt.GetFigure("/rules/R7_sampled"), 0)
        self.assertLess(sharp.GetMinimumDihedralAngle(), 4)
        self.assertGreater(blunt.GetMinimumDihedralAngle(), 4.6)
        self.assertIn("Force", self.mesh(SliverAngle=16.0)[0].GetErrorMessage())

    def test_interfaces(self):
        """Specks that are far from all other interfaces, for the Delta, come out for the sake of distance."""
        mesher, found, _ = self.mesh(Delta=2.0, SmallestComponent=0)
        self.assertEqual(found, {1, 2, 5})
        statistics = mesher.GetStatistics()
        self.assertGreater(statistics.GetFigure("/interfaces/rounds"), 0)
        self.assertGreater(statistics.GetInterfacesTime(), 0)
        self.assertEqual(statistics.GetFigure("/interfaces/nonmanifold_edges_left"), 0)
        self.assertEqual(statistics.GetFigure("/interfaces/junction_curves"), 0)
        mesher, found, _ = self.mesh(Delta=2.0, SmallestComponent=0, InterfaceRounds=0)
        self.assertEqual(found, {1})
        self.assertEqual(mesher.GetStatistics().GetFigure("/interfaces/rounds"), 0)
        self.assertIn("OptimisationTimeLimit", self.mesh(OptimisationTimeLimit=-1.0)[0].GetErrorMessage())

    def test_junctions(self):
        def figures(sample):
            mesher = make_filter(make_image(two_labels))
            mesher.SetDelta(2)
            mesher.SetSampleJunctions(sample)
            mesher.Update()
            return mesher.GetStatistics()
        self.assertGreaterEqual(figures(True).GetFigure("/interfaces/junction_curves"), 1)
        self.assertGreater(figures(True).GetFigure("/interfaces/junction_points"), 10)
        self.assertEqual(figures(False).GetFigure("/interfaces/junction_points"), 0)


class Optimisation(unittest.TestCase):
    def test_shapes(self):
        mesher = make_filter(make_image(two_labels))
        mesher.SetDelta(1)
        mesher.ComputeQualityOn()
        mesher.SetSliverAngle(0)
        self.assertTrue(mesher.GetOptimise())
        mesher.OptimiseOff()
        mesher.Update()
        before = mesher.GetStatistics()
        self.assertFalse(before.GetOptimised())
        self.assertEqual(before.GetOptimisationTime(), 0)
        sharpest, volumes = before.GetMinimumDihedralAngle(), [before.GetLabelVolume(i) for i in range(2)]
        self.assertLess(sharpest, 4)

        mesher.OptimiseOn()
        mesher.Update()
        after = mesher.GetStatistics()
        self.assertTrue(after.GetOptimised())
        self.assertGreater(after.GetOptimisationTime(), 0)
        self.assertAlmostEqual(after.GetFigure("/optimisation/min_dihedral_before"), sharpest, delta=1e-6)
        self.assertAlmostEqual(after.GetFigure("/optimisation/min_dihedral_after"),
                               after.GetMinimumDihedralAngle(), delta=1e-6)
        self.assertAlmostEqual(after.GetFigure("/optimisation/max_dihedral_after"),
                               after.GetMaximumDihedralAngle(), delta=1e-6)
        self.assertGreater(after.GetFigure("/optimisation/max_dihedral_before"), 171)
        self.assertGreater(after.GetMinimumDihedralAngle(), 12)
        self.assertLess(after.GetMaximumDihedralAngle(), 160)
        self.assertGreater(after.GetFigure("/optimisation/poor_before"), after.GetFigure("/optimisation/poor_after"))
        self.assertLess(after.GetMaximumRadiusEdgeRatio(), 2.5 + 1e-9)
        self.assertEqual(after.GetRadiusEdgeViolations(), 0)
        self.assertEqual(after.GetInvertedElements(), 0)
        self.assertEqual(after.GetFacetAngleViolations(),
                         after.GetFigure("/quality/facet_angle_violations_at_junctions"))
        for i, volume in enumerate(volumes):
            self.assertAlmostEqual(after.GetLabelVolume(i), volume, delta=0.003 * volume)
        figures = json.loads(after.ToJSON())
        self.assertTrue(figures["optimisation"]["ran"])
        self.assertEqual(figures["optimisation"]["poor_after"], after.GetFigure("/optimisation/poor_after"))


class Threads(unittest.TestCase):
    MANAGERS = {"aggressive": "Aggressive", "random": "Random", "global": "Global", "local": "Local"}
    BALANCERS = {"rws": "RandomWorkStealing", "hws": "HierarchicalWorkStealing"}

    def test_properties(self):
        mesher = voxplex.vtkImageToTetMeshFilter()
        self.assertEqual(mesher.GetContentionManager(), mesher.CONTENTION_LOCAL)
        self.assertEqual(mesher.GetLoadBalancer(), mesher.HIERARCHICAL_WORK_STEALING)
        self.assertFalse(mesher.GetPinThreads())
        for value, (name, method) in enumerate(self.MANAGERS.items()):
            getattr(mesher, "SetContentionManagerTo" + method)()
            self.assertEqual(mesher.GetContentionManager(), value)
            self.assertEqual(mesher.GetContentionManagerAsString(), name)
            self.assertEqual(getattr(mesher, "CONTENTION_" + name.upper()), value)
        for value, (name, method) in enumerate(self.BALANCERS.items()):
            getattr(mesher, "SetLoadBalancerTo" + method)()
            self.assertEqual(mesher.GetLoadBalancer(), value)
            self.assertEqual(mesher.GetLoadBalancerAsString(), name)
        mesher.PinThreadsOn()
        self.assertIn("PinThreads: On", str(mesher))

    def test_every_policy(self):
        for manager, set_manager in self.MANAGERS.items():
            for balancer, set_balancer in self.BALANCERS.items():
                with self.subTest(manager=manager, balancer=balancer):
                    mesher = make_filter(make_image(two_labels))
                    mesher.SetNumberOfThreads(4)
                    mesher.ComputeQualityOn()
                    getattr(mesher, "SetContentionManagerTo" + set_manager)()
                    getattr(mesher, "SetLoadBalancerTo" + set_balancer)()
                    mesher.Update()
                    figures = json.loads(mesher.GetStatistics().ToJSON())
                    self.assertEqual((figures["contention"], figures["balance"]), (manager, balancer))
                    self.assertEqual(set(figures["labels"]), {"3", "7"})
                    self.assertLessEqual(figures["quality"]["max_radius_edge"], 2.5)
                    self.assertEqual(figures["quality"]["inverted_elements"], 0)
                    self.assertGreater(min(volume(t) for t in tetrahedra(mesher.GetOutput())), 0.0)

    def test_statistics(self):
        mesher = make_filter(make_image(two_labels))
        mesher.SetNumberOfThreads(4)
        mesher.Update()
        statistics = mesher.GetStatistics()
        figures = json.loads(statistics.ToJSON())
        self.assertEqual(figures["threads"], 4)
        self.assertIs(figures["switched_to_local"], False)
        self.assertEqual(figures["seeding_seconds"], statistics.GetFigure("/seeding_seconds"))
        entries = figures["thread_statistics"]
        self.assertEqual(len(entries), 4)
        self.assertEqual(statistics.GetFigure("/thread_statistics"), 4)
        for thread, entry in enumerate(entries):
            for name in ("insertions", "rollbacks", "contention_seconds"):
                self.assertEqual(statistics.GetFigure(f"/thread_statistics/{thread}/{name}"), entry[name])
            for level in range(3):
                self.assertEqual(statistics.GetFigure(f"/thread_statistics/{thread}/received/{level}"),
                                 entry["received"][level])
        self.assertGreater(sum(entry["insertions"] for entry in entries), 0)

    def test_default_is_the_setting_of_vtk(self):
        before = vtkSMPTools.GetEstimatedNumberOfThreads()
        self.addCleanup(vtkSMPTools.Initialize, before)
        mesher = make_filter(make_image(two_labels))
        mesher.SetNumberOfThreads(0)
        for number in (3, 1):
            vtkSMPTools.Initialize(number)
            expected = vtkSMPTools.GetEstimatedNumberOfThreads()  # always 1 without a parallel backend
            mesher.Modified()
            mesher.Update()
            statistics = mesher.GetStatistics()
            self.assertEqual(statistics.GetNumberOfThreads(), expected)
            self.assertEqual(statistics.GetFigure("/thread_statistics"), expected)
            self.assertEqual(mesher.GetNumberOfThreads(), 0)


class Behaviour(unittest.TestCase):
    def test_errors(self):
        mesher = make_filter(make_image(two_labels))
        errors = ErrorCollector(mesher)
        cases = [
            (lambda: mesher.SetDelta(-1), lambda: mesher.SetDelta(0), "Delta"),
            (lambda: mesher.SetDelta(math.nan), lambda: mesher.SetDelta(0), "Delta"),
            (lambda: mesher.SetLabelSize(5, 1), mesher.ClearLabelSizes, "label 5"),
            (lambda: mesher.AddLabel(9), mesher.RemoveAllLabels, "9"),
            (lambda: mesher.SetRadiusEdgeRatio(1.5), lambda: mesher.SetRadiusEdgeRatio(2), "1.93"),
        ]
        for damage, repair, words in cases:
            with self.subTest(words):
                errors.messages.clear()
                damage()
                mesher.Update()
                self.assertEqual(len(errors.messages), 1)
                self.assertIn(words, errors.messages[0])
                self.assertIn(words, mesher.GetErrorMessage())
                self.assertEqual(mesher.GetOutput().GetNumberOfCells(), 0)
                self.assertEqual(mesher.GetInterfaces().GetNumberOfCells(), 0)
                repair()
                mesher.Update()
                self.assertGreater(mesher.GetOutput().GetNumberOfCells(), 0)

    def test_wrong_types(self):
        mesher = voxplex.vtkImageToTetMeshFilter()
        with self.assertRaises(TypeError):
            mesher.SetDelta("fine")
        with self.assertRaises(AttributeError):
            mesher.SetDetla(1.0)

    def test_progress(self):
        for threads in (1, 8):
            with self.subTest(threads):
                self.check_progress(threads)

    def check_progress(self, number):
        mesher = make_filter(make_image(two_labels))
        mesher.SetDelta(0.8)
        mesher.SetNumberOfThreads(number)
        fractions = []
        threads = set()

        @calldata_type(VTK_DOUBLE)
        def observe(_caller, _event, fraction):
            fractions.append(fraction)
            threads.add(threading.get_ident())

        mesher.AddObserver("ProgressEvent", observe)
        mesher.Update()
        self.assertGreater(len(fractions), 2)
        self.assertEqual(fractions, sorted(fractions))
        self.assertEqual(fractions[-1], 1.0)
        self.assertEqual(threads, {threading.get_ident()})

    def test_abort(self):
        for threads in (1, 8):
            with self.subTest(threads):
                mesher = make_filter(make_image(two_labels))
                mesher.SetDelta(0.3)
                mesher.SetNumberOfThreads(threads)
                errors = ErrorCollector(mesher)
                mesher.AddObserver("ProgressEvent", lambda caller, _event: caller.SetAbortExecute(1))
                mesher.Update()
                self.assertTrue(mesher.GetAborted())
                self.assertEqual(errors.messages, [])
                self.assertEqual(mesher.GetOutput().GetNumberOfCells(), 0)

    def test_reproducible(self):
        meshes = []
        for _ in range(2):
            mesher = make_filter(make_image(two_labels))
            mesher.Update()
            meshes.append(list(tetrahedra(mesher.GetOutput())))
        self.assertGreater(len(meshes[0]), 0)
        self.assertEqual(meshes[0], meshes[1])

    def test_version(self):
        self.assertRegex(voxplex.__version__, r"^\d+\.\d+\.\d+$")


if __name__ == "__main__":
    unittest.main()
