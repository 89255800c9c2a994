#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""vtkSimplexMeshQuality: figures of boxes made by hand, images in any position, misuse, abort."""
import json
import math
import unittest

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import (VTK_TETRA, VTK_TRIANGLE, vtkDataObject, vtkDataSetAttributes,
                                           vtkUnstructuredGrid)

import voxplex
from filter_testing import add_array, errors_of, tets

BOX = numpy.zeros((8, 8, 8), dtype=numpy.uint8)
BOX[2:6, 2:6, 2:6] = 3
TURNED = math.sqrt(0.5) * numpy.array(((1, -1, 0), (1, 1, 0), (0, 0, math.sqrt(2))))
# Six tetrahedra around the diagonal of a box, whose corners are numbered with x first.
CORNERS = numpy.array([[0, *pair, 7] for pair in ((1, 3), (3, 2), (2, 6), (6, 4), (4, 5), (5, 1))])


class Case:
    """Voxels 2 to 5 of each axis have label 3; so do the tetrahedra, shifted by this along the first axis."""

    def __init__(self, shift=0.0, spacing=1.0, origin=(0, 0, 0), direction=numpy.eye(3)):
        self.image = voxplex.Image(BOX.copy(), spacing=(spacing,) * 3, origin=origin, direction=direction).to_vtk()
        index = numpy.array([[1.5 + 4 * (corner >> axis & 1) for axis in range(3)] for corner in range(8)])
        points = vtkPoints()
        points.SetDataTypeToDouble()
        for place in (index + (shift, 0, 0)) * spacing @ numpy.transpose(direction) + origin:
            points.InsertNextPoint(place)
        self.grid = vtkUnstructuredGrid()
        self.grid.SetPoints(points)
        for cell in CORNERS if numpy.linalg.det(direction) > 0 else CORNERS[:, [0, 1, 3, 2]]:
            self.grid.InsertNextCell(VTK_TETRA, 4, cell)
        self.labels = add_array(self.grid.GetCellData(), "Label", numpy.full(6, 3, dtype=numpy.int32))
        self.filter = voxplex.vtkSimplexMeshQuality()
        self.filter.SetInputData(self.grid)
        self.filter.SetImageData(self.image)

    def voxels(self):
        return voxplex.Image.from_vtk(self.image).voxels

    def figures(self):
        """After another execution."""
        self.image.Modified()
        self.grid.Modified()
        self.filter.Update()
        return json.loads(self.filter.ToJSON())


def value(table, column, row=0):
    return table.GetValueByName(row, column).ToDouble()


