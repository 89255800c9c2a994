# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""NIfTI-1, NIfTI-2 and ANALYZE 7.5, from nifti1.h, nifti2.h and dbh.h."""
import gzip
import struct
from dataclasses import replace

import numpy as np

from .images import (AXES, FIRST_TIME, LARGER, NOT_SHEARED, ORDERS, ORIGIN, RAS_TO_LPS, SPACING, TIME_STEP, TYPES,
                     affine, combinations, gzipped, raw, times, title, voxels)
from .rows import ANY, Fifo, Files, Folder, Image, Link, Sound, broken, refused, row

NIFTI1 = {
    "sizeof_hdr": (0, "i"), "data_type": (4, "10s"), "db_name": (14, "18s"), "extents": (32, "i"), "regular": (38, "c"),
    "dim": (40, "8h"), "intent_code": (68, "h"), "datatype": (70, "h"), "bitpix": (72, "h"), "pixdim": (76, "8f"),
    "vox_offset": (108, "f"), "scl_slope": (112, "f"), "scl_inter": (116, "f"), "xyzt_units": (123, "B"),
    "cal_max": (124, "f"), "toffset": (136, "f"), "glmax": (140, "i"), "glmin": (144, "i"), "descrip": (148, "80s"),
    "qform_code": (252, "h"), "sform_code": (254, "h"), "quatern": (256, "3f"), "qoffset": (268, "3f"),
    "srow": (280, "12f"), "intent_name": (328, "16s"), "magic": (344, "4s")}
NIFTI2 = {
    "sizeof_hdr": (0, "i"), "magic": (4, "8s"), "datatype": (12, "h"), "bitpix": (14, "h"), "dim": (16, "8q"),
    "pixdim": (104, "8d"), "vox_offset": (168, "q"), "scl_slope": (176, "d"), "scl_inter": (184, "d"),
    "toffset": (216, "d"),
    "qform_code": (344, "i"), "sform_code": (348, "i"), "quatern": (352, "3d"), "qoffset": (376, "3d"),
    "srow": (400, "12d"),
    "xyzt_units": (500, "i"), "intent_code": (504, "i")}
DATATYPES = {"u1": 2, "i2": 4, "i4": 8, "f4": 16, "f8": 64, "i1": 256, "u2": 512, "u4": 768, "i8": 1024, "u8": 1280}
MM, MICRON, METRE, SECONDS, MILLISECONDS, MICROSECONDS = 2, 3, 1, 8, 16, 24
LENGTHS = {0: 1.0, METRE: 1e3, MM: 1.0, MICRON: 1e-3}
TIMES = {MILLISECONDS: 1e-3, MICROSECONDS: 1e-6}  # in seconds; other numbers are those of the file

# ----- writing


def quaternion(rotation):
    """b, c, d of a proper rotation, with a >= 0."""
    a = 0.5 * np.sqrt(max(0.0, 1.0 + np.trace(rotation)))
    if a > 0.1:
        return np.array([rotation[2, 1] - rotation[1, 2], rotation[0, 2] - rotation[2, 0],
                         rotation[1, 0] - rotation[0, 1]]) / (4.0 * a)
    values, vectors = np.linalg.eigh(rotation + rotation.T)
    axis = vectors[:, np.argmax(values)] * np.sqrt(1.0 - a * a)
    skew = [rotation[2, 1] - rotation[1, 2], rotation[0, 2] - rotation[2, 0], rotation[1, 0] - rotation[0, 1]]
    return -axis if np.dot(axis, skew) < 0 else axis


def qform(steps, origin=ORIGIN, code=1):
    """Fields for axes at right angles, given in LPS."""
    ras, spacing = RAS_TO_LPS @ steps, np.linalg.norm(steps, axis=0)
    rotation = ras / spacing
    qfac = 1.0 if np.linalg.det(rotation) > 0 else -1.0
    return {"qform_code": code, "quatern": quaternion(rotation * (1, 1, qfac)), "qoffset": RAS_TO_LPS @ origin,
            "pixdim": (qfac, *spacing, TIME_STEP)}


def sform(steps, origin=ORIGIN, code=1):
    return {"sform_code": code, "srow": (RAS_TO_LPS @ affine(steps, origin)).ravel(),
            "pixdim": (1.0, *np.linalg.norm(steps, axis=0), TIME_STEP)}


