# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""The files in which the program gets and gives meshes: VTK's XML, arrays appended as they are in memory."""

from __future__ import annotations

import struct
from typing import Any, Dict, List, Mapping, NamedTuple, Union
from xml.etree import ElementTree
from xml.sax.saxutils import quoteattr

import numpy
from numpy.typing import NDArray

from .fields import TEXTS, Fields, texts_of

_APPENDED = b'<AppendedData encoding="raw">'
# By VTK's type of a cell of a mesh, or of interfaces: a triangle, a tetrahedron, a pentatope.
CORNERS = {5: 3, 10: 4, 2: 5}
ACTIVE = "Label"  # the array that other programs show first
IDS = ("PointIds",)  # numbers of points, which VTK has a type for
CELL_TYPE = {corners: cell_type for cell_type, corners in CORNERS.items()}


class Arrays(NamedTuple):
    """Those of a file: points, cells (one row of point numbers each), and data by name."""

    points: NDArray[Any]
    cells: NDArray[Any]
    point_data: Dict[str, NDArray[Any]]
    cell_data: Dict[str, NDArray[Any]]
    field_data: Fields


def check(arrays: Arrays) -> None:
    """Raises ValueError for arrays that do not fit each other."""
    points, cells = numpy.asarray(arrays.points), numpy.asarray(arrays.cells)
    if points.ndim != 2 or points.shape[1] != 3 or cells.ndim != 2 or cells.shape[1] not in CELL_TYPE:
        raise ValueError(f"points have the shape {points.shape}, not (number, 3), or cells {cells.shape}, not (number, 3, 4 or 5)")
    if cells.dtype.kind not in "iu" or len(cells) and not 0 <= cells.min() <= cells.max() < len(points):
        raise ValueError(f"cells must be numbers of points, from 0 to {len(points) - 1}")
    for what, data, count in (("point_data", arrays.point_data, len(points)), ("cell_data", arrays.cell_data, len(cells))):
        for name, values in data.items():
            if len(values) != count:
                raise ValueError(f"{what}[{name!r}] has {len(values)} rows, not {count}")


def native(name: str, values: Any) -> NDArray[Any]:
    """In memory as VTK has it."""
    array = numpy.ascontiguousarray(values)
    if array.dtype.kind not in "biuf":
        raise TypeError(f"the array {name!r} has elements of type {array.dtype}, which are not numbers")
    if array.dtype.kind == "b":
        return array.view(numpy.uint8)
    if array.dtype.kind == "f" and array.dtype.itemsize not in (4, 8):
        return array.astype(numpy.float32 if array.dtype.itemsize < 4 else numpy.float64)
    return array.astype(array.dtype.newbyteorder("="), copy=False)


def read(path: str) -> Arrays:
    """Reads a .vtu file of one kind of cells that the program wrote with --uncompressed."""
    with open(path, "rb") as file:
        header = bytearray()
        while _APPENDED not in header:
            block = file.read(1 << 16)
            if not block:
                raise ValueError(f"{path} has no appended data")
            header += block
        head = bytes(header).partition(_APPENDED)[0]
        start = header.index(b"_", len(head)) + 1
        tree = ElementTree.fromstring(head + b"</VTKFile>")
        found: Dict[str, Dict[str, Any]] = {}
        for parent in tree.iter():
            for element in parent:
                if element.tag in ("DataArray", "Array"):
                    found.setdefault(parent.tag, {})[element.get("Name", "")] = _read_array(file, start, element)
    nothing: Dict[str, Any] = {}
    points = found["Points"].popitem()[1]
    cells = found["Cells"]
    types = cells["types"]
    corners = CORNERS[int(types[0])] if len(types) else 4
    fields: Fields = found.get("FieldData", nothing)
    for name in TEXTS:
        if name in fields and not isinstance(fields[name], list):
            fields[name] = texts_of(numpy.asarray(fields[name]).tobytes())
    return Arrays(points.reshape(-1, 3), cells["connectivity"].reshape(-1, corners), found.get("PointData", nothing),
                  found.get("CellData", nothing), fields)


