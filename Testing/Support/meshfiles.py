# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Reads the formats that the program writes: VTK's by VTK's readers, others by hand. Those that other programs read in
tests of their own are not among them."""
import re
from dataclasses import dataclass, field
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOGeometry import vtkSTLReader
from vtkmodules.vtkIOLegacy import vtkPolyDataReader, vtkUnstructuredGridReader
from vtkmodules.vtkIOPLY import vtkPLYReader
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLUnstructuredGridReader


class Labelled:
    """What has labels, and volumes()."""

    def volume_of_label(self):
        volumes = self.volumes()
        return {int(label): float(volumes[self.labels == label].sum()) for label in np.unique(self.labels)}


@dataclass
class Tetrahedra(Labelled):
    points: np.ndarray
    cells: np.ndarray
    labels: np.ndarray
    space: str = ""
    triangles: np.ndarray = None
    references: np.ndarray = None  # of the triangles
    names: dict = field(default_factory=dict)  # of pairs of labels
    label_names: dict = field(default_factory=dict)
    node_sets: dict = field(default_factory=dict)
    surfaces: dict = field(default_factory=dict)  # of faces, as vertices whose normal points out of the tetrahedron
    surface_labels: dict = field(default_factory=dict)  # of these tetrahedra

    def volumes(self):
        a, b, c, d = (self.points[self.cells[:, i]] for i in range(4))
        return np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) / 6.0


@dataclass
class Triangles:
    points: np.ndarray
    cells: np.ndarray
    labels: np.ndarray = None  # two columns
    point_ids: np.ndarray = None
    space: str = ""

    def areas(self):
        a, b, c = (self.points[self.cells[:, i]] for i in range(3))
        return np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2.0

    def enclosed_volume(self):
        a, b, c = (self.points[self.cells[:, i]] for i in range(3))
        return float(np.einsum("ij,ij->i", np.cross(a, b), c).sum() / 6.0)


@dataclass
class Pentatopes(Labelled):
    points: np.ndarray  # x, y, z, t
    cells: np.ndarray
    labels: np.ndarray
    space: str = ""
    tetrahedra: np.ndarray = None
    references: np.ndarray = None  # of the tetrahedra
    names: dict = field(default_factory=dict)
    sides: dict = field(default_factory=dict)  # of references: "", "initial", "final", "plane 1" ...
    planes: list = field(default_factory=list)  # their times
    times: list = field(default_factory=list)  # of a slab's ends
    slabs: np.ndarray = None  # of the pentatopes
    pairs: np.ndarray = None  # of points
    numbers: np.ndarray = None  # of a slab's points in the whole mesh

    def volumes(self):
        corners = self.points[self.cells]
        return np.linalg.det(corners[:, 1:] - corners[:, :1]) / 24.0


@dataclass
class Boundary:
    points: np.ndarray  # x, y, z, t
    cells: np.ndarray
    labels: np.ndarray  # two columns
    point_ids: np.ndarray
    space: str
    sides: np.ndarray  # 0 lateral, 1 at the first time, 2 at the last
    velocities: np.ndarray  # along the normal in space
    point_velocities: np.ndarray  # three columns
    surfaces: np.ndarray  # numbers
    surface_names: dict  # of the numbers


@dataclass
class Slice(Labelled):
    points: np.ndarray
    cells: np.ndarray
    labels: np.ndarray
    time: float
    space: str = ""
    point_velocities: np.ndarray = None  # three columns

    def volumes(self):
        corners = self.points[self.cells]
        return np.linalg.det(corners[:, 1:] - corners[:, :1]) / 6.0


def texts_of(data, name):
    """Those of an array in the field data: strings, or bytes with a 0 at the end of each text."""
    array = data.GetFieldData().GetAbstractArray(name)
    values = [array.GetValue(i) for i in range(array.GetNumberOfValues())] if array else []
    if array and not array.IsA("vtkStringArray"):
        *values, rest = bytes(values).decode().split("\0")
        assert rest == "", rest
    return values


def _space(data):
    return "".join(texts_of(data, "SPACE"))


def _points(data):
    return vtk_to_numpy(data.GetPoints().GetData()).astype(float)


def read_data(path):
    """What VTK's reader of .vtu, .vtp or, of grids, .vtk makes of a file."""
    readers = {".vtu": vtkXMLUnstructuredGridReader, ".vtp": vtkXMLPolyDataReader, ".vtk": vtkUnstructuredGridReader}
    return _read(readers[Path(path).suffix](), path)


