# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""NRRD, from the definition of the format (teem.sourceforge.net/nrrd/format.html)."""
import bz2

import numpy as np

from .images import (AXES, FIRST_TIME, LARGER, ORDERS, ORIGIN, SPACING, TIME_STEP, TYPES, affine, combinations,
                     gzipped, raw, text, times, title, voxels)
from .rows import ANY, Fifo, Files, Image, Sound, broken, data_files, named, refused, row

SPELLINGS = {
    "i1": ("signed char", "int8", "int8_t"),
    "u1": ("uchar", "unsigned char", "uint8", "uint8_t"),
    "i2": ("short", "short int", "signed short", "signed short int", "int16", "int16_t"),
    "u2": ("ushort", "unsigned short", "unsigned short int", "uint16", "uint16_t"),
    "i4": ("int", "signed int", "int32", "int32_t"),
    "u4": ("uint", "unsigned int", "uint32", "uint32_t"),
    "i8": ("longlong", "long long", "long long int", "signed long long", "signed long long int", "int64", "int64_t"),
    "u8": ("ulonglong", "unsigned long long", "unsigned long long int", "uint64", "uint64_t"),
    "f4": ("float",),
    "f8": ("double",),
}
# How coordinates of a space become LPS. Spaces that name no direction of the body are taken as LPS.
SPACES = {
    "left-posterior-superior": (1, 1, 1), "LPS": (1, 1, 1),
    "right-anterior-superior": (-1, -1, 1), "RAS": (-1, -1, 1),
    "left-anterior-superior": (1, -1, 1), "LAS": (1, -1, 1),
    "scanner-xyz": (1, 1, 1), "3D-right-handed": (1, 1, 1), "3D-left-handed": (1, 1, 1),
}
NAMED = [name for name in SPACES if name.endswith(("superior", "S"))]
UNITS = {"mm": "", "millimeter": "", "cm": "centimetres", "m": "metres", "um": "micrometres", "nm": "nanometres",
         "micron": "micrometres", "furlong": "'furlong'"}
UNIT = "its lengths are in %s, and so is the mesh"  # numbers are those of the file


def encode(array, encoding, order):
    data = raw(array, order)
    if encoding in ("gzip", "gz"):
        return gzipped(data)
    if encoding in ("bzip2", "bz2"):
        return bz2.compress(data)
    if encoding == "hex":
        digits = data.hex().encode()
        return b"\n".join(digits[at:at + 70] for at in range(0, len(digits), 70)) + b"\n"
    return text(array) if encoding in ("ascii", "text", "txt") else data


def vector(numbers):
    return "(%s)" % ",".join(repr(float(number)) for number in numbers)


def nrrd(array, file="i.nrrd", magic="NRRD0005", encoding="raw", order="<", data=None, keys=(), newline="\n",
         before=b"",
         **fields):
    """data: the name of a file for the voxels, which before precedes.

    Names of fields have '_' for blanks; None takes a field away.
    """
    spatial = array.ndim == 3
    defaults = {
        "type": SPELLINGS[array.dtype.str[1:]][0], "dimension": array.ndim,
        "space": "left-posterior-superior" if spatial else None,
        "sizes": " ".join(map(str, array.shape[::-1])),
        "space directions": directions(AXES["identity"]) if spatial else None,
        "endian": {"<": "little", ">": "big"}[order], "encoding": encoding,
        "space origin": vector(ORIGIN) if spatial else None, "data file": data}
    fields = {**defaults, **{name.replace("_", " "): value for name, value in fields.items()}}
    if "data file" in fields:  # its list of names ends the header
        fields["data file"] = fields.pop("data file")
    lines = [magic] + ["%s: %s" % item for item in fields.items() if item[1] is not None]
    lines[-1:-1] = ["%s:=%s" % item for item in dict(keys).items()]
    header = (newline.join(lines) + newline).encode()
    voxel_data = before + encode(array, encoding, order)
    if data is not None:
        folder = file.rpartition("/")[0]
        return Files(file, {file: header, (folder + "/" if folder else "") + data: voxel_data}, 0)
    header += newline.encode()
    return Files(file, {file: header + voxel_data}, len(header))


def directions(steps, *more):
    return " ".join([vector(step) for step in np.asarray(steps).T] + list(more))


def space_time(space="left-posterior-superior-time", steps=AXES["identity"], origin=ORIGIN):
    """Fields of four axes in a space of four dimensions."""
    vectors = [vector((*step, 0)) for step in np.asarray(steps).T] + [vector((0, 0, 0, TIME_STEP))]
    return {"space": space, "space_directions": " ".join(vectors), "space_origin": vector((*origin, FIRST_TIME))}


