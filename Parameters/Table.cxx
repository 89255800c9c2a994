// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
#include "MeshingParameters.h"

namespace voxplex
{
namespace
{

using Kind = ParameterKind;
using Group = ParameterGroup;
using Parameters = std::vector<MeshingParameter>;

constexpr const char* None = MeshingParameter::None;
constexpr double Infinity = std::numeric_limits<double>::infinity();
constexpr double LargestWhole = std::numeric_limits<int>::max();
constexpr ParameterRange Positive{ 0.0, Infinity, true };
constexpr ParameterRange NotNegative{ 0.0, Infinity };
constexpr ParameterRange Sigmas{ 0.0, 5.0 };

const ParameterRule NotOfGreyValues{ "isovalue",
  ": grey-value images have no labels; leave it or {isovalue} out" };
const ParameterRule OfIsosurface{ "isovalue",
  ": inside of what? Give the isosurface with {isovalue}" };
const ParameterRule OfGrading{ "grading",
  ": only for interfaces that are graded; give {grading} lfs as well, or leave it out" };
const ParameterRule OfPicking{ "picking",
  " is about picking regions, and {picking} switches them off: leave one of the two out" };

/** The columns that all parameters have are arguments. `rest` has the other members. */
MeshingParameter Number(Kind kind, const char* name, int dimension, ParameterRange range,
  const char* defaultValue, const char* unit, const char* help, MeshingParameter rest = {})
{
  rest.Name = name;
  rest.Kind = kind;
  rest.Dimension = dimension;
  rest.Range = range;
  rest.Default = defaultValue;
  rest.Unit = unit;
  rest.Help = help;
  return rest;
}

MeshingParameter Flag(const char* name, int dimension, const char* defaultValue, const char* help,
  const MeshingParameter& rest = {})
{
  return Number(Kind::Flag, name, dimension, {}, defaultValue, "", help, rest);
}

MeshingParameter Word(const char* name, int dimension, const char* defaultValue,
  const std::vector<std::string>& words, const char* help, MeshingParameter rest = {})
{
  rest.Words = words;
  return Number(Kind::Word, name, dimension, {}, defaultValue, rest.Unit.c_str(), help, rest);
}

MeshingParameter List(Kind kind, const char* name, ParameterRange range, const char* unit,
  const char* help, const MeshingParameter& rest = {})
{
  return Number(kind, name, 0, range, "", unit, help, rest);
}

/** In programs that mesh what they have there are no files to read. */
Parameters Reading()
{
  Parameters all{
    Word("overlap", 0, "smallest", { "smallest", "order" },
      "which of the masks that have a voxel gets it: the smallest, of equals the first; or the "
      "first in order. Also of segments of a .seg.nrrd file, and of DICOM segmentations"),
    Number(Kind::Real, "mask-threshold", 0, { 0.0, 1.0 }, "0.5", "NUMBER",
      "above which probabilities, from 0 to 1, are inside: of masks, and of DICOM segmentations"),
    Flag("resample-masks", 0, "off",
      "resample masks whose grids differ by more than whole voxels to the smallest voxels, by "
      "nearest neighbour; they are refused otherwise"),
    List(Kind::Text, "series", {}, "UID", "the DICOM series to read, if the folder holds several",
      { .Property = "SeriesUID", .Python = "series_uid", .Panel = None }),
    List(Kind::File, "label-table", {}, "FILE",
      "text file with the names of the labels, and perhaps colours: that of an atlas, of "
      "FreeSurfer, ITK-SNAP or 3D Slicer, or lines like '3 Tibia' or '3,Tibia,220,216,20'",
      { .Property = "LabelTableFileName",
        .Zero = "the names that the image has, or those in FILE.nii.txt beside FILE.nii.gz",
        .Excludes = NotOfGreyValues,
        .Panel = "Label Table File" }),
    Word("space", 0, "lps", { "lps", "ras" },
      "coordinates of the image and the mesh: in those of DICOM and ITK (lps) x and y grow to the "
      "left and to the back of the patient, in those of NIfTI and 3D Slicer's scene (ras) to the "
      "right and to the front"),
    List(Kind::Numbers, "spacing", Positive, "X,Y,Z",
      "the distances of voxels along the axes of the image, in place of what its file says: for "
      "formats that do not know them (TIFF)",
      { .Example = "0.5,0.5,2" }),
    List(Kind::Numbers, "origin", {}, "X,Y,Z",
      "the place of the first voxel, in place of what the file says, in the coordinates of {space}",
      { .Example = "-10,0,25.5" }),
    List(Kind::Numbers, "direction", {}, "NUMBERS",
      "the directions of the axes of the image, in place of what the file says, in the coordinates "
      "of {space}: nine numbers, row by row, of a matrix whose columns they are",
      { .Example = "1,0,0,0,1,0,0,0,1" }),
    Flag("data-files-anywhere", 0, "off",
      "let the header of an image (.nhdr, .mhd, .hdr) name data files that are not in its folder "
      "or below; only for headers that you trust"),
  };
  for (MeshingParameter& parameter : all)
  {
    parameter.Slicer = None;
  }
  return all;
}

Parameters GreyValues()
{
  return {
    Number(Kind::Real, "isovalue", 0, {}, "", "VALUE",
      "mesh the region that the isosurface of a grey-value image at this value bounds, as one "
      "label",
      { .Usual = ParameterRange{ -1e9, 1e9 }, .Step = 0.1 }),
    Word("inside", 0, "above", { "above", "below" },
      "side of the isosurface on which the object lies; above: where values are greater",
      { .Needs = OfIsosurface }),
    Number(Kind::Whole, "inside-label", 0, { 1.0, LargestWhole }, "1", "LABEL",
      "the label of the elements inside of the isosurface",
      { .Label = "Label of the inside",
        .Usual = ParameterRange{ 1.0, 65535.0 },
        .Step = 1.0,
        .Needs = OfIsosurface }),
    // Programs that have no name for it set it by smoothing.
    Number(Kind::Real, "grey-smoothing", 0, Sigmas, "0", "VOXELS",
      "standard deviation of the smoothing of noise in grey values, in voxels",
      { .Property = "IsosurfaceSmoothingSigma",
        .Label = "Smoothing of grey values",
        .Step = 0.1,
        .Zero = "off",
        .Option = None,
        .Python = None,
        .Panel = "Isosurface Smoothing" }),
  };
}

Parameters Sampling()
{
  return {
    Number(Kind::Real, "delta", 0, Positive, "", "LENGTH",
      "sampling distance of the interfaces: the edges of their triangles are about one to two "
      "times as long; the number of elements grows with the square of 1/delta",
      { .Zero = "derived from the spacing",
        .Excludes = { "elements",
          " and {elements} do not go together: delta is what is solved for; leave one of the two "
          "out" } }),
    Number(Kind::Whole, "elements", 0, { 1.0, LargestWhole }, "", "NUMBER",
      "solve for the delta that gives this number of elements, to within a tenth, in place of "
      "{delta}; it takes two or three times as long",
      { .Property = "NumberOfElements",
        .Label = "Number of elements",
        .Zero = "it depends on delta" }),
    Word("grading", 0, "uniform", { "uniform", "lfs" },
      "sample interfaces with delta everywhere (uniform), or more coarsely where their shape "
      "allows it, by the local feature size (lfs): the distance to the medial axis, about half the "
      "thickness of a thin part"),
    Number(Kind::Real, "size", 0, Positive, "", "LENGTH",
      "upper bound of the elements' circumradii, everywhere",
      { .Property = "ElementSize", .Label = "Largest element", .Zero = "no bound" }),
    List(Kind::LabelSizes, "label-size", Positive, "LABEL=LENGTH",
      "upper bound of the elements' circumradii in single labels",
      { .Label = "Largest element of labels",
        .Slicer = "labelSizes",
        .Python = "label_sizes",
        .Panel = "Label Table" }),
    List(Kind::Image, "size-image", {}, "FILE",
      "image whose values are upper bounds of the elements' circumradii, 0 where there is no bound",
      { .Property = "ElementSizeData",
        .Label = "Image of sizes",
        .Slicer = None,
        .Panel = "Size Image" }),
  };
}

Parameters Labels()
{
  return {
    List(Kind::Labels, "labels", {}, "LIST", "mesh these labels only; the others become background",
      { .Property = "Label", .Excludes = NotOfGreyValues, .Panel = "Label Table" }),
  };
}

Parameters Shapes()
{
  return {
    Flag("optimise", 0, "on",
      "improve shapes after refinement: dihedral angles of 18 to 150 degrees, with few exceptions, "
      "radius-edge ratios up to 2.5; in space-time normalized volumes of 0.05",
      { .Zero = "they stay as refinement makes them: Delaunay, radius-edge ratios below 2" }),
    Number(Kind::Whole, "smallest-component", 0, { 0.0, LargestWhole }, "8", "VOXELS",
      "connected components with at least this number of voxels, and the largest of each label, "
      "get elements for every delta; in space-time so do those of each frame",
      { .Zero = "no guarantee" }),
    Flag("exact-components", 0, "off",
      "sample these components as finely as their thickness requires, for every delta, and in 3D "
      "as it "
      "takes to connect their elements through faces; otherwise components that are thin compared "
      "with "
      "delta have few elements"),
    Number(Kind::Real, "min-component-volume", 3, Positive, "", "VOLUME",
      "leave out connected components that are smaller, such as specks: they get the label around "
      "them",
      { .Property = "MinimumComponentVolume",
        .Label = "Smallest volume",
        .Zero = "none is left out",
        .Slicer = "minimumVolume" }),
  };
}

Parameters Interfaces()
{
  return {
    List(Kind::InterfaceSizes, "interface-size", Positive, "LABELS=LENGTH",
      "sampling distance of all interfaces of a label, or of the interface between two labels (0 "
      "is background), in place of delta; it may be smaller or larger",
      { .Label = "Interface sizes",
        .Slicer = "interfaceSizes",
        .Python = "interface_sizes",
        .Panel = "Interface Table" }),
    Number(Kind::Real, "feature-ratio", 0, Positive, "1", "RATIO",
      "with {grading} lfs: sampling distance over local feature size where that gives more than "
      "delta",
      { .Usual = ParameterRange{ 0.1, 4.0 }, .Step = 0.1, .Needs = OfGrading }),
    Number(Kind::Real, "largest-feature", 0, Positive, "12", "VOXELS",
      "with {grading} lfs: upper bound of the local feature size (lambda), in voxels",
      { .Usual = ParameterRange{ 1.0, 100.0 }, .Step = 1.0, .Needs = OfGrading }),
    Number(Kind::Real, "gradation", 0, NotNegative, "0.3", "SLOPE",
      "how much sizes and interface sizes may change over a unit of length",
      { .Usual = ParameterRange{ 0.0, 1.0 }, .Zero = "no limit" }),
  };
}

Parameters Quality()
{
  return {
    Number(Kind::Real, "radius-edge", 0, { 1.0, Infinity }, "2", "RATIO",
      "upper bound of circumradius over shortest edge, of every element",
      { .Property = "RadiusEdgeRatio",
        .Label = "Radius-edge ratio",
        .Usual = ParameterRange{ 1.0, 10.0 },
        .Step = 0.1,
        .ForceBelow = 1.93,
        .ForceWhy = "meshes can become very large",
        .Panel = "Radius-Edge Ratio" }),
    Number(Kind::Real, "facet-angle", 3, { 0.0, 30.0 }, "30", "DEGREES",
      "lower bound of the angles of triangles on the interfaces, in degrees", { .Step = 1.0 }),
    Number(Kind::Real, "smoothing", 0, Sigmas, "1", "VOXELS",
      "standard deviation of the smoothing of voxel stairs, in voxels; every voxel centre keeps "
      "its label",
      { .Property = "SmoothingSigma",
        .Step = 0.1,
        .Zero = "off",
        .StandsFor = "grey-smoothing",
        .Panel = "Smoothing" }),
    Number(Kind::Real, "sliver-angle", 3, { 0.0, 59.0 }, "9", "DEGREES",
      "a tetrahedron with a dihedral angle below this, or above 180 degrees minus this, is a "
      "sliver and is split; most slivers above 1 degree are left to optimisation",
      { .Step = 1.0,
        .Zero = "leave slivers",
        .ForceAbove = 15.0,
        .ForceWhy = "meshes can become very large" }),
    Number(Kind::Real, "optimise-seconds", 3, Positive, "", "SECONDS",
      "stop improving shapes after this time, even if work remains",
      { .Property = "OptimisationTimeLimit",
        .Label = "Time for optimising",
        .Zero = "no limit",
        .Excludes = { "optimise",
          " limits what {optimise} switches off: leave one of the two out" } }),
    Flag("junctions", 3, "on",
      "sample the curves where three labels or more meet before all else, so that edges follow "
      "them",
      { .Property = "SampleJunctions", .Zero = "the curves zigzag", .Python = "sample_junctions" }),
    Number(Kind::Whole, "interface-rounds", 0, { 0.0, 100.0 }, "8", "NUMBER",
      "largest number of rounds that refine again where an interface of the image is farther than "
      "1.5 delta from the mesh's interfaces, or a label's boundary is not manifold",
      { .Step = 1.0, .Zero = "never" }),
    Flag("manifold", 0, "on",
      "repair edges where more than two triangles of a label's boundary meet (space-time: "
      "triangles "
      "with more than two tetrahedra), if necessary with pieces of elements that are not Delaunay",
      { .Zero = "such places stay", .Slicer = None }),
    Flag("fit", 0, "on", "move vertices of interfaces a little, so that volumes are right",
      { .Property = "FitInterfaces",
        .Label = "Fit interfaces",
        .Zero = "they lie on the interfaces",
        .Slicer = None,
        .Python = "fit_interfaces" }),
  };
}

/** In the order in which they are done. */
Parameters Repair()
{
  Parameters all{
    Number(Kind::Whole, "fill-holes", 0, { 1.0, LargestWhole }, "", "VOXELS",
      "fill cavities of at most this number of voxels with the label around them",
      { .Zero = "none is filled" }),
    Flag("remove-spikes", 0, "off",
      "remove strings of voxels, one voxel wide, that hang on a label on one side only"),
    List(Kind::LabelSizes, "min-thickness", Positive, "LABEL=LENGTH",
      "thicken labels where they are thinner, at the cost of what is around them",
      { .Property = "MinimumThickness",
        .Label = "Smallest thickness of labels",
        .Slicer = "minimumThickness",
        .Panel = "Minimum Thickness" }),
    List(Kind::LabelSizes, "shell", {}, "LABEL=LENGTH",
      "make a new label of this thickness around a label, in background, or, if it is negative, of "
      "the outer voxels of the label",
      { .Label = "Shells", .Slicer = "shells", .Python = "shells" }),
    Flag("check-image", 0, "off",
      "report what is suspicious in the image, such as crumbs, cavities and thin parts"),
  };
  for (MeshingParameter& parameter : all)
  {
    parameter.Excludes = NotOfGreyValues;
  }
  return all;
}

Parameters SpaceTime()
{
  return {
    Number(Kind::Real, "time-scale", 4, Positive, "1", "LENGTH",
      "the length that is equivalent to one unit of time"),
    // Python's mesh() has an argument of its own.
    Number(Kind::Times, "frame-times", 4, {}, "", "LIST",
      "the times of the frames, in place of those of the image; they increase, and need not be "
      "equally spaced",
      { .Property = "FrameTime", .Python = None, .Panel = "Times of Frames" }),
    Number(Kind::Whole, "frame-steps", 4, { 0.0, 8.0 }, "0", "NUMBER",
      "steps between two frames; labels are interpolated between them, so that fast motion is "
      "followed (1: no frames are added)",
      { .Step = 1.0, .Zero = "as many as the motion asks for" }),
    Flag("periodic", 4, "off",
      "make both ends of the mesh congruent; the last frame must be the first one again"),
    Word("rule-order", 4, "radius-edge", { "radius-edge", "surface" },
      "which rules come first: those that bound the radius-edge ratio, or those that sample the "
      "interfaces",
      { .Python = None }),
    Flag("picking", 4, "on", "fight slivers with picking regions",
      { .Property = "PickingRegions",
        .Label = "Fight slivers",
        .Zero = "faster, with flat elements",
        .Python = "pick_slivers",
        .Panel = "Fight Slivers" }),
    Number(Kind::Whole, "picks", 4, { 1.0, LargestWhole }, "10", "NUMBER",
      "random points to try in a picking region",
      { .Property = "NumberOfPicks",
        .Label = "Number of picks",
        .Excludes = OfPicking,
        .Python = None }),
    Number(Kind::Real, "sliver-bound", 4, { 0.0, 0.999 }, "0.01", "RATIO",
      "normalized volume below which an element is a sliver",
      { .Usual = ParameterRange{ 0.0, 0.03 },
        .ForceAbove = 0.03,
        .ForceWhy = "meshes can become very large",
        .Excludes = OfPicking,
        .Python = None }),
    Number(Kind::Whole, "seed", 4, { 0.0, LargestWhole }, "0", "NUMBER",
      "seed of the random points",
      { .Property = "RandomSeed", .Label = "Random seed", .Excludes = OfPicking }),
    Flag("fine-grained", 4, "on", "let waiting threads help others to expand cavities",
      { .Label = "Fine-grained", .Python = None, .Panel = "Fine-Grained Help" }),
  };
}

Parameters Running()
{
  return {
    Number(Kind::Whole, "threads", 0, { 0.0, 4096.0 }, "0", "NUMBER",
      "threads to use in every stage, refinement included; with 1, or with reproducible, the mesh "
      "is "
      "the same, bit for bit, in every run",
      { .Property = "NumberOfThreads", .Step = 1.0, .Zero = "all cores", .Panel = "Threads" }),
    Flag("reproducible", 0, "off", "make the same mesh, bit for bit, with any number of threads",
      { .Property = "Reproducible", .Label = "Reproducible" }),
    Word("contention", 0, "local", { "aggressive", "random", "global", "local" },
      "what a thread does when another thread holds a vertex that it needs: aggressive (try again "
      "at once), random (sleep for a random time), global or local (wait until another thread "
      "makes progress)",
      { .Property = "ContentionManager",
        .Label = "Contention manager",
        .Unit = "MANAGER",
        .Slicer = None,
        .Python = None }),
    Word("balance", 0, "hws", { "rws", "hws" },
      "which thread gives work to a thread without work: the one that looks first (rws) or the "
      "nearest (hws)",
      { .Property = "LoadBalancer", .Label = "Load balancer", .Slicer = None, .Python = None }),
    Flag("pin", 0, "off",
      "keep each thread on a core of its own; not while other programs use the cores",
      { .Property = "PinThreads", .Label = "Pin threads", .Slicer = None, .Python = None }),
    Number(Kind::Bytes, "memory-limit", 0, { 1.0, 1e18 }, "", "BYTES",
      "refuse meshes estimated to need more",
      { .Zero = "the machine's memory", .Slicer = None, .Panel = None }),
    Flag("force", 0, "off",
      "continue although the mesh is estimated not to fit into memory, the labels look like grey "
      "values, or the value of another parameter needs it"),
  };
}

struct GroupOfParameters
{
  Group Name;
  Parameters Members;
};

Parameters Join(const std::vector<GroupOfParameters>& groups)
{
  Parameters all;
  for (const GroupOfParameters& group : groups)
  {
    for (const MeshingParameter& member : group.Members)
    {
      all.push_back(member);
      all.back().Group = group.Name;
    }
  }
  return all;
}

} // namespace

const std::vector<MeshingParameter>& MeshingParameters()
{
  static const Parameters all = Join({
    { Group::Reading, Reading() },
    { Group::GreyValues, GreyValues() },
    { Group::Sampling, Sampling() },
    { Group::Labels, Labels() },
    { Group::Shapes, Shapes() },
    { Group::Interfaces, Interfaces() },
    { Group::Quality, Quality() },
    { Group::Repair, Repair() },
    { Group::SpaceTime, SpaceTime() },
    { Group::Running, Running() },
  });
  return all;
}

} // namespace voxplex