class Figures(unittest.TestCase):
    def check_near(self, expected, *values):
        for number in values:
            self.assertAlmostEqual(number, expected, 9)

    def test_placements(self):
        placed = dict(spacing=2.0, origin=(10, -20, 30))
        for place in ({}, dict(direction=TURNED, **placed), dict(direction=TURNED * (1, 1, -1), **placed)):
            spacing = place.get("spacing", 1.0)
            case = Case(0.25, **place)
            self.assertEqual(case.figures()["quality"]["inverted_elements"], 0)
            quality = case.filter
            self.assertEqual((quality.GetErrorMessage() or "", quality.GetNumberOfLostLabels(),
                              quality.GetNumberOfLostComponents()), ("", 0, 0))
            labels = quality.GetLabelTable()
            self.assertEqual(labels.GetNumberOfRows(), 1)
            for column, expected in (("Label", 3), ("Elements", 6), ("Voxels", 64), ("Volume", 64 * spacing ** 3),
                                     ("VolumeError", 0), ("BoundaryEdges", 18), ("NonManifoldEdges", 0)):
                self.check_near(expected, value(labels, column))
            # The corners that were moved away: (0.25, 0.5, 0.5) from the nearest centre of a voxel's face.
            self.check_near(0.75 * spacing, quality.GetHausdorffDistance())
            place, index = [0.0] * 3, [0.0] * 3
            quality.GetHausdorffPlace(place)
            case.image.TransformPhysicalPointToContinuousIndex(place, index)
            self.check_near(5.75, index[0])
            self.assertIn(round(index[1], 9), (1.5, 5.5))
            self.assertTrue(0 < quality.GetSmoothHausdorffDistance() < 1.5 * spacing)
            cells = quality.GetOutput().GetCellData()
            for name, expected in (("Volume", 64 * spacing ** 3 / 6), ("MinimumDihedralAngle", 45),
                                   ("MaximumDihedralAngle", 90), ("RadiusEdgeRatio", math.sqrt(0.75)), ("Label", 3)):
                numpy.testing.assert_allclose(vtk_to_numpy(cells.GetArray(name)), [expected] * 6, rtol=1e-9)
            self.check_near(45, quality.GetMinimumDihedralAngle(), quality.GetMinimumPlanarAngle())
            self.check_near(90, quality.GetMaximumDihedralAngle())
            self.check_near(math.sqrt(0.75), quality.GetMaximumRadiusEdgeRatio())
            histograms = quality.GetHistograms()
            self.assertEqual(histograms.GetNumberOfRows(), 90)
            for column, row, expected in (("Angle", 45, 90), ("DihedralAngles", 22, 12), ("PlanarAngles", 22, 24),
                                          ("Ratio", 17, 0.85), ("RadiusEdgeRatios", 17, 6)):
                self.check_near(expected, value(histograms, column, row))

    def test_labels(self):
        case = Case()
        case.voxels()[0, 0, :3] = 9  # a component of three voxels, of a label that no element has
        case.voxels()[7, 7, 6:] = 9  # and one of two
        lost = [{"label": 9, "voxels": 3, "voxel": [0, 0, 0]}]
        image = case.figures()["image"]  # the largest of its label, however small
        self.assertEqual((image["lost_labels"], image["lost_components"]), ([9], lost))
        table, quality = case.filter.GetLabelTable(), case.filter
        self.assertEqual((table.GetNumberOfRows(), value(table, "Elements", 1), value(table, "VolumeError", 1)), (2, 0, -1))
        # The first voxel's outer corner face is the farthest from the mesh.
        self.assertGreater(quality.GetHausdorffDistance(), math.sqrt(3 * 1.5 ** 2))
        quality.SetSmallestComponent(3)
        self.assertEqual(case.figures()["image"]["lost_components"], lost)
        quality.SetSmallestComponent(2)
        self.assertEqual(len(case.figures()["image"]["lost_components"]), 2)
        quality.AddLabel(3)
        self.assertEqual(case.figures()["image"]["lost_labels"], [])
        self.check_near(math.sqrt(0.5), quality.GetHausdorffDistance())
        quality.RemoveAllLabels()
        quality.DistancesOff()
        figures = case.figures()
        self.assertEqual((figures["image"]["lost_labels"], figures["hausdorff"]), ([9], {}))
        self.assertTrue(math.isnan(quality.GetHausdorffDistance()))
        quality.SetImageData(None)
        self.assertNotIn("hausdorff", case.figures())
        self.assertEqual((quality.GetErrorMessage() or "", quality.GetNumberOfLostLabels()), ("", 0))
        self.assertIsNone(table.GetColumnByName("Voxels"))

    def test_hidden(self):
        """Voxels that the image hides are background for measuring, too."""
        shown, hidden = Case(), Case()
        is_left = numpy.zeros(BOX.shape, dtype=bool)
        is_left[..., :4] = True
        shown.voxels()[is_left] = 0
        ghosts = numpy.where(is_left, vtkDataSetAttributes.HIDDENPOINT, 0).astype(numpy.uint8)
        add_array(hidden.image.GetPointData(), vtkDataSetAttributes.GhostArrayName(), ghosts.ravel())
        self.assertEqual(shown.figures(), hidden.figures())
        self.assertGreater(shown.filter.GetHausdorffDistance(), 1.5)

    def test_nothing(self):
        case = Case()
        empty = vtkUnstructuredGrid()
        empty.SetPoints(vtkPoints())
        add_array(empty.GetCellData(), "Label", numpy.zeros(0, dtype=numpy.int32))
        case.filter.SetInputData(empty)
        self.assertEqual(case.figures()["image"]["lost_labels"], [3])
        self.assertTrue(math.isnan(case.filter.GetMinimumDihedralAngle()))


