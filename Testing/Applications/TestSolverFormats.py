#!/usr/bin/python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""The formats of solvers as meshio, h5py and an XML parser read them, against .vtu and .vtp; and these by meshio."""
import binascii
import json
import resource
import tempfile
import unittest
from xml.etree import ElementTree

import h5py
import meshio
import numpy as np
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import VTK_TETRA, vtkUnstructuredGrid
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter

import images
import meshfiles
from labelledmesh import LabelledMeshTestCase
from program import main


def meshio_reads_vtu():
    """meshio 5.3 does not read appended raw data, of VTK itself either, with Python 3.13."""
    points = vtkPoints()
    for point in ((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)):
        points.InsertNextPoint(point)
    grid = vtkUnstructuredGrid()
    grid.SetPoints(points)
    grid.InsertNextCell(VTK_TETRA, 4, (0, 1, 2, 3))
    with tempfile.TemporaryDirectory() as folder:
        writer = vtkXMLUnstructuredGridWriter()
        writer.SetInputData(grid)
        writer.SetFileName(folder + "/grid.vtu")
        writer.EncodeAppendedDataOff()
        writer.Write()
        try:
            return len(meshio.read(folder + "/grid.vtu").points) == 4
        except binascii.Error:
            return False


@unittest.skipUnless(meshio_reads_vtu(), "meshio does not read VTK's own files with this Python")
class VTKFilesReadByMeshio(LabelledMeshTestCase):
    """The same numbers as VTK's reader has."""

    def setUp(self):
        super().setUp()
        (self.folder / "names.csv").write_text('3,"Left lung",255,0,51\n7,N\u00e4se\n', encoding="utf-8")

    def assert_same(self, name, expected):
        found = meshio.read(self.folder / name)
        np.testing.assert_array_equal(found.points, expected.points[:, :3])
        blocks = [(block.type, len(block.data)) for block in found.cells]
        self.assertGreater(len(blocks), 0)
        first = 0
        for block, labels in zip(found.cells, found.cell_data["Labels" if expected.labels.ndim == 2 else "Label"]):
            np.testing.assert_array_equal(block.data, list(expected.cells[first:first + len(block.data)]))
            np.testing.assert_array_equal(labels.reshape(len(block.data), -1),
                                          expected.labels[first:first + len(block.data)].reshape(len(block.data), -1))
            first += len(block.data)
        self.assertEqual(first, len(expected.cells))
        return found

    def test_tetrahedra(self):
        """With names and without; enough of them that an array has several blocks."""
        for delta, names in ((2.5, True), (2.5, False), (1.0, True)):
            for name, *space in (("m.vtu",), ("m.vtk",), ("ras.vtk", "--space", "ras")):
                with self.subTest(delta=delta, names=names, name=name):
                    self.delta = delta
                    self.write(name, *space, *(("--label-table", "names.csv") if names else ()))
                    self.assert_same(name, meshfiles.read_tetrahedra(self.folder / name))

    def test_names(self):
        self.write("m.vtu", "--label-table", "names.csv")
        fields = meshio.read(self.folder / "m.vtu").field_data
        self.assertEqual(bytes(fields["LabelNames"]).decode().split("\0"), ["Left lung", "N\u00e4se", ""])
        self.assertEqual((fields["LabelValues"].tolist(), bytes(fields["SPACE"])), ([3, 7], b"LPS\0"))

    def test_labels_of_64_bits(self):
        wide = np.where(images.two_labels() == 7, 5_000_000_000, images.two_labels()).astype(np.uint64)
        self.input = images.write_nrrd(self.folder / "wide.nrrd", wide)
        self.write("m.vtu")
        mesh = meshfiles.read_tetrahedra(self.folder / "m.vtu")
        self.assertEqual(set(mesh.labels), {3, 5_000_000_000})
        self.assert_same("m.vtu", mesh)

    def test_space_time(self):
        """Boundaries, slices and points; meshio has no pentatopes, and says so."""
        self.input = images.write_nrrd(self.folder / "t.nrrd", np.stack([images.two_labels(14, 5.0)] * 5))
        self.delta = 2
        self.write("p.vtu", "--label-table", "names.csv", "--time-planes", 2, "--periodic", "--slabs", "slab_",
                   "--plc", "b.vtu", "--slices", "s_", "--slice-count", 3)
        boundary = self.assert_same("b.vtu", meshfiles.read_boundary(self.folder / "b.vtu"))
        self.assertIn("Left lung__background__initial", bytes(boundary.field_data["SurfaceNames"]).decode().split("\0"))
        for i in range(3):
            self.assert_same("s_%d.vtu" % i, meshfiles.read_slice(self.folder / ("s_%d.vtu" % i)))
        for name in ("p.vtu", "slab_0.vtu"):
            found, expected = meshio.read(self.folder / name), meshfiles.read_pentatopes(self.folder / name)
            self.assertEqual(found.cells, [])
            np.testing.assert_array_equal(np.column_stack([found.points, found.point_data["Time"]]), expected.points)


