#!/usr/bin/python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""MakeSeeds.py FOLDER: writes a folder of small files for each fuzzer, from which it starts."""
import gzip
import io
import json
import struct
import sys
import tempfile
from pathlib import Path

import numpy as np
import pydicom
from pydicom.dataset import Dataset, FileMetaDataset

sys.path.insert(0, str(Path(__file__).parent.parent / "Support"))
import images

LABELS = images.ball(4, 1.5, label=3)
FRAMES = images.moving_balls(2, 4, 1.5)

TABLES = ("1 Tibia\n2 Femur, left\n",
          "1 Precentral_L 2001\n2 Precentral_R 2002\n",
          "# colours\n17 Left-Hippocampus 220 216 20 0\n",
          '3 0 0 255 1 1 1 "Left hippocampus"\n',
          '3,"Hippocampus, ""left""",220,216,20\n4;b\n',
          "name\tvalue\tred\tgreen\tblue\r\nKnee\t7\t0.5\t1\t0\r\n",
          "\ufeffid;region\n9;\u00dcber\n")

CALLS = ("--input\ni.nrrd\n--delta\n1.5\n--labels\nTibia,3\n--output\nm.vtu\n",
         "--input=i\n--label-size\nKnee=2\n--interface-size\n3,7=0.5\n--gradation\n0.3\n--memory-limit\n8G\n",
         "--input\ni\n--slices\nheart_\n--slice-count\n3\n--threads\n2\n--contention\nlocal\n--plc\ni.stl\n",
         "--input\ni\n--isovalue\n3.5\n--elements\n1000\n--grading\nlfs\n--space\nras\n--stats\ns.json\n")


def detached(folder, data, **header_lines):
    """An NRRD header that names files."""
    path = Path(images.write_nrrd(folder / "i.nhdr", LABELS.astype("<u2"),
                                  header_lines={"encoding": "raw", "data file": data, **header_lines}))
    return path.read_bytes().split(b"\n\n")[0] + b"\n"


def overlapping_segments(folder):
    """Of 3D Slicer, in two layers."""
    keys = {f"Segment{n}_{key}": value for n, values in enumerate((("a", "Knee", 3, 0), ("b", "Bone", 1, 1), ("c", "Fat", 2, 1)))
            for key, value in zip(("ID", "Name", "LabelValue", "Layer"), map(str, values))}
    layers = np.stack([LABELS, np.where(np.arange(4) < 2, 1, 2).astype(np.uint8) + 0 * LABELS], axis=-1)
    return Path(images.write_nrrd(folder / "i.seg.nrrd", layers, components=True, key_values=keys,
                                  header_lines={"kinds": "list domain domain domain", "encoding": "raw"})).read_bytes()


def vtk(binary):
    head = ("# vtk DataFile Version 3.0\nlabels\n%s\nDATASET STRUCTURED_POINTS\nDIMENSIONS 4 4 4\nSPACING 1 1 1\n"
            "ORIGIN 0 0 0\nPOINT_DATA 64\nSCALARS labels unsigned_char 1\nLOOKUP_TABLE default\n")
    data = LABELS.tobytes() if binary else " ".join(map(str, LABELS.ravel())).encode() + b"\n"
    return (head % ("BINARY" if binary else "ASCII")).encode() + data


def nifti_header():
    """Of two files."""
    with tempfile.TemporaryDirectory() as folder:
        header = bytearray(Path(images.write_nifti(Path(folder) / "i.nii", LABELS.astype("<u2"))).read_bytes()[:348])
    struct.pack_into("<f", header, 108, 0.0)
    header[344:348] = b"ni1\0"
    return bytes(header)


def gipl():
    head = bytearray(256)
    struct.pack_into(">4H", head, 0, 4, 4, 4, 1)
    struct.pack_into(">H", head, 8, 8)
    struct.pack_into(">4f", head, 10, 1, 1, 1, 1)
    struct.pack_into(">I", head, 252, 719555000)
    return bytes(head) + LABELS.tobytes()


