#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Images and meshes of PyVista, ITK, SimpleITK and meshio, each where it is installed."""

import importlib.util
import tempfile
import unittest
import unittest.mock
from pathlib import Path

import numpy

import voxplex
from voxplex.sources import image_of
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
        mesh = voxplex.mesh(voxplex.Image(brick(), names={5: "liver"}), 2.0)
        import meshio
        with tempfile.TemporaryDirectory() as folder:
            for name, extra in (("mesh.msh", {"file_format": "gmsh22"}), ("mesh.inp", {}), ("mesh.vtu", {}), ("mesh.msh4", {"file_format": "gmsh"})):
                meshio.write(Path(folder, name), mesh.to_meshio(), **extra)
            groups = meshio.read(Path(folder, "mesh.msh"))
            self.assertEqual({name: tuple(data) for name, data in groups.field_data.items()}, {"liver": (5, 3), "label_9": (9, 3)})
            numpy.testing.assert_array_equal(groups.cell_data["gmsh:physical"][0], mesh.labels)
            self.assertRegex(Path(folder, "mesh.inp").read_text(), "(?si)ELSET, ELSET=liver.*ELSET, ELSET=label_9")
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
        self.assertTrue(same(self.mesh, voxplex.mesh(image.get_fdata().T, 2.0, threads=1, affine=image.affine)))
        series = nibabel.Nifti1Image(beating().T, numpy.eye(4))
        series.header.set_zooms((1, 1, 1, 0.5))
        self.assertEqual(voxplex.mesh(series, 2.0).times.max(), 1.5)

    @needs("nibabel")
    def test_nibabel_and_its_file(self):
        """They lie at the same place and time, whatever the units; without a place as nibabel says."""
        import nibabel
        series = nibabel.Nifti1Image(beating().T, numpy.array([[-1.0, 0, 0, 4], [0, 2, 0, 5], [0, 0, 3, 6], [0, 0, 0, 1]]))
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
    def test_plot(self):
        """Categories with names and colours, cut open; a slice of space-time."""
        import pyvista
        calls = []

        def show(data, **arguments):
            calls.append((data, arguments))
            return pyvista.plot(data, off_screen=True, **arguments)

        image = voxplex.Image(brick(), names={5: "liver"})
        image.colors = {5: (1.0, 0.0, 0.0)}
        mesh, series = voxplex.mesh(image, 2.0), voxplex.mesh(beating(), 2.0)
        with unittest.mock.patch("pyvista.UnstructuredGrid.plot", show), unittest.mock.patch("pyvista.PolyData.plot", show):
            mesh.plot()
            mesh.plot(cut="x", show_edges=False)
            mesh.interfaces.plot()
            mesh.interfaces.plot(cut=(0, 0, 1))
            series.plot(time=1.0)
        texts = [list(arguments["annotations"].values()) for _, arguments in calls]
        self.assertEqual(texts, [["liver", "9"]] * 2 + [["liver - outside", "9 - outside", "9 - liver"]] * 2 + [["1"]])
        whole, half = calls[0][0], calls[1][0]
        self.assertEqual((len(mesh.cells), calls[1][1]["show_edges"], calls[0][1]["cmap"].colors[0]), (whole.n_cells, False, (1.0, 0.0, 0.0)))
        self.assertTrue(0.2 < half.n_cells / whole.n_cells < 0.8)
        self.assertEqual(set(half.cell_data["Label"][half.cell_data["Voxplex"] == 1]), {9})
        pairs = calls[2][0]
        self.assertEqual({tuple(pair) for pair in pairs.cell_data["Labels"][pairs.cell_data["Voxplex"] == 2]}, {(9, 5)})
        self.assertLess(calls[3][0].n_cells, pairs.n_cells)
        self.assertEqual(set(calls[4][0].celltypes), {10})
        self.assertNotIn("Voxplex", mesh.cell_data)

    @needs("pyvista")
    def test_active_array_of_pyvista(self):
        """One of points or cells, whatever VTK has active of both."""
        import pyvista
        image = pyvista.ImageData(dimensions=(4, 3, 3))
        image.point_data["ct"], image.cell_data["labels"] = numpy.ones(36, numpy.uint8), numpy.full(12, 2, numpy.uint8)
        for preference, name, value in (("point", "ct", 1), ("cell", "labels", 2), ("cell", "labels", 2), ("point", "ct", 1)):
            image.set_active_scalars(name, preference=preference)
            for frames in (image, [image, image], image.copy()):
                self.assertEqual(voxplex.Image.from_vtk(frames).voxels.max(), value)
        image.cell_data["ct"] = numpy.full(12, 5, numpy.uint8)
        for preference, value in (("cell", 5), ("point", 1)):
            image.set_active_scalars("ct", preference=preference)
            self.assertEqual((voxplex.Image.from_vtk(image).voxels.max(), voxplex.Image.from_vtk(image, scalars="ct").voxels.max()),
                             (value, value))
        self.assertEqual(voxplex.Image.from_vtk(image, scalars="labels").voxels.max(), 2)
        image.set_active_scalars(None)
        with self.assertRaisesRegex(ValueError, "several arrays"):
            voxplex.mesh(image)

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