class ReadByMeshio(LabelledMeshTestCase):
    def test_medit(self):
        mesh = meshio.read(self.write("mesh.mesh"))
        np.testing.assert_array_equal(mesh.points, self.points)
        np.testing.assert_array_equal(mesh.get_cells_type("tetra"), self.cells)
        np.testing.assert_array_equal(mesh.get_cell_data("medit:ref", "tetra"), self.labels)
        np.testing.assert_array_equal(mesh.get_cells_type("triangle"), self.triangles)
        numbers = self.pair_numbers()
        np.testing.assert_array_equal(mesh.get_cell_data("medit:ref", "triangle"),
                                      [numbers[tuple(pair)] for pair in self.pairs])

    def test_gmsh(self):
        mesh = meshio.read(self.write("mesh.msh"))
        self.assertIn(b"SPACE=LPS\n", (self.folder / "mesh.msh").read_bytes())
        # The reader numbers points by blocks of nodes.
        order = np.lexsort(mesh.points.T)
        np.testing.assert_array_equal(mesh.points[order], self.points[np.lexsort(self.points.T)])
        self.assertEqual({name: tuple(value) for name, value in mesh.field_data.items()},
                         {**{name: (label, 3) for label, name in self.label_names.items()},
                          **{self.name_of_pair(pair): (number, 2) for pair, number in self.pair_numbers().items()}})
        expected = {**self.cells_by_name(), **self.triangles_by_name()}
        for block, groups in zip(mesh.cells, mesh.cell_data["gmsh:physical"]):
            dimension = 3 if block.type == "tetra" else 2
            name, = (name for name, value in mesh.field_data.items() if tuple(value) == (groups[0], dimension))
            self.assertEqual(set(groups), {groups[0]})
            np.testing.assert_array_equal(mesh.points[block.data], self.points[expected.pop(name)])
        self.assertEqual(expected, {})

    def test_abaqus(self):
        """meshio knows no surfaces of element faces."""
        mesh = meshio.read(self.write("mesh.inp"))
        np.testing.assert_allclose(mesh.points, self.points, rtol=1e-13, atol=0)
        sets = {name: np.concatenate([block.data[members] for block, members in zip(mesh.cells, blocks)
                                      if len(members)]) for name, blocks in mesh.cell_sets.items()}
        self.assert_same_cells(sets, self.cells_by_name())
        self.assert_same_cells(mesh.point_sets, {name: np.unique(cells)
                                                 for name, cells in self.triangles_by_name().items()})

    def test_xdmf(self):
        """meshio reads files of one grid: each is cut out into a file of its own."""
        grids = {}
        for name, kind in (("mesh", "tetra"), ("facets", "triangle")):
            tree = ElementTree.parse(self.write("mesh.xdmf"))
            domain = tree.getroot().find("Domain")
            for child in list(domain):
                if child.get("Name") != name:
                    domain.remove(child)
            tree.write(self.folder / "one.xdmf")
            grids[kind] = meshio.read(self.folder / "one.xdmf")
            np.testing.assert_array_equal(grids[kind].points, self.points)
            self.assertEqual([block.type for block in grids[kind].cells], [kind])
        np.testing.assert_array_equal(grids["tetra"].cells[0].data, self.cells)
        np.testing.assert_array_equal(grids["tetra"].cell_data["Label"][0], self.labels)
        np.testing.assert_array_equal(grids["triangle"].cells[0].data, self.triangles)
        np.testing.assert_array_equal(grids["triangle"].cell_data["Labels"][0], self.pairs)
        numbers = self.pair_numbers()
        np.testing.assert_array_equal(grids["triangle"].cell_data["Number"][0],
                                      [numbers[tuple(pair)] for pair in self.pairs])


