#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Legacy .vtk and .vti: labels of points and cells, their place, and what is refused."""
import itertools
import unittest

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkBitArray, vtkStringArray
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkIOLegacy import vtkStructuredPointsWriter
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter

from iotesting import FolderTestCase, table_of, warnings_of

ARRAY = np.random.default_rng(3).integers(0, 100, (4, 5, 6)).astype("u1")
TYPES = {"unsigned_char": "u1", "char": "i1", "unsigned_short": "u2", "short": "i2", "unsigned_int": "u4", "int": "i4",
         "unsigned_long": "u8", "long": "i8", "vtktypeint64": "i8", "float": "f4", "double": "f8"}
HIDDEN_POINT, HIDDEN_CELL = 2, 32


def legacy(array=ARRAY, kind="unsigned_char", encoding="BINARY", data="POINT_DATA", points=None, before=b"", after=b"",
           spacing="SPACING 0.5 0.25 1.5", attribute="SCALARS labels %s 1\nLOOKUP_TABLE default\n"):
    """before and after are bytes of other arrays."""
    points = points or array.shape[::-1]
    head = ("# vtk DataFile Version 3.0\nlabels\n%s\nDATASET STRUCTURED_POINTS\nDIMENSIONS %d %d %d\n%s\n"
            "ORIGIN 10 -20 30\n%s %d\n" % (encoding, *points, spacing, data, array.size))
    return head.encode() + before + (attribute % kind).encode() + numbers(array, encoding) + after


def numbers(array, encoding="BINARY"):
    """Big-endian, or as text."""
    if encoding == "BINARY":
        return array.astype(array.dtype.newbyteorder(">")).tobytes() + b"\n"
    return "\n".join(" ".join(map(repr, row.tolist())) for row in array.reshape(-1, array.shape[-1])).encode() + b"\n"


def image_of(*arrays, cells=False, direction=None, start=(0, 0, 0)):
    """vtkImageData with arrays by name; the first is active unless its name is empty or a ghost's."""
    image = vtkImageData()
    shape = np.array(arrays[0][1].shape[::-1]) + cells
    image.SetExtent([int(value) for pair in zip(start, start + shape - 1) for value in pair])
    image.SetSpacing(0.5, 0.25, 1.5)
    image.SetOrigin(10, -20, 30)
    if direction is not None:
        image.SetDirectionMatrix(np.asarray(direction, float).ravel())
    data = image.GetCellData() if cells else image.GetPointData()
    for name, array in arrays:
        values = numpy_to_vtk(np.ascontiguousarray(array).ravel(), deep=1)
        values.SetName(name)
        data.AddArray(values)
    return image


def add_texts(image, name, texts, as_bytes=False):
    if as_bytes:
        data = b"".join(text.encode(errors="surrogateescape") + b"\0" for text in texts)
        array = numpy_to_vtk(np.frombuffer(data, "u1"), deep=1)
    else:
        array = vtkStringArray()
        for text in texts:
            array.InsertNextValue(text)
    array.SetName(name)
    image.GetFieldData().AddArray(array)


# VTK does not tell what is missing from what is wrong.
BROKEN = "truncated or damaged|VTK does not read it|which no image has"


