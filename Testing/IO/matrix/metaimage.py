# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""MetaImage, from the documentation of MetaIO (itk.org/Wiki/MetaIO/Documentation)."""
import zlib

import numpy as np

from .images import (AXES, FIRST_TIME, LARGER, ORDERS, ORIGIN, SPACING, TIME_STEP, TYPES, affine, combinations, raw,
                     text, times, title, voxels)
from .rows import ANY, Fifo, Files, Image, Sound, broken, data_files, named, refused, row

ELEMENTS = {"u1": ("MET_UCHAR",), "i1": ("MET_CHAR",), "u2": ("MET_USHORT",), "i2": ("MET_SHORT",),
            "u4": ("MET_UINT", "MET_ULONG"), "i4": ("MET_INT", "MET_LONG"), "u8": ("MET_ULONG_LONG",),
            "i8": ("MET_LONG_LONG",), "f4": ("MET_FLOAT",), "f8": ("MET_DOUBLE",)}


def metaimage(array, file="i.mha", order="<", form="raw", steps=None, origin=None, data=None, before=b"",
              **fields):
    """form: raw, zlib or text. data: the name of a file for the voxels, which before precedes."""
    steps, origin = AXES["identity"] if steps is None else steps, ORIGIN if origin is None else origin
    spacing = list(np.linalg.norm(steps, axis=0))
    matrix, origin = np.asarray(steps) / spacing, list(origin)
    if array.ndim == 4:
        matrix = np.block([[matrix, np.zeros((3, 1))], [np.zeros((1, 3)), 1.0]])
        spacing, origin = spacing + [TIME_STEP], origin + [FIRST_TIME]
    voxel_data = {"raw": lambda: raw(array, order), "zlib": lambda: zlib.compress(raw(array, order)),
                  "text": lambda: text(array)}[form]()
    defaults = {
        "ObjectType": "Image", "NDims": array.ndim, "BinaryData": form != "text",
        "BinaryDataByteOrderMSB": order == ">",
        "CompressedData": form == "zlib", "CompressedDataSize": len(voxel_data) if form == "zlib" else None,
        # It lists the directions of the axes one after the other.
        "TransformMatrix": numbers(matrix.T), "Offset": numbers(origin), "ElementSpacing": numbers(spacing),
        "DimSize": " ".join(map(str, array.shape[::-1])), "ElementType": ELEMENTS[array.dtype.str[1:]][0]}
    fields = {**defaults, **fields, "ElementDataFile": "LOCAL" if data is None else data}
    header = "".join("%s = %s\n" % item for item in fields.items() if item[1] is not None).encode()
    if data is not None:
        folder = file.rpartition("/")[0]
        return Files(file, {file: header, (folder + "/" if folder else "") + data: before + voxel_data})
    return Files(file, {file: header + before + voxel_data}, len(header))


def numbers(values):
    return " ".join(repr(float(value)) for value in np.ravel(values))


# ----- rows

ROWS = []
I2, U1, FOUR = voxels("i2"), voxels("u1"), voxels("i2", frames=3)
IMAGE = Image(I2, affine())
OBLIQUE = Image(I2, affine(AXES["oblique"]))
FRAMES = Image(FOUR, affine(), times(3))
FORMS = ("raw", "zlib", "text")


def equal(name, image=IMAGE, also=(), wrap=lambda files: files, **options):
    ROWS.append(row("MetaImage", name, wrap(metaimage(image.voxels, **options)), image, *also))


def refuse(name, words, array=I2, wrap=lambda files: files, is_broken=False, **options):
    ROWS.append(row("MetaImage", name, wrap(metaimage(array, **options)), refused(words, is_broken)))


for case in combinations(type=TYPES, order=ORDERS, form=FORMS, axes=AXES, data=(None, "i.raw"), frames=(None, 3)):
    equal(title(case), Image(voxels(case["type"], case["frames"]), affine(AXES[case["axes"]]), times(3)),
          order=case["order"],
          form=case["form"], steps=AXES[case["axes"]], data=case["data"], file="i.mhd" if case["data"] else "i.mha")

# Types
for dtype, elements in ELEMENTS.items():
    for element in elements:
        equal(element, Image(voxels(dtype), affine()), ElementType=element)