def mgh():
    head = bytearray(284)
    struct.pack_into(">6i", head, 0, 1, 4, 4, 4, 1, 0)
    struct.pack_into(">h12f", head, 28, 1, 1, 1, 1, 1, 0, 0, 0, 1, 0, 0, 0, 1)
    return bytes(head) + LABELS.tobytes()


def mrc():
    head = bytearray(1024)
    struct.pack_into("<4i", head, 0, 4, 4, 4, 0)
    struct.pack_into("<3i6f3i", head, 28, 4, 4, 4, 4, 4, 4, 90, 90, 90, 1, 2, 3)
    head[208:216] = b"MAP \x44\x44\0\0"
    return bytes(head) + LABELS.tobytes()


def segmentation(kind):
    """Of DICOM: two segments in three slices, or a label map of them."""
    def item(**tags):
        data = Dataset()
        for name, value in tags.items():
            setattr(data, name, value)
        return data
    bits = 1 if kind == "BINARY" else 8
    frames = [(k, 0) for k in (0, 2)] if kind == "LABELMAP" else [(0, 1), (1, 1), (1, 2), (3, 2)]
    groups = [item(PlanePositionSequence=[item(ImagePositionPatient=["0", "0", str(k)])]) for k, _ in frames]
    for group, (_, number) in zip(groups, frames):
        if number:
            group.SegmentIdentificationSequence = [item(ReferencedSegmentNumber=number)]
    pixels = np.stack([LABELS[k] + (LABELS[k] if number > 1 else 0) for k, number in frames])
    packed = pixels * (25 if kind == "FRACTIONAL" else 1)
    if bits == 1:
        packed = np.packbits(pixels.ravel() > 0, bitorder="little")
    data = item(
        SOPClassUID="1.2.840.10008.5.1.4.1.1.66." + ("7" if kind == "LABELMAP" else "4"), SeriesInstanceUID="1.2", Rows=4,
        Columns=4, SamplesPerPixel=1, PhotometricInterpretation="MONOCHROME2", NumberOfFrames=len(frames),
        BitsAllocated=bits, BitsStored=bits, HighBit=bits - 1, PixelRepresentation=0, SegmentationType=kind, MaximumFractionalValue=100,
        SegmentSequence=[item(SegmentNumber=n, SegmentLabel="Knee", RecommendedDisplayCIELabValue=[9, 9, 9])
                         for n in (1, 2, 3)],
        SharedFunctionalGroupsSequence=[item(
            PlaneOrientationSequence=[item(ImageOrientationPatient=[1, 0, 0, 0, 1, 0])],
            PixelMeasuresSequence=[item(PixelSpacing=[1, 1], SpacingBetweenSlices="1")])],
        PerFrameFunctionalGroupsSequence=groups)
    data.PixelData = packed.astype("u1").tobytes()
    data["PixelData"].VR = "OB"
    data.preamble, data.file_meta = bytes(128), FileMetaDataset()
    data.file_meta.TransferSyntaxUID = "1.2.840.10008.1.2.1"
    data.is_little_endian, data.is_implicit_VR = True, False
    file = io.BytesIO()
    pydicom.dcmwrite(file, data)
    return file.getvalue()


def vti():
    return ('<?xml version="1.0"?>\n<VTKFile type="ImageData" version="0.1" byte_order="LittleEndian">\n'
            '<ImageData WholeExtent="0 3 0 3 0 3" Origin="0 0 0" Spacing="1 1 1">\n<Piece Extent="0 3 0 3 0 3">\n'
            '<PointData Scalars="l"><DataArray type="UInt8" Name="l" format="ascii">%s</DataArray></PointData>\n'
            "</Piece>\n</ImageData>\n</VTKFile>\n" % " ".join(map(str, LABELS.ravel()))).encode()


