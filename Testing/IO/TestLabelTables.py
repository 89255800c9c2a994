#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Names and colours of labels: text tables of all kinds, and the segments of 3D Slicer's files."""
import os
import unittest
from pathlib import Path

import numpy as np

import images

try:
    import nibabel
except ImportError:
    nibabel = None
from iotesting import FolderTestCase, table_of, warnings_of

AAL = Path("/usr/share/mricron/templates/aal.nii.gz")


def slices(labels, dtype=np.int32):
    """An image with a slice of each label."""
    return np.stack([np.zeros((4, 4))] + [np.full((4, 4), float(label)) for label in labels]).astype(dtype)


class TableTestCase(FolderTestCase):
    def setUp(self):
        super().setUp()
        self.image = images.write_nrrd(self.folder / "i.nrrd", slices(range(1, 21)))

    def write(self, text):
        path = self.folder / "table"
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return str(path)

    def table(self, text):
        return table_of(self.read(self.image, LabelTableFileName=self.write(text)))

    def refuse(self, pattern, text):
        self.refused("^cannot read the label table '.*table': " + pattern, self.image,
                     LabelTableFileName=self.write(text))


class Formats(TableTestCase):
    def test_plain(self):
        self.assertEqual(self.table("# comment\n0 Background\n\n 3  Left  hippocampus \n12\tTail (part)\n7 'Area 4'\n"),
                         {3: ("Left  hippocampus", None), 7: ("Area 4", None), 12: ("Tail (part)", None)})

    def test_plain_names_with_commas_and_numbers(self):
        self.assertEqual(self.table("1 Tibia, left\n2 Area 4\n3 Area 6 and 7\n"),
                         {1: ("Tibia, left", None), 2: ("Area 4", None), 3: ("Area 6 and 7", None)})

    def test_codes_of_mricron(self):
        """The third column is a code, unless the names differ in nothing else."""
        self.assertEqual(self.table("1 Precentral_L 2001\r\n2 Precentral_R 2002\r\n\r\n"),
                         {1: ("Precentral_L", None), 2: ("Precentral_R", None)})
        self.assertEqual(self.table("1 Area 4\n2 Area 6\n"), {1: ("Area 4", None), 2: ("Area 6", None)})
        self.assertEqual(self.table("1 Area 4\n"), {1: ("Area 4", None)})

    def test_freesurfer(self):
        self.assertEqual(self.table("#No. Label Name:                R   G   B   A\n"
                                    "0   Unknown                         0   0   0   0\n"
                                    "17  Left-Hippocampus                220 216 20  0\n"
                                    "18\tLeft-Amygdala\t\t103   255  255    0\n"),
                         {17: ("Left-Hippocampus", (220, 216, 20)), 18: ("Left-Amygdala", (103, 255, 255))})

    def test_slicer_color_table(self):
        self.assertEqual(self.table("# Color table file x.ctbl\n# 3 values\n0 background 0 0 0 0\n"
                                    "1 tissue 128 174.5 128 255\n2 'bone' 241 214 145 255\n"),
                         {1: ("tissue", (128, 174.5, 128)), 2: ("bone", (241, 214, 145))})

    def test_colour_without_opacity(self):
        self.assertEqual(self.table("1 left lung 1 2 3\n"), {1: ("left lung", (1, 2, 3))})

    def test_itk_snap(self):
        self.assertEqual(self.table('################\n# ITK-SnAP Label Description File\n# IDX   -R-  -G-  -B-\n'
                                    '    0     0    0    0        0  0  0    "Clear Label"\n'
                                    '    1   255    0    0        1  1  1    "Left I-III"\n'
                                    '    3     0  128  255     0.50  1  0    "Label 3"\n'),
                         {1: ("Left I-III", (255, 0, 0)), 3: ("Label 3", (0, 128, 255))})

    def test_csv(self):
        self.assertEqual(self.table('1,Tibia\n2,"Hippocampus, ""left"""\n'),
                         {1: ("Tibia", None), 2: ('Hippocampus, "left"', None)})
        self.assertEqual(self.table("1;Tibia;10;20;30\n2;Femur;;;\n"), {1: ("Tibia", (10, 20, 30)), 2: ("Femur", None)})

    def test_csv_with_fractions(self):
        self.assertEqual(self.table("1,Tibia,1,0.5,0\n"), {1: ("Tibia", (255, 127.5, 0))})
        self.assertEqual(self.table("1,Tibia,1,0.5,0\n2,Femur,255,0,0\n")[1], ("Tibia", (1, 0.5, 0)))
        self.assertEqual(self.table("1 Tibia 1 1 0 255\n"), {1: ("Tibia", (1, 1, 0))})  # only in CSV

    def test_header(self):
        self.assertEqual(self.table("LabelValue,Name,Color_R,Color_G,Color_B,Color_A\n1,Tibia,10,20,30,255\n"),
                         {1: ("Tibia", (10, 20, 30))})
        self.assertEqual(self.table("red,green,blue,label,index\n10,20,30,Tibia,4\n"), {4: ("Tibia", (10, 20, 30))})
        self.assertEqual(self.table("label,name\n1,Tibia\n"), {1: ("Tibia", None)})
        self.assertEqual(self.table("index\tname\tnote\n3\tLeft lung\tx\n"), {3: ("Left lung", None)})

    def test_encoding(self):
        self.assertEqual(self.table(b"\xef\xbb\xbf1 N\xc3\xa4se\n"), {1: ("N\u00e4se", None)})
        self.assertEqual(self.table("2 \u53f3\u80ba \U0001f9e0\n"), {2: ("\u53f3\u80ba \U0001f9e0", None)})

    def test_same_line_twice(self):
        self.assertEqual(self.table("1 a\n1 a\n"), {1: ("a", None)})