equal("MET_ASCII_CHAR", Image(voxels("i1"), affine()), [refused("MET_ASCII_CHAR")], ElementType="MET_ASCII_CHAR")
for dtype, element in (("u1", "MET_UCHAR_ARRAY"), ("i2", "MET_SHORT_ARRAY"), ("f4", "MET_FLOAT_ARRAY")):
    equal(element, Image(voxels(dtype), affine()), [refused(element)], ElementType=element)
for element in ("MET_STRING", "MET_OTHER", "MET_NONE", "MET_FLOAT_MATRIX", "MET_HALF", "short", "", "MET_" + 300 * "X"):
    refuse("ElementType %s" % element[:20], "ElementType|type", ElementType=element)
for count in (2, 3, 0, -1):
    refuse("%d channels" % count, "channel|component|ElementNumberOfChannels", ElementNumberOfChannels=count,
           wrap=lambda f: f.with_data(f.data() + bytes(500)))
equal("1 channel", ElementNumberOfChannels=1)

# Fields and their other names
for name in ("TransformMatrix", "Rotation", "Orientation"):
    equal(name, OBLIQUE, **{"TransformMatrix": None, name: numbers((AXES["oblique"] / SPACING).T)})
for name in ("Offset", "Position", "Origin"):
    equal(name, **{"Offset": None, name: numbers(ORIGIN)})
for name in ("BinaryDataByteOrderMSB", "ElementByteOrderMSB"):
    for order in ORDERS:
        equal("%s, %s" % (name, order), order=order, **{"BinaryDataByteOrderMSB": None, name: order == ">"})
equal("neither of them", BinaryDataByteOrderMSB=None)
equal("ElementSize without ElementSpacing", ElementSpacing=None, ElementSize=numbers(SPACING), also=[
    Image(I2, affine(), warns=ANY)])
equal("ElementSize beside ElementSpacing", ElementSize="9 9 9")
equal("neither size nor spacing", Image(I2, affine(np.eye(3)), warns=ANY), [refused("spacing")], ElementSpacing=None)
equal("no matrix", TransformMatrix=None)
equal("no offset", Image(I2, affine(origin=(0, 0, 0)), warns=ANY), Offset=None)
equal("AnatomicalOrientation", AnatomicalOrientation="LPI", CenterOfRotation="9 9 9", Comment="x = y", ID=7, Name="a",
      ObjectSubType="Image", Modality="MET_MOD_CT", ElementMin=-9, ElementMax=9)
for unit, warns in (("mm", ""), ("um", "in micrometres"), ("cm", "in centimetres"), ("furlong", "in 'furlong'"), ("?", "")):
    equal("DistanceUnits %s" % unit, Image(I2, affine(), warns=warns and "its lengths are %s, and so is" % warns),
          DistanceUnits=unit)
equal("a field that is not known", MyField="x")
equal("a comment with the word of MRC", Image(voxels("i2", shape=LARGER), affine()),
      wrap=lambda f: f.with_data(b"Comment = ".ljust(208, b"x") + b"MAP\n" + f.data()))
equal("a name of a file with a %", file="i.mhd", data="50% done.raw")
equal("carriage returns", wrap=lambda f: f.with_data(f.data()[:f.header].replace(b"\n", b"\r\n") + f.data()[f.header:]))
equal("no blanks around =", wrap=lambda f: f.with_data(f.data()[:f.header].replace(b" = ", b"=") + f.data()[f.header:]),
      also=[refused("field|=|line")])
equal("words for truth", BinaryData="1", CompressedData="false", BinaryDataByteOrderMSB="False")
equal("CompressedData without its size", form="zlib", CompressedDataSize=None)
equal("CompressedData without its size, .zraw", form="zlib", CompressedDataSize=None, file="i.mhd", data="i.zraw")
equal("4D of one frame", Image(voxels("i2", frames=1)[0], affine()), wrap=lambda f: metaimage(voxels("i2", frames=1)))
equal("5D, the fifth of length 1", wrap=lambda f: metaimage(
    I2, NDims=5, DimSize="5 4 3 1 1", ElementSpacing="0.5 1.25 2 1 1", Offset="10 -20 30 0 0",
    TransformMatrix=numbers(np.eye(5))))
equal("ObjectType is missing", ObjectType=None, also=[refused("ObjectType|format|not an image")])