def _read(reader, path):
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def read_tetrahedra(path):
    path = str(path)
    if path.endswith((".vtu", ".vtk")):
        return _from_grid(read_data(path))
    if path.endswith(".mesh"):
        return _read_medit(path)
    if path.endswith(".inp"):
        return _read_abaqus(path)
    if path.endswith(".mfem"):
        return _read_mfem(path)
    raise ValueError(path)


def read_pentatopes(path):
    path = str(path)
    if path.endswith(".vtu"):
        return _pentatopes_from_grid(read_data(path))
    if path.endswith(".mfem"):
        return _read_space_time_mfem(path)
    if path.endswith(".mesh"):
        return _read_gmf(path)
    raise ValueError(path)


def _points_of_space_time(grid):
    times = vtk_to_numpy(grid.GetPointData().GetArray("Time"))
    if times.dtype != np.float64 or times.ndim != 1:
        raise AssertionError("times")
    return np.column_stack([_points(grid), times])


def _require_type(grid, kind):
    if any(grid.GetCellType(cell) != kind for cell in range(grid.GetNumberOfCells())):
        raise AssertionError("cells that are not of type %d" % kind)


def _pentatopes_from_grid(grid):
    _require_type(grid, 2)
    cells = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 5)
    planes, times, pairs = (grid.GetFieldData().GetArray(name) for name in ("TimePlanes", "SlabTimes", "PeriodicPairs"))
    slabs, numbers = grid.GetCellData().GetArray("Slab"), grid.GetPointData().GetGlobalIds()
    return Pentatopes(_points_of_space_time(grid), cells, vtk_to_numpy(grid.GetCellData().GetArray("Label")),
                      _space(grid), planes=vtk_to_numpy(planes).tolist() if planes else [],
                      times=vtk_to_numpy(times).tolist() if times else [], slabs=slabs and vtk_to_numpy(slabs),
                      pairs=pairs and vtk_to_numpy(pairs), numbers=numbers and vtk_to_numpy(numbers))


def read_boundary(path):
    grid = read_data(path)
    _require_type(grid, 10)
    cells = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 4)
    return Boundary(_points_of_space_time(grid), cells, vtk_to_numpy(grid.GetCellData().GetArray("Labels")),
                    vtk_to_numpy(grid.GetPointData().GetArray("PointIds")), _space(grid),
                    vtk_to_numpy(grid.GetCellData().GetArray("Side")),
                    vtk_to_numpy(grid.GetCellData().GetArray("NormalVelocity")),
                    vtk_to_numpy(grid.GetPointData().GetArray("BoundaryVelocity")),
                    vtk_to_numpy(grid.GetCellData().GetArray("Surface")), _surface_names(grid))


def _surface_names(grid):
    numbers = vtk_to_numpy(grid.GetFieldData().GetArray("SurfaceNumbers"))
    names = texts_of(grid, "SurfaceNames")
    if len(numbers) != len(names) or (np.diff(numbers) <= 0).any():
        raise AssertionError("numbers and names of surfaces")
    return dict(zip(numbers.tolist(), names))


def read_slice(path):
    grid = read_data(path)
    _require_type(grid, 10)
    cells = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 4)
    labels = grid.GetCellData().GetArray("Label")
    points = _points(grid) if grid.GetNumberOfPoints() else np.zeros((0, 3))
    velocities = grid.GetPointData().GetArray("BoundaryVelocity")
    return Slice(points, cells, vtk_to_numpy(labels) if labels else np.zeros(0, dtype=int),
                 grid.GetFieldData().GetArray("TimeValue").GetValue(0), _space(grid),
                 vtk_to_numpy(velocities) if velocities else np.zeros((0, 3)))


def read_collection(path):
    """(time, file) of each entry."""
    root = ElementTree.parse(str(path)).getroot()
    if (root.tag, root.get("type")) != ("VTKFile", "Collection"):
        raise AssertionError("head of the collection")
    return [(float(entry.get("timestep")), entry.get("file")) for entry in root.find("Collection")]


def read_slices(path):
    """(time, slice) of each entry of a collection."""
    return [(time, read_slice(Path(path).parent / file)) for time, file in read_collection(path)]


