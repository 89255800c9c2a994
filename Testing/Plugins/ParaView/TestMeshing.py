# SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
# SPDX-License-Identifier: BSD-3-Clause
"""The plugin in pvbatch: meshes the AAL atlas through the proxies, and small images with each option."""
from voxplex_testing import *

from paraview.simple import GroupDatasets, MeshQuality, XMLImageDataReader
from vtkmodules.util.misc import calldata_type
from vtkmodules.util.vtkConstants import VTK_STRING

FILTERS = ("VoxplexMasksToSegmentation", "VoxplexTetMesh", "VoxplexPentatopeMesh", "VoxplexTimeSlice", "VoxplexSegmentationRepair",
           "VoxplexSimplexMeshQuality")


def test_documentation():
    """The Help page and the tooltips are made from it: of each filter and of each property and port."""
    manager = servermanager.ActiveConnection.Session.GetSessionProxyManager()
    for group, name in [("filters", name) for name in FILTERS] + [("sources", "VoxplexSegmentationReader")]:
        proxy = manager.GetPrototypeProxy(group, name)
        check(proxy is not None, "no proxy", name)
        text = proxy.GetDocumentation().GetDescription()
        check(text and len(text) > 100, "documentation of", name)
        check(proxy.GetHints().FindNestedElementByName("ShowInMenu" if group == "filters" else "ReaderFactory"), name)
        iterator = proxy.NewPropertyIterator()
        properties = 0
        while not iterator.IsAtEnd():
            documentation = iterator.GetProperty().GetDocumentation()
            text = documentation.GetDescription() if documentation else None
            check(text and len(text.strip()) > 20, "documentation of", name, iterator.GetKey())
            properties += 1
            iterator.Next()
        check(properties > 2, name, properties)


def test_atlas():
    reader = SegmentationReaderVoxplex(FileName=ATLAS)
    mesher = MeshSegmentationTetrahedralize(Input=reader)
    check_equal(mesher.Delta, 2.0, "default Delta at 1 mm")
    mesher.Delta = 3.0
    mesher.UpdatePipeline()
    check_equal(labels_of(mesher), set(range(1, 117)), "labels of the atlas")
    info = mesher[0].GetDataInformation()
    check(60000 < info.GetNumberOfCells() < 200000, "tetrahedra", info.GetNumberOfCells())
    # The atlas spans 147 x 180 x 147 mm in LPS; NIfTI has it in RAS with x reversed.
    bounds = info.GetBounds()
    for found, expected in zip(bounds, (-73, 73, -75, 106, -62, 85)):
        check(abs(found - expected) < 4, "bounds", bounds)
    interfaces = mesher[1].GetDataInformation()
    check(interfaces.GetNumberOfCells() > 20000, "triangles", interfaces.GetNumberOfCells())
    check_equal([mesher.SMProxy.GetOutputPortName(i) for i in (0, 1)], ["Mesh", "Interfaces"])
    check_equal(interfaces.GetDataSetTypeAsString(), "vtkPolyData")
    check(interfaces.GetArrayInformation("Labels", 1).GetNumberOfComponents() == 2, "Labels")
    check(info.GetArrayInformation("SPACE", 2) is not None, "field data SPACE")
    screenshot(mesher, "atlas.png", ("CELLS", "Label"))
    quality = MeshQuality(Input=mesher)
    quality.UpdatePipeline()
    check_equal(count_cells(quality), info.GetNumberOfCells())
    ours = SegmentationMeshQuality(Input=mesher, Segmentation=reader)
    ours.UpdatePipeline()
    check_equal(count_cells(ours), info.GetNumberOfCells())
    for name in ("MinimumDihedralAngle", "MaximumDihedralAngle", "RadiusEdgeRatio", "Volume"):
        check(ours[0].GetDataInformation().GetArrayInformation(name, 1) is not None, name)
    check_equal([ours.SMProxy.GetOutputPortName(i) for i in (0, 1, 2)], ["Mesh", "Labels", "Histograms"])
    check_equal(ours[1].GetDataInformation().GetNumberOfRows(), 116, "labels of the table")
    check_equal(ours[2].GetDataInformation().GetNumberOfRows(), 90, "bins of the histograms")
    ours.UpdatePropertyInformation()
    check(0.5 < ours.GetProperty('HausdorffDistance')[0] < 6.0, "Hausdorff distance", ours.GetProperty('HausdorffDistance')[0])


