# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""VTK's legacy files of structured points, and its XML files of images (VTK User's Guide, file formats).

They name no directions of the body; their coordinates are taken as LPS.
"""
import base64
import lzma
import re
import struct
import zlib

import numpy as np

from .images import AXES, LARGER, ORDERS, ORIGIN, SPACING, TYPES, affine, combinations, raw, text, title, voxels
from .rows import ANY, Files, Image, Sound, named, refused, row

LEGACY_TYPES = {"u1": ("unsigned_char",), "i1": ("char", "signed_char"), "u2": ("unsigned_short",), "i2": ("short",),
                "u4": ("unsigned_int",), "i4": ("int",), "u8": ("unsigned_long", "vtktypeuint64"),
                "i8": ("long", "vtktypeint64"), "f4": ("float",), "f8": ("double",)}
XML_TYPES = {"u1": "UInt8", "i1": "Int8", "u2": "UInt16", "i2": "Int16", "u4": "UInt32", "i4": "Int32", "u8": "UInt64",
             "i8": "Int64", "f4": "Float32", "f8": "Float64"}

# ----- legacy files


def scalars(array, form, name="Labels", type=None, components="", table="default"):
    return b"SCALARS %s %s%s\nLOOKUP_TABLE %s\n%s\n" % (
        name.encode(), (type or LEGACY_TYPES[array.dtype.str[1:]][0]).encode(), components.encode(), table.encode(),
        values(array, form))


def field(arrays, form):
    """arrays: (name, array) of each."""
    lines = b"".join(b"%s 1 %d %s\n%s\n" % (name.encode(), array.size, LEGACY_TYPES[array.dtype.str[1:]][0].encode(),
                                             values(array, form)) for name, array in arrays)
    return b"FIELD FieldData %d\n" % len(arrays) + lines


def values(array, form):
    return text(array).rstrip() if form == "ASCII" else raw(array, ">")


def legacy(array, form="BINARY", file="i.vtk", version="3.0", data=None, where="POINT_DATA", count=None, header=(),
           **options):
    """data: what follows POINT_DATA, instead of the array.

    header: lines that replace those that begin with the same word.
    """
    sizes = [n + (where == "CELL_DATA") for n in array.shape[::-1]]
    lines = ["# vtk DataFile Version %s" % version, "a title", form, "DATASET STRUCTURED_POINTS",
             "DIMENSIONS %d %d %d" % tuple(sizes), "SPACING %r %r %r" % tuple(map(float, SPACING)),
             "ORIGIN %r %r %r" % tuple(map(float, ORIGIN)), "%s %d" % (where, array.size if count is None else count)]
    for line in header:
        word = line.split(" ")[0]
        lines = [line if old.split(" ")[0] == word else old for old in lines]
    head = "".join(line + "\n" for line in lines).encode()
    body = scalars(array, form, **options) if data is None else data
    return Files(file, {file: head + body}, len(head) + body.find(b"default\n") + 8)


# ----- XML


def lz4(data):
    """A block of LZ4 that consists of literals."""
    rest = len(data) - 15
    if rest < 0:
        return bytes([len(data) << 4]) + data
    return bytes([0xF0]) + b"\xff" * (rest // 255) + bytes([rest % 255]) + data


COMPRESSORS = {None: None, "ZLib": zlib.compress, "LZ4": lz4, "LZMA": lzma.compress}


def encoded(array, order, compressor, header_type, as_base64, block=96):
    """A header with numbers of bytes, and the bytes; a block has whole numbers."""
    data, word = raw(array, order), order + {"UInt32": "I", "UInt64": "Q"}[header_type]
    code = base64.b64encode if as_base64 else bytes
    if compressor is None:
        return code(struct.pack(word, len(data)) + data)
    blocks = [data[at:at + block] for at in range(0, len(data), block)]
    squeezed = [COMPRESSORS[compressor](part) for part in blocks]
    numbers = [len(blocks), block, len(data) % block, *map(len, squeezed)]
    return code(b"".join(struct.pack(word, number) for number in numbers)) + code(b"".join(squeezed))


def vti(array, file="i.vti", order="<", form="binary", compressor=None, header_type="UInt32", steps=None,
        where="PointData", start=(0, 0, 0), attributes="", more=b"", type=None, whole=None, piece=None):
    """form: ascii, binary, raw (appended) or base64 (appended). more: further arrays."""
    steps = AXES["identity"] if steps is None else steps
    spacing = np.linalg.norm(steps, axis=0)
    last = [s + n - (where == "PointData") for s, n in zip(start, array.shape[::-1])]
    extent = " ".join("%d %d" % pair for pair in zip(start, last))
    # The origin is that of the index 0.
    origin = ORIGIN - np.asarray(steps) @ start
    body = {"ascii": lambda: text(array), "raw": bytes, "base64": bytes,
            "binary": lambda: encoded(array, order, compressor, header_type, True)}[form]()
    appended = form in ("raw", "base64")
    tag = '<DataArray type="%s" Name="Labels" format="%s"%s%s>' % (
        type or XML_TYPES[array.dtype.str[1:]], "appended" if appended else form, ' offset="0"' if appended else "",
        attributes)
    head = ('<?xml version="1.0"?>\n<VTKFile type="ImageData" version="1.0" byte_order="%s" header_type="%s"%s>\n'
            '<ImageData WholeExtent="%s" Origin="%s" Spacing="%s" Direction="%s">\n<Piece Extent="%s">\n'
            '<%s Scalars="Labels">\n%s' % (
                {"<": "LittleEndian", ">": "BigEndian"}[order], header_type,
                ' compressor="vtk%sDataCompressor"' % compressor if compressor else "", whole or extent,
                numbers(origin), numbers(spacing), numbers(np.asarray(steps) / spacing), piece or extent, where,
                tag)).encode()
    tail = b"</DataArray>\n%s</%s>\n</Piece>\n</ImageData>\n" % (more, where.encode())
    if appended:
        data = encoded(array, order, compressor, header_type, form == "base64")
        tail += b'<AppendedData encoding="%s">\n_%s\n</AppendedData>\n' % (form.encode(), data)
    return Files(file, {file: head + body + tail + b"</VTKFile>\n"}, len(head))


def numbers(array):
    return " ".join(repr(float(number)) for number in np.ravel(array))


# ----- rows

ROWS = []
I2, U1 = voxels("i2"), voxels("u1")
IMAGE = Image(I2, affine())
# Voxels of cells lie in their middles.
CELLS = affine(origin=ORIGIN + 0.5 * SPACING)
LABELS, OTHER = I2, (I2[::-1].astype("f4") / 7)


def equal(name, image=IMAGE, also=(), wrap=lambda files: files, **options):
    ROWS.append(row("VTK legacy", name, wrap(legacy(image.voxels, **options)), image, *also))


def refuse(name, words, array=I2, wrap=lambda files: files, is_broken=False, **options):
    ROWS.append(row("VTK legacy", name, wrap(legacy(array, **options)), refused(words, is_broken)))


for case in combinations(type=[(t, name) for t, names in LEGACY_TYPES.items() for name in names],
                         form=("ASCII", "BINARY"),
                         version=("2.0", "3.0", "4.2", "5.1"), where=("POINT_DATA", "CELL_DATA")):
    cells = case["where"] == "CELL_DATA"
    equal(title(case), Image(voxels(case["type"][0]), CELLS if cells else affine()), [refused("cell")] if cells else [],
          form=case["form"], version=case["version"], where=case["where"], type=case["type"][1])
for form in ("ASCII", "BINARY"):
    two = scalars(LABELS, form) + scalars(OTHER, form, "Other")
    equal("two arrays of points, %s" % form, Image(I2, affine(), warns=ANY), [refused("arrays|several")], form=form,
          data=two)
    equal("two arrays of points, the labels last, %s" % form, Image(OTHER, affine(), warns=ANY),
          [refused("arrays|several")], form=form, data=scalars(OTHER, form, "Other") + scalars(LABELS, form))
    equal("two arrays of cells, %s" % form, Image(I2, CELLS, warns=ANY), [refused("arrays|several|cell")], form=form,
          data=two, where="CELL_DATA")
    equal("a field of one array, %s" % form, form=form, data=field([("Labels", LABELS)], form))
    equal("a field of two arrays, %s" % form, Image(I2, affine(), warns=ANY), [refused("arrays|several")], form=form,
          data=field([("Labels", LABELS), ("Other", OTHER)], form))
    equal("scalars and a field, %s" % form, Image(I2, affine(), warns=ANY), form=form,
          data=scalars(LABELS, form) + field([("Other", OTHER)], form))
    equal("points and cells, %s" % form, Image(I2, affine(), warns=ANY), [refused("arrays|several|cell")], form=form,
          data=scalars(LABELS, form) + b"CELL_DATA 24\n" + scalars(np.arange(24, dtype="i2").reshape(2, 3, 4), form,
                                                                   "Other"))
    equal("a lookup table, %s" % form, Image(I2, affine(), warns=ANY), form=form,
          data=scalars(LABELS, form, table="t") +
          b"LOOKUP_TABLE t 2\n" + (b"0 0 0 1 1 1 1 1\n" if form == "ASCII" else bytes(8)))
    for components in (" 2", " 3", " 4"):
        refuse("scalars of%s components, %s" % (components, form), "component|values", form=form, components=components,
               data=scalars(
            np.stack([I2] * int(components)), form, components=components))
    refuse("vectors, %s" % form, "component|vector|scalars|no ", form=form,
           data=b"VECTORS v short\n" + values(np.stack([I2] * 3), form) + b"\n")
    refuse("no data, %s" % form, "scalars|no |values", form=form, data=b"", is_broken=True)
    equal("METADATA, %s" % form, form=form, version="5.1", data=scalars(LABELS, form) + b"METADATA\nINFORMATION 0\n\n")
# Written with 32 bits, and read with 64 where VTK has such.
equal("vtkIdType", Image(voxels("i4"), affine(), any_integer=True), [refused("vtkIdType")], type="vtkIdType")
equal("1 component", components=" 1")
equal("ASPECT_RATIO", wrap=lambda f: f.replaced(b"SPACING", b"ASPECT_RATIO"))
equal("ORIGIN before SPACING", wrap=lambda f: f.replaced(b"ORIGIN 10.0 -20.0 30.0\n", b"").replaced(
    b"SPACING", b"ORIGIN 10.0 -20.0 30.0\nSPACING"))
equal("lower case", wrap=lambda f: f.replaced(b"DATASET STRUCTURED_POINTS", b"dataset structured_points").replaced(
    b"DIMENSIONS", b"dimensions"))
equal("carriage returns", form="ASCII", wrap=lambda f: f.with_data(f.data().replace(b"\n", b"\r\n")))
equal("numbers in lines", form="ASCII", wrap=lambda f: f.replaced(text(I2).rstrip(), text(I2, "\n").rstrip()))
equal("no spacing and origin", Image(I2, affine(np.eye(3), (0, 0, 0)), warns=ANY), [refused("spacing")],
      wrap=lambda f: f.with_data(
    f.data().replace(b"SPACING 0.5 1.25 2.0\nORIGIN 10.0 -20.0 30.0\n", b"")))
equal("a title of 255 characters", wrap=lambda f: f.replaced(b"a title", b"t" * 255))
for kind in ("STRUCTURED_GRID", "UNSTRUCTURED_GRID", "POLYDATA", "RECTILINEAR_GRID", "FIELD"):
    refuse("DATASET %s" % kind, "DATASET|%s|image|structured points" % kind, header=["DATASET %s" % kind])
for sizes in ("5 0 3", "5 -4 3", "-5 -4 3", "0 0 0"):
    refuse("DIMENSIONS %s" % sizes, "DIMENSIONS|size|voxels|dimension", header=["DIMENSIONS " + sizes])
for sizes in ("5 4", "5 4 x", "5 4 3.5"):
    refuse("DIMENSIONS '%s'" % sizes, "DIMENSIONS|size|dimension|VTK does not read", header=["DIMENSIONS " + sizes])
equal("one slice", Image(voxels("i2", shape=(1, 4, 5)), affine()), [refused("slice|dimension")])
for sizes, count in (("3000 3000 3000", 27000000000), ("5 4 4", 80), ("2147483647 2147483647 2147483647", 60),
                     ("5 4 4", 60), ("5 4 3", 80), ("5 4 3", 59), ("5 4 3", -1), ("5 4 3", 0)):
    for form in ("ASCII", "BINARY"):
        refuse("claims %s, %d values, %s" % (sizes, count, form), ".", form=form, header=["DIMENSIONS " + sizes],
               count=count, is_broken=True)
for spacing in ("0", "nan", "inf", "-1"):
    refuse("SPACING %s" % spacing, "spacing", header=["SPACING 1 %s 1" % spacing])
for part in ("nan", "inf"):
    refuse("ORIGIN %s" % part, "origin|position|finite|number", header=["ORIGIN 1 %s 1" % part])
for name in ("string", "bit", "variant", "complex", "x" * 5000):
    refuse("type %s" % name[:10], "type|array|header|" + name[:10], type=name, is_broken=name == "bit")
for name, line in (("DATASET", b"DATASET STRUCTURED_POINTS\n"), ("DIMENSIONS", b"DIMENSIONS 5 4 3\n"),
                   ("POINT_DATA", b"POINT_DATA 60\n")):
    refuse("no %s" % name, ".", is_broken=True, wrap=lambda f, line=line: f.replaced(line, b""))
for word in ("DATASET", "DIMENSIONS", "SPACING", "POINT_DATA"):
    refuse("a word of 5000 characters after %s" % word, ".", is_broken=True, header=[word + " " + "x" * 5000])
refuse("a title of 5000 characters", ".", is_broken=True, wrap=lambda f: f.replaced(b"a title", b"t" * 5000))
refuse("neither ASCII nor BINARY", ".", is_broken=True, wrap=lambda f: f.replaced(b"\nBINARY\n", b"\nMORSE\n"))
for word in (b"x", b"3.5", b"70000"):
    refuse("text with %s" % word.decode(), ".", form="ASCII", is_broken=True, wrap=lambda f, word=word: f.replaced(
        text(I2).rstrip(), word + b" " + text(I2[1:]) + text(I2[0]).rpartition(b" ")[0]))
named(equal, ("i.nii", "i.nrrd", "i.mrc", "i", "i.VTK", "i.vti"))


def xml_equal(name, image=IMAGE, also=(), wrap=lambda files: files, **options):
    ROWS.append(row("VTK XML", name, wrap(vti(image.voxels, **options)), image, *also))


def _interrupted(data, letter):
    """With a letter amid the first array in base64."""
    start = re.search(rb'format="binary">\s*|encoding="base64">\s*_', data).end() + 20
    return data[:start] + letter + data[start:]


def xml_refuse(name, words, array=I2, wrap=lambda files: files, is_broken=False, **options):
    ROWS.append(row("VTK XML", name, wrap(vti(array, **options)), refused(words, is_broken)))


for case in combinations(type=TYPES, order=ORDERS, form=("ascii", "binary", "raw", "base64"), compressor=COMPRESSORS,
                         header_type=("UInt32", "UInt64"), axes=AXES, where=("PointData", "CellData")):
    steps, cells = AXES[case["axes"]], case["where"] == "CellData"
    origin = ORIGIN + steps @ (0.5, 0.5, 0.5) if cells else ORIGIN
    xml_equal(title(case), Image(voxels(case["type"]), affine(steps, origin)), [refused("cell")] if cells else [],
              order=case["order"], form=case["form"], compressor=case["compressor"], header_type=case["header_type"],
              steps=steps, where=case["where"])
xml_equal("an extent that begins at (2, -1, 7)", start=(2, -1, 7))
xml_equal("the same, oblique", Image(I2, affine(AXES["oblique"])), start=(2, -1, 7), steps=AXES["oblique"])
xml_equal("no direction",
          wrap=lambda f: f.with_data(f.data().replace(b' Direction="1.0 0.0 0.0 0.0 1.0 0.0 0.0 0.0 1.0"', b"")))
xml_equal("no scalars marked", wrap=lambda f: f.replaced(b' Scalars="Labels"', b""),
          also=[Image(I2, affine(), warns=ANY)])
SECOND = b'<DataArray type="UInt8" Name="Other" format="ascii">' + text(U1) + b"</DataArray>\n"
xml_equal("two arrays, scalars marked", Image(I2, affine(), warns=ANY), more=SECOND)
xml_equal("two arrays, none marked", Image(I2, affine(), warns=ANY), [refused("arrays|several")], more=SECOND,
          wrap=lambda f: f.replaced(b' Scalars="Labels"', b""))
xml_equal("a comment, and blanks", wrap=lambda f: f.replaced(b"<Piece", b"<!-- a --> \n\n<Piece"))
xml_refuse("3 components", "component", attributes=' NumberOfComponents="3"', wrap=lambda f: vti(
    np.stack([I2] * 3, axis=-1).reshape(9, 4, 5), attributes=' NumberOfComponents="3"', whole="0 4 0 3 0 2",
    piece="0 4 0 3 0 2"))
for kind in ("PolyData", "UnstructuredGrid", "RectilinearGrid", "StructuredGrid", "vtkMultiBlockDataSet"):
    xml_refuse("type %s" % kind, "type|image|" + kind, wrap=lambda f, kind=kind: f.with_data(
        f.data().replace(b"ImageData", kind.encode())))
for extent in ("0 -1 0 3 0 2", "0 4 0 -5 0 2", "0 4 0 3"):
    xml_refuse("extent %s" % extent, "extent|size|voxels|dimension", whole=extent, piece=extent, is_broken=True)
for extent in ("0 2999 0 2999 0 2999", "0 4 0 3 0 3", "0 2147483646 0 2147483646 0 2147483646"):
    for form in ("ascii", "binary", "raw"):
        xml_refuse("claims %s, %s" % (extent, form), ".", whole=extent, piece=extent, form=form, is_broken=True)
xml_refuse("pieces smaller than the whole", ".", whole="0 4 0 3 0 5", is_broken=True)
xml_refuse("pieces larger than the whole", ".", whole="0 4 0 3 0 1", is_broken=True)
for value in ("0.0", "nan", "inf", "-1.25"):
    xml_refuse("spacing %s" % value, "spacing", wrap=lambda f,
               value=value: f.replaced(b'Spacing="0.5 1.25', b'Spacing="0.5 ' + value.encode()))
for value in ("nan", "inf"):
    xml_refuse("origin %s" % value, "origin|position|finite|number", wrap=lambda f, value=value: f.replaced(
        b'Origin="10.0', b'Origin="' + value.encode()))
for matrix in (9 * "0 ", "1 1 0 1 1 0 0 0 1", "nan 0 0 0 1 0 0 0 1", "1 2 3 4 5 6 7 8 9"):
    xml_refuse("direction %s" % matrix.strip(), "direction|axes|independent|singular|finite|number|length",
               wrap=lambda f, matrix=matrix: f.with_data(f.data().replace(
                   b'Direction="1.0 0.0 0.0 0.0 1.0 0.0 0.0 0.0 1.0"', b'Direction="%s"' % matrix.encode())))
for name in ("String", "Complex", "x" * 5000):
    xml_refuse("data type %s" % name[:10], ".", type=name, is_broken=True)
xml_refuse("an array of texts", "String", type="String", wrap=lambda f: f.with_data(f.data().replace(b"DataArray", b"Array")))
for count in (-1, 0, 10 ** 9):
    xml_refuse("%d components" % count, "NumberOfComponents", attributes=' NumberOfComponents="%d"' % count, is_broken=True)
xml_refuse("10^9 texts", "NumberOfTuples", is_broken=True, wrap=lambda f: f.replaced(
    b"<Piece", b'<FieldData><Array type="String" Name="a" NumberOfTuples="1000000000" format="ascii">1</Array></FieldData><Piece'))
for where, letter in (("in the middle", b"\n"), ("in the middle", b" "), ("in the middle", b"*")):
    for form in ("binary", "base64"):
        xml_refuse("%r %s, %s" % (letter.decode(), where, form), "base64", form=form, wrap=lambda f, letter=letter: f.with_data(
            _interrupted(f.data(), letter)))
for value, type in ((b"300", "u1"), (b"-1", "u1"), (b"40000", "i2")):
    xml_refuse("%s as text of %s" % (value.decode(), type), "smaller type", array=voxels(type), form="ascii",
               wrap=lambda f, value=value: f.with_data(re.sub(rb'(format="ascii">\s*)-?\d+', rb"\g<1>" + value, f.data())))
for tag, type in (("DataArray", ' type="Foo"'), ("DataArray", ""), ("Array", ' type="Variant"')):
    xml_refuse("field data of type%s" % (type or " none"), "type=", wrap=lambda f, tag=tag, type=type: f.replaced(
        b"<Piece", ('<FieldData><%s%s Name="a" NumberOfTuples="1" format="ascii">1</%s></FieldData><Piece' % (
            tag, type, tag)).encode()))
xml_equal("attributes in another order", wrap=lambda f: f.replaced(
    b'type="ImageData" version="1.0" byte_order="LittleEndian" header_type="UInt32"',
    b'byte_order="LittleEndian" header_type = "UInt32" type = "ImageData" version="1.0"'))
xml_refuse("a document type", "document type", wrap=lambda f: f.replaced(b"<VTKFile", b"<!DOCTYPE VTKFile>\n<VTKFile"))
xml_refuse("a compressor that there is not", ".", is_broken=True, wrap=lambda f: f.replaced(
    b"header_type", b'compressor="vtkRarDataCompressor" header_type'))
for blocks in (1 << 31, (1 << 32) - 1, 1000):
    xml_refuse("claims %d blocks" % blocks, ".", compressor="ZLib", form="raw", is_broken=True,
               wrap=lambda f, blocks=blocks: f.replaced(b"_" + struct.pack("<3I", 2, 96, 24),
                                                        b"_" + struct.pack("<3I", blocks, 96, 24)))
for size in (1 << 31, (1 << 32) - 1, 50):
    xml_refuse("claims blocks of %d bytes" % size, ".", compressor="ZLib", form="raw", is_broken=True,
               wrap=lambda f, size=size: f.replaced(b"_" + struct.pack("<3I", 2, 96, 24),
                                                    b"_" + struct.pack("<3I", 2, size, 24)))
for offset in ("100000", "-1", "x"):
    xml_refuse("offset %s" % offset, ".", form="raw", is_broken=True,
               wrap=lambda f, offset=offset: f.replaced(b'offset="0"', b'offset="%s"' % offset.encode()))
xml_refuse("claims more bytes", ".", form="raw", is_broken=True,
           wrap=lambda f: f.replaced(b"_" + struct.pack("<I", 120), b"_" + struct.pack("<I", 4000000000)))
xml_refuse("entities of entities", ".", is_broken=True, wrap=lambda f: f.replaced(
    b"<VTKFile", b'<!DOCTYPE x [<!ENTITY a0 "aaaaaaaaaa">' + b"".join(
        b'<!ENTITY a%d "%s">' % (n, 10 * (b"&a%d;" % (n - 1))) for n in range(1, 12)) + b']>\n<VTKFile').replaced(
            b"</Piece>", b"&a11;</Piece>"))
xml_refuse("nested elements", ".", is_broken=True, wrap=lambda f: f.replaced(b"<Piece", 200000 * b"<a>" + b"<Piece"))
for word in (b"x", b"3.5", b"70000"):
    xml_refuse("text with %s" % word.decode(), ".", form="ascii", is_broken=True, wrap=lambda f, word=word: f.replaced(
        text(I2), word + b" " + text(I2[1:]) + text(I2[0]).rpartition(b" ")[0]))
named(xml_equal, ("i.nii", "i.nrrd", "i.xml", "i.vtk", "i", "i.VTI"))

_MORE = voxels("i2", shape=LARGER)
_HELD = Image(_MORE, affine())
SOUND = [Sound("VTK legacy", "raw", legacy(_MORE), _HELD), Sound("VTK legacy", "text", legacy(_MORE, "ASCII"), _HELD)]
SOUND += [Sound("VTK XML", "xml", vti(_MORE, form=form, compressor=compressor, file="%s.vti" % form), _HELD)
          for form, compressor in (("ascii", None), ("binary", "ZLib"), ("raw", None), ("base64", "LZ4"))]
