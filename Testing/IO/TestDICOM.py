#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""DICOM: a row a case. pydicom writes the files, GDCM compresses them; voxels and places are those of the array."""
import os
import struct
import subprocess
import unittest
import zlib
from pathlib import Path

import numpy as np
import pydicom
from pydicom.dataset import Dataset, FileMetaDataset
from pydicom.encaps import decode_data_sequence, encapsulate
from pydicom.sequence import Sequence
from vtkmodules.util.numpy_support import vtk_to_numpy

import images
from iotesting import FolderTestCase, warnings_of

ROOT = "1.2.840.10008.5.1.4.1.1."
CT, MR, ENHANCED_CT, SECONDARY_CAPTURE, SEGMENTATION, LABEL_MAP = (
    ROOT + end for end in ("2", "4", "2.1", "7.2", "66.4", "66.7"))
IMPLICIT, EXPLICIT, DEFLATED, BIG_ENDIAN, RLE, JPEG, JPEG_LOSSLESS, JPEG_2000, MPEG = (
    "1.2.840.10008.1.2" + end for end in ("", ".1", ".1.99", ".2", ".5", ".4.50", ".4.70", ".4.90", ".4.100"))
SERIES = "1.2.826.0.1.3680043.2.1125.7"

ARRAY = np.random.default_rng(5).integers(0, 4, (5, 7, 9)).astype("<u2") * 257
OBLIQUE = images.Geometry((10.0, -20.0, 30.0), (0.5, 0.75, 2.0),
                          np.array([[0.8, 0.0, -0.6], [0.6, 0.0, 0.8], [0.0, -1.0, 0.0]]))
NORMAL = np.cross(OBLIQUE.direction[:, 0], OBLIQUE.direction[:, 1])
STEP = 2.0 * NORMAL
TILTED = STEP + 0.8 * OBLIQUE.direction[:, 1]


def numbers(values):
    return ["%.12g" % value for value in np.asarray(values, dtype=float) + 0.0]


def place(k, step=STEP):
    return np.asarray(OBLIQUE.origin) + k * np.asarray(step)


def assign(data, tags):
    """None takes an element away."""
    for name, value in tags.items():
        if value is None:
            data.pop(name, None)
        else:
            setattr(data, name, value)


def data_set(array, order="<", **tags):
    """What a file says of an array, with one place for it."""
    data = Dataset()
    data.SOPClassUID = CT if array.ndim == 2 else ENHANCED_CT
    data.SOPInstanceUID = SERIES + ".1"
    data.SeriesInstanceUID = SERIES
    data.ImagePositionPatient = numbers(place(0))
    data.ImageOrientationPatient = numbers([*OBLIQUE.direction[:, 0], *OBLIQUE.direction[:, 1]])
    data.PixelSpacing = numbers([OBLIQUE.spacing[1], OBLIQUE.spacing[0]])
    data.SamplesPerPixel = 1
    data.PhotometricInterpretation = "MONOCHROME2"
    data.Rows, data.Columns = array.shape[-2:]
    data.BitsAllocated = data.BitsStored = 8 * array.itemsize
    data.PixelRepresentation = int(array.dtype.kind == "i")
    data.PixelData = array.astype(array.dtype.newbyteorder(order)).tobytes()
    data.PixelData += b"\0" * (len(data.PixelData) % 2)
    data["PixelData"].VR = "OW"
    assign(data, tags)
    data.HighBit = tags.get("HighBit", data.BitsStored - 1)
    return data


def save(path, data, syntax=EXPLICIT, convert=None):
    """convert: arguments of gdcmconv."""
    data.file_meta = FileMetaDataset()
    data.file_meta.MediaStorageSOPClassUID = data.SOPClassUID
    data.file_meta.MediaStorageSOPInstanceUID = data.SOPInstanceUID
    data.file_meta.TransferSyntaxUID = syntax
    data.is_little_endian = syntax != BIG_ENDIAN
    data.is_implicit_VR = syntax == IMPLICIT
    pydicom.dcmwrite(path, data, write_like_original=False)
    if convert:
        subprocess.run(["gdcmconv", *convert, path, path], check=True, capture_output=True)
    return path


def write_series(folder, array=ARRAY, step=STEP, syntax=EXPLICIT, convert=None, places=None, change=None, **tags):
    """A slice a file, of which names and numbers say nothing. change(k, data) changes one."""
    folder = folder / "series"
    folder.mkdir()
    for k, image in enumerate(array):
        order = ">" if syntax == BIG_ENDIAN else "<"
        data = data_set(image, order, ImagePositionPatient=numbers(place(k, step) if places is None else places[k]),
                        SOPInstanceUID="%s.%d" % (SERIES, k + 1), InstanceNumber=(7 * k) % 5, **tags)
        if change:
            change(k, data)
        save(folder / ("%d.dcm" % ((3 * k) % len(array))), data, syntax, convert)
    return folder


def item(**tags):
    data = Dataset()
    assign(data, tags)
    return Sequence([data])


