#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Images and meshes as data of VTK and back: the same memory, and for how long."""

import gc
import unittest
import weakref

import numpy

import voxplex
from phantoms import ball, beating, brick

try:
    from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
    from vtkmodules.vtkCommonDataModel import (
        VTK_POLY_VERTEX, VTK_TETRA, VTK_TRIANGLE, vtkDataSetAttributes, vtkImageData, vtkPolyData, vtkUnstructuredGrid)
    from vtkmodules.vtkCommonExecutionModel import vtkTrivialProducer
except ModuleNotFoundError as missing:
    raise unittest.SkipTest("there is no VTK") from missing


def churn():
    """Makes freed memory likely to be overwritten."""
    gc.collect()
    return [numpy.full(size, 123, dtype=numpy.uint8) for size in (100, 3840, 1000, 10000, 100000) for _ in range(20)]


def scalars(image):
    """Indexed [k, j, i]."""
    return vtk_to_numpy(image.GetPointData().GetScalars()).reshape(tuple(reversed(image.GetDimensions())))


def same(first, second):
    return (numpy.array_equal(first.points, second.points) and numpy.array_equal(first.cells, second.cells)
            and numpy.array_equal(first.labels, second.labels))


class Images(unittest.TestCase):
    def test_shared(self):
        labels = brick()
        image = voxplex.Image(labels).to_vtk()
        self.assertTrue(numpy.shares_memory(labels, scalars(image)))
        self.assertTrue(numpy.shares_memory(labels, voxplex.Image.from_vtk(image).voxels))
        labels[0, 0, 0] = 77
        self.assertEqual(image.GetScalarComponentAsDouble(0, 0, 0, 0), 77)
        series = beating()
        for frame, volume in zip(voxplex.Image(series).to_vtk(), series):
            numpy.testing.assert_array_equal(scalars(frame), volume)
            self.assertTrue(numpy.shares_memory(volume, scalars(frame)))

    def test_shared_where_it_can_be(self):
        shared = {"transposed": numpy.asfortranarray(brick().T).T, "bool": brick() > 0}
        copied = {"stride": brick()[:, :, ::2], "byte order": brick().astype(">i2")}
        for name, array in {**shared, **copied}.items():
            with self.subTest(name):
                image = voxplex.Image(array).to_vtk()
                self.assertEqual(numpy.shares_memory(array, scalars(image)), name in shared)
                numpy.testing.assert_array_equal(scalars(image), array)

    def test_image_outlives_the_array(self):
        image = voxplex.Image(brick()).to_vtk()
        waste = churn()
        numpy.testing.assert_array_equal(scalars(image), brick())
        copy = vtkImageData()
        copy.ShallowCopy(image)
        del image
        waste += churn()
        numpy.testing.assert_array_equal(scalars(copy), brick())

    def test_array_outlives_the_image(self):
        image = vtkImageData()
        image.SetDimensions(4, 3, 2)
        image.AllocateScalars(3, 1)  # unsigned char
        for voxel in range(24):
            image.GetPointData().GetScalars().SetTuple1(voxel, voxel)
        array = voxplex.Image.from_vtk(image).voxels
        del image
        waste = churn()
        numpy.testing.assert_array_equal(array, numpy.arange(24).reshape(2, 3, 4))
        del waste

    def test_the_last_reference_frees(self):
        class Memory(bytearray):
            """Can be referred to weakly."""

        memory = Memory(4 * 4 * 4)
        alive = weakref.ref(memory)
        image = voxplex.Image(numpy.frombuffer(memory, dtype=numpy.uint8).reshape(4, 4, 4)).to_vtk()
        del memory
        gc.collect()
        self.assertIsNotNone(alive())
        del image
        gc.collect()
        self.assertIsNone(alive())

    def test_round_trip(self):
        direction = ((0, 0, 1), (-1, 0, 0), (0, 1, 0))
        before = voxplex.Image(brick(), spacing=(1, 2, 3), origin=(4, 5, 6), direction=direction, space="RAS",
                               names={5: "liver", 9: "spleen"})
        image = before.to_vtk()
        self.assertEqual(image.GetDimensions(), (20, 16, 12))
        self.assertEqual(image.GetSpacing(), (1, 2, 3))
        self.assertEqual(image.GetOrigin(), (4, 5, 6))
        matrix = image.GetDirectionMatrix()
        self.assertEqual(tuple(tuple(matrix.GetElement(row, column) for column in range(3)) for row in range(3)), direction)
        self.assertEqual(image.GetFieldData().GetAbstractArray("SPACE").GetValue(0), "RAS")
        self.assertEqual(image.GetScalarComponentAsDouble(10, 5, 4, 0), 9)
        after = voxplex.Image.from_vtk(image)
        self.assertEqual((after.spacing, after.origin, after.space, after.names),
                         (before.spacing, before.origin, "RAS", {5: "liver", 9: "spleen"}))
        numpy.testing.assert_array_equal(after.direction, direction)

    def test_extent_and_cells(self):
        """The first voxel lies where the extent begins; of cells in the middle of the first one."""
        image = vtkImageData()
        image.SetExtent(2, 5, 0, 2, 0, 1)
        image.SetSpacing(2, 1, 1)
        image.GetPointData().SetScalars(numpy_to_vtk(numpy.arange(24, dtype=numpy.uint8)))
        self.assertEqual(voxplex.Image.from_vtk(image).origin, [4, 0, 0])
        image.GetPointData().Initialize()
        image.GetCellData().SetScalars(numpy_to_vtk(numpy.arange(6, dtype=numpy.uint8)))
        cells = voxplex.Image.from_vtk(image)
        self.assertEqual((cells.origin, cells.voxels.shape), ([5, 0.5, 0.5], (1, 2, 3)))
        with self.assertRaisesRegex(ValueError, "scalars"):
            voxplex.Image.from_vtk(vtkImageData())

    def test_lengths_of_directions(self):
        """VTK takes matrices of any columns: their lengths belong to the spacing."""
        image = voxplex.Image(brick(), spacing=(1, 2, 3), origin=(4, 5, 6)).to_vtk()
        image.SetDirectionMatrix(0, -2, 0, 0.5, 0, 0, 0, 0, 1)
        found = voxplex.Image.from_vtk(image)
        numpy.testing.assert_allclose(found.spacing, (0.5, 4, 3))
        numpy.testing.assert_array_equal(found.direction, ((0, -1, 0), (1, 0, 0), (0, 0, 1)))
        self.assertEqual(found.origin, [4, 5, 6])

    def test_which_array(self):
        """The active one, else the only one, or that of a name; of points or of cells."""
        def array(name, count, value):
            result = numpy_to_vtk(numpy.full(count, value, dtype=numpy.uint8), deep=True)
            result.SetName(name)
            return result

        def image(*arrays):
            result = vtkImageData()
            result.SetDimensions(4, 3, 3)
            for name, of_cells, value in arrays:
                data = result.GetCellData() if of_cells else result.GetPointData()
                data.AddArray(array(name, 12 if of_cells else 36, value))
            return result

        def value(data, **arguments):
            found = voxplex.Image.from_vtk(data, **arguments).voxels
            self.assertIn(found.shape, ((3, 3, 4), (2, 2, 3)))
            return (found.size == 12, int(found.max()))

        for of_cells in (False, True):
            alone = image(("labels", of_cells, 3))
            alone.GetPointData().AddArray(array("vtkGhostType", 36, 0))
            vectors = numpy_to_vtk(numpy.zeros((36, 3)), deep=True)
            alone.GetPointData().SetVectors(vectors)
            self.assertEqual(value(alone), (of_cells, 3))
            self.assertFalse(alone.GetPointData().GetScalars() or alone.GetCellData().GetScalars())
        several = image(("ct", False, 1), ("labels", False, 2), ("ct", True, 3), ("organs", True, 4))
        for frames in (several, [several, several]):
            words = ("several arrays that could be labels .'ct' of the points, 'labels' of the points, 'ct' of the cells, 'organs' of "
                     "the cells.; choose one with scalars=")
            with self.assertRaisesRegex(ValueError, words):
                voxplex.mesh(frames)
        self.assertEqual((value(several, scalars="labels"), value(several, scalars="organs")), ((False, 2), (True, 4)))
        with self.assertRaisesRegex(ValueError, "'ct' of the points, 'ct' of the cells"):
            voxplex.mesh(several, scalars="ct")
        with self.assertRaisesRegex(ValueError, "no array 'none'"):
            voxplex.quality(voxplex.mesh(brick(), 3), several, scalars="none")
        several.GetCellData().SetActiveScalars("ct")
        self.assertEqual((value(several), value(several, scalars="ct"), value(several, scalars="labels")), ((True, 3), (True, 3), (False, 2)))
        several.GetPointData().SetActiveScalars("labels")
        self.assertEqual(value(several), (False, 2))
        self.assertEqual(voxplex.Image.from_vtk([several, several], scalars="organs").voxels.max(), 4)
        with self.assertRaisesRegex(ValueError, "scalars: only for images of VTK"):
            voxplex.mesh(brick(), scalars="labels")

    def test_hidden_voxels(self):
        labels = ball(radii=(8, 5))
        mask = numpy.zeros(labels.shape, dtype=bool)
        mask[:, :, :12] = True
        expected = voxplex.mesh(numpy.where(mask, 0, labels), 2.0, threads=1)
        for kind in (numpy.uint8, numpy.int64, numpy.float32, float, ">i2"):
            image = voxplex.Image(numpy.ma.masked_array(labels.astype(kind), mask)).to_vtk()
            self.assertEqual(vtk_to_numpy(image.GetPointData().GetArray("vtkGhostType")).sum(), 2 * mask.sum())
            self.assertTrue(same(expected, voxplex.mesh(image, 2.0, threads=1)), kind)

    def test_hidden_by_points_and_cells(self):
        """By the rule of the program and the filters (ImageVoxels.h)."""
        random = numpy.random.default_rng(1)
        flags = [0, 0, 0, vtkDataSetAttributes.HIDDENCELL, vtkDataSetAttributes.REFINEDCELL, vtkDataSetAttributes.DUPLICATECELL]
        point_flags = [0, 0, 0, vtkDataSetAttributes.HIDDENPOINT, vtkDataSetAttributes.DUPLICATEPOINT]
        for of_cells in (False, True):
            for hides in ("points", "cells", "both"):
                image = vtkImageData()
                image.SetExtent(1, 5, 0, 4, 2, 5)
                data, shape = (image.GetCellData(), (3, 4, 4)) if of_cells else (image.GetPointData(), (4, 5, 5))
                data.SetScalars(numpy_to_vtk(numpy.full(shape, 7, numpy.uint8).reshape(-1), deep=True))
                points = numpy.array(random.choice(point_flags, (4, 5, 5)), numpy.uint8)
                cells = numpy.array(random.choice(flags, (3, 4, 4)), numpy.uint8)
                for name, target, ghosts in (("points", image.GetPointData(), points), ("cells", image.GetCellData(), cells)):
                    if hides in (name, "both"):
                        array = numpy_to_vtk(ghosts.reshape(-1), deep=True)
                        array.SetName("vtkGhostType")
                        target.AddArray(array)
                    else:
                        ghosts[:] = 0
                hidden_points = (points & vtkDataSetAttributes.HIDDENPOINT) != 0
                hidden_cells = (cells & (vtkDataSetAttributes.HIDDENCELL | vtkDataSetAttributes.REFINEDCELL)) != 0
                around = numpy.ones((4, 5, 5), bool)
                corner = numpy.zeros((3, 4, 4), bool)
                for k, j, i in numpy.ndindex(2, 2, 2):
                    around[k:k + 3, j:j + 4, i:i + 4] &= hidden_cells
                    corner |= hidden_points[k:k + 3, j:j + 4, i:i + 4]
                expected = hidden_cells | corner if of_cells else hidden_points | around
                with self.subTest(of_cells=of_cells, hides=hides):
                    self.assertTrue(0 < expected.sum() < expected.size)
                    read = voxplex.Image.from_vtk(image)
                    numpy.testing.assert_array_equal(read.mask, expected)