def _read_array(file: Any, start: int, element: ElementTree.Element) -> Union[NDArray[Any], List[str]]:
    file.seek(start + int(element.get("offset", "0")))
    (size,) = struct.unpack("<Q", file.read(8))
    kind = element.get("type", "")
    dtype = numpy.dtype("uint8" if kind == "String" else kind.lower())
    array = numpy.empty(size // dtype.itemsize, dtype=dtype)
    if array.size and file.readinto(array.view(numpy.uint8).data) != size:
        raise ValueError(f"{file.name} is cut short")
    if kind == "String":
        return texts_of(array.tobytes())
    components = int(element.get("NumberOfComponents") or 1)
    return array.reshape(-1, components) if components > 1 else array


def write(path: str, arrays: Arrays) -> None:
    """Writes a .vtu file of one kind of cells; of triangles a .vtp file."""
    check(arrays)
    corners = arrays.cells.shape[1]
    count = len(arrays.cells)
    is_surface = corners == 3
    kind, cells = ("PolyData", "Polys") if is_surface else ("UnstructuredGrid", "Cells")
    connectivity = {"connectivity": numpy.reshape(arrays.cells, -1),
                    "offsets": numpy.arange(1, count + 1, dtype=numpy.int64) * corners}
    if not is_surface:
        connectivity["types"] = numpy.full(count, CELL_TYPE[corners], dtype=numpy.uint8)
    writer = _Writer()
    text = [f'<VTKFile type="{kind}" version="1.0" byte_order="LittleEndian" header_type="UInt64">', f"<{kind}>",
            *writer.section("FieldData", arrays.field_data),
            f'<Piece NumberOfPoints="{len(arrays.points)}" NumberOf{cells}="{count}">',
            *writer.section("PointData", arrays.point_data), *writer.section("CellData", arrays.cell_data),
            *writer.section("Points", {"Points": arrays.points}), *writer.section(cells, connectivity),
            "</Piece>", f"</{kind}>", ""]
    with open(path, "wb") as file:
        file.write("\n".join(text).encode() + _APPENDED + b"_")
        for array in writer.arrays:
            file.write(struct.pack("<Q", array.nbytes))
            file.write(array.reshape(-1).view(numpy.uint8).data)
        file.write(b"</AppendedData></VTKFile>")


class _Writer:
    """Collects arrays and their places in the appended data."""

    def __init__(self) -> None:
        self.arrays: List[NDArray[Any]] = []
        self.offset = 0

    def section(self, tag: str, arrays: Mapping[str, Any]) -> List[str]:
        active = f' Scalars="{ACTIVE}"' if ACTIVE in arrays else ""
        elements = [self._element(tag, name, values) for name, values in arrays.items()]
        return [f"<{tag}{active}>", *elements, f"</{tag}>"]

    def _element(self, tag: str, name: str, values: Union[NDArray[Any], List[str]]) -> str:
        if isinstance(values, list):
            values = numpy.frombuffer("".join(text + "\0" for text in values).encode(), dtype=numpy.uint8)
        array = native(name, values)
        array = array.astype(array.dtype.newbyteorder("<"), copy=False)
        kind = array.dtype.name.replace("uint", "UInt").replace("int", "Int").replace("float", "Float")
        ids = ' IdType="1"' if name in IDS else ""
        tuples = f' NumberOfTuples="{len(array)}"' if tag == "FieldData" else ""
        components = array.shape[1] if array.ndim > 1 else 1
        element = (f'<DataArray type="{kind}"{ids} Name={quoteattr(name)} NumberOfComponents="{components}"{tuples} '
                   f'format="appended" offset="{self.offset}"/>')
        self.arrays.append(array)
        self.offset += 8 + array.nbytes
        return element