def fields_of(array, fields):
    """All fields, those that are given replacing what a plain writer writes."""
    dim = (array.ndim, *array.shape[::-1], *[1] * (7 - array.ndim))
    default = {"sizeof_hdr": 348, "regular": b"r", "dim": dim, "datatype": DATATYPES[array.dtype.str[1:]],
               "bitpix": 8 * array.dtype.itemsize, "pixdim": (1.0, *SPACING, TIME_STEP), "vox_offset": 352.0,
               "scl_slope": 1.0, "scl_inter": 0.0, "xyzt_units": MM + SECONDS, "toffset": FIRST_TIME,
               "qform_code": 0, "sform_code": 0, "quatern": (0, 0, 0), "qoffset": (0, 0, 0), "srow": (0,) * 12,
               "magic": b"n+1"}
    return {**default, **fields}


def pack(fields, order="<", layout=NIFTI1, length=348):
    header = bytearray(length)
    for name, value in fields.items():
        offset, form = layout[name]
        values = list(value) if np.ndim(value) else [value]
        count = int(form[:-1] or 1) if form[-1] in "hfdq" else 1
        struct.pack_into(order + form, header, offset, *(values + [0] * (count - len(values)) if count > 1 else values))
    return bytes(header)


def nifti(array, file="i.nii", order="<", extension=b"", **fields):
    """A single file, or a pair if its name ends in .hdr; .gz compresses."""
    fields, pair = fields_of(array, fields), ".hdr" in file
    if pair:
        fields = {**fields, "magic": b"ni1",
                  "vox_offset": fields["vox_offset"] if fields["vox_offset"] != 352.0 else 0.0}
    header = pack(fields, order) + (struct.pack("<4B", 1, 0, 0,
                                                0) + extension if extension else b"" if pair else bytes(4))
    squeeze = gzipped if file.endswith(".gz") else bytes
    offset = fields["vox_offset"]
    skipped = bytes(max(0, int(offset) - (0 if pair else len(header)))) if 0 <= offset < 1e6 else b""
    data = skipped + raw(array, order)
    if pair:
        return Files(file, {file: squeeze(header), file.replace(".hdr", ".img"): squeeze(data)})
    return Files(file, {file: squeeze(header + data)}, 0 if file.endswith(".gz") else len(header + skipped))


def nifti2(array, file="i.nii", order="<", **fields):
    fields = {**fields_of(array, fields), "sizeof_hdr": 540, "magic": b"n+2\0\r\n\x1a\n", "vox_offset": 544}
    fields.pop("regular")
    return Files(file, {file: pack(fields, order, NIFTI2, 540) + bytes(4) + raw(array, order)}, 544)


# ----- what the files hold


def place(fields):
    """Methods 3, 2 and 1 of nifti1.h, in LPS and mm, and which it is."""
    single = {name: np.asarray(fields[name], "f4").astype(float) for name in ("pixdim", "quatern", "qoffset", "srow")}
    if fields["sform_code"] > 0:
        ras, method = single["srow"].reshape(3, 4), 3
    elif fields["qform_code"] > 0:
        ras, method = _quaternion_matrix(single), 2
    else:
        ras, method = affine(np.diag(single["pixdim"][1:4]), np.zeros(3)), 1
    return RAS_TO_LPS @ ras * LENGTHS.get(fields["xyzt_units"] & 7, 1.0), method


def _quaternion_matrix(single):
    b, c, d = single["quatern"]
    a = np.sqrt(max(0.0, 1.0 - b * b - c * c - d * d))
    rotation = np.array([[a * a + b * b - c * c - d * d, 2 * (b * c - a * d), 2 * (b * d + a * c)],
                         [2 * (b * c + a * d), a * a + c * c - b * b - d * d, 2 * (c * d - a * b)],
                         [2 * (b * d - a * c), 2 * (c * d + a * b), a * a + d * d - b * b - c * c]])
    qfac = -1.0 if single["pixdim"][0] < 0 else 1.0
    return affine(rotation * single["pixdim"][1:4] * (1, 1, qfac), single["qoffset"])