def frame_list(place=3, steps=AXES["identity"], space="left-posterior-superior", frames=3, origin=ORIGIN):
    """Fields of a list of frames, with the index values of 3D Slicer."""
    vectors, kinds = [vector(step) for step in np.asarray(steps).T], ["domain"] * 3
    vectors.insert(place, "none")
    kinds.insert(place, "list")
    return {"space": space, "space_directions": " ".join(vectors), "space_origin": vector(origin),
            "kinds": " ".join(kinds), "keys": {"axis %d index type" % place: "numeric",
                     "axis %d index values" % place: " ".join(map(repr, times(frames)))}}


# ----- rows

ROWS = []
I2, U1, FOUR = voxels("i2"), voxels("u1"), voxels("i2", frames=3)
IMAGE = Image(I2, affine())
FRAMES = Image(FOUR, affine(), times(3))


def equal(name, image=IMAGE, also=(), wrap=lambda files: files, array=None, **options):
    """also: other outcomes that are right."""
    ROWS.append(row("NRRD", name, wrap(nrrd(image.voxels if array is None else array, **options)), image, *also))


def refuse(name, words, array=I2, wrap=lambda files: files, is_broken=False, **options):
    ROWS.append(row("NRRD", name, wrap(nrrd(array, **options)), refused(words, is_broken)))


def _turned(space, steps=AXES["oblique"]):
    flips = np.diag(SPACES[space]).astype(float)
    return affine(flips @ steps, flips @ ORIGIN)


for case in combinations(type=TYPES, order=ORDERS, encoding=("raw", "gzip", "ascii", "hex"), axes=AXES,
                         space=NAMED[::2], data=(None, "i.dat"), frames=(None, "list 0", "list 1", "list 3", "time")):
    array = voxels(case["type"], None if case["frames"] is None else 3)
    steps, space, image = AXES[case["axes"]], case["space"], None
    image = Image(array, _turned(space, steps), times(3))
    if case["frames"] is None:
        fields = {"space": space, "space_directions": directions(steps)}
    elif case["frames"] == "time":
        fields = space_time(space + "-time", steps)
    else:
        place = int(case["frames"][-1])
        fields = frame_list(place, steps, space)
        array = np.moveaxis(array, 0, 3 - place)
    equal(title(case), image, array=array, order=case["order"], encoding=case["encoding"], data=case["data"],
          file="i.nhdr" if case["data"] else "i.nrrd", **fields)

# Types and encodings
for dtype, spellings in SPELLINGS.items():
    for spelling in spellings:
        equal("type %s" % spelling, Image(voxels(dtype), affine()), type=spelling)
for encoding in ("raw", "gzip", "gz", "ascii", "text", "txt", "hex"):
    equal("encoding %s" % encoding, encoding=encoding)
    equal("encoding %s, detached" % encoding, encoding=encoding, file="i.nhdr", data="i.dat")
for encoding in ("bzip2", "bz2"):
    refuse("encoding %s" % encoding, "bz", encoding=encoding)
    refuse("encoding %s, detached" % encoding, "bz", encoding=encoding, file="i.nhdr", data="i.raw.bz2")
equal("encoding RAW", also=[refused("encoding|RAW")], encoding="raw", wrap=lambda f: f.replaced(b": raw", b": RAW"))
refuse("encoding zip", "zip", wrap=lambda f: f.replaced(b": raw", b": zip"))
refuse("encoding empty", "encoding", wrap=lambda f: f.replaced(b": raw", b": "))
refuse("type block", "block", type="block", block_size=2)
for name in ("complex", "half", "x", "", "unsigned double"):
    refuse("type '%s'" % name, "type|" + (name or "type"), type=name)
equal("8 bits without endian", Image(U1, affine()), endian=None)
equal("text without endian", encoding="ascii", endian=None)
refuse("16 bits without endian", "endian", endian=None)
refuse("endian middle", "endian|middle", endian="middle")
equal("two members of gzip", encoding="gzip", wrap=lambda f: f.with_data(
    f.data()[:f.header] + gzipped(raw(I2)[:50]) + gzipped(raw(I2)[50:])))
refuse("text with a word", ".", encoding="ascii", is_broken=True, wrap=lambda f: f.replaced(text(I2), b"a" + text(I2)))
refuse("text with a number out of range", ".", U1, encoding="ascii", is_broken=True,
       wrap=lambda f: f.with_data(f.data().replace(b" 255 ", b" 256 ")))
refuse("text with a fraction for integers", ".", U1, encoding="ascii", is_broken=True,
       wrap=lambda f: f.with_data(f.data().replace(b" 255 ", b" 25.5 ")))
equal("text in lines and commas", also=[broken()], encoding="ascii",
      wrap=lambda f: f.replaced(text(I2), text(I2, ",\n")))
equal("text in lines", encoding="ascii", wrap=lambda f: f.replaced(text(I2), text(I2, "\r\n  \t")))
refuse("hex with a word", ".", encoding="hex", is_broken=True,
       wrap=lambda f: f.with_data(f.data()[:-40] + b"xyz" + f.data()[-37:]))