class Errors(TableTestCase):
    def test_lines(self):
        for text, pattern in (
            ("1 a\n# c\nfoo\n", "line 3: 'foo' is not a label"),
            ("1 a\n\n-2 b\n", "line 3: '-2' is not a label"),
            ("1.5 b\n", "line 1: '1.5' is not a label"),
            ("99999999999999999999 b\n", "line 1: '9+' is not a label"),
            ("1 a\n2\n", "line 2: label 2 has no name"),
            ("1 a\n2 ''\n", "line 2: label 2 has no name"),
            ("1 a\n2 b\n1 c\n", "line 3: label 1 has another name on line 1"),
            ("1 a 300 0 0 0\n", "line 1: '300' is not a part of a colour"),
            ("1 a 0 -1 0 0\n", "line 1: '-1' is not a part of a colour"),
            ("1 a 0 nan 0 0\n", "line 1: 'nan' is not a part of a colour"),
            ("1,a\n2\n", "line 2: it has no name"),
            ("1,a\nx,b\n", "line 2: 'x' is not a label"),
            ("1,a\n2,b,c\n", "line 2: it has 3 fields"),
            ("1,a,1,2,x\n", "line 1: 'x' is not a part of a colour"),
            ("1,a,1,2,\n", "line 1: '' is not a part of a colour"),
            ('1,"a\n', "line 1: a quotation mark is not closed"),
            ("colour,name\n1,a\n", "line 1: it begins with no label and is not a header"),
            ("Dear reader, this is text.\n", "line 1: it begins with no label"),
            (b"1 a\n2 N\xe4se\n", "line 2: the name is not in UTF-8"),
            (b"1 \xc0\xaf\n", "line 1: the name is not in UTF-8"),
            (b"1 \xed\xa0\x80\n", "line 1: the name is not in UTF-8"),
            (b"1 a\xe2\x82\n", "line 1: the name is not in UTF-8"),
            # Long texts are quoted by their beginnings, and nothing that a terminal would obey.
            ("x" * 1000000, r"line 1: 'x+\.\.\.' is not a label"),
            ("1" * 100000 + " a\n", r"line 1: '1+\.\.\.' is not a label"),
            ("\x1b[2J a\n", r"line 1: '\?\[2J' is not a label"),
            ("1," + '"' * 100001, "line 1: a quotation mark is not closed"),
            ("1,a" + "," * 1000000, "line 1: it has 1000002 fields"),
            ("1,a,2,3,1e999\n", "line 1: '1e999' is not a part of a colour"),
        ):
            with self.subTest(text[:40]):
                self.refuse(pattern + ".{0,300}$", text)

    def test_no_table(self):
        self.refuse("it is no text file", Path(self.image).read_bytes() + b"\0")
        self.refuse("it lists no labels", "# nothing\n0 background\n")
        self.refuse("it lists no labels", "")
        self.refused("there is no such file", self.image, LabelTableFileName=str(self.folder / "none"))
        os.mkfifo(self.folder / "fifo")
        for name in (self.folder, self.folder / "fifo"):
            self.refused("it is not a regular file", self.image, LabelTableFileName=str(name))

    def test_too_large(self):
        self.refuse("it is larger than 16 MiB", b"1 a\n" * (5 << 20))

    def test_labels_that_are_elsewhere(self):
        reader = self.reader(self.image, LabelTableFileName=self.write("100 a\n200 b\n"))
        self.assertEqual(table_of(reader.GetOutput()), {})
        self.assertRegex(warnings_of(reader)[0], "no label that '.*table' lists is in the image")
        self.assertEqual(reader.GetLabelTableSource(), "")


