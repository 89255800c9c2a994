#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Images and meshes of PyVista, ITK, SimpleITK and meshio, each where it is installed."""

import importlib.util
import unittest

import numpy

import voxplex
from phantoms import beating, brick

PLACE = dict(spacing=(0.5, 1.0, 2.0), origin=(10.0, -20.0, 30.0), direction=((0, -1, 0), (1, 0, 0), (0, 0, 1)))


def same(first, second):
    return numpy.allclose(first.points, second.points) and numpy.array_equal(first.cells, second.cells)


def needs(library):
    return unittest.skipUnless(importlib.util.find_spec(library), f"{library} is not installed")


class Libraries(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.mesh = voxplex.mesh(brick(), 2.0, threads=1, **PLACE)

    @needs("meshio")
    def test_meshio(self):
        theirs = self.mesh.to_meshio()
        numpy.testing.assert_array_equal(theirs.cells_dict["tetra"], self.mesh.cells)
        numpy.testing.assert_array_equal(theirs.cell_data["Label"][0], self.mesh.labels)
        with self.assertRaisesRegex(ValueError, "no cells for pentatopes"):
            voxplex.mesh(beating(), 2.0).to_meshio()

    @needs("SimpleITK")
    def test_simpleitk(self):
        import SimpleITK
        image = SimpleITK.GetImageFromArray(brick())
        image.SetSpacing(PLACE["spacing"])
        image.SetOrigin(PLACE["origin"])
        image.SetDirection(numpy.ravel(PLACE["direction"]).astype(float))
        self.assertTrue(same(self.mesh, voxplex.mesh(image, 2.0, threads=1)))
        series = SimpleITK.JoinSeries([SimpleITK.GetImageFromArray(frame) for frame in beating()], 1.0, 0.5)
        mesh = voxplex.mesh(series, 2.0)
        self.assertEqual((mesh.times.min(), mesh.times.max()), (1.0, 2.5))

    @needs("SimpleITK")
    def test_components(self):
        """They may be colours or vectors as well as frames."""
        import SimpleITK
        image = SimpleITK.Compose([SimpleITK.GetImageFromArray(frame.astype(numpy.int16)) for frame in beating()])
        with self.assertRaisesRegex(ValueError, "4 components in each voxel"):
            voxplex.mesh(image, 2.0)
        series = voxplex.mesh(beating(), 2.0, threads=1)
        self.assertTrue(same(series, voxplex.mesh(image, 2.0, times=range(4), threads=1)))
        self.assertTrue(same(series, voxplex.mesh([SimpleITK.GetImageFromArray(frame) for frame in beating()], 2.0, threads=1)))

    @needs("nibabel")
    def test_nibabel(self):
        import nibabel
        affine = numpy.diag((-1, -1, 1, 1)) @ numpy.block([
            [numpy.array(PLACE["direction"]) * PLACE["spacing"], numpy.array(PLACE["origin"])[:, None]], [0, 0, 0, 1]])
        image = nibabel.Nifti1Image(brick().T, affine)
        self.assertTrue(same(self.mesh, voxplex.mesh(image, 2.0, threads=1)))
        series = nibabel.Nifti1Image(beating().T, numpy.eye(4))
        series.header.set_zooms((1, 1, 1, 0.5))
        self.assertEqual(voxplex.mesh(series, 2.0).times.max(), 1.5)

    @needs("itk")
    def test_itk(self):
        import itk
        image = itk.image_from_array(brick())
        image.SetSpacing(PLACE["spacing"])
        image.SetOrigin(PLACE["origin"])
        image.SetDirection(numpy.array(PLACE["direction"], dtype=float))
        self.assertTrue(same(self.mesh, voxplex.mesh(image, 2.0, threads=1)))

    @needs("pyvista")
    def test_pyvista(self):
        import pyvista
        grid = self.mesh.to_pyvista()
        self.assertIsInstance(grid, pyvista.UnstructuredGrid)
        self.assertEqual((grid.n_cells, set(grid.cell_data["Label"])), (len(self.mesh.cells), {5, 9}))
        self.assertGreater(grid.compute_cell_sizes()["Volume"].min(), 0)
        self.assertIsInstance(self.mesh.interfaces.to_pyvista(), pyvista.PolyData)
        self.assertTrue(same(self.mesh, voxplex.mesh(pyvista.wrap(voxplex.Image(brick(), **PLACE).to_vtk()), 2.0, threads=1)))

    @needs("pyvista")
    def test_accessor(self):
        """image.voxplex.mesh(), from PyVista 0.48 on, of an installed distribution."""
        import pyvista
        if not hasattr(pyvista, "register_dataset_accessor"):
            self.skipTest("this PyVista has no accessors")
        import voxplex.pyvista_accessor
        image = pyvista.wrap(voxplex.Image(brick(), **PLACE).to_vtk())
        grid = image.voxplex.mesh(delta=2.0, threads=1)
        self.assertIsInstance(grid, pyvista.UnstructuredGrid)
        numpy.testing.assert_allclose(grid.points, self.mesh.points)


if __name__ == "__main__":
    unittest.main()