def scaled(array, fields):
    """The voxels with slope and intercept, and whether these have left integers."""
    slope, inter = float(np.float32(fields["scl_slope"])), float(np.float32(fields["scl_inter"]))
    if slope == 0 or not np.isfinite(slope) or not np.isfinite(inter) or (slope, inter) == (1.0, 0.0):
        return array, False
    if array.dtype.kind in "iu" and slope == int(slope) and inter == int(inter):
        values = [int(v) * int(slope) + int(inter) for v in array.ravel()]
        return np.array(values, object).reshape(array.shape).astype("u8" if max(values) > 2**63 - 1 else "i8"), True
    return array.astype("f8") * slope + inter, False


def held(array, fields, warns=""):
    fields = fields_of(array, fields)
    values, any_integer = scaled(array, fields)
    where, method = place(fields)
    if method == 1 and not warns:
        warns = "qform|sform|position|orientation"
    step = float(np.float32(fields["pixdim"][4])) if len(fields["pixdim"]) > 4 else 1.0
    frames = len(array) if array.ndim == 4 else 1
    if frames == 1 and values.ndim == 4:
        values = values[0]
    unit = TIMES.get(fields["xyzt_units"] & 56, 1.0)
    return Image(values, where, times(frames, float(np.float32(fields["toffset"])) * unit, step * unit), any_integer, warns)


# ----- rows

ROWS = []


def equal(name, array, warns="", wrap=lambda files: files, outcome=None, **options):
    """A file with these fields, and what nifti1.h says that it holds."""
    fields = {key: value for key, value in options.items() if key in NIFTI1}
    ROWS.append(row("NIfTI", name, wrap(nifti(array, **options)), *([outcome] if outcome else []),
                    held(array, fields, warns)))


def refuse(name, words, array=None, wrap=lambda files: files, is_broken=False, **options):
    ROWS.append(row("NIfTI", name, wrap(nifti(I2 if array is None else array, **{**sform(AXES["oblique"]), **options})),
                    refused(words, is_broken)))


I2, U1, F4, FOUR = voxels("i2"), voxels("u1"), voxels("f4"), voxels("i2", frames=3)
OBLIQUE = {**qform(AXES["oblique"]), **sform(AXES["oblique"])}
FORMS = {"qform": qform, "sform": sform, "both": lambda steps: {**sform(steps), **qform(steps)}}
MUST_WARN_BOTH = r"(?=.*qform)(?=.*sform)(?=.*\d)"

for case in combinations(type=TYPES, order=ORDERS, file=("i.nii", "i.nii.gz", "i.hdr", "i.hdr.gz"), axes=NOT_SHEARED,
                         form=FORMS, frames=(None, 2)):
    equal(title(case), voxels(case["type"], case["frames"]), file=case["file"], order=case["order"],
          **FORMS[case["form"]](AXES[case["axes"]]))

# Values
for slope, inter in ((0, 0), (1, 0), (1, -1024), (2, 3), (-1, 0), (0.5, 0), (1, 0.5), (0.1, -3), (0, 7), (np.nan, 0),
                     (np.inf, 0), (1, np.nan)):
    for array in (U1, I2, F4):
        outcome = refused("slope|inter") if np.isnan(inter) else None
        equal("slope %s, intercept %s, %s" % (slope, inter, array.dtype), array, scl_slope=slope, scl_inter=inter,
              outcome=outcome, **OBLIQUE)