class Sources(unittest.TestCase):
    """What mesh() takes of VTK."""

    def test_image_and_pipeline(self):
        image = voxplex.Image(brick(), spacing=(1, 1, 2)).to_vtk()
        reference = voxplex.mesh(brick(), 1.5, spacing=(1, 1, 2), threads=1)
        self.assertTrue(same(reference, voxplex.mesh(image, 1.5, threads=1)))
        producer = vtkTrivialProducer()
        producer.SetOutput(image)
        producer.SetWholeExtent(image.GetExtent())
        self.assertTrue(same(reference, voxplex.mesh(producer, 1.5, threads=1)))

    def test_frames(self):
        frames = voxplex.Image(beating(), times=(0.0, 2.0, 4.0, 6.0)).to_vtk()
        for times, ends in ((None, (0, 6)), ((1, 2, 3.5, 4), (1, 4))):
            mesh = voxplex.mesh(frames, 2.0, times=times)
            self.assertEqual((mesh.times.min(), mesh.times.max()), ends)
        undated = [voxplex.Image(frame).to_vtk() for frame in beating()]
        self.assertEqual(voxplex.mesh(undated, 2.0).times.max(), 3)
        with self.assertRaisesRegex(ValueError, "frame 0 has no time, but others have"):
            voxplex.mesh([undated[0], *frames[1:]], 2.0)
        with self.assertRaisesRegex(ValueError, "different shapes"):
            voxplex.mesh([undated[0], voxplex.Image(brick()).to_vtk()], 2.0)
        with self.assertRaisesRegex(ValueError, "frame 1 does not lie where frame 0 lies"):
            voxplex.mesh([undated[0], voxplex.Image(beating()[1], origin=(0, 0, 1)).to_vtk()], 2.0)
        with self.assertRaisesRegex(ValueError, "two frames or more"):
            voxplex.mesh(undated[:1], 2.0)

    def test_components(self):
        frames = beating()
        image = voxplex.Image(frames[0]).to_vtk()
        array = numpy.moveaxis(frames, 0, -1).reshape(-1, len(frames)).copy()
        image.GetPointData().SetScalars(numpy_to_vtk(array))
        reference = voxplex.mesh(frames, 2.0, threads=1)
        for times in (range(4), numpy.arange(4)):
            self.assertTrue(same(reference, voxplex.mesh(image, 2.0, times=times, threads=1)))
        with self.assertRaisesRegex(ValueError, "4 frames, and 2 times"):
            voxplex.mesh(image, 2.0, times=(5.0, 7.0))

    def test_components_without_times(self):
        """They may be colours or vectors as well as frames."""
        frames = beating()
        image = voxplex.Image(frames[0]).to_vtk()
        producer = vtkTrivialProducer()
        producer.SetOutput(image)
        for components in (2, 3, 4):
            for kind in (numpy.uint8, numpy.int32, float):
                array = numpy.moveaxis(frames[:components], 0, -1).reshape(-1, components).astype(kind)
                image.GetPointData().SetScalars(numpy_to_vtk(array, deep=True))
                for source in (image, producer):
                    words = f"{components} components .* pass their times .* extract one"
                    with self.subTest(components=components, kind=kind), self.assertRaisesRegex(ValueError, words):
                        voxplex.mesh(source, 2.0)
        with self.assertRaisesRegex(ValueError, "4 components"):
            voxplex.quality(voxplex.mesh(frames, 2.0), image)


