#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Mesh a segmentation and write the tetrahedra and the interfaces.

    mesh_segmentation.py [INPUT] --output MESH.vtu [--interfaces PLC.vtp] [--delta LENGTH]

INPUT is a label image that VTK reads: .vti, .mha, .mhd or .nii(.gz). Without it a small phantom is
meshed: two touching organs in a body.
"""

import argparse
import json
import math
import sys

from vtkmodules.vtkCommonCore import VTK_UNSIGNED_CHAR
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkCommonExecutionModel import vtkTrivialProducer
from vtkmodules.vtkIOImage import vtkMetaImageReader, vtkNIFTIImageReader
from vtkmodules.vtkIOXML import (
    vtkXMLImageDataReader, vtkXMLPolyDataWriter, vtkXMLUnstructuredGridWriter)

import voxplex


def phantom():
    """48 x 32 x 24 voxels of 1 x 1 x 1.5 mm: organs 2 and 3 touch each other inside of body 1."""
    image = vtkImageData()
    image.SetDimensions(48, 32, 24)
    image.SetSpacing(1.0, 1.0, 1.5)
    image.AllocateScalars(VTK_UNSIGNED_CHAR, 1)
    for k in range(24):
        for j in range(32):
            for i in range(48):
                x, y, z = i - 23.5, j - 15.5, 1.5 * (k - 11.5)
                label = 0
                if math.hypot(x / 21, y / 14, z / 15) < 1.0:
                    label = 1
                if math.hypot(x + 6, y, z) < 7.0:
                    label = 2
                elif math.hypot(x - 6, y, z) < 7.0:
                    label = 3
                image.SetScalarComponentFromDouble(i, j, k, 0, label)
    producer = vtkTrivialProducer()
    producer.SetOutput(image)
    producer.SetWholeExtent(image.GetExtent())
    return producer


def reader_of(path):
    readers = {
        ".vti": vtkXMLImageDataReader, ".mha": vtkMetaImageReader, ".mhd": vtkMetaImageReader,
        ".nii": vtkNIFTIImageReader, ".nii.gz": vtkNIFTIImageReader}
    for suffix, reader in readers.items():
        if path.endswith(suffix):
            result = reader()
            result.SetFileName(path)
            return result
    sys.exit(f"{path}: the name must end in one of {', '.join(readers)}")


def write(writer, port, path):
    writer.SetInputConnection(port)
    writer.SetFileName(path)
    if not writer.Write():
        sys.exit(f"{path}: could not be written")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("input", nargs="?")
    parser.add_argument("--output", required=True)
    parser.add_argument("--interfaces")
    parser.add_argument("--delta", type=float, default=0.0)
    arguments = parser.parse_args()

    source = reader_of(arguments.input) if arguments.input else phantom()
    mesher = voxplex.vtkImageToTetMeshFilter()
    mesher.SetInputConnection(source.GetOutputPort())
    mesher.SetDelta(arguments.delta)
    mesher.ComputeQualityOn()
    mesher.Update()
    if mesher.GetErrorMessage():
        sys.exit(mesher.GetErrorMessage())

    figures = json.loads(mesher.GetStatistics().ToJSON())
    print(f"{figures['elements']} tetrahedra, {figures['interface_facets']} interface triangles")
    for label, entry in figures["labels"].items():
        print(f"  label {label}: {entry['elements']} tetrahedra, volume {entry['volume']:.1f}")

    write(vtkXMLUnstructuredGridWriter(), mesher.GetOutputPort(), arguments.output)
    if arguments.interfaces:
        write(vtkXMLPolyDataWriter(), mesher.GetInterfacesPort(), arguments.interfaces)


if __name__ == "__main__":
    main()