def _pairs_of_comments(lines, start="#"):
    """Number: pair of labels, from the comments at the head."""
    pattern = re.compile(re.escape(start) + r"   (\d+): (\d+) (\d+)( .*)?$")
    found = (pattern.match(line) for line in lines)
    return {int(match[1]): (int(match[2]), int(match[3])) for match in found if match}


def _sides_of_comments(lines):
    """Number: side in time, from the comments at the head; and the times of planes."""
    found = (re.match(r"#   (\d+): \d+ \d+ ?(.*)$", line) for line in lines)
    planes = [match for match in (re.match(r"#   plane (\d+) at (.*)$", line) for line in lines) if match]
    if [int(match[1]) for match in planes] != list(range(1, len(planes) + 1)):
        raise AssertionError("numbers of planes")
    return {"sides": {int(match[1]): match[2] for match in found if match},
            "planes": [float(match[2]) for match in planes]}


def _read_optional(words, at, sections):
    """Sections that may be missing: their tables of whole numbers, or None; and where they end."""
    tables = {}
    for name, width in sections:
        tables[name] = None
        if at < len(words) and words[at] == name:
            found, at = _read_sections(words, at, ((name, width),))
            tables[name] = found[name].astype(int)
    return tables, at


def _names_of_comments(lines, start="#"):
    """Label: name, and pair of labels: name, from the comments at the head."""
    labels, pairs = {}, {}
    for line in lines:
        if match := re.match(re.escape(start) + r"   \d+: (\d+) (\d+) (.*)$", line):
            pairs[int(match[1]), int(match[2])] = match[3]
        elif match := re.match(re.escape(start) + r"   (\d+): (.*)$", line):
            labels[int(match[1])] = match[2]
    return labels, pairs


def _read_sections(words, at, sections):
    """Each a name, a count and as many rows; the result has all of them, and where they end."""
    tables = {}
    for name, width in sections:
        if words[at] != name:
            raise AssertionError("section %s" % name)
        count = int(words[at + 1])
        at += 2
        tables[name] = np.array(words[at:at + count * width], dtype=float).reshape(count, width)
        at += count * width
    return tables, at


def _read_gmf(path):
    with open(path) as file:
        lines = file.read().split("\n")
    words = " ".join(line for line in lines if not line.startswith("#")).split()
    if words[:4] != ["MeshVersionFormatted", "2", "Dimension", "4"] or words[-1] != "End":
        raise AssertionError("head or end of the file")
    tables, at = _read_sections(words, 4, (("Vertices", 5), ("Tetrahedra", 5), ("Pentatopes", 6)))
    more, at = _read_optional(words, at, (("PeriodicVertices", 2), ("PrivateTable", 1)))
    if at != len(words) - 1:
        raise AssertionError("something before End")
    numbers = tables["Vertices"][:, 4].astype(int)
    tetrahedra, pentatopes = tables["Tetrahedra"].astype(int), tables["Pentatopes"].astype(int)
    space = next(line.split("SPACE=")[1][:3] for line in lines if "SPACE=" in line)
    return Pentatopes(tables["Vertices"][:, :4], pentatopes[:, :5] - 1, pentatopes[:, 5], space,
                      tetrahedra[:, :4] - 1, tetrahedra[:, 4], _pairs_of_comments(lines), **_sides_of_comments(lines),
                      slabs=None if more["PrivateTable"] is None else more["PrivateTable"][:, 0],
                      pairs=None if more["PeriodicVertices"] is None else more["PeriodicVertices"] - 1,
                      numbers=numbers - 1 if numbers.any() else None)