refuse("hex with half a byte", ".", encoding="hex", is_broken=True, wrap=lambda f: f.with_data(f.data()[:-2]))
equal("hex in capitals", encoding="hex", wrap=lambda f: f.with_data(f.data()[:f.header] + f.data()[f.header:].upper()))

# Spaces
for space in SPACES:
    note = ANY if space in ("scanner-xyz", "3D-right-handed", "3D-left-handed") else ""
    equal("space %s" % space, Image(I2, _turned(space), warns=note), space=space,
          space_directions=directions(AXES["oblique"]))
    in_time = space + ("T" if space in ("LPS", "RAS", "LAS") else "-time")
    equal("space %s" % in_time, Image(FOUR, _turned(space), times(3), warns=note),
          **space_time(in_time, AXES["oblique"]))
    equal("space %s, list" % space, Image(FOUR, _turned(space), times(3), warns=note),
          **frame_list(3, AXES["oblique"], space))
equal("space Right-Anterior-Superior", Image(I2, _turned("RAS")), [refused("space")], space="Right-Anterior-Superior",
      space_directions=directions(AXES["oblique"]))
for space, same in (("left posterior superior", "LPS"), ("leftposteriorsuperior", "LPS"), ("right_anterior_superior", "RAS"),
                    ("left anterior superior", "LAS")):
    equal("space %s" % space, Image(I2, _turned(same)), space=space, space_directions=directions(AXES["oblique"]))
equal("space right anterior superior time", Image(FOUR, _turned("RAS"), times(3)), **space_time("right anterior superior time", AXES["oblique"]))
equal("space 3D right handed", Image(I2, _turned("LPS"), warns="LPS"), space="3D right handed", space_directions=directions(AXES["oblique"]))
equal("space dimension 3", Image(I2, _turned("LPS"), warns=ANY), space=None, space_dimension=3,
      wrap=lambda f: f.replaced(b"space dimension: 3\n", b"").replaced(b"sizes", b"space dimension: 3\nsizes"),
      space_directions=directions(AXES["oblique"]))
equal("space dimension 4", Image(FOUR, affine(AXES["oblique"]), times(3), warns=ANY), [refused("space")],
      wrap=lambda f: f.replaced(b"space: ?\n", b"space dimension: 4\n"), **space_time("?", AXES["oblique"]))
refuse("space dimension 2", "space|dimension|vector", space=None, space_directions="(1,0) (0,1) none",
       space_origin="(0,0)", wrap=lambda f: f.replaced(b"sizes", b"space dimension: 2\nsizes"))
for space in ("superior-left-posterior", "x", "", "3"):
    refuse("space '%s'" % space, "space", space=space)
refuse("space of four dimensions with vectors of three", "space|dimension|vector", space="left-posterior-superior-time")
equal("space without an origin", Image(I2, affine(origin=(0, 0, 0)), warns=ANY), space_origin=None)
equal("blanks in vectors", space_directions="(0.5, 0, 0)  ( 0,1.25,0 ) (0 ,0 ,2)", space_origin="( 10, -20 ,30)")
equal("exponents in vectors", space_directions="(5e-1,0,0) (0,+1.25,0) (0,0,0.2E1)")
refuse("two vectors for three axes", "space directions|vector|direction", space_directions="(1,0,0) (0,1,0)")
refuse("four vectors for three axes", "space directions|vector|direction",
       space_directions="(1,0,0) (0,1,0) (0,0,1) (0,0,1)")
refuse("none for an axis of space", "none|direction|list|space", space_directions="(1,0,0) (0,1,0) none")
refuse("vectors without parentheses", "space directions|vector|direction", space_directions="1,0,0 0,1,0 0,0,1")
refuse("vectors without a space", "space", space=None)

# No space
PLAIN = {"space": None, "space_directions": None, "space_origin": None}
equal("spacings", Image(I2, affine(origin=(0, 0, 0)), warns=ANY), **PLAIN, spacings="0.5 1.25 2")
equal("neither spacings nor space", Image(I2, affine(np.eye(3), (0, 0, 0)), warns=ANY), **PLAIN)
for centers, share in (("node node node", 0.0), ("cell cell cell", 0.5), (None, 0.5)):
    equal("spacings, axis mins, centers %s" % centers, Image(I2, affine(origin=ORIGIN + share * SPACING), warns=ANY),
          **PLAIN, centers=centers, spacings="0.5 1.25 2", axis_mins="10 -20 30")
equal("axis mins and maxs of nodes", Image(I2, affine(), warns=ANY), [refused("spacing|max")], **PLAIN,
      centers="node node node", axis_mins="10 -20 30", axis_maxs="12 -16.25 34")
