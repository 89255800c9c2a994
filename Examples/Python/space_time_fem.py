# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Linear finite elements on pentatope meshes, with NumPy and SciPy: what the two examples of solving share.

A function is its values at the points of the mesh. In a pentatope it is linear in x, y, z and t, so its gradient in space
and its derivative in time are constant there. All of space-time is one sparse system.
"""

import itertools
import math
import os

import inspect

import numpy
import scipy.sparse
import scipy.sparse.linalg

LATERAL, INITIAL, FINAL = 0, 1, 2


class SpaceTimeMesh:
    """The pentatopes of one label, and the boundary tetrahedra around them.

    points      (n, 4): x, y, z, t
    pentatopes  (m, 5): ids of points
    gradients   (m, 5, 4): of the five linear functions that are 1 at one vertex and 0 at the others
    volumes     (m,)
    facets      (k, 4): ids of points
    other       (k,): the label on the other side, 0 for none
    sides       (k,): LATERAL, INITIAL or FINAL
    measures    (k,): of a lateral tetrahedron, area times duration; of one at an end, its volume in space
    velocities  (k,): how fast the boundary moves outwards
    """

    def __init__(self, mesh, label):
        cells = mesh.cells[mesh.labels == label]
        self.ids = numpy.unique(cells)  # of the points of `mesh`
        number = numpy.full(len(mesh.points), -1)
        number[self.ids] = numpy.arange(len(self.ids))
        self.points = numpy.column_stack([mesh.points, mesh.times])[self.ids]
        self.pentatopes = number[cells]
        corners = self.points[self.pentatopes]
        edges = corners[:, 1:] - corners[:, :1]
        inverse = numpy.linalg.inv(edges).transpose(0, 2, 1)
        self.gradients = numpy.concatenate([-inverse.sum(axis=1, keepdims=True), inverse], axis=1)
        self.volumes = numpy.abs(numpy.linalg.det(edges)) / 24.0

        boundary = mesh.interfaces
        pairs = boundary.labels
        here = (pairs == label).any(axis=1)
        first = pairs[here, 0] == label
        self.facets = number[boundary.point_ids[boundary.cells[here]]]
        self.other = numpy.where(first, pairs[here, 1], pairs[here, 0])
        self.sides = boundary.cell_data["Side"][here]
        outwards = numpy.where(first, 1.0, -1.0)
        self.velocities = outwards * boundary.cell_data["NormalVelocity"][here]
        normals = normals_of(self.points[self.facets])
        self.measures = numpy.where(self.sides == LATERAL, numpy.linalg.norm(normals[:, :3], axis=1),
                                    numpy.abs(normals[:, 3]))

    def points_of(self, facets):
        """A mask of the points of some facets."""
        mask = numpy.zeros(len(self.points), dtype=bool)
        mask[self.facets[facets]] = True
        return mask

    def assemble(self, blocks):
        """The sparse matrix of an (m, 5, 5) array: rows are test functions."""
        rows = numpy.repeat(self.pentatopes, 5, axis=1)
        columns = numpy.tile(self.pentatopes, (1, 5))
        n = len(self.points)
        return scipy.sparse.csr_matrix((blocks.ravel(), (rows.ravel(), columns.ravel())), shape=(n, n))

    def assemble_facets(self, facets):
        """The matrix of the integrals of c v over some facets."""
        blocks = self.measures[facets, None, None] * (numpy.ones((4, 4)) + numpy.eye(4)) / 20.0
        rows = numpy.repeat(self.facets[facets], 4, axis=1)
        columns = numpy.tile(self.facets[facets], (1, 4))
        n = len(self.points)
        return scipy.sparse.csr_matrix((blocks.ravel(), (rows.ravel(), columns.ravel())), shape=(n, n))

    def integrate_facets(self, facets, densities):
        """For each test function its integral over some facets, times a density that each facet has."""
        values = numpy.repeat((self.measures[facets] * densities / 4.0)[:, None], 4, axis=1)
        return numpy.bincount(self.facets[facets].ravel(), values.ravel(), minlength=len(self.points))

    def gradient(self, values):
        """The gradient (m, 4) of a function: along x, y, z and t."""
        return numpy.einsum("mi,mik->mk", values[self.pentatopes], self.gradients)


def normals_of(corners):
    """Vectors (k, 4) normal to tetrahedra in space-time; their length is the tetrahedron's three-dimensional volume."""
    edges = corners[:, 1:] - corners[:, :1]
    minors = [numpy.linalg.det(numpy.delete(edges, axis, axis=2)) for axis in range(4)]
    return numpy.column_stack([(-1) ** axis * minor / 6.0 for axis, minor in enumerate(minors)])


def solve(matrix, right_side, known=None, values=None, tolerance=1e-10):
    """Solves a sparse system. Where the mask `known` is set, the solution has `values`."""
    solution = numpy.zeros(len(right_side))
    free = numpy.ones(len(right_side), dtype=bool)
    if known is not None:
        free = ~known
        solution[known] = values[known]
    system = matrix[free][:, free].tocsc()
    load = (right_side - matrix @ solution)[free]
    # Rows get like sizes, so that dropping small entries of the factors is fair to all.
    scale = 1.0 / numpy.abs(system.diagonal())
    system = (scipy.sparse.diags(scale) @ system).tocsc()
    factors = scipy.sparse.linalg.spilu(system, drop_tol=1e-3, fill_factor=8)
    preconditioner = scipy.sparse.linalg.LinearOperator(system.shape, factors.solve)
    relative = "rtol" if "rtol" in inspect.signature(scipy.sparse.linalg.gmres).parameters else "tol"  # before SciPy 1.12
    answer, status = scipy.sparse.linalg.gmres(system, scale * load, M=preconditioner, restart=60, maxiter=40,
                                               atol=0.0, **{relative: tolerance})
    if status != 0:
        raise RuntimeError("GMRES did not converge: a finer mesh may help")
    solution[free] = answer
    return solution


def quadrature():
    """Barycentric points (21, 5) and weights of a rule for a pentatope, exact up to degree 5 (Grundmann and Moeller, 1978)."""
    points, weights = [], []
    n, s = 4, 2
    d = 2 * s + 1
    for i in range(s + 1):
        weight = (-1) ** i * 2.0 ** (-2 * s) * (d + n - 2 * i) ** d / (
            math.factorial(i) * math.factorial(d + n - i)) * math.factorial(n)
        for beta in itertools.product(range(s - i + 1), repeat=n + 1):
            if sum(beta) == s - i:
                points.append([(2 * b + 1) / (d + n - 2 * i) for b in beta])
                weights.append(weight)
    return numpy.array(points), numpy.array(weights)


def write_slices(whole, mesh, name, values, folder, prefix, count):
    """Cuts the pentatopes and their values at `count` times: PREFIX_0.vtu and so on, and PREFIX.pvd, which ParaView plays.

    Points of other labels get 0. Returns the slices and their times.
    """
    field = numpy.zeros(len(whole.points))
    field[mesh.ids] = values
    whole.point_data[name] = field
    slices, entries = [], []
    for index, time in enumerate(numpy.linspace(whole.times.min(), whole.times.max(), count)):
        piece = whole.slice(time)
        slices.append((time, piece))
        file = "%s_%d.vtu" % (prefix, index)
        piece.write(os.path.join(folder, file))
        entries.append(f'<DataSet timestep="{time:.17g}" part="0" file="{file}"/>')
    with open(os.path.join(folder, prefix + ".pvd"), "w", encoding="ascii") as file:
        file.write('<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1"><Collection>\n%s\n'
                   "</Collection></VTKFile>\n" % "\n".join(entries))
    return slices