def _read_space_time_mfem(path):
    with open(path) as file:
        lines = file.read().split("\n")
    if lines[0] != "MFEM mesh v1.0":
        raise AssertionError("head of the file")
    words = " ".join(line for line in lines[1:] if not line.startswith("#")).split()
    if words[:2] != ["dimension", "4"]:
        raise AssertionError("dimension")
    tables, at = _read_sections(words, 2, (("elements", 7), ("boundary", 6)))
    elements, boundary = tables["elements"].astype(int), tables["boundary"].astype(int)
    if (elements[:, 1] != 8).any() or (boundary[:, 1] != 4).any():
        raise AssertionError("geometries")
    if words[at] != "vertices" or words[at + 2] != "4":
        raise AssertionError("vertices")
    count = int(words[at + 1])
    end = at + 3 + 4 * count  # where MFEM's reader of version 1.0 stops
    vertices = np.array(words[at + 3:end], dtype=float).reshape(count, 4)
    more, at = _read_optional(words, end, (("slabs", 1), ("periodic_pairs", 2), ("global_vertices", 1)))
    if at != len(words):
        raise AssertionError("end of the file")
    space = next(line.split("SPACE=")[1][:3] for line in lines if "SPACE=" in line)
    return Pentatopes(vertices, elements[:, 2:], elements[:, 0], space, boundary[:, 2:], boundary[:, 0],
                      _pairs_of_comments(lines), **_sides_of_comments(lines),
                      slabs=None if more["slabs"] is None else more["slabs"][:, 0], pairs=more["periodic_pairs"],
                      numbers=None if more["global_vertices"] is None else more["global_vertices"][:, 0])


def _read_attribute_sets(words, at, name):
    """The only attribute of each set: its name; where the section ends."""
    if words[at] != name:
        raise AssertionError(words[at])
    count, at = int(words[at + 1]), at + 2
    sets = {}
    for _ in range(count):
        quoted, size, attribute = words[at:at + 3]
        if size != "1" or not re.fullmatch('".*"', quoted):
            raise AssertionError(quoted)
        sets[int(attribute)] = quoted[1:-1]
        at += 3
    return sets, at


def _read_mfem(path):
    """Version 1.3, as mfem::Mesh::ReadMFEMMesh() reads it."""
    with open(path) as file:
        lines = file.read().split("\n")
    if lines[0] != "MFEM mesh v1.3":
        raise AssertionError("head of the file")
    text = "\n".join(line for line in lines[1:] if not line.startswith("#"))
    words = re.findall(r'"[^"\n]*"|\S+', text)
    if words[:2] != ["dimension", "3"] or words[-1] != "mfem_mesh_end":
        raise AssertionError("dimension or end")
    tables, at = _read_sections(words, 2, (("elements", 6),))
    labels, at = _read_attribute_sets(words, at, "attribute_sets")
    boundaries, at = _read_sections(words, at, (("boundary", 5),))
    pairs, at = _read_attribute_sets(words, at, "bdr_attribute_sets")
    elements, boundary = tables["elements"].astype(int), boundaries["boundary"].astype(int)
    if (elements[:, 1] != 4).any() or (boundary[:, 1] != 2).any():
        raise AssertionError("geometries")
    if words[at] != "vertices" or words[at + 2] != "3":
        raise AssertionError("vertices")
    vertices = np.array(words[at + 3:-1], dtype=float).reshape(int(words[at + 1]), 3)
    space = next(line.split("SPACE=")[1][:3] for line in lines if "SPACE=" in line)
    numbers = _pairs_of_comments(lines)
    return Tetrahedra(vertices, elements[:, 2:], elements[:, 0], space, boundary[:, 2:], boundary[:, 0],
                      {numbers[number]: name for number, name in pairs.items()}, labels)


def _from_grid(grid):
    _require_type(grid, 10)
    cells = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 4)
    labels = vtk_to_numpy(grid.GetCellData().GetArray("Label"))
    return Tetrahedra(_points(grid), cells, labels, _space(grid))


def _read_medit(path):
    with open(path) as file:
        lines = file.read().split("\n")
    space = next(line.split("SPACE=")[1] for line in lines if "SPACE=" in line)
    label_names, names = _names_of_comments(lines)
    words = " ".join(line for line in lines if not line.startswith("#")).split()
    if words[:4] != ["MeshVersionFormatted", "2", "Dimension", "3"] or words[-1] != "End":
        raise AssertionError("head or end of the file")
    sections, at = _read_sections(words, 4, (("Vertices", 4), ("Triangles", 4), ("Tetrahedra", 5)))
    if at != len(words) - 1:
        raise AssertionError("something between the last section and End")
    tetrahedra = sections["Tetrahedra"].astype(int)
    triangles = sections["Triangles"].astype(int)
    return Tetrahedra(sections["Vertices"][:, :3], tetrahedra[:, :4] - 1, tetrahedra[:, 4], space,
                      triangles[:, :3] - 1, triangles[:, 3], names, label_names)


