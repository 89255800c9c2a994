#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Stacks of TIFF pages: all voxels are those that this file or tifffile wrote, or a message says why not."""
import itertools
import lzma
import re
import struct
import unittest
import unittest.mock
import zlib

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy

import images
from iotesting import FolderTestCase, warnings_of

try:
    import PIL.Image
except ImportError:
    PIL = None
try:
    import tifffile
except ImportError:
    tifffile = None

DTYPES = "u1", "i1", "u2", "i2", "u4", "i4", "u8", "i8", "f4", "f8"
UNKNOWN = r"how large its voxels are \(.*1 x 1 x 1: .*SetSpacing\(\)"
TIMES = "its times are in '%s', and so are those of the mesh"
MICRONS = "its lengths are in micrometres, and so is the mesh"
NO_TIME = r"time from frame to frame, which is taken to be 1; use SetTimeScale\(\)"


def labels(dtype="u1", shape=(3, 12, 20)):
    """Extremes of the type among others."""
    dtype = np.dtype(dtype)
    array = np.random.default_rng(3).integers(0, 5, shape).astype(dtype)
    limits = np.iinfo(dtype) if dtype.kind in "ui" else np.finfo(dtype)
    array.ravel()[[0, -1, 7]] = limits.min, limits.max, 100
    return array


# --- A writer of all layouts

def lzw(data):
    """Codes of 9 bits only: the table is cleared before they are longer."""
    codes = [code for at in range(0, len(data), 200) for code in (256, *data[at:at + 200])] + [257]
    bits = "".join(format(code, "09b") for code in codes)
    bits += "0" * (-len(bits) % 8)
    return bytes(int(bits[i:i + 8], 2) for i in range(0, len(bits), 8))


def packbits(data):
    return b"".join(bytes([len(part) - 1]) + part for part in (data[i:i + 128] for i in range(0, len(data), 128)))


def xz(data):
    return lzma.compress(data, lzma.FORMAT_XZ, lzma.CHECK_NONE)


COMPRESSIONS = {"none": (1, bytes), "LZW": (5, lzw), "Deflate": (8, zlib.compress),
                "old Deflate": (32946, zlib.compress), "PackBits": (32773, packbits), "LZMA": (34925, xz)}


