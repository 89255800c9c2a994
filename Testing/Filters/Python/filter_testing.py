# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""What the tests of the filters share."""
import unittest

import numpy
from vtkmodules.util.misc import calldata_type
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.util.vtkConstants import VTK_STRING
from vtkmodules.vtkCommonDataModel import vtkImageData

import voxplex
from temporal import Series


def errors_of(algorithm):
    """A list that the texts of the algorithm's error events go into."""
    messages = []

    @calldata_type(VTK_STRING)
    def keep(_caller, _event, text):
        messages.append(text)

    algorithm.AddObserver("ErrorEvent", keep)
    algorithm.GetExecutive().AddObserver("ErrorEvent", lambda *_: None)
    return messages


def add_array(data, name, values):
    array = numpy_to_vtk(values, deep=True)
    array.SetName(name)
    data.AddArray(array)
    return array


def components(frames):
    """One image with a component for each frame."""
    image = voxplex.Image(frames[0]).to_vtk()
    scalars = add_array(image.GetPointData(), "Frames", numpy.stack([frame.ravel() for frame in frames], axis=1))
    image.GetPointData().SetScalars(scalars)
    return image


def tets(image):
    mesher = voxplex.vtkImageToTetMeshFilter()
    mesher.SetInputData(image)
    mesher.SetNumberOfThreads(1)
    return mesher


TIMES = [float(time) for time in range(12)]


def four_ball(radius=4.2):
    """Label 3 on the left, 7 on the right; [time, k, j, i], 12 voxels along each."""
    t, k, j, i = numpy.mgrid[:12, :12, :12, :12] - 5.5
    inside = numpy.sqrt(t * t + k * k + j * j + i * i) < radius
    return numpy.where(inside, numpy.where(i < 0, 3, 7), 0).astype(numpy.uint8)


def image_of_array(array):
    return voxplex.Image(array).to_vtk()


def series(array, times=TIMES, image_of=image_of_array):
    return Series(map(image_of, array), times)


def pentatopes(source):
    """Of components or of a series; without picking."""
    mesher = voxplex.vtkImageToPentatopeMeshFilter()
    if isinstance(source, vtkImageData):
        mesher.SetInputData(source)
    else:
        mesher.SetInputConnection(source.GetOutputPort())
    mesher.SetNumberOfThreads(1)
    mesher.PickingRegionsOff()
    return mesher


class FilterTestCase(unittest.TestCase):
    def is_empty(self, mesher):
        outputs = [mesher.GetOutputDataObject(port) for port in range(mesher.GetNumberOfOutputPorts())]
        return not any(output.GetNumberOfCells() or output.GetNumberOfPoints() for output in outputs)

    def expect_error(self, mesher, words, repair=None):
        """One message with these words, and nothing else. With what `repair` calls, the filter works."""
        with self.subTest(words):
            errors = errors_of(mesher)
            self.assertEqual(mesher.GetExecutive().Update(), 0)
            self.assertEqual(len(errors), 1, errors)
            self.assertIn(mesher.GetErrorMessage(), errors[0])
            for word in words:
                self.assertIn(word, mesher.GetErrorMessage() or "nothing")
            self.assertFalse(mesher.GetAborted())
            self.assertTrue(self.is_empty(mesher))
            self.assertEqual(mesher.GetStatistics().GetNumberOfElements(), 0)
            if repair:
                repair()
                mesher.Update()
                self.assertEqual(mesher.GetErrorMessage() or "", "")
                self.assertGreater(mesher.GetOutput().GetNumberOfCells(), 0)