equal("slope 1, intercept -1024, gz", I2, scl_inter=-1024, file="i.nii.gz", **OBLIQUE)
equal("slope 1, intercept 5, int64", voxels("i8") // 2, scl_inter=5, **OBLIQUE)
for code, bits, words in ((128, 24, "RGB|128|colour"), (2304, 32, "RGB|2304|colour"), (32, 64, "complex|32"),
                          (1792, 128, "complex|1792"), (1536, 128, "float128|1536|128"),
                          (1, 1, "binary|1 bit|bit|type"), (0, 16, "type|unknown"), (99, 16, "99")):
    refuse("data type %d" % code, words, datatype=code, bitpix=bits, wrap=lambda f: f.with_data(f.data() + bytes(1000)))
for bits in (8, 32, 17, -16):
    refuse("bitpix %d of int16" % bits, "bitpix|bits|type", bitpix=bits,
           wrap=lambda f: f.with_data(f.data() + bytes(200)))
refuse("bitpix 16 of int32", "bitpix|bits|type", array=voxels("i4"), bitpix=16)

# Place
for axes in AXES:
    equal("sform only, %s" % axes, I2, **sform(AXES[axes]))
for axes in NOT_SHEARED:
    equal("qform only, %s" % axes, I2, **qform(AXES[axes]))
for code in (1, 2, 3, 4, 5):
    equal("sform of code %d" % code, I2, **sform(AXES["oblique"], code=code))
    equal("qform of code %d" % code, I2, **qform(AXES["oblique"], code=code))
equal("neither", I2)
equal("neither, 4D", FOUR)
equal("neither, with an unused qform and sform", I2, **{**OBLIQUE, "qform_code": 0, "sform_code": 0})
equal("neither, with an unused qform and sform of NaN", I2, **{
    **OBLIQUE, "qform_code": 0, "sform_code": 0, "quatern": (np.nan,) * 3, "srow": (np.nan,) * 12})
equal("sform of code -1, and qform", I2, warns=ANY, **{**OBLIQUE, "sform_code": -1, "srow": (9,) * 12})
equal("sform far from qform", I2, MUST_WARN_BOTH, **{**qform(AXES["oblique"]), **sform(AXES["oblique"], ORIGIN + 100)})
equal("sform turned against qform", I2, MUST_WARN_BOTH, **{**qform(AXES["identity"]), **sform(AXES["oblique"])})
equal("sform mirrored against qform", I2, MUST_WARN_BOTH, **{**qform(AXES["identity"]), **sform(AXES["mirrored"])})
equal("sform larger than qform", I2, MUST_WARN_BOTH, **{**qform(AXES["identity"]), **sform(1.5 * AXES["identity"]),
                                                       "pixdim": (1, *SPACING)})
equal("sform and qform differ by rounding", I2, **{**OBLIQUE, "qoffset": RAS_TO_LPS @ (ORIGIN + 1e-6)})
equal("sform, pixdim differs", I2, warns=ANY, **{**sform(AXES["oblique"]), "pixdim": (1, 1, 1, 1)})
equal("sform, pixdim 0", I2, warns=ANY, outcome=refused("pixdim|spacing"),
      **{**sform(AXES["oblique"]), "pixdim": (1, 0, 0, 0)})
equal("qfac 0", I2, **{**qform(AXES["identity"]), "pixdim": (0, *SPACING)})
equal("quaternion longer than 1 by rounding", I2, warns=ANY,
      **{**qform(AXES["identity"]), "quatern": (0, 0, 1.0000001)})
for quatern in ((0.8, 0.8, 0), (1.0001, 0, 0), (np.nan, 0, 0)):
    equal("sform beside a quaternion of %s" % (quatern,), I2, r"two places.*sform.*qform is no rotation",
          **{**OBLIQUE, "quatern": quatern})

# Units
for units in (0, MM, MICRON, METRE):
    for name, form in FORMS.items():
        equal("length unit %d, %s" % (units, name), I2, warns=ANY if units == 0 else "", xyzt_units=units,
              **form(AXES["oblique"]))
    equal("length unit %d, neither" % units, I2, xyzt_units=units)
for units, warns in ((0, ""), (SECONDS, ""), (MILLISECONDS, ""), (MICROSECONDS, ""), (32, "Hz"), (40, "ppm"), (48, "rad/s"),
                     (56, "unit 56")):
    warns = warns and "its times are in '%s', and so are those of the mesh" % warns
    equal("time unit %d" % units, FOUR, warns=warns, xyzt_units=MM + units, **OBLIQUE)
    equal("time unit %d, 3D" % units, I2, xyzt_units=MM + units, **OBLIQUE)
for units in (SECONDS, MILLISECONDS, MICROSECONDS):
    ROWS.append(row("NIfTI-2", "time unit %d" % units, nifti2(FOUR, xyzt_units=MM + units, **OBLIQUE),
                    held(FOUR, {**OBLIQUE, "xyzt_units": MM + units})))
equal("micron and milliseconds", FOUR, xyzt_units=MICRON + MILLISECONDS, **OBLIQUE)
for units in (4, 7):
    equal("length unit %d" % units, I2, "its lengths are in 'unit %d'" % units, xyzt_units=units, **OBLIQUE)

# Sizes
equal("4D of one frame", voxels("i2", frames=1), **OBLIQUE)
equal("4D, step 0", FOUR, outcome=Image(FOUR, place(fields_of(FOUR, OBLIQUE))[0], times(3, FIRST_TIME, 1.0),
                                        warns="time"),
      **{**OBLIQUE, "pixdim": (*OBLIQUE["pixdim"][:4], 0)})
equal("dim[0] = 3 beside other sizes", I2, dim=(3, 5, 4, 3, 77, 0, -4, 9), warns=ANY, **OBLIQUE)
equal("dim[0] = 7, further sizes 1", I2, dim=(7, 5, 4, 3, 1, 1, 1, 1), **OBLIQUE)
equal("dim[0] = 5, dim[5] = 1", FOUR, dim=(5, 5, 4, 3, 3, 1), **OBLIQUE)
equal("a slice of one voxel in depth", voxels("i2", shape=(1, 4, 5)), outcome=refused("slice|dimension|size"),
      **OBLIQUE)
equal("one voxel", voxels("i2", shape=(1, 1, 2))[:, :, :1], outcome=refused("slice|dimension|size|voxel"), **OBLIQUE)
refuse("2D", "dimension|slice", dim=(2, 5, 4, 3))
refuse("2D, no further sizes", "dimension|slice", array=voxels("i2", shape=(1, 4, 5)), dim=(2, 5, 4, 0, 0))
refuse("5D", "dim|components", array=voxels("i2", frames=2), dim=(5, 5, 4, 3, 1, 2))
refuse("5D, vectors", "dim|vector|components", array=voxels("i2", frames=3), dim=(5, 5, 4, 3, 1, 3), intent_code=1007)
for code, words in ((2003, "colours.*2003"), (2004, "colours.*2004"), (1004, "matrices.*1004"), (1005, "matrices.*1005"),
                    (1006, "vectors.*1006"), (1007, "vectors.*1007"), (1008, "points.*1008"), (1009, "triangles.*1009"),
                    (1010, "quaternions.*1010"), (2006, "vectors.*2006"), (2009, "coefficients.*2009"), (2016, "coefficients.*2016")):
    for dim in ((4, 5, 4, 3, 3), (5, 5, 4, 3, 1, 3)):
        refuse("intent %d, %dD" % (code, dim[0]), words, array=FOUR, dim=dim, intent_code=code)
        ROWS.append(row("NIfTI-2", "intent %d, %dD" % (code, dim[0]), nifti2(FOUR, dim=dim, intent_code=code, **OBLIQUE),
                        refused(words)))
refuse("intent RGB, big endian, gz", "colours.*2003", array=FOUR, order=">", file="i.nii.gz", intent_code=2003)
refuse("intent RGB, .hdr", "colours.*2003", array=FOUR, file="i.hdr", intent_code=2003)
for code in (1001, 1002, 1011, 2001, 2005):
    equal("intent %d, 4D" % code, FOUR, intent_code=code, **OBLIQUE)
for code in (2003, 1007):  # of one component
    equal("intent %d, 3D" % code, I2, intent_code=code, **OBLIQUE)
# Classes along the fourth axis: which of them a voxel has.
CLASS = np.arange(60).reshape(3, 4, 5) % 3
ONE_HOT = (CLASS == np.arange(3).reshape(3, 1, 1, 1))
WARNS_OF_CLASSES = "frames are taken for times.*classes"
for name, array in (("one-hot", ONE_HOT.astype("u1")), ("one-hot of 255", (255 * ONE_HOT).astype("u1")),
                    ("one-hot, real", ONE_HOT.astype("f4")), ("labels apart", (ONE_HOT * np.arange(3).reshape(3, 1, 1, 1)).astype("i2")),
                    ("without background", (ONE_HOT & (np.arange(5) > 2)).astype("u1")),
                    ("probabilities", np.stack([0.7 - 0.1 * CLASS, 0.2 + 0.1 * CLASS, 0 * CLASS + 0.1]).astype("f4"))):
    equal("classes, %s" % name, array, WARNS_OF_CLASSES, **OBLIQUE)
for name, array in (("voxels in two frames", np.concatenate([ONE_HOT, ONE_HOT[:1]]).astype("u1")),
                    ("one frame that is not empty", np.stack([CLASS == 0, 0 * CLASS, 0 * CLASS]).astype("u1")),
                    ("empty", np.zeros((3, 3, 4, 5), "u1"))):
    equal("no classes, %s" % name, array, **OBLIQUE)
refuse("6D", "dim", array=voxels("i2", frames=4), dim=(6, 5, 4, 3, 1, 2, 2))
for count in (0, 8, -1, 20000):
    refuse("dim[0] = %d" % count, "dim|not an image|format", dim=(count, 5, 4, 3, 1, 1, 1, 1))
for size in (0, -4):
    refuse("a size of %d" % size, "dim|size|voxels", dim=(3, 5, size, 3))
    refuse("%d frames" % size, "dim|size|frames|voxels", dim=(4, 5, 4, 3, size))
for name in ("i.nii", "i.nii.gz", "i.hdr", "i.hdr.gz"):
    refuse("claims more than there is, " + name, ".", file=name, dim=(3, 32767, 32767, 32767), is_broken=True)
    refuse("claims 2^105 voxels, " + name, ".", file=name, dim=(7, *[32767] * 7), is_broken=True)
    refuse("claims a frame too many, " + name, ".", file=name, dim=(4, 5, 4, 3, 2), is_broken=True)

# Numbers that are no place
for value in (0, np.nan, np.inf, -np.inf):
    refuse("pixdim[2] = %s, qform" % value, "pixdim|spacing", **{**qform(AXES["identity"]), "sform_code": 0,
                                                                "pixdim": (1, 1, value, 1)})
    refuse("pixdim[2] = %s, neither" % value, "pixdim|spacing", sform_code=0, pixdim=(1, 1, value, 1))
refuse("negative pixdim", "pixdim|spacing", sform_code=0, pixdim=(1, 1, -1, 1))
for value in (np.nan, np.inf):
    refuse("qoffset of %s" % value, "qform|qoffset|origin|position|finite",
           **{**qform(AXES["identity"]), "sform_code": 0, "qoffset": (0, value, 0)})
    refuse("quaternion of %s" % value, "qform|quatern|position or orientation", **{**qform(AXES["identity"]), "sform_code": 0,
                                                           "quatern": (0, value, 0)})
    refuse("sform of %s" % value, "sform|srow|finite|number", srow=(value, *range(11)))
    refuse("step of time of %s" % value, "time|pixdim", array=FOUR, pixdim=(1, 1, 1, 1, value))
    refuse("first time of %s" % value, "toffset", array=FOUR, toffset=value)
refuse("negative step of time", "time|pixdim", array=FOUR, pixdim=(1, 1, 1, 1, -1))
refuse("quaternion longer than 1", "qform|quatern|position or orientation", **{**qform(AXES["identity"]), "sform_code": 0,
                                                       "quatern": (1, 1, 1)})
refuse("sform of zeros", "sform|independent|singular|axes|length", srow=(0,) * 12)
refuse("sform with equal columns", "sform|independent|singular|axes|spacing", srow=(1, 1, 0, 5) * 3)
refuse("sform of rank 2", "sform|independent|singular|axes|spacing", srow=(1, 2, 3, 5, 4, 5, 9, 5, 7, 8, 15, 5))

# The rest of the header
for offset in (352, 356, 368, 416, 1024):
    equal("vox_offset %d" % offset, I2, vox_offset=offset, **OBLIQUE)
    equal("vox_offset %d, gz" % offset, I2, vox_offset=offset, file="i.nii.gz", **OBLIQUE)
equal("vox_offset 16 of a pair", I2, vox_offset=16, file="i.hdr", **OBLIQUE)
EXTENSION = struct.pack("<2i", 32, 6) + b"a comment".ljust(24, b"\0")
equal("an extension", I2, extension=EXTENSION, vox_offset=384, **OBLIQUE)
equal("two extensions", I2, extension=2 * EXTENSION, vox_offset=416, file="i.nii.gz", **OBLIQUE)
equal("an extension of a pair", I2, extension=EXTENSION, file="i.hdr", **OBLIQUE)
for offset in (0, 1, 100, 348, 351, -1, np.nan, np.inf):
    refuse("vox_offset %s" % offset, "offset|byte|header", vox_offset=offset)
refuse("vox_offset 350 of a gz", "offset|byte|header", vox_offset=350, file="i.nii.gz")
for offset in (1e5, 1e9, 1e30):
    refuse("vox_offset %g, beyond the end" % offset, ".", vox_offset=offset, is_broken=True,
           wrap=lambda f: f.with_data(f.data()[:2000]))
equal("texts in all fields", I2, descrip=b"x" * 80, intent_name=b"y" * 16, data_type=b"z" * 10, db_name=b"w" * 18,
      **OBLIQUE)
equal("labels as intent", U1, intent_code=1002, cal_max=9, glmax=255, **OBLIQUE)
equal("a description with the word of MRC", voxels("i2", shape=LARGER), descrip=60 * b"x" + b"MAP y", **OBLIQUE)
refuse("sizeof_hdr 347", "format|header|not an image", sizeof_hdr=347)
refuse("no magic", "format|magic|header|not an image|ANALYZE|img", magic=b"abc")

# Names
equal("a pair, named by its .img", I2, file="i.hdr", wrap=lambda f: Files("i.img", f.parts), **OBLIQUE)
equal("a .hdr with an .img.gz", I2, file="i.hdr", **OBLIQUE,
      wrap=lambda f: Files(f.main, {"i.hdr": f.data(), "i.img.gz": gzipped(f.data("i.img"))}))
for other in ("i.nii.gz", "i.nrrd", "i.mha", "i.vtk", "i.img", "i.hdr", "i", "i.NII"):
    equal("a single file named %s" % other, I2, wrap=lambda f, other=other: f.renamed(other), **OBLIQUE)
for other in ("i.nii", "i.dat", "i.gz"):
    equal("a compressed file named %s" % other, I2, file="i.nii.gz", wrap=lambda f, other=other: f.renamed(other),
          **OBLIQUE)
equal("two members of gzip", I2, file="i.nii.gz", **OBLIQUE, wrap=lambda f: f.with_data(
    gzipped(gzip.decompress(f.data())[:400]) + gzipped(gzip.decompress(f.data())[400:])))
refuse("gzip of gzip", "compressed by gzip.*unpack it", wrap=lambda f: f.with_data(gzipped(f.data())), file="i.nii.gz")
ROWS.append(row("NIfTI", "a pair without its .img", Files("i.hdr", {"i.hdr": nifti(I2, "i.hdr").data()}),
                broken(r"i\.img")))
for what, part in (("a FIFO", Fifo()), ("a folder", Folder()), ("a link to itself", Link("i.img"))):
    refuse("%s as .img" % what, r"i\.img", file="i.hdr", wrap=lambda f, part=part: f.with_data(part, "i.img"))
refuse("its header as .img, by a link", "names itself", file="i.hdr", wrap=lambda f: f.with_data(Link("i.hdr"), "i.img"))
refuse("an .img elsewhere, by a link", r"i\.img", file="in/i.hdr", wrap=lambda f: f.with_data(
    Link("../out.img"), "in/i.img").beside({"out.img": raw(I2)}))
equal("an .img in the folder, by a link", I2, file="i.hdr", **OBLIQUE, wrap=lambda f: f.with_data(
    Link("voxels.raw"), "i.img").beside({"voxels.raw": raw(I2)}))
equal("the file itself is a link", I2, file="out/i.nii", **OBLIQUE,
      wrap=lambda f: Files("in.nii", {**f.parts, "in.nii": Link("out/i.nii")}))
for beside in ("i.img", "i.hdr", "visu_pars", "i.raw", "i.nii.txt"):
    equal("a FIFO named %s beside it" % beside, I2, warns=ANY if beside.endswith("txt") else "", **OBLIQUE,
          wrap=lambda f, beside=beside: f.beside({beside: Fifo()}))

# Two more headers
ANALYZE_WARNS = "position|orientation|lies|ANALYZE"
for case in combinations(type=TYPES, order=ORDERS, axes=NOT_SHEARED, frames=(None, 2)):
    array, fields = voxels(case["type"], case["frames"]), FORMS["both"](AXES[case["axes"]])
    ROWS.append(row("NIfTI-2", title(case), nifti2(array, order=case["order"], **fields), held(array, fields),
                    refused("NIfTI-2")))


def analyze(array, order="<", **fields):
    """The fields of ANALYZE 7.5 that NIfTI has kept; no magic. Where the image lies is not known."""
    fields = {**fields_of(array, fields), "vox_offset": 0.0, "scl_slope": 0.0, "extents": 16384, "magic": b"",
              "toffset": 0.0, "xyzt_units": 0}
    return Files("i.hdr", {"i.hdr": pack(fields, order), "i.img": raw(array, order)}), fields


def held_by_analyze(array, fields):
    """Its axes are taken for those of LPS."""
    image = held(array, fields, warns=ANALYZE_WARNS)
    return replace(image, affine=RAS_TO_LPS @ image.affine)


for case in combinations(type=("u1", "i2", "i4", "f4", "f8"), order=ORDERS, frames=(None, 2)):
    array = voxels(case["type"], case["frames"])
    files, analyze_fields = analyze(array, case["order"])
    ROWS.append(row("ANALYZE", title(case), files,
                    held_by_analyze(array, analyze_fields)))
for name, words, options in (("RGB", "RGB|colour|128", {"datatype": 128, "bitpix": 24}),
                             ("2D", "dim|slice", {"dim": (2, 5, 4)}),
                             ("complex", "complex|32", {"datatype": 32, "bitpix": 64}),
                             ("bitpix 8 of int16", "bit", {"bitpix": 8}),
                             ("pixdim 0", "pixdim|spacing", {"pixdim": (0, 0, 1, 1)})):
    files = analyze(I2, **options)[0]
    ROWS.append(row("ANALYZE", name, files.with_data(files.data("i.img") + bytes(500), "i.img"), refused(words)))
ROWS.append(row("ANALYZE", "short .img", analyze(I2)[0].with_data(raw(I2)[:-1], "i.img"), broken()))
ROWS.append(row("ANALYZE", "header cut", analyze(I2)[0].with_data(analyze(I2)[0].data()[:347]), broken()))

try:
    import nibabel
except ModuleNotFoundError:
    nibabel = None


def _nibabel_rows():
    """Files that nibabel has written, with both forms."""
    for case in combinations(type=TYPES, axes=NOT_SHEARED, kind=("Nifti1Image", "Nifti2Image"), frames=(None, 2)):
        array, where = voxels(case["type"], case["frames"]), affine(AXES[case["axes"]])
        image = getattr(nibabel, case["kind"])(array.T, np.vstack([RAS_TO_LPS @ where, (0, 0, 0, 1)]),
                                               dtype=array.dtype)
        image.header.set_xyzt_units("mm", "sec")
        image.set_qform(image.affine, 1)
        outcomes = [Image(array, where, times(2, 0.0, 1.0))] + [refused("NIfTI-2")] * (case["kind"] == "Nifti2Image")
        yield row("nibabel", title(case), Files("i.nii", {"i.nii": image.to_bytes()}), *outcomes)


ROWS += _nibabel_rows() if nibabel else []

_MORE = voxels("i2", shape=LARGER)
_HELD = held(_MORE, OBLIQUE)
SOUND = [
    Sound("NIfTI", "raw", nifti(_MORE, **OBLIQUE), _HELD),
    Sound("NIfTI", "gzip", nifti(_MORE, "i.nii.gz", **OBLIQUE), _HELD),
    Sound("NIfTI", "raw", nifti(_MORE, "i.hdr", **OBLIQUE), _HELD, "i.img"),
    Sound("NIfTI", "gzip", nifti(_MORE, "i.hdr.gz", **OBLIQUE), _HELD, "i.img.gz"),
    Sound("NIfTI-2", "raw", nifti2(_MORE, **OBLIQUE), _HELD),
    Sound("ANALYZE", "raw", analyze(_MORE)[0], held_by_analyze(_MORE, analyze(_MORE)[1]), "i.img"),
]
