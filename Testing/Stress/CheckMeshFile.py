#!/usr/bin/python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Checks a file with tetrahedra against its label image, with VTK's readers and NumPy and nothing of Voxplex.

usage: CheckMeshFile.py IMAGE MESH.vtu
"""
import gzip
import sys

import numpy as np
from scipy import ndimage
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkLogger
from vtkmodules.vtkIOImage import vtkNIFTIImageReader
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_ERROR)  # of NIfTI files with two matrices

# What the program promises with its default flags: see Documentation/Reference.md.
LARGEST_RATIO = 2.5
SMALLEST_COMPONENT = 8
# Share of elements that may break a bound of their shape: the optimiser cannot repair all of them.
POOR_SHARE = 1e-4

NRRD_TYPES = {"uchar": "u1", "unsigned char": "u1", "uint8": "u1", "short": "i2", "int16": "i2", "ushort": "u2",
              "unsigned short": "u2", "uint16": "u2", "int": "i4", "int32": "i4", "float": "f4", "double": "f8"}


def read_nrrd(path):
    """Voxels (z, y, x), and a matrix from (i, j, k, 1) to a point."""
    with open(path, "rb") as file:
        header, data = file.read().split(b"\n\n", 1)
    fields = {}
    for line in header.decode("latin-1").splitlines()[1:]:
        if ": " in line and not line.startswith("#"):
            key, value = line.split(": ", 1)
            fields[key] = value.strip()
    if fields["encoding"] in ("gzip", "gz"):
        data = gzip.decompress(data)
    shape = [int(n) for n in fields["sizes"].split()][::-1]
    order = ">" if fields.get("endian") == "big" else "<"
    voxels = np.frombuffer(data, order + NRRD_TYPES[fields["type"]], int(np.prod(shape))).reshape(shape)
    matrix = np.eye(4)
    for axis, text in enumerate(fields["space directions"].replace(" ", "").strip("()").split(")(")):
        matrix[:3, axis] = [float(x) for x in text.split(",")]
    matrix[:3, 3] = [float(x) for x in fields["space origin"].strip("()").split(",")]
    if fields["space"].startswith("right-anterior"):
        matrix[:2] *= -1
    return voxels, matrix


def read_nifti(path):
    """The same. VTK's reader turns no axes; its matrices are of RAS space. The sform counts if there is one."""
    reader = vtkNIFTIImageReader()
    reader.SetFileName(str(path))
    reader.Update()
    image = reader.GetOutput()
    voxels = vtk_to_numpy(image.GetPointData().GetScalars()).reshape(image.GetDimensions()[::-1])
    header = reader.GetNIFTIHeader()
    form = reader.GetSFormMatrix() if header.GetSFormCode() > 0 else reader.GetQFormMatrix()
    matrix = np.array([[form.GetElement(r, c) for c in range(4)] for r in range(4)])
    matrix[:, :3] = matrix[:, :3] @ np.diag(image.GetSpacing())
    matrix[:2] *= -1
    return voxels, matrix


class Image:
    """A label image and its connected components."""

    def __init__(self, path):
        voxels, self.matrix = (read_nrrd if str(path).endswith("nrrd") else read_nifti)(path)
        self.voxels = np.ascontiguousarray(np.rint(voxels).astype(np.int64))
        self.components, self.sizes, self.labels = self._find_components()

    def voxel_volume(self):
        return abs(np.linalg.det(self.matrix[:3, :3]))

    def interface_faces(self):
        """Number of voxel faces between different labels."""
        padded = np.pad(self.voxels, 1)
        return sum(int(np.count_nonzero(np.diff(padded, axis=axis))) for axis in range(3))

    def to_index(self, points):
        """Continuous (i, j, k)."""
        return (points - self.matrix[:3, 3]) @ np.linalg.inv(self.matrix[:3, :3]).T

    def _find_components(self):
        numbers = np.zeros(self.voxels.shape, dtype=np.int32)
        sizes, labels = [0], [0]
        boxes = ndimage.find_objects(self.voxels)
        for label, box in enumerate(boxes, start=1):
            if box is None:
                continue
            found, count = ndimage.label(self.voxels[box] == label)
            numbers[box][found > 0] = found[found > 0] + len(sizes) - 1
            sizes += np.bincount(found.ravel())[1:].tolist()
            labels += [label] * count
        return numbers, np.array(sizes), np.array(labels)


def read_mesh(path):
    """Points, tetrahedra, labels."""
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    grid = reader.GetOutput()
    points = vtk_to_numpy(grid.GetPoints().GetData()).astype(np.float64)
    cells = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 4).astype(np.int64)
    labels = vtk_to_numpy(grid.GetCellData().GetArray("Label")).astype(np.int64)
    return points, cells, labels


def lengths(vectors):
    return np.sqrt(np.einsum("...i,...i", vectors, vectors))