def parts(page, rows, tile):
    """Strips of a page, or its tiles, filled up with what must not be read."""
    if not tile:
        return [page[y:y + rows] for y in range(0, len(page), rows)]
    across, down = (-(-size // edge) for size, edge in zip(page.shape[::-1], tile))
    padded = np.full((down * tile[1], across * tile[0]), 77, page.dtype)
    padded[:page.shape[0], :page.shape[1]] = page
    return [padded[y:y + tile[1], x:x + tile[0]]
            for y in range(0, len(padded), tile[1]) for x in range(0, padded.shape[1], tile[0])]


def pack(page, order):
    return (np.packbits(page, axis=1) if page.dtype == bool else page.astype(page.dtype.newbyteorder(order))).tobytes()


def difference(part):
    """Predictor 2: each number less the one before it."""
    return np.concatenate((part[:, :1], part[:, 1:] - part[:, :-1]), axis=1)


def write(path, pages, order="<", big=False, compression="none", rows=5, tile=None, predictor=1, change=None, tags=(),
          loop=None):
    """
    change(page,
           {tag: (type,
                  values)}) edits a directory. tags are those of the first page. loop is the number of the directory
    after the last.
    """
    offset, count, entry = ("Q", "Q", 20) if big else ("I", "H", 12)
    kinds = {1: "B", 2: "B", 3: "H", 4: "I", 5: "I", 16: "Q"}
    file = bytearray(struct.pack(order + "2sH", b"II" if order == "<" else b"MM", 43 if big else 42))
    file += struct.pack(order + "2H", 8, 0) if big else b""
    link = len(file)
    file += struct.pack(order + offset, 0)
    code, compress = COMPRESSIONS[compression]
    places = []
    for number, page in enumerate(pages):
        page = np.asarray(page)
        chunks = [compress(pack(difference(part) if predictor == 2 else part, order)) for part in parts(page, rows,
                                                                                                        tile)]
        starts = []
        for chunk in chunks:
            starts.append(len(file))
            file += chunk + b"\xEE" * (len(chunk) % 2 + 2)
        kind = {"b": 1, "u": 1, "i": 2, "f": 3}[page.dtype.kind]
        entries = {256: (4, [page.shape[1]]), 257: (4, [page.shape[0]]),
                   258: (3, [1 if page.dtype == bool else 8 * page.dtype.itemsize]),
                   259: (3, [code]), 262: (3, [1]), 277: (3, [1]), 339: (3, [kind])}
        if predictor != 1:
            entries[317] = 3, [predictor]
        if tile:
            entries.update({322: (4, [tile[0]]), 323: (4, [tile[1]]), 324: (4, starts),
                            325: (4, [len(chunk) for chunk in chunks])})
        else:
            entries.update({273: (4, starts), 278: (4, [rows]), 279: (4, [len(chunk) for chunk in chunks])})
        entries.update(dict(tags) if number == 0 else {})
        if change:
            change(number, entries)
        directory = struct.pack(order + count, len(entries))
        for tag, (kind, values) in sorted(entries.items()):
            data = values if kind == 2 else struct.pack(order + str(len(values)) + kinds[kind], *values)
            size = len(values) // 2 if kind == 5 else len(values)
            if len(data) > struct.calcsize(offset):
                data, place = struct.pack(order + offset, len(file)), data
                file += place + b"\0" * (len(place) % 2)
            directory += struct.pack(order + "2H" + offset, tag, kind, size) + data.ljust(struct.calcsize(offset),
                                                                                          b"\0")
        struct.pack_into(order + offset, file, link, len(file))
        places.append(len(file))
        link = len(file) + len(directory)
        file += directory + struct.pack(order + offset, 0)
    if loop is not None:
        struct.pack_into(order + offset, file, link, places[loop])
    path.write_bytes(file)
    return path


def text(description):
    data = description if isinstance(description, bytes) else description.encode()
    return {270: (2, data + b"\0")}


def resolution(x, y, unit):
    """Voxels for a unit: 1 is none, 2 an inch, 3 a centimetre."""
    return {282: (5, [round(1e6 * x), 10**6]), 283: (5, [round(1e6 * y), 10**6]), 296: (3, [unit])}


def change_all(tags):
    return lambda _, entries: entries.update(tags)


def change_second(tags):
    return lambda number, entries: entries.update(tags if number == 1 else {})


class TIFFTestCase(FolderTestCase):
    def save(self, pages, **options):
        return write(self.folder / "i.tif", pages, **options)

    def check(self, path, array, spacing=(1, 1, 1), origin=(0, 0, 0), time_step=1.0, warnings=(UNKNOWN,), dtype=None):
        """array is indexed [k, j, i], or [n, k, j, i]. The warnings are these, in their order."""
        array = np.asarray(array)
        reader = self.reader(path)
        self.assertEqual(reader.GetErrorMessage(), "")
        said = warnings_of(reader)
        self.assertEqual(len(said), len(warnings), said)
        for line, pattern in zip(said, warnings):
            self.assertRegex(line, pattern)
        frames = array if array.ndim == 4 else array[None]
        self.assertEqual(reader.GetNumberOfFrames(), len(frames))
        for n, frame in enumerate(frames):
            if len(frames) > 1:
                self.assertAlmostEqual(reader.GetTimeOfFrame(n), n * time_step)
                reader.UpdateTimeStep(n * time_step)
            image = reader.GetOutput()
            self.assertEqual(image.GetDimensions(), frame.shape[::-1])
            np.testing.assert_allclose(image.GetSpacing(), spacing, rtol=1e-6)
            np.testing.assert_allclose(image.GetOrigin(), origin, rtol=1e-6, atol=1e-9)
            read = vtk_to_numpy(image.GetPointData().GetArray("Labels")).reshape(frame.shape)
            self.assertEqual(read.dtype, np.dtype(dtype or array.dtype).newbyteorder("="))
            np.testing.assert_array_equal(read, frame)


class Layouts(TIFFTestCase):
    def test_types(self):
        """Numbers of every type in both byte orders, with each compression, in strips and tiles, TIFF and BigTIFF."""
        for n, (dtype, order, compression) in enumerate(itertools.product(DTYPES, "<>", COMPRESSIONS)):
            row = dict(order=order, compression=compression, big=n % 3 == 1, tile=(16, 16) if n % 5 < 2 else None)
            with self.subTest(dtype, **row):
                array = labels(dtype)
                self.check(self.save(array, **row), array)

    def test_predictor(self):
        for dtype, order, tile, compression in itertools.product(("u1", "i2", "u4", "i8"), "<>", (None, (32, 16)),
                                                                 ("LZW", "Deflate")):
            with self.subTest(dtype, order=order, tile=tile, compression=compression):
                array = labels(dtype)
                path = self.save(array, order=order, tile=tile, compression=compression, predictor=2)
                self.check(path, array)

    def test_bits(self):
        """A bit is 0 or 1, whatever is white."""
        array = labels(shape=(3, 12, 21)) > 2
        for tile, compression, white in itertools.product((None, (16, 16)), ("none", "PackBits", "LZW"), (0, 1)):
            with self.subTest(tile=tile, compression=compression, white=white):
                path = self.save(array, tile=tile, compression=compression, change=change_all({262: (3, [white])}))
                self.check(path, array, dtype="u1")

    def test_layouts(self):
        array = labels("u2")

        def without(*tags):
            return lambda _, entries: [entries.pop(tag) for tag in tags]

        for name, wanted, options in (
                ("one strip", array, dict(rows=12)),
                ("a row a strip", array, dict(rows=1)),
                ("strips longer than the page", array, dict(rows=2**32 - 1)),
                ("a tile larger than the page", array, dict(tile=(64, 48))),
                ("white is 0", array, dict(change=change_all({262: (3, [0])}))),
                ("one sample, planar", array, dict(change=change_all({284: (3, [2])}))),
                ("rows upwards", array[:, ::-1], dict(change=change_all({274: (3, [4])}))),
                ("rows upwards in tiles", array[:, ::-1], dict(tile=(16, 16), change=change_all({274: (3, [4])}))),
                ("no sample format", array, dict(change=without(339))),
                ("an untyped sample format", array, dict(change=change_all({339: (3, [4])}))),
                ("no colours", array, dict(change=without(262))),
                ("pages of a document", array, dict(change=change_all({254: (4, [2])}))),
                ("another text", array, dict(tags=text("made by hand"))),
                ("72 dpi", array, dict(tags=resolution(72, 72, 2)))):
            with self.subTest(name):
                self.check(self.save(array, **options), wanted)

    def test_streams_of_deflate(self):
        """A last strip may be as long as the others, and bits may be reversed."""
        array = labels("u2", (3, 12, 20))
        longer = np.concatenate((array, array[:, :3]), axis=1)
        self.check(self.save(longer, compression="Deflate", change=change_all({257: (4, [12])})), array)
        reverse = bytes(int(format(byte, "08b")[::-1], 2) for byte in range(256))
        path = self.save(array, compression="Deflate", rows=12, change=change_all({266: (3, [2])}))
        file = path.read_bytes()
        for packed in map(zlib.compress, map(np.ndarray.tobytes, array)):
            self.assertIn(packed, file)
            file = file.replace(packed, packed.translate(reverse))
        path.write_bytes(file)
        self.check(path, array)

    def test_lerc(self):
        """Whether numbers are changed is a choice of the writer."""
        array = np.full((3, 12, 20), 4, "u1")

        def lerc(data):
            unsigned8, largest_error = 1, 0.5
            return b"Lerc2 " + struct.pack("<7i3di", 2, 12, 20, 240, 8, 62, unsigned8, largest_error, 4, 4, 0)

        with unittest.mock.patch.dict(COMPRESSIONS, LERC=(34887, lerc)):
            path = self.save(array, compression="LERC", rows=12)
        if "which this libtiff cannot read" in self.reader(path).GetErrorMessage():
            self.skipTest("libtiff without LERC")
        self.check(path, array, warnings=(UNKNOWN, "compressed with LERC, which may change numbers"))

    def test_pyramids(self):
        """Reduced images and masks are no slices."""
        array = labels("u2")
        for tag, kind, value in ((254, 4, 1), (254, 4, 4), (254, 4, 5)):
            with self.subTest(tag=tag, value=value):
                def change(number, entries):
                    if number % 2:
                        entries[tag] = kind, [value]

                pages = [page for full in array for page in (full, full[::2, ::2])]
                self.check(self.save(pages, change=change), array)

    def test_pages_that_differ(self):
        first = labels("u1", (12, 20))
        for name, other in (("width", first[:, :10]), ("length", first[:11]), ("bits", first.astype("u2")),
                            ("sign", first.astype("i1"))):
            with self.subTest(name):
                size = "%d x %d" % other.shape[::-1]
                self.refused("pages differ: page 3 is " + size + ", .*the first is 20 x 12, unsigned integers of 8",
                             self.save([first, first, other]))

    def test_refused(self):
        array = labels("u1")
        for pattern, tags in (
                ("3 components a voxel", {277: (3, [3]), 258: (3, [8, 8, 8]), 262: (3, [2]), 339: (3, [1, 1, 1])}),
                ("2 components a voxel", {277: (3, [2]), 258: (3, [8, 8]), 339: (3, [1, 1])}),
                ("colours of a palette", {262: (3, [3]), 320: (3, [0] * 768)}),
                ("its numbers are colours", {262: (3, [32803])}),
                ("integers of 4 bits; voxplex reads", {258: (3, [4])}),
                ("integers of 12 bits", {258: (3, [12])}),
                ("integers of 24 bits", {258: (3, [24])}),
                ("floating-point numbers of 16 bits", {258: (3, [16]), 339: (3, [3])}),
                ("complex numbers of 64 bits", {258: (3, [64]), 339: (3, [6])}),
                ("several slices each", {32997: (4, [3])}),
                ("mirrored or turned .Orientation 6", {274: (3, [6])}),
                ("compressed with a method that is unknown, 34712", {259: (3, [34712])}),
                ("compressed with LERC|truncated or damaged", {259: (3, [34887])})):
            with self.subTest(pattern):
                self.refused(pattern, self.save(array, change=change_all(tags)))
        self.refused("it is a picture of one slice", self.save(array[:1]))
        self.refused("it is a picture of one slice", self.save(array[:1], tags=text("ImageJ=1.53\nimages=1\n")))
        self.refused("no page that is not a reduced", self.save(array, change=change_all({254: (4, [1])})))


class Descriptions(TIFFTestCase):
    """Which page is which slice, and how large voxels are."""
    ARRAY = labels("u2", (6, 12, 20))
    MOVING = ARRAY.reshape(2, 3, 12, 20)
    ACROSS = np.moveaxis(ARRAY.reshape(3, 2, 12, 20), 0, 1)  # pages of one slice, all frames, before those of the next

    def described(self, description, *more, **options):
        return self.save(options.pop("pages", self.ARRAY), tags={**text(description), **dict(more)}, **options)

    def test_imagej(self):
        def lines(*fields):
            return "\n".join(("ImageJ=1.53t", "images=6", *fields, ""))

        half, none, inch = resolution(2, 4, 1), resolution(1, 1, 1), resolution(72, 72, 2)
        box = 0.5, 0.25, 1.5
        for name, description, scale, wanted, warnings, more in (
                ("slices", lines("slices=6", "unit=micron", "spacing=1.5"), half, self.ARRAY, (MICRONS,),
                 dict(spacing=box)),
                ("no counts", lines("unit=mm", "spacing=-1.5"), half, self.ARRAY, (), dict(spacing=box)),
                ("escaped unit", lines("slices=6", "unit=\\u00B5m", "spacing=1.5"), half, self.ARRAY, (MICRONS,),
                 dict(spacing=box)),
                ("Latin-1 unit", lines("unit=\xB5m", "spacing=1.5").encode("latin-1"), half, self.ARRAY, (MICRONS,),
                 dict(spacing=box)),
                ("other unit", lines("unit=furlong", "spacing=1.5"), half, self.ARRAY, ("in 'furlong', and so is",),
                 dict(spacing=box)),
                ("no unit", lines("spacing=1.5"), half, self.ARRAY, ("lengths have no unit",), dict(spacing=box)),
                ("unit of an axis", lines("unit=micron", "zunit=nm", "spacing=1500"), half, self.ARRAY, (MICRONS,),
                 dict(spacing=box)),
                ("units that cannot be compared", lines("unit=micron", "zunit=parsec", "spacing=1.5"), half, self.ARRAY,
                 (r"units 'micron' and 'parsec', .*SetSpacing\(\)", MICRONS), dict(spacing=box)),
                ("an axis in pixels", lines("unit=micron", "zunit=pixel", "spacing=1.5"), half, self.ARRAY,
                 (r"units 'micron' and 'pixel', .*SetSpacing\(\)", MICRONS), dict(spacing=box)),
                ("inches", lines("unit=inch", "spacing=1.5"), resolution(2, 4, 2), self.ARRAY, ("in inches",),
                 dict(spacing=box)),
                ("no distance", lines("unit=mm"), half, self.ARRAY,
                 (r"along z, which is taken to be 1: .*SetSpacing\(\)",),
                 dict(spacing=(0.5, 0.25, 1))),
                ("a unit alone", lines("unit=mm"), {}, self.ARRAY, (UNKNOWN,), {}),
                ("pixels", lines("unit=pixel"), none, self.ARRAY, (UNKNOWN,), {}),
                ("nothing", lines(), none, self.ARRAY, (UNKNOWN,), {}),
                ("a print", lines(), inch, self.ARRAY, (UNKNOWN,), {}),
                ("origin", lines("unit=mm", "spacing=1.5", "xorigin=10", "yorigin=-4", "zorigin=2"), half, self.ARRAY,
                 (),
                 dict(spacing=box, origin=(-5, 1, -3))),
                ("frames", lines("slices=3", "frames=2", "unit=mm", "spacing=1.5", "finterval=0.1"), half, self.MOVING,
                 (),
                 dict(spacing=box, time_step=0.1)),
                ("milliseconds", lines("slices=3", "frames=2", "unit=mm", "spacing=1.5", "finterval=0.1", "tunit=ms"), half,
                 self.MOVING, (TIMES % "ms",), dict(spacing=box, time_step=0.1)),
                ("seconds", lines("slices=3", "frames=2", "unit=mm", "spacing=1.5", "finterval=0.1", "tunit=sec"), half,
                 self.MOVING, (), dict(spacing=box, time_step=0.1)),
                ("milliseconds of one frame", lines("slices=6", "unit=mm", "spacing=1.5", "finterval=0.1", "tunit=ms"), half,
                 self.ARRAY, (), dict(spacing=box)),
                ("frames without a time", lines("slices=3", "frames=2", "unit=mm", "spacing=1.5"), half, self.MOVING,
                 (NO_TIME,), dict(spacing=box)),
                ("an offset of grey",
                 lines("unit=mm", "spacing=1.5", "cf=0", "c0=-32768.0", "c1=1.0", "vunit=gray value"), half,
                 self.ARRAY.astype("i4") - 32768, (), dict(spacing=box, dtype="i2")),
                ("a calibration of grey", lines("unit=mm", "spacing=1.5", "cf=0", "c0=5", "c1=2"), half, self.ARRAY,
                 ("calibration of grey values is not applied",), dict(spacing=box))):
            for order in "<>":
                with self.subTest(name, order=order):
                    self.check(self.described(description, *scale.items(), order=order), wanted, warnings=warnings,
                               **more)
        palette = {262: (3, [3]), 320: (3, [0] * 768)}
        array = self.ARRAY.astype("u1")
        self.check(self.described(lines(), pages=array, change=change_all(palette)), array)
        for pattern, fields in (("it has 2 channels", ("channels=2", "slices=3")),
                                ("2 channels x 3 slices|it has 2 channels", ("channels=2", "frames=3")),
                                ("says 4 slices x 2 frames, and the file has 6 pages", ("slices=4", "frames=2")),
                                ("its 6 pages are frames in time, of one slice each", ("frames=6",)),
                                ("has 'six' for slices", ("slices=six",)),
                                ("has 0 for slices", ("slices=0",)),
                                ("y axis runs upwards", ("inverty=true",)),
                                ("spacing", ("unit=mm", "spacing=nan")),
                                ("time from frame to frame", ("slices=3", "frames=2", "finterval=-1"))):
            with self.subTest(pattern):
                self.refused(pattern, self.described(lines(*fields), *half.items()))
        self.refused("description says .*8 slices, and the file has 6 pages",
                     self.described("ImageJ=1.53t\nimages=8\nslices=8\n"))

    def test_imagej_with_one_directory(self):
        """What ImageJ writes from 4 GB on: all pages follow the first."""
        for dtype, order in itertools.product(("u1", "u2", "f4"), "<>"):
            with self.subTest(dtype, order=order):
                array = labels(dtype, (6, 12, 20))
                whole = np.concatenate(array).astype(array.dtype.newbyteorder(order))
                path = self.save([whole], order=order, rows=len(whole), change=change_all({
                    257: (4, [12]), 278: (4, [12]), 279: (4, [12 * 20 * array.itemsize]),
                    **text("ImageJ=1.53\nimages=6\nslices=3\nframes=2\n")}))
                self.check(path, array.reshape(2, 3, 12, 20), warnings=(UNKNOWN, NO_TIME))
        short = path.read_bytes().replace(b"images=6\nslices=3\nframes=2", b"images=60\nslices=20\nframes=3", 1)
        path.write_bytes(short)
        self.refused("truncated or damaged", path)
        for options in (dict(compression="Deflate"), dict(tile=(16, 16))):
            self.refused("description says 6 pages, and it holds 1",
                         self.described("ImageJ=1.53\nimages=6\n", pages=self.ARRAY[:1], **options))

    def test_scifio(self):
        description = ("SCIFIO=0.37\naxes=X,Y,%s\nlengths=20,12,%s\nscales=0.5,0.25,%s\nunits=micron,micron,%s\n"
                       "images=6\n")
        for name, values, wanted, more in (
                ("slices", ("Z", "6", "1.5", "micron"), self.ARRAY, {}),
                ("frames", ("Z,Time", "3,2", "1.5,0.1", "micron,sec"), self.MOVING, dict(time_step=0.1)),
                ("slices of frames", ("Time,Z", "2,3", "0.1,1.5", "sec,micron"), self.ACROSS, dict(time_step=0.1)),
                ("hours", ("Z,Time", "3,2", "1.5,0.1", "micron,hour"), self.MOVING, dict(
                    time_step=0.1, warnings=(MICRONS, TIMES % "hour")))):
            with self.subTest(name):
                self.check(self.described(description % values), wanted, spacing=(0.5, 0.25, 1.5),
                           **{"warnings": (MICRONS,), **more})
        for more in ("scales=1.0,1.0,1.0\nunits=null,null,null\n", "units=um,um,um\n"):
            self.check(self.described("SCIFIO=0.37\naxes=X,Y,Z\nlengths=20,12,6\n" + more), self.ARRAY)
        self.refused("it has 2 channels", self.described(description % ("Channel,Z", "2,3", "1,1", "null,um")))
        self.refused("2 pages along its axis 'Lifetime'",
                     self.described(description % ("Lifetime,Z", "2,3", "1,1", "null,um")))
        self.refused("no stack of pages", self.described("SCIFIO=0.37\naxes=Y,X,Z\nlengths=12,20,6\n"))

    OME = ('<?xml version="1.0" encoding="UTF-8"?>'
           '<OME xmlns="http://www.openmicroscopy.org/Schemas/OME/2016-06" UUID="urn:uuid:1"><Image ID="Image:0">'
           '<Pixels ID="Pixels:0" DimensionOrder="%s" Type="uint16" SizeX="20" SizeY="12" SizeC="1" SizeZ="%d" '
           'SizeT="%d" PhysicalSizeX="0.5" PhysicalSizeY="0.25" PhysicalSizeZ="1.5" %s>%s</Pixels></Image></OME>')

    def test_ome(self):
        def data(*places, uuid=""):
            return "".join('<TiffData %s>%s</TiffData>' % (place, uuid) for place in places)

        step = 'TimeIncrement="0.1"'
        own = '<UUID FileName="old-name.ome.tif">urn:uuid:1</UUID>'
        nm = step + "".join(' PhysicalSize%sUnit="%s"' % pair for pair in (("X", "nm"), ("Y", "nm"), ("Z", "\u00B5m")))
        shuffled = [4, 2, 0, 5, 1, 3]
        planes = data(*('IFD="%d" FirstZ="%d" FirstT="%d" PlaneCount="1"' % (ifd, n % 3, n // 3)
                        for n, ifd in enumerate(shuffled)), uuid=own)
        box = 0.5, 0.25, 1.5
        for name, values, wanted, warnings, more in (
                ("slices", ("XYCZT", 6, 1, "", ""), self.ARRAY, (MICRONS,), {}),
                ("one TiffData", ("XYCZT", 6, 1, "", "<TiffData/>"), self.ARRAY, (MICRONS,), {}),
                ("frames", ("XYCZT", 3, 2, step, data('IFD="0" PlaneCount="6"')), self.MOVING, (MICRONS,),
                 dict(time_step=0.1)),
                ("frames first", ("XYTCZ", 3, 2, step, "<TiffData/>"), self.ACROSS, (MICRONS,), dict(time_step=0.1)),
                ("frames without a time", ("XYZTC", 3, 2, "", "<TiffData/>"), self.MOVING, (MICRONS, NO_TIME), {}),
                ("any order of pages", ("XYZCT", 3, 2, step, planes), self.ARRAY[shuffled].reshape(2, 3, 12, 20),
                 (MICRONS,), dict(time_step=0.1)),
                ("nanometres and micrometres", ("XYZCT", 3, 2, nm, ""), self.MOVING, ("in nanometres",),
                 dict(spacing=(0.5, 0.25, 1500), time_step=0.1)),
                *((f"times in {unit}", ("XYZCT", 3, 2, f'{step} TimeIncrementUnit="{unit}"', ""), self.MOVING,
                   (MICRONS,) + (() if unit == "s" else (TIMES % unit,)), dict(time_step=0.1)) for unit in ("s", "ms", "min", "h")),
                *((f"z in {unit}", ("XYZCT", 6, 1, f'PhysicalSizeZUnit="{unit}"', ""), self.ARRAY,
                   (() if factor else (fr"units 'um' and '{unit}', .*SetSpacing\(\)",)) + (MICRONS,),
                   dict(spacing=(0.5, 0.25, 1.5 * (factor or 1)))) for unit, factor in (
                       ("nm", 1e-3), ("pm", 1e-6), ("\u00C5", 1e-4), ("mm", 1e3), ("dm", 1e5), ("in", 25400.0), ("thou", 25.4),
                       ("pixel", None), ("reference frame", None), ("ly", None))),
                ("millimetres", ("XYZCT", 6, 1, nm.replace("nm", "mm").replace("\u00B5m", "mm"), ""), self.ARRAY, (),
                 {})):
            with self.subTest(name):
                self.check(self.described(self.OME % values), wanted, warnings=warnings, **{"spacing": box, **more})
        with self.subTest("a prefix"):
            description = (self.OME % ("XYZCT", 6, 1, "", "")).replace("xmlns=", "xmlns:OME=")
            prefixed = re.sub(r"<(/?)(?=[A-Z])", r"<\1OME:", description)
            self.check(self.described(prefixed), self.ARRAY, spacing=box, warnings=(MICRONS,))
        with self.subTest("a pyramid"):
            pages = [page for full in self.ARRAY for page in (full, full[::2, ::2])]
            places = data(*('IFD="%d" FirstZ="%d"' % (2 * n, n) for n in range(6)))
            path = self.described(self.OME % ("XYZCT", 6, 1, "", places), pages=pages,
                                  change=lambda number, entries: entries.update({254: (4, [number % 2])}))
            self.check(path, self.ARRAY, spacing=box, warnings=(MICRONS,))
        with self.subTest("annotations"):
            other = "<XMLAnnotation><Value><A><Image/><Pixels SizeX='9'/></A></Value></XMLAnnotation><UUID>9</UUID>"
            annotations = "<StructuredAnnotations>%s</StructuredAnnotations>" % other
            whole = self.OME % ("XYZCT", 6, 1, "", "<TiffData/>")
            for place in ("<Image ", "</OME>"):
                self.check(self.described(whole.replace(place, annotations + place)), self.ARRAY, spacing=box,
                           warnings=(MICRONS,))
        with self.subTest("no sizes"):
            self.check(self.described(re.sub(r'PhysicalSize.="[0-9.]+"', "", self.OME % ("XYZCT", 6, 1, "", ""))),
                       self.ARRAY)

    def test_ome_refused(self):
        whole = self.OME % ("XYZCT", 6, 1, "", "<TiffData/>")
        other = '<TiffData IFD="0"><UUID FileName="other.ome.tif">urn:uuid:2</UUID></TiffData>'
        for pattern, description in (
                ("says 5 slices, and the file has 6 pages", whole.replace('SizeZ="6"', 'SizeZ="5"')),
                ("it has 2 channels", whole.replace('SizeC="1"', 'SizeC="2"').replace('SizeZ="6"', 'SizeZ="3"')),
                ("say 21 x 12 voxels a page, and its pages have 20 x 12", whole.replace('SizeX="20"', 'SizeX="21"')),
                ("in another file, 'other.ome.tif'", whole.replace("<TiffData/>", other)),
                ("in another file, 'set.companion.ome'",
                 '<OME><BinaryOnly MetadataFile="set.companion.ome" UUID="urn:uuid:3"/></OME>'),
                ("it holds 2 images", whole.replace("</OME>", '<Image><Pixels SizeX="20"/></Image></OME>')),
                ("it holds 0 images", "<OME/>"),
                ("one page to each slice and frame",
                 whole.replace("<TiffData/>", '<TiffData IFD="0" PlaneCount="5"/>')),
                ("one page to each slice and frame",
                 whole.replace("<TiffData/>", '<TiffData IFD="1" PlaneCount="6"/>')),
                ("one page to each slice and frame",
                 whole.replace("<TiffData/>", '<TiffData/><TiffData FirstZ="2" IFD="3"/>')),
                ("one page to each slice and frame",
                 whole.replace("<TiffData/>", '<TiffData FirstZ="6" IFD="0" PlaneCount="0"/>')),
                ("DimensionOrder 'XYZZT'", whole.replace("XYZCT", "XYZZT")),
                ("has '1,5' for PhysicalSizeZ", whole.replace('Z="1.5"', 'Z="1,5"')),
                ("spacing", whole.replace('Z="1.5"', 'Z="0"')),
                ("OME metadata are damaged: .* in line 1", whole[:-9]),
                ("document type", whole.replace("<OME", '<!DOCTYPE OME [<!ENTITY a SYSTEM "/etc/hostname">]><OME', 1))):
            with self.subTest(pattern):
                self.refused(pattern, self.described(description))

    def test_tifffile_shapes(self):
        for description, wanted, warnings in (
                ('{"shape": [6, 12, 20]}', self.ARRAY, (UNKNOWN,)),
                ('{"shape": [1, 6, 12, 20]}', self.ARRAY, (UNKNOWN,)),
                ('{"shape": [6, 12, 20, 1]}', self.ARRAY, (UNKNOWN,)),
                ('{"shape": [1, 1, 6, 12, 20, 1]}', self.ARRAY, (UNKNOWN,)),
                ('{"shape": [12, 20, 1]}', self.ARRAY, (UNKNOWN,)),
                ('{"axes": "TZYXS", "shape": [2, 3, 12, 20, 1]}', self.MOVING, (UNKNOWN, NO_TIME)),
                ('{"axes": "TZYX", "shape": [2, 3, 12, 20]}', self.MOVING, (UNKNOWN, NO_TIME)),
                ('{"shape": [3, 2, 12, 20], "axes": "ZTYX"}', self.ACROSS, (UNKNOWN, NO_TIME)),
                ('{"shape": [12, 20]}', self.ARRAY, (UNKNOWN,)),
                ('{"colour": "red"}', self.ARRAY, (UNKNOWN,))):
            with self.subTest(description):
                self.check(self.described(description), wanted, warnings=warnings)
        for pattern, description in (("4 axes without names .2, 3, 12, 20", '{"shape": [2, 3, 12, 20]}'),
                                     ("it has 2 channels", '{"shape": [2, 3, 12, 20], "axes": "CZYX"}'),
                                     ("3 pages along its axis 'Q'", '{"shape": [2, 3, 12, 20], "axes": "ZQYX"}'),
                                     ("says 5 slices, and the file has 6 pages", '{"shape": [5, 12, 20]}')):
            with self.subTest(pattern):
                self.refused(pattern, self.described(description))

    @unittest.skipUnless(tifffile, "there is no tifffile")
    def test_tifffile(self):
        """What other people's code writes."""
        array = self.MOVING
        path = self.folder / "i.tif"
        box = 0.5, 0.25, 1.5
        scale = dict(PhysicalSizeX=0.5, PhysicalSizeY=0.25, PhysicalSizeZ=1.5)
        for name, voxels, warnings, more, options in (
                ("ImageJ", array, (MICRONS,), dict(spacing=box, time_step=0.1),
                 dict(imagej=True, resolution=(2, 4),
                      metadata=dict(axes="TZYX", unit="um", spacing=1.5, finterval=0.1))),
                ("OME", array, (MICRONS,), dict(spacing=box, time_step=0.1),
                 dict(ome=True, metadata=dict(axes="TZYX", TimeIncrement=0.1, **scale))),
                ("OME, slices first", np.moveaxis(array, 0, 1), (MICRONS, NO_TIME), dict(spacing=box),
                 dict(ome=True, metadata=dict(axes="ZTYX", **scale))),
                ("OME, big", array[0], (MICRONS,), dict(spacing=box),
                 dict(ome=True, bigtiff=True, tile=(16, 16), metadata=dict(axes="ZYX", **scale))),
                ("plain", array[0], (UNKNOWN,), {}, {}),
                ("named axes", array, (UNKNOWN, NO_TIME), {},
                 dict(metadata=dict(axes="TZYX"), photometric="minisblack")),
                ("no metadata", array[0], (UNKNOWN,), {}, dict(metadata=None)),
                ("compressed", array[0], (UNKNOWN,), {}, dict(compression="zlib", predictor=True))):
            for order in "<>" if "ImageJ" != name else ">":
                with self.subTest(name, order=order):
                    tifffile.imwrite(path, voxels, byteorder=order, **{"photometric": "minisblack", **options})
                    wanted = np.moveaxis(voxels, 0, 1) if "slices first" in name else voxels
                    self.check(path, wanted, warnings=warnings, **more)


class Folders(TIFFTestCase):
    """A file for each slice."""
    ARRAY = labels("u2", (12, 12, 20))
    TOLD = (r"a folder of slices, .*SetSpacing\(\)",)

    def slices(self, array, name="s_%d.tif", **options):
        for old in self.folder.iterdir():
            old.unlink()
        for n, page in enumerate(array):
            write(self.folder / (name % n), page[None], **options)
        return self.folder

    def test_read(self):
        """In the order of numbers, whatever else is there."""
        for n, dtype in enumerate(DTYPES):
            array = labels(dtype, (12, 12, 20))
            options = dict(order="<>"[n % 2], big=n % 3 == 1, compression=list(COMPRESSIONS)[n % len(COMPRESSIONS)], tile=(16, 16) if n % 4 else None)
            folder = self.slices(array, ("s_%d.tif", "s%04d.TIFF", "%d.tif", "scan2_%d_rec.tif")[n % 4], **options)
            (folder / ".hidden.tif").write_bytes(b"x")
            (folder / "scan.log").write_text("x")
            self.check(folder, array, warnings=self.TOLD)
        self.read(folder, Spacing=(0.01, 0.01, 0.02))
        self.check(self.slices(self.ARRAY[::2], "%d.tif"), self.ARRAY[::2], warnings=self.TOLD)
        steps = self.slices(self.ARRAY)
        for n in range(1, 12, 2):
            (steps / f"s_{n}.tif").unlink()
        self.check(steps, self.ARRAY[::2], warnings=self.TOLD)
        self.check(self.slices(self.ARRAY > 2), self.ARRAY > 2, warnings=self.TOLD, dtype="u1")
        names = self.slices(self.ARRAY[:3], "x%d.tif")
        for n, letter in enumerate("abc"):
            (names / f"x{n}.tif").rename(names / f"{letter}.tif")
        self.check(names, self.ARRAY[:3], warnings=self.TOLD)

    def test_refused(self):
        folder = self.slices(self.ARRAY)
        (folder / "s_5.tif").unlink()
        self.refused("slices are missing, or numbered twice: 's_6.tif' follows 's_4.tif', and other numbers are 1 apart", folder)
        for page, pattern in ((self.ARRAY[0, :5], "its slices differ: 's_3.tif' has 20 x 5 voxels of 2 bytes, and 's_0.tif' 20 x 12 of 2"),
                              (self.ARRAY[0].astype("u1"), "its slices differ: 's_3.tif' has 20 x 12 voxels of 1 bytes"),
                              (self.ARRAY[0].astype("i2"), "its slices differ")):
            write(self.slices(self.ARRAY) / "s_3.tif", page[None])
            self.refused(pattern, folder)
        write(self.slices(self.ARRAY) / "s_3.tif", self.ARRAY)
        self.refused("'s_3.tif': it has 12 pages, .*: if each is a mask, give the files one by one", folder)
        (self.slices(self.ARRAY) / "s_3.tif").write_bytes(b"x")
        self.refused("'s_3.tif': it is no TIFF or PNG file", folder)
        path = self.slices(self.ARRAY) / "s_3.tif"
        path.write_bytes(path.read_bytes()[:300])
        self.refused("'s_3.tif': it is truncated or damaged", folder)
        self.refused("it holds one slice, 's_0.tif'", self.slices(self.ARRAY[:1]))
        self.refused("holds no DICOM images, no slices", self.slices(()))

    def test_among_others(self):
        """DICOM and volumes come first."""
        folder = self.slices(self.ARRAY)
        images.write_nrrd(folder / "mask.nrrd", (self.ARRAY > 2).astype("u1"))
        reader = self.reader(folder)
        self.assertEqual(reader.GetErrorMessage(), "")
        self.assertRegex(" ".join(warnings_of(reader)), "left out what is no image, or a mask only if it is named: s_0.tif, s_1.tif, s_2.tif")


def png(path, page, bits=8, colours=0, interlace=0, damage=bytes):
    """One slice, by the standard (w3.org/TR/png)."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    def packed(part):
        digits = "".join(format(int(n), f"0{bits}b") for n in np.ravel(part))
        return bytes(int(digits[at:at + 8].ljust(8, "0"), 2) for at in range(0, len(digits), 8))

    # Adam7: the first row and column of each pass, and the steps
    passes = ((0, 0, 8, 8), (0, 4, 8, 8), (4, 0, 8, 4), (0, 2, 4, 4), (2, 0, 4, 2), (0, 1, 2, 2), (1, 0, 2, 1))
    parts = [page[y::dy, x::dx] for y, x, dy, dx in passes] if interlace else [page]
    data = b"".join(b"\0" + packed(row) for part in parts if part.size for row in part)
    path.write_bytes(damage(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(
        ">2I5B", page.shape[1], page.shape[0], bits, colours, 0, 0, interlace)) + chunk(b"gAMA", struct.pack(">I", 45455)) + (
        chunk(b"PLTE", bytes(768)) if colours == 3 else b"") + chunk(b"IDAT", zlib.compress(data)) + chunk(b"IEND", b"")))


class FoldersOfPNG(TIFFTestCase):
    def test_read(self):
        """The numbers that are stored, whatever a viewer makes of them."""
        for bits, interlace in itertools.product((1, 2, 4, 8, 16), (0, 1)):
            array = np.random.default_rng(3).integers(0, 2**bits, (12, 9, 13)).astype("u2" if bits > 8 else "u1")
            for n, page in enumerate(array):
                png(self.folder / f"s{n}.png", page, bits, interlace=interlace)
            self.check(self.folder, array, warnings=Folders.TOLD)
        self.read(self.folder, Spacing=(0.1, 0.1, 0.2))

    @unittest.skipUnless(PIL, "there is no PIL (apt-get install python3-pil)")
    def test_of_pil(self):
        for dtype in ("u1", "u2", "?"):
            array = np.random.default_rng(3).integers(0, 2, (3, 40, 50)).cumsum(axis=2).astype(dtype)
            for n, page in enumerate(array):
                PIL.Image.fromarray(page).save(self.folder / f"s{n}.png")
            self.check(self.folder, array, warnings=Folders.TOLD, dtype="u1" if dtype == "?" else dtype)

    def test_refused(self):
        page = labels("u1")[0]
        for n in range(3):
            png(self.folder / f"s{n}.png", page)
        path = self.folder / "s1.png"
        for pattern, options in (("stand for colours of a palette", {"colours": 3}), ("its numbers are colours", {"colours": 2}),
                                 ("alpha", {"colours": 4}), ("truncated or damaged", {"damage": lambda f: f[:-20]}),
                                 ("truncated or damaged", {"damage": lambda f: f[:90] + bytes([f[90] ^ 1]) + f[91:]}),
                                 ("no TIFF or PNG", {"damage": lambda f: f[1:]}),
                                 ("it claims 1000000 x 900000", {"damage": lambda f: f[:16] + struct.pack(">2I", 1000000, 900000) +
                                  f[24:29] + struct.pack(">I", zlib.crc32(f[12:16] + struct.pack(">2I", 1000000, 900000) +
                                                                         f[24:29])) + f[33:]})):
            png(path, page, **options)
            self.refused("'s1.png': .*" + pattern, self.folder)
        png(path, page[:5])
        self.refused("its slices differ: 's1.png' has 20 x 5 voxels", self.folder)
        write(self.folder / "s1.tif", page[None])
        self.refused("files of TIFF and of PNG", self.folder)


class Damage(TIFFTestCase):
    ARRAY = labels("u2", (3, 12, 20))

    def test_cut(self):
        """A file that ends anywhere is never an image."""
        for big, tile, compression in itertools.product((False, True), (None, (16, 16)),
                                                        ("none", "LZW", "Deflate", "PackBits")):
            whole = self.save(self.ARRAY, big=big, tile=tile, compression=compression).read_bytes()
            for length in range(8, len(whole), len(whole) // 9):
                with self.subTest(big=big, tile=tile, compression=compression, length=length):
                    (self.folder / "i.tif").write_bytes(whole[:length])
                    self.refused("truncated or damaged: page [1-4]", self.folder / "i.tif")

    def test_parts(self):
        for pattern, change in (
                (r"page 2 \(its strip or tile 3 has 79 bytes .*80 are needed",
                 change_second({279: (4, [200, 200, 79])})),
                (r"page 2 \(its strip or tile 3 has 80 bytes from byte 9999",
                 change_second({273: (4, [8, 300, 9999])})),
                ("page 2", change_second({273: (4, [8, 300, 0])})),
                ("page 2", change_second({279: (4, [0, 200, 80])})),
                ("page 2", change_second({273: (4, [8])})),
                ("page 2", change_second({278: (4, [0])})),
                ("page 2", change_second({339: (2, b"abc\0")})),
                (r'page 2 .*"Orientation"', change_second({274: (4, [1, 1])})),
                ("pages differ|damaged: page 2", change_second({257: (4, [4000000000])})),
                ("it claims 20 x 2000000000, .* and the file has",
                 change_all({257: (4, [2000000000]), 278: (4, [2000000000])})),
                ("strips or tiles of 20 x 1|damaged", change_all({257: (4, [2000000000]), 278: (4, [1])})),
                ("damaged: page 1", change_all({322: (4, [0]), 323: (4, [0])})),
                ("damaged", change_all({322: (4, [2**31]), 323: (4, [2**31]), 324: (4, [8]), 325: (4, [9])}))):
            with self.subTest(pattern):
                self.refused(pattern, self.save(self.ARRAY, change=change))

    def test_compressed_parts(self):
        """A part that decodes to less than it should, or not at all."""
        for compression, (_, compress) in COMPRESSIONS.items():
            if compression == "none":
                continue
            with self.subTest(compression):
                whole = self.save(self.ARRAY, compression=compression, rows=12).read_bytes()
                sound = compress(self.ARRAY[1].tobytes())
                self.assertIn(sound, whole)
                short = compress(self.ARRAY[1, :11].tobytes())
                for damaged in (short.ljust(len(sound), b"\0") if len(short) <= len(sound) else sound[:9],
                                sound[:40] + bytes(len(sound) - 40)):
                    (self.folder / "i.tif").write_bytes(whole.replace(sound,
                                                                      damaged[:len(sound)].ljust(len(sound), b"\0")))
                    if compression != "PackBits" or damaged is not short:
                        self.refused("truncated or damaged: page 2", self.folder / "i.tif")

    def test_checksums(self):
        """Deflate: a stream ends with a checksum, within its part, also if it is longer than the part needs."""
        for name, damaged in (("wrong", lambda data: zlib.compress(data)[:-4] + b"none"),
                              ("missing", lambda data: zlib.compress(data)[:-4]),
                              ("cut", lambda data: zlib.compress(data)[:-1]),
                              ("wrong, longer", lambda data: zlib.compress(2 * data)[:-4] + b"none"),
                              ("missing, longer", lambda data: zlib.compress(2 * data)[:-4])):
            for code, tile in itertools.product((8, 32946), (None, (16, 16))):
                with self.subTest(name, code=code, tile=tile):
                    with unittest.mock.patch.dict(COMPRESSIONS, damaged=(code, damaged)):
                        path = self.save(self.ARRAY, compression="damaged", tile=tile)
                    self.refused("truncated or damaged: page 1", path)

    def test_sparse(self):
        """Parts that are left out on purpose are no damage."""
        def leave_out(_, entries):
            for tag in (324, 325) if tile else (273, 279):
                entries[tag][1][1] = 0

        for tile in None, (16, 16):
            self.refused("^[^(]*sparse file, which leaves out strip or tile 2 of page 1: save it with all",
                         self.save(self.ARRAY, tile=tile, change=leave_out))

    def test_circles(self):
        for loop in range(3):
            self.refused("damaged: page 4", self.save(self.ARRAY, loop=loop))

    def test_many_pages(self):
        """More than anyone has: a message within seconds."""
        entries = {256: 1, 257: 1, 258: 8, 259: 1, 262: 1, 273: 8, 277: 1, 278: 1, 279: 1}
        body = b"".join(struct.pack("<2HIHH", tag, 3, 1, value, 0) for tag, value in entries.items())
        size = 2 + len(body) + 4
        file = bytearray(b"II*\0" + struct.pack("<I", 8))
        for n in range(200_000):
            file += struct.pack("<H", len(entries)) + body + struct.pack("<I", 8 + (n + 1) * size)
        (self.folder / "i.tif").write_bytes(file)
        self.refused("more than 100000 pages|damaged", self.folder / "i.tif")

    def test_noise(self):
        """Every file gives an image or an error, and the process lives on."""
        rng = np.random.default_rng(11)
        for options in ({}, dict(tile=(16, 16), compression="LZW"), dict(compression="Deflate", big=True)):
            whole = self.save(self.ARRAY, **options).read_bytes()
            for _ in range(40):
                damaged = bytearray(whole)
                for at in rng.integers(0, len(whole), 4):
                    damaged[at] = rng.integers(0, 256)
                (self.folder / "i.tif").write_bytes(damaged)
                reader = self.reader(self.folder / "i.tif")
                self.assertEqual(reader.GetOutput().GetNumberOfPoints() == 0, reader.GetErrorMessage() != "", damaged)


if __name__ == "__main__":
    unittest.main()