class Files(FolderTestCase):
    def save(self, data, name="i.vtk"):
        (self.folder / name).write_bytes(data)
        return self.folder / name

    def save_xml(self, image, **settings):
        writer = vtkXMLImageDataWriter()
        writer.SetInputData(image)
        writer.SetFileName(str(self.folder / "i.vti"))
        for name, value in settings.items():
            getattr(writer, "Set" + name)(value)
        self.assertEqual(writer.Write(), 1)
        return self.folder / "i.vti"

    def check(self, path, array=ARRAY, origin=(10, -20, 30), spacing=(0.5, 0.25, 1.5), direction=np.eye(3), dtype=None):
        image = self.read(path)
        self.assertEqual(image.GetDimensions(), array.shape[::-1])
        np.testing.assert_allclose(image.GetOrigin(), origin)
        np.testing.assert_allclose(image.GetSpacing(), spacing)
        matrix = image.GetDirectionMatrix()
        np.testing.assert_allclose([[matrix.GetElement(i, j) for j in range(3)] for i in range(3)], direction,
                                   atol=1e-12)
        read = vtk_to_numpy(image.GetPointData().GetArray("Labels")).reshape(array.shape)
        self.assertEqual(read.dtype, np.dtype(dtype or array.dtype))
        np.testing.assert_array_equal(read, array)

    def test_legacy_layouts(self):
        bits = ARRAY > 50
        packed = np.packbits(bits).tobytes() + b"\n"
        field = "FIELD FieldData 1\nlabels 1 120 %s\n"
        vectors = b"VECTORS v float\n" + numbers(np.ones((120, 3), "f4"))
        for name, data, more in (
                ("a field", legacy(attribute=field), {}),
                ("a table of colours", legacy(attribute="SCALARS labels %s 1\nLOOKUP_TABLE mine\n",
                                              after=b"LOOKUP_TABLE mine 2\n" + bytes(8) + b"\n"), {}),
                ("another array, not active", legacy(after=b"FIELD more 1\nmore 1 120 float\n" + bytes(480) + b"\n"),
                 {}),
                ("vectors", legacy(before=vectors), {}),
                ("bits", legacy(bits, "bit")[:-121] + packed, dict(array=bits.astype("u1"))),
                ("an old word for spacing", legacy(spacing="ASPECT_RATIO 0.5 0.25 1.5"), {}),
                ("lines of Windows", legacy(encoding="ASCII").replace(b"\n", b"\r\n"), {})):
            with self.subTest(name):
                self.check(self.save(data), **more)
        reader = self.reader(self.save(legacy().replace(b"ORIGIN 10 -20 30\n", b"")))
        self.assertEqual(reader.GetErrorMessage(), "")
        self.assertRegex("".join(warnings_of(reader)), "No origin read")

    def test_xml(self):
        turned = [[0, -1, 0], [0.8, 0, 0.6], [-0.6, 0, 0.8]]
        start = np.array([3, -2, 5])
        moved = np.array([10, -20, 30]) + np.array(turned) @ (start * (0.5, 0.25, 1.5))
        for dtype, mode, compressor, order in itertools.product(
                ("u1", "i2", "u4", "i8", "f4", "f8"), ("Ascii", "Binary", "Appended"), (0, 1), (0, 1)):
            with self.subTest(dtype, mode=mode, compressor=compressor, order=order):
                array = ARRAY.astype(dtype)
                path = self.save_xml(image_of(("labels", array), direction=turned, start=start),
                                     CompressorType=compressor,
                                     ByteOrder=order, DataMode=("Ascii", "Binary", "Appended").index(mode))
                self.check(path, array, origin=moved, direction=turned)
        with self.subTest("bits"):
            image = image_of(("labels", ARRAY))
            image.GetPointData().RemoveArray("labels")
            bits = vtkBitArray()
            for value in ARRAY.ravel():
                bits.InsertNextValue(int(value > 50))
            image.GetPointData().AddArray(bits)
            self.check(self.save_xml(image), (ARRAY > 50).astype("u1"))

    def test_fields(self):
        """SPACE and names of labels, as the reader itself writes them; texts may be bytes, as in our meshes."""
        turned = np.array([[0, -1, 0], [0.8, 0, 0.6], [-0.6, 0, 0.8]])
        flip = np.diag([-1, -1, 1])
        for space, as_bytes in (("RAS", False), ("LPS", False), ("RAS", True)):
            with self.subTest(space, as_bytes=as_bytes):
                place = flip if space == "RAS" else np.eye(3)
                image = image_of(("labels", ARRAY), direction=turned)
                add_texts(image, "SPACE", [space], as_bytes)
                add_texts(image, "LabelNames", ["Liver", "", "Milz ü"], as_bytes)
                values = numpy_to_vtk(np.array([7, 8, 9], "i4"), deep=1)
                values.SetName("LabelValues")
                image.GetFieldData().AddArray(values)
                path = self.save_xml(image)
                self.check(path, direction=place @ turned, origin=place @ (10, -20, 30))
                reader = self.reader(path)
                self.assertEqual(table_of(reader.GetOutput()), {7: ("Liver", None), 9: ("Milz ü", None)})
                self.assertEqual(reader.GetLabelTableSource(), str(path))
                again = self.read(self.save_xml(self.reader(path, Space=1).GetOutput()))
                np.testing.assert_allclose(again.GetOrigin(), place @ (10, -20, 30))
        image = image_of(("labels", ARRAY))
        add_texts(image, "SPACE", ["scanner"])
        add_texts(image, "LabelNames", ["\udcff", "Milz"], as_bytes=True)
        values = numpy_to_vtk(np.array([7, 9], "i4"), deep=1)
        values.SetName("LabelValues")
        image.GetFieldData().AddArray(values)
        reader = self.reader(self.save_xml(image))
        self.assertRegex("\n".join(warnings_of(reader)), r"SPACE is 'scanner'\); its coordinates are taken for LPS\n"
                         ".*the name of label 7 is not in UTF-8, and is not used")
        self.assertEqual(table_of(reader.GetOutput()), {9: ("Milz", None)})

    def test_hidden(self):
        """What a caller hides is background."""
        hidden = ARRAY > 60
        visible = np.where(hidden, 0, ARRAY)
        for cells, flag in ((False, HIDDEN_POINT), (True, HIDDEN_CELL)):
            with self.subTest(cells=cells):
                image = image_of(("labels", ARRAY), ("vtkGhostType", (hidden * flag).astype("u1")), cells=cells)
                self.check(self.save_xml(image), visible, origin=(10.25, -19.875, 30.75) if cells else (10, -20, 30))
        with self.subTest("cells around points"):
            image = image_of(("labels", ARRAY))
            ghosts = np.zeros((3, 4, 5), "u1")
            ghosts[:2, :, :] = HIDDEN_CELL
            values = numpy_to_vtk(ghosts.ravel(), deep=1)
            values.SetName("vtkGhostType")
            image.GetCellData().AddArray(values)
            shown = ARRAY.copy()
            shown[:2] = 0
            self.check(self.save_xml(image), shown)

    def test_active_scalars(self):
        other = ARRAY + 100
        image = image_of(("other", other), ("labels", ARRAY))
        path = self.save_xml(image)
        self.refused("several arrays .*'other' of the points, 'labels' of the points", path)
        image.GetPointData().SetActiveScalars("labels")
        self.check(self.save_xml(image))
        writer = vtkStructuredPointsWriter()
        writer.SetInputData(image)
        writer.SetFileName(str(self.folder / "i.vtk"))
        writer.Write()
        self.check(self.folder / "i.vtk")
        self.refused("several arrays .*'a' of the points, 'b' of the cells", self.save(
            legacy(attribute="FIELD f 1\na 1 120 %s\n",
                   after=b"CELL_DATA 60\nFIELD f 1\nb 1 60 unsigned_char\n" + bytes(60) + b"\n")))

    def test_refused(self):
        whole = legacy()
        image = image_of(("labels", ARRAY))
        xml = self.save_xml(image).read_bytes()
        for pattern, data in (
                ("it holds POLYDATA; ", b"# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 0 float\n"),
                ("it holds STRUCTURED_GRID; ", whole.replace(b"STRUCTURED_POINTS", b"STRUCTURED_GRID")),
                ("it holds PolyData; ", xml.replace(b'"ImageData"', b'"PolyData"')),
                ("it holds PImageData; ", xml.replace(b'"ImageData"', b'"PImageData"')),
                ("3 components",
                 legacy(before=b"SCALARS rgb unsigned_char 3\nLOOKUP_TABLE default\n" + bytes(360) + b"\n")),
                ("3 components", legacy(before=b"COLOR_SCALARS rgb 3\n" + bytes(360) + b"\n")),
                ("no array of numbers", whole[:whole.index(b"POINT_DATA")]),
                ("no array of numbers", whole[:whole.index(b"SCALARS")] + b"VECTORS v float\n" + bytes(1440) + b"\n"),
                ("header claims 2000 x 2000 x 2000 points", whole.replace(b"6 5 4", b"2000 2000 2000")),
                (BROKEN, whole.replace(b"POINT_DATA 120", b"POINT_DATA 110")),
                (BROKEN, whole.replace(b"6 5 4", b"6 5 5")),
                (BROKEN, legacy(encoding="ASCII")[:-40]),
                (BROKEN, legacy(encoding="ASCII").replace(b" 1\n", b" 1\n1.5\n", 1)),
                (BROKEN, legacy(encoding="ASCII", after=b"17\n")),
                (BROKEN + "|no array of numbers", legacy(kind="unsigned_char" * 400)),  # to VTK 9.6 it is none
                (BROKEN, b"# vtk DataFile Version 3.0\nlabels\nBINARY\nDATASET STRUCTURED_POINTS\nDIM"),
                (BROKEN, b"# vtk DataFile\nlabels"),
                ("spacing|step", legacy(spacing="SPACING 0 1 1")),
                ("spacing|step|finite", legacy(spacing="SPACING nan 1 1"))):
            with self.subTest(pattern, data=data[:150]):
                self.refused(pattern, self.save(data))

    def test_missing_parts(self):
        xml = self.save_xml(image_of(("labels", ARRAY)), DataMode=0).read_bytes()
        whole = b'WholeExtent="0 5 0 4 0 3"'
        piece = xml[xml.index(b"<Piece"):xml.index(b"</Piece>") + 8]
        start = xml.index(b">", xml.index(b"<DataArray")) + 1
        for pattern, data in (
                ("the extent 0 5 0 4 0 4, and its piece 0 5 0 4 0 3", xml.replace(whole, b'WholeExtent="0 5 0 4 0 4"')),
                ("header claims 2000 x 2000 x 2000", xml.replace(b"0 5 0 4 0 3", b"0 1999 0 1999 0 1999")),
                ("stored in 2 pieces", xml.replace(piece, 2 * piece)),
                ("stored in 0 pieces", xml.replace(piece, b"")),
                (BROKEN, xml[:start] + xml[start + 60:]),
                ("document type",
                 xml.replace(b"<VTKFile", b'<!DOCTYPE a [<!ENTITY b SYSTEM "/etc/hostname">]><VTKFile', 1))):
            with self.subTest(pattern):
                self.refused(pattern, self.save(data, "i.vti"))
        xml = self.save_xml(image_of(("labels", ARRAY)), DataMode=1, CompressorType=0).read_bytes()
        at = xml.index(b">", xml.index(b"<DataArray")) + 40
        self.refused(BROKEN, self.save(xml[:at] + xml[at + 60:], "i.vti"))
        for foreign in (b"<!-- -->", b"<?a b?>", b"<a/>", b"\n", b"&#%d;" % xml[at]):
            with self.subTest(foreign):  # VTK ends there, and takes 0 for the rest
                self.refused("line breaks or foreign letters within",
                             self.save(xml[:at] + foreign + xml[at + foreign.startswith(b"&"):], "i.vti"))
        for base64, big in itertools.product((0, 1), (0, 1)):
            xml = self.save_xml(image_of(("labels", ARRAY), ("more", ARRAY[::-1])), DataMode=2, CompressorType=0,
                                EncodeAppendedData=base64, HeaderType=64 if big else 32, ByteOrder=1 - big).read_bytes()
            at = xml.index(b"_", xml.index(b"<AppendedData")) + 1
            for removed in (1, 4, 60, 200):
                with self.subTest(base64=base64, big=big, removed=removed):
                    self.refused(BROKEN, self.save(xml[:at + 20] + xml[at + 20 + removed:], "i.vti"))


if __name__ == "__main__":
    unittest.main()
