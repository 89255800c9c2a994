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
import unittest
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
        done = self.assert_refused(3, pattern, "--input", path, "--output", "mesh.vtu", *arguments, timeout=60,
                                   preexec_fn=limit_memory)
        self.assertIn(os.path.basename(str(path)), done.stderr)
        self.assertLess(len(done.stderr), 500)
        self.assertNotIn("memory", done.stderr)

    def refuse_one_slice(self, path):
        done = self.call("--input", path, "--output", "mesh.vtu")
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertRegex(done.stderr, "1 voxel")

    def survive(self, path):
        """What is damaged in a way that only the library which reads it sees: an image, or one line that names the file."""
        done = self.call("--input", path, "--output", "mesh.vtu", "--delta", 1, timeout=60, preexec_fn=limit_memory)
        self.assertIn(done.returncode, (0, 1, 3), done.stderr)
        if done.returncode:
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

    def nifti(self, name, **fields):
        """fields: offsets in the header, with formats and values."""
        data = bytearray(Path(images.write_nifti(self.folder / "plain.nii", images.ball(4, 1.5))).read_bytes())
        (self.folder / "plain.nii").unlink()
        for offset, (form, *values) in fields.items():
            struct.pack_into("<" + form, data, int(offset[1:]), *values)
        return self.write(name, gzip.compress(bytes(data)) if name.endswith(".gz") else bytes(data))


class Sizes(HostileTestCase):
    """Headers that claim more than the file can hold."""

    def test_claims(self):
        ball, moving = images.ball(4, 1.5), images.moving_balls(2, 8, 2.5)
        for write, name, array, lines in (
                *((images.write_nrrd, "i.nrrd", ball, {"sizes": "3000 3000 3000", "encoding": encoding})
                  for encoding in ("raw", "gzip", "ascii", "hex")),
                *((images.write_metaimage, "i.mha", ball, {"DimSize": "3000 3000 3000", **more})
                  for more in ({}, {"CompressedData": "True"}, {"BinaryData": "False"})),
                (images.write_metaimage, "i.mha", moving, {"DimSize": "8 8 8 100000000"}),
                (images.write_sequence, "i.nrrd", moving, {"sizes": "100000000 8 8 8"})):
            with self.subTest(name, lines=lines):
                write(self.folder / name, array, header_lines=lines)
                self.refuse(CLAIM % (name, "'%s'" % name), name)
        for name in ("i.nii", "i.nii.gz"):
            self.refuse(CLAIM % (name, "'%s'" % name), self.nifti(name, _42=("3h", 32767, 32767, 32767)))

    def test_claims_of_two_files(self):
        self.write("i.raw", bytes(64))
        self.refuse(CLAIM % ("i.nhdr", "'i.raw'"), self.nrrd_header("i.nhdr", sizes="3000 3000 3000", data_file="i.raw"))
        self.nifti("i.hdr", _42=("3h", 3000, 3000, 3000), _344=("4s", b"ni1\0"))
        self.write("i.img", bytes(64))
        for name in ("i.hdr", "i.img"):
            self.refuse(CLAIM % (name, "'i.img'"), name)

    def test_claims_of_other_formats(self):
        head = ("# vtk DataFile Version 3.0\nlabels\n%s\nDATASET STRUCTURED_POINTS\nDIMENSIONS 3000 3000 3000\n"
                "SPACING 1 1 1\nORIGIN 0 0 0\nPOINT_DATA 27000000000\nSCALARS labels %s 1\nLOOKUP_TABLE default\n")
        for encoding, scalars in (("BINARY", "unsigned_char"), ("ASCII", "short"), ("binary", "double")):
            with self.subTest(encoding):
                self.refuse("truncated or damaged",
                            self.write("i.vtk", (head % (encoding, scalars)).encode() + b"1 " * 32))
        head = bytearray(256)
        struct.pack_into(">5H4f", head, 0, 60000, 60000, 1000, 1, 8, 1, 1, 1, 1)
        struct.pack_into(">I", head, 252, 719555000)
        self.refuse(CLAIM % ("i.gipl", "'i.gipl'"), self.write("i.gipl", bytes(head) + bytes(64)))

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

    def test_large_and_sound(self):
        """What compresses best is no hostile size."""
        zeros = np.zeros((160, 160, 160), np.uint8)
        for write, name in ((images.write_nrrd, "i.nrrd"), (images.write_nifti, "i.nii.gz")):
            with self.subTest(name):
                path = Path(write(self.folder / name, zeros))
                self.assertLess(path.stat().st_size * 200, zeros.size)
                self.assert_refused(1, "no foreground", "--input", name, "--output", "mesh.vtu")


class Headers(HostileTestCase):
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
        done = self.call("image", "i.nrrd", **options)
        self.assertEqual(done.returncode, 3)
        self.assertRegex(done.stderr, "^voxplex: cannot read 'i.nrrd': Permission denied\n$")


@unittest.skipIf(USES_SANITIZER, "sanitizers reserve more")
class LittleMemory(ProgramTestCase):
    def test_messages(self):
        """However little there is, the program or the loader of its libraries says so."""
        path = images.write_nrrd(self.folder / "i.nrrd", images.two_labels(14, 5.0))
        statuses = set()
        for mebibytes in range(40, 400, 20):
            limit = mebibytes << 20
            done = self.call("--input", path, "--delta", 3, "--threads", 2, "--quality", "--messages", "python",
                             preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit)))
            statuses.add(done.returncode)
            with self.subTest(mebibytes, told=done.stderr):
                self.assertIn(done.returncode, (0, 1, 3, 127))
                if done.returncode in (1, 3):
                    self.assertRegex(done.stderr, '^{"kind":"error",[^\n]*(memory|limits)[^\n]*\n$')
        self.assertLessEqual({1, 127}, statuses)


if __name__ == "__main__":
    main()
