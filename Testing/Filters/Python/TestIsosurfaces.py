#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Isosurfaces of grey values, in space and in space-time. What holds for every mesh: Stress.Dimension-iso."""
import math
import unittest

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkDataSetAttributes, vtkImageData

import voxplex
from temporal import Series
from filter_testing import FilterTestCase, add_array, components, image_of_array, pentatopes, tets
from TestInputs import GHOSTS, converted, on_cells

N, MIDDLE = 26, 12.5
K, J, I = numpy.mgrid[:N, :N, :N] - MIDDLE
DEPTH = 8 - numpy.sqrt(I * I + J * J + K * K)  # in a ball of radius 8
VOLUME = 4 / 3 * math.pi


class IsosurfaceTestCase(FilterTestCase):
    def made(self, mesher, isovalue):
        mesher.SetInputModeToIsosurface()
        mesher.SetIsovalue(isovalue)
        mesher.Update()
        self.assertEqual(mesher.GetErrorMessage() or "", "")
        self.assertGreater(mesher.GetOutput().GetNumberOfCells(), 100)
        return mesher

    def check_same(self, first, second):
        numpy.testing.assert_array_equal(voxplex.Mesh.from_vtk(first.GetOutput()).points, voxplex.Mesh.from_vtk(second.GetOutput()).points)
        numpy.testing.assert_array_equal(*(vtk_to_numpy(mesher.GetOutput().GetCells().GetConnectivityArray())
                                           for mesher in (first, second)))