equal("axis mins and maxs of cells", Image(I2, affine(origin=ORIGIN + 0.5 * SPACING), warns=ANY),
      [refused("spacing|max")],
      **PLAIN, centers="cell cell cell", axis_mins="10 -20 30", axis_maxs="12.5 -15 36")
equal("spacings, 4D", Image(FOUR, affine(origin=(0, 0, 0)), times(3, 0.0), warns=ANY), spacings="0.5 1.25 2 0.5")
equal("spacings, 4D, axis mins of nodes", Image(FOUR, affine(), times(3), warns=ANY), spacings="0.5 1.25 2 0.5",
      centers="node node node node", axis_mins="10 -20 30 3")
equal("spacings, 4D, no step of time", Image(FOUR, affine(origin=(0, 0, 0)), (0, 1, 2), warns=ANY),
      spacings="0.5 1.25 2 nan")

# Further fields
for unit in UNITS:
    equal("space units %s" % unit, Image(I2, affine(), warns=UNITS[unit] and UNIT % UNITS[unit]), space_units='"%s" "%s" "%s"' % (unit, unit, unit))
equal("units um", Image(I2, affine(origin=(0, 0, 0)), warns=UNIT % "micrometres"), **PLAIN, spacings="0.5 1.25 2",
      units='"um" "um" "um"')
equal("space units um, list", Image(FOUR, affine(), times(3), warns=UNIT % "micrometres"), **frame_list(), space_units='"um" "um" "um"')
equal("space units um and s", Image(FOUR, affine(), times(3), warns=UNIT % "micrometres"), **space_time(), space_units='"um" "um" "um" "s"')
equal("space units voxel", Image(I2, affine(), warns=ANY), [refused("unit|voxel")],
      space_units='"voxel" "voxel" "voxel"')
equal("space units empty", Image(I2, affine(), warns=ANY), space_units='"" "" ""')
# Different ones become that of the first axis: of the space, or of the file.
THOUSAND = np.array([1.0, 1000.0, 1000.0])
for axes in AXES:
    equal("space units um, mm and mm, %s" % axes, Image(I2, np.diag(THOUSAND) @ affine(AXES[axes]), warns=UNIT % "micrometres"),
          space_units='"um" "mm" "mm"', space_directions=directions(AXES[axes]))
    equal("units um, mm and mm, %s" % axes, Image(I2, affine(AXES[axes] * THOUSAND), warns=UNIT % "micrometres"),
          units='"um" "mm" "mm"', space_directions=directions(AXES[axes]))
equal("space units mm, mm and cm", Image(I2, np.diag((1, 1, 10)) @ affine()), space_units='"mm" "millimeters" "cm"')
equal("units um, mm and mm, no directions", Image(I2, affine(np.diag(SPACING * THOUSAND), ORIGIN * THOUSAND),
      warns=UNIT % "micrometres"), **PLAIN, spacings="0.5 1.25 2", axis_mins="10 -20 30", centers="node node node",
      units='"um" "mm" "mm"')
for units in ('"mm" "mm" "furlong"', '"mm" "mm" ""', '"mm" "mm"', '"" "um" "um"', '"voxel" "voxel" "mm"'):
    equal("space units %s" % units, Image(I2, affine(), warns=r"its axes have the units '.*SetSpacing\(\)"), space_units=units)
# Times are told.
for unit, warns in (("s", ""), ("sec", ""), ("", ""), ("???", ""), ("ms", "'ms'"), ("\u00B5s", "'\u00B5s'"), ("min", "'min'")):
    warns = warns and "its times are in %s, and so are those of the mesh" % warns
    frames, index = Image(FOUR, affine(), times(3), warns=warns), frame_list(0)
    equal("space units in time %s" % unit, frames, **space_time(), space_units='"mm" "mm" "mm" "%s"' % unit)
    equal("units in time %s" % unit, frames, **frame_list(), units='"" "" "" "%s"' % unit, space_units='"mm" "mm" "mm"')
    equal("index unit %s" % unit, frames, array=np.moveaxis(FOUR, 0, 3),
          **{**index, "keys": {**index["keys"], "axis 0 index unit": unit}})
    equal("spacings, 4D, units in time %s" % unit, Image(FOUR, affine(origin=(0, 0, 0)), times(3, 0.0), warns=warns),
          spacings="0.5 1.25 2 0.5", units='"mm" "mm" "mm" "%s"' % unit)
for kinds in ("domain domain domain", "space space space", "??? ??? ???", "none none none", "Domain DOMAIN domain"):
    equal("kinds %s" % kinds, kinds=kinds)
for centers in ("cell cell cell", "node node node", "??? ??? ???", "none none none"):
    equal("centers %s beside a space" % centers, centers=centers)
equal("a measurement frame", measurement_frame="(0,1,0) (1,0,0) (0,0,1)")
equal("labels, content, and more", content="a segmentation: of x", labels='"x y" "z\\"" ""', thicknesses="1 nan 1",
      min=0, max=9, old_min=0, sample_units="label", number=60, keys={"modality": "CT", "a:b": "c := d", "": "x"})
