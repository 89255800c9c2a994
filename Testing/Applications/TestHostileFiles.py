#!/usr/bin/python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Files that were made to do harm: refused in one line that names the file and the fault.

The memory of the program is limited, so that none is taken for what a header claims and the file cannot hold.
"""
import gzip
import os
import resource
import shutil
import struct
import zlib
from pathlib import Path

import numpy as np

import images
from program import PROGRAM, ProgramTestCase, main

GIBIBYTE = 1 << 30
# What the program and its libraries reserve, and sanitizers, reserve without using it.
ADDRESS_SPACE = 4 * GIBIBYTE
USES_SANITIZER = any(name in Path(shutil.which(PROGRAM)).read_bytes() for name in (b"__asan_init", b"__tsan_init"))

CLAIM = "cannot read '%s': it is truncated or damaged: its header claims .* voxels of [0-9]+ bytes?, and %s"


def limit_memory():
    if not USES_SANITIZER:
        resource.setrlimit(resource.RLIMIT_AS, (ADDRESS_SPACE, ADDRESS_SPACE))


class HostileTestCase(ProgramTestCase):
    def refuse(self, pattern, path, *arguments):
        done = self.assert_refused(1, pattern, "--input", path, "--output", "mesh.vtu", *arguments, timeout=60,
                                   preexec_fn=limit_memory)
        self.assertIn(os.path.basename(str(path)), done.stderr)
        self.assertLess(len(done.stderr), 500)
        self.assertNotIn("memory", done.stderr)

    def write(self, name, data):
        (self.folder / name).write_bytes(data)
        return name

    def nrrd_header(self, name, **fields):
        """A header without voxels."""
        fields = {"encoding": "raw", **{key.replace("_", " "): value for key, value in fields.items()}}
        path = Path(images.write_nrrd(self.folder / name, images.ball(4, 1.5), header_lines=fields))
        path.write_bytes(path.read_bytes().split(b"\n\n")[0] + b"\n")
        return name

    def metaimage_header(self, name, data_file):
        path = Path(images.write_metaimage(self.folder / name, images.ball(4, 1.5), header_lines={"ElementDataFile": "@"}))
        path.write_bytes(path.read_bytes().split(b"@")[0] + data_file.encode() + b"\n")
        return name

    def nifti(self, name, **fields):
        """fields: offsets in the header, with formats and values."""
        data = bytearray(Path(images.write_nifti(self.folder / "plain.nii", images.ball(4, 1.5))).read_bytes())
        (self.folder / "plain.nii").unlink()
        for offset, (form, *values) in fields.items():
            struct.pack_into("<" + form, data, int(offset[1:]), *values)
        return self.write(name, gzip.compress(bytes(data)) if name.endswith(".gz") else bytes(data))


class Sizes(HostileTestCase):
    """Headers that claim more than the file can hold."""

    def test_nrrd(self):
        for encoding in ("raw", "gzip", "ascii", "hex", "bzip2"):
            with self.subTest(encoding):
                images.write_nrrd(self.folder / "i.nrrd", images.ball(4, 1.5),
                                  header_lines={"sizes": "3000 3000 3000", "encoding": encoding})
                self.refuse(CLAIM % ("i.nrrd", "the file has [0-9]+ bytes$"), "i.nrrd")
        images.write_nrrd(self.folder / "i.nrrd", images.ball(4, 1.5), header_lines={"sizes": "4294967296 " * 3})
        self.refuse("too large", "i.nrrd")

    def test_detached_nrrd(self):
        self.write("i.raw", bytes(64))
        self.refuse(CLAIM % ("i.nhdr", "'i.raw' has 64 bytes$"),
                    self.nrrd_header("i.nhdr", sizes="3000 3000 3000", data_file="i.raw"))

    def test_metaimage(self):
        for header in ({}, {"CompressedData": "True"}, {"BinaryData": "False"}):
            with self.subTest(header):
                images.write_metaimage(self.folder / "i.mha", images.ball(4, 1.5),
                                       header_lines={"DimSize": "3000 3000 3000", **header})
                self.refuse(CLAIM % ("i.mha", "the file has [0-9]+ bytes$"), "i.mha")

    def test_frames(self):
        images.write_metaimage(self.folder / "i.mha", images.moving_balls(2, 8, 2.5),
                               header_lines={"DimSize": "8 8 8 100000000"})
        self.refuse(CLAIM % ("i.mha", "the file"), "i.mha")
        images.write_sequence(self.folder / "i.nrrd", images.moving_balls(2, 8, 2.5),
                              header_lines={"sizes": "100000000 8 8 8"})
        self.refuse(CLAIM % ("i.nrrd", "the file"), "i.nrrd")

    def test_nifti(self):
        for name in ("i.nii", "i.nii.gz"):
            self.refuse(r"truncated or damaged \(416 of 35181150962015 bytes\)",
                        self.nifti(name, _42=("3h", 32767, 32767, 32767)))
        # The product of all seven does not fit into 64 bits.
        self.refuse("truncated or damaged", self.nifti("i.nii", _40=("8h", 7, *[32767] * 7)))
        self.refuse("8 bits a voxel from byte -1", self.nifti("i.nii", _108=("f", -1)))
        self.refuse("8 bits a voxel from byte nan", self.nifti("i.nii", _108=("f", float("nan"))))
        self.refuse("truncated or damaged", self.nifti("i.nii", _108=("f", 1e30)))

    def test_placement_of_nifti(self):
        """ITK ends the program where these are not finite."""
        nan = float("nan")
        for fields in ({"_252": ("h", 1), "_256": ("f", nan)}, {"_252": ("h", 1), "_276": ("f", nan)},
                       {"_254": ("h", 1), "_280": ("f", float("inf"))}, {"_254": ("h", 1), "_324": ("f", nan)},
                       {"_254": ("h", 1), "_280": ("f", 1e30)}, {"_252": ("h", 1), "_260": ("f", -1e30)}):
            with self.subTest(fields):
                self.refuse("position or orientation in its header .qform or sform. is not finite, or far too large", self.nifti("i.nii", **fields))
        self.refuse("qform or sform", self.nifti("i.nii", _0=("i", 347), _254=("h", 1), _280=("f", nan)))
        # What is not called .gz is not unpacked, though it begins like that.
        self.refuse("qform or sform", self.nifti("i.nii", _0=("H", 0x8b1f), _254=("h", 1), _280=("f", nan)))
        self.nifti("i.nii", _252=("h", 0), _254=("h", 0), _256=("f", nan), _324=("f", nan))
        self.mesh("--input", "i.nii", "--delta", 1, "--output", "mesh.vtu")

    def test_nifti_of_two_files(self):
        self.nifti("i.hdr", _42=("3h", 3000, 3000, 3000), _344=("4s", b"ni1\0"))
        self.write("i.img", bytes(64))
        self.refuse(CLAIM % ("i.hdr", "its 2 files have"), "i.hdr")
        self.refuse(CLAIM % ("i.img", "the file has 64 bytes"), "i.img")
        self.nifti("i.hdr", _40=("h", 9), _344=("4s", b"ni1\0"))
        self.refuse("9 dimensions", "i.img")

    def test_vtk(self):
        """Which ITK reads as zeros where it ends too soon."""
        head = ("# vtk DataFile Version 3.0\nlabels\n%s\nDATASET STRUCTURED_POINTS\nDIMENSIONS 3000 3000 3000\n"
                "SPACING 1 1 1\nORIGIN 0 0 0\nPOINT_DATA 27000000000\nSCALARS labels %s 1\nLOOKUP_TABLE default\n")
        for encoding, scalars in (("BINARY", "unsigned_char"), ("ASCII", "short"), ("binary", "double")):
            with self.subTest(encoding):
                self.refuse(CLAIM % ("i.vtk", "the file"),
                            self.write("i.vtk", (head % (encoding, scalars)).encode() + b"1 " * 32))

    def test_end_in_the_header(self):
        """ITK finds out while it looks for the format."""
        self.refuse("cannot read 'i.vtk': the file is truncated or damaged",
                    self.write("i.vtk", b"# vtk DataFile Version 3.0\nlabels\nBINARY\nDATASET STRUCTURED_POINTS\nDIM"))
        self.refuse("cannot read 'i.vtk': the file is truncated or damaged", self.write("i.vtk", b"# vtk DataFile\nlabels"))

    def test_gipl(self):
        head = bytearray(256)
        struct.pack_into(">5H4f", head, 0, 60000, 60000, 1000, 1, 8, 1, 1, 1, 1)
        struct.pack_into(">I", head, 252, 719555000)
        self.refuse(CLAIM % ("i.gipl", "the file has 320 bytes"), self.write("i.gipl", bytes(head) + bytes(64)))

    def test_dicom(self):
        path = images.write_dicom_series(self.folder, images.ball(4, 1.5))[0]
        plain = path.read_bytes()
        rows = plain.index(struct.pack("<2H", 0x28, 0x10)) + 8
        path.write_bytes(plain[:rows] + b"\xff\xff" + plain[rows + 2:rows + 10] + b"\xff\xff" + plain[rows + 12:])
        self.refuse(CLAIM % (path.name, "the file has"), path.name)
        frames = images._element(0x28, 8, "IS", "1000000000")
        path.write_bytes(plain[:rows - 8] + frames + plain[rows - 8:])
        self.refuse(CLAIM % (path.name, "the file has"), path.name)

    def test_dicom_elements(self):
        """GDCM takes as much memory as an element claims."""
        path = images.write_dicom_series(self.folder, images.ball(4, 1.5))[0]
        plain = path.read_bytes()
        pixels = plain.rindex(struct.pack("<2H", 0x7FE0, 0x10))
        for group, number, representation in ((0x7FE0, 0x10, b"OW"), (0x29, 0x1010, b"OB"), (0x40, 0xA730, b"SQ")):
            with self.subTest(representation):
                path.write_bytes(plain[:pixels] + struct.pack(
                    "<2H2sHI", group, number, representation, 0, 0xFFFFFFF0) + b"abc")
                message = r"its element \(%04x,%04x\) claims 4294967280 bytes, and 3 are left" % (group, number)
                self.refuse(message, path.name)
                self.assert_refused(1, "'%s': .*%s" % (path.name, message), "--input", ".", "--output", "mesh.vtu")
        # Without a preamble, and without a value representation, for which GDCM has readers, too.
        path.write_bytes(plain[132:pixels] + struct.pack("<2H2sHI", 0x29, 0x1010, b"OB", 0, 0xFFFFFFF0))
        self.refuse(r"its element \(0029,1010\) claims", path.name)
        path.write_bytes(plain[:pixels] + struct.pack("<2HI", 0x29, 0x1010, 0x7FFFFF01))
        self.refuse(r"its element \(0029,1010\) claims 2147483393 bytes, and 0 are left", path.name)

    def test_dicom_representations(self):
        """GDCM takes what follows an unknown one for a length, and as much memory."""
        path = images.write_dicom_series(self.folder, images.ball(4, 1.5))[0]
        plain = path.read_bytes()
        spacing = plain.index(struct.pack("<2H", 0x28, 0x30)) + 4
        path.write_bytes(plain[:spacing] + b"DW" + plain[spacing + 2:])
        self.refuse(r"its element \(0028,0030\) has the value representation 'DW', which DICOM does not have", path.name)

    def test_dicom_grammar(self):
        """GDCM reads what breaks it by other rules, in which other bytes are lengths, or ends the program."""
        path = images.write_dicom_series(self.folder, images.ball(4, 1.5))[0]
        plain = path.read_bytes()
        pixels = plain.rindex(struct.pack("<2H", 0x7FE0, 0x10))

        def insert(*elements):
            return plain[:pixels] + b"".join(elements) + plain[pixels:]

        def element(group, number, representation, value):
            length = struct.pack("<HI", 0, len(value)) if representation in (b"SQ", b"UN") else struct.pack("<H", len(value))
            return struct.pack("<2H2s", group, number, representation) + length + value

        def item(value, length=None):
            return struct.pack("<2HI", 0xFFFE, 0xE000, len(value) if length is None else length) + value

        inner = element(0x8, 0x100, b"SH", b"AB")
        for data, message in (
                (plain[:132] + b"\0\0", "it is truncated: it ends before its first data element"),
                (plain[:132] + struct.pack("<2H", 0x2, 0) + b"UV" + plain[138:pixels], "not an image|truncated"),
                (plain + b"\0" * 6, "it ends within an element"),
                (insert(b"\0" * 8), r"its element \(0000,0000\) has no value representation"),
                (insert(struct.pack("<2HI", 0x29, 0x1010, 4) + b"abcd"), r"\(0029,1010\) has no value representation"),
                (insert(element(0x2, 0x2, b"UI", b"1.")), r"its element \(0002,0002\) is out of place"),
                (insert(struct.pack("<2HI", 0xFFFE, 0xE00D, 0)), r"its element \(fffe,e00d\) is out of place"),
                (insert(element(0xFF, 0x4AA5, b"LO", b"ab")), r"its element \(00ff,4aa5\) is out of place"),
                (insert(element(0x5400, 0x1010, b"OB"[::-1], b"")), "value representation 'BO'"),
                (insert(element(0x5400, 0x100, b"SQ", b"")), r"its element \(5400,0100\) belongs in a sequence"),
                (insert(element(0x40, 0xA730, b"SQ", item(inner, 99))), r"its element \(fffe,e000\) claims 99 bytes, and 10 are left"),
                (insert(element(0x40, 0xA730, b"SQ", item(inner + b"\0" * 4))), r"\(0000,0000\) claims|within an element"),
                (insert(element(0x40, 0xA730, b"SQ", inner)), r"its element \(0008,0100\) is where an item must be"),
                (insert(element(0x40, 0xA730, b"UN", item(inner))), r"its element \(0008,0100\) claims"),
                (insert(element(0x40, 0xA730, b"SQ", item(element(0x8, 0x104, b"LO", b"A")))), "has the odd length 1"),
                (insert(element(0x40, 0xA730, b"LO", b"AB")), "has the value representation 'LO', and must not have it"),
                (insert(element(0x28, 0x1052, b"SQ", item(b""))), r"its element \(0028,1052\) is a sequence"),
                (insert(element(0x28, 0x1052, b"IS", b"1 ")), "has the value representation 'IS', and must not have it"),
                (insert(element(0x28, 0x12, b"US", b"123")), r"its element \(0028,0012\) has 3 bytes, of numbers of 2"),
                (insert(element(0x28, 0x6, b"US", b"\2\0")), r"its element \(0028,0006\) has the value '2', which it must not have"),
                (insert(element(0x8, 0x10, b"SH", b"DICOM ")), r"its element \(0008,0010\) has the value 'DICOM '"),
                (insert(element(0x28, 0x1053, b"DS", b"x1")), r"its element \(0028,1053\) has the value 'x1'"),
                (insert(element(0x18, 0x88, b"DS", b"1\\")), r"its element \(0018,0088\) has the value"),
                (insert(element(0x18, 0x50, b"DS", b"1\\1 ")), r"its element \(0018,0050\) has the value '1.1 '"),
                (insert(element(0x3004, 0xC, b"DS", b"0\\1 ")), r"\(3004,000c\) needs an element \(0028,0008\)"),
                (plain.replace(b"MONOCHROME2 ", b"PALETTECOLOR"), r"its element \(0028,0004\) says that its voxels are colours of a palette"),
                (plain.replace(struct.pack("<2H2s2H", 0x28, 2, b"US", 2, 1), struct.pack("<2H2s2H", 0x28, 2, b"US", 2, 9)),
                 r"its element \(0028,0002\) has the value '9', which it must not have")):
            with self.subTest(message):
                self.refuse("cannot read '%s': .*(%s)" % (path.name, message), self.write(path.name, data))
        # All of it may be compressed.
        start = plain.index(struct.pack("<2H", 0x8, 0x16))
        syntax = struct.pack("<2H2sH", 0x2, 0x10, b"UI", 20) + b"1.2.840.10008.1.2.1\0"
        head = plain[:start].replace(syntax, struct.pack("<2H2sH", 0x2, 0x10, b"UI", 22) + b"1.2.840.10008.1.2.1.99")

        def deflate(data):
            stream = zlib.compressobj(wbits=-15)
            return head + stream.compress(data[start:]) + stream.flush()

        self.refuse(r"its element \(0029,1010\) has no value", self.write(path.name, deflate(insert(struct.pack("<2HI", 0x29, 0x1010, 0)))))
        self.refuse("what is compressed in it does not unpack", self.write(path.name, deflate(plain)[:-20]))
        # What is like these, but sound.
        for data in (deflate(plain), insert(element(0x40, 0xA730, b"SQ", item(inner) + item(b""))), insert(element(0x9, 0x10, b"LO", b"AB")),
                     insert(element(0x18, 0x50, b"DS", b" 1.5e+0 "), element(0x18, 0x88, b"DS", b"  ")),
                     insert(element(0x40, 0xA730, b"UN", item(struct.pack("<2HI", 0x8, 0x100, 2) + b"AB")))):
            self.write(path.name, data)
            self.assert_refused(1, "1 voxel", "--input", path.name, "--output", "mesh.vtu")
        # GDCM has readers for files in these formats, and gives them to them before ITK asks for others.
        self.refuse("it ends before its first data element", self.write("i.nii", struct.pack("<2HI", 2, 16, 42) + bytes(120) + b"DICM\0\0"))

    def tiff(self, name, *entries, form="<", big=False, next_directory=0):
        """entries: tag, type, count, value or offset."""
        offset = "Q" if big else "I"
        head = struct.pack(form + "2sH", b"II" if form == "<" else b"MM", 43 if big else 42)
        head += struct.pack(form + "2HQ", 8, 0, 16) if big else struct.pack(form + "I", 8)
        directory = struct.pack(form + ("Q" if big else "H"), len(entries))
        for tag, kind, count, value in entries:
            value = struct.pack(form + {2: "B", 3: "H", 4: "I"}[kind], value) if count == 1 else struct.pack(form + offset, value)
            directory += struct.pack(form + "2H" + offset, tag, kind, count) + value.ljust(struct.calcsize(offset), b"\0")
        return self.write(name, head + directory + struct.pack(form + offset, next_directory) + bytes(16))

    def test_tiff(self):
        """libtiff takes memory for what tags claim."""
        image = [(256, 3, 1, 4), (257, 3, 1, 4), (258, 3, 1, 8), (259, 3, 1, 1), (262, 3, 1, 1), (273, 4, 1, 8),
                 (277, 3, 1, 1), (278, 3, 1, 4), (279, 4, 1, 16)]
        for form in "<>":
            for big in (False, True):
                with self.subTest(form=form, big=big):
                    options = {"form": form, "big": big}
                    tag = {entry[0]: i for i, entry in enumerate(image)}

                    def replace(*entry):
                        return self.tiff("i.tif", *image[:tag[entry[0]]], entry, *image[tag[entry[0]] + 1:], **options)

                    self.refuse("its tag 273 claims 150994945 values, and the file has", replace(273, 4, 150994945, 8))
                    self.refuse("its tag 259 claims 536870913 values", replace(259, 3, 536870913, 8))
                    self.refuse("claims more strips or tiles than the file has bytes",
                                self.tiff("i.tif", (256, 3, 1, 4), (257, 4, 1, 4000000000), *image[2:7], (278, 3, 1, 1), image[8], **options))
                    self.refuse("its strips or tiles have no size",
                                self.tiff("i.tif", *image, (322, 3, 1, 0), (323, 3, 1, 0), **options))
                    self.refuse("one of its strips or tiles claims more bytes than the file has", replace(279, 4, 1, 4000000000))
                    self.refuse("its directories form a circle",
                                self.tiff("i.tif", *image, next_directory=16 if big else 8, **options))
                    self.refuse("it has no whole directory at byte 9999", self.tiff("i.tif", *image, next_directory=9999, **options))
        self.refuse("its tag 4358 has a text that does not end", self.tiff("i.tif", *image, (4358, 2, 1, 1)))
        # Values of a type that there is not are skipped, however many.
        self.assert_refused(1, "not an image|damaged", "--input", self.tiff("i.tif", *image[:8], (279, 99, 4000000000, 8)),
                            "--output", "mesh.vtu", timeout=60)
        path = self.folder / self.tiff("i.tif", *image)
        self.refuse("it has no whole directory at byte 8", self.write("i.tif", path.read_bytes()[:60]))

    def test_dicom_that_begins_as_tiff(self):
        """Which is GDCM's alone: the header of the TIFF may be wrong."""
        path = images.write_dicom_series(self.folder, images.ball(4, 1.5))[0]
        header = Path(self.folder / self.tiff("i.tif", (273, 4, 150994945, 8))).read_bytes()
        path.write_bytes(header.ljust(128, b"\0") + path.read_bytes()[128:])
        self.assert_refused(1, "1 voxel", "--input", path.name, "--output", "mesh.vtu")

    def change_metaimage(self, old, new):
        data = Path(images.write_metaimage(self.folder / "i.mha", images.ball(4, 1.5))).read_bytes()
        self.assertIn(old, data)
        return self.write("i.mha", data.replace(old, new))

    def test_lines_of_metaimage(self):
        """MetaIO takes the next lines for what is missing, and copies texts to where they have no room."""
        for old, new, message in (
                (b"NDims =", b"NDims", "the line 'NDims 3' of its header is no field"),
                (b"NDims = 3", b"Offset = 3\nNDims = 3", "gives Offset before NDims"),
                (b"DimSize =", b"dimsize =", "has the field 'dimsize', which must be written DimSize"),
                (b"DimSize = 4 4 4", b"DimSize = 4 4", "gives '4 4' for DimSize, where 3 numbers must be"),
                (b"DimSize = 4 4 4", b"DimSize = 4 4 x", "gives '4 4 x' for DimSize"),
                (b"ElementType", b"Color = 1 1 1\nElementType", "gives '1 1 1' for Color, where 4 numbers must be"),
                (b"ElementType", b"TransformMatrix2 = \0\nElementType", "is no field"),
                (b"ElementType", b"Comment == a\nElementType", "the line 'Comment == a' of its header is no field"),
                (b"ElementType", b"= a\nElementType", "the line '= a' of its header is no field"),
                (b"ElementType", b"a" * 255 + b" = b\nElementType", "has a field with a name of 255 bytes"),
                (b"ElementType", b"Comment = " + b"a" * 255 + b"\nElementType", "gives a text of 255 bytes for Comment"),
                (b"NDims", b"NRRD0004 = a\nNDims", "the line 'NRRD0004 = a' of its header is no field"),
                (b"DimSize", b"Dims", "does not give DimSize")):
            with self.subTest(new=new[:40]):
                self.refuse(message, self.change_metaimage(old, new))
        self.change_metaimage(b"ElementType", b"Comment = " + b"a" * 254 + b"\r\n \nMy Field: b = c\nColor = 1 1 1 1 1\nElementType")
        self.mesh("--input", "i.mha", "--delta", 1, "--output", "mesh.vtu")

    def test_repeated_fields_of_metaimage(self):
        """MetaIO takes the last, and writes beyond its memory where these differ."""
        for key, value in (("NDims", "0"), ("DimSize", "4 4 400"), ("CompressedData", "False")):
            with self.subTest(key):
                lines = b"%s = 3 3 3\n%s = %s\n" % (key.encode(), key.encode(), value.encode())
                self.refuse("gives %s more than once" % key, self.change_metaimage(b"ElementType", lines + b"ElementType"))

    def test_compressed_size_of_metaimage(self):
        self.change_metaimage(b"ElementType", b"CompressedData = True\nCompressedDataSize = 4000000000\nElementType")
        self.refuse("claims '4000000000' bytes of compressed voxels", "i.mha")

    def test_no_voxels(self):
        images.write_metaimage(self.folder / "i.mha", images.ball(4, 1.5), header_lines={"DimSize": "0 4 4"})
        self.refuse("its header claims no voxels: 0 x 4 x 4", "i.mha")

    def test_large_and_sound(self):
        """What compresses best is no hostile size."""
        zeros = np.zeros((160, 160, 160), np.uint8)
        for write, name in ((images.write_nrrd, "i.nrrd"), (images.write_nifti, "i.nii.gz")):
            with self.subTest(name):
                path = Path(write(self.folder / name, zeros))
                self.assertLess(path.stat().st_size * 200, zeros.size)
                self.assert_refused(1, "no foreground", "--input", name, "--output", "mesh.vtu")

    def test_text(self):
        """Numbers in text hold at most half a voxel a byte."""
        ball = images.ball(12, 4.0)
        head = Path(images.write_nrrd(self.folder / "i.nrrd", ball, header_lines={"encoding": "ascii"})).read_bytes()
        text = " ".join(map(str, ball.ravel())).encode()
        self.write("i.nrrd", head.split(b"\n\n")[0] + b"\n\n" + text)
        self.mesh("--input", "i.nrrd", "--delta", 3, "--output", "mesh.vtu")


