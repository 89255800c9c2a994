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

CLAIM = "cannot read '%s': it is truncated or damaged: its header claims .* voxels of [0-9]+ bytes?, and %s has [0-9]+ bytes$"


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

    def accept(self, *arguments, warning=".*"):
        """Small images lose volume, of which there is a warning, too."""
        done = self.call(*arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stderr, warning)

    def refuse_one_slice(self, path):
        done = self.call("--input", path, "--output", "mesh.vtu")
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertRegex(done.stderr, "1 voxel")

    def survive(self, path):
        """What is damaged in a way that only the library which reads it sees: an image, or one line that names the file."""
        done = self.call("--input", path, "--output", "mesh.vtu", "--delta", 1, timeout=60, preexec_fn=limit_memory)
        self.assertIn(done.returncode, (0, 1), done.stderr)
        if done.returncode == 1:
            self.assertRegex(done.stderr.splitlines(True)[-1], r"^voxplex: cannot (read|mesh) '[^\n]*%s[^\n]*\n$" % os.path.basename(str(path)))

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
        for encoding in ("raw", "gzip", "ascii", "hex"):
            with self.subTest(encoding):
                images.write_nrrd(self.folder / "i.nrrd", images.ball(4, 1.5),
                                  header_lines={"sizes": "3000 3000 3000", "encoding": encoding})
                self.refuse(CLAIM % ("i.nrrd", "'i.nrrd'"), "i.nrrd")
        images.write_nrrd(self.folder / "i.nrrd", images.ball(4, 1.5), header_lines={"encoding": "bzip2"})
        self.refuse("in the encoding 'bzip2'; those that are read are raw, gzip, text and hex", "i.nrrd")
        images.write_nrrd(self.folder / "i.nrrd", images.ball(4, 1.5), header_lines={"sizes": "4294967296 " * 3})
        self.refuse("its header claims 4294967296 x 4294967296 x 4294967296 voxels", "i.nrrd")

    def test_detached_nrrd(self):
        self.write("i.raw", bytes(64))
        self.refuse(CLAIM % ("i.nhdr", "'i.raw'"), self.nrrd_header("i.nhdr", sizes="3000 3000 3000", data_file="i.raw"))

    def test_metaimage(self):
        for header in ({}, {"CompressedData": "True"}, {"BinaryData": "False"}):
            with self.subTest(header):
                images.write_metaimage(self.folder / "i.mha", images.ball(4, 1.5),
                                       header_lines={"DimSize": "3000 3000 3000", **header})
                self.refuse(CLAIM % ("i.mha", "'i.mha'"), "i.mha")

    def test_frames(self):
        images.write_metaimage(self.folder / "i.mha", images.moving_balls(2, 8, 2.5),
                               header_lines={"DimSize": "8 8 8 100000000"})
        self.refuse(CLAIM % ("i.mha", "'i.mha'"), "i.mha")
        images.write_sequence(self.folder / "i.nrrd", images.moving_balls(2, 8, 2.5),
                              header_lines={"sizes": "100000000 8 8 8"})
        self.refuse(CLAIM % ("i.nrrd", "'i.nrrd'"), "i.nrrd")

    def test_nifti(self):
        for name in ("i.nii", "i.nii.gz"):
            self.refuse(CLAIM % (name, "'%s'" % name), self.nifti(name, _42=("3h", 32767, 32767, 32767)))
        self.refuse("it has 7 dimensions", self.nifti("i.nii", _40=("8h", 7, *[32767] * 7)))
        for offset in (-1, 0, 348, float("nan"), 1e30):
            self.refuse("its header says that voxels begin at byte", self.nifti("i.nii", _108=("f", offset)))
        self.refuse("16 bits a voxel .bitpix., and its datatype 2 has 8", self.nifti("i.nii", _72=("h", 16)))

    def test_placement_of_nifti(self):
        nan = float("nan")
        for fields in ({"_252": ("h", 1), "_254": ("h", 0), "_256": ("f", nan)}, {"_252": ("h", 1), "_254": ("h", 0), "_276": ("f", nan)},
                       {"_254": ("h", 1), "_280": ("f", float("inf"))}, {"_254": ("h", 1), "_324": ("f", nan)},
                       {"_254": ("h", 1), "_280": ("f", 1e30)}):
            with self.subTest(fields):
                self.refuse("its position or orientation in space is not finite, or far too large", self.nifti("i.nii", **fields))
        self.nifti("i.nii", _252=("h", 0), _254=("h", 0), _256=("f", nan), _324=("f", nan))
        self.accept("--input", "i.nii", "--delta", 1, "--output", "mesh.vtu", warning="does not say where the image lies")

    def test_nifti_of_two_files(self):
        self.nifti("i.hdr", _42=("3h", 3000, 3000, 3000), _344=("4s", b"ni1\0"))
        self.write("i.img", bytes(64))
        self.refuse(CLAIM % ("i.hdr", "'i.img'"), "i.hdr")
        self.refuse(CLAIM % ("i.img", "'i.img'"), "i.img")
        self.nifti("i.hdr", _40=("h", 9), _344=("4s", b"ni1\0"))
        self.refuse("9 dimensions", "i.img")

    def test_vtk(self):
        """Which readers may take for zeros where it ends too soon."""
        head = ("# vtk DataFile Version 3.0\nlabels\n%s\nDATASET STRUCTURED_POINTS\nDIMENSIONS 3000 3000 3000\n"
                "SPACING 1 1 1\nORIGIN 0 0 0\nPOINT_DATA 27000000000\nSCALARS labels %s 1\nLOOKUP_TABLE default\n")
        for encoding, scalars in (("BINARY", "unsigned_char"), ("ASCII", "short"), ("binary", "double")):
            with self.subTest(encoding):
                self.refuse("truncated or damaged",
                            self.write("i.vtk", (head % (encoding, scalars)).encode() + b"1 " * 32))

    def test_end_in_the_header(self):
        self.refuse("cannot read 'i.vtk': ",
                    self.write("i.vtk", b"# vtk DataFile Version 3.0\nlabels\nBINARY\nDATASET STRUCTURED_POINTS\nDIM"))
        self.refuse("cannot read 'i.vtk': ", self.write("i.vtk", b"# vtk DataFile\nlabels"))

    def test_gipl(self):
        head = bytearray(256)
        struct.pack_into(">5H4f", head, 0, 60000, 60000, 1000, 1, 8, 1, 1, 1, 1)
        struct.pack_into(">I", head, 252, 719555000)
        self.refuse(CLAIM % ("i.gipl", "'i.gipl'"), self.write("i.gipl", bytes(head) + bytes(64)))

    def test_dicom(self):
        """Claims of the header, and of elements."""
        path = images.write_dicom_series(self.folder, images.ball(4, 1.5))[0]
        plain = path.read_bytes()
        rows = plain.index(struct.pack("<2H", 0x28, 0x10)) + 8
        path.write_bytes(plain[:rows] + b"\xff\xff" + plain[rows + 2:rows + 10] + b"\xff\xff" + plain[rows + 12:])
        self.refuse("truncated|damaged", path.name)
        frames = images._element(0x28, 8, "IS", "1000000000")
        path.write_bytes(plain[:rows - 8] + frames + plain[rows - 8:])
        self.refuse("truncated|damaged|frames", path.name)
        pixels = plain.rindex(struct.pack("<2H", 0x7FE0, 0x10))
        for group, number, representation in ((0x7FE0, 0x10, b"OW"), (0x29, 0x1010, b"OB"), (0x40, 0xA730, b"SQ")):
            with self.subTest(representation):
                path.write_bytes(plain[:pixels] + struct.pack("<2H2sHI", group, number, representation, 0, 0xFFFFFFF0) + b"abc")
                self.survive(path.name)
        spacing = plain.index(struct.pack("<2H", 0x28, 0x30)) + 4
        self.survive(self.write(path.name, plain[:spacing] + b"DW" + plain[spacing + 2:]))

    def test_dicom_grammar(self):
        """GDCM reads what breaks it by other rules, in which other bytes are lengths, or ends its process."""
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
        for data in (
                plain[:132] + b"\0\0",
                plain[:132] + struct.pack("<2H", 0x2, 0) + b"UV" + plain[138:pixels],
                plain + b"\0" * 6,
                insert(b"\0" * 8),
                insert(struct.pack("<2HI", 0x29, 0x1010, 4) + b"abcd"),
                insert(element(0x2, 0x2, b"UI", b"1.")),
                insert(struct.pack("<2HI", 0xFFFE, 0xE00D, 0)),
                insert(element(0xFF, 0x4AA5, b"LO", b"ab")),
                insert(element(0x5400, 0x1010, b"OB"[::-1], b"")),
                insert(element(0x5400, 0x100, b"SQ", b"")),
                insert(element(0x40, 0xA730, b"SQ", item(inner, 99))),
                insert(element(0x40, 0xA730, b"SQ", item(inner + b"\0" * 4))),
                insert(element(0x40, 0xA730, b"SQ", inner)),
                insert(element(0x40, 0xA730, b"UN", item(inner))),
                insert(element(0x40, 0xA730, b"SQ", item(element(0x8, 0x104, b"LO", b"A")))),
                insert(element(0x40, 0xA730, b"LO", b"AB")),
                insert(element(0x28, 0x1052, b"SQ", item(b""))),
                insert(element(0x28, 0x1052, b"IS", b"1 ")),
                insert(element(0x28, 0x12, b"US", b"123")),
                insert(element(0x28, 0x6, b"US", b"\2\0")),
                insert(element(0x8, 0x10, b"SH", b"DICOM ")),
                insert(element(0x28, 0x1053, b"DS", b"x1")),
                insert(element(0x18, 0x88, b"DS", b"1\\")),
                insert(element(0x18, 0x50, b"DS", b"1\\1 ")),
                insert(element(0x3004, 0xC, b"DS", b"0\\1 ")),
                plain.replace(b"MONOCHROME2 ", b"PALETTECOLOR"),
                plain.replace(struct.pack("<2H2s2H", 0x28, 2, b"US", 2, 1), struct.pack("<2H2s2H", 0x28, 2, b"US", 2, 9))):
            with self.subTest(data[len(data) // 2:]):
                self.survive(self.write(path.name, data))
        # All of it may be compressed.
        start = plain.index(struct.pack("<2H", 0x8, 0x16))
        syntax = struct.pack("<2H2sH", 0x2, 0x10, b"UI", 20) + b"1.2.840.10008.1.2.1\0"
        head = plain[:start].replace(syntax, struct.pack("<2H2sH", 0x2, 0x10, b"UI", 22) + b"1.2.840.10008.1.2.1.99")

        def deflate(data):
            stream = zlib.compressobj(wbits=-15)
            return head + stream.compress(data[start:]) + stream.flush()

        self.survive(self.write(path.name, deflate(insert(struct.pack("<2HI", 0x29, 0x1010, 0)))))
        self.refuse("truncated|damaged", self.write(path.name, deflate(plain)[:-20]))
        # What is like these, but sound.
        for data in (deflate(plain), insert(element(0x40, 0xA730, b"SQ", item(inner) + item(b""))), insert(element(0x9, 0x10, b"LO", b"AB")),
                     insert(element(0x18, 0x50, b"DS", b" 1.5e+0 "), element(0x18, 0x88, b"DS", b"  ")),
                     insert(element(0x40, 0xA730, b"UN", item(struct.pack("<2HI", 0x8, 0x100, 2) + b"AB")))):
            self.write(path.name, data)
            self.refuse_one_slice(path.name)

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

                    for path in (
                            replace(273, 4, 150994945, 8), replace(259, 3, 536870913, 8), replace(279, 4, 1, 4000000000),
                            self.tiff("i.tif", (256, 3, 1, 4), (257, 4, 1, 4000000000), *image[2:7], (278, 3, 1, 1), image[8], **options),
                            self.tiff("i.tif", *image, (322, 3, 1, 0), (323, 3, 1, 0), **options),
                            self.tiff("i.tif", *image, next_directory=16 if big else 8, **options),
                            self.tiff("i.tif", *image, next_directory=9999, **options)):
                        self.refuse("cannot read 'i.tif': ", path)
        self.refuse("cannot read 'i.tif': ", self.tiff("i.tif", *image, (4358, 2, 1, 1)))
        # Values of a type that there is not are skipped, however many.
        self.refuse("cannot read 'i.tif': ", self.tiff("i.tif", *image[:8], (279, 99, 4000000000, 8)))
        path = self.folder / self.tiff("i.tif", *image)
        self.refuse("cannot read 'i.tif': ", self.write("i.tif", path.read_bytes()[:60]))

    def test_dicom_that_begins_as_tiff(self):
        """Which is GDCM's alone: the header of the TIFF may be wrong."""
        path = images.write_dicom_series(self.folder, images.ball(4, 1.5))[0]
        header = Path(self.folder / self.tiff("i.tif", (273, 4, 150994945, 8))).read_bytes()
        path.write_bytes(header.ljust(128, b"\0") + path.read_bytes()[128:])
        self.refuse_one_slice(path.name)

    def change_metaimage(self, old, new):
        data = Path(images.write_metaimage(self.folder / "i.mha", images.ball(4, 1.5))).read_bytes()
        self.assertIn(old, data)
        return self.write("i.mha", data.replace(old, new))

    def test_lines_of_metaimage(self):
        for old, new, message in (
                (b"NDims =", b"NDims", "not an image|the line 'NDims 3' of its header is no field"),
                (b"DimSize = 4 4 4", b"DimSize = 4 4", "gives '4 4' for 'DimSize', where 3 numbers must be"),
                (b"DimSize = 4 4 4", b"DimSize = 4 4 x", "gives '4 4 x' for 'DimSize'"),
                (b"DimSize = 4 4 4", b"DimSize = 4 4 4 4", "gives '4 4 4 4' for 'DimSize'"),
                (b"ElementType", b"= a\nElementType", "the line '= a' of its header is no field"),
                (b"DimSize", b"Dims", "does not give DimSize")):
            with self.subTest(new=new[:40]):
                self.refuse(message, self.change_metaimage(old, new))
        self.change_metaimage(
            b"ElementType", b"Comment = " + b"a" * 5000 + b"\r\n \nMy Field: b = c\n" + b"a" * 5000 + b" = b\nColor = 1 1\nElementType")
        self.accept("--input", "i.mha", "--delta", 1, "--output", "mesh.vtu")
        # Names and order are not checked letter by letter.
        self.change_metaimage(b"NDims = 3", b"elementspacing: 1 1 1\nNDims = 3\n")
        self.refuse("gives 'ElementSpacing' more than once", "i.mha")

    def test_repeated_fields_of_metaimage(self):
        for key, value in (("NDims", "0"), ("DimSize", "4 4 400"), ("CompressedData", "False")):
            with self.subTest(key):
                lines = b"%s = 3 3 3\n%s = %s\n" % (key.encode(), key.encode(), value.encode())
                self.refuse("gives '%s' more than once" % key, self.change_metaimage(b"ElementType", lines + b"ElementType"))

    def test_no_voxels(self):
        images.write_metaimage(self.folder / "i.mha", images.ball(4, 1.5), header_lines={"DimSize": "0 4 4"})
        self.refuse("its header claims 0 x 4 x 4 voxels", "i.mha")

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
        self.accept("--input", "i.nrrd", "--delta", 3, "--output", "mesh.vtu")


class Headers(HostileTestCase):
    def test_dimensions_of_metaimage(self):
        for number in ("100000", "0", "-3", "many"):
            with self.subTest(number):
                images.write_metaimage(self.folder / "i.mha", images.ball(4, 1.5), header_lines={"NDims": number})
                self.refuse("its header gives '?%s'? (dimensions|for 'NDims')" % number, "i.mha")

    def test_endless_headers(self):
        self.refuse("its header does not end within 1 MiB", self.write("i.nrrd", b"NRRD0004\n" + b"# comment\n" * (1 << 17)))
        self.refuse("its header does not end within 1 MiB",
                    self.write("i.mhd", b"ObjectType = Image\nNDims = 3\nComment = " + b"a" * (1 << 21)))

    def test_endless_values(self):
        """They are quoted by their beginnings."""
        images.write_nrrd(self.folder / "i.nrrd", images.ball(4, 1.5), header_lines={
            "space": None, "space directions": None, "space origin": None, "spacings": "0 1 1 " + "1" * 100000})
        self.refuse("its header gives '0 1 1 1+...' for 'spacings'", "i.nrrd")

    def test_deep_nesting(self):
        """GDCM follows sequences by recursion."""
        path = images.write_dicom_series(self.folder, images.ball(4, 1.5))[0]
        plain = path.read_bytes()
        pixels = plain.rindex(struct.pack("<2H", 0x7FE0, 0x10))
        level = struct.pack("<2H2sHI", 0x40, 0xA730, b"SQ", 0, 0xFFFFFFFF) + struct.pack("<2HI", 0xFFFE, 0xE000, 0xFFFFFFFF)
        end = struct.pack("<2HI", 0xFFFE, 0xE00D, 0) + struct.pack("<2HI", 0xFFFE, 0xE0DD, 0)
        self.survive(self.write(path.name, plain[:pixels] + level * 100000))
        self.survive(self.write(path.name, plain[:pixels] + level * 60 + end * 60 + plain[pixels:]))

    def test_control_characters(self):
        """Terminals obey them."""
        images.write_nrrd(self.folder / "i.nrrd", images.ball(4, 1.5), header_lines={
            "space": None, "space directions": None, "space origin": None, "spacings": "0 1 1\x1b[2J"})
        self.refuse(r"its header gives '0 1 1\?\[2J' for 'spacings'", "i.nrrd")

    def test_spacings_and_directions(self):
        for name, fields, pattern in (
                ("i.nrrd", {"space directions": "(0,0,0) (0,1,0) (0,0,1)"}, "spacing|singular|independent"),
                ("i.nrrd", {"space origin": "(nan,0,0)"}, "position")):
            with self.subTest(fields):
                images.write_nrrd(self.folder / name, images.ball(8, 2.5), header_lines=fields)
                self.refuse(pattern, name)
        for fields, pattern in (({"TransformMatrix": "0 0 0 0 0 0 0 0 0"}, "spacing"), ({"Offset": "inf 0 0"}, "position"),
                                ({"TransformMatrix": "nan 0 0 0 1 0 0 0 1"}, "position or orientation")):
            with self.subTest(fields):
                images.write_metaimage(self.folder / "i.mha", images.ball(8, 2.5), header_lines=fields)
                self.refuse(pattern, "i.mha")


class DataFiles(HostileTestCase):
    """A header from a stranger may name any file of the user's."""

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
        for data_file in ("fifo.raw", "folder.raw"):
            self.refuse_data_file("is not a regular file", data_file)

    def test_other_folders(self):
        """Whatever the way there is."""
        (self.folder / "below").mkdir()
        self.write("below/own.raw", bytes(64))
        (self.folder / "link.raw").symlink_to("/etc/passwd")
        (self.folder / "up").symlink_to("..")
        for data_file in ("/dev/zero", "/dev/stdin", "/etc/passwd", "../x.raw", "below/../../x.raw", "link.raw", "up/x.raw",
                          "LIST\n/etc/passwd", "/var/a%d.raw 1 4 1"):
            self.refuse_data_file("is not in the folder of the header or below.*--data-files-anywhere", data_file)
        self.assert_refused(1, "no foreground", "--input", self.nrrd_header("i.nhdr", data_file="below/own.raw"),
                            "--output", "mesh.vtu")

    def test_patterns(self):
        for pattern in ("%s%s%s%n%d.raw 1 4 1", "%0999999999d.raw 1 4 1", "a%d%n.raw 1 4 1",
                        "a%d.raw 1 4 0", "a%d.raw 4 1 1", "a%d.raw"):
            self.refuse_data_file("is no pattern of names such as", pattern)
        self.refuse_data_file("names 1000000000 data files", "a%d.raw 1 1000000000 1")
        self.refuse_data_file("its data file '%n.raw 1 4 1' does not exist", "%n.raw 1 4 1")
        name = self.metaimage_header("i.mhd", "%S%s%d.raw")
        path = self.folder / name
        path.write_bytes(path.read_bytes().replace(b"ElementDataFile", b"\n \n  ElementDataFile"))
        self.refuse("is no pattern of names such as", name)  # also after empty lines, which MetaImage skips

    def test_lists_of_metaimage(self):
        ball = images.ball(4, 1.5)
        for k in range(4):
            self.write("a%d.raw" % k, ball[k].tobytes())
        names = "\n".join("a%d.raw" % k for k in range(4))
        for data_file, message in (
                ("LISTS\n" + names, "its data file 'LISTS' does not exist"),
                ("LIST\na0.raw\na1.raw\na2.raw", "its header names 3 data files, which cannot hold 4 x 4 x 4 voxels"),
                ("a%d.raw 0 2 1", "its header names 3 data files, which cannot hold 4 x 4 x 4 voxels"),
                ("a%d.raw 3 0 1", "is no pattern of names")):
            with self.subTest(data_file):
                self.refuse(message, self.metaimage_header("i.mhd", data_file))
        for data_file in ("LIST\n" + names, "LIST 2\n" + names + "\n\n", "a%d.raw 0 3 1", "a%d.raw 0 3"):
            self.accept("--input", self.metaimage_header("i.mhd", data_file), "--delta", 0.5, "--output", "mesh.vtu")

    def test_sound_ones(self):
        ball = images.ball(8, 2.8)
        for k in range(8):
            self.write("slice_%03d.raw" % k, ball[k].tobytes())
        for data_file in ("slice_%03d.raw 0 7 1", "LIST\n" + "\n".join("slice_%03d.raw" % k for k in range(8))):
            fields = {"sizes": "8 8 8", "data_file": data_file}
            with self.subTest(data_file):
                self.accept("--input", self.nrrd_header("i.nhdr", **fields), "--delta", 1, "--output", "mesh.vtu")


class Files(HostileTestCase):
    def test_special_files(self):
        os.mkfifo(self.folder / "i.nrrd")
        self.refuse("it is neither a regular file nor a folder", "i.nrrd")
        self.refuse("it is neither a regular file nor a folder", "/dev/zero")
        self.refuse("the folder holds no DICOM images|not a regular file", ".")

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