for key in ("space", "space origin", "space units", "units", "axis mins", "axis maxs", "spacings", "kinds", "centers", "type", "dimension",
            "sizes", "encoding", "endian", "byte skip", "line skip", "data file", "datafile", "a: b"):
    for name in (key, key.title()):
        equal("a pair %s" % name, keys={name: "LIST"})
        equal("a pair %s, before the fields" % name, wrap=lambda f, name=name: f.replaced(b"type", name.encode() + b":=8 2\ntype"))
equal("pairs of names of fields, no space", Image(I2, affine(origin=(0, 0, 0)), warns=ANY), **PLAIN, spacings="0.5 1.25 2",
      keys={"Space": "RAS", "axis mins": "100 100 100", "Space Directions": "none", "Units": '"um"'})
equal("a pair given twice", wrap=lambda f: f.replaced(b"type", b"Modality:=CT\nModality:=MR\ntype"))
equal("comments", wrap=lambda f: f.replaced(b"type", b"# type: float\n#\ntype").replaced(
    b"sizes", b"#sizes: 1 1 1\nsizes"))
equal("lines with carriage returns", newline="\r\n")
equal("fields in capitals", also=[refused("field|Sizes|header")], wrap=lambda f: f.replaced(b"\nsizes", b"\nSizes"))
equal("names without blanks", space_units=None, lineskip=0, byteskip=0, datafile=None)
equal("sizes before dimension", also=[refused("sizes|dimension")],
      wrap=lambda f: f.replaced(b"dimension: 3\n", b"").replaced(b"endian", b"dimension: 3\nendian"))
for version in range(1, 6):
    equal("magic NRRD000%d" % version, Image(I2, affine(origin=(0, 0, 0)), warns=ANY), magic="NRRD000%d" % version,
          **PLAIN, spacings="0.5 1.25 2")
equal("magic NRRD0006", also=[refused("NRRD0006|version|newer")], magic="NRRD0006")
equal("magic NRRD00.01", Image(I2, affine(origin=(0, 0, 0)), warns=ANY),
      [refused("NRRD00.01|version|format|not an image")],
      magic="NRRD00.01", **PLAIN, spacings="0.5 1.25 2")
for field, value in (("sizes", "5 4 3"), ("type", "short"), ("encoding", "raw"), ("endian", "big")):
    refuse("%s given twice" % field, field + "|twice|more than once",
           wrap=lambda f, line=("%s: %s\nspace origin" % (field, value)).encode(): f.replaced(b"space origin", line))
for field in ("type", "dimension", "sizes", "encoding"):
    refuse("no %s" % field, field, **{field: None})
refuse("a field that there is not", "field|colour", colour="red")
refuse("a line that is no field", "line|field|hello", wrap=lambda f: f.replaced(b"sizes", b"hello\nsizes"))
refuse("a header without an end", ".", is_broken=True, wrap=lambda f: f.with_data(f.data()[:f.header - 1]))
refuse("only the magic", ".", is_broken=True, wrap=lambda f: f.with_data(b"NRRD0004\n"))

# Frames and components
for place in (0, 1, 2, 3):
    equal("a list as axis %d" % place, FRAMES, array=np.moveaxis(FOUR, 0, 3 - place), **frame_list(place))
    equal("a list of one as axis %d" % place, IMAGE, array=np.expand_dims(I2, 3 - place), **frame_list(place, frames=1))
equal("a list without index values", Image(FOUR, affine(), (0, 1, 2)), **{**frame_list(), "keys": ()})
equal("a list with a vector of NaN", Image(FOUR, affine(), (0, 1, 2)), **{
    **frame_list(), "keys": (), "space_directions": directions(AXES["identity"], "(nan,nan,nan)")})
equal("a list with spacings beside it", Image(FOUR, affine(), (0, 0.5, 1), warns=ANY), [refused("spacing")],
      **{**frame_list(), "keys": ()}, spacings="nan nan nan 0.5")
equal("index values not equally spaced", Image(FOUR, affine(), (1, 2, 5)),
      **{**frame_list(), "keys": {"axis 3 index type": "numeric", "axis 3 index values": "1 2 5"}})
equal("index values of two frames for three", Image(FOUR, affine(), (0, 1, 2), warns="index"),
      **{**frame_list(), "keys": {"axis 3 index type": "numeric", "axis 3 index values": "1 2"}})
equal("index values that are texts", Image(FOUR, affine(), (0, 1, 2), warns=ANY),
      **{**frame_list(), "keys": {"axis 3 index type": "text", "axis 3 index values": "a b c"}})
refuse("index values that decrease", "index|time|increase", FOUR,
       **{**frame_list(), "keys": {"axis 3 index type": "numeric", "axis 3 index values": "3 2 1"}})