class Headers(HostileTestCase):
    def test_dimensions_of_metaimage(self):
        for number in ("100000", "0", "-3", "many"):
            with self.subTest(number):
                images.write_metaimage(self.folder / "i.mha", images.ball(4, 1.5), header_lines={"NDims": number})
                self.refuse("its header gives '%s' dimensions" % number, "i.mha")

    def test_endless_headers(self):
        self.refuse("its header does not end within 1 MiB", self.write("i.nrrd", b"NRRD0004\n" + b"a" * (1 << 21)))
        self.refuse("its header does not end within 1 MiB",
                    self.write("i.mhd", b"ObjectType = Image\nNDims = 3\nComment = " + b"a" * (1 << 21)))

    def test_endless_values(self):
        """They are quoted by their beginnings."""
        images.write_nrrd(self.folder / "i.nrrd", images.ball(4, 1.5), header_lines={
            "space": None, "space directions": None, "space origin": None, "spacings": "0 1 1 " + "1" * 100000})
        self.refuse("spacing in its header is '0 1 1 1+...'", "i.nrrd")

    def test_deep_nesting(self):
        """GDCM follows sequences by recursion."""
        path = images.write_dicom_series(self.folder, images.ball(4, 1.5))[0]
        plain = path.read_bytes()
        pixels = plain.rindex(struct.pack("<2H", 0x7FE0, 0x10))
        level = struct.pack("<2H2sHI", 0x40, 0xA730, b"SQ", 0, 0xFFFFFFFF) + struct.pack("<2HI", 0xFFFE, 0xE000, 0xFFFFFFFF)
        end = struct.pack("<2HI", 0xFFFE, 0xE00D, 0) + struct.pack("<2HI", 0xFFFE, 0xE0DD, 0)
        path.write_bytes(plain[:pixels] + level * 100000)
        self.refuse("sequences are nested more than 64 deep", path.name)
        path.write_bytes(plain[:pixels] + level * 60 + end * 60 + plain[pixels:])
        self.assert_refused(1, "1 voxel", "--input", path.name, "--output", "mesh.vtu")

    def test_control_characters(self):
        """Terminals obey them."""
        images.write_nrrd(self.folder / "i.nrrd", images.ball(4, 1.5), header_lines={
            "space": None, "space directions": None, "space origin": None, "spacings": "0 1 1\x1b[2J"})
        self.refuse(r"spacing in its header is '0 1 1\?\[2J'", "i.nrrd")

    def test_spacings_and_directions(self):
        for name, fields, pattern in (
                ("i.nrrd", {"space directions": "(0,0,0) (0,1,0) (0,0,1)"}, "spacing|singular|independent"),
                ("i.nrrd", {"space origin": "(nan,0,0)"}, "origin|damaged")):
            with self.subTest(fields):
                images.write_nrrd(self.folder / name, images.ball(8, 2.5), header_lines=fields)
                self.refuse(pattern, name)
        for fields, pattern in (({"TransformMatrix": "0 0 0 0 0 0 0 0 0"}, "singular"), ({"Offset": "inf 0 0"}, "origin|damaged"),
                                ({"TransformMatrix": "nan 0 0 0 1 0 0 0 1"}, "singular|damaged|direction")):
            with self.subTest(fields):
                images.write_metaimage(self.folder / "i.mha", images.ball(8, 2.5), header_lines=fields)
                self.refuse(pattern, "i.mha")


