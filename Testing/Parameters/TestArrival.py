#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Each parameter, through the program, also as 3D Slicer's module, and Python: the mesh that the filter makes with it, and another
one than without."""
import os
import subprocess
import types
import unittest

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk

import images
import meshfiles
import voxplex
from folders import FolderTestCase
from table import TABLE, make_filter

BY_PROPERTY = {p["property"]: p for p in TABLE}
ANY = voxplex.vtkImageToTetMeshFilter.ANY_LABEL
# The first parameter of a row makes the difference.
TETRAHEDRA = (
    {"Delta": 1.5}, {"NumberOfElements": 9000}, {"ElementSize": 1.5}, {"LabelSize": ((3, 1.5),)},
    {"LabelSize": ((3, 1.5), (7, 1.5))}, {"InterfaceSize": ((3, 7, 1), (0, ANY, 2.5))}, {"InterfaceSize": ((3, 7, 1),)},
    {"Gradation": 0.1, "InterfaceSize": ((3, 7, 1),)}, {"Label": (7,)}, {"Label": (3, 7)}, {"SmoothingSigma": 0},
    {"RadiusEdgeRatio": 1.9, "Force": True}, {"FacetAngle": 20}, {"Optimise": False}, {"SliverAngle": 0, "Optimise": False},
    {"Grading": "lfs", "Delta": 1}, {"FeatureRatio": 0.4, "Grading": "lfs", "Delta": 1},
    {"LargestFeature": 1, "Grading": "lfs", "Delta": 1}, {"SampleJunctions": False}, {"InterfaceRounds": 0},
    {"SmallestComponent": 0, "InterfaceRounds": 0}, {"MinimumComponentVolume": 100}, {"ExactComponents": True})
ISOSURFACES = tuple({**row, "Isovalue": 2} for row in (
    {"InsideLabel": 4}, {"Inside": "below"}, {"IsosurfaceSmoothingSigma": 1.5}, {"ElementSize": 1.5}))
NOISE = ({"Manifold": False, "Delta": 3, "SmoothingSigma": 0, "InterfaceRounds": 0},)
PENTATOPES = (
    {"Delta": 1.8}, {"TimeScale": 3}, {"FrameSteps": 3}, {"FitInterfaces": False}, {"Periodic": True}, {"Label": (6,)},
    {"Grading": "lfs", "Delta": 1.5}, {"FeatureRatio": 0.2, "Grading": "lfs", "Delta": 1.5},
    {"PickingRegions": False, "Delta": 1.5}, {"RuleOrder": "surface", "Delta": 1.5}, {"SliverBound": 0.02, "Force": True},
    {"NumberOfPicks": 1, "SliverBound": 0.02, "Force": True}, {"RandomSeed": 5, "SliverBound": 0.02, "Force": True})
# What changes no mesh of one thread, and what other tests give: images of sizes and times of frames.
ELSEWHERE = {"OptimisationTimeLimit", "NumberOfThreads", "Reproducible", "FineGrained", "ContentionManager",
             "LoadBalancer", "PinThreads", "MemoryLimit", "ElementSizeData", "FrameTime"}
# Testing/Python/TestRepair.py; of reading below, and Testing/Applications/TestGeometry.py and TestLabelNames.py
ELSEWHERE |= {p["property"] for p in TABLE if p["class"] in ("Reader", "Repair")}


def text_of(values):
    """3 or 3=1.5 or 3,7=1.5."""
    keys = ",".join(str(key) for key in values[:-1] if key != ANY)
    return f"{keys}={values[-1]}"


def for_program(name, value):
    parameter = BY_PROPERTY[name]
    option = "--" + (parameter["option"] or "smoothing")
    if parameter["kind"] == "flag":
        return [option] if value == (parameter["default"] == "off") else []
    if name == "Label":
        return [option, ", ".join(map(str, value))]
    if name in ("LabelSize", "InterfaceSize"):
        return [option, ", ".join(text_of(values) for values in value)]
    return [option, str(value)]


def for_python(name, value):
    """None where mesh() has no such argument."""
    key = "smoothing" if name == "IsosurfaceSmoothingSigma" else BY_PROPERTY[name]["python"]
    if name in ("LabelSize", "InterfaceSize"):
        value = {values[0] if len(values) == 2 or values[1] == ANY else values[:2]: values[-1] for values in value}
    return {key: value} if key else None


def mesh_of(mesh):
    """Of a filter or of mesh()."""
    return mesh if isinstance(mesh, voxplex.Mesh) else voxplex.Mesh.from_vtk(mesh)


def cells_of(mesh):
    return mesh_of(mesh).cells


class Arrival(FolderTestCase):
    def run_program(self, *arguments):
        done = subprocess.run([os.environ["VOXPLEX_PROGRAM"], *map(str, arguments)], cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)

    def filter_of(self, array, dimension, properties):
        mesher = make_filter({"class": "Tets" if dimension == 3 else "Pentatopes"})
        image = voxplex.Image(array if dimension == 3 else array[0]).to_vtk()
        if dimension == 4:  # the components are frames
            image.GetPointData().SetScalars(numpy_to_vtk(array.reshape(len(array), -1).T.copy(), deep=True))
        mesher.SetInputData(image)
        mesher.SetNumberOfThreads(1)
        mesher.SetInputMode("Isovalue" in properties)
        for name, value in properties.items():
            words = BY_PROPERTY[name]["words"]
            for values in value if isinstance(value, tuple) else [words.index(value) if words else value]:
                set_it = getattr(mesher, ("Add" if name == "Label" else "Set") + name)
                set_it(*values) if isinstance(values, tuple) else set_it(values)
        mesher.Update()
        return mesher.GetOutput()

    def check(self, array, dimension, table, cells_of, read):
        images.write_nrrd(self.folder / "image.nrrd", array)
        for row in table:
            properties = row if {"Delta", "NumberOfElements"} & set(row) else {"Delta": 2, **row}
            expected = cells_of(self.filter_of(array, dimension, properties))
            without = {"Delta": 2, **dict(list(row.items())[1:])}
            with self.subTest(row):
                other = cells_of(self.filter_of(array, dimension, without))
                self.assertFalse(numpy.array_equal(expected, other))
                words = [word for item in properties.items() for word in for_program(*item)]
                self.run_program("--threads", 1, *words, "--input", "image.nrrd", "--output", "mesh.vtu")
                numpy.testing.assert_array_equal(read(self.folder / "mesh.vtu").cells, expected)
                if dimension == 3:
                    flags = [word.replace("-", "_").replace("__", "--", 1) if word.startswith("--") else word for word in words]
                    self.run_program("--returnparameterfile", "results", *flags, "--threads", 1, "image.nrrd", "module.vtu")
                    numpy.testing.assert_array_equal(read(self.folder / "module.vtu").cells, expected)
                words = [for_python(*item) for item in properties.items()]
                if None not in words:
                    arguments = {key: value for item in words for key, value in item.items()}
                    numpy.testing.assert_array_equal(cells_of(voxplex.mesh(array, threads=1, **arguments)), expected)

    def test_tetrahedra(self):
        array = images.two_labels()
        array[2, 2, 2] = 3  # a speck, far from everything else
        array[12, 12, 12] = 9  # one voxel beside an interface
        self.check(array, 3, TETRAHEDRA, cells_of, meshfiles.read_tetrahedra)

    def test_isosurfaces(self):
        distance = numpy.linalg.norm(numpy.mgrid[:20, :20, :20] - 9.5, axis=0)
        array = (8 - distance + numpy.random.RandomState(1).uniform(-0.5, 0.5, distance.shape)).astype(numpy.float32)

        def numbers(mesh):
            return numpy.column_stack((mesh_of(mesh).cells, mesh_of(mesh).labels))

        def read(path):
            mesh = meshfiles.read_tetrahedra(path)
            return types.SimpleNamespace(cells=numpy.column_stack((mesh.cells, mesh.labels)))

        self.check(array, 3, ISOSURFACES, numbers, read)

    def test_noise(self):
        array = numpy.random.RandomState(1).randint(0, 3, (24, 24, 24)).astype(numpy.uint8)
        self.check(array, 3, NOISE, cells_of, meshfiles.read_tetrahedra)

    def test_pentatopes(self):
        array = images.moving_balls(size=12, radius=3.0)
        array[-1] = array[0]
        self.check(array, 4, PENTATOPES, cells_of, meshfiles.read_pentatopes)

    def test_all_are_there(self):
        given = {name for row in TETRAHEDRA + ISOSURFACES + NOISE + PENTATOPES for name in row}
        self.assertEqual(given | ELSEWHERE, set(BY_PROPERTY))


if __name__ == "__main__":
    unittest.main()