def answer(**fields):
    """What the reading process tells."""
    return json.dumps({"type": 1, "sizes": [4, 4, 4, 1], "origin": [0, 0, 0], "spacing": [1, 1, 1],
                       "direction": [1, 0, 0, 0, 1, 0, 0, 0, 1], "time": [0, 1], "times": [], "offset": 0,
                       "labels": [[3, "Tibia", [1, 0, 0]], [4, "Femur"]], "warnings": ["odd"], **fields}).encode()


def tiff():
    entries = ((256, 4, 4), (257, 4, 4), (258, 3, 8), (259, 3, 1), (262, 3, 1), (273, 4, 8), (277, 3, 1), (278, 4, 4),
               (279, 4, 16))
    directory = struct.pack("<H", len(entries))
    for tag, kind, value in entries:
        directory += struct.pack("<2HII", tag, kind, 1, value)
    return b"II*\0" + struct.pack("<I", 24) + LABELS[1].tobytes() + directory + b"\0" * 4


def image_seeds(folder):
    def nrrd(**options):
        return Path(images.write_nrrd(folder / "i.nrrd", LABELS, **options)).read_bytes()

    def meta(array=LABELS, **header):
        return Path(images.write_metaimage(folder / "i.mha", array, header_lines=header)).read_bytes()

    nifti = [Path(images.write_nifti(folder / "i.nii", array)).read_bytes() for array in (LABELS, FRAMES)]
    head = meta(LABELS.astype("<u2"), ElementDataFile="i.raw")
    head = head[:head.index(b"i.raw") + 6]
    return {
        "nrrd": [nrrd(), nrrd(header_lines={"encoding": "raw"}), nrrd(key_values={
                     "Segment0_ID": "a", "Segment0_Name": "Knee", "Segment0_LabelValue": "3", "Segment0_Color": "1 0 0"}),
                 overlapping_segments(folder),
                 Path(images.write_sequence(folder / "i.nrrd", FRAMES)).read_bytes(),
                 Path(images.write_space_time_nrrd(folder / "i.nrrd", FRAMES)).read_bytes()],
        "nhdr": [detached(folder, "i.raw"), detached(folder, "LIST\ni.raw\ni.raw\ni.raw\ni.raw"),
                 detached(folder, "i%d.raw 1 4 1")],
        "nii": nifti,
        "nii.gz": [gzip.compress(data, 1) for data in nifti],
        "hdr": [nifti_header()],
        "mha": [meta(), meta(FRAMES), meta(CompressedData="True")],
        "mhd": [head, head.replace(b"i.raw", b"LIST\ni.raw"), head.replace(b"i.raw", b"i%d.raw 1 4 1")],
        "vtk": [vtk(True), vtk(False)],
        "dcm": [*(path.read_bytes() for path in images.write_dicom_series(folder, LABELS)[:1]),
                *(segmentation(kind) for kind in ("BINARY", "FRACTIONAL", "LABELMAP"))],
        "gipl": [gipl()],
        "mgh": [mgh()],
        "mrc": [mrc()],
        "vti": [vti()],
        "tif": [tiff()],
    }


def main():
    target = Path(sys.argv[1])
    with tempfile.TemporaryDirectory() as folder:
        seeds = image_seeds(Path(folder))
    seeds["label-table"] = [table.encode() for table in TABLES]
    seeds["command-line"] = [call.encode() for call in CALLS]
    seeds["answer"] = [answer(), answer(sizes=[4, 4, 4, 3], times=[0, 1, 3]), b'{"error": "it is damaged"}']
    rng = np.random.default_rng(1)
    seeds["mesh"] = [rng.bytes(200) for _ in range(20)]
    for name, files in seeds.items():
        (target / name).mkdir(parents=True, exist_ok=True)
        for i, data in enumerate(files):
            (target / name / ("seed-%d" % i)).write_bytes(data)


if __name__ == "__main__":
    main()
