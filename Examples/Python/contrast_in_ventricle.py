#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Blood leaves a beating ventricle and returns: advection and diffusion on pentatopes.

    contrast_in_ventricle.py --output FOLDER [--delta LENGTH]

A label image of 15 frames shows a left ventricle that beats once: blood (1) in muscle (2), both cut by a plane at the
base. At first the blood is full of a contrast agent. A part of it leaves through the base. Blood without agent returns.

1. The flow w is the gradient of a potential. The muscle drives it: at the wall the normal velocity of the flow is that of
   the boundary, `NormalVelocity`. At the base the potential is 0.
2. The concentration c satisfies dc/dt + w . grad c = D (d2c/dx2 + d2c/dy2 + d2c/dz2), and is 1 at the first time. In
   space-time a particle follows (w, 1), which is tangential to the wall. So nothing crosses the wall, and it needs no
   condition, although it moves. Streamline upwinding (Brooks and Hughes 1982) stabilizes the advection.

The program checks that nothing crosses the wall, that a concentration of 1 everywhere stays so if the blood that returns
has it too, and that no agent is lost. It then compares the agent that remains with the blood that never left. Linear
elements overshoot a little beside the front between old and new blood.

Writes FOLDER/contrast.pvd, the concentration at 29 times. Points of the muscle have the value 0.
"""

import argparse
import os
import sys

import numpy
import scipy.sparse
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkPlane
from vtkmodules.vtkFiltersCore import vtkCutter, vtkTriangleFilter

import space_time_fem as fem
import voxplex

FRAMES = 15
BEAT = 0.8  # seconds
DIFFUSIVITY = 60.0  # D, mm^2/s; blood mixes in eddies
BLOOD, MUSCLE = 1, 2


def phantom():
    """50 x 50 x 56 voxels of 2 mm."""
    z, y, x = numpy.meshgrid(2.0 * numpy.arange(56) - 92.0, 2.0 * (numpy.arange(50) - 24.5),
                             2.0 * (numpy.arange(50) - 24.5), indexing="ij")
    frames = []
    for frame in range(FRAMES):
        squeeze = numpy.sin(numpy.pi * frame / (FRAMES - 1)) ** 2
        inner, outer, apex = 28.0 - 8.0 * squeeze, 40.0 - 4.0 * squeeze, 80.0 - 6.0 * squeeze
        r2 = x * x + y * y
        labels = numpy.where(r2 / outer**2 + (z / apex) ** 2 < 1.0, MUSCLE, 0)
        labels[r2 / inner**2 + (z / (apex - 11.0)) ** 2 < 1.0] = BLOOD
        labels[z > 9.0] = 0
        frames.append(labels.astype(numpy.uint8))
    return voxplex.Image(numpy.stack(frames), spacing=(2.0, 2.0, 2.0), origin=(-49.0, -49.0, -92.0),
                         times=numpy.linspace(0.0, BEAT, FRAMES))


def make_mesh(delta):
    mesh = voxplex.mesh(phantom(), delta, time_scale=200.0, label_sizes={BLOOD: delta})  # a second counts as 200 mm
    return mesh, fem.SpaceTimeMesh(mesh, BLOOD)


def flow(mesh):
    """The velocity in each pentatope, (m, 3)."""
    space = mesh.gradients[:, :, :3]
    matrix = mesh.assemble(mesh.volumes[:, None, None] * (space @ space.transpose(0, 2, 1)))
    wall = (mesh.sides == fem.LATERAL) & (mesh.other == MUSCLE)
    source = mesh.integrate_facets(wall, mesh.velocities[wall])
    base = mesh.points_of((mesh.sides == fem.LATERAL) & (mesh.other == 0))
    potential = fem.solve(matrix, source, base, numpy.zeros(len(source)))
    return mesh.gradient(potential)[:, :3]


class Transport:
    """The system of the concentration, and how much blood crosses the base."""

    def __init__(self, mesh, velocity):
        self.first = mesh.assemble_facets(mesh.sides == fem.INITIAL)
        self.last = mesh.assemble_facets(mesh.sides == fem.FINAL)
        # Along (w, 1), the path of a particle in space-time.
        ahead = numpy.einsum("mik,mk->mi", mesh.gradients[:, :, :3], velocity) + mesh.gradients[:, :, 3]
        space = mesh.gradients[:, :, :3]
        upwind = 1.0 / numpy.abs(ahead).sum(axis=1)  # half the time in which a particle crosses a pentatope
        blocks = (-numpy.repeat(ahead[:, :, None] / 5.0, 5, axis=2)
                  + DIFFUSIVITY * space @ space.transpose(0, 2, 1)
                  + upwind[:, None, None] * ahead[:, :, None] * ahead[:, None, :])
        inside = mesh.assemble(mesh.volumes[:, None, None] * blocks)
        # What leaves the mesh, for each test function. Nothing crosses the wall, so the rest crosses the base.
        self.outflow = -(inside + self.last - self.first) @ numpy.ones(len(mesh.points))
        base = mesh.points_of((mesh.sides == fem.LATERAL) & (mesh.other == 0))
        self.leak = numpy.abs(self.outflow[~base]).sum() / numpy.abs(self.outflow[base]).sum()
        self.outflow[~base] = 0.0
        self.matrix = inside + self.last + scipy.sparse.diags(self.outflow.clip(min=0.0))

    def solve(self, before, returning):
        """The concentration, from that at the first time and that of blood that returns."""
        right_side = self.first @ before - self.outflow.clip(max=0.0) * returning
        return fem.solve(self.matrix, right_side)

    def amounts(self, before, concentration):
        """Of the agent: at the first time, at the last, and what left through the base."""
        outwards = self.outflow.clip(min=0.0)
        return (self.first @ before).sum(), (self.last @ concentration).sum(), outwards @ concentration


def draw(slices, path):
    """Cuts across y at a few times."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(1, len(slices), figsize=(1.4 * len(slices) + 0.6, 2.3), layout="constrained")
    plane = vtkPlane()
    plane.SetNormal(0.0, 1.0, 0.0)
    plane.SetOrigin(0.0, 0.01, 0.0)
    for axis, (time, piece) in zip(axes, slices):
        cutter = vtkCutter()
        cutter.SetInputData(piece.to_vtk())
        cutter.SetCutFunction(plane)
        triangles = vtkTriangleFilter()
        triangles.SetInputConnection(cutter.GetOutputPort())
        triangles.Update()
        cut = triangles.GetOutput()
        points = vtk_to_numpy(cut.GetPoints().GetData())
        corners = vtk_to_numpy(cut.GetPolys().GetConnectivityArray()).reshape(-1, 3)
        blood = vtk_to_numpy(cut.GetCellData().GetArray("Label")) == BLOOD
        axis.tripcolor(points[:, 0], points[:, 2], corners[~blood], facecolors=numpy.ones(numpy.count_nonzero(~blood)),
                       cmap="Greys", vmin=0.0, vmax=4.0)
        colors = axis.tripcolor(points[:, 0], points[:, 2], corners[blood],
                                vtk_to_numpy(cut.GetPointData().GetArray("Concentration")),
                                shading="gouraud", cmap="viridis", vmin=0.0, vmax=1.0)
        axis.set_title("t = %.2f s" % time, fontsize=9)
        axis.set(xlim=(-42.0, 42.0), ylim=(-84.0, 14.0), aspect="equal")
        axis.axis("off")
    figure.colorbar(colors, ax=axes, label="concentration")
    figure.savefig(path, dpi=120)