equal("the kind time for a list", FRAMES, [Image(FOUR, affine(), (0, 1, 2), warns=ANY), refused("time|kind|list")],
      **{**frame_list(), "kinds": "domain domain domain time"})
equal("no kinds, none for the last axis", FRAMES, [Image(FOUR, affine(), (0, 1, 2), warns=ANY),
                                                   refused("kind|list|none|components")],
      **{**frame_list(), "kinds": None})
equal("time as the first axis of four", FRAMES, [refused("time")], array=np.moveaxis(FOUR, 0, 3), **{
    **space_time(), "space_directions": "(0,0,0,0.5) (0.5,0,0,0) (0,1.25,0,0) (0,0,2,0)"})
refuse("time runs backwards", "time|direction", FOUR, **{
    **space_time(), "space_directions": "(0.5,0,0,0) (0,1.25,0,0) (0,0,2,0) (0,0,0,-0.5)"})
refuse("time mixed with space", "time|direction", FOUR, **{
    **space_time(), "space_directions": "(0.5,0,0,0) (0,1.25,0,0) (0,0,2,1) (0,0,0,0.5)"})
refuse("frames that move", "time|direction", FOUR, **{
    **space_time(), "space_directions": "(0.5,0,0,0) (0,1.25,0,0) (0,0,2,0) (1,0,0,0.5)"})
for kind, count in (("vector", 3), ("RGB-color", 3), ("RGBA-color", 4), ("complex", 2), ("3-vector", 3),
                    ("covariant-vector", 3), ("3D-matrix", 9), ("stub", 1)):
    refuse("components of the kind %s" % kind, "component|kind|" + kind,
           voxels("u1", frames=count).transpose(1, 2, 3, 0),
           **{**frame_list(0), "kinds": kind + " domain domain domain", "keys": ()}) if count > 1 else None
equal("an axis of one, kind stub", IMAGE, [refused("kind|stub|component")], array=I2[..., None],
      **{**frame_list(0), "kinds": "stub domain domain domain", "keys": ()})
refuse("2D", "dimension|slice|axes", I2[0], space_directions="(1,0,0) (0,1,0)", space="left-posterior-superior",
       space_origin="(0,0,0)")
refuse("5 axes", "dimension|axes|component", voxels("i2", frames=4).reshape(2, 2, *I2.shape),
       kinds="domain domain domain list list",
       space="left-posterior-superior", space_directions=directions(AXES["identity"], "none", "none"),
       space_origin="(0,0,0)")
equal("16 axes", dimension=16, sizes="5 4 3" + 13 * " 1", kinds=None,
      space_directions=directions(AXES["identity"], *["none"] * 13))
refuse("17 axes", "dimension|axes", dimension=17, sizes="5 4 3" + 14 * " 1",
       space_directions=directions(AXES["identity"], *["none"] * 14))

# Sizes and places that are none
for sizes in ("5 0 3", "5 -4 3", "-5 -4 3", "0 0 0"):
    refuse("sizes %s" % sizes, "size|voxels", sizes=sizes)
for sizes in ("5 4", "5 4 3 1", "5 4 x", "", "5 4 3.5"):
    refuse("sizes '%s' of three" % sizes, "size", sizes=sizes)
for sizes in ("3000 3000 3000", "5 4 4", "4294967296 4294967296 4294967296", "99999999999999999999999999 1 1"):
    for encoding in ("raw", "gzip", "ascii", "hex"):
        refuse("claims %s, %s" % (sizes, encoding), ".", encoding=encoding, sizes=sizes, is_broken=True)
refuse("claims frames", ".", FOUR, **frame_list(), sizes="5 4 3 100000000", is_broken=True)
for dimension in ("0", "-3", "x", "", "3.5", "100000"):
    refuse("dimension '%s'" % dimension, "dimension", dimension=dimension)
for spacing in ("0", "nan", "inf", "x", "-1"):
    refuse("spacing %s" % spacing, "spacing", **PLAIN, spacings="1 %s 1" % spacing)
refuse("two spacings of three", "spacing", **PLAIN, spacings="1 1")
for part in ("nan", "inf", "1e40", "x"):
    refuse("%s in a vector" % part, "direction|vector|finite|number|large|spacing",
           space_directions="(1,0,0) (0,%s,0) (0,0,1)" % part)
    refuse("%s in the origin" % part, "origin|position|finite|number|large", space_origin="(0,%s,0)" % part)
refuse("a vector of zeros", "direction|length|independent|spacing|singular", space_directions="(1,0,0) (0,0,0) (0,0,1)")
refuse("two equal vectors", "independent|singular|direction", space_directions="(1,1,0) (1,1,0) (0,0,1)")
refuse("vectors in a plane", "independent|singular|direction", space_directions="(1,2,3) (4,5,6) (7,8,9)")
refuse("an origin of two numbers", "origin", space_origin="(0,0)")

