#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""vtkSimplexMeshWriter, behind the reader and the filters: names that arrive in the files, errors, whole files."""
import os
import resource
import signal
import unittest
from xml.etree import ElementTree

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkDoubleArray, vtkIntArray, vtkPoints, vtkStringArray
from vtkmodules.vtkCommonDataModel import VTK_HEXAHEDRON, VTK_QUAD, vtkCellArray, vtkPolyData, vtkUnstructuredGrid
from vtkmodules.vtkIOLegacy import vtkPolyDataReader, vtkUnstructuredGridReader
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLUnstructuredGridReader

import images
import meshfiles
import voxplex
from iotesting import FolderTestCase, table_of

MESH, INTERFACES = voxplex.vtkSimplexMeshWriter.CONTENT_MESH, voxplex.vtkSimplexMeshWriter.CONTENT_INTERFACES
TABLE = "3,Left lung,255,0,51\n7,N\u00e4se,,,\n8,not in the image,1,2,3\n"
EXPECTED = {3: ("Left lung", (255, 0, 51)), 7: ("N\u00e4se", None)}


class WriterTestCase(FolderTestCase):
    def mesher(self, frames=1, table=TABLE):
        """Reader and filter, of a 3D image or of one with several frames; not yet executed."""
        array = images.two_labels(14, 5.0)
        if frames > 1:
            array = np.stack([array] * frames)
        (self.folder / "input").mkdir(exist_ok=True)
        (self.folder / "input" / "table.csv").write_text(table, encoding="utf-8")
        self.source = voxplex.vtkSegmentationReader()
        self.source.SetFileName(images.write_nrrd(self.folder / "input" / "i.nrrd", array))
        self.source.SetLabelTableFileName(self.folder / "input" / "table.csv")
        mesher = voxplex.vtkImageToTetMeshFilter() if frames == 1 else voxplex.vtkImageToPentatopeMeshFilter()
        mesher.SetInputConnection(self.source.GetOutputPort())
        mesher.SetDelta(3)
        mesher.SetNumberOfThreads(1)
        return mesher

    def writer(self, mesher, name, content=MESH):
        writer = voxplex.vtkSimplexMeshWriter()
        writer.SetInputConnection(0, mesher.GetOutputPort(0))
        writer.SetInputConnection(1, mesher.GetOutputPort(1))
        writer.SetContent(content)
        writer.SetFileName(self.folder / name)
        return writer

    def write(self, *arguments):
        writer = self.writer(*arguments)
        self.assertEqual((writer.Write(), writer.GetErrorMessage(), writer.GetErrorCode()), (1, "", 0))

    def with_data(self, name, mesh, interfaces=None):
        writer = voxplex.vtkSimplexMeshWriter()
        writer.SetInputData(0, mesh)
        if interfaces:
            writer.SetInputData(1, interfaces)
        writer.SetFileName(self.folder / name)
        return writer

    def refuse(self, writer, pattern):
        before = self.files()
        self.assertEqual(writer.Write(), 0)
        self.assertRegex(writer.GetErrorMessage(), pattern)
        self.assertNotEqual(writer.GetErrorCode(), 0)
        self.assertEqual(self.files(), before)

    def files(self):
        return {path.name: path.read_bytes() for path in self.folder.iterdir() if path.is_file()}

    def load(self, reader, name):
        reader.SetFileName(str(self.folder / name))
        reader.Update()
        return reader.GetOutput()


