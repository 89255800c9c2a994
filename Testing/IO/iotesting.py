# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""What the tests of the IO module share."""
import math

from vtkmodules.util.vtkConstants import VTK_DOUBLE
from vtkmodules.vtkCommonCore import vtkObject

import folders
import meshfiles
import voxplex


class FolderTestCase(folders.FolderTestCase):
    """Errors are looked at through GetErrorMessage()."""

    def setUp(self):
        super().setUp()
        vtkObject.GlobalWarningDisplayOff()

    def reader(self, path, **properties):
        """A reader that has executed."""
        reader = voxplex.vtkSegmentationReader()
        reader.SetFileName(path)
        for name, value in properties.items():
            getattr(reader, "Set" + name)(value)
        reader.Update()
        return reader

    def read(self, path, **properties):
        """The image, which must be readable without a warning."""
        reader = self.reader(path, **properties)
        self.assertEqual(reader.GetErrorMessage(), "")
        self.assertEqual(warnings_of(reader), [])
        return reader.GetOutput()

    def refused(self, pattern, path, **properties):
        reader = self.reader(path, **properties)
        self.assertRegex(reader.GetErrorMessage(), pattern)
        self.assertEqual(reader.GetOutput().GetNumberOfPoints(), 0)
        self.assertEqual(reader.GetNumberOfFrames(), 0)
        self.assertEqual(reader.GetLabelTableSource(), "")


def warnings_of(reader):
    return [reader.GetWarning(i) for i in range(reader.GetNumberOfWarnings())]


def table_of(data):
    """{label: (name, colour or None)} of the field data. All its arrays are checked."""
    fields = data.GetFieldData()
    values = fields.GetArray("LabelValues")
    names = meshfiles.texts_of(data, "LabelNames")
    colors = fields.GetArray("LabelColors")
    if values is None:
        assert names == [] and colors is None
        return {}
    count = values.GetNumberOfValues()
    assert values.GetDataTypeSize() in (4, 8) and values.GetDataTypeValueMin() < 0, values.GetClassName()
    assert len(names) == count
    labels = [values.GetValue(i) for i in range(count)]
    assert labels == sorted(set(labels)) and labels[0] > 0, labels
    if colors:
        assert colors.GetDataType() == VTK_DOUBLE, colors.GetClassName()
        assert (colors.GetNumberOfComponents(), colors.GetNumberOfTuples()) == (3, count)
    table = {}
    for i, label in enumerate(labels):
        color = colors.GetTuple3(i) if colors else None
        if color and math.isnan(color[0]):
            assert all(math.isnan(part) for part in color)
            color = None
        table[label] = (names[i], color and tuple(round(255 * part, 6) for part in color))
    return table
