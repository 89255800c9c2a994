# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""Names and colours of labels become annotations and categorical colours of ParaView's colour maps."""
import struct

from voxplex_testing import *

from paraview.simple import GetColorTransferFunction, SaveData, Sphere, XMLImageDataReader, XMLUnstructuredGridReader

def check_maps(what):
    label = GetColorTransferFunction("Label")
    check_equal(pairs(label.Annotations), {"3": NAME, "7": "7"}, what)
    check_equal(bool(label.InterpretValuesAsCategories), True, what)
    check_equal([round(c, 6) for c in label.IndexedColors[:3]], list(COLOR), what)
    check_equal(len(label.IndexedColors), 6, what)
    check(list(label.IndexedColors[3:]) != list(COLOR), what, "label 7 has its own colour")
    sides = GetColorTransferFunction("Labels")
    check_equal(pairs(sides.Annotations), {"0": "background", "3": NAME, "7": "7"}, what)
    check_equal((sides.VectorMode, sides.VectorComponent), ("Component", 0), what)


def write_cells(labels):
    """A row of voxels with a label each, as a MetaImage with a table of names."""
    path = output_path("cells-%d.mha" % labels)
    with open(path, "wb") as file:
        file.write(b"ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
                   b"DimSize = %d 2 2\nElementType = MET_USHORT\nElementDataFile = LOCAL\n" % labels)
        file.write(4 * struct.pack("<%dH" % labels, *range(1, labels + 1)))
    with open(path + ".txt", "w") as file:
        file.writelines("%d Cell %d\n" % (label, label) for label in range(1, labels + 1))
    return path


def reset_maps():
    for name in ("Label", "Labels"):
        colors = GetColorTransferFunction(name)
        colors.InterpretValuesAsCategories = 0
        colors.Annotations = []
        colors.IndexedColors = []


def main():
    load_plugin(namespace=globals())
    import voxplex_paraview

    reader = XMLImageDataReader(FileName=[write_named_image()])
    reader.UpdatePipeline()
    mesher = MeshSegmentationTetrahedralize(Input=reader)
    voxplex_paraview.apply_label_colors(mesher)
    check_maps("of the mesh")
    screenshot(mesher, "label-colors.png", ("CELLS", "Label"))
    pixels = check_picture(output_path("label-colors.png"))
    # Orange (0.8, 0.4, 0.2) in some light: red twice as strong as green, green as blue.
    orange = [p for p in pixels.tolist() if p[0] > 90 and abs(p[0] - 2 * p[1]) < 25 and abs(p[1] - 2 * p[2]) < 25]
    check(len(orange) > 500, "pixels in the colour of label 3", len(orange))

    reset_maps()
    voxplex_paraview.apply_label_colors(mesher[1])
    check_equal(pairs(GetColorTransferFunction("Labels").Annotations)["3"], NAME, "of the interfaces")
    check_equal(set(pairs(GetColorTransferFunction("Label").Annotations)), {"3"}, "which have no array Label")

    # From a file, without any filter of ours.
    reset_maps()
    path = output_path("named.vtu")
    SaveData(path, proxy=mesher)
    voxplex_paraview.apply_label_colors(XMLUnstructuredGridReader(FileName=[path]))
    check_maps("of a file")

    # Names as bytes, as our writer has them.
    reset_maps()
    reader = XMLImageDataReader(FileName=[write_named_image(as_bytes=True)])
    voxplex_paraview.apply_label_colors(MeshSegmentationTetrahedralize(Input=reader))
    check_maps("of bytes")

    # The atlas with its table of names, through the reader.
    reader = SegmentationReaderVoxplex(FileName=ATLAS, LabelTableFile=ATLAS.replace(".gz", ".txt"))
    check_equal(reader.SMProxy.GetProperty("LabelTableFileName").GetElement(0), ATLAS.replace(".gz", ".txt"))
    atlas = MeshSegmentationTetrahedralize(Input=reader, Delta=5.0)
    voxplex_paraview.apply_label_colors(atlas)
    names = pairs(GetColorTransferFunction("Label").Annotations)
    check_equal((len(names), names.get("1"), names.get("116")), (116, "Precentral_L", "Vermis_10"), "the atlas")
    reset_maps()
    voxplex_paraview.apply_label_colors(mesher)

    # VTK draws slowly with many categories.
    for labels in (1000, 1001):
        reader = SegmentationReaderVoxplex(FileName=write_cells(labels))
        voxplex_paraview.apply_label_colors(reader)
        for array in ("Label", "Labels"):
            colors = GetColorTransferFunction(array)
            check_equal(bool(colors.InterpretValuesAsCategories), labels == 1000, "%d labels" % labels)
            check_equal(pairs(colors.Annotations).get("77"), "Cell 77" if labels == 1000 else None)
    reset_maps()
    voxplex_paraview.apply_label_colors(mesher)

    # Nothing to apply: nothing changes.
    voxplex_paraview.apply_label_colors(Sphere())
    check_maps("after a source without labels")


run(main)