# Skipping
for encoding in ("raw", "ascii", "hex"):
    equal("line skip 2, %s" % encoding, encoding=encoding, line_skip=2, before=b"one\ntwo\n", file="i.nhdr",
          data="i.dat")
    equal("byte skip 7, %s" % encoding, encoding=encoding, byte_skip=7, before=b"1 23 45", file="i.nhdr", data="i.dat")
    equal("line and byte skip, %s" % encoding, encoding=encoding, line_skip=1, byte_skip=3, before=b"one\n123",
          file="i.nhdr", data="i.dat")
equal("line skip 1, gzip", encoding="gzip", line_skip=1, before=b"one\n", file="i.nhdr", data="i.dat")
equal("byte skip 5 within gzip", encoding="gzip", byte_skip=5, file="i.nhdr", data="i.dat",
      wrap=lambda f: f.with_data(gzipped(b"12345" + raw(I2)), "i.dat"))
equal("byte skip -1", byte_skip=-1, before=b"anything", file="i.nhdr", data="i.dat")
equal("byte skip -1, nothing to skip", byte_skip=-1, file="i.nhdr", data="i.dat")
equal("byte skip -1, attached", byte_skip=-1, before=b"anything")
equal("line skip 1, attached", line_skip=1, before=b"anything\n")
refuse("byte skip -1, gzip", "byte ?skip|gzip", encoding="gzip", byte_skip=-1,
       wrap=lambda f: f.with_data(f.data()[:-20]), is_broken=True)
refuse("byte skip -1, too few bytes", ".", byte_skip=-1, file="i.nhdr", data="i.dat", is_broken=True,
       wrap=lambda f: f.with_data(raw(I2)[1:], "i.dat"))
refuse("byte skip -1, attached, a byte missing", ".", byte_skip=-1, is_broken=True, wrap=lambda f: f.with_data(f.data()[:-1]))
for skip in (0, -1):
    refuse("its header as data file, byte skip %d" % skip, "names itself", byte_skip=skip, file="i.nhdr", data="i.dat",
           wrap=lambda f: f.replaced(b"i.dat", b"i.nhdr"))
for skip in ("-2", "x", "1.5"):
    refuse("byte skip %s" % skip, "byte ?skip", byte_skip=skip, before=b"123")
refuse("line skip -1", "line ?skip", line_skip=-1)
refuse("line skip beyond the end", ".", line_skip=2 ** 62, is_broken=True)
refuse("byte skip beyond the end", ".", byte_skip=1000000, is_broken=True)
refuse("byte skip of 10^30", ".", byte_skip=10**30, is_broken=True)

# Files of voxels
def pieces(array, data_file, names, encoding="raw", order="<", count=None, **fields):
    """A header that refers to several files, each with a part of the voxels."""
    files = nrrd(array, "i.nhdr", encoding=encoding, order=order, data="i.dat", **fields)
    files.parts.pop("i.dat")
    files = files.replaced(b"data file: i.dat\n", b"data file: %s\n" % data_file.encode())
    parts = np.split(array, count or len(names))
    return files.beside({name: encode(part, encoding, order) for name, part in zip(names, parts)})


SLICES = ["s1.dat", "s2.dat", "s3.dat"]
LIST = "LIST\n" + "\n".join(SLICES)
for encoding in ("raw", "gzip", "ascii", "hex"):
    for name, data_file in (("LIST", LIST), ("LIST 2", "LIST 2\n" + "\n".join(SLICES)),
                            ("a pattern", "s%d.dat 1 3 1"), ("a pattern of 2 dimensions", "s%d.dat 1 3 1 2")):
        ROWS.append(row("NRRD", "%s, %s" % (name, encoding), pieces(I2, data_file, SLICES, encoding), IMAGE))