# HeaderSize
for form in FORMS:
    equal("HeaderSize 9, %s" % form, form=form, HeaderSize=9, before=b"123456789", file="i.mhd", data="i.raw")
equal("HeaderSize -1", HeaderSize=-1, before=b"anything", file="i.mhd", data="i.raw")
equal("HeaderSize -1, 4D", FRAMES, HeaderSize=-1, before=b"anything", file="i.mhd", data="i.raw")
equal("HeaderSize 0", HeaderSize=0, file="i.mhd", data="i.raw")
for size in ("-2", "x", "1.5", "99999999999999999999"):
    refuse("HeaderSize %s" % size, "HeaderSize|data|byte", HeaderSize=size, file="i.mhd", data="i.raw",
           is_broken=size[0] == "9")
refuse("HeaderSize beyond the end", ".", HeaderSize=100000, file="i.mhd", data="i.raw", is_broken=True)
refuse("HeaderSize -1, too few bytes", ".", HeaderSize=-1, file="i.mhd", data="i.raw", is_broken=True,
       wrap=lambda f: f.with_data(raw(I2)[1:], "i.raw"))

for form in FORMS:
    for size in (1, 40):
        refuse("HeaderSize %d of LOCAL, %s" % (size, form), "HeaderSize %d.*header" % size, HeaderSize=size, form=form)
equal("HeaderSize 1000 of LOCAL", HeaderSize=1000,
      wrap=lambda f: f.with_data(f.data()[:f.header].ljust(1000, b"x") + f.data()[f.header:]))
refuse("HeaderSize -1 of LOCAL, a byte missing", ".", HeaderSize=-1, is_broken=True, wrap=lambda f: f.with_data(f.data()[:-1]))
for size in (None, 0, 9, -1):
    for names in ("i.mhd", "LIST\ni.mhd", "i.mhd %d", "LIST\ns.raw\ns.raw\n./i.mhd"):
        refuse("its header as data file, %s, HeaderSize %s" % (names, size), "names itself|pattern|data file", HeaderSize=size,
               file="i.mhd", data="s.raw", wrap=lambda f, names=names: f.replaced(b"= s.raw", b"= %s" % names.encode()))


# Several files of voxels
def pieces(array, data_file, names, form="raw", order="<", file="i.mhd", **fields):
    files = metaimage(array, file, order, form, data="i.raw", **fields)
    files.parts.pop("i.raw")
    files = files.replaced(b"= i.raw\n", b"= %s\n" % data_file.encode())
    parts = {name: metaimage(part, "i.mhd", order, form, data="i.raw").data("i.raw")
             for name, part in zip(names, np.split(array, len(names)))}
    return Files(file, {**files.parts, **parts})


SLICES = ["s1.raw", "s2.raw", "s3.raw"]
LIST = "LIST\n" + "\n".join(SLICES)
for order in ORDERS:
    ROWS += [
        row("MetaImage", "LIST, %s" % order, pieces(I2, LIST, SLICES, order=order), IMAGE),
        row("MetaImage", "LIST 2, %s" % order, pieces(I2, "LIST 2\n" + "\n".join(SLICES), SLICES, order=order), IMAGE),
        row("MetaImage", "LIST of frames, %s" % order, pieces(FOUR, LIST, SLICES, order=order),
            FRAMES),
        row("MetaImage", "a pattern, %s" % order, pieces(I2, "s%d.raw 1 3 1", SLICES, order=order), IMAGE),
        row("MetaImage", "a pattern of frames, %s" % order, pieces(FOUR, "s%d.raw 1 3 1", SLICES, order=order), FRAMES)]