class Tetrahedra(IsosurfaceTestCase):
    def mesh(self, image, isovalue, fit=True):
        mesher = tets(image if isinstance(image, vtkImageData) else voxplex.Image(image).to_vtk())
        mesher.SetDelta(2.0)
        mesher.SetFitInterfaces(fit)
        return self.made(mesher, isovalue)

    def volume(self, mesher):
        corners = voxplex.Mesh.from_vtk(mesher.GetOutput()).points[voxplex.Mesh.from_vtk(mesher.GetOutput()).cells]
        volumes = numpy.linalg.det(corners[:, 1:] - corners[:, :1]) / 6
        self.assertGreater(volumes.min(), 0)
        return volumes.sum()

    def largest_distance(self, mesher, centre=MIDDLE):
        """Of a vertex on the interface from the ball."""
        return abs(numpy.linalg.norm(voxplex.Interfaces.from_vtk(mesher.GetInterfaces()).points - centre, axis=1) - 8).max()

    def test_distance(self):
        values = DEPTH.astype(numpy.float32)
        mesher = self.mesh(values, 0.0)
        self.assertEqual(set(voxplex.Mesh.from_vtk(mesher.GetOutput()).labels), {1})
        self.assertLess(self.largest_distance(self.mesh(values, 0.0, fit=False)), 0.05)
        figure = mesher.GetStatistics().GetFigure
        self.assertEqual([figure("/isosurface/value"), figure("/isosurface/range/0"), figure("/isosurface/range/1")],
                         [0, values.min(), values.max()])
        self.assertIn('"isosurface":{"value":0.0,"inside":"above","range":[-', mesher.GetStatistics().ToJSON())
        mesher.SetDelta(1.2)
        smaller = self.volume(self.made(mesher, 2.0)) / (VOLUME * 6 ** 3)
        self.assertTrue(0.93 < smaller < 1.01, smaller)
        self.assertIn('"isosurface":null', voxplex.vtkImageToTetMeshFilter().GetStatistics().ToJSON())

    def test_types(self):
        values = numpy.maximum(0.0, numpy.round(60 + 4 * DEPTH))
        for name in ("CHAR", "UNSIGNED_CHAR", "SHORT", "UNSIGNED_SHORT", "INT", "UNSIGNED_INT", "LONG", "LONG_LONG", "ID_TYPE",
                     "FLOAT", "DOUBLE"):
            with self.subTest(name):
                image = voxplex.Image(values).to_vtk()
                image.GetPointData().SetScalars(converted(image.GetPointData().GetScalars(), name))
                self.assertLess(self.largest_distance(self.mesh(image, 60.25)), 0.3)

    def test_hidden(self):
        """Voxels that are hidden are outside, as NaN is, whatever their values; in all types."""
        values = numpy.round(4 * DEPTH)
        ghosts = numpy.where(I < 0, vtkDataSetAttributes.HIDDENPOINT, 0).astype(numpy.uint8).ravel()
        for side in (0, 1):
            def mesh(image):
                mesher = tets(image)
                mesher.SetInside(side)
                return self.made(mesher, 0.5)

            expected = mesh(voxplex.Image(numpy.where(I < 0, math.nan, values)).to_vtk())
            for kind in (numpy.int8, numpy.int16, numpy.int32, numpy.float32, float):
                image = voxplex.Image(values.astype(kind)).to_vtk()
                add_array(image.GetPointData(), GHOSTS, ghosts)
                self.check_same(mesh(image), expected)

    def test_placement(self):
        """Spacing, origin, tilted and left-handed axes, an extent that does not begin at 0, cell scalars."""
        c, s = math.cos(0.5), math.sin(0.5)
        direction = numpy.array(((c, -s, 0), (s, c, 0), (0, 0, -1)))
        k, j, i = numpy.mgrid[:N, :N, :N]
        index = numpy.stack((i, j, k), axis=-1)
        for image_of in (image_of_array, on_cells):
            places = index * (0.8, 1.1, 1.0) @ direction.T
            centre = numpy.array((12.4, 12.6, 12.2)) * (0.8, 1.1, 1.0) @ direction.T
            image = image_of((8 - numpy.linalg.norm(places - centre, axis=-1)).astype(numpy.float32))
            first, last = image.GetExtent()[::2], image.GetExtent()[1::2]
            shift = numpy.array((3, -5, 2))
            image.SetExtent([int(n) for pair in zip(first + shift, last + shift) for n in pair])
            first_voxel = shift + (0.5 if image_of is on_cells else 0.0)
            image.SetOrigin(-first_voxel * (0.8, 1.1, 1.0) @ direction.T)
            image.SetSpacing(0.8, 1.1, 1.0)
            image.SetDirectionMatrix(direction.ravel())
            distance = self.largest_distance(self.mesh(image, 0.5), centre)
            self.assertAlmostEqual(distance, 0.5, delta=0.06)

    def test_sides(self):
        above, below = self.mesh(DEPTH, 0.25), tets(voxplex.Image(-DEPTH).to_vtk())
        below.SetDelta(2.0)
        below.SetInsideToBelow()
        self.check_same(above, self.made(below, -0.25))
        # The label of the inside, which may have a size.
        coarse = above.GetOutput().GetNumberOfCells()
        above.SetInsideLabel(77)
        above.SetLabelSize(77, 1.5)
        above.Update()
        self.assertEqual(set(voxplex.Mesh.from_vtk(above.GetOutput()).labels), {77})
        self.assertGreater(above.GetOutput().GetNumberOfCells(), 2 * coarse)

    def test_smoothing(self):
        noise = numpy.random.default_rng(1).uniform(-0.6, 0.6, DEPTH.shape)
        mesher = self.mesh(DEPTH + noise, 0.0)
        rough = self.largest_distance(mesher)
        mesher.SetSmoothingSigma(3.0)  # about labels only
        mesher.Update()
        self.assertEqual(self.largest_distance(mesher), rough)
        mesher.SetIsosurfaceSmoothingSigma(1.5)
        mesher.Update()
        self.assertLess(self.largest_distance(mesher), 0.5 * rough)