def test_place_of_a_file():
    """What the panel says counts before the file; zeros and no origin leave the file's."""
    reader = SegmentationReaderVoxplex(FileName=ATLAS)
    reader.UpdatePipeline()
    own = reader.GetDataInformation().GetBounds()
    reader.Spacing = [2.0, 1.0, 1.5]
    reader.Origin = [10.0, 20.0, 30.0]
    reader.Direction = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]
    reader.DataFilesAnywhere = 1
    reader.UpdatePipeline()
    check_equal(reader.GetDataInformation().GetBounds(), (10.0, 370.0, 20.0, 236.0, 30.0, 300.0))
    reader.Spacing = [0.0] * 3
    reader.Origin = []
    reader.Direction = [0.0] * 9
    reader.UpdatePipeline()
    check_equal(reader.GetDataInformation().GetBounds(), own)


def test_repair():
    """Rows of labels and lengths, and the table."""
    def labels_of_voxels():
        repair.UpdatePipeline()
        return set(numbers(servermanager.Fetch(repair).GetPointData().GetScalars()))

    hole = make_image(lambda i, j, k: 0 if (i, j, k) == (5, 8, 8) else two_balls(i, j, k))
    reader = XMLImageDataReader(FileName=[write_image(hole, "hole.vti")])
    repair = RepairSegmentation(Input=reader, FillHoles=1, Shells=[3, 1.5, 7, -1], FirstShellLabel=9, MinimumThickness=[3, 2])
    check_equal(labels_of_voxels(), {0, 3, 7, 9, 10}, "labels and shells")
    table = servermanager.Fetch(repair, idx=1)
    rows = [(table.GetColumnByName("What").GetValue(i), table.GetColumnByName("Label").GetValue(i)) for i in range(4)]
    check_equal(rows, [("fill-holes", 3), ("min-thickness", 3), ("shell", 3), ("shell", 7)])
    mesher = MeshSegmentationTetrahedralize(Input=repair, Delta=1.0)
    mesher.UpdatePipeline()
    check_equal(labels_of(mesher), {3, 7, 9, 10}, "labels of the mesh")
    repair.Shells = []
    check_equal(labels_of_voxels(), {0, 3, 7}, "rows taken away")


def test_masks():
    """Several inputs, a group of them, and a folder of files."""
    masks = {"liver": lambda i, j, k: i < 9, "heart": lambda i, j, k: i > 5, "cyst": lambda i, j, k: i == j == k == 2}
    os.makedirs(output_path("masks"), exist_ok=True)
    paths = [write_image(make_image(mask, name="Scalars"), f"masks/{name}.vti") for name, mask in masks.items()]
    readers = [XMLImageDataReader(FileName=[path]) for path in paths]
    several = MasksToSegmentation(Input=readers, MaskNames=list(masks))
    # The heart, with 10 slices, is larger than the liver, with 9.
    expected = {name: make_image(mask).GetPointData().GetScalars() for name, mask in masks.items()}
    labels = [3 if cyst else 1 if liver else 2 for liver, heart, cyst in zip(*map(numbers, expected.values()))]
    group = MasksToSegmentation(Input=GroupDatasets(Input=readers))
    folder = SegmentationReaderVoxplex(FileName=output_path("masks"))
    for source, names in ((several, list(masks)), (group, None), (folder, sorted(masks))):
        source.UpdatePipeline()
        image = servermanager.Fetch(source)
        order = [sorted(masks).index(name) + 1 for name in masks] if source is folder else [1, 2, 3]
        check(numbers(image.GetPointData().GetArray("Labels")) == [order[label - 1] for label in labels], "labels of", names)
        if names:
            array = image.GetFieldData().GetAbstractArray("LabelNames")
            check_equal([array.GetValue(n) for n in range(array.GetNumberOfValues())], names)
    several.Overlap = "First"
    mesher = MeshSegmentationTetrahedralize(Input=several, SmallestComponent=0)
    mesher.UpdatePipeline()
    check_equal(labels_of(mesher), {1, 2}, "the first gets what all have")
    readers[1:] = []
    several.Input = readers
    several.MaskNames = ["liver"]
    several.UpdatePipeline()
    check_equal(several.PointData["Labels"].GetRange(), (0, 1), "inputs taken away")