def write_frames(folder, array=ARRAY, step=STEP, syntax=EXPLICIT, convert=None, order=(3, 0, 4, 1, 2), change=None,
                 change_saved=None, **tags):
    """All slices in a file, in an order of no meaning. change(data) changes the data set."""
    data = data_set(array[list(order)], ">" if syntax == BIG_ENDIAN else "<", NumberOfFrames=len(order))
    for name in ("ImagePositionPatient", "ImageOrientationPatient", "PixelSpacing"):
        del data[name]
    orientation = numbers([*OBLIQUE.direction[:, 0], *OBLIQUE.direction[:, 1]])
    data.SharedFunctionalGroupsSequence = item(
        PlaneOrientationSequence=item(ImageOrientationPatient=orientation),
        PixelMeasuresSequence=item(PixelSpacing=numbers([OBLIQUE.spacing[1], OBLIQUE.spacing[0]]), SliceThickness="9"))
    data.PerFrameFunctionalGroupsSequence = Sequence(
        [item(PlanePositionSequence=item(ImagePositionPatient=numbers(place(k, step))))[0] for k in order])
    assign(data, tags)
    data.HighBit = tags.get("HighBit", data.BitsStored - 1)
    if change:
        change(data)
    path = save(folder / "frames.dcm", data, syntax, convert)
    if change_saved:
        data = pydicom.dcmread(path)
        change_saved(data)
        data.save_as(path)
    return path


def write_slice(folder, image=ARRAY[0], syntax=EXPLICIT, convert=None, edit=None, **tags):
    """One slice, with its thickness. edit(bytes) changes the file."""
    order = ">" if syntax == BIG_ENDIAN else "<"
    path = save(folder / "slice.dcm", data_set(image, order, **{"SliceThickness": "2", **tags}), syntax, convert)
    if edit:
        path.write_bytes(edit(path.read_bytes()))
    return path


def write_dose(folder, offsets=(0, 2, 4, 6, 8), **tags):
    data = data_set(ARRAY, SOPClassUID=ROOT + "481.2", NumberOfFrames=len(ARRAY),
        GridFrameOffsetVector=numbers(offsets),
                    DoseGridScaling="0.25", **tags)
    return save(folder / "dose.dcm", data)


def write_compressed(folder, frames, syntax, **tags):
    """One slice; its frames are compressed already."""
    data = data_set(np.zeros((8, 8), "u1"), SliceThickness="2", **tags)
    data.PixelData = encapsulate(frames)
    data["PixelData"].VR = "OB"
    data["PixelData"].is_undefined_length = True
    return save(folder / "slice.dcm", data, syntax)


