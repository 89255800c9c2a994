#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Heat in a ball that moves, on pentatopes: how errors fall with the sampling distance.

    heat_in_moving_ball.py --output FOLDER [--delta LENGTH ...]

A label image of 9 frames shows a ball of radius 8 mm that moves by 8 mm in a second. In it the heat equation
du/dt = K (d2u/dx2 + d2u/dy2 + d2u/dz2) holds, with the solution

    u = exp(-3 K k^2 t) cos(k x) cos(k y) cos(k z).

Its values are given at the first time and on the moving boundary. The finite elements find the rest: the standard
Galerkin method, with the same linear functions for u and for testing (Steinbach 2015). The last time needs no condition.

Writes FOLDER/heat.pvd, the solution of the finest mesh at 21 times, and FOLDER/heat-convergence.png.
"""

import argparse
import math
import os

import numpy

import space_time_fem as fem
import voxplex

FRAMES = 9
CONDUCTIVITY = 10.0  # K, mm^2/s
WAVE_NUMBER = math.pi / 20.0  # k, 1/mm


def phantom():
    """34 x 26 x 26 voxels of 1 mm."""
    z, y, x = numpy.meshgrid(numpy.arange(26) - 12.5, numpy.arange(26) - 12.5, numpy.arange(34) - 12.5, indexing="ij")
    frames = [(x - 8.0 * n / (FRAMES - 1)) ** 2 + y * y + z * z < 64.0 for n in range(FRAMES)]
    return voxplex.Image(numpy.stack(frames), origin=(-12.5, -12.5, -12.5), times=numpy.linspace(0.0, 1.0, FRAMES))


def exact(points):
    decay = numpy.exp(-3.0 * CONDUCTIVITY * WAVE_NUMBER**2 * points[..., 3])
    return decay * numpy.cos(WAVE_NUMBER * points[..., :3]).prod(axis=-1)


def exact_gradient(points):
    """In space."""
    cosines, sines = numpy.cos(WAVE_NUMBER * points[..., :3]), numpy.sin(WAVE_NUMBER * points[..., :3])
    decay = numpy.exp(-3.0 * CONDUCTIVITY * WAVE_NUMBER**2 * points[..., 3])
    parts = [sines[..., a] * cosines[..., (a + 1) % 3] * cosines[..., (a + 2) % 3] for a in range(3)]
    return -WAVE_NUMBER * decay[..., None] * numpy.stack(parts, axis=-1)


def make_mesh(delta):
    # A second counts as 16 mm. `size`: inside as well, an upper bound on circumradii.
    mesh = voxplex.mesh(phantom(), delta, time_scale=16.0, size=delta)
    return mesh, fem.SpaceTimeMesh(mesh, 1)


def solve(mesh):
    space, time = mesh.gradients[:, :, :3], mesh.gradients[:, :, 3]
    # Integrals of (du/dt) v and of K grad u . grad v. A linear function's mean over a pentatope is a fifth of its sum.
    blocks = numpy.repeat(time[:, None, :] / 5.0, 5, axis=1) + CONDUCTIVITY * space @ space.transpose(0, 2, 1)
    matrix = mesh.assemble(mesh.volumes[:, None, None] * blocks)
    known = mesh.points_of(mesh.sides != fem.FINAL)
    return fem.solve(matrix, numpy.zeros(len(mesh.points)), known, exact(mesh.points))


def errors(mesh, values):
    """Relative errors of u and of its gradient in space, in the norm of L2."""
    points, weights = fem.quadrature()
    gradient = mesh.gradient(values)[:, :3]
    sums = numpy.zeros(4)
    for point, weight in zip(points, weights):
        where = numpy.tensordot(mesh.points[mesh.pentatopes], point, axes=(1, 0))
        u, du = exact(where), exact_gradient(where)
        shares = ((values[mesh.pentatopes] @ point - u) ** 2, u**2, ((gradient - du) ** 2).sum(axis=1), (du**2).sum(axis=1))
        sums += [weight * (share @ mesh.volumes) for share in shares]
    return math.sqrt(sums[0] / sums[1]), math.sqrt(sums[2] / sums[3])


def draw(rows, path):
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    deltas, _, values, gradients = numpy.array(rows).T
    figure, axes = pyplot.subplots(figsize=(5.0, 3.6))
    axes.loglog(deltas, values, "o-", label="u")
    axes.loglog(deltas, gradients, "s-", label="gradient of u")
    axes.loglog(deltas, 0.7 * values[-1] * (deltas / deltas[-1]) ** 2, "k--", linewidth=0.8, label="order 2")
    axes.loglog(deltas, 0.7 * gradients[-1] * deltas / deltas[-1], "k:", linewidth=0.8, label="order 1")
    axes.set_xlabel("sampling distance, mm")
    axes.set_ylabel("relative error in L2")
    axes.set_xticks(deltas, ["%g" % delta for delta in deltas])
    axes.minorticks_off()
    axes.legend()
    figure.tight_layout()
    figure.savefig(path, dpi=120)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--output", required=True)
    parser.add_argument("--delta", type=float, nargs="+", default=[2.8, 2.0, 1.4])
    arguments = parser.parse_args()
    os.makedirs(arguments.output, exist_ok=True)

    rows = []
    print("delta  pentatopes  points    error of u  of its gradient")
    for delta in sorted(arguments.delta, reverse=True):
        whole, mesh = make_mesh(delta)
        values = solve(mesh)
        rows.append((delta, len(mesh.points), *errors(mesh, values)))
        print("%5.2f  %10d  %6d  %10.5f  %10.5f" % (delta, len(mesh.pentatopes), *rows[-1][1:]), flush=True)
    fem.write_slices(whole, mesh, "u", values, arguments.output, "heat", 21)
    if len(rows) > 1:
        steps = numpy.log([row[0] for row in rows])
        orders = [numpy.polyfit(steps, numpy.log([row[k] for row in rows]), 1)[0] for k in (2, 3)]
        print("order of convergence: %.2f of u, %.2f of its gradient" % tuple(orders))
        draw(rows, os.path.join(arguments.output, "heat-convergence.png"))


if __name__ == "__main__":
    main()