ROWS += [
    row("MetaImage", "LIST 3 of frames", pieces(FOUR, "LIST 3\n" + "\n".join(SLICES), SLICES), FRAMES),
    row("MetaImage", "LIST 2 of slices of frames", pieces(
        FOUR, "LIST 2\n" + "\n".join("s%d.raw" % n for n in range(9)), SLICES).beside({
            "s%d.raw" % n: raw(FOUR.reshape(9, 4, 5)[n]) for n in range(9)}), FRAMES),
    row("MetaImage", "a pattern with zeros and a step",
        pieces(I2, "s%03d.raw 1 5 2", ["s001.raw", "s003.raw", "s005.raw"]), IMAGE),
    row("MetaImage", "LIST in a folder below",
        pieces(I2, LIST.replace("s", "d/s"), ["d/" + s for s in SLICES]), IMAGE),
    row("MetaImage", "LIST in a .mha", pieces(I2, LIST, SLICES, file="i.mha"), IMAGE),
    row("MetaImage", "LIST of compressed files", pieces(I2, LIST, SLICES, form="zlib", CompressedDataSize=None), IMAGE,
        refused("LIST|compressed")),
    row("MetaImage", "LIST with bytes to skip", pieces(I2, LIST, SLICES, HeaderSize=2).beside(
        {"s%d.raw" % (n + 1): b"xx" + raw(I2[n]) for n in range(3)}), IMAGE),
    row("MetaImage", "LIST of two for three slices", pieces(I2, "LIST\ns1.raw\ns2.raw", SLICES),
        broken("data file|LIST|slices|2")),
    row("MetaImage", "LIST of four for three slices", pieces(I2, "LIST\ns1.raw\ns2.raw\ns3.raw\ns1.raw", SLICES),
        refused("data file|LIST|slices|4")),
    row("MetaImage", "LIST with a missing file", pieces(I2, "LIST\ns1.raw\ns2.raw\nnone.raw", SLICES),
        broken("none.raw")),
    row("MetaImage", "LIST with a short file", pieces(I2, LIST, SLICES).with_data(b"x", "s2.raw"), broken("s2.raw")),
    row("MetaImage", "LIST with a FIFO", pieces(I2, LIST, SLICES).with_data(Fifo(), "s2.raw"),
        refused("s2.raw")),
    *(row("MetaImage", "files elsewhere: " + names.split("\n")[0], pieces(I2, names, SLICES), refused("folder of the header"))
      for names in ("LIST\n/etc/passwd\ns2.raw\ns3.raw", "/var/a%d.raw 1 3 1")),
    row("MetaImage", "LIST and nothing else", pieces(I2, "LIST", SLICES), broken("data file|LIST|list")),
]
for pattern in ("%s%n.raw 1 3 1", "s%d.raw 1 3 0", "s%d.raw 3 1 1", "s%d.raw 1 1000000000 1", "s%d%d.raw 1 3 1",
                "s%999999999d.raw 1 3 1", "s%d.raw", "s%d.raw 1 x 1"):
    ROWS.append(row("MetaImage", "the pattern %s" % pattern, pieces(I2, pattern, SLICES),
                    broken("pattern|data file|s%d|names")))

for data in ("data/i.raw", "./i.raw", "i dat.raw", "d/e/f/i.raw"):
    equal("data file %s" % data, file="i.mhd", data=data)
equal("Local", wrap=lambda f: f.replaced(b"= LOCAL", b"= Local"), also=[broken()])
equal("lower case local", wrap=lambda f: f.replaced(b"= LOCAL", b"= local"), also=[broken()])
data_files(equal, refuse, "= ", "i.raw", "i.mhd", raw(I2))

# What is refused
refuse("2D", "dimension|NDims|slice", wrap=lambda f: metaimage(
    I2, NDims=2, DimSize="5 12", ElementSpacing="1 1", Offset="0 0", TransformMatrix="1 0 0 1"))
refuse("5D", "dimension|NDims", wrap=lambda f: metaimage(
    I2, NDims=5, DimSize="5 4 1 1 3", ElementSpacing="1 1 1 1 1", Offset="0 0 0 0 0",
    TransformMatrix=numbers(np.eye(5))))
for count in ("0", "-3", "many", "100000", "3.5", ""):
    refuse("NDims '%s'" % count, "dimension|NDims", NDims=count)
for sizes in ("5 0 3", "5 -4 3", "-5 -4 3", "0 0 0"):
    refuse("DimSize %s" % sizes, "DimSize|size|voxels", DimSize=sizes)
for sizes in ("5 4", "5 4 3 1", "5 4 x", "", "5 4 3.5"):
    refuse("DimSize '%s' of three" % sizes, "DimSize", DimSize=sizes)
for sizes in ("3000 3000 3000", "5 4 4", "4294967296 4294967296 4294967296", "99999999999999999999999999 1 1"):
    for form in FORMS:
        refuse("claims %s, %s" % (sizes, form), ".", form=form, DimSize=sizes, is_broken=True)
