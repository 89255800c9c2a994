# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Names of labels, which travel with images and meshes as field data.

The arrays are `LabelValues`, `LabelNames` and `LabelColors`: one row a label, in increasing order of the value,
background not listed. `SPACE` has the coordinate system, LPS or RAS.
"""

from __future__ import annotations

import difflib
from typing import Any, Dict, List, Mapping, Optional, Union

import numpy
from numpy.typing import NDArray

Fields = Dict[str, Union[NDArray[Any], List[str]]]
"""Field data: arrays of numbers, or lists of texts, by name."""

Label = Union[int, str]
"""A label's value, or its name where the image has names."""

_VALUES = "LabelValues"
_NAMES = "LabelNames"
_COLORS = "LabelColors"
TEXTS = (_NAMES, "SurfaceNames", "SPACE")  # files of meshes have bytes in their place


def texts_of(data: bytes) -> List[str]:
    """Of bytes with a 0 at the end of each text."""
    return [text.decode(errors="replace") for text in data.split(b"\0")[:-1]]


def set_names(fields: Fields, names: Mapping[int, str]) -> None:
    """Replaces names and colours.

    Raises ValueError for a value below 1, which no tissue has.
    """
    for value in names:
        if isinstance(value, str) or value != int(value):
            raise TypeError(f"names: labels are whole numbers, not {value!r}")
    values = sorted(names)
    if values and values[0] < 1:
        raise ValueError(f"labels are whole numbers from 1 on, not {values[0]}")
    for array in (_VALUES, _NAMES, _COLORS):
        fields.pop(array, None)
    if values:
        large = values[-1] >= 2 ** 31
        fields[_VALUES] = numpy.array(values, dtype=numpy.int64 if large else numpy.int32)
        fields[_NAMES] = [names[value] for value in values]


class HasFields:
    """An image, a mesh or its interfaces: what has field data."""

    field_data: Fields

    @property
    def names(self) -> Dict[int, str]:
        """The names of labels, by value; those without one are not in it. Assign to it to change them; colours are dropped then."""
        values = self.field_data.get(_VALUES)
        names = self.field_data.get(_NAMES)
        if values is None or names is None:
            return {}
        return {int(value): str(name) for value, name in zip(values, names) if name}

    @names.setter
    def names(self, names: Mapping[int, str]) -> None:
        set_names(self.field_data, names)

    @property
    def space(self) -> Optional[str]:
        """The coordinates, LPS or RAS; None if they are not known."""
        found = self.field_data.get("SPACE")
        return str(found[0]) if found is not None and len(found) else None


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
    near = difflib.get_close_matches(label, names.values(), 3, 0.0)
    known = "there are " + ", ".join(map(repr, near)) + (" and others" if len(names) > 3 else "")
    raise ValueError(f"no label is called {label!r} ({known if names else 'the image has no label names'})")
