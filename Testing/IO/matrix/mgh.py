# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""FreeSurfer's MGH (FreeSurferWiki, MghFormat): a header of 284 bytes, everything in big endian, coordinates in RAS."""
import struct

import numpy as np

from .images import AXES, LARGER, ORIGIN, RAS_TO_LPS, affine, combinations, gzipped, raw, times, title, voxels
from .rows import Files, Image, Sound, named, refused, row

TYPES = {"u1": 0, "i4": 1, "f4": 3, "i2": 4, "u2": 10}
LAYOUT = {"version": (0, "i"), "sizes": (4, "4i"), "type": (20, "i"), "dof": (24, "i"), "good": (28, "h"),
          "delta": (30, "3f"), "directions": (42, "9f"), "middle": (78, "3f")}


FOOTER = struct.pack(">4f", 2300, 0.2, 3, 900)  # TR and other times of the scanner


def mgh(array, file="i.mgh", steps=AXES["oblique"], footer=FOOTER, **fields):
    """With steps in LPS, from the first voxel at ORIGIN."""
    steps = RAS_TO_LPS @ steps
    sizes = (array.shape[::-1] + (1,))[:4]
    delta = np.linalg.norm(steps, axis=0)
    fields = {"version": 1, "sizes": sizes, "type": TYPES.get(array.dtype.str[1:], 2), "good": 1, "delta": delta,
              "directions": (steps / delta).T.ravel(),
              "middle": RAS_TO_LPS @ ORIGIN + steps @ np.array(sizes[:3]) / 2, **fields}
    header = bytearray(284)
    for name, value in fields.items():
        offset, form = LAYOUT[name]
        struct.pack_into(">" + form, header, offset, *(value if np.ndim(value) else [value]))
    data = bytes(header) + raw(array, ">") + footer
    return Files(file, {file: gzipped(data) if file.endswith("z") else data}, 284)


ROWS = []
I2 = voxels("i2")
IMAGE = Image(I2, affine(AXES["oblique"]))
FRAMES = "time between its frames is taken to be 1"


def equal(name, image=IMAGE, also=(), wrap=lambda files: files, **options):
    ROWS.append(row("MGH", name, wrap(mgh(image.voxels, **options)), image, *also))


def refuse(name, words, array=I2, wrap=lambda files: files, is_broken=False, **options):
    ROWS.append(row("MGH", name, wrap(mgh(array, **options)), refused(words, is_broken)))


for case in combinations(type=TYPES, frames=(None, 3), axes=AXES, file=("i.mgh", "i.mgz")):
    image = Image(voxels(case["type"], case["frames"]), affine(AXES[case["axes"]]), times(3, 0, 1),
                  warns=FRAMES if case["frames"] else "")
    equal(title(case), image, steps=AXES[case["axes"]], file=case["file"])
COUNTS = np.array(I2.shape[::-1])
CORONAL = np.array([[1.0, 0, 0], [0, 0, -1], [0, -1, 0]])
equal("no place", Image(I2, affine(CORONAL, -CORONAL @ COUNTS / 2), warns="does not say where the image lies"), good=0)
for code, name in ((2, "long"), (5, "bits"), (6, "tensor")):
    refuse("type %d, %s" % (code, name), "type|%d" % code, type=code, wrap=lambda f: f.with_data(f.data() + bytes(1000)))
for sizes in ((2147483647,) * 4, (3000, 3000, 3000, 1), (5, 4, 4, 1), (5, 4, 3, 65535)):
    refuse("claims %s" % (sizes,), ".", sizes=sizes, is_broken=True)
for sizes in ((5, 0, 3, 1), (5, -4, 3, 1)):
    refuse("sizes %s" % (sizes,), "format|size", sizes=sizes)
for value in (0, -1, np.nan, np.inf):
    refuse("spacing %s" % value, "spacing", delta=(1, value, 1))
refuse("directions of no length", "axis 0 is 0", directions=(0,) * 9)
refuse("middle at nan", "finite|number|position|origin", middle=(0, np.nan, 0))
refuse("version 2", "format|not an image", version=2)
named(equal, ("i.nii", "i.nrrd", "i.vtk", "i.mrc", "i"))

_MORE = voxels("i2", shape=LARGER)
_IMAGE = Image(_MORE, affine(AXES["oblique"]))
SOUND = [Sound("MGH", "raw", mgh(_MORE, footer=b""), _IMAGE), Sound("MGH", "gzip", mgh(_MORE, "i.mgz", footer=b""), _IMAGE)]
