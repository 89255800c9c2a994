# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""What the tests of the ParaView plugin share. CTest tells them where things are (CMakeLists.txt)."""
import os
import sys

from paraview import servermanager
from paraview.simple import ColorBy, GetActiveViewOrCreate, LoadPlugin, Render, ResetCamera, SaveScreenshot, Show

PLUGIN = os.environ["VOXPLEX_PARAVIEW_PLUGIN"]
OUTPUT = os.environ["VOXPLEX_TEST_OUTPUT"]
ATLAS = os.environ.get("VOXPLEX_TEST_ATLAS", "")

NAME = "Foie \u00e9"  # beyond ASCII
COLOR = (0.8, 0.4, 0.2)

FAILURES = []


def check(condition, *what):
    """Notes a failure and goes on."""
    if not condition:
        FAILURES.append(what)
        print("FAILED:", *what, file=sys.stderr)


def check_equal(found, expected, what=""):
    check(found == expected, what, "found", found, "expected", expected)


def finish():
    """Ends the script: its exit status is what CTest looks at."""
    sys.stdout.flush()
    sys.stderr.flush()
    if FAILURES:
        print("%d check(s) failed" % len(FAILURES), file=sys.stderr)
    else:
        print("all checks passed")
    sys.stdout.flush()
    # ParaView's own exit handlers may crash; what is to be tested has been tested.
    os._exit(1 if FAILURES else 0)


def run(main):
    """Calls main and ends; an exception is a failure."""
    import traceback

    try:
        main()
    except BaseException:
        traceback.print_exc()
        FAILURES.append("exception")
    finish()


def load_plugin(remote=False, namespace=None):
    """Loads the plugin into the client, and into the server if there is one."""
    if remote:
        LoadPlugin(PLUGIN, remote=True, ns=namespace)
    LoadPlugin(PLUGIN, remote=False, ns=namespace)


def output_path(name):
    return os.path.join(OUTPUT, name)


def make_image(function, dimensions=(16, 16, 16), spacing=(1.0, 1.0, 1.0), components=1, name="Segmentation"):
    """A vtkImageData with whole values: function(i, j, k) for each voxel."""
    from vtkmodules.vtkCommonCore import vtkUnsignedCharArray
    from vtkmodules.vtkCommonDataModel import vtkImageData

    image = vtkImageData()
    image.SetDimensions(dimensions)
    image.SetSpacing(spacing)
    labels = vtkUnsignedCharArray()
    labels.SetName(name)
    labels.SetNumberOfComponents(components)
    for k in range(dimensions[2]):
        for j in range(dimensions[1]):
            for i in range(dimensions[0]):
                value = function(i, j, k)
                labels.InsertNextTuple(value if components > 1 else (value,))
    image.GetPointData().SetScalars(labels)
    return image


def write_image(image, name):
    """Writes a .vti into the output folder; its path."""
    from vtkmodules.vtkIOXML import vtkXMLImageDataWriter

    writer = vtkXMLImageDataWriter()
    writer.SetFileName(output_path(name))
    writer.SetInputData(image)
    check_equal(writer.Write(), 1, "write " + name)
    return output_path(name)


def two_balls(i, j, k):
    """Labels 3 and 7: the halves of a ball of radius 6 around (7.5, 7.5, 7.5)."""
    inside = (i - 7.5) ** 2 + (j - 7.5) ** 2 + (k - 7.5) ** 2 < 36
    return 0 if not inside else 3 if i < 8 else 7


def write_named_image(as_bytes=False):
    """An image of labels 3, which has a name and a colour, and 7, which has neither.

    as_bytes: the name is as in mesh files of Voxplex."""
    from vtkmodules.vtkCommonCore import vtkDoubleArray, vtkIntArray, vtkStringArray, vtkUnsignedCharArray

    image = make_image(two_balls)
    values, colors = vtkIntArray(), vtkDoubleArray()
    names = vtkUnsignedCharArray() if as_bytes else vtkStringArray()
    values.SetName("LabelValues")
    values.InsertNextValue(3)
    names.SetName("LabelNames")
    for name in (*NAME.encode(), 0) if as_bytes else (NAME,):
        names.InsertNextValue(name)
    colors.SetName("LabelColors")
    colors.SetNumberOfComponents(3)
    colors.InsertNextTuple(COLOR)
    for array in (values, names, colors):
        image.GetFieldData().AddArray(array)
    return write_image(image, "named-bytes.vti" if as_bytes else "named.vti")


def pairs(annotations):
    """A colour map's annotations by value."""
    return dict(zip(annotations[::2], annotations[1::2]))


def labels_of(proxy, name="Label", port=0):
    """The set of values of a cell array; fetches the data to the client."""
    data = servermanager.Fetch(proxy, idx=port) if port else servermanager.Fetch(proxy)
    array = data.GetCellData().GetArray(name)
    check(array is not None, "no array", name)
    return {int(array.GetComponent(i, 0)) for i in range(array.GetNumberOfTuples())} if array else set()


def count_cells(proxy, port=0):
    return proxy[port].GetDataInformation().GetNumberOfCells()


class Executions:
    """Counts how often the VTK filter behind a proxy starts to execute (only with the built-in server)."""

    def __init__(self, proxy):
        self.count = 0
        self.algorithm = proxy.SMProxy.GetClientSideObject()
        self.algorithm.AddObserver("StartEvent", self._increment)

    def _increment(self, *_):
        self.count += 1


def screenshot(proxy, name, color):
    """Saves a picture of a source, and checks that something was drawn."""
    view = GetActiveViewOrCreate("RenderView")
    view.ViewSize = (600, 450)
    representation = Show(proxy, view)
    ColorBy(representation, color)
    ResetCamera(view)
    Render(view)
    SaveScreenshot(output_path(name), view)
    check_picture(output_path(name))


def check_picture(path, colors=20):
    """A picture that shows something has more than a few colours."""
    from vtkmodules.vtkIOImage import vtkPNGReader
    from vtkmodules.util.numpy_support import vtk_to_numpy
    import numpy

    reader = vtkPNGReader()
    reader.SetFileName(path)
    reader.Update()
    pixels = vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars())
    distinct = len(numpy.unique(pixels, axis=0))
    check(distinct > colors, path, "has only", distinct, "colours")
    return pixels