class Occurrence(TableTestCase):
    def test_only_labels_of_the_image(self):
        """With all types of voxels. 9, which has no name, is not taken for a label that differs from it by 2^8, 2^16
        or 2^32."""
        names = "1 a\n5 b\n200 c\n257 d\n70000 e\n5000000000 f\n265 g\n65545 h\n4294967305 i\n"
        for dtype, labels in (("u1", {1, 200}), ("i1", {5}), ("i2", {257, 5}), ("u2", {1, 257}), ("i4", {70000, 1}),
                              ("u4", {70000}), ("i8", {5000000000, 1}), ("u8", {5000000000, 257}), ("f4", {200, 1}),
                              ("f8", {5000000000, 5})):
            with self.subTest(dtype):
                path = images.write_nrrd(self.folder / "t.nrrd", slices(sorted(labels | {9}), dtype))
                image = self.read(path, LabelTableFileName=self.write(names))
                self.assertEqual(set(table_of(image)), labels)
                wide = max(labels) > 2**31 - 1
                self.assertEqual(image.GetFieldData().GetArray("LabelValues").GetClassName(),
                                 "vtkLongLongArray" if wide else "vtkIntArray")

    def test_any_frame(self):
        frames = np.stack([slices([1, 1]), slices([1, 2]), slices([3, 1])])
        path = images.write_nrrd(self.folder / "t.nrrd", frames)
        image = self.read(path, LabelTableFileName=self.write("1 a\n2 b\n3 c\n4 d\n"))
        self.assertEqual(set(table_of(image)), {1, 2, 3})


class Beside(TableTestCase):
    def test_found(self):
        for image, table in (("x.nii.gz", "x.nii.txt"), ("x.nii", "x.nii.txt"), ("y.nrrd", "y.nrrd.txt")):
            with self.subTest(image):
                write = images.write_nifti if ".nii" in image else images.write_nrrd
                path = write(self.folder / image, slices([1, 2], np.int16))
                (self.folder / table).write_text("2 two\n")
                reader = self.reader(path)
                self.assertEqual(table_of(reader.GetOutput()), {2: ("two", None)})
                self.assertEqual(reader.GetLabelTableSource(), str(self.folder / table))
                (self.folder / table).unlink()
                self.assertEqual(table_of(self.read(path)), {})

    def test_another_file_of_that_name(self):
        (self.folder / "i.nrrd.txt").write_text("Segmented by N. N.\n")
        reader = self.reader(self.image)
        self.assertEqual((reader.GetErrorMessage(), table_of(reader.GetOutput())), ("", {}))
        self.assertRegex(warnings_of(reader)[0], "names: .*i.nrrd.txt': line 1: 'Segmented'")
        self.assertEqual(reader.GetOutput().GetNumberOfPoints(), 21 * 16)

    def test_order(self):
        """The table that is set comes before the header, and the header before the table beside."""
        path = images.write_nrrd(self.folder / "s.seg.nrrd", slices([1, 2]), key_values={
            "Segment0_ID": "s", "Segment0_Name": "of the header", "Segment0_LabelValue": "1"})
        (self.folder / "s.seg.nrrd.txt").write_text("1 beside\n")
        self.assertEqual(table_of(self.read(path)), {1: ("of the header", None)})
        self.assertEqual(table_of(self.read(path, LabelTableFileName=self.write("2 set\n"))), {2: ("set", None)})

    @unittest.skipUnless(AAL.exists(), "package mricron-data")
    def test_atlas(self):
        reader = self.reader(str(AAL))
        table = table_of(reader.GetOutput())
        self.assertEqual(list(table), list(range(1, 117)))
        self.assertEqual([table[label][0] for label in (1, 37, 116)], ["Precentral_L", "Hippocampus_L", "Vermis_10"])
        self.assertEqual(reader.GetLabelTableSource(), str(AAL)[:-3] + ".txt")