def gmsh_names(path):
    """The names of labels and of pairs of labels. Meshes are read by Gmsh itself."""
    text = Path(path).read_text()
    pairs = _pairs_of_comments(text.split("\n"), "")
    found = re.findall(r'^([23]) (\d+) "([^"]*)"$', text, re.MULTILINE)
    return ({int(tag): name for dimension, tag, name in found if dimension == "3"},
            {pairs[int(tag)]: name for dimension, tag, name in found if dimension == "2"})


# Nodes of the faces of C3D4, in the order in which their normals point outwards.
_C3D4_FACES = {"S1": (0, 2, 1), "S2": (0, 1, 3), "S3": (1, 2, 3), "S4": (2, 0, 3)}


def _read_abaqus(path):
    with open(path) as file:
        lines = file.read().split("\n")
    names_of_labels, names_of_pairs = _names_of_comments(lines, "**")
    # The set's name, without the name of the label behind it.
    label_of_set = {name.split(" ")[0]: label for label, name in names_of_labels.items()}
    nodes, elements, labels, sets, faces = {}, {}, {}, {}, {}
    keyword, space = "", ""
    for line in lines:
        if line.startswith("**") or not line:
            continue
        if line.startswith("*"):
            keyword = line
            continue
        words = [word.strip() for word in line.split(",")]
        if keyword == "*HEADING":
            space = line.split("SPACE=")[1]
        elif keyword == "*NODE":
            nodes[int(words[0])] = [float(word) for word in words[1:]]
        elif keyword.startswith("*ELEMENT, TYPE=C3D4, ELSET="):
            elements[int(words[0])] = [int(word) for word in words[1:]]
            labels[int(words[0])] = label_of_set[keyword[27:]]
        elif keyword.startswith("*NSET, NSET="):
            if len(words) > 16:
                raise AssertionError("more than 16 numbers on a line")
            sets.setdefault(keyword[12:], []).extend(int(word) for word in words)
        elif keyword.startswith("*SURFACE, TYPE=ELEMENT, NAME="):
            faces.setdefault(keyword[29:], []).append((int(words[0]), words[1]))
        else:
            raise AssertionError(keyword)
    if sorted(nodes) != list(range(1, len(nodes) + 1)) or sorted(elements) != list(range(1, len(elements) + 1)):
        raise AssertionError("numbering")
    surfaces = {name: np.array([[elements[e][k] - 1 for k in _C3D4_FACES[side]] for e, side in members])
                for name, members in faces.items()}
    order = sorted(elements)
    return Tetrahedra(np.array([nodes[n] for n in sorted(nodes)]), np.array([elements[e] for e in order]) - 1,
                      np.array([labels[e] for e in order]), space, names=names_of_pairs,
                      label_names={label: name for name, label in label_of_set.items()}, node_sets=sets,
                      surfaces=surfaces,
                      surface_labels={name: {labels[e] for e, side in members} for name, members in faces.items()})


def read_triangles(path):
    path = str(path)
    if path.endswith(".vtp"):
        return _from_polydata(read_data(path))
    if path.endswith(".vtk"):
        return _from_polydata(_read(vtkPolyDataReader(), path))
    if path.endswith(".ply"):
        return _read_ply(path)
    if path.endswith(".stl"):
        with open(path, "rb") as file:
            header = file.read(80)
        return _from_polydata(_read(vtkSTLReader(), path), header.split(b"SPACE=")[1][:3].decode())
    raise ValueError(path)


def _read_ply(path):
    """VTK's reader knows the triangles, not the labels."""
    with open(path, "rb") as file:
        head, body = file.read().split(b"end_header\n", 1)
    head = head.decode()
    surface = _from_polydata(_read(vtkPLYReader(), path), head.split("SPACE=")[1][:3])
    faces = np.frombuffer(body[12 * len(surface.points):],
                          dtype=[("size", "u1"), ("vertices", "<i4", 3), ("labels", "<i4", 2)])
    np.testing.assert_array_equal(faces["vertices"], surface.cells)
    surface.labels = faces["labels"]
    return surface


def _from_polydata(data, space=None):
    cells = vtk_to_numpy(data.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    labels = data.GetCellData().GetArray("Labels")
    point_ids = data.GetPointData().GetArray("PointIds")
    return Triangles(_points(data), cells, vtk_to_numpy(labels) if labels else None,
                     vtk_to_numpy(point_ids) if point_ids else None, space or _space(data))
