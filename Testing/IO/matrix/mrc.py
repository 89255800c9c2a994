# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""MRC2014 and the older CCP4 maps (ccpem.ac.uk/mrc_format/mrc2014.php)."""
import struct

import numpy as np

from .images import LARGER, ORDERS, ORIGIN, SPACING, affine, combinations, gzipped, raw, title, voxels
from .rows import ANY, Files, Image, Sound, named, refused, row

# Lengths are in Angstrom. A mesh has the numbers of the file; 1e-7 would make mm of them.
ANGSTROM = 1.0
MODES = {"i1": 0, "i2": 1, "f4": 2, "u2": 6}
LAYOUT = {"size": (0, "3i"), "mode": (12, "i"), "start": (16, "3i"), "m": (28, "3i"), "cell": (40, "3f"),
          "angles": (52, "3f"),
          "map": (64, "3i"), "statistics": (76, "3f"), "ispg": (88, "i"), "nsymbt": (92, "i"), "exttyp": (104, "4s"),
          "nversion": (108, "i"), "imod_stamp": (152, "i"), "imod_flags": (156, "i"), "origin": (196, "3f"),
          "magic": (208, "4s"), "machst": (212, "4s"), "rms": (216, "f"), "nlabl": (220, "i"), "labels": (224, "800s")}


def mrc(array, file="i.mrc", order="<", extended=b"", **fields):
    size = array.shape[::-1]
    fields = {"size": size, "mode": MODES.get(array.dtype.str[1:], 99), "m": size, "cell": tuple(SPACING * size),
              "angles": (90, 90, 90), "map": (1, 2, 3), "ispg": 1, "nsymbt": len(extended), "nversion": 20140,
              "origin": tuple(ORIGIN), "magic": b"MAP ", "machst": b"DD\0\0" if order == "<" else b"\x11\x11\0\0",
              "nlabl": 1, "labels": b"a label", **fields}
    header = bytearray(1024)
    for name, value in fields.items():
        offset, form = LAYOUT[name]
        struct.pack_into(order + form, header, offset, *(value if np.ndim(value) else [value]))
    return Files(file, {file: bytes(header) + extended + raw(array, order)}, 1024 + len(extended))


ROWS = []
I2 = voxels("i2")
WHERE = affine() * ANGSTROM
WARNS = "angstrom"  # numbers are those of the file
IMAGE = Image(I2, WHERE, warns=WARNS)


def equal(name, image=IMAGE, also=(), wrap=lambda files: files, **options):
    ROWS.append(row("MRC", name, wrap(mrc(image.voxels, **options)), image, *also))


def refuse(name, words, array=I2, wrap=lambda files: files, is_broken=False, **options):
    ROWS.append(row("MRC", name, wrap(mrc(array, **options)), refused(words, is_broken)))


def turned(columns):
    """Column, row and section of the file run along these axes of space."""
    steps = np.zeros((3, 3))
    for axis, direction in enumerate(columns):
        steps[direction - 1, axis] = SPACING[direction - 1]
    return affine(steps) * ANGSTROM


PERMUTATIONS = (1, 2, 3), (1, 3, 2), (2, 1, 3), (2, 3, 1), (3, 1, 2), (3, 2, 1)
for case in combinations(type=MODES, order=ORDERS, map=PERMUTATIONS, extended=(0, 80, 1024), file=("i.mrc", "i.map")):
    array = voxels(case["type"])
    m = [array.shape[::-1][case["map"].index(direction)] for direction in (1, 2, 3)]
    equal(title(case), Image(array, turned(case["map"]), warns=WARNS), order=case["order"], map=case["map"], m=m, cell=SPACING * m,
          extended=bytes(case["extended"]), file=case["file"])

# Bytes are signed since 2014; IMOD has written both, and says which.
equal("bytes of 0 to 127, old header", Image(np.arange(60, dtype="i1").reshape(3, 4, 5), WHERE, warns=WARNS),
      [Image(np.arange(60, dtype="u1").reshape(3, 4, 5), WHERE, warns=WARNS)], nversion=0)
equal("unsigned bytes of IMOD", Image(voxels("u1"), WHERE, warns=WARNS), mode=0, imod_stamp=1146047817, imod_flags=0, nversion=0)
equal("signed bytes of IMOD, none negative", Image(voxels("i1") & 127, WHERE, warns=WARNS), mode=0, imod_stamp=1146047817, imod_flags=1, nversion=0)
equal("signed bytes of IMOD", Image(voxels("i1"), WHERE, warns="IMOD stores numbers from 0 to 255 less 128: .*newstack -mode 6"), mode=0, imod_stamp=1146047817, imod_flags=1, nversion=0)
equal("negative bytes, old header", Image(voxels("i1"), WHERE, warns="negative.*128 to 255"), nversion=0)
equal("half floats", Image(np.arange(60, dtype="f2").reshape(3, 4, 5).astype("f4"), WHERE), [refused("mode|12|half")],
      wrap=lambda f: mrc(np.arange(60, dtype="f2").reshape(3, 4, 5), mode=12))
