#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""kill -9 at every step of vtkSimplexMeshWriter leaves the old file, the whole new one, or none.

The steps are those of Testing/KillSwitch, whose library LD_PRELOAD names.
"""
import ctypes
import os
import signal
import unittest

from vtkmodules.vtkCommonCore import vtkIdTypeArray, vtkIntArray, vtkPoints
from vtkmodules.vtkCommonDataModel import VTK_TETRA, vtkCellArray, vtkPolyData, vtkUnstructuredGrid

import voxplex
from iotesting import FolderTestCase

KILL_SWITCH = ctypes.CDLL(os.environ["LD_PRELOAD"])


def array_of(kind, name, components, values):
    array = kind()
    array.SetName(name)
    array.SetNumberOfComponents(components)
    for value in values:
        array.InsertNextValue(value)
    return array


def tetrahedron():
    """One, and its four sides."""
    points = vtkPoints()
    for point in ((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)):
        points.InsertNextPoint(point)
    mesh = vtkUnstructuredGrid()
    mesh.SetPoints(points)
    mesh.InsertNextCell(VTK_TETRA, 4, range(4))
    mesh.GetCellData().AddArray(array_of(vtkIntArray, "Label", 1, [1]))
    sides = vtkCellArray()
    for side in ((0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)):
        sides.InsertNextCell(3, side)
    interfaces = vtkPolyData()
    interfaces.SetPoints(points)
    interfaces.SetPolys(sides)
    interfaces.GetCellData().AddArray(array_of(vtkIntArray, "Labels", 2, [1, 0] * 4))
    interfaces.GetPointData().AddArray(array_of(vtkIdTypeArray, "PointIds", 1, range(4)))
    return mesh, interfaces


class KilledWriter(FolderTestCase):
    def write(self, name):
        writer = voxplex.vtkSimplexMeshWriter()
        for port, data in enumerate(tetrahedron()):  # new ones: VTK keeps ranges with arrays, and writes them
            writer.SetInputData(port, data)
        writer.SetContent(writer.CONTENT_MESH if name.startswith("m") else writer.CONTENT_INTERFACES)
        writer.SetFileName(self.folder / name)
        return writer.Write()

    def killed(self, name, step):
        """Writes in a process of its own; whether it was killed."""
        child = os.fork()
        if child == 0:
            KILL_SWITCH.VoxplexKillAt(ctypes.c_long(step))
            os._exit(0 if self.write(name) else 1)
        status = os.waitpid(child, 0)[1]
        self.assertIn(status, (0, signal.SIGKILL))
        return status != 0

    def contents(self, names):
        return [(self.folder / name).read_bytes() if (self.folder / name).exists() else None for name in names]

    def check(self, name, *companion):
        names = [name, *companion]
        self.assertEqual(self.write(name), 1)
        new = self.contents(names)
        old = [b"old"] * len(names)
        found = []
        step = 1
        while True:
            for path in self.folder.iterdir():
                path.unlink()
            for one in names:
                (self.folder / one).write_bytes(b"old")
            if not self.killed(name, step):
                break
            found.append(self.contents(names))
            self.assertIn(found[-1], (old, new) if not companion else (old, new, [None, b"old"], [None, new[1]]))
            step += 1
        self.assertEqual(self.contents(names), new)
        self.assertIn(old, found)
        self.assertGreaterEqual(step, 4 * len(names))  # opening, writing, closing, renaming

    def test_all_formats(self):
        for name in ("m.vtu", "m.vtk", "m.mesh", "m.mfem", "m.msh", "m.inp", "m.feb", "i.vtp", "i.vtk", "i.stl", "i.ply"):
            with self.subTest(name):
                self.check(name)

    def test_two_files(self):
        self.check("m.xdmf", "m.h5")


if __name__ == "__main__":
    unittest.main()