refuse("claims frames", ".", FOUR, DimSize="5 4 3 100000000", is_broken=True)
for size in ("-1", "x"):
    refuse("CompressedDataSize %s" % size, "Compressed", form="zlib", CompressedDataSize=size, is_broken=True)
refuse("raw voxels said to be compressed", ".", CompressedData=True, is_broken=True)
refuse("compressed text", ".", form="text", CompressedData=True, is_broken=True)
equal("claims more compressed bytes", form="zlib", CompressedDataSize=4000000000)
equal("compressed, with too many voxels", Image(I2[:2], affine()), form="zlib",
      wrap=lambda f: metaimage(I2, form="zlib", DimSize="5 4 2"))
for spacing in ("0", "nan", "inf", "x", "-1"):
    refuse("ElementSpacing %s" % spacing, "ElementSpacing|spacing", ElementSpacing="1 %s 1" % spacing)
refuse("two spacings of three", "ElementSpacing|spacing", ElementSpacing="1 1")
for part in ("nan", "inf", "1e40", "x"):
    refuse("%s in the matrix" % part, "TransformMatrix|direction|axes|finite|number|large|spacing|singular",
           TransformMatrix="1 0 0 0 %s 0 0 0 1" % part)
    refuse("%s in the offset" % part, "Offset|origin|position|finite|number|large", Offset="0 %s 0" % part)
for name, matrix in (("zeros", 9 * "0 "), ("equal axes", "1 1 0 1 1 0 0 0 1"), ("rank 2", "1 2 3 4 5 6 7 8 9"),
                     ("8 numbers", 8 * "1 ")):
    refuse("a matrix of %s" % name, "TransformMatrix|independent|singular|axes|length|direction",
           TransformMatrix=matrix)
refuse("a negative step of time", "time|spacing|ElementSpacing", FOUR, ElementSpacing="1 1 1 -1")
refuse("a step of time of 0", "time|spacing|ElementSpacing", FOUR, ElementSpacing="1 1 1 0")
refuse("time mixed with space", "time|TransformMatrix|direction", FOUR,
       TransformMatrix="1 0 0 0 0 1 0 0 0 0 1 1 0 0 0 1")
refuse("time runs backwards", "time|TransformMatrix|direction", FOUR,
       TransformMatrix="1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 -1")
for field in ("NDims", "DimSize", "ElementType"):
    refuse("no %s" % field, field + "|not an image", **{field: None})
refuse("no ElementDataFile", "ElementDataFile", is_broken=True,
       wrap=lambda f: f.with_data(f.data()[:f.header].replace(b"ElementDataFile = LOCAL\n", b"")))
for field, value in (("NDims", "3"), ("DimSize", "5 4 2"), ("ElementType", "MET_INT")):
    line = ("%s = %s\nElementDataFile" % (field, value)).encode()
    refuse("%s given twice" % field, field + "|twice|more than once",
           wrap=lambda f, line=line: f.replaced(b"ElementDataFile", line))
equal("DimSize before NDims", NDims=None,
       wrap=lambda f: f.replaced(b"ElementType", b"NDims = 3\nElementType"))
refuse("a line that is no field", "line|field|hello", wrap=lambda f: f.replaced(b"DimSize", b"hello\nDimSize"))
for kind in ("Tube", "Scene", "Mesh", "Transform"):
    refuse("ObjectType %s" % kind, "ObjectType|" + kind, ObjectType=kind)
for words, name in ((b"1 2 x 4 ", "a word"), (b"1 2 3.5 ", "a fraction"), (b"70000 ", "a number out of range")):
    refuse("text with %s" % name, ".", form="text", is_broken=True,
           wrap=lambda f, words=words: f.with_data(f.data()[:f.header] + words + f.data()[f.header:]))

named(equal, ("i.nii", "i.nrrd", "i.vtk", "i.mrc", "i", "i.dcm", "i.hdr", "i.MHA", "i.mhd"),
      ("i.img", "i.hdr", "visu_pars", "i.raw"))

_MORE = voxels("i2", shape=LARGER)
_HELD = Image(_MORE, affine())
SOUND = [Sound("MetaImage", form, metaimage(_MORE, form=form), _HELD) for form in FORMS]
SOUND += [Sound("MetaImage", form, metaimage(_MORE, "i.mhd", form=form, data="i.raw"), _HELD,
                "i.raw") for form in ("raw", "zlib")]