class Meshes(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.mesh = voxplex.mesh(voxplex.Image(brick(), names={5: "liver"}, space="LPS"), 2.0)
        cls.series = voxplex.mesh(beating(), 2.0)

    def assert_shares(self, array, vtk_array):
        self.assertTrue(numpy.shares_memory(array, vtk_to_numpy(vtk_array)))

    def test_tetrahedra(self):
        mesh = self.mesh
        grid = mesh.to_vtk()
        self.assertEqual((grid.GetNumberOfPoints(), grid.GetNumberOfCells()), (len(mesh.points), len(mesh.cells)))
        self.assert_shares(mesh.points, grid.GetPoints().GetData())
        self.assert_shares(mesh.cells, grid.GetCells().GetConnectivityArray())
        self.assert_shares(mesh.labels, grid.GetCellData().GetArray("Label"))
        for cell in (0, len(mesh.cells) - 1):
            ids = grid.GetCell(cell).GetPointIds()
            self.assertEqual(grid.GetCellType(cell), VTK_TETRA)
            self.assertEqual([ids.GetId(i) for i in range(4)], list(mesh.cells[cell]))
        self.assertEqual(grid.GetPoint(7), tuple(mesh.points[7]))
        fields = grid.GetFieldData()
        self.assertEqual([fields.GetAbstractArray(name).GetValue(0) for name in ("LabelNames", "SPACE")], ["liver", "LPS"])

    def test_interfaces(self):
        interfaces = self.mesh.interfaces
        surface = interfaces.to_vtk()
        self.assertIsInstance(surface, vtkPolyData)
        self.assertEqual(surface.GetNumberOfPolys(), len(interfaces.cells))
        self.assert_shares(interfaces.cells, surface.GetPolys().GetConnectivityArray())
        self.assert_shares(interfaces.labels, surface.GetCellData().GetArray("Labels"))

    def test_space_time(self):
        mesh = self.series
        grid = mesh.to_vtk()
        self.assertEqual({grid.GetCellType(cell) for cell in range(grid.GetNumberOfCells())}, {VTK_POLY_VERTEX})
        self.assert_shares(mesh.cells, grid.GetCells().GetConnectivityArray())
        self.assert_shares(mesh.times, grid.GetPointData().GetArray("Time"))
        boundary = mesh.interfaces.to_vtk()
        self.assertEqual(boundary.GetCellType(0), VTK_TETRA)

    def test_round_trip(self):
        for mesh in (self.mesh, self.series):
            back = voxplex.Mesh.from_vtk(mesh.to_vtk())
            self.assertTrue(same(mesh, back))
            self.assertEqual(back.names, mesh.names)
            self.assertTrue(numpy.shares_memory(mesh.points, back.points))
            surfaces = voxplex.Interfaces.from_vtk(mesh.interfaces.to_vtk())
            self.assertTrue(same(mesh.interfaces, surfaces))

    def test_interfaces_that_are_not_known(self):
        """They are made of the labels, with the numbers of the mesh's points, also if no element uses some of these."""
        def facets(one):
            return {(tuple(sorted(cell)), tuple(pair)) for cell, pair in
                    zip(one.interfaces.point_ids[one.interfaces.cells].tolist(), one.interfaces.labels.tolist())}

        for mesh in (self.mesh, self.series):
            back = voxplex.Mesh.from_vtk(mesh.to_vtk())
            self.assertEqual(facets(back), facets(mesh))
            numpy.testing.assert_array_equal(back.points[back.interfaces.point_ids], back.interfaces.points)
        part = voxplex.Mesh(self.mesh.points, self.mesh.cells[self.mesh.labels == 9],
                            cell_data={"Label": self.mesh.labels[self.mesh.labels == 9]})
        self.assertEqual({pair for _, pair in facets(part)}, {(9, 0)})
        numpy.testing.assert_array_equal(part.points[part.interfaces.point_ids], part.interfaces.points)
        with self.assertRaisesRegex(voxplex.MeshingError, "no array .Label."):
            voxplex.Mesh(self.mesh.points, self.mesh.cells).interfaces

    def test_grid_outlives_the_mesh(self):
        grid = voxplex.mesh(brick(), 2.0, threads=1).to_vtk()
        waste = churn()
        self.assertTrue(same(voxplex.mesh(brick(), 2.0, threads=1), voxplex.Mesh.from_vtk(grid)))
        del waste

    def test_arrays_outlive_the_grid(self):
        grid = vtkUnstructuredGrid()
        grid.DeepCopy(self.mesh.to_vtk())
        mesh = voxplex.Mesh.from_vtk(grid)
        del grid
        waste = churn()
        self.assertTrue(same(mesh, self.mesh))
        del waste

    def test_writing_changes_the_grid(self):
        grid = vtkUnstructuredGrid()
        grid.DeepCopy(self.mesh.to_vtk())
        voxplex.Mesh.from_vtk(grid).points[:] += 1000.0
        grid.GetPoints().Modified()
        self.assertGreater(grid.GetBounds()[0], 900.0)

    def test_refusals(self):
        mixed = vtkUnstructuredGrid()
        mixed.DeepCopy(self.mesh.to_vtk())
        mixed.InsertNextCell(VTK_TRIANGLE, 3, (0, 1, 2))
        quads = vtkPolyData()
        quads.DeepCopy(self.mesh.interfaces.to_vtk())
        quads.GetPolys().InsertNextCell(4, (0, 1, 2, 3))
        for kind, data in ((voxplex.Mesh, mixed), (voxplex.Interfaces, quads)):
            with self.assertRaisesRegex(ValueError, "not all of one kind"):
                kind.from_vtk(data)
        with self.assertRaisesRegex(ValueError, "no point array Time"):
            self.mesh.times
        with self.assertRaisesRegex(ValueError, "no cell array Label"):
            voxplex.Mesh.from_vtk(vtkUnstructuredGrid()).labels
        with self.assertRaisesRegex(ValueError, "3 corners, those of a voxplex.Mesh 4 or 5"):
            voxplex.Mesh.from_vtk(self.mesh.interfaces.to_vtk())
        with self.assertRaisesRegex(TypeError, "not (vtk)?ImageData"):
            voxplex.Mesh.from_vtk(vtkImageData())

    def test_arrays_of_any_kind(self):
        mesh = voxplex.mesh(brick(), 2.0)
        expected = mesh.points.copy()
        mesh.points = mesh.points.astype(">f8")
        mesh.cell_data["Half"] = (mesh.labels == 5).astype(">f2")
        mesh.cell_data["Is5"] = mesh.labels == 5
        grid = mesh.to_vtk()
        numpy.testing.assert_array_equal(vtk_to_numpy(grid.GetPoints().GetData()), expected)
        for name in ("Half", "Is5"):
            numpy.testing.assert_array_equal(vtk_to_numpy(grid.GetCellData().GetArray(name)), mesh.labels == 5)
        mesh.cell_data["Half"] = numpy.ones(3)
        with self.assertRaisesRegex(ValueError, r"cell_data\['Half'\] has 3 rows, not"):
            mesh.to_vtk()
        mesh.cell_data["Half"] = numpy.array(["a"] * len(mesh.cells))
        with self.assertRaisesRegex(TypeError, "array 'Half' has elements of type <U1"):
            mesh.to_vtk()
        mesh.cells = mesh.cells + len(mesh.points)
        with self.assertRaisesRegex(ValueError, "cells must be numbers of points, from 0 to"):
            mesh.to_vtk()

    def test_empty(self):
        mesh = voxplex.Mesh.from_vtk(vtkUnstructuredGrid())
        self.assertEqual((mesh.points.shape, mesh.cells.shape), ((0, 3), (0, 4)))
        self.assertEqual(voxplex.Interfaces.from_vtk(vtkPolyData()).cells.shape, (0, 3))
        self.assertEqual(mesh.to_vtk().GetNumberOfCells(), 0)


if __name__ == "__main__":
    unittest.main()
