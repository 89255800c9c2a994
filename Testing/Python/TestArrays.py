#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""NumPy arrays and VTK's memory: what is shared, and for how long."""

import gc
import unittest
import weakref

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import VTK_TRIANGLE, vtkImageData, vtkPolyData, vtkUnstructuredGrid

import voxplex
from phantoms import beating, brick


def churn():
    """Makes freed memory likely to be overwritten."""
    gc.collect()
    return [numpy.full(size, 123, dtype=numpy.uint8) for size in (100, 3840, 1000, 10000, 100000) for _ in range(20)]


class Images(unittest.TestCase):
    def scalars(self, image):
        return vtk_to_numpy(image.GetPointData().GetScalars())

    def test_shared(self):
        labels = brick()
        image = voxplex.image_from_array(labels)
        self.assertTrue(numpy.shares_memory(labels, self.scalars(image)))
        self.assertTrue(numpy.shares_memory(labels, voxplex.array_from_image(image)))
        labels[0, 0, 0] = 77
        self.assertEqual(image.GetScalarComponentAsDouble(0, 0, 0, 0), 77)
        for frame, volume in zip(voxplex.images_from_array(beating()), beating()):
            numpy.testing.assert_array_equal(voxplex.array_from_image(frame), volume)

    def test_frames_share(self):
        series = beating()
        for frame, image in zip(series, voxplex.images_from_array(series)):
            self.assertTrue(numpy.shares_memory(frame, self.scalars(image)))

    def test_shared_where_it_can_be(self):
        shared = {"transposed": numpy.asfortranarray(brick().T).T, "bool": brick() > 0}
        copied = {"stride": brick()[:, :, ::2], "byte order": brick().astype(">i2")}
        for name, array in {**shared, **copied}.items():
            with self.subTest(name):
                image = voxplex.image_from_array(array)
                self.assertEqual(numpy.shares_memory(array, self.scalars(image)), name in shared)
                numpy.testing.assert_array_equal(voxplex.array_from_image(image), array)

    def test_image_outlives_the_array(self):
        image = voxplex.image_from_array(brick())
        waste = churn()
        numpy.testing.assert_array_equal(voxplex.array_from_image(image), brick())
        copy = vtkImageData()
        copy.ShallowCopy(image)
        del image
        waste += churn()
        numpy.testing.assert_array_equal(voxplex.array_from_image(copy), brick())

    def test_array_outlives_the_image(self):
        image = vtkImageData()
        image.SetDimensions(4, 3, 2)
        image.AllocateScalars(3, 1)  # unsigned char
        for voxel in range(24):
            image.GetPointData().GetScalars().SetTuple1(voxel, voxel)
        array = voxplex.array_from_image(image)
        del image
        waste = churn()
        numpy.testing.assert_array_equal(array, numpy.arange(24).reshape(2, 3, 4))
        del waste

    def test_the_last_reference_frees(self):
        class Memory(bytearray):
            """Can be referred to weakly."""

        memory = Memory(4 * 4 * 4)
        alive = weakref.ref(memory)
        image = voxplex.image_from_array(numpy.frombuffer(memory, dtype=numpy.uint8).reshape(4, 4, 4))
        del memory
        gc.collect()
        self.assertIsNotNone(alive())
        del image
        gc.collect()
        self.assertIsNone(alive())

    def test_round_trip_of_geometry(self):
        direction = ((0, 0, 1), (-1, 0, 0), (0, 1, 0))
        image = voxplex.image_from_array(brick(), spacing=(1, 2, 3), origin=(4, 5, 6), direction=direction, space="RAS")
        self.assertEqual(image.GetDimensions(), (20, 16, 12))
        self.assertEqual(image.GetSpacing(), (1, 2, 3))
        self.assertEqual(image.GetOrigin(), (4, 5, 6))
        matrix = image.GetDirectionMatrix()
        self.assertEqual(tuple(tuple(matrix.GetElement(row, column) for column in range(3)) for row in range(3)), direction)
        self.assertEqual(image.GetFieldData().GetAbstractArray("SPACE").GetValue(0), "RAS")
        self.assertEqual(image.GetScalarComponentAsDouble(10, 5, 4, 0), 9)
        with self.assertRaisesRegex(ValueError, "space"):
            voxplex.image_from_array(brick(), space="XYZ")
        with self.assertRaisesRegex(ValueError, "scalars"):
            voxplex.array_from_image(vtkImageData())