class DataFiles(HostileTestCase):
    """ITK opens any file that a header names."""

    def refuse_data_file(self, pattern, data_file):
        for name, write in (("i.nhdr", lambda name: self.nrrd_header(name, data_file=data_file)),
                            ("i.mhd", lambda name: self.metaimage_header(name, data_file))):
            with self.subTest(name=name, data_file=data_file):
                self.refuse(pattern, write(name))

    def test_missing(self):
        self.refuse_data_file("its data file 'none.raw' does not exist", "none.raw")
        self.refuse_data_file("its data file 'none.raw' does not exist", "LIST\nnone.raw")
        self.refuse_data_file("its data file 'none_001.raw' does not exist", "none_%03d.raw 1 4 1")

    def test_special_files(self):
        os.mkfifo(self.folder / "fifo.raw")
        (self.folder / "folder.raw").mkdir()
        for data_file in ("fifo.raw", "folder.raw", "/dev/zero", "/dev/stdin"):
            self.refuse_data_file("is not a regular file", data_file)

    def test_patterns(self):
        for pattern in ("%s%s%s%n%d.raw 1 4 1", "%0999999999d.raw 1 4 1", "a%d%n.raw 1 4 1", "%n.raw 1 4 1",
                        "a%d.raw 1 2147483647 1", "a%d.raw 1 4 0", "a%d.raw 4 1 1", "a%d.raw"):
            self.refuse_data_file("is no pattern of names such as", pattern)
        self.refuse_data_file("names 1000000000 data files", "a%d.raw 1 1000000000 1")
        name = self.metaimage_header("i.mhd", "%S%s%n.raw")
        path = self.folder / name
        path.write_bytes(path.read_bytes().replace(b"ElementDataFile", b"\n \n  ElementDataFile"))
        self.refuse("is no pattern of names such as", name)  # also after empty lines, which MetaImage skips

    def test_lists_of_metaimage(self):
        """MetaIO trusts their blanks and numbers, and leaves out what is not there."""
        ball = images.ball(4, 1.5)
        for k in range(4):
            self.write("a%d.raw" % k, ball[k].tobytes())
        names = "\n".join("a%d.raw" % k for k in range(4))
        for data_file, message in (
                ("LIST   2\n" + names, "is no list of data files"), ("LIST -7\n" + names, "is no list of data files"),
                ("LIST 3\n" + names, "is no list of data files"), ("LISTS\n" + names, "is no list of data files"),
                ("LIST\na0.raw\n\na1.raw\na2.raw\na3.raw", "the line '' of its header names no data file"),
                ("LIST\n " + names, "the line ' a0.raw' of its header names no data file"),
                ("LIST\na0.raw\na1.raw\na2.raw", "lists 3 data files with a line each, and 4 are needed"),
                ("a%d.raw 0 3", "is no pattern of names"), ("a%d.raw 0  3 1", "is no pattern of names"),
                ("a%d.raw 0 3 1 1", "is no pattern of names"), ("a%d.raw 3 3 -1", "is no pattern of names"),
                ("a%d.raw 0 2 1", "names 3 data files, and 4 are needed")):
            with self.subTest(data_file):
                self.refuse(message, self.metaimage_header("i.mhd", data_file))
        for data_file in ("LIST\n" + names, "LIST 2\n" + names + "\n\n", "a%d.raw 0 3 1"):
            self.mesh("--input", self.metaimage_header("i.mhd", data_file), "--delta", 1, "--output", "mesh.vtu")
        self.metaimage_header("i.mhd", "LIST\n" + names)
        self.write("i.mhd", (self.folder / "i.mhd").read_bytes()[:-1])
        self.refuse("lists 3 data files with a line each, and 4 are needed", "i.mhd")

    def test_sound_ones(self):
        ball = images.ball(8, 2.8)
        for k in range(8):
            self.write("slice_%03d.raw" % k, ball[k].tobytes())
        for data_file in ("slice_%03d.raw 0 7 1", "LIST\n" + "\n".join("slice_%03d.raw" % k for k in range(8))):
            fields = {"sizes": "8 8 8", "data_file": data_file}
            with self.subTest(data_file):
                self.mesh("--input", self.nrrd_header("i.nhdr", **fields), "--delta", 2, "--output", "mesh.vtu")