class Names(WriterTestCase):
    """Field data passes the filters, and is in VTK's files."""

    def test_tetrahedra(self):
        mesher = self.mesher()
        for name, content, reader in (("m.vtu", MESH, vtkXMLUnstructuredGridReader()),
                                      ("m.vtk", MESH, vtkUnstructuredGridReader()),
                                      ("i.vtp", INTERFACES, vtkXMLPolyDataReader()),
                                      ("i.vtu", INTERFACES, vtkXMLUnstructuredGridReader()),
                                      ("i.vtk", INTERFACES, vtkPolyDataReader())):
            with self.subTest(name):
                self.write(mesher, name, content)
                data = self.load(reader, name)
                self.assertGreater(data.GetNumberOfCells(), 10)
                self.assertEqual(table_of(data), EXPECTED)
                self.assertEqual(meshfiles.texts_of(data, "SPACE"), ["LPS"])
        for port in (0, 1):
            self.assertEqual(table_of(mesher.GetOutputDataObject(port)), EXPECTED)

    def classes_of_texts(self, data):
        fields = data.GetFieldData()
        arrays = [fields.GetAbstractArray(name) for name in ("LabelNames", "SPACE")]
        return ["strings" if array.IsA("vtkStringArray") else "bytes" if array.GetDataTypeSize() == 1 else "others" for array in arrays]

    def test_texts_in_files(self):
        """meshio reads no strings; 3D Slicer takes RAS in .vtu and .vtp from nothing else."""
        strings, octets = "strings", "bytes"
        for space, in_vtu in (("LPS", octets), ("RAS", strings)):
            mesher = self.mesher()
            self.source.SetSpace(getattr(self.source, "SPACE_" + space))
            for name, content, reader, expected in (
                    ("m.vtu", MESH, vtkXMLUnstructuredGridReader(), [octets, in_vtu]),
                    ("m.vtk", MESH, vtkUnstructuredGridReader(), [octets, octets]),
                    ("i.vtp", INTERFACES, vtkXMLPolyDataReader(), [strings, strings]),
                    ("i.vtu", INTERFACES, vtkXMLUnstructuredGridReader(), [octets, in_vtu]),
                    ("i.vtk", INTERFACES, vtkPolyDataReader(), [strings, strings])):
                with self.subTest(name=name, space=space):
                    self.write(mesher, name, content)
                    data = self.load(reader, name)
                    self.assertEqual(self.classes_of_texts(data), expected)
                    self.assertEqual(meshfiles.texts_of(data, "SPACE"), [space])
                    self.assertEqual(table_of(data), EXPECTED)
                    if name.endswith(".vtk"):
                        self.assertIn(b"SPACE=" + space.encode(), self.files()[name].split(b"\n")[1])
            self.assertEqual(self.classes_of_texts(mesher.GetOutput()), [strings, strings])

    def test_files_that_are_read_again(self):
        """Bytes count as the texts that they are, in all formats."""
        mesher = self.mesher()
        self.source.SetSpace(self.source.SPACE_RAS)
        self.write(mesher, "first.vtk")
        mesh = self.load(vtkUnstructuredGridReader(), "first.vtk")
        self.assertEqual(self.with_data("again.vtu", mesh).Write(), 1)
        again = self.load(vtkXMLUnstructuredGridReader(), "again.vtu")
        self.assertEqual(self.classes_of_texts(again), ["bytes", "strings"])
        self.assertEqual((meshfiles.texts_of(again, "SPACE"), table_of(again)), (["RAS"], EXPECTED))
        self.assertEqual(self.with_data("again.feb", again).Write(), 1)
        self.assertIn(b"SPACE=RAS", self.files()["again.feb"])
        self.assertIn(b'name="Left lung"', self.files()["again.feb"])
        surface = vtkPolyData()
        surface.SetPoints(mesh.GetPoints())
        surface.SetFieldData(mesh.GetFieldData())
        writer = self.with_data("surface.vtp", mesh, surface)
        writer.SetContent(INTERFACES)
        self.assertEqual(writer.Write(), 1)
        surface = self.load(vtkXMLPolyDataReader(), "surface.vtp")
        self.assertEqual(self.classes_of_texts(surface), ["strings", "strings"])

    def test_labels_that_are_not_meshed_have_no_names(self):
        mesher = self.mesher()
        mesher.AddLabel(3)
        self.write(mesher, "m.vtu")
        mesh = self.load(vtkXMLUnstructuredGridReader(), "m.vtu")
        self.assertEqual(mesh.GetCellData().GetArray("Label").GetRange(), (3, 3))
        self.assertEqual(table_of(mesh), {3: EXPECTED[3]})

    def test_pentatopes(self):
        mesher = self.mesher(frames=3)
        for name, content in (("m.vtu", MESH), ("b.vtu", INTERFACES)):
            with self.subTest(name):
                self.write(mesher, name, content)
                self.assertEqual(table_of(self.load(vtkXMLUnstructuredGridReader(), name)), EXPECTED)
        slicer = voxplex.vtkPentatopeMeshTimeSlice()
        slicer.SetInputConnection(mesher.GetOutputPort())
        slicer.UpdateTimeStep(0.5)
        self.assertEqual(table_of(slicer.GetOutput()), EXPECTED)
        slicer.SetInputConnection(mesher.GetOutputPort(1))
        slicer.Update()
        self.assertEqual(table_of(slicer.GetOutput()), EXPECTED)

    def test_no_unicode(self):
        """Other programs' field data may hold anything: stray bytes, cut and overlong characters, surrogates."""
        mesher = self.mesher()
        mesher.Update()
        mesh = mesher.GetOutput()
        names = vtkStringArray()
        names.SetName("LabelNames")
        for name in (b"a\xffb\xc3(\xc3", b"\xed\xa0\x80c\xc1\x81d\xf4\x90\x80\x80\xef\xbf\xbfe\xe2\x82\xac"):
            names.InsertNextValue(name)
        values = vtkIntArray()
        values.SetName("LabelValues")
        for label in (3, 7):
            values.InsertNextValue(label)
        mesh.GetFieldData().AddArray(names)
        mesh.GetFieldData().AddArray(values)
        self.assertEqual(self.with_data("m.feb", mesh).Write(), 1)
        root = ElementTree.fromstring(self.files()["m.feb"])
        self.assertEqual([part.get("name") for part in root.iter("Elements")], ["a_b_(", "c_d_e\u20ac"])

    def test_new_table(self):
        """The arrays are replaced when the reader reads again."""
        mesher = self.mesher()
        mesher.Update()
        self.source.SetLabelTableFileName(None)
        mesher.Update()
        self.assertEqual(table_of(mesher.GetOutput()), {})


