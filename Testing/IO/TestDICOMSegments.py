#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""DICOM segmentations: volumes, centroids and voxels beside what NumPy makes of the arrays; pydicom and highdicom write
files, and DCMTK reads them, too."""
import importlib.util
import json
import os
import struct
import subprocess
import unittest
import zlib
from pathlib import Path

import numpy as np
import pydicom
from pydicom.dataset import Dataset
from pydicom.encaps import encapsulate
from pydicom.sequence import Sequence
from vtkmodules.util.numpy_support import vtk_to_numpy

import images
import voxplex
from iotesting import FolderTestCase, table_of, warnings_of
from TestDICOM import (BIG_ENDIAN, DEFLATED, EXPLICIT, IMPLICIT, LABEL_MAP, NORMAL, OBLIQUE, RLE, SEGMENTATION, SERIES, STEP,
                       TILTED, assign, item, numbers, place, save)

HERE = Path(__file__).resolve().parent
SMALLEST, ORDER = 0, 1
NONE, WITHIN, ALL = range(3)  # of the frames without a voxel; within: those between the first and the last of a segment
JPEG_LS, DEFLATED_FRAMES = "1.2.840.10008.1.2.4.80", "1.2.840.10008.1.2.8.1"
SHAPE = (6, 9, 7)  # frames of 63 bits
Z, Y, X = np.indices(SHAPE)
LIVER = (X - 2) ** 2 + (Y - 4) ** 2 + (Z - 2) ** 2 < 5
SPLEEN = (X > 4) & (Y < 6) & (Z % 4 == 1)  # with empty slices in between
TUMOUR = (X > 1) & (X < 4) & (Y > 2) & (Z > 2)
APART = (LIVER, SPLEEN)
OVERLAPPING = (LIVER, SPLEEN, TUMOUR)
NAMES = ("Liver", "Spleen", "Tumour")


def segment(number, name=None, lab=None):
    data = Dataset()
    data.SegmentNumber = number
    data.SegmentLabel = NAMES[number - 1] if name is None else name
    if lab is not None:
        data.RecommendedDisplayCIELabValue = lab
    return data


def sequences(step=STEP, told=True):
    """What all frames have in common."""
    measures = {"PixelSpacing": numbers([OBLIQUE.spacing[1], OBLIQUE.spacing[0]]), "SliceThickness": "9"}
    if told:
        measures["SpacingBetweenSlices"] = numbers([np.dot(step, NORMAL)])[0]
    orientation = numbers([*OBLIQUE.direction[:, 0], *OBLIQUE.direction[:, 1]])
    return item(PlaneOrientationSequence=item(ImageOrientationPatient=orientation), PixelMeasuresSequence=item(**measures))


def deflated(frame):
    stream = zlib.compressobj(wbits=-15)
    return stream.compress(frame) + stream.flush()


def runs_of(frame):
    """Of one byte each: a run-length segment."""
    return struct.pack("<16I", 1, 64, *[0] * 14) + b"".join(b"\0%c" % byte for byte in frame)


def write(folder, masks=APART, step=STEP, told=True, syntax=EXPLICIT, convert=None, empty=NONE, most=None, segments=None,
          change=None, shared=False, pack=None, **tags):
    """A file of frames in an order of no meaning. masks: of booleans; with most, of the greatest fraction, of fractions
    from 0 to 1. empty: which frames without a voxel there are. shared: whether all frames are of one segment. pack: makes a
    fragment of the bytes of a frame."""
    frames = [(number, k, image) for number, mask in enumerate(masks, 1) for k, image in enumerate(mask)
              if image.any() or empty == ALL or empty == WITHIN and mask[:k].any() and mask[k:].any()]
    frames = [frames[i] for i in np.random.default_rng(2).permutation(len(frames))]
    pixels = np.stack([image for _, _, image in frames])
    bits = 1 if most is None else 8
    packed = np.packbits(pixels.ravel(), bitorder="little") if most is None else np.rint(pixels * most).astype("u1").ravel()
    packed = np.append(packed, np.zeros(len(packed) % 2, "u1"))
    data = Dataset()
    data.SOPClassUID, data.SOPInstanceUID, data.SeriesInstanceUID = SEGMENTATION, SERIES + ".1", SERIES
    data.SegmentationType = "BINARY" if most is None else "FRACTIONAL"
    if most is not None:
        data.SegmentationFractionalType, data.MaximumFractionalValue = "PROBABILITY", most
    data.SamplesPerPixel, data.PhotometricInterpretation, data.PixelRepresentation = 1, "MONOCHROME2", 0
    data.NumberOfFrames = len(frames)
    data.Rows, data.Columns = pixels.shape[1:]
    data.BitsAllocated = data.BitsStored = bits
    data.HighBit = bits - 1
    data.SegmentSequence = Sequence(segments or [segment(number) for number in range(1, len(masks) + 1)])
    data.SharedFunctionalGroupsSequence = sequences(step, told)
    identified = [item(ReferencedSegmentNumber=number) for number, _, _ in frames]
    data.PerFrameFunctionalGroupsSequence = Sequence(
        [item(PlanePositionSequence=item(ImagePositionPatient=numbers(place(k, step))))[0] for _, k, _ in frames])
    if shared:
        data.SharedFunctionalGroupsSequence[0].SegmentIdentificationSequence = identified[0]
    for i, groups in enumerate([] if shared else data.PerFrameFunctionalGroupsSequence):
        groups.SegmentIdentificationSequence = identified[i]
    data.PixelData = (packed.view("<u2").astype(">u2") if syntax == BIG_ENDIAN else packed).tobytes()
    data["PixelData"].VR = "OW" if syntax == BIG_ENDIAN else "OB"
    if pack:
        frames = [np.packbits(image.ravel(), bitorder="little") if most is None else np.rint(image * most).astype("u1")
                  for image in pixels]
        data.PixelData = encapsulate([pack(frame.tobytes()) for frame in frames])
        data["PixelData"].is_undefined_length = True
    assign(data, tags)
    if change:
        change(data)
    known = JPEG_LS if syntax == DEFLATED_FRAMES else syntax  # pydicom 2 does not know it
    path = save(folder / "segments.dcm", data, known, convert)
    if known != syntax:
        path.write_bytes(path.read_bytes().replace(known.encode(), syntax.encode() + b"\0"))
    return path


def write_map(folder, labels, dtype="u1", step=STEP, told=True, syntax=EXPLICIT, convert=None, segments=None, order=None,
              change=None, **tags):
    order = np.random.default_rng(2).permutation(len(labels)) if order is None else order
    data = Dataset()
    data.SOPClassUID, data.SOPInstanceUID, data.SeriesInstanceUID = LABEL_MAP, SERIES + ".1", SERIES
    data.SegmentationType = "LABELMAP"
    data.SamplesPerPixel, data.PhotometricInterpretation, data.PixelRepresentation = 1, "MONOCHROME2", 0
    data.NumberOfFrames = len(order)
    data.Rows, data.Columns = labels.shape[1:]
    data.BitsAllocated = data.BitsStored = 8 * np.dtype(dtype).itemsize
    data.HighBit = data.BitsStored - 1
    data.SegmentSequence = Sequence(segments or [segment(0, "Background"), segment(1), segment(2)])
    data.SharedFunctionalGroupsSequence = sequences(step, told)
    data.PerFrameFunctionalGroupsSequence = Sequence(
        [item(PlanePositionSequence=item(ImagePositionPatient=numbers(place(k, step))))[0] for k in order])
    data.PixelData = labels[list(order)].astype(dtype).tobytes()
    data["PixelData"].VR = "OW"
    assign(data, tags)
    if change:
        change(data)
    return save(folder / "map.dcm", data, syntax, convert)


def map_of(masks, rule=SMALLEST):
    """What comes last is painted first."""
    sizes = [mask.sum() for mask in masks]
    order = sorted(range(len(masks)), key=lambda n: (sizes[n], n) if rule == SMALLEST else n)
    labels = np.zeros(masks[0].shape, dtype=np.uint16)
    for number in reversed(order):
        labels[masks[number]] = number + 1
    return labels


LABELS = map_of(APART)


def measures_of_image(image):
    """{label: (voxels, centroid in space)}"""
    voxels = vtk_to_numpy(image.GetPointData().GetArray("Labels"))
    result = {}
    for label in np.unique(voxels[voxels > 0]):
        ids = np.flatnonzero(voxels == label)
        result[int(label)] = len(ids), np.mean([image.GetPoint(i) for i in ids], axis=0)
    return result


def measures_of_array(labels, origin, steps):
    """steps: of i, j, k, in columns."""
    result = {}
    for label in np.unique(labels[labels > 0]):
        k, j, i = np.nonzero(labels == label)
        result[int(label)] = len(k), np.asarray(origin) + np.asarray(steps) @ np.mean([i, j, k], axis=1)
    return result


def steps_of(step=STEP):
    return np.column_stack([*(OBLIQUE.direction[:, axis] * OBLIQUE.spacing[axis] for axis in (0, 1)), step])


class SegmentsTestCase(FolderTestCase):
    def compare(self, image, labels, origin=OBLIQUE.origin, steps=steps_of(), ends=1):
        """ends: empty slices at each end that are not in the file."""
        found, expected = measures_of_image(image), measures_of_array(labels, origin, steps)
        self.assertEqual({label: count for label, (count, _) in found.items()},
                         {label: count for label, (count, _) in expected.items()})
        tolerance = 0.1 * np.linalg.norm(steps, axis=0).min()
        for label, (_, centroid) in expected.items():
            self.assertLess(np.linalg.norm(found[label][1] - centroid), tolerance, label)
        used = np.flatnonzero(labels.any(axis=(1, 2)))
        voxels = vtk_to_numpy(image.GetPointData().GetArray("Labels")).reshape(image.GetDimensions()[::-1])
        if len(voxels) - 2 * ends < len(labels):  # the slices that are left out at the ends
            labels = labels[used[0]:used[-1] + 1]
        np.testing.assert_array_equal(voxels, np.pad(labels, ((ends, ends), (0, 0), (0, 0))))


# name, options, what is expected other than LABELS with STEP and an empty slice at each end: labels, step, ends
WIDE = tuple(np.tile(mask, (1, 6, 6)) for mask in APART)  # GDCM makes nothing of small frames
FRACTIONS = [np.where(mask, 0.8, 0.1) for mask in APART]
SOUND = (
    ("binary", {}, {}),
    ("implicit", {"syntax": IMPLICIT}, {}),
    ("deflated", {"syntax": DEFLATED}, {}),
    ("big endian, in words", {"syntax": BIG_ENDIAN}, {}),
    ("all slices, also empty ones", {"empty": ALL}, {"ends": 0}),
    ("all slices of a gantry tilt", {"empty": ALL, "step": TILTED}, {"step": TILTED, "ends": 0}),
    ("all slices, of which the last are empty", {"masks": (LIVER,), "empty": ALL}, {"labels": map_of((LIVER,)), "ends": 0}),
    ("all slices between the ends of a segment", {"empty": WITHIN}, {}),
    ("gaps, a distance that is told", {"masks": (SPLEEN, LIVER & (Z == 2))}, {"labels": map_of((SPLEEN, LIVER & (Z == 2)))}),
    ("bits in runs", {"syntax": RLE, "pack": runs_of}, {}),
    ("bits, each frame deflated", {"syntax": DEFLATED_FRAMES, "pack": deflated}, {}),
    ("bytes, each frame deflated", {"masks": FRACTIONS, "most": 9, "syntax": DEFLATED_FRAMES, "pack": deflated}, {}),
    ("gantry tilt", {"step": TILTED}, {"step": TILTED}),
    ("one segment, told once", {"masks": (LIVER,), "shared": True}, {"labels": map_of((LIVER,))}),
    ("one frame", {"masks": (LIVER & (Z == 0),)}, {"labels": map_of((LIVER & (Z == 0),))}),
    ("in another order", {"segments": [segment(2), segment(1)]}, {}),
    ("binary, in bytes", {"most": 1, "SegmentationType": "BINARY"}, {}),
    ("fractional", {"masks": FRACTIONS, "most": 255}, {}),
    ("fractional, of 100", {"masks": FRACTIONS, "most": 100}, {}),
    ("fractional, RLE", {"masks": WIDE, "most": 9, "convert": ("--rle",)}, {"labels": map_of(WIDE)}),
    ("fractional, JPEG-LS", {"masks": WIDE, "most": 9, "convert": ("--jpegls",)}, {"labels": map_of(WIDE)}),
    ("fractional, JPEG 2000", {"masks": WIDE, "most": 9, "convert": ("--j2k",)}, {"labels": map_of(WIDE)}),
)
MAPS = (
    ("label map", {}, {}),
    ("label map, 16 bits", {"labels": LABELS * 300, "dtype": "<u2",
     "segments": [segment(600, "x")]}, {"labels": LABELS * 300}),
    ("label map, deflated", {"syntax": DEFLATED}, {}),
    ("label map, another background", {"labels": np.where(LABELS > 0, LABELS, 99), "PixelPaddingValue": 99,
     "segments": [segment(1), segment(2)]}, {}),
    ("label map with empty slices", {"labels": LABELS * (Z % 4 > 0)}, {"labels": LABELS * (Z % 4 > 0), "ends": 0}),
    ("label map, 16 bits, with empty slices", {"labels": LABELS * 300 * (Z < 5), "dtype": "<u2",
     "segments": [segment(600, "x")]}, {"labels": LABELS * 300 * (Z < 5), "ends": 0}),
    ("label map with an empty slice within", {"labels": LABELS * (Z != 3)}, {"labels": LABELS * (Z != 3)}),
    ("label map with another background and empty slices", {"labels": np.where(LABELS * (Z < 5) > 0, LABELS, 99),
     "PixelPaddingValue": 99, "segments": [segment(1), segment(2)]}, {"labels": LABELS * (Z < 5), "ends": 0}),
)


def frame(number, **tags):
    """A change to the groups of one frame."""
    return lambda data: assign(data.PerFrameFunctionalGroupsSequence[number], tags)


def shared(name, **tags):
    return lambda data: assign(getattr(data.SharedFunctionalGroupsSequence[0], name)[0], tags)


def at_place_of_first(data):
    groups = data.PerFrameFunctionalGroupsSequence
    first = groups[0].SegmentIdentificationSequence[0].ReferencedSegmentNumber
    other = next(group for group in groups[1:] if group.SegmentIdentificationSequence[0].ReferencedSegmentNumber == first)
    other.PlanePositionSequence = groups[0].PlanePositionSequence


def beside(data):
    position = data.PerFrameFunctionalGroupsSequence[-1].PlanePositionSequence[0]
    position.ImagePositionPatient = numbers(np.array(position.ImagePositionPatient) + 3 * OBLIQUE.direction[:, 0])


# name, options, words of the message
REFUSED = (
    *((f"type {kind} of {bits} bits", {"most": most, "SegmentationType": kind},
       fr"its Segmentation Type \(0062,0001\) is '{kind or ''}'") for kind in ("X", None, "LABELMAP", "binary")
      for bits, most in ((1, None), (8, 9))),
    ("no greatest fraction", {"most": 9, "MaximumFractionalValue": None}, r"Maximum Fractional Value \(0062,000e\)"),
    ("a greatest fraction of 0", {"most": 9, "MaximumFractionalValue": 0}, r"Maximum Fractional Value \(0062,000e\)"),
    ("a greatest fraction that bytes do not have", {"most": 9, "MaximumFractionalValue": 256}, "Maximum Fractional Value"),
    ("fractions of one bit", {"SegmentationType": "FRACTIONAL", "MaximumFractionalValue": 255}, "Maximum Fractional Value"),
    ("tiles", {"DimensionOrganizationType": "TILED_FULL"}, "its frames are tiles of a picture"),
    ("tiles in a table", {"TotalPixelMatrixColumns": 512}, "its frames are tiles of a picture"),
    ("no places", {"PerFrameFunctionalGroupsSequence": None}, "frames have no places in space"),
    ("a frame without a place", {"change": frame(2, PlanePositionSequence=None)}, r"it has no Image Position \(Patient\)"),
    ("no orientation", {"change": lambda data: assign(data.SharedFunctionalGroupsSequence[0],
                                                      {"PlaneOrientationSequence": None})}, "it has no Image Orientation"),
    ("an orientation of its own", {"change": frame(3, PlaneOrientationSequence=item(
        ImageOrientationPatient=[1, 0, 0, 0, 1, 0]))}, "frame . and frame . differ in Image Orientation"),
    ("a frame beside that of another segment", {"empty": ALL, "change": beside},
     "frame 12 is 3 mm beside another one, frame"),
    ("a frame between the others", {"change": frame(0, PlanePositionSequence=item(
        ImagePositionPatient=numbers(place(1.4))))}, "slices are missing, damaged or not evenly spaced"),
    ("two times", {"change": at_place_of_first}, "frame . is the second one of segment . at its place"),
    ("a segment that is not listed", {"segments": [segment(1)]}, "frame . is of segment 2, which is not listed"),
    ("no segments", {"SegmentSequence": None}, "frame . is of segment ., which is not listed"),
    ("frames of no segment", {"shared": True, "change": lambda data: assign(data.SharedFunctionalGroupsSequence[0], {
        "SegmentIdentificationSequence": None})}, "frame 1 is of segment 0, which is not listed"),
    ("a segment twice", {"segments": [segment(1), segment(2), segment(1)]}, r"has the Segment Number \(0062,0004\) 1 twice"),
    ("segment 0", {"segments": [segment(0, "x"), segment(1)]}, "0, and they begin with 1"),
    ("frames that are missing", {"change": lambda data: assign(data, {"PixelData": data.PixelData[:40]})},
     "its pixels are truncated: 40 of 5. bytes"),
    ("bits for more frames", {"change": lambda data: data.PerFrameFunctionalGroupsSequence.pop(),
                              "NumberOfFrames": 6}, "its pixels have 56 bytes, and 6 frames of 7 x 9 have 48"),
    ("frames without groups", {"change": lambda data: data.PerFrameFunctionalGroupsSequence.pop()},
     "it has 7 frames, and 6 items in its Per-frame"),
    ("frames without end", {"NumberOfFrames": "2000000000"}, "its pixels are truncated: 56 of 15750000000 bytes"),
    ("four bytes", {"BitsAllocated": 32, "BitsStored": 32, "HighBit": 31},
     "is 32: voxels of 1 and 8 bits are read"),
    ("very many empty slices", {"masks": (SPLEEN,), "change": shared("PixelMeasuresSequence", SpacingBetweenSlices="0.001")},
     "8 mm apart, and its Spacing Between Slices .* is 0.001"),
    ("bits as JPEG-LS", {"syntax": JPEG_LS, "pack": deflated},
     "its voxels of 1 bit are compressed by 'JPEG-LS Lossless.*', which is not supported"),
    ("a frame that unpacks to too little", {"syntax": DEFLATED_FRAMES, "pack": lambda frame: deflated(frame[:-1])},
     "a frame unpacks to 7 of 8 bytes"),
    ("a frame that does not unpack", {"syntax": DEFLATED_FRAMES, "pack": lambda frame: b"\xff" * 8}, "do not unpack"),
)


class TestSegments(SegmentsTestCase):
    def folder_of(self, name):
        folder = self.folder / name
        folder.mkdir()
        return folder

    def test_sound(self):
        for name, options, expected in SOUND:
            with self.subTest(name):
                image = self.read(write(self.folder_of(name), **{"segments": [segment(1), segment(2)][:len(options.get(
                    "masks", APART))], **options}))
                self.compare(image, expected.get("labels", LABELS), steps=steps_of(expected.get("step", STEP)),
                             ends=expected.get("ends", 1))

    def test_maps(self):
        for name, options, expected in MAPS:
            with self.subTest(name):
                image = self.read(write_map(self.folder_of(name), **{"labels": LABELS, **options}))
                self.compare(image, **{"labels": LABELS, **expected})

    def test_refused(self):
        for name, options, words in REFUSED:
            with self.subTest(name):
                self.refused("^cannot read '.*': (.|\n)*(" + words + ")", write(self.folder_of(name), **options))

    def test_types_of_maps(self):
        for kind in ("X", "BINARY", "FRACTIONAL"):
            with self.subTest(kind):
                self.refused(fr"its Segmentation Type \(0062,0001\) is '{kind}'",
                             write_map(self.folder_of(kind), LABELS, SegmentationType=kind))

    def test_object_at_the_ends(self):
        """It is not at the border of the image, and has a shell there, the same as if no slice is left out."""
        z, y, x = np.indices((15, 41, 53))
        ball = (0.5 * (x - 26)) ** 2 + (0.75 * (y - 20)) ** 2 + (2 * (z - 7)) ** 2 < 100
        shells = []
        for empty in (NONE, ALL):
            image = self.read(write(self.folder, (ball,), empty=empty))
            self.assertEqual(image.GetDimensions()[2], 15 if empty == ALL else 11)
            check, shell = voxplex.vtkSegmentationRepair(), voxplex.vtkSegmentationRepair()
            check.SetCheckImage(True)
            shell.SetShell(1, 2.0)
            for repair in (check, shell):
                repair.SetInputData(image)
                repair.Update()
            self.assertNotIn("border", [row["what"] for row in json.loads(check.ToJSON())])
            shells.append(measures_of_image(shell.GetOutput())[2])
        self.assertEqual(shells[0][0], shells[1][0])
        np.testing.assert_allclose(shells[0][1], shells[1][1], atol=1e-6)

    def test_distance_that_is_not_told(self):
        spleen, liver = SPLEEN, LIVER & (Z == 2)
        for path, labels in ((write(self.folder, (spleen, liver), told=False), map_of((spleen, liver))),
                             (write_map(self.folder, LABELS, told=False, order=(5, 1, 2, 3)), LABELS * (Z > 0) * (Z != 4))):
            reader = self.reader(path)
            self.compare(reader.GetOutput(), labels)
            self.assertEqual(warnings_of(reader), [
                f"{path}: it leaves out slices, and does not tell their distance, which is taken to be 2 mm, the smallest "
                "of its frames"])

    def test_thin_slices_at_a_distance(self):
        def thin(data):
            data.SharedFunctionalGroupsSequence[0].PixelMeasuresSequence[0].SliceThickness = "2"
        path = write(self.folder, (SPLEEN,), told=False, change=thin)
        self.assertEqual(warnings_of(self.reader(path)), [
            f"{path}: its slices are thinner than their distance, which it does not tell and which is taken to be 8 mm, the "
            "smallest of its frames"])

    def test_distance_that_is_told(self):
        """It may be wrong if no slice has a neighbour."""
        path = write(self.folder, (SPLEEN,))
        reader = self.reader(path)
        self.compare(reader.GetOutput(), map_of((SPLEEN,)))
        self.assertEqual(warnings_of(reader), [
            f"{path}: it leaves out slices, between any two of its frames, by a Spacing Between Slices of 2 mm"])

    def test_overlaps(self):
        liver, spleen, tumour = OVERLAPPING
        shared_voxels = int((liver & tumour).sum())
        self.assertGreater(shared_voxels, 0)
        self.assertFalse((spleen & tumour).any())
        for rule, word in ((SMALLEST, "smallest"), (ORDER, "first")):
            path = write(self.folder_of(word), OVERLAPPING)
            reader = self.reader(path, Overlap=rule)
            self.assertEqual(reader.GetErrorMessage(), "")
            self.compare(reader.GetOutput(), map_of(OVERLAPPING, rule))
            self.assertEqual(warnings_of(reader), [
                f"{path}: segments overlap in {shared_voxels} voxels, which the {word} of them gets: Liver and Tumour "
                f"({shared_voxels})"])

    def test_numbers_and_rule(self):
        """The order is that of the list, and labels are numbers of segments."""
        path = write(self.folder, OVERLAPPING, segments=[segment(3), segment(1), segment(2)])
        reader = self.reader(path, Overlap=ORDER)
        expected = map_of((TUMOUR, LIVER, SPLEEN), ORDER)
        self.compare(reader.GetOutput(), np.array([0, 3, 1, 2])[expected])

    def test_threshold(self):
        fractions = [np.where(LIVER, 0.3, 0.0), np.where(SPLEEN, 0.7, 0.0)]
        path = write(self.folder, fractions, most=200)
        for threshold, masks in ((0.2, APART), (0.3, (LIVER & False, SPLEEN)), (0.65, (LIVER & False, SPLEEN))):
            reader = self.reader(path, MaskThreshold=threshold)
            self.compare(reader.GetOutput(), map_of(masks))
            empty = [] if masks is APART else [f"{path}: segments without a voxel: Liver"]
            self.assertEqual(warnings_of(reader), empty)
            self.assertEqual(list(table_of(reader.GetOutput())), [1, 2] if masks is APART else [2])
        self.assertEqual(self.reader(write(self.folder, APART), MaskThreshold=1).GetOutput().GetScalarRange()[1], 2)

    def test_names_and_colors(self):
        def latin(data):
            data.SpecificCharacterSet = "ISO_IR 100"
        table = [segment(1, "Foie, c\u00f4t\u00e9 gauche", [0x8A8A, 0xB000, 0x9000]), segment(2, "", [1, 2, 3])]
        self.assertEqual(table_of(self.read(write(self.folder, segments=table, change=latin))), {
            1: ("Foie, c\u00f4t\u00e9 gauche", tuple(round(part, 6) for part in self.rgb(0x8A8A, 0xB000, 0x9000)))})
        path = write(self.folder, segments=[segment(1, "\u809d"), segment(2)], SpecificCharacterSet="ISO_IR 192")
        self.assertEqual(table_of(self.read(path)), {1: ("\u809d", None), 2: ("Spleen", None)})

        def japanese(data):
            data.SpecificCharacterSet = ["ISO 2022 IR 6", "ISO 2022 IR 87"]
        path = write(self.folder, segments=[segment(1, "\u809d\u81d3"), segment(2)], change=japanese)
        reader = self.reader(path)
        self.assertEqual(table_of(reader.GetOutput()), {2: ("Spleen", None)})
        self.assertEqual(warnings_of(reader), [f"{path}: the name of label 1 is not in UTF-8, and is not used"])

    def rgb(self, *stored):
        """CIE 15 and IEC 61966-2-1."""
        lightness, a, b = stored[0] * 100 / 65535, stored[1] * 255 / 65535 - 128, stored[2] * 255 / 65535 - 128
        f = np.array([(lightness + 16) / 116 + a / 500, (lightness + 16) / 116, (lightness + 16) / 116 - b / 200])
        xyz = np.where(f > 6 / 29, f ** 3, 3 * (6 / 29) ** 2 * (f - 4 / 29)) * (0.950456, 1, 1.088754)
        linear = np.array([[3.2406, -1.5372, -0.4986], [-0.9689, 1.8758, 0.0415], [0.0557, -0.2040, 1.0570]]) @ xyz
        linear = np.clip(linear, 0, 1)
        return 255 * np.where(linear > 0.0031308, 1.055 * linear ** (1 / 2.4) - 0.055, 12.92 * linear)

    def test_palettes(self):
        colors = np.array([[0, 0, 0], [200, 100, 50], [0, 255, 51]], "u1")
        for bits, data in ((8, colors), (16, colors.astype("<u2") * 257)):
            tags = {}
            for name, channel in zip(("Red", "Green", "Blue"), data.T):
                tags[name + "PaletteColorLookupTableDescriptor"] = [3, 0, bits]
                stored = channel.tobytes()
                tags[name + "PaletteColorLookupTableData"] = stored + b"\0" * (len(stored) % 2)
            path = write_map(self.folder, LABELS, PhotometricInterpretation="PALETTE COLOR", **tags)
            self.assertEqual(table_of(self.read(path)), {1: ("Liver", (200, 100, 50)), 2: ("Spleen", (0, 255, 51))})

    def test_names_of_maps(self):
        path = write_map(self.folder, LABELS, segments=[segment(0, "Nothing"), segment(2), segment(9, "Absent")])
        self.assertEqual(table_of(self.read(path)), {2: ("Spleen", None)})
        self.refused("its segment 0 is not the background, which has the Pixel Padding Value",
                     write_map(self.folder, LABELS, PixelPaddingValue=99))
        self.refused("at one place", write_map(self.folder, LABELS, order=(0, 1, 2, 3), change=frame(
            2, PlanePositionSequence=item(ImagePositionPatient=numbers(place(1))))))

    def test_many_segments(self):
        """Of which few are used, and all are listed."""
        listed = [segment(1), segment(2), *(segment(number, "s%d" % number) for number in range(3, 65536))]
        reader = self.reader(write(self.folder, segments=listed))
        self.compare(reader.GetOutput(), LABELS)
        (warning,) = warnings_of(reader)
        self.assertRegex(warning, "segments without a voxel: s3, s4, .*, s102, and 65433 more$")


class Folders(SegmentsTestCase):
    """The segmentation beside the images that it is of."""

    def test_images_and_segmentation(self):
        images.write_dicom_series(self.folder, LABELS, series="1.2.3")
        write(self.folder)
        reader = self.reader(self.folder)
        self.compare(reader.GetOutput(), LABELS)
        self.assertEqual(warnings_of(reader), [
            f"{self.folder}: the folder holds 2 DICOM series, and the one that is a segmentation was read ('{SERIES}'); "
            "SetSeriesUID() chooses another"])
        self.assertEqual(self.reader(self.folder, SeriesUID="1.2.3").GetOutput().GetDimensions(), SHAPE[::-1])
        save(self.folder / "other.dcm", pydicom.dcmread(write_map(self.folder, LABELS, SeriesInstanceUID="1.2.9")))
        self.refused("3 DICOM series; choose one with", self.folder)

    def test_in_one_series(self):
        images.write_dicom_series(self.folder, LABELS, series=SERIES)
        write(self.folder, masks=(LIVER & (Z == 2),))
        self.refused("'segments.dcm' has 1 frames of segments, and there are other files in its series", self.folder)

    def test_alone(self):
        write(self.folder)
        self.compare(self.read(self.folder), LABELS)


def highdicom_files():
    spec = importlib.util.spec_from_file_location("MakeSegmentations", HERE / "highdicom" / "MakeSegmentations.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


class OtherWriters(SegmentsTestCase):
    def test_highdicom(self):
        made = highdicom_files()
        masks = list(made.masks())
        fractions = list(np.rint(made.fractions() * 200) / 200 > 0.5)
        names = {number: name for number, name in enumerate(made.NAMES, 1)}
        for name, expected in (("binary", masks), ("binary-jpeg2000", masks), ("fractional", fractions),
                               ("label-map", masks[:2]), ("label-map-palette", masks[:2])):
            with self.subTest(name):
                reader = self.reader(HERE / "highdicom" / (name + ".dcm"))
                self.assertEqual(reader.GetErrorMessage(), "")
                self.compare(reader.GetOutput(), map_of(expected), made.ORIGIN, made.DIRECTION * made.SPACING,
                             ends=int(name != "binary-jpeg2000"))  # which has all frames
                both = (expected[0] & expected[-1]).sum()
                told = f"segments overlap in {both} voxels, which the smallest of them gets: Liver and Tumour ({both})"
                self.assertEqual(warnings_of(reader), [f"{reader.GetFileName()}: {told}"] if both else [])
                for label, (text, color) in table_of(reader.GetOutput()).items():
                    self.assertEqual(text, names[label])
                    np.testing.assert_allclose(color, made.COLORS[label - 1], atol=0.5)

    @unittest.skipUnless("VOXPLEX_DCMTK_SEGMENTS" in os.environ, "DCMTK was not found")
    def test_dcmtk(self):
        """Voxels and places of each segment, beside the arrays that made the file."""
        made, path = highdicom_files(), HERE / "highdicom" / "binary.dcm"
        told = json.loads(subprocess.run([os.environ["VOXPLEX_DCMTK_SEGMENTS"], path], check=True, capture_output=True,
                                         text=True).stdout)
        self.assertEqual([told[str(number)]["name"] for number in (1, 2, 3)], list(made.NAMES))
        ours = measures_of_image(self.reader(path).GetOutput())
        for number, mask in enumerate(made.masks(), 1):
            theirs = told[str(number)]
            ((count, centroid),) = measures_of_array(mask.astype(int), made.ORIGIN, made.DIRECTION * made.SPACING).values()
            self.assertEqual(theirs["voxels"], count)
            np.testing.assert_allclose(theirs["centroid"], centroid, atol=1e-6)
            if number > 1:  # what overlaps is not the first one's
                self.assertEqual(ours[number][0], theirs["voxels"])
                np.testing.assert_allclose(ours[number][1], theirs["centroid"], atol=1e-6)


if __name__ == "__main__":
    unittest.main()