def values(dtype, scale=1, offset=0):
    return (ARRAY.astype("i8") // 257 * scale + offset).astype(dtype)


def in_bits(array, low, others):
    """With the voxels from a bit on, and other bits around them."""
    rest = np.random.default_rng(8).integers(0, 1 << 16, array.shape) & others
    return ((array.astype("i8") << low) & ~others & 0xFFFF | rest).astype("<u2")


def as_old_file(data):
    """Without preamble and group 2."""
    start = data.index(struct.pack("<2H", 0x8, 0x16))
    return data[start:]


def segment(packed):
    """A run-length frame of 8 x 8 bytes."""
    return struct.pack("<16I", 1, 64, *[0] * 14) + packed


RUNS = bytes([193, 7])  # 64 times 7
FIVE = values("u1")
LARGE = np.tile(FIVE[0], (6, 6))  # gdcmconv fails where compression makes an image larger
SIGNED = values("<i2", 1000, -2000)
WIDE = values("<u4", 1 << 20)


def rescaled(slope, intercept):
    return {"RescaleSlope": slope, "RescaleIntercept": intercept}


def rescale_groups(k, slope):
    def change(data):
        data.PerFrameFunctionalGroupsSequence[k].PixelValueTransformationSequence = item(**rescaled(slope, "0"))
    return change


def filled_up(marker):
    """The first such marker of the pixels gets bytes before it, which its fragment makes room for."""
    def edit(data):
        begin = data.index(b"\xfe\xff\0\xe0", data.index(struct.pack("<2H", 0x7FE0, 0x10)))
        begin += 8 + struct.unpack_from("<I", data, begin + 4)[0]  # the table of offsets
        place, (length,) = data.index(marker, begin), struct.unpack_from("<I", data, begin + 4)
        return (data[:begin + 4] + struct.pack("<I", length + 2) + data[begin + 8:place] + b"\xff\xff" + data[place:])
    return edit


def in_fragments(data):
    """Two of each frame, and an empty table of offsets."""
    parts = [part for frame in decode_data_sequence(data.PixelData) for part in (frame[:40], frame[40:])]
    data.PixelData = b"".join(struct.pack("<2HI", 0xFFFE, 0xE000, len(part)) + part for part in [b"", *parts])


# name, writer, its options, and what is expected other than ARRAY at OBLIQUE: array, step
SOUND = (
    ("series", write_series, {}, {}),
    ("series of a gantry tilt", write_series, {"step": TILTED}, {"step": TILTED}),
    ("series that goes down", write_series, {"array": ARRAY[::-1], "places": [place(4 - k) for k in range(5)]}, {}),
    ("positions with little noise", write_series,
     {"places": [place(k) + (0, 0, 0.1 * (k == 2)) for k in range(5)]}, {}),
    ("implicit", write_series, {"syntax": IMPLICIT}, {}),
    ("deflated", write_series, {"syntax": DEFLATED}, {}),
    ("big endian", write_series, {"syntax": BIG_ENDIAN}, {}),
    ("big endian, one byte in words", write_series,
     {"array": FIVE, "syntax": BIG_ENDIAN, "change": lambda k, data: data.__setattr__(
         "PixelData", np.frombuffer(data.PixelData, "<u2").astype(">u2").tobytes())}, {"array": FIVE}),
    ("one byte", write_series, {"array": FIVE}, {"array": FIVE}),
    ("one byte, signed", write_series, {"array": values("i1", 5, -7)}, {"array": values("i1", 5, -7)}),
    ("two bytes, signed", write_series, {"array": SIGNED}, {"array": SIGNED}),
    ("two bytes, signed, big endian", write_series, {"array": SIGNED, "syntax": BIG_ENDIAN}, {"array": SIGNED}),
    ("four bytes", write_series, {"array": WIDE}, {"array": WIDE}),
    ("four bytes, signed", write_series, {"array": values("<i4", 1 << 20, -9)}, {"array": values("i4", 1 << 20, -9)}),
    ("overlays above the voxels", write_series,
     {"array": in_bits(ARRAY, 0, 0xF000), "BitsStored": 12}, {"array": ARRAY}),
    ("overlays around the voxels", write_series,
     {"array": in_bits(ARRAY, 2, 0xC003), "BitsStored": 12, "HighBit": 13}, {"array": ARRAY}),
    ("overlays above signed voxels", write_series,
     {"array": in_bits(SIGNED, 0, 0xF000), "BitsStored": 12, "PixelRepresentation": 1}, {"array": SIGNED}),
    ("MONOCHROME1", write_series, {"PhotometricInterpretation": "MONOCHROME1"}, {}),
    ("whole slope and intercept", write_series,
     {"array": FIVE, **rescaled("2", "-1024")}, {"array": values("i2", 2, -1024)}),
    ("intercept that needs more bits", write_series,
     {"array": WIDE >> 18, "BitsStored": 16, **rescaled("1", "-60000")}, {"array": values("i4", 4, -60000)}),
    ("slope that needs still more", write_series,
     {"array": WIDE, **rescaled("4", "0")}, {"array": values("i8", 4 << 20)}),
    ("slope of half", write_series, {"array": FIVE, **rescaled("0.5", "1")}, {"array": values("f8") / 2 + 1}),
    ("slopes that differ", write_series,
     {"array": FIVE, "change": lambda k, data: assign(data, rescaled(str(k + 1), "0"))},
     {"array": (FIVE * (np.arange(5) + 1)[:, None, None]).astype("i2")}),
    ("slope of 1 with much space", write_series, {"array": FIVE, **rescaled(" 1.000 ", "+0.0")}, {"array": FIVE}),
    ("RLE", write_series, {"convert": ("--rle",)}, {}),
    ("RLE, four bytes", write_slice, {"image": WIDE[0], "convert": ("--rle",)}, {"array": WIDE[:1]}),
    ("JPEG lossless", write_slice, {"convert": ("--jpeg",)}, {"array": ARRAY[:1]}),
    ("JPEG lossless, one byte", write_slice, {"image": LARGE, "convert": ("--jpeg",)}, {"array": LARGE[None]}),
    ("JPEG lossless, 12 bits", write_slice, {"convert": ("--jpeg",), "BitsStored": 12}, {"array": ARRAY[:1]}),
    ("JPEG lossless, signed", write_slice, {"image": SIGNED[0], "convert": ("--jpeg",)}, {"array": SIGNED[:1]}),
    ("JPEG-LS", write_slice, {"convert": ("--jpegls",)}, {"array": ARRAY[:1]}),
    ("JPEG-LS, one byte", write_slice, {"image": FIVE[0], "convert": ("--jpegls",)}, {"array": FIVE[:1]}),
    ("JPEG-LS, 12 bits", write_slice, {"convert": ("--jpegls",), "BitsStored": 12}, {"array": ARRAY[:1]}),
    ("JPEG 2000", write_series, {"convert": ("--j2k",)}, {}),
    ("JPEG 2000, one byte", write_slice, {"image": LARGE, "convert": ("--j2k",)}, {"array": LARGE[None]}),
    ("JPEG 2000, signed", write_slice, {"image": SIGNED[0], "convert": ("--j2k",)}, {"array": SIGNED[:1]}),
    ("JPEG 2000, signed, 12 bits", write_slice, {"image": SIGNED[0], "BitsStored": 12, "convert": ("--j2k",)},
     {"array": SIGNED[:1]}),
    ("frames", write_frames, {}, {}),
    ("frames of a gantry tilt", write_frames, {"step": TILTED}, {"step": TILTED}),
    ("frames, implicit", write_frames, {"syntax": IMPLICIT}, {}),
    ("frames, deflated", write_frames, {"syntax": DEFLATED}, {}),
    ("frames, big endian, one byte, odd", write_frames,
     {"array": FIVE, "syntax": BIG_ENDIAN, "change": lambda data: data.__setattr__(
         "PixelData", np.frombuffer(data.PixelData, "<u2").astype(">u2").tobytes())}, {"array": FIVE}),
    ("frames, RLE", write_frames, {"convert": ("--rle",)}, {}),
    ("frames, JPEG lossless", write_frames, {"convert": ("--jpeg",)}, {}),
    ("frames, JPEG-LS", write_frames, {"convert": ("--jpegls",)}, {}),
    ("frames, JPEG 2000", write_frames, {"convert": ("--j2k",)}, {}),
    ("frames, all rescaled", write_frames,
     {"array": FIVE, "change": lambda data: data.SharedFunctionalGroupsSequence[0].__setattr__(
         "PixelValueTransformationSequence", item(**rescaled("3", "-1")))}, {"array": values("i2", 3, -1)}),
    ("frames, one rescaled", write_frames, {"array": FIVE, "change": rescale_groups(0, "10")},
     {"array": (FIVE * np.array([1, 1, 1, 10, 1])[:, None, None]).astype("i2")}),
    ("label map segmentation", write_frames,
     {"array": FIVE, "SOPClassUID": LABEL_MAP, "PhotometricInterpretation": "PALETTE COLOR"}, {"array": FIVE, "ends": 1}),
    ("label map without its empty slices", write_frames,
     {"array": FIVE, "SOPClassUID": LABEL_MAP, "order": (4, 0, 3), "change": lambda data:
      data.SharedFunctionalGroupsSequence[0].PixelMeasuresSequence[0].__setattr__("SpacingBetweenSlices", "2")},
     {"array": FIVE * np.array([1, 0, 0, 1, 1], "u1")[:, None, None], "ends": 1}),
    ("JPEG lossless, filled up before the end", write_slice,
     {"convert": ("--jpeg",), "edit": filled_up(b"\xff\xd9")}, {"array": ARRAY[:1]}),
    ("JPEG lossless, filled up in the header", write_slice,
     {"convert": ("--jpeg",), "edit": filled_up(b"\xff\xc4")}, {"array": ARRAY[:1]}),
    ("JPEG 2000 in fragments, without offsets", write_frames, {"convert": ("--j2k",), "change_saved": in_fragments}, {}),
    ("deflated, several parts", write_slice,
     {"image": np.tile(ARRAY[0], (100, 100)), "syntax": DEFLATED}, {"array": np.tile(ARRAY[0], (100, 100))[None]}),
    ("captured, as ITK writes it", write_series,
     {"SOPClassUID": SECONDARY_CAPTURE, "PixelSpacing": None, "NominalScannedPixelSpacing": numbers([0.75, 0.5])}, {}),
    ("slice", write_slice, {}, {"array": ARRAY[:1]}),
    ("slice, distance of slices", write_slice,
     {"SliceThickness": "7", "SpacingBetweenSlices": "2"}, {"array": ARRAY[:1]}),
    ("slice without preamble", write_slice, {"edit": as_old_file}, {"array": ARRAY[:1]}),
    ("slice without preamble, implicit", write_slice, {"edit": as_old_file, "syntax": IMPLICIT}, {"array": ARRAY[:1]}),
    ("slice with bytes after it", write_slice, {"edit": lambda data: data + b"\0" * 100}, {"array": ARRAY[:1]}),
    ("slice of runs", write_compressed, {"frames": [segment(RUNS)], "syntax": RLE},
     {"array": np.full((1, 8, 8), 7, "u1")}),
    ("dose", write_dose, {}, {"array": ARRAY * 0.25}),
)


def turned(data):
    data.ImageOrientationPatient = [1, 0, 0, 0, 1, 0]


def at(number, change):
    """A change to the data set of one slice."""
    return lambda k, data: change(data) if k == number else None


def cut(length):
    return lambda data: data[:-length]


def repacked(change):
    """What a change makes of the unpacked part of a deflated file."""
    def edit(data):
        start = data.index(b"1.2.840.10008.1.2.1.99") + 22
        while struct.unpack_from("<H", data, start) == (2,):
            start += 8 + struct.unpack_from("<H", data, start + 6)[0]
        return data[:start] + change(data[start:])
    return edit


def without_pixels(data):
    stream = zlib.compressobj(wbits=-15)
    unpacked = zlib.decompress(data, wbits=-15)
    return stream.compress(unpacked[:-len(ARRAY[0].tobytes())]) + stream.flush()


def ended(data):
    """Puts the end of the codestream into its middle, and zeros behind."""
    middle = (data.rindex(b"\xfe\xff\0\xe0") + len(data)) // 2
    return data[:middle] + b"\xff\xd9" + bytes(len(data) - middle - 10) + data[-8:]


def without(tag):
    """An element of two characters gets a private tag."""
    return lambda data: data.replace(struct.pack("<2H2s", tag >> 16, tag & 0xFFFF, b"CS"),
                                     struct.pack("<2H2s", (tag >> 16) + 1, tag & 0xFFFF, b"CS"))


def element(tag, value):
    return lambda data: data.replace(struct.pack("<2H2s2H", tag >> 16, tag & 0xFFFF, b"US", 2, value[0]),
                                     struct.pack("<2H2s2H", tag >> 16, tag & 0xFFFF, b"US", 2, value[1]))


def replaced(*parts):
    return lambda data: data.replace(*parts)


PLACES = "are slices at one place: there are several images"
MISSING = "slices are missing, damaged or not evenly spaced: '.*' is %s mm from where slices %s mm apart put it"

# name, writer, its options, words of the message
REFUSED = (
    ("a slice is missing", write_series, {"places": [place(k + (k > 1)) for k in range(5)]}, MISSING % ("0.5", "2.5")),
    ("a slice is beside the others", write_series,
     {"places": [place(k) + 0.5 * (k == 2) * OBLIQUE.direction[:, 0] for k in range(5)]}, MISSING % ("0.5", "2")),
    ("a slice is half a voxel beside the others", write_series,
     {"places": [place(k) + 0.25 * (k == 2) * OBLIQUE.direction[:, 0] for k in range(5)]}, MISSING % ("0.25", "2")),
    ("GE's own transfer syntax", write_slice, {"edit": replaced(b"1.2.840.10008.1.2.1\0", b"1.2.840.113619.5.2\0\0")},
     "its transfer syntax '1.2.840.113619.5.2' is not supported"),
    ("pixels of JPEG from nothing", write_compressed,
     {"frames": [b"\xff\xd8\xff\xd9"], "syntax": JPEG, "Rows": 40000, "Columns": 40000}, "are not compressed to 4"),
    ("a file of JPEG 2000", write_compressed,
     {"frames": [b"\0\0\0\x0cjP  \r\n\x87\n" + b"\0" * 20 + b"\xff\xd9"], "syntax": JPEG_2000},
     "files of JPEG 2000, where codestreams must be"),
    ("a label map that asks for very many empty slices", write_frames,
     {"array": FIVE, "SOPClassUID": LABEL_MAP, "order": (0, 4), "change": lambda data:
      data.SharedFunctionalGroupsSequence[0].PixelMeasuresSequence[0].__setattr__("SpacingBetweenSlices", "0.0001")},
     "8 mm apart, and its Spacing Between Slices .* is 0.0001"),
    ("two times", write_series, {"places": [place(k // 2) for k in range(5)]}, "'.*' and '.*' " + PLACES),
    ("frames of two times", write_frames, {"step": (0, 0, 0)}, "frame . and frame . " + PLACES),
    ("columns differ", write_series, {"change": at(3, lambda data: assign(data, {
        "Columns": 7, "Rows": 9}))}, r"'.*' and '.*' differ in Columns \(0028,0011\), which is 9 and 7"),
    ("bits differ", write_series, {"change": at(1, lambda data: assign(data, {"BitsStored": 12, "HighBit": 11}))},
     r"differ in Bits Stored \(0028,0101\), which is 16 and 12"),
    ("orientations differ", write_series, {"change": at(1, turned)}, "'.*' and '.*' differ in Image Orientation"),
    ("spacings differ", write_series, {"change": at(4, lambda data: assign(data, {"PixelSpacing": [0.8, 0.5]}))},
     "differ in Image Orientation .* or Pixel Spacing"),
    ("no position", write_slice, {"ImagePositionPatient": None}, r"it has no Image Position \(Patient\) \(0020,0032\)"),
    ("no orientation", write_series, {"ImageOrientationPatient": None}, "'.*dcm': it has no Image Orientation"),
    ("no spacing", write_slice, {"PixelSpacing": None}, r"it has no Pixel Spacing \(0028,0030\)"),
    ("spacing of 0", write_slice, {"PixelSpacing": [0, 1]}, "Pixel Spacing .* is 0 and 1; these must be positive"),
    ("orientation of no length", write_slice, {"ImageOrientationPatient": [0] * 6}, "not two directions of length 1"),
    ("position of two numbers", write_slice, {"ImagePositionPatient": [1, 2]}, "is '1.0.2.0', and must be 3 numbers"),
    ("position that is a text", write_slice, {"edit": replaced(b"10\\-20\\30", b"10\\-x0\\30")},
     r"Image Position \(Patient\) \(0020,0032\) is '10.-x0.30', and must be numbers"),
    ("slope of 0", write_slice, rescaled("0", "0"), r"Rescale Slope \(0028,1053\) is 0"),
    ("film", write_frames, {"SOPClassUID": SECONDARY_CAPTURE, "PerFrameFunctionalGroupsSequence": None},
     "its 5 frames have no places in space"),
    ("places of other frames", write_frames, {"change": lambda data: data.PerFrameFunctionalGroupsSequence.pop()},
     "5 frames, and 4 items in its Per-frame Functional Groups"),
    ("dose without places", write_dose, {"offsets": (0, 1)}, "has 2 offsets for 5 frames"),
    ("surfaces", write_slice, {"SOPClassUID": ROOT + "66.5", "PixelData": None}, "it is a DICOM surface segmentation"),
    ("structure set", write_slice, {"SOPClassUID": ROOT + "481.3", "PixelData": None},
     "it is a DICOM RT structure set"),
    ("whole slide", write_frames, {"SOPClassUID": ROOT + "77.1.6"}, "it is a whole-slide microscopy image"),
    ("parametric map", write_frames, {"SOPClassUID": ROOT + "30"}, "it is a parametric map"),
    ("directory", write_slice, {"SOPClassUID": "1.2.840.10008.1.3.10", "PixelData": None}, "it is a DICOMDIR"),
    ("document", write_slice, {"SOPClassUID": ROOT + "104.1", "PixelData": None},
     r"it is a DICOM object without pixels \('Encapsulated PDF Storage'\)"),
    ("presentation state", write_slice, {"SOPClassUID": ROOT + "11.1", "PixelData": None},
     r"without pixels \('Grayscale Softcopy Presentation State Storage"),
    ("mosaic", write_slice, {"SOPClassUID": MR, "ImageType": ["ORIGINAL", "PRIMARY", "MOSAIC"]},
     "it is a mosaic of Siemens"),
    ("colours", write_slice, {"SamplesPerPixel": 3, "PhotometricInterpretation": "RGB", "PlanarConfiguration": 0},
     r"Samples per Pixel \(0028,0002\) is 3: its voxels are colours"),
    ("palette", write_slice, {"PhotometricInterpretation": "PALETTE COLOR"},
     r"Photometric Interpretation \(0028,0004\) is 'PALETTE COLOR': its voxels are colours"),
    ("table of values", write_slice, {"ModalityLUTSequence": item(LUTExplanation="x")}, "stand for others in a table"),
    ("12 bits allocated", write_slice, {"BitsAllocated": 12, "BitsStored": 12}, r"Bits Allocated \(0028,0100\) is 12"),
    ("one bit", write_slice, {"BitsAllocated": 1, "BitsStored": 1}, r"Bits Allocated \(0028,0100\) is 1:"),
    ("more bits stored than allocated", write_slice, {"BitsStored": 17}, "17 bits stored up to bit 16 of 16"),
    ("no rows", write_slice, {"Rows": None}, r"it has no Rows \(0028,0010\)"),
    ("rows of 0", write_slice, {"Rows": 0}, "it has 0 rows and 9 columns"),
    ("frames of 0", write_slice, {"NumberOfFrames": "0"}, r"Number of Frames \(0028,0008\) is '0'"),
    ("frames without end", write_slice, {"NumberOfFrames": "2000000000", "Rows": 65535, "Columns": 65535},
     "claims more pixels than memory has|truncated: 126 of "),
    ("film of pixels", write_compressed, {"frames": [b"\0\0\1\xba"], "syntax": MPEG},
     "its transfer syntax 'MPEG2 .*' is not supported: decompress it"),
    ("half of the pixels in the file", write_slice, {"edit": cut(63)}, "its pixels are truncated: 63 of 126 bytes"),
    ("half of the pixels in the element", write_slice, {"PixelData": ARRAY[0].tobytes()[:62]},
     "truncated: 62 of 126 bytes"),
    ("half of the frames", write_frames, {"change": lambda data: assign(data, {"PixelData": data.PixelData[:252]})},
     "its pixels are truncated: 252 of 630 bytes"),
    ("more pixels than its header says", write_slice, {"Rows": 6},
     "its pixels have 126 bytes, and 1 frames of 9 x 6 have 108"),
    ("cut before the pixels", write_slice, {"edit": cut(126 + 12)}, "without pixels .*or it is cut off before them"),
    ("cut within an element", write_slice, {"edit": cut(126 + 13)},
     "it ends within an element|claims 2 bytes, and 1 are left"),
    ("nothing after the preamble", write_slice, {"edit": lambda data: data[:132]},
     "ends before its first data element"),
    ("deflated and cut", write_slice, {"syntax": DEFLATED, "edit": cut(20)},
     "what is compressed in it does not unpack"),
    ("deflated and garbled", write_slice, {"syntax": DEFLATED, "edit": repacked(lambda data: b"\xff" * len(data))},
     "what is compressed in it does not unpack"),
    ("deflated without pixels", write_slice, {"syntax": DEFLATED, "edit": repacked(without_pixels)},
     "its pixels are truncated: 0 of 126 bytes"),
    ("element that claims too much", write_slice,
     {"edit": replaced(struct.pack("<2H2s2H", 0x28, 0x10, b"US", 2, 7), struct.pack("<2H2sHI", 0x29, 0x10, b"OB", 0,
      0xF0000000))},
     r"its element \(0029,0010\) claims 4026531840 bytes, and \d+ are left"),
    ("value representation that there is not", write_slice,
     {"edit": replaced(struct.pack("<2H2s", 0x28, 0x30, b"DS"), struct.pack("<2H2s", 0x28, 0x30, b"DW"))},
     r"its element \(0028,0030\) has the value representation 'DW', which DICOM does not have"),
    ("rows as a text", write_slice,
     {"edit": replaced(struct.pack("<2H2s", 0x28, 0x10, b"US"), struct.pack("<2H2s", 0x28, 0x10, b"SH"))},
     r"its element \(0028,0010\) has the value representation 'SH', and must not have it"),
    ("rows twice", write_slice,
     {"edit": replaced(struct.pack("<2H2s", 0x28, 0x11, b"US"), struct.pack("<2H2s", 0x28, 0x10, b"US"))},
     r"it has its element \(0028,0010\) twice"),
    ("not compressed as it says", write_slice, {"edit": replaced(b"1.2.840.10008.1.2.1\0", b"1.2.840.10008.1.2.5\0")},
     "they are not compressed, as its transfer syntax 'RLE Lossless' says"),
    ("no run-length segments", write_compressed, {"frames": [bytes(64)], "syntax": RLE},
     "has 0 run-length segments, and 1 are"),
    ("run-length segments of another depth", write_compressed, {"frames": [b"\2" + segment(RUNS)[1:]], "syntax": RLE},
     "has 2 run-length segments, and 1 are needed"),
    ("run-length segment outside", write_compressed, {"frames": [segment(RUNS).replace(b"@\0\0\0", b"\0\1\0\0")],
     "syntax": RLE},
     "a run-length segment begins at byte 256 and ends at byte 66 of 66"),
    ("runs that end too soon", write_compressed, {"frames": [segment(b"\xc2\7")], "syntax": RLE},
     "a run-length segment has 63 of 64 bytes"),
    ("runs that go on", write_compressed, {"frames": [segment(RUNS * 2)], "syntax": RLE}, "has more than 64 bytes"),
    ("frames and no fragments", write_compressed, {"frames": [segment(RUNS)] * 2, "syntax": RLE, "NumberOfFrames": "3"},
     "it has 2 compressed fragments for 3 frames"),
    ("pixels from nothing", write_compressed,
     {"frames": [segment(RUNS)], "syntax": RLE, "Rows": 60000, "Columns": 60000, "BitsAllocated": 32, "BitsStored": 32},
     "frames of 14400000000 bytes are not compressed to 66"),
)
# What each compression says of itself is compared with the header, and none may end too soon.
for option, marker in (("--jpeg", 0xFFC3), ("--jpegls", 0xFFF7), ("--j2k", 0xFF51)):
    REFUSED += (
        (option + " without an end", write_slice, {"convert": (option,), "edit": replaced(b"\xff\xd9", b"\xff\x01")},
         "has no end"),
        (option + " that ends too soon", write_slice, {"image": LARGE, "convert": (option,), "edit": ended},
         "its pixels are truncated or damaged"),
        (option + " of another size", write_slice,
         {"convert": (option,), "edit": element(0x00280010, (7, 9))},
          "a compressed frame has 9 x 7 pixels of 1 components"),
        (option + " of other bits", write_slice,
         {"convert": (option,), "edit": lambda data: element(0x00280101, (16, 8))(element(0x00280102, (15, 7))(
             element(0x00280100, (16, 8))(data)))},
                 "its pixels have 16 bits where they are compressed, and 8 in its header"),
        (option + " of other data", write_slice,
         {"convert": (option,), "edit": replaced(struct.pack(">H", marker), b"\xff\x0f")}, "truncated or damaged"))

# name, writer, its options, words of the warning, what is expected
WARNED = (
    ("JPEG-LS with loss that its header does not tell", write_slice,
     {"image": np.full((8, 8), 77, "u1"), "convert": ("--jpegls", "--lossy", "-e", "3"),
      "edit": without(0x00282110)}, "compressed with loss", {"array": np.full((1, 8, 8), 77, "u1")}),
    ("JPEG 2000 with loss that its header does not tell", write_slice,
     {"image": np.full((64, 64), 77, "u1"), "convert": ("--j2k", "--lossy", "--irreversible"),
      "edit": without(0x00282110)}, "compressed with loss", {"array": np.full((1, 64, 64), 77, "u1")}),
    ("slice of no thickness", write_slice, {"SliceThickness": None},
     "one slice, of which the thickness is not known: 0.5 mm",
     {"array": ARRAY[:1], "step": 0.5 * NORMAL}),
    ("compressed with loss before", write_series, {"LossyImageCompression": "01"}, "compressed with loss", {}),
    ("JPEG", write_slice, {"image": np.full((8, 8), 77, "u1"), "convert": ("--jpeg", "--lossy")},
     "compressed with loss",
     {"array": np.full((1, 8, 8), 77, "u1")}),
)


class TestDICOM(FolderTestCase):
    def compare(self, image, array=ARRAY, step=STEP, ends=0):
        """ends: empty slices at each end that are not in the array."""
        voxels = vtk_to_numpy(image.GetPointData().GetArray("Labels")).reshape(image.GetDimensions()[::-1])
        np.testing.assert_array_equal(voxels, np.pad(array, ((ends, ends), (0, 0), (0, 0))))
        self.assertEqual(voxels.dtype, array.dtype.newbyteorder("="))
        for index in ((0, 0, 0), (8, 0, 0), (0, 6, 0), (0, 0, 4)):
            expected = OBLIQUE.physical((*index[:2], 0)) + (index[2] - ends) * np.asarray(step)
            point = [0.0] * 3
            image.TransformContinuousIndexToPhysicalPoint([float(i) for i in index], point)
            np.testing.assert_allclose(point, expected, atol=1e-6)

    def folder_of(self, name):
        """One for each case, as others may be left from before."""
        folder = self.folder / str(abs(zlib.crc32(name.encode())))
        folder.mkdir()
        return folder

    def test_sound(self):
        for name, write, options, expected in SOUND:
            with self.subTest(name):
                self.compare(self.read(write(self.folder_of(name), **options)), **expected)

    def test_refused(self):
        for name, write, options, words in REFUSED:
            with self.subTest(name):
                self.refused("^cannot read '.*': (.|\n)*(" + words + ")", write(self.folder_of(name), **options))

    def test_warned(self):
        for name, write, options, words, expected in WARNED:
            with self.subTest(name):
                reader = self.reader(write(self.folder_of(name), **options))
                self.assertEqual(reader.GetErrorMessage(), "")
                self.assertRegex("\n".join(warnings_of(reader)), words)
                self.compare(reader.GetOutput(), **expected)


class Folders(FolderTestCase):
    """What else is in a folder."""

    compare = TestDICOM.compare

    def setUp(self):
        super().setUp()
        self.series = write_series(self.folder)

    def test_other_files(self):
        (self.series / "notes.txt").write_text("hello")
        (self.series / "._0.dcm").write_bytes(b"\0\5\x16\7 of macOS")
        (self.series / ".#lock").symlink_to("nowhere")
        os.mkfifo(self.series / "fifo")
        (self.series / "deeper").mkdir()
        save(self.series / "report", data_set(ARRAY[0], SOPClassUID=ROOT + "88.11", SeriesInstanceUID="1.2.3",
            PixelData=None))
        self.compare(self.read(self.series))

    def test_links(self):
        folder = self.folder / "links"
        folder.mkdir()
        for path in self.series.iterdir():
            (folder / path.name).symlink_to(path)
        self.compare(self.read(folder))

    def test_two_series(self):
        write_slice(self.series, SeriesInstanceUID=SERIES + ".8")
        listed = 'SetSeriesUID\\("%s"\\)  \\(5 files\\)\n' % SERIES.replace(".", r"\.")
        self.refused("2 DICOM series; choose one with\n  " + listed,
                     self.series, SeriesUID="1.2.8")
        self.compare(self.read(self.series, SeriesUID=SERIES))
        self.compare(self.read(self.series, SeriesUID=SERIES + ".8"), ARRAY[:1])
        self.refused("there is no DICOM series '7'; there are\n", self.series, SeriesUID="7")

    def test_damage(self):
        """A slice that cannot be read is not left out."""
        path = self.series / "0.dcm"
        whole = path.read_bytes()
        for data, words in ((whole[:-9], "its pixels are truncated: 117 of 126 bytes"), (whole[:400], "truncated"),
                            (whole[:-138], "or it is cut off before"), (b"", "it is no DICOM file")):
            path.write_bytes(data)
            self.refused("'0.dcm': .*" + words, self.series)

    def test_frames_and_slices(self):
        write_frames(self.series)
        self.refused("'frames.dcm' has 5 frames, and there are other files in its series", self.series)

    def test_objects_only(self):
        folder = self.folder / "objects"
        folder.mkdir()
        write_slice(folder, SOPClassUID=ROOT + "481.3", PixelData=None)
        self.refused("'slice.dcm': it is a DICOM RT structure set", folder)
        self.refused("the folder holds no DICOM images", self.folder)


class Files(FolderTestCase):
    def test_hostile(self):
        """Files of our own making that crashed readers, or were read as if they were sound."""
        data = Path(__file__).resolve().parents[2] / ".." / "shared" / "data" / "hostile"
        paths = sorted(data.glob("dicom-*.dcm"))
        if not paths:
            self.skipTest("../shared/data is not there")
        for path in paths:
            with self.subTest(path.name):
                self.refused("no places in space|colours|truncated", path)


if __name__ == "__main__":
    unittest.main()