class Formats(WriterTestCase):
    def test_extensions(self):
        writer = voxplex.vtkSimplexMeshWriter
        for frames, dimension in ((1, 3), (3, 4)):
            mesher = self.mesher(frames)
            for content in (MESH, INTERFACES):
                extensions = writer.ListExtensions(content, dimension).replace(" or ", ", ").split(", ")
                self.assertIn(".vtu" if content == MESH or frames > 1 else ".vtp", extensions)
                for extension in extensions:
                    with self.subTest(content=content, extension=extension):
                        self.assertTrue(writer.HasFormat("a" + extension.upper(), content, dimension))
                        self.assertTrue(writer.HasFormat("a" + extension, content, 0))
                        name = "d%d-c%d%s" % (dimension, content, extension)
                        self.write(mesher, name, content)
                        self.assertGreater((self.folder / name).stat().st_size, 200)
                        self.assertFalse([file for file in self.files() if file.startswith(".")])
        self.assertFalse(writer.HasFormat("a.stl", MESH, 0))
        self.assertFalse(writer.HasFormat("vtu", MESH, 0))
        self.assertFalse(writer.HasFormat("a.feb", MESH, 4))

    def test_interfaces_as_a_grid(self):
        """.vtu has what .vtp has."""
        mesher = self.mesher()
        for name in ("i.vtp", "i.vtu"):
            self.write(mesher, name, INTERFACES)
        surface = self.load(vtkXMLPolyDataReader(), "i.vtp")
        grid = self.load(vtkXMLUnstructuredGridReader(), "i.vtu")
        self.assertEqual({grid.GetCellType(cell) for cell in range(grid.GetNumberOfCells())}, {5})
        for first, second in ((surface.GetPoints().GetData(), grid.GetPoints().GetData()),
                              (surface.GetPolys().GetConnectivityArray(), grid.GetCells().GetConnectivityArray()),
                              (surface.GetPointData().GetArray("PointIds"), grid.GetPointData().GetArray("PointIds")),
                              (surface.GetCellData().GetArray("Labels"), grid.GetCellData().GetArray("Labels"))):
            self.assertEqual(memoryview(first).tobytes(), memoryview(second).tobytes())

    def test_without_interfaces(self):
        """Formats that hold both have no facets then; those of interfaces do without a mesh."""
        mesher = self.mesher()
        for extension in (".msh", ".mesh", ".inp", ".feb", ".mfem", ".xdmf", ".vtu"):
            with self.subTest(extension):
                writer = self.writer(mesher, "m" + extension)
                writer.RemoveAllInputConnections(1)
                self.assertEqual((writer.Write(), writer.GetErrorMessage()), (1, ""))
        writer = self.writer(mesher, "i.ply", INTERFACES)
        writer.RemoveAllInputConnections(0)
        self.assertEqual((writer.Write(), writer.GetErrorMessage()), (1, ""))
        self.write(mesher, "both.ply", INTERFACES)
        self.assertEqual(self.files()["i.ply"], self.files()["both.ply"])

    def test_abaqus_has_short_numbers(self):
        """It and CalculiX read 20 characters, and of `3.479460781363741e-05` would take `3.479460781363741e-0`."""
        mesher = self.mesher()
        mesher.Update()
        mesh = mesher.GetOutput()
        points = vtk_to_numpy(mesh.GetPoints().GetData())
        points *= np.geomspace(1e-12, 1, len(points))[:, np.newaxis] / 3
        self.assertEqual(self.with_data("m.inp", mesh, mesher.GetOutputDataObject(1)).Write(), 1)
        lines = self.files()["m.inp"].decode().split("*NODE\n")[1].split("\n*")[0].split("\n")
        texts = np.array([line.split(", ")[1:] for line in lines])
        self.assertEqual(max(map(len, texts.flat)), 20)
        np.testing.assert_allclose(texts.astype(float), points, rtol=1e-13, atol=0)

    def test_boundary_without_sides(self):
        """One of an older file: all of it counts as lateral."""
        mesher = self.mesher(frames=3)
        mesher.Update()
        mesh, boundary = mesher.GetOutput(), mesher.GetOutputDataObject(1)
        self.assertEqual(self.with_data("sides.mfem", mesh, boundary).Write(), 1)
        self.assertIn(b" final\n", self.files()["sides.mfem"])
        sides = boundary.GetCellData().GetArray("Side")
        sides.SetNumberOfTuples(sides.GetNumberOfTuples() - 1)
        self.refuse(self.with_data("m.mfem", mesh, boundary), "the interfaces have [0-9]+ values 'Side' for")
        boundary.GetCellData().RemoveArray("Side")
        self.assertEqual(self.with_data("old.mfem", mesh, boundary).Write(), 1)
        self.assertNotIn(b" final\n", self.files()["old.mfem"])

    def test_temporary_name_of_the_caller(self):
        writer = self.writer(self.mesher(), "final.vtk")
        writer.SetTemporaryFileName(self.folder / "part")
        self.assertEqual(writer.Write(), 1)
        self.assertEqual(list(self.files()), ["part"])
        self.assertTrue(self.files()["part"].startswith(b"# vtk"))


