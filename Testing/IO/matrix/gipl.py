# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""GIPL: a header of 256 bytes, everything in big endian. Its coordinates are taken as LPS."""
import struct

import numpy as np

from .images import (FIRST_TIME, LARGER, ORIGIN, SPACING, TIME_STEP, affine, combinations, gzipped, raw, times, title,
                     voxels)
from .rows import ANY, Files, Image, Sound, named, refused, row

IMAGE_TYPES = {"i1": 7, "u1": 8, "i2": 15, "u2": 16, "u4": 31, "i4": 32, "f4": 64, "f8": 65}
MAGIC = 0xEFFFE9B0, 0x2AE389B8
LAYOUT = {"dim": (0, "4H"), "image_type": (8, "H"), "pixdim": (10, "4f"), "line1": (26, "80s"), "matrix": (106, "20f"),
          "flag": (186, "2B"), "min": (188, "d"), "max": (196, "d"), "origin": (204, "4d"), "pixval_offset": (236, "f"),
          "pixval_cal": (240, "f"), "user": (244, "2f"), "magic": (252, "I")}


def gipl(array, file="i.gipl", **fields):
    dim = (array.shape[::-1] + (1,))[:4]
    fields = {"dim": dim, "image_type": IMAGE_TYPES.get(array.dtype.str[1:], 0), "pixdim": (*SPACING, TIME_STEP),
              "line1": b"a patient", "origin": (*ORIGIN, FIRST_TIME), "magic": MAGIC[0], **fields}
    header = bytearray(256)
    for name, value in fields.items():
        offset, form = LAYOUT[name]
        struct.pack_into(">" + form, header, offset, *(value if np.ndim(value) else [value]))
    data = bytes(header) + raw(array, ">")
    return Files(file, {file: gzipped(data) if file.endswith(".gz") else data}, 256)


ROWS = []
I2, FOUR = voxels("i2"), voxels("i2", frames=3)
IMAGE, FRAMES = Image(I2, affine()), Image(FOUR, affine(), times(3))


def equal(name, image=IMAGE, also=(), wrap=lambda files: files, **options):
    ROWS.append(row("GIPL", name, wrap(gipl(image.voxels, **options)), image, *also))


def refuse(name, words, array=I2, wrap=lambda files: files, is_broken=False, **options):
    ROWS.append(row("GIPL", name, wrap(gipl(array, **options)), refused(words, is_broken)))


for case in combinations(type=IMAGE_TYPES, frames=(None, 3), magic=MAGIC, file=("i.gipl", "i.gipl.gz")):
    image = Image(voxels(case["type"], case["frames"]), affine(), times(3))
    equal(title(case), image, [refused(r"dimension|\b4\b|time|frames")] * bool(case["frames"]) +
          [refused("gzip|compressed")] * case["file"].endswith(".gz"), magic=case["magic"], file=case["file"])
for code, name in ((144, "complex short"), (160, "complex int"), (192, "complex float"), (193, "complex double"),
                   (200, "surface"), (201, "polygon"), (0, "none"), (99, "unknown")):
    refuse("image type %d, %s" % (code, name), "type|%d|%s" % (code, name.split()[0]), image_type=code,
           wrap=lambda f: f.with_data(f.data() + bytes(1000)))
equal("image type 1, binary", Image(voxels("u1"), affine()), [refused("type|binary")], image_type=1)
equal("dim[3] = 0", wrap=lambda f: gipl(I2, dim=(5, 4, 3, 0)))
equal("a matrix, which is not used", Image(I2, affine(), warns=ANY), matrix=tuple(range(20)))
equal("origin 0", Image(I2, affine(origin=(0, 0, 0)), warns=ANY), origin=(0, 0, 0, 0))
for sizes in ((5, 0, 3, 1), (0, 0, 0, 0)):
    refuse("sizes %s" % (sizes,), "dim|size|voxels|slice", dim=sizes)
for sizes in ((65535, 65535, 65535, 1), (5, 4, 4, 1), (65535,) * 4, (5, 4, 3, 65535)):
    refuse("claims %s" % (sizes,), ".", dim=sizes, is_broken=True)
for value in (0, np.nan, np.inf, -1):
    refuse("spacing %s" % value, "spacing|pixdim", pixdim=(1, value, 1, 1))
    if value not in (0, -1):
        refuse("origin %s" % value, "origin|position|finite|number", origin=(0, value, 0, 0))
refuse("magic 1", "format|magic|not an image", magic=1)
named(equal, ("i.nii", "i.nrrd", "i.vtk", "i.mrc", "i", "i.GIPL"))

_MORE = voxels("i2", shape=LARGER)
SOUND = [Sound("GIPL", "raw", gipl(_MORE), Image(_MORE, affine()))]
