#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Misuse: a clear message through ErrorEvent, empty outputs, and the filter goes on working. Single numbers out of range:
Parameters.Filters. Functions that throw: Filters.Cxx.TestTetMeshThreads."""
import math
import unittest

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkStringArray
from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkImageData

import voxplex
from filter_testing import TIMES, FilterTestCase, add_array, components, errors_of, four_ball, pentatopes, series, tets

N = 24
K, J, I = numpy.mgrid[:N, :N, :N]
RADII = numpy.sqrt((I - 11.5) ** 2 + (J - 11.5) ** 2 + (K - 11.5) ** 2)
ANY = voxplex.vtkImageToTetMeshFilter.ANY_LABEL
NAN, INFINITY = math.nan, math.inf


def ball(radius=6.0):
    return voxplex.Image((RADII < radius).astype(float)).to_vtk()


def two_labels():
    return voxplex.Image(numpy.where(RADII < 6, numpy.where(I < 12, 1, 2), 0).astype(numpy.uint8)).to_vtk()


def choose(mesher, name):
    mesher.SetInputArrayToProcess(0, 0, 0, vtkDataObject.FIELD_ASSOCIATION_POINTS, name)


def texts(image):
    strings = vtkStringArray()
    strings.SetName("Text")
    strings.SetNumberOfValues(image.GetNumberOfPoints())
    image.GetPointData().AddArray(strings)


class Images(FilterTestCase):
    def expect_image_error(self, words, image):
        mesher = tets(image)
        self.expect_error(mesher, words, lambda: mesher.SetInputData(ball()))

    def test_values(self):
        for value, words in ((1.5, ("1.5", "whole", "(12, 12, 12)")),
                             (-3, ("-3", "negative", "isosurface", "choose the labels")),
                             (NAN, ("finite", "set such voxels to 0")), (INFINITY, ("finite",))):
            image = ball()
            image.GetPointData().GetScalars().SetTuple1(12 + N * (12 + N * 12), value)
            self.expect_image_error(words, image)
        self.expect_image_error(("foreground",), ball(-1))

    def test_arrays(self):
        image = ball()
        image.GetPointData().Initialize()
        self.expect_image_error(("array", "SetInputArrayToProcess"), image)
        self.expect_image_error((), vtkImageData())
        self.expect_image_error(("Frames", "3 components", "vtkImageToPentatopeMeshFilter"),
                                components([numpy.ones((N, N, N), numpy.uint8)] * 3))
        image = ball()
        add_array(image.GetPointData(), "vtkGhostType", numpy.zeros(N ** 3 - 1, numpy.uint8))
        self.expect_image_error(("vtkGhostType", "13823", "13824"), image)
        image = ball()
        texts(image)
        mesher = tets(image)
        choose(mesher, "Text")
        self.expect_error(mesher, ("Text", "numbers"))
        choose(mesher, "Missing")
        self.expect_error(mesher, ("SetInputArrayToProcess",))

    def test_grey_values(self):
        image = voxplex.Image((numpy.arange(N ** 3) % 5000).astype(float).reshape(N, N, N)).to_vtk()
        self.expect_image_error(("grey-value", "labels"), image)
        mesher = tets(image)  # and only the chosen label counts
        mesher.AddLabel(4000)
        mesher.SetSmallestComponent(1)
        mesher.Update()
        self.assertFalse(self.is_empty(mesher), mesher.GetErrorMessage())

    def test_extents(self):
        for shape in ((1, N, N), (1, 1, 1)):
            self.expect_image_error(("1 voxel",), voxplex.Image(numpy.ones(shape, numpy.uint8)).to_vtk())

    def test_geometry(self):
        for bad in (0.0, -1.0, NAN, INFINITY):
            image = ball()
            image.SetSpacing(1.0, bad, 1.0)
            self.expect_image_error(("spacing", "positive"), image)
        image = ball()
        image.SetOrigin(0, NAN, 0)
        self.expect_image_error(("origin", "finite"), image)
        for words, rows in ((("direction", "singular"), (1, 1, 0, 0, 0, 0, 0, 0, 1)),
                            (("direction", "singular"), (1, 0, 1, 0, 1, 1, 0, 0, 0)),
                            (("direction", "singular"), (0,) * 9), (("direction", "finite"), (NAN, 0, 0, 0, 1, 0, 0, 0, 1))):
            image = ball()
            image.SetDirectionMatrix(rows)
            self.expect_image_error(words, image)

    def test_no_input(self):
        """The executive's error, not the filter's."""
        mesher, errors = voxplex.vtkImageToTetMeshFilter(), []
        mesher.GetExecutive().AddObserver("ErrorEvent", lambda *_: errors.append(1))
        mesher.Update()
        self.assertTrue(errors)
        self.assertTrue(self.is_empty(mesher))


class Parameters(FilterTestCase):
    def test_labels(self):
        mesher = tets(two_labels())
        for bad in (0.0, -1.0, NAN, INFINITY):
            mesher.SetLabelSize(2, bad)
            self.expect_error(mesher, ("label 2",), mesher.ClearLabelSizes)
        mesher.SetRadiusEdgeRatio(1.8)
        self.expect_error(mesher, ("1.93", "Force"), mesher.ForceOn)
        mesher.SetRadiusEdgeRatio(2.0)
        mesher.SetLabelSize(9, 1.0)
        self.expect_error(mesher, ("label 9", "1, 2"), mesher.ClearLabelSizes)
        mesher.AddLabel(1)
        mesher.SetLabelSize(2, 1.0)
        self.expect_error(mesher, ("label 2", "1"), mesher.ClearLabelSizes)
        mesher.AddLabel(77)
        self.expect_error(mesher, ("77", "1, 2"), lambda: mesher.RemoveLabel(77))
        mesher.RemoveAllLabels()
        mesher.ExcludeLabel(78)
        self.expect_error(mesher, ("78", "1, 2"), lambda: mesher.RemoveExcludedLabel(78))
        mesher.ExcludeLabel(1)
        mesher.SetLabelSize(1, 1.0)
        self.expect_error(mesher, ("label 1", "2"), mesher.ClearLabelSizes)
        mesher.SetInterfaceSize(2, 1, 1.0)
        self.expect_error(mesher, ("SetInterfaceSize()", "label 1", "2"), mesher.ClearInterfaceSizes)
        mesher.ExcludeLabel(2)
        self.expect_error(mesher, ("All labels", "excluded"), lambda: mesher.RemoveExcludedLabel(2))

    def test_interfaces(self):
        mesher = tets(ball())
        for labels, size, words in (
                *(((1, 0), bad, ("labels 1 and 0", "positive and finite")) for bad in (0.0, -1.0, INFINITY, NAN)),
                ((1, ANY), -1.0, ("all interfaces of label 1",)), ((9, 0), 1.0, ("SetInterfaceSize()", "label 9")),
                ((1, 1), 1.0, ("two different labels", "1 and")), ((1, -2), 1.0, ("two different labels", "1 and"))):
            mesher.SetInterfaceSize(*labels, size)
            self.expect_error(mesher, words, mesher.ClearInterfaceSizes)

    def test_numbers(self):
        mesher = tets(ball(8.0))
        mesher.SetDelta(2.0)
        mesher.SetNumberOfElements(5000)
        self.expect_error(mesher, ("Delta", "NumberOfElements"), lambda: mesher.SetDelta(0.0))
        mesher.SetElementSize(0.8)
        self.expect_error(mesher, ("no delta makes a mesh of 5000 elements", "nearest"), lambda: mesher.SetElementSize(0.0))

    def test_memory(self):
        mesher = tets(ball(10.0))
        mesher.SetDelta(1e-4)
        self.expect_error(mesher, ("memory",), lambda: mesher.SetDelta(2.0))
        mesher.SetMemoryLimit(1000)
        self.expect_error(mesher, ("memory",), mesher.ForceOn)

    def test_size_image(self):
        mesher, sizes = tets(ball()), voxplex.Image(numpy.full((N, N, N), 2.0), spacing=(1, 1, 1)).to_vtk()
        sizes.SetSpacing(1, 1, 0)
        mesher.SetElementSizeData(sizes)
        self.expect_error(mesher, ("image of element sizes", "spacing"), lambda: sizes.SetSpacing(1, 1, 1))
        sizes.GetPointData().SetScalars(add_array(sizes.GetPointData(), "Pairs", numpy.ones((N ** 3, 2))))
        self.expect_error(mesher, ("image of element sizes", "2 components"), lambda: mesher.SetElementSizeData(None))
        bare = vtkImageData()
        bare.SetDimensions(2, 2, 2)
        mesher.SetElementSizeData(bare)
        self.expect_error(mesher, ("image of element sizes",), lambda: mesher.SetElementSizeData(None))

    def test_isosurfaces(self):
        image = voxplex.Image((9 - RADII).astype(numpy.float32)).to_vtk()
        mesher = tets(image)
        self.assertEqual(mesher.GetInputMode(), mesher.INPUT_LABELS)
        # Labels are asked for by default, and the message shows the way.
        self.expect_error(mesher, ("isosurface",), mesher.SetInputModeToIsosurface)
        mesher.SetIsovalue(11)
        self.expect_error(mesher, ("isovalue 11", "from -1", "to 8."), lambda: mesher.SetIsovalue(0.0))
        mesher.SetInsideLabel(0)
        self.expect_error(mesher, ("label of the inside is 0",), lambda: mesher.SetInsideLabel(3))
        mesher.AddLabel(3)
        self.expect_error(mesher, ("AddLabel()", "InputMode is isosurface", "remove the labels"), mesher.RemoveAllLabels)
        mesher.ExcludeLabel(3)
        self.expect_error(mesher, ("ExcludeLabel()",), mesher.RemoveAllExcludedLabels)
        mesher.SetLabelSize(1, 2.0)
        self.expect_error(mesher, ("label 1", "labels are 3"), mesher.ClearLabelSizes)
        mesher.SetInputData(voxplex.Image(numpy.full((N, N, N), NAN, numpy.float32)).to_vtk())
        self.expect_error(mesher, ("NaN",), lambda: mesher.SetInputData(image))


class SpaceTime(FilterTestCase):
    def setUp(self):
        self.good = series(four_ball())

    def expect_series_error(self, words, source):
        mesher = pentatopes(source)
        self.expect_error(mesher, words, lambda: mesher.SetInputConnection(self.good.GetOutputPort()))

    def cells(self, mesher):
        mesher.Update()
        self.assertEqual(mesher.GetErrorMessage() or "", "")
        self.assertGreater(mesher.GetOutput().GetNumberOfCells(), 100)
        return voxplex.Mesh.from_vtk(mesher.GetOutput()).cells

    def test_times(self):
        for times, words in (
                ([2.0], ("one time step only", "vtkImageToTetMeshFilter")),
                ([], ("no time steps", "vtkImageToTetMeshFilter")),
                ([0, 1, 1, 2], ("must increase", "frame 1 has time 1", "frame 2 has time 1")),
                ([0, 2, 1, 3], ("must increase", "frame 1 has time 2", "frame 2 has time 1")),
                ([0, 1, 1.0001, 3], ("frames 1 and 2", "1 and 1.0001", "too near each other", "more than 1000")),
                ([0, NAN, 2, 3], ("frame 1", "nan", "finite")), ([0, 1, 2, INFINITY], ("frame 3", "finite"))):
            self.expect_series_error(words, series(four_ball(), times))
        # The rounding of a file's header is no gap.
        rounded = pentatopes(series(four_ball()[4:8], [0, 0.333333, 0.666667, 1]))
        rounded.SetTimeScale(3.0)
        self.cells(rounded)
        three = pentatopes(self.good)
        for time in (0.0, 1.0, 2.0):
            three.AddFrameTime(time)
        self.expect_error(three, ("AddFrameTime() gave 3 times, but there are 12 frames",), three.ClearFrameTimes)

    def test_frames(self):
        def make_larger(image):
            image.DeepCopy(voxplex.Image(numpy.ones((12, 13, 12), numpy.uint8)).to_vtk())

        def set_components(image):
            image.GetPointData().SetScalars(add_array(image.GetPointData(), "Other", numpy.ones((1728, 2))))

        first = "frame 0 (time 0)"
        for number, words, change in (
                (3, ("same dimensions", first, "frame 3 (time 3)", "12 x 12 x 12", "12 x 13 x 12"), make_larger),
                (5, ("same spacing", first, "frame 5 (time 5)", "1.01"), lambda image: image.SetSpacing(1, 1, 1.01)),
                (11, ("same origin", first, "frame 11 (time 11)", "(0, 0.5, 0)"), lambda image: image.SetOrigin(0, 0.5, 0)),
                (1, ("same origin", "frame 1"), lambda image: image.SetExtent(1, 12, 0, 11, 0, 11)),
                (2, ("same direction", first, "frame 2 (time 2)"),
                 lambda image: image.SetDirectionMatrix((0, 1, 0, 1, 0, 0, 0, 0, 1))),
                (4, ("same name", "frame 4 (time 4)", "'Mask'"),
                 lambda image: image.GetPointData().GetScalars().SetName("Mask")),
                (4, ("image of frame 4 (time 4)", "SetInputArrayToProcess"),
                 lambda image: image.GetPointData().Initialize()),
                (6, ("image of frame 6 (time 6)", "2 components", "time steps"), set_components)):
            source = series(four_ball())
            change(source.frames[number])
            self.expect_series_error(words, source)
        # What is within rounding is the same.
        source = series(four_ball())
        source.frames[3].SetOrigin(1e-6, 0, 0)
        source.frames[3].SetSpacing(1, 1 + 1e-6, 1)
        self.cells(pentatopes(source))

    def test_values(self):
        for number, value, words in (
                (2, 1.5, ("frame 2 (time 2)", "1.5", "(3, 4, 5)", "whole")), (7, -3, ("frame 7 (time 7)", "-3", "negative")),
                (0, NAN, ("frame 0", "finite")), (1, INFINITY, ("frame 1", "finite")),
                (1, 1e30, ("frame 1", "largest label"))):
            array = four_ball().astype(float)
            array[number, 5, 4, 3] = value
            self.expect_series_error(words, series(array))
        array = four_ball().astype(numpy.int16)
        array[3, 0, 0, 0] = -1
        self.expect_series_error(("frame 3", "-1", "(0, 0, 0)", "negative"), series(array))
        self.expect_series_error(("foreground",), series(0 * four_ball()[:3], TIMES[:3]))
        grey = numpy.arange(3 * 1728, dtype=numpy.float32).reshape(3, 12, 12, 12)
        self.expect_series_error(("grey-value",), series(grey, TIMES[:3]))
        self.expect_series_error(("1 voxel",), series(numpy.ones((3, 1, 12, 12), numpy.uint8), TIMES[:3]))

    def test_components(self):
        def expect(words, image):
            mesher = pentatopes(image)
            self.expect_error(mesher, words, lambda: mesher.SetInputData(components(four_ball())))

        expect(("one component", "vtkImageToTetMeshFilter"), components(four_ball()[5:6]))
        array = four_ball().astype(float)
        array[6, 5, 4, 3] = 0.25
        expect(("frame 6 (time 6)", "0.25", "(3, 4, 5)"), components(array))
        image = components(four_ball())
        image.GetPointData().Initialize()
        expect(("array", "SetInputArrayToProcess"), image)
        texts(image)
        mesher = pentatopes(image)
        choose(mesher, "Text")
        self.expect_error(mesher, ("Text", "numbers"))
        image = components(four_ball())
        image.SetSpacing(1, 1, 0)
        expect(("spacing", "positive"), image)

    def test_colours(self):
        """Bytes of three or four components are colours, unless there are times."""
        for kind in (numpy.uint8, numpy.uint16):
            for count in (3, 4):
                mesher = pentatopes(components(four_ball()[4:4 + count].astype(kind)))
                self.expect_error(mesher, ("RGB", "AddFrameTime()", "extract one component"),
                                  lambda: [mesher.AddFrameTime(time) for time in TIMES[:count]])
                mesher.ClearFrameTimes()
                mesher.SetTimeSpacing(0.5)
                self.cells(mesher)
        self.cells(pentatopes(components(four_ball()[4:7].astype(numpy.int16))))

    def test_negative_beside_chosen(self):
        """Chosen labels count first: negative voxels are background then, as other labels are."""
        expected = pentatopes(self.good)
        expected.AddLabel(3)
        for kind in (numpy.int16, numpy.float32):
            array = four_ball().astype(kind)
            array[..., 0] = -1024
            mesher = pentatopes(series(array))
            mesher.AddLabel(3)
            numpy.testing.assert_array_equal(self.cells(mesher), self.cells(expected))

    def test_parameters(self):
        """Those that the programs have no option for."""
        mesher = pentatopes(self.good)
        for name, good, bad in (("TimeOrigin", 0, (NAN, INFINITY)), ("TimeSpacing", 1, (0, -1, NAN, INFINITY)),
                                ("PickingRadius", 0.5, (0, 1, -0.5, NAN)), ("SliverRadiusFactor", 4, (0.9, 0, NAN, INFINITY))):
            for value in bad:
                getattr(mesher, "Set" + name)(value)
                self.expect_error(mesher, (name,), lambda: getattr(mesher, "Set" + name)(good))
        mesher.SetSliverBound(0.04)
        self.expect_error(mesher, ("SliverBound", "0.03", "Force"), mesher.ForceOn)
        mesher.SetSliverBound(0.01)
        mesher.SetInputModeToIsosurface()
        mesher.SetIsovalue(50)
        self.expect_error(mesher, ("outside of the image's range",), lambda: mesher.SetIsovalue(1))

    def test_failing_input(self):
        """Nothing comes out, and the next execution starts afresh."""
        for failing in (1, 5, 11):
            source = series(four_ball())
            source.frames[failing] = None
            source.GetExecutive().AddObserver("ErrorEvent", lambda *_: None)
            mesher = pentatopes(source)
            errors_of(mesher)
            self.assertEqual(mesher.GetExecutive().Update(), 0)
            self.assertTrue(self.is_empty(mesher))
            self.assertNotEqual(mesher.GetErrorMessage() or "", "")
            self.assertEqual(source.asked, TIMES[:failing + 1])
            # Other frames than those that were gathered before the failure.
            other = series(four_ball(3.6))
            source.frames = other.frames
            source.Modified()
            numpy.testing.assert_array_equal(self.cells(mesher), self.cells(pentatopes(other)))
            numpy.testing.assert_array_equal(voxplex.Mesh.from_vtk(mesher.GetOutput()).points.shape[0],
                                             vtk_to_numpy(mesher.GetOutput().GetPointData().GetArray("Time")).shape[0])


if __name__ == "__main__":
    unittest.main()
