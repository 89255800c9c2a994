#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Images and meshes of PyVista, ITK, SimpleITK and meshio, each where it is installed."""

import importlib.util
import tempfile
import unittest
from pathlib import Path

import numpy

import voxplex
from voxplex.images import image_of
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

    @needs("nibabel")
    def test_nibabel_and_its_file(self):
        """They lie at the same place and time, whatever the units; without a place as nibabel says."""
        import nibabel
        series = nibabel.Nifti1Image(beating().T, numpy.diag((-1.0, 2.0, 3.0, 1.0)) + numpy.eye(4)[:, 3:] * (4, 5, 6, 0))
        series.header["toffset"] = 500
        series.header.set_zooms((1, 2, 3, 250))
        with tempfile.TemporaryDirectory() as folder:
            for units in (("mm", "sec"), ("micron", "msec"), ("meter", "usec"), ("unknown", "unknown")):
                series.header.set_xyzt_units(*units)
                path = Path(folder, "series.nii")
                nibabel.save(series, path)
                ours, theirs = voxplex.read_segmentation(path), image_of(series, {}, None)
                for ours_, theirs_ in ((ours.spacing, theirs.spacing), (ours.origin, theirs.origin), (ours.times, theirs.times),
                                       (ours.direction, theirs.direction), (ours.voxels, theirs.voxels)):
                    numpy.testing.assert_allclose(ours_, theirs_, rtol=1e-6)
            data = bytearray(path.read_bytes())
            data[252:256] = bytes(4)  # the codes of qform and sform
            path.write_bytes(data)
            with self.assertWarnsRegex(voxplex.MeshingWarning, "axes are taken for those of RAS, from 0 on"):
                self.assertEqual(voxplex.read_segmentation(path).origin, [0, 0, 0])
            affine = numpy.diag((-1, -1, 1, 1)) @ nibabel.load(path).affine
            numpy.testing.assert_allclose(image_of(nibabel.load(path), {}, None).origin, affine[:3, 3])

    @needs("SimpleITK")
    @needs("nibabel")
    def test_masks(self):
        """One of each, by name; SimpleITK's is in LPS, nibabel's affine in RAS."""
        import SimpleITK
        import nibabel
        low, high = (brick() == 5).astype(numpy.uint8), (brick() == 9).astype(numpy.uint8)
        first = SimpleITK.GetImageFromArray(low)
        first.SetSpacing(PLACE["spacing"])
        first.SetOrigin(PLACE["origin"])
        first.SetDirection(numpy.ravel(PLACE["direction"]).astype(float))
        affine = numpy.diag((-1, -1, 1, 1)) @ numpy.block([
            [numpy.array(PLACE["direction"]) * PLACE["spacing"], numpy.array(PLACE["origin"])[:, None]], [0, 0, 0, 1]])
        masks = {"low": first, "high": nibabel.Nifti1Image(high.T, affine)}
        image = image_of(masks, {}, None)
        numpy.testing.assert_array_equal(image.voxels, low + 2 * high)
        for ours, theirs in ((image.spacing, PLACE["spacing"]), (image.origin, PLACE["origin"]), (image.direction, PLACE["direction"])):
            numpy.testing.assert_allclose(ours, theirs, atol=1e-9)
        mesh = voxplex.mesh(masks, 2.0, threads=1)
        self.assertEqual((mesh.names, mesh.space), ({1: "low", 2: "high"}, "LPS"))
        self.assertTrue(same(mesh, voxplex.mesh({"low": low, "high": high}, 2.0, threads=1, **PLACE)))

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
