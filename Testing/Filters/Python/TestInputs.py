#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Every way to hand over labels gives the same mesh: scalar types, memory layouts, points or cells, time steps or components,
chosen arrays, hidden voxels."""
import math
import unittest

import numpy
from vtkmodules.util import vtkConstants
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkBitArray, vtkDataArray, vtkSOADataArrayTemplate
from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkDataSetAttributes, vtkImageData, vtkUniformGrid
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as Pipeline

import voxplex
from filter_testing import TIMES, FilterTestCase, add_array, components, four_ball, image_of_array, pentatopes, series, tets

TYPES = ("CHAR", "SIGNED_CHAR", "UNSIGNED_CHAR", "SHORT", "UNSIGNED_SHORT", "INT", "UNSIGNED_INT", "LONG", "UNSIGNED_LONG",
         "LONG_LONG", "UNSIGNED_LONG_LONG", "ID_TYPE", "FLOAT", "DOUBLE")
GHOSTS = vtkDataSetAttributes.GhostArrayName()
POINTS, CELLS = vtkDataObject.FIELD_ASSOCIATION_POINTS, vtkDataObject.FIELD_ASSOCIATION_CELLS


def converted(array, name):
    """The values as an array of the VTK type of this name."""
    other = vtkDataArray.CreateDataArray(getattr(vtkConstants, "VTK_" + name))
    other.DeepCopy(array)
    return other


def apart(array):
    """Components that are not contiguous in memory."""
    other = vtkSOADataArrayTemplate["int32"]()
    other.SetNumberOfComponents(array.GetNumberOfComponents())
    other.SetNumberOfTuples(array.GetNumberOfTuples())
    for k in range(array.GetNumberOfComponents()):
        other.CopyComponent(k, array, k)
    return other


def on_cells(values, name="Cells"):
    """An image whose cells are the voxels; centres of cells lie where voxels lay."""
    image = vtkImageData()
    image.SetDimensions([size + 1 for size in values.shape[::-1]])
    image.SetOrigin(-0.5, -0.5, -0.5)
    image.GetCellData().SetScalars(add_array(image.GetCellData(), name, values.ravel()))
    return image


class InputTestCase(FilterTestCase):
    def mesh(self, mesher):
        """All numbers of both outputs."""
        mesher.Update()
        self.assertEqual(mesher.GetErrorMessage() or "", "")
        self.assertGreater(mesher.GetOutput().GetNumberOfCells(), 50)
        found = []
        for output in map(mesher.GetOutputDataObject, range(2)):
            cells = output.GetPolys() if output.IsA("vtkPolyData") else output.GetCells()
            arrays = (output.GetPoints().GetData(), cells.GetConnectivityArray(), output.GetCellData().GetArray("Label"),
                      output.GetCellData().GetArray("Labels"), output.GetPointData().GetArray("Time"))
            found += [vtk_to_numpy(array).copy() for array in arrays if array]
        return found

    def check_same(self, mesher, expected):
        for found, array in zip(self.mesh(mesher), expected):
            numpy.testing.assert_array_equal(found, array)


N = 24
K, J, I = numpy.mgrid[:N, :N, :N]
BALL = (numpy.sqrt((I - 11.5) ** 2 + (J - 11.5) ** 2 + (K - 11.5) ** 2) < 6).astype(numpy.uint8)
RIGHT = numpy.where(I < 12, 0, BALL)


class Tetrahedra(InputTestCase):
    @classmethod
    def setUpClass(cls):
        cls.expected = cls().mesh(tets(voxplex.Image(BALL).to_vtk()))
        cls.right = cls().mesh(tets(voxplex.Image(RIGHT).to_vtk()))

    def test_scalars(self):
        """Of all types and in all layouts."""
        image = voxplex.Image(BALL).to_vtk()
        plain = image.GetPointData().GetScalars()
        bits = vtkBitArray()
        bits.DeepCopy(plain)
        for array in (*(converted(plain, name) for name in TYPES), apart(plain), bits):
            with self.subTest(array.GetClassName()):
                image.GetPointData().SetScalars(array)
                self.check_same(tets(image), self.expected)

    def test_choice(self):
        """Point scalars go before cell scalars; a name and an association choose any array."""
        image = voxplex.Image(BALL).to_vtk()
        cells = numpy.zeros((N - 1,) * 3, numpy.uint8)
        cells[8:15, 8:15, 8:15] = 5
        image.GetCellData().SetScalars(add_array(image.GetCellData(), "Cells", cells.ravel()))
        add_array(image.GetPointData(), "Other", numpy.zeros(N ** 3, numpy.uint8))
        mesher = tets(image)
        self.check_same(mesher, self.expected)
        mesher.SetInputArrayToProcess(0, 0, 0, CELLS, "Cells")
        mesher.SetDelta(1.0)  # a cube loses its edges
        mesh = self.mesh(mesher)
        self.assertEqual(set(mesh[2]), {5})
        corners = mesh[0][mesh[1].reshape(-1, 4)]
        volumes = numpy.linalg.det(corners[:, 1:] - corners[:, :1]) / 6
        self.assertAlmostEqual(volumes.sum() / 343, 1, delta=0.2)
        numpy.testing.assert_allclose(numpy.average(corners.mean(axis=1), axis=0, weights=volumes), 11.5, atol=0.1)
        mesher.SetInputArrayToProcess(0, 0, 0, POINTS, image.GetPointData().GetScalars().GetName())
        mesher.SetDelta(0.0)
        self.check_same(mesher, self.expected)
        image.GetPointData().Initialize()
        self.assertEqual(set(self.mesh(tets(image))[2]), {5})

    def test_untouched(self):
        """Scalars are read in place: the filter must not change them."""
        array = BALL.copy()
        self.mesh(tets(voxplex.Image(array).to_vtk()))
        numpy.testing.assert_array_equal(array, BALL)

    def test_hidden_points(self):
        """They are background, whatever their values are; duplicates are not hidden. The image stays as it is."""
        ghosts = numpy.where(I < 12, vtkDataSetAttributes.HIDDENPOINT, vtkDataSetAttributes.DUPLICATEPOINT)
        for values in (BALL, numpy.where(I < 12, -1.5, BALL).astype(numpy.float32)):
            image = voxplex.Image(values.copy()).to_vtk()
            add_array(image.GetPointData(), GHOSTS, ghosts.astype(numpy.uint8).ravel())
            self.check_same(tets(image), self.right)
            numpy.testing.assert_array_equal(voxplex.Image.from_vtk(image).voxels, values)

    def test_hidden_cells(self):
        # Points are hidden where all cells around them are: the cells from point 11 to 12 are the last hidden ones.
        grid = vtkUniformGrid()
        grid.ShallowCopy(voxplex.Image(BALL).to_vtk())
        for cell in numpy.flatnonzero(I[1:, 1:, 1:] <= 12):
            grid.BlankCell(cell)
        self.check_same(tets(grid), self.right)
        expected = self.mesh(tets(on_cells(RIGHT)))
        for kind in (vtkDataSetAttributes.HIDDENCELL, vtkDataSetAttributes.REFINEDCELL):
            image = on_cells(BALL)
            ghosts = numpy.where(I < 12, kind, vtkDataSetAttributes.DUPLICATECELL)
            add_array(image.GetCellData(), GHOSTS, ghosts.astype(numpy.uint8).ravel())
            self.check_same(tets(image), expected)
        # A cell with a hidden corner is hidden.
        image = on_cells(BALL)
        corners = numpy.zeros((N + 1,) * 3, numpy.uint8)
        corners[..., :12] = vtkDataSetAttributes.HIDDENPOINT
        add_array(image.GetPointData(), GHOSTS, corners.ravel())
        self.check_same(tets(image), expected)

    def test_hidden_sizes(self):
        """They set no bound."""
        sizes = voxplex.Image(numpy.full(BALL.shape, 0.5, numpy.float32)).to_vtk()
        add_array(sizes.GetPointData(), GHOSTS, numpy.full(BALL.size, vtkDataSetAttributes.HIDDENPOINT, numpy.uint8))
        mesher = tets(voxplex.Image(BALL).to_vtk())
        mesher.SetElementSizeData(sizes)
        self.check_same(mesher, self.expected)

    def test_rounded(self):
        """Labels that were scaled and scaled back, in single precision."""
        rounded = BALL + 1e-7 * numpy.sin(I + 3.0 * J + 7.0 * K)
        for kind in (numpy.float32, float):
            self.check_same(tets(voxplex.Image(rounded.astype(kind)).to_vtk()), self.expected)


class Pentatopes(InputTestCase):
    @classmethod
    def setUpClass(cls):
        cls.expected = cls().mesh(pentatopes(series(four_ball())))

    def test_points_and_cells(self):
        """Time steps and components, at other times."""
        times = [2.5 + 0.75 * k for k in range(9)]
        for image_of in (image_of_array, on_cells):
            frames = four_ball()[1:10]
            mesher = pentatopes(series(frames, times, image_of))
            image = image_of(frames[0])
            data = image.GetCellData() if image_of is on_cells else image.GetPointData()
            data.SetScalars(components(frames).GetPointData().GetScalars())
            other = pentatopes(image)
            other.SetTimeOrigin(2.5)
            other.SetTimeSpacing(0.75)
            self.check_same(other, self.mesh(mesher))

    def test_unequal_times(self):
        """Of a ball that does not move: the mesh is that of all frames. And times that no equal distances have."""
        still = numpy.stack([four_ball()[5]] * 8)
        some, times = still[:5], [10.0, 11.0, 12.0, 14.0, 17.0]
        expected = self.mesh(pentatopes(series(still, [10.0 + k for k in range(8)])))
        self.check_same(pentatopes(series(some, times)), expected)
        mesher, replaced = pentatopes(components(some)), pentatopes(series(some, TIMES[:5]))
        for time in times:
            mesher.AddFrameTime(time)
            replaced.AddFrameTime(time)  # in place of the times of the pipeline
        self.assertEqual((mesher.GetNumberOfFrameTimes(), mesher.GetFrameTime(3)), (5, 14.0))
        self.assertTrue(math.isnan(mesher.GetFrameTime(5)) and math.isnan(mesher.GetFrameTime(-1)))
        mesher.UpdateInformation()
        self.assertEqual(mesher.GetOutputInformation(0).Get(Pipeline.TIME_RANGE()), (10.0, 17.0))
        self.check_same(mesher, expected)
        self.check_same(replaced, expected)
        odd = pentatopes(series(some, [0.1, 1.0, 2.37, 4.01, 6.6]))
        odd.Update()
        self.assertEqual(odd.GetOutput().GetPointData().GetArray("Time").GetRange(), (0.1, 6.6))

    def test_chosen_array(self):
        """Two of several, by name."""
        image, other = components(four_ball()), components(four_ball(3.0))
        add_array(image.GetPointData(), "Other", vtk_to_numpy(other.GetPointData().GetScalars()))
        mesher = pentatopes(image)
        mesher.SetInputArrayToProcess(0, 0, 0, POINTS, "Other")
        self.check_same(mesher, self.mesh(pentatopes(other)))

    def test_scalars(self):
        """Of all types, as time steps and as components, and not contiguous in memory."""
        def image_of(frame):
            image = voxplex.Image(frame).to_vtk()
            image.GetPointData().SetScalars(converted(image.GetPointData().GetScalars(), name))
            return image

        image = components(four_ball())
        plain = image.GetPointData().GetScalars()
        for name in ("CHAR", "UNSIGNED_SHORT", "INT", "LONG", "UNSIGNED_LONG_LONG", "FLOAT", "DOUBLE", "ID_TYPE"):
            with self.subTest(name):
                self.check_same(pentatopes(series(four_ball(), image_of=image_of)), self.expected)
                image.GetPointData().SetScalars(converted(plain, name))
                self.check_same(pentatopes(image), self.expected)
        image.GetPointData().SetScalars(apart(plain))
        self.check_same(pentatopes(image), self.expected)

    def test_large_labels(self):
        """Other values in the same places: other labels, which need more bits from some frame on."""
        for left, right, kind in ((3, 300, "vtkIntArray"), (255, 256, "vtkIntArray"), (65535, 65536, "vtkIntArray"),
                                  (3, 10 ** 12, "vtkLongLongArray")):
            for late in (False, True):
                array = four_ball()
                is_right = numpy.arange(12)[:, None, None, None] > 6 if late else array == 7
                mesher = pentatopes(series(numpy.where(array, numpy.where(is_right, right, left), 0).astype(float)))
                mesher.Update()
                labels = mesher.GetOutput().GetCellData().GetArray("Label")
                self.assertEqual((labels.GetClassName(), set(vtk_to_numpy(labels))), (kind, {left, right}))

    def test_selected_labels(self):
        mesher = pentatopes(series(four_ball()))
        mesher.AddLabel(7)
        self.assertEqual(set(self.mesh(mesher)[2]), {7})
        self.assertLess(mesher.GetStatistics().GetLabelVolume(0), 1000)
        mesher.RemoveAllLabels()
        self.check_same(mesher, self.expected)

    def test_sizes(self):
        """Largest circumradius: every way to give it makes more elements."""
        mesher = pentatopes(series(four_ball()))
        mesher.SetDelta(3.0)
        without = self.mesh(mesher)
        mesher.SetElementSize(1.8)
        uniform = self.mesh(mesher)
        self.assertGreater(len(uniform[2]), 1.3 * len(without[2]))
        mesher.SetElementSize(0.0)
        mesher.SetLabelSize(7, 1.8)
        self.assertTrue(1.3 * len(without[2]) < len(self.mesh(mesher)[2]) < len(uniform[2]))
        mesher.ClearLabelSizes()
        mesher.SetElementSizeData(voxplex.Image(numpy.full((12, 12, 12), 1.8)).to_vtk())
        self.check_same(mesher, uniform)  # it applies at all times
        mesher.SetElementSizeData(None)
        self.check_same(mesher, without)

    def test_hidden(self):
        """Points that are hidden in one image or in each frame are background."""
        ghosts = numpy.where(numpy.mgrid[:12, :12, :12][2] < 4, vtkDataSetAttributes.HIDDENPOINT, 0).astype(numpy.uint8).ravel()

        def hiding(image):
            add_array(image.GetPointData(), GHOSTS, ghosts)
            return image

        shown, strange = four_ball(), four_ball().astype(numpy.float32)
        shown[..., :4], strange[..., :4] = 0, -1.5
        expected = self.mesh(pentatopes(series(shown)))
        self.check_same(pentatopes(series(strange, image_of=lambda frame: hiding(voxplex.Image(frame).to_vtk()))), expected)
        self.check_same(pentatopes(hiding(components(strange.astype(numpy.int16)))), expected)

    def test_rounded(self):
        """Labels that were scaled and scaled back."""
        array = four_ball()
        rounded = array * (1 - 1e-7) - numpy.where(array == 0, 1e-7, 0)
        for kind in (numpy.float32, float):
            self.check_same(pentatopes(series(rounded.astype(kind))), self.expected)


if __name__ == "__main__":
    unittest.main()