for mode, name in ((3, "complex short"), (4, "complex float"), (5, "none"), (16, "RGB"), (101, "4 bits"), (-1, "none"),
                   (99, "none")):
    refuse("mode %d, %s" % (mode, name), "mode|type|%d|%s" % (mode, name.split()[0]), mode=mode,
           wrap=lambda f: f.with_data(f.data() + bytes(1000)))

# Place
equal("nstart without an origin", Image(I2, affine(origin=SPACING * (2, -3, 4)) * ANGSTROM, warns=ANY),
      origin=(0, 0, 0), start=(2, -3, 4))
equal("nstart of permuted axes", Image(I2, affine(turned((2, 3, 1))[:, :3] / ANGSTROM, SPACING * (4, 2, -3)) * ANGSTROM,
                                       warns=ANY),
      origin=(0, 0, 0), start=(2, -3, 4), map=(2, 3, 1), m=(3, 5, 4), cell=SPACING * (3, 5, 4))
equal("nstart beside an origin", Image(I2, WHERE, warns=ANY), [
    Image(I2, affine(origin=ORIGIN + SPACING * (2, -3, 4)) * ANGSTROM, warns=ANY)], start=(2, -3, 4))
equal("neither", Image(I2, affine(origin=(0, 0, 0)) * ANGSTROM, warns=ANY), origin=(0, 0, 0))
equal("a part of the cell", m=(10, 8, 6), cell=SPACING * (10, 8, 6))
equal("no cell", Image(I2, affine(np.eye(3)), warns="spacing.*taken to be 1"), cell=(0, 0, 0))
refuse("gzipped", "compressed by gzip.*unpack it", wrap=lambda f: f.with_data(gzipped(f.data())))
equal("no sampling, no cell", Image(I2, affine(np.eye(3)) * ANGSTROM, warns=ANY), [refused("cell|spacing|sampling")],
      m=(0, 0, 0), cell=(0, 0, 0))
equal("angles of 0", angles=(0, 0, 0), also=[refused("angle"), Image(I2, WHERE, warns=ANY)])
refuse("angles of 120", "angle", angles=(90, 90, 120))
equal("map of zeros", map=(0, 0, 0), also=[refused("axes|map"), Image(I2, WHERE, warns=ANY)])
for axes in ((1, 1, 3), (1, 2, 4), (3, 2, 2), (-1, 2, 3)):
    refuse("map of %s" % (axes,), "axes|map", map=axes)
for axes in PERMUTATIONS[1:]:  # the sampling follows the axes of space, not those of the file
    refuse("sampling of columns, rows, sections, map of %s" % (axes,), "axes.*sampling|sampling.*axes", map=axes)
equal("a part of the cell, map of (3, 2, 1)", Image(I2, turned((3, 2, 1)), warns=WARNS), map=(3, 2, 1), m=(6, 8, 10),
      cell=SPACING * (6, 8, 10))
for value in (0, -1, np.nan, np.inf):  # along one axis
    refuse("cell of %s" % value, "cell|spacing|position", cell=(1, value, 1))
for value in (np.nan, np.inf):
    refuse("origin of %s" % value, "origin|position|finite|number", origin=(0, value, 0))
for value in (0, -4):
    refuse("sampling of %d" % value, "cell|spacing|sampling|m", m=(5, value, 3))

# The rest of the header
equal("machst DA", machst=b"DA\0\0")
equal("no machst", machst=bytes(4), also=[refused("machine|stamp|order|format|not an image")])
equal("no machst, big endian", machst=bytes(4), order=">", also=[refused("machine|stamp|order|format|not an image")])
equal("no magic", magic=bytes(4), machst=bytes(4), also=[refused("format|MAP|not an image")])
equal("ispg 0, one section a slice", Image(I2, WHERE), [Image(I2, WHERE, warns=ANY), refused("stack|ispg")], ispg=0)
ROWS.append(row("MRC", "ispg 401, two volumes", mrc(voxels("i2", shape=(6, 4, 5)), ispg=401, m=(5, 4, 3),
                                                    cell=SPACING * (5, 4, 3)),
                refused("stack|volumes|ispg|401"),
                Image(voxels("i2", shape=(6, 4, 5)).reshape(2, 3, 4, 5), WHERE, (0, 1), warns=ANY)))
for size in (-80, -1, 1 << 30, (1 << 31) - 1):
    refuse("nsymbt %d" % size, ".", nsymbt=size, is_broken=size > 0)
refuse("nsymbt to the last voxel", ".", nsymbt=I2.nbytes, is_broken=True)
for sizes in ((5, 0, 3), (5, -4, 3), (-5, -4, 3), (0, 0, 0)):
    refuse("sizes %s" % (sizes,), "size|voxels|dimension", size=sizes)
for sizes in ((2147483647,) * 3, (3000,) * 3, (5, 4, 4)):
    refuse("claims %s" % (sizes,), ".", size=sizes, m=(5, 4, 3), is_broken=True)
named(equal, ("i.nii", "i.nrrd", "i.vtk", "i.rec", "i", "i.st"))

_MORE = voxels("i2", shape=LARGER)
SOUND = [Sound("MRC", "raw", mrc(_MORE), Image(_MORE, WHERE, warns=WARNS)),
         Sound("MRC", "raw", mrc(_MORE, "i.map", extended=bytes(160)), Image(_MORE, WHERE, warns=WARNS))]
