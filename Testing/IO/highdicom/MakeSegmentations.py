#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""MakeSegmentations.py: writes the segmentations beside it with highdicom (PyPI; 0.28.2 wrote them).

The voxels are those of masks(), on the grid of GEOMETRY, in slices that need not all be in a file.
"""
from pathlib import Path

import numpy as np

SHAPE = (9, 34, 33)  # slices, rows, columns: frames of 1122 bits
ORIGIN = np.array((12.5, -40.25, 7.0))
SPACING = (1.5, 0.75, 2.5)  # of columns, rows, slices
DIRECTION = np.array([[0.8, 0.36, 0.48], [0.0, 0.8, -0.6], [-0.6, 0.48, 0.64]])  # of these, in columns
NAMES = ("Liver", "Rib, left", "Tumour")
COLORS = ((221, 130, 101), (241, 214, 145), (144, 238, 144))


def fractions():
    """Three segments, from 0 to 1. The second is in the first and the last slices, the third has voxels of the first."""
    z, y, x = np.indices(SHAPE)
    ball = np.clip(1.6 - np.sqrt((x - 14) ** 2 + (y - 13) ** 2 + (3 * (z - 3)) ** 2) / 9, 0, 1)
    bar = np.where((abs(z - 4) > 2) & (y > 27) & (x < 17), 0.75, 0.0)
    tumour = np.where((abs(z - 4) < 2) & (abs(x - 20) < 5) & (abs(y - 16) < 4), 0.6, 0.0)
    return np.stack([ball, bar, tumour])


def masks(threshold=0.5):
    return fractions() > threshold


def source_images():
    from pydicom.dataset import Dataset, FileMetaDataset
    from pydicom.uid import ExplicitVRLittleEndian
    images = []
    for k in range(SHAPE[0]):
        image = Dataset()
        image.file_meta = FileMetaDataset()
        image.file_meta.TransferSyntaxUID = ExplicitVRLittleEndian
        image.SOPClassUID = "1.2.840.10008.5.1.4.1.1.2"
        image.SOPInstanceUID = "1.2.826.0.1.3680043.2.1125.8.%d" % (k + 1)
        image.StudyInstanceUID = "1.2.826.0.1.3680043.2.1125.8.91"
        image.SeriesInstanceUID = "1.2.826.0.1.3680043.2.1125.8.92"
        image.FrameOfReferenceUID = "1.2.826.0.1.3680043.2.1125.8.93"
        image.PatientID = image.PatientName = "Phantom^"
        image.PatientBirthDate = image.PatientSex = image.StudyDate = image.StudyTime = image.StudyID = ""
        image.AccessionNumber = image.ReferringPhysicianName = ""
        image.Modality, image.SeriesNumber, image.InstanceNumber = "CT", 1, k + 1
        image.Rows, image.Columns = SHAPE[1:]
        image.ImagePositionPatient = ["%.10g" % number for number in ORIGIN + k * SPACING[2] * DIRECTION[:, 2]]
        image.ImageOrientationPatient = [*DIRECTION[:, 0], *DIRECTION[:, 1]]
        image.PixelSpacing = [SPACING[1], SPACING[0]]
        image.SliceThickness = SPACING[2]
        images.append(image)
    return images


def main():
    import highdicom as hd
    from pydicom.sr.codedict import codes
    from pydicom.uid import ExplicitVRLittleEndian, JPEG2000Lossless, JPEGLSLossless, RLELossless

    def described(number, color=True):
        return hd.seg.SegmentDescription(
            number, NAMES[number - 1], codes.SCT.Organ, codes.SCT.Liver, hd.seg.SegmentAlgorithmTypeValues.MANUAL,
            display_color=hd.color.CIELabColor.from_rgb(*COLORS[number - 1]) if color else None)

    labels = np.zeros(SHAPE, np.uint8)
    for number, mask in enumerate(masks()[:2], 1):
        labels[mask] = number
    stacked = np.moveaxis(masks(), 0, -1)
    palette = hd.PaletteColorLUTTransformation.from_colors(
        ["#%02x%02x%02x" % color for color in ((0, 0, 0), *COLORS)])
    rows = (("binary", stacked, "BINARY", ExplicitVRLittleEndian, {}),
            ("binary-jpeg2000", stacked, "BINARY", JPEG2000Lossless, {"omit_empty_frames": False}),
            ("fractional", np.moveaxis(fractions(), 0, -1), "FRACTIONAL", RLELossless, {"max_fractional_value": 200}),
            ("label-map", labels, "LABELMAP", JPEGLSLossless, {}),
            ("label-map-palette", labels, "LABELMAP", ExplicitVRLittleEndian, {"palette_color_lut_transformation": palette}))
    for number, (name, array, kind, syntax, options) in enumerate(rows):
        count = 2 if kind == "LABELMAP" else 3
        segmentation = hd.seg.Segmentation(
            source_images(), array, kind, [described(i + 1, "palette" not in name) for i in range(count)],
            series_instance_uid="1.2.826.0.1.3680043.2.1125.9.%d" % number, series_number=2, instance_number=1,
            sop_instance_uid="1.2.826.0.1.3680043.2.1125.9.%d.1" % number, manufacturer="x", manufacturer_model_name="x",
            software_versions="x", device_serial_number="x", transfer_syntax_uid=syntax, **options)
        segmentation.save_as(Path(__file__).with_name(name + ".dcm"))


if __name__ == "__main__":
    main()