def check(name, value, limit):
    print("%s: %.1e" % (name, value))
    if not value < limit:
        sys.exit("it should be less than %g" % limit)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--output", required=True)
    parser.add_argument("--delta", type=float, default=7.0)
    arguments = parser.parse_args()
    os.makedirs(arguments.output, exist_ok=True)

    whole, mesh = make_mesh(arguments.delta)
    print(f"{len(mesh.pentatopes)} pentatopes and {len(mesh.points)} points of blood")
    transport = Transport(mesh, flow(mesh))
    check("share of the flow that crosses the wall", transport.leak, 1e-6)
    ones = numpy.ones(len(mesh.points))
    check("change of a concentration of 1", numpy.abs(transport.solve(ones, 1.0) - 1.0).max(), 1e-6)

    concentration = transport.solve(ones, 0.0)
    before, after, left = transport.amounts(ones, concentration)
    print("agent: %.0f mm^3 at first, %.0f at last, %.0f left" % (before, after, left))
    check("share of the agent that is missing", abs(1.0 - (after + left) / before), 1e-6)
    print("values: 98 of 100 points from %.2f to %.2f, all from %.2f to %.2f" % (
        *numpy.percentile(concentration, [1.0, 99.0]), concentration.min(), concentration.max()))

    slices = fem.write_slices(whole, mesh, "Concentration", concentration, arguments.output, "contrast", 29)
    volumes = [piece.label_volumes()[BLOOD] for _, piece in slices]
    print("agent that remains: %.3f; blood that never left: %.3f" % (after / before, min(volumes) / volumes[0]))
    draw(slices[::4], os.path.join(arguments.output, "contrast.png"))


if __name__ == "__main__":
    main()