class Meshes(unittest.TestCase):
    @staticmethod
    def ball(delta, labels):
        k, j, i = numpy.mgrid[:24, :24, :24] - 11.5
        halves = numpy.where(i < 0, *labels)
        mesher = tets(voxplex.Image(numpy.where(i * i + j * j + k * k < 64, halves, 0).astype(numpy.uint8)).to_vtk())
        mesher.SetDelta(delta)
        mesher.ComputeQualityOn()
        quality = voxplex.vtkSimplexMeshQuality()
        quality.SetInputConnection(mesher.GetOutputPort())
        quality.SetImageConnection(mesher.GetInputConnection(0, 0))
        return mesher, quality

    def test_agrees_with_the_mesher(self):
        """What the mesher counts with its own interfaces; for any number of threads, to the last bit."""
        mesher, quality = self.ball(2.0, (1, 2))
        quality.SetNumberOfThreads(1)
        quality.Update()
        text, statistics = quality.ToJSON(), mesher.GetStatistics()
        self.assertEqual(json.loads(text)["interface_facets"], statistics.GetNumberOfInterfaceFacets())
        for name in ("MinimumDihedralAngle", "MaximumRadiusEdgeRatio", "MinimumPlanarAngle"):
            self.assertAlmostEqual(getattr(quality, "Get" + name)(), getattr(statistics, "Get" + name)(), 6)
        quality.SetNumberOfThreads(3)
        quality.Update()
        self.assertEqual(quality.ToJSON(), text)

    def test_distances(self):
        """Vertices lie on the smooth interface, centroids of facets a tenth of a voxel beside it; the middle of a voxel's
        face is up to half a voxel from the mesh, and points between such middles are still farther from all of them."""
        _, quality = self.ball(1.0, (1, 1))
        quality.Update()
        smooth, voxels = (json.loads(quality.ToJSON())["hausdorff"][kind] for kind in ("smooth", "voxels"))
        self.assertTrue(0.05 < smooth["distance"] < min(0.25, 0.5 * voxels["distance"]), smooth)
        self.assertTrue(0.5 < voxels["distance"] < 1.0, voxels)
        self.assertTrue(0.05 < smooth["image_to_mesh"]["max"] < 0.25, smooth)
        self.assertTrue(0.35 < voxels["image_to_mesh"]["max"] < 0.6, voxels)

    def test_abort(self):
        _, quality = self.ball(2.0, (1, 2))
        tag = quality.AddObserver("ProgressEvent", lambda caller, _: caller.SetAbortExecute(1))
        quality.Update()
        self.assertTrue(quality.GetAborted())
        self.assertEqual((quality.GetErrorMessage() or "", quality.GetOutput().GetNumberOfCells()), ("", 0))
        quality.RemoveObserver(tag)
        quality.Modified()
        quality.Update()
        self.assertFalse(quality.GetAborted())
        self.assertGreater(quality.GetOutput().GetNumberOfCells(), 0)


class Errors(unittest.TestCase):
    def check_refused(self, case, words):
        with self.subTest(words):
            quality = case.filter
            errors = errors_of(quality)
            quality.Update()
            self.assertEqual(len(errors), 1)
            self.assertIn(words, quality.GetErrorMessage())
            self.assertEqual([quality.GetOutput().GetNumberOfCells(), quality.GetLabelTable().GetNumberOfColumns(),
                              quality.GetHistograms().GetNumberOfColumns()], [0, 0, 0])

    def test_mesh(self):
        case = Case()
        case.labels.SetValue(4, 0)
        self.check_refused(case, "with the label 0: 1, the first is cell 4.")
        case.labels.SetValue(4, 3)
        case.figures()
        self.assertEqual(case.filter.GetOutput().GetNumberOfCells(), 6)
        case.labels.SetName("Tissue")
        case.grid.Modified()
        self.check_refused(case, "no numeric cell array of labels")
        case.filter.SetInputArrayToProcess(0, 0, 0, vtkDataObject.FIELD_ASSOCIATION_CELLS, "Tissue")
        case.filter.Update()
        self.assertEqual(case.filter.GetOutput().GetNumberOfCells(), 6)
        case = Case()
        case.grid.InsertNextCell(VTK_TRIANGLE, 3, (0, 1, 2))
        case.labels.InsertNextValue(1)
        self.check_refused(case, "Cell 6 of the mesh is a vtkTriangle")
        case = Case()
        case.grid.GetPoints().SetPoint(2, math.nan, 0, 0)
        self.check_refused(case, "Point 2 of the mesh is not finite")
        case = Case()
        case.image.GetPointData().SetActiveScalars("none")
        self.check_refused(case, "image has no such array")

    def test_parameters(self):
        case = Case()
        for name, bad, good, words in (("SmoothingSigma", 6.0, 1.0, "SmoothingSigma is 6"),
                                       ("NumberOfThreads", -1, 0, "NumberOfThreads is -1")):
            getattr(case.filter, "Set" + name)(bad)
            self.check_refused(case, words)
            getattr(case.filter, "Set" + name)(good)
        case.filter.AddLabel(77)
        self.check_refused(case, "77")


if __name__ == "__main__":
    unittest.main()