DOWN, WIDE = ["s3.dat", "s2.dat", "s1.dat"], ["s001.dat", "s003.dat", "s005.dat"]
ROWS += [
    row("NRRD", "a pattern that counts down", pieces(I2, "s%d.dat 3 1 -1", DOWN), IMAGE),
    row("NRRD", "a pattern with zeros and a step", pieces(I2, "s%03d.dat 1 5 2", WIDE), IMAGE),
    row("NRRD", "LIST in big endian", pieces(I2, LIST, SLICES, order=">"), IMAGE),
    row("NRRD", "LIST of frames", pieces(FOUR, LIST, SLICES, **frame_list()), FRAMES),
    row("NRRD", "LIST of frames, 3 dimensions", pieces(FOUR, "LIST 3\n" + "\n".join(SLICES), SLICES, **frame_list()),
        FRAMES),
    row("NRRD", "a pattern of frames", pieces(FOUR, "s%d.dat 1 3 1", SLICES, **frame_list()), FRAMES),
    row("NRRD", "LIST of slices of frames, 2 dimensions", pieces(
        FOUR.reshape(9, 4, 5), "LIST 2\n" + "\n".join("s%d.dat" % n for n in range(9)),
        ["s%d.dat" % n for n in range(9)],
        **{**frame_list(), "dimension": 4, "sizes": "5 4 3 3"}), FRAMES),
    row("NRRD", "LIST of one file for all", pieces(I2, "LIST 3\ns1.dat", ["s1.dat"]), IMAGE, refused("LIST|data file")),
    row("NRRD", "LIST with bytes to skip", pieces(I2, LIST, SLICES).replaced(
        b"data file",
        b"byte skip: 2\ndata file").beside({"s%d.dat" % (n + 1): b"xx" + raw(I2[n]) for n in range(3)}), IMAGE),
    row("NRRD", "LIST in a folder below", pieces(I2, LIST.replace("s", "d/s"),
                                                 ["d/" + s for s in SLICES]),
        IMAGE),
    row("NRRD", "LIST of two for three slices", pieces(I2, "LIST\ns1.dat\ns2.dat", SLICES),
        broken("data file|LIST|slices|2")),
    row("NRRD", "LIST of four for three slices", pieces(I2, "LIST\ns1.dat\ns2.dat\ns3.dat\ns1.dat", SLICES),
        refused("data file|LIST|slices|4")),
    row("NRRD", "LIST with a missing file", pieces(I2, "LIST\ns1.dat\ns2.dat\nnone.dat", SLICES), broken("none.dat")),
    row("NRRD", "LIST with a short file", pieces(I2, LIST, SLICES).with_data(b"x", "s2.dat"),
        broken("s2.dat")),
    row("NRRD", "LIST with a FIFO", pieces(I2, LIST, SLICES).with_data(Fifo(), "s2.dat"),
        refused("s2.dat")),
    *(row("NRRD", "files elsewhere: " + names.split("\n")[0], pieces(I2, names, SLICES), refused("folder of the header"))
      for names in ("LIST\n/etc/passwd\ns2.dat\ns3.dat", "/var/a%d.dat 1 3 1")),
    row("NRRD", "LIST and nothing else", pieces(I2, "LIST", SLICES), broken("data file|LIST|list")),
]
for pattern in ("%s%n.dat 1 3 1", "s%d.dat 1 3 0", "s%d.dat 3 1 1", "s%d.dat 1 1000000000 1", "s%d%d.dat 1 3 1",
                "s%999999999d.dat 1 3 1", "s%d.dat", "s%d.dat 1 x 1",
                "s%d.dat -9223372036854775808 9223372036854775807 1"):
    ROWS.append(row("NRRD", "the pattern %s" % pattern, pieces(I2, pattern, SLICES),
                    broken("pattern|data file|s%d|names")))

for data in ("data/i.dat", "./i.dat", "i dat.raw", "d/e/f/i.dat", "50%.raw", "100% done.raw", "5%n.raw 1 3 1"):
    equal("data file %s" % data, file="i.nhdr", data=data)
equal("data file of a header named .nrrd", file="i.nrrd", data="i.dat")
equal("voxels in a header named .nhdr", file="i.nhdr")
equal("datafile without a blank", file="i.nhdr", data="i.dat", wrap=lambda f: f.replaced(b"data file", b"datafile"))
equal("an empty line after data file", file="i.nhdr", data="i.dat", wrap=lambda f: f.with_data(f.data() + b"\n"))
data_files(equal, refuse, ": ", "i.dat", "i.nhdr", raw(I2), [("standard input", "-")])

# The content decides
refuse("gzipped as a whole", "compressed by gzip.*unpack it",
       wrap=lambda f: f.with_data(gzipped(f.data())).renamed("i.nrrd.gz"))
named(equal, ("i.nii", "i.nii.gz", "i.mha", "i.vtk", "i.mrc", "i", "i.dcm", "i.hdr", "i.NRRD", "i.seg.nrrd"),
      ("i.img", "i.hdr", "visu_pars", "i.raw"))

_MORE, _MORE_FRAMES = voxels("i2", shape=LARGER), voxels("i2", frames=3, shape=LARGER)
_HELD = Image(_MORE, affine())
SOUND = [Sound("NRRD", kind, nrrd(_MORE, encoding + ".nrrd", encoding=encoding), _HELD)
         for kind, encoding in (("raw", "raw"), ("gzip", "gzip"), ("text", "ascii"), ("text", "hex"))]
SOUND += [Sound("NRRD", kind, nrrd(_MORE, "i.nhdr", encoding=kind, data="i.dat"), _HELD, "i.dat")
          for kind in ("raw", "gzip")]
SOUND.append(Sound("NRRD", "raw", nrrd(_MORE_FRAMES, "frames.nrrd", **frame_list()),
                   Image(_MORE_FRAMES, affine(), times(3))))
