#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""voxplex.quality(), against NumPy, VTK's own filters and a check of meshes that shares no code with it."""

import importlib.util
import json
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy

import voxplex
from phantoms import ball, beating, brick

try:
    from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkImageData, vtkPolyData, vtkUnstructuredGrid
    from vtkmodules.vtkFiltersModeling import vtkHausdorffDistancePointSetFilter
    from vtkmodules.vtkFiltersVerdict import vtkCellSizeFilter, vtkMeshQuality
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter
    from temporal import Series
except ModuleNotFoundError as missing:
    raise unittest.SkipTest("there is no VTK") from missing

needs_classes = unittest.skipUnless(importlib.util.find_spec("voxplex.vtkVoxplex"), "the VTK classes are not built")

SHARED = Path(__file__).resolve().parents[2] / ".." / "shared" / "data"
CHECK_MESH = SHARED / "check_mesh.py"
KNEE = SHARED / "spl-knee-atlas.nrrd"


def face_centres(labels):
    """The centres of faces between voxels of different labels; unit voxels, x first."""
    padded = numpy.pad(labels, 1)
    centres = []
    for axis in range(3):
        faces = numpy.argwhere(numpy.diff(padded, axis=axis))[:, ::-1] - 1.0
        faces[:, 2 - axis] += 0.5
        centres.append(faces)
    return numpy.concatenate(centres)