def test_dicom_segmentation():
    file = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "IO", "highdicom", "fractional.dcm")
    reader = SegmentationReaderVoxplex(FileName=file)
    reader.UpdatePipeline()
    check_equal(reader.PointData["Labels"].GetRange(), (0, 3), "segments")
    reader.MaskThreshold = 0.7
    reader.UpdatePipeline()
    check_equal(reader.PointData["Labels"].GetRange(), (0, 2), "segments above 0.7")


def numbers(array):
    return [int(array.GetTuple1(n)) for n in range(array.GetNumberOfTuples())]


def test_options():
    reader = XMLImageDataReader(FileName=[write_image(make_image(two_balls), "balls.vti")])
    mesher = MeshSegmentationTetrahedralize(Input=reader, Threads=1)
    mesher.UpdatePipeline()
    check_equal(labels_of(mesher), {3, 7})
    cells = count_cells(mesher)
    check(cells > 100, cells)

    mesher.LabelTable = [7, 0.0, 0]
    mesher.UpdatePipeline()
    check_equal(labels_of(mesher), {3}, "label 7 left out")
    mesher.LabelTable = [3, 0.8, 1]
    mesher.UpdatePipeline()
    check_equal(labels_of(mesher), {3, 7}, "label 7 is back")
    check(count_cells(mesher) > 1.3 * cells, "label 3 finer", count_cells(mesher), cells)
    mesher.LabelTable = []
    mesher.UpdatePipeline()
    check_equal(count_cells(mesher), cells, "no rows")

    mesher.Delta = 1.0
    mesher.UpdatePipeline()
    check(count_cells(mesher) > 2 * cells, "half of Delta", count_cells(mesher), cells)
    mesher.Delta = 0.0
    mesher.UpdatePipeline()
    check_equal(count_cells(mesher), cells, "0 means the default")

    sizes = make_image(lambda i, j, k: 1, name="Size")
    size_reader = XMLImageDataReader(FileName=[write_image(sizes, "sizes.vti")])
    mesher.SizeImage = size_reader
    mesher.UpdatePipeline()
    check(count_cells(mesher) > 1.3 * cells, "size image", count_cells(mesher), cells)
    mesher.SizeImage = None
    mesher.UpdatePipeline()
    check_equal(count_cells(mesher), cells, "size image taken away")
    mesher.ElementSize = 1.0
    mesher.UpdatePipeline()
    check(count_cells(mesher) > 1.3 * cells, "element size", count_cells(mesher), cells)


def test_density_and_shapes():
    reader = XMLImageDataReader(FileName=[write_image(make_image(two_balls), "balls.vti")])
    mesher = MeshSegmentationTetrahedralize(Input=reader, Threads=1, Delta=1.0)

    def count(**properties):
        """With these alone."""
        before = {name: mesher.GetPropertyValue(name) for name in properties}
        for name, value in properties.items():
            mesher.SetPropertyWithName(name, value)
        mesher.UpdatePipeline()
        cells = count_cells(mesher)
        for name, value in before.items():
            mesher.SetPropertyWithName(name, value)
        return cells

    plain = count()
    check(abs(count(NumberOfElements=9000) / 9000 - 1) <= 0.1, "a number of elements, in place of Delta")
    check_equal(count(), plain, "and Delta again")
    graded = count(Grading="Local feature size")
    check(graded < 0.8 * plain, "graded", graded, plain)
    check(count(Grading="Local feature size", FeatureRatio=0.3) > 1.1 * graded, "feature ratio")
    check(count(Grading="Local feature size", LargestFeature=1.0) > 1.1 * graded, "largest feature")
    check_equal(count(FeatureRatio=0.3, LargestFeature=1.0), plain, "neither without grading")
    finer = count(InterfaceTable=[3, 0, 0.5])
    check(finer > 1.3 * plain, "interface between two", finer, plain)
    check(count(InterfaceTable=[3, -1, 0.5, 7, -1, 0.5]) > 1.3 * finer, "of labels")
    for properties in (dict(Optimise=0), dict(SliverAngle=0.0), dict(InterfaceRounds=0, Manifold=0, SampleJunctions=0),
                       dict(FacetAngle=10.0)):
        check(count(**properties) != plain, properties)
    check(count(InterfaceTable=[3, 0, 0.5], Gradation=0.1) > finer, "gradation")
    check(count(MinimumComponentVolume=1e9) == 0, "everything left out")