class Segments(FolderTestCase):
    KEYS = {
        "Segment0_ID": "Segment_1", "Segment0_Name": "Left lung: upper = 1", "Segment0_Color": "0.2 0.4 1",
        "Segment0_LabelValue": "7", "Segment0_Layer": "0", "Segment0_Extent": "0 3 0 3 0 3",
        "Segment1_ID": "Segment_2", "Segment1_Name": "N\u00e4se \\\\ \\n2", "Segment1_LabelValue": "3",
        "Segment1_Layer": "0", "Segment1_DefaultColor": "0 0 0.6",
        "Segment2_ID": "Segment_3", "Segment2_LabelValue": "4", "Segment2_Color": "x",
        "Segment4_ID": "Segment_5", "Segment4_LabelValue": "5", "Segment4_Name": "after a gap",
        "Segmentation_ReferenceImageExtentOffset": "0 0 0",
    }

    def test_names_and_colours(self):
        path = images.write_nrrd(self.folder / "s.seg.nrrd", slices([3, 4, 5, 7]), key_values=self.KEYS)
        reader = self.reader(path)
        self.assertEqual(warnings_of(reader), [])
        self.assertEqual(reader.GetLabelTableSource(), path)
        self.assertEqual(table_of(reader.GetOutput()), {
            3: ("N\u00e4se \\  2", (0, 0, 153)), 4: ("Segment_3", None), 5: ("after a gap", None),
            7: ("Left lung: upper = 1", (51, 102, 255))})

    def test_segment_without_voxels(self):
        path = images.write_nrrd(self.folder / "s.seg.nrrd", slices([3]), key_values=self.KEYS)
        self.assertEqual(set(table_of(self.read(path))), {3})

    def test_without_value(self):
        """As of Slicer before 4.11, which wrote one segment a layer."""
        path = images.write_nrrd(self.folder / "s.seg.nrrd", slices([1]), key_values={
            "Segment0_ID": "s", "Segment0_Name": "Tumour"})
        self.assertEqual(table_of(self.read(path)), {1: ("Tumour", None)})

    def test_layer_as_an_axis_of_its_own(self):
        """Slicer writes an axis of kind 'list' in front if there are several layers; one is an image as any other."""
        path = images.write_nrrd(self.folder / "s.seg.nrrd", slices([3, 7])[..., None], components=True,
                                 header_lines={"kinds": "list domain domain domain"}, key_values=self.KEYS)
        image = self.read(path)
        self.assertEqual(set(table_of(image)), {3, 7})
        self.assertEqual(image.GetDimensions(), (4, 4, 3))

    def test_damaged_keys(self):
        path = images.write_nrrd(self.folder / "s.seg.nrrd", slices([1, 2]), key_values={
            "Segment0_ID": "a", "Segment0_Name": "Bone", "Segment0_LabelValue": "x",
            "Segment1_ID": "b", "Segment1_Name": "Fat", "Segment1_LabelValue": "2"})
        reader = self.reader(path)
        self.assertRegex(warnings_of(reader)[0], "the segment 'Bone' has a value that is not a label")
        self.assertEqual(table_of(reader.GetOutput()), {2: ("Fat", None)})
        Path(path).write_bytes(Path(path).read_bytes().replace(b"Name:=Fat", b"Name:=F\xe4t"))
        reader.Modified()
        reader.Update()
        self.assertRegex(warnings_of(reader)[1], "the name of label 2 is not in UTF-8")
        self.assertEqual(table_of(reader.GetOutput()), {})