class Compression(WriterTestCase):
    def test_off(self):
        """Arrays as they are in memory, each behind the number of its bytes."""
        mesher = self.mesher()
        for name, content in (("m.vtu", MESH), ("i.vtp", INTERFACES)):
            writer = self.writer(mesher, name, content)
            self.assertTrue(writer.GetCompress())
            writer.CompressOff()
            self.assertEqual(writer.Write(), 1)
            data = self.files()[name]
            self.assertIn(b'header_type="UInt64">', data[:200])
            self.assertIn(b'<AppendedData encoding="raw">', data)
            points = vtk_to_numpy(writer.GetInputDataObject(content, 0).GetPoints().GetData()).tobytes()
            self.assertIn(len(points).to_bytes(8, "little") + points, data)
            writer.CompressOn()
            self.assertEqual(writer.Write(), 1)
            self.assertIn(b'compressor="vtkZLibDataCompressor"', self.files()[name][:200])
            self.assertLess(len(self.files()[name]), len(data))


class TwoFiles(WriterTestCase):
    """XDMF: text, and numbers in HDF5."""

    def test_names(self):
        writer = voxplex.vtkSimplexMeshWriter
        self.assertEqual(writer.CompanionOf("a folder/m.v2.XDMF"), "a folder/m.v2.h5")
        self.assertEqual(writer.CompanionOf("m.vtu"), "")

    def test_both_appear(self):
        self.write(self.mesher(), "m.xdmf")
        files = self.files()
        self.assertEqual(set(files), {"m.xdmf", "m.h5"})
        self.assertIn(b">m.h5:/mesh/topology<", files["m.xdmf"])
        self.assertTrue(files["m.h5"].startswith(b"\x89HDF"))

    def test_second_in_the_way(self):
        (self.folder / "m.h5").mkdir()
        self.refuse(self.writer(self.mesher(), "m.xdmf"), "cannot write '[^']*m.h5': it is a folder")
        self.assertEqual(self.files(), {})

    def test_temporary_names_of_the_caller(self):
        writer = self.writer(self.mesher(), "final.xdmf")
        writer.SetTemporaryFileName(self.folder / "one")
        self.refuse(writer, "two files.*TemporaryCompanionFileName")
        writer.SetTemporaryCompanionFileName(self.folder / "two")
        self.assertEqual(writer.Write(), 1)
        files = self.files()
        self.assertEqual(set(files), {"one", "two"})
        self.assertIn(b">final.h5:/mesh/topology<", files["one"])


