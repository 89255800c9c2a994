# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Names and colours of labels, and the arrays in which they travel with images and meshes.

The arrays are `LabelValues`, `LabelNames` and `LabelColors`: one row a label, in increasing order of the value,
background not listed. `SPACE` has the coordinate system, LPS or RAS.
"""

from __future__ import annotations

import difflib
import html
from typing import Any, Dict, Iterable, List, Mapping, Optional, Sequence, Union

import numpy
from numpy.typing import NDArray

Fields = Dict[str, Union[NDArray[Any], List[str]]]
"""Field data: arrays of numbers, or lists of texts, by name."""

Label = Union[int, str]
"""A label's value, or its name where the image has names."""

Color = Sequence[float]
"""Red, green and blue, from 0 to 1."""

_VALUES = "LabelValues"
_NAMES = "LabelNames"
_COLORS = "LabelColors"
_SPACE = "SPACE"
TEXTS = (_NAMES, "SurfaceNames", _SPACE)  # files of meshes have bytes in their place


def texts_of(data: bytes) -> List[str]:
    """Of bytes with a 0 at the end of each text."""
    return [text.decode(errors="replace") for text in data.split(b"\0")[:-1]]


class Described:
    """An image, a mesh or its interfaces: what has names and colours of labels, and other field data."""

    names: Dict[int, str]
    colors: Dict[int, Color]
    space: Optional[str]
    field_data: Fields

    def _fields(self) -> Fields:
        """All of it as arrays. Raises ValueError for a label below 1, which no tissue has."""
        check_names(self.names)
        result = dict(self.field_data)
        values = sorted(self.names)
        if values:
            result[_VALUES] = numpy.array(values, dtype=numpy.int64 if values[-1] >= 2 ** 31 else numpy.int32)
            result[_NAMES] = [self.names[value] for value in values]
            if any(value in self.colors for value in values):
                result[_COLORS] = numpy.array([self.colors.get(value, (numpy.nan,) * 3) for value in values], dtype=float)
        if self.space is not None:
            result[_SPACE] = [self.space]
        return result

    def _describe(self, fields: Fields) -> None:
        """Takes what _fields() returns."""
        rest = dict(fields)
        values, names, colors, space = [rest.pop(name, []) for name in (_VALUES, _NAMES, _COLORS, _SPACE)]
        rows = [(int(value), str(name)) for value, name in zip(values, names)]
        self.names = {value: name for value, name in rows if value > 0 and name}
        self.colors = {value: [float(part) for part in color] for (value, _), color in zip(rows, colors) if numpy.isfinite(color).all()}
        self.space = str(space[0]) if len(space) else None
        self.field_data = rest


def check_names(names: Mapping[int, str]) -> None:
    """Raises TypeError or ValueError for what is no label of a tissue."""
    for value in names:
        if isinstance(value, str) or value != int(value):
            raise TypeError(f"names: labels are whole numbers, not {value!r}")
        if value < 1:
            raise ValueError(f"names: labels are whole numbers from 1 on, not {value}")


def label_value(label: Label, names: Mapping[int, str]) -> int:
    """The value of a label that is given by its value or its name, whose case counts only if several names differ in nothing else.

    Raises ValueError for a name that none or several labels have, and for a number that is not whole.
    """
    if not isinstance(label, str):
        if not float(label).is_integer():
            raise ValueError(f"labels are whole numbers, not {label!r}")
        return int(label)
    found = ([value for value, name in names.items() if name == label]
             or [value for value, name in names.items() if name.lower() == label.lower()])
    if len(found) == 1:
        return found[0]
    if found:
        raise ValueError(f"several labels are called {label!r}: {found}; give the value")
    near = difflib.get_close_matches(label, names.values(), 3, 0.0)
    known = "there are " + ", ".join(map(repr, near)) + (" and others" if len(names) > 3 else "")
    raise ValueError(f"no label is called {label!r} ({known if names else 'the image has no label names'})")


def html_table(title: str, heads: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """What a notebook shows."""
    cells = ["".join(f"<{tag}>{html.escape(str(text))}</{tag}>" for text in row)
             for tag, row in [("th", heads), *(("td", row) for row in rows)]]
    return f"<p>{html.escape(title)}</p><table>{''.join(f'<tr>{row}</tr>' for row in cells)}</table>"