class Files(HostileTestCase):
    def test_special_files(self):
        os.mkfifo(self.folder / "i.nrrd")
        self.refuse("it is neither a regular file nor a folder", "i.nrrd")
        self.refuse("it is neither a regular file nor a folder", "/dev/zero")
        self.refuse("'i.nrrd' is not a regular file", ".")

    def test_no_permission(self):
        images.write_nrrd(self.folder / "i.nrrd", images.ball())
        (self.folder / "i.nrrd").chmod(0)
        self.folder.chmod(0o755)
        # Root may read everything.
        options = {"user": 65534} if os.geteuid() == 0 else {}
        done = self.call("--input", "i.nrrd", **options)
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stderr, "^voxplex: cannot read 'i.nrrd': Permission denied\n$")

    def test_label_tables(self):
        images.write_nrrd(self.folder / "i.nrrd", images.ball(12, 4.0))
        os.mkfifo(self.folder / "fifo.txt")
        (self.folder / "folder.txt").mkdir()
        with open(self.folder / "large.txt", "wb") as file:
            file.truncate((16 << 20) + 1)
        for name, text, pattern in (
                ("a.txt", b"", "it lists no labels"),
                ("a.txt", b"\0" * 100, "it is no text file"),
                ("a.txt", b"x" * 1000000, "line 1: 'x+...' is not a label"),
                ("a.txt", b"1 " + b"\xff" * 1000, "line 1: the name is not in UTF-8"),
                ("a.txt", b"\x1b[2J a\n", r"line 1: '\?\[2J' is not a label"),
                ("a.txt", b"9223372036854775808 a\n", "line 1: '9223372036854775808' is not a label"),
                ("a.txt", b"1" * 100000 + b" a\n", "line 1: '1+...' is not a label"),
                ("a.txt", b'1,"a', "line 1: a quotation mark is not closed"),
                ("a.txt", b"1," + b'"' * 100001, "line 1: a quotation mark is not closed"),
                ("a.txt", b"1,a" + b"," * 1000000, "line 1: it has 1000002 fields"),
                ("a.txt", b"1,a,2,3,1e999\n", "line 1: '1e999' is not a part of a colour"),
                ("fifo.txt", None, "it is not a regular file"),
                ("folder.txt", None, "it is not a regular file"),
                ("large.txt", None, "it is larger than 16 MiB"),
                ("none.txt", None, "there is no such file")):
            with self.subTest(name=name, text=text and text[:20]):
                if text is not None:
                    self.write(name, text)
                done = self.assert_refused(1, "cannot read the label table '%s': %s" % (name, pattern), "--input",
                                           "i.nrrd", "--label-table", name, "--output", "m.vtu",
                                           preexec_fn=limit_memory, timeout=60)
                self.assertLess(len(done.stderr), 500)


if __name__ == "__main__":
    main()