class Errors(WriterTestCase):
    def test_names(self):
        mesher = self.mesher()
        for name, content, pattern in (
            ("m.xyz", MESH, "^cannot write '.*m.xyz': no format '.xyz'.*use .vtu"),
            ("mesh", MESH, "no format ''"),
            ("m.stl", MESH, "no format '.stl'"),
            ("i.msh", INTERFACES, "no format '.msh'"),
            ("none/m.vtu", MESH, "there is no folder '.*none'"),
            ("input/i.nrrd/m.vtu", MESH, "there is no folder"),
        ):
            with self.subTest(name):
                self.refuse(self.writer(mesher, name, content), pattern)
        (self.folder / "m.vtu").mkdir()
        self.refuse(self.writer(mesher, "m.vtu"), "it is a folder")
        os.mkfifo(self.folder / "p.vtu")
        self.refuse(self.writer(mesher, "p.vtu"), "not a regular file")
        writer = self.writer(mesher, "m")
        writer.SetFileName(None)
        self.refuse(writer, "^no file name is set$")

    def test_missing_input(self):
        writer = self.writer(self.mesher(), "m.vtu")
        writer.RemoveAllInputConnections(0)
        self.refuse(writer, "no mesh to write")
        writer = self.writer(self.mesher(), "i.vtp", INTERFACES)
        writer.RemoveAllInputConnections(1)
        self.refuse(writer, "no interfaces to write")

    def test_error_upstream(self):
        mesher = self.mesher()
        self.source.SetFileName(self.folder / "none.nrrd")
        self.refuse(self.writer(mesher, "m.vtu"), "what makes the mesh reports an error")

    def test_other_data(self):
        mesher = self.mesher()
        mesher.Update()
        mesh, interfaces = mesher.GetOutput(), mesher.GetOutputDataObject(1)

        bare = vtkUnstructuredGrid()
        bare.CopyStructure(mesh)
        self.refuse(self.with_data("m.msh", bare), "no array 'Label'")
        self.assertEqual(self.with_data("bare.vtu", bare).Write(), 1)

        for cell, size in ((VTK_HEXAHEDRON, 8), (VTK_QUAD, 4)):
            other = vtkUnstructuredGrid()
            other.SetPoints(mesh.GetPoints())
            other.InsertNextCell(cell, size, range(size))
            label = vtkIntArray()
            label.SetName("Label")
            label.InsertNextValue(1)
            other.GetCellData().AddArray(label)
            self.refuse(self.with_data("m.inp", other), "must be tetrahedra in this format, and cell 0 is none")

        without = interfaces.NewInstance()
        without.ShallowCopy(interfaces)
        without.GetPointData().RemoveArray("PointIds")
        self.refuse(self.with_data("m.mesh", mesh, without), "no array 'PointIds'")
        without.ShallowCopy(interfaces)
        without.GetCellData().RemoveArray("Labels")
        self.refuse(self.with_data("m.mesh", mesh, without), "no array 'Labels' of 2 components")

        small = vtkUnstructuredGrid()
        small.DeepCopy(mesh)
        small.GetPoints().SetNumberOfPoints(4)
        small.Reset()
        small.GetCellData().GetArray("Label").SetNumberOfTuples(0)
        self.refuse(self.with_data("m.mesh", small, interfaces), "interfaces are not those of this mesh")

        # Labels that no tetrahedron has are harmless.
        other = interfaces.NewInstance()
        other.DeepCopy(interfaces)
        vtk_to_numpy(other.GetCellData().GetArray("Labels"))[:] = (9, 8)
        self.assertEqual(self.with_data("other.msh", mesh, other).Write(), 1)
        self.assertIn(b'"label_9__label_8"', self.files()["other.msh"])

        moved = interfaces.NewInstance()
        moved.DeepCopy(interfaces)
        ids = vtk_to_numpy(moved.GetPointData().GetArray("PointIds"))
        ids[:] = ids[::-1].copy()
        self.refuse(self.with_data("m.inp", mesh, moved), "interfaces are not those of this mesh.*no face")

        pentatopes = self.mesher(frames=3)
        pentatopes.Update()
        self.refuse(self.with_data("m.vtu", mesh, pentatopes.GetOutputDataObject(1)), "one is of three dimensions")
        self.refuse(self.with_data("m.mfem", pentatopes.GetOutput(), interfaces), "one is of three dimensions")

    def slabs(self):
        """A mesh of two slabs, periodic: pentatopes, boundary."""
        mesher = self.mesher(frames=9)
        mesher.AddTimePlane(4.0)
        mesher.PeriodicOn()
        mesher.Update()
        return mesher.GetOutput(), mesher.GetOutputDataObject(1)

    def test_slabs(self):
        mesh, boundary = self.slabs()
        self.assertEqual(set(vtk_to_numpy(mesh.GetCellData().GetArray("Slab"))), {0, 1})
        for name in ("s.vtu", "s.mfem", "s.mesh"):
            for slab in (0, 1):
                writer = self.with_data(name, mesh, boundary)
                writer.SetSlab(slab)
                self.assertEqual((writer.Write(), writer.GetErrorMessage()), (1, ""))
                self.assertGreater(len(self.files()[name]), 1000)
            writer.SetSlab(2)
            self.refuse(writer, "it has no slab 2; slabs are those of the pentatopes of a mesh with time planes")
        writer = self.with_data("s.vtu", mesh, boundary)
        writer.SetSlab(0)
        writer.SetContent(INTERFACES)
        self.refuse(writer, "it has no slab 0")
        flat = self.mesher()
        flat.Update()
        writer = self.with_data("s.vtu", flat.GetOutput())
        writer.SetSlab(0)
        self.refuse(writer, "it has no slab 0")

    def test_damaged_slabs(self):
        mesh, boundary = self.slabs()

        def refuse(pattern, damage):
            copy = mesh.NewInstance()
            copy.DeepCopy(mesh)
            damage(copy)
            for name in ("m.mfem", "m.mesh"):
                self.refuse(self.with_data(name, copy, boundary), pattern)

        def pairs_of(grid):
            return grid.GetFieldData().GetArray("PeriodicPairs")

        refuse("its PeriodicPairs are not its points", lambda grid: pairs_of(grid).SetComponent(3, 1, 1e9))
        refuse("its PeriodicPairs are not its points", lambda grid: pairs_of(grid).SetComponent(0, 0, -1))
        refuse("not those of a meshing filter", lambda grid: pairs_of(grid).SetNumberOfComponents(1))
        refuse("values 'Slab' for", lambda grid: grid.GetCellData().GetArray("Slab").SetNumberOfTuples(5))

    def test_damaged_data(self):
        """What a damaged file may leave: vertices and arrays that are none."""
        mesher = self.mesher()
        mesher.Update()
        mesh, interfaces = mesher.GetOutput(), mesher.GetOutputDataObject(1)

        def damaged(data, damage):
            copy = data.NewInstance()
            copy.DeepCopy(data)
            damage(copy)
            return copy

        def set_vertex(cells, vertex):
            vtk_to_numpy(cells.GetConnectivityArray())[-1] = vertex

        def shorten(attributes, name):
            array = attributes.GetArray(name)
            array.SetNumberOfTuples(array.GetNumberOfTuples() - 1)

        def replace(attributes, name, value):
            values = vtkDoubleArray()
            values.DeepCopy(attributes.GetArray(name))
            values.SetComponent(0, 0, value)
            attributes.RemoveArray(name)
            attributes.AddArray(values)

        for name in ("m.msh", "m.xdmf", "m.inp"):
            for vertex in (-1, mesh.GetNumberOfPoints(), 1 << 60):
                with self.subTest(name=name, vertex=vertex):
                    wrong = damaged(mesh, lambda grid: set_vertex(grid.GetCells(), vertex))
                    self.refuse(self.with_data(name, wrong, interfaces), "vertices that are none of its points")
                    wrong = damaged(interfaces, lambda surface: set_vertex(surface.GetPolys(), vertex))
                    self.refuse(self.with_data(name, mesh, wrong), "vertices that are none of its points")
            wrong = damaged(mesh, lambda grid: shorten(grid.GetCellData(), "Label"))
            self.refuse(self.with_data(name, wrong, interfaces), "the mesh has [0-9]+ values 'Label' for")
            wrong = damaged(interfaces, lambda surface: shorten(surface.GetCellData(), "Labels"))
            self.refuse(self.with_data(name, mesh, wrong), "the interfaces have [0-9]+ values 'Labels' for")
            wrong = damaged(interfaces, lambda surface: shorten(surface.GetPointData(), "PointIds"))
            self.refuse(self.with_data(name, mesh, wrong), "the interfaces have [0-9]+ values 'PointIds' for")
            for value in (float("nan"), float("inf"), -1, 1e300):
                with self.subTest(name=name, value=value):
                    wrong = damaged(interfaces, lambda surface: replace(surface.GetPointData(), "PointIds", value))
                    self.refuse(self.with_data(name, mesh, wrong), "their PointIds are not its points")
            for value in (1e300, -1e300, 1 << 40):
                wrong = damaged(mesh, lambda grid: replace(grid.GetCellData(), "Label", value))
                self.refuse(self.with_data(name, wrong, interfaces), "does not fit into this format")

        for name in ("i.stl", "i.ply", "i.vtp"):
            wrong = damaged(interfaces, lambda surface: set_vertex(surface.GetPolys(), 1 << 40))
            writer = self.with_data(name, mesh, wrong)
            writer.SetContent(INTERFACES)
            self.refuse(writer, "vertices that are none of its points")

    def test_small_cells(self):
        points, polygons = vtkPoints(), vtkCellArray()
        for i in range(3):
            points.InsertNextPoint(i, 0, i * i)
        polygons.InsertNextCell(2, (0, 1))
        surface = vtkPolyData()
        surface.SetPoints(points)
        surface.SetPolys(polygons)
        for name in ("i.vtp", "i.vtk", "i.stl"):
            writer = self.with_data(name, vtkUnstructuredGrid(), surface)
            writer.SetContent(INTERFACES)
            self.refuse(writer, "cells with fewer vertices than they need")

    def test_no_points(self):
        for name in ("m.vtu", "m.msh", "m.xdmf", "m.mesh"):
            empty = vtkUnstructuredGrid()
            label = vtkIntArray()
            label.SetName("Label")
            empty.GetCellData().AddArray(label)
            self.assertEqual(self.with_data(name, empty).Write(), 1, name)
            self.assertIsNone(empty.GetPoints())

    def test_full_disk(self):
        """A limit on the size of files stands in for it. What was there before stays."""
        mesher = self.mesher()
        mesher.SetDelta(1)
        mesher.Update()
        for name, content in (("m.vtu", MESH), ("m.vtk", MESH), ("m.msh", MESH), ("m.mesh", MESH), ("m.inp", MESH),
                              ("m.feb", MESH), ("m.mfem", MESH), ("m.xdmf", MESH),
                              ("i.vtp", INTERFACES), ("i.stl", INTERFACES), ("i.ply", INTERFACES)):
            with self.subTest(name):
                (self.folder / name).write_text("old")
                writer = self.writer(mesher, name, content)
                before = resource.getrlimit(resource.RLIMIT_FSIZE)
                handler = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
                resource.setrlimit(resource.RLIMIT_FSIZE, (2048, before[1]))
                try:
                    done = writer.Write()
                finally:
                    resource.setrlimit(resource.RLIMIT_FSIZE, before)
                    signal.signal(signal.SIGXFSZ, handler)
                self.assertEqual((done, (self.folder / name).read_text()), (0, "old"))
                self.assertRegex(writer.GetErrorMessage(), "cannot write '.*%s': " % name)
                self.assertFalse([file for file in self.files() if file.startswith(".")])

    def test_recovery(self):
        writer = self.writer(self.mesher(), "m.xyz")
        self.assertEqual(writer.Write(), 0)
        writer.SetFileName(self.folder / "m.vtu")
        self.assertEqual((writer.Write(), writer.GetErrorMessage(), writer.GetErrorCode()), (1, "", 0))

    def test_print(self):
        text = str(self.writer(self.mesher(), "m.xyz"))
        for line in ("FileName: .*m.xyz", "TemporaryFileName: .none", "TemporaryCompanionFileName: .none",
                     "Content: mesh"):
            self.assertRegex(text, line)


if __name__ == "__main__":
    unittest.main()