def moving(frames=6, depth_of=lambda depth, time: depth, kind=float):
    """How deep points are in a ball of radius 4 that moves along x."""
    k, j, i = numpy.mgrid[:12, :12, :12]
    return [depth_of(4 - numpy.sqrt((i - 5 - 0.25 * time) ** 2 + (j - 5.5) ** 2 + (k - 5.5) ** 2), time).astype(kind)
            for time in range(frames)]


class Pentatopes(IsosurfaceTestCase):
    TIMES = [float(time) for time in range(6)]
    HYPERVOLUME = 5 * VOLUME * 4 ** 3

    def mesh(self, source, isovalue=0.0):
        mesher = pentatopes(source)
        mesher.SetDelta(1.25)
        mesher.PickingRegionsOn()  # without them volumes are less exact
        return self.made(mesher, isovalue)

    def series(self, frames, isovalue=0.0, times=TIMES):
        return self.mesh(Series(map(image_of_array, frames), times), isovalue)

    def volume(self, mesher):
        mesh = mesher.GetOutput()
        points = numpy.column_stack((voxplex.Mesh.from_vtk(mesh).points, voxplex.Mesh.from_vtk(mesh).times))
        corners = points[voxplex.Mesh.from_vtk(mesh).cells]
        volumes = numpy.linalg.det(corners[:, 1:] - corners[:, :1]) / 24
        self.assertGreater(volumes.min(), 0)
        return volumes.sum()

    def test_ball(self):
        """The same mesh in both ways to hand over frames, with the ball's hypervolume."""
        series = self.series(moving())
        self.assertAlmostEqual(self.volume(series) / self.HYPERVOLUME, 1, delta=0.04)
        figure = series.GetStatistics().GetFigure
        self.assertEqual((figure("/isosurface/value"), figure("/isosurface/range/1")), (0, max(map(numpy.max, moving()))))
        self.check_same(self.mesh(components(moving())), series)
        rounded = self.series(moving(kind=numpy.float32))
        self.assertAlmostEqual(self.volume(rounded) / self.HYPERVOLUME, 1, delta=0.04)

    def test_types(self):
        """Whole values in all types: the same mesh, whether they are kept as float or double."""
        def frames(kind):
            return moving(depth_of=lambda depth, _: numpy.round(60 + 8 * depth), kind=kind)

        expected = self.series(frames(float), 60.25)
        for kind in (numpy.int8, numpy.int16, numpy.uint16, numpy.int32, numpy.int64, numpy.float32):
            self.check_same(self.series(frames(kind), 60.25), expected)

    def test_mixed_types(self):
        """A type that float does not hold, from the second frame on."""
        frames = moving(depth_of=lambda depth, _: 16777217 + numpy.round(8 * depth))
        frames = [frames[0].astype(numpy.float32), *(frame.astype(numpy.int32) for frame in frames[1:])]
        mesher = self.series(frames, 16777217.0)
        self.assertAlmostEqual(self.volume(mesher) / self.HYPERVOLUME, 1, delta=0.05)

    def test_unequal_times(self):
        """A frame is missing; values that are linear in time are made again exactly."""
        still = moving(1)[0]
        whole, some = (self.series([still + 0.25 * time for time in times], times=times)
                       for times in (self.TIMES, [0.0, 1.0, 2.0, 4.0, 5.0]))
        self.assertAlmostEqual(self.volume(some) / self.volume(whole), 1, delta=1e-3)

    def test_side_and_label(self):
        mesher = pentatopes(Series(map(image_of_array, moving(depth_of=lambda depth, _: -depth)), self.TIMES))
        mesher.SetDelta(1.25)
        mesher.PickingRegionsOn()
        mesher.SetInsideToBelow()
        mesher.SetInsideLabel(12)
        self.made(mesher, 0.0)
        self.assertEqual(set(voxplex.Mesh.from_vtk(mesher.GetOutput()).labels), {12})
        self.assertAlmostEqual(self.volume(mesher) / self.HYPERVOLUME, 1, delta=0.04)


if __name__ == "__main__":
    unittest.main()