@unittest.skipIf(nibabel is None, "nibabel was not found (apt-get install python3-nibabel)")
class Extensions(FolderTestCase):
    """Tables of Connectome Workbench and of TotalSegmentator (--ml), in files that nibabel writes."""

    XML = """<?xml version="1.0" encoding="UTF-8"?> <CaretExtension> <Date><![CDATA[2013-07-14T05:45:09]]></Date>
        <VolumeInformation Index="0"> <LabelTable>
        <Label Key="0" Red="1" Green="1" Blue="1" Alpha="0"><![CDATA[???]]></Label>
        <Label Key="3" Red="1.0" Green="0.2" Blue="0" Alpha="1"><![CDATA[vertebrae_L3 & <x>]]></Label>
        <Label Key="7" Red="300" Green="0" Blue="0" Alpha="1"> kíhn </Label> <Label Key="4"></Label>
        </LabelTable> </VolumeInformation>
        <VolumeInformation Index="1"> <LabelTable> <Label Key="4">other</Label> </LabelTable> </VolumeInformation>
        </CaretExtension>\n"""
    WANTED = {3: ("vertebrae_L3 & <x>", (255, 51, 0)), 7: ("kíhn", None)}

    def save(self, name, text, code=0, kind="Nifti1Image", order="<"):
        kind = getattr(nibabel, kind)
        array = slices([3, 4, 7], np.int16).T
        image = kind(array, np.eye(4), kind.header_class(endianness=order))
        image.header.set_data_dtype(order + "i2")
        image.header.extensions.append(nibabel.nifti1.Nifti1Extension("comment", b"first"))
        image.header.extensions.append(nibabel.nifti1.Nifti1Extension(code, text.encode()))
        nibabel.save(image, self.folder / name)
        return str(self.folder / name)

    def test_all_kinds_of_files(self):
        for name, kind, order in (("i.nii", "Nifti1Image", "<"), ("i.nii.gz", "Nifti1Image", ">"), ("2.nii", "Nifti2Image", ">"),
                                  ("p.hdr", "Nifti1Pair", "<"), ("q.hdr.gz", "Nifti2Pair", "<")):
            with self.subTest(name=name):
                path = self.save(name, self.XML, 30 if kind.endswith("Pair") else 0, kind, order)
                reader = self.reader(path)
                self.assertEqual((warnings_of(reader), reader.GetLabelTableSource()), ([], path))
                self.assertEqual(table_of(reader.GetOutput()), self.WANTED)

    def test_others_and_damaged(self):
        for wrong, told in (("<other/>", None), ("", None), (self.XML[:-30], "unclosed token in line"),
                            (self.XML.replace('"3"', '"x"'), "a label has the key 'x'"),
                            (self.XML.replace("?> <Caret", "?><!DOCTYPE a [<!ENTITY b 'c'>]><Caret"), "document type")):
            with self.subTest(told=told):
                reader = self.reader(self.save("w.nii", wrong))
                self.assertEqual(table_of(reader.GetOutput()), {})
                self.assertEqual(len(warnings_of(reader)), told is not None)
                if told:
                    self.assertRegex(warnings_of(reader)[0], "which may hold names of labels, is damaged: .*" + told)

    def test_sizes_that_are_wrong(self):
        whole = Path(self.save("s.nii", self.XML)).read_bytes()
        for size in (7, -8, 0, 1 << 30):
            path = self.folder / "t.nii"
            path.write_bytes(whole[:352] + np.int32(size).tobytes() + whole[356:])
            reader = self.reader(path)
            self.assertEqual(table_of(reader.GetOutput()), {})
            self.assertRegex(warnings_of(reader)[0], f"is damaged: it has {size} bytes, and the header \\d+ for it")


if __name__ == "__main__":
    unittest.main()