def shapes(corners):
    """Volumes, radius-edge ratios, smallest dihedral angles."""
    a, b, c = (corners[:, i] - corners[:, 0] for i in (1, 2, 3))
    volume = np.einsum("ij,ij->i", a, np.cross(b, c)) / 6.0
    squares = [np.einsum("ij,ij->i", v, v)[:, None] for v in (a, b, c)]
    centre = squares[0] * np.cross(b, c) + squares[1] * np.cross(c, a) + squares[2] * np.cross(a, b)
    with np.errstate(divide="ignore", invalid="ignore"):
        radius = lengths(centre) / np.abs(12.0 * volume)
    pairs = [(i, j) for i in range(4) for j in range(i)]
    shortest = np.min([lengths(corners[:, i] - corners[:, j]) for i, j in pairs], axis=0)
    smallest = np.full(len(corners), 180.0)
    for i, j in pairs:
        k, l = [v for v in range(4) if v not in (i, j)]
        edge = corners[:, l] - corners[:, k]
        n = np.cross(edge, corners[:, i] - corners[:, k])
        m = np.cross(edge, corners[:, j] - corners[:, k])
        angle = np.degrees(np.arctan2(lengths(np.cross(n, m)), np.einsum("ij,ij->i", n, m)))
        smallest = np.minimum(smallest, np.minimum(angle, 180.0 - angle))
    return volume, radius / shortest, smallest


def facets_of(cells):
    """Sorted facets of all cells, the cell of each, and where runs of equal facets begin."""
    facets = np.concatenate([np.delete(cells, i, axis=1) for i in range(4)])
    facets.sort(axis=1)
    owner = np.tile(np.arange(len(cells)), 4)
    order = np.lexsort(facets.T[::-1])
    facets, owner = facets[order], owner[order]
    starts = np.flatnonzero(np.concatenate([[True], np.any(np.diff(facets, axis=0) != 0, axis=1)]))
    return facets, owner, starts


def non_manifold_edges(facets, pairs):
    """Edges at which not exactly two facets of a label's boundary meet, once for each label."""
    edges = np.concatenate([facets[:, [0, 1]], facets[:, [1, 2]], facets[:, [0, 2]]])
    pairs = np.concatenate([pairs, pairs, pairs])
    rows = np.concatenate([np.column_stack([edges, pairs[:, side]]) for side in (0, 1)])
    rows = rows[rows[:, 2] != 0]
    if len(rows) == 0:
        return 0
    _, counts = np.unique(rows, axis=0, return_counts=True)
    return int(np.count_nonzero(counts != 2))


def lost_components(image, centroids, labels):
    """Components with enough voxels, but without an element of their label whose centroid is within a voxel."""
    index = np.rint(image.to_index(centroids)).astype(np.int64)
    shape = np.array(image.voxels.shape[::-1])
    found = np.zeros(len(image.sizes), dtype=bool)
    for step in np.ndindex(3, 3, 3):
        at = index + np.array(step) - 1
        inside = np.all((at >= 0) & (at < shape), axis=1)
        component = image.components[at[inside, 2], at[inside, 1], at[inside, 0]]
        found[component[image.labels[component] == labels[inside]]] = True
    return np.flatnonzero(~found & (image.sizes >= SMALLEST_COMPONENT))


def check(image, path):
    """@return (figures, a list of what is wrong)"""
    points, cells, labels = read_mesh(path)
    faults = []
    corners = points[cells]
    volume, ratio, dihedral = shapes(corners)
    facets, owner, starts = facets_of(cells)
    ends = np.append(starts[1:], len(facets))
    count = ends - starts
    second = np.where(count > 1, labels[owner[np.minimum(starts + 1, len(owner) - 1)]], 0)
    pairs = np.column_stack([labels[owner[starts]], second])
    between = pairs[:, 0] != pairs[:, 1]
    lost = lost_components(image, corners.mean(axis=1), labels)
    figures = {
        "elements": len(cells),
        "non_manifold": non_manifold_edges(facets[starts][between], pairs[between]),
        "lost": len(lost),
        "worst_ratio": float(ratio.max(initial=0.0)),
        "smallest_dihedral": float(dihedral.min(initial=180.0)),
    }
    if not np.all(np.isfinite(points)):
        faults.append("points that are not finite")
    if len(np.unique(cells)) != len(points):
        faults.append("points without a cell")
    # Coordinates may be written as 32-bit numbers.
    if np.any(volume <= 0.0):
        faults.append(f"{np.count_nonzero(volume <= 0.0)} cells that are not positive")
    if np.any(count > 2):
        faults.append(f"{np.count_nonzero(count > 2)} facets of more than two cells")
    if not np.all(np.isin(labels, image.voxels)) or np.any(labels == 0):
        faults.append("labels that the image has not")
    if np.count_nonzero(ratio > LARGEST_RATIO * (1 + 1e-5)) > POOR_SHARE * len(cells) + 2:
        faults.append(f"{np.count_nonzero(ratio > LARGEST_RATIO)} cells with ratios above {LARGEST_RATIO}")
    if figures["non_manifold"] > 0:
        faults.append(f"non-manifold: {figures['non_manifold']} edges")
    if len(lost) > 0:
        faults.append(f"{len(lost)} components lost")
    return figures, faults


if __name__ == "__main__":
    print(*check(Image(sys.argv[1]), sys.argv[2]), sep="\n")