class Meshes(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.result = voxplex.mesh(brick(), 2.0, full_output=True)
        cls.series = voxplex.mesh(beating(), 2.0, full_output=True)

    def assert_shares(self, array, vtk_array):
        self.assertTrue(numpy.shares_memory(array, vtk_to_numpy(vtk_array)))

    def test_shapes_and_memory(self):
        mesh, interfaces, _ = self.result
        cells = mesh.GetNumberOfCells()
        self.assertEqual(voxplex.points(mesh).shape, (mesh.GetNumberOfPoints(), 3))
        self.assertEqual(voxplex.points(mesh).dtype, numpy.float64)
        self.assert_shares(voxplex.points(mesh), mesh.GetPoints().GetData())
        self.assertEqual(voxplex.tets(mesh).shape, (cells, 4))
        self.assert_shares(voxplex.tets(mesh), mesh.GetCells().GetConnectivityArray())
        self.assertEqual(voxplex.labels(mesh).shape, (cells,))
        self.assert_shares(voxplex.labels(mesh), mesh.GetCellData().GetArray("Label"))
        facets = interfaces.GetNumberOfCells()
        self.assertEqual(voxplex.triangles(interfaces).shape, (facets, 3))
        self.assert_shares(voxplex.triangles(interfaces), interfaces.GetPolys().GetConnectivityArray())
        self.assertEqual(voxplex.labels(interfaces).shape, (facets, 2))
        self.assert_shares(voxplex.labels(interfaces), interfaces.GetCellData().GetArray("Labels"))
        self.assert_shares(voxplex.point_ids(interfaces), interfaces.GetPointData().GetArray("PointIds"))

    def test_contents(self):
        mesh, interfaces, _ = self.result
        for cell in (0, mesh.GetNumberOfCells() - 1):
            ids = mesh.GetCell(cell).GetPointIds()
            self.assertEqual([ids.GetId(i) for i in range(4)], list(voxplex.tets(mesh)[cell]))
        self.assertEqual(mesh.GetPoint(7), tuple(voxplex.points(mesh)[7]))
        self.assertEqual({tuple(pair) for pair in voxplex.labels(interfaces)}, {(5, 0), (9, 0), (9, 5)})
        numpy.testing.assert_array_equal(
            voxplex.points(mesh)[voxplex.point_ids(interfaces)], voxplex.points(interfaces))
        faces = {tuple(sorted(face)) for tet in voxplex.tets(mesh).tolist() for face in
                 (tet[1:], tet[:1] + tet[2:], tet[:2] + tet[3:], tet[:3])}
        for triangle in voxplex.point_ids(interfaces)[voxplex.triangles(interfaces)].tolist():
            self.assertIn(tuple(sorted(triangle)), faces)

    def test_space_time(self):
        mesh, boundary, _ = self.series
        self.assertEqual(voxplex.pentatopes(mesh).shape, (mesh.GetNumberOfCells(), 5))
        self.assert_shares(voxplex.pentatopes(mesh), mesh.GetCells().GetConnectivityArray())
        self.assert_shares(voxplex.times(mesh), mesh.GetPointData().GetArray("Time"))
        self.assert_shares(voxplex.tets(boundary), boundary.GetCells().GetConnectivityArray())

    def test_arrays_outlive_the_mesh(self):
        mesh = vtkUnstructuredGrid()
        mesh.DeepCopy(self.result.mesh)
        arrays = [voxplex.points(mesh), voxplex.tets(mesh), voxplex.labels(mesh)]
        expected = [array.copy() for array in arrays]
        del mesh
        waste = churn()
        for array, copy in zip(arrays, expected):
            numpy.testing.assert_array_equal(array, copy)
        del waste

    def test_writing_changes_the_mesh(self):
        mesh = vtkUnstructuredGrid()
        mesh.DeepCopy(self.result.mesh)
        voxplex.points(mesh)[:] += 1000.0
        mesh.GetPoints().Modified()
        self.assertGreater(mesh.GetBounds()[0], 900.0)

    def test_refusals(self):
        mesh, interfaces, _ = self.result
        mixed = vtkUnstructuredGrid()
        mixed.DeepCopy(mesh)
        mixed.InsertNextCell(VTK_TRIANGLE, 3, (0, 1, 2))
        with self.assertRaisesRegex(ValueError, f"1 of {mesh.GetNumberOfCells() + 1} cells are no tetrahedra"):
            voxplex.tets(mixed)
        with self.assertRaisesRegex(ValueError, "no tetrahedra"):
            voxplex.tets(self.series.mesh)
        with self.assertRaisesRegex(ValueError, "no pentatopes"):
            voxplex.pentatopes(mesh)
        with self.assertRaisesRegex(ValueError, "Time"):
            voxplex.times(mesh)
        with self.assertRaisesRegex(ValueError, "Label"):
            voxplex.labels(vtkUnstructuredGrid())
        quads = vtkPolyData()
        quads.DeepCopy(interfaces)
        quads.GetPolys().InsertNextCell(4, (0, 1, 2, 3))
        with self.assertRaisesRegex(ValueError, "triangles"):
            voxplex.triangles(quads)

    def test_empty(self):
        grid = vtkUnstructuredGrid()
        self.assertEqual(voxplex.points(grid).shape, (0, 3))
        self.assertEqual(voxplex.tets(grid).shape, (0, 4))
        self.assertEqual(voxplex.pentatopes(grid).shape, (0, 5))
        self.assertEqual(voxplex.triangles(vtkPolyData()).shape, (0, 3))


if __name__ == "__main__":
    unittest.main()
