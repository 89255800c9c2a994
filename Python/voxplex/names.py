# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Names and colours of labels, which travel with images and meshes as field data.

The arrays are `LabelValues`, `LabelNames` and `LabelColors`: one tuple a label, in increasing order
of the value, background not listed. The meshing filters pass them from the image to the mesh. In `.vtu` and `.vtk` files
of meshes `LabelNames` has bytes in place of strings, because meshio reads no strings.
"""

from __future__ import annotations

from typing import Dict, List, Mapping, Union

from vtkmodules.vtkCommonCore import vtkAbstractArray, vtkIntArray, vtkLongLongArray, vtkStringArray
from vtkmodules.vtkCommonDataModel import vtkDataObject

Label = Union[int, str]
"""A label's value, or its name where the image carries names."""

_VALUES = "LabelValues"
_NAMES = "LabelNames"
_COLORS = "LabelColors"


def _texts(array: vtkAbstractArray) -> List[str]:
    """Those of an array of strings, or of bytes with a 0 at the end of each text."""
    if array.IsA("vtkUnsignedCharArray"):
        return bytes(array).decode(errors="replace").split("\0")[:-1]
    return [array.GetValue(i) for i in range(array.GetNumberOfValues())] if array.IsA("vtkStringArray") else []


def label_names(data: vtkDataObject) -> Dict[int, str]:
    """The names of labels that an image or a mesh carries, by label value.

    Labels without a name are not in it. Empty if there are no names.
    """
    fields = data.GetFieldData()
    values = fields.GetArray(_VALUES)
    names = fields.GetAbstractArray(_NAMES)
    if values is None or names is None:
        return {}
    return {int(values.GetComponent(i, 0)): name
            for i, name in zip(range(values.GetNumberOfValues()), _texts(names)) if name}


def set_label_names(data: vtkDataObject, names: Mapping[int, str]) -> None:
    """Lets an image or a mesh carry these names, instead of the names and colours that it had.

    Names of an image reach the meshes that are made from it, and the groups of files that
    :func:`write` makes.

    Raises ValueError for a value below 1, which no tissue has.
    """
    values = sorted(names)
    if values and values[0] < 1:
        raise ValueError(f"labels are whole numbers from 1 on, not {values[0]}")
    numbers = vtkIntArray() if not values or values[-1] < 2 ** 31 else vtkLongLongArray()
    numbers.SetName(_VALUES)
    strings = vtkStringArray()
    strings.SetName(_NAMES)
    for value in values:
        numbers.InsertNextValue(value)
        strings.InsertNextValue(names[value])
    fields = data.GetFieldData()
    fields.RemoveArray(_COLORS)
    fields.AddArray(numbers)
    fields.AddArray(strings)


def label_value(label: Label, names: Mapping[int, str]) -> int:
    """The value of a label that is given by its value or its name.

    Raises ValueError for a name that none or several labels have, and for a number that is not whole.
    """
    if not isinstance(label, str):
        if not float(label).is_integer():
            raise ValueError(f"labels are whole numbers, not {label!r}")
        return int(label)
    found = [value for value, name in names.items() if name == label]
    if len(found) == 1:
        return found[0]
    if found:
        raise ValueError(f"several labels are called {label!r}: {found}; give the value")
    known = ", ".join(repr(name) for name in names.values()) or "the image has no label names"
    raise ValueError(f"no label is called {label!r} ({known})")