class XDMF(LabelledMeshTestCase):
    def test_names_and_types(self):
        root = ElementTree.parse(self.write("mesh.xdmf")).getroot()
        self.assertEqual((root.tag, root.get("Version")), ("Xdmf", "3.0"))
        information = {entry.get("Name"): entry.get("Value") for entry in root.iter("Information")}
        self.assertEqual(information["SPACE"], "LPS")
        self.assertEqual(json.loads(information["CellTags"]),
                         {name: label for label, name in self.label_names.items()})
        self.assertEqual(json.loads(information["FacetTags"]),
                         {self.name_of_pair(pair): number for pair, number in self.pair_numbers().items()})
        # As FEniCS writes its own files.
        with h5py.File(self.folder / "mesh.h5") as file:
            types = {}
            file.visititems(lambda name, item: types.update({name: item.dtype.str})
                            if isinstance(item, h5py.Dataset) else None)
        self.assertEqual(types, {"mesh/geometry": "<f8", "mesh/topology": "<i8", "mesh/labels": "<i4",
                                 "facets/topology": "<i8", "facets/numbers": "<i4", "facets/labels": "<i4"})
        for item in root.iter("DataItem"):
            file, dataset = item.text.split(":")
            self.assertEqual(file, "mesh.h5")
            with h5py.File(self.folder / file) as heavy:
                self.assertEqual(item.get("Dimensions").split(), [str(n) for n in heavy[dataset].shape])

    def test_file_names(self):
        (self.folder / "a folder").mkdir()
        self.write("a folder/R&D <1>.v2.xdmf")
        text = (self.folder / "a folder" / "R&D <1>.v2.xdmf").read_text()
        self.assertEqual({item.text.split(":")[0] for item in ElementTree.fromstring(text).iter("DataItem")},
                         {"R&D <1>.v2.h5"})
        self.assertTrue((self.folder / "a folder" / "R&D <1>.v2.h5").exists())

    def refuse(self, pattern, *arguments, **options):
        self.assert_refused(3, pattern, "--input", self.input, "--delta", self.delta, *arguments, **options)

    def test_two_files_or_none(self):
        self.write("whole.xdmf")
        whole = (self.folder / "whole.h5").stat().st_size
        (self.folder / "mesh.h5").write_text("old numbers")
        (self.folder / "mesh.xdmf").write_text("old")
        for size in (1000, whole // 4, whole - 1):
            with self.subTest(size):
                self.refuse("cannot write 'mesh.xdmf': ", "--output", "mesh.xdmf", "--threads", 1,
                            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, resource.RLIM_INFINITY)))

    def test_refused_names(self):
        self.refuse("cannot write 'a:b.xdmf': .*':'", "--output", "a:b.xdmf")
        (self.folder / "folder.h5").mkdir()
        self.refuse("cannot write 'folder.h5': it is a folder", "--output", "folder.xdmf")


class FEBio(LabelledMeshTestCase):
    """What FEBio 4 wants of its input, after the source of its reader and of FEBio Studio's."""

    def setUp(self):
        super().setUp()
        self.root = ElementTree.parse(self.write("mesh.feb")).getroot()

    def vertices(self, elements):
        return np.array([[int(vertex) for vertex in element.text.split(",")] for element in elements]) - 1

    def test_sections(self):
        self.assertEqual((self.root.tag, self.root.get("version")), ("febio_spec", "4.0"))
        # Materials come before the domains that have them.
        self.assertEqual([section.tag for section in self.root], ["Module", "Material", "Mesh", "MeshDomains"])
        self.assertEqual(self.root.find("Module").get("type"), "solid")
        self.assertTrue((self.folder / "mesh.feb").read_text().startswith("<?xml"))

    def test_mesh(self):
        mesh = self.root.find("Mesh")
        self.assertEqual([section.tag for section in mesh], ["Nodes"] + ["Elements"] * 2 + ["Surface"] * 3)
        nodes = mesh.find("Nodes")
        self.assertEqual([node.get("id") for node in nodes], [str(i + 1) for i in range(len(self.points))])
        np.testing.assert_array_equal([[float(x) for x in node.text.split(",")] for node in nodes], self.points)
        parts = {part.get("name"): part for part in mesh.iter("Elements")}
        self.assertEqual({part.get("type") for part in parts.values()}, {"tet4"})
        self.assert_same_cells({name: self.vertices(part.iter("elem")) for name, part in parts.items()},
                               self.cells_by_name())
        ids = {name: [int(element.get("id")) for element in part] for name, part in parts.items()}
        self.assert_same_cells(ids, {name: np.flatnonzero(self.labels == label) + 1
                                     for label, name in self.label_names.items()})
        surfaces = {surface.get("name"): surface for surface in mesh.iter("Surface")}
        self.assert_same_cells({name: self.vertices(surface.iter("tri3")) for name, surface in surfaces.items()},
                               self.triangles_by_name())
        for surface in surfaces.values():
            self.assertEqual([face.get("id") for face in surface], [str(i + 1) for i in range(len(surface))])

    def test_domains_have_materials(self):
        materials = {material.get("name"): material for material in self.root.find("Material")}
        self.assertEqual([material.get("id") for material in materials.values()], ["1", "2"])
        self.assertEqual({domain.get("name"): domain.get("mat") for domain in self.root.find("MeshDomains")},
                         {name: name for name in self.label_names.values()})
        self.assertEqual(set(materials), set(self.label_names.values()))
        for material in materials.values():
            self.assertEqual(material.get("type"), "neo-Hookean")
            self.assertEqual({parameter.tag for parameter in material}, {"density", "E", "v"})


if __name__ == "__main__":
    main()