def test_isosurface():
    image = make_image(lambda i, j, k: 10 * i, name="Ramp")
    reader = XMLImageDataReader(FileName=[write_image(image, "ramp.vti")])
    mesher = MeshSegmentationTetrahedralize(Input=reader, Threads=1, InputMode="Isosurface", InsideLabel=4)
    reader.UpdatePipeline()
    middle = 0.5 * sum(reader.GetDataInformation().GetArrayInformation("Ramp", 0).GetComponentRange(0))
    mesher.Isovalue = middle
    mesher.UpdatePipeline()
    check_equal(labels_of(mesher), {4})
    bounds = mesher[0].GetDataInformation().GetBounds()
    check(abs(bounds[0] - middle / 10) < 0.1, "above", bounds, middle)
    mesher.Inside = "Below the isovalue"
    mesher.UpdatePipeline()
    bounds = mesher[0].GetDataInformation().GetBounds()
    check(abs(bounds[1] - middle / 10) < 0.1, "below", bounds, middle)


def test_default_delta():
    """It follows the spacing, and is the filter's own."""
    for spacing, expected in (((1, 1, 1), 2.0), ((0.5, 2.0, 8.0), 4.0)):
        reader = XMLImageDataReader(FileName=[write_image(make_image(two_balls, spacing=spacing), "spaced.vti")])
        reader.UpdatePipeline()
        mesher = MeshSegmentationTetrahedralize(Input=reader)
        check(abs(mesher.Delta - expected) < 1e-9, spacing, mesher.Delta)
        mesher.Delta = 17.0
        mesher.SMProxy.GetProperty("Delta").ResetToDefault()
        check(abs(mesher.Delta - expected) < 1e-9, "reset", mesher.Delta)


def test_arrays():
    """Point and cell arrays can be chosen; the default is the active one."""
    image = make_image(two_balls)
    other = make_image(lambda i, j, k: 5 if 4 <= i < 12 and 4 <= j < 12 and 4 <= k < 12 else 0, name="Box")
    image.GetPointData().AddArray(other.GetPointData().GetArray("Box"))
    reader = XMLImageDataReader(FileName=[write_image(image, "arrays.vti")])
    reader.UpdatePipeline()
    mesher = MeshSegmentationTetrahedralize(Input=reader)
    check_equal(list(mesher.LabelArray), ["POINTS", "Segmentation"])
    mesher.LabelArray = ["POINTS", "Box"]
    mesher.UpdatePipeline()
    check_equal(labels_of(mesher), {5})


def test_messages():
    """Errors name properties by their labels."""
    reader = XMLImageDataReader(FileName=[write_image(make_image(two_balls), "messages.vti")])
    mesher = MeshSegmentationTetrahedralize(Input=reader, RadiusEdgeRatio=1.5)
    messages = []

    @calldata_type(VTK_STRING)
    def note(_caller, _event, text):
        messages.append(text)

    mesher.SMProxy.GetClientSideObject().AddObserver("ErrorEvent", note)
    mesher.UpdatePipeline()
    check("'Radius-Edge Ratio' is 1.5; it must be at least 1.93" in "".join(messages), messages)


def main():
    load_plugin(namespace=globals())
    test_documentation()
    test_repair()
    test_masks()
    test_dicom_segmentation()
    test_options()
    test_density_and_shapes()
    test_isosurface()
    test_default_delta()
    test_arrays()
    test_messages()
    test_atlas()
    test_place_of_a_file()


run(main)