class Figures(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.labels = ball(28, (11.0, 6.0))
        cls.mesh = voxplex.mesh(cls.labels, 2.0, threads=1)
        cls.interfaces, cls.statistics = cls.mesh.interfaces, cls.mesh.statistics
        cls.figures = voxplex.quality(cls.mesh, cls.labels)

    def test_agrees_with_the_mesher(self):
        quality = self.statistics["quality"]
        for key, value in self.figures["quality"].items():
            if value is None:  # there is no junction
                self.assertIsNone(quality[key])
                continue
            numpy.testing.assert_allclose(value, quality[key], rtol=1e-6, err_msg=key)
        self.assertEqual(self.figures["elements"], self.statistics["elements"])
        self.assertEqual(self.figures["interface_facets"], self.statistics["interface_facets"])
        self.assertEqual(self.figures["faces_of_three_elements"], 0)

    def test_volumes(self):
        for label in (1, 2):
            figures = self.figures["labels"][str(label)]
            voxels = int((self.labels == label).sum())
            self.assertEqual(figures["voxels"], voxels)
            self.assertEqual(figures["image_volume"], voxels)
            self.assertAlmostEqual(figures["volume_error"], figures["volume"] / voxels - 1)
            self.assertLess(abs(figures["volume_error"]), 0.2)

    def test_distances_to_voxels(self):
        """By brute force, except inside of triangles. For these see the comparison with VTK's filter below."""
        centres = face_centres(self.labels)
        points = self.interfaces.points
        corners = points[self.interfaces.cells]
        samples = numpy.concatenate([points, corners.mean(axis=1)])
        distances = numpy.array([numpy.linalg.norm(centres - p, axis=1).min() for p in samples])
        figures = self.figures["hausdorff"]["voxels"]["mesh_to_image"]
        self.assertEqual(figures["points"], len(samples))
        numpy.testing.assert_allclose(
            [figures["max"], figures["mean"], figures["p99"]],
            [distances.max(), distances.mean(), numpy.percentile(distances, 99)], rtol=1e-6)
        nearest = numpy.linalg.norm(samples - figures["place"], axis=1).min()
        self.assertLess(nearest, 1e-6)

    def test_distances_from_voxels(self):
        centres = face_centres(self.labels)
        cloud = vtkPolyData()
        points = vtkPoints()
        points.SetDataTypeToDouble()
        vertices = vtkCellArray()
        for centre in centres:
            vertices.InsertNextCell(1, [points.InsertNextPoint(centre)])
        cloud.SetPoints(points)
        cloud.SetVerts(vertices)
        theirs = vtkHausdorffDistancePointSetFilter()
        theirs.SetInputData(0, cloud)
        theirs.SetInputData(1, self.interfaces.to_vtk())
        theirs.SetTargetDistanceMethodToPointToCell()
        theirs.Update()
        distances = vtk_to_numpy(theirs.GetOutput(0).GetPointData().GetArray("Distance"))
        figures = self.figures["hausdorff"]["voxels"]["image_to_mesh"]
        self.assertEqual(figures["points"], len(centres))
        numpy.testing.assert_allclose(
            [figures["max"], figures["mean"], figures["p99"]],
            [distances.max(), distances.mean(), numpy.percentile(distances, 99)], rtol=1e-5)

    def test_symmetric_distance(self):
        for kind in ("voxels", "smooth"):
            figures = self.figures["hausdorff"][kind]
            self.assertEqual(figures["distance"],
                             max(figures["mesh_to_image"]["max"], figures["image_to_mesh"]["max"]))
        # Vertices lie on the smooth interface; the stairs of voxels are not part of that distance.
        self.assertLess(self.figures["hausdorff"]["smooth"]["mesh_to_image"]["mean"],
                        0.5 * self.figures["hausdorff"]["voxels"]["mesh_to_image"]["mean"])

    def measured(self, name):
        measurer = voxplex.vtkSimplexMeshQuality()
        measurer.SetInputData(self.mesh.to_vtk())
        measurer.Update()
        return vtk_to_numpy(measurer.GetOutput().GetCellData().GetArray(name))

    @needs_classes
    def test_dihedral_angles(self):
        corners = self.mesh.points[self.mesh.cells]
        faces = [(1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1)]
        normals = numpy.stack([numpy.cross(corners[:, b] - corners[:, a], corners[:, c] - corners[:, a])
                               for a, b, c in faces], axis=1)
        normals /= numpy.linalg.norm(normals, axis=2, keepdims=True)
        angles = numpy.degrees(numpy.stack([numpy.arccos(-(normals[:, i] * normals[:, j]).sum(axis=1))
                                            for i in range(4) for j in range(i)], axis=1))
        numpy.testing.assert_allclose(self.measured("MinimumDihedralAngle"), angles.min(axis=1), rtol=1e-9)
        numpy.testing.assert_allclose(self.measured("MaximumDihedralAngle"), angles.max(axis=1), rtol=1e-9)
        counts = numpy.histogram(angles, bins=90, range=(0, 180))[0]
        self.assertEqual(self.figures["quality"]["dihedral_histogram"], counts.tolist())

    @needs_classes
    def test_verdict(self):
        """What VTK measures, too. Of dihedral angles VTK 9.1 has the smallest of only four."""
        verdict = vtkMeshQuality()
        verdict.SetInputData(self.mesh.to_vtk())
        verdict.SaveCellQualityOn()
        verdict.SetTetQualityMeasureToVolume()
        verdict.Update()
        volumes = vtk_to_numpy(verdict.GetOutput().GetCellData().GetArray("Quality"))
        numpy.testing.assert_allclose(self.measured("Volume"), volumes, rtol=1e-9)
        verdict.SetTetQualityMeasureToMinAngle()
        verdict.Update()
        angles = vtk_to_numpy(verdict.GetOutput().GetCellData().GetArray("Quality"))
        excess = angles - self.measured("MinimumDihedralAngle")
        self.assertGreater(excess.min(), -1e-9)
        self.assertLess(numpy.median(excess), 1e-9)

    def test_arguments(self):
        figures = voxplex.quality(self.mesh)
        self.assertNotIn("image", figures)
        self.assertEqual(figures["quality"], self.figures["quality"])
        labels = self.labels.copy()
        labels[0:2, 0:2, 0:2] = 7
        figures = voxplex.quality(self.mesh, labels, hausdorff=False)
        self.assertEqual((figures["hausdorff"], figures["image"]["lost_labels"]), ({}, [7]))
        figures = voxplex.quality(self.mesh, labels, labels=[1, 2])
        self.assertEqual(figures["image"]["lost_labels"], [])
        self.assertEqual(figures["hausdorff"], self.figures["hausdorff"])
        labels[-2:, -2:, -2:] = 1  # not the largest of its label
        for options, lost in ((dict(), [7, 1]), (dict(smallest_component=9), [7])):
            figures = voxplex.quality(self.mesh, labels, hausdorff=False, **options)
            self.assertEqual([component["label"] for component in figures["image"]["lost_components"]], lost)
        labels[labels == 2] = 1
        figures = voxplex.quality(self.mesh, labels, hausdorff=False)
        self.assertEqual(figures["image"]["extra_labels"], [2])
        self.assertIsNone(figures["labels"]["2"]["volume_error"])


class Inputs(unittest.TestCase):
    def test_files(self):
        with tempfile.TemporaryDirectory() as folder:
            mesh = voxplex.mesh(brick(), 2.0, spacing=(0.5, 0.5, 1.0), threads=1)
            path = os.path.join(folder, "brick.vtu")
            writer = vtkXMLUnstructuredGridWriter()
            writer.SetInputData(mesh.to_vtk())
            writer.SetFileName(path)
            writer.Write()
            self.assertEqual(voxplex.quality(path, brick(), spacing=(0.5, 0.5, 1.0)),
                             voxplex.quality(mesh, brick(), spacing=(0.5, 0.5, 1.0)))
            with self.assertRaises(FileNotFoundError):
                voxplex.quality(os.path.join(folder, "none.vtu"))
            wrong = os.path.join(folder, "brick.stl")
            Path(wrong).write_text("solid\n")
            with self.assertRaisesRegex(voxplex.FileError, "not a .vtu file"):
                voxplex.quality(wrong)

    def test_refuses(self):
        mesh = voxplex.mesh(brick(), 2.0)
        with self.assertRaisesRegex(TypeError, "not (vtk)?ImageData"):
            voxplex.quality(vtkImageData())
        with self.assertRaisesRegex(ValueError, "spacing: only with an image"):
            voxplex.quality(mesh, spacing=(1, 1, 1))
        with self.assertRaisesRegex(ValueError, "labels: only with an image"):
            voxplex.quality(mesh, labels=[5])
        with self.assertRaisesRegex(ValueError, "time frames"):
            voxplex.quality(mesh, beating())
        with self.assertRaisesRegex(voxplex.MeshingError, "smoothing: must lie between 0 and 5, not -1"):
            voxplex.quality(mesh, brick(), smoothing=-1)
        del mesh.cell_data["Label"]
        with self.assertRaisesRegex(voxplex.MeshingError, "^its cells have no array 'Label'"):
            voxplex.quality(mesh)

    def test_progress(self):
        mesh = voxplex.mesh(brick(), 2.0)
        fractions = []
        voxplex.quality(mesh, brick(), progress=fractions.append)
        self.assertEqual(fractions[-1], 1.0)
        self.assertEqual(fractions, sorted(fractions))
        with self.assertRaises(voxplex.MeshingCancelled):
            voxplex.quality(mesh, brick(), progress=lambda _fraction: False)


def pentatope_figures(corners):
    """Hypervolume, radius-edge ratio and normalized volume of pentatopes [n, 5, 4]."""
    edges = corners[:, 1:] - corners[:, :1]
    volumes = numpy.linalg.det(edges) / 24
    centres = numpy.linalg.solve(2 * edges, (edges**2).sum(axis=2)[..., None])[..., 0]
    radii = numpy.linalg.norm(centres, axis=1)
    pairs = [(i, j) for i in range(5) for j in range(i)]
    shortest = numpy.min([numpy.linalg.norm(corners[:, i] - corners[:, j], axis=1) for i, j in pairs], axis=0)
    regular = numpy.sqrt(5) / 96 * numpy.sqrt(5 / 2)**4  # edge 1 has the radius sqrt(2 / 5)
    return volumes, radii / shortest, volumes / (regular * radii**4)


class SpaceTime(unittest.TestCase):
    """Pentatopes: by NumPy, and the cuts by the slices."""
    TIMES = (1.0, 1.5, 2.0, 3.0, 3.5)
    SCALE = 3.0

    @classmethod
    def setUpClass(cls):
        z, y, x = numpy.mgrid[:16, :16, :18]
        cls.frames = numpy.zeros((5, 16, 16, 18), dtype=numpy.uint8)
        for frame, time in zip(cls.frames, cls.TIMES):
            frame[(x - 4 - 2 * time)**2 + (y - 7.5)**2 + (z - 7.5)**2 < 30] = 2
            frame[(x - 4 - 2 * time)**2 + (y - 7.5)**2 + (z - 7.5)**2 < 8] = 5
        cls.mesh = voxplex.mesh(cls.frames, 2.0, times=cls.TIMES, time_scale=cls.SCALE, threads=1)
        cls.figures = voxplex.quality(cls.mesh, cls.frames, times=cls.TIMES, time_scale=cls.SCALE)

    def measurer(self):
        measurer = voxplex.vtkSimplexMeshQuality()
        measurer.SetInputData(self.mesh.to_vtk())
        measurer.SetTimeScale(self.SCALE)
        return measurer

    @needs_classes
    def test_elements(self):
        measurer = self.measurer()
        measurer.SetNumberOfWorstElements(7)
        measurer.Update()
        cells = measurer.GetOutput().GetCellData()
        corners = numpy.column_stack([self.mesh.points, self.SCALE * self.mesh.times])[
            self.mesh.cells]
        volumes, ratios, shapes = pentatope_figures(corners)
        for name, expected in (("Volume", volumes), ("RadiusEdgeRatio", ratios), ("NormalizedVolume", shapes)):
            numpy.testing.assert_allclose(vtk_to_numpy(cells.GetArray(name)), expected, rtol=1e-6, err_msg=name)
        ranks = vtk_to_numpy(cells.GetArray("WorstElement"))
        self.assertEqual(sorted(ranks)[-8:], list(range(8)))
        worst = numpy.argsort(shapes)[:7]
        numpy.testing.assert_array_equal(ranks[worst], range(1, 8))
        figures = json.loads(measurer.ToJSON())
        self.assertEqual([element["cell"] for element in figures["worst_elements"]], list(worst))
        for element in figures["worst_elements"]:
            self.assertAlmostEqual(element["normalized_volume"], shapes[element["cell"]], 9)
            self.assertAlmostEqual(element["radius_edge"], ratios[element["cell"]], 6)
            centre = corners[element["cell"]].mean(axis=0) / (1, 1, 1, self.SCALE)
            numpy.testing.assert_allclose(element["place"], centre)
            self.assertEqual(element["label"], self.mesh.labels[element["cell"]])
        quality = figures["quality"]
        self.assertAlmostEqual(quality["min_normalized_volume"], shapes.min(), 9)
        self.assertAlmostEqual(quality["mean_normalized_volume"], shapes.mean(), 9)
        self.assertAlmostEqual(quality["max_radius_edge"], ratios.max(), 6)
        self.assertAlmostEqual(measurer.GetMinimumNormalizedVolume(), shapes.min(), 9)
        self.assertAlmostEqual(measurer.GetMeanNormalizedVolume(), shapes.mean(), 9)
        histograms = measurer.GetHistograms()
        for name, values in (("NormalizedVolumes", shapes), ("RadiusEdgeRatios", ratios)):
            counts = vtk_to_numpy(histograms.GetColumnByName(name))
            numpy.testing.assert_array_equal(counts[:60], numpy.histogram(values, 60, (0, 3))[0], err_msg=name)
        self.assertEqual(figures["frames"], [])
        self.assertNotIn("image", figures)

    @needs_classes
    def test_frames(self):
        frames = self.figures["frames"]
        self.assertEqual([frame["time"] for frame in frames], list(self.TIMES))
        slicer = voxplex.vtkPentatopeMeshTimeSlice()
        slicer.SetInputData(self.mesh.to_vtk())
        for frame, voxels in zip(frames, self.frames):
            slicer.UpdateTimeStep(frame["time"])
            sizes = vtkCellSizeFilter()
            sizes.SetInputConnection(slicer.GetOutputPort())
            sizes.Update()
            volumes = vtk_to_numpy(sizes.GetOutput().GetCellData().GetArray("Volume"))
            labels = vtk_to_numpy(sizes.GetOutput().GetCellData().GetArray("Label"))
            for label in (2, 5):
                figures = frame["labels"][str(label)]
                self.assertAlmostEqual(figures["volume"], volumes[labels == label].sum(), 6)
                count = int((voxels == label).sum())
                self.assertEqual((figures["voxels"], figures["image_volume"]), (count, count))
            self.assertEqual(frame["faces_of_three_elements"], 0)
            self.assertEqual(frame["quality"]["inverted_elements"], 0)
            self.assertEqual(frame["image"]["lost_components"], [])
            self.assertEqual(frame["image"]["components"], 2)
            self.assertLess(0.3, frame["hausdorff"]["voxels"]["distance"])
            self.assertLess(frame["hausdorff"]["voxels"]["distance"], 2.5)

    def test_labels(self):
        for label in (2, 5):
            counts = (self.frames == label).sum(axis=(1, 2, 3))
            expected = self.SCALE * (numpy.diff(self.TIMES) * (counts[1:] + counts[:-1]) / 2).sum()
            figures = self.figures["labels"][str(label)]
            self.assertAlmostEqual(figures["image_volume"], expected, 6)
            self.assertAlmostEqual(figures["volume_error"], figures["volume"] / expected - 1, 9)
            self.assertLess(abs(figures["volume_error"]), 0.25)
            self.assertEqual(figures["components"], 1)
        self.assertEqual(self.figures["image"], {"lost_labels": [], "components": 2, "lost_components": []})

    @needs_classes
    def test_tables(self):
        """The same with components for frames, in VTK."""
        measurer = self.measurer()
        image = voxplex.Image(self.frames[0]).to_vtk()
        image.GetPointData().SetScalars(numpy_to_vtk(numpy.moveaxis(self.frames, 0, -1).reshape(-1, 5).copy()))
        measurer.SetImageData(image)
        for time in self.TIMES:
            measurer.AddFrameTime(time)
        measurer.Update()
        self.assertEqual(json.loads(measurer.ToJSON()), self.figures)
        distances = [frame["hausdorff"]["voxels"]["distance"] for frame in self.figures["frames"]]
        self.assertEqual(measurer.GetHausdorffDistance(), max(distances))
        self.assertEqual((measurer.GetNumberOfLostLabels(), measurer.GetNumberOfLostComponents()), (0, 0))
        labels = measurer.GetLabelTable()
        self.assertEqual(list(vtk_to_numpy(labels.GetColumnByName("Label"))), [2, 5])
        self.assertEqual(list(vtk_to_numpy(labels.GetColumnByName("Components"))), [1, 1])
        for column, key in (("Volume", "volume"), ("ImageVolume", "image_volume"), ("VolumeError", "volume_error")):
            self.assertEqual(list(vtk_to_numpy(labels.GetColumnByName(column))),
                             [self.figures["labels"][label][key] for label in ("2", "5")])
        table = measurer.GetFrameTable()
        self.assertEqual(list(vtk_to_numpy(table.GetColumnByName("Time"))), [t for t in self.TIMES for _ in (2, 5)])
        self.assertEqual(list(vtk_to_numpy(table.GetColumnByName("Label"))), 5 * [2, 5])
        self.assertEqual(list(vtk_to_numpy(table.GetColumnByName("HausdorffDistance"))), [d for d in distances for _ in (2, 5)])
        self.assertEqual(list(vtk_to_numpy(table.GetColumnByName("VolumeError"))),
                         [frame["labels"][label]["volume_error"] for frame in self.figures["frames"] for label in ("2", "5")])
        self.assertEqual(set(vtk_to_numpy(table.GetColumnByName("Components"))), {2})

    @needs_classes
    def test_pipeline(self):
        """Time steps for frames. A request for another time does not measure again."""
        frames = Series(voxplex.Image(self.frames, times=self.TIMES).to_vtk(), self.TIMES)
        mesher = voxplex.vtkImageToPentatopeMeshFilter()
        mesher.SetInputConnection(frames.GetOutputPort())
        mesher.SetTimeScale(self.SCALE)
        mesher.SetDelta(2.0)
        mesher.SetNumberOfThreads(1)
        measurer = voxplex.vtkSimplexMeshQuality()
        measurer.SetInputConnection(mesher.GetOutputPort())
        measurer.SetImageConnection(frames.GetOutputPort())
        measurer.SetTimeScale(self.SCALE)
        executions = []
        measurer.AddObserver("StartEvent", lambda *_: executions.append(1))
        for time in (1.0, 2.0, 3.5):
            measurer.UpdateTimeStep(time)
            self.assertEqual(measurer.GetFrameTable().GetNumberOfRows(), 10)
        self.assertEqual(len(executions), 1)
        self.assertEqual(json.loads(measurer.ToJSON()), self.figures)

    def test_lost_components(self):
        """A speck that lives for one frame is a component of space-time, and of that frame."""
        frames = self.frames.copy()
        frames[2, 1:3, 1:3, 1:3] = 2
        figures = voxplex.quality(self.mesh, frames, times=self.TIMES, time_scale=self.SCALE, hausdorff=False)
        lost = figures["image"]["lost_components"]
        self.assertEqual([component["label"] for component in lost], [2])
        self.assertEqual(lost[0]["voxel"][:3], [1, 1, 1])
        self.assertEqual([len(frame["image"]["lost_components"]) for frame in figures["frames"]], [0, 0, 1, 0, 0])
        self.assertEqual(figures["frames"][2]["image"]["lost_components"],
                         [{"label": 2, "voxels": 8, "voxel": [1, 1, 1]}])
        frames = self.frames.copy()
        frames[:, 1:3, 1:3, 1:3] = 7
        figures = voxplex.quality(self.mesh, frames, times=self.TIMES, hausdorff=False)
        self.assertEqual(figures["image"]["lost_labels"], [7])

    def test_without_image(self):
        figures = voxplex.quality(self.mesh, times=(1.0, 2.7), time_scale=self.SCALE)
        self.assertEqual([frame["time"] for frame in figures["frames"]], [1.0, 2.7])
        self.assertEqual([frame["image"] for frame in figures["frames"]], [None, None])
        self.assertEqual(figures["frames"][0]["labels"]["2"]["volume"], self.figures["frames"][0]["labels"]["2"]["volume"])

    @needs_classes
    def test_refusals(self):
        with self.assertRaisesRegex(ValueError, "the image has no time frames"):
            voxplex.quality(self.mesh, self.frames[0])
        with self.assertRaisesRegex(ValueError, "only for meshes of pentatopes"):
            voxplex.quality(voxplex.mesh(brick(), 2.0), time_scale=2)
        with self.assertRaisesRegex(voxplex.MeshingError, "must increase"):
            voxplex.quality(self.mesh, self.frames, times=(1, 2, 2, 3, 4))
        measurer = self.measurer()
        messages = []
        measurer.AddObserver("ErrorEvent", lambda *_: messages.append(measurer.GetErrorMessage()))
        measurer.GetExecutive().AddObserver("ErrorEvent", lambda *_: None)
        for change, words in (
                (lambda: measurer.SetImageData(voxplex.Image(self.frames[0]).to_vtk()), "the image has one frame"),
                (lambda: measurer.AddFrameTime(1.0), "the image has one frame"),
                (lambda: (measurer.SetImageData(None), measurer.SetTimeScale(0.0)), "TimeScale is 0"),
                (lambda: (measurer.SetTimeScale(1.0), self.without_time(measurer)), "no point array 'Time'")):
            change()
            measurer.Update()
            self.assertIn(words, messages[-1])
            self.assertEqual(measurer.GetOutput().GetNumberOfCells(), 0)

    def without_time(self, measurer):
        mesh = vtkUnstructuredGrid()
        mesh.ShallowCopy(self.mesh.to_vtk())
        mesh.GetPointData().RemoveArray("Time")
        measurer.SetInputData(mesh)


@unittest.skipUnless(importlib.util.find_spec("scipy"), "the check needs SciPy")
@unittest.skipUnless(CHECK_MESH.exists() and KNEE.exists(), "the check and the knee atlas are not beside the checkout")
class AgainstAnIndependentCheck(unittest.TestCase):
    def test_knee(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "knee.vtu")
            voxplex.mesh(KNEE, 4.0, sliver_angle=0, smallest_component=0, optimise=False, sample_junctions=False,
                         interface_rounds=0, manifold=False).write(path)
            ours = voxplex.quality(path, KNEE)
            check = subprocess.run([sys.executable, CHECK_MESH, KNEE, path], check=True, capture_output=True, text=True)
            theirs = json.loads(check.stdout)
        quality, topology, image = ours["quality"], ours["topology"], ours["image"]
        self.assertEqual(ours["elements"], theirs["tets"])
        self.assertEqual(ours["interface_facets"], theirs["interface_facets"])
        self.assertEqual(topology["non_manifold_edges"], theirs["nonmanifold_edges"])
        self.assertGreater(topology["non_manifold_edges"], 0)
        self.assertEqual(topology["boundary_edges"], theirs["interface_edges"])
        self.assertEqual(image["lost_labels"], theirs["labels_missing"])
        self.assertEqual(len(image["lost_components"]), theirs["components_lost"][">=8"])
        self.assertEqual(image["components"], theirs["components"][">=8"])
        self.assertAlmostEqual(image["label_volume_error"], theirs["volume_rel_error_weighted_abs"], 9)
        self.assertAlmostEqual(quality["min_dihedral"], theirs["dihedral_min"], 6)
        self.assertAlmostEqual(quality["max_dihedral"], theirs["dihedral_max"], 6)
        self.assertAlmostEqual(quality["max_radius_edge"], theirs["radius_edge_max"], 9)
        self.assertAlmostEqual(quality["min_planar"], theirs["planar_min"], 6)
        distances = ours["hausdorff"]["voxels"]
        for figure in ("max", "mean", "p99"):
            self.assertAlmostEqual(distances["mesh_to_image"][figure], theirs["distance_mesh_to_image"][figure], 6)
            # They measure from points on the triangles that are less than a voxel apart, we from the triangles.
            self.assertLessEqual(distances["image_to_mesh"][figure], theirs["distance_image_to_mesh"][figure] + 1e-6)
            self.assertAlmostEqual(distances["image_to_mesh"][figure], theirs["distance_image_to_mesh"][figure], delta=0.1)


if __name__ == "__main__":
    unittest.main()
